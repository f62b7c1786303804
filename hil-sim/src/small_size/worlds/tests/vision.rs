//! `vision`: tests of faults of camera frames: rate, gaps, jitter, swapped numbers, ghosts and misses.

use std::collections::BTreeSet;

use ssl::vision::DetectionFrame;

use super::*;
use crate::small_size::camera::Cameras;
use crate::small_size::compatibility::Profile;
use crate::small_size::tests::six_a_side;

/// Six robots a side, the ball, one camera over all.
fn lined_up(model: &WorldModel) -> World {
    six_a_side(World::of_model(League::DivisionB, model, 1))
}

/// All frames of `seconds` seconds, with the step each arrived in.
fn watched(change: impl FnOnce(&mut WorldModel), seconds: u32) -> Vec<(u64, DetectionFrame)> {
    let model = model(|model| {
        model.parameters.camera.count = 1;
        model.parameters.camera.rate = 100.0;
        change(model);
    });
    let mut world = lined_up(&model);
    let mut cameras = Cameras::of_model(Profile::Ours, 0.0, &world, model.vision, 7);
    let mut frames = Vec::new();
    for _ in 0..seconds * 1000 {
        world.step();
        cameras.watch(&world);
        while let Some(packet) = cameras.poll(world.now()) {
            frames.extend(packet.detection.map(|frame| (world.now(), frame)));
        }
    }
    frames
}

fn waits(frames: &[(u64, DetectionFrame)]) -> Vec<u64> {
    frames.windows(2).map(|pair| pair[1].0 - pair[0].0).collect()
}

#[test]
fn cameras_send_at_their_frame_rate() {
    for rate in [50.0, 75.0, 100.0] {
        let frames = watched(|model| model.parameters.camera.rate = rate, 4);
        assert!(frames.len().abs_diff((rate * 4.0) as usize) <= 5, "{rate}: {}", frames.len());
    }
}

#[test]
fn a_gap_of_a_hundred_ms_leaves_a_hundred_ms_without_frames() {
    let frames = watched(|model| (model.vision.gap_every_s, model.vision.gap_ms) = (1.0, [100, 100]), 60);
    let gaps: Vec<u64> = waits(&frames).into_iter().filter(|wait| *wait > 10).collect();
    // Frames are 10 ms apart: ten are missing, so the next comes 110 ms after the last. Two gaps may follow
    // each other closely.
    assert!(gaps.iter().filter(|gap| **gap == 110).count() * 10 >= gaps.len() * 8, "{gaps:?}");
    assert!((35..=75).contains(&gaps.len()), "one a second and a tenth on average: {}", gaps.len());
    // The camera's frame numbers continue, so that a receiver can detect what it missed.
    let jumps = frames.windows(2).filter(|pair| pair[1].1.frame_number > pair[0].1.frame_number + 1);
    assert_eq!(jumps.count(), gaps.len());
}

#[test]
fn gaps_fill_the_range_of_their_durations() {
    let frames = watched(|model| (model.vision.gap_every_s, model.vision.gap_ms) = (0.5, GAP_MS), 120);
    let gaps: Vec<u64> = waits(&frames).into_iter().filter(|wait| *wait > 10).collect();
    assert!(gaps.iter().all(|gap| *gap >= 40), "{gaps:?}");
    assert!(gaps.iter().any(|gap| *gap <= 60) && gaps.iter().any(|gap| *gap >= 140), "{gaps:?}");
}

#[test]
fn vision_jitter_stays_within_its_bound_and_keeps_the_frame_order() {
    let frames = watched(|model| model.vision.jitter_ms = 15, 20);
    assert!(frames.windows(2).all(|pair| pair[0].1.frame_number < pair[1].1.frame_number));
    // Our frames are 35 ms late without it.
    let late: Vec<u64> =
        frames.iter().map(|(now, frame)| now - (frame.t_capture * 1e3 + 0.5) as u64).collect();
    assert_eq!((late.iter().min(), late.iter().max()), (Some(&35), Some(&50)));
}

#[test]
fn two_robots_of_a_team_swap_numbers_for_a_few_frames() {
    let frames = watched(|model| (model.vision.swap_every_s, model.vision.swap_frames) = (1.0, [3, 3]), 60);
    let (mut runs, mut length) = (Vec::new(), 0);
    for (_, frame) in &frames {
        let wrong = |robot: &&ssl::vision::DetectionRobot| {
            let n = robot.robot_id.unwrap();
            (robot.x + 300.0 * n as f32).abs() > 1.0 && (robot.x - 300.0 * n as f32 - 100.0).abs() > 1.0
        };
        let here = frame.robots_yellow.iter().chain(&frame.robots_blue).filter(wrong).count();
        assert!(here == 0 || here == 2, "{here}");
        let numbers: BTreeSet<_> = frame.robots_yellow.iter().map(|robot| robot.robot_id).collect();
        assert_eq!(numbers.len(), 6, "each number once");
        if here == 2 {
            length += 1;
        } else if length > 0 {
            runs.push(length);
            length = 0;
        }
    }
    assert!((30..=90).contains(&runs.len()), "one a second on average: {}", runs.len());
    assert!(runs.iter().filter(|run| **run == 3).count() * 10 >= runs.len() * 8, "{runs:?}");
}

#[test]
fn ghosts_and_missed_balls_have_the_configured_probabilities() {
    let frames = watched(
        |model| {
            let noise = &mut model.parameters.noise;
            (noise.ghost_ball, noise.missing_ball) = (0.05, 0.10);
        },
        40,
    );
    let n = frames.len() as f32;
    let real = |ball: &ssl::vision::DetectionBall| ball.x == 1000.0 && ball.y == 1000.0;
    let seen = frames.iter().filter(|(_, frame)| frame.balls.iter().any(real)).count() as f32;
    let ghosts = frames.iter().flat_map(|(_, frame)| &frame.balls).filter(|ball| !real(ball)).count() as f32;
    // Four deviations of 4,000 draws.
    assert!((seen / n - 0.90).abs() < 0.019 && (ghosts / n - 0.05).abs() < 0.014, "{seen} {ghosts} {n}");
}
