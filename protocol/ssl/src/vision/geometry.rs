//! `geometry`: field geometry. Units: mm and rad in the field frame.

use prost::{Enumeration, Message};

/// A point on the ground, mm, field frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Vector2f {
    /// Along the field's length, mm.
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// Coordinate to the left of +x, mm.
    #[prost(float, required, tag = "2")]
    pub y: f32,
}

/// A straight line painted on the field.
#[derive(Clone, PartialEq, Message)]
pub struct FieldLineSegment {
    /// Name of the line, as `TopTouchLine` or `LeftPenaltyStretch`.
    #[prost(string, required, tag = "1")]
    pub name: String,
    /// One end, on the middle of the line's width.
    #[prost(message, required, tag = "2")]
    pub p1: Vector2f,
    /// The other end.
    #[prost(message, required, tag = "3")]
    pub p2: Vector2f,
    /// Width of the paint, mm.
    #[prost(float, required, tag = "4")]
    pub thickness: f32,
    /// The same as `name`, as [`FieldShapeType`].
    #[prost(enumeration = "FieldShapeType", optional, tag = "5")]
    pub r#type: Option<i32>,
}

/// A round line painted on the field.
#[derive(Clone, PartialEq, Message)]
pub struct FieldCircularArc {
    /// Name of the arc, as `CenterCircle`.
    #[prost(string, required, tag = "1")]
    pub name: String,
    /// Centre of the arc, mm.
    #[prost(message, required, tag = "2")]
    pub center: Vector2f,
    /// Its radius, mm, to the middle of the line's width.
    #[prost(float, required, tag = "3")]
    pub radius: f32,
    /// Where it starts, rad, counter-clockwise from +x.
    #[prost(float, required, tag = "4")]
    pub a1: f32,
    /// Where it ends, rad.
    #[prost(float, required, tag = "5")]
    pub a2: f32,
    /// Width of the paint, mm.
    #[prost(float, required, tag = "6")]
    pub thickness: f32,
    /// The same as `name`, as [`FieldShapeType`].
    #[prost(enumeration = "FieldShapeType", optional, tag = "7")]
    pub r#type: Option<i32>,
}

/// Dimensions and lines of the field. Neither simulator sets the fields after `field_arcs` (README, trap 8).
#[derive(Clone, PartialEq, Message)]
pub struct GeometryFieldSize {
    /// Distance from goal line to goal line, mm.
    #[prost(int32, required, tag = "1")]
    pub field_length: i32,
    /// Distance from touch line to touch line, mm.
    #[prost(int32, required, tag = "2")]
    pub field_width: i32,
    /// Distance between the posts, inside, mm.
    #[prost(int32, required, tag = "3")]
    pub goal_width: i32,
    /// Distance from the goal line to the goal's back, mm.
    #[prost(int32, required, tag = "4")]
    pub goal_depth: i32,
    /// Distance from the touch line to the wall, mm; also goal line to wall where `boundary_width_goal_line`
    /// is absent.
    #[prost(int32, required, tag = "5")]
    pub boundary_width: i32,
    /// Straight lines, in any order.
    #[prost(message, repeated, tag = "6")]
    pub field_lines: Vec<FieldLineSegment>,
    /// Arcs among the lines.
    #[prost(message, repeated, tag = "7")]
    pub field_arcs: Vec<FieldCircularArc>,
    /// Defence area along x, mm.
    #[prost(int32, optional, tag = "8")]
    pub penalty_area_depth: Option<i32>,
    /// Defence area along y, mm.
    #[prost(int32, optional, tag = "9")]
    pub penalty_area_width: Option<i32>,
    /// Radius of the centre circle, mm.
    #[prost(int32, optional, tag = "10")]
    pub center_circle_radius: Option<i32>,
    /// Width of every line, mm.
    #[prost(int32, optional, tag = "11")]
    pub line_thickness: Option<i32>,
    /// Distance from the goal centre to the penalty mark, mm.
    #[prost(int32, optional, tag = "12")]
    pub goal_center_to_penalty_mark: Option<i32>,
    /// Height of the crossbar's lower edge, mm.
    #[prost(int32, optional, tag = "13")]
    pub goal_height: Option<i32>,
    /// Radius of the ball, mm.
    #[prost(float, optional, tag = "14")]
    pub ball_radius: Option<f32>,
    /// Largest radius of a robot, mm.
    #[prost(float, optional, tag = "15")]
    pub max_robot_radius: Option<f32>,
    /// Distance from the goal line to the wall, mm.
    #[prost(int32, optional, tag = "16")]
    pub boundary_width_goal_line: Option<i32>,
    /// Width of the substitution area behind the goal lines, mm.
    #[prost(int32, optional, tag = "17")]
    pub goal_substitution_area_width: Option<i32>,
}

/// Position and orientation of a camera, and its lens.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GeometryCameraCalibration {
    /// Number of the camera.
    #[prost(uint32, required, tag = "1")]
    pub camera_id: u32,
    /// Focal length, px.
    #[prost(float, required, tag = "2")]
    pub focal_length: f32,
    /// Column of the optical axis, px.
    #[prost(float, required, tag = "3")]
    pub principal_point_x: f32,
    /// Row of the optical axis, px.
    #[prost(float, required, tag = "4")]
    pub principal_point_y: f32,
    /// Radial distortion, the coefficient of r².
    #[prost(float, required, tag = "5")]
    pub distortion: f32,
    /// Rotation from field to camera: quaternion, x. Simulators send 0.7 four times, which is not normalised.
    #[prost(float, required, tag = "6")]
    pub q0: f32,
    /// y of the orientation quaternion.
    #[prost(float, required, tag = "7")]
    pub q1: f32,
    /// z of the orientation quaternion.
    #[prost(float, required, tag = "8")]
    pub q2: f32,
    /// w of the orientation quaternion.
    #[prost(float, required, tag = "9")]
    pub q3: f32,
    /// Translation from field to camera, mm, camera frame.
    #[prost(float, required, tag = "10")]
    pub tx: f32,
    /// Translation along y, mm.
    #[prost(float, required, tag = "11")]
    pub ty: f32,
    /// Translation along z, mm.
    #[prost(float, required, tag = "12")]
    pub tz: f32,
    /// Position of the camera along x, mm, field frame.
    #[prost(float, optional, tag = "13")]
    pub derived_camera_world_tx: Option<f32>,
    /// Position of the camera along y, mm, field frame.
    #[prost(float, optional, tag = "14")]
    pub derived_camera_world_ty: Option<f32>,
    /// Height of the camera, mm.
    #[prost(float, optional, tag = "15")]
    pub derived_camera_world_tz: Option<f32>,
    /// Columns of the camera frame, px.
    #[prost(uint32, optional, tag = "16")]
    pub pixel_image_width: Option<u32>,
    /// Rows of the camera frame, px.
    #[prost(uint32, optional, tag = "17")]
    pub pixel_image_height: Option<u32>,
}

/// Kind of line or arc.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum FieldShapeType {
    Undefined = 0,
    CenterCircle = 1,
    TopTouchLine = 2,
    BottomTouchLine = 3,
    LeftGoalLine = 4,
    RightGoalLine = 5,
    HalfwayLine = 6,
    CenterLine = 7,
    LeftPenaltyStretch = 8,
    RightPenaltyStretch = 9,
    LeftFieldLeftPenaltyStretch = 10,
    LeftFieldRightPenaltyStretch = 11,
    RightFieldLeftPenaltyStretch = 12,
    RightFieldRightPenaltyStretch = 13,
}

/// A ball on the ground: it slides, then rolls.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BallModelStraightTwoPhase {
    /// Acceleration while it slides, m/s², < 0.
    #[prost(double, required, tag = "1")]
    pub acc_slide: f64,
    /// Acceleration while it rolls, m/s², < 0.
    #[prost(double, required, tag = "2")]
    pub acc_roll: f64,
    /// It rolls from this fraction of its kick speed on, 0–1.
    #[prost(double, required, tag = "3")]
    pub k_switch: f64,
}

/// A chipped ball: each bounce keeps a fixed part of its speed.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BallModelChipFixedLoss {
    /// Share of the speed along the ground that the first bounce keeps, 0–1.
    #[prost(double, required, tag = "1")]
    pub damping_xy_first_hop: f64,
    /// Share of it that later bounces keep, 0–1.
    #[prost(double, required, tag = "2")]
    pub damping_xy_other_hops: f64,
    /// Share of the vertical speed that a bounce keeps, 0–1.
    #[prost(double, required, tag = "3")]
    pub damping_z: f64,
}

/// Ball model of this field. Simulators differ widely: it must be read, not hard-coded.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GeometryModels {
    /// Model on the ground.
    #[prost(message, optional, tag = "1")]
    pub straight_two_phase: Option<BallModelStraightTwoPhase>,
    /// Model in the air.
    #[prost(message, optional, tag = "2")]
    pub chip_fixed_loss: Option<BallModelChipFixedLoss>,
}

/// The field, its cameras and its ball.
#[derive(Clone, PartialEq, Message)]
pub struct GeometryData {
    /// Dimensions and lines.
    #[prost(message, required, tag = "1")]
    pub field: GeometryFieldSize,
    /// Cameras: all of them, or one a packet; merge by camera id.
    #[prost(message, repeated, tag = "2")]
    pub calib: Vec<GeometryCameraCalibration>,
    /// Model of the ball's motion.
    #[prost(message, optional, tag = "3")]
    pub models: Option<GeometryModels>,
}
