//! `kicks`: what a robot is ordered while its kicker is measured. Sans-IO: reports in, orders out.
//!
//! It is armed only once a ball has lain still for a while, so that nothing is charged while hands are near.

use std::time::{Duration, Instant};

use clap::Args;
use protocol::pulses::{Fired, Pulse, PulseOrder, PulseRefusal, PulseReport};

/// Which pulses.
#[derive(Debug, Args)]
pub(super) struct KickOptions {
    /// Instead of the checks, fire raw pulses of these lengths, µs, to measure the kicker.
    #[arg(long, value_name = "US,…", value_delimiter = ',', requires = "robot", value_parser = clap::value_parser!(u16).range(1..=6_000))]
    kick: Vec<u16>,
    /// Through the chip kicker's coil, not the flat one's.
    #[arg(long, requires = "kick")]
    chip: bool,
    /// Pulses of each length.
    #[arg(long, value_name = "N", requires = "kick", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=100))]
    repeat: u16,
    /// Charge and fire once a ball has lain before the kicker for so long; 0: at once, without one.
    #[arg(long, value_name = "SECONDS", requires = "kick", default_value_t = 3)]
    ball: u64,
}

/// Pulses one after the other.
#[derive(Debug)]
pub(super) struct Kicks {
    pulses: std::vec::IntoIter<Pulse>,
    /// The pulse that is next; none: all are done.
    pub(super) next: Option<Pulse>,
    ball_for: Duration,
    /// Time after which it is ordered to fire without charge, so that it says what it lacks.
    charges_for: Duration,
    ball_since: Option<Instant>,
    /// Since when it has been ordered to arm.
    armed_since: Option<Instant>,
    is_firing: bool,
    /// The robot's start and its newest report.
    newest: Option<(u32, PulseReport)>,
}

impl Kicks {
    /// `None` where no pulse is asked for.
    pub(super) fn new(options: &KickOptions, charges_for: Duration) -> Option<Self> {
        let each = options.kick.iter().flat_map(|micros| (0..options.repeat).map(|_| *micros));
        let pulses = (1..).zip(each).map(|(number, micros)| Pulse { number, chip: options.chip, micros });
        let mut pulses = pulses.collect::<Vec<_>>().into_iter();
        let (next, ball_for) = (Some(pulses.next()?), Duration::from_secs(options.ball));
        let (ball_since, armed_since, newest) = (None, None, None);
        Some(Self { pulses, next, ball_for, charges_for, ball_since, armed_since, is_firing: false, newest })
    }

    /// Takes a report of that start of the robot; what became of a pulse, if it has ended.
    pub(super) fn take(
        &mut self,
        now: Instant,
        (start, report): (u32, PulseReport),
    ) -> Option<(Pulse, Result<Fired, PulseRefusal>)> {
        self.is_firing &= self.newest.is_none_or(|(known, _)| known == start);
        self.newest = Some((start, report));
        self.ball_since = if report.ball { self.ball_since.or(Some(now)) } else { None };
        let ended = report.last.filter(|(pulse, _)| Some(*pulse) == self.next)?;
        (self.next, self.is_firing) = (self.pulses.next(), false);
        (self.ball_since, self.armed_since) = (None, None);
        Some(ended)
    }

    /// The order that is due; none, which disarms, while no ball lies there.
    pub(super) fn order(&mut self, now: Instant) -> Option<PulseOrder> {
        let ((boot_epoch, report), pulse) = (self.newest?, self.next?);
        let is_placed =
            self.ball_for.is_zero() || self.ball_since.is_some_and(|since| now - since >= self.ball_for);
        self.armed_since = if is_placed { self.armed_since.or(Some(now)) } else { None };
        let is_late = self.armed_since.is_some_and(|since| now - since >= self.charges_for);
        self.is_firing = is_placed && (self.is_firing || report.ready || is_late);
        is_placed.then_some(PulseOrder {
            boot_epoch,
            clock: report.clock,
            fire: self.is_firing.then_some(pulse),
        })
    }
}
