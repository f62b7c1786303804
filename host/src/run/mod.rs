//! `run`: a whole host by one call: sockets and links opened, a thread for each, one loop that feeds the host
//! what arrives and sends its output (docs/architecture.md §3).
//!
//! [`Host`] is a value without sockets; here is what stands around it, for programs that lead
//! robots. Nothing that is missing ends the loop: it reports what it waits for, and goes on when that
//! arrives. What an operator sees and asks for goes through [`Operator`]. Times on the host's clock, which is
//! 0 when the loop starts.

mod alarms;
mod event_loop;
mod failure;
mod identity;
mod inbox;
mod port_for_teams;
mod radio_alarms;
mod remote_thread;
mod requests;
mod threads;
mod tracker_input;
mod tuning;
mod watch;

use std::ffi::OsString;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use casebase::CaseBase;
use protocol::{Instant, RobotId, TeamId};
use rules::Colour;
use ssl::net::{addresses, resolve_destination};

use crate::Host;
use crate::config::{ParameterChange, RobotLink, TeamConfig};
use crate::health_checks::Finding;
use crate::referee::remote::{RemoteRequest, RemoteState};
use crate::robot_test::TestOrder;
use crate::shell::{Link, SimSettings};

pub use failure::RunError;
pub use identity::{PublicKey, real_epoch};
pub use requests::{change_text, test_text};
pub use tuning::CONFIG_LEN_MAX;

/// What a host is run with.
pub struct RunSettings<'a> {
    /// The team, and the addresses to receive from and send to.
    pub config: &'a TeamConfig,
    /// Name, version and commit of the program, for recordings.
    pub program: Program<'a>,
    /// The host plays by what it learns of kickers, latencies and the ball.
    pub learns: bool,
    /// The cases that robots play, where the host is to understand them.
    pub cases: Option<CaseBase<'static>>,
    /// Robots that are started as processes in a simulator, and flags for them.
    pub virtual_robots: VirtualRobots,
    /// The game controller's port for remote controls; `None`: there is no remote control.
    pub remote: Option<SocketAddr>,
    /// Files that are written.
    pub output: OutputFiles<'a>,
    /// Time after which the loop ends, s; none: until it is stopped.
    pub duration: Option<f64>,
}

/// The program that runs a host.
#[derive(Clone, Copy, Debug)]
pub struct Program<'a> {
    /// Its version.
    pub version: &'a str,
    /// The commit that it was built from.
    pub commit: &'a str,
    /// Hash of the sources of the robots' images, hexadecimal; `None`: unknown.
    pub image: Option<&'a str>,
}

/// Robots that this program starts in a simulator, each as a process of the program's own file.
#[derive(Clone, Debug, Default)]
pub struct VirtualRobots {
    /// Numbers of the robots.
    pub ids: Vec<RobotId>,
    /// Flags for each of them, such as the library of cases.
    pub arguments: Vec<OsString>,
}

/// Files that are written.
#[derive(Clone, Copy, Debug, Default)]
pub struct OutputFiles<'a> {
    /// Stem of the recording of the match, as `onetwo replay` takes it.
    pub record: Option<&'a Path>,
    /// Learned values, as lines of `team.toml`.
    pub learned: Option<&'a Path>,
    /// The team's file that was read; changed parameters are saved to it.
    pub config: Option<&'a Path>,
}

/// What an operator asks for while robots play.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// All robots stand until the end.
    Halt,
    /// A parameter of the team changes.
    Change(ParameterChange),
    /// The test of a kicker starts or ends.
    Test(TestOrder),
    /// Changed parameters are saved to the team's file.
    Save,
    /// Our team's remote control asks the game controller for something.
    Remote(RemoteRequest),
}

/// Whoever watches a host that runs: a terminal, a page, or nobody. Calls must return at once: the thread
/// that leads robots makes them.
pub trait Operator {
    /// Everything is open, and the loop starts.
    fn started(&mut self) {}
    /// A line for the operator: what is waited for, what arrives, alarms.
    fn line(&mut self, line: String);
    /// The state in one line, ten times a second.
    fn status(&mut self, _status: String) {}
    /// A datagram of the vision was handled.
    fn vision(&mut self, _bytes: &[u8]) {}
    /// A datagram of the referee was handled.
    fn referee(&mut self, _now: Instant, _bytes: &[u8]) {}
    /// Time that the host took for an input.
    fn took(&mut self, _time: std::time::Duration) {}
    /// A fault of radio or robots.
    fn fault(&mut self, _now: Instant, _fault: String) {}
    /// A parameter was changed.
    fn changed(&mut self) {}
    /// State of our team by the game controller's port for remote controls; `None`: no connection.
    fn remote(&mut self, _state: Option<&RemoteState>) {}
    /// The host after an input, with what does not fit at the moment.
    fn look(&mut self, _now: Instant, _host: &Host, _findings: &[Finding]) {}
    /// The next request, if there is one.
    fn next_request(&mut self) -> Option<Request> {
        None
    }
    /// Why the last request is refused.
    fn refuse(&mut self, _reason: String) {}
    /// Robots are halted, and the loop has ended; only lines follow.
    fn ended(&mut self) {}
}

/// Runs a host until `stopped` is set, then halts the robots.
pub fn run(
    settings: &RunSettings<'_>,
    operator: &mut dyn Operator,
    stopped: &AtomicBool,
) -> Result<(), RunError> {
    let key = identity::team_key(settings.config, operator)?;
    let link = open_link(settings, key)?;
    event_loop::run(settings, key, link, operator, stopped)
}

fn open_link(settings: &RunSettings<'_>, key: protocol::frame::TeamKey) -> Result<Box<dyn Link>, RunError> {
    let config = settings.config;
    let simulator = match &config.robots {
        RobotLink::Simulator(host) => simulator(host, config.colour)?,
        RobotLink::Udp(_) | RobotLink::Serial { .. } => ([127, 0, 0, 1], 0).into(),
    };
    let program: PathBuf = std::env::current_exe().map_err(RunError::Program)?;
    let start = |_: &str| SimSettings {
        program,
        colour: config.colour,
        league: config.league,
        robots: settings.virtual_robots.ids.clone(),
        simulator,
        key,
        more: settings.virtual_robots.arguments.clone(),
    };
    let team = TeamId::of(config.colour);
    Ok(crate::shell::open(&config.robots, (team, config.air.plan(team, key)), start)?)
}

/// Address where a simulator takes a team's commands: `HOST[:PORT]` names its control port.
fn simulator(host: &str, colour: Colour) -> Result<SocketAddr, RunError> {
    let offset = match colour {
        Colour::Blue => 1,
        Colour::Yellow => 2,
    };
    let control = resolve_destination(host, Some(addresses::SIMULATOR_PORT)).ok();
    let port =
        control.and_then(|control| Some(SocketAddr::new(control.ip(), control.port().checked_add(offset)?)));
    port.ok_or_else(|| RunError::UnknownSimulator(host.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_simulator_s_ports_follow_its_control_port() {
        let port = |host, colour| simulator(host, colour).map(|address| address.port()).ok();
        assert_eq!(port("127.0.0.1", Colour::Blue), Some(10301));
        assert_eq!(port("127.0.0.1:20300", Colour::Yellow), Some(20302));
        assert_eq!(port("[::1]", Colour::Blue), Some(10301));
        assert_eq!(port("localhost", Colour::Yellow), Some(10302));
        assert_eq!(port("127.0.0.1:x", Colour::Blue), None);
        assert_eq!(port("127.0.0.1:65535", Colour::Blue), None);
    }
}
