//! `epoch`: the host's boot epoch, larger with every start even where this computer's clock was set back.
//! Seconds since 1970, or one more than the last that was used, kept in a file per user.
//!
//! Robots refuse every host whose epoch is below that of the host they followed last. The file is one decimal
//! number, replaced as a whole under a lock, so that neither a power cut nor two simultaneous starts damage
//! it or give one epoch twice.

use std::env;
use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// The file's name in the directory of [`state_directory`].
const FILE_NAME: &str = "host-epoch";
/// A number of 32 bits has ten digits.
const FILE_BYTES_MAX: u64 = 16;

/// An epoch, with a warning if there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Epoch {
    /// The epoch, seconds since 1970 or larger.
    pub epoch: u32,
    /// Text if it could not be stored, or the clock is behind.
    pub warning: Option<String>,
}

/// Directory of this user's state that must survive a restart: `$XDG_STATE_HOME/onetwo`, or
/// `~/.local/state/onetwo`.
pub fn state_directory() -> Option<PathBuf> {
    let absolute = |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let state = absolute("XDG_STATE_HOME").or_else(|| Some(absolute("HOME")?.join(".local/state")))?;
    Some(state.join("onetwo"))
}

/// The epoch of a start at `calendar`, seconds since 1970, kept in `directory` for the next one.
pub fn next(directory: Option<&Path>, calendar: u32) -> Epoch {
    let kept = directory.ok_or_else(|| "there is neither XDG_STATE_HOME nor HOME".to_owned());
    let kept = kept.and_then(|directory| {
        take(directory, calendar).map_err(|error| format!("{}: {error}", directory.join(FILE_NAME).display()))
    });
    match kept {
        Ok(epoch) if epoch > calendar => {
            let warning = format!(
                "this computer's clock is {} s behind the last start of the host; robots are led with epoch {epoch} all the same. Set the \
                 clock",
                epoch - calendar
            );
            Epoch { epoch, warning: Some(warning) }
        }
        Ok(epoch) => Epoch { epoch, warning: None },
        Err(why) => Epoch {
            epoch: calendar.max(1),
            warning: Some(format!(
                "the host's epoch cannot be kept ({why}); if this computer's clock is set back, robots will refuse the next start until \
                 they are restarted"
            )),
        },
    }
}

fn take(directory: &Path, calendar: u32) -> io::Result<u32> {
    fs::create_dir_all(directory)?;
    let lock = File::create(directory.join(format!("{FILE_NAME}.lock")))?;
    lock.lock()?;
    let path = directory.join(FILE_NAME);
    let last = read(&path)?;
    let epoch = match last {
        Some(last) => calendar.max(last.checked_add(1).ok_or_else(|| {
            io::Error::other(
                "the last epoch is the largest there is: delete the file and restart every robot",
            )
        })?),
        None => calendar.max(1),
    };
    let new = directory.join(format!("{FILE_NAME}.new"));
    let mut file = File::create(&new)?;
    writeln!(file, "{epoch}")?;
    file.sync_all()?;
    fs::rename(&new, &path)?;
    Ok(epoch)
}

/// The last epoch; `None` before the first start.
fn read(path: &Path) -> io::Result<Option<u32>> {
    let file = match File::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        file => file?,
    };
    if !file.metadata()?.is_file() {
        return Err(io::Error::other("it is no regular file; delete it"));
    }
    let mut text = String::new();
    file.take(FILE_BYTES_MAX).read_to_string(&mut text)?;
    text.trim()
        .parse()
        .map(Some)
        .map_err(|_| io::Error::other("it holds no epoch; delete it and restart every robot"))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Directory(PathBuf);

    impl Directory {
        fn new(name: &str) -> Self {
            let path = env::temp_dir().join(format!("onetwo-epoch-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            Self(path)
        }
    }

    impl Drop for Directory {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn epochs_are_the_calendars_and_rise_when_it_is_set_back() {
        let directory = Directory::new("rise");
        let epoch = |calendar| next(Some(&directory.0), calendar);
        assert_eq!(epoch(1_000), Epoch { epoch: 1_000, warning: None });
        assert_eq!(epoch(1_000).epoch, 1_001, "twice in a second");
        assert_eq!(epoch(2_000), Epoch { epoch: 2_000, warning: None });
        let behind = epoch(500);
        assert_eq!(behind.epoch, 2_001);
        assert!(behind.warning.is_some_and(|description| description.contains("1501 s behind")), "told");
        assert_eq!(fs::read_to_string(directory.0.join(FILE_NAME)).unwrap(), "2001\n");
    }

    #[test]
    fn many_starts_at_once_get_an_epoch_each() {
        let directory = Directory::new("many");
        let mut epochs: Vec<u32> = std::thread::scope(|scope| {
            let starts: Vec<_> =
                (0..8).map(|_| scope.spawn(|| next(Some(&directory.0), 100).epoch)).collect();
            starts.into_iter().map(|start| start.join().unwrap()).collect()
        });
        epochs.sort_unstable();
        assert_eq!(epochs, (100..108).collect::<Vec<_>>());
    }

    #[test]
    fn the_host_starts_and_reports_a_file_without_epoch_or_an_impossible_directory() {
        let directory = Directory::new("bad");
        fs::create_dir_all(&directory.0).unwrap();
        fs::write(directory.0.join(FILE_NAME), "yesterday").unwrap();
        let reported = |directory| {
            let Epoch { epoch, warning } = next(directory, 1_000);
            assert_eq!(epoch, 1_000);
            warning.unwrap()
        };
        assert!(reported(Some(&directory.0)).contains("it holds no epoch; delete it"));
        let no_directory = directory.0.join(FILE_NAME);
        assert!(reported(Some(&no_directory)).contains("cannot be kept"));
        assert!(reported(None).contains("XDG_STATE_HOME"));
        fs::write(directory.0.join(FILE_NAME), u32::MAX.to_string()).unwrap();
        assert!(reported(Some(&directory.0)).contains("largest"));
    }
}
