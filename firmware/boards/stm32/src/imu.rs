//! `imu`: IMU driver. A gyroscope and accelerometer on SPI: ICM-42688-P (TDK DS-000347).

use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::mode::Blocking;
use embassy_stm32::spi::mode::Master;
use embassy_stm32::spi::{Config, Error, MODE_3, Spi};
use embassy_stm32::time::Hertz;
use embassy_time::Timer;

use crate::pins;

/// The IMU on its bus.
pub struct Imu {
    bus: Spi<'static, Blocking, Master>,
    select: Output<'static>,
}

/// Why a reading is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum ImuError {
    /// An SPI transfer ended with an error.
    Bus,
    /// Another chip answers, or none (0x00, 0xff): this value instead of 0x47.
    Unauthenticated(u8),
    /// The data line never changes: the sensor is unplugged, or without supply.
    Silent,
}

impl From<Error> for ImuError {
    fn from(_: Error) -> Self {
        Self::Bus
    }
}

/// A reading, in the sensor's axes.
#[derive(Clone, Copy, Debug, PartialEq, defmt::Format)]
pub struct Reading {
    /// Acceleration with gravity, g, sensor's axes.
    pub acceleration: [f32; 3],
    /// Turning rate, rad/s, sensor's axes.
    pub rate: [f32; 3],
}

impl Imu {
    /// A sensor without any transfer yet.
    pub fn new(parts: pins::Imu) -> Self {
        let mut config = Config::default();
        config.mode = MODE_3;
        config.frequency = CLOCK;
        let bus = Spi::new_blocking(parts.bus, parts.clock, parts.to, parts.from, config);
        Self { bus, select: Output::new(parts.select, Level::High, Speed::Low) }
    }

    /// Reads its identification and starts it: 2,000 degrees a second, 16 g, 1,000 readings a second.
    pub async fn start(&mut self) -> Result<(), ImuError> {
        self.write(DEVICE_CONFIG, 1)?;
        // After a reset it needs a millisecond.
        Timer::after_millis(2).await;
        let name = self.read::<1>(WHO_AM_I)?;
        if name != [NAME] {
            return Err(ImuError::Unauthenticated(name[0]));
        }
        self.write(GYRO_CONFIG0, RATE_1_KHZ)?;
        self.write(ACCEL_CONFIG0, RATE_1_KHZ)?;
        self.write(PWR_MGMT0, BOTH_LOW_NOISE)?;
        // No register may be written for 200 µs; the gyroscope is valid after 45 ms.
        Timer::after_millis(45).await;
        Ok(())
    }

    /// The newest reading: 13 bytes at 6 MHz, some 20 µs.
    pub fn reading(&mut self) -> Result<Reading, ImuError> {
        let raw: [u8; 12] = self.read(ACCEL_DATA)?;
        // Six numbers of a working sensor are never all equal: it measures gravity.
        if raw.iter().all(|byte| *byte == raw[0]) {
            return Err(ImuError::Silent);
        }
        let [ax, ay, az, gx, gy, gz] = description(raw);
        Ok(Reading {
            acceleration: [ax, ay, az].map(|raw| f32::from(raw) * G_A_STEP),
            rate: [gx, gy, gz].map(|raw| f32::from(raw) * RAD_A_STEP),
        })
    }

    fn write(&mut self, register: u8, value: u8) -> Result<(), ImuError> {
        self.select.set_low();
        let done = self.bus.blocking_write(&[register, value]);
        self.select.set_high();
        Ok(done?)
    }

    fn read<const N: usize>(&mut self, register: u8) -> Result<[u8; N], ImuError> {
        let mut bytes = [0; N];
        self.select.set_low();
        let done = self
            .bus
            .blocking_write(&[register | READ])
            .and_then(|()| self.bus.blocking_transfer_in_place(&mut bytes));
        self.select.set_high();
        done?;
        Ok(bytes)
    }
}

/// Decodes 16-bit values, high byte first.
fn description(raw: [u8; 12]) -> [i16; 6] {
    let mut bytes = [0; 6];
    for (label, pair) in bytes.iter_mut().zip(raw.as_chunks().0) {
        *label = i16::from_be_bytes(*pair);
    }
    bytes
}

/// SPI clock; the sensor allows 24 MHz.
const CLOCK: Hertz = Hertz(8_000_000);
const READ: u8 = 0x80;
const DEVICE_CONFIG: u8 = 0x11;
const ACCEL_DATA: u8 = 0x1f;
const PWR_MGMT0: u8 = 0x4e;
const GYRO_CONFIG0: u8 = 0x4f;
const ACCEL_CONFIG0: u8 = 0x50;
const WHO_AM_I: u8 = 0x75;
const NAME: u8 = 0x47;
/// The widest range, and 1 kHz.
const RATE_1_KHZ: u8 = 0x06;
const BOTH_LOW_NOISE: u8 = 0x0f;
/// 2,048 steps a g.
const G_A_STEP: f32 = 1.0 / 2048.0;
/// 16.4 steps for a degree a second.
const RAD_A_STEP: f32 = core::f32::consts::PI / 180.0 / 16.4;
