//! `feed`: pictures of a match for the page. A live match, a host or a recording becomes a [`page::Scene`]
//! some 25 times a second.
//!
//! [`Composer`] fills scenes from hosts, the same for a simulated match, a real field and a recording;
//! [`MatchRunner`] plays a match beside its page; [`recording`] reads traces and league log files;
//! [`CaseExplanations`] answers why a case was chosen, and serves the case workbench. Nothing here decides,
//! prints or ends the program: callers pass in the page, the log and the flag that ends a run.
//!
//! m, s, rad, field frame.
#![forbid(unsafe_code)]
#![deny(clippy::print_stdout, clippy::print_stderr)]
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod beliefs;
mod cameras;
mod composer;
mod cycles;
mod decided;
mod description;
mod explanations;
mod gauges;
mod layers;
mod ledger_feed;
mod legged;
mod match_events;
mod match_runner;
mod minds;
mod moment_source;
mod names;
mod overlay_builder;
mod overlay_input;
mod parameter_feed;
mod paths;
mod possession;
mod raw;
pub mod recording;
mod referee_event;
mod snapshots;
mod tactics;
#[cfg(test)]
mod tests;
mod windows;
mod workbench;

pub use composer::{Composer, Moment, field_of, scene_of};
pub use description::spaced;
pub use explanations::{CaseExplanations, explained};
pub use gauges::tick;
pub use ledger_feed::LedgerFeed;
pub use legged::Legged;
pub use match_runner::{End, MatchObserver, MatchRunner, RunSettings, command_of};
pub use moment_source::{MomentSource, RecentMoments};
pub use parameter_feed::{ParameterFeed, change_of, test_of};
pub use snapshots::{SnapshotRequest, Snapshots};
pub use workbench::{SharedLibrary, refusals};

use page::PageTeam;
use rules::Colour;

/// Period of scenes, s: smooth motion, with the page interpolating in between.
pub const SCENE_EVERY_S: f64 = 0.04;

/// A colour in the page's format.
pub const fn team(colour: Colour) -> PageTeam {
    match colour {
        Colour::Blue => PageTeam::Blue,
        Colour::Yellow => PageTeam::Yellow,
    }
}

/// The inverse of [`team`].
pub const fn colour(team: PageTeam) -> Colour {
    match team {
        PageTeam::Blue => Colour::Blue,
        PageTeam::Yellow => Colour::Yellow,
    }
}
