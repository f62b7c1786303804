//! `metrics`: match statistics. Counted during play for the match report: time in play, time in each half,
//! shots, scoring chances, passes, fouls by kind.
//!
//! Biswas et al. 2014 §6: the *offence ratio* is the time of the ball in the opponents' half over that in
//! one's own; the *attack ratio* is one's attempts to shoot at the goal over the opponents'. Both are ratios
//! of the two teams' numbers here. s, m, m/s, field frame.

use std::collections::BTreeMap;

use geometry::{Field, Point};
use rules::Colour;

use super::InternalReferee;
use super::blocked::Blocked;
use super::event::{Kind, RefereeEvent, What};
use super::observation::BallSeen;
use super::scene::is_running;
use protocol::Who;

/// Number of offences of each kind, by team.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FoulCounts(BTreeMap<(Colour, Kind), u32>);

impl FoulCounts {
    /// Number of offences of that kind by that team.
    pub fn of(&self, team: Colour, kind: Kind) -> u32 {
        self.0.get(&(team, kind)).copied().unwrap_or(0)
    }

    /// Every kind that team committed at least once, with its count.
    pub fn team(&self, team: Colour) -> impl Iterator<Item = (Kind, u32)> + '_ {
        self.0.iter().filter(move |((who, _), _)| *who == team).map(|((_, kind), count)| (*kind, *count))
    }

    fn add(&mut self, team: Colour, kind: Kind) {
        *self.0.entry((team, kind)).or_default() += 1;
    }
}

/// Statistics of one team.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TeamMetrics {
    /// Seconds in play from its touch to another team's.
    pub possession_s: f32,
    /// Seconds in play with the ball in the opponents' half.
    pub ball_in_their_half_s: f32,
    /// Shots: the ball left one of its robots faster than 1.5 m/s, from the opponents' half, on a line that
    /// crosses their goal line between the posts or within a goal's width beside them.
    pub shots: u32,
    /// Scoring chances: shots on a line between the posts, fast enough to get there if no robot stops them.
    pub chances: u32,
    /// Passes that arrived: touches of two of its robots one after the other, the ball at least 0.5 m apart.
    pub passes: u32,
    /// Number of balls lost: the next touch was the opponents'.
    pub losses: u32,
}

/// Statistics of a match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metrics {
    /// Simulated seconds without breaks and after-match.
    pub match_s: f32,
    /// Seconds in which the ball was in play (rules: from 0.05 m after a restart, or a force start, to the
    /// next stop).
    pub in_play_s: f32,
    /// Seconds in which a team may play the ball: in play, or before an awaited kick.
    pub running_s: f32,
    /// Statistics of team yellow.
    pub yellow: TeamMetrics,
    /// Statistics of team blue.
    pub blue: TeamMetrics,
    /// Offences by kind, sanctioned or not.
    pub offences: FoulCounts,
    /// Periods in which the match stood for longer than the referee's patience, oldest first.
    pub blocks: Vec<Blocked>,
    /// Number of robots taken off the field by hand.
    pub taken_off: u32,
    last: Option<Leg>,
}

/// The ball's path after a touch.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leg {
    who: Who,
    from: Point<Field>,
    /// True once the path was counted as a shot.
    shot: bool,
}

impl Metrics {
    /// Share of the match time in which the ball was in play.
    pub fn ball_in_play(&self) -> f32 {
        if self.match_s > 0.0 { self.in_play_s / self.match_s } else { 0.0 }
    }

    /// Seconds in which the match was blocked, from the first obstacle on.
    pub fn blocked_s(&self) -> f32 {
        self.blocks.iter().map(|block| block.lasted.as_secs_f32()).sum()
    }

    /// The statistics of one team.
    pub fn team(&self, team: Colour) -> &TeamMetrics {
        team.pick(&self.yellow, &self.blue)
    }

    /// The paper's offence ratio of that team; `None` where the ball never was in its half.
    pub fn offence_ratio(&self, team: Colour) -> Option<f32> {
        let own = self.team(team.other()).ball_in_their_half_s;
        (own > 0.0).then(|| self.team(team).ball_in_their_half_s / own)
    }

    /// The paper's attack ratio of that team; `None` where the opponents never shot.
    pub fn attack_ratio(&self, team: Colour) -> Option<f32> {
        let theirs = self.team(team.other()).shots;
        (theirs > 0).then(|| self.team(team).shots as f32 / theirs as f32)
    }

    pub(super) fn count(&mut self, event: &RefereeEvent) {
        let kind = event.what.kind();
        if !kind.is_offence() {
            return;
        }
        match (&event.what, event.by) {
            (What::CrashDrawn { .. }, _) => {
                self.offences.add(Colour::Yellow, kind);
                self.offences.add(Colour::Blue, kind);
            }
            (_, Some(team)) => self.offences.add(team, kind),
            (_, None) => {}
        }
    }

    fn team_mut(&mut self, team: Colour) -> &mut TeamMetrics {
        team.pick(&mut self.yellow, &mut self.blue)
    }
}

impl InternalReferee {
    /// Counts one observation; `touch` is the last touch before it.
    pub(super) fn count_moment(
        &mut self,
        ball: BallSeen,
        touching: bool,
        touch: Option<(Who, Point<Field>)>,
        passed_us: u64,
    ) {
        let seconds = passed_us as f32 * 1e-6;
        if self.stage.is_break() {
            return;
        }
        let running = is_running(self.phase());
        let in_play = self.state.ball_in_play();
        self.metrics.match_s += seconds;
        self.metrics.running_s += if running { seconds } else { 0.0 };
        if !running {
            self.metrics.last = None;
            return;
        }
        if in_play {
            self.metrics.in_play_s += seconds;
            let yellow_end = self.own_end(Colour::Yellow).sign() as f32;
            let attacker = if ball.position.x() * yellow_end > 0.0 { Colour::Blue } else { Colour::Yellow };
            self.metrics.team_mut(attacker).ball_in_their_half_s += seconds;
            if let Some((who, _)) = touch {
                self.metrics.team_mut(who.colour).possession_s += seconds;
            }
        }
        let Some((who, from)) = touch else { return };
        let leg = self.metrics.last.get_or_insert(Leg { who, from, shot: false });
        if leg.who == who {
            if touching {
                // Still at the robot; near to the position of the previous touch it may be the same kick.
                leg.shot &= leg.from.distance(from) < LEFT_ROBOT_DISTANCE;
                leg.from = from;
            } else {
                let leg = *leg;
                self.look_for_shot(leg, ball);
            }
            return;
        }
        // In a duel the touching robot alternates in every step; a change of possession counts when the ball
        // is away.
        let (leg, now) = (*leg, if touching { from } else { ball.position });
        if leg.from.distance(now) < LEFT_ROBOT_DISTANCE {
            return;
        }
        let team = self.metrics.team_mut(leg.who.colour);
        if leg.who.colour != who.colour {
            team.losses += 1;
        } else if leg.from.distance(from) >= PASS_LENGTH {
            team.passes += 1;
        }
        self.metrics.last = Some(Leg { who, from, shot: false });
    }

    fn look_for_shot(&mut self, leg: Leg, ball: BallSeen) {
        let speed = ball.velocity.norm();
        let end = self.own_end(leg.who.colour).opposite();
        let sign = end.sign() as f32;
        let forward = ball.velocity.x() * sign;
        let away = leg.from.distance(ball.position) >= LEFT_ROBOT_DISTANCE;
        if leg.shot || !away || speed < SHOT_SPEED || forward <= 0.0 || leg.from.x() * sign < 0.0 {
            return;
        }
        let to_goal_line = self.field.length * 0.5 - ball.position.x() * sign;
        if to_goal_line < 0.0 {
            return;
        }
        let time = to_goal_line / forward;
        let across = ball.position.y() + ball.velocity.y() * time;
        let half = self.field.goal_width * 0.5;
        if across.abs() > half + self.field.goal_width {
            return;
        }
        let decelerates = self.settings.league.ball().rolling_deceleration;
        let arrives = speed * speed >= 2.0 * decelerates * (speed * time);
        let team = self.metrics.team_mut(leg.who.colour);
        team.shots += 1;
        team.chances += u32::from(across.abs() <= half && arrives);
        self.metrics.last = Some(Leg { shot: true, ..leg });
    }
}

/// Minimum speed of a shot, m/s: a slower ball rolls less than 3.2 m.
const SHOT_SPEED: f32 = 1.5;
/// Distance from the last touch, m, at which the ball has left the robot: half a robot's diameter, more than
/// a dribbler's bounces.
const LEFT_ROBOT_DISTANCE: f32 = 0.1;
/// Minimum distance between two touches of a pass, m.
const PASS_LENGTH: f32 = 0.5;
