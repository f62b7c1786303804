//! `wire_event`: game events on the wire. Our events as its `GameEvent`s, with all evidence; m, m/s, s, rad.
//!
//! Our own kinds (moved in halt, too close in stop) are not sent: the league has no message for them.

use geometry::{Field, Point};
use protocol::{Instant, RobotId};
use rules::Colour;
use ssl::common::{Team, Vector2};
use ssl::event as wire;
use ssl::event::Event as Sent;
use ssl::event::GameEventType as Type;

use super::event::{Invalid, RefereeEvent, ShotEvent, What};

/// The league's type of an event, and the event of the same name with this message.
macro_rules! sent {
    ($name:ident { $($fields:tt)* }) => { sent!($name: wire::$name { $($fields)* }) };
    ($name:ident: $message:expr) => { (Type::$name, Sent::$name($message)) };
}

impl RefereeEvent {
    /// The league's message for it; `None` where the league has none. `epoch_us` is added to times, µs.
    pub fn to_wire(&self, epoch_us: u64) -> Option<wire::GameEvent> {
        let (r#type, event) = self.sent(epoch_us)?;
        let stamp = |at: Instant| epoch_us.saturating_add(at.0);
        Some(wire::GameEvent {
            r#type: Some(r#type as i32),
            origin: vec![ORIGIN.into()],
            created_timestamp: Some(stamp(self.at)),
            id: Some(format!("{}-{}", self.at.0, self.what.kind().label())),
            event: Some(event),
        })
    }

    fn sent(&self, epoch_us: u64) -> Option<(Type, Sent)> {
        let by_team = team(self.by);
        let by_bot = self.robot.map(number);
        let location = Some(point(self.place));
        let goal = |shot: Option<&ShotEvent>, message| self.goal(shot, epoch_us, message);
        Some(match &self.what {
            What::LeftTouchLine => {
                sent!(BallLeftFieldTouchLine: wire::BallLeftField { by_team, by_bot, location })
            }
            What::LeftGoalLine => {
                sent!(BallLeftFieldGoalLine: wire::BallLeftField { by_team, by_bot, location })
            }
            What::AimlessKick { from } => {
                sent!(AimlessKick { by_team, by_bot, location, kick_location: Some(point(*from)) })
            }
            What::PossibleGoal { shot } => sent!(PossibleGoal: goal(Some(shot), None)),
            What::Goal { shot } => {
                let message = if shot.is_some() { "valid" } else { "awarded for a foul in a penalty" };
                sent!(Goal: goal(shot.as_ref(), Some(message.into())))
            }
            What::InvalidGoal { shot, reason } => {
                let message = match reason {
                    Invalid::TooManyRobots => "too many robots".into(),
                    Invalid::TooHigh => format!("the ball was {:.2} m high", shot.max_height),
                    Invalid::RecentFoul(kind) => format!("recent foul: {}", kind.label()),
                };
                sent!(InvalidGoal: goal(Some(shot), Some(message)))
            }
            What::NoProgress { duration } => sent!(NoProgressInGame { location, time: Some(*duration) }),
            What::DoubleTouch => sent!(AttackerDoubleTouchedBall { by_team, by_bot, location }),
            What::KeeperHeldBall { duration } => {
                sent!(KeeperHeldBall { by_team, location, duration: Some(*duration) })
            }
            What::BoundaryCrossing => sent!(BoundaryCrossing { by_team, location }),
            What::BallTooFast { speed, chipped } => {
                let (initial_ball_speed, chipped) = (Some(*speed), Some(*chipped));
                sent!(BotKickedBallTooFast { by_team, by_bot, location, initial_ball_speed, chipped })
            }
            What::DribbledTooFar { end } => {
                sent!(BotDribbledBallTooFar { by_team, by_bot, start: location, end: Some(point(*end)) })
            }
            What::HeldBall { duration } => {
                sent!(BotHeldBallDeliberately { by_team, by_bot, location, duration: Some(*duration) })
            }
            What::PlacementSucceeded { took, precision, distance } => {
                let (time_taken, precision, distance) = (Some(*took), Some(*precision), Some(*distance));
                sent!(PlacementSucceeded { by_team, time_taken, precision, distance })
            }
            What::PlacementFailed { remaining, nearest } => {
                let (remaining_distance, nearest_own_bot_distance) = (Some(*remaining), Some(*nearest));
                sent!(PlacementFailed { by_team, remaining_distance, nearest_own_bot_distance })
            }
            What::PenaltyFailed { reason } => {
                sent!(PenaltyKickFailed { by_team, location, reason: Some(reason.message()) })
            }
            What::MultipleFouls { caused_by } => {
                let caused_game_events =
                    caused_by.iter().filter_map(|event| event.to_wire(epoch_us)).collect();
                sent!(MultipleFouls { by_team, caused_game_events })
            }
            What::MultipleCards => sent!(MultipleCards { by_team }),
            What::TooManyRobots { allowed, on_field, ball } => sent!(TooManyRobots {
                by_team,
                num_robots_allowed: Some(*allowed as i32),
                num_robots_on_field: Some(*on_field as i32),
                ball_location: Some(point(*ball)),
            }),
            What::AttackerTooClose { distance, ball } => {
                let (distance, ball_location) = (Some(*distance), Some(point(*ball)));
                sent!(AttackerTooCloseToDefenseArea { by_team, by_bot, location, distance, ball_location })
            }
            What::AttackerTouchedBall { depth } => {
                sent!(AttackerTouchedBallInDefenseArea { by_team, by_bot, location, distance: Some(*depth) })
            }
            What::DefenderInArea { depth } => {
                sent!(DefenderInDefenseArea { by_team, by_bot, location, distance: Some(*depth) })
            }
            What::DefenderTooClose { distance } => {
                sent!(DefenderTooCloseToKickPoint { by_team, by_bot, location, distance: Some(*distance) })
            }
            What::TooFastInStop { speed } => {
                sent!(BotTooFastInStop { by_team, by_bot, location, speed: Some(*speed) })
            }
            What::InterferedPlacement => sent!(BotInterferedPlacement { by_team, by_bot, location }),
            What::CrashUnique { victim, crash_speed, speed_difference, angle } => sent!(BotCrashUnique {
                by_team,
                violator: by_bot,
                victim: Some(number(*victim)),
                location,
                crash_speed: Some(*crash_speed),
                speed_diff: Some(*speed_difference),
                crash_angle: Some(*angle),
            }),
            What::CrashDrawn { yellow, blue, crash_speed, speed_difference, angle } => sent!(BotCrashDrawn {
                bot_yellow: Some(number(*yellow)),
                bot_blue: Some(number(*blue)),
                location,
                crash_speed: Some(*crash_speed),
                speed_diff: Some(*speed_difference),
                crash_angle: Some(*angle),
            }),
            What::Pushed { victim, distance } => {
                let (victim, pushed_distance) = (Some(number(*victim)), Some(*distance));
                sent!(BotPushedBot { by_team, violator: by_bot, victim, location, pushed_distance })
            }
            What::MovedInHalt { .. } | What::Blocked { .. } | What::TooCloseInStop { .. } => return None,
        })
    }

    fn goal(&self, shot: Option<&ShotEvent>, epoch_us: u64, message: Option<String>) -> wire::Goal {
        let kicker = shot.and_then(|shot| shot.kicker);
        wire::Goal {
            by_team: team(self.by),
            kicking_bot: kicker.map(|kicker| number(kicker.id)),
            location: Some(point(self.place)),
            kick_location: shot.map(|shot| point(shot.from)),
            max_ball_height: shot.map(|shot| shot.max_height),
            kicking_team: kicker.map(|kicker| team(Some(kicker.colour))),
            num_robots_by_team: shot.map(|shot| shot.robots),
            last_touch_by_team: shot.and_then(|shot| shot.last_touch).map(|at| epoch_us.saturating_add(at.0)),
            message,
        }
    }
}

fn team(colour: Option<Colour>) -> i32 {
    let team = match colour {
        None => Team::Unknown,
        Some(Colour::Yellow) => Team::Yellow,
        Some(Colour::Blue) => Team::Blue,
    };
    team as i32
}

fn number(id: RobotId) -> u32 {
    u32::from(id.number())
}

fn point(place: Point<Field>) -> Vector2 {
    Vector2 { x: place.x(), y: place.y() }
}

/// Name of the reporting automatic referee.
const ORIGIN: &str = "onetwo";
