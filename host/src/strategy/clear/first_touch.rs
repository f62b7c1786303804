//! `first_touch`: which robots are first at a kicked ball, along its whole way: beside it while it is low,
//! not where it flies over them, until it rests or leaves the field. Attack frame, SI units.

use geometry::{Attack, Point, Vector, math};
use protocol::host::KickOrder;
use rules::limits::ROBOT_HEIGHT;

use super::super::pass::Kicks;
use super::super::pass::intercept::touch_time;
use super::super::pass::reach::Mover;
use super::super::view::View;
use super::PASSES_BY_M;

/// Robots are looked at where the ball has gone on by this, m, or after this time, s: half of what a
/// comparison of who is sooner resolves.
const STEP_M: f32 = 0.25;
const STEP_S: f32 = 0.15;
/// A way is followed as far as this, m, and down to this speed, m/s: the time in which that ball stops is
/// less than a robot's start.
const LONGEST_M: f32 = 10.0;
const RESTING_SPEED_M_S: f32 = 0.2;
const STEPS_MAX: usize = 80;

/// The progress of a ball from its kick on.
pub(super) struct Flight {
    /// While it is low enough to be touched.
    steps: heapless::Vec<Progress, STEPS_MAX>,
}

/// Distance, m, time, s, and speed, m/s, of a ball.
#[derive(Clone, Copy)]
struct Progress {
    distance: f32,
    time: f32,
    speed: f32,
}

/// Who may touch a ball.
pub(super) struct Touchers<'m> {
    /// Robots with their limits.
    pub(super) movers: &'m [Mover],
    /// Delay until they see the kick, s.
    pub(super) reaction: f32,
    /// No sooner after the kick than this, s.
    pub(super) after: f32,
    /// No ball that is faster than this, m/s.
    pub(super) below: f32,
}

/// The line on which a ball goes.
pub(super) struct Way {
    from: Point<Attack>,
    /// Of length 1.
    along: Vector<Attack>,
    /// Field players may touch it from this distance on: out of our area, m.
    opens: f32,
    /// It leaves the field at this distance, m.
    pub(super) ends: f32,
}

/// The first touch of one of several robots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FirstTouch {
    /// After the kick, s.
    pub(super) time: f32,
    /// Along the way, m.
    pub(super) distance: f32,
}

impl Flight {
    /// After a kick on the field surface of `kicks`.
    pub(super) fn of(kick: KickOrder, kicks: &Kicks) -> Self {
        let from = Point::<Attack>::new(0.0, 0.0);
        match kick {
            KickOrder::Flat(cm_s) => {
                let path = kicks.ground().kicked(from, Vector::new(f32::from(cm_s) * 0.01, 0.0));
                Self::followed(|time| {
                    let (distance, speed) = path.progress(time);
                    (distance, speed, 0.0)
                })
            }
            KickOrder::Chip(cm_s) => {
                let slope = kicks.constants().chip_slope;
                let speed = f32::from(cm_s) * 0.01 / math::hypot(1.0, slope);
                let path =
                    kicks.chips_as().chipped(from, Vector::new(speed, 0.0), speed * slope, kicks.ground());
                Self::followed(|time| {
                    let state = path.at(time);
                    (state.ground.position.x(), state.ground.velocity.norm(), state.height)
                })
            }
        }
    }

    /// By distance, speed and height at a time.
    fn followed(at: impl Fn(f32) -> (f32, f32, f32)) -> Self {
        let mut steps = heapless::Vec::new();
        let mut time = 0.0;
        while !steps.is_full() {
            let (distance, speed, height) = at(time);
            if height < ROBOT_HEIGHT {
                // There is room.
                let _ = steps.push(Progress { distance, time, speed });
            }
            if speed < RESTING_SPEED_M_S || distance > LONGEST_M {
                break;
            }
            time += (STEP_M / speed).min(STEP_S);
        }
        Self { steps }
    }

    /// The first touch by one of `touchers`, no later than `until`, s; `None` where the ball has left the
    /// field before.
    pub(super) fn first(&self, way: &Way, touchers: &Touchers<'_>, until: f32) -> Option<FirstTouch> {
        for (number, &Progress { distance, time, speed }) in self.steps.iter().enumerate() {
            if distance > way.ends || time > until {
                return None;
            }
            if distance < way.opens || time < touchers.after || speed > touchers.below {
                continue;
            }
            let at = way.from + way.along * distance;
            let rests = number + 1 == self.steps.len();
            let soonest = touchers
                .movers
                .iter()
                .filter(|mover| {
                    let reach = mover.farthest_touched(time) + PASSES_BY_M;
                    let off = at - mover.position;
                    rests || off.dot(off) <= reach * reach
                })
                .map(|mover| touch_time(mover, at, PASSES_BY_M, touchers.reaction))
                .fold(f32::INFINITY, f32::min);
            if soonest <= time || rests {
                return Some(FirstTouch { time: soonest.max(time), distance });
            }
        }
        None
    }

    /// How far it rolls where no robot touches it, m; no farther than it is followed.
    pub(super) fn length(&self) -> f32 {
        self.steps.last().map_or(0.0, |step| step.distance)
    }

    /// How far it has gone after `time` s, m.
    pub(super) fn gone(&self, time: f32) -> f32 {
        self.steps.iter().find(|step| step.time >= time).map_or(LONGEST_M, |step| step.distance)
    }
}

impl Way {
    /// From `from` towards `along`, of length 1.
    pub(super) fn of(view: &View, from: Point<Attack>, along: Vector<Attack>) -> Self {
        let ends = until(from.x(), along.x(), view.field.length * 0.5).min(until(
            from.y(),
            along.y(),
            view.field.width * 0.5,
        ));
        let mut opens = 0.0;
        while opens < ends && view.in_our_area(from + along * opens, 0.0) {
            opens += 0.5 * STEP_M;
        }
        Self { from, along, opens, ends }
    }

    /// The place at a distance.
    pub(super) fn at(&self, distance: f32) -> Point<Attack> {
        self.from + self.along * distance
    }
}

/// Distance along a direction's share `along` of an axis until `half` of the field is left behind, m.
fn until(at: f32, along: f32, half: f32) -> f32 {
    if along == 0.0 { f32::INFINITY } else { ((half * along.signum() - at) / along).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use motion::trajectory::FreeLimits;
    use rules::League;

    /// The first touch of a robot at `robot`, of a ball from `from` straight ahead or aside.
    fn first(kick: KickOrder, robot: (f32, f32), along: (f32, f32), below: f32) -> Option<FirstTouch> {
        let kicks = Kicks::of(League::DivisionB);
        let at = Point::new(robot.0, robot.1);
        let movers = [Mover::new(at, Vector::default(), &FreeLimits::default())];
        let touchers = Touchers { movers: &movers, reaction: 0.1, after: 0.0, below };
        let way = Way::of(&view((0.0, 0.0), &[], &[]), Point::new(0.0, 0.0), Vector::new(along.0, along.1));
        Flight::of(kick, &kicks).first(&way, &touchers, f32::INFINITY)
    }

    #[test]
    fn a_body_on_the_way_stops_a_flat_ball_and_a_chip_goes_over_it() {
        let flat = first(KickOrder::Flat(300), (0.8, 0.0), (1.0, 0.0), f32::INFINITY).unwrap();
        assert!((flat.distance - 0.8).abs() < STEP_M, "{flat:?}");
        // By 1.6 m, where it lands after 0.58 s, the robot is 0.25 · 3.5 · 0.58² = 0.3 m farther.
        let chip = first(KickOrder::Chip(400), (0.8, 0.0), (1.0, 0.0), f32::INFINITY).unwrap();
        assert!(chip.distance > 1.3, "{chip:?}");
    }

    #[test]
    fn no_robot_touches_a_ball_that_has_left_nor_keeps_a_fast_one() {
        let aside = (0.0, 1.0);
        assert_eq!(first(KickOrder::Flat(600), (3.5, -2.0), aside, f32::INFINITY), None);
        assert_eq!(first(KickOrder::Flat(600), (0.0, 2.0), aside, 3.0), None);
        assert!(first(KickOrder::Flat(600), (0.0, 2.0), aside, f32::INFINITY).is_some());
    }

    #[test]
    fn a_ball_that_rests_is_reached_after_it_has_stopped() {
        // 1 m/s stops after less than 1 m; from 4 m off a robot needs 4/3 + 3/3.5 = 2.19 s.
        let touch = first(KickOrder::Flat(100), (4.5, 0.0), (1.0, 0.0), f32::INFINITY).unwrap();
        assert!(touch.distance < 1.0 && touch.time > 1.5, "{touch:?}");
    }
}
