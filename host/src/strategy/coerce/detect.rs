//! `detect`: tactic estimation of the opponents, from their places over the last half second (Biswas et al.
//! 2014 §4.1; docs/papers.md D17). Attack frame, s.

use geometry::{Attack, Point};
use protocol::{Instant, RobotId};

use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::tactics::{CoerceSituation, Likelihoods, Models, Tactic, detected};

/// Snapshots count by e^(−age/this), s (D17: the last half second).
const MEMORY_S: f32 = 0.5;
/// After a gap of this length all estimates restart, s.
const RESTART_AFTER_S: f32 = 2.0;
/// A mark of at least this likelihood updates the distance.
const MARKING_P_MIN: f32 = 0.5;

/// State of an opponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detected {
    /// The opponent's number in its team.
    pub opponent: RobotId,
    /// Place of the opponent, attack frame, m.
    pub at: Point<Attack>,
    /// The tactic that explains its places best; `None` if none does: it counts as one that follows the ball.
    pub tactic: Option<Tactic>,
    /// Mean likelihoods over the last half second, in the order of [`Tactic::ALL`].
    pub likelihoods: Likelihoods,
    /// The robot of ours that it follows.
    pub follows: Option<RobotId>,
    /// Distance from that robot, m: as observed of this opponent, before that the model's number.
    pub stand_off: f32,
    /// Whether it stands between that robot and the ball, not their goal.
    pub ball_side: bool,
}

impl Detected {
    /// Whether it follows our robots: these are coerced. All others count as following the ball.
    pub fn follows_robots(&self) -> bool {
        self.tactic == Some(Tactic::Mark)
    }
}

/// Means over time, for every opponent.
#[derive(Clone, Debug)]
pub struct Detector {
    models: Models,
    seen: Option<Instant>,
    known: [Option<Known>; ROBOTS_MAX],
}

#[derive(Clone, Copy, Debug)]
struct Known {
    likelihoods: Likelihoods,
    stand_off: f32,
}

impl Detector {
    /// A detector without any observation.
    pub fn new(models: Models) -> Self {
        Self { models, seen: None, known: [None; ROBOTS_MAX] }
    }

    /// Parameters of the tactics' models.
    pub fn models(&self) -> &Models {
        &self.models
    }

    /// Takes a snapshot; older ones count less and less, half of them after 0.35 s.
    pub fn watch(&mut self, view: &View, kicker: Option<RobotId>) {
        let since = self.seen.map_or(f32::INFINITY, |seen| view.now.since(seen).as_secs_f32());
        self.seen = Some(view.now);
        let keeps = if since < RESTART_AFTER_S { geometry::math::exp(-since / MEMORY_S) } else { 0.0 };
        let situation = CoerceSituation::new(view, self.models, kicker);
        let mut known = [None; ROBOTS_MAX];
        for robot in &view.theirs {
            let new = situation.likelihoods(robot.position);
            let before = self.known[robot.id.index()].filter(|_| keeps > 0.0);
            let mixed = |before: f32, new: f32| before * keeps + new * (1.0 - keeps);
            let likelihoods =
                before.map_or(new, |before| core::array::from_fn(|i| mixed(before.likelihoods[i], new[i])));
            let mut stand_off = before.map_or(self.models.stand_off, |before| before.stand_off);
            // A marker's distance is learned while it is very likely that it marks.
            if let (likely, Some(ours)) = situation.mark(robot.position)
                && likely > MARKING_P_MIN
            {
                stand_off = mixed(stand_off, view.ours[ours].position.distance(robot.position));
            }
            known[robot.id.index()] = Some(Known { likelihoods, stand_off });
        }
        self.known = known;
    }

    /// Estimates for each opponent of the view, by number; one never watched is judged by its present place.
    pub fn read(&self, view: &View, kicker: Option<RobotId>) -> heapless::Vec<Detected, ROBOTS_MAX> {
        let situation = CoerceSituation::new(view, self.models, kicker);
        view.theirs.iter().map(|robot| self.estimate(&situation, robot)).collect()
    }

    fn estimate(&self, situation: &CoerceSituation<'_>, robot: &ViewRobot) -> Detected {
        let ours = &situation.view.ours;
        let known = self.known[robot.id.index()];
        let likelihoods =
            known.map_or_else(|| situation.likelihoods(robot.position), |known| known.likelihoods);
        let stand_off = known.map_or(self.models.stand_off, |known| known.stand_off);
        let tactic = detected(&likelihoods, &self.models);
        let follows = situation.mark(robot.position).1.filter(|_| tactic == Some(Tactic::Mark));
        let ball_side = follows.is_some_and(|followed| {
            let [goal, ball] = situation.mark_places(ours[followed].position, stand_off);
            ball.distance(robot.position) < goal.distance(robot.position)
        });
        Detected {
            opponent: robot.id,
            at: robot.position,
            tactic,
            likelihoods,
            follows: follows.map(|followed| ours[followed].id),
            stand_off,
            ball_side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use rules::League;

    fn snapshot(ms: u64, theirs: &[(f32, f32)]) -> View {
        let ours = [(-2.8, 0.0), (-0.1, 1.0), (1.0, -1.0), (1.0, 0.5)];
        let mut view = view((0.0, 1.0), &ours, theirs);
        view.field = League::Ssl2013.field();
        view.now = Instant(ms * 1000);
        view
    }

    #[test]
    fn a_robot_that_keeps_to_ours_follows_it_and_one_passing_by_does_not() {
        let mut detector = Detector::new(Models::default());
        let kicker = RobotId::new(1);
        for tick in 0..150_u64 {
            // 0 stands 0.4 m goal-side of our 2; 1 runs through our 3's mark and is far behind 0.8 s later.
            let y = (-3.0 + 0.05 * tick as f32).min(1.95);
            let view = snapshot(tick * 10, &[(1.358, -0.821), (1.3, y)]);
            detector.watch(&view, kicker);
        }
        let view = snapshot(1_500, &[(1.358, -0.821), (1.3, 1.95)]);
        let read = detector.read(&view, kicker);
        assert_eq!((read[0].tactic, read[0].follows), (Some(Tactic::Mark), RobotId::new(2)));
        assert!(!read[0].ball_side && (read[0].stand_off - 0.4).abs() < 0.02, "{:?}", read[0]);
        assert_eq!(read[1].tactic, None, "{:?}", read[1]);
    }

    #[test]
    fn half_a_second_of_places_outweighs_one_misread_frame() {
        let mut detector = Detector::new(Models::default());
        let kicker = RobotId::new(1);
        for tick in 0..60 {
            detector.watch(&snapshot(tick * 10, &[(2.7, 0.1)]), kicker);
        }
        // One snapshot in which the keeper is taken for another robot at our robot 2.
        let off = snapshot(600, &[(1.25, -0.9)]);
        detector.watch(&off, kicker);
        assert_eq!(detector.read(&off, kicker)[0].tactic, Some(Tactic::Goalkeeper));
        // After a gap all estimates restart.
        let later = snapshot(5_000, &[(1.25, -0.9)]);
        detector.watch(&later, kicker);
        assert_eq!(detector.read(&later, kicker)[0].tactic, Some(Tactic::Mark));
    }
}
