//! `assistant`: manual acts at a field whose game controller runs elsewhere: place the ball where no robot
//! can or may, take robots off and return them. m, m/s, field frame; times of the simulation, µs.
//!
//! Rules 2026, chapters on ball placement, robot substitution and cards. Each act has its reason with it.

use core::fmt;

use geometry::{Field, Point};
use protocol::{Duration, Instant, Who};
use rules::restart::{nearest_free_kick_spot, placement_needless};
use rules::{Colour, Phase, limits};
use ssl::event::GameEventType;

use super::super::event::Restart;
use super::super::field_staff::WorldOrder;
use super::super::flow::is_reachable;
use super::{RemoteMatch, places};
use crate::small_size::{Robot, World};

/// Reason of a manual act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssistantReason {
    /// The ball is placed by hand for this kick-off or penalty.
    SetByHand(Restart),
    /// No team may place the ball, or both have failed.
    NoTeamPlaces,
    /// Robots cannot reach the ball: it is in or behind a goal, in a corner of the field surface, or outside
    /// the walls.
    OutOfReach,
    /// The ball lies at a position from which the controller does not continue, and nothing else happens.
    NothingHappens,
    /// The team has more robots than allowed, and this one has left the field for it.
    HasLeft,
    /// The team has more robots than allowed, for longer than the time for taking one off.
    TooMany,
    /// The game is halted for the team to substitute a robot.
    Substituted,
    /// The team may have one robot more again.
    MayComeBack,
}

/// A manual act with its reason.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deed {
    /// The act, as the simulator carries it out.
    pub order: WorldOrder,
    /// The reason that the rules give for it.
    pub why: AssistantReason,
}

/// Decides the manual acts at the field.
#[derive(Clone, Debug, Default)]
pub struct Assistant {
    commands: u64,
    /// Reason for placing the ball, and since when it holds.
    ball: Option<(AssistantReason, Instant)>,
    /// Number of manual placements since the last command, and the time of the last.
    puts: u32,
    put_at: Option<Instant>,
    /// Both teams, in the order of [`Colour::ALL`].
    teams: [Team; 2],
}

#[derive(Clone, Debug, Default)]
struct Team {
    /// Since when there are too many robots on the field.
    crowded: Option<Instant>,
    /// Time at which a robot was last taken off or returned.
    changed: Option<Instant>,
    /// Robots taken off, in this order.
    off: Vec<Who>,
    /// True once a robot was taken off in this substitution.
    substituted: bool,
}

impl Assistant {
    /// The acts due now, in this order; to be called about every 10 ms. The caller carries out the orders.
    pub fn look(&mut self, game: &RemoteMatch, world: &World) -> Vec<Deed> {
        let now = game.now;
        if game.is_silent(now) {
            return Vec::new();
        }
        if self.commands != game.commands {
            self.commands = game.commands;
            (self.puts, self.put_at, self.ball) = (0, None, None);
        }
        let mut deeds: Vec<Deed> = self.put_ball(game, world).into_iter().collect();
        for (index, colour) in Colour::ALL.into_iter().enumerate() {
            deeds.extend(self.teams[index].look(game, world, colour));
        }
        deeds
    }

    fn put_ball(&mut self, game: &RemoteMatch, world: &World) -> Option<Deed> {
        let now = game.now;
        let Some((why, target)) = wanted(game, world) else {
            self.ball = None;
            return None;
        };
        let since = self.ball.filter(|(before, _)| *before == why).map_or(now, |(_, since)| since);
        self.ball = Some((why, since));
        let waited = now.since(self.put_at.map_or(since, |put| put.max(since)));
        let delay = if why == AssistantReason::NothingHappens { CONTROLLER_PATIENCE } else { PERSON_DELAY };
        let near = limits::ROBOT_RADIUS + PLACEMENT_ROOM;
        let mut present = world.robots().iter().filter(|robot| robot.present);
        let room = present.all(|robot| robot.pose.position.distance(target) >= near);
        if waited < delay || !room && waited < delay + CONTROLLER_PATIENCE || self.puts >= PUTS_MAX {
            return None;
        }
        self.puts += 1;
        self.put_at = Some(now);
        self.ball = None;
        Some(Deed { order: WorldOrder::PutBall(target), why })
    }
}

impl Team {
    fn look(&mut self, game: &RemoteMatch, world: &World, colour: Colour) -> Option<Deed> {
        let (now, own) = (game.now, game.own_end(colour));
        let (field, ball) = (&game.field, world.ball.position);
        let counts = |robot: &&Robot| robot.present && !robot.bystander && robot.who.colour == colour;
        let ours = || world.robots().iter().filter(counts);
        let behind = |robot: &&Robot| !field.counts(own, robot.pose.position);
        let here = ours().count() as u32;
        let on_field = ours().filter(|robot| !behind(robot)).count() as u32;
        let allowed = game.allowed(colour)?;
        if on_field <= allowed {
            self.crowded = None;
        } else {
            self.crowded.get_or_insert(now);
        }
        if !game.substitutes(colour) {
            self.substituted = false;
        }
        if self.changed.is_some_and(|at| now.since(at) < CHANGE_TIME) {
            return None;
        }
        let halted = matches!(game.phase(), Phase::Halt | Phase::Timeout(_));
        let stopped = halted || game.phase() == Phase::Stop;
        let may_be_taken = |robot: &&Robot| {
            let p = robot.pose.position;
            (behind(robot) || places::beside_halfway_line(field, p))
                && p.distance(ball) >= limits::SUBSTITUTION_BALL_DISTANCE
                && robot.velocity.norm() <= STANDING_SPEED_MAX
        };
        let left = ours().filter(may_be_taken).max_by_key(|robot| (behind(robot), robot.who));
        let crowded_for = self.crowded.map_or(Duration(0), |since| now.since(since));
        let taken = if game.substitutes(colour) && halted && !self.substituted {
            let any = || whom_to_take(game, ours(), ball);
            left.or_else(any).map(|robot| (robot.who, AssistantReason::Substituted))
        } else if here > allowed && left.is_some() {
            left.map(|robot| (robot.who, AssistantReason::HasLeft))
        } else if stopped && crowded_for.as_secs_f32() >= limits::CARD_REMOVAL_TIME {
            whom_to_take(game, ours(), ball).map(|robot| (robot.who, AssistantReason::TooMany))
        } else {
            None
        };
        if let Some((who, why)) = taken {
            self.changed = Some(now);
            self.substituted |= why == AssistantReason::Substituted;
            self.off.push(who);
            return Some(Deed { order: WorldOrder::RemoveRobot(who), why });
        }
        // Robots that were returned otherwise are no longer in this list.
        self.off.retain(|who| world.robot(*who).is_some_and(|robot| !robot.present));
        if here >= allowed {
            return None;
        }
        let others: Vec<_> =
            world.robots().iter().filter(|robot| robot.present).map(|robot| robot.pose.position).collect();
        let pose = places::way_in(field, own, ball, &others)?;
        let who = *self.off.first()?;
        self.off.remove(0);
        self.changed = Some(now);
        Some(Deed { order: WorldOrder::ReturnRobot(who, pose), why: AssistantReason::MayComeBack })
    }
}

/// The position where the ball has to be placed by hand now, if any.
fn wanted(game: &RemoteMatch, world: &World) -> Option<(AssistantReason, Point<Field>)> {
    let (ball, speed) = (world.ball.position, world.ball.velocity.norm());
    let still = speed <= limits::BALL_STILL && world.ball.height <= 0.0;
    let set = match game.phase() {
        Phase::BallPlacement(_) => {
            let lost = still && !is_reachable(&game.field, ball);
            return lost.then(|| (AssistantReason::OutOfReach, places::within_reach(&game.field, ball)));
        }
        // Robots stand around it now: only a ball from which the controller does not start is moved.
        Phase::PrepareKickoff(team) => Some((Restart::Kickoff(team), game.field.center_radius)),
        Phase::PreparePenalty(team) => Some((Restart::Penalty(team), limits::PLACEMENT_TOLERANCE)),
        _ => None,
    };
    if let Some((restart, tolerance)) = set {
        let mark = game.mark(restart).filter(|mark| ball.distance(*mark) > tolerance)?;
        return Some((AssistantReason::SetByHand(restart), mark));
    }
    let stopped = matches!(game.phase(), Phase::Stop);
    if !stopped && game.phase() != Phase::Halt || game.stage().is_break() {
        return None;
    }
    // The ball stays where it lies until the goal is decided, as evidence.
    let open = game.has_event(GameEventType::PossibleGoal) && !game.has_event(GameEventType::Goal);
    let spot = || stopped.then(|| nearest_free_kick_spot(&game.field, &game.limits, ball));
    let target = game.target().or_else(spot).filter(|_| !open || stopped)?;
    let lies = |tolerance: f32| still && ball.distance(target) <= tolerance;
    match game.next() {
        Some(next) if next.is_set_by_hand() => {
            (!lies(MARK_TOLERANCE)).then_some((AssistantReason::SetByHand(next), target))
        }
        _ if !stopped || placement_needless(&game.field, ball, speed, target) => None,
        _ if game.has_event(GameEventType::PlacementSucceeded) && lies(limits::PLACEMENT_TOLERANCE) => None,
        _ if game.placing_team().is_none() => Some((AssistantReason::NoTeamPlaces, target)),
        _ => Some((AssistantReason::NothingHappens, target)),
    }
}

/// A robot that lies on its side; else the one farthest from the ball. The keeper only where there is no
/// other robot.
fn whom_to_take<'a>(
    game: &RemoteMatch,
    ours: impl Iterator<Item = &'a Robot>,
    ball: Point<Field>,
) -> Option<&'a Robot> {
    let worth = |robot: &Robot| (robot.tipped, !game.accounts.is_keeper(robot.who));
    let distance = |robot: &Robot| robot.pose.position.distance(ball);
    ours.max_by(|a, b| {
        let by_worth = worth(a).cmp(&worth(b)).then(distance(a).total_cmp(&distance(b)));
        by_worth.then(b.who.cmp(&a.who))
    })
}

impl fmt::Display for AssistantReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SetByHand(Restart::Penalty(by)) => write!(f, "for {}'s penalty", by.label()),
            Self::SetByHand(Restart::Kickoff(by)) => write!(f, "for {}'s kick-off", by.label()),
            Self::SetByHand(_) => write!(f, "for the restart"),
            Self::NoTeamPlaces => write!(f, "no team may place it, or both have failed"),
            Self::OutOfReach => write!(f, "it was where no robot can reach it"),
            Self::NothingHappens => {
                write!(f, "the controller does not go on from where it was, and no team placed it")
            }
            Self::HasLeft => write!(f, "the team has too many robots, and this one has left the field"),
            Self::TooMany => {
                write!(f, "the team has had too many robots for {} s", limits::CARD_REMOVAL_TIME)
            }
            Self::Substituted => write!(f, "the game is halted for the team to substitute a robot"),
            Self::MayComeBack => write!(f, "the team may have another robot"),
        }
    }
}

impl fmt::Display for Deed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |who: Who| format!("{} {}", who.colour.label(), who.id.number());
        match self.order {
            WorldOrder::PutBall(at) => write!(f, "puts the ball at ({:.2}, {:.2}) m", at.x(), at.y())?,
            WorldOrder::RemoveRobot(who) => write!(f, "takes {} off", name(who))?,
            WorldOrder::ReturnRobot(who, pose) => {
                let at = pose.position;
                write!(f, "puts {} in at ({:.2}, {:.2}) m", name(who), at.x(), at.y())?;
            }
            WorldOrder::CarryRobot(who, pose) => {
                let at = pose.position;
                write!(f, "carries {} to ({:.2}, {:.2}) m", name(who), at.x(), at.y())?;
            }
        }
        write!(f, ": {}", self.why)
    }
}

/// Delay before a manual act, estimated: the internal referee's is the same.
const PERSON_DELAY: Duration = Duration::millis(2_000);
/// Further wait for robots to make room, and for a game that does not continue by itself: the controller's
/// time for preparation.
const CONTROLLER_PATIENCE: Duration = Duration::millis(10_000);
/// Time for taking off or returning a robot: the controller's tolerance in counting robots.
const CHANGE_TIME: Duration = Duration::millis(2_000);
/// Minimum distance from a robot's side, m, for placing the ball by hand: a hand's breadth.
const PLACEMENT_ROOM: f32 = 0.1;
/// Maximum distance of a ball placed by hand from its mark, m: a third of what the controller tolerates.
const MARK_TOLERANCE: f32 = 0.05;
/// Maximum number of manual placements after one command; more would hide another fault.
const PUTS_MAX: u32 = 5;
/// Speed below which a robot is ready to be taken off, m/s: it may still turn, or be pushed a little.
const STANDING_SPEED_MAX: f32 = 0.2;
