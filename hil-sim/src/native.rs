//! `native`: a brain that runs in the simulator's process. The same [`Station`] as on a board, driven in the
//! same order (docs/architecture.md §7.2): deadlines due by the tick's time, each at its own time; then the
//! tick's packets; then its sensor frame; every message is sent as soon as it is produced.

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use protocol::Instant;
use protocol::decision::DecisionReport;
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
        Ok(Box::new(NativeMcu::new(config, self.base)))
    }
}

/// One robot's computer in this process, whose station can be looked at.
pub struct NativeMcu<'a> {
    station: Station<'a>,
    reply: Reply,
}

impl<'a> NativeMcu<'a> {
    /// A robot that boots now.
    pub fn new(config: &BrainConfig, base: CaseBase<'a>) -> Self {
        Self { station: Station::new(Instant(0), config, base), reply: Reply::default() }
    }

    /// Brain and radio endpoint of this computer.
    pub fn station(&self) -> &Station<'a> {
        &self.station
    }

    /// As [`Mcu::post`]; `seen` is shown the station after every event and after every packet it sent.
    pub fn post_seen(&mut self, tick: &TickIn<'_>, mut seen: impl FnMut(&Station<'a>, Instant)) {
        self.reply = Reply::default();
        while let Some(due) = self.station.poll_timeout().filter(|due| *due <= tick.now) {
            self.station.handle_timeout(due);
            self.drain(due, &mut seen);
        }
        for packet in &tick.air {
            self.station.handle_packet(tick.now, packet);
            self.drain(tick.now, &mut seen);
        }
        self.station.handle_sensors(tick.now, &tick.sensors);
        self.drain(tick.now, &mut seen);
        self.reply.actuators = self.station.poll_actuators(tick.now);
    }

    /// Sends what the station has to send; as on a board, what does not fit into the tick is dropped.
    fn drain(&mut self, now: Instant, seen: &mut impl FnMut(&Station<'a>, Instant)) {
        seen(&self.station, now);
        while let Some(packet) = self.station.poll_packet(now) {
            let _dropped = self.reply.packets.push(packet);
            seen(&self.station, now);
        }
    }
}

impl Mcu for NativeMcu<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.post_seen(tick, |_, _| ());
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        Ok(std::mem::take(&mut self.reply))
    }

    fn decision(&self) -> Option<DecisionReport> {
        self.station.brain().decision()
    }
}
