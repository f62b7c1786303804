//! `kick_test`: tests: a robot whose kicker is tested kicks by itself; the gain that is fitted is the one
//! that the simulated kicker has, and with it the ball leaves as fast as ordered. The trace gives all of it
//! again.

use std::io::BufReader;
use std::path::Path;

use arena::game::{Game, GameConfig, TICK_US, Watcher, header};
use casebase::CaseBase;
use geometry::Point;
use hil_sim::NativeBackend;
use hil_sim::small_size::worlds::{NamedWorld, WorldChoice};
use hil_sim::small_size::{Ball, PhysicsEvent};
use host::config::ParameterChange;
use host::record::Recorder;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, RecordKind};
use host::robot_test::{KickReport, TestOrder, TestState};
use protocol::frame::TeamKey;
use protocol::{RobotId, Who};
use rules::state::RefereeCommand;
use rules::{Colour, League, Phase};

/// The robot whose kicker is tested.
const TESTED: u8 = 3;
/// Kicks of a test.
const KICKS: u8 = 10;
/// Longest time of a test, s.
const LONGEST: f64 = 120.0;

fn tested() -> Who {
    Who { colour: Colour::Blue, id: RobotId::new(TESTED).unwrap() }
}

fn game<'a>(backend: &mut NativeBackend<'a>) -> Game<'a> {
    let mut config = GameConfig::new(League::DivisionB, 6, 600.0);
    config.world = WorldChoice::Named(NamedWorld::WeakKickers);
    Game::new(&config, backend).expect("a match")
}

/// Plays a test to its end; the ball is put back to the middle after each kick, as a helper does. Returns the
/// report and the speeds of the balls that the robot kicked.
fn test_kicks(game: &mut Game<'_>, watcher: &mut dyn Watcher) -> (KickReport, Vec<f32>) {
    game.test(Colour::Blue, TestOrder::Kick { robot: TESTED, kicks: KICKS }, watcher).expect("a test");
    game.test(Colour::Yellow, TestOrder::Stand, watcher).expect("they stand");
    let (mut speeds, mut measured) = (Vec::new(), 0);
    for _ in 0..(LONGEST * 1e6) as u64 / TICK_US {
        if game.referee().phase() != Phase::Run {
            game.command(RefereeCommand::ForceStart);
        }
        game.step(watcher).expect("no emulator");
        for event in game.events() {
            if let PhysicsEvent::Kicked { robot, velocity, .. } = event {
                assert_eq!(*robot, tested(), "no other robot kicks");
                speeds.push(velocity.norm());
            }
        }
        let report = game.host(Colour::Blue).kick_test().expect("a test");
        if report.state == TestState::Done {
            return (report, speeds);
        }
        if report.kicks.len() > measured {
            measured = report.kicks.len();
            game.put_ball(Ball::at(Point::new(0.0, 0.0)));
        }
    }
    panic!("not done in {LONGEST} s: {:?}", game.host(Colour::Blue).kick_test());
}

fn median(mut values: Vec<f32>) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values[values.len() / 2]
}

#[test]
fn the_fitted_gain_is_the_kickers_and_corrects_its_speed() {
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = game(&mut backend);
    let truth = game.world().robot(tested()).expect("it plays").traits().kick_gain;
    let (report, before) = test_kicks(&mut game, &mut Silent);
    let gain = report.gain.expect("ten kicks");
    eprintln!("truth {truth}, fitted {gain:?}, {:?}", report.kicks);
    assert!((0.4..0.95).contains(&truth), "{truth}: a weak kicker");
    assert!((gain.value / truth - 1.0).abs() < 0.06, "{gain:?} of {truth}");
    assert_eq!((report.kicks.len(), gain.samples), (usize::from(KICKS), usize::from(KICKS)));
    // Taken as the robot's parameter, as the page does.
    let json = format!(r#"{{"key":"calibration.kick","robot":{TESTED},"value":{}}}"#, gain.value);
    let change = ParameterChange::from_json(json.as_bytes()).expect("a change");
    game.change(Colour::Blue, &change, &mut Silent).expect("accepted");
    let (_, after) = test_kicks(&mut game, &mut Silent);
    // Speeds in turn, 3.2, 2.6, 3.8 and 4.4 m/s: their median is 3.5 m/s.
    let (before, after) = (median(before), median(after));
    assert!(before < 3.5 * 0.95 && (after / 3.5 - 1.0).abs() < 0.1, "{before} m/s before, {after} m/s after");
    // Ended: the coach gives orders again.
    game.test(Colour::Blue, TestOrder::End, &mut Silent).expect("an end");
    assert_eq!(game.host(Colour::Blue).kick_test(), None);
}

#[test]
fn halt_stops_a_kick_test_and_a_trace_repeats_it() {
    let stem = Path::new(env!("CARGO_TARGET_TMPDIR")).join("kick-test");
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = game(&mut backend);
    let mut recorder = Recorder::begin(&stem, &header("test", "test", game.config())).expect("a recording");
    for _ in 0..100 {
        game.step(&mut recorder).expect("no emulator");
    }
    game.test(Colour::Blue, TestOrder::Kick { robot: TESTED, kicks: KICKS }, &mut recorder).expect("a test");
    let refused = game.test(Colour::Blue, TestOrder::Kick { robot: 16, kicks: KICKS }, &mut recorder);
    assert!(refused.is_err());
    for _ in 0..400 {
        if !matches!(game.referee().phase(), Phase::Run) {
            game.command(RefereeCommand::ForceStart);
        }
        game.step(&mut recorder).expect("no emulator");
    }
    assert_ne!(game.host(Colour::Blue).kick_test().map(|report| report.state), Some(TestState::WaitsForGame));
    assert!(game.command(RefereeCommand::Halt));
    for _ in 0..200 {
        game.step(&mut recorder).expect("no emulator");
    }
    assert!(game.world().robot(tested()).expect("it plays").velocity.norm() < 0.02, "it stands");
    recorder.finish().expect("written");
    let [log, trace] = Recorder::files(&stem);
    let file = BufReader::new(foreign::open(&trace).expect("a trace"));
    let reader = Reader::new(flate2::bufread::MultiGzDecoder::new(file)).expect("its header");
    let read = RecordingHeader::from_json(reader.header()).expect("a header");
    let mut again = Recheck::new(&read, TeamKey::ZERO).expect("hosts");
    let mut tests = 0;
    for record in reader {
        tests += usize::from(record.kind == RecordKind::Test);
        assert!(again.feed(&record));
    }
    assert_eq!(tests, 1);
    for (counts, difference) in again.results() {
        assert!(difference.is_none() && counts.same > 500, "{difference:?}");
    }
    for file in [log, trace] {
        std::fs::remove_file(file).expect("it was there");
    }
}

struct Silent;
impl Watcher for Silent {}
