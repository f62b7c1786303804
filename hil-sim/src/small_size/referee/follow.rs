//! `follow`: the internal referee as the mirror of a match that a game controller runs: its state is the
//! controller's, and it counts what reports and pages show. m; µs of the simulation.

use rules::state::Stage;
use rules::{Colour, Phase};

use super::InternalReferee;
use super::look::Sight;
use super::remote::{CiMatch, RemoteMatch};
use crate::small_size::{PhysicsEvent, World};

impl InternalReferee {
    /// Takes over the match's state and its new events, and counts this observation; `events` are the world's
    /// since the last call. Apply [`Self::poll_order`] afterwards: robots of a team that does not drive are
    /// moved by hand when the teams change ends.
    pub fn follow(&mut self, game: &mut CiMatch, world: &World, events: &[PhysicsEvent]) {
        let sight = Sight::of(world, events, self.begun.then_some(self.now));
        let passed = if self.begun { sight.time.since(self.now).0 } else { 0 };
        (self.begun, self.now, self.ball, self.ball_seen_at) = (true, sight.time, sight.ball, sight.time);
        let decided = game.take_events();
        let remote = game.game();
        if let Some(command) = remote.command.filter(|_| remote.commands != u64::from(self.command_counter)) {
            (self.command, self.command_at, self.ball_at_command) =
                (command, self.now, remote.ball_at_command);
            self.command_counter = u32::try_from(remote.commands).unwrap_or(u32::MAX);
            self.wait_ends();
        }
        self.state = remote.state;
        let before = self.stage;
        self.stage = if game.is_over() { Stage::PostGame } else { remote.stage };
        self.next = remote.next();
        self.placement = remote.target();
        self.blue_on_positive = remote.blue_on_positive();
        self.follow_accounts(game.game());
        if self.stage == Stage::SecondHalfPre && before != self.stage {
            self.carry_over(&sight.robots);
        }
        for event in decided {
            self.metrics.count(&event);
            self.log.push(event);
        }
        let touching = sight.robots.iter().any(|robot| robot.touches_ball);
        self.count_moment(sight.ball, touching, game.last_touch(), passed);
        let waits = matches!(self.phase(), Phase::Stop | Phase::PrepareKickoff(_) | Phase::PreparePenalty(_));
        match self.obstacles(&sight.robots).first().filter(|_| waits) {
            Some(first) => {
                self.wait_for(&sight.robots, first);
            }
            None => self.wait_ends(),
        }
    }

    /// Takes over the accounts of both teams, and the times left.
    pub(super) fn follow_accounts(&mut self, remote: &RemoteMatch) {
        let Some(newest) = &remote.newest else { return };
        self.stage_left = newest.stage_time_left.unwrap_or(0);
        self.action_left = newest.current_action_time_remaining.unwrap_or(0);
        for team in Colour::ALL {
            let info = team.pick(&newest.yellow, &newest.blue);
            let keeper = remote.accounts.of(team).keeper;
            let account = self.accounts.of_mut(team);
            account.keeper = keeper;
            account.score = info.score;
            account.red_cards = info.red_cards;
            account.yellow_cards = info.yellow_card_times.iter().map(|left| i64::from(*left)).collect();
            account.yellow_cards_given = info.yellow_cards;
            account.timeouts = info.timeouts;
            account.can_place_ball = info.can_place_ball.unwrap_or(true);
            account.placement_failures = info.ball_placement_failures.unwrap_or(0);
            account.placement_blocked = info.ball_placement_failures_reached.unwrap_or(false);
        }
    }
}
