//! `external`: a strategy in another program. The host offers its view and the coach's orders as a line of
//! JSON ([`StrategyView`]); orders come back as an input and replace the coach's, robot by robot.
//!
//! ```text
//! plan ─► Host::poll_view ─► the program ─► Input::Orders ─► orders, sent at once
//! ```
//! The program around the host passes the lines on, so that a trace with them can be replayed. Where no
//! answer has come for [`ANSWERS_WITHIN`] robots stand in open play, and follow the coach in every other
//! phase, so that they keep the rules. HALT and timeouts are never asked about.

mod answer;
mod drawing;
mod form;
mod link;

use protocol::{Duration, Instant, RobotId};
use rules::{League, Phase};

pub use answer::{AnswerError, StrategyAnswer};
pub use drawing::{StrategyDrawing, StrategyShape};
pub use form::{
    Pair, StrategyBall, StrategyField, StrategyOrder, StrategyPhase, StrategyRobot, StrategyTask,
    StrategyView,
};

pub use link::{StrategyLink, StrategyStarter};

use crate::strategy::{Order, OrderReason, Orders, Role, Task, View};

/// An answer is followed for this long, s: robots of a program that has stopped stand within 0.1 s.
pub const ANSWERS_WITHIN: Duration = Duration::millis(80);

/// The host's end of it.
#[derive(Clone, Debug)]
pub(crate) struct External {
    league: League,
    /// The newest view with the coach's orders.
    newest: Option<(View, Orders)>,
    /// The line that was not polled yet.
    line: Option<String>,
    /// The newest answer, and when it came.
    answer: Option<(Instant, Vec<(RobotId, Task)>)>,
    drawing: StrategyDrawing,
    used: u64,
    refused: u64,
    error: Option<AnswerError>,
    /// Since when it is asked without an answer, and whether it ever answered.
    asked: Option<Instant>,
    answered: bool,
}

impl External {
    /// A strategy that has neither received a view nor answered.
    pub(crate) fn new(league: League) -> Self {
        Self {
            league,
            newest: None,
            line: None,
            answer: None,
            drawing: StrategyDrawing::default(),
            used: 0,
            refused: 0,
            error: None,
            asked: None,
            answered: false,
        }
    }

    /// The orders to be sent now, by the newest answer; the view is offered to the program.
    pub(crate) fn plan(&mut self, view: &View, usual: Orders) -> Orders {
        if matches!(view.phase, Phase::Halt | Phase::Timeout(_)) {
            (self.newest, self.line, self.asked) = (None, None, None);
            return usual;
        }
        // Numbers and strings: JSON can represent all of it.
        self.line = serde_json::to_string(&StrategyView::of(self.league, view, &usual)).ok();
        self.asked = self.asked.or(Some(view.now));
        let orders = self.orders(view, &usual);
        self.newest = Some((view.clone(), usual));
        orders
    }

    /// Takes an answer; the orders to be sent now, unless nothing was asked.
    pub(crate) fn answered(&mut self, now: Instant, line: &[u8]) -> Result<Option<Orders>, AnswerError> {
        (self.asked, self.answered) = (None, true);
        match StrategyAnswer::read(line) {
            Ok((tasks, drawing)) => {
                self.answer = Some((now, tasks));
                self.used += 1;
                self.drawing = drawing;
            }
            Err(error) => {
                self.refused += 1;
                self.error = Some(error.clone());
                return Err(error);
            }
        }
        let newest = self.newest.take();
        let orders = newest.as_ref().map(|(view, usual)| {
            let view = View { now, ..view.clone() };
            self.orders(&view, usual)
        });
        self.newest = newest;
        Ok(orders)
    }

    /// The line for the program.
    pub(crate) fn poll(&mut self) -> Option<String> {
        self.line.take()
    }

    /// Shapes and values of the newest answer, for the page.
    pub(crate) fn drawing(&self) -> &StrategyDrawing {
        &self.drawing
    }

    /// Number of answers that were followed.
    pub(crate) fn used(&self) -> u64 {
        self.used
    }

    /// Answers that were refused, and why the last one was.
    pub(crate) fn refused(&self) -> (u64, Option<&AnswerError>) {
        (self.refused, self.error.as_ref())
    }

    /// Since when it is asked without an answer, and whether it ever answered.
    pub(crate) fn unanswered(&self) -> Option<(Instant, bool)> {
        self.asked.map(|asked| (asked, self.answered))
    }

    fn orders(&self, view: &View, usual: &Orders) -> Orders {
        let fresh = self.answer.as_ref().filter(|(came, _)| view.now.since(*came) < ANSWERS_WITHIN);
        let tasks = fresh.map(|(_, tasks)| tasks.as_slice());
        usual.iter().map(|order| replaced(view, order, tasks)).collect()
    }
}

/// The order that replaces the coach's: of a fresh answer's tasks the robot's own; without an answer the
/// robot stands in open play.
fn replaced(view: &View, order: &Order, tasks: Option<&[(RobotId, Task)]>) -> Order {
    match tasks {
        _ if form::is_bound(order) => order.clone(),
        Some(tasks) => {
            let own = tasks.iter().find(|(robot, _)| *robot == order.robot);
            own.map_or_else(|| order.clone(), |(robot, task)| answer::order(view, *robot, *task))
        }
        None if view.phase == Phase::Run => Order {
            robot: order.robot,
            role: if order.robot == view.keeper { Role::Keeper } else { Role::Player },
            task: Task::Stand,
            why: OrderReason::ExternalSilent,
        },
        None => order.clone(),
    }
}

#[cfg(test)]
mod tests;
