//! Does a straight piece of way touch an obstacle, and where is one out of it? Points and segments against shapes; m, s.

use geometry::{Point, Segment, Shape, Vector, math};

use super::{FORESIGHT, OBSTACLES_MAX, Obstacle};

/// An obstacle with the distance that is kept from it.
#[derive(Clone, Copy)]
pub(super) struct Item<F> {
    pub(super) shape: Shape<F>,
    pub(super) velocity: Vector<F>,
    pub(super) moves: bool,
    /// What routes keep from the shape, m: [`SKIN`], or less where start or goal are nearer.
    pub(super) margin: f32,
}

/// All obstacles, and the region to stay in.
pub(super) struct Scene<F> {
    items: [Item<F>; OBSTACLES_MAX],
    count: usize,
    within: Option<Shape<F>>,
}

impl<F: Copy> Scene<F> {
    pub(super) fn new(obstacles: &[Obstacle<F>], within: Option<Shape<F>>) -> Self {
        let nothing = Shape::Disc { center: Point::default(), radius: 0.0 };
        let mut items = [Item { shape: nothing, velocity: Vector::default(), moves: false, margin: SKIN }; _];
        let mut count = 0;
        for (item, obstacle) in items.iter_mut().zip(obstacles) {
            item.shape = obstacle.shape;
            if obstacle.velocity.is_finite() {
                item.velocity = obstacle.velocity;
                item.moves = item.velocity.dot(item.velocity) > SPEED_MIN * SPEED_MIN;
            }
            count += 1;
        }
        Self { items, count, within }
    }

    pub(super) fn items(&self) -> &[Item<F>] {
        self.items.get(..self.count).unwrap_or(&[])
    }

    pub(super) fn moves(&self) -> bool {
        self.items().iter().any(|item| item.moves)
    }

    /// Routes keep [`SKIN`] from everything, but no more than start and goal do.
    pub(super) fn keep_apart(&mut self, from: Point<F>, goal: Point<F>) {
        for item in self.items.iter_mut().take(self.count) {
            let nearest = gap(&item.shape, from).min(gap(&item.shape, goal));
            item.margin = (nearest - TOUCH).clamp(0.0, SKIN);
        }
    }

    pub(super) fn is_inside(&self, point: Point<F>) -> bool {
        self.items().iter().any(|item| item.shape.distance_to(point) < 0.0)
    }

    pub(super) fn stays_within(&self, point: Point<F>) -> bool {
        self.within.is_none_or(|within| within.distance_to(point) <= 0.0)
    }

    /// As [`Self::stays_within`]; who is outside already may come no farther out.
    pub(super) fn stays_within_or_returns(&self, from: Point<F>, to: Point<F>) -> bool {
        self.within.is_none_or(|within| within.distance_to(to) <= within.distance_to(from).max(0.0))
    }

    /// The first obstacle that a piece of way touches, by its number, when it takes from `at` to `at + time` s.
    pub(super) fn first_hit(&self, from: Point<F>, way: Vector<F>, at: f32, time: f32) -> Option<usize> {
        let mut first = None;
        let mut least = f32::INFINITY;
        for (i, item) in self.items().iter().enumerate() {
            if let Some(share) = item.hit(from, way, at, time, item.margin)
                && share < least
            {
                (first, least) = (Some(i), share);
            }
        }
        first
    }

    /// Nothing is touched, with a smaller margin: what is left of braking.
    pub(super) fn is_clear(&self, from: Point<F>, way: Vector<F>, at: f32, time: f32) -> bool {
        self.items().iter().all(|item| item.hit(from, way, at, time, item.margin.min(BRAKE_SKIN)).is_none())
    }

    /// The point itself if it is free, else one nearby that is.
    pub(super) fn nearest_free(&self, point: Point<F>) -> Point<F> {
        let start = self.within.map_or(point, |within| inside(&within, point));
        let mut at = start;
        for _ in 0..PUSHES_MAX {
            let Some(item) = self.items().iter().find(|item| item.shape.distance_to(at) < FREE) else {
                return at;
            };
            at = out_of(&item.shape, at, 2.0 * FREE);
            if let Some(within) = self.within {
                at = inside(&within, at);
            }
        }
        // Between obstacles that overlap: the first free point on growing rings.
        for ring in 1..=RINGS {
            for [x, y] in COMPASS {
                let at = start + Vector::new(x, y) * (ring as f32 * RING_STEP);
                let free = self.items().iter().all(|item| item.shape.distance_to(at) >= FREE);
                if free && self.stays_within(at) {
                    return at;
                }
            }
        }
        start
    }
}

impl<F: Copy> Item<F> {
    /// The shape where it will be at a time.
    pub(super) fn at(&self, time: f32) -> Shape<F> {
        let by = self.velocity * time.clamp(0.0, FORESIGHT);
        match self.shape {
            Shape::Disc { center, radius } => Shape::Disc { center: center + by, radius },
            Shape::Capsule { spine, radius } => {
                Shape::Capsule { spine: Segment::new(spine.from + by, spine.to + by), radius }
            }
            Shape::Box { low, high } => Shape::Box { low: low + by, high: high + by },
        }
    }

    /// Whether a piece of way comes nearer than `margin`, and at which share of it about.
    #[inline]
    fn hit(&self, from: Point<F>, way: Vector<F>, at: f32, time: f32, margin: f32) -> Option<f32> {
        let (mut from, mut way) = (from, way);
        if self.moves {
            // As the obstacle sees it.
            let before = at.min(FORESIGHT);
            from = from - self.velocity * before;
            way += self.velocity * (before - (at + time).min(FORESIGHT));
        }
        match self.shape {
            Shape::Disc { center, radius } => touches(from, way, center, radius + margin),
            Shape::Capsule { spine, radius } => hits_capsule(from, way, &spine, radius + margin),
            Shape::Box { low, high } => hits_box(from, way, low, high, margin),
        }
    }
}

/// By how much the shape may grow and not hold the point: corners of a box stay corners.
fn gap<F: Copy>(shape: &Shape<F>, point: Point<F>) -> f32 {
    match *shape {
        Shape::Box { low, high } => {
            let over = |at: f32, least: f32, most: f32| (least - at).max(at - most);
            over(point.x(), low.x(), high.x()).max(over(point.y(), low.y(), high.y()))
        }
        _ => shape.distance_to(point),
    }
}

/// The share of the way at which it is nearest to `center`, if that is nearer than `radius`.
#[inline]
fn touches<F: Copy>(from: Point<F>, way: Vector<F>, center: Point<F>, radius: f32) -> Option<f32> {
    let offset = center - from;
    let (along, squared) = (offset.dot(way), way.dot(way));
    // Behind, beyond, or beside.
    let share = if along <= 0.0 {
        0.0
    } else if along >= squared {
        1.0
    } else {
        along / squared
    };
    let off = offset - way * share;
    (off.dot(off) < radius * radius).then_some(share)
}

fn hits_capsule<F: Copy>(from: Point<F>, way: Vector<F>, spine: &Segment<F>, radius: f32) -> Option<f32> {
    let bone = spine.vector();
    let offset = spine.from - from;
    // Do they cross? from + s·way = spine.from + t·bone.
    let turn = way.cross(bone);
    if turn != 0.0 {
        let (s, t) = (offset.cross(bone) / turn, offset.cross(way) / turn);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return Some(s);
        }
    }
    let end = |at: Point<F>, share: f32| (spine.distance_to(at) < radius).then_some(share);
    end(from, 0.0)
        .or_else(|| touches(from, way, spine.from, radius))
        .or_else(|| touches(from, way, spine.to, radius))
        .or_else(|| end(from + way, 1.0))
}

/// By slabs: the shares between which it is inside of each pair of sides.
fn hits_box<F: Copy>(
    from: Point<F>,
    way: Vector<F>,
    low: Point<F>,
    high: Point<F>,
    margin: f32,
) -> Option<f32> {
    let (mut enters, mut leaves) = (0.0_f32, 1.0_f32);
    let axes = [
        (from.x(), way.x(), low.x() - margin, high.x() + margin),
        (from.y(), way.y(), low.y() - margin, high.y() + margin),
    ];
    for (at, by, least, most) in axes {
        if by == 0.0 {
            if at <= least || at >= most {
                return None;
            }
        } else {
            let (a, b) = ((least - at) / by, (most - at) / by);
            let (first, last) = if a < b { (a, b) } else { (b, a) };
            enters = enters.max(first);
            leaves = leaves.min(last);
        }
    }
    (enters < leaves).then_some(enters)
}

/// The point nearest to `at` that is `by` outside of the shape.
fn out_of<F: Copy>(shape: &Shape<F>, at: Point<F>, by: f32) -> Point<F> {
    let off = |center: Point<F>, radius: f32| {
        center + (at - center).unit().unwrap_or(Vector::new(1.0, 0.0)) * (radius + by)
    };
    match *shape {
        Shape::Disc { center, radius } => off(center, radius),
        Shape::Capsule { spine, radius } => {
            let foot = spine.closest_to(at);
            if at.distance(foot) > 0.0 {
                off(foot, radius)
            } else {
                let bone = spine.vector().unit().unwrap_or(Vector::new(1.0, 0.0));
                foot + Vector::new(-bone.y(), bone.x()) * (radius + by)
            }
        }
        Shape::Box { low, high } => {
            let [left, right] = [at.x() - low.x(), high.x() - at.x()];
            let [down, up] = [at.y() - low.y(), high.y() - at.y()];
            let least = left.min(right).min(down.min(up));
            if least == left {
                Point::new(low.x() - by, at.y())
            } else if least == right {
                Point::new(high.x() + by, at.y())
            } else if least == down {
                Point::new(at.x(), low.y() - by)
            } else {
                Point::new(at.x(), high.y() + by)
            }
        }
    }
}

/// The point of the shape nearest to `at`.
fn inside<F: Copy>(shape: &Shape<F>, at: Point<F>) -> Point<F> {
    match *shape {
        _ if shape.distance_to(at) <= 0.0 => at,
        Shape::Box { low, high } => Point::new(
            at.x().max(low.x()).min(high.x().max(low.x())),
            at.y().max(low.y()).min(high.y().max(low.y())),
        ),
        Shape::Disc { center, radius } => center + (at - center).clamped(radius),
        Shape::Capsule { spine, radius } => {
            let foot = spine.closest_to(at);
            foot + (at - foot).clamped(radius)
        }
    }
}

/// What routes keep from shapes, m: what a following controller may be off.
pub(super) const SKIN: f32 = 0.02;
/// What braking keeps, m.
const BRAKE_SKIN: f32 = 0.005;
/// Start and goal count as touching below this, m.
const TOUCH: f32 = 0.000_5;
/// A free point is this far outside, m.
const FREE: f32 = 0.002;
/// Slower is standing, m/s.
const SPEED_MIN: f32 = 0.02;
/// Out of one obstacle after another.
const PUSHES_MAX: usize = 6;
/// Rings of 8 points around a covered point, m apart.
const RINGS: u32 = 8;
const RING_STEP: f32 = 0.15;
const COMPASS: [[f32; 2]; 8] = {
    let h = core::f32::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [h, h], [0.0, 1.0], [-h, h], [-1.0, 0.0], [-h, -h], [0.0, -1.0], [h, -h]]
};

/// The unit normal, from the middle of a disc, of its tangent through `from`: on the left seen from there for `side` +1.
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
