//! Tests: use of the learned values by a host.

use protocol::host::{Directive, KickOrder};

use super::*;
use crate::strategy::Tactics;

#[test]
fn a_learned_gain_scales_kicks_within_its_bounds_where_the_host_uses_it() {
    let id = RobotId::new(3).unwrap();
    let ordered = |gain: f32, learns: bool| {
        let settings = HostSettings { learns, ..HostSettings::new(Colour::Blue, League::DivisionB, 1) };
        let mut host = Host::new(settings, Instant(0));
        host.learned = Learned::of_kick(id, gain);
        let at = Point::<geometry::Field>::new(1.0, 0.0).into();
        match host.calibrated(id, Directive::Kick { at, kick: KickOrder::Flat(300) }) {
            Directive::Kick { kick: KickOrder::Flat(speed), .. } => speed,
            other => panic!("{other:?}"),
        }
    };
    let near = |speed: u16, expected: u16| assert!(speed.abs_diff(expected) <= 1, "{speed}, not {expected}");
    near(ordered(0.72, true), 417);
    near(ordered(0.72, false), 300);
    near(ordered(0.45, true), 510);
    near(ordered(1.8, true), 240);
}

#[test]
fn a_changed_parameter_holds_at_once_and_a_set_gain_replaces_the_learned_one() {
    let id = RobotId::new(3).unwrap();
    let settings = HostSettings { learns: true, ..HostSettings::new(Colour::Blue, League::DivisionB, 1) };
    let mut host = Host::new(settings, Instant(0));
    host.learned = Learned::of_kick(id, 0.9);
    let change = |host: &mut Host, json: &str| host.handle(Instant(0), Input::Parameter(json.as_bytes()));
    assert!((host.kicks_by(id) - 0.9).abs() < 0.01);
    let kick = r#"{"key":"calibration.kick","robot":3,"value":1.25}"#;
    assert_eq!(change(&mut host, kick), InputVerdict::Changed);
    assert_eq!(host.kicks_by(id), 1.25);
    assert_eq!(
        change(&mut host, r#"{"key":"calibration.kick","robot":3,"value":null}"#),
        InputVerdict::Changed
    );
    assert!((host.kicks_by(id) - 0.9).abs() < 0.01);

    assert_eq!(change(&mut host, r#"{"key":"tactics","value":"none"}"#), InputVerdict::Changed);
    assert_eq!(host.settings().tactics, Tactics::NONE);
    assert_eq!(change(&mut host, r#"{"key":"ball.roll","value":0.6}"#), InputVerdict::Changed);
    assert_eq!(host.roll, Some(0.6));
    assert_eq!(change(&mut host, r#"{"key":"ball.roll","value":null}"#), InputVerdict::Changed);
    assert_eq!((host.roll, host.settings().roll), (None, None));

    let before = host.settings().limits;
    for wrong in [r#"{"key":"limits.speed","value":0.1}"#, r#"{"key":"name","value":"us"}"#, "x", ""] {
        assert!(matches!(change(&mut host, wrong), InputVerdict::NotChanged(_)), "{wrong}");
    }
    assert_eq!(host.settings().limits, before);
}
