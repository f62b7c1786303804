//! Tests: assistant and automatic referee fulfil the requirements of an external game controller. Packets
//! made by hand, the simulator's own world.

use geometry::{Angle, Pose, Vector};
use protocol::Who;
use ssl::event::PlacementFailed;
use ssl::referee::Command as Wire;

use super::super::event::{Kind, RefereeEvent, What};
use super::super::field_staff::WorldOrder;
use super::*;
use crate::small_size::{Ball, Parameters, World};

/// Yellow's goal is at −x; division B; a packet of the controller comes with every observation, 10 ms apart.
struct ServerLoop {
    world: World,
    game: RemoteMatch,
    packet: packet::Referee,
    assistant: Assistant,
    autoref: AutoReferee,
    deeds: Vec<(f64, Deed)>,
    events: Vec<RefereeEvent>,
}

fn who(colour: Colour, id: u8) -> Who {
    Who { colour, id: RobotId::new(id).unwrap() }
}

fn at(x: f32, y: f32) -> Point<Field> {
    Point::new(x, y)
}

fn info() -> packet::TeamInfo {
    packet::TeamInfo { max_allowed_bots: Some(6), can_place_ball: Some(true), ..packet::TeamInfo::default() }
}

impl ServerLoop {
    fn new(decider: Decider) -> Self {
        let parameters = Parameters::of(League::DivisionB).unwrap().clone();
        let mut world = World::new(League::DivisionB, &parameters, 1);
        for id in 0..6 {
            let y = -2.0 + 0.6 * f32::from(id);
            world.put(who(Colour::Yellow, id), Pose { position: at(-2.5, y), heading: Angle::ZERO });
            world.put(who(Colour::Blue, id), Pose { position: at(2.5, y), heading: Angle::ZERO });
        }
        // With division A's area behind the goal line.
        let mut game = RemoteMatch::new(League::DivisionB).unwrap();
        game.set_field(FieldSpec { goal_substitution: 0.3, ..League::DivisionB.field() });
        let packet = packet::Referee {
            command: Wire::Stop as i32,
            stage: packet::Stage::NormalFirstHalf as i32,
            yellow: info(),
            blue: info(),
            blue_team_on_positive_half: Some(true),
            source_identifier: Some("controller".into()),
            ..packet::Referee::default()
        };
        Self {
            world,
            game,
            packet,
            assistant: Assistant::default(),
            autoref: AutoReferee::new(decider),
            deeds: Vec::new(),
            events: Vec::new(),
        }
    }

    fn command(&mut self, command: Wire) {
        self.packet.command = command as i32;
        self.packet.command_counter += 1;
    }

    fn next(&mut self, command: Wire, place: Point<Field>) {
        self.packet.next_command = Some(command as i32);
        self.packet.designated_position =
            Some(packet::Point { x: place.x() * 1000.0, y: place.y() * 1000.0 });
    }

    fn ball(&mut self, position: Point<Field>, velocity: Vector<Field>) {
        self.world.put_ball(Ball::rolling(position, velocity));
    }

    fn run(&mut self, seconds: f32) {
        let mut events = Vec::new();
        for _ in 0..(seconds * 100.0) as u32 {
            for _ in 0..10 {
                self.world.step();
            }
            let now = Instant(self.world.now() * 1000);
            self.packet.packet_timestamp = now.0;
            self.game.receive(self.packet.clone(), now, self.world.ball.position);
            self.game.tick(now, self.world.ball.position);
            self.world.take_events(&mut events);
            self.events.extend(self.autoref.look(&self.game, &self.world, &events));
            events.clear();
            for deed in self.assistant.look(&self.game, &self.world) {
                deed.order.carry_out(&mut self.world);
                self.deeds.push((self.world.time(), deed));
            }
        }
    }

    fn reasons(&self) -> Vec<AssistantReason> {
        self.deeds.iter().map(|(_, deed)| deed.why).collect()
    }

    fn kinds(&self) -> Vec<Kind> {
        self.events.iter().map(|event| event.what.kind()).collect()
    }

    fn here(&self, colour: Colour) -> usize {
        self.world.robots().iter().filter(|robot| robot.present && robot.who.colour == colour).count()
    }
}

fn server_loop() -> ServerLoop {
    ServerLoop::new(Decider::Person)
}

fn failed(by: Colour) -> GameEvent {
    let team = if by == Colour::Blue { ssl::common::Team::Blue } else { ssl::common::Team::Yellow };
    let failed = PlacementFailed { by_team: team as i32, ..PlacementFailed::default() };
    GameEvent {
        r#type: Some(GameEventType::PlacementFailed as i32),
        event: Some(Reported::PlacementFailed(failed)),
        ..GameEvent::default()
    }
}

#[test]
fn the_ball_is_set_for_a_kick_off_and_for_a_penalty() {
    let mut server_loop = server_loop();
    server_loop.ball(at(1.0, 1.0), Vector::default());
    server_loop.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    server_loop.run(1.9);
    assert_eq!(server_loop.deeds, [], "a person needs 2 s");
    server_loop.run(0.5);
    assert_eq!(server_loop.reasons(), [AssistantReason::SetByHand(Restart::Kickoff(Colour::Yellow))]);
    assert_eq!(server_loop.world.ball.position, at(0.0, 0.0));
    server_loop.run(20.0);
    assert_eq!(server_loop.deeds.len(), 1, "it lies there: {:?}", server_loop.deeds);
    server_loop.command(Wire::Halt);
    server_loop.next(Wire::PreparePenaltyBlue, at(1.5, 0.0));
    server_loop.run(3.0);
    assert_eq!(server_loop.reasons()[1], AssistantReason::SetByHand(Restart::Penalty(Colour::Blue)));
    let ball = server_loop.world.ball.position;
    assert!(ball.distance(at(1.5, 0.0)) < 1e-5, "6 m from yellow's goal at -4.5 m: {ball:?}");
}

#[test]
fn the_ball_is_put_where_no_team_may_place_it_and_left_alone_where_one_does() {
    let spot = at(-2.0, 2.8);
    let mut server_loop = server_loop();
    server_loop.ball(at(-2.0, 3.1), Vector::default());
    server_loop.next(Wire::DirectFreeBlue, spot);
    server_loop.run(9.0);
    assert_eq!(server_loop.deeds, [], "blue may place, and the controller tells it to");
    server_loop.packet.game_events = vec![failed(Colour::Blue)];
    server_loop.command(Wire::Stop);
    server_loop.run(9.0);
    assert_eq!(server_loop.deeds, [], "now yellow may");
    server_loop.packet.game_events.push(failed(Colour::Yellow));
    server_loop.command(Wire::Stop);
    server_loop.run(3.0);
    assert_eq!(server_loop.reasons(), [AssistantReason::NoTeamPlaces]);
    assert!(server_loop.world.ball.position.distance(spot) < 1e-5, "{:?}", server_loop.world.ball.position);

    let mut neither = ServerLoop::new(Decider::Person);
    neither.ball(at(-2.0, 3.1), Vector::default());
    neither.next(Wire::ForceStart, spot);
    (neither.packet.yellow.can_place_ball, neither.packet.blue.ball_placement_failures_reached) =
        (Some(false), Some(true));
    neither.run(3.0);
    assert_eq!(neither.reasons(), [AssistantReason::NoTeamPlaces]);
}

#[test]
fn where_the_controller_wants_the_ball_decides_and_the_mark_when_it_prepares() {
    let mut server_loop = server_loop();
    // A foul in the stop before a kick-off has moved the designated place.
    server_loop.ball(at(0.0, 0.0), Vector::default());
    server_loop.next(Wire::PrepareKickoffYellow, at(1.0, 2.0));
    server_loop.run(3.0);
    assert!(server_loop.world.ball.position.distance(at(1.0, 2.0)) < 1e-5, "it goes on from there alone");
    server_loop.command(Wire::PrepareKickoffYellow);
    server_loop.run(1.5);
    assert_eq!(server_loop.deeds.len(), 1);
    server_loop.run(1.5);
    assert_eq!(server_loop.reasons()[1], AssistantReason::SetByHand(Restart::Kickoff(Colour::Yellow)));
    assert_eq!(server_loop.world.ball.position, at(0.0, 0.0));
    server_loop.ball(at(0.3, 0.0), Vector::default());
    server_loop.run(10.0);
    assert_eq!(server_loop.deeds.len(), 2, "in the circle the controller starts");
    // No position at all: a rule-compliant one near the ball.
    let mut lost = ServerLoop::new(Decider::Person);
    lost.ball(at(4.6, 0.0), Vector::default());
    lost.packet.next_command = Some(Wire::DirectFreeBlue as i32);
    lost.run(11.0);
    assert_eq!(lost.reasons(), [AssistantReason::NothingHappens]);
    let spot = lost.world.ball.position;
    assert_eq!(rules::restart::free_kick_fault(&lost.game.field, &lost.game.limits, spot), None, "{spot:?}");
}

#[test]
fn packets_of_nonsense_move_nothing_out_of_the_server() {
    let mut chance = crate::rng::Stream::new(8, "remote match");
    let mut server_loop = server_loop();
    server_loop.ball(at(-2.0, 3.1), Vector::default());
    server_loop.next(Wire::ForceStart, at(0.0, 0.0));
    server_loop.packet.game_events = vec![failed(Colour::Blue), failed(Colour::Yellow)];
    for _ in 0..400 {
        let number = [f32::NAN, f32::INFINITY, -1e30, 3e9, 0.0][chance.whole(0, 4) as usize];
        server_loop.packet.designated_position = Some(packet::Point { x: number, y: -number });
        server_loop.packet.command = chance.whole(0, 30) as i32 - 5;
        server_loop.packet.next_command = Some(chance.whole(0, 30) as i32 - 5);
        server_loop.packet.stage = chance.whole(0, 40) as i32 - 10;
        server_loop.packet.command_counter = chance.whole(0, 5);
        server_loop.packet.command_timestamp = u64::from(chance.whole(0, 9)) * 1_000_000_000_000;
        server_loop.packet.blue.max_allowed_bots = Some([0, 6, u32::MAX][chance.whole(0, 2) as usize]);
        server_loop.packet.yellow.goalkeeper = chance.whole(0, 99);
        server_loop.run(0.3);
    }
    let inside = |p: Point<Field>| server_loop.game.field.surface().contains(p);
    assert!(inside(server_loop.world.ball.position), "{:?}", server_loop.world.ball);
    let robots = server_loop.world.robots().iter().filter(|robot| robot.present);
    assert!(robots.into_iter().all(|robot| inside(robot.pose.position)));
}

#[test]
fn a_stop_from_which_nothing_goes_on_is_ended_by_hand_at_last() {
    let mut server_loop = server_loop();
    server_loop.ball(at(-2.0, 3.1), Vector::default());
    server_loop.next(Wire::DirectFreeBlue, at(-2.0, 2.8));
    server_loop.run(9.9);
    assert_eq!(server_loop.deeds, []);
    server_loop.run(0.5);
    assert_eq!(server_loop.reasons(), [AssistantReason::NothingHappens]);
}

#[test]
fn a_ball_that_robots_cannot_reach_is_brought_back_to_the_team_that_places() {
    // Behind the goal, in the goal, and in the corner of the field surface.
    for (x, y) in [(4.75, 0.2), (4.6, 0.0), (4.7, 3.2)] {
        let mut server_loop = server_loop();
        server_loop.next(Wire::DirectFreeBlue, at(3.5, 2.8));
        server_loop.command(Wire::BallPlacementBlue);
        server_loop.ball(at(x, y), Vector::default());
        server_loop.run(3.0);
        assert_eq!(server_loop.reasons(), [AssistantReason::OutOfReach], "{x} {y}");
        let ball = server_loop.world.ball.position;
        assert!((ball.x() - 4.3).abs() < 1e-6 && (ball.y() - y.min(2.8)).abs() < 1e-6, "{ball:?}");
    }
    let mut reachable = server_loop();
    reachable.next(Wire::DirectFreeBlue, at(3.5, 2.8));
    reachable.command(Wire::BallPlacementBlue);
    reachable.ball(at(0.0, 3.25), Vector::default());
    reachable.run(20.0);
    assert_eq!(reachable.deeds, [], "a ball at a wall is the team's business");
}

#[test]
fn a_person_waits_for_room_but_not_for_ever() {
    let mut server_loop = server_loop();
    server_loop.ball(at(1.0, 1.0), Vector::default());
    server_loop.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    server_loop.world.put(who(Colour::Blue, 5), Pose { position: at(0.1, 0.0), heading: Angle::ZERO });
    server_loop.run(11.0);
    assert_eq!(server_loop.deeds, []);
    server_loop.run(1.5);
    assert_eq!(server_loop.deeds.len(), 1);
}

#[test]
fn a_surplus_robot_is_taken_off_where_it_may_be_and_brought_back_when_the_card_is_over() {
    // Behind the own goal line, and beside the halfway line.
    for (x, y) in [(4.68, 2.0), (-0.8, -3.05)] {
        let mut server_loop = server_loop();
        server_loop.command(Wire::ForceStart);
        server_loop.ball(at(0.0, 0.0), Vector::default());
        server_loop.packet.blue.max_allowed_bots = Some(5);
        server_loop.run(12.0);
        assert_eq!(server_loop.deeds, [], "in play nobody goes in among the robots");
        let leaving = who(Colour::Blue, 3);
        server_loop.world.put(leaving, Pose { position: at(x, y), heading: Angle::ZERO });
        server_loop.run(1.0);
        let taken = Deed { order: WorldOrder::RemoveRobot(leaving), why: AssistantReason::HasLeft };
        assert_eq!(server_loop.deeds.pop().map(|(_, deed)| deed), Some(taken));
        server_loop.run(20.0);
        assert_eq!((server_loop.deeds.len(), server_loop.here(Colour::Blue)), (0, 5));
        server_loop.packet.blue.max_allowed_bots = Some(6);
        server_loop.run(1.0);
        assert_eq!(
            (server_loop.reasons(), server_loop.here(Colour::Blue)),
            (vec![AssistantReason::MayComeBack], 6)
        );
        let place = server_loop.world.robot(leaving).unwrap().pose.position;
        assert!(place.x() > 0.0 && place.x() <= 1.0 && place.y().abs() > 3.0, "{place:?}");
        server_loop.run(20.0);
        assert_eq!(server_loop.deeds.len(), 1);
    }
}

#[test]
fn in_stop_a_surplus_robot_is_taken_off_after_the_controllers_patience() {
    let mut server_loop = server_loop();
    server_loop.packet.yellow.max_allowed_bots = Some(5);
    server_loop.run(9.9);
    assert_eq!(server_loop.deeds, []);
    server_loop.run(0.5);
    assert_eq!(
        (server_loop.reasons(), server_loop.here(Colour::Yellow)),
        (vec![AssistantReason::TooMany], 5)
    );
    assert!(server_loop.world.robot(who(Colour::Yellow, 0)).unwrap().present, "not the keeper");
    // A second card: robots are taken off one after the other.
    server_loop.packet.yellow.max_allowed_bots = Some(3);
    server_loop.run(16.0);
    assert_eq!(server_loop.here(Colour::Yellow), 3);
}

#[test]
fn a_substitution_takes_one_robot_and_brings_it_back_standing() {
    let mut server_loop = server_loop();
    server_loop.command(Wire::Halt);
    server_loop.packet.blue.bot_substitution_allowed = Some(true);
    let fallen = who(Colour::Blue, 4);
    server_loop.world.tip(fallen, true);
    server_loop.run(1.0);
    assert_eq!(server_loop.reasons(), [AssistantReason::Substituted]);
    assert_eq!(server_loop.deeds[0].1.order, WorldOrder::RemoveRobot(fallen));
    server_loop.run(10.0);
    assert_eq!(server_loop.reasons(), [AssistantReason::Substituted, AssistantReason::MayComeBack]);
    assert!(!server_loop.world.robot(fallen).unwrap().tipped && server_loop.here(Colour::Blue) == 6);
    server_loop.command(Wire::Stop);
    server_loop.packet.blue.bot_substitution_allowed = Some(false);
    server_loop.run(5.0);
    assert_eq!(server_loop.deeds.len(), 2);
}

#[test]
fn nothing_is_done_for_a_controller_that_is_silent_or_is_not_the_one_that_is_followed() {
    let mut server_loop = server_loop();
    server_loop.ball(at(1.0, 1.0), Vector::default());
    let mut other = server_loop.packet.clone();
    other.source_identifier = Some("another".into());
    server_loop.run(0.1);
    let now = Instant(server_loop.world.now() * 1000);
    other.command = Wire::ForceStart as i32;
    assert!(!server_loop.game.receive(other.clone(), now, at(0.0, 0.0)));
    assert_eq!(server_loop.game.phase(), Phase::Stop);
    let later = now + SILENCE + Duration::millis(1);
    assert!(server_loop.game.is_silent(later));
    assert!(server_loop.game.receive(other, later, at(0.0, 0.0)), "the first is gone");
    let mut game = RemoteMatch::new(League::DivisionB).unwrap();
    game.tick(Instant(10_000_000), at(0.0, 0.0));
    assert_eq!(Assistant::default().look(&game, &server_loop.world), []);
}

#[test]
fn a_ball_over_a_line_is_reported_once_and_nothing_of_play_until_the_controller_stops() {
    let mut server_loop = server_loop();
    server_loop.command(Wire::ForceStart);
    server_loop.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
    server_loop.run(0.9);
    assert_eq!(server_loop.kinds(), [Kind::LeftTouchLine]);
    // Back on the field and out over the goal line, while the controller waits for other automatic referees.
    server_loop.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    server_loop.run(0.5);
    assert_eq!(server_loop.kinds(), [Kind::LeftTouchLine]);
    server_loop.command(Wire::Stop);
    server_loop.run(0.5);
    server_loop.command(Wire::ForceStart);
    server_loop.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    server_loop.run(0.5);
    assert_eq!(server_loop.kinds(), [Kind::LeftTouchLine, Kind::LeftGoalLine]);
}

#[test]
fn a_goal_is_reported_to_a_person_or_decided() {
    let cases: [(Decider, u32, &[Kind]); 3] = [
        (Decider::Person, 6, &[Kind::PossibleGoal]),
        (Decider::AutoReferee, 6, &[Kind::Goal]),
        (Decider::AutoReferee, 5, &[Kind::InvalidGoal, Kind::LeftGoalLine]),
    ];
    for (decider, robots, kinds) in cases {
        let mut server_loop = ServerLoop::new(decider);
        server_loop.packet.yellow.max_allowed_bots = Some(robots);
        server_loop.command(Wire::ForceStart);
        server_loop.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
        server_loop.run(0.5);
        assert_eq!(server_loop.kinds(), kinds);
        assert_eq!(server_loop.events[0].by, Some(Colour::Yellow), "blue's goal is at +x");
    }
    // A robot behind its own goal line is not on the field.
    let mut server_loop = ServerLoop::new(Decider::AutoReferee);
    server_loop.packet.yellow.max_allowed_bots = Some(5);
    server_loop.world.put(who(Colour::Yellow, 5), Pose { position: at(-4.68, 2.0), heading: Angle::ZERO });
    server_loop.command(Wire::ForceStart);
    server_loop.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
    server_loop.run(0.5);
    assert_eq!(server_loop.kinds(), [Kind::Goal]);
}

#[test]
fn a_ball_out_that_no_robot_touched_goes_on_by_a_force_start() {
    for (decider, kind) in [(Decider::Person, Kind::LeftTouchLine), (Decider::AutoReferee, Kind::NoProgress)]
    {
        let mut server_loop = ServerLoop::new(decider);
        server_loop.command(Wire::ForceStart);
        server_loop.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
        server_loop.run(0.9);
        assert_eq!((server_loop.kinds(), server_loop.events[0].by), (vec![kind], None));
    }
}

#[test]
fn a_placement_is_reported_when_it_is_done_and_not_before() {
    let mut server_loop = server_loop();
    let target = at(0.0, 1.0);
    server_loop.next(Wire::DirectFreeBlue, target);
    server_loop.command(Wire::BallPlacementBlue);
    server_loop.ball(at(0.1, 1.0), Vector::default());
    server_loop.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.12), heading: Angle::ZERO });
    server_loop.run(3.0);
    assert_eq!(server_loop.kinds(), [], "a robot is still at the ball");
    server_loop.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.5), heading: Angle::ZERO });
    server_loop.run(1.0);
    assert_eq!(server_loop.kinds(), [Kind::PlacementSucceeded]);
    assert!(matches!(server_loop.events[0].what, What::PlacementSucceeded { took, .. } if took > 2.9));
    server_loop.run(2.0);
    assert_eq!(server_loop.events.len(), 1);
}

#[test]
fn what_the_controller_finds_by_itself_is_not_reported() {
    let mut server_loop = server_loop();
    server_loop.command(Wire::ForceStart);
    server_loop.packet.blue.max_allowed_bots = Some(1);
    // Resting in a defence area, for longer than any limit.
    server_loop.ball(at(4.0, 0.0), Vector::default());
    server_loop.run(30.0);
    assert_eq!(server_loop.kinds(), []);
}
