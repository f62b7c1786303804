//! `ball`: ball tracking: chooses the ball among detections, and estimates its kicker, its flight, and its
//! place when no camera sees it. m, m/s; times on vision's clock, µs.
//!
//! Every blob that stays becomes a track. One of them is the ball, and stays the ball while it is seen: a
//! second ball, a hand or a shoe never replaces a visible ball, and one that robots cover only where ours can
//! have come out. A ball that vanishes at a robot's front counts as held there.

mod choice;
mod flight;
mod gone;
mod hidden;
mod kick;
mod track;

use geometry::{Field, Point};
pub(crate) use hidden::HiddenBall;
use protocol::Instant;

use self::gone::{Gone, OtherPlaces};
use self::kick::{Air, Kicked};
use self::track::{Glimpse, Track};
use super::filter::Plane;
use super::robots::{Moved, Robots, micros};
use super::scene::Scene;
use super::seen::{BallSeen, Captured, Frame};
use crate::world::{Ball, Kick};

/// Tracks at once: more balls do not occur in a game.
const TRACKS_MAX: usize = 6;
/// Time after which it counts as unseen, s: two to three frames of 60 Hz.
const UNSEEN_AFTER_S: f32 = 0.045;
/// Uncertainty of a hidden ball: within a ball's radius of where it was, m; released slowly, m/s.
const HELD_SIGMA_M: f32 = 0.02;
const HELD_SIGMA_M_S: f32 = 0.5;

/// Counts of blobs by result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct BallCounts {
    /// Detections of the ball.
    pub taken: u64,
    /// Detections of balls while none was confirmed yet.
    pub new: u64,
    /// Detections of other balls, hands, shoes.
    pub others: u64,
    /// Kicks detected, flat ones and chips.
    pub kicks: u64,
    /// Number of kicks that were chips.
    pub chips: u64,
    /// Turns without a kick: off robots, posts and walls.
    pub bounces: u64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Balls {
    tracks: [Option<Track>; TRACKS_MAX],
    /// Index of the ball among them.
    chosen: Option<usize>,
    /// Time of the first choice.
    first: Option<Captured>,
    air: Air,
    kicked: Option<Kicked>,
    contact: Option<kick::Contact>,
    /// Since when and where the ball is not seen.
    gone: Option<Gone>,
    others: OtherPlaces,
    pub(super) counts: BallCounts,
}

/// Inputs of the ball's tracking besides the camera frame.
#[derive(Clone, Copy)]
pub(super) struct Around<'a> {
    pub(super) robots: &'a Robots,
    pub(super) scene: &'a Scene,
    /// Standard deviation of a blob's coordinate, m.
    pub(super) sigma: f32,
}

impl Balls {
    /// Takes a camera frame's blobs.
    pub(super) fn see(&mut self, frame: &Frame, around: Around<'_>) {
        self.forget(frame.at);
        self.hold(frame.at, around.robots);
        let ball = self.nearest_to_chosen(frame, around);
        if let Some(index) = ball {
            self.see_ball(frame, &frame.balls[index], around);
        }
        for (_, seen) in frame.balls.iter().enumerate().filter(|(index, _)| Some(*index) != ball) {
            self.see_other(frame, seen, around);
        }
        self.mark_others(frame, around.scene);
        self.note_absence(frame.at, around);
        self.choose(frame.at, around);
    }

    fn see_ball(&mut self, frame: &Frame, seen: &BallSeen, around: Around<'_>) {
        self.counts.taken += 1;
        let models = &around.scene.models;
        self.land(frame.at, models);
        let glimpse = self.glimpse(frame, seen, around.scene);
        let Some(track) = self.chosen.and_then(|index| self.tracks[index].as_mut()) else { return };
        track.note(frame, seen);
        track.note_inside(around.scene.is_inside(seen.position));
        if matches!(self.air, Air::Flying(..)) {
            track.agreed = track.seen;
            self.see_flying(&glimpse, around);
            return;
        }
        let turn = track.see(&glimpse, models, around.sigma);
        if let Some(turn) = turn {
            self.turned(&turn, around);
        } else {
            self.watch(&glimpse, around);
        }
        self.touch(frame.at, around);
        self.refine(models);
    }

    /// A detection from a blob, put below the ball if the ball is known to fly.
    fn glimpse(&self, frame: &Frame, seen: &BallSeen, scene: &Scene) -> Glimpse {
        let height = self.height(frame.at, &scene.models).0;
        let camera = scene.camera(frame.camera).filter(|_| height > 0.0);
        let position = camera.map_or(seen.position, |camera| {
            seen.position + (camera.above - seen.position) * (height / camera.height)
        });
        Glimpse { position, apparent: seen.position, camera: frame.camera, at: frame.at }
    }

    /// A ball that vanished at a robot's front moves with the robot.
    fn hold(&mut self, now: Captured, robots: &Robots) {
        let Some((place, robot)) = self.held(now, robots) else { return };
        if let Some(track) = self.chosen.and_then(|index| self.tracks[index].as_mut()) {
            let plane = Plane::sent_off(place, robot.velocity, HELD_SIGMA_M, HELD_SIGMA_M_S);
            track.put(now.max(track.at), plane);
        }
    }

    fn held(&self, now: Captured, robots: &Robots) -> Option<(Point<Field>, Moved)> {
        let (track, contact) = (self.chosen_track()?, self.contact?);
        let unseen =
            now - track.seen > micros(UNSEEN_AFTER_S) && track.seen - contact.until <= micros(UNSEEN_AFTER_S);
        let robot = robots.robot(contact.who, now).filter(|_| unseen)?;
        Some((robot.pose.to_field(contact.place), robot))
    }

    fn chosen_track(&self) -> Option<&Track> {
        self.chosen.and_then(|index| self.tracks[index].as_ref())
    }

    /// The ball at that moment; `ours` converts moments to our clock.
    pub(super) fn snapshot(
        &self,
        at: Captured,
        around: Around<'_>,
        ours: impl Fn(Captured) -> Instant,
    ) -> Option<Ball> {
        let track = self.chosen_track()?;
        let models = &around.scene.models;
        let (position, velocity) = match (self.held(at, around.robots), &self.air) {
            (Some((place, robot)), _) => (place, robot.velocity),
            (None, Air::Flying(_, flight)) => (flight.position(at), flight.velocity),
            (None, _) => track.moved(at, models),
        };
        let (height, climb) = self.height(at, models);
        let kicked = self.kicked.map(|kicked| Kick {
            by: kicked.by,
            from: kicked.from,
            velocity: kicked.velocity,
            climb: kicked.climb,
            at: ours(kicked.at),
        });
        Some(Ball {
            position,
            height,
            velocity,
            climb,
            rolls_below: track.rolls_below,
            bounced: matches!(self.air, Air::Hopping(_)),
            confidence: track.confidence(at, self.patience()),
            seen: ours(track.seen),
            kicked,
        })
    }
}
