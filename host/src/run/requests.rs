//! `requests`: what an operator asks for while robots play: HALT, parameters, tests of kickers, drives by
//! hand.

use super::Request;
use super::event_loop::EventLoop;
use crate::config::ParameterChange;
use crate::robot_test::TestOrder;
use crate::{Input, InputVerdict};

impl EventLoop<'_> {
    /// Shows the host to the operator, and does what is asked for.
    pub(super) fn show(&mut self) {
        let now = self.now();
        self.operator.look(now, &self.host, self.alarms.now());
        while let Some(request) = self.operator.next_request() {
            let done = match request {
                Request::Halt => {
                    self.feed(now, Input::Halt);
                    Ok(Some("HALT was asked for on the page: the robots stand until the end".to_owned()))
                }
                Request::Change(change) => self.change(change).map(Some),
                Request::Test(order) => self.test(order),
                // Without a remote control no thread receives it.
                Request::Remote(request) => match self.channels.remote.send(request) {
                    Ok(()) => Ok(Some(format!("remote control  asked for on the page: {}", request.name()))),
                    Err(_) => Err("start control with --remote HOST to use its remote control".to_owned()),
                },
                Request::Save => self.tuning.save().map(Some),
            };
            match done {
                Ok(line) => self.lines.extend(line),
                Err(reason) => self.operator.refuse(reason),
            }
        }
    }

    /// Changes a parameter; a line that says so, or why it stays as it is.
    fn change(&mut self, change: ParameterChange) -> Result<String, String> {
        self.tuning.check(&self.host, &change)?;
        let now = self.now();
        if let InputVerdict::NotChanged(refused) =
            self.feed(now, Input::Parameter(change.to_json().as_bytes()))
        {
            return Err(refused.to_string());
        }
        let line = format!("parameter  {}", change_text(&change));
        self.tuning.keep(change);
        self.operator.changed();
        Ok(line)
    }

    /// Starts or ends a test or a drive; a line that says so, none for each further order of a hand, or why
    /// not.
    fn test(&mut self, order: TestOrder) -> Result<Option<String>, String> {
        let (now, driven) = (self.now(), self.host.driven());
        if let InputVerdict::NoTest(refused) = self.feed(now, Input::Test(order.to_json().as_bytes())) {
            return Err(refused.to_string());
        }
        let goes_on = driven.is_some() && driven == self.host.driven();
        Ok((!goes_on).then(|| format!("test       {}", test_text(order))))
    }
}

/// A change in words, for events and logs.
pub fn change_text(change: &ParameterChange) -> String {
    let robot = change.robot.map(|robot| format!(" of robot {robot}")).unwrap_or_default();
    match &change.value {
        Some(value) => format!("{}{robot} is now {value}, by hand", change.key),
        None => format!("{}{robot} is as if left out, by hand", change.key),
    }
}

/// A test in words, for events and logs.
pub fn test_text(order: TestOrder) -> String {
    match order {
        TestOrder::Kick { robot, kicks } => format!("the kicker of robot {robot} is tested, {kicks} kicks"),
        TestOrder::Drive { robot, .. } => format!("robot {robot} is driven by hand"),
        TestOrder::Stand => "all robots stand while the other team tests a robot".to_owned(),
        TestOrder::End => "the test of a robot has ended".to_owned(),
    }
}
