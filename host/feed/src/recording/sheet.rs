//! `sheet`: the last state of the field and of both teams in a recording. Lengths in m.

use std::fmt::Write as _;

use foreign::excerpt;
use serde::Serialize;
use ssl::referee::{Referee, TeamInfo};
use ssl::vision::WrapperPacket;

/// Longest part of a team's name that is printed, characters.
const NAME_LEN: usize = 60;

/// Field and teams.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Sheet {
    /// By vision; `None` if it never sent one.
    pub field: Option<FieldSize>,
    /// By the referee; `None` if it was never received.
    pub teams: Option<Teams>,
}

/// The field's dimensions, as vision sends them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FieldSize {
    pub length: f64,
    pub width: f64,
    pub goal_width: f64,
    /// Along x, where it was sent.
    pub defence_depth: Option<f64>,
    /// Along y.
    pub defence_width: Option<f64>,
    /// From the touch line to the wall.
    pub boundary: f64,
}

/// Both teams.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Teams {
    pub blue: Team,
    pub yellow: Team,
}

/// A team as the referee reports it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Team {
    pub name: String,
    pub goalkeeper: u32,
    /// Number given in total.
    pub yellow_cards: u32,
    /// Still counting down.
    pub yellow_cards_active: usize,
    pub red_cards: u32,
    /// Robots it may have on the field; `None` where the referee does not send it.
    pub max_bots: Option<u32>,
}

impl Sheet {
    /// A packet of the vision.
    pub fn vision(&mut self, packet: &WrapperPacket) {
        let Some(geometry) = &packet.geometry else { return };
        let (field, metres) = (&geometry.field, |mm: i32| f64::from(mm) * 1e-3);
        self.field = Some(FieldSize {
            length: metres(field.field_length),
            width: metres(field.field_width),
            goal_width: metres(field.goal_width),
            defence_depth: field.penalty_area_depth.map(metres),
            defence_width: field.penalty_area_width.map(metres),
            boundary: metres(field.boundary_width),
        });
    }

    /// A packet of the referee.
    pub fn referee(&mut self, packet: &Referee) {
        self.teams = Some(Teams { blue: Team::of(&packet.blue), yellow: Team::of(&packet.yellow) });
    }

    /// As text, a line each.
    pub fn text(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(field) = &self.field {
            let FieldSize { length, width, goal_width, boundary, .. } = field;
            let mut line = format!("field: {length:.3} x {width:.3} m, goals {goal_width:.3} m");
            if let (Some(depth), Some(width)) = (field.defence_depth, field.defence_width) {
                let _ = write!(line, ", defence areas {depth:.3} x {width:.3} m");
            }
            let _ = write!(line, ", {boundary:.3} m beyond its lines");
            lines.push(line);
        }
        if let Some(Teams { blue, yellow }) = &self.teams {
            lines.push(blue.text("blue"));
            lines.push(yellow.text("yellow"));
        }
        lines
    }
}

impl Team {
    fn of(info: &TeamInfo) -> Self {
        Self {
            name: info.name.clone(),
            goalkeeper: info.goalkeeper,
            yellow_cards: info.yellow_cards,
            yellow_cards_active: info.yellow_card_times.len(),
            red_cards: info.red_cards,
            max_bots: info.max_allowed_bots,
        }
    }

    fn text(&self, colour: &str) -> String {
        let name =
            if self.name.is_empty() { "without a name".to_owned() } else { excerpt(&self.name, NAME_LEN) };
        let cards = |n: u32, kind: &str| format!("{n} {kind} card{}", if n == 1 { "" } else { "s" });
        let bots = self.max_bots.map_or_else(|| "unknown".to_owned(), |n| n.to_string());
        format!(
            "{colour}: {name}, keeper {}, {} ({} active), {}, max bots {bots}",
            self.goalkeeper,
            cards(self.yellow_cards, "yellow"),
            self.yellow_cards_active,
            cards(self.red_cards, "red"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssl::vision::{GeometryData, GeometryFieldSize};

    #[test]
    fn field_and_teams_are_reported_as_they_were_at_last() {
        let mut sheet = Sheet::default();
        assert!(sheet.text().is_empty());
        let field = GeometryFieldSize {
            field_length: 12_000,
            field_width: 9_000,
            goal_width: 1_800,
            boundary_width: 300,
            penalty_area_depth: Some(1_800),
            penalty_area_width: Some(3_600),
            ..GeometryFieldSize::default()
        };
        let geometry = Some(GeometryData { field, ..GeometryData::default() });
        sheet.vision(&WrapperPacket { geometry, ..WrapperPacket::default() });
        sheet.vision(&WrapperPacket::default());
        let mut packet = Referee::default();
        packet.blue.name = "A\u{1b}[31m\nB".to_owned();
        packet.blue.yellow_cards = 2;
        packet.blue.yellow_card_times = vec![60_000_000];
        packet.blue.red_cards = 1;
        packet.blue.max_allowed_bots = Some(9);
        packet.blue.goalkeeper = 3;
        sheet.referee(&packet);
        assert_eq!(
            sheet.text(),
            [
                "field: 12.000 x 9.000 m, goals 1.800 m, defence areas 1.800 x 3.600 m, 0.300 m beyond its lines",
                "blue: A\\u001b[31m\\nB, keeper 3, 2 yellow cards (1 active), 1 red card, max bots 9",
                "yellow: without a name, keeper 0, 0 yellow cards (0 active), 0 red cards, max bots unknown",
            ]
        );
    }

    #[test]
    fn a_field_of_any_numbers_is_reported() {
        let mut sheet = Sheet::default();
        let field = GeometryFieldSize {
            field_length: i32::MIN,
            field_width: i32::MAX,
            ..GeometryFieldSize::default()
        };
        let geometry = Some(GeometryData { field, ..GeometryData::default() });
        sheet.vision(&WrapperPacket { geometry, ..WrapperPacket::default() });
        assert!(sheet.text()[0].starts_with("field: -2147483.648 x 2147483.647 m"));
    }
}
