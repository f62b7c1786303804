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
struct Stage {
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

impl Stage {
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

fn stage() -> Stage {
    Stage::new(Decider::Person)
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
fn the_ball_is_placed_by_hand_for_a_kick_off_and_a_penalty() {
    let mut stage = stage();
    stage.ball(at(1.0, 1.0), Vector::default());
    stage.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    stage.run(1.9);
    assert_eq!(stage.deeds, [], "a person needs 2 s");
    stage.run(0.5);
    assert_eq!(stage.reasons(), [AssistantReason::SetByHand(Restart::Kickoff(Colour::Yellow))]);
    assert_eq!(stage.world.ball.position, at(0.0, 0.0));
    stage.run(20.0);
    assert_eq!(stage.deeds.len(), 1, "it lies there: {:?}", stage.deeds);
    stage.command(Wire::Halt);
    stage.next(Wire::PreparePenaltyBlue, at(1.5, 0.0));
    stage.run(3.0);
    assert_eq!(stage.reasons()[1], AssistantReason::SetByHand(Restart::Penalty(Colour::Blue)));
    let ball = stage.world.ball.position;
    assert!(ball.distance(at(1.5, 0.0)) < 1e-5, "6 m from yellow's goal at -4.5 m: {ball:?}");
}

#[test]
fn the_ball_is_placed_by_hand_only_where_no_team_may_place_it() {
    let spot = at(-2.0, 2.8);
    let mut stage = stage();
    stage.ball(at(-2.0, 3.1), Vector::default());
    stage.next(Wire::DirectFreeBlue, spot);
    stage.run(9.0);
    assert_eq!(stage.deeds, [], "blue may place, and the controller orders it to");
    stage.packet.game_events = vec![failed(Colour::Blue)];
    stage.command(Wire::Stop);
    stage.run(9.0);
    assert_eq!(stage.deeds, [], "now yellow may");
    stage.packet.game_events.push(failed(Colour::Yellow));
    stage.command(Wire::Stop);
    stage.run(3.0);
    assert_eq!(stage.reasons(), [AssistantReason::NoTeamPlaces]);
    assert!(stage.world.ball.position.distance(spot) < 1e-5, "{:?}", stage.world.ball.position);

    let mut neither = Stage::new(Decider::Person);
    neither.ball(at(-2.0, 3.1), Vector::default());
    neither.next(Wire::ForceStart, spot);
    (neither.packet.yellow.can_place_ball, neither.packet.blue.ball_placement_failures_reached) =
        (Some(false), Some(true));
    neither.run(3.0);
    assert_eq!(neither.reasons(), [AssistantReason::NoTeamPlaces]);
}

#[test]
fn the_designated_position_decides_and_in_a_preparation_the_mark() {
    let mut stage = stage();
    // A foul in the stop before a kick-off has moved the designated place.
    stage.ball(at(0.0, 0.0), Vector::default());
    stage.next(Wire::PrepareKickoffYellow, at(1.0, 2.0));
    stage.run(3.0);
    assert!(stage.world.ball.position.distance(at(1.0, 2.0)) < 1e-5, "it goes on from there alone");
    stage.command(Wire::PrepareKickoffYellow);
    stage.run(1.5);
    assert_eq!(stage.deeds.len(), 1);
    stage.run(1.5);
    assert_eq!(stage.reasons()[1], AssistantReason::SetByHand(Restart::Kickoff(Colour::Yellow)));
    assert_eq!(stage.world.ball.position, at(0.0, 0.0));
    stage.ball(at(0.3, 0.0), Vector::default());
    stage.run(10.0);
    assert_eq!(stage.deeds.len(), 2, "in the circle the controller starts");
    // No position at all: a rule-compliant one near the ball.
    let mut lost = Stage::new(Decider::Person);
    lost.ball(at(4.6, 0.0), Vector::default());
    lost.packet.next_command = Some(Wire::DirectFreeBlue as i32);
    lost.run(11.0);
    assert_eq!(lost.reasons(), [AssistantReason::NothingHappens]);
    let spot = lost.world.ball.position;
    assert_eq!(rules::restart::free_kick_fault(&lost.game.field, &lost.game.limits, spot), None, "{spot:?}");
}

#[test]
fn invalid_packets_move_nothing_off_the_field_surface() {
    let mut chance = crate::rng::Stream::new(8, "remote match");
    let mut stage = stage();
    stage.ball(at(-2.0, 3.1), Vector::default());
    stage.next(Wire::ForceStart, at(0.0, 0.0));
    stage.packet.game_events = vec![failed(Colour::Blue), failed(Colour::Yellow)];
    for _ in 0..400 {
        let number = [f32::NAN, f32::INFINITY, -1e30, 3e9, 0.0][chance.whole(0, 4) as usize];
        stage.packet.designated_position = Some(packet::Point { x: number, y: -number });
        stage.packet.command = chance.whole(0, 30) as i32 - 5;
        stage.packet.next_command = Some(chance.whole(0, 30) as i32 - 5);
        stage.packet.stage = chance.whole(0, 40) as i32 - 10;
        stage.packet.command_counter = chance.whole(0, 5);
        stage.packet.command_timestamp = u64::from(chance.whole(0, 9)) * 1_000_000_000_000;
        stage.packet.blue.max_allowed_bots = Some([0, 6, u32::MAX][chance.whole(0, 2) as usize]);
        stage.packet.yellow.goalkeeper = chance.whole(0, 99);
        stage.run(0.3);
    }
    let inside = |p: Point<Field>| stage.game.field.surface().contains(p);
    assert!(inside(stage.world.ball.position), "{:?}", stage.world.ball);
    let robots = stage.world.robots().iter().filter(|robot| robot.present);
    assert!(robots.into_iter().all(|robot| inside(robot.pose.position)));
}

#[test]
fn after_10_s_without_progress_in_stop_the_ball_is_placed_by_hand() {
    let mut stage = stage();
    stage.ball(at(-2.0, 3.1), Vector::default());
    stage.next(Wire::DirectFreeBlue, at(-2.0, 2.8));
    stage.run(9.9);
    assert_eq!(stage.deeds, []);
    stage.run(0.5);
    assert_eq!(stage.reasons(), [AssistantReason::NothingHappens]);
}

#[test]
fn an_unreachable_ball_is_brought_back_for_the_placing_team() {
    // Behind the goal, in the goal, and in the corner of the field surface.
    for (x, y) in [(4.75, 0.2), (4.6, 0.0), (4.7, 3.2)] {
        let mut stage = stage();
        stage.next(Wire::DirectFreeBlue, at(3.5, 2.8));
        stage.command(Wire::BallPlacementBlue);
        stage.ball(at(x, y), Vector::default());
        stage.run(3.0);
        assert_eq!(stage.reasons(), [AssistantReason::OutOfReach], "{x} {y}");
        let ball = stage.world.ball.position;
        assert!((ball.x() - 4.3).abs() < 1e-6 && (ball.y() - y.min(2.8)).abs() < 1e-6, "{ball:?}");
    }
    let mut reachable = stage();
    reachable.next(Wire::DirectFreeBlue, at(3.5, 2.8));
    reachable.command(Wire::BallPlacementBlue);
    reachable.ball(at(0.0, 3.25), Vector::default());
    reachable.run(20.0);
    assert_eq!(reachable.deeds, [], "a ball at a wall is the team's business");
}

#[test]
fn a_manual_placement_waits_for_robots_to_make_room_for_10_s() {
    let mut stage = stage();
    stage.ball(at(1.0, 1.0), Vector::default());
    stage.next(Wire::PrepareKickoffYellow, at(0.0, 0.0));
    stage.world.put(who(Colour::Blue, 5), Pose { position: at(0.1, 0.0), heading: Angle::ZERO });
    stage.run(11.0);
    assert_eq!(stage.deeds, []);
    stage.run(1.5);
    assert_eq!(stage.deeds.len(), 1);
}

#[test]
fn a_surplus_robot_leaves_at_a_permitted_place_and_returns_after_the_card() {
    // Behind the own goal line, and beside the halfway line.
    for (x, y) in [(4.68, 2.0), (-0.8, -3.05)] {
        let mut stage = stage();
        stage.command(Wire::ForceStart);
        stage.ball(at(0.0, 0.0), Vector::default());
        stage.packet.blue.max_allowed_bots = Some(5);
        stage.run(12.0);
        assert_eq!(stage.deeds, [], "in play no robot is taken off");
        let leaving = who(Colour::Blue, 3);
        stage.world.put(leaving, Pose { position: at(x, y), heading: Angle::ZERO });
        stage.run(1.0);
        let taken = Deed { order: WorldOrder::RemoveRobot(leaving), why: AssistantReason::HasLeft };
        assert_eq!(stage.deeds.pop().map(|(_, deed)| deed), Some(taken));
        stage.run(20.0);
        assert_eq!((stage.deeds.len(), stage.here(Colour::Blue)), (0, 5));
        stage.packet.blue.max_allowed_bots = Some(6);
        stage.run(1.0);
        assert_eq!((stage.reasons(), stage.here(Colour::Blue)), (vec![AssistantReason::MayComeBack], 6));
        let place = stage.world.robot(leaving).unwrap().pose.position;
        assert!(place.x() > 0.0 && place.x() <= 1.0 && place.y().abs() > 3.0, "{place:?}");
        stage.run(20.0);
        assert_eq!(stage.deeds.len(), 1);
    }
}

#[test]
fn in_stop_a_surplus_robot_is_taken_off_after_10_s() {
    let mut stage = stage();
    stage.packet.yellow.max_allowed_bots = Some(5);
    stage.run(9.9);
    assert_eq!(stage.deeds, []);
    stage.run(0.5);
    assert_eq!((stage.reasons(), stage.here(Colour::Yellow)), (vec![AssistantReason::TooMany], 5));
    assert!(stage.world.robot(who(Colour::Yellow, 0)).unwrap().present, "not the keeper");
    // A second card: robots are taken off one after the other.
    stage.packet.yellow.max_allowed_bots = Some(3);
    stage.run(16.0);
    assert_eq!(stage.here(Colour::Yellow), 3);
}

#[test]
fn a_substitution_takes_one_robot_off_and_returns_it_upright() {
    let mut stage = stage();
    stage.command(Wire::Halt);
    stage.packet.blue.bot_substitution_allowed = Some(true);
    let fallen = who(Colour::Blue, 4);
    stage.world.tip(fallen, true);
    stage.run(1.0);
    assert_eq!(stage.reasons(), [AssistantReason::Substituted]);
    assert_eq!(stage.deeds[0].1.order, WorldOrder::RemoveRobot(fallen));
    stage.run(10.0);
    assert_eq!(stage.reasons(), [AssistantReason::Substituted, AssistantReason::MayComeBack]);
    assert!(!stage.world.robot(fallen).unwrap().tipped && stage.here(Colour::Blue) == 6);
    stage.command(Wire::Stop);
    stage.packet.blue.bot_substitution_allowed = Some(false);
    stage.run(5.0);
    assert_eq!(stage.deeds.len(), 2);
}

#[test]
fn silent_and_foreign_controllers_cause_no_manual_act() {
    let mut stage = stage();
    stage.ball(at(1.0, 1.0), Vector::default());
    let mut other = stage.packet.clone();
    other.source_identifier = Some("another".into());
    stage.run(0.1);
    let now = Instant(stage.world.now() * 1000);
    other.command = Wire::ForceStart as i32;
    assert!(!stage.game.receive(other.clone(), now, at(0.0, 0.0)));
    assert_eq!(stage.game.phase(), Phase::Stop);
    let later = now + SILENCE + Duration::millis(1);
    assert!(stage.game.is_silent(later));
    assert!(stage.game.receive(other, later, at(0.0, 0.0)), "the first is gone");
    let mut game = RemoteMatch::new(League::DivisionB).unwrap();
    game.tick(Instant(10_000_000), at(0.0, 0.0));
    assert_eq!(Assistant::default().look(&game, &stage.world), []);
}

#[test]
fn after_a_ball_over_a_line_no_event_is_reported_until_stop() {
    let mut stage = stage();
    stage.command(Wire::ForceStart);
    stage.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
    stage.run(0.9);
    assert_eq!(stage.kinds(), [Kind::LeftTouchLine]);
    // Back on the field and out over the goal line, while the controller waits for other automatic referees.
    stage.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    stage.run(0.5);
    assert_eq!(stage.kinds(), [Kind::LeftTouchLine]);
    stage.command(Wire::Stop);
    stage.run(0.5);
    stage.command(Wire::ForceStart);
    stage.ball(at(4.0, 2.0), Vector::new(3.0, 0.0));
    stage.run(0.5);
    assert_eq!(stage.kinds(), [Kind::LeftTouchLine, Kind::LeftGoalLine]);
}

#[test]
fn a_goal_is_possible_for_a_person_and_decided_by_the_autoref() {
    let cases: [(Decider, u32, &[Kind]); 3] = [
        (Decider::Person, 6, &[Kind::PossibleGoal]),
        (Decider::AutoReferee, 6, &[Kind::Goal]),
        (Decider::AutoReferee, 5, &[Kind::InvalidGoal, Kind::LeftGoalLine]),
    ];
    for (decider, robots, kinds) in cases {
        let mut stage = Stage::new(decider);
        stage.packet.yellow.max_allowed_bots = Some(robots);
        stage.command(Wire::ForceStart);
        stage.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
        stage.run(0.5);
        assert_eq!(stage.kinds(), kinds);
        assert_eq!(stage.events[0].by, Some(Colour::Yellow), "blue's goal is at +x");
    }
    // A robot behind its own goal line is not on the field.
    let mut stage = Stage::new(Decider::AutoReferee);
    stage.packet.yellow.max_allowed_bots = Some(5);
    stage.world.put(who(Colour::Yellow, 5), Pose { position: at(-4.68, 2.0), heading: Angle::ZERO });
    stage.command(Wire::ForceStart);
    stage.ball(at(4.2, 0.0), Vector::new(4.0, 0.0));
    stage.run(0.5);
    assert_eq!(stage.kinds(), [Kind::Goal]);
}

#[test]
fn an_untouched_ball_out_of_the_field_leads_to_a_force_start() {
    for (decider, kind) in [(Decider::Person, Kind::LeftTouchLine), (Decider::AutoReferee, Kind::NoProgress)]
    {
        let mut stage = Stage::new(decider);
        stage.command(Wire::ForceStart);
        stage.ball(at(0.0, 2.5), Vector::new(0.0, 3.0));
        stage.run(0.9);
        assert_eq!((stage.kinds(), stage.events[0].by), (vec![kind], None));
    }
}

#[test]
fn a_placement_is_reported_once_when_the_robots_have_left_the_ball() {
    let mut stage = stage();
    let target = at(0.0, 1.0);
    stage.next(Wire::DirectFreeBlue, target);
    stage.command(Wire::BallPlacementBlue);
    stage.ball(at(0.1, 1.0), Vector::default());
    stage.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.12), heading: Angle::ZERO });
    stage.run(3.0);
    assert_eq!(stage.kinds(), [], "a robot is still at the ball");
    stage.world.put(who(Colour::Blue, 1), Pose { position: at(0.1, 1.5), heading: Angle::ZERO });
    stage.run(1.0);
    assert_eq!(stage.kinds(), [Kind::PlacementSucceeded]);
    assert!(matches!(stage.events[0].what, What::PlacementSucceeded { took, .. } if took > 2.9));
    stage.run(2.0);
    assert_eq!(stage.events.len(), 1);
}

#[test]
fn events_that_the_controller_finds_itself_are_not_reported() {
    let mut stage = stage();
    stage.command(Wire::ForceStart);
    stage.packet.blue.max_allowed_bots = Some(1);
    // Resting in a defence area, for longer than any limit.
    stage.ball(at(4.0, 0.0), Vector::default());
    stage.run(30.0);
    assert_eq!(stage.kinds(), []);
}
