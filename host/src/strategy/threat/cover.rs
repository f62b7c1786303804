//! `cover`: places of keeper and primary defenders against the first-level threat (Biswas et al. 2014 §5.1:
//! three cases; its Figure 7). Attack frame, m, rad.
//!
//! 1. One defender covers the whole open angle: it stands on the bisector, the keeper before the middle of
//!    the goal.
//! 2. Defender and keeper cover it together: the defender just inside the line from the threat to the nearer
//!    post, the keeper on the bisector of the remaining angle, as far back as it can be.
//! 3. Else two defenders: the keeper on the bisector of the whole angle, a defender on the bisector of each
//!    of the two remaining angles.
//!
//! Division B's goal is wide (1 m): from far away not even three standing bodies cover all of it. The keeper
//! then comes out as far as it may, and [`Cover::uncovered`] is the angle left to its reaction.

mod keeper;

use geometry::{Attack, Point, Vector};

use super::super::view::View;
use super::ThreatSettings;
use super::angle::{Opening, distance_for, half_shadow};
use super::edge::Edge;

/// Rounds after which a place that depends on its own distance moves by less than a millimetre.
const ROUNDS: usize = 4;
/// Least slope of a ray towards our goal line: below, it counts as parallel to the line.
const SLOPE_MIN: f32 = 1e-3;

/// The three placements of the paper, by the bodies needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Case {
    /// One defender covers the whole open angle.
    Defender,
    /// One defender and the keeper.
    DefenderAndKeeper,
    /// Two defenders and the keeper.
    DefendersAndKeeper,
}

/// The earlier decision, for hysteresis, so that small changes do not reverse it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    /// The placement chosen before.
    pub case: Case,
    /// Whether the post at +y counted as the nearer one.
    pub upper_post: bool,
}

/// Places of keeper and primary defenders.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    /// The placement chosen, by the bodies needed.
    pub case: Case,
    /// The goal as seen from the threat.
    pub opening: Opening,
    /// Place of the keeper, m.
    pub keeper: Point<Attack>,
    /// Places of the primary defenders that are needed, from −y to +y along the edge.
    pub primaries: heapless::Vec<Point<Attack>, 2>,
    /// The part of the open angle that bodies at these places leave open, rad.
    pub uncovered: f32,
    /// Whether the post at +y counts as the nearer one.
    pub upper_post: bool,
}

/// Keeper and at most `available` primary defenders against a shot from `threat`.
pub fn cover(
    view: &View,
    threat: Point<Attack>,
    available: usize,
    before: Option<Before>,
    settings: &ThreatSettings,
) -> Cover {
    let place = Placing::new(view, threat, before, settings);
    let held = before.map(|before| before.case);
    let fits = |case: Case, taken: f32, open: f32| {
        // Fewer bodies than now only where they suffice with a reserve.
        let spare = if held.is_some_and(|held| case < held) { settings.to_spare } else { 1.0 };
        taken >= open * spare
    };
    let one = place.on_bisector(0.0);
    let angle = place.opening.angle();
    if available >= 1 && fits(Case::Defender, 2.0 * half_shadow(place.distance(one)), angle) {
        return place.finish(Case::Defender, place.before_goal(), &[one]);
    }
    if available == 0 {
        let keeper = place.keeper(0.0, place.opening.half).0;
        return place.finish(Case::DefenderAndKeeper, keeper, &[]);
    }
    let (defender, keeper, taken, rest) = place.defender_and_keeper();
    if available == 1 || fits(Case::DefenderAndKeeper, taken, rest) {
        return place.finish(Case::DefenderAndKeeper, keeper, &[defender]);
    }
    let (keeper, defenders) = place.defenders_and_keeper();
    place.finish(Case::DefendersAndKeeper, keeper, &defenders)
}

/// Values that every placement needs.
struct Placing<'v> {
    view: &'v View,
    settings: &'v ThreatSettings,
    opening: Opening,
    edge: Edge,
    upper_post: bool,
}

impl<'v> Placing<'v> {
    fn new(
        view: &'v View,
        threat: Point<Attack>,
        before: Option<Before>,
        settings: &'v ThreatSettings,
    ) -> Self {
        let opening = Opening::of(threat, view.our_goal(), view.field.goal_width);
        let edge = Edge::of(&view.field, settings.off_area);
        let near_axis = threat.y().abs() < settings.axis;
        let upper_post = before.filter(|_| near_axis).map_or(threat.y() > 0.0, |before| before.upper_post);
        Self { view, settings, opening, edge, upper_post }
    }

    fn distance(&self, place: Point<Attack>) -> f32 {
        place.distance(self.opening.from)
    }

    /// Crossing of the ray `off` the middle and our goal line.
    fn on_goal_line(&self, off: f32) -> Point<Attack> {
        let (from, direction) = (self.opening.from, self.opening.direction(off));
        let (goal, half) = (self.view.our_goal(), self.view.field.goal_width * 0.5);
        let y = from.y() + direction.y() * (goal.x() - from.x()) / direction.x().min(-SLOPE_MIN);
        Point::new(goal.x(), y.clamp(-half, half))
    }

    /// The point of the edge on the ray `off` the middle.
    fn on_bisector(&self, off: f32) -> Point<Attack> {
        let end = self.on_goal_line(off);
        self.edge.crossing(end, self.opening.from - end)
    }

    /// Place in front of the middle of the goal.
    fn before_goal(&self) -> Point<Attack> {
        self.view.our_goal() + Vector::new(self.settings.keeper_back, 0.0)
    }

    /// On the ray `off` the middle, as far back as the keeper still covers `half` to either side, but no
    /// farther out than it may; and the half angle that it covers there.
    fn keeper(&self, off: f32, half: f32) -> (Point<Attack>, f32) {
        let (from, direction) = (self.opening.from, self.opening.direction(off));
        let goal = self.view.our_goal();
        let out = |x: f32| (goal.x() + x - from.x()) / direction.x().min(-SLOPE_MIN);
        let (back, front) = (out(self.settings.keeper_back).max(0.0), out(self.settings.keeper_out).max(0.0));
        // No farther aside than the posts: on this ray, not beside it.
        let post = self.view.field.goal_width * 0.5;
        let aside = from.y().abs() - post;
        let between = if aside > 0.0 { aside / direction.y().abs().max(SLOPE_MIN) } else { 0.0 };
        let at = from + direction * distance_for(half).max(front).max(between).min(back);
        // A shot along the goal line is blocked before the near post, not beside the goal.
        let at = Point::new(at.x().max(goal.x() + self.settings.keeper_back), at.y().clamp(-post, post));
        (at, half_shadow(self.distance(at)))
    }

    /// Case 2: defender, keeper, the angle that the keeper covers, and the angle that the defender leaves,
    /// rad.
    fn defender_and_keeper(&self) -> (Point<Attack>, Point<Attack>, f32, f32) {
        let half = self.opening.half;
        // Seen from a threat before our goal, +y lies to the right.
        let post = if self.upper_post { -half } else { half };
        let inwards = if self.upper_post { 1.0 } else { -1.0 };
        let mut at = self.on_bisector(post);
        let mut taken = half_shadow(self.distance(at)).min(half);
        // Its shadow starts at the post; its distance, and so its shadow, changes little with the resulting
        // place.
        for _ in 0..ROUNDS {
            at = self.on_bisector(post + inwards * taken);
            taken = half_shadow(self.distance(at)).min(half);
        }
        let rest = 2.0 * (half - taken);
        let (keeper, keeps) = self.keeper(post + inwards * (2.0 * taken + 0.5 * rest), 0.5 * rest);
        (at, keeper, 2.0 * keeps, rest)
    }

    /// Case 3: keeper, and a defender to either side.
    fn defenders_and_keeper(&self) -> (Point<Attack>, [Point<Attack>; 2]) {
        let half = self.opening.half;
        let mut needed = 0.0;
        let (mut keeper, mut defenders) = (self.before_goal(), [self.before_goal(); 2]);
        for _ in 0..ROUNDS {
            let (at, keeps) = self.keeper(0.0, needed);
            let rest = (half - keeps).max(0.0);
            keeper = at;
            defenders = [1.0, -1.0].map(|side| self.on_bisector(side * (keeps + 0.5 * rest)));
            let least = defenders.map(|at| 2.0 * half_shadow(self.distance(at)));
            needed = (half - least[0].min(least[1])).max(0.0);
        }
        (keeper, self.apart(defenders))
    }

    /// The same, far enough from each other along the edge for two bodies.
    fn apart(&self, places: [Point<Attack>; 2]) -> [Point<Attack>; 2] {
        let [a, b] = places.map(|place| self.edge.along(place));
        let (middle, least) = (0.5 * (a + b), self.settings.shoulder);
        let mut off = (0.5 * (b - a).abs()).max(least);
        let on = |along: f32| self.edge.point(along);
        // Around a corner bodies come nearer to each other than along the edge.
        for _ in 0..ROUNDS {
            let missing = 2.0 * least - on(middle - off).distance(on(middle + off));
            off += missing.max(0.0);
        }
        let middle = middle.clamp(off, self.edge.length() - off);
        [on(middle - off), on(middle + off)]
    }

    fn finish(&self, case: Case, keeper: Point<Attack>, primaries: &[Point<Attack>]) -> Cover {
        let mut primaries: heapless::Vec<_, 2> = primaries.iter().copied().collect();
        primaries.sort_unstable_by(|a, b| self.edge.along(*a).total_cmp(&self.edge.along(*b)));
        let bodies = primaries.iter().copied().chain([keeper]);
        let gaps = self.opening.gaps(bodies, f32::INFINITY);
        let uncovered = gaps.iter().fold(0.0, |sum, gap| sum + gap.width());
        Cover { case, opening: self.opening, keeper, primaries, uncovered, upper_post: self.upper_post }
    }
}

impl Cover {
    /// Place of a primary defender that is not needed: beside the one that is, on the side of the field's
    /// middle.
    pub fn spare_place(&self, edge: &Edge, settings: &ThreatSettings) -> Point<Attack> {
        let along = self.primaries.first().map_or(0.5 * edge.length(), |place| edge.along(*place));
        beside(edge, along, if self.upper_post { -1.0 } else { 1.0 }, settings)
    }

    /// The state for hysteresis.
    pub fn remember(&self) -> Before {
        Before { case: self.case, upper_post: self.upper_post }
    }
}

/// The point of the edge next to the one `along` it that leaves room for two bodies, upwards (1) or downwards
/// (−1).
pub(super) fn beside(edge: &Edge, along: f32, towards: f32, settings: &ThreatSettings) -> Point<Attack> {
    let (here, least) = (edge.point(along), 2.0 * settings.shoulder);
    let mut off = least;
    // Around a corner bodies come nearer to each other than along the edge.
    for _ in 0..ROUNDS {
        off += (least - here.distance(edge.point(along + towards * off))).max(0.0);
    }
    edge.point(along + towards * off)
}

#[cfg(test)]
mod tests;
