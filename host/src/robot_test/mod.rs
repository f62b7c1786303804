//! `robot_test`: one robot on the field for itself: its kicker is tested, or it is driven by hand.
//! In the test it kicks a resting ball again and again, at several speeds; the tracker sees how fast the ball
//! leaves, and the gain of the kicker is fitted. m, m/s.
//!
//! The operator begins and ends it ([`crate::Input::Test`]), so that a trace replays it. It gives orders in
//! open play alone, and in every other phase the coach does, so that the rules are kept: HALT and STOP hold
//! as in a match. While it lasts, and when it is over, all other robots of the team stand.

mod hand;
mod line;

use geometry::{Attack, Point, Vector};
use protocol::host::{HostCommand, KickOrder};
use protocol::{Instant, RobotId};
use rules::{Colour, Phase, RobotSpec};
use serde::{Deserialize, Serialize};

use self::hand::Hand;
use crate::learned::{Estimate, Kicks};
use crate::strategy::{Order, OrderReason, Orders, Role, Task, View};
use crate::world::World;

pub use hand::{HAND_EXPIRY, KICK_MIN_M_S, SPEED_MAX_M_S, TURN_MAX_RAD_S};

/// Fewest kicks of a test: of five, two may be spoiled.
const KICKS_LEAST: u8 = 5;
/// Most: as many as a fit keeps.
const KICKS_MOST: u8 = 15;
/// Speeds in turn, cm/s: as passes have them; with the greatest gain the least of them is still ordered
/// faster than 1.5 m/s, below which a kick is not told from a touch.
const SPEEDS_CM_S: [u16; 4] = [320, 260, 380, 440];
/// A ball faster than this was kicked, m/s: the weakest kicker gives 1.04, and a ball at the dribbler of a
/// robot that lines up moves slower.
const KICKED_SPEED_MIN_M_S: f32 = 0.9;
/// A ball slower than this is fetched, m/s.
const RESTING_SPEED_MAX_M_S: f32 = 0.3;
/// A ball that has moved less lies where it was, m: the robot pushes it while it lines up.
const SAME_PLACE_WITHIN_M: f32 = 0.4;

/// Request of the operator, as JSON in a trace and from the page.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum TestOrder {
    /// This robot kicks until so many kicks are measured; a running test is replaced.
    Kick {
        /// The robot's number.
        robot: u8,
        /// Kicks to measure, 5 to 15.
        kicks: u8,
    },
    /// This robot is driven by hand; the order holds for [`HAND_EXPIRY`], then the robot stands.
    Drive {
        /// The robot's number.
        robot: u8,
        /// Speeds of the body, ahead and to the left, m/s, and of its turn, rad/s, counter-clockwise.
        velocity: [f32; 3],
        /// It takes a ball before it, and carries it.
        dribbler: bool,
        /// It kicks a ball at its dribbler straight ahead, with this speed of the ball, m/s.
        kick: Option<f32>,
    },
    /// All robots stand in open play: another team tests on this field.
    Stand,
    /// The coach gives orders again.
    End,
}

/// Why a test does not begin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TestRefused {
    /// The line is no order.
    #[error("no test: {0}")]
    Malformed(String),
    /// A number that no robot has.
    #[error("{0} is no robot; ids are 0 to 15")]
    NoSuchRobot(u8),
    /// A number of kicks that is not measured.
    #[error("{0} kicks: a test measures {KICKS_LEAST} to {KICKS_MOST}")]
    Kicks(u8),
    /// A speed that is not driven.
    #[error("too fast by hand: at most {SPEED_MAX_M_S} m/s ahead and aside, and {TURN_MAX_RAD_S} rad/s")]
    Speed,
    /// A kick of a speed that no kicker has.
    #[error("a kick by hand: {KICK_MIN_M_S} to {} m/s", RobotSpec::OURS.kicker.fastest)]
    KickSpeed,
    /// A strategy in another program gives the orders.
    #[error("a strategy in another program gives the orders: end it first")]
    External,
}

impl TestOrder {
    /// From JSON, within what a test can do.
    pub fn from_json(json: &[u8]) -> Result<Self, TestRefused> {
        let order =
            serde_json::from_slice(json).map_err(|error| TestRefused::Malformed(error.to_string()))?;
        match order {
            Self::Kick { robot, .. } | Self::Drive { robot, .. } if RobotId::new(robot).is_none() => {
                Err(TestRefused::NoSuchRobot(robot))
            }
            Self::Drive { velocity, kick, .. } => hand::check(velocity, kick).map(|()| order),
            Self::Kick { kicks, .. } if !(KICKS_LEAST..=KICKS_MOST).contains(&kicks) => {
                Err(TestRefused::Kicks(kicks))
            }
            order => Ok(order),
        }
    }

    /// JSON of the order, for a trace.
    pub fn to_json(self) -> String {
        // Numbers and words: JSON can represent all of it.
        serde_json::to_string(&self).unwrap_or_default()
    }
}

/// State of a kicker's test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestState {
    /// The referee has not let the game run.
    WaitsForGame,
    /// The robot is not on the field, or does not answer.
    NoRobot,
    /// The ball's place is unknown.
    NoBall,
    /// The ball rolls after a kick.
    Rolls,
    /// The ball lies outside the field or in a defence area, where the robot may not fetch it: bring it back.
    OutOfReach,
    /// The robot goes to the ball and kicks it.
    Kicks,
    /// All kicks are measured.
    Done,
}

/// Findings of a kicker's test so far.
#[derive(Clone, Debug, PartialEq)]
pub struct KickReport {
    /// Robot whose kicker is tested.
    pub robot: RobotId,
    /// Number of kicks to measure.
    pub wanted: u8,
    /// Each measured kick: speed ordered of the kicker, and speed of the ball as it left, m/s.
    pub kicks: Vec<[f32; 2]>,
    /// The gain that fits them: speed of the ball over speed ordered; from the third kick on.
    pub gain: Option<Estimate>,
    /// Progress of the test.
    pub state: TestState,
}

/// A test that runs, or has come to its end.
#[derive(Clone, Debug)]
pub(crate) struct RobotTest {
    /// The robot that kicks and the number of its kicks; none: all stand.
    kicker: Option<(RobotId, u8)>,
    /// The robot that is driven by hand.
    hand: Option<Hand>,
    fit: Kicks,
    kicks: Vec<[f32; 2]>,
    /// Kicks that were seen, measured or not.
    tried: usize,
    /// The last kick still rolls.
    rolls: bool,
    /// Place of the ball when the target was chosen, and the target.
    target: Option<[Point<Attack>; 2]>,
    state: TestState,
}

impl RobotTest {
    /// The test that is ordered; none: an end.
    pub(crate) fn of(order: TestOrder, now: Instant) -> Option<Self> {
        let kicker = match order {
            TestOrder::Kick { robot, kicks } => Some((RobotId::new(robot)?, kicks)),
            TestOrder::Drive { .. } | TestOrder::Stand => None,
            TestOrder::End => return None,
        };
        let hand = Hand::of(order, now);
        let (fit, kicks, state) = (Kicks::default(), Vec::new(), TestState::WaitsForGame);
        Some(Self { kicker, hand, fit, kicks, tried: 0, rolls: false, target: None, state })
    }

    /// Findings so far; none: all stand.
    pub(crate) fn report(&self) -> Option<KickReport> {
        let (robot, wanted) = self.kicker?;
        let (kicks, gain) = (self.kicks.clone(), self.fit.estimate(robot));
        Some(KickReport { robot, wanted, kicks, gain, state: self.state })
    }

    /// The robot that is driven by hand.
    pub(crate) fn driven(&self) -> Option<RobotId> {
        self.hand.as_ref().map(|hand| hand.robot)
    }

    /// When the order of a hand ends, while it has not.
    pub(crate) fn until(&self) -> Option<Instant> {
        self.hand.as_ref()?.until()
    }

    /// Ends the order of a hand that is too old; true where it has ended now.
    pub(crate) fn expire(&mut self, now: Instant) -> bool {
        self.hand.as_mut().is_some_and(|hand| hand.expire(now))
    }

    /// The orders to be sent now in place of those `by_coach`.
    pub(crate) fn plan(&mut self, view: &View, by_coach: Orders) -> Orders {
        let (alone, task, why) = match &self.hand {
            Some(hand) => (Some(hand.robot), hand.task(view), OrderReason::ByHand),
            None => (self.kicker.map(|(robot, _)| robot), self.kick(view), OrderReason::Test),
        };
        if view.phase != Phase::Run {
            return by_coach;
        }
        let orders = view.ours.iter().map(|robot| {
            let role = if robot.id == view.keeper { Role::Keeper } else { Role::Player };
            let task = task.filter(|_| alone == Some(robot.id)).unwrap_or(Task::Stand);
            Order { robot: robot.id, role, task, why }
        });
        orders.collect()
    }

    /// Task of the kicker; updates the test's state.
    fn kick(&mut self, view: &View) -> Option<Task> {
        let (robot, wanted) = self.kicker?;
        self.look(view);
        let (state, task) = if self.kicks.len() >= usize::from(wanted) {
            (TestState::Done, None)
        } else if view.phase != Phase::Run {
            (TestState::WaitsForGame, None)
        } else if view.our(robot).is_none() {
            (TestState::NoRobot, None)
        } else if self.rolls {
            (TestState::Rolls, None)
        } else {
            match view.ball {
                None => (TestState::NoBall, None),
                // All stand while a person goes for the ball.
                Some(ball) if is_out_of_reach(view, ball.position) => (TestState::OutOfReach, None),
                Some(ball) => {
                    let at = self.target_from(view, robot, ball.position);
                    let kick = KickOrder::Flat(SPEEDS_CM_S[self.tried % SPEEDS_CM_S.len()]);
                    (TestState::Kicks, Some(Task::Kick { at, kick }))
                }
            }
        };
        self.state = state;
        task
    }

    /// Whether the last kick still rolls.
    fn look(&mut self, view: &View) {
        let Some(ball) = view.ball else { return };
        let speed = ball.velocity.norm();
        if !self.rolls && speed > KICKED_SPEED_MIN_M_S {
            (self.rolls, self.target) = (true, None);
            self.tried += 1;
        }
        self.rolls &= speed > RESTING_SPEED_MAX_M_S;
    }

    /// The same target until the ball lies elsewhere.
    fn target_from(&mut self, view: &View, robot: RobotId, ball: Point<Attack>) -> Point<Attack> {
        if let Some([from, to]) = self.target
            && from.distance(ball) < SAME_PLACE_WITHIN_M
        {
            return to;
        }
        let to = line::longest(view, robot, ball);
        self.target = Some([ball, to]);
        to
    }

    /// A snapshot at the newest camera frame, and the orders that go out because of it.
    pub(crate) fn see(&mut self, now: Instant, world: &World, us: Colour, commands: &[HostCommand]) {
        let Some((robot, wanted)) = self.kicker else { return };
        self.fit.see(now, world, us, commands);
        if let Some((kicker, kick)) = self.fit.take_newest()
            && kicker == robot
            && self.kicks.len() < usize::from(wanted)
        {
            self.kicks.push(kick);
        }
    }
}

/// Whether the ball lies outside the field or in a defence area.
fn is_out_of_reach(view: &View, ball: Point<Attack>) -> bool {
    let outside = ball.x().abs() > view.field.length * 0.5 || ball.y().abs() > view.field.width * 0.5;
    outside || view.in_our_area(ball, 0.0) || view.in_their_area(ball, 0.0)
}

/// A step from a place by a distance in a direction.
fn step(from: Point<Attack>, along: Vector<Attack>, distance: f32) -> Point<Attack> {
    from + along * distance
}

#[cfg(test)]
mod tests;
