//! `episodes`: separation of offences in time. An offence is reported when it starts and, as long as it
//! lasts, again after the rules' 2 s; one that pauses shorter than 0.2 s is still the same.

use std::collections::BTreeMap;

use protocol::{Duration, Instant};
use rules::limits;

/// Current offences, by the robot or team that commits them.
#[derive(Clone, Debug)]
pub(super) struct Episodes<K>(BTreeMap<K, Episode>);

#[derive(Clone, Copy, Debug)]
struct Episode {
    raised: Instant,
    seen: Instant,
}

impl<K> Default for Episodes<K> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<K: Ord> Episodes<K> {
    /// True where the present offence has to be reported.
    pub(super) fn raise(&mut self, who: K, holds: bool, now: Instant) -> bool {
        let Some(episode) = self.0.get_mut(&who) else {
            if holds {
                self.0.insert(who, Episode { raised: now, seen: now });
            }
            return holds;
        };
        if !holds {
            if now.since(episode.seen) > PAUSE {
                self.0.remove(&who);
            }
            return false;
        }
        episode.seen = now;
        let again = now.since(episode.raised) >= Duration::from_secs_f32(limits::FOUL_REPEAT);
        if again {
            episode.raised = now;
        }
        again
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

/// Maximum pause within one offence, such as when a robot bounces off the ball or a line: more than two
/// frames of a camera, estimated.
const PAUSE: Duration = Duration::millis(200);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offence_is_raised_at_its_start_and_every_two_seconds() {
        let mut episodes = Episodes::default();
        let raised: Vec<u64> =
            (0..500).filter(|step| episodes.raise((), true, Instant(step * 10_000))).collect();
        assert_eq!(raised, [0, 200, 400]);
    }

    #[test]
    fn only_a_pause_of_two_seconds_starts_a_new_offence() {
        let mut episodes = Episodes::default();
        assert!(episodes.raise((), true, Instant(0)));
        assert!(!episodes.raise((), false, Instant(100_000)));
        assert!(!episodes.raise((), true, Instant(150_000)));
        assert!(!episodes.raise((), false, Instant(400_000)));
        assert!(episodes.raise((), true, Instant(410_000)));
    }
}
