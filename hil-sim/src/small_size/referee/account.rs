//! `account`: a team's account. Goals, fouls, cards, placements, time-outs (rules: sanctions, game
//! structure).

use protocol::{Instant, RobotId, Who};
use rules::{Colour, limits};

use super::event::RefereeEvent;
use super::micros;
use super::settings::TeamSettings;

/// State of one team in the match.
#[derive(Clone, Debug)]
pub struct Account {
    /// Name on the wire.
    pub name: String,
    /// Keeper's shell number.
    pub keeper: RobotId,
    /// Number of goals that count.
    pub score: u32,
    /// Fouls that count towards cards, oldest first.
    pub(super) fouls: Vec<RefereeEvent>,
    /// Playing time left of each active yellow card, µs.
    pub yellow_cards: Vec<i64>,
    /// Yellow cards ever given.
    pub yellow_cards_given: u32,
    /// Number of red cards given.
    pub red_cards: u32,
    /// True for a team that is able to place the ball.
    pub can_place_ball: bool,
    /// Number of failed placements minus successful ones.
    pub placement_failures: u32,
    /// True after too many failures to place again in this half.
    pub placement_blocked: bool,
    /// Number of time-outs left.
    pub timeouts: u32,
    /// Time left for time-outs, µs.
    pub timeout_left: i64,
    pub(super) timeout_wanted: Option<i64>,
    /// Time of the last yellow card.
    pub(super) carded: Option<Instant>,
    /// Robots taken off for cards, in this order.
    pub(super) taken_off: Vec<RobotId>,
    /// The last robot that committed a foul.
    pub(super) last_offender: Option<RobotId>,
}

impl Account {
    pub(super) fn new(settings: &TeamSettings) -> Self {
        Self {
            name: settings.name.clone(),
            keeper: settings.keeper,
            score: 0,
            fouls: Vec::new(),
            yellow_cards: Vec::new(),
            yellow_cards_given: 0,
            red_cards: 0,
            can_place_ball: settings.can_place_ball,
            placement_failures: 0,
            placement_blocked: false,
            timeouts: limits::TIMEOUTS,
            timeout_left: micros(limits::TIMEOUT_TIME),
            timeout_wanted: None,
            carded: None,
            taken_off: Vec::new(),
            last_offender: None,
        }
    }

    /// Fouls that count towards cards.
    pub fn foul_count(&self) -> u32 {
        self.fouls.len() as u32
    }

    /// Number of robots it may have now.
    pub fn allowed(&self, most: u32) -> u32 {
        most.saturating_sub(self.yellow_cards.len() as u32 + self.red_cards)
    }

    /// True for a team that may place the ball now.
    pub fn places(&self) -> bool {
        self.can_place_ball && !self.placement_blocked
    }

    /// Gives a yellow card for that playing time; false where it must be a red one.
    pub(super) fn show_yellow(&mut self, now: Instant, playing_us: i64) -> bool {
        if self.yellow_cards.len() as u32 >= limits::YELLOW_CARDS_MAX {
            return false;
        }
        self.yellow_cards.push(playing_us);
        self.yellow_cards_given += 1;
        self.carded = Some(now);
        true
    }

    pub(super) fn show_red(&mut self, now: Instant) {
        self.red_cards += 1;
        self.carded = Some(now);
    }

    /// Counts down its cards by playing time `us`.
    pub(super) fn play(&mut self, us: i64) {
        for left in &mut self.yellow_cards {
            *left -= us;
        }
        self.yellow_cards.retain(|left| *left > 0);
    }

    pub(super) fn placed(&mut self, succeeded: bool) {
        if succeeded {
            self.placement_failures = self.placement_failures.saturating_sub(1);
        } else {
            self.placement_failures += 1;
            self.placement_blocked |= self.placement_failures >= limits::PLACEMENT_FAILURES_MAX;
        }
    }

    pub(super) fn begin_half(&mut self) {
        self.placement_failures = 0;
        self.placement_blocked = false;
    }

    /// The last foul that did not stop the game.
    pub(super) fn last_non_stopping_foul(&self) -> Option<&RefereeEvent> {
        self.fouls.iter().rev().find(|foul| foul.what.kind().is_non_stopping_foul())
    }
}

/// State of both teams.
#[derive(Clone, Debug)]
pub struct Accounts {
    /// Account of team yellow.
    pub yellow: Account,
    /// Account of team blue.
    pub blue: Account,
}

impl Accounts {
    /// The account of team `colour`.
    pub fn of(&self, colour: Colour) -> &Account {
        colour.pick(&self.yellow, &self.blue)
    }

    pub(super) fn of_mut(&mut self, colour: Colour) -> &mut Account {
        colour.pick(&mut self.yellow, &mut self.blue)
    }

    pub(super) fn both_mut(&mut self) -> [&mut Account; 2] {
        [&mut self.yellow, &mut self.blue]
    }

    /// True for the keeper of its team.
    pub fn is_keeper(&self, who: Who) -> bool {
        self.of(who.colour).keeper == who.id
    }
}
