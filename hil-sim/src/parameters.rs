//! `parameters`: structs of bounded numbers, read from the files of `hil-sim/data`, and the error that names
//! a number out of its bounds.

use thiserror::Error;

/// Declares structs whose every field is a number within bounds, and their check.
macro_rules! numbers {
    ($($(#[$about:meta])* $name:ident in $file:literal { $($(#[$doc:meta])* $field:ident: $low:expr, $high:expr;)* })*) => { $(
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name { $($(#[$doc])* pub $field: f32,)* }

        impl $name {
            /// Every number 0.
            pub const ZERO: Self = Self { $($field: 0.0,)* };

            /// Checks every number against the limits of the physics.
            pub fn check(&self) -> Result<(), ParameterError> {
                $(within(concat!($file, ".", stringify!($field)), self.$field, $low, $high)?;)*
                Ok(())
            }
        }
    )* };
}
pub(crate) use numbers;

/// Reason for which a file of parameters cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParameterError {
    /// Not TOML, or a key unknown, missing or of a wrong type.
    #[error("parameters: {0}")]
    Syntax(String),
    /// A number outside the limits of the physics.
    #[error("parameters: {name} is {value}, must be within {low} to {high}")]
    Range {
        /// Name of the number, as in the file.
        name: &'static str,
        /// Value in the file.
        value: f32,
        /// Smallest valid value.
        low: f32,
        /// Largest valid value.
        high: f32,
    },
}

/// Accepts `value` within the bounds, both included; else the error names it.
pub(crate) fn within(name: &'static str, value: f32, low: f32, high: f32) -> Result<(), ParameterError> {
    if (low..=high).contains(&value) { Ok(()) } else { Err(ParameterError::Range { name, value, low, high }) }
}
