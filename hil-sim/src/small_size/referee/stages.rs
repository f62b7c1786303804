//! `stages`: stages and match time. Rules: game structure, shoot-out.

use geometry::Point;
use protocol::Duration;
use rules::state::{RefereeCommand, Stage};
use rules::{Colour, Phase, limits};

use super::settings::MatchClock;
use super::{InternalReferee, Restart, micros, scene::is_running};

#[derive(Clone, Copy, Debug)]
pub(super) struct ShootOut {
    next: Colour,
    attempts: u32,
}

impl ShootOut {
    pub(super) fn new(first: Colour) -> Self {
        Self { next: first, attempts: 0 }
    }
}

impl InternalReferee {
    pub(super) fn begin(&mut self) {
        if let MatchClock::Simulated { total } = self.settings.clock {
            self.ends_at = Some(self.now + total);
        }
        self.enter_stage(Stage::FirstHalfPre);
    }

    /// Advances the match clocks by `us`.
    pub(super) fn pass_time(&mut self, us: u64) {
        let us = us as i64;
        let running = is_running(self.phase());
        let simulated = matches!(self.settings.clock, MatchClock::Simulated { .. });
        let halves = self.stage < Stage::ExtraTimeBreak;
        if self.stage != Stage::PostGame && (running || self.stage.is_break() || simulated && halves) {
            self.stage_left -= us;
        }
        if running || matches!(self.phase(), Phase::BallPlacement(_)) {
            self.action_left = (self.action_left - us).max(-ACTION_OVER_MAX);
        }
        if running {
            for account in self.accounts.both_mut() {
                account.play(us);
            }
        }
        if let Phase::Timeout(team) = self.phase() {
            let account = self.accounts.of_mut(team);
            account.timeout_left -= us;
            account.timeout_wanted = account.timeout_wanted.map(|left| left - us);
        }
    }

    /// Enters the next stage where this one is over; true if it did.
    pub(super) fn end_stage(&mut self) -> bool {
        let scores = [self.accounts.yellow.score, self.accounts.blue.score];
        let (most, least) = (scores[0].max(scores[1]), scores[0].min(scores[1]));
        let out_of_play = !is_running(self.phase());
        let decided = most >= limits::GOALS_MAX && most - least >= limits::GOALS_LEAD;
        if decided && out_of_play && self.stage < Stage::ShootOut {
            self.enter_stage(Stage::PostGame);
            return true;
        }
        if self.stage == Stage::ShootOut {
            let over = self.shoot_out_is_over() && out_of_play;
            if over {
                self.enter_stage(Stage::PostGame);
            }
            return over;
        }
        if self.stage_left > 0 || self.stage == Stage::PostGame {
            return false;
        }
        // Additional time for a penalty; not beyond the configured simulated time.
        let penalty = matches!(self.next, Some(Restart::Penalty(_)))
            || matches!(self.phase(), Phase::Penalty(_) | Phase::PreparePenalty(_));
        if penalty && matches!(self.settings.clock, MatchClock::Playing { .. }) && !self.stage.is_break() {
            return false;
        }
        let tied = scores[0] == scores[1];
        let next = match self.stage {
            Stage::FirstHalfPre | Stage::FirstHalf => Stage::HalfTime,
            Stage::HalfTime => Stage::SecondHalfPre,
            Stage::SecondHalfPre | Stage::SecondHalf if self.settings.knockout && tied => {
                Stage::ExtraTimeBreak
            }
            Stage::ExtraTimeBreak => Stage::ExtraFirstHalfPre,
            Stage::ExtraFirstHalfPre | Stage::ExtraFirstHalf => Stage::ExtraHalfTime,
            Stage::ExtraHalfTime => Stage::ExtraSecondHalfPre,
            Stage::ExtraSecondHalfPre | Stage::ExtraSecondHalf if tied => Stage::ShootOutBreak,
            Stage::ShootOutBreak => Stage::ShootOut,
            _ => Stage::PostGame,
        };
        self.enter_stage(next);
        true
    }

    /// The ball may be played: a "pre" stage ends, a shoot-out counts the attempt.
    pub(super) fn play_begins(&mut self, command: RefereeCommand) {
        let begun = match self.stage {
            Stage::FirstHalfPre => Stage::FirstHalf,
            Stage::SecondHalfPre => Stage::SecondHalf,
            Stage::ExtraFirstHalfPre => Stage::ExtraFirstHalf,
            Stage::ExtraSecondHalfPre => Stage::ExtraSecondHalf,
            same => same,
        };
        self.stage = begun;
        if self.stage == Stage::ShootOut && command == RefereeCommand::NormalStart {
            self.shoot_out.attempts += 1;
            self.shoot_out.next = self.shoot_out.next.other();
        }
    }

    /// In a shoot-out every stop is followed by the other team's attempt.
    pub(super) fn shoot_out_goes_on(&mut self) {
        if self.stage == Stage::ShootOut {
            self.next = Some(Restart::Penalty(self.shoot_out.next));
            self.placement = Some(self.penalty_spot(self.shoot_out.next));
        }
    }

    fn shoot_out_is_over(&self) -> bool {
        let ShootOut { attempts, .. } = self.shoot_out;
        let even = attempts.is_multiple_of(2);
        let decided = self.accounts.yellow.score != self.accounts.blue.score;
        even && attempts >= 2 * ATTEMPTS && (decided || attempts >= 2 * ATTEMPTS_MAX)
    }

    fn enter_stage(&mut self, stage: Stage) {
        let changes_sides = matches!(stage, Stage::SecondHalfPre | Stage::ExtraSecondHalfPre);
        if changes_sides {
            self.blue_on_positive = !self.blue_on_positive;
        }
        if stage == Stage::ExtraFirstHalfPre {
            for account in self.accounts.both_mut() {
                account.timeouts = OVERTIME_TIMEOUTS;
                account.timeout_left = micros(OVERTIME_TIMEOUT_TIME);
            }
        }
        self.stage = stage;
        self.stage_left = self.length_of(stage);
        self.recent.clear();
        for account in self.accounts.both_mut() {
            account.begin_half();
        }
        let first = self.settings.first_kickoff;
        self.next = match stage {
            Stage::FirstHalfPre | Stage::ExtraFirstHalfPre => Some(Restart::Kickoff(first)),
            Stage::SecondHalfPre | Stage::ExtraSecondHalfPre => Some(Restart::Kickoff(first.other())),
            _ => None,
        };
        self.placement = self.next.map(|_| Point::new(0.0, 0.0));
        self.drawn = None;
        if stage == Stage::ShootOut {
            self.shoot_out = ShootOut::new(first);
            self.shoot_out_goes_on();
        }
        self.give(RefereeCommand::Halt);
    }

    fn length_of(&self, stage: Stage) -> i64 {
        let us = |duration: Duration| duration.0 as i64;
        let (half, until_end) = match (self.settings.clock, self.ends_at) {
            (MatchClock::Simulated { total }, Some(end)) => {
                (us(total).saturating_sub(us(self.settings.half_time)) / 2, us(end.since(self.now)))
            }
            (MatchClock::Playing { half } | MatchClock::Simulated { total: half }, _) => (us(half), us(half)),
        };
        match stage {
            Stage::FirstHalfPre | Stage::FirstHalf => half.max(0),
            Stage::SecondHalfPre | Stage::SecondHalf => until_end,
            Stage::ExtraFirstHalfPre
            | Stage::ExtraFirstHalf
            | Stage::ExtraSecondHalfPre
            | Stage::ExtraSecondHalf => half.max(0) / 2,
            Stage::ShootOut | Stage::PostGame => 0,
            _ => us(self.settings.half_time),
        }
    }
}

/// Maximum overrun of a time limit, µs: half an hour, the game controller's bound.
const ACTION_OVER_MAX: i64 = 1_800_000_000;
/// Attempts of each team in a shoot-out before it may be decided.
const ATTEMPTS: u32 = 5;
/// Attempts of each team after which a simulated shoot-out ends as a draw; the rules have no limit.
const ATTEMPTS_MAX: u32 = 20;
/// Number of time-outs of a team in overtime, and their total time, s.
const OVERTIME_TIMEOUTS: u32 = 2;
const OVERTIME_TIMEOUT_TIME: f32 = 150.0;
