//! `clear`: clearances, rated on the scale of all actions: a ball sent away from our goal, flat or high, as
//! soon as the robot can release it: a field player's to where a teammate is sooner than any opponent, the
//! keeper's by which team is first on its way. Attack frame, SI units.

mod first_touch;
mod keepers;

use geometry::{Angle, Attack, Point, Segment, Vector, math};
use motion::trajectory::FreeLimits;
use protocol::RobotId;
use protocol::host::KickOrder;
use rules::{Phase, Side, contact};

use super::pass::conditions::likely;
use super::pass::reach::Mover;
use super::pass::{Kicks, PassScene};
use super::view::{View, ViewRobot};
use super::{roles, support};
use keepers::KeepersRating;

/// Directions of a clearance are this far apart, degrees.
const STEP_DEG: f32 = 15.0;
const DIRECTIONS: i16 = 24;
/// Directions that lead towards our goal line by more than this, by the sine, are left out.
const BACK_MAX: f32 = -0.1;
/// A clearance along the ground goes this far, m; a chip as far as its two hops and what it rolls then.
const FLAT_LENGTH_M: f32 = 2.5;
const CHIP_LENGTH_M: f32 = 3.5;
/// One that a line cuts shorter than this is none, m.
const LENGTH_MIN_M: f32 = 1.2;
/// cm/s, 3-D: at 45° the first hop is v²/g = 1.6 m.
const CHIP_CM_S: u16 = 400;
/// A flat clearance rests at least this far inside the lines, m; a chip, whose roll is less certain, this
/// far.
const INSIDE_FLAT_M: f32 = 0.3;
const INSIDE_CHIP_M: f32 = 1.0;
/// A chip is over robots from this distance on, m.
const CHIP_RISES_M: f32 = 0.3;
/// From a ball's way to the centre of a robot that it passes, m: both radii and a kick's scatter.
const PASSES_BY_M: f32 = 0.13;
/// Width of the comparison of who is sooner at it, s.
const SOONER_WIDTH_S: f32 = 0.3;
/// Time from the first touch to a kick straight on, s; and for each radian that it turns from there: half a
/// turn around the ball or with it takes 1.2 s.
const RELEASE_S: f32 = 0.25;
const TURN_S_PER_RAD: f32 = 0.3;
/// P(goal against) for each radian, as opponents come nearer than they are: half a turn costs less than a way
/// that is blocked (estimate).
const WAITS_PER_RAD: f32 = 0.01;
/// Width of the comparison of release and opponents' arrival, s.
const RELEASE_WIDTH_S: f32 = 0.2;
/// Share of the balls that are lost where an opponent comes long before the release: the body shields the
/// others.
const LOST_SHARE_MAX: f32 = 0.6;
/// P(goal against) added by a free kick in our half that is given away.
const GIVEN_AWAY: f32 = 0.15;

/// A ball sent away from our goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Where it lands or rolls to, m.
    pub at: Point<Attack>,
    /// Kind and speed of the kick.
    pub kick: KickOrder,
    /// P(goal for) − P(goal against) within 10 s.
    pub worth: f32,
}

/// The clearance of `who` that is worth most for a ball at `from`, of the directions that `fit`.
pub fn clearance(
    view: &View,
    kicks: &Kicks,
    who: &ViewRobot,
    from: Point<Attack>,
    fits: impl Fn(Vector<Attack>) -> bool,
) -> Option<Clearance> {
    // Straight on it is released soonest.
    let straight = Vector::polar(1.0, straight_on(who, from));
    let directions = (0..DIRECTIONS)
        .map(|step| Vector::polar(1.0, Angle::degrees(STEP_DEG * f32::from(step))))
        .chain([straight])
        .filter(|ray| ray.x() > BACK_MAX && fits(*ray));
    if who.id == view.keeper {
        return KeepersRating::of(view, kicks, who, from).of_directions(directions).reduce(better);
    }
    let rating = Rating::of(view, kicks, who, from);
    directions
        .flat_map(|ray| {
            let flat = view.clamp(from + ray * FLAT_LENGTH_M, INSIDE_FLAT_M);
            let chip = view.clamp(from + ray * CHIP_LENGTH_M, INSIDE_CHIP_M);
            [(flat, support::push_kick(flat.distance(from))), (chip, KickOrder::Chip(CHIP_CM_S))]
        })
        .filter(|(at, kick)| {
            // At a restart opponents stand in every way along the ground.
            let flies = view.phase == Phase::Run || matches!(kick, KickOrder::Chip(_));
            // The lines turn it.
            let fits = (*at - from).unit().is_some_and(&fits);
            flies && fits && at.distance(from) > LENGTH_MIN_M
        })
        .map(|(at, kick)| Clearance { at, kick, worth: rating.worth(at, kick) })
        .reduce(better)
}

fn better(best: Clearance, next: Clearance) -> Clearance {
    if next.worth > best.worth { next } else { best }
}

/// A clearance that was chosen earlier, rated now.
pub fn worth_again(
    view: &View,
    kicks: &Kicks,
    who: &ViewRobot,
    from: Point<Attack>,
    (at, kick): (Point<Attack>, KickOrder),
) -> f32 {
    if who.id == view.keeper {
        KeepersRating::of(view, kicks, who, from).again(at, kick)
    } else {
        Rating::of(view, kicks, who, from).worth(at, kick)
    }
}

/// A robot that comes to the ball, and how soon opponents could have that.
#[derive(Clone, Copy, Debug)]
pub struct Release<'v> {
    view: &'v View,
    from: Point<Attack>,
    /// Direction from the robot to the ball: straight on nothing is turned.
    straight: Angle,
    /// Time of the soonest opponent at the ball after the robot's own, s.
    pressed_after: f32,
}

impl<'v> Release<'v> {
    /// For `who` and a ball at `from`.
    pub fn of(view: &'v View, kicks: &Kicks, who: &ViewRobot, from: Point<Attack>) -> Self {
        let c = kicks.constants();
        let theirs = view
            .theirs
            .iter()
            .map(|robot| touch_time(robot, from, &c.opponent))
            .fold(f32::INFINITY, f32::min);
        let straight = straight_on(who, from);
        // At a restart no opponent may come before the kick.
        let pressed_after = if view.phase == Phase::Run {
            theirs - touch_time(who, from, &c.receiver)
        } else {
            f32::INFINITY
        };
        Self { view, from, straight, pressed_after }
    }

    /// Place of the ball when it is kicked, m.
    pub fn from(&self) -> Point<Attack> {
        self.from
    }

    /// Angle by which the robot turns, or goes round the ball, to kick towards `at`, rad.
    fn turn(&self, at: Point<Attack>) -> f32 {
        (self.from.direction_to(at) - self.straight).radians().abs().min(math::PI)
    }

    /// P(an opponent has the ball before it is kicked towards `at`).
    pub fn lost(&self, at: Point<Attack>) -> f32 {
        let time = RELEASE_S + TURN_S_PER_RAD * self.turn(at);
        LOST_SHARE_MAX * (1.0 - likely(self.pressed_after - time, RELEASE_WIDTH_S))
    }

    /// The worth of an action towards `at` that is worth `released` once the ball has left.
    pub fn worth(&self, at: Point<Attack>, released: f32) -> f32 {
        let lost = self.lost(at);
        let half = self.view.field.length * 0.5;
        (1.0 - lost) * released + lost * self.view.stakes.of_theirs(half, self.from)
    }
}

/// The direction of a robot that comes to the ball, or has it at its front.
fn straight_on(robot: &ViewRobot, ball: Point<Attack>) -> Angle {
    let off = ball - robot.position;
    if off.norm() < contact::TOUCHES_WITHIN { robot.heading } else { off.angle() }
}

/// Time after which `robot` touches a ball at `at`, s.
fn touch_time(robot: &ViewRobot, at: Point<Attack>, limits: &FreeLimits) -> f32 {
    Mover::new(robot.position, robot.velocity, limits).time_to_touch(at, contact::TOUCHES_WITHIN)
}

/// Time after which the first of `robots` is at `at`, s.
fn soonest<'r>(robots: impl Iterator<Item = &'r ViewRobot>, at: Point<Attack>) -> f32 {
    robots.map(|robot| roles::time_to(robot, at)).fold(f32::INFINITY, f32::min)
}

/// What clearances of a field player from one place are rated by. Rated as the keeper's they were preferred
/// to passes: of 300 free kicks with a marker 64 in place of 164 reached a teammate.
struct Rating<'v> {
    view: &'v View,
    who: RobotId,
    from: Point<Attack>,
    release: Release<'v>,
    scene: PassScene<'v>,
}

impl<'v> Rating<'v> {
    fn of(view: &'v View, kicks: &'v Kicks, who: &ViewRobot, from: Point<Attack>) -> Self {
        // A clearance has no receiver of ours: the robot that is soonest there gets it.
        let placeholder = ViewRobot::at_rest(RobotId::ZERO, from);
        let scene = PassScene::of(view, kicks, from, Some(who.id), &placeholder);
        Self { view, who: who.id, from, release: Release::of(view, kicks, who, from), scene }
    }

    fn worth(&self, at: Point<Attack>, kick: KickOrder) -> f32 {
        let view = self.view;
        let half = view.field.length * 0.5;
        let receivers = view.ours.iter().filter(|robot| robot.id != self.who && robot.id != view.keeper);
        let (ours, their_time) = (soonest(receivers, at), soonest(view.theirs.iter(), at));
        // Up to half of its way: what comes later is who is sooner where it rests.
        let [flat, chip] = self.scene.not_intercepted(self.from + (at - self.from) * 0.5);
        let past = match kick {
            KickOrder::Flat(_) => flat,
            KickOrder::Chip(_) => (chip / self.scene.kicks().constants().chip_prior).max(flat),
        };
        // Our own bodies before the robot stop it too.
        let flies = if matches!(kick, KickOrder::Chip(_)) { CHIP_RISES_M } else { FLAT_LENGTH_M };
        let start = Segment::new(self.from, self.from + (at - self.from).clamped(flies));
        let mut teammates = view.ours.iter().filter(|robot| robot.id != self.who);
        let past =
            if teammates.any(|robot| start.distance_to(robot.position) < PASSES_BY_M) { 0.0 } else { past };
        let had = likely(their_time - ours, SOONER_WIDTH_S);
        let there = had * view.stakes.of_ours(half, at) + (1.0 - had) * self.lost_at(at);
        let on_the_way = self.lost_at(self.from + (at - self.from) * 0.25);
        self.release.worth(at, past * there + (1.0 - past) * on_the_way)
            - WAITS_PER_RAD * self.release.turn(at)
    }

    /// The worth of a ball that is theirs at `at`.
    fn lost_at(&self, at: Point<Attack>) -> f32 {
        let half = self.view.field.length * 0.5;
        self.view.stakes.of_theirs(half, at) - given_away(self.view, self.from)
    }
}

/// What a free kick in our half costs beyond the ball where it is given away: our team is spread out for it.
/// Of 17 that were lost to the champions' team 8 became goals within 8 s.
pub(super) fn given_away(view: &View, from: Point<Attack>) -> f32 {
    if view.phase == Phase::FreeKick(Side::Ours) && from.x() < 0.0 { GIVEN_AWAY } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;
    use rules::League;

    #[test]
    fn a_clearance_goes_away_from_our_goal_past_opponents_and_our_own_bodies() {
        let kicks = Kicks::of(League::DivisionB);
        let ours = [(-4.3, 0.0), (-3.37, 0.1), (-3.37, -0.1), (-1.5, 2.0)];
        let view = view((-4.15, 0.0), &ours, &[(-2.8, 0.0), (-2.5, -1.0)]);
        let from = Point::new(-4.15, 0.0);
        let found = clearance(&view, &kicks, &view.ours[0], from, |_| true).unwrap();
        let ray = (found.at - from).unit().unwrap();
        assert!(ray.x() > BACK_MAX, "{found:?}");
        let way = Segment::new(from, from + ray * CHIP_RISES_M);
        assert!(
            view.ours[1..].iter().all(|robot| way.distance_to(robot.position) > PASSES_BY_M),
            "{found:?}"
        );
        assert_eq!(clearance(&view, &kicks, &view.ours[0], from, |_| false), None);
    }

    #[test]
    fn the_keeper_kicks_over_a_touch_line_only_where_an_opponent_is_near() {
        let kicks = Kicks::of(League::DivisionB);
        let from = Point::new(-4.0, 0.9);
        let leaves = |opponent| {
            let view = view((-4.0, 0.9), &[(-4.2, 0.8)], &[opponent, (-1.0, 0.0), (-1.0, 2.0)]);
            let found = clearance(&view, &kicks, &view.ours[0], from, |_| true).unwrap();
            let along = (found.at - from).unit().unwrap();
            let length = first_touch::Flight::of(found.kick, &kicks).length();
            (from + along * length).y().abs() > view.field.width * 0.5
        };
        assert!(leaves((-3.2, 0.9)));
        assert!(!leaves((-1.5, 0.9)));
    }

    /// The robot stood there with the ball, was sent round it to kick 43° to the left, and lost it.
    #[test]
    fn a_ball_at_the_front_is_cleared_straight_on_before_an_opponent_comes() {
        let kicks = Kicks::of(League::DivisionB);
        let ours = [(-4.3, 0.0), (-3.32, -0.29), (-2.91, -0.04), (-1.67, -1.12)];
        let mut view = view((-3.22, -0.26), &ours, &[(-3.0, -0.48), (-2.3, -2.2)]);
        view.ours[1].heading = Angle::degrees(-9.0);
        let from = Point::new(-3.22, -0.26);
        let found = clearance(&view, &kicks, &view.ours[1], from, |_| true).unwrap();
        let turn = (from.direction_to(found.at) - view.ours[1].heading).abs();
        assert!(turn < 0.2, "{turn} rad, {found:?}");
    }

    #[test]
    fn what_is_released_late_under_an_opponent_is_worth_less() {
        let kicks = Kicks::of(League::DivisionB);
        let from = Point::new(-3.0, 1.5);
        let mut view = view((-3.0, 1.5), &[(-4.4, 0.0), (-3.12, 1.5)], &[(-2.4, 1.5)]);
        let lost = |view: &View, at| Release::of(view, &kicks, &view.ours[1], from).lost(at);
        let (ahead, back) = (Point::new(0.0, 1.5), Point::new(-4.4, 1.4));
        assert!(lost(&view, ahead) + 0.2 < lost(&view, back));
        view.phase = Phase::FreeKick(rules::Side::Ours);
        assert_eq!(lost(&view, back), 0.0, "no opponent may come before the kick");
    }
}
