//! `drivetrain`: velocity of the wheeled body in the next control step: from an intent to a path around all
//! obstacles, and from there to a twist.
//!
//! Every step plans anew from where the robot is and from the velocity it was told last (wheels follow within a step; where
//! they do not, from the measured one); one with no time to look for a way keeps the last one ([`Intent::Onwards`]). SI, body frame
//! out.

use geometry::{Angle, Body, Field, Point, Twist, Vector, math};
use motion::avoid::{self, Course, Restraint, Verdict};
use motion::trajectory::{CalcMotion, FreeLimits, Motion, TurnLimits};
use protocol::Instant;
use protocol::robot_io::{OmniKick, WHEELED_STEP};
use rules::{Duty, FieldSpec, Phase, RobotSpec, Side};

use super::surroundings::Surroundings;
use super::{Drive, Manner};
use crate::belief::Belief;
use crate::body::Intent;
use crate::governor::{STOP_SPEED, Wanted};

/// Wheels that follow a plan.
#[derive(Clone, Debug, Default)]
pub struct Drivetrain {
    /// What they were told last.
    velocity: Vector<Field>,
    angular: f32,
    stepped: Option<Instant>,
    /// Length of the present step, s.
    step: f32,
    /// The way it is on; none where it stands or brakes.
    under_way: Option<UnderWay>,
}

/// What a way came to when it was planned last.
#[derive(Clone, Copy, Debug)]
struct UnderWay {
    drive: Drive,
    /// The goal, or past the first corner on the way to it.
    towards: Point<Field>,
    /// It leads around something.
    winds: bool,
}

impl Drivetrain {
    /// What the body shall do for `intent`.
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
        let under_way = self.under_way.take();
        match intent {
            Intent::Stand { face } => self.stand(belief, step, face),
            Intent::Onwards => match under_way {
                Some(way) => self.onwards(belief, step, way),
                None => self.stand(belief, step, None),
            },
            Intent::Turn { heading } => {
                let here = belief.pose.position;
                let drive =
                    if belief.holds_ball { Drive::holding(here, heading) } else { Drive::shy(here, heading) };
                self.follow(belief, step, &drive)
            }
            Intent::Walk { to, face, shy_of_ball } => {
                let drive = if shy_of_ball { Drive::shy(to, face) } else { Drive::bold(to, face) };
                self.follow(belief, step, &drive)
            }
            Intent::Drive(drive) => self.follow(belief, step, &drive),
            // Wheels have no legs.
            Intent::Carry { .. } | Intent::Grab | Intent::Kick(_) => Wanted::STAND,
        }
    }

    /// What was let through in the end: the next plan starts from it. The body turns in the step, and `twist` is meant for the
    /// heading in the middle of it.
    pub fn told(&mut self, belief: &Belief, twist: Twist<Body>) {
        let half = half_turn(twist.angular, self.step);
        self.velocity = belief.pose.vector_to_field(twist.linear.rotated(half));
        self.angular = twist.angular;
    }

    /// Its last way led around something: to look for one takes longer.
    pub fn winds(&self) -> bool {
        self.under_way.is_some_and(|way| way.winds)
    }

    fn stand(&mut self, belief: &Belief, step: f32, face: Option<Angle>) -> Wanted {
        let speed = (self.velocity.norm() - LIMITS.braking * step).max(0.0);
        self.wanted(belief, step, self.velocity.clamped(speed), face, &held_or_free(belief))
    }

    /// The same way once more, without looking for a better one.
    fn onwards(&mut self, belief: &Belief, step: f32, way: UnderWay) -> Wanted {
        self.under_way = Some(way);
        let UnderWay { drive, towards, .. } = way;
        let motion = limits(belief, &drive).plan(belief.pose.position, self.velocity, towards);
        self.wanted(belief, step, motion.at(step).velocity, Some(drive.face), &drive)
    }

    fn follow(&mut self, belief: &Belief, step: f32, drive: &Drive) -> Wanted {
        let from = belief.pose.position;
        let rests = self.velocity.norm() < THERE_SPEED;
        if rests && from.distance(drive.to) < THERE && !is_moved_by_the_rules(belief.game.phase) {
            // Nothing to plan.
            return self.wanted(belief, step, Vector::default(), Some(drive.face), drive);
        }
        let field = belief.league().field();
        let (effort, effort_to_leave) = efforts(belief, &field);
        let mut around = Surroundings::none(&field);
        around.look(belief, &field, drive.to, drive.manner);
        let way = avoid::plan(&Course {
            from,
            velocity: self.velocity,
            to: drive.to,
            limits: limits(belief, drive),
            obstacles: &around.obstacles,
            within: Some(around.within),
            step,
            effort,
            effort_to_leave,
            checks: if effort >= EFFORT_TAKING { avoid::CHECKS_LONG } else { avoid::CHECKS_MAX },
        });
        if way.restraint == Restraint::None {
            let winds = way.verdict != Verdict::Direct;
            self.under_way = Some(UnderWay { drive: *drive, towards: way.motion.to(), winds });
        }
        let there = rests && from.distance(way.goal) < THERE;
        let velocity = if there { Vector::default() } else { way.next.velocity };
        self.wanted(belief, step, velocity, Some(drive.face), drive)
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
        let mut turning = if drive.manner == Manner::Holding { HOLDING_TURN } else { TURN };
        let angular = match face {
            Some(face) if (face - pose.heading).abs() > FACED || self.angular.abs() > FACED_RATE => {
                if belief.is_placing() {
                    turning.rate = math::min(turning.rate, SETTLES * (face - pose.heading).abs());
                }
                turning.plan(pose.heading, self.angular, face).at(step).1
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

/// By how much the body has turned in the middle of a step of so many s.
fn half_turn(angular: f32, step: f32) -> Angle {
    Angle::new(0.5 * (angular * step))
}

/// What a step may spend on a way, and on a way out of a forbidden region. It is what the rest of the step leaves of 40,000
/// instructions (`qemu_wheels`).
fn efforts(belief: &Belief, field: &FieldSpec) -> (u32, u32) {
    let ball_moves = belief.ball.as_ref().is_some_and(|ball| ball.velocity.norm() > BALL_MOVES);
    let stopped = is_moved_by_the_rules(belief.game.phase);
    let effort = match belief.game.phase {
        // From behind a goal the way into its mouth is long.
        _ if belief.pose.position.x().abs() > 0.5 * field.length => EFFORT_BEHIND_GOAL,
        Phase::BallPlacement(Side::Ours) => EFFORT_TAKING,
        _ if stopped && belief.game.duty == Duty::Taker => EFFORT_TAKING,
        _ if stopped => EFFORT_STOPPED,
        _ if ball_moves => EFFORT_BALL_MOVES,
        _ => EFFORT_BALL_RESTS,
    };
    (effort, if stopped { EFFORT_STOPPED_TO_LEAVE } else { EFFORT_TO_LEAVE })
}

/// In play: eight pieces among three obstacles, five among a dozen; only what stands near the way is one. Where to meet a moving ball
/// is sought in the same step.
const EFFORT_BALL_MOVES: u32 = 100;
/// The same while the ball rests.
const EFFORT_BALL_RESTS: u32 = 115;
/// The same while the ball is not in play: neither a case nor an interception is sought then.
const EFFORT_STOPPED: u32 = 230;
/// Behind a goal line.
const EFFORT_BEHIND_GOAL: u32 = 312;
/// The same of who places the ball or takes a restart: it looks for a way behind the ball besides.
const EFFORT_TAKING: u32 = 200;
/// A way out of a forbidden region then.
const EFFORT_STOPPED_TO_LEAVE: u32 = 460;
/// A way out in play, where a step may seek a case too.
const EFFORT_TO_LEAVE: u32 = 125;
/// A ball faster than this is met on its way, m/s.
const BALL_MOVES: f32 = 0.05;

/// Whether where a robot may stand changes in this phase, though nobody tells it to go: with the ball, or with the phase itself.
fn is_moved_by_the_rules(phase: Phase<Side>) -> bool {
    !matches!(phase, Phase::Run | Phase::Halt | Phase::Timeout(_))
}

/// Standing with the ball keeps it.
fn held_or_free(belief: &Belief) -> Drive {
    let drive = if belief.holds_ball { Drive::holding } else { Drive::shy };
    Drive { kick: OmniKick::None, ..drive(belief.pose.position, belief.pose.heading) }
}

fn limits(belief: &Belief, drive: &Drive) -> FreeLimits {
    let limits = if drive.manner == Manner::Holding {
        FreeLimits { acceleration: HOLDING.acceleration * drive.gentle, ..HOLDING }
    } else {
        LIMITS
    };
    let stop = if belief.game.phase == Phase::Stop { STOP_SPEED - SLACK } else { f32::INFINITY };
    limits.slowed_to(drive.speed.min(stop))
}

/// What is planned with, free.
pub const LIMITS: FreeLimits = FreeLimits::of(&RobotSpec::OURS.plan);
/// With the ball on the dribbler.
const HOLDING: FreeLimits = FreeLimits::of(&RobotSpec::OURS.plan_holding);
const TURN: TurnLimits = TurnLimits::of(&RobotSpec::OURS.turn);
const HOLDING_TURN: TurnLimits = TurnLimits::of(&RobotSpec::OURS.turn_holding);
/// The last bit of a turn while a ball is placed, 1/s: orders that arrive 0.1 s late make a faster one swing about its goal.
const SETTLES: f32 = 5.0;
/// Below the governor's limit in STOP, m/s: it shall not need to say anything.
const SLACK: f32 = 0.1;
/// A robot this near its place, and this slow, stands, m and m/s: the vision's noise.
const THERE: f32 = 0.004;
const THERE_SPEED: f32 = 0.05;
/// It looks the right way, rad; and hardly turns, rad/s.
const FACED: f32 = 0.01;
const FACED_RATE: f32 = 0.2;
/// Wheels that are told one thing and measure another by this much are blocked, or slip, m/s.
const ASTRAY: f32 = 0.6;
/// The same for turning, rad/s.
const ASTRAY_TURN: f32 = 3.0;
/// What is taken for a step, s.
const STEP_LEAST: f32 = 0.001;
const STEP_MOST: f32 = 0.03;
