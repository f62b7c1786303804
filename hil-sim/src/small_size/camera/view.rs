//! `view`: detections of one camera. Robots and balls in its rectangle of the field, with noise, misses and
//! occlusion; mm and rad on the wire.
//!
//! The camera looks straight down. A ball above the field surface is reported where the line from the camera
//! through it reaches the ground, as vision without heights does (unless the compatibility profile reports
//! heights); a robot's cover height is known and its true position is reported. A robot hides the ball where
//! it stands in that line.

use geometry::{Field, Point, Vector, math};
use ssl::vision::{DetectionBall, DetectionFrame, DetectionRobot, GeometryCameraCalibration};

use super::CameraSettings;
use crate::rng::Stream;
use crate::small_size::compatibility::Profile;
use crate::small_size::robot::Robot;
use crate::small_size::{Ball, World};

/// Camera that looks straight down on its rectangle of the field.
#[derive(Clone, Debug)]
pub(super) struct View {
    id: u32,
    /// Position above the field, m.
    at: Point<Field>,
    height: f32,
    /// Corners of the visible rectangle: with minimum and maximum x and y, m.
    low: Point<Field>,
    high: Point<Field>,
    /// Pixels a metre at one metre's distance.
    focal: f32,
    frame: u32,
    /// Number of frames taken; the next is due a whole number of periods after the first.
    taken: u64,
    /// Frame period, in thousandths of a step.
    period: u64,
    phase: u64,
    first: u64,
    chance: Stream,
    /// The other half of a pair of normal numbers.
    spare: Option<f32>,
}

impl View {
    /// The cameras of these settings, over the field surface of `world`.
    pub(super) fn hang(settings: &CameraSettings, world: &World, seed: u64) -> Vec<Self> {
        let camera = &settings.camera;
        let (columns, rows) = match camera.count {
            4 => (2, 2),
            2 => (2, 1),
            _ => (1, 1),
        };
        let [x, y] = world.pitch().corner();
        let (across, along) = (2.0 * x / columns as f32, 2.0 * y / rows as f32);
        let period = (1e6 / camera.rate) as u64;
        let mut views = Vec::new();
        for id in 0..columns * rows {
            // In grSim's order: the positive quarter first, then clockwise.
            let (column, row) = match (columns * rows, id) {
                (4, 0) => (1, 1),
                (4, 1) => (1, 0),
                (4, 2) => (0, 0),
                (4, _) => (0, 1),
                (2, 0) => (1, 0),
                _ => (0, 0),
            };
            let (left, bottom) = (column as f32 * across - x, row as f32 * along - y);
            // Half the overlap beyond each inner edge; beyond the outer ones there is only a ball that flew
            // away.
            let beyond = |inner: bool| if inner { camera.overlap * 0.5 } else { OUTSIDE_VIEW };
            let low = Point::new(left - beyond(column > 0), bottom - beyond(row > 0));
            let high = Point::new(
                left + across + beyond(column + 1 < columns),
                bottom + along + beyond(row + 1 < rows),
            );
            let reach =
                (across * 0.5 / IMAGE_PIXELS[0] as f32).max(along * 0.5 / IMAGE_PIXELS[1] as f32) * 1.2;
            let phase = if settings.compatibility.staggered {
                period * id as u64 / u64::from(camera.count)
            } else {
                0
            };
            views.push(Self {
                id: id as u32,
                at: Point::new(left + across * 0.5, bottom + along * 0.5),
                height: camera.height,
                low,
                high,
                focal: 0.5 * camera.height / reach,
                frame: 0,
                taken: 0,
                period,
                phase,
                first: world.now() + 1,
                chance: Stream::new(seed, &format!("camera {id}")),
                spare: None,
            });
        }
        views
    }

    /// The step in which the next frame is taken.
    pub(super) fn due(&self) -> u64 {
        self.first + (self.phase + self.taken * self.period) / 1000
    }

    pub(super) fn look(&mut self, world: &World, settings: &CameraSettings, time: f64) -> DetectionFrame {
        self.taken += 1;
        let mut frame = DetectionFrame {
            frame_number: self.frame,
            t_capture: time,
            t_sent: time + f64::from(settings.camera.processing),
            camera_id: self.id,
            balls: Vec::with_capacity(1),
            robots_yellow: Vec::with_capacity(16),
            robots_blue: Vec::with_capacity(16),
            t_capture_camera: None,
        };
        self.frame += 1;
        frame.balls.extend(self.ball(world, settings));
        if self.chance.chance(settings.noise.ghost_ball) {
            frame.balls.push(self.ghost(settings));
        }
        for robot in world.robots() {
            let p = robot.pose.position;
            if !robot.present || !self.sees(p) || self.chance.chance(settings.noise.missing_robot) {
                continue;
            }
            let detection = self.robot(robot, settings);
            robot.who.colour.pick(&mut frame.robots_yellow, &mut frame.robots_blue).push(detection);
        }
        frame
    }

    fn sees(&self, p: Point<Field>) -> bool {
        p.x() >= self.low.x() && p.x() <= self.high.x() && p.y() >= self.low.y() && p.y() <= self.high.y()
    }

    fn robot(&mut self, robot: &Robot, settings: &CameraSettings) -> DetectionRobot {
        let p = self.blurred(robot.pose.position, settings.noise.robot);
        let askew =
            if settings.noise.heading > 0.0 { self.deviation() * settings.noise.heading } else { 0.0 };
        let heading = robot.pose.heading + geometry::Angle::new(askew);
        let [pixel_x, pixel_y] = self.pixel(p, robot.body.height, settings);
        DetectionRobot {
            confidence: 1.0,
            robot_id: Some(u32::from(robot.who.id.number())),
            x: p.x() * 1000.0,
            y: p.y() * 1000.0,
            orientation: Some(heading.radians()),
            pixel_x,
            pixel_y,
            height: (settings.compatibility.profile == Profile::Ours).then_some(robot.body.height * 1000.0),
        }
    }

    fn ball(&mut self, world: &World, settings: &CameraSettings) -> Option<DetectionBall> {
        let (ball, radius) = (&world.ball, world.parameters().ball.radius);
        let reported_height = settings.compatibility.ball_height;
        let seen = if reported_height { ball.position } else { self.apparent(ball) };
        if !self.sees(seen) || self.chance.chance(settings.noise.missing_ball) {
            return None;
        }
        let shows = self.shows(ball, radius, world.robots());
        if shows < settings.noise.hidden_ball {
            return None;
        }
        let p = self.blurred(seen, settings.noise.ball);
        let scale = self.focal / self.height;
        let area = shows * math::PI * radius * radius * scale * scale;
        let [pixel_x, pixel_y] = self.pixel(p, 0.0, settings);
        Some(DetectionBall {
            confidence: if settings.noise.ball > 0.0 { 0.95 + 0.05 * shows } else { 1.0 },
            area: (settings.compatibility.profile != Profile::Grsim).then_some(area as u32),
            x: p.x() * 1000.0,
            y: p.y() * 1000.0,
            // Height of its centre.
            z: reported_height.then_some((ball.height + radius) * 1000.0),
            pixel_x,
            pixel_y,
        })
    }

    fn ghost(&mut self, settings: &CameraSettings) -> DetectionBall {
        let x = self.chance.between(self.low.x(), self.high.x());
        let y = self.chance.between(self.low.y(), self.high.y());
        let [pixel_x, pixel_y] = self.pixel(Point::new(x, y), 0.0, settings);
        let confidence = self.chance.between(0.3, 0.7);
        DetectionBall { confidence, area: Some(12), x: x * 1000.0, y: y * 1000.0, z: None, pixel_x, pixel_y }
    }

    fn apparent(&self, ball: &Ball) -> Point<Field> {
        if ball.height <= 0.0 {
            return ball.position;
        }
        let below = (self.height - ball.height).max(0.1);
        self.at + (ball.position - self.at) * (self.height / below)
    }

    /// The share of the ball that no robot hides, 0–1.
    fn shows(&self, ball: &Ball, radius: f32, robots: &[Robot]) -> f32 {
        let away = self.at - ball.position;
        let mut least: f32 = 1.0;
        for robot in robots {
            let top = robot.body.height;
            let offset = robot.pose.position - ball.position;
            let near = robot.body.radius + radius + SHADOW_REACH;
            if offset.dot(offset) > near * near || !robot.present || ball.height >= top {
                continue;
            }
            // The line to the camera is below the robot's top for this share of its length.
            let share = ((top - ball.height) / (self.height - ball.height).max(0.1)).min(1.0);
            let line = away * share;
            let squared = line.dot(line);
            let along = if squared > 0.0 { (offset.dot(line) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let passes = (offset - line * along).norm();
            let ahead = robot.to_body(ball.position - robot.pose.position)[0];
            // In front of its flat front the ball is outside the disc that stands for the robot here.
            let edge =
                if along == 0.0 && ahead > robot.body.front { robot.body.front } else { robot.body.radius };
            least = least.min(((passes - edge + radius) / (2.0 * radius)).clamp(0.0, 1.0));
        }
        least
    }

    fn blurred(&mut self, point: Point<Field>, sigma: f32) -> Point<Field> {
        if sigma <= 0.0 {
            return point;
        }
        let (x, y) = self.chance.normals();
        point + Vector::new(x * sigma, y * sigma)
    }

    /// Normal with deviation 1; every second value is already computed.
    fn deviation(&mut self) -> f32 {
        self.spare.take().unwrap_or_else(|| {
            let (one, other) = self.chance.normals();
            self.spare = Some(other);
            one
        })
    }

    fn pixel(&self, p: Point<Field>, height: f32, settings: &CameraSettings) -> [f32; 2] {
        match settings.compatibility.profile {
            Profile::Ours => {
                let scale = self.focal / (self.height - height).max(0.1);
                let away = p - self.at;
                [
                    IMAGE_PIXELS[0] as f32 * 0.5 + away.x() * scale,
                    IMAGE_PIXELS[1] as f32 * 0.5 - away.y() * scale,
                ]
            }
            Profile::Grsim => [p.x() * 1000.0, p.y() * 1000.0],
            Profile::ErForce => [0.0, 0.0],
        }
    }

    /// The camera's pose, as geometry packets contain it.
    pub(super) fn calibration(&self, full: bool) -> GeometryCameraCalibration {
        let [x, y, z] = [self.at.x(), self.at.y(), self.height].map(|m| m * 1000.0);
        let ours = GeometryCameraCalibration {
            camera_id: self.id,
            focal_length: self.focal,
            principal_point_x: IMAGE_PIXELS[0] as f32 * 0.5,
            principal_point_y: IMAGE_PIXELS[1] as f32 * 0.5,
            distortion: 0.0,
            // Half a turn about x: columns go with +x, rows with −y, the view down.
            q0: 1.0,
            q1: 0.0,
            q2: 0.0,
            q3: 0.0,
            tx: -x,
            ty: y,
            tz: z,
            derived_camera_world_tx: Some(x),
            derived_camera_world_ty: Some(y),
            derived_camera_world_tz: Some(z),
            pixel_image_width: Some(IMAGE_PIXELS[0]),
            pixel_image_height: Some(IMAGE_PIXELS[1]),
        };
        if full {
            return ours;
        }
        // What both other simulators send.
        GeometryCameraCalibration {
            focal_length: 390.0,
            principal_point_x: 300.0,
            principal_point_y: 300.0,
            distortion: 0.2,
            q0: 0.7,
            q1: 0.7,
            q2: 0.7,
            q3: 0.7,
            tx: 0.0,
            ty: 0.0,
            tz: 3500.0,
            pixel_image_width: None,
            pixel_image_height: None,
            ..ours
        }
    }
}

/// Columns and rows of a camera frame: a common 5 MP camera.
const IMAGE_PIXELS: [u32; 2] = [2448, 2048];
/// m beyond the field surface that outer cameras see: up to the walls of the venue.
const OUTSIDE_VIEW: f32 = 2.0;
/// m that a robot's occlusion reaches, seen from a camera at the far end of its view: 0.15 m high, 45°
/// oblique.
const SHADOW_REACH: f32 = 0.2;
