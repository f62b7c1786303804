//! `terms`: distances between a problem and a stored case, attribute by attribute: what similarities other
//! than the paper's are made of.
//!
//! No check of retrieval applies: every case has its distances, near or far.

use geometry::math;
use heapless::Vec;

use crate::PointMm;
use crate::action::{OPPONENTS_MAX, TEAMMATES_MAX};
use crate::case::Case;
use crate::correspondence::assign_within;
use crate::problem::Problem;
use crate::query::Query;
use crate::rank::Correspondence;
use crate::settings::{RetrievalSettings, ScopeRule};

/// Distances of one case from a problem, 0 where they are alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Terms {
    /// Of the ball from the case's, in radii of its scope: sim_B is exp(−d²).
    pub ball: f32,
    /// Of each case robot's player from its adapted position, mm; none where the problem has fewer robots.
    pub robots: Vec<f32, TEAMMATES_MAX>,
    /// The players of the case's robots: the correspondence of least cost, without a travel limit.
    pub players: Correspondence,
    /// Of the nearest opponent from the centre of each opponent scope, in radii; infinite without opponents.
    pub scopes: Vec<f32, OPPONENTS_MAX>,
    /// Of the nearest opponent across the ball's path, in radii: μ is exp(−d²); infinite where none is
    /// abreast of it.
    pub path: f32,
}

/// The distances of a case from a problem.
pub fn terms(case: &Case<'_>, problem: &Problem, settings: &RetrievalSettings) -> Terms {
    let scopes_moved = match settings.scopes {
        ScopeRule::Translated => case.shift(problem.ball),
        ScopeRule::Absolute => PointMm::new(0, 0),
    };
    let scopes = case.opponents().map(|(centre, scope)| {
        let from_centre = problem.opponents.iter().map(|at| at.minus(centre.plus(scopes_moved)));
        least(from_centre.map(|displacement| math::sqrt(scope.exponent(displacement))))
    });
    let across = case.legs(problem.ball).map(|leg| {
        let abreast = problem.opponents.iter().filter_map(|at| leg.abreast(at.to_f32()));
        least(abreast.map(|place| place.across.abs() / place.radius))
    });
    let mut found = Terms {
        ball: math::sqrt(case.ball_exponent(problem.ball)),
        robots: Vec::new(),
        players: Correspondence::new(),
        scopes: scopes.collect(),
        path: least(across),
    };
    Query::with(problem, settings, |query| {
        let Some(stored) = case.stored() else { return };
        let distances = query.distances(&stored);
        let Some(assignment) = assign_within(&distances, settings.cost, f32::INFINITY) else { return };
        found.players = assignment.players.ids;
        for (part, player) in found.players.iter().enumerate() {
            let column = distances.columns.iter().find(|(id, _)| id == player);
            let distance = column.and_then(|(_, column)| column.get(part)).copied();
            // A correspondence has no more players than a case has robots.
            let _ = found.robots.push(distance.unwrap_or(f32::INFINITY));
        }
    });
    found
}

/// The smallest of some distances, infinite without any.
fn least(distances: impl Iterator<Item = f32>) -> f32 {
    distances.fold(f32::INFINITY, f32::min)
}
