//! `acquaintance`: replay protection between robots: a peer is trusted after it has echoed our boot epoch.
//! Prevents recordings of teammates from being trusted after a boot.
//!
//! A teammate is trusted once it has named this robot's present boot epoch in a [`Greeting`] (handshake): no
//! recording can, because it was made before that epoch started. So a robot that receives a new epoch of a
//! teammate sends it a handshake, and again every 40 ms, until both know of each other that they trust; then
//! handshakes cease.

use crate::team::{Bond, GREETED_MAX, Greeted, Greeting};
use crate::{Duration, Instant, RobotId};

/// Handshake state of every teammate.
#[derive(Clone, Debug, Default)]
pub struct Acquaintances {
    mates: [Option<Mate>; RobotId::COUNT],
    /// Teammates due for a handshake, a bit each: checked after every packet, and nearly always empty.
    owed: u16,
    /// When this robot sent its last handshake.
    greeted: Option<Instant>,
    /// Number of the teammate with which the next handshake starts, so that none is left out for ever.
    next: u8,
}

#[derive(Clone, Copy, Debug)]
struct Mate {
    /// The newest boot epoch received.
    life: u32,
    /// It has named our boot epoch: we trust it.
    believed: bool,
    /// It has reported that we named its boot epoch: it trusts us.
    believes: bool,
}

const _: () = assert!(RobotId::COUNT <= u16::BITS as usize, "a bit for each mate");

const fn bit(mate: RobotId) -> u16 {
    1 << mate.number()
}

impl Acquaintances {
    /// Handles a frame with the team's tag from that boot epoch (`life`) of a teammate.
    pub fn hear(&mut self, mate: RobotId, life: u32) {
        let slot = &mut self.mates[mate.index()];
        match slot {
            Some(known) if known.life > life => return,
            Some(known) if known.life == life => {
                if known.believed && known.believes {
                    return;
                }
            }
            _ => *slot = Some(Mate { life, believed: false, believes: false }),
        }
        self.owed |= bit(mate);
    }

    /// That boot epoch of a teammate, received already, has named our present one.
    pub fn believe(&mut self, mate: RobotId, life: u32, bond: Bond) {
        let Some(known) = self.mates[mate.index()].as_mut().filter(|known| known.life == life) else {
            return;
        };
        known.believed = true;
        known.believes |= bond != Bond::Heard;
        if bond != Bond::Mutual {
            self.owed |= bit(mate);
        }
    }

    /// The handshake to send now, if one is due.
    pub fn poll(&mut self, now: Instant) -> Option<Greeting> {
        if self.owed == 0 || self.greeted.is_some_and(|last| now.since(last) < GREET_EVERY) {
            return None;
        }
        let mut mates: heapless::Vec<Greeted, GREETED_MAX> = heapless::Vec::new();
        let first = usize::from(self.next);
        for number in (first..first + RobotId::COUNT).map(|n| (n % RobotId::COUNT) as u8) {
            let Some(who) = RobotId::new(number).filter(|_| !mates.is_full()) else { break };
            let Some(mate) = self.mates[who.index()].filter(|_| self.owed & bit(who) != 0) else { continue };
            self.owed &= !bit(who);
            let bond = match (mate.believed, mate.believes) {
                (false, _) => Bond::Heard,
                (true, false) => Bond::Believed,
                (true, true) => Bond::Mutual,
            };
            // The capacity suffices: checked above.
            let _ = mates.push(Greeted { who, life: mate.life, bond });
            self.next = (number + 1) % RobotId::COUNT as u8;
        }
        if mates.is_empty() {
            return None;
        }
        self.greeted = Some(now);
        Some(Greeting { mates })
    }
}

/// A walking robot's step: ten handshakes fit into the lease for which a booting robot listens, so that at 30
/// % loss one in 10^5 starts without knowing a teammate.
const GREET_EVERY: Duration = Duration::millis(40);

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn greeted(acquaintances: &mut Acquaintances, ms: u64) -> heapless::Vec<(u8, u32, Bond), 8> {
        let greeting = acquaintances.poll(Instant(ms * 1000));
        let mates = greeting.iter().flat_map(|greeting| &greeting.mates);
        mates.map(|mate| (mate.who.number(), mate.life, mate.bond)).collect()
    }

    #[test]
    fn a_new_life_is_greeted_at_once_and_again_every_40_ms_while_it_speaks_and_does_not_answer() {
        let mut all = Acquaintances::default();
        let mut at: heapless::Vec<u64, 8> = heapless::Vec::new();
        for ms in (0..300).step_by(10) {
            all.hear(robot(3), 7);
            if !greeted(&mut all, ms).is_empty() {
                at.push(ms).unwrap();
            }
        }
        assert_eq!(at[..], [0, 40, 80, 120, 160, 200, 240, 280]);
        // Silent: no handshake is due any more.
        assert!(greeted(&mut all, 400).len() == 1 && greeted(&mut all, 500).is_empty());
    }

    #[test]
    fn two_greet_each_other_until_both_know_and_then_cease() {
        let (mut a, mut b) = (Acquaintances::default(), Acquaintances::default());
        let mut bonds = heapless::Vec::<Bond, 16>::new();
        for round in 0..20 {
            // Both send all the time; a's boot epoch is 5, b's 9.
            a.hear(robot(2), 9);
            b.hear(robot(1), 5);
            for greeting in greeted(&mut a, round * 100) {
                assert_eq!((greeting.0, greeting.1), (2, 9));
                b.believe(robot(1), 5, greeting.2);
                bonds.push(greeting.2).unwrap();
            }
            for greeting in greeted(&mut b, round * 100) {
                assert_eq!((greeting.0, greeting.1), (1, 5));
                a.believe(robot(2), 9, greeting.2);
                bonds.push(greeting.2).unwrap();
            }
        }
        assert_eq!(bonds[..], [Bond::Heard, Bond::Believed, Bond::Mutual, Bond::Mutual]);
    }

    #[test]
    fn a_recording_of_an_earlier_life_changes_nothing() {
        let mut all = Acquaintances::default();
        all.hear(robot(2), 9);
        all.believe(robot(2), 9, Bond::Mutual);
        assert_eq!(greeted(&mut all, 0)[..], [(2, 9, Bond::Mutual)]);
        all.hear(robot(2), 8);
        all.believe(robot(2), 8, Bond::Heard);
        all.hear(robot(2), 9);
        assert!(greeted(&mut all, 1_000).is_empty());
    }

    #[test]
    fn more_mates_than_a_greeting_holds_take_turns() {
        let mut all = Acquaintances::default();
        let mut seen = [0; RobotId::COUNT];
        for round in 0..3 {
            RobotId::all().skip(1).for_each(|mate| all.hear(mate, 1));
            for (who, ..) in greeted(&mut all, round * 100) {
                seen[usize::from(who)] += 1;
            }
        }
        assert!(seen[1..].iter().all(|times| *times >= 1), "{seen:?}");
    }
}
