//! `keep_out`: the rules of 2026 as shapes: forbidden regions, speed limits and touch bans for a robot.
//!
//! Robots' skills, host and referee call these functions, so that there is one definition. Shapes are for the
//! robot's *body*: a planner for its centre grows them by its radius, and by its own noise
//! ([`KeepOut::offence`] does the former). Lines belong to the areas they bound. Field frame, m. No state is
//! kept here: double touches, grace times and counts are the caller's.

use geometry::{Field, GoalEnd, Point, Segment, Shape};
use heapless::Vec;

use crate::legality::{InArea, in_area};
use crate::limits::{
    BALL_DISTANCE, BALL_RADIUS, NEAR_MARK, OPPONENT_AREA_DISTANCE, PENALTY_BEHIND, ROBOT_RADIUS, STOP_SPEED,
};
use crate::{FieldSpec, Phase, RuleRole, Side};

/// Most shapes in a list: a keeper at a penalty, with a reserve.
pub const FORBIDDEN_MAX: usize = 12;

/// Inputs that decide where a robot may be. `Side` is from its own team's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation<'a> {
    /// Dimensions of the field.
    pub field: &'a FieldSpec,
    /// The goal its team defends.
    pub own: GoalEnd,
    /// The phase of the game.
    pub phase: Phase<Side>,
    /// Role of the robot under the rules.
    pub rule_role: RuleRole,
    /// Position of the ball; `None`: nothing around it is forbidden.
    pub ball: Option<Point<Field>>,
    /// Placement target of the ball; only used in ball placement.
    pub placement: Option<Point<Field>>,
    /// True once the ball has left its place since NORMAL_START; only used for a penalty's keeper, who then
    /// may move.
    pub ball_in_play: bool,
}

/// Reason why a place is forbidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeepOutReason {
    /// Within 0.5 m of the ball on STOP, or at the opponents' kick-off or free kick.
    BallDistance,
    /// On the ball before NORMAL_START.
    BallTouch,
    /// The place is in the own defence area, except for the keeper.
    OwnArea,
    /// The place is in the opponents' defence area, or within 0.2 m of it on STOP and at free kicks.
    OpponentArea,
    /// The place is in the other half at a kick-off.
    OtherHalf,
    /// The place is in the centre circle at a kick-off, except for the kicker.
    CentreCircle,
    /// Less than 1 m behind the ball at a penalty.
    BehindBall,
    /// The keeper at a penalty, off its line or not between the posts.
    KeeperLine,
    /// Within 0.5 m of the line from ball to target while opponents place.
    Stadium,
    /// Within 0.5 m of the target while a teammate places: a force start may follow, and it would not count
    /// as placed.
    Target,
    /// Beyond the field surface.
    Border,
}

impl KeepOutReason {
    /// Returns whether being there is an offence or a failure by itself. Where it is not, robots keep out
    /// because being there is useless: in the opponents' area the ball may not be touched, at the target
    /// teammates are on the path.
    pub const fn offends(self, phase: Phase<Side>) -> bool {
        match self {
            Self::Target | Self::Border => false,
            Self::OpponentArea => matches!(phase, Phase::Stop | Phase::FreeKick(_)),
            _ => true,
        }
    }
}

/// A region and the reason to keep out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forbidden {
    /// No part of the body may be in here.
    pub shape: Shape<Field>,
    /// Reason for the region.
    pub why: KeepOutReason,
}

/// Regions where a robot must not be, and the one it must stay in.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepOut {
    /// No part of the body may be in any of these.
    pub forbidden: Vec<Forbidden, FORBIDDEN_MAX>,
    /// The whole body must be in here: the field surface within the walls.
    pub within: Shape<Field>,
}

impl KeepOut {
    /// The first region that a disc-shaped body at this place reaches into (to touch its border is allowed),
    /// if any.
    pub fn offence(&self, center: Point<Field>, radius: f32) -> Option<KeepOutReason> {
        let hit = self.forbidden.iter().find(|region| region.shape.distance_to(center) < radius);
        let out = self.within.distance_to(center) > -radius;
        hit.map(|region| region.why).or(out.then_some(KeepOutReason::Border))
    }
}

/// Keep-out regions of this robot.
pub fn keep_out(s: &Situation) -> KeepOut {
    let mut list = List(Vec::new());
    let keeper = s.rule_role == RuleRole::Keeper;
    let is_kicker = s.rule_role == RuleRole::Kicker;
    let disc = |center: Point<Field>, radius: f32| Shape::Disc { center, radius };
    match s.phase {
        Phase::Halt | Phase::Timeout(_) => {}
        Phase::Stop => {
            list.add_some(KeepOutReason::BallDistance, s.ball.map(|ball| disc(ball, BALL_DISTANCE)));
            list.opponent_area(s, OPPONENT_AREA_DISTANCE);
            list.own_area(s);
        }
        Phase::FreeKick(side) => {
            let away = s.ball.filter(|_| side == Side::Theirs);
            list.add_some(KeepOutReason::BallDistance, away.map(|ball| disc(ball, BALL_DISTANCE)));
            list.opponent_area(s, OPPONENT_AREA_DISTANCE);
            list.own_area(s);
        }
        Phase::Run => {
            list.opponent_area(s, 0.0);
            list.own_area(s);
        }
        Phase::BallPlacement(Side::Theirs) => {
            let spine = match (s.ball, s.placement) {
                (Some(ball), Some(target)) => Some(Segment::new(ball, target)),
                (known, other) => known.or(other).map(|point| Segment::new(point, point)),
            };
            let stadium = spine.map(|spine| Shape::Capsule { spine, radius: BALL_DISTANCE });
            list.add_some(KeepOutReason::Stadium, stadium);
        }
        Phase::BallPlacement(Side::Ours) => {
            let target = s.placement.filter(|_| !is_kicker);
            list.add_some(KeepOutReason::Target, target.map(|target| disc(target, BALL_DISTANCE)));
        }
        Phase::PrepareKickoff(side) | Phase::Kickoff(side) => {
            let center = Point::new(0.0, 0.0);
            if side == Side::Ours && is_kicker {
                list.kicker(s);
                let prepares = matches!(s.phase, Phase::PrepareKickoff(_));
                let ball = s.ball.filter(|_| prepares);
                list.add_some(KeepOutReason::BallTouch, ball.map(|ball| disc(ball, BALL_RADIUS)));
            } else {
                list.half_plane(s, KeepOutReason::OtherHalf, 0.0, s.own.opposite());
                list.add(KeepOutReason::CentreCircle, disc(center, s.field.center_radius));
            }
            let away = s.ball.filter(|_| side == Side::Theirs);
            list.add_some(KeepOutReason::BallDistance, away.map(|ball| disc(ball, BALL_DISTANCE)));
            list.own_area(s);
        }
        Phase::PreparePenalty(side) | Phase::Penalty(side) => list.penalty(s, side, keeper, is_kicker),
    }
    KeepOut { forbidden: list.0, within: s.field.surface() }
}

/// Speed limit of a robot, m/s; `None`: no limit.
pub const fn speed_limit<Who>(phase: &Phase<Who>) -> Option<f32> {
    match phase {
        Phase::Halt | Phase::Timeout(_) => Some(0.0),
        Phase::Stop => Some(STOP_SPEED),
        _ => None,
    }
}

/// Permission of a robot to touch the ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// The robot may touch the ball.
    Allowed,
    /// The phase allows no robot, not its team, or only its team's kicker (or keeper).
    NotNow,
    /// The robot is at least partly in the opponents' defence area.
    InOpponentArea,
    /// The robot is entirely in the own defence area and not the keeper: a penalty.
    InOwnArea,
}

/// Permission of a robot with its centre here to touch the ball now. The caller keeps track of double
/// touches.
pub fn may_touch_ball(s: &Situation, center: Point<Field>) -> Touch {
    let may = match s.phase {
        Phase::Run => true,
        Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours) | Phase::BallPlacement(Side::Ours) => {
            s.rule_role == RuleRole::Kicker
        }
        Phase::Penalty(Side::Ours) => s.rule_role == RuleRole::Kicker,
        Phase::Penalty(Side::Theirs) => s.rule_role == RuleRole::Keeper,
        _ => false,
    };
    if !may {
        return Touch::NotNow;
    }
    if matches!(s.phase, Phase::BallPlacement(_)) {
        return Touch::Allowed; // "it is allowed to enter the defence area during ball placement"
    }
    if in_area(s.field, s.own.opposite(), center) != InArea::Out {
        Touch::InOpponentArea
    } else if s.rule_role != RuleRole::Keeper && in_area(s.field, s.own, center) == InArea::Entirely {
        Touch::InOwnArea
    } else {
        Touch::Allowed
    }
}

/// The list under construction. It never overflows: a test counts every situation.
struct List(Vec<Forbidden, FORBIDDEN_MAX>);

impl List {
    fn add(&mut self, why: KeepOutReason, shape: Shape<Field>) {
        let full = self.0.push(Forbidden { shape, why }).is_err();
        debug_assert!(!full, "more than {FORBIDDEN_MAX} forbidden regions");
    }

    fn add_some(&mut self, why: KeepOutReason, shape: Option<Shape<Field>>) {
        if let Some(shape) = shape {
            self.add(why, shape);
        }
    }

    fn own_area(&mut self, s: &Situation) {
        if s.rule_role != RuleRole::Keeper {
            for shape in &s.field.defence_area(s.own) {
                self.add(KeepOutReason::OwnArea, shape.grown(s.field.line_width * 0.5));
            }
        }
    }

    fn opponent_area(&mut self, s: &Situation, by: f32) {
        for shape in &s.field.defence_area(s.own.opposite()) {
            self.add(KeepOutReason::OpponentArea, shape.grown(by + s.field.line_width * 0.5));
        }
    }

    /// The whole field surface from x = `from` to the wall behind this goal.
    fn half_plane(&mut self, s: &Situation, why: KeepOutReason, from: f32, towards: GoalEnd) {
        let wall = s.field.goal_line(towards) + towards.sign() as f32 * s.field.goal_line_margin;
        let y = s.field.width * 0.5 + s.field.margin;
        let (low, high) = (from.min(wall), from.max(wall));
        self.add(why, Shape::Box { low: Point::new(low, -y), high: Point::new(high, y) });
    }

    /// The kicker may be in the whole circle, whose far half a box cannot describe; a flat upright rectangle
    /// in it is left open, wide enough that a body passes the ball on either side.
    fn kicker(&mut self, s: &Situation) {
        let side = s.field.center_radius * KICKER_BESIDE;
        let other = s.own.opposite();
        let far = s.field.center_radius * KICKER_BEYOND * other.sign() as f32;
        self.half_plane(s, KeepOutReason::OtherHalf, far, other);
        let wall = s.field.width * 0.5 + s.field.margin;
        for (low, high) in [(-wall, -side), (side, wall)] {
            let (low, high) = (Point::new(far.min(0.0), low), Point::new(far.max(0.0), high));
            self.add(KeepOutReason::OtherHalf, Shape::Box { low, high });
        }
    }

    fn penalty(&mut self, s: &Situation, side: Side, keeper: bool, is_kicker: bool) {
        let attacked = if side == Side::Ours { s.own.opposite() } else { s.own };
        if side == Side::Theirs && keeper {
            if !s.ball_in_play {
                self.keeper_line(s);
            }
        } else if side == Side::Ours && is_kicker {
            let prepares = matches!(s.phase, Phase::PreparePenalty(_));
            let ball = s.ball.filter(|_| prepares);
            let on = ball.map(|center| Shape::Disc { center, radius: BALL_RADIUS });
            self.add_some(KeepOutReason::BallTouch, on);
        } else {
            // A ball that lies elsewhere is not yet where the kick is taken from: it is placed there by hand.
            let mark = s.field.penalty_spot(attacked);
            let ball = s.ball.filter(|ball| ball.distance(mark) < NEAR_MARK).unwrap_or(mark);
            let from = ball.x() - attacked.sign() as f32 * PENALTY_BEHIND;
            self.half_plane(s, KeepOutReason::BehindBall, from, attacked);
        }
    }

    /// The body touches the goal line as long as all of it is within its own width of the line, on either
    /// side; and it is between the posts.
    fn keeper_line(&mut self, s: &Situation) {
        let (line, sign) = (s.field.goal_line(s.own), s.own.sign() as f32);
        let strip = 2.0 * ROBOT_RADIUS;
        self.half_plane(s, KeepOutReason::KeeperLine, line - sign * strip, s.own.opposite());
        self.half_plane(s, KeepOutReason::KeeperLine, line + sign * strip, s.own);
        let wall = s.field.width * 0.5 + s.field.margin;
        let post = s.field.goal_width * 0.5;
        let (low_x, high_x) = (line - strip, line + strip);
        for (low, high) in [(-wall, -post), (post, wall)] {
            let shape = Shape::Box { low: Point::new(low_x, low), high: Point::new(high_x, high) };
            self.add(KeepOutReason::KeeperLine, shape);
        }
    }
}

/// Half width and depth of the rectangle in the far half of the centre circle, as shares of its radius: its
/// corners lie on the circle.
const KICKER_BESIDE: f32 = 0.88;
const KICKER_BEYOND: f32 = 0.475;

#[cfg(test)]
mod tests;
