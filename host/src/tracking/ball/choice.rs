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
            track.fits(position, at, models).map(|off| (off, track))
        });
        if let Some((_, track)) = fitting.reduce(|best, next| if next.0 < best.0 { next } else { best }) {
            track.note(frame, seen);
            track.inside |= around.scene.is_inside(position);
            track.see(&glimpse, models, around.sigma);
            return;
        }
        // A new track; without room it replaces the one unseen the longest.
        let other = self.is_other(position, at);
        let inside = around.scene.is_inside(position);
        let room = self.tracks.iter_mut().enumerate().filter(|(index, _)| Some(*index) != chosen);
        let seen_last = |track: &Option<Track>| track.map_or(Captured::MIN, |track| track.seen);
        if let Some((_, place)) = room.min_by_key(|(_, track)| seen_last(track)) {
            let mut track = Track::new(&glimpse, seen, around.sigma);
            (track.other, track.inside) = (other, inside);
            *place = Some(track);
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
        let lost = current.is_none_or(|track| now - track.seen > micros(REPLACED_AFTER_S));
        let settled = current.is_some_and(|track| playable(track) && track.inside) && !self.is_doubtful();
        if !lost && settled {
            return;
        }
        let needed = if current.is_some() { FRAMES_TO_TAKE_OVER } else { FRAMES_TO_BELIEVE };
        let last = current.map(|track| track.plane.position);
        let outside = current.is_some_and(|track| !playable(track));
        let mut best: Option<(usize, (bool, f32))> = None;
        for (index, track) in self.tracks.iter().enumerate() {
            let Some(track) = track.as_ref().filter(|_| self.chosen != Some(index)) else { continue };
            let steady = track.images >= needed && now - track.seen <= micros(UNSEEN_AFTER_S);
            let can_be_it = if lost {
                self.may_be_ours(track, now, around)
            } else if self.is_doubtful() {
                self.is_back(track, now, around)
            } else {
                playable(track) && (track.inside || outside)
            };
            if !steady || !can_be_it {
                continue;
            }
            let away = last.map_or(0.0, |last| last.distance(track.plane.position));
            let rank = (!playable(track), away);
            if best.is_none_or(|(_, least)| rank < least) {
                best = Some((index, rank));
            }
        }
        if let Some((index, _)) = best {
            if let Some(track) = self.tracks[index] {
                self.note_replacement(&track, now, around);
            }
            self.become_ball(Some(index));
        }
    }

    fn become_ball(&mut self, index: Option<usize>) {
        self.chosen = index;
        (self.air, self.kicked, self.contact) = (Air::Down, None, None);
    }
}
