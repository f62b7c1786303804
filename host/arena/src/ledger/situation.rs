//! `situation`: a team's possessions by how they began (at a kind of restart, or in play in one of the
//! halves), how many of them a case played, and what came of them. s, field frame.

use std::collections::BTreeMap;

use geometry::{Field, Point};
use rules::{Colour, FieldSpec, Phase};

use super::table::{Followed, SituationTally, add};
use super::{REBOUND_WITHIN, TeamLedger};
use crate::attack::{AttackWatch, BallEvent, BallLook, POSSESSION_LASTS};

geometry::labels! {
    /// How a possession began.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Situation {
        /// The team's kick-off.
        KickOff = "kick-off",
        /// A free kick within 1.2 m of the own goal line: goal kicks lie 1 m from it.
        GoalKick = "goal-kick",
        /// Another free kick in the own half.
        OwnHalf = "free-kick-own-half",
        /// A free kick in the other half.
        TheirHalf = "free-kick-their-half",
        /// A free kick within 0.5 m of the opponents' goal line: corner kicks lie 0.2 m from it.
        Corner = "corner",
        /// The ball was won in the own half.
        PlayOwnHalf = "play-own-half",
        /// The ball was won in the other half.
        PlayTheirHalf = "play-their-half",
    }
}

/// A possession: from the moment at which the restart may be taken or the ball is won, until the ball is
/// lost or play stops.
#[derive(Clone, Copy, Debug)]
struct Possession {
    team: Colour,
    situation: Situation,
    from: f64,
    until: Option<f64>,
    followed: Followed,
}

impl Possession {
    fn is_deflection(&self) -> bool {
        let lasted = self.until.map_or(f64::INFINITY, |until| until - self.from);
        let in_play = matches!(self.situation, Situation::PlayOwnHalf | Situation::PlayTheirHalf);
        in_play && lasted < POSSESSION_LASTS && self.followed < Followed::Shot
    }
}

/// The possessions of both teams, in the order of time.
#[derive(Clone, Debug, Default)]
pub(super) struct Possessions {
    all: Vec<Possession>,
    /// The phase of the moment before: a restart begins with its phase.
    phase: Option<Phase<Colour>>,
    /// Until when a goal belongs to the last shot of this possession.
    rebound: Option<(usize, f64)>,
}

impl Possessions {
    /// Takes a moment of the match that `attack` has taken.
    pub(super) fn look(&mut self, look: &BallLook<'_>, attack: &AttackWatch) {
        for event in attack.events() {
            self.follow(look.now, event);
        }
        let before = self.phase.replace(look.phase);
        let begun = match look.phase {
            Phase::FreeKick(team) | Phase::Kickoff(team) if before != Some(look.phase) => Some((team, true)),
            Phase::Run => attack.possession().map(|team| (team, false)),
            _ => None,
        };
        let Some((team, restarts)) = begun else { return };
        if !restarts && self.open().is_some_and(|open| open.team == team) {
            return;
        }
        // A restart that the other team played first.
        self.end(look.now, Followed::Loss);
        let end = look.own_ends[team as usize].sign() as f32;
        let situation = Situation::of(look.phase, look.field, look.ball, end);
        let followed = Followed::Nothing;
        self.all.push(Possession { team, situation, from: look.now, until: None, followed });
    }

    fn follow(&mut self, now: f64, event: &BallEvent) {
        match *event {
            BallEvent::Shot { by } => {
                if let Some(open) = self.open().filter(|open| open.team == by.colour) {
                    open.followed = Followed::Shot;
                }
            }
            BallEvent::Goal { team } => {
                let rebound = self.rebound.take().filter(|(_, until)| now <= *until).map(|(place, _)| place);
                let place = rebound.or(self.all.len().checked_sub(1));
                let scored = place.and_then(|place| self.all.get_mut(place));
                if let Some(scored) = scored.filter(|possession| possession.team == team) {
                    scored.followed = Followed::Goal;
                }
            }
            BallEvent::Lost { team, end } if self.open().is_some_and(|open| open.team == team) => {
                let followed = Followed::from(end);
                if followed == Followed::Shot {
                    self.rebound = Some((self.all.len() - 1, now + REBOUND_WITHIN));
                }
                self.end(now, followed);
            }
            BallEvent::Stopped => self.end(now, Followed::Stop),
            _ => {}
        }
    }

    fn open(&mut self) -> Option<&mut Possession> {
        self.all.last_mut().filter(|last| last.until.is_none())
    }

    fn end(&mut self, now: f64, followed: Followed) {
        if let Some(open) = self.open() {
            open.until = Some(now);
            open.followed = open.followed.max(followed);
        }
    }

    /// The possessions of a team by situation, with its plays of cases.
    pub(super) fn of(
        &self,
        team: Colour,
        ledger: &TeamLedger,
        over: bool,
    ) -> BTreeMap<String, SituationTally> {
        let possessions = self.all.iter().filter(|had| had.team == team && !had.is_deflection());
        let possessions: Vec<_> = possessions.collect();
        let mut plays = vec![Vec::new(); possessions.len()];
        for (from, until, end) in ledger.spans(over) {
            // A case may be decided on before the ball is won, and go on in the next possession.
            let place = possessions
                .iter()
                .position(|had| had.from <= until && had.until.is_none_or(|end| end >= from));
            if let Some(place) = place {
                plays[place].push(end);
            }
        }
        let mut tallies = BTreeMap::<String, SituationTally>::new();
        for (possession, plays) in possessions.into_iter().zip(plays) {
            let tally = tallies.entry(possession.situation.label().to_owned()).or_default();
            tally.possessions += 1;
            tally.plays += plays.len() as u32;
            tally.with_case += u32::from(!plays.is_empty());
            for end in plays {
                add(&mut tally.ends, end, 1);
            }
            add(&mut tally.followed_by, possession.followed.label(), 1);
        }
        tallies
    }
}

impl Situation {
    /// Where a ball that lies there, in that phase, is the ball of a team that defends the end of this sign.
    fn of(phase: Phase<Colour>, field: &FieldSpec, ball: Point<Field>, end: f32) -> Self {
        // From the own goal line.
        let ahead = 0.5 * field.length + ball.x() * -end;
        let own = ahead < 0.5 * field.length;
        match phase {
            Phase::Kickoff(_) => Self::KickOff,
            Phase::FreeKick(_) if ahead < GOAL_KICK_WITHIN => Self::GoalKick,
            Phase::FreeKick(_) if ahead > field.length - CORNER_WITHIN => Self::Corner,
            Phase::FreeKick(_) if own => Self::OwnHalf,
            Phase::FreeKick(_) => Self::TheirHalf,
            _ if own => Self::PlayOwnHalf,
            _ => Self::PlayTheirHalf,
        }
    }
}

/// Distance from the own goal line within which a free kick is a goal kick, m: 1 m (rules), and what a
/// placement errs by.
const GOAL_KICK_WITHIN: f32 = 1.2;
/// Distance from the opponents' goal line within which a free kick is a corner kick, m: 0.2 m (rules), and
/// what a placement errs by.
const CORNER_WITHIN: f32 = 0.5;

#[cfg(test)]
mod tests {
    use geometry::GoalEnd;
    use protocol::{RobotId, Who};
    use rules::League;

    use super::*;

    const US: Colour = Colour::Blue;

    /// A match by hand: phases, the ball's x and robots at it, 100 looks a second from 0 s.
    struct ByHand {
        attack: AttackWatch,
        possessions: Possessions,
        ticks: u32,
        goals: u32,
    }

    impl ByHand {
        fn play(&mut self, phase: Phase<Colour>, x: f32, at_ball: Option<Colour>, ticks: u32) {
            let ball = Point::new(x, 0.0);
            let robots: Vec<_> =
                at_ball.map(|colour| (Who { colour, id: RobotId::ZERO }, ball)).into_iter().collect();
            for _ in 0..ticks {
                self.ticks += 1;
                let look = BallLook {
                    now: f64::from(self.ticks) * 0.01,
                    field: &League::DivisionB.field(),
                    ball,
                    height: 0.0,
                    robots: &robots,
                    phase,
                    score: [0, self.goals],
                    own_ends: [GoalEnd::Positive, GoalEnd::Negative],
                    contacts: &[],
                };
                self.attack.look(&look);
                self.possessions.look(&look, &self.attack);
            }
        }
    }

    #[test]
    fn possessions_count_where_they_began_and_a_restart_goes_on_in_play() {
        let mut game = ByHand {
            attack: AttackWatch::default(),
            possessions: Possessions::default(),
            ticks: 0,
            goals: 0,
        };
        let free_kick = Phase::FreeKick(US);
        game.play(Phase::Kickoff(US), 0.0, None, 50);
        game.play(Phase::Run, 0.0, Some(US), 50);
        // Theirs takes it, ours takes it back, and it goes out.
        game.play(Phase::Run, 1.0, Some(Colour::Yellow), 50);
        game.play(Phase::Run, -1.0, Some(US), 50);
        game.play(Phase::Stop, -4.6, None, 50);
        // A goal kick, a corner, from which ours scores, a free kick that theirs play first.
        game.play(free_kick, -3.5, Some(US), 50);
        game.play(Phase::Stop, -3.5, None, 50);
        game.play(free_kick, 4.3, None, 50);
        game.play(Phase::Run, 4.3, Some(US), 50);
        game.goals = 1;
        game.play(Phase::Stop, 4.6, None, 50);
        game.play(free_kick, 2.0, None, 50);
        game.play(Phase::Run, 2.0, Some(Colour::Yellow), 50);
        let ours = game.possessions.of(US, &TeamLedger::default(), true);
        let seen: Vec<_> = ours
            .iter()
            .map(|(name, tally)| {
                (name.as_str(), tally.possessions, tally.followed_by.keys().next().unwrap().as_str())
            })
            .collect();
        assert_eq!(
            seen,
            [
                ("corner", 1, "goal"),
                ("free-kick-their-half", 1, "loss"),
                ("goal-kick", 1, "stop"),
                ("kick-off", 1, "loss"),
                ("play-own-half", 1, "out"),
            ]
        );
        let theirs = game.possessions.of(Colour::Yellow, &TeamLedger::default(), true);
        assert_eq!(theirs.values().map(|tally| tally.possessions).sum::<u32>(), 2);
        assert!(theirs.contains_key("play-own-half"), "{theirs:?}");
    }
}
