//! `teammates`: the newest beacon of every teammate, with a lease.

use geometry::{Field, Pose};
use protocol::team::{Beacon, CycleState, PRESENCE_LEASE, Progress, Status};
use protocol::{CycleId, Instant, RobotId};

/// A teammate's newest beacon.
#[derive(Clone, Debug)]
pub struct Teammate {
    /// The newest beacon received from it.
    pub beacon: Beacon,
    /// When it was received.
    pub received: Instant,
}

impl Teammate {
    /// Its pose as reported.
    pub fn pose(&self) -> Pose<Field> {
        self.beacon.pose.into()
    }

    /// Its progress in cycle `id`; `None` while it reports another.
    pub fn progress_in(&self, id: CycleId) -> Option<Progress> {
        self.beacon.cycle.as_ref().filter(|c| c.id == id).map(|_| self.beacon.progress)
    }

    /// Its state of cycle `id`.
    pub fn knows(&self, id: CycleId) -> Option<&CycleState> {
        self.beacon.cycle.as_ref().filter(|c| c.id == id)
    }
}

/// The newest beacon of each teammate received.
#[derive(Clone, Debug, Default)]
pub struct Teammates {
    table: [Option<Teammate>; RobotId::COUNT],
    /// A bit for each robot that a beacon was ever received from.
    received: u16,
}

impl Teammates {
    /// Stores `beacon` as the newest of robot `from`, received at `now`.
    pub fn receive(&mut self, now: Instant, from: RobotId, beacon: &Beacon) {
        self.received |= 1 << from.index();
        self.table[from.index()] = Some(Teammate { beacon: beacon.clone(), received: now });
    }

    /// Whether a beacon of that robot was received since this one booted, however long ago.
    pub fn has_received(&self, id: RobotId) -> bool {
        self.received & 1 << id.index() != 0
    }

    /// The teammate, if it is present: received within the lease and available.
    pub fn get(&self, now: Instant, id: RobotId) -> Option<&Teammate> {
        self.table[id.index()].as_ref().filter(|teammate| is_present(now, teammate))
    }

    /// Every present teammate, lowest id first.
    pub fn present(&self, now: Instant) -> impl Iterator<Item = (RobotId, &Teammate)> {
        RobotId::all()
            .zip(&self.table)
            .filter_map(|(id, teammate)| teammate.as_ref().map(|m| (id, m)))
            .filter(move |(_, teammate)| is_present(now, teammate))
    }

    /// Whether the newest beacon of any teammate reports that it holds the ball.
    pub fn anyone_holds_ball(&self) -> bool {
        self.table.iter().flatten().any(|teammate| teammate.beacon.status.has(Status::HOLDS_BALL))
    }

    /// Drops the beacons of teammates that have been silent for longer than the lease.
    pub fn forget_the_silent(&mut self, now: Instant) {
        for slot in &mut self.table {
            if slot.as_ref().is_some_and(|teammate| now.since(teammate.received) > PRESENCE_LEASE) {
                *slot = None;
            }
        }
    }
}

fn is_present(now: Instant, teammate: &Teammate) -> bool {
    now.since(teammate.received) <= PRESENCE_LEASE && teammate.beacon.status.has(Status::AVAILABLE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::quantized::WirePose;
    use protocol::team::Role;

    fn beacon(status: Status) -> Beacon {
        Beacon {
            pose: WirePose::default(),
            ball: None,
            status,
            case_base: 0,
            cycle: None,
            progress: Progress::Idle,
            role: Role::None,
        }
    }

    #[test]
    fn presence_ends_with_the_lease_and_needs_availability() {
        let mut teammates = Teammates::default();
        let (one, two) = (RobotId::new(1).unwrap(), RobotId::new(2).unwrap());
        teammates.receive(Instant(0), two, &beacon(Status::AVAILABLE));
        teammates.receive(Instant(0), one, &beacon(Status::default()));
        assert_eq!(
            teammates.present(Instant(400_000)).map(|(id, _)| id).collect::<heapless::Vec<_, 4>>(),
            [two]
        );
        assert_eq!(teammates.present(Instant(400_001)).count(), 0);
    }

    #[test]
    fn a_silent_holder_is_forgotten() {
        let mut teammates = Teammates::default();
        teammates.receive(Instant(0), RobotId::new(3).unwrap(), &beacon(Status::HOLDS_BALL));
        teammates.forget_the_silent(Instant(400_000));
        assert!(teammates.anyone_holds_ball());
        teammates.forget_the_silent(Instant(400_001));
        assert!(!teammates.anyone_holds_ball());
    }
}
