//! `test_field`: test bench: brains on wheels in the simulator, commanded by the test.
//!
//! Every brain gets snapshots of the true state, rounded as in the wire format, 75 a second, and the command
//! that the test set. SI units, field frame; a step is 10 ms. No camera, no noise of snapshots, no radio:
//! these have tests of their own.

use std::collections::BTreeMap;

use brain::{Brain, BrainConfig};
use casebase::CaseBase;
use geometry::{Field, GoalEnd, Point, Pose, Vector};
use hil_sim::small_size::{Ball, Parameters, PhysicsEvent, Robot, World};
use protocol::host::{
    Directive, HostCommand, HostMessage, PART_ROBOTS_MAX, RuleRole, Telemetry, WireBall, WireRobot, WireWho,
    WorldPart,
};
use protocol::quantized::{WirePoint, WirePose, to_mm};
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::team::{Beacon, Closure, CycleState, Decision, Progress, Role, Status, TeamMessage};
use protocol::{CycleId, Duration, Instant, RobotId, TeamId, Who};
use rules::{Colour, League, Phase, Side};

/// A field with our robots under brains, and opponents where the test places them.
pub struct TestField<'a> {
    /// True state of ball and robots.
    pub world: World,
    /// The phase of the game, from our side.
    pub phase: Phase<Side>,
    /// Target position of a ball placement.
    pub placement: Option<Point<Field>>,
    /// The command of each of our robots.
    pub commands: BTreeMap<RobotId, (RuleRole, Directive)>,
    /// Brains of our robots, by number.
    pub brains: BTreeMap<RobotId, Brain<'a>>,
    /// Events, with the time, s.
    pub events: Vec<(f64, PhysicsEvent)>,
    /// The newest order of each of ours.
    pub orders: BTreeMap<RobotId, ActuatorFrame>,
    /// Ends of cycles, as reported by any robot.
    pub ends: Vec<(CycleId, Closure)>,
    /// The last telemetry of each of our robots, with its time.
    pub telemetry: BTreeMap<RobotId, (Instant, Telemetry)>,
    /// Whether the host sends nothing.
    pub silent: bool,
    /// Number of teammates that do not play but send a beacon in each step.
    pub chatter: u8,
    steps: u64,
    snapshot: u8,
    air: Vec<(RobotId, TeamMessage)>,
}

impl<'a> TestField<'a> {
    /// Our robots (blue) at these poses (x, y in m, degrees), and a resting ball.
    pub fn new(league: League, base: CaseBase<'a>, ball: (f32, f32), ours: &[(u8, f32, f32, f32)]) -> Self {
        let parameters = Parameters::of(league).expect("a Small Size league");
        let mut world = World::new(league, parameters, 1);
        world.put_ball(Ball::at(Point::new(ball.0, ball.1)));
        let mut brains = BTreeMap::new();
        for &(number, x, y, degrees) in ours {
            let id = RobotId::new(number).expect("an id");
            world.put(Who { colour: Colour::Blue, id }, pose(x, y, degrees));
            let config = BrainConfig::hosted(id, TeamId(1), league);
            brains.insert(id, Brain::new(Instant(0), &config, base));
        }
        Self {
            world,
            phase: Phase::Run,
            placement: None,
            commands: BTreeMap::new(),
            brains,
            events: Vec::new(),
            orders: BTreeMap::new(),
            ends: Vec::new(),
            telemetry: BTreeMap::new(),
            silent: false,
            chatter: 0,
            steps: 0,
            snapshot: 0,
            air: Vec::new(),
        }
    }

    /// Places a standing opponent.
    pub fn opponent(&mut self, number: u8, x: f32, y: f32, degrees: f32) {
        let id = RobotId::new(number).expect("an id");
        self.world.put(Who { colour: Colour::Yellow, id }, pose(x, y, degrees));
    }

    /// Makes the ball roll.
    pub fn roll(&mut self, at: (f32, f32), velocity: (f32, f32)) {
        self.world.put_ball(Ball::rolling(Point::new(at.0, at.1), Vector::new(velocity.0, velocity.1)));
    }

    /// Sets the command of robot `number`.
    pub fn give_order(&mut self, number: u8, rule_role: RuleRole, directive: Directive) {
        self.commands.insert(RobotId::new(number).expect("an id"), (rule_role, directive));
    }

    /// Time of the present step, µs since the start.
    pub fn now(&self) -> Instant {
        Instant(self.steps * 10_000)
    }

    /// The true state of one of our robots.
    pub fn ours(&self, number: u8) -> &Robot {
        let id = RobotId::new(number).expect("an id");
        self.world.robot(Who { colour: Colour::Blue, id }).expect("a robot of ours")
    }

    /// The true position of the ball.
    pub fn ball(&self) -> Point<Field> {
        self.world.ball.position
    }

    /// The brain of one of ours.
    pub fn brain(&self, number: u8) -> &Brain<'a> {
        &self.brains[&RobotId::new(number).expect("an id")]
    }

    /// Steps until `done`, at most for `seconds`; returns the duration, s.
    pub fn until(&mut self, seconds: f32, mut done: impl FnMut(&Self) -> bool) -> Option<f32> {
        let start = self.steps;
        while (self.steps - start) as f32 * 0.01 < seconds {
            self.step();
            if done(self) {
                return Some((self.steps - start) as f32 * 0.01);
            }
        }
        None
    }

    /// Steps for `seconds`, calling `look` in every step.
    pub fn during(&mut self, seconds: f32, mut look: impl FnMut(&Self)) {
        self.until(seconds, |field| {
            look(field);
            false
        });
    }

    /// Every kick of ours so far: the robot, and the ball's speed after it, m/s.
    pub fn kicks(&self) -> Vec<(RobotId, f32, Vector<Field>)> {
        let kick = |(_, event): &(f64, PhysicsEvent)| match *event {
            PhysicsEvent::Kicked { robot, speed, velocity, .. } if robot.colour == Colour::Blue => {
                Some((robot.id, speed, velocity))
            }
            _ => None,
        };
        self.events.iter().filter_map(kick).collect()
    }

    /// Messages of our robots in the last step.
    pub fn sent_messages(&self) -> &[(RobotId, TeamMessage)] {
        &self.air
    }

    /// One step of 10 ms of everything.
    pub fn step(&mut self) {
        self.steps += 1;
        let now = self.now();
        if !self.silent && !self.steps.is_multiple_of(4) {
            self.show(now);
        }
        let mut received = std::mem::take(&mut self.air);
        let unauthenticated = RobotId::all().skip(RobotId::COUNT - usize::from(self.chatter));
        received.extend(unauthenticated.map(|id| (id, TeamMessage::Beacon(IDLE))));
        for (&id, brain) in &mut self.brains {
            while let Some(due) = brain.poll_timeout().filter(|due| *due <= now) {
                brain.handle_timeout(due);
            }
            for (from, message) in received.iter().filter(|(from, _)| *from != id) {
                brain.handle_team_message(now, *from, message);
            }
            let who = Who { colour: Colour::Blue, id };
            let Some(sensors) = self.world.sensors(who) else { continue };
            brain.handle_sensors(now, &sensors);
            while let Some(message) = brain.poll_message(now) {
                match &message {
                    TeamMessage::Beacon(beacon) => {
                        if let Some(CycleState { id, decision: Decision::Closed(end), .. }) = &beacon.cycle
                            && !self.ends.contains(&(*id, *end))
                        {
                            self.ends.push((*id, *end));
                        }
                    }
                    TeamMessage::Telemetry(telemetry) => {
                        self.telemetry.insert(id, (now, *telemetry));
                    }
                    // Handled by the link, and by the host: there are none here.
                    TeamMessage::Handshake(_) | TeamMessage::Decision(_) => {}
                }
                self.air.push((id, message));
            }
            if let Some(order) = brain.poll_actuators(now) {
                self.world.command(who, &order);
                self.orders.insert(id, order);
            }
        }
        for _ in 0..10 {
            self.world.step();
        }
        let mut events = Vec::new();
        self.world.take_events(&mut events);
        let time = self.world.time();
        self.events.extend(events.into_iter().map(|event| (time, event)));
    }

    /// Sends a snapshot to all robots, and a command to each.
    fn show(&mut self, now: Instant) {
        self.snapshot = self.snapshot.wrapping_add(1);
        let ball = &self.world.ball;
        let ball = Some(WireBall {
            at: ball.position.into(),
            height: (ball.height * 1000.0) as u16,
            vx: to_mm(ball.velocity.x()),
            vy: to_mm(ball.velocity.y()),
        });
        let robots: Vec<WireRobot> = self.world.robots().iter().map(wire).collect();
        let parts = robots.chunks(PART_ROBOTS_MAX);
        let count = parts.len() as u8;
        let messages: Vec<HostMessage> = (0..count)
            .zip(parts)
            .map(|(part, robots)| {
                HostMessage::World(WorldPart {
                    snapshot: self.snapshot,
                    part,
                    parts: count,
                    phase: self.phase,
                    placement: self.placement.map(Into::into),
                    ball,
                    robots: robots.iter().copied().collect(),
                })
            })
            .collect();
        for (&id, brain) in &mut self.brains {
            for message in &messages {
                brain.handle_host_message(now, Duration(0), message);
            }
            if let Some((rule_role, directive)) = self.commands.get(&id) {
                let command = HostCommand {
                    to: id,
                    defending: GoalEnd::Negative,
                    phase: self.phase,
                    rule_role: *rule_role,
                    directive: directive.clone(),
                };
                brain.handle_host_message(now, Duration(0), &HostMessage::Command(command));
            }
        }
    }
}

/// Beacon of a robot that is present but does not play.
const IDLE: Beacon = Beacon {
    pose: WirePose { at: WirePoint { x: 0, y: 0 }, heading: 0 },
    ball: None,
    status: Status(0),
    case_base: 0,
    cycle: None,
    progress: Progress::Idle,
    role: Role::None,
};

/// A pose of metres and degrees.
pub fn pose(x: f32, y: f32, degrees: f32) -> Pose<Field> {
    Pose::from_mm_deg(x * 1000.0, y * 1000.0, degrees)
}

/// Whether that order kicks.
pub fn kicks(order: &ActuatorFrame) -> bool {
    matches!(order, ActuatorFrame::Omni { kick: OmniKick::Flat(_) | OmniKick::Chip(_), .. })
}

fn wire(robot: &Robot) -> WireRobot {
    let side = if robot.who.colour == Colour::Blue { Side::Ours } else { Side::Theirs };
    WireRobot {
        who: WireWho { side, id: robot.who.id },
        pose: robot.pose.into(),
        vx: to_mm(robot.velocity.x()),
        vy: to_mm(robot.velocity.y()),
    }
}
