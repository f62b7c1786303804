//! `test`: one robot for itself, as the operator begins and ends it: a test of its kicker, or a drive by
//! hand.

use protocol::{Instant, RobotId};

use super::{Host, InputVerdict};
use crate::robot_test::{KickReport, RobotTest, TestOrder, TestRefused};

impl Host {
    /// What the test of a kicker has found, while there is one.
    pub fn kick_test(&self) -> Option<KickReport> {
        self.test.as_ref()?.report()
    }

    /// The robot that is driven by hand, until that is ended.
    pub fn driven(&self) -> Option<RobotId> {
        self.test.as_ref()?.driven()
    }

    /// Handles the JSON of a [`TestOrder`].
    pub(super) fn handle_test(&mut self, now: Instant, json: &[u8]) -> InputVerdict {
        match TestOrder::from_json(json) {
            Ok(TestOrder::Kick { .. } | TestOrder::Drive { .. }) if self.external.is_some() => {
                InputVerdict::NoTest(TestRefused::External)
            }
            Ok(order) => {
                let drove = self.test.as_ref().is_some_and(|test| test.until().is_some());
                self.test = RobotTest::of(order, now);
                if drove && self.test.as_ref().is_none_or(|test| test.until().is_none()) {
                    self.stop_hand(now);
                }
                InputVerdict::Test
            }
            Err(refused) => InputVerdict::NoTest(refused),
        }
    }

    /// Stops a driven robot whose hand has gone silent.
    pub(super) fn expire_hand(&mut self, now: Instant) {
        if self.test.as_mut().is_some_and(|test| test.expire(now)) {
            self.stop_hand(now);
        }
    }

    /// The stop waits neither for the next camera frame nor for the radio's rate.
    fn stop_hand(&mut self, now: Instant) {
        self.radio.hasten(now);
        self.plan(now);
    }
}
