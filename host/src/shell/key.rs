//! `key`: the team's key file. A file with 32 hexadecimal digits, which other users should not be able to
//! read.

use std::path::{Path, PathBuf};

use protocol::frame::TeamKey;

use crate::hex;

/// Longest key file that is read, bytes: 32 digits, and room for blanks and line ends around them.
const KEY_FILE_LEN_MAX: u64 = 4096;

/// A key that was read, with a warning about its file if there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyFile {
    /// The team's key, 16 bytes.
    pub key: TeamKey,
    /// Other users may read the file, or the key is the public one of zeros.
    pub warning: Option<String>,
}

/// Why there is no key.
#[derive(Debug, thiserror::Error)]
pub enum KeyError {
    /// The file cannot be read.
    #[error(
        "the key file {} cannot be read: {error}; `openssl rand -hex 16` makes a key",
        printable_path(path)
    )]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// The operating system's error.
        error: std::io::Error,
    },
    /// A file that does not hold 32 hexadecimal digits.
    #[error(
        "the key file {} holds {what}; it must hold 32 hexadecimal digits and nothing else, as `openssl rand -hex 16` \
         makes them",
        printable_path(path)
    )]
    Malformed {
        /// Path of the file.
        path: PathBuf,
        /// Content of the file by kind; never its text.
        what: String,
    },
}

/// A path as it can be printed.
fn printable_path(path: &Path) -> String {
    foreign::printable(&path.to_string_lossy()).into_owned()
}

/// Reads a key file.
pub fn read(path: &Path) -> Result<KeyFile, KeyError> {
    let unreadable = |error| KeyError::Unreadable { path: path.to_owned(), error };
    let bytes = foreign::read(path, KEY_FILE_LEN_MAX).map_err(unreadable)?;
    let malformed = |what| KeyError::Malformed { path: path.to_owned(), what };
    let text = str::from_utf8(&bytes).map_err(|_| malformed("bytes that are no text".to_owned()))?;
    let key = parse(text).map_err(malformed)?;
    let warning = if key == TeamKey::ZERO {
        Some(format!("the key in {} is all zeros, which is public", printable_path(path)))
    } else {
        readable_by_others(path)
    };
    Ok(KeyFile { key, warning })
}

/// Parses 32 hexadecimal digits; the error describes the text found.
pub fn parse(text: &str) -> Result<TeamKey, String> {
    let digits = text.trim();
    let bytes = hex::decode(digits)?;
    let key = bytes.try_into().map_err(|_| format!("{} digits", digits.len()))?;
    Ok(TeamKey(key))
}

/// The key as [`parse`] reads it.
pub fn format(key: &TeamKey) -> String {
    hex::encode(&key.0)
}

#[cfg(unix)]
fn readable_by_others(path: &Path) -> Option<String> {
    use std::os::unix::fs::PermissionsExt as _;
    let mode = std::fs::metadata(path).ok()?.permissions().mode();
    (mode & 0o077 != 0)
        .then(|| format!("others may read the key file {}; `chmod 600` it", printable_path(path)))
}

#[cfg(not(unix))]
fn readable_by_others(_path: &Path) -> Option<String> {
    None
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_key_is_read_and_written_as_32_digits() {
        let text = "000102030405060708090a0b0c0d0eFF\n";
        let key = parse(text).unwrap();
        assert_eq!((key.0[1], key.0[15]), (1, 0xff));
        assert_eq!(parse(&format(&key)), Ok(key));
    }

    #[test]
    fn an_invalid_key_is_refused_without_printing_it() {
        assert_eq!(parse("00"), Err("2 digits".into()));
        assert_eq!(parse("123"), Err("3 digits".into()));
        assert_eq!(parse("0001secret"), Err("something that is no hexadecimal digit at place 5".into()));
        let missing = read(Path::new("no-such.key")).unwrap_err().to_string();
        assert!(missing.contains("no-such.key") && missing.contains("openssl"), "{missing}");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_and_a_file_too_long_are_no_key_and_end_at_once() {
        let zeros = read(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(zeros.contains("a device, not a regular file"), "{zeros}");
        let path = std::env::temp_dir().join(format!("onetwo-long-key-test-{}", std::process::id()));
        fs::write(&path, "0".repeat(5000)).unwrap();
        let long = read(&path).unwrap_err().to_string();
        assert!(long.contains("longer than 4096 bytes"), "{long}");
        fs::remove_file(&path).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_others_may_read_is_warned_of() {
        use std::os::unix::fs::PermissionsExt as _;
        let path = std::env::temp_dir().join(format!("onetwo-key-test-{}", std::process::id()));
        fs::write(&path, "000102030405060708090a0b0c0d0e0f").unwrap();
        let warned = |mode| {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            read(&path).unwrap().warning.is_some()
        };
        assert_eq!((warned(0o600), warned(0o640), warned(0o604)), (false, true, true));
        fs::write(&path, "0".repeat(32)).unwrap();
        assert!(read(&path).unwrap().warning.unwrap().contains("all zeros"));
        fs::remove_file(&path).unwrap();
    }
}
