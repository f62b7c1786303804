//! `exit`: finds a free point near a covered one: out of overlapping obstacles and inside the region to stay
//! in. m.
//!
//! A best-first search over candidates: on the sides of the box, or around the disc or capsule, that covers a
//! point; a candidate that is covered itself is left by the same method, the one nearest to the start first.
//! Candidates outside the region to stay in are no exits: a half-plane that ends beyond a wall is left on the
//! side that lies on the field surface. Where [`TRIES_MAX`] candidates were tried in vain, the nearest free
//! point of a lattice over the region is taken. Deterministic, and bounded: a search looks at [`TRIES_MAX`]
//! candidates and [`COLUMNS`] × [`ROWS`] points of the lattice at most.

use geometry::{Point, Shape, Vector, math};

use super::item::Scene;

impl<F: Copy> Scene<'_, F> {
    /// The point itself if it is free, else one nearby that is; without one, the point moved inside. For a
    /// target, in every step: few candidates, then the first free point on rings around it.
    pub(super) fn nearest_free(&self, point: Point<F>) -> Point<F> {
        let start = self.within().map_or(point, |within| inside(&within, point));
        self.search(start, TRIES_TO_GOAL_MAX, |_| true)
            .or_else(|| self.first_on_rings(start))
            .unwrap_or(start)
    }

    /// Where to leave what covers a robot: the nearest free point with no body on the straight path to it,
    /// else the nearest.
    pub(super) fn exit(&self, from: Point<F>, effort: u32) -> Point<F> {
        let start = self.within().map_or(from, |within| inside(&within, from));
        let tries = (effort / EFFORT_A_TRY).min(TRIES_MAX) as usize;
        let found = self.search(start, tries, |exit| self.sees(from, exit));
        found.or_else(|| self.nearest_of_lattice(start)).unwrap_or(start)
    }

    fn search(&self, start: Point<F>, tries: usize, suits: impl Fn(Point<F>) -> bool) -> Option<Point<F>> {
        let Some(cover) = self.cover(start) else { return Some(start) };
        let mut exits = Exits { start, list: heapless::Vec::new() };
        self.add_exits(&mut exits, &cover, start);
        let mut free = None;
        for _ in 0..tries {
            let Some(at) = exits.take_nearest() else { break };
            match self.cover(at) {
                None if suits(at) => return Some(at),
                None => free = free.or(Some(at)),
                Some(cover) => self.add_exits(&mut exits, &cover, at),
            }
        }
        free
    }

    /// The first free point on growing rings.
    fn first_on_rings(&self, start: Point<F>) -> Option<Point<F>> {
        let points = RINGS
            .into_iter()
            .flat_map(|ring| COMPASS.into_iter().map(move |[x, y]| start + Vector::new(x, y) * ring));
        points.into_iter().find(|at| {
            self.spend(0, 1);
            self.stays_within(*at) && self.cover(*at).is_none()
        })
    }

    /// The shape of an obstacle in which the point lies, or that it touches.
    fn cover(&self, point: Point<F>) -> Option<Shape<F>> {
        self.nearer(point, FREE).map(|obstacle| obstacle.shape)
    }

    /// Exit points of a shape from a point in it, as far as they lie inside.
    fn add_exits(&self, exits: &mut Exits<F>, shape: &Shape<F>, at: Point<F>) {
        let same = if matches!(shape, Shape::Box { .. }) { SAME } else { SAME_AROUND };
        let mut add = |exit: Point<F>| {
            if self.stays_within(exit) {
                exits.add(exit, same);
            }
        };
        match *shape {
            Shape::Box { low, high } => {
                add(Point::new(low.x() - OFF, at.y()));
                add(Point::new(high.x() + OFF, at.y()));
                add(Point::new(at.x(), low.y() - OFF));
                add(Point::new(at.x(), high.y() + OFF));
            }
            Shape::Disc { center, radius } => {
                let out = (at - center).unit().unwrap_or(Vector::new(1.0, 0.0)) * (radius + OFF);
                let left = Vector::new(-out.y(), out.x());
                // Along both axes first, parallel to walls and boxes: of nearly equal candidates the first
                // one is used.
                let off = at - center;
                let reach =
                    |off: f32| math::sqrt(math::max((radius + OFF) * (radius + OFF) - off * off, 0.0));
                let (x, y) = (reach(off.y()), reach(off.x()));
                add(Point::new(center.x() - x, at.y()));
                add(Point::new(center.x() + x, at.y()));
                add(Point::new(at.x(), center.y() - y));
                add(Point::new(at.x(), center.y() + y));
                add(center + out);
                add(center + left);
                add(center - left);
                add(center - out);
            }
            Shape::Capsule { spine, radius } => {
                let reach = radius + OFF;
                let along = spine.vector().unit().unwrap_or(Vector::new(1.0, 0.0));
                let foot = spine.closest_to(at);
                let left = Vector::new(-along.y(), along.x()) * reach;
                if let Some(out) = (at - foot).unit() {
                    add(foot + out * reach);
                }
                add(foot + left);
                add(foot - left);
                add(spine.from - along * reach);
                add(spine.to + along * reach);
            }
        }
    }

    /// The free point of a lattice over the region to stay in that is nearest to `start`.
    fn nearest_of_lattice(&self, start: Point<F>) -> Option<Point<F>> {
        let Shape::Box { low, high } = self.within()? else { return None };
        let cell = high - low;
        let mut best: Option<(f32, Point<F>)> = None;
        for i in 0..COLUMNS * ROWS {
            let share = |at: u8, of: u8| (f32::from(at) + 0.5) / f32::from(of);
            let (x, y) = (share(i % COLUMNS, COLUMNS), share(i / COLUMNS, ROWS));
            let at = low + Vector::new(cell.x() * x, cell.y() * y);
            let off = at - start;
            let squared = off.dot(off);
            if best.is_none_or(|(least, _)| squared < least) && self.cover(at).is_none() {
                best = Some((squared, at));
            }
        }
        best.map(|(_, at)| at)
    }
}

/// Candidates of a search, each tried once.
struct Exits<F> {
    start: Point<F>,
    list: heapless::Vec<Exit<F>, EXITS_MAX>,
}

struct Exit<F> {
    at: Point<F>,
    /// Square of its distance from the start, m²; infinite once tried.
    squared: f32,
}

impl<F: Copy> Exits<F> {
    /// Adds a candidate that is farther than `least` from all others along an axis; without capacity the
    /// search continues with those there are.
    // Called from many places; a copy in each takes 2 kB of flash.
    #[inline(never)]
    fn add(&mut self, at: Point<F>, least: f32) {
        let same = |exit: &Exit<F>| {
            let off = exit.at - at;
            off.x().abs() < least && off.y().abs() < least
        };
        if !self.list.iter().any(same) {
            let off = at - self.start;
            let _ = self.list.push(Exit { at, squared: off.dot(off) });
        }
    }

    fn take_nearest(&mut self) -> Option<Point<F>> {
        let mut best: Option<&mut Exit<F>> = None;
        for exit in &mut self.list {
            if exit.squared < best.as_ref().map_or(f32::INFINITY, |best| best.squared) {
                best = Some(exit);
            }
        }
        let best = best?;
        best.squared = f32::INFINITY;
        Some(best.at)
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

/// Distance of a free point from a shape, m.
const FREE: f32 = 0.002;
/// Distance of candidates from a shape, m.
const OFF: f32 = 2.0 * FREE;
/// Candidates nearer to each other than this along both axes are one, m: on the sides of boxes, which may
/// leave narrow gaps.
const SAME: f32 = 0.001;
/// The same around discs and capsules, of which there would be too many.
const SAME_AROUND: f32 = 0.03;
/// Most candidates that are tested: with 16, keepers do not find into a goal opening in which another robot
/// stands.
const TRIES_MAX: u32 = 32;
/// Effort for testing one candidate, out of what a route out may take.
const EFFORT_A_TRY: u32 = 12;
/// Most candidates for a target that is covered: a robot that gets near it searches again.
const TRIES_TO_GOAL_MAX: usize = 2;
/// Most candidates that are stored.
const EXITS_MAX: usize = 64;
/// Points of the lattice along the region's x and y.
const COLUMNS: u8 = 6;
const ROWS: u8 = 4;
/// Rings of 8 points around a covered point, m.
const RINGS: [f32; 4] = [0.15, 0.3, 0.6, 1.2];
const COMPASS: [[f32; 2]; 8] = {
    let h = core::f32::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [h, h], [0.0, 1.0], [-h, h], [-1.0, 0.0], [-h, -h], [0.0, -1.0], [h, -h]]
};
