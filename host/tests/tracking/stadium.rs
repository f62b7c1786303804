//! An artificial field with known ground truth, seen by cameras with noise. SI; vision's packets in mm as in
//! the protocol.

use host::tracking::{Tracker, VisionVerdict};
use protocol::{Instant, RobotId, Who};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rules::Colour;
use ssl::vision::{
    DetectionBall, DetectionFrame, DetectionRobot, GeometryCameraCalibration, GeometryData,
    GeometryFieldSize, WrapperPacket,
};

/// Frames a second of each camera.
pub(crate) const RATE: f64 = 60.0;

/// The ground truth: m, rad.
#[derive(Clone, Debug, Default)]
pub(crate) struct Truth {
    /// Balls: x, y, z, m.
    pub(crate) balls: Vec<[f64; 3]>,
    pub(crate) robots: Vec<(Who, [f64; 3])>,
}

/// A camera: its position, m, the time of its first frame, s, and its error, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera {
    pub(crate) above: [f64; 2],
    pub(crate) height: f64,
    pub(crate) phase: f64,
    pub(crate) off: [f64; 2],
}

/// Cameras and the noise they see.
pub(crate) struct Stadium {
    pub(crate) cameras: Vec<Camera>,
    /// Standard deviation of balls and robots, m, and of headings, rad.
    pub(crate) sigma: [f64; 3],
    /// Share of objects that are missed.
    pub(crate) missed: f64,
    /// Vision's clock when ours is at 0, s.
    pub(crate) epoch: f64,
    pub(crate) rng: Xoshiro256PlusPlus,
}

pub(crate) fn who(colour: Colour, id: u8) -> Who {
    Who { colour, id: RobotId::new(id).unwrap() }
}

impl Stadium {
    /// One camera over the middle.
    pub(crate) fn one_camera(seed: u64) -> Self {
        let camera = Camera { above: [0.0, 0.0], height: 4.0, phase: 0.0, off: [0.0; 2] };
        Self {
            cameras: vec![camera],
            sigma: [0.003, 0.003, 0.03],
            missed: 0.0,
            epoch: 0.0,
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        }
    }

    /// Four cameras over the quarters of a 9 × 6 m field, not in step, each off by up to 5 mm.
    pub(crate) fn four_cameras(seed: u64) -> Self {
        let quarter = |(i, (x, y)): (usize, (f64, f64))| Camera {
            above: [x * 2.25, y * 1.5],
            height: 4.0,
            phase: i as f64 * 0.0037,
            off: [x * 0.005, y * -0.005],
        };
        let cameras = [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)];
        Self { cameras: cameras.into_iter().enumerate().map(quarter).collect(), ..Self::one_camera(seed) }
    }

    pub(crate) fn geometry(&self) -> WrapperPacket {
        let calibration = |(i, camera): (usize, &Camera)| GeometryCameraCalibration {
            camera_id: i as u32,
            derived_camera_world_tx: Some((camera.above[0] * 1000.0) as f32),
            derived_camera_world_ty: Some((camera.above[1] * 1000.0) as f32),
            derived_camera_world_tz: Some((camera.height * 1000.0) as f32),
            ..GeometryCameraCalibration::default()
        };
        let field = GeometryFieldSize {
            field_length: 9_000,
            field_width: 6_000,
            goal_width: 1_000,
            goal_depth: 180,
            boundary_width: 300,
            ..GeometryFieldSize::default()
        };
        let geometry = GeometryData {
            field,
            calib: self.cameras.iter().enumerate().map(calibration).collect(),
            models: None,
        };
        WrapperPacket { geometry: Some(geometry), ..WrapperPacket::default() }
    }

    /// The camera frames between two moments, in the order they are taken.
    pub(crate) fn images(
        &mut self,
        from: f64,
        to: f64,
        truth: impl Fn(f64) -> Truth,
    ) -> Vec<(f64, WrapperPacket)> {
        let mut times = Vec::new();
        for (camera, Camera { phase, .. }) in self.cameras.iter().enumerate() {
            let first = ((from - phase) * RATE).ceil().max(0.0) as u32;
            let taken = (first..).map(|n| (phase + f64::from(n) / RATE, n));
            times.extend(taken.take_while(|(t, _)| *t < to).map(|(t, n)| (t, camera, n)));
        }
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        times.into_iter().map(|(t, camera, n)| (t, self.image(camera, n, t, &truth(t)))).collect()
    }

    pub(crate) fn image(&mut self, number: usize, frame_number: u32, t: f64, truth: &Truth) -> WrapperPacket {
        let camera = self.cameras[number];
        let mut detection = DetectionFrame {
            frame_number,
            t_capture: self.epoch + t,
            t_sent: self.epoch + t + 0.004,
            camera_id: number as u32,
            ..DetectionFrame::default()
        };
        for [x, y, z] in &truth.balls {
            let lift = camera.height / (camera.height - z);
            let at = [0, 1].map(|i| camera.above[i] + ([x, y][i] - camera.above[i]) * lift);
            if let Some([x, y]) = self.see(camera, at, self.sigma[0]) {
                detection.balls.push(DetectionBall { confidence: 1.0, x, y, ..DetectionBall::default() });
            }
        }
        for (who, [x, y, heading]) in &truth.robots {
            let Some([x, y]) = self.see(camera, [*x, *y], self.sigma[1]) else { continue };
            let heading = heading + self.sigma[2] * self.gauss();
            let robot = DetectionRobot {
                confidence: 1.0,
                robot_id: Some(u32::from(who.id.number())),
                x,
                y,
                orientation: Some(heading.sin().atan2(heading.cos()) as f32),
                ..DetectionRobot::default()
            };
            match who.colour {
                Colour::Yellow => detection.robots_yellow.push(robot),
                Colour::Blue => detection.robots_blue.push(robot),
            }
        }
        WrapperPacket { detection: Some(detection), ..WrapperPacket::default() }
    }

    /// Where a camera detects something, mm, if it does.
    fn see(&mut self, camera: Camera, at: [f64; 2], sigma: f64) -> Option<[f32; 2]> {
        let reach = if self.cameras.len() == 1 { [20.0, 20.0] } else { [2.75, 2.0] };
        let covered = (0..2).all(|i| (at[i] - camera.above[i]).abs() < reach[i]);
        let seen = self.share() >= self.missed;
        (covered && seen)
            .then(|| [0, 1].map(|i| ((at[i] + camera.off[i] + sigma * self.gauss()) * 1000.0) as f32))
    }

    /// Uniform in [0, 1).
    pub(crate) fn share(&mut self) -> f64 {
        (self.rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal, mean 0, deviation 1.
    pub(crate) fn gauss(&mut self) -> f64 {
        let (a, b) = (1.0 - self.share(), self.share());
        (-2.0 * a.ln()).sqrt() * (b * std::f64::consts::TAU).cos()
    }
}

/// When a packet of a frame taken then arrives, our clock: 5 ms later.
pub(crate) fn arrival(t: f64) -> Instant {
    Instant(((t + 0.005) * 1e6) as u64)
}

/// Feeds a tracker and reads the world after every camera frame.
pub(crate) fn play(
    stadium: &mut Stadium,
    tracker: &mut Tracker,
    span: (f64, f64),
    truth: impl Fn(f64) -> Truth,
    mut after: impl FnMut(f64, &Tracker),
) {
    tracker.handle(&stadium.geometry(), arrival(span.0));
    for (t, packet) in stadium.images(span.0, span.1, truth) {
        assert_eq!(tracker.handle(&packet, arrival(t)), VisionVerdict::Newest, "at {t} s");
        after(t, tracker);
    }
}

/// Root of the mean of squares.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rms {
    sum: f64,
    count: f64,
    pub(crate) worst: f64,
}

impl Rms {
    pub(crate) fn add(&mut self, error: f64) {
        self.sum += error * error;
        self.count += 1.0;
        self.worst = self.worst.max(error.abs());
    }

    pub(crate) fn value(&self) -> f64 {
        assert!(self.count > 0.0, "nothing was measured");
        (self.sum / self.count).sqrt()
    }
}
