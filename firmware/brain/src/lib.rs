//! What does a robot do next? The robot's logic, sans-IO (DESIGN §3, §5; Ros et al. 2009 §4–§5).
#![no_std]

mod config;
mod station;

pub use config::{Approach, BrainConfig, Positioning};
pub use station::Station;

use casebase::CaseBase;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::team::TeamMessage;
use protocol::{Instant, RobotId};

/// A robot's brain.
pub struct Brain<'a> {
    _base: CaseBase<'a>,
}

#[allow(missing_docs, clippy::unused_self)]
impl<'a> Brain<'a> {
    pub fn new(_now: Instant, _config: &BrainConfig, base: CaseBase<'a>) -> Self {
        Self { _base: base }
    }
    pub fn handle_team_message(&mut self, _now: Instant, _from: RobotId, _message: &TeamMessage) {}
    pub fn handle_sensors(&mut self, _now: Instant, _sensors: &SensorFrame) {}
    pub fn handle_timeout(&mut self, _now: Instant) {}
    pub fn poll_message(&mut self, _now: Instant) -> Option<TeamMessage> {
        None
    }
    pub fn poll_actuators(&mut self, _now: Instant) -> Option<ActuatorFrame> {
        None
    }
    pub fn poll_timeout(&self) -> Option<Instant> {
        None
    }
}
