//! `open`: open goal angle. The widest angle between the posts that no body blocks (Biswas et al. 2014 c2',
//! Fig. 3; D10). Attack frame, m, rad.

use geometry::{Attack, Point, Vector, math};

use super::super::view::ROBOTS_MAX;

/// A goal opening on the line x = `x`, between ±`half`, and the size of bodies that can block a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GoalOpening {
    /// Position of the goal line, m.
    pub x: f32,
    /// Half its width less the ball's radius, m.
    pub half: f32,
    /// Radius that a body blocks, the ball's included, m.
    pub body: f32,
}

/// The widest gap of a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenAngle {
    /// rad; 0 where all is blocked, or the place is not in front of the goal.
    pub angle: f32,
    /// Middle of the gap on the goal line; of the goal where there is none.
    pub aim: Point<Attack>,
}

impl GoalOpening {
    /// The widest gap seen from `from`, with bodies at `blockers`.
    pub fn open_from(&self, from: Point<Attack>, blockers: impl Iterator<Item = Point<Attack>>) -> OpenAngle {
        let depth = self.x - from.x();
        let closed = OpenAngle { angle: 0.0, aim: Point::new(self.x, 0.0) };
        if depth <= 0.0 {
            return closed;
        }
        // Shadows on the goal line, lowest first.
        let mut shadows: heapless::Vec<(f32, f32), ROBOTS_MAX> = heapless::Vec::new();
        for blocker in blockers {
            if let Some((low, high)) = self.shadow(from, depth, blocker - from) {
                let at = shadows.iter().position(|(other, _)| *other > low).unwrap_or(shadows.len());
                // As many as robots fit; one more would only block more.
                let _ = shadows.insert(at, (low, high));
            }
        }
        let mut best = (0.0, closed.aim);
        let mut gap = |low: f32, high: f32| {
            if high <= low {
                return;
            }
            let (a, b) = (low - from.y(), high - from.y());
            // tan of the angle between the two sides; they are less than 90° apart unless the place lies in
            // the goal.
            let (across, along) = (depth * (b - a), depth * depth + a * b);
            let tangent = if along > 0.0 { across / along } else { f32::INFINITY };
            if tangent > best.0 {
                best = (tangent, Point::new(self.x, 0.5 * (low + high)));
            }
        };
        let mut free_from = -self.half;
        for (low, high) in &shadows {
            gap(free_from, *low);
            free_from = free_from.max(*high);
        }
        gap(free_from, self.half);
        let (tangent, aim) = best;
        let angle = if tangent.is_finite() { math::atan2(tangent, 1.0) } else { math::FRAC_PI_2 };
        OpenAngle { angle, aim }
    }

    /// The part of the goal line that a body at `off` from the place blocks, cut to the opening.
    #[inline]
    fn shadow(&self, from: Point<Attack>, depth: f32, off: Vector<Attack>) -> Option<(f32, f32)> {
        let (x, y) = (off.x(), off.y());
        // Behind the shooter, or behind the goal line.
        if x <= -self.body || x >= depth + self.body {
            return None;
        }
        let squared = off.dot(off) - self.body * self.body;
        if squared <= 0.0 {
            return Some((-self.half, self.half));
        }
        // Both tangents: `off` turned by ± the angle whose sine is body / |off|.
        let length = math::sqrt(squared);
        let left = (x * length - y * self.body, y * length + x * self.body);
        let right = (x * length + y * self.body, y * length - x * self.body);
        let high = if left.0 > 0.0 {
            from.y() + depth * left.1 / left.0
        } else if left.1 > 0.0 {
            self.half
        } else {
            return None;
        };
        let low = if right.0 > 0.0 {
            from.y() + depth * right.1 / right.0
        } else if right.1 < 0.0 {
            -self.half
        } else {
            return None;
        };
        let (low, high) = (low.max(-self.half), high.min(self.half));
        (low < high).then_some((low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::{RngCore, SeedableRng};
    use rand_xoshiro::Xoshiro128PlusPlus;

    const DRIBBLER_WIDTH: GoalOpening = GoalOpening { x: 4.5, half: 0.5, body: 0.1 };

    fn open(from: (f32, f32), blockers: &[(f32, f32)]) -> OpenAngle {
        let at = |(x, y): (f32, f32)| Point::new(x, y);
        DRIBBLER_WIDTH.open_from(at(from), blockers.iter().copied().map(at))
    }

    #[test]
    fn an_empty_goal_straight_ahead_by_hand() {
        // 2 atan(0.5 / 2) = 0.489957 rad.
        let open = open((2.5, 0.0), &[]);
        assert!((open.angle - 0.489_957).abs() < 1e-5 && open.aim == Point::new(4.5, 0.0));
    }

    #[test]
    fn a_body_in_the_middle_leaves_two_gaps_by_hand() {
        // A keeper 1 m ahead blocks ± asin(0.1) = 0.100167 rad of ± 0.244979: 0.144811 rad to either side,
        // the lower first.
        let open = open((2.5, 0.0), &[(3.5, 0.0)]);
        assert!((open.angle - 0.144_811).abs() < 1e-5, "{open:?}");
        // From −0.5 to −2 tan(0.100167) = −0.201008.
        assert!((open.aim.y() + 0.350_504).abs() < 1e-5);
        let beside = super::tests::open((2.5, 0.0), &[(3.5, 0.05)]);
        assert!(beside.aim.y() < 0.0 && beside.angle > open.angle);
    }

    #[test]
    fn the_corner_sees_little_and_behind_the_line_nothing() {
        // From (4.4, 2.5): atan2(−2, 0.1) − atan2(−3, 0.1) = 0.0166359 rad.
        assert!((open((4.4, 2.5), &[]).angle - 0.016_636).abs() < 1e-5);
        assert_eq!(open((4.6, 0.0), &[]).angle, 0.0);
        assert_eq!(open((2.0, 0.0), &[(2.05, 0.0)]).angle, 0.0, "a body on the ball closes all");
        assert_eq!(open((2.0, 0.0), &[(1.8, 0.0), (4.7, 0.0)]), open((2.0, 0.0), &[]), "behind either end");
    }

    #[test]
    fn it_is_what_a_thousand_rays_see() {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(5);
        let mut between =
            |low: f32, high: f32| low + (high - low) * (rng.next_u32() >> 8) as f32 / 16_777_216.0;
        for _ in 0..400 {
            let from = (between(0.0, 3.9), between(-2.5, 2.5));
            let blockers: Vec<_> = (0..5).map(|_| (between(0.0, 4.5), between(-1.5, 1.5))).collect();
            let found = open(from, &blockers).angle;
            // Rays by even steps of the angle, each free or not by its distance from the bodies.
            let (low, high) = ((-0.5 - from.1).atan2(4.5 - from.0), (0.5 - from.1).atan2(4.5 - from.0));
            let step = (high - low) / 2_000.0;
            let (mut widest, mut run) = (0.0_f32, 0.0_f32);
            for i in 0..2_000 {
                let angle = low + step * (i as f32 + 0.5);
                let (s, c) = angle.sin_cos();
                let free = blockers.iter().all(|(x, y)| {
                    let (dx, dy) = (x - from.0, y - from.1);
                    let along = dx * c + dy * s;
                    let at = along.clamp(0.0, (4.5 - from.0) / c);
                    (dx - at * c).hypot(dy - at * s) > 0.1
                });
                run = if free { run + step } else { 0.0 };
                widest = widest.max(run);
            }
            // Bodies whose shadow ends at a tangent point behind the goal line differ by a little.
            assert!((found - widest).abs() < 2.0 * step + 0.02, "{from:?} {blockers:?}: {found} {widest}");
        }
    }
}
