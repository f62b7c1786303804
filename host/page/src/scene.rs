//! `scene`: one moment as data that JSON can represent; m, m/s, rad, s, field frame.
//!
//! Everything but time and field may be missing: a league's log file has no robot states, a real field no
//! truth. The page displays what is there.

use serde::{Deserialize, Serialize};

use crate::request::PageTeam;
use crate::shape::Layer;

/// One moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Seconds since the start.
    pub t: f64,
    /// The lines.
    pub field: Field,
    /// The ball, where it is known.
    pub ball: Option<SceneBall>,
    /// All robots on the field, as filtered.
    pub robots: Vec<SceneRobot>,
    /// Detections of the cameras, before any filter.
    pub raw: Raw,
    /// The match so far.
    pub game: Match,
    /// The newest cycle of each team that reports one.
    pub cycles: Vec<Cycle>,
    /// Further overlays, by name.
    pub layers: Vec<Layer>,
    /// Numbers that are displayed and plotted.
    pub gauges: Vec<Gauge>,
    /// Faults that an operator should act on now, each in a sentence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alarms: Vec<String>,
    /// Number of events up to now.
    pub happened: u64,
    /// It is paused by a viewer.
    pub paused: bool,
    /// Simulated seconds a second; 0 where the pace is not ours to set.
    pub speed: f32,
    /// Random seed, in a simulation.
    pub seed: Option<u64>,
}

/// The lines of the field, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Length along x.
    pub length: f32,
    /// Width along y.
    pub width: f32,
    /// Width of the surface beyond touch and goal lines.
    pub margin: f32,
    /// Width between the posts.
    pub goal_width: f32,
    /// Depth of the net.
    pub goal_depth: f32,
    /// Depth of the defence area, along x.
    pub area_depth: f32,
    /// Width of the defence area, along y; for quarter circles the stretch between them.
    pub area_width: f32,
    /// The defence area is two quarter circles of this radius and a stretch between them; `None`: a
    /// rectangle.
    pub area_radius: Option<f32>,
    /// Radius of the centre circle; 0 where there is none.
    pub centre_radius: f32,
    /// Radius of a robot.
    pub robot_radius: f32,
    /// Radius of the ball.
    pub ball_radius: f32,
}

/// The ball.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneBall {
    /// Position.
    pub at: [f32; 2],
    /// Above the field surface.
    pub height: f32,
    /// Along the field surface.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// Past positions, oldest first.
    pub trail: Vec<[f32; 2]>,
    /// Where it will be if no robot intercepts it, a tenth of a second from one to the next.
    pub ahead: Vec<[f32; 2]>,
}

/// A robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRobot {
    /// Its team.
    pub team: PageTeam,
    /// Its number.
    pub id: u8,
    /// Position.
    pub at: [f32; 2],
    /// Heading.
    pub heading: f32,
    /// Velocity.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// State of its decisions, where its host is ours.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "mind")]
    pub detail: Option<RobotDetail>,
    /// Its hardware state, if it reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vitals: Option<Vitals>,
}

/// Why a robot does what it does.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotDetail {
    /// Its role in the team: "keeper", "defender 1", "taker".
    pub role: String,
    /// Its order: "go to (1.2, 0.4)".
    pub directive: String,
    /// Reason of the directive.
    pub why: String,
    /// The state of the reuse machine: "adapt", "execute", "wait end", "idle".
    pub state: String,
    /// Current step of that state.
    pub step: String,
    /// The case it plays and the part it has in it: "centre/pass-around, robot 2".
    pub part: String,
    /// Its reactive behaviour while it plays no case.
    pub reactive: String,
    /// Target and planned path.
    pub intent: Intent,
    /// Running timers, s.
    pub timers: Vec<Timer>,
}

/// Target and path of a robot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Intent {
    /// From where it is to where it will be, a tenth of a second from one point to the next as far as its
    /// motion was planned; a straight line from there on, and for robots whose motion is not known here.
    pub path: Vec<[f32; 2]>,
    /// Target of the ball.
    pub ball_to: Option<[f32; 2]>,
}

/// A running timer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timer {
    /// Its name.
    pub name: String,
    /// Elapsed time, s.
    pub seconds: f32,
}

/// State of a robot's hardware and its link.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vitals {
    /// Voltage, V; `None` where it is not measured.
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
    /// Number of boots seen.
    pub lives: u32,
    /// Since a camera last saw it, ms.
    pub unseen_ms: f32,
    /// Faults to check: "tipped", "battery low", "link lost".
    pub faults: Vec<String>,
    /// The ball is at its dribbler.
    pub ball: bool,
    /// Its kicker is charged.
    pub kicker: bool,
}

/// Detections of the cameras.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Raw {
    /// Positions of balls.
    pub balls: Vec<[f32; 2]>,
    /// Robots: team, number, x, y, heading.
    pub robots: Vec<(PageTeam, u8, f32, f32, f32)>,
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

/// A value for both teams.
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
    /// Counts of shots, chances and passes, by name.
    pub counts: Vec<(String, u32)>,
}

/// A retrieve–reuse cycle of a team.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Its team.
    pub team: Option<PageTeam>,
    /// Its number.
    pub number: u32,
    /// Number of its coordinator.
    pub coordinator: u8,
    /// "deciding", "no case", "playing", "finished", or why it was stopped.
    pub state: String,
    /// `region/name` of its case.
    pub case: String,
    /// Symmetry of the stored case.
    pub symmetry: String,
    /// Intent of the case, as its author wrote it.
    pub meant: String,
    /// Players: robot's number for case robot 1, 2, …
    pub players: Vec<u8>,
    /// Since it started, s.
    pub seconds: f32,
}

/// A number to be displayed and plotted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gauge {
    /// Heading of its group.
    pub group: String,
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f32,
    /// Its unit.
    pub unit: String,
    /// The value is bad above this limit; for a negative limit: below its absolute value.
    pub limit: Option<f32>,
}

impl<T> PerTeam<T> {
    /// The value of `team`.
    pub fn of(&self, team: PageTeam) -> &T {
        match team {
            PageTeam::Blue => &self.blue,
            PageTeam::Yellow => &self.yellow,
        }
    }

    /// The value of `team`, mutable.
    pub fn of_mut(&mut self, team: PageTeam) -> &mut T {
        match team {
            PageTeam::Blue => &mut self.blue,
            PageTeam::Yellow => &mut self.yellow,
        }
    }
}
