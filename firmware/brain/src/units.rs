//! Where do the case base's integer millimetres meet the robot's metres? Here; all points in the field frame.

use casebase::PointMm;
use geometry::{Field, Point, math};
use protocol::quantized::{WirePoint, from_mm};

/// Millimetres of the case base to metres.
pub(crate) fn to_field(point: PointMm) -> Point<Field> {
    Point::new(from_mm(point.x), from_mm(point.y))
}

/// The end of a leg, mm, to metres.
pub(crate) fn end_to_field([x, y]: [f32; 2]) -> Point<Field> {
    Point::new(x * 0.001, y * 0.001)
}

/// Metres to whole millimetres, to the nearest.
pub(crate) fn to_mm(point: Point<Field>) -> PointMm {
    PointMm { x: math::round_to_i32(point.x() * 1000.0), y: math::round_to_i32(point.y() * 1000.0) }
}

/// A problem's ball as it goes over the air; a ball farther than 32 m off saturates.
pub(crate) fn to_wire(point: PointMm) -> WirePoint {
    let saturate = |v: i32| v.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16;
    WirePoint { x: saturate(point.x), y: saturate(point.y) }
}

/// And back.
pub(crate) fn from_wire(point: WirePoint) -> PointMm {
    PointMm { x: i32::from(point.x), y: i32::from(point.y) }
}
