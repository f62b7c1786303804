//! `wheels`: motors of any scheme with their encoders, as the control loop drives them.

use embassy_time::Instant;
use runtime::ports::WheelsPort;
use runtime::sense::Encoder;
use runtime::wheel::WHEELS;

use crate::encoders::EncoderCounts;
use crate::motors::MotorDrivers;

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

    /// Counts of the encoders; they wrap.
    pub fn counts(&self) -> [u16; WHEELS] {
        self.encoders.counts()
    }
}

impl<M: MotorDrivers, E: EncoderCounts> WheelsPort for Wheels<M, E> {
    fn measured(&mut self) -> [f32; WHEELS] {
        let now = protocol::Instant(Instant::now().as_micros());
        let mut rims = [0.0; WHEELS];
        let counts = self.encoders.counts();
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
        self.drivers.drive(duty, dribbler);
        self.duty = duty;
    }

    fn release(&mut self) {
        self.drivers.release();
        self.duty = [0.0; WHEELS];
    }
}
