//! `controller_process`: the league's game controller as a program of our own: started in CI mode in a
//! directory of its own, ended and cleared away when it is dropped.

use std::fs::{self, File};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use ssl::net::Connection;

use super::failure::CiError;

#[derive(Debug)]
pub(super) struct ControllerProcess {
    child: Child,
    directory: Scratch,
}

/// A directory that is removed with the value.
#[derive(Debug)]
struct Scratch(PathBuf);

impl ControllerProcess {
    /// Starts the program on free ports of this machine with halves of this playing time, s, and connects to
    /// it.
    pub(super) fn start(program: &Path, half_s: u64) -> Result<(Self, Connection), CiError> {
        let name = program.display().to_string();
        let failed = |error| CiError::NoProgram(name.clone(), error);
        let directory = Scratch::new().map_err(failed)?;
        let address = free_port().map_err(failed)?;
        let log = prepare(&directory.0, &settings(address, half_s)).map_err(failed)?;
        // The program runs in its own directory: a path from ours must not depend on that.
        let path =
            if program.components().count() > 1 { fs::canonicalize(program) } else { Ok(program.into()) };
        let child = Command::new(path.map_err(failed)?)
            .arg("-backendOnly")
            .current_dir(&directory.0)
            // With several threads the order of its own acts varies from run to run.
            .env("GOMAXPROCS", "1")
            .stdin(Stdio::null())
            .stdout(log.try_clone().map_err(failed)?)
            .stderr(log)
            .spawn()
            .map_err(failed)?;
        let mut process = Self { child, directory };
        let until = Instant::now() + START_WAIT;
        loop {
            match Connection::open(address, RETRY_AFTER) {
                Ok(link) => return Ok((process, link)),
                Err(_) if process.runs() && Instant::now() < until => thread::sleep(RETRY_AFTER),
                Err(_) => return Err(CiError::NotListening(name, process.last_lines())),
            }
        }
    }

    fn runs(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    fn last_lines(&self) -> String {
        let text = fs::read_to_string(self.directory.0.join(LOG)).unwrap_or_default();
        let lines: Vec<&str> = text.lines().collect();
        if lines.is_empty() {
            return "none".to_owned();
        }
        lines[lines.len().saturating_sub(LINES_SHOWN)..].join(" / ")
    }
}

impl Drop for ControllerProcess {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Scratch {
    fn new() -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("onetwo-controller-{}-{number}", std::process::id()));
        fs::create_dir_all(path.join("config"))?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // What cannot be removed stays in the system's directory for such files.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Writes the controller's settings; returns the file for its output.
fn prepare(directory: &Path, settings: &str) -> io::Result<File> {
    fs::write(directory.join("config/ssl-game-controller.yaml"), settings)?;
    File::create(directory.join(LOG))
}

/// Nothing goes to the network, and ports that the match does not use are any free ones.
fn settings(ci: SocketAddr, half_s: u64) -> String {
    format!(
        "time-acquisition-mode: ci
network:
  publish-address: \"\"
game:
  normal:
    half-duration: {half_s}s
server:
  ci:
    address: {ci}
  auto-ref:
    address: 127.0.0.1:0
  team:
    address: 127.0.0.1:0
  remote-control:
    address: 127.0.0.1:0
"
    )
}

fn free_port() -> io::Result<SocketAddr> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?.local_addr()
}

/// Its output.
const LOG: &str = "controller.log";
/// Lines of its output in an error.
const LINES_SHOWN: usize = 3;
/// Longest time until it listens: 0.2 s usually, and a loaded machine was seen to pause for 1.6 s.
const START_WAIT: Duration = Duration::from_secs(10);
/// Between two attempts to connect.
const RETRY_AFTER: Duration = Duration::from_millis(50);
