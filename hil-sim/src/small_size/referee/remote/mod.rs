//! `remote`: a match run by a game controller elsewhere, followed by its packets. m, field frame; times of
//! the simulation, µs.
//!
//! [`RemoteMatch`] is the state from the packets; [`AutoReferee`] finds the events that an automatic referee
//! reports to such a controller, and [`Assistant`] carries out the manual acts that it requests. None has a
//! socket: the caller brings packets and takes events and acts.

mod assistant;
mod autoref;
mod ci;
mod decided;
mod operator;
mod places;
#[cfg(test)]
mod tests;

use geometry::{Field, GoalEnd, Point};
use protocol::{Duration, Instant, RobotId};
use rules::state::{GameState, RefereeCommand, Stage};
use rules::{Colour, FieldSpec, League, Limits, Phase};
use ssl::event::{Event as Reported, GameEvent, GameEventType};
use ssl::referee as packet;

pub use assistant::{Assistant, AssistantReason, Deed};
pub use autoref::{AutoReferee, Decider};
pub use ci::CiMatch;

use super::account::{Account, Accounts};
use super::event::Restart;
use super::scene::{self, GameView};
use super::settings::TeamSettings;
use super::{NoRules, wire};

/// A match as a game controller's packets describe it.
#[derive(Clone, Debug)]
pub struct RemoteMatch {
    field: FieldSpec,
    limits: Limits,
    pub(super) state: GameState,
    pub(super) stage: Stage,
    pub(super) command: Option<RefereeCommand>,
    pub(super) newest: Option<packet::Referee>,
    received: Instant,
    now: Instant,
    pub(super) accounts: Accounts,
    pub(super) ball_at_command: Point<Field>,
    /// Number of commands so far.
    pub(super) commands: u64,
}

impl RemoteMatch {
    /// Before the first packet. Not for the four-legged league.
    pub fn new(league: League) -> Result<Self, NoRules> {
        let limits = league.limits().ok_or(NoRules(league))?;
        let account = Account::new(&TeamSettings::new(""));
        Ok(Self {
            field: league.field(),
            limits,
            state: GameState::new(),
            stage: Stage::FirstHalfPre,
            command: None,
            newest: None,
            received: Instant(0),
            now: Instant(0),
            accounts: Accounts { yellow: account.clone(), blue: account },
            ball_at_command: Point::default(),
            commands: 0,
        })
    }

    /// A packet received at `now`, with the ball here; true where it brings a new command. A packet of
    /// another sender than the followed one is ignored until that one has been silent for [`SILENCE`].
    pub fn receive(&mut self, packet: packet::Referee, now: Instant, ball: Point<Field>) -> bool {
        let before = self.newest.as_ref();
        if before.is_some_and(|before| before.source_identifier != packet.source_identifier)
            && !self.is_silent(now)
        {
            return false;
        }
        self.received = now;
        if let Some(stage) = Stage::ALL.into_iter().find(|stage| wire::stage(*stage) as i32 == packet.stage) {
            self.stage = stage;
        }
        for (team, info) in [(Colour::Yellow, &packet.yellow), (Colour::Blue, &packet.blue)] {
            if let Some(keeper) = u8::try_from(info.goalkeeper).ok().and_then(RobotId::new) {
                self.accounts.of_mut(team).keeper = keeper;
            }
        }
        let counted = |other: &packet::Referee| (other.command, other.command_counter);
        let new = before.is_none_or(|before| counted(before) != counted(&packet));
        // A goal's packet carries an obsolete command, which has no other effect.
        let command = command_of(packet.command);
        if let (true, Some(command)) = (new, command) {
            let age = match packet.command_timestamp {
                0 => 0,
                given => packet.packet_timestamp.saturating_sub(given),
            };
            self.state.receive(command, now.0.saturating_sub(age), Some(ball));
            self.ball_at_command = ball;
            self.command = Some(command);
            self.commands += 1;
        }
        self.newest = Some(packet);
        new && command.is_some()
    }

    /// Advances the time to `now`, with the ball here.
    pub fn tick(&mut self, now: Instant, ball: Point<Field>) {
        self.now = now;
        self.state.tick(now.0, Some(ball), &self.limits);
    }

    /// Replaces the field's dimensions, as from a geometry packet.
    pub fn set_field(&mut self, field: FieldSpec) {
        self.field = field;
    }

    /// The present phase of the game, by team colour.
    pub fn phase(&self) -> Phase<Colour> {
        self.state.phase()
    }

    /// The present stage of the match.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// The keeper of that team.
    pub fn keeper(&self, team: Colour) -> RobotId {
        self.accounts.of(team).keeper
    }

    /// True where nothing was received for [`SILENCE`], or ever.
    pub fn is_silent(&self, now: Instant) -> bool {
        self.newest.is_none() || now.since(self.received) > SILENCE
    }

    /// The end at which that team's own goal stands now.
    pub fn own_end(&self, team: Colour) -> GoalEnd {
        scene::own_end(self.blue_on_positive(), team)
    }

    pub(super) fn blue_on_positive(&self) -> bool {
        self.newest.as_ref().and_then(|newest| newest.blue_team_on_positive_half).unwrap_or(false)
    }

    fn team(&self, team: Colour) -> Option<&packet::TeamInfo> {
        let newest = self.newest.as_ref()?;
        Some(team.pick(&newest.yellow, &newest.blue))
    }

    /// The restart after the stop.
    pub fn next(&self) -> Option<Restart> {
        match command_of(self.newest.as_ref()?.next_command?)? {
            RefereeCommand::PrepareKickoff(team) => Some(Restart::Kickoff(team)),
            RefereeCommand::PreparePenalty(team) => Some(Restart::Penalty(team)),
            RefereeCommand::FreeKick(team) => Some(Restart::FreeKick(team)),
            RefereeCommand::ForceStart => Some(Restart::ForceStart),
            _ => None,
        }
    }

    /// Target position of the ball for the restart: the controller's, which may differ from the mark (a foul
    /// in the stop before a kick-off moves it); else the mark.
    pub fn target(&self) -> Option<Point<Field>> {
        self.designated().or_else(|| self.mark(self.next()?))
    }

    fn mark(&self, restart: Restart) -> Option<Point<Field>> {
        match restart {
            Restart::Kickoff(_) => Some(Point::new(0.0, 0.0)),
            Restart::Penalty(team) => Some(self.field.penalty_spot(self.own_end(team).opposite())),
            Restart::FreeKick(_) | Restart::ForceStart => None,
        }
    }

    fn designated(&self) -> Option<Point<Field>> {
        let reported = self.newest.as_ref()?.designated_position?;
        let place = Point::new(reported.x * 0.001, reported.y * 0.001);
        // A position outside the field surface is refused, whatever the packet contains.
        (place.is_finite() && self.field.surface().contains(place)).then_some(place)
    }

    /// Number of robots that team may have on the field now; `None` until the controller has sent it.
    pub fn allowed(&self, team: Colour) -> Option<u32> {
        self.team(team)?.max_allowed_bots
    }

    /// True for a team that may exchange a robot now: the match is halted for it.
    pub fn substitutes(&self, team: Colour) -> bool {
        self.team(team).and_then(|info| info.bot_substitution_allowed).unwrap_or(false)
    }

    /// The team that the controller would let place the ball now; `None`: placed by hand.
    fn placing_team(&self) -> Option<Colour> {
        let may = |team: &Colour| self.may_place(*team);
        let mut failed = self.failed_placements();
        match (failed.next(), failed.next()) {
            (None, _) => Colour::ALL.into_iter().find(may),
            (Some(team), None) => team.map(Colour::other).filter(may),
            (Some(_), Some(_)) => None,
        }
    }

    fn may_place(&self, team: Colour) -> bool {
        self.team(team).is_some_and(|info| {
            info.can_place_ball.unwrap_or(true) && !info.ball_placement_failures_reached.unwrap_or(false)
        })
    }

    /// The teams whose placement failed in this stoppage, one item each.
    fn failed_placements(&self) -> impl Iterator<Item = Option<Colour>> + '_ {
        self.events().iter().filter_map(|event| match &event.event {
            Some(Reported::PlacementFailed(failed)) => Some(colour_of(failed.by_team)),
            _ => None,
        })
    }

    fn events(&self) -> &[GameEvent] {
        self.newest.as_ref().map_or(&[], |newest| &newest.game_events)
    }

    fn has_event(&self, kind: GameEventType) -> bool {
        self.events().iter().any(|event| event.r#type == Some(kind as i32))
    }

    fn view(&self) -> GameView<'_> {
        GameView {
            phase: self.phase(),
            is_break: self.stage.is_break(),
            before_half: matches!(self.stage, Stage::SecondHalfPre | Stage::ExtraSecondHalfPre),
            since: Instant(self.state.since()),
            ball_at_command: self.ball_at_command,
            target: self.designated(),
            field: &self.field,
            limits: &self.limits,
            blue_on_positive: self.blue_on_positive(),
            accounts: &self.accounts,
            judge_manual_fouls: false,
        }
    }
}

fn colour_of(team: i32) -> Option<Colour> {
    use ssl::common::Team;
    match Team::try_from(team) {
        Ok(Team::Yellow) => Some(Colour::Yellow),
        Ok(Team::Blue) => Some(Colour::Blue),
        _ => None,
    }
}

/// The command with that number on the wire; none for obsolete ones (goals, indirect free kicks) and unknown
/// numbers.
fn command_of(number: i32) -> Option<RefereeCommand> {
    RefereeCommand::all().find(|command| wire::command(*command) as i32 == number)
}

/// Silence after which a controller is not followed any more: it sends every 25 ms.
pub const SILENCE: Duration = Duration::millis(3_000);
