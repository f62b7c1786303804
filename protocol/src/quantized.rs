//! `quantized`: conversion between SI units and wire integers, the only place for it (docs/architecture.md
//! §2.2). All conversions saturate.

use geometry::{Angle, Field, Point, Pose, math};
use serde::{Deserialize, Serialize};

/// A place on the field, whole millimetres, ±32.767 m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub struct WirePoint {
    /// Coordinate along +x, mm.
    #[serde(with = "postcard::fixint::le")]
    pub x: i16,
    /// Coordinate along +y, mm.
    #[serde(with = "postcard::fixint::le")]
    pub y: i16,
}

/// A place and a heading: mm and mrad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct WirePose {
    /// Position of the robot's centre, mm.
    pub at: WirePoint,
    /// Heading, mrad, −3142 to 3142.
    #[serde(with = "postcard::fixint::le")]
    pub heading: i16,
}

/// Metres to whole millimetres, to the nearest; NaN gives 0.
pub fn whole_mm(metres: f32) -> i32 {
    math::round_to_i32(metres * 1000.0)
}

/// Rounds as [`whole_mm`] does, for the wire: saturates at ±32.767 m.
pub fn to_mm(metres: f32) -> i16 {
    saturate(whole_mm(metres))
}

/// Converts millimetres to metres.
pub fn from_mm(mm: i32) -> f32 {
    mm as f32 * 0.001
}

/// A length ≥ 0 in whole millimetres, saturating at 65.535 m.
pub fn length_to_mm(metres: f32) -> u16 {
    whole_mm(metres).clamp(0, i32::from(u16::MAX)) as u16
}

impl From<Point<Field>> for WirePoint {
    fn from(p: Point<Field>) -> Self {
        Self { x: to_mm(p.x()), y: to_mm(p.y()) }
    }
}

impl From<WirePoint> for Point<Field> {
    fn from(p: WirePoint) -> Self {
        Self::new(from_mm(i32::from(p.x)), from_mm(i32::from(p.y)))
    }
}

impl From<Pose<Field>> for WirePose {
    fn from(p: Pose<Field>) -> Self {
        Self { at: p.position.into(), heading: saturate(math::round_to_i32(p.heading.radians() * 1000.0)) }
    }
}

impl From<WirePose> for Pose<Field> {
    fn from(p: WirePose) -> Self {
        Self { position: p.at.into(), heading: Angle::new(f32::from(p.heading) * 0.001) }
    }
}

/// A value outside the range of the wire's integers becomes the nearest inside.
pub fn saturate(value: i32) -> i16 {
    value.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn millimetres_survive_quantisation() {
        for mm in [-32_767_i16, -2700, -1, 0, 1, 1799, 32_767] {
            assert_eq!(to_mm(from_mm(i32::from(mm))), mm);
        }
    }

    #[test]
    fn values_beyond_the_wires_range_saturate() {
        assert_eq!(to_mm(1e9), i16::MAX);
        assert_eq!(to_mm(f32::NAN), 0);
        assert_eq!(length_to_mm(-1.0), 0);
    }
}
