//! `camera`: belief of a walking robot from its camera and legs (docs/belief.md). Pose by [`PoseFilter`],
//! ball by [`BallFilter`], opponents by [`Tracks`]. SI units, field frame.

use geometry::{Body, Field, Point, Twist, Vector, math};
use protocol::robot_io::{CameraFrame, SensorFrame, Sight};
use protocol::{Duration, Instant};

use super::ball::BallFilter;
use super::opponents::Tracks;
use super::pose::PoseFilter;
use super::{Belief, BelievedBall, model};

/// Estimators of a walking robot with a camera.
#[derive(Clone, Debug, Default)]
pub struct Perception {
    /// Own pose.
    pub pose: PoseFilter,
    /// The ball, if it is known.
    pub ball: Option<BallFilter>,
    /// The opponents.
    pub opponents: Tracks,
    /// Last sight of the ball.
    seen: Option<Instant>,
    /// Last frame.
    at: Option<Instant>,
    /// Whether it held the ball in the last frame.
    held: bool,
}

impl Perception {
    /// Takes in the sensor frame of `now`; `deceleration` of the ball, m/s².
    pub fn update(&mut self, now: Instant, sensors: &SensorFrame, camera: &CameraFrame, deceleration: f32) {
        let dt = self.at.replace(now).map_or(0.0, |before| now.since(before).as_secs_f32()).min(LONGEST);
        let finite = sensors.odometry.linear.is_finite() && sensors.odometry.angular.is_finite();
        let odometry = if finite { sensors.odometry } else { Twist::default() };
        self.pose.predict(odometry, dt);
        if let Some(placed) = sensors.pose.filter(|pose| pose.position.is_finite()) {
            self.pose = PoseFilter::at(placed, model::PLACING, model::PLACING_HEADING);
        }
        for seen in &camera.landmarks {
            self.pose.see(*seen);
        }
        if let Some(ball) = &mut self.ball {
            ball.predict(odometry, dt);
        }
        self.see_ball(now, sensors.ball_contact, camera.ball, deceleration);
        self.opponents.update(&sensors.opponents, dt);
    }

    /// Takes in places of opponents alone.
    pub fn follow(&mut self, now: Instant, opponents: &[Point<Field>]) {
        let dt = self.at.replace(now).map_or(0.0, |before| now.since(before).as_secs_f32()).min(LONGEST);
        self.opponents.update(opponents, dt);
    }

    fn see_ball(&mut self, now: Instant, holds: bool, sight: Option<Sight>, deceleration: f32) {
        if holds {
            (self.ball, self.seen) = (Some(BallFilter::held(deceleration)), Some(now));
        } else {
            if self.held
                && let Some(ball) = &mut self.ball
            {
                ball.released();
            }
            if let Some(sight) = sight {
                let (off, off_variance) = self.pose.bearing_error();
                let range = sight.range();
                let at = Vector::<Body>::polar(range, sight.bearing() - geometry::Angle::new(off));
                let at = Point::new(at.x(), at.y());
                // The mean of both axes: along the sight and across it.
                let across = range * range * 0.5;
                let variance = 0.5 * model::range_variance(range, model::BALL_SIZE)
                    + across * (model::PIXEL * model::PIXEL + off_variance);
                let ball = self.ball.get_or_insert_with(|| BallFilter::seen(at, variance, deceleration));
                ball.see(at, variance, LASTING * across * off_variance);
                self.seen = Some(now);
            }
        }
        self.held = holds;
        if self.seen.is_some_and(|seen| now.since(seen) > LEASE) {
            self.ball = None;
        }
    }

    /// Standard deviation of the ball's place on the field, a coordinate, m.
    pub fn ball_sigma(&self) -> Option<f32> {
        let ball = self.ball.as_ref()?;
        let at = ball.place();
        let range = at.x() * at.x() + at.y() * at.y();
        let pose = self.pose.place_variance() + 0.5 * range * self.pose.heading_variance();
        Some(math::sqrt(ball.variance() + pose))
    }

    /// Time since the ball was seen.
    pub fn ball_age(&self, now: Instant) -> Duration {
        self.seen.map_or(LEASE, |seen| now.since(seen))
    }
}

impl Belief {
    /// Takes in a frame with camera: pose, ball and opponents of the estimators.
    pub(super) fn perceive(
        &mut self,
        now: Instant,
        sensors: &SensorFrame,
        camera: &CameraFrame,
    ) -> Option<BelievedBall> {
        let league = self.league;
        self.perception.update(now, sensors, camera, league.ball().rolling_deceleration);
        self.pose = self.perception.pose.pose();
        self.opponents.clear();
        for track in self.perception.opponents.iter() {
            // Fewer tracks than opponents have room.
            let _room = self.opponents.push(track.place);
        }
        self.ball_sigma = self.perception.ball_sigma().unwrap_or(0.0);
        let ball = self.perception.ball?;
        Some(self.cut_at_opponents(super::rolling(
            self.pose.to_field(ball.place()),
            self.pose.vector_to_field(ball.velocity()),
            league,
        )))
    }
}

/// Longest step of a prediction, s: a frame that late is as good as a new start.
const LONGEST: f32 = 1.0;
/// A ball that was not seen for longer is unknown, s: a glance for landmarks and a sweep for it.
const LEASE: Duration = Duration::millis(3000);
/// How many times worse sights with the sway's correlation are for a mean: (1 + ρ) / (1 − ρ), ρ = exp(−0.04 /
/// 0.3).
const LASTING: f32 = 15.0;
