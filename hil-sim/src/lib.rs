//! `hil_sim`: simulator of field, radio and microcontrollers. A deterministic simulator
//! (docs/architecture.md §7). Runs on the PC.
//!
//! ```text
//! scenario ─► world (ball, walkers) ─► senses ─► Mcu: native, or the image under QEMU ─► orders ─► world
//!                 │                                  ▲ │
//!                 └► opponents, referee, trace       air ─ packets with loss, delay, copies, partition
//! ```
//! [`Simulation`] ties them together: a tick of 40 ms for brains and air, four steps of 10 ms for physics. Same configuration,
//! same bits: no clock, one stream of chance per subsystem, fixed order of every loop, `geometry::math` only.
//!
//! **Invariants.** It never links `host`; robots learn of the truth through [`sensors`] alone; no I/O but the back end's.
#![forbid(unsafe_code)]

mod air;
mod fault;
mod hash;
mod mcu;
mod meter;
mod native;
mod opponents;
mod parameters;
mod qemu;
mod referee;
mod rng;
mod scenario;
pub mod sensors;
mod simulation;
pub mod small_size;
mod trace;
mod words;
pub mod world;

pub use air::{Air, AirCounts, AirSettings, Bursts, LinkLoss};
pub use fault::{Fault, ScheduledFault};
pub use hash::Fnv;
pub use mcu::{Backend, Mcu, McuError, Reply};
pub use meter::{ByTeam, Meter, Metered};
pub use native::{NativeBackend, NativeMcu};
pub use opponents::{Conduct, Opponent, Role};
pub use parameters::{FOUR_LEGGED_TOML, Noise, ParameterError, Parameters, Region};
pub use qemu::QemuBackend;
pub use referee::{Configuration, Outcome, Party, Referee, Verdict};
pub use rng::Stream;
pub use scenario::{Layout, Placed, Scenario, TEAM};
pub use simulation::{Heard, Sent, Simulation, SimulationConfig, SimulationError, TICK_US, Tick};
pub use trace::TraceHash;
