//! `judge`: consequences of an event. Fouls and cards, goals, the next restart and its position (rules:
//! offenses, sanctions, scoring goals; appendix "game events").

use rules::legality::{NoGoal, no_goal};
use rules::state::RefereeCommand;
use rules::{Colour, Phase, limits};

use super::event::{Invalid, Kind, PenaltyEnd, RefereeEvent, Restart, ShotEvent, What};
use super::scene::is_running;
use super::{InternalReferee, micros, spots};

impl InternalReferee {
    /// Records an event and applies the rules to it.
    pub(super) fn judge(&mut self, event: &RefereeEvent) {
        let (kind, by) = (event.what.kind(), event.by);
        // An event at the same moment as one that already stopped the game is no longer in play.
        if !self.is_in_time(kind) {
            return;
        }
        self.metrics.count(event);
        self.log.push(event.clone());
        self.recent.push(event.clone());

        self.decide_next(event);
        if kind.is_foul() {
            self.count_foul(event);
        }
        match &event.what {
            What::PossibleGoal { shot } => self.possible_goal(event, *shot),
            What::Goal { .. } => {
                if let Some(team) = by {
                    self.accounts.of_mut(team).score += 1;
                    self.announce_goal(team);
                }
            }
            What::AttackerTooClose { .. } => self.second_in_a_stop_halts(by),
            What::InterferedPlacement => self.action_left += micros(limits::PLACEMENT_EXTRA_TIME),
            What::DefenderTooClose { .. } => {
                self.action_left = self.time_for(self.command);
                self.state.receive(self.command, self.now.0, Some(self.ball.position));
                self.next_packet = self.now;
            }
            What::PlacementSucceeded { .. } | What::PlacementFailed { .. } => self.placement_ended(event),
            What::MultipleFouls { .. } => self.show_card(by),
            What::MultipleCards => {
                if let Some(team) = by {
                    self.accounts.of_mut(team).show_red(self.now);
                }
            }
            _ => {}
        }
        if let Phase::Penalty(team) = self.phase()
            && kind.decides_a_penalty()
        {
            self.decide_penalty(team, event);
        }
        let stopped = matches!(self.phase(), Phase::Stop | Phase::Halt | Phase::Timeout(_));
        if kind.stops_the_game() && !stopped {
            self.give(RefereeCommand::Stop);
        }
    }

    /// True for an event that belongs to the present phase: events of play to play, those of placements to
    /// placements.
    fn is_in_time(&self, kind: Kind) -> bool {
        match kind {
            Kind::PlacementSucceeded | Kind::PlacementFailed => {
                matches!(self.phase(), Phase::BallPlacement(_))
            }
            Kind::PenaltyFailed => matches!(self.phase(), Phase::Penalty(_)),
            // Decided while the game is halted for the ball in the goal, or after a foul in a penalty.
            Kind::Goal | Kind::InvalidGoal => true,
            // Valid during a stop too; the ball flies over the wall after it left the field.
            Kind::AttackerTooClose | Kind::BoundaryCrossing => true,
            Kind::PossibleGoal => is_running(self.phase()),
            _ => !kind.stops_the_game() || is_running(self.phase()),
        }
    }

    fn decide_next(&mut self, event: &RefereeEvent) {
        let kind = event.what.kind();
        let keeps = self.next.is_some_and(Restart::is_set_by_hand);
        let follows = if spots::is_nobodys(kind, event.by) {
            Some(Restart::ForceStart)
        } else {
            kind.restart(spots::blamed(event))
        };
        if let (Some(next), false) = (follows, keeps) {
            self.next = Some(next);
            self.placement = self.spot_after(event).or(self.placement);
            self.drawn = None;
        }
    }

    fn count_foul(&mut self, event: &RefereeEvent) {
        let kind = event.what.kind();
        // Only the first interference with a placement counts.
        if kind == Kind::InterferedPlacement && event.by.is_some() && self.recent_count(kind, event.by) > 1 {
            return;
        }
        let offenders: &[RobotOf] = &match &event.what {
            What::CrashDrawn { yellow, blue, .. } => {
                vec![(Colour::Yellow, Some(*yellow)), (Colour::Blue, Some(*blue))]
            }
            _ => event.by.map(|team| (team, event.robot)).into_iter().collect(),
        };
        for &(team, robot) in offenders {
            let account = self.accounts.of_mut(team);
            account.fouls.push(event.clone());
            account.last_offender = robot.or(account.last_offender);
            let fouls = &account.fouls;
            if self.settings.cards && fouls.len().is_multiple_of(limits::FOULS_PER_CARD as usize) {
                let caused_by = fouls[fouls.len() - limits::FOULS_PER_CARD as usize..].to_vec();
                self.judge(&self.event(Some(team), What::MultipleFouls { caused_by }));
            }
        }
    }

    fn show_card(&mut self, team: Option<Colour>) {
        let Some(team) = team else { return };
        let now = self.now;
        if !self.accounts.of_mut(team).show_yellow(now, micros(limits::YELLOW_CARD_TIME)) {
            self.judge(&self.event(Some(team), What::MultipleCards));
        }
    }

    /// Halts the game until the goal is decided, as the game controller does; the decision is ours and
    /// immediate.
    fn possible_goal(&mut self, event: &RefereeEvent, shot: ShotEvent) {
        let Some(scorer) = event.by else { return };
        let in_penalty = matches!(self.phase(), Phase::Penalty(_));
        self.give(RefereeCommand::Halt);
        let invalid = if in_penalty { None } else { self.invalid(scorer, &shot) };
        let what = match invalid {
            None => What::Goal { shot: Some(shot) },
            Some(reason) => What::InvalidGoal { shot, reason },
        };
        self.judge(&RefereeEvent { what, ..event.clone() });
    }

    fn invalid(&self, scorer: Colour, shot: &ShotEvent) -> Option<Invalid> {
        let account = self.accounts.of(scorer);
        let foul = account.last_non_stopping_foul();
        let since_foul = foul.map(|foul| self.now.since(foul.at).as_secs_f32());
        let why = no_goal(shot.robots, self.allowed_now(scorer), shot.max_height, since_foul)?;
        Some(match why {
            NoGoal::TooManyRobots => Invalid::TooManyRobots,
            NoGoal::Height(_) => Invalid::TooHigh,
            NoGoal::Foul => Invalid::RecentFoul(foul?.what.kind()),
        })
    }

    /// The second such foul of a team in one stoppage halts the game, once.
    fn second_in_a_stop_halts(&mut self, team: Option<Colour>) {
        if self.recent_count(Kind::AttackerTooClose, team) == 2 {
            self.give(RefereeCommand::Halt);
        }
    }

    /// Number of a team's events of that kind in this stoppage.
    fn recent_count(&self, kind: Kind, by: Option<Colour>) -> usize {
        self.recent.iter().filter(|event| event.what.kind() == kind && event.by == by).count()
    }

    fn placement_ended(&mut self, event: &RefereeEvent) {
        let Some(team) = event.by else { return };
        let succeeded = event.what.kind() == Kind::PlacementSucceeded;
        self.accounts.of_mut(team).placed(succeeded);
        if !self.limits.placement_is_mandatory
            || !self.recent.iter().any(|event| event.what.kind().is_ball_out())
        {
            return;
        }
        // Division A: a team that cannot place a ball that left the field does not get it.
        if !succeeded {
            self.next = Some(Restart::FreeKick(team.other()));
        } else if self.next == Some(Restart::FreeKick(team.other()))
            && self.accounts.of(team.other()).placement_blocked
        {
            self.next = Some(Restart::FreeKick(team));
        }
    }

    /// A foul in a penalty: of the shooting team, no goal; of the others, a goal. Fouls of both count as the
    /// shooting team's.
    fn decide_penalty(&mut self, shooting: Colour, event: &RefereeEvent) {
        let kind = event.what.kind();
        if event.by == Some(shooting.other()) {
            self.judge(&RefereeEvent {
                by: Some(shooting),
                robot: None,
                what: What::Goal { shot: None },
                ..event.clone()
            });
        } else {
            let what = What::PenaltyFailed { reason: PenaltyEnd::Foul(kind) };
            self.judge(&RefereeEvent { by: Some(shooting), what, ..event.clone() });
        }
    }

    /// An event of a team at the ball's position, now.
    pub(super) fn event(&self, by: Option<Colour>, what: What) -> RefereeEvent {
        RefereeEvent { at: self.now, by, robot: None, place: self.ball.position, what }
    }

    /// Number of robots a team may have, including the time to take one off after a card.
    pub(super) fn allowed_now(&self, team: Colour) -> u32 {
        self.accounts.of(team).allowed(self.most_robots())
    }

    pub(super) fn most_robots(&self) -> u32 {
        self.settings.max_robots.map_or(self.limits.robots, u32::from)
    }

    /// Time limit of placement, kick or penalty after this command, µs; as in the game controller.
    pub(super) fn time_for(&self, command: RefereeCommand) -> i64 {
        micros(match command {
            RefereeCommand::BallPlacement(_) => limits::PLACEMENT_TIME,
            RefereeCommand::FreeKick(_) => self.limits.free_kick_time,
            RefereeCommand::PrepareKickoff(_)
            | RefereeCommand::PreparePenalty(_)
            | RefereeCommand::NormalStart => limits::KICKOFF_TIME,
            _ => 0.0,
        })
    }

    /// The teams that failed to place the ball in this stoppage.
    pub(super) fn failed_placements(&self) -> impl Iterator<Item = Colour> + '_ {
        let failed = self.recent.iter().filter(|event| event.what.kind() == Kind::PlacementFailed);
        failed.filter_map(|event| event.by)
    }
}

type RobotOf = (Colour, Option<protocol::RobotId>);
