//! `access_point`: relay between a host and robots that are reached over IP, as sockets of this machine:
//! every datagram of the host goes to all robots, every datagram of a robot to the host.
//!
//! A robot is known by the address of its last datagram, the host by its own: both speak first, as robots
//! send beacons before a host commands them. Nothing is decoded: frames carry their own tags.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Silence after which a robot is gone: a robot on wheels sends twenty beacons a second.
const ROBOT_TIMEOUT: Duration = Duration::from_secs(5);
/// Longest wait of a thread before it checks whether it shall end.
const END_CHECK_PERIOD: Duration = Duration::from_millis(50);
/// Longest datagram that is passed on, bytes: longer ones are no frames (`protocol::frame`).
const LEN_MAX: usize = protocol::frame::FRAME_LEN_MAX;

/// Datagrams that were passed on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassedCounts {
    /// Datagrams of the host, each counted once however many robots there were.
    pub from_host: u64,
    /// Datagrams of robots, while a host was known.
    pub from_robots: u64,
}

/// Two threads between a host and robots; they end when this is dropped.
#[derive(Debug)]
pub struct AccessPoint {
    for_host: SocketAddr,
    for_robots: SocketAddr,
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Shared {
    end: AtomicBool,
    host: Mutex<Option<SocketAddr>>,
    robots: Mutex<Vec<(SocketAddr, Instant)>>,
    from_host: AtomicU64,
    from_robots: AtomicU64,
}

impl Shared {
    fn pass_to_robots(&self, host: &UdpSocket, robots: &UdpSocket) {
        pass(host, &self.end, |bytes, from| {
            *lock(&self.host) = Some(from);
            self.from_host.fetch_add(1, Ordering::Relaxed);
            for (robot, _) in lock(&self.robots).iter() {
                // A queue that is full loses a frame, as any air does.
                let _ = robots.send_to(bytes, robot);
            }
        });
    }

    fn pass_to_host(&self, robots: &UdpSocket, host: &UdpSocket) {
        pass(robots, &self.end, |bytes, from| {
            let now = Instant::now();
            let mut known = lock(&self.robots);
            known.retain(|(robot, at)| *robot != from && now.duration_since(*at) < ROBOT_TIMEOUT);
            known.push((from, now));
            drop(known);
            let to = *lock(&self.host);
            if let Some(to) = to {
                self.from_robots.fetch_add(1, Ordering::Relaxed);
                let _ = host.send_to(bytes, to);
            }
        });
    }
}

impl AccessPoint {
    /// Takes the host's datagrams at `address`, and robots' at a port of this machine that is free.
    pub fn open(address: SocketAddr) -> io::Result<Self> {
        let host = Arc::new(UdpSocket::bind(address)?);
        let robots = Arc::new(UdpSocket::bind("127.0.0.1:0")?);
        for socket in [&host, &robots] {
            socket.set_read_timeout(Some(END_CHECK_PERIOD))?;
        }
        let (for_host, for_robots) = (host.local_addr()?, robots.local_addr()?);
        let shared = Arc::new(Shared::default());
        let mut point = Self { for_host, for_robots, shared: shared.clone(), threads: Vec::new() };
        let (from, to, state) = (host.clone(), robots.clone(), shared.clone());
        let to_robots = thread::Builder::new().name("to-robots".to_owned());
        point.threads.push(to_robots.spawn(move || state.pass_to_robots(&from, &to))?);
        let to_host = thread::Builder::new().name("to-host".to_owned());
        point.threads.push(to_host.spawn(move || shared.pass_to_host(&robots, &host))?);
        Ok(point)
    }

    /// Address to which the host sends, and from which it is answered.
    pub fn for_host(&self) -> SocketAddr {
        self.for_host
    }

    /// Address to which robots send.
    pub fn for_robots(&self) -> SocketAddr {
        self.for_robots
    }

    /// Counts of passed frames so far.
    pub fn counts(&self) -> PassedCounts {
        PassedCounts {
            from_host: self.shared.from_host.load(Ordering::Relaxed),
            from_robots: self.shared.from_robots.load(Ordering::Relaxed),
        }
    }
}

impl Drop for AccessPoint {
    fn drop(&mut self) {
        self.shared.end.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

fn lock<T>(value: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

fn pass(socket: &UdpSocket, end: &AtomicBool, mut to: impl FnMut(&[u8], SocketAddr)) {
    // One byte more than a frame has, so that a longer datagram is noticed.
    let mut bytes = [0; LEN_MAX + 1];
    while !end.load(Ordering::Relaxed) {
        // A time-out, or a receiver that was not running: try again.
        if let Ok((len @ 1..=LEN_MAX, from)) = socket.recv_from(&mut bytes) {
            to(bytes.get(..len).unwrap_or(&[]), from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn socket() -> UdpSocket {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        socket
    }

    fn receive(socket: &UdpSocket) -> Vec<u8> {
        let mut bytes = [0; 256];
        let (len, _) = socket.recv_from(&mut bytes).unwrap();
        bytes[..len].to_vec()
    }

    #[test]
    fn a_host_is_heard_by_all_robots_that_spoke_and_hears_each_of_them() {
        let point = AccessPoint::open(([127, 0, 0, 1], 0).into()).unwrap();
        let (host, one, two) = (socket(), socket(), socket());
        // The host comes first, so that what robots say reaches it.
        host.send_to(b"nobody there", point.for_host()).unwrap();
        while point.counts().from_host == 0 {
            thread::sleep(Duration::from_millis(1));
        }
        for (robot, words) in [(&one, b"I am one"), (&two, b"I am two")] {
            robot.send_to(words, point.for_robots()).unwrap();
            assert_eq!(receive(&host), words);
        }
        // Longer than any frame: not passed on.
        host.send_to(&[1; LEN_MAX + 1], point.for_host()).unwrap();
        host.send_to(b"go", point.for_host()).unwrap();
        assert_eq!((receive(&one), receive(&two)), (b"go".to_vec(), b"go".to_vec()));
        assert_eq!(point.counts(), PassedCounts { from_host: 2, from_robots: 2 });
    }
}
