//! `leg`: one straight part of the ball's path as a fuzzy set (Ros et al. 2009, §3.3.1).
//!
//! The set widens from r_min at the foot to r_max at the end: μ = exp(−(v/ρ)²), u along and v across the leg,
//! 0 ≤ u ≤ l. Lengths in mm, axes of the field.

use geometry::{Field, Point, math};
use serde::{Deserialize, Serialize};

use crate::PointMm;
use crate::action::{CaseRobot, KickId};
use crate::settings::{FreePathRule, RetrievalSettings};

/// One straight part of the ball's path, mm, field frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Where the ball is kicked.
    pub from: [f32; 2],
    /// Where the ball stops.
    pub to: [f32; 2],
    /// Radius of the fuzzy set at `from`, mm.
    pub r_min: f32,
    /// Radius of the fuzzy set at `to`, mm.
    pub r_max: f32,
    /// The case robot that passes or kicks.
    pub robot: CaseRobot,
    /// Number of that action in the kicker's gameplay, from 0.
    pub action: usize,
    /// Whether the leg is a pass or a kick.
    pub kind: LegKind,
}

/// The action that sends the ball along a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LegKind {
    /// A pass to this robot.
    Pass(CaseRobot),
    /// A kick of this kind.
    Kick(KickId),
}

impl Leg {
    /// Where the ball is kicked, m.
    pub fn start(&self) -> Point<Field> {
        in_metres(self.from)
    }

    /// Where the ball stops, m.
    pub fn end(&self) -> Point<Field> {
        in_metres(self.to)
    }

    /// Distance of `point` along the leg and across it (left > 0), and the leg's radius there; `None` where
    /// it is not abreast of the leg. No point is abreast of a leg of length 0.
    pub fn abreast(&self, point: [f32; 2]) -> Option<Abreast> {
        let corridor = self.corridor();
        let Products { along, cross, radius } = corridor.products(point)?;
        let length = math::sqrt(corridor.squared);
        Some(Abreast { along: along / length, across: cross / length, radius })
    }

    /// Depth of an opponent inside the leg, mm from its edge at the settings' threshold; `None` outside.
    pub fn blocked_by(&self, opponent: PointMm, settings: &RetrievalSettings) -> Option<f32> {
        let point = opponent.to_f32();
        let exponent = self.corridor().exponent(point).filter(|exponent| is_blocking(*exponent, settings))?;
        let abreast = self.abreast(point)?;
        let edge = abreast.radius * math::sqrt(settings.limit());
        // With its own threshold a fuzzy path may be blocked by less than the crisp trapezoid: then the depth
        // is 0.
        Some(if exponent < settings.limit() { (edge - abreast.across.abs()).max(0.0) } else { 0.0 })
    }

    /// The fuzzy set around the leg.
    pub(crate) fn corridor(&self) -> Corridor {
        Corridor::new(self.from, self.to, [self.r_min, self.r_max])
    }
}

/// The fuzzy set around a leg, without its robot, action and kind: the part that retrieval uses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corridor {
    from: [f32; 2],
    to: [f32; 2],
    r_min: f32,
    r_max: f32,
    /// From `from` to `to`.
    axis: [f32; 2],
    squared: f32,
}

impl Corridor {
    /// The corridor from `from` to `to` with these radii at its ends.
    #[inline]
    pub(crate) fn new(from: [f32; 2], to: [f32; 2], [r_min, r_max]: [f32; 2]) -> Self {
        let axis = minus(to, from);
        Self { from, to, r_min, r_max, axis, squared: axis[0] * axis[0] + axis[1] * axis[1] }
    }

    /// Where the ball stops.
    #[inline]
    pub(crate) fn to(&self) -> [f32; 2] {
        self.to
    }

    pub(crate) fn into_leg(self, robot: CaseRobot, action: usize, kind: LegKind) -> Leg {
        let Self { from, to, r_min, r_max, .. } = self;
        Leg { from, to, r_min, r_max, robot, action, kind }
    }

    /// Whether it has any length: without, no point is abreast of it.
    #[inline]
    pub(crate) fn has_length(&self) -> bool {
        self.squared > 0.0
    }

    /// (v/ρ)², the negated exponent of μ; `None` where μ is 0 because the point is not abreast of the leg.
    #[inline]
    pub(crate) fn exponent(&self, point: [f32; 2]) -> Option<f32> {
        let Products { cross, radius, .. } = self.products(point)?;
        Some(cross * cross / (self.squared * radius * radius))
    }

    /// The products that decide about a point abreast of the leg, without a square root.
    #[inline]
    fn products(&self, point: [f32; 2]) -> Option<Products> {
        let Self { axis, squared, r_min, r_max, .. } = *self;
        let q = minus(point, self.from);
        let along = axis[0] * q[0] + axis[1] * q[1];
        (along >= 0.0 && along <= squared && squared > 0.0).then(|| Products {
            along,
            cross: axis[0] * q[1] - axis[1] * q[0],
            radius: r_min + (r_max - r_min) * (along / squared),
        })
    }
}

/// Products of the leg's vector with that to a point (`along`: scalar, `cross`: z of the vector product),
/// mm², and the leg's radius abreast of the point, mm.
struct Products {
    along: f32,
    cross: f32,
    radius: f32,
}

/// Position of a point that is abreast of a leg, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abreast {
    /// u, from the foot.
    pub along: f32,
    /// v, left > 0.
    pub across: f32,
    /// Radius ρ(u) of the leg abreast of the point, mm.
    pub radius: f32,
}

/// A leg relative to the ball's start position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeLeg(pub(crate) Leg);

impl RelativeLeg {
    /// In the field frame, for a ball that starts at `ball`.
    pub(crate) fn at(&self, ball: PointMm) -> Leg {
        let [x, y] = ball.to_f32();
        let Leg { from, to, .. } = self.0;
        Leg { from: [from[0] + x, from[1] + y], to: [to[0] + x, to[1] + y], ..self.0 }
    }
}

/// Whether an opponent with this exponent in a leg blocks it.
#[inline]
pub(crate) fn is_blocking(exponent: f32, settings: &RetrievalSettings) -> bool {
    match settings.free_path {
        FreePathRule::Crisp => exponent < settings.limit(),
        FreePathRule::Fuzzy => freedom(Some(exponent)) < settings.free_min,
    }
}

/// 1 − max μ.
pub(crate) fn freedom(least_exponent: Option<f32>) -> f32 {
    least_exponent.map_or(1.0, |exponent| 1.0 - math::exp(-exponent))
}

/// Conversion of mm to m.
fn in_metres([x, y]: [f32; 2]) -> Point<Field> {
    Point::new(x * 0.001, y * 0.001)
}

#[inline]
pub(crate) fn minus(to: [f32; 2], from: [f32; 2]) -> [f32; 2] {
    [to[0] - from[0], to[1] - from[1]]
}
