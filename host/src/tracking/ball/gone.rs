//! `gone`: rules for a ball that no camera sees, and for other balls. The ball may be covered by a robot for
//! seconds; a blob elsewhere is the ball only where ours can have got there since. m; times on vision's
//! clock, µs.
//!
//! A blob that was seen beside the ball is another ball, and stays another one: a spare ball at the touch
//! line, a shoe. It replaces ours once ours has been gone for longer than robots cover balls.

use geometry::{Field, Point};
use protocol::Who;

use super::track::Track;
use super::{Around, Balls, UNSEEN_AFTER_S};
use crate::tracking::robots::{micros, seconds};
use crate::tracking::scene::Scene;
use crate::tracking::seen::{Captured, Frame};

/// A robot whose centre is this near may cover the ball: its hull, and the shadow of a robot 0.15 m high
/// below a camera that sees it at 60°.
const COVERS_WITHIN_M: f32 = 0.35;
/// Longest time for which a robot covers a ball, s: a placement across the field.
const COVERED_MAX_S: f32 = 20.0;
/// A ball that vanished in the open has been taken away after this time, s: nothing covers it.
const TAKEN_AWAY_AFTER_S: f32 = 1.0;
/// A covered ball appears at most this far from the robot that covers it, m: 0.1 s of a kick.
const RELEASED_WITHIN_M: f32 = 0.6;
/// It may have been passed on to any robot this near, m.
const PASSED_ON_WITHIN_M: f32 = 0.4;
/// Fastest ball that reappears by itself, m/s, and its distance in no time, m.
const REAPPEARS_M_S: f32 = 10.0;
const REAPPEARS_WITHIN_M: f32 = 0.3;
/// Speed of a ball that travelled unseen, m/s.
const UNSEEN_SPEED_M_S: f32 = 6.5;
/// A blob that first shows on the field within this time after ours vanished was put there, s.
const AT_ONCE_S: f32 = 0.1;
/// A ball that vanished in the open, and was put elsewhere at once, comes back within this time if it was
/// not put there, s: cameras miss a fast one for some frames.
const PUT_DOUBTED_FOR_S: f32 = 0.3;
/// A ball that a robot covers is not elsewhere on the field before this time, s, and not beside it before
/// that.
const COVERED_MIN_S: f32 = 0.3;
const COVERED_BESIDE_MIN_S: f32 = 5.0;
/// Camera frames of a blob that shows beside the ball.
const FRAMES_BESIDE: u16 = 5;
/// Two blobs of one camera frame at least this far apart are two balls, m.
const BESIDE_MIN_M: f32 = 0.3;
/// Two blobs that were seen for this time by any cameras are two balls too, s: longer than a chip that
/// cameras see at different places.
const BESIDE_FOR_S: f32 = 1.0;
/// A blob that rests this far from ours, m, is another ball after this time, s: no chip stands still for a
/// camera, and clocks of cameras differ by less.
const FAR_BESIDE_MIN_M: f32 = 1.0;
const REST_BESIDE_FOR_S: f32 = 0.2;
/// A blob this near the place of another ball is that ball, m.
const SAME_PLACE_M: f32 = 0.15;
/// The place of another ball that is not seen is remembered for this time, s: a robot or a person stands in
/// front of it.
const PLACE_KEPT_S: f32 = 30.0;
/// Places remembered.
const PLACES_MAX: usize = 4;

/// The ball as it was when it was last seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gone {
    seen: Captured,
    pub(super) place: Point<Field>,
    cover: Option<Who>,
    /// Until when ours may come back, though another blob was made the ball meanwhile.
    replaced_until: Option<Captured>,
}

/// Places of other balls, each with the time of its last detection.
pub(super) type OtherPlaces = [Option<(Point<Field>, Captured)>; PLACES_MAX];

impl Balls {
    /// Records since when and where the ball is not seen, and which robot covers it.
    pub(super) fn note_absence(&mut self, now: Captured, around: Around<'_>) {
        self.gone =
            self.gone.filter(|gone| now <= gone.replaced_until.unwrap_or(gone.seen + micros(COVERED_MAX_S)));
        if self.is_doubtful() {
            return;
        }
        let Some(track) = self.chosen_track() else { return };
        if now - track.agreed <= micros(UNSEEN_AFTER_S) {
            self.gone = None;
            return;
        }
        let place = track.moved(now, &around.scene.models).0;
        let nearest = around.robots.nearest(place, now).filter(|(_, _, off)| *off <= COVERS_WITHIN_M);
        let cover = self.gone.and_then(|gone| gone.cover);
        self.gone = Some(Gone {
            seen: track.agreed,
            place: track.seen_at,
            cover: cover.or(nearest.map(|(who, _, _)| who)),
            replaced_until: None,
        });
    }

    /// Whether a blob can be the ball that is not seen.
    pub(super) fn may_be_ours(&self, track: &Track, now: Captured, around: Around<'_>) -> bool {
        let Some(gone) = self.gone else { return true };
        let unseen = seconds(now - gone.seen);
        let playable = around.scene.is_playable(track.plane.position);
        if track.other {
            return gone.cover.is_none() && playable && unseen >= TAKEN_AWAY_AFTER_S;
        }
        if Self::returned(&gone, track, now, around) {
            return true;
        }
        // One blob goes and another comes at once: the ball was put there.
        let between = track.began - gone.seen;
        if playable
            && track.inside_at.is_some()
            && (-micros(REST_BESIDE_FOR_S)..=micros(AT_ONCE_S)).contains(&between)
        {
            return true;
        }
        let covered = match gone.cover {
            None => 0.0,
            Some(_) if track.inside_at.is_some() => COVERED_MIN_S,
            Some(_) if playable => COVERED_BESIDE_MIN_S,
            Some(_) => return false,
        };
        (unseen - covered) * UNSEEN_SPEED_M_S >= gone.place.distance(track.plane.position)
    }

    /// Whether a blob first showed where the ball comes out: at the robot that covers it, or where it
    /// vanished.
    fn returned(gone: &Gone, track: &Track, now: Captured, around: Around<'_>) -> bool {
        let off = gone.place.distance(track.origin);
        let Some(cover) = gone.cover else {
            let unseen = seconds(track.began - gone.seen).max(0.0);
            return off <= REAPPEARS_WITHIN_M + REAPPEARS_M_S * unseen;
        };
        let at_cover = around
            .robots
            .robot(cover, now)
            .is_some_and(|robot| robot.pose.position.distance(track.origin) <= RELEASED_WITHIN_M);
        let passed_on = around.robots.nearest(track.origin, now);
        at_cover || off <= RELEASED_WITHIN_M || passed_on.is_some_and(|(_, _, off)| off <= PASSED_ON_WITHIN_M)
    }

    /// Whether this blob is the ball that another one has replaced meanwhile.
    pub(super) fn is_back(&self, track: &Track, now: Captured, around: Around<'_>) -> bool {
        let replaced = self.gone.filter(|gone| track.began >= gone.seen && !track.other);
        replaced.is_some_and(|gone| Self::returned(&gone, track, now, around))
    }

    /// Whether a blob that is not the ball for certain is the ball now.
    pub(super) fn is_doubtful(&self) -> bool {
        self.gone.is_some_and(|gone| gone.replaced_until.is_some())
    }

    /// Notes that a blob becomes the ball: for good where ours came out there.
    pub(super) fn note_replacement(&mut self, track: &Track, now: Captured, around: Around<'_>) {
        let is_doubtful = self.is_doubtful();
        self.gone = self
            .gone
            .filter(|gone| !is_doubtful && (track.other || !Self::returned(gone, track, now, around)));
        if let Some(gone) = &mut self.gone {
            let was_put_there = gone.cover.is_none() && !track.other;
            let doubted_us = micros(if was_put_there { PUT_DOUBTED_FOR_S } else { COVERED_MAX_S });
            gone.replaced_until = Some(gone.seen + doubted_us);
        }
    }

    /// Marks blobs that are seen beside the ball as other balls, but for one that is put into the field while
    /// the ball is out.
    pub(super) fn mark_others(&mut self, frame: &Frame, scene: &Scene) {
        let Some(ball) = self.chosen_track().copied() else { return };
        let now = frame.at;
        let is_certain = !self.is_doubtful() && !self.is_first_choice(now);
        if !is_certain || now - ball.agreed > micros(UNSEEN_AFTER_S) {
            return;
        }
        let is_out = !scene.is_inside(ball.plane.position);
        let in_frame = |track: &Track| track.seen == now && track.camera == frame.camera;
        let chosen = self.chosen;
        for (index, place) in self.tracks.iter_mut().enumerate() {
            let Some(track) = place.as_mut().filter(|_| chosen != Some(index)) else { continue };
            if is_out && scene.is_inside(track.plane.position) {
                continue;
            }
            let apart = track.plane.position.distance(ball.plane.position);
            let rests = apart >= FAR_BESIDE_MIN_M && track.rests();
            let beside_for_us = micros(if rests { REST_BESIDE_FOR_S } else { BESIDE_FOR_S });
            let together = (in_frame(track) && in_frame(&ball))
                || (track.seen == now && ball.agreed - track.began >= beside_for_us);
            track.other |= together && track.images >= FRAMES_BESIDE && apart >= BESIDE_MIN_M;
        }
    }

    /// Remembers the place of another ball whose track ends.
    pub(super) fn remember_other(&mut self, track: &Track) {
        let entry = self.others.iter_mut().min_by_key(|place| place.map_or(Captured::MIN, |(_, at)| at));
        if let Some(entry) = entry.filter(|_| track.other) {
            *entry = Some((track.plane.position, track.seen));
        }
    }

    /// Whether another ball lies at that place, visible or not.
    pub(super) fn is_other(&self, position: Point<Field>, now: Captured) -> bool {
        let tracked = self.tracks.iter().enumerate().filter(|(index, _)| self.chosen != Some(*index));
        let mut tracked = tracked.filter_map(|(_, track)| track.as_ref()).filter(|track| track.other);
        tracked.any(|track| track.plane.position.distance(position) <= SAME_PLACE_M)
            || self.others.iter().flatten().any(|(place, at)| {
                now - at <= micros(PLACE_KEPT_S) && place.distance(position) <= SAME_PLACE_M
            })
    }
}
