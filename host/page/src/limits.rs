//! `limits`: how long and how many connections a page serves, and the guards that count them.
//!
//! Every client that reaches the page's address can open connections. None of them may exhaust what the
//! others need: descriptors, memory, or the match.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Bounds on the resources that clients can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// A connection that has not sent the whole head of a request within this time is closed; one that is
    /// idle between two requests too.
    pub header: Duration,
    /// Longest time for a request's body and its answer.
    pub request: Duration,
    /// A connection that is not a viewer's socket is closed after this time in any state: it may be
    /// a reader that never reads.
    pub connection: Duration,
    /// Connections served at once, viewers' sockets aside, shared out by address. Others wait; a few more
    /// places are kept for addresses that hold none and for the token.
    pub connections: usize,
    /// Viewers at once: further ones are refused.
    pub viewers: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            // A browser sends the head of a request in one packet.
            header: Duration::from_secs(5),
            // An explanation of the largest library takes less than 1 s.
            request: Duration::from_secs(20),
            // A second of a match is the longest answer: 100 kB.
            connection: Duration::from_mins(1),
            // Browsers open 6 to a host. With the viewers' it stays below a fifth of the default 1,024
            // descriptors of a process.
            connections: 128,
            // Enough for a team and its guests.
            viewers: 64,
        }
    }
}

/// A viewer's place in the count of viewers, from before its connection becomes a socket until that ends.
#[derive(Debug)]
pub(crate) struct Seat(Arc<AtomicUsize>);

impl Seat {
    /// Takes a place; `None` if `most` are taken.
    pub(crate) fn take(taken: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        let one_more = |n: usize| (n < most).then_some(n + 1);
        taken.fetch_update(Ordering::AcqRel, Ordering::Acquire, one_more).ok()?;
        Some(Self(taken.clone()))
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn concurrent_viewers_take_exactly_the_seats_there_are() {
        let taken = Arc::new(AtomicUsize::new(0));
        let seats: Vec<Seat> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8)
                .map(|_| scope.spawn(|| (0..50).filter_map(|_| Seat::take(&taken, 64)).collect::<Vec<_>>()))
                .collect();
            threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!((seats.len(), taken.load(Ordering::Relaxed)), (64, 64));
        drop(seats);
        assert_eq!(taken.load(Ordering::Relaxed), 0);
        assert!(Seat::take(&taken, 64).is_some());
    }
}
