//! `senses`: sensors of a wheeled robot. Wheels and gyroscope with noise, break-beam sensor, battery
//! (docs/architecture.md §3.2).
//!
//! Its position comes from its host alone: no pose, no ball seen, no opponents.

use geometry::{Twist, Vector};
use protocol::robot_io::{Health, SensorFrame};
use serde::{Deserialize, Serialize};

use super::STEP;
use super::parameters::{BatteryParameters, NoiseParameters};
use super::robot::{Odometer, Robot};
use crate::rng::Stream;
use protocol::Who;

#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Senses {
    noise: NoiseParameters,
    chance: Stream,
}

impl Senses {
    pub(super) fn new(noise: NoiseParameters, seed: u64, who: Who) -> Self {
        Self { noise, chance: Stream::new(seed, &format!("small size senses {}", who.slot())) }
    }

    /// The sensor frame of the robot; speeds are means since the last one.
    pub(super) fn look(&mut self, robot: &mut Robot, now: u64, battery: &BatteryParameters) -> SensorFrame {
        let restarted = Odometer { asked: now, ..Odometer::default() };
        let odometer = std::mem::replace(&mut robot.odometer, restarted);
        let mean = 1.0 / (now - odometer.asked).max(1) as f32;
        let [x, y] = odometer.along.map(|sum| sum * mean);
        let scale = self.deviation(self.noise.odometry);
        let drift = self.deviation(self.noise.gyro);
        SensorFrame {
            ball_contact: robot.ball_contact,
            odometry: Twist {
                linear: Vector::new(x, y) * (1.0 + scale),
                angular: odometer.turned * mean + drift,
            },
            health: Health {
                // Voltage in hundredths, the resolution of analogue-digital converters.
                battery: Some(geometry::math::round_to_i32(robot.volts(battery) * 100.0) as f32 * 0.01),
                tipped: robot.tipped,
                kicker_ready: robot.charged(now),
            },
            ..SensorFrame::default()
        }
    }

    fn deviation(&mut self, sigma: f32) -> f32 {
        if sigma > 0.0 { self.chance.normal() * sigma } else { 0.0 }
    }
}

/// The odometer assumes this step length.
const _: () = assert!(STEP == 0.001);
