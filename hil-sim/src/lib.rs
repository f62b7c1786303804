//! `hil_sim`: simulator of field, radio and microcontrollers. A deterministic simulator (docs/architecture.md
//! §7). Runs on the PC.
//!
//! ```text
//! scenario ─► world (ball, walkers) ─► senses ─► Mcu: native, or the image under QEMU ─► orders ─► world
//!                 │                                  ▲ │
//!                 └► opponents, referee, trace       air ─ packets with loss, delay, copies, partition
//! ```
//! [`Simulation`] connects them: a tick of 40 ms for brains and radio, four steps of 10 ms for physics. Equal
//! configurations give equal bits: no clock, one random stream per subsystem, fixed order of every loop,
//! `geometry::math` only.
//!
//! **Invariants.** It never links `host`; robots measure the true state through [`four_legged::sensors`]
//! alone; only the back end does I/O.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod air;
pub mod four_legged;
mod hash;
mod mcu;
mod meter;
mod native;
mod parameters;
mod qemu;
mod rng;
pub mod small_size;

pub use air::{Air, AirCounts, AirSettings, Bursts, LinkLoss};
pub use four_legged::fault::{Fault, ScheduledFault};
pub use four_legged::opponents::{Conduct, Opponent, OpponentRole};
pub use four_legged::parameters::{FOUR_LEGGED_TOML, Noise, Parameters, Region};
pub use four_legged::referee::{Configuration, Party, Referee, TrialOutcome, TrialVerdict};
pub use four_legged::scenario::{Layout, Placed, Scenario, TEAM};
pub use four_legged::simulation::{
    ReceivedPacket, Sent, Simulation, SimulationConfig, SimulationError, TICK_US, Tick,
};
pub use four_legged::trace::TraceHash;
pub use four_legged::world_hash::world_hash;
pub use hash::Fnv;
pub use mcu::{Backend, Mcu, McuError, Reply};
pub use meter::{ByTeam, Meter, Metered};
pub use native::{NativeBackend, NativeMcu};
pub use parameters::ParameterError;
pub use qemu::{QemuBackend, emulator_command};
pub use rng::Stream;
