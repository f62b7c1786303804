//! A thread for each socket: it waits, and passes on what came. One that cannot be opened is tried again every second.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use host::radio::To;
use host::shell::Link;
use protocol::link::Packet;
use ssl::net::Interfaces;

use crate::net::Ear;

/// What comes to the host's desk.
pub(super) enum Mail {
    /// A datagram of the vision.
    Vision(Vec<u8>),
    /// A datagram of the referee.
    Referee(Vec<u8>),
    /// A frame of a robot.
    Robot(Packet),
    /// Where a source is heard now.
    Open(Source, String),
    /// Why a source cannot be heard.
    Trouble(Source, String),
    /// Something to be told.
    Word(String),
}

/// Where mail comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    Vision,
    Referee,
    Robots,
}

impl Source {
    /// As people call it.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Vision => "vision",
            Self::Referee => "referee",
            Self::Robots => "robots",
        }
    }
}

/// A thread looks this often whether it shall end.
const LOOK: Duration = Duration::from_millis(100);
/// What could not be opened is tried again after this.
const AGAIN: Duration = Duration::from_secs(1);
/// A link that fails again and again is told of this often.
const TROUBLE_EVERY: Duration = Duration::from_secs(10);
/// The link's thread waits so long for robots before it looks for what is to be sent: a tenth of a picture's period.
const LINK_WAIT: Duration = Duration::from_millis(1);

/// Hears `address` until `end`.
pub(super) fn hear(
    source: Source,
    address: SocketAddr,
    by: Interfaces,
    mail: Sender<Mail>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut told = None;
        while !end.load(Ordering::Relaxed) {
            let mut ear = match Ear::open(address, &by) {
                Ok(ear) => ear,
                Err(error) => {
                    let words = error.to_string();
                    if told.as_ref() != Some(&words) {
                        let _ = mail.send(Mail::Trouble(source, words.clone()));
                        told = Some(words);
                    }
                    sleep(AGAIN, &end);
                    continue;
                }
            };
            told = None;
            let _ = mail.send(Mail::Open(source, ear.words()));
            while !end.load(Ordering::Relaxed) {
                let bytes = match ear.receive(LOOK) {
                    Ok(Some(datagram)) => datagram.bytes.to_vec(),
                    Ok(None) => continue,
                    Err(error) => {
                        let _ = mail.send(Mail::Trouble(source, error.to_string()));
                        sleep(AGAIN, &end);
                        break;
                    }
                };
                let letter =
                    if source == Source::Vision { Mail::Vision(bytes) } else { Mail::Referee(bytes) };
                if mail.send(letter).is_err() {
                    return;
                }
            }
        }
    })
}

/// Carries frames to the robots and back, until the desk hangs up.
pub(super) fn carry(
    mut link: Box<dyn Link>,
    frames: Receiver<(To, Packet)>,
    mail: Sender<Mail>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut told: Option<Instant> = None;
        let mut note = |result: Result<(), String>| {
            if let Err(words) = result
                && told.is_none_or(|told| told.elapsed() >= TROUBLE_EVERY)
            {
                told = Some(Instant::now());
                let _ = mail.send(Mail::Trouble(Source::Robots, words));
            }
        };
        while !end.load(Ordering::Relaxed) {
            for (to, packet) in frames.try_iter() {
                note(link.send(to, &packet).map_err(|error| error.to_string()));
            }
            match link.receive(LINK_WAIT) {
                Ok(None) => {}
                Ok(Some(packet)) => {
                    if mail.send(Mail::Robot(packet)).is_err() {
                        return;
                    }
                }
                Err(error) => {
                    note(Err(error.to_string()));
                    thread::sleep(LOOK);
                }
            }
            while let Some(words) = link.notice() {
                let _ = mail.send(Mail::Word(words));
            }
        }
        for (to, packet) in frames.try_iter() {
            let _ = link.send(to, &packet);
        }
    })
}

/// Sleeps, but not beyond the end.
pub(super) fn sleep(time: Duration, end: &AtomicBool) {
    let mut left = time;
    while !left.is_zero() && !end.load(Ordering::Relaxed) {
        let now = left.min(LOOK);
        thread::sleep(now);
        left -= now;
    }
}
