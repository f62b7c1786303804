//! `choice`: names of worlds: one world for a match, or a plan that gives each match its own.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// The choice of a world: `nominal`, a named profile, or `random:SEED`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WorldChoice {
    /// The league's own file, unchanged.
    #[default]
    Nominal,
    /// A named profile of `hil-sim/data/worlds`.
    Named(NamedWorld),
    /// Every number drawn from its distribution, with this seed.
    Random(u64),
}

geometry::labels! {
    /// A profile of `hil-sim/data/worlds`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum NamedWorld {
        /// The published defaults of grSim.
        Grsim = "grsim",
        /// ER-Force's simulator with realism "Realistic".
        Erforce = "erforce",
        /// ER-Force's simulator with realism "None".
        ErforceNone = "erforce-none",
        /// TIGERs Mannheim's simulator Sumatra.
        Sumatra = "sumatra",
        /// Robots whose roller holds the ball weakly.
        SlowDribbler = "slow-dribbler",
        /// Cameras with gaps, jitter, ghosts and misses.
        PoorVision = "poor-vision",
        /// Robots whose kicks leave slower than ordered, and scatter.
        WeakKickers = "weak-kickers",
    }
}

impl WorldChoice {
    /// Every name that can be chosen, except `random:SEED`.
    pub fn names() -> impl Iterator<Item = &'static str> {
        [NOMINAL].into_iter().chain(NamedWorld::ALL.into_iter().map(NamedWorld::label))
    }
}

impl fmt::Display for WorldChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nominal => f.write_str(NOMINAL),
            Self::Named(named) => f.write_str(named.label()),
            Self::Random(seed) => write!(f, "{RANDOM}:{seed}"),
        }
    }
}

impl FromStr for WorldChoice {
    type Err = UnknownWorld;

    fn from_str(name: &str) -> Result<Self, UnknownWorld> {
        if name == NOMINAL {
            return Ok(Self::Nominal);
        }
        if let Some(named) = NamedWorld::ALL.into_iter().find(|named| named.label() == name) {
            return Ok(Self::Named(named));
        }
        let seed = name.strip_prefix(RANDOM).and_then(|rest| rest.strip_prefix(':'));
        let seed = seed.and_then(|digits| digits.parse().ok());
        seed.map(Self::Random).ok_or_else(|| UnknownWorld { name: name.to_owned(), plan: false })
    }
}

/// The world of each match of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WorldPlan {
    /// All matches in this one.
    Same(WorldChoice),
    /// Each in the random world of its own seed; written `random`.
    RandomPerMatch,
}

impl WorldPlan {
    /// The world of the match with this seed.
    pub const fn of_match(self, seed: u64) -> WorldChoice {
        match self {
            Self::Same(choice) => choice,
            Self::RandomPerMatch => WorldChoice::Random(seed),
        }
    }
}

impl Default for WorldPlan {
    fn default() -> Self {
        Self::Same(WorldChoice::Nominal)
    }
}

impl From<WorldChoice> for WorldPlan {
    fn from(choice: WorldChoice) -> Self {
        Self::Same(choice)
    }
}

impl fmt::Display for WorldPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Same(choice) => choice.fmt(f),
            Self::RandomPerMatch => f.write_str(RANDOM),
        }
    }
}

impl FromStr for WorldPlan {
    type Err = UnknownWorld;

    fn from_str(name: &str) -> Result<Self, UnknownWorld> {
        if name == RANDOM {
            return Ok(Self::RandomPerMatch);
        }
        name.parse().map(Self::Same).map_err(|error| UnknownWorld { plan: true, ..error })
    }
}

/// Implements serde's traits of types by `Display` and `FromStr`.
#[macro_export]
macro_rules! serde_by_text {
    ($($name:ty),+) => { $(
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = <String as serde::Deserialize>::deserialize(deserializer)?;
                text.parse().map_err(serde::de::Error::custom)
            }
        }
    )+ };
}
serde_by_text!(WorldChoice, WorldPlan);

/// The text names no world.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("no world is named {name:?}; there are {}, and {} with a whole number", all_names(), seed_form(*.plan))]
pub struct UnknownWorld {
    /// The name that was requested.
    pub name: String,
    /// True where `random` alone would have been a name too.
    plan: bool,
}

fn all_names() -> String {
    WorldChoice::names().collect::<Vec<_>>().join(", ")
}

const fn seed_form(plan: bool) -> &'static str {
    if plan { "random (the seed of each match) or random:SEED" } else { "random:SEED" }
}

/// The league's own file.
const NOMINAL: &str = "nominal";
/// Prefix of a seed, or alone in a plan.
const RANDOM: &str = "random";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_as_it_is_written() {
        let seeds = [0, 7, u64::MAX].map(WorldChoice::Random);
        let named = NamedWorld::ALL.map(WorldChoice::Named);
        for choice in [WorldChoice::Nominal].into_iter().chain(named).chain(seeds) {
            assert_eq!(choice.to_string().parse(), Ok(choice));
            assert_eq!(choice.to_string().parse(), Ok(WorldPlan::Same(choice)));
        }
        assert_eq!("random".parse(), Ok(WorldPlan::RandomPerMatch));
        assert_eq!(WorldPlan::RandomPerMatch.to_string(), "random");
        assert_eq!(WorldPlan::RandomPerMatch.of_match(12), WorldChoice::Random(12));
        assert_eq!(WorldPlan::default().of_match(12), WorldChoice::Nominal);
    }

    #[test]
    fn the_error_of_an_unknown_name_lists_all_names() {
        for name in ["", "Nominal", "grsim ", "random", "random:", "random:-1", "random:1.5", "mars"] {
            let error = name.parse::<WorldChoice>().unwrap_err().to_string();
            for name in WorldChoice::names().chain(["random:SEED"]) {
                assert!(error.contains(name), "{error}");
            }
            assert!(error.contains(&format!("{name:?}")), "{error}");
        }
        let error = "mars".parse::<WorldPlan>().unwrap_err().to_string();
        assert!(error.contains("seed of each match"), "{error}");
    }
}
