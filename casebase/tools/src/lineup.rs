//! `lineup`: line-ups around a ball for drawn problems. mm, seen in attack towards +x.
//!
//! `league.toml` may contain it; otherwise a line-up is guessed from the field and the size of the cases:
//!
//! ```toml
//! [problems]
//! teammates = [{ x = [-700, -300], y = [-300, 300] }]            # around the ball
//! opponents = [[{ x = [900, 2050], y = [-1800, 1800] }], []]     # homes on the field; one of the line-ups is drawn
//! ```

use casebase::{FieldMm, PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, PointMm};

use crate::codes::code;
use crate::document::{Reader, Table, Value};
use crate::keys;

/// Areas of the robots of a drawn problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lineup {
    /// One area per teammate, relative to the ball; the first is that of the robot at the ball.
    pub teammates: Vec<Rectangle>,
    /// Line-ups of opponents, each with the homes of its robots, on the field.
    pub opponents: Vec<Vec<Rectangle>>,
}

/// A rectangle, mm, borders included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// Smallest and largest x, mm.
    pub x: [i32; 2],
    /// Smallest and largest y, mm.
    pub y: [i32; 2],
}

impl Rectangle {
    /// Inside or on the border.
    pub const fn contains(&self, point: PointMm) -> bool {
        self.x[0] <= point.x && point.x <= self.x[1] && self.y[0] <= point.y && point.y <= self.y[1]
    }

    /// The point of the area nearest to `point`.
    pub fn nearest(&self, point: PointMm) -> PointMm {
        PointMm::new(point.x.clamp(self.x[0], self.x[1]), point.y.clamp(self.y[0], self.y[1]))
    }
}

impl Lineup {
    /// Default line-up of a league: as many teammates as the largest case has, one of them behind the ball;
    /// as many opponents, a goalie among them; or the same without a goalie, pushed up to the middle.
    pub fn guess(field: FieldMm, largest_case: usize) -> Self {
        let robots = largest_case.clamp(2, PROBLEM_TEAMMATES_MAX);
        let [length, width] = [field.length, field.width];
        let behind = Rectangle { x: [-length / 8, -length / 18], y: [-width / 12, width / 12] };
        let around = Rectangle { x: [-length / 4, length / 8], y: [-width / 3, width / 3] };
        let teammates = std::iter::once(behind).chain(std::iter::repeat_n(around, robots - 1)).collect();
        let half = length / 2;
        let goalie = Rectangle {
            x: [half - field.penalty_depth, half],
            y: [-field.penalty_width / 2, field.penalty_width / 2],
        };
        let side = [-width / 2, width / 2];
        let back = Rectangle { x: [length / 6, half - field.penalty_depth], y: side }.in_order();
        let middle = Rectangle { x: [-length / 27, length / 4], y: side };
        let deep = std::iter::once(goalie.in_order()).chain(std::iter::repeat_n(back, robots - 1)).collect();
        let high = std::iter::once(back).chain(std::iter::repeat_n(middle, robots - 1)).collect();
        Self { teammates, opponents: vec![deep, high] }
    }

    /// The line-up of `[problems]`; `None` with findings where it cannot be used.
    pub(crate) fn read(reader: &mut Reader<'_>, value: Value<'_, '_>) -> Option<Self> {
        let table = reader.table(value, "problems")?;
        table.refuse_others(reader, keys::PROBLEMS);
        let teammates = table.required(reader, "teammates")?;
        let list = areas(reader, teammates, "problems.teammates", PROBLEM_TEAMMATES_MAX)?;
        if list.is_empty() {
            let hint = "give the area of one robot at least, such as { x = [-700, -300], y = [-300, 300] }";
            reader.error(code::BAD_VALUE, teammates.span(), "problems.teammates is empty", hint);
            return None;
        }
        let opponents = table.required(reader, "opponents")?;
        let mut lineups = Vec::new();
        for lineup in reader.list(opponents, "problems.opponents")? {
            lineups.push(areas(reader, lineup, "problems.opponents", PROBLEM_OPPONENTS_MAX)?);
        }
        if lineups.is_empty() {
            let hint = "give one line-up at least; [] is the one without opponents";
            reader.error(code::BAD_VALUE, opponents.span(), "problems.opponents has no line-up", hint);
            return None;
        }
        Some(Self { teammates: list, opponents: lineups })
    }
}

impl Rectangle {
    /// Puts the ends in rising order, for all dimensions of the field.
    fn in_order(self) -> Self {
        let ordered = |[a, b]: [i32; 2]| [a.min(b), a.max(b)];
        Self { x: ordered(self.x), y: ordered(self.y) }
    }
}

fn areas(reader: &mut Reader<'_>, value: Value<'_, '_>, name: &str, most: usize) -> Option<Vec<Rectangle>> {
    let list = reader.list(value, name)?;
    if list.len() > most {
        let message = format!("{name} has {} robots", list.len());
        reader.error(
            code::BAD_VALUE,
            value.span(),
            message,
            format!("keep to {most}, the most of a problem"),
        );
        return None;
    }
    list.into_iter().map(|area| read_area(reader, area, name)).collect()
}

fn read_area(reader: &mut Reader<'_>, value: Value<'_, '_>, name: &str) -> Option<Rectangle> {
    let table = reader.table(value, name)?;
    table.refuse_others(reader, keys::RECTANGLE);
    let (x, y) = (range(reader, &table, "x"), range(reader, &table, "y"));
    Some(Rectangle { x: x?, y: y? })
}

/// A pair of rising whole numbers.
fn range(reader: &mut Reader<'_>, table: &Table<'_, '_>, key: &str) -> Option<[i32; 2]> {
    let (ends, span) = table.point(reader, key)?;
    if ends.x > ends.y {
        let message = format!("{} ends before it begins", table.name_of(key));
        reader.error(code::BAD_VALUE, span, message, "write [from, to] in mm, the smaller first");
        return None;
    }
    Some([ends.x, ends.y])
}
