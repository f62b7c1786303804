//! `port`: check that camera frames come on vision's port.

use protocol::{Duration, Instant};
use thiserror::Error;

use crate::Host;

/// Time without camera frames after which they count as missing, from the start and from the last one.
const SILENCE_MAX: Duration = Duration::millis(1_000);
/// Another program that has sent nothing for this time has ended.
const FOREIGN_SILENCE_MAX: Duration = Duration::millis(2_000);
/// Fewer packets may come from a program that scans ports.
const FOREIGN_MIN: u64 = 3;

/// Input on vision's port without camera frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum VisionPort {
    /// No packet at all since the start.
    #[error(
        "waiting for vision: no packet has come; is SSL-Vision or a simulator running and sending there? Cameras send to \
         224.5.23.2:10006, simulators to 224.5.23.2:10020 (--vision, --interface); `onetwo simulate` is one"
    )]
    Nothing,
    /// Packets that hold neither camera frame nor field: another program's port.
    #[error(
        "waiting for vision: {packets} packets came on its port and none holds a camera frame or a field; another program sends \
         there. Cameras send to 224.5.23.2:10006, simulators to 224.5.23.2:10020 (--vision)"
    )]
    Foreign {
        /// Number since the last camera frame.
        packets: u64,
    },
    /// The field's geometry, but no camera frame.
    #[error(
        "waiting for vision: the field's geometry comes, but no camera frame; are the cameras on, and is capture started in \
         SSL-Vision?"
    )]
    NoFrames,
}

/// Packets of vision's port, as the host counted them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Port {
    began: Option<Instant>,
    /// Foreign packets before the last camera frame, and now; when the newest came.
    before: u64,
    foreign: u64,
    newest: Option<Instant>,
}

impl Port {
    pub(super) fn look(&mut self, now: Instant, host: &Host) -> Option<VisionPort> {
        let undecodable = host.undecodable();
        self.see(
            now,
            host.last_camera_frame(),
            undecodable.vision + undecodable.empty,
            host.tracker().counts().packets() > undecodable.empty,
        )
    }

    /// Updates by the newest camera frame, the number of foreign packets, and whether any other packet came.
    fn see(
        &mut self,
        now: Instant,
        frame: Option<Instant>,
        foreign: u64,
        others: bool,
    ) -> Option<VisionPort> {
        let began = *self.began.get_or_insert(now);
        if foreign > self.foreign {
            (self.foreign, self.newest) = (foreign, Some(now));
        }
        if frame.is_some_and(|at| now.since(at) < SILENCE_MAX) {
            self.before = self.foreign;
            return None;
        }
        if now.since(began) < SILENCE_MAX {
            return None;
        }
        let packets = self.foreign - self.before;
        if packets >= FOREIGN_MIN && self.newest.is_some_and(|at| now.since(at) < FOREIGN_SILENCE_MAX) {
            return Some(VisionPort::Foreign { packets });
        }
        match frame {
            // Frames that came and then stopped are a stall.
            Some(_) => None,
            None if others => Some(VisionPort::NoFrames),
            None => Some(VisionPort::Nothing),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The findings every 100 ms of `seconds`, by camera frames and foreign packets a second; geometry where
    /// `others`.
    fn found(frames: u64, foreign: u64, others: bool, seconds: u64) -> Vec<Option<VisionPort>> {
        let mut port = Port::default();
        let look = |n: u64| {
            let now = Instant(n * 100_000);
            let frame = (frames > 0).then_some(now);
            port.see(now, frame, foreign * n / 10, others)
        };
        (0..10 * seconds).map(look).collect()
    }

    #[test]
    fn no_packet_other_packets_and_geometry_alone_are_distinguished_within_two_seconds() {
        for (foreign, others, expected) in [
            (0, false, VisionPort::Nothing),
            (100, false, VisionPort::Foreign { packets: 0 }),
            (0, true, VisionPort::NoFrames),
        ] {
            let found = found(0, foreign, others, 5);
            assert_eq!(found[9], None, "it is given a second");
            for (n, found) in found.iter().enumerate().skip(20) {
                let same = match (found, expected) {
                    (Some(VisionPort::Foreign { packets }), VisionPort::Foreign { .. }) => {
                        *packets == 10 * n as u64
                    }
                    (found, expected) => *found == Some(expected),
                };
                assert!(same, "{n}: {found:?}");
            }
        }
        for description in [VisionPort::Nothing, VisionPort::Foreign { packets: 5_785 }, VisionPort::NoFrames]
        {
            assert!(
                description.to_string().contains("SSL-Vision")
                    || description.to_string().contains("--vision"),
                "{description}"
            );
        }
    }

    #[test]
    fn a_port_that_brings_camera_frames_is_the_right_one_whatever_else_comes() {
        assert!(found(60, 0, true, 60).iter().all(Option::is_none));
        assert!(found(60, 50, true, 60).iter().all(Option::is_none));
    }
}
