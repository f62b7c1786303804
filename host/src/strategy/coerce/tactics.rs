//! `tactics`: likelihood of a position under each tactic. P(p | M_t, W) for the planner's four tactics
//! (Biswas et al. 2014 §4.1; its Figure 5). Attack frame (opponents defend +x), m.
//!
//! The paper computes its models "analytically using assumptions of SSL-specific tactic behaviors and the
//! rules" and prints none. Ours are bell curves around the place that the tactic gives a robot, 1 at their
//! top, so that a threshold means the same for all of them.

use geometry::{Attack, Point, Segment, Vector, math};
use rules::FieldSpec;
use rules::limits::{BALL_DISTANCE, ROBOT_RADIUS};

use super::super::threat::edge::Edge;
use super::super::view::View;

/// The tactic of an opponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tactic {
    /// Follows the ball within its defence area.
    Goalkeeper,
    /// Follows the ball along the edge of its defence area.
    PrimaryDefence,
    /// Follows one of our attackers.
    Mark,
    /// Follows the ball, as close to our kicker as the rules allow.
    Wall,
}

impl Tactic {
    /// All, as [`Likelihoods`] orders them.
    pub const ALL: [Self; 4] = [Self::Goalkeeper, Self::PrimaryDefence, Self::Mark, Self::Wall];

    /// English name, for figures and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Goalkeeper => "goalkeeper",
            Self::PrimaryDefence => "primary defence",
            Self::Mark => "mark",
            Self::Wall => "wall",
        }
    }
}

/// P(p | M_t, W) for every tactic, in the order of [`Tactic::ALL`].
pub type Likelihoods = [f32; 4];

/// The numbers of the models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Models {
    /// Standard deviation of a robot's distance from the place that its tactic gives it, m (docs/papers.md
    /// D17).
    pub spread: f32,
    /// Standard deviation of the distance of primary defenders from the edge that they move along, and of
    /// walls from the distance they keep, m.
    pub keeps: f32,
    /// Standard deviation of the keeper's distance outside its area, m: it never leaves it; this is the
    /// cameras' error.
    pub outside: f32,
    /// A defender's centre is this far outside the area that it must not enter, m: a body and a margin.
    pub off_area: f32,
    /// Markers stand this far from our robot, towards their goal or towards the ball, m (D19).
    pub stand_off: f32,
    /// α_t: a tactic is not accepted below this likelihood (D17: 0.1 to 0.3).
    pub alpha: Likelihoods,
}

impl Default for Models {
    fn default() -> Self {
        Self { spread: 0.25, keeps: 0.12, outside: 0.03, off_area: 0.11, stand_off: 0.3, alpha: [0.2; 4] }
    }
}

/// The world's part in the models: the ball and the robots of ours that can be marked.
#[derive(Clone, Debug)]
pub struct CoerceSituation<'v> {
    pub(super) view: &'v View,
    models: Models,
    ball: Point<Attack>,
    /// Our field players except the kicker.
    marked: heapless::Vec<usize, { super::super::view::ROBOTS_MAX }>,
    /// End of the ball's shortest path to the middle of their goal, on their area's border.
    keeper_front: Point<Attack>,
}

impl<'v> CoerceSituation<'v> {
    /// The situation in this snapshot, with `kicker` at the ball.
    pub fn new(view: &'v View, models: Models, kicker: Option<protocol::RobotId>) -> Self {
        let ball = view.ball.map_or(Point::new(0.0, 0.0), |ball| ball.position);
        let marked =
            |robot: &super::super::view::ViewRobot| robot.id != view.keeper && Some(robot.id) != kicker;
        let marked = view.ours.iter().enumerate().filter(|(_, robot)| marked(robot)).map(|(i, _)| i);
        let goal = view.their_goal();
        let keeper_front =
            turned(Edge::of(&view.field, 0.0).crossing(turned(goal), turned(ball) - turned(goal)));
        Self { view, models, ball, marked: marked.collect(), keeper_front }
    }

    /// P(p | M_t, W) of all four.
    pub fn likelihoods(&self, at: Point<Attack>) -> Likelihoods {
        [self.goalkeeper(at), self.primary(at), self.mark(at).0, self.wall(at)]
    }

    /// Within the defence area, on the ball's path to the goal.
    fn goalkeeper(&self, at: Point<Attack>) -> f32 {
        let out = Edge::of(&self.view.field, 0.0).distance_to(turned(at)).max(0.0);
        let path = Segment::new(self.view.their_goal(), self.keeper_front);
        bell(path.distance_to(at), self.models.spread) * bell(out, self.models.outside)
    }

    /// At the edge of the defence area, within the angle from the ball to the goal's posts.
    fn primary(&self, at: Point<Attack>) -> f32 {
        let off_edge = Edge::of(&self.view.field, self.models.off_area).distance_to(turned(at));
        bell(off_edge, self.models.keeps)
            * bell(off_angle(&self.view.field, self.ball, at), self.models.spread)
    }

    /// At one of our attackers; and at which one of [`View::ours`].
    pub fn mark(&self, at: Point<Attack>) -> (f32, Option<usize>) {
        let mut best = (0.0, None);
        for i in &self.marked {
            let ours = self.view.ours[*i].position;
            for place in self.mark_places(ours, self.models.stand_off) {
                let likely = bell(place.distance(at), self.models.spread);
                if likely > best.0 {
                    best = (likely, Some(*i));
                }
            }
        }
        best
    }

    /// Places of a marker: between our robot and their goal against its shot, or the ball against the pass
    /// to it.
    pub fn mark_places(&self, ours: Point<Attack>, stand_off: f32) -> [Point<Attack>; 2] {
        let towards =
            |to: Point<Attack>| ours + (to - ours).unit().unwrap_or(Vector::new(1.0, 0.0)) * stand_off;
        [towards(self.view.their_goal()), towards(self.ball)]
    }

    /// Likelihood of a wall: as near to the ball as the rules allow.
    fn wall(&self, at: Point<Attack>) -> f32 {
        bell(at.distance(self.ball) - (BALL_DISTANCE + ROBOT_RADIUS + 0.02), self.models.keeps)
    }

    /// Parameters of the tactics' models.
    pub fn models(&self) -> &Models {
        &self.models
    }
}

/// The tactic that explains a place best, if one exceeds its threshold.
pub fn detected(likelihoods: &Likelihoods, models: &Models) -> Option<Tactic> {
    let mut best: Option<(Tactic, f32)> = None;
    for ((tactic, likely), alpha) in Tactic::ALL.into_iter().zip(likelihoods).zip(models.alpha) {
        if *likely > alpha && best.is_none_or(|(_, most)| *likely > most) {
            best = Some((tactic, *likely));
        }
    }
    best.map(|(tactic, _)| tactic)
}

/// Bell curve exp(−x²/2σ²) of a deviation, m.
fn bell(off: f32, spread: f32) -> f32 {
    let x = off / spread;
    math::exp(-0.5 * x * x)
}

/// Distance of a place outside the triangle of ball and posts, m.
fn off_angle(field: &FieldSpec, ball: Point<Attack>, at: Point<Attack>) -> f32 {
    let (x, y) = (field.length * 0.5, field.goal_width * 0.5);
    let corners = [ball, Point::new(x, -y), Point::new(x, y)];
    let sides = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| Segment::new(corners[a], corners[b]));
    let turns = sides.map(|side| side.vector().cross(at - side.from));
    let inside = turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0);
    if inside {
        0.0
    } else {
        sides.map(|side| side.distance_to(at)).into_iter().fold(f32::INFINITY, f32::min)
    }
}

/// Half a turn: [`Edge`] is defined for our end.
fn turned(at: Point<Attack>) -> Point<Attack> {
    Point::new(-at.x(), -at.y())
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use rules::League;

    fn scene() -> View {
        let mut view = view((0.0, 1.0), &[(-2.8, 0.0), (-0.1, 1.0), (1.0, -1.0)], &[]);
        view.field = League::Ssl2013.field();
        view
    }

    fn near(found: f32, expected: f32) {
        assert!((found - expected).abs() < 2e-4, "{found}, not {expected}");
    }

    /// Values by Python: `exp(-.5*(x/s)**2)` of the distances computed beside each.
    #[test]
    fn every_model_gives_the_values_computed_by_hand() {
        let view = scene();
        let kicker = Some(view.ours[1].id);
        let models = Models::default();
        let situation = CoerceSituation::new(&view, models, kicker);
        let at = |x: f32, y: f32| situation.likelihoods(Point::new(x, y));
        // Goalkeeper: in the area, 0.1 m beside the line from (3, 0) to (0, 1): exp(−0.5 · 0.4²).
        let line = Segment::new(Point::<Attack>::new(3.0, 0.0), Point::new(0.0, 1.0));
        let along = line.vector().unit().unwrap();
        let beside = line.from + along * 0.4 + Vector::new(-along.y(), along.x()) * 0.1;
        near(at(beside.x(), beside.y())[0], 0.923_116);
        // 0.06 m beyond where that line leaves the area, by its quarter circle about (3, 0.175): 0.0588 m
        // outside it.
        let front = situation.keeper_front + along * 0.06;
        near(at(front.x(), front.y())[0], 0.142_476);
        // Primary: 0.11 m off the area's straight front and within the angle: 1; 0.12 m farther out:
        // exp(−0.5).
        near(at(2.09, 0.17)[1], 1.0);
        near(at(1.97, 0.17)[1], 0.606_531);
        // Mark: 0.3 m from (1, −1) towards (3, 0): (1.2683, −0.8658) is 1; 0.25 m from that: exp(−0.5).
        near(at(1.268_328, -0.865_836)[2], 1.0);
        near(at(1.268_328, -1.115_836)[2], 0.606_531);
        // Wall: 0.61 m from the ball in any direction; 0.12 m farther.
        near(at(0.61, 1.0)[3], 1.0);
        near(at(0.0, 1.73)[3], 0.606_531);
    }

    #[test]
    fn the_tactic_is_the_one_that_explains_a_place_best_and_none_below_its_threshold() {
        let view = scene();
        let models = Models::default();
        let situation = CoerceSituation::new(&view, models, Some(view.ours[1].id));
        let tactic = |x: f32, y: f32| detected(&situation.likelihoods(Point::new(x, y)), &models);
        assert_eq!(tactic(2.7, 0.1), Some(Tactic::Goalkeeper));
        assert_eq!(tactic(2.1, 0.2), Some(Tactic::PrimaryDefence));
        assert_eq!(tactic(1.25, -0.9), Some(Tactic::Mark));
        assert_eq!(tactic(0.5, 0.7), Some(Tactic::Wall));
        assert_eq!(tactic(-2.0, -1.8), None);
        // Neither the kicker nor the keeper is marked.
        assert_eq!(situation.mark(Point::new(-0.1, 1.3)).1, Some(2));
    }

    #[test]
    fn likelihoods_are_shares_everywhere() {
        let view = scene();
        let situation = CoerceSituation::new(&view, Models::default(), None);
        for i in 0..2_400 {
            let at = Point::new((i % 60) as f32 * 0.1 - 3.0, (i / 60) as f32 * 0.1 - 2.0);
            assert!(situation.likelihoods(at).iter().all(|p| (0.0..=1.0).contains(p)), "{at:?}");
        }
    }
}
