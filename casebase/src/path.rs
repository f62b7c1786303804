//! `path`: the free-path test: a ball path as the case describes it must be clear of opponents (Ros et al.
//! 2009, §3.3.1).
//!
//! The ball runs through a sequence of legs, each a fuzzy set ([`Leg`]). With one opponent above the
//! threshold in any leg the case is not applicable now. Lengths in mm, axes of the field.

use crate::action::{Action, CaseRobot};
use crate::case::Case;
use crate::leg::{Corridor, Leg, RelativeLeg, is_blocking, minus};
use crate::plan_simulation::{PlanStep, Script, Spot, plan_simulation};
use crate::settings::{OutOfField, RetrievalSettings};
use crate::stored::Stored;
use crate::table::{self, CaseBase};
use crate::{GoalEnd, PointMm};

/// A blocked leg and the opponent in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocked {
    /// The leg, field frame.
    pub leg: Leg,
    /// Number of the leg in the ball path, from 0.
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
            let corridor = relative.0.corridor();
            let mut exponents = opponents.iter().map(|at| corridor.exponent(at.minus(ball).to_f32()));
            let opponent = exponents.position(|exponent| exponent.is_some_and(|e| is_blocking(e, settings)));
            if let Some((opponent, place)) = opponent.and_then(|n| Some((n, opponents.get(n)?))) {
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
    let mut least = None;
    if settings.out_of_field == OutOfField::Clamp {
        if let Some(case) = stored.case() {
            each_leg(&case, case.base(), ball, settings, |leg| {
                least = least_of(least, &leg.0.corridor(), opponents);
            });
        }
        return least;
    }
    let mut rest = [0.0; 2];
    for raw in stored.legs().unwrap_or(&[]) {
        let corridor = stored.corridor(raw, rest, ball.to_f32());
        least = least_of(least, &corridor, opponents);
        if least.is_some_and(|exponent| is_blocking(exponent, settings)) {
            break;
        }
        rest = corridor.to();
    }
    least
}

/// The smaller of `least` and the minimum exponent of any opponent in a leg.
#[inline]
fn least_of(mut least: Option<f32>, corridor: &Corridor, opponents: &[[f32; 2]]) -> Option<f32> {
    for opponent in opponents {
        if let Some(exponent) = corridor.exponent(*opponent) {
            least = Some(least.map_or(exponent, |least| least.min(exponent)));
        }
    }
    least
}

/// Returns whether an opponent stands in a leg, with legs as stored and the crisp test. Opponents relative to
/// the ball.
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
        let corridor = case.corridor(raw, rest, ball);
        rest = corridor.to();
        let stands_in =
            |opponent: &[f32; 2]| corridor.exponent(*opponent).is_some_and(|exponent| exponent < limit);
        if corridor.has_length() && opponents.iter().any(stands_in) {
            return true;
        }
    }
    false
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
        if scope.cells & cells == 0 || !scope.holds_any(moved, opponents, limit) {
            if empty == most {
                return None;
            }
            empty += 1;
        }
    }
    Some(empty)
}
