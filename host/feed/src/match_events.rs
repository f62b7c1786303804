//! `match_events`: time-line events from the referee's packets; the referee of a simulation reports more.

use arena::game::sentence;
use hil_sim::small_size::referee::InternalReferee;
use host::world::Kick;
use page::{MatchEvent, MatchEventKind, PageTeam, milli};
use ssl::Message;
use ssl::referee::Referee;

use crate::referee_event::{RefereeEventFinder, RefereeEventKind};

#[derive(Debug, Default)]
pub(super) struct EventFeed {
    finder: RefereeEventFinder,
    events: usize,
    kick: Option<Kick>,
}

impl EventFeed {
    /// A packet of the referee. Where our own referee reports its events itself, the packet's are left out.
    pub(super) fn packet(&mut self, bytes: &[u8], t: f64, own: bool, into: &mut Vec<MatchEvent>) {
        let Ok(packet) = Referee::decode(bytes) else { return };
        let mut found = Vec::new();
        self.finder.read(&packet, t, &mut found);
        for found in found {
            let name = found.name.replace('_', " ").to_lowercase();
            let kind = match found.kind {
                RefereeEventKind::Command => MatchEventKind::Command,
                RefereeEventKind::Stage => MatchEventKind::Stage,
                RefereeEventKind::Goal => MatchEventKind::Goal,
                RefereeEventKind::GameEvent if own => continue,
                RefereeEventKind::GameEvent => foul_or_event(&found.name),
                RefereeEventKind::Card => MatchEventKind::Foul,
                RefereeEventKind::MaxBots
                | RefereeEventKind::TeamName
                | RefereeEventKind::DesignatedPosition => MatchEventKind::Event,
            };
            // Numbers are stored in the record and left out of the label.
            let description = match found.kind {
                RefereeEventKind::Goal => format!("goal, {}", found.description),
                RefereeEventKind::GameEvent if !found.description.is_empty() => {
                    format!("{name} ({})", found.description)
                }
                RefereeEventKind::Card
                | RefereeEventKind::MaxBots
                | RefereeEventKind::TeamName
                | RefereeEventKind::DesignatedPosition => format!("{name}, {}", found.description),
                _ => name,
            };
            let team = whose(&description);
            into.push(MatchEvent::new(t, kind, team, description));
        }
    }

    /// Events of the simulation's own referee since the last call.
    pub(super) fn referee(&mut self, referee: &InternalReferee, t: f64, into: &mut Vec<MatchEvent>) {
        for event in referee.events().iter().skip(self.events) {
            let kind = event.what.kind();
            let row = if kind.is_offence() { MatchEventKind::Foul } else { MatchEventKind::Event };
            let at = Some([milli(event.place.x()), milli(event.place.y())]);
            into.push(MatchEvent {
                at,
                ..MatchEvent::new(t, row, event.by.map(super::team), sentence(event))
            });
        }
        self.events = referee.events().len();
    }

    pub(super) fn kick(&mut self, kick: Option<Kick>, t: f64, into: &mut Vec<MatchEvent>) {
        let Some(kick) = kick else { return };
        let same =
            self.kick.is_some_and(|known| known.at == kick.at || kick.at.since(known.at).0 < SAME_KICK_US);
        self.kick = Some(kick);
        let Some(by) = kick.by.filter(|_| !same) else { return };
        let how = if kick.is_chip() { "chips" } else { "kicks" };
        let (name, number, speed) = (by.colour.label(), by.id.number(), kick.velocity.norm());
        let text = format!("{name} {number} {how} at {speed:.1} m/s");
        let at = Some([milli(kick.from.x()), milli(kick.from.y())]);
        let team = Some(super::team(by.colour));
        into.push(MatchEvent { at, ..MatchEvent::new(t, MatchEventKind::Kick, team, text) });
    }
}

/// The tracker refits a kick as it sees more of it; within this time it is the same one, µs.
const SAME_KICK_US: u64 = 200_000;

/// Kind of a game event of the league by its name: a foul, or any other event.
pub(crate) fn foul_or_event(name: &str) -> MatchEventKind {
    let foul = [
        "BOT_",
        "ATTACKER_",
        "DEFENDER_",
        "KEEPER_HELD",
        "BOUNDARY",
        "TOO_MANY",
        "UNSPORTING",
        "MULTIPLE_FOULS",
    ];
    if foul.iter().any(|begin| name.starts_with(begin)) && name != "BOT_SUBSTITUTION" {
        MatchEventKind::Foul
    } else {
        MatchEventKind::Event
    }
}

fn whose(description: &str) -> Option<PageTeam> {
    let has = |colour: &str| description.split(|c: char| !c.is_alphabetic()).any(|word| word == colour);
    match (has("blue"), has("yellow")) {
        (true, false) => Some(PageTeam::Blue),
        (false, true) => Some(PageTeam::Yellow),
        // "goal, yellow, blue 0 : 1 yellow": the first team is the one that scored.
        (true, true) => description.split(", ").find_map(|part| match part {
            "blue" => Some(PageTeam::Blue),
            "yellow" => Some(PageTeam::Yellow),
            _ => None,
        }),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_is_the_scorers_and_a_command_its_teams() {
        assert_eq!(whose("goal, yellow, blue 0 : 1 yellow"), Some(PageTeam::Yellow));
        assert_eq!(whose("direct free blue"), Some(PageTeam::Blue));
        assert_eq!(whose("halt"), None);
    }

    #[test]
    fn offences_are_distinguished_from_other_events() {
        assert_eq!(foul_or_event("BOT_CRASH_UNIQUE"), MatchEventKind::Foul);
        assert_eq!(foul_or_event("PLACEMENT_SUCCEEDED"), MatchEventKind::Event);
    }
}
