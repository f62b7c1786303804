//! Tests: the state follows the league's graph, and is safe where a command does not.

use std::vec;
use std::vec::Vec;

use super::*;
use crate::League;

const B: Colour = Colour::Blue;
const Y: Colour = Colour::Yellow;
const S: u64 = 1_000_000;

fn limits() -> Limits {
    League::DivisionB.limits().unwrap()
}

#[expect(clippy::unnecessary_wraps, reason = "as `tick` takes it")]
fn at(x: f32, y: f32) -> Option<Point<Field>> {
    Some(Point::new(x, y))
}

/// A state after these commands, a second apart, the ball at the centre; and the time.
fn after(commands: &[RefereeCommand]) -> (GameState, u64) {
    let mut state = GameState::new();
    let mut now = 0;
    for command in commands {
        now += S;
        state.receive(*command, now, at(0.0, 0.0));
    }
    (state, now)
}

/// For every phase a path that leads to it, over edges of the graph only.
fn sequences() -> Vec<(Phase<Colour>, Vec<RefereeCommand>)> {
    let stop = RefereeCommand::Stop;
    let mut sequences = vec![
        (Phase::Halt, vec![stop, RefereeCommand::Halt]),
        (Phase::Stop, vec![RefereeCommand::Halt, stop]),
        (Phase::Run, vec![stop, RefereeCommand::ForceStart]),
    ];
    for who in Colour::ALL {
        let kickoff = RefereeCommand::PrepareKickoff(who);
        let penalty = RefereeCommand::PreparePenalty(who);
        sequences.extend([
            (Phase::Timeout(who), vec![stop, RefereeCommand::Timeout(who)]),
            (Phase::BallPlacement(who), vec![stop, RefereeCommand::BallPlacement(who)]),
            (Phase::PrepareKickoff(who), vec![stop, kickoff]),
            (Phase::Kickoff(who), vec![stop, kickoff, RefereeCommand::NormalStart]),
            (Phase::PreparePenalty(who), vec![stop, penalty]),
            (Phase::Penalty(who), vec![stop, penalty, RefereeCommand::NormalStart]),
            (Phase::FreeKick(who), vec![stop, RefereeCommand::FreeKick(who)]),
        ]);
    }
    sequences
}

#[test]
fn every_phase_is_reached_over_edges_of_the_graph() {
    for (phase, path) in sequences() {
        let mut state = GameState::new();
        for (i, command) in path.iter().enumerate() {
            let received = state.receive(*command, i as u64 * S, None);
            assert_eq!(received, CommandVerdict::Followed, "{phase:?}: {command:?}");
        }
        assert_eq!(state.phase(), phase);
    }
}

/// Freedom of robots in a phase, 0 the least: the measure of "safe" in the next test.
fn freedom(phase: Phase<Colour>) -> u32 {
    match phase {
        Phase::Halt | Phase::Timeout(_) => 0,
        Phase::Stop => 1,
        Phase::BallPlacement(_) | Phase::PrepareKickoff(_) | Phase::PreparePenalty(_) => 2,
        Phase::Kickoff(_) | Phase::Penalty(_) | Phase::FreeKick(_) => 3,
        Phase::Run => 4,
    }
}

#[test]
fn every_command_in_every_phase_has_a_safe_reading() {
    let mut counts = [0; 4];
    for (phase, path) in sequences() {
        for command in RefereeCommand::all() {
            let (mut state, now) = after(&path);
            let received = state.receive(command, now + S, at(0.0, 0.0));
            let got = state.phase();
            match received {
                CommandVerdict::Followed => {
                    assert!(follows(phase, got), "{phase:?} → {command:?} → {got:?}");
                    counts[0] += 1;
                }
                CommandVerdict::Repeated => {
                    assert_eq!(got, phase, "{phase:?} → {command:?}");
                    assert_eq!(path.last(), Some(&command));
                    counts[1] += 1;
                }
                CommandVerdict::OffGraph { from } => {
                    assert_eq!(from, phase);
                    assert!(!follows(phase, got), "{phase:?} → {command:?} → {got:?}");
                    assert!(freedom(phase) > 0 || freedom(got) == 0, "{phase:?} → {command:?} → {got:?}");
                    counts[2] += 1;
                }
                CommandVerdict::AsStop { from, then, at } => {
                    assert_eq!((from, got), (phase, Phase::Stop));
                    assert!(freedom(then) > 1 && at >= now + 2 * S);
                    counts[3] += 1;
                }
            }
            // After any command, HALT and STOP work at once.
            assert_eq!(
                state.receive(RefereeCommand::Halt, now + 2 * S, None) == CommandVerdict::Repeated,
                command == RefereeCommand::Halt
            );
            assert_eq!(state.phase(), Phase::Halt);
            state.receive(RefereeCommand::Stop, now + 3 * S, None);
            assert_eq!(state.phase(), Phase::Stop);
        }
    }
    assert_eq!(counts.iter().sum::<u32>(), 17 * 14);
    assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
}

#[test]
fn a_kick_off_is_in_play_when_the_ball_has_moved_5_cm_or_after_10_s() {
    let path = [RefereeCommand::Stop, RefereeCommand::PrepareKickoff(B), RefereeCommand::NormalStart];
    let (mut state, now) = after(&path);
    assert_eq!(state.tick(now + S, at(0.049, 0.0), &limits()), Ticked::Same);
    assert_eq!(state.phase(), Phase::Kickoff(B));
    assert_eq!(state.tick(now + S, at(0.03, 0.041), &limits()), Ticked::BallMoved); // 0.0508 m
    assert_eq!((state.phase(), state.ball_in_play()), (Phase::Run, true));
    let (mut state, now) = after(&path);
    assert_eq!(state.tick(now + 10 * S - 1, None, &limits()), Ticked::Same);
    assert_eq!(state.tick(now + 10 * S, None, &limits()), Ticked::TimeUp);
    assert_eq!(state.phase(), Phase::Run);
}

#[test]
fn a_free_kick_is_in_play_after_5_s_in_division_a_and_10_s_in_b() {
    for (league, time) in [(League::DivisionA, 5), (League::DivisionB, 10)] {
        let limits = league.limits().unwrap();
        let (mut state, now) = after(&[RefereeCommand::Stop, RefereeCommand::FreeKick(Y)]);
        assert_eq!(state.tick(now + time * S - 1, at(0.0, 0.0), &limits), Ticked::Same);
        assert_eq!(state.tick(now + time * S, at(0.0, 0.0), &limits), Ticked::TimeUp);
        assert_eq!(state.phase(), Phase::Run);
    }
}

#[test]
fn a_ball_that_was_not_seen_at_the_command_is_measured_from_where_it_shows_up() {
    let mut state = GameState::new();
    state.receive(RefereeCommand::FreeKick(Y), S, None);
    assert_eq!(state.tick(2 * S, None, &limits()), Ticked::Same);
    assert_eq!(state.tick(2 * S, at(f32::NAN, 0.0), &limits()), Ticked::Same);
    assert_eq!(state.tick(3 * S, at(2.0, 1.0), &limits()), Ticked::Same);
    assert_eq!(state.tick(4 * S, at(2.0, 1.1), &limits()), Ticked::BallMoved);
}

#[test]
fn a_penalty_frees_the_keeper_when_the_ball_moves_and_stops_after_10_s() {
    let (mut state, now) =
        after(&[RefereeCommand::Stop, RefereeCommand::PreparePenalty(Y), RefereeCommand::NormalStart]);
    assert!(!state.ball_in_play());
    assert_eq!(state.tick(now + S, at(0.06, 0.0), &limits()), Ticked::BallMoved);
    assert_eq!((state.phase(), state.ball_in_play()), (Phase::Penalty(Y), true));
    assert_eq!(state.tick(now + 2 * S, at(1.0, 0.0), &limits()), Ticked::Same);
    assert_eq!(state.tick(now + 10 * S, at(2.0, 0.0), &limits()), Ticked::TimeUp);
    assert_eq!(state.phase(), Phase::Stop);
}

#[test]
fn a_start_out_of_halt_is_read_as_stop_for_two_seconds() {
    let (mut state, now) = after(&[RefereeCommand::Stop, RefereeCommand::Halt, RefereeCommand::ForceStart]);
    assert_eq!(state.phase(), Phase::Stop);
    assert_eq!(state.tick(now + 2 * S - 1, None, &limits()), Ticked::Same);
    assert_eq!(state.tick(now + 2 * S, None, &limits()), Ticked::Released);
    assert_eq!(state.phase(), Phase::Run);
    // A HALT in between takes precedence.
    let (mut state, now) = after(&[
        RefereeCommand::Stop,
        RefereeCommand::Halt,
        RefereeCommand::ForceStart,
        RefereeCommand::Halt,
    ]);
    assert_eq!(state.tick(now + 20 * S, None, &limits()), Ticked::Same);
    assert_eq!(state.phase(), Phase::Halt);
}

#[test]
fn a_kick_off_prepared_out_of_halt_is_still_a_kick_off() {
    let mut state = after(&[RefereeCommand::Stop, RefereeCommand::Halt]).0;
    let received = state.receive(RefereeCommand::PrepareKickoff(B), 10 * S, None);
    assert_eq!(
        received,
        CommandVerdict::AsStop { from: Phase::Halt, then: Phase::PrepareKickoff(B), at: 12 * S }
    );
    state.receive(RefereeCommand::NormalStart, 11 * S, None);
    assert_eq!((state.phase(), state.tick(12 * S, None, &limits())), (Phase::Stop, Ticked::Released));
    assert_eq!(state.phase(), Phase::Kickoff(B));
}

#[test]
fn after_joining_behind_normal_start_robots_wait_until_the_ball_is_in_play() {
    let mut state = GameState::new();
    assert_eq!(state.phase(), Phase::Halt);
    let received = state.receive(RefereeCommand::NormalStart, 100 * S, None);
    assert_eq!(received, CommandVerdict::AsStop { from: Phase::Halt, then: Phase::Run, at: 110 * S });
    assert_eq!(state.tick(109 * S, None, &limits()), Ticked::Same);
    assert_eq!((state.phase(), state.tick(111 * S, None, &limits())), (Phase::Stop, Ticked::Released));
    // A command that is a minute old requires no wait.
    let mut state = GameState::new();
    state.receive(RefereeCommand::NormalStart, 40 * S, None);
    assert_eq!(state.tick(100 * S, None, &limits()), Ticked::Released);
    assert_eq!(state.phase(), Phase::Run);
    // A program that joins in a standing phase takes it as it is.
    let mut state = GameState::new();
    assert_eq!(state.receive(RefereeCommand::FreeKick(B), S, None), CommandVerdict::Followed);
    assert_eq!(state.phase(), Phase::FreeKick(B));
}

#[test]
fn trap_04_the_same_command_again_is_no_new_command() {
    // NORMAL_START after the kick-off is in play.
    let (mut state, now) =
        after(&[RefereeCommand::Stop, RefereeCommand::PrepareKickoff(B), RefereeCommand::NormalStart]);
    state.tick(now + S, at(1.0, 0.0), &limits());
    assert_eq!(
        state.receive(RefereeCommand::NormalStart, now + 2 * S, at(1.0, 0.0)),
        CommandVerdict::Repeated
    );
    assert_eq!(state.phase(), Phase::Run);
    // HALT and BALL_PLACEMENT twice.
    for command in [RefereeCommand::Halt, RefereeCommand::BallPlacement(Y)] {
        let (mut state, now) = after(&[RefereeCommand::Stop, command]);
        let before = state;
        assert_eq!(state.receive(command, now + S, None), CommandVerdict::Repeated);
        assert_eq!(state, before);
    }
}

#[test]
fn a_restart_that_is_ordered_again_before_it_is_in_play_gets_its_time_again() {
    let (mut state, now) = after(&[RefereeCommand::Stop, RefereeCommand::FreeKick(B)]);
    assert_eq!(
        state.receive(RefereeCommand::FreeKick(B), now + 4 * S, at(0.01, 0.0)),
        CommandVerdict::Repeated
    );
    assert_eq!(state.tick(now + 10 * S, at(0.0, 0.0), &limits()), Ticked::Same);
    assert_eq!(state.tick(now + 14 * S, at(0.0, 0.0), &limits()), Ticked::TimeUp);
}

#[test]
fn a_free_kick_that_is_ordered_again_after_it_was_in_play_is_a_new_one() {
    let (mut state, now) = after(&[RefereeCommand::Stop, RefereeCommand::FreeKick(B)]);
    state.tick(now + 11 * S, at(0.0, 0.0), &limits());
    assert_eq!(state.phase(), Phase::Run);
    state.receive(RefereeCommand::FreeKick(B), now + 12 * S, at(0.0, 0.0));
    assert_eq!(state.phase(), Phase::FreeKick(B));
    // A ball that rolls puts it back into play at once.
    assert_eq!(state.tick(now + 12 * S + 20_000, at(0.06, 0.0), &limits()), Ticked::BallMoved);
    assert_eq!(state.phase(), Phase::Run);
}

#[test]
fn five_of_the_stages_are_breaks() {
    let breaks = Stage::ALL.iter().filter(|stage| stage.is_break()).count();
    assert_eq!((breaks, Stage::ALL.len()), (5, 14));
    assert!(Stage::ALL.is_sorted());
}

#[test]
fn no_commands_start_robots_from_halt_within_two_seconds_without_stop() {
    let mut bits = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = move |below: u64| {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        bits % below
    };
    let (all, mut state, mut now) = (RefereeCommand::all().collect::<Vec<_>>(), GameState::new(), 0);
    // Time of the first command that would let robots move out of HALT or a time-out.
    let (mut stands, mut called) = (false, None);
    let (mut held, mut moved) = (0, 0);
    for _ in 0..100_000 {
        now += random(700_000);
        state.tick(now, at(random(100) as f32 * 0.001, 0.0), &limits());
        if random(3) == 0 {
            let command = all[random(all.len() as u64) as usize];
            state.receive(command, now, at(0.0, 0.0));
            match command {
                RefereeCommand::Halt | RefereeCommand::Timeout(_) => (stands, called) = (true, None),
                RefereeCommand::Stop => stands = false,
                _ => called = called.or(Some(now)),
            }
        }
        let may_move = called.is_some_and(|since| now >= since + 2 * S);
        if stands && !may_move {
            assert!(freedom(state.phase()) <= 1, "{state:?} at {now}");
            held += 1;
        }
        moved += u32::from(freedom(state.phase()) > 1);
    }
    assert!(held > 10_000 && moved > 10_000, "{held} {moved}");
}
