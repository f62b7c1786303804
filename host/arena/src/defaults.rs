//! `defaults`: time that a team played its default behaviour, and why (paper §5.4: "only when the costs
//! exceeded the threshold").
//!
//! A spell starts with a coordinator's decision that no case fits and lasts until a case is decided on. Why
//! none fitted is judged from the true positions at the end of the tick in which that is received: the
//! farthest any case came through retrieval's tests (docs/case-format.md §3).

use casebase::{CaseBase, CaseVerdict, GoalEnd, Problem, RetrievalSettings, explain};
use hil_sim::TICK_US;
use hil_sim::four_legged::world::{LeggedWorld, Side};
use protocol::{CycleId, RobotId};

use crate::cycles::CycleSeen;
use crate::report::{Causes, DefaultReport, in_seconds};

/// Watches one team's default behaviour.
#[derive(Clone, Debug, Default)]
pub(crate) struct DefaultWatch {
    active: bool,
    /// The cycle whose lack of a case was counted last.
    judged: Option<CycleId>,
    ticks: u32,
    spells: u32,
    causes: Causes,
}

impl DefaultWatch {
    pub(crate) fn tick(&mut self) {
        self.ticks += u32::from(self.active);
    }

    /// Takes the newest cycle when it is decided on or ended.
    pub(crate) fn receive(
        &mut self,
        cycle: &CycleSeen,
        problem: &Problem,
        base: &CaseBase<'_>,
        settings: &RetrievalSettings,
    ) {
        if cycle.play.is_some() {
            self.active = false;
        } else if cycle.no_case && self.judged != Some(cycle.id) {
            self.judged = Some(cycle.id);
            self.spells += u32::from(!self.active);
            self.active = true;
            *self.causes.of(base, problem, settings) += 1;
        }
    }

    pub(crate) fn report(&self) -> DefaultReport {
        let seconds = self.ticks as f32 * (TICK_US as f32 * 1e-6);
        DefaultReport { time_s: in_seconds(seconds), spells: self.spells, causes: self.causes }
    }
}

impl Causes {
    fn of(&mut self, base: &CaseBase<'_>, problem: &Problem, settings: &RetrievalSettings) -> &mut u32 {
        let mut farthest = 0;
        explain(base, problem, settings, |_, verdict| {
            farthest = farthest.max(match verdict {
                CaseVerdict::Ball { .. } => 0,
                CaseVerdict::Robots { .. } => 1,
                CaseVerdict::OutOfField { .. } | CaseVerdict::TooFar { .. } => 2,
                CaseVerdict::Path { .. } | CaseVerdict::Opponents { .. } => 3,
                CaseVerdict::Candidate(_) => 4,
            });
        });
        match farthest {
            0 => &mut self.ball,
            1 => &mut self.robots,
            2 => &mut self.thr_c,
            3 => &mut self.path,
            _ => &mut self.held,
        }
    }

    /// Sum over all causes.
    pub fn total(&self) -> u32 {
        let Self { ball, robots, thr_c, path, held } = *self;
        ball + robots + thr_c + path + held
    }
}

/// View of a coordinator without noise: the ball at its stop position, the attackers by id, all other
/// robots.
pub(crate) fn problem(world: &LeggedWorld, attackers: &[RobotId], deceleration: f32) -> Problem {
    let places = |side| {
        let walkers = world.walkers.iter().filter(move |walker| walker.side == side);
        walkers.map(|walker| walker.pose.position.into())
    };
    let ids = attackers.iter().copied();
    Problem {
        ball: world.ball.rest(deceleration).into(),
        defending: GoalEnd::Negative,
        teammates: ids.zip(places(Side::Attackers)).collect(),
        opponents: places(Side::Opponents).collect(),
    }
}

#[cfg(test)]
mod tests {
    use casebase::PointMm;

    use super::*;

    const fn at(x: i32, y: i32) -> PointMm {
        PointMm { x, y }
    }

    fn cause(ball: PointMm, teammates: &[PointMm]) -> Causes {
        let id = |n: usize| RobotId::new(n as u8).unwrap();
        let problem = Problem {
            ball,
            teammates: teammates.iter().enumerate().map(|(i, teammate)| (id(i + 1), *teammate)).collect(),
            ..problem_of_nobody()
        };
        let mut causes = Causes::default();
        *causes.of(&case_library::four_legged(), &problem, &RetrievalSettings::default()) += 1;
        causes
    }

    fn cycle(counter: u32, no_case: bool, play: bool) -> CycleSeen {
        use protocol::quantized::WirePoint;
        use protocol::team::{Play, ShotRule};
        let id = RobotId::new(1).unwrap();
        let play = play.then(|| Play {
            case: protocol::CaseId(0),
            ball: WirePoint::default(),
            robots: [id].into_iter().collect(),
        });
        CycleSeen {
            id: CycleId { counter, proposer: id },
            coordinator: id,
            play,
            no_case,
            start: 0.0,
            end: None,
            shot: ShotRule::NoShot,
        }
    }

    #[test]
    fn the_cause_is_the_farthest_any_case_came() {
        assert_eq!(cause(at(60_000, 0), &[at(0, 0)]), Causes { ball: 1, ..Causes::default() });
        // The ball is in scopes of the built-in library, but the robots are a field's length away.
        assert_eq!(
            cause(at(0, 0), &[at(9_000, 9_000), at(9_000, 8_000)]),
            Causes { thr_c: 1, ..Causes::default() }
        );
        assert_eq!(cause(at(0, 0), &[]), Causes { robots: 1, ..Causes::default() });
        assert_eq!(cause(at(0, 0), &[at(-150, 0), at(800, 900)]), Causes { held: 1, ..Causes::default() });
    }

    #[test]
    fn a_spell_lasts_from_the_first_report_to_the_next_case() {
        let problem = Problem { ball: at(60_000, 0), ..problem_of_nobody() };
        let (base, settings) = (case_library::four_legged(), RetrievalSettings::default());
        let mut watch = DefaultWatch::default();
        // The second report of cycle 2 is its closing.
        for (counter, no_case, play, ticks) in [
            (1, true, false, 5),
            (2, true, false, 2),
            (2, true, false, 3),
            (3, false, true, 100),
            (4, true, false, 15),
        ] {
            watch.receive(&cycle(counter, no_case, play), &problem, &base, &settings);
            (0..ticks).for_each(|_| watch.tick());
        }
        let causes = Causes { ball: 3, ..Causes::default() };
        assert_eq!(watch.report(), DefaultReport { time_s: 1.0, spells: 2, causes });
        assert_eq!(causes.total(), 3);
    }

    fn problem_of_nobody() -> Problem {
        Problem {
            ball: at(0, 0),
            defending: GoalEnd::Negative,
            teammates: std::iter::empty().collect(),
            opponents: std::iter::empty().collect(),
        }
    }
}
