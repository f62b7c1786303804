//! `scene`: one moment as data that JSON can represent; m, m/s, rad, s, field frame.
//!
//! Everything but time and field may be missing: a league's log file has no robot states, a real field no
//! truth. The page displays what is there.

use serde::{Deserialize, Serialize};

use crate::match_event::DecisionNote;
use crate::request::PageTeam;
use crate::shape::Layer;

/// One moment of a match.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Seconds since the start.
    pub t: f64,
    /// The lines of the field, m.
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
    /// Cameras that have sent something, by number.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<CameraNote>,
    /// Numbers that are displayed and plotted.
    pub gauges: Vec<Gauge>,
    /// Faults that an operator should act on now, each in a sentence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alarms: Vec<String>,
    /// The same as objects: part, what, evidence, remedy, and since when, s.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<serde_json::Value>,
    /// Our robots at a glance, an object each (docs/start.md).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub glance: Vec<serde_json::Value>,
    /// State of our team by the game controller's remote control (docs/case-format.md §5.6).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remote: Option<serde_json::Value>,
    /// Number of events up to now.
    pub happened: u64,
    /// True while a viewer has paused the match.
    pub paused: bool,
    /// Simulated seconds a second; 0 where the pace is not ours to set.
    pub speed: f32,
    /// Random seed, in a simulation.
    pub seed: Option<u64>,
    /// The match is over: no scene follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<MatchEnd>,
}

/// The end of a match that its program does not end with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MatchEnd {
    /// A viewer may start another match.
    pub another: bool,
}

/// The lines of the field, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Length between the goal lines, along x.
    pub length: f32,
    /// Width between the touch lines, along y.
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

/// The ball, as the host's tracking estimates it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneBall {
    /// Position of its centre, m.
    pub at: [f32; 2],
    /// Above the field surface.
    pub height: f32,
    /// Along the field surface.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// Past positions, oldest first.
    pub trail: Vec<[f32; 2]>,
    /// Positions to come if no robot intercepts the ball, a tenth of a second apart.
    pub ahead: Vec<[f32; 2]>,
}

/// A robot of either team, as filtered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRobot {
    /// Team of the robot.
    pub team: PageTeam,
    /// The robot's number in its team.
    pub id: u8,
    /// Position of its centre, m.
    pub at: [f32; 2],
    /// Heading, rad, counter-clockwise from +x.
    pub heading: f32,
    /// Velocity of its centre, m/s.
    pub velocity: [f32; 2],
    /// 0 (lost) to 1 (seen just now).
    pub confidence: f32,
    /// State of its decisions, where its host is ours.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "mind")]
    pub detail: Option<RobotDetail>,
    /// Hardware state, if the robot reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vitals: Option<Vitals>,
}

/// State of a robot's decisions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotDetail {
    /// Role in the team: "keeper", "defender 1", "taker".
    pub role: String,
    /// Order of the host: "go to (1.2, 0.4)".
    pub directive: String,
    /// Reason of the directive.
    pub why: String,
    /// The state of the reuse machine: "adapt", "execute", "wait end", "idle".
    pub state: String,
    /// Current step of that state.
    pub step: String,
    /// The case it plays and the part it has in it: "centre/pass-around, robot 2".
    pub part: String,
    /// Reactive behaviour while the robot plays no case.
    pub reactive: String,
    /// True while the robot can be given a part in a case: its host lets it, and it reports so.
    #[serde(default)]
    pub available: bool,
    /// Target and planned path.
    pub intent: Intent,
    /// Timers of its role and state, s.
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

/// A timer of a robot: how long a role or state has lasted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timer {
    /// Name with the role or state.
    pub name: String,
    /// Time since the last change, s.
    pub seconds: f32,
}

/// State of a robot's hardware and its link.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vitals {
    /// Voltage, V; `None` where it is not measured.
    pub battery: Option<f32>,
    /// Since its last frame was received, ms.
    pub silence_ms: Option<f32>,
    /// Round trip of a frame, ms.
    pub trip_ms: Option<f32>,
    /// Of our frames that it did not receive, percent.
    pub loss_down: Option<f32>,
    /// Of its frames that we did not receive, percent.
    pub loss_up: Option<f32>,
    /// Frames received from it a second.
    pub frames: Option<f32>,
    /// Over the last second, each with the worst such second within ten.
    #[serde(default)]
    pub link: LinkWindow,
    /// Packets that its base station sent to it; `None` without one that counts them.
    #[serde(default)]
    pub air: Option<AirCounts>,
    /// Since its last telemetry was received, ms.
    #[serde(default)]
    pub telemetry_ms: Option<f32>,
    /// True while the governor limits the order of the logic, by the last telemetry.
    #[serde(default)]
    pub governed: bool,
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
    /// True while the kicker is charged.
    pub kicker: bool,
}

/// A value over the last second, and the worst value over a second within the last ten; each `None` while
/// nothing was measured.
pub type Windowed = [Option<f32>; 2];

/// Packets of a base station to one robot since the base station's start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AirCounts {
    /// Channel, MHz above 2,400.
    pub channel: u8,
    /// Rate on the air, Mbit/s.
    pub megabits: u8,
    /// Packets sent.
    pub sent: u32,
    /// Of those, acknowledged.
    pub acknowledged: u32,
    /// Repeats of them.
    pub repeats: u32,
    /// Not acknowledged in any repeat.
    pub lost: u32,
}

/// A robot's link over windows of 1 s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkWindow {
    /// Mean round trip of a frame, ms; worst is largest.
    pub trip_ms: Windowed,
    /// Of our frames that it did not receive, percent; worst is largest.
    pub loss_down: Windowed,
    /// Of its frames that we did not receive, percent; worst is largest.
    pub loss_up: Windowed,
    /// Frames received from it a second; worst is lowest.
    pub frames: Windowed,
    /// Telemetry received from it a second; worst is lowest.
    pub telemetry: Windowed,
    /// kbit/s of frames, both directions; worst is largest.
    pub kbps: Windowed,
}

/// A camera, by the frames that it sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraNote {
    /// Number of the camera.
    pub id: u32,
    /// Camera frames received a second; worst is lowest.
    pub frames: Windowed,
    /// Mean time from taking a camera frame to sending it, by the sender's clock, ms; worst is largest.
    pub delay_ms: Windowed,
    /// Camera frames lost on the way over a second, by their numbers, percent; worst is largest.
    pub lost: Windowed,
    /// Camera frames lost so far.
    pub lost_total: u64,
    /// Since its last camera frame was received, ms.
    pub age_ms: f32,
}

/// Detections of the cameras.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Raw {
    /// Positions of detected balls, m.
    pub balls: Vec<[f32; 2]>,
    /// Robots: team, number, x, y, heading.
    pub robots: Vec<(PageTeam, u8, f32, f32, f32)>,
}

/// The match so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Match {
    /// Phase of the game, as text.
    pub phase: String,
    /// Restart after the stop, as text; empty while unknown.
    pub next: String,
    /// The part of the match, as text.
    pub stage: String,
    /// Playing time left in it, s.
    pub stage_left: Option<f32>,
    /// Time left for placement, kick-off or free kick, s.
    pub action_left: Option<f32>,
    /// Target position of a placement, m.
    pub placement: Option<[f32; 2]>,
    /// Share of the time in which the ball was in play, where it is counted.
    pub in_play: Option<f32>,
    /// Score and state of both teams.
    pub teams: PerTeam<TeamSheet>,
}

/// A value for both teams.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PerTeam<T> {
    /// The value of team blue.
    pub blue: T,
    /// The value of team yellow.
    pub yellow: T,
}

/// Score, cards and statistics of one team.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TeamSheet {
    /// The team's name by the game controller.
    pub name: String,
    /// Number of goals scored.
    pub score: u32,
    /// +1 where it defends the goal at +x, −1 at −x, 0 while unknown.
    pub defends: i8,
    /// Number of its keeper, by the referee.
    pub keeper: Option<u8>,
    /// Robots it may have now.
    pub allowed: Option<u32>,
    /// Seconds left of each yellow card.
    pub yellow_cards: Vec<f32>,
    /// Number of red cards given.
    pub red_cards: u32,
    /// Fouls that count towards a card.
    pub fouls: u32,
    /// Number of time-outs left.
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
    /// The team that plays it.
    pub team: Option<PageTeam>,
    /// Number of the cycle, counted by the team.
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
    /// The team's newest decision, with its problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decided: Option<DecisionNote>,
}

/// A number to be displayed and plotted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gauge {
    /// Heading of its group.
    pub group: String,
    /// Name of the value, within its group.
    pub name: String,
    /// Newest value, in `unit`.
    pub value: f32,
    /// Unit, as displayed behind the value.
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
