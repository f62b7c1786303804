//! `scene`: geometry for tracking: positions of cameras, size of the surface, and models of the ball. m.

use geometry::{Field, Point};
use motion::ball::BallModel;
use ssl::vision::GeometryData;

use super::seen::CAMERAS_MAX;
use crate::field_geometry::{GeometryChange, GeometryFault, VisionGeometry};
use crate::world::BallModels;

/// No camera is mounted lower than the height of a chipped ball, m.
const CAMERA_HEIGHT_MIN_M: f32 = 1.5;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Camera {
    pub(super) above: Point<Field>,
    pub(super) height: f32,
}

/// Geometry as far as it is known.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub(super) geometry: VisionGeometry,
    cameras: [Option<Camera>; CAMERAS_MAX],
    pub(super) models: BallModels,
    /// Deceleration of a rolling ball, where it is better known than from vision, m/s².
    roll: Option<f32>,
}

impl Scene {
    /// No geometry received yet; balls move by `models` until then.
    pub(super) fn new(models: BallModels) -> Self {
        Self { models, ..Self::default() }
    }

    /// Takes a packet; refused parts keep their previous values.
    pub(super) fn receive(&mut self, data: &GeometryData) -> Result<GeometryChange, GeometryFault> {
        let changes = self.geometry.receive(data)?;
        for (number, camera) in self.geometry.cameras() {
            let [x, y, height] = camera.position;
            if let Some(place) = self.cameras.get_mut(*number as usize) {
                // A camera mounted lower is not used for heights.
                *place =
                    (height >= CAMERA_HEIGHT_MIN_M).then_some(Camera { above: Point::new(x, y), height });
            }
        }
        let ground = self.geometry.ground().unwrap_or(self.models.ground);
        self.models.ground = BallModel { roll: self.roll.unwrap_or(ground.roll), ..ground };
        self.models.chip = self.geometry.chip().unwrap_or(self.models.chip);
        Ok(changes)
    }

    /// Sets the deceleration of a rolling ball, m/s².
    pub(super) fn set_roll(&mut self, roll: f32) -> BallModel {
        self.roll = Some(roll);
        self.models.ground.roll = roll;
        self.models.ground
    }

    /// The deceleration is vision's again, where it has sent one.
    pub(super) fn clear_roll(&mut self) -> BallModel {
        self.roll = None;
        if let Some(ground) = self.geometry.ground() {
            self.models.ground = ground;
        }
        self.models.ground
    }

    /// Position of that camera, if it was received.
    pub(super) fn camera(&self, number: u32) -> Option<Camera> {
        self.cameras.get(number as usize).copied().flatten()
    }

    /// Whether a ball there can be in play: on the surface between the walls. Everywhere, while the field is
    /// unknown.
    pub(super) fn is_playable(&self, point: Point<Field>) -> bool {
        self.geometry.field().is_none_or(|field| {
            let margin = field.margin.max(field.goal_line_margin).max(field.goal_depth);
            field.clamp(point, -margin) == point
        })
    }

    /// Whether it is inside the field's lines; everywhere, while the field is unknown.
    pub(super) fn is_inside(&self, point: Point<Field>) -> bool {
        self.geometry.field().is_none_or(|field| field.clamp(point, 0.0) == point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssl::vision::{GeometryCameraCalibration, GeometryFieldSize};

    fn packet(camera_id: u32, z: f32) -> GeometryData {
        let calibration = GeometryCameraCalibration {
            camera_id,
            derived_camera_world_tx: Some(-2_000.0),
            derived_camera_world_ty: Some(1_500.0),
            derived_camera_world_tz: Some(z),
            ..GeometryCameraCalibration::default()
        };
        let field = GeometryFieldSize {
            field_length: 9_000,
            field_width: 6_000,
            goal_width: 1_000,
            goal_depth: 180,
            boundary_width: 300,
            ..GeometryFieldSize::default()
        };
        GeometryData { field, calib: vec![calibration], models: None }
    }

    #[test]
    fn trap_02_calibrations_sent_one_a_packet_are_all_kept() {
        let mut scene = Scene::default();
        for id in 0..4 {
            scene.receive(&packet(id, 4_000.0)).unwrap();
        }
        for id in 0..4 {
            let camera = scene.camera(id).unwrap();
            assert!(
                camera.above.distance(Point::new(-2.0, 1.5)) < 1e-5 && (camera.height - 4.0).abs() < 1e-5
            );
        }
        assert_eq!((scene.camera(4), scene.camera(u32::MAX)), (None, None));
        scene.receive(&packet(2, 300.0)).unwrap();
        assert_eq!(scene.camera(2), None, "on a tripod");
    }

    #[test]
    fn a_ball_between_the_walls_can_be_played_and_one_beyond_them_cannot() {
        let mut scene = Scene::default();
        assert!(scene.is_playable(Point::new(9.0, 0.0)), "the field is unknown");
        scene.receive(&packet(0, 4_000.0)).unwrap();
        assert!(scene.is_playable(Point::new(-4.75, 3.25)) && !scene.is_playable(Point::new(9.0, 0.0)));
        let nonsense = GeometryData { field: GeometryFieldSize::default(), ..packet(0, 4_000.0) };
        assert!(scene.receive(&nonsense).is_err());
        assert!(!scene.is_playable(Point::new(9.0, 0.0)), "what was known stands");
    }
}
