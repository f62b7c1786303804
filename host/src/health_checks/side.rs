//! `side`: check that the teams stand at the goals that they defend. The referee names the sides; where it
//! names them wrong, or not at all, our robots would cross the field and shoot at their own goal.

use std::fmt;

use geometry::{Field, GoalEnd, Point};
use protocol::{Duration, Instant, RobotId};
use rules::{FieldSpec, Phase};

use super::Lasting;
use crate::Host;

/// After the sides have changed robots have this time of STOP and play to cross the field: 12 m at 1.3 m/s,
/// and as much again.
const CROSSING_TIME: Duration = Duration::millis(20_000);
/// Least number of robots of each team for a check of the halves.
const HALVES_MIN: usize = 3;
/// A robot nearer to the halfway line is in neither half, m.
const HALFWAY_LINE_WITHIN_M: f32 = 0.1;

/// The teams stand at each other's goals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongSide {
    /// The goal that our host defends.
    pub defending: GoalEnd,
    /// The referee has named it; else it is the default of a host of that colour.
    pub reported: bool,
    /// Evidence that it is the other.
    pub evidence: SideEvidence,
}

/// Evidence that the other goal is ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SideEvidence {
    /// Our keeper stands in the area that we attack.
    OurKeeper(RobotId),
    /// Their keeper stands in the area that we defend.
    TheirKeeper(RobotId),
    /// Before a kick-off all robots (number of ours, of theirs) stand in the half of the other team.
    Halves(usize, usize),
}

impl fmt::Display for WrongSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |goal: GoalEnd| if goal == GoalEnd::Positive { "+x" } else { "−x" };
        let (ours, other) = (side(self.defending), side(self.defending.opposite()));
        let who = if self.reported { "the referee says" } else { "no referee says otherwise" };
        write!(f, "we defend the goal at {ours} ({who}), but ")?;
        match self.evidence {
            SideEvidence::OurKeeper(id) => write!(f, "our keeper {id} stands in the area at {other}")?,
            SideEvidence::TheirKeeper(id) => write!(f, "their keeper {id} stands in the area at {ours}")?,
            SideEvidence::Halves(our, their) => {
                write!(
                    f,
                    "all {our} of ours stand in the half at {other} and all {their} of theirs in ours"
                )?;
            }
        }
        f.write_str(
            ": have the sides changed in the game controller (blue team on positive half), or check --colour",
        )
    }
}

/// The robots under check.
#[derive(Clone, Debug)]
struct Seen {
    defending: GoalEnd,
    reported: bool,
    phase: Phase<rules::Colour>,
    /// Our and their keeper, where they are on the field.
    keepers: [Option<(RobotId, Point<Field>)>; 2],
    /// Places of our robots, and of theirs.
    robots: [Vec<Point<Field>>; 2],
}

/// State of the checks of the sides.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sides {
    lasting: Lasting,
    defending: Option<GoalEnd>,
    /// The sides have changed, and the teams have not yet been seen to follow; play since then.
    changed: Option<Duration>,
    looked: Option<Instant>,
}

impl Sides {
    pub(super) fn look(&mut self, now: Instant, host: &Host, sees: bool) -> Option<WrongSide> {
        let (us, game, world) = (host.settings().us, host.game(), host.world());
        let reported = game.own_goal(us);
        let keeper = |number: Option<RobotId>, colour| {
            let id = number?;
            world.robot(protocol::Who { colour, id }).map(|robot| (id, robot.pose.position))
        };
        let places = |colour| world.team(colour).map(|robot| robot.pose.position).collect();
        let seen = Seen {
            defending: reported.unwrap_or(host.settings().defending),
            reported: reported.is_some(),
            phase: game.phase,
            keepers: [
                keeper(game.team(us).keeper.or(Some(host.settings().keeper)), us),
                keeper(game.team(us.other()).keeper, us.other()),
            ],
            robots: [places(us), places(us.other())],
        };
        let seen = sees.then_some(seen);
        self.see(now, seen.as_ref(), &host.field())
    }

    fn see(&mut self, now: Instant, seen: Option<&Seen>, field: &FieldSpec) -> Option<WrongSide> {
        let passed = self.looked.replace(now).map_or(Duration(0), |last| now.since(last));
        let Some(seen) = seen else {
            self.lasting = Lasting::default();
            return None;
        };
        if self.defending.replace(seen.defending).is_some_and(|before| before != seen.defending) {
            self.changed = Some(Duration(0));
        }
        let evidence = evidence(seen, field);
        match (&mut self.changed, evidence) {
            (changed, None) => *changed = None,
            (Some(played), Some(_)) => {
                if !matches!(seen.phase, Phase::Halt | Phase::Timeout(_)) {
                    *played = Duration(played.0 + passed.0);
                }
                if played.0 >= CROSSING_TIME.0 {
                    self.changed = None;
                }
            }
            (None, Some(_)) => {}
        }
        let wrong = self.lasting.see(now, evidence.is_some() && self.changed.is_none());
        evidence.filter(|_| wrong).map(|evidence| WrongSide {
            defending: seen.defending,
            reported: seen.reported,
            evidence,
        })
    }
}

fn evidence(seen: &Seen, field: &FieldSpec) -> Option<SideEvidence> {
    let (own, theirs) = (seen.defending, seen.defending.opposite());
    if matches!(seen.phase, Phase::PreparePenalty(_) | Phase::Penalty(_)) {
        return None;
    }
    let [our_keeper, their_keeper] = seen.keepers;
    if let Some((id, _)) = our_keeper.filter(|(_, at)| field.in_penalty_area(theirs, *at)) {
        return Some(SideEvidence::OurKeeper(id));
    }
    if let Some((id, _)) = their_keeper.filter(|(_, at)| field.in_penalty_area(own, *at)) {
        return Some(SideEvidence::TheirKeeper(id));
    }
    let waits =
        matches!(seen.phase, Phase::Halt | Phase::Stop | Phase::PrepareKickoff(_) | Phase::Kickoff(_));
    let in_half = |places: &[Point<Field>], goal: GoalEnd| {
        places.len() >= HALVES_MIN
            && places.iter().all(|at| at.x() * goal.sign() as f32 > HALFWAY_LINE_WITHIN_M)
    };
    let [ours, others] = &seen.robots;
    let swapped = waits && in_half(ours, theirs) && in_half(others, own);
    swapped.then_some(SideEvidence::Halves(ours.len(), others.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    /// Teams of four as before a kick-off; `swapped`: on each other's sides.
    fn seen(swapped: bool, defending: GoalEnd, phase: Phase<rules::Colour>) -> Seen {
        let sign = defending.sign() as f32 * if swapped { -1.0 } else { 1.0 };
        let team = |sign: f32| -> Vec<Point<Field>> {
            vec![
                Point::new(4.3 * sign, 0.0),
                Point::new(2.0 * sign, 1.0),
                Point::new(1.0 * sign, -1.0),
                Point::new(3.0 * sign, 0.5),
            ]
        };
        let robots = [team(sign), team(-sign)];
        let keepers = [Some((id(0), robots[0][0])), Some((id(1), robots[1][0]))];
        Seen { defending, reported: true, phase, keepers, robots }
    }

    /// The first time at which something is found, ms, and the finding.
    fn found(seen: impl Fn(u64) -> Seen, ms: u64) -> Option<(u64, WrongSide)> {
        let (mut sides, field) = (Sides::default(), League::DivisionB.field());
        (0..ms)
            .step_by(100)
            .find_map(|t| sides.see(Instant(t * 1_000), Some(&seen(t)), &field).map(|found| (t, found)))
    }

    #[test]
    fn swapped_sides_are_found_within_two_seconds_by_each_kind_of_evidence() {
        let (goal, halt) = (GoalEnd::Negative, Phase::Halt);
        let both = seen(true, goal, halt);
        let ours_only = Seen { keepers: [both.keepers[0], None], ..both.clone() };
        let theirs_only = Seen { keepers: [None, both.keepers[1]], ..both.clone() };
        let neither = Seen { keepers: [None, None], ..both.clone() };
        for (seen, evidence) in [
            (both, SideEvidence::OurKeeper(id(0))),
            (ours_only, SideEvidence::OurKeeper(id(0))),
            (theirs_only, SideEvidence::TheirKeeper(id(1))),
            (neither, SideEvidence::Halves(4, 4)),
        ] {
            let (at, wrong) = found(|_| seen.clone(), 10_000).unwrap();
            assert!(at <= 2_000 && wrong.evidence == evidence, "{at} ms: {wrong:?}");
            let description = wrong.to_string();
            assert!(
                description.contains("at −x") && description.contains("game controller"),
                "{description}"
            );
        }
    }

    #[test]
    fn teams_at_their_own_goals_and_a_change_of_sides_that_they_follow_are_in_order() {
        for goal in [GoalEnd::Negative, GoalEnd::Positive] {
            assert_eq!(found(|_| seen(false, goal, Phase::Stop), 60_000), None);
        }
        // Half-time: the sides change in HALT, which lasts; then the teams need ten seconds of STOP.
        let half_time = |t: u64| {
            let (before, after) = (GoalEnd::Negative, GoalEnd::Positive);
            match t {
                0..5_000 => seen(false, before, Phase::Halt),
                5_000..120_000 => seen(true, after, Phase::Halt),
                120_000..130_000 => seen(true, after, Phase::Stop),
                _ => seen(false, after, Phase::Stop),
            }
        };
        assert_eq!(found(half_time, 180_000), None);
    }

    #[test]
    fn teams_that_do_not_follow_a_change_of_sides_are_a_finding() {
        let stays = |t: u64| {
            let goal = if t < 5_000 { GoalEnd::Negative } else { GoalEnd::Positive };
            seen(t >= 5_000, goal, Phase::Stop)
        };
        let (at, _) = found(stays, 60_000).unwrap();
        assert!((25_000..27_000).contains(&at), "{at}");
    }
}
