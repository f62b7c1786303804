//! `planner`: our planners as building blocks: who reaches the ball, what a shot and a pass are worth (Biswas
//! et al. 2014 §3.1). Attack frame, m, s.

use geometry::{Attack, Point, Vector};
use host::external::{Pair, StrategyBall, StrategyRobot, StrategyTask, StrategyView};
use host::strategy::pass::{Kicks, Offer, PassSearch, shot};
use protocol::RobotId;
use rules::League;

/// A robot's length, m.
const STAYS: f32 = 0.18;
/// Seed of the searches: the same moments give the same places.
const SEED: u64 = 1;
const LEAGUES: [League; 3] = [League::DivisionB, League::DivisionA, League::Ssl2013];

/// A shot that could be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotOffer {
    /// At this point of the goal line.
    pub at: Pair,
    /// The open angle around it, rad.
    pub open: f32,
    /// Probability of a goal, 0–1.
    pub goal: f32,
}

/// A pass that could be played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassOffer {
    /// Number of the receiving teammate.
    pub receiver: u8,
    /// Place of the reception, attack frame, m.
    pub at: Pair,
    /// Speed of the kick, m/s.
    pub speed: f32,
    /// Whether the pass flies.
    pub chip: bool,
    /// Probability that the receiver gets the ball, 0–1.
    pub receive: f32,
    /// P(goal | receive), 0–1.
    pub goal: f32,
    /// Where the receiver shoots.
    pub shot_at: Pair,
}

impl PassOffer {
    /// Task of the passer for this offer.
    pub fn task(&self) -> StrategyTask {
        let Self { at, receiver, speed, chip, .. } = *self;
        StrategyTask::Pass { at, receiver, speed, chip, ready: true }
    }
}

/// Our planners, with what they keep between moments.
#[derive(Debug)]
pub struct Planner {
    league: League,
    passes: PassSearch,
}

impl Default for Planner {
    fn default() -> Self {
        Self::of(League::DivisionB)
    }
}

impl Planner {
    fn of(league: League) -> Self {
        Self { league, passes: PassSearch::new(Kicks::of(league), SEED) }
    }

    /// The league of the view, where it is another than before.
    fn follow(&mut self, view: &StrategyView) {
        let named = LEAGUES.into_iter().find(|league| league.name() == view.league);
        if let Some(league) = named.filter(|league| *league != self.league) {
            *self = Self::of(league);
        }
    }

    /// The field player of ours that touches the ball first, by its distance from where the ball will be. The
    /// one that `had` it stays unless another is nearer by a robot's length: robots that change places at the
    /// ball lose it.
    pub fn nearest_to_ball(&self, view: &StrategyView, had: Option<u8>) -> Option<u8> {
        let ball = view.ball?;
        let distance = |robot: &StrategyRobot| {
            let stays = if Some(robot.robot) == had { STAYS } else { 0.0 };
            distance_from_path(robot.at, &ball) - stays
        };
        let may = |robot: &&StrategyRobot| robot.robot != view.keeper && !view.bound.contains(&robot.robot);
        let players = view.ours.iter().filter(may);
        let nearest = players.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map(|robot| robot.robot)
    }

    /// The best shot from `from`.
    pub fn shot(&mut self, view: &StrategyView, from: Pair) -> ShotOffer {
        self.follow(view);
        let snapshot = view.snapshot(self.league.field());
        let shot = shot::shot(&snapshot, self.passes.kicks(), Point::new(from[0], from[1]));
        ShotOffer { at: [shot.aim.x(), shot.aim.y()], open: shot.angle, goal: shot.value() }
    }

    /// The passes from the ball to each teammate, best first.
    pub fn passes(&mut self, view: &StrategyView, passer: u8) -> Vec<PassOffer> {
        self.follow(view);
        let (Some(ball), Some(passer)) = (view.ball, RobotId::new(passer)) else { return Vec::new() };
        let from = Point::<Attack>::new(ball.at[0], ball.at[1]);
        let snapshot = view.snapshot(self.league.field());
        self.passes.offers(&snapshot, from, passer, false).iter().map(PassOffer::from).collect()
    }
}

impl From<&Offer> for PassOffer {
    fn from(Offer { receiver, rating }: &Offer) -> Self {
        Self {
            receiver: receiver.number(),
            at: [rating.at.x(), rating.at.y()],
            speed: rating.kick.speed(),
            chip: rating.kick.is_chip(),
            receive: rating.receive(),
            goal: rating.goal(),
            shot_at: [rating.shot.aim.x(), rating.shot.aim.y()],
        }
    }
}

/// Distance of a place from the way that the ball will roll, m.
fn distance_from_path(at: Pair, ball: &StrategyBall) -> f32 {
    let [from, to, at] = [ball.at, ball.rest, at].map(|[x, y]| Point::<Attack>::new(x, y));
    let way: Vector<Attack> = to - from;
    let along = if way.dot(way) > 0.0 { ((at - from).dot(way) / way.dot(way)).clamp(0.0, 1.0) } else { 0.0 };
    at.distance(from + way * along)
}
