//! `route`: route search around obstacles. A bounded best-first search over tangent points; lengths in m.

use geometry::{Point, Shape, Vector, math};

use super::item::{Item, Scene, at, tangent};
use super::{CHECKS_MAX, Obstacle};
use crate::trajectory::FreeLimits;

/// Result of the search.
#[derive(Clone, Copy)]
pub(super) struct Route<F> {
    /// Whether it leads to the goal.
    pub(super) arrives: bool,
    /// The first corner; `None` where it is straight.
    pub(super) via: Option<Point<F>>,
    /// Point after the first corner.
    pub(super) behind: Point<F>,
    /// End of the route.
    pub(super) end: Point<F>,
    pub(super) length: f32,
}

/// A corner that can be reached.
#[derive(Clone, Copy, Debug)]
struct Node<F> {
    at: Point<F>,
    /// Number of the corner before.
    parent: usize,
    /// Length so far, without and with the cost of turning.
    length: f32,
    cost: f32,
    /// Cost including the straight line to the goal; infinite once tested.
    estimate: f32,
}

/// What a search leaves to the next step: its corners, where the effort ended it, and the route that was
/// found in more than one step, which no single search would find again.
#[derive(Clone, Debug)]
pub(super) struct CarriedRoute<F> {
    start: Point<F>,
    goal: Point<F>,
    nodes: heapless::Vec<Node<F>, NODES_MAX>,
    /// The corner whose turns the effort did not suffice for, and those turns.
    turns: Option<(usize, Turns<F>)>,
    /// Pieces that the unfinished search may still test; 0 where none is unfinished.
    checks: u32,
    /// Corners of the route that was found, the first one last.
    corners: Corners<F>,
}

type Corners<F> = heapless::Vec<Point<F>, CORNERS_MAX>;

impl<F> Default for CarriedRoute<F> {
    fn default() -> Self {
        Self {
            start: Point::default(),
            goal: Point::default(),
            nodes: heapless::Vec::new(),
            turns: None,
            checks: 0,
            corners: heapless::Vec::new(),
        }
    }
}

impl<F> CarriedRoute<F> {
    /// Whether the effort ended the last search.
    pub(super) fn is_unfinished(&self) -> bool {
        self.checks > 0
    }
}

struct Search<'s, F> {
    scene: &'s Scene<'s, F>,
    goal: Point<F>,
    velocity: Vector<F>,
    limits: &'s FreeLimits,
    nodes: &'s mut heapless::Vec<Node<F>, NODES_MAX>,
    turns: &'s mut Option<(usize, Turns<F>)>,
    /// Number of path pieces that may still be tested.
    checks: u32,
    /// Speed towards the goal, m/s.
    speed: f32,
}

impl<F: Copy> Route<F> {
    pub(super) fn find(
        scene: &Scene<'_, F>,
        carried: &mut CarriedRoute<F>,
        (from, velocity): (Point<F>, Vector<F>),
        goal: Point<F>,
        limits: &FreeLimits,
    ) -> Self {
        let length = from.distance(goal);
        let start = Node { at: from, parent: 0, length: 0.0, cost: 0.0, estimate: length };
        let towards = (goal - from).unit().unwrap_or_default();
        let speed = math::clamp(velocity.dot(towards), 0.0, limits.speed);
        let CarriedRoute { start: began, goal: aimed, nodes, turns, checks, corners } = carried;
        if aimed.distance(goal) > SAME_PLACE_M {
            *checks = 0;
            corners.clear();
        }
        let mut search = Search { scene, goal, velocity, limits, nodes, turns, checks: CHECKS_MAX, speed };
        if let Some(route) = search.known(start, corners) {
            return route;
        }
        corners.clear();
        let goes_on = *checks > 0 && began.distance(from) < SAME_PLACE_M;
        if goes_on && let Some(first) = search.nodes.first_mut() {
            first.at = from;
            search.checks = *checks;
        } else {
            search.nodes.clear();
            *search.turns = None;
            // The first of many.
            let _ = search.nodes.push(start);
            search.checks = CHECKS_MAX;
            (*began, *aimed) = (from, goal);
        }
        let found = search.run();
        let remains = search.turns.is_some() || search.cheapest().is_some();
        let unfinished = found.is_none() && !scene.affords_a_piece() && remains;
        *checks = if unfinished { search.checks } else { 0 };
        match found {
            Some(last) => {
                let route = search.route(start, last, true);
                if goes_on {
                    search.note_corners(last, corners);
                }
                route
            }
            None => search.route(start, search.most_promising(), false),
        }
    }
}

impl<F: Copy> Search<'_, F> {
    /// The route along these corners, without the first one where it is passed; `None` where it is blocked,
    /// as far as the effort tells.
    fn known(&mut self, start: Node<F>, corners: &mut Corners<F>) -> Option<Route<F>> {
        let second = corners.iter().rev().nth(1).copied().unwrap_or(self.goal);
        if !corners.is_empty() && self.first_hit(&start, second).is_none() {
            corners.pop();
        }
        // A corner that is reached, from where it does not go on, is no way.
        let via = *corners.last().filter(|via| via.distance(start.at) > REACHED_M)?;
        let mut node = start;
        for end in corners.iter().rev().copied().chain([self.goal]) {
            if self.scene.affords_a_piece() && self.first_hit(&node, end).is_some() {
                return None;
            }
            node = Node { at: end, length: node.length + node.at.distance(end), ..node };
        }
        let behind = corners.iter().rev().nth(1).copied().unwrap_or(self.goal);
        Some(Route { arrives: true, via: Some(via), behind, end: self.goal, length: node.length })
    }

    /// Fills in the corners of the route to this node, if they are few.
    fn note_corners(&self, last: usize, corners: &mut Corners<F>) {
        let mut at = last;
        while let Some(node) = self.nodes.get(at).filter(|_| at != 0) {
            if corners.push(node.at).is_err() {
                return corners.clear();
            }
            at = node.parent;
        }
    }

    /// The number of the corner from which the goal is straight ahead.
    fn run(&mut self) -> Option<usize> {
        // A search that was cut short takes a route that it can have, before it looks for a better one.
        if self.turns.is_some()
            && self.may_test()
            && let Some((number, node)) = self.cheapest()
            && self.first_hit(&node, self.goal).is_none()
        {
            return Some(number);
        }
        while self.may_test() {
            let (number, mut turns) = if let Some(cut_short) = self.turns.take() {
                cut_short
            } else {
                let (number, node) = self.cheapest()?;
                self.nodes.get_mut(number)?.estimate = f32::INFINITY;
                let Some(hit) = self.first_hit(&node, self.goal) else { return Some(number) };
                // Obstacles before a corner are avoided as well; each obstacle once on each side.
                (number, Turns::new(hit, self.goal))
            };
            let node = *self.nodes.get(number)?;
            while let Some(Turn { item: hit, side, to }) = turns.next() {
                if !self.may_test() {
                    turns.put_back();
                    *self.turns = Some((number, turns));
                    return None;
                }
                let Some((item, obstacle)) = self.scene.get(hit) else { continue };
                let corner = self.corner(item, obstacle, &node, to, side);
                if let Some(before) = self.reach(
                    number,
                    &node,
                    corner,
                    ahead_of(item.moves, obstacle.velocity, corner - node.at, to - node.at),
                ) {
                    turns.add(before, side, corner);
                    turns.add(before, -side, corner);
                }
            }
        }
        None
    }

    /// Whether checks and effort suffice for another piece.
    fn may_test(&self) -> bool {
        self.checks > 0 && self.scene.affords_a_piece()
    }

    fn cheapest(&self) -> Option<(usize, Node<F>)> {
        let mut best: Option<(usize, Node<F>)> = None;
        for (i, node) in self.nodes.iter().enumerate() {
            if node.estimate < best.map_or(f32::INFINITY, |(_, best)| best.estimate) {
                best = Some((i, *node));
            }
        }
        best
    }

    fn first_hit(&mut self, node: &Node<F>, to: Point<F>) -> Option<usize> {
        self.checks = self.checks.saturating_sub(1);
        let path = to - node.at;
        let (mut at, mut time) = (0.0, 0.0);
        if self.scene.moves() {
            at = self.time_after(node.length);
            time = self.time_after(node.length + path.norm()) - at;
        }
        self.scene.first_hit(node.at, path, at, time)
    }

    /// Approximate time to travel this far: accelerating from its present speed to its limit, s.
    fn time_after(&self, length: f32) -> f32 {
        let peak = math::sqrt(self.speed * self.speed + 2.0 * self.limits.acceleration * length);
        let faster = self.speed + peak;
        let speeding = if faster > 0.0 { 2.0 * length / faster } else { 0.0 };
        math::max(speeding, length / self.limits.speed)
    }

    /// Adds a corner that can be reached from the node; else returns the number of the obstacle before it.
    fn reach(&mut self, number: usize, node: &Node<F>, at: Point<F>, extra: f32) -> Option<usize> {
        if !self.scene.stays_within(at) {
            return None;
        }
        if let Some(hit) = self.first_hit(node, at) {
            return Some(hit);
        }
        let path = at - node.at;
        let piece = path.norm();
        let turning = if number == 0 { self.turning(path, piece) } else { 0.0 };
        let (length, cost) = (node.length + piece, node.cost + piece + turning + extra);
        if piece > PIECE_MIN {
            let estimate = cost + at.distance(self.goal);
            // Without capacity for more corners the search continues with those there are.
            let _ = self.nodes.push(Node { at, parent: number, length, cost, estimate });
        }
        None
    }

    /// Cost of turning the present velocity into this direction, as a length: nothing straight on, twice the
    /// braking distance where it goes back.
    fn turning(&self, path: Vector<F>, piece: f32) -> f32 {
        if piece <= 0.0 {
            return 0.0;
        }
        let speed = self.velocity.norm();
        0.5 * speed * (speed - self.velocity.dot(path) / piece) / self.limits.braking
    }

    /// A corner of the path around an obstacle on the left (`side` +1) or right, from the node on towards
    /// `to`.
    fn corner(
        &self,
        item: &Item<F>,
        obstacle: &Obstacle<F>,
        node: &Node<F>,
        to: Point<F>,
        side: f32,
    ) -> Point<F> {
        let from = node.at;
        let mut gap = item.margin + CORNER_SKIN;
        let mut interception_point = 0.0;
        if item.moves {
            // The obstacle's position when the robot passes, with a margin for being early or late there.
            for _ in 0..2 {
                let distance = math::max(at(obstacle, interception_point).distance_to(from), 0.0);
                interception_point = self.time_after(node.length + distance);
            }
            gap += EARLY_OR_LATE * obstacle.velocity.norm();
        }
        match if item.moves { at(obstacle, interception_point) } else { obstacle.shape } {
            Shape::Disc { center, radius } => around(center, radius + gap, from, to, side, None),
            Shape::Capsule { spine, radius } => {
                // The end of the spine whose tangent leaves the other end on the inner side.
                let outer = |seen: Point<F>, side: f32| {
                    let normal = tangent(seen, spine.from, radius + gap, side);
                    if normal.dot(spine.vector()) > 0.0 { spine.to } else { spine.from }
                };
                let (first, last) = (outer(from, side), outer(to, -side));
                let along = (to - from).unit().unwrap_or(Vector::new(1.0, 0.0));
                let flank = (first != last).then(|| {
                    let bone = spine.vector().unit().unwrap_or(along);
                    let normal = Vector::new(-bone.y(), bone.x());
                    if normal.dot(Vector::new(-along.y(), along.x())) * side < 0.0 { -normal } else { normal }
                });
                around(first, radius + gap, from, to, side, flank)
            }
            Shape::Box { low, high } => {
                // The outermost corner, measured at the routes' distance; a robot may be within the skin of
                // corners.
                let off = |sx: f32, sy: f32, by: f32| {
                    let (x, y) = (
                        if sx < 0.0 { low.x() } else { high.x() },
                        if sy < 0.0 { low.y() } else { high.y() },
                    );
                    Point::new(x + sx * by, y + sy * by)
                };
                let mut outer = (-1.0, -1.0);
                for (sx, sy) in [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                    let seen = off(outer.0, outer.1, item.margin) - from;
                    if seen.cross(off(sx, sy, item.margin) - from) * side > 0.0 {
                        outer = (sx, sy);
                    }
                }
                off(outer.0, outer.1, gap)
            }
        }
    }

    /// Target when no path was found: the corner nearest to the goal; where that is the start, the cheapest
    /// that was not tested any more, because staying would repeat the same search in the next step.
    fn most_promising(&self) -> usize {
        let mut best = (0, f32::INFINITY);
        for (i, node) in self.nodes.iter().enumerate() {
            let distance = node.at.distance(self.goal);
            if distance < best.1 {
                best = (i, distance);
            }
        }
        if best.0 > 0 { best.0 } else { self.cheapest().map_or(0, |(number, _)| number) }
    }

    fn route(&self, start: Node<F>, last: usize, arrives: bool) -> Route<F> {
        let node = |i: usize| self.nodes.get(i).copied().unwrap_or(start);
        let end = node(last).at;
        let rest = if arrives { end.distance(self.goal) } else { 0.0 };
        let mut route = Route {
            arrives,
            via: None,
            behind: self.goal,
            end: if arrives { self.goal } else { end },
            length: node(last).length + rest,
        };
        let mut at = last;
        let mut behind = route.end;
        while at != 0 {
            (route.via, route.behind) = (Some(node(at).at), behind);
            behind = node(at).at;
            at = node(at).parent;
        }
        route
    }
}

/// Cost of passing in front of a moving obstacle, as a length: being late there is a crash, behind it is not.
fn ahead_of<F: Copy>(moves: bool, velocity: Vector<F>, corner: Vector<F>, straight: Vector<F>) -> f32 {
    if !moves {
        return 0.0;
    }
    let (side, across) = (straight.cross(corner), straight.cross(velocity));
    if side * across <= 0.0 { 0.0 } else { LATENESS * across.abs() / math::max(straight.norm(), PIECE_MIN) }
}

/// A turn around this obstacle on this side, on the path to that point.
#[derive(Clone, Copy, Debug)]
struct Turn<F> {
    item: usize,
    side: f32,
    to: Point<F>,
}

/// Turns still to be tried from a corner, in order of arrival.
#[derive(Clone, Debug)]
struct Turns<F> {
    list: heapless::Vec<Turn<F>, TURNS_MAX>,
    begin: usize,
    /// Obstacles that are in the list or were, on the left and on the right.
    seen: [u64; 2],
}

impl<F: Copy> Turns<F> {
    fn new(item: usize, to: Point<F>) -> Self {
        let mut turns = Self { list: heapless::Vec::new(), begin: 0, seen: [0; 2] };
        turns.add(item, 1.0, to);
        turns.add(item, -1.0, to);
        turns
    }

    fn add(&mut self, item: usize, side: f32, to: Point<F>) {
        let [left, right] = &mut self.seen;
        let seen = if side > 0.0 { left } else { right };
        if *seen >> item & 1 == 0 && self.list.push(Turn { item, side, to }).is_ok() {
            *seen |= 1 << item;
        }
    }

    fn next(&mut self) -> Option<Turn<F>> {
        let turn = self.list.get(self.begin).copied()?;
        self.begin += 1;
        Some(turn)
    }

    /// The turn that was next is next again.
    fn put_back(&mut self) {
        self.begin = self.begin.saturating_sub(1);
    }
}

/// The intersection of the tangents of a disc from both points on one side; where they intersect far out or
/// not at all, a corner half-way round. With `flank`, the tangent along it takes the place of the one from
/// `to`.
fn around<F: Copy>(
    center: Point<F>,
    radius: f32,
    from: Point<F>,
    to: Point<F>,
    side: f32,
    flank: Option<Vector<F>>,
) -> Point<F> {
    let first = tangent(from, center, radius, side);
    let last = flank.unwrap_or_else(|| tangent(to, center, radius, -side));
    let along = (to - from).unit().unwrap_or(Vector::new(1.0, 0.0));
    let outwards = Vector::new(-along.y(), along.x()) * side;
    let both = first + last;
    let opening = 1.0 + first.dot(last);
    // Beyond 120°, or the longer side.
    if opening > OPENING_MIN && both.dot(outwards) > 0.0 {
        return center + both * (radius / opening);
    }
    let middle = both.unit().unwrap_or(outwards);
    let middle = if middle.dot(outwards) < 0.0 { -middle } else { middle };
    let opening = math::max(1.0 + first.dot(middle), OPENING_MIN);
    center + (first + middle) * (radius / opening)
}

/// A corner this near is reached, m: the skin that routes keep.
const REACHED_M: f32 = 0.02;
/// A start and a goal that moved no farther are the same, m.
const SAME_PLACE_M: f32 = 0.1;
/// Most corners of a route that is kept.
const CORNERS_MAX: usize = 5;
/// Most turns that are tried from a corner.
const TURNS_MAX: usize = 12;
/// Most corners of a search: one a piece, and the start.
const NODES_MAX: usize = CHECKS_MAX as usize + 1;
/// Distance of corners outside of the routes' margin, m, so that rounding does not put the next piece inside.
const CORNER_SKIN: f32 = 0.002;
/// What passing in front costs, by the obstacle's speed across the path, s: a robot may be late by as much.
const LATENESS: f32 = 0.5;
/// Room for a moving obstacle around corners, by its speed, s.
const EARLY_OR_LATE: f32 = 0.15;
/// Least length of a piece, m.
const PIECE_MIN: f32 = 0.001;
/// Limit of the opening, 1 + cos 120°.
const OPENING_MIN: f32 = 0.5;
