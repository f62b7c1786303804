//! `world_hash`: hash of the four-legged world: every number of its data, its scenarios, and the version of
//! its model. Tables print it: two tables with the same hash were played in the same world.

use std::sync::LazyLock;

use crate::four_legged::parameters::Parameters;
use crate::four_legged::scenario::SCENARIO_FILES;
use crate::hash::Fnv;

/// Version of the model: raised with every change of code that changes what the world does with the same
/// data.
///
/// 1: opponents clear into the field; body-frame sights, drifting localisation and slipping legs in the
/// robots' profile; opponents act on a noisy ball there and stop in the pause.
const MODEL_VERSION: u32 = 1;

/// The hash, 8 hexadecimal digits.
pub fn world_hash() -> String {
    HASH.clone()
}

static HASH: LazyLock<String> = LazyLock::new(|| hash(Parameters::four_legged()));

fn hash(parameters: &Parameters) -> String {
    let mut hash = Fnv::default();
    hash.add(&MODEL_VERSION.to_le_bytes());
    // Comments and order of the file do not count.
    hash.add(toml::to_string(parameters).unwrap_or_default().as_bytes());
    for file in SCENARIO_FILES {
        let value: toml::Table = toml::from_str(file).unwrap_or_default();
        hash.add(value.to_string().as_bytes());
    }
    let value = hash.value();
    format!("{:08x}", (value ^ (value >> 32)) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::four_legged::parameters::FOUR_LEGGED_TOML;

    #[test]
    fn every_parameter_changes_the_world_hash_and_comments_do_not() {
        let own = world_hash();
        assert_eq!(own.len(), 8);
        let other = |from: &str, to: &str| {
            assert!(FOUR_LEGGED_TOML.contains(from), "{from}");
            hash(&Parameters::from_toml(&FOUR_LEGGED_TOML.replace(from, to)).unwrap())
        };
        assert_eq!(other("# s;", "# seconds;"), own);
        assert_ne!(other("deceleration = 0.35", "deceleration = 0.36"), own);
        assert_ne!(other("miss = 0.1", "miss = 0.2"), own);
    }
}
