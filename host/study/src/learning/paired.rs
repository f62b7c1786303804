//! `paired`: what pairs of trials with and without a change show: to goal, by kind of start and by world, and
//! the opponents' touches.

use arena::Profile;
use serde::Serialize;

use crate::learning::betting::{PairedDifference, Wager};
use crate::learning::starts::KINDS;
use crate::learning::trial::LearningTrial;

/// Pairs of one world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WorldPairs {
    /// Pairs by whether the ball came to goal.
    pub to_goal: Wager,
    /// Touches of the opponents.
    pub touches: PairedDifference,
}

/// Pairs of whole trials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Pairs {
    /// All, those included that are equal by construction and were not played.
    pub all: Wager,
    /// Those that were played, by kind of start.
    pub kinds: [Wager; KINDS.len()],
    /// Those that were played, as in the paper's simulator and as by its robots.
    pub worlds: [WorldPairs; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Objection {
    /// Fewer balls come to goal in a world or a kind of starts.
    Lowers,
    /// The opponents touch the ball more often in a world where to goal rises by no more than chance gives.
    Touches,
}

impl Pairs {
    /// Adds a pair of trials of a start of this kind.
    pub(crate) fn add(&mut self, kind: usize, with: &LearningTrial, without: &LearningTrial) {
        let to_goal = [with.to_goal(), without.to_goal()];
        let world = &mut self.worlds[usize::from(KINDS[kind].profile == Profile::Robots)];
        for wager in [&mut self.all, &mut self.kinds[kind], &mut world.to_goal] {
            wager.add(to_goal[0], to_goal[1]);
        }
        world.touches.add(f64::from(with.touches) - f64::from(without.touches));
    }

    /// Objection to the change, if there is one.
    pub(crate) fn objection(&self) -> Option<Objection> {
        let lowers = self.worlds.iter().any(|world| world.to_goal.z() < WORLD_LOWERED_Z)
            || self.kinds.iter().any(|kind| kind.z() < KIND_LOWERED_Z);
        // A play that ends at once, such as a kick out of the field, has few touches; its repair has more.
        let dearer = |world: &WorldPairs| world.touches.z() > TOUCHES_Z && world.to_goal.z() < GAIN_Z;
        let touches = self.worlds.iter().any(dearer);
        if lowers { Some(Objection::Lowers) } else { touches.then_some(Objection::Touches) }
    }
}

/// A world counts as lowered below this: more lowered than raised.
const WORLD_LOWERED_Z: f64 = 0.0;
/// A kind of starts counts as lowered from here on: p < 0.025 on one side.
const KIND_LOWERED_Z: f64 = -1.96;
/// Touches count as more frequent from here on, standard deviations.
const TOUCHES_Z: f64 = 1.96;
/// The share to goal counts as raised from here on, standard deviations.
const GAIN_Z: f64 = 1.96;

#[cfg(test)]
mod tests {
    use hil_sim::TrialOutcome;

    use super::*;

    fn trial(goal: bool, touches: u32) -> LearningTrial {
        let outcome = if goal { TrialOutcome::Goal } else { TrialOutcome::Out };
        LearningTrial { outcome, touches, decisions: Vec::new() }
    }

    fn pairs(kind: usize, number: usize, with: (bool, u32), without: (bool, u32)) -> Pairs {
        let mut pairs = Pairs::default();
        (0..number).for_each(|_| pairs.add(kind, &trial(with.0, with.1), &trial(without.0, without.1)));
        pairs
    }

    #[test]
    fn a_world_is_lowered_by_one_pair_more_and_a_kind_by_four_of_four() {
        let noisy = KINDS.iter().position(|kind| kind.profile == Profile::Robots).unwrap();
        let mut one = pairs(noisy, 1, (false, 0), (true, 0));
        assert_eq!(one.objection(), Some(Objection::Lowers));
        // Other starts of the simulator do not make up for a loss of the robots.
        (0..50).for_each(|_| one.add(0, &trial(true, 0), &trial(false, 0)));
        assert_eq!((one.objection(), one.all.raised), (Some(Objection::Lowers), 50));
        let mut kind = pairs(2, 4, (false, 0), (true, 0));
        (0..50).for_each(|_| kind.add(0, &trial(true, 0), &trial(false, 0)));
        assert_eq!(kind.objection(), Some(Objection::Lowers), "2 standard deviations");
        let mut three = pairs(2, 3, (false, 0), (true, 0));
        (0..50).for_each(|_| three.add(0, &trial(true, 0), &trial(false, 0)));
        assert_eq!(three.objection(), None, "1.7 standard deviations");
    }

    #[test]
    fn touches_stand_against_a_change_from_two_standard_deviations_on() {
        // Four pairs with one touch more: 4 / 2.
        assert_eq!(pairs(0, 4, (true, 3), (true, 2)).objection(), Some(Objection::Touches));
        assert_eq!(pairs(0, 3, (true, 3), (true, 2)).objection(), None);
        assert_eq!(pairs(0, 9, (true, 1), (false, 2)).objection(), None);
        // Four goals more are worth the touches, three may be chance.
        assert_eq!(pairs(0, 4, (true, 3), (false, 2)).objection(), None);
        let mut three = pairs(0, 3, (true, 3), (false, 2));
        three.add(0, &trial(true, 3), &trial(true, 2));
        assert_eq!(three.objection(), Some(Objection::Touches));
    }
}
