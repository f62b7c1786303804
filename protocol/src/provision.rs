//! `provision`: a robot's identity and its keys, a page of the flash written by `onetwo firmware provision`
//! (docs/architecture.md §6.1, docs/case-format.md §5): 64 bytes that are not part of the firmware.
//!
//! `magic 4 "1-2K" | version 1 | robot 1 | team 1 | league 1 | host key 16 | team's key 16 | check 8`, padded
//! with 0xff. The keys are this robot's own ([`crate::key`]), never the team's secret. The check is
//! SipHash-2-4 of the 40 bytes before it under the host key: a page that was written halfway, or is empty
//! flash, is none. A robot without a page, or with keys that are public, is not commanded by any host
//! ([`read`]).

use rules::League;

use crate::key::{Key, RobotKeys};
use crate::{RobotId, TeamId};

/// Bytes of a page; the remainder of a flash sector stays empty.
pub const PAGE_LEN: usize = 64;
/// Bytes of a page that are used.
const USED_LEN: usize = CHECKED_LEN + 8;
const CHECKED_LEN: usize = 40;
const MAGIC: [u8; 4] = *b"1-2K";
/// Version of the page; version 1 held the team's key.
const VERSION: u8 = 2;

/// Content of a robot's page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provision {
    /// The robot's number, 0–15.
    pub robot: RobotId,
    /// The team that the robot belongs to.
    pub team: TeamId,
    /// League it plays in.
    pub league: League,
    /// The robot's keys: with the host, and with its team.
    pub keys: RobotKeys,
}

/// Reason why a robot's identity cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProvisionError {
    /// Never written, or foreign content.
    #[error("the robot has no key; write one with `onetwo firmware provision`")]
    Empty,
    /// Written for another version of the firmware.
    #[error(
        "its page has version {0}, this firmware reads {VERSION}; write it again with `onetwo firmware provision`"
    )]
    Version(u8),
    /// Written partly, or damaged.
    #[error("its page is damaged; write it again with `onetwo firmware provision`")]
    Damaged,
    /// The keys are derived from the team key of zeros, which is public.
    #[error("its team key is all zeros, which is public; give the team a key of its own")]
    OpenKey,
}

/// The page for a robot.
pub fn page(who: &Provision) -> [u8; PAGE_LEN] {
    let mut page = [0xff; PAGE_LEN];
    let head = [VERSION, who.robot.number(), who.team.0, league_number(who.league)];
    let fields = MAGIC.iter().chain(&head).chain(&who.keys.host.0).chain(&who.keys.team.0);
    page.iter_mut().zip(fields).for_each(|(to, from)| *to = *from);
    let check = check(&page, &who.keys.host);
    page.iter_mut().skip(CHECKED_LEN).zip(check).for_each(|(to, from)| *to = from);
    page
}

/// Reads a page. Public keys are refused unless `open` marks a firmware for trials.
pub fn read(page: &[u8], open: bool) -> Result<Provision, ProvisionError> {
    let used: &[u8; USED_LEN] = page.first_chunk().ok_or(ProvisionError::Empty)?;
    let [m0, m1, m2, m3, version, robot, team, league, rest @ ..] = *used;
    if [m0, m1, m2, m3] != MAGIC {
        return Err(ProvisionError::Empty);
    }
    if version != VERSION {
        return Err(ProvisionError::Version(version));
    }
    let (host, rest) = rest.split_first_chunk().ok_or(ProvisionError::Damaged)?;
    let (shared, seen) = rest.split_first_chunk().ok_or(ProvisionError::Damaged)?;
    let keys = RobotKeys { host: Key(*host), team: Key(*shared) };
    if seen != check(page, &keys.host) {
        return Err(ProvisionError::Damaged);
    }
    let robot = RobotId::new(robot).ok_or(ProvisionError::Damaged)?;
    if keys.are_open(robot) && !open {
        return Err(ProvisionError::OpenKey);
    }
    let league = LEAGUES.get(usize::from(league)).copied().ok_or(ProvisionError::Damaged)?;
    Ok(Provision { robot, team: TeamId(team), league, keys })
}

fn check(page: &[u8], key: &Key) -> [u8; 8] {
    key.tag(page.get(..CHECKED_LEN).unwrap_or_default()).to_le_bytes()
}

fn league_number(league: League) -> u8 {
    LEAGUES.iter().position(|known| *known == league).unwrap_or(0) as u8
}

/// Leagues by their number in a page; new ones are only appended.
const LEAGUES: [League; 4] = [League::FourLegged, League::Ssl2013, League::DivisionB, League::DivisionA];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::key::TeamKey;

    fn who(league: League) -> Provision {
        let (robot, key) = (RobotId::new(7).unwrap(), TeamKey(core::array::from_fn(|n| 3 * n as u8 + 1)));
        Provision { robot, team: TeamId(2), league, keys: key.of_robot(robot) }
    }

    #[test]
    fn pages_are_read_as_written() {
        for league in League::ALL {
            assert_eq!(read(&page(&who(league)), false), Ok(who(league)));
        }
        assert_eq!(&page(&who(League::DivisionB))[..8], [0x31, 0x2d, 0x32, 0x4b, 2, 7, 2, 2]);
        assert!(page(&who(League::DivisionB))[USED_LEN..].iter().all(|byte| *byte == 0xff));
    }

    #[test]
    fn the_page_lacks_the_team_key_and_the_version_that_held_it_is_refused() {
        let key: [u8; 16] = core::array::from_fn(|n| 3 * n as u8 + 1);
        let mut page = page(&who(League::DivisionB));
        assert!(!page.windows(16).any(|bytes| bytes == key));
        page[4] = 1;
        assert_eq!(read(&page, false), Err(ProvisionError::Version(1)));
    }

    #[test]
    fn empty_flash_and_every_changed_bit_are_refused() {
        assert_eq!(read(&[0xff; PAGE_LEN], false), Err(ProvisionError::Empty));
        assert_eq!(read(&[0; 3], false), Err(ProvisionError::Empty));
        let whole = page(&who(League::DivisionB));
        for bit in 0..8 * USED_LEN {
            let mut page = whole;
            page[bit / 8] ^= 1 << (bit % 8);
            assert!(read(&page, true).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn the_key_of_zeros_is_for_trying_things_out() {
        let robot = RobotId::new(7).unwrap();
        let open = Provision { keys: TeamKey::ZERO.of_robot(robot), ..who(League::DivisionB) };
        assert_eq!(read(&page(&open), false), Err(ProvisionError::OpenKey));
        assert_eq!(read(&page(&open), true), Ok(open));
    }
}
