//! `robots`: tests of robot tracking.

use geometry::Point;
use host::tracking::Tracker;
use rules::Colour::{Blue, Yellow};

use crate::stadium::{RATE, Rms, Stadium, Truth, play, who};

/// A robot that drives a figure of eight at up to 2.2 m/s and 3 m/s², turning continuously with up to 4
/// rad/s.
fn eight(t: f64) -> ([f64; 3], [f64; 3]) {
    let (a, b) = (1.4 * t, 2.0 * 1.4 * t);
    let (turn, rate) = (4.0 * (t * 0.9).sin(), 3.6 * (t * 0.9).cos());
    ([1.5 * a.sin(), 0.35 * b.sin(), turn], [2.1 * a.cos(), 0.98 * b.cos(), rate])
}

fn errors(mut stadium: Stadium) -> [Rms; 4] {
    let mut rms = [Rms::default(); 4];
    let robot = who(Blue, 4);
    let truth = |t| Truth { robots: vec![(robot, eight(t).0)], ..Truth::default() };
    play(&mut stadium, &mut Tracker::default(), (0.0, 30.0), truth, |t, tracker| {
        let Some(seen) = tracker.snapshot().robot(robot).copied() else {
            assert!(t < 0.2, "lost at {t} s");
            return;
        };
        if t > 0.5 {
            let ([x, y, heading], [vx, vy, rate]) = eight(t);
            let off = seen.pose.position - Point::new(x as f32, y as f32);
            rms[0].add(f64::from(off.norm()));
            let (dvx, dvy) = (f64::from(seen.velocity.x()) - vx, f64::from(seen.velocity.y()) - vy);
            rms[1].add((dvx * dvx + dvy * dvy).sqrt());
            let turn = f64::from(seen.pose.heading.radians()) - heading;
            rms[2].add(turn.sin().atan2(turn.cos()));
            rms[3].add(f64::from(seen.angular) - rate);
        }
    });
    rms
}

#[test]
fn a_robot_on_a_figure_of_eight_is_followed() {
    for (name, stadium, bounds) in [
        ("one camera", Stadium::one_camera(1), [0.005, 0.15, 0.03, 0.6]),
        ("four cameras, 5 mm off", Stadium::four_cameras(2), [0.008, 0.2, 0.03, 0.6]),
    ] {
        let rms = errors(stadium);
        println!(
            "{name}: position {:.1} mm (worst {:.1}), velocity {:.3} m/s ({:.3}), heading {:.3} rad ({:.3}), rate {:.2} rad/s ({:.2})",
            rms[0].value() * 1e3,
            rms[0].worst * 1e3,
            rms[1].value(),
            rms[1].worst,
            rms[2].value(),
            rms[2].worst,
            rms[3].value(),
            rms[3].worst
        );
        for (rms, bound) in rms.iter().zip(bounds) {
            assert!(rms.value() < bound, "{name}: {} over {bound}", rms.value());
        }
    }
}

#[test]
fn the_velocity_of_a_robot_that_starts_with_3_m_s2_lags_less_than_60_ms() {
    let robot = who(Yellow, 0);
    let speed = |t: f64| 3.0 * (t - 1.0).clamp(0.0, 0.8);
    let place = |t: f64| {
        let s = (t - 1.0).clamp(0.0, 0.8);
        1.5 * s * s + 2.4 * (t - 1.8).max(0.0) - 2.0
    };
    let truth = |t| Truth { robots: vec![(robot, [place(t), 0.0, 0.0])], ..Truth::default() };
    // The mean of many runs is the lag; the remainder in one run is noise.
    let mut lags = vec![0.0; 150];
    let (mut noise, runs) = (Rms::default(), 40);
    for seed in 0..runs {
        let mut image = 0;
        play(&mut Stadium::one_camera(seed), &mut Tracker::default(), (0.0, 2.5), truth, |t, tracker| {
            let seen = tracker.snapshot().robot(robot).map_or(0.0, |seen| f64::from(seen.velocity.x()));
            lags[image] += (speed(t) - seen) / 3.0 / runs as f64;
            if (0.5..1.0).contains(&t) {
                noise.add(seen);
            }
            image += 1;
        });
    }
    let worst = lags.iter().copied().fold(0.0, f64::max);
    let settled = lags[75..108].iter().sum::<f64>() / 33.0;
    println!(
        "lag {:.0} ms, worst {:.0} ms; noise at rest {:.3} m/s",
        settled * 1e3,
        worst * 1e3,
        noise.value()
    );
    assert!(worst < 0.06 && settled < 0.04 && noise.value() < 0.06);
}

#[test]
fn a_robot_is_believed_after_three_frames_and_a_misread_one_never() {
    let mut stadium = Stadium::one_camera(4);
    let (real, ghost) = (who(Yellow, 3), who(Yellow, 9));
    // The ghost is in two frames in a row, every second.
    let truth = |t: f64| {
        let mut robots = vec![(real, [0.0, 0.0, 0.0])];
        if (t % 1.0) < 1.99 / RATE {
            robots.push((ghost, [2.0, 1.0, 0.0]));
        }
        Truth { robots, ..Truth::default() }
    };
    let mut images = 0;
    play(&mut stadium, &mut Tracker::default(), (0.0, 5.0), truth, |t, tracker| {
        images += 1;
        let world = tracker.snapshot();
        assert_eq!(world.robot(real).is_some(), images >= 3, "image {images}");
        assert!(world.robot(ghost).is_none(), "at {t} s");
    });
}

#[test]
fn a_pattern_read_in_the_wrong_colour_or_number_makes_no_second_robot() {
    let mut stadium = Stadium::four_cameras(5);
    let (real, colour, number) = (who(Blue, 5), who(Yellow, 5), who(Blue, 6));
    // Every third frame in the wrong colour, every seventh under the wrong number.
    let truth = |t: f64| {
        let image = (t * RATE).round() as u32;
        let name =
            if image < 10 { real } else { [real, real, colour, real, real, number][image as usize % 6] };
        Truth { robots: vec![(name, [0.5 * t, -0.1, 1.0])], ..Truth::default() }
    };
    play(&mut stadium, &mut Tracker::default(), (0.0, 4.0), truth, |t, tracker| {
        let world = tracker.snapshot();
        assert!(world.robots().all(|robot| robot.who == real), "at {t} s");
        assert!(t < 0.2 || world.robot(real).is_some(), "at {t} s");
    });
}

#[test]
fn a_wrong_name_that_was_believed_first_gives_way() {
    let mut stadium = Stadium::one_camera(6);
    let (real, wrong) = (who(Blue, 5), who(Yellow, 5));
    let truth = |t: f64| {
        let image = (t * RATE).round() as u32;
        let name = if image < 6 || image.is_multiple_of(20) { wrong } else { real };
        Truth { robots: vec![(name, [0.0, 0.0, 0.0])], ..Truth::default() }
    };
    play(&mut stadium, &mut Tracker::default(), (0.0, 4.0), truth, |t, tracker| {
        let world = tracker.snapshot();
        assert!(t < 0.5 || world.robot(real).is_some(), "at {t} s");
        assert!(t < 1.3 || world.robot(wrong).is_none(), "at {t} s");
    });
}

#[test]
fn misread_places_of_a_robot_are_ignored_and_a_carried_robot_is_followed() {
    let mut stadium = Stadium::one_camera(7);
    let robot = who(Yellow, 1);
    let truth = |t: f64| {
        let here = [1.0, 1.0, 0.0];
        let there = [-3.0, -2.0, 2.0];
        let image = (t * RATE).round() as u32;
        let robots = match t {
            // Misread in single frames.
            ..2.0 if image % 10 == 9 => vec![(robot, there)],
            // Seen twice.
            2.0..3.0 => vec![(robot, there), (robot, here)],
            ..3.0 => vec![(robot, here)],
            // A person, or a simulator, placed it elsewhere.
            _ => vec![(robot, there)],
        };
        Truth { robots, ..Truth::default() }
    };
    let mut tracker = Tracker::default();
    play(&mut stadium, &mut tracker, (0.0, 4.0), truth, |t, tracker| {
        let Some(seen) = tracker.snapshot().robot(robot).copied() else { return assert!(t < 0.1) };
        let there = seen.pose.position.x() < 0.0;
        assert!(if t < 3.0 { !there } else { there || t < 3.2 }, "at {t} s: {seen:?}");
        assert!(seen.velocity.norm() < 0.3, "at {t} s: {seen:?}");
    });
    assert!(tracker.objects().robots.jumped > 60, "{:?}", tracker.objects());
}

#[test]
fn an_unseen_robot_coasts_fades_goes_and_returns() {
    let mut stadium = Stadium::one_camera(8);
    let robot = who(Yellow, 1);
    let place = |t: f64| [-2.0 + t, 0.5, 0.3];
    let truth = |t: f64| {
        let seen = !(1.0..1.5).contains(&t) && !(2.0..3.5).contains(&t);
        let robots = if seen { vec![(robot, place(t))] } else { vec![] };
        Truth { robots, ..Truth::default() }
    };
    let mut confidence = 1.0;
    play(&mut stadium, &mut Tracker::default(), (0.0, 4.0), truth, |t, tracker| {
        let world = tracker.snapshot();
        let seen = world.robot(robot);
        let off = seen.map(|seen| f64::from(seen.pose.position.x()) - place(t)[0]);
        match t {
            0.3..1.0 => assert!(seen.unwrap().confidence > 0.9),
            1.02..1.24 => {
                assert!(off.unwrap().abs() < 0.05, "at {t} s it coasts: {off:?}");
                assert!(seen.unwrap().confidence < confidence);
                confidence = seen.unwrap().confidence;
            }
            1.52..2.0 => assert!(off.unwrap().abs() < 0.03, "at {t} s it is back: {off:?}"),
            3.05..3.5 => assert!(seen.is_none(), "at {t} s it is gone"),
            3.6.. => assert!(off.unwrap().abs() < 0.03, "at {t} s: {off:?}"),
            _ => {}
        }
    });
}
