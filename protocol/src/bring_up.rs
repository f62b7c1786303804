//! `bring_up`: the checks of a robot's first start, what each can find, and the frame by which a robot tells
//! the host how each stands (protocol/SPEC.md, BringUpReport). Units are SI.
//!
//! Such a frame's payload begins with [`KIND`], which is no [`TeamMessage`](crate::team::TeamMessage): the
//! images that play, and their host, do not know it. It is sealed under the robot's own key, as telemetry is;
//! robots do not open it, and `onetwo control` refuses it for its payload. [`Frame`]'s epoch and counter
//! order the frames, and [`BringUpReport::host`] distinguishes a robot that is on from a recording.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::frame::{Frame, Key, OVERHEAD, Refusal, Sender, TeamKeys, open_report, packet};
use crate::link::Packet;
use crate::parts::wheel_name;
use crate::team::TEAM_MESSAGE_LEN_MAX;
use crate::{RobotId, TeamId};

/// A check of the list; as text what is checked, and what a person has to see or do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
pub enum Check {
    /// The battery's voltage is measured, and within that of four cells.
    #[error("battery: nothing moves")]
    Battery,
    /// At rest wheels stand, the gyroscope knows its offset and the robot does not lie on its side.
    #[error("sensors at rest: leave the robot alone")]
    Rest,
    /// One wheel turns the way it is driven, and no other does.
    #[error("{} wheel: it turns, as to turn the robot {}", wheel_name(*wheel), way(*forwards))]
    Wheel {
        /// 0 to 3: front right, back right, back left, front left.
        wheel: u8,
        /// Direction: the rim runs to the left, seen from the robot's centre, as if to turn the robot
        /// counter-clockwise.
        forwards: bool,
    },
    /// Frames of the host arrive.
    #[error("radio: a host of its team sends")]
    Radio,
    /// The beam is interrupted by a ball that is held before the dribbler, and free again without it.
    #[error("break-beam sensor: hold a ball before the dribbler, then take it away")]
    Beam,
}

/// The list, in its order: what others rest on first.
pub const CHECKS: [Check; 12] = [
    Check::Battery,
    Check::Rest,
    wheel(0, true),
    wheel(0, false),
    wheel(1, true),
    wheel(1, false),
    wheel(2, true),
    wheel(2, false),
    wheel(3, true),
    wheel(3, false),
    Check::Radio,
    Check::Beam,
];

const fn wheel(wheel: u8, forwards: bool) -> Check {
    Check::Wheel { wheel, forwards }
}

impl Check {
    /// Index in [`CHECKS`]; `None` of a wheel that does not exist.
    pub fn number(self) -> Option<usize> {
        CHECKS.iter().position(|known| *known == self)
    }

    /// Unit of what it measures when it passes.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Battery => "V",
            Self::Rest => "rad/s",
            Self::Wheel { .. } => "m/s",
            Self::Radio => "frames",
            Self::Beam => "s",
        }
    }
}

const fn way(forwards: bool) -> &'static str {
    if forwards { "counter-clockwise" } else { "clockwise" }
}

/// Fault that a check has found; as text what was measured, and what to look at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Error)]
pub enum Finding {
    /// The battery's voltage is not measured.
    #[error("no voltage is measured: the divider's wire")]
    NoVoltage,
    /// The battery's voltage, V, is none of four cells.
    #[error("{0:.1} V is none of four cells: charge it, or measure the divider")]
    Voltage(f32),
    /// No gyroscope answers, or it never came to rest.
    #[error("no gyroscope: power, wires and chip select of the IMU; was it moved?")]
    NoGyroscope,
    /// The turning rate at rest, rad/s.
    #[error("it turns by {0:.2} rad/s at rest: the IMU is loose, or was moved")]
    Drifts(f32),
    /// The robot lies on its side, by its accelerometer.
    #[error("it lies on its side, says the IMU: its z axis must point up")]
    Tipped,
    /// This wheel moves although none is driven, m/s.
    #[error("the {} wheel runs {:.2} m/s by itself: encoder's ground and shield, or a driver that is always on", wheel_name(*.0), .1)]
    MovesAlone(u8, f32),
    /// This wheel's encoder is known to be broken.
    #[error("the {} wheel's encoder is broken: cable and supply", wheel_name(*.0))]
    NoEncoder(u8),
    /// The wheel is driven and no encoder sees anything.
    #[error("nothing turns: motor's cable, its driver and its enable; if it does turn, the encoder's cable")]
    NoMotion,
    /// The wheel runs the wrong way, m/s.
    #[error(
        "it runs the wrong way, {0:.2} m/s: if it looks right, swap the encoder's two lines, else two phases or the direction's wire"
    )]
    Reversed(f32),
    /// Another wheel's encoder counts in its place, m/s.
    #[error("the encoder of the {} wheel counts {:.2} m/s in its place: swap the two encoders' cables, or the two motors'", wheel_name(*.0), .1)]
    CountedBy(u8, f32),
    /// Another wheel moves too, m/s.
    #[error("the {} wheel moves too, {:.2} m/s: a driver's inputs are joined", wheel_name(*.0), .1)]
    MovesToo(u8, f32),
    /// Speed of the wheel, and that by the motor's constant, m/s.
    #[error("{0:.2} m/s, not {1:.2}: gear, friction, lines of the encoder, or the wheel's radius")]
    Speed(f32, f32),
    /// The wheel does not stop without current, m/s.
    #[error("{0:.2} m/s a second after its current was off: its driver's enable")]
    KeepsTurning(f32),
    /// No frame and no noise was received.
    #[error("nothing received: is a host of its team running; power and wires of the radio")]
    Silent,
    /// Frames received and lost.
    #[error("{} of {} frames lost: antenna, plug, channel", .1, .0.saturating_add(*.1))]
    Loses(u32, u32),
    /// Errors of the line, and frames received.
    #[error("{0} errors on the radio's line beside {1} frames: its rate, ground and plug")]
    LineErrors(u32, u32),
    /// The beam is interrupted without a ball.
    #[error("interrupted without a ball: align lamp and sensor; daylight")]
    Blocked,
    /// The beam was never interrupted.
    #[error("never interrupted: lamp and sensor face each other behind the ball, or its wire is stuck")]
    NeverInterrupted,
    /// The beam stayed interrupted.
    #[error("still interrupted after the ball was taken away, or it was not taken away")]
    StaysInterrupted,
}

/// The result of a check; what passed has the value that was measured, in the check's unit (V, rad/s, m/s,
/// frames received, s of interruption).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckReport {
    /// The check that has ended.
    pub check: Check,
    /// Measured value, or the fault.
    pub result: Result<f32, Finding>,
}

/// State of a check.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CheckState {
    /// The check runs, or waits for a person.
    Running,
    /// The check passed, with the measured value.
    Passed(f32),
    /// The check found this fault.
    Failed(Finding),
}

impl From<Result<f32, Finding>> for CheckState {
    fn from(result: Result<f32, Finding>) -> Self {
        result.map_or_else(Self::Failed, Self::Passed)
    }
}

/// A robot reports the state of one of its checks to the host; each is repeated, so that a lost frame
/// only delays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BringUpReport {
    /// Epoch of the newest frame of a host of its team that the robot has received, 0 without one. Its tag
    /// was not checked: it shows that the report is not older than that host.
    #[serde(with = "postcard::fixint::le")]
    pub host: u32,
    /// The check that is reported.
    pub check: Check,
    /// State of the check.
    pub state: CheckState,
}

/// The payload's first byte.
pub const KIND: u8 = crate::team::BRING_UP;
/// The longest payload: kind, host, a wheel's check, and a finding with two counts.
const REPORT_LEN_MAX: usize = 1 + 4 + 3 + 1 + 1 + 10;

/// Robot that seals reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reporter {
    /// Team of the robot.
    pub team: TeamId,
    /// Number of the robot.
    pub robot: RobotId,
    /// Key of the robot with the host.
    pub key: Key,
    /// Boot epoch of the robot.
    pub epoch: u32,
}

impl Reporter {
    /// The packet that carries `report`; `counter` must rise with each.
    pub fn seal(&self, counter: u32, report: &BringUpReport) -> Packet {
        self.seal_as(counter, KIND, report)
    }

    /// The same of another report, whose payload begins with `kind`.
    pub fn seal_as(&self, counter: u32, kind: u8, report: &impl Serialize) -> Packet {
        let mut payload = [0; TEAM_MESSAGE_LEN_MAX];
        // A report always fits (tested with the longest there is); if it did not, silence is the safe answer.
        let Ok(payload) = postcard::to_slice(&(kind, report), &mut payload) else { return Packet::new() };
        let (team, sender, epoch) = (self.team, Sender::Robot(self.robot), self.epoch);
        packet(&Frame { team, sender, audience: None, epoch, counter, payload }, &self.key)
    }
}

/// Reads a genuine report. Order and repetition are the reader's to judge
/// ([`Sessions`](crate::frame::Sessions)).
pub fn open<'a>(
    packet: &'a [u8],
    team: TeamId,
    keys: &TeamKeys,
) -> Result<(Frame<'a>, RobotId, BringUpReport), Refusal> {
    let (frame, robot, report) = open_report::<BringUpReport>(packet, (team, keys), KIND)?;
    report.check.number().map(|_| (frame, robot, report)).ok_or(Refusal::Payload)
}

const _: () = assert!(OVERHEAD + REPORT_LEN_MAX <= 40, "as short as a command");

#[cfg(test)]
mod tests;
