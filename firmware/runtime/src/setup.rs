//! `setup`: reading of a robot's configuration from the simulator, or from provisioning.

use brain::BrainConfig;
use brain::body::BodyKind;
use rules::League;

/// Reads a configuration (postcard), which must end with the last byte.
pub fn read(bytes: &[u8]) -> Result<BrainConfig, SetupError> {
    match postcard::take_from_bytes::<BrainConfig>(bytes) {
        Ok((config, [])) if !BodyKind::is_built(config.league) => Err(SetupError::Body(config.league)),
        Ok((config, [])) => Ok(config),
        Ok((_, rest)) => Err(SetupError::Rest(rest.len())),
        Err(_) => Err(SetupError::Unreadable),
    }
}

/// Reason why bytes are not a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SetupError {
    /// The bytes do not decode: cut short, or of another version of the firmware.
    #[error("the bytes are no configuration of this firmware's version")]
    Unreadable,
    /// Number of surplus bytes behind it.
    #[error("{0} bytes are left over behind the configuration")]
    Rest(usize),
    /// The firmware has no brain for the body of that league's robots.
    #[error("this image leads no robot of the league {0:?}; take the other body's")]
    Body(League),
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{RobotId, TeamId};

    #[test]
    fn a_configuration_is_read_as_written_and_any_cut_is_refused() {
        let config = BrainConfig::new(RobotId::new(3).unwrap(), TeamId(1));
        let mut buffer = [0; 512];
        let bytes = postcard::to_slice(&config, &mut buffer).unwrap().len();
        assert_eq!(read(&buffer[..bytes]), Ok(config));
        assert_eq!(read(&buffer[..=bytes]), Err(SetupError::Rest(1)));
        for cut in 0..bytes {
            assert_eq!(read(&buffer[..cut]), Err(SetupError::Unreadable), "cut at {cut}");
        }
    }
}
