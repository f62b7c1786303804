//! `rated`: the actions of the robot that plays the ball, rated on one scale: P(goal for) − P(goal against)
//! within 10 s, each times its worth by score and time left ([`stakes`](super::stakes)). Attack frame, SI
//! units.
//!
//! An action that succeeds leaves the ball with us at a place, or in the goal; one that fails leaves it with
//! them where they stop it. [`value`](super::value) has the worth of both.

use std::fmt;

use geometry::{Attack, Point, Segment};
use protocol::RobotId;
use protocol::host::KickOrder;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

use super::case_candidate::{CaseStep, CastCase};
use super::clear::{self, Clearance, Release, clearance, given_away};
use super::pass::bridge::{RADIUS, refine};
use super::pass::shot::shot;
use super::pass::{Kicks, Offer, PassScene, PassSearch, Rating};
use super::view::{CaseNext, CasePass, ROBOTS_MAX, View};

/// An opponent this near the ball, m, disputes it, or presses its owner.
const CONTESTED_WITHIN_M: f32 = 0.25;
const PRESSED_WITHIN_M: f32 = 0.7;
const LOST_SHARE_CONTESTED: f32 = 0.4;
const LOST_SHARE_PRESSED: f32 = 0.2;
const LOST_SHARE_FREE: f32 = 0.0;
/// In our own half from this share of the way to our goal on the ball may be cleared.
const CLEARS_FROM: f32 = 0.4;
/// An action of the robot with the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// A shot at the goal.
    Shot {
        /// At this point of the goal line.
        at: Point<Attack>,
        /// P(goal) of the shot, 0–1.
        goal: f32,
    },
    /// A pass to a teammate.
    Pass {
        /// The teammate that receives it.
        receiver: RobotId,
        /// Place, kick and probabilities.
        rating: Rating,
    },
    /// The pass of the case that is played, near its place.
    OfCase {
        /// Pass that the case proposes.
        pass: CasePass,
        /// Place, kick and probabilities.
        rating: Rating,
        /// Distance from the case's own place, m.
        moved: f32,
    },
    /// The case that the robots would retrieve.
    Case(CastCase),
    /// Away from our goal, to where the ball is least likely to be theirs.
    Clear {
        /// Where it lands or rolls to, m.
        at: Point<Attack>,
        /// Kind and speed of the kick.
        kick: KickOrder,
    },
    /// Keeping the ball: by the case that is played, or by what the robots do without one.
    PlayOn,
}

impl Action {
    /// The receiver of its pass, and the pass's rating.
    pub fn pass(&self) -> Option<(RobotId, Rating)> {
        match *self {
            Self::Pass { receiver, rating } => Some((receiver, rating)),
            Self::OfCase { pass, rating, .. } => Some((pass.receiver.0, rating)),
            Self::Shot { .. } | Self::Case(_) | Self::Clear { .. } | Self::PlayOn => None,
        }
    }
}

/// An action with its worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rated {
    /// Action of the robot with the ball.
    pub action: Action,
    /// P(goal for) − P(goal against) within 10 s.
    pub worth: f32,
}

impl Rated {
    /// The same pass with kick and volley as they were `ordered`; its probabilities are of now.
    pub fn kicked_as(self, ordered: &Action) -> Self {
        let Some((_, before)) = ordered.pass() else { return self };
        let Self { mut action, worth } = self;
        if let Action::Pass { rating, .. } | Action::OfCase { rating, .. } = &mut action {
            (rating.kick, rating.shot, rating.ball_time) = (before.kick, before.shot, before.ball_time);
        }
        Self { action, worth }
    }
}

impl fmt::Display for Rated {
    /// `pass to 4: +0.121 (received with 0.83, then a goal with 0.14)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.action {
            Action::Shot { .. } => f.write_str("shot")?,
            Action::Pass { receiver, .. } => write!(f, "pass to {receiver}")?,
            Action::OfCase { pass, .. } => write!(f, "pass of case {} to {}", pass.case, pass.receiver.0)?,
            Action::Case(cast) => write!(f, "case {}", cast.case)?,
            Action::Clear { .. } => f.write_str("clear the ball")?,
            Action::PlayOn => f.write_str("keep the ball")?,
        }
        write!(f, ": {:+.3}", self.worth)?;
        match self.action {
            Action::Shot { goal, .. } => write!(f, " (a goal with {goal:.2})"),
            Action::Pass { rating, .. } | Action::OfCase { rating, .. } => {
                write!(f, " (received with {:.2}, then a goal with {:.2})", rating.receive(), rating.goal())
            }
            Action::Case(_) | Action::Clear { .. } | Action::PlayOn => Ok(()),
        }
    }
}

/// Proposals of cases to the robot that plays the ball.
#[derive(Clone, Copy, Debug, Default)]
pub struct OfCases {
    /// The next pass of the case that it plays.
    pub pass: Option<CasePass>,
    /// The case that it would play.
    pub retrieved: Option<CastCase>,
}

/// All actions, best first.
pub type RatedList = heapless::Vec<Rated, { ROBOTS_MAX + 5 }>;

/// Rates all actions of `who` for a ball at `from`.
pub fn rate(
    view: &View,
    passes: &mut PassSearch,
    who: RobotId,
    from: Point<Attack>,
    of_cases: OfCases,
) -> RatedList {
    let offers = passes.offers(view, from, who, true);
    let kicks = passes.kicks();
    let release = view.our(who).map(|robot| Release::of(view, kicks, robot, from));
    let in_time = |at, worth| release.map_or(worth, |release| release.worth(at, worth));
    let mut list = RatedList::new();
    let found = shot(view, kicks, from);
    let goal = found.value();
    // At a closed goal no shot is in the list: 3 of 41 scored.
    if found.angle > 0.0 {
        let worth = in_time(found.aim, shot_worth(view, from, found.aim, goal));
        add(&mut list, Action::Shot { at: found.aim, goal }, worth);
    }
    add(&mut list, Action::PlayOn, play_on(view, from));
    if from.x() < view.our_goal().x() * CLEARS_FROM
        && let Some(robot) = view.our(who)
        && let Some(Clearance { at, kick, worth }) = clearance(view, kicks, robot, from, |_| true)
    {
        add(&mut list, Action::Clear { at, kick }, worth);
    }
    for Offer { receiver, rating } in offers {
        let worth = in_time(rating.at, pass_worth(view, from, &rating));
        add(&mut list, Action::Pass { receiver, rating }, worth);
    }
    if let Some(pass) = of_cases.pass
        && let Some(receiver) = view.our(pass.receiver.0)
    {
        let scene = PassScene::of(view, kicks, from, Some(who), receiver).keeping();
        let refined = refine(&scene, pass.at, RADIUS);
        let (rating, moved) = (refined.best, refined.moved());
        let worth = in_time(rating.at, pass_worth(view, from, &rating));
        add(&mut list, Action::OfCase { pass, rating, moved }, worth);
    }
    if let Some(cast) = of_cases.retrieved
        && let Some(release) = release
        && let Some(worth) = step_worth(view, kicks, who, &release, &cast.step)
    {
        add(&mut list, Action::Case(cast), worth);
    }
    list
}

/// Inserts an action before the first that is worth less.
fn add(list: &mut RatedList, action: Action, worth: f32) {
    let place = list.iter().position(|other| other.worth < worth).unwrap_or(list.len());
    // A pass a robot, and four more.
    let _ = list.insert(place, Rated { action, worth });
}

/// An action that was chosen earlier, rated now for a ball at `from`; `None` where its receiver is gone.
pub fn rate_again(
    view: &View,
    kicks: &Kicks,
    who: RobotId,
    from: Point<Attack>,
    action: &Action,
) -> Option<Rated> {
    let release = Release::of(view, kicks, view.our(who)?, from);
    let again = |receiver: RobotId, at| {
        let scene = PassScene::of(view, kicks, from, Some(who), view.our(receiver)?).keeping();
        let rating = scene.rate(at);
        Some((rating, release.worth(at, pass_worth(view, from, &rating))))
    };
    let (action, worth) = match *action {
        Action::Shot { at, .. } => {
            let goal = shot(view, kicks, from).value();
            (Action::Shot { at, goal }, release.worth(at, shot_worth(view, from, at, goal)))
        }
        Action::Pass { receiver, rating } => {
            let (rating, worth) = again(receiver, rating.at)?;
            (Action::Pass { receiver, rating }, worth)
        }
        Action::OfCase { pass, rating, moved } => {
            let (rating, worth) = again(pass.receiver.0, rating.at)?;
            (Action::OfCase { pass, rating, moved }, worth)
        }
        Action::Clear { at, kick } => {
            (*action, clear::worth_again(view, kicks, view.our(who)?, from, (at, kick)))
        }
        Action::Case(cast) => (*action, step_worth(view, kicks, who, &release, &cast.step)?),
        Action::PlayOn => (*action, play_on(view, from)),
    };
    Some(Rated { action, worth })
}

/// What the next step of the case that is played is worth, if it is a kick of `who`.
pub fn next_worth(view: &View, kicks: &Kicks, who: RobotId, from: Point<Attack>) -> Option<f32> {
    let step = match view.proposal? {
        CaseNext::Pass(pass) if pass.passer.0 == who => {
            CaseStep::Pass { from, receiver: pass.receiver.0, at: pass.at }
        }
        CaseNext::Kick(robot) if robot == who => CaseStep::Shot { from },
        CaseNext::Pass(_) | CaseNext::Kick(_) => return None,
    };
    step_worth(view, kicks, who, &Release::of(view, kicks, view.our(who)?, from), &step)
}

/// A case is worth what its first step with the ball is worth, less what an opponent who is first at the ball
/// takes of it; `None` where its receiver is gone.
fn step_worth(
    view: &View,
    kicks: &Kicks,
    who: RobotId,
    release: &Release<'_>,
    step: &CaseStep,
) -> Option<f32> {
    let half = view.field.length * 0.5;
    Some(match *step {
        CaseStep::Pass { from, receiver, at } => {
            let scene = PassScene::of(view, kicks, from, Some(who), view.our(receiver)?).keeping();
            release.worth(at, pass_worth(view, from, &scene.rate(at)))
        }
        CaseStep::Shot { from } => {
            let found = shot(view, kicks, from);
            release.worth(found.aim, shot_worth(view, from, found.aim, found.value()))
        }
        // Either team may be first at it.
        CaseStep::Kick { to } => {
            release.worth(to, 0.5 * (view.stakes.of_ours(half, to) + view.stakes.of_theirs(half, to)))
        }
        CaseStep::Hold => play_on(view, release.from()),
    })
}

fn shot_worth(view: &View, from: Point<Attack>, aim: Point<Attack>, goal: f32) -> f32 {
    let half = view.field.length * 0.5;
    // The first robot in its path has it; else their keeper.
    let line = Segment::new(from, aim);
    let blocker = view
        .theirs
        .iter()
        .filter(|robot| line.distance_to(robot.position) < ROBOT_RADIUS + BALL_RADIUS)
        .map(|robot| robot.position)
        .min_by(|a, b| a.distance(from).total_cmp(&b.distance(from)));
    // One that misses is theirs at rest, as any restart: worth nothing to either, unless it was kicked in our
    // half: an aimless kick is their free kick where it was kicked.
    let missed = blocker.or((from.x() < 0.0).then_some(from));
    let lost = missed.map_or(0.0, |at| view.stakes.of_theirs(half, at)) - given_away(view, from);
    view.stakes.ours * goal + (1.0 - goal) * lost
}

fn pass_worth(view: &View, from: Point<Attack>, rating: &Rating) -> f32 {
    let half = view.field.length * 0.5;
    let along = (rating.at - from).unit().unwrap_or_default();
    let lost = rating.interceptor.map_or(rating.at, |found| from + along * found.along);
    // P(we have it) is true of passes that were chosen; rating all passes by it cost a fifth of the goals.
    let (receive, goal) = (rating.receive(), view.stakes.ours * rating.goal());
    let had = goal.max(view.stakes.of_ours(half, rating.at));
    receive * had + (1.0 - receive) * (view.stakes.of_theirs(half, lost) - given_away(view, from))
}

fn play_on(view: &View, from: Point<Attack>) -> f32 {
    let half = view.field.length * 0.5;
    // What is lost with a ball that is lost.
    let difference = view.stakes.of_ours(half, from) - view.stakes.of_theirs(half, from);
    view.stakes.of_ours(half, from) - lost(view, from) * difference.max(0.0)
}

/// Share of the balls at `from` that are lost beyond the mean of all moments with the ball.
fn lost(view: &View, from: Point<Attack>) -> f32 {
    let near = view.theirs_within(from);
    if near < CONTESTED_WITHIN_M {
        LOST_SHARE_CONTESTED
    } else if near < PRESSED_WITHIN_M {
        LOST_SHARE_PRESSED
    } else {
        LOST_SHARE_FREE
    }
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;
    use casebase::CaseRobot;
    use protocol::CaseId;
    use rules::League;

    const WALL: [(f32, f32); 4] = [(4.4, 0.0), (2.4, 0.0), (2.45, 0.2), (2.45, -0.2)];

    fn kicks() -> Kicks {
        Kicks::of(League::DivisionB)
    }

    /// Our 1 has the ball at (2, 0), our 2 stands at `teammate`.
    fn list(teammate: (f32, f32), theirs: &[(f32, f32)], case: Option<Point<Attack>>) -> RatedList {
        let view = view((2.0, 0.0), &[(-4.4, 0.0), (1.9, 0.0), teammate], theirs);
        let part = |part, robot: usize| (view.ours[robot].id, CaseRobot::new(part).unwrap());
        let pass = case.map(|at| CasePass { case: CaseId(1), passer: part(0, 1), receiver: part(1, 2), at });
        let from = Point::new(2.0, 0.0);
        let passes = &mut PassSearch::new(kicks(), 1);
        rate(&view, passes, view.ours[1].id, from, OfCases { pass, retrieved: None })
    }

    #[test]
    fn an_open_goal_is_shot_at_and_worth_more_than_keeping_the_ball() {
        let list = list((-2.0, 2.0), &[(4.4, 0.4)], None);
        assert!(matches!(list[0].action, Action::Shot { goal, .. } if goal > 0.1), "{list:?}");
        assert!(list.windows(2).all(|pair| pair[0].worth >= pair[1].worth), "best first");
    }

    #[test]
    fn a_closed_goal_is_not_shot_at_and_a_free_teammate_before_it_is_passed_to() {
        let list = list((3.0, 1.8), &WALL, None);
        assert!(list.iter().all(|rated| !matches!(rated.action, Action::Shot { .. })), "{list:?}");
        assert!(
            matches!(list[0].action, Action::Pass { receiver, .. } if receiver.number() == 2),
            "{list:?}"
        );
    }

    #[test]
    fn with_only_a_marked_teammate_far_behind_a_robot_plays_on() {
        let marked = [WALL[0], WALL[1], WALL[2], WALL[3], (-1.8, 2.0)];
        let list = list((-2.0, 2.0), &marked, None);
        assert_eq!(list[0].action, Action::PlayOn, "{list:?}");
        assert_eq!(list.len(), 2, "a pass is in the list with its worth: {list:?}");
    }

    #[test]
    fn a_shot_from_our_half_is_worth_less_than_clearing_the_ball() {
        let view = view((-3.2, 1.4), &[(-4.4, 0.0), (-3.3, 1.4), (-1.0, -1.0)], &[(4.4, 0.0), (-2.4, 1.6)]);
        let passes = &mut PassSearch::new(kicks(), 1);
        let list = rate(&view, passes, view.ours[1].id, Point::new(-3.2, 1.4), OfCases::default());
        let worth =
            |which: fn(&Action) -> bool| list.iter().find(|rated| which(&rated.action)).map(|r| r.worth);
        let clear = worth(|action| matches!(action, Action::Clear { .. })).unwrap();
        let shot = worth(|action| matches!(action, Action::Shot { .. }));
        assert!(shot.is_none_or(|shot| shot < clear), "{list:?}");
        assert!(!matches!(list[0].action, Action::Shot { .. }), "{list:?}");
    }

    #[test]
    fn the_pass_of_a_case_is_rated_as_any_other_to_that_place() {
        let at = Point::new(3.0, 1.6);
        let list = list((3.0, 1.8), &WALL, Some(at));
        let of_case = list.iter().find(|rated| matches!(rated.action, Action::OfCase { .. })).unwrap();
        let (receiver, rating) = of_case.action.pass().unwrap();
        assert!(receiver.number() == 2 && rating.at.distance(at) <= RADIUS);
        let view = view((2.0, 0.0), &[(-4.4, 0.0), (1.9, 0.0), (3.0, 1.8)], &WALL);
        let kicks = kicks();
        let scene = PassScene::of(&view, &kicks, Point::new(2.0, 0.0), Some(view.ours[1].id), &view.ours[2]);
        let same = pass_worth(&view, Point::new(2.0, 0.0), &scene.keeping().rate(rating.at));
        let release = Release::of(&view, &kicks, &view.ours[1], Point::new(2.0, 0.0));
        let same = release.worth(rating.at, same);
        assert!((same - of_case.worth).abs() < 1e-6, "{same} {}", of_case.worth);
    }

    #[test]
    fn a_case_is_worth_what_its_first_step_is_worth_in_the_list() {
        let seen = view((2.0, 0.0), &[(-4.4, 0.0), (1.9, 0.0), (3.0, 1.8)], &WALL);
        let (kicks, from, who) = (kicks(), Point::new(2.0, 0.0), seen.ours[1].id);
        let cast = |step| CastCase { case: CaseId(3), robots: [Some(who), None, None, None], step };
        let at = Point::new(3.0, 1.6);
        let release = Release::of(&seen, &kicks, &seen.ours[1], from);
        let worth = |step| step_worth(&seen, &kicks, who, &release, &step);
        let pass = CaseStep::Pass { from, receiver: seen.ours[2].id, at };
        let scene = PassScene::of(&seen, &kicks, from, Some(who), &seen.ours[2]).keeping();
        assert_eq!(worth(pass), Some(release.worth(at, pass_worth(&seen, from, &scene.rate(at)))));
        assert_eq!(worth(CaseStep::Hold), Some(play_on(&seen, from)));
        let found = shot(&seen, &kicks, from);
        let shot = release.worth(found.aim, shot_worth(&seen, from, found.aim, found.value()));
        assert_eq!(worth(CaseStep::Shot { from }), Some(shot));
        let gone = CaseStep::Pass { from, receiver: RobotId::new(9).unwrap(), at };
        assert_eq!(worth(gone), None, "its receiver is not there");
        let of_cases = OfCases { pass: None, retrieved: Some(cast(pass)) };
        let list = rate(&seen, &mut PassSearch::new(kicks.clone(), 1), who, from, of_cases);
        assert!(
            list.iter()
                .any(|rated| Some(rated.worth) == worth(pass) && matches!(rated.action, Action::Case(_))),
            "{list:?}"
        );
    }

    #[test]
    fn a_running_case_is_worth_its_next_kick_if_that_is_this_robots() {
        let seen = view((2.0, 0.0), &[(-4.4, 0.0), (1.9, 0.0), (3.0, 1.8)], &WALL);
        let (kicks, from) = (kicks(), Point::new(2.0, 0.0));
        let part = |part, robot: usize| (seen.ours[robot].id, CaseRobot::new(part).unwrap());
        let (passer, receiver, at) = (part(0, 1), part(1, 2), Point::new(3.0, 1.6));
        let pass = CaseNext::Pass(CasePass { case: CaseId(1), passer, receiver, at });
        let next = |next, who| next_worth(&seen.clone().proposing(next), &kicks, who, from);
        let listed = list((3.0, 1.8), &WALL, Some(at));
        let of_case =
            listed.iter().find(|rated| matches!(rated.action, Action::OfCase { .. })).unwrap().worth;
        let worth = next(Some(pass), passer.0).unwrap();
        assert!(worth <= of_case && worth > of_case - 0.1, "at its own place {worth}, refined {of_case}");
        assert_eq!(next(Some(pass), receiver.0), None, "the receiver's next kick is not known yet");
        let release = Release::of(&seen, &kicks, &seen.ours[1], from);
        let shot = step_worth(&seen, &kicks, passer.0, &release, &CaseStep::Shot { from });
        assert_eq!(next(Some(CaseNext::Kick(passer.0)), passer.0), shot);
        assert_eq!(next(None, passer.0), None);
    }

    #[test]
    fn a_case_whose_ball_an_opponent_reaches_first_is_worth_less() {
        let worth = |near: (f32, f32)| {
            let seen = view((2.0, 0.0), &[(-4.4, 0.0), (1.6, 0.0), (3.0, 1.8)], &[(4.4, 0.0), near]);
            let (kicks, from, who) = (kicks(), Point::new(2.0, 0.0), seen.ours[1].id);
            let step = CaseStep::Pass { from, receiver: seen.ours[2].id, at: Point::new(3.0, 1.6) };
            step_worth(&seen, &kicks, who, &Release::of(&seen, &kicks, &seen.ours[1], from), &step).unwrap()
        };
        let (first, later) = (worth((2.0, -0.2)), worth((2.0, -2.5)));
        assert!(first < 0.8 * later, "{first} {later}");
    }
}
