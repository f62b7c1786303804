//! `seen`: valid detections in SI units, field frame; times in µs on the sender's clock.

use geometry::{Angle, Field, Point};
use heapless::Vec;
use protocol::{RobotId, Who};
use rules::Colour;
use ssl::vision::{DetectionFrame, DetectionRobot};

/// Cameras of a field, numbered from 0: the league uses 1 to 8.
pub(super) const CAMERAS_MAX: usize = crate::field_geometry::CAMERAS_MAX as usize;
/// Robots in one camera frame: 11 + 11, some twice under wrong numbers.
const ROBOTS_MAX: usize = 48;
/// Blobs in one camera frame; hands and shoes included.
const BALLS_MAX: usize = 16;
/// Farthest place that is accepted, mm: the largest field's surface ends at 6.7 m, a simulator let a ball lie
/// at 9 m on a 9 m field (trap 11), and venues are not larger.
const MM_MAX: f32 = 30_000.0;
/// Headings come in (−π, π] or (0, 2π]; values far beyond are invalid.
const RADIANS_MAX: f32 = 100.0;
/// The year 2286, s; `f64` still resolves µs up to it.
const SECONDS_MAX: f64 = 1e10;

/// A moment on vision's clock, µs: since 1970, or since a simulator's start.
pub(super) type Captured = i64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RobotSeen {
    pub(super) who: Who,
    pub(super) position: Point<Field>,
    /// Absent where only a part of the pattern was seen.
    pub(super) heading: Option<Angle>,
    pub(super) confidence: f32,
}

/// A blob in a camera frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BallSeen {
    pub(super) position: Point<Field>,
    pub(super) confidence: f32,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) at: Captured,
    pub(super) camera: u32,
    pub(super) robots: Vec<RobotSeen, ROBOTS_MAX>,
    pub(super) balls: Vec<BallSeen, BALLS_MAX>,
    /// Average time between frames of its camera, s.
    pub(super) gap: f32,
    /// Number of invalid objects: not finite, too far, without a shell number, or too many.
    pub(super) nonsense: u32,
}

impl Frame {
    pub(super) const fn empty() -> Self {
        Self { at: 0, camera: 0, robots: Vec::new(), balls: Vec::new(), gap: 0.0, nonsense: 0 }
    }

    /// Reads a camera frame into this one; `false` where its time or camera is invalid.
    #[must_use]
    pub(super) fn read(&mut self, frame: &DetectionFrame) -> bool {
        let Some(at) = captured(frame.t_capture).filter(|_| frame.camera_id < CAMERAS_MAX as u32) else {
            return false;
        };
        (self.at, self.camera, self.nonsense) = (at, frame.camera_id, 0);
        self.robots.clear();
        self.balls.clear();
        for (colour, robots) in [(Colour::Yellow, &frame.robots_yellow), (Colour::Blue, &frame.robots_blue)] {
            for robot in robots {
                let taken = seen(colour, robot).is_some_and(|seen| self.robots.push(seen).is_ok());
                self.nonsense += u32::from(!taken);
            }
        }
        for ball in &frame.balls {
            let seen = place(ball.x, ball.y)
                .map(|position| BallSeen { position, confidence: share(ball.confidence) });
            let taken = seen.is_some_and(|seen| self.balls.push(seen).is_ok());
            self.nonsense += u32::from(!taken);
        }
        true
    }
}

/// A time of the protocol, s, in µs; `None` where it is no valid time.
pub(super) fn captured(seconds: f64) -> Option<Captured> {
    (0.0..=SECONDS_MAX).contains(&seconds).then_some((seconds * 1e6 + 0.5) as i64)
}

fn seen(colour: Colour, robot: &DetectionRobot) -> Option<RobotSeen> {
    let id = RobotId::new(u8::try_from(robot.robot_id?).ok()?)?;
    let heading = match robot.orientation {
        Some(radians) if radians.abs() <= RADIANS_MAX => Some(Angle::new(radians)),
        Some(_) => return None,
        None => None,
    };
    let position = place(robot.x, robot.y)?;
    Some(RobotSeen { who: Who { colour, id }, position, heading, confidence: share(robot.confidence) })
}

/// From mm; `None` for a place too far from a field.
fn place(x: f32, y: f32) -> Option<Point<Field>> {
    let near = |mm: f32| mm.abs() <= MM_MAX;
    (near(x) && near(y)).then(|| Point::new(x * 0.001, y * 0.001))
}

fn share(confidence: f32) -> f32 {
    if confidence.is_nan() { 0.0 } else { confidence.clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssl::vision::DetectionBall;

    fn ball(x: f32, y: f32) -> DetectionBall {
        DetectionBall { confidence: 1.0, x, y, ..DetectionBall::default() }
    }

    fn robot(id: Option<u32>, x: f32, orientation: f32) -> DetectionRobot {
        DetectionRobot {
            confidence: f32::NAN,
            robot_id: id,
            x,
            orientation: Some(orientation),
            ..DetectionRobot::default()
        }
    }

    #[test]
    fn what_is_not_a_number_or_far_off_is_left_out_and_counted() {
        let message = DetectionFrame {
            t_capture: 1.5,
            balls: vec![ball(1.0, f32::NAN), ball(9000.0, 0.0), ball(-1e9, 0.0), ball(f32::INFINITY, 0.0)],
            robots_blue: vec![robot(Some(3), 500.0, 7.0), robot(Some(16), 0.0, 0.0), robot(None, 0.0, 0.0)],
            robots_yellow: vec![robot(Some(0), 0.0, f32::NAN), robot(Some(u32::MAX), 0.0, 0.0)],
            ..DetectionFrame::default()
        };
        let mut frame = Frame::empty();
        assert!(frame.read(&message));
        assert_eq!((frame.at, frame.nonsense), (1_500_000, 7));
        assert_eq!(frame.balls[..], [BallSeen { position: Point::new(9.0, 0.0), confidence: 1.0 }]);
        let blue = Who { colour: Colour::Blue, id: RobotId::new(3).unwrap() };
        let heading = Some(Angle::new(7.0));
        assert_eq!(
            frame.robots[..],
            [RobotSeen { who: blue, position: Point::new(0.5, 0.0), heading, confidence: 0.0 }]
        );
    }

    #[test]
    fn an_image_without_a_time_or_camera_is_refused_whole() {
        let at = |t_capture, camera_id| {
            Frame::empty().read(&DetectionFrame { t_capture, camera_id, ..DetectionFrame::default() })
        };
        assert!(at(0.0, 15) && at(1.8e9, 0));
        assert!(!at(f64::NAN, 0) && !at(-1.0, 0) && !at(1e300, 0) && !at(1.0, 16));
    }

    #[test]
    fn a_thousand_balls_fill_the_image_and_are_counted() {
        let balls = vec![ball(0.0, 0.0); 1000];
        let mut frame = Frame::empty();
        assert!(frame.read(&DetectionFrame { balls, ..DetectionFrame::default() }));
        assert_eq!((frame.balls.len(), frame.nonsense), (BALLS_MAX, 1000 - BALLS_MAX as u32));
    }
}
