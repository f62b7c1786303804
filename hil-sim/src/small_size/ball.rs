//! `ball`: motion of a free ball. It slides, rolls, flies and hops; m, s, field frame, heights above the
//! field surface.
//!
//! A solid sphere: while it slips, the surface slows it by `slide` and turns it until it rolls (a ball kicked
//! without spin then has 5/7 of its speed); rolling, it loses `roll` a second. A hop keeps fixed shares of
//! its speeds. Each step is exact for motion along a line. Written independently of `motion`'s model on
//! purpose: an error of that model must become visible as a missed pass.

use geometry::{Field, Point, Vector, math};
use serde::{Deserialize, Serialize};

use super::parameters::BallParameters;

/// The ball's true state.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Ball {
    /// Position of its centre on the ground, m.
    pub position: Point<Field>,
    /// Its lowest point above the field surface, m.
    pub height: f32,
    /// Velocity along the field surface, m/s.
    pub velocity: Vector<Field>,
    /// Upward velocity, m/s; negative while it falls.
    pub climb: f32,
    /// The velocity at which its spin would roll, m/s.
    pub spin: Vector<Field>,
    /// Number of landings since it last lay on the ground.
    pub hops: u32,
}

impl Ball {
    /// Resting on the field surface.
    pub fn at(position: Point<Field>) -> Self {
        Self { position, ..Self::default() }
    }

    /// Rolling on the field surface.
    pub fn rolling(position: Point<Field>, velocity: Vector<Field>) -> Self {
        Self { position, velocity, spin: velocity, ..Self::default() }
    }

    /// Speed in 3-D, m/s.
    pub fn speed(&self) -> f32 {
        math::sqrt(self.velocity.dot(self.velocity) + self.climb * self.climb)
    }

    /// Whether it is above the field surface.
    pub fn in_the_air(&self) -> bool {
        self.height > 0.0 || self.climb > 0.0
    }

    /// Moves freely for `dt` seconds.
    pub(super) fn advance(&mut self, of: &BallParameters, dt: f32) {
        if self.in_the_air() {
            self.fly(of, dt);
        } else if self.velocity != Vector::default() || self.spin != Vector::default() {
            self.roll(of, dt);
        }
    }

    fn fly(&mut self, of: &BallParameters, dt: f32) {
        let mut left = dt;
        for _ in 0..HOPS_PER_STEP {
            let height = self.height + left * (self.climb - 0.5 * of.gravity * left);
            if height > 0.0 {
                self.position += self.velocity * left;
                self.height = height;
                self.climb -= of.gravity * left;
                return;
            }
            let fall = math::sqrt(self.climb * self.climb + 2.0 * of.gravity * self.height);
            let time = ((self.climb + fall) / of.gravity).clamp(0.0, left);
            self.position += self.velocity * time;
            left -= time;
            self.height = 0.0;
            self.climb = fall * of.hop_up;
            let along = if self.hops == 0 { of.hop_along } else { of.hop_along_later };
            self.velocity = self.velocity * along;
            self.hops += 1;
            if self.climb * self.climb < 2.0 * of.gravity * of.hop_end {
                break;
            }
        }
        self.climb = 0.0;
        self.hops = 0;
        self.spin = self.velocity;
        self.roll(of, left);
    }

    fn roll(&mut self, of: &BallParameters, dt: f32) {
        let mut left = dt;
        let slip = self.velocity - self.spin;
        let slipping = slip.norm();
        if slipping > 0.0 {
            // Friction slows the ball by a and speeds its rim up by 5/2 a: the slip ends at 7/2 a.
            let lasts = slipping * (2.0 / 7.0) / of.slide;
            let time = lasts.min(left);
            let push = slip * (-of.slide / slipping);
            self.position += self.velocity * time + push * (0.5 * time * time);
            self.velocity += push * time;
            self.spin = if time < lasts { self.spin - push * (2.5 * time) } else { self.velocity };
            left -= time;
        }
        let speed = self.velocity.norm();
        if left <= 0.0 || speed <= 0.0 {
            return;
        }
        let time = (speed / of.roll).min(left);
        let direction = self.velocity * (1.0 / speed);
        self.position += direction * (time * (speed - 0.5 * of.roll * time));
        self.velocity = if time < left { Vector::default() } else { direction * (speed - of.roll * time) };
        self.spin = self.velocity;
    }

    /// Bounces on a surface that moves with `surface`, whose outward normal is `normal`; returns the change
    /// of its velocity.
    pub(super) fn bounce(
        &mut self,
        normal: Vector<Field>,
        surface: Vector<Field>,
        hit: Impact,
    ) -> Vector<Field> {
        let relative = self.velocity - surface;
        let closing = -relative.dot(normal);
        if closing <= 0.0 {
            return Vector::default();
        }
        let restitution = if closing > REBOUND_SPEED_MIN { hit.restitution } else { 0.0 };
        let push = (1.0 + restitution) * closing * hit.share;
        let along = relative + normal * closing;
        let sliding = along.norm();
        // Friction acts until the ball rolls along the surface: 2/7 of the sliding of a sphere.
        let rub =
            if sliding > 0.0 { (hit.friction * push).min(sliding * (2.0 / 7.0)) / sliding } else { 0.0 };
        let change = normal * push - along * rub;
        self.velocity += change;
        let into = self.spin.dot(normal);
        self.spin = self.spin - normal * (into * (1.0 - hit.spin));
        change
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Impact {
    /// Share of the closing speed that comes back.
    pub restitution: f32,
    /// Coefficient along the surface.
    pub friction: f32,
    /// Share of its roll along the normal that the ball keeps.
    pub spin: f32,
    /// Share of the impact that the ball takes: 1 against walls, less against movable bodies.
    pub share: f32,
}

/// Closing speed, m/s, below which bodies stay together; else a pushed ball would oscillate.
const REBOUND_SPEED_MIN: f32 = 0.03;
/// Maximum number of hops in a millisecond: the lowest hop lasts 90 times as long.
const HOPS_PER_STEP: usize = 2;

#[cfg(test)]
mod tests {
    use rules::League;

    use super::*;
    use crate::small_size::{Parameters, STEP};

    fn division_b() -> BallParameters {
        Parameters::of(League::DivisionB).unwrap().ball
    }

    fn run_until_rest(ball: &mut Ball, of: &BallParameters) -> u32 {
        let mut steps = 0;
        while (ball.velocity != Vector::default() || ball.in_the_air()) && steps < 100_000 {
            ball.advance(of, STEP);
            steps += 1;
        }
        steps
    }

    #[test]
    fn a_flat_kick_of_six_metres_a_second_rests_where_the_closed_formula_says() {
        let (mut ball, of) = (Ball::at(Point::default()), division_b());
        ball.velocity = Vector::new(6.0, 0.0);
        let steps = run_until_rest(&mut ball, &of);
        // v²(1−c²)/2a + c²v²/2r with c = 5/7, a = 3.9, r = 0.35: 2.2606 + 26.2391 m; v(1−c)/a + cv/r = 0.4396
        // + 12.2449 s.
        assert!((ball.position.x() - 28.499_7).abs() < 5e-3, "{:?}", ball.position);
        assert!(steps.abs_diff(12_684) <= 2, "{steps}");
        assert_eq!(ball.position.y(), 0.0);
    }

    #[test]
    fn a_ball_set_rolling_never_slides() {
        let mut ball = Ball::rolling(Point::default(), Vector::new(0.0, -2.0));
        let of = division_b();
        run_until_rest(&mut ball, &of);
        // 2²/(2·0.35) = 5.714 m.
        assert!((ball.position.y() + 5.714_29).abs() < 1e-3, "{:?}", ball.position);
    }

    #[test]
    fn backspin_brings_the_ball_back() {
        let mut ball = Ball::at(Point::default());
        ball.velocity = Vector::new(1.0, 0.0);
        ball.spin = Vector::new(-4.0, 0.0);
        run_until_rest(&mut ball, &division_b());
        // In the end it rolls with 5/7 · 1 + 2/7 · (−4) = −3/7 m/s.
        assert!(ball.position.x() < 0.0, "{:?}", ball.position);
    }

    #[test]
    fn a_chip_lands_where_the_parabola_says_and_hops_as_the_wires_model() {
        let (mut ball, of) = (Ball::at(Point::default()), division_b());
        ball.velocity = Vector::new(3.0, 0.0);
        ball.climb = 3.0;
        let mut top = 0.0_f32;
        while ball.hops == 0 {
            ball.advance(&of, STEP);
            top = top.max(ball.height);
        }
        // 2·3·3/9.81 = 1.8349 m; 3²/(2·9.81) = 0.4587 m; then 0.75 along and 0.5 up. One step flies on after
        // landing.
        assert!((ball.position.x() - 1.834_86).abs() < 3e-3, "{:?}", ball.position);
        assert!((top - 0.458_7).abs() < 1e-4, "{top}");
        assert!((ball.velocity.x() - 2.25).abs() < 1e-5 && (ball.climb - 1.5).abs() < 0.01, "{ball:?}");
        while ball.hops == 1 {
            ball.advance(&of, STEP);
        }
        // The second flight: 2·1.5·2.25/9.81 = 0.6881 m further.
        assert!((ball.position.x() - 2.522_94).abs() < 4e-3, "{:?}", ball.position);
        run_until_rest(&mut ball, &of);
        assert!(ball.height == 0.0 && ball.hops == 0);
    }

    #[test]
    fn an_impact_gives_back_its_share_and_nothing_pulls() {
        let mut ball = Ball::at(Point::default());
        ball.velocity = Vector::new(-2.0, 1.0);
        let hit = Impact { restitution: 0.5, friction: 0.1, spin: 0.0, share: 1.0 };
        let change = ball.bounce(Vector::new(1.0, 0.0), Vector::default(), hit);
        // Along the normal −2 becomes 1; friction 0.1 · 3 would take 0.3, but 2/7 of 1 m/s is the maximum.
        assert!((change - Vector::new(3.0, -2.0 / 7.0)).norm() < 1e-6);
        assert_eq!(ball.bounce(Vector::new(1.0, 0.0), Vector::default(), hit), Vector::default());
        // A surface that moves along pushes the ball.
        ball.velocity = Vector::default();
        ball.bounce(Vector::new(1.0, 0.0), Vector::new(2.0, 0.0), hit);
        assert!((ball.velocity.x() - 3.0).abs() < 1e-6);
    }
}
