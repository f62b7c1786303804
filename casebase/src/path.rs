//! `path`: the free-path test: a ball path as the case describes it must be clear of opponents (Ros et al.
//! 2009, §3.3.1).
//!
//! The ball runs through a sequence of legs; each is a fuzzy set that widens from r_min at the foot to r_max
//! at the end: μ = exp(−(v/ρ)²), u along and v across the leg, 0 ≤ u ≤ l. With one opponent above the
//! threshold in any leg the case is not applicable now. Lengths in mm, axes of the field.

use geometry::{Field, Point, math};
use serde::{Deserialize, Serialize};

use crate::action::{Action, CaseRobot, KickId};
use crate::case::Case;
use crate::plan_simulation::{PlanStep, Script, Spot, plan_simulation};
use crate::settings::{FreePathRule, OutOfField, RetrievalSettings};
use crate::stored::Stored;
use crate::table::{self, CaseBase, RawLeg};
use crate::{GoalEnd, PointMm};

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

    fn corridor(&self) -> Corridor {
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
    /// The axis' length, squared.
    squared: f32,
}

impl Corridor {
    fn new(from: [f32; 2], to: [f32; 2], [r_min, r_max]: [f32; 2]) -> Self {
        let axis = minus(to, from);
        Self { from, to, r_min, r_max, axis, squared: axis[0] * axis[0] + axis[1] * axis[1] }
    }

    /// From the table, relative to a ball at `ball`; `rest` is the end of the leg before.
    #[inline]
    pub(crate) fn decode(case: &Stored<'_, '_>, raw: &RawLeg, rest: [f32; 2], ball: [f32; 2]) -> Self {
        let from = match raw.carried_to {
            RawLeg::NOT_CARRIED => rest,
            point => case.carried_to(point),
        };
        let to = if raw.flags & RawLeg::TO_FIELD == 0 { raw.to } else { minus(raw.to, ball) };
        Self::new(from, to, raw.radii)
    }

    /// Where the ball stops.
    #[inline]
    pub(crate) fn to(&self) -> [f32; 2] {
        self.to
    }

    /// (v/ρ)², the negated exponent of μ; `None` where μ is 0 because the point is not abreast of the leg.
    #[inline]
    fn exponent(&self, point: [f32; 2]) -> Option<f32> {
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

/// A blocked leg and the opponent in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocked {
    /// The leg, field frame.
    pub leg: Leg,
    /// Its number in the ball path, from 0.
    pub index: usize,
    /// The opponent's number in the list.
    pub opponent: usize,
    /// Depth of the opponent inside the leg, mm.
    pub inside_mm: f32,
}

/// The first leg that contains an opponent, for a ball at `ball`.
pub fn blocked_leg(
    case: &Case<'_>,
    base: &CaseBase<'_>,
    ball: PointMm,
    opponents: &[PointMm],
    settings: &RetrievalSettings,
) -> Option<Blocked> {
    let mut found = None;
    let mut index = 0;
    each_leg(case, base, ball, settings, |relative| {
        if found.is_none() {
            let blocks = |(_, opponent): &(usize, &PointMm)| {
                let exponent = relative.0.corridor().exponent(opponent.minus(ball).to_f32());
                exponent.is_some_and(|exponent| is_blocking(exponent, settings))
            };
            if let Some((opponent, place)) = opponents.iter().enumerate().find(blocks) {
                let inside_mm = relative.0.blocked_by(place.minus(ball), settings).unwrap_or(0.0);
                found = Some(Blocked { leg: relative.at(ball), index, opponent, inside_mm });
            }
        }
        index += 1;
    });
    found
}

/// The minimum exponent of any opponent in any leg, `None` where no opponent is abreast of one; that of any
/// blocking opponent where the path is blocked. Opponents relative to the ball.
#[inline]
pub(crate) fn least_exponent(
    stored: &Stored<'_, '_>,
    ball: PointMm,
    opponents: &[[f32; 2]],
    settings: &RetrievalSettings,
) -> Option<f32> {
    let mut least: Option<f32> = None;
    let mut look = |corridor: &Corridor| {
        for opponent in opponents {
            if let Some(exponent) = corridor.exponent(*opponent) {
                least = Some(least.map_or(exponent, |least| least.min(exponent)));
            }
        }
        least.is_some_and(|exponent| is_blocking(exponent, settings))
    };
    if settings.out_of_field == OutOfField::Clamp {
        if let Some(case) = stored.case() {
            each_leg(&case, case.base(), ball, settings, |leg| {
                look(&leg.0.corridor());
            });
        }
        return least;
    }
    let mut rest = [0.0; 2];
    for raw in stored.legs().unwrap_or(&[]) {
        let corridor = Corridor::decode(stored, raw, rest, ball.to_f32());
        if look(&corridor) {
            break;
        }
        rest = corridor.to;
    }
    least
}

/// Whether an opponent stands in a leg, with legs as stored and the crisp test. Opponents relative to the
/// ball.
#[inline(always)]
pub(crate) fn is_crisply_blocked(
    case: &Stored<'_, '_>,
    ball: [f32; 2],
    opponents: &[[f32; 2]],
    limit: f32,
) -> bool {
    let Some(legs) = case.legs() else { return true };
    let mut rest = [0.0; 2];
    for raw in legs {
        let corridor = Corridor::decode(case, raw, rest, ball);
        rest = corridor.to;
        let stands_in =
            |opponent: &[f32; 2]| corridor.exponent(*opponent).is_some_and(|exponent| exponent < limit);
        if corridor.squared > 0.0 && opponents.iter().any(stands_in) {
            return true;
        }
    }
    false
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

/// Every leg of the ball path in turn: as stored, or simulated again where adapted positions are clamped to
/// the field.
fn each_leg(
    case: &Case<'_>,
    base: &CaseBase<'_>,
    ball: PointMm,
    settings: &RetrievalSettings,
    mut sink: impl FnMut(RelativeLeg),
) {
    if settings.out_of_field != OutOfField::Clamp {
        return case.relative_legs(ball).for_each(sink);
    }
    // A stored case was simulated without an error when it was built, and clamping moves positions only.
    let _ = plan_simulation(&Clamped { case, base, ball }, base, |step| {
        if let PlanStep::Leg { robot, action, from, to, radii, kind, .. } = step {
            let relative = |spot: Spot| if spot.on_field { minus(spot.at, ball.to_f32()) } else { spot.at };
            let [r_min, r_max] = radii.map(|radius| radius as f32);
            sink(RelativeLeg(Leg {
                from: relative(from),
                to: relative(to),
                r_min,
                r_max,
                robot,
                action,
                kind,
            }));
        }
    });
}

/// A leg relative to the ball's start position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeLeg(Leg);

impl RelativeLeg {
    /// From the table: a stored leg with its robot, action and kind.
    pub(crate) fn decode(case: &Case<'_>, raw: &RawLeg, corridor: Corridor) -> Option<Self> {
        let robot = CaseRobot::new(usize::from(raw.robot))?;
        let action = usize::from(raw.action);
        let kind = match case.action(robot, action)? {
            Action::PassBall(receiver) => LegKind::Pass(receiver),
            Action::Kick(id) => LegKind::Kick(id),
            _ => return None,
        };
        let Corridor { from, to, r_min, r_max, .. } = corridor;
        Some(Self(Leg { from, to, r_min, r_max, robot, action, kind }))
    }

    /// In the field frame, for a ball that starts at `ball`.
    pub(crate) fn at(&self, ball: PointMm) -> Leg {
        let [x, y] = ball.to_f32();
        let moved = |point: [f32; 2]| [point[0] + x, point[1] + y];
        Leg { from: moved(self.0.from), to: moved(self.0.to), ..self.0 }
    }
}

#[inline]
fn minus(to: [f32; 2], from: [f32; 2]) -> [f32; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

/// A case whose adapted positions are clamped to the field.
struct Clamped<'c, 'a> {
    case: &'c Case<'a>,
    base: &'c CaseBase<'a>,
    ball: PointMm,
}

impl Script for Clamped<'_, '_> {
    fn teammates(&self) -> usize {
        self.case.teammates()
    }
    fn defending(&self) -> GoalEnd {
        self.case.defending()
    }
    fn ball(&self) -> PointMm {
        self.case.ball()
    }
    fn position(&self, robot: CaseRobot) -> PointMm {
        let clamped = self.base.field().clamp(self.case.adapted(robot, self.ball));
        clamped.minus(self.case.shift(self.ball))
    }
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        self.case.action(robot, index)
    }
}

/// Number of a case's opponent scopes, moved by `moved`, that contain no opponent, opponents relative to the
/// ball; `None` once they are more than `most`. `cells` are the squares that contain opponents.
#[inline(always)]
pub(crate) fn empty_scopes(
    scopes: &[table::OpponentRecord],
    moved: [f32; 2],
    opponents: &[[f32; 2]],
    cells: u32,
    limit: f32,
    most: u32,
) -> Option<u32> {
    let mut empty = 0;
    for scope in scopes {
        let holds = |opponent: &[f32; 2]| scope.holds(moved, *opponent, limit);
        if scope.cells & cells == 0 || !opponents.iter().any(holds) {
            if empty == most {
                return None;
            }
            empty += 1;
        }
    }
    Some(empty)
}
