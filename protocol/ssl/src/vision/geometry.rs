//! `geometry`: field geometry. Units: mm and rad in the field frame.

use prost::{Enumeration, Message};

messages! {
    /// A point on the ground, mm, field frame.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Vector2f {
        /// Along the field's length, mm.
        x: f32 [float, required] = 1;
        /// Coordinate to the left of +x, mm.
        y: f32 [float, required] = 2;
    }

    /// A straight line painted on the field.
    #[derive(Clone, PartialEq, Message)]
    pub struct FieldLineSegment {
        /// Name of the line, as `TopTouchLine` or `LeftPenaltyStretch`.
        name: String [string, required] = 1;
        /// One end, on the middle of the line's width.
        p1: Vector2f [message, required] = 2;
        /// The other end, likewise.
        p2: Vector2f [message, required] = 3;
        /// Width of the paint, mm.
        thickness: f32 [float, required] = 4;
        /// The same as `name`, as [`FieldShapeType`].
        r#type: Option<i32> [enumeration = "FieldShapeType", optional] = 5;
    }

    /// A round line painted on the field.
    #[derive(Clone, PartialEq, Message)]
    pub struct FieldCircularArc {
        /// Name of the arc, as `CenterCircle`.
        name: String [string, required] = 1;
        /// Centre of the circle, mm.
        center: Vector2f [message, required] = 2;
        /// Radius, mm, to the middle of the line's width.
        radius: f32 [float, required] = 3;
        /// Start of the arc, rad, counter-clockwise from +x.
        a1: f32 [float, required] = 4;
        /// End of the arc, rad, counter-clockwise from +x.
        a2: f32 [float, required] = 5;
        /// Width of the paint, mm.
        thickness: f32 [float, required] = 6;
        /// The same as `name`, as [`FieldShapeType`].
        r#type: Option<i32> [enumeration = "FieldShapeType", optional] = 7;
    }

    /// The field's measures and lines. Neither simulator sets the fields after `field_arcs` (README, trap 8).
    #[derive(Clone, PartialEq, Message)]
    pub struct GeometryFieldSize {
        /// Goal line to goal line, mm.
        field_length: i32 [int32, required] = 1;
        /// Touch line to touch line, mm.
        field_width: i32 [int32, required] = 2;
        /// Between the posts, inside, mm.
        goal_width: i32 [int32, required] = 3;
        /// Goal line to the goal's back, mm.
        goal_depth: i32 [int32, required] = 4;
        /// Touch line to the wall, mm; also goal line to wall where `boundary_width_goal_line` is absent.
        boundary_width: i32 [int32, required] = 5;
        /// Straight lines, in any order.
        field_lines: Vec<FieldLineSegment> [message, repeated] = 6;
        /// Round lines, in any order.
        field_arcs: Vec<FieldCircularArc> [message, repeated] = 7;
        /// Defence area along x, mm.
        penalty_area_depth: Option<i32> [int32, optional] = 8;
        /// Defence area along y, mm.
        penalty_area_width: Option<i32> [int32, optional] = 9;
        /// Radius of the centre circle, mm.
        center_circle_radius: Option<i32> [int32, optional] = 10;
        /// Width of every line, mm.
        line_thickness: Option<i32> [int32, optional] = 11;
        /// Goal centre to penalty mark, mm.
        goal_center_to_penalty_mark: Option<i32> [int32, optional] = 12;
        /// Ground to the crossbar's lower edge, mm.
        goal_height: Option<i32> [int32, optional] = 13;
        /// Radius of the ball, mm.
        ball_radius: Option<f32> [float, optional] = 14;
        /// Largest radius of a robot, mm.
        max_robot_radius: Option<f32> [float, optional] = 15;
        /// Goal line to the wall, mm.
        boundary_width_goal_line: Option<i32> [int32, optional] = 16;
        /// Width of the substitution area behind the goal lines, mm.
        goal_substitution_area_width: Option<i32> [int32, optional] = 17;
    }

    /// Pose and optics of a camera.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GeometryCameraCalibration {
        /// Number of the camera, from 0.
        camera_id: u32 [uint32, required] = 1;
        /// Focal length of the pinhole model, px.
        focal_length: f32 [float, required] = 2;
        /// Column of the optical axis, px.
        principal_point_x: f32 [float, required] = 3;
        /// Row of the optical axis, px.
        principal_point_y: f32 [float, required] = 4;
        /// Radial distortion, the coefficient of r².
        distortion: f32 [float, required] = 5;
        /// Rotation from field to camera: quaternion, x. Simulators send 0.7 four times, which is not
        /// normalised.
        q0: f32 [float, required] = 6;
        /// Component y of the quaternion.
        q1: f32 [float, required] = 7;
        /// Component z of the quaternion.
        q2: f32 [float, required] = 8;
        /// Component w of the quaternion.
        q3: f32 [float, required] = 9;
        /// Translation from field to camera, mm, camera frame.
        tx: f32 [float, required] = 10;
        /// Component y of the translation, mm.
        ty: f32 [float, required] = 11;
        /// Component z of the translation, mm.
        tz: f32 [float, required] = 12;
        /// Position of the camera along x, mm, field frame.
        derived_camera_world_tx: Option<f32> [float, optional] = 13;
        /// Position of the camera along y, mm, field frame.
        derived_camera_world_ty: Option<f32> [float, optional] = 14;
        /// Height of the camera, mm.
        derived_camera_world_tz: Option<f32> [float, optional] = 15;
        /// Columns of the image, px.
        pixel_image_width: Option<u32> [uint32, optional] = 16;
        /// Rows of the image, px.
        pixel_image_height: Option<u32> [uint32, optional] = 17;
    }
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

messages! {
    /// A ball on the ground: it slides, then rolls.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BallModelStraightTwoPhase {
        /// Acceleration while it slides, m/s², < 0.
        acc_slide: f64 [double, required] = 1;
        /// Acceleration while it rolls, m/s², < 0.
        acc_roll: f64 [double, required] = 2;
        /// Fraction of its kick speed from which the ball rolls, 0–1.
        k_switch: f64 [double, required] = 3;
    }

    /// A chipped ball: each bounce keeps a fixed part of its speed.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BallModelChipFixedLoss {
        /// Share of the speed along the ground that the first bounce keeps, 0–1.
        damping_xy_first_hop: f64 [double, required] = 1;
        /// Share of it that later bounces keep, 0–1.
        damping_xy_other_hops: f64 [double, required] = 2;
        /// Share of the vertical speed that a bounce keeps, 0–1.
        damping_z: f64 [double, required] = 3;
    }

    /// Models of the ball's motion. Simulators differ widely: read it, hard-code nothing.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GeometryModels {
        /// Model of a ball on the ground.
        straight_two_phase: Option<BallModelStraightTwoPhase> [message, optional] = 1;
        /// Model of a ball in the air.
        chip_fixed_loss: Option<BallModelChipFixedLoss> [message, optional] = 2;
    }

    /// The field, its cameras and its ball.
    #[derive(Clone, PartialEq, Message)]
    pub struct GeometryData {
        /// Measures and lines of the field, mm.
        field: GeometryFieldSize [message, required] = 1;
        /// Cameras: all of them, or one a packet; merge by camera id.
        calib: Vec<GeometryCameraCalibration> [message, repeated] = 2;
        /// Models of the ball's motion.
        models: Option<GeometryModels> [message, optional] = 3;
    }
}
