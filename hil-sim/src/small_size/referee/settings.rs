//! `settings`: settings of a match. Everything that the rules leave to the organisers or to manual acts.

use protocol::{Duration, RobotId};
use rules::{Colour, League};

/// Time that counts down in a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatchClock {
    /// Playing time, as in the rules: it stands still in halt, stop, placement and preparation. Per half; 300
    /// s by the rules.
    Playing {
        /// Length of each half.
        half: Duration,
    },
    /// Simulated time, so that a match has the configured length: the first half ends half-way, the match
    /// when this much simulated time is over, however much was played.
    Simulated {
        /// From the first observation to the end.
        total: Duration,
    },
}

/// Settings of one team.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TeamSettings {
    /// Name on the wire.
    pub name: String,
    /// Keeper's shell number.
    pub keeper: RobotId,
    /// True for a team that can place the ball. (Optional in division B, required in division A.)
    pub can_place_ball: bool,
    /// True for a team whose robots drive. Of one whose robots do not, those that block the match are moved
    /// by hand, and all of them at half-time.
    pub drives: bool,
}

/// Settings of the internal referee.
#[derive(Clone, Debug, PartialEq)]
pub struct RefereeSettings {
    /// League: field, ball, robots and the rules that differ between divisions.
    pub league: League,
    /// Time that counts down in a half.
    pub clock: MatchClock,
    /// Pause between the halves, in simulated time. 300 s by the rules, for human teams; programs need none,
    /// so 3 s.
    pub half_time: Duration,
    /// True where a draw is no possible result: overtime of half a half each, then a shoot-out. Their time is
    /// added to the match, to `MatchClock::Simulated` too.
    pub knockout: bool,
    /// True where blue's goal is at +x in the first half. The teams change ends at half-time.
    pub blue_on_positive_half: bool,
    /// The team that kicks off first; the other does in the second half.
    pub first_kickoff: Colour,
    /// True where every third foul gives a yellow card; else fouls are only counted.
    pub cards: bool,
    /// Maximum number of robots of a team without cards; `None` for the division's number.
    pub max_robots: Option<u8>,
    /// True to judge pushing and holding too, which the rules leave to the human referee.
    pub judge_manual_fouls: bool,
    /// Send `designated_position` whenever a place is known, in every command, as the real game controller
    /// does (contrary to its own documentation), instead of in ball placement only.
    pub position_always: bool,
    /// Added to simulated time to give the packets' timestamps, µs: 0, or Unix time at the simulation's
    /// start.
    pub epoch_us: u64,
    /// Delay before the ball is placed by hand, and time that robots get to prepare before a restart: 2 s,
    /// the game controller's "preparation time before resume".
    pub person_delay: Duration,
    /// Time that an obstacle may prevent the game from continuing before the match is reported as blocked: 10
    /// s, as long as the game controller gives after a halt. The game keeps waiting after it, as with the
    /// game controller.
    pub patience: Duration,
    /// Minimum duration of a halt: 3 s, so that a robot still moving after the rules' grace of 2 s is seen.
    pub halt: Duration,
    /// Settings of team yellow.
    pub yellow: TeamSettings,
    /// Settings of team blue.
    pub blue: TeamSettings,
}

impl TeamSettings {
    /// A team with keeper 0 that places the ball and whose robots drive.
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), keeper: KEEPER, can_place_ball: true, drives: true }
    }
}

impl RefereeSettings {
    /// A match of that league by the rules: 2 × 300 s of playing time, blue defends +x, yellow kicks off,
    /// cards.
    pub fn new(league: League) -> Self {
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
            epoch_us: 0,
            person_delay: Duration::millis(2_000),
            patience: Duration::millis(10_000),
            halt: Duration::millis(3_000),
            yellow: TeamSettings::new("yellow"),
            blue: TeamSettings::new("blue"),
        }
    }

    /// Settings of one team.
    pub fn team_mut(&mut self, colour: Colour) -> &mut TeamSettings {
        colour.pick(&mut self.yellow, &mut self.blue)
    }

    /// Settings of one team.
    pub fn team(&self, colour: Colour) -> &TeamSettings {
        colour.pick(&self.yellow, &self.blue)
    }
}

/// Default shell number of the keeper: 0, as with most teams.
const KEEPER: RobotId = match RobotId::new(0) {
    Some(id) => id,
    None => unreachable!(),
};
