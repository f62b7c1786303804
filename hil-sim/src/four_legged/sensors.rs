//! `sensors`: perception of a walking robot. Exact by default; with a noise profile, with Gaussian errors
//! (docs/papers.md R39, R40).
//!
//! Measurement noise is added here and only here (docs/architecture.md §3.2). m, rad, field frame.

use geometry::{Angle, Field, Point, Pose, Twist, Vector};
use protocol::Duration;
use protocol::robot_io::{BallSight, Health, SensorFrame};

use crate::four_legged::parameters::Noise;
use crate::four_legged::world::LeggedWorld;
use crate::rng::Stream;

/// The sensors of one robot.
#[derive(Clone, Debug)]
pub struct Senses {
    noise: Noise,
    chance: Stream,
    /// The robot's true pose at its last measurement.
    before: Option<Pose<Field>>,
}

impl Senses {
    /// The sensors of the robot with index `robot` in the world's list, with errors of `noise`.
    pub fn new(noise: Noise, seed: u64, robot: usize) -> Self {
        Self { noise, chance: Stream::new(seed, &format!("senses {robot}")), before: None }
    }

    /// The sensor frame of the robot, `dt` seconds after its last one.
    pub fn look(&mut self, world: &LeggedWorld, robot: usize, dt: f32) -> SensorFrame {
        let walker = &world.walkers[robot];
        let before = self.before.replace(walker.pose).unwrap_or(walker.pose);
        let moved = before.vector_to_body(walker.pose.position - before.position);
        let turned = (walker.pose.heading - before.heading).radians();
        let ball = world.ball.position;
        let distance = walker.pose.position.distance(ball);
        let sigma = self.noise.ball_floor + self.noise.ball_share * distance;
        let pose = Pose {
            position: self.blurred(walker.pose.position, self.noise.pose),
            heading: walker.pose.heading + self.deviation(self.noise.heading_deg),
        };
        let ball = BallSight {
            position: self.blurred(ball, sigma),
            sigma: sigma.max(SIGMA_FLOOR),
            age: Duration(0),
        };
        let others = world.walkers.iter().filter(|other| other.side != walker.side);
        SensorFrame {
            pose: Some(pose),
            ball: Some(ball),
            opponents: others.map(|o| self.blurred(o.pose.position, self.noise.opponent)).collect(),
            ball_contact: world.holder() == Some(robot),
            busy: walker.action.is_some(),
            odometry: Twist { linear: moved * (1.0 / dt), angular: turned / dt },
            health: Health::default(),
        }
    }

    fn blurred(&mut self, point: Point<Field>, sigma: f32) -> Point<Field> {
        if sigma > 0.0 {
            point + Vector::new(self.chance.normal() * sigma, self.chance.normal() * sigma)
        } else {
            point
        }
    }

    fn deviation(&mut self, degrees: f32) -> Angle {
        if degrees > 0.0 { Angle::degrees(self.chance.normal() * degrees) } else { Angle::ZERO }
    }
}

/// Minimum standard deviation of a noiseless measurement, m: the resolution of the wire format; it keeps
/// brains from dividing by zero.
const SIGMA_FLOOR: f32 = 0.001;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::four_legged::world::{Side, Walker};

    fn world() -> LeggedWorld {
        let walkers = vec![
            Walker::at(Side::Attackers, Pose::from_mm_deg(0.0, 0.0, 90.0)),
            Walker::at(Side::Attackers, Pose::from_mm_deg(-500.0, 0.0, 0.0)),
            Walker::at(Side::Opponents, Pose::from_mm_deg(900.0, 100.0, 180.0)),
        ];
        LeggedWorld::new(Parameters::four_legged(), 0, Point::new(0.0, 2.0), walkers)
    }

    #[test]
    fn without_noise_everything_is_seen_where_it_is() {
        let seen = Senses::new(Noise::NONE, 1, 0).look(&world(), 0, 0.04);
        assert_eq!(seen.pose, Some(Pose::from_mm_deg(0.0, 0.0, 90.0)));
        assert_eq!(seen.ball.unwrap().position, Point::new(0.0, 2.0));
        assert_eq!(seen.opponents[..], [world().walkers[2].pose.position], "teammates are no opponents");
        assert!(!seen.ball_contact && !seen.busy);
    }

    #[test]
    fn odometry_is_the_way_since_the_last_look_in_the_bodys_own_frame() {
        let mut senses = Senses::new(Noise::NONE, 1, 0);
        let mut world = world();
        assert_eq!(senses.look(&world, 0, 0.04).odometry, Twist::default());
        world.walkers[0].pose = Pose::from_mm_deg(-4.0, 8.0, 92.0);
        let moved = senses.look(&world, 0, 0.04).odometry;
        assert!((moved.linear - Vector::new(0.2, 0.1)).norm() < 1e-5, "{moved:?}");
        assert!((moved.angular - 0.872_665).abs() < 1e-3);
    }

    #[test]
    fn the_balls_blur_grows_with_its_distance() {
        let noise = Parameters::four_legged().noise;
        let (mut senses, world) = (Senses::new(noise, 1, 0), world());
        let n = 4_000;
        let mut squares = 0.0;
        for _ in 0..n {
            let ball = senses.look(&world, 0, 0.04).ball.unwrap();
            // 0.02 + 0.08 · 2 m.
            assert!((ball.sigma - 0.18).abs() < 1e-6);
            let error = ball.position.y() - 2.0;
            squares += error * error;
        }
        let deviation = geometry::math::sqrt(squares / n as f32);
        assert!((deviation - 0.18).abs() < 0.18 * 0.045, "{deviation}");
    }
}
