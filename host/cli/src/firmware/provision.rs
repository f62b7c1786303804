//! `onetwo firmware provision`: writes the page of 64 bytes with a robot's number, its team and its own keys,
//! derived from the team's; `onetwo firmware flash --page` puts it beside the firmware (docs/architecture.md
//! §6.1).

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use protocol::provision::{PAGE_LEN, Provision, page, read};
use protocol::{RobotId, TeamId};
use rules::League;

use super::at;
use super::failure::FirmwareError;
use crate::Failure;
use crate::output::{note, print_text};

/// The robot's identity.
#[derive(Debug, Args)]
pub(crate) struct ProvisionArgs {
    /// Its number, 0–15.
    #[arg(long, value_name = "N")]
    robot: u8,
    /// Its team's number on the radio: 1 yellow, 2 blue.
    #[arg(long, value_name = "N")]
    team: u8,
    /// Its league.
    #[arg(long, value_enum, default_value_t = LeagueLabel::DivisionB)]
    league: LeagueLabel,
    /// A file with 32 hexadecimal digits, as `openssl rand -hex 16` makes them.
    #[arg(long, value_name = "FILE")]
    key_file: PathBuf,
    /// Output file of the page.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
}

/// Name of a league.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LeagueLabel {
    /// The four-legged league of 2007.
    FourLegged,
    /// The Small Size League of 2013.
    #[value(name = "ssl-2013")]
    Ssl2013,
    /// Division B of the Small Size League.
    DivisionB,
    /// Division A.
    DivisionA,
}

impl LeagueLabel {
    const fn league(self) -> League {
        match self {
            Self::FourLegged => League::FourLegged,
            Self::Ssl2013 => League::Ssl2013,
            Self::DivisionB => League::DivisionB,
            Self::DivisionA => League::DivisionA,
        }
    }
}

pub(super) fn run(args: &ProvisionArgs) -> Result<(), Failure> {
    let robot = RobotId::new(args.robot).ok_or(FirmwareError::NoRobot(args.robot))?;
    let key = host::shell::key::read(&args.key_file)?;
    if let Some(warning) = &key.warning {
        note!("onetwo: {warning}");
    }
    let who = Provision {
        robot,
        team: TeamId(args.team),
        league: args.league.league(),
        keys: key.key.of_robot(robot),
    };
    let bytes: [u8; PAGE_LEN] = page(&who);
    // The page is read back as by the robot: a key of zeros is refused here already.
    read(&bytes, false)?;
    write_for_owner(&args.out, &bytes).map_err(at(&args.out))?;
    print_text(&format!(
        "{}: robot {robot} of team {}; it holds this robot's keys, not the team's\n",
        args.out.display(),
        args.team
    ))
}

/// Writes a file that only its owner can read, because it contains a key.
fn write_for_owner(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut file = options.open(path)?;
    // The mode above is for new files; an existing file keeps its own until it is set here.
    #[cfg(unix)]
    file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o600))?;
    file.write_all(bytes)
}
