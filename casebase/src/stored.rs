//! `stored`: record addresses of one stored case. Used by retrieval: by reference, nothing copied.
//!
//! [`Case`](crate::Case) is the view for all other callers; it contains a reference to its base and decodes
//! on request.

use protocol::CaseId;

use crate::PointMm;
use crate::action::FieldMm;
use crate::leg::{Corridor, minus};
use crate::table::{CaseBase, OpponentRecord, RawLeg, RecordHeader};

#[derive(Clone, Copy)]
pub(crate) struct Stored<'q, 'a> {
    pub(crate) base: &'q CaseBase<'a>,
    pub(crate) id: CaseId,
    pub(crate) record_header: &'a RecordHeader,
}

impl<'q, 'a> Stored<'q, 'a> {
    /// Looks a case up by its number; `None` beyond the last case.
    #[inline]
    pub(crate) fn new(base: &'q CaseBase<'a>, id: CaseId) -> Option<Self> {
        let record_header = base.record_headers.get(usize::from(id.0))?;
        Some(Self { base, id, record_header })
    }

    #[inline]
    pub(crate) fn field(&self) -> FieldMm {
        self.base.field()
    }

    /// B_c: position of the ball in the case, mm.
    #[inline]
    pub(crate) fn ball(&self) -> PointMm {
        let [x, y] = self.record_header.ball;
        PointMm::new(x as i32, y as i32)
    }

    #[inline]
    pub(crate) fn teammates(&self) -> u8 {
        self.record_header.teammates
    }

    /// Positions of the robots relative to the case's ball, mm.
    #[inline]
    pub(crate) fn positions(&self) -> Option<&'a [[i16; 2]]> {
        self.record_header.positions(self.base.places)
    }

    #[inline]
    pub(crate) fn opponents(&self) -> Option<&'a [OpponentRecord]> {
        self.record_header.opponents(self.base.places)
    }

    /// The legs; each starts where the one before ends.
    #[inline]
    pub(crate) fn legs(&self) -> Option<&'a [RawLeg]> {
        self.record_header.legs(self.base.places)
    }

    /// A point of the case by its number, mm, relative to the case's ball. Used by few legs.
    #[inline(never)]
    fn carried_to(&self, index: u8) -> [f32; 2] {
        let CaseId(id) = self.id;
        let group = self.base.groups.get(usize::from(id / 4));
        group.map_or([0.0; 2], |group| {
            group.point(self.base.points, id & 3, index).minus(self.ball()).to_f32()
        })
    }

    /// The corridor of a stored leg, relative to a ball at `ball`; `rest` is the end of the leg before.
    #[inline]
    pub(crate) fn corridor(&self, raw: &RawLeg, rest: [f32; 2], ball: [f32; 2]) -> Corridor {
        let from = match raw.carried_to {
            RawLeg::NOT_CARRIED => rest,
            point => self.carried_to(point),
        };
        let to = if raw.flags & RawLeg::TO_FIELD == 0 { raw.to } else { minus(raw.to, ball) };
        Corridor::new(from, to, raw.radii)
    }
}
