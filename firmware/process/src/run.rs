//! `run`: main loop of a virtual robot. One socket for host and simulator, one thread, the system's clock.

use std::io::{self, BufRead as _};
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as Clock};

use brain::BrainConfig;
use casebase::CaseBase;
use protocol::Instant;
use protocol::frame::RobotKeys;

use crate::robot::VirtualRobot;

/// Identity of the robot, and its peers.
#[derive(Clone, Debug)]
pub struct Options {
    /// Configuration of its brain.
    pub brain: BrainConfig,
    /// Radio keys: one with the host, one with the team.
    pub keys: RobotKeys,
    /// Address of the host.
    pub host: SocketAddr,
    /// The simulator's port for this team's robots: 10301 blue, 10302 yellow.
    pub simulator: SocketAddr,
}

/// Regular end of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessEnd {
    /// The parent process requested it.
    Asked,
}

/// Reason why a robot cannot run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A socket could not be opened.
    #[error("the robot has no socket: {0}")]
    Socket(#[source] io::Error),
}

/// A flag that is raised when standard input closes: the parent process has gone, or requests the end.
pub fn parent_gone() -> Arc<AtomicBool> {
    let gone = Arc::new(AtomicBool::new(false));
    let raised = gone.clone();
    std::thread::spawn(move || {
        let mut line = String::new();
        while io::stdin().lock().read_line(&mut line).is_ok_and(|len| len > 0) {
            line.clear();
        }
        raised.store(true, Ordering::Relaxed);
    });
    gone
}

/// Runs the robot until `end` is raised.
pub fn run(options: &Options, base: CaseBase<'_>, end: &AtomicBool) -> Result<ProcessEnd, RunError> {
    let local = |address: &SocketAddr| address.ip().is_loopback();
    let any: SocketAddr = match options.simulator {
        SocketAddr::V4(_) if local(&options.host) && local(&options.simulator) => ([127, 0, 0, 1], 0).into(),
        SocketAddr::V4(_) => ([0, 0, 0, 0], 0).into(),
        SocketAddr::V6(_) => ([0_u16; 8], 0).into(),
    };
    let socket = UdpSocket::bind(any).map_err(RunError::Socket)?;
    let start = Clock::now();
    let now = || Instant(start.elapsed().as_micros() as u64);
    let mut robot = VirtualRobot::new(now(), &options.brain, base, options.keys);
    let mut bytes = [0; LEN_MAX];
    while !end.load(Ordering::Relaxed) {
        let wait = robot.poll_timeout().since(now());
        socket
            .set_read_timeout(Some(Duration::from_micros(wait.0).max(WAIT_MIN)))
            .map_err(RunError::Socket)?;
        // A time-out, or a peer that does not listen yet: both pass.
        if let Ok((len, from)) = socket.recv_from(&mut bytes) {
            let datagram = bytes.get(..len).unwrap_or(&[]);
            if from == options.host {
                robot.handle_frame(now(), datagram);
            } else if from.port() == options.simulator.port() {
                robot.handle_response(now(), datagram);
            }
        }
        robot.handle_timeout(now());
        while let Some(frame) = robot.poll_frame(now()) {
            let _ = socket.send_to(&frame, options.host);
        }
        if let Some(control) = robot.poll_control() {
            let _ = socket.send_to(&control, options.simulator);
        }
    }
    Ok(ProcessEnd::Asked)
}

/// The longest datagram that is read: the league's programs send no longer ones.
const LEN_MAX: usize = 8192;
/// The shortest time-out that a socket accepts.
const WAIT_MIN: Duration = Duration::from_micros(1);
