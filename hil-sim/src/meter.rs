//! `meter`: measurement of the robots' computers. A back end that wraps another and keeps each step's
//! instruction count and the maximum stack use (docs/architecture.md §9), and one that gives a team another
//! back end than the others.

use std::cell::RefCell;
use std::rc::Rc;

use brain::BrainConfig;
use protocol::TeamId;
use protocol::lockstep::TickIn;

use crate::mcu::{Backend, Mcu, McuError, Reply};

/// Measurements of all computers of a back end; zeros where they cannot be measured.
#[derive(Clone, Debug, Default)]
pub struct Meter(Rc<RefCell<Taken>>);

#[derive(Debug, Default)]
struct Taken {
    steps: Vec<u32>,
    stack: u32,
}

impl Meter {
    /// Number of steps that were measured.
    pub fn steps(&self) -> usize {
        self.0.borrow().steps.len()
    }

    /// The median and the worst step, instructions.
    pub fn median_and_worst(&self) -> (u32, u32) {
        let mut taken = self.0.borrow_mut();
        taken.steps.sort_unstable();
        let at = |index: usize| taken.steps.get(index).copied().unwrap_or(0);
        (at(taken.steps.len() / 2), at(taken.steps.len().saturating_sub(1)))
    }

    /// Maximum stack use, bytes.
    pub fn stack(&self) -> u32 {
        self.0.borrow().stack
    }

    /// Adds a step's instruction count and stack use.
    pub fn note(&self, reply: &Reply) {
        let mut taken = self.0.borrow_mut();
        taken.steps.push(reply.instructions);
        taken.stack = taken.stack.max(reply.stack);
    }
}

/// A back end with a meter.
#[derive(Debug)]
pub struct Metered<B> {
    backend: B,
    meter: Meter,
}

impl<B> Metered<B> {
    /// Wraps `backend`; its computers' measurements are added to `meter`.
    pub fn new(backend: B, meter: &Meter) -> Self {
        Self { backend, meter: meter.clone() }
    }
}

impl<'a, B: Backend<'a>> Backend<'a> for Metered<B> {
    fn name(&self) -> &'static str {
        self.backend.name()
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        Ok(Box::new(MeteredMcu { mcu: self.backend.boot(config)?, meter: self.meter.clone() }))
    }
}

struct MeteredMcu<'a> {
    mcu: Box<dyn Mcu + 'a>,
    meter: Meter,
}

impl Mcu for MeteredMcu<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.mcu.post(tick)
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let reply = self.mcu.collect()?;
        self.meter.note(&reply);
        Ok(reply)
    }
}

/// One back end for one team's computers, another for all others.
#[derive(Debug)]
pub struct ByTeam<A, B> {
    /// The team with a back end of its own.
    pub team: TeamId,
    /// Back end of that team's computers.
    pub its: A,
    /// Back end of all other computers.
    pub others: B,
}

impl<'a, A: Backend<'a>, B: Backend<'a>> Backend<'a> for ByTeam<A, B> {
    fn name(&self) -> &'static str {
        "mixed"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        if config.team == self.team { self.its.boot(config) } else { self.others.boot(config) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn took(instructions: u32, stack: u32) -> Reply {
        Reply { instructions, stack, ..Reply::default() }
    }

    #[test]
    fn a_meter_gives_median_and_worst_instructions_and_the_deepest_stack() {
        let meter = Meter::default();
        assert_eq!((meter.median_and_worst(), meter.stack()), ((0, 0), 0));
        let same = meter.clone();
        for reply in [took(7, 100), took(900, 400), took(8, 300)] {
            same.note(&reply);
        }
        assert_eq!((meter.steps(), meter.median_and_worst(), meter.stack()), (3, (8, 900), 400));
    }
}
