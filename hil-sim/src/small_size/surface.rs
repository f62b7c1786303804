//! `surface`: distance and normal of a robot's hull, a wall or a board. m.
//!
//! The hull is a disc with a flat front: the part beyond the chord at `front` is cut off. Distances are exact
//! outside (so that steps as long as the distance never jump into a body) and, inside, to the nearest side.

use serde::{Deserialize, Serialize};

use super::parameters::BodyParameters;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearest {
    /// Distance, m, negative inside.
    pub distance: f32,
    /// Outward normal, of length 1.
    pub normal: [f32; 2],
    /// True on the flat front.
    pub front: bool,
}

/// The nearest point of a robot's hull to a point in the robot's own frame.
pub(super) fn hull(body: &BodyParameters, half_front: f32, [x, y]: [f32; 2]) -> Nearest {
    let ahead = x - body.front;
    let squared = x * x + y * y;
    if ahead >= 0.0 && y.abs() <= half_front {
        return Nearest { distance: ahead, normal: [1.0, 0.0], front: true };
    }
    let radius = geometry::math::sqrt(squared);
    // The disc's nearest point lies beyond the chord where x/|p| · R > front: then the corner is nearest.
    if ahead > 0.0 && x * body.radius > body.front * radius {
        let (dx, dy) = (ahead, y - if y < 0.0 { -half_front } else { half_front });
        let distance = geometry::math::sqrt(dx * dx + dy * dy);
        return Nearest { distance, normal: [dx / distance, dy / distance], front: false };
    }
    let beyond = radius - body.radius;
    if beyond < ahead && y.abs() <= half_front {
        Nearest { distance: ahead, normal: [1.0, 0.0], front: true }
    } else if radius > 0.0 {
        Nearest { distance: beyond, normal: [x / radius, y / radius], front: false }
    } else {
        Nearest { distance: ahead, normal: [1.0, 0.0], front: true }
    }
}

/// A box with sides along the axes: from and to along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Slab {
    pub x: [f32; 2],
    pub y: [f32; 2],
}

impl Slab {
    /// The nearest point of the box to a point of the field.
    pub(super) fn nearest(&self, [x, y]: [f32; 2]) -> Nearest {
        let (dx, dy) = (x - x.clamp(self.x[0], self.x[1]), y - y.clamp(self.y[0], self.y[1]));
        let squared = dx * dx + dy * dy;
        if squared > 0.0 {
            let distance = geometry::math::sqrt(squared);
            return Nearest { distance, normal: [dx / distance, dy / distance], front: false };
        }
        let sides = [
            (self.x[0] - x, [-1.0, 0.0]),
            (x - self.x[1], [1.0, 0.0]),
            (self.y[0] - y, [0.0, -1.0]),
            (y - self.y[1], [0.0, 1.0]),
        ];
        let (distance, normal) =
            sides.into_iter().fold(sides[0], |best, side| if side.0 > best.0 { side } else { best });
        Nearest { distance, normal, front: false }
    }
}

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::rng::Stream;
    use crate::small_size::Parameters;

    /// Reference by brute force: the nearest of many points of the outline.
    fn outline(body: &BodyParameters, half_front: f32) -> Vec<[f32; 2]> {
        let chord = (0..=1000).map(|i| [body.front, half_front * (i as f32 / 500.0 - 1.0)]);
        let arc = (0..=6000).map(|i| geometry::math::sin_cos(i as f32 / 6000.0 * geometry::math::TAU));
        let arc = arc.map(|(s, c)| [body.radius * c, body.radius * s]).filter(|p| p[0] <= body.front);
        chord.chain(arc).collect()
    }

    #[test]
    fn distances_to_the_hull_agree_with_brute_force_inside_and_out() {
        let body = Parameters::of(League::DivisionB).unwrap().robot;
        let half = geometry::math::sqrt(body.radius * body.radius - body.front * body.front);
        let (points, mut chance) = (outline(&body, half), Stream::new(1, "test"));
        for _ in 0..400 {
            let p = [chance.between(-0.2, 0.2), chance.between(-0.2, 0.2)];
            let near = hull(&body, half, p);
            let square = |q: &[f32; 2]| (q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1]);
            let by_force = geometry::math::sqrt(points.iter().map(square).fold(f32::MAX, f32::min));
            let inside = geometry::math::hypot(p[0], p[1]) < body.radius && p[0] < body.front;
            assert_eq!(near.distance < 0.0, inside, "{p:?}");
            assert!((near.distance.abs() - by_force).abs() < 2e-4, "{p:?}: {near:?}, by force {by_force}");
            assert!((geometry::math::hypot(near.normal[0], near.normal[1]) - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn the_nearest_side_of_a_box_gives_the_normal() {
        let slab = Slab { x: [1.0, 3.0], y: [0.0, 1.0] };
        assert_eq!(slab.nearest([1.1, 0.5]).normal, [-1.0, 0.0]);
        assert_eq!(slab.nearest([2.0, 0.9]).normal, [0.0, 1.0]);
        assert!((slab.nearest([2.0, 0.9]).distance + 0.1).abs() < 1e-6);
        assert_eq!(slab.nearest([4.0, 5.0]).distance, geometry::math::sqrt(17.0));
    }
}
