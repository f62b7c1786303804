//! `scene`: probability that a pass leads to a goal. P(receive | x) · P(goal | receive, x), with all its
//! factors (Biswas et al. 2014 §3.1, equations 3–5). Attack frame, SI units.
//!
//! A [`PassScene`] is one moment with one receiver; values that do not depend on x are computed once.
//! docs/architecture.md §9 bounds the cost of a place (`cargo xtask bench strategy`).

use geometry::{Attack, Field, GoalEnd, Point, Shape, Vector};
use protocol::RobotId;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{Phase, Side};

use super::super::value;
use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::conditions as given;
use super::constants::PassConstants;
use super::intercept::{BallPath, Interceptor, PassOpponent, SAFE};
use super::kicks::{FlatKick, Kicks, PassKick};
use super::open::GoalOpening;
use super::reach::Mover;

/// m; nearer, directions are undefined.
const SAME_PLACE_WITHIN_M: f32 = 1e-3;
/// From places farther off the goal line than this most shots are slower than a keeper, m: 0.5 s at 6.24 m/s.
const KEEPER_MATTERS_BEYOND_M: f32 = 2.8;
/// Nine factors in another order differ by less than 10⁻⁶.
const ROUNDING_FACTOR: f32 = 1.0 + 1e-5;
/// Time that an opponent beside the ball uses before our free kick leaves, s: it steps towards where the
/// kicker turns, and it lines up for 1.0 to 1.5 s.
const STEPS_IN_S: f32 = 1.0;
/// Opponents this near the ball do, m: as near as the rules permit, and a step.
const STEPS_IN_WITHIN_M: f32 = 1.2;
/// Share of the chips of our free kicks that arrive, against the usual chip's: the ball lies where it is
/// kicked from, and the receiver stands where it comes. A guess that the drill `marker` supports; not
/// measured by itself.
const RESTART_CHIP_PRIOR: f32 = 0.9;
/// What having the ball is worth more than a ball lost, out of our half: there places are compared by whether
/// they keep it.
const HELD_IN_OUR_HALF: f32 = 0.1;
/// At our free kicks the receiver stands there when the ball leaves, and goes towards it: a marker beside or
/// behind it does not get this last part of the ball's way, m.
const RECEIVER_COVERS_M: f32 = 0.8;
/// A chip that ends in a goal less often than this is not considered: one in two hundred.
const CHIP_GOAL_P_MIN: f32 = 0.005;

/// Probabilities of a pass to a place, with their factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rating {
    /// Place of the reception, m.
    pub at: Point<Attack>,
    /// The kick that is likelier to end in a goal.
    pub kick: PassKick,
    /// P(c1) … P(c5): their product is P(receive | x).
    pub receive_factors: [f32; 5],
    /// P(c1') … P(c4'): their product is P(goal | receive, x).
    pub goal_factors: [f32; 4],
    /// Time of the ball's arrival, s after the kick.
    pub ball_time: f32,
    /// Time until the receiver stands there, s.
    pub receiver_time: f32,
    /// The opponent that can be there soonest, and its time, s; none if not within [`SAFE`] after the
    /// receiver. Of those that are there [`SAFE`] before it, any.
    pub model: Option<(RobotId, f32)>,
    /// The opponent that comes nearest to intercepting the ball, if its margin is below [`SAFE`]. Of those
    /// that certainly do (−[`SAFE`]), any.
    pub interceptor: Option<Interceptor>,
    /// The most restrictive obstacle of the place, with its margin, m.
    pub spoiler: (Spoiler, f32),
    /// The shot after the reception.
    pub shot: ShotFrom,
    /// Worth of having the ball there without a shot, 0–1; 0 where only goals count.
    pub held: f32,
}

/// A shot from where a pass is received.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShotFrom {
    /// At this point of the goal line.
    pub aim: Point<Attack>,
    /// The open angle around it, rad.
    pub angle: f32,
    /// Time until it is there, s.
    pub time: f32,
    /// Whether the receiver shoots without stopping the ball first.
    pub one_touch: bool,
}

/// Obstacles that make a place unreliable (c5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spoiler {
    /// Our own defence area.
    OurArea,
    /// Theirs, which attackers must not enter.
    TheirArea,
    /// A line of the field.
    Line,
    /// A teammate at the place.
    Teammate,
}

impl Rating {
    /// P(receive | x): the product of `receive_factors`, 0–1.
    pub fn receive(&self) -> f32 {
        self.receive_factors.iter().product()
    }

    /// P(goal | receive, x).
    pub fn goal(&self) -> f32 {
        self.goal_factors.iter().product()
    }

    /// The value that is maximised: P(goal | x), or with what having the ball there is worth, where that is
    /// more.
    pub fn value(&self) -> f32 {
        self.receive() * self.goal().max(self.held)
    }
}

/// One snapshot, a ball to be passed, and its receiver.
#[derive(Clone, Debug)]
pub struct PassScene<'k> {
    kicks: &'k Kicks,
    from: Point<Attack>,
    receiver: Mover,
    opponents: heapless::Vec<PassOpponent, ROBOTS_MAX>,
    teammates: heapless::Vec<Point<Attack>, ROBOTS_MAX>,
    our_area: heapless::Vec<Shape<Field>, { rules::AREA_SHAPES_MAX }>,
    their_area: heapless::Vec<Shape<Field>, { rules::AREA_SHAPES_MAX }>,
    half: [f32; 2],
    opening: GoalOpening,
    shot: FlatKick,
    /// Whether having the ball is worth something too.
    keeps: bool,
    /// Whether the receiver must not start before the kick: at a kick-off it must stay in our half.
    waits: bool,
    /// Share of the chips past all opponents that arrive.
    chip_prior: f32,
    /// What having the ball is worth anywhere, 0–1.
    held_at_least: f32,
    /// The end of the ball's way that the receiver's body covers, m.
    covered: f32,
}

impl<'k> PassScene<'k> {
    /// A pass from `from`, played by `passer`, to `receiver`, against all opponents of the view.
    pub fn of(
        view: &View,
        kicks: &'k Kicks,
        from: Point<Attack>,
        passer: Option<RobotId>,
        receiver: &ViewRobot,
    ) -> Self {
        let c = kicks.constants();
        let mover = |robot: &ViewRobot, limits| Mover::new(robot.position, robot.velocity, limits);
        let others =
            view.ours.iter().filter(|teammate| teammate.id != receiver.id && Some(teammate.id) != passer);
        let (length, width) = (view.field.length, view.field.width);
        let restart = view.phase == Phase::FreeKick(Side::Ours);
        // The field is the same seen from either end, so its areas have the same places in the attack frame.
        Self {
            kicks,
            from,
            receiver: mover(receiver, &c.receiver),
            opponents: view
                .theirs
                .iter()
                .map(|robot| {
                    let steps_in = restart && robot.position.distance(from) < STEPS_IN_WITHIN_M;
                    let head_start = if steps_in { STEPS_IN_S } else { 0.0 };
                    PassOpponent { id: robot.id, mover: mover(robot, &c.opponent), head_start }
                })
                .take(ROBOTS_MAX)
                .collect(),
            teammates: others.map(|teammate| teammate.position).collect(),
            our_area: view.field.defence_area(GoalEnd::Negative),
            their_area: view.field.defence_area(GoalEnd::Positive),
            half: [length * 0.5, width * 0.5],
            opening: GoalOpening {
                x: length * 0.5,
                half: view.field.goal_width * 0.5 - BALL_RADIUS,
                body: ROBOT_RADIUS + BALL_RADIUS,
            },
            shot: kicks.shot(),
            keeps: false,
            waits: matches!(view.phase, Phase::PrepareKickoff(_) | Phase::Kickoff(_)),
            chip_prior: if restart { RESTART_CHIP_PRIOR } else { c.chip_prior },
            held_at_least: if from.x() < 0.0 { HELD_IN_OUR_HALF } else { 0.0 },
            covered: if restart { RECEIVER_COVERS_M } else { 0.0 },
        }
    }

    /// P(c3) of a ball that takes `ball_time`: who waits for the kick reacts and drives there meanwhile.
    fn time_to_react(&self, ball_time: f32, receiver_time: f32, c: &PassConstants) -> f32 {
        let driving = if self.waits { receiver_time } else { 0.0 };
        given::time_to_react(ball_time - driving, c)
    }

    /// The same at the moment of the kick: with opponents where the view shows them, and the usual chip.
    pub fn at_kick(mut self) -> Self {
        self.opponents.iter_mut().for_each(|opponent| opponent.head_start = 0.0);
        (self.chip_prior, self.covered) = (self.kicks.constants().chip_prior, 0.0);
        self
    }

    /// The same, where having the ball is worth something without a shot too.
    pub fn keeping(self) -> Self {
        Self { keeps: true, ..self }
    }

    /// The same for a receiver that stands at `at`.
    pub fn received_at(&self, at: Point<Attack>) -> Self {
        let receiver = Mover::new(at, Vector::default(), &self.kicks.constants().receiver);
        Self { receiver, ..self.clone() }
    }

    /// Start of the pass, x0.
    pub fn from(&self) -> Point<Attack> {
        self.from
    }

    /// The kicks to choose from.
    pub fn kicks(&self) -> &'k Kicks {
        self.kicks
    }

    /// Half the field's length and width, m.
    pub fn half(&self) -> [f32; 2] {
        self.half
    }

    /// Rates a pass to `at`.
    pub fn rate(&self, at: Point<Attack>) -> Rating {
        self.weigh(at, f32::NEG_INFINITY)
    }

    /// P(c2) of a flat pass and of a chip to `at`, each by itself; 0 where no such chip can be kicked.
    pub fn not_intercepted(&self, at: Point<Attack>) -> [f32; 2] {
        let (path, c) = (self.path(at - self.from), self.kicks.constants());
        let of = |found: Option<Interceptor>, chip: bool| {
            given::not_intercepted(found.map_or(SAFE, |found| found.margin), chip, c)
        };
        let chip =
            self.kicks.chip(path.length).map_or(0.0, |chip| of(path.chip(&chip, &self.opponents), true));
        [of(path.flat(&self.kicks.flat(path.length), &self.opponents), false), chip]
    }

    fn path(&self, off: Vector<Attack>) -> BallPath {
        let length = off.norm();
        let along = if length > SAME_PLACE_WITHIN_M { off * (1.0 / length) } else { Vector::new(1.0, 0.0) };
        let reaction = self.kicks.constants().reaction;
        BallPath { from: self.from, along, length, body: self.opening.body, reaction, covered: self.covered }
    }

    /// Rates it, if its value is above `floor`; below, it costs less.
    pub fn rate_above(&self, at: Point<Attack>, floor: f32) -> Option<Rating> {
        Some(self.weigh(at, floor)).filter(|rating| rating.value() > floor)
    }

    /// Factor by factor, until the value cannot be above `floor` any more; factors not computed by then stay
    /// 1.
    fn weigh(&self, at: Point<Attack>, floor: f32) -> Rating {
        let c = self.kicks.constants();
        let path = self.path(at - self.from);
        let BallPath { along, length, .. } = path;
        let spoiler = self.spoiler(at, c);
        let goal = Point::new(self.opening.x, 0.0);
        let mut rating = Rating {
            at,
            kick: PassKick::Flat { speed: 0.0 },
            receive_factors: [
                1.0,
                1.0,
                1.0,
                given::short_enough(length, c),
                given::reliable_place(spoiler.1, c),
            ],
            goal_factors: [
                self.keeper_at_best(at, c),
                1.0,
                1.0,
                given::not_stolen(!c.their_area_forbidden && self.in_their_area(at), c),
            ],
            ball_time: 0.0,
            receiver_time: 0.0,
            model: None,
            interceptor: None,
            spoiler,
            shot: ShotFrom { aim: goal, angle: 0.0, time: 0.0, one_touch: false },
            held: if self.keeps {
                (value::of_ours(self.opening.x, at) + self.held_at_least).max(0.0)
            } else {
                0.0
            },
        };
        // The product so far, slightly enlarged for rounding: a floor that it does not exceed is not exceeded
        // by the value either.
        let place = rating.receive_factors[3] * rating.receive_factors[4] * ROUNDING_FACTOR;
        if place * rating.goal().max(rating.held) <= floor {
            return rating;
        }
        rating.receiver_time = self.receiver.time_to(at);
        rating.model = self.model(at, rating.receiver_time);
        let soonest = rating.model.map_or(rating.receiver_time + SAFE, |(_, time)| time);
        rating.receive_factors[0] = given::first_there(rating.receiver_time, soonest, c);
        let first = place * rating.receive_factors[0];
        if first * rating.goal().max(rating.held) <= floor {
            return rating;
        }
        rating.shot = self.shot(at, along, c);
        rating.goal_factors[0] = given::beats_the_keeper(rating.shot.time, c);
        rating.goal_factors[1] = given::open_goal(rating.shot.angle, c);
        rating.goal_factors[2] = given::shot_in_time(rating.shot.one_touch, c);
        let first = first * rating.goal().max(rating.held);
        if first <= floor {
            return rating;
        }
        let flat = self.kicks.flat(length);
        rating.kick = PassKick::Flat { speed: flat.speed };
        let end = flat.at(length);
        rating.ball_time = end.0;
        rating.receive_factors[2] = self.time_to_react(rating.ball_time, rating.receiver_time, c);
        rating.interceptor =
            path.flat_until(&flat, &self.opponents, end, enough(floor, first * rating.receive_factors[2], c));
        let margin = rating.interceptor.map_or(SAFE, |found| found.margin);
        rating.receive_factors[1] = given::not_intercepted(margin, false, c);
        self.chip_if_better(&path, &mut rating, floor, c);
        rating
    }

    /// c1' for the nearest possible point of the goal, where that matters: near the goal it is 1.
    fn keeper_at_best(&self, at: Point<Attack>, c: &PassConstants) -> f32 {
        let depth = self.opening.x - at.x();
        if depth < KEEPER_MATTERS_BEYOND_M {
            return 1.0;
        }
        given::beats_the_keeper(self.shot.at(depth).0, c)
    }

    /// A chip instead, where it is likelier to end in a goal. It gives more time (c3) and passes over
    /// opponents (c2), but bounces: no one-touch shot follows (c3').
    fn chip_if_better(&self, path: &BallPath, rating: &mut Rating, floor: f32, c: &PassConstants) {
        let flat = rating.receive_factors[1] * rating.receive_factors[2];
        let others = rating.value() / flat.max(f32::MIN_POSITIVE);
        // Neither above the flat pass, nor above the floor.
        if flat >= self.chip_prior || others * self.chip_prior <= floor.max(CHIP_GOAL_P_MIN) {
            return;
        }
        let length = path.length;
        let Some(kick) = self.kicks.chip(length) else { return };
        let interceptor = path.chip(&kick, &self.opponents);
        let ball_time = kick.at(length).0;
        let mut chip = *rating;
        chip.receive_factors[1] = self.chip_prior
            * given::not_intercepted(interceptor.map_or(SAFE, |found| found.margin), false, c);
        chip.receive_factors[2] = self.time_to_react(ball_time, rating.receiver_time, c);
        chip.goal_factors[2] = given::shot_in_time(false, c);
        if chip.value() > rating.value() {
            chip.kick = PassKick::Chip { speed: kick.speed, lands: kick.lands };
            (chip.ball_time, chip.interceptor) = (ball_time, interceptor);
            chip.shot.one_touch = false;
            *rating = chip;
        }
    }

    /// The opponent that can be at `at` soonest, if it affects a receiver that takes `receiver_time`; the
    /// first one that is sooner by so large a margin that the others do not matter.
    fn model(&self, at: Point<Attack>, receiver_time: f32) -> Option<(RobotId, f32)> {
        let mut soonest = (None, receiver_time + SAFE);
        for opponent in &self.opponents {
            let path = at - opponent.mover.position;
            let reach = opponent.mover.farthest(soonest.1);
            if path.dot(path) > reach * reach {
                continue;
            }
            let time = opponent.mover.time_to(at);
            if time < soonest.1 {
                soonest = (Some(opponent.id), time);
            }
            if soonest.1 < receiver_time - SAFE {
                break;
            }
        }
        soonest.0.map(|id| (id, soonest.1))
    }

    /// The most restrictive obstacle of the place.
    fn spoiler(&self, at: Point<Attack>, c: &PassConstants) -> (Spoiler, f32) {
        let line = (self.half[0] - at.x().abs()).min(self.half[1] - at.y().abs()) - c.line_margin;
        let mut worst = (Spoiler::Line, line);
        let mut look = |spoiler: Spoiler, margin: f32| {
            if margin < worst.1 {
                worst = (spoiler, margin);
            }
        };
        let place = Point::new(at.x(), at.y());
        let off = |area: &[Shape<Field>]| {
            area.iter().map(|shape| shape.distance_to(place)).fold(f32::INFINITY, f32::min) - c.area_margin
        };
        if at.x() < 0.0 {
            look(Spoiler::OurArea, off(&self.our_area));
        } else if c.their_area_forbidden {
            look(Spoiler::TheirArea, off(&self.their_area));
        }
        let nearest = self
            .teammates
            .iter()
            .map(|teammate| (at - *teammate).dot(at - *teammate))
            .fold(f32::INFINITY, f32::min);
        if nearest < f32::INFINITY {
            look(Spoiler::Teammate, geometry::math::sqrt(nearest) - c.teammate_margin);
        }
        worst
    }

    /// Whether a place is in the opponents' defence area, lines included.
    pub fn in_their_area(&self, at: Point<Attack>) -> bool {
        let place = Point::new(at.x(), at.y());
        at.x() > 0.0 && at.x() <= self.half[0] && self.their_area.iter().any(|shape| shape.contains(place))
    }

    /// The shot that follows a pass which comes along `along`.
    fn shot(&self, at: Point<Attack>, along: Vector<Attack>, c: &PassConstants) -> ShotFrom {
        let open = self.opening.open_from(at, self.opponents.iter().map(|opponent| opponent.mover.position));
        let path = open.aim - at;
        let distance = path.norm();
        // Angle between the incoming and the outgoing path of the ball, at the receiver.
        let one_touch = -along.dot(path) >= c.one_touch_cos * distance;
        ShotFrom { aim: open.aim, angle: open.angle, time: self.shot.at(distance).0, one_touch }
    }
}

/// A margin of time with which a value of `others` (all other factors) is not above `floor` any more, s: no
/// caller needs a smaller one. No less than −[`SAFE`].
fn enough(floor: f32, others: f32, c: &PassConstants) -> f32 {
    let p = floor / others;
    if p > 0.0 && p < 1.0 {
        // The inverse of the logistic, slightly lowered for rounding.
        (c.time_width * geometry::math::ln(p / (1.0 - p)) - 1e-3).max(-SAFE)
    } else {
        -SAFE
    }
}

#[cfg(test)]
pub(crate) mod tests;
