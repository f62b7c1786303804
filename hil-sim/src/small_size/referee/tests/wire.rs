//! What goes out: packets as the game controller sends them.

use super::*;
use ssl::event::GameEventType;
use ssl::referee as sent;

/// The command of a packet; `None` for the old announcements of goals.
pub(super) fn from_wire(number: i32) -> Option<Command> {
    use Colour::{Blue, Yellow};
    Some(match sent::Command::try_from(number).unwrap() {
        sent::Command::Halt => Command::Halt,
        sent::Command::Stop => Command::Stop,
        sent::Command::NormalStart => Command::NormalStart,
        sent::Command::ForceStart => Command::ForceStart,
        sent::Command::PrepareKickoffYellow => Command::PrepareKickoff(Yellow),
        sent::Command::PrepareKickoffBlue => Command::PrepareKickoff(Blue),
        sent::Command::PreparePenaltyYellow => Command::PreparePenalty(Yellow),
        sent::Command::PreparePenaltyBlue => Command::PreparePenalty(Blue),
        sent::Command::DirectFreeYellow => Command::FreeKick(Yellow),
        sent::Command::DirectFreeBlue => Command::FreeKick(Blue),
        sent::Command::TimeoutYellow => Command::Timeout(Yellow),
        sent::Command::TimeoutBlue => Command::Timeout(Blue),
        sent::Command::BallPlacementYellow => Command::BallPlacement(Yellow),
        sent::Command::BallPlacementBlue => Command::BallPlacement(Blue),
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
    // The independent listener counts in the same clock.
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
    let mut stage = stage_with(RefereeSettings { position_always: false, ..settings() });
    stage.until(Phase::Kickoff(Colour::Yellow), 30.0);
    stage.move_ball(at(1.0, 2.9));
    stage.touch(blue(1));
    stage.kick(0.0, 5.0);
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
    stage.move_ball(at(3.0, 0.0));
    stage.touch(yellow(2));
    stage.kick(5.0, 0.0);
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
fn what_happened_is_told_until_the_ball_may_move_again() {
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
