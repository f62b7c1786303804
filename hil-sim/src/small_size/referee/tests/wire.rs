//! Tests of the packets: as the game controller sends them.

use super::*;
use ssl::event::GameEventType;
use ssl::referee as sent;

/// The command of a packet; `None` for the obsolete announcements of goals.
pub(super) fn from_wire(number: i32) -> Option<RefereeCommand> {
    use Colour::{Blue, Yellow};
    Some(match sent::Command::try_from(number).unwrap() {
        sent::Command::Halt => RefereeCommand::Halt,
        sent::Command::Stop => RefereeCommand::Stop,
        sent::Command::NormalStart => RefereeCommand::NormalStart,
        sent::Command::ForceStart => RefereeCommand::ForceStart,
        sent::Command::PrepareKickoffYellow => RefereeCommand::PrepareKickoff(Yellow),
        sent::Command::PrepareKickoffBlue => RefereeCommand::PrepareKickoff(Blue),
        sent::Command::PreparePenaltyYellow => RefereeCommand::PreparePenalty(Yellow),
        sent::Command::PreparePenaltyBlue => RefereeCommand::PreparePenalty(Blue),
        sent::Command::DirectFreeYellow => RefereeCommand::FreeKick(Yellow),
        sent::Command::DirectFreeBlue => RefereeCommand::FreeKick(Blue),
        sent::Command::TimeoutYellow => RefereeCommand::Timeout(Yellow),
        sent::Command::TimeoutBlue => RefereeCommand::Timeout(Blue),
        sent::Command::BallPlacementYellow => RefereeCommand::BallPlacement(Yellow),
        sent::Command::BallPlacementBlue => RefereeCommand::BallPlacement(Blue),
        sent::Command::GoalYellow | sent::Command::GoalBlue => return None,
        old => panic!("{old:?} is not sent any more"),
    })
}

#[test]
fn about_forty_packets_a_second_and_one_more_for_each_command() {
    let mut stage = stage();
    stage.run(1.0);
    // Steps of 10 ms make it one every 30 ms.
    assert!((33..=42).contains(&stage.packets.len()), "{}", stage.packets.len());
    let counters: Vec<u32> = stage.packets.iter().map(|packet| packet.command_counter).collect();
    assert!(counters.is_sorted());
    assert_eq!(*counters.last().unwrap(), 1);
    stage.until(Phase::Stop, 3.0);
    let first = stage.packets.iter().find(|packet| packet.command == sent::Command::Stop as i32).unwrap();
    assert_eq!((first.command_counter, first.command_timestamp), (2, stage.now.0));
}

#[test]
fn timestamps_begin_at_the_epoch() {
    let epoch_us = 1_700_000_000_000_000;
    let mut stage = stage_with(RefereeSettings { epoch_us, ..settings() });
    // The independent game state uses the same clock.
    stage.referee.observe(&Observation {
        time: Instant(20_000),
        ball: None,
        fastest: 0.0,
        robots: &[],
        crashes: &[],
    });
    let packet = stage.referee.poll_packet().unwrap();
    assert_eq!((packet.packet_timestamp, packet.command_timestamp), (epoch_us + 20_000, epoch_us + 20_000));
}

#[test]
fn trap_03_the_designated_position_is_sent_in_every_command_unless_asked_otherwise() {
    for position_always in [true, false] {
        let mut stage = stage_with(RefereeSettings { position_always, ..settings() });
        stage.step();
        let position = stage.referee.packet().designated_position;
        assert_eq!(position.is_some(), position_always);
        if let Some(position) = position {
            assert_eq!((position.x, position.y), (0.0, 0.0));
        }
    }
}

#[test]
fn the_position_is_in_millimetres_and_always_there_in_a_placement() {
    let mut stage = kickoff(RefereeSettings { position_always: false, ..settings() });
    stage.kick_from(at(1.0, 2.9), blue(1), [0.0, 5.0]);
    stage.until(Phase::Stop, 1.0);
    assert_eq!(stage.referee.packet().designated_position, None);
    stage.kick(0.0, 0.0);
    stage.until(Phase::BallPlacement(Colour::Yellow), 1.0);
    let position = stage.referee.packet().designated_position.unwrap();
    assert!((position.x - 1000.0).abs() < 1.0 && (position.y - 2800.0).abs() < 1.0, "{position:?}");
}

#[test]
fn a_goal_is_announced_once_by_the_old_command() {
    let mut stage = in_play();
    stage.put(blue(0), at(4.45, 0.8));
    stage.kick_from(at(3.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.run(1.0);
    let goal = sent::Command::GoalYellow as i32;
    let announced: Vec<usize> =
        (0..stage.packets.len()).filter(|at| stage.packets[*at].command == goal).collect();
    assert_eq!(announced.len(), 1);
    let [packet, next] = [0, 1].map(|after| &stage.packets[announced[0] + after]);
    assert_eq!(packet.command_counter, next.command_counter);
    assert_eq!(next.command, sent::Command::Halt as i32);
    assert_eq!((next.yellow.score, next.blue.score), (1, 0));
    assert_eq!(next.next_command, Some(sent::Command::PrepareKickoffBlue as i32));
}

#[test]
fn packets_list_events_until_the_ball_may_move_again() {
    let mut stage = in_play();
    stage.touch(blue(1));
    stage.kick(0.0, 6.0);
    stage.until(Phase::Stop, 2.0);
    let packet = stage.referee.packet();
    let kinds: Vec<i32> = packet.game_events.iter().filter_map(|event| event.r#type).collect();
    assert_eq!(kinds, [GameEventType::BallLeftFieldTouchLine as i32]);
    let Some(ssl::event::Event::BallLeftFieldTouchLine(left)) = &packet.game_events[0].event else {
        panic!()
    };
    assert_eq!((left.by_team, left.by_bot), (ssl::common::Team::Blue as i32, Some(1)));
    stage.move_ball(stage.referee.placement().unwrap());
    stage.kick(0.0, 0.0);
    stage.until(Phase::FreeKick(Colour::Yellow), 20.0);
    assert!(stage.referee.packet().game_events.is_empty());
}

#[test]
fn in_preparation_the_next_command_is_normal_start() {
    let mut stage = stage();
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 20.0);
    assert_eq!(stage.referee.packet().next_command, Some(sent::Command::NormalStart as i32));
}

#[test]
fn every_event_but_our_three_has_the_leagues_type_and_evidence() {
    let shot = ShotEvent {
        kicker: Some(yellow(3)),
        from: at(1.0, 0.0),
        max_height: 0.1,
        last_touch: Some(Instant(7)),
        robots: 6,
    };
    let ball = at(0.5, 0.25);
    let (duration, distance, speed) = (5.5, 0.3, 1.7);
    let crash = (1.8, 0.5, 0.25);
    let cases = [
        (What::LeftTouchLine, 6),
        (What::LeftGoalLine, 7),
        (What::AimlessKick { from: ball }, 11),
        (What::PossibleGoal { shot }, 39),
        (What::Goal { shot: Some(shot) }, 8),
        (What::InvalidGoal { shot, reason: Invalid::TooHigh }, 42),
        (What::NoProgress { duration }, 2),
        (What::DoubleTouch, 14),
        (What::KeeperHeldBall { duration }, 13),
        (What::BoundaryCrossing, 41),
        (What::BallTooFast { speed, chipped: true }, 18),
        (What::DribbledTooFar { end: ball }, 17),
        (What::AttackerTooClose { distance, ball }, 19),
        (What::AttackerTouchedBall { depth: distance }, 15),
        (What::DefenderInArea { depth: distance }, 31),
        (What::DefenderTooClose { distance }, 29),
        (What::TooFastInStop { speed }, 28),
        (What::InterferedPlacement, 20),
        (
            What::CrashUnique {
                victim: id(4),
                crash_speed: crash.0,
                speed_difference: crash.1,
                angle: crash.2,
            },
            22,
        ),
        (
            What::CrashDrawn {
                yellow: id(3),
                blue: id(4),
                crash_speed: crash.0,
                speed_difference: crash.1,
                angle: crash.2,
            },
            21,
        ),
        (What::Pushed { victim: id(4), distance }, 24),
        (What::HeldBall { duration }, 26),
        (What::TooManyRobots { allowed: 5, on_field: 6, ball }, 38),
        (What::PenaltyFailed { reason: PenaltyEnd::Saved }, 43),
        (What::PlacementSucceeded { took: 3.0, precision: 0.1, distance }, 5),
        (What::PlacementFailed { remaining: 1.0, nearest: -1.0 }, 3),
        (What::MultipleFouls { caused_by: Vec::new() }, 34),
        (What::MultipleCards, 32),
        (What::MovedInHalt { speed }, 0),
        (What::Blocked { reason: Reason::BallOut }, 0),
        (What::TooCloseInStop { distance }, 0),
    ];
    // The numbers are the reference's table of event types; 0 where the league has none.
    assert_eq!(cases.len(), Kind::ALL.len());
    for ((what, number), kind) in cases.into_iter().zip(Kind::ALL) {
        assert_eq!(what.kind(), *kind);
        let event = RefereeEvent {
            at: Instant(9),
            by: Some(Colour::Blue),
            robot: Some(id(2)),
            place: at(-1.0, 2.0),
            what,
        };
        let reported = event.to_wire(1_000);
        assert_eq!(reported.as_ref().map_or(0, |reported| reported.r#type.unwrap()), number, "{kind:?}");
        let Some(reported) = reported else { continue };
        assert_eq!(reported.created_timestamp, Some(1_009));
        // The league's name of the type, in lower case, is ours.
        let name = format!("{:?}", GameEventType::try_from(number).unwrap()).to_lowercase();
        assert_eq!(name, kind.label().replace('_', ""), "{kind:?}");
        // The event is the one that the type names: both have the same name.
        let event = format!("{:?}", reported.event.unwrap());
        let event = event.split('(').next().unwrap().to_lowercase();
        assert_eq!(event, name);
    }
}

#[test]
fn messages_of_crash_and_goal_have_the_measured_values() {
    let event = |what| RefereeEvent {
        at: Instant(9),
        by: Some(Colour::Blue),
        robot: Some(id(2)),
        place: at(-1.0, 2.0),
        what,
    };
    let crash = What::CrashUnique { victim: id(4), crash_speed: 1.8, speed_difference: 0.5, angle: 0.25 };
    let Some(ssl::event::Event::BotCrashUnique(crash)) = event(crash).to_wire(0).unwrap().event else {
        panic!()
    };
    let vector = |x, y| Some(ssl::common::Vector2 { x, y });
    assert_eq!(
        crash,
        ssl::event::BotCrashUnique {
            by_team: 2,
            violator: Some(2),
            victim: Some(4),
            location: vector(-1.0, 2.0),
            crash_speed: Some(1.8),
            speed_diff: Some(0.5),
            crash_angle: Some(0.25),
        }
    );
    let shot = ShotEvent {
        kicker: Some(yellow(3)),
        from: at(1.0, 0.0),
        max_height: 0.1,
        last_touch: Some(Instant(7)),
        robots: 6,
    };
    let goal = event(What::InvalidGoal { shot, reason: Invalid::RecentFoul(Kind::CrashDrawn) });
    let Some(ssl::event::Event::InvalidGoal(goal)) = goal.to_wire(1_000).unwrap().event else { panic!() };
    assert_eq!(
        goal,
        ssl::event::Goal {
            by_team: 2,
            kicking_bot: Some(3),
            location: vector(-1.0, 2.0),
            kick_location: vector(1.0, 0.0),
            max_ball_height: Some(0.1),
            kicking_team: Some(1),
            num_robots_by_team: Some(6),
            last_touch_by_team: Some(1_007),
            message: Some("recent foul: bot_crash_drawn".into()),
        }
    );
}
