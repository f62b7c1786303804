//! `recording`: recording of a trial for its figure. Places by tick, kicks, and where gameplays started; m,
//! s, field frame.

use geometry::{Field, Point, Pose};
use hil_sim::TICK_US;
use hil_sim::four_legged::world::WorldEvent;
use protocol::robot_io::LeggedKick;

use crate::cycles::CycleEvent;
use crate::names::{Cast, symmetry};
use crate::report::TrialReport;
use crate::trial::{Moment, Watcher};

/// Course of a trial, filled as a [`Watcher`].
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Identities of the robots in [`RecordedSample::robots`].
    pub cast: Cast,
    /// One sample a tick, oldest first.
    pub samples: Vec<RecordedSample>,
    /// Every kick, opponents' included.
    pub kicks: Vec<RecordedKick>,
    /// Every gameplay that started.
    pub starts: Vec<Start>,
    /// Report, once the trial is over.
    pub report: Option<TrialReport>,
}

/// Positions of ball and robots at the end of a tick.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedSample {
    /// Simulated seconds from kick-off.
    pub time: f32,
    /// Position of the ball, m, field frame.
    pub ball: Point<Field>,
    /// The robot that held it, if any.
    pub holder: Option<usize>,
    /// Poses in the order of [`Recording::cast`], m and rad.
    pub robots: Vec<Pose<Field>>,
}

/// A kick of any robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedKick {
    /// Simulated seconds from kick-off.
    pub time: f32,
    /// The robot that kicked.
    pub robot: usize,
    /// Kind of kick, as the body executed it.
    pub kick: LeggedKick,
    /// Position of the ball.
    pub from: Point<Field>,
    /// The ball's stop position, undisturbed.
    pub rest: Point<Field>,
}

/// Start of a gameplay.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Simulated seconds from kick-off.
    pub time: f32,
    /// Position of the ball.
    pub ball: Point<Field>,
    /// Name of the case, `region/name`.
    pub case: String,
    /// Symmetry of the stored case.
    pub symmetry: &'static str,
    /// The players, in the order of case robots.
    pub players: Vec<String>,
    /// Place in the team's list of cycles.
    pub cycle: usize,
}

impl Watcher for Recording {
    fn watch(&mut self, moment: &Moment<'_>) {
        if self.samples.is_empty() {
            self.cast = moment.cast.clone();
        }
        for cycle_event in moment.events {
            let CycleEvent::Decided(cycle) = *cycle_event else { continue };
            let Some(play) = moment.cycles.cycles().get(cycle).and_then(|cycle| cycle.play.as_ref()) else {
                continue;
            };
            self.starts.push(Start {
                time: moment.tick.time,
                ball: play.ball.into(),
                case: moment.config.names.of(play.case),
                symmetry: symmetry(play.case),
                players: play.robots.iter().map(|id| moment.cast.name_of(*id)).collect(),
                cycle,
            });
        }
        for (time, event) in &moment.tick.events {
            if let WorldEvent::Kicked { robot, kick, from, rest } = *event {
                self.kicks.push(RecordedKick { time: *time, robot, kick, from, rest });
            }
        }
        self.samples.push(RecordedSample {
            time: moment.tick.time + TICK_US as f32 * 1e-6,
            ball: moment.world.ball.position,
            holder: moment.world.holder(),
            robots: moment.world.walkers.iter().map(|walker| walker.pose).collect(),
        });
    }

    fn end(&mut self, _moment: &Moment<'_>, report: &TrialReport) {
        self.report = Some(report.clone());
    }
}
