//! `four_legged`: trials of walking robots: world, sensors, opponents, referee and main loop. mm in files, SI
//! in code, field frame; Ros et al. 2009 §5.

pub(crate) mod camera;
pub(crate) mod drift;
pub(crate) mod fault;
pub(crate) mod opponents;
pub(crate) mod parameters;
pub(crate) mod referee;
pub(crate) mod scenario;
pub mod sensors;
pub(crate) mod simulation;
pub(crate) mod trace;
pub mod world;
pub(crate) mod world_hash;
