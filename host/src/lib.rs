//! `host`: the host of a Small Size team: vision and referee in, commands to robots out. Runs on the PC.
//!
//! Sans-IO: bytes and times come from the caller, frames go back to it; sockets and serial lines belong to
//! the shell.
//!
//! **Invariants.** It never links `brain` or `hil-sim`: it knows robots by `protocol` and the field by `ssl`
//! only. Same input, same decisions.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

pub mod config;
pub mod external;
pub mod field_geometry;
pub mod health_checks;
mod hex;
mod host;
pub mod learned;
pub mod radio;
pub mod record;
pub mod referee;
mod requests;
pub mod robot_test;
pub mod run;
pub mod shell;
pub mod strategy;
pub mod tracking;
pub mod world;

pub use host::{Drill, Host, HostSettings, Input, InputVerdict, Undecodable};
pub use strategy::cases_of;
