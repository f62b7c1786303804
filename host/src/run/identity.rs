//! `identity`: the team's key and this start's epoch, for links to robots; our name in tracker packets.
//!
//! A link to real robots refuses the key of zeros, which is public, unless `--insecure-zero-key` permits it.

use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::config::{RobotLink, TeamConfig};
use crate::shell::epoch::{self, Epoch};
use crate::shell::key;
use protocol::frame::TeamKey;
use thiserror::Error;

use super::{Operator, RunError};

/// Real robots, and a key that is public: that of the file, or none given.
#[derive(Debug, Error)]
#[error(
    "{link}: {}: anybody in radio range could command the robots. Make a key with `openssl rand -hex 16 > \
     team.key`, provision the robots with it (docs/security.md) and add --key-file team.key; or add \
     --insecure-zero-key",
    match file {
        Some(file) => format!("the key in {} is all zeros, which is public", file.display()),
        None => "there is no --key-file, and the key of zeros is public".to_owned(),
    }
)]
pub struct PublicKey {
    /// The link as in `--robots`.
    pub link: String,
    /// `--key-file`.
    pub file: Option<PathBuf>,
}

/// Identifier of our tracker packets.
pub(super) fn own_uuid(config: &TeamConfig) -> String {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    format!("onetwo-{}-{}", config.colour.label(), unix.as_secs())
}

/// The team's key: the file's, or zeros where that is allowed.
pub(super) fn team_key(config: &TeamConfig, operator: &mut dyn Operator) -> Result<TeamKey, RunError> {
    let read = config.key_file.as_deref().map(key::read).transpose()?;
    let key = read.as_ref().map_or(TeamKey::ZERO, |read| read.key);
    let link = match &config.robots {
        RobotLink::Simulator(_) => None,
        RobotLink::Udp(address) => Some(format!("udp://{address}")),
        RobotLink::Serial { device, .. } => Some(format!("serial:{device}")),
    };
    if let Some(link) = link.filter(|_| key == TeamKey::ZERO && !config.insecure_zero_key) {
        return Err(PublicKey { link, file: config.key_file.clone() }.into());
    }
    if let Some(warning) = read.and_then(|read| read.warning) {
        operator.line(format!("warning: {warning}"));
    }
    Ok(key)
}

/// This start's epoch. Robots in a simulator start with their host, so nothing is kept for them.
pub(super) fn this_epoch(config: &TeamConfig) -> Epoch {
    if matches!(config.robots, RobotLink::Simulator(_)) {
        return Epoch { epoch: calendar(), warning: None };
    }
    real_epoch()
}

/// This start's epoch for real robots, greater than all before.
pub fn real_epoch() -> Epoch {
    epoch::next(epoch::state_directory().as_deref(), calendar())
}

/// Seconds since 1970.
fn calendar() -> u32 {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u32::try_from(unix.as_secs()).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::TeamSettings;

    struct NoOperator;

    impl Operator for NoOperator {
        fn line(&mut self, _line: String) {}
    }

    fn key_for(robots: &str, key: Option<&str>, insecure: bool) -> Result<TeamKey, String> {
        let path = std::env::temp_dir().join(format!(
            "onetwo-identity-{}-{}",
            std::process::id(),
            key.unwrap_or("none")
        ));
        if let Some(key) = key {
            std::fs::write(&path, key).unwrap();
        }
        let settings = TeamSettings {
            robots: Some(robots.to_owned()),
            key_file: key.map(|_| path.clone()),
            insecure_zero_key: Some(insecure),
            ..TeamSettings::default()
        };
        let found =
            team_key(&settings.complete().unwrap(), &mut NoOperator).map_err(|failure| failure.to_string());
        let _ = std::fs::remove_file(path);
        found
    }

    #[test]
    fn a_link_to_real_robots_needs_a_key_that_is_not_public() {
        let (zeros, own) = ("0".repeat(32), format!("{}07", "0".repeat(30)));
        for robots in ["udp://127.0.0.1:9", "serial:/dev/ttyACM0"] {
            for key in [None, Some(&*zeros)] {
                let error = key_for(robots, key, false).unwrap_err();
                assert!(
                    error.contains("openssl rand -hex 16") && error.contains("--insecure-zero-key"),
                    "{error}"
                );
                assert!(key_for(robots, key, true) == Ok(TeamKey::ZERO));
            }
            assert!(key_for(robots, Some(&own), false).is_ok());
        }
        assert!(key_for("sim://127.0.0.1", None, false) == Ok(TeamKey::ZERO));
    }
}
