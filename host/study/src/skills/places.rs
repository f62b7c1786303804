//! `places`: random places on a league's field: in play, along boards, in corners, at the goals. Field frame,
//! m.

use geometry::{Angle, Field, GoalEnd, Point, Pose, Segment};
use hil_sim::Stream;
use rules::limits::BALL_RADIUS;
use rules::{FieldSpec, League};

pub(super) struct Places {
    pub(super) field: FieldSpec,
    pub(super) chance: Stream,
}

impl Places {
    pub(super) fn new(league: League, seed: u64) -> Self {
        Self { field: league.field(), chance: Stream::new(seed, "skill") }
    }

    /// Even over the field, this far inside its lines.
    pub(super) fn inside(&mut self, margin: f32) -> Point<Field> {
        let (x, y) = (0.5 * self.field.length - margin, 0.5 * self.field.width - margin);
        Point::new(self.chance.between(-x, x), self.chance.between(-y, y))
    }

    /// The same, and outside both defence areas by `off`.
    pub(super) fn in_play(&mut self, margin: f32, off: f32) -> Point<Field> {
        for _ in 0..DRAWS_MAX {
            let at = self.inside(margin);
            let clear = |goal| self.field.distance_to_area(goal, at) > off;
            if clear(GoalEnd::Negative) && clear(GoalEnd::Positive) {
                return at;
            }
        }
        Point::default()
    }

    pub(super) fn direction(&mut self) -> Angle {
        Angle::new(self.chance.between(-core::f32::consts::PI, core::f32::consts::PI))
    }

    fn sign(&mut self) -> f32 {
        if self.chance.chance(0.5) { 1.0 } else { -1.0 }
    }

    fn off_board(&mut self) -> f32 {
        BALL_RADIUS + self.chance.between(0.0, OFF_BOARD_MAX_M)
    }

    /// Along a side's board.
    pub(super) fn at_side(&mut self) -> Point<Field> {
        let (length, wide) = (0.5 * self.field.length, 0.5 * self.field.width + self.field.margin);
        let x = self.chance.between(-length, length);
        Point::new(x, self.sign() * (wide - self.off_board()))
    }

    /// Along an end's board, beside the goal.
    pub(super) fn at_end(&mut self) -> Point<Field> {
        let (far, wide) = (0.5 * self.field.length + self.field.goal_line_margin, 0.5 * self.field.width);
        let beside = 0.5 * self.field.goal_width + BESIDE_GOAL_MAX_M;
        let y = self.sign() * self.chance.between(beside, wide);
        Point::new(self.sign() * (far - self.off_board()), y)
    }

    pub(super) fn in_corner(&mut self) -> Point<Field> {
        let far = 0.5 * self.field.length + self.field.goal_line_margin;
        let wide = 0.5 * self.field.width + self.field.margin;
        let (x, y) = (far - self.off_board(), wide - self.off_board());
        Point::new(self.sign() * x, self.sign() * y)
    }

    /// Behind the goal line: in the goal, beside it, or behind it where a body fits.
    pub(super) fn behind_goal(&mut self) -> Point<Field> {
        let f = self.field;
        let (line, half) = (0.5 * f.length, 0.5 * f.goal_width);
        let room = f.goal_line_margin - f.goal_depth - f.goal_wall;
        let (x, y) = match self.chance.whole(0, 2) {
            0 => {
                let deep = self.chance.between(0.03, f.goal_depth - BALL_RADIUS);
                (line + deep, self.chance.between(0.0, half - 0.05))
            }
            1 if room > BEHIND_GOAL_MIN_M => {
                let behind = self.chance.between(BALL_RADIUS, room - BALL_RADIUS);
                (line + f.goal_depth + f.goal_wall + behind, self.chance.between(0.0, half))
            }
            _ => {
                let outer = half + f.goal_wall + BALL_RADIUS;
                let deep = self.chance.between(0.03, f.goal_line_margin - BALL_RADIUS);
                (line + deep, outer + self.chance.between(0.01, BESIDE_GOAL_MAX_M))
            }
        };
        Point::new(self.sign() * x, self.sign() * y)
    }

    /// Robots that stand: this far from a stretch, and from each other and those before.
    pub(super) fn robots(
        &mut self,
        count: usize,
        keep_off: Segment<Field>,
        off: f32,
        before: &[Pose<Field>],
    ) -> Vec<Pose<Field>> {
        let mut placed: Vec<Pose<Field>> = Vec::new();
        for _ in 0..DRAWS_MAX {
            if placed.len() == count {
                break;
            }
            let (at, heading) = (self.in_play(0.2, 0.3), self.direction());
            let apart = |other: &Pose<Field>| other.position.distance(at) > ROBOTS_APART_M;
            if keep_off.distance_to(at) > off && before.iter().chain(&placed).all(apart) {
                placed.push(Pose { position: at, heading });
            }
        }
        placed
    }
}

/// Draws at most: starts come to an end.
const DRAWS_MAX: usize = 10_000;
/// A ball at a board lies within this of it, m.
const OFF_BOARD_MAX_M: f32 = 0.04;
/// Beside a goal is within this of its wall, m.
const BESIDE_GOAL_MAX_M: f32 = 0.3;
/// Behind a goal with less room than this no robot gets at a ball, m: a body and a little.
const BEHIND_GOAL_MIN_M: f32 = 0.24;
/// Robots start this far from each other, m.
const ROBOTS_APART_M: f32 = 0.4;
