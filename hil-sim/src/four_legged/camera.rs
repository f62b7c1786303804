//! `camera`: perception of the real-robot profile. Range and bearing in the body frame, as a camera on a
//! turning head sees ball and landmarks; m, rad (docs/papers.md R40).
//!
//! A range is measured by the size of an image: one column of error of an object of size s at distance r is
//! an error of r² · column / s, so errors grow with the square of the distance. All bearings of a frame share
//! the error of the neck's joints and of the gait's sway, which is correlated over steps. What is outside of
//! the view, too far away, or missed by chance is not detected. The head follows the ball, sweeps for
//! landmarks every few seconds, and sweeps while the ball is lost.

use geometry::{Angle, Field, Point, Pose, math};
use protocol::robot_io::{CameraFrame, LandmarkSight, Sight};
use rules::{LANDMARKS, League};

use crate::four_legged::drift::Drift;
use crate::four_legged::parameters::Noise;
use crate::rng::Stream;

#[derive(Clone, Debug)]
pub(crate) struct Camera {
    noise: Noise,
    chance: Stream,
    sway: Drift,
    /// Number of frames so far.
    frames: u32,
    /// Frames since the ball was detected.
    without_ball: u32,
    dt: f32,
}

#[derive(Clone, Copy)]
struct Image {
    /// Size by which the range is measured, m.
    size: f32,
    /// Distance at which the object is no longer detected, m.
    within: f32,
}

impl Camera {
    /// A camera with a frame every `dt` s.
    pub(crate) fn new(noise: Noise, dt: f32, mut chance: Stream) -> Self {
        let sway = Drift::new(noise.sway_time, dt, &mut chance);
        Self { noise, chance, sway, frames: 0, without_ball: 0, dt }
    }

    /// The frame from `pose`; `walks` while the legs move, and no `ball` where the body hides it.
    pub(crate) fn frame(
        &mut self,
        pose: Pose<Field>,
        ball: Option<Point<Field>>,
        walks: bool,
    ) -> CameraFrame {
        let head = self.head(ball.map(|ball| pose.turn_to(ball)));
        self.frames += 1;
        let sway = self.sway.step(&mut self.chance);
        let degrees = self.noise.joint_deg + if walks { self.noise.sway_deg } else { 0.0 };
        let off = Angle::degrees(sway * degrees);
        let size = 2.0 * League::FourLegged.ball().radius;
        let image = Image { size, within: self.noise.ball_within };
        let ball = ball.and_then(|ball| self.sight(pose, ball, head, off, image));
        self.without_ball = if ball.is_some() { 0 } else { self.without_ball.saturating_add(1) };
        let mut landmarks = heapless::Vec::new();
        for (index, landmark) in LANDMARKS.into_iter().enumerate() {
            let size = if index < MARKERS { self.noise.marker } else { self.noise.goal };
            let image = Image { size, within: self.noise.landmark_within };
            if let Some(sight) = self.sight(pose, landmark, head, off, image) {
                // A frame has room for more than the camera's angle holds.
                let _room = landmarks.push(LandmarkSight { landmark: index as u8, sight });
            }
        }
        CameraFrame { landmarks, ball }
    }

    /// Direction of the head, to the left of the body's.
    fn head(&self, ball: Option<Angle>) -> Angle {
        let time = self.frames as f32 * self.dt;
        let pan = Angle::degrees(self.noise.pan_deg).radians();
        let every = self.noise.glance_every.max(self.dt);
        let count = math::floor(time / every);
        let into = time - count * every;
        let glances = into >= every - self.noise.glance_for;
        let lost = self.without_ball as f32 * self.dt > self.noise.lost_after;
        match ball {
            Some(ball) if !glances && !lost => Angle::new(ball.radians().clamp(-pan, pan)),
            None if !glances => Angle::ZERO,
            _ => {
                // From one side to the other in a glance's time, and back in the next.
                let sweep = time / self.noise.glance_for.max(self.dt);
                let whole = math::floor(sweep);
                let share = sweep - whole;
                let back = (whole as u32).is_multiple_of(2);
                Angle::new(pan * if back { 1.0 - 2.0 * share } else { 2.0 * share - 1.0 })
            }
        }
    }

    /// A detection of `object`, unless it is out of view or missed.
    fn sight(
        &mut self,
        pose: Pose<Field>,
        object: Point<Field>,
        head: Angle,
        off: Angle,
        image: Image,
    ) -> Option<Sight> {
        let (range, bearing) = (pose.position.distance(object), pose.turn_to(object));
        let near = range / image.within.max(f32::MIN_POSITIVE);
        let missed = 1.0 - (1.0 - self.noise.miss) * (1.0 - near * near);
        let half = 0.5 * Angle::degrees(self.noise.field_of_view_deg).radians().abs();
        if near >= 1.0 || (bearing - head).abs() > half || self.chance.chance(missed) {
            return None;
        }
        let pixel = Angle::degrees(self.noise.pixel_deg).radians();
        let sigma = self.noise.range_floor + range * range * pixel / image.size;
        let (ranged, aimed) = self.chance.normals();
        Some(Sight::new((range + sigma * ranged).max(0.0), bearing + off + Angle::new(pixel * aimed)))
    }
}

/// Landmarks before this index are markers, the others goals.
const MARKERS: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;

    fn camera(seed: u64) -> Camera {
        Camera::new(Parameters::four_legged().noise, 0.04, Stream::new(seed, "camera"))
    }

    fn spread(values: &[f32]) -> (f32, f32) {
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / values.len() as f32;
        (mean, math::sqrt(variance))
    }

    /// Sights of a ball at `distance`, straight ahead.
    fn sights(distance: f32, walks: bool) -> (usize, Vec<Sight>) {
        let (mut camera, frames) = (camera(7), 40_000);
        let ball = Point::new(distance, 0.0);
        let seen = (0..frames).filter_map(|_| camera.frame(Pose::default(), Some(ball), walks).ball);
        (frames, seen.collect())
    }

    #[test]
    fn errors_of_a_range_grow_with_the_square_of_the_distance() {
        for distance in [0.5_f32, 1.0, 2.0] {
            let (_, seen) = sights(distance, true);
            let ranges: Vec<f32> = seen.iter().map(|sight| sight.range()).collect();
            let (mean, sigma) = spread(&ranges);
            // 0.01 m + r² · 0.274° / 85 mm.
            let expected = 0.01 + distance * distance * 0.274_f32.to_radians() / 0.085;
            assert!((sigma / expected - 1.0).abs() < 0.05, "{distance}: {sigma} m, not {expected}");
            assert!((mean - distance).abs() < 0.01, "{distance}: {mean}");
        }
    }

    #[test]
    fn bearing_errors_grow_while_walking_and_correlate_between_frames() {
        for (walks, degrees) in [(false, 0.5_f32), (true, 2.5)] {
            let (_, seen) = sights(1.0, walks);
            let bearings: Vec<f32> = seen.iter().map(|sight| sight.bearing().radians()).collect();
            let (_, sigma) = spread(&bearings);
            let expected = math::hypot(degrees.to_radians(), 0.274_f32.to_radians());
            assert!((sigma / expected - 1.0).abs() < 0.1, "{walks}: {sigma} rad, not {expected}");
        }
        let (_, seen) = sights(1.0, true);
        let bearings: Vec<f32> = seen.iter().map(|sight| sight.bearing().radians()).collect();
        let products: f32 = bearings.windows(2).map(|pair| pair[0] * pair[1]).sum();
        let squares: f32 = bearings.iter().map(|b| b * b).sum();
        // exp(−0.04 / 0.3) = 0.875 of the sway, less for frames in between that were missed.
        assert!((0.75..0.9).contains(&(products / squares)), "{}", products / squares);
    }

    #[test]
    fn the_ball_is_missed_more_often_farther_away_and_never_seen_behind() {
        let share = |distance| {
            let (frames, seen) = sights(distance, false);
            seen.len() as f32 / frames as f32
        };
        let shares = [0.5, 1.5, 2.5, 3.4].map(share);
        // Glances for landmarks take a quarter of the time; a part of a glance passes the ball.
        assert!((0.65..0.85).contains(&shares[0]), "{shares:?}");
        assert!(shares.windows(2).all(|pair| pair[1] < pair[0] - 0.05), "{shares:?}");
        let (_, behind) = sights(-0.5, false);
        assert!(behind.is_empty());
        let (_, far) = sights(3.6, false);
        assert!(far.is_empty());
    }

    #[test]
    fn glances_see_every_landmark_from_all_over_the_field() {
        let mut seen = [0_u32; 6];
        for (seed, (x, y, heading)) in
            [(0.0, 0.0, 0.0), (1500.0, 800.0, 30.0), (-1500.0, -500.0, 120.0), (500.0, -1500.0, -90.0)]
                .into_iter()
                .enumerate()
        {
            let pose = Pose::from_mm_deg(x, y, heading);
            let (mut camera, mut here) = (camera(seed as u64), 0);
            let ball = pose.to_field(Point::new(0.8, 0.2));
            for _ in 0..500 {
                for landmark in camera.frame(pose, Some(ball), true).landmarks {
                    (seen[usize::from(landmark.landmark)], here) =
                        (seen[usize::from(landmark.landmark)] + 1, here + 1);
                }
            }
            // Two a second in 20 s.
            assert!(here > 40, "{pose:?}: {here}");
        }
        assert!(seen.iter().all(|&count| count > 0), "{seen:?}");
    }
}
