//! Tests: assistant and automatic referee fulfil the requirements of an external game controller. Packets
//! made by hand, the simulator's own world.

use geometry::{Angle, Pose, Vector};
use protocol::Who;
use ssl::event::PlacementFailed;
use ssl::referee::Command as Wire;

use super::super::event::{Event, Kind, What};
use super::super::people::WorldOrder;
use super::*;
use crate::small_size::{Ball, Parameters, World};

/// Yellow's goal is at −x; division B; a packet of the controller comes with every observation, 10 ms apart.
struct Hall {
    world: World,
    game: RemoteMatch,
    packet: packet::Referee,
    assistant: Assistant,
    autoref: AutoReferee,
    deeds: Vec<(f64, Deed)>,
    events: Vec<Event>,
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

impl Hall {
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
            self.game.hear(self.packet.clone(), now, self.world.ball.position);
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

    fn reasons(&self) -> Vec<Why> {
        self.deeds.iter().map(|(_, deed)| deed.why).collect()
    }

    fn kinds(&self) -> Vec<Kind> {
        self.events.iter().map(|event| event.what.kind()).collect()
    }

    fn here(&self, colour: Colour) -> usize {
        self.world.robots().iter().filter(|robot| robot.present && robot.who.colour == colour).count()
    }
}

fn hall() -> Hall {
    Hall::new(Decider::Person)
}

fn failed(by: Colour) -> GameEvent {
    let team = if by == Colour::Blue { ssl::common::Team::Blue } else { ssl::common::Team::Yellow };
    let failed = PlacementFailed { by_team: team as i32, ..PlacementFailed::default() };
    GameEvent {
        r#type: Some(GameEventType::PlacementFailed as i32),
        event: Some(Told::PlacementFailed(failed)),
        ..GameEvent::default()
    }
}

#[test]
fn the_ball_is_set_for_a_kick_off_and_for_a_penalty() {
    let mut hall = hall();
    hall.ball(at(1.0, 1.0), Vector::default());
    hall.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    hall.run(1.9);
    assert_eq!(hall.deeds, [], "a person needs 2 s");
    hall.run(0.5);
    assert_eq!(hall.reasons(), [Why::SetByHand(Restart::Kickoff(Colour::Yellow))]);
    assert_eq!(hall.world.ball.position, at(0.0, 0.0));
    hall.run(20.0);
    assert_eq!(hall.deeds.len(), 1, "it lies there: {:?}", hall.deeds);
    hall.command(Wire::Halt);
    hall.next(Wire::PreparePenaltyBlue, at(1.5, 0.0));
    hall.run(3.0);
    assert_eq!(hall.reasons()[1], Why::SetByHand(Restart::Penalty(Colour::Blue)));
    let ball = hall.world.ball.position;
    assert!(ball.distance(at(1.5, 0.0)) < 1e-5, "6 m from yellow's goal at -4.5 m: {ball:?}");
}

#[test]
fn the_ball_is_put_where_no_team_may_place_it_and_left_alone_where_one_does() {
    let spot = at(-2.0, 2.8);
    let mut hall = hall();
    hall.ball(at(-2.0, 3.1), Vector::default());
    hall.next(Wire::DirectFreeBlue, spot);
    hall.run(9.0);
    assert_eq!(hall.deeds, [], "blue may place, and the controller tells it to");
    hall.packet.game_events = vec![failed(Colour::Blue)];
    hall.command(Wire::Stop);
    hall.run(9.0);
    assert_eq!(hall.deeds, [], "now yellow may");
    hall.packet.game_events.push(failed(Colour::Yellow));
    hall.command(Wire::Stop);
    hall.run(3.0);
    assert_eq!(hall.reasons(), [Why::NoTeamPlaces]);
    assert!(hall.world.ball.position.distance(spot) < 1e-5, "{:?}", hall.world.ball.position);

    let mut neither = Hall::new(Decider::Person);
    neither.ball(at(-2.0, 3.1), Vector::default());
    neither.next(Wire::ForceStart, spot);
    (neither.packet.yellow.can_place_ball, neither.packet.blue.ball_placement_failures_reached) =
        (Some(false), Some(true));
    neither.run(3.0);
    assert_eq!(neither.reasons(), [Why::NoTeamPlaces]);
}

#[test]
fn where_the_controller_wants_the_ball_decides_and_the_mark_when_it_prepares() {
    let mut hall = hall();
    // A foul in the stop before a kick-off has moved the designated place.
    hall.ball(at(0.0, 0.0), Vector::default());
    hall.next(Wire::PrepareKickoffYellow, at(1.0, 2.0));
    hall.run(3.0);
    assert!(hall.world.ball.position.distance(at(1.0, 2.0)) < 1e-5, "it goes on from there alone");
    hall.command(Wire::PrepareKickoffYellow);
    hall.run(1.5);
    assert_eq!(hall.deeds.len(), 1);
    hall.run(1.5);
    assert_eq!(hall.reasons()[1], Why::SetByHand(Restart::Kickoff(Colour::Yellow)));
    assert_eq!(hall.world.ball.position, at(0.0, 0.0));
    hall.ball(at(0.3, 0.0), Vector::default());
    hall.run(10.0);
    assert_eq!(hall.deeds.len(), 2, "in the circle the controller starts");
    // No position at all: a rule-compliant one near the ball.
    let mut lost = Hall::new(Decider::Person);
    lost.ball(at(4.6, 0.0), Vector::default());
    lost.packet.next_command = Some(Wire::DirectFreeBlue as i32);
    lost.run(11.0);
    assert_eq!(lost.reasons(), [Why::NothingHappens]);
    let spot = lost.world.ball.position;
    assert_eq!(rules::restart::free_kick_fault(&lost.game.field, &lost.game.limits, spot), None, "{spot:?}");
}

#[test]
fn packets_of_nonsense_move_nothing_out_of_the_hall() {
    let mut chance = crate::rng::Stream::new(8, "remote match");
    let mut hall = hall();
    hall.ball(at(-2.0, 3.1), Vector::default());
    hall.next(Wire::ForceStart, at(0.0, 0.0));
    hall.packet.game_events = vec![failed(Colour::Blue), failed(Colour::Yellow)];
    for _ in 0..400 {
        let number = [f32::NAN, f32::INFINITY, -1e30, 3e9, 0.0][chance.whole(0, 4) as usize];
        hall.packet.designated_position = Some(packet::Point { x: number, y: -number });
        hall.packet.command = chance.whole(0, 30) as i32 - 5;
        hall.packet.next_command = Some(chance.whole(0, 30) as i32 - 5);
        hall.packet.stage = chance.whole(0, 40) as i32 - 10;
        hall.packet.command_counter = chance.whole(0, 5);
        hall.packet.command_timestamp = u64::from(chance.whole(0, 9)) * 1_000_000_000_000;
        hall.packet.blue.max_allowed_bots = Some([0, 6, u32::MAX][chance.whole(0, 2) as usize]);
        hall.packet.yellow.goalkeeper = chance.whole(0, 99);
        hall.run(0.3);
    }
    let inside = |p: Point<Field>| hall.game.field.carpet().contains(p);
    assert!(inside(hall.world.ball.position), "{:?}", hall.world.ball);
    let robots = hall.world.robots().iter().filter(|robot| robot.present);
    assert!(robots.into_iter().all(|robot| inside(robot.pose.position)));
}

#[test]
fn a_stop_from_which_nothing_goes_on_is_ended_by_hand_at_last() {
    let mut hall = hall();
    hall.ball(at(-2.0, 3.1), Vector::default());
    hall.next(Wire::DirectFreeBlue, at(-2.0, 2.8));
    hall.run(9.9);
    assert_eq!(hall.deeds, []);
    hall.run(0.5);
    assert_eq!(hall.reasons(), [Why::NothingHappens]);
}

#[test]
fn a_ball_that_robots_cannot_reach_is_brought_back_to_the_team_that_places() {
    // Behind the goal, in the goal, and in the corner of the field surface.
    for (x, y) in [(4.75, 0.2), (4.6, 0.0), (4.7, 3.2)] {
        let mut hall = hall();
        hall.next(Wire::DirectFreeBlue, at(3.5, 2.8));
        hall.command(Wire::BallPlacementBlue);
        hall.ball(at(x, y), Vector::default());
        hall.run(3.0);
        assert_eq!(hall.reasons(), [Why::OutOfReach], "{x} {y}");
        let ball = hall.world.ball.position;
        assert!((ball.x() - 4.3).abs() < 1e-6 && (ball.y() - y.min(2.8)).abs() < 1e-6, "{ball:?}");
    }
    let mut reachable = hall();
    reachable.next(Wire::DirectFreeBlue, at(3.5, 2.8));
    reachable.command(Wire::BallPlacementBlue);
    reachable.ball(at(0.0, 3.25), Vector::default());
    reachable.run(20.0);
    assert_eq!(reachable.deeds, [], "a ball at a wall is the team's business");
}

#[test]
fn a_person_waits_for_room_but_not_for_ever() {
    let mut hall = hall();
    hall.ball(at(1.0, 1.0), Vector::default());
    hall.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    hall.world.put(who(Colour::Blue, 5), Pose { position: at(0.1, 0.0), heading: Angle::ZERO });
    hall.run(11.0);
    assert_eq!(hall.deeds, []);
    hall.run(1.5);
    assert_eq!(hall.deeds.len(), 1);
}

#[test]
fn a_surplus_robot_is_taken_off_where_it_may_be_and_brought_back_when_the_card_is_over() {
    // Behind the own goal line, and beside the halfway line.
    for (x, y) in [(4.68, 2.0), (-0.8, -3.05)] {
        let mut hall = hall();
        hall.command(Wire::ForceStart);
        hall.ball(at(0.0, 0.0), Vector::default());
        hall.packet.blue.max_allowed_bots = Some(5);
        hall.run(12.0);
        assert_eq!(hall.deeds, [], "in play nobody goes in among the robots");
        let leaving = who(Colour::Blue, 3);
        hall.world.put(leaving, Pose { position: at(x, y), heading: Angle::ZERO });
        hall.run(1.0);
        let taken = Deed { order: WorldOrder::RemoveRobot(leaving), why: Why::HasLeft };
        assert_eq!(hall.deeds.pop().map(|(_, deed)| deed), Some(taken));
        hall.run(20.0);
        assert_eq!((hall.deeds.len(), hall.here(Colour::Blue)), (0, 5));
        hall.packet.blue.max_allowed_bots = Some(6);
        hall.run(1.0);
        assert_eq!((hall.reasons(), hall.here(Colour::Blue)), (vec![Why::MayComeBack], 6));
        let place = hall.world.robot(leaving).unwrap().pose.position;
        assert!(place.x() > 0.0 && place.x() <= 1.0 && place.y().abs() > 3.0, "{place:?}");
        hall.run(20.0);
        assert_eq!(hall.deeds.len(), 1);
    }
}

#[test]
fn in_stop_a_surplus_robot_is_taken_off_after_the_controllers_patience() {
    let mut hall = hall();
    hall.packet.yellow.max_allowed_bots = Some(5);
    hall.run(9.9);
    assert_eq!(hall.deeds, []);
    hall.run(0.5);
    assert_eq!((hall.reasons(), hall.here(Colour::Yellow)), (vec![Why::TooMany], 5));
    assert!(hall.world.robot(who(Colour::Yellow, 0)).unwrap().present, "not the keeper");
    // A second card: robots are taken off one after the other.
    hall.packet.yellow.max_allowed_bots = Some(3);
    hall.run(16.0);
    assert_eq!(hall.here(Colour::Yellow), 3);
}

#[test]
fn a_substitution_takes_one_robot_and_brings_it_back_standing() {
    let mut hall = hall();
    hall.command(Wire::Halt);
    hall.packet.blue.bot_substitution_allowed = Some(true);
    let fallen = who(Colour::Blue, 4);
    hall.world.tip(fallen, true);
    hall.run(1.0);
    assert_eq!(hall.reasons(), [Why::Substituted]);
    assert_eq!(hall.deeds[0].1.order, WorldOrder::RemoveRobot(fallen));
    hall.run(10.0);
    assert_eq!(hall.reasons(), [Why::Substituted, Why::MayComeBack]);
    assert!(!hall.world.robot(fallen).unwrap().tipped && hall.here(Colour::Blue) == 6);
    hall.command(Wire::Stop);
    hall.packet.blue.bot_substitution_allowed = Some(false);
    hall.run(5.0);
    assert_eq!(hall.deeds.len(), 2);
}

#[test]
fn nothing_is_done_for_a_controller_that_is_silent_or_is_not_the_one_that_is_followed() {
    let mut hall = hall();
    hall.ball(at(1.0, 1.0), Vector::default());
    let mut other = hall.packet.clone();
    other.source_identifier = Some("another".into());
    hall.run(0.1);
    let now = Instant(hall.world.now() * 1000);
    other.command = Wire::ForceStart as i32;
    assert!(!hall.game.hear(other.clone(), now, at(0.0, 0.0)));
    assert_eq!(hall.game.phase(), Phase::Stop);
    let later = now + SILENCE + Duration::millis(1);
    assert!(hall.game.is_silent(later));
    assert!(hall.game.hear(other, later, at(0.0, 0.0)), "the first is gone");
    let mut game = RemoteMatch::new(League::DivisionB).unwrap();
    game.tick(Instant(10_000_000), at(0.0, 0.0));
    assert_eq!(Assistant::default().look(&game, &hall.world), []);
}

#[test]
fn a_ball_over_a_line_is_reported_once_and_nothing_of_play_until_the_controller_stops() {
    let mut hall = hall();
    hall.command(Wire::ForceStart);
    hall.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
    hall.run(0.9);
    assert_eq!(hall.kinds(), [Kind::LeftTouchLine]);
    // Back on the field and out over the goal line, while the controller waits for other automatic referees.
    hall.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    hall.run(0.5);
    assert_eq!(hall.kinds(), [Kind::LeftTouchLine]);
    hall.command(Wire::Stop);
    hall.run(0.5);
    hall.command(Wire::ForceStart);
    hall.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    hall.run(0.5);
    assert_eq!(hall.kinds(), [Kind::LeftTouchLine, Kind::LeftGoalLine]);
}

#[test]
fn a_goal_is_reported_to_a_person_or_decided() {
    let cases: [(Decider, u32, &[Kind]); 3] = [
        (Decider::Person, 6, &[Kind::PossibleGoal]),
        (Decider::AutoReferee, 6, &[Kind::Goal]),
        (Decider::AutoReferee, 5, &[Kind::InvalidGoal, Kind::LeftGoalLine]),
    ];
    for (decider, robots, kinds) in cases {
        let mut hall = Hall::new(decider);
        hall.packet.yellow.max_allowed_bots = Some(robots);
        hall.command(Wire::ForceStart);
        hall.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
        hall.run(0.5);
        assert_eq!(hall.kinds(), kinds);
        assert_eq!(hall.events[0].by, Some(Colour::Yellow), "blue's goal is at +x");
    }
    // A robot behind its own goal line is not on the field.
    let mut hall = Hall::new(Decider::AutoReferee);
    hall.packet.yellow.max_allowed_bots = Some(5);
    hall.world.put(who(Colour::Yellow, 5), Pose { position: at(-4.68, 2.0), heading: Angle::ZERO });
    hall.command(Wire::ForceStart);
    hall.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
    hall.run(0.5);
    assert_eq!(hall.kinds(), [Kind::Goal]);
}

#[test]
fn a_ball_out_that_no_robot_touched_goes_on_by_a_force_start() {
    for (decider, kind) in [(Decider::Person, Kind::LeftTouchLine), (Decider::AutoReferee, Kind::NoProgress)]
    {
        let mut hall = Hall::new(decider);
        hall.command(Wire::ForceStart);
        hall.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
        hall.run(0.9);
        assert_eq!((hall.kinds(), hall.events[0].by), (vec![kind], None));
    }
}

#[test]
fn a_placement_is_reported_when_it_is_done_and_not_before() {
    let mut hall = hall();
    let target = at(0.0, 1.0);
    hall.next(Wire::DirectFreeBlue, target);
    hall.command(Wire::BallPlacementBlue);
    hall.ball(at(0.1, 1.0), Vector::default());
    hall.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.12), heading: Angle::ZERO });
    hall.run(3.0);
    assert_eq!(hall.kinds(), [], "a robot is still at the ball");
    hall.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.5), heading: Angle::ZERO });
    hall.run(1.0);
    assert_eq!(hall.kinds(), [Kind::PlacementSucceeded]);
    assert!(matches!(hall.events[0].what, What::PlacementSucceeded { took, .. } if took > 2.9));
    hall.run(2.0);
    assert_eq!(hall.events.len(), 1);
}

#[test]
fn what_the_controller_finds_by_itself_is_not_reported() {
    let mut hall = hall();
    hall.command(Wire::ForceStart);
    hall.packet.blue.max_allowed_bots = Some(1);
    // Resting in a defence area, for longer than any limit.
    hall.ball(at(4.0, 0.0), Vector::default());
    hall.run(30.0);
    assert_eq!(hall.kinds(), []);
}
