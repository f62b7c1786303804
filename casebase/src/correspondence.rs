//! `correspondence`: assignment of case robots to present robots: the cheapest injective map (paper §3.2).
//!
//! Exact and bounded: present robots are added one after the other, and for every set of parts the cheapest
//! assignment so far is kept: 16 sets, at most 11 robots, at most 352 steps for 4 parts. Distances are summed
//! as whole 1/256 mm, so that equal sums are equal in any order of adding; a tie goes to the
//! lexicographically smallest list of robot ids in the order of the parts, which is the smallest number when
//! an id is a digit of base 16.

use geometry::math;
use heapless::Vec;
use protocol::RobotId;

use crate::action::TEAMMATES_MAX;
use crate::problem::PROBLEM_TEAMMATES_MAX;
use crate::rank::Correspondence;
use crate::settings::{CorrespondenceRule, CostRule, RetrievalSettings};

/// The distances of every present robot to every part of a case, mm.
#[derive(Clone, Debug, Default)]
pub(crate) struct Distances {
    /// One column per present robot: its id, and its distance to each part.
    pub(crate) columns: Vec<(RobotId, [f32; TEAMMATES_MAX]), PROBLEM_TEAMMATES_MAX>,
    /// Number of parts: robots of the case.
    pub(crate) parts: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Players {
    pub(crate) ids: Correspondence,
    /// Sum or maximum of the distances, mm.
    pub(crate) cost: f32,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assignment {
    pub(crate) players: Players,
    pub(crate) farthest: usize,
    /// Distance of that robot, mm.
    pub(crate) distance: f32,
}

/// The nearest robot to each part: together they cost at most as much as the cheapest correspondence.
pub(crate) struct Nearest {
    pub(crate) players: Players,
    /// No robot is nearest to two parts, and none is tied with another: it is the cheapest correspondence.
    pub(crate) distinct: bool,
}

/// The nearest robot to each place; `None` where no robot can reach one of them within `limit` mm: then every
/// correspondence exceeds it.
#[inline(always)]
pub(crate) fn nearest(robots: &[(RobotId, [f32; 2])], places: &[[i16; 2]], limit: f32) -> Option<Nearest> {
    let (mut ids, mut cost) = (Vec::new(), 0.0);
    let mut distinct = true;
    let mut taken = 0_u32;
    for place in places {
        let [x, y] = place.map(f32::from);
        let (mut least, mut second, mut player) = (f32::INFINITY, f32::INFINITY, None);
        for (id, at) in robots {
            let (dx, dy) = (at[0] - x, at[1] - y);
            let squared = dx * dx + dy * dy;
            if squared < least {
                (least, second, player) = (squared, least, Some(*id));
            } else if squared < second {
                second = squared;
            }
        }
        let player = player?;
        let distance = math::sqrt(least);
        if distance > limit {
            return None;
        }
        let next = distance + DISTINCT_MM;
        let bit = 1 << player.index();
        distinct &= second > next * next && taken & bit == 0;
        taken |= bit;
        ids.push(player).ok()?;
        cost += distance;
    }
    Some(Nearest { players: Players { ids, cost }, distinct })
}

/// The cheapest correspondence; `None` where there are fewer robots than parts, or where the settings
/// constrain the search to the travel limit and no correspondence is within it.
pub(crate) fn assign(distances: &Distances, settings: &RetrievalSettings) -> Option<Assignment> {
    let limit = match settings.correspondence {
        CorrespondenceRule::MinThenTest => f32::INFINITY,
        CorrespondenceRule::Constrained => settings.travel_max_mm,
    };
    assign_within(distances, settings.cost, limit)
}

/// The cheapest correspondence among those with no distance above `limit`.
pub(crate) fn assign_within(distances: &Distances, rule: CostRule, limit: f32) -> Option<Assignment> {
    let packed = match rule {
        CostRule::Sum => least_sum(distances, limit)?,
        CostRule::Max => {
            let bottleneck = least_maximum(distances, limit)?;
            let mut ids = 0;
            first_within(distances, bottleneck, 0, 0, &mut ids).then_some(ids)?
        }
    };
    let players = Players { ids: Vec::new(), cost: 0.0 };
    let mut assignment = Assignment { players, farthest: 0, distance: -1.0 };
    for part in 0..distances.parts {
        let id = digit(packed, part);
        let (player, column) = distances.columns.iter().find(|(player, _)| player.number() == id)?;
        let distance = *column.get(part)?;
        let Players { ids, cost } = &mut assignment.players;
        ids.push(*player).ok()?;
        *cost = match rule {
            CostRule::Sum => *cost + distance,
            CostRule::Max => cost.max(distance),
        };
        if distance > assignment.distance {
            (assignment.farthest, assignment.distance) = (part, distance);
        }
    }
    Some(assignment)
}

/// The packed ids of the minimum sum.
fn least_sum(distances: &Distances, limit: f32) -> Option<u16> {
    let full = full_set(distances)?;
    if cfg!(feature = "words") && distances.parts == 2 {
        return least_pair(distances, limit);
    }
    // For every set of parts: the minimum sum so far and its ids, the sum above the ids.
    let mut best = [UNREACHABLE_SUM; SETS];
    best[0] = 0;
    for (player, column) in &distances.columns {
        let mut with = [UNREACHABLE_SUM; TEAMMATES_MAX];
        for (part, (with, distance)) in with.iter_mut().zip(column).enumerate().take(distances.parts) {
            *with = sum_of_one(*player, part, *distance, limit);
        }
        for set in (1..=full).rev() {
            let mut least = best[set & (SETS - 1)];
            for (part, with) in with.iter().enumerate() {
                if set & (1 << part) != 0 {
                    least = least.min(best[(set ^ (1 << part)) & (SETS - 1)] + with);
                }
            }
            best[set & (SETS - 1)] = least;
        }
    }
    let least = best[full & (SETS - 1)];
    (least < UNREACHABLE_SUM).then_some(least as u16)
}

/// The same of two parts, the most frequent search, without a table of sets.
fn least_pair(distances: &Distances, limit: f32) -> Option<u16> {
    let (mut first, mut second, mut both) = (UNREACHABLE_SUM, UNREACHABLE_SUM, UNREACHABLE_SUM);
    for (player, column) in &distances.columns {
        let [to_first, to_second] = [0, 1].map(|part| sum_of_one(*player, part, column[part], limit));
        both = both.min(first + to_second).min(second + to_first);
        (first, second) = (first.min(to_first), second.min(to_second));
    }
    (both < UNREACHABLE_SUM).then_some(both as u16)
}

/// One player's share of a sum and its digit of the ids below; unreachable above the limit.
#[inline]
fn sum_of_one(player: RobotId, part: usize, distance: f32, limit: f32) -> u64 {
    if distance > limit {
        return UNREACHABLE_SUM;
    }
    u64::from(fixed(distance)) << 16 | u64::from(shifted(player, part))
}

/// The minimum possible maximum.
fn least_maximum(distances: &Distances, limit: f32) -> Option<u32> {
    let full = full_set(distances)?;
    let mut best = [u32::MAX; SETS];
    best[0] = 0;
    for (_, column) in &distances.columns {
        for set in (1..=full).rev() {
            for part in 0..distances.parts {
                let distance = column[part & (TEAMMATES_MAX - 1)];
                if set & (1 << part) != 0 && distance <= limit {
                    let with = best[set & !(1 << part) & (SETS - 1)].max(fixed(distance));
                    best[set & (SETS - 1)] = best[set & (SETS - 1)].min(with);
                }
            }
        }
    }
    let least = best[full & (SETS - 1)];
    (least != u32::MAX).then_some(least)
}

/// The lexicographically smallest correspondence with no distance above `bottleneck`, part after part.
fn first_within(distances: &Distances, bottleneck: u32, part: usize, used: u16, ids: &mut u16) -> bool {
    if part == distances.parts {
        return true;
    }
    for player in RobotId::all() {
        let bit = 1 << player.number();
        if used & bit == 0 && distances.reaches(player, part, bottleneck) {
            let before = *ids;
            *ids |= shifted(player, part);
            if first_within(distances, bottleneck, part + 1, used | bit, ids) {
                return true;
            }
            *ids = before;
        }
    }
    false
}

impl Distances {
    /// Returns whether the player's distance to the part is at most `bottleneck`.
    fn reaches(&self, player: RobotId, part: usize, bottleneck: u32) -> bool {
        self.columns.iter().any(|(id, column)| {
            *id == player && column.get(part).is_some_and(|distance| fixed(*distance) <= bottleneck)
        })
    }
}

/// All parts, as a set; `None` where there are fewer robots than parts.
fn full_set(distances: &Distances) -> Option<usize> {
    let possible = distances.parts <= TEAMMATES_MAX && distances.parts <= distances.columns.len();
    possible.then(|| (1 << distances.parts) - 1)
}

/// A distance in 1/256 mm: exact for `f32` up to 65 m, cut off at 2 km, so that four of them fit 32 bits.
#[inline]
fn fixed(distance: f32) -> u32 {
    ((distance * 256.0 + 0.5) as u32).min(1 << 29)
}

/// A robot's id as the digit of a part.
#[inline]
fn shifted(player: RobotId, part: usize) -> u16 {
    (player.index() as u16) << (12 - 4 * (part & 3))
}

fn digit(packed: u16, part: usize) -> u8 {
    ((packed >> (12 - 4 * (part & 3))) & 15) as u8
}

/// Difference of distances, mm, that is above the 1/256 mm within which distances count as equal, and above
/// the rounding error of distances that can matter.
const DISTINCT_MM: f32 = 0.02;
/// Above every sum; five times this value still fits.
const UNREACHABLE_SUM: u64 = 1 << 60;
/// Number of sets of parts.
const SETS: usize = 1 << TEAMMATES_MAX;

#[cfg(test)]
mod tests {
    extern crate std;
    use std::vec::Vec as List;

    use super::*;
    use crate::testing::Stream;

    fn distances(rows: &[&[f32]], ids: &[u8]) -> Distances {
        let columns = ids.iter().enumerate().map(|(player, id)| {
            let column = core::array::from_fn(|part| rows.get(part).map_or(0.0, |row| row[player]));
            (RobotId::new(*id).unwrap(), column)
        });
        Distances { columns: columns.collect(), parts: rows.len() }
    }

    fn players(assignment: &Assignment) -> List<u8> {
        assignment.players.ids.iter().map(|id| id.number()).collect()
    }

    /// Every injective map in lexicographic order of ids: the reference for the fast method.
    fn enumerate(distances: &Distances, rule: CostRule, limit: f32) -> Option<(u64, List<u8>)> {
        fn go(
            d: &Distances,
            rule: CostRule,
            limit: f32,
            at: &mut List<usize>,
            best: &mut Option<(u64, List<u8>)>,
        ) {
            if at.len() == d.parts {
                let costs =
                    at.iter().enumerate().map(|(part, column)| u64::from(fixed(d.columns[*column].1[part])));
                let cost = match rule {
                    CostRule::Sum => costs.sum(),
                    CostRule::Max => costs.max().unwrap_or(0),
                };
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    *best = Some((cost, at.iter().map(|column| d.columns[*column].0.number()).collect()));
                }
                return;
            }
            let mut order: List<usize> = (0..d.columns.len()).collect();
            order.sort_by_key(|column| d.columns[*column].0);
            for column in order {
                if !at.contains(&column) && d.columns[column].1[at.len()] <= limit {
                    at.push(column);
                    go(d, rule, limit, at, best);
                    at.pop();
                }
            }
        }
        let mut best = None;
        go(distances, rule, limit, &mut List::new(), &mut best);
        best
    }

    #[test]
    fn the_assignment_equals_the_enumeration_of_all_maps() {
        let mut stream = Stream::new(1);
        for round in 0..3000 {
            let (parts, robots) = (1 + stream.below(4) as usize, stream.below(12) as usize);
            let mut ids: List<u8> = (0..16).collect();
            for i in 0..16 {
                ids.swap(i, stream.below(16) as usize);
            }
            // Few different distances make many ties.
            let spread = if round % 2 == 0 { 4 } else { 3000 };
            let rows: List<List<f32>> =
                (0..parts).map(|_| (0..robots).map(|_| stream.below(spread) as f32).collect()).collect();
            let rows: List<&[f32]> = rows.iter().map(List::as_slice).collect();
            let matrix = distances(&rows, &ids[..robots]);
            for rule in [CostRule::Sum, CostRule::Max] {
                for limit in [f32::INFINITY, spread as f32 * 0.6] {
                    let found = assign_within(&matrix, rule, limit);
                    let truth = enumerate(&matrix, rule, limit);
                    assert_eq!(found.as_ref().map(players), truth.map(|(_, ids)| ids), "{matrix:?} {rule:?}");
                }
            }
        }
    }

    #[test]
    fn in_the_papers_trapezoid_only_the_maximum_lets_paths_cross() {
        // Fig. 6: robots 1 and 2, places A and B; c = d(1, A) is short, b = d(2, B) the long side, both
        // diagonals shorter than b.
        let (robot1, robot2) = ([0.0, 0.0], [-400.0, 300.0]);
        let (a, b) = ([100.0, 0.0], [500.0, 300.0]);
        let d = |p: [f32; 2], q: [f32; 2]| ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)).sqrt();
        let matrix = distances(&[&[d(robot1, a), d(robot2, a)], &[d(robot1, b), d(robot2, b)]], &[1, 2]);
        assert!(d(robot1, b) < d(robot2, b) && d(robot2, a) < d(robot2, b));
        let sum = assign_within(&matrix, CostRule::Sum, f32::INFINITY).unwrap();
        let maximum = assign_within(&matrix, CostRule::Max, f32::INFINITY).unwrap();
        assert_eq!((players(&sum), players(&maximum)), (List::from([1, 2]), List::from([2, 1])));
    }

    #[test]
    fn a_limit_during_the_search_finds_what_a_test_after_it_rejects() {
        // The cheapest map sends robot 2 over 1600 mm; within 1500 mm the more expensive one fits.
        let matrix = distances(&[&[0.0, 1400.0], &[1450.0, 1600.0]], &[1, 2]);
        let mut settings = RetrievalSettings::default();
        let free = assign(&matrix, &settings).unwrap();
        assert_eq!((players(&free), free.farthest, free.distance), (List::from([1, 2]), 1, 1600.0));
        settings.set("correspondence", "constrained").unwrap();
        let constrained = assign(&matrix, &settings).unwrap();
        assert_eq!((players(&constrained), constrained.players.cost), (List::from([2, 1]), 2850.0));
    }

    #[test]
    fn far_away_robots_do_not_overflow() {
        let far = f32::MAX;
        let matrix = distances(&[&[far, far], &[far, far]], &[3, 9]);
        assert_eq!(players(&assign_within(&matrix, CostRule::Sum, f32::INFINITY).unwrap()), [3, 9]);
    }
}
