//! `aim`: situations like those of play, as many as a comparison of changes needs.
//!
//! An edit of one case changes few trials of all starts, and most of them late. So proposals are compared
//! where they matter: in situations that are drawn from the decisions of recorded play, each moved a little
//! (a smoothed bootstrap), and kept where the change would be played or retrieval would answer otherwise.
//! Drawing and looking up cost no trial. Robots and ball stand at first, so this chooses and does not
//! decide: tests play whole trials. mm.

use hil_sim::{Fnv, Stream};
use rayon::prelude::*;

use crate::learning::edit::Edit;
use crate::learning::occasion::Occasion;
use crate::learning::variant::{Answer, Variant};

/// Purpose of drawn situations; no two purposes draw the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    Search,
    Screening,
}

/// Situations of a round, with what retrieval answers in each.
#[derive(Debug)]
pub(crate) struct Ground {
    pub(crate) purpose: Purpose,
    pub(crate) occasions: Vec<Occasion>,
    answers: Vec<Answer>,
}

impl Ground {
    /// `count` situations like `played`, for a round of a run with `seed`; fewer where drawn ones do not fit
    /// the field.
    pub(crate) fn draw(
        played: &[Occasion],
        purpose: Purpose,
        count: u32,
        seed: u64,
        round: u32,
        current: &Variant,
    ) -> Self {
        let usable: Vec<&Occasion> =
            played.iter().filter(|occasion| occasion.situation.is_usable()).collect();
        let one = |number: u32| {
            let mut hash = Fnv::default();
            hash.add(&[purpose as u8]);
            hash.add(&seed.to_le_bytes());
            hash.add(&round.to_le_bytes());
            hash.add(&number.to_le_bytes());
            moved(&usable, &mut Stream::new(hash.value(), "aim"))
        };
        let occasions: Vec<Occasion> = (0..count).into_par_iter().filter_map(one).collect();
        let mut ground = Self { purpose, occasions, answers: Vec::new() };
        ground.answer(current);
        ground
    }

    /// Looks all situations up.
    fn answer(&mut self, current: &Variant) {
        let base = current.base();
        let answer = |occasion: &Occasion| current.answer(&base, &occasion.situation.problem());
        self.answers = self.occasions.par_iter().map(answer).collect();
    }

    /// The situations, by number, in which an edit changes what is played.
    pub(crate) fn touched(&self, edit: &Edit, edited: &Variant) -> Vec<usize> {
        let base = edited.base();
        let touched = |i: &usize| {
            let before = &self.answers[*i];
            edit.changes_problems()
                || before.as_ref().is_some_and(|(name, _, _)| *name == edit.case)
                || edited.answer(&base, &self.occasions[*i].situation.problem()) != *before
        };
        (0..self.occasions.len()).into_par_iter().filter(touched).collect()
    }
}

/// One of these situations with everything moved a little; a robot close to the ball moves with it.
fn moved(played: &[&Occasion], chance: &mut Stream) -> Option<Occasion> {
    let last = u32::try_from(played.len().checked_sub(1)?).ok()?;
    let mut occasion = played[chance.whole(0, last) as usize].clone();
    let mut shift = || [chance.normal_within(2.0), chance.normal_within(2.0)].map(|n| (n * SPREAD) as i32);
    let plus = |[x, y]: [i32; 2], [dx, dy]: [i32; 2]| [x + dx, y + dy];
    let situation = &mut occasion.situation;
    let (before, with_ball) = (situation.ball, shift());
    situation.ball = plus(before, with_ball);
    for (_, at) in &mut situation.teammates {
        *at = plus(*at, if distance(*at, before) < HOLDS_WITHIN_MM { with_ball } else { shift() });
    }
    for at in &mut situation.opponents {
        *at = plus(*at, if distance(*at, before) < HOLDS_WITHIN_MM { with_ball } else { shift() });
    }
    let robots: Vec<[i32; 2]> =
        situation.teammates.iter().map(|(_, at)| *at).chain(situation.opponents.iter().copied()).collect();
    let inside = robots.iter().all(|[x, y]| x.abs() <= ROBOT_INSIDE[0] && y.abs() <= ROBOT_INSIDE[1]);
    let apart = (0..robots.len()).all(|i| (0..i).all(|j| distance(robots[i], robots[j]) >= ROBOTS_APART_MM));
    (situation.is_usable() && inside && apart).then_some(occasion)
}

/// Between two points in mm.
pub(crate) fn distance([a, b]: [i32; 2], [x, y]: [i32; 2]) -> f64 {
    f64::from(a - x).hypot(f64::from(b - y))
}

/// Standard deviation of a move, mm: a robot's length, well below the radii of scopes.
const SPREAD: f32 = 150.0;
/// A robot whose centre is closer to the ball has it, mm.
const HOLDS_WITHIN_MM: f64 = 250.0;
/// Least distance of two robots' centres, mm: the width of a robot.
const ROBOTS_APART_MM: f64 = 300.0;
/// Limits of a robot's centre along x and y, mm: on the lines.
const ROBOT_INSIDE: [i32; 2] = [2700, 1800];

#[cfg(test)]
mod tests {
    use arena::Profile;

    use super::*;
    use crate::learning::edit::Change;
    use crate::learning::trial::Situation;

    fn played() -> Occasion {
        let situation = Situation {
            ball: [500, 200],
            defending_positive: false,
            teammates: vec![(1, [350, 200]), (2, [200, -900])],
            opponents: vec![[1500, 300], [2400, 0]],
        };
        Occasion { situation, profile: Profile::Simulated, two_defenders: false, without_case: false }
    }

    fn variant() -> Variant {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        Variant::new(case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap())
            .unwrap()
    }

    #[test]
    fn drawn_situations_lie_around_those_of_play_and_the_robot_keeps_its_ball() {
        let ground = Ground::draw(&[played()], Purpose::Screening, 400, 7, 1, &variant());
        assert!(ground.occasions.len() > 350, "{}", ground.occasions.len());
        for Occasion { situation, .. } in &ground.occasions {
            assert!(distance(situation.ball, [500, 200]) <= 300.0 * std::f64::consts::SQRT_2);
            let [x, y] = situation.ball;
            assert_eq!(situation.teammates[0].1, [x - 150, y]);
        }
        let mean = ground.occasions.iter().map(|one| f64::from(one.situation.ball[0])).sum::<f64>();
        // 150 mm over the root of 400, four times.
        assert!((mean / ground.occasions.len() as f64 - 500.0).abs() < 30.0);
        let other = Ground::draw(&[played()], Purpose::Search, 400, 7, 1, &variant());
        assert!(other.occasions[..50].iter().zip(&ground.occasions).all(|(a, b)| a.situation != b.situation));
    }

    #[test]
    fn an_edit_touches_the_situations_of_its_case_and_those_answered_otherwise() {
        let current = variant();
        let ground = Ground::draw(&[played()], Purpose::Screening, 200, 7, 1, &current);
        let names = |i: usize| ground.answers[i].as_ref().map(|(name, _, _)| name.clone());
        let case = (0..ground.occasions.len()).find_map(names).unwrap();
        let edit = Edit { case: case.clone(), change: Change::Forget };
        let touched = ground.touched(&edit, &current.edited(&edit).unwrap());
        let plays = (0..ground.occasions.len()).filter(|i| names(*i).as_ref() == Some(&case));
        assert_eq!(touched, plays.collect::<Vec<_>>());
    }
}
