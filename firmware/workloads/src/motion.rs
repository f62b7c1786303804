//! `motion`: motion benchmark tasks. The same on a board and on the PC, to the last bit.
//!
//! Tasks are drawn from a seed, so no task data goes to the board; counts and a hash of the results come
//! back. Runs in the bench's firmware (`motion-bench` of the QEMU board) and in `cargo xtask bench motion`,
//! which drives both. SI units.

use core::fmt;

use geometry::{Angle, Field, Point, Segment, Shape, Vector};
use motion::avoid::{self, Carried, Course, Obstacle};
use motion::ball::{BallModel, BallPath};
use motion::intercept::{InterceptRequest, Interception, kick_reach};
use motion::trajectory::{CalcMotion, DragLimits, FreeLimits, Motion, State};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

geometry::labels! {
    /// Functions that are measured.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Work {
        /// `t*` without drag: duration alone.
        FreeTime = "free-time",
        /// The whole motion without drag.
        FreePlan = "free-plan",
        /// State of a motion without drag at one time.
        FreeState = "free-state",
        /// `t*` with drag: duration alone.
        DragTime = "drag-time",
        /// The whole motion with drag.
        DragPlan = "drag-plan",
        /// The earliest interception of a ball.
        Soonest = "soonest",
        /// The interception with most slack.
        Safest = "safest",
        /// A planner step among 12 discs and 4 shapes that stand.
        Avoid = "avoid",
        /// The same with moving discs.
        AvoidMoving = "avoid-moving",
    }
}

impl Work {
    /// Runs the task; returns the bits of the result, folded into 32 bits.
    pub fn run(self, task: &MotionTask) -> u32 {
        let MotionTask { from, velocity, to, .. } = *task;
        let (free, drag) = (FreeLimits::default(), DragLimits::default());
        match self {
            Self::FreeTime => free.time(from, velocity, to).to_bits(),
            Self::FreePlan => free.plan(from, velocity, to).duration().to_bits(),
            Self::FreeState => folded(&task.motion.at(task.time)),
            Self::DragTime => drag.time(from, velocity, to).to_bits(),
            Self::DragPlan => drag.plan(from, velocity, to).duration().to_bits(),
            Self::Soonest => task.interception(InterceptRequest::Soonest),
            Self::Safest => task.interception(InterceptRequest::Safest),
            Self::Avoid => task.step(&task.standing),
            Self::AvoidMoving => task.step(&task.moving),
        }
    }
}

/// Instructions that a step of a wheeled robot leaves for a plan at most (`brain`'s drivetrain).
const STEP_EFFORT: u32 = 21_000;

/// Inputs of one task.
#[derive(Clone, Debug)]
pub struct MotionTask {
    /// A start, a velocity and an end on a field of 12 × 9 m; every second path is short.
    pub from: Point<Field>,
    /// Velocity at the start, m/s.
    pub velocity: Vector<Field>,
    /// End of the motion, m.
    pub to: Point<Field>,
    motion: <FreeLimits as CalcMotion>::Motion<Field>,
    time: f32,
    ball: BallPath<Field>,
    start: Point<Field>,
    target: Point<Field>,
    standing: [Obstacle<Field>; OBSTACLES],
    moving: [Obstacle<Field>; OBSTACLES],
}

impl MotionTask {
    fn interception(&self, request: InterceptRequest) -> u32 {
        let asked = Interception {
            robot: self.start,
            velocity: self.velocity,
            ball: &self.ball,
            target: Point::new(4.5, 0.0),
            reach: kick_reach(ROBOT_RADIUS, BALL_RADIUS),
            until: 5.0,
        };
        match asked.find(&FreeLimits::default(), request) {
            motion::intercept::InterceptVerdict::Intercepts(interception) => {
                interception.robot_time.to_bits()
            }
            motion::intercept::InterceptVerdict::Chase { robot_time, .. } => robot_time.to_bits() ^ 1,
        }
    }

    fn step(&self, obstacles: &[Obstacle<Field>]) -> u32 {
        let course = Course {
            from: self.start,
            velocity: self.velocity * 0.3,
            to: self.target,
            limits: FreeLimits::default(),
            obstacles,
            within: Some(Shape::Box { low: Point::new(-4.7, -3.2), high: Point::new(4.7, 3.2) }),
            straight_on: true,
            step: 0.01,
            effort: STEP_EFFORT,
        };
        folded(&avoid::plan(&course, &mut Carried::default()).next)
    }
}

fn folded(state: &State<Field>) -> u32 {
    let State { position, velocity, acceleration } = *state;
    let coordinates =
        [position.x(), position.y(), velocity.x(), velocity.y(), acceleration.x(), acceleration.y()];
    coordinates.into_iter().fold(0, |all: u32, coordinate| all.rotate_left(5) ^ coordinate.to_bits())
}

/// The worst case planned for (docs/architecture.md §9): 12 robots and 4 forbidden regions.
const OBSTACLES: usize = 16;

/// The endless sequence of a seed's tasks.
#[derive(Clone, Debug)]
pub struct Tasks(Xoshiro128PlusPlus);

impl Tasks {
    /// Tasks from the start of the seed's sequence.
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro128PlusPlus::seed_from_u64(seed))
    }

    fn within(&mut self, range: f32) -> f32 {
        ((self.0.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range
    }

    fn point(&mut self) -> Point<Field> {
        Point::new(self.within(4.6), self.within(3.1))
    }

    fn free(&mut self, obstacles: &[Obstacle<Field>]) -> Point<Field> {
        loop {
            let point = self.point();
            if obstacles.iter().all(|obstacle| obstacle.shape.distance_to(point) > 0.0) {
                return point;
            }
        }
    }

    /// Twelve robots, both defence areas, a stadium and a box, all for a robot's centre.
    fn scene(&mut self) -> [Obstacle<Field>; OBSTACLES] {
        let mut number = 0;
        [(); OBSTACLES].map(|()| {
            number += 1;
            let at = self.point();
            Obstacle::standing(match number {
                13 => Shape::Box { low: Point::new(-4.6, -1.1), high: Point::new(-3.4, 1.1) },
                14 => Shape::Box { low: Point::new(3.4, -1.1), high: Point::new(4.6, 1.1) },
                15 => {
                    let along = Vector::polar(1.0, Angle::new(self.within(3.0)));
                    Shape::Capsule { spine: Segment::new(at, at + along), radius: 0.5 }
                }
                16 => Shape::Box { low: at, high: at + Vector::new(0.6, 0.5 + self.within(0.3)) },
                _ => Shape::Disc { center: at, radius: 0.25 },
            })
        })
    }
}

impl Iterator for Tasks {
    type Item = MotionTask;

    fn next(&mut self) -> Option<MotionTask> {
        let near = if self.0.next_u32() & 1 == 0 { 0.05 } else { 1.0 };
        let from = Point::new(self.within(6.0), self.within(4.5));
        let velocity = Vector::new(self.within(2.1), self.within(2.1));
        let to = from + Vector::new(self.within(12.0), self.within(9.0)) * near;
        let motion = FreeLimits::default().plan(from, velocity, to);
        let time = motion.duration() * (0.5 + self.within(0.5));
        let kick = Vector::polar(3.5 + self.within(3.0), Angle::new(self.within(3.0)));
        let ball = BallModel::default().kicked(self.point(), kick);
        let standing = self.scene();
        let (start, target) = (self.free(&standing), self.free(&standing));
        let moving = standing.map(|obstacle| match obstacle.shape {
            Shape::Disc { center, radius } => {
                Obstacle::robot(center, Vector::new(self.within(1.5), self.within(1.5)), radius)
            }
            _ => obstacle,
        });
        Some(MotionTask { from, velocity, to, motion, time, ball, start, target, standing, moving })
    }
}

/// Result of one task: instructions of each work, and a hash of all results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Instructions, in the order of [`Work::ALL`].
    pub instructions: [u32; Work::ALL.len()],
    /// Hash of the results' bits.
    pub found: u32,
}

impl Counted {
    /// Runs all works on a task. `count` runs one, and counts its instructions.
    pub fn of(task: &MotionTask, mut count: impl FnMut(Work, &MotionTask) -> (u32, u32)) -> Self {
        let mut found = 0_u32;
        let instructions = Work::ALL.map(|work| {
            let (bits, instructions) = count(work, task);
            found = found.rotate_left(7) ^ bits;
            instructions
        });
        Self { instructions, found }
    }

    /// Reads a line of numbers.
    pub fn from_line(line: &str) -> Option<Self> {
        let mut numbers = line.split(' ').map_while(|number| number.parse().ok());
        let mut counted = Self { instructions: [0; _], found: numbers.next()? };
        for instructions in &mut counted.instructions {
            *instructions = numbers.next()?;
        }
        numbers.next().is_none().then_some(counted)
    }
}

impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.found)?;
        self.instructions.iter().try_for_each(|count| write!(f, " {count}"))
    }
}

/// Number of tasks for the board, from this seed on.
pub const TASKS: usize = 500;
/// Seed of the tasks.
pub const SEED: u64 = 2013;

#[cfg(test)]
mod tests {
    extern crate std;
    use std::string::ToString;

    use super::*;

    #[test]
    fn a_count_comes_back_as_it_went_and_a_seed_gives_the_same_tasks() {
        let counted = |seed| Counted::of(&Tasks::new(seed).next().unwrap(), |work, task| (work.run(task), 7));
        assert_eq!(Counted::from_line(&counted(1).to_string()), Some(counted(1)));
        assert_ne!(counted(1).found, counted(2).found);
        assert_eq!(Counted::from_line("1 2 3"), None);
    }
}
