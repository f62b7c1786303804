//! `order`: tests: tracking does not depend on how the network shuffled, copied and delayed packets.

use geometry::{Field, Point, Vector};
use host::tracking::{Tracker, VisionVerdict};
use host::world::World;
use motion::ball::BallModel;
use motion::trajectory::Motion;
use protocol::Instant;
use rules::Colour::{Blue, Yellow};
use ssl::vision::WrapperPacket;

use crate::stadium::{RATE, Stadium, Truth, arrival, who};

/// Three seconds with a kick, moving robots and misses, seen by four cameras.
fn images() -> Vec<(f64, WrapperPacket)> {
    let mut stadium = Stadium::four_cameras(21);
    stadium.missed = 0.1;
    let path = BallModel::default().kicked(Point::<Field>::new(-1.0, 0.2), Vector::new(4.0, 1.0));
    let mut images = vec![(0.0, stadium.geometry())];
    images.extend(stadium.images(0.0, 3.0, |t| {
        let ball = path.at((t - 1.0) as f32).position;
        let robots = (0..6).flat_map(|id| {
            let (x, y) = (f64::from(id) * 0.7 - 2.0, (t + f64::from(id)).sin());
            [(who(Yellow, id), [x, y, t]), (who(Blue, id), [-x, -y - 0.4, -t])]
        });
        Truth { balls: vec![[f64::from(ball.x()), f64::from(ball.y()), 0.0]], robots: robots.collect() }
    }));
    images
}

/// All results, as bits.
fn bits(world: &World) -> Vec<u32> {
    let ball = world.ball.iter().flat_map(|ball| {
        let (p, v) = (ball.position, ball.velocity);
        [p.x(), p.y(), ball.height, v.x(), v.y(), ball.climb, ball.confidence, ball.rolls_below]
    });
    let robots = world.robots().flat_map(|robot| {
        let (p, v) = (robot.pose.position, robot.velocity);
        let id = f32::from(robot.who.id.number());
        [id, p.x(), p.y(), robot.pose.heading.radians(), v.x(), v.y(), robot.angular, robot.confidence]
    });
    ball.chain(robots).map(f32::to_bits).collect()
}

#[test]
fn copies_of_half_of_the_frames_and_late_copies_of_all_change_nothing() {
    let (mut plain, mut copied) = (Tracker::default(), Tracker::default());
    let images = images();
    let mut late = images.iter().skip(1).map(|(t, packet)| (t + 0.1, packet)).peekable();
    let mut copies = 0;
    for (i, (t, packet)) in images.iter().enumerate() {
        plain.handle(packet, arrival(*t));
        // The wireless copies, a tenth of a second late.
        while let Some((then, packet)) = late.next_if(|(then, _)| then < t) {
            let received = copied.handle(packet, arrival(then));
            assert!(matches!(received, VisionVerdict::Repeated | VisionVerdict::Late(_)), "{received:?}");
            copies += 1;
        }
        copied.handle(packet, arrival(*t));
        if i > 0 && i % 2 == 0 {
            assert_eq!(copied.handle(packet, arrival(*t + 0.001)), VisionVerdict::Repeated);
            copies += 1;
        }
        assert_eq!(plain.snapshot(), copied.snapshot(), "at {t} s");
    }
    assert_eq!(plain.objects(), copied.objects());
    assert_eq!(copied.counts().repeated + copied.counts().late, copies);
    assert!(copies > 1_000 && plain.snapshot().robots().count() == 12);
}

#[test]
fn frames_out_of_order_give_the_same_snapshot_as_in_order() {
    let mut plain = Tracker::default();
    let images = images();
    for (t, packet) in &images {
        plain.handle(packet, arrival(*t));
    }
    let expected = bits(&plain.snapshot());
    for seed in 0..5 {
        let mut random = Stadium::one_camera(seed);
        // Each packet is in transit for up to 40 ms: about ten packets overtake each other.
        let mut delayed: Vec<(f64, &WrapperPacket)> =
            images.iter().map(|(t, packet)| (t + 0.04 * random.share(), packet)).collect();
        delayed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut tracker = Tracker::default();
        tracker.handle(&images[0].1, Instant(0));
        for (t, packet) in delayed {
            tracker.handle(packet, arrival(t));
        }
        let counts = tracker.counts();
        assert!(counts.reordered > 300 && counts.late == 0 && counts.repeated == 0, "{counts:?}");
        assert_eq!(bits(&tracker.snapshot()), expected, "seed {seed}");
        assert_eq!(tracker.objects(), plain.objects(), "seed {seed}");
    }
}

#[test]
fn trap_02_four_frames_a_tick_with_a_robot_in_all_of_them_are_one_robot() {
    // As grSim sends: every camera at the same moment with its own number, empty ones included.
    let mut stadium = Stadium::four_cameras(22);
    for camera in &mut stadium.cameras {
        camera.phase = 0.0;
    }
    let mut tracker = Tracker::default();
    for tick in 0..120 {
        let t = f64::from(tick) / RATE;
        for camera in 0..4 {
            let truth = Truth {
                balls: vec![[0.0, 0.0, 0.0]],
                robots: vec![(who(Blue, 3), [0.1, -0.1, 0.5]), (who(Yellow, 8), [-3.0, 2.0, 0.0])],
            };
            let packet = stadium.image(camera, 500 + tick * (camera as u32 + 1), t, &truth);
            assert_eq!(tracker.handle(&packet, arrival(t)), VisionVerdict::Newest);
        }
    }
    let world = tracker.snapshot();
    assert_eq!(world.robots().count(), 2);
    let robot = world.robot(who(Blue, 3)).unwrap();
    assert!(robot.pose.position.distance(Point::new(0.1, -0.1)) < 0.005, "{robot:?}");
    let objects = tracker.objects();
    assert_eq!(objects.balls.others, 0, "{objects:?}");
    assert_eq!(objects.robots.jumped + objects.robots.wrong_name, 0, "{objects:?}");
}
