//! `key`: the team's secret and the keys derived from it, one per robot and one among robots. 128 bits each.
//!
//! ```text
//! key(purpose, robot) = SipHash-2-4(team key, "onetwo key 2" | purpose 1 | robot 1 | 00)
//!                     | SipHash-2-4(team key, "onetwo key 2" | purpose 1 | robot 1 | 01)        each 8 bytes, little endian
//! ```
//!
//! Purpose `H` is the key between the host and that robot, purpose `T` (robot 0) the one among all robots of
//! the team. SipHash is a pseudo-random function: two labels never give the same input, and no derived key
//! reveals the team key or another derived one. The host holds the team key; a robot holds only its own two
//! ([`RobotKeys`]), so a stolen robot cannot speak as the host to another robot, nor as another robot to the
//! host.

use core::fmt;
use core::hash::Hasher as _;

use siphasher::sip::SipHasher24;

use crate::RobotId;

/// The secret of a team: held by its host and by the program that provisions its robots, never by a robot.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TeamKey(pub [u8; 16]);

/// A key that frames are sealed with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Key(pub [u8; 16]);

/// Keys of one robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotKeys {
    /// Key between this robot and the host.
    pub host: Key,
    /// Key among all robots of the team; the host holds it too.
    pub team: Key,
}

/// Keys of the host: every robot's key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TeamKeys {
    robots: [Key; RobotId::COUNT],
    team: Key,
}

impl TeamKey {
    /// The public key of a team that has none: its frames can be distinguished from noise, not from
    /// forgeries.
    pub const ZERO: Self = Self([0; 16]);

    /// The keys of one robot.
    pub fn of_robot(&self, robot: RobotId) -> RobotKeys {
        RobotKeys { host: self.derived(b'H', robot), team: self.derived(b'T', RobotId::ZERO) }
    }

    /// The keys of all robots.
    pub fn of_team(&self) -> TeamKeys {
        let mut robots = [Key([0; 16]); RobotId::COUNT];
        for (robot, key) in RobotId::all().zip(&mut robots) {
            *key = self.derived(b'H', robot);
        }
        TeamKeys { robots, team: self.derived(b'T', RobotId::ZERO) }
    }

    fn derived(&self, purpose: u8, robot: RobotId) -> Key {
        let mut derived = [0; 16];
        for (half, bytes) in (0_u8..).zip(derived.chunks_exact_mut(8)) {
            let mut text = [0; DERIVATION_LABEL.len() + 3];
            let (label, rest) = text.split_at_mut(DERIVATION_LABEL.len());
            label.copy_from_slice(DERIVATION_LABEL);
            rest.copy_from_slice(&[purpose, robot.number(), half]);
            bytes.copy_from_slice(&Key(self.0).tag(&text).to_le_bytes());
        }
        Key(derived)
    }
}

impl Key {
    /// SipHash-2-4 of these bytes.
    #[inline(never)]
    pub(crate) fn tag(&self, bytes: &[u8]) -> u64 {
        let mut hasher = SipHasher24::new_with_key(&self.0);
        hasher.write(bytes);
        hasher.finish()
    }
}

impl RobotKeys {
    /// Returns whether these are the keys derived from [`TeamKey::ZERO`], which are public.
    pub fn are_open(&self, robot: RobotId) -> bool {
        *self == TeamKey::ZERO.of_robot(robot)
    }
}

impl TeamKeys {
    /// The key between the host and that robot.
    pub fn of(&self, robot: RobotId) -> &Key {
        &self.robots[robot.index()]
    }

    /// The key among robots.
    pub fn team(&self) -> &Key {
        &self.team
    }
}

impl fmt::Debug for TeamKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("TeamKey(..)")
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Key(..)")
    }
}

/// Separates derived keys from any other input that is hashed under a team key; 2 is the frame's version.
const DERIVATION_LABEL: &[u8; 12] = b"onetwo key 2";

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    #[test]
    fn every_robot_has_a_key_of_its_own_and_all_share_the_teams() {
        let team = TeamKey(core::array::from_fn(|n| n as u8));
        let all = team.of_team();
        for a in RobotId::all() {
            let keys = team.of_robot(a);
            assert_eq!((&keys.host, &keys.team), (all.of(a), all.team()));
            assert_ne!(keys.host, keys.team);
            assert_ne!(keys.host.0, team.0);
            for b in RobotId::all().filter(|b| *b != a) {
                assert_ne!(all.of(a), all.of(b));
            }
        }
    }

    #[test]
    fn keys_of_the_public_team_key_are_known_as_such() {
        assert!(TeamKey::ZERO.of_robot(robot(3)).are_open(robot(3)));
        assert!(!TeamKey::ZERO.of_robot(robot(3)).are_open(robot(4)));
        assert!(!TeamKey([1; 16]).of_robot(robot(3)).are_open(robot(3)));
    }
}
