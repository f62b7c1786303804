//! `map`: maps of ball and passes of a cell. The first trials of a cell played again and watched: they are
//! the same trials.

mod draw;

use arena::{Moment, Profile, TrialConfig, TrialReport, Watcher, run};
use geometry::{Field, Point};
use hil_sim::four_legged::world::{LeggedWorld, WorldEvent};
use hil_sim::{Layout, NativeBackend, Scenario, SimulationError, TICK_US, TrialOutcome};
use protocol::robot_io::LeggedKick;
use rayon::prelude::*;
use study::evaluation::{Evaluation, EvaluationCell};
use study::store::Shard;

pub(crate) use draw::{CHANCE_PASS_COLOR, LOST_PASS_COLOR, SHADES, html, sheets};

/// The error of a map whose trial could not be played again.
pub type MapError = SimulationError;

/// The ball and the passes of a cell's first trials.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The cell whose trials are mapped.
    pub cell: EvaluationCell,
    /// Number of its trials.
    pub trials: u32,
    /// The field they were played on.
    pub field: casebase::FieldMm,
    /// Seconds of the ball in each square of [`SQUARE_MM`], row by row from the least y, each from the least
    /// x; all trials together.
    pub seconds: Vec<f64>,
    /// Passes of the attackers, all trials together.
    pub passes: Vec<Pass>,
    /// Places of the robots at kick-off; `None` where each trial has its own layout.
    pub start: Option<Layout>,
    /// Place of the ball at the end of each trial, and the outcome.
    pub ends: Vec<(Point<Field>, TrialOutcome)>,
}

/// A ball that one attacker intended for another, or that another one received.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Place of the kick, m, field frame.
    pub from: Point<Field>,
    /// End: where it was received or lost.
    pub to: Point<Field>,
    /// Outcome of the pass.
    pub kind: PassKind,
}

/// Result of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassKind {
    /// Intended for a teammate, and received by it.
    Completed,
    /// Intended for a teammate, and received by another robot, or by none.
    Lost,
    /// A kick ahead that a teammate received: the only passes reactive attackers have (paper §5).
    Chance,
}

impl Map {
    /// Squares along the field.
    pub fn columns(&self) -> usize {
        squares(self.field.length)
    }

    /// Number of squares across the field, along y.
    pub fn rows(&self) -> usize {
        squares(self.field.width)
    }

    fn empty(cell: EvaluationCell, field: casebase::FieldMm) -> Self {
        let (seconds, passes, ends) = (Vec::new(), Vec::new(), Vec::new());
        let mut map = Self { cell, trials: 0, field, seconds, passes, start: None, ends };
        map.seconds = vec![0.0; map.columns() * map.rows()];
        map
    }

    fn add(&mut self, mapper: Mapper) {
        self.trials += 1;
        for place in mapper.balls {
            if let Some(square) = self.square(place) {
                self.seconds[square] += f64::from(TICK_US as u32) * 1e-6;
            }
        }
        self.passes.extend(mapper.passes);
        self.ends.extend(mapper.end);
    }

    /// The square of a place; `None` beside the field.
    fn square(&self, place: Point<Field>) -> Option<usize> {
        let along = |value: f32, side: i32, squares: usize| {
            let mm = f64::from(value) * 1000.0 + f64::from(side) * 0.5;
            let square = (mm / SQUARE_MM).floor();
            (square >= 0.0 && square < squares as f64).then_some(square as usize)
        };
        let column = along(place.x(), self.field.length, self.columns())?;
        let row = along(place.y(), self.field.width, self.rows())?;
        Some(row * self.columns() + column)
    }

    /// The maps of an evaluation's simulated cells: the first `trials` of each, played again on all threads
    /// of the pool.
    pub fn of(evaluation: &Evaluation<'_>, trials: u32) -> Result<Vec<Self>, MapError> {
        let plan = &evaluation.plan;
        let cells = plan.cells.iter().filter(|cell| cell.profile == Profile::Simulated);
        let maps = cells.map(|cell| {
            let own = plan.shard(Shard::WHOLE).filter(|planned| planned.cell == *cell);
            let configs: Vec<_> =
                own.take(trials as usize).map(|planned| evaluation.config(&planned)).collect();
            Self::play(*cell, evaluation.base.field(), &configs)
        });
        maps.collect()
    }

    /// The map of these trials, which are of one cell.
    pub fn play(
        cell: EvaluationCell,
        field: casebase::FieldMm,
        configs: &[TrialConfig<'_>],
    ) -> Result<Self, MapError> {
        let watched: Result<Vec<Mapper>, _> = configs
            .par_iter()
            .map(|config| {
                let mut mapper = Mapper::default();
                run(config, Box::new(NativeBackend::new(config.base)), &mut [&mut mapper]).map(|_| mapper)
            })
            .collect();
        let mut map = Self::empty(cell, field);
        let same = configs.first().filter(|config| config.scenario != Scenario::Random);
        map.start = same.map(|config| {
            let mut layout = config.simulation().layout;
            // A scenario has places for larger teams too.
            layout.attackers.truncate(config.robots);
            layout
        });
        watched?.into_iter().for_each(|mapper| map.add(mapper));
        Ok(map)
    }
}

/// Watches a trial for its map.
#[derive(Clone, Debug, Default)]
pub struct Mapper {
    balls: Vec<Point<Field>>,
    passes: Vec<Pass>,
    end: Option<(Point<Field>, TrialOutcome)>,
    flying: Option<Flight>,
}

/// A ball that an attacker has kicked and no robot has received yet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flight {
    by: usize,
    from: Point<Field>,
    /// Intended as a pass.
    pass: bool,
}

impl Mapper {
    /// The passes so far.
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    fn event(&mut self, world: &LeggedWorld, attackers: usize, event: &WorldEvent) {
        let ball = world.ball.position;
        match *event {
            WorldEvent::Grabbed { robot } => self.got(robot, attackers, ball),
            WorldEvent::Kicked { robot, kick, from, .. } => {
                self.got(robot, attackers, from);
                let pass = matches!(kick, LeggedKick::Pass(_));
                self.flying = (robot < attackers).then_some(Flight { by: robot, from, pass });
            }
            WorldEvent::Touched { .. }
            | WorldEvent::GrabFailed { .. }
            | WorldEvent::KickedNothing { .. }
            | WorldEvent::Stolen { .. } => {}
        }
    }

    /// A robot has the ball now.
    fn got(&mut self, robot: usize, attackers: usize, to: Point<Field>) {
        let Some(Flight { by, from, pass }) = self.flying.take() else { return };
        let kind = match (pass, robot < attackers && robot != by) {
            (true, true) => PassKind::Completed,
            (true, false) => PassKind::Lost,
            (false, true) => PassKind::Chance,
            (false, false) => return,
        };
        self.passes.push(Pass { from, to, kind });
    }
}

impl Watcher for Mapper {
    fn watch(&mut self, moment: &Moment<'_>) {
        for (_, event) in &moment.tick.events {
            self.event(moment.world, moment.cast.attackers.len(), event);
        }
        self.balls.push(moment.world.ball.position);
    }

    fn end(&mut self, moment: &Moment<'_>, report: &TrialReport) {
        let ball = moment.world.ball.position;
        // A pass that goes in or passes a post is not counted as lost.
        if let Some(Flight { from, pass: true, .. }) = self.flying.take()
            && !matches!(report.outcome, TrialOutcome::Goal | TrialOutcome::Close)
        {
            self.passes.push(Pass { from, to: ball, kind: PassKind::Lost });
        }
        self.end = Some((ball, report.outcome));
    }
}

fn squares(side: i32) -> usize {
    (f64::from(side.max(0)) / SQUARE_MM).ceil() as usize
}

/// Side of a square, mm: about the ball's diameter, and well visible in a figure.
pub const SQUARE_MM: f64 = 100.0;

#[cfg(test)]
mod tests;
