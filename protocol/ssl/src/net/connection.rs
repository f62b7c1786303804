//! `connection`: TCP connection to the game controller, with whole messages, each after its length.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use prost::Message;

use super::NetError;
use crate::stream::{FrameReader, MESSAGE_MAX, delimited};

/// An open TCP connection with a controller's port.
#[derive(Debug)]
pub struct Connection {
    stream: TcpStream,
    peer: SocketAddr,
    reader: FrameReader,
    chunk: Box<[u8]>,
}

impl Connection {
    /// Connects within `wait`; an error names the address that did not answer.
    pub fn open(peer: SocketAddr, wait: Duration) -> Result<Self, NetError> {
        let stream = TcpStream::connect_timeout(&peer, wait.max(SHORTEST_WAIT));
        let stream = stream.map_err(|error| NetError::NotConnected { to: peer, error })?;
        Self::over(stream)
    }

    /// Communicates over a stream that the caller opened or accepted.
    pub fn over(stream: TcpStream) -> Result<Self, NetError> {
        let unknown = SocketAddr::from(([0; 4], 0));
        let system = |address| move |error| NetError::System { doing: "talk with", address, error };
        let peer = stream.peer_addr().map_err(system(unknown))?;
        // Messages are small and wait for answers.
        stream.set_nodelay(true).map_err(system(peer))?;
        stream.set_write_timeout(Some(WRITE_WAIT)).map_err(system(peer))?;
        Ok(Self { stream, peer, reader: FrameReader::new(MESSAGE_MAX), chunk: vec![0; READ_LEN_MAX].into() })
    }

    /// Address of the peer.
    pub const fn peer(&self) -> SocketAddr {
        self.peer
    }

    /// Sends one message after its length; fails where the peer has closed.
    pub fn send(&mut self, message: &impl Message) -> Result<(), NetError> {
        self.stream.write_all(&delimited(message)).map_err(|error| self.broken("send to", error))
    }

    /// The next message, within `wait` (at least a millisecond). `None`: none arrived completely; the bytes
    /// received are kept.
    pub fn receive<M: Message + Default>(&mut self, wait: Duration) -> Result<Option<M>, NetError> {
        let from = self.peer;
        let until = Instant::now() + wait.max(SHORTEST_WAIT);
        loop {
            let message = self.reader.next_message().map_err(|error| NetError::NotFramed { from, error })?;
            if let Some(message) = message {
                let decoded = M::decode(message).map_err(|error| NetError::NotDecoded { from, error })?;
                return Ok(Some(decoded));
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            let waits = self.stream.set_read_timeout(Some(left.max(SHORTEST_WAIT)));
            waits.map_err(|error| self.broken("wait for", error))?;
            match self.stream.read(&mut self.chunk) {
                Ok(0) => return Err(self.closed()),
                Ok(bytes) => self.reader.push(&self.chunk[..bytes]),
                Err(error) if is_silence(&error) => {}
                Err(error) => return Err(self.broken("receive from", error)),
            }
        }
    }

    fn closed(&self) -> NetError {
        NetError::Closed { by: self.peer, pending: self.reader.pending() }
    }

    fn broken(&self, doing: &'static str, error: io::Error) -> NetError {
        use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset};
        match error.kind() {
            BrokenPipe | ConnectionAborted | ConnectionReset => self.closed(),
            _ => NetError::System { doing, address: self.peer, error },
        }
    }
}

fn is_silence(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted)
}

/// Shortest wait; zero would wait forever.
const SHORTEST_WAIT: Duration = Duration::from_millis(1);

/// The game controller answers within its tick of 25 ms; a peer that takes a second does not read any more.
const WRITE_WAIT: Duration = Duration::from_secs(1);

/// Bytes read at once; a reply has about a hundred.
const READ_LEN_MAX: usize = 4096;
