//! `angle`: open angle of our goal (Biswas et al. 2014 §5.1).
//!
//! Angles of view are measured from the direction of the view's middle, left positive, rad. A robot of radius
//! r at distance D covers 2·asin((r + r_ball) / D): the ball's centre must not come nearer than both radii.
//! Attack frame.

use geometry::{Angle, Attack, Point, Vector, math};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

/// Radii of a body and of the ball together, m: a ball whose centre comes nearer to a robot's centre is
/// blocked.
pub const BODY: f32 = ROBOT_RADIUS + BALL_RADIUS;
/// Bodies that can block at the same time: all of both teams on the largest field.
pub const BODIES_MAX: usize = 2 * rules::limits::ROBOTS_MAX;
/// Least distance of a view from the goal line, m: nearer, its posts are a straight line.
const BEFORE_LINE_MIN_M: f32 = 0.05;
/// Smaller angles count as 0, rad: they need a body 110 m away.
const ANGLE_MIN_RAD: f32 = 1e-3;

/// The goal as seen from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// Place from which the goal is seen, m.
    pub from: Point<Attack>,
    /// Direction of the goal's bisector.
    pub middle: Angle,
    /// Half the angle between the posts, rad.
    pub half: f32,
}

/// A range of directions, rad from the opening's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Right end of the gap, rad.
    pub right: f32,
    /// Left end of the gap, rad.
    pub left: f32,
}

impl Span {
    /// Width of the span, rad.
    pub fn width(&self) -> f32 {
        self.left - self.right
    }

    /// Direction of its bisector, rad from the opening's middle.
    pub fn middle(&self) -> f32 {
        0.5 * (self.left + self.right)
    }
}

impl Opening {
    /// The goal with its middle at `goal` and `width` m between the posts, seen from `from`; a place on or
    /// behind its line is moved to just before it.
    pub fn of(from: Point<Attack>, goal: Point<Attack>, width: f32) -> Self {
        let before = if goal.x() < 0.0 {
            from.x().max(goal.x() + BEFORE_LINE_MIN_M)
        } else {
            from.x().min(goal.x() - BEFORE_LINE_MIN_M)
        };
        let from = Point::new(before, from.y());
        let post = |y: f32| Point::new(goal.x(), goal.y() + y) - from;
        let (one, other) = (post(-0.5 * width), post(0.5 * width));
        // The angle from one post to the other is below half a turn in either direction.
        let half = 0.5 * math::atan2(one.cross(other), one.dot(other));
        Self { from, middle: one.angle() + Angle::new(half), half: half.abs() }
    }

    /// The whole angle, rad.
    pub fn angle(&self) -> f32 {
        2.0 * self.half
    }

    /// The unit vector of a direction `off` the middle.
    pub fn direction(&self, off: f32) -> Vector<Attack> {
        Vector::polar(1.0, self.middle + Angle::new(off))
    }

    /// The directions that a body covers; `None` where it stands no nearer than `within` m, or behind.
    pub fn shadow(&self, body: Point<Attack>, within: f32) -> Option<Span> {
        let to = body - self.from;
        let distance = to.norm();
        let off = (to.angle() - self.middle).radians();
        let half = half_shadow(distance);
        (distance < within && off.abs() - half < math::FRAC_PI_2)
            .then_some(Span { right: off - half, left: off + half })
    }

    /// The directions that these bodies cover, by their right ends. A body counts where it stands nearer than
    /// `within` m.
    pub fn shadows(&self, bodies: impl Iterator<Item = Point<Attack>>, within: f32) -> Shadows {
        let mut shadows: Shadows =
            bodies.filter_map(|body| self.shadow(body, within)).take(BODIES_MAX).collect();
        shadows.sort_unstable_by(|a, b| a.right.total_cmp(&b.right));
        shadows
    }

    /// The gaps that these bodies leave open, from right to left; `within` as of [`Self::shadows`].
    pub fn gaps(&self, bodies: impl Iterator<Item = Point<Attack>>, within: f32) -> Gaps {
        self.gaps_between(&self.shadows(bodies, within))
    }

    /// The gaps between shadows, which are sorted by their right ends.
    pub fn gaps_between(&self, shadows: &[Span]) -> Gaps {
        let (mut gaps, mut open) = (Gaps::new(), -self.half);
        for shadow in shadows {
            if shadow.right > open && open < self.half {
                // One gap more than bodies at most, which is the capacity.
                let _ = gaps.push(Span { right: open, left: shadow.right.min(self.half) });
            }
            open = open.max(shadow.left);
        }
        if open < self.half {
            let _ = gaps.push(Span { right: open, left: self.half });
        }
        gaps
    }
}

/// Covered directions, by their right ends.
pub type Shadows = heapless::Vec<Span, BODIES_MAX>;
/// Open gaps, from right to left.
pub type Gaps = heapless::Vec<Span, { BODIES_MAX + 1 }>;

/// The widest of them; 0 where there is none.
pub fn widest(gaps: &[Span]) -> f32 {
    gaps.iter().map(Span::width).fold(0.0, f32::max)
}

/// asin(([`BODY`]) / D): half of the angle that a body covers at a distance, rad; a quarter turn where it
/// touches.
pub fn half_shadow(distance: f32) -> f32 {
    if distance <= BODY {
        return math::FRAC_PI_2;
    }
    math::atan2(BODY, math::sqrt(distance * distance - BODY * BODY))
}

/// The distance at which a body covers this half angle, m: the inverse of [`half_shadow`].
pub fn distance_for(half: f32) -> f32 {
    BODY / math::sin_cos(half.clamp(ANGLE_MIN_RAD, math::FRAC_PI_2)).0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 2e-5
    }

    /// Python: `2*atan(0.5/4.5)`, `atan2(1.5,3)-atan2(.5,3)`, `asin(.1115/2)`, `.1115/sin(.05)`.
    #[test]
    fn angles_are_those_computed_by_hand() {
        let goal = Point::new(-4.5, 0.0);
        let ahead = Opening::of(Point::new(0.0, 0.0), goal, 1.0);
        assert!(near(ahead.angle(), 0.221_314_44), "{}", ahead.angle());
        assert!(near(ahead.middle.abs(), math::PI));
        let aside = Opening::of(Point::new(-1.5, 1.0), goal, 1.0);
        assert!(near(aside.angle(), 0.298_498_93), "{}", aside.angle());
        assert!(near(half_shadow(2.0), 0.055_778_89), "{}", half_shadow(2.0));
        assert!(near(distance_for(0.05), 2.230_929_6), "{}", distance_for(0.05));
    }

    #[test]
    fn what_bodies_leave_open_is_what_rays_find_free() {
        let goal = Point::new(-4.5, 0.0);
        for (i, from) in [(0.0, 0.0), (-2.0, 2.0), (-3.9, -1.6), (-4.3, 0.4)].into_iter().enumerate() {
            let opening = Opening::of(Point::new(from.0, from.1), goal, 1.0);
            let bodies = [(-3.37, 0.1), (-4.2, -0.2), (-3.4, -0.4), (-4.1, 0.6), (3.0, 0.0)]
                .map(|(x, y)| Point::<Attack>::new(x, y));
            let gaps = opening.gaps(bodies.into_iter(), f32::INFINITY);
            let (mut free, rays) = (0, 20_000);
            for ray in 0..rays {
                let y = -0.5 + (ray as f32 + 0.5) / rays as f32;
                let path = geometry::Segment::new(opening.from, Point::new(-4.5, y));
                // Bodies behind the line do not occur here, so the segment to the goal line decides.
                if bodies.iter().all(|body| path.distance_to(*body) > BODY) {
                    free += 1;
                    let off = (path.vector().angle() - opening.middle).radians();
                    assert!(
                        gaps.iter().any(|gap| gap.right - 1e-3 < off && off < gap.left + 1e-3),
                        "{i} {y}"
                    );
                }
            }
            // The same share of the goal opening: seen from the middle of each gap's ends.
            let on_line = |off: f32| {
                let d = opening.direction(off);
                opening.from.y() + d.y() * (-4.5 - opening.from.x()) / d.x()
            };
            let open: f32 = gaps.iter().map(|gap| (on_line(gap.right) - on_line(gap.left)).abs()).sum();
            assert!((open - free as f32 / rays as f32).abs() < 2e-3, "{i}: {open} {free}");
        }
    }

    #[test]
    fn a_body_behind_takes_nothing_and_two_bodies_in_line_take_what_one_takes() {
        let opening = Opening::of(Point::new(0.0, 0.0), Point::new(-4.5, 0.0), 1.0);
        let open = |bodies: &[(f32, f32)]| -> f32 {
            let bodies = bodies.iter().map(|(x, y)| Point::new(*x, *y));
            opening.gaps(bodies, f32::INFINITY).iter().map(Span::width).sum()
        };
        assert!(near(open(&[(1.0, 0.0)]), opening.angle()));
        assert!(near(open(&[(-2.0, 0.0), (-4.0, 0.0)]), open(&[(-2.0, 0.0)])));
        assert!(near(open(&[(-2.0, 0.0)]), opening.angle() - 2.0 * 0.055_778_89));
    }
}
