//! `description`: names of scenarios and approaches in files: the same as on the command line.

/// `1` to `4`, or `random`.
pub(super) mod scenario {
    use hil_sim::Scenario;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(in super::super) fn serialize<S: Serializer>(scenario: &Scenario, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(scenario.label())
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Scenario, D::Error> {
        let label = String::deserialize(d)?;
        Scenario::from_label(&label).ok_or_else(|| D::Error::custom(format!("no scenario is called {label}")))
    }
}

/// `cbr`, `reactive`, …
pub(super) mod approach {
    use brain::Approach;
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    use arena::{approach_from_label, approach_label};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
    pub(in super::super) fn serialize<S: Serializer>(approach: &Approach, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(approach_label(*approach))
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<Approach, D::Error> {
        let label = String::deserialize(d)?;
        approach_from_label(&label).ok_or_else(|| D::Error::custom(format!("no approach is called {label}")))
    }
}
