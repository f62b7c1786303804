//! `parts`: which parts of a robot work, as it estimates itself and reports to its host (protocol/SPEC.md,
//! PartsReport).
//!
//! Such a frame's payload begins with [`KIND`], which is no [`TeamMessage`](crate::team::TeamMessage): hosts
//! of before refuse it for its payload. It is sealed under the robot's own key, as telemetry is.

use core::fmt;

/// First byte of the payload.
pub const KIND: u8 = 8;
/// Bytes of the payload.
pub const PAYLOAD_LEN: usize = 10;
/// Parts that a report can name.
pub const PARTS: u8 = 12;

/// A part of a robot on wheels: motors with their drivers 0 to 3, encoders 4 to 7 in the order of the wheels,
/// the gyroscope, 8, the break-beam sensor, 9, the kicker's capacitor with its charger, 10, the radio, 11.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Part(u8);

impl Part {
    /// The gyroscope.
    pub const GYROSCOPE: Self = Self(8);
    /// The break-beam sensor.
    pub const BREAK_BEAM: Self = Self(9);
    /// The kicker's capacitor and its charger.
    pub const CHARGER: Self = Self(10);
    /// The radio chip, or the line to it.
    pub const RADIO: Self = Self(11);

    /// Motor and driver of a wheel, 0 to 3.
    pub const fn motor(wheel: u8) -> Self {
        Self(wheel & 3)
    }

    /// Encoder of a wheel, 0 to 3.
    pub const fn encoder(wheel: u8) -> Self {
        Self(4 + (wheel & 3))
    }

    /// Number of the part, below [`PARTS`].
    pub const fn number(self) -> u8 {
        self.0
    }

    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..PARTS).map(Self)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            wheel @ 0..4 => write!(f, "{} motor or its driver", wheel_name(wheel)),
            wheel @ 4..8 => write!(f, "{} encoder", wheel_name(wheel - 4)),
            8 => f.write_str("gyroscope"),
            9 => f.write_str("break-beam sensor"),
            10 => f.write_str("capacitor or its charger"),
            _ => f.write_str("radio or its line"),
        }
    }
}

/// Name of a wheel by its number, 0 to 3.
pub(crate) fn wheel_name(wheel: u8) -> &'static str {
    ["front right", "back right", "back left", "front left"].get(usize::from(wheel)).copied().unwrap_or("no")
}

/// State of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum PartState {
    /// Nothing speaks against it.
    #[default]
    Ok = 0,
    /// What is measured would be explained by its failure.
    Suspected = 1,
    /// That has lasted; until the robot's next start the part is not used where others replace it.
    Failed = 2,
}

/// State of all parts, and the evidence against one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PartsReport {
    /// Two bits for each part, as [`PartState`] is numbered.
    pub states: u32,
    /// The part of which the rest speaks.
    pub part: u8,
    /// Share of what all parts together do not explain, and the failure of this one does, per mille.
    pub evidence: u16,
    /// How long it is suspected, 0.1 s, saturating.
    pub since: u16,
}

impl PartsReport {
    /// A report of parts that all work.
    pub const fn new() -> Self {
        Self { states: 0, part: 0, evidence: 0, since: 0 }
    }

    /// State of a part.
    pub const fn state(&self, part: Part) -> PartState {
        match self.states >> (2 * part.0) & 3 {
            1 => PartState::Suspected,
            2 => PartState::Failed,
            _ => PartState::Ok,
        }
    }

    /// The same with another state of that part.
    #[must_use]
    pub const fn with(self, part: Part, state: PartState) -> Self {
        let at = 2 * part.0;
        Self { states: self.states & !(3 << at) | (state as u32) << at, ..self }
    }

    /// Parts in that state.
    pub fn in_state(&self, state: PartState) -> impl Iterator<Item = Part> {
        Part::all().filter(move |part| self.state(*part) == state)
    }

    /// Whether nothing speaks against any part.
    pub const fn is_ok(&self) -> bool {
        self.states == 0
    }

    /// Whether every part has the same state in both.
    pub const fn has_states_of(&self, other: &Self) -> bool {
        self.states == other.states
    }

    /// The payload of a frame.
    pub fn payload(&self) -> [u8; PAYLOAD_LEN] {
        let ([a, b, c, d], [e, f]) = (self.states.to_le_bytes(), self.evidence.to_le_bytes());
        let [g, h] = self.since.to_le_bytes();
        [KIND, a, b, c, d, self.part, e, f, g, h]
    }

    /// From a payload; `None` where it is no such report.
    pub fn read(payload: &[u8]) -> Option<Self> {
        let &[KIND, a, b, c, d, part, e, f, g, h] = payload else { return None };
        let states = u32::from_le_bytes([a, b, c, d]);
        let [evidence, since] = [[e, f], [g, h]].map(u16::from_le_bytes);
        let known = states >> (2 * PARTS) == 0 && states & states >> 1 & 0x5555_5555 == 0 && part < PARTS;
        known.then_some(Self { states, part, evidence, since })
    }
}

impl fmt::Display for PartsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (count, part) in Part::all().filter(|part| self.state(*part) != PartState::Ok).enumerate() {
            let state = if self.state(part) == PartState::Failed { "failed" } else { "suspected" };
            write!(f, "{}{part} {state}", if count == 0 { "" } else { ", " })?;
            if part.0 == self.part {
                let (whole, tenth) = (self.since / 10, self.since % 10);
                write!(f, " for {whole}.{tenth} s (explains {} %)", self.evidence / 10)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;
    use std::vec::Vec;

    use super::*;

    #[test]
    fn a_report_is_read_as_it_was_written_and_nothing_else_is() {
        let report = PartsReport { part: 5, evidence: 930, since: 17, ..PartsReport::default() }
            .with(Part::encoder(1), PartState::Failed)
            .with(Part::motor(3), PartState::Suspected)
            .with(Part::GYROSCOPE, PartState::Failed)
            .with(Part::GYROSCOPE, PartState::Ok);
        assert_eq!(PartsReport::read(&report.payload()), Some(report));
        assert_eq!(report.in_state(PartState::Failed).collect::<Vec<_>>(), [Part::encoder(1)]);
        let last = [Part::BREAK_BEAM, Part::CHARGER, Part::RADIO];
        let all_last = last.iter().fold(report, |report, part| report.with(*part, PartState::Failed));
        assert_eq!(PartsReport::read(&all_last.payload()), Some(all_last));
        let said =
            "front left motor or its driver suspected, back right encoder failed for 1.7 s (explains 93 %)";
        assert_eq!(report.to_string(), said);
        let wrong = [(1, 3), (4, 1), (5, PARTS), (0, 7)];
        for (at, byte) in wrong {
            let mut payload = report.payload();
            payload[at] = byte;
            assert_eq!(PartsReport::read(&payload), None, "{at}");
        }
        assert_eq!(PartsReport::read(&report.payload()[1..]), None);
    }
}
