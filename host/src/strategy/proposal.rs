//! `proposal`: what the case that our robots play does next with the ball: the cycle that they report, looked
//! up in the case base that they carry (docs/papers.md §8: the case is the intent). From the field to the
//! attack frame, m.

use casebase::{CaseBase, CaseRobot, LegKind};
use protocol::RobotId;
use protocol::team::{Beacon, CycleState, Progress};
use rules::League;

use super::Flip;
use super::view::{CaseNext, CasePass};

/// The cases that come with a league; cases of robots with another case base cannot be looked up.
pub fn cases_of(league: League) -> CaseBase<'static> {
    case_library::league(league.name()).map_or_else(CaseBase::default, case_library::League::base)
}

/// The next leg of the newest cycle that robots with this case base report. `None` where they play no case,
/// or where its kicker is not, or no longer, at it.
pub(crate) fn proposal(base: &CaseBase<'_>, reported: &[(RobotId, &Beacon)], flip: Flip) -> Option<CaseNext> {
    let reported = || reported.iter().copied().filter(|(_, beacon)| beacon.case_base == base.hash());
    let newest = reported().filter_map(|(_, beacon)| beacon.cycle.as_ref()).fold(None, newer)?;
    let play = newest.play()?;
    let case = base.case(play.case)?;
    let progress = |robot: RobotId| {
        let (_, beacon) =
            reported().find(|(id, beacon)| *id == robot && beacon.cycle.as_ref() == Some(newest))?;
        Some(beacon.progress)
    };
    // A robot that has not received the cycle yet has done nothing in it.
    let done = |robot: RobotId| match progress(robot) {
        Some(Progress::Execute { done }) => usize::from(done),
        Some(Progress::WaitEnd { .. }) => usize::MAX,
        _ => 0,
    };
    let player = |part: CaseRobot| play.robots.get(part.index()).copied();
    let leg =
        case.legs(play.ball.into()).find(|leg| player(leg.robot).is_some_and(|id| leg.action >= done(id)))?;
    let passer = player(leg.robot)?;
    matches!(progress(passer), Some(Progress::Adapt { .. } | Progress::Execute { .. })).then_some(())?;
    let LegKind::Pass(to) = leg.kind else { return Some(CaseNext::Kick(passer)) };
    Some(CaseNext::Pass(CasePass {
        case: play.case,
        passer: (passer, leg.robot),
        receiver: (player(to)?, to),
        at: flip.point(leg.end()),
    }))
}

fn newer<'s>(known: Option<&'s CycleState>, other: &'s CycleState) -> Option<&'s CycleState> {
    if other.is_newer_than(known) { Some(other) } else { known }
}

#[cfg(test)]
mod tests {
    use super::*;
    use casebase::Action;
    use geometry::{Attack, GoalEnd, Point};
    use protocol::quantized::{WirePoint, WirePose};
    use protocol::team::{Decision, Play, Role, Status};
    use protocol::{CaseId, CycleId};

    /// A cycle that plays this case with robots 3, 1 and so on, the ball in the middle.
    fn cycle(counter: u32, case: u16, robots: usize) -> CycleState {
        let robots = [3, 1, 2, 4].into_iter().take(robots).filter_map(RobotId::new).collect();
        let play = Play { case: CaseId(case), ball: WirePoint { x: 0, y: 0 }, robots };
        let coordinator = RobotId::ZERO;
        CycleState {
            id: CycleId { counter, proposer: coordinator },
            coordinator,
            decision: Decision::Play(play),
        }
    }

    fn beacon(case_base: u32, cycle: CycleState, progress: Progress) -> Beacon {
        Beacon {
            pose: WirePose { at: WirePoint { x: 0, y: 0 }, heading: 0 },
            ball: None,
            status: Status::default(),
            case_base,
            cycle: Some(cycle),
            progress,
            role: Role::None,
        }
    }

    #[test]
    fn the_getters_pass_goes_to_where_the_case_has_the_receiver_until_it_is_done() {
        let base = case_library::division_b();
        let mut seen = 0;
        for id in 0..base.len() as u16 {
            let case = base.case(CaseId(id)).unwrap();
            // Get, pass, and a receiver that waits at its own place: by hand the leg ends there.
            let getter = case.getter();
            let Some(Action::PassBall(to)) = case.action(getter, 1) else { continue };
            if !case
                .gameplay(to)
                .take_while(|action| !matches!(action, Action::ReceiveBall(_)))
                .all(|action| action == Action::Wait)
            {
                continue;
            }
            seen += 1;
            let of = |part: casebase::CaseRobot| RobotId::new([3, 1, 2, 4][part.index()]).unwrap();
            let state = cycle(7, id, case.robots().count());
            let old = cycle(6, id, 0);
            let reported = |done| {
                let mine = beacon(base.hash(), state.clone(), done);
                let late = beacon(base.hash(), old.clone(), Progress::Execute { done: 9 });
                [(of(getter), mine), (of(to), late)]
            };
            let find = |reported: &[(RobotId, Beacon)]| {
                let reported: Vec<_> = reported.iter().map(|(id, beacon)| (*id, beacon)).collect();
                proposal(&base, &reported, Flip::defending(GoalEnd::Positive))
            };
            let Some(CaseNext::Pass(found)) = find(&reported(Progress::Execute { done: 1 })) else {
                panic!("case {id} is at its pass")
            };
            assert_eq!(found.case, CaseId(id));
            assert_eq!((found.passer, found.receiver), ((of(getter), getter), (of(to), to)), "case {id}");
            let at = case.adapted(to, casebase::PointMm { x: 0, y: 0 });
            // A team that defends the goal at +x attacks towards −x.
            let by_hand = Point::<Attack>::new(at.x as f32 * -0.001, at.y as f32 * -0.001);
            assert!(found.at.distance(by_hand) < 1e-3, "case {id}: {found:?}, by hand {by_hand:?}");
            // Once it is done the proposal is another one, or none.
            assert!(
                find(&reported(Progress::Execute { done: 2 })) != Some(CaseNext::Pass(found)),
                "case {id}"
            );
            // A robot that the host called away, or that has ended, is not a passer of any case.
            assert_eq!(find(&reported(Progress::Idle)), None);
            // Cycles of robots with another case base are ignored.
            let mut others = reported(Progress::Execute { done: 1 });
            for (_, beacon) in &mut others {
                beacon.case_base ^= 1;
            }
            assert_eq!(find(&others), None);
        }
        assert!(seen > 4, "{seen} such cases");
    }

    #[test]
    fn a_case_that_begins_with_a_shot_has_it_next() {
        let base = case_library::division_b();
        let first = |id: &CaseId| base.case(*id)?.legs(WirePoint { x: 0, y: 0 }.into()).next();
        let of_shots = (0..base.len() as u16)
            .map(CaseId)
            .filter(|id| first(id).is_some_and(|leg| matches!(leg.kind, LegKind::Kick(_))));
        let mut seen = 0;
        for id in of_shots {
            let case = base.case(id).unwrap();
            let by = RobotId::new([3, 1, 2, 4][first(&id).unwrap().robot.index()]).unwrap();
            let state = cycle(7, id.0, case.robots().count());
            let adapts = beacon(base.hash(), state, Progress::Adapt { arrived: false });
            let found = proposal(&base, &[(by, &adapts)], Flip::defending(GoalEnd::Negative));
            assert_eq!(found, Some(CaseNext::Kick(by)), "case {id}");
            seen += 1;
        }
        assert!(seen > 4, "{seen} such cases");
    }
}
