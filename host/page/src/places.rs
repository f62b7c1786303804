//! `places`: shares the places for connections out by address. A place that becomes free goes to the address
//! that holds the fewest; a few more are kept for addresses that hold none and for clients that show the
//! token, so that one machine that opens connections without end cannot block HALT.

use std::collections::{BTreeMap, VecDeque};
use std::net::{IpAddr, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Places beyond the limit that are kept.
const KEPT: usize = 8;
/// Connections that wait for a place; of more, the newest of the address with the most is closed.
const WAITING_MAX: usize = 256;
/// A connection that waits is looked at again after this: its request may have come.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// Bytes of a request that are looked at for the token: the address line.
const PEEKED_BYTES: usize = 512;

/// Connections that are served and that wait.
#[derive(Debug, Default)]
pub(crate) struct Places {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    /// Places taken, by address.
    taken: BTreeMap<IpAddr, usize>,
    kept_taken: usize,
    waiting: VecDeque<(TcpStream, IpAddr)>,
    ended: bool,
}

/// A place of one connection, until it is dropped.
#[derive(Debug)]
pub(crate) struct Place {
    places: Arc<Places>,
    address: IpAddr,
    kept: bool,
}

impl State {
    fn held_by(&self, address: &IpAddr) -> usize {
        self.taken.get(address).copied().unwrap_or(0)
    }

    /// The next connection to serve, and whether on a kept place.
    fn next(&self, most: usize, shows_token: impl Fn(&TcpStream) -> bool) -> Option<(usize, bool)> {
        let waiting = self.waiting.iter().enumerate();
        if self.taken.values().sum::<usize>() - self.kept_taken < most {
            let fewest = waiting.min_by_key(|(_, (_, address))| self.held_by(address));
            return fewest.map(|(index, _)| (index, false));
        }
        if self.kept_taken >= KEPT {
            return None;
        }
        let mut waiting = waiting;
        let next = waiting.find(|(_, (stream, address))| self.held_by(address) == 0 || shows_token(stream));
        next.map(|(index, _)| (index, true))
    }
}

impl Places {
    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A connection waits for a place.
    pub(crate) fn queue(&self, stream: TcpStream, address: IpAddr) {
        let mut state = self.locked();
        state.waiting.push_back((stream, address));
        if state.waiting.len() > WAITING_MAX {
            let addresses = state.waiting.iter().map(|(_, address)| *address);
            let most = addresses
                .max_by_key(|address| state.waiting.iter().filter(|(_, other)| other == address).count());
            let newest = state.waiting.iter().rposition(|(_, address)| Some(*address) == most);
            newest.and_then(|index| state.waiting.remove(index));
        }
        self.changed.notify_all();
    }

    /// Waits for the next connection that has a place, of `most` at once; `None` at the end. `is_token`:
    /// whether the beginning of a request shows the token.
    pub(crate) fn next(
        self: &Arc<Self>,
        most: usize,
        is_token: impl Fn(&[u8]) -> bool,
    ) -> Option<(TcpStream, Place)> {
        let mut state = self.locked();
        loop {
            if state.ended {
                return None;
            }
            if let Some((index, kept)) = state.next(most, |stream| is_token(&peeked(stream)))
                && let Some((stream, address)) = state.waiting.remove(index)
            {
                *state.taken.entry(address).or_default() += 1;
                state.kept_taken += usize::from(kept);
                return Some((stream, Place { places: self.clone(), address, kept }));
            }
            let waited = self.changed.wait_timeout(state, LOOK_EVERY);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// The page ends: connections that wait are closed.
    pub(crate) fn end(&self) {
        let mut state = self.locked();
        state.ended = true;
        state.waiting.clear();
        self.changed.notify_all();
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut state = self.places.locked();
        if let Some(held) = state.taken.get_mut(&self.address) {
            *held -= 1;
        }
        state.taken.retain(|_, held| *held > 0);
        state.kept_taken -= usize::from(self.kept);
        self.places.changed.notify_all();
    }
}

/// The beginning of what a connection has sent, without taking it.
fn peeked(stream: &TcpStream) -> Vec<u8> {
    let mut bytes = vec![0; PEEKED_BYTES];
    let peek = |bytes: &mut [u8]| {
        stream.set_nonblocking(true)?;
        let length = stream.peek(bytes);
        stream.set_nonblocking(false)?;
        length
    };
    let length = peek(&mut bytes).unwrap_or(0);
    bytes.truncate(length);
    bytes
}
