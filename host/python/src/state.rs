//! `state`: state of an episode: its world, what is observed and earned in it, how it ends. m, s, rad; own
//! robots are blue and attack the goal at +x.

use geometry::{Body, Field, Point, Twist, Vector};
use hil_sim::TraceHash;
use hil_sim::small_size::worlds::WorldModel;
use hil_sim::small_size::{Drive, KickCommand, Order, Parameters, Robot, World};
use protocol::{RobotId, Who};
use rules::{Colour, League};
use serde::{Deserialize, Serialize};

use crate::computers::Judgement;
use crate::driver::{Driver, Script};
use crate::legged;
use crate::sensed::SensedWorld;
use crate::settings::{ACTION_LEN, End, Settings, View};
use crate::start::line_up;

/// State of an episode.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// What it was started with.
    pub settings: Settings,
    /// Its seed.
    pub seed: u64,
    /// True state of ball and robots.
    pub world: World,
    /// Reward of the last step.
    pub reward: f32,
    /// End of the episode, once it has ended.
    pub end: Option<End>,
    /// Goals of the own team and of the opponents, under the referee.
    pub score: [u32; 2],
    scales: Scales,
    /// Hash of every step so far.
    pub trace: TraceHash,
    steps: u32,
    /// The world's step at the start.
    pub started: u64,
    /// Whether the ball is in play.
    pub in_play: bool,
    restart: Option<Colour>,
    /// Where the ball was when robot 0 touched it last, unless robot 1 has touched it since.
    passed_from: Option<Point<Field>>,
    /// The side that alone holds the ball, and since which step of the world.
    holder: Option<(Colour, u64)>,
}

/// Speeds that an action or an observation of 1 stands for: the league's, whatever the world.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Scales {
    /// m/s, of robots.
    speed: f32,
    /// rad/s, of robots.
    turn_speed: f32,
    /// m/s, of the ball.
    shot: f32,
}

impl State {
    /// Ball and robots at the start; an error for a league without this simulator.
    pub fn start(settings: Settings, seed: u64) -> Result<Self, String> {
        let (world, scales) = if settings.task.spec().scenario.is_some() {
            // It shows ball and robots of the trial; its own physics rests.
            let parameters = Parameters::of(League::DivisionB).ok_or(NO_SIMULATOR)?;
            (World::new(settings.league, parameters, seed), legged::scales())
        } else {
            let of = Parameters::of(settings.league).ok_or(NO_SIMULATOR)?;
            let mut world = World::of_model(settings.league, &model(&settings, seed)?, seed);
            line_up(&mut world, &settings, seed);
            (world, [of.drive.speed, of.drive.turn_speed, of.kick.flat])
        };
        Ok(Self {
            scales: Scales { speed: scales[0], turn_speed: scales[1], shot: scales[2] },
            in_play: !settings.task.spec().referee,
            settings,
            seed,
            world,
            trace: TraceHash::default(),
            steps: 0,
            started: 0,
            reward: 0.0,
            end: None,
            score: [0; 2],
            restart: None,
            passed_from: None,
            holder: None,
        })
    }

    /// The cameras over its world, with a host's tracker.
    pub fn sensed(&self) -> Result<SensedWorld, String> {
        Ok(SensedWorld::new(&self.world, model(&self.settings, self.seed)?.vision, self.seed))
    }

    /// Simulated time since the start, s.
    pub fn time_s(&self) -> f64 {
        if self.settings.task.spec().scenario.is_some() {
            return f64::from(self.steps * self.settings.period_ms) * 0.001;
        }
        self.world.now().saturating_sub(self.started) as f64 * 0.001
    }

    /// Whether a state that was read can be played: its world is whole and has the robots of its settings.
    pub fn is_consistent(&self) -> bool {
        self.world.is_consistent()
            && Colour::ALL.into_iter().all(|colour| {
                let mut ids = RobotId::all().take(self.settings.count(colour));
                ids.all(|id| self.world.robot(Who { colour, id }).is_some())
            })
    }

    /// Gives the caller's orders and the script's.
    pub fn order(&mut self, own: &[f32], opponents: &[f32]) {
        for (colour, actions) in [(Colour::Blue, own), (Colour::Yellow, opponents)] {
            for (id, action) in RobotId::all().zip(actions.chunks_exact(ACTION_LEN)) {
                let order = self.order_of(action);
                self.world.send_order(Who { colour, id }, order);
            }
        }
        let settings = &self.settings;
        let spec = settings.task.spec();
        for (colour, first) in [(Colour::Blue, settings.agents), (Colour::Yellow, 0)] {
            if settings.driver(colour) == Driver::Scripted {
                let keeper = spec.keeper && colour == Colour::Yellow;
                let robots = first..settings.count(colour);
                let shoots = spec.ends.hold_s == 0.0;
                Script { colour, robots, keeper, shoots }.order(&mut self.world);
            }
        }
    }

    /// Takes the referee's view of a tick.
    pub fn take(&mut self, judgement: Judgement) {
        (self.score, self.in_play, self.restart) = (judgement.score, judgement.in_play, judgement.restart);
    }

    /// After a period's physics: estimate, hash, reward, time limit.
    pub fn finish_step(
        &mut self,
        before: f32,
        was_in_play: bool,
        score: [u32; 2],
        sensed: &mut Option<SensedWorld>,
    ) {
        if let Some(sensed) = sensed {
            sensed.estimate(&self.world);
        }
        self.world.take_events(&mut Vec::new());
        self.steps += 1;
        self.trace.small_size_tick(self.steps, &self.world);
        let (weights, period_s) = (&self.settings.task.spec().reward, self.settings.period_ms as f32 * 0.001);
        self.reward = if was_in_play && self.in_play { self.potential() - before } else { 0.0 };
        self.reward += weights.per_s * period_s;
        let held = self.holder.map_or(0.0, |(side, _)| side.pick(-1.0, 1.0));
        self.reward += weights.held_per_s * held * period_s;
        self.reward += weights.goal * (self.score[0] as f32 - score[0] as f32);
        self.reward -= weights.goal * (self.score[1] as f32 - score[1] as f32);
        self.reward += match self.end {
            Some(End::Goal) => weights.goal,
            Some(End::OwnGoal) => -weights.goal,
            Some(End::Out) => weights.out,
            Some(End::Received | End::Won) => weights.success,
            Some(End::Lost) => weights.lost,
            Some(End::Time | End::Close) | None => 0.0,
        };
        if self.end.is_none() && self.time_s() >= self.settings.time_limit_s {
            self.end = Some(End::Time);
        }
    }

    /// Writes the observation of the true or of the estimated state, [`Settings::observation_len`] numbers
    /// within ±1.
    pub fn observe(&self, view: View, estimated: Option<&World>, into: &mut [f32]) {
        let world = estimated.unwrap_or(&self.world);
        let [x, y] = world.pitch().corner();
        let (ball, Scales { speed, turn_speed, shot }) = (&world.ball, self.scales);
        let turned = view.side.pick(-1.0, 1.0);
        let mut places = into.iter_mut();
        let mut next = |value: f32| {
            if let Some(place) = places.next() {
                *place = value.clamp(-1.0, 1.0);
            }
        };
        for value in [
            turned * ball.position.x() / x,
            turned * ball.position.y() / y,
            ball.height / HEIGHT_SCALE,
            turned * ball.velocity.x() / shot,
            turned * ball.velocity.y() / shot,
        ] {
            next(value);
        }
        let other = view.side.pick(Colour::Blue, Colour::Yellow);
        for (colour, first) in [(view.side, view.first), (other, 0)] {
            let count = self.settings.count(colour);
            let others = (0..count).filter(|n| *n != first);
            for n in (first..count).take(1).chain(others) {
                let id = RobotId::new(n as u8).unwrap_or(RobotId::ZERO);
                let Some(robot) = world.robot(Who { colour, id }) else { continue };
                // Opponents do not report what they sense.
                let contact = robot.ball_contact && (estimated.is_none() || colour == view.side);
                let (sin, cos) = robot.pose.heading.sin_cos();
                for value in [
                    turned * robot.pose.position.x() / x,
                    turned * robot.pose.position.y() / y,
                    turned * sin,
                    turned * cos,
                    turned * robot.velocity.x() / speed,
                    turned * robot.velocity.y() / speed,
                    robot.turning / turn_speed,
                    f32::from(u8::from(contact)),
                ] {
                    next(value);
                }
            }
        }
        if self.settings.task.spec().referee {
            let restart = self.restart.map_or(0.0, |side| if side == view.side { 1.0 } else { -1.0 });
            let ahead = turned * (self.score[0] as f32 - self.score[1] as f32) / SCORE_SCALE;
            let left = 1.0 - self.time_s() / self.settings.time_limit_s;
            for value in [f32::from(u8::from(self.in_play)), restart, ahead, left as f32] {
                next(value);
            }
        }
    }

    fn order_of(&self, action: &[f32]) -> Order {
        let Scales { speed, turn_speed, shot } = self.scales;
        let [forward, left, turn, kick, dribbler] =
            std::array::from_fn(|at| action.get(at).copied().unwrap_or(0.0).clamp(-1.0, 1.0));
        let linear = Vector::<Body>::new(forward, left) * speed;
        let kick = (kick > 0.0).then_some(KickCommand { speed: kick * shot, angle: 0.0 });
        Order {
            drive: Drive::Local(Twist { linear: linear.clamped(speed), angular: turn * turn_speed }),
            kick,
            dribbler: dribbler.max(0.0),
            discharge: false,
        }
    }

    /// Minus the weighted distances of the reward.
    pub fn potential(&self) -> f32 {
        let weights = &self.settings.task.spec().reward;
        let ball = self.world.ball.position;
        let goal = Point::<Field>::new(self.world.pitch().field.length * 0.5, 0.0);
        let own = self.world.robots().iter();
        let own = own.filter(|robot| robot.who.colour == Colour::Blue && !robot.bystander);
        let mut distances = own.map(|robot| robot.pose.position.distance(ball));
        let nearest = distances.clone().fold(f32::INFINITY, f32::min);
        let receiver = distances.nth(1).unwrap_or(0.0);
        -(weights.to_goal * goal.distance(ball) + weights.to_ball * nearest + weights.to_receiver * receiver)
    }

    /// How the episode ends now, if it does; under the referee it goes on.
    pub fn judge(&mut self) -> Option<End> {
        let spec = self.settings.task.spec();
        if spec.referee || spec.scenario.is_some() {
            return None;
        }
        let (ball, ends) = (self.world.ball.position, &spec.ends);
        if ends.region.is_some_and(|[x, y]| ball.x().abs() > x || ball.y().abs() > y) {
            return Some(End::Out);
        }
        let touch = self.world.last_touch().filter(|(_, step)| *step > self.started);
        if ends.touch_loses && touch.is_some_and(|(who, _)| who.colour == Colour::Yellow) {
            return Some(End::Lost);
        }
        self.ball_gone().or_else(|| self.received(ends.pass_m)).or_else(|| self.held(ends.hold_s))
    }

    /// Whether robot 1 has a ball that came that far from robot 0.
    fn received(&mut self, distance: f32) -> Option<End> {
        let ball = self.world.ball.position;
        if distance == 0.0 {
            return None;
        }
        let mut own = RobotId::all().filter_map(|id| self.world.robot(Who::blue(id)));
        let (passer, receiver) = (own.next()?, own.next()?);
        if has_ball(passer) {
            self.passed_from = Some(ball);
        } else if has_ball(receiver) {
            let far_enough = self.passed_from.is_some_and(|from| from.distance(ball) >= distance);
            if far_enough && receiver.ball_contact {
                return Some(End::Received);
            }
            self.passed_from = self.passed_from.filter(|_| far_enough);
        }
        None
    }

    /// Whether a side alone has held the ball that long, s.
    fn held(&mut self, seconds: f32) -> Option<End> {
        if seconds == 0.0 {
            return None;
        }
        let now = self.world.now();
        let robots = self.world.robots().iter().filter(|robot| robot.present && !robot.bystander);
        let mut holders = Colour::ALL
            .into_iter()
            .filter(|side| robots.clone().any(|robot| robot.who.colour == *side && robot.ball_contact));
        let (Some(side), None) = (holders.next(), holders.next()) else {
            self.holder = None;
            return None;
        };
        let since = self.holder.filter(|(holder, _)| *holder == side).map_or(now, |(_, since)| since);
        self.holder = Some((side, since));
        ((now - since) as f32 * 0.001 >= seconds).then_some(side.pick(End::Lost, End::Won))
    }

    fn ball_gone(&self) -> Option<End> {
        let (ball, field) = (&self.world.ball, self.world.pitch().field);
        let (x, y) = (ball.position.x(), ball.position.y());
        let radius = self.world.parameters().ball.radius;
        let behind_line = x.abs() > field.length * 0.5 + radius;
        if behind_line && y.abs() < field.goal_width * 0.5 && ball.height < field.goal_height {
            return Some(if x > 0.0 { End::Goal } else { End::OwnGoal });
        }
        (behind_line || y.abs() > field.width * 0.5 + radius).then_some(End::Out)
    }
}

/// Whether a robot touches the ball; its break-beam sensor may detect it before the hull does.
fn has_ball(robot: &Robot) -> bool {
    robot.touching || robot.ball_contact
}

fn model(settings: &Settings, seed: u64) -> Result<WorldModel, String> {
    let model = WorldModel::of(settings.league, &settings.world.of_match(seed));
    model.ok_or_else(|| NO_SIMULATOR.to_owned())
}

const NO_SIMULATOR: &str = "that league has no simulator of wheeled robots";
/// Goals ahead that are observed as 1: more is rare in a match.
const SCORE_SCALE: f32 = 10.0;
/// Height of the ball that is observed as 1, m: chips rise higher for moments only.
const HEIGHT_SCALE: f32 = 1.0;
