//! `robot_log`: the log of a robot without a debug probe, for its host: what the log's ring still has, piece
//! by piece from the oldest byte to the newest, then again. A lost packet only delays, and a host that starts
//! late gets the last of it. Sans-IO; it only reads the ring, so that a probe may read it at the same time.

use protocol::Instant;
use protocol::robot_log::{KEPT_MAX, LogReport};

use super::REPORT_EVERY;

/// The ring into which a board logs.
pub trait LogRing {
    /// Hands over the ring and the place of the next byte; nothing is logged meanwhile.
    fn look<T>(&self, read: impl FnOnce(&[u8], usize) -> T) -> T;
}

/// What of a log was sent.
#[derive(Debug)]
pub struct RobotLog<R> {
    ring: R,
    /// Place of the next byte at the last look.
    end: usize,
    /// Number of bytes since the start.
    written: u32,
    /// The byte with which the next piece begins.
    next: u32,
    sent: Option<Instant>,
}

impl<R: LogRing> RobotLog<R> {
    /// A log of which nothing was sent.
    pub const fn new(ring: R) -> Self {
        Self { ring, end: 0, written: 0, next: 0, sent: None }
    }

    /// The next piece for the host of that epoch; none without a host (0), within [`REPORT_EVERY`] of the
    /// last one, or before the first byte. To be called, with a host or without, before the ring can fill:
    /// bytes are counted by their places in it.
    pub fn report(&mut self, now: Instant, host: u32) -> Option<LogReport> {
        let Self { ring, end: seen, written, next, sent } = self;
        let is_due = host != 0 && sent.is_none_or(|sent| now.since(sent) >= REPORT_EVERY);
        let bytes = ring.look(|ring, end| {
            let (newest, oldest) = ring.split_at_checked(end)?;
            let since = if end < *seen { end + ring.len() - *seen } else { end - *seen };
            (*seen, *written) = (end, written.wrapping_add(since as u32));
            let kept = written.saturating_sub(KEPT_MAX.min(ring.len() as u32));
            if !is_due || *written == 0 {
                return None;
            }
            if !(kept..*written).contains(next) {
                *next = kept;
            }
            let sent = ring.len().saturating_sub(written.wrapping_sub(*next) as usize);
            let rest = oldest.iter().chain(newest).skip(sent);
            let mut bytes = heapless::Vec::new();
            // Ends with the ring's last byte or with the piece's.
            rest.copied().take_while(|byte| bytes.push(*byte).is_ok()).for_each(drop);
            Some(bytes)
        })?;
        let at = *next;
        (*next, *sent) = (at.wrapping_add(bytes.len() as u32), Some(now));
        Some(LogReport { host, at, rest: written.wrapping_sub(*next) as u16, bytes })
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::vec::Vec;

    use protocol::robot_log::PIECE_LEN_MAX;

    use super::*;

    /// A ring of 100 bytes, each the lower half of its number.
    #[derive(Debug)]
    struct Ring(RefCell<(Vec<u8>, usize)>);

    impl LogRing for &Ring {
        fn look<T>(&self, read: impl FnOnce(&[u8], usize) -> T) -> T {
            let (bytes, written) = &*self.0.borrow();
            read(bytes, written % bytes.len())
        }
    }

    impl Ring {
        fn new() -> Self {
            Self(RefCell::new((std::vec![0xee; 100], 0)))
        }

        fn log(&self, count: usize) {
            let (bytes, written) = &mut *self.0.borrow_mut();
            for _ in 0..count {
                let place = *written % bytes.len();
                bytes[place] = *written as u8;
                *written += 1;
            }
        }
    }

    /// Number of the first byte and length of each of the next pieces.
    fn pieces(log: &mut RobotLog<&Ring>, from_ms: u64, count: u64) -> Vec<(u32, usize)> {
        let piece = |n| {
            let report = log.report(Instant(1_000 * (from_ms + 20 * n)), 5).unwrap();
            let mut numbers = report.at..;
            assert!(report.bytes.iter().all(|byte| Some(*byte) == numbers.next().map(|n| n as u8)));
            assert_eq!(numbers.start as usize + usize::from(report.rest), log.ring.0.borrow().1);
            (report.at, report.bytes.len())
        };
        (0..count).map(piece).collect()
    }

    #[test]
    fn the_log_is_sent_in_order_with_what_comes_meanwhile_then_again() {
        let ring = Ring::new();
        let mut log = RobotLog::new(&ring);
        assert_eq!(log.report(Instant(0), 5), None, "nothing is logged");
        ring.log(40);
        assert_eq!(pieces(&mut log, 20, 3), [(0, 32), (32, 8), (0, 32)]);
        ring.log(30);
        assert_eq!(pieces(&mut log, 80, 3), [(32, 32), (64, 6), (0, 32)]);
        // 130 bytes, of which the ring has 100: the piece under way begins with the oldest.
        ring.log(60);
        assert_eq!(pieces(&mut log, 140, 5), [(32, 32), (64, 32), (96, 32), (128, 2), (30, 32)]);
    }

    #[test]
    fn bytes_that_were_overwritten_unsent_leave_a_gap_in_the_numbers() {
        let ring = Ring::new();
        let mut log = RobotLog::new(&ring);
        ring.log(50);
        assert_eq!(pieces(&mut log, 0, 1), [(0, 32)]);
        ring.log(99);
        assert_eq!(pieces(&mut log, 20, 1), [(49, 32)]);
        // A ring that fills between two pieces, time and again.
        for n in 0..200 {
            ring.log(99);
            assert_eq!(pieces(&mut log, 40 + 20 * n, 1), [(148 + 99 * n as u32, PIECE_LEN_MAX)]);
        }
    }

    #[test]
    fn without_a_host_or_too_soon_nothing_is_sent_but_bytes_are_counted() {
        let ring = Ring::new();
        let mut log = RobotLog::new(&ring);
        for ms in 0..10 {
            ring.log(70);
            assert_eq!(log.report(Instant(1_000 * ms), 0), None);
        }
        assert_eq!(pieces(&mut log, 10, 1), [(600, 32)]);
        for ms in 11..30 {
            ring.log(5);
            assert_eq!(log.report(Instant(1_000 * ms), 5), None);
        }
        assert_eq!(pieces(&mut log, 30, 1), [(695, 32)]);
    }
}
