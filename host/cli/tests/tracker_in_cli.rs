//! `tracker_in_cli`: `onetwo control --tracker-in` between another program's tracker and vision, with real
//! sockets: the tracker falls silent, vision takes over, and the tracker comes back.

mod running;

use std::net::UdpSocket;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use running::{PATIENCE, Running, free, socket};
use ssl::Message;
use ssl::common::Vector3;
use ssl::tracker::{TrackedBall, TrackedFrame, TrackerWrapperPacket};
use ssl::vision::{DetectionBall, DetectionFrame, WrapperPacket};

/// Period of vision and tracker: 60 Hz.
const EVERY: Duration = Duration::from_micros(16_667);
/// Shortest silence after which vision may take over (docs/commands.md).
const SILENCE: Duration = Duration::from_millis(50);
/// Time for which the tracker has to send again before it leads.
const STEADY: Duration = Duration::from_millis(500);
/// The ball lies there by the tracker, and opposite by vision, m.
const TRACKED_Y_M: f32 = -0.5;

fn unix_s() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970").as_secs_f64()
}

fn tracked(number: u32) -> Vec<u8> {
    let pos = Vector3 { x: 1.0, y: TRACKED_Y_M, z: 0.0 };
    let ball = TrackedBall { pos, vel: Some(Vector3 { x: 0.0, y: 0.0, z: 0.0 }), visibility: Some(1.0) };
    let frame = TrackedFrame {
        frame_number: number,
        timestamp: unix_s(),
        balls: vec![ball],
        robots: Vec::new(),
        kicked_ball: None,
        capabilities: Vec::new(),
    };
    let (uuid, source_name) = ("another".to_owned(), Some("other".to_owned()));
    TrackerWrapperPacket { uuid, source_name, tracked_frame: Some(frame) }.encode_to_vec()
}

fn seen(number: u32) -> Vec<u8> {
    let y = -1_000.0 * TRACKED_Y_M;
    let ball = DetectionBall { confidence: 1.0, x: 1_000.0, y, ..DetectionBall::default() };
    let detection = DetectionFrame {
        frame_number: number,
        t_capture: unix_s(),
        t_sent: unix_s(),
        balls: vec![ball],
        ..DetectionFrame::default()
    };
    WrapperPacket { detection: Some(detection), ..WrapperPacket::default() }.encode_to_vec()
}

/// Sends packets at 60 Hz while it is on, until it is dropped.
struct Source {
    on: Arc<AtomicBool>,
    _alive: Arc<()>,
}

impl Source {
    fn start(to: String, packet: fn(u32) -> Vec<u8>) -> Self {
        let (on, alive) = (Arc::new(AtomicBool::new(true)), Arc::new(()));
        let (sends, here) = (on.clone(), Arc::downgrade(&alive));
        thread::spawn(move || {
            let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
            for number in 0.. {
                if here.strong_count() == 0 {
                    return;
                }
                if sends.load(Ordering::Relaxed) {
                    // The receiver may not be open yet.
                    let _ = socket.send_to(&packet(number), &to);
                }
                thread::sleep(EVERY);
            }
        });
        Self { on, _alive: alive }
    }

    /// Starts or stops sending, at the returned time or later: the thread may be held up in between.
    fn set(&self, on: bool) -> Instant {
        let at = Instant::now();
        self.on.store(on, Ordering::Relaxed);
        at
    }
}

/// Waits until the ball of our own tracker lies on that side.
fn ball_is_at(output: &UdpSocket, y: f32) {
    let (until, mut bytes, mut last) = (Instant::now() + PATIENCE, [0; 8192], None);
    while Instant::now() < until {
        let (length, _) = output.recv_from(&mut bytes).expect("our tracker sends");
        let packet = TrackerWrapperPacket::decode(&bytes[..length]).expect("a tracker packet");
        last = packet.tracked_frame.and_then(|frame| frame.balls.first().map(|ball| ball.pos.y));
        if last.is_some_and(|seen| (seen - y).abs() < 0.1) {
            return;
        }
    }
    panic!("the ball is not at {y}: {last:?}");
}

#[test]
fn vision_stands_in_for_a_silent_tracker_until_it_has_sent_for_half_a_second() {
    let (vision, tracker, output) = (free(), free(), socket());
    let own = output.local_addr().expect("an address").to_string();
    let wanted = format!("{tracker},other");
    let robots = ["control", "--headless", "--robots", "udp://127.0.0.1:9", "--insecure-zero-key"];
    let more = ["--vision", &vision, "--referee", &free(), "--tracker", &own, "--tracker-in", &wanted];
    let mut control = Running::start(&[&robots[..], &more[..]].concat());
    let _camera = Source::start(vision, seen);
    ball_is_at(&output, -TRACKED_Y_M);
    let other = Source::start(tracker, tracked);
    control.wait_for("the field comes from tracker other");
    ball_is_at(&output, TRACKED_Y_M);
    let silent = other.set(false) - control.began;
    // A loaded machine may have delayed a packet before; the last change is the one that counts.
    let mut at = control.wait_for("the field comes from vision").0;
    while at < silent {
        at = control.wait_for("the field comes from").0;
    }
    ball_is_at(&output, -TRACKED_Y_M);
    assert!(at + EVERY >= silent + SILENCE, "after {:?} of silence", at.saturating_sub(silent));
    let speaks = other.set(true) - control.began;
    let at = control.wait_for("the field comes from tracker other").0;
    assert!(at >= speaks + STEADY, "{:?} after it came back", at.saturating_sub(speaks));
    ball_is_at(&output, TRACKED_Y_M);
}
