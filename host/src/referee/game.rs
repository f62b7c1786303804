//! `game`: game state as the referee reports it. Phase, stage, times, teams and sides, from the newest packet
//! and the state of the game. SI, field frame; times left in s.

use geometry::{Field, GoalEnd, Point};
use protocol::RobotId;
use rules::state::{GameState, Stage};
use rules::{Colour, Phase};
use ssl::referee::{HullColor, MatchType, Referee, TeamInfo};

use super::description;

/// No field reaches farther from its centre than this, m: a designated position beyond it is refused.
const POSITION_MAX_M: f32 = 20.0;

/// The game by the referee's packets and the ball's motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Game {
    /// The phase that is obeyed now.
    pub phase: Phase<Colour>,
    /// The phase after the current stop, if the referee sends it.
    pub next: Option<Phase<Colour>>,
    /// Place for the ball; only while it is ([`Phase::BallPlacement`]), even if packets of other
    /// phases have one (trap 3).
    pub placement: Option<Point<Field>>,
    /// The part of the match.
    pub stage: Stage,
    /// Playing time left in it, s; negative when it ran over.
    pub stage_time_left: Option<f32>,
    /// Time left for placement, free kick, kick-off or penalty, s; negative when it ran over.
    pub action_time_left: Option<f32>,
    /// The goal that blue defends, once the referee has sent it.
    pub blue_goal: Option<GoalEnd>,
    /// Kind of match: friendly, group phase, elimination.
    pub match_type: MatchType,
    /// Text of the referee on what it waits for.
    pub status: String,
    /// Yellow's and blue's account, in this order.
    pub teams: [TeamAccount; 2],
    /// The designated position of the newest packet, in any phase.
    designated: Option<Point<Field>>,
    next_command: Option<i32>,
}

impl Default for Game {
    fn default() -> Self {
        Self {
            phase: Phase::Halt,
            next: None,
            placement: None,
            stage: Stage::FirstHalfPre,
            stage_time_left: None,
            action_time_left: None,
            blue_goal: None,
            match_type: MatchType::Unknown,
            status: String::new(),
            teams: Default::default(),
            designated: None,
            next_command: None,
        }
    }
}

/// State of one team as the referee reports it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TeamAccount {
    /// Name of the team; empty while unknown.
    pub name: String,
    /// Number of goals scored.
    pub score: u32,
    /// The keeper's number, if it is one a robot can have.
    pub keeper: Option<RobotId>,
    /// Number of red cards.
    pub red_cards: u32,
    /// Number of yellow cards ever given.
    pub yellow_cards: u32,
    /// Time left of each yellow card that still counts, s.
    pub yellow_card_times: Vec<f32>,
    /// Fouls that count towards the next yellow card.
    pub fouls: u32,
    /// Robots it may have on the field now, if the referee sends it.
    pub robots_allowed: Option<u32>,
    /// Number of time-outs left.
    pub timeouts: u32,
    /// Time left for time-outs, s.
    pub timeout_time: f32,
    /// Whether it may place the ball: it can, and has not failed too often; if the referee does not send it,
    /// it may.
    pub may_place: bool,
    /// Number of failed placements that count.
    pub placement_failures: u32,
    /// Whether it has requested a substitution.
    pub substitution_wanted: bool,
    /// Whether it may substitute now.
    pub substitution_allowed: bool,
    /// Substitutions left in this half, if the referee sends it.
    pub substitutions_left: Option<u32>,
    /// Time left for the running substitution, s.
    pub substitution_time_left: f32,
    /// Whether its hulls are dark; none where the referee does not send it.
    pub dark_hulls: Option<bool>,
}

impl Game {
    /// The account of the team of that colour.
    pub fn team(&self, colour: Colour) -> &TeamAccount {
        &self.teams[colour as usize]
    }

    /// The goal that a team defends, once the referee has sent it.
    pub fn own_goal(&self, colour: Colour) -> Option<GoalEnd> {
        self.blue_goal.map(|goal| if colour == Colour::Blue { goal } else { goal.opposite() })
    }

    /// Takes all fields of a packet except its command.
    pub(super) fn read(&mut self, packet: &Referee) {
        let place = |mm: f32| mm / 1000.0;
        self.stage = description::stage_of(packet.stage).unwrap_or(self.stage);
        self.stage_time_left = packet.stage_time_left.map(seconds);
        self.action_time_left = packet.current_action_time_remaining.map(seconds);
        self.designated = packet.designated_position.map(|at| Point::new(place(at.x), place(at.y)));
        // Not finite fails the comparison too.
        self.designated =
            self.designated.filter(|at| at.x().abs() < POSITION_MAX_M && at.y().abs() < POSITION_MAX_M);
        let goal = |positive| if positive { GoalEnd::Positive } else { GoalEnd::Negative };
        self.blue_goal = packet.blue_team_on_positive_half.map(goal).or(self.blue_goal);
        self.match_type = packet.match_type();
        self.status.clear();
        self.status.push_str(packet.status_message());
        self.next_command = packet.next_command;
        self.teams[Colour::Yellow as usize].read(&packet.yellow);
        self.teams[Colour::Blue as usize].read(&packet.blue);
    }

    /// Takes the state of the game; `phase` is the one that is obeyed, which may be stricter.
    pub(super) fn stands(&mut self, state: &GameState, phase: Phase<Colour>) {
        self.phase = phase;
        let placing = matches!(self.phase, Phase::BallPlacement(_));
        self.placement = self.designated.filter(|_| placing);
        // The next phase is unknown where another phase is imposed.
        let next = self.next_command.filter(|_| phase == state.phase()).and_then(description::command_of);
        self.next = next.and_then(|command| command.leads_to(self.phase));
    }

    /// Place where the ball is being put, by robots or by hand: in ball placement, and in the stop before a
    /// free kick or penalty. In other phases packets hold a place too, that of an earlier phase (trap 3).
    pub fn ball_goes_to(&self) -> Option<Point<Field>> {
        let follows = matches!(self.next, Some(Phase::FreeKick(_) | Phase::PreparePenalty(_)));
        let by_hand = self.phase == Phase::Stop && follows;
        self.designated.filter(|_| by_hand).or(self.placement)
    }
}

impl TeamAccount {
    fn read(&mut self, info: &TeamInfo) {
        let micros = |time: u32| seconds(i64::from(time));
        if self.name != info.name {
            self.name.clone_from(&info.name);
        }
        self.score = info.score;
        self.keeper = u8::try_from(info.goalkeeper).ok().and_then(RobotId::new);
        self.red_cards = info.red_cards;
        self.yellow_cards = info.yellow_cards;
        self.yellow_card_times.clear();
        self.yellow_card_times.extend(info.yellow_card_times.iter().map(|time| micros(*time)));
        self.fouls = info.foul_counter();
        self.robots_allowed = info.max_allowed_bots;
        self.timeouts = info.timeouts;
        self.timeout_time = micros(info.timeout_time);
        self.may_place = info.can_place_ball.unwrap_or(true) && !info.ball_placement_failures_reached();
        self.placement_failures = info.ball_placement_failures();
        self.substitution_wanted = info.bot_substitution_intent();
        self.substitution_allowed = info.bot_substitution_allowed();
        self.substitutions_left = info.bot_substitutions_left;
        self.substitution_time_left = micros(info.bot_substitution_time_left());
        self.dark_hulls = match info.hull_color() {
            HullColor::Unknown => None,
            HullColor::Dark => Some(true),
            HullColor::Light => Some(false),
        };
    }
}

/// Converts µs to s.
fn seconds(micros: i64) -> f32 {
    (micros as f64 * 1e-6) as f32
}
