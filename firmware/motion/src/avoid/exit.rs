//! `exit`: search for a free point near a covered one: out of overlapping obstacles and inside the region to
//! stay in. m.
//!
//! A best-first search over candidates: on the sides of the box, or around the disc or capsule, that covers a
//! point; a candidate that is covered itself is left by the same method, the one nearest to the start first.
//! Candidates outside the region to stay in are no exits: a half-plane that ends beyond a wall is left on the
//! side that lies on the field surface. Where [`TRIES_MAX`] candidates were tried in vain, the nearest free
//! point of a lattice over the region is taken.
//!
//! Deterministic, and bounded in each step: a search takes half of the plan's effort at most, and a robot's
//! way out is searched for in as many steps as that takes ([`ExitSearch`]). Candidates are tested in the
//! scene of the step that tests them.

use geometry::{Point, Shape, Vector, math};

use super::item::{Scene, cost};

/// Search for a way out of what covers a robot, kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct ExitSearch<F> {
    /// Where it began.
    start: Point<F>,
    candidates: heapless::Vec<Exit<F>, EXITS_MAX>,
    /// Candidates and then lattice points that were tested; [`TESTS_MAX`] once it has ended.
    tested: u32,
    /// Covered point whose exits are being added, and how many of them were.
    adding: Option<(Point<F>, usize)>,
    /// Free point that is used where none in sight is found.
    unseen: Option<Point<F>>,
    /// Result of the last search that ended.
    exit: Option<Point<F>>,
    /// A route leads to it.
    pub(super) is_reachable: bool,
}

impl<F> Default for ExitSearch<F> {
    fn default() -> Self {
        Self {
            start: Point::default(),
            candidates: heapless::Vec::new(),
            tested: TESTS_MAX,
            adding: None,
            unseen: None,
            exit: None,
            is_reachable: false,
        }
    }
}

impl<F: Copy> ExitSearch<F> {
    /// Forgets it: the robot is out.
    pub(super) fn end(&mut self) {
        (self.tested, self.exit) = (TESTS_MAX, None);
    }

    fn begin(&mut self, start: Point<F>) {
        (self.start, self.tested, self.adding, self.unseen) = (start, 0, None, None);
        self.candidates.clear();
    }

    fn goes_on(&self) -> bool {
        self.tested < TESTS_MAX
    }

    fn ends_with(&mut self, exit: Point<F>) -> Point<F> {
        (self.tested, self.exit) = (TESTS_MAX, Some(exit));
        exit
    }

    /// Adds a candidate that is farther than `least` from all others along an axis; without capacity the
    /// search continues with those there are.
    // Called from many places; a copy in each takes 2 kB of flash.
    #[inline(never)]
    fn add(&mut self, at: Point<F>, least: f32) {
        let same = |exit: &Exit<F>| {
            let off = exit.at - at;
            off.x().abs() < least && off.y().abs() < least
        };
        if !self.candidates.iter().any(same) {
            let off = at - self.start;
            let _ = self.candidates.push(Exit { at, squared: off.dot(off) });
        }
    }

    fn nearest(&mut self) -> Option<&mut Exit<F>> {
        let mut best: Option<&mut Exit<F>> = None;
        for exit in &mut self.candidates {
            if exit.squared < best.as_ref().map_or(f32::INFINITY, |best| best.squared) {
                best = Some(exit);
            }
        }
        best
    }

    fn take_nearest(&mut self) -> Option<Point<F>> {
        let best = self.nearest()?;
        best.squared = f32::INFINITY;
        Some(best.at)
    }
}

#[derive(Clone, Copy, Debug)]
struct Exit<F> {
    at: Point<F>,
    /// Square of its distance from the start, m²; infinite once tried.
    squared: f32,
}

impl<F: Copy> Scene<'_, F> {
    /// The point itself if it is free, else one nearby that is; without one, the point moved inside. For a
    /// target, in every step anew: few candidates, then the first free point on rings around it.
    pub(super) fn nearest_free(&self, point: Point<F>, search: &mut ExitSearch<F>) -> Point<F> {
        search.end();
        let start = self.within().map_or(point, |within| inside(&within, point));
        let Some(cover) = self.cover(start) else { return start };
        let reserve = self.effort() / 2;
        search.begin(start);
        self.add_exits(search, &cover, start, reserve);
        let free = self.search(search, TRIES_TO_GOAL_MAX, reserve, |_| true);
        search.end();
        free.or_else(|| self.first_on_rings(start, reserve)).unwrap_or(start)
    }

    /// Where to leave what covers a robot: the nearest free point with no body on the straight path to it,
    /// else the nearest. While the search goes on, the one that was found before, or the candidate that it
    /// would try next. An exit to which a route leads is kept while it is free: of two that
    /// are about as far, each would be the nearer one on the path to the other.
    pub(super) fn exit(&self, from: Point<F>, search: &mut ExitSearch<F>) -> Point<F> {
        let start = self.within().map_or(from, |within| inside(&within, from));
        let reserve = self.effort() / 2;
        let free = search.exit.filter(|exit| self.cover(*exit).is_none());
        if !search.goes_on() {
            if let Some(exit) = free
                && (search.is_reachable || start.distance(search.start) < SAME_START)
            {
                return exit;
            }
            search.begin(start);
            let Some(cover) = self.cover(start) else { return search.ends_with(start) };
            self.add_exits(search, &cover, start, reserve);
        }
        if let Some(exit) = self.search(search, TRIES_MAX, reserve, |exit| self.sees(from, exit)) {
            return search.ends_with(exit);
        }
        self.search_lattice(search, reserve);
        if search.goes_on() {
            free.or_else(|| search.nearest().map(|exit| exit.at)).unwrap_or(search.start)
        } else {
            search.ends_with(search.unseen.unwrap_or(search.start))
        }
    }

    /// Tests candidates up to the number of `tries`, while more than `reserve` of the effort is left.
    fn search(
        &self,
        search: &mut ExitSearch<F>,
        tries: u32,
        reserve: u32,
        suits: impl Fn(Point<F>) -> bool,
    ) -> Option<Point<F>> {
        while search.tested < tries && self.effort() > reserve {
            if let Some((at, _)) = search.adding {
                match self.cover(at) {
                    Some(cover) => self.add_exits(search, &cover, at, reserve),
                    None => search.adding = None,
                }
                continue;
            }
            self.spend(cost::EXIT + search.candidates.len() as u32 * cost::EXIT_KNOWN);
            let Some(at) = search.take_nearest() else {
                search.tested = tries;
                break;
            };
            search.tested += 1;
            match self.cover(at) {
                None if suits(at) => return Some(at),
                None => search.unseen = search.unseen.or(Some(at)),
                Some(cover) => self.add_exits(search, &cover, at, reserve),
            }
        }
        None
    }

    /// The first free point on growing rings.
    fn first_on_rings(&self, start: Point<F>, reserve: u32) -> Option<Point<F>> {
        let points = RINGS
            .into_iter()
            .flat_map(|ring| COMPASS.into_iter().map(move |[x, y]| start + Vector::new(x, y) * ring));
        points
            .into_iter()
            .take_while(|_| self.effort() > reserve)
            .find(|at| self.stays_within(*at) && self.cover(*at).is_none())
    }

    /// The shape of an obstacle in which the point lies, or that it touches.
    fn cover(&self, point: Point<F>) -> Option<Shape<F>> {
        self.nearer(point, FREE).map(|obstacle| obstacle.shape)
    }

    /// Adds the exit points of a shape from a point in it, as far as they lie inside; while more than
    /// `reserve` of the effort is left, and the others in the next step.
    fn add_exits(&self, search: &mut ExitSearch<F>, shape: &Shape<F>, at: Point<F>, reserve: u32) {
        let same = if matches!(shape, Shape::Box { .. }) { SAME } else { SAME_AROUND };
        let begins = search.adding.take().map_or(0, |(_, added)| added);
        for (number, exit) in exits_of(shape, at).into_iter().enumerate() {
            if number < begins {
                continue;
            }
            if number > begins && self.effort() <= reserve {
                search.adding = Some((at, number));
                return;
            }
            if self.stays_within(exit) {
                self.spend(cost::EXIT + search.candidates.len() as u32 * cost::EXIT_KNOWN);
                search.add(exit, same);
            }
        }
    }

    /// Where no candidate was free: the free point of a lattice over the region to stay in that is nearest to
    /// the start, from the lattice point at which the step before ended.
    fn search_lattice(&self, search: &mut ExitSearch<F>, reserve: u32) {
        if search.tested < TRIES_MAX {
            return;
        }
        let begins = search.tested == TRIES_MAX;
        let Some(Shape::Box { low, high }) = self.within().filter(|_| !(begins && search.unseen.is_some()))
        else {
            search.tested = TESTS_MAX;
            return;
        };
        let cell = high - low;
        while search.goes_on() && self.effort() > reserve {
            let number = search.tested - TRIES_MAX;
            let (column, row) = (number % COLUMNS, number / COLUMNS);
            let x = cell.x() * ((column as f32 + 0.5) / COLUMNS as f32);
            let y = cell.y() * ((row as f32 + 0.5) / ROWS as f32);
            let at = low + Vector::new(x, y);
            if search.unseen.is_none_or(|best| at.distance(search.start) < best.distance(search.start))
                && self.cover(at).is_none()
            {
                search.unseen = Some(at);
            }
            search.tested += 1;
        }
    }
}

/// Exit points of a shape from a point in it.
fn exits_of<F: Copy>(shape: &Shape<F>, at: Point<F>) -> heapless::Vec<Point<F>, EXITS_OF_SHAPE_MAX> {
    let mut exits = heapless::Vec::new();
    // No shape has more than the capacity.
    match *shape {
        Shape::Box { low, high } => {
            let _ = exits.extend_from_slice(&[
                Point::new(low.x() - OFF, at.y()),
                Point::new(high.x() + OFF, at.y()),
                Point::new(at.x(), low.y() - OFF),
                Point::new(at.x(), high.y() + OFF),
            ]);
        }
        Shape::Disc { center, radius } => {
            let out = (at - center).unit().unwrap_or(Vector::new(1.0, 0.0)) * (radius + OFF);
            let left = Vector::new(-out.y(), out.x());
            // Along both axes first, parallel to walls and boxes: of nearly equal candidates the first one is
            // used.
            let off = at - center;
            let reach = |off: f32| math::sqrt(math::max((radius + OFF) * (radius + OFF) - off * off, 0.0));
            let (x, y) = (reach(off.y()), reach(off.x()));
            let _ = exits.extend_from_slice(&[
                Point::new(center.x() - x, at.y()),
                Point::new(center.x() + x, at.y()),
                Point::new(at.x(), center.y() - y),
                Point::new(at.x(), center.y() + y),
                center + out,
                center + left,
                center - left,
                center - out,
            ]);
        }
        Shape::Capsule { spine, radius } => {
            let reach = radius + OFF;
            let along = spine.vector().unit().unwrap_or(Vector::new(1.0, 0.0));
            let foot = spine.closest_to(at);
            let left = Vector::new(-along.y(), along.x()) * reach;
            exits.extend((at - foot).unit().map(|out| foot + out * reach));
            let _ = exits.extend_from_slice(&[
                foot + left,
                foot - left,
                spine.from - along * reach,
                spine.to + along * reach,
            ]);
        }
    }
    exits
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
/// Most candidates for a target that is covered: a robot that gets near it searches again.
const TRIES_TO_GOAL_MAX: u32 = 2;
/// Most exit points of a shape: a disc's.
const EXITS_OF_SHAPE_MAX: usize = 8;
/// Most candidates that are stored.
const EXITS_MAX: usize = 64;
/// Points of the lattice along the region's x and y.
const COLUMNS: u32 = 6;
const ROWS: u32 = 4;
/// All points that a search may test.
const TESTS_MAX: u32 = TRIES_MAX + COLUMNS * ROWS;
/// A robot that has moved no farther keeps its exit, m.
const SAME_START: f32 = 0.05;
/// Rings of 8 points around a covered point, m.
const RINGS: [f32; 4] = [0.15, 0.3, 0.6, 1.2];
const COMPASS: [[f32; 2]; 8] = {
    let h = core::f32::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [h, h], [0.0, 1.0], [-h, h], [-1.0, 0.0], [-h, -h], [0.0, -1.0], [h, -h]]
};
