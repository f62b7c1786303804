//! `onetwo simulate`: a Small Size field that any team's software can play on, by the league's simulation
//! protocol (docs/architecture.md §7.3).
//!
//! [`hil_sim::small_size::network`] has sockets, clock and referee; here are the flags, the terminal and the
//! page.

mod dashboard;
mod spectator;

use std::net::SocketAddr;
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

use clap::{Args, ValueEnum};
use hil_sim::ParameterError;
use hil_sim::small_size::NoiseParameters;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::network::{self, ControllerChoice, NetworkSettings, RefereeKind};
use hil_sim::small_size::server::ServerSettings;
use hil_sim::small_size::worlds::{WorldChoice, WorldModel};
use rules::League;
use ssl::net::addresses;
use thiserror::Error;

use crate::Failure;
use crate::args::parsers::{
    address, cameras, controller, destination, field_speed, league, machine, referee, seconds,
};
use crate::robot_description;
use crate::stop::stopped_by_hand;
use spectator::FieldOperator;

/// What is simulated, and the addresses to receive from and send to.
#[derive(Debug, Args)]
pub(crate) struct SimulateArgs {
    /// Field, robots and rules: ssl-2013, division-b or division-a.
    #[arg(long, value_name = "NAME", default_value = "division-b", value_parser = league)]
    league: League,
    /// Robots of each team; the league's number by default.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=16))]
    robots: Option<u8>,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Simulated seconds a second; clients change it by the protocol.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = field_speed)]
    speed: f32,
    /// Compatibility profile: how it behaves on the wire, as itself or as another simulator, to test a
    /// program against.
    #[arg(long, value_enum, default_value_t = ProfileLabel::Ours)]
    profile: ProfileLabel,
    /// Which world of the family is simulated: nominal, grsim, erforce, erforce-none, sumatra, slow-dribbler,
    /// poor-vision, weak-kickers or random:SEED (docs/fields.md). A profile other than ours has cameras and
    /// noise of its own.
    #[arg(long, value_name = "WORLD", default_value_t)]
    world: WorldChoice,
    /// Cameras: 1, 2 or 4; by default the league's or the profile's number.
    #[arg(long, value_name = "N", value_parser = cameras)]
    cameras: Option<u32>,
    /// Without noise: vision sees everything as it is.
    #[arg(long)]
    ideal: bool,
    /// Destination of vision: a multicast group, or one machine.
    #[arg(long, value_name = "HOST:PORT", default_value_t = addresses::VISION_SIMULATED.into(), value_parser = destination)]
    vision: SocketAddr,
    /// The control port; blue's robots are at the next one, yellow's at the one after. 0: any three that are
    /// free.
    #[arg(long, value_name = "PORT", default_value_t = addresses::SIMULATOR_PORT, value_parser = clap::value_parser!(u16).range(0..=65533))]
    ports: u16,
    /// Step the field by TCP instead of by the clock: blue's port, yellow's is the next one (the simulation
    /// protocol's SimulationSyncRequest, each after its length). 0: any two that are free.
    #[arg(long, value_name = "HOST:PORT", value_parser = address)]
    sync: Option<SocketAddr>,
    /// Address that accepts control; with 127.0.0.1 other machines have no access.
    #[arg(long, value_name = "HOST", default_value = "0.0.0.0", value_parser = machine)]
    listen: std::net::IpAddr,
    /// The interface that multicast leaves by, its name or address; the system's choice by default.
    #[arg(long, value_name = "NAME")]
    interface: Option<String>,
    /// Source of referee messages: internal, none, or the ADDRESS:PORT of a game controller's packets, to be
    /// displayed beside the field.
    #[arg(long, value_name = "WHO", default_value = "internal", value_parser = referee)]
    referee: RefereeKind,
    /// With `--referee none` or an address: do the human's tasks that the game controller asks for: put the
    /// ball, take robots off, bring them back. Each action is reported in a line.
    #[arg(long)]
    assistant: bool,
    /// With `--referee none` or an address: report game events to that game controller as an automatic
    /// referee; port 10007 by default. With --assistant it also decides about goals.
    #[arg(long, value_name = "HOST[:PORT]", value_parser = controller)]
    autoref: Option<String>,
    /// Play under the league's game controller in its CI mode, which this field's clock leads: its program,
    /// which is started for it, or the HOST:PORT of one that runs.
    #[arg(long, value_name = "PATH|HOST:PORT", conflicts_with_all = ["referee", "assistant", "autoref"])]
    game_controller: Option<ControllerChoice>,
    /// Destination of the packets of the internal referee, or of the --game-controller.
    #[arg(long, value_name = "HOST:PORT", default_value_t = addresses::REFEREE.into(), value_parser = destination)]
    referee_to: SocketAddr,
    /// Send the output of our own tracker, too: the league's address is 224.5.23.2:10010.
    #[arg(long, value_name = "HOST:PORT", value_parser = destination)]
    tracker: Option<SocketAddr>,
    /// The description of the robots that are simulated, both teams': a file or a built-in name; by default
    /// the one that this program is built for (docs/robots.md).
    #[arg(long, value_name = "FILE")]
    robot: Option<String>,
    /// Run without the page.
    #[arg(long)]
    headless: bool,
    /// Address of the page; it is reachable from other machines only if an address other than the loopback is
    /// given.
    #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:8080", value_parser = address)]
    page: SocketAddr,
    /// End after this number of seconds; else Ctrl-C ends it.
    #[arg(short, long, value_name = "SECONDS", value_parser = seconds)]
    duration: Option<f64>,
}

impl SimulateArgs {
    /// grSim's own port for commands, with the profile of grSim; with 0 for the ports any free port.
    fn legacy_port(&self) -> Option<u16> {
        let number = if self.ports == 0 { 0 } else { addresses::GRSIM_PORT };
        matches!(self.profile, ProfileLabel::Grsim).then_some(number)
    }
}

/// A profile on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ProfileLabel {
    /// This simulator's own behaviour.
    Ours,
    /// As grSim: four cameras at once, its own time base, no noise.
    Grsim,
    /// As ER-Force's simulator: one camera, geometry with every frame, answers that get lost.
    ErForce,
}

pub(crate) fn run(args: &SimulateArgs) -> Result<ExitCode, Failure> {
    if args.referee == RefereeKind::Internal && (args.assistant || args.autoref.is_some()) {
        return Err(SimulateError::InternalReferee.into());
    }
    let robot = robot_description::simulated(args.robot.as_deref())?;
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let profile = match args.profile {
        ProfileLabel::Ours => Profile::Ours,
        ProfileLabel::Grsim => Profile::Grsim,
        ProfileLabel::ErForce => Profile::ErForce,
    };
    let settings = ServerSettings::of(args.league, profile, args.seed, unix.as_secs_f64());
    let no_rules = || SimulateError::NotOnWheels(args.league);
    let mut settings = settings.ok_or_else(no_rules)?;
    settings.model = WorldModel::with_robot(args.league, &args.world, &robot).ok_or_else(no_rules)?;
    settings.model.check().map_err(SimulateError::Robot)?;
    settings.robots = args.robots.unwrap_or(settings.robots);
    settings.vision_port = args.vision.port();
    if let Some(count) = args.cameras {
        settings.model.parameters.camera.count = count;
    }
    if args.ideal {
        settings.model.parameters.noise = NoiseParameters::NONE;
    }
    let title = format!(
        "simulating {}, {robots} v {robots} robots, world {}, seed {}; Ctrl-C ends it",
        args.league.name(),
        settings.model.name,
        args.seed,
        robots = settings.robots,
    );
    let network = NetworkSettings {
        server: settings,
        unix_us: unix.as_micros() as u64,
        robots: args.robots,
        speed: args.speed,
        listen: args.listen,
        port: args.ports,
        legacy_port: args.legacy_port(),
        sync: args.sync,
        vision: args.vision,
        interface: args.interface.clone(),
        referee: args.referee,
        referee_to: args.referee_to,
        assistant: args.assistant,
        autoref: args.autoref.clone(),
        controller: args.game_controller.clone(),
        duration: args.duration,
    };
    network::run(&network, &mut FieldOperator::new(args, title), stopped_by_hand())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Debug, Error)]
enum SimulateError {
    #[error(
        "--assistant and --autoref serve a game controller elsewhere, and the internal referee needs neither; add \
         --referee none, or the ADDRESS:PORT of its packets"
    )]
    InternalReferee,
    #[error("the robot of --robot does not fit this world: {0}; change its description")]
    Robot(ParameterError),
    #[error("{} is not played on wheels", .0.name())]
    NotOnWheels(League),
}
