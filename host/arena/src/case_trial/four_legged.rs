//! `four_legged`: an attempt in the four-legged league's simulator, against bodies that stand or the paper's
//! scripted opponents.
//!
//! The role of an opponent is that of the home region its scope's centre lies in, and it plays from there.
//! Where no role has its home (own half), it plays from a region of its own, as deep as the midfield's, about
//! its scope.

use brain::Approach;
use casebase::Case;
use geometry::{Field, Point, Vector};
use hil_sim::four_legged::world::WorldEvent;
use hil_sim::{
    Conduct, Configuration, Layout, NativeBackend, OpponentRole, Parameters, Placed, Region, Scenario,
    SimulationError, TrialOutcome, TrialVerdict,
};
use rules::League;

use super::course::{Course, Moment};
use super::situation::{self, Bodies};
use super::{Attempt, CaseTrial, Opposition, Tape};
use crate::recording::Recording;
use crate::story::TextLog;
use crate::trial::{Game, TrialConfig, Watcher};

/// Plays an attempt, and keeps it on `tape`.
pub(super) fn attempt<'a>(
    case_trial: &CaseTrial<'a>,
    case: &Case<'a>,
    opposition: Opposition,
    seed: u64,
    tape: Option<&mut Tape>,
) -> Result<Attempt, SimulationError> {
    let config = TrialConfig {
        layout: Some(layout(case, opposition, seed)),
        robots: case.teammates(),
        retrievers: case.teammates(),
        settings: case_trial.settings.clone(),
        // The referee detects goals at the goal line and catches by the goalie.
        ..TrialConfig::new(Scenario::Random, Configuration::DefenderGoalie, Approach::Cases, seed)
    }
    .with_library(case_trial.base, case_trial.names.clone());
    let (mut log, mut recording) = (TextLog::default(), Recording::default());
    let mut watchers: Vec<&mut dyn Watcher> = Vec::new();
    if tape.is_some() {
        watchers.extend([&mut log as &mut dyn Watcher, &mut recording]);
    }
    let mut game = Game::new(&config, Box::new(NativeBackend::new(case_trial.base)))?;
    let start = game.moment().world.ball.position;
    let mut course = Course::default();
    while !course.over(&moment(&game), case) {
        game.step(&mut watchers)?;
    }
    let progress = game.moment().world.ball.position.x() - start.x();
    let attempt = course.attempt(&moment(&game), case, &case_trial.names, progress);
    let last = TrialVerdict { outcome: TrialOutcome::Timeout, time: game.moment().tick.time };
    let verdict = game.moment().referee.verdict();
    game.end(verdict.unwrap_or(last), &mut watchers);
    if let Some(tape) = tape {
        *tape = Tape { story: log.take_lines(), samples: recording.samples };
    }
    Ok(attempt)
}

fn moment<'g>(game: &'g Game<'_, '_>) -> Moment<'g> {
    let moment = game.moment();
    Moment {
        time: moment.tick.time,
        cycles: moment.cycles.cycles(),
        verdict: moment.referee.verdict().map(|verdict| (verdict.outcome, verdict.time)),
        taken: moment.tick.events.iter().any(|(_, event)| matches!(event, WorldEvent::Grabbed { .. })),
        still: moment.world.ball.velocity == Vector::default(),
    }
}

/// A situation of `case`, with the opponents' conduct.
pub(super) fn layout(case: &Case<'_>, opposition: Opposition, seed: u64) -> Layout {
    let parameters = Parameters::four_legged();
    let field = League::FourLegged.field();
    let bodies = Bodies { field, clear_of_ball: CLEAR_OF_BALL, apart: ROBOTS_APART_M };
    let region = |authored| role_at(authored, parameters).1.unwrap_or_else(|| about(authored));
    let places = situation::draw(case, &bodies, region, seed);
    let opponents = places.opponents.iter().map(|[authored, at]| {
        let (role, home) = role_at(*authored, parameters);
        let conduct = match (opposition, home) {
            (Opposition::Standing, _) => Conduct::Standing,
            (Opposition::Playing, Some(_)) => Conduct::AtHome,
            (Opposition::Playing, None) => Conduct::Within(about(*authored)),
        };
        Placed { conduct, ..Placed::at_home(role, *at, places.ball) }
    });
    let opponents = opponents.collect();
    Layout { ball: places.ball, attackers: places.attackers, opponents }
}

/// The role of an opponent there, and its home if it is in it.
fn role_at(at: Point<Field>, parameters: &Parameters) -> (OpponentRole, Option<Region>) {
    let at_home = |role: &OpponentRole| role.home(parameters).contains(at);
    match [OpponentRole::Goalie, OpponentRole::Defender, OpponentRole::Midfield].into_iter().find(at_home) {
        Some(role) => (role, Some(role.home(parameters))),
        None if at.x() > 0.0 => (OpponentRole::Defender, None),
        None => (OpponentRole::Midfield, None),
    }
}

/// A region across the field about a place where no role has its home.
fn about(at: Point<Field>) -> Region {
    let field = League::FourLegged.field();
    let (length, width) = (field.length * 0.5, field.width * 0.5);
    let middle = at.x().clamp(HALF_DEPTH - length, length - HALF_DEPTH);
    Region { x: [middle - HALF_DEPTH, middle + HALF_DEPTH], y: [-width, width] }
}

/// Least distance of a robot from the ball at the start, m: at 0.1625 they would touch.
const CLEAR_OF_BALL: f32 = 0.18;
/// Least distance between robots at the start, m: two radii and a gap.
const ROBOTS_APART_M: f32 = 0.3;
/// Half of the midfield's depth, m (`hil-sim/data/four-legged.toml`).
const HALF_DEPTH: f32 = 0.75;
