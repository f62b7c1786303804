//! `field_geometry`: field geometry from vision, merged from its geometry packets.
//!
//! Simulators send one camera's calibration a packet (trap 2), leave the defence area out, send lines in any
//! order and dummies for a camera's rotation (trap 8). The defence area is taken from its own numbers, else
//! from its lines, else from the division whose length is nearest, and [`AreaSource`] states which. Numbers
//! that no field can have are refused ([`GeometryFault`]); the previous geometry is kept. SI, field frame.

mod area;
mod camera;

use std::collections::BTreeMap;

use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use rules::{FieldFault, FieldSpec, League, limits};
use ssl::vision::{GeometryData, GeometryFieldSize};

pub use area::AreaSource;
pub use camera::Camera;

/// Cameras have numbers below this, twice as many as any field has: another number is not genuine, and would
/// take the place of a genuine camera.
pub const CAMERAS_MAX: u32 = 16;

/// Width of the goal substitution area that the game controller (2026) assumes where vision does not send it,
/// m.
const SUBSTITUTION_WIDTH_DEFAULT_M: f32 = 0.3;

/// The geometry that vision has sent so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VisionGeometry {
    field: Option<(FieldSpec, AreaSource)>,
    cameras: BTreeMap<u32, Camera>,
    ground: Option<BallModel>,
    chip: Option<ChipModel>,
    ball_radius: Option<f32>,
    robot_radius: Option<f32>,
}

/// Changes by a geometry packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryChange {
    /// The field differs from before, or known for the first time.
    pub field: bool,
    /// Number of cameras that are new or have moved.
    pub cameras: usize,
    /// Number of cameras refused: no position, or not a finite one.
    pub cameras_refused: usize,
    /// A model of the ball is new.
    pub models: bool,
    /// Number of models refused: implausible for a ball.
    pub models_refused: usize,
}

/// Why a geometry packet was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GeometryFault {
    /// A dimension of the field is invalid.
    #[error("vision's geometry is refused: {0}")]
    Field(FieldFault),
}

impl VisionGeometry {
    /// The field, once vision has sent it.
    pub fn field(&self) -> Option<&FieldSpec> {
        self.field.as_ref().map(|(field, _)| field)
    }

    /// Source of the defence area's size.
    pub fn area_source(&self) -> Option<AreaSource> {
        self.field.map(|(_, source)| source)
    }

    /// The cameras, by their numbers.
    pub fn cameras(&self) -> &BTreeMap<u32, Camera> {
        &self.cameras
    }

    /// Model of the ball on the ground, if vision has sent one.
    pub fn ground(&self) -> Option<BallModel> {
        self.ground
    }

    /// Model of the ball's bounces, if vision has sent one.
    pub fn chip(&self) -> Option<ChipModel> {
        self.chip
    }

    /// The ball's radius, m: from vision, else from the rules.
    pub fn ball_radius(&self) -> f32 {
        self.ball_radius.unwrap_or(limits::BALL_RADIUS)
    }

    /// The largest radius of a robot, m: from vision, else from the rules.
    pub fn robot_radius(&self) -> f32 {
        self.robot_radius.unwrap_or(limits::ROBOT_RADIUS)
    }

    /// Takes a geometry packet. An implausible field refuses the whole packet.
    pub fn receive(&mut self, data: &GeometryData) -> Result<GeometryChange, GeometryFault> {
        let field = field_of(&data.field).map_err(GeometryFault::Field)?;
        let mut change = GeometryChange { field: self.field != Some(field), ..GeometryChange::default() };
        self.field = Some(field);
        for calibration in &data.calib {
            let possible = calibration.camera_id < CAMERAS_MAX;
            match Camera::from_wire(calibration).filter(|_| possible) {
                None => change.cameras_refused += 1,
                Some(camera) => {
                    if self.cameras.insert(calibration.camera_id, camera) != Some(camera) {
                        change.cameras += 1;
                    }
                }
            }
        }
        let models = data.models.unwrap_or_default();
        if let Some(model) = models.straight_two_phase {
            match BallModel::from_wire(model.acc_slide, model.acc_roll, model.k_switch) {
                None => change.models_refused += 1,
                Some(model) => change.models |= self.ground.replace(model) != Some(model),
            }
        }
        if let Some(model) = models.chip_fixed_loss {
            let (first, other, z) =
                (model.damping_xy_first_hop, model.damping_xy_other_hops, model.damping_z);
            match ChipModel::from_wire(first, other, z) {
                None => change.models_refused += 1,
                Some(model) => change.models |= self.chip.replace(model) != Some(model),
            }
        }
        // Radii that are sent are used within what is possible on the field.
        let radius = |mm: Option<f32>, least: f32, most: f32| {
            mm.map(|mm| mm / 1000.0).filter(|radius| (least..=most).contains(radius))
        };
        self.ball_radius = radius(data.field.ball_radius, 0.01, 0.1).or(self.ball_radius);
        self.robot_radius = radius(data.field.max_robot_radius, 0.03, 0.3).or(self.robot_radius);
        Ok(change)
    }
}

/// The division whose field is nearest in length: missing values are taken from it.
fn nearest_division(length: f32) -> League {
    let off = |league: League| (league.field().length - length).abs();
    if off(League::DivisionA) < off(League::DivisionB) { League::DivisionA } else { League::DivisionB }
}

/// The field of a packet, checked.
fn field_of(size: &GeometryFieldSize) -> Result<(FieldSpec, AreaSource), FieldFault> {
    // Sizes of int32 in mm are whole numbers up to 2³¹; as f32 they lose less than the rules' tolerance.
    let metres = |mm: i32| mm as f32 / 1000.0;
    let announced = |mm: Option<i32>| mm.filter(|mm| *mm > 0).map(metres);
    let (length, width) = (metres(size.field_length), metres(size.field_width));
    let default = nearest_division(length).field();
    let margin = metres(size.boundary_width);
    let circle =
        size.field_arcs.iter().find(|arc| area::is_arc(arc, "CenterCircle")).map(|arc| arc.radius / 1000.0);
    let thickness = size.field_lines.first().map(|line| line.thickness / 1000.0);
    let (area, source) = area::of(size);
    let field = FieldSpec {
        length,
        width,
        margin,
        // The newest message has both; older programs send 0 for "not set".
        goal_line_margin: announced(size.boundary_width_goal_line).unwrap_or(margin),
        // Here 0 is a value: no such area. If it is not sent, the game controller takes its own default, the
        // same in both divisions.
        goal_substitution: size.goal_substitution_area_width.map_or(SUBSTITUTION_WIDTH_DEFAULT_M, metres),
        goal_width: metres(size.goal_width),
        goal_depth: metres(size.goal_depth),
        goal_height: announced(size.goal_height).unwrap_or(default.goal_height),
        goal_wall: default.goal_wall,
        penalty_depth: area.depth,
        penalty_width: area.width,
        penalty_form: area.form,
        // In both divisions the mark is two thirds of the field from the goal.
        penalty_mark: announced(size.goal_center_to_penalty_mark)
            .unwrap_or(length * (default.penalty_mark / default.length)),
        center_radius: announced(size.center_circle_radius).or(circle).unwrap_or(default.center_radius),
        line_width: announced(size.line_thickness).or(thickness).unwrap_or(default.line_width),
    };
    Ok((field.checked()?, source))
}

#[cfg(test)]
mod tests;
