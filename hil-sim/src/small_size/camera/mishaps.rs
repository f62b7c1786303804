//! `mishaps`: faults of camera frames of the random world models: gaps, swapped ids, jitter. Times in steps
//! of 1 ms.

use geometry::math;
use protocol::Who;
use rules::Colour;
use ssl::vision::DetectionFrame;

use crate::rng::Stream;
use crate::small_size::World;
use crate::small_size::worlds::VisionModel;

#[derive(Clone, Debug)]
pub(super) struct Mishaps {
    of: VisionModel,
    gaps: Stream,
    swaps: Stream,
    jitter: Stream,
    /// The next or current gap: from, to.
    gap: [u64; 2],
    next_swap: u64,
    swap: Option<Swap>,
    last_due: u64,
}

/// Two robots of one team are detected with each other's number.
#[derive(Clone, Copy, Debug)]
struct Swap {
    robots: [Who; 2],
    until: u64,
}

impl Mishaps {
    pub(super) fn new(of: VisionModel, seed: u64) -> Self {
        let mut mishaps = Self {
            of,
            gaps: Stream::new(seed, "vision gaps"),
            swaps: Stream::new(seed, "vision swaps"),
            jitter: Stream::new(seed, "vision jitter"),
            gap: [u64::MAX; 2],
            next_swap: u64::MAX,
            swap: None,
            last_due: 0,
        };
        if of.gap_every_s > 0.0 {
            mishaps.draw_gap(0);
        }
        if of.swap_every_s > 0.0 {
            mishaps.next_swap = waiting(&mut mishaps.swaps, of.swap_every_s);
        }
        mishaps
    }

    fn draw_gap(&mut self, after: u64) {
        let from = after + waiting(&mut self.gaps, self.of.gap_every_s);
        let [least, most] = self.of.gap_ms;
        self.gap = [from, from + u64::from(self.gaps.whole(least, most))];
    }

    /// Advances to step `now`.
    pub(super) fn go_on(&mut self, now: u64, world: &World, rate: f32) {
        if now >= self.gap[1] {
            self.draw_gap(self.gap[1]);
        }
        if now >= self.next_swap {
            let [least, most] = self.of.swap_frames;
            let frames = self.swaps.whole(least, most) as f32;
            let until = now + (frames * 1000.0 / rate) as u64;
            self.swap = self.draw_pair(world).map(|robots| Swap { robots, until });
            self.next_swap = until + waiting(&mut self.swaps, self.of.swap_every_s);
        }
        if self.swap.is_some_and(|swap| swap.until <= now) {
            self.swap = None;
        }
    }

    fn draw_pair(&mut self, world: &World) -> Option<[Who; 2]> {
        let colour = if self.swaps.chance(0.5) { Colour::Yellow } else { Colour::Blue };
        let here = world.robots().iter().filter(|robot| robot.present && robot.who.colour == colour);
        let here: Vec<Who> = here.map(|robot| robot.who).collect();
        let last = u32::try_from(here.len()).ok()?.checked_sub(1)?;
        let [one, other] = [self.swaps.whole(0, last), self.swaps.whole(0, last.checked_sub(1)?)];
        // A robot other than the first, uniformly drawn.
        let other = if other >= one { other + 1 } else { other };
        Some([*here.get(one as usize)?, *here.get(other as usize)?])
    }

    /// True where a frame taken now does not arrive.
    pub(super) fn in_gap(&self, now: u64) -> bool {
        (self.gap[0]..self.gap[1]).contains(&now)
    }

    /// Swaps the numbers as they are detected now.
    pub(super) fn swap_ids(&self, frame: &mut DetectionFrame) {
        let Some(Swap { robots: [one, other], .. }) = self.swap else { return };
        let team = one.colour.pick(&mut frame.robots_yellow, &mut frame.robots_blue);
        let [a, b] = [one, other].map(|who| Some(u32::from(who.id.number())));
        for robot in team {
            if robot.robot_id == a {
                robot.robot_id = b;
            } else if robot.robot_id == b {
                robot.robot_id = a;
            }
        }
    }

    /// Arrival time of a frame due at `due`: later, but never before a frame that was sent earlier.
    pub(super) fn delayed(&mut self, due: u64) -> u64 {
        if self.of.jitter_ms == 0 {
            return due;
        }
        let due = due + u64::from(self.jitter.whole(0, self.of.jitter_ms));
        self.last_due = self.last_due.max(due);
        self.last_due
    }
}

/// Steps to the next event; `mean_s` is the mean interval.
fn waiting(chance: &mut Stream, mean_s: f32) -> u64 {
    1 + (-mean_s * math::ln(1.0 - chance.share()) * 1000.0) as u64
}
