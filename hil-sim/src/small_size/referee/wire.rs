//! `wire`: referee packets. The league's referee packet with all known fields, about 40 times a second and at
//! every command. Times in µs, `designated_position` in mm, events in m; as from the real game controller.

use protocol::{Duration, Instant};
use rules::state::{RefereeCommand, Stage};
use rules::{Colour, Phase};
use ssl::referee as wire;

use super::account::Account;
use super::event::Restart;
use super::{InternalReferee, micros};

impl InternalReferee {
    /// Packet that the game controller would send now.
    pub fn packet(&self) -> wire::Referee {
        let placing = matches!(self.phase(), Phase::BallPlacement(_));
        let position = self.placement.filter(|_| placing || self.settings.position_always);
        let prepares =
            matches!(self.command, RefereeCommand::PrepareKickoff(_) | RefereeCommand::PreparePenalty(_));
        let next = if prepares {
            Some(wire::Command::NormalStart)
        } else {
            self.next.map(|next| {
                command(match next {
                    Restart::Kickoff(team) => RefereeCommand::PrepareKickoff(team),
                    Restart::Penalty(team) => RefereeCommand::PreparePenalty(team),
                    Restart::FreeKick(team) => RefereeCommand::FreeKick(team),
                    Restart::ForceStart => RefereeCommand::ForceStart,
                })
            })
        };
        let events = self.recent.iter().filter_map(|event| event.to_wire(self.settings.epoch_us));
        wire::Referee {
            packet_timestamp: self.stamp(self.now),
            stage: stage(self.stage) as i32,
            stage_time_left: Some(self.stage_left),
            command: command(self.command) as i32,
            command_counter: self.command_counter,
            command_timestamp: self.stamp(self.command_at),
            yellow: self.team_info(Colour::Yellow),
            blue: self.team_info(Colour::Blue),
            designated_position: position
                .map(|place| wire::Point { x: place.x() * 1000.0, y: place.y() * 1000.0 }),
            blue_team_on_positive_half: Some(self.blue_on_positive),
            next_command: next.map(|next| next as i32),
            current_action_time_remaining: Some(self.action_left),
            game_events: events.collect(),
            game_event_proposals: Vec::new(),
            source_identifier: Some("onetwo internal referee".into()),
            match_type: Some(wire::MatchType::Friendly as i32),
            status_message: self.blocked().map(|blocked| format!("blocked: {}", blocked.obstacle)),
        }
    }

    pub(super) fn send_when_due(&mut self) {
        if self.now < self.next_packet {
            return;
        }
        let packet = self.packet();
        self.packets.push_back(packet);
        if self.packets.len() > PACKETS_MAX {
            self.packets.pop_front();
        }
        self.next_packet = self.now + PERIOD;
    }

    /// One packet with the obsolete command for a goal, as the real game controller sends; the current
    /// command follows with the same count.
    pub(super) fn announce_goal(&mut self, team: Colour) {
        self.command_counter += 1;
        self.command_at = self.now;
        let goal = team.pick(wire::Command::GoalYellow, wire::Command::GoalBlue);
        let packet = wire::Referee { command: goal as i32, ..self.packet() };
        self.packets.push_back(packet);
    }

    fn stamp(&self, at: Instant) -> u64 {
        self.settings.epoch_us.saturating_add(at.0)
    }

    fn team_info(&self, team: Colour) -> wire::TeamInfo {
        let account = self.accounts.of(team);
        let Account { yellow_cards, .. } = account;
        wire::TeamInfo {
            name: account.name.clone(),
            score: account.score,
            red_cards: account.red_cards,
            yellow_card_times: yellow_cards.iter().map(|left| unsigned(*left)).collect(),
            yellow_cards: account.yellow_cards_given,
            timeouts: account.timeouts,
            timeout_time: unsigned(account.timeout_left),
            goalkeeper: u32::from(account.keeper.number()),
            foul_counter: Some(account.foul_count()),
            ball_placement_failures: Some(account.placement_failures),
            can_place_ball: Some(account.can_place_ball),
            max_allowed_bots: Some(self.allowed_now(team)),
            bot_substitution_intent: Some(false),
            ball_placement_failures_reached: Some(account.placement_blocked),
            bot_substitution_allowed: Some(false),
            bot_substitutions_left: Some(rules::limits::SUBSTITUTIONS),
            bot_substitution_time_left: Some(unsigned(micros(0.0))),
            hull_color: None,
        }
    }
}

pub(super) const fn command(command: RefereeCommand) -> wire::Command {
    use Colour::{Blue, Yellow};
    match command {
        RefereeCommand::Halt => wire::Command::Halt,
        RefereeCommand::Stop => wire::Command::Stop,
        RefereeCommand::NormalStart => wire::Command::NormalStart,
        RefereeCommand::ForceStart => wire::Command::ForceStart,
        RefereeCommand::PrepareKickoff(Yellow) => wire::Command::PrepareKickoffYellow,
        RefereeCommand::PrepareKickoff(Blue) => wire::Command::PrepareKickoffBlue,
        RefereeCommand::PreparePenalty(Yellow) => wire::Command::PreparePenaltyYellow,
        RefereeCommand::PreparePenalty(Blue) => wire::Command::PreparePenaltyBlue,
        RefereeCommand::FreeKick(Yellow) => wire::Command::DirectFreeYellow,
        RefereeCommand::FreeKick(Blue) => wire::Command::DirectFreeBlue,
        RefereeCommand::Timeout(Yellow) => wire::Command::TimeoutYellow,
        RefereeCommand::Timeout(Blue) => wire::Command::TimeoutBlue,
        RefereeCommand::BallPlacement(Yellow) => wire::Command::BallPlacementYellow,
        RefereeCommand::BallPlacement(Blue) => wire::Command::BallPlacementBlue,
    }
}

pub(super) const fn stage(stage: Stage) -> wire::Stage {
    match stage {
        Stage::FirstHalfPre => wire::Stage::NormalFirstHalfPre,
        Stage::FirstHalf => wire::Stage::NormalFirstHalf,
        Stage::HalfTime => wire::Stage::NormalHalfTime,
        Stage::SecondHalfPre => wire::Stage::NormalSecondHalfPre,
        Stage::SecondHalf => wire::Stage::NormalSecondHalf,
        Stage::ExtraTimeBreak => wire::Stage::ExtraTimeBreak,
        Stage::ExtraFirstHalfPre => wire::Stage::ExtraFirstHalfPre,
        Stage::ExtraFirstHalf => wire::Stage::ExtraFirstHalf,
        Stage::ExtraHalfTime => wire::Stage::ExtraHalfTime,
        Stage::ExtraSecondHalfPre => wire::Stage::ExtraSecondHalfPre,
        Stage::ExtraSecondHalf => wire::Stage::ExtraSecondHalf,
        Stage::ShootOutBreak => wire::Stage::PenaltyShootoutBreak,
        Stage::ShootOut => wire::Stage::PenaltyShootout,
        Stage::PostGame => wire::Stage::PostGame,
    }
}

fn unsigned(us: i64) -> u32 {
    u32::try_from(us.max(0)).unwrap_or(u32::MAX)
}

/// Period of the game controller's packets.
const PERIOD: Duration = Duration::millis(25);
/// Maximum number of packets kept for a caller that does not poll: a quarter of a second and some commands.
const PACKETS_MAX: usize = 32;
