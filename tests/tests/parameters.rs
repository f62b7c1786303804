//! `parameters`: tests: a parameter that changes while a match runs changes what that team's robots do in the
//! simulator, and nothing of the other team's settings; what was changed is in the trace.

use std::io::BufReader;
use std::path::Path;

use arena::game::{Game, GameConfig, TICK_US, Watcher, header};
use casebase::CaseBase;
use hil_sim::NativeBackend;
use hil_sim::small_size::PhysicsEvent;
use host::config::ParameterChange;
use host::record::Recorder;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, RecordKind};
use protocol::frame::TeamKey;
use protocol::{RobotId, Who};
use rules::{Colour, League};

/// What a team's robots did.
#[derive(Debug, Default)]
struct Seen {
    /// Balls' speeds after its kicks, m/s.
    kicks: Vec<f32>,
    /// Greatest speed of a robot, m/s.
    fastest: f32,
    /// Greatest gain of a robot's speed within 100 ms, m/s².
    accelerations: Vec<f32>,
}

/// A match; blue's parameters are changed so from the start.
fn blue_and_yellow(seconds: f64, changes: &[&str]) -> [Seen; 2] {
    let config = GameConfig::new(League::DivisionB, 4, seconds);
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = Game::new(&config, &mut backend).expect("a match");
    for json in changes {
        let change = ParameterChange::from_json(json.as_bytes()).expect("a change");
        game.change(Colour::Blue, &change, &mut Silent).expect("accepted");
    }
    let mut seen = [Seen::default(), Seen::default()];
    let mut before: Vec<(Who, f32)> = Vec::new();
    for tick in 0..(seconds * 1e6) as u64 / TICK_US {
        game.step(&mut Silent).expect("no emulator");
        for event in game.events() {
            if let PhysicsEvent::Kicked { robot, velocity, .. } = event {
                seen[robot.colour as usize].kicks.push(velocity.norm());
            }
        }
        if tick % 10 != 0 {
            continue;
        }
        let now: Vec<(Who, f32)> =
            game.world().robots().iter().map(|robot| (robot.who, robot.velocity.norm())).collect();
        for (who, speed) in &now {
            let team = &mut seen[who.colour as usize];
            team.fastest = team.fastest.max(*speed);
            if let Some((_, had)) = before.iter().find(|(known, _)| known == who) {
                team.accelerations.push((speed - had) / 0.1);
            }
        }
        before = now;
    }
    seen
}

struct Silent;
impl Watcher for Silent {}

fn median(values: Vec<f32>) -> f32 {
    quantile(values, 0.5)
}

/// The value that this share of them is below.
fn quantile(mut values: Vec<f32>, share: f64) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values[(values.len() as f64 * share) as usize]
}

#[test]
fn speed_and_acceleration_limits_slow_the_team_that_sets_them() {
    let [yellow, blue] = blue_and_yellow(
        40.0,
        &[r#"{"key":"limits.speed","value":0.8}"#, r#"{"key":"limits.acceleration","value":1.0}"#],
    );
    // What a robot does beyond its plan is the controller's error and what pushes it: within a quarter of a
    // metre a second.
    assert!(blue.fastest < 1.05 && yellow.fastest > 1.5, "{blue:?} {yellow:?}");
    // Of a thousand tenths of a second five may be a push by another robot.
    let [yellow, blue] = [yellow, blue].map(|team| quantile(team.accelerations, 0.995));
    assert!(blue < 2.0 && yellow > 2.0, "{blue} {yellow}");
}

#[test]
fn a_kick_gain_of_2_halves_the_ordered_speed() {
    let default = blue_and_yellow(240.0, &[]);
    let kicks: Vec<String> =
        (0..6).map(|n| format!(r#"{{"key":"calibration.kick","robot":{n},"value":2.0}}"#)).collect();
    let changed = blue_and_yellow(240.0, &kicks.iter().map(String::as_str).collect::<Vec<_>>());
    let [_, blue_default] = default;
    let [yellow, blue] = changed;
    let counts = [&blue_default, &blue, &yellow].map(|team| team.kicks.len());
    assert!(counts.iter().all(|count| *count >= 5), "{counts:?} kicks: too few to compare");
    let (before, after) = (median(blue_default.kicks), median(blue.kicks));
    assert!(after < before * 0.7, "{after} m/s with, {before} m/s without");
    assert!(median(yellow.kicks) > after * 1.3, "the other team kicks as before");
}

#[test]
fn replaying_a_trace_repeats_parameter_changes_and_packets() {
    let config = GameConfig::new(League::DivisionB, 4, 10.0);
    let stem = Path::new(env!("CARGO_TARGET_TMPDIR")).join("parameters");
    let mut recorder = Recorder::begin(&stem, &header("test", "test", &config)).expect("a recording");
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = Game::new(&config, &mut backend).expect("a match");
    let changes = [
        r#"{"key":"limits.speed","value":1.2}"#,
        r#"{"key":"calibration.kick","robot":2,"value":1.3}"#,
        r#"{"key":"tactics","value":"none"}"#,
        r#"{"key":"ball.roll","value":0.5}"#,
        r#"{"key":"limits.speed","value":null}"#,
    ];
    for json in changes {
        for _ in 0..200 {
            game.step(&mut recorder).expect("no emulator");
        }
        let change = ParameterChange::from_json(json.as_bytes()).expect("a change");
        game.change(Colour::Yellow, &change, &mut recorder).expect("accepted");
        let far = ParameterChange::from_json(br#"{"key":"limits.speed","value":99.0}"#).expect("a change");
        assert!(game.change(Colour::Yellow, &far, &mut recorder).is_err());
    }
    for _ in 0..100 {
        game.step(&mut recorder).expect("no emulator");
    }
    recorder.finish().expect("written");
    let [log, trace] = Recorder::files(&stem);
    let reader = Reader::new(flate2::bufread::MultiGzDecoder::new(BufReader::new(
        foreign::open(&trace).expect("a trace"),
    )))
    .expect("its header");
    let read = RecordingHeader::from_json(reader.header()).expect("a header");
    let mut again = Recheck::new(&read, TeamKey::ZERO).expect("hosts");
    let mut changed = 0;
    for record in reader {
        changed += usize::from(record.kind == RecordKind::Parameter);
        assert!(again.feed(&record));
    }
    assert_eq!(changed, changes.len());
    for (counts, difference) in again.results() {
        assert!(difference.is_none() && counts.same > 1000, "{difference:?}");
    }
    let yellow = (0..2).filter_map(|i| again.host(i)).find(|host| host.settings().us == Colour::Yellow);
    let settings = yellow.expect("its host").settings();
    let robot = RobotId::new(2).expect("a number");
    assert_eq!((settings.kick[robot.index()], settings.roll, settings.limits.speed), (1.3, Some(0.5), None));
    for file in [log, trace] {
        std::fs::remove_file(file).expect("it was there");
    }
}
