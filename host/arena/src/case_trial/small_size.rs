//! `small_size`: an attempt in a Small Size League's simulator, through cameras, host and radio, against
//! bodies that stand or a reactive team.
//!
//! Our robots are under `Gameplay`: they elect a coordinator, retrieve and play by themselves. Of the
//! opponents that play, one in its own defence area keeps the goal; the others play reactively. The referee
//! only starts the game; the judge looks at the true world. m, s; we are yellow and defend −x.

use brain::Approach;
use casebase::Case;
use geometry::{Field, Point, Pose};
use hil_sim::small_size::{Ball, PhysicsEvent};
use hil_sim::{Backend, NativeBackend, Region, TrialOutcome};
use host::Drill;
use host::strategy::Team;
use protocol::host::{Directive, RuleRole};
use protocol::quantized::WirePoint;
use protocol::team::{Closure, Decision};
use protocol::{RobotId, Who};
use rules::{Colour, FieldSpec};

use super::course::{Course, Moment};
use super::situation::{self, Bodies, Places};
use super::{Attempt, CaseTrial, Opposition, Tape};
use crate::cycles::{CycleEvent, CycleLog};
use crate::game::{Game, GameConfig, GameError, ManualReferee, NoWatcher, RefereeOrder, numbers};
use crate::recording::RecordedSample;

/// The team of the case.
const US: Colour = Colour::Yellow;
const THEM: Colour = Colour::Blue;

/// Plays an attempt, and keeps it on `tape`.
pub(super) fn attempt<'a>(
    case_trial: &CaseTrial<'a>,
    case: &Case<'a>,
    opposition: Opposition,
    seed: u64,
    mut tape: Option<&mut Tape>,
) -> Result<Attempt, GameError> {
    let field = case_trial.league.field();
    let bodies = Bodies { field, clear_of_ball: CLEAR_OF_BALL, apart: ROBOTS_APART_M };
    let places = situation::draw(case, &bodies, |_| whole(&field), seed);
    let config = config(case_trial, &places, opposition, seed);
    let backend: &mut dyn Backend<'a> = &mut NativeBackend::new(case_trial.base);
    let mut game = Game::new(&config, backend)?;
    let mut referee = ManualReferee::new(&game);
    place(&mut game, &places);
    // Cameras and radio first: robots and host must know each other.
    for team in [US, THEM] {
        game.drill(team, Some(Drill::new()));
    }
    for _ in 0..WARM_UP_TICKS {
        referee.speak(&mut game);
        game.advance(&mut NoWatcher)?;
    }
    place(&mut game, &places);
    referee.send(&game, RefereeOrder::Run);
    game.drill(US, Some(ours(&places, &field)));
    game.drill(THEM, Some(theirs(&places, &field, opposition)));
    let (began, mut course, mut log, mut verdict) =
        (game.time(), Course::default(), CycleLog::default(), None);
    loop {
        let time = (game.time() - began) as f32;
        for robot in numbers(places.attackers.len() as u8) {
            let state = game.host(US).beacon(robot).and_then(|beacon| beacon.cycle.as_ref());
            // A coordinator that has not yet received its teammates' beacons finds no case for itself alone.
            let alone = matches!(state, Some(state) if is_no_case(&state.decision)) && time < ACQUAINTED;
            let Some(state) = state.filter(|_| !alone) else { continue };
            let event = log.receive(time, state);
            if let Some(tape) = tape.as_deref_mut() {
                tape.story.extend(sentence(case_trial, &log, event, time));
            }
        }
        if let Some(tape) = tape.as_deref_mut() {
            tape.story.extend(game.events().iter().filter_map(|event| of_the_ball(event, time)));
            if tape.samples.last().is_none_or(|last| time - last.time >= SAMPLE_EVERY) {
                tape.samples.push(sample(&game, &places, time));
            }
        }
        verdict = verdict.or_else(|| Some((judge(&game, &field)?, time)));
        let taken = |event: &PhysicsEvent| matches!(event, PhysicsEvent::Touched { .. });
        let moment = Moment {
            time,
            cycles: log.cycles(),
            verdict,
            taken: game.events().iter().any(taken),
            still: game.world().ball.speed() < BALL_STILL_M_S,
        };
        if course.over(&moment, case) {
            let progress = game.world().ball.position.x() - places.ball.x();
            return Ok(course.attempt(&moment, case, &case_trial.names, progress));
        }
        referee.speak(&mut game);
        game.advance(&mut NoWatcher)?;
    }
}

/// Ball and robots as they are.
fn sample(game: &Game<'_>, places: &Places, time: f32) -> RecordedSample {
    let of = |colour, count: usize| (0..count as u8).map(move |number| Who { colour, id: id(number) });
    let robots = of(US, places.attackers.len()).chain(of(THEM, places.opponents.len()));
    let pose = |who| game.world().robot(who).map_or_else(Pose::default, |robot| robot.pose);
    let ball = game.world().ball.position;
    RecordedSample { time, ball, holder: None, robots: robots.map(pose).collect() }
}

fn config(case_trial: &CaseTrial<'_>, places: &Places, opposition: Opposition, seed: u64) -> GameConfig {
    let mut config = GameConfig::new(case_trial.league, seed, 0.0);
    config.referee.blue_on_positive_half = true;
    for team in &mut config.teams {
        let us = team.colour == US;
        team.robots = if us { places.attackers.len() } else { places.opponents.len() } as u8;
        team.settings = case_trial.settings.clone();
        team.plays = if us || opposition == Opposition::Playing { Team::Ours } else { Team::Idle };
        team.approach = if us { Approach::Cases } else { Approach::Reactive };
    }
    let keeper =
        (0..).zip(&places.attackers).find(|(_, pose)| in_own_area(pose.position, &case_trial.league.field()));
    if let Some((number, _)) = keeper {
        config.referee.team_mut(US).keeper = id(number);
    }
    let keeper =
        (0..).zip(&places.opponents).find(|(_, [_, at])| in_their_area(*at, &case_trial.league.field()));
    if let Some((number, _)) = keeper {
        config.referee.team_mut(THEM).keeper = id(number);
    }
    config
}

/// Robots and ball to their places, standing.
fn place(game: &mut Game<'_>, places: &Places) {
    for (number, pose) in (0..).zip(&places.attackers) {
        game.put_robot(Who { colour: US, id: id(number) }, *pose);
    }
    for (number, [_, at]) in (0..).zip(&places.opponents) {
        let heading = at.direction_to(places.ball);
        game.put_robot(Who { colour: THEM, id: id(number) }, Pose { position: *at, heading });
    }
    game.world_mut().put_ball(Ball::at(places.ball));
}

/// All of ours choose a case together; one that starts in our defence area is the keeper.
fn ours(places: &Places, field: &FieldSpec) -> Drill {
    let keeper = places.attackers.iter().position(|pose| in_own_area(pose.position, field));
    let role = |number: usize| if Some(number) == keeper { RuleRole::Keeper } else { RuleRole::Player };
    (0..places.attackers.len())
        .map(|number| (id(number as u8), role(number), Directive::Gameplay { hint: None }))
        .collect()
}

/// Opponents that stand, or one that keeps the goal from its defence area and the others reactive.
fn theirs(places: &Places, field: &FieldSpec, opposition: Opposition) -> Drill {
    let keeper = places.opponents.iter().position(|[_, at]| in_their_area(*at, field));
    let orders = (0..places.opponents.len()).map(|number| {
        let (role, directive) = match opposition {
            Opposition::Standing => (RuleRole::Player, Directive::Stand),
            Opposition::Playing if Some(number) == keeper => (RuleRole::Keeper, before_goal(field)),
            Opposition::Playing => (RuleRole::Player, Directive::Gameplay { hint: None }),
        };
        (id(number as u8), role, directive)
    });
    orders.collect()
}

/// The keeper's stretch before the attacked goal.
fn before_goal(field: &FieldSpec) -> Directive {
    let (x, y) = (0.5 * field.length - KEEPER_AHEAD, 0.5 * field.goal_width);
    let [from, to] = [-y, y].map(|y| WirePoint::from(Point::<Field>::new(x, y)));
    Directive::Block { from, to }
}

/// Goal, or out of the field anywhere else.
fn judge(game: &Game<'_>, field: &FieldSpec) -> Option<TrialOutcome> {
    let ball = game.world().ball.position;
    let beyond = game.world().parameters().ball.radius;
    let (length, width) = (0.5 * field.length + beyond, 0.5 * field.width + beyond);
    if ball.x() > length && ball.y().abs() < 0.5 * field.goal_width {
        return Some(TrialOutcome::Goal);
    }
    (ball.x().abs() > length || ball.y().abs() > width).then_some(TrialOutcome::Out)
}

fn in_own_area(at: Point<Field>, field: &FieldSpec) -> bool {
    in_their_area(Point::new(-at.x(), at.y()), field)
}

/// Within the attacked goal's defence area.
fn in_their_area(at: Point<Field>, field: &FieldSpec) -> bool {
    at.x() > 0.5 * field.length - field.penalty_depth && at.y().abs() < 0.5 * field.penalty_width
}

fn whole(field: &FieldSpec) -> Region {
    let (x, y) = (0.5 * field.length, 0.5 * field.width);
    Region { x: [-x, x], y: [-y, y] }
}

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap_or(RobotId::ZERO)
}

fn is_no_case(decision: &Decision) -> bool {
    matches!(decision, Decision::NoCase | Decision::Closed(Closure::NoCase))
}

/// A line of the story for a change of the cycles.
fn sentence(case_trial: &CaseTrial<'_>, log: &CycleLog, event: CycleEvent, time: f32) -> Option<String> {
    let text = match event {
        CycleEvent::Decided(i) => match &log.cycles().get(i)?.play {
            Some(play) => {
                let robots: Vec<_> = play.robots.iter().map(|id| id.number().to_string()).collect();
                format!("{} by {}", case_trial.names.of(play.case), robots.join(", "))
            }
            None => "no case fits".to_owned(),
        },
        CycleEvent::Ended(i) => log.cycles().get(i)?.end?.1.label().to_owned(),
        CycleEvent::Nothing | CycleEvent::Began(_) => return None,
    };
    Some(format!("{time:6.2} s  {text}"))
}

/// A line of the story for a touch or a kick.
fn of_the_ball(event: &PhysicsEvent, time: f32) -> Option<String> {
    let (robot, at, what) = match event {
        PhysicsEvent::Touched { robot, at } => (robot, at, "touches the ball".to_owned()),
        PhysicsEvent::Kicked { robot, at, speed, chip, .. } => {
            let verb = if *chip { "chips" } else { "kicks" };
            (robot, at, format!("{verb} with {speed:.1} m/s"))
        }
        _ => return None,
    };
    let (team, id) = (robot.colour.label(), robot.id);
    Some(format!("{time:6.2} s  {team} {id} {what} at ({:.2}, {:.2})", at.x(), at.y()))
}

/// Before an attempt: cameras' first frames, radio's handshake, and tracks that are sure.
const WARM_UP_TICKS: u32 = 80;
/// Time after which every robot has received all others' beacons under the new order, s: three periods.
const ACQUAINTED: f32 = 0.5;
/// An attempt is kept at this interval, s: smooth to look at.
const SAMPLE_EVERY: f32 = 0.0395;
/// Least distance of a robot from the ball at the start, m: at 0.112 they would touch.
const CLEAR_OF_BALL: f32 = 0.15;
/// Least distance between robots at the start, m: two radii and a gap.
const ROBOTS_APART_M: f32 = 0.22;
/// Distance of the opponents' keeper before its goal line, m: two bodies.
const KEEPER_AHEAD: f32 = 0.36;
/// A slower ball lies still, m/s.
const BALL_STILL_M_S: f32 = 0.02;
