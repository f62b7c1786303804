//! `smart`: a driver that controls the motors itself, on a serial line or SPI: one short frame each step, and
//! an answer. Sans-IO besides [`FrameLine`].
//!
//! | byte | order | state (the answer) |
//! |---:|---|---|
//! | 0 | 0xa5 | 0xa5 |
//! | 1 | 1 drive, 0 release | flags: bit 0 a driver has switched itself off |
//! | 2–9 | four shares of the battery's voltage, i16, 1/32767, low byte first | four counts of the wheels, u16, which wrap |
//! | 10–11 | the dribbler's share, 0 to 32767 | 0 |
//! | 12 | CRC-8 of bytes 0 to 11 (polynomial 0x07, from 0) | likewise |
//!
//! On SPI an order and the state of the step before pass each other. The driver must take the current off by
//! itself after 20 ms without a right order: a program that stops cannot send one.

use runtime::wheel::WHEELS;

use super::MotorDrivers;

/// Length of a frame, bytes.
pub const FRAME_LEN: usize = 13;

/// A line to the driver: a UART with buffers, or SPI.
pub trait FrameLine {
    /// Sends the order, and passes every byte that has come since the last call to `came`; whether the order
    /// was taken. Must not wait for an answer: the control loop has a millisecond.
    fn exchange(&mut self, order: &[u8; FRAME_LEN], came: &mut dyn FnMut(u8)) -> bool;
}

/// Report of the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriverState {
    /// A driver has switched itself off.
    pub fault: bool,
    /// Counts of the wheels, in their order on the wire; they wrap.
    pub counts: [u16; WHEELS],
}

/// The order for these shares; NaN is no current.
pub fn order(duty: [f32; WHEELS], dribbler: f32) -> [u8; FRAME_LEN] {
    let dribbler = dribbler.clamp(0.0, 1.0);
    let [a, b, c, d] = duty.map(|duty| (duty.clamp(-1.0, 1.0) * FULL_SCALE) as i16);
    frame(DRIVE, [a, b, c, d, (dribbler * FULL_SCALE) as i16])
}

/// The order to take the current off.
pub fn release() -> [u8; FRAME_LEN] {
    frame(RELEASE, [0; 5])
}

fn frame(kind: u8, numbers: [i16; 5]) -> [u8; FRAME_LEN] {
    let [a, b, c, d, e] = numbers.map(i16::to_le_bytes);
    let mut frame = [MARK, kind, a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1], e[0], e[1], 0];
    frame[FRAME_LEN - 1] = crc(&frame[..FRAME_LEN - 1]);
    frame
}

fn crc(bytes: &[u8]) -> u8 {
    let mut crc = 0;
    for byte in bytes {
        crc ^= byte;
        for _ in 0..8 {
            crc = if crc & 0x80 == 0 { crc << 1 } else { crc << 1 ^ POLYNOMIAL };
        }
    }
    crc
}

/// Finds states in what comes from the line, past noise and half frames.
#[derive(Clone, Copy, Debug, Default)]
pub struct StateReader {
    /// The newest bytes, oldest first.
    window: [u8; FRAME_LEN],
}

impl StateReader {
    /// The state that this byte completes.
    pub fn push(&mut self, byte: u8) -> Option<DriverState> {
        self.window.rotate_left(1);
        self.window[FRAME_LEN - 1] = byte;
        let [MARK, flags, a, b, c, d, e, f, g, h, 0, 0, check] = self.window else { return None };
        if crc(&self.window[..FRAME_LEN - 1]) != check {
            return None;
        }
        // Its bytes belong to no other frame.
        self.window = [0; FRAME_LEN];
        let counts = [[a, b], [c, d], [e, f], [g, h]].map(u16::from_le_bytes);
        Some(DriverState { fault: flags & 1 != 0, counts })
    }
}

/// The motors of a smart driver.
#[derive(Debug)]
pub struct Smart<L> {
    line: L,
    reader: StateReader,
    newest: Option<DriverState>,
    /// Exchanges since the newest state.
    silent: u8,
}

impl<L: FrameLine> Smart<L> {
    /// A driver without current, which counts as broken until it has answered.
    pub fn new(line: L) -> Self {
        let mut new = Self { line, reader: StateReader::default(), newest: None, silent: 0 };
        new.exchange(&release());
        new
    }

    /// Counts of the wheels by the driver, as far as it has answered.
    pub fn counts(&self) -> Option<[u16; WHEELS]> {
        self.newest.map(|state| state.counts)
    }

    fn exchange(&mut self, order: &[u8; FRAME_LEN]) {
        self.silent = self.silent.saturating_add(1);
        let Self { line, reader, newest, silent } = self;
        let taken = line.exchange(order, &mut |byte| {
            if let Some(state) = reader.push(byte) {
                (*newest, *silent) = (Some(state), 0);
            }
        });
        if !taken {
            self.silent = u8::MAX;
        }
    }
}

impl<L: FrameLine> MotorDrivers for Smart<L> {
    fn drive(&mut self, duty: [f32; WHEELS], dribbler: f32) {
        self.exchange(&order(duty, dribbler));
    }

    fn release(&mut self) {
        self.exchange(&release());
    }

    fn has_fault(&mut self) -> bool {
        self.newest.is_none_or(|state| state.fault) || self.silent > SILENT_STEPS_MAX
    }
}

const MARK: u8 = 0xa5;
const DRIVE: u8 = 1;
const RELEASE: u8 = 0;
/// A share of 1.
const FULL_SCALE: f32 = 32_767.0;
/// x⁸ + x² + x + 1, as of SMBus.
const POLYNOMIAL: u8 = 0x07;
/// Steps of a millisecond without a state after which the driver counts as broken, as long as it drives by
/// itself.
const SILENT_STEPS_MAX: u8 = 20;

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// A driver at the other end: records each order, and answers with `answer`.
    #[derive(Default)]
    struct Driver {
        orders: Vec<[u8; FRAME_LEN]>,
        answer: Vec<u8>,
        refuses: bool,
    }

    impl FrameLine for &mut Driver {
        fn exchange(&mut self, order: &[u8; FRAME_LEN], came: &mut dyn FnMut(u8)) -> bool {
            self.orders.push(*order);
            self.answer.clone().into_iter().for_each(came);
            !self.refuses
        }
    }

    fn state(flags: u8, counts: [i16; 4]) -> [u8; FRAME_LEN] {
        frame(flags, [counts[0], counts[1], counts[2], counts[3], 0])
    }

    #[test]
    fn a_frame_is_as_the_table_says() {
        let order = order([1.0, -1.0, 0.5, f32::NAN], 2.0);
        let hand = [0xa5, 1, 0xff, 0x7f, 0x01, 0x80, 0xff, 0x3f, 0, 0, 0xff, 0x7f];
        assert_eq!(order[..12], hand);
        // The check value of this CRC.
        assert_eq!(crc(b"123456789"), 0xf4);
        assert_eq!(order[12], crc(&hand));
        assert_eq!(release()[..2], [0xa5, 0]);
    }

    #[test]
    fn a_state_is_found_past_noise_and_a_damaged_one_is_none() {
        let whole = state(0, [1, -1, 300, 0]);
        for noise in [&[][..], &[0xa5], &[0xa5, 0, 7], &whole[..7]] {
            let mut reader = StateReader::default();
            let found: Vec<_> = noise.iter().chain(&whole).filter_map(|byte| reader.push(*byte)).collect();
            assert_eq!(found, [DriverState { fault: false, counts: [1, u16::MAX, 300, 0] }], "{noise:?}");
        }
        for n in 0..FRAME_LEN * 8 {
            let (mut damaged, mut reader) = (whole, StateReader::default());
            damaged[n / 8] ^= 1 << (n % 8);
            assert!(damaged.iter().all(|byte| reader.push(*byte).is_none()), "bit {n}");
        }
    }

    #[test]
    fn a_driver_is_broken_until_it_answers_when_it_reports_it_and_when_silent() {
        let mut driver = Driver::default();
        let mut smart = Smart::new(&mut driver);
        assert!(smart.has_fault() && smart.counts().is_none());
        smart.line.answer = state(0, [5, 6, 7, 8]).to_vec();
        smart.drive([0.1; WHEELS], 0.0);
        assert!(!smart.has_fault());
        assert_eq!(smart.counts(), Some([5, 6, 7, 8]));
        smart.line.answer = state(1, [5, 6, 7, 8]).to_vec();
        smart.release();
        assert!(smart.has_fault());
        smart.line.answer = state(0, [5, 6, 7, 9]).to_vec();
        smart.release();
        assert!(!smart.has_fault());
        smart.line.answer.clear();
        for n in 0..=SILENT_STEPS_MAX {
            assert!(!smart.has_fault(), "{n}");
            smart.release();
        }
        assert!(smart.has_fault());
        smart.line.answer = state(0, [5, 6, 7, 9]).to_vec();
        smart.line.refuses = true;
        smart.release();
        assert!(smart.has_fault(), "an order that was not taken");
        assert_eq!(driver.orders.first(), Some(&release()));
        assert_eq!(driver.orders.len(), 26);
    }
}
