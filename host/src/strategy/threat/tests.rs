//! Tests: the whole defence is consistent: rule-compliant places, one task per robot, held tasks, and
//! stability under noise.

use super::super::view::tests::view;
use super::*;
use geometry::{Field, GoalEnd, Vector};
use protocol::Instant;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::keep_out::{Situation, keep_out};
use rules::{League, Phase, RuleRole, Side};

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn all_robots(view: &View) -> RobotSet {
    let mut team = RobotSet::default();
    view.ours.iter().for_each(|robot| team.insert(robot.id));
    team
}

struct Noise(Xoshiro128PlusPlus);

impl Noise {
    fn seeded(seed: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in ±`range`.
    fn within(&mut self, range: f32) -> f32 {
        ((self.0.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range
    }

    fn place(&mut self, field: &rules::FieldSpec) -> (f32, f32) {
        (self.within(field.length * 0.5), self.within(field.width * 0.5))
    }
}

#[test]
fn whatever_the_snapshot_every_robot_has_one_legal_place_at_most() {
    let mut noise = Noise::seeded(1);
    let settings = ThreatSettings::default();
    let phases = [Phase::Run, Phase::Stop, Phase::FreeKick(Side::Theirs)];
    for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
        let field = league.field();
        let robots = if league == League::DivisionA { 11 } else { 6 };
        let mut memory = Memory::default();
        for round in 0..400 {
            let places: Vec<_> = (0..2 * robots).map(|_| noise.place(&field)).collect();
            let mut view = view(noise.place(&field), &places[..robots], &places[robots..]);
            view.field = field;
            view.phase = phases[round % phases.len()];
            if let Some(ball) = &mut view.ball {
                ball.velocity = Vector::new(noise.within(4.0), noise.within(4.0));
            }
            let defence = defend(&view, all_robots(&view), &mut memory, &settings);
            let mut seen = RobotSet::default();
            for assignment in &defence.assignments {
                assert!(!seen.has(assignment.robot), "twice: {assignment:?}");
                seen.insert(assignment.robot);
                let keeper = assignment.robot == view.keeper;
                let ball = view.ball.map(|ball| Point::<Field>::new(ball.position.x(), ball.position.y()));
                let rules = keep_out(&Situation {
                    field: &view.field,
                    own: GoalEnd::Negative,
                    phase: view.phase,
                    rule_role: if keeper { RuleRole::Keeper } else { RuleRole::Player },
                    ball: ball.filter(|_| !keeper),
                    placement: None,
                    ball_in_play: true,
                });
                let body = Point::<Field>::new(assignment.at.x(), assignment.at.y());
                let offence = rules.offence(body, 0.09);
                assert_eq!(offence, None, "{league:?} {:?} {assignment:?}", view.phase);
                assert!(keeper || !field.in_penalty_area(GoalEnd::Negative, body));
            }
            // All robots have a task while there are more positions than defenders.
            assert!(defence.assignments.len() >= robots.min(5), "{league:?} {defence:?}");
        }
    }
}

#[test]
fn the_nearest_defenders_take_the_best_ranked_positions() {
    let ours = [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3), (-2.0, 1.6), (-1.2, -1.0)];
    let theirs = [(4.4, 0.0), (-1.0, -0.1), (-2.4, 2.0), (-1.8, -1.5)];
    let view = view((-0.9, 0.0), &ours, &theirs);
    let mut memory = Memory::default();
    let defence = defend(&view, all_robots(&view), &mut memory, &ThreatSettings::default());
    assert_eq!(defence.threat.because, receiving::Because::Ball);
    // The holder (1) and their keeper (0) are no second-level threats.
    let dangers: Vec<_> = defence.dangers.iter().map(|danger| danger.opponent.number()).collect();
    assert_eq!(dangers, [2, 3]);
    let task = |n: u8| defence.assignments.iter().find(|a| a.robot == id(n)).map(|a| a.guards);
    assert!(matches!(task(0), Some(Guards::FirstLevel { .. })));
    let shot = |n: u8, of: u8| matches!(task(n), Some(Guards::SecondLevel { opponent, blocks: Blocks::Shot, .. }) if opponent == id(of));
    assert!(shot(3, 2) && shot(4, 3), "{:#?}", defence.assignments);
}

#[test]
fn a_blocked_shot_stays_blocked_until_the_primaries_have_come_over() {
    let settings = ThreatSettings::default();
    let ours = [(-4.4, 0.0), (-3.3, -0.5), (-3.2, -0.7), (-2.3, 1.5)];
    let theirs = [(4.4, 0.0), (-1.5, -1.7), (-2.0, 2.0)];
    let mut scene = view((-1.4, -1.6), &ours, &theirs);
    let mut memory = Memory::default();
    let before = defend(&scene, all_robots(&scene), &mut memory, &settings);
    let of = |defence: &Defence, n: u8| defence.assignments.iter().find(|a| a.robot == id(n)).unwrap().guards;
    assert!(
        matches!(of(&before, 3), Guards::SecondLevel { opponent, blocks: Blocks::Shot, .. } if opponent == id(2))
    );
    // 1 passes to 2: (−0.6, 3.6) away, at 4 m/s.
    scene.ball.as_mut().unwrap().velocity = Vector::new(-0.657, 3.945);
    scene.ball.as_mut().unwrap().position = Point::new(-1.5, -1.0);
    let during = defend(&scene, all_robots(&scene), &mut memory, &settings);
    assert_eq!(during.threat.receiver(), Some(id(2)));
    let Guards::Held { opponent, primaries_off } = of(&during, 3) else { panic!("{during:#?}") };
    assert!(opponent == id(2) && primaries_off > 0.5);
    let again = defend(&scene, all_robots(&scene), &mut memory, &settings);
    assert!(matches!(of(&again, 3), Guards::Held { .. }), "it holds from tick to tick");
    // The primaries arrive.
    let places: Vec<_> =
        [1, 2].map(|n| again.assignments.iter().find(|a| a.robot == id(n)).unwrap().at).into_iter().collect();
    scene.ours[1].position = places[0];
    scene.ours[2].position = places[1];
    let after = defend(&scene, all_robots(&scene), &mut memory, &settings);
    assert!(!matches!(of(&after, 3), Guards::Held { .. }), "{after:#?}");
}

/// A sequence of 20 s at 100 Hz: opponents wander, the ball is carried and passed, all positions have the
/// noise of a camera; our robots go to their places at 2 m/s. Counts changes of task per robot.
fn changes_over_a_sequence(sigma: f32, settings: &ThreatSettings, forgetful: bool) -> (usize, usize) {
    let mut noise = Noise::seeded(7);
    let ours = [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3), (-2.0, 1.6), (-1.5, -1.0), (0.0, 0.0)];
    let mut truth =
        view((-0.9, 0.0), &ours, &[(4.4, 0.0), (-1.0, 0.0), (-2.4, 2.0), (-1.8, -1.5), (0.5, 1.0)]);
    let mut memory = Memory::default();
    let mut last: [Option<Guards>; ROBOTS_MAX] = [None; ROBOTS_MAX];
    let (mut changes, mut jumps) = (0, 0);
    let mut places: [Option<Point<Attack>>; ROBOTS_MAX] = [None; ROBOTS_MAX];
    for tick in 0..2_000_u32 {
        let t = tick as f32 * 0.01;
        truth.now = Instant(u64::from(tick) * 10_000);
        for (i, robot) in truth.theirs.iter_mut().enumerate().skip(1) {
            let (s, c) = geometry::math::sin_cos(0.35 * t + i as f32);
            robot.position += Vector::new(0.4 * c, 0.35 * s) * 0.01;
        }
        let carrier = truth.theirs[1].position;
        truth.ball.as_mut().unwrap().position = carrier + Vector::new(-0.11, 0.0);
        let mut seen = truth.clone();
        for robot in seen.ours.iter_mut().chain(&mut seen.theirs) {
            robot.position += Vector::new(noise.within(sigma), noise.within(sigma));
        }
        let ball = seen.ball.as_mut().unwrap();
        ball.position += Vector::new(noise.within(sigma), noise.within(sigma));
        ball.velocity = Vector::new(noise.within(0.2), noise.within(0.2));
        if forgetful {
            memory = Memory::default();
        }
        let defence = defend(&seen, all_robots(&seen), &mut memory, settings);
        for assignment in &defence.assignments {
            let n = assignment.robot.index();
            let same = |a: Guards, b: Guards| match (a, b) {
                (
                    Guards::SecondLevel { opponent: a, blocks: x, .. },
                    Guards::SecondLevel { opponent: b, blocks: y, .. },
                ) => a == b && x == y,
                (a, b) => core::mem::discriminant(&a) == core::mem::discriminant(&b),
            };
            changes += usize::from(last[n].is_some_and(|before| !same(before, assignment.guards)));
            jumps += usize::from(places[n].is_some_and(|before| before.distance(assignment.at) > 0.3));
            (last[n], places[n]) = (Some(assignment.guards), Some(assignment.at));
            let robot = &mut truth.ours[n];
            robot.position += (assignment.at - robot.position).clamped(0.02);
        }
    }
    (changes, jumps)
}

#[test]
fn over_a_noisy_sequence_tasks_do_not_flicker() {
    let settings = ThreatSettings::default();
    let (clean, _) = changes_over_a_sequence(0.0, &settings, false);
    let (noisy, jumps) = changes_over_a_sequence(0.01, &settings, false);
    let (forgetful, _) = changes_over_a_sequence(0.01, &settings, true);
    println!(
        "changes of task in 20 s: clean {clean}, noisy {noisy} with {jumps} jumps, without a memory {forgetful}"
    );
    // Six robots, 20 s: the changes due to the play itself, and hardly more for a centimetre of noise. Places
    // jump by more than 0.3 m with tasks, or where another placement of the primaries starts.
    assert!(noisy <= clean + 4 && jumps <= 20, "clean {clean}, noisy {noisy}, jumps {jumps}");
    assert!(forgetful > 4 * noisy.max(1), "the memory matters: {forgetful} without it, {noisy} with it");
}

#[test]
fn at_their_free_kick_places_keep_off_the_ball() {
    let ours = [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3), (-2.0, 1.6)];
    let mut view = view((-3.0, 1.2), &ours, &[(4.4, 0.0), (-2.9, 1.3), (-2.4, 2.0)]);
    view.phase = Phase::FreeKick(Side::Theirs);
    let defence = defend(&view, all_robots(&view), &mut Memory::default(), &ThreatSettings::default());
    let ball = view.ball.unwrap().position;
    for assignment in defence.assignments.iter().skip(1) {
        assert!(assignment.at.distance(ball) > 0.59, "{assignment:?}");
    }
}

#[test]
fn a_wall_of_two_is_not_formed_by_paths_that_cross() {
    let settings = ThreatSettings::default();
    let ours = [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3)];
    let mut scene = view((-2.8, 0.6), &ours, &[(4.4, 0.0), (-2.7, 0.6)]);
    let mut memory = Memory::default();
    let before = defend(&scene, all_robots(&scene), &mut memory, &settings);
    let place = |defence: &Defence, n: u8| defence.assignments.iter().find(|a| a.robot == id(n)).unwrap().at;
    assert!(before.assignments.iter().any(|a| a.guards == Guards::Spare), "{before:?}");
    // Each where the other has to be: both have their tasks from before.
    let places = [place(&before, 1), place(&before, 2)];
    (scene.ours[1].position, scene.ours[2].position) = (places[1], places[0]);
    let after = defend(&scene, all_robots(&scene), &mut memory, &settings);
    let paths: f32 = (1..3).map(|n| scene.ours[n].position.distance(place(&after, n as u8))).sum();
    assert!(places[0].distance(places[1]) > 0.15 && paths < 0.05, "{paths} m: {after:?}");
}

/// Another opponent waits for a cross.
#[test]
fn before_a_carrier_near_our_goal_the_spare_primary_stays_beside_the_other() {
    let ours = [(-4.4, 0.0), (-3.3, 0.3), (-3.3, -0.3)];
    let scene = view((-2.8, 0.6), &ours, &[(4.4, 0.0), (-2.7, 0.6), (-2.4, -1.2)]);
    let last = |settings: &ThreatSettings| {
        let defence = defend(&scene, all_robots(&scene), &mut Memory::default(), settings);
        defence.assignments.last().unwrap().guards
    };
    assert_eq!(last(&ThreatSettings::default()), Guards::Spare);
    let lent = last(&ThreatSettings { spare_stays: 1.0, ..ThreatSettings::default() });
    assert!(matches!(lent, Guards::SecondLevel { blocks: Blocks::Shot, .. }), "{lent:?}");
}
