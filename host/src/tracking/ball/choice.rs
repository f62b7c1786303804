//! `choice`: choice of the ball among detections. The one that continues the ball's track while it is
//! visible; else one that was detected steadily, inside the field before outside, near before far. m; times
//! on vision's clock, µs.

use super::kick::Air;
use super::track::{Glimpse, Track};
use super::{Around, Balls, UNSEEN_AFTER_S};
use crate::tracking::robots::micros;
use crate::tracking::seen::{BallSeen, Captured, Frame};

/// Camera frames that make a blob the ball when there is none.
const FRAMES_TO_BELIEVE: u16 = 2;
/// Camera frames that make a blob the ball when there is one that is not visible.
const FRAMES_TO_TAKE_OVER: u16 = 5;
/// Time without detection after which another ball may be chosen, s: six frames of 60 Hz.
const REPLACED_AFTER_S: f32 = 0.1;
/// The first choice among several balls lasts for this time, s: cameras send their first frames one after the
/// other.
const FIRST_CHOICE_LASTS_S: f32 = 0.3;
/// A ball that has been out of the field for this time, s, is replaced by one that rests inside for so many
/// camera frames: people play on with another.
const OUT_AFTER_S: f32 = 0.5;
const FRAMES_PUT_BACK: u16 = 30;
/// An unseen ball is forgotten after this time, s; at a robot's front, where robots hide balls, this time is
/// longer.
const FORGOTTEN_AFTER_S: f32 = 1.0;
const HELD_FORGOTTEN_AFTER_S: f32 = 3.0;
/// Other balls are forgotten sooner, s.
const OTHER_FORGOTTEN_AFTER_S: f32 = 0.3;
/// Two blobs of one camera frame nearer than this are one ball, m: its diameter.
const SAME_BALL_WITHIN_M: f32 = 0.045;
/// A ball this near to where ours is expected may be ours though another one lies there, m.
const OTHER_WITHIN_M: f32 = 0.1;
/// A blob farther from where another ball is expected is not that ball, m: a ball carried by hand turns.
const OTHER_JUMPS_WITHIN_M: f32 = 0.3;
/// A flying ball appears at most this far from its parabola, m; farther, it is another ball or has hit
/// something.
const FLIGHT_GATE_M: f32 = 0.4;

impl Balls {
    /// The blob nearest to where the ball is expected in the camera frame, if one can be it.
    pub(super) fn nearest_to_chosen(&self, frame: &Frame, around: Around<'_>) -> Option<usize> {
        let track = self.chosen_track()?;
        let expected = track.moved(frame.at, &around.scene.models).0;
        let near = frame.balls.iter().enumerate().filter_map(|(index, seen)| {
            let near = seen.position.distance(expected) <= OTHER_WITHIN_M;
            if !near && self.is_other(seen.position, frame.at) {
                return None;
            }
            let glimpse = self.glimpse(frame, seen, around.scene);
            let off = match &self.air {
                Air::Flying(_, flight) => {
                    let off = flight.position(frame.at).distance(glimpse.position);
                    (off <= FLIGHT_GATE_M).then_some(off)
                }
                _ => track.fits(glimpse.position, frame.at, &around.scene.models),
            };
            off.map(|off| (index, off))
        });
        near.reduce(|best, next| if next.1 < best.1 { next } else { best }).map(|(index, _)| index)
    }

    /// Follows a blob that is not the ball.
    pub(super) fn see_other(&mut self, frame: &Frame, seen: &BallSeen, around: Around<'_>) {
        let models = &around.scene.models;
        let (position, at) = (seen.position, frame.at);
        let glimpse = Glimpse { position, apparent: position, camera: frame.camera, at };
        let twin = |track: &Track| {
            track.seen == at && track.moved(at, models).0.distance(position) < SAME_BALL_WITHIN_M
        };
        *if self.chosen.is_some() { &mut self.counts.others } else { &mut self.counts.new } += 1;
        if self.chosen_track().is_some_and(twin) {
            return;
        }
        let chosen = self.chosen;
        let others = self.tracks.iter_mut().enumerate().filter(|(index, _)| Some(*index) != chosen);
        let fitting = others.filter_map(|(_, track)| {
            let track = track.as_mut()?;
            let off = track.fits(position, at, models)?;
            // A kicked ball is a new one; other balls are not kicked.
            (!track.other || off <= OTHER_JUMPS_WITHIN_M).then_some((off, track))
        });
        if let Some((_, track)) = fitting.reduce(|best, next| if next.0 < best.0 { next } else { best }) {
            track.note(frame, seen);
            track.note_inside(around.scene.is_inside(position));
            track.see(&glimpse, models, around.sigma);
            return;
        }
        // A new track; without room it replaces the one unseen the longest, a known ball last.
        let room = (0..self.tracks.len()).filter(|index| Some(*index) != chosen);
        if let Some(index) =
            room.min_by_key(|index| self.tracks[*index].map(|track| (track.other, track.seen)))
        {
            let mut track = Track::new(&glimpse, seen, around.sigma);
            track.other = self.is_other(position, at);
            track.note_inside(around.scene.is_inside(position));
            if let Some(replaced) = self.tracks[index].replace(track) {
                self.remember_other(&replaced);
            }
        }
    }

    /// Drops tracks that no camera has seen for long.
    pub(super) fn forget(&mut self, now: Captured) {
        let patience = micros(self.patience());
        for index in 0..self.tracks.len() {
            let kept = if self.chosen == Some(index) { patience } else { micros(OTHER_FORGOTTEN_AFTER_S) };
            if let Some(track) = self.tracks[index].take_if(|track| now - track.seen > kept) {
                self.remember_other(&track);
            }
        }
        if self.chosen.is_some_and(|index| self.tracks[index].is_none()) {
            self.become_ball(None);
        }
    }

    /// Time for which an unseen ball is kept, s.
    pub(super) fn patience(&self) -> f32 {
        let at_front = self.contact.zip(self.chosen_track());
        let held =
            at_front.is_some_and(|(contact, track)| track.seen - contact.until <= micros(UNSEEN_AFTER_S));
        if held { HELD_FORGOTTEN_AFTER_S } else { FORGOTTEN_AFTER_S }
    }

    /// Makes another track the ball where this one is not visible and the other can be it, or where this one
    /// is out of the field.
    pub(super) fn choose(&mut self, now: Captured, around: Around<'_>) {
        let playable = |track: &Track| around.scene.is_playable(track.plane.position);
        let current = self.chosen_track();
        let lost = current.is_none_or(|track| now - track.agreed > micros(REPLACED_AFTER_S));
        let is_first = self.is_first_choice(now);
        let is_out = current.is_some_and(|track| now - track.inside_at.unwrap_or(now) > micros(OUT_AFTER_S));
        let settled =
            current.is_some_and(|track| playable(track) && track.inside_at.is_some()) && !self.is_doubtful();
        if !lost && settled && !is_first && !is_out {
            return;
        }
        let needed = if current.is_some() { FRAMES_TO_TAKE_OVER } else { FRAMES_TO_BELIEVE };
        // A match begins at the centre of the field.
        let last = current.filter(|_| !is_first).map(|track| track.plane.position);
        let last = last.or(self.gone.map(|gone| gone.place)).unwrap_or_default();
        let outside = current.is_some_and(|track| !playable(track));
        let mut best: Option<(usize, (bool, bool, f32))> = None;
        for (index, track) in self.tracks.iter().enumerate() {
            let Some(track) = track.as_ref().filter(|_| self.chosen != Some(index)) else { continue };
            let steady = track.images >= needed && now - track.seen <= micros(UNSEEN_AFTER_S);
            let can_be_it = if lost {
                self.may_be_ours(track, now, around)
            } else if self.is_doubtful() {
                self.is_back(track, now, around)
            } else if settled && is_out {
                let is_inside = track.inside_at == Some(track.seen);
                is_inside && !track.other && track.rests() && track.images >= FRAMES_PUT_BACK
            } else if settled {
                current
                    .is_some_and(|current| track.rank(last, around.scene) < current.rank(last, around.scene))
            } else {
                playable(track) && (track.inside_at.is_some() || outside)
            };
            if !steady || !can_be_it {
                continue;
            }
            let rank = track.rank(last, around.scene);
            if best.is_none_or(|(_, least)| rank < least) {
                best = Some((index, rank));
            }
        }
        if let Some((index, _)) = best {
            self.first = self.first.or_else(|| current.is_none().then_some(now));
            if let Some(track) = self.tracks[index] {
                self.note_replacement(&track, now, around);
            }
            self.become_ball(Some(index));
        }
    }

    /// Whether the ball was first chosen just now.
    pub(super) fn is_first_choice(&self, now: Captured) -> bool {
        self.first.is_some_and(|first| now - first <= micros(FIRST_CHOICE_LASTS_S))
    }

    fn become_ball(&mut self, index: Option<usize>) {
        self.chosen = index;
        (self.air, self.kicked, self.contact) = (Air::Down, None, None);
    }
}
