//! `air`: what chips do on the air (PS 6.1, 7.4, 7.5) and which packets arrive: time, collisions, loss from a
//! seed. Times in ns.

use std::cell::RefCell;
use std::rc::Rc;

use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use crate::chip::{FIFO, MAX_RT, Mode, RX_DR, Registers, TX_DS};
use crate::{Chip, FRAMING_BITS, SETTLING};

/// What the air does to packets. Probabilities, each drawn for every receiver by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// A packet does not arrive.
    pub loss: f32,
    /// A packet arrives with one bit of its payload turned, and the check sum fits all the same.
    pub damage: f32,
    /// A packet arrives once more 0.3 to 20 ms later, under another identity, so that the chip takes it for
    /// new: a recording, played back.
    pub copies: f32,
}

/// What was on the air so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AirCounts {
    /// Packets, acknowledgements and repeats included.
    pub packets: u64,
    /// Packets that met another one on their channel.
    pub collided: u64,
    /// Time for which packets were on the air, ns; those at once counted each.
    pub busy: u64,
    /// The same and the time for which chips settled before them.
    pub occupied: u64,
}

/// The air: all chips of a test and their time.
#[derive(Clone, Debug)]
pub struct Air(Rc<RefCell<Medium>>);

impl Air {
    /// Air without a chip, at time 0.
    pub fn new(faults: Faults, seed: u64) -> Self {
        Self(Rc::new(RefCell::new(Medium {
            now: 0,
            chips: Vec::new(),
            flights: Vec::new(),
            copies: Vec::new(),
            carriers: Vec::new(),
            faults,
            dice: Xoshiro128PlusPlus::seed_from_u64(seed),
            counts: AirCounts::default(),
        })))
    }

    /// One more chip, as after power on.
    pub fn chip(&self) -> Chip {
        let mut medium = self.0.borrow_mut();
        medium.chips.push(Registers::new());
        Chip { medium: self.0.clone(), index: medium.chips.len() - 1 }
    }

    /// Time since the start, ns.
    pub fn now(&self) -> u64 {
        self.0.borrow().now
    }

    /// Lets everything happen up to `until`, ns.
    pub fn advance(&self, until: u64) {
        self.0.borrow_mut().advance(until);
    }

    /// A carrier of something else on that channel, on for this share of the time.
    pub fn carrier(&self, channel: u8, share: f32) {
        self.0.borrow_mut().carriers.push((channel, share));
    }

    /// What was on the air so far.
    pub fn counts(&self) -> AirCounts {
        self.0.borrow().counts
    }
}

#[derive(Debug)]
pub(crate) struct Medium {
    now: u64,
    pub(crate) chips: Vec<Registers>,
    flights: Vec<Flight>,
    /// Copies that come at that time, to that chip.
    copies: Vec<(u64, usize, Flight)>,
    /// Channels with a carrier, and its share of the time.
    carriers: Vec<(u8, f32)>,
    faults: Faults,
    dice: Xoshiro128PlusPlus,
    counts: AirCounts,
}

/// A packet on the air.
#[derive(Clone, Debug)]
struct Flight {
    from: usize,
    start: u64,
    end: u64,
    channel: u8,
    bit_time: u64,
    address: [u8; 5],
    identity: u8,
    no_ack: bool,
    is_ack: bool,
    payload: Vec<u8>,
    collided: bool,
}

impl Medium {
    /// A chip's supply goes or comes: its packet on the air breaks off, and it has forgotten everything.
    pub(crate) fn power(&mut self, index: usize, on: bool) {
        self.flights.retain(|flight| flight.from != index);
        let chip = &mut self.chips[index];
        let (enabled, spent) = (chip.enabled, chip.spent);
        *chip = Registers::new();
        (chip.enabled, chip.spent, chip.has_supply) = (enabled, spent, on);
    }

    /// Sets whether a chip that listens notices power, which takes it 40 us (PS 6.4).
    pub(crate) fn sense(&mut self, index: usize) {
        let chip = &self.chips[index];
        let Mode::Listening { since } = chip.mode else { return };
        if self.now < since + 40_000 {
            return;
        }
        let channel = chip.channel();
        let share = self.carriers.iter().find(|(of, _)| *of == channel).map_or(0.0, |(_, share)| *share);
        let is_busy = self.flights.iter().any(|flight| flight.channel == channel);
        let is_there = is_busy || self.happens(share);
        self.chips[index].set_power(is_there);
    }

    /// Looks at a chip whose registers or lines changed.
    pub(crate) fn wake(&mut self, index: usize) {
        let now = self.now;
        let chip = &mut self.chips[index];
        if !chip.is_up() {
            // A packet under way is finished (PS 6.1.6); a receiver stops at once.
            if matches!(chip.mode, Mode::Listening { .. } | Mode::Settling { .. } | Mode::Turning { .. }) {
                chip.mode = Mode::Idle;
            }
            return;
        }
        if chip.mode != Mode::Idle {
            return;
        }
        if chip.is_receiver() {
            chip.mode = Mode::Listening { since: now + SETTLING };
        } else if !chip.has(MAX_RT) && chip.to_send.front().is_some_and(|first| first.pipe.is_none()) {
            chip.packet = (chip.packet + 1) & 3;
            chip.repeats = 0;
            chip.mode = Mode::Settling { until: now + SETTLING };
        }
    }

    fn advance(&mut self, until: u64) {
        loop {
            let own = self.chips.iter().enumerate().filter_map(|(index, chip)| {
                let due = match chip.mode {
                    Mode::Idle | Mode::Listening { .. } => return None,
                    Mode::Settling { until }
                    | Mode::Sending { until }
                    | Mode::Awaiting { until, .. }
                    | Mode::Turning { until, .. }
                    | Mode::Acknowledging { until } => until,
                };
                Some((due, index, false))
            });
            let copies = self.copies.iter().enumerate().map(|(index, (due, _, _))| (*due, index, true));
            let Some((due, index, is_copy)) = own.chain(copies).min() else { break };
            if due > until {
                break;
            }
            self.now = self.now.max(due);
            if is_copy {
                let (_, to, flight) = self.copies.swap_remove(index);
                self.arrive(to, flight);
            } else {
                self.step(index);
            }
        }
        self.now = self.now.max(until);
    }

    /// What this chip was waiting for has come.
    fn step(&mut self, index: usize) {
        let now = self.now;
        match self.chips[index].mode {
            Mode::Idle | Mode::Listening { .. } => {}
            Mode::Settling { .. } => self.send(index),
            Mode::Sending { .. } => {
                let no_ack = self.land(index);
                let chip = &mut self.chips[index];
                let asks = !no_ack && chip.acknowledges(0);
                if asks {
                    let (delay, _) = chip.repeats();
                    chip.mode = Mode::Awaiting { since: now + SETTLING, until: now + delay };
                } else {
                    chip.to_send.pop_front();
                    chip.raise(TX_DS);
                    chip.mode = Mode::Idle;
                    self.wake(index);
                }
            }
            Mode::Awaiting { .. } => {
                let chip = &mut self.chips[index];
                if chip.repeats < chip.repeats().1 {
                    chip.repeats += 1;
                    chip.observe(false);
                    self.send(index);
                } else {
                    // The payload stays in the FIFO (PS 7.4.2).
                    chip.observe(true);
                    chip.raise(MAX_RT);
                    chip.mode = Mode::Idle;
                }
            }
            Mode::Turning { pipe, .. } => self.acknowledge(index, pipe),
            Mode::Acknowledging { .. } => {
                self.land(index);
                self.chips[index].mode = Mode::Idle;
                self.wake(index);
            }
        }
    }

    fn send(&mut self, index: usize) {
        let chip = &mut self.chips[index];
        let Some(first) = chip.to_send.front_mut() else {
            // Flushed meanwhile.
            chip.mode = Mode::Idle;
            return;
        };
        first.sent = true;
        let (payload, no_ack) = (first.payload.clone(), first.no_ack);
        let (address, identity) = (chip.target(), chip.packet);
        let end = self.take_off(index, address, identity, payload, no_ack, false);
        self.chips[index].mode = Mode::Sending { until: end };
    }

    fn acknowledge(&mut self, index: usize, pipe: u8) {
        let chip = &mut self.chips[index];
        let address = chip.address(pipe);
        let payload = chip.to_send.iter_mut().find(|waiting| waiting.pipe == Some(pipe));
        let payload = payload.map_or_else(Vec::new, |first| {
            first.sent = true;
            first.payload.clone()
        });
        let end = self.take_off(index, address, 0, payload, true, true);
        self.chips[index].mode = Mode::Acknowledging { until: end };
    }

    fn take_off(
        &mut self,
        from: usize,
        address: [u8; 5],
        identity: u8,
        payload: Vec<u8>,
        no_ack: bool,
        is_ack: bool,
    ) -> u64 {
        let (channel, bit_time) = (self.chips[from].channel(), self.chips[from].bit_time());
        let start = self.now;
        let length = (FRAMING_BITS + 8 * payload.len() as u64) * bit_time;
        let end = start + length;
        let mut collided = false;
        for other in self.flights.iter_mut().filter(|other| other.channel == channel) {
            // A packet that ends now is over.
            if other.end > start {
                self.counts.collided += u64::from(!other.collided);
                other.collided = true;
                collided = true;
            }
        }
        self.counts.packets += 1;
        self.counts.collided += u64::from(collided);
        self.counts.busy += length;
        self.counts.occupied += length + SETTLING;
        self.flights.push(Flight {
            from,
            start,
            end,
            channel,
            bit_time,
            address,
            identity,
            no_ack,
            is_ack,
            payload,
            collided,
        });
        end
    }

    /// The packet of this chip is over: it arrives where it can be received. Returns whether it asked for no
    /// acknowledgement.
    fn land(&mut self, from: usize) -> bool {
        let Some(at) = self.flights.iter().position(|flight| flight.from == from) else { return true };
        let flight = self.flights.swap_remove(at);
        let no_ack = flight.no_ack;
        for to in (0..self.chips.len()).filter(|to| *to != from) {
            let chip = &self.chips[to];
            let (Mode::Listening { since } | Mode::Awaiting { since, .. }) = chip.mode else { continue };
            let hears = chip.channel() == flight.channel
                && chip.bit_time() == flight.bit_time
                && since <= flight.start;
            if !hears || flight.collided || self.happens(self.faults.loss) {
                continue;
            }
            let mut received = flight.clone();
            if !received.payload.is_empty() && self.happens(self.faults.damage) {
                let bit = self.dice.next_u32() as usize % (received.payload.len() * 8);
                received.payload[bit / 8] ^= 1 << (bit % 8);
            }
            if !flight.is_ack && self.happens(self.faults.copies) {
                let later = self.now + 300_000 + u64::from(self.dice.next_u32() % 19_700_000);
                let copy = Flight { identity: (received.identity + 2) & 3, no_ack: true, ..received.clone() };
                self.copies.push((later, to, copy));
            }
            self.arrive(to, received);
        }
        no_ack
    }

    fn arrive(&mut self, to: usize, flight: Flight) {
        let now = self.now;
        let chip = &mut self.chips[to];
        match chip.mode {
            Mode::Awaiting { .. } if flight.is_ack && chip.address(0) == flight.address => {
                if !flight.payload.is_empty() {
                    if chip.received.len() == FIFO {
                        return;
                    }
                    chip.received.push_back((0, flight.payload));
                    chip.raise(RX_DR);
                }
                chip.to_send.pop_front();
                chip.observe(false);
                chip.raise(TX_DS);
                chip.mode = Mode::Idle;
                self.wake(to);
            }
            Mode::Listening { .. } if !flight.is_ack => {
                let Some(pipe) = chip.pipe(flight.address) else { return };
                let sum = check_sum(&flight);
                let is_new = chip.last[usize::from(pipe)] != Some((flight.identity, sum));
                if is_new {
                    // Full, or of another length: neither kept nor acknowledged (PS 7.5.2).
                    if chip.received.len() == FIFO || !chip.takes(pipe, flight.payload.len()) {
                        return;
                    }
                    chip.last[usize::from(pipe)] = Some((flight.identity, sum));
                    chip.received.push_back((pipe, flight.payload));
                    chip.raise(RX_DR);
                    // A new packet shows that the acknowledgement before it came through (PS 7.5.2).
                    let came = chip.to_send.iter().position(|sent| sent.pipe == Some(pipe) && sent.sent);
                    if let Some(came) = came.filter(|_| !flight.no_ack) {
                        chip.to_send.remove(came);
                        chip.raise(TX_DS);
                    }
                }
                if !flight.no_ack && chip.acknowledges(pipe) {
                    chip.mode = Mode::Turning { until: now + SETTLING, pipe };
                }
            }
            _ => {}
        }
    }

    fn happens(&mut self, probability: f32) -> bool {
        probability > 0.0 && (self.dice.next_u32() >> 8) as f32 / 16_777_216.0 < probability
    }
}

/// CRC-16-CCITT over address, control field and payload (PS 7.3.5), here by whole bytes.
fn check_sum(flight: &Flight) -> u16 {
    let control = [flight.payload.len() as u8, flight.identity << 1 | u8::from(flight.no_ack)];
    let bytes = flight.address.iter().chain(&control).chain(&flight.payload);
    bytes.fold(0xffff, |sum, byte| {
        (0..8).fold(
            sum ^ u16::from(*byte) << 8,
            |sum, _| {
                if sum & 0x8000 == 0 { sum << 1 } else { sum << 1 ^ 0x1021 }
            },
        )
    })
}
