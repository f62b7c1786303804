//! The brain as a value: inputs, outputs, and the order of its steps (docs/architecture.md §3.1).
//!
//! One mutation, then drain: after every `handle_…` call `poll_message` until `None`, then `poll_actuators`,
//! then read the next deadline from `poll_timeout`.

mod act;
mod coordinate;
mod explained;
mod telemeter;

use casebase::{CaseBase, Problem};
use protocol::host::HostMessage;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::team::{Decision, PRESENCE_LEASE, TeamMessage};
use protocol::{CycleId, Duration, Instant, RobotId};

use crate::abilities::{self, Abilities};
use crate::actuation::Actuation;
use crate::belief::Belief;
use crate::body::Intent;
use crate::config::{Approach, BrainConfig};
use crate::directive::TaskState;
use crate::execution::Execution;
use crate::governor::Ruling;
use crate::hosted::Hosted;
use crate::reactive::Reactive;
use crate::team::monitor::Monitor;
use crate::team::{Cycle, retrieval};
use crate::teammates::Teammates;
use crate::timer::{Timer, TimerTable};
use explained::Explained;
use telemeter::Spoken;

/// Inputs since the last step, besides time.
#[derive(Clone, Copy, Debug, Default)]
struct Since {
    /// Instructions that they took, by estimate.
    effort: u32,
    /// Those of them that the host's packets took.
    host_effort: u32,
    /// Whether it has retrieved.
    retrieved: bool,
    /// A gameplay has started or ended.
    gameplay_changed: bool,
}

/// Kind of a packet, by its header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PacketKind {
    /// The host's to this robot.
    Command,
    /// The host's to several robots.
    Snapshot,
    /// A teammate's, or anything else.
    Beacon,
}

/// A robot's brain: sans-IO, all times are arguments.
pub struct Brain<'a> {
    config: BrainConfig,
    body: &'static dyn Abilities,
    base: CaseBase<'a>,
    belief: Belief,
    teammates: Teammates,
    cycle: Cycle,
    execution: Option<Execution>,
    monitor: Monitor,
    reactive: Reactive,
    timers: TimerTable,
    awake: bool,
    /// The closed cycle whose end this robot has announced to its teammates.
    reported_end_of: Option<CycleId>,
    actuation: Actuation,
    host: Option<Hosted>,
    task_state: TaskState,
    /// It took part in election and retrieval in the last step.
    was_available: bool,
    actuators: Option<ActuatorFrame>,
    beacon_due: bool,
    /// Inputs since its last step.
    since: Since,
    /// Number of steps that may still reuse the path before a step must plan: up to [`PATH_REUSES_MAX`].
    reuses_left: u8,
    spoken: Spoken,
    /// Its newest decision, with the problem.
    explained: Option<Explained>,
    /// Number of packets that no step had time to open.
    unopened: u32,
    /// What it has retrieved, where steps are short: the gameplay starts in the next step.
    retrieved: Option<(CycleId, Decision)>,
}

impl<'a> Brain<'a> {
    /// A robot that boots at `now`; it listens for one lease before it is present.
    pub fn new(now: Instant, config: &BrainConfig, base: CaseBase<'a>) -> Self {
        let mut timers = TimerTable::default();
        timers.set(Timer::Boot, now + PRESENCE_LEASE);
        Self {
            config: config.clone(),
            body: abilities::of(config.league),
            base,
            belief: Belief::defending(config.league, config.defending)
                .following_opponents(config.settings.lookahead_s > 0.0),
            teammates: Teammates::default(),
            cycle: Cycle::new(config.robot),
            execution: None,
            monitor: Monitor::default(),
            reactive: Reactive::of(config.league),
            timers,
            awake: false,
            reported_end_of: None,
            actuation: Actuation::of(config.league),
            host: config.hosted.then(|| Hosted::new(config.robot)),
            task_state: TaskState::default(),
            was_available: !config.hosted,
            actuators: None,
            beacon_due: false,
            since: Since::default(),
            reuses_left: PATH_REUSES_MAX,
            spoken: Spoken::default(),
            explained: None,
            unopened: 0,
            retrieved: None,
        }
    }

    /// Whether another packet may be opened before the next step. Where steps are short the others are lost
    /// and counted. A teammate's leaves room for what the host sends in a step, so that no number of beacons
    /// keeps a command or HALT away, which every command repeats; a step that has to plan opens no snapshot,
    /// and others open little more than a whole one.
    pub(crate) fn takes_packet(&mut self, now: Instant, kind: PacketKind) -> bool {
        if !self.has_short_steps() {
            return true;
        }
        let Since { effort, host_effort, gameplay_changed, .. } = self.since;
        let must_plan = self.reuses_left == 0 || self.actuation.needs_time();
        let needs_snapshot = self.host.as_ref().is_some_and(|host| host.needs_snapshot(now));
        let parts = self.host.as_ref().and_then(Hosted::parts_of_snapshot);
        let takes = match kind {
            PacketKind::Command => effort < INPUTS_MAX,
            PacketKind::Snapshot => {
                (!must_plan || needs_snapshot) && effort < parts.map_or(INPUTS_MAX, inputs_of_snapshot_max)
            }
            PacketKind::Beacon => {
                let gameplay = if gameplay_changed { 0 } else { EFFORT_OF_GAMEPLAY };
                let most = if must_plan { INPUTS_OF_PLAN_MAX } else { INPUTS_MAX - gameplay };
                effort + HOST_INPUTS.saturating_sub(host_effort) < most
            }
        };
        if takes {
            self.charge(EFFORT_OF_PACKET, kind);
        } else {
            self.note_unopened();
            self.unopened = self.unopened.saturating_add(1);
            // What a step that has to plan leaves to the next ones is no flood.
            if !must_plan || kind == PacketKind::Command {
                self.spoken.leave_unopened(now, kind != PacketKind::Command);
            }
        }
        takes
    }

    /// Accounts for a packet that was opened, whatever its tag was.
    pub(crate) fn note_opened(&mut self, kind: PacketKind) {
        let effort = match kind {
            PacketKind::Beacon => EFFORT_OF_FRAME,
            PacketKind::Command => EFFORT_OF_COMMAND,
            PacketKind::Snapshot => EFFORT_OF_SNAPSHOT,
        };
        self.charge(effort, kind);
    }

    /// Accounts for a packet that was not opened.
    pub(crate) fn note_unopened(&mut self) {
        self.since.effort += EFFORT_OF_UNOPENED;
    }

    fn charge(&mut self, instructions: u32, kind: PacketKind) {
        self.since.effort += instructions;
        if kind != PacketKind::Beacon {
            self.since.host_effort += instructions;
        }
    }

    /// Handles a teammate's beacon.
    pub fn handle_team_message(&mut self, now: Instant, from: RobotId, message: &TeamMessage) {
        // Teammates' messages to the host are not for this robot.
        let TeamMessage::Beacon(beacon) = message else { return };
        self.timers.advance(now);
        // Before the first beacon of its proposer a cycle may be older than this boot epoch.
        let from_start = self.awake
            && beacon.cycle.as_ref().is_some_and(|state| self.teammates.has_received(state.id.proposer));
        self.teammates.receive(now, from, beacon);
        if self.config.approach != Approach::Reactive
            && let Some(state) = &beacon.cycle
        {
            self.adopt(now, state, from_start);
        }
    }

    /// Handles the host's message, sent at most `age` ago; a robot that expects no host ignores it.
    pub fn handle_host_message(&mut self, now: Instant, age: Duration, message: &HostMessage) {
        let Some(host) = &mut self.host else { return };
        self.timers.advance(now);
        if let Some(received) = host.handle(now, age, message) {
            self.actuation.receive_host(received);
        }
    }

    /// A host that was not trusted before leads from now on.
    pub fn handle_new_host(&mut self) {
        if let Some(host) = &mut self.host {
            host.restart();
            self.spoken.owes_telemetry();
        }
    }

    /// Handles a sensor frame: one whole step.
    pub fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.timers.advance(now);
        self.teammates.forget_the_silent(now);
        // The host overrides own sensors and teammates' reports (docs/architecture.md §3.1): a robot led by a
        // host does not use them.
        match &mut self.host {
            Some(host) => host.see(now, sensors, &mut self.belief),
            None => self.belief.update(now, self.config.robot, sensors, &self.teammates),
        }
        let effort = self.since.effort;
        let is_busy = self.has_short_steps()
            && effort > INPUTS_OF_PLAN_MAX
            && (self.reuses_left > 0 || effort > INPUTS_OF_LEAST_PLAN_MAX);
        if !is_busy {
            self.coordinate(now);
        }
        self.beacon_due |= self.spoken.has_turn(self.config.robot, self.actuation.beacon_steps());
        let intent = self.intent(now, is_busy);
        let Self { actuation, belief, teammates, host, .. } = self;
        self.actuators = Some(actuation.act(now, belief, teammates, host.as_ref(), sensors, intent));
        self.spoken.sense(sensors);
    }

    /// What it wants of its body. A step does not both plan and do something else that takes long: a step in
    /// which a gameplay starts or ends stands; where steps are short, one that retrieved or received many
    /// frames reuses its path.
    fn intent(&mut self, now: Instant, is_busy: bool) -> Intent {
        let since = core::mem::take(&mut self.since);
        let speaks = self.beacon_due || self.spoken.is_silent_for_long(now);
        let message = if speaks { EFFORT_OF_MESSAGE } else { 0 };
        self.actuation.set_spent(since.effort + message);
        if since.gameplay_changed {
            Intent::Stand { face: None }
        } else if is_busy || self.has_short_steps() && since.retrieved {
            self.reuses_left = self.reuses_left.saturating_sub(1);
            Intent::KeepPath
        } else {
            let more = if self.reuses_left == 0 { PATH_REUSES } else { 1 };
            self.reuses_left = PATH_REUSES_MAX.min(self.reuses_left + more);
            self.act(now)
        }
    }

    /// Handles a deadline of [`Brain::poll_timeout`].
    pub fn handle_timeout(&mut self, now: Instant) {
        self.timers.advance(now);
        // Its consequences follow in the next step where that is near.
        if self.has_short_steps() {
            return;
        }
        self.teammates.forget_the_silent(now);
        self.coordinate(now);
    }

    /// The next message to teammates.
    pub fn poll_message(&mut self, now: Instant) -> Option<TeamMessage> {
        if !core::mem::take(&mut self.beacon_due) {
            let telemetry = self.telemetry(now).map(TeamMessage::Telemetry);
            return telemetry.or_else(|| self.explanation(now).map(TeamMessage::Decision));
        }
        self.spoken.beacon(now);
        let beacon = self.beacon(now);
        if self.cycle.closure().is_some() && self.reported_end_of != self.cycle.id() {
            // The end is announced before the next cycle starts: a teammate that receives only the start
            // would not know why.
            self.reported_end_of = self.cycle.id();
            // One message a step where steps are short: sealing costs time, and the next step comes soon.
            if !self.has_short_steps() {
                self.coordinate(now);
            }
        }
        Some(TeamMessage::Beacon(beacon))
    }

    /// The actuator orders, once per step.
    pub fn poll_actuators(&mut self, _now: Instant) -> Option<ActuatorFrame> {
        self.actuators.take()
    }

    /// Time at which [`Brain::handle_timeout`] must be called.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.timers.next()
    }

    /// Whether its body's steps are short, so that work is spread over several.
    pub(crate) fn has_short_steps(&self) -> bool {
        self.actuation.has_short_steps()
    }

    /// Number of packets that were left unopened, because no step had time for them.
    pub fn unopened(&self) -> u32 {
        self.unopened
    }

    /// The robot's world model as of its last step.
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// The governor's decision on the motion wanted in the last step.
    pub fn ruling(&self) -> Ruling {
        self.actuation.ruling()
    }

    /// State of the running cycle.
    pub fn cycle(&self) -> &Cycle {
        &self.cycle
    }

    /// The problem for which it would retrieve now.
    pub fn problem(&self, now: Instant) -> Option<Problem> {
        let Self { config, base, belief, teammates, .. } = self;
        let lookahead = config.settings.lookahead_s;
        retrieval::problem(now, config.robot, base, belief.game.defending, belief, teammates, lookahead)
    }
}

/// Instructions of a packet, and of the frame in it where it is for this robot: opened, and what follows from
/// it. Under QEMU, by two to eleven more packets in a step, with the protocol compiled for speed: a command
/// to another robot took 590, a beacon 1,340, a forged snapshot of 120 B 2,080. Compiled for size, by least
/// squares over 27,249 steps of six images in a match of 60 s, they take 923, 2,493 and 4,175; `EFFORT` of
/// `drivetrain` leaves room for that.
const EFFORT_OF_PACKET: u32 = 590;
const EFFORT_OF_FRAME: u32 = 760;
/// The same of a command: it is as long as a beacon, and all of it is covered by the tag.
const EFFORT_OF_COMMAND: u32 = 900;
/// The same of a part of a snapshot, the longest frame.
const EFFORT_OF_SNAPSHOT: u32 = 1_500;
/// Instructions of a packet that is left unopened: most of them are for handing it over.
const EFFORT_OF_UNOPENED: u32 = 510;
/// Instructions of a beacon that is made and sealed: by least squares over 27,249 steps of six images, 1,832.
const EFFORT_OF_MESSAGE: u32 = 1_850;
/// Instructions of what the host sends to a robot in a step: both parts of a snapshot and a command.
const HOST_INPUTS: u32 = 3 * EFFORT_OF_PACKET + 2 * EFFORT_OF_SNAPSHOT + EFFORT_OF_COMMAND;
/// Instructions of a gameplay that starts or ends.
const EFFORT_OF_GAMEPLAY: u32 = 7_000;
/// Instructions that inputs of a short step take where it plans, to within a packet: both parts of a
/// snapshot, a command and two teammates' beacons, and packets for others between them.
const INPUTS_OF_PLAN_MAX: u32 = 10_500;
/// The same of a plan that tests the straight path only.
const INPUTS_OF_LEAST_PLAN_MAX: u32 = 13_500;
/// Instructions of inputs after which no other packet is opened, from any sender: a step that opens as many
/// reuses its path.
const INPUTS_MAX: u32 = 18_000;
/// Most steps in a row that reuse the path: a cycle's end, a proposal, its answer and teammates' usual
/// beacons between them, twice. Each step that plans adds one again.
const PATH_REUSES_MAX: u8 = 10;
/// Steps between two that plan on a radio channel that is always full, as in division A.
const PATH_REUSES: u8 = 3;

/// Instructions of a short step's inputs after which it opens no part of a snapshot, where a whole snapshot
/// has `parts`: all of them, a command and two teammates' beacons. When the referee's phase changes, the host
/// may send two snapshots within 10 ms: a step that opened both took 40,160 instructions.
fn inputs_of_snapshot_max(parts: u8) -> u32 {
    let part = EFFORT_OF_PACKET + EFFORT_OF_SNAPSHOT;
    let rest = 3 * EFFORT_OF_PACKET + EFFORT_OF_COMMAND + 2 * EFFORT_OF_FRAME;
    (u32::from(parts) * part + rest).min(INPUTS_MAX)
}
