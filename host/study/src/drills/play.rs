//! `play`: plays one try of a drill: everything is put in place in HALT, then play begins. Ours is a host
//! with six or eleven robots; theirs are bodies that the script moves.

use hil_sim::NativeBackend;
use hil_sim::small_size::referee::Restart;
use hil_sim::small_size::worlds::WorldChoice;
use hil_sim::small_size::{Ball, PhysicsEvent};
use host::strategy::Team;
use rules::Phase;
use rules::state::RefereeCommand;
use serde::Serialize;

use super::script::{Script, THEM, US, id, them};
use super::start::{DrillStart, OUR_END, Opening};
use super::{DrillKind, DrillRow};
use crate::matches::MatchTeam;
use arena::game::{Game, GameConfig, GameError, NoWatcher};
use geometry::{Pose, Vector};
use protocol::Who;

/// Who has the ball after ours have played it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NextTouch {
    /// None of ours played it, or nobody touched it after.
    #[default]
    None,
    /// Another of ours.
    Mate,
    /// One of theirs.
    Opponent,
    /// Play ended first: out, a goal, a foul.
    Over,
}

/// Plays try `number` of a drill from its start.
pub(super) fn play(
    drill: DrillKind,
    start: &DrillStart,
    (number, seed): (u32, u64),
    (team, world): (MatchTeam, WorldChoice),
) -> Result<DrillRow, GameError> {
    let mut config = GameConfig::new(start.league, seed, LASTS_MAX_S).between(Team::Ours, Team::Idle);
    config.world = world;
    config.referee.blue_on_positive_half = false;
    for setup in &mut config.teams {
        let ours = setup.colour == US;
        setup.robots = if ours { start.ours.len() as u8 } else { 0 };
        if ours {
            (setup.tactics, setup.approach) = (team.host_tactics(), team.approach());
        }
    }
    let mut row = DrillRow::new(drill, number, seed);
    let mut game = Game::new(&config, &mut NativeBackend::new(case_library::division_b()))?;
    while !game.command(RefereeCommand::Halt) {
        game.step(&mut NoWatcher)?;
        if game.time() > BEGINS_WITHIN_S {
            return Ok(row);
        }
    }
    place(&mut game, start);
    // The cameras see the ball before a robot stands over it.
    let lead = start.theirs[start.lead];
    let back = lead.position - Vector::polar(STANDS_BACK_M, lead.heading);
    game.put_robot(them(start.lead), Pose { position: back, ..lead });
    settle(&mut game, SETTLES_S)?;
    game.put_robot(them(start.lead), lead);
    settle(&mut game, COVERS_S)?;
    let mut script = Script::new(drill, start);
    let begun = match start.opening {
        Opening::OpenPlay => {
            game.world_mut().put_ball(start.ball);
            game.command(RefereeCommand::ForceStart)
        }
        Opening::OurFreeKick => game.restart(Restart::FreeKick(US), start.ball.position),
        Opening::TheirFreeKick => game.restart(Restart::FreeKick(THEM), start.ball.position),
    };
    if !begun || !until_in_play(&mut game, &mut script)? {
        return Ok(row);
    }
    row.played = true;
    watch(&mut game, &mut script, drill, &mut row)?;
    Ok(row)
}

fn settle(game: &mut Game<'_>, seconds: f64) -> Result<(), GameError> {
    let settled = game.time() + seconds;
    while game.time() < settled {
        game.step(&mut NoWatcher)?;
    }
    Ok(())
}

fn place(game: &mut Game<'_>, start: &DrillStart) {
    for (number, pose) in start.ours.iter().enumerate() {
        game.put_robot(Who { colour: US, id: id(number) }, *pose);
    }
    for (number, pose) in start.theirs.iter().enumerate() {
        game.put_robot(them(number), *pose);
    }
    game.world_mut().put_ball(Ball::at(start.ball.position));
}

/// One tick, with the script's orders.
fn step(game: &mut Game<'_>, script: &mut Script) -> Result<(), GameError> {
    let phase = game.referee().phase();
    let orders = match phase {
        Phase::Halt => Vec::new(),
        _ => script.orders(game.world(), phase),
    };
    for (who, order) in orders {
        game.world_mut().order(who, order);
    }
    game.step(&mut NoWatcher)
}

/// Until the ball is in play; false where a free kick was not taken in its time.
fn until_in_play(game: &mut Game<'_>, script: &mut Script) -> Result<bool, GameError> {
    let mut given = false;
    while game.time() < LASTS_MAX_S {
        match game.referee().phase() {
            Phase::Run => return Ok(true),
            Phase::FreeKick(_) => given = true,
            _ if given => return Ok(false),
            _ => {}
        }
        step(game, script)?;
    }
    Ok(false)
}

fn watch(
    game: &mut Game<'_>,
    script: &mut Script,
    drill: DrillKind,
    row: &mut DrillRow,
) -> Result<(), GameError> {
    let began = game.time();
    let ball_was = game.world().ball.position;
    let before = [US, THEM].map(|team| game.referee().accounts().of(team).score);
    let mut they_kicked = false;
    // The kicker of our free kick has played it before the ball was in play.
    let mut player =
        (drill == DrillKind::Marker).then(|| game.world().last_touch().map(|(who, _)| who)).flatten();
    while game.time() < began + drill.watched_s() && game.referee().phase() == Phase::Run {
        step(game, script)?;
        let time = game.time() - began;
        for event in game.events() {
            let who = match event {
                PhysicsEvent::Touched { robot, .. } | PhysicsEvent::Kicked { robot, .. } => *robot,
                _ => continue,
            };
            if who.colour == US {
                row.touched_s.get_or_insert(time);
            }
            row.shot_against |= is_shot_at_us(event, game);
            they_kicked |= who.colour == THEM && matches!(event, PhysicsEvent::Kicked { .. });
            match player {
                _ if row.next_touch != NextTouch::None => {}
                Some(ours) if who.colour == THEM && ours.colour == US => row.next_touch = NextTouch::Opponent,
                Some(ours) if who != ours => row.next_touch = NextTouch::Mate,
                // Pinball off a body is no pass: it counts as played once it is kicked.
                None if who.colour == US && matches!(event, PhysicsEvent::Kicked { .. }) => {
                    player = Some(who);
                }
                _ => {}
            }
        }
        if game.world().ball.position.distance(ball_was) > CLEARED_M {
            row.cleared_s.get_or_insert(time);
        }
    }
    let after = [US, THEM].map(|team| game.referee().accounts().of(team).score);
    (row.goal, row.goal_against) = (after[0] > before[0], after[1] > before[1]);
    let last_ours = game.world().last_touch().is_some_and(|(who, _)| who.colour == US);
    let referee = game.referee();
    let still_ours = match referee.phase() {
        Phase::Run => last_ours,
        _ => referee.next().and_then(Restart::team) == Some(US),
    };
    row.kept = row.goal || still_ours && !they_kicked;
    if row.next_touch == NextTouch::None && player.is_some() && game.referee().phase() != Phase::Run {
        row.next_touch = NextTouch::Over;
    }
    Ok(())
}

/// Whether it is a kick of theirs that goes at our goal.
fn is_shot_at_us(event: &PhysicsEvent, game: &Game<'_>) -> bool {
    let PhysicsEvent::Kicked { robot, at, velocity, .. } = *event else { return false };
    let field = game.world().pitch().field;
    let line = field.goal_line(OUR_END);
    let crosses = at.y() + velocity.y() * (line - at.x()) / velocity.x();
    robot.colour == THEM
        && velocity.x() < 0.0
        && velocity.norm() > SHOT_SPEED_MIN_M_S
        && crosses.abs() < 0.5 * field.goal_width + BESIDE_POST_M
}

/// A slower kick is no shot, m/s.
const SHOT_SPEED_MIN_M_S: f32 = 3.0;
/// A kick that misses a post by less is a shot, m.
const BESIDE_POST_M: f32 = 0.2;
/// The referee's first command comes within this time, s.
const BEGINS_WITHIN_S: f64 = 10.0;
/// Time in HALT until the host has seen where everything is, s: 30 frames of the cameras.
const SETTLES_S: f64 = 0.5;
/// Until then the opponent at the ball stands this far back, m; then for this time at the ball, s: 6 frames.
const STANDS_BACK_M: f32 = 0.25;
const COVERS_S: f64 = 0.1;
/// Longest try, with stop and free kick, s.
const LASTS_MAX_S: f64 = 60.0;
/// A ball this far from where it lay has been cleared, m.
const CLEARED_M: f32 = 0.5;
