//! `exchange`: exchange of problems and answers with the measured board.
//!
//! Table and problems lie in memory that the firmware image does not use, each behind `length 4 LE | count 4
//! LE`; problems are in the wire format's encoding (postcard). An answer is a line of numbers on the console.

use core::fmt;
use core::str::FromStr;

use casebase::{Match, Problem, Retrieval};

/// Address of the table: the first half of the board's 16 MiB of slow memory, which the firmware image does
/// not use. The flash slot for libraries is too small for the largest one that is measured.
pub const TABLE_ADDRESS: usize = 0x2100_0000;
/// Address of the problems: the second half.
pub const PROBLEMS_ADDRESS: usize = 0x2180_0000;
/// Maximum length of either, bytes, header included.
pub const LEN_MAX: usize = 0x0080_0000;
/// Length of the header before the table and before the first problem, bytes.
pub const HEADER_LEN: usize = 8;

/// The header of a table (`count` 1), or of `count` problems, of `length` bytes.
pub fn header(length: usize, count: usize) -> [u8; HEADER_LEN] {
    let ([a, b, c, d], [e, f, g, h]) = ((length as u32).to_le_bytes(), (count as u32).to_le_bytes());
    [a, b, c, d, e, f, g, h]
}

/// One problem's bytes, at the start of `buffer`; `None` where it is too short (512 bytes are enough).
pub fn encode<'b>(problem: &Problem, buffer: &'b mut [u8]) -> Option<&'b [u8]> {
    postcard::to_slice(problem, buffer).ok().map(|bytes| &*bytes)
}

/// The problems in `memory`, up to the first that cannot be decoded.
pub fn problems(memory: &[u8]) -> impl Iterator<Item = Problem> + '_ {
    let mut rest = behind_header(memory);
    (0..word_at(memory, 4)).map_while(move |_| {
        let (problem, behind) = postcard::take_from_bytes(rest).ok()?;
        rest = behind;
        Some(problem)
    })
}

/// The bytes behind the header, as many as its length field states; none where there are fewer.
pub fn behind_header(memory: &[u8]) -> &[u8] {
    memory.get(HEADER_LEN..HEADER_LEN.saturating_add(word_at(memory, 0))).unwrap_or(&[])
}

fn word_at(memory: &[u8], at: usize) -> usize {
    memory.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).map_or(0, u32::from_le_bytes) as usize
}

/// The board's results for one problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The winner of `retrieve_best`.
    pub best: Found,
    /// The winner of `retrieve`.
    pub counted: Found,
    /// Number of candidates that `retrieve` found for the problem.
    pub candidates: u32,
    /// The winner of the plain scan.
    pub scanned: Found,
    /// Instructions of `retrieve_best`, `retrieve` and the plain scan.
    pub instructions: [u32; 3],
}

/// A retrieval's winner as bits that can be compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// The case, from 1; 0 for none.
    pub case: u32,
    /// Bits of its cost, exponent and similarity.
    pub bits: [u32; 3],
    /// The number of conditions, and the players, 5 bits each.
    pub players: u32,
}

impl Found {
    /// The winner of a retrieval.
    pub fn of(best: Option<&Match>) -> Self {
        let Some(best) = best else { return Self::default() };
        let players = best.correspondence.iter();
        Self {
            case: u32::from(best.case.0) + 1,
            bits: [best.cost, best.exponent, best.similarity].map(f32::to_bits),
            players: players
                .fold(u32::from(best.conditions), |packed, id| packed << 5 | (u32::from(id.number()) + 1)),
        }
    }

    fn numbers(self) -> [u32; 5] {
        let [cost, exponent, similarity] = self.bits;
        [self.case, cost, exponent, similarity, self.players]
    }

    fn from_numbers([case, cost, exponent, similarity, players]: [u32; 5]) -> Self {
        Self { case, bits: [cost, exponent, similarity], players }
    }
}

impl Answer {
    /// From the results of the three retrieval methods.
    pub fn new(
        best: Option<&Match>,
        counted: &Retrieval,
        scanned: &Retrieval,
        instructions: [u32; 3],
    ) -> Self {
        Self {
            best: Found::of(best),
            counted: Found::of(counted.best.as_ref()),
            candidates: u32::from(counted.candidates),
            scanned: Found::of(scanned.best.as_ref()),
            instructions,
        }
    }

    /// Returns whether the three methods agree.
    pub fn agrees(&self) -> bool {
        self.best == self.scanned && self.counted == self.scanned
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = [self.best, self.counted, self.scanned];
        let numbers =
            found.into_iter().flat_map(Found::numbers).chain([self.candidates]).chain(self.instructions);
        for (i, number) in numbers.enumerate() {
            write!(f, "{}{number}", if i == 0 { "" } else { " " })?;
        }
        Ok(())
    }
}

impl FromStr for Answer {
    type Err = ();

    fn from_str(line: &str) -> Result<Self, ()> {
        let mut numbers = line.split(' ').map(|number| number.parse::<u32>().map_err(|_| ()));
        let mut next = || numbers.next().ok_or(())?;
        let mut found = [Found::default(); 3];
        for found in &mut found {
            *found = Found::from_numbers([next()?, next()?, next()?, next()?, next()?]);
        }
        let [best, counted, scanned] = found;
        let answer =
            Self { best, counted, candidates: next()?, scanned, instructions: [next()?, next()?, next()?] };
        if numbers.next().is_none() { Ok(answer) } else { Err(()) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::string::ToString;
    use std::vec::Vec;

    use casebase::{GoalEnd, PointMm};
    use protocol::RobotId;

    use super::*;

    #[test]
    fn problems_come_back_as_they_went() {
        let problem = |x| Problem {
            ball: PointMm::new(x, -7),
            defending: GoalEnd::Positive,
            teammates: RobotId::all().take(11).map(|id| (id, PointMm::new(i32::MIN, x))).collect(),
            opponents: (0..11).map(|y| PointMm::new(i32::MAX, y)).collect(),
        };
        let sent = [problem(3), problem(i32::MAX)];
        let mut bytes = Vec::new();
        for problem in &sent {
            bytes.extend(encode(problem, &mut [0; 512]).unwrap());
        }
        let memory: Vec<u8> = header(bytes.len(), 2).into_iter().chain(bytes).chain([0; 9]).collect();
        assert_eq!(problems(&memory).collect::<Vec<_>>(), sent);
        assert_eq!(problems(&memory[..60]).count(), 0);
        assert_eq!(problems(&[]).count(), 0);
    }

    #[test]
    fn an_answer_comes_back_as_it_went() {
        let found = |case| Found { case, bits: [1, 2, 3], players: 4 };
        let answer = Answer {
            best: found(1),
            counted: found(1),
            candidates: 7,
            scanned: found(2),
            instructions: [10, 20, 30],
        };
        assert_eq!(answer.to_string().parse(), Ok(answer));
        assert!(!answer.agrees() && Answer { scanned: found(1), ..answer }.agrees());
        assert!("1 2 3".parse::<Answer>().is_err());
    }
}
