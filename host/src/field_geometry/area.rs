//! `area`: size of the defence area. From its numbers, its lines, or the division.

use rules::{AreaForm, League};
use ssl::vision::{FieldCircularArc, FieldLineSegment, FieldShapeType, GeometryFieldSize};

use super::nearest_division;

/// Both lines parallel to the goal line; the length of either is the area's width.
const FRONTS: [(&str, FieldShapeType); 2] = [
    ("LeftPenaltyStretch", FieldShapeType::LeftPenaltyStretch),
    ("RightPenaltyStretch", FieldShapeType::RightPenaltyStretch),
];
/// The four lines from the goal line into the field; the length of each is the area's depth.
const SIDES: [(&str, FieldShapeType); 4] = [
    ("LeftFieldLeftPenaltyStretch", FieldShapeType::LeftFieldLeftPenaltyStretch),
    ("LeftFieldRightPenaltyStretch", FieldShapeType::LeftFieldRightPenaltyStretch),
    ("RightFieldLeftPenaltyStretch", FieldShapeType::RightFieldLeftPenaltyStretch),
    ("RightFieldRightPenaltyStretch", FieldShapeType::RightFieldRightPenaltyStretch),
];
/// The arcs of a round area, as fields until 2017 had them.
const ARCS: [&str; 4] = [
    "LeftFieldLeftPenaltyArc",
    "LeftFieldRightPenaltyArc",
    "RightFieldLeftPenaltyArc",
    "RightFieldRightPenaltyArc",
];

/// Source of the defence area's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AreaSource {
    /// From the packet's own numbers.
    Announced,
    /// From the packet's penalty stretches.
    Lines,
    /// The packet has none: this division's, scaled down with the field where that is smaller. To be reported
    /// to the operator.
    Division(League),
}

/// Size of a defence area, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) depth: f32,
    pub(super) width: f32,
    pub(super) form: AreaForm,
}

/// The defence area of a field.
pub(super) fn of(size: &GeometryFieldSize) -> (Area, AreaSource) {
    let announced = |mm: Option<i32>| mm.filter(|mm| *mm > 0).map(|mm| mm as f32 / 1000.0);
    if let (Some(depth), Some(width)) =
        (announced(size.penalty_area_depth), announced(size.penalty_area_width))
    {
        return (Area { depth, width, form: AreaForm::Box }, AreaSource::Announced);
    }
    if let Some(area) = from_lines(size) {
        return (area, AreaSource::Lines);
    }
    let league = nearest_division(size.field_length as f32 / 1000.0);
    let field = league.field();
    let share = |mm: i32, full: f32| (mm as f32 / 1000.0 / full).min(1.0);
    let (along, across) = (share(size.field_length, field.length), share(size.field_width, field.width));
    let (depth, width) = (field.penalty_depth * along, field.penalty_width * across);
    (Area { depth, width, form: AreaForm::Box }, AreaSource::Division(league))
}

/// A side's length is the depth as it is painted, independent of where the program puts the goal line (grSim
/// puts it a line's width inside the field); only where there are no sides the distance of the front from the
/// goal line is.
fn from_lines(size: &GeometryFieldSize) -> Option<Area> {
    let front = FRONTS.iter().find_map(|kind| find(size, *kind))?;
    let width = (front.p1.y - front.p2.y).abs() / 1000.0;
    let arc = size.field_arcs.iter().find(|arc| ARCS.iter().any(|name| is_arc(arc, name)));
    let area = if let Some(arc) = arc {
        let depth = arc.radius / 1000.0;
        Area { depth, width: width + 2.0 * depth, form: AreaForm::QuarterCircles }
    } else {
        let side = SIDES.iter().find_map(|kind| find(size, *kind));
        let depth = side.map_or_else(
            || size.field_length as f32 * 0.5 - front.p1.x.abs(),
            |side| (side.p1.x - side.p2.x).abs(),
        );
        Area { depth: depth / 1000.0, width, form: AreaForm::Box }
    };
    // A line of length zero has no information.
    (area.depth > 0.0 && area.width > 0.0).then_some(area)
}

fn find<'a>(
    size: &'a GeometryFieldSize,
    (name, kind): (&str, FieldShapeType),
) -> Option<&'a FieldLineSegment> {
    size.field_lines.iter().find(|line| line.name == name || line.r#type == Some(kind as i32))
}

pub(super) fn is_arc(arc: &FieldCircularArc, name: &str) -> bool {
    arc.name == name || (name == "CenterCircle" && arc.r#type == Some(FieldShapeType::CenterCircle as i32))
}
