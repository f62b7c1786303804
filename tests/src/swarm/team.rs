//! `team`: a team's cycles in a swarm run.

use protocol::link::{Packet, overhear};
use protocol::team::{Beacon, Closure, CycleState, Decision, Status, TeamMessage};
use protocol::{CycleId, Instant, RobotId};

use super::honest::Believed;
use super::plan::{Plan, TEAM};
use super::{Broken, Counters, Found};
use crate::invariants::{Air, Seen, Watcher};

/// Checks a team's messages.
pub(super) struct TeamWatch {
    watcher: Watcher,
    ids: Vec<RobotId>,
    healed: u32,
    /// Since when the team must start a new cycle.
    owed_since: u32,
    /// The newest cycle when everything healed.
    at_healing: Option<CycleId>,
    /// Time at which all knew one cycle that goes on.
    united: Option<u32>,
    beacons: Vec<Option<Beacon>>,
    /// The last gameplay that ended, while no robot knows a newer cycle.
    ended: Option<(CycleId, u32)>,
    /// The newest cycle whose end was counted.
    counted: Option<CycleId>,
    found: Option<Found>,
    counters: Counters,
}

impl TeamWatch {
    pub(super) fn new(plan: &Plan) -> Self {
        let ids: Vec<RobotId> = plan.ids().collect();
        let mut watcher = Watcher::new(Air::Hostile);
        for id in &ids {
            watcher.see(Instant(0), &Seen::Booted(*id));
        }
        Self {
            watcher,
            beacons: vec![None; ids.len()],
            ids,
            healed: plan.trouble.to,
            owed_since: plan.trouble.to,
            at_healing: None,
            united: None,
            ended: None,
            counted: None,
            found: None,
            counters: Counters { runs: 1, ..Counters::default() },
        }
    }

    pub(super) fn crashed(&mut self, ms: u32, id: RobotId) {
        self.watcher.see(instant(ms), &Seen::Crashed(id));
        if let Some(place) = self.ids.iter().position(|other| *other == id) {
            self.beacons[place] = None;
        }
    }

    pub(super) fn booted(&mut self, ms: u32, id: RobotId) {
        self.watcher.see(instant(ms), &Seen::Booted(id));
    }

    /// A packet was delivered to a robot, which may accept this message of it.
    pub(super) fn received(&mut self, ms: u32, to: RobotId, believed: Option<&Believed>) {
        self.counters.packets += 1;
        self.counters.unbelievable += u64::from(believed.is_none());
        if let Some(Believed::Teammate(from, TeamMessage::Beacon(beacon))) = believed {
            self.watcher.see(instant(ms), &Seen::Received(to, *from, beacon.clone()));
        }
    }

    pub(super) fn note_sent(&mut self, ms: u32, plan: &Plan, packet: &Packet) {
        let Ok((from, TeamMessage::Beacon(beacon))) = overhear(packet, TEAM, &plan.key.of_team()) else {
            return;
        };
        if let Some(cycle) = &beacon.cycle {
            let players = cycle.play().map_or(&[][..], |play| &play.robots[..]);
            let ghost = players.iter().chain([&cycle.coordinator]).find(|id| !self.ids.contains(id));
            if let Some(ghost) = ghost {
                self.find(ms, Broken::Ghost(from, *ghost));
            }
        }
        if let Some(CycleState { id, decision: Decision::Closed(end), .. }) = beacon.cycle {
            self.end(ms, id, end);
        }
        self.watcher.see(instant(ms), &Seen::Sent(from, beacon.clone()));
        if let Some(place) = self.ids.iter().position(|other| *other == from) {
            self.beacons[place] = Some(beacon);
        }
    }

    /// A gameplay, or an attempt at one, is over.
    fn end(&mut self, ms: u32, id: CycleId, end: Closure) {
        if self.counted.is_some_and(|counted| id <= counted) {
            return;
        }
        self.counted = Some(id);
        match end {
            Closure::Finished => self.counters.finished += 1,
            Closure::Aborted { .. } => self.counters.stopped += 1,
            Closure::NoCase => return,
        }
        self.ended.get_or_insert((id, ms));
    }

    pub(super) fn braked(&mut self, steps: u64) {
        self.counters.brakings += steps;
    }

    /// An armed robot has lost its host; or stands for that reason for another tick, ms.
    pub(super) fn stood(&mut self, begins: bool, ms: u32) {
        self.counters.false_stops += u32::from(begins);
        self.counters.stood_ms += u64::from(ms);
    }

    /// Records a violation; the first one is kept.
    pub(super) fn find(&mut self, ms: u32, broken: Broken) {
        self.found.get_or_insert(Found { ms, broken });
    }

    /// To be called after all observations of this moment; returns the first violation so far.
    pub(super) fn end_of_step(&mut self, ms: u32) -> Result<(), Found> {
        self.watcher.end_of_step(instant(ms));
        if let Some(violation) = self.watcher.violations().first() {
            let what = violation.what.clone();
            self.find(ms, Broken::Team(what));
        }
        if let Some((id, since)) = self.ended {
            let newest = self.watcher.newest_by_robot();
            if newest.iter().all(|known| known.is_some_and(|known| known > id)) {
                self.counters.gaps += 1;
                self.counters.gaps_ms += u64::from(ms - since);
                self.ended = None;
            }
        }
        if ms <= self.healed + LAST_TICK || !self.has_retriever() {
            // Where no robot is left that could be named coordinator, the team's time starts when one comes
            // back.
            self.owed_since = ms;
        }
        if ms <= self.healed + LAST_TICK {
            self.at_healing = self.watcher.newest_by_robot().into_iter().flatten().max();
        } else if self.united.is_none() && self.plays() {
            self.united = Some(ms);
            self.counters.slowest_ms = ms - self.healed;
        } else if self.united.is_none() && ms > self.owed_since + RECOVER_WITHIN {
            let states: Vec<String> = self.ids.iter().zip(&self.beacons).map(beacon_text).collect();
            self.find(ms, Broken::Dead(states.join("; ")));
        }
        self.found.clone().map_or(Ok(()), Err)
    }

    pub(super) fn counters(&self) -> Counters {
        let Watcher { cycles, gameplays, overlaps, .. } = self.watcher;
        Counters { cycles, gameplays, overlaps, ..self.counters }
    }

    /// Whether a robot is present that may retrieve and could be named coordinator.
    fn has_retriever(&self) -> bool {
        let both = Status::AVAILABLE.with(Status::RETRIEVER);
        // A robot that has not sent yet in this epoch is still listening.
        self.beacons.iter().flatten().any(|beacon| beacon.status.has(both))
            || self.beacons.iter().any(Option::is_none)
            || self.beacons.iter().flatten().any(|beacon| beacon.cycle.is_none())
    }

    /// Whether all know the same cycle, and it is a new one or a gameplay that goes on.
    fn plays(&self) -> bool {
        let newest = self.watcher.newest_by_robot();
        let Some(Some(id)) = newest.first() else { return false };
        let one = newest.len() == self.ids.len() && newest.iter().all(|other| *other == Some(*id));
        let gameplay = || {
            let cycle = |beacon: &Beacon| beacon.cycle.as_ref().is_some_and(|cycle| cycle.play().is_some());
            self.beacons.iter().all(|beacon| beacon.as_ref().is_some_and(cycle))
        };
        one && (Some(*id) > self.at_healing || gameplay())
    }
}

fn beacon_text((id, beacon): (&RobotId, &Option<Beacon>)) -> String {
    match beacon {
        None => format!("{id} silent"),
        Some(beacon) => {
            let cycle = beacon.cycle.as_ref().map_or("no cycle".into(), |cycle| {
                format!("{} of {}: {:?}", cycle.id, cycle.coordinator, cycle.decision)
            });
            format!("{id} status {} {cycle} {:?}", beacon.status.0, beacon.progress)
        }
    }
}

fn instant(ms: u32) -> Instant {
    Instant(u64::from(ms) * 1000)
}

/// Events of the plan take effect in the next tick, ms: 40 at most.
const LAST_TICK: u32 = 40;
/// A new cycle comes within this time of healing, ms (docs/architecture.md §5.4).
const RECOVER_WITHIN: u32 = 1_000;
