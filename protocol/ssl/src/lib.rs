//! `ssl`: the Small Size League's messages, sockets and log files. Runs on the PC.
//!
//! One module a protobuf package, as `prost` structs written by hand: no protoc, no build script. Names are
//! the league's without `SSL_`; a field is a plain value where the league requires it, an `Option` where it
//! does not. Enums are kept as the number on the wire, so that unknown ones survive; the accessor of the
//! field's name reads an unknown number as the enum's first value, `Enum::try_from(number)` distinguishes it.
//!
//! | module | message on the wire | address |
//! |---|---|---|
//! | [`vision`] | [`vision::WrapperPacket`] | UDP 224.5.23.2:10006, simulators 10020 |
//! | [`vision::legacy`] | [`vision::legacy::WrapperPacket`] | UDP 224.5.23.2:10005, until 2014 |
//! | [`referee`], [`event`] | [`referee::Referee`] | UDP 224.5.23.1:10003 |
//! | [`tracker`] | [`tracker::TrackerWrapperPacket`] | UDP 224.5.23.2:10010 |
//! | [`simulation`] | [`simulation::SimulatorCommand`], [`simulation::RobotControl`] | UDP, 10300; 10301 blue, 10302 yellow |
//! | [`simulation`] | [`simulation::GrsimPacket`], [`simulation::RobotsStatus`] | UDP, grSim's own: 20011; 30011 blue, 30012 yellow |
//! | [`controller`] | [`controller::TeamToController`] and its kin | TCP 10007, 10008, length-delimited |
//! | [`controller::ci`] | [`controller::ci::CiInput`], [`controller::ci::CiOutput`] | TCP 10009, length-delimited |
//!
//! [`net`] has the sockets, [`stream`] the framing on TCP, [`log`] the log files of matches.
//!
//! Receiving vision, for example:
//!
//! ```no_run
//! use std::time::Duration;
//! use ssl::net::{Interfaces, Receiver, addresses};
//! use ssl::vision::Decoder;
//!
//! let mut decoder = Decoder::default(); // any message decodes by itself; this one takes no memory
//! let mut receiver = Receiver::join(addresses::VISION, &Interfaces::All)?;
//! while let Some(datagram) = receiver.receive(Duration::from_secs(2))? {
//!     match decoder.decode(datagram.bytes) {
//!         Ok(packet) => println!("{:?}", packet.detection),
//!         Err(error) => eprintln!("from {}: {error}", datagram.from),
//!     }
//! }
//! eprintln!("no vision for two seconds on {:?}", receiver.joined());
//! # Ok::<(), ssl::net::NetError>(())
//! ```
//!
//! **Units differ**: vision uses mm, all others m; the referee µs, vision and trackers s. Each module and
//! each field states its own. The README lists the traps of the league's programs and which test holds each.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

#[macro_use]
mod messages;

pub mod common;
pub mod controller;
pub mod event;
pub mod log;
pub mod net;
pub mod referee;
pub mod simulation;
pub mod stream;
pub mod tracker;
pub mod vision;
mod wire;

pub use prost::{DecodeError, Message, UnknownEnumValue};
