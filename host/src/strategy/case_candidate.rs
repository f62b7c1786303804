//! `case_candidate`: the case that our robots would retrieve for a ball at a place, with its next step: one
//! of the actions that the rated list compares. Attack frame, m.

use casebase::{CaseBase, LegKind, Problem, RetrievalSettings};
use geometry::{Attack, Point};
use protocol::host::Hint;
use protocol::team::CASE_ROBOTS_MAX;
use protocol::{CaseId, RobotId};

use super::view::View;

/// A kick that ends this near the goal line is a shot, m: cases shoot at the line itself, in whole mm.
const SHOT_ENDS_WITHIN_M: f32 = 0.01;

/// A case, and our robots that play it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastCase {
    /// Number of the stored case.
    pub case: CaseId,
    /// Case robot i is played by entry i.
    pub robots: [Option<RobotId>; CASE_ROBOTS_MAX],
    /// First thing that the case does with the ball.
    pub step: CaseStep,
}

/// The first thing that a case does with the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CaseStep {
    /// A pass to a robot of the case.
    Pass {
        /// Place where the ball is kicked, m.
        from: Point<Attack>,
        /// The teammate that receives it.
        receiver: RobotId,
        /// Place of the reception, m.
        at: Point<Attack>,
    },
    /// A kick at the goal.
    Shot {
        /// Place where the ball is kicked, m.
        from: Point<Attack>,
    },
    /// A kick that ends on the field, without a receiver.
    Kick {
        /// Place where the ball stops, m.
        to: Point<Attack>,
    },
    /// The ball is not kicked.
    Hold,
}

impl CastCase {
    /// The proposal to the robots.
    pub fn hint(&self) -> Hint {
        Hint { case: self.case, robots: self.robots.iter().flatten().copied().collect(), pass_point: None }
    }

    /// Whether a robot of ours plays in it.
    pub fn has(&self, robot: RobotId) -> bool {
        self.robots.contains(&Some(robot))
    }
}

/// The case that robots for which `may` is true would retrieve for a ball that lies at `ball`, if `getter` is
/// the one that gets the ball in it.
pub fn retrieve(
    view: &View,
    base: &CaseBase<'_>,
    getter: RobotId,
    ball: Point<Attack>,
    may: impl Fn(RobotId) -> bool,
) -> Option<CastCase> {
    let flip = view.flip;
    let mut problem = Problem {
        ball: flip.to_field(ball).into(),
        defending: flip.defends(),
        teammates: heapless::Vec::new(),
        opponents: heapless::Vec::new(),
    };
    for robot in view.ours.iter().filter(|robot| may(robot.id) && view.knows_cases.has(robot.id)) {
        // A team larger than a problem holds is cut at its limit, as the robots do.
        let _ = problem.teammates.push((robot.id, flip.to_field(robot.position).into()));
    }
    for robot in &view.theirs {
        let _ = problem.opponents.push(flip.to_field(robot.position).into());
    }
    let found = casebase::retrieve_best(base, &problem, &RetrievalSettings::default())?;
    let case = base.case(found.case)?;
    if found.correspondence.get(case.getter().index()) != Some(&getter) {
        return None;
    }
    let mut robots = [None; CASE_ROBOTS_MAX];
    for (place, robot) in robots.iter_mut().zip(&found.correspondence) {
        *place = Some(*robot);
    }
    let goal_line = view.field.length * 0.5;
    let step = match case.legs(problem.ball).next() {
        None => CaseStep::Hold,
        Some(leg) => {
            let (from, to) = (flip.point(leg.start()), flip.point(leg.end()));
            match leg.kind {
                LegKind::Pass(receiver) => {
                    CaseStep::Pass { from, receiver: robots.get(receiver.index()).copied()??, at: to }
                }
                LegKind::Kick(_) if to.x() >= goal_line - SHOT_ENDS_WITHIN_M => CaseStep::Shot { from },
                LegKind::Kick(_) => CaseStep::Kick { to },
            }
        }
    };
    Some(CastCase { case: found.case, robots, step })
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::super::view::{Flip, RobotSet};
    use super::*;
    use geometry::GoalEnd;

    fn knowing(mut view: View) -> View {
        let mut all = RobotSet::default();
        view.ours.iter().for_each(|robot| all.insert(robot.id));
        view.knows_cases = all;
        view
    }

    const OURS: [(f32, f32); 3] = [(-4.4, 0.0), (0.6, 0.0), (1.5, 1.6)];

    #[test]
    fn it_is_the_same_case_turned_where_the_team_defends_the_other_goal() {
        let base = case_library::division_b();
        let mut seen = 0;
        for i in 0..63 {
            let at = (0.5 + 0.5 * (i % 7) as f32, 0.5 * (i / 7) as f32 - 2.0);
            let mut view = knowing(view(at, &OURS, &[(4.4, 0.0)]));
            view.ours[1].position = Point::new(at.0 - 0.2, at.1);
            let turned = View { flip: Flip::defending(GoalEnd::Positive), ..view.clone() };
            let ball = view.ball.unwrap().position;
            let of = |view: &View| {
                let getter = view.ours[1].id;
                retrieve(view, &base, getter, ball, |id| id != view.keeper)
            };
            match (of(&view), of(&turned)) {
                (Some(here), Some(there)) => {
                    seen += 1;
                    assert_eq!(here.robots, there.robots, "{at:?}");
                    assert_ne!(here.case, there.case, "each symmetric copy has an id of its own");
                }
                (here, there) => assert_eq!(here.is_some(), there.is_some(), "{at:?}: {here:?} {there:?}"),
            }
        }
        assert!(seen > 10, "{seen} of 63 balls");
    }

    #[test]
    fn robots_with_another_case_base_and_those_that_may_not_take_no_part() {
        let base = case_library::division_b();
        let mut view = knowing(view((3.0, 0.0), &OURS, &[(4.4, 0.0)]));
        view.ours[1].position = Point::new(2.8, 0.0);
        let getter = view.ours[1].id;
        let find = |view: &View, may: &dyn Fn(RobotId) -> bool| {
            retrieve(view, &base, getter, Point::new(3.0, 0.0), may)
        };
        assert!(find(&view, &|_| true).is_some_and(|found| found.has(getter)));
        assert_eq!(find(&view, &|id| id != getter), None, "the one at the ball may not");
        view.knows_cases = RobotSet::default();
        assert_eq!(find(&view, &|_| true), None);
    }
}
