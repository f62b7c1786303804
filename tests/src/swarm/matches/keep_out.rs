//! `keep_out`: how long each robot is at a forbidden position, by the true positions. ms, m, field frame.
//!
//! Regions are those of `rules::keep_out`. Which robot a team has chosen for its kick is not known here: one
//! robot per team may be where only the kicker may be, and every further one violates the rule.

use std::collections::BTreeMap;

use geometry::{Field, GoalEnd, Point};
use protocol::Who;
use rules::keep_out::{Forbidden, KeepOutReason, Situation, keep_out};
use rules::{Colour, FieldSpec, Phase, RuleRole, Side, limits};

/// Grace before being in a region counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grace {
    /// This time, s, after the last change: of phase, keeper, or the ball's position by hand.
    AfterChange(f32),
    /// This time, s, in the region without interruption.
    AtATime(f32),
}

/// The rules' grace for that region in that phase; `None` where being there is no offence.
pub fn grace(why: KeepOutReason, phase: Phase<Side>) -> Option<Grace> {
    if !why.offends(phase) {
        return None;
    }
    Some(match (why, phase) {
        // Offenses, ball placement interference: "for more than 2 seconds".
        (KeepOutReason::Stadium, _) => Grace::AtATime(limits::GRACE),
        // Preparations are for taking positions: the controller's time for them.
        (
            KeepOutReason::OtherHalf | KeepOutReason::CentreCircle | KeepOutReason::BallDistance,
            Phase::PrepareKickoff(_),
        )
        | (KeepOutReason::BehindBall | KeepOutReason::KeeperLine, Phase::PreparePenalty(_)) => {
            Grace::AfterChange(limits::PREPARE_TIME)
        }
        // Offenses, attacker too close to defence area; referee commands, stop: 2 s to slow down and leave.
        (KeepOutReason::OpponentArea, _) | (KeepOutReason::BallDistance, Phase::Stop) => {
            Grace::AfterChange(limits::GRACE)
        }
        // Being in the own area is no offence before the ball is touched: the time to leave it at the speed
        // of STOP, ours.
        (KeepOutReason::OwnArea, _) => Grace::AfterChange(LEAVE_OWN_AREA),
        _ => Grace::AfterChange(0.0),
    })
}

/// Time to leave division A's area at 1.5 m/s, 1.8 m and the robot's radius, from standstill, and as much
/// again around teammates, s.
const LEAVE_OWN_AREA: f32 = 4.0;
/// Maximum time of any robot beyond its grace, s (required bound).
pub const BOUND: f32 = 0.5;
/// Distance from a region's border within which robots are not in it, m: a camera's noise on a robot that
/// touches the border.
const TOLERANCE: f32 = 0.005;
/// Speed of a freely rolling ball above which robots cannot leave it at once (referee commands, stop, note),
/// m/s.
const BALL_QUICK: f32 = 0.5;

/// The state of the match that the check uses.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// s since the start.
    pub time: f32,
    /// Dimensions of the field, m.
    pub field: &'a FieldSpec,
    /// Phase of the game, by team colour.
    pub phase: Phase<Colour>,
    /// Position of the ball, m.
    pub ball: Point<Field>,
    /// Speed of the ball, m/s.
    pub ball_speed: f32,
    /// Target position of its placement, m.
    pub placement: Option<Point<Field>>,
    /// Whether it has left its position since NORMAL_START.
    pub in_play: bool,
    /// Keepers of yellow and blue.
    pub keepers: [Who; 2],
    /// Yellow's and blue's own goals.
    pub own: [GoalEnd; 2],
    /// Time of the last change of phase, keeper or the ball's position by hand, s.
    pub changed: f32,
}

/// A robot in a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within {
    /// The robot in the region.
    pub who: Who,
    /// Rule that forbids the region.
    pub why: KeepOutReason,
    /// Depth within it, m.
    pub depth: f32,
}

impl Moment<'_> {
    /// Whether no robot has the ball: it rolls freely.
    fn ball_is_free(&self, robots: &[(Who, Point<Field>)]) -> bool {
        robots.iter().all(|(_, at)| at.distance(self.ball) > limits::ROBOT_RADIUS + 2.0 * limits::BALL_RADIUS)
    }

    fn situation(&self, who: Who, rule_role: RuleRole) -> Situation<'_> {
        Situation {
            field: self.field,
            own: self.own[who.colour as usize],
            phase: self.phase.seen_by(who.colour),
            rule_role,
            ball: Some(self.ball),
            placement: self.placement,
            ball_in_play: self.in_play,
        }
    }

    fn regions(&self, who: Who, rule_role: RuleRole, at: Point<Field>) -> Vec<Within> {
        let phase = self.phase.seen_by(who.colour);
        let depth = |region: &Forbidden| limits::ROBOT_RADIUS - region.shape.distance_to(at);
        let regions = keep_out(&self.situation(who, rule_role)).forbidden;
        let offends = |region: &&Forbidden| region.why.offends(phase) && depth(region) > TOLERANCE;
        regions.iter().filter(offends).map(|r| Within { who, why: r.why, depth: depth(r) }).collect()
    }

    /// Every robot at a forbidden position.
    pub fn offenders(&self, robots: &[(Who, Point<Field>)]) -> Vec<Within> {
        let mut all = Vec::new();
        for team in [Colour::Yellow, Colour::Blue] {
            // The robot that may be the kicker: the nearest to the ball of those that only the kicker's role
            // excuses.
            let mut excused: Option<(f32, Vec<Within>)> = None;
            for &(who, at) in robots.iter().filter(|(who, _)| who.colour == team) {
                let rule_role = if self.keepers.contains(&who) { RuleRole::Keeper } else { RuleRole::Player };
                let found = self.regions(who, rule_role, at);
                if found.is_empty() {
                    continue;
                }
                if !self.regions(who, RuleRole::Kicker, at).is_empty() {
                    all.extend(found);
                    continue;
                }
                let distance = at.distance(self.ball);
                match &mut excused {
                    Some((least, _)) if *least <= distance => all.extend(found),
                    other => {
                        let before = other.replace((distance, found));
                        all.extend(before.into_iter().flat_map(|(_, found)| found));
                    }
                }
            }
        }
        all
    }
}

/// A violated keep-out area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Broken {
    /// The robot, the region and the maximum depth.
    pub within: Within,
    /// Time beyond the grace, s.
    pub beyond: f32,
}

/// Monitors all robots of both teams, region by region.
#[derive(Clone, Debug, Default)]
pub struct KeepOuts {
    /// Since when each robot is in each region, s, the maximum depth, and whether it was reported.
    since: BTreeMap<(Who, u8), (f32, f32, bool)>,
}

impl KeepOuts {
    /// Takes one moment, 10 ms after the last one; returns new violations.
    pub fn look(&mut self, moment: &Moment<'_>, robots: &[(Who, Point<Field>)]) -> Vec<Broken> {
        let within = moment.offenders(robots);
        self.since.retain(|key, _| within.iter().any(|one| (one.who, one.why as u8) == *key));
        let mut broken = Vec::new();
        for one in within {
            let phase = moment.phase.seen_by(one.who.colour);
            let Some(grace) = grace(one.why, phase) else { continue };
            let entry = self.since.entry((one.who, one.why as u8)).or_insert((moment.time, one.depth, false));
            if one.why == KeepOutReason::BallDistance
                && moment.ball_speed > BALL_QUICK
                && moment.ball_is_free(robots)
            {
                entry.0 = moment.time;
            }
            entry.1 = entry.1.max(one.depth);
            let begins = match grace {
                Grace::AfterChange(s) => entry.0.max(moment.changed + s),
                Grace::AtATime(s) => entry.0.max(moment.changed) + s,
            };
            let beyond = moment.time - begins;
            if beyond > BOUND && !entry.2 {
                entry.2 = true;
                broken.push(Broken { within: Within { depth: entry.1, ..one }, beyond });
            }
        }
        broken
    }
}
