//! `imu`: IMU driver. A gyroscope and accelerometer on SPI: ICM-42688-P (TDK DS-000347), on any chip's bus.

use embassy_time::Timer;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;

/// A gyroscope and accelerometer.
#[allow(async_fn_in_trait, reason = "all tasks of a robot run on one executor in one thread")]
pub trait Gyroscope {
    /// Reads its identification and starts it.
    async fn start(&mut self) -> Result<(), ImuError>;

    /// Reads the newest measurement.
    fn reading(&mut self) -> Result<Reading, ImuError>;
}

/// The IMU on its bus: mode 3, at most 24 MHz.
#[derive(Debug)]
pub struct Imu<B, S> {
    bus: B,
    select: S,
}

/// Reason why a reading is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub enum ImuError {
    /// An SPI transfer ended with an error.
    Bus,
    /// Another chip answers, or none (0x00, 0xff): this value instead of 0x47.
    WrongChip(u8),
    /// The data line never changes: the sensor is unplugged, or without supply.
    Silent,
    /// No sensor is on this board.
    NotWired,
}

/// A reading, in the sensor's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(target_os = "none", derive(defmt::Format))]
pub struct Reading {
    /// Acceleration with gravity, g, sensor's axes.
    pub acceleration: [f32; 3],
    /// Turning rate, rad/s, sensor's axes.
    pub rate: [f32; 3],
}

impl<B: SpiBus, S: OutputPin> Imu<B, S> {
    /// A sensor without any transfer yet; `select` must be high.
    pub fn new(bus: B, select: S) -> Self {
        Self { bus, select }
    }

    fn write(&mut self, register: u8, value: u8) -> Result<(), ImuError> {
        self.selected(|bus| bus.write(&[register, value]))
    }

    fn read<const N: usize>(&mut self, register: u8) -> Result<[u8; N], ImuError> {
        let mut bytes = [0; N];
        self.selected(|bus| {
            bus.write(&[register | READ_BIT])?;
            bus.transfer_in_place(&mut bytes)
        })?;
        Ok(bytes)
    }

    /// A transfer while the sensor is selected; the bus is idle again before it is let go.
    fn selected(&mut self, work: impl FnOnce(&mut B) -> Result<(), B::Error>) -> Result<(), ImuError> {
        self.select.set_low().map_err(|_| ImuError::Bus)?;
        let done = work(&mut self.bus).and_then(|()| self.bus.flush());
        self.select.set_high().map_err(|_| ImuError::Bus)?;
        done.map_err(|_| ImuError::Bus)
    }
}

impl<B: SpiBus, S: OutputPin> Gyroscope for Imu<B, S> {
    /// 2,000 degrees a second, 16 g, 1,000 readings a second.
    async fn start(&mut self) -> Result<(), ImuError> {
        self.write(DEVICE_CONFIG, 1)?;
        // After a reset it needs a millisecond.
        Timer::after_millis(2).await;
        let [name] = self.read(WHO_AM_I)?;
        if name != ICM_42688_P {
            return Err(ImuError::WrongChip(name));
        }
        self.write(GYRO_CONFIG0, RATE_1_KHZ)?;
        self.write(ACCEL_CONFIG0, RATE_1_KHZ)?;
        self.write(PWR_MGMT0, BOTH_LOW_NOISE)?;
        // No register may be written for 200 µs; the gyroscope is valid after 45 ms.
        Timer::after_millis(45).await;
        Ok(())
    }

    /// 13 bytes: at 6 MHz some 20 µs.
    fn reading(&mut self) -> Result<Reading, ImuError> {
        let raw: [u8; 12] = self.read(ACCEL_DATA)?;
        // Six numbers of a working sensor are never all equal: it measures gravity.
        if raw.iter().all(|byte| *byte == raw[0]) {
            return Err(ImuError::Silent);
        }
        let [ax, ay, az, gx, gy, gz] = numbers(raw);
        Ok(Reading {
            acceleration: [ax, ay, az].map(|raw| f32::from(raw) * G_PER_STEP),
            rate: [gx, gy, gz].map(|raw| f32::from(raw) * RAD_PER_STEP),
        })
    }
}

/// Decodes 16-bit values, high byte first.
fn numbers(raw: [u8; 12]) -> [i16; 6] {
    let mut numbers = [0; 6];
    for (number, pair) in numbers.iter_mut().zip(raw.as_chunks().0) {
        *number = i16::from_be_bytes(*pair);
    }
    numbers
}

const READ_BIT: u8 = 0x80;
const DEVICE_CONFIG: u8 = 0x11;
const ACCEL_DATA: u8 = 0x1f;
const PWR_MGMT0: u8 = 0x4e;
const GYRO_CONFIG0: u8 = 0x4f;
const ACCEL_CONFIG0: u8 = 0x50;
const WHO_AM_I: u8 = 0x75;
const ICM_42688_P: u8 = 0x47;
/// The widest range, and 1 kHz.
const RATE_1_KHZ: u8 = 0x06;
const BOTH_LOW_NOISE: u8 = 0x0f;
/// 2,048 steps a g.
const G_PER_STEP: f32 = 1.0 / 2048.0;
/// 16.4 steps for a degree a second.
const RAD_PER_STEP: f32 = core::f32::consts::PI / 180.0 / 16.4;
