//! `view`: the strategy's view of the field. The field turned so that the goal we attack lies at +x
//! (docs/architecture.md §2.1: the only module that flips). SI.

use casebase::CaseRobot;
use geometry::{Angle, Attack, Field, GoalEnd, Point, Pose, Segment, Vector};
use protocol::quantized::{WirePoint, WirePose};
use protocol::{CaseId, Duration, Instant, RobotId};
use rules::{Colour, FieldSpec, Phase, Side};

use super::stakes::Stakes;
use crate::world::World;

/// An opponent whose centre is this near to the ball has the ball, m: radii of body and ball, and a margin.
pub(super) const HAS_BALL_WITHIN_M: f32 = 0.2;

/// Room above this gives no further value, m.
pub(super) const ROOM_MAX_M: f32 = 1.0;

/// Most robots of a team in a view: one per id.
pub const ROBOTS_MAX: usize = RobotId::COUNT;

/// The next pass of a case that is being played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CasePass {
    /// Number of the stored case.
    pub case: CaseId,
    /// The passer, and its robot in the case.
    pub passer: (RobotId, CaseRobot),
    /// The receiver, and its robot in the case.
    pub receiver: (RobotId, CaseRobot),
    /// The place of its reception in the adapted case.
    pub at: Point<Attack>,
}

/// What comes next for the ball in a case that is being played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CaseNext {
    /// A pass.
    Pass(CasePass),
    /// A kick by this robot.
    Kick(RobotId),
}

/// Turns between the field and the attack frame: by half a turn, or not at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    sign: f32,
}

impl Flip {
    /// For the team that defends `goal`.
    pub fn defending(goal: GoalEnd) -> Self {
        Self { sign: goal.attack_sign() as f32 }
    }

    /// The goal that the team defends.
    pub fn defends(self) -> GoalEnd {
        if self.sign < 0.0 { GoalEnd::Positive } else { GoalEnd::Negative }
    }

    /// A place in the attack frame.
    pub fn point(self, p: Point<Field>) -> Point<Attack> {
        Point::new(p.x() * self.sign, p.y() * self.sign)
    }

    /// A robot in the attack frame.
    fn robot(self, robot: &crate::world::Robot) -> ViewRobot {
        ViewRobot {
            id: robot.who.id,
            position: self.point(robot.pose.position),
            heading: self.angle(robot.pose.heading),
            velocity: self.vector(robot.velocity),
        }
    }

    /// A velocity in the attack frame.
    pub fn vector(self, v: Vector<Field>) -> Vector<Attack> {
        Vector::new(v.x() * self.sign, v.y() * self.sign)
    }

    /// A heading, in either direction.
    pub fn angle(self, heading: Angle) -> Angle {
        if self.sign < 0.0 { heading + Angle::HALF_TURN } else { heading }
    }

    /// A place of the attack frame on the field.
    pub fn to_field(self, p: Point<Attack>) -> Point<Field> {
        Point::new(p.x() * self.sign, p.y() * self.sign)
    }

    /// The same in the protocol's units.
    pub fn to_wire(self, p: Point<Attack>) -> WirePoint {
        self.to_field(p).into()
    }

    /// A place and a heading in the protocol's units.
    pub fn pose_to_wire(self, at: Point<Attack>, heading: Angle) -> WirePose {
        Pose { position: self.to_field(at), heading: self.angle(heading) }.into()
    }
}

/// The ball, in the attack frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewBall {
    /// Place on the ground, m.
    pub position: Point<Attack>,
    /// Velocity along the ground, m/s.
    pub velocity: Vector<Attack>,
    /// Stop position if no robot intercepts it, not cut at lines or walls.
    pub rest: Point<Attack>,
    /// Height above the ground, m.
    pub height: f32,
    /// Time since a camera saw it.
    pub unseen: Duration,
}

impl ViewBall {
    /// A ball at standstill.
    pub fn at_rest(position: Point<Attack>) -> Self {
        let unseen = Duration(0);
        Self { position, velocity: Vector::default(), rest: position, height: 0.0, unseen }
    }
}

/// A robot, in the attack frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRobot {
    /// The robot's number in its team.
    pub id: RobotId,
    /// Position of its centre, m.
    pub position: Point<Attack>,
    /// Heading, counter-clockwise from the attacked goal.
    pub heading: Angle,
    /// Velocity of its centre, m/s.
    pub velocity: Vector<Attack>,
}

impl ViewRobot {
    /// A robot that stands still, facing the goal we attack.
    pub fn at_rest(id: RobotId, position: Point<Attack>) -> Self {
        Self { id, position, heading: Angle::ZERO, velocity: Vector::default() }
    }
}

/// State of the game by the referee, by side (ours or theirs).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewGame {
    /// The phase of the game.
    pub phase: Phase<Side>,
    /// The phase that will start next, if the referee sends it.
    pub next: Option<Phase<Side>>,
    /// Place for the ball during a placement, m.
    pub placement: Option<Point<Field>>,
    /// The goal we defend.
    pub defending: GoalEnd,
    /// Our keeper's number, by the referee.
    pub keeper: RobotId,
    /// Their keeper's number, by the referee.
    pub their_keeper: RobotId,
    /// Worths of goals by score and time left; even where the tactics do not ask.
    pub stakes: Stakes,
}

/// All inputs of the strategy's decisions.
#[derive(Clone, Debug)]
pub struct View {
    /// The time on the host's clock.
    pub now: Instant,
    /// The phase of the game.
    pub phase: Phase<Side>,
    /// The phase that will start next, if the referee sends it.
    pub next: Option<Phase<Side>>,
    /// Place for the ball during a placement, m.
    pub placement: Option<Point<Attack>>,
    /// The ball, if its place is known.
    pub ball: Option<ViewBall>,
    /// Our robots on the field that can be commanded, by id.
    pub ours: heapless::Vec<ViewRobot, ROBOTS_MAX>,
    /// Number of further robots of ours that count on the field although they cannot be commanded.
    pub uncommanded: usize,
    /// Number of those that have never answered since this start of the host.
    pub never_answered: usize,
    /// Their robots, by id.
    pub theirs: heapless::Vec<ViewRobot, ROBOTS_MAX>,
    /// Our keeper's number, by the referee.
    pub keeper: RobotId,
    /// Their keeper's number, by the referee.
    pub their_keeper: RobotId,
    /// Worths of goals by score and time left.
    pub stakes: Stakes,
    /// Number of robots the referee allows us on the field.
    pub allowed: usize,
    /// Number of robots the referee allows them.
    pub theirs_allowed: usize,
    /// Our robots that play a case now, as they report.
    pub in_play: RobotSet,
    /// Our robots whose sensors feel the ball.
    pub contact: RobotSet,
    /// What that case does next with the ball, where the tactics include the bridge between the papers.
    pub proposal: Option<CaseNext>,
    /// Our robots that carry the case base that the host knows.
    pub knows_cases: RobotSet,
    /// Between the attack frame and the field.
    pub flip: Flip,
    /// Dimensions of the field.
    pub field: FieldSpec,
}

impl View {
    /// The field as seen by the team of colour `us`; `fit` lists our robots that can be commanded.
    pub fn of(world: &World, us: Colour, game: &ViewGame, field: FieldSpec, fit: RobotSet) -> Self {
        let flip = Flip::defending(game.defending);
        Self {
            now: world.time,
            phase: game.phase,
            next: game.next,
            placement: game.placement.map(|at| flip.point(at)),
            ball: world.ball.map(|ball| ViewBall {
                position: flip.point(ball.position),
                velocity: flip.vector(ball.velocity),
                rest: flip.point(ball.rest(&world.models)),
                height: ball.height,
                unseen: world.time.since(ball.seen),
            }),
            ours: world
                .ours(us)
                .filter(|robot| fit.has(robot.who.id))
                .map(|robot| flip.robot(robot))
                .collect(),
            uncommanded: world
                .ours(us)
                .filter(|robot| !fit.has(robot.who.id) && field.counts(game.defending, robot.pose.position))
                .count(),
            never_answered: 0,
            theirs: world.theirs(us).map(|robot| flip.robot(robot)).collect(),
            keeper: game.keeper,
            their_keeper: game.their_keeper,
            stakes: game.stakes,
            allowed: ROBOTS_MAX,
            theirs_allowed: ROBOTS_MAX,
            in_play: RobotSet::default(),
            contact: RobotSet::default(),
            proposal: None,
            knows_cases: RobotSet::default(),
            flip,
            field,
        }
    }

    /// An artificial snapshot for figures, counts and tests: play runs, a second has passed, all robots stand
    /// still at the given places, numbered from 0; the keepers are 0.
    pub fn still(
        field: FieldSpec,
        ball: Point<Attack>,
        ours: impl IntoIterator<Item = Point<Attack>>,
        theirs: impl IntoIterator<Item = Point<Attack>>,
    ) -> Self {
        let robot = |(id, position)| ViewRobot::at_rest(id, position);
        Self {
            now: Instant(1_000_000),
            phase: Phase::Run,
            next: None,
            placement: None,
            ball: Some(ViewBall::at_rest(ball)),
            ours: RobotId::all().zip(ours).map(robot).collect(),
            uncommanded: 0,
            never_answered: 0,
            theirs: RobotId::all().zip(theirs).map(robot).collect(),
            keeper: RobotId::ZERO,
            their_keeper: RobotId::ZERO,
            stakes: Stakes::EVEN,
            allowed: ROBOTS_MAX,
            theirs_allowed: ROBOTS_MAX,
            in_play: RobotSet::default(),
            contact: RobotSet::default(),
            proposal: None,
            knows_cases: RobotSet::default(),
            flip: Flip::defending(GoalEnd::Negative),
            field,
        }
    }

    /// The same, with a limit on the number of our robots on the field.
    pub fn allowing(self, robots: usize) -> Self {
        Self { allowed: robots, ..self }
    }

    /// The same, with a limit on the number of their robots on the field.
    pub fn allowing_them(self, robots: usize) -> Self {
        Self { theirs_allowed: robots, ..self }
    }

    /// The same, with what the case that robots play does next with the ball.
    pub fn proposing(self, proposal: Option<CaseNext>) -> Self {
        Self { proposal, ..self }
    }

    /// The pass of `who` that is next in the case that is played.
    pub fn proposed_pass(&self, who: RobotId) -> Option<CasePass> {
        match self.proposal {
            Some(CaseNext::Pass(pass)) if pass.passer.0 == who => Some(pass),
            _ => None,
        }
    }

    /// The same, without these robots of ours.
    pub fn without(&self, off: &[RobotId]) -> Self {
        let mut view = self.clone();
        view.ours.retain(|robot| !off.contains(&robot.id));
        view
    }

    /// Whether a robot of ours at `p` counts as on the field: outside the goal substitution area behind our
    /// goal.
    pub fn counts_for_us(&self, p: Point<Attack>) -> bool {
        self.field.counts(GoalEnd::Negative, Point::new(p.x(), p.y()))
    }

    /// The same of a robot of theirs.
    pub fn counts_for_them(&self, p: Point<Attack>) -> bool {
        self.field.counts(GoalEnd::Positive, Point::new(p.x(), p.y()))
    }

    /// Our robot of that number.
    pub fn our(&self, id: RobotId) -> Option<&ViewRobot> {
        self.ours.iter().find(|robot| robot.id == id)
    }

    /// Middle of our goal's opening.
    pub fn our_goal(&self) -> Point<Attack> {
        Point::new(-self.field.length * 0.5, 0.0)
    }

    /// Middle of the opening of the goal we attack.
    pub fn their_goal(&self) -> Point<Attack> {
        Point::new(self.field.length * 0.5, 0.0)
    }

    /// Whether a place is in our defence area, grown by `margin` m.
    pub fn in_our_area(&self, p: Point<Attack>, margin: f32) -> bool {
        self.in_area(Point::new(-p.x(), p.y()), margin)
    }

    /// Whether a place is in their defence area, grown by `margin` m.
    pub fn in_their_area(&self, p: Point<Attack>, margin: f32) -> bool {
        self.in_area(p, margin)
    }

    fn in_area(&self, p: Point<Attack>, margin: f32) -> bool {
        let depth = self.field.length * 0.5 - p.x();
        depth <= self.field.penalty_depth + margin && p.y().abs() <= self.field.penalty_width * 0.5 + margin
    }

    /// The opponent nearest to `point`, with its distance, m.
    pub fn nearest_theirs(&self, point: Point<Attack>) -> Option<(&ViewRobot, f32)> {
        nearest(self.theirs.iter(), point)
    }

    /// Distance of the nearest opponent from the path of a ball, m; at most a metre.
    pub fn room_along(&self, from: Point<Attack>, to: Point<Attack>) -> f32 {
        let ray = Segment::new(from, to);
        self.theirs.iter().map(|robot| ray.distance_to(robot.position)).fold(ROOM_MAX_M, f32::min)
    }

    /// Distance of the nearest opponent from a place, m; infinite without opponents.
    pub fn theirs_within(&self, point: Point<Attack>) -> f32 {
        self.nearest_theirs(point).map_or(f32::INFINITY, |(_, distance)| distance)
    }

    /// The nearest place at least `inside` m within the lines.
    pub fn clamp(&self, p: Point<Attack>, inside: f32) -> Point<Attack> {
        let (x, y) = (self.field.length * 0.5 - inside, self.field.width * 0.5 - inside);
        Point::new(p.x().clamp(-x, x), p.y().clamp(-y, y))
    }
}

/// The robot nearest to `point`; the first one among equals.
pub fn nearest<'r>(
    robots: impl Iterator<Item = &'r ViewRobot>,
    point: Point<Attack>,
) -> Option<(&'r ViewRobot, f32)> {
    robots
        .map(|robot| (robot, robot.position.distance(point)))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })
}

/// A set of our robots, one bit per number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct RobotSet(u16);

impl RobotSet {
    /// Adds a robot; no effect if it is in the set.
    pub fn insert(&mut self, id: RobotId) {
        self.0 |= 1 << id.number();
    }

    /// Adds a robot, or takes it out.
    pub fn set(&mut self, id: RobotId, is_in: bool) {
        let bit = 1 << id.number();
        self.0 = if is_in { self.0 | bit } else { self.0 & !bit };
    }

    /// Whether it contains that robot.
    pub fn has(self, id: RobotId) -> bool {
        self.0 & (1 << id.number()) != 0
    }

    /// Number of robots in the set.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether it contains no robot.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use rules::League;

    /// A view of division B's field with our robots 0, 1, … and theirs at these places, towards +x.
    pub(crate) fn view(ball: (f32, f32), ours: &[(f32, f32)], theirs: &[(f32, f32)]) -> View {
        let at = |&(x, y): &(f32, f32)| Point::new(x, y);
        View::still(League::DivisionB.field(), at(&ball), ours.iter().map(at), theirs.iter().map(at))
    }

    #[test]
    fn for_a_team_at_the_positive_goal_the_view_is_turned_by_half_a_turn() {
        let flip = Flip::defending(GoalEnd::Positive);
        assert_eq!(flip.point(Point::new(1.0, -2.0)), Point::new(-1.0, 2.0));
        assert_eq!(flip.to_field(Point::new(-1.0, 2.0)), Point::new(1.0, -2.0));
        assert!((flip.angle(Angle::ZERO) - Angle::HALF_TURN).abs() < 1e-6);
        let straight = Flip::defending(GoalEnd::Negative);
        assert_eq!(straight.vector(Vector::new(1.0, 0.5)), Vector::new(1.0, 0.5));
    }

    #[test]
    fn areas_are_at_their_own_ends_and_grow_by_a_margin() {
        let view = view((0.0, 0.0), &[], &[]);
        assert!(view.in_our_area(Point::new(-4.0, 0.9), 0.0) && !view.in_our_area(Point::new(4.0, 0.9), 0.0));
        assert!(
            !view.in_their_area(Point::new(3.4, 0.0), 0.0) && view.in_their_area(Point::new(3.4, 0.0), 0.2)
        );
    }
}
