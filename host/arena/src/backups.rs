//! `backups`: count of backups per robot. Entries into the supporting role, as its beacons report (paper
//! §5.2.1, Table 2; docs/papers.md R36).

use protocol::RobotId;
use protocol::team::Role;

/// Counts one team's backing up.
#[derive(Clone, Debug)]
pub(crate) struct BackupCount {
    robots: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    robot: RobotId,
    role: Role,
    /// Time of the last counted entry, s.
    counted_at: Option<f32>,
    count: u32,
}

impl BackupCount {
    pub(crate) fn new(robots: impl IntoIterator<Item = RobotId>) -> Self {
        Self {
            robots: robots
                .into_iter()
                .map(|robot| Entry { robot, role: Role::None, counted_at: None, count: 0 })
                .collect(),
        }
    }

    /// `robot` reported `role` at `time` seconds.
    pub(crate) fn receive(&mut self, time: f32, robot: RobotId, role: Role) {
        let Some(entry) = self.robots.iter_mut().find(|entry| entry.robot == robot) else { return };
        let enters = role == Role::Supporter && entry.role != Role::Supporter;
        entry.role = role;
        if enters && entry.counted_at.is_none_or(|at| time - at >= GAP) {
            entry.counted_at = Some(time);
            entry.count += 1;
        }
    }

    /// Number of backups, by robot in the order given.
    pub(crate) fn counts(&self) -> Vec<u32> {
        self.robots.iter().map(|entry| entry.count).collect()
    }
}

/// Least time between two counted entries, s: flicker between roles is one backing up.
const GAP: f32 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_count_and_flicker_does_not() {
        let id = |n| RobotId::new(n).unwrap();
        let mut count = BackupCount::new([id(1), id(2)]);
        for (time, role) in [
            (0.0, Role::Attacker),
            (1.0, Role::Supporter),
            (1.1, Role::Supporter),
            (1.2, Role::Attacker),
            (1.4, Role::Supporter),
            (1.6, Role::None),
            (1.7, Role::Supporter),
        ] {
            count.receive(time, id(2), role);
        }
        count.receive(2.0, id(9), Role::Supporter);
        assert_eq!(count.counts(), [0, 2]);
    }
}
