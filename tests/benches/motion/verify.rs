//! `verify`: check of the motion benchmark's solutions.

use geometry::{Field, Point, Vector, math};
use motion::trajectory::{CalcMotion, DragLimits, FreeLimits};
use workloads::motion::{MotionTask, Tasks};

/// Compares `tasks` tasks with the best of all shares, without drag and with, on all processor cores.
pub(crate) fn run(tasks: usize) -> Result<(), String> {
    let free = FreeLimits::default();
    let drag = DragLimits::default();
    print_excess("without drag", tasks, |task| task_excess(task, &free, |share| free_alone(free, share)))?;
    print_excess("with drag", tasks, |task| task_excess(task, &drag, |share| drag_alone(drag, share)))
}

fn free_alone(limits: FreeLimits, share: f32) -> FreeLimits {
    let FreeLimits { speed, acceleration, braking } = limits;
    FreeLimits { speed: speed * share, acceleration: acceleration * share, braking: braking * share }
}

/// An axis with a share of the thrust: the same equation, with a smaller limit and a smaller final speed.
fn drag_alone(limits: DragLimits, share: f32) -> DragLimits {
    DragLimits { speed: limits.speed * share, acceleration: limits.acceleration * share }
}

fn print_excess(
    what: &str,
    tasks: usize,
    excess: impl Fn(&MotionTask) -> Option<f32> + Sync,
) -> Result<(), String> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let excess = &excess;
    let mut all: Vec<Option<f32>> = std::thread::scope(|scope| {
        let share = |seed: usize| {
            let count = tasks / threads + usize::from(seed < tasks % threads);
            scope.spawn(move || {
                Tasks::new(seed as u64).take(count).map(|task| excess(&task)).collect::<Vec<_>>()
            })
        };
        let running: Vec<_> = (0..threads).map(share).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("no panic")).collect()
    });
    let unsolved = all.iter().filter(|excess| excess.is_none()).count();
    all.retain(Option::is_some);
    let mut all: Vec<f32> = all.into_iter().flatten().collect();
    all.sort_by(f32::total_cmp);
    let at = |share: f64| all.get(((all.len() - 1) as f64 * share) as usize).copied().unwrap_or(0.0) * 100.0;
    let mean = all.iter().map(|excess| f64::from(*excess)).sum::<f64>() / all.len().max(1) as f64;
    println!(
        "{what}: {tasks} tasks, {unsolved} unsolved; longer than with the best share by {:.3} % on average, {:.2} % at 99 \
         of 100, {:.2} % at 999 of 1,000, {:.2} % at worst",
        mean * 100.0,
        at(0.99),
        at(0.999),
        at(1.0),
    );
    if unsolved == 0 { Ok(()) } else { Err(format!("{what}: {unsolved} unsolved")) }
}

/// Relative excess of the time over the best; `None` where there is no valid time.
fn task_excess<L: CalcMotion>(task: &MotionTask, limits: &L, alone: impl Fn(f32) -> L) -> Option<f32> {
    let (offset, velocity) = (task.to - task.from, task.velocity);
    let origin = Point::<Field>::new(0.0, 0.0);
    let axis = |distance: f32, speed: f32, share: f32| {
        alone(share).time(origin, Vector::new(speed, 0.0), Point::new(distance, 0.0))
    };
    let slower = |angle: f32| {
        let (s, c) = math::sin_cos(angle);
        axis(offset.x(), velocity.x(), c).max(axis(offset.y(), velocity.y(), s))
    };
    // All angles coarsely, then with increasing resolution around the best.
    let (mut middle, mut span) = (0.5 * math::FRAC_PI_2, 0.5 * math::FRAC_PI_2);
    let mut best = f32::INFINITY;
    for _ in 0..ZOOMS {
        let centre = middle;
        for i in 0..=POINTS {
            let angle = centre + span * (2.0 * i as f32 / POINTS as f32 - 1.0);
            let angle = angle.clamp(ANGLE_MIN, math::FRAC_PI_2 - ANGLE_MIN);
            let time = slower(angle);
            if time < best {
                (best, middle) = (time, angle);
            }
        }
        span *= 4.0 / POINTS as f32;
    }
    let time = limits.time(task.from, velocity, task.to);
    (time.is_finite() && time >= 0.0 && best.is_finite()).then(|| time / best - 1.0)
}

const ZOOMS: usize = 4;
const POINTS: u32 = 40;
/// Minimum angle: below it an axis would have less than the minimum limit.
const ANGLE_MIN: f32 = 1e-3;
