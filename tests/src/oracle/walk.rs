//! `walk`: naive plan simulation: the ball's path through a case.
//!
//! The symbolic simulation of docs/case-format.md §3.1 (paper §3.3.1), played one ball action after the
//! other. Field frame, mm.

use super::library::{Action, Aim, Case, Corridor, Kick, Library, Point};

/// One leg of the ball path; its ends are not rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Start of the leg, mm.
    pub from: (f64, f64),
    /// Its intended end, mm.
    pub to: (f64, f64),
    /// Radii at either end.
    pub corridor: Corridor,
}

/// The legs of `case` with its ball moved to `ball`; an error where the gameplays cannot be played to their
/// end.
pub fn legs(library: &Library, case: &Case, ball: Point) -> Result<Vec<Leg>, String> {
    let shift = Point { x: ball.x - case.ball.x, y: ball.y - case.ball.y };
    let shifted = |p: Point| ((p.x + shift.x) as f64, (p.y + shift.y) as f64);
    let mut walkers: Vec<Walker<'_>> =
        case.robots.iter().map(|r| Walker { place: shifted(r.at), rest: &r.gameplay }).collect();

    let starts = |walker: &Walker<'_>| walker.rest.first() == Some(&Action::GetBall);
    if walkers.iter().filter(|walker| starts(walker)).count() != 1 {
        return Err("not exactly one robot starts with get_ball".to_owned());
    }
    let mut holder = walkers.iter().position(starts);
    let mut at = (ball.x as f64, ball.y as f64);
    if let Some(getter) = holder {
        walkers[getter].take_ball(at);
    }
    let mut legs = Vec::new();
    while let Some(robot) = holder {
        match walkers[robot].next_ball_action(&shifted) {
            None => break,
            Some(Action::DribbleTo(point)) => {
                at = shifted(point);
                walkers[robot].take_ball(at);
            }
            Some(Action::Pass(to)) => {
                walkers[robot].rest = &walkers[robot].rest[1..];
                let receiver =
                    walkers.get_mut(to).filter(|_| to != robot).ok_or("a pass to no other robot")?;
                if receiver.next_ball_action(&shifted) != Some(Action::Receive(robot)) {
                    return Err(format!("tm{}'s pass is not received by tm{}", robot + 1, to + 1));
                }
                let place = receiver.place;
                receiver.take_ball(place);
                legs.push(Leg { from: at, to: place, corridor: library.pass });
                at = place;
                holder = Some(to);
            }
            Some(Action::Kick(kick)) => {
                walkers[robot].rest = &walkers[robot].rest[1..];
                let end = kicked(library, case, kick, at);
                legs.push(Leg { from: at, to: end, corridor: kick.corridor });
                at = end;
                holder = None;
                for (next, walker) in walkers.iter_mut().enumerate() {
                    if walker.peek_ball_action() == Some(Action::GetBall) {
                        walker.next_ball_action(&shifted);
                        walker.take_ball(at);
                        holder = Some(next);
                        break;
                    }
                }
            }
            Some(action) => return Err(format!("tm{} holds the ball at {action:?}", robot + 1)),
        }
    }
    match walkers.iter().position(|walker| walker.peek_ball_action().is_some()) {
        None => Ok(legs),
        Some(robot) => Err(format!("tm{} never comes to {:?}", robot + 1, walkers[robot].peek_ball_action())),
    }
}

fn kicked(library: &Library, case: &Case, kick: Kick, from: (f64, f64)) -> (f64, f64) {
    let attack = case.defending.attack() as f64;
    match kick.aim {
        Aim::Heading { degrees, length } => {
            let (sin, cos) = (degrees as f64).to_radians().sin_cos();
            let length = length as f64;
            (from.0 + attack * length * cos, from.1 + attack * length * sin)
        }
        Aim::Goal { offset } => (attack * library.length as f64 / 2.0, attack * offset as f64),
    }
}

/// A robot during its gameplay.
struct Walker<'c> {
    place: (f64, f64),
    /// Actions not yet executed.
    rest: &'c [Action],
}

impl Walker<'_> {
    /// Executes the first remaining action, which leaves robot and ball at `place`.
    fn take_ball(&mut self, place: (f64, f64)) {
        self.place = place;
        self.rest = &self.rest[1..];
    }

    /// Executes everything before the next ball action, and returns that one.
    fn next_ball_action(&mut self, shifted: &impl Fn(Point) -> (f64, f64)) -> Option<Action> {
        while let [action @ (Action::Stay | Action::GoTo(_)), rest @ ..] = self.rest {
            if let Action::GoTo(point) = action {
                self.place = shifted(*point);
            }
            self.rest = rest;
        }
        self.rest.first().copied()
    }

    fn peek_ball_action(&self) -> Option<Action> {
        self.rest.iter().copied().find(|action| !matches!(action, Action::Stay | Action::GoTo(_)))
    }
}
