//! `counterfactual`: the smallest move of one object on the field that would make a case the retrieved one
//! (docs/case-format.md §3.3, `explain`).
//!
//! Moves tried: the ball towards the case's ball; each robot to each adapted position; each opponent into the
//! case's scopes, out of its legs, out of the winner's scopes and into the winner's legs; with scopes that
//! exclude opponents the other way round. On each line the shortest distance is found by bisection, in whole
//! mm, and every answer was retrieved again on the changed problem: the move is proven to work, but a shorter
//! one on another line may exist.

use casebase::{
    Case, CaseBase, Criterion, Leg, Match, PointMm, Presence, Problem, RetrievalSettings, ScopeRule,
    retrieve_best,
};
use protocol::{CaseId, RobotId};

/// Change that would make a case the retrieved one.
#[derive(Clone, Debug, PartialEq)]
pub enum Counterfactual {
    /// The case is the retrieved one.
    Winner,
    /// The shortest single move that makes it the retrieved case.
    Move(Move),
    /// No single move that was tried.
    NoSingleMove(CounterfactualObstacle),
}

/// One object moved to another position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The object that is moved.
    pub entity: Entity,
    /// Old position, mm, field frame.
    pub from: PointMm,
    /// New position, mm, field frame.
    pub to: PointMm,
    /// Length of the move, mm.
    pub distance_mm: f32,
}

/// Objects that can be moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entity {
    /// The ball; all adapted positions move with it.
    Ball,
    /// A robot of ours.
    Teammate(RobotId),
    /// An opponent, by its number in the problem, from 0.
    Opponent(usize),
}

/// Reason why no single move works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CounterfactualObstacle {
    /// Fewer robots are present than the case needs.
    Robots {
        /// Robots of the case.
        needed: usize,
        /// Robots of the problem.
        present: usize,
    },
    /// The winner fulfils more conditions than the case has.
    Conditions {
        /// The case that is retrieved instead.
        winner: CaseId,
        /// Number of conditions it fulfils.
        fulfilled: u8,
        /// Maximum number of conditions of the case.
        most: u8,
    },
    /// No single move removes all obstacles.
    Several {
        /// Number of moves tried.
        tried: usize,
    },
}

impl Move {
    /// The problem after it.
    pub fn applied(&self, problem: &Problem) -> Problem {
        let mut changed = problem.clone();
        match self.entity {
            Entity::Ball => changed.ball = self.to,
            Entity::Teammate(id) => {
                for (robot, at) in &mut changed.teammates {
                    if *robot == id {
                        *at = self.to;
                    }
                }
            }
            Entity::Opponent(index) => {
                if let Some(at) = changed.opponents.get_mut(index) {
                    *at = self.to;
                }
            }
        }
        changed
    }
}

/// The smallest single move that makes `id` the retrieved case; `None` where the base has no such case under
/// the problem's goal.
pub fn counterfactual(
    base: &CaseBase<'_>,
    problem: &Problem,
    settings: &RetrievalSettings,
    id: CaseId,
) -> Option<Counterfactual> {
    let case = base.case(id).filter(|case| case.defending() == problem.defending)?;
    let winner = retrieve_best(base, problem, settings);
    if winner.as_ref().is_some_and(|winner| winner.case == id) {
        return Some(Counterfactual::Winner);
    }
    let (needed, present) = (case.teammates(), problem.teammates.len());
    if needed > present {
        return Some(Counterfactual::NoSingleMove(CounterfactualObstacle::Robots { needed, present }));
    }
    let mut search = Search { base, problem, settings, id, best: None, tried: 0 };
    search.ball(&case);
    search.teammates(&case);
    search.opponents(&case, winner.as_ref());
    Some(match search.best {
        Some(found) => Counterfactual::Move(found),
        None => Counterfactual::NoSingleMove(obstacle(&case, winner.as_ref(), settings, search.tried)),
    })
}

fn obstacle(
    case: &Case<'_>,
    winner: Option<&Match>,
    settings: &RetrievalSettings,
    tried: usize,
) -> CounterfactualObstacle {
    let most = case.opponents().count() as u8;
    match winner {
        Some(winner) if settings.ranking[0] == Criterion::Conditions && winner.conditions > most => {
            CounterfactualObstacle::Conditions { winner: winner.case, fulfilled: winner.conditions, most }
        }
        _ => CounterfactualObstacle::Several { tried },
    }
}

struct Search<'s, 'b> {
    base: &'s CaseBase<'b>,
    problem: &'s Problem,
    settings: &'s RetrievalSettings,
    id: CaseId,
    best: Option<Move>,
    tried: usize,
}

impl Search<'_, '_> {
    /// Moves the ball towards the case's ball. Points between are tested in steps: opponents enter and leave
    /// legs along the path.
    fn ball(&mut self, case: &Case<'_>) {
        let from = self.problem.ball;
        for step in 1..=BALL_STEPS {
            let to = between(from, case.ball(), step as f32 / BALL_STEPS as f32);
            if self.shorten(Entity::Ball, from, to) {
                break;
            }
        }
    }

    fn teammates(&mut self, case: &Case<'_>) {
        for robot in case.robots() {
            let to = case.adapted(robot, self.problem.ball);
            for (player, from) in &self.problem.teammates {
                self.shorten(Entity::Teammate(*player), *from, to);
            }
        }
    }

    fn opponents(&mut self, case: &Case<'_>, winner: Option<&Match>) {
        let winner = winner.and_then(|winner| self.base.case(winner.case));
        let ball = self.problem.ball;
        for (index, from) in self.problem.opponents.iter().enumerate() {
            let leave = |at, scope: casebase::Scope| away(*from, at, scope.x.max(scope.y) + ROOM_MM);
            let mut targets = Vec::new();
            for (number, (at, scope)) in self.scopes(case).enumerate() {
                match case.presence(number) {
                    Presence::Excluded => targets.extend(leave(at, scope)),
                    Presence::Preferred | Presence::Required => targets.push(at),
                }
            }
            for leg in case.legs(ball) {
                targets.extend(beside(&leg, *from));
            }
            if let Some(winner) = &winner {
                for (number, (at, scope)) in self.scopes(winner).enumerate() {
                    match winner.presence(number) {
                        Presence::Excluded => targets.push(at),
                        Presence::Preferred | Presence::Required => targets.extend(leave(at, scope)),
                    }
                }
                targets.extend(winner.legs(ball).filter_map(|leg| onto(&leg, *from)));
            }
            for to in targets {
                self.shorten(Entity::Opponent(index), *from, to);
            }
        }
    }

    /// Opponent scopes as the settings place them.
    fn scopes<'a>(&self, case: &Case<'a>) -> impl Iterator<Item = (PointMm, casebase::Scope)> + use<'a> {
        let shift = match self.settings.scopes {
            ScopeRule::Translated => case.shift(self.problem.ball),
            ScopeRule::Absolute => PointMm::new(0, 0),
        };
        case.opponents().map(move |(at, scope)| (at.plus(shift), scope))
    }

    /// Returns whether the move to `target` works. Then the shortest part of it that works is kept if it is
    /// the shortest of all.
    fn shorten(&mut self, entity: Entity, from: PointMm, target: PointMm) -> bool {
        self.tried += 1;
        if !self.serves(entity, from, target) {
            return false;
        }
        let (mut low, mut high) = (0.0, 1.0);
        let mut found = target;
        // Bisects a distance of 10 m to 1 mm.
        for _ in 0..14 {
            let middle = 0.5 * (low + high);
            let to = between(from, target, middle);
            if self.serves(entity, from, to) {
                (high, found) = (middle, to);
            } else {
                low = middle;
            }
        }
        let moved = Move { entity, from, to: found, distance_mm: distance(from, found) };
        if self.best.is_none_or(|best| moved.distance_mm < best.distance_mm) {
            self.best = Some(moved);
        }
        true
    }

    fn serves(&self, entity: Entity, from: PointMm, to: PointMm) -> bool {
        let changed = Move { entity, from, to, distance_mm: 0.0 }.applied(self.problem);
        retrieve_best(self.base, &changed, self.settings).is_some_and(|winner| winner.case == self.id)
    }
}

/// The positions on both sides of a leg to which an opponent abreast of it may leave.
fn beside(leg: &Leg, opponent: PointMm) -> Vec<PointMm> {
    let Some((foot, normal)) = foot(leg, opponent) else { return Vec::new() };
    let Some(abreast) = leg.abreast(opponent.to_f32()) else { return Vec::new() };
    let reach = abreast.radius + ROOM_MM as f32;
    let at = |side: f32| whole([foot[0] + side * reach * normal[0], foot[1] + side * reach * normal[1]]);
    vec![at(1.0), at(-1.0)]
}

/// The position on a leg nearest to an opponent abreast of it.
fn onto(leg: &Leg, opponent: PointMm) -> Option<PointMm> {
    foot(leg, opponent).map(|(foot, _)| whole(foot))
}

/// Foot of the perpendicular on the leg, and the leg's normal (left).
fn foot(leg: &Leg, opponent: PointMm) -> Option<([f32; 2], [f32; 2])> {
    let along = leg.abreast(opponent.to_f32())?.along;
    let [dx, dy] = [leg.to[0] - leg.from[0], leg.to[1] - leg.from[1]];
    let length = dx.hypot(dy);
    let unit = [dx / length, dy / length];
    Some(([leg.from[0] + along * unit[0], leg.from[1] + along * unit[1]], [-unit[1], unit[0]]))
}

/// The point from `centre` through `from` at distance `reach`; from the centre itself, those in the four
/// directions of the axes.
fn away(from: PointMm, centre: PointMm, reach: i32) -> Vec<PointMm> {
    let [dx, dy] = from.minus(centre).to_f32();
    let length = dx.hypot(dy);
    let mut places: Vec<_> = [(reach, 0), (-reach, 0), (0, reach), (0, -reach)]
        .map(|(x, y)| centre.plus(PointMm::new(x, y)))
        .into();
    if length > 0.0 {
        let [x, y] = centre.to_f32();
        let factor = reach as f32 / length;
        places.push(whole([x + dx * factor, y + dy * factor]));
    }
    places
}

fn between(from: PointMm, to: PointMm, part: f32) -> PointMm {
    let [dx, dy] = to.minus(from).to_f32();
    let [x, y] = [dx * part, dy * part];
    from.plus(whole([x, y]))
}

fn whole([x, y]: [f32; 2]) -> PointMm {
    PointMm::new(x.round() as i32, y.round() as i32)
}

fn distance(from: PointMm, to: PointMm) -> f32 {
    let [dx, dy] = to.minus(from).to_f32();
    dx.hypot(dy)
}

/// Number of steps along the ball's path: a case's scopes are a good part of the field wide, so an eighth of
/// the path finds what changes on it.
const BALL_STEPS: u32 = 8;
/// Distance beyond an edge, so that rounding to whole mm does not fall back over it, mm.
const ROOM_MM: i32 = 5;
