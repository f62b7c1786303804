//! `input`: inputs of a host, and their results.

use protocol::RobotId;
use protocol::frame::Refusal;

use crate::config::ConfigError;
use crate::external::AnswerError;
use crate::referee::{self, SenderAddress};
use crate::robot_test::TestRefused;
use crate::tracking;

/// An input of the host.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a> {
    /// A datagram of the vision.
    Vision(&'a [u8]),
    /// A datagram of the referee, and its sender.
    Referee(&'a [u8], SenderAddress),
    /// A frame of a robot.
    Robot(&'a [u8]),
    /// A line of the strategy in another program ([`crate::external`]).
    Orders(&'a [u8]),
    /// The operator changes a parameter: the JSON of a
    /// [`ParameterChange`](crate::config::ParameterChange).
    Parameter(&'a [u8]),
    /// The operator begins or ends a test of a kicker, or drives a robot by hand: the JSON of a
    /// [`TestOrder`](crate::robot_test::TestOrder).
    Test(&'a [u8]),
    /// The operator halts our robots until the end of the program.
    Halt,
    /// A deadline that [`Host::poll_timeout`](crate::Host::poll_timeout) announced.
    Timeout,
}

/// Outcome of an input.
#[derive(Clone, Debug, PartialEq)]
pub enum InputVerdict {
    /// A camera frame or geometry.
    Vision(tracking::VisionVerdict),
    /// A packet of the referee.
    Referee(Box<referee::RefereeVerdict>),
    /// A frame of this robot was accepted.
    Robot(RobotId),
    /// A frame that was refused.
    Refused(Refusal),
    /// Orders of the strategy in another program.
    Orders,
    /// A line of that program that is no answer.
    NoAnswer(AnswerError),
    /// A datagram that is no message.
    Undecodable,
    /// A deadline was handled.
    Timeout,
    /// A parameter has another value.
    Changed,
    /// A change that is refused; nothing changed.
    NotChanged(ConfigError),
    /// A test begins or ends.
    Test,
    /// A test that does not begin; a running one goes on.
    NoTest(TestRefused),
    /// Our robots halt until the end.
    Halted,
}

/// Datagrams that were no messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Undecodable {
    /// Number on vision's port.
    pub vision: u64,
    /// Number on the referee's port.
    pub referee: u64,
    /// Number on vision's port that are decodable, but have neither camera frame nor field: possibly another
    /// program's messages.
    pub empty: u64,
}
