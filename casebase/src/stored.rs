//! Where in the table are the records of one stored case? What retrieval looks at: by reference, nothing copied.
//!
//! [`Case`](crate::Case) is the view for everybody else; it carries its base with it and decodes what it is asked for.

use protocol::CaseId;

use crate::action::FieldMm;
use crate::case::Case;
use crate::table::{CaseBase, Gate, Group, Opponent, RawLeg, part};

/// The records of a stored case.
#[derive(Clone, Copy)]
pub(crate) struct Stored<'q, 'a> {
    base: &'q CaseBase<'a>,
    pub(crate) id: CaseId,
    pub(crate) gate: &'a Gate,
    group: &'a Group,
}

impl<'q, 'a> Stored<'q, 'a> {
    /// By its number; `None` beyond the last case.
    #[inline]
    pub(crate) fn new(base: &'q CaseBase<'a>, id: CaseId) -> Option<Self> {
        let gate = base.gates.get(usize::from(id.0))?;
        let group = base.groups.get(usize::from(id.0 / 4))?;
        Some(Self { base, id, gate, group })
    }

    /// The same case as everybody sees it.
    pub(crate) fn case(&self) -> Option<Case<'a>> {
        Case::new(*self.base, self.id)
    }

    /// The league's field.
    #[inline]
    pub(crate) fn field(&self) -> FieldMm {
        self.base.field()
    }

    /// Number of robots.
    #[inline]
    pub(crate) fn teammates(&self) -> u8 {
        self.group.teammates
    }

    /// Number of opponents.
    #[inline]
    pub(crate) fn opponents_count(&self) -> u8 {
        self.group.opponents
    }

    /// Where the robots stand relative to the case's ball, mm.
    #[inline]
    pub(crate) fn positions(&self) -> &'a [[i16; 2]] {
        part(self.base.positions, self.group.positions_at, self.group.teammates, self.copy())
    }

    /// The opponents.
    #[inline]
    pub(crate) fn opponents(&self) -> &'a [Opponent] {
        part(self.base.opponents, self.group.opponents_at, self.group.opponents, self.copy())
    }

    /// The legs; each begins where the one before ends.
    #[inline]
    pub(crate) fn legs(&self) -> &'a [RawLeg] {
        part(self.base.legs, self.group.legs_at, self.group.legs, self.copy())
    }

    /// A point of the case by its number, mm, in the case's own coordinates.
    #[inline]
    pub(crate) fn point(&self, index: u8) -> [i32; 2] {
        let points = part(self.base.points, self.group.points_at, self.group.points, self.copy());
        points.get(usize::from(index)).copied().unwrap_or([0; 2])
    }

    const fn copy(&self) -> u16 {
        self.id.0 & 3
    }
}
