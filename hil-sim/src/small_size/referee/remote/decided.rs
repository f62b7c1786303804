//! `decided`: game events that the controller finds by itself, as ours. m, s; times of the simulation, µs.

use geometry::{Field, Point};
use protocol::Instant;
use ssl::event::{Event as Reported, GameEvent};
use ssl::referee::Referee;

use super::super::event::{PenaltyEnd, RefereeEvent, What};
use super::colour_of;

/// Tells new events of the controller's engine from those of earlier packets.
#[derive(Clone, Debug, Default)]
pub(super) struct EngineEvents {
    /// Identifiers of the events of the newest packet.
    known: Vec<String>,
}

impl EngineEvents {
    /// The events of the engine that are new in this packet, which was received at `at` with the ball here.
    pub(super) fn new_in(&mut self, packet: &Referee, at: Instant, ball: Point<Field>) -> Vec<RefereeEvent> {
        let known = std::mem::take(&mut self.known);
        self.known = packet.game_events.iter().filter_map(|event| event.id.clone()).collect();
        let new = |event: &&GameEvent| event.id.as_ref().is_some_and(|id| !known.contains(id));
        let own = |event: &&GameEvent| event.origin.iter().all(|origin| origin == ENGINE);
        let found = packet.game_events.iter().filter(new).filter(own);
        found.filter_map(|event| ours(event.event.as_ref()?, at, ball)).collect()
    }
}

fn ours(event: &Reported, at: Instant, ball: Point<Field>) -> Option<RefereeEvent> {
    let count = |number: Option<i32>| number.and_then(|number| u32::try_from(number).ok()).unwrap_or(0);
    let (team, what) = match event {
        Reported::NoProgressInGame(event) => {
            (0, What::NoProgress { duration: event.time.unwrap_or_default() })
        }
        Reported::KeeperHeldBall(event) => {
            (event.by_team, What::KeeperHeldBall { duration: event.duration.unwrap_or_default() })
        }
        Reported::PlacementFailed(event) => {
            let remaining = event.remaining_distance.unwrap_or_default();
            let nearest = event.nearest_own_bot_distance.unwrap_or(-1.0);
            (event.by_team, What::PlacementFailed { remaining, nearest })
        }
        Reported::TooManyRobots(event) => {
            let (allowed, on_field) = (count(event.num_robots_allowed), count(event.num_robots_on_field));
            (event.by_team, What::TooManyRobots { allowed, on_field, ball })
        }
        Reported::PenaltyKickFailed(event) => {
            (event.by_team, What::PenaltyFailed { reason: PenaltyEnd::TimeUp })
        }
        // The three fouls were reported by ours.
        Reported::MultipleFouls(event) => (event.by_team, What::MultipleFouls { caused_by: Vec::new() }),
        Reported::MultipleCards(event) => (event.by_team, What::MultipleCards),
        _ => return None,
    };
    Some(RefereeEvent { at, by: colour_of(team), robot: None, place: ball, what })
}

/// Origin of the events that the controller finds by itself.
const ENGINE: &str = "Engine";
