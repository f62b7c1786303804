//! `drivetrain`: velocity of the wheeled body in the next control step: from an intent to a path around all
//! obstacles, and from there to a twist.
//!
//! Every step plans again, from the robot's position and the velocity ordered last (wheels follow within a
//! step; where they do not, from the measured one); a step without time to plan reuses the last path
//! ([`Intent::KeepPath`]). SI, body frame out.

use geometry::{Angle, Body, Field, Point, Twist, Vector, math};
use motion::avoid::{self, Carried, Course, Detour, Restraint, RouteVerdict};
use motion::trajectory::{CalcMotion, FreeLimits, Motion, TurnLimits};
use protocol::Instant;
use protocol::robot_io::{OmniKick, WHEELED_STEP};
use rules::{Phase, RobotSpec, RuleRole, Side};

use super::bodies::short_of_bodies;
use super::surroundings::Surroundings;
use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::{Drive, DriveMode, LIMITS};
use crate::governor::{STOP_SPEED, Wanted};

/// Wheels that follow a plan.
#[derive(Clone, Debug, Default)]
pub struct Drivetrain {
    /// Velocity ordered last.
    velocity: Vector<Field>,
    angular: f32,
    /// What was ordered and has not been measured yet: of the way, m, …
    moves_on: Vector<Field>,
    /// … and of the turn, rad.
    turns_on: f32,
    stepped: Option<Instant>,
    /// Length of the present step, s.
    step: f32,
    /// The path in use; `None` while the robot stands.
    under_way: Option<CurrentPath>,
    /// Phase whose regions that path leaves, if it does: another phase may not have them.
    escapes: Option<Phase<Side>>,
    carried: Carried<Field>,
    /// Instructions that inputs and choices took in this step.
    spent: u32,
    /// Number of steps since the path was planned.
    path_age: u8,
}

/// Result of the last path planning.
#[derive(Clone, Copy, Debug)]
struct CurrentPath {
    drive: Drive,
    kept: Kept,
}

impl CurrentPath {
    fn has_way(&self) -> bool {
        matches!(self.kept, Kept::Way(_))
    }
}

/// What a step without time to plan goes on with.
#[derive(Clone, Copy, Debug)]
enum Kept {
    /// The way to the goal, or to a point past the first corner of the path to it, m.
    Way(Point<Field>),
    /// The velocity: sideways speed is being lost, or the robot stands.
    Velocity,
    /// Braking at this deceleration, m/s²: the path's motion would have touched something.
    Braking(f32),
}

impl Kept {
    fn of(path: &Detour<Field>, drive: &Drive) -> Self {
        match path.restraint {
            Restraint::None => Self::Way(path.motion.to()),
            Restraint::Straightened => Self::Velocity,
            Restraint::Braked => Self::Braking(LIMITS.braking),
            Restraint::Unavoidable => Self::Braking(drive.hardest_braking()),
        }
    }
}

impl Drivetrain {
    /// The motion, dribbler and kick for `intent`.
    pub fn actuate(&mut self, now: Instant, belief: &Belief, intent: Intent) -> Wanted {
        let since = self.stepped.map_or(WHEELED_STEP, |last| now.since(last));
        let step = since.as_secs_f32().clamp(STEP_LEAST, STEP_MOST);
        (self.stepped, self.step) = (Some(now), step);
        if (self.velocity - belief.velocity).norm() > ASTRAY {
            self.velocity = belief.velocity;
        }
        if (self.angular - belief.angular).abs() > ASTRAY_TURN {
            self.angular = belief.angular;
        }
        let keeps = 1.0 - step * FORGETTING_RATE;
        self.moves_on = (self.moves_on + (self.velocity - belief.velocity) * step) * keeps;
        self.turns_on = (self.turns_on + (self.angular - belief.angular) * step) * keeps;
        let holds = self.escapes.is_none_or(|phase| phase == belief.game.phase);
        let under_way = self.under_way.take().filter(|_| holds);
        match intent {
            Intent::Stand { face } => self.stand(belief, step, face),
            Intent::KeepPath => match under_way {
                Some(path) => self.keep_path(belief, step, path),
                None => self.stand(belief, step, None),
            },
            Intent::Turn { heading } => {
                let here = belief.pose.position;
                let drive = if belief.holds_ball {
                    Drive::holding(here, heading)
                } else {
                    Drive::avoiding(here, heading)
                };
                self.follow(belief, step, &drive, under_way)
            }
            Intent::Walk { to, face, avoid_ball } => {
                let drive = if avoid_ball { Drive::avoiding(to, face) } else { Drive::bold(to, face) };
                self.follow(belief, step, &drive, under_way)
            }
            Intent::Drive(drive) => self.follow(belief, step, &drive, under_way),
            // Wheels have no legs.
            Intent::Carry { .. } | Intent::Grab | Intent::Kick(_) => Wanted::STAND,
        }
    }

    /// Records the motion that the governor allowed: the next plan starts from it. The body turns in the
    /// step, and `twist` is meant for the heading in the middle of it.
    pub fn set_speed_order(&mut self, belief: &Belief, twist: Twist<Body>) {
        let half = half_turn(twist.angular, self.step);
        self.velocity = belief.pose.vector_to_field(twist.linear.rotated(half));
        self.angular = twist.angular;
    }

    /// Sets how many instructions this step has taken so far: so many fewer are left for planning.
    pub fn set_spent(&mut self, instructions: u32) {
        self.spent = instructions;
    }

    /// Accounts for more of them.
    pub fn spend(&mut self, instructions: u32) {
        self.spent += instructions;
    }

    /// Whether the next plan needs more time than the last ones had: where no path was found in the last
    /// step, every second step, and every step while the robot stands.
    pub fn needs_time(&self) -> bool {
        self.path_age % 2 == 1 || self.path_age > 0 && self.velocity.norm() < THERE_SPEED
    }

    fn stand(&mut self, belief: &Belief, step: f32, face: Option<Angle>) -> Wanted {
        self.wanted(belief, step, self.braked(step, LIMITS.braking), face, &held_or_free(belief))
    }

    /// The velocity after a step of braking at that deceleration, m/s².
    fn braked(&self, step: f32, deceleration: f32) -> Vector<Field> {
        self.velocity.clamped((self.velocity.norm() - deceleration * step).max(0.0))
    }

    /// Follows the same path, and turns to the same heading, without planning; brakes on a path that is too
    /// old.
    // Called from three places; a copy in each takes flash.
    #[inline(never)]
    fn keep_path(&mut self, belief: &Belief, step: f32, path: CurrentPath) -> Wanted {
        self.under_way = Some(path);
        self.path_age = self.path_age.saturating_add(1);
        let CurrentPath { drive, kept } = path;
        let velocity = match kept {
            Kept::Way(to) if self.path_age <= PATH_AGE_MAX => {
                let from = belief.pose.position + self.moves_on;
                let next = limits(belief, &drive).plan(from, self.velocity, to).at(step).velocity;
                if belief.is_placing() { next } else { short_of_bodies(belief, next, drive.mode) }
            }
            Kept::Velocity if self.path_age <= COASTS_MAX => {
                short_of_bodies(belief, self.velocity, drive.mode)
            }
            Kept::Braking(deceleration) => self.braked(step, deceleration),
            Kept::Way(_) | Kept::Velocity => self.braked(step, LIMITS.braking),
        };
        self.wanted(belief, step, velocity, Some(drive.face), &drive)
    }

    fn follow(
        &mut self,
        belief: &Belief,
        step: f32,
        drive: &Drive,
        under_way: Option<CurrentPath>,
    ) -> Wanted {
        let from = belief.pose.position + self.moves_on;
        let path_age = core::mem::take(&mut self.path_age);
        let rests = self.velocity.norm() < THERE_SPEED;
        if rests && from.distance(drive.to) < AT_PLACE && !is_moved_by_the_rules(belief.game.phase) {
            // No plan is needed.
            self.under_way = Some(CurrentPath { drive: *drive, kept: Kept::Velocity });
            return self.wanted(belief, step, Vector::default(), Some(drive.face), drive);
        }
        let field = belief.league().field();
        let mut around = Surroundings::none(&field);
        around.look(belief, &field, drive.to, drive.mode);
        let effort = self.effort(belief, drive);
        if effort < search_effort(around.obstacles.len()) {
            around.leave_out_far();
        }
        // Too little for all that is around: the path of a few steps before has looked at all of it.
        // In play a robot that this path leaves where it is has nothing to keep.
        let in_play = belief.game.phase == Phase::Run;
        let kept = under_way.map_or(Kept::Velocity, |path| path.kept);
        let leads_on = !in_play || matches!(kept, Kept::Way(to) if to.distance(from) > AT_PLACE);
        if effort < search_effort(around.obstacles.len()) && path_age < PATH_AGE_MAX && leads_on {
            self.path_age = path_age;
            return self.keep_path(belief, step, CurrentPath { drive: *drive, kept });
        }
        // Where the effort is too small for all robots the drive only slows down for those far away.
        around.leave_out_farthest(from, |number| effort >= search_effort(number));
        if effort < avoid::effort_least(around.obstacles.len()) {
            return self.stand(belief, step, Some(drive.face));
        }
        let course = Course {
            from,
            velocity: self.velocity,
            to: drive.to,
            limits: limits(belief, drive),
            obstacles: &around.obstacles,
            within: Some(around.within),
            straight_on: in_play,
            step,
            effort,
        };
        let path = avoid::plan(&course, &mut self.carried);
        // An escape of half a search may lead back to where the step before came from.
        let is_blocked = matches!(path.verdict, RouteVerdict::Blocked { .. } | RouteVerdict::Escape { .. });
        if self.carried.is_searching() && is_blocked {
            self.path_age = path_age;
            if let Some(known) = under_way.filter(|known| known.has_way() && path_age < PATH_AGE_MAX) {
                return self.keep_path(belief, step, CurrentPath { drive: *drive, ..known });
            }
            self.path_age = path_age.saturating_add(1);
        }
        self.under_way = Some(CurrentPath { drive: *drive, kept: Kept::of(&path, drive) });
        let escapes = matches!(path.verdict, RouteVerdict::Escape { .. });
        self.escapes = escapes.then_some(belief.game.phase);
        let there = rests && from.distance(path.goal) < AT_PLACE;
        // While we place the ball the others keep off, and the step has no time for it.
        let velocity = match path.next.velocity {
            _ if there => Vector::default(),
            next if belief.is_placing() => next,
            _ if path.restraint == Restraint::Unavoidable => self.braked(step, drive.hardest_braking()),
            next => short_of_bodies(belief, next, drive.mode),
        };
        self.wanted(belief, step, velocity, Some(drive.face), drive)
    }

    /// Instructions that are left for planning a path.
    fn effort(&self, belief: &Belief, drive: &Drive) -> u32 {
        let stopped = is_moved_by_the_rules(belief.game.phase);
        let skill = match belief.game.phase {
            Phase::BallPlacement(Side::Ours) => EFFORT_OF_SKILL,
            _ if stopped && belief.game.rule_role != RuleRole::Kicker => EFFORT_OF_REGIONS,
            _ => EFFORT_OF_SKILL,
        };
        EFFORT.saturating_sub(skill + drive.effort + self.spent)
    }

    fn wanted(
        &mut self,
        belief: &Belief,
        step: f32,
        velocity: Vector<Field>,
        face: Option<Angle>,
        drive: &Drive,
    ) -> Wanted {
        let pose = belief.pose;
        let mut turning = match drive.mode {
            DriveMode::Holding if belief.is_placing() => PLACING_TURN,
            DriveMode::Holding => HOLDING_TURN,
            _ => TURN,
        };
        // As it will be when this order takes effect.
        let heading = pose.heading + Angle::new(self.turns_on);
        let angular = match face {
            Some(face) if (face - heading).abs() > FACED || self.angular.abs() > FACED_RATE => {
                if belief.is_placing() {
                    turning.rate = math::min(turning.rate, SETTLES * (face - heading).abs());
                }
                turning.plan(heading, self.angular, face).at(step).1
            }
            Some(_) => 0.0,
            None => {
                let loss = turning.acceleration * step;
                self.angular - math::clamp(self.angular, -loss, loss)
            }
        };
        // The body turns while it moves: the velocity as seen from the heading half a step on.
        let linear = pose.vector_to_body(velocity).rotated(-half_turn(angular, step));
        let kick = if drive.armed { drive.kick } else { OmniKick::None };
        Wanted { twist: Twist { linear, angular }, dribbler: drive.dribbler, kick }
    }
}

/// Instructions with which a path among this many obstacles is searched.
fn search_effort(obstacles: usize) -> u32 {
    avoid::effort_least(obstacles) + EFFORT_OF_SEARCH
}

/// Angle by which the body has turned in the middle of a step of `step` seconds.
fn half_turn(angular: f32, step: f32) -> Angle {
    Angle::new(0.5 * (angular * step))
}

/// Number of steps for which a path is followed without planning again, as in a flood of packets that take
/// the whole step: 0.2 s, the age of a command that is too old.
const PATH_AGE_MAX: u8 = 20;
/// Number of steps for which a robot that loses its sideways speed keeps its velocity, where it has no time
/// to plan.
const COASTS_MAX: u8 = 2;
/// Instructions that a step leaves for inputs, its message, a skill and planning a path: 40,000
/// (docs/architecture.md §9) less what every step takes and what estimates err by. In ten matches of 60 s of
/// six images (seeds 1 to 10) the worst steps took 36,929 to 39,853.
const EFFORT: u32 = 21_000;
/// Instructions that a plan among obstacles has besides the least, for a search.
const EFFORT_OF_SEARCH: u32 = 1_500;
/// Instructions of a skill, such as placing the ball or a kick: it also plans a path behind the ball.
const EFFORT_OF_SKILL: u32 = 4_000;
/// Instructions of a stopped game's regions, which every robot keeps out of. At commit d510d255, in ten
/// matches of 60 s (seeds 1 to 10), the worst step took 40,807 without it, 39,105 with it, 39,442 with
/// twice as much; of 96 preparations of division A (24 seeds of `arena`'s test `prepare`) 2, 1 and 2
/// ended with a robot late.
const EFFORT_OF_REGIONS: u32 = 1_500;

/// Whether the allowed positions of a robot change in this phase without a new directive: with the ball, or
/// with the phase itself.
fn is_moved_by_the_rules(phase: Phase<Side>) -> bool {
    !matches!(phase, Phase::Run | Phase::Halt | Phase::Timeout(_))
}

/// A standing robot with the ball keeps it.
fn held_or_free(belief: &Belief) -> Drive {
    let drive = if belief.holds_ball { Drive::holding } else { Drive::avoiding };
    Drive { kick: OmniKick::None, ..drive(belief.pose.position, belief.pose.heading) }
}

fn limits(belief: &Belief, drive: &Drive) -> FreeLimits {
    let limits = if drive.mode == DriveMode::Holding {
        let speed = if belief.is_placing() { PLACING_SPEED } else { HOLDING.speed };
        FreeLimits { speed, acceleration: HOLDING.acceleration * drive.acceleration_share, ..HOLDING }
    } else {
        FreeLimits { acceleration: LIMITS.acceleration * drive.acceleration_share, ..LIMITS }
    };
    let limits = belief.drive_cap.applied_to(limits);
    let stop = if belief.game.phase == Phase::Stop { STOP_SPEED - STOP_SPEED_SLACK } else { f32::INFINITY };
    limits.slowed_to(drive.speed.min(stop))
}

/// Planning limits with the ball on the dribbler.
const HOLDING: FreeLimits = FreeLimits::of(&RobotSpec::OURS.plan_holding);
/// Speed limit of a ball that is pushed to its place, m/s.
const PLACING_SPEED: f32 = 2.0;
const TURN: TurnLimits = TurnLimits::of(&RobotSpec::OURS.turn);
/// Turning limits with the ball.
const HOLDING_TURN: TurnLimits = TurnLimits::of(&RobotSpec::OURS.turn_holding);
/// Turning limits while a ball is placed.
const PLACING_TURN: TurnLimits = TurnLimits::of(&RobotSpec::OURS.turn_placing);
/// Gain of the final turn while a ball is placed, 1/s: with orders that arrive 0.1 s late a larger gain
/// oscillates.
const SETTLES: f32 = 5.0;
/// Below the governor's limit in STOP, m/s: the governor need not intervene.
const STOP_SPEED_SLACK: f32 = 0.1;
/// Position error, m, and speed, m/s, below which a robot stands at its place: the vision's noise.
const AT_PLACE: f32 = 0.004;
const THERE_SPEED: f32 = 0.05;
/// Heading error, rad, and turning rate, rad/s, below which the robot faces its target.
const FACED: f32 = 0.01;
const FACED_RATE: f32 = 0.2;
/// Wheels whose measured velocity differs from the ordered one by this are blocked or slip, m/s.
const ASTRAY: f32 = 0.6;
/// The same for turning, rad/s.
const ASTRAY_TURN: f32 = 3.0;
/// An order that was never carried out is forgotten in this share a second: wheels follow within a tenth.
const FORGETTING_RATE: f32 = 8.0;
/// What is taken for a step, s.
const STEP_LEAST: f32 = 0.001;
const STEP_MOST: f32 = 0.03;

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::skills::wheels::testing::belief;

    /// How far off its aim a robot still swings 1.2 s after the beginning of a quarter turn, degrees, with
    /// wheels `late` steps behind.
    fn swings(late: usize) -> f32 {
        let mut b = belief((0.0, 0.0, 0.0), (2.0, 0.0));
        let mut drivetrain = Drivetrain::default();
        let mut under_way = std::collections::VecDeque::from(std::vec![0.0_f32; late]);
        let mut farthest = 0.0_f32;
        for tick in 1..150_u64 {
            let intent = Drive::avoiding(b.pose.position, Angle::degrees(90.0)).into();
            let wanted = drivetrain.actuate(Instant(tick * 10_000), &b, intent);
            drivetrain.set_speed_order(&b, wanted.twist);
            under_way.push_back(wanted.twist.angular);
            b.angular = under_way.pop_front().unwrap();
            b.pose.heading = b.pose.heading + Angle::new(b.angular * 0.01);
            if tick > 120 {
                farthest = farthest.max((b.pose.heading.to_degrees() - 90.0).abs());
            }
        }
        farthest
    }

    #[test]
    fn a_turn_ends_at_its_aim_although_wheels_follow_late() {
        for late in [0, 2, 6] {
            assert!(swings(late) < 1.0, "{late} steps: {} degrees", swings(late));
        }
    }

    #[test]
    fn a_robot_on_its_spot_turns_as_far_when_every_second_step_has_no_time_to_plan() {
        let turned = |keeps: bool| {
            let b = belief((0.0, 0.0, 0.0), (2.0, 0.0));
            let mut drivetrain = Drivetrain::default();
            (1..=20_u64).fold(0.0, |_, tick| {
                let turns = Drive::holding(b.pose.position, Angle::degrees(90.0)).into();
                let intent = if keeps && tick % 2 == 0 { Intent::KeepPath } else { turns };
                let wanted = drivetrain.actuate(Instant(tick * 10_000), &b, intent);
                drivetrain.set_speed_order(&b, wanted.twist);
                wanted.twist.angular
            })
        };
        assert!(turned(false) > 1.0, "{} rad/s", turned(false));
        assert_eq!(turned(true), turned(false));
    }

    #[test]
    fn a_robot_too_fast_for_its_area_brakes_in_steps_without_a_plan_too() {
        // Braking from 3 m/s takes 1.29 m; the defender's place at the area's edge is 1.2 m away.
        let place = Point::new(-3.57, 0.0);
        let mut b = belief((-2.37, 0.0, 0.0), (2.0, 0.0));
        (b.game.phase, b.game.defending) = (Phase::Run, geometry::GoalEnd::Negative);
        b.velocity = Vector::new(-3.0, 0.0);
        let mut drivetrain = Drivetrain::default();
        for tick in 1..=120_u64 {
            let goes = Drive::avoiding(place, Angle::degrees(0.0)).into();
            let intent = if tick % 2 == 0 { Intent::KeepPath } else { goes };
            let wanted = drivetrain.actuate(Instant(tick * 10_000), &b, intent);
            drivetrain.set_speed_order(&b, wanted.twist);
            b.velocity = b.pose.vector_to_field(wanted.twist.linear);
            b.pose.position += b.velocity * 0.01;
            if b.velocity.x() >= 0.0 {
                break;
            }
        }
        let beyond = place.x() - b.pose.position.x();
        assert!(beyond < 0.12, "{beyond} m beyond its place");
    }

    #[test]
    fn a_path_out_of_a_region_is_not_kept_in_a_phase_without_it() {
        for (phase, goes_on) in [(Phase::Stop, true), (Phase::Run, false)] {
            let mut b = belief((0.0, 0.0, 0.0), (0.3, 0.0));
            b.game.phase = Phase::Stop;
            let mut drivetrain = Drivetrain::default();
            let goes = Drive::avoiding(Point::new(0.3, 1.0), Angle::ZERO).into();
            let left = drivetrain.actuate(Instant(10_000), &b, goes);
            assert!(left.twist.linear.x() < 0.0, "off the ball of a stopped game: {left:?}");
            drivetrain.set_speed_order(&b, left.twist);
            b.game.phase = phase;
            let kept = drivetrain.actuate(Instant(20_000), &b, Intent::KeepPath);
            assert_eq!(kept.twist.linear.norm() > left.twist.linear.norm(), goes_on, "{phase:?}: {kept:?}");
        }
    }
}
