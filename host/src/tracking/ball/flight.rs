//! `flight`: detection of chipped balls, and prediction of their landing. m, m/s, s.
//!
//! Vision assumes that every ball lies on the field surface: one at height z below a camera at (c, H) appears
//! at a = c + (p − c) · H / (H − z), which is the same as p + (a − c) · z / H = a. With p = p₀ + v t and z =
//! w t − g t² / 2 that is linear in p₀, v and w:
//!
//! p₀ + v t + w · t (a − c) / H = a + (g t² / 2)(a − c) / H
//!
//! so the flight is found by least squares, and beside it a flat kick with free deceleration; the ball flies
//! when only the flight explains the detections. A camera right above cannot distinguish the two, but then
//! the ball does not appear displaced.

use geometry::{Field, Point, Vector};

use super::super::robots::seconds;
use super::super::scene::Camera;
use super::super::seen::Captured;
use crate::world::GRAVITY_M_S2;
use protocol::Who;

/// p₀ and v along x and y, and climb or deceleration.
const UNKNOWNS: usize = 5;
/// Detections of one flight: 0.4 s and more; later ones improve little.
const SAMPLES_MAX: usize = 48;
/// Detections nearer in time to each other than this add nothing, s: four cameras that see the ball at once.
const SAMPLES_APART_S: f32 = 0.006;
/// Fewer detections, or a shorter time (s), do not distinguish a flight from a flat kick: in 60 ms a ball
/// that rises with 2 m/s is 0.1 m high, which appears as 25 mm at one metre from below a camera 4 m high.
const SAMPLES_MIN: usize = 5;
const TIME_MIN_S: f32 = 0.06;
/// Offsets tried around the kick's moment by two detections, in units of its uncertainty.
const MOMENT_SHIFTS_SIGMA: [f32; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
/// Uncertainty of the moment by a turn, s: half a frame.
pub(super) const MOMENT_SIGMA_SHARP_S: f32 = 0.008;
/// Uncertainty of the moment of a turn that was detected late, s: two frames.
pub(super) const MOMENT_SIGMA_VAGUE_S: f32 = 0.03;
/// Uncertainty of the kick's place, m.
const PLACE_SIGMA_M: f32 = 0.01;
/// Climbs that are flights, m/s: slower ones stay below 50 mm; no robot kicks straight up with 10 m/s.
const CLIMB_MIN_M_S: f32 = 1.0;
const CLIMB_MAX_M_S: f32 = 10.0;
/// No kicker launches a ball more steeply than this (tangent of 76°; chippers are built for 45°, and a
/// launch's direction is known to some degrees after 60 ms).
const LAUNCH_TAN_MAX: f32 = 4.0;
/// A flight fits when its mean squared error is less than this, in variances (1 where the noise is as
/// configured; the noise of cameras that disagree is larger).
const FIT_VARIANCES_MAX: f32 = 6.0;
/// A flat kick is accepted unless its summed squared error is worse by this, in variances (times the flight's
/// own mean): 1 in 10⁶ by noise.
const FLAT_WORSE_VARIANCES: f32 = 25.0;
/// A flat kick decelerates by at most this much more than the field surface's sliding deceleration.
const SLIDE_FACTOR_MAX: f32 = 1.5;
/// Normal equations with a smaller pivot have no solution (m², s², as samples weigh 1).
const PIVOT_MIN: f32 = 1e-9;

/// A kick that is being watched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Launch {
    pub(super) at: Captured,
    pub(super) from: Point<Field>,
    /// The robot that stood there.
    pub(super) by: Option<Who>,
    /// Uncertainty of the moment, s.
    slack: f32,
    samples: [Sample; SAMPLES_MAX],
    count: usize,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    /// Time since the kick, s.
    time: f32,
    /// From the kick's place to where the ball appeared.
    seen: Vector<Field>,
    /// (a − c) / H.
    slant: Vector<Field>,
}

/// A ball's flight up to its first touch of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flight {
    pub(super) at: Captured,
    pub(super) from: Point<Field>,
    pub(super) velocity: Vector<Field>,
    pub(super) climb: f32,
}

impl Launch {
    /// A kick at that moment, known to ± `slack` s, from that place.
    pub(super) fn new(at: Captured, from: Point<Field>, by: Option<Who>, slack: f32) -> Self {
        Self { at, from, by, slack, samples: [Sample::default(); SAMPLES_MAX], count: 0 }
    }

    /// Adds a detection of a camera; without room or without a camera's place it is left out.
    pub(super) fn add(&mut self, apparent: Point<Field>, at: Captured, camera: Option<Camera>) {
        let Some(camera) = camera.filter(|_| !self.is_full()) else { return };
        let time = seconds(at - self.at);
        if self.count > 0 && time < self.samples[self.count - 1].time + SAMPLES_APART_S {
            return;
        }
        self.samples[self.count] = Sample {
            time,
            seen: apparent - self.from,
            slant: (apparent - camera.above) * (1.0 / camera.height),
        };
        self.count += 1;
    }

    fn samples(&self) -> &[Sample] {
        &self.samples[..self.count]
    }

    /// Whether it is time to ask [`Self::flight`].
    pub(super) fn is_ripe(&self) -> bool {
        self.count >= SAMPLES_MIN && self.samples[self.count - 1].time >= TIME_MIN_S
    }

    /// Whether there is no room for another detection.
    pub(super) fn is_full(&self) -> bool {
        self.count == SAMPLES_MAX
    }

    /// The flight that explains the detections, if a flat kick does not; `decided` requests the best flight
    /// in any case.
    pub(super) fn flight(&self, sigma: f32, slide: f32, decided: bool) -> Option<Flight> {
        let mut best: Option<(f32, f32, [f32; UNKNOWNS])> = None;
        for share in MOMENT_SHIFTS_SIGMA {
            let shift = share * self.slack;
            let rows = |sample: &Sample| {
                let t = sample.time - shift;
                let fall = 0.5 * GRAVITY_M_S2 * t * t;
                (t, sample.slant * t, sample.seen + sample.slant * fall)
            };
            let Some((solution, error)) = solve(self.samples(), sigma, None, rows) else {
                continue;
            };
            let error = error + share * share;
            if best.is_none_or(|(_, least, _)| error < least) {
                best = Some((shift, error, solution));
            }
        }
        let (shift, error, [x, y, vx, vy, climb]) = best?;
        let freedoms = (2 * self.count).saturating_sub(UNKNOWNS).max(1) as f32;
        let mean = error / freedoms;
        let along = Vector::<Field>::new(vx, vy).norm();
        if !(CLIMB_MIN_M_S..=CLIMB_MAX_M_S).contains(&climb) || climb > LAUNCH_TAN_MAX * along {
            return None;
        }
        if !decided
            && (mean > FIT_VARIANCES_MAX
                || self.flat_error(sigma, slide) < error + FLAT_WORSE_VARIANCES * (1.0 + mean))
        {
            return None;
        }
        let at = self.at + (shift * 1e6) as Captured;
        let flight = Flight { at, from: self.from + Vector::new(x, y), velocity: Vector::new(vx, vy), climb };
        Some(flight)
    }

    /// Error of the best flat kick over the detections, in variances.
    fn flat_error(&self, sigma: f32, slide: f32) -> f32 {
        let Some(last) = self.samples().last() else { return 0.0 };
        let along = last.seen.unit().unwrap_or_default();
        let rows = |sample: &Sample| {
            let t = sample.time;
            (t, along * (-0.5 * t * t), sample.seen)
        };
        let most = slide * SLIDE_FACTOR_MAX;
        let Some((solution, error)) = solve(self.samples(), sigma, None, rows) else { return 0.0 };
        if (0.0..=most).contains(&solution[4]) {
            return error;
        }
        solve(self.samples(), sigma, Some(solution[4].clamp(0.0, most)), rows).map_or(0.0, |(_, error)| error)
    }
}

impl Flight {
    /// Height and climb at that time after the kick, until it lands, m and m/s.
    pub(super) fn height(&self, at: Captured) -> (f32, f32) {
        let t = seconds(at - self.at).max(0.0);
        ((self.climb * t - 0.5 * GRAVITY_M_S2 * t * t).max(0.0), self.climb - GRAVITY_M_S2 * t)
    }

    pub(super) fn position(&self, at: Captured) -> Point<Field> {
        self.from + self.velocity * seconds(at - self.at)
    }

    /// Time at which it touches the ground.
    pub(super) fn lands(&self) -> Captured {
        self.at + (self.climb * (2.0 / GRAVITY_M_S2) * 1e6) as Captured
    }
}

/// Least squares for p₀, v and one more unknown u: p₀ + v t + u · `slope` = `value` for each sample, p₀
/// close to 0. Gives the solution and the sum of squared errors in variances.
fn solve(
    samples: &[Sample],
    sigma: f32,
    fixed: Option<f32>,
    rows: impl Fn(&Sample) -> (f32, Vector<Field>, Vector<Field>),
) -> Option<([f32; UNKNOWNS], f32)> {
    let mut normal = [[0.0_f32; UNKNOWNS + 1]; UNKNOWNS];
    // The kick's place is known to some millimetres.
    let known = (sigma / PLACE_SIGMA_M) * (sigma / PLACE_SIGMA_M);
    normal[0][0] = known;
    normal[1][1] = known;
    let mut add = |row: [f32; UNKNOWNS + 1]| {
        for (i, line) in normal.iter_mut().enumerate() {
            for (cell, value) in line.iter_mut().zip(row) {
                *cell += row[i] * value;
            }
        }
    };
    for sample in samples {
        let (t, slope, value) = rows(sample);
        add([1.0, 0.0, t, 0.0, slope.x(), value.x()]);
        add([0.0, 1.0, 0.0, t, slope.y(), value.y()]);
    }
    if let Some(fixed) = fixed {
        normal[4] = [0.0, 0.0, 0.0, 0.0, 1.0, fixed];
    }
    let solution = eliminate(&mut normal)?;
    let [x, y, vx, vy, u] = solution;
    let errors = samples.iter().map(|sample| {
        let (t, slope, value) = rows(sample);
        let off = Vector::<Field>::new(x + vx * t, y + vy * t) + slope * u - value;
        off.dot(off)
    });
    let sum: f32 = errors.sum();
    Some((solution, (sum + known * (x * x + y * y)) / (sigma * sigma)))
}

/// Gauss with the largest pivot; `None` where the unknowns are not separable.
fn eliminate(normal: &mut [[f32; UNKNOWNS + 1]; UNKNOWNS]) -> Option<[f32; UNKNOWNS]> {
    for column in 0..UNKNOWNS {
        let pivot = (column..UNKNOWNS).max_by(|a, b| {
            let size = |row: &usize| normal[*row][column].abs();
            size(a).total_cmp(&size(b))
        })?;
        normal.swap(column, pivot);
        let head = normal[column];
        if head[column].abs() < PIVOT_MIN {
            return None;
        }
        for row in normal.iter_mut().skip(column + 1) {
            let factor = row[column] / head[column];
            for (cell, above) in row.iter_mut().zip(head) {
                *cell -= factor * above;
            }
        }
    }
    let mut solution = [0.0; UNKNOWNS];
    for row in (0..UNKNOWNS).rev() {
        let mut value = normal[row][UNKNOWNS];
        for column in row + 1..UNKNOWNS {
            value -= normal[row][column] * solution[column];
        }
        solution[row] = value / normal[row][row];
    }
    solution.iter().all(|x| x.is_finite()).then_some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera { above: Point::new(2.0, 1.0), height: 4.0 };

    fn watched(position: impl Fn(f32) -> (Point<Field>, f32), count: usize) -> Launch {
        let mut launch = Launch::new(1_000_000, Point::new(0.0, 0.0), None, MOMENT_SIGMA_SHARP_S);
        for i in 1..=count {
            let t = i as f32 / 60.0;
            let (p, z) = position(t);
            let apparent = CAMERA.above + (p - CAMERA.above) * (CAMERA.height / (CAMERA.height - z));
            launch.add(apparent, 1_000_000 + (t * 1e6) as i64, Some(CAMERA));
        }
        launch
    }

    #[test]
    fn an_exact_flight_is_found_with_its_landing() {
        let launch = watched(|t| (Point::new(3.0 * t, -t), 2.5 * t - 0.5 * 9.81 * t * t), 10);
        let flight = launch.flight(0.003, 3.9, false).unwrap();
        assert!((flight.velocity - Vector::new(3.0, -1.0)).norm() < 0.02, "{flight:?}");
        assert!((flight.climb - 2.5).abs() < 0.02);
        let landing = flight.position(flight.lands());
        let truth = Vector::<Field>::new(3.0, -1.0).norm() * (5.0 / 9.81);
        assert!((landing.distance(Point::default()) - truth).abs() < 0.01);
    }

    #[test]
    fn a_sliding_ball_does_not_fly() {
        for count in 5..30 {
            let launch =
                watched(|t| (Point::new(4.0 * t - 1.95 * t * t, 2.0 * t - 0.97 * t * t), 0.0), count);
            assert_eq!(launch.flight(0.003, 3.9, false), None, "{count} glimpses");
        }
    }

    #[test]
    fn a_slow_ball_that_a_turning_robot_leads_around_does_not_fly() {
        // On the front of a robot that turns with 3.5 rad/s: a circle of 0.095 m, accelerating from
        // standstill.
        for count in 5..30 {
            let launch = watched(
                |t| {
                    let turned = if t < 0.3 { 6.0 * t * t } else { 0.54 + 3.5 * (t - 0.3) };
                    (Point::new(0.0945 * turned.sin(), 0.0945 * (1.0 - turned.cos())), 0.0)
                },
                count,
            );
            assert_eq!(launch.flight(0.003, 3.9, false), None, "{count} glimpses");
        }
    }

    #[test]
    fn a_kick_that_no_known_camera_saw_is_not_judged() {
        let mut launch = Launch::new(0, Point::default(), None, MOMENT_SIGMA_SHARP_S);
        launch.add(Point::new(1.0, 0.0), 100_000, None);
        assert!(!launch.is_ripe() && !launch.is_full());
        assert_eq!(launch.flight(0.003, 3.9, true), None);
    }
}
