//! `threads`: a thread for each socket: it waits, and passes on what arrives. A socket that cannot be opened
//! is tried again every second.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::external::StrategyLink as _;
use crate::shell::{LineRate, Link, OutCounts, Outbox, StrategyProcess};
use ssl::net::{Interfaces, NetReceiver};

use super::inbox::{Inbox, Mail, Source};

/// A thread checks this often whether to end.
const END_CHECK: Duration = Duration::from_millis(100);
/// A socket that could not be opened is tried again after this.
const REOPEN_AFTER: Duration = Duration::from_secs(1);
/// A link that fails repeatedly is reported this often.
const TROUBLE_EVERY: Duration = Duration::from_secs(10);
/// The link's thread waits at most this long for robots before it checks for frames to send: a tenth of a
/// snapshot's period.
const LINK_WAIT: Duration = Duration::from_millis(1);

/// Whether a line keeps up is checked this often.
const PACE_EVERY: Duration = Duration::from_secs(1);
/// One in this number of snapshots may be replaced by a newer one: threads are late now and then.
const SUPERSEDED_ONE_IN: u64 = 20;
/// Bit rates that adapters offer, bit/s.
const LINE_RATES: [u64; 7] = [115_200, 230_400, 460_800, 921_600, 1_000_000, 2_000_000, 3_000_000];
/// Time for the last frames to be sent at the end.
const FLUSH_TIME: Duration = Duration::from_millis(200);

/// Receives on `address` until `end`.
pub(super) fn receive(
    source: Source,
    address: SocketAddr,
    by: Interfaces,
    mail: Arc<Inbox>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut reported = None;
        while !end.load(Ordering::Relaxed) {
            let mut receiver = match NetReceiver::open(address, &by) {
                Ok(receiver) => receiver,
                Err(error) => {
                    let description = error.to_string();
                    if reported.as_ref() != Some(&description) {
                        mail.put(Mail::Trouble(source, description.clone()));
                        reported = Some(description);
                    }
                    sleep(REOPEN_AFTER, &end);
                    continue;
                }
            };
            reported = None;
            mail.put(Mail::Opened { source, route: receiver.route() });
            let mut looked = Instant::now();
            while !end.load(Ordering::Relaxed) {
                // Cables are plugged in, and addresses change, while a program runs.
                if looked.elapsed() >= REOPEN_AFTER {
                    looked = Instant::now();
                    if receiver.rejoin(&by) {
                        let route = receiver.route();
                        mail.put(Mail::Note(format!("{:<8} is received on {route} now", source.name())));
                        mail.put(Mail::Opened { source, route });
                    }
                }
                match receiver.receive(END_CHECK) {
                    Ok(Some(datagram)) => mail.put(match source {
                        Source::Vision => Mail::Vision(datagram.bytes.to_vec(), datagram.from),
                        Source::Tracker => Mail::Tracker(datagram.bytes.to_vec()),
                        _ => Mail::Referee(datagram.bytes.to_vec(), datagram.from.into()),
                    }),
                    Ok(None) => {}
                    Err(error) => {
                        mail.put(Mail::Trouble(source, error.to_string()));
                        sleep(REOPEN_AFTER, &end);
                        break;
                    }
                }
            }
        }
    })
}

/// Asks the team's own strategy about the newest view, until `end`: the host never waits for it.
pub(super) fn ask_strategy(
    mut strategy: StrategyProcess,
    views: Receiver<String>,
    mail: Arc<Inbox>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut starts = strategy.starts();
        while !end.load(Ordering::Relaxed) {
            let view = match views.recv_timeout(END_CHECK) {
                Ok(view) => view,
                Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            // Views that came while it planned are old.
            let newest = views.try_iter().last().unwrap_or(view);
            let ran = strategy.id().is_some();
            if let Some(answer) = strategy.answer(&newest) {
                mail.put(Mail::Orders(answer));
            } else if ran {
                mail.put(Mail::Note(
                    "strategy  the program ended or does not answer; it is started again".to_owned(),
                ));
            }
            if strategy.starts() != starts {
                starts = strategy.starts();
                mail.put(Mail::Note(format!("strategy  started again, {} times by now", starts - 1)));
            }
        }
    })
}

/// Carries frames to the robots and back, until `end`; then the waiting frames are sent, usually HALT.
pub(super) fn carry(
    mut link: Box<dyn Link>,
    frames: Arc<Mutex<Outbox>>,
    mail: Arc<Inbox>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut reported: Option<Instant> = None;
        let mut note = |result: Result<(), String>| {
            if let Err(description) = result
                && reported.is_none_or(|reported| reported.elapsed() >= TROUBLE_EVERY)
            {
                reported = Some(Instant::now());
                mail.put(Mail::Trouble(Source::Robots, description));
            }
        };
        let mut pace = Pace::new();
        while !end.load(Ordering::Relaxed) {
            note(send(&mut *link, &frames));
            match link.receive(LINK_WAIT) {
                Ok(None) => {}
                Ok(Some(packet)) => mail.put(Mail::Robot(packet)),
                Err(error) => {
                    note(Err(error.to_string()));
                    thread::sleep(END_CHECK);
                }
            }
            while let Some(description) = link.notice() {
                mail.put(Mail::Note(description));
            }
            if let Some(description) = pace.look(&*link, &frames) {
                mail.put(Mail::Slow(description));
            }
        }
        let until = Instant::now() + FLUSH_TIME;
        while look_at(&frames).waiting() > 0 && Instant::now() < until {
            let _ = send(&mut *link, &frames);
            thread::sleep(LINK_WAIT);
        }
    })
}

fn look_at(frames: &Mutex<Outbox>) -> std::sync::MutexGuard<'_, Outbox> {
    frames.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sends as much as the link takes without blocking.
fn send(link: &mut dyn Link, frames: &Mutex<Outbox>) -> Result<(), String> {
    let mut result = Ok(());
    loop {
        let discard = look_at(frames).take_discard();
        if discard {
            link.discard();
        }
        if !link.has_room() {
            return result;
        }
        let frame = look_at(frames).take();
        let Some((to, packet)) = frame else { return result };
        if let Err(error) = link.send(to, &packet) {
            result = Err(error.to_string());
        }
    }
}

/// Checks every second whether a line keeps up.
struct Pace {
    since: Instant,
    before: OutCounts,
}

impl Pace {
    fn new() -> Self {
        Self { since: Instant::now(), before: OutCounts::default() }
    }

    /// A message if the line did not keep up in the last second, with the rate it needs.
    fn look(&mut self, link: &dyn Link, frames: &Mutex<Outbox>) -> Option<String> {
        let passed = self.since.elapsed();
        if passed < PACE_EVERY {
            return None;
        }
        let counts = look_at(frames).counts();
        let before = std::mem::replace(&mut self.before, counts);
        self.since = Instant::now();
        too_slow(&link.line_rate()?, before, counts, passed)
    }
}

/// A message for a line that dropped more than one in [`SUPERSEDED_ONE_IN`] of its snapshots between two
/// counts.
fn too_slow(line: &LineRate, before: OutCounts, counts: OutCounts, passed: Duration) -> Option<String> {
    let lost = counts.superseded - before.superseded;
    let offered = counts.snapshots - before.snapshots;
    if lost <= offered / SUPERSEDED_ONE_IN {
        return None;
    }
    let in_a_second = |number: u64| (number as f64 / passed.as_secs_f64()) as u64;
    let needed = in_a_second(LineRate::needed(counts.frames - before.frames, counts.bytes - before.bytes));
    let rate = LINE_RATES.into_iter().find(|rate| *rate >= needed);
    let remedy = rate.map_or_else(
        || "no usual rate is enough: use fewer robots, or udp://".to_owned(),
        |rate| format!("set the base station and --robots serial:{}:{rate}", line.device),
    );
    Some(format!(
        "robots' line  {} at {} bit/s is too slow: {lost} of {offered} snapshots of the last second were replaced by newer ones; the \
         traffic needs {needed} bit/s: {remedy}",
        line.device, line.baud
    ))
}

/// Sleeps, but not beyond the end.
pub(super) fn sleep(time: Duration, end: &AtomicBool) {
    let mut left = time;
    while !left.is_zero() && !end.load(Ordering::Relaxed) {
        let now = left.min(END_CHECK);
        thread::sleep(now);
        left -= now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_is_too_slow_is_reported_with_the_rate_that_it_needs() {
        let line = LineRate { device: "/dev/ttyACM0".to_owned(), baud: 115_200 };
        let before =
            OutCounts { snapshots: 1_000, superseded: 400, frames: 5_000, bytes: 200_000, side_dropped: 0 };
        // 100 snapshots of 290 bytes in 8 frames.
        let counts =
            OutCounts { snapshots: 1_100, superseded: 460, frames: 5_800, bytes: 229_000, side_dropped: 0 };
        let warning = too_slow(&line, before, counts, Duration::from_secs(1)).expect("it is too slow");
        assert!(
            warning.contains("needs 306000 bit/s") && warning.contains("serial:/dev/ttyACM0:460800"),
            "{warning}"
        );
        let kept_up = OutCounts { superseded: 405, ..counts };
        assert_eq!(too_slow(&line, before, kept_up, Duration::from_secs(1)), None);
    }
}
