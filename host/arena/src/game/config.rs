//! `config`: configuration of a match: league, seed, length, and each side's robots; equal configurations
//! play equally.

use std::sync::Arc;

use brain::{Approach, BrainConfig};
use casebase::{CaseBase, RetrievalSettings};
use hil_sim::AirSettings;
use hil_sim::small_size::network::ControllerChoice;
use hil_sim::small_size::referee::{MatchClock, RefereeSettings};
use hil_sim::small_size::worlds::WorldChoice;
use host::external::StrategyStarter;
use host::strategy::{Tactics, Team};
use protocol::{Duration, TeamId};
use rules::{Colour, League};

use super::GameStart;
use crate::names::CaseNames;

/// A match to be played.
#[derive(Clone, Debug)]
pub struct GameConfig {
    /// Field, robots, ball and rules.
    pub league: League,
    /// Random seed of the whole match.
    pub seed: u64,
    /// Length of the match, simulated s.
    pub duration_s: f64,
    /// Settings of the referee.
    pub referee: RefereeSettings,
    /// Yellow and blue, in this order.
    pub teams: [TeamSetup; 2],
    /// Radio settings of each team; delays in ticks of 10 ms.
    pub air: AirSettings,
    /// The world of the family that it is played in.
    pub world: WorldChoice,
    /// Names of the cases that its robots play, for reports; by default those that come with the league.
    pub names: CaseNames,
    /// The case base that hosts retrieve from, which must be that of the robots: a host proposes nothing to
    /// robots with another one. None: the one that comes with the league.
    pub cases: Option<CaseBase<'static>>,
    /// The league's game controller that runs the match; none: the internal referee.
    pub controller: Option<ControllerChoice>,
    /// The moment of another match that it starts from; none: before the first kick-off.
    pub start: Option<Arc<GameStart>>,
}

/// Configuration of one side of a match.
#[derive(Clone, Debug)]
pub struct TeamSetup {
    /// Colour of the team.
    pub colour: Colour,
    /// Number of robots on the field at the start.
    pub robots: u8,
    /// Strategy of its open play.
    pub plays: Team,
    /// Approach of robots without an order of a host.
    pub approach: Approach,
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Tactics of the second paper that its host plays.
    pub tactics: Tactics,
    /// The strategy that gives orders in place of its host's coach.
    pub strategy: Option<StrategyStarter>,
}

impl TeamSetup {
    /// Our team with its default tactics and this number of robots.
    fn full(colour: Colour, robots: u8) -> Self {
        Self {
            colour,
            robots,
            plays: Team::Ours,
            approach: Approach::Cases,
            settings: RetrievalSettings::default(),
            tactics: Tactics::default(),
            strategy: None,
        }
    }
}

impl GameConfig {
    /// Two full teams of ours, for `duration_s` simulated seconds.
    pub fn new(league: League, seed: u64, duration_s: f64) -> Self {
        let robots = match league {
            League::DivisionA => 11,
            _ => 6,
        };
        let total = Duration((duration_s * 1e6) as u64);
        Self {
            league,
            seed,
            duration_s,
            referee: RefereeSettings {
                clock: MatchClock::Simulated { total },
                ..RefereeSettings::new(league)
            },
            teams: [Colour::Yellow, Colour::Blue].map(|colour| TeamSetup::full(colour, robots)),
            air: AirSettings::default(),
            world: WorldChoice::Nominal,
            names: CaseNames::new(
                case_library::league(league.name())
                    .map_or(&[][..], |built_in| built_in.names)
                    .iter()
                    .copied(),
            ),
            cases: None,
            controller: None,
            start: None,
        }
    }
}

impl GameConfig {
    /// The same between these two.
    pub fn between(mut self, blue: Team, yellow: Team) -> Self {
        for setup in &mut self.teams {
            setup.plays = if setup.colour == Colour::Blue { blue } else { yellow };
            // A team that stands cannot place a ball, and the referee does not wait for it to.
            self.referee.team_mut(setup.colour).can_place_ball &= setup.plays != Team::Idle;
            // Its robots are moved manually where they block the match.
            self.referee.team_mut(setup.colour).drives &= setup.plays != Team::Idle;
        }
        self
    }
}

impl GameConfig {
    /// The same from this moment on: robots, keepers and ends are its own.
    pub fn starting_from(mut self, start: Arc<GameStart>) -> Self {
        self.referee.blue_on_positive_half = start.blue_on_positive;
        for setup in &mut self.teams {
            self.referee.team_mut(setup.colour).keeper = start.referee.keeper(setup.colour);
            setup.robots = start.robots(setup.colour).count() as u8;
        }
        self.start = Some(start);
        self
    }

    /// Strategy of a side's open play.
    pub fn plays(&self, colour: Colour) -> Team {
        self.teams.iter().find(|setup| setup.colour == colour).map_or(Team::Ours, |setup| setup.plays)
    }
}

impl TeamSetup {
    pub(super) fn brain(&self, league: League, id: protocol::RobotId) -> BrainConfig {
        BrainConfig {
            approach: self.approach,
            settings: self.settings.clone(),
            ..BrainConfig::hosted(id, TeamId::of(self.colour), league)
        }
    }
}

impl GameConfig {
    /// The settings that a team's host starts with.
    pub fn host_settings(&self, colour: Colour) -> host::HostSettings {
        super::side::host_settings(self, colour)
    }
}
