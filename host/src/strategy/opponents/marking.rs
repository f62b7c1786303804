//! `marking`: opponent team of man-markers. A robot that is not at the ball stays between an opponent and the
//! own goal and follows its motion, as the paper's Teams G and B, which reacted swiftly to every change
//! (Biswas et al. 2014 §6). With the ball far from every opponent two leave their opponents to receive a
//! pass. Attack frame, m.

use geometry::Vector;

use super::{Places, Style, defenders, free_places};
use crate::strategy::order::{OrderReason, Role};
use crate::strategy::view::{View, ViewBall, ViewRobot};
use crate::strategy::{roles, support};

pub(super) const STYLE: Style = Style { target: support::target, places, keeps_places_at_free_kicks: true };
/// An opponent this near the ball is covered by the robot that goes for the ball, m.
const PLAYS_BALL_WITHIN_M: f32 = 0.4;
/// Distance of a marker's centre from its opponent's, m: two bodies and room to brake.
const MARK_OFF_M: f32 = 0.3;
/// A marker goes to where its opponent will be after this time, s: latency of a command to the robot, and its
/// first step.
const MARKER_LEAD_S: f32 = 0.15;
/// The ball counts as ours if we are this much sooner at it, s.
const OURS_SOONER_BY_S: f32 = 0.3;
/// Number of robots that leave their opponents while the ball is ours.
const FORWARD_ROBOTS: usize = 2;

fn places(view: &View, ball: &ViewBall, wanted: usize) -> Places {
    let goal = view.our_goal();
    let mut them: heapless::Vec<&ViewRobot, { super::ROBOTS_MAX }> = view
        .theirs
        .iter()
        .filter(|robot| robot.id != view.their_keeper)
        .filter(|robot| ball.position.distance(robot.position) > PLAYS_BALL_WITHIN_M)
        .collect();
    let danger = |robot: &ViewRobot| robot.position.distance(goal);
    them.sort_unstable_by(|a, b| danger(a).total_cmp(&danger(b)).then(a.id.cmp(&b.id)));
    let marks = (0_u8..).zip(them).map(|(i, robot)| {
        // Extrapolated to where it will be when the marker has reacted.
        let at = robot.position + robot.velocity * MARKER_LEAD_S;
        let home = (goal - at).unit().unwrap_or(Vector::new(-1.0, 0.0));
        (at + home * MARK_OFF_M, Role::Marker(i), OrderReason::Marks { opponent: robot.id })
    });
    let forward = if is_ours(view, ball) { FORWARD_ROBOTS } else { 0 };
    let [near, _] = defenders(view);
    let places = [near].into_iter().chain(free_places(view, ball, forward)).chain(marks);
    let mut places: Places = places.take(wanted).collect();
    let missing = wanted - places.len().min(wanted);
    places.extend(free_places(view, ball, FORWARD_ROBOTS + missing).skip(forward).take(missing));
    places
}

/// Whether one of ours can have the ball well before any of theirs.
fn is_ours(view: &View, ball: &ViewBall) -> bool {
    let soonest = |robots: &[ViewRobot]| {
        robots.iter().map(|robot| roles::time_to(robot, ball.rest)).fold(f32::INFINITY, f32::min)
    };
    soonest(&view.ours) + OURS_SOONER_BY_S < soonest(&view.theirs)
}
