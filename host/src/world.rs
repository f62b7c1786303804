//! `world`: the world model that tracking passes to strategy, radio, referee and page. Field frame; m, m/s,
//! rad, rad/s; times on the host's clock.

use geometry::{Field, Point, Pose, Vector, math};
use motion::ball::chip::ChipModel;
use motion::ball::{BallModel, BallPath};
use motion::trajectory::Motion;
use protocol::{Instant, RobotId, Who};
use rules::Colour;

/// Longest time for which a robot is extrapolated straight on, s: at 3 m/s² it changes its speed by 0.75 m/s
/// in that time, and no delay that is worth compensating is longer (capture to motion is 45–65 ms in the
/// league).
pub const STRAIGHT_MAX: f32 = 0.25;
/// Acceleration of free fall, m/s².
pub(crate) const GRAVITY_M_S2: f32 = 9.81;

/// The field at one moment.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct World {
    /// The moment, on the host's clock.
    pub time: Instant,
    /// The ball in play, if its place is known.
    pub ball: Option<Ball>,
    /// Models of the ball here.
    pub models: BallModels,
    robots: [[Option<Robot>; RobotId::COUNT]; 2],
}

/// Models of the ball on this field surface.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct BallModels {
    /// Model of motion on the ground.
    pub ground: BallModel,
    /// Model of the ball in the air and at bounces.
    pub chip: ChipModel,
}

/// State of the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Place of the ball, or the point below it while it flies.
    pub position: Point<Field>,
    /// Height above its place on the field surface, m.
    pub height: f32,
    /// Velocity along the ground, m/s.
    pub velocity: Vector<Field>,
    /// Velocity upwards, m/s; negative while it falls.
    pub climb: f32,
    /// Speed below which the ball rolls and above which it slides, m/s; infinite where its kick was not seen.
    pub rolls_below: f32,
    /// Whether its last kick has touched the ground once: later bounces lose less.
    pub bounced: bool,
    /// Confidence, 0 (about to be dropped) to 1 (seen just now, and often).
    pub confidence: f32,
    /// When a camera last saw it.
    pub seen: Instant,
    /// The last kick, while the ball's motion is due to it.
    pub kicked: Option<Kick>,
}

/// A kick of the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// The robot at the ball; `None` where no robot was near.
    pub by: Option<Who>,
    /// The place where it left.
    pub from: Point<Field>,
    /// Velocity along the ground, right after the kick, m/s.
    pub velocity: Vector<Field>,
    /// Velocity upwards, m/s; 0 for a flat kick.
    pub climb: f32,
    /// Time of the kick.
    pub at: Instant,
}

impl Kick {
    /// Whether it left the ground.
    pub fn is_chip(&self) -> bool {
        self.climb > 0.0
    }
}

/// State of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robot {
    /// Team and number.
    pub who: Who,
    /// Place and heading.
    pub pose: Pose<Field>,
    /// Velocity of its centre, m/s, field frame.
    pub velocity: Vector<Field>,
    /// Angular velocity, rad/s, counter-clockwise.
    pub angular: f32,
    /// Confidence, 0 (about to be dropped) to 1 (seen just now, and often).
    pub confidence: f32,
    /// When a camera last saw it.
    pub seen: Instant,
}

impl World {
    /// An empty field at that moment.
    pub fn empty(time: Instant, models: BallModels) -> Self {
        Self { time, models, ..Self::default() }
    }

    /// Puts a robot at its place; an earlier one of the same number is replaced.
    pub fn put(&mut self, robot: Robot) {
        self.robots[index(robot.who.colour)][robot.who.id.index()] = Some(robot);
    }

    /// The same with other numbers for the robots of `team`; `number` gives each another one.
    pub(crate) fn renumbered(&self, team: Colour, number: impl Fn(RobotId) -> RobotId) -> Self {
        let mut world = self.clone();
        world.robots[index(team)] = [None; RobotId::COUNT];
        for robot in self.team(team) {
            world.put(Robot { who: Who { id: number(robot.who.id), ..robot.who }, ..*robot });
        }
        world
    }

    /// The robot, if it is on the field.
    pub fn robot(&self, who: Who) -> Option<&Robot> {
        self.robots[index(who.colour)][who.id.index()].as_ref()
    }

    /// A team's robots, lowest number first.
    pub fn team(&self, colour: Colour) -> impl Iterator<Item = &Robot> {
        self.robots[index(colour)].iter().flatten()
    }

    /// Our robots, when we play in `us`.
    pub fn ours(&self, us: Colour) -> impl Iterator<Item = &Robot> {
        self.team(us)
    }

    /// The other team's robots, when we play in `us`.
    pub fn theirs(&self, us: Colour) -> impl Iterator<Item = &Robot> {
        self.team(us.other())
    }

    /// All robots: yellow, then blue, lowest number first.
    pub fn robots(&self) -> impl Iterator<Item = &Robot> {
        self.robots.iter().flatten().flatten()
    }

    /// The robot nearest to a point, and the distance of its centre, m; the first of [`Self::robots`] among
    /// equals.
    pub fn nearest(&self, point: Point<Field>) -> Option<(&Robot, f32)> {
        self.robots()
            .map(|robot| (robot, robot.pose.position.distance(point)))
            .reduce(|best, next| if next.1 < best.1 { next } else { best })
    }

    /// The world at `time` if no robot changes its motion: delay compensation. The ball moves by its model,
    /// robots straight on for at most [`STRAIGHT_MAX`]. A moment before this world's gives this world.
    pub fn at(&self, time: Instant) -> Self {
        let ahead = time.since(self.time).as_secs_f32();
        if ahead <= 0.0 {
            return self.clone();
        }
        let mut later = Self { time, ..self.clone() };
        later.ball = self.ball.map(|ball| ball.after(ahead, &self.models));
        for robot in later.robots.iter_mut().flatten().flatten() {
            *robot = robot.after(ahead);
        }
        later
    }
}

impl Ball {
    /// A ball at standstill, with full confidence.
    pub fn at_rest(position: Point<Field>, seen: Instant) -> Self {
        Self {
            position,
            height: 0.0,
            velocity: Vector::default(),
            climb: 0.0,
            rolls_below: f32::INFINITY,
            bounced: false,
            confidence: 1.0,
            seen,
            kicked: None,
        }
    }

    /// Path of the ball along the ground from here; for a ball in the air, from here as if it were down.
    pub fn path(&self, models: &BallModels) -> BallPath<Field> {
        models.ground.moving(self.position, self.velocity, self.rolls_below)
    }

    /// The same ball `time` seconds later.
    pub fn after(&self, time: f32, models: &BallModels) -> Self {
        if self.is_down() {
            let state = self.path(models).at(time);
            return Self {
                position: state.position,
                velocity: state.velocity,
                height: 0.0,
                climb: 0.0,
                ..*self
            };
        }
        let (path, elapsed) = self.flight(models);
        let state = path.at(elapsed + time);
        Self {
            position: state.ground.position,
            velocity: state.ground.velocity,
            height: state.height,
            climb: state.rise,
            // A bounced ball does not slide any more: a chip's ball rolls when it stays on the ground.
            rolls_below: f32::INFINITY,
            bounced: self.bounced || elapsed + time > self.lands_in() + elapsed,
            ..*self
        }
    }

    /// Stop position of the ball if no robot intercepts it.
    pub fn rest(&self, models: &BallModels) -> Point<Field> {
        if self.is_down() { self.path(models).rest() } else { self.flight(models).0.rest() }
    }

    /// Time until it stops, s.
    pub fn rests_in(&self, models: &BallModels) -> f32 {
        if self.is_down() {
            return self.path(models).duration();
        }
        let (path, elapsed) = self.flight(models);
        path.duration() - elapsed
    }

    /// Time until it touches the ground next, s; 0 on the ground.
    pub fn lands_in(&self) -> f32 {
        if self.is_down() {
            return 0.0;
        }
        (self.climb + math::sqrt(self.climb * self.climb + 2.0 * GRAVITY_M_S2 * self.height))
            * (1.0 / GRAVITY_M_S2)
    }

    fn is_down(&self) -> bool {
        self.height <= 0.0 && self.climb <= 0.0
    }

    /// This hop from its start, and the time since then, s.
    fn flight(&self, models: &BallModels) -> (motion::ball::chip::ChipPath<Field>, f32) {
        let launch = math::sqrt(self.climb * self.climb + 2.0 * GRAVITY_M_S2 * self.height.max(0.0));
        let elapsed = (launch - self.climb) * (1.0 / GRAVITY_M_S2);
        let from = self.position - self.velocity * elapsed;
        let first = if self.bounced { models.chip.other } else { models.chip.first };
        let chip = ChipModel { first, ..models.chip };
        (chip.chipped(from, self.velocity, launch, &models.ground), elapsed)
    }
}

impl Robot {
    /// The same robot `time` seconds later, straight on.
    pub fn after(&self, time: f32) -> Self {
        let time = time.clamp(0.0, STRAIGHT_MAX);
        let pose = Pose {
            position: self.pose.position + self.velocity * time,
            heading: self.pose.heading + geometry::Angle::new(self.angular * time),
        };
        Self { pose, ..*self }
    }
}

/// The index of a team in an array of two.
pub(crate) const fn index(colour: Colour) -> usize {
    match colour {
        Colour::Yellow => 0,
        Colour::Blue => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Angle;
    use protocol::Duration;

    fn robot(colour: Colour, id: u8, x: f32) -> Robot {
        Robot {
            who: Who { colour, id: RobotId::new(id).unwrap() },
            pose: Pose { position: Point::new(x, 0.0), heading: Angle::degrees(170.0) },
            velocity: Vector::new(1.0, -2.0),
            angular: 10.0,
            confidence: 1.0,
            seen: Instant(0),
        }
    }

    fn ball(velocity: Vector<Field>, height: f32, climb: f32) -> Ball {
        Ball { height, velocity, climb, ..Ball::at_rest(Point::default(), Instant(0)) }
    }

    #[test]
    fn teams_are_ours_and_theirs_by_our_colour_and_come_in_order() {
        let mut world = World::default();
        world.put(robot(Colour::Blue, 7, 0.0));
        world.put(robot(Colour::Blue, 2, 0.5));
        world.put(robot(Colour::Yellow, 2, 1.0));
        let ids = |robots: Vec<&Robot>| robots.iter().map(|r| r.who.id.number()).collect::<Vec<_>>();
        assert_eq!(ids(world.ours(Colour::Blue).collect()), [2, 7]);
        assert_eq!(ids(world.theirs(Colour::Blue).collect()), [2]);
        let (nearest, distance) = world.nearest(Point::new(0.9, 0.0)).unwrap();
        assert_eq!((nearest.who.colour, (distance * 10.0) as i32), (Colour::Yellow, 1));
    }

    #[test]
    fn extrapolation_by_0_1_s_moves_a_robot_and_wraps_its_heading() {
        let mut world = World::empty(Instant(5_000_000), BallModels::default());
        world.put(robot(Colour::Yellow, 0, 1.0));
        let later = world.at(Instant(5_000_000) + Duration::millis(100));
        let moved = later.robots().next().unwrap();
        assert!(moved.pose.position.distance(Point::new(1.1, -0.2)) < 1e-5);
        assert!((moved.pose.heading.to_degrees() - (170.0 + 57.295_78 - 360.0)).abs() < 1e-3);
        assert_eq!(world.at(Instant(1)), world, "the past is not made up");
    }

    #[test]
    fn a_rolling_ball_is_carried_by_its_deceleration_and_stops() {
        let models =
            BallModels { ground: BallModel { slide: 4.0, roll: 0.5, switch: 0.7 }, ..BallModels::default() };
        let rolling = ball(Vector::new(1.0, 0.0), 0.0, 0.0);
        let later = rolling.after(1.0, &models);
        assert!((later.position.x() - 0.75).abs() < 1e-5 && (later.velocity.x() - 0.5).abs() < 1e-5);
        assert!((rolling.rest(&models).x() - 1.0).abs() < 1e-5);
        assert_eq!(rolling.after(9.0, &models).velocity, Vector::new(0.0, 0.0));
        // Sliding from 1 m/s to 0.8 takes 0.05 s and 45 mm; then 0.05 s of rolling.
        let sliding = Ball { rolls_below: 0.8, ..rolling };
        let expected = 0.045 + 0.8 * 0.05 - 0.25 * 0.0025;
        assert!((sliding.after(0.1, &models).position.x() - expected).abs() < 1e-5);
    }

    #[test]
    fn a_ball_in_the_air_is_carried_along_its_parabola_and_over_its_bounce() {
        let models = BallModels::default();
        let launched = ball(Vector::new(2.0, 0.0), 0.0, 3.0);
        let whole = models.chip.chipped(launched.position, launched.velocity, launched.climb, &models.ground);
        let mut stepped = launched;
        for step in 1..=40 {
            stepped = stepped.after(0.05, &models);
            let truth = whole.at(step as f32 * 0.05);
            assert!(
                stepped.position.distance(truth.ground.position) < 2e-3,
                "step {step}: {stepped:?} {truth:?}"
            );
            assert!((stepped.height - truth.height).abs() < 2e-3, "step {step}");
        }
        assert!((launched.lands_in() - 6.0 / 9.81).abs() < 1e-5);
        assert!(launched.rest(&models).distance(whole.rest()) < 1e-4);
    }
}
