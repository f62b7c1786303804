//! Tests: cameras detect what is there, with the configured delay and errors. And the other simulators'
//! compatibility profiles, by the numbers of their deviations.

use std::collections::BTreeSet;

use geometry::{Point, Pose, Vector};
use protocol::{RobotId, Who};
use rules::League;

use super::*;
use crate::small_size::tests::six_a_side;
use crate::small_size::{Ball, Parameters};

fn world(league: League) -> World {
    six_a_side(World::new(league, Parameters::of(league).unwrap(), 1))
}

fn clear(world: &World) -> CameraSettings {
    let camera = world.parameters().camera;
    CameraSettings {
        camera,
        noise: NoiseParameters::NONE,
        clock: Clock::Simulation,
        compatibility: Profile::Ours.compatibility(&camera),
    }
}

/// All packets of `steps` steps, with the step each was due in.
fn watched(cameras: &mut Cameras, world: &mut World, steps: u32) -> Vec<(u64, WrapperPacket)> {
    let mut packets = Vec::new();
    for _ in 0..steps {
        world.step();
        cameras.watch(world);
        while let Some(packet) = cameras.poll(world.now()) {
            packets.push((world.now(), packet));
        }
    }
    packets
}

#[test]
fn without_noise_detections_are_the_true_positions_in_millimetres() {
    let mut world = world(League::DivisionB);
    let mut cameras = Cameras::new(clear(&world), &world, 1);
    world.step();
    let frames = cameras.capture(&world);
    assert_eq!(frames.len(), 2);
    let ball = frames[0].balls[0];
    assert_eq!((ball.x, ball.y), (1000.0, 1000.0));
    assert!(frames[1].balls.is_empty(), "beyond the overlap the other camera sees nothing");
    let yellow: BTreeSet<_> =
        frames.iter().flat_map(|f| &f.robots_yellow).map(|r| r.robot_id.unwrap()).collect();
    assert_eq!(yellow.len(), 6);
    // Number 0 stands at the middle, in the overlap: both see it.
    let twice = frames.iter().flat_map(|f| &f.robots_yellow).filter(|r| r.robot_id == Some(0));
    for robot in twice.clone() {
        assert_eq!((robot.x, robot.y), (0.0, 500.0));
        assert!((robot.orientation.unwrap() - 10.0_f32.to_radians()).abs() < 1e-6);
    }
    assert_eq!(twice.count(), 2);
}

#[test]
fn frames_have_the_rate_delay_and_numbers_of_their_camera() {
    let mut world = world(League::DivisionB);
    let mut cameras = Cameras::new(clear(&world), &world, 1);
    let packets = watched(&mut cameras, &mut world, 2_000);
    for camera in 0..2 {
        let frames: Vec<_> = (packets.iter())
            .filter_map(|(due, p)| p.detection.as_ref().map(|d| (*due, d)))
            .filter(|(_, d)| d.camera_id == camera)
            .collect();
        // 75 a second, of which those of the last 35 ms are not due yet.
        assert!((146..=149).contains(&frames.len()), "{}", frames.len());
        for (k, (due, frame)) in frames.iter().enumerate() {
            assert_eq!(frame.frame_number, k as u32);
            let captured = (frame.t_capture * 1000.0 + 0.5) as u64;
            assert_eq!(due - captured, 35);
            assert!((frame.t_sent - frame.t_capture - 0.010).abs() < 1e-6);
        }
    }
    let geometry = packets.iter().filter(|(_, p)| p.geometry.is_some()).count();
    assert_eq!(geometry, 2, "once a second, in packets of its own");
    let captures = |camera| {
        let of = move |p: &(u64, WrapperPacket)| {
            p.1.detection.as_ref().filter(|d| d.camera_id == camera).map(|d| (d.t_capture * 1000.0) as u64)
        };
        packets.iter().filter_map(of).collect::<BTreeSet<_>>()
    };
    assert!(captures(0).is_disjoint(&captures(1)), "real cameras are not in step");
}

#[test]
fn noise_has_the_configured_deviation_and_share_of_misses() {
    let mut world = world(League::DivisionB);
    let noise = world.parameters().noise;
    let mut cameras = Cameras::new(CameraSettings { noise, ..clear(&world) }, &world, 1);
    world.step();
    let (n, mut squares, mut balls, mut robots) = (4_000, 0.0, 0, 0);
    for _ in 0..n {
        let frames = cameras.capture(&world);
        if let Some(ball) = frames[0].balls.first() {
            balls += 1;
            squares += (ball.x - 1000.0) * (ball.x - 1000.0);
        }
        robots += frames[1].robots_yellow.iter().filter(|r| r.robot_id == Some(5)).count();
    }
    let deviation = geometry::math::sqrt(squares / balls as f32);
    // Standard error 1/√(2n) = 1.1 %; four of them.
    assert!((deviation / 1.4 - 1.0).abs() < 0.045, "{deviation}");
    // Binomial deviations √(n p q): 13.8 balls, 8.9 robots.
    assert!(i32::abs(n - 200 - balls) < 56, "{balls}");
    assert!((n as usize - 80).abs_diff(robots) < 36, "{robots}");
}

#[test]
fn a_ball_behind_a_robot_is_hidden_and_one_before_its_front_is_seen() {
    let mut world = world(League::DivisionB);
    let noise = NoiseParameters { hidden_ball: 0.3, ..NoiseParameters::NONE };
    let mut cameras = Cameras::new(CameraSettings { noise, ..clear(&world) }, &world, 1);
    // The camera of the right half is at x = 2.4; the robot stands further out and occludes the area outside
    // it.
    let who = Who::blue(RobotId::new(9).unwrap());
    world.put(who, Pose::from_mm_deg(4200.0, 0.0, 0.0));
    let mut seen = |x: f32, height: f32| {
        world.put_ball(Ball { height, ..Ball::at(Point::new(x, 0.0)) });
        cameras.capture(&world).iter().any(|frame| !frame.balls.is_empty())
    };
    assert!(seen(3.9, 0.0));
    assert!(!seen(4.2946, 0.0), "before its front, in its shadow");
    assert!(seen(4.45, 0.0));
    assert!(seen(4.27, 0.2), "above everybody");
    world.put(who, Pose::from_mm_deg(4200.0, 0.0, 180.0));
    let mut seen = |x: f32| {
        world.put_ball(Ball::at(Point::new(x, 0.0)));
        cameras.capture(&world).iter().any(|frame| !frame.balls.is_empty())
    };
    assert!(seen(4.2 - 0.0946), "in its dribbler, on the camera's side");
}

#[test]
fn a_flying_ball_is_detected_where_the_cameras_ray_meets_the_ground() {
    let mut world = world(League::DivisionB);
    let mut cameras = Cameras::new(clear(&world), &world, 1);
    world.put_ball(Ball { height: 1.0, ..Ball::at(Point::new(3.4, 0.5)) });
    let ball = cameras.capture(&world)[0].balls[0];
    // From (2.4, 0) at 5 m: 5/4 of the distance outwards.
    assert!((ball.x - 3650.0).abs() < 0.1 && (ball.y - 625.0).abs() < 0.1, "{ball:?}");
}

#[test]
fn pixels_and_calibration_lead_back_to_the_field() {
    let mut world = world(League::DivisionA);
    let mut cameras = Cameras::new(clear(&world), &world, 1);
    world.step();
    let geometry = cameras.geometry(&world, None);
    assert_eq!(geometry.calib.len(), 4);
    for frame in cameras.capture(&world) {
        let c = geometry.calib[frame.camera_id as usize];
        assert_eq!(c.camera_id, frame.camera_id);
        for ball in frame.balls {
            // Field to camera: half a turn about x, then the shift; then the pinhole.
            let (x, y, z) = (ball.x + c.tx, -ball.y + c.ty, c.tz);
            assert!((c.principal_point_x + c.focal_length * x / z - ball.pixel_x).abs() < 0.01);
            assert!((c.principal_point_y + c.focal_length * y / z - ball.pixel_y).abs() < 0.01);
            assert!((0.0..2448.0).contains(&ball.pixel_x) && (0.0..2048.0).contains(&ball.pixel_y));
        }
        // The derived position is the camera's own: −Rᵀt.
        assert_eq!((c.derived_camera_world_tx, c.derived_camera_world_ty), (Some(-c.tx), Some(c.ty)));
    }
}

#[test]
fn geometry_packets_have_the_rules_field_and_our_ball_model() {
    let world = world(League::DivisionA);
    let geometry = Cameras::new(clear(&world), &world, 1).geometry(&world, None);
    let field = &geometry.field;
    assert_eq!((field.field_length, field.field_width, field.goal_width), (12_000, 9_000, 1_800));
    assert_eq!((field.boundary_width, field.boundary_width_goal_line), (300, Some(600)));
    assert_eq!((field.penalty_area_depth, field.penalty_area_width), (Some(1_800), Some(3_600)));
    assert_eq!((field.goal_height, field.goal_center_to_penalty_mark), (Some(160), Some(8_000)));
    assert_eq!((field.field_lines.len(), field.field_arcs.len()), (12, 1));
    let stretch = field.field_lines.iter().find(|line| line.name == "LeftPenaltyStretch").unwrap();
    assert_eq!((stretch.p1.x, stretch.p1.y, stretch.p2.y), (-4_200.0, -1_800.0, 1_800.0));
    let models = geometry.models.unwrap();
    let flat = models.straight_two_phase.unwrap();
    assert!((flat.acc_slide + 3.9).abs() < 1e-6 && (flat.acc_roll + 0.35).abs() < 1e-6);
    assert!((flat.k_switch - 5.0 / 7.0).abs() < 1e-12);
}

#[test]
fn trap_01_time_stamps_use_the_clock_of_the_profile() {
    let first = |profile| {
        let mut world = world(League::DivisionB);
        let mut cameras = Cameras::of(profile, 1_795_220_511.0, &world, 1);
        let packets = watched(&mut cameras, &mut world, 200);
        packets.into_iter().find_map(|(_, p)| p.detection).unwrap()
    };
    let grsim = first(Profile::Grsim);
    assert!(grsim.t_capture < 0.1 && grsim.t_capture == grsim.t_sent, "simulation seconds from 0");
    let erforce = first(Profile::ErForce);
    assert!(erforce.t_capture > 1_795_220_511.0 && erforce.t_capture < 1_795_220_512.0, "Unix time");
    assert!(first(Profile::Ours).t_capture > 1_795_220_511.0);
}

#[test]
fn trap_02_grsim_sends_four_frames_a_tick_and_one_calibration_a_packet() {
    let mut moving = world(League::DivisionB);
    let mut cameras = Cameras::of(Profile::Grsim, 0.0, &moving, 1);
    let packets = watched(&mut cameras, &mut moving, 2_100);
    let ticks: Vec<u64> =
        packets.iter().filter(|(_, p)| p.detection.is_some()).map(|(due, _)| *due).collect();
    assert!(ticks.chunks_exact(4).all(|four| four.iter().all(|tick| *tick == four[0])));
    let frames: Vec<_> = packets.iter().filter_map(|(_, p)| p.detection.as_ref()).collect();
    assert!(frames.iter().any(|f| f.balls.is_empty()), "frames without anything are sent too");
    let announced: Vec<_> = packets.iter().filter_map(|(_, p)| p.geometry.as_ref()).collect();
    assert!(announced.iter().all(|geometry| geometry.calib.len() == 1));
    assert_eq!(announced.iter().map(|g| g.calib[0].camera_id).collect::<BTreeSet<_>>().len(), 4);
    assert_eq!(announced.len(), 8, "four at frame 0 and four at frame 120");
    assert_eq!(announced[0].field.field_lines.len(), 18);

    let mut moving = world(League::DivisionB);
    let mut cameras = Cameras::of(Profile::ErForce, 0.0, &moving, 1);
    let packets = watched(&mut cameras, &mut moving, 500);
    assert!(packets.iter().all(|(_, p)| p.detection.is_some() && p.geometry.is_some()));
    assert!(packets.iter().all(|(_, p)| p.detection.as_ref().unwrap().camera_id == 0));
}

#[test]
fn trap_08_the_others_leave_out_the_defence_area_and_turn_cameras_by_a_dummy() {
    for profile in [Profile::Grsim, Profile::ErForce] {
        let world = world(League::DivisionB);
        let geometry = Cameras::of(profile, 0.0, &world, 1).geometry(&world, None);
        assert_eq!(geometry.field.penalty_area_depth, None);
        assert_eq!(geometry.calib[0].q0, 0.7);
        assert!(geometry.calib[0].derived_camera_world_tz.is_some());
    }
}

#[test]
fn trap_11_frames_with_no_ball_two_balls_and_a_ball_far_outside_occur() {
    let mut world = world(League::DivisionB);
    let noise = NoiseParameters { ghost_ball: 0.2, missing_ball: 0.2, ..NoiseParameters::NONE };
    let mut cameras = Cameras::new(CameraSettings { noise, ..clear(&world) }, &world, 1);
    world.put_ball(Ball { velocity: Vector::new(6.0, 0.0), climb: 4.0, ..Ball::at(Point::new(4.0, 0.8)) });
    let packets = watched(&mut cameras, &mut world, 3_000);
    let frames: Vec<_> =
        packets.iter().filter_map(|(_, p)| p.detection.as_ref()).filter(|d| d.camera_id == 0).collect();
    for balls in [0, 1, 2] {
        assert!(frames.iter().any(|frame| frame.balls.len() == balls), "{balls}");
    }
    let furthest = frames.iter().flat_map(|f| &f.balls).map(|ball| ball.x).fold(0.0, f32::max);
    assert!(furthest > 6_000.0, "beyond the boards at 4.8 m: {furthest}");
}
