//! `latency`: delay of orders from a robot's computer to its wheels: each takes effect some ms later, in the
//! given order.

use std::collections::VecDeque;

use protocol::Who;
use serde::{Deserialize, Serialize};

use super::LinkModel;
use crate::rng::Stream;
use crate::small_size::{Order, SLOTS};

#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::small_size) struct Latency {
    steps: u64,
    jitter: u32,
    chance: Stream,
    /// By the step they are due in; those of one robot in the order they were given.
    coming: VecDeque<(u64, Who, Order)>,
    /// The step in which each slot's last order is due.
    last: [u64; SLOTS],
}

impl Latency {
    pub(in crate::small_size) fn new(link: &LinkModel, seed: u64) -> Self {
        Self {
            steps: u64::from(link.latency_ms),
            jitter: link.jitter_ms,
            chance: Stream::new(seed, "command latency"),
            coming: VecDeque::new(),
            last: [0; SLOTS],
        }
    }

    /// Orders take effect in the step after they were given.
    pub(in crate::small_size) fn is_none(&self) -> bool {
        self.steps == 0 && self.jitter == 0
    }

    /// Delays an order given after step `now`.
    pub(in crate::small_size) fn send(&mut self, now: u64, who: Who, order: Order) {
        let drawn = now + self.steps + u64::from(self.chance.whole(0, self.jitter));
        let due = drawn.max(self.last[who.slot()]);
        self.last[who.slot()] = due;
        let place = self.coming.partition_point(|(other, ..)| *other <= due);
        self.coming.insert(place, (due, who, order));
    }

    /// The next order that is due by the end of step `now`.
    pub(in crate::small_size) fn arrived(&mut self, now: u64) -> Option<(Who, Order)> {
        let due = self.coming.front().is_some_and(|(due, ..)| *due <= now);
        due.then(|| self.coming.pop_front())?.map(|(_, who, order)| (who, order))
    }
}
