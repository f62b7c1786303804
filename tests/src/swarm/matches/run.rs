//! `run`: plays a match of a plan and checks it every 10 ms. s, m, field frame.

use std::fmt::Write as _;

use arena::game::{Game, GameConfig, TICK_US, Watcher};
use geometry::{Field, GoalEnd, Point};
use hil_sim::NativeBackend;
use hil_sim::small_size::Ball;
use hil_sim::small_size::referee::{Card, Kind, MatchClock, Restart};
use host::strategy::{Flip, Task};
use protocol::{Duration, Who};
use rules::state::RefereeCommand;
use rules::{Colour, FieldSpec, Phase, Side, limits};

use super::frozen::{Must, Stands};
use super::keep_out::{KeepOuts, Moment};
use super::plan::{Act, Plan};
use super::{Broken, Found, Outcome};

/// Maximum time that the match may stand, s: division A is 12 m long, and 1.5 m/s the speed of STOP; twice
/// that with a detour around others.
pub const BLOCKED_LONGEST: f32 = 20.0;
/// Distance to its target above which a robot has to move, m (required bound).
const SENT: f32 = 0.1;
/// Speed above which a robot moves, m/s, in HALT for longer than [`PUSHED`].
const STANDS: f32 = 0.05;
/// Time in which a robot that others push rolls out, s.
const PUSHED: f32 = 0.1;
/// Distance within 10 ms above which an object was moved by hand, m: 10 m/s.
const CARRIED: f32 = 0.1;
/// Maximum number of findings kept per match.
const MOST: usize = 40;

/// The settings of a plan's match.
pub fn config(plan: &Plan) -> GameConfig {
    let mut config = GameConfig::new(plan.league, plan.seed, f64::from(plan.length) / 1000.0);
    if !plan.half_time {
        config.referee.clock = MatchClock::Playing { half: Duration::millis(300_000) };
    }
    config
}

/// Plays it; `watcher` sees every tick.
pub fn play(plan: &Plan, watcher: &mut dyn Watcher) -> Outcome {
    let config = config(plan);
    let mut backend = NativeBackend::new(host::cases_of(plan.league));
    let mut game = match Game::new(&config, &mut backend) {
        Ok(game) => game,
        Err(error) => return ended(error.to_string()),
    };
    let mut watch = Watch::new(plan);
    let mut acts = plan.acts.iter().peekable();
    for tick in 0..plan.length / (TICK_US / 1000) as u32 {
        let ms = tick * (TICK_US / 1000) as u32;
        while let Some((_, act)) = acts.next_if(|(at, _)| *at <= ms) {
            let carried = matches!(act, Act::Ball(_) | Act::Roll(..));
            if perform(&mut game, *act) {
                watch.outcome.acts += 1;
                watch.ball_carried |= carried;
            }
        }
        if let Err(error) = game.step(watcher) {
            return ended(error.to_string());
        }
        if game.is_over() {
            break;
        }
        watch.look(&game);
    }
    watch.end(&game)
}

fn ended(error: String) -> Outcome {
    let found = Found { ms: 0, phase: Phase::Halt, broken: Broken::Ended(error) };
    Outcome { found: vec![found], ..Outcome::default() }
}

/// Carries out a manual act; whether it was valid now.
fn perform(game: &mut Game<'_>, act: Act) -> bool {
    let origin = Point::new(0.0, 0.0);
    match act {
        Act::Yellow(team, ms) => {
            game.card(team, Card::Yellow(Duration::millis(u64::from(ms))));
            true
        }
        Act::Red(team) => {
            game.card(team, Card::Red);
            true
        }
        Act::Keeper(team, robot) => {
            let who = Who { colour: team, id: robot };
            let here = game.world().robot(who).is_some_and(|robot| robot.present);
            // A keeper may be changed while the ball is out of play or in the opponents' half (choosing
            // keeper id): not in a penalty.
            let penalty = matches!(game.referee().phase(), Phase::Penalty(_));
            here && !penalty && game.change_keeper(team, robot)
        }
        Act::Penalty(team) => game.restart(Restart::Penalty(team), origin),
        Act::Kickoff(team) => game.restart(Restart::Kickoff(team), origin),
        Act::FreeKick(team, at) => game.restart(Restart::FreeKick(team), at),
        Act::ForceStart(at) => game.restart(Restart::ForceStart, at),
        Act::Halt => !game.referee().stage().is_break() && game.command(RefereeCommand::Halt),
        Act::Stop => !game.referee().stage().is_break() && game.command(RefereeCommand::Stop),
        Act::GoOn => {
            game.go_on();
            true
        }
        Act::Timeout(team, ms) => game.request_timeout(team, Duration::millis(u64::from(ms))),
        Act::Ball(at) => {
            game.put_ball(Ball::at(at));
            true
        }
        Act::Roll(at, velocity) => {
            game.put_ball(Ball::rolling(at, velocity));
            true
        }
    }
}

struct Watch {
    outcome: Outcome,
    field: FieldSpec,
    phase: Phase<Colour>,
    phase_since: f32,
    keepers: [Who; 2],
    /// Time of the last change of phase, keeper or the ball's position by hand, s.
    changed: f32,
    ball_carried: bool,
    ball: Point<Field>,
    /// Position of the ball at the start of the phase.
    ball_then: Point<Field>,
    keep_outs: KeepOuts,
    stands: Stands,
    /// Since when each robot moves in HALT or is too fast in STOP, s.
    moves: std::collections::BTreeMap<Who, (f32, bool)>,
    places: std::collections::BTreeMap<Who, Point<Field>>,
    blocks_reported: usize,
    events: usize,
}

impl Watch {
    fn new(plan: &Plan) -> Self {
        let keeper_0 = |colour| Who { colour, id: first() };
        Self {
            outcome: Outcome::default(),
            field: plan.league.field(),
            phase: Phase::Halt,
            phase_since: 0.0,
            keepers: [keeper_0(Colour::Yellow), keeper_0(Colour::Blue)],
            changed: 0.0,
            ball_carried: false,
            ball: Point::default(),
            ball_then: Point::default(),
            keep_outs: KeepOuts::default(),
            stands: Stands::default(),
            moves: std::collections::BTreeMap::new(),
            places: std::collections::BTreeMap::new(),
            blocks_reported: 0,
            events: 0,
        }
    }

    fn find(&mut self, time: f32, broken: Broken) {
        if self.outcome.found.len() < MOST {
            let found = Found { ms: (time * 1000.0).round() as u32, phase: self.phase, broken };
            self.outcome.found.push(found);
        }
    }

    fn look(&mut self, game: &Game<'_>) {
        let (referee, world) = (game.referee(), game.world());
        let time = game.time() as f32;
        let ball = world.ball.position;
        let accounts = referee.accounts();
        let keepers =
            [Colour::Yellow, Colour::Blue].map(|team| Who { colour: team, id: accounts.of(team).keeper });
        let jumped = self.ball.distance(ball) > CARRIED;
        if referee.phase() != self.phase {
            (self.phase, self.phase_since, self.ball_then) = (referee.phase(), time, ball);
            self.changed = time;
            self.moves.clear();
            self.count_phase();
        }
        if keepers != self.keepers || jumped || self.ball_carried {
            self.changed = time;
        }
        (self.keepers, self.ball, self.ball_carried) = (keepers, ball, false);
        self.count_events(game);
        if referee.stage().is_break() {
            return;
        }
        let present = || world.robots().iter().filter(|robot| robot.present);
        let robots: Vec<(Who, Point<Field>)> =
            present().map(|robot| (robot.who, robot.pose.position)).collect();
        // A robot that was placed by hand is where it was placed.
        let carried = robots.iter().any(|(who, at)| {
            self.places.insert(*who, *at).is_some_and(|before| before.distance(*at) > CARRIED)
        });
        if carried {
            self.changed = time;
        }
        let own = [Colour::Yellow, Colour::Blue].map(|team| referee.own_end(team));
        let field = self.field;
        let moment = Moment {
            time,
            field: &field,
            phase: self.phase,
            ball,
            ball_speed: world.ball.speed(),
            placement: referee.placement(),
            in_play: ball.distance(self.ball_then) > limits::IN_PLAY_DISTANCE,
            keepers: self.keepers,
            own,
            changed: self.changed,
        };
        let offenders = moment.offenders(&robots);
        for broken in self.keep_outs.look(&moment, &robots) {
            self.find(time, Broken::KeepOut(broken));
        }
        for (who, speed) in present().map(|robot| (robot.who, robot.velocity.norm())).collect::<Vec<_>>() {
            self.look_at_speed(time, who, speed);
        }
        let must: Vec<_> = robots
            .iter()
            .map(|&(who, at)| {
                let leaves = offenders.iter().any(|one| one.who == who);
                (who, at, self.must(game, &moment, who, at, leaves))
            })
            .collect();
        for frozen in self.stands.look(time, &must) {
            let order = order_text(game, own, frozen.who);
            self.find(time, Broken::Frozen(frozen, order));
        }
        self.look_at_blocks(time, game);
    }

    /// The reason for which that robot has to move, if any.
    fn must(
        &self,
        game: &Game<'_>,
        moment: &Moment<'_>,
        who: Who,
        at: Point<Field>,
        leaves: bool,
    ) -> Option<Must> {
        if matches!(self.phase, Phase::Halt | Phase::Timeout(_)) {
            return None;
        }
        if leaves {
            return Some(Must::Leave);
        }
        if game.referee().blocked().is_some_and(|blocked| blocked.obstacle.who() == Some(who)) {
            return Some(Must::MakeWay);
        }
        let order = game.host(who.colour).orders().iter().find(|order| order.robot == who.id)?;
        let flip = Flip::defending(moment.own[who.colour as usize]);
        let ours = |phase: Phase<Side>| {
            matches!(
                phase,
                Phase::Kickoff(Side::Ours) | Phase::Penalty(Side::Ours) | Phase::FreeKick(Side::Ours)
            )
        };
        let phase = self.phase.seen_by(who.colour);
        let to_ball = at.distance(self.ball);
        match order.task {
            Task::GoTo { at: target, .. } => {
                let target = flip.to_field(target);
                let away = target.distance(at);
                (away > SENT).then_some(Must::GoTo(away))
            }
            Task::PlaceBall { .. } if phase == Phase::BallPlacement(Side::Ours) => Some(Must::Play(to_ball)),
            Task::Kick { .. } | Task::Pass { ready: true, .. } if ours(phase) => Some(Must::Play(to_ball)),
            _ => None,
        }
    }

    fn look_at_speed(&mut self, time: f32, who: Who, speed: f32) {
        let limit = match self.phase {
            Phase::Halt => STANDS,
            Phase::Stop => limits::STOP_SPEED,
            _ => return,
        };
        if time - self.phase_since <= limits::GRACE || speed <= limit {
            self.moves.remove(&who);
            return;
        }
        let (since, reported) = self.moves.entry(who).or_insert((time, false));
        if time - *since < PUSHED || *reported {
            return;
        }
        *reported = true;
        let stop = self.phase == Phase::Stop;
        self.find(time, if stop { Broken::FastInStop(who, speed) } else { Broken::MovedInHalt(who, speed) });
    }

    fn look_at_blocks(&mut self, time: f32, game: &Game<'_>) {
        let blocks = &game.referee().metrics().blocks;
        let last = blocks.last().filter(|block| block.lasted.as_secs_f32() > BLOCKED_LONGEST);
        if let Some(block) = last.filter(|_| self.blocks_reported < blocks.len()) {
            self.blocks_reported = blocks.len();
            self.find(time, Broken::Blocked(block.obstacle));
        }
    }

    fn count_phase(&mut self) {
        let index = match self.phase {
            Phase::Penalty(_) => 0,
            Phase::Kickoff(_) => 1,
            Phase::FreeKick(_) => 2,
            _ => return,
        };
        self.outcome.begun[index] += 1;
    }

    fn count_events(&mut self, game: &Game<'_>) {
        let events = game.referee().events();
        for event in events.iter().skip(self.events) {
            match event.what.kind() {
                Kind::PlacementSucceeded => self.outcome.begun[3] += 1,
                Kind::PlacementFailed => self.outcome.begun[4] += 1,
                _ => {}
            }
        }
        self.events = events.len();
    }

    fn end(mut self, game: &Game<'_>) -> Outcome {
        let metrics = game.referee().metrics();
        self.outcome.running_s = metrics.running_s;
        self.outcome.blocked_s = metrics.blocked_s();
        self.outcome.taken_off = metrics.taken_off;
        self.outcome.trace = game.trace().digits();
        self.outcome
    }
}

/// The order of a robot's host, and the robot nearest to it.
fn order_text(game: &Game<'_>, own: [GoalEnd; 2], who: Who) -> String {
    let order = game.host(who.colour).orders().iter().find(|order| order.robot == who.id);
    let flip = Flip::defending(own[who.colour as usize]);
    let mut text = order.map_or_else(
        || "no order".to_owned(),
        |order| format!("{:?} {:?}", order.role, order.task.directive(flip)),
    );
    let at = |who| game.world().robot(who).map(|robot| robot.pose.position);
    let others = game.world().robots().iter().filter(|robot| robot.present && robot.who != who);
    let near = others.filter_map(|robot| Some((robot.who, robot.pose.position.distance(at(who)?))));
    if let Some((next, distance)) = near.min_by(|a, b| a.1.total_cmp(&b.1)) {
        let _ = write!(text, "; {} {} is {distance:.2} m away", next.colour.label(), next.id);
    }
    text
}

const fn first() -> protocol::RobotId {
    match protocol::RobotId::new(0) {
        Some(id) => id,
        None => unreachable!(),
    }
}
