//! `frame`: coordinate frames as type parameters, so that a point of the field is never used as a point of
//! the robot.
//!
//! Thin wrappers of nalgebra's `Point2` and `Vector2`; its `norm` and `distance` are avoided (they call
//! libm's √). Metres, or metres per second where a [`Vector`] is a velocity.

use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Mul, Neg, Sub};

use nalgebra::{Point2, Vector2};
use serde::{Deserialize, Serialize};

use crate::{Angle, math};

/// The field frame: origin at the centre, +x along the length, +y to the left of +x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {}
/// The attack frame: as the field, turned so that +x points to the goal we attack. The host's strategy only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attack {}
/// The body frame: origin at the robot's centre, +x where it faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {}

/// A place in frame `F`, metres.
#[repr(transparent)]
#[derive(Serialize, Deserialize)]
#[serde(into = "[f32; 2]", from = "[f32; 2]", bound = "")]
pub struct Point<F>(Point2<f32>, PhantomData<fn() -> F>);

/// A displacement (m) or a velocity (m/s) in frame `F`.
#[repr(transparent)]
#[derive(Serialize, Deserialize)]
#[serde(into = "[f32; 2]", from = "[f32; 2]", bound = "")]
pub struct Vector<F>(Vector2<f32>, PhantomData<fn() -> F>);

macro_rules! common {
    ($name:ident, $inner:ident) => {
        impl<F> Clone for $name<F> {
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<F> Copy for $name<F> {}
        impl<F> PartialEq for $name<F> {
            fn eq(&self, other: &Self) -> bool {
                self.0 == other.0
            }
        }
        impl<F> Default for $name<F> {
            fn default() -> Self {
                Self::new(0.0, 0.0)
            }
        }
        impl<F> core::fmt::Debug for $name<F> {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                write!(f, "({}, {})", self.0.x, self.0.y)
            }
        }
        impl<F> From<$name<F>> for [f32; 2] {
            fn from(value: $name<F>) -> Self {
                [value.0.x, value.0.y]
            }
        }
        impl<F> From<[f32; 2]> for $name<F> {
            fn from([x, y]: [f32; 2]) -> Self {
                Self::new(x, y)
            }
        }
        impl<F> $name<F> {
            /// Vector from its two coordinates.
            #[inline]
            pub const fn new(x: f32, y: f32) -> Self {
                Self($inner::new(x, y), PhantomData)
            }
            /// The coordinate along +x.
            #[inline]
            pub fn x(self) -> f32 {
                self.0.x
            }
            /// The coordinate along +y.
            #[inline]
            pub fn y(self) -> f32 {
                self.0.y
            }
            /// Returns whether neither coordinate is NaN or infinite.
            pub fn is_finite(self) -> bool {
                self.0.x.is_finite() && self.0.y.is_finite()
            }
        }
    };
}
common!(Point, Point2);
common!(Vector, Vector2);

impl<F> Point<F> {
    /// Distance to another point, m.
    #[inline]
    pub fn distance(self, other: Self) -> f32 {
        (self - other).norm()
    }

    /// The direction from here to `other`.
    #[inline]
    pub fn direction_to(self, other: Self) -> Angle {
        (other - self).angle()
    }
}

impl<F> Vector<F> {
    /// The vector of this length in this direction.
    #[inline]
    pub fn polar(length: f32, direction: Angle) -> Self {
        let (s, c) = direction.sin_cos();
        Self::new(length * c, length * s)
    }

    /// Scalar product with `other`.
    #[inline]
    pub fn dot(self, other: Self) -> f32 {
        self.0.x * other.0.x + self.0.y * other.0.y
    }

    /// z of the cross product: positive when `other` points to the left.
    #[inline]
    pub fn cross(self, other: Self) -> f32 {
        self.0.x * other.0.y - self.0.y * other.0.x
    }

    /// Euclidean length, in the components' unit.
    #[inline]
    pub fn norm(self) -> f32 {
        math::sqrt(self.dot(self))
    }

    /// Direction from +x; 0 for the zero vector.
    #[inline]
    pub fn angle(self) -> Angle {
        Angle::new(math::atan2(self.0.y, self.0.x))
    }

    /// Turned counter-clockwise by `by`.
    #[inline]
    pub fn rotated(self, by: Angle) -> Self {
        let (s, c) = by.sin_cos();
        Self::new(c * self.0.x - s * self.0.y, s * self.0.x + c * self.0.y)
    }

    /// The same direction, cut to at most `limit` long.
    pub fn clamped(self, limit: f32) -> Self {
        let length = self.norm();
        if length > limit && length > 0.0 { self * (limit / length) } else { self }
    }

    /// Length 1 in the same direction; `None` for a vector shorter than a micrometre.
    pub fn unit(self) -> Option<Self> {
        let length = self.norm();
        (length > 1e-6).then(|| self * (1.0 / length))
    }

    /// The same numbers in another frame; only for the one place that turns or shifts between the two.
    #[inline]
    pub(crate) fn reframed<G>(self) -> Vector<G> {
        Vector::new(self.0.x, self.0.y)
    }
}

// Written by coordinates: nalgebra's operators use memory on a Cortex-M4, and cost twice as much there.
impl<F> Sub for Point<F> {
    type Output = Vector<F>;
    #[inline]
    fn sub(self, other: Self) -> Vector<F> {
        Vector::new(self.0.x - other.0.x, self.0.y - other.0.y)
    }
}
impl<F> Add<Vector<F>> for Point<F> {
    type Output = Self;
    #[inline]
    fn add(self, v: Vector<F>) -> Self {
        Self::new(self.0.x + v.0.x, self.0.y + v.0.y)
    }
}
impl<F> Sub<Vector<F>> for Point<F> {
    type Output = Self;
    #[inline]
    fn sub(self, v: Vector<F>) -> Self {
        Self::new(self.0.x - v.0.x, self.0.y - v.0.y)
    }
}
impl<F> AddAssign<Vector<F>> for Point<F> {
    #[inline]
    fn add_assign(&mut self, v: Vector<F>) {
        *self = *self + v;
    }
}
impl<F> Add for Vector<F> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::new(self.0.x + other.0.x, self.0.y + other.0.y)
    }
}
impl<F> AddAssign for Vector<F> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<F> Sub for Vector<F> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::new(self.0.x - other.0.x, self.0.y - other.0.y)
    }
}
impl<F> Neg for Vector<F> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.0.x, -self.0.y)
    }
}
impl<F> Mul<f32> for Vector<F> {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        Self::new(self.0.x * k, self.0.y * k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_three_by_four_is_five_long_and_clamps_to_its_direction() {
        let v = Vector::<Field>::new(3.0, 4.0);
        assert_eq!(v.norm(), 5.0);
        assert_eq!(v.clamped(2.5), Vector::new(1.5, 2.0));
        assert_eq!(v.clamped(6.0), v);
    }

    #[test]
    fn left_is_positive() {
        assert!(Vector::<Field>::new(1.0, 0.0).cross(Vector::new(0.0, 1.0)) > 0.0);
        let turned = Vector::<Field>::new(1.0, 0.0).rotated(Angle::new(math::FRAC_PI_2));
        assert!(turned.x().abs() < 1e-6 && (turned.y() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_zero_vector_has_no_unit() {
        assert_eq!(Vector::<Body>::new(0.0, 0.0).unit(), None);
    }
}
