//! `running`: a verb of the built program while it runs, and its output on stderr, for the tests of the
//! command line.

#[allow(dead_code, reason = "each test program takes what it needs of it")]
pub(crate) mod controller;
#[allow(dead_code, reason = "each test program takes what it needs of it")]
pub(crate) mod simulator;

use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, UdpSocket};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Generous: a loaded machine is no failure.
pub(crate) const PATIENCE: Duration = Duration::from_mins(1);

/// A port of this machine's own, waited at for [`PATIENCE`] at most.
pub(crate) fn socket() -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
    socket.set_read_timeout(Some(PATIENCE)).expect("a time-out");
    socket
}

/// The address of a port that is free at the moment.
#[allow(dead_code, reason = "each test program takes what it needs of it")]
pub(crate) fn free() -> String {
    socket().local_addr().expect("an address").to_string()
}

/// A running verb; its stderr comes line by line. Ended when dropped.
pub(crate) struct Running {
    pub(crate) process: Child,
    /// The lines' times count from here.
    #[allow(dead_code, reason = "each test program takes what it needs of it")]
    pub(crate) began: Instant,
    lines: Receiver<(Duration, String)>,
    pub(crate) received: Vec<(Duration, String)>,
}

impl Running {
    /// Starts the built program with these arguments.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_onetwo"))
            .args(arguments)
            // The host's epoch is kept there, not in the home of the user that runs the tests.
            .env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"))
            .stdin(Stdio::null())
            .stderr(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .expect("the program starts");
        let (began, description) = (Instant::now(), process.stderr.take().expect("a pipe"));
        let (send, lines) = channel();
        thread::spawn(move || {
            for line in BufReader::new(description).lines().map_while(Result::ok) {
                if send.send((began.elapsed(), line)).is_err() {
                    break;
                }
            }
        });
        Self { process, began, lines, received: Vec::new() }
    }

    /// Waits for a line that contains `description`.
    pub(crate) fn wait_for(&mut self, description: &str) -> (Duration, String) {
        let until = Instant::now() + PATIENCE;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.lines.recv_timeout(left) {
                Ok(line) => {
                    self.received.push(line.clone());
                    if line.1.contains(description) {
                        return line;
                    }
                }
                Err(error) => {
                    panic!("`{description}` was not printed ({error}); printed: {:#?}", self.received)
                }
            }
        }
    }

    /// Ends it as Ctrl-C does.
    #[allow(dead_code, reason = "each test program takes what it needs of it")]
    pub(crate) fn interrupt(&self) {
        let sent = Command::new("kill").args(["-INT", &self.process.id().to_string()]).status();
        assert!(sent.is_ok_and(|status| status.success()), "it has ended already");
    }

    /// The control port that the simulator prints.
    #[allow(dead_code, reason = "each test program takes what it needs of it")]
    pub(crate) fn control_port(&mut self) -> u16 {
        let (_, line) = self.wait_for("control  ");
        let address = line.split_whitespace().nth(1).expect("an address").trim_end_matches(',');
        address.parse::<SocketAddr>().expect("an address").port()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
