//! `scene`: one moment as data that JSON can represent; m, m/s, rad, s, field frame.
//!
//! Everything but time and field may be missing: a league's log file has no robot states, a real field no
//! truth. The page displays what is there.

use serde::{Deserialize, Serialize};

use crate::request::Team;
use crate::shape::Layer;

/// One moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Seconds since the beginning.
    pub t: f64,
    /// The lines.
    pub field: Field,
    /// The ball, where it is known.
    pub ball: Option<Ball>,
    /// All robots on the field, as filtered.
    pub robots: Vec<Robot>,
    /// What cameras saw, before any filter.
    pub raw: Raw,
    /// The match so far.
    pub game: Match,
    /// The newest cycle of each team that reports one.
    pub cycles: Vec<Cycle>,
    /// What more can be drawn, by name.
    pub layers: Vec<Layer>,
    /// Numbers that are displayed and plotted.
    pub gauges: Vec<Gauge>,
    /// What is wrong now and an operator should act on, each in a sentence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alarms: Vec<String>,
    /// Number of events up to now.
    pub happened: u64,
    /// It is paused by a viewer.
    pub paused: bool,
    /// Simulated seconds a second; 0 where the pace is not ours to set.
    pub speed: f32,
    /// Where chance comes from, in a simulation.
    pub seed: Option<u64>,
}

/// The lines of the field, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Along x.
    pub length: f32,
    /// Along y.
    pub width: f32,
    /// Beyond touch and goal lines.
    pub margin: f32,
    /// Between the posts.
    pub goal_width: f32,
    /// Of the net.
    pub goal_depth: f32,
    /// Of the defence area, along x.
    pub area_depth: f32,
    /// Of the defence area, along y; for quarter circles the stretch between them.
    pub area_width: f32,
    /// The defence area is two quarter circles of this radius and a stretch between them; none: a rectangle.
    pub area_radius: Option<f32>,
    /// Of the centre circle; 0 where there is none.
    pub centre_radius: f32,
    /// Of a robot.
    pub robot_radius: f32,
    /// Of the ball.
    pub ball_radius: f32,
}

/// The ball.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ball {
    /// Where.
    pub at: [f32; 2],
    /// Above the field surface.
    pub height: f32,
    /// Along the field surface.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// Where it was, oldest first.
    pub trail: Vec<[f32; 2]>,
    /// Where it will be if no robot intercepts it, a tenth of a second from one to the next.
    pub ahead: Vec<[f32; 2]>,
}

/// A robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Robot {
    /// Whose.
    pub team: Team,
    /// Its number.
    pub id: u8,
    /// Where.
    pub at: [f32; 2],
    /// Where it faces.
    pub heading: f32,
    /// How it moves.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// What it thinks, where its host is ours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mind: Option<Mind>,
    /// Its hardware state, if it reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vitals: Option<Vitals>,
}

/// Why a robot does what it does.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mind {
    /// Its role in the team: "keeper", "defender 1", "taker".
    pub role: String,
    /// Its order: "go to (1.2, 0.4)".
    pub directive: String,
    /// What decided that.
    pub why: String,
    /// The state of the reuse machine: "adapt", "execute", "wait end", "idle".
    pub state: String,
    /// Which step of that state.
    pub step: String,
    /// The case it plays and the part it has in it: "centre/pass-around, robot 2".
    pub part: String,
    /// What it does by itself while no case binds it.
    pub reactive: String,
    /// Where it wants to be, and how it gets there.
    pub intent: Intent,
    /// What runs, s.
    pub timers: Vec<Timer>,
}

/// Where a robot wants to be.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Intent {
    /// From where it is to where it will be, a tenth of a second from one point to the next as far as its motion was planned; a
    /// straight line from there on, and for robots whose motion is not known here.
    pub path: Vec<[f32; 2]>,
    /// Where it wants the ball.
    pub ball_to: Option<[f32; 2]>,
}

/// Something that runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timer {
    /// What.
    pub name: String,
    /// For how long, s.
    pub seconds: f32,
}

/// How a robot and its link are.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vitals {
    /// V; none where it is not measured.
    pub battery: Option<f32>,
    /// Since its last frame was received, ms.
    pub silence_ms: Option<f32>,
    /// Round trip, ms.
    pub trip_ms: Option<f32>,
    /// Of our frames that it did not receive, percent.
    pub loss_down: Option<f32>,
    /// Of its frames that we did not receive, percent.
    pub loss_up: Option<f32>,
    /// Frames received from it a second.
    pub frames: Option<f32>,
    /// Frames that it refused.
    pub refused: u32,
    /// How often it was seen to boot.
    pub lives: u32,
    /// Since a camera last saw it, ms.
    pub unseen_ms: f32,
    /// What is to be looked at: "tipped", "battery low", "link lost".
    pub faults: Vec<String>,
    /// The ball is at its dribbler.
    pub ball: bool,
    /// Its kicker is charged.
    pub kicker: bool,
}

/// What cameras saw.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Raw {
    /// Balls.
    pub balls: Vec<[f32; 2]>,
    /// Robots: team, number, x, y, heading.
    pub robots: Vec<(Team, u8, f32, f32, f32)>,
}

/// The match so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Match {
    /// What may be done now, as text.
    pub phase: String,
    /// What follows the stop, as text; empty while unknown.
    pub next: String,
    /// The part of the match, as text.
    pub stage: String,
    /// Playing time left in it, s.
    pub stage_left: Option<f32>,
    /// Time left for placement, kick-off or free kick, s.
    pub action_left: Option<f32>,
    /// Where the ball is to be placed.
    pub placement: Option<[f32; 2]>,
    /// Share of the time in which the ball was in play, where it is counted.
    pub in_play: Option<f32>,
    /// Both teams.
    pub teams: PerTeam<TeamSheet>,
}

/// Something of both teams.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PerTeam<T> {
    /// Blue's.
    pub blue: T,
    /// Yellow's.
    pub yellow: T,
}

/// One team's sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TeamSheet {
    /// Its name.
    pub name: String,
    /// Goals.
    pub score: u32,
    /// +1 where it defends the goal at +x, −1 at −x, 0 while unknown.
    pub defends: i8,
    /// Its keeper's number.
    pub keeper: Option<u8>,
    /// Robots it may have now.
    pub allowed: Option<u32>,
    /// Seconds left of each yellow card.
    pub yellow_cards: Vec<f32>,
    /// Red cards.
    pub red_cards: u32,
    /// Fouls that count towards a card.
    pub fouls: u32,
    /// Time-outs left.
    pub timeouts: u32,
    /// Share of the possession so far, where it is counted.
    pub possession: Option<f32>,
    /// Time of the ball in the opponents' half over that in the own (Biswas et al. 2014).
    pub offence_ratio: Option<f32>,
    /// Own shots over the opponents'.
    pub attack_ratio: Option<f32>,
    /// Shots, chances, passes: name and number.
    pub counts: Vec<(String, u32)>,
}

/// A retrieve–reuse cycle of a team.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Whose.
    pub team: Option<Team>,
    /// Its number.
    pub number: u32,
    /// Number of its coordinator.
    pub coordinator: u8,
    /// "deciding", "no case", "playing", "finished", or why it was stopped.
    pub state: String,
    /// `region/name` of its case.
    pub case: String,
    /// Which copy of it.
    pub symmetry: String,
    /// What its author meant.
    pub meant: String,
    /// Players: robot's number for case robot 1, 2, …
    pub players: Vec<u8>,
    /// Since it started, s.
    pub seconds: f32,
}

/// A number to be displayed and plotted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gauge {
    /// Under which heading.
    pub group: String,
    /// What.
    pub name: String,
    /// How much.
    pub value: f32,
    /// Of what.
    pub unit: String,
    /// More than this (or less, where it is negative: less than its absolute) is bad.
    pub limit: Option<f32>,
}

impl<T> PerTeam<T> {
    /// That team's.
    pub fn of(&self, team: Team) -> &T {
        match team {
            Team::Blue => &self.blue,
            Team::Yellow => &self.yellow,
        }
    }

    /// That team's, to be filled.
    pub fn of_mut(&mut self, team: Team) -> &mut T {
        match team {
            Team::Blue => &mut self.blue,
            Team::Yellow => &mut self.yellow,
        }
    }
}
