//! `legged`: the play of a trial that ended in or close to the goal, from the true world. Grabs and kicks are
//! the simulator's own events. m, field frame, attack towards +x.

use geometry::{Field, Point};
use hil_sim::TrialOutcome;
use hil_sim::four_legged::world::WorldEvent;

use super::{HOLDINGS_MAX, Holding, PlayEnd, SuccessfulPlay, seen};
use crate::report::TrialReport;
use crate::trial::{Moment, Watcher};

/// Follows a trial, as a [`Watcher`].
#[derive(Clone, Debug, Default)]
pub struct LeggedPlay {
    /// The team's holdings since an opponent had the ball, each with the scene at its start.
    held: Vec<(Holding, Scene)>,
    /// The attacker whose kick nobody has touched since.
    passes: Option<u8>,
    /// Start and stop position of the last kick of an attacker.
    kick: Option<[Point<Field>; 2]>,
    found: Option<SuccessfulPlay>,
}

/// Both teams at a moment, mm.
#[derive(Clone, Debug)]
struct Scene {
    teammates: Vec<(u8, [i32; 2])>,
    opponents: Vec<[i32; 2]>,
}

impl LeggedPlay {
    /// The play that led to goal, once the trial is over.
    pub fn found(&self) -> Option<&SuccessfulPlay> {
        self.found.as_ref()
    }

    fn grabbed(&mut self, moment: &Moment<'_>, robot: usize) {
        let Some(id) = moment.cast.attackers.get(robot).map(|id| id.number()) else { return self.lose() };
        let ball = seen(moment.world.ball.position, 1.0);
        self.kick = None;
        let passed = self.passes.take();
        match self.held.last_mut() {
            // Its own ball again: it carries it on.
            Some((last, _)) if last.robot == id => last.left = ball,
            last => {
                if last.is_none_or(|(last, _)| passed != Some(last.robot)) {
                    self.held.clear();
                }
                self.held.push((Holding { robot: id, got: ball, left: ball }, scene(moment)));
                if self.held.len() > HOLDINGS_MAX {
                    self.held.remove(0);
                }
            }
        }
    }

    fn kicked(&mut self, moment: &Moment<'_>, robot: usize, from: Point<Field>, rest: Point<Field>) {
        let Some(id) = moment.cast.attackers.get(robot).map(|id| id.number()) else { return self.lose() };
        let at = seen(from, 1.0);
        match self.held.last_mut() {
            Some((last, _)) if last.robot == id => last.left = at,
            _ => self.held = vec![(Holding { robot: id, got: at, left: at }, scene(moment))],
        }
        (self.passes, self.kick) = (Some(id), Some([from, rest]));
    }

    fn lose(&mut self) {
        self.held.clear();
        (self.passes, self.kick) = (None, None);
    }
}

impl Watcher for LeggedPlay {
    fn watch(&mut self, moment: &Moment<'_>) {
        for (_, event) in &moment.tick.events {
            match *event {
                WorldEvent::Grabbed { robot } | WorldEvent::Stolen { by: robot, .. } => {
                    self.grabbed(moment, robot);
                }
                WorldEvent::Kicked { robot, from, rest, .. } => self.kicked(moment, robot, from, rest),
                // A ball that an opponent deflected is no pass, and may still be a shot.
                WorldEvent::Touched { robot } if robot >= moment.cast.attackers.len() => self.passes = None,
                WorldEvent::Touched { .. }
                | WorldEvent::GrabFailed { .. }
                | WorldEvent::KickedNothing { .. } => {}
            }
        }
    }

    fn end(&mut self, moment: &Moment<'_>, report: &TrialReport) {
        if !matches!(report.outcome, TrialOutcome::Goal | TrialOutcome::Close) {
            return;
        }
        let field = rules::League::FourLegged.field();
        let Some((_, scene)) = self.held.first().cloned() else { return };
        let mut holdings: Vec<Holding> = self.held.iter().map(|(holding, _)| *holding).collect();
        let end = match self.kick {
            Some([from, rest]) if rest.x() > from.x() => {
                let slope = (rest.y() - from.y()) / (rest.x() - from.x());
                let y = from.y() + slope * (0.5 * field.length - from.x());
                let half = 0.5 * field.width;
                PlayEnd::Shot((y.clamp(-half, half) * 1000.0).round() as i32)
            }
            _ => {
                let ball = field.clamp(moment.world.ball.position, 0.0);
                if let Some(last) = holdings.last_mut() {
                    last.left = seen(ball, 1.0);
                }
                PlayEnd::Carried
            }
        };
        let play = SuccessfulPlay {
            field: [field.length, field.width].map(|m| (m * 1000.0).round() as i32),
            teammates: scene.teammates,
            opponents: scene.opponents,
            holdings,
            end,
            goal: report.outcome == TrialOutcome::Goal,
        };
        self.found = Some(play).filter(SuccessfulPlay::is_sane);
    }
}

fn scene(moment: &Moment<'_>) -> Scene {
    let own = moment.cast.attackers.len();
    let places: Vec<_> = moment.world.walkers.iter().map(|walker| seen(walker.pose.position, 1.0)).collect();
    let (ours, theirs) = places.split_at(own.min(places.len()));
    let ids = moment.cast.attackers.iter().map(|id| id.number());
    Scene { teammates: ids.zip(ours.iter().copied()).collect(), opponents: theirs.to_vec() }
}
