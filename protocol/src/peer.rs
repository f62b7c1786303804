//! `peer`: replay protection between robots: a peer is trusted after it has echoed our boot epoch.
//! Prevents recordings of teammates from being trusted after a boot.
//!
//! A teammate is trusted once it has named this robot's present boot epoch in a [`Handshake`]: no
//! recording can, because it was made before that epoch started. So a robot that receives a new epoch of a
//! teammate sends it a handshake, and again every 40 ms, until both know of each other that they trust; then
//! handshakes cease.

use crate::team::{Bond, Handshake, KNOWN_EPOCHS_MAX, KnownEpoch};
use crate::{Duration, Instant, RobotId};

/// Handshake state of every teammate.
#[derive(Clone, Debug, Default)]
pub struct PeerTable {
    teammates: [Option<Peer>; RobotId::COUNT],
    /// Teammates due for a handshake, a bit each: checked after every packet, and nearly always empty.
    owed: u16,
    /// Time of this robot's last handshake.
    last_handshake: Option<Instant>,
    /// Number of the teammate with which the next handshake starts, so that none is left out for ever.
    next: u8,
}

#[derive(Clone, Copy, Debug)]
struct Peer {
    /// The newest boot epoch received.
    boot_epoch: u32,
    /// True once the teammate has named our boot epoch: we trust it.
    believed: bool,
    /// True once the teammate has reported that we named its boot epoch: it trusts us.
    believes: bool,
}

const _: () = assert!(RobotId::COUNT <= u16::BITS as usize, "a bit for each teammate");

const fn bit(teammate: RobotId) -> u16 {
    1 << teammate.number()
}

impl PeerTable {
    /// Handles a frame with the team's tag from that boot epoch (`boot_epoch`) of a teammate.
    pub fn receive(&mut self, teammate: RobotId, boot_epoch: u32) {
        let slot = &mut self.teammates[teammate.index()];
        match slot {
            Some(known) if known.boot_epoch > boot_epoch => return,
            Some(known) if known.boot_epoch == boot_epoch => {
                if known.believed && known.believes {
                    return;
                }
            }
            _ => *slot = Some(Peer { boot_epoch, believed: false, believes: false }),
        }
        self.owed |= bit(teammate);
    }

    /// Records that this boot epoch of a teammate, received already, has named our present one.
    pub fn believe(&mut self, teammate: RobotId, boot_epoch: u32, bond: Bond) {
        let Some(known) =
            self.teammates[teammate.index()].as_mut().filter(|known| known.boot_epoch == boot_epoch)
        else {
            return;
        };
        known.believed = true;
        known.believes |= bond != Bond::Received;
        if bond != Bond::Mutual {
            self.owed |= bit(teammate);
        }
    }

    /// The handshake to send now, if one is due.
    pub fn poll(&mut self, now: Instant) -> Option<Handshake> {
        if self.owed == 0 || self.last_handshake.is_some_and(|last| now.since(last) < HANDSHAKE_PERIOD) {
            return None;
        }
        let mut teammates: heapless::Vec<KnownEpoch, KNOWN_EPOCHS_MAX> = heapless::Vec::new();
        let first = usize::from(self.next);
        for number in (first..first + RobotId::COUNT).map(|n| (n % RobotId::COUNT) as u8) {
            let Some(who) = RobotId::new(number).filter(|_| !teammates.is_full()) else { break };
            let Some(teammate) = self.teammates[who.index()].filter(|_| self.owed & bit(who) != 0) else {
                continue;
            };
            self.owed &= !bit(who);
            let bond = match (teammate.believed, teammate.believes) {
                (false, _) => Bond::Received,
                (true, false) => Bond::Believed,
                (true, true) => Bond::Mutual,
            };
            // The capacity suffices: checked above.
            let _ = teammates.push(KnownEpoch { who, boot_epoch: teammate.boot_epoch, bond });
            self.next = (number + 1) % RobotId::COUNT as u8;
        }
        if teammates.is_empty() {
            return None;
        }
        self.last_handshake = Some(now);
        Some(Handshake { teammates })
    }
}

/// A walking robot's step: ten handshakes fit into the lease for which a booting robot listens, so that at 30
/// % loss one in 10^5 starts without knowing a teammate.
const HANDSHAKE_PERIOD: Duration = Duration::millis(40);

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn handshakes(peer_table: &mut PeerTable, ms: u64) -> heapless::Vec<(u8, u32, Bond), 8> {
        let handshake = peer_table.poll(Instant(ms * 1000));
        let teammates = handshake.iter().flat_map(|handshake| &handshake.teammates);
        teammates.map(|teammate| (teammate.who.number(), teammate.boot_epoch, teammate.bond)).collect()
    }

    #[test]
    fn a_new_boot_epoch_gets_a_handshake_at_once_and_every_40_ms_until_answered() {
        let mut all = PeerTable::default();
        let mut at: heapless::Vec<u64, 8> = heapless::Vec::new();
        for ms in (0..300).step_by(10) {
            all.receive(robot(3), 7);
            if !handshakes(&mut all, ms).is_empty() {
                at.push(ms).unwrap();
            }
        }
        assert_eq!(at[..], [0, 40, 80, 120, 160, 200, 240, 280]);
        // Silent: no handshake is due any more.
        assert!(handshakes(&mut all, 400).len() == 1 && handshakes(&mut all, 500).is_empty());
    }

    #[test]
    fn two_robots_exchange_handshakes_until_both_know_and_then_cease() {
        let (mut a, mut b) = (PeerTable::default(), PeerTable::default());
        let mut bonds = heapless::Vec::<Bond, 16>::new();
        for round in 0..20 {
            // Both send all the time; a's boot epoch is 5, b's 9.
            a.receive(robot(2), 9);
            b.receive(robot(1), 5);
            for handshake in handshakes(&mut a, round * 100) {
                assert_eq!((handshake.0, handshake.1), (2, 9));
                b.believe(robot(1), 5, handshake.2);
                bonds.push(handshake.2).unwrap();
            }
            for handshake in handshakes(&mut b, round * 100) {
                assert_eq!((handshake.0, handshake.1), (1, 5));
                a.believe(robot(2), 9, handshake.2);
                bonds.push(handshake.2).unwrap();
            }
        }
        assert_eq!(bonds[..], [Bond::Received, Bond::Believed, Bond::Mutual, Bond::Mutual]);
    }

    #[test]
    fn a_recording_of_an_earlier_boot_epoch_changes_nothing() {
        let mut all = PeerTable::default();
        all.receive(robot(2), 9);
        all.believe(robot(2), 9, Bond::Mutual);
        assert_eq!(handshakes(&mut all, 0)[..], [(2, 9, Bond::Mutual)]);
        all.receive(robot(2), 8);
        all.believe(robot(2), 8, Bond::Received);
        all.receive(robot(2), 9);
        assert!(handshakes(&mut all, 1_000).is_empty());
    }

    #[test]
    fn more_teammates_than_a_handshake_holds_take_turns() {
        let mut all = PeerTable::default();
        let mut seen = [0; RobotId::COUNT];
        for round in 0..3 {
            RobotId::all().skip(1).for_each(|teammate| all.receive(teammate, 1));
            for (who, ..) in handshakes(&mut all, round * 100) {
                seen[usize::from(who)] += 1;
            }
        }
        assert!(seen[1..].iter().all(|times| *times >= 1), "{seen:?}");
    }
}
