//! `sampling`: sensor sampling at 1 kHz. One task reads gyroscope, battery, capacitor and break-beam sensor;
//! kicker and brain take the newest.
//!
//! A reading older than ten steps is invalid: then the kicker neither charges nor fires, and the gyroscope is
//! not used.

use core::cell::Cell;

use embassy_sync::blocking_mutex::CriticalSectionMutex;
use embassy_time::{Duration, Instant, Ticker};
use runtime::kicker::{FULL_VOLTS, KickerState};
use runtime::ports::{self, Seen};
use runtime::sense::{BreakBeam, GyroOffset, Tilt};

use crate::imu::{Gyroscope, ImuError};

/// Inputs measured as a voltage, and the lamp of the break-beam sensor.
pub trait AnalogInputs {
    /// Battery voltage, V; NaN where it is not measured, which brakes the robot.
    fn battery(&mut self) -> f32;

    /// Voltage of the kicker's capacitor, V; NaN where it is not measured: it neither charges nor fires.
    fn capacitor(&mut self) -> f32;

    /// Light at the receiver of the break-beam sensor, 0 to 1.
    fn break_beam(&mut self) -> f32;

    /// Switches the lamp of the break-beam sensor; visible with the next step, because a receiver needs some
    /// 100 µs.
    fn light(&mut self, lit: bool);
}

/// The last reading of all sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub struct SensorSample {
    /// Turning rate of the body, rad/s, counter-clockwise.
    pub turn: Option<f32>,
    /// The robot lies on its side.
    pub tipped: bool,
    /// The beam is interrupted.
    pub ball: bool,
    /// Battery voltage, V; NaN without a valid reading.
    pub battery: f32,
    /// Voltage of the kicker's capacitor, V; NaN without a valid reading.
    pub capacitor: f32,
}

impl SensorSample {
    const NONE: Self =
        Self { turn: None, tipped: false, ball: false, battery: f32::NAN, capacitor: f32::NAN };

    /// State that the kicker's interlock needs.
    pub fn kicker(&self) -> KickerState {
        KickerState { ball: self.ball, volts: self.capacitor }
    }
}

/// The newest sample, if it is recent enough; else all readings are unknown, and an unknown battery brakes
/// the robot.
pub fn newest() -> SensorSample {
    let (at, sample) = NEWEST.lock(Cell::get);
    if at.elapsed() < SAMPLE_AGE_MAX { sample } else { SensorSample::NONE }
}

/// Reads everything, for ever. A gyroscope that does not answer is reported and tried again each second;
/// until then the turning rate comes from the wheels.
pub async fn run(mut imu: impl Gyroscope, mut analog: impl AnalogInputs) -> ! {
    let (mut turn, mut tilt, mut break_beam) = (GyroOffset::new(), Tilt::new(), BreakBeam::new());
    let mut answers = false;
    let mut lit = false;
    let mut ticker = Ticker::every(SAMPLING_PERIOD);
    let mut asked = Instant::MIN;
    loop {
        if !answers && (asked == Instant::MIN || asked.elapsed() >= START_RETRY_PERIOD) {
            asked = Instant::now();
            match imu.start().await {
                Ok(()) => answers = true,
                Err(error) => report(error),
            }
            ticker.reset();
        }
        ticker.next().await;
        let reading = if answers { imu.reading() } else { Err(ImuError::Silent) };
        if let (true, Err(error)) = (answers, &reading) {
            answers = false;
            report(*error);
        }
        let now = Instant::now();
        let sample = SensorSample {
            turn: reading.ok().and_then(|reading| turn.step(reading.rate[UP_AXIS])),
            tipped: tilt.step(
                protocol::Instant(now.as_micros()),
                reading.map_or(f32::NAN, |reading| reading.acceleration[UP_AXIS]),
            ),
            ball: break_beam.step(lit, analog.break_beam()),
            battery: analog.battery(),
            capacitor: analog.capacitor(),
        };
        lit = !lit;
        analog.light(lit);
        NEWEST.lock(|newest| newest.set((now, sample)));
    }
}

/// Logs a missing reading.
fn report(error: ImuError) {
    #[cfg(target_os = "none")]
    defmt::warn!("no gyroscope: {}; the turning rate comes from the wheels", error);
    #[cfg(not(target_os = "none"))]
    let _ = error;
}

/// The probes that the brain reads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Probes;

impl ports::Probes for Probes {
    fn look(&mut self) -> Seen {
        let SensorSample { turn, tipped, ball, battery, capacitor } = newest();
        Seen { turn, ball, tipped, battery: Some(battery), kicker_ready: capacitor >= FULL_VOLTS }
    }
}

static NEWEST: CriticalSectionMutex<Cell<(Instant, SensorSample)>> =
    CriticalSectionMutex::new(Cell::new((Instant::MIN, SensorSample::NONE)));
/// Sampling period, that of the control loop.
const SAMPLING_PERIOD: Duration = Duration::from_millis(1);
/// Maximum age of a sample: ten steps.
const SAMPLE_AGE_MAX: Duration = Duration::from_millis(10);
/// Period in which a silent sensor is tried again.
const START_RETRY_PERIOD: Duration = Duration::from_secs(1);
/// Index of the accelerometer's axis that points up on a board that lies flat.
const UP_AXIS: usize = 2;
