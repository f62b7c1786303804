//! `case_candidate`: the case that our robots would retrieve for a ball at a place, with its next step: one
//! of the actions that the rated list compares. Attack frame, m.

use casebase::{CaseBase, CaseRobot, LegKind, Problem, RetrievalSettings};
use geometry::{Attack, Point};
use protocol::host::Hint;
use protocol::team::CASE_ROBOTS_MAX;
use protocol::{CaseId, RobotId};
use rules::Phase;

use super::view::{CasePass, View};

/// At a restart mates have 2.5 s to go anywhere, mm: the kicker goes round the ball, and waits for them.
const RESTART_TRAVEL_MAX_MM: f32 = 5000.0;
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

    /// The pass of `getter` that it starts with.
    pub fn first_pass(&self, getter: RobotId) -> Option<CasePass> {
        let CaseStep::Pass { receiver, at, .. } = self.step else { return None };
        let (passer, receiver) = ((getter, self.part_of(getter)?), (receiver, self.part_of(receiver)?));
        Some(CasePass { case: self.case, passer, receiver, at })
    }

    /// The case robot that a robot of ours plays.
    fn part_of(&self, robot: RobotId) -> Option<CaseRobot> {
        CaseRobot::new(self.robots.iter().position(|player| *player == Some(robot))?)
    }

    /// Whether a robot of ours plays in it.
    pub fn has(&self, robot: RobotId) -> bool {
        self.part_of(robot).is_some()
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
    let mut settings = RetrievalSettings::default();
    if view.phase != Phase::Run {
        settings.travel_max_mm = RESTART_TRAVEL_MAX_MM;
    }
    let found = casebase::retrieve_best(base, &problem, &settings)?;
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

    #[test]
    fn the_first_pass_of_a_case_names_passer_and_receiver_with_their_parts() {
        let id = |number| RobotId::new(number).unwrap();
        let at = Point::new(2.0, 1.0);
        let step = CaseStep::Pass { from: Point::new(0.0, 0.0), receiver: id(5), at };
        let cast = CastCase { case: CaseId(3), robots: [Some(id(2)), Some(id(5)), None, None], step };
        let pass = cast.first_pass(id(2)).unwrap();
        assert_eq!((pass.passer.1.index(), pass.receiver.1.index(), pass.at), (0, 1, at));
        assert_eq!(cast.first_pass(id(4)), None, "it plays no part");
        assert_eq!(CastCase { step: CaseStep::Hold, ..cast }.first_pass(id(2)), None);
    }

    #[test]
    fn at_a_restart_mates_may_be_farther_from_their_places() {
        let base = case_library::division_b();
        let found = |phase| {
            let balls = (0..63).map(|i| (0.5 + 0.5 * (i % 7) as f32, 0.5 * (i / 7) as f32 - 2.0));
            let of_two = |at: (f32, f32)| {
                let mut view =
                    knowing(view(at, &[(-4.4, 0.0), (at.0 - 0.2, at.1), (-2.5, 0.0)], &[(4.4, 0.0)]));
                view.phase = phase;
                let found =
                    retrieve(&view, &base, view.ours[1].id, Point::new(at.0, at.1), |id| id != view.keeper);
                found.is_some_and(|cast| cast.has(view.ours[2].id))
            };
            balls.filter(|at| of_two(*at)).count()
        };
        let (in_play, restart) = (found(Phase::Run), found(Phase::FreeKick(rules::Side::Ours)));
        assert!(restart > in_play + 5, "{restart} of 63 balls, in play {in_play}");
    }
}
