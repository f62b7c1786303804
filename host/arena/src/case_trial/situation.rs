//! `situation`: start situation drawn from a case: the robots' places at the start of an attempt. m, field
//! frame.
//!
//! - The ball lies in the scope's core, where the similarity is H (at least 0.8), every place there equally
//!   likely.
//! - Everything else moves along with it, as adaptation does. Robots stand 0.15 m (one standard deviation)
//!   about their places and face 20° past the ball.
//! - Opponents are drawn on their scopes as the scope weighs places: a Gaussian with the scope's radii, cut
//!   off where the scope ends.
//! - An opponent stays in a region: draws outside it are drawn again.

use casebase::{Case, PointMm, Scope};
use geometry::{Angle, Field, Point, Pose, Vector, math};
use hil_sim::{Region, Stream};
use rules::FieldSpec;

/// Field and bodies of a league.
#[derive(Clone, Debug)]
pub(super) struct Bodies {
    pub(super) field: FieldSpec,
    /// Least distance of a robot's centre from the ball at the start, m.
    pub(super) clear_of_ball: f32,
    /// Least distance between two robots at the start, m.
    pub(super) apart: f32,
}

#[derive(Clone, Debug)]
pub(super) struct Places {
    pub(super) ball: Point<Field>,
    /// The robots of the case, in its order.
    pub(super) attackers: Vec<Pose<Field>>,
    /// Opponents, in the order of their scopes: the scope's authored centre, and the drawn place.
    pub(super) opponents: Vec<[Point<Field>; 2]>,
}

/// Draws a situation of `case`; `region` of an opponent's authored centre is where it may stand.
pub(super) fn draw(
    case: &Case<'_>,
    bodies: &Bodies,
    region: impl Fn(Point<Field>) -> Region,
    seed: u64,
) -> Places {
    let mut chance = Stream::new(seed, "rehearsal");
    let field = &bodies.field;
    let centre: Point<Field> = case.ball().into();
    let ball =
        (0..DRAWS).map(|_| centre + in_core(&mut chance, case.ball_scope())).find(|at| field.contains(*at));
    let ball = ball.unwrap_or(centre);
    // The shift of the robots in whole millimetres.
    let shift = case.shift(PointMm::from(ball));
    let place = |at: PointMm| -> Point<Field> { at.plus(shift).into() };
    let mut taken: Vec<Point<Field>> = Vec::new();
    let attackers = case.robots().map(|robot| {
        let centre = place(case.position(robot));
        let draw = |chance: &mut Stream| {
            let [x, y] = [(); 2].map(|()| SCATTER * chance.normal_within(2.0));
            field.clamp(centre + Vector::new(x, y), 0.0)
        };
        let at = clear(&mut chance, bodies, ball, &taken, draw, |_| true).unwrap_or(centre);
        taken.push(at);
        let heading = at.direction_to(ball) + Angle::degrees(LOOKS_PAST_DEG * chance.normal_within(2.0));
        Pose { position: at, heading }
    });
    let attackers = attackers.collect::<Vec<_>>();
    let opponents = case.opponents().map(|(at, scope)| {
        let (authored, centre): (Point<Field>, _) = (at.into(), place(at));
        let region = region(authored);
        let draw = |chance: &mut Stream| centre + on_scope(chance, scope);
        let fits = |at: Point<Field>| region.contains(at) && field.contains(at);
        let at =
            clear(&mut chance, bodies, ball, &taken, draw, fits).unwrap_or_else(|| region.nearest(centre));
        taken.push(at);
        [authored, at]
    });
    let opponents = opponents.collect();
    Places { ball, attackers, opponents }
}

/// The first draw that fits and is clear of the ball and of all robots placed before.
fn clear(
    chance: &mut Stream,
    bodies: &Bodies,
    ball: Point<Field>,
    taken: &[Point<Field>],
    draw: impl Fn(&mut Stream) -> Point<Field>,
    fits: impl Fn(Point<Field>) -> bool,
) -> Option<Point<Field>> {
    (0..DRAWS).map(|_| draw(chance)).find(|at| {
        at.distance(ball) >= bodies.clear_of_ball
            && taken.iter().all(|other| other.distance(*at) >= bodies.apart)
            && fits(*at)
    })
}

/// Uniform in the ellipse in which the similarity is H.
fn in_core(chance: &mut Stream, scope: Scope) -> Vector<Field> {
    let radius = CORE * math::sqrt(chance.share());
    let (sin, cos) = math::sin_cos(math::TAU * chance.share());
    in_metres(scope, radius * cos, radius * sin)
}

/// Draws a point by exp(−(x² + y²)) in the scope's radii, up to the scope's border.
fn on_scope(chance: &mut Stream, scope: Scope) -> Vector<Field> {
    let inside = |(x, y): &(f32, f32)| x * x + y * y <= BORDER;
    let mut bell = || (chance.normal() * math::sqrt(0.5), chance.normal() * math::sqrt(0.5));
    let (x, y) = (0..DRAWS).map(|_| bell()).find(inside).unwrap_or_default();
    in_metres(scope, x, y)
}

fn in_metres(scope: Scope, x: f32, y: f32) -> Vector<Field> {
    Vector::new(x * scope.x as f32 * 0.001, y * scope.y as f32 * 0.001)
}

/// Share of the scope's radii within which the similarity is at least 0.8: √(−ln 0.8).
const CORE: f32 = 0.472_38;
/// A scope's border: −ln 0.367 (docs/case-format.md §3).
const BORDER: f32 = 1.002_393;
/// Scatter of robots about their places, m, one standard deviation: the tolerance of arriving
/// (docs/case-format.md §4).
const SCATTER: f32 = 0.15;
/// Scatter of their headings about the ball, degrees, one standard deviation: an estimate.
const LOOKS_PAST_DEG: f32 = 20.0;
/// Number of draws before the middle is taken.
const DRAWS: usize = 200;
