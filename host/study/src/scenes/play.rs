//! `play`: plays one scene: everything is put in place in HALT, then play begins.

use hil_sim::NativeBackend;
use hil_sim::small_size::Ball;
use hil_sim::small_size::referee::Restart;
use rules::state::RefereeCommand;
use rules::{Colour, Phase};
use serde::Serialize;

use super::{SCENE_S, SceneKind, SceneStart, US};
use arena::game::{Game, GameConfig, GameError, NoWatcher};

/// Outcome of a scene within [`SCENE_S`], or until the referee stopped play.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SceneOutcome {
    /// The ball came into play: free kicks that nobody takes do not.
    pub played: bool,
    /// A shot of ours at the goal.
    pub shot: bool,
    /// A goal of ours.
    pub goal: bool,
    /// A shot of theirs at our goal.
    pub shot_against: bool,
    /// A goal of theirs.
    pub goal_against: bool,
    /// Our pass of the Coerce and Attack Planner left.
    pub planned: bool,
}

pub(super) fn play(
    config: &GameConfig,
    kind: SceneKind,
    start: &SceneStart,
) -> Result<SceneOutcome, GameError> {
    let mut game = Game::new(config, &mut NativeBackend::new(case_library::division_b()))?;
    // The referee obeys once it has begun.
    while !game.command(RefereeCommand::Halt) {
        game.step(&mut NoWatcher)?;
        if game.time() > BEGINS_WITHIN_S {
            return Ok(SceneOutcome::default());
        }
    }
    for (who, pose) in &start.robots {
        game.put_robot(*who, *pose);
    }
    game.put_ball(Ball::at(start.ball));
    let settled = game.time() + SETTLES_S;
    while game.time() < settled {
        game.step(&mut NoWatcher)?;
    }
    // A shot straight from a free kick counts: it leaves before the ball is in play.
    let before = Tally::of(&game);
    let begun = match kind {
        SceneKind::OpenPlay => {
            game.put_ball(start.ball());
            game.command(RefereeCommand::ForceStart)
        }
        SceneKind::FreeKick => game.restart(Restart::FreeKick(US), start.ball),
    };
    if !begun {
        return Ok(SceneOutcome::default());
    }
    until_in_play(&mut game, config.duration_s)?;
    if game.referee().phase() != Phase::Run {
        return Ok(SceneOutcome::default());
    }
    watch(&mut game, before)
}

/// Until the ball is in play: a free kick of ours is taken, or lost to the time limit.
fn until_in_play(game: &mut Game<'_>, last: f64) -> Result<(), GameError> {
    let mut ours = false;
    while game.time() < last {
        match game.referee().phase() {
            Phase::Run => return Ok(()),
            Phase::FreeKick(US) => ours = true,
            // Over without a kick.
            _ if ours => return Ok(()),
            _ => {}
        }
        game.step(&mut NoWatcher)?;
    }
    Ok(())
}

fn watch(game: &mut Game<'_>, before: Tally) -> Result<SceneOutcome, GameError> {
    let until = game.time() + SCENE_S;
    while game.time() < until && game.referee().phase() == Phase::Run {
        game.step(&mut NoWatcher)?;
    }
    let after = Tally::of(game);
    Ok(SceneOutcome {
        played: true,
        shot: after.shots[0] > before.shots[0],
        goal: after.goals[0] > before.goals[0],
        shot_against: after.shots[1] > before.shots[1],
        goal_against: after.goals[1] > before.goals[1],
        planned: after.planned > before.planned,
    })
}

/// Shots and goals so far, ours first.
#[derive(Clone, Copy)]
struct Tally {
    shots: [u32; 2],
    goals: [u32; 2],
    planned: u32,
}

impl Tally {
    fn of(game: &Game<'_>) -> Self {
        let teams = [US, Colour::Yellow];
        let shots = |team: Colour| game.ledger().attack().of(team).shots.all();
        Self {
            shots: teams.map(shots),
            goals: teams.map(|team| game.referee().accounts().of(team).score),
            planned: game.host(US).counters().cap.attempts,
        }
    }
}

/// The referee's first command comes within this time, s.
const BEGINS_WITHIN_S: f64 = 10.0;
/// Time in HALT until both hosts have seen where everything is, s: 30 frames of the cameras.
const SETTLES_S: f64 = 0.5;
