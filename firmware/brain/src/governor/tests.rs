//! Every reason to brake and to limit, one by one, and the table of what passes in which phase.

extern crate std;

use std::boxed::Box;

use super::*;

const HEALTHY: Health = Health { battery: Some(16.0), tipped: false, kicker_ready: true };

fn go(x: f32) -> Wanted {
    let twist = Twist { linear: Vector::new(x, 0.0), angular: 1.0 };
    Wanted { twist, dribbler: 0.5, kick: OmniKick::Flat(3.0) }
}

fn at(ms: u64, phase: Phase<Side>) -> Circumstances<'static> {
    let now = Instant(ms * 1000);
    Circumstances {
        now,
        host: Some(Hearing { frame: Some(now), command: Some(now) }),
        phase: Some(phase),
        placed: true,
        health: &HEALTHY,
        odometry: Twist::default(),
    }
}

/// A robot that has received the host every 10 ms up to `ms`, and drives with 3 m/s.
fn driving(ms: u64, phase: Phase<Side>) -> Governor {
    let mut governor = Governor::new(League::DivisionB);
    for t in (0..=ms).step_by(10) {
        governor.receive_host(Instant(t * 1000));
        governor.rule(&at(t, phase), &go(3.0));
    }
    governor
}

fn why(ruling: Ruling) -> Reasons {
    match ruling {
        Ruling::Braking(reasons) => reasons,
        other => panic!("not braking: {other:?}"),
    }
}

#[test]
fn with_nothing_amiss_everything_passes() {
    let mut governor = driving(600, Phase::Run);
    assert_eq!(governor.rule(&at(610, Phase::Run), &go(3.0)), (go(3.0), Ruling::Allowed));
}

#[test]
fn each_reason_alone_brakes_with_dribbler_off_and_kicker_discharged() {
    let now = Instant(610_000);
    let silent = |ms: u64| Some(Instant((610 - ms) * 1000));
    let tipped = Health { tipped: true, ..HEALTHY };
    let moved = |x, angular| Twist { linear: Vector::new(x, 0.0), angular };
    let run = at(610, Phase::Run);
    let cases = [
        (Circumstances { phase: Some(Phase::Halt), ..run }, LimitReason::Halt),
        (Circumstances { phase: Some(Phase::Timeout(Side::Theirs)), ..run }, LimitReason::Halt),
        (
            Circumstances { host: Some(Hearing { frame: silent(100), command: silent(100) }), ..run },
            LimitReason::Silence,
        ),
        (Circumstances { host: Some(Hearing { frame: None, command: None }), ..run }, LimitReason::Silence),
        (
            Circumstances { host: Some(Hearing { frame: Some(now), command: silent(100) }), ..run },
            LimitReason::NoCommand,
        ),
        (
            Circumstances { host: Some(Hearing { frame: Some(now), command: None }), ..run },
            LimitReason::NoCommand,
        ),
        (Circumstances { placed: false, ..run }, LimitReason::Lost),
        (Circumstances { health: &tipped, ..run }, LimitReason::Tipped),
        (Circumstances { odometry: moved(0.0, 30.1), ..run }, LimitReason::Spinning),
        (Circumstances { odometry: moved(0.0, -30.1), ..run }, LimitReason::Spinning),
        (Circumstances { odometry: moved(f32::NAN, 0.0), ..run }, LimitReason::NotANumber),
        (Circumstances { odometry: moved(0.0, f32::INFINITY), ..run }, LimitReason::NotANumber),
    ];
    for (circumstances, expected) in cases {
        let (given, ruling) = driving(600, Phase::Run).rule(&circumstances, &go(3.0));
        let reasons = why(ruling);
        assert!(reasons.has(expected), "{expected:?}: {reasons:?}");
        assert_eq!((given.dribbler, given.kick), (0.0, OmniKick::Discharge), "{expected:?}");
        // 3 m/s less 5 m/s² for 10 ms, or less where the body is slower already.
        assert!(given.twist.linear.norm() < 2.951, "{expected:?}: {given:?}");
    }
}

#[test]
fn numbers_that_are_none_brake_wherever_they_stand() {
    let twist = |x, y, angular| Twist { linear: Vector::new(x, y), angular };
    let wanted = [
        Wanted { twist: twist(f32::NAN, 0.0, 0.0), ..go(0.0) },
        Wanted { twist: twist(0.0, f32::INFINITY, 0.0), ..go(0.0) },
        Wanted { twist: twist(0.0, 0.0, f32::NAN), ..go(0.0) },
        Wanted { dribbler: f32::NAN, ..go(0.0) },
        Wanted { kick: OmniKick::Flat(f32::NAN), ..go(0.0) },
        Wanted { kick: OmniKick::Chip(f32::INFINITY), ..go(0.0) },
    ];
    for wanted in wanted {
        let (given, ruling) = driving(600, Phase::Run).rule(&at(610, Phase::Run), &wanted);
        assert!(why(ruling).has(LimitReason::NotANumber), "{wanted:?}");
        assert!(is_finite(given.twist) && given.dribbler == 0.0 && given.kick == OmniKick::Discharge);
    }
}

#[test]
fn braking_from_3_m_per_s_at_the_limit_takes_0_6_s_and_then_it_stands() {
    let mut governor = driving(600, Phase::Run);
    let mut steps = 0;
    loop {
        let t = 610 + steps * 10;
        // Wheels that follow their orders at once.
        let odometry = governor.last();
        let (given, _) = governor.rule(&Circumstances { odometry, ..at(t, Phase::Halt) }, &go(3.0));
        steps += 1;
        if given.twist == Twist::default() {
            break;
        }
    }
    // Sixty steps of 50 mm/s, and one for rounding.
    assert!((60..=61).contains(&steps), "{steps}");
}

#[test]
fn a_body_that_has_stopped_is_not_driven_on_by_the_ramp() {
    let mut governor = driving(600, Phase::Run);
    let (given, _) = governor.rule(&at(610, Phase::Halt), &go(3.0));
    assert_eq!(given.twist, Twist::default(), "the wheels stand: nothing to brake");
}

#[test]
fn from_50_to_100_ms_of_silence_the_limit_shrinks_and_the_next_frame_restores_it() {
    let mut governor = driving(600, Phase::Run);
    let received = Instant(600_000);
    let host = Some(Hearing { frame: Some(received), command: Some(received) });
    let mut speeds = [0.0; 16];
    for (i, speed) in speeds.iter_mut().enumerate() {
        let t = 610 + 10 * i as u64;
        let (given, ruling) = governor.rule(&Circumstances { host, ..at(t, Phase::Run) }, &go(3.0));
        *speed = given.twist.linear.norm();
        match t - 600 {
            // 4 m/s · (100 − t)/50 passes below 3 m/s after 62.5 ms.
            0..=60 => assert_eq!(ruling, Ruling::Allowed, "{t}"),
            61..100 => assert!(matches!(ruling, Ruling::Limited(r) if r.has(LimitReason::Hesitant)), "{t}"),
            _ => assert!(why(ruling).has(LimitReason::Silence), "{t}"),
        }
    }
    assert!(speeds.windows(2).all(|pair| pair[1] <= pair[0]), "{speeds:?}");
    governor.receive_host(Instant(770_000));
    assert_eq!(governor.rule(&at(770, Phase::Run), &go(1.0)).1, Ruling::Allowed);
}

/// Time from the first frame after a silence of `silence` ms until it may move again, ms.
fn moves_again_after(silence: u64) -> Option<u64> {
    let mut governor = driving(600, Phase::Run);
    let received = Instant(600_000);
    let host = Some(Hearing { frame: Some(received), command: Some(received) });
    for t in (610..600 + silence).step_by(10) {
        governor.rule(&Circumstances { host, ..at(t, Phase::Run) }, &go(1.0));
    }
    (0..1000).step_by(10).find(|t| {
        let t = 600 + silence + t;
        governor.receive_host(Instant(t * 1000));
        governor.rule(&at(t, Phase::Run), &go(1.0)).1 == Ruling::Allowed
    })
}

#[test]
fn gaps_end_with_the_first_frame_and_silences_of_0_5_s_after_0_5_s_of_frames() {
    for gap in [60, 100, 150, 300, 490] {
        assert_eq!(moves_again_after(gap), Some(0), "{gap} ms");
    }
    for silence in [500, 510, 700, 3000] {
        assert_eq!(moves_again_after(silence), Some(500), "{silence} ms");
    }
}

#[test]
fn a_robot_that_boots_is_armed_0_5_s_after_the_first_frame_whatever_the_gaps() {
    let mut governor = Governor::new(League::DivisionB);
    let (mut armed, mut frame) = (None, None);
    for t in (0..2000_u64).step_by(10) {
        // Received for 60 ms, then not for 150 ms, again and again.
        if t % 210 < 60 {
            governor.receive_host(Instant(t * 1000));
            frame = Some(Instant(t * 1000));
        }
        let host = Some(Hearing { frame, command: frame });
        let ruling = governor.rule(&Circumstances { host, ..at(t, Phase::Run) }, &go(1.0)).1;
        if armed.is_none() && ruling == Ruling::Allowed {
            armed = Some(t);
        }
    }
    // 500 ms after the first, the newest was received 30 ms before.
    assert_eq!(armed, Some(500));
}

#[test]
fn who_expects_no_host_is_not_braked_by_its_silence() {
    let mut governor = Governor::new(League::DivisionB);
    let alone = Circumstances { host: None, phase: None, ..at(10, Phase::Run) };
    assert_eq!(governor.rule(&alone, &go(1.0)).1, Ruling::Allowed);
    let halted = Circumstances { host: None, ..at(20, Phase::Halt) };
    assert!(why(governor.rule(&halted, &go(1.0)).1).has(LimitReason::Halt));
}

#[test]
fn in_stop_a_robot_is_slowed_to_1_3_m_per_s_within_the_grace_of_2_s() {
    let mut governor = driving(600, Phase::Run);
    let mut slow_after = None;
    for t in (610..2610).step_by(10) {
        governor.receive_host(Instant(t * 1000));
        let odometry = governor.last();
        let (given, ruling) = governor.rule(&Circumstances { odometry, ..at(t, Phase::Stop) }, &go(3.0));
        assert!(matches!(ruling, Ruling::Limited(r) if r.has(LimitReason::StopSpeed)));
        if given.twist.linear.norm() <= STOP_SPEED + 1e-5 && slow_after.is_none() {
            slow_after = Some(t - 600);
        }
    }
    // 1.7 m/s at 5 m/s².
    assert_eq!(slow_after, Some(340));
    let slow = Wanted { kick: OmniKick::None, ..go(1.2) };
    assert_eq!(governor.rule(&at(2620, Phase::Stop), &slow), (slow, Ruling::Allowed));
}

#[test]
fn the_table_of_kicks_by_phase() {
    use Phase::{
        BallPlacement, FreeKick, Halt, Kickoff, Penalty, PrepareKickoff, PreparePenalty, Run, Stop, Timeout,
    };
    use Side::{Ours, Theirs};
    let table = [
        (Halt, None),
        (Timeout(Ours), None),
        (Timeout(Theirs), None),
        (Stop, Some(OmniKick::None)),
        (BallPlacement(Ours), Some(OmniKick::Flat(6.24))),
        (BallPlacement(Theirs), Some(OmniKick::None)),
        (PrepareKickoff(Ours), Some(OmniKick::None)),
        (PrepareKickoff(Theirs), Some(OmniKick::None)),
        (Kickoff(Ours), Some(OmniKick::Flat(6.24))),
        (Kickoff(Theirs), Some(OmniKick::None)),
        (PreparePenalty(Ours), Some(OmniKick::None)),
        (PreparePenalty(Theirs), Some(OmniKick::None)),
        (Penalty(Ours), Some(OmniKick::Flat(6.24))),
        (Penalty(Theirs), Some(OmniKick::Flat(6.24))),
        (FreeKick(Ours), Some(OmniKick::Flat(6.24))),
        (FreeKick(Theirs), Some(OmniKick::None)),
        (Run, Some(OmniKick::Flat(6.24))),
    ];
    for (phase, expected) in table {
        let hard = Wanted { kick: OmniKick::Flat(8.0), ..go(1.0) };
        let (given, ruling) = driving(600, Phase::Run).rule(&at(610, phase), &hard);
        match expected {
            None => assert!(why(ruling).has(LimitReason::Halt), "{phase:?}"),
            Some(kick) => {
                let reason =
                    if kick == OmniKick::None { LimitReason::NoKick } else { LimitReason::BallSpeed };
                assert!(matches!(ruling, Ruling::Limited(r) if r.has(reason)), "{phase:?}: {ruling:?}");
                assert_eq!(given.kick, kick, "{phase:?}");
            }
        }
    }
}

#[test]
fn kicks_are_held_to_the_leagues_ball_speed_whichever_way_the_ball_goes() {
    for (league, most) in [(League::DivisionA, 6.24), (League::DivisionB, 6.24), (League::Ssl2013, 7.1)] {
        let mut governor = Governor { league, ..driving(600, Phase::Run) };
        for (wanted, expected) in [
            (OmniKick::Chip(9.0), OmniKick::Chip(most)),
            (OmniKick::Flat(9.0), OmniKick::Flat(most)),
            (OmniKick::Flat(2.0), OmniKick::Flat(2.0)),
        ] {
            let (given, _) = governor.rule(&at(610, Phase::Run), &Wanted { kick: wanted, ..go(0.0) });
            assert_eq!(given.kick, expected, "{league:?}");
        }
    }
}

#[test]
fn a_battery_must_be_low_for_a_second() {
    let low = Health { battery: Some(13.0), ..HEALTHY };
    let mut governor = driving(600, Phase::Run);
    let mut braked = None;
    for t in (610..2000).step_by(10) {
        governor.receive_host(Instant(t * 1000));
        let ruling = governor.rule(&Circumstances { health: &low, ..at(t, Phase::Run) }, &go(1.0)).1;
        if matches!(ruling, Ruling::Braking(_)) {
            assert!(why(ruling).has(LimitReason::Battery));
            braked = Some(t - 610);
            break;
        }
    }
    assert_eq!(braked, Some(1000));
}

#[test]
fn an_absurd_motion_is_cut_to_what_robots_do() {
    let mut governor = driving(600, Phase::Run);
    let twist = Twist { linear: Vector::new(300.0, 400.0), angular: -99.0 };
    let (given, ruling) = governor.rule(&at(610, Phase::Run), &Wanted { twist, ..go(0.0) });
    assert!(matches!(ruling, Ruling::Limited(r) if r.has(LimitReason::Reach)));
    assert!((given.twist.linear.norm() - 4.0).abs() < 1e-5 && given.twist.angular == -20.0);
}

/// Steps of 10 ms from `from` ms on in which `at` holds and the wheels follow their orders, until the motors
/// are released; `None` after 3 s.
fn released_after(
    governor: &mut Governor,
    from: u64,
    at: impl Fn(u64) -> Circumstances<'static>,
) -> Option<u64> {
    (from..from + 3000).step_by(10).find(|t| {
        let odometry = governor.last();
        governor.rule(&Circumstances { odometry, ..at(*t) }, &go(3.0));
        governor.has_let_go()
    })
}

#[test]
fn motors_are_released_half_a_second_after_a_silent_robot_stands_and_never_before() {
    let received = Some(Instant(600_000));
    let silent =
        |t| Circumstances { host: Some(Hearing { frame: received, command: received }), ..at(t, Phase::Run) };
    let released = released_after(&mut driving(600, Phase::Run), 610, silent);
    // 100 ms of silence, in whose second half the limit falls from 3 m/s with 80 m/s² but never faster than
    // the brake's 5 m/s²: 3 m/s take 600 ms from 62.5 ms on, a turn of 1 rad/s less; then 500 ms.
    let after = released.expect("released in the end") - 600;
    assert!((1150..=1200).contains(&after), "{after} ms");
}

#[test]
fn only_lasting_reasons_release_the_motors_and_a_push_or_the_host_takes_them_back() {
    let silent =
        |t| Circumstances { host: Some(Hearing { frame: None, command: None }), ..at(t, Phase::Run) };
    let tipped = Health { tipped: true, ..HEALTHY };
    let tipped: &'static Health = Box::leak(Box::new(tipped));
    let lies = |t| Circumstances { health: tipped, ..at(t, Phase::Run) };
    let lost = |t| Circumstances { placed: false, ..at(t, Phase::Run) };
    assert_eq!(released_after(&mut Governor::new(League::DivisionB), 0, silent), Some(500));
    assert!(released_after(&mut driving(600, Phase::Run), 610, lies).is_some());
    assert_eq!(released_after(&mut driving(600, Phase::Run), 610, lost), None, "it may be seen again soon");
    assert_eq!(released_after(&mut driving(600, Phase::Halt), 610, |t| at(t, Phase::Halt)), None);

    let mut governor = Governor::new(League::DivisionB);
    released_after(&mut governor, 0, silent);
    let pushed = Twist { linear: Vector::new(0.3, 0.0), angular: 0.0 };
    governor.rule(&Circumstances { odometry: pushed, ..silent(510) }, &go(1.0));
    assert!(!governor.has_let_go(), "it brakes");
    released_after(&mut governor, 520, silent);
    assert!(governor.has_let_go());
    for t in (2000..2510).step_by(10) {
        governor.receive_host(Instant(t * 1000));
        governor.rule(&at(t, Phase::Run), &go(1.0));
    }
    assert!(!governor.has_let_go(), "it goes");
}

#[test]
fn a_robot_whose_odometry_is_no_number_is_not_released() {
    let silent =
        |t| Circumstances { host: Some(Hearing { frame: None, command: None }), ..at(t, Phase::Run) };
    let mut governor = Governor::new(League::DivisionB);
    for t in (0..2000).step_by(10) {
        let odometry = Twist { linear: Vector::new(f32::NAN, 0.0), angular: 0.0 };
        governor.rule(&Circumstances { odometry, ..silent(t) }, &go(1.0));
        assert!(!governor.has_let_go());
    }
}
