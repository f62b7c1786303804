//! `rated`: the actions of the robot that plays the ball, rated on one scale: P(goal for) − P(goal against)
//! within 10 s. Attack frame, SI units.
//!
//! An action that succeeds leaves the ball with us at a place, or in the goal; one that fails leaves it with
//! them where they stop it. [`value`] has the worth of both.

use geometry::{Attack, Point, Segment};
use protocol::RobotId;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

use super::pass::shot::shot;
use super::pass::{Kicks, PassScene, Rating, SAMPLES, Searches};
use super::value;
use super::view::{ROBOTS_MAX, View};

/// An action of the robot with the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// A shot.
    Shot {
        /// At this point of the goal line.
        at: Point<Attack>,
        /// P(goal).
        goal: f32,
    },
    /// A pass.
    Pass {
        /// The teammate that receives it.
        receiver: RobotId,
        /// Place, kick and probabilities.
        rating: Rating,
    },
    /// To keep the ball: by a case, or by what the robots do without one.
    PlayOn,
}

/// An action with its worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rated {
    /// The action.
    pub action: Action,
    /// P(goal for) − P(goal against) within 10 s.
    pub worth: f32,
}

/// All actions, best first.
pub type RatedList = heapless::Vec<Rated, { ROBOTS_MAX + 2 }>;

/// Rates all actions of `who` for a ball at `from`; a teammate of which `receives` is not true gets no pass.
pub fn rate(
    view: &View,
    kicks: &Kicks,
    searches: &mut Searches,
    who: RobotId,
    from: Point<Attack>,
    receives: impl Fn(RobotId) -> bool,
) -> RatedList {
    let mut list = RatedList::new();
    let mut add = |action, worth| {
        let place = list.iter().position(|other: &Rated| other.worth < worth).unwrap_or(list.len());
        // A pass a robot, and two more.
        let _ = list.insert(place, Rated { action, worth });
    };
    let found = shot(view, kicks, from);
    let goal = found.value();
    add(Action::Shot { at: found.aim, goal }, shot_worth(view, from, found.aim, goal));
    add(Action::PlayOn, play_on(view, from));
    for offer in searches.offers(view, kicks, from, who, SAMPLES, true) {
        if receives(offer.receiver) {
            let (receiver, rating) = (offer.receiver, offer.rating);
            add(Action::Pass { receiver, rating }, pass_worth(view, from, &rating));
        }
    }
    list
}

/// The worth now of an action that was chosen earlier; `None` where its receiver is gone.
pub fn rate_again(
    view: &View,
    kicks: &Kicks,
    who: RobotId,
    from: Point<Attack>,
    action: &Action,
) -> Option<f32> {
    Some(match action {
        Action::Shot { at, .. } => {
            let goal = shot(view, kicks, from).value();
            shot_worth(view, from, *at, goal)
        }
        Action::Pass { receiver, rating } => {
            let receiver = view.our(*receiver)?;
            let scene = PassScene::of(view, kicks, from, Some(who), receiver).keeping();
            pass_worth(view, from, &scene.rate(rating.at))
        }
        Action::PlayOn => play_on(view, from),
    })
}

fn shot_worth(view: &View, from: Point<Attack>, aim: Point<Attack>, goal: f32) -> f32 {
    let half = view.field.length * 0.5;
    // Whom it hits has it; else their keeper.
    let line = Segment::new(from, aim);
    let blocker = view
        .theirs
        .iter()
        .filter(|robot| line.distance_to(robot.position) < ROBOT_RADIUS + BALL_RADIUS)
        .map(|robot| robot.position)
        .min_by(|a, b| a.distance(from).total_cmp(&b.distance(from)));
    goal + (1.0 - goal) * value::of_theirs(half, blocker.unwrap_or(aim))
}

fn pass_worth(view: &View, from: Point<Attack>, rating: &Rating) -> f32 {
    let half = view.field.length * 0.5;
    let along = (rating.at - from).unit().unwrap_or_default();
    let lost = rating.interceptor.map_or(rating.at, |found| from + along * found.along);
    let (receive, goal) = (rating.receive(), rating.goal());
    let had = goal.max(value::of_ours(half, rating.at));
    receive * had + (1.0 - receive) * value::of_theirs(half, lost)
}

fn play_on(view: &View, from: Point<Attack>) -> f32 {
    let half = view.field.length * 0.5;
    let near = view.nearest_theirs(from).map_or(f32::INFINITY, |(_, distance)| distance);
    // What is lost with a ball that is lost.
    let difference = value::of_ours(half, from) - value::of_theirs(half, from);
    let lost = if near < CONTESTED {
        LOST_CONTESTED
    } else if near < PRESSED {
        LOST_PRESSED
    } else {
        LOST_FREE
    };
    value::of_ours(half, from) - lost * difference.max(0.0)
}

/// An opponent this near the ball, m, disputes it, or presses its owner.
const CONTESTED: f32 = 0.25;
const PRESSED: f32 = 0.7;
/// Shares of the balls that are lost beyond the mean of all moments with the ball.
const LOST_CONTESTED: f32 = 0.4;
const LOST_PRESSED: f32 = 0.2;
const LOST_FREE: f32 = 0.0;
