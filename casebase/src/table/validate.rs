//! `validate`: one-time validation of case-base bytes, so that later accesses need no checks.

use zerocopy::{FromBytes, Immutable, KnownLayout};

use super::{
    CaseBase, GRID_MAX, Group, HASHED_FROM, Header, LISTS_OF_CELL, MAGIC, MAGIC_WORDS, RawAction, RawLeg,
    RecordHeader, STRIPS, Word, WordSections, content_hash, part,
};
use crate::Grid;
use crate::action::{KICKS_MAX, OPPONENTS_MAX, Primitive, TEAMMATES_MAX};

/// Reason why bytes are not a case base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The bytes do not start at a multiple of 4.
    #[error("the table does not begin at a multiple of 4 bytes")]
    Misaligned,
    /// The bytes are fewer or more than the header states.
    #[error("the table is shorter or longer than its header states")]
    Length,
    /// The bytes are something else, another version, or of the other byte order.
    #[error("not a case table of this version and byte order")]
    Magic,
    /// The hash does not match: damaged.
    #[error("the table is damaged: its hash does not match")]
    Hash,
    /// The field, the radii of a pass or a kick kind are invalid.
    #[error("the table's field, pass or kick kinds make no sense")]
    League,
    /// A record points outside its pool, or contains a value that no case can have.
    #[error("authored case {authored} of the table makes no sense")]
    Case {
        /// Number of the authored case, from 0.
        authored: u32,
    },
    /// The index points outside the table.
    #[error("the table's index makes no sense")]
    Index,
}
impl<'a> CaseBase<'a> {
    /// Splits the table into its sections; all lengths are checked, no content.
    pub(super) fn split(bytes: &'a [u8]) -> Result<Self, TableError> {
        if !(bytes.as_ptr() as usize).is_multiple_of(align_of::<u32>()) {
            return Err(TableError::Misaligned);
        }
        let (header, rest) = bytes.split_at_checked(size_of::<Header>()).ok_or(TableError::Length)?;
        let header = Header::ref_from_bytes(header).map_err(|_| TableError::Length)?;
        let (sections, rest) = match header.magic {
            MAGIC => (&[][..], rest),
            MAGIC_WORDS if cfg!(feature = "words") => section::<WordSections>(rest, 1)?,
            _ => return Err(TableError::Magic),
        };
        let lengths = sections.first().map_or([0; 3], |of| [of.words, of.bitmaps, header.cell_cases]);
        let (words, rest) = section(rest, lengths[0])?;
        let (bitmaps, rest) = section(rest, lengths[1])?;
        let (cell_masks, rest) = section(rest, lengths[2])?;
        let Grid { columns, rows, .. } = header.grid;
        let lists = if sections.is_empty() { 1 } else { LISTS_OF_CELL };
        let lists = lists * usize::from(columns) * usize::from(rows);
        let copies = header.groups.checked_mul(4).ok_or(TableError::Length)?;
        let (groups, rest) = section(rest, header.groups)?;
        let (record_headers, rest) = section(rest, copies)?;
        let (points, rest) = section(rest, header.points)?;
        let (kicks, rest) = section(rest, header.kicks)?;
        let (cell_starts, rest) = section(rest, lists as u32 + 1)?;
        let (places, rest) = section(rest, header.places)?;
        let (cell_cases, rest) = section(rest, header.cell_cases)?;
        let (actions, rest) = section(rest, header.actions)?;
        if !rest.is_empty() {
            return Err(TableError::Length);
        }
        Ok(Self {
            bytes,
            header,
            words,
            bitmaps,
            cell_masks,
            groups,
            record_headers,
            points,
            kicks,
            cell_starts,
            places,
            cell_cases,
            actions,
        })
    }

    /// Checks the content of every section.
    pub(super) fn validate(&self) -> Result<(), TableError> {
        let hashed = self.bytes.get(HASHED_FROM..).unwrap_or(&[]);
        if content_hash(hashed) != self.header.hash {
            return Err(TableError::Hash);
        }
        if !self.league_is_sound() {
            return Err(TableError::League);
        }
        if self.groups.len() > CASES_MAX {
            return Err(TableError::Length);
        }
        for (authored, group) in self.groups.iter().enumerate() {
            let sound = (0..4).all(|copy| self.copy_is_sound(authored, group, copy));
            if !sound {
                return Err(TableError::Case { authored: authored as u32 });
            }
        }
        if self.index_is_sound() { Ok(()) } else { Err(TableError::Index) }
    }

    fn league_is_sound(&self) -> bool {
        let field = &self.header.field;
        let sides = [field[0], field[1]].iter().all(|side| (1..=SIDE_MAX_MM).contains(side));
        let kicks = self.kicks.len() <= KICKS_MAX
            && self.kicks.iter().all(|kick| {
                kick.radii.iter().all(|radius| *radius > 0)
                    && usize::from(kick.primitive) < Primitive::ALL.len()
                    && kick.at_goal <= 1
            });
        sides && self.header.pass.iter().all(|radius| *radius > 0) && kicks
    }

    /// Returns whether one of the four copies is valid: records within their pools, values a case can have.
    fn copy_is_sound(&self, authored: usize, group: &Group, copy: u16) -> bool {
        let Some(record_header) = self.record_headers.get(4 * authored + usize::from(copy)) else {
            return false;
        };
        let teammates = usize::from(record_header.teammates);
        if !(1..=TEAMMATES_MAX).contains(&teammates) || usize::from(record_header.opponents) > OPPONENTS_MAX {
            return false;
        }
        if !record_header.demands().fits(record_header.opponents) {
            return false;
        }
        let ends = group.list_ends.get(..teammates).unwrap_or(&[]);
        let actions_count = ends.last().copied().unwrap_or(0);
        let (Some(opponents), Some(legs), Some(_)) = (
            record_header.opponents(self.places),
            record_header.legs(self.places),
            record_header.positions(self.places),
        ) else {
            return false;
        };
        let actions = part(self.actions, group.actions_at, actions_count, copy);
        let whole = part(self.points, group.points_at, group.points, copy).len() == usize::from(group.points)
            && actions.len() == usize::from(actions_count)
            && never_falls(ends)
            && group.defending <= 1
            && group.getter < record_header.teammates;
        let getters_first = gameplay(actions, ends, group.getter).first();
        whole
            && record_header.ball.iter().all(|coordinate| f32::from(*coordinate as i16) == *coordinate)
            && all_positive(&record_header.inverse_scope)
            && opponents.iter().all(|opponent| all_positive(&opponent.inverse_scope))
            && actions.iter().all(|action| self.action_is_sound(record_header, group, *action))
            && legs.iter().all(|leg| leg_is_sound(leg, group, gameplay(actions, ends, leg.robot)))
            && getters_first.is_some_and(|action| action.kind == RawAction::GET_BALL)
    }

    fn action_is_sound(&self, record_header: &RecordHeader, group: &Group, action: RawAction) -> bool {
        let argument = action.argument;
        match action.kind {
            RawAction::WAIT | RawAction::GET_BALL => true,
            RawAction::GO_TO_POINT
            | RawAction::TURN_HEADING
            | RawAction::TURN_FACE
            | RawAction::DRIBBLE_TO => argument < group.points,
            RawAction::PASS_BALL | RawAction::RECEIVE_BALL => argument < record_header.teammates,
            RawAction::KICK => usize::from(argument) < self.kicks.len(),
            _ => false,
        }
    }

    fn index_is_sound(&self) -> bool {
        let Grid { columns, rows, cell_mm, cells_per_mm, corner } = self.header.grid;
        let starts_are_sound = never_falls(self.cell_starts)
            && self.cell_starts.first() == Some(&0)
            && self.cell_starts.last().is_some_and(|last| *last as usize == self.cell_cases.len());
        (1..=GRID_MAX).contains(&columns)
            && (1..=GRID_MAX).contains(&rows)
            && [cell_mm, cells_per_mm].iter().all(|scale| scale.is_finite() && *scale > 0.0)
            && corner.iter().all(|coordinate| coordinate.is_finite())
            && starts_are_sound
            && self.cell_cases.iter().all(|listed| usize::from(*listed) < self.listed())
            && self.words.iter().all(|word| self.word_is_sound(word))
    }

    /// Number of the things that the index's cells list: words, or cases.
    fn listed(&self) -> usize {
        if cfg!(feature = "words") && self.header.magic == MAGIC_WORDS {
            self.words.len()
        } else {
            self.record_headers.len()
        }
    }

    fn word_is_sound(&self, word: &Word) -> bool {
        let bitmaps = self.bitmaps.get(word.bitmaps_at as usize..).unwrap_or(&[]);
        bitmaps.len() >= STRIPS * usize::from(word.opponents)
            && word.cases.iter().all(|case| usize::from(*case) < self.record_headers.len())
    }
}

/// A robot's actions, from those of its case and the ends of the robots' lists; none for a robot that the
/// case does not have.
fn gameplay<'a>(actions: &'a [RawAction], ends: &[u8], robot: u8) -> &'a [RawAction] {
    let end = |robot: usize| ends.get(robot).map_or(0, |end| usize::from(*end));
    let robot = usize::from(robot);
    actions.get(robot.checked_sub(1).map_or(0, end)..end(robot)).unwrap_or(&[])
}

/// Returns whether a leg is one of its kicker's passes or kicks, along finite coordinates; `gameplay` is the
/// kicker's.
fn leg_is_sound(leg: &RawLeg, group: &Group, gameplay: &[RawAction]) -> bool {
    let action = gameplay.get(usize::from(leg.action));
    action.is_some_and(|action| matches!(action.kind, RawAction::PASS_BALL | RawAction::KICK))
        && (leg.carried_to == RawLeg::NOT_CARRIED || leg.carried_to < group.points)
        && leg.to.iter().all(|coordinate| coordinate.is_finite())
        && all_positive(&leg.radii)
}

/// Returns whether all of these are finite and above 0.
fn all_positive(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.is_finite() && *number > 0.0)
}

/// Maximum number of authored cases: their four copies are numbered by a `u16`.
pub(crate) const CASES_MAX: usize = (u16::MAX as usize + 1) / 4;
/// Maximum side of a field, mm: positions relative to the ball then fit an `i16`.
pub(crate) const SIDE_MAX_MM: i32 = 30_000;

/// Like `is_sorted`, whose division into chunks leaves a panic site in the binary.
fn never_falls<T: PartialOrd>(list: &[T]) -> bool {
    list.iter().zip(list.iter().skip(1)).all(|(before, after)| before <= after)
}

/// The next `count` records of `rest`.
fn section<T: FromBytes + Immutable + KnownLayout>(
    rest: &[u8],
    count: u32,
) -> Result<(&[T], &[u8]), TableError> {
    let size = (count as usize).checked_mul(size_of::<T>()).ok_or(TableError::Length)?;
    let (section, rest) = rest.split_at_checked(size).ok_or(TableError::Length)?;
    Ok((<[T]>::ref_from_bytes(section).map_err(|_| TableError::Length)?, rest))
}
