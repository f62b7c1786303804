//! `decision`: a coordinator's decision with the problem it decided on, for the host (protocol/SPEC.md,
//! "DecisionPart").
//!
//! What a robot believed when it retrieved is known to it alone: the host's view of that moment is another.
//! So it reports the problem itself, cut into parts that each fit a frame; the host puts them together.

use geometry::GoalEnd;
use serde::{Deserialize, Serialize};

use crate::quantized::WirePoint;
use crate::{CaseId, CycleId, RobotId};

/// Most robots of a team in a problem.
pub const TEAM_MAX: usize = 11;
/// Bytes of a report in one part: as many as the frame holds (docs/architecture.md §6.1).
pub const PART_LEN: usize = 36;
/// Parts of the longest report.
pub const PARTS_MAX: usize = REPORT_LEN_MAX.div_ceil(PART_LEN);

/// Bytes before the robots: grounds, case, ball, which teammates, number of opponents.
const HEAD_LEN: usize = 1 + 2 + 4 + 2 + 1;
const REPORT_LEN_MAX: usize = HEAD_LEN + 2 * TEAM_MAX * 4;
/// The case of a report without one.
const NO_CASE: u16 = u16::MAX;

/// Grounds of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grounds {
    /// Retrieval's answer to the problem, whatever it was.
    Retrieved,
    /// The best case gives another robot the ball than this one, which holds it: no case.
    Holds(RobotId),
    /// The ball rolls and no robot has it: not retrieved.
    BallRolls,
    /// The host proposed the case.
    Proposed,
    /// The reactive behaviour was expected to shoot sooner than the best case: no case.
    ShootsSooner,
    /// No ball was known: there was no problem, and the report's robots and ball say nothing.
    NoBall,
}

/// A decision, and the problem on which it was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecisionReport {
    /// The cycle that it decided.
    pub cycle: CycleId,
    /// Grounds of the decision.
    pub grounds: Grounds,
    /// The case that is played; `None` for "no case fits".
    pub case: Option<CaseId>,
    /// The goal that the team defends.
    pub defending: GoalEnd,
    /// The ball retrieved with, mm, field frame.
    pub ball: WirePoint,
    /// The robots that could have been given a part, by number, mm, field frame.
    pub teammates: heapless::Vec<(RobotId, WirePoint), TEAM_MAX>,
    /// The opponents, mm, field frame.
    pub opponents: heapless::Vec<WirePoint, TEAM_MAX>,
}

/// A part of a [`DecisionReport`] on the radio.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DecisionPart {
    /// The cycle that was decided.
    pub cycle: CycleId,
    /// Number of the part, from 0.
    pub part: u8,
    /// Number of parts of the whole report.
    pub parts: u8,
    /// Bytes of the report; all parts but the last are full.
    pub bytes: heapless::Vec<u8, PART_LEN>,
}

/// A [`DecisionReport`] as bytes: half its size, as robots keep it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedReport {
    cycle: CycleId,
    bytes: heapless::Vec<u8, REPORT_LEN_MAX>,
}

impl PackedReport {
    /// Number of parts of the whole report.
    pub fn parts(&self) -> u8 {
        self.bytes.len().div_ceil(PART_LEN) as u8
    }

    /// Part `part` of it; empty beyond the last.
    pub fn part(&self, part: u8) -> DecisionPart {
        let mut bytes = heapless::Vec::new();
        for byte in self.bytes.iter().skip(usize::from(part) * PART_LEN).take(PART_LEN) {
            // As many as a part holds.
            let _room = bytes.push(*byte);
        }
        DecisionPart { cycle: self.cycle, part, parts: self.parts(), bytes }
    }

    /// The report, once all parts are there and decode.
    pub fn report(&self) -> Option<DecisionReport> {
        DecisionReport::parse(self.cycle, &self.bytes)
    }
}

impl DecisionReport {
    /// The report as it is kept and sent.
    pub fn packed(&self) -> PackedReport {
        PackedReport { cycle: self.cycle, bytes: self.bytes() }
    }

    fn bytes(&self) -> heapless::Vec<u8, REPORT_LEN_MAX> {
        let mut out = heapless::Vec::new();
        let (kind, robot) = match self.grounds {
            Grounds::Retrieved => (0, 0),
            Grounds::Holds(robot) => (1, robot.number()),
            Grounds::BallRolls => (2, 0),
            Grounds::Proposed => (3, 0),
            Grounds::ShootsSooner => (4, 0),
            Grounds::NoBall => (5, 0),
        };
        let positive = u8::from(self.defending == GoalEnd::Positive);
        let case = self.case.map_or(NO_CASE, |case| case.0);
        let among = self.teammates.iter().fold(0u16, |set, (id, _)| set | 1 << id.number());
        // The capacity is that of the longest report: everything fits.
        let _ = out.push(kind | robot << 3 | positive << 7);
        let _ = out.extend_from_slice(&case.to_le_bytes());
        let _ = out.extend_from_slice(&point_bytes(self.ball));
        let _ = out.extend_from_slice(&among.to_le_bytes());
        let _ = out.push(self.opponents.len() as u8);
        // By number: the receiver has the numbers as a set.
        for id in RobotId::all().filter(|id| among >> id.number() & 1 == 1) {
            if let Some((_, at)) = self.teammates.iter().find(|(teammate, _)| *teammate == id) {
                let _ = out.extend_from_slice(&point_bytes(*at));
            }
        }
        for at in &self.opponents {
            let _ = out.extend_from_slice(&point_bytes(*at));
        }
        out
    }

    /// The report of these bytes; `None` where they are none.
    fn parse(cycle: CycleId, bytes: &[u8]) -> Option<Self> {
        let (head, rest) = bytes.split_first_chunk::<HEAD_LEN>()?;
        let [grounds, c0, c1, x0, x1, y0, y1, m0, m1, count] = *head;
        let robot = RobotId::new(grounds >> 3 & 0xf)?;
        let among = u16::from_le_bytes([m0, m1]);
        let (places, odd) = rest.as_chunks::<4>();
        let ours = among.count_ones() as usize;
        if !odd.is_empty() || places.len() != ours + usize::from(count) {
            return None;
        }
        let (ours, theirs) = places.split_at_checked(ours)?;
        let mut teammates = heapless::Vec::new();
        let ids = RobotId::all().filter(|id| among >> id.number() & 1 == 1);
        for (id, at) in ids.zip(ours) {
            teammates.push((id, point_of(*at))).ok()?;
        }
        let mut opponents = heapless::Vec::new();
        for at in theirs {
            opponents.push(point_of(*at)).ok()?;
        }
        let case = u16::from_le_bytes([c0, c1]);
        Some(Self {
            cycle,
            grounds: match grounds & 7 {
                0 => Grounds::Retrieved,
                1 => Grounds::Holds(robot),
                2 => Grounds::BallRolls,
                3 => Grounds::Proposed,
                4 => Grounds::ShootsSooner,
                5 => Grounds::NoBall,
                _ => return None,
            },
            case: (case != NO_CASE).then_some(CaseId(case)),
            defending: if grounds >> 7 == 1 { GoalEnd::Positive } else { GoalEnd::Negative },
            ball: point_of([x0, x1, y0, y1]),
            teammates,
            opponents,
        })
    }
}

/// Puts a robot's reports together.
#[derive(Clone, Debug, Default)]
pub struct Assembler {
    cycle: Option<CycleId>,
    parts: [Option<heapless::Vec<u8, PART_LEN>>; PARTS_MAX],
    done: bool,
}

impl Assembler {
    /// Takes a part in any order; returns a report once, when it is whole.
    pub fn receive(&mut self, part: &DecisionPart) -> Option<DecisionReport> {
        if self.cycle != Some(part.cycle) {
            *self = Self { cycle: Some(part.cycle), ..Self::default() };
        }
        let parts = usize::from(part.parts);
        if self.done || parts > PARTS_MAX || part.part >= part.parts {
            return None;
        }
        *self.parts.get_mut(usize::from(part.part))? = Some(part.bytes.clone());
        let mut bytes: heapless::Vec<u8, { PARTS_MAX * PART_LEN }> = heapless::Vec::new();
        for piece in self.parts.iter().take(parts) {
            bytes.extend_from_slice(piece.as_ref()?).ok()?;
        }
        self.done = true;
        DecisionReport::parse(part.cycle, &bytes)
    }
}

/// A point on the wire: x, then y, low byte first.
fn point_bytes(at: WirePoint) -> [u8; 4] {
    let ([a, b], [c, d]) = (at.x.to_le_bytes(), at.y.to_le_bytes());
    [a, b, c, d]
}

fn point_of([a, b, c, d]: [u8; 4]) -> WirePoint {
    WirePoint { x: i16::from_le_bytes([a, b]), y: i16::from_le_bytes([c, d]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::team::{TEAM_MESSAGE_LEN_MAX, TeamMessage};

    fn point(n: i16) -> WirePoint {
        WirePoint { x: 1000 - 37 * n, y: -n }
    }

    fn report(ours: u8, theirs: u8) -> DecisionReport {
        DecisionReport {
            cycle: CycleId { counter: u32::MAX, proposer: RobotId::ZERO },
            grounds: Grounds::Holds(RobotId::new(15).unwrap()),
            case: Some(CaseId(300)),
            defending: GoalEnd::Positive,
            ball: WirePoint { x: -32768, y: 32767 },
            teammates: (0..ours).map(|n| (RobotId::new(15 - n).unwrap(), point(n.into()))).rev().collect(),
            opponents: (0..theirs).map(|n| point(100 + i16::from(n))).collect(),
        }
    }

    #[test]
    fn a_report_survives_the_radio_in_any_order_and_doubled() {
        for (ours, theirs) in [(0, 0), (1, 6), (5, 6), (11, 11)] {
            let sent = report(ours, theirs);
            let packed = sent.packed();
            assert_eq!(packed.report().as_ref(), Some(&sent));
            let mut assembler = Assembler::default();
            let mut whole = heapless::Vec::<_, 4>::new();
            for part in (0..packed.parts()).rev().chain(0..packed.parts()) {
                whole.extend(assembler.receive(&packed.part(part)));
            }
            assert_eq!(whole, [sent], "{ours} and {theirs}");
        }
    }

    #[test]
    fn parts_of_two_cycles_are_never_joined() {
        let (old, mut new) = (report(5, 6), report(5, 6));
        new.cycle.counter = 1;
        let mut assembler = Assembler::default();
        assert_eq!(assembler.receive(&old.packed().part(0)), None);
        assert_eq!(assembler.receive(&new.packed().part(1)), None);
        assert_eq!(assembler.receive(&old.packed().part(1)), None);
    }

    #[test]
    fn bytes_that_are_no_report_are_refused() {
        let cycle = report(0, 0).cycle;
        for bytes in [&[][..], &[7; HEAD_LEN], &[0; HEAD_LEN - 1], &[0, 0, 0, 0, 0, 0, 0, 0, 0, 9]] {
            let bytes = bytes.iter().copied().collect();
            assert_eq!(Assembler::default().receive(&DecisionPart { cycle, part: 0, parts: 1, bytes }), None);
        }
        let part = |part, parts| DecisionPart { cycle, part, parts, bytes: heapless::Vec::new() };
        assert_eq!(Assembler::default().receive(&part(3, 255)), None);
        assert_eq!(Assembler::default().receive(&part(0, 0)), None);
    }

    #[test]
    fn the_longest_part_fits_its_budget() {
        let message = TeamMessage::Decision(report(11, 11).packed().part(0));
        let mut out = [0; 128];
        let n = postcard::to_slice(&message, &mut out).unwrap().len();
        assert!(n <= TEAM_MESSAGE_LEN_MAX, "{n} bytes");
    }
}
