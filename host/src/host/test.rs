//! `test`: a test of a robot's kicker, as the operator begins and ends it.

use super::{Host, InputVerdict};
use crate::robot_test::{KickReport, RobotTest, TestOrder, TestRefused};

impl Host {
    /// What the test of a kicker has found, while there is one.
    pub fn kick_test(&self) -> Option<KickReport> {
        self.test.as_ref()?.report()
    }

    /// Handles the JSON of a [`TestOrder`].
    pub(super) fn handle_test(&mut self, json: &[u8]) -> InputVerdict {
        match TestOrder::from_json(json) {
            Ok(TestOrder::Kick { .. }) if self.external.is_some() => {
                InputVerdict::NoTest(TestRefused::External)
            }
            Ok(order) => {
                self.test = RobotTest::of(order);
                InputVerdict::Test
            }
            Err(refused) => InputVerdict::NoTest(refused),
        }
    }
}
