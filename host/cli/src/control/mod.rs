//! `onetwo control`: the host of a team on the league's network
//! (docs/architecture.md §3, docs/case-format.md §5).
//!
//! [`host::run`] has sockets, threads and the loop; here are the flags, the terminal and the page.

mod failure;
mod operator;
mod terminal;

use std::ffi::OsString;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::cases::LibraryHandle;
use clap::Args;
use hil_sim::small_size::Parameters;
use host::config::{Calibration, RobotLink, TeamConfig, TeamSettings};
use host::run::{CONFIG_LEN_MAX, OutputFiles, Program, RunSettings, VirtualRobots};
use protocol::{RobotId, TeamId};
use ssl::net::addresses;

use crate::Failure;
use crate::args::page::PageArgs;
use crate::args::parsers::{
    RobotIds, address, destination, kick, remote_port, robot_ids, seconds, team_port,
};
use crate::args::{DirectoryArgs, SettingsArgs};
use crate::destination::{self, FileKind, check_recording};
use crate::library;
use crate::output::{note, print_text, printable_path};
use crate::robot::scan::Spectrum;
use crate::robot_description::ensure_built_for;
use crate::stop::stopped_by_hand;
use failure::ControlError;
use operator::{ControlOperator, PageSettings};

/// Our team, and the addresses to receive from and send to. What is not given here is taken from the file,
/// and else from the league.
#[derive(Debug, Args)]
pub(crate) struct ControlArgs {
    /// The team's settings file; each setting can be overridden here.
    #[arg(long, value_name = "team.toml")]
    config: Option<PathBuf>,
    /// Write the settings of this command to a new settings file, each with what it means, and end.
    #[arg(long, value_name = "team.toml", conflicts_with = "print_config")]
    init: Option<PathBuf>,
    /// Print the settings of this command as a settings file, each with what it means, and end.
    #[arg(long)]
    print_config: bool,
    /// The team's name, as the game controller knows it.
    #[arg(long)]
    name: Option<String>,
    /// blue or yellow.
    #[arg(long)]
    colour: Option<String>,
    /// ssl-2013, division-b or division-a.
    #[arg(long)]
    league: Option<String>,
    /// Our keeper's number, until the referee sends another.
    #[arg(long, value_name = "ID")]
    keeper: Option<u8>,
    /// The interface that receives and sends multicast, its name or address; by default it is received on
    /// every interface.
    #[arg(long, value_name = "NAME")]
    interface: Option<String>,
    /// Where the robots are: `sim://HOST[:PORT]` (brains of our own in a simulator; its control port, 10300),
    /// `udp://HOST:PORT` or `serial:DEVICE[:BAUD]`.
    #[arg(long, value_name = "LINK")]
    robots: Option<String>,
    /// Which robots are started in a simulator, such as 0-5 or 1,4,7; by default the league's number, from 0
    /// on.
    #[arg(long, value_name = "IDS", value_parser = robot_ids)]
    ids: Option<RobotIds>,
    /// The team's key: 32 hexadecimal digits in a file, as `openssl rand -hex 16` makes them; needed for
    /// udp:// and serial:.
    #[arg(long, value_name = "FILE")]
    key_file: Option<PathBuf>,
    /// Control real robots without a key of the team's own: any sender in radio range can then command them.
    #[arg(long)]
    insecure_zero_key: bool,
    /// Address where vision is received: 224.5.23.2:10006, and 224.5.23.2:10020 for robots in a simulator.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    vision: Option<SocketAddr>,
    /// Address where the referee is received: 224.5.23.1:10003.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    referee: Option<SocketAddr>,
    /// The only referee that is obeyed: the address of its machine (192.168.1.5), its address with port, or
    /// its identifier. Others are ignored and reported. Without it the strictest command of all of them is
    /// obeyed.
    #[arg(long, value_name = "ADDRESS|IDENTIFIER")]
    referee_source: Option<String>,
    /// What the robots do when no packet came from the referee for 2 s: `halt` (the default), or `go-on` by
    /// its last command (a test day on which the game controller is ended after a command). Before its first
    /// packet they halt in both cases.
    #[arg(long, value_name = "halt|go-on")]
    referee_silence: Option<String>,
    /// Where our tracker's packets go: 224.5.23.2:10010.
    #[arg(long, value_name = "HOST:PORT", value_parser = destination)]
    tracker: Option<SocketAddr>,
    /// Another program's tracker that takes the place of vision while it sends, such as
    /// 224.5.23.2:10010,TIGERs: address, and name or identifier of the source (the first that sends, without
    /// one). Where it is silent for 0.05 s vision is tracked, and 0.5 s after it is back it leads again.
    #[arg(long, value_name = "HOST:PORT[,NAME]")]
    tracker_in: Option<String>,
    /// The game controller's port for teams, such as 127.0.0.1:10008. If omitted, the goalkeeper is not
    /// announced to the game controller.
    #[arg(long, value_name = "HOST[:PORT]", value_parser = team_port)]
    game_controller: Option<SocketAddr>,
    /// The game controller's port for remote controls (10011): the page's tab Control then asks for timeouts,
    /// substitutions, the challenge flag, an emergency stop and the keeper, with --live-parameters.
    #[arg(long, value_name = "HOST[:PORT]", value_parser = remote_port)]
    remote: Option<SocketAddr>,
    /// A program that gives the robots' orders, such as `python3 my_team.py`: it gets the view as a line
    /// of JSON and answers with one (docs/strategy-protocol.md). While it does not answer, robots stand.
    #[arg(long, value_name = "COMMAND")]
    strategy: Option<String>,
    /// Kick gain of a robot, measured / ordered ball speed, such as 3=1.06; may be repeated.
    #[arg(long = "kick", value_name = "ROBOT=FACTOR", value_parser = kick)]
    kicks: Vec<Calibration>,
    /// Keep what is learned of kickers, latencies and the ball in this file, which may be the team.toml: its
    /// contents are read at the start (unless --config names it already), and the values at the end replace
    /// the lines that an earlier run wrote.
    #[arg(long, value_name = "FILE")]
    learned: Option<PathBuf>,
    /// Do not play by what is learned (it is displayed all the same): kicks are ordered by `--kick` and
    /// team.toml alone.
    #[arg(long)]
    no_learning: bool,
    #[command(flatten)]
    cases: CasesArgs,
    /// Record the match as NAME.log.gz (for the league's tools) and NAME.trace (for `onetwo replay`).
    #[arg(short, long, value_name = "NAME")]
    record: Option<PathBuf>,
    /// The robot's description, a file or a built-in name: refused where it is not the one that this program
    /// is built for (docs/robots.md).
    #[arg(long, value_name = "FILE")]
    robot: Option<String>,
    /// Run without the page.
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    page: PageArgs,
    /// Viewers of the page may change parameters while robots play (kick gains, limits of the drives,
    /// tactics, the ball), save them to the file of --config, test kickers and drive a robot by hand; without
    /// this they may ask for HALT only.
    #[arg(long, conflicts_with = "headless")]
    live_parameters: bool,
    /// Power on the radio's channels, as `onetwo robot scan --json` printed it before the match: the page's
    /// tab Health plots it, with our channel marked.
    #[arg(long, value_name = "FILE", conflicts_with = "headless")]
    scan: Option<PathBuf>,
    /// Print our robots at a glance every so many seconds: cameras, radio, battery, faults, and what is not
    /// as it should be.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    glance: Option<f64>,
    /// End after this number of seconds; else Ctrl-C ends it, and robots are halted first.
    #[arg(short, long, value_name = "SECONDS", value_parser = seconds)]
    duration: Option<f64>,
}

/// Which cases robots in a simulator retrieve, and how; the page explains by them. Robots on a field have
/// theirs in flash.
#[derive(Debug, Args)]
pub(crate) struct CasesArgs {
    #[command(flatten)]
    directory: DirectoryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

pub(crate) fn run(args: &ControlArgs) -> Result<ExitCode, Failure> {
    ensure_built_for(args.robot.as_deref())?;
    let config = configure(args)?;
    if args.print_config {
        print_text(&config.to_toml())?;
        return Ok(ExitCode::SUCCESS);
    }
    if let Some(path) = &args.init {
        destination::write_new(path, &config.to_toml())
            .map_err(|error| ControlError::Init(path.clone(), error))?;
        note!("the team's settings are in {}", printable_path(path));
        return Ok(ExitCode::SUCCESS);
    }
    let inputs = [&args.config, &args.key_file, &args.learned, &args.cases.directory.library, &args.scan];
    let inputs: Vec<_> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    check_recording(args.record.as_deref(), &inputs)?;
    if let Some(learned) = &args.learned {
        destination::check(&[(learned, FileKind::Toml)], args.key_file.as_deref().as_slice())?;
    }
    let by_default = Parameters::of(config.league).map_or(0, |parameters| parameters.robots);
    let robots = match &args.ids {
        Some(RobotIds(ids)) => ids.clone(),
        None => (0..by_default).filter_map(RobotId::new).collect(),
    };
    let cases = Cases::choose(&args.cases, config.league)?;
    let spectrum = args.scan.as_deref().map(Spectrum::read).transpose()?;
    let channel = config.air.channel_of(TeamId::of(config.colour));
    let page_settings = (!args.headless).then_some(PageSettings {
        args: &args.page,
        live_parameters: args.live_parameters,
        library: cases.library_handle,
        retrieval: cases.settings,
        spectrum: spectrum.map(|spectrum| spectrum.to_page(channel)),
    });
    let settings = RunSettings {
        config: &config,
        program: Program {
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("ONETWO_COMMIT"),
            image: option_env!("ONETWO_IMAGE_SOURCES"),
        },
        learns: !args.no_learning,
        cases: cases.library_handle.as_ref().map(LibraryHandle::lasting_base),
        virtual_robots: VirtualRobots { ids: robots, arguments: cases.robot_arguments },
        remote: args.remote,
        output: OutputFiles {
            record: args.record.as_deref(),
            learned: args.learned.as_deref(),
            config: args.config.as_deref(),
        },
        duration: args.duration,
    };
    let mut operator =
        ControlOperator::new(&config, args.config.clone(), page_settings).glancing(args.glance);
    host::run::run(&settings, &mut operator, stopped_by_hand())?;
    Ok(ExitCode::SUCCESS)
}

/// The case library, and what retrieval is set to.
struct Cases {
    library_handle: Option<LibraryHandle>,
    settings: casebase::RetrievalSettings,
    /// Flags that pass both on to virtual robots.
    robot_arguments: Vec<OsString>,
}

impl Cases {
    fn choose(args: &CasesArgs, league: rules::League) -> Result<Self, Failure> {
        let library = args.directory.library.as_deref();
        let named = library.map(|directory| [OsString::from("--library"), directory.into()]);
        let set = |(name, value): &(String, String)| ["--set".into(), format!("{name}={value}").into()];
        Ok(Self {
            library_handle: library::of_league(league, library)?,
            settings: args.settings.choose()?.settings,
            robot_arguments: named
                .into_iter()
                .flatten()
                .chain(args.settings.given().iter().flat_map(set))
                .collect(),
        })
    }
}

/// A file of settings.
fn read(path: &Path) -> Result<TeamSettings, Failure> {
    let text = foreign::read_text(path, CONFIG_LEN_MAX)
        .map_err(|error| ControlError::ConfigUnreadable(path.to_owned(), error))?;
    Ok(TeamSettings::from_toml(&text).map_err(|error| ControlError::ConfigFile(path.to_owned(), error))?)
}

/// Flags override the file, which overrides the defaults.
fn configure(args: &ControlArgs) -> Result<TeamConfig, Failure> {
    let mut file = args.config.as_deref().map_or_else(|| Ok(TeamSettings::default()), read)?;
    if let Some(learned) = args.learned.as_deref().filter(|path| args.config.as_deref() != Some(*path))
        && learned.exists()
    {
        // The team's own settings come later, and override.
        let TeamSettings { calibration, ball, .. } = read(learned)?;
        file.calibration = [calibration, file.calibration].concat();
        file.ball.roll = file.ball.roll.or(ball.roll);
    }
    let flags = TeamSettings {
        name: args.name.clone(),
        colour: args.colour.clone(),
        league: args.league.clone(),
        keeper: args.keeper,
        interface: args.interface.clone(),
        robots: args.robots.clone(),
        key_file: args.key_file.clone(),
        insecure_zero_key: args.insecure_zero_key.then_some(true),
        vision: args.vision,
        referee: args.referee,
        referee_source: args.referee_source.clone(),
        referee_silence: args.referee_silence.clone(),
        tracker: args.tracker,
        tracker_in: args.tracker_in.clone(),
        game_controller: args.game_controller,
        strategy: args.strategy.clone(),
        calibration: args.kicks.clone(),
        ..TeamSettings::default()
    };
    let settings = flags.over(file);
    let reported = settings.vision.is_some();
    let mut config = settings.complete()?;
    if !reported && matches!(config.robots, RobotLink::Simulator(_)) {
        config.vision = addresses::VISION_SIMULATED.into();
    }
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn case_flags_reach_virtual_robots() {
        #[derive(Debug, clap::Parser)]
        struct Line {
            #[command(flatten)]
            cases: CasesArgs,
        }
        let line = <Line as clap::Parser>::parse_from(["control", "--set", "free_path=fuzzy"]);
        let cases = Cases::choose(&line.cases, rules::League::DivisionB).unwrap();
        assert_eq!(cases.robot_arguments, ["--set", "free_path=fuzzy"].map(OsString::from));
        let line = <Line as clap::Parser>::parse_from(["control", "--library", "/nowhere"]);
        assert!(Cases::choose(&line.cases, rules::League::DivisionB).is_err());
    }
}
