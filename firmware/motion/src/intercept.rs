//! `intercept`: interception of a moving ball, soonest or with the most time to spare (paper 2 §2, equations
//! 1 and 2; m, s).
//!
//! For future places of the ball, [`STEP`] apart in time: the time when the ball is there, and the time when
//! the robot can be behind it, facing the kick's target. Their difference is the slack; only a slack ≥ 0
//! intercepts the ball. Places that a bound of the robot's reach rules out are skipped, eight at a time and
//! then singly, without planning a motion to them; the result equals that of the search through all of them.

use geometry::{Point, Vector, math};
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
        let best = match request {
            InterceptRequest::Soonest => self.soonest(limits),
            InterceptRequest::Safest => self.safest(limits),
        };
        best.map_or_else(|| self.chase(limits, self.horizon()), InterceptVerdict::Intercepts)
    }

    /// As [`Interception::find`], of few points, and with no more than `most` instructions of a Cortex-M4;
    /// also returns how many it took, by the estimates of its parts.
    pub fn find_within<L: CalcMotion>(
        &self,
        limits: &L,
        request: InterceptRequest,
        most: u32,
    ) -> (InterceptVerdict<F>, u32) {
        // The motion to where the ball is chased.
        let mut effort = most.saturating_sub(cost::MOTION);
        let best = match request {
            InterceptRequest::Soonest => self.about_soonest(limits, &mut effort),
            InterceptRequest::Safest => self.about_safest(limits, &mut effort),
        };
        let verdict = best.map_or_else(|| self.chase(limits, self.horizon()), InterceptVerdict::Intercepts);
        (verdict, most - effort)
    }

    fn horizon(&self) -> f32 {
        self.until.min(self.ball.duration()).clamp(0.0, HORIZON)
    }

    /// Number of the last step; the horizon itself comes after it.
    fn steps(&self) -> u32 {
        (self.horizon() * (1.0 / STEP)) as u32
    }

    fn soonest<L: CalcMotion>(&self, limits: &L) -> Option<InterceptionPoint<F>> {
        let steps = self.steps();
        let mut begins = 0.0;
        for block in 0..=steps / BLOCK {
            let (first, last) = (block * BLOCK, steps.min(block * BLOCK + BLOCK - 1));
            let time = if last == steps { self.horizon() } else { last as f32 * STEP };
            let (ends, _) = self.ball.progress(time);
            if !self.is_out_of_reach(limits, [begins, ends], time) {
                let times = (first..=last).map(|step| step as f32 * STEP);
                let mut times = times.chain((last == steps).then_some(time));
                let found = times.find_map(|time| self.look(limits, time, 0.0).interception_point());
                if found.is_some() {
                    return found;
                }
            }
            begins = ends;
        }
        None
    }

    /// The soonest by bisection: slack mostly grows until the ball passes the robot, and after that to the
    /// end where the robot is faster.
    fn about_soonest<L: CalcMotion>(&self, limits: &L, effort: &mut u32) -> Option<InterceptionPoint<F>> {
        let steps = self.steps();
        let soon = self.robot + self.velocity * SOON_S;
        let along = (soon - self.ball.from()).dot(self.ball.along());
        let passes = self.ball.time_to(math::max(along, 0.0)).unwrap_or(HORIZON);
        let passes = steps.min((passes * (1.0 / STEP)) as u32);
        let (mut late, mut in_time, mut best) = (0, passes, self.probe(limits, passes, 0.0, effort));
        if best.is_none() {
            (late, in_time, best) = (passes, steps, self.probe(limits, steps, 0.0, effort));
        }
        while best.is_some() && in_time - late > 1 && *effort >= cost::PLACE_TEST {
            let middle = late.midpoint(in_time);
            match self.probe(limits, middle, 0.0, effort) {
                None => late = middle,
                sooner => (in_time, best) = (middle, sooner),
            }
        }
        best
    }

    /// The probe with the most slack, and the points around it by halves of their distance.
    fn about_safest<L: CalcMotion>(&self, limits: &L, effort: &mut u32) -> Option<InterceptionPoint<F>> {
        let steps = self.steps();
        let mut best = self.probe(limits, steps, 0.0, effort);
        let mut at = steps;
        let mut try_at = |step: u32, at: &mut u32| {
            let least = best.as_ref().map_or(0.0, InterceptionPoint::slack);
            let found = self.probe(limits, step, least, effort);
            if found.is_some() {
                (best, *at) = (found, step);
            }
        };
        for probe in 1..PROBES {
            try_at(steps * probe / PROBES, &mut at);
        }
        let mut stride = steps / PROBES;
        while stride > 1 {
            stride /= 2;
            for step in [at.saturating_sub(stride), steps.min(at + stride)] {
                try_at(step, &mut at);
            }
        }
        best
    }

    /// The interception at a step, if its slack is `least` at least, and the effort suffices for the test.
    // Called from four places; a copy in each takes flash.
    #[inline(never)]
    fn probe<L: CalcMotion>(
        &self,
        limits: &L,
        step: u32,
        least: f32,
        effort: &mut u32,
    ) -> Option<InterceptionPoint<F>> {
        if *effort < cost::PLACE_TEST {
            return None;
        }
        let found = self.look(limits, step as f32 * STEP, least);
        *effort -= if matches!(found, Look::OutOfReach) { cost::BOUND } else { cost::PLACE_TEST };
        found.interception_point()
    }

    /// Searches from the end backwards, as slack mostly grows to the end, after some probes for the slack
    /// available.
    fn safest<L: CalcMotion>(&self, limits: &L) -> Option<InterceptionPoint<F>> {
        let (steps, horizon) = (self.steps(), self.horizon());
        let mut best = self.look(limits, horizon, 0.0).interception_point();
        let mut least = best.as_ref().map_or(0.0, InterceptionPoint::slack);
        for probe in 1..PROBES {
            let step = steps * probe / PROBES;
            if let Look::Intercepts(interception_point) = self.look(limits, step as f32 * STEP, least) {
                least = interception_point.slack();
            }
        }
        let mut block = steps / BLOCK + 1;
        while block > 0 {
            block -= 1;
            let (first, last) = (block * BLOCK, steps.min(block * BLOCK + BLOCK - 1));
            let (begins, _) = self.ball.progress(first as f32 * STEP);
            let time = last as f32 * STEP;
            let (ends, _) = self.ball.progress(time);
            if self.is_out_of_reach(limits, [begins, ends], time - least) {
                continue;
            }
            for step in (first..=last).rev() {
                // The first of equal ones.
                if let Look::Intercepts(interception_point) = self.look(limits, step as f32 * STEP, least) {
                    least = interception_point.slack();
                    best = Some(interception_point);
                }
            }
        }
        best
    }

    /// Whether no point with the ball's distances in `offsets` is reached within this time.
    fn is_out_of_reach<L: CalcMotion>(&self, limits: &L, offsets: [f32; 2], within: f32) -> bool {
        let [begins, ends] = offsets;
        let middle = self.ball.from() + self.ball.along() * (0.5 * (begins + ends));
        let radius = 0.5 * (ends - begins) + self.reach;
        limits.is_surely_longer(self.robot, self.velocity, middle, radius, within)
    }

    /// The interception at a time, if its slack is `least` at least.
    fn look<L: CalcMotion>(&self, limits: &L, time: f32, least: f32) -> Look<F> {
        let ball = self.ball.from() + self.ball.along() * self.ball.progress(time).0;
        let place = kick_place(ball, self.target, self.reach);
        if limits.is_surely_longer(self.robot, self.velocity, place, 0.0, time - least) {
            return Look::OutOfReach;
        }
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

/// Instructions of a Cortex-M4 that the parts of a bounded search take at most.
mod cost {
    /// Where the ball is at a time, and the bound of the robot's reach.
    pub(super) const BOUND: u32 = 300;
    /// The time of a motion.
    pub(super) const MOTION: u32 = 1_100;
    /// A point that may be in reach.
    pub(super) const PLACE_TEST: u32 = BOUND + MOTION;
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
/// Time in which a robot turns its velocity, s: where it is then, the ball passes it.
const SOON_S: f32 = 0.25;
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
    fn in_bounded_time_most_interceptions_are_found_and_few_are_later_than_the_soonest() {
        // The least that are the soonest, and the most that are more than 7 places later or missed. The
        // second is what a robot has: effort and horizon of the brain's `get_ball`.
        for (until, effort, least, most) in [(2.0, 30_000, 820, 8), (0.8, 7_500, 170, 2)] {
            let [same, near, later, missed] = compared(until, effort);
            assert!(
                same >= least && near < 60 && later + missed <= most,
                "{until} s: {same} the same, {near} near, {later} later, {missed} missed"
            );
        }
    }

    /// Numbers of 2,000 questions in which the search with this effort finds the soonest interception, one at
    /// most 7 places later, a later one, and none where there is one; farther away, the longer the horizon.
    fn compared(until: f32, effort: u32) -> [u32; 4] {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(3);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        let (mut same, mut near, mut later, mut missed) = (0, 0, 0, 0);
        let size = 0.5 * until;
        for _ in 0..2_000 {
            let from = Point::new(within(3.0 * size), within(2.0 * size));
            let velocity = Vector::polar(0.8 + within(0.7), Angle::new(within(3.0)));
            let path = BallModel::default().rolling(from, velocity);
            let asked = Interception {
                robot: Point::<Field>::new(within(3.0 * size), within(2.0 * size)),
                velocity: Vector::new(within(1.0), within(1.0)),
                ball: &path,
                target: from - velocity,
                reach: 0.1,
                until,
            };
            let limits = FreeLimits::default();
            match (
                asked.find(&limits, InterceptRequest::Soonest),
                asked.find_within(&limits, InterceptRequest::Soonest, effort).0,
            ) {
                (InterceptVerdict::Intercepts(best), InterceptVerdict::Intercepts(found))
                    if best == found =>
                {
                    same += 1;
                }
                (InterceptVerdict::Intercepts(best), InterceptVerdict::Intercepts(found)) => {
                    let by = found.ball_time - best.ball_time;
                    assert!(by > 0.0, "{asked:?}");
                    let is_near = by < (BLOCK as f32 - 0.5) * STEP;
                    (near, later) = (near + u32::from(is_near), later + u32::from(!is_near));
                }
                (exact, found) => {
                    assert!(matches!(found, InterceptVerdict::Chase { .. }), "{exact:?} {found:?}");
                    missed += u32::from(matches!(exact, InterceptVerdict::Intercepts(_)));
                }
            }
        }
        [same, near, later, missed]
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
