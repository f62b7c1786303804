//! `receiving`: first-level threat (Biswas et al. 2014 §5.1, equation 6). Attack frame, m, m/s, s.

use geometry::{Attack, Point, Vector};
use protocol::RobotId;

use super::super::view::{HAS_BALL_WITHIN_M, View, nearest};
use super::ThreatSettings;

/// Equation 6: −(|d| / |v|) · (1 + c · (1 − cos θ)), s, at most 0; greater is riskier.
///
/// `d` leads from the ball to the robot, `v` is the ball's velocity, θ the angle between them. Straight ahead
/// it is less the time the ball would take; c sets how fast risk falls to the side. Places of equal risk lie
/// on an ellipse of eccentricity c / (1 + c) with the ball in a focus ([`isocontour`]). A ball at standstill
/// is not received: −∞.
pub fn risk_of_receiving(ball: Point<Attack>, velocity: Vector<Attack>, robot: Point<Attack>, c: f32) -> f32 {
    let (d, speed) = (robot - ball, velocity.norm());
    let distance = d.norm();
    if speed <= 0.0 || distance <= 0.0 {
        return if speed > 0.0 { 0.0 } else { f32::NEG_INFINITY };
    }
    let cos = d.dot(velocity) / (distance * speed);
    -(distance / speed) * (1.0 + c * (1.0 - cos))
}

/// The ellipse of one `risk` (below 0) for a ball at the origin with `speed` along +x: its centre's x, its
/// half axes along and across, m.
pub fn isocontour(speed: f32, c: f32, risk: f32) -> (f32, f32, f32) {
    // |d| (1 + c) − c d_x = −risk · |v|: a conic with the ball in its focus, e = c / (1 + c), semi-latus
    // rectum k / (1 + c).
    let (k, eccentricity) = (-risk * speed, c / (1.0 + c));
    let rest = 1.0 - eccentricity * eccentricity;
    let along = k / (1.0 + c) / rest;
    (along * eccentricity, along, along * geometry::math::sqrt(rest))
}

/// The place from which a shot is most imminent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstLevel {
    /// The place that keeper and primary defenders guard against.
    pub at: Point<Attack>,
    /// Kind of the first-level threat.
    pub because: Because,
}

/// Kind of the first-level threat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Because {
    /// The ball itself, at its place.
    Ball,
    /// A pass to this opponent is imminent.
    PassTo {
        /// The opponent that is to receive.
        opponent: RobotId,
        /// Risk by equation 6, s.
        risk: f32,
    },
    /// The ball is not visible: its last place, or the field's middle.
    BallUnseen,
}

impl FirstLevel {
    /// The receiver of the pass, if there is one.
    pub fn receiver(&self) -> Option<RobotId> {
        match self.because {
            Because::PassTo { opponent, .. } => Some(opponent),
            Because::Ball | Because::BallUnseen => None,
        }
    }
}

/// The first-level threat, given the one before (a pass once detected is kept until it is clearly over).
pub fn first_level(view: &View, before: Option<FirstLevel>, settings: &ThreatSettings) -> FirstLevel {
    let Some(ball) = view.ball else {
        let at = before.map_or(Point::new(0.0, 0.0), |threat| threat.at);
        return FirstLevel { at, because: Because::BallUnseen };
    };
    let held = before.and_then(|threat| threat.receiver());
    let ease = if held.is_some() { settings.hold } else { 1.0 };
    // Who has the ball may carry it on.
    let carrier = nearest(view.theirs.iter(), ball.position).filter(|(_, off)| *off < HAS_BALL_WITHIN_M);
    let carried = carrier.map_or(Vector::default(), |(robot, _)| robot.velocity * settings.carried_for);
    let here = FirstLevel { at: ball.position + carried, because: Because::Ball };
    let fast = ball.velocity.norm() * ease >= settings.pass_speed;
    if !fast || comes_at_goal(view, ball.position, ball.velocity) {
        return here;
    }
    let risk = |at| risk_of_receiving(ball.position, ball.velocity, at, settings.c);
    let mut best: Option<(RobotId, Point<Attack>, f32, f32)> = None;
    for robot in &view.theirs {
        // The kicker does not receive its own ball: it stands behind, where equation 6 is steep, but near.
        if (robot.position - ball.position).dot(ball.velocity) <= 0.0 && held != Some(robot.id) {
            continue;
        }
        let risk = risk(robot.position);
        let worth = if held == Some(robot.id) { risk + settings.risk_worth } else { risk };
        if best.is_none_or(|(_, _, _, most)| worth > most) {
            best = Some((robot.id, robot.position, risk, worth));
        }
    }
    match best {
        Some((opponent, at, risk, _)) if risk > settings.risk_threshold * ease => {
            // It shoots from where it meets the ball.
            let along = ball.velocity.unit().unwrap_or_default();
            let at = ball.position + along * (at - ball.position).dot(along).max(0.0);
            FirstLevel { at, because: Because::PassTo { opponent, risk } }
        }
        _ => here,
    }
}

/// Whether the path of a ball crosses our goal line between the posts, or a ball's width beside.
pub fn comes_at_goal(view: &View, ball: Point<Attack>, velocity: Vector<Attack>) -> bool {
    let goal = view.our_goal();
    if velocity.x() >= 0.0 || ball.x() <= goal.x() {
        return false;
    }
    let y = ball.y() + velocity.y() * (goal.x() - ball.x()) / velocity.x();
    y.abs() <= view.field.goal_width * 0.5 + 2.0 * rules::limits::BALL_RADIUS
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use geometry::{Angle, math};
    use protocol::Instant;

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    /// Python: `-(hypot(*d)/hypot(*v))*(1+c*(1-cos(theta)))`, θ from `atan2`, for ball (0.5, −1), v (3, 1).
    #[test]
    fn equation_6_gives_the_numbers_computed_by_hand() {
        let (ball, v) = (Point::new(0.5, -1.0), Vector::new(3.0, 1.0));
        let expected = [
            // robot, c, risk
            ((3.5, 0.0), 5.0, -1.0),
            ((3.5, 0.0), 20.0, -1.0),
            ((2.0, 1.0), 5.0, -1.493_416_5),
            ((2.0, 1.0), 20.0, -3.601_957_7),
            ((-1.0, -1.0), 10.0, -9.717_758),
        ];
        for ((x, y), c, risk) in expected {
            let found = risk_of_receiving(ball, v, Point::new(x, y), c);
            assert!((found - risk).abs() < 2e-5, "({x}, {y}), c {c}: {found}");
        }
        assert_eq!(risk_of_receiving(ball, Vector::default(), Point::new(0.0, 0.0), 5.0), f32::NEG_INFINITY);
    }

    #[test]
    fn places_of_equal_risk_lie_on_an_ellipse_with_the_ball_in_a_focus() {
        for (c, risk) in [(5.0, -1.0), (20.0, -1.0), (10.0, -0.4)] {
            let (centre, along, across) = isocontour(2.0, c, risk);
            for i in 0..36 {
                let (s, o) = math::sin_cos(i as f32 * math::TAU / 36.0);
                let place = Point::new(centre + along * o, across * s);
                let found = risk_of_receiving(Point::default(), Vector::new(2.0, 0.0), place, c);
                assert!((found - risk).abs() < 2e-4, "c {c}, {i}: {found}");
            }
        }
    }

    fn passing(velocity: (f32, f32), theirs: &[(f32, f32)]) -> View {
        let mut view = view((0.0, 0.0), &[], theirs);
        if let Some(ball) = &mut view.ball {
            ball.velocity = Vector::new(velocity.0, velocity.1);
        }
        view
    }

    #[test]
    fn the_threat_is_whom_the_ball_is_passed_to_and_else_the_ball() {
        let settings = ThreatSettings::default();
        let theirs = [(-1.5, 2.0), (-2.0, -2.0), (0.1, -0.05)];
        // Towards the first one, 2.5 m away, at 4 m/s: 0.625 s.
        let threat = first_level(&passing((-2.4, 3.2), &theirs), None, &settings);
        assert_eq!(threat.receiver(), Some(id(0)));
        let Because::PassTo { risk, .. } = threat.because else { panic!("{threat:?}") };
        assert!((risk + 0.625).abs() < 1e-4, "{risk}");
        assert_eq!(threat.at, Point::new(-1.5, 2.0));
        // Too slow, at our goal, at no opponent.
        for velocity in [(-0.24, 0.32), (-5.0, 0.0), (0.0, 3.0)] {
            let threat = first_level(&passing(velocity, &theirs), None, &settings);
            assert_eq!(threat.because, Because::Ball, "{velocity:?}");
        }
    }

    #[test]
    fn a_pass_once_seen_is_believed_through_noise() {
        let settings = ThreatSettings::default();
        let theirs = [(-1.5, 2.0), (-1.7, 1.8)];
        let mut before = None;
        let (mut changes, mut last) = (0, None);
        for tick in 0..200_u32 {
            let turn = if tick % 2 == 0 { 2.0 } else { -2.0 };
            let v = Vector::<Attack>::new(-2.4, 3.2).rotated(Angle::degrees(turn));
            let mut view = passing((v.x(), v.y()), &theirs);
            view.now = Instant(u64::from(tick) * 10_000);
            let threat = first_level(&view, before, &settings);
            if last.is_some_and(|last| last != threat.receiver()) {
                changes += 1;
            }
            last = Some(threat.receiver());
            before = Some(threat);
        }
        assert_eq!((changes, last), (0, Some(Some(id(0)))));
        // The decision without a memory does change back and forth.
        let without = |turn| {
            let v = Vector::<Attack>::new(-2.4, 3.2).rotated(Angle::degrees(turn));
            first_level(&passing((v.x(), v.y()), &theirs), None, &settings).receiver()
        };
        assert_ne!(without(-2.0), without(9.0));
    }

    #[test]
    fn without_a_ball_the_place_where_it_was_is_guarded() {
        let mut view = passing((0.0, 0.0), &[]);
        view.ball = None;
        let before = FirstLevel { at: Point::new(-2.0, 1.0), because: Because::Ball };
        let threat = first_level(&view, Some(before), &ThreatSettings::default());
        assert_eq!((threat.at, threat.because), (before.at, Because::BallUnseen));
    }
}
