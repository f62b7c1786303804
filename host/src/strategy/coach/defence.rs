//! `defence`: defence of our goal: keeper and two defenders on the ball's line; by threats, if the team plays
//! them (Biswas et al. 2014 §5).

use geometry::{Attack, Point};
use rules::Phase;

use super::super::order::{Role, Task, Why};
use super::super::threat::{self, receiving::comes_at_goal};
use super::super::view::{Ball, RobotSet, View};
use super::super::{defence, roles};
use super::{Coach, Plan};

impl Coach {
    /// Keeper and defenders; while `attacked`, everybody free too if second-level threats are played.
    pub(super) fn defend(&mut self, plan: &mut Plan<'_>, attacked: bool) {
        if self.tactics.threats {
            return self.against_threats(plan, attacked && self.tactics.second_level);
        }
        if plan.view.phase == Phase::Run {
            plan.keeper();
        } else {
            plan.keeper_guards();
        }
        let (places, why) = defence::defenders(plan.view);
        let places = places.map(|at| plan.kept_off(at));
        self.defenders = roles::assign(plan.view, &mut plan.free, &places, &self.defenders);
        for (i, id) in self.defenders.into_iter().enumerate() {
            if let Some(id) = id {
                plan.order(id, Role::Defender(i as u8), plan.facing_ball(places[i]), why);
            }
        }
    }

    fn against_threats(&mut self, plan: &mut Plan<'_>, everybody: bool) {
        let view = plan.view;
        let mut team = self.primaries(plan);
        if everybody {
            plan.free.iter().for_each(|id| team.insert(*id));
        }
        let defence = threat::defend(view, team, &mut self.threats, &threat::Settings::default());
        self.defenders = self.threats.primaries();
        for (i, assignment) in defence.assignments.iter().enumerate() {
            let (id, why) = (assignment.robot, Why::Threat(assignment.guards));
            if !plan.take(id) {
                continue;
            }
            if id == view.keeper {
                let (task, why) = keeper(view, assignment.at, why);
                plan.order(id, Role::Keeper, task, why);
                continue;
            }
            // A primary defender stays one where it blocks a second-level shot from the edge.
            let primary = self.defenders.iter().position(|defender| *defender == Some(id));
            let role = primary.map_or(Role::Marker(i as u8), |slot| Role::Defender(slot as u8));
            plan.order(id, role, plan.facing_ball(plan.kept_off(assignment.at)), why);
        }
    }

    /// Whether the ball before our area is left to our keeper.
    pub(super) fn is_keepers(&self, view: &View, ball: &Ball) -> bool {
        self.tactics.threats && view.our(view.keeper).is_some() && lies_before_our_area(view, ball)
    }

    /// The two nearest to where defenders stand; who was one stays one.
    pub(super) fn primaries(&self, plan: &Plan<'_>) -> RobotSet {
        let view = plan.view;
        let mut free = plan.free.clone();
        free.retain(|id| *id != view.keeper);
        let (places, _) = defence::defenders(view);
        let mut team = RobotSet::default();
        for id in roles::assign(view, &mut free, &places, &self.defenders).into_iter().flatten() {
            team.insert(id);
        }
        team
    }
}

/// The keeper at its place; clears what lies in our area, and meets a shot on its line.
fn keeper(view: &View, at: Point<Attack>, why: Why) -> (Task, Why) {
    let (task, usual) =
        if view.phase == Phase::Run { defence::keeper(view) } else { (defence::keeper_line(view), why) };
    if matches!(usual, Why::ClearsArea { .. }) {
        return (task, usual);
    }
    if let Some(ball) = view.ball.filter(|ball| lies_before_our_area(view, ball)) {
        let (at, kick, room) = defence::clearance_outwards(view, &ball);
        return (Task::Kick { at, kick }, Why::ClearsArea { room });
    }
    match view.ball {
        Some(ball) if ball.velocity.norm() > COMES && comes_at_goal(view, ball.position, ball.velocity) => {
            (task, why)
        }
        Some(ball) => (Task::GoTo { at, face: at.direction_to(ball.position) }, why),
        None => (task, why),
    }
}

/// So near to our area that nobody but the keeper can be behind the ball, and slow enough to be kicked as it lies.
fn lies_before_our_area(view: &View, ball: &Ball) -> bool {
    let inside = ball.position.x() > view.our_goal().x();
    view.phase == Phase::Run
        && inside
        && ball.velocity.norm() < defence::LYING
        && view.in_our_area(ball.position, KEEPERS)
}

/// Outside our area, but nearer to it than this, the keeper clears the ball, m: a field player's centre is 0.11 m behind the ball it
/// kicks, 0.18 m when it lines up, and keeps 0.13 m off the area.
const KEEPERS: f32 = 0.3;
/// A ball that comes at our goal faster than this is met on its way, m/s: slower ones leave time to walk.
const COMES: f32 = 0.5;
