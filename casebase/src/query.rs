//! `query`: tests of one stored case against one problem. The checks of docs/case-format.md §3 one by one,
//! everything relative to the ball, mm.
//!
//! Retrieval and explanation use the same tests, each in its own order.

use geometry::math;
use heapless::Vec;
use protocol::RobotId;

use crate::action::TEAMMATES_MAX;
use crate::case::{Case, widen};
use crate::cells::{cell_of, strip_of};
use crate::correspondence::{Distances, Nearest, Players, assign, nearest};
use crate::leg::{freedom, is_blocking};
use crate::path::{empty_scopes, is_crisply_blocked, least_exponent};
use crate::presence::Presence;
use crate::problem::{PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Problem};
use crate::rank::{Correspondence, Key, Match};
use crate::settings::{CorrespondenceRule, CostRule, FreePathRule, OutOfField, RetrievalSettings, ScopeRule};
use crate::stored::Stored;
use crate::table::{OpponentRecord, RecordHeader, STRIPS};
use crate::{CaseRobot, PointMm, Symmetry};

/// A prepared problem: everything relative to the ball.
pub(crate) struct Query<'p> {
    pub(crate) problem: &'p Problem,
    pub(crate) settings: &'p RetrievalSettings,
    pub(crate) key: QueryKey,
    teammates: &'p [(RobotId, [f32; 2])],
    opponents: &'p [[f32; 2]],
    /// The squares around the ball that contain opponents.
    cells: u32,
}

/// The strips of all opponents across x and y, numbered as a word's bitmaps.
pub(crate) type Strips = Vec<[usize; 2], PROBLEM_OPPONENTS_MAX>;

/// The part of a problem that is tested against a case's record header.
#[derive(Clone, Copy)]
pub(crate) struct QueryKey {
    /// Position of the ball, mm, field frame.
    pub(crate) ball: [f32; 2],
    /// The exponent at the end of scopes.
    pub(crate) limit: f32,
    /// Number of robots that are present.
    pub(crate) robots: usize,
}

impl QueryKey {
    /// The ball's exponent in the case's scope, where it lies inside and there are enough robots.
    #[inline]
    pub(crate) fn exponent(&self, record_header: &RecordHeader) -> Option<f32> {
        if usize::from(record_header.teammates) > self.robots {
            return None;
        }
        self.exponent_in_scope(record_header)
    }

    /// The ball's exponent in the case's scope, where it lies inside.
    #[inline]
    pub(crate) fn exponent_in_scope(&self, record_header: &RecordHeader) -> Option<f32> {
        let exponent = record_header.exponent(self.ball);
        (exponent < self.limit).then_some(exponent)
    }
}

impl Query<'_> {
    /// Prepares a problem and calls `work` with it.
    #[inline(always)]
    pub(crate) fn with<R>(
        problem: &Problem,
        settings: &RetrievalSettings,
        work: impl FnOnce(&Query<'_>) -> R,
    ) -> R {
        let ball = problem.ball;
        // Both lists have the capacity of the problem's: every push fits.
        let mut teammates: Vec<_, PROBLEM_TEAMMATES_MAX> = Vec::new();
        for (id, place) in &problem.teammates {
            if teammates.push((*id, place.minus(ball).to_f32())).is_err() {
                break;
            }
        }
        let mut opponents: Vec<_, PROBLEM_OPPONENTS_MAX> = Vec::new();
        let mut cells = 0;
        for place in &problem.opponents {
            let place = place.minus(ball);
            cells |= cell_of(place);
            if opponents.push(place.to_f32()).is_err() {
                break;
            }
        }
        let key = QueryKey { ball: ball.to_f32(), limit: settings.limit(), robots: teammates.len() };
        work(&Query { problem, settings, key, teammates: &teammates, opponents: &opponents, cells })
    }

    /// The opponents' strips across x and y around the ball, under a symmetry.
    #[inline(always)]
    pub(crate) fn strips(&self, symmetry: Symmetry) -> Strips {
        let mut strips = Vec::new();
        for place in &self.problem.opponents {
            let PointMm { x, y } = symmetry.point(place.minus(self.problem.ball));
            // The capacity is that of a problem's opponents: every push fits.
            let _ = strips.push([strip_of(x), STRIPS / 2 + strip_of(y)]);
        }
        strips
    }

    /// Displacement of opponent scopes against the problem's ball, mm.
    fn scopes_moved_by(&self, case: &Stored<'_, '_>) -> [f32; 2] {
        match self.settings.scopes {
            ScopeRule::Translated => [0.0; 2],
            ScopeRule::Absolute => case.ball().minus(self.problem.ball).to_f32(),
        }
    }

    /// Number of the case's opponent scopes that contain an opponent.
    pub(crate) fn conditions(&self, case: &Stored<'_, '_>) -> u8 {
        let scopes = case.opponents().unwrap_or(&[]);
        let (moved_by, all) = (self.scopes_moved_by(case), u32::MAX);
        let empty = empty_scopes(scopes, moved_by, self.opponents, all, self.key.limit, u32::MAX);
        case.record_header.opponents.saturating_sub(empty.unwrap_or(0) as u8)
    }

    /// The first opponent scope whose demand is not met; few cases demand anything.
    #[inline]
    pub(crate) fn unmet_demand(&self, case: &Stored<'_, '_>) -> Option<UnmetDemand> {
        if case.record_header.demands().is_empty() { None } else { self.search_unmet_demand(case) }
    }

    #[inline(never)]
    fn search_unmet_demand(&self, case: &Stored<'_, '_>) -> Option<UnmetDemand> {
        let (demands, moved_by) = (case.record_header.demands(), self.scopes_moved_by(case));
        case.opponents()?.iter().enumerate().find_map(|(scope, record)| {
            let inside = self.opponents.iter().position(|at| record.holds(moved_by, *at, self.key.limit));
            match (demands.get(scope), inside) {
                (Presence::Required, None) => Some(UnmetDemand { scope, opponent: None }),
                (Presence::Excluded, Some(_)) => Some(UnmetDemand { scope, opponent: inside }),
                _ => None,
            }
        })
    }

    /// Number of those that contain none, where scopes move with the ball; `None` once they are more than
    /// `most`.
    #[inline(always)]
    pub(crate) fn empty_scopes(&self, scopes: &[OpponentRecord], most: u32) -> Option<u32> {
        empty_scopes(scopes, [0.0; 2], self.opponents, self.cells, self.key.limit, most)
    }

    /// Returns whether an opponent stands in a leg as it is stored.
    #[inline(always)]
    pub(crate) fn is_crisply_blocked(&self, case: &Stored<'_, '_>) -> bool {
        is_crisply_blocked(case, self.key.ball, self.opponents, self.key.limit)
    }

    /// Freedom of the ball's path; `None` where it is blocked.
    pub(crate) fn freedom(&self, case: &Stored<'_, '_>) -> Option<f32> {
        if self.settings.free_path == FreePathRule::Crisp && self.settings.out_of_field != OutOfField::Clamp {
            return (!self.is_crisply_blocked(case)).then_some(1.0);
        }
        let least = least_exponent(case, self.problem.ball, self.opponents, self.settings);
        if least.is_some_and(|exponent| is_blocking(exponent, self.settings)) {
            return None;
        }
        Some(match self.settings.free_path {
            FreePathRule::Crisp => 1.0,
            FreePathRule::Fuzzy => freedom(least),
        })
    }

    /// A robot whose adapted position lies outside the field, where the settings reject that.
    pub(crate) fn robot_outside(&self, case: &Stored<'_, '_>) -> Option<CaseRobot> {
        if self.settings.out_of_field != OutOfField::Reject {
            return None;
        }
        let field = case.field();
        let mut positions = case.positions()?.iter().map(|at| self.problem.ball.plus(widen(*at)));
        positions.position(|at| !field.contains(at)).and_then(CaseRobot::new)
    }

    /// The nearest robot to each part as it is stored; `None` where no robot is near enough to one.
    #[inline(always)]
    pub(crate) fn nearest(&self, case: &Stored<'_, '_>) -> Option<Nearest> {
        nearest(self.teammates, case.positions()?, self.settings.travel_max_mm)
    }

    /// The cheapest correspondence, where no robot in it exceeds the travel limit.
    pub(crate) fn cheapest(&self, case: &Stored<'_, '_>) -> Option<Players> {
        let RetrievalSettings { cost, correspondence, out_of_field, .. } = self.settings;
        let plain = *cost == CostRule::Sum
            && *correspondence == CorrespondenceRule::MinThenTest
            && *out_of_field != OutOfField::Clamp;
        if plain { self.least_sum(case, self.nearest(case)?) } else { self.search(case) }
    }

    /// The same by the sum, with parts as they are stored: in most cases, the nearest robots.
    #[inline]
    pub(crate) fn least_sum(&self, case: &Stored<'_, '_>, nearest: Nearest) -> Option<Players> {
        if nearest.distinct { Some(nearest.players) } else { self.search(case) }
    }

    #[inline(never)]
    fn search(&self, case: &Stored<'_, '_>) -> Option<Players> {
        let found = assign(&self.distances(case), self.settings)?;
        (found.distance <= self.settings.travel_max_mm).then_some(found.players)
    }

    /// The distance of every present robot to every adapted position.
    pub(crate) fn distances(&self, case: &Stored<'_, '_>) -> Distances {
        let parts = usize::from(case.teammates());
        let mut distances = Distances { columns: Vec::new(), parts };
        for (id, at) in self.teammates {
            let mut column = [0.0; TEAMMATES_MAX];
            for (place, to) in case.positions().unwrap_or(&[]).iter().zip(&mut column) {
                *to = distance(*at, self.place(case, *place));
            }
            // The capacity is that of a problem's teammates: every push fits.
            let _ = distances.columns.push((*id, column));
        }
        distances
    }

    /// The ranking key of a candidate.
    pub(crate) fn found(&self, case: &Stored<'_, '_>, exponent: f32, free: f32, players: Players) -> Found {
        let (conditions, teammates) = (self.conditions(case), case.teammates());
        let Players { ids, cost } = players;
        Found { key: Key { conditions, teammates, free, exponent, cost, case: case.id.0 }, players: ids }
    }

    /// Adapted position of a robot that stands at `at` in the case, both relative to the ball.
    #[inline]
    fn place(&self, case: &Stored<'_, '_>, at: [i16; 2]) -> [f32; 2] {
        if self.settings.out_of_field == OutOfField::Clamp {
            let ball = self.problem.ball;
            return case.field().clamp(ball.plus(widen(at))).minus(ball).to_f32();
        }
        at.map(f32::from)
    }
}

/// An opponent scope whose demand a problem does not meet.
pub(crate) struct UnmetDemand {
    /// Number of the case's opponent, from 0.
    pub(crate) scope: usize,
    /// Number of the problem's opponent in a scope that excludes it.
    pub(crate) opponent: Option<usize>,
}

/// A candidate: its ranking key, and its correspondence.
pub(crate) struct Found {
    pub(crate) key: Key,
    pub(crate) players: Correspondence,
}

impl Found {
    /// Completes the match by its similarity, the only exponential of a retrieval.
    pub(crate) fn into_match(self) -> Match {
        let Key { conditions, teammates, free, exponent, cost, case } = self.key;
        Match {
            case: protocol::CaseId(case),
            similarity: math::exp(-exponent),
            exponent,
            cost,
            free,
            conditions,
            teammates,
            correspondence: self.players,
        }
    }
}

#[inline]
fn distance(from: [f32; 2], to: [f32; 2]) -> f32 {
    math::hypot(from[0] - to[0], from[1] - to[1])
}

/// Position of a robot of the case for a ball at `ball`, by the settings: adapted, and clamped to the field
/// only where they require it.
pub fn adapted_position(
    case: &Case<'_>,
    robot: CaseRobot,
    ball: PointMm,
    settings: &RetrievalSettings,
) -> PointMm {
    let adapted = case.adapted(robot, ball);
    match settings.out_of_field {
        OutOfField::Clamp => case.base().field().clamp(adapted),
        OutOfField::Keep | OutOfField::Reject => adapted,
    }
}
