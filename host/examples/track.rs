//! `track`: statistics of tracking on a recorded match: rates and delays of the cameras, results of camera
//! frames and objects, noise.
//!
//! ```sh
//! cargo run --release -p onetwo-host --example track -- protocol/ssl/tests/data/grsim_divB_noisy_64s.log.gz
//! ```
//! `--times N` feeds the recording N times and prints only the sum of positions: for counting instructions
//! (`valgrind --tool=callgrind`, N and 2 N, the difference divided by the camera frames).

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use host::tracking::Tracker;
use protocol::Instant;
use ssl::log::Packet;
use ssl::vision::{DetectionFrame, DetectionRobot, WrapperPacket};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (path, times) = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [path] => (PathBuf::from(path), None),
        [path, "--times", times] => (PathBuf::from(path), times.parse().ok()),
        _ => {
            eprintln!("track FILE.log[.gz] [--times N]");
            return ExitCode::from(2);
        }
    };
    match (packets(&path), times) {
        (Err(error), _) => {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
        (Ok(packets), None) => report(&packets),
        (Ok(packets), Some(times)) => println!("{}", (0..times).map(|_| feed(&packets)).sum::<f32>()),
    }
    ExitCode::SUCCESS
}

fn packets(path: &std::path::Path) -> Result<Vec<(Instant, WrapperPacket)>, ssl::log::LogError> {
    let mut packets = Vec::new();
    let mut first = None;
    for record in ssl::log::open(path)? {
        let since = record.timestamp_ns.saturating_sub(*first.get_or_insert(record.timestamp_ns)).max(0);
        if let Ok(Some(Packet::Vision(packet))) = record.decode() {
            packets.push((Instant(since as u64 / 1000), packet));
        }
    }
    Ok(packets)
}

/// Every packet, and the tracked world after each.
fn feed(packets: &[(Instant, WrapperPacket)]) -> f32 {
    let mut tracker = Tracker::default();
    let mut sum = 0.0;
    for (arrived, packet) in packets {
        tracker.handle(packet, *arrived);
        let world = tracker.world(*arrived);
        sum += world.ball.map_or(0.0, |ball| ball.position.x());
        sum += world.robots().map(|robot| robot.pose.position.x()).sum::<f32>();
    }
    sum
}

fn report(packets: &[(Instant, WrapperPacket)]) {
    let mut tracker = Tracker::default();
    let mut cameras: BTreeMap<u32, (u32, f64, f64)> = BTreeMap::new();
    let (mut delays, mut kick) = (Vec::new(), None);
    for (arrived, packet) in packets {
        tracker.handle(packet, *arrived);
        let Some(image) = &packet.detection else { continue };
        let camera = cameras.entry(image.camera_id).or_insert((0, image.t_capture, image.t_capture));
        (camera.0, camera.2) = (camera.0 + 1, image.t_capture);
        delays.push(tracker.delay().0);
        let world = tracker.snapshot();
        let kicked = world.ball.and_then(|ball| ball.kicked);
        if let Some(now) = kicked.filter(|now| kick != Some((now.by, now.from))) {
            let by = now.by.map_or("a robot".into(), |who| format!("{} {}", who.colour.label(), who.id));
            println!(
                "{:8.3} s: {by} kicks at {:?} with {:.1} m/s, {:.1} m/s up",
                now.at.as_secs_f32(),
                now.from,
                now.velocity.norm(),
                now.climb
            );
            kick = Some((now.by, now.from));
        }
    }
    for (camera, (images, from, to)) in cameras {
        println!(
            "camera {camera}: {images} images, {:.1} a second of vision's clock",
            f64::from(images) / (to - from)
        );
    }
    delays.sort_unstable();
    if let (Some(middle), Some(most)) = (delays.get(delays.len() / 2), delays.last()) {
        println!(
            "from image to arrival: {:.1} ms in the median, {:.1} at most",
            *middle as f64 * 1e-3,
            *most as f64 * 1e-3
        );
    }
    println!("{:#?}\n{:#?}", tracker.counts(), tracker.objects());
    noise(packets);
}

/// Time, s, and place, mm and rad.
type Glimpse = (f64, [f64; 3]);

/// Noise from second differences of consecutive frames of one camera: for a body at constant speed they
/// contain only noise, with six times its variance; the median of their absolute values is not affected by
/// the few bodies that accelerate.
fn noise(packets: &[(Instant, WrapperPacket)]) {
    let images = || packets.iter().filter_map(|(_, packet)| packet.detection.as_ref());
    let robots = |image: &DetectionFrame| -> Vec<(u32, f64, DetectionRobot)> {
        let teams = [&image.robots_yellow, &image.robots_blue].into_iter().enumerate();
        let all = teams.flat_map(|(team, robots)| robots.iter().map(move |robot| (team, robot)));
        all.filter_map(|(team, robot)| Some((robot.robot_id? + 100 * team as u32, image.t_capture, *robot)))
            .collect()
    };
    let mut last: BTreeMap<(u32, u32), Vec<Glimpse>> = BTreeMap::new();
    for image in images() {
        for (id, t, robot) in robots(image) {
            let heading = f64::from(robot.orientation.unwrap_or(0.0));
            let seen = (t, [f64::from(robot.x), f64::from(robot.y), heading]);
            last.entry((image.camera_id, id)).or_default().push(seen);
        }
        if let [ball] = image.balls[..] {
            let seen = (image.t_capture, [f64::from(ball.x), f64::from(ball.y), 0.0]);
            last.entry((image.camera_id, u32::MAX)).or_default().push(seen);
        }
    }
    let sigma = |ball: bool, axes: &[usize]| {
        let mut sizes = Vec::new();
        for seen in last.iter().filter(|((_, id), _)| (*id == u32::MAX) == ball).map(|(_, seen)| seen) {
            for three in seen.windows(3).filter(|three| three[2].0 - three[0].0 < 0.04) {
                for axis in axes {
                    let bend = three[2].1[*axis] - 2.0 * three[1].1[*axis] + three[0].1[*axis];
                    sizes.push(if *axis == 2 { bend.sin().atan2(bend.cos()).abs() } else { bend.abs() });
                }
            }
        }
        sizes.sort_by(f64::total_cmp);
        // A normal variable's median absolute value is 0.6745 of its deviation.
        sizes.get(sizes.len() / 2).map_or(0.0, |middle| middle / 0.6745 / 6.0_f64.sqrt())
    };
    println!(
        "noise: robots {:.2} mm and {:.4} rad, ball {:.2} mm",
        sigma(false, &[0, 1]),
        sigma(false, &[2]),
        sigma(true, &[0, 1])
    );
}
