//! `case`: one stored case (Ros et al. 2009, §2). A view into the table; mm, field frame.

use protocol::CaseId;

use crate::action::{Action, CaseRobot, KickId, TurnTarget};
use crate::leg::{Corridor, Leg, LegKind, RelativeLeg};
use crate::plan_simulation::{HandOver, Script, plan_simulation};
use crate::presence::Presence;
use crate::settings::SCOPE_EXPONENT;
use crate::stored::Stored;
use crate::table::{CaseBase, Group, OpponentRecord, RawAction, RawLeg, RecordHeader, part};
use crate::{GoalEnd, PointMm, Scope, Symmetry};

/// A stored case: case = (P, A, K). Cheap to copy: it contains only references.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    base: CaseBase<'a>,
    id: CaseId,
    record_header: &'a RecordHeader,
    group: &'a Group,
}

impl<'a> Case<'a> {
    #[inline]
    pub(crate) fn new(base: CaseBase<'a>, id: CaseId) -> Option<Self> {
        let record_header = base.record_headers.get(usize::from(id.0))?;
        let group = base.groups.get(usize::from(id.0 / 4))?;
        Some(Self { base, id, record_header, group })
    }

    /// Number in the base: 4 × authored + symmetry.
    pub const fn id(&self) -> CaseId {
        self.id
    }

    /// Number of the authored case it comes from.
    pub const fn authored(&self) -> usize {
        self.id.0 as usize / 4
    }

    /// The symmetry by which it was derived from the authored one.
    pub const fn symmetry(&self) -> Symmetry {
        Symmetry::from_bits(self.id.0)
    }

    /// G: the goal that the case's team defends, of this symmetric copy.
    pub const fn defending(&self) -> GoalEnd {
        let authored = if self.group.defending == 0 { GoalEnd::Negative } else { GoalEnd::Positive };
        self.symmetry().goal(authored)
    }

    /// B_c: the ball's position in the case, mm, field frame.
    pub const fn ball(&self) -> PointMm {
        PointMm { x: self.record_header.ball[0] as i32, y: self.record_header.ball[1] as i32 }
    }

    /// The ball's scope: radii τx, τy around B_c, mm.
    pub fn ball_scope(&self) -> Scope {
        scope(self.record_header.inverse_scope)
    }

    /// Number of robots of the case, which is that of its gameplays.
    pub const fn teammates(&self) -> usize {
        self.record_header.teammates as usize
    }

    /// The case's robots, in their order.
    pub fn robots(&self) -> impl Iterator<Item = CaseRobot> + Clone + use<> {
        CaseRobot::first(self.teammates())
    }

    /// Position of the robot in the case; the ball's position for a robot that the case does not have.
    pub fn position(&self, robot: CaseRobot) -> PointMm {
        self.ball().plus(self.relative_position(robot))
    }

    /// B_p − B_c: displacement of the case for a ball at `ball`.
    pub const fn shift(&self, ball: PointMm) -> PointMm {
        ball.minus(self.ball())
    }

    /// Adapted position of the robot for a ball at `ball`; never clamped.
    pub fn adapted(&self, robot: CaseRobot, ball: PointMm) -> PointMm {
        ball.plus(self.relative_position(robot))
    }

    /// The robot's actions, in the case's own coordinates.
    pub fn gameplay(&self, robot: CaseRobot) -> impl Iterator<Item = Action> + use<'a> {
        let case = *self;
        case.raw_gameplay(robot).iter().map(move |raw| case.decode(*raw))
    }

    /// One of the robot's actions.
    pub fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        self.raw_gameplay(robot).get(index).map(|raw| self.decode(*raw))
    }

    /// The opponents and their scopes, in the case's own coordinates.
    pub fn opponents(&self) -> impl Iterator<Item = (PointMm, Scope)> + use<'a> {
        let ball = self.ball();
        self.raw_opponents().iter().map(move |raw| (ball.plus(widen(raw.at)), scope(raw.inverse_scope)))
    }

    /// Demand of the scope of the opponent of that number, from 0.
    pub const fn presence(&self, opponent: usize) -> Presence {
        self.record_header.demands().get(opponent)
    }

    /// The robot whose first action is `get_ball`.
    pub fn getter(&self) -> CaseRobot {
        CaseRobot::new(usize::from(self.group.getter)).unwrap_or(CaseRobot::FIRST)
    }

    /// Returns whether the ball lies in the ball's scope, at the paper's threshold.
    pub fn ball_in_scope(&self, ball: PointMm) -> bool {
        self.ball_exponent(ball) < SCOPE_EXPONENT
    }

    /// The legs of the ball path for a ball at `ball`, as stored: mm, field frame.
    pub fn legs(&self, ball: PointMm) -> impl Iterator<Item = Leg> + use<'a> {
        self.relative_legs(ball).map(move |leg| leg.at(ball))
    }

    /// The other end of a hand-over in the plan simulation: `pass_ball` and the `receive_ball` that answers
    /// it lead to each other; a later `get_ball` leads to the kick that hands the ball to it.
    pub fn partner_of(&self, robot: CaseRobot, action: usize) -> Option<(CaseRobot, usize)> {
        let mut partner = None;
        let here = (robot, action);
        // A stored case was simulated without an error when it was built; steps before an error would still
        // be right.
        let _ = plan_simulation(self, &self.base, |step| {
            if let Some(HandOver { from, to, by_pass }) = step.hand_over() {
                if to == here {
                    partner = Some(from);
                } else if by_pass && from == here {
                    partner = Some(to);
                }
            }
        });
        partner
    }

    #[inline]
    pub(crate) fn stored(&self) -> Option<Stored<'_, 'a>> {
        Stored::new(&self.base, self.id)
    }

    pub(crate) const fn base(&self) -> &CaseBase<'a> {
        &self.base
    }

    /// (Δx/τx)² + (Δy/τy)² of the ball in its scope.
    #[inline]
    pub(crate) fn ball_exponent(&self, ball: PointMm) -> f32 {
        self.record_header.exponent(ball.to_f32())
    }

    /// The robot's position relative to the case's ball.
    #[inline]
    pub(crate) fn relative_position(&self, robot: CaseRobot) -> PointMm {
        self.relative_positions().get(robot.index()).copied().map_or(PointMm::new(0, 0), widen)
    }

    #[inline]
    pub(crate) fn relative_positions(&self) -> &'a [[i16; 2]] {
        self.record_header.positions(self.base.places).unwrap_or(&[])
    }

    #[inline]
    pub(crate) fn raw_opponents(&self) -> &'a [OpponentRecord] {
        self.record_header.opponents(self.base.places).unwrap_or(&[])
    }

    /// The stored legs relative to a ball at `ball`.
    pub(crate) fn relative_legs(&self, ball: PointMm) -> impl Iterator<Item = RelativeLeg> + use<'a> {
        let case = *self;
        self.raw_legs().iter().scan([0.0; 2], move |rest, raw| {
            let corridor = case.stored()?.corridor(raw, *rest, ball.to_f32());
            *rest = corridor.to();
            case.leg(raw, corridor)
        })
    }

    /// The stored legs as records; each begins where the one before ends.
    #[inline]
    pub(crate) fn raw_legs(&self) -> &'a [RawLeg] {
        self.record_header.legs(self.base.places).unwrap_or(&[])
    }

    fn point(&self, index: u8) -> PointMm {
        self.group.point(self.base.points, self.copy(), index)
    }

    /// A stored leg with its robot, action and kind.
    fn leg(&self, raw: &RawLeg, corridor: Corridor) -> Option<RelativeLeg> {
        let robot = CaseRobot::new(usize::from(raw.robot))?;
        let action = usize::from(raw.action);
        let kind = match self.action(robot, action)? {
            Action::PassBall(receiver) => LegKind::Pass(receiver),
            Action::Kick(id) => LegKind::Kick(id),
            _ => return None,
        };
        Some(RelativeLeg(corridor.into_leg(robot, action, kind)))
    }

    const fn copy(&self) -> u16 {
        self.id.0 & 3
    }

    fn raw_gameplay(&self, robot: CaseRobot) -> &'a [RawAction] {
        let ends = &self.group.list_ends;
        if robot.index() >= self.teammates() {
            return &[];
        }
        let count = ends[self.teammates().clamp(1, ends.len()) - 1];
        let from = robot.index().checked_sub(1).map_or(0, |before| ends[before]);
        part(self.base.actions, self.group.actions_at, count, self.copy())
            .get(usize::from(from)..usize::from(ends[robot.index()]))
            .unwrap_or(&[])
    }

    fn decode(&self, raw: RawAction) -> Action {
        let robot = || CaseRobot::new(usize::from(raw.argument)).unwrap_or(CaseRobot::FIRST);
        match raw.kind {
            RawAction::GO_TO_POINT => Action::GoToPoint(self.point(raw.argument)),
            RawAction::TURN_HEADING => Action::Turn(TurnTarget::HeadingDeg(self.point(raw.argument).x)),
            RawAction::TURN_FACE => Action::Turn(TurnTarget::Face(self.point(raw.argument))),
            RawAction::GET_BALL => Action::GetBall,
            RawAction::DRIBBLE_TO => Action::DribbleTo(self.point(raw.argument)),
            RawAction::PASS_BALL => Action::PassBall(robot()),
            RawAction::RECEIVE_BALL => Action::ReceiveBall(robot()),
            RawAction::KICK => Action::Kick(KickId(raw.argument)),
            _ => Action::Wait,
        }
    }
}

impl<'a> CaseBase<'a> {
    /// The stored case with this id; `None` if the table has no such case.
    pub fn case(&self, id: CaseId) -> Option<Case<'a>> {
        Case::new(*self, id)
    }

    /// Every stored case, lowest id first.
    pub fn cases(&self) -> impl Iterator<Item = Case<'a>> + use<'a> {
        let base = *self;
        (0..base.len() as u32).filter_map(move |id| base.case(CaseId(id as u16)))
    }
}

impl<'a> Stored<'_, 'a> {
    /// The same case as [`Case`].
    pub(crate) fn case(&self) -> Option<Case<'a>> {
        Case::new(*self.base, self.id)
    }
}

impl Script for Case<'_> {
    fn teammates(&self) -> usize {
        self.teammates()
    }
    fn defending(&self) -> GoalEnd {
        self.defending()
    }
    fn ball(&self) -> PointMm {
        self.ball()
    }
    fn position(&self, robot: CaseRobot) -> PointMm {
        self.position(robot)
    }
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action> {
        self.action(robot, index)
    }
}

#[inline]
pub(crate) fn widen([x, y]: [i16; 2]) -> PointMm {
    PointMm { x: i32::from(x), y: i32::from(y) }
}

fn scope([x, y]: [f32; 2]) -> Scope {
    Scope { x: geometry::math::round_to_i32(1.0 / x), y: geometry::math::round_to_i32(1.0 / y) }
}
