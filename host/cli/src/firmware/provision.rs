//! `onetwo firmware provision`: writes the page of 64 bytes with a robot's number, its team and its own keys,
//! derived from the team's; `onetwo firmware flash --page` puts it beside the firmware (docs/architecture.md
//! §6.1).

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use protocol::provision::{PAGE_LEN, Provision, page, read};
use protocol::{RobotId, TeamId};
use rules::League;

use super::failure::FirmwareError;
use crate::Failure;
use crate::args::parsers;
use crate::destination::{self, FileKind};
use crate::output::{note, print_text};

/// The robot's identity.
#[derive(Debug, Args)]
pub(crate) struct ProvisionArgs {
    /// Its number, 0–15.
    #[arg(long, value_name = "N")]
    robot: u8,
    /// Its team's number on the radio: 1 yellow, 2 blue.
    #[arg(long, value_name = "N", value_parser = parsers::radio_team)]
    team: TeamId,
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
    destination::check(&[(&args.out, FileKind::Page)], &[&args.key_file])?;
    let robot = RobotId::new(args.robot).ok_or(FirmwareError::NoRobot(args.robot))?;
    let key = host::shell::key::read(&args.key_file)?;
    if let Some(warning) = &key.warning {
        note!("onetwo: {warning}");
    }
    let who =
        Provision { robot, team: args.team, league: args.league.league(), keys: key.key.of_robot(robot) };
    let bytes: [u8; PAGE_LEN] = page(&who);
    // The page is read back as by the robot: a key of zeros is refused here already.
    read(&bytes, false)?;
    destination::write_for_owner(&args.out, FileKind::Page, &bytes)?;
    print_text(&format!(
        "{}: robot {} of team {}; it holds this robot's keys, not the team's\n",
        args.out.display(),
        robot,
        args.team.0
    ))
}
