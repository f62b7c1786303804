//! Shared code of tests that span several crates. Runs on the developer's machine only.
#![forbid(unsafe_code)]

pub mod bad_line;
pub mod bench;
pub mod hil;
pub mod hostile;
pub mod invariants;
pub mod led_robot;
pub mod oracle;
pub mod random_library;
pub mod soak;
pub mod swarm;
pub mod sweep;
pub mod tabletop;
pub mod test_field;
pub mod workspace;
