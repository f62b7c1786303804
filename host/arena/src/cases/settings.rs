//! `settings`: retrieval's named settings, changed by name and value (docs/case-format.md §3.2).

use casebase::{RetrievalSettings, SettingError};

/// Settings of the retrieval.
#[derive(Clone, Debug, Default)]
pub struct Chosen {
    /// All of them.
    pub settings: RetrievalSettings,
    /// Name and value of every setting that is not at its default, recorded with the results.
    pub changed: Vec<(String, String)>,
}

impl Chosen {
    /// The defaults, changed by these names and values; of two values for a name the later one counts.
    pub fn of<'a>(assignments: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, SettingFailure> {
        let mut settings = RetrievalSettings::default();
        for (name, value) in assignments {
            settings.set(name, value).map_err(|error| SettingFailure::new(name, value, error))?;
        }
        let defaults = described(&RetrievalSettings::default());
        let changed =
            described(&settings).into_iter().filter(|setting| !defaults.contains(setting)).collect();
        Ok(Self { settings, changed })
    }
}

/// Every setting's name and value.
pub fn described(settings: &RetrievalSettings) -> Vec<(String, String)> {
    settings.describe().map(|(name, value)| (name.to_string(), value.to_string())).collect()
}

/// A name or value that retrieval does not know.
#[derive(Debug, thiserror::Error)]
#[error("{assignment}: {error}")]
pub struct SettingFailure {
    /// `NAME=VALUE` as given.
    pub assignment: String,
    /// The error of the retrieval.
    pub error: SettingError,
}

impl SettingFailure {
    /// Error of that assignment.
    pub fn new(name: &str, value: &str, error: SettingError) -> Self {
        Self { assignment: format!("{name}={value}"), error }
    }
}
