//! `file`: files of untrusted sources, read up to a limit. Sizes in bytes.

use std::fs::{self, File, FileType, Permissions};
use std::io::{self, ErrorKind, Read, Write as _};
use std::path::Path;

/// Opens a regular file for streaming; any other kind of file is refused.
///
/// Its type is checked before it is opened, because opening a pipe waits for a writer and opening a device
/// may have an effect; and again afterwards, in case it was exchanged in between.
pub fn open(path: &Path) -> io::Result<File> {
    regular(fs::metadata(path)?.file_type())?;
    let file = File::open(path)?;
    regular(file.metadata()?.file_type())?;
    Ok(file)
}

/// A regular file's bytes, at most `limit` of them; a longer file is refused.
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    read_from(&open(path)?, limit)
}

/// The same for a file that is open already, from its present position.
pub fn read_from(file: &File, limit: u64) -> io::Result<Vec<u8>> {
    regular(file.metadata()?.file_type())?;
    let mut bytes = Vec::new();
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let message = format!("the file is longer than {limit} bytes, the most that is read of such a file");
        return Err(io::Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// A regular file's text in UTF-8, at most `limit` bytes; a longer file is refused.
pub fn read_text(path: &Path, limit: u64) -> io::Result<String> {
    String::from_utf8(read(path, limit)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        io::Error::new(ErrorKind::InvalidData, format!("the file is not UTF-8 from byte {at} on"))
    })
}

/// Replaces a regular file's contents, as a whole or not at all: a crash leaves the old file. A link stays a
/// link, what it leads to is replaced; the file's mode stays. A file that is not there is created.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (target, mode) = match fs::metadata(path) {
        Ok(there) => {
            regular(there.file_type())?;
            (fs::canonicalize(path)?, Some(there.permissions()))
        }
        // A link to a file that is not there yet.
        Err(error) if error.kind() == ErrorKind::NotFound => match fs::read_link(path) {
            Ok(to) => (path.parent().unwrap_or(Path::new("")).join(to), None),
            Err(_) => (path.to_owned(), None),
        },
        Err(error) => return Err(error),
    };
    let mut beside = target.as_os_str().to_owned();
    beside.push(".new");
    let beside = Path::new(&beside);
    let replaced = write_new(beside, mode, bytes).and_then(|()| fs::rename(beside, &target));
    if replaced.is_err() {
        let _ = fs::remove_file(beside);
    }
    replaced
}

fn write_new(path: &Path, mode: Option<Permissions>, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    // First: the contents may be for its owner alone.
    if let Some(mode) = mode {
        file.set_permissions(mode)?;
    }
    file.write_all(bytes)?;
    file.sync_all()
}

fn regular(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    let message = format!("this is a {}, not a regular file; copy what it gives into a file", name(kind));
    Err(io::Error::new(ErrorKind::InvalidInput, message))
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match kind {
        _ if kind.is_dir() => "directory",
        _ if kind.is_fifo() => "pipe",
        _ if kind.is_socket() => "socket",
        _ if kind.is_char_device() || kind.is_block_device() => "device",
        _ => "special file",
    }
}

#[cfg(not(unix))]
fn name(kind: FileType) -> &'static str {
    if kind.is_dir() { "directory" } else { "special file" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn scratch(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("onetwo-foreign-{}-{name}", std::process::id()))
    }

    #[test]
    fn a_file_is_read_up_to_its_limit_and_not_beyond() {
        let file = scratch("limit");
        fs::write(&file, "12345678").unwrap();
        assert_eq!(read(&file, 8).unwrap(), b"12345678");
        let error = read(&file, 7).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
        assert!(error.to_string().contains("7 bytes"), "{error}");
        assert_eq!(read_text(&file, 8).unwrap(), "12345678");
        fs::write(&file, b"ab\xff").unwrap();
        assert!(read_text(&file, 8).unwrap_err().to_string().contains("byte 2"));
        fs::remove_file(&file).unwrap();
        assert_eq!(read(&file, 8).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn a_replaced_file_is_new_as_a_whole_and_leaves_nothing_beside_it() {
        let file = scratch("replaced");
        for text in ["one", "two and more"] {
            replace(&file, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
        assert!(replace(&std::env::temp_dir(), b"three").is_err());
        assert!(!scratch("replaced.new").exists());
        fs::remove_file(&file).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_replaced_file_keeps_its_mode_and_the_link_that_leads_to_it() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let directory = scratch("links");
        fs::create_dir_all(directory.join("real")).unwrap();
        let (file, link) = (directory.join("real/team.toml"), directory.join("team.toml"));
        symlink("real/team.toml", &link).unwrap();
        replace(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new", "a link to nothing yet");
        for mode in [0o600, 0o640, 0o644, 0o444] {
            fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
            replace(&link, format!("{mode:o}").as_bytes()).unwrap();
            assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o7777, mode);
            assert_eq!(fs::read_to_string(&file).unwrap(), format!("{mode:o}"));
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        }
        fs::remove_dir_all(directory).unwrap();
    }

    #[test]
    fn a_directory_is_refused_by_name() {
        assert!(read(&std::env::temp_dir(), 8).unwrap_err().to_string().contains("a directory"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_pipes_and_sockets_are_refused_without_being_read() {
        for device in ["/dev/zero", "/dev/full", "/dev/null"] {
            let error = read(Path::new(device), 8).unwrap_err();
            assert!(error.to_string().contains("a device"), "{device}: {error}");
        }
        let socket = scratch("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        assert!(read(&socket, 8).unwrap_err().to_string().contains("a socket"));
        fs::remove_file(&socket).unwrap();
        let pipe = scratch("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|status| status.success()), "mkfifo is part of every Unix");
        // It has no writer: reading it would never end.
        assert!(read(&pipe, 8).unwrap_err().to_string().contains("a pipe"));
        let link = scratch("link");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        assert!(read(&link, 8).unwrap_err().to_string().contains("a device"));
        for path in [pipe, link] {
            fs::remove_file(path).unwrap();
        }
    }
}
