//! `limits`: limits of the rules. Every number of the rules that players and referee need: m, m/s, s.
//!
//! Rules of 2026 (chapter in brackets); where a league differs the number is in [`Limits`]. Distances from a
//! robot are measured from its nearest side with an assumed radius of 0.09 m (playing environment), to the
//! ball's centre.

use crate::League;

/// Robots on STOP are slower than this, m/s (referee commands, stop). Not required in ball placement
/// (offenses).
pub const STOP_SPEED: f32 = 1.5;
/// Robots keep this far from the ball on STOP, at the opponents' kick-off and free kick, and from the line
/// between ball and target while opponents place, m (referee commands; offenses).
pub const BALL_DISTANCE: f32 = 0.5;
/// Time to brake after HALT, to slow down after STOP, to leave the opponents' defence area or the placement
/// stadium, s.
pub const GRACE: f32 = 2.0;
/// On STOP and at free kicks robots keep this far from the opponents' defence area, m (offenses).
pub const OPPONENT_AREA_DISTANCE: f32 = 0.2;
/// A ball that has moved this far from its place is in play, m (referee commands, ball in and out of play).
pub const IN_PLAY_DISTANCE: f32 = 0.05;
/// A kick-off is in play after this long at the latest, s (same).
pub const KICKOFF_TIME: f32 = 10.0;
/// A penalty ends after this long, s (referee commands, penalty kick).
pub const PENALTY_TIME: f32 = 10.0;
/// All but keeper and shooter are this far behind the ball at a penalty, m (same).
pub const PENALTY_BEHIND: f32 = 1.0;
/// A ball this near its mark lies for a kick-off or a penalty, m (ours: the game controller starts it within
/// 0.15 m).
pub const NEAR_MARK: f32 = 0.3;
/// Placing the ball may take this long, s (referee commands, ball placement).
pub const PLACEMENT_TIME: f32 = 30.0;
/// Time that an interference adds to it, s (offenses).
pub const PLACEMENT_EXTRA_TIME: f32 = 10.0;
/// A placed ball is this near its target, m (referee commands, ball placement).
pub const PLACEMENT_TOLERANCE: f32 = 0.15;
/// Robots are this far from a placed ball where the placing team's free kick follows, m (same).
pub const PLACEMENT_CLEARANCE: f32 = 0.05;
/// Play continues no earlier than this after the command to place, s (same).
pub const PLACEMENT_TIME_MIN: f32 = 2.0;
/// Failures after which a team places no more in this half (same).
pub const PLACEMENT_FAILURES_MAX: u32 = 5;
/// No placement is needed nearer than this to the target, m (same).
pub const PLACEMENT_SKIP_DISTANCE: f32 = 1.0;
/// Least distance of the ball from both defence areas where no placement is needed, m (same).
pub const PLACEMENT_SKIP_AREA_DISTANCE: f32 = 0.7;
/// A ball slower than this is stationary, m/s. The rules give no number; trackers' noise on a stationary ball
/// stays below it.
pub const BALL_STILL: f32 = 0.05;
/// A goal counts up to this height of the ball after the scorers' last touch, m (scoring goals).
pub const GOAL_BALL_HEIGHT: f32 = 0.15;
/// No goal this soon after a foul that did not stop the game, s (scoring goals).
pub const GOAL_AFTER_FOUL: f32 = 2.0;
/// A collision with a greater speed difference along the line between the robots is a foul, m/s (offenses,
/// crashing).
pub const CRASH_SPEED: f32 = 1.5;
/// Difference of speeds below which a collision is both teams' foul, m/s (same).
pub const CRASH_DRAWN: f32 = 0.3;
/// The same foul that does not stop the game counts again after this, s (non stopping fouls).
pub const FOUL_REPEAT: f32 = 2.0;
/// Fouls for a yellow card (fouls).
pub const FOULS_PER_CARD: u32 = 3;
/// A yellow card's playing time, s (sanctions).
pub const YELLOW_CARD_TIME: f32 = 120.0;
/// Time to take the robot out, s (sanctions).
pub const CARD_REMOVAL_TIME: f32 = 10.0;
/// Yellow cards at a time; the next one is red (sanctions).
pub const YELLOW_CARDS_MAX: u32 = 2;
/// Playing time of a half and of the break, s (game structure).
pub const HALF_TIME: f32 = 300.0;
/// Playing time of a half of overtime, s (game structure).
pub const OVERTIME_HALF_TIME: f32 = 150.0;
/// Goals that end a game with a lead of [`GOALS_LEAD`] or more (game structure).
pub const GOALS_MAX: u32 = 10;
/// Lead with which [`GOALS_MAX`] goals end a game (game structure).
pub const GOALS_LEAD: u32 = 2;
/// Time-outs of a team (game structure).
pub const TIMEOUTS: u32 = 4;
/// Total time of a team's time-outs, s (game structure).
pub const TIMEOUT_TIME: f32 = 300.0;
/// Substitutions a half that are free (substitution).
pub const SUBSTITUTIONS: u32 = 5;
/// Reach of the centre substitution area from the halfway line, in the margin, m (substitution).
pub const SUBSTITUTION_REACH: f32 = 1.0;
/// Least distance from the ball of a robot that is substituted, m (substitution).
pub const SUBSTITUTION_BALL_DISTANCE: f32 = 0.5;
/// The radius that the rules assume for every robot, m (playing environment).
pub const ROBOT_RADIUS: f32 = 0.09;
/// The greatest height of a robot, m (robots).
pub const ROBOT_HEIGHT: f32 = 0.15;
/// The ball's radius, m: a golf ball of 43 mm (playing environment).
pub const BALL_RADIUS: f32 = 0.0215;
/// Largest share of the ball that a robot covers, seen from above (robots).
pub const BALL_COVERED: f32 = 0.2;
/// Time that teams have to take their places for a kick-off or penalty, s (the game controller's setting).
pub const PREPARE_TIME: f32 = 10.0;
/// Number of valid robot numbers: 0 to 15 (robots).
pub const ROBOT_IDS: u32 = 16;
/// Most robots of a team on any field of these leagues.
pub const ROBOTS_MAX: usize = 11;

/// Limits that differ between the leagues with a referee of the Small Size League.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Number of robots of a team, keeper included (robots).
    pub robots: u32,
    /// No robot may kick faster than this, m/s, in three dimensions (offenses, ball speed).
    pub ball_speed: f32,
    /// No robot may dribble farther than this, m, straight from the first contact (offenses, excessive
    /// dribbling).
    pub dribble: f32,
    /// A free kick is in play after this, s (referee commands, ball in and out of play).
    pub free_kick_time: f32,
    /// The keeper's team holds the ball in its area for at most this, s (offenses).
    pub keeper_hold: f32,
    /// Play without progress for this time is stopped, s (offenses, no progress).
    pub no_progress: f32,
    /// True where a kick from the own half over their goal line is "aimless" (ball leaves the field).
    pub aimless_kick: bool,
    /// True where teams must place the ball; else they may decline (referee commands, ball placement).
    pub placement_is_mandatory: bool,
    /// Least distance of a free kick from every line, m (referee commands, free kick).
    pub spot_line_distance: f32,
    /// Least distance of a free kick from both defence areas, m (referee commands, free kick).
    pub spot_area_distance: f32,
    /// Distance of a goal kick from the goal line, m (ball leaves the field).
    pub goal_kick_distance: f32,
}

/// Rules of 2026, division B.
const DIVISION_B: Limits = Limits {
    robots: 6,
    ball_speed: 6.5,
    dribble: 1.0,
    free_kick_time: 10.0,
    keeper_hold: 10.0,
    no_progress: 10.0,
    aimless_kick: true,
    placement_is_mandatory: false,
    spot_line_distance: 0.2,
    spot_area_distance: 1.0,
    goal_kick_distance: 1.0,
};

impl League {
    /// Limits of the league; `None` for the four-legged league, whose rules are in the scenarios of the first
    /// paper.
    pub const fn limits(self) -> Option<Limits> {
        match self {
            Self::FourLegged => None,
            // Biswas et al. 2014: shots at 8 m/s (§1), dribbling at most 0.5 m (§3), free kicks within 10 s
            // and defenders 0.5 m away (§4). From defence areas 0.2 m, as the league's programs of 2013 and
            // 2014 carried it. What neither states (lines, goal kick, keeper, no progress) is division B's;
            // on a field of 4 m the goal kick moves to half a metre, so that it stays out of reach of the
            // area.
            Self::Ssl2013 => Some(Limits {
                ball_speed: 8.0,
                dribble: 0.5,
                aimless_kick: false,
                spot_area_distance: 0.2,
                goal_kick_distance: 0.5,
                ..DIVISION_B
            }),
            Self::DivisionB => Some(DIVISION_B),
            Self::DivisionA => Some(Limits {
                robots: 11,
                free_kick_time: 5.0,
                keeper_hold: 5.0,
                no_progress: 5.0,
                aimless_kick: false,
                placement_is_mandatory: true,
                ..DIVISION_B
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_divisions_differ_where_the_rules_say_so() {
        let [a, b] = [League::DivisionA, League::DivisionB].map(|league| league.limits().unwrap());
        assert_eq!((a.robots, b.robots), (11, 6));
        assert_eq!((a.free_kick_time, b.free_kick_time), (5.0, 10.0));
        assert_eq!((a.keeper_hold, b.keeper_hold, a.no_progress, b.no_progress), (5.0, 10.0, 5.0, 10.0));
        assert_eq!((a.aimless_kick, b.aimless_kick), (false, true));
        assert_eq!((a.ball_speed, b.ball_speed, a.dribble, b.dribble), (6.5, 6.5, 1.0, 1.0));
        let paper = League::Ssl2013.limits().unwrap();
        assert_eq!((paper.ball_speed, paper.dribble, paper.robots), (8.0, 0.5, 6));
        assert_eq!(League::FourLegged.limits(), None);
    }
}
