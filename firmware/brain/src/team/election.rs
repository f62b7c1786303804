//! `election`: election of coordinator and retriever. The lowest id present names the retriever nearest the
//! ball (paper §4.1).

use protocol::team::{Beacon, CycleState, Decision, Status};
use protocol::{CycleId, Instant, RobotId};

use crate::teammates::Teammates;

/// The robot that must propose cycles.
pub fn elector(now: Instant, me: RobotId, teammates: &Teammates) -> RobotId {
    teammates.present(now).map(|(id, _)| id).chain([me]).min().unwrap_or(me)
}

/// The retriever that knows the ball best: near it the one with the smallest standard deviation, of equals
/// the nearest, then the lowest id. `None` without a retriever.
pub fn coordinator(now: Instant, me: RobotId, own: &Beacon, teammates: &Teammates) -> Option<RobotId> {
    let doubt = |beacon: &Beacon| {
        beacon.ball.map_or(u32::MAX, |ball| {
            let distance = u32::from(ball.distance);
            let sigma = u32::from(ball.quality.sigma_cm());
            if distance > NEAR_MM { NEAR_NOT | distance } else { sigma << 16 | distance }
        })
    };
    teammates
        .present(now)
        .map(|(id, teammate)| (id, &teammate.beacon))
        .chain([(me, own)])
        .filter(|(_, beacon)| beacon.status.has(Status::RETRIEVER))
        .min_by_key(|(id, beacon)| (doubt(beacon), *id))
        .map(|(id, _)| id)
}

/// The next cycle, as proposed in that boot epoch (`boot_epoch`) of this robot. Each epoch counts in a
/// residue class of its own: a robot that has booted cannot know which cycles its earlier epochs proposed to
/// teammates it does not receive, and cycle ids must be unique.
pub fn proposal(known: Option<CycleId>, me: RobotId, coordinator: RobotId, boot_epoch: u32) -> CycleState {
    let successor = known.map_or(0, |id| id.counter).saturating_add(1);
    let ahead = boot_epoch.wrapping_sub(successor) % LIVES;
    let counter = successor.saturating_add(ahead);
    CycleState { id: CycleId { counter, proposer: me }, coordinator, decision: Decision::Undecided }
}

/// Retrievers within this distance of the ball compare how well they know it, mm: a range at 1.5 m is 0.13 m
/// off; farther away no pose helps.
const NEAR_MM: u32 = 1_500;
/// Order of those farther away: after all others, by distance.
const NEAR_NOT: u32 = 1 << 24;
/// Number of successive boot epochs of a robot that never propose the same cycle. A power of two, so that
/// residues hold over the wrap of the difference; at a cycle a second counters last for two years.
const LIVES: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Vector;
    use protocol::Duration;
    use protocol::quantized::{WirePoint, WirePose};
    use protocol::team::{BallQuality, BallReport, Progress, Role};

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn beacon(distance: Option<u16>, retriever: bool) -> Beacon {
        blurred(distance, 0.0, retriever)
    }

    fn blurred(distance: Option<u16>, sigma: f32, retriever: bool) -> Beacon {
        let quality = BallQuality::new(sigma, Duration(0), Vector::default());
        let status = if retriever { Status::AVAILABLE.with(Status::RETRIEVER) } else { Status::AVAILABLE };
        Beacon {
            pose: WirePose::default(),
            ball: distance.map(|distance| BallReport { at: WirePoint::default(), distance, quality }),
            status,
            case_base: 0,
            cycle: None,
            progress: Progress::Idle,
            role: Role::None,
        }
    }

    #[test]
    fn the_lowest_id_elects_even_if_it_cannot_retrieve() {
        let mut teammates = Teammates::default();
        teammates.receive(Instant(0), robot(2), &beacon(Some(900), false));
        teammates.receive(Instant(0), robot(7), &beacon(Some(500), true));
        let now = Instant(40_000);
        assert_eq!(elector(now, robot(5), &teammates), robot(2));
        assert_eq!(coordinator(now, robot(5), &beacon(Some(400), false), &teammates), Some(robot(7)));
        assert_eq!(coordinator(now, robot(5), &beacon(Some(500), true), &teammates), Some(robot(5)));
        assert_eq!(coordinator(now, robot(5), &beacon(None, true), &teammates), Some(robot(7)));
    }

    #[test]
    fn near_the_ball_the_one_that_knows_it_best_is_named() {
        let mut teammates = Teammates::default();
        let now = Instant(0);
        teammates.receive(now, robot(2), &blurred(Some(900), 0.05, true));
        teammates.receive(now, robot(3), &blurred(Some(2_000), 0.01, true));
        assert_eq!(coordinator(now, robot(1), &blurred(Some(400), 0.2, true), &teammates), Some(robot(2)));
        assert_eq!(coordinator(now, robot(1), &blurred(Some(400), 0.05, true), &teammates), Some(robot(1)));
        assert_eq!(coordinator(now, robot(1), &blurred(Some(1_900), 0.9, false), &teammates), Some(robot(2)));
    }

    #[test]
    fn no_boot_epoch_proposes_a_cycle_that_another_epoch_has_proposed() {
        let mut proposed = [0_u32; 4];
        for (boot_epoch, newest) in (5..9).zip(&mut proposed) {
            let mut known = None;
            for received in [0, 1, 40, 63, 64, 65, 200] {
                let before = known.map_or(0, |id: CycleId| id.counter).max(received);
                let id = CycleId { counter: before, proposer: robot(3) };
                let next = proposal(Some(id), robot(1), robot(1), boot_epoch).id;
                assert!(next.counter > before && next.counter <= before + 64, "{before} {next}");
                assert_eq!(next.counter % 64, boot_epoch % 64);
                (known, *newest) = (Some(next), next.counter);
            }
        }
        assert_eq!(proposal(None, robot(1), robot(1), 1).id.counter, 1);
        let last = CycleId { counter: u32::MAX, proposer: robot(1) };
        assert_eq!(proposal(Some(last), robot(1), robot(1), 7).id.counter, u32::MAX);
    }

    #[test]
    fn without_a_retriever_no_one_is_named() {
        assert_eq!(coordinator(Instant(0), robot(1), &beacon(Some(1), false), &Teammates::default()), None);
    }

    #[test]
    fn the_silent_are_not_elected() {
        let mut teammates = Teammates::default();
        teammates.receive(Instant(0), robot(1), &beacon(Some(1), true));
        assert_eq!(elector(Instant(500_000), robot(3), &teammates), robot(3));
    }
}
