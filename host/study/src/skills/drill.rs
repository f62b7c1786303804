//! `drill`: one try through the whole loop. A start, a referee with one command, orders by hand or by the
//! coach, and a judge of the true world. SI units, field frame; our team is yellow and defends −x.

use geometry::{Angle, Field, Point, Pose, Segment};
use hil_sim::small_size::{Ball, PhysicsEvent, Robot, World};
use hil_sim::{Backend, Fnv};
use host::Drill as Orders;
use host::strategy::Team;
use protocol::host::{Directive, RuleRole};
use protocol::{RobotId, Who};
use rules::{Colour, League};

use super::{Skill, Try, TryResult, catches, kicks, placement, save, story};
pub(super) use arena::game::RefereeOrder;
use arena::game::{Game, GameConfig, GameError, ManualReferee, NoWatcher};

pub(super) const US: Colour = Colour::Yellow;

#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) description: String,
    pub(super) ours: Vec<(u8, Pose<Field>)>,
    /// Opponents, who stand.
    pub(super) theirs: Vec<Pose<Field>>,
    pub(super) ball: Ball,
    /// Path of the ball: nothing else stands there.
    pub(super) path: Option<Segment<Field>>,
    /// The first command of the referee.
    pub(super) referee_order: RefereeOrder,
    /// Time after which the try has failed, s.
    pub(super) limit: f32,
}

impl Start {
    /// One of our robots and a ball in running play.
    pub(super) fn of(description: String, (number, pose): (u8, Pose<Field>), ball: Ball, limit: f32) -> Self {
        Self {
            description,
            ours: vec![(number, pose)],
            theirs: Vec::new(),
            ball,
            path: None,
            referee_order: RefereeOrder::Run,
            limit,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum State {
    /// Undecided.
    Going,
    /// Time until it succeeded, s.
    Succeeded(f32),
    /// Failed, with what was wrong.
    Failed(String),
}

pub(super) struct Moment<'g> {
    /// Time since the beginning, s.
    pub(super) time: f32,
    pub(super) world: &'g World,
    /// Physical events of the last 10 ms.
    pub(super) events: &'g [PhysicsEvent],
}

impl Moment<'_> {
    /// One of ours; those of a start are always there.
    pub(super) fn ours(&self, number: u8) -> Option<&Robot> {
        self.world.robot(Who { colour: US, id: id(number) })
    }

    /// The ball lies before a robot's dribbler: this gap, m, and beside the middle, m.
    pub(super) fn at_dribbler(&self, number: u8) -> Option<[f32; 2]> {
        let robot = self.ours(number)?;
        let seen = robot.pose.to_body(self.world.ball.position);
        Some([seen.x() - robot.body.front - self.world.parameters().ball.radius, seen.y()])
    }

    /// A robot has the ball at its dribbler.
    pub(super) fn has(&self, number: u8) -> bool {
        self.at_dribbler(number)
            .is_some_and(|[gap, beside]| gap.abs() < HAS_WITHIN_M && beside.abs() < HAS_BESIDE_M)
            && self.world.ball.height < HAS_WITHIN_M
    }
}

pub(super) trait Judge {
    /// Orders to our robots; `None`: the coach gives them.
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        None
    }
    fn judge(&mut self, moment: &Moment<'_>) -> State;
    /// Describes what is missing when time is up.
    fn lacks(&self, moment: &Moment<'_>) -> String;
    /// Changes the world from outside, and returns the next command of the referee.
    fn happens(&mut self, _time: f32, _world: &mut World) -> Option<RefereeOrder> {
        None
    }
}

/// The number of a robot; numbers of starts are below 16.
pub(super) fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap_or(RobotId::ZERO)
}

/// Random stream of a try: seed, skill and number, the same in every world.
fn seed_of(tried: &Try) -> u64 {
    let mut hash = Fnv::default();
    hash.add(&tried.seed.to_le_bytes());
    hash.add(tried.skill.label().as_bytes());
    hash.add(&tried.number.to_le_bytes());
    hash.value()
}

fn judged(tried: &Try, seed: u64) -> (Start, Box<dyn Judge>) {
    fn boxed((start, judge): (Start, impl Judge + 'static)) -> (Start, Box<dyn Judge>) {
        (start, Box::new(judge))
    }
    let (league, number) = (tried.league, tried.number);
    match tried.skill {
        Skill::Placement => boxed(placement::Placement::new(league, number, seed)),
        Skill::GetBall => boxed(catches::GetBall::new(league, number, seed)),
        Skill::Receive => boxed(catches::Receive::new(league, seed)),
        Skill::Dribble => boxed(catches::Dribble::new(league, seed)),
        Skill::TurnWithBall => boxed(catches::Turn::new(league, seed)),
        Skill::Kick => boxed(kicks::Kick::flat(league, seed)),
        Skill::Chip => boxed(kicks::Kick::chip(league, seed)),
        Skill::Save => boxed(save::Save::new(league, seed)),
    }
}

/// A game with our robots only; theirs are bodies that stand.
fn config(tried: &Try, seed: u64, robots: u8) -> GameConfig {
    let mut config = GameConfig::new(tried.league, seed, 60.0);
    config.world = tried.world;
    config.referee.blue_on_positive_half = true;
    for team in &mut config.teams {
        let ours = team.colour == US;
        team.robots = if ours { robots } else { 0 };
        team.plays = if ours { Team::Ours } else { Team::Idle };
    }
    config
}

pub(super) fn play(
    tried: Try,
    backend: &mut dyn Backend<'_>,
    lines: &mut Vec<String>,
) -> Result<TryResult, GameError> {
    let seed = seed_of(&tried);
    let (start, mut judge) = judged(&tried, seed);
    let robots = start.ours.iter().map(|(number, _)| number + 1).max().unwrap_or(1);
    let mut game = Game::new(&config(&tried, seed, robots), backend)?;
    place(&mut game, &start, robots);
    let mut referee = ManualReferee::new(&game);
    // Cameras and radio first: robots and host must know each other.
    game.drill(US, Some(Orders::new()));
    for _ in 0..WARM_UP_TICKS {
        referee.speak(&mut game);
        game.advance(&mut NoWatcher)?;
    }
    place(&mut game, &start, robots);
    game.world_mut().put_ball(start.ball);
    referee.send(&game, start.referee_order);
    let began = game.time();
    let end = loop {
        let time = (game.time() - began) as f32;
        if let Some(referee_order) = judge.happens(time, game.world_mut()) {
            referee.send(&game, referee_order);
        }
        let moment = Moment { time, world: game.world(), events: game.events() };
        match judge.judge(&moment) {
            State::Going if time > start.limit => break Err(judge.lacks(&moment)),
            State::Going => {}
            State::Succeeded(after) => break Ok(after),
            State::Failed(description) => break Err(description),
        }
        let orders = judge.orders(&moment).map(|orders| {
            orders
                .into_iter()
                .map(|(number, rule_role, directive)| (id(number), rule_role, directive))
                .collect()
        });
        story::note_events(lines, time, &game);
        game.drill(US, orders);
        referee.speak(&mut game);
        game.advance(&mut NoWatcher)?;
    };
    Ok(TryResult { tried, start: start.description, end })
}

/// Everybody and the ball to their places.
fn place(game: &mut Game<'_>, start: &Start, robots: u8) {
    let world = game.world_mut();
    for number in 0..robots {
        let who = Who { colour: US, id: id(number) };
        match start.ours.iter().find(|(placed, _)| *placed == number) {
            Some((_, pose)) => {
                world.put(who, *pose);
            }
            None => world.remove(who),
        }
    }
    for (number, pose) in (0..).zip(&start.theirs) {
        world.put(Who { colour: US.other(), id: id(number) }, *pose);
    }
    world.put_ball(Ball::at(start.ball.position));
    // Bystanders of the world stand where they like, but for where the try takes place.
    let mut needed: Vec<Point<Field>> = start.ours.iter().map(|(_, pose)| pose.position).collect();
    needed.extend(start.theirs.iter().map(|pose| pose.position));
    needed.push(start.ball.position);
    if let RefereeOrder::Place(at) = start.referee_order {
        needed.push(at);
    }
    let bystanders = world.robots().iter().filter(|robot| {
        let placed = if robot.who.colour == US { usize::from(robots) } else { start.theirs.len() };
        robot.present && usize::from(robot.who.id.number()) >= placed
    });
    let in_the_way = bystanders.filter(|robot| {
        let at = robot.pose.position;
        needed.iter().any(|place| place.distance(at) < BYSTANDERS_OFF_M)
            || start.path.is_some_and(|path| path.distance_to(at) < BYSTANDERS_OFF_M)
    });
    let removed: Vec<Who> = in_the_way.map(|robot| robot.who).collect();
    for who in removed {
        world.remove(who);
    }
}

/// A pose of metres and an angle.
pub(super) fn pose(at: Point<Field>, heading: Angle) -> Pose<Field> {
    Pose { position: at, heading }
}

pub(super) fn player(number: u8, directive: Directive) -> Vec<(u8, RuleRole, Directive)> {
    vec![(number, RuleRole::Player, directive)]
}

pub(super) fn team_size(league: League) -> u8 {
    if league == League::DivisionA { 11 } else { 6 }
}

/// Before a try: cameras' first frames, radio's handshake, and tracks that are sure.
const WARM_UP_TICKS: u32 = 80;
/// Bystanders keep this far from where a try starts, m: room for a body to pass.
const BYSTANDERS_OFF_M: f32 = 0.4;
/// Ball and dribbler this near, m: as far as a break-beam sensor sees, and a little.
const HAS_WITHIN_M: f32 = 0.025;
/// Beside the middle of the front, m: a dribbler's half width and a little.
const HAS_BESIDE_M: f32 = 0.045;
