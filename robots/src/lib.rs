//! `robots`: descriptions of robots, `robot.toml`. Reads a file, checks every value against its range and all
//! of them against each other. SI units, degrees where a name says so.
//!
//! [`KEYS`] lists every key with unit, range and meaning; [`Description::read`] gives the values, or
//! [`Finding`]s with what is wrong, in which line, and how to mend it. Crate `rules` reads the description
//! that `ONETWO_ROBOT` names ([`chosen`]) when it is built, and the program checks files with the same code.
//!
//! **Invariants.** No file panics; a description that was read has every key, each within its range.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod checks;
mod description;
mod keys;
mod place;
mod wheels;

pub use description::{Description, Value};
pub use foreign::{Finding, Severity};
pub use keys::{KEYS, Key, Kind};
pub use place::{Chosen, Unreadable, VARIABLE, chosen};
pub use wheels::{Wheel, WheelSlots, condition, wheel_slots};

/// Descriptions that come with the project: name and text. The first is the default.
pub const BUILT_IN: [(&str, &str); 5] = [
    ("ours", include_str!("../ours.toml")),
    ("wide", include_str!("../wide.toml")),
    ("school", include_str!("../school.toml")),
    ("three", include_str!("../three.toml")),
    ("skewed", include_str!("../skewed.toml")),
];

/// The text of the built-in description of that name.
pub fn built_in(name: &str) -> Option<&'static str> {
    BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_descriptions_are_right_and_carry_their_names() {
        for (name, text) in BUILT_IN {
            let description = Description::read(name, text).unwrap_or_else(|findings| panic!("{findings:?}"));
            assert_eq!((description.name(), description.warnings()), (name, &[][..]));
        }
        assert_eq!(built_in("mine"), None);
    }

    #[test]
    fn every_number_of_a_built_in_description_has_its_source_or_reason_beside_it() {
        for (name, text) in BUILT_IN {
            for line in text.lines().filter(|line| line.contains(" = ") && !line.starts_with('#')) {
                let (_, comment) = line.split_once('#').unwrap_or_else(|| panic!("{name}: {line}"));
                assert!(comment.trim().len() > 3, "{name}: {line}");
            }
        }
    }
}
