//! `situations`: recorded situations of matches, read from two CSV tables: `index.csv`, a row a situation,
//! and the tracked positions, a row a robot or ball in a frame. m, s, rad, field frame; our goal is at −x.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use geometry::{Angle, Field, Point, Pose};
use protocol::RobotId;
use rules::League;
use serde::Deserialize;

/// One recorded situation.
#[derive(Clone, Debug)]
pub struct Situation {
    /// Name in both tables.
    pub name: String,
    /// Kind: `goal against`, `own free kick`, or another that no drill asks for.
    pub kind: String,
    /// Note: cause of a goal, half of a free kick.
    pub note: String,
    /// Field and number of robots.
    pub league: League,
    /// Frames in the order of time.
    pub frames: Vec<SituationFrame>,
}

/// Positions at one time.
#[derive(Clone, Debug)]
pub struct SituationFrame {
    /// Time from the moment that the situation is about, s.
    pub time_s: f32,
    /// The ball.
    pub ball: Point<Field>,
    /// Robots of ours, the keeper first.
    pub ours: Vec<Pose<Field>>,
    /// Robots of theirs.
    pub theirs: Vec<Pose<Field>>,
}

/// Error in the tables.
#[derive(Debug, thiserror::Error)]
pub enum SituationError {
    /// A table cannot be read.
    #[error("{file}: {1}", file = .0.display())]
    Read(PathBuf, io::Error),
    /// A row is not of the format; the error has its line.
    #[error("{file}: {1}", file = .0.display())]
    Row(PathBuf, csv::Error),
    /// A value of a row is not valid.
    #[error("{} line {line}: {reason}", .file.display())]
    Value {
        /// The table.
        file: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The fault, and what is accepted.
        reason: String,
    },
    /// No situation has a frame.
    #[error("{}: no situation has a frame with ball and robots", .0.display())]
    Empty(PathBuf),
}

/// A row of `index.csv`; its other columns are for people.
#[derive(Deserialize)]
struct IndexRow {
    situation: String,
    kind: String,
    division: String,
    note: String,
}

#[derive(Deserialize)]
struct PositionRow {
    situation: String,
    t_s: f32,
    who: String,
    id: Option<u8>,
    x_m: f32,
    y_m: f32,
    heading_rad: Option<f32>,
}

/// The situations that come with the program: three moments of each of 52 situations of matches against the
/// champions' software.
pub fn built_in() -> Result<Vec<Situation>, SituationError> {
    let index = include_str!("../../data/situations/index.csv");
    let positions = include_str!("../../data/situations/situations.csv");
    let [index_file, file] = ["index.csv", "situations.csv"].map(|name| Path::new("built-in").join(name));
    parse(&index_file, index.as_bytes(), &file, positions.as_bytes())
}

/// The situations of a file, plain or gzip, with its `index.csv` beside it.
pub fn read(file: &Path) -> Result<Vec<Situation>, SituationError> {
    let index_file = file.with_file_name("index.csv");
    let open = |file: &Path| File::open(file).map_err(|error| SituationError::Read(file.to_owned(), error));
    let index = BufReader::new(open(&index_file)?);
    let mut bytes = Vec::new();
    let mut positions = BufReader::new(open(file)?);
    let read = positions.read_to_end(&mut bytes).and_then(|_| {
        if !bytes.starts_with(&GZIP_MAGIC) {
            return Ok(bytes.clone());
        }
        let mut text = Vec::new();
        MultiGzDecoder::new(bytes.as_slice()).read_to_end(&mut text).map(|_| text)
    });
    let text = read.map_err(|error| SituationError::Read(file.to_owned(), error))?;
    parse(&index_file, index, file, text.as_slice())
}

fn parse(
    index_file: &Path,
    index: impl Read,
    file: &Path,
    positions: impl Read,
) -> Result<Vec<Situation>, SituationError> {
    let mut situations = Vec::new();
    let mut places = BTreeMap::new();
    for_rows(index_file, index, |row: IndexRow, value_error| {
        let league = match row.division.as_str() {
            "A" => League::DivisionA,
            "B" => League::DivisionB,
            other => return Err(value_error(format!("division is {other:?}; write A or B"))),
        };
        places.insert(row.situation.clone(), situations.len());
        let IndexRow { situation: name, kind, note, .. } = row;
        situations.push(Situation { name, kind, note, league, frames: Vec::new() });
        Ok(())
    })?;
    let mut frame = OpenFrame::default();
    for_rows(file, positions, |row: PositionRow, value_error| {
        let Some(&place) = places.get(&row.situation) else {
            return Err(value_error(format!(
                "situation {:?} is not in {}",
                row.situation,
                index_file.display()
            )));
        };
        let situation: &mut Situation = &mut situations[place];
        if frame.place != Some(place) || frame.time_s != row.t_s {
            let done = std::mem::replace(&mut frame, OpenFrame::at(place, row.t_s));
            done.close(&mut situations);
            return frame.take(&row, situations[place].league).map_err(value_error);
        }
        frame.take(&row, situation.league).map_err(value_error)
    })?;
    frame.close(&mut situations);
    situations.retain(|situation| !situation.frames.is_empty());
    if situations.is_empty() {
        return Err(SituationError::Empty(file.to_owned()));
    }
    Ok(situations)
}

/// Calls `take` with every row, and with what makes an error of a value in it.
fn for_rows<R: for<'d> Deserialize<'d>>(
    file: &Path,
    table: impl Read,
    mut take: impl FnMut(R, &dyn Fn(String) -> SituationError) -> Result<(), SituationError>,
) -> Result<(), SituationError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(table);
    let error_of = |error| SituationError::Row(file.to_owned(), error);
    let heads = reader.headers().map_err(error_of)?.clone();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(error_of)? {
        let line = record.position().map_or(0, csv::Position::line);
        let row = record.deserialize(Some(&heads)).map_err(error_of)?;
        take(row, &|reason| SituationError::Value { file: file.to_owned(), line, reason })?;
    }
    Ok(())
}

/// A frame whose rows are being read.
#[derive(Default)]
struct OpenFrame {
    place: Option<usize>,
    time_s: f32,
    ball: Option<Point<Field>>,
    /// Ours and theirs, by number.
    teams: [BTreeMap<u8, Pose<Field>>; 2],
}

impl OpenFrame {
    fn at(place: usize, time_s: f32) -> Self {
        Self { place: Some(place), time_s, ..Self::default() }
    }

    fn take(&mut self, row: &PositionRow, league: League) -> Result<(), String> {
        let at = Point::new(row.x_m, row.y_m);
        let (length, width) = (league.field().length, league.field().width);
        let near = at.is_finite() && at.x().abs() <= 0.5 * length + BESIDE_MAX_M;
        if !near || at.y().abs() > 0.5 * width + BESIDE_MAX_M || !row.t_s.is_finite() {
            let found = format!("({}, {}) at {} s", row.x_m, row.y_m, row.t_s);
            return Err(format!("{found} is not on a field of {length} × {width} m"));
        }
        let team = match row.who.as_str() {
            "ball" => {
                self.ball = Some(at);
                return Ok(());
            }
            "ours" => 0,
            "theirs" => 1,
            other => return Err(format!("who is {other:?}; write ball, ours or theirs")),
        };
        let heading =
            row.heading_rad.filter(|heading| heading.is_finite()).ok_or("a robot needs heading_rad")?;
        let id = row.id.filter(|id| RobotId::new(*id).is_some()).ok_or("a robot needs an id of 0 to 15")?;
        self.teams[team].insert(id, Pose { position: at, heading: Angle::new(heading) });
        Ok(())
    }

    /// Adds the frame to its situation, unless something of it is missing.
    fn close(self, situations: &mut [Situation]) {
        let (Some(place), Some(ball)) = (self.place, self.ball) else { return };
        let Some(situation) = situations.get_mut(place) else { return };
        let goal = situation.league.field().goal_center(geometry::GoalEnd::Negative);
        let [ours, theirs] = self.teams.map(|team| team.into_values().collect::<Vec<_>>());
        if ours.is_empty() || theirs.is_empty() {
            return;
        }
        let mut ours = ours;
        ours.sort_by(|a, b| a.position.distance(goal).total_cmp(&b.position.distance(goal)));
        situation.frames.push(SituationFrame { time_s: self.time_s, ball, ours, theirs });
    }
}

/// First bytes of a gzip file (RFC 1952).
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];
/// Robots and ball are seen this far beside the lines, m: to the boards and a little.
const BESIDE_MAX_M: f32 = 1.0;

#[cfg(test)]
mod tests {
    use super::*;

    const INDEX: &str = "situation,kind,division,field_length_m,note\na,goal against,B,9.0,F9\n";

    fn parsed(index: &str, positions: &str) -> Result<Vec<Situation>, String> {
        let read = parse(Path::new("index.csv"), index.as_bytes(), Path::new("p.csv"), positions.as_bytes());
        read.map_err(|error| error.to_string())
    }

    #[test]
    fn frames_are_read_row_by_row_with_the_keeper_first() {
        let rows = "situation,t_s,who,id,x_m,y_m,heading_rad,seen\n\
            a,-1.0,ball,,-3.0,0.5,,1\na,-1.0,ours,3,-1.0,0,0.5,1\na,-1.0,ours,5,-4.4,0,0,1\na,-1.0,theirs,2,-2.9,0.5,3.1,0\n\
            a,-0.9,ball,,-3.1,0.5,,1\na,-0.9,ours,3,-1.0,0,0.5,1\na,-0.9,theirs,2,-2.9,0.5,3.1,0\n";
        let situations = parsed(INDEX, rows).unwrap();
        let [first, second] = situations[0].frames.as_slice() else { panic!("{situations:?}") };
        assert_eq!((first.ball, first.ours.len(), first.theirs.len()), (Point::new(-3.0, 0.5), 2, 1));
        assert_eq!(first.ours[0].position, Point::new(-4.4, 0.0));
        assert_eq!((second.time_s, second.ours.len()), (-0.9, 1));
    }

    #[test]
    fn a_row_that_does_not_fit_is_refused_with_its_line_and_remedy() {
        let heads = "situation,t_s,who,id,x_m,y_m,heading_rad,seen\n";
        for (row, expected) in [
            ("b,0,ball,,0,0,,1", "line 2: situation \"b\" is not in index.csv"),
            ("a,0,ball,,40,0,,1", "line 2: (40, 0) at 0 s is not on a field of 9 × 6 m"),
            ("a,0,ball,,NaN,0,,1", "is not on a field"),
            ("a,0,them,1,0,0,0,1", "line 2: who is \"them\"; write ball, ours or theirs"),
            ("a,0,ours,16,0,0,0,1", "line 2: a robot needs an id of 0 to 15"),
            ("a,0,ours,1,0,0,,1", "line 2: a robot needs heading_rad"),
            ("a,zero,ball,,0,0,,1", "line: 2"),
            ("a,0,ball", "line: 2"),
        ] {
            let error = parsed(INDEX, &format!("{heads}{row}\n")).unwrap_err();
            assert!(error.contains(expected), "{row}: {error}");
        }
        let error = parsed(&INDEX.replace(",B,", ",C,"), heads).unwrap_err();
        assert!(error.contains("index.csv line 2: division is \"C\"; write A or B"), "{error}");
        assert!(parsed(INDEX, heads).unwrap_err().contains("no situation has a frame"));
    }

    #[test]
    fn the_built_in_situations_are_of_both_divisions() {
        let situations = built_in().unwrap();
        assert!(situations.len() >= 50, "{}", situations.len());
        assert!(situations.iter().any(|situation| situation.league == League::DivisionA));
        assert!(situations.iter().all(|situation| situation.frames.len() >= 2));
    }
}
