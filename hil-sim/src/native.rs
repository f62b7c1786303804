//! `native`: a brain that runs in the simulator's process. The same [`Station`] as on a board, driven in the
//! same order (docs/architecture.md §7.2): deadlines due by the tick's time, each at its own time; then the
//! tick's packets; then its sensor frame; every message is sent as soon as it is produced.

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use protocol::Instant;
use protocol::lockstep::TickIn;

use crate::mcu::{Backend, Mcu, McuError, Reply};

/// Robots' computers in this process, all with one case base.
#[derive(Clone, Copy)]
pub struct NativeBackend<'a> {
    base: CaseBase<'a>,
}

impl<'a> NativeBackend<'a> {
    /// With this case base in every robot's "flash".
    pub fn new(base: CaseBase<'a>) -> Self {
        Self { base }
    }
}

impl<'a> Backend<'a> for NativeBackend<'a> {
    fn name(&self) -> &'static str {
        "native"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        let station = Station::new(Instant(0), config, self.base);
        Ok(Box::new(Native { station, reply: Reply::default() }))
    }
}

/// One robot's computer.
struct Native<'a> {
    station: Station<'a>,
    reply: Reply,
}

impl Native<'_> {
    /// Sends the station's messages; as on a board, those that do not fit into the tick are dropped.
    fn drain(&mut self, now: Instant) {
        while let Some(packet) = self.station.poll_packet(now) {
            let _dropped = self.reply.packets.push(packet);
        }
    }
}

impl Mcu for Native<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.reply = Reply::default();
        while let Some(due) = self.station.poll_timeout().filter(|due| *due <= tick.now) {
            self.station.handle_timeout(due);
            self.drain(due);
        }
        for packet in &tick.air {
            self.station.handle_packet(tick.now, packet);
            self.drain(tick.now);
        }
        self.station.handle_sensors(tick.now, &tick.sensors);
        self.drain(tick.now);
        self.reply.actuators = self.station.poll_actuators(tick.now);
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        Ok(std::mem::take(&mut self.reply))
    }
}
