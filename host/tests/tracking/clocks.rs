//! `clocks`: tests: tracking is independent of vision's clock and its jumps.

use geometry::Point;
use host::tracking::{Tracker, VisionVerdict};
use protocol::{Duration, Instant};
use rules::Colour::Yellow;

use crate::stadium::{RATE, Stadium, Truth, arrival, play, who};

fn truth(t: f64) -> Truth {
    Truth { balls: vec![[-2.0 + t, 0.5, 0.0]], robots: vec![(who(Yellow, 3), [1.0 - t, -0.5, 0.0])] }
}

#[test]
fn trap_01_simulation_time_and_unix_time_give_the_same_snapshot_on_our_clock() {
    let snapshots = [0.0, 1_795_220_511.25].map(|epoch| {
        let mut stadium = Stadium { epoch, ..Stadium::one_camera(31) };
        let mut tracker = Tracker::default();
        play(&mut stadium, &mut tracker, (0.0, 2.0), truth, |_, _| {});
        // Vision took 4 ms, the network at least 0: the frame was taken 4 ms before its packet came.
        let taken = arrival(119.0 / RATE) - Duration::millis(4);
        let snapshot = tracker.snapshot();
        assert!(snapshot.time.0.abs_diff(taken.0) < 50, "{:?}, not {taken:?}", snapshot.time);
        assert!((tracker.captured().unwrap() - epoch - 119.0 / RATE).abs() < 1e-5);
        snapshot
    });
    let [simulated, unix] = snapshots;
    let (a, b) = (simulated.ball.unwrap(), unix.ball.unwrap());
    // f64 resolves Unix seconds to a quarter of a microsecond.
    assert!(a.position.distance(b.position) < 1e-4 && (a.velocity - b.velocity).norm() < 1e-3);
}

#[test]
fn the_snapshot_is_carried_to_the_moment_asked_for() {
    let mut tracker = Tracker::default();
    play(&mut Stadium::one_camera(32), &mut tracker, (0.0, 2.0), truth, |_, _| {});
    let snapshot = tracker.snapshot();
    let later = tracker.world(snapshot.time + Duration::millis(80));
    let moved = later.ball.unwrap().position - snapshot.ball.unwrap().position;
    assert!((moved.x() - 0.08).abs() < 0.01, "{moved:?}");
    let robot = later.robot(who(Yellow, 3)).unwrap().pose.position.x();
    assert!((robot - (1.0 - 119.0 / RATE as f32 - 0.08)).abs() < 0.03, "{robot}");
}

/// Feeds camera frames whose clock is `epoch` ahead of ours from `from` to `to`, our time, and returns the
/// results.
fn run(tracker: &mut Tracker, epoch: f64, from: f64, to: f64) -> Vec<VisionVerdict> {
    let mut stadium = Stadium { epoch, ..Stadium::one_camera(33) };
    let images = stadium.images(from, to, truth);
    images.iter().map(|(t, packet)| tracker.handle(packet, arrival(*t))).collect()
}

#[test]
fn a_restarted_simulator_is_followed_within_a_quarter_of_a_second() {
    for epoch in [-2.9, -1.5, 3_600.0, 1_795_220_511.0] {
        let mut tracker = Tracker::default();
        run(&mut tracker, 100.0, 0.0, 3.0);
        let received = run(&mut tracker, 100.0 + epoch, 3.0, 4.0);
        let restart = received.iter().position(|received| *received == VisionVerdict::Restarted);
        assert!(restart.is_some_and(|images| images as f64 / RATE < 0.25), "{epoch}: {restart:?}");
        assert!(received[restart.unwrap() + 1..].iter().all(|received| *received == VisionVerdict::Newest));
        assert_eq!(tracker.counts().restarts, 1);
        let ball = tracker.snapshot().ball.unwrap();
        assert!(ball.position.distance(Point::new(2.0 - 1.0 / RATE as f32, 0.5)) < 0.02, "{epoch}: {ball:?}");
    }
}

#[test]
fn a_clock_set_back_by_less_than_a_second_is_followed_too() {
    let mut tracker = Tracker::default();
    run(&mut tracker, 100.0, 0.0, 3.0);
    let received = run(&mut tracker, 99.29, 3.0, 4.5);
    let restart = received.iter().position(|received| *received == VisionVerdict::Restarted);
    assert!(restart.is_some_and(|images| images as f64 / RATE < 0.55), "{restart:?}");
    assert!(
        received[..restart.unwrap()]
            .iter()
            .all(|received| matches!(received, VisionVerdict::Late(_) | VisionVerdict::Repeated))
    );
}

#[test]
fn after_ten_seconds_without_vision_the_snapshot_comes_back_at_once() {
    let mut tracker = Tracker::default();
    run(&mut tracker, 50.0, 0.0, 1.0);
    let received = run(&mut tracker, 50.0, 11.0, 11.2);
    assert!(received.iter().all(|received| *received == VisionVerdict::Newest), "{received:?}");
    let ball = tracker.snapshot().ball.unwrap();
    assert!(ball.position.distance(Point::new(9.2 - 1.0 / RATE as f32, 0.5)) < 0.02, "{ball:?}");
    assert!(tracker.snapshot().robot(who(Yellow, 3)).is_some());
}

#[test]
fn a_simulator_that_stood_still_for_ten_seconds_goes_on_and_is_not_ten_seconds_late() {
    let mut tracker = Tracker::default();
    run(&mut tracker, 50.0, 0.0, 1.0);
    // Its clock continues where it stood.
    let received = run(&mut tracker, 40.0, 11.0, 12.0);
    assert!(received.iter().all(|received| *received == VisionVerdict::Newest), "{received:?}");
    assert!(tracker.delay() < Duration::millis(10), "{:?}", tracker.delay());
    assert!(tracker.snapshot().time.0.abs_diff(arrival(12.0).0) < 30_000);
}

#[test]
fn a_second_vision_with_another_clock_is_received_and_left_alone() {
    let mut tracker = Tracker::default();
    let ours = Stadium::one_camera(34).images(0.0, 3.0, truth);
    let mut other = Stadium { epoch: 1_795_220_511.0, ..Stadium::one_camera(35) };
    let elsewhere = |_| Truth { balls: vec![[4.0, 2.0, 0.0]], robots: vec![] };
    let theirs = other.images(0.001, 3.0, elsewhere);
    for ((t, a), (u, b)) in ours.iter().zip(&theirs) {
        assert_eq!(tracker.handle(a, arrival(*t)), VisionVerdict::Newest);
        assert_eq!(tracker.handle(b, arrival(*u)), VisionVerdict::ForeignClock);
    }
    let ball = tracker.snapshot().ball.unwrap();
    assert!(ball.position.distance(Point::new(1.0 - 1.0 / RATE as f32, 0.5)) < 0.02, "{ball:?}");
    assert!(tracker.counts().foreign > 150);
}

#[test]
fn nonsense_times_are_counted_and_survived() {
    let mut tracker = Tracker::default();
    run(&mut tracker, 10.0, 0.0, 1.0);
    let before = tracker.snapshot();
    let mut stadium = Stadium::one_camera(36);
    for t_capture in [f64::NAN, f64::INFINITY, -5.0, 1e18, f64::MIN_POSITIVE, 9e9] {
        let mut packet = stadium.image(0, 1, 0.0, &truth(0.0));
        packet.detection.as_mut().unwrap().t_capture = t_capture;
        let received = tracker.handle(&packet, arrival(1.0));
        assert!(
            matches!(received, VisionVerdict::Nonsense | VisionVerdict::ForeignClock),
            "{t_capture}: {received:?}"
        );
    }
    assert_eq!(tracker.snapshot(), before);
    assert_eq!(tracker.handle(&ssl::vision::WrapperPacket::default(), Instant(0)), VisionVerdict::NoImage);
    let counts = *tracker.counts();
    assert_eq!((counts.nonsense, counts.foreign, counts.no_image), (4, 2, 1));
    assert_eq!(counts.packets(), 60 + 7);
}
