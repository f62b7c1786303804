//! `replayed`: comparison of a robot's journal with a native brain: the native brain gets what the robot's
//! was given, at the same times, and its outputs are compared byte by byte.

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use protocol::Instant;
use protocol::frame::RobotKeys;
use protocol::journal::{Entry, JournalError, records};
use protocol::robot_io::ActuatorFrame;

/// Counts of what both brains did alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Replayed {
    /// Boot epochs of the robot: one, unless it restarted.
    pub epochs: u32,
    /// Packets that it was given.
    pub packets: u64,
    /// Sensor frames that it was given: steps.
    pub steps: u64,
    /// Packets that it sent, all of them equal.
    pub sent: u64,
    /// Orders that it gave, all of them equal.
    pub orders: u64,
    /// FNV-1a-64 of its outputs with their times, in their order; the function of docs/architecture.md §2.5.
    pub hash: u64,
    /// Time of its last record.
    pub last: Instant,
}

/// Reason why a journal cannot be called the work of that brain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReplayError {
    /// The journal cannot be read.
    #[error("{0}")]
    Journal(JournalError),
    /// The journal does not begin with the brain's start.
    #[error("the journal does not begin with the brain's start")]
    NoStart,
    /// The robot's memory was full at that time.
    #[error("the robot's memory for the journal was full at {} µs", .0.0)]
    Full(Instant),
    /// An output of the robot differs.
    #[error("at {} µs the robot {robot}, the native brain {native}", at.0)]
    Differs {
        /// Time by the robot's clock.
        at: Instant,
        /// Output of the robot, as text.
        robot: String,
        /// Output of the native brain, as text.
        native: String,
    },
}

/// Plays a journal again; the configuration's epoch is taken from it.
pub fn replay(
    journal: &[u8],
    config: &BrainConfig,
    base: CaseBase<'_>,
    keys: &RobotKeys,
) -> Result<Replayed, ReplayError> {
    let mut replayed = Replayed { hash: FNV_OFFSET, ..Replayed::default() };
    let mut player: Option<Player<'_>> = None;
    for record in records(journal).map_err(ReplayError::Journal)? {
        let record = record.map_err(ReplayError::Journal)?;
        let at = record.at;
        replayed.last = at;
        if let Entry::Start(epoch) = record.entry {
            let config = BrainConfig { epoch, ..config.clone() };
            replayed.epochs += 1;
            let station = Station::with_keys(at, &config, base, *keys);
            player = Some(Player { station, now: at, is_drained: true, packets_done: true });
            continue;
        }
        let player = player.as_mut().ok_or(ReplayError::NoStart)?;
        match record.entry {
            Entry::Start(_) => {}
            Entry::Full => return Err(ReplayError::Full(at)),
            Entry::Packet(packet) => {
                player.settle()?;
                player.station.handle_packet(at, packet);
                player.begin(at);
                replayed.packets += 1;
            }
            Entry::Sensors(sensors) => {
                player.settle()?;
                player.station.handle_sensors(at, &sensors);
                player.begin(at);
                replayed.steps += 1;
            }
            Entry::Timeout => {
                player.settle()?;
                player.station.handle_timeout(at);
                player.begin(at);
            }
            Entry::Sent(packet) => {
                player.sent(at, packet)?;
                replayed.sent += 1;
                hash(&mut replayed.hash, at, packet);
            }
            Entry::Ordered(order) => {
                player.ordered(at, order)?;
                replayed.orders += 1;
                let mut bytes = [0; 64];
                let order = postcard::to_slice(&order, &mut bytes).map_or(&[][..], |bytes| bytes);
                hash(&mut replayed.hash, at, order);
            }
        }
    }
    // The journal's end may lie between an input and its outputs: what is missing there is no difference.
    Ok(replayed)
}

/// The native brain, driven as `runtime`'s task does: after every input all packets, then the orders.
struct Player<'a> {
    station: Station<'a>,
    now: Instant,
    is_drained: bool,
    packets_done: bool,
}

impl Player<'_> {
    fn begin(&mut self, at: Instant) {
        (self.now, self.is_drained, self.packets_done) = (at, false, false);
    }

    fn sent(&mut self, at: Instant, packet: &[u8]) -> Result<(), ReplayError> {
        let own = self.station.poll_packet(self.now);
        let equal = own.as_ref().is_some_and(|own| own[..] == *packet) && at == self.now;
        let native = || own.as_ref().map_or("sent none".to_owned(), |own| format!("sent {own:02x?}"));
        if equal { Ok(()) } else { differs(at, format!("sent {packet:02x?}"), native()) }
    }

    fn ordered(&mut self, at: Instant, order: ActuatorFrame) -> Result<(), ReplayError> {
        self.no_more_packets()?;
        self.is_drained = true;
        let own = self.station.poll_actuators(self.now);
        let bits = |order: &ActuatorFrame| {
            let mut bytes = [0; 64];
            postcard::to_slice(order, &mut bytes).map_or(Vec::new(), |bytes| bytes.to_vec())
        };
        // By bits: NaN and the sign of zero count too.
        let equal = own.as_ref().is_some_and(|own| bits(own) == bits(&order)) && at == self.now;
        if equal { Ok(()) } else { differs(at, format!("ordered {order:?}"), format!("ordered {own:?}")) }
    }

    /// The robot's brain had nothing more to give for its last input.
    fn settle(&mut self) -> Result<(), ReplayError> {
        self.no_more_packets()?;
        if !std::mem::replace(&mut self.is_drained, true)
            && let Some(own) = self.station.poll_actuators(self.now)
        {
            return differs(self.now, "ordered nothing".to_owned(), format!("ordered {own:?}"));
        }
        Ok(())
    }

    fn no_more_packets(&mut self) -> Result<(), ReplayError> {
        if !std::mem::replace(&mut self.packets_done, true)
            && let Some(own) = self.station.poll_packet(self.now)
        {
            return differs(self.now, "sent no more".to_owned(), format!("sent {own:02x?}"));
        }
        Ok(())
    }
}

fn differs<T>(at: Instant, robot: String, native: String) -> Result<T, ReplayError> {
    Err(ReplayError::Differs { at, robot, native })
}

/// Folds bytes and their time into a hash: FNV-1a, 64 bits.
fn hash(hash: &mut u64, at: Instant, bytes: &[u8]) {
    for byte in at.0.to_le_bytes().iter().chain(bytes) {
        *hash = (*hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    }
}

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimulatedBody;
    use protocol::frame::TeamKey;
    use protocol::host::HostMessage;
    use protocol::host_link::HostLink;
    use protocol::journal::{HEADER_LEN, MAGIC, Writer};
    use protocol::{RobotId, TeamId};
    use rules::League;

    const KEY: TeamKey = TeamKey([5; 16]);

    fn id() -> RobotId {
        RobotId::new(3).unwrap()
    }

    fn config() -> BrainConfig {
        BrainConfig::hosted(id(), TeamId(1), League::DivisionB)
    }

    /// What a robot's tasks write in a second: a step every 10 ms, a welcome of the host between them.
    fn journal() -> Vec<u8> {
        let mut memory = vec![0; 1 << 18];
        memory[..4].copy_from_slice(&MAGIC);
        let mut writer = Writer::new(&mut memory);
        let base = case_library::division_b();
        let config = BrainConfig { epoch: 7, ..config() };
        let mut station = Station::with_keys(Instant(50), &config, base, KEY.of_robot(id()));
        writer.write(Instant(50), Entry::Start(7));
        let mut host = HostLink::new(TeamId(1), KEY, 9);
        let body = SimulatedBody::new(id());
        for step in 1..100 {
            let at = Instant(step * 10_000 + step % 7);
            let sensors = body.sensors(at);
            writer.write(at, Entry::Sensors(sensors.clone()));
            station.handle_sensors(at, &sensors);
            drain(&mut station, &mut writer, at, &mut host);
            let at = Instant(at.0 + 4_321);
            if let Some(due) = station.poll_timeout().filter(|due| *due <= at) {
                writer.write(due, Entry::Timeout);
                station.handle_timeout(due);
                drain(&mut station, &mut writer, due, &mut host);
            }
            let Some(welcome) = host.welcome(id()) else { continue };
            let packet = host.seal(at, &HostMessage::Welcome(welcome));
            writer.write(at, Entry::Packet(&packet));
            station.handle_packet(at, &packet);
            drain(&mut station, &mut writer, at, &mut host);
        }
        memory
    }

    fn drain(station: &mut Station<'_>, writer: &mut Writer<'_>, at: Instant, host: &mut HostLink) {
        while let Some(packet) = station.poll_packet(at) {
            let _heard = host.open(at, &packet);
            writer.write(at, Entry::Sent(&packet));
        }
        if let Some(order) = station.poll_actuators(at) {
            writer.write(at, Entry::Ordered(order));
        }
    }

    fn played(journal: &[u8], keys: TeamKey) -> Result<Replayed, ReplayError> {
        replay(journal, &config(), case_library::division_b(), &keys.of_robot(id()))
    }

    #[test]
    fn a_brain_with_equal_inputs_gives_equal_outputs() {
        let replayed = played(&journal(), KEY).unwrap();
        assert_eq!((replayed.epochs, replayed.steps), (1, 99));
        assert!(replayed.packets > 90 && replayed.sent > 20 && replayed.orders > 90, "{replayed:?}");
    }

    #[test]
    fn one_bit_of_an_output_an_input_less_and_another_key_are_differences() {
        let whole = journal();
        assert!(matches!(played(&whole, TeamKey([6; 16])), Err(ReplayError::Differs { .. })));
        let read: Vec<_> = records(&whole).unwrap().map(Result::unwrap).collect();
        let rewritten = |change: &dyn Fn(usize, &mut Entry<'_>) -> bool| {
            let mut memory = vec![0; whole.len()];
            memory[..4].copy_from_slice(&MAGIC);
            let mut writer = Writer::new(&mut memory);
            for (n, record) in read.iter().enumerate() {
                let mut entry = record.entry.clone();
                if change(n, &mut entry) {
                    writer.write(record.at, entry);
                }
            }
            memory
        };
        assert!(played(&rewritten(&|_, _| true), KEY).is_ok());
        let last =
            |like: fn(&Entry<'_>) -> bool| read.iter().rposition(|record| like(&record.entry)).unwrap();
        let order = last(|entry| matches!(entry, Entry::Ordered(_)));
        let released = rewritten(&|n, entry| {
            if n == order {
                *entry = Entry::Ordered(ActuatorFrame::Omni {
                    wheels: [0.25; 4],
                    dribbler: 0.0,
                    kick: protocol::robot_io::OmniKick::None,
                });
            }
            true
        });
        assert!(matches!(played(&released, KEY), Err(ReplayError::Differs { .. })));
        let sent = last(|entry| matches!(entry, Entry::Sent(_)));
        assert!(matches!(played(&rewritten(&|n, _| n != sent), KEY), Err(ReplayError::Differs { .. })));
        let first = read.iter().position(|record| matches!(record.entry, Entry::Sensors(_))).unwrap();
        assert!(matches!(played(&rewritten(&|n, _| n != first), KEY), Err(ReplayError::Differs { .. })));
        assert_eq!(played(&rewritten(&|n, _| n > 0), KEY), Err(ReplayError::NoStart));
        assert_eq!(played(&whole[..HEADER_LEN], KEY), Err(ReplayError::Journal(JournalError::Header)));
    }
}
