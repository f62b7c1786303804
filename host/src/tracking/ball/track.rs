//! `track`: filter of one ball on the ground, with a model of its deceleration; it detects changes by robots
//! and walls. m, m/s, s; times on vision's clock, µs.
//!
//! A detection far from the prediction is held back: the next one shows whether it was a misreading or the
//! start of a new direction. So a kick is known by the second camera frame that contains it, and one wrong
//! blob changes nothing.

use geometry::{Field, Point, Vector};
use motion::trajectory::Motion;

use super::super::filter::{Freedom, Plane};
use super::super::robots::seconds;
use super::super::scene::Scene;
use super::super::seen::{BallSeen, Captured, Frame};
use crate::world::BallModels;

/// White acceleration of a rolling ball, m²/s³: `steady` is a field surface that decelerates it 0.3 m/s² more
/// or less than configured; `changing` is a robot that pushes or dribbles it with 5 m/s² for 0.2 s.
const FREEDOM: Freedom = Freedom { steady: 0.02, changing: 8.0 };
/// A detection is an outlier when its distance squared is more variances than this ...
const OUTLIER_VARIANCES_MIN: f32 = 20.0;
/// An outlier is farther than this off, m: noise between cameras is no turn.
const OUTLIER_DISTANCE_MIN_M: f32 = 0.012;
/// Standard deviation of a new ball's speed, m/s.
const SPEED_SIGMA_M_S: f32 = 2.0;
/// Uncertainty of a turned ball's speed besides the noise of two detections, m/s.
const TURN_SIGMA_M_S: f32 = 0.3;
/// Fastest ball, m/s: robots are allowed 6.5, kickers without a limit give 10 or so.
const SPEED_MAX_M_S: f32 = 15.0;
/// Largest distance of a detection from its prediction, m, and its growth for every second unseen (m/s), up
/// to a time (s).
const GATE_M: f32 = 0.1;
const GATE_GROWTH_M_S: f32 = 10.0;
const GATE_TIME_MAX_S: f32 = 0.15;
/// Detections nearer to each other are of one tick, µs.
const TICK_US: Captured = 5_000;
/// A ball that has moved less than this rests, m: the noise of cameras that disagree.
const RESTS_WITHIN_M: f32 = 0.05;
/// Camera frames after which confidence is full.
const FRAMES_FULL: u16 = 8;
/// Weight of the newest detection in the quality.
const QUALITY_SHARE: f32 = 0.1;

/// A blob and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Glimpse {
    /// On the ground; for a ball in the air, below it.
    pub(super) position: Point<Field>,
    /// Place at which the camera saw it on the field surface.
    pub(super) apparent: Point<Field>,
    pub(super) camera: u32,
    pub(super) at: Captured,
}

/// A change of velocity that the field surface cannot cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    pub(super) at: Captured,
    pub(super) from: Point<Field>,
    pub(super) before: Vector<Field>,
    pub(super) after: Vector<Field>,
    /// The two detections that revealed it.
    pub(super) sightings: [Glimpse; 2],
    /// Distance between the old path and the new one, m; large where the ball was placed elsewhere.
    pub(super) gap: f32,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    pub(super) plane: Plane,
    pub(super) at: Captured,
    pub(super) seen: Captured,
    /// Time of the last detection that was no outlier.
    pub(super) agreed: Captured,
    counted: Captured,
    pub(super) images: u16,
    quality: f32,
    /// Speed above which the ball slides, m/s.
    pub(super) rolls_below: f32,
    strange: Option<Glimpse>,
    /// Time and place of the first detection.
    pub(super) began: Captured,
    pub(super) origin: Point<Field>,
    /// Place of the last detection, and its camera.
    pub(super) seen_at: Point<Field>,
    pub(super) camera: u32,
    /// Another ball than ours: it was seen beside ours.
    pub(super) other: bool,
    /// Its last detection inside the field's lines.
    pub(super) inside_at: Option<Captured>,
}

impl Track {
    pub(super) fn new(glimpse: &Glimpse, seen: &BallSeen, sigma: f32) -> Self {
        Self {
            plane: Plane::new(glimpse.position, sigma, SPEED_SIGMA_M_S),
            at: glimpse.at,
            seen: glimpse.at,
            agreed: glimpse.at,
            counted: glimpse.at,
            images: 1,
            quality: seen.confidence,
            rolls_below: f32::INFINITY,
            strange: None,
            began: glimpse.at,
            origin: glimpse.position,
            seen_at: glimpse.position,
            camera: glimpse.camera,
            other: false,
            inside_at: None,
        }
    }

    /// Place and velocity of the ball at `at` if no robot touches it.
    pub(super) fn moved(&self, at: Captured, models: &BallModels) -> (Point<Field>, Vector<Field>) {
        let dt = seconds(at - self.at);
        if dt <= 0.0 {
            return (self.plane.position + self.plane.velocity * dt, self.plane.velocity);
        }
        let path = models.ground.moving(self.plane.position, self.plane.velocity, self.rolls_below);
        let state = path.at(dt);
        (state.position, state.velocity)
    }

    /// Distance of a detection from the prediction, and whether it can be this ball.
    pub(super) fn fits(&self, position: Point<Field>, at: Captured, models: &BallModels) -> Option<f32> {
        let off = self.moved(at, models).0.distance(position);
        let reach = GATE_M + GATE_GROWTH_M_S * seconds(at - self.seen).clamp(0.0, GATE_TIME_MAX_S);
        // A change that has started may continue there.
        let begun = self.strange.is_some_and(|strange| {
            let reach = GATE_M + GATE_GROWTH_M_S * seconds(at - strange.at).clamp(0.0, GATE_TIME_MAX_S);
            strange.position.distance(position) <= reach
        });
        (off <= reach || begun).then_some(off)
    }

    /// Sets it to a state known from elsewhere.
    pub(super) fn put(&mut self, at: Captured, plane: Plane) {
        (self.at, self.plane, self.strange) = (at, plane, None);
    }

    pub(super) fn note(&mut self, frame: &Frame, seen: &BallSeen) {
        let at = frame.at;
        self.seen = self.seen.max(at);
        (self.seen_at, self.camera) = (seen.position, frame.camera);
        if at - self.counted >= TICK_US {
            self.counted = at;
            self.images = self.images.saturating_add(1);
        }
        self.quality += (seen.confidence - self.quality) * QUALITY_SHARE;
    }

    /// Order in which blobs become the ball, the least first: other balls last, those behind the walls before
    /// them, far from `last` after near.
    pub(super) fn rank(&self, last: Point<Field>, scene: &Scene) -> (bool, bool, f32) {
        let place = self.plane.position;
        (self.other, !scene.is_playable(place), last.distance(place))
    }

    /// Whether it lies where it was first seen.
    pub(super) fn rests(&self) -> bool {
        self.origin.distance(self.plane.position) <= RESTS_WITHIN_M
    }

    /// Records whether its last detection was inside the field's lines.
    pub(super) fn note_inside(&mut self, is_inside: bool) {
        self.inside_at = if is_inside { Some(self.seen) } else { self.inside_at };
    }

    /// Takes a detection; returns a turn if it is the second that reveals one.
    pub(super) fn see(&mut self, glimpse: &Glimpse, models: &BallModels, sigma: f32) -> Option<Turn> {
        let dt = seconds(glimpse.at - self.at).max(0.0);
        let (position, velocity) = self.moved(self.at.max(glimpse.at), models);
        let mut plane = self.plane;
        plane.pass_as(dt, position, velocity, FREEDOM);
        let (off, surprise) = plane.surprise(glimpse.position, sigma);
        if surprise <= OUTLIER_VARIANCES_MIN
            || off.dot(off) <= OUTLIER_DISTANCE_MIN_M * OUTLIER_DISTANCE_MIN_M
        {
            plane.see(glimpse.position, sigma);
            (self.plane, self.at, self.strange) = (plane, self.at.max(glimpse.at), None);
            self.agreed = self.agreed.max(glimpse.at);
            return None;
        }
        let Some(first) = self.strange else {
            self.strange = Some(*glimpse);
            return None;
        };
        let between = glimpse.at - first.at;
        if between < TICK_US {
            return None;
        }
        let after = (glimpse.position - first.position) * (1.0 / seconds(between));
        if after.dot(after) > SPEED_MAX_M_S * SPEED_MAX_M_S {
            self.strange = Some(*glimpse);
            return None;
        }
        let turn = self.turn(&first, glimpse, after);
        let speed_sigma = TURN_SIGMA_M_S + 2.0 * sigma / seconds(between);
        self.put(glimpse.at, Plane::sent_off(glimpse.position, after, sigma, speed_sigma));
        self.agreed = self.agreed.max(glimpse.at);
        Some(turn)
    }

    /// Place and time at which the old path and the new one cross.
    fn turn(&self, first: &Glimpse, second: &Glimpse, after: Vector<Field>) -> Turn {
        let (start, before) = (self.plane.position, self.plane.velocity);
        let span = seconds(first.at - self.at).max(0.0);
        let begin = first.position - after * span;
        let (apart, relative) = (begin - start, after - before);
        let squared = relative.dot(relative);
        let met = if squared > 0.0 { (-apart.dot(relative) / squared).clamp(0.0, span) } else { span };
        let from = start + before * met;
        let gap = from.distance(begin + after * met);
        let at = self.at + (met * 1e6) as Captured;
        Turn { at, from, before, after, sightings: [*first, *second], gap }
    }

    pub(super) fn confidence(&self, at: Captured, patience: f32) -> f32 {
        let freshness = 1.0 - seconds(at - self.seen) / patience;
        let often = f32::from(self.images.min(FRAMES_FULL)) * (1.0 / FRAMES_FULL as f32);
        (freshness * often * self.quality).clamp(0.0, 1.0)
    }
}
