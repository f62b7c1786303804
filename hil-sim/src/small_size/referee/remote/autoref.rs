//! `autoref`: the game events that an automatic referee reports to a game controller elsewhere, found in the
//! true state of the world by the monitors of the internal referee. m, m/s, field frame; times of the
//! simulation, µs.
//!
//! Events that the controller finds by itself are not reported: no progress, a ball kept in a defence area,
//! too many robots, time-outs of a phase. After an event that stops the game, no event of play is reported
//! until the controller has stopped it: it waits 1 s for other automatic referees.

use protocol::{Duration, Instant};
use rules::legality::no_goal;
use rules::restart::{AfterPlacement, placement_lack};
use rules::{Colour, Phase, limits};

use super::super::event::{Invalid, Kind, PenaltyEnd, RefereeEvent, Restart, ShotEvent, What};
use super::super::look::Sight;
use super::super::scene::{Scene, is_running};
use super::super::watch::Watch;
use super::RemoteMatch;
use crate::small_size::{PhysicsEvent as WorldEvent, World};

/// Party that takes the decisions which automatic referees leave open: whether a ball in the goal is a goal,
/// and how play continues after a ball left the field that no robot touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decider {
    /// The operator of the controller: POSSIBLE_GOAL is reported, and the controller halts the game for the
    /// decision.
    Person,
    /// This automatic referee: the decision is reported, and the game continues.
    AutoReferee,
}

/// An automatic referee for a match that a game controller elsewhere runs.
#[derive(Clone, Debug)]
pub struct AutoReferee {
    decider: Decider,
    pub(super) watch: Watch,
    looked: Option<Instant>,
    commands: u64,
    /// Time at which an event that stops the game was reported, while the controller has not reacted.
    stopping: Option<Instant>,
    /// True once the success of this placement was reported.
    placed: bool,
    /// The last foul of each team that did not stop the game, in the order of [`Colour::ALL`].
    fouls: [Option<(Kind, Instant)>; 2],
}

impl AutoReferee {
    /// An automatic referee before its first observation.
    pub fn new(decider: Decider) -> Self {
        let watch = Watch::default();
        Self { decider, watch, looked: None, commands: 0, stopping: None, placed: false, fouls: [None; 2] }
    }

    /// Observes the world, about every 10 ms; `events` are the world's since the last call. Returns the
    /// events to report.
    pub fn look(&mut self, game: &RemoteMatch, world: &World, events: &[WorldEvent]) -> Vec<RefereeEvent> {
        let sight = Sight::of(world, events, self.looked);
        let now = sight.time;
        self.looked = Some(now);
        if game.is_silent(now) {
            return Vec::new();
        }
        if self.commands != game.commands {
            self.commands = game.commands;
            self.watch.command_given();
            self.stopping = None;
            self.placed = false;
        }
        if self.stopping.is_some_and(|at| now.since(at) > DECISION_TIME) {
            self.stopping = None;
        }
        let view = game.view();
        let scene = Scene {
            now,
            ball: sight.ball,
            fastest: sight.fastest.max(sight.ball.speed()),
            robots: &sight.robots,
            crashes: &sight.crashes,
            game: &view,
        };
        let mut seen = Vec::new();
        self.watch.look(&scene, &mut seen);
        seen.extend(self.placement(game, &scene));
        seen.into_iter().flat_map(|event| self.report(game, event)).collect()
    }

    /// The events to report for this one: none, one, or two where it takes both to determine the restart.
    fn report(&mut self, game: &RemoteMatch, event: RefereeEvent) -> Vec<RefereeEvent> {
        let phase = game.phase();
        let kind = event.what.kind();
        if is_the_controllers(&event.what) || !is_in_time(kind, phase) {
            return Vec::new();
        }
        // Of the events between the report and the stop only a ball over the wall counts: it was kicked in
        // play.
        if self.stopping.is_some() && kind != Kind::BoundaryCrossing {
            return Vec::new();
        }
        if kind.is_non_stopping_foul() {
            for (team, foul) in Colour::ALL.into_iter().zip(&mut self.fouls) {
                if event.by.is_none_or(|by| by == team) {
                    *foul = Some((kind, event.at));
                }
            }
        }
        let events = match event.what {
            What::PossibleGoal { shot } => self.goal(game, shot, event),
            // The controller knows no restart for it, and continues by a force start where nothing moves.
            What::LeftTouchLine | What::LeftGoalLine
                if event.by.is_none() && self.decider == Decider::AutoReferee =>
            {
                vec![RefereeEvent { what: What::NoProgress { duration: 0.0 }, ..event }]
            }
            _ => vec![event],
        };
        let stops = |event: &RefereeEvent| {
            event.what.kind().stops_the_game() || matches!(event.what, What::PossibleGoal { .. })
        };
        if events.iter().any(stops) && (is_running(phase) || matches!(phase, Phase::BallPlacement(_))) {
            self.stopping = events.first().map(|event| event.at);
        }
        events
    }

    /// A ball in a goal, as required by [`Decider`].
    fn goal(&self, game: &RemoteMatch, shot: ShotEvent, event: RefereeEvent) -> Vec<RefereeEvent> {
        let Some(scorer) = event.by else { return vec![event] };
        if self.decider == Decider::Person {
            return vec![RefereeEvent { what: What::PossibleGoal { shot }, ..event }];
        }
        let invalid = self.invalid(game, scorer, &shot, event.at);
        match invalid.filter(|_| !matches!(game.phase(), Phase::Penalty(_))) {
            None => vec![RefereeEvent { what: What::Goal { shot: Some(shot) }, ..event }],
            Some(reason) => {
                // The controller takes the position of the restart from a ball over the goal line, and none
                // from an invalid goal.
                let kicker = shot.kicker;
                let out = RefereeEvent {
                    by: kicker.map_or(Some(scorer), |kicker| Some(kicker.colour)),
                    robot: kicker.map(|kicker| kicker.id),
                    what: What::LeftGoalLine,
                    ..event.clone()
                };
                vec![RefereeEvent { what: What::InvalidGoal { shot, reason }, ..event }, out]
            }
        }
    }

    fn invalid(&self, game: &RemoteMatch, scorer: Colour, shot: &ShotEvent, at: Instant) -> Option<Invalid> {
        use rules::legality::NoGoal;
        let foul = self.fouls[usize::from(scorer == Colour::Blue)];
        let since = foul.map(|(_, foul)| at.since(foul).as_secs_f32());
        let allowed = game.allowed(scorer).unwrap_or(u32::MAX);
        Some(match no_goal(shot.robots, allowed, shot.max_height, since)? {
            NoGoal::TooManyRobots => Invalid::TooManyRobots,
            NoGoal::Height(_) => Invalid::TooHigh,
            NoGoal::Foul => Invalid::RecentFoul(foul?.0),
        })
    }

    /// The ball lies where the placing team had to bring it: the controller takes this from automatic
    /// referees alone.
    fn placement(&mut self, game: &RemoteMatch, scene: &Scene<'_>) -> Option<RefereeEvent> {
        let Phase::BallPlacement(team) = game.phase() else { return None };
        let target = scene.game.target.filter(|_| !self.placed)?;
        let after = match game.next() {
            Some(Restart::FreeKick(favoured)) if favoured == team => AfterPlacement::FreeKick,
            _ => AfterPlacement::ForceStart,
        };
        let (ball, took) = (scene.ball, scene.game.age(scene.now));
        let places = scene.robots.iter().map(|robot| robot.pose.position);
        let lack = placement_lack(ball.position, ball.speed(), target, places, after);
        if lack.is_some() || took < limits::PLACEMENT_TIME_MIN {
            return None;
        }
        self.placed = true;
        let what = What::PlacementSucceeded {
            took,
            precision: ball.position.distance(target),
            distance: scene.game.ball_at_command.distance(target),
        };
        Some(scene.of(Some(team), ball.position, what))
    }
}

/// True for an event that the controller finds by itself.
fn is_the_controllers(what: &What) -> bool {
    matches!(
        what,
        What::NoProgress { .. }
            | What::KeeperHeldBall { .. }
            | What::TooManyRobots { .. }
            | What::PlacementFailed { .. }
            | What::PenaltyFailed { reason: PenaltyEnd::TimeUp }
    )
}

/// True for an event that belongs to the phase: events of play to play, those of placements to placements.
fn is_in_time(kind: Kind, phase: Phase<Colour>) -> bool {
    match kind {
        Kind::PlacementSucceeded => matches!(phase, Phase::BallPlacement(_)),
        Kind::PenaltyFailed => matches!(phase, Phase::Penalty(_)),
        Kind::AttackerTooClose | Kind::BoundaryCrossing => true,
        Kind::PossibleGoal => is_running(phase),
        _ => !kind.stops_the_game() || is_running(phase),
    }
}

/// Time after which the controller has decided about a report: it waits 1 s for other automatic referees;
/// twice that plus network delays.
const DECISION_TIME: Duration = Duration::millis(2_500);
