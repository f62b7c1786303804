//! `autoref`: the game events that an automatic referee reports to a game controller elsewhere, seen in the true state of the
//! world by the watchers of the internal referee. m, m/s, field frame; times of the simulation, µs.
//!
//! What the controller finds by itself is not reported: no progress, a ball kept in a defence area, too many robots, time that is
//! up. After an event that stops the game nothing of play is reported until the controller has stopped it: it waits 1 s for other
//! automatic referees.

use protocol::{Duration, Instant};
use rules::legality::no_goal;
use rules::restart::{AfterPlacement, placement_lack};
use rules::{Colour, Phase, limits};

use super::super::event::{Event, Invalid, Kind, PenaltyEnd, Restart, Shot, What};
use super::super::look::Sight;
use super::super::scene::{COLOURS, Scene, is_running};
use super::super::watch::Watch;
use super::{RemoteMatch, places};
use crate::small_size::{Event as WorldEvent, World};

/// Who decides whether a ball in the goal is a goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goals {
    /// A person at the controller: POSSIBLE_GOAL is reported, and the controller halts the game for the decision.
    Person,
    /// This automatic referee: GOAL or INVALID_GOAL is reported, and the game goes on.
    Us,
}

/// An automatic referee for a match that a game controller elsewhere runs.
#[derive(Clone, Debug)]
pub struct AutoReferee {
    goals: Goals,
    watch: Watch,
    looked: Option<Instant>,
    commands: u64,
    /// When an event that stops the game was reported that the controller has not acted on.
    stopping: Option<Instant>,
    /// A success of this placement was reported.
    placed: bool,
    /// The last foul of each team after which the game went on, in the order of [`COLOURS`].
    fouls: [Option<(Kind, Instant)>; 2],
}

impl AutoReferee {
    /// One that has seen nothing yet.
    pub fn new(goals: Goals) -> Self {
        let watch = Watch::default();
        Self { goals, watch, looked: None, commands: 0, stopping: None, placed: false, fouls: [None; 2] }
    }

    /// Looks at the world, every 10 ms or so; `events` are the world's since the last look. Gives what is to be reported.
    pub fn look(&mut self, game: &RemoteMatch, world: &World, events: &[WorldEvent]) -> Vec<Event> {
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
        if self.stopping.is_some_and(|at| now.since(at) > DECISION) {
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
        seen.into_iter().filter_map(|event| self.report(game, &sight, event)).collect()
    }

    /// The event as it is reported, if it is.
    fn report(&mut self, game: &RemoteMatch, sight: &Sight, event: Event) -> Option<Event> {
        let phase = game.phase();
        let kind = event.what.kind();
        if is_the_controllers(&event.what) || !is_in_time(kind, phase) {
            return None;
        }
        // Of what happens between the report and the stop only a ball over the wall counts: it was kicked in play.
        if self.stopping.is_some() && kind != Kind::BoundaryCrossing {
            return None;
        }
        if kind.is_non_stopping_foul() {
            for (team, foul) in COLOURS.into_iter().zip(&mut self.fouls) {
                if event.by.is_none_or(|by| by == team) {
                    *foul = Some((kind, event.at));
                }
            }
        }
        let event = match event.what {
            What::PossibleGoal { shot } => self.goal(game, sight, shot, event),
            _ => event,
        };
        let stops = event.what.kind().stops_the_game() || kind == Kind::PossibleGoal;
        if stops && (is_running(phase) || matches!(phase, Phase::BallPlacement(_))) {
            self.stopping = Some(event.at);
        }
        Some(event)
    }

    /// A ball in a goal, as whoever decides needs it.
    fn goal(&self, game: &RemoteMatch, sight: &Sight, shot: Shot, event: Event) -> Event {
        let Some(scorer) = event.by else { return event };
        let own = game.own_end(scorer);
        let on_field = sight.robots.iter().filter(|robot| {
            robot.who.colour == scorer && !places::behind_own_goal(&game.field, own, robot.pose.position)
        });
        let shot = Shot { robots: on_field.count() as u32, ..shot };
        if self.goals == Goals::Person {
            return Event { what: What::PossibleGoal { shot }, ..event };
        }
        let invalid = self.invalid(game, scorer, &shot, event.at);
        let what = match invalid.filter(|_| !matches!(game.phase(), Phase::Penalty(_))) {
            None => What::Goal { shot: Some(shot) },
            Some(reason) => What::InvalidGoal { shot, reason },
        };
        Event { what, ..event }
    }

    fn invalid(&self, game: &RemoteMatch, scorer: Colour, shot: &Shot, at: Instant) -> Option<Invalid> {
        use rules::legality::NoGoal;
        let foul = self.fouls[usize::from(scorer == COLOURS[1])];
        let since = foul.map(|(_, foul)| at.since(foul).as_secs_f32());
        let allowed = game.allowed(scorer).unwrap_or(u32::MAX);
        Some(match no_goal(shot.robots, allowed, shot.max_height, since)? {
            NoGoal::TooManyRobots => Invalid::TooManyRobots,
            NoGoal::Height(_) => Invalid::TooHigh,
            NoGoal::Foul => Invalid::RecentFoul(foul?.0),
        })
    }

    /// The ball lies where the placing team was to bring it: the controller takes this from automatic referees alone.
    fn placement(&mut self, game: &RemoteMatch, scene: &Scene<'_>) -> Option<Event> {
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

/// The controller finds these by itself.
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

/// Events of play belong to play, those of placements to placements.
fn is_in_time(kind: Kind, phase: Phase<Colour>) -> bool {
    match kind {
        Kind::PlacementSucceeded => matches!(phase, Phase::BallPlacement(_)),
        Kind::PenaltyFailed => matches!(phase, Phase::Penalty(_)),
        Kind::AttackerTooClose | Kind::BoundaryCrossing => true,
        Kind::PossibleGoal => is_running(phase),
        _ => !kind.stops_the_game() || is_running(phase),
    }
}

/// The controller has decided about a report within this: it waits 1 s for other automatic referees; twice that and a network's
/// pauses.
const DECISION: Duration = Duration::millis(2_500);
