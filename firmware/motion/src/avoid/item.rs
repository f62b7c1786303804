//! `item`: collision test of a straight path segment. Points and segments against shapes; m, s.

use core::cell::Cell;

use geometry::{Point, Segment, Shape, Vector, math};

use super::{FORESIGHT, OBSTACLES_MAX, Obstacle};

/// An obstacle with the distance that is kept from it, and a circle around it: most tests need the circle
/// alone.
#[derive(Clone, Copy)]
pub(super) struct Item<F> {
    center: Point<F>,
    /// Squares of the circle's radius, with the margins of routes and of braking.
    route: f32,
    brake: f32,
    /// Distance that routes keep from the shape, m: [`SKIN`], or less where start or goal are nearer.
    pub(super) margin: f32,
    /// The circle is the shape.
    is_disc: bool,
    pub(super) moves: bool,
}

/// All obstacles, and the region to stay in.
pub(super) struct Scene<'o, F> {
    obstacles: &'o [Obstacle<F>],
    items: heapless::Vec<Item<F>, OBSTACLES_MAX>,
    moves: bool,
    /// The robot leaves a region without a body.
    leaves_region: bool,
    within: Option<Shape<F>>,
    /// Instructions that are left for the plan.
    effort: Cell<u32>,
}

impl<'o, F: Copy> Scene<'o, F> {
    /// Without its obstacles: [`Scene::look`] fills them in place, because the value is too large to be moved
    /// around.
    pub(super) fn new(obstacles: &'o [Obstacle<F>], within: Option<Shape<F>>, effort: u32) -> Self {
        let obstacles = obstacles.get(..OBSTACLES_MAX).unwrap_or(obstacles);
        let items = heapless::Vec::new();
        Self { obstacles, items, moves: false, leaves_region: false, within, effort: Cell::new(effort) }
    }

    /// Computes the items of all obstacles.
    pub(super) fn look(&mut self) {
        for obstacle in self.obstacles {
            let velocity = obstacle.velocity;
            let mut item = Item {
                center: Point::default(),
                route: 0.0,
                brake: 0.0,
                margin: SKIN,
                is_disc: false,
                moves: velocity.is_finite() && velocity.dot(velocity) > SPEED_MIN * SPEED_MIN,
            };
            self.moves |= item.moves;
            item.enclose(&obstacle.shape);
            // The capacity suffices: the obstacles were counted above.
            let _ = self.items.push(item);
        }
        self.spend(cost::PLAN + self.for_each_item(cost::PLAN_ITEM));
    }

    /// Every obstacle with its item.
    fn all(&self) -> impl Iterator<Item = (&Item<F>, &Obstacle<F>)> {
        self.items.iter().zip(self.obstacles)
    }

    pub(super) fn get(&self, number: usize) -> Option<(&Item<F>, &Obstacle<F>)> {
        self.items.get(number).zip(self.obstacles.get(number))
    }

    pub(super) fn moves(&self) -> bool {
        self.moves
    }

    pub(super) fn within(&self) -> Option<Shape<F>> {
        self.within
    }

    /// Routes keep [`SKIN`] from everything, but no more than start and goal do. A robot that leaves a region
    /// may go through all regions; a body that holds the start is taken to end just before it, so that no
    /// path leads into it. A body that moves with the robot, as a ball that rolls on beside it, is left out
    /// where the exit leads away from it: braking would keep them together; a body that lies before the start
    /// would be pushed along, and stays. Walls meet: the distance kept from the wall nearest to the start is
    /// kept from all of them, else none could be followed around to the next.
    pub(super) fn keep_apart(&mut self, from: Point<F>, goal: Point<F>, leaves: bool) {
        let mut wall = SKIN;
        // Who only dodges a body stays out of the regions.
        self.leaves_region =
            leaves && self.all().any(|(_, obstacle)| !obstacle.is_body && gap(&obstacle.shape, from) < 0.0);
        for (item, obstacle) in self.items.iter_mut().zip(self.obstacles) {
            let behind = || (goal - from).dot(item.center - from) <= 0.0;
            let is_passed = self.leaves_region && !obstacle.is_body;
            if is_passed || leaves && item.moves && gap(&obstacle.shape, from) < 0.0 && behind() {
                item.leave_out();
                continue;
            }
            // Most obstacles are far from both.
            if item.may_hold(from) || item.may_hold(goal) {
                let here = gap(&obstacle.shape, from);
                let nearest = math::min(here, gap(&obstacle.shape, goal)) - TOUCH;
                item.margin = if leaves && here < 0.0 { here - TOUCH } else { nearest.clamp(0.0, SKIN) };
                item.enclose(&obstacle.shape);
                if obstacle.is_wall() {
                    wall = math::min(wall, item.margin);
                }
            }
        }
        if wall < SKIN {
            for (item, obstacle) in self.items.iter_mut().zip(self.obstacles) {
                if obstacle.is_wall() {
                    item.margin = wall;
                    item.enclose(&obstacle.shape);
                }
            }
        }
    }

    /// An obstacle nearer to the point than `least`, which is [`SKIN`] at most.
    pub(super) fn nearer(&self, point: Point<F>, least: f32) -> Option<&Obstacle<F>> {
        self.spend(cost::POINT + self.for_each_item(cost::POINT_ITEM));
        self.all()
            .find(|(item, obstacle)| {
                item.may_hold(point) && {
                    self.spend(cost::SHAPE);
                    obstacle.shape.distance_to(point) < least
                }
            })
            .map(|(_, obstacle)| obstacle)
    }

    fn for_each_item(&self, instructions: u32) -> u32 {
        self.items.len() as u32 * instructions
    }

    /// Takes what was done from the effort.
    pub(super) fn spend(&self, instructions: u32) {
        self.effort.set(self.effort.get().saturating_sub(instructions));
    }

    /// Instructions that are left.
    pub(super) fn effort(&self) -> u32 {
        self.effort.get()
    }

    /// Whether another piece of path may be tested.
    pub(super) fn affords_a_piece(&self) -> bool {
        self.effort() >= cost::PIECE + self.for_each_item(cost::PIECE_ITEM)
    }

    /// Whether no region without a body is first on the straight path among obstacles where they are now;
    /// false where the effort does not suffice to tell.
    pub(super) fn meets_no_region(&self, from: Point<F>, to: Point<F>) -> bool {
        if !self.affords_a_piece() {
            return false;
        }
        let hit = self.first_hit(from, to - from, 0.0, 0.0).and_then(|number| self.get(number));
        hit.is_none_or(|(_, obstacle)| obstacle.is_body)
    }

    pub(super) fn is_inside(&self, point: Point<F>) -> bool {
        self.nearer(point, 0.0).is_some()
    }

    pub(super) fn stays_within(&self, point: Point<F>) -> bool {
        self.within.is_none_or(|within| within.distance_to(point) <= 0.0)
    }

    /// As [`Self::stays_within`]; a robot that is outside already may move no farther out.
    pub(super) fn stays_within_or_returns(&self, from: Point<F>, to: Point<F>) -> bool {
        self.within.is_none_or(|within| within.distance_to(to) <= math::max(within.distance_to(from), 0.0))
    }

    /// The first obstacle that a piece of path touches, by its number, when it takes from `at` to `at + time`
    /// s.
    pub(super) fn first_hit(&self, from: Point<F>, path: Vector<F>, at: f32, time: f32) -> Option<usize> {
        self.spend(cost::PIECE + self.for_each_item(cost::PIECE_ITEM));
        let mut first = None;
        let mut least = f32::INFINITY;
        let seen =
            Seen { from, path, before: math::min(at, FORESIGHT), later: math::min(at + time, FORESIGHT) };
        for (number, (item, obstacle)) in self.all().enumerate() {
            let (from, path) = if item.moves { seen.by(obstacle.velocity) } else { (from, path) };
            if let Some(share) = touches(from, path, item.center, item.route)
                && let Some(share) = self.hit(item, obstacle, from, path, share)
                && share < least
            {
                (first, least) = (Some(number), share);
            }
        }
        first
    }

    /// As [`Item::hit`] with the margin of routes; shapes that are no discs take time.
    #[inline]
    fn hit(
        &self,
        item: &Item<F>,
        obstacle: &Obstacle<F>,
        from: Point<F>,
        path: Vector<F>,
        share: f32,
    ) -> Option<f32> {
        if !item.is_disc {
            self.spend(cost::SHAPE);
        }
        item.hit(&obstacle.shape, from, path, item.margin, share)
    }

    /// Whether no body stands on the straight path; for a body that covers the start, whether the path does
    /// not lead deeper in.
    pub(super) fn sees(&self, from: Point<F>, to: Point<F>) -> bool {
        let path = to - from;
        self.spend(cost::POINT + self.for_each_item(cost::PIECE_ITEM));
        self.all().filter(|(_, obstacle)| obstacle.is_body).all(|(item, obstacle)| {
            if touches(from, path, item.center, item.route).is_none() {
                return true;
            }
            self.spend(2 * cost::SHAPE);
            let depth = obstacle.shape.distance_to(from);
            if depth < 0.0 {
                return obstacle.shape.distance_to(from + path * A_LITTLE) >= depth;
            }
            match obstacle.shape {
                Shape::Disc { center, radius } => touches(from, path, center, square(radius)).is_none(),
                Shape::Capsule { spine, radius } => hits_capsule(from, path, &spine, radius).is_none(),
                Shape::Box { low, high } => hits_box(from, path, low, high, 0.0).is_none(),
            }
        })
    }

    /// Whether no obstacle is touched, with the smaller margin that braking keeps. For a robot that leaves a
    /// region, a moving body whose shape covers the start does not count where the path leads past or away
    /// from it: standing still would not avoid it.
    pub(super) fn is_clear(&self, from: Point<F>, path: Vector<F>, at: f32, time: f32) -> bool {
        let seen =
            Seen { from, path, before: math::min(at, FORESIGHT), later: math::min(at + time, FORESIGHT) };
        self.all().all(|(item, obstacle)| {
            let (begin, relative) = if item.moves { seen.by(obstacle.velocity) } else { (from, path) };
            let margin = math::min(item.margin, BRAKE_SKIN);
            touches(begin, relative, item.center, item.brake)
                .and_then(|share| item.hit(&obstacle.shape, begin, relative, margin, share))
                .is_none_or(|_| {
                    self.leaves_region
                        && item.moves
                        && item.margin < 0.0
                        && leads_past(item.center - from, path)
                })
        })
    }
}

impl<F: Copy> Item<F> {
    /// Computes the circle around the shape, grown by the margins.
    fn enclose(&mut self, shape: &Shape<F>) {
        let (center, radius, corner) = match *shape {
            Shape::Disc { center, radius } => (center, radius, 1.0),
            Shape::Capsule { spine, radius } => {
                let half = spine.vector() * 0.5;
                (spine.from + half, half.norm() + radius, 1.0)
            }
            Shape::Box { low, high } => {
                let half = (high - low) * 0.5;
                (low + half, half.norm(), core::f32::consts::SQRT_2)
            }
        };
        self.is_disc = matches!(shape, Shape::Disc { .. });
        self.center = center;
        // A box that shrinks keeps its circle: the corners that remain may be farther out than a smaller
        // circle.
        let margin = if corner > 1.0 { math::max(self.margin, 0.0) } else { self.margin };
        self.route = square(radius + corner * margin);
        self.brake = square(radius + corner * math::min(margin, BRAKE_SKIN));
    }

    /// Excludes it: no path touches it any more.
    fn leave_out(&mut self) {
        (self.route, self.brake) = (NOWHERE, NOWHERE);
    }

    /// Whether the point is in the circle.
    #[inline]
    fn may_hold(&self, point: Point<F>) -> bool {
        let off = point - self.center;
        off.dot(off) <= self.route
    }

    /// Whether a piece of path that touches the circle at `share` comes nearer than `margin`, and at about
    /// which share.
    #[inline]
    fn hit(&self, shape: &Shape<F>, from: Point<F>, path: Vector<F>, margin: f32, share: f32) -> Option<f32> {
        match *shape {
            _ if self.is_disc => Some(share),
            Shape::Disc { .. } => None,
            Shape::Capsule { spine, radius } => hits_capsule(from, path, &spine, radius + margin),
            Shape::Box { low, high } => hits_box(from, path, low, high, margin),
        }
    }
}

/// The obstacle's shape at a time.
pub(super) fn at<F: Copy>(obstacle: &Obstacle<F>, time: f32) -> Shape<F> {
    let by = obstacle.velocity * time.clamp(0.0, FORESIGHT);
    match obstacle.shape {
        Shape::Disc { center, radius } => Shape::Disc { center: center + by, radius },
        Shape::Capsule { spine, radius } => {
            Shape::Capsule { spine: Segment::new(spine.from + by, spine.to + by), radius }
        }
        Shape::Box { low, high } => Shape::Box { low: low + by, high: high + by },
    }
}

/// A piece of path and when it is travelled, s.
struct Seen<F> {
    from: Point<F>,
    path: Vector<F>,
    before: f32,
    later: f32,
}

impl<F: Copy> Seen<F> {
    /// The piece of path relative to an obstacle that moves with `velocity`.
    #[inline]
    fn by(&self, velocity: Vector<F>) -> (Point<F>, Vector<F>) {
        (self.from - velocity * self.before, self.path + velocity * (self.before - self.later))
    }
}

fn square(x: f32) -> f32 {
    x * x
}

/// Whether a path leads past what is at `offset`, or away from it.
fn leads_past<F: Copy>(offset: Vector<F>, path: Vector<F>) -> bool {
    let along = offset.dot(path);
    along <= 0.0 || square(along) < square(PAST_MOST) * offset.dot(offset) * path.dot(path)
}

/// Distance by which the shape may grow without holding the point: corners of a box stay corners.
fn gap<F: Copy>(shape: &Shape<F>, point: Point<F>) -> f32 {
    match *shape {
        Shape::Box { low, high } => {
            let over = |at: f32, least: f32, most: f32| math::max(least - at, at - most);
            math::max(over(point.x(), low.x(), high.x()), over(point.y(), low.y(), high.y()))
        }
        _ => shape.distance_to(point),
    }
}

/// The share of the path at which it is nearest to `center`, if that is nearer than the root of
/// `radius_squared`.
#[inline]
fn touches<F: Copy>(from: Point<F>, path: Vector<F>, center: Point<F>, radius_squared: f32) -> Option<f32> {
    let offset = center - from;
    let (along, length_squared) = (offset.dot(path), path.dot(path));
    // Behind, beyond, or beside.
    if along <= 0.0 {
        return (offset.dot(offset) < radius_squared).then_some(0.0);
    }
    if along >= length_squared {
        let off = offset - path;
        return (off.dot(off) < radius_squared).then_some(1.0);
    }
    let aside = offset.cross(path);
    (aside * aside < radius_squared * length_squared).then(|| along / length_squared)
}

fn hits_capsule<F: Copy>(from: Point<F>, path: Vector<F>, spine: &Segment<F>, radius: f32) -> Option<f32> {
    let bone = spine.vector();
    let offset = spine.from - from;
    // Intersection test: from + s·step = spine.from + t·bone.
    let turn = path.cross(bone);
    if turn != 0.0 {
        let per_turn = 1.0 / turn;
        let (s, t) = (offset.cross(bone) * per_turn, offset.cross(path) * per_turn);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return Some(s);
        }
    }
    let end = |at: Point<F>, share: f32| (spine.distance_to(at) < radius).then_some(share);
    end(from, 0.0)
        .or_else(|| touches(from, path, spine.from, square(radius)))
        .or_else(|| touches(from, path, spine.to, square(radius)))
        .or_else(|| end(from + path, 1.0))
}

/// Slab test: the shares between which it is inside of each pair of sides.
fn hits_box<F: Copy>(
    from: Point<F>,
    path: Vector<F>,
    low: Point<F>,
    high: Point<F>,
    margin: f32,
) -> Option<f32> {
    let (mut enters, mut leaves) = (0.0_f32, 1.0_f32);
    let axes = [
        (from.x(), path.x(), low.x() - margin, high.x() + margin),
        (from.y(), path.y(), low.y() - margin, high.y() + margin),
    ];
    for (at, by, least, most) in axes {
        if by == 0.0 {
            if at <= least || at >= most {
                return None;
            }
        } else {
            let (a, b) = ((least - at) / by, (most - at) / by);
            let (first, last) = if a < b { (a, b) } else { (b, a) };
            enters = math::max(enters, first);
            leaves = math::min(leaves, last);
        }
    }
    (enters < leaves).then_some(enters)
}

impl<F: Copy> Obstacle<F> {
    /// Whether it is a body with straight sides.
    fn is_wall(&self) -> bool {
        self.is_body && matches!(self.shape, Shape::Box { .. })
    }
}

/// Distance that routes keep from shapes, m: the error of a controller that follows them.
pub(super) const SKIN: f32 = 0.02;
/// Distance that braking keeps, m.
const BRAKE_SKIN: f32 = 0.005;
/// A path that leads past a body leads towards it by this at most, as a cosine: centres 0.2 m apart pass at
/// 0.18 m, two robots' radii.
const PAST_MOST: f32 = 0.44;
/// A share of a path long enough to give its direction.
const A_LITTLE: f32 = 0.1;
/// Square radius of an empty circle: it is never touched.
const NOWHERE: f32 = -1.0;
/// Start and goal count as touching below this, m.
const TOUCH: f32 = 0.000_5;
/// A slower obstacle counts as standing, m/s.
const SPEED_MIN: f32 = 0.02;

/// Instructions of a Cortex-M4 that the parts of a plan take at most, by which its effort is kept: estimates
/// from the table of firmware/motion/README.md, held together by the worst step of whole matches
/// (`qemu_match`).
pub(super) mod cost {
    /// What every plan does: motions, the checks of its step, the choice of the verdict.
    pub(crate) const PLAN: u32 = 3_500;
    /// The same for an obstacle: its circle, its margin, and three checks of braking.
    pub(crate) const PLAN_ITEM: u32 = 170;
    /// A piece of path: its corner and its place in the search.
    pub(crate) const PIECE: u32 = 900;
    /// A piece of path and an obstacle.
    pub(crate) const PIECE_ITEM: u32 = 35;
    /// A point.
    pub(crate) const POINT: u32 = 60;
    /// A point and an obstacle.
    pub(crate) const POINT_ITEM: u32 = 14;
    /// An obstacle in the least plan: two points and a piece of path.
    pub(crate) const ITEM: u32 = PLAN_ITEM + 2 * POINT_ITEM + PIECE_ITEM;
    /// Where the circle is touched: the shape itself.
    pub(crate) const SHAPE: u32 = 130;
    /// A candidate for an exit: the point itself, …
    pub(crate) const EXIT: u32 = 50;
    /// … and a comparison with one that is known.
    pub(crate) const EXIT_KNOWN: u32 = 13;
}

/// The unit normal, from the middle of a disc, of its tangent through `from`: on the left seen from there for
/// `side` +1.
pub(super) fn tangent<F: Copy>(from: Point<F>, center: Point<F>, radius: f32, side: f32) -> Vector<F> {
    let out = from - center;
    let squared = out.dot(out);
    if squared <= radius * radius {
        return out.unit().unwrap_or(Vector::new(1.0, 0.0));
    }
    let per = 1.0 / squared;
    let (along, across) = (radius * per, math::sqrt(squared - radius * radius) * per * side);
    out * along + Vector::new(out.y(), -out.x()) * across
}
