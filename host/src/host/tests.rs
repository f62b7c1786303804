//! Tests: use of the learned values by a host.

use protocol::host::{Directive, KickOrder};

use super::*;

#[test]
fn a_learned_gain_scales_the_order_within_its_bounds_and_only_where_the_host_plays_by_it() {
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
