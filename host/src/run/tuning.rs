//! `tuning`: the team's parameters while robots play: changes from the page, kept until they are saved to the
//! team's file, and what was learned, which is saved at the end.

use std::io;
use std::path::{Path, PathBuf};

use foreign::printable_path;

use crate::Host;
use crate::config::{ParameterChange, TeamConfig};
use crate::learned::Learned;

/// Longest file of settings that is read, bytes: one with every setting has 1 kB.
pub const CONFIG_LEN_MAX: u64 = 1 << 20;

/// The configuration that the program started with, and what was changed since.
pub(super) struct Tuning {
    config: TeamConfig,
    file: Option<PathBuf>,
    changes: Vec<ParameterChange>,
}

impl Tuning {
    /// Nothing changed yet; `file` is the one of `--config`.
    pub(super) fn new(config: &TeamConfig, file: Option<&Path>) -> Self {
        Self { config: config.clone(), file: file.map(Path::to_owned), changes: Vec::new() }
    }

    /// Checks a change against what the host plays by now; an error says why it is refused.
    pub(super) fn check(&self, host: &Host, change: &ParameterChange) -> Result<(), String> {
        let now = self.config.clone().with_live(host.settings());
        now.changed(change).map(|_| ()).map_err(|refused| refused.to_string())
    }

    /// Keeps a change that the host has taken.
    pub(super) fn keep(&mut self, change: ParameterChange) {
        self.changes.retain(|had| (&had.key, had.robot) != (&change.key, change.robot));
        self.changes.push(change);
    }

    /// Writes what was changed into the team's file, whose comments and order stay; says what was done.
    pub(super) fn save(&mut self) -> Result<String, String> {
        let Some(file) = &self.file else {
            return Err("there is no file to save to: start with --config team.toml".to_owned());
        };
        if self.changes.is_empty() {
            return Err("nothing was changed since it was saved".to_owned());
        }
        let failed = |error: io::Error| format!("{}: {error}; nothing is saved", printable_path(file));
        let mut text = foreign::read_text(file, CONFIG_LEN_MAX)
            .map_err(|error| failed(io::Error::other(error.to_string())))?;
        for change in &self.changes {
            text =
                change.write_into(&text).map_err(|refused| failed(io::Error::other(refused.to_string())))?;
        }
        foreign::replace(file, text.as_bytes()).map_err(failed)?;
        let number = self.changes.len();
        self.changes.clear();
        Ok(format!("{number} changed parameters are in {}", printable_path(file)))
    }
}

/// Saves the learned values to the file `path`; returns a message for the operator.
pub(super) fn keep_learned(path: &Path, learned: &Learned) -> String {
    let write = || -> io::Result<()> {
        let before = match foreign::read_text(path, CONFIG_LEN_MAX) {
            Ok(text) => text,
            Err(_) if !path.exists() => String::new(),
            Err(error) => return Err(io::Error::other(error.to_string())),
        };
        foreign::replace(path, crate::learned::kept(&before, learned).as_bytes())
    };
    match write() {
        Ok(()) => format!("learned  what is known of kickers and ball is in {}", printable_path(path)),
        Err(error) => format!("learned  {}: {error}; nothing is kept", printable_path(path)),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_was_changed_is_saved_once_and_the_rest_of_the_file_stays() {
        let file = std::env::temp_dir().join(format!("onetwo-tuning-{}.toml", std::process::id()));
        fs::write(&file, "# our team\nkeeper = 2\n").unwrap();
        let config = crate::config::TeamSettings::default().complete().unwrap();
        let mut tuning = Tuning::new(&config, Some(&file));
        assert!(tuning.save().unwrap_err().contains("nothing was changed"));
        for value in [1.5, 1.7] {
            let value = Some(toml::Value::from(value));
            tuning.keep(ParameterChange { key: "limits.speed".to_owned(), robot: None, value });
        }
        let told = tuning.save().unwrap();
        assert!(told.starts_with("1 changed"), "{told}");
        assert_eq!(fs::read_to_string(&file).unwrap(), "# our team\nkeeper = 2\n\n[limits]\nspeed = 1.7\n");
        assert!(tuning.save().is_err());
        fs::remove_file(&file).unwrap();
        assert!(Tuning::new(&config, None).save().unwrap_err().contains("--config"));
    }
}
