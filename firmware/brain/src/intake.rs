//! Which packets are opened in a step, and which wait for the next?
//!
//! Opening a packet (tag, decoding, what follows) is dear, and steps on wheels are short. So packets wait here for the next step.
//! It opens all of the host's, as a HALT must not wait, but of several pictures the newest first, and of several commands: what is
//! overtaken by a genuine frame is then refused by its counter, before its tag costs anything. Mates' are opened in the order in which they came, as many as the
//! allowance pays for and [`MATES_LEAST`] at least; a full pile lets its oldest go, for all is repeated. Costs are in
//! instructions of a Cortex-M4.

use protocol::Instant;
use protocol::link::{Packet, Pile};

/// Packets that wait for a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Intake {
    host: Queue<HOST_MAX>,
    mates: Queue<MATES_MAX>,
    /// How many came since the last step.
    came: u32,
    /// What this step may still spend, and how many mates' packets it opens at least.
    left: u32,
    owed: u32,
    /// How far the step has come with the host's: first what is not overtaken, then the rest.
    seen: [usize; 2],
    lost: u32,
}

impl Intake {
    /// A packet came, which its pile keeps until it is its turn; `None` for one that nobody wants to open.
    pub(crate) fn keep(&mut self, now: Instant, pile: Option<Pile>, packet: &[u8]) {
        self.came = self.came.saturating_add(1);
        let oldest_went = match pile {
            Some(pile @ (Pile::Picture(..) | Pile::Command(_) | Pile::Welcome)) => {
                self.host.overtake(pile);
                self.host.push(now, pile, packet)
            }
            Some(Pile::Mate) => self.mates.push(now, Pile::Mate, packet),
            Some(Pile::Others) | None => false,
        };
        self.lost = self.lost.saturating_add(u32::from(oldest_went));
    }

    /// A step begins.
    pub(crate) fn begin_step(&mut self) {
        self.left = STEP.saturating_sub(self.came.saturating_mul(CAME));
        (self.came, self.owed, self.seen) = (0, MATES_LEAST, [0; 2]);
    }

    /// The next packet to open in this step, and when it came.
    pub(crate) fn next(&mut self) -> Option<(Instant, &Packet)> {
        for (overtaken, seen) in [false, true].into_iter().zip(&mut self.seen) {
            while *seen < self.host.len {
                let number = *seen;
                *seen += 1;
                if self.host.get(number).is_some_and(|place| place.overtaken == overtaken) {
                    let place = self.host.get(number)?;
                    let cost = if overtaken { 0 } else { place.cost() };
                    self.left = self.left.saturating_sub(cost);
                    return Some((place.came, &place.packet));
                }
            }
        }
        self.host.len = 0;
        let cost = self.mates.get(0).map(Place::cost).filter(|cost| self.owed > 0 || self.left >= *cost)?;
        self.left = self.left.saturating_sub(cost);
        self.owed = self.owed.saturating_sub(1);
        self.mates.pop()
    }

    /// How many packets went unopened because too many others came.
    pub(crate) fn lost(&self) -> u32 {
        self.lost
    }
}

/// A packet that waits.
#[derive(Clone, Debug)]
struct Place {
    came: Instant,
    packet: Packet,
    pile: Pile,
    /// Something that came later makes it needless, if that is genuine.
    overtaken: bool,
}

impl Place {
    /// What it costs to open.
    fn cost(&self) -> u32 {
        OPENED + A_BYTE * self.packet.len() as u32
    }
}

/// Packets in the order in which they came; the oldest goes where there is no room.
#[derive(Clone, Debug)]
struct Queue<const N: usize> {
    places: [Place; N],
    first: usize,
    len: usize,
}

impl<const N: usize> Default for Queue<N> {
    fn default() -> Self {
        let empty =
            |_| Place { came: Instant(0), packet: Packet::new(), pile: Pile::Others, overtaken: false };
        Self { places: core::array::from_fn(empty), first: 0, len: 0 }
    }
}

impl<const N: usize> Queue<N> {
    /// Whether the oldest had to go.
    fn push(&mut self, now: Instant, pile: Pile, packet: &[u8]) -> bool {
        let full = self.len == N;
        if full {
            self.pop();
        }
        if let Some(place) = self.places.get_mut((self.first + self.len) % N) {
            place.packet.clear();
            // What is longer than a frame has been refused before it comes here.
            if place.packet.extend_from_slice(packet).is_ok() {
                (place.came, place.pile, place.overtaken) = (now, pile, false);
                self.len += 1;
            }
        }
        full
    }

    /// Marks what says nothing any more once `later` is believed.
    fn overtake(&mut self, later: Pile) {
        for number in 0..self.len {
            if let Some(place) = self.places.get_mut((self.first + number) % N) {
                place.overtaken |= place.pile.is_overtaken_by(later);
            }
        }
    }

    fn get(&self, number: usize) -> Option<&Place> {
        self.places.get((self.first + number) % N).filter(|_| number < self.len)
    }

    /// The next one; it keeps its place until another one needs it.
    fn pop(&mut self) -> Option<(Instant, &Packet)> {
        if self.len == 0 {
            return None;
        }
        let place = self.places.get(self.first)?;
        self.first = (self.first + 1) % N;
        self.len -= 1;
        Some((place.came, &place.packet))
    }
}

/// What a step spends on packets before mates' wait.
const STEP: u32 = 11_000;
/// What a packet costs that only came: from the radio to its pile.
const CAME: u32 = 500;
/// What opening one costs, and each of its bytes: tag, decoding, taking it in.
const OPENED: u32 = 700;
const A_BYTE: u32 = 23;
/// Mates' packets that a step opens whatever else there is: an end that a mate tells is obeyed from the next step on (DESIGN §5).
const MATES_LEAST: u32 = 2;
/// The host's waiting packets: two pictures of six against six with their commands, and a welcome.
const HOST_MAX: usize = 8;
/// Mates' waiting packets.
const MATES_MAX: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    /// The first bytes of what a step opens.
    fn step(intake: &mut Intake) -> heapless::Vec<u8, 32> {
        intake.begin_step();
        let mut opened = heapless::Vec::new();
        while let Some((_, packet)) = intake.next() {
            opened.push(packet[0]).unwrap();
        }
        opened
    }

    fn hear(intake: &mut Intake, pile: Pile, first: u8, len: usize) {
        let mut packet = [0; 120];
        packet[0] = first;
        intake.keep(Instant(u64::from(first)), Some(pile), &packet[..len]);
    }

    #[test]
    fn of_two_pictures_the_newest_is_opened_first_and_mates_wait_in_turn() {
        let mut intake = Intake::default();
        for picture in 0..2 {
            let said = [1, 10 * u32::from(picture)];
            hear(&mut intake, Pile::Picture(said, picture), 10 * picture, 107);
            hear(&mut intake, Pile::Picture(said, picture), 10 * picture + 1, 107);
            hear(&mut intake, Pile::Command(said), 10 * picture + 2, 35);
        }
        for mate in 0..6 {
            hear(&mut intake, Pile::Mate, 100 + mate, 50);
        }
        // 11,000 − 12 · 500 pays for one part; then nothing comes, and fifty bytes cost 1,850.
        assert_eq!(step(&mut intake)[..], [10, 11, 12, 0, 1, 2, 100, 101]);
        assert_eq!(step(&mut intake)[..], [102, 103, 104, 105]);
        assert!(step(&mut intake).is_empty() && intake.lost() == 0);
    }

    #[test]
    fn a_welcome_and_what_another_host_says_are_not_overtaken() {
        let mut intake = Intake::default();
        hear(&mut intake, Pile::Command([1, 1]), 1, 35);
        hear(&mut intake, Pile::Welcome, 2, 26);
        hear(&mut intake, Pile::Picture([2, 1], 9), 3, 90);
        hear(&mut intake, Pile::Picture([1, 2], 3), 4, 90);
        hear(&mut intake, Pile::Command([2, 2]), 5, 35);
        assert_eq!(step(&mut intake)[..], [1, 2, 3, 4, 5]);
    }

    #[test]
    fn however_much_comes_the_oldest_go() {
        let mut intake = Intake::default();
        for number in 0..40 {
            hear(&mut intake, Pile::Mate, number, 64);
        }
        assert_eq!(intake.lost(), 40 - MATES_MAX as u32);
        assert_eq!(step(&mut intake)[..], [32, 33]);
        intake.keep(Instant(0), None, &[]);
        intake.keep(Instant(0), Some(Pile::Others), &[9]);
        assert_eq!(step(&mut intake)[..], [34, 35, 36, 37]);
    }

    #[test]
    fn a_packet_is_told_with_the_time_at_which_it_came() {
        let mut intake = Intake::default();
        hear(&mut intake, Pile::Command([1, 1]), 7, 40);
        intake.begin_step();
        assert_eq!(intake.next().map(|(heard, packet)| (heard, packet.len())), Some((Instant(7), 40)));
    }
}
