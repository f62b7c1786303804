//! `goalkeeper`: demands on a goalkeeper before the attacked goal. The league's opponents have one or none,
//! and what is good against one is often bad against the other. mm, attack towards +x.

use case_tools::workbench::{CaseText, Part};
use casebase::{GoalEnd, Presence};

use crate::learning::edit::Change;

/// The demand on a goalkeeper, as one more opponent of a case.
pub(crate) fn demanded(case: &CaseText, presence: Presence) -> Change {
    let attacks_negative = case.defending() == Some(GoalEnd::Positive);
    let x = if attacks_negative { -PLACE[0] } else { PLACE[0] };
    Change::AddOpponent([x, PLACE[1]], SCOPE, presence)
}

/// Whether a case demands something of a goalkeeper already.
pub(crate) fn is_demanded(case: &CaseText) -> bool {
    (1..=case.opponents()).any(|n| {
        case.scope_of(&Part::Opponent(n)) == Some(SCOPE)
            && case.presence_of(n).is_some_and(|presence| presence != Presence::Preferred)
    })
}

/// The goalkeeper among opponents, by its number: the one nearest to the goal, where it stands before it.
pub(crate) fn among(opponents: &[[i32; 2]]) -> Option<usize> {
    let before_goal = |[x, y]: &[i32; 2]| *x >= LEAST_X && y.abs() <= MOST_Y;
    let keepers = opponents.iter().enumerate().filter(|(_, at)| before_goal(at));
    keepers.max_by_key(|(_, [x, _])| *x).map(|(number, _)| number)
}

/// Usual place of a goalkeeper: in front of the middle of the goal, whose line is at 2700 mm.
pub(crate) const PLACE: [i32; 2] = [2400, 0];
/// Radii of the demand's scope: it moves with the ball, up to a ball scope's radius.
pub(crate) const SCOPE: [i32; 2] = [700, 650];
/// Opponents nearer to their goal line are in their penalty area, which is 650 mm deep: only goalkeepers are.
const LEAST_X: i32 = 2050;
/// Half the width of the penalty area.
const MOST_Y: i32 = 650;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::edit::Edit;

    #[test]
    fn a_goalkeeper_is_the_last_opponent_in_the_penalty_area() {
        assert_eq!(among(&[[1500, 0], [2300, 100]]), Some(1));
        assert_eq!(among(&[[2450, -300], [2100, 0]]), Some(0));
        assert_eq!(among(&[[2000, 0], [2600, 900]]), None);
    }

    #[test]
    fn a_demand_lies_before_the_goal_that_is_attacked_and_is_found_again() {
        for (defending, x) in [("yellow", 2400), ("cyan", -2400)] {
            let text = format!("intent = \"\"\ndefending = \"{defending}\"\n");
            let case = CaseText::read(&text).unwrap();
            assert!(!is_demanded(&case));
            let change = demanded(&case, Presence::Excluded);
            assert_eq!(change, Change::AddOpponent([x, 0], SCOPE, Presence::Excluded));
            let files = case_tools::Files::from_texts("l", "", &[("a/b", &text)]);
            let after = Edit { case: "a/b".to_owned(), change }.apply(&files).unwrap();
            assert!(is_demanded(&CaseText::read(&after.cases[0].text).unwrap()));
        }
    }
}
