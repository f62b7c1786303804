//! `verbs`: the command line: its verbs, each with the arguments of its own file (docs/case-format.md §5).

use clap::{Parser, Subcommand};

use crate::args::SHORT_VERSION;
use crate::cases::CasesVerb;
use crate::control::ControlArgs;
use crate::evaluate::EvaluateArgs;
use crate::firmware::FirmwareVerb;
use crate::launch::LaunchArgs;
use crate::output::ColorChoice;
use crate::play::PlayArgs;
use crate::remote::RemoteArgs;
use crate::replay::ReplayArgs;
use crate::robot::RobotVerb;
use crate::simulate::SimulateArgs;
use crate::trial::TrialArgs;
use crate::virtual_robot::VirtualRobotArgs;

/// Case-based robot soccer: robots that choose a gameplay together and play it.
#[derive(Debug, Parser)]
#[command(name = "onetwo", version = SHORT_VERSION, arg_required_else_help = true)]
pub(crate) struct Cli {
    /// Colour errors on the terminal.
    #[arg(long, value_name = "WHEN", global = true, default_value = "auto")]
    pub(crate) color: ColorChoice,
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

/// One verb, one file.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Play a match of the Small Size League in the simulator: two teams, a referee, and a report.
    Play(PlayArgs),
    /// One trial of the paper.
    Trial(TrialArgs),
    /// Evaluate: the paper's tables, thousands of trials, beside the paper's measurements.
    Evaluate(Box<EvaluateArgs>),
    /// The host of a team on the league's network: vision and referee in, commands to robots out.
    Control(Box<ControlArgs>),
    /// A team's remote control at the game controller: timeout, emergency stop, challenge flag, substitution,
    /// keeper.
    Remote(RemoteArgs),
    /// Inspect a recorded match: its contents, the field at a moment, and whether the hosts decide the same
    /// again.
    Replay(Box<ReplayArgs>),
    /// A Small Size field for any team's software: vision out, the league's simulation protocol in, a referee
    /// beside it.
    Simulate(Box<SimulateArgs>),
    /// Start a simulator, both teams and, if its program is named, the league's game controller, with one
    /// command.
    Launch(LaunchArgs),
    /// Check, list, show, retrieve and explain cases.
    Cases {
        #[command(subcommand)]
        verb: CasesVerb,
    },
    /// The robots' firmware: build, size, run under QEMU, flash, provision.
    Firmware {
        #[command(subcommand)]
        verb: FirmwareVerb,
    },
    /// A robot's description, robot.toml: check it, show it with what follows from it, fit it to
    /// measurements.
    Robot {
        #[command(subcommand)]
        verb: RobotVerb,
    },
    /// One robot's brain as a process, in any simulator of the league; `control` starts them.
    #[command(hide = true)]
    VirtualRobot(Box<VirtualRobotArgs>),
    /// Write manual pages and completions, for release archives.
    #[cfg(feature = "manuals")]
    #[command(hide = true)]
    Manuals(crate::manuals::ManualsArgs),
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
