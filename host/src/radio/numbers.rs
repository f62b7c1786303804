//! `numbers`: the number on a robot's shell, by which cameras, referee and operators know it, and its radio
//! number, with which it was flashed. [`super::Radio`] takes and gives shell numbers; the frames carry radio
//! numbers.

use protocol::RobotId;
use protocol::decision::{DecisionReport, Grounds};
use protocol::host::{Directive, HostCommand};
use protocol::team::{Beacon, Closure, Decision};

/// Radio number of each shell number. No two robots have the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotNumbers {
    given: [Option<RobotId>; RobotId::COUNT],
    radio: [RobotId; RobotId::COUNT],
}

impl Default for RobotNumbers {
    /// Every robot has one number.
    fn default() -> Self {
        let mut radio = [RobotId::ZERO; RobotId::COUNT];
        for robot in RobotId::all() {
            radio[robot.index()] = robot;
        }
        Self { given: [None; RobotId::COUNT], radio }
    }
}

impl RobotNumbers {
    /// With the radio numbers given, by shell number; every other robot keeps its shell's number or, where
    /// that is given away, gets the lowest that is left. Error: the two shells that are given one number.
    pub fn new(given: [Option<RobotId>; RobotId::COUNT]) -> Result<Self, [RobotId; 2]> {
        let mut owner = [None; RobotId::COUNT];
        let mut numbers = Self { given, ..Self::default() };
        for shell in RobotId::all() {
            let Some(radio) = given[shell.index()] else { continue };
            if let Some(first) = owner[radio.index()].replace(shell) {
                return Err([first, shell]);
            }
            numbers.radio[shell.index()] = radio;
        }
        let (given, owned) = (given.map(|radio| radio.is_some()), owner.map(|shell| shell.is_some()));
        let homeless = RobotId::all().filter(|shell| !given[shell.index()] && owned[shell.index()]);
        let free = RobotId::all().filter(|radio| !owned[radio.index()] && given[radio.index()]);
        for (shell, radio) in homeless.zip(free) {
            numbers.radio[shell.index()] = radio;
        }
        Ok(numbers)
    }

    /// The radio number given to a shell; none: it was given none.
    pub fn given(&self, shell: RobotId) -> Option<RobotId> {
        self.given[shell.index()]
    }

    /// The radio number of a shell.
    pub fn radio(&self, shell: RobotId) -> RobotId {
        self.radio[shell.index()]
    }

    /// The shell of a radio number.
    pub fn shell(&self, radio: RobotId) -> RobotId {
        RobotId::all().find(|shell| self.radio(*shell) == radio).unwrap_or(radio)
    }

    /// A command as the robot understands it.
    pub(super) fn command(&self, command: &HostCommand) -> HostCommand {
        let mut command = command.clone();
        command.to = self.radio(command.to);
        match &mut command.directive {
            Directive::Pass { receiver, .. } => *receiver = self.radio(*receiver),
            Directive::Gameplay { hint: Some(hint) } => {
                for robot in &mut hint.robots {
                    *robot = self.radio(*robot);
                }
            }
            _ => {}
        }
        command
    }

    /// A robot's beacon with the shell numbers of those that it names. The cycle's id stays: robots order
    /// cycles by it.
    pub(super) fn beacon(&self, mut beacon: Beacon) -> Beacon {
        if let Some(cycle) = &mut beacon.cycle {
            cycle.coordinator = self.shell(cycle.coordinator);
            match &mut cycle.decision {
                Decision::Play(play) => {
                    for robot in &mut play.robots {
                        *robot = self.shell(*robot);
                    }
                }
                Decision::Closed(Closure::Aborted { by, .. }) => *by = self.shell(*by),
                _ => {}
            }
        }
        beacon
    }

    /// A robot's decision with the shell numbers of those that it names.
    pub(crate) fn report(&self, mut report: DecisionReport) -> DecisionReport {
        if let Grounds::Holds(robot) = &mut report.grounds {
            *robot = self.shell(*robot);
        }
        for (robot, _) in &mut report.teammates {
            *robot = self.shell(*robot);
        }
        report.teammates.sort_unstable_by_key(|(robot, _)| robot.number());
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(number: u8) -> RobotId {
        RobotId::new(number).unwrap()
    }

    fn numbers(pairs: &[(u8, u8)]) -> Result<RobotNumbers, [RobotId; 2]> {
        let mut given = [None; RobotId::COUNT];
        for (shell, radio) in pairs {
            given[usize::from(*shell)] = Some(id(*radio));
        }
        RobotNumbers::new(given)
    }

    #[test]
    fn every_robot_has_one_radio_number_whichever_are_given() {
        for pairs in [&[][..], &[(4, 0)], &[(4, 0), (0, 7)], &[(1, 2), (2, 1)], &[(9, 9), (0, 15), (3, 0)]] {
            let numbers = numbers(pairs).unwrap();
            assert!(RobotId::all().all(|shell| numbers.shell(numbers.radio(shell)) == shell), "{pairs:?}");
            assert!(pairs.iter().all(|(shell, radio)| numbers.radio(id(*shell)) == id(*radio)), "{pairs:?}");
        }
        let swapped = numbers(&[(4, 0)]).unwrap();
        assert_eq!((swapped.radio(id(0)), swapped.radio(id(5))), (id(4), id(5)), "the number that is left");
        assert_eq!(numbers(&[(4, 0), (2, 0)]), Err([id(2), id(4)]));
    }
}
