//! `host`: sans-IO core of the host: datagrams and times in, packets out (docs/architecture.md §3.1).
//!
//! Call protocol: after every [`Host::handle`] call [`Host::poll_packet`] until `None`, then ask
//! [`Host::poll_timeout`] for the next deadline. It plans when a camera frame arrives, not on a period of its
//! own: that would make every command half a period older. The same inputs at the same times give the same
//! packets: a trace of the inputs is a recording of the decisions.

mod calibration;
mod change;
mod commands;
mod input;
mod settings;
mod state;
mod test;

use casebase::CaseBase;
use geometry::{GoalEnd, Point};
use protocol::decision::{Assembler, DecisionReport};
use protocol::host::{Condition, Directive, RuleRole, Telemetry};
use protocol::link::Packet;
use protocol::team::{Beacon, PRESENCE_LEASE, Progress};
use protocol::{Duration, Instant, RobotId};
use rules::{Colour, FieldSpec, League, Limits, Phase};
use ssl::Message;

use crate::config::DriveSettings;
use crate::external::External;
use crate::field_geometry::VisionGeometry;
use crate::learned::Learned;
use crate::radio::{self, Radio, RadioSituation, To};
use crate::referee::team_port::TeamPortRequest;
use crate::referee::{Listener, SenderAddress};
use crate::requests::Requests;
use crate::robot_test::RobotTest;
use crate::strategy::counters::Bookkeeper;
use crate::strategy::proposal::proposal;
use crate::strategy::stakes::{Stakes, time_left};
use crate::strategy::view::{CaseNext, RobotSet, ViewGame};
use crate::strategy::{Coach, Flip, Orders, View};
use crate::tracking::HiddenBall;
use crate::tracking::{self, Tracker};
use crate::world::{Ball, World};

pub use input::{Input, InputVerdict, Undecodable};
pub use settings::HostSettings;

/// The limits used for a league that defines none.
const LIMITS: Limits = match League::DivisionB.limits() {
    Some(limits) => limits,
    None => panic!("division B has limits"),
};
/// Minimum time between plans: four cameras that look at once give one plan, not four; half a period of 100
/// Hz.
const PLAN_EVERY: Duration = Duration::millis(5);
/// Relative change of the ball's deceleration from which tables are computed again.
const ROLL_CHANGE_MIN: f32 = 0.05;
/// A ball not seen for this time counts as hidden: the cameras' delay and a few frames.
const BALL_VISIBLE_WITHIN: Duration = Duration::millis(120);
/// The tracker's confidence in a ball that it has followed for a tenth of a second.
const BALL_CONFIDENCE_MIN: f32 = 0.6;

/// Orders that replace the coach's: robot, its role, and its directive.
pub type Drill = heapless::Vec<(RobotId, RuleRole, Directive), { RobotId::COUNT }>;

/// The host of one team: all state from vision to radio.
#[derive(Clone, Debug)]
pub struct Host {
    settings: HostSettings,
    /// The case base in the robots, to look up the case that they report.
    cases: CaseBase<'static>,
    tracker: Tracker,
    geometry: VisionGeometry,
    listener: Listener,
    radio: Radio,
    coach: Coach,
    external: Option<External>,
    robots: [Known; RobotId::COUNT],
    world: World,
    hidden: HiddenBall,
    orders: Orders,
    planned: Option<Instant>,
    /// When the newest camera frame came.
    last_camera_frame: Option<Instant>,
    /// When it last planned because of the referee.
    replanned: Option<Instant>,
    /// The referee's phase in the newest orders.
    ordered: Phase<Colour>,
    undecodable: Undecodable,
    halted: bool,
    /// Set in place of the coach's orders.
    drill: Option<Drill>,
    test: Option<RobotTest>,
    books: Bookkeeper,
    requests: Requests,
    learned: Learned,
    /// The deceleration of a rolling ball that it uses, where that is not from vision.
    roll: Option<f32>,
    /// Robots whose kicker's gain was set while it ran: what is learned does not replace it.
    gain_set: RobotSet,
}

/// Newest reports of one of our robots.
#[derive(Clone, Debug, Default)]
struct Known {
    beacon: Option<(Instant, Beacon)>,
    telemetry: Option<(Instant, Telemetry)>,
    /// When its sensor detected the ball last.
    felt: Option<Instant>,
    assembler: Assembler,
    decision: Option<DecisionReport>,
}

impl Host {
    /// A host that starts at `now`.
    pub fn new(settings: HostSettings, now: Instant) -> Self {
        let roll = settings.roll;
        let cases = settings.case_base();
        let mut host = Self {
            listener: Listener::new(
                settings.league.limits().unwrap_or(LIMITS),
                settings.referee.clone(),
                now,
            )
            .on_silence(settings.referee_silence),
            radio: Radio::new(settings.radio),
            tracker: Tracker::default(),
            geometry: VisionGeometry::default(),
            coach: Coach::new(settings.team, settings.tactics, settings.league).playing(cases),
            external: settings.external.then(|| External::new(settings.league)),
            robots: Default::default(),
            world: World::default(),
            hidden: HiddenBall::default(),
            orders: Orders::new(),
            planned: None,
            last_camera_frame: None,
            replanned: None,
            ordered: Phase::Halt,
            undecodable: Undecodable::default(),
            halted: false,
            drill: None,
            test: None,
            books: Bookkeeper::default(),
            requests: Requests::default(),
            cases,
            learned: Learned::default(),
            roll: None,
            gain_set: RobotSet::default(),
            settings,
        };
        if host.settings.limits != DriveSettings::default() {
            host.send_limits();
        }
        if let Some(roll) = roll {
            host.roll_with(roll);
        }
        host
    }

    /// Handles an input or a deadline.
    pub fn handle(&mut self, now: Instant, input: Input<'_>) -> InputVerdict {
        match input {
            Input::Vision(bytes) => self.handle_vision(now, bytes),
            Input::Referee(bytes, from) => self.handle_referee(now, bytes, from),
            Input::Robot(bytes) => self.handle_robot(now, bytes),
            Input::Orders(line) => self.handle_orders(now, line),
            Input::Parameter(json) => self.handle_parameter(json),
            Input::Test(json) => self.handle_test(now, json),
            Input::Halt => {
                self.halt(now);
                InputVerdict::Halted
            }
            Input::Timeout => {
                self.expire_hand(now);
                self.radio.handle_timeout(now);
                InputVerdict::Timeout
            }
        }
    }

    /// Halts our robots for the rest of the run, independent of the referee.
    fn halt(&mut self, now: Instant) {
        if !std::mem::replace(&mut self.halted, true) {
            self.radio.hasten(now);
        }
        self.plan(now);
    }

    /// From the next plan on robots get these orders and no others, independent of the coach; `None`: the
    /// coach's again. Phase and governor bind them as ever. For drills of single skills.
    pub fn drill(&mut self, orders: Option<Drill>) {
        self.drill = orders;
    }

    /// The next packet for the robots.
    pub fn poll_packet(&mut self) -> Option<(To, Packet)> {
        self.radio.poll_packet()
    }

    /// The next request to send to the game controller's port for teams.
    pub fn poll_request(&mut self) -> Option<TeamPortRequest> {
        self.requests.poll()
    }

    /// When the next [`Input::Timeout`] is due, unless another input comes before.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let hand = self.test.as_ref().and_then(RobotTest::until);
        self.radio.poll_timeout().into_iter().chain(hand).min()
    }

    fn handle_vision(&mut self, now: Instant, bytes: &[u8]) -> InputVerdict {
        let Ok(mut packet) = ssl::vision::WrapperPacket::decode(bytes) else {
            self.undecodable.vision += 1;
            return InputVerdict::Undecodable;
        };
        self.undecodable.empty += u64::from(packet.geometry.is_none() && packet.detection.is_none());
        if let Some(data) = &packet.geometry {
            // A field that is refused is counted by the geometry; the previous field is kept.
            let _verdict = self.geometry.receive(data);
        }
        if let Some(frame) = packet.detection.as_mut().filter(|_| !self.settings.practice.is_all()) {
            self.settings.practice.filter(frame, self.settings.us);
        }
        let received = self.tracker.handle(&packet, now);
        let changes =
            !matches!(received, tracking::VisionVerdict::NoImage | tracking::VisionVerdict::Repeated);
        if changes {
            self.last_camera_frame = Some(now);
        }
        if changes && self.planned.is_none_or(|last| now.since(last) >= PLAN_EVERY) {
            self.plan(now);
        }
        InputVerdict::Vision(received)
    }

    fn handle_referee(&mut self, now: Instant, bytes: &[u8], from: SenderAddress) -> InputVerdict {
        let Ok(packet) = ssl::referee::Referee::decode(bytes) else {
            self.undecodable.referee += 1;
            return InputVerdict::Undecodable;
        };
        let before = self.listener.game().phase;
        let ball = visible_place(now, self.tracker.world(now).ball);
        let verdict = self.listener.receive(&packet, from, now, ball);
        let phase = self.listener.game().phase;
        let lately = self.replanned.is_some_and(|last| now.since(last) < PLAN_EVERY);
        if phase == Phase::Halt && self.ordered != Phase::Halt {
            // HALT waits neither for the next camera frame nor for the radio's rate.
            self.radio.hasten(now);
            self.replan(now);
        } else if phase != before && !lately {
            self.replan(now);
        }
        InputVerdict::Referee(Box::new(verdict))
    }

    fn handle_robot(&mut self, now: Instant, bytes: &[u8]) -> InputVerdict {
        match self.radio.handle_packet(now, bytes) {
            Ok(radio::RadioReceived::Beacon(robot, beacon)) => {
                self.robots[robot.index()].beacon = Some((now, beacon));
                InputVerdict::Robot(robot)
            }
            Ok(radio::RadioReceived::Telemetry(robot, telemetry)) => {
                let known = &mut self.robots[robot.index()];
                if telemetry.condition.has(Condition::BALL_CONTACT) {
                    known.felt = Some(now);
                }
                known.telemetry = Some((now, telemetry));
                InputVerdict::Robot(robot)
            }
            Ok(
                radio::RadioReceived::Handshake(robot)
                | radio::RadioReceived::Version(robot, _)
                | radio::RadioReceived::Parts(robot, _)
                | radio::RadioReceived::Station(robot, _),
            ) => InputVerdict::Robot(robot),
            Ok(radio::RadioReceived::Decision(robot, part)) => {
                let known = &mut self.robots[robot.index()];
                if let Some(report) = known.assembler.receive(&part) {
                    known.decision = Some(self.radio.numbers().report(report));
                }
                InputVerdict::Robot(robot)
            }
            Err(refusal) => InputVerdict::Refused(refusal),
        }
    }

    /// Orders because the referee's phase changed. At most at the rate of camera frames, except for HALT:
    /// alternating forged packets must not load the processor.
    fn replan(&mut self, now: Instant) {
        self.replanned = Some(now);
        self.plan(now);
    }

    /// Plans orders for the present field and sends them.
    fn plan(&mut self, now: Instant) {
        self.planned = Some(now);
        let snapshot = self.tracker.snapshot();
        self.world = snapshot.at(now);
        // Only a visible ball counts as moved: the place of a hidden one is an estimate.
        self.listener.tick(now, visible_place(now, self.world.ball));
        self.remember_ball(now);
        // One that rolled out of sight is not followed there.
        self.world.ball = self.world.ball.take().filter(|ball| self.settings.practice.holds(ball.position));
        let us = self.settings.us;
        let game = self.our_game();
        let view = View::of(&self.world, us, &game, self.field(), self.fit(now))
            .allowing(self.allowed(us))
            .allowing_them(self.allowed(us.other()))
            .proposing(self.proposed(now, Flip::defending(game.defending)));
        let never_answered = self.never_answered(&view.field, game.defending);
        let view = View {
            never_answered,
            in_play: self.in_play(now),
            contact: self.in_contact(now),
            knows_cases: self.knows_cases(now),
            ..view
        };
        self.orders = self.coach.decide(&view);
        if let Some(external) = &mut self.external {
            self.orders = external.plan(&view, std::mem::take(&mut self.orders));
        }
        if let Some(test) = &mut self.test {
            self.orders = test.plan(&view, std::mem::take(&mut self.orders));
        }
        if !self.halted {
            self.requests.look(&view, self.listener.game().team(us).substitutions_left);
        }
        let flip = Flip::defending(game.defending);
        self.books.note((&self.world, &view, &view.field), (us, flip), &self.orders, self.coach.take_sent());
        let commands = self.commands(&game);
        self.learned.see(now, (&snapshot, us), game.phase, &commands);
        if let Some(test) = &mut self.test {
            test.see(now, &snapshot, us, &commands);
        }
        if self.settings.learns
            && let Some(known) = self.learned.friction()
            && self.roll.is_none_or(|roll| (known.value - roll).abs() > roll * ROLL_CHANGE_MIN)
        {
            self.roll_with(known.value);
        }
        self.ordered = self.listener.game().phase;
        let situation = RadioSituation { us, phase: game.phase, placement: game.placement };
        self.radio.offer(now, &self.world, situation, &commands);
    }

    /// Number of robots of our colour on the field that have not reported since this host started.
    fn never_answered(&self, field: &FieldSpec, defending: GoalEnd) -> usize {
        let on_field =
            self.world.ours(self.settings.us).filter(|robot| field.counts(defending, robot.pose.position));
        on_field.filter(|robot| !self.robots[robot.who.id.index()].has_reported()).count()
    }

    /// Estimates the place of a ball that no camera sees.
    fn remember_ball(&mut self, now: Instant) {
        let feels = |robot: RobotId| self.robots[robot.index()].feels(now);
        self.hidden.fill(now, &mut self.world, self.settings.us, self.listener.game(), feels);
    }

    /// Our robots whose sensors feel the ball, as they reported.
    fn in_contact(&self, now: Instant) -> RobotSet {
        let mut set = RobotSet::default();
        for robot in RobotId::all().filter(|robot| self.robots[robot.index()].feels(now) == Some(true)) {
            set.insert(robot);
        }
        set
    }

    fn our_game(&self) -> ViewGame {
        let (us, game) = (self.settings.us, self.listener.game());
        ViewGame {
            phase: if self.halted { Phase::Halt } else { game.phase.seen_by(us) },
            next: game.next.map(|phase| phase.seen_by(us)),
            placement: game.ball_goes_to(),
            defending: game.own_goal(us).unwrap_or(self.settings.defending),
            keeper: game.team(us).keeper.unwrap_or(self.settings.keeper),
            their_keeper: game.team(us.other()).keeper.unwrap_or(self.settings.keeper),
            stakes: if self.settings.tactics.by_score { self.stakes() } else { Stakes::EVEN },
        }
    }

    /// Worths of goals by score and time left.
    fn stakes(&self) -> Stakes {
        let (us, game) = (self.settings.us, self.listener.game());
        let score = |colour| i32::try_from(game.team(colour).score).unwrap_or(i32::MAX);
        let ahead = score(us).saturating_sub(score(us.other()));
        time_left(game.stage, game.stage_time_left).map_or(Stakes::EVEN, |left| Stakes::of(ahead, left))
    }

    /// Number of robots the referee allows a team.
    fn allowed(&self, team: Colour) -> usize {
        self.listener.game().team(team).robots_allowed.map_or(RobotId::COUNT, |n| n as usize)
    }

    /// Robots that receive the host and are upright.
    fn fit(&self, now: Instant) -> RobotSet {
        let mut fit = RobotSet::default();
        for robot in self.radio.present(now) {
            let lies =
                self.telemetry(robot).is_some_and(|reported| reported.condition.has(Condition::TIPPED));
            if !lies {
                fit.insert(robot);
            }
        }
        fit
    }

    /// Robots that play a case now, as they report.
    fn in_play(&self, now: Instant) -> RobotSet {
        let mut playing = RobotSet::default();
        for robot in RobotId::all() {
            let Some((received, beacon)) = &self.robots[robot.index()].beacon else { continue };
            let part =
                beacon.cycle.as_ref().and_then(|cycle| cycle.play()).and_then(|play| play.part_of(robot));
            let busy = !matches!(beacon.progress, Progress::WaitEnd { .. } | Progress::Idle);
            if now.since(*received) < PRESENCE_LEASE && part.is_some() && busy {
                playing.insert(robot);
            }
        }
        playing
    }

    /// Robots that carry the case base that this host knows.
    fn knows_cases(&self, now: Instant) -> RobotSet {
        let mut knowing = RobotSet::default();
        for robot in RobotId::all() {
            let Some((received, beacon)) = &self.robots[robot.index()].beacon else { continue };
            if now.since(*received) < PRESENCE_LEASE && beacon.case_base == self.cases.hash() {
                knowing.insert(robot);
            }
        }
        knowing
    }

    /// What the case that our robots play does next with the ball, where the tactics include the bridge.
    fn proposed(&self, now: Instant, flip: Flip) -> Option<CaseNext> {
        if !self.settings.tactics.bridge {
            return None;
        }
        let fresh = RobotId::all().filter_map(|robot| {
            let (received, beacon) = self.robots[robot.index()].beacon.as_ref()?;
            (now.since(*received) < PRESENCE_LEASE).then_some((robot, beacon))
        });
        let reported: heapless::Vec<_, { RobotId::COUNT }> = fresh.collect();
        proposal(&self.cases, &reported, flip)
    }
}

/// The ball's place if cameras see it; the estimated place of a hidden ball does not count.
fn visible_place(now: Instant, ball: Option<Ball>) -> Option<Point<geometry::Field>> {
    ball.filter(|ball| now.since(ball.seen) < BALL_VISIBLE_WITHIN && ball.confidence > BALL_CONFIDENCE_MIN)
        .map(|ball| ball.position)
}

#[cfg(test)]
mod tests;
