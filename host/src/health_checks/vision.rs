//! `vision`: checks of the cameras' senders, clocks, delays and rates.

use std::fmt;

use protocol::{Duration, Instant};
use thiserror::Error;

use super::FAULT_LASTS_MIN;
use crate::Host;
use crate::tracking::CameraStatus;
use crate::tracking::senders::SecondVision;

/// A camera's packets that come this much later than the others' are reported, ms.
const LATE_FROM_MS: i64 = 50;
/// Robots are tracked from this number of camera frames a second on.
const RATE_MIN: f32 = 4.5;
/// A camera's rate is known after this time with vision.
const RATE_KNOWN_AFTER: Duration = FAULT_LASTS_MIN;

impl fmt::Display for SecondVision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { camera, followed, other } = self;
        write!(
            f,
            "a second vision sends camera {camera}: {followed} is followed, {other} is not used; end the other program, or give it \
             another group (--vision)"
        )
    }
}

/// What is wrong with a camera.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CameraFault {
    /// Its clock is not the others'.
    #[error(
        "the clock of camera {camera} is {} ms {} the others': it is taken out; set the clocks of the vision computers \
         by NTP",
        ahead_ms.abs(), if *ahead_ms < 0 { "behind" } else { "ahead of" }
    )]
    Clock {
        /// Number of the camera.
        camera: u32,
        /// Its clock is ahead by this, ms; negative: behind.
        ahead_ms: i64,
    },
    /// Its packets come later than the others'.
    #[error(
        "frames of camera {camera} come {by_ms} ms later than the others': they count late; look at its computer and its network"
    )]
    Late {
        /// Number of the camera.
        camera: u32,
        /// Time by which they are later, ms.
        by_ms: i64,
    },
    /// Its frames cannot be used.
    #[error(
        "frames of camera {camera} are not used, they are {by_ms} ms off the others': its part of the field is not seen; is its \
         clock steady, and are two programs sending it?"
    )]
    Unused {
        /// Number of the camera.
        camera: u32,
        /// Time by which its stamps differ from the others', ms.
        by_ms: i64,
    },
    /// It sends too few frames.
    #[error(
        "camera {camera} sends {rate:.1} images a second, too slow to track robots, which need 5; is its computer overloaded, or \
         the exposure too long?"
    )]
    Slow {
        /// Number of the camera.
        camera: u32,
        /// Frames a second.
        rate: f32,
    },
}

impl CameraFault {
    /// Identity without numbers.
    pub(super) fn matter(&self) -> String {
        match self {
            Self::Clock { camera, .. } => format!("clock of camera {camera}"),
            Self::Late { camera, .. } => format!("delay of camera {camera}"),
            Self::Unused { camera, .. } => format!("frames of camera {camera}"),
            Self::Slow { camera, .. } => format!("rate of camera {camera}"),
        }
    }
}

/// The faults of the cameras that are heard.
pub(super) fn look(now: Instant, host: &Host) -> impl Iterator<Item = CameraFault> {
    let known = now.0 >= RATE_KNOWN_AFTER.0;
    host.tracker().cameras(now).filter_map(move |camera| fault(&camera).filter(|_| known))
}

fn fault(status: &CameraStatus) -> Option<CameraFault> {
    let CameraStatus { camera, ahead_ms, late_ms, rate, unused_ms } = *status;
    if let Some(by_ms) = unused_ms {
        return Some(CameraFault::Unused { camera, by_ms });
    }
    if ahead_ms != 0 {
        return Some(CameraFault::Clock { camera, ahead_ms });
    }
    if late_ms >= LATE_FROM_MS {
        return Some(CameraFault::Late { camera, by_ms: late_ms });
    }
    (rate > 0.0 && rate < RATE_MIN).then_some(CameraFault::Slow { camera, rate })
}
