//! `explained`: the newest decision with the problem it rests on, kept packed and reported to the host in
//! parts (protocol/SPEC.md, "DecisionPart").

use casebase::Problem;
use protocol::decision::{DecisionPart, DecisionReport, Grounds, PackedReport};
use protocol::quantized::WirePoint;
use protocol::team::Decision;
use protocol::{CycleId, Instant};

use super::Brain;

/// A decision of this robot's, and the problem it decided on.
#[derive(Clone, Debug)]
pub(super) struct Explained {
    report: PackedReport,
    /// Number of parts sent.
    sent: u8,
}

impl Explained {
    /// `decision` in `cycle`, which rests on `grounds` and `problem`. Not inlined: the report shall not lie
    /// on the stack of a step.
    #[inline(never)]
    pub(super) fn new(
        cycle: CycleId,
        decision: &Decision,
        grounds: Grounds,
        problem: Option<&Problem>,
    ) -> Self {
        let mut report = DecisionReport {
            cycle,
            grounds,
            case: match decision {
                Decision::Play(play) => Some(play.case),
                _ => None,
            },
            defending: geometry::GoalEnd::Negative,
            ball: WirePoint::default(),
            teammates: heapless::Vec::new(),
            opponents: heapless::Vec::new(),
        };
        if let Some(problem) = problem {
            report.defending = problem.defending;
            report.ball = problem.ball.into();
            // A problem has no more robots than a report.
            for (id, place) in &problem.teammates {
                let _room = report.teammates.push((*id, (*place).into()));
            }
            for place in &problem.opponents {
                let _room = report.opponents.push((*place).into());
            }
        }
        Self { report: report.packed(), sent: 0 }
    }
}

impl Brain<'_> {
    /// This robot's newest decision with the problem it decided on, if it has coordinated a cycle.
    pub fn decision(&self) -> Option<DecisionReport> {
        self.explained.as_ref()?.report.report()
    }

    /// The next part for the host: each is sent twice, in steps in which nothing else is sent.
    pub(super) fn explanation(&mut self, now: Instant) -> Option<DecisionPart> {
        if self.host.is_none() || self.spoken.spoke_at(now) {
            return None;
        }
        let explained = self.explained.as_mut().filter(|explained| explained.sent < SENT_ALL)?;
        let parts = explained.report.parts();
        let part = explained.report.part(explained.sent.checked_rem(parts)?);
        explained.sent += 1;
        if explained.sent >= REPEATS * parts {
            explained.sent = SENT_ALL;
        }
        self.spoken.explained(now);
        Some(part)
    }
}

/// How often each part is sent: a lost one loses only the explanation.
const REPEATS: u8 = 2;
/// Everything was sent.
const SENT_ALL: u8 = u8::MAX;
