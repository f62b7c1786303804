//! `port_for_teams`: the game controller's port for teams: a connection that is reopened when lost, around
//! [`TeamPort`], which holds the protocol.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::referee::team_port::{TeamPort, TeamPortEvent, TeamPortRequest};
use foreign::excerpt;
use protocol::RobotId;
use rules::Colour;

use super::inbox::{Inbox, Mail};
use super::threads::sleep;

/// Longest time that reading an open connection may block before the clock is checked.
const READ_WAIT: Duration = Duration::from_millis(100);
/// Time for a connection attempt; without an answer by then the controller counts as absent.
const CONNECT_TIME: Duration = Duration::from_secs(1);

/// Registers us, asks for our keeper, and for what the host asks by `asked`.
pub(super) fn talk(
    address: SocketAddr,
    (name, colour, keeper): (String, Colour, RobotId),
    asked: Receiver<TeamPortRequest>,
    mail: Arc<Inbox>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut port = TeamPort::new(name, colour);
        let began = Instant::now();
        let now = || protocol::Instant(began.elapsed().as_micros() as u64);
        let mut stream: Option<TcpStream> = None;
        let mut last = None;
        port.ask(TeamPortRequest::Keeper(keeper), now());
        while !end.load(Ordering::Relaxed) {
            if port.wants_connection(now()) {
                stream = connect(address);
                if stream.is_some() { port.connected(now()) } else { port.lost(now()) }
            }
            let open = stream.as_mut().is_some_and(|stream| exchange(stream, &mut port, now()));
            if !open && stream.take().is_some() {
                port.lost(now());
            }
            for request in asked.try_iter() {
                port.ask(request, now());
            }
            port.tick(now());
            while let Some(event) = port.poll_event() {
                if matches!(event, TeamPortEvent::GivenUp(_) | TeamPortEvent::RegistrationRefused { .. }) {
                    stream = None;
                }
                let description = description(&event, address);
                // An absent controller is reported once.
                if description.is_some() && description != last {
                    mail.put(Mail::Note(description.clone().unwrap_or_default()));
                    last = description;
                }
            }
            if stream.is_none() {
                sleep(READ_WAIT, &end);
            }
        }
    })
}

fn connect(address: SocketAddr) -> Option<TcpStream> {
    let stream = TcpStream::connect_timeout(&address, CONNECT_TIME).ok()?;
    stream.set_nodelay(true).ok()?;
    stream.set_read_timeout(Some(READ_WAIT)).ok()?;
    stream.set_write_timeout(Some(CONNECT_TIME)).ok()?;
    Some(stream)
}

/// Sends and receives what is pending; false if the connection is gone.
fn exchange(stream: &mut TcpStream, port: &mut TeamPort, now: protocol::Instant) -> bool {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    while let Some(bytes) = port.poll_transmit() {
        if stream.write_all(&bytes).is_err() {
            return false;
        }
    }
    let mut chunk = [0; 4096];
    match stream.read(&mut chunk) {
        Ok(0) => false,
        Ok(bytes) => {
            port.receive(&chunk[..bytes], now);
            true
        }
        Err(error) => matches!(error.kind(), WouldBlock | TimedOut | Interrupted),
    }
}

/// Longest reason that is printed, characters.
const REASON_LEN: usize = 200;

fn description(event: &TeamPortEvent, address: SocketAddr) -> Option<String> {
    Some(match event {
        TeamPortEvent::Registered { .. } => format!("game controller  at {address} knows us now"),
        TeamPortEvent::RegistrationRefused { reason } => format!(
            "game controller  at {address} will not have us: {}; is our --name the one it shows, and our --colour?",
            excerpt(reason, REASON_LEN)
        ),
        TeamPortEvent::Granted(TeamPortRequest::Ping) => return None,
        TeamPortEvent::Granted(request) => format!("game controller  granted: {request:?}"),
        TeamPortEvent::Refused { request, reason } => {
            format!("game controller  refused {request:?}: {}", excerpt(reason, REASON_LEN))
        }
        TeamPortEvent::GivenUp(trouble) => format!("waiting for the game controller at {address}: {trouble}"),
    })
}
