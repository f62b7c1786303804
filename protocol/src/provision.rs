//! Who is this robot, and which key does its team have? A page of the flash, written once by `onetwo firmware provision`
//! (DESIGN §6, §8): 64 bytes that are not part of the image.
//!
//! `magic 4 "1-2K" | version 1 | robot 1 | team 1 | league 1 | key 16 | check 8`, the rest 0xff. The check is SipHash-2-4 of
//! the 24 bytes before it under the key itself: a page that was written halfway, or is empty flash, is none. A robot without
//! a page, or with the key of zeros, is not commanded by anybody ([`read`]).

use core::fmt;
use core::hash::Hasher as _;

use rules::League;
use siphasher::sip::SipHasher24;

use crate::frame::TeamKey;
use crate::{RobotId, TeamId};

/// Bytes of a page; the rest of a flash sector stays empty.
pub const PAGE_LEN: usize = 64;
/// Of those, the ones that mean something.
const USED: usize = CHECKED + 8;
const CHECKED: usize = 24;
const MAGIC: [u8; 4] = *b"1-2K";
const VERSION: u8 = 1;

/// What is written into a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provision {
    /// Its number.
    pub robot: RobotId,
    /// Its team.
    pub team: TeamId,
    /// What it plays.
    pub league: League,
    /// The team's key.
    pub key: TeamKey,
}

/// Why there is no telling who a robot is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProvisionError {
    /// Nothing was ever written, or something else.
    Empty,
    /// Of another version of the firmware.
    Version(u8),
    /// Written halfway, or damaged.
    Damaged,
    /// The key is the one of zeros, which everybody knows.
    OpenKey,
}

impl fmt::Display for ProvisionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("the robot has no key; write one with `onetwo firmware provision`"),
            Self::Version(version) => {
                write!(f, "its page has version {version}, this firmware reads {VERSION}")
            }
            Self::Damaged => {
                f.write_str("its page is damaged; write it again with `onetwo firmware provision`")
            }
            Self::OpenKey => {
                f.write_str("its key is all zeros, which everybody knows; give the team a key of its own")
            }
        }
    }
}

impl core::error::Error for ProvisionError {}

/// The page for a robot.
pub fn page(who: &Provision) -> [u8; PAGE_LEN] {
    let mut page = [0xff; PAGE_LEN];
    let head = [VERSION, who.robot.number(), who.team.0, league_number(who.league)];
    let fields = MAGIC.iter().chain(&head).chain(&who.key.0);
    page.iter_mut().zip(fields).for_each(|(to, from)| *to = *from);
    let check = check(&page, &who.key);
    page.iter_mut().skip(CHECKED).zip(check).for_each(|(to, from)| *to = from);
    page
}

/// Reads a page. An open key is refused unless `open` says that this is an image for trying things out.
pub fn read(page: &[u8], open: bool) -> Result<Provision, ProvisionError> {
    let used: &[u8; USED] = page.first_chunk().ok_or(ProvisionError::Empty)?;
    let [m0, m1, m2, m3, version, robot, team, league, key @ .., _, _, _, _, _, _, _, _] = *used;
    if [m0, m1, m2, m3] != MAGIC {
        return Err(ProvisionError::Empty);
    }
    if version != VERSION {
        return Err(ProvisionError::Version(version));
    }
    let key = TeamKey(key);
    if used.last_chunk() != Some(&check(page, &key)) {
        return Err(ProvisionError::Damaged);
    }
    if key == TeamKey::ZERO && !open {
        return Err(ProvisionError::OpenKey);
    }
    let robot = RobotId::new(robot).ok_or(ProvisionError::Damaged)?;
    let league = LEAGUES.get(usize::from(league)).copied().ok_or(ProvisionError::Damaged)?;
    Ok(Provision { robot, team: TeamId(team), league, key })
}

fn check(page: &[u8], key: &TeamKey) -> [u8; 8] {
    let mut hasher = SipHasher24::new_with_key(&key.0);
    hasher.write(page.get(..CHECKED).unwrap_or_default());
    hasher.finish().to_le_bytes()
}

fn league_number(league: League) -> u8 {
    LEAGUES.iter().position(|known| *known == league).unwrap_or(0) as u8
}

/// By their number in a page; only ever added to.
const LEAGUES: [League; 4] = [League::FourLegged, League::Ssl2013, League::DivisionB, League::DivisionA];

#[cfg(test)]
mod tests {
    use super::*;

    fn who(league: League) -> Provision {
        let key = core::array::from_fn(|n| 3 * n as u8 + 1);
        Provision { robot: RobotId::new(7).unwrap(), team: TeamId(2), league, key: TeamKey(key) }
    }

    #[test]
    fn what_was_written_is_read() {
        for league in LEAGUES {
            assert_eq!(read(&page(&who(league)), false), Ok(who(league)));
        }
        assert_eq!(&page(&who(League::DivisionB))[..9], [0x31, 0x2d, 0x32, 0x4b, 1, 7, 2, 2, 1]);
        assert!(page(&who(League::DivisionB))[USED..].iter().all(|byte| *byte == 0xff));
    }

    #[test]
    fn empty_flash_and_every_changed_bit_are_refused() {
        assert_eq!(read(&[0xff; PAGE_LEN], false), Err(ProvisionError::Empty));
        assert_eq!(read(&[0; 3], false), Err(ProvisionError::Empty));
        let whole = page(&who(League::DivisionB));
        for bit in 0..8 * USED {
            let mut page = whole;
            page[bit / 8] ^= 1 << (bit % 8);
            assert!(read(&page, true).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn the_key_of_zeros_is_for_trying_things_out() {
        let open = Provision { key: TeamKey::ZERO, ..who(League::DivisionB) };
        assert_eq!(read(&page(&open), false), Err(ProvisionError::OpenKey));
        assert_eq!(read(&page(&open), true), Ok(open));
    }
}
