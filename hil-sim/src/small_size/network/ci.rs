//! `ci`: connection to a game controller in its CI mode (TCP 10009), as a program started here or at an
//! address.

use std::fmt;
use std::net::ToSocketAddrs as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use ssl::controller::ci::{CiInput, CiOutput};
use ssl::net::Connection;
use ssl::referee::Referee;
use ssl::vision::GeometryData;

use super::controller_process::ControllerProcess;
use super::failure::CiError;
use crate::small_size::referee::remote::CiMatch;
use crate::small_size::referee::{InternalReferee, MatchClock, RefereeSettings};
use crate::small_size::{PhysicsEvent, World};

/// Where the game controller of a match is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ControllerChoice {
    /// A program that is started for the match, and ended with it.
    Program(PathBuf),
    /// A controller in CI mode that listens at `HOST:PORT`.
    Address(String),
}

impl From<&str> for ControllerChoice {
    fn from(text: &str) -> Self {
        let port = text.rsplit_once(':').map(|(_, port)| port.parse::<u16>());
        match port {
            Some(Ok(_)) if !text.contains('/') => Self::Address(text.to_owned()),
            _ => Self::Program(text.into()),
        }
    }
}

impl fmt::Display for ControllerChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Program(path) => write!(f, "{}", path.display()),
            Self::Address(address) => f.write_str(address),
        }
    }
}

/// A match with the connection to its game controller.
pub struct CiController {
    ci: CiMatch,
    link: Connection,
    /// Ends the program when it is dropped.
    _process: Option<ControllerProcess>,
}

impl CiController {
    /// Connects to the chosen controller, or starts it; the match begins with the first call of
    /// [`Self::look`].
    pub fn start(
        choice: &ControllerChoice,
        settings: &RefereeSettings,
        seed: u64,
        geometry: GeometryData,
    ) -> Result<Self, CiError> {
        let ci = CiMatch::new(settings, seed, geometry)?;
        let (link, process) = match choice {
            ControllerChoice::Program(path) => {
                let (process, link) = ControllerProcess::start(path, half_s(settings))?;
                (link, Some(process))
            }
            ControllerChoice::Address(text) => {
                let unknown = |why: String| CiError::Address(text.clone(), why);
                let mut found = text.to_socket_addrs().map_err(|error| unknown(error.to_string()))?;
                let address = found.next().ok_or_else(|| unknown("no address".to_owned()))?;
                (Connection::open(address, CONNECT_WAIT)?, None)
            }
        };
        Ok(Self { ci, link, _process: process })
    }

    /// Observes the world every 10 ms; where an exchange is due the controller decides. `referee` follows it.
    /// Returns the controller's new packets.
    pub fn look(
        &mut self,
        world: &mut World,
        events: &[PhysicsEvent],
        referee: &mut InternalReferee,
    ) -> Result<Vec<Referee>, CiError> {
        self.ci.look(world, events);
        let packets = if self.ci.is_due(world) { self.exchange(world)? } else { Vec::new() };
        referee.follow(&mut self.ci, world, events);
        while let Some(order) = referee.poll_order() {
            order.carry_out(world);
        }
        Ok(packets)
    }

    fn exchange(&mut self, world: &World) -> Result<Vec<Referee>, CiError> {
        if let Some(acts) = self.ci.acts(world) {
            self.ask(&acts)?;
        }
        let tick = self.ci.tick(world);
        self.ask(&tick)?;
        Ok(self.ci.packets(world))
    }

    /// Sends, and receives to the end of the exchange.
    fn ask(&mut self, input: &CiInput) -> Result<(), CiError> {
        self.link.send(input)?;
        let until = Instant::now() + ANSWER_WAIT;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            let Some(output) = self.link.receive::<CiOutput>(left)? else {
                return Err(CiError::Silent { at: self.link.peer(), seconds: ANSWER_WAIT.as_secs() });
            };
            if self.ci.take(output) {
                return Ok(());
            }
        }
    }
}

/// Playing time of a half, s; by simulated time the operator ends a half before the controller would.
fn half_s(settings: &RefereeSettings) -> u64 {
    let half = match settings.clock {
        MatchClock::Playing { half } => half.0,
        MatchClock::Simulated { total } => total.0 / 2,
    };
    half.div_ceil(1_000_000)
}

/// Longest time for a connection.
const CONNECT_WAIT: Duration = Duration::from_secs(5);
/// Longest time for an answer: a loaded machine was seen to pause for 1.6 s.
const ANSWER_WAIT: Duration = Duration::from_secs(10);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_a_port_and_everything_else_is_a_program() {
        for address in ["localhost:10009", "127.0.0.1:10009"] {
            assert_eq!(ControllerChoice::from(address), ControllerChoice::Address(address.to_owned()));
        }
        for program in ["./ssl-game-controller", "ssl-game-controller", "/opt/gc:10009", "a:b"] {
            assert_eq!(ControllerChoice::from(program), ControllerChoice::Program(program.into()));
        }
    }

    #[test]
    fn a_program_that_is_missing_is_named_with_where_to_get_it() {
        let program = std::path::Path::new("/nonexistent/ssl-game-controller");
        let error = ControllerProcess::start(program, 300).expect_err("no program").to_string();
        assert!(error.contains("/nonexistent/ssl-game-controller") && error.contains("releases"), "{error}");
    }
}
