//! `invariants`: coordination invariants of a team. The coordination invariants of docs/architecture.md §5.4,
//! checked from outside the brain.
//!
//! The watcher sees only what an eavesdropper with the key sees: which beacon each robot sent and received,
//! and when robots crashed, came back, and the radio was partitioned or healed. The motion of a robot's body
//! in a step is judged by the beacon of the same step, which the brain sends after it has decided.

use std::collections::BTreeMap;

use protocol::team::{Beacon, CycleState, Decision, Play, Progress, Status};
use protocol::{CycleId, Duration, Instant, RobotId};

/// An observation from outside.
#[derive(Clone, Debug)]
pub enum Seen {
    /// A robot sent this beacon.
    Sent(RobotId, Beacon),
    /// A robot received this beacon of another.
    Received(RobotId, RobotId, Beacon),
    /// A robot crashed: its computer stopped.
    Crashed(RobotId),
    /// A robot boots into a new epoch.
    Booted(RobotId),
}

/// A violated invariant with its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Time of the violation, µs.
    pub at: Instant,
    /// What was violated, one sentence.
    pub what: String,
}

/// State of the radio, on which the invariants depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Air {
    /// No loss: gameplays never overlap longer than [`LEAVE_WITHIN`].
    Lossless,
    /// Packets are lost: overlaps are counted, robots leave the old gameplay when they receive the new one.
    Lossy,
    /// Any fault of packets: as with loss, and no new cycle is required after a fault until everything has
    /// healed.
    Hostile,
}

/// Watches a team's beacons, and keeps violations and counts.
#[derive(Debug)]
pub struct Watcher {
    air: Air,
    robots: BTreeMap<RobotId, Watched>,
    contents: BTreeMap<CycleId, Content>,
    overlap_since: Option<Instant>,
    pending: Option<Pending>,
    /// Number of times that two gameplays ran at once.
    pub overlaps: u32,
    /// Number of cycles seen.
    pub cycles: u32,
    /// Number of gameplays that started.
    pub gameplays: u32,
    /// The longest time from a fault to the next cycle.
    pub slowest_recovery: Duration,
    violations: Vec<Violation>,
}

#[derive(Clone, Debug, Default)]
struct Watched {
    beacon: Option<Beacon>,
    /// The newest cycle it has received, and since when.
    reported: Option<(CycleState, Instant)>,
}

/// The content of all beacons of a cycle together.
#[derive(Clone, Debug)]
struct Content {
    coordinator: RobotId,
    play: Option<Play>,
    closed: bool,
}

/// A fault after which the team must start a new cycle.
#[derive(Clone, Copy, Debug)]
struct Pending {
    lost: RobotId,
    /// Time of the fault; where packets are lost, of the first beacon that any robot received after it.
    since: Instant,
    received_since: bool,
    newer_than: CycleId,
}

/// A robot of an older gameplay leaves it within this time of receiving a newer cycle (docs/architecture.md
/// §5.4).
pub const LEAVE_WITHIN: Duration = Duration::millis(150);
/// A new cycle comes within this time of a fault (docs/architecture.md §5.4).
pub const RECOVER_WITHIN: Duration = Duration::millis(1000);

impl Watcher {
    /// A watcher before the first observation.
    pub fn new(air: Air) -> Self {
        Self {
            air,
            robots: BTreeMap::new(),
            contents: BTreeMap::new(),
            overlap_since: None,
            pending: None,
            overlaps: 0,
            cycles: 0,
            gameplays: 0,
            slowest_recovery: Duration(0),
            violations: Vec::new(),
        }
    }

    /// Every violation so far.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// The newest cycle of every running robot; `None` for one that knows of none.
    pub fn newest_by_robot(&self) -> Vec<Option<CycleId>> {
        self.robots.values().map(|w| w.beacon.as_ref()?.cycle.as_ref().map(|c| c.id)).collect()
    }

    /// Takes an observation at `now`; to be called in order.
    pub fn see(&mut self, now: Instant, seen: &Seen) {
        match seen {
            Seen::Booted(id) => {
                self.robots.insert(*id, Watched::default());
            }
            Seen::Crashed(id) => self.crashed(now, *id),
            Seen::Received(id, _, beacon) => self.received(now, *id, beacon),
            Seen::Sent(id, beacon) => self.sent(now, *id, beacon),
        }
    }

    /// To be called after all observations of one moment.
    pub fn end_of_step(&mut self, now: Instant) {
        let running: Vec<CycleId> = self.robots.iter().filter_map(|(id, w)| active_in(*id, w)).collect();
        // A robot that received a newer cycle, or the end of this one, must have left it from that step on.
        // It may have sent in this step before it received; its motion is decided last.
        let stubborn: Vec<String> = self
            .robots
            .iter()
            .filter_map(|(id, watched)| {
                let (active, (reported, _)) = (active_in(*id, watched)?, watched.reported.as_ref()?);
                let closed = reported.id == active && matches!(reported.decision, Decision::Closed(_));
                (reported.id > active || closed)
                    .then(|| format!("robot {id} plays on in {active} after hearing of {reported:?}"))
            })
            .collect();
        for what in stubborn {
            self.violate(now, what);
        }
        let overlapping = running.windows(2).any(|pair| pair[0] != pair[1]);
        if !overlapping {
            self.overlap_since = None;
        } else if let Some(since) = self.overlap_since {
            if self.air == Air::Lossless && now.since(since) > LEAVE_WITHIN {
                self.violate(now, format!("two gameplays have run at once since {} ms", since.0 / 1000));
            }
        } else {
            self.overlap_since = Some(now);
            self.overlaps += 1;
        }
        let Some(pending) = &mut self.pending else { return };
        let retrieves = |w: &Watched| w.beacon.as_ref().is_some_and(|b| b.status.has(Status::RETRIEVER));
        if !self.robots.values().any(retrieves) {
            // No robot is left that could be named coordinator: the team's time starts when one comes back.
            pending.since = now;
        }
        let pending = *pending;
        let newer = self.newest().is_some_and(|id| id > pending.newer_than);
        if newer || self.plays_on_without(pending.lost) {
            self.slowest_recovery = self.slowest_recovery.max(now.since(pending.since));
            self.pending = None;
        } else if now.since(pending.since) > RECOVER_WITHIN {
            self.violate(now, format!("no new cycle since the fault at {} ms", pending.since.0 / 1000));
            self.pending = None;
        }
    }

    fn crashed(&mut self, now: Instant, id: RobotId) {
        let newest = self.newest();
        self.robots.remove(&id);
        // The remaining robots must start a new cycle, unless a gameplay goes on without the lost robot.
        let goes_on = self.plays_on_without(id);
        let owed = self.air != Air::Hostile && !goes_on && !self.robots.is_empty();
        if let (Some(newer_than), true) = (newest, owed) {
            self.pending = Some(Pending { lost: id, since: now, received_since: false, newer_than });
        }
    }

    /// Whether a gameplay runs in the newest cycle, and the lost robot neither plays in it nor coordinates
    /// it.
    fn plays_on_without(&self, lost: RobotId) -> bool {
        self.newest().and_then(|newest| self.contents.get(&newest)).is_some_and(|content| {
            let play = content.play.as_ref().filter(|_| !content.closed);
            content.coordinator != lost && play.is_some_and(|play| play.part_of(lost).is_none())
        })
    }

    fn received(&mut self, now: Instant, id: RobotId, beacon: &Beacon) {
        if let (Some(pending), Air::Lossy) = (&mut self.pending, self.air)
            && !pending.received_since
        {
            (pending.since, pending.received_since) = (now, true);
        }
        let (Some(watched), Some(cycle)) = (self.robots.get_mut(&id), &beacon.cycle) else { return };
        if cycle.is_newer_than(watched.reported.as_ref().map(|(state, _)| state)) {
            watched.reported = Some((cycle.clone(), now));
        }
    }

    fn sent(&mut self, now: Instant, id: RobotId, beacon: &Beacon) {
        if let Some(cycle) = &beacon.cycle {
            self.agree(now, cycle);
        }
        let Some(watched) = self.robots.get_mut(&id) else { return };
        let before = watched.beacon.as_ref().and_then(|b| b.cycle.as_ref());
        let backwards = before.is_some_and(|before| {
            beacon.cycle.as_ref().is_none_or(|cycle| before.is_newer_than(Some(cycle)))
        });
        watched.beacon = Some(beacon.clone());
        if backwards {
            self.violate(now, format!("robot {id} went back to an older state of its cycle"));
        }
    }

    /// Checks that a cycle has one coordinator and one gameplay.
    fn agree(&mut self, now: Instant, cycle: &CycleState) {
        let new = !self.contents.contains_key(&cycle.id);
        let entry = self.contents.entry(cycle.id).or_insert(Content {
            coordinator: cycle.coordinator,
            play: None,
            closed: false,
        });
        let mut complaint = None;
        if entry.coordinator != cycle.coordinator {
            complaint = Some(format!("cycle {} has two coordinators", cycle.id));
        }
        entry.closed |= matches!(cycle.decision, Decision::Closed(_));
        if let Some(play) = cycle.play() {
            match &entry.play {
                None => {
                    entry.play = Some(play.clone());
                    self.gameplays += 1;
                }
                Some(known) if known != play => {
                    complaint = Some(format!("cycle {} has two gameplays: {known:?} and {play:?}", cycle.id));
                }
                Some(_) => {}
            }
        }
        self.cycles += u32::from(new);
        if let Some(what) = complaint {
            self.violate(now, what);
        }
    }

    fn newest(&self) -> Option<CycleId> {
        self.robots.values().filter_map(|w| w.beacon.as_ref()?.cycle.as_ref()).map(|c| c.id).max()
    }

    fn violate(&mut self, at: Instant, what: String) {
        self.violations.push(Violation { at, what });
    }
}

/// The cycle whose gameplay this robot's body executes.
fn active_in(id: RobotId, watched: &Watched) -> Option<CycleId> {
    let beacon = watched.beacon.as_ref()?;
    let cycle = beacon.cycle.as_ref()?;
    let involved = cycle.play().is_some_and(|play| play.part_of(id).is_some());
    let busy = matches!(beacon.progress, Progress::Adapt { .. } | Progress::Execute { .. });
    (involved && busy).then_some(cycle.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::CaseId;
    use protocol::quantized::{WirePoint, WirePose};
    use protocol::team::{AbortReason, Closure, Role};

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn beacon(counter: u32, decision: Decision, progress: Progress) -> Beacon {
        let id = CycleId { counter, proposer: robot(1) };
        Beacon {
            pose: WirePose::default(),
            ball: None,
            status: Status::AVAILABLE.with(Status::RETRIEVER),
            case_base: 1,
            cycle: Some(CycleState { id, coordinator: robot(1), decision }),
            progress,
            role: Role::None,
        }
    }

    fn play(robots: &[u8]) -> Decision {
        let robots = robots.iter().map(|&n| robot(n)).collect();
        Decision::Play(Play { case: CaseId(1), ball: WirePoint::default(), robots })
    }

    fn watch(air: Air) -> Watcher {
        let mut watcher = Watcher::new(air);
        for n in [1, 2] {
            watcher.see(Instant(0), &Seen::Booted(robot(n)));
        }
        watcher
    }

    const BUSY: Progress = Progress::Execute { done: 0 };

    #[test]
    fn without_loss_a_long_overlap_of_gameplays_is_a_violation() {
        for (air, expected) in [(Air::Lossless, true), (Air::Lossy, false)] {
            let mut watcher = watch(air);
            for ms in [0, 80, 160] {
                let now = Instant(ms * 1000);
                watcher.see(now, &Seen::Sent(robot(1), beacon(2, play(&[1]), BUSY)));
                watcher.see(now, &Seen::Sent(robot(2), beacon(1, play(&[2]), BUSY)));
                watcher.end_of_step(now);
            }
            assert_eq!(!watcher.violations().is_empty(), expected, "{air:?}");
            assert_eq!(watcher.overlaps, 1);
        }
    }

    #[test]
    fn playing_on_after_hearing_an_abort_is_a_violation() {
        let mut watcher = watch(Air::Lossy);
        let abort = Closure::Aborted { by: robot(2), reason: AbortReason::Timeout };
        watcher.see(Instant(0), &Seen::Sent(robot(1), beacon(1, play(&[1]), BUSY)));
        let end = beacon(1, Decision::Closed(abort), Progress::Idle);
        watcher.see(Instant(40_000), &Seen::Received(robot(1), robot(2), end));
        watcher.see(Instant(40_000), &Seen::Sent(robot(1), beacon(1, play(&[1]), BUSY)));
        watcher.end_of_step(Instant(40_000));
        assert_eq!(watcher.violations().len(), 1);
    }

    #[test]
    fn a_team_that_never_recovers_is_a_violation() {
        let mut watcher = watch(Air::Lossless);
        watcher.see(Instant(0), &Seen::Sent(robot(2), beacon(1, play(&[1, 2]), BUSY)));
        watcher.see(Instant(0), &Seen::Crashed(robot(1)));
        watcher.end_of_step(Instant(990_000));
        assert!(watcher.violations().is_empty());
        watcher.end_of_step(Instant(1_001_000));
        assert_eq!(watcher.violations().len(), 1);
    }

    #[test]
    fn two_gameplays_in_one_cycle_are_a_violation() {
        let mut watcher = watch(Air::Lossy);
        watcher.see(Instant(0), &Seen::Sent(robot(1), beacon(1, play(&[1]), BUSY)));
        watcher.see(Instant(0), &Seen::Sent(robot(2), beacon(1, play(&[2]), BUSY)));
        assert_eq!(watcher.violations().len(), 1);
    }
}
