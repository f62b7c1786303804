//! `field`: geometry packets. Lines, arc, numbers, cameras and the ball's model; mm, as SSL-Vision sends
//! them.
//!
//! Names and directions are SSL-Vision's; grSim draws its lines inside the edge, and also the goals.

use ssl::vision::{
    BallModelChipFixedLoss, BallModelStraightTwoPhase, FieldCircularArc, FieldLineSegment, FieldShapeType,
    GeometryData, GeometryFieldSize, GeometryModels, Vector2f,
};

use super::view::View;
use crate::small_size::World;
use crate::small_size::compatibility::{Compatibility, ReportedBall};

/// The geometry packet of `world`'s field with these cameras.
pub(super) fn geometry(world: &World, compatibility: &Compatibility, views: &[View]) -> GeometryData {
    let field = &world.pitch().field;
    let ball = compatibility.reported_ball.unwrap_or_else(|| ReportedBall::of(&world.parameters().ball));
    let mm = |m: f32| geometry::math::round_to_i32(m * 1000.0);
    let full = |value: i32| compatibility.full_geometry.then_some(value);
    let newer =
        (compatibility.full_geometry || compatibility.drawn_goals).then_some(mm(field.goal_line_margin));
    let inset = if compatibility.drawn_goals { field.line_width * 500.0 } else { 0.0 };
    GeometryData {
        field: GeometryFieldSize {
            field_length: mm(field.length),
            field_width: mm(field.width),
            goal_width: mm(field.goal_width),
            goal_depth: mm(field.goal_depth),
            boundary_width: mm(field.margin),
            field_lines: lines(world, compatibility),
            field_arcs: vec![FieldCircularArc {
                name: "CenterCircle".into(),
                center: Vector2f { x: 0.0, y: 0.0 },
                radius: field.center_radius * 1000.0 - inset,
                a1: 0.0,
                a2: geometry::math::TAU,
                thickness: field.line_width * 1000.0,
                r#type: compatibility.full_geometry.then_some(FieldShapeType::CenterCircle as i32),
            }],
            penalty_area_depth: full(mm(field.penalty_depth)),
            penalty_area_width: full(mm(field.penalty_width)),
            center_circle_radius: full(mm(field.center_radius)),
            line_thickness: full(mm(field.line_width)),
            goal_center_to_penalty_mark: full(mm(field.penalty_mark)),
            goal_height: full(mm(field.goal_height)),
            ball_radius: compatibility.full_geometry.then_some(world.parameters().ball.radius * 1000.0),
            max_robot_radius: compatibility.full_geometry.then_some(world.parameters().robot.radius * 1000.0),
            boundary_width_goal_line: newer,
            goal_substitution_area_width: newer.map(|_| mm(field.goal_substitution)),
        },
        calib: views.iter().map(|view| view.calibration(compatibility.full_geometry)).collect(),
        models: Some(GeometryModels {
            straight_two_phase: Some(BallModelStraightTwoPhase {
                acc_slide: ball.slide,
                acc_roll: ball.roll,
                k_switch: ball.switch,
            }),
            chip_fixed_loss: Some(BallModelChipFixedLoss {
                damping_xy_first_hop: ball.hops[0],
                damping_xy_other_hops: ball.hops[1],
                damping_z: ball.hops[2],
            }),
        }),
    }
}

fn lines(world: &World, compatibility: &Compatibility) -> Vec<FieldLineSegment> {
    use FieldShapeType as Shape;
    let field = &world.pitch().field;
    let thickness = field.line_width * 1000.0;
    let inset = if compatibility.drawn_goals { thickness * 0.5 } else { 0.0 };
    let (x, y) = (field.length * 500.0 - inset, field.width * 500.0 - inset);
    let depth = field.length * 500.0 - field.penalty_depth * 1000.0;
    let half = field.penalty_width * 500.0;
    let mut lines = vec![
        ("TopTouchLine", Some(Shape::TopTouchLine), [-x, y], [x, y]),
        ("BottomTouchLine", Some(Shape::BottomTouchLine), [-x, -y], [x, -y]),
        ("LeftGoalLine", Some(Shape::LeftGoalLine), [-x, -y], [-x, y]),
        ("RightGoalLine", Some(Shape::RightGoalLine), [x, -y], [x, y]),
        ("HalfwayLine", Some(Shape::HalfwayLine), [0.0, -y], [0.0, y]),
        ("CenterLine", Some(Shape::CenterLine), [-x, 0.0], [x, 0.0]),
        ("LeftPenaltyStretch", Some(Shape::LeftPenaltyStretch), [-depth, -half], [-depth, half]),
        ("RightPenaltyStretch", Some(Shape::RightPenaltyStretch), [depth, -half], [depth, half]),
    ];
    if compatibility.drawn_goals {
        let (goal, back) = (field.goal_width * 500.0, x + field.goal_depth * 1000.0);
        lines.extend([
            ("RightGoalTopLine", None, [x, goal], [back, goal]),
            ("RightGoalBottomLine", None, [x, -goal], [back, -goal]),
            ("RightGoalDepthLine", None, [back, -goal], [back, goal]),
            ("LeftGoalTopLine", None, [-x, goal], [-back, goal]),
            ("LeftGoalBottomLine", None, [-x, -goal], [-back, -goal]),
            ("LeftGoalDepthLine", None, [-back, -goal], [-back, goal]),
        ]);
    }
    // SSL-Vision's names; grSim swaps the names of all four lines.
    let first = if compatibility.drawn_goals { -half } else { half };
    let (left, right) = (Shape::LeftFieldLeftPenaltyStretch, Shape::LeftFieldRightPenaltyStretch);
    lines.push(("LeftFieldLeftPenaltyStretch", Some(left), [-x, -first], [-depth, -first]));
    lines.push(("LeftFieldRightPenaltyStretch", Some(right), [-x, first], [-depth, first]));
    let (left, right) = (Shape::RightFieldLeftPenaltyStretch, Shape::RightFieldRightPenaltyStretch);
    lines.push(("RightFieldRightPenaltyStretch", Some(right), [x, -first], [depth, -first]));
    lines.push(("RightFieldLeftPenaltyStretch", Some(left), [x, first], [depth, first]));
    let segments = lines.into_iter().map(|(name, shape, [x1, y1], [x2, y2])| FieldLineSegment {
        name: name.into(),
        p1: Vector2f { x: x1, y: y1 },
        p2: Vector2f { x: x2, y: y2 },
        thickness,
        r#type: shape.filter(|_| compatibility.full_geometry).map(|shape| shape as i32),
    });
    segments.collect()
}
