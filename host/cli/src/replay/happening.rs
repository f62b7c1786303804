//! What happened in a recorded match, by the referee's packets? Commands, stages, goals and game events, each once.

use std::collections::BTreeSet;

use serde::Serialize;
use ssl::Message;
use ssl::event::GameEventType;
use ssl::referee::{Command, Referee, Stage};

/// Something the referee said for the first time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Happening {
    /// Seconds since the file's begin.
    pub(crate) at_s: f64,
    /// What kind of thing.
    pub(crate) kind: Kind,
    /// Its name, as the league writes it.
    pub(crate) name: String,
    /// Whose, or by whom, and with what number.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) words: String,
}

/// Kinds of happenings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Kind {
    Command,
    Stage,
    Goal,
    GameEvent,
}

/// Finds what is new in each packet of the referee.
#[derive(Debug, Default)]
pub(crate) struct Finder {
    last: Option<Last>,
    events: BTreeSet<Vec<u8>>,
}

#[derive(Clone, Copy, Debug)]
struct Last {
    command: i32,
    counter: u32,
    stage: i32,
    /// Yellow's and blue's.
    score: [u32; 2],
}

impl Finder {
    /// What is new in a packet that came at `at_s`.
    pub(crate) fn read(&mut self, packet: &Referee, at_s: f64, into: &mut Vec<Happening>) {
        let now = Last {
            command: packet.command,
            counter: packet.command_counter,
            stage: packet.stage,
            score: [packet.yellow.score, packet.blue.score],
        };
        let before = self.last.replace(now);
        let mut tell = |kind, name, words| into.push(Happening { at_s, kind, name, words });
        if before.is_none_or(|before| before.stage != now.stage) {
            tell(Kind::Stage, number_name(packet.stage, Stage::try_from(packet.stage).ok()), String::new());
        }
        if before.is_none_or(|before| (before.command, before.counter) != (now.command, now.counter)) {
            let name = number_name(packet.command, Command::try_from(packet.command).ok());
            let again = before.is_some_and(|before| before.command == now.command);
            let again = if again { ", once more" } else { "" };
            tell(Kind::Command, name, format!("number {}{again}", now.counter));
        }
        for event in &packet.game_events {
            let identity = event.id.clone().map_or_else(|| event.encode_to_vec(), String::into_bytes);
            if self.events.insert(identity) {
                let kind = event.r#type.unwrap_or_default();
                let name = number_name(kind, GameEventType::try_from(kind).ok());
                tell(Kind::GameEvent, name, event.origin.join(", "));
            }
        }
        if let Some(before) = before {
            for (team, name) in ["yellow", "blue"].iter().enumerate() {
                if now.score[team] > before.score[team] {
                    let [yellow, blue] = now.score;
                    tell(Kind::Goal, "GOAL".to_owned(), format!("{name}, blue {blue} : {yellow} yellow"));
                }
            }
        }
    }
}

/// A name as the league writes it; the number where nothing is known by it.
fn number_name(number: i32, known: Option<impl std::fmt::Debug>) -> String {
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

/// Is a happening meant by a word? The begin of its name, whatever case and dashes.
pub(crate) fn is_meant(happening: &Happening, word: &str) -> bool {
    let plain = |text: &str| text.replace(['-', ' '], "_").to_ascii_uppercase();
    happening.name.starts_with(&plain(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packet(command: Command, counter: u32, blue: u32) -> Referee {
        let mut packet = Referee { command: command as i32, command_counter: counter, ..Referee::default() };
        packet.blue.score = blue;
        packet
    }

    #[test]
    fn each_thing_is_told_once() {
        let (mut finder, mut found) = (Finder::default(), Vec::new());
        for (at, packet) in [
            (0.0, packet(Command::Halt, 1, 0)),
            (0.1, packet(Command::Halt, 1, 0)),
            (1.0, packet(Command::PrepareKickoffBlue, 2, 0)),
            (2.0, packet(Command::PrepareKickoffBlue, 3, 1)),
        ] {
            finder.read(&packet, at, &mut found);
        }
        let told: Vec<_> = found.iter().map(|h| (h.at_s, h.name.as_str(), h.words.as_str())).collect();
        assert_eq!(
            told,
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
    fn a_name_is_meant_by_its_begin_in_any_writing() {
        let (mut finder, mut found) = (Finder::default(), Vec::new());
        finder.read(&packet(Command::PrepareKickoffBlue, 1, 0), 0.0, &mut found);
        assert!(is_meant(&found[1], "prepare-kickoff") && is_meant(&found[1], "PREPARE_KICKOFF_BLUE"));
        assert!(!is_meant(&found[1], "kickoff") && !is_meant(&found[1], "prepare_penalty"));
    }
}
