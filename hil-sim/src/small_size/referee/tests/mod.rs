//! Tests: the referee follows the rules. Scripted observations against expected results made by hand.
//!
//! The stage: division B, blue's goal at +x in the first half, yellow kicks off; robots stand where they
//! commit no offence unless a test moves them; the ball keeps its velocity. Steps of 10 ms.

mod areas;
mod goals;
mod manual;
mod metrics;
mod penalties;
mod play;
mod robust;
mod run;
mod stop_rules;
mod wire;
mod world;

use geometry::{Angle, Field, Point, Pose, Vector};
use protocol::{Duration, Instant, RobotId, Who};
use rules::state::GameState;
use rules::{Colour, League, Phase};

use super::*;

struct Stage {
    referee: InternalReferee,
    ball: Option<BallSeen>,
    robots: Vec<RobotSeen>,
    crashes: Vec<CrashSeen>,
    now: Instant,
    step: Duration,
    /// Whether the requested manual acts are carried out.
    obeyed: bool,
    /// Whether robots that the referee waits for move at once to where they have to be.
    obedient: bool,
    orders: Vec<WorldOrder>,
    /// A game state that is updated by the packets alone.
    received: GameState,
    counter: Option<u32>,
    action_left: i64,
    packets: Vec<ssl::referee::Referee>,
}

const STEP: Duration = Duration::millis(10);

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap()
}

fn yellow(number: u8) -> Who {
    Who { colour: Colour::Yellow, id: id(number) }
}

fn blue(number: u8) -> Who {
    Who { colour: Colour::Blue, id: id(number) }
}

fn at(x: f32, y: f32) -> Point<Field> {
    Point::new(x, y)
}

fn settings() -> RefereeSettings {
    RefereeSettings::new(League::DivisionB)
}

/// Before the first observation; keepers in their goals, two more robots of each team at the sides of their
/// own half.
fn stage_with(settings: RefereeSettings) -> Stage {
    let mut stage = Stage {
        referee: InternalReferee::new(settings, 1).unwrap(),
        ball: Some(BallSeen::at(at(0.0, 0.0))),
        robots: Vec::new(),
        crashes: Vec::new(),
        now: Instant(0),
        step: STEP,
        obeyed: true,
        obedient: false,
        orders: Vec::new(),
        received: GameState::new(),
        counter: None,
        action_left: 0,
        packets: Vec::new(),
    };
    for (who, place) in [
        (yellow(0), at(-4.45, 0.0)),
        (yellow(1), at(-2.0, 2.0)),
        (yellow(2), at(-2.0, -2.0)),
        (blue(0), at(4.45, 0.0)),
        (blue(1), at(2.0, 2.0)),
        (blue(2), at(2.0, -2.0)),
    ] {
        stage.put(who, place);
    }
    stage
}

fn stage() -> Stage {
    stage_with(settings())
}

/// Yellow may take its kick-off.
fn kickoff(settings: RefereeSettings) -> Stage {
    let mut stage = stage_with(settings);
    stage.until(Phase::Kickoff(Colour::Yellow), 30.0);
    stage
}

/// The first half runs, the ball lies at the centre, no robot touched it.
fn in_play() -> Stage {
    let mut stage = kickoff(settings());
    stage.put(yellow(1), at(-0.1, 0.0));
    stage.touch(yellow(1));
    stage.kick(0.0, 0.0);
    stage.move_ball(at(0.3, 0.0));
    stage.step();
    assert_eq!(stage.phase(), Phase::Run);
    stage.put(yellow(1), at(-2.0, 2.0));
    stage.touch(blue(1));
    stage
}

/// The ball went out over blue's touch line; yellow has to place it at (1, 2.8).
fn placement() -> Stage {
    let mut stage = in_play();
    stage.kick_from(at(1.0, 2.9), blue(1), [0.0, 5.0]);
    stage.until_stop(1.0);
    stage.put(blue(1), at(2.0, 1.0));
    stage.put(yellow(1), at(-2.0, 1.0));
    stage.until(Phase::BallPlacement(Colour::Yellow), 1.0);
    stage
}

impl Stage {
    fn put(&mut self, who: Who, place: Point<Field>) {
        self.take(who);
        let pose = Pose { position: place, heading: Angle::ZERO };
        self.robots.push(RobotSeen { who, pose, velocity: Vector::default(), touches_ball: false });
    }

    fn take(&mut self, who: Who) {
        self.robots.retain(|robot| robot.who != who);
    }

    fn robot(&mut self, who: Who) -> &mut RobotSeen {
        self.robots.iter_mut().find(|robot| robot.who == who).unwrap()
    }

    fn drive(&mut self, who: Who, x: f32, y: f32) {
        self.robot(who).velocity = Vector::new(x, y);
    }

    /// One step in which that robot touches the ball.
    fn touch(&mut self, who: Who) {
        self.robot(who).touches_ball = true;
        self.step();
        self.robot(who).touches_ball = false;
    }

    fn kick(&mut self, x: f32, y: f32) {
        self.ball_mut().velocity = Vector::new(x, y);
    }

    /// The ball is there, that robot touches it for a step, and it has this velocity, m/s.
    fn kick_from(&mut self, place: Point<Field>, who: Who, [x, y]: [f32; 2]) {
        self.move_ball(place);
        self.touch(who);
        self.kick(x, y);
    }

    /// Steps until the game is stopped, and holds the ball.
    fn until_stop(&mut self, seconds: f32) {
        self.until(Phase::Stop, seconds);
        self.kick(0.0, 0.0);
    }

    fn ball_mut(&mut self) -> &mut BallSeen {
        self.ball.as_mut().unwrap()
    }

    fn move_ball(&mut self, place: Point<Field>) {
        self.ball_mut().position = place;
    }

    fn place_of_ball(&self) -> Point<Field> {
        self.ball.unwrap().position
    }

    fn phase(&self) -> Phase<Colour> {
        self.referee.phase()
    }

    fn step(&mut self) {
        if self.obedient {
            self.make_way();
        }
        self.now += self.step;
        if let Some(ball) = &mut self.ball {
            ball.position += ball.velocity * self.step.as_secs_f32();
        }
        let seen = Observation {
            time: self.now,
            ball: self.ball,
            fastest: 0.0,
            robots: &self.robots,
            crashes: &self.crashes,
        };
        self.referee.observe(&seen);
        self.crashes.clear();
        while let Some(order) = self.referee.poll_order() {
            self.orders.push(order);
            if self.obeyed {
                self.obey(order);
            }
        }
        self.receive_packets();
        let after = self.referee.limits;
        self.received.tick(self.now.0, self.ball.map(|ball| ball.position), &after);
        assert_eq!(self.referee.off_graph(), 0, "off the graph at {:?}", self.now);
        assert_eq!(
            self.received.phase(),
            self.phase(),
            "who hears the packets alone disagrees at {:?}",
            self.now
        );
    }

    /// Moves every robot that the referee waits for to a rule-compliant position of its own.
    fn make_way(&mut self) {
        if let Some(ReadyObstacle { team: Some(team), reason: Reason::NoKeeper, .. }) =
            self.referee.blocked().map(|blocked| blocked.obstacle)
        {
            let keeper = Who { colour: team, id: self.referee.accounts().of(team).keeper };
            self.put(keeper, at(self.referee.own_end(team).sign() as f32 * 4.5, 0.0));
        }
        let waits_for: Vec<Who> =
            self.referee.obstacles(&self.robots).iter().filter_map(ReadyObstacle::who).collect();
        for who in waits_for {
            let side = self.referee.own_end(who.colour).sign() as f32;
            let lane =
                0.35 * f32::from(who.id.number()) - 2.6 + if who.colour == Colour::Blue { 0.17 } else { 0.0 };
            let place = match self.phase() {
                Phase::PreparePenalty(team)
                    if team != who.colour && self.referee.accounts().is_keeper(who) =>
                {
                    at(side * 4.5, 0.0)
                }
                Phase::PreparePenalty(team) => {
                    let back = self.referee.own_end(team).sign() as f32;
                    at(self.place_of_ball().x() + back * 1.5, lane)
                }
                // Beside the ball's lane, in the own half.
                _ => at(side * 2.0, if lane * self.place_of_ball().y() > 0.0 { -lane } else { lane }),
            };
            let place =
                if place.distance(self.place_of_ball()) < 0.7 { at(side * 1.0, place.y()) } else { place };
            self.robot(who).pose.position = place;
        }
    }

    /// What prevents the match from continuing, where it was reported.
    fn reason(&self) -> Option<Reason> {
        self.referee.blocked().map(|blocked| blocked.obstacle.reason)
    }

    fn obey(&mut self, order: WorldOrder) {
        match order {
            WorldOrder::PutBall(place) => self.ball = Some(BallSeen::at(place)),
            WorldOrder::RemoveRobot(who) => self.take(who),
            WorldOrder::ReturnRobot(who, pose) | WorldOrder::CarryRobot(who, pose) => {
                self.put(who, pose.position);
            }
        }
    }

    /// Follows the commands of the packets, each once.
    fn receive_packets(&mut self) {
        while let Some(packet) = self.referee.poll_packet() {
            let new = self.counter != Some(packet.command_counter);
            self.counter = Some(packet.command_counter);
            if let Some(command) = wire::from_wire(packet.command).filter(|_| new) {
                let ball = self.ball.map(|ball| ball.position);
                let received = self.received.receive(command, packet.command_timestamp, ball);
                use rules::state::CommandVerdict;
                assert!(
                    matches!(received, CommandVerdict::Followed | CommandVerdict::Repeated),
                    "{received:?} for {command:?}"
                );
            }
            // More time than before: the kicker was disturbed and has its time again.
            let action_left = packet.current_action_time_remaining.unwrap();
            if !new
                && action_left > self.action_left
                && let Some(command) = self.received.command()
            {
                self.received.receive(command, packet.packet_timestamp, None);
            }
            self.action_left = action_left;
            self.packets.push(packet);
        }
    }

    fn run(&mut self, seconds: f32) {
        for _ in 0..(seconds * 1e6) as u64 / self.step.0 {
            self.step();
        }
    }

    fn until(&mut self, phase: Phase<Colour>, seconds: f32) {
        for _ in 0..(seconds * 1e6) as u64 / self.step.0 {
            if self.phase() == phase {
                return;
            }
            self.step();
        }
        panic!("{:?} after {seconds} s, not {phase:?}; {:#?}", self.phase(), self.referee.events());
    }

    fn count(&self, kind: Kind) -> usize {
        self.referee.events().iter().filter(|event| event.what.kind() == kind).count()
    }

    fn only(&self, kind: Kind) -> &RefereeEvent {
        let mut same = self.referee.events().iter().filter(|event| event.what.kind() == kind);
        let first = same.next().unwrap_or_else(|| panic!("no {kind:?} in {:#?}", self.referee.events()));
        assert_eq!(same.count(), 0, "more than one {kind:?}");
        first
    }

    /// The only event of that kind, which that robot caused.
    fn only_by(&self, kind: Kind, who: Who) -> &RefereeEvent {
        let event = self.only(kind);
        assert_eq!((event.by, event.robot), (Some(who.colour), Some(who.id)));
        event
    }

    fn assert_restart(&self, next: Restart, place: Point<Field>) {
        assert_eq!(self.referee.next(), Some(next));
        let placement = self.referee.placement().unwrap();
        assert!(close(placement, place), "{placement:?}");
    }

    fn seconds(&self) -> f32 {
        self.now.as_secs_f32()
    }
}

fn close(a: Point<Field>, b: Point<Field>) -> bool {
    a.distance(b) < 0.012
}
