//! `problems`: random problems near a library's cases, a good share of them with several candidates.
//!
//! Field frame, mm.

use super::Dice;
use crate::oracle::library::{Goal, Library, Point};
use crate::oracle::problem::Problem;

/// A random problem near one of the library's stored cases; sometimes anywhere, or at extreme coordinates.
pub fn random_problem(dice: &mut Dice, library: &Library) -> Problem {
    let case = dice.pick(&library.cases).clone();
    let defending = if dice.chance(0.95) { case.defending } else { *dice.pick(&[Goal::Yellow, Goal::Cyan]) };
    let lost = dice.chance(0.03);
    let near = |dice: &mut Dice, at: Point, sigma: f64| {
        if lost {
            return Point { x: far(dice), y: far(dice) };
        }
        Point { x: at.x + dice.scatter(sigma), y: at.y + dice.scatter(sigma) }
    };
    let anywhere = |dice: &mut Dice| Point {
        x: dice.between(-library.length, library.length) * 11 / 20,
        y: dice.between(-library.width, library.width) * 11 / 20,
    };

    let ball = if dice.chance(0.01) {
        Point { x: far(dice), y: far(dice) }
    } else {
        Point {
            x: case.ball.x + dice.scatter(0.4 * case.scope.x as f64),
            y: case.ball.y + dice.scatter(0.4 * case.scope.y as f64),
        }
    };
    let shift = Point { x: ball.x - case.ball.x, y: ball.y - case.ball.y };
    let shifted = |p: Point| Point { x: p.x + shift.x, y: p.y + shift.y };

    let mut teammates = Vec::new();
    for robot in &case.robots {
        if dice.chance(0.95) {
            teammates.push(near(dice, shifted(robot.at), 350.0));
        }
    }
    let extra = dice.between(0, 11 - teammates.len() as i64) * i64::from(dice.chance(0.6));
    for _ in 0..extra {
        teammates.push(if dice.chance(0.5) { near(dice, ball, 900.0) } else { anywhere(dice) });
    }
    // Two robots at one position give exact ties, which the ids decide.
    if dice.chance(0.1) && teammates.len() < 11 {
        teammates.extend(teammates.first().copied());
    }
    let mut opponents = Vec::new();
    for (centre, _) in &case.opponents {
        if dice.chance(0.6) {
            opponents.push(near(dice, shifted(*centre), 250.0));
        }
    }
    let extra = dice.between(0, 11 - opponents.len() as i64) * i64::from(dice.chance(0.4));
    for _ in 0..extra {
        opponents.push(anywhere(dice));
    }
    Problem { ball, defending, teammates: with_any_ids(dice, teammates), opponents }
}

/// Coordinates at the limits of a 32-bit integer.
fn far(dice: &mut Dice) -> i64 {
    *dice.pick(&[i64::from(i32::MIN), i64::from(i32::MAX), -1_000_000, 40_000, 0])
}

/// Ids are drawn from 0–15, in no order.
fn with_any_ids(dice: &mut Dice, robots: Vec<Point>) -> Vec<(u8, Point)> {
    let mut ids: Vec<u8> = (0..16).collect();
    for i in (1..ids.len()).rev() {
        let other = dice.between(0, i as i64) as usize;
        ids.swap(i, other);
    }
    ids.into_iter().zip(robots).collect()
}

#[cfg(test)]
mod tests {
    use super::super::RandomLibrary;
    use super::*;
    use crate::oracle::{Rules, retrieve};

    #[test]
    fn a_good_share_of_the_problems_has_several_candidates() {
        let random = RandomLibrary::new(1, 60);
        let library = Library::from_texts(&random.league, &random.cases).expect("readable");
        let mut dice = Dice::new(2);
        let (mut some, mut several) = (0, 0);
        for _ in 0..1000 {
            let answer = retrieve(&library, &random_problem(&mut dice, &library), &Rules::default());
            some += usize::from(answer.candidates > 0);
            several += usize::from(answer.candidates > 1);
        }
        assert!(some > 400 && several > 150, "{some} of 1000 with a candidate, {several} with several");
    }
}
