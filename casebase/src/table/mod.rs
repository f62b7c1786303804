//! `table`: the flat case-base table as it lies in flash. One flat table of fixed records, read in place,
//! without a decode step.
//!
//! Sections follow the [`Header`] in the order of [`CaseBase`]'s fields, those of the widest alignment first,
//! native byte order. The four symmetric copies of an authored case are stored in full, one after the other;
//! records used by retrieval belong to each copy's [`RecordHeader`], those used by its players to their
//! common [`Group`]. Positions and opponents are stored relative to the case's ball, legs computed to their
//! ends: nothing is derived twice at run time. The index is a grid over the ball's position for cases that
//! defend the negative goal; a mirrored look-up serves the others.
//!
//! [`CaseBase::from_bytes`] checks everything once, so that no later access can panic or leave the table.

use geometry::GoalEnd;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

mod record_header;
mod validate;
mod word;

pub use record_header::{OpponentRecord, RawLeg, RecordHeader};
pub use validate::TableError;
pub(crate) use word::NearWords;
pub use word::{LISTS_OF_CELL, STRIPS, Word, WordSections};

use crate::PointMm;
use crate::action::{CaseKick, FieldMm, KickAim, KickId, Pass, Primitive, TEAMMATES_MAX};
use crate::index::Grid;
use crate::settings::SCOPE_EXPONENT;
use crate::symmetry::Symmetry;

/// A case base over a borrowed table. Cheap to copy: it contains only references.
#[derive(Clone, Copy, Debug)]
pub struct CaseBase<'a> {
    bytes: &'a [u8],
    pub(crate) header: &'a Header,
    pub(crate) words: &'a [Word],
    pub(crate) bitmaps: &'a [u32],
    cell_masks: &'a [u32],
    pub(crate) groups: &'a [Group],
    pub(crate) record_headers: &'a [RecordHeader],
    pub(crate) points: &'a [[i32; 2]],
    kicks: &'a [RawKick],
    pub(crate) cell_starts: &'a [u32],
    pub(crate) places: &'a [u32],
    pub(crate) cell_cases: &'a [u16],
    pub(crate) actions: &'a [RawAction],
}

impl<'a> CaseBase<'a> {
    /// Reads a table in place and checks all of it; `bytes` must start at a multiple of 4.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, TableError> {
        let base = Self::split(bytes)?;
        base.validate()?;
        Ok(base)
    }

    /// Hash of the content: two bases with the same hash contain the same cases.
    pub const fn hash(&self) -> u32 {
        self.header.hash
    }

    /// Number of stored cases, four for each authored one.
    pub const fn len(&self) -> usize {
        self.record_headers.len()
    }

    /// Returns whether there is no case.
    pub const fn is_empty(&self) -> bool {
        self.record_headers.is_empty()
    }

    /// Dimensions of the league's field, mm.
    pub const fn field(&self) -> FieldMm {
        let [length, width, margin, goal_width, penalty_depth, penalty_width] = self.header.field;
        FieldMm { length, width, margin, goal_width, penalty_depth, penalty_width }
    }

    /// Radii r_min and r_max of all passes of the league, mm.
    pub const fn pass(&self) -> Pass {
        let [r_min, r_max] = self.header.pass;
        Pass { r_min, r_max }
    }

    /// The kick kind with this id; `None` if the table has no such kind.
    pub fn kick(&self, id: KickId) -> Option<CaseKick> {
        self.kicks.get(id.0 as usize).map(RawKick::decode)
    }

    /// Number of kick kinds.
    pub const fn kicks(&self) -> usize {
        self.kicks.len()
    }

    /// The whole table as it lies in flash, header included.
    pub const fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Every case under `goal` whose ball scope may contain `ball`: ids, with the bits to flip in them. None
    /// in a table with words.
    #[inline]
    pub(crate) fn near(&self, ball: [f32; 2], goal: GoalEnd) -> (&[u16], usize) {
        let (cell, flip) = self.cell(ball, goal);
        let bounds = self.cell_starts.get(cell..).and_then(|starts| starts.first_chunk());
        let list = bounds.and_then(|&[from, to]| self.cell_cases.get(from as usize..to as usize));
        (list.unwrap_or(&[]), usize::from(flip))
    }

    /// The same of a table with words: their lists, and the symmetry that leads from their cases to those
    /// under `goal`.
    #[inline]
    pub(crate) fn words_near(&self, ball: [f32; 2], goal: GoalEnd) -> (NearWords<'_>, Symmetry) {
        let (cell, flip) = self.cell(ball, goal);
        let bounds = self.cell_starts.get(cell * LISTS_OF_CELL..).and_then(|starts| starts.first_chunk());
        let bounds = bounds.unwrap_or(&[0; LISTS_OF_CELL + 1]);
        let near = NearWords { bounds, words: self.cell_cases, masks: self.cell_masks };
        (near, Symmetry::from_bits(flip))
    }

    /// The cell of a ball, and the bits to flip in the ids of its cases.
    #[inline]
    fn cell(&self, [x, y]: [f32; 2], goal: GoalEnd) -> (usize, u16) {
        let (x, other_goal) = match goal {
            GoalEnd::Negative => (x, Symmetry::Identity),
            GoalEnd::Positive => (-x, Symmetry::AcrossY),
        };
        let (y, other_side) = if y < 0.0 { (-y, Symmetry::AcrossX) } else { (y, Symmetry::Identity) };
        (self.header.grid.cell([x, y]), other_goal.bits() | other_side.bits())
    }

    /// Returns whether the index was built for scopes that end at this exponent.
    #[inline]
    pub(crate) fn index_serves(limit: f32) -> bool {
        limit <= SCOPE_EXPONENT
    }

    /// Mean bytes of the table per stored case, index included.
    pub fn bytes_per_case(&self) -> f32 {
        if self.is_empty() { 0.0 } else { self.bytes.len() as f32 / self.len() as f32 }
    }
}

impl Default for CaseBase<'_> {
    /// The base without cases: every retrieval finds nothing.
    fn default() -> Self {
        Self {
            bytes: &[],
            header: &EMPTY_HEADER,
            words: &[],
            bitmaps: &[],
            cell_masks: &[],
            groups: &[],
            record_headers: &[],
            points: &[],
            kicks: &[],
            cell_starts: &[],
            places: &[],
            cell_cases: &[],
            actions: &[],
        }
    }
}

/// "o12c" and the version of the layout without words.
pub const MAGIC: [u32; 2] = [u32::from_ne_bytes(*b"o12c"), 3];
/// The same of the layout with words, for large libraries.
pub const MAGIC_WORDS: [u32; 2] = [MAGIC[0], 4];
/// Maximum number of cells of the index along one axis.
pub const GRID_MAX: u16 = 256;

/// The start of a table.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Header {
    /// [`MAGIC`]; read with the wrong byte order it is another number.
    pub magic: [u32; 2],
    /// FNV-1a-32 over everything behind this field.
    pub hash: u32,
    /// Length, width, margin, goal width, penalty depth, penalty width, mm.
    pub field: [i32; 6],
    /// r_min, r_max of a pass, mm.
    pub pass: [i32; 2],
    /// Number of authored cases.
    pub groups: u32,
    /// Number of points of actions.
    pub points: u32,
    /// Number of kick kinds.
    pub kicks: u32,
    /// Number of 32-bit units of the places: opponents, legs and positions of the stored cases.
    pub places: u32,
    /// Number of case numbers in the cells of the index.
    pub cell_cases: u32,
    /// Number of actions in the table, over all records.
    pub actions: u32,
    /// The cells of the index.
    pub grid: Grid,
}

/// Data shared by the four copies of an authored case: copy k starts at `start + k · count` among points and
/// actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Group {
    /// Index of the first of the copies' points.
    pub points_at: u32,
    /// Index of the first of the copies' actions.
    pub actions_at: u32,
    /// Number of points of actions in each copy.
    pub points: u8,
    /// End of each robot's list of actions, counted from the copy's first action.
    pub list_ends: [u8; TEAMMATES_MAX],
    /// 0 where the authored case defends the negative goal, 1 the positive.
    pub defending: u8,
    /// The robot whose first action is `get_ball`.
    pub getter: u8,
    /// Always 0; keeps the record free of padding.
    pub reserved: u8,
}

impl Group {
    /// A point of copy `copy` by its number, mm, field frame; (0, 0) where there is none.
    pub(crate) fn point(&self, points: &[[i32; 2]], copy: u16, index: u8) -> PointMm {
        let points = part(points, self.points_at, self.points, copy);
        points.get(usize::from(index)).map_or(PointMm::new(0, 0), |[x, y]| PointMm::new(*x, *y))
    }
}

/// One action: its kind and its argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct RawAction {
    /// One of [`RawAction`]'s constants.
    pub kind: u8,
    /// A robot (from 0), a kick kind, or one of the case's points; 0 for actions without an argument.
    pub argument: u8,
}

#[allow(missing_docs, reason = "each is the kind of the action of its name")]
impl RawAction {
    pub const WAIT: u8 = 0;
    pub const GO_TO_POINT: u8 = 1;
    pub const TURN_HEADING: u8 = 2;
    pub const TURN_FACE: u8 = 3;
    pub const GET_BALL: u8 = 4;
    pub const DRIBBLE_TO: u8 = 5;
    pub const PASS_BALL: u8 = 6;
    pub const RECEIVE_BALL: u8 = 7;
    pub const KICK: u8 = 8;
}

/// A kick kind as the table stores it, with numbers in place of names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct RawKick {
    /// Heading relative to the direction of attack, whole degrees; 0 for a kick at the goal.
    pub degrees: i32,
    /// Length of a kick along a heading, or the offset of a kick at the goal, mm.
    pub length_or_offset: i32,
    /// r_min and r_max, mm.
    pub radii: [i32; 2],
    /// 1 for a kick at the goal, else 0.
    pub at_goal: u8,
    /// Index of the primitive in [`Primitive::ALL`].
    pub primitive: u8,
    /// Always 0; keeps the record free of padding.
    pub reserved: [u8; 2],
}

impl RawKick {
    /// Encodes a kick for the table.
    pub fn encode(kick: CaseKick) -> Self {
        let (degrees, length_or_offset, at_goal) = match kick.aim {
            KickAim::Heading { degrees, length_mm } => (degrees, length_mm, 0),
            KickAim::Goal { offset_mm } => (0, offset_mm, 1),
        };
        let radii = [kick.r_min, kick.r_max];
        Self { degrees, length_or_offset, radii, at_goal, primitive: kick.primitive as u8, reserved: [0; 2] }
    }

    fn decode(&self) -> CaseKick {
        let aim = if self.at_goal == 0 {
            KickAim::Heading { degrees: self.degrees, length_mm: self.length_or_offset }
        } else {
            KickAim::Goal { offset_mm: self.length_or_offset }
        };
        let [r_min, r_max] = self.radii;
        let primitive = Primitive::ALL.get(self.primitive as usize).copied().unwrap_or_default();
        CaseKick { aim, r_min, r_max, primitive }
    }
}

/// FNV-1a-32, the hash a [`Header`] carries of all that follows its `hash` word.
pub fn content_hash(behind_hash: &[u8]) -> u32 {
    behind_hash.iter().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193))
}

/// Bytes before those that are hashed.
pub const HASHED_FROM: usize = 12;

/// The `count` records of copy `copy` in a pool; nothing where the pool ends before (never in a validated
/// table).
#[inline]
pub(crate) fn part<T>(pool: &[T], start: u32, count: u8, copy: u16) -> &[T] {
    let count = usize::from(count);
    let from = (start as usize).wrapping_add(usize::from(copy) * count);
    pool.get(from..).and_then(|rest| rest.get(..count)).unwrap_or(&[])
}

static EMPTY_HEADER: Header = Header {
    magic: MAGIC,
    hash: 0,
    field: [0; 6],
    pass: [1; 2],
    groups: 0,
    points: 0,
    kicks: 0,
    places: 0,
    cell_cases: 0,
    actions: 0,
    grid: Grid { columns: 0, rows: 0, cell_mm: 1.0, cells_per_mm: 1.0, corner: [0.0; 2] },
};
