//! `settings`: settings of a match. Everything about it that the rules leave to the organisers or to people.

use protocol::{Duration, RobotId};
use rules::{Colour, League};

/// What runs down in a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchClock {
    /// Playing time, as the rules have it: it stands still in halt, stop, placement and preparation. Per half; the rules
    /// say 300 s.
    Playing {
        /// Length of each half.
        half: Duration,
    },
    /// Simulated time, so that a match has the length that was asked for: the first half ends half-way, the match when
    /// this much simulated time is over, whatever was played.
    Simulated {
        /// From the first observation to the end.
        total: Duration,
    },
}

/// One team's part of the settings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TeamSettings {
    /// Its name on the wire.
    pub name: String,
    /// Its keeper's shell number.
    pub keeper: RobotId,
    /// Can it place the ball? (Division B may do without, division A must not.)
    pub can_place_ball: bool,
    /// Do its robots drive? Where not, people carry those that block the match, and all of them at half-time.
    pub drives: bool,
}

/// How the internal referee runs a match.
#[derive(Clone, Debug, PartialEq)]
pub struct RefereeSettings {
    /// Field, ball, robots and the rules that differ between divisions.
    pub league: League,
    /// What runs down in a half.
    pub clock: MatchClock,
    /// Pause between the halves, in simulated time. The rules say 300 s for people; programs need none, so 3 s.
    pub half_time: Duration,
    /// A draw is no possible outcome: overtime of half a half each, then a shoot-out. Their time is added to the match,
    /// to `MatchClock::Simulated` too.
    pub knockout: bool,
    /// Is blue's goal at +x in the first half? They change at half-time.
    pub blue_on_positive_half: bool,
    /// Who kicks off first; the other does in the second half.
    pub first_kickoff: Colour,
    /// Are yellow cards given for every third foul? Where not, fouls are only counted.
    pub cards: bool,
    /// Most robots a team may have without cards; `None` for the division's number.
    pub max_robots: Option<u8>,
    /// Judge what the rules leave to the human referee as well: pushing and holding.
    pub judge_manual_fouls: bool,
    /// Send `designated_position` whenever a place is known, in every command, as the real game controller does
    /// (contrary to its own documentation), instead of in ball placement only.
    pub position_always: bool,
    /// Announce a goal by one packet with the old commands `GOAL_*`, as the real game controller does.
    pub legacy_goal_command: bool,
    /// Added to simulated time to make the packets' timestamps, µs: 0, or Unix time at the simulation's start.
    pub epoch_us: u64,
    /// Time a person needs to put the ball down, and robots get to prepare before a restart: 2 s, the game
    /// controller's "preparation time before resume".
    pub person_delay: Duration,
    /// How long something may keep the game from going on before the match is said to be blocked: 10 s, as long as the game
    /// controller gives after a halt. The game waits for longer, as the game controller does.
    pub patience: Duration,
    /// How long a halt lasts once it is given: 3 s, so that a robot still moving after the rules' grace of 2 s is seen.
    pub halt: Duration,
    /// Yellow's part.
    pub yellow: TeamSettings,
    /// Blue's part.
    pub blue: TeamSettings,
}

impl RefereeSettings {
    /// A match of that league by the rules: 2 × 300 s of playing time, blue defends +x, yellow kicks off, cards.
    pub fn new(league: League) -> Self {
        let team = |name: &str| TeamSettings {
            name: name.into(),
            keeper: KEEPER,
            can_place_ball: true,
            drives: true,
        };
        Self {
            league,
            clock: MatchClock::Playing { half: Duration::millis(300_000) },
            half_time: Duration::millis(3_000),
            knockout: false,
            blue_on_positive_half: true,
            first_kickoff: Colour::Yellow,
            cards: true,
            max_robots: None,
            judge_manual_fouls: true,
            position_always: true,
            legacy_goal_command: true,
            epoch_us: 0,
            person_delay: Duration::millis(2_000),
            patience: Duration::millis(10_000),
            halt: Duration::millis(3_000),
            yellow: team("yellow"),
            blue: team("blue"),
        }
    }

    /// One team's part.
    pub fn team_mut(&mut self, colour: Colour) -> &mut TeamSettings {
        match colour {
            Colour::Yellow => &mut self.yellow,
            Colour::Blue => &mut self.blue,
        }
    }

    /// One team's part.
    pub fn team(&self, colour: Colour) -> &TeamSettings {
        match colour {
            Colour::Yellow => &self.yellow,
            Colour::Blue => &self.blue,
        }
    }
}

/// The keeper unless somebody says otherwise: shell number 0, as most teams have it.
const KEEPER: RobotId = match RobotId::new(0) {
    Some(id) => id,
    None => unreachable!(),
};
