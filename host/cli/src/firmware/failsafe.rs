//! `failsafe`: fail-safe table of a wheeled robot: reaction to each fault, and its time. The brain's
//! governor, evaluated every millisecond (docs/architecture.md §6.2); wheels that follow without delay.

use std::fmt::Write as _;

use brain::governor::{Circumstances, Governor, Hearing, Ruling, Wanted};
use geometry::{Twist, Vector};
use protocol::Instant;
use protocol::robot_io::{Health, OmniKick};
use rules::{League, Phase, Side};

geometry::labels! {
    /// Faults that are tested: a robot drives with 3 m/s, then one fault lasts for three seconds.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Cause {
        Silence = "no authentic frame of the host",
        NoCommand = "the host speaks, but not to this robot",
        Halt = "HALT, or a time-out",
        Lost = "no source reports its position",
        Tipped = "it lies on its side",
        Spinning = "it turns faster than 30 rad/s",
        Battery = "the battery is below 14 V",
        WantsNaN = "the brain outputs NaN",
        MeasuresNaN = "the encoders report NaN",
    }
}

/// The effect of a cause, ms after it started.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// The speed is limited.
    pub(super) slow: Option<u64>,
    /// Brakes: dribbler off, kicker discharged.
    pub(super) brakes: Option<u64>,
    /// Standstill.
    pub(super) stands: Option<u64>,
    /// The motors have no current.
    pub(super) released: Option<u64>,
    /// Movement is allowed again: ms after the cause has ended.
    pub(super) again: Option<u64>,
}

/// Before the table, in docs/firmware.md.
pub(super) const HEAD: &str = "
## What a robot on wheels does when something breaks

It drives with 3 m/s under a host that speaks every 10 ms; then one thing is wrong for 3 s. Times are counted from that moment, in
steps of 1 ms (a brain's steps take 10 ms), of the brain's governor over wheels that obey at once. The kicker may be charged again when
the robot moves again.

";
/// After the table.
pub(super) const BELOW: &str = "
Below the brain, without its governor, each with its tests:

| what is wrong | what happens | after | held by |
|---|---|---|---|
| the brain orders nothing any more | the control loop brakes wheels, dribbler off, kicker discharged | 50 ms | `runtime::wheel`, `runtime::hardware` |
| the control loop says nothing any more | the kicker is discharged | 10 ms | `runtime::hardware` |
| a panic or a hard fault, in the brain or elsewhere | motors without current, place kept and told, a new life with an epoch of its own | at once | `qemu_free` |
| control, radio or brain hangs | the watchdog's first time-out takes the current off, its second resets | 100 ms, 200 ms | `qemu_free` |
| no page with a key, or a damaged one | it never drives and says nothing on the air | – | `qemu_free` |
";

pub(super) fn table() -> String {
    let mut text = String::from(
        "| what is wrong | slower after | brakes, dribbler off, kicker discharged after | stands after | motors released after | moves again, once it is right |\n\
         |---|---:|---:|---:|---:|---:|\n",
    );
    let ms = |time: Option<u64>| time.map_or_else(|| "–".to_owned(), |ms| format!("{ms} ms"));
    for cause in Cause::ALL {
        let Outcome { slow, brakes, stands, released, again } = outcome(cause);
        let row = [slow, brakes, stands, released, again].map(ms).join(" | ");
        let _ = writeln!(text, "| {} | {row} |", cause.label());
    }
    text
}

fn outcome(cause: Cause) -> Outcome {
    let mut governor = Governor::new(League::DivisionB);
    let go = Wanted {
        twist: Twist { linear: Vector::new(3.0, 0.0), angular: 0.0 },
        dribbler: 1.0,
        kick: OmniKick::None,
    };
    let mut found = Outcome::default();
    // Frames come every 10 ms; the last good one before the cause starts is 0 ms old.
    let (mut frame, mut command) = (None, None);
    for ms in 0..CAUSE_AT_MS + CAUSE_LASTS_MS + 2_000 {
        let now = Instant(ms * 1_000);
        let wrong = (CAUSE_AT_MS + 1..=CAUSE_AT_MS + CAUSE_LASTS_MS).contains(&ms);
        if ms % 10 == 0 && !(wrong && cause == Cause::Silence) {
            governor.receive_host(now);
            frame = Some(now);
            command = if wrong && cause == Cause::NoCommand { command } else { Some(now) };
        }
        let is = |one: Cause| wrong && cause == one;
        let health = Health {
            battery: Some(if is(Cause::Battery) { 13.0 } else { 16.0 }),
            tipped: is(Cause::Tipped),
            kicker_ready: true,
        };
        let moved = governor.last();
        let odometry = if is(Cause::MeasuresNaN) {
            Twist { linear: Vector::new(f32::NAN, 0.0), ..moved }
        } else if is(Cause::Spinning) {
            Twist { angular: 31.0, ..moved }
        } else {
            moved
        };
        let phase = if is(Cause::Halt) { Phase::Halt } else { Phase::<Side>::Run };
        let circumstances = Circumstances {
            now,
            host: Some(Hearing { frame, command }),
            phase: Some(phase),
            placed: !is(Cause::Lost),
            health: &health,
            odometry,
        };
        let mut wanted = go;
        if is(Cause::WantsNaN) {
            wanted.twist.angular = f32::NAN;
        }
        let (given, ruling) = governor.rule(&circumstances, &wanted);
        let since = ms.saturating_sub(CAUSE_AT_MS);
        if wrong {
            let first = |place: &mut Option<u64>, holds: bool| {
                if holds {
                    place.get_or_insert(since);
                }
            };
            first(&mut found.slow, matches!(ruling, Ruling::Limited(_)));
            let safe = given.kick == OmniKick::Discharge && given.dribbler == 0.0;
            first(&mut found.brakes, safe && matches!(ruling, Ruling::Braking(_)));
            first(&mut found.stands, given.twist == Twist::default());
            first(&mut found.released, governor.has_let_go());
        } else if since > CAUSE_LASTS_MS && ruling == Ruling::Allowed {
            found.again.get_or_insert(since - CAUSE_LASTS_MS);
        }
    }
    found
}

/// When the cause starts, ms: the robot is armed and drives.
const CAUSE_AT_MS: u64 = 1_000;
/// Duration of the cause, ms: longer than a robot needs to stand and to release its motors.
const CAUSE_LASTS_MS: u64 = 3_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_silent_host_slows_after_50_ms_brakes_after_100_and_arms_after_half_a_second() {
        let found = outcome(Cause::Silence);
        // 3 m/s is more than the limit, 4 m/s at 50 ms and 0 at 100 ms, from 62.5 ms on.
        assert_eq!((found.slow, found.brakes), (Some(63), Some(100)));
        // From 62.5 ms on with 5 m/s² 3 m/s take 600 ms.
        assert!(found.stands.is_some_and(|ms| (660..=668).contains(&ms)), "{found:?}");
        assert_eq!(found.released, found.stands.map(|ms| ms + 500));
        // The first frame comes within 10 ms.
        assert!(found.again.is_some_and(|ms| (500..=511).contains(&ms)), "{found:?}");
    }

    /// Checks for every cause: it brakes within `patience` ms, stands, and moves again once the cause is
    /// over.
    fn ends_well(cause: Cause, patience: u64) -> Outcome {
        let found = outcome(cause);
        assert!(found.brakes.is_some_and(|ms| ms <= patience), "{cause:?}: {found:?}");
        // 3 m/s take 600 ms at 5 m/s².
        let stands = found.stands.is_some_and(|ms| ms <= patience + 610);
        assert!(stands, "{cause:?}: {found:?}");
        found
    }

    #[test]
    fn a_forgotten_robot_brakes_after_100_ms_and_moves_with_the_next_command() {
        let found = ends_well(Cause::NoCommand, 100);
        // Motors hold: the host commands the team.
        assert_eq!((found.brakes, found.released), (Some(100), None));
        assert!(found.again.is_some_and(|ms| ms <= 10), "{found:?}");
    }

    #[test]
    fn halt_brakes_at_once_and_holds_the_place() {
        let found = ends_well(Cause::Halt, 1);
        assert_eq!((found.released, found.again), (None, Some(1)));
    }

    #[test]
    fn a_robot_that_no_one_sees_brakes_at_once_and_goes_on_when_it_is_seen() {
        let found = ends_well(Cause::Lost, 1);
        assert_eq!((found.released, found.again), (None, Some(1)));
    }

    #[test]
    fn a_tipped_robot_brakes_at_once_and_lets_its_motors_go_when_they_stand() {
        let found = ends_well(Cause::Tipped, 1);
        assert_eq!(found.released, found.stands.map(|ms| ms + 500));
        assert_eq!(found.again, Some(1));
    }

    #[test]
    fn a_robot_that_spins_brakes_at_once() {
        let found = ends_well(Cause::Spinning, 1);
        assert_eq!((found.released, found.again), (None, Some(1)));
    }

    #[test]
    fn an_empty_battery_is_given_a_second_then_the_robot_brakes_and_lets_go() {
        // Voltage drops for a moment when the motors draw current.
        let found = ends_well(Cause::Battery, 1_001);
        assert_eq!(found.brakes, Some(1_001));
        assert_eq!(found.released, found.stands.map(|ms| ms + 500));
    }

    #[test]
    fn a_number_that_is_none_wanted_or_measured_brakes_at_once_and_ends_with_it() {
        for cause in [Cause::WantsNaN, Cause::MeasuresNaN] {
            let found = ends_well(cause, 1);
            assert_eq!((found.released, found.again), (None, Some(1)), "{cause:?}");
        }
    }

    #[test]
    fn the_table_has_a_row_for_every_cause() {
        let rows = table().lines().count();
        assert_eq!(rows, Cause::ALL.len() + 2);
    }
}
