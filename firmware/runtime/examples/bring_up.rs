//! `bring_up`: plays the checks of a robot's first start on simulated parts with a fault, as a board plays it
//! on its own: `cargo run -p onetwo-runtime --example bring_up -- reversed-motor`.
//!
//! With `--udp 127.0.0.1:10400 --page robot.page` it waits there for a host, plays them in real time and
//! reports them as a board does by radio: `onetwo robot bring-up --robots udp://127.0.0.1:10400 …` shows
//! them.

use std::net::{SocketAddr, UdpSocket};
use std::process::ExitCode;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use protocol::TeamId;
use protocol::bring_up::{CheckReport, Reporter};
use protocol::provision;
use runtime::bring_up::bench::{Fault, play_steps};
use runtime::bring_up::{Listener, REPORT_EVERY, Results};

const USAGE: &str = "usage: bring_up [FAULT] [--udp ADDRESS:PORT --page FILE]";

fn main() -> ExitCode {
    match run() {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

/// How many checks failed.
fn run() -> Result<u32, String> {
    let (mut asked, mut udp, mut page) = ("none".to_owned(), None, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--udp" => udp = Some(arguments.next().ok_or(USAGE)?),
            "--page" => page = Some(arguments.next().ok_or(USAGE)?),
            flag if flag.starts_with('-') => return Err(USAGE.to_owned()),
            _ => asked = argument,
        }
    }
    let fault = Fault::EXAMPLES.iter().find(|(name, _)| *name == asked).map(|(_, fault)| *fault);
    let fault = fault.ok_or_else(|| {
        let names = Fault::EXAMPLES.map(|(name, _)| name).join(", ");
        format!("{asked}: no such fault; expected one of {names}")
    })?;
    let mut radio = match (udp, page) {
        (Some(address), Some(file)) => Some(Radio::open(&address, &file)?),
        (None, None) => None,
        _ => return Err(USAGE.to_owned()),
    };
    let (mut failed, began, mut steps) = (0, Instant::now(), 0_u32);
    let took = play_steps(fault, 1, |step| {
        if let Some(report) = step.report {
            failed += u32::from(report.result.is_err());
            print(&report);
        }
        if let Some(radio) = &mut radio {
            radio.results.take(step);
            steps += 1;
            let due = Duration::from_millis(u64::from(steps)).saturating_sub(began.elapsed());
            std::thread::sleep(due);
            // A radio that is off sends nothing.
            if fault != Fault::NoRadio && u64::from(steps).is_multiple_of(REPORT_EVERY.0 / 1_000) {
                radio.report();
            }
        }
    });
    println!("{failed} failed; it takes {:.0} s", took.0 as f64 * 1e-6);
    if let Some(mut radio) = radio.filter(|_| fault != Fault::NoRadio) {
        // A board reports them until it is switched off.
        while began.elapsed() < Duration::from_micros(took.0) + REPORT_AFTER_END {
            radio.report();
            std::thread::sleep(Duration::from_micros(REPORT_EVERY.0));
        }
    }
    Ok(failed)
}

fn print(report: &CheckReport) {
    match report.result {
        Ok(value) => println!("pass  {}  ({value:.2})", report.check),
        Err(finding) => println!("FAIL  {}\n      {finding}", report.check),
    }
}

/// A robot's radio and its base station in one: a UDP port.
struct Radio {
    socket: UdpSocket,
    host: SocketAddr,
    listener: Listener,
    team: TeamId,
    results: Results,
}

impl Radio {
    /// Waits for a host.
    fn open(address: &str, page: &str) -> Result<Self, String> {
        let bytes = std::fs::read(page).map_err(|error| format!("{page}: {error}"))?;
        let who = provision::read(&bytes, false).map_err(|error| format!("{page}: {error}"))?;
        let failed = |error| format!("{address}: {error}");
        let socket = UdpSocket::bind(address).map_err(failed)?;
        println!("waiting for a host at udp://{address}");
        let mut bytes = [0; 200];
        let (len, host) = socket.recv_from(&mut bytes).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        let mut listener = Listener::default();
        listener.receive(bytes.get(..len).unwrap_or_default());
        // A board counts its starts in flash.
        let start = SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |unix| unix.as_secs() as u32);
        let reporter = Reporter { team: who.team, robot: who.robot, key: who.keys.host, epoch: start };
        Ok(Self { socket, host, listener, team: who.team, results: Results::new(reporter) })
    }

    fn report(&mut self) {
        let mut bytes = [0; 200];
        while let Ok((len, from)) = self.socket.recv_from(&mut bytes) {
            self.listener.receive(bytes.get(..len).unwrap_or_default());
            self.host = from;
        }
        if let Some(packet) = self.results.packet(self.listener.host_epoch(self.team)) {
            // A host that has ended is no fault of the robot.
            let _ = self.socket.send_to(&packet, self.host);
        }
    }
}

/// Time for which the results are reported after the last check.
const REPORT_AFTER_END: Duration = Duration::from_secs(5);
