//! `words`: names of scenarios and approaches in files: the same as on the command line.

/// `1` to `4`, or `random`.
pub(super) mod scenario {
    use hil_sim::Scenario;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(in super::super) fn serialize<S: Serializer>(scenario: &Scenario, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(scenario.word())
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Scenario, D::Error> {
        let word = String::deserialize(d)?;
        Scenario::from_word(&word).ok_or_else(|| D::Error::custom(format!("no scenario is called {word}")))
    }
}

/// `cbr`, `reactive`, …
pub(super) mod approach {
    use brain::Approach;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    use crate::trial::{approach_from_word, approach_word};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(in super::super) fn serialize<S: Serializer>(approach: &Approach, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(approach_word(*approach))
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Approach, D::Error> {
        let word = String::deserialize(d)?;
        approach_from_word(&word).ok_or_else(|| D::Error::custom(format!("no approach is called {word}")))
    }
}
