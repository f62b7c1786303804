//! `episode`: one attempt to score in the Small Size simulator, in steps of one control period. m, s, rad;
//! own robots are blue and attack the goal at +x.

use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector};
use hil_sim::small_size::{Ball, Drive, KickCommand, Order, Parameters, World};
use hil_sim::{Stream, TraceHash};
use protocol::{RobotId, Who};
use rules::{Colour, League};

/// League, robots and times of an episode.
#[derive(Clone, Debug)]
pub struct Settings {
    /// League, whose field and physics are simulated.
    pub league: League,
    /// Number of own robots.
    pub own: usize,
    /// Number of standing opponents on the field.
    pub opponents: usize,
    /// Control period, ms: orders stay as they are in between.
    pub period_ms: u32,
    /// Simulated time after which the episode ends, s.
    pub time_limit_s: f64,
}

/// End of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The ball is in the opponents' goal.
    Goal,
    /// The ball is in the own goal.
    OwnGoal,
    /// The ball left the field elsewhere.
    Out,
    /// The time limit is reached.
    Time,
}

impl End {
    /// Name in Python.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Goal => "goal",
            Self::OwnGoal => "own_goal",
            Self::Out => "out",
            Self::Time => "time",
        }
    }
}

/// Episode with its world, advanced action by action.
#[derive(Clone, Debug)]
pub struct Episode {
    settings: Settings,
    parameters: &'static Parameters,
    /// True state of ball and robots.
    pub world: World,
    trace: TraceHash,
    steps: u32,
    /// Reward of the last step.
    pub reward: f32,
    /// End of the episode, once it has ended.
    pub end: Option<End>,
}

impl Episode {
    /// From random start positions that follow from the seed; `None` for a league without this simulator.
    pub fn start(settings: Settings, seed: u64) -> Option<Self> {
        let parameters = Parameters::of(settings.league)?;
        let mut world = World::new(settings.league, parameters, seed);
        line_up(&mut world, &settings, seed);
        let mut episode = Self {
            settings,
            parameters,
            world,
            trace: TraceHash::default(),
            steps: 0,
            reward: 0.0,
            end: None,
        };
        episode.trace.small_size_tick(0, &episode.world);
        Some(episode)
    }

    /// Plays one control period with these orders, [`ACTION_LEN`] numbers for each robot; an empty slice
    /// for the opponents lets them stand. A finished episode stays as it is.
    pub fn step(&mut self, own: &[f32], opponents: &[f32]) {
        self.reward = 0.0;
        if self.end.is_some() {
            return;
        }
        for (colour, actions) in [(Colour::Blue, own), (Colour::Yellow, opponents)] {
            for (id, action) in RobotId::all().zip(actions.chunks_exact(ACTION_LEN)) {
                let order = self.order(action);
                self.world.order(Who { colour, id }, order);
            }
        }
        let before = self.potential();
        for _ in 0..self.settings.period_ms {
            self.world.step();
            self.end = self.ball_gone();
            if self.end.is_some() {
                break;
            }
        }
        self.steps += 1;
        self.trace.small_size_tick(self.steps, &self.world);
        self.reward = self.potential() - before;
        match self.end {
            Some(End::Goal) => self.reward += GOAL_REWARD,
            Some(End::OwnGoal) => self.reward -= GOAL_REWARD,
            None if self.world.time() >= self.settings.time_limit_s => self.end = Some(End::Time),
            _ => {}
        }
    }

    /// Writes the observation, [`observation_len`] numbers within ±1.
    pub fn observe(&self, mut put: impl FnMut(usize, f32)) {
        let [x, y] = self.world.pitch().corner();
        let (ball, limits) = (&self.world.ball, self.parameters.drive);
        let shot = self.parameters.kick.flat;
        let mut at = 0;
        let mut next = |value: f32| {
            put(at, value.clamp(-1.0, 1.0));
            at += 1;
        };
        for value in [
            ball.position.x() / x,
            ball.position.y() / y,
            ball.height / HEIGHT_SCALE,
            ball.velocity.x() / shot,
            ball.velocity.y() / shot,
        ] {
            next(value);
        }
        for (colour, count) in [(Colour::Blue, self.settings.own), (Colour::Yellow, self.settings.opponents)]
        {
            for id in RobotId::all().take(count) {
                let Some(robot) = self.world.robot(Who { colour, id }) else { continue };
                let (sin, cos) = robot.pose.heading.sin_cos();
                for value in [
                    robot.pose.position.x() / x,
                    robot.pose.position.y() / y,
                    sin,
                    cos,
                    robot.velocity.x() / limits.speed,
                    robot.velocity.y() / limits.speed,
                    robot.turning / limits.turn_speed,
                    f32::from(u8::from(robot.ball_contact)),
                ] {
                    next(value);
                }
            }
        }
    }

    /// Hash of every step's state so far: equal for equal episodes.
    pub fn trace_hash(&self) -> String {
        self.trace.digits()
    }

    fn order(&self, action: &[f32]) -> Order {
        let drive = self.parameters.drive;
        let [forward, left, turn, kick, dribbler] =
            std::array::from_fn(|at| action.get(at).copied().unwrap_or(0.0).clamp(-1.0, 1.0));
        let linear = Vector::<Body>::new(forward, left) * drive.speed;
        let kick =
            (kick > 0.0).then_some(KickCommand { speed: kick * self.parameters.kick.flat, angle: 0.0 });
        Order {
            drive: Drive::Local(Twist {
                linear: linear.clamped(drive.speed),
                angular: turn * drive.turn_speed,
            }),
            kick,
            dribbler: dribbler.max(0.0),
            discharge: false,
        }
    }

    /// Minus the ball's distance to the opponents' goal, m, and minus a share of the distance between the
    /// ball and the nearest own robot, m.
    fn potential(&self) -> f32 {
        let ball = self.world.ball.position;
        let goal = Point::<Field>::new(self.world.pitch().field.length * 0.5, 0.0);
        let own = self.world.robots().iter().filter(|robot| robot.who.colour == Colour::Blue);
        let nearest = own.map(|robot| robot.pose.position.distance(ball)).fold(f32::INFINITY, f32::min);
        -(goal.distance(ball) + APPROACH_SHARE * nearest)
    }

    fn ball_gone(&self) -> Option<End> {
        let (ball, field) = (&self.world.ball, self.world.pitch().field);
        let (x, y) = (ball.position.x(), ball.position.y());
        let radius = self.parameters.ball.radius;
        let behind_line = x.abs() > field.length * 0.5 + radius;
        if behind_line && y.abs() < field.goal_width * 0.5 && ball.height < field.goal_height {
            return Some(if x > 0.0 { End::Goal } else { End::OwnGoal });
        }
        (behind_line || y.abs() > field.width * 0.5 + radius).then_some(End::Out)
    }
}

/// The ball within the middle of the field; own robots in their half, opponents in theirs, apart from each
/// other.
fn line_up(world: &mut World, settings: &Settings, seed: u64) {
    let field = world.pitch().field;
    let (length, width) = (field.length * 0.5 - EDGE, field.width * 0.5 - EDGE);
    let mut draw = Stream::new(seed, "python start");
    let ball = Point::new(draw.between(-0.5 * length, 0.5 * length), draw.between(-0.5 * width, 0.5 * width));
    world.put_ball(Ball::at(ball));
    let mut taken = vec![ball];
    for (colour, count, side) in
        [(Colour::Blue, settings.own, -1.0), (Colour::Yellow, settings.opponents, 1.0)]
    {
        for id in RobotId::all().take(count) {
            let mut place = Point::default();
            for _ in 0..DRAWS_MAX {
                place = Point::new(side * draw.between(0.0, length), draw.between(-width, width));
                if taken.iter().all(|other| other.distance(place) > START_APART_MIN) {
                    break;
                }
            }
            taken.push(place);
            let heading = Angle::new(draw.between(-geometry::math::PI, geometry::math::PI));
            world.put(Who { colour, id }, Pose { position: place, heading });
        }
    }
}

/// Number of values in an observation.
pub fn observation_len(settings: &Settings) -> usize {
    BALL_LEN + ROBOT_LEN * (settings.own + settings.opponents)
}

/// Values of an order: forward, left, turn, kick, dribbler.
pub const ACTION_LEN: usize = 5;
/// Values of the ball in an observation: x, y, height, velocity along x and y.
pub const BALL_LEN: usize = 5;
/// Values of a robot: x, y, sine and cosine of the heading, velocity along x and y, turning rate, ball
/// contact.
pub const ROBOT_LEN: usize = 8;
/// Reward of a goal, and minus that of an own goal: more than any way across the field adds up to, m.
const GOAL_REWARD: f32 = 10.0;
/// Weight of the way to the ball against the ball's way to the goal: a shot is worth more than an approach.
const APPROACH_SHARE: f32 = 0.5;
/// Height of the ball that is observed as 1, m: chips rise higher for moments only.
const HEIGHT_SCALE: f32 = 1.0;
/// Least distance of start positions from the field's lines, m.
const EDGE: f32 = 0.3;
/// Least distance between start positions, m: three robots' radii.
const START_APART_MIN: f32 = 0.27;
/// Draws for a start position; after that the last one is taken, and the physics parts the robots.
const DRAWS_MAX: usize = 100;
