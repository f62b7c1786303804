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

use super::event::{Event, Invalid, Shot, What};

impl Event {
    /// The league's message for it; `None` where the league has none. `epoch_us` is added to times, µs.
    pub fn to_wire(&self, epoch_us: u64) -> Option<wire::GameEvent> {
        let (r#type, event) = self.sent(epoch_us)?;
        let stamp = |at: Instant| epoch_us.saturating_add(at.0);
        Some(wire::GameEvent {
            r#type: Some(r#type as i32),
            origin: vec![ORIGIN.into()],
            created_timestamp: Some(stamp(self.at)),
            id: Some(format!("{}-{}", self.at.0, self.what.kind().word())),
            event: Some(event),
        })
    }

    fn sent(&self, epoch_us: u64) -> Option<(Type, Sent)> {
        let by_team = team(self.by);
        let by_bot = self.robot.map(number);
        let location = Some(point(self.place));
        Some(match &self.what {
            What::LeftTouchLine => (
                Type::BallLeftFieldTouchLine,
                Sent::BallLeftFieldTouchLine(wire::BallLeftField { by_team, by_bot, location }),
            ),
            What::LeftGoalLine => (
                Type::BallLeftFieldGoalLine,
                Sent::BallLeftFieldGoalLine(wire::BallLeftField { by_team, by_bot, location }),
            ),
            What::AimlessKick { from } => {
                let kick_location = Some(point(*from));
                let kick = wire::AimlessKick { by_team, by_bot, location, kick_location };
                (Type::AimlessKick, Sent::AimlessKick(kick))
            }
            What::PossibleGoal { shot } => {
                (Type::PossibleGoal, Sent::PossibleGoal(self.goal(Some(shot), epoch_us, None)))
            }
            What::Goal { shot } => {
                let words = if shot.is_some() { "valid" } else { "awarded for a foul in a penalty" };
                (Type::Goal, Sent::Goal(self.goal(shot.as_ref(), epoch_us, Some(words.into()))))
            }
            What::InvalidGoal { shot, reason } => {
                let words = match reason {
                    Invalid::TooManyRobots => "too many robots".into(),
                    Invalid::TooHigh => format!("the ball was {:.2} m high", shot.max_height),
                    Invalid::RecentFoul(kind) => format!("recent foul: {}", kind.word()),
                };
                (Type::InvalidGoal, Sent::InvalidGoal(self.goal(Some(shot), epoch_us, Some(words))))
            }
            What::NoProgress { duration } => {
                let stuck = wire::NoProgressInGame { location, time: Some(*duration) };
                (Type::NoProgressInGame, Sent::NoProgressInGame(stuck))
            }
            What::DoubleTouch => {
                let touch = wire::AttackerDoubleTouchedBall { by_team, by_bot, location };
                (Type::AttackerDoubleTouchedBall, Sent::AttackerDoubleTouchedBall(touch))
            }
            What::KeeperHeldBall { duration } => {
                let held = wire::KeeperHeldBall { by_team, location, duration: Some(*duration) };
                (Type::KeeperHeldBall, Sent::KeeperHeldBall(held))
            }
            What::BoundaryCrossing => {
                let crossing = wire::BoundaryCrossing { by_team, location };
                (Type::BoundaryCrossing, Sent::BoundaryCrossing(crossing))
            }
            What::BallTooFast { speed, chipped } => {
                let (initial_ball_speed, chipped) = (Some(*speed), Some(*chipped));
                let kick =
                    wire::BotKickedBallTooFast { by_team, by_bot, location, initial_ball_speed, chipped };
                (Type::BotKickedBallTooFast, Sent::BotKickedBallTooFast(kick))
            }
            What::DribbledTooFar { end } => {
                let (start, end) = (location, Some(point(*end)));
                let dribble = wire::BotDribbledBallTooFar { by_team, by_bot, start, end };
                (Type::BotDribbledBallTooFar, Sent::BotDribbledBallTooFar(dribble))
            }
            What::HeldBall { duration } => {
                let duration = Some(*duration);
                let held = wire::BotHeldBallDeliberately { by_team, by_bot, location, duration };
                (Type::BotHeldBallDeliberately, Sent::BotHeldBallDeliberately(held))
            }
            What::PlacementSucceeded { took, precision, distance } => {
                let placed = wire::PlacementSucceeded {
                    by_team,
                    time_taken: Some(*took),
                    precision: Some(*precision),
                    distance: Some(*distance),
                };
                (Type::PlacementSucceeded, Sent::PlacementSucceeded(placed))
            }
            What::PlacementFailed { remaining, nearest } => {
                let failed = wire::PlacementFailed {
                    by_team,
                    remaining_distance: Some(*remaining),
                    nearest_own_bot_distance: Some(*nearest),
                };
                (Type::PlacementFailed, Sent::PlacementFailed(failed))
            }
            What::PenaltyFailed { reason } => {
                let failed = wire::PenaltyKickFailed { by_team, location, reason: Some(reason.words()) };
                (Type::PenaltyKickFailed, Sent::PenaltyKickFailed(failed))
            }
            What::MultipleFouls { caused_by } => {
                let caused_game_events =
                    caused_by.iter().filter_map(|event| event.to_wire(epoch_us)).collect();
                (
                    Type::MultipleFouls,
                    Sent::MultipleFouls(wire::MultipleFouls { by_team, caused_game_events }),
                )
            }
            What::MultipleCards => {
                (Type::MultipleCards, Sent::MultipleCards(wire::MultipleCards { by_team }))
            }
            What::TooManyRobots { allowed, on_field, ball } => {
                let many = wire::TooManyRobots {
                    by_team,
                    num_robots_allowed: Some(*allowed as i32),
                    num_robots_on_field: Some(*on_field as i32),
                    ball_location: Some(point(*ball)),
                };
                (Type::TooManyRobots, Sent::TooManyRobots(many))
            }
            _ => return self.robots_foul(),
        })
    }

    /// Fouls of one robot: acts against other robots, or a forbidden position.
    fn robots_foul(&self) -> Option<(Type, Sent)> {
        let by_team = team(self.by);
        let by_bot = self.robot.map(number);
        let location = Some(point(self.place));
        Some(match &self.what {
            What::AttackerTooClose { distance, ball } => {
                let (distance, ball_location) = (Some(*distance), Some(point(*ball)));
                let close = wire::AttackerTooCloseToDefenseArea {
                    by_team,
                    by_bot,
                    location,
                    distance,
                    ball_location,
                };
                (Type::AttackerTooCloseToDefenseArea, Sent::AttackerTooCloseToDefenseArea(close))
            }
            What::AttackerTouchedBall { depth } => {
                let distance = Some(*depth);
                let touch = wire::AttackerTouchedBallInDefenseArea { by_team, by_bot, location, distance };
                (Type::AttackerTouchedBallInDefenseArea, Sent::AttackerTouchedBallInDefenseArea(touch))
            }
            What::DefenderInArea { depth } => {
                let distance = Some(*depth);
                let inside = wire::DefenderInDefenseArea { by_team, by_bot, location, distance };
                (Type::DefenderInDefenseArea, Sent::DefenderInDefenseArea(inside))
            }
            What::DefenderTooClose { distance } => {
                let distance = Some(*distance);
                let close = wire::DefenderTooCloseToKickPoint { by_team, by_bot, location, distance };
                (Type::DefenderTooCloseToKickPoint, Sent::DefenderTooCloseToKickPoint(close))
            }
            What::TooFastInStop { speed } => {
                let fast = wire::BotTooFastInStop { by_team, by_bot, location, speed: Some(*speed) };
                (Type::BotTooFastInStop, Sent::BotTooFastInStop(fast))
            }
            What::InterferedPlacement => {
                let stands = wire::BotInterferedPlacement { by_team, by_bot, location };
                (Type::BotInterferedPlacement, Sent::BotInterferedPlacement(stands))
            }
            What::CrashUnique { victim, crash_speed, speed_difference, angle } => {
                let crash = wire::BotCrashUnique {
                    by_team,
                    violator: by_bot,
                    victim: Some(number(*victim)),
                    location,
                    crash_speed: Some(*crash_speed),
                    speed_diff: Some(*speed_difference),
                    crash_angle: Some(*angle),
                };
                (Type::BotCrashUnique, Sent::BotCrashUnique(crash))
            }
            What::CrashDrawn { yellow, blue, crash_speed, speed_difference, angle } => {
                let crash = wire::BotCrashDrawn {
                    bot_yellow: Some(number(*yellow)),
                    bot_blue: Some(number(*blue)),
                    location,
                    crash_speed: Some(*crash_speed),
                    speed_diff: Some(*speed_difference),
                    crash_angle: Some(*angle),
                };
                (Type::BotCrashDrawn, Sent::BotCrashDrawn(crash))
            }
            What::Pushed { victim, distance } => {
                let push = wire::BotPushedBot {
                    by_team,
                    violator: by_bot,
                    victim: Some(number(*victim)),
                    location,
                    pushed_distance: Some(*distance),
                };
                (Type::BotPushedBot, Sent::BotPushedBot(push))
            }
            _ => return None,
        })
    }

    fn goal(&self, shot: Option<&Shot>, epoch_us: u64, message: Option<String>) -> wire::Goal {
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
