//! `wheels`: motors of any scheme with their encoders, as the control loop drives them.

use embassy_time::Instant;
use rules::RobotSpec;
use runtime::ports::WheelsPort;
use runtime::sense::Encoder;
use runtime::wheel::WHEELS;

use crate::encoders::EncoderCounts;
use crate::motors::MotorDrivers;

/// The board's output that drives each wheel.
const OUTPUTS: [u8; WHEELS] = RobotSpec::OURS.wheels.outputs;

/// Motors with their encoders.
#[derive(Debug)]
pub struct Wheels<M, E> {
    drivers: M,
    encoders: E,
    speeds: [Encoder; WHEELS],
    duty: [f32; WHEELS],
}

impl<M: MotorDrivers, E: EncoderCounts> Wheels<M, E> {
    /// Wheels with all motors without current.
    pub fn new(drivers: M, encoders: E) -> Self {
        Self { drivers, encoders, speeds: [Encoder::new(E::RIM_PER_COUNT); WHEELS], duty: [0.0; WHEELS] }
    }

    /// Counts of the wheels' encoders; they wrap.
    pub fn counts(&self) -> [u16; WHEELS] {
        let of_outputs = self.encoders.counts();
        OUTPUTS.map(|output| of_outputs.get(usize::from(output)).copied().unwrap_or(0))
    }
}

impl<M: MotorDrivers, E: EncoderCounts> WheelsPort for Wheels<M, E> {
    fn measured(&mut self) -> [f32; WHEELS] {
        let now = protocol::Instant(Instant::now().as_micros());
        let mut rims = [0.0; WHEELS];
        let counts = self.counts();
        for (((rim, encoder), count), duty) in
            rims.iter_mut().zip(&mut self.speeds).zip(counts).zip(self.duty)
        {
            *rim = encoder.step(now, count, duty);
        }
        rims
    }

    fn drive(&mut self, duty: [f32; WHEELS], dribbler: f32) {
        // Three wheels alone would turn the robot: all off where one driver has switched itself off.
        if self.drivers.has_fault() {
            return self.release();
        }
        let mut of_outputs = [0.0; WHEELS];
        for (output, duty) in OUTPUTS.into_iter().zip(duty) {
            if let Some(place) = of_outputs.get_mut(usize::from(output)) {
                *place = duty;
            }
        }
        self.drivers.drive(of_outputs, dribbler);
        self.duty = duty;
    }

    fn release(&mut self) {
        self.drivers.release();
        self.duty = [0.0; WHEELS];
    }
}
