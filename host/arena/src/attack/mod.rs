//! `attack`: what a team makes of the ball: how its possessions end, where its kicks go, what its shots were
//! worth, and which balls it leaves. In a simulated match from the true world; of a recording, and on a real
//! field, as a host sees it ([`HostView`]). s, m, m/s, field frame.
//!
//! | word | meaning |
//! |---|---|
//! | possession | from the moment at which robots of one team alone are at the ball, or one of them kicks it, until the other team is, or play stops; of 0.25 s and longer |
//! | at the ball | the ball on the ground within 0.125 m of a robot's centre |
//! | kick | faster than 1 m/s, and 0.5 m long before another robot touches it or play stops |
//! | shot | a kick faster than 3 m/s at a point of the goal line within 0.25 m beside the posts |
//! | volley | a shot within 0.12 s of the ball's arrival from a teammate's kick |
//! | open | share of the goal's opening to which no opponent's body blocks the line at the kick |
//! | left ball | a robot has the ball with no opponent within 0.45 m of it, and 0.8 s later the ball still lies there and the robot is more than 0.25 m away |

mod counts;
mod host_view;
mod left;
mod look;

use geometry::{Field, Point, Segment, Vector};
use protocol::Who;
use rules::contact::TOUCHES_WITHIN;
use rules::limits::{BALL_RADIUS, ROBOT_HEIGHT, ROBOT_RADIUS};
use rules::{Colour, Phase};

pub use counts::{AttackCounts, PossessionEnd, ShotCounts};
pub use host_view::HostView;
pub use look::{BallContact, BallLook};

use left::LeftBalls;

/// Event of the ball, as it becomes known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallEvent {
    /// A kick that is no shot is over: another robot has the ball, or play has stopped.
    Kick {
        /// The robot that kicked.
        by: Who,
        /// Time of the kick, s.
        at: f64,
        /// A teammate has the ball.
        arrived: bool,
    },
    /// A shot was made.
    Shot {
        /// The robot that shot.
        by: Who,
    },
    /// A team's possession is over, deflections among them.
    Lost {
        /// The team that had the ball.
        team: Colour,
        /// End of its possession.
        end: PossessionEnd,
    },
    /// The team has scored.
    Goal {
        /// The team that scored.
        team: Colour,
    },
    /// Play has stopped.
    Stopped,
    /// Play goes on after a stop.
    Resumed,
}

/// Counts of both teams, and the play that is running.
#[derive(Clone, Debug, Default)]
pub struct AttackWatch {
    counts: [AttackCounts; 2],
    possession: Option<Possession>,
    flight: Option<Flight>,
    /// The team that alone is at the ball, but does not possess it yet, since when.
    claims: Option<(Colour, f64)>,
    /// The robot that a teammate's kick has reached last, and when.
    received: Option<(Who, f64)>,
    goals: [u32; 2],
    left: LeftBalls,
    runs: bool,
    events: Vec<BallEvent>,
}

/// The ball of one team.
#[derive(Clone, Copy, Debug)]
struct Possession {
    team: Colour,
    since: f64,
    /// Last moment at which an opponent was near the ball while one of its robots was at it.
    pressed: f64,
}

/// A kicked ball that no other robot has touched.
#[derive(Clone, Copy, Debug)]
struct Flight {
    by: Who,
    at: f64,
    from: Point<Field>,
    speed: f32,
    shot: bool,
    /// Reported as over, though the ball is not controlled yet.
    landed: bool,
}

impl Flight {
    fn is_kick(&self, ball: Point<Field>) -> bool {
        self.from.distance(ball) >= KICK_LENGTH
    }
}

impl AttackWatch {
    /// Takes a moment of the match; the events up to it replace those of the moment before.
    pub fn look(&mut self, look: &BallLook<'_>) {
        self.events.clear();
        let now = look.now;
        let scored =
            Colour::ALL.into_iter().find(|team| look.score[*team as usize] > self.goals[*team as usize]);
        self.goals = look.score;
        let plays = matches!(look.phase, Phase::Run | Phase::FreeKick(_) | Phase::Kickoff(_));
        if plays && !self.runs {
            self.events.push(BallEvent::Resumed);
        }
        for contact in look.contacts {
            match *contact {
                BallContact::Kicked { by, at, from, velocity } => self.kicked(look, at, by, from, velocity),
                BallContact::Touched { by, at } => self.touched(now, by, at),
            }
        }
        if !plays || scored.is_some() {
            self.stopped(now, look.ball, scored, look.is_out());
            self.events.extend(scored.map(|team| BallEvent::Goal { team }));
            if self.runs {
                self.events.push(BallEvent::Stopped);
            }
            self.runs = false;
            return;
        }
        self.runs = true;
        self.control(look);
        let run = look.phase == Phase::Run;
        for team in self.left.look(now, look.ball, look.robots.iter().copied(), run) {
            self.counts[team as usize].left_balls += 1;
        }
    }

    /// Events of the last moment.
    pub fn events(&self) -> &[BallEvent] {
        &self.events
    }

    /// The team that has the ball, or had it last in this spell of play.
    pub fn possession(&self) -> Option<Colour> {
        self.possession.map(|possession| possession.team)
    }

    /// The counts of a team.
    pub fn of(&self, team: Colour) -> &AttackCounts {
        &self.counts[team as usize]
    }

    fn kicked(&mut self, look: &BallLook<'_>, at: f64, by: Who, from: Point<Field>, velocity: Vector<Field>) {
        let (now, speed) = (look.now, velocity.norm());
        if speed < KICK_SPEED {
            return;
        }
        if self.flight.is_some_and(|flight| flight.by != by) {
            self.land(now, from, Some(by));
        }
        let arrived = self.received.filter(|(who, _)| *who == by).map_or(f64::NEG_INFINITY, |(_, at)| at);
        self.possess(now, by.colour);
        let shot = speed > SHOT_SPEED && is_at_goal(look, by.colour, from, velocity);
        if shot {
            let volley = now - arrived < VOLLEY_WITHIN;
            self.counts[by.colour as usize].shots.add(open_share(look, by.colour, from), volley);
            self.events.push(BallEvent::Shot { by });
        }
        self.flight = Some(Flight { by, at, from, speed, shot, landed: false });
    }

    fn touched(&mut self, now: f64, by: Who, at: Point<Field>) {
        if self.flight.is_some_and(|flight| flight.by != by) {
            self.land(now, at, Some(by));
        }
    }

    /// The flight is over: a robot has the ball, or play has stopped.
    fn land(&mut self, now: f64, at: Point<Field>, by: Option<Who>) {
        let Some(flight) = &mut self.flight else { return };
        let first = !std::mem::replace(&mut flight.landed, true);
        let flight = *flight;
        let to_team = by.is_some_and(|by| by.colour == flight.by.colour);
        if first && flight.is_kick(at) && !flight.shot {
            self.counts[flight.by.colour as usize].kick(flight.speed, flight.from.distance(at), to_team);
            self.events.push(BallEvent::Kick { by: flight.by, at: flight.at, arrived: to_team });
        }
        // A ball at the opponents is theirs when they control it: until then it was lost by this kick.
        if to_team {
            self.received = by.map(|by| (by, now));
            self.flight = None;
        }
    }

    /// Gives the ball to the team whose robots alone are at it, after [`CONTROLS_AFTER`].
    fn control(&mut self, look: &BallLook<'_>) {
        let now = look.now;
        let (mut at, mut near) = ([false; 2], [false; 2]);
        for (who, place) in look.robots.iter().filter(|_| look.height < ROBOT_HEIGHT) {
            let distance = place.distance(look.ball);
            at[who.colour as usize] |= distance < TOUCHES_WITHIN;
            near[who.colour as usize] |= distance < PRESSES_WITHIN;
        }
        if let Some(possession) = &mut self.possession
            && at[possession.team as usize]
            && near[possession.team.other() as usize]
        {
            possession.pressed = now;
        }
        let alone = Colour::ALL.into_iter().find(|team| at[*team as usize] && !at[team.other() as usize]);
        let Some(team) = alone.filter(|team| self.possession.is_none_or(|own| own.team != *team)) else {
            self.claims = None;
            return;
        };
        let since = match self.claims {
            Some((claimer, since)) if claimer == team => since,
            _ => now,
        };
        self.claims = Some((team, since));
        if now - since >= CONTROLS_AFTER {
            self.possess(now, team);
        }
    }

    /// The team has the ball; the other team's possession is over.
    fn possess(&mut self, now: f64, team: Colour) {
        if self.possession.is_some_and(|own| own.team == team) {
            return;
        }
        if let Some(lost) = self.possession {
            let flight = self.flight.take().filter(|flight| flight.by.colour == lost.team);
            let end = match flight {
                Some(flight) if flight.shot => PossessionEnd::Shot,
                Some(_) => PossessionEnd::KickToOpponent,
                None if now - lost.pressed < PRESSED_WITHIN => PossessionEnd::Tackle,
                None => PossessionEnd::Left,
            };
            self.end(lost, now, end);
        }
        self.possession = Some(Possession { team, since: now, pressed: f64::NEG_INFINITY });
        self.claims = None;
    }

    fn stopped(&mut self, now: f64, ball: Point<Field>, scored: Option<Colour>, out: bool) {
        let flight = self.flight;
        self.land(now, ball, None);
        let shot = flight.filter(|flight| flight.shot).map(|flight| flight.by.colour);
        if let Some(team) = scored.filter(|team| shot == Some(*team)) {
            self.counts[team as usize].shots.goals += 1;
        }
        if let Some(own) = self.possession.take() {
            let end = if scored == Some(own.team) {
                PossessionEnd::Goal
            } else if shot == Some(own.team) {
                PossessionEnd::Shot
            } else if out {
                PossessionEnd::Out
            } else {
                PossessionEnd::Referee
            };
            self.end(own, now, end);
        }
        (self.flight, self.claims, self.received) = (None, None, None);
        self.left.forget();
    }

    fn end(&mut self, possession: Possession, now: f64, end: PossessionEnd) {
        let lasted = now - possession.since;
        self.events.push(BallEvent::Lost { team: possession.team, end });
        if lasted >= POSSESSION_LASTS {
            self.counts[possession.team as usize].ended(end, lasted as f32);
        }
    }
}

/// Whether a ball from `at` crosses the goal line that `team` attacks between the posts or just beside them.
fn is_at_goal(look: &BallLook<'_>, team: Colour, at: Point<Field>, velocity: Vector<Field>) -> bool {
    let field = look.field;
    let sign = look.own_ends[team as usize].opposite().sign() as f32;
    let forward = velocity.x() * sign;
    if forward <= 0.0 {
        return false;
    }
    let time = (0.5 * field.length - at.x() * sign) / forward;
    let across = at.y() + velocity.y() * time;
    time > 0.0 && across.abs() < 0.5 * field.goal_width + BESIDE_POST
}

/// The share of the goal's opening to which the line from `at` is free of opponents' bodies, 0–1.
fn open_share(look: &BallLook<'_>, team: Colour, at: Point<Field>) -> f32 {
    let field = look.field;
    let x = 0.5 * field.length * look.own_ends[team as usize].opposite().sign() as f32;
    let half = 0.5 * field.goal_width - BALL_RADIUS;
    let opponents = look.robots.iter().filter(|(who, _)| who.colour != team);
    let bodies: Vec<_> = opponents.map(|(_, place)| *place).collect();
    let free = (0..GOAL_LINES).filter(|i| {
        let y = half * (2.0 * (*i as f32 + 0.5) / GOAL_LINES as f32 - 1.0);
        let line = Segment::new(at, Point::new(x, y));
        bodies.iter().all(|body| line.distance_to(*body) > ROBOT_RADIUS + BALL_RADIUS)
    });
    free.count() as f32 / GOAL_LINES as f32
}

/// An opponent this near the ball presses its owner, m.
const PRESSES_WITHIN: f32 = 0.35;
/// A ball lost within this time of being pressed was lost in a tackle or scrum, s.
const PRESSED_WITHIN: f64 = 0.5;
/// A team alone at the ball for this long has it, s: longer than a deflection.
const CONTROLS_AFTER: f64 = 0.05;
/// Shorter possessions are deflections, s.
pub const POSSESSION_LASTS: f64 = 0.25;
/// Speed above which a touch is a kick, m/s.
const KICK_SPEED: f32 = 1.0;
/// Length above which a touch is a kick, m.
const KICK_LENGTH: f32 = 0.5;
/// Speed above which a kick at the goal is a shot, m/s.
const SHOT_SPEED: f32 = 3.0;
/// Distance beside a post within which a shot still counts, m.
const BESIDE_POST: f32 = 0.25;
/// A volley leaves within this of the ball's arrival, s.
const VOLLEY_WITHIN: f64 = 0.12;
/// Lines to the goal's opening that are looked at.
const GOAL_LINES: usize = 20;

#[cfg(test)]
mod tests;
