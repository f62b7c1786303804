//! `commanders`: detection of two programs that command one robot of the simulator. Both programs' commands
//! are then executed alternately, and the robots shake. Times in the program's own.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;

use rules::Colour;
use ssl::Message;
use ssl::simulation::RobotControl;

/// Changes of the sender are counted over this time.
const COUNTED_OVER: Duration = Duration::from_secs(1);
/// This number of changes in the window means two programs: a program that restarts changes the sender once.
const CHANGES_OF_TWO: usize = 5;
/// A lasting conflict is reported again after this.
const REPEAT_AFTER: Duration = Duration::from_secs(10);

/// The sender of a robot's commands.
#[derive(Debug)]
struct Commanded {
    by: SocketAddr,
    /// The sender before that, and when the sender changed recently.
    before: SocketAddr,
    changes: Vec<Duration>,
}

/// Senders of the commands, by robot.
#[derive(Debug, Default)]
pub(super) struct Commanders {
    robots: BTreeMap<(Colour, u32), Commanded>,
    message: BTreeMap<Colour, Duration>,
}

impl Commanders {
    /// Takes a datagram of a team's port; returns a message where another program commands the same robots.
    pub(super) fn receive(
        &mut self,
        now: Duration,
        team: Colour,
        from: SocketAddr,
        bytes: &[u8],
    ) -> Option<String> {
        let control = RobotControl::decode(bytes).ok()?;
        let mut contested = None;
        // A robot has a number below 16; others are refused by the simulator.
        for command in control.robot_commands.iter().filter(|command| command.id < 16) {
            let robot = self.robots.entry((team, command.id)).or_insert_with(|| Commanded {
                by: from,
                before: from,
                changes: Vec::new(),
            });
            robot.changes.retain(|at| now.saturating_sub(*at) < COUNTED_OVER);
            if robot.by != from {
                robot.before = std::mem::replace(&mut robot.by, from);
                robot.changes.push(now);
            }
            if robot.changes.len() >= CHANGES_OF_TWO {
                contested = Some((command.id, robot.before));
            }
        }
        let (id, other) = contested?;
        if self.message.get(&team).is_some_and(|at| now.saturating_sub(*at) < REPEAT_AFTER) {
            return None;
        }
        self.message.insert(team, now);
        Some(format!(
            "two programs command {} robot {id}: {other} and {from}; end one of them, or give it the other --colour",
            team.label()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssl::simulation::RobotCommand;

    fn control(id: u32) -> Vec<u8> {
        let command = RobotCommand { id, ..RobotCommand::default() };
        RobotControl { robot_commands: vec![command] }.encode_to_vec()
    }

    /// The messages of 25 s in which robot 3 is commanded 60 times a second from these ports by turns.
    fn message(ports: impl Fn(u64) -> u16) -> Vec<(u128, String)> {
        let mut commanders = Commanders::default();
        let one = |n: u64| {
            let now = Duration::from_millis(n * 1000 / 60);
            let from = SocketAddr::from(([127, 0, 0, 1], ports(n)));
            Some((now.as_millis(), commanders.receive(now, Colour::Blue, from, &control(3))?))
        };
        (0..25 * 60).filter_map(one).collect()
    }

    #[test]
    fn two_commanders_of_a_robot_are_reported_within_2_s_and_every_10_s() {
        let message = message(|n| 4_000 + (n % 2) as u16);
        assert_eq!(message.len(), 3, "{message:?}");
        assert!(message[0].0 < 2_000 && message[0].1.contains("blue robot 3"), "{message:?}");
        assert!(
            message[0].1.contains("127.0.0.1:4000") && message[0].1.contains("127.0.0.1:4001"),
            "{message:?}"
        );
    }

    #[test]
    fn one_program_and_one_that_starts_again_are_in_order() {
        assert!(message(|_| 4_000).is_empty());
        assert!(message(|n| 4_000 + (n / 300) as u16).is_empty());
    }
}
