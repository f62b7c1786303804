//! `assign`: assignment of defenders to places. Primaries along the edge, the other defenders greedily by
//! rank, tasks held (Biswas et al. 2014 §5.1, §5.2). Attack frame, m.

use geometry::{Attack, Point};
use protocol::RobotId;

use super::super::roles;
use super::super::view::{ROBOTS_MAX, RobotSet, View, ViewRobot};
use super::cover::{Case, Cover, beside};
use super::danger::{Blocks, Danger, Position, block_shot, ranked};
use super::edge::Edge;
use super::receiving::FirstLevel;
use super::{Assignment, Guards, Kept, Memory, ThreatSettings};

/// Primaries have passed each other when they are past by this, m along the edge: a body's radius and more
/// than noise.
const PASSED_BY_M: f32 = 0.12;
/// Two robots do not both stand within this, m: two bodies and a margin between.
const TAKEN_WITHIN_M: f32 = 0.2;
/// A new place keeps this much more distance from others, m.
const TAKEN_MARGIN_M: f32 = 0.1;

type Assignments = heapless::Vec<Assignment, ROBOTS_MAX>;

/// A place of a primary defender, and its robot.
#[derive(Clone, Copy)]
struct Primary {
    robot: RobotId,
    place: Point<Attack>,
    /// Whether it is needed against the first-level threat; else it is spare.
    needed: bool,
}

/// Threats that our defence faces: the first-level threat, its cover, and the opponents that may become one.
#[derive(Clone, Copy)]
pub(super) struct Assessment<'t> {
    pub(super) threat: &'t FirstLevel,
    pub(super) cover: &'t Cover,
    pub(super) dangers: &'t [Danger],
}

/// Gives every robot of the team at most one place.
pub(super) fn assign(
    view: &View,
    team: RobotSet,
    assessment: Assessment<'_>,
    memory: &mut Memory,
    settings: &ThreatSettings,
) -> Assignments {
    let Assessment { threat, cover, dangers } = assessment;
    let mut giving = Giving {
        view,
        settings,
        threat: threat.at,
        edge: Edge::of(&view.field, settings.off_area),
        free: view
            .ours
            .iter()
            .filter(|robot| robot.id != view.keeper && team.has(robot.id))
            .copied()
            .collect(),
        given: Assignments::new(),
    };
    let guards =
        Guards::FirstLevel { case: cover.case, open: cover.opening.angle(), uncovered: cover.uncovered };
    let held = held_task(threat, memory).and_then(|kept| giving.take(kept.robot).map(|_| kept));
    let primaries = giving.primaries(cover, memory.primaries);
    if view.our(view.keeper).is_some() {
        let bodies = view.ours.iter().filter(|robot| robot.id != view.keeper).map(|robot| robot.position);
        let at = cover.keeper_meanwhile(view, bodies, settings);
        giving.give(view.keeper, at, guards);
    }
    for primary in primaries.iter().filter(|primary| primary.needed) {
        giving.give(primary.robot, primary.place, guards);
    }
    let mut spare = primaries.iter().find(|primary| !primary.needed).copied();
    if threat.at.distance(view.our_goal()) < settings.spare_stays
        && let Some(beside) = spare.take()
    {
        giving.give(beside.robot, beside.place, Guards::Spare);
    }
    memory.held = held.filter(|kept| giving.holds_on(*kept, &primaries));
    if let (Some(kept), None) = (held, memory.held)
        && let Some(robot) = view.our(kept.robot)
    {
        // The primaries are in place: it is free for the other tasks.
        let _ = giving.free.push(*robot);
    }
    memory.tasks = giving.second_level(dangers, spare, cover, &memory.tasks);
    memory.tasks.extend(memory.held);
    memory.primaries = [primaries.first(), primaries.get(1)].map(|p| p.map(|primary| primary.robot));
    giving.given
}

/// The task of blocking the shot of the pass receiver, if a robot other than the primaries has it.
fn held_task(threat: &FirstLevel, memory: &Memory) -> Option<Kept> {
    let receiver = threat.receiver()?;
    let kept = memory.tasks.iter().find(|kept| kept.opponent == receiver && kept.blocks == Blocks::Shot)?;
    (!memory.primaries.contains(&Some(kept.robot))).then_some(*kept)
}

/// Whether two robots stand in each other's way to these places: the other way round their paths are shorter
/// in all, by more than noise.
fn crosses(a: &ViewRobot, b: &ViewRobot, [to_a, to_b]: [Point<Attack>; 2]) -> bool {
    let now = a.position.distance(to_a) + b.position.distance(to_b);
    let swapped = a.position.distance(to_b) + b.position.distance(to_a);
    swapped + PASSED_BY_M < now
}

/// Places being assigned, and robots that have none yet.
struct Giving<'v> {
    view: &'v View,
    settings: &'v ThreatSettings,
    /// Place of the first-level threat.
    threat: Point<Attack>,
    edge: Edge,
    free: heapless::Vec<ViewRobot, ROBOTS_MAX>,
    given: Assignments,
}

impl Giving<'_> {
    fn give(&mut self, robot: RobotId, at: Point<Attack>, guards: Guards) {
        let at = if robot == self.view.keeper { at } else { super::legal(self.view, at, self.settings) };
        // At most one per robot.
        let _ = self.given.push(Assignment { robot, at, guards });
    }

    /// Takes a robot out of the free ones.
    fn take(&mut self, id: RobotId) -> Option<ViewRobot> {
        let found = self.free.iter().position(|robot| robot.id == id)?;
        Some(self.free.remove(found))
    }

    /// At most two primaries, the ones needed first. A robot that was one stays one until another is nearer
    /// by the settings' worth.
    fn primaries(&mut self, cover: &Cover, before: [Option<RobotId>; 2]) -> heapless::Vec<Primary, 2> {
        let worth = self.settings.worth;
        match cover.primaries[..] {
            [lower, upper] => self.pair([lower, upper], before),
            [place] => {
                let mut guard = self.nearest(place, before[0], worth);
                // The spare one may be away along the edge to guard a second-level threat, so it is held
                // longer.
                let beside = cover.spare_place(&self.edge, self.settings);
                let mut spare = self.nearest(beside, before[1], 2.0 * worth);
                if let (Some(one), Some(other)) = (&guard, &spare)
                    && crosses(one, other, [place, beside])
                {
                    core::mem::swap(&mut guard, &mut spare);
                }
                let guard = guard.map(|robot| Primary { robot: robot.id, place, needed: true });
                let spare = spare.map(|robot| Primary { robot: robot.id, place: beside, needed: false });
                guard.into_iter().chain(spare).collect()
            }
            _ => heapless::Vec::new(),
        }
    }

    /// The free robot nearest to a place, taken.
    fn nearest(&mut self, place: Point<Attack>, held: Option<RobotId>, worth: f32) -> Option<ViewRobot> {
        let (id, _) = roles::choose(self.free.iter(), held, worth, |robot| robot.position.distance(place))?;
        self.take(id)
    }

    /// Two primaries that are both needed: the robots nearest to either place, present primaries first.
    fn pair(
        &mut self,
        places: [Point<Attack>; 2],
        before: [Option<RobotId>; 2],
    ) -> heapless::Vec<Primary, 2> {
        let mut robots: heapless::Vec<ViewRobot, 2> = heapless::Vec::new();
        for _ in 0..places.len().min(self.free.len()) {
            let off = |robot: &ViewRobot| {
                let bonus = if before.contains(&Some(robot.id)) { self.settings.worth } else { 0.0 };
                robot.position.distance(places[0]).min(robot.position.distance(places[1])) - bonus
            };
            if let Some((id, _)) = roles::choose(self.free.iter(), None, 0.0, off) {
                robots.extend(self.take(id));
            }
        }
        // Along the edge they cannot pass each other, so their order there is that of their places.
        let along = |robot: &ViewRobot| self.edge.along(robot.position);
        robots.sort_unstable_by(|a, b| along(a).total_cmp(&along(b)).then(a.id.cmp(&b.id)));
        if let [lower, upper] = robots[..]
            && before == [Some(upper.id), Some(lower.id)]
            && along(&upper) - along(&lower) < PASSED_BY_M
        {
            robots.swap(0, 1);
        }
        let needed =
            |(robot, place): (&ViewRobot, Point<Attack>)| Primary { robot: robot.id, place, needed: true };
        robots.iter().zip(places).map(needed).collect()
    }

    /// Whether a held task continues: until all primaries are in place. Assigns its place if so.
    fn holds_on(&mut self, kept: Kept, primaries: &[Primary]) -> bool {
        let off = |primary: &Primary| {
            self.view.our(primary.robot).map_or(0.0, |robot| robot.position.distance(primary.place))
        };
        let needed = primaries.iter().filter(|primary| primary.needed);
        let primaries_off = needed.map(off).fold(0.0, f32::max);
        let shooter = self.view.theirs.iter().find(|robot| robot.id == kept.opponent);
        let Some(shooter) = shooter.filter(|_| primaries_off > self.settings.in_place) else { return false };
        let (at, _) = block_shot(self.view, shooter.position, self.settings);
        self.give(kept.robot, at, Guards::Held { opponent: kept.opponent, primaries_off });
        true
    }

    /// The best positions to the nearest robots, in order of rank; a robot that had one keeps it. A spare
    /// primary blocks shots from where their lines cross the edge, and else stands beside the other one.
    fn second_level(
        &mut self,
        dangers: &[Danger],
        mut spare: Option<Primary>,
        cover: &Cover,
        before: &[Kept],
    ) -> heapless::Vec<Kept, ROBOTS_MAX> {
        let holder = |opponent, blocks| {
            let kept = before.iter().find(|kept| kept.opponent == opponent && kept.blocks == blocks);
            kept.map(|kept| kept.robot)
        };
        let still_here = |id: RobotId| {
            self.free.iter().any(|robot| robot.id == id) || spare.is_some_and(|spare| spare.robot == id)
        };
        let positions = ranked(
            dangers,
            |opponent, blocks| holder(opponent, blocks).is_some_and(still_here),
            self.settings,
        );
        let defenders = self.free.len() + usize::from(spare.is_some());
        let wanted: heapless::Vec<RobotId, ROBOTS_MAX> = positions
            .iter()
            .take(defenders)
            .filter_map(|position| holder(position.danger.opponent, position.blocks))
            .take(ROBOTS_MAX)
            .collect();
        let mut kept: heapless::Vec<Kept, ROBOTS_MAX> = heapless::Vec::new();
        for (rank, position) in positions.iter().enumerate() {
            let (opponent, blocks) = (position.danger.opponent, position.blocks);
            let had = holder(opponent, blocks);
            if self.free.is_empty() && spare.is_none() {
                break;
            }
            let at = position.place(self.view, self.threat, self.settings);
            if self.is_taken(at, had.is_some()) {
                continue;
            }
            let on_edge = spare.filter(|_| blocks == Blocks::Shot).and_then(|spare| {
                let robot = *self.view.our(spare.robot)?;
                Some((robot, self.edge_place(position, cover)))
            });
            let candidates = self.free.iter().chain(on_edge.as_ref().map(|(robot, _)| robot));
            let chosen = roles::choose(candidates, had, self.settings.worth, |robot| {
                let place = on_edge.filter(|(spare, _)| spare.id == robot.id).map(|(_, place)| place);
                let to_go = robot.position.distance(place.unwrap_or(at));
                // A robot with another task that is still wanted keeps that, or one new task would move all
                // robots.
                let has_other = had != Some(robot.id) && wanted.contains(&robot.id);
                if has_other { to_go + self.settings.worth } else { to_go }
            });
            let Some((robot, _)) = chosen else { continue };
            let place = on_edge.filter(|(spare, _)| spare.id == robot).map(|(_, place)| place);
            if self.take(robot).is_none() {
                spare = None;
            }
            let Danger { open, time_to_shoot, .. } = position.danger;
            let guards = Guards::SecondLevel { opponent, blocks, rank, open, time_to_shoot };
            self.give(robot, place.unwrap_or(at), guards);
            // At most one per robot.
            let _ = kept.push(Kept { robot, opponent, blocks });
        }
        if let Some(spare) = spare {
            self.give(spare.robot, spare.place, Guards::Spare);
        }
        kept
    }

    /// Whether a robot stands there already; a place that a robot had is given up less easily.
    fn is_taken(&self, at: Point<Attack>, had: bool) -> bool {
        let room = if had { TAKEN_WITHIN_M } else { TAKEN_WITHIN_M + TAKEN_MARGIN_M };
        self.given.iter().any(|other| other.at.distance(at) < room)
    }

    /// Crossing of the edge and the line from our goal to the opponent, beside the primary that is needed.
    fn edge_place(&self, position: &Position, cover: &Cover) -> Point<Attack> {
        let goal = self.view.our_goal();
        let at = self.edge.crossing(goal, position.danger.at - goal);
        let Some(primary) = cover.primaries.first().filter(|_| cover.case < Case::DefendersAndKeeper) else {
            return at;
        };
        if primary.distance(at) >= 2.0 * self.settings.shoulder {
            return at;
        }
        let towards = if cover.upper_post { -1.0 } else { 1.0 };
        beside(&self.edge, self.edge.along(*primary), towards, self.settings)
    }
}
