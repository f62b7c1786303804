//! `parts`: which motor, encoder or gyroscope of a robot has failed, from what they say of each other.
//! Sans-IO, fed every 10 ms; m/s at the rim, rad/s.
//!
//! | part | evidence |
//! |---|---|
//! | encoder, gyroscope | four rims and a gyroscope measure three motions: what they contradict each other by vanishes without one of them |
//! | motor or driver | the body's acceleration against the efforts (duty cycles less what the speeds need): they fit without one of them |
//! | encoder | the board reports NaN: driven hard without moving |
//! | break-beam sensor | the host's ball contradicts it (`brain::belief`) |
//! | capacitor, charger | the voltage does not follow the orders to the kicker (`kicker`) |
//! | radio | its chip was set up again, or its line erred (`mailboxes`) |
//!
//! A part is suspected while leaving it out explains what all together do not, and failed once that has
//! lasted. It stays so until the next start, and is not used: the others give the same motion
//! (`motion::omni`). No scale of mass, grip or battery enters: only proportions count.

use geometry::{Body, Twist, math};
use motion::omni::Omni;
use protocol::Instant;
use protocol::parts::{PARTS, Part, PartState, PartsReport};
use rules::RobotSpec;

use crate::wheel::{Lost, Motors, WHEELS, without};

/// Means of the control loop's readings over some milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Rolled {
    /// Rim speeds, m/s; NaN where the board knows that an encoder is broken.
    pub rims: [f32; WHEELS],
    /// Duty cycles less those that the speeds need without load: what accelerates.
    pub efforts: [f32; WHEELS],
}

/// Sums of the control loop's readings.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    sums: Rolled,
    count: u8,
    /// The duty cycles of the step before: the speeds of this one come from them.
    duty: [f32; WHEELS],
}

impl Means {
    /// Adds a step of a millisecond; the means of every tenth.
    pub fn add(&mut self, rims: [f32; WHEELS], motors: Motors) -> Option<Rolled> {
        let Rolled { rims: sums, efforts } = &mut self.sums;
        for (((sum, effort), rim), duty) in sums.iter_mut().zip(efforts).zip(rims).zip(self.duty) {
            *sum += rim;
            *effort += duty - rim / RobotSpec::OURS.wheels.free_speed;
        }
        self.duty = if let Motors::Driven(duty) = motors { duty } else { [0.0; WHEELS] };
        self.count += 1;
        if self.count < MEAN_STEPS {
            return None;
        }
        let Rolled { rims, efforts } = self.sums;
        (self.sums, self.count) = (Rolled::default(), 0);
        Some(Rolled { rims: rims.map(mean), efforts: efforts.map(mean) })
    }
}

/// The estimator of one robot.
#[derive(Clone, Debug)]
pub struct PartsEstimator {
    all: Omni,
    /// Kinematics of the encoders that work.
    whole: Omni,
    /// Turning rate for each rim of 1 m/s, by all wheels, and by all but each; and their noise.
    turning: [([f32; WHEELS], f32); 1 + WHEELS],
    /// Decaying mean of squared contradictions, (m/s)²: of everything, without each encoder, without the
    /// gyroscope.
    contradictions: [f32; 2 + WHEELS],
    /// The first of them, without what was contradicted while wheels may have slipped.
    firm: f32,
    /// Decaying mean of the largest effort.
    strain: f32,
    window: Window,
    efforts: Efforts,
    /// Since when each part is suspected, or failed.
    since: [Option<Instant>; PARTS as usize],
    report: PartsReport,
    lost: Lost,
    had_gyroscope: bool,
}

/// Sums over a window of the acceleration's measurement.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    count: u8,
    start: Option<Twist<Body>>,
    efforts: [f32; WHEELS],
}

/// Decaying sums of products of acceleration and what the efforts of all motors, and of all but each,
/// predict.
#[derive(Clone, Copy, Debug, Default)]
struct Efforts {
    squared: f32,
    products: [f32; 1 + WHEELS],
    predicted: [f32; 1 + WHEELS],
}

impl PartsEstimator {
    /// An estimator that suspects nothing.
    #[inline(never)]
    pub fn new() -> Self {
        let all = Omni::default();
        Self {
            turning: core::array::from_fn(|index| {
                let row = turning(&index.checked_sub(1).map_or(all, without));
                (row, math::sqrt(row.iter().map(|rate| rate * rate).sum::<f32>()))
            }),
            whole: all,
            all,
            contradictions: [0.0; 2 + WHEELS],
            firm: 0.0,
            strain: 0.0,
            window: Window::default(),
            efforts: Efforts::default(),
            since: [None; PARTS as usize],
            report: PartsReport::default(),
            lost: Lost::default(),
            had_gyroscope: false,
        }
    }

    /// Parts that are no longer used.
    pub const fn lost(&self) -> Lost {
        self.lost
    }

    /// The state of all parts.
    pub const fn report(&self) -> PartsReport {
        self.report
    }

    /// Motion of the body by the parts that work; NaN where too few are left.
    pub fn odometry(&self, rims: [f32; WHEELS], gyroscope: Option<f32>) -> Twist<Body> {
        let mut rims = rims;
        for (wheel, rim) in rims.iter_mut().enumerate() {
            if self.lost.stops() {
                *rim = f32::NAN;
            } else if self.lost.encoders & 1 << wheel != 0 {
                *rim = 0.0;
            }
        }
        let Twist { linear, angular } = self.whole.twist(rims);
        Twist { linear, angular: gyroscope.filter(|_| !self.lost.gyroscope).unwrap_or(angular) }
    }

    fn lose(&mut self, part: Part) {
        match part.number() {
            wheel @ 0..4 => self.lost.motors |= 1 << wheel,
            wheel @ 4..8 if self.lost.encoders & 1 << (wheel - 4) == 0 => {
                self.lost.encoders |= 1 << (wheel - 4);
                self.whole = without(usize::from(wheel - 4));
            }
            8 => self.lost.gyroscope = true,
            _ => {}
        }
    }

    /// Takes the readings of the last 10 ms, and which others are doubted where they work.
    pub fn step(&mut self, now: Instant, rolled: &Rolled, gyroscope: Option<f32>, doubted: Doubted) {
        let mut suspects = [None; PARTS as usize];
        self.contradictory(rolled, gyroscope, &mut suspects);
        for (doubted, suspect) in doubted.into_iter().zip(suspects.iter_mut().skip(FIRST_DOUBTED)) {
            *suspect = doubted.then_some(1.0);
        }
        self.judge(now, &suspects);
    }

    fn contradictory(&mut self, rolled: &Rolled, gyroscope: Option<f32>, suspects: &mut Suspects) {
        for (wheel, rim) in (0_u8..).zip(rolled.rims) {
            if !rim.is_finite() && self.report.state(Part::motor(wheel)) != PartState::Failed {
                suspect(suspects, Part::encoder(wheel), 1.0);
            }
        }
        if self.had_gyroscope && gyroscope.is_none() {
            suspect(suspects, Part::GYROSCOPE, 1.0);
        }
        self.had_gyroscope |= gyroscope.is_some();
        let whole = rolled.rims.iter().all(|rim| rim.is_finite()) && self.lost == Lost::default();
        if whole && RobotSpec::OURS.wheels.count as usize == WHEELS {
            self.accelerate(rolled);
            self.idle_motor(suspects);
            if let Some(turn) = gyroscope {
                let largest = rolled.efforts.iter().fold(0.0, |most: f32, effort| most.max(effort.abs()));
                decay(&mut self.strain, largest, CONTRADICTION_SHARE);
                self.contradict(&rolled.rims, turn, largest.max(self.strain) > STRAIN_MAX);
                // With three motors wheels slip, and contradict each other.
                if suspects.iter().all(Option::is_none) {
                    self.least_contradiction(suspects);
                }
            }
        }
    }

    fn contradict(&mut self, rims: &[f32; WHEELS], turn: f32, slips: bool) {
        let fitted = self.all.rims(self.all.twist(*rims));
        let among_wheels: f32 =
            rims.iter().zip(fitted).map(|(rim, fitted)| (rim - fitted) * (rim - fitted)).sum();
        let [of_all, of_gyroscope, of_encoders @ ..] = &mut self.contradictions;
        decay(of_gyroscope, among_wheels, CONTRADICTION_SHARE);
        let mut rest = among_wheels;
        let mut all = None;
        for (sum, (row, noise)) in core::iter::once(of_all).chain(of_encoders).zip(&self.turning) {
            let turned: f32 = row.iter().zip(rims).map(|(rate, rim)| rate * rim).sum();
            let off = (turned - turn) / noise;
            let contradiction = rest + off * off;
            decay(sum, contradiction, CONTRADICTION_SHARE);
            all = all.or(Some(contradiction));
            rest = 0.0;
        }
        let firm = all.filter(|_| !slips).unwrap_or(0.0);
        decay(&mut self.firm, firm, CONTRADICTION_SHARE);
    }

    fn least_contradiction(&self, suspects: &mut Suspects) {
        let [of_all, of_gyroscope, of_encoders @ ..] = self.contradictions;
        let encoders = (0..).zip(of_encoders).map(|(wheel, sum)| (Part::encoder(wheel), sum));
        let [best, second] = two_least(encoders.chain([(Part::GYROSCOPE, of_gyroscope)]));
        // All wheels slip together where they push hard, as without a gyroscope.
        let (of_all, least) =
            if best.0 == Part::GYROSCOPE { (self.firm, GYROSCOPE_MIN) } else { (of_all, CONTRADICTION_MIN) };
        if of_all > least * least && best.1 < EXPLAINED_MAX * of_all && best.1 < NEXT_MAX * second.1 {
            suspect(suspects, best.0, 1.0 - best.1 / of_all);
        }
    }

    /// Adds a window of the body's acceleration, and what the efforts predict.
    fn accelerate(&mut self, rolled: &Rolled) {
        let twist = self.all.twist(rolled.rims);
        let window = &mut self.window;
        let Some(start) = window.start.filter(|_| window.count < WINDOW_STEPS) else {
            *window = Window { count: 0, start: Some(twist), efforts: [0.0; WHEELS] };
            return;
        };
        window.count += 1;
        for (sum, effort) in window.efforts.iter_mut().zip(rolled.efforts) {
            *sum += effort;
        }
        if window.count < WINDOW_STEPS {
            return;
        }
        // Of the turning frame: dv/dt = a − ω × v.
        let turned = 0.5 * (start.angular + twist.angular) * WINDOW_S;
        let mean = (start.linear + twist.linear) * 0.5;
        let change = twist.linear - start.linear;
        let measured = [
            change.x() - turned * mean.y(),
            change.y() + turned * mean.x(),
            (twist.angular - start.angular) * GYRATION,
        ];
        let sums = &mut self.efforts;
        decay_sum(&mut sums.squared, dot(measured, measured));
        for (index, (product, predicted)) in sums.products.iter_mut().zip(&mut sums.predicted).enumerate() {
            let mut efforts = window.efforts;
            if let Some(effort) = index.checked_sub(1).and_then(|wheel| efforts.get_mut(wheel)) {
                *effort = 0.0;
            }
            let force = pushed(&self.all, &efforts);
            decay_sum(product, dot(measured, force));
            decay_sum(predicted, dot(force, force));
        }
        window.start = None;
    }

    fn idle_motor(&self, suspects: &mut Suspects) {
        if self.efforts.squared < CHANGE_MIN {
            return;
        }
        let all = self.efforts.unexplained(0);
        let motors = (0..WHEELS as u8)
            .map(|wheel| (Part::motor(wheel), self.efforts.unexplained(usize::from(wheel) + 1)));
        let [best, second] = two_least(motors);
        if all > UNEXPLAINED_MIN && best.1 < FITS_MAX * all && best.1 < NEXT_FIT_MAX * second.1 {
            suspect(suspects, best.0, 1.0 - best.1 / all);
        }
    }

    /// Suspicions that last become failures.
    fn judge(&mut self, now: Instant, suspects: &Suspects) {
        let mut named = None;
        for ((part, since), evidence) in Part::all().zip(&mut self.since).zip(suspects) {
            if self.report.state(part) == PartState::Failed {
                continue;
            }
            *since = evidence.map(|_| since.unwrap_or(now));
            let lasts = since.is_some_and(|since| now.since(since) >= FAILED_AFTER);
            let state = match evidence {
                None => PartState::Ok,
                Some(_) if !lasts => PartState::Suspected,
                Some(_) => PartState::Failed,
            };
            self.report = self.report.with(part, state);
            if let Some(evidence) = evidence {
                named = Some((part, *evidence));
            }
        }
        let report = self.report;
        report.in_state(PartState::Failed).for_each(|part| self.lose(part));
        if let Some((part, evidence)) = named {
            (self.report.part, self.report.evidence) = (part.number(), (evidence * 1_000.0) as u16);
        }
        let since = self.since.get(usize::from(self.report.part)).copied().flatten();
        let tenths = since.map_or(0, |since| now.since(since).0 / 100_000);
        self.report.since = tenths.min(u64::from(u16::MAX)) as u16;
    }
}

impl Default for PartsEstimator {
    fn default() -> Self {
        Self::new()
    }
}

/// Mean of a sum over the control steps.
fn mean(sum: f32) -> f32 {
    sum / f32::from(MEAN_STEPS)
}

impl Efforts {
    /// Share of the acceleration that the efforts of all motors (0), or of all but one, leave unexplained.
    fn unexplained(&self, index: usize) -> f32 {
        match (self.products.get(index), self.predicted.get(index)) {
            (Some(product), Some(predicted)) if *product > 0.0 && *predicted > 0.0 => {
                1.0 - product * product / (self.squared * predicted)
            }
            _ => 1.0,
        }
    }
}

/// Break-beam sensor, capacitor with charger, radio: whether each is doubted where it works.
pub type Doubted = [bool; 3];

/// Number of the first of them.
const FIRST_DOUBTED: usize = Part::BREAK_BEAM.number() as usize;

/// Share of its contradiction or misfit that the failure of a part explains; none: not suspected.
type Suspects = [Option<f32>; PARTS as usize];

fn suspect(suspects: &mut Suspects, part: Part, evidence: f32) {
    if let Some(place) = suspects.get_mut(usize::from(part.number())) {
        *place = Some(evidence);
    }
}

/// Turning rate for a rim of 1 m/s of each wheel.
fn turning(omni: &Omni) -> [f32; WHEELS] {
    core::array::from_fn(|wheel| {
        omni.twist(core::array::from_fn(|other| if other == wheel { 1.0 } else { 0.0 })).angular
    })
}

/// The part with the least number, and the next.
fn two_least(numbers: impl Iterator<Item = (Part, f32)>) -> [(Part, f32); 2] {
    let mut least = [(Part::GYROSCOPE, f32::INFINITY); 2];
    for (part, number) in numbers {
        if number < least[0].1 {
            least = [(part, number), least[0]];
        } else if number < least[1].1 {
            least[1] = (part, number);
        }
    }
    least
}

/// Acceleration that these efforts give, up to a scale.
#[inline(never)]
fn pushed(omni: &Omni, efforts: &[f32; WHEELS]) -> [f32; 3] {
    let [x, y, turn] = omni.forces(*efforts);
    [x, y, turn / GYRATION]
}

fn decay(mean: &mut f32, value: f32, share: f32) {
    *mean += (value - *mean) * share;
}

fn decay_sum(sum: &mut f32, value: f32) {
    *sum = *sum * EFFORTS_KEPT + value;
}

fn dot([a, b, c]: [f32; 3], [x, y, z]: [f32; 3]) -> f32 {
    a * x + b * y + c * z
}

/// Control steps in a step of the estimator.
const MEAN_STEPS: u8 = 10;
/// A suspicion that lasts for this time is a failure: longer than a wheel slips or a robot is pushed.
const FAILED_AFTER: protocol::Duration = protocol::Duration::millis(350);
/// Share of a new step in the contradictions' means: they span 0.3 s.
const CONTRADICTION_SHARE: f32 = 1.0 / 30.0;
/// Contradiction from which an encoder is suspected, m/s: more than a wheel slips for half a second.
const CONTRADICTION_MIN: f32 = 0.35;
/// The same of the gyroscope, m/s: 0.6 rad/s at our wheels.
const GYROSCOPE_MIN: f32 = 0.1;
/// Mean effort of the hardest driven wheel above which wheels may slip, share of the battery's voltage.
const STRAIN_MAX: f32 = 0.15;
/// Share of the contradiction that may stay without a failed part.
const EXPLAINED_MAX: f32 = 0.1;
/// Share of the next best explanation's rest that the best one's may have.
const NEXT_MAX: f32 = 0.3;
/// Steps of a window over which acceleration is measured.
const WINDOW_STEPS: u8 = 5;
/// The same, s.
const WINDOW_S: f32 = 0.01 * WINDOW_STEPS as f32;
/// Share of the efforts' sums that is kept from window to window: they span 1.2 s.
const EFFORTS_KEPT: f32 = 0.93;
/// Sum of squared changes of speed from which efforts are compared, (m/s)²: 1 m/s² for 0.6 s.
const CHANGE_MIN: f32 = 0.02;
/// Radius of gyration, m: of an even disc of the hull's radius.
const GYRATION: f32 = 0.707 * RobotSpec::OURS.hull.radius;
/// Share of the acceleration that all motors' efforts must leave unexplained.
const UNEXPLAINED_MIN: f32 = 0.2;
/// Share of that which may stay without a failed motor.
const FITS_MAX: f32 = 0.7;
/// Share of the next best motor's rest that the best one's may have.
const NEXT_FIT_MAX: f32 = 0.6;
