//! `angle`: direction. A wrapped angle in (−π, π], counter-clockwise from +x, without a misleading order.

use core::ops::{Add, Neg, Sub};

use serde::{Deserialize, Serialize};

use crate::math;

/// A direction or a turn, rad, always in (−π, π]. It has no `Ord`: "greater" is undefined on a circle.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Angle(f32);

impl Angle {
    /// 0 rad: direction along +x.
    pub const ZERO: Self = Self(0.0);
    /// π rad: direction along −x.
    pub const HALF_TURN: Self = Self(math::PI);

    /// Wraps `radians` into (−π, π]; NaN and infinities become 0.
    pub fn new(radians: f32) -> Self {
        if radians > -math::PI && radians <= math::PI {
            return Self(radians);
        }
        if !radians.is_finite() {
            return Self::ZERO;
        }
        let turns = math::floor((radians + math::PI) * (1.0 / math::TAU));
        let wrapped = radians - turns * math::TAU;
        Self(wrapped.clamp(-math::PI, math::PI))
    }

    /// For constants: `radians` must already lie in (−π, π] (checked when the constant is made).
    pub const fn const_new(radians: f32) -> Self {
        assert!(radians > -math::PI && radians <= math::PI, "a constant angle lies in (−π, π]");
        Self(radians)
    }

    /// The angle of `degrees`, wrapped; NaN and infinities become 0.
    pub fn degrees(degrees: f32) -> Self {
        Self::new(degrees * (math::PI / 180.0))
    }

    /// Value in rad, (−π, π].
    #[inline]
    pub fn radians(self) -> f32 {
        self.0
    }

    /// Value in degrees, (−180, 180].
    pub fn to_degrees(self) -> f32 {
        self.0 * (180.0 / math::PI)
    }

    /// Absolute value, 0 to π.
    #[inline]
    pub fn abs(self) -> f32 {
        self.0.abs()
    }

    /// Sine and cosine, `(sin, cos)`.
    #[inline]
    pub fn sin_cos(self) -> (f32, f32) {
        math::sin_cos(self.0)
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.0 + other.0)
    }
}
impl Sub for Angle {
    type Output = Self;
    /// The shortest turn from `other` to `self`.
    fn sub(self, other: Self) -> Self {
        Self::new(self.0 - other.0)
    }
}
impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_turn_crosses_the_seam() {
        let turn = Angle::degrees(-170.0) - Angle::degrees(170.0);
        assert!((turn.to_degrees() - 20.0).abs() < 1e-3);
    }

    #[test]
    fn wrapping_keeps_the_direction_and_the_range() {
        for i in -1000..1000 {
            let raw = i as f32 * 0.37;
            let wrapped = Angle::new(raw).radians();
            assert!(wrapped > -math::PI - 1e-6 && wrapped <= math::PI);
            let (s, c) = math::sin_cos(raw);
            let (ws, wc) = math::sin_cos(wrapped);
            assert!((s - ws).abs() < 1e-4 && (c - wc).abs() < 1e-4, "{raw}");
        }
        assert_eq!(Angle::new(f32::NAN), Angle::ZERO);
    }
}
