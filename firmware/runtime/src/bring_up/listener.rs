//! `listener`: counts the frames of a host that a robot receives before it knows its team and keys, and keeps
//! the newest host's epoch.

use protocol::TeamId;
use protocol::frame::{Frame, Sender};

use super::RadioCounts;

/// Counts the frames of a host that are on the air, whatever its team and its keys: a robot that is wired for
/// the first time has neither.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Listener {
    counts: RadioCounts,
    /// Host's epoch, snapshot and part of the last part of a snapshot.
    last: Option<(u32, u8, u8)>,
    /// Team and epoch of its last frame.
    host: Option<(TeamId, u32)>,
}

impl Listener {
    /// Takes a packet; others than a host's parts of snapshots are ignored. Only they have numbers without a
    /// gap.
    pub fn receive(&mut self, packet: &[u8]) {
        let team = packet.get(1).copied().unwrap_or_default();
        let Ok(frame) = Frame::parse(packet, TeamId(team)) else { return };
        if frame.sender != Sender::Host {
            return;
        }
        self.host = Some((frame.team, frame.epoch));
        // A part of a snapshot as protocol/SPEC.md has it: variant 0, snapshot, part, parts.
        let [0, snapshot, part, parts, ..] = *frame.payload else { return };
        self.counts.received = self.counts.received.wrapping_add(1);
        if let Some((epoch, before, last)) = self.last
            && epoch == frame.epoch
        {
            let parts_on = u32::from(snapshot.wrapping_sub(before)) * u32::from(parts) + u32::from(part);
            // One that comes twice is not missing.
            let missing = parts_on.saturating_sub(u32::from(last) + 1);
            self.counts.lost = self.counts.lost.wrapping_add(missing);
        }
        self.last = Some((frame.epoch, snapshot, part));
    }

    /// Epoch of the last frame of a host, if it was one of that team; else 0. Its tag was not checked.
    pub fn host_epoch(&self, team: TeamId) -> u32 {
        self.host.filter(|(of, _)| *of == team).map_or(0, |(_, epoch)| epoch)
    }

    /// Counts so far; `line_errors` are the line's.
    pub fn counts(&self, line_errors: u32) -> RadioCounts {
        RadioCounts { line_errors, ..self.counts }
    }
}

#[cfg(test)]
mod tests {
    use protocol::frame::TeamKey;
    use protocol::host::{DriveLimits, HostMessage, WorldPart};
    use protocol::host_link::HostLink;
    use protocol::{Instant, RobotId};
    use rules::Phase;

    use super::*;

    #[test]
    fn a_hosts_frames_are_counted_with_those_that_are_missing_whatever_its_key() {
        let mut host = HostLink::new(TeamId(7), TeamKey([5; 16]), 3);
        let part = |snapshot: u8, part: u8| {
            let (phase, robots) = (Phase::Halt, heapless::Vec::new());
            HostMessage::World(WorldPart {
                snapshot,
                part,
                parts: 2,
                phase,
                placement: None,
                ball: None,
                robots,
            })
        };
        let mut listener = Listener::default();
        // Ten snapshots over the wrap of their number, each in two parts.
        for n in 0..20_u8 {
            let packet = host.seal(Instant(u64::from(n) * 5_000), &part(250_u8.wrapping_add(n / 2), n % 2));
            // Two together, then one more.
            if ![3, 4, 15].contains(&n) {
                listener.receive(&packet);
            }
        }
        let limits = DriveLimits { to: RobotId::ZERO, speed: 900, acceleration: 900 };
        listener.receive(&host.seal(Instant(200_000), &HostMessage::Limits(limits)));
        listener.receive(b"noise");
        assert_eq!(listener.counts(2), RadioCounts { received: 17, lost: 3, line_errors: 2 });
        assert_eq!([7, 8].map(|team| listener.host_epoch(TeamId(team))), [3, 0]);
        // After a restart of the host its numbers start again, and none is missing.
        let mut restarted = HostLink::new(TeamId(7), TeamKey([5; 16]), 4);
        listener.receive(&restarted.seal(Instant(0), &part(100, 0)));
        assert_eq!(listener.counts(0).lost, 3);
    }
}
