//! `hub`: one simulator socket shared by several robot processes. Some simulators (ER-Force's) answer only
//! the last sender, so the commands of all robots go out through this socket, and its answers go to all of
//! them.
//!
//! Bytes are forwarded undecoded; each process picks its own robot's part.

use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::LinkError;
use super::udp::bind;

/// A robot's process that was silent for this time has ended.
const ROBOT_SILENCE_MAX: Duration = Duration::from_secs(1);
/// Time a thread waits between checks whether it shall end.
const STOP_CHECK_EVERY: Duration = Duration::from_millis(50);
/// The longest datagram that is forwarded: UDP carries no longer one.
const DATAGRAM_LEN_MAX: usize = ssl::stream::DATAGRAM_MAX;

/// Two threads between robots' processes and a simulator; they end when this is dropped.
#[derive(Debug)]
pub(super) struct Hub {
    address: SocketAddr,
    end: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

type Known = Arc<Mutex<Vec<(SocketAddr, Instant)>>>;

impl Hub {
    /// Forwards between processes on this machine and the simulator at that address.
    pub(super) fn start(simulator: SocketAddr) -> Result<Self, LinkError> {
        let system = |error| LinkError::Socket { doing: "open a socket for virtual robots".into(), error };
        let inner = Arc::new(UdpSocket::bind("127.0.0.1:0").map_err(system)?);
        let outer = Arc::new(bind(simulator)?);
        for socket in [&inner, &outer] {
            socket.set_read_timeout(Some(STOP_CHECK_EVERY)).map_err(system)?;
        }
        let address = inner.local_addr().map_err(system)?;
        let (end, known) = (Arc::new(AtomicBool::new(false)), Known::default());
        let out = {
            let (inner, outer, end, known) = (inner.clone(), outer.clone(), end.clone(), known.clone());
            move || {
                pass(&inner, &end, |bytes, from| {
                    remember(&known, from);
                    // The simulator is not running yet, or a queue is full: the next command follows within
                    // 10 ms.
                    let _ = outer.send_to(bytes, simulator);
                });
            }
        };
        let back = {
            let end = end.clone();
            move || {
                pass(&outer, &end, |bytes, from| {
                    let known = known.lock().unwrap_or_else(PoisonError::into_inner);
                    for (robot, _) in known.iter().filter(|_| from.port() == simulator.port()) {
                        let _ = inner.send_to(bytes, robot);
                    }
                });
            }
        };
        let threads = vec![spawn("hub-out", out)?, spawn("hub-back", back)?];
        Ok(Self { address, end, threads })
    }

    /// Address to which robots' processes send commands for the simulator.
    pub(super) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Hub {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, LinkError> {
    thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
        .map_err(|error| LinkError::Socket { doing: "start a thread for virtual robots".into(), error })
}

fn pass(socket: &UdpSocket, end: &AtomicBool, mut to: impl FnMut(&[u8], SocketAddr)) {
    let mut bytes = vec![0; DATAGRAM_LEN_MAX];
    while !end.load(Ordering::Relaxed) {
        // A time-out, or a receiver that was not running: try again.
        if let Ok((len, from)) = socket.recv_from(&mut bytes) {
            to(bytes.get(..len).unwrap_or(&[]), from);
        }
    }
}

fn remember(known: &Known, from: SocketAddr) {
    let now = Instant::now();
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    known.retain(|(robot, received)| *robot != from && now.duration_since(*received) < ROBOT_SILENCE_MAX);
    known.push((from, now));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn socket() -> UdpSocket {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
        socket
    }

    fn receive(socket: &UdpSocket) -> (Vec<u8>, SocketAddr) {
        let mut bytes = [0; 64];
        let (len, from) = socket.recv_from(&mut bytes).unwrap();
        (bytes[..len].to_vec(), from)
    }

    #[test]
    fn trap_09_a_simulator_that_answers_only_the_last_speaker_is_received_by_all() {
        let (simulator, one, two) = (socket(), socket(), socket());
        let hub = Hub::start(simulator.local_addr().unwrap()).unwrap();
        one.send_to(b"one", hub.address()).unwrap();
        let (first, from_one) = receive(&simulator);
        two.send_to(b"two", hub.address()).unwrap();
        let (second, from_two) = receive(&simulator);
        assert_eq!((&first[..], &second[..]), (&b"one"[..], &b"two"[..]));
        assert_eq!(from_one, from_two, "one speaker");
        simulator.send_to(b"both", from_two).unwrap();
        assert_eq!(receive(&one).0, b"both");
        assert_eq!(receive(&two).0, b"both");
    }
}
