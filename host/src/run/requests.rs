//! `requests`: what viewers of the page of `onetwo control` ask for: HALT, and where the operator allows it
//! parameters and tests of kickers.

use host::config::ParameterChange;
use host::robot_test::TestOrder;
use host::{Input, InputVerdict};
use page::UserRequest;

use super::EventLoop;
use crate::control::board::Board;
use feed::{change_of, description_of, description_of_test, test_of};

impl EventLoop {
    /// Sends the scene to the page, and does what viewers ask for.
    pub(super) fn show(&mut self) {
        let now = self.now();
        let Some(board) = &mut self.board else { return };
        let alarms = [self.alarms.now(), self.watch.missing()].concat();
        board.look(now, &self.host, alarms);
        self.tuning.show(&self.host, board.page());
        while let Some(request) = self.board.as_ref().and_then(Board::next_request) {
            let refused = match request {
                UserRequest::Halt {} => {
                    let description = "HALT was asked for on the page: the robots stand until the end";
                    self.description.push(description.to_owned());
                    self.feed(now, Input::Halt);
                    None
                }
                UserRequest::Parameter { key, robot, value, .. } => {
                    change_of(&key, robot, value.as_ref()).and_then(|change| self.change(change)).err()
                }
                UserRequest::Kicks { robot, kicks, .. } => self.test(test_of(robot, kicks)).err(),
                UserRequest::Save {} => self.tuning.save().map(|told| self.description.push(told)).err(),
                // Requests for a simulation are refused when they are read.
                _ => None,
            };
            if let (Some(description), Some(board)) = (refused, &self.board) {
                board.page().refuse(description);
            }
        }
    }

    /// Changes a parameter; an error says why it stays as it is.
    fn change(&mut self, change: ParameterChange) -> Result<(), String> {
        self.tuning.check(&self.host, &change)?;
        let now = self.now();
        if let InputVerdict::NotChanged(refused) =
            self.feed(now, Input::Parameter(change.to_json().as_bytes()))
        {
            return Err(refused.to_string());
        }
        self.description.push(format!("parameter  {}", description_of(&change)));
        self.tuning.keep(change);
        Ok(())
    }

    /// Begins or ends the test of a kicker; an error says why not.
    fn test(&mut self, order: TestOrder) -> Result<(), String> {
        let now = self.now();
        if let InputVerdict::NoTest(refused) = self.feed(now, Input::Test(order.to_json().as_bytes())) {
            return Err(refused.to_string());
        }
        self.description.push(format!("test       {}", description_of_test(order)));
        Ok(())
    }
}
