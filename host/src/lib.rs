//! `host`: the host of a Small Size team: vision and referee in, commands to robots out. Runs on the PC.
//!
//! # Layers
//!
//! From the lowest; a layer uses those above it in this table only.
//!
//! | layer | modules | does |
//! |---|---|---|
//! | models | [`world`], [`field_geometry`] | what is known of robots, ball and field |
//! | sensing | [`tracking`], [`referee`] | camera frames become a [`world::World`], referee packets a [`referee::Game`] |
//! | deciding | [`strategy`], [`external`], [`robot_test`] | a [`strategy::View`] becomes an order for every robot, with its reason |
//! | sending | [`radio`], [`learned`] | orders become frames; robots' frames become telemetry and link quality |
//! | host | [`Host`], [`config`] | all of that as one value, and its settings |
//! | around it | [`shell`], [`record`], [`health_checks`] | sockets, serial lines and processes; recordings and their replay; checks of field, network and computer |
//!
//! The host links neither `brain` nor `hil-sim`: it knows robots by `protocol` and the field by `ssl` only.
//!
//! # One tick
//!
//! A camera frame starts it ([`Input::Vision`]); the host has no period of its own.
//!
//! 1. [`tracking::Tracker`] merges the frame into the world and extrapolates it to now.
//! 2. [`strategy::View::of`] turns the world so that the team attacks towards +x.
//! 3. [`strategy::Coach::decide`] orders every robot by the referee's phase; a strategy in another program,
//!    or a robot's test, may replace orders.
//! 4. Each [`strategy::Order`] becomes a command; its kick is corrected by what was learned of the robot.
//! 5. [`radio::Radio::offer`] packs snapshot and commands into frames.
//!
//! # Inputs and outputs
//!
//! Sans-IO: bytes and times come from the caller by [`Host::handle`], which returns an [`InputVerdict`].
//! [`Host::poll_packet`] gives the frames for robots, [`Host::poll_request`] requests to the game controller,
//! [`Host::poll_view`] the view for a strategy in another program, [`Host::poll_timeout`] the next deadline.
//! The same inputs at the same times give the same decisions: a trace of the inputs is a recording of them.
//!
//! # What is where
//!
//! Passes: [`strategy::pass`]. Defence: [`strategy::threat`]. Free kicks: [`strategy::coerce`]. Choice
//! between actions: [`strategy::rated`]. Cases: [`strategy::case_candidate`]. Legal places:
//! [`strategy::restart`]. Kicks and flights of the ball: [`tracking`]. Several referees at once: [`referee`].
//! Settings and their ranges: [`config`].
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

pub mod config;
pub mod external;
pub mod field_geometry;
pub mod glance;
pub mod health_checks;
mod hex;
mod host;
pub mod learned;
pub mod practice;
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
