//! Tests of differences between robots, delayed orders, and bystanders.

use super::*;
use crate::small_size::camera::Cameras;
use crate::small_size::compatibility::Profile;
use crate::small_size::referee::{InternalReferee, RefereeSettings};
use rules::Colour;

#[test]
fn kick_gain_and_chip_ratio_scale_kicks_within_the_kickers_limit() {
    // Kick gain, chip ratio, flat limit, ordered speed and angle, speed of the ball.
    for (gain, ratio, limit, ordered, angle, expected) in [
        (0.7, 1.0, 8.0, 5.0, 0.0, 3.5),
        (0.9, 0.8, 8.0, 4.0, 0.0, 3.6),
        (0.9, 0.8, 8.0, 4.0, 0.7, 2.88),
        (1.1, 1.0, 6.5, 6.5, 0.0, 6.5),
    ] {
        let mut world = with_ball(|model| {
            (model.robots.kick_gain, model.robots.chip_ratio) = ([gain, gain], [ratio, ratio]);
            model.parameters.kick.flat = limit;
        });
        let speed = kick_of(&mut world, yellow(1), ordered, angle);
        assert!((speed - expected).abs() < 1e-4, "{gain} {ratio} {angle}: {speed}");
    }
}

#[test]
fn each_robot_draws_its_own_traits_whatever_the_order_of_placing() {
    let model = WorldModel::of(League::DivisionB, &WorldChoice::Random(4)).unwrap();
    let traits = |ids: &[u8], seed: u64| {
        let mut world = World::of_model(League::DivisionB, &model, seed);
        for id in ids {
            world.put(yellow(*id), Pose::from_mm_deg(300.0 * f32::from(*id), 0.0, 0.0));
        }
        world.robots().iter().map(|robot| *robot.traits()).collect::<Vec<_>>()
    };
    let (one, other) = (traits(&[0, 1, 2], 9), traits(&[2, 1, 0], 9));
    assert_eq!(one, other);
    assert!(one[0] != one[1] && one[1] != one[2] && one != traits(&[0, 1, 2], 10));
    let [low, high] = model.robots.kick_gain;
    assert!(one.iter().all(|of| (low..=high).contains(&of.kick_gain)));
}

#[test]
fn traits_scale_a_robots_acceleration_and_speed() {
    let time_to = |share: f32| {
        let mut world = with_ball(|model| model.robots.acceleration = [share, share]);
        world.put_ball(Ball::at(Point::new(0.0, 2.5)));
        (0..2_000).find(|_| {
            lead(&mut world, local(1.5, 0.0, 0.0), 10);
            world.robot(yellow(1)).unwrap().velocity.x() > 1.45
        })
    };
    // 1.45 m/s at 4.5 m/s²: 0.32 s.
    let (whole, half) = (time_to(1.0).unwrap(), time_to(0.5).unwrap());
    assert!((31..=35).contains(&whole) && (62..=68).contains(&half), "{whole} {half}");
    let mut world = with_ball(|model| model.robots.speed = [0.5, 0.5]);
    world.put_ball(Ball::at(Point::new(0.0, 2.5)));
    lead(&mut world, local(3.5, 0.0, 0.0), 1_500);
    assert!((world.robot(yellow(1)).unwrap().velocity.x() - 1.75).abs() < 1e-3);
}

#[test]
fn slipping_wheels_measure_1_m_per_s_at_a_true_0_9() {
    let mut world = with_ball(|model| model.robots.slip = [0.1, 0.1]);
    world.put_ball(Ball::at(Point::new(0.0, 2.5)));
    lead(&mut world, local(1.0, 0.0, 2.0), 800);
    world.sensors(yellow(1));
    lead(&mut world, local(1.0, 0.0, 0.0), 800);
    let reported = world.sensors(yellow(1)).unwrap().odometry.linear;
    let true_speed = world.robot(yellow(1)).unwrap().velocity.norm();
    assert!(
        (reported.norm() - 1.0).abs() < 0.02 && (true_speed - 0.9).abs() < 1e-3,
        "{reported:?} {true_speed}"
    );
}

/// The step after which the robot first moves, commanded from the first step on.
fn first_motion(link: LinkModel) -> u64 {
    let mut world = with_ball(|model| model.link = link);
    for step in 0..500 {
        if step % 10 == 0 {
            assert!(world.command(yellow(1), &wheels([0.5, 0.5, 0.5, 0.5])));
        }
        world.step();
        if world.robot(yellow(1)).unwrap().turning != 0.0 {
            return world.now();
        }
    }
    panic!("it never moved")
}

#[test]
fn the_first_motion_is_late_by_the_links_latency() {
    let at_once = first_motion(LinkModel::IDEAL);
    for latency_ms in [1, 5, 40, 60] {
        assert_eq!(
            first_motion(LinkModel { latency_ms, ..LinkModel::IDEAL }),
            at_once + u64::from(latency_ms)
        );
    }
}

#[test]
fn jitter_stays_within_its_bound_and_keeps_the_order_of_commands() {
    let link = LinkModel { latency_ms: 20, jitter_ms: 30, loss: 0.0 };
    let mut latency = Latency::new(&link, 3);
    let (mut arrived, mut late) = (Vec::new(), Vec::new());
    for now in 0..20_000_u64 {
        while let Some((_, order)) = latency.arrived(now) {
            arrived.push(order.dribbler);
            late.push(now - order.dribbler as u64);
        }
        if now % 10 == 0 {
            latency.send(now, yellow(1), Order { dribbler: now as f32, ..Order::default() });
        }
    }
    assert!(arrived.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!((late.iter().min(), late.iter().max()), (Some(&20), Some(&50)));
}

#[test]
fn losses_of_link_and_air_combine() {
    let air = crate::AirSettings::with_loss(0.1);
    assert_eq!(LinkModel::IDEAL.over(&air), air);
    let lossy = LinkModel { loss: 0.1, ..LinkModel::IDEAL }.over(&air);
    assert!((lossy.loss - 0.19).abs() < 1e-6);
}

/// A team's line-up of six, and bystanders.
fn crowd(league: League, count: u8, seed: u64) -> World {
    let model = WorldModel::of(league, &WorldChoice::Nominal).unwrap();
    let mut world = World::of_model(league, &model, seed);
    for n in 0..model.parameters.robots {
        let id = RobotId::new(n).unwrap();
        world.put(Who::yellow(id), Pose::from_mm_deg(1000.0 + 250.0 * f32::from(n), 300.0, 180.0));
        world.put(Who::blue(id), Pose::from_mm_deg(-1000.0 - 250.0 * f32::from(n), 300.0, 0.0));
    }
    world.add_bystanders(count);
    world
}

#[test]
fn bystanders_stand_clear_of_players_ball_lines_and_areas() {
    let (mut on, mut beside) = (0, 0);
    for (league, most) in [(League::DivisionB, 11), (League::DivisionA, 10)] {
        for seed in 0..30 {
            let world = crowd(league, 11, seed);
            let field = league.field();
            let standing: Vec<_> = world.robots().iter().filter(|robot| robot.bystander).collect();
            // In division A five numbers a team are left.
            assert_eq!(standing.len(), most, "{league:?} {seed}");
            for robot in &standing {
                let p = robot.pose.position;
                let [x, y] = world.pitch().corner();
                assert!(p.x().abs() < x - 0.08 && p.y().abs() < y - 0.08);
                on += u32::from(field.contains(p));
                beside += u32::from(!field.contains(p));
                assert!(
                    !field.contains(p) || field.width * 0.5 - p.y().abs() > 0.6,
                    "no placement is barred"
                );
                let near = world.robots().iter().filter(|other| other.pose.position.distance(p) < 0.4);
                assert_eq!(near.count(), 1, "alone there");
            }
        }
    }
    assert!(on > 150 && beside > 250, "{on} {beside}");
}

#[test]
fn cameras_see_bystanders_and_the_referee_does_not_count_them() {
    let mut world = crowd(League::DivisionB, 8, 2);
    world.step();
    let frames = Cameras::of(Profile::Ours, 0.0, &world, 1).capture(&world);
    let seen: std::collections::BTreeSet<_> =
        frames.iter().flat_map(|frame| &frame.robots_blue).filter_map(|robot| robot.robot_id).collect();
    assert!(seen.len() >= 9 && seen.contains(&15), "{seen:?}");
    let mut referee = InternalReferee::new(RefereeSettings::new(League::DivisionB), 1).unwrap();
    for _ in 0..300 {
        (0..10).for_each(|_| world.step());
        referee.look(&world, &[]);
        while referee.poll_packet().is_some() {}
        while let Some(order) = referee.poll_order() {
            order.carry_out(&mut world);
        }
    }
    let metrics = referee.metrics();
    for team in [Colour::Blue, Colour::Yellow] {
        let many = metrics.offences.team(team).any(|(kind, _)| kind.label() == "too_many_robots");
        assert!(!many, "{team:?}");
    }
    assert!(world.robots().iter().filter(|robot| robot.bystander).all(|robot| robot.present));
}
