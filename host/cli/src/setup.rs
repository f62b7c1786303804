//! `setup`: the flags of every verb that plays trials of the first paper.
//!
//! Each is a change to the paper's team, so that `onetwo trial` can replay any trial of an evaluation or of
//! an ablation.

use std::path::Path;

use arena::Setup;
use arena::cases::LibraryHandle;
use brain::Positioning;
use case_tools::Reduction;
use clap::{Args, ValueEnum};

use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs, parsers};
use crate::library;
use crate::output::quoted;

/// The attackers' set-up.
#[derive(Debug, Args)]
pub(crate) struct SetupArgs {
    /// When a case's actions start.
    #[arg(long, value_enum, default_value_t = PositioningLabel::Dependent)]
    positioning: PositioningLabel,
    /// Number of robots that may retrieve; all by default.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=4))]
    retrievers: Option<u8>,
    /// Share of packets lost, 0 to 1.
    #[arg(long, default_value_t = 0.0, value_parser = parsers::share)]
    loss: f32,
    /// Without the mirrored copies of cases: only authored ones are known.
    #[arg(long)]
    no_symmetry: bool,
    /// Without the opponents of cases: they are neither a condition nor a criterion of rank.
    #[arg(long)]
    no_opponents: bool,
    /// As robots: the opponents play on while the attackers stand still after a cycle.
    #[arg(long)]
    opponents_play_on: bool,
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

/// The paper's two positionings, on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PositioningLabel {
    /// As soon as the robot that gets the ball is at its place.
    Dependent,
    /// When all are at their places.
    Independent,
}

impl SetupArgs {
    /// The setup of the flags, for a team of this number of robots.
    pub(crate) fn choose(&self, robots: usize) -> Result<Setup, Failure> {
        Ok(Setup {
            settings: self.settings.choose()?.settings,
            positioning: match self.positioning {
                PositioningLabel::Dependent => Positioning::Dependent,
                PositioningLabel::Independent => Positioning::Independent,
            },
            retrievers: self.retrievers.map_or(robots, usize::from).min(robots),
            loss: self.loss,
            symmetry: !self.no_symmetry,
            opponents: !self.no_opponents,
            opponents_pause: !self.opponents_play_on,
        })
    }

    /// The cases of that set-up; refused if they are of a field that no simulator has.
    pub(crate) fn open(&self, setup: &Setup) -> Result<LibraryHandle, Failure> {
        let library_handle = library::open_reduced(&self.library, reduction(setup))?;
        library_handle.check_field_of_trials()?;
        Ok(library_handle)
    }

    /// True if the firmware contains the cases.
    pub(crate) fn is_built_in(&self) -> bool {
        self.library.directory.library.is_none() && !self.no_symmetry && !self.no_opponents
    }

    /// The directory of the library, if it is none that is built in.
    pub(crate) fn directory(&self) -> Option<&Path> {
        self.library.directory.library.as_deref()
    }

    /// Name of the library: a league's name, or the directory.
    pub(crate) fn library_label(&self) -> String {
        match &self.library.directory.library {
            Some(directory) => directory.display().to_string(),
            None => self.library.league.clone(),
        }
    }

    /// The flags that are not at their defaults, each with a blank before it.
    pub(crate) fn changed_flags(&self) -> String {
        use std::fmt::Write as _;
        let mut flags = String::new();
        if let PositioningLabel::Independent = self.positioning {
            flags.push_str(" --positioning independent");
        }
        if let Some(retrievers) = self.retrievers {
            let _ = write!(flags, " --retrievers {retrievers}");
        }
        if self.loss > 0.0 {
            let _ = write!(flags, " --loss {}", self.loss);
        }
        let switches = [
            ("no-symmetry", self.no_symmetry),
            ("no-opponents", self.no_opponents),
            ("opponents-play-on", self.opponents_play_on),
        ];
        for (flag, given) in switches {
            if given {
                let _ = write!(flags, " --{flag}");
            }
        }
        match &self.library.directory.library {
            Some(directory) => {
                let _ = write!(flags, " --library {}", quoted(&directory.to_string_lossy()));
            }
            None if self.library.league != "four-legged" => {
                let _ = write!(flags, " --league {}", self.library.league);
            }
            None => {}
        }
        for (name, value) in self.settings.given() {
            let _ = write!(flags, " --set {}", quoted(&format!("{name}={value}")));
        }
        flags
    }
}

/// The part of a library that a set-up keeps.
pub(crate) const fn reduction(setup: &Setup) -> Reduction {
    Reduction { symmetry: setup.symmetry, opponents: setup.opponents }
}
