//! `rules`: rules of the leagues. Dimensions, limits, keep-out areas, restarts, offences and the state of a
//! game, SI, field frame.
//!
//! [`FieldSpec`] and [`League`] are data; [`limits`] are the rules' numbers; [`RobotSpec`] holds every number
//! of our own robots, [`contact`] how near a robot is to a ball that it touches; [`keep_out`] defines where a
//! robot must not be, [`restart`] where the ball goes, [`legality`] what is an offence, [`state`] what a
//! referee's command means.
//!
//! **Invariants.** No I/O, no clock, no allocation. One source per fact: physics, brains, referee and
//! renderings read the dimensions here.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod contact;
mod field;
mod game;
pub mod keep_out;
mod league;
pub mod legality;
pub mod limits;
pub mod restart;
mod robot;
pub mod state;

pub use field::{AREA_SHAPES_MAX, AreaForm, FieldFault, FieldSpec, LANDMARKS};
pub use game::{Colour, Phase, RuleRole, Side};
pub use league::{BallSpec, Footprint, League};
pub use limits::Limits;
pub use robot::{
    AssumedSpec, BatterySpec, BreakBeamSpec, DribblerSpec, DriveSpec, GovernorSpec, HardwareSpec, HullSpec,
    ImuModel, ImuSpec, KickerSpec, MotorScheme, PartsSpec, RadioLine, RobotSpec, TurnSpec, TypicalSpec,
    WheelSpec,
};
