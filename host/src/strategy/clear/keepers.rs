//! `keepers`: the keeper's clearances: several kicks in each direction, rated by which team is first on the
//! ball's way. Attack frame, SI units.

use geometry::{Attack, Point, Segment, Vector};
use motion::trajectory::FreeLimits;
use protocol::RobotId;
use protocol::host::KickOrder;

use super::super::pass::Kicks;
use super::super::pass::conditions::likely;
use super::super::pass::reach::Mover;
use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::first_touch::{FirstTouch, Flight, Touchers, Way};
use super::{CHIP_RISES_M, Clearance, LENGTH_MIN_M, PASSES_BY_M, Release, SOONER_WIDTH_S};

/// Kicks of a clearance, cm/s: along the ground, of which the slowest stops after 3 m, and chips whose first
/// hop, v²/g at 45°, is 0.9, 1.6, 2.5 and 3.7 m. The fastest count for the longest ways alone, to the far
/// corners.
const KICKS: [KickOrder; 8] = [
    KickOrder::Flat(200),
    KickOrder::Flat(300),
    KickOrder::Flat(450),
    KickOrder::Flat(600),
    KickOrder::Chip(300),
    KickOrder::Chip(400),
    KickOrder::Chip(500),
    KickOrder::Chip(600),
];
/// A faster ball bounces off a robot that it comes to, m/s: half more than a pass arrives with.
const TAKEN_BELOW_M_S: f32 = 3.0;
/// A team that comes later than the other by this is not first, s: three widths of the comparison.
const LATER_MAX_S: f32 = 0.9;

/// A clearance may go over a touch line if an opponent reaches the ball less than this after the keeper, s:
/// of 300 rebounds 115 went to an opponent where none may, 44 with this; with more the ball is less in play.
const PRESSED_WITHIN_S: f32 = 1.1;
/// There it crosses the line at least this far from the corner, m: a kick's scatter of 3° over 4 m.
const OFF_CORNERS_M: f32 = 0.2;

/// What clearances of the keeper from one place are rated by.
pub(super) struct KeepersRating<'v> {
    view: &'v View,
    who: RobotId,
    from: Point<Attack>,
    release: Release<'v>,
    /// Field players of ours that may have the ball next.
    ours: Movers,
    theirs: Movers,
    kicks: &'v Kicks,
}

type Movers = heapless::Vec<Mover, ROBOTS_MAX>;

impl<'v> KeepersRating<'v> {
    pub(super) fn of(view: &'v View, kicks: &'v Kicks, who: &ViewRobot, from: Point<Attack>) -> Self {
        let c = kicks.constants();
        let ours = view.ours.iter().filter(|robot| robot.id != who.id && robot.id != view.keeper);
        Self {
            view,
            who: who.id,
            from,
            release: Release::of(view, kicks, who, from),
            ours: ours.map(|robot| mover_of(robot, &c.receiver)).collect(),
            theirs: view.theirs.iter().map(|robot| mover_of(robot, &c.opponent)).collect(),
            kicks,
        }
    }

    /// The clearances with every kick in each of `directions`.
    pub(super) fn of_directions(
        &self,
        directions: impl Iterator<Item = Vector<Attack>>,
    ) -> impl Iterator<Item = Clearance> {
        let flights = KICKS.map(|kick| (kick, Flight::of(kick, self.kicks)));
        directions.flat_map(move |along| {
            let way = Way::of(self.view, self.from, along);
            flights.each_ref().map(|(kick, flight)| self.clearance(&way, *kick, flight))
        })
    }

    /// The worth of a clearance that was chosen earlier.
    pub(super) fn again(&self, at: Point<Attack>, kick: KickOrder) -> f32 {
        let way = Way::of(self.view, self.from, (at - self.from).unit().unwrap_or_default());
        self.clearance(&way, kick, &Flight::of(kick, self.kicks)).worth
    }

    fn clearance(&self, way: &Way, kick: KickOrder, flight: &Flight) -> Clearance {
        // Our own bodies before the robot stop it.
        let c = self.kicks.constants();
        let open = match kick {
            KickOrder::Chip(_) => CHIP_RISES_M,
            KickOrder::Flat(_) => flight.gone(c.shortest_time),
        };
        let start = Segment::new(self.from, way.at(open));
        let mut teammates = self.view.ours.iter().filter(|robot| robot.id != self.who);
        let stopped = teammates.any(|robot| start.distance_to(robot.position) < PASSES_BY_M);
        // Where no robot comes to it as foreseen it shall stay in the field, as far as it is followed: else
        // the game stops, and goes on theirs.
        let end = way.at(way.ends);
        let goes_out = flight.length() > way.ends;
        let (at, there) = if stopped || goes_out && !self.may_leave_at(end) {
            (end, self.lost_at(self.from))
        } else {
            self.first_touch(way, flight)
        };
        let at = way.at(at.distance(self.from).max(LENGTH_MIN_M));
        Clearance { at, kick, worth: self.release.worth(at, there) }
    }

    /// Whether the ball may leave the field there: under pressure, over a touch line. Over their goal line it
    /// would be an aimless kick (division B), over ours a corner kick.
    fn may_leave_at(&self, end: Point<Attack>) -> bool {
        self.release.pressed_after < PRESSED_WITHIN_S
            && end.x().abs() < self.view.field.length * 0.5 - OFF_CORNERS_M
    }

    /// Where the ball is touched first, or leaves the field, and what that is worth.
    fn first_touch(&self, way: &Way, flight: &Flight) -> (Point<Attack>, f32) {
        let half = self.view.field.length * 0.5;
        let c = self.kicks.constants();
        let theirs =
            Touchers { movers: &self.theirs, reaction: c.reaction, after: 0.0, below: f32::INFINITY };
        let theirs = flight.first(way, &theirs, f32::INFINITY);
        let until = theirs.map_or(f32::INFINITY, |touch| touch.time + LATER_MAX_S);
        let ours = Touchers {
            movers: &self.ours,
            reaction: c.reaction,
            after: c.shortest_time,
            below: TAKEN_BELOW_M_S,
        };
        let ours = flight.first(way, &ours, until);
        if let (None, None) = (ours, theirs) {
            let out = way.at(way.ends);
            return (out, self.lost_at(out));
        }
        let had = likely(time_of(theirs) - time_of(ours), SOONER_WIDTH_S);
        let rests = way.at(flight.length());
        let [ours, theirs] = [ours, theirs].map(|touch| touch.map_or(rests, |touch| way.at(touch.distance)));
        let worth = had * self.view.stakes.of_ours(half, ours) + (1.0 - had) * self.lost_at(theirs);
        (if had < 0.5 { theirs } else { ours }, worth)
    }

    /// The worth of a ball that is theirs at `at`.
    fn lost_at(&self, at: Point<Attack>) -> f32 {
        self.view.stakes.of_theirs(self.view.field.length * 0.5, at)
    }
}

fn mover_of(robot: &ViewRobot, limits: &FreeLimits) -> Mover {
    Mover::new(robot.position, robot.velocity, limits)
}

/// When a team is at the ball, s.
fn time_of(touch: Option<FirstTouch>) -> f32 {
    touch.map_or(f32::INFINITY, |touch| touch.time)
}
