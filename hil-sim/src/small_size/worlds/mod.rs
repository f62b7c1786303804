//! `worlds`: the family of worlds: physics, robots, links and cameras as distributions, so that no skill is
//! tested with one set of parameters alone.
//!
//! A [`WorldModel`] is one world: the league's [`Parameters`](super::Parameters), changed, and what they do
//! not contain: differences between robots of a team ([`RobotSpread`]), delay of orders to the wheels
//! ([`LinkModel`]), frames that come late, not at all or with robots' ids swapped ([`VisionModel`]), and
//! robots without a computer ([`WorldModel::bystanders`]). A [`WorldChoice`] names one: `nominal` is the
//! league's own file, a named profile changes it by `hil-sim/data/worlds/NAME.toml`, and `random:SEED` draws
//! every number from its distribution. SI units; times of links and frames in ms.

mod bystanders;
mod choice;
mod file;
mod latency;
mod model;
mod random;

#[cfg(test)]
mod tests;

pub(super) use latency::Latency;

pub use choice::{NamedWorld, UnknownWorld, WorldChoice, WorldPlan};
pub use file::WorldError;
pub use model::{LinkModel, RobotSpread, Traits, VisionModel, WorldModel};
pub use random::{DRAWS, GAP_MS, Law, PERFECT_PULL, Quantity};
