//! Tests: the league's own packets give the game that was played. Recordings of the game controller and
//! packets made here.

use std::path::PathBuf;

use geometry::GoalEnd;
use rules::state::{CommandVerdict, Stage};
use rules::{Colour, League, Phase};
use ssl::Message;
use ssl::log::Packet;
use ssl::referee::{Command as Wire, Point as WirePoint, TeamInfo};

use super::*;

const B: Colour = Colour::Blue;
const Y: Colour = Colour::Yellow;
const S: u64 = 1_000_000;
/// An arbitrary moment of the referee's clock, µs.
const EPOCH: u64 = 1_795_220_000 * S;

fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data").join(name)
}

fn listener() -> Listener {
    Listener::new(League::DivisionB.limits().unwrap(), None, Instant(0))
}

impl Listener {
    /// A packet of a referee in this program.
    fn hears(&mut self, packet: &Referee, now: Instant, ball: Option<Point<Field>>) -> RefereeVerdict {
        self.receive(packet, SenderAddress::INTERNAL, now, ball)
    }
}

/// A packet sent `sent` µs after the epoch, its command of the same age.
fn packet(sent: u64, command: Wire, counter: u32) -> Referee {
    let team = |name: &str| TeamInfo { name: name.into(), ..TeamInfo::default() };
    Referee {
        packet_timestamp: EPOCH + sent,
        command: command as i32,
        command_counter: counter,
        command_timestamp: EPOCH + sent,
        yellow: team("yellow"),
        blue: team("blue"),
        source_identifier: Some("a".into()),
        ..Referee::default()
    }
}

fn command(verdict: RefereeVerdict) -> Option<CommandVerdict> {
    match verdict {
        RefereeVerdict::Taken(taken) => taken.command.map(|(_, received)| received),
        other => panic!("{other:?}"),
    }
}

/// Plays a recording without a ball; the phases in their order, with the packets' number in each.
fn phases(name: &str) -> (Vec<Phase<Colour>>, Listener) {
    let mut listener = listener();
    let mut phases = Vec::new();
    for record in ssl::log::open(&data(name)).unwrap() {
        let now = Instant(record.timestamp_ns as u64 / 1000);
        listener.tick(now, None);
        if let Ok(Some(Packet::Referee(packet))) = record.decode() {
            let verdict = listener.hears(&packet, now, None);
            assert!(matches!(verdict, RefereeVerdict::Taken(_) | RefereeVerdict::Copy), "{verdict:?}");
        }
        let phase = listener.game().phase;
        if phases.last() != Some(&phase) {
            phases.push(phase);
        }
    }
    (phases, listener)
}

#[test]
fn the_recorded_match_goes_through_its_phases() {
    // As an independent decoder listed the commands: the second NORMAL_START of each pair changes nothing,
    // the free kick of 20.6 s is stopped at 27.6 s, before its 10 s are over.
    let (got, listener) = phases("grsim_divB_noisy_64s.log.gz");
    let start = [
        Phase::Halt,
        Phase::Stop,
        Phase::PrepareKickoff(Y),
        Phase::Kickoff(Y),
        Phase::Stop,
        Phase::BallPlacement(B),
        Phase::Stop,
        Phase::BallPlacement(B),
        Phase::FreeKick(B),
    ];
    let rest = [
        Phase::Stop,
        Phase::Run,
        Phase::Stop,
        Phase::PrepareKickoff(Y),
        Phase::Kickoff(Y),
        Phase::Stop,
        Phase::PreparePenalty(B),
        Phase::Penalty(B),
        Phase::Stop,
        Phase::Timeout(B),
        Phase::Stop,
        Phase::Halt,
    ];
    assert_eq!(got, [&start[..], &rest[..]].concat());
    let counts = listener.counts();
    assert_eq!((counts.commands, counts.missed, counts.old, counts.unknown), (25, 0, 0, 0));
    assert_eq!(listener.game().stage, Stage::HalfTime);
    for name in ["grsim_divB_22s.log.gz", "erforce_divB_realistic_22s.log.gz"] {
        let (got, listener) = phases(name);
        assert_eq!(got, start, "{name}");
        assert_eq!((listener.counts().commands, listener.counts().missed), (11, 0));
    }
}

#[test]
fn single_packets_say_what_an_independent_decoder_reads_in_them() {
    let mut compared = 0;
    for entry in std::fs::read_dir(data("packets")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if !name.starts_with("referee") || path.extension().is_none_or(|end| end != "bin") {
            continue;
        }
        let packet = Referee::decode(&std::fs::read(&path).unwrap()[..]).unwrap();
        let json = std::fs::read_to_string(path.with_extension("json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let mut listener = listener();
        listener.hears(&packet, Instant(S), None);
        let game = listener.game();
        for (colour, label) in [(Y, "yellow"), (B, "blue")] {
            let (team, json) = (game.team(colour), &json[label]);
            assert_eq!(team.name, json["name"], "{name}");
            assert_eq!(team.score, json["score"], "{name}");
            assert_eq!(team.keeper.map(RobotNumber::number), json["goalkeeper"].as_u64(), "{name}");
            assert_eq!(team.robots_allowed.map(u64::from), json["max_allowed_bots"].as_u64(), "{name}");
            assert_eq!(team.may_place, json["can_place_ball"], "{name}");
            assert_eq!(team.timeouts, json["timeouts"], "{name}");
            let time = json["timeout_time"].as_f64().unwrap() * 1e-6;
            assert!((f64::from(team.timeout_time) - time).abs() < 1e-3, "{name}");
            let cards = json["yellow_card_times"].as_array().map_or(0, Vec::len);
            assert_eq!(team.yellow_card_times.len(), cards, "{name}");
        }
        let blue = json["blue_team_on_positive_half"].as_bool().unwrap();
        assert_eq!(game.own_goal(B), Some(if blue { GoalEnd::Positive } else { GoalEnd::Negative }));
        assert_eq!(game.own_goal(Y), game.own_goal(B).map(GoalEnd::opposite));
        assert_eq!(game.status, json["status_message"].as_str().unwrap_or(""), "{name}");
        compared += 1;
    }
    assert_eq!(compared, 14);
}

trait RobotNumber {
    fn number(self) -> u64;
}

impl RobotNumber for protocol::RobotId {
    fn number(self) -> u64 {
        u64::from(Self::number(self))
    }
}

#[test]
fn trap_03_a_designated_position_counts_in_ball_placement_only() {
    let bytes = |name: &str| std::fs::read(data("packets").join(name)).unwrap();
    let mut placed = 0;
    for name in [
        "referee_halt.bin",
        "referee_stop.bin",
        "referee_prepare_kickoff_yellow.bin",
        "referee_designated_position.bin",
        "referee_ball_placement_blue.bin",
    ] {
        let packet = Referee::decode(&bytes(name)[..]).unwrap();
        assert!(packet.designated_position.is_some(), "{name} shows the trap");
        let mut listener = listener();
        listener.hears(&packet, Instant(S), None);
        let placing = matches!(listener.game().phase, Phase::BallPlacement(_));
        let expected = placing.then(|| Point::new(1.2, 2.8));
        assert_eq!(listener.game().placement, expected, "{name}");
        placed += u32::from(placing);
    }
    assert!(placed > 0);
    // A position that is not finite or too far is dropped.
    for x in [f32::NAN, f32::INFINITY, 1e9] {
        let mut packet = packet(0, Wire::BallPlacementBlue, 1);
        packet.designated_position = Some(WirePoint { x, y: 0.0 });
        let mut listener = listener();
        listener.hears(&packet, Instant(S), None);
        assert_eq!((listener.game().phase, listener.game().placement), (Phase::BallPlacement(B), None));
    }
}

#[test]
fn trap_04_a_rising_counter_is_no_changed_command() {
    let mut listener = listener();
    let mut now = S;
    let mut send = |command, counter| {
        now += S;
        let received = listener.hears(&packet(now, command, counter), Instant(now), None);
        (super::tests::command(received), listener.game().phase)
    };
    send(Wire::Stop, 1);
    send(Wire::PrepareKickoffYellow, 2);
    assert_eq!(send(Wire::NormalStart, 3), (Some(CommandVerdict::Followed), Phase::Kickoff(Y)));
    assert_eq!(send(Wire::NormalStart, 4), (Some(CommandVerdict::Repeated), Phase::Kickoff(Y)));
    assert_eq!(send(Wire::NormalStart, 4), (None, Phase::Kickoff(Y)), "the same packet again is no command");
    send(Wire::Stop, 5);
    send(Wire::BallPlacementBlue, 6);
    assert_eq!(send(Wire::BallPlacementBlue, 7), (Some(CommandVerdict::Repeated), Phase::BallPlacement(B)));
    send(Wire::Halt, 8);
    assert_eq!(send(Wire::Halt, 9), (Some(CommandVerdict::Repeated), Phase::Halt));
}

#[test]
fn trap_05_a_pause_of_the_referee_is_no_loss() {
    let mut listener = listener();
    assert_eq!(listener.silence(Instant(S)), Silence::Never(Duration(S)));
    listener.hears(&packet(0, Wire::ForceStart, 1), Instant(S), None);
    // The longest pause of the recordings is 1.56 s.
    for pause in [25_000, 100_000, 1_562_466] {
        let now = Instant(S + pause);
        listener.tick(now, None);
        assert_eq!(listener.silence(now), Silence::Received(Duration(pause)));
        assert_eq!(listener.game().phase, Phase::Run);
    }
    assert_eq!(listener.silence(Instant(5 * S)), Silence::Silent(Duration(4 * S)));
    assert_eq!(listener.game().phase, Phase::Run, "what was said last stands");
    listener.hears(&packet(5 * S, Wire::ForceStart, 1), Instant(6 * S), None);
    assert_eq!(listener.silence(Instant(6 * S)), Silence::Received(Duration(0)));
}

#[test]
fn packets_out_of_order_and_copies_change_nothing() {
    let mut listener = listener();
    let (run, halt) = (packet(0, Wire::ForceStart, 1), packet(40_000, Wire::Halt, 2));
    listener.hears(&run, Instant(S), None);
    listener.hears(&halt, Instant(S), None);
    assert_eq!(listener.hears(&run, Instant(S), None), RefereeVerdict::Copy);
    assert_eq!(listener.hears(&halt, Instant(S), None), RefereeVerdict::Copy);
    let late = listener.hears(&packet(20_000, Wire::ForceStart, 1), Instant(S), None);
    assert_eq!(late, RefereeVerdict::Doubted { doubt: Doubt::Old(Duration(20_000)), restrains: false });
    assert_eq!(listener.game().phase, Phase::Halt);
    assert_eq!((listener.counts().old, listener.counts().copies, listener.counts().taken), (1, 2, 2));
}

#[test]
fn commands_never_received_are_reported() {
    let mut listener = listener();
    listener.hears(&packet(S, Wire::Stop, 0), Instant(2 * S), None);
    let RefereeVerdict::Taken(taken) =
        listener.hears(&packet(2 * S, Wire::ForceStart, 4), Instant(3 * S), None)
    else {
        panic!("not taken")
    };
    assert_eq!((taken.missed, listener.counts().missed), (3, 3));
}

#[test]
fn a_silent_source_is_succeeded_by_another() {
    let mut listener = listener();
    listener.hears(&packet(0, Wire::Stop, 1), Instant(0), None);
    let mut other = packet(0, Wire::ForceStart, 9);
    other.source_identifier = Some("b".into());
    let identifier = |listener: &Listener| listener.source().and_then(|source| source.identifier.clone());
    let verdict = listener.hears(&other, Instant(2 * S), None);
    assert!(matches!(verdict, RefereeVerdict::OtherSource { .. }), "{verdict:?}");
    assert_eq!((listener.game().phase, identifier(&listener)), (Phase::Stop, Some("a".into())));
    other.packet_timestamp += S;
    let RefereeVerdict::Taken(taken) = listener.hears(&other, Instant(3 * S), None) else {
        panic!("not taken")
    };
    assert_eq!(taken.new_source.flatten().and_then(|source| source.identifier), Some("a".into()));
    assert_eq!((listener.game().phase, identifier(&listener)), (Phase::Run, Some("b".into())));
}

#[test]
fn a_command_without_a_meaning_is_taken_for_halt() {
    let mut listener = listener();
    listener.hears(&packet(0, Wire::ForceStart, 1), Instant(S), None);
    let mut odd = packet(S, Wire::Halt, 2);
    odd.command = 18;
    let RefereeVerdict::Taken(taken) = listener.hears(&odd, Instant(2 * S), None) else {
        panic!("not taken")
    };
    assert_eq!((taken.unknown, listener.game().phase), (Some(18), Phase::Halt));
}

#[test]
fn a_host_that_starts_late_knows_the_age_of_the_command() {
    // NORMAL_START was given 8 s before the first packet received: 2 s are left until the ball must be in
    // play.
    let mut listener = listener();
    let mut first = packet(20 * S, Wire::NormalStart, 7);
    first.command_timestamp -= 8 * S;
    listener.hears(&first, Instant(100 * S), None);
    assert_eq!(listener.game().phase, Phase::Stop);
    listener.tick(Instant(102 * S - 1), None);
    assert_eq!(listener.game().phase, Phase::Stop);
    listener.tick(Instant(102 * S), None);
    assert_eq!(listener.game().phase, Phase::Run);
    // A command without a time is new.
    let mut listener = super::tests::listener();
    first.command_timestamp = 0;
    listener.hears(&first, Instant(100 * S), None);
    listener.tick(Instant(109 * S), None);
    assert_eq!(listener.game().phase, Phase::Stop);
}

#[test]
fn the_next_command_gives_the_next_phase() {
    let mut listener = listener();
    let mut stop = packet(0, Wire::Stop, 1);
    stop.next_command = Some(Wire::DirectFreeBlue as i32);
    listener.hears(&stop, Instant(S), None);
    assert_eq!(listener.game().next, Some(Phase::FreeKick(B)));
    let mut prepare = packet(S, Wire::PreparePenaltyYellow, 2);
    prepare.next_command = Some(Wire::NormalStart as i32);
    listener.hears(&prepare, Instant(2 * S), None);
    assert_eq!(listener.game().next, Some(Phase::Penalty(Y)));
    listener.hears(&packet(2 * S, Wire::Stop, 3), Instant(3 * S), None);
    assert_eq!(listener.game().next, None);
}

#[test]
fn a_keeper_no_robot_can_be_is_none() {
    let mut listener = listener();
    let mut odd = packet(0, Wire::Stop, 1);
    odd.blue.goalkeeper = 16;
    odd.yellow.goalkeeper = u32::MAX;
    listener.hears(&odd, Instant(S), None);
    assert_eq!((listener.game().team(B).keeper, listener.game().team(Y).keeper), (None, None));
}

#[test]
fn a_side_once_received_holds_when_a_packet_omits_it() {
    let mut listener = listener();
    assert_eq!(listener.game().own_goal(B), None);
    let mut reported = packet(0, Wire::Stop, 1);
    reported.blue_team_on_positive_half = Some(true);
    listener.hears(&reported, Instant(S), None);
    listener.hears(&packet(S, Wire::Stop, 1), Instant(2 * S), None);
    assert_eq!(listener.game().own_goal(B), Some(GoalEnd::Positive));
    assert_eq!(listener.game().own_goal(Y), Some(GoalEnd::Negative));
}
