//! `destination`: the files that verbs write. One rule for all of them: an output is no input of the same
//! command, no other output of it, and no file that holds something else than what is written.
//!
//! [`check`] is called before the work, so that nothing is lost and nothing is computed in vain; [`write()`]
//! looks again. Devices and pipes hold nothing and are written to as they are.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use foreign::printable_path;
use host::record::Recorder;
use protocol::provision;

/// Contents of a file, as far as its first bytes say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileKind {
    /// A recording of ours, gzipped or not.
    Trace,
    /// A recording of the league, gzipped or not.
    LeagueLog,
    /// A robot's number and keys.
    Page,
    /// A team's key.
    Key,
    Png,
    Svg,
    Html,
    Json,
    Csv,
    /// Settings, a case or a robot's description.
    Toml,
    /// Text of any other form.
    Text,
    /// Bytes that are none of these.
    Bytes,
}

impl FileKind {
    const fn description(self) -> &'static str {
        match self {
            Self::Trace => "a trace",
            Self::LeagueLog => "a league log",
            Self::Page => "a robot's key page",
            Self::Key => "a team's key",
            Self::Png => "a PNG picture",
            Self::Svg => "an SVG picture",
            Self::Html => "an HTML page",
            Self::Json => "JSON",
            Self::Csv => "a CSV table",
            Self::Toml => "TOML",
            Self::Text => "text",
            Self::Bytes => "other data",
        }
    }

    /// Kind of the file that begins like this; none of an empty one.
    fn of(begin: &[u8]) -> Option<Self> {
        if begin.is_empty() {
            return None;
        }
        let magics: [(&[u8], Self); 3] = [
            (b"ONETWO_TRACE", Self::Trace),
            (b"SSL_LOG_FILE", Self::LeagueLog),
            (b"\x89PNG\r\n\x1a\n", Self::Png),
        ];
        if let Some((_, kind)) = magics.into_iter().find(|(magic, _)| begin.starts_with(magic)) {
            return Some(kind);
        }
        let page: Result<&[u8; provision::PAGE_LEN], _> = begin.try_into();
        if page.is_ok_and(|page| provision::read(page, false).is_ok()) {
            return Some(Self::Page);
        }
        // The last character may be cut.
        Some(match str::from_utf8(begin) {
            Ok(text) if !text.contains('\0') => Self::of_text(text),
            Err(error) if error.error_len().is_none() && error.valid_up_to() > 0 => {
                Self::of_text(&String::from_utf8_lossy(begin))
            }
            _ => Self::Bytes,
        })
    }

    fn of_text(text: &str) -> Self {
        let text = text.trim_start_matches('\u{feff}').trim();
        let mut lines = text.lines().map(str::trim);
        let statement = lines.find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
        let lower = text.get(..512).unwrap_or(text).to_ascii_lowercase();
        if host::shell::key::parse(text).is_ok() {
            Self::Key
        } else if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
            Self::Html
        } else if lower.starts_with('<') && lower.contains("<svg") {
            Self::Svg
        } else if text.starts_with('{') || begins_list(text) {
            Self::Json
        } else if is_toml(statement) {
            Self::Toml
        } else if is_csv(text.lines().next().unwrap_or_default()) {
            Self::Csv
        } else {
            Self::Text
        }
    }

    /// Kind of an existing file; none of one that is empty, absent, a device, a pipe or a directory:
    /// to the last no file is written.
    fn of_file(path: &Path) -> io::Result<Option<Self>> {
        match fs::metadata(path) {
            Ok(there) if there.is_file() => {}
            Ok(_) => return Ok(None),
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
        }
        let begin = first_bytes(foreign::open(path)?)?;
        if !begin.starts_with(&[0x1f, 0x8b]) {
            return Ok(Self::of(&begin));
        }
        // A recording that was cut gives what there is of it.
        let mut begin = Vec::new();
        let _ = MultiGzDecoder::new(foreign::open(path)?).take(BEGIN_LEN).read_to_end(&mut begin);
        if begin.is_empty() {
            return Ok(None);
        }
        let recorded = Self::of(&begin).filter(|kind| matches!(kind, Self::Trace | Self::LeagueLog));
        Ok(Some(recorded.unwrap_or(Self::Bytes)))
    }
}

fn first_bytes(source: impl io::Read) -> io::Result<Vec<u8>> {
    let mut begin = Vec::new();
    source.take(BEGIN_LEN).read_to_end(&mut begin)?;
    Ok(begin)
}

/// True of the list of a JSON text, which is no table's name in TOML.
fn begins_list(text: &str) -> bool {
    text.strip_prefix('[').is_some_and(|rest| rest.starts_with(['\n', '\r', '{', ']']))
}

/// True of `[table]` and of `key = value`.
fn is_toml(line: &str) -> bool {
    let line = line.split_once('#').map_or(line, |(before, _)| before).trim();
    let table = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
    let key = line.split_once('=').map(|(key, _)| key);
    let name = table.map(|name| name.trim_start_matches('[').trim_end_matches(']')).or(key);
    name.is_some_and(|name| is_name(name, "_-.\"' "))
}

/// True of a line of several names of columns.
fn is_csv(line: &str) -> bool {
    line.contains(',') && line.split(',').all(|name| is_name(name, "_-.%\"/ "))
}

/// True of letters, digits and the other characters that a name may have.
fn is_name(name: &str, others: &str) -> bool {
    !name.trim().is_empty() && name.chars().all(|c| c.is_alphanumeric() || others.contains(c))
}

/// Why a file is not written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum DestinationError {
    #[error("{} would be overwritten, and this command reads it; name another file for the output", printable_path(.0))]
    Input(PathBuf),
    #[error("{} is named for two outputs; give each a file of its own", printable_path(.0))]
    Twice(PathBuf),
    #[error(
        "{} holds {holds}, and {new} would replace it; name another file, or remove that one",
        printable_path(file)
    )]
    OtherKind { file: PathBuf, holds: &'static str, new: &'static str },
    /// A directory that would be replaced holds files other than those written there.
    #[error("{} would be lost with its directory, which is written anew; name another one", printable_path(.0))]
    Foreign(PathBuf),
    #[error("cannot write {}: {error}", printable_path(file))]
    Unwritable { file: PathBuf, error: io::Error },
}

impl DestinationError {
    /// An error of the system that concerns this file.
    pub(crate) fn at(file: &Path) -> impl Fn(io::Error) -> Self {
        move |error| Self::Unwritable { file: file.to_owned(), error }
    }
}

/// Refuses outputs that would destroy something: an input (a file, or a case of a library's directory),
/// another output, or a file of another kind.
pub(crate) fn check(outputs: &[(&Path, FileKind)], inputs: &[&Path]) -> Result<(), DestinationError> {
    for (number, (file, kind)) in outputs.iter().enumerate() {
        if inputs.iter().any(|input| is_same(file, input) || is_case_in(file, input)) {
            return Err(DestinationError::Input((*file).to_owned()));
        }
        if outputs[..number].iter().any(|(other, _)| is_same(file, other)) {
            return Err(DestinationError::Twice((*file).to_owned()));
        }
        check_kind(file, *kind)?;
    }
    Ok(())
}

/// Refuses a recording of that name as [`check`] does.
pub(crate) fn check_recording(stem: Option<&Path>, inputs: &[&Path]) -> Result<(), DestinationError> {
    let Some([log, trace]) = stem.map(Recorder::files) else { return Ok(()) };
    check(&[(&log, FileKind::LeagueLog), (&trace, FileKind::Trace)], inputs)
}

/// Writes a file of that kind; refused where one of another kind is there. A link stays one, and an existing
/// file keeps its mode.
pub(crate) fn write(file: &Path, kind: FileKind, bytes: &[u8]) -> Result<(), DestinationError> {
    check_kind(file, kind)?;
    fs::write(file, bytes).map_err(DestinationError::at(file))
}

/// The same for a file that only its owner may read, because it holds a key.
pub(crate) fn write_for_owner(file: &Path, kind: FileKind, bytes: &[u8]) -> Result<(), DestinationError> {
    check_kind(file, kind)?;
    let written = open_for_owner(file).and_then(|mut opened| opened.write_all(bytes));
    written.map_err(DestinationError::at(file))
}

fn open_for_owner(file: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let opened = options.open(file)?;
    // The mode above is for new files; an existing file keeps its own until it is set here.
    #[cfg(unix)]
    if opened.metadata()?.is_file() {
        opened.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o600))?;
    }
    Ok(opened)
}

/// Writes a file that is not there yet.
pub(crate) fn write_new(file: &Path, text: &str) -> io::Result<()> {
    File::create_new(file)?.write_all(text.as_bytes())
}

/// Replaces the text of an input that a verb is to change, as a whole or not at all.
pub(crate) fn replace(file: &Path, text: &str) -> Result<(), DestinationError> {
    foreign::replace(file, text.as_bytes()).map_err(DestinationError::at(file))
}

/// Creates the directory and those above it.
pub(crate) fn make_directory(directory: &Path) -> Result<(), DestinationError> {
    fs::create_dir_all(directory).map_err(DestinationError::at(directory))
}

/// Refuses a directory of results that is read by the same command.
pub(crate) fn check_directory(out: &Path, input: &Path) -> Result<(), DestinationError> {
    if real(out) == real(input) { Err(DestinationError::Input(input.to_owned())) } else { Ok(()) }
}

/// Refuses a library's directory that would be written anew if an input lies in it, or a file that no library
/// has.
pub(crate) fn check_library(directory: &Path, inputs: &[&Path]) -> Result<(), DestinationError> {
    let whole = real(directory);
    if let Some(input) = inputs.iter().find(|input| real(input).starts_with(&whole)) {
        return Err(DestinationError::Input((*input).to_owned()));
    }
    let mut left = vec![directory.to_owned()];
    while let Some(directory) = left.pop().filter(|directory| directory.exists()) {
        for entry in fs::read_dir(&directory).map_err(DestinationError::at(&directory))? {
            let path = entry.map_err(DestinationError::at(&directory))?.path();
            if path.is_dir() && !path.is_symlink() {
                left.push(path);
            } else if path.extension().is_none_or(|extension| extension != "toml") {
                return Err(DestinationError::Foreign(path));
            }
        }
    }
    Ok(())
}

/// Removes a directory that [`check_library`] has passed.
pub(crate) fn clear_library(directory: &Path) -> Result<(), DestinationError> {
    match fs::remove_dir_all(directory) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(DestinationError::at(directory)(error)),
        _ => Ok(()),
    }
}

fn check_kind(file: &Path, kind: FileKind) -> Result<(), DestinationError> {
    match FileKind::of_file(file).map_err(DestinationError::at(file))? {
        Some(holds) if holds != kind => Err(DestinationError::OtherKind {
            file: file.to_owned(),
            holds: holds.description(),
            new: kind.description(),
        }),
        _ => Ok(()),
    }
}

/// Whether both names lead to one file, through links of either kind.
fn is_same(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    if let (Ok(a), Ok(b)) = (fs::metadata(a), fs::metadata(b)) {
        use std::os::unix::fs::MetadataExt as _;
        return a.is_file() && (a.dev(), a.ino()) == (b.dev(), b.ino());
    }
    real(a) == real(b)
}

/// Whether the file is one of those that make a library of the directory.
fn is_case_in(file: &Path, directory: &Path) -> bool {
    directory.is_dir()
        && file.is_file()
        && file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
        && real(file).starts_with(real(directory))
}

/// The path without links, of a file that need not exist.
fn real(path: &Path) -> PathBuf {
    let whole = fs::canonicalize(path);
    whole.unwrap_or_else(|_| match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => {
            let parent = if parent.as_os_str().is_empty() { Path::new(".") } else { parent };
            fs::canonicalize(parent).unwrap_or_else(|_| parent.to_owned()).join(name)
        }
        _ => path.to_owned(),
    })
}

/// Bytes from which a kind is read.
const BEGIN_LEN: u64 = 4096;

#[cfg(test)]
mod tests {
    use super::*;

    fn directory(name: &str) -> PathBuf {
        let directory =
            std::env::temp_dir().join(format!("onetwo-destination-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).unwrap();
        directory
    }

    fn gzipped(bytes: &[u8]) -> Vec<u8> {
        let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        writer.write_all(bytes).unwrap();
        writer.finish().unwrap()
    }

    #[test]
    fn a_file_is_of_the_kind_that_its_first_bytes_say() {
        let directory = directory("kinds");
        let file = directory.join("file");
        let kinds: [(&[u8], Option<FileKind>); 24] = [
            (b"", None),
            (b"ONETWO_TRACE\x02\0\0\0", Some(FileKind::Trace)),
            (&gzipped(b"ONETWO_TRACE\x02\0\0\0"), Some(FileKind::Trace)),
            (b"SSL_LOG_FILE\0\0\0\x01", Some(FileKind::LeagueLog)),
            (&gzipped(b"SSL_LOG_FILE\0\0\0\x01"), Some(FileKind::LeagueLog)),
            (&gzipped(b"my thesis"), Some(FileKind::Bytes)),
            (&gzipped(b"ONETWO_TRACE\x02\0\0\0")[..30], Some(FileKind::Trace)),
            (&gzipped(b"ONETWO_TRACE")[..11], None),
            (b"000102030405060708090a0b0c0d0e0f\r\n", Some(FileKind::Key)),
            (b"\xef\xbb\xbf000102030405060708090A0B0C0D0E0F", Some(FileKind::Key)),
            (b"<svg xmlns=\"http://www.w3.org/2000/svg\">", Some(FileKind::Svg)),
            (b"<?xml version=\"1.0\"?>\n<svg>", Some(FileKind::Svg)),
            (b"<!DOCTYPE html><svg>", Some(FileKind::Html)),
            (b"{\"ball\":[0,0]}\n", Some(FileKind::Json)),
            (b"[\n  {\n    \"a\": 1", Some(FileKind::Json)),
            (b"[[calibration]]\nrobot = 3\n", Some(FileKind::Toml)),
            (b"# our team\n\nkeeper = 2\n", Some(FileKind::Toml)),
            (b"[wheels] # four\nradius = 0.027\n", Some(FileKind::Toml)),
            (b"distance_m,counts\n1.0,25000\n", Some(FileKind::Csv)),
            (b"# Results\n\n| a | b |\n", Some(FileKind::Text)),
            (b"[a link](x.md), and text\n", Some(FileKind::Text)),
            (b"import sys\n", Some(FileKind::Text)),
            (b"ab\0\0", Some(FileKind::Bytes)),
            (b"\x7fELF\x02\x01\x01\0\xff", Some(FileKind::Bytes)),
        ];
        for (bytes, kind) in kinds {
            fs::write(&file, bytes).unwrap();
            assert_eq!(FileKind::of_file(&file).unwrap(), kind, "{}", String::from_utf8_lossy(bytes));
        }
        fs::remove_dir_all(directory).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn an_input_is_no_output_under_any_of_its_names() {
        let directory = directory("names");
        let input = directory.join("a.jsonl");
        fs::write(&input, "{}\n").unwrap();
        std::os::unix::fs::symlink(&input, directory.join("soft")).unwrap();
        fs::hard_link(&input, directory.join("hard")).unwrap();
        for name in ["a.jsonl", "soft", "hard", "./a.jsonl"] {
            let refused = check(&[(&directory.join(name), FileKind::Json)], &[&input]).unwrap_err();
            assert!(matches!(refused, DestinationError::Input(_)), "{name}: {refused}");
        }
        let other = directory.join("b.jsonl");
        assert!(check(&[(&other, FileKind::Json)], &[&input]).is_ok());
        let twice = [(other.as_path(), FileKind::Json), (&directory.join("./b.jsonl"), FileKind::Svg)];
        assert!(matches!(check(&twice, &[]), Err(DestinationError::Twice(_))));
        assert!(check(&[(Path::new("/dev/null"), FileKind::Page)], &[&input]).is_ok());
        assert_eq!(fs::read(&input).unwrap(), b"{}\n");
        fs::remove_dir_all(directory).unwrap();
    }

    #[test]
    fn a_file_of_another_kind_stays_and_one_of_the_same_is_replaced() {
        let directory = directory("other");
        let file = directory.join("team.key");
        fs::write(&file, "000102030405060708090a0b0c0d0e0f\n").unwrap();
        let refused = write(&file, FileKind::Csv, b"a,b\n").unwrap_err().to_string();
        assert!(refused.contains("holds a team's key, and a CSV table would replace it"), "{refused}");
        assert!(write_for_owner(&file, FileKind::Page, &[0; 64]).is_err());
        assert_eq!(fs::read_to_string(&file).unwrap().len(), 33);
        let table = directory.join("cells.csv");
        for text in ["a,b\n1,2\n", "a,b\n3,4\n"] {
            write(&table, FileKind::Csv, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&table).unwrap(), text);
        }
        assert!(write(&directory, FileKind::Csv, b"a,b\n").is_err(), "a directory");
        fs::remove_dir_all(directory).unwrap();
    }

    #[test]
    fn a_library_with_the_users_files_is_not_written_anew() {
        let directory = directory("library");
        let (inside, cases) = (directory.join("four-legged/center"), directory.join("four-legged"));
        fs::create_dir_all(&inside).unwrap();
        fs::write(inside.join("one.toml"), "a = 1\n").unwrap();
        assert!(check_library(&cases, &[]).is_ok());
        assert!(matches!(check_library(&cases, &[&cases]), Err(DestinationError::Input(_))));
        assert!(check_library(&cases, &[&directory]).is_ok(), "it is beside it, not in it");
        fs::write(inside.join("notes.txt"), "mine").unwrap();
        assert!(matches!(check_library(&cases, &[]), Err(DestinationError::Foreign(_))));
        fs::remove_dir_all(directory).unwrap();
    }
}
