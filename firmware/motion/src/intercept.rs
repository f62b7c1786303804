//! `intercept`: interception of a moving ball, soonest or with the most time to spare (paper 2 §2, equations
//! 1 and 2; m, s).
//!
//! For future places of the ball, [`STEP`] apart in time: the time when the ball is there, and the time when
//! the robot can be behind it, facing the kick's target. Their difference is the slack; only a slack ≥ 0
//! intercepts the ball. Places that a bound of the robot's reach rules out are skipped, eight at a time and
//! then singly, without planning a motion to them; the result equals that of the search through all of them.

use geometry::{Point, Vector};
use rules::RobotSpec;

use crate::ball::BallPath;
use crate::trajectory::{CalcMotion, Motion};

/// Input of an interception.
#[derive(Clone, Copy, Debug)]
pub struct Interception<'b, F> {
    /// Position of the robot, m.
    pub robot: Point<F>,
    /// Velocity of the robot, m/s.
    pub velocity: Vector<F>,
    /// Predicted path of the ball.
    pub ball: &'b BallPath<F>,
    /// Target of the kick: the robot stops on the far side of the ball.
    pub target: Point<F>,
    /// Distance from the robot's centre to the ball's, when it kicks: r_robot + r_ball − 10 mm
    /// ([`kick_reach`]), m.
    pub reach: f32,
    /// Time for which the ball is of interest, s: until it leaves the field, or is taken. At most
    /// [`HORIZON`].
    pub until: f32,
}

/// Which of the reachable interceptions to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InterceptRequest {
    /// arg min t_ball: for an attacker, whose failure is cheap.
    Soonest,
    /// arg max slack: for a defender, whose failure is a goal.
    Safest,
}

/// Result of an interception.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InterceptVerdict<F> {
    /// The robot can intercept in time.
    Intercepts(InterceptionPoint<F>),
    /// No point is reached in time: go to the ball's stop position, or to where it is no longer of interest.
    Chase {
        /// Position of the ball then, m.
        ball: Point<F>,
        /// Position of the robot behind it.
        place: Point<F>,
        /// Time at which the robot can be there, s.
        robot_time: f32,
    },
}

/// An interception of the ball by a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterceptionPoint<F> {
    /// Position of the ball then, m.
    pub ball: Point<F>,
    /// Position of the robot behind it.
    pub place: Point<F>,
    /// Time at which the ball is there, s from now.
    pub ball_time: f32,
    /// Time at which the robot can be there, s from now.
    pub robot_time: f32,
}

impl<F> InterceptionPoint<F> {
    /// Time that the robot waits, s.
    pub fn slack(&self) -> f32 {
        self.ball_time - self.robot_time
    }
}

/// From the robot's centre to the ball's, when it kicks, m: the dribbler's opening lets the ball in
/// (`HullSpec::opening`).
pub fn kick_reach(robot_radius: f32, ball_radius: f32) -> f32 {
    robot_radius + ball_radius - RobotSpec::OURS.hull.opening
}

/// The robot's place for a kick of a ball at `ball` to `target`: `reach` behind it. If ball and target
/// coincide, the robot is on the −x side.
pub fn kick_place<F: Copy>(ball: Point<F>, target: Point<F>, reach: f32) -> Point<F> {
    ball - (target - ball).unit().unwrap_or(Vector::new(1.0, 0.0)) * reach
}

impl<F: Copy> Interception<'_, F> {
    /// Finds the interception that `request` asks for; else where to follow the ball.
    pub fn find<L: CalcMotion>(&self, limits: &L, request: InterceptRequest) -> InterceptVerdict<F> {
        let mut effort = Effort { left: u32::MAX };
        let best = match request {
            InterceptRequest::Soonest => self.soonest(limits, &mut effort),
            InterceptRequest::Safest => self.safest(limits, &mut effort),
        };
        best.map_or_else(|| self.chase(limits, self.horizon()), InterceptVerdict::Intercepts)
    }

    /// As [`Interception::find`], of ever fewer points while they are in vain, and with no more than `most`
    /// instructions of a Cortex-M4; also returns how many it took, by the estimates of its parts.
    pub fn find_within<L: CalcMotion>(
        &self,
        limits: &L,
        request: InterceptRequest,
        most: u32,
    ) -> (InterceptVerdict<F>, u32) {
        let mut effort = Effort { left: most };
        let best = match request {
            InterceptRequest::Soonest => self.soonest(limits, &mut effort),
            InterceptRequest::Safest => self.about_safest(limits, &mut effort),
        };
        let verdict = match best {
            Some(interception_point) => InterceptVerdict::Intercepts(interception_point),
            None => {
                effort.spend(cost::MOTION);
                self.chase(limits, self.horizon())
            }
        };
        (verdict, most - effort.left)
    }

    fn horizon(&self) -> f32 {
        self.until.min(self.ball.duration()).clamp(0.0, HORIZON)
    }

    /// Number of the last step; the horizon itself comes after it.
    fn steps(&self) -> u32 {
        (self.horizon() * (1.0 / STEP)) as u32
    }

    fn soonest<L: CalcMotion>(&self, limits: &L, effort: &mut Effort) -> Option<InterceptionPoint<F>> {
        let steps = self.steps();
        let bounded = effort.is_bounded();
        // The last point without an interception, the number of such points, and their stride.
        let (mut late, mut vain, mut stride) = (0, 0, 1);
        let (mut step, mut block_ends) = (0, 0);
        while step <= steps {
            if step >= block_ends {
                let first = step - step % BLOCK;
                let last = steps.min(first + BLOCK - 1);
                let time = if last == steps { self.horizon() } else { last as f32 * STEP };
                if self.is_out_of_reach(limits, [first as f32 * STEP, time], time, effort) {
                    (late, step) = (last, last + 1);
                    if last == steps {
                        return None;
                    }
                    continue;
                }
                block_ends = last + 1;
            }
            if !effort.affords_a_look() {
                return None;
            }
            match self.look(limits, step as f32 * STEP, 0.0, effort) {
                Look::Intercepts(interception_point) => {
                    return Some(self.sooner(limits, [late, step], interception_point, effort));
                }
                Look::TooLate => vain += 1,
                Look::OutOfReach => {}
            }
            late = step;
            if bounded && vain == VAIN_MAX {
                (vain, stride) = (0, stride * COARSER);
            }
            step += stride;
        }
        effort
            .affords_a_look()
            .then(|| self.look(limits, self.horizon(), 0.0, effort).interception_point())?
    }

    /// The soonest of the points between a late one and one in time, by bisection: once in time, the robot
    /// mostly stays so.
    fn sooner<L: CalcMotion>(
        &self,
        limits: &L,
        [late, in_time]: [u32; 2],
        found: InterceptionPoint<F>,
        effort: &mut Effort,
    ) -> InterceptionPoint<F> {
        let (mut late, mut in_time, mut best) = (late, in_time, found);
        while in_time - late > 1 && effort.affords_a_look() {
            let middle = late.midpoint(in_time);
            match self.look(limits, middle as f32 * STEP, 0.0, effort).interception_point() {
                Some(interception_point) => (in_time, best) = (middle, interception_point),
                None => late = middle,
            }
        }
        best
    }

    /// The probe with the most slack, and the points around it by halves of their distance.
    fn about_safest<L: CalcMotion>(&self, limits: &L, effort: &mut Effort) -> Option<InterceptionPoint<F>> {
        let steps = self.steps();
        let mut best = self.look(limits, self.horizon(), 0.0, effort).interception_point();
        let mut at = steps;
        for probe in 1..PROBES {
            let step = steps * probe / PROBES;
            if self.improves(limits, step, &mut best, effort) {
                at = step;
            }
        }
        let mut stride = steps / PROBES;
        while stride > 1 {
            stride /= 2;
            for step in [at.saturating_sub(stride), steps.min(at + stride)] {
                if self.improves(limits, step, &mut best, effort) {
                    at = step;
                }
            }
        }
        best
    }

    /// Takes the point of a step where it has more slack than the best one; tested as far as the effort goes.
    fn improves<L: CalcMotion>(
        &self,
        limits: &L,
        step: u32,
        best: &mut Option<InterceptionPoint<F>>,
        effort: &mut Effort,
    ) -> bool {
        let least = best.as_ref().map_or(0.0, InterceptionPoint::slack);
        if effort.affords_a_look()
            && let Look::Intercepts(found) = self.look(limits, step as f32 * STEP, least, effort)
        {
            *best = Some(found);
            return true;
        }
        false
    }

    /// Searches from the end backwards, as slack mostly grows to the end, after some probes for the slack
    /// available.
    fn safest<L: CalcMotion>(&self, limits: &L, effort: &mut Effort) -> Option<InterceptionPoint<F>> {
        let (steps, horizon) = (self.steps(), self.horizon());
        let mut best = self.look(limits, horizon, 0.0, effort).interception_point();
        let mut least = best.as_ref().map_or(0.0, InterceptionPoint::slack);
        for probe in 1..PROBES {
            let step = steps * probe / PROBES;
            if let Look::Intercepts(interception_point) = self.look(limits, step as f32 * STEP, least, effort)
            {
                least = interception_point.slack();
            }
        }
        let mut block = steps / BLOCK + 1;
        while block > 0 {
            block -= 1;
            let (first, last) = (block * BLOCK, steps.min(block * BLOCK + BLOCK - 1));
            let times = [first as f32 * STEP, last as f32 * STEP];
            if self.is_out_of_reach(limits, times, times[1] - least, effort) {
                continue;
            }
            for step in (first..=last).rev() {
                // The first of equal ones.
                if let Look::Intercepts(interception_point) =
                    self.look(limits, step as f32 * STEP, least, effort)
                {
                    least = interception_point.slack();
                    best = Some(interception_point);
                }
            }
        }
        best
    }

    /// Whether no point where the ball is between these times is reached `within` a time.
    fn is_out_of_reach<L: CalcMotion>(
        &self,
        limits: &L,
        [from, to]: [f32; 2],
        within: f32,
        effort: &mut Effort,
    ) -> bool {
        effort.spend(cost::BOUND);
        let (begins, ends) = (self.ball.progress(from).0, self.ball.progress(to).0);
        let middle = self.ball.from() + self.ball.along() * (0.5 * (begins + ends));
        let radius = 0.5 * (ends - begins) + self.reach;
        limits.is_surely_longer(self.robot, self.velocity, middle, radius, within)
    }

    /// The interception at a time, if its slack is `least` at least.
    fn look<L: CalcMotion>(&self, limits: &L, time: f32, least: f32, effort: &mut Effort) -> Look<F> {
        effort.spend(cost::BOUND);
        let ball = self.ball.from() + self.ball.along() * self.ball.progress(time).0;
        let place = kick_place(ball, self.target, self.reach);
        if limits.is_surely_longer(self.robot, self.velocity, place, 0.0, time - least) {
            return Look::OutOfReach;
        }
        effort.spend(cost::MOTION);
        // Slightly more than required, as both differences are rounded.
        let within = time - least + ROUNDING;
        let Some(robot_time) = limits.time_within(self.robot, self.velocity, place, within) else {
            return Look::TooLate;
        };
        let interception_point = InterceptionPoint { ball, place, ball_time: time, robot_time };
        if interception_point.slack() >= least { Look::Intercepts(interception_point) } else { Look::TooLate }
    }

    fn chase<L: CalcMotion>(&self, limits: &L, horizon: f32) -> InterceptVerdict<F> {
        let ball = self.ball.at(horizon).position;
        let place = kick_place(ball, self.target, self.reach);
        InterceptVerdict::Chase { ball, place, robot_time: limits.time(self.robot, self.velocity, place) }
    }
}

/// Instructions that are left for a search.
struct Effort {
    left: u32,
}

impl Effort {
    fn is_bounded(&self) -> bool {
        self.left < u32::MAX / 2
    }

    fn spend(&mut self, instructions: u32) {
        self.left = self.left.saturating_sub(instructions);
    }

    /// Whether another point may be tested, and after it a motion to where the ball is chased.
    fn affords_a_look(&self) -> bool {
        self.left >= cost::BOUND + 2 * cost::MOTION
    }
}

/// Instructions of a Cortex-M4 that the parts of a bounded search take at most.
mod cost {
    /// Where the ball is at a time, and the bound of the robot's reach.
    pub(super) const BOUND: u32 = 300;
    /// The time of a motion.
    pub(super) const MOTION: u32 = 1_100;
}

/// Result of testing one point.
enum Look<F> {
    /// The robot intercepts the ball there.
    Intercepts(InterceptionPoint<F>),
    /// It does not intercept, by a planned motion.
    TooLate,
    /// It cannot intercept; no motion was planned.
    OutOfReach,
}

impl<F> Look<F> {
    fn interception_point(self) -> Option<InterceptionPoint<F>> {
        match self {
            Self::Intercepts(interception_point) => Some(interception_point),
            Self::TooLate | Self::OutOfReach => None,
        }
    }
}

/// Time between two points of the ball's path, s.
pub const STEP: f32 = 0.02;
/// Number of points that are ruled out together.
const BLOCK: u32 = 8;
/// In bounded time, number of points without an interception after which the stride grows, and its factor.
const VAIN_MAX: u32 = 2;
const COARSER: u32 = 4;
/// Tolerance for rounding, s.
const ROUNDING: f32 = 1e-5;
/// Number of shares of the horizon that are probed first for the slack.
const PROBES: u32 = 6;
/// Longest prediction, s: a kick of 6.5 m/s has left the field by then.
pub const HORIZON: f32 = 5.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::BallModel;
    use crate::trajectory::{DragLimits, FreeLimits};
    use geometry::{Angle, Field};
    use rand_core::{RngCore, SeedableRng};
    use rand_xoshiro::Xoshiro128PlusPlus;

    /// The plain search through every place.
    fn linear<L: CalcMotion>(
        asked: &Interception<'_, Field>,
        limits: &L,
        request: InterceptRequest,
    ) -> InterceptVerdict<Field> {
        let horizon = asked.horizon();
        let mut best: Option<InterceptionPoint<Field>> = None;
        let steps = (horizon / STEP) as u32;
        for time in (0..=steps).map(|step| step as f32 * STEP).chain([horizon]) {
            let ball = asked.ball.from() + asked.ball.along() * asked.ball.progress(time).0;
            let place = kick_place(ball, asked.target, asked.reach);
            let robot_time = limits.time(asked.robot, asked.velocity, place);
            let interception_point = InterceptionPoint { ball, place, ball_time: time, robot_time };
            let better = best.is_none_or(|best| {
                request == InterceptRequest::Safest && interception_point.slack() > best.slack()
            });
            if interception_point.slack() >= 0.0 && better {
                best = Some(interception_point);
            }
        }
        best.map_or_else(|| asked.chase(limits, horizon), InterceptVerdict::Intercepts)
    }

    #[test]
    fn in_bounded_time_the_interception_is_mostly_the_soonest_or_at_most_7_places_later() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(3);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        let (mut same, mut later, mut none) = (0, 0, 0);
        for _ in 0..2_000 {
            let from = Point::new(within(3.0), within(2.0));
            let velocity = Vector::polar(0.8 + within(0.7), Angle::new(within(3.0)));
            let path = BallModel::default().rolling(from, velocity);
            let asked = Interception {
                robot: Point::<Field>::new(within(3.0), within(2.0)),
                velocity: Vector::new(within(1.0), within(1.0)),
                ball: &path,
                target: from - velocity,
                reach: 0.1,
                until: 2.0,
            };
            let limits = FreeLimits::default();
            match (
                asked.find(&limits, InterceptRequest::Soonest),
                asked.find_within(&limits, InterceptRequest::Soonest, 30_000).0,
            ) {
                (InterceptVerdict::Intercepts(best), InterceptVerdict::Intercepts(found))
                    if best == found =>
                {
                    same += 1;
                }
                (InterceptVerdict::Intercepts(best), InterceptVerdict::Intercepts(found)) => {
                    let by = found.ball_time - best.ball_time;
                    assert!(by > 0.0 && by < (BLOCK as f32 - 0.5) * STEP, "{by} s later: {asked:?}");
                    later += 1;
                }
                (exact, found) => {
                    assert!(matches!(found, InterceptVerdict::Chase { .. }), "{exact:?} {found:?}");
                    none += 1;
                }
            }
        }
        assert!(
            same > 800 && (1..20).contains(&later) && none < 1_200,
            "{same} the same, {later} later, {none} none"
        );
    }

    #[test]
    fn the_answer_is_that_of_the_search_through_every_place() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(2);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        let (mut interception_points, mut chases) = (0, 0);
        for i in 0..1_500 {
            let velocity = Vector::polar(3.25 + within(3.25), Angle::new(within(3.0)));
            let start = Point::new(within(4.5), within(3.0));
            let model = BallModel::default();
            let ball =
                if i % 2 == 0 { model.kicked(start, velocity) } else { model.rolling(start, velocity) };
            let asked = Interception {
                robot: Point::<Field>::new(within(4.5), within(3.0)),
                velocity: Vector::new(within(2.0), within(2.0)),
                ball: &ball,
                target: Point::new(4.5, 0.0),
                reach: kick_reach(0.09, 0.0215),
                until: 3.0 + within(3.0),
            };
            for request in [InterceptRequest::Soonest, InterceptRequest::Safest] {
                let found = asked.find(&FreeLimits::default(), request);
                assert_eq!(found, linear(&asked, &FreeLimits::default(), request), "{asked:?}");
                match found {
                    InterceptVerdict::Intercepts(_) => interception_points += 1,
                    InterceptVerdict::Chase { .. } => chases += 1,
                }
            }
            if i < 100 {
                let drag = DragLimits::default();
                assert_eq!(
                    asked.find(&drag, InterceptRequest::Soonest),
                    linear(&asked, &drag, InterceptRequest::Soonest)
                );
            }
        }
        assert!(interception_points > 500 && chases > 500, "{interception_points} {chases}");
    }

    fn asked(ball: &BallPath<Field>, robot: Point<Field>) -> Interception<'_, Field> {
        let target = Point::new(4.5, 0.0);
        Interception { robot, velocity: Vector::default(), ball, target, reach: 0.1, until: 10.0 }
    }

    #[test]
    fn a_ball_that_comes_by_is_met_soonest_where_the_robot_is_just_in_time() {
        let ball = BallModel::default().rolling(Point::new(-2.0, 1.0), Vector::new(2.0, 0.0));
        let question = asked(&ball, Point::new(0.0, 0.0));
        let InterceptVerdict::Intercepts(soonest) =
            question.find(&FreeLimits::default(), InterceptRequest::Soonest)
        else {
            panic!()
        };
        // One step earlier the robot would be late.
        assert!(soonest.slack() >= 0.0 && soonest.slack() < 0.1, "{soonest:?}");
        let InterceptVerdict::Intercepts(safest) =
            question.find(&FreeLimits::default(), InterceptRequest::Safest)
        else {
            panic!()
        };
        assert!(safest.slack() > soonest.slack() && safest.ball_time > soonest.ball_time);
        // It stands 0.1 m behind the ball, seen from the target.
        assert!((soonest.place.distance(soonest.ball) - 0.1).abs() < 1e-5);
        assert!(soonest.place.distance(question.target) > soonest.ball.distance(question.target));
    }

    #[test]
    fn a_ball_that_runs_away_is_chased_to_its_rest() {
        let ball = BallModel::default().rolling(Point::new(0.0, 0.0), Vector::new(1.0, 0.0));
        let slow = FreeLimits { speed: 0.1, acceleration: 1.0, braking: 1.0 };
        let InterceptVerdict::Chase { ball: rest, robot_time, .. } =
            asked(&ball, Point::new(-2.0, 0.0)).find(&slow, InterceptRequest::Soonest)
        else {
            panic!()
        };
        assert!((rest.x() - 1.0 / 0.7).abs() < 1e-3 && robot_time > 30.0);
    }

    #[test]
    fn a_ball_at_rest_is_met_by_who_stands_behind_it_and_chased_by_others() {
        let ball = BallModel::default().rolling(Point::new(1.0, 0.0), Vector::default());
        let behind = asked(&ball, Point::new(0.9, 0.0));
        assert!(
            matches!(behind.find(&FreeLimits::default(), InterceptRequest::Safest), InterceptVerdict::Intercepts(m) if m.ball_time == 0.0)
        );
        let away = asked(&ball, Point::new(0.0, 0.0));
        assert!(matches!(
            away.find(&FreeLimits::default(), InterceptRequest::Safest),
            InterceptVerdict::Chase { .. }
        ));
    }
}
