//! `referee`: outcome and possession of a trial. Ros et al. 2009 §5.1.4, docs/papers.md R32–R35.
//!
//! A trial ends when the ball has crossed a line with all of itself, when the goalie touches it (defender and
//! goalie), when it enters the attacked penalty area (two defenders; the paper calls that "to goal", the
//! outcome here is `goal`), or when time is up. m, s, field frame; the attacked goal is at +x.

use geometry::{Field, GoalEnd, Point};
use rules::{FieldSpec, League};
use serde::{Deserialize, Serialize};

use crate::four_legged::opponents::OpponentRole;
use crate::four_legged::parameters::RefereeParameters;
use crate::four_legged::world::{LeggedWorld, Side, WorldEvent};

geometry::labels! {
    /// Opponents of a trial (paper §5.1.2, Fig. 11).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Configuration {
        /// A defender and the goalie play.
        #[default]
        #[serde(rename = "dg")]
        DefenderGoalie = "dg",
        /// Midfield defender and defender.
        #[serde(rename = "2d")]
        TwoDefenders = "2d",
    }

    /// Outcome of a trial.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum TrialOutcome {
        /// In the attacked goal; against two defenders: in the attacked penalty area.
        Goal = "goal",
        /// Out over the attacked goal line, near a goalpost.
        Close = "close",
        /// The goalie stopped or kicked the ball.
        Block = "block",
        /// Out anywhere else, the own goal included.
        Out = "out",
        /// The trial's time was up.
        Timeout = "timeout",
    }
}

/// The referee's final result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialVerdict {
    /// Outcome of the trial.
    pub outcome: TrialOutcome,
    /// Simulated seconds from kick-off.
    pub time: f32,
}

/// The party that touched the ball last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// One of the robots controlled by brains.
    Attackers,
    /// A scripted opponent of that role.
    Opponent(OpponentRole),
}

impl Party {
    /// Label in reports.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Attackers => "attackers",
            Self::Opponent(role) => role.label(),
        }
    }
}

/// Observes a trial and decides its outcome.
#[derive(Clone, Debug)]
pub struct Referee {
    configuration: Configuration,
    parameters: RefereeParameters,
    field: FieldSpec,
    ball_radius: f32,
    /// The opponents' roles, in the order of the walkers after the attackers.
    roles: Vec<OpponentRole>,
    contacts: Vec<Contact>,
    last: Option<Party>,
    before: Point<Field>,
    verdict: Option<TrialVerdict>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Contact {
    /// Time of the last touch, s.
    at: Option<f32>,
    /// Number of its possessions (docs/papers.md R33).
    possessions: u32,
}

impl Referee {
    /// Before kick-off; `roles` of the opponents in their order, `ball` at its start position.
    pub fn new(
        configuration: Configuration,
        parameters: &RefereeParameters,
        roles: Vec<OpponentRole>,
        ball: Point<Field>,
    ) -> Self {
        let league = League::FourLegged;
        Self {
            configuration,
            parameters: *parameters,
            field: league.field(),
            ball_radius: league.ball().radius,
            contacts: vec![Contact::default(); roles.len()],
            roles,
            last: None,
            before: ball,
            verdict: None,
        }
    }

    /// Examines the world after a step that ended at `time` seconds. The first verdict and all counts are
    /// kept.
    pub fn observe(&mut self, time: f32, world: &LeggedWorld, events: &[WorldEvent]) {
        if self.verdict.is_some() {
            return;
        }
        let attackers = world.walkers.iter().filter(|walker| walker.side == Side::Attackers).count();
        let mut goalie_touched = false;
        for event in events {
            let (WorldEvent::Touched { robot }
            | WorldEvent::Grabbed { robot }
            | WorldEvent::Kicked { robot, .. }) = *event
            else {
                continue;
            };
            self.touched(time, robot, attackers);
            goalie_touched |= self.last == Some(Party::Opponent(OpponentRole::Goalie));
        }
        let (before, now) = (self.before, world.ball.position);
        self.before = now;
        let outcome = self.judge(time, before, now, goalie_touched);
        self.verdict = outcome.map(|outcome| TrialVerdict { outcome, time });
    }

    /// Outcome and time of the trial, if it has ended.
    pub fn verdict(&self) -> Option<TrialVerdict> {
        self.verdict
    }

    /// Outcome of the trial, if it has ended.
    pub fn outcome(&self) -> Option<TrialOutcome> {
        self.verdict.map(|verdict| verdict.outcome)
    }

    /// The party that touched the ball last.
    pub fn last_touch(&self) -> Option<Party> {
        self.last
    }

    /// Number of possessions of the opponent of that role.
    pub fn possessions(&self, role: OpponentRole) -> u32 {
        self.roles.iter().zip(&self.contacts).filter(|(r, _)| **r == role).map(|(_, c)| c.possessions).sum()
    }

    fn touched(&mut self, time: f32, robot: usize, attackers: usize) {
        let opponent = robot.checked_sub(attackers).filter(|&i| i < self.roles.len());
        let Some(i) = opponent else {
            self.last = Some(Party::Attackers);
            return;
        };
        let contact = &mut self.contacts[i];
        // A scrum around the ball is one possession, though its bodies touch alternately.
        let gap = self.parameters.possession_gap;
        contact.possessions += u32::from(contact.at.is_none_or(|at| time - at >= gap));
        contact.at = Some(time);
        self.last = Some(Party::Opponent(self.roles[i]));
    }

    fn judge(
        &self,
        time: f32,
        before: Point<Field>,
        now: Point<Field>,
        goalie_touched: bool,
    ) -> Option<TrialOutcome> {
        let goal_line = self.field.length * 0.5;
        let (out_x, out_y) = (goal_line + self.ball_radius, self.field.width * 0.5 + self.ball_radius);
        let two_defenders = self.configuration == Configuration::TwoDefenders;
        if two_defenders && self.field.in_penalty_area(GoalEnd::Positive, now) {
            return Some(TrialOutcome::Goal);
        }
        if now.x().abs() > out_x {
            let step = now - before;
            let share =
                if step.x() == 0.0 { 1.0 } else { (out_x * now.x().signum() - before.x()) / step.x() };
            let y = (before.y() + step.y() * share.clamp(0.0, 1.0)).abs();
            let post = self.field.goal_width * 0.5;
            return Some(match () {
                () if now.x() < 0.0 => TrialOutcome::Out,
                () if y <= post => TrialOutcome::Goal,
                () if y <= post + self.parameters.close => TrialOutcome::Close,
                () => TrialOutcome::Out,
            });
        }
        if now.y().abs() > out_y {
            return Some(TrialOutcome::Out);
        }
        if goalie_touched {
            return Some(TrialOutcome::Block);
        }
        let limit = if two_defenders { self.parameters.time_limit_2d } else { self.parameters.time_limit_dg };
        (time >= limit).then_some(TrialOutcome::Timeout)
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use crate::four_legged::parameters::Parameters;
    use crate::four_legged::world::{LeggedBall, Walker};
    use protocol::robot_io::LeggedKick;

    struct Match {
        world: LeggedWorld,
        referee: Referee,
    }

    /// One attacker and the configuration's opponents, all far from the ball.
    fn kick_off(configuration: Configuration) -> Match {
        let p = Parameters::four_legged();
        let roles = match configuration {
            Configuration::DefenderGoalie => vec![OpponentRole::Defender, OpponentRole::Goalie],
            Configuration::TwoDefenders => vec![OpponentRole::Midfield, OpponentRole::Defender],
        };
        let pose = Pose::from_mm_deg(-2000.0, -1500.0, 0.0);
        let mut walkers = vec![Walker::at(Side::Attackers, pose)];
        walkers.extend(roles.iter().map(|_| Walker::at(Side::Opponents, pose)));
        let referee = Referee::new(configuration, &p.referee, roles, Point::default());
        Match { world: LeggedWorld::new(p, 0, Point::default(), walkers), referee }
    }

    impl Match {
        /// Moves the ball to a position and returns the outcome.
        fn ball(&mut self, time: f32, x: f32, y: f32) -> Option<TrialOutcome> {
            self.world.ball = LeggedBall::at(Point::new(x, y));
            self.referee.observe(time, &self.world, &[]);
            self.referee.outcome()
        }

        fn touch(&mut self, time: f32, robot: usize) {
            self.referee.observe(time, &self.world, &[WorldEvent::Touched { robot }]);
        }
    }

    /// The outcome of a ball that moves from one position to another between two observations.
    fn between(from: (f32, f32), to: (f32, f32)) -> Option<TrialOutcome> {
        let mut game = kick_off(Configuration::DefenderGoalie);
        game.ball(0.0, from.0, from.1);
        game.ball(0.01, to.0, to.1)
    }

    #[test]
    fn where_the_ball_crosses_a_line_decides_the_outcome() {
        assert_eq!(between((2.69, 0.0), (2.70, 0.0)), None, "the line belongs to the field");
        assert_eq!(between((2.69, 0.0), (2.74, 0.0)), None, "not yet with all of itself");
        assert_eq!(between((2.74, 0.39), (2.745, 0.39)), Some(TrialOutcome::Goal));
        assert_eq!(between((2.74, -0.69), (2.745, -0.69)), Some(TrialOutcome::Close));
        assert_eq!(between((2.74, 0.71), (2.745, 0.71)), Some(TrialOutcome::Out));
        assert_eq!(between((-2.74, 0.0), (-2.745, 0.0)), Some(TrialOutcome::Out), "an own goal");
        assert_eq!(between((0.0, 1.84), (0.0, 1.845)), Some(TrialOutcome::Out));
    }

    #[test]
    fn a_slanted_shot_is_judged_where_it_crosses_the_line() {
        // The whole ball is over at x = 2.7425: a quarter of the distance from 2.7325 to 2.7725, at y = 0.39.
        assert_eq!(between((2.7325, 0.38), (2.7725, 0.42)), Some(TrialOutcome::Goal));
        assert_eq!(between((2.7325, 0.40), (2.7725, 0.44)), Some(TrialOutcome::Close));
    }

    #[test]
    fn the_goalies_touch_ends_a_trial_and_the_defenders_does_not() {
        let mut game = kick_off(Configuration::DefenderGoalie);
        game.touch(1.0, 1);
        assert_eq!(game.referee.verdict(), None);
        game.touch(1.1, 2);
        assert_eq!(game.referee.verdict(), Some(TrialVerdict { outcome: TrialOutcome::Block, time: 1.1 }));
    }

    #[test]
    fn two_defenders_end_a_trial_at_the_penalty_area_or_after_a_minute() {
        let mut game = kick_off(Configuration::TwoDefenders);
        assert_eq!(game.ball(1.0, 2.04, 0.0), None);
        assert_eq!(game.ball(1.1, 2.06, 0.64), Some(TrialOutcome::Goal));
        let mut slow = kick_off(Configuration::TwoDefenders);
        assert_eq!(slow.ball(59.99, 0.0, 0.0), None);
        assert_eq!(slow.ball(60.0, 0.0, 0.0), Some(TrialOutcome::Timeout));
        let mut goalie = kick_off(Configuration::DefenderGoalie);
        assert_eq!(goalie.ball(60.0, 2.3, 0.0), None);
        assert_eq!(goalie.ball(600.0, 2.3, 0.0), Some(TrialOutcome::Timeout));
    }

    #[test]
    fn a_possession_counts_again_after_half_a_second_without_contact() {
        let mut game = kick_off(Configuration::TwoDefenders);
        let had = |game: &Match| {
            (
                game.referee.possessions(OpponentRole::Midfield),
                game.referee.possessions(OpponentRole::Defender),
            )
        };
        for (time, robot, expected) in [
            (1.00, 1, (1, 0)),
            (1.01, 1, (1, 0)),
            (1.49, 1, (1, 0)),
            (1.99, 1, (2, 0)),
            (2.00, 0, (2, 0)),
            (2.01, 1, (2, 0)),
            (2.02, 0, (2, 0)),
            (2.12, 1, (2, 0)),
            (2.13, 2, (2, 1)),
            (2.62, 1, (3, 1)),
        ] {
            game.touch(time, robot);
            assert_eq!(had(&game), expected, "at {time}");
        }
    }

    #[test]
    fn kicks_grabs_and_hits_count_as_the_last_touch() {
        let mut game = kick_off(Configuration::DefenderGoalie);
        assert_eq!(game.referee.last_touch(), None);
        game.touch(1.0, 1);
        assert_eq!(game.referee.last_touch().map(Party::label), Some("defender"));
        let grab = WorldEvent::Grabbed { robot: 0 };
        game.referee.observe(2.0, &game.world, &[grab]);
        assert_eq!(game.referee.last_touch(), Some(Party::Attackers));
        let (kick, at) = (LeggedKick::ForwardHard, Point::default());
        game.referee.observe(3.0, &game.world, &[WorldEvent::Kicked { robot: 1, kick, from: at, rest: at }]);
        assert_eq!(game.referee.last_touch(), Some(Party::Opponent(OpponentRole::Defender)));
    }
}
