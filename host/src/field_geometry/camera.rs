//! `camera`: camera positions. Needed as balls in the air are seen displaced, along the line from the camera.

use ssl::vision::GeometryCameraCalibration;

/// No camera is mounted farther from the centre than this, m.
const CAMERA_DISTANCE_MAX_M: f32 = 50.0;
/// A quaternion whose squared length is off 1 by more is a dummy (simulators send four times 0.7: 1.96).
const QUATERNION_TOLERANCE: f32 = 0.02;

/// Position of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Mounting position, m: along x, y, and height, field frame.
    pub position: [f32; 3],
    /// Source of the position.
    pub source: CameraSource,
}

/// Source of a camera's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraSource {
    /// The packet contains it.
    Announced,
    /// Computed from the calibration's rotation and translation.
    Calibration,
}

impl Camera {
    /// From a calibration; `None` where it gives no place, or none above the ground.
    pub(super) fn from_wire(c: &GeometryCameraCalibration) -> Option<Self> {
        let announced = [c.derived_camera_world_tx, c.derived_camera_world_ty, c.derived_camera_world_tz];
        let camera = if let [Some(x), Some(y), Some(z)] = announced {
            Self { position: [x, y, z].map(|mm| mm / 1000.0), source: CameraSource::Announced }
        } else {
            Self { position: from_rotation(c)?, source: CameraSource::Calibration }
        };
        let [x, y, z] = camera.position;
        // Not finite fails the comparisons too.
        let sound = x.abs() < CAMERA_DISTANCE_MAX_M
            && y.abs() < CAMERA_DISTANCE_MAX_M
            && z > 0.0
            && z < CAMERA_DISTANCE_MAX_M;
        sound.then_some(camera)
    }
}

/// A point p of the field is R p + t for the camera; the camera itself is where that is 0: −Rᵀ t.
fn from_rotation(c: &GeometryCameraCalibration) -> Option<[f32; 3]> {
    let [x, y, z, w] = [c.q0, c.q1, c.q2, c.q3];
    let length = x * x + y * y + z * z + w * w;
    if (length - 1.0).abs() > QUATERNION_TOLERANCE {
        return None;
    }
    // Columns of R, so that a product with t is a row of Rᵀ t.
    let columns = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let t = [c.tx, c.ty, c.tz];
    Some(columns.map(|column| -(column[0] * t[0] + column[1] * t[1] + column[2] * t[2]) / 1000.0))
}
