//! `avoid`: path planning around robots and out of forbidden regions, with the velocity of the next control
//! step.
//!
//! [`plan`] is called every step and takes no more instructions than the course's effort. It answers in three
//! parts:
//!
//! 1. **Goal.** A target inside an obstacle is moved to a free point nearby. A start inside one is left for
//!    such a point by a short path ([`RouteVerdict::Escape`]): through regions, around bodies and out of no
//!    wall. A search that takes more than half of the effort goes on in the next step ([`Carried`]).
//! 2. **Route.** The straight path, or the cheapest path found over tangent points of the obstacles on it: a
//!    search of at most [`CHECKS_MAX`] straight pieces in a fixed order; where the effort is spent before, it
//!    goes on in the next step. Cost is length, plus what turning the present velocity costs.
//! 3. **Next step.** The near-time-optimal motion to the goal, or past the first corner, if the robot can
//!    still brake straight to a stop without touching anything afterwards; else one that first loses its
//!    sideways speed; else braking. So a robot that could brake before its first step can after every step:
//!    **it enters no obstacle that stands still.** Moving ones are taken to keep their velocity for
//!    [`FORESIGHT`]; against these there is no guarantee.
//!
//! Obstacles are regions for the robot's *centre*: grow others' and the rules' shapes ([`Shape::grown`]) by
//! the robot's own radius, and by the errors of its vision and wheels. Corners of boxes stay corners. SI
//! units, field frame or any other.

mod exit;
mod item;
mod route;

use geometry::{Point, Shape, Vector, math};

use self::exit::ExitSearch;
use self::item::{Scene, cost};
use self::route::{CarriedRoute, Route};
use crate::trajectory::{CalcMotion, FreeLimits, FreeMotion, Motion, State, usable};

/// A region that the robot's centre must not enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle<F> {
    /// Shape that the robot's centre must not enter, m.
    pub shape: Shape<F>,
    /// Velocity of the whole shape, m/s.
    pub velocity: Vector<F>,
    /// Whether it is a body to collide with. A robot that leaves a region without a body may go through
    /// others.
    pub is_body: bool,
}

impl<F: Copy> Obstacle<F> {
    /// A body that stands still: a wall.
    pub fn standing(shape: Shape<F>) -> Self {
        Self { shape, velocity: Vector::default(), is_body: true }
    }

    /// A region without a body that the rules forbid to enter.
    pub fn region(shape: Shape<F>) -> Self {
        Self { is_body: false, ..Self::standing(shape) }
    }

    /// A robot, as a disc of both radii and a margin.
    pub fn robot(center: Point<F>, velocity: Vector<F>, radius: f32) -> Self {
        Self::moving(Shape::Disc { center, radius }, velocity)
    }

    /// A body that moves.
    pub fn moving(shape: Shape<F>, velocity: Vector<F>) -> Self {
        Self { shape, velocity, is_body: true }
    }
}

/// Input of the planner.
#[derive(Clone, Copy, Debug)]
pub struct Course<'o, F> {
    /// Position of the robot's centre, m.
    pub from: Point<F>,
    /// Velocity of the robot's centre, m/s.
    pub velocity: Vector<F>,
    /// Where it is to stop, m.
    pub to: Point<F>,
    /// Present limits of its motion.
    pub limits: FreeLimits,
    /// Obstacles to keep out of; only the first [`OBSTACLES_MAX`] are used.
    pub obstacles: &'o [Obstacle<F>],
    /// Where its centre must stay, such as the field surface less the robot's radius; any convex shape.
    pub within: Option<Shape<F>>,
    /// Whether the robot goes straight on as far as it can brake where not even a first corner is found and
    /// no region is first on the straight path: a robot that comes is not passed by waiting for it. Where
    /// many leave a region at once they would hold each other up.
    pub straight_on: bool,
    /// Time until the next plan, s, at most 1.
    pub step: f32,
    /// Most instructions of a Cortex-M4 that the plan may take, by the estimates of its parts;
    /// [`EFFORT_MAX`] suffices for every scene.
    pub effort: u32,
}

/// Kind of path found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RouteVerdict<F> {
    /// Straight to the goal.
    Direct,
    /// Around at least one obstacle.
    Around {
        /// The first corner, m.
        via: Point<F>,
    },
    /// Out of the obstacle it is in.
    Escape {
        /// The point outside, m.
        to: Point<F>,
    },
    /// No path was found; goes as near as possible.
    Blocked {
        /// The reached point nearest to the goal.
        at: Point<F>,
    },
}

/// Restraint of the route's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restraint {
    /// No restraint: it is driven.
    None,
    /// It would not be safe; sideways speed is lost first.
    Straightened,
    /// Neither would be safe: it brakes.
    Braked,
    /// Not even braking avoids a contact: it brakes.
    Unavoidable,
}

/// Result of the planner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detour<F> {
    /// Whether the path is direct, a detour or blocked.
    pub verdict: RouteVerdict<F>,
    /// Stop position: the target, or the free point that replaces it.
    pub goal: Point<F>,
    /// Length of the route to the goal, m; of its known part where blocked.
    pub length: f32,
    /// Whether the route's motion is driven.
    pub restraint: Restraint,
    /// **Motion to drive**: place, velocity and acceleration at the end of the step.
    pub next: State<F>,
    /// Motion along the route: to the goal, or past the first corner.
    pub motion: FreeMotion<F>,
}

/// What a plan leaves to the robot's next one: searches that did not end within its effort, and their
/// results.
#[derive(Clone, Debug)]
pub struct Carried<F> {
    exits: ExitSearch<F>,
    route: CarriedRoute<F>,
}

impl<F> Default for Carried<F> {
    fn default() -> Self {
        Self { exits: ExitSearch::default(), route: CarriedRoute::default() }
    }
}

impl<F> Carried<F> {
    /// Whether the search for a route did not end within the effort and goes on in the next step.
    pub fn is_searching(&self) -> bool {
        self.route.is_unfinished()
    }
}

/// Instructions with which a plan among this many obstacles tests the straight path at least.
pub fn effort_least(obstacles: usize) -> u32 {
    cost::PLAN + 2 * cost::POINT + cost::PIECE + obstacles as u32 * cost::ITEM
}

/// Plans the next step; `carried` is the robot's own, and kept from step to step.
pub fn plan<F: Copy>(course: &Course<'_, F>, carried: &mut Carried<F>) -> Detour<F> {
    let Course { from, velocity, to, limits, within, step, .. } = *course;
    let time_passes = step > 0.0 && step <= STEP_MAX;
    if !time_passes || !limits.are_usable() || !usable(from, velocity, to) {
        // Standing where it is, if that is known.
        let motion = FreeLimits::default().plan(from, Vector::new(f32::NAN, 0.0), to);
        let next = motion.at(0.0);
        let (verdict, restraint) = (RouteVerdict::Blocked { at: next.position }, Restraint::Braked);
        return Detour { verdict, goal: next.position, length: 0.0, restraint, next, motion };
    }
    let mut scene = Scene::new(course.obstacles, within, course.effort);
    scene.look();
    if scene.is_inside(from) {
        return escape(course, &mut scene, carried);
    }
    let goal = scene.nearest_free(to, &mut carried.exits);
    scene.keep_apart(from, goal, false);
    let route = Route::find(&scene, &mut carried.route, (from, velocity), goal, &limits);
    let (verdict, towards) = match route.via {
        _ if !route.arrives => {
            let straight = course.straight_on && route.via.is_none() && scene.meets_no_region(from, goal);
            let end = if straight { goal } else { route.end };
            (RouteVerdict::Blocked { at: route.end }, route.via.unwrap_or(end))
        }
        None => (RouteVerdict::Direct, goal),
        Some(via) => (RouteVerdict::Around { via }, past(from, via, route.behind, &limits)),
    };
    let motion = limits.plan(from, velocity, towards);
    let (next, restraint) = safe_step(course, &scene, &motion, towards);
    Detour { verdict, goal, length: route.length, restraint, next, motion }
}

/// Out of the obstacle that holds the start: to a free point, around all bodies, through any region.
fn escape<F: Copy>(course: &Course<'_, F>, scene: &mut Scene<'_, F>, carried: &mut Carried<F>) -> Detour<F> {
    let Course { from, velocity, to, limits, .. } = *course;
    let exit = scene.exit(from, &mut carried.exits);
    // One search a step: a free point for a covered target is searched for when the robot is out.
    let goal = if scene.is_inside(to) { exit } else { to };
    scene.keep_apart(from, exit, true);
    let route = Route::find(scene, &mut carried.route, (from, velocity), exit, &limits);
    carried.exits.is_reachable = route.arrives;
    let towards = match route.via {
        Some(via) if route.arrives => past(from, via, route.behind, &limits),
        Some(via) => via,
        // Where no path is known, as far as it gets.
        None => exit,
    };
    let motion = limits.plan(from, velocity, towards);
    let (next, restraint) = safe_step(course, scene, &motion, towards);
    let length = route.length + exit.distance(goal);
    Detour { verdict: RouteVerdict::Escape { to: exit }, goal, length, restraint, next, motion }
}

/// A point beyond a corner, at such a distance that the robot comes to the corner as fast as it can turn
/// there: from its speed limit straight on down to standstill at a right angle.
fn past<F: Copy>(from: Point<F>, via: Point<F>, behind: Point<F>, limits: &FreeLimits) -> Point<F> {
    let (first, second) = (via - from, behind - via);
    let (Some(along), Some(on)) = (first.unit(), second.unit()) else { return via };
    let speed = limits.speed * math::max(along.dot(on), 0.0);
    let beyond = 0.5 * speed * speed / limits.braking;
    via + along * math::min(beyond, second.norm())
}

/// The first of the possible steps after which the robot can brake to a stop without touching anything.
fn safe_step<F: Copy>(
    course: &Course<'_, F>,
    scene: &Scene<'_, F>,
    motion: &FreeMotion<F>,
    towards: Point<F>,
) -> (State<F>, Restraint) {
    let wanted = motion.at(course.step);
    if brakes_clear(course, scene, &wanted) {
        return (wanted, Restraint::None);
    }
    let straight = straightened(course, towards);
    if brakes_clear(course, scene, &straight) {
        return (straight, Restraint::Straightened);
    }
    let braked = braked(course);
    let restraint =
        if brakes_clear(course, scene, &braked) { Restraint::Braked } else { Restraint::Unavoidable };
    (braked, restraint)
}

/// From this state, braking straight ahead to a stop touches nothing and stays within.
fn brakes_clear<F: Copy>(course: &Course<'_, F>, scene: &Scene<'_, F>, state: &State<F>) -> bool {
    let speed = state.velocity.norm();
    let time = speed / course.limits.braking;
    let path = state.velocity * (0.5 * time);
    scene.stays_within_or_returns(course.from, state.position + path)
        && scene.is_clear(state.position, path, course.step, time)
}

/// Cancels the speed across the path with all that the limits leave; the remainder accelerates along it.
fn straightened<F: Copy>(course: &Course<'_, F>, towards: Point<F>) -> State<F> {
    let Course { from, velocity, limits, step, .. } = *course;
    let along = (towards - from).unit().unwrap_or(Vector::new(1.0, 0.0));
    let across = Vector::new(-along.y(), along.x());
    let (ahead, side) = (velocity.dot(along), velocity.dot(across));
    let loss = limits.braking * step;
    let lost = math::clamp(side, -loss, loss);
    // No acceleration is left along the path where all of it is needed; a robot that moves backwards brakes
    // that first.
    let left = (1.0 - lost.abs() / loss.max(f32::MIN_POSITIVE)).max(0.0);
    let gain = limits.acceleration * step * left;
    let next = velocity + across * -lost + along * gain.min((limits.speed - ahead).max(0.0));
    moved(course, next)
}

fn braked<F: Copy>(course: &Course<'_, F>) -> State<F> {
    let speed = course.velocity.norm();
    let loss = course.limits.braking * course.step;
    let factor = if speed > loss { 1.0 - loss / speed } else { 0.0 };
    moved(course, course.velocity * factor)
}

/// The state after a step in which the velocity changes evenly to `velocity`.
fn moved<F: Copy>(course: &Course<'_, F>, velocity: Vector<F>) -> State<F> {
    let step = course.step.max(f32::MIN_POSITIVE);
    State {
        position: course.from + (course.velocity + velocity) * (0.5 * course.step),
        velocity,
        acceleration: (velocity - course.velocity) * (1.0 / step),
    }
}

/// Most obstacles that are used: 21 other robots, the rules' 12 shapes, and a reserve.
pub const OBSTACLES_MAX: usize = 36;
/// More instructions than any plan takes.
pub const EFFORT_MAX: u32 = 1 << 20;
/// Most straight pieces that a search tests: around a goal and into its opening it takes as many.
pub const CHECKS_MAX: u32 = 24;
/// Longest control step, s.
const STEP_MAX: f32 = 1.0;
/// Time for which other robots are assumed to keep their velocity, s: about what a robot needs to change it.
pub const FORESIGHT: f32 = 0.5;

#[cfg(test)]
mod tests;
