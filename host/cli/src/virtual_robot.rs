//! `onetwo virtual-robot`: one robot's brain as a process, in any simulator of the league. Not for direct
//! use: `control` starts it for each robot of `--robots sim://HOST`; by hand it helps to find out why one
//! does not run.

use std::io::{self, BufRead as _};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{SystemTime, UNIX_EPOCH};

use brain::BrainConfig;
use casebase::GoalEnd;
use clap::Args;
use host::shell::key;
use protocol::frame::TeamKey;
use protocol::{RobotId, TeamId};
use rules::{Colour, League};
use thiserror::Error;
use virtual_robot::{Options, parent_gone, run as play};

use crate::Failure;
use crate::args::parsers::{colour, destination, goal, league, robot_id};
use crate::args::{DirectoryArgs, SettingsArgs};
use crate::output::note;

/// The robot's identity and its addresses.
#[derive(Debug, Args)]
pub(crate) struct VirtualRobotArgs {
    /// Its number, 0 to 15.
    #[arg(long, value_parser = robot_id)]
    id: RobotId,
    /// Its team: blue or yellow.
    #[arg(long, value_parser = colour)]
    team: Colour,
    /// Its league: ssl-2013, division-b or division-a.
    #[arg(long, value_parser = league, default_value = "division-b")]
    league: League,
    /// Its host, as HOST:PORT.
    #[arg(long, value_parser = destination)]
    host: SocketAddr,
    /// The simulator, as HOST or HOST:PORT; without a port the league's for its team, 10301 blue, 10302
    /// yellow.
    #[arg(long, value_name = "HOST[:PORT]")]
    simulator: String,
    /// The goal its team defends until its host sends it.
    #[arg(long, value_parser = goal, default_value = "yellow", value_name = "yellow|cyan")]
    defending: GoalEnd,
    /// The file of the team's key; left out: a key of zeros.
    #[arg(long, value_name = "FILE", conflicts_with = "with_parent")]
    key_file: Option<PathBuf>,
    /// The key is standard input's first line, and the robot ends when standard input closes.
    #[arg(long)]
    with_parent: bool,
    #[command(flatten)]
    directory: DirectoryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

/// Runs until it is stopped.
pub(crate) fn run(args: &VirtualRobotArgs) -> Result<ExitCode, Failure> {
    let (key, end) = if args.with_parent {
        (key_of_parent()?, parent_gone())
    } else {
        (key_of_file(args.key_file.as_deref())?, Arc::new(AtomicBool::new(false)))
    };
    let library_handle = args.directory.library.as_deref().map(crate::library::read).transpose()?;
    let base = match &library_handle {
        Some(library_handle) => library_handle.base(),
        // A league without a case library is played without cases.
        None => host::cases_of(args.league),
    };
    let brain = BrainConfig {
        // Seconds since 1970: rises with every start that is a second after the last, which `control`
        // ensures.
        epoch: SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() as u32),
        defending: args.defending,
        settings: args.settings.choose()?.settings,
        ..BrainConfig::hosted(args.id, TeamId::of(args.team), args.league)
    };
    let options = Options {
        brain,
        keys: key.of_robot(args.id),
        host: args.host,
        simulator: simulator(&args.simulator, args.team)?,
    };
    play(&options, base, &end)?;
    Ok(ExitCode::SUCCESS)
}

fn key_of_parent() -> Result<TeamKey, Failure> {
    let mut line = String::new();
    io::stdin().lock().read_line(&mut line).map_err(Failure::Input)?;
    key::parse(&line).map_err(|what| RobotError::NoKey(what).into())
}

fn key_of_file(file: Option<&std::path::Path>) -> Result<TeamKey, Failure> {
    let Some(file) = file else { return Ok(TeamKey::ZERO) };
    let read = key::read(file)?;
    if let Some(warning) = read.warning {
        note!("warning: {warning}");
    }
    Ok(read.key)
}

fn simulator(text: &str, team: Colour) -> Result<SocketAddr, Failure> {
    let port = match team {
        Colour::Blue => ssl::net::addresses::ROBOTS_BLUE_PORT,
        Colour::Yellow => ssl::net::addresses::ROBOTS_YELLOW_PORT,
    };
    ssl::net::resolve_destination(text, Some(port))
        .map_err(|error| RobotError::UnknownSimulator(text.to_owned(), error).into())
}

#[derive(Debug, Error)]
enum RobotError {
    #[error("--with-parent: standard input begins with {0}, no key")]
    NoKey(String),
    #[error("unknown host in --simulator {0}: {1}")]
    UnknownSimulator(String, String),
}
