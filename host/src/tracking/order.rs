//! `order`: ordering of camera frames. No frame counts twice, and one that comes late within a short window
//! is inserted at its place: all later ones are processed again.
//!
//! So the world depends on the frames, not on how the network shuffled them. A team lost a match without
//! this: vision came over cable and wireless at once, and late copies were processed as new frames.

use heapless::Vec;

use super::seen::{Captured, Frame};

/// Largest delay of a camera frame, µs: a camera whose packets take a network's worst delays. Older ones
/// would change what robots did long ago.
const LATE_MAX_US: Captured = 200_000;
/// Camera frames kept: those of eight cameras of 60 Hz within the window.
const FRAMES_KEPT: usize = 96;

/// Result of inserting a camera frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Placed {
    /// The newest frame.
    Newest,
    /// A frame inserted before this number of newer ones.
    Before(usize),
    /// This camera's frame of this moment is there already.
    Repeated,
    /// Older than the newest by this many µs: too old to be inserted.
    Late(Captured),
}

/// The last camera frames, each with the state before it.
#[derive(Clone, Debug)]
pub(super) struct Timeline<S> {
    slots: Box<[Slot<S>]>,
    /// Slots in use, oldest frame first.
    order: Vec<u8, FRAMES_KEPT>,
}

#[derive(Clone, Debug)]
struct Slot<S> {
    frame: Frame,
    before: S,
}

impl<S: Copy> Timeline<S> {
    pub(super) fn new(state: S) -> Self {
        let slot = Slot { frame: Frame::empty(), before: state };
        Self { slots: vec![slot; FRAMES_KEPT].into(), order: Vec::new() }
    }

    pub(super) fn clear(&mut self) {
        self.order.clear();
    }

    /// When the newest camera frame was taken.
    pub(super) fn newest(&self) -> Option<Captured> {
        self.order.last().map(|slot| self.slots[usize::from(*slot)].frame.at)
    }

    /// Inserts a camera frame at its place and updates `state` by `apply`.
    pub(super) fn put(
        &mut self,
        frame: &Frame,
        state: &mut S,
        mut apply: impl FnMut(&mut S, &Frame),
    ) -> Placed {
        let key = |slot: u8| {
            let frame = &self.slots[usize::from(slot)].frame;
            (frame.at, frame.camera)
        };
        let own = (frame.at, frame.camera);
        let place = self.order.iter().rposition(|slot| key(*slot) <= own).map_or(0, |last| last + 1);
        if place > 0 && key(self.order[place - 1]) == own {
            return Placed::Repeated;
        }
        let newest = self.newest().unwrap_or(frame.at);
        if newest - frame.at > LATE_MAX_US || (place == 0 && self.order.is_full()) {
            return Placed::Late(newest - frame.at);
        }
        // The oldest frame is dropped; it is not the new one, which would be too late then.
        let (slot, place) = if self.order.is_full() {
            (self.order.remove(0), place - 1)
        } else {
            (self.order.len() as u8, place)
        };
        // There is room, so this cannot fail.
        let _ = self.order.insert(place, slot);
        self.replay(place, frame, state, &mut apply)
    }

    /// The state before a frame of that moment; `now` where it is the newest.
    pub(super) fn before<'a>(&'a self, at: Captured, now: &'a S) -> &'a S {
        let slots = self.order.iter().map(|slot| &self.slots[usize::from(*slot)]);
        let mut later = slots.rev().take_while(|slot| slot.frame.at > at);
        later.by_ref().last().map_or(now, |slot| &slot.before)
    }

    fn replay(
        &mut self,
        place: usize,
        frame: &Frame,
        state: &mut S,
        apply: &mut impl FnMut(&mut S, &Frame),
    ) -> Placed {
        let after = self.order.len() - 1 - place;
        if let Some(next) = self.order.get(place + 1) {
            *state = self.slots[usize::from(*next)].before;
        }
        self.slots[usize::from(self.order[place])].frame.clone_from(frame);
        for slot in &self.order[place..] {
            let slot = &mut self.slots[usize::from(*slot)];
            slot.before = *state;
            apply(state, &slot.frame);
        }
        if after == 0 { Placed::Newest } else { Placed::Before(after) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state that distinguishes every order: a list of the frames applied.
    type Seen = [(Captured, u32); 110];

    fn frame(at: Captured, camera: u32) -> Frame {
        Frame { at, camera, ..Frame::empty() }
    }

    fn feed(frames: &[(Captured, u32)]) -> (Vec<(Captured, u32), 110>, std::vec::Vec<Placed>) {
        let mut state: (Seen, usize) = ([(0, 0); 110], 0);
        let mut timeline = Timeline::new(state);
        let placed = frames.iter().map(|(at, camera)| {
            timeline.put(&frame(*at, *camera), &mut state, |(seen, count), frame| {
                seen[*count] = (frame.at, frame.camera);
                *count += 1;
            })
        });
        let placed = placed.collect();
        (Vec::from_slice(&state.0[..state.1]).unwrap(), placed)
    }

    #[test]
    fn frames_out_of_order_leave_the_same_state_as_in_order() {
        let sorted: std::vec::Vec<(Captured, u32)> =
            (0..30).map(|i| (i64::from(i / 2) * 10_000, i as u32 % 2)).collect();
        let mut shuffled = sorted.clone();
        for (i, j) in [(2, 4), (9, 7), (12, 15), (20, 21), (28, 29)] {
            shuffled.swap(i, j);
        }
        assert_eq!(feed(&shuffled).0, feed(&sorted).0);
        assert_eq!(feed(&sorted).0[..], sorted[..]);
    }

    #[test]
    fn a_copy_is_reported_and_changes_nothing() {
        let (seen, placed) = feed(&[(0, 0), (0, 1), (16_000, 0), (0, 1), (16_000, 0), (16_000, 1)]);
        assert_eq!(seen[..], [(0, 0), (0, 1), (16_000, 0), (16_000, 1)]);
        let expected = [Placed::Newest, Placed::Newest, Placed::Newest, Placed::Repeated, Placed::Repeated];
        assert_eq!(placed[..5], expected);
    }

    #[test]
    fn what_is_older_than_the_window_is_late() {
        let (seen, placed) = feed(&[(300_000, 0), (100_000, 1), (99_999, 1), (0, 1)]);
        assert_eq!(placed[1..], [Placed::Before(1), Placed::Late(200_001), Placed::Late(300_000)]);
        assert_eq!(seen[..], [(100_000, 1), (300_000, 0)]);
    }

    #[test]
    fn frames_of_more_cameras_than_are_kept_are_still_in_order() {
        let mut images: std::vec::Vec<(Captured, u32)> = (1..=100).map(|i| (i * 1_000, 0)).collect();
        images.extend([(99_500, 1), (1, 1)]);
        let (seen, placed) = feed(&images);
        assert_eq!(placed[100..], [Placed::Before(1), Placed::Late(99_999)]);
        assert_eq!(seen[99..], [(99_500, 1), (100_000, 0)]);
    }
}
