//! `event`: game events. The rules' table of game events, with the evidence of each.
//!
//! Rules 2026, appendix "game events". m, m/s, s, field frame.

use geometry::{Field, Point};
use protocol::{Instant, RobotId, Who};
use rules::Colour;

use super::reason::Reason;

/// An observation or decision of the referee.
#[derive(Clone, Debug, PartialEq)]
pub struct RefereeEvent {
    /// Time, µs of the simulation.
    pub at: Instant,
    /// The team that caused it; `None` where no team or both did.
    pub by: Option<Colour>,
    /// The robot that caused it.
    pub robot: Option<RobotId>,
    /// Position of the event, m, field frame.
    pub place: Point<Field>,
    /// The event with its evidence.
    pub what: What,
}

/// A ball in a goal; [`RefereeEvent::by`] is the team that scores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotEvent {
    /// The robot that touched the ball last, of either team.
    pub kicker: Option<Who>,
    /// Position of the ball at that touch, m.
    pub from: Point<Field>,
    /// Maximum height of the ball since the scoring team's last touch, m.
    pub max_height: f32,
    /// Time of the scoring team's last touch.
    pub last_touch: Option<Instant>,
    /// Number of robots that the scoring team had on the field.
    pub robots: u32,
}

/// Reason for which a ball in the goal does not count (rules: scoring goals).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Invalid {
    /// The scoring team had more robots than allowed.
    TooManyRobots,
    /// The ball was above 0.15 m after the scoring team's last touch.
    TooHigh,
    /// The scoring team had committed a foul that does not stop the game less than 2 s before.
    RecentFoul(Kind),
}

/// Reason for which a penalty gave no goal (rules: penalty kick).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PenaltyEnd {
    /// The ball crossed a line elsewhere.
    Out,
    /// The keeper deflected it by 90° or more.
    Saved,
    /// The ball moved away from the goal.
    MovedBack,
    /// The shooting team broke a rule.
    Foul(Kind),
    /// 10 s were over.
    TimeUp,
}

impl PenaltyEnd {
    /// Text of the league's message.
    pub fn message(self) -> String {
        match self {
            Self::Out => "ball left the field".into(),
            Self::Saved => "saved by the keeper".into(),
            Self::MovedBack => "ball moved away from the goal".into(),
            Self::Foul(kind) => format!("foul of the shooting team: {}", kind.label()),
            Self::TimeUp => "time is up".into(),
        }
    }
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident $({ $($(#[$fdoc:meta])* $field:ident: $type:ty),+ $(,)? })? = $label:literal),+ $(,)?) => {
        /// A game event, with its evidence.
        #[derive(Clone, Debug, PartialEq)]
        pub enum What { $($(#[$doc])* $kind $({ $($(#[$fdoc])* $field: $type),+ })?),+ }

        /// The kind of an event, without the evidence: for counting.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Kind { $($(#[$doc])* $kind),+ }

        impl Kind {
            /// All kinds, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// The league's name of it in lower case, as in reports; ours where the league has none.
            pub const fn label(self) -> &'static str {
                match self { $(Self::$kind => $label),+ }
            }
        }

        impl What {
            /// Kind of the event, without the evidence.
            pub const fn kind(&self) -> Kind {
                match self { $(Self::$kind { .. } => Kind::$kind),+ }
            }
        }
    };
}

kinds! {
    /// The whole ball crossed a touch line.
    LeftTouchLine = "ball_left_field_touch_line",
    /// The ball crossed a goal line outside the goal.
    LeftGoalLine = "ball_left_field_goal_line",
    /// The same, kicked from the own half and touched by no other robot (division B).
    AimlessKick {
        /// Position of the kick, m.
        from: Point<Field>,
    } = "aimless_kick",
    /// The ball is in a goal; not judged yet.
    PossibleGoal {
        /// The shot that brought it there.
        shot: ShotEvent,
    } = "possible_goal",
    /// The goal counts: the score rises.
    Goal {
        /// The shot; `None` where the goal is awarded for a foul in a penalty.
        shot: Option<ShotEvent>,
    } = "goal",
    /// The goal does not count.
    InvalidGoal {
        /// The shot that brought it there.
        shot: ShotEvent,
        /// Rule by which it does not count.
        reason: Invalid,
    } = "invalid_goal",
    /// The ball stayed where it was.
    NoProgress {
        /// Time that it stayed there, s.
        duration: f32,
    } = "no_progress_in_game",
    /// The kicker of a kick-off or free kick touched the ball again.
    DoubleTouch = "attacker_double_touched_ball",
    /// The ball stayed in a defence area, held by the keeper of its team.
    KeeperHeldBall {
        /// Time that it was held, s.
        duration: f32,
    } = "keeper_held_ball",
    /// The ball was kicked over the wall around the field surface; the place is that of the kick.
    BoundaryCrossing = "boundary_crossing",
    /// A ball over the speed limit.
    BallTooFast {
        /// Speed in 3-D, m/s.
        speed: f32,
        /// True where the ball flew after the kick.
        chipped: bool,
    } = "bot_kicked_ball_too_fast",
    /// Dribbled farther than allowed; the place is the start of the contact.
    DribbledTooFar {
        /// Position where it exceeded the limit, m.
        end: Point<Field>,
    } = "bot_dribbled_ball_too_far",
    /// A robot within 0.2 m of the opponents' defence area in stop or at a free kick; the event's position is
    /// the robot's.
    AttackerTooClose {
        /// Distance from the area, m.
        distance: f32,
        /// Position of the ball, m.
        ball: Point<Field>,
    } = "attacker_too_close_to_defense_area",
    /// A robot partly in the opponents' defence area touched the ball.
    AttackerTouchedBall {
        /// Depth within the area, m.
        depth: f32,
    } = "attacker_touched_ball_in_defense_area",
    /// A robot other than the keeper touched the ball when entirely in its own defence area.
    DefenderInArea {
        /// Depth within the area, m.
        depth: f32,
    } = "defender_in_defense_area",
    /// A robot within 0.5 m of the ball at the opponents' kick-off or free kick.
    DefenderTooClose {
        /// Distance from the ball, m.
        distance: f32,
    } = "defender_too_close_to_kick_point",
    /// A robot faster than 1.5 m/s during a stop.
    TooFastInStop {
        /// Speed of the robot, m/s.
        speed: f32,
    } = "bot_too_fast_in_stop",
    /// A robot stood too near the line from ball to target in a placement of the other team.
    InterferedPlacement = "bot_interfered_placement",
    /// Two robots of different teams collided; the faster one is at fault.
    CrashUnique {
        /// The other robot's shell number.
        victim: RobotId,
        /// Difference of the velocities along the line between the two, m/s.
        crash_speed: f32,
        /// Difference of the two speeds, m/s.
        speed_difference: f32,
        /// Angle between the difference of the velocities and the line between the two, rad.
        angle: f32,
    } = "bot_crash_unique",
    /// Two robots of different teams collided; both are at fault.
    CrashDrawn {
        /// Number of yellow's robot.
        yellow: RobotId,
        /// Number of blue's robot.
        blue: RobotId,
        /// Difference of the velocities along the line between the two, m/s.
        crash_speed: f32,
        /// Difference of the two speeds, m/s.
        speed_difference: f32,
        /// Angle between the difference of the velocities and the line between the two, rad.
        angle: f32,
    } = "bot_crash_drawn",
    /// A robot pushed an opponent.
    Pushed {
        /// The other robot's shell number.
        victim: RobotId,
        /// Distance that it was pushed, m.
        distance: f32,
    } = "bot_pushed_bot",
    /// A team's robots enclosed the ball.
    HeldBall {
        /// Time that they held it, s.
        duration: f32,
    } = "bot_held_ball_deliberately",
    /// More robots than allowed, for longer than the time for taking one off.
    TooManyRobots {
        /// Number of robots allowed.
        allowed: u32,
        /// Number of robots on the field.
        on_field: u32,
        /// Position of the ball, m.
        ball: Point<Field>,
    } = "too_many_robots",
    /// A penalty gave no goal.
    PenaltyFailed {
        /// Reason of its end without a goal.
        reason: PenaltyEnd,
    } = "penalty_kick_failed",
    /// The ball is at its target.
    PlacementSucceeded {
        /// Time from the order to the end, s.
        took: f32,
        /// Distance from ball to target, m.
        precision: f32,
        /// Distance from its start position to the target, m.
        distance: f32,
    } = "placement_succeeded",
    /// The ball is not at its target, and time is up.
    PlacementFailed {
        /// Distance from ball to target, m.
        remaining: f32,
        /// The placing team's nearest robot to the target, m; negative without one.
        nearest: f32,
    } = "placement_failed",
    /// Every third foul: a yellow card.
    MultipleFouls {
        /// The three fouls, oldest first.
        caused_by: Vec<RefereeEvent>,
    } = "multiple_fouls",
    /// A third active yellow card: it turns red.
    MultipleCards = "multiple_cards",
    /// A robot moved more than 2 s after a halt (ours: the league's automatic referees do not check it).
    MovedInHalt {
        /// Speed of the robot, m/s.
        speed: f32,
    } = "bot_moved_in_halt",
    /// The match has stood for longer than the referee's patience (ours: the league's game controller waits
    /// without a message).
    Blocked {
        /// Obstacle that keeps the game from continuing.
        reason: Reason,
    } = "blocked",
    /// A robot within 0.5 m of the ball in stop after 2 s (ours: the rules leave it to the human referee).
    TooCloseInStop {
        /// Distance from the ball, m.
        distance: f32,
    } = "bot_too_close_to_ball_in_stop",
}

/// Restart of the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restart {
    /// From the centre, by this team.
    Kickoff(Colour),
    /// From the penalty mark.
    Penalty(Colour),
    /// From the position of the event, or the nearest valid one.
    FreeKick(Colour),
    /// By both teams, where the ball lies.
    ForceStart,
}

impl Restart {
    /// The team that takes it; `None` for a force start.
    pub const fn team(self) -> Option<Colour> {
        match self {
            Self::Kickoff(team) | Self::Penalty(team) | Self::FreeKick(team) => Some(team),
            Self::ForceStart => None,
        }
    }

    /// True where the ball is placed on a mark by hand.
    pub const fn is_set_by_hand(self) -> bool {
        matches!(self, Self::Kickoff(_) | Self::Penalty(_))
    }
}

impl Kind {
    /// True for an event that raises the foul counter, which leads to yellow cards.
    /// ([`Kind::InterferedPlacement`] only the first time in a placement.)
    pub const fn is_foul(self) -> bool {
        matches!(
            self,
            Self::AttackerTooClose
                | Self::Pushed
                | Self::HeldBall
                | Self::BoundaryCrossing
                | Self::KeeperHeldBall
                | Self::DribbledTooFar
                | Self::InterferedPlacement
                | Self::TooFastInStop
                | Self::DefenderTooClose
        ) || self.is_non_stopping_foul()
    }

    /// True for a foul that does not stop the game.
    pub const fn is_non_stopping_foul(self) -> bool {
        matches!(self, Self::AttackerTouchedBall | Self::BallTooFast | Self::CrashUnique | Self::CrashDrawn)
    }

    /// True for an offence of a team, sanctioned or not: reports count it as a foul.
    pub const fn is_offence(self) -> bool {
        self.is_foul()
            || matches!(
                self,
                Self::DoubleTouch
                    | Self::DefenderInArea
                    | Self::TooManyRobots
                    | Self::MovedInHalt
                    | Self::TooCloseInStop
            )
    }

    /// True for an event that stops a running game.
    pub const fn stops_the_game(self) -> bool {
        matches!(
            self,
            Self::LeftTouchLine
                | Self::LeftGoalLine
                | Self::AimlessKick
                | Self::AttackerTooClose
                | Self::DefenderInArea
                | Self::BoundaryCrossing
                | Self::KeeperHeldBall
                | Self::DribbledTooFar
                | Self::Pushed
                | Self::HeldBall
                | Self::DoubleTouch
                | Self::TooManyRobots
                | Self::NoProgress
                | Self::PenaltyFailed
                | Self::PlacementSucceeded
                | Self::PlacementFailed
                | Self::InvalidGoal
                | Self::Goal
        )
    }

    /// True for an event that decides a penalty: a goal where the defenders commit it, no goal where the
    /// shooting team does.
    pub const fn decides_a_penalty(self) -> bool {
        self.is_non_stopping_foul()
            || matches!(self, Self::BoundaryCrossing | Self::DribbledTooFar | Self::Pushed)
    }

    /// Restart after the event; `None` where it changes nothing.
    pub const fn restart(self, by: Option<Colour>) -> Option<Restart> {
        match (self, by) {
            (Self::NoProgress | Self::TooManyRobots, _) => Some(Restart::ForceStart),
            (Self::Goal, Some(by)) => Some(Restart::Kickoff(by.other())),
            (Self::DefenderInArea, Some(by)) => Some(Restart::Penalty(by.other())),
            (
                Self::LeftTouchLine
                | Self::LeftGoalLine
                | Self::AimlessKick
                | Self::AttackerTooClose
                | Self::Pushed
                | Self::HeldBall
                | Self::KeeperHeldBall
                | Self::BoundaryCrossing
                | Self::DribbledTooFar
                | Self::DoubleTouch
                | Self::PenaltyFailed
                | Self::InvalidGoal,
                Some(by),
            ) => Some(Restart::FreeKick(by.other())),
            _ => None,
        }
    }

    /// True for an event by which the ball left the field.
    pub const fn is_ball_out(self) -> bool {
        matches!(self, Self::LeftTouchLine | Self::LeftGoalLine | Self::AimlessKick | Self::PossibleGoal)
    }
}
