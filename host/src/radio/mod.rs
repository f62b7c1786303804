//! `radio`: packs snapshots and commands into frames at a limited rate, unpacks robots' frames into
//! telemetry and link quality (docs/architecture.md §3.3, §6.1). Sans-IO: times come from the caller, packets
//! go back to it.
//!
//! **Presence.** A robot is present while its telemetry names this host's epoch ([`protocol::host_link`]).
//! Only then it is commanded, addressed by snapshots, relayed and used by the strategy. Before, it is
//! welcomed, at most every [`UNAUTHENTICATED_EVERY`].
//!
//! **Numbers.** Callers name robots by their shells, frames by their radio numbers ([`RobotNumbers`]);
//! packets and their receivers ([`To`]) have radio numbers.
//!
//! **Rate.** A new snapshot goes out at once, but at most one per [`PERIOD_MIN`] (100 Hz); one that comes too
//! early waits, the newest replaces older ones. Where no new one comes for [`PERIOD_MAX`] (60 Hz) the last
//! goes out again, extrapolated. After [`REPEAT_MAX`] without a new one the radio stops sending: robots brake
//! by themselves, which is safer than such an old estimate.
//!
//! **Relay.** Where robots receive their host but not each other, the host forwards each beacon and handshake
//! byte for byte.
//!
//! No heap: capacities are named constants, packets that do not fit are dropped and counted.

mod counters;
mod numbers;
mod quality;
mod snapshot;
mod warning;

use protocol::decision::DecisionPart;
use protocol::frame::{Audience, Frame, Refusal, Sender, TeamKey};
use protocol::host::{DriveLimits, HostCommand, HostMessage, PARTS_MAX, Telemetry};
use protocol::host_link::{HostLink, Opened};
use protocol::link::Packet;
use protocol::parts::PartsReport;
use protocol::station::{self, StationMessage, StationReport};
use protocol::team::{Beacon, TeamMessage};
use protocol::version::VersionReport;
use protocol::{Duration, Instant, RobotId, TeamId};

use crate::world::World;
use warning::Refusals;

pub use counters::Counters;
pub use numbers::RobotNumbers;
pub use quality::{LinkTotals, Quality, table};
pub use snapshot::{PARTS_ROBOTS_MAX, RadioSituation};
pub use warning::{RadioWarning, RefusalReason};

/// At most one snapshot in this time: 100 Hz, as fast as the league's cameras and the best published radios.
pub const PERIOD_MIN: Duration = Duration::millis(10);
/// A snapshot may come early by this time, so that a camera of 100 Hz with jitter loses none; the next then
/// waits longer.
pub const EARLY: Duration = Duration::millis(2);
/// The last snapshot goes out again after this time: 60 Hz.
pub const PERIOD_MAX: Duration = Duration(16_600);
/// Longest time for which a snapshot is extrapolated: half a second, twice the longest blackout of vision
/// that teams report (0.2 s).
pub const REPEAT_MAX: Duration = Duration::millis(500);
/// A robot is present if its telemetry came within this time; it comes ten times a second.
pub const PRESENT: Duration = Duration::millis(1_000);
/// Interval of repeated welcomes, so that a lost welcome causes only a delay.
const WELCOME_EVERY: Duration = Duration::millis(100);
/// A robot that has not named our epoch is welcomed at most this often: replayed frames of robots cause no
/// higher rate.
pub const UNAUTHENTICATED_EVERY: Duration = Duration::millis(20);
/// Capacity of the queue of outgoing packets: the parts, a command and a welcome for each robot, and each
/// robot's beacon for each other.
const OUT_MAX: usize = 320;

/// Receivers of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// Every robot of the team.
    All,
    /// The robot of this number.
    One(RobotId),
}

/// Path of robots' beacons to their teammates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relay {
    /// Robots receive each other directly.
    No,
    /// One at a time: a link that has an address for each robot.
    ToEach,
    /// To all at once: a base station. The sender receives its own frame and ignores it.
    ToAll,
}

/// Settings that are fixed while a host runs.
#[derive(Clone, Copy, Debug)]
pub struct RadioSettings {
    /// The team's number on the radio.
    pub team: TeamId,
    /// The key from which each robot's key is derived.
    pub key: TeamKey,
    /// The host's epoch: must rise with every start; Unix seconds do.
    pub epoch: u32,
    /// Forwarding of beacons between robots.
    pub relay: Relay,
    /// One-way latency of a packet: snapshots are extrapolated by it. 3 ms is what ER-Force takes for theirs.
    pub latency: Duration,
    /// Radio numbers of the shells.
    pub numbers: RobotNumbers,
}

impl RadioSettings {
    /// With a key of zeros over a base station.
    pub fn new(team: TeamId, epoch: u32) -> Self {
        Self {
            team,
            key: TeamKey::ZERO,
            epoch,
            relay: Relay::ToAll,
            latency: Duration::millis(3),
            numbers: RobotNumbers::default(),
        }
    }
}

/// A message received from a robot.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RadioReceived {
    /// State of a robot, to its teammates.
    Beacon(RobotId, Beacon),
    /// Condition of a robot, to the host.
    Telemetry(RobotId, Telemetry),
    /// Boot epoch of a robot, to its teammates.
    Handshake(RobotId),
    /// Part of the problem that a robot decided on, to the host.
    Decision(RobotId, DecisionPart),
    /// What a robot runs, to the host.
    Version(RobotId, VersionReport),
    /// Which of its parts work, to the host.
    Parts(RobotId, PartsReport),
    /// Packets that the base station sent to a robot.
    Station(RobotId, StationReport),
}

/// The host's radio: queue of frames, links to robots, refusals.
#[derive(Clone, Debug)]
pub struct Radio {
    settings: RadioSettings,
    link: HostLink,
    latest: Option<Latest>,
    /// When the next snapshot may go out.
    free: Instant,
    /// When the last snapshot went out.
    last: Option<Instant>,
    snapshot: u8,
    /// When each snapshot went out, by its number.
    departures: [Option<Instant>; 256],
    /// By radio number.
    robots: [Quality; RobotId::COUNT],
    /// Limits of the robots' drives, mm/s and mm/s², once the team has set any.
    limits: Option<[u16; 2]>,
    out: heapless::Deque<(To, Packet), OUT_MAX>,
    dropped: u32,
    refusals: Refusals,
}

/// The newest snapshot and commands of the strategy.
#[derive(Clone, Debug)]
struct Latest {
    since: Instant,
    world: World,
    situation: RadioSituation,
    commands: heapless::Vec<HostCommand, { RobotId::COUNT }>,
    /// Whether the snapshot has not gone out yet.
    fresh: bool,
}

impl Radio {
    /// A radio that has sent and received nothing.
    pub fn new(settings: RadioSettings) -> Self {
        Self {
            settings,
            link: HostLink::new(settings.team, settings.key, settings.epoch),
            latest: None,
            free: Instant(0),
            last: None,
            snapshot: u8::MAX,
            departures: [None; 256],
            robots: Default::default(),
            limits: None,
            out: heapless::Deque::new(),
            dropped: 0,
            refusals: Refusals::default(),
        }
    }

    /// Takes a new snapshot and all robots' commands: they go out now, or as soon as the rate allows. Of two
    /// commands for one robot the first counts. Fetch packets afterwards.
    pub fn offer(
        &mut self,
        now: Instant,
        world: &World,
        situation: RadioSituation,
        commands: &[HostCommand],
    ) {
        let mut kept = heapless::Vec::<HostCommand, { RobotId::COUNT }>::new();
        let numbers = &self.settings.numbers;
        for command in commands.iter().map(|command| numbers.command(command)) {
            if kept.iter().all(|known| known.to != command.to) {
                // One per robot: there is room.
                let _room = kept.push(command);
            }
        }
        let world = world.renumbered(situation.us, |shell| numbers.radio(shell));
        self.latest = Some(Latest { since: now, world, situation, commands: kept, fresh: true });
        self.handle_timeout(now);
    }

    /// A deadline that [`Radio::poll_timeout`] announced has come (or not yet: then nothing happens).
    pub fn handle_timeout(&mut self, now: Instant) {
        if self.poll_timeout().is_some_and(|due| due <= now) {
            self.transmit(now);
        }
    }

    /// The next snapshot may go out at `now`, independent of the rate: it carries HALT. Once per HALT, so
    /// that the rate holds on average.
    pub fn hasten(&mut self, now: Instant) {
        self.free = self.free.min(now);
    }

    /// When to call [`Radio::handle_timeout`]; `None` while there is nothing to send.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let latest = self.latest.as_ref()?;
        if latest.fresh {
            return Some(self.free.max(latest.since));
        }
        let due = self.last? + PERIOD_MAX;
        (due <= latest.since + REPEAT_MAX).then_some(due)
    }

    /// The next packet to send. Call until `None` after everything handled.
    pub fn poll_packet(&mut self) -> Option<(To, Packet)> {
        self.out.pop_front()
    }

    /// Handles a packet of a robot: returns its message, or why it is refused (counted).
    pub fn handle_packet(&mut self, now: Instant, packet: &[u8]) -> Result<RadioReceived, Refusal> {
        if let Some(StationMessage::Report(report)) = station::read(packet) {
            self.robots[report.robot.index()].report_station(report);
            return Ok(RadioReceived::Station(self.settings.numbers.shell(report.robot), report));
        }
        let frame = Frame::parse(packet, self.settings.team);
        let opened = self.link.open(now, packet);
        if let Err(refusal) = opened {
            let sender = frame.ok().map(|frame| (frame.sender, frame.epoch));
            self.refusals.refuse(now, refusal, sender.and_then(|(sender, _)| sender.robot()));
            if let Some((Sender::Host, epoch)) = sender.filter(|(_, epoch)| *epoch != self.link.epoch()) {
                self.refusals.other_host(now, epoch);
            }
        }
        let (robot, message) = match opened? {
            Opened::Believed(robot, message) => (robot, message),
            Opened::Version(robot, report) => {
                let (frame, quality) = (frame?, &mut self.robots[robot.index()]);
                quality.receive(now, packet.len(), frame.epoch, frame.counter);
                quality.report_version(report);
                return Ok(RadioReceived::Version(self.settings.numbers.shell(robot), report));
            }
            Opened::Parts(robot, report) => {
                let (frame, quality) = (frame?, &mut self.robots[robot.index()]);
                quality.receive(now, packet.len(), frame.epoch, frame.counter);
                quality.report_parts(report);
                return Ok(RadioReceived::Parts(self.settings.numbers.shell(robot), report));
            }
            Opened::Unauthenticated(robot, telemetry) => {
                self.refusals.report(now, robot, &telemetry);
                if self.robots[robot.index()].wants_welcome(now, UNAUTHENTICATED_EVERY) {
                    self.welcome(now, robot);
                }
                return Err(Refusal::Unauthenticated {
                    epoch: self.link.welcome(robot).map_or(0, |known| known.boot_epoch),
                });
            }
        };
        let (frame, shell) = (frame?, self.settings.numbers.shell(robot));
        self.robots[robot.index()].receive(now, packet.len(), frame.epoch, frame.counter);
        match message {
            TeamMessage::Beacon(beacon) => {
                self.relay(now, robot, packet);
                Ok(RadioReceived::Beacon(shell, self.settings.numbers.beacon(beacon)))
            }
            TeamMessage::Handshake(_) => {
                self.relay(now, robot, packet);
                Ok(RadioReceived::Handshake(shell))
            }
            TeamMessage::Decision(part) => Ok(RadioReceived::Decision(shell, part)),
            TeamMessage::Telemetry(telemetry) => {
                let departed = self.departures[usize::from(telemetry.snapshot)];
                self.refusals.report(now, robot, &telemetry);
                self.robots[robot.index()].report(now, telemetry, departed);
                Ok(RadioReceived::Telemetry(shell, telemetry))
            }
        }
    }

    /// Quality of the link to that robot; `None` until a frame of it was received.
    pub fn quality(&self, robot: RobotId) -> Option<&Quality> {
        let radio = self.settings.numbers.radio(robot);
        Some(&self.robots[radio.index()]).filter(|quality| quality.received_at().is_some())
    }

    /// Robots whose telemetry has named our epoch within [`PRESENT`], lowest number first.
    pub fn present(&self, now: Instant) -> impl Iterator<Item = RobotId> {
        RobotId::all()
            .filter(move |shell| self.robots[self.settings.numbers.radio(*shell).index()].is_present(now))
    }

    /// Radio numbers of the shells.
    pub fn numbers(&self) -> &RobotNumbers {
        &self.settings.numbers
    }

    /// Other radio numbers of the shells hold from now on; links go on by radio number.
    pub fn renumber(&mut self, numbers: RobotNumbers) {
        // The last snapshot and commands have the old numbers.
        self.latest = None;
        self.settings.numbers = numbers;
    }

    /// Number of frames refused, by [`Refusal::kind`].
    pub fn refused(&self) -> &[u32; Refusal::KINDS] {
        self.link.refused()
    }

    /// Frames on our channel of no robot of the team: of others, forged, or corrupted. What the league's
    /// table calls interference.
    pub fn foreign(&self) -> u32 {
        let refused = self.link.refused();
        let kinds = [Refusal::Version(0), Refusal::Team(TeamId(0)), Refusal::Sender(0), Refusal::Tag];
        kinds.iter().fold(0, |sum, kind| sum.saturating_add(refused[kind.kind()]))
    }

    /// Warnings of what prevents communication between robots and this host now, with remedies.
    pub fn warnings(&self, now: Instant) -> impl Iterator<Item = RadioWarning> {
        self.refusals.warnings(now, self.link.epoch())
    }

    /// When the last snapshot went out.
    pub fn transmitted(&self) -> Option<Instant> {
        self.last
    }

    /// Packets that the caller did not fetch in time.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    fn transmit(&mut self, now: Instant) {
        // Moved out so that parts of it can be read while packets are queued.
        let Some(mut latest) = self.latest.take() else { return };
        self.free = self.free.max(now - EARLY) + PERIOD_MIN;
        self.last = Some(now);
        self.snapshot = self.snapshot.wrapping_add(1);
        self.departures[usize::from(self.snapshot)] = Some(now);
        let present = RobotId::all().filter(|robot| self.robots[robot.index()].is_present(now));
        let audience: Audience = present.collect();
        self.link.set_audience(audience);
        let there = latest.world.at(now + self.settings.latency);
        // Without robots one part goes out to an empty audience: a base station learns the host's address
        // from it.
        let most = if audience.is_empty() { 1 } else { PARTS_MAX };
        for part in snapshot::parts(self.snapshot, audience, &there, &latest.situation).into_iter().take(most)
        {
            self.send_message(now, To::All, &HostMessage::World(part));
        }
        for command in latest.commands.iter().filter(|command| audience.has(command.to)) {
            self.send_message(now, To::One(command.to), &HostMessage::Command(command.clone()));
        }
        for robot in audience.robots() {
            if self.robots[robot.index()].wants_welcome(now, WELCOME_EVERY) {
                self.welcome(now, robot);
            }
        }
        if let Some([speed, acceleration]) = self.limits
            && let Some(to) = nth(audience, self.snapshot)
        {
            let limits = DriveLimits { to, speed, acceleration };
            self.send_message(now, To::One(to), &HostMessage::Limits(limits));
        }
        latest.fresh = false;
        self.latest = Some(latest);
    }

    /// From the next snapshot on robots are told to drive within these limits, mm/s and mm/s²
    /// ([`DriveLimits`]): with every snapshot one of those present, in turn. Before the first call they are
    /// told nothing.
    pub fn limit(&mut self, speed: u16, acceleration: u16) {
        self.limits = Some([speed, acceleration]);
    }

    fn welcome(&mut self, now: Instant, robot: RobotId) {
        if let Some(welcome) = self.link.welcome(robot) {
            self.robots[robot.index()].welcomed(now);
            self.send_message(now, To::One(robot), &HostMessage::Welcome(welcome));
        }
    }

    fn send_message(&mut self, now: Instant, to: To, message: &HostMessage) {
        let packet = self.link.seal(now, message);
        for robot in RobotId::all() {
            if matches!(to, To::All) || to == To::One(robot) {
                self.robots[robot.index()].sent(now, packet.len());
            }
        }
        self.push(to, packet);
    }

    fn relay(&mut self, now: Instant, from: RobotId, packet: &[u8]) {
        let Ok(packet) = Packet::from_slice(packet) else { return };
        if !self.robots[from.index()].is_present(now) {
            return;
        }
        match self.settings.relay {
            Relay::No => {}
            Relay::ToAll => self.push(To::All, packet),
            Relay::ToEach => {
                for teammate in RobotId::all().filter(|teammate| *teammate != from) {
                    if self.robots[teammate.index()].is_present(now) {
                        self.push(To::One(teammate), packet.clone());
                    }
                }
            }
        }
    }

    fn push(&mut self, to: To, packet: Packet) {
        if self.out.push_back((to, packet)).is_err() {
            self.dropped = self.dropped.saturating_add(1);
        }
    }
}

/// The robot whose turn it is at that snapshot.
fn nth(audience: Audience, snapshot: u8) -> Option<RobotId> {
    let present = audience.robots().count();
    let turn = usize::from(snapshot).checked_rem(present)?;
    audience.robots().nth(turn)
}

#[cfg(test)]
mod tests;
