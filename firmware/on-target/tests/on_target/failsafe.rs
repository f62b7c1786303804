//! `failsafe`: tests: the governor stops a robot on this processor, to the millisecond of the PC's tests
//! (docs/architecture.md §6.2).

#[embedded_test::tests]
mod tests {
    use brain::governor::{Circumstances, Governor, Hearing, Ruling, Wanted};
    use geometry::{Twist, Vector};
    use protocol::Instant;
    use protocol::robot_io::{Health, OmniKick};
    use rules::{League, Phase};

    /// Steps a governor of a robot that drives with 3 m/s, every millisecond up to `until`.
    struct Drive {
        governor: Governor,
        received: Option<Instant>,
        last: (Wanted, Ruling),
    }

    impl Drive {
        fn new() -> Self {
            let mut drive = Self {
                governor: Governor::new(League::DivisionB),
                received: None,
                last: (Wanted::STAND, Ruling::Allowed),
            };
            for ms in 0..=1_000 {
                drive.step(ms, true, WELL, 3.0);
            }
            assert_eq!(drive.last.1, Ruling::Allowed, "armed after half a second");
            drive
        }

        fn step(&mut self, ms: u64, host: bool, health: Health, wanted: f32) {
            let now = Instant(1_000 * ms);
            if host && ms.is_multiple_of(10) {
                self.governor.receive_host(now);
                self.received = Some(now);
            }
            let circumstances = Circumstances {
                now,
                host: Some(Hearing { frame: self.received, command: self.received }),
                phase: Some(Phase::Run),
                placed: true,
                health: &health,
                odometry: self.governor.last(),
            };
            let go = Wanted {
                twist: Twist { linear: Vector::new(wanted, 0.0), angular: 0.0 },
                dribbler: 1.0,
                kick: OmniKick::None,
            };
            self.last = self.governor.rule(&circumstances, &go);
        }

        fn brakes(&self) -> bool {
            matches!(self.last.1, Ruling::Braking(_))
        }
    }

    const WELL: Health = Health { battery: Some(16.0), tipped: false, kicker_ready: true };

    #[test]
    fn silence_slows_brakes_discharges_and_half_a_second_of_good_link_arms_again() {
        let mut drive = Drive::new();
        for ms in 1_001..1_100 {
            drive.step(ms, false, WELL, 3.0);
            assert!(!drive.brakes(), "{ms}");
            // The limit, 4 m/s at 50 ms and 0 at 100, passes 3 m/s after 62.5 ms.
            assert_eq!(matches!(drive.last.1, Ruling::Limited(_)), ms >= 1_063, "{ms}");
        }
        drive.step(1_100, false, WELL, 3.0);
        assert!(drive.brakes());
        assert_eq!((drive.last.0.kick, drive.last.0.dribbler), (OmniKick::Discharge, 0.0));
        let again = (1_101..3_000).find(|ms| {
            drive.step(*ms, *ms >= 2_000, WELL, 3.0);
            !drive.brakes()
        });
        assert_eq!(again, Some(2_500));
    }

    #[test]
    fn tipping_and_nan_brake_at_once_and_an_empty_battery_after_1_s() {
        for (health, wanted, after) in [
            (Health { tipped: true, ..WELL }, 3.0, 1_001),
            (WELL, f32::NAN, 1_001),
            (Health { battery: Some(13.0), ..WELL }, 3.0, 2_001),
        ] {
            let mut drive = Drive::new();
            let braked = (1_001..2_100).find(|ms| {
                drive.step(*ms, true, health, wanted);
                drive.brakes()
            });
            assert_eq!(braked, Some(after), "{health:?}");
        }
    }

    /// That a failed test is reported as failed.
    #[test]
    #[should_panic]
    fn a_panic_ends_the_test() {
        assert_eq!(Drive::new().last.1, Ruling::Limited(brain::governor::Reasons::default()));
    }
}
