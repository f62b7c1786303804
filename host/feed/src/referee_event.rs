//! `referee_event`: events in the packets of the referee. Commands, stages, goals, game events, cards, and
//! what else changed: names, robots allowed, places for the ball; each once.

use std::collections::BTreeSet;

use foreign::excerpt;
use serde::Serialize;
use ssl::Message;
use ssl::event::GameEventType;
use ssl::referee::{Command, Referee, Stage, TeamInfo};

/// An event that the referee reported for the first time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RefereeEvent {
    /// Seconds since the start of the file.
    pub at_s: f64,
    /// RefereeEventKind of event.
    pub kind: RefereeEventKind,
    /// Name as the league writes it.
    pub name: String,
    /// Team or player, and number.
    #[serde(skip_serializing_if = "String::is_empty")]
    #[serde(rename = "words")]
    pub description: String,
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RefereeEventKind {
    /// Another command, or the same with another number.
    Command,
    /// Another stage of the match.
    Stage,
    /// A higher score.
    Goal,
    /// A game event of the league, such as a ball out of the field.
    GameEvent,
    /// A yellow or red card was given.
    Card,
    /// The number of robots that a team may have changed.
    MaxBots,
    /// A team's name changed.
    TeamName,
    /// The position for ball placement changed.
    DesignatedPosition,
}

/// Most game events that are reported; a source with more is not a referee.
const EVENTS_MAX: usize = 65_536;

/// Detects new events in each packet of the referee.
#[derive(Debug, Default)]
pub struct RefereeEventFinder {
    last: Option<Last>,
    events: BTreeSet<Vec<u8>>,
}

#[derive(Clone, Debug)]
struct Last {
    command: i32,
    counter: u32,
    stage: i32,
    /// Place for the ball, mm, where a command asks for that.
    place: Option<[i32; 2]>,
    teams: [Account; 2],
}

/// The state of a team whose changes are reported.
#[derive(Clone, Debug)]
struct Account {
    score: u32,
    yellow_cards: u32,
    red_cards: u32,
    max_bots: Option<u32>,
    name: String,
}

impl Account {
    fn of(team: &TeamInfo) -> Self {
        Self {
            score: team.score,
            yellow_cards: team.yellow_cards,
            red_cards: team.red_cards,
            max_bots: team.max_allowed_bots,
            name: team.name.clone(),
        }
    }
}

impl RefereeEventFinder {
    /// Events in a packet that came at `at_s`.
    pub fn read(&mut self, packet: &Referee, at_s: f64, into: &mut Vec<RefereeEvent>) {
        let now = Last {
            command: packet.command,
            counter: packet.command_counter,
            stage: packet.stage,
            place: place(packet),
            teams: [Account::of(&packet.yellow), Account::of(&packet.blue)],
        };
        let before = self.last.replace(now.clone());
        let mut line = |kind, name, description| into.push(RefereeEvent { at_s, kind, name, description });
        if before.as_ref().is_none_or(|before| before.stage != now.stage) {
            line(
                RefereeEventKind::Stage,
                number_name(packet.stage, Stage::try_from(packet.stage).ok()),
                String::new(),
            );
        }
        let same = |before: &Last| (before.command, before.counter) == (now.command, now.counter);
        let commanded = !before.as_ref().is_some_and(same);
        if commanded {
            let name = number_name(packet.command, Command::try_from(packet.command).ok());
            let again = before.as_ref().is_some_and(|before| before.command == now.command);
            let again = if again { ", once more" } else { "" };
            let at = now.place.map(|place| format!(", the ball to {}", in_metres(place))).unwrap_or_default();
            line(RefereeEventKind::Command, name, format!("number {}{again}{at}", now.counter));
        } else if let Some(place) = now.place
            && before.as_ref().is_some_and(|before| before.place != now.place)
        {
            line(
                RefereeEventKind::DesignatedPosition,
                "DESIGNATED_POSITION".to_owned(),
                format!("the ball to {}", in_metres(place)),
            );
        }
        for event in &packet.game_events {
            let identity = event.id.clone().map_or_else(|| event.encode_to_vec(), String::into_bytes);
            if self.events.len() < EVENTS_MAX && self.events.insert(identity) {
                let kind = event.r#type.unwrap_or_default();
                let name = number_name(kind, GameEventType::try_from(kind).ok());
                line(RefereeEventKind::GameEvent, name, event.origin.join(", "));
            }
        }
        let Some(before) = before else { return };
        let [yellow, blue] = [now.teams[0].score, now.teams[1].score];
        for (colour, (before, now)) in ["yellow", "blue"].iter().zip(before.teams.iter().zip(&now.teams)) {
            if now.score > before.score {
                line(
                    RefereeEventKind::Goal,
                    "GOAL".to_owned(),
                    format!("{colour}, blue {blue} : {yellow} yellow"),
                );
            }
            for (name, before, now) in [
                ("YELLOW_CARD", before.yellow_cards, now.yellow_cards),
                ("RED_CARD", before.red_cards, now.red_cards),
            ] {
                if now > before {
                    line(RefereeEventKind::Card, name.to_owned(), format!("{colour}, {now} in all"));
                }
            }
            if let Some(max_bots) = now.max_bots.filter(|_| now.max_bots != before.max_bots) {
                line(RefereeEventKind::MaxBots, "MAX_BOTS".to_owned(), format!("{colour}, {max_bots}"));
            }
            if now.name != before.name {
                line(RefereeEventKind::TeamName, "TEAM_NAME".to_owned(), format!("{colour}, {}", now.name));
            }
        }
    }
}

/// Place for the ball, mm, where the command is such that the place counts (README of `ssl`, trap
/// 3).
fn place(packet: &Referee) -> Option<[i32; 2]> {
    let placing = matches!(
        Command::try_from(packet.command),
        Ok(Command::BallPlacementBlue | Command::BallPlacementYellow)
    );
    let at = packet.designated_position.filter(|_| placing)?;
    Some([at.x.round() as i32, at.y.round() as i32])
}

fn in_metres([x, y]: [i32; 2]) -> String {
    format!("({:.2}, {:.2}) m", f64::from(x) * 1e-3, f64::from(y) * 1e-3)
}

impl RefereeEvent {
    /// A line for the operator; text of the referee's program is quoted in it.
    pub fn line(&self) -> String {
        let description = if self.description.is_empty() {
            String::new()
        } else {
            format!(" ({})", excerpt(&self.description, DESCRIPTION_LEN))
        };
        format!("{:>9.2} s  {}{description}", self.at_s, self.name)
    }
}

/// Longest text of an event that is printed, characters.
const DESCRIPTION_LEN: usize = 200;

/// A name as the league writes it; the number where nothing is known by it.
pub(crate) fn number_name(number: i32, known: Option<impl std::fmt::Debug>) -> String {
    known.map_or_else(|| format!("NUMBER_{number}"), |known| screaming(&format!("{known:?}")))
}

/// `PrepareKickoffBlue` as `PREPARE_KICKOFF_BLUE`.
fn screaming(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.push(letter.to_ascii_uppercase());
    }
    out
}

/// True if a search text matches an event: the start of its name, without regard to case and dashes.
pub fn is_meant(event: &RefereeEvent, label: &str) -> bool {
    let plain = |text: &str| text.replace(['-', ' '], "_").to_ascii_uppercase();
    event.name.starts_with(&plain(label))
}

#[cfg(test)]
mod tests {
    use ssl::referee::Point;

    use super::*;

    fn packet(command: Command, counter: u32, blue: u32) -> Referee {
        let mut packet = Referee { command: command as i32, command_counter: counter, ..Referee::default() };
        packet.blue.score = blue;
        packet
    }

    #[test]
    fn each_thing_is_reported_once() {
        let (mut finder, mut found) = (RefereeEventFinder::default(), Vec::new());
        for (at, packet) in [
            (0.0, packet(Command::Halt, 1, 0)),
            (0.1, packet(Command::Halt, 1, 0)),
            (1.0, packet(Command::PrepareKickoffBlue, 2, 0)),
            (2.0, packet(Command::PrepareKickoffBlue, 3, 1)),
        ] {
            finder.read(&packet, at, &mut found);
        }
        let reported: Vec<_> =
            found.iter().map(|h| (h.at_s, h.name.as_str(), h.description.as_str())).collect();
        assert_eq!(
            reported,
            [
                (0.0, "NORMAL_FIRST_HALF_PRE", ""),
                (0.0, "HALT", "number 1"),
                (1.0, "PREPARE_KICKOFF_BLUE", "number 2"),
                (2.0, "PREPARE_KICKOFF_BLUE", "number 3, once more"),
                (2.0, "GOAL", "blue, blue 1 : 0 yellow"),
            ]
        );
    }

    #[test]
    fn cards_names_robots_allowed_and_places_are_reported_when_they_change() {
        let (mut finder, mut found) = (RefereeEventFinder::default(), Vec::new());
        let mut placing = packet(Command::BallPlacementBlue, 5, 0);
        placing.designated_position = Some(Point { x: 1200.0, y: -450.0 });
        finder.read(&placing, 0.0, &mut found);
        let mut moved = placing.clone();
        moved.designated_position = Some(Point { x: f32::NAN, y: 1e30 });
        moved.blue.yellow_cards = 1;
        moved.yellow.red_cards = 2;
        moved.blue.max_allowed_bots = Some(5);
        moved.yellow.name = "\u{1b}[31mRED\nGOAL".to_owned();
        finder.read(&moved, 1.0, &mut found);
        finder.read(&moved, 2.0, &mut found);
        let mut stop = packet(Command::Stop, 6, 0);
        (stop.blue, stop.yellow) = (moved.blue.clone(), moved.yellow.clone());
        stop.designated_position = moved.designated_position;
        finder.read(&stop, 3.0, &mut found);
        let reported: Vec<_> = found.iter().skip(1).map(RefereeEvent::line).collect();
        assert_eq!(
            reported,
            [
                "     0.00 s  BALL_PLACEMENT_BLUE (number 5, the ball to (1.20, -0.45) m)",
                "     1.00 s  DESIGNATED_POSITION (the ball to (0.00, 2147483.65) m)",
                "     1.00 s  RED_CARD (yellow, 2 in all)",
                "     1.00 s  TEAM_NAME (yellow, \\u001b[31mRED\\nGOAL)",
                "     1.00 s  YELLOW_CARD (blue, 1 in all)",
                "     1.00 s  MAX_BOTS (blue, 5)",
                "     3.00 s  STOP (number 6)",
            ]
        );
    }

    #[test]
    fn a_name_is_meant_by_its_begin_in_any_writing() {
        let (mut finder, mut found) = (RefereeEventFinder::default(), Vec::new());
        finder.read(&packet(Command::PrepareKickoffBlue, 1, 0), 0.0, &mut found);
        assert!(is_meant(&found[1], "prepare-kickoff") && is_meant(&found[1], "PREPARE_KICKOFF_BLUE"));
        assert!(!is_meant(&found[1], "kickoff") && !is_meant(&found[1], "prepare_penalty"));
    }
}
