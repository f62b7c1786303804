//! `operator`: acts of the game controller's operator in a match without a person: settings at the start,
//! stages, and commands that the controller leaves to its operator. m, field frame; simulated time, µs.

use geometry::Point;
use protocol::Duration;
use rules::restart::placement_needless;
use rules::state::Stage;
use rules::{Colour, Phase, limits};
use ssl::common::{Division, Team};
use ssl::controller::ci::{
    ApiInput, Behavior, Change, ChangeOf, ChangeStage, CommandType, ControllerCommand, EngineConfig,
    NewCommand, UpdateConfig, UpdateTeamState,
};
use ssl::event::GameEventType;
use ssl::referee as packet;

use super::super::event::Restart;
use super::super::scene::is_running;
use super::super::settings::{MatchClock, RefereeSettings};
use super::RemoteMatch;
use crate::rng::Stream;
use crate::small_size::Ball;

#[derive(Clone, Debug)]
pub(super) struct Operator {
    settings: RefereeSettings,
    /// Draws the placing team where neither is in favour: the controller's draw has no seed.
    chance: Stream,
    /// Whether the controller continues by itself.
    continues: bool,
}

impl Operator {
    pub(super) fn new(settings: RefereeSettings, seed: u64) -> Self {
        Self { settings, chance: Stream::new(seed, "controller-operator"), continues: false }
    }

    /// Settings of the controller's engine: every event that is reported is accepted, by a fresh match.
    pub(super) fn engine() -> ApiInput {
        let names =
            (0..=EVENT_TYPE_MAX).filter_map(|kind| GameEventType::try_from(kind).ok()).map(league_name);
        let config = EngineConfig {
            game_event_behavior: names.map(|name| (name, Behavior::Accept as i32)).collect(),
            auto_continue: Some(false),
        };
        ApiInput { change: None, reset_match: Some(true), config_delta: Some(config) }
    }

    /// Lets the controller continue by itself, or not: in play and halt it must not, so that a stop begins
    /// with the operator's acts. The setting where it changes.
    pub(super) fn continues(&mut self, game: &RemoteMatch) -> Option<ApiInput> {
        let continues = !is_running(game.phase()) && game.phase() != Phase::Halt;
        if continues == std::mem::replace(&mut self.continues, continues) {
            return None;
        }
        let config = EngineConfig { auto_continue: Some(continues), ..EngineConfig::default() };
        Some(ApiInput { config_delta: Some(config), ..ApiInput::default() })
    }

    /// Settings of the match and of both teams.
    pub(super) fn start(&self) -> Vec<ChangeOf> {
        let settings = &self.settings;
        let division = match settings.league {
            rules::League::DivisionA => Division::A,
            _ => Division::B,
        };
        let mut changes = vec![ChangeOf::UpdateConfig(UpdateConfig {
            division: Some(division as i32),
            first_kickoff_team: Some(wire(settings.first_kickoff) as i32),
            match_type: Some(packet::MatchType::Friendly as i32),
            max_robots_per_team: settings.max_robots.map(i32::from),
        })];
        changes.extend(Colour::ALL.map(|team| {
            let own = settings.team(team);
            ChangeOf::UpdateTeamState(UpdateTeamState {
                for_team: Some(wire(team) as i32),
                team_name: Some(own.name.clone()),
                goalkeeper: Some(i32::from(own.keeper.number())),
                on_positive_half: Some((team == Colour::Blue) == settings.blue_on_positive_half),
                can_place_ball: Some(own.can_place_ball),
            })
        }));
        changes
    }

    pub(super) fn acts(&mut self, game: &RemoteMatch, ball: &Ball) -> Vec<ChangeOf> {
        let age = game.now.since(protocol::Instant(game.state.since()));
        let running = is_running(game.phase());
        match game.stage {
            Stage::PostGame => Vec::new(),
            Stage::HalfTime if age >= self.settings.half_time => {
                let ends = UpdateTeamState {
                    for_team: Some(Team::Blue as i32),
                    on_positive_half: Some(!game.blue_on_positive()),
                    ..UpdateTeamState::default()
                };
                vec![stage(packet::Stage::NormalSecondHalfPre), ChangeOf::UpdateTeamState(ends)]
            }
            stage if stage.is_break() => Vec::new(),
            Stage::FirstHalfPre | Stage::FirstHalf if !running && self.half_is_over(game) => {
                vec![stage(packet::Stage::NormalHalfTime)]
            }
            _ => self.command(game, ball, age).into_iter().collect(),
        }
    }

    fn half_is_over(&self, game: &RemoteMatch) -> bool {
        let halved = match self.settings.clock {
            MatchClock::Simulated { total } => {
                game.now.0 >= total.0.saturating_sub(self.settings.half_time.0) / 2
            }
            MatchClock::Playing { .. } => false,
        };
        halved || stage_left(game) < 0
    }

    fn command(&mut self, game: &RemoteMatch, ball: &Ball, age: Duration) -> Option<ChangeOf> {
        match game.phase() {
            Phase::Halt => {
                let substitutes = Colour::ALL.into_iter().any(|team| game.substitutes(team));
                (age >= self.settings.halt && !substitutes).then(|| command(CommandType::Stop, Team::Unknown))
            }
            Phase::Stop if game.next().is_none() && age >= STOP_WITHOUT_NEXT_MAX => {
                Some(command(CommandType::ForceStart, Team::Unknown))
            }
            Phase::Stop if game.next() == Some(Restart::ForceStart) => {
                self.draw(game, ball).map(|team| command(CommandType::BallPlacement, wire(team)))
            }
            _ => None,
        }
    }

    /// The team that places the ball before a force start, if the ball has to be placed.
    fn draw(&mut self, game: &RemoteMatch, ball: &Ball) -> Option<Colour> {
        let events =
            game.failed_placements().next().is_some() || game.has_event(GameEventType::PlacementSucceeded);
        let target: Point<_> = game.designated().filter(|_| !events)?;
        let (place, speed) = (ball.position, ball.velocity.norm());
        if placement_needless(&game.field, place, speed, target) {
            return None;
        }
        let first = if self.chance.chance(0.5) { Colour::Yellow } else { Colour::Blue };
        [first, first.other()].into_iter().find(|team| game.may_place(*team))
    }
}

/// True once the match is over: the controller leaves it to its operator to end it.
pub(super) fn is_over(game: &RemoteMatch) -> bool {
    let scores = Colour::ALL.map(|team| game.team(team).map_or(0, |info| info.score));
    let decided = scores.iter().max() >= Some(&limits::GOALS_MAX)
        && scores[0].abs_diff(scores[1]) >= limits::GOALS_LEAD;
    let time_up = game.stage == Stage::SecondHalf && stage_left(game) < 0;
    game.stage == Stage::PostGame || (decided || time_up) && !is_running(game.phase())
}

fn stage_left(game: &RemoteMatch) -> i64 {
    game.newest.as_ref().and_then(|newest| newest.stage_time_left).unwrap_or(0)
}

fn stage(stage: packet::Stage) -> ChangeOf {
    ChangeOf::ChangeStage(ChangeStage { new_stage: Some(stage as i32) })
}

fn command(kind: CommandType, team: Team) -> ChangeOf {
    let command = ControllerCommand { r#type: kind as i32, for_team: team as i32 };
    ChangeOf::NewCommand(NewCommand { command: Some(command) })
}

pub(super) fn act(change: ChangeOf) -> ApiInput {
    ApiInput { change: Some(Change { change: Some(change) }), ..ApiInput::default() }
}

fn wire(team: Colour) -> Team {
    team.pick(Team::Yellow, Team::Blue)
}

/// The league's name of a kind of event: `NO_PROGRESS_IN_GAME` for `NoProgressInGame`.
fn league_name(kind: GameEventType) -> String {
    let mut name = String::new();
    for letter in format!("{kind:?}").chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(letter.to_ascii_uppercase());
    }
    name
}

/// The highest number of a kind of event: EXCESSIVE_BOT_SUBSTITUTION.
const EVENT_TYPE_MAX: i32 = GameEventType::ExcessiveBotSubstitution as i32;
/// Time in a stop after which play continues by a force start where no restart is known: twice the
/// controller's preparation after a halt, so that a late report is waited for. An estimate.
const STOP_WITHOUT_NEXT_MAX: Duration = Duration::millis(20_000);

#[cfg(test)]
mod tests {
    use protocol::Instant;
    use rules::League;
    use ssl::referee::Command;

    use super::*;

    /// A match at this time, s, in which the controller has sent this.
    fn game(at: f64, command: Command, stage: packet::Stage) -> RemoteMatch {
        let mut game = RemoteMatch::new(League::DivisionB).unwrap();
        let packet = packet::Referee {
            command: command as i32,
            command_counter: 1,
            stage: stage as i32,
            ..packet::Referee::default()
        };
        game.receive(packet, Instant(0), Point::default());
        game.tick(Instant((at * 1e6) as u64), Point::default());
        game
    }

    fn operator() -> Operator {
        let clock = MatchClock::Simulated { total: Duration::millis(600_000) };
        Operator::new(RefereeSettings { clock, ..RefereeSettings::new(League::DivisionB) }, 1)
    }

    #[test]
    fn a_halt_ends_after_3_s_and_a_half_in_its_first_stop_after_half_of_the_time() {
        let acts = |at, command, stage| operator().acts(&game(at, command, stage), &Ball::default());
        let half = packet::Stage::NormalFirstHalf;
        assert_eq!(acts(2.9, Command::Halt, half), []);
        assert_eq!(acts(3.0, Command::Halt, half), [command(CommandType::Stop, Team::Unknown)]);
        assert_eq!(acts(299.0, Command::ForceStart, half), []);
        assert_eq!(acts(299.0, Command::Stop, half), [stage(packet::Stage::NormalHalfTime)]);
        assert_eq!(acts(2.9, Command::Halt, packet::Stage::NormalHalfTime), []);
        // The teams change ends.
        let second = acts(3.0, Command::Halt, packet::Stage::NormalHalfTime);
        assert_eq!(second[0], stage(packet::Stage::NormalSecondHalfPre));
        assert_eq!(second.len(), 2);
    }

    #[test]
    fn the_operator_draws_the_placing_team_by_its_seed_where_neither_is_in_favour() {
        let mut stopped = game(1.0, Command::Stop, packet::Stage::NormalFirstHalf);
        let mut packet = stopped.newest.clone().unwrap();
        packet.next_command = Some(Command::ForceStart as i32);
        packet.designated_position = Some(packet::Point { x: 2000.0, y: 0.0 });
        stopped.receive(packet, Instant(0), Point::default());
        let first = operator().acts(&stopped, &Ball::default());
        assert_eq!(first, operator().acts(&stopped, &Ball::default()));
        let teams = [Team::Yellow, Team::Blue].map(|team| [command(CommandType::BallPlacement, team)]);
        assert!(teams.iter().any(|team| first == *team), "{first:?}");
        // A ball that lies well is not placed.
        assert_eq!(operator().acts(&stopped, &Ball::at(Point::new(2.0, 0.0))), []);
    }

    #[test]
    fn the_controller_continues_by_itself_in_a_stop_and_not_in_play() {
        let mut operator = operator();
        let auto = |act: Option<ApiInput>| act.and_then(|act| act.config_delta?.auto_continue);
        let half = packet::Stage::NormalFirstHalf;
        for (command, change) in [
            (Command::ForceStart, None),
            (Command::Stop, Some(true)),
            (Command::BallPlacementBlue, None),
            (Command::DirectFreeBlue, Some(false)),
        ] {
            assert_eq!(auto(operator.continues(&game(5.0, command, half))), change, "{command:?}");
        }
    }

    #[test]
    fn events_have_the_leagues_names() {
        let config = Operator::engine().config_delta.unwrap();
        let behavior = config.game_event_behavior;
        for name in ["NO_PROGRESS_IN_GAME", "BOT_KICKED_BALL_TOO_FAST", "GOAL"] {
            assert_eq!(behavior.get(name), Some(&(Behavior::Accept as i32)), "{name}");
        }
    }
}
