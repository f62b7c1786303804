//! `names`: names of robots and cases. A, B, C, D as in the paper's figures; cases by `region/name`
//! (docs/case-format.md §2).

use casebase::Symmetry;
use hil_sim::OpponentRole;
use protocol::{CaseId, RobotId};

/// Identities of the robots: attackers by id, then opponents, as in `hil_sim::four_legged::world::World`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cast {
    /// Ids of the robots with brains.
    pub attackers: Vec<RobotId>,
    /// Roles of the scripted robots.
    pub opponents: Vec<OpponentRole>,
}

impl Cast {
    /// The name of the robot in place `robot` of the world's list.
    pub fn name(&self, robot: usize) -> String {
        match robot.checked_sub(self.attackers.len()) {
            None => letter(robot).to_string(),
            Some(i) => match self.opponents.get(i) {
                Some(OpponentRole::Midfield) => "the midfield defender".to_owned(),
                Some(role) => format!("the {}", role.label()),
                None => format!("robot {robot}"),
            },
        }
    }

    /// The name of an attacker by its id.
    pub fn name_of(&self, id: RobotId) -> String {
        self.attackers.iter().position(|a| *a == id).map_or_else(|| format!("robot {id}"), |i| self.name(i))
    }
}

/// The names of a library's cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaseNames(Vec<String>);

impl CaseNames {
    /// `region/name` per authored case, in the order of ids.
    pub fn new<S: Into<String>>(names: impl IntoIterator<Item = S>) -> Self {
        Self(names.into_iter().map(Into::into).collect())
    }

    /// All names `region/name`, in the order of authored cases.
    pub fn all(&self) -> &[String] {
        &self.0
    }

    /// The authored name of a stored case; its number where the library has no such case.
    pub fn of(&self, case: CaseId) -> String {
        self.0.get(usize::from(case.0 / 4)).cloned().unwrap_or_else(|| format!("case {case}"))
    }
}

pub(crate) fn symmetry(case: CaseId) -> &'static str {
    Symmetry::from_bits(case.0).label()
}

/// The letter of the attacker in place `index` of the team.
pub fn letter(index: usize) -> char {
    char::from(b'A' + (index % 26) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attackers_have_letters_and_opponents_their_roles() {
        let attackers = [3, 7].map(|n| RobotId::new(n).unwrap());
        let cast = Cast {
            attackers: attackers.to_vec(),
            opponents: vec![OpponentRole::Midfield, OpponentRole::Defender],
        };
        assert_eq!([0, 1, 2, 3].map(|i| cast.name(i)), ["A", "B", "the midfield defender", "the defender"]);
        assert_eq!(cast.name_of(attackers[1]), "B");
    }

    #[test]
    fn a_stored_case_has_the_name_of_the_authored_one_and_its_own_symmetry() {
        let names = CaseNames::new(["back/kick", "center/pass"]);
        assert_eq!(names.of(CaseId(3)), "back/kick");
        assert_eq!(names.of(CaseId(5)), "center/pass");
        assert_eq!(names.of(CaseId(8)), "case 8");
        assert_eq!((symmetry(CaseId(3)), symmetry(CaseId(5))), ("both", "across-x"));
        assert_eq!([0, 1, 3].map(letter), ['A', 'B', 'D']);
    }
}
