//! `ci`: a match under the league's game controller in its CI mode, whose clock is the simulation. m, field
//! frame; times of the simulation, µs.
//!
//! No socket: the caller sends [`CiMatch::acts`] and [`CiMatch::tick`], and hands what comes back to
//! [`CiMatch::take`] until it is true. The controller sends a message for each run of its engine and for each
//! change of its state, and marks neither; the end of an exchange is recognized by its content, so that equal
//! matches take equal messages into the same tick, however long the controller takes:
//!
//! - acts end with a status text of our own, after which everything before it is done;
//! - a run of the engine moves a clock by the time that has passed, or changes nothing.

use protocol::{Duration, Instant, Who};
use ssl::common::{Vector2, Vector3};
use ssl::controller::ci::{AddGameEvent, ChangeOf, CiInput, CiOutput, SetStatusMessage};
use ssl::referee::{Command, Referee, Stage as WireStage, TeamInfo};
use ssl::tracker::{
    TeamColor, TrackedBall, TrackedFrame, TrackedRobot, TrackedRobotId, TrackerWrapperPacket,
};
use ssl::vision::GeometryData;

use super::decided::EngineEvents;
use super::operator::{Operator, act, is_over};
use super::{Assistant, AutoReferee, Decider, RemoteMatch};
use crate::small_size::referee::{NoRules, RefereeEvent, RefereeSettings};
use crate::small_size::{PhysicsEvent, Robot, World};

/// A match that a game controller runs by the simulation's clock.
#[derive(Clone, Debug)]
pub struct CiMatch {
    game: RemoteMatch,
    autoref: AutoReferee,
    assistant: Assistant,
    operator: Operator,
    /// Sent with the first tick.
    geometry: Option<GeometryData>,
    /// Time that is added to the simulation's in packets, µs.
    epoch_us: u64,
    engine: EngineEvents,
    /// Events since they were last taken, ours and the controller's own.
    events: Vec<RefereeEvent>,
    /// Events of ours that the next acts report.
    reports: Vec<RefereeEvent>,
    /// The newest message as the controller sent it.
    newest: Option<Referee>,
    awaited: Option<Awaited>,
    /// Number of acts sent, which numbers their status texts.
    sent: u64,
    ticks: u32,
    ticked: Option<Instant>,
    received: Vec<Referee>,
    /// The newest command's count, and the time at which it was received.
    command: (u32, u64),
}

/// The content that ends an exchange.
#[derive(Clone, Debug, PartialEq)]
enum Awaited {
    /// This status text.
    Status(String),
    /// A run of the engine after this time, µs.
    Tick(i64),
}

impl CiMatch {
    /// A match before the first exchange. Not for the four-legged league.
    pub fn new(settings: &RefereeSettings, seed: u64, geometry: GeometryData) -> Result<Self, NoRules> {
        Ok(Self {
            game: RemoteMatch::new(settings.league)?,
            autoref: AutoReferee::new(Decider::AutoReferee),
            assistant: Assistant::default(),
            operator: Operator::new(settings.clone(), seed),
            geometry: Some(geometry),
            epoch_us: settings.epoch_us,
            engine: EngineEvents::default(),
            events: Vec::new(),
            reports: Vec::new(),
            newest: None,
            awaited: None,
            sent: 0,
            ticks: 0,
            ticked: None,
            received: Vec::new(),
            command: (0, 0),
        })
    }

    /// The match as the controller describes it.
    pub fn game(&self) -> &RemoteMatch {
        &self.game
    }

    /// True once the match is over.
    pub fn is_over(&self) -> bool {
        is_over(&self.game)
    }

    /// The robot that touched the ball last, and the ball's position then, m.
    pub(in super::super) fn last_touch(&self) -> Option<(Who, geometry::Point<geometry::Field>)> {
        self.autoref.watch.last_touch()
    }

    /// Observes the world every 10 ms, and carries out the manual acts at the field; `events` are the world's
    /// since the last call. What it sees is reported by the next exchange.
    pub fn look(&mut self, world: &mut World, events: &[PhysicsEvent]) {
        self.game.set_field(world.pitch().field);
        self.game.tick(time_of(world), world.ball.position);
        let seen = self.autoref.look(&self.game, world, events);
        for deed in self.assistant.look(&self.game, world) {
            deed.order.carry_out(world);
        }
        self.events.extend(seen.iter().cloned());
        self.reports.extend(seen);
    }

    /// The events since the last call, as our automatic referee reported them and as the controller found
    /// them by itself.
    pub(in super::super) fn take_events(&mut self) -> Vec<RefereeEvent> {
        std::mem::take(&mut self.events)
    }

    /// Whether an exchange is due.
    pub fn is_due(&self, world: &World) -> bool {
        self.ticked.is_none_or(|ticked| time_of(world).since(ticked) >= EXCHANGE_PERIOD)
    }

    /// Reports and acts of the operator, to be sent before the tick; `None`: nothing to be done.
    pub fn acts(&mut self, world: &World) -> Option<CiInput> {
        self.newest.as_ref()?;
        let mut changes = match self.sent {
            0 => self.operator.start(),
            _ => self.operator.acts(&self.game, &world.ball),
        };
        let reports = std::mem::take(&mut self.reports);
        changes.extend(reports.iter().filter_map(|event| {
            // The identifier is the controller's: two robots may do the same at the same time.
            let event = ssl::event::GameEvent { id: None, ..event.to_wire(self.epoch_us)? };
            Some(ChangeOf::AddGameEvent(AddGameEvent { game_event: Some(event) }))
        }));
        if changes.is_empty() {
            return None;
        }
        self.sent += 1;
        let status = format!("{STATUS}{}", self.sent);
        changes.push(ChangeOf::SetStatusMessage(SetStatusMessage { status_message: Some(status.clone()) }));
        self.awaited = Some(Awaited::Status(status));
        Some(CiInput { api_inputs: changes.into_iter().map(act).collect(), ..CiInput::default() })
    }

    /// The field and the time.
    pub fn tick(&mut self, world: &World) -> CiInput {
        let now = time_of(world);
        let passed = self.ticked.map_or(Duration(0), |ticked| now.since(ticked));
        self.ticked = Some(now);
        self.ticks = self.ticks.wrapping_add(1);
        self.awaited = Some(Awaited::Tick(passed.0 as i64));
        let engine = match self.newest {
            None => Some(Operator::engine()),
            Some(_) => self.operator.continues(&self.game),
        };
        let stamp_us = self.epoch_us.saturating_add(now.0);
        CiInput {
            timestamp: i64::try_from(stamp_us.saturating_mul(1_000)).ok(),
            tracker_packet: Some(tracked(world, self.ticks, stamp_us as f64 * 1e-6)),
            api_inputs: engine.into_iter().collect(),
            geometry: self.geometry.take(),
        }
    }

    /// Takes a message of the controller; true where it ends the exchange.
    pub fn take(&mut self, output: CiOutput) -> bool {
        let Some(referee) = output.referee_msg else { return false };
        let ends = match &self.awaited {
            Some(Awaited::Status(status)) => referee.status_message.as_ref() == Some(status),
            Some(Awaited::Tick(passed)) => {
                self.newest.as_ref().is_none_or(|before| is_tick(before, &referee, *passed))
            }
            None => false,
        };
        if ends {
            self.awaited = None;
        }
        self.newest = Some(referee.clone());
        self.received.push(referee);
        ends
    }

    /// The referee packets of the exchange by the simulation's clock, oldest first; they are the game's from
    /// now on.
    pub fn packets(&mut self, world: &World) -> Vec<Referee> {
        let (now, ball) = (time_of(world), world.ball.position);
        let received = std::mem::take(&mut self.received);
        let packets: Vec<Referee> = received.into_iter().map(|referee| self.stamped(referee, now)).collect();
        for packet in &packets {
            self.events.extend(self.engine.new_in(packet, now, ball));
            self.game.receive(packet.clone(), now, ball);
        }
        self.game.tick(now, ball);
        packets
    }

    /// The message with times of the simulation in place of the controller's wall clock.
    fn stamped(&mut self, mut referee: Referee, now: Instant) -> Referee {
        let stamp = self.epoch_us.saturating_add(now.0);
        if self.command.0 != referee.command_counter {
            self.command = (referee.command_counter, stamp);
        }
        (referee.packet_timestamp, referee.command_timestamp) = (stamp, self.command.1);
        referee.status_message = referee.status_message.filter(|status| !status.starts_with(STATUS));
        referee
    }
}

/// Whether `now` is the message of a run of the engine, `passed` µs after the one before, with no change
/// between this message and `before`.
fn is_tick(before: &Referee, now: &Referee, passed: i64) -> bool {
    use Command::{BallPlacementBlue, BallPlacementYellow};
    use Command::{DirectFreeBlue, DirectFreeYellow, ForceStart, NormalStart};
    use WireStage::{ExtraHalfTime, ExtraTimeBreak, NormalHalfTime, PenaltyShootoutBreak};
    let moved = |a: Option<i64>, b: Option<i64>| a.zip(b).is_some_and(|(a, b)| a - b == passed);
    let pauses =
        matches!(before.stage(), NormalHalfTime | ExtraTimeBreak | ExtraHalfTime | PenaltyShootoutBreak);
    match before.command() {
        _ if pauses => moved(before.stage_time_left, now.stage_time_left),
        NormalStart | ForceStart | DirectFreeYellow | DirectFreeBlue => {
            moved(before.stage_time_left, now.stage_time_left)
        }
        BallPlacementYellow | BallPlacementBlue => {
            moved(before.current_action_time_remaining, now.current_action_time_remaining)
        }
        _ => timeless(before) == timeless(now),
    }
}

/// The message without its clocks.
fn timeless(referee: &Referee) -> Referee {
    let team = |team: &TeamInfo| TeamInfo {
        yellow_card_times: Vec::new(),
        timeout_time: 0,
        bot_substitution_time_left: None,
        ..team.clone()
    };
    Referee {
        packet_timestamp: 0,
        stage_time_left: None,
        current_action_time_remaining: None,
        yellow: team(&referee.yellow),
        blue: team(&referee.blue),
        ..referee.clone()
    }
}

/// The true field as a tracker packet; `stamp` in s.
fn tracked(world: &World, number: u32, stamp: f64) -> TrackerWrapperPacket {
    let ball = &world.ball;
    let ball = TrackedBall {
        pos: Vector3 { x: ball.position.x(), y: ball.position.y(), z: ball.height },
        vel: Some(Vector3 { x: ball.velocity.x(), y: ball.velocity.y(), z: ball.climb }),
        visibility: Some(1.0),
    };
    let counts = |robot: &&Robot| robot.present && !robot.bystander;
    let frame = TrackedFrame {
        frame_number: number,
        timestamp: stamp,
        balls: vec![ball],
        robots: world.robots().iter().filter(counts).map(tracked_robot).collect(),
        kicked_ball: None,
        capabilities: Vec::new(),
    };
    TrackerWrapperPacket {
        uuid: SOURCE.to_owned(),
        source_name: Some(SOURCE.to_owned()),
        tracked_frame: Some(frame),
    }
}

fn tracked_robot(robot: &Robot) -> TrackedRobot {
    let team_color = robot.who.colour.pick(TeamColor::Yellow, TeamColor::Blue) as i32;
    TrackedRobot {
        robot_id: TrackedRobotId { id: u32::from(robot.who.id.number()), team_color },
        pos: Vector2 { x: robot.pose.position.x(), y: robot.pose.position.y() },
        orientation: robot.pose.heading.radians(),
        vel: Some(Vector2 { x: robot.velocity.x(), y: robot.velocity.y() }),
        vel_angular: Some(robot.turning),
        visibility: Some(1.0),
    }
}

fn time_of(world: &World) -> Instant {
    Instant(world.now() * 1_000)
}

/// Period of the exchanges: the tick of the simulation's referee that is next to the controller's own 25 ms.
const EXCHANGE_PERIOD: Duration = Duration::millis(20);
/// Beginning of the status texts that mark the end of acts.
const STATUS: &str = "onetwo act ";
/// Identifier of the tracker's packets.
const SOURCE: &str = "onetwo-simulator";

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 s before the end of a half and of an action.
    fn message(command: Command) -> Referee {
        Referee {
            command: command as i32,
            stage: WireStage::NormalFirstHalf as i32,
            stage_time_left: Some(10_000_000),
            current_action_time_remaining: Some(10_000_000),
            ..Referee::default()
        }
    }

    #[test]
    fn a_run_of_the_engine_moves_a_clock_or_changes_nothing() {
        let in_play = message(Command::ForceStart);
        assert!(!is_tick(&in_play, &in_play, 20_000), "a change without a trace, such as a free kick's end");
        assert!(is_tick(&in_play, &Referee { stage_time_left: Some(9_980_000), ..in_play.clone() }, 20_000));

        let placed = message(Command::BallPlacementBlue);
        let later = Referee { current_action_time_remaining: Some(9_980_000), ..placed.clone() };
        assert!(!is_tick(&placed, &placed, 20_000) && is_tick(&placed, &later, 20_000));

        let stopped = message(Command::Stop);
        assert!(is_tick(&stopped, &Referee { packet_timestamp: 7, ..stopped.clone() }, 20_000));
        let mut scored = stopped.clone();
        scored.yellow.score = 1;
        let again = Referee { command_counter: 1, ..stopped.clone() };
        assert!(!is_tick(&stopped, &scored, 20_000) && !is_tick(&stopped, &again, 20_000));
    }

    #[test]
    fn events_of_the_engine_alone_are_taken_over_once() {
        use ssl::event::{Event, GameEvent, NoProgressInGame};
        let event = |origin: &str, id: &str| GameEvent {
            origin: vec![origin.to_owned()],
            id: Some(id.to_owned()),
            event: Some(Event::NoProgressInGame(NoProgressInGame { location: None, time: Some(10.0) })),
            ..GameEvent::default()
        };
        let mut packet = message(Command::Stop);
        packet.game_events = vec![event("Engine", "a"), event("onetwo", "b")];
        let (mut engine, here) = (EngineEvents::default(), geometry::Point::new(1.0, 0.0));
        let found = engine.new_in(&packet, Instant(5), here);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].at, found[0].by, found[0].place), (Instant(5), None, here));
        assert!(engine.new_in(&packet, Instant(6), here).is_empty());
    }
}
