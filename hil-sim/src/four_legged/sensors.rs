//! `sensors`: sensor frames of a walking robot. Exact by default; with a noise profile, what its camera and
//! legs measure (docs/papers.md R39, R40).
//!
//! Measurement noise is added here and only here (docs/architecture.md §3.2). m, rad. An exact frame has pose
//! and ball in the field frame. With noise it has sights of ball and landmarks in the body frame (`camera`),
//! an odometry of legs that slip, opponents' positions as those report them, and a pose in the first frame
//! alone: a robot is placed by hand at kick-off.

use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector};
use protocol::Duration;
use protocol::robot_io::{BallSight, SensorFrame};

use crate::four_legged::camera::Camera;
use crate::four_legged::drift::Drift;
use crate::four_legged::parameters::Noise;
use crate::four_legged::world::{LeggedWorld, Walker};
use crate::rng::Stream;

/// The sensors of one robot.
#[derive(Clone, Debug)]
pub struct Senses {
    noisy: Option<Noisy>,
    /// The robot's true pose at its last measurement.
    before: Option<Pose<Field>>,
}

/// Camera and legs with their errors.
#[derive(Clone, Debug)]
struct Noisy {
    noise: Noise,
    camera: Camera,
    legs: Stream,
    /// Factors of the odometry: ahead, aside, turning.
    scale: [f32; 3],
    slip: [Drift; 3],
}

impl Senses {
    /// The sensors of the robot with index `robot` in the world's list, with errors of `noise`; a frame every
    /// `dt` s.
    pub fn new(noise: Noise, seed: u64, robot: usize, dt: f32) -> Self {
        let noisy = (!noise.is_none()).then(|| {
            let mut legs = Stream::new(seed, &format!("legs {robot}"));
            let scale = [(); 3].map(|()| 1.0 + noise.odometry_scale * legs.normal());
            let slip = [(); 3].map(|()| Drift::new(noise.slip_time, dt, &mut legs));
            let camera = Camera::new(noise, dt, Stream::new(seed, &format!("senses {robot}")));
            Noisy { noise, camera, legs, scale, slip }
        });
        Self { noisy, before: None }
    }

    /// The sensor frame of the robot, `dt` seconds after its last one; `opponents` are the positions that the
    /// opponents report.
    pub fn look(
        &mut self,
        world: &LeggedWorld,
        robot: usize,
        opponents: impl IntoIterator<Item = Point<Field>>,
        dt: f32,
    ) -> SensorFrame {
        let walker = &world.walkers[robot];
        let before = self.before.replace(walker.pose);
        let holds = world.holder() == Some(robot);
        let mut frame = SensorFrame {
            // A team has no more robots than a frame has room for.
            opponents: opponents.into_iter().take(protocol::robot_io::OPPONENTS_SEEN_MAX).collect(),
            ball_contact: holds,
            busy: walker.action.is_some(),
            ..SensorFrame::default()
        };
        if let Some(noisy) = &mut self.noisy {
            // The legs hold the ball under the head.
            let ball = (!holds).then_some(world.ball.position);
            let walks = walker.twist.linear.norm() > STANDING_SPEED_MAX
                || walker.twist.angular.abs() > STANDING_SPEED_MAX;
            frame.camera = Some(noisy.camera.frame(walker.pose, ball, walks));
            frame.odometry = noisy.odometry(walker);
            frame.pose = before.is_none().then(|| noisy.placed(walker.pose));
        } else {
            let before = before.unwrap_or(walker.pose);
            let moved = before.vector_to_body(walker.pose.position - before.position);
            let turned = (walker.pose.heading - before.heading).radians();
            frame.odometry = Twist { linear: moved * (1.0 / dt), angular: turned / dt };
            frame.pose = Some(walker.pose);
            let (position, sigma) = (world.ball.position, SIGMA_FLOOR);
            frame.ball = Some(BallSight { position, sigma, age: Duration(0) });
        }
        frame
    }
}

impl Noisy {
    /// The motion as the legs measure it: they mismeasure, they slip, and they do not feel pushes.
    fn odometry(&mut self, walker: &Walker) -> Twist<Body> {
        let slip = self.noise.odometry_slip;
        let mut factor = |axis: usize| self.scale[axis] + slip * self.slip[axis].step(&mut self.legs);
        let (ahead, aside, turning) = (factor(0), factor(1), factor(2));
        let Twist { linear, angular } = walker.twist;
        Twist { linear: Vector::new(linear.x() * ahead, linear.y() * aside), angular: angular * turning }
    }

    /// Believed pose of a robot that is placed at `pose`.
    fn placed(&mut self, pose: Pose<Field>) -> Pose<Field> {
        let (x, y) = self.legs.normals();
        let turned = Angle::degrees(self.legs.normal() * self.noise.placing_deg);
        Pose {
            position: pose.position + Vector::new(x, y) * self.noise.placing,
            heading: pose.heading + turned,
        }
    }
}

/// Minimum standard deviation of a noiseless measurement, m: the resolution of the wire format; it keeps
/// brains from dividing by zero.
const SIGMA_FLOOR: f32 = 0.001;
/// Speed below which a robot stands, m/s and rad/s: below what one order of a step changes (0.024).
const STANDING_SPEED_MAX: f32 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::four_legged::world::Side;

    const DT: f32 = 0.04;

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
        let opponent = world().walkers[2].pose.position;
        let seen = Senses::new(Noise::NONE, 1, 0, DT).look(&world(), 0, [opponent], DT);
        assert_eq!(seen.pose, Some(Pose::from_mm_deg(0.0, 0.0, 90.0)));
        assert_eq!(seen.ball.unwrap().position, Point::new(0.0, 2.0));
        assert_eq!(seen.opponents[..], [opponent]);
        assert!(!seen.ball_contact && !seen.busy && seen.camera.is_none());
    }

    #[test]
    fn odometry_is_the_body_frame_motion_since_the_last_frame() {
        let mut senses = Senses::new(Noise::NONE, 1, 0, DT);
        let mut world = world();
        assert_eq!(senses.look(&world, 0, [], DT).odometry, Twist::default());
        world.walkers[0].pose = Pose::from_mm_deg(-4.0, 8.0, 92.0);
        let moved = senses.look(&world, 0, [], DT).odometry;
        assert!((moved.linear - Vector::new(0.2, 0.1)).norm() < 1e-5, "{moved:?}");
        assert!((moved.angular - 0.872_665).abs() < 1e-3);
    }

    #[test]
    fn with_noise_a_robot_gets_its_pose_at_kick_off_and_then_sights_alone() {
        let noise = Parameters::four_legged().noise;
        let (mut placed, mut count) = (0.0, 0);
        for seed in 0..400 {
            let (mut senses, world) = (Senses::new(noise, seed, 0, DT), world());
            let first = senses.look(&world, 0, [], DT);
            let off = first.pose.unwrap().position - world.walkers[0].pose.position;
            (placed, count) = (placed + off.norm() * off.norm(), count + 2);
            assert!(first.ball.is_none() && first.camera.is_some());
            let next = senses.look(&world, 0, [], DT);
            assert!(next.pose.is_none() && next.ball.is_none() && next.camera.is_some());
        }
        let sigma = geometry::math::sqrt(placed / count as f32);
        assert!((sigma - noise.placing).abs() < 0.1 * noise.placing, "{sigma}");
    }

    #[test]
    fn the_brains_error_model_equals_the_simulated_noise() {
        use brain::belief::model;
        let noise = Parameters::four_legged().noise;
        for (assumed, degrees) in [
            (model::PIXEL, noise.pixel_deg),
            (model::JOINT, noise.joint_deg),
            (model::SWAY, noise.sway_deg),
            (model::PLACING_HEADING, noise.placing_deg),
        ] {
            assert!((assumed - degrees.to_radians()).abs() < 1e-6, "{degrees}");
        }
        let lengths =
            [model::MARKER_SIZE, model::GOAL_SIZE, model::RANGE_FLOOR, model::PLACING, model::REPORTED];
        assert_eq!(lengths, [noise.marker, noise.goal, noise.range_floor, noise.placing, noise.localisation]);
        let legs = [model::SLIP, model::SLIP_TIME, model::SCALE, model::SWAY_TIME, model::STANDSTILL_SPEED];
        let world =
            [noise.odometry_slip, noise.slip_time, noise.odometry_scale, noise.sway_time, STANDING_SPEED_MAX];
        assert_eq!(legs, world);
    }

    #[test]
    fn odometry_errors_are_a_share_of_the_speed_and_miss_pushes() {
        let noise = Parameters::four_legged().noise;
        let (mut squares, n) = (0.0, 4_000);
        for seed in 0..n {
            let (mut senses, mut world) = (Senses::new(noise, seed, 0, DT), world());
            world.walkers[0].twist.linear = Vector::new(0.3, 0.0);
            let ahead = senses.look(&world, 0, [], DT).odometry.linear.x() / 0.3 - 1.0;
            squares += ahead * ahead;
        }
        let (sigma, expected) = (geometry::math::sqrt(squares / n as f32), geometry::math::hypot(0.05, 0.15));
        assert!((sigma / expected - 1.0).abs() < 0.05, "{sigma}");
        let (mut senses, mut world) = (Senses::new(noise, 1, 0, DT), world());
        senses.look(&world, 0, [], DT);
        world.walkers[0].pose.position = Point::new(0.1, 0.0);
        assert_eq!(senses.look(&world, 0, [], DT).odometry, Twist::default());
    }
}
