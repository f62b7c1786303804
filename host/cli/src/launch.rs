//! `onetwo launch`: simulator, both teams and, where its program is named, the league's game controller:
//! started with one command, ended with one Ctrl-C (docs/start.md). Each is a process of its own, as when it
//! is started by hand; lines of their output are printed with their name.

use std::io::{self, BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use hil_sim::small_size::network::CiError;
use rules::{Colour, League};
use thiserror::Error;

use crate::Failure;
use crate::args::parsers::{league, seconds};
use crate::output::note;
use crate::stop::stopped_by_hand;

/// Who plays, and where the programs listen.
#[derive(Debug, Args)]
pub(crate) struct LaunchArgs {
    /// Field, robots and rules: ssl-2013, division-b or division-a.
    #[arg(long, value_name = "NAME", default_value = "division-b", value_parser = league)]
    league: League,
    /// Random seed of the simulator.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// The league's game controller, a program; its settings are kept in `config` in this directory. Without
    /// it the simulator's internal referee leads the match.
    #[arg(long, value_name = "PATH")]
    game_controller: Option<PathBuf>,
    /// A program that gives blue's orders (docs/strategy-protocol.md).
    #[arg(long, value_name = "COMMAND")]
    blue_strategy: Option<String>,
    /// The same for yellow.
    #[arg(long, value_name = "COMMAND")]
    yellow_strategy: Option<String>,
    /// Blue is played by software of yours, which this command does not start.
    #[arg(long, conflicts_with = "blue_strategy")]
    own_blue: bool,
    /// The simulator's control port; blue's robots are at the next one, yellow's at the one after.
    #[arg(long, value_name = "PORT", default_value_t = ssl::net::addresses::SIMULATOR_PORT, value_parser = clap::value_parser!(u16).range(1..=65533))]
    ports: u16,
    /// Port of the simulator's page; blue's page is two further, yellow's three.
    #[arg(long, value_name = "PORT", default_value_t = 8080, value_parser = clap::value_parser!(u16).range(1..=65532))]
    pages: u16,
    /// Without pages.
    #[arg(long)]
    headless: bool,
    /// End after this number of seconds; else Ctrl-C ends it.
    #[arg(short, long, value_name = "SECONDS", value_parser = seconds)]
    duration: Option<f64>,
}

/// A program ended before the others.
#[derive(Debug, Error)]
#[error("{name} has ended ({status}), and the others with it; its last lines are above")]
struct Ended {
    name: &'static str,
    status: ExitStatus,
}

pub(crate) fn run(args: &LaunchArgs) -> Result<ExitCode, Failure> {
    let stopped = stopped_by_hand();
    let until = args.duration.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    let mut programs = Programs(Vec::new());
    args.start(&mut programs)?;
    let mut ended = None;
    while ended.is_none()
        && !stopped.load(Ordering::Relaxed)
        && until.is_none_or(|until| Instant::now() < until)
    {
        ended = programs.ended();
        thread::sleep(LOOK_EVERY);
    }
    // A terminal's Ctrl-C has reached all of them, and a second signal would end them at once.
    if !stopped.load(Ordering::Relaxed) {
        programs.interrupt();
    }
    programs.end();
    ended.map_or(Ok(ExitCode::SUCCESS), |ended| Err(ended.into()))
}

impl LaunchArgs {
    /// Starts all of them, and prints where each listens.
    fn start(&self, programs: &mut Programs) -> Result<(), Failure> {
        if let Some(program) = &self.game_controller {
            let mut controller = Command::new(program);
            controller.args(["-visionAddress", &ssl::net::addresses::VISION_SIMULATED.to_string()]);
            programs
                .start(CONTROLLER, controller)
                .map_err(|error| CiError::NoProgram(program.display().to_string(), error))?;
            note!(
                "{CONTROLLER}  page http://localhost:8081: choose the division, the names Blue and Yellow, and blue's \
                 goal at −x; then press STOP"
            );
        }
        programs.start("simulator", self.simulator()?)?;
        note!(
            "simulator  control port {}, robots {} blue and {} yellow{}",
            self.ports,
            self.ports + 1,
            self.ports + 2,
            self.page(0)
        );
        for (colour, page) in [(Colour::Blue, BLUE_PAGE), (Colour::Yellow, YELLOW_PAGE)] {
            if colour == Colour::Blue && self.own_blue {
                note!("blue  yours: send to 127.0.0.1:{}", self.ports + 1);
                continue;
            }
            programs.start(colour.label(), self.team(colour, page)?)?;
            note!("{}  onetwo control{}", colour.label(), self.page(page));
        }
        note!("Ctrl-C ends all of them");
        Ok(())
    }

    fn page(&self, further: u16) -> String {
        if self.headless {
            String::new()
        } else {
            format!(", page http://127.0.0.1:{}", self.pages + further)
        }
    }

    fn simulator(&self) -> Result<Command, Failure> {
        let mut simulator = own()?;
        simulator.args(["simulate", "--league", self.league.name(), "--seed", &self.seed.to_string()]);
        simulator.args(["--ports", &self.ports.to_string()]);
        if self.game_controller.is_some() {
            let tracker = ssl::net::addresses::TRACKER.to_string();
            simulator.args([
                "--referee",
                "none",
                "--assistant",
                "--autoref",
                "127.0.0.1",
                "--tracker",
                &tracker,
            ]);
        }
        self.paged(&mut simulator, "--page", 0);
        Ok(simulator)
    }

    fn team(&self, colour: Colour, page: u16) -> Result<Command, Failure> {
        let mut team = own()?;
        let link = format!("sim://127.0.0.1:{}", self.ports);
        team.args(["control", "--robots", &link, "--league", self.league.name(), "--colour", colour.label()]);
        let (name, strategy) = match colour {
            Colour::Blue => ("Blue", &self.blue_strategy),
            Colour::Yellow => ("Yellow", &self.yellow_strategy),
        };
        team.args(["--name", name]);
        if self.game_controller.is_some() {
            team.args(["--game-controller", "127.0.0.1"]);
        }
        if let Some(strategy) = strategy {
            team.args(["--strategy", strategy]);
        }
        self.paged(&mut team, "--listen", page);
        Ok(team)
    }

    fn paged(&self, program: &mut Command, flag: &str, further: u16) {
        if self.headless {
            program.arg("--headless");
        } else {
            program.args([flag, &format!("127.0.0.1:{}", self.pages + further)]);
        }
    }
}

/// This program.
fn own() -> Result<Command, Failure> {
    Ok(Command::new(std::env::current_exe()?))
}

/// The programs that run, each with its name; ended when dropped.
struct Programs(Vec<(&'static str, Child)>);

impl Programs {
    fn start(&mut self, name: &'static str, mut program: Command) -> io::Result<()> {
        program.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = program.spawn()?;
        print_lines(name, child.stdout.take());
        print_lines(name, child.stderr.take());
        self.0.push((name, child));
        Ok(())
    }

    /// The first that has ended.
    fn ended(&mut self) -> Option<Ended> {
        self.0
            .iter_mut()
            .find_map(|(name, child)| child.try_wait().ok().flatten().map(|status| Ended { name, status }))
    }

    /// Asks all that run to end in order, as Ctrl-C does.
    fn interrupt(&self) {
        for (_, child) in &self.0 {
            // Where there is no such program they are ended by [`Drop`].
            let _ =
                Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
        }
    }

    /// Waits until all have ended, teams after they halted their robots; at most [`END_WAIT`].
    fn end(&mut self) {
        let until = Instant::now() + END_WAIT;
        while Instant::now() < until
            && self.0.iter_mut().any(|(_, child)| matches!(child.try_wait(), Ok(None)))
        {
            thread::sleep(LOOK_EVERY);
        }
    }
}

impl Drop for Programs {
    fn drop(&mut self) {
        for (_, child) in &mut self.0 {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Prints lines of a program with its name, until it ends.
fn print_lines(name: &'static str, output: Option<impl Read + Send + 'static>) {
    let Some(output) = output else { return };
    thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            note!("{name} | {line}");
        }
    });
}

/// The controller, as it is named in lines.
const CONTROLLER: &str = "game controller";
/// Ports from the simulator's page to blue's: the one between is the controller's, 8081.
const BLUE_PAGE: u16 = 2;
/// The same to yellow's.
const YELLOW_PAGE: u16 = 3;
/// Time between two looks at what runs.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// Longest time for programs to end in order: a host halts its robots for 0.3 s.
const END_WAIT: Duration = Duration::from_secs(2);
