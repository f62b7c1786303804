//! `sample`: seeded draws of problems: situations as they occur in play. mm, field frame.
//!
//! The ball lies anywhere on the field. Robots stand as in the paper's scenarios (Ros et al. 2009,
//! §5.1.2–§5.1.3): the first teammate behind the ball, the others around it; each opponent in its home
//! region, half of them where the paper's opponents wait (the point of the region nearest to the ball; with
//! the ball in the region, in front of it as in scenarios 3 and 4), half anywhere in it. No two robots
//! overlap. Half of the problems attack in the other direction.
//!
//! The n-th problem of a seed is always the same, independent of which others are drawn.

use casebase::{FieldMm, GoalEnd, PointMm, Problem, Symmetry};
use protocol::RobotId;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use crate::lineup::{Lineup, Rectangle};

/// Seeded source of problems; the n-th draw depends on seed and n only.
#[derive(Clone, Debug)]
pub struct Sampler {
    lineup: Lineup,
    field: FieldMm,
    seed: u64,
}

impl Sampler {
    /// The problems of `seed` for a league's field.
    pub fn new(lineup: Lineup, field: FieldMm, seed: u64) -> Self {
        Self { lineup, field, seed }
    }

    /// The problem of that number; ids of teammates count from 1.
    pub fn problem(&self, number: u64) -> Problem {
        let mut chance = RandomStream::new(self.seed, number);
        let ball = chance.within(self.whole_field());
        self.around(ball, &mut chance)
    }

    /// The same with the ball at `ball`, as seen by a team that defends `defending`.
    pub fn problem_at(&self, ball: PointMm, defending: GoalEnd, number: u64) -> Problem {
        let mut chance = RandomStream::new(self.seed, number);
        let symmetry = symmetry_for(defending, false);
        mirrored(&self.attack(symmetry.point(ball), &mut chance), symmetry)
    }

    fn whole_field(&self) -> Rectangle {
        let (x, y) = (self.field.length / 2, self.field.width / 2);
        Rectangle { x: [-x, x], y: [-y, y] }
    }

    /// Mirrored at random in both axes, so that the draw prefers no side.
    fn around(&self, ball: PointMm, chance: &mut RandomStream) -> Problem {
        let defending = [GoalEnd::Negative, GoalEnd::Positive][usize::from(chance.coin())];
        let symmetry = symmetry_for(defending, chance.coin());
        mirrored(&self.attack(ball, chance), symmetry)
    }

    /// A problem attacking towards +x.
    fn attack(&self, ball: PointMm, chance: &mut RandomStream) -> Problem {
        let mut problem = Problem {
            ball,
            defending: GoalEnd::Negative,
            teammates: heapless::Vec::new(),
            opponents: heapless::Vec::new(),
        };
        let mut taken = Vec::new();
        for (id, area) in (1..).zip(&self.lineup.teammates) {
            let at =
                place(&taken, ball, NEAR_BALL_TEAMMATE, || self.field.clamp(ball.plus(chance.within(*area))));
            taken.push(at);
            // A line-up has no more robots than a problem.
            let _ = RobotId::new(id).map(|id| problem.teammates.push((id, at)));
        }
        let lineups = &self.lineup.opponents;
        let homes = lineups.get(chance.below(lineups.len() as u32) as usize).map_or(&[][..], Vec::as_slice);
        for home in homes {
            // Where there is no room to wait, it stands elsewhere in its home.
            let mut patience = if chance.coin() { DRAWS_MAX / 2 } else { 0 };
            let at = place(&taken, ball, NEAR_BALL_OPPONENT, || {
                let waits = patience > 0;
                patience = patience.saturating_sub(1);
                if !waits {
                    chance.within(*home)
                } else if home.contains(ball) {
                    home.nearest(ball.plus(self.in_front(ball, chance)))
                } else {
                    let nearest = home.nearest(ball);
                    let stray = Rectangle { x: [-STRAY_MM, STRAY_MM], y: [-STRAY_MM, STRAY_MM] };
                    home.nearest(nearest.plus(chance.within(stray)))
                }
            });
            taken.push(at);
            let _ = problem.opponents.push(at);
        }
        problem
    }

    /// Displacement from the ball to an opponent that stands between it and the goal it guards, with random
    /// deviation.
    fn in_front(&self, ball: PointMm, chance: &mut RandomStream) -> PointMm {
        let goal = PointMm::new(self.field.length / 2, 0).minus(ball).to_f32();
        let distance = chance.between(IN_FRONT_MM[0], IN_FRONT_MM[1]) as f32;
        let length = geometry::math::hypot(goal[0], goal[1]).max(1.0);
        let ahead = goal.map(|part| geometry::math::round_to_i32(part * distance / length));
        let stray = Rectangle { x: [-STRAY_MM, STRAY_MM], y: [-STRAY_MM, STRAY_MM] };
        PointMm::new(ahead[0], ahead[1]).plus(chance.within(stray))
    }
}

/// The first draw that is clear of the ball and of all other robots; after [`DRAWS_MAX`] draws the last one.
fn place(taken: &[PointMm], ball: PointMm, from_ball: i64, mut draw: impl FnMut() -> PointMm) -> PointMm {
    let mut at = draw();
    for _ in 0..DRAWS_MAX {
        if are_apart(at, ball, from_ball)
            && taken.iter().all(|other| are_apart(at, *other, ROBOT_DISTANCE_MIN_MM))
        {
            break;
        }
        at = draw();
    }
    at
}

/// Returns whether two points are at least `distance` apart, mm.
fn are_apart(a: PointMm, b: PointMm, distance: i64) -> bool {
    let (dx, dy) = (i64::from(a.x - b.x), i64::from(a.y - b.y));
    dx * dx + dy * dy >= distance * distance
}

/// The copy of an attack towards +x for a team that defends `defending`, with the sides swapped or not.
const fn symmetry_for(defending: GoalEnd, swapped: bool) -> Symmetry {
    match (defending, swapped) {
        (GoalEnd::Negative, false) => Symmetry::Identity,
        (GoalEnd::Negative, true) => Symmetry::AcrossX,
        (GoalEnd::Positive, false) => Symmetry::AcrossY,
        (GoalEnd::Positive, true) => Symmetry::Both,
    }
}

fn mirrored(problem: &Problem, symmetry: Symmetry) -> Problem {
    Problem {
        ball: symmetry.point(problem.ball),
        defending: symmetry.goal(problem.defending),
        teammates: problem.teammates.iter().map(|(id, at)| (*id, symmetry.point(*at))).collect(),
        opponents: problem.opponents.iter().map(|at| symmetry.point(*at)).collect(),
    }
}

struct RandomStream(Xoshiro128PlusPlus);

impl RandomStream {
    /// The generator mixes its seed itself; the number is mixed first (by multiples of the golden ratio), so
    /// that neighbouring problems of neighbouring seeds do not coincide.
    fn new(seed: u64, number: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(
            seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(32),
        ))
    }

    /// Uniform in `0..count`; 0 where that is empty.
    fn below(&mut self, count: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(count)) >> 32) as u32
    }

    fn coin(&mut self) -> bool {
        self.below(2) == 1
    }

    /// Random integer, uniform in `low..=high`.
    fn between(&mut self, low: i32, high: i32) -> i32 {
        low + self.below(high.abs_diff(low) + 1) as i32
    }

    fn within(&mut self, area: Rectangle) -> PointMm {
        let x = self.between(area.x[0], area.x[1]);
        PointMm::new(x, self.between(area.y[0], area.y[1]))
    }
}

/// Minimum distance between the centres of two robots, mm: two bodies of the four-legged league (radius 120)
/// and a margin.
const ROBOT_DISTANCE_MIN_MM: i64 = 250;
/// Minimum distance between a teammate's centre and the ball, mm: it does not have the ball yet.
const NEAR_BALL_TEAMMATE: i64 = 170;
/// Minimum distance between an opponent's centre and the ball, mm: a nearer one has the ball, and there is no
/// case to play. The closest of the paper's scenarios (4) has 300.
const NEAR_BALL_OPPONENT: i64 = 300;
/// Distance in front of the ball, mm, of an opponent whose home contains the ball: scenarios 4 (300) to 3
/// (550).
const IN_FRONT_MM: [i32; 2] = [300, 550];
/// Deviation of an opponent from its waiting position, mm in each direction: what it walks in a third of a
/// second.
const STRAY_MM: i32 = 100;
/// Maximum number of draws for a position without overlap.
const DRAWS_MAX: u32 = 30;

#[cfg(test)]
mod tests {
    use super::*;

    const FIELD: FieldMm = FieldMm {
        length: 5400,
        width: 3600,
        margin: 300,
        goal_width: 800,
        penalty_depth: 650,
        penalty_width: 1300,
    };

    fn sampler(seed: u64) -> Sampler {
        Sampler::new(Lineup::guess(FIELD, 3), FIELD, seed)
    }

    #[test]
    fn a_problem_depends_on_its_seed_and_number_alone() {
        let all: Vec<_> = (0..50).map(|number| sampler(7).problem(number)).collect();
        assert_eq!(sampler(7).problem(31), all[31]);
        assert_ne!(sampler(8).problem(31), all[31]);
        assert!(all.iter().all(|one| all.iter().filter(|other| *other == one).count() == 1));
    }

    #[test]
    fn the_ball_lies_evenly_over_the_field_and_both_goals_are_defended() {
        let (mut quarters, mut negative) = ([0_u32; 4], 0_u32);
        for number in 0..4000 {
            let problem = sampler(1).problem(number);
            assert!(FIELD.contains(problem.ball));
            quarters[usize::from(problem.ball.x > 0) * 2 + usize::from(problem.ball.y > 0)] += 1;
            negative += u32::from(problem.defending == GoalEnd::Negative);
        }
        // Binomial: 1000 ± 27 and 2000 ± 32; four standard deviations.
        assert!(quarters.iter().all(|count| count.abs_diff(1000) < 110), "{quarters:?}");
        assert!(negative.abs_diff(2000) < 128, "{negative}");
    }

    #[test]
    fn robots_are_drawn_in_the_areas_of_the_line_up_and_clear_of_each_other() {
        let lineup = Lineup::guess(FIELD, 2);
        let mut crowded = 0;
        for number in 0..2000 {
            let drawn = Sampler::new(lineup.clone(), FIELD, 3).problem(number);
            // Seen in attack towards +x; homes and areas are symmetric about y = 0.
            let problem = mirrored(&drawn, symmetry_for(drawn.defending, false));
            assert_eq!(problem.defending, GoalEnd::Negative);
            for ((_, at), area) in problem.teammates.iter().zip(&lineup.teammates) {
                assert!(FIELD.contains(*at));
                let from_ball = at.minus(problem.ball);
                let on_line = at.x.abs() == FIELD.length / 2 || at.y.abs() == FIELD.width / 2;
                assert!(area.contains(from_ball) || on_line, "{number}: {from_ball:?}");
            }
            let fits = |homes: &Vec<Rectangle>| {
                homes.len() == problem.opponents.len()
                    && homes.iter().zip(&problem.opponents).all(|(home, at)| home.contains(*at))
            };
            assert!(lineup.opponents.iter().any(fits), "{number}: {problem:?}");
            let near =
                |a: PointMm, b: PointMm, mm: f64| f64::from(a.x - b.x).hypot(f64::from(a.y - b.y)) < mm;
            crowded += usize::from(problem.opponents.iter().any(|at| near(*at, problem.ball, 300.0)));
        }
        assert!(crowded == 0, "{crowded} of 2000 have an opponent at the ball");
    }

    #[test]
    fn with_the_ball_given_only_the_robots_are_drawn() {
        let ball = PointMm::new(-900, 1200);
        for number in 0..100 {
            for defending in [GoalEnd::Negative, GoalEnd::Positive] {
                let problem = sampler(5).problem_at(ball, defending, number);
                assert_eq!((problem.ball, problem.defending), (ball, defending));
                let first = problem.teammates[0].1.minus(ball).x
                    * if defending == GoalEnd::Negative { 1 } else { -1 };
                assert!(first < 0, "the first teammate stands behind the ball");
            }
        }
    }
}
