//! Tests: the figure agrees with the recording. Counted shapes and hand-made recordings.

use hil_sim::NativeBackend;

use super::legend::LISTED;
use super::*;
use crate::names::Cast;
use crate::recording::RecordedKick;
use crate::trial::{TrialConfig, run};
use brain::Approach;
use protocol::RobotId;

fn sample(time: f32, x: f32, holder: Option<usize>) -> RecordedSample {
    RecordedSample {
        time,
        ball: Point::new(x, 0.0),
        holder,
        robots: vec![Pose::from_mm_deg(1000.0 * x - 130.0, 0.0, 0.0), Pose::from_mm_deg(900.0, 0.0, 180.0)],
    }
}

#[test]
fn a_carried_and_kicked_ball_is_a_thick_and_then_a_dotted_line() {
    let mut recording = Recording {
        cast: Cast { attackers: vec![RobotId::new(1).unwrap()], opponents: vec![OpponentRole::Defender] },
        ..Recording::default()
    };
    let held = (0..20).map(|i| sample(i as f32 * 0.04, i as f32 * 0.01, Some(0)));
    let rolling = (20..60).map(|i| sample(i as f32 * 0.04, i as f32 * 0.03 - 0.4, None));
    recording.samples = held.chain(rolling).collect();
    let kick = LEGGED_KICK;
    recording.kicks.push(RecordedKick {
        time: 0.79,
        robot: 0,
        kick,
        from: Point::new(0.19, 0.0),
        rest: Point::default(),
    });
    let svg = picture(&recording);
    let thick = format!(r#"stroke="{}" stroke-width="6""#, ATTACKERS[0]);
    assert_eq!(svg.matches(&thick).count(), 1 + 1, "with the legend's");
    assert_eq!(svg.matches("stroke-dasharray").count(), 1 + 1, "with the legend's");
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
}

const LEGGED_KICK: protocol::robot_io::LeggedKick = protocol::robot_io::LeggedKick::ForwardSoft;

#[test]
fn a_trial_with_gameplays_lists_each_that_could_be_seen() {
    let config = TrialConfig::new(Scenario::MiddleBack, Configuration::DefenderGoalie, Approach::Cases, 2);
    let mut recording = Recording::default();
    let report = run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut recording]).unwrap();
    let svg = picture(&recording);
    let starts = displayed_starts(&recording);
    assert!(!starts.is_empty());
    for start in starts.iter().take(LISTED) {
        assert!(svg.contains(&start.case), "{}", start.case);
    }
    assert_eq!(svg.contains(" more</text>"), starts.len() > LISTED, "what the list leaves out is told");
    assert!(svg.contains(&format!("{} after", report.outcome.label())));
}

#[test]
fn nothing_recorded_is_an_empty_field() {
    assert!(picture(&Recording::default()).contains("<svg"));
}

#[test]
fn labels_avoid_what_is_there() {
    let at = Px::new(0.0, 0.0);
    assert_eq!(free_spot(at, 34.0, &[]), Px::new(0.0, -34.0));
    let spot = free_spot(at, 34.0, &[Px::new(0.0, -34.0)]);
    assert!(spot.distance(Px::new(0.0, -34.0)) >= CLEAR);
}
