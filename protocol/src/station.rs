//! `station`: what a host and its base station tell each other beside frames, on the serial line alone and
//! never on the air: radio settings, counts of packets, power on the channels (SPEC.md: StationMessage).
//!
//! `mark 3 | message, postcard | check 4`. The mark is no frame's start, so that a base station or a host
//! that does not know these messages refuses them. The check guards against a corrupted line; it is no
//! secret.

use serde::{Deserialize, Serialize};

use crate::link::Packet;
use crate::{RobotId, TeamId, key::Key};

/// Where a team is on the air.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RadioPlan {
    /// Frequency, MHz above 2,400: [`CHANNEL_MIN`] to [`CHANNEL_MAX`].
    pub channel: u8,
    /// Rate on the air, Mbit/s: 1 or 2.
    pub megabits: u8,
    /// Upper bytes of the radio's addresses, which keep teams of one number apart ([`Key::radio_address`]).
    pub address: u16,
}

/// Lowest channel, MHz above 2,400: the first whose 2 MHz lie within the band.
pub const CHANNEL_MIN: u8 = 2;
/// Highest channel: 2.4835 GHz ends the band that needs no licence.
pub const CHANNEL_MAX: u8 = 80;
/// Channels that a scan measures, from 0 on.
pub const SCANNED: usize = 84;
/// Address of base stations without a plan.
pub const ADDRESS_DEFAULT: u16 = 0x6db4;

impl RadioPlan {
    /// The plan of a team that has made none: 2 Mbit/s at 2,402 MHz and 4 MHz more for each team number.
    pub const fn of_team(team: TeamId) -> Self {
        Self { channel: CHANNEL_MIN + 4 * (team.0 % 20), megabits: 2, address: ADDRESS_DEFAULT }
    }

    /// Returns whether a radio can be set to it.
    pub fn is_sound(&self) -> bool {
        (CHANNEL_MIN..=CHANNEL_MAX).contains(&self.channel) && matches!(self.megabits, 1 | 2)
    }
}

impl Key {
    /// The address of a team's radios by the key among its robots, which all of them and the host hold.
    pub fn radio_address(&self) -> u16 {
        self.tag(b"onetwo radio address") as u16
    }
}

/// Packets that a base station sent to one robot since its start, wrapping.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PacketCounts {
    /// Packets with the host's frames; a frame is one or two.
    pub sent: u32,
    /// Of those, acknowledged.
    pub acknowledged: u32,
    /// Repeats of them.
    pub repeats: u32,
    /// Not acknowledged in any repeat.
    pub lost: u32,
}

/// A base station's report on one robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StationReport {
    /// The plan that the base station follows now.
    pub plan: RadioPlan,
    /// Starts of its chip after the first.
    pub restarts: u32,
    /// The robot.
    pub robot: RobotId,
    /// Its packets.
    pub packets: PacketCounts,
}

/// A message between host and base station.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack")]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StationMessage {
    /// Host: be there on the air, and report. Once a second.
    Plan(TeamId, RadioPlan),
    /// Base station: packets of one robot, after each plan for every robot it has sent to.
    Report(StationReport),
    /// Host: measure the power on all channels in so many sweeps. A base station that had a frame of a host
    /// within the last second answers with 0 sweeps: it is in play.
    Scan(u8),
    /// Base station: sweeps, and for each channel in how many of them there was power above −64 dBm.
    Spectrum(u8, heapless::Vec<u8, SCANNED>),
}

/// The packet that carries `message`; empty if it did not fit, which a test excludes.
pub fn packet(message: &StationMessage) -> Packet {
    let mut packet = Packet::new();
    let fits = packet.resize_default(packet.capacity()).is_ok();
    let (Some(body), true) = (packet.get_mut(FRAME_MARK.len()..), fits) else { return Packet::new() };
    let len = postcard::to_slice(message, body).map_or(0, |used| used.len());
    packet.truncate(FRAME_MARK.len() + len);
    packet.iter_mut().zip(FRAME_MARK).for_each(|(to, from)| *to = from);
    let check = check(&packet);
    if len == 0 || packet.extend_from_slice(&check).is_err() {
        packet.clear();
    }
    packet
}

/// Whether a packet is a station's message, sound or not: no frame begins so.
pub fn is_message(packet: &[u8]) -> bool {
    packet.starts_with(&FRAME_MARK)
}

/// The message in a packet; `None` for frames, and what was corrupted.
pub fn read(packet: &[u8]) -> Option<StationMessage> {
    let (covered, seen) = packet.split_last_chunk()?;
    if *seen != check(covered) {
        return None;
    }
    let message = crate::frame::decode(covered.strip_prefix(&FRAME_MARK)?)?;
    let sound = match &message {
        StationMessage::Plan(_, plan) => plan.is_sound(),
        StationMessage::Report(report) => report.plan.is_sound(),
        StationMessage::Scan(_) | StationMessage::Spectrum(..) => true,
    };
    sound.then_some(message)
}

fn check(covered: &[u8]) -> [u8; 4] {
    (Key([0; 16]).tag(covered) as u32).to_le_bytes()
}

/// First bytes: no version of frames, then no sender.
const FRAME_MARK: [u8; 3] = [0xb5, 0x6e, 0xff];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, TeamKey, claimed_sender};

    fn messages() -> [StationMessage; 4] {
        let plan = RadioPlan { channel: 40, megabits: 1, address: 0xbeef };
        let most = u32::MAX;
        let packets = PacketCounts { sent: most, acknowledged: most, repeats: most, lost: most };
        let robot = RobotId::new(15).unwrap();
        [
            StationMessage::Plan(TeamId(2), plan),
            StationMessage::Report(StationReport { plan, restarts: most, robot, packets }),
            StationMessage::Scan(20),
            StationMessage::Spectrum(255, [255; SCANNED].into_iter().collect()),
        ]
    }

    #[test]
    fn messages_are_read_as_written_and_no_changed_bit_is_believed() {
        for message in messages() {
            let whole = packet(&message);
            assert_eq!(read(&whole), Some(message));
            for bit in 0..8 * whole.len() {
                let mut changed = whole.clone();
                changed[bit / 8] ^= 1 << (bit % 8);
                assert_eq!(read(&changed), None, "bit {bit}");
            }
            assert_eq!(read(&whole[..whole.len() - 1]), None);
            // Programs that do not know it: no frame of any version, and of no sender.
            assert!(Frame::parse(&whole, TeamId(2)).is_err() && claimed_sender(&whole).is_none());
        }
    }

    #[test]
    fn a_plan_that_no_radio_can_follow_is_refused() {
        for (channel, megabits) in [(1, 2), (81, 2), (255, 1), (40, 0), (40, 3)] {
            let plan = RadioPlan { channel, megabits, address: 1 };
            assert_eq!(read(&packet(&StationMessage::Plan(TeamId(1), plan))), None);
        }
    }

    #[test]
    fn teams_of_one_number_have_addresses_of_their_own_by_their_keys() {
        let address = |first| TeamKey([first; 16]).of_team().team().radio_address();
        assert_ne!(address(1), address(2));
        assert!((0..=u8::MAX).all(|team| RadioPlan::of_team(TeamId(team)).is_sound()));
    }
}
