//! `rows`: a recording as a table: the tracked field and the referee, one row per time stamp, columns with
//! units in their names (docs/case-format.md §5.4). m, m/s, rad, rad/s, s, field frame.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use host::tracking::{Tracker, VisionVerdict};
use protocol::{Instant, RobotId};
use rules::Colour;
use serde_json::Value;
use ssl::log::{Packet, Record};
use ssl::referee::{Command, Referee, Stage};
use ssl::tracker::{TeamColor, TrackedFrame};

use super::failure::RecordingFailure;
use super::packets::{LeaguePacket, LeaguePackets};
use crate::referee_event::{RefereeEvent, RefereeEventFinder, number_name};

/// Where positions and velocities come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldSource {
    /// Our tracker, fed with the recording's vision.
    Own,
    /// The tracker packets in the recording; of the source whose packet comes first, or of the one with this
    /// name or identifier.
    Recorded(Option<String>),
}

/// A row: its cells with the names of their columns, in order; unknown values are left out.
pub type Row = Vec<(String, Value)>;

/// Reads the rows of a recording, an iterator.
pub struct Rows<'f> {
    packets: LeaguePackets<'f>,
    source: FieldSource,
    tracker: Tracker,
    finder: RefereeEventFinder,
    referee: Option<Referee>,
    /// The field by the recorded tracker.
    frame: Option<TrackedFrame>,
    /// Identifier of the recorded tracker that is read.
    followed: Option<String>,
    /// Names of all recorded trackers, by their identifiers.
    pub trackers: BTreeMap<String, String>,
    /// Number of packets that could not be decoded.
    pub undecodable: u64,
}

impl<'f> Rows<'f> {
    /// Opens a league log file or a trace.
    pub fn open(file: &'f Path, source: FieldSource) -> Result<Self, RecordingFailure> {
        Ok(Self {
            packets: LeaguePackets::open(file)?,
            source,
            tracker: Tracker::default(),
            finder: RefereeEventFinder::default(),
            referee: None,
            frame: None,
            followed: None,
            trackers: BTreeMap::new(),
            undecodable: 0,
        })
    }

    /// Damage of the file, if it is not whole; known after the last row.
    pub fn damage(&self) -> Option<String> {
        self.packets.damage()
    }

    /// Whether a packet of the recorded tracker that is to be read was found so far.
    pub const fn follows_tracker(&self) -> bool {
        self.followed.is_some()
    }

    /// Reads a packet; returns a row where it updated the tracked field or reported events.
    fn read(&mut self, packet: LeaguePacket) -> Option<Row> {
        let (at, unix_ns) = (packet.at, packet.unix_ns);
        let record = Record { timestamp_ns: unix_ns, kind: packet.kind, payload: packet.bytes };
        let decoded = match record.present() {
            Some((kind, bytes)) => Packet::decode(kind, &bytes),
            None => record.decode().map(|_| None),
        };
        let Ok(decoded) = decoded else {
            self.undecodable += 1;
            return None;
        };
        let mut events = Vec::new();
        let own = self.source == FieldSource::Own;
        let is_row = match decoded? {
            Packet::Vision(packet) if own => {
                let verdict = self.tracker.handle(&packet, at);
                matches!(verdict, VisionVerdict::Newest | VisionVerdict::Restarted)
            }
            Packet::Tracker(packet) => {
                let name = packet.source_name.unwrap_or_default();
                let followed = !own && self.follows(&packet.uuid, &name);
                if self.trackers.len() < TRACKERS_MAX {
                    self.trackers.insert(packet.uuid, name);
                }
                if followed {
                    self.frame = packet.tracked_frame;
                }
                followed && self.frame.is_some()
            }
            Packet::Referee(packet) => {
                self.finder.read(&packet, at.0 as f64 * 1e-6, &mut events);
                self.referee = Some(packet);
                !events.is_empty()
            }
            _ => false,
        };
        is_row.then(|| self.row(at, unix_ns, &events))
    }

    /// Whether this recorded tracker is the one that is read: the first that matches is kept from then on.
    fn follows(&mut self, uuid: &str, name: &str) -> bool {
        if let Some(followed) = &self.followed {
            return followed == uuid;
        }
        let FieldSource::Recorded(wanted) = &self.source else { return false };
        let is_wanted = wanted.as_deref().is_none_or(|wanted| [uuid, name].contains(&wanted));
        if is_wanted {
            self.followed = Some(uuid.to_owned());
        }
        is_wanted
    }

    fn row(&self, at: Instant, unix_ns: i64, events: &[RefereeEvent]) -> Row {
        let mut row = Row::new();
        let mut put = Cells { row: &mut row };
        put.number("time_s", at.0 as f64 * 1e-6);
        put.number("unix_time_s", unix_ns as f64 * 1e-9);
        if let Some(referee) = &self.referee {
            put.referee(referee);
        }
        if !events.is_empty() {
            let texts = events.iter().map(|event| format!("{} {}", event.name, event.description));
            let texts: Vec<_> = texts.map(|text| text.trim_end().to_owned()).collect();
            put.text("events", texts.join("; "));
        }
        match (&self.source, &self.frame) {
            (FieldSource::Own, _) => self.own(at, &mut put),
            (FieldSource::Recorded(_), Some(frame)) => recorded(frame, &mut put),
            (FieldSource::Recorded(_), None) => {}
        }
        row
    }

    /// The field by our tracker.
    fn own(&self, at: Instant, put: &mut Cells<'_>) {
        let world = self.tracker.world(at);
        if let Some(ball) = &world.ball {
            let [position, velocity] =
                [[ball.position.x(), ball.position.y()], [ball.velocity.x(), ball.velocity.y()]];
            let values = [position[0], position[1], ball.height, velocity[0], velocity[1], ball.climb];
            put.group("ball", BALL, values.into_iter().chain([ball.confidence]).map(Some));
        }
        for robot in world.robots() {
            let (pose, velocity) = (robot.pose, robot.velocity);
            let values = [
                pose.position.x(),
                pose.position.y(),
                pose.heading.radians(),
                velocity.x(),
                velocity.y(),
                robot.angular,
                robot.confidence,
            ];
            let name = robot_columns(robot.who.colour, u32::from(robot.who.id.number()));
            put.group(&name, ROBOT, values.map(Some));
        }
    }
}

impl Iterator for Rows<'_> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        loop {
            let packet = self.packets.next()?;
            if let Some(row) = self.read(packet) {
                return Some(row);
            }
        }
    }
}

/// Names of all columns of a recording: those that every table has, then those of each robot in it.
pub fn columns(rows: impl Iterator<Item = Row>) -> Vec<String> {
    let mut robots = BTreeSet::new();
    for row in rows {
        for (name, _) in row {
            if let Some((team, id)) = robot_of(&name) {
                robots.insert((team.to_owned(), id));
            }
        }
    }
    let mut columns: Vec<String> = ALWAYS.map(str::to_owned).into();
    columns.extend(TEAMS.iter().flat_map(|team| TEAM.map(|(name, _)| format!("{team}_{name}"))));
    columns.push("events".to_owned());
    columns.extend(BALL.iter().map(|name| format!("ball_{name}")));
    for (team, id) in robots {
        columns.extend(ROBOT.iter().map(|name| format!("{team}_{id}_{name}")));
    }
    columns
}

/// Team and number of the robot that a column is of.
fn robot_of(column: &str) -> Option<(&str, u32)> {
    let (team, rest) = column.split_once('_').filter(|(team, _)| TEAMS.contains(team))?;
    Some((team, rest.split_once('_')?.0.parse().ok()?))
}

fn robot_columns(colour: Colour, id: u32) -> String {
    format!("{}_{id}", colour.label())
}

/// The field by a tracker in the recording; of a robot that is in a frame twice, the first entry.
fn recorded(frame: &TrackedFrame, put: &mut Cells<'_>) {
    if let Some(ball) = frame.balls.first() {
        let velocity = ball.vel.map_or([None; 3], |vel| [vel.x, vel.y, vel.z].map(Some));
        let position = [ball.pos.x, ball.pos.y, ball.pos.z].map(Some);
        put.group("ball", BALL, position.into_iter().chain(velocity).chain([ball.visibility]));
    }
    for robot in &frame.robots {
        let colour = match TeamColor::try_from(robot.robot_id.team_color) {
            Ok(TeamColor::Blue) => Colour::Blue,
            Ok(TeamColor::Yellow) => Colour::Yellow,
            _ => continue,
        };
        let name = robot_columns(colour, robot.robot_id.id);
        let first = format!("{name}_{}", ROBOT[0]);
        if robot.robot_id.id >= RobotId::COUNT as u32 || put.row.iter().any(|(column, _)| *column == first) {
            continue;
        }
        let velocity = robot.vel.map_or([None; 2], |vel| [vel.x, vel.y].map(Some));
        let pose = [robot.pos.x, robot.pos.y, robot.orientation].map(Some);
        let values = pose.into_iter().chain(velocity).chain([robot.vel_angular, robot.visibility]);
        put.group(&name, ROBOT, values);
    }
}

/// Fills a row.
struct Cells<'r> {
    row: &'r mut Row,
}

impl Cells<'_> {
    fn text(&mut self, column: &str, text: String) {
        self.row.push((column.to_owned(), text.into()));
    }

    /// A number rounded to µs; one that is not finite is unknown.
    fn number(&mut self, column: &str, value: f64) {
        if value.is_finite() {
            self.row.push((column.to_owned(), ((value * 1e6).round() / 1e6).into()));
        }
    }

    /// Cells of the ball or a robot, rounded to 0.1 mm, 0.1 mm/s and 0.1 mrad.
    fn group<const N: usize>(
        &mut self,
        of: &str,
        names: [&str; N],
        values: impl IntoIterator<Item = Option<f32>>,
    ) {
        for (name, value) in names.into_iter().zip(values) {
            if let Some(value) = value.filter(|value| value.is_finite()) {
                let rounded = (f64::from(value) * 1e4).round() / 1e4;
                self.row.push((format!("{of}_{name}"), rounded.into()));
            }
        }
    }

    fn referee(&mut self, packet: &Referee) {
        self.text("stage", number_name(packet.stage, Stage::try_from(packet.stage).ok()));
        self.text("command", number_name(packet.command, Command::try_from(packet.command).ok()));
        if let Some(left_us) = packet.stage_time_left {
            self.number("stage_time_left_s", left_us as f64 * 1e-6);
        }
        if let Some(left_us) = packet.current_action_time_remaining {
            self.number("action_time_left_s", left_us as f64 * 1e-6);
        }
        for (team, info) in TEAMS.iter().zip([&packet.blue, &packet.yellow]) {
            for (name, value) in TEAM {
                self.row.push((format!("{team}_{name}"), value(info).into()));
            }
        }
    }
}

type TeamCell = (&'static str, fn(&ssl::referee::TeamInfo) -> u32);

const TEAMS: [&str; 2] = ["blue", "yellow"];
const ALWAYS: [&str; 6] =
    ["time_s", "unix_time_s", "stage", "command", "stage_time_left_s", "action_time_left_s"];
const TEAM: [TeamCell; 4] = [
    ("score", |team| team.score),
    ("yellow_cards", |team| team.yellow_cards),
    ("red_cards", |team| team.red_cards),
    ("keeper", |team| team.goalkeeper),
];
const BALL: [&str; 7] = ["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "confidence"];
const ROBOT: [&str; 7] = ["x_m", "y_m", "heading_rad", "vx_m_s", "vy_m_s", "turn_rate_rad_s", "confidence"];
/// Most trackers whose names are kept.
const TRACKERS_MAX: usize = 64;
