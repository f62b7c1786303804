//! `null_control`: chance in place of outcomes, in runs with `--shuffle-outcomes`, which tell how often
//! changes without an effect are accepted. Other runs are not touched.

use hil_sim::{Fnv, Stream};

use crate::learning::edit::Edit;
use crate::learning::settings::LearnSettings;

/// Whether chance swaps the sides of a pair: that of `edit` with this number, for the purpose `of`.
pub(crate) fn swaps(settings: &LearnSettings, edit: &Edit, of: u8, index: u32) -> bool {
    let mut hash = Fnv::default();
    hash.add(&[of]);
    hash.add(&settings.seed.to_le_bytes());
    hash.add(edit.to_string().as_bytes());
    hash.add(&index.to_le_bytes());
    settings.shuffle && Stream::new(hash.value(), "coin").chance(0.5)
}

/// Shuffles outcomes, of which the first is of the start with this index.
pub(crate) fn shuffle<T>(settings: &LearnSettings, first: u32, outcomes: &mut [T]) {
    if !settings.shuffle {
        return;
    }
    let mut chance = Stream::new(settings.seed ^ u64::from(first), "shuffle");
    for i in (1..outcomes.len()).rev() {
        outcomes.swap(i, chance.whole(0, i as u32) as usize);
    }
}
