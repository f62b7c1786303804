//! `remote_thread`: our team's remote control at the game controller: what the operator asks for goes out,
//! and the team's state comes back, at least every [`STATUS_EVERY`]. A connection that is lost is opened
//! again.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rules::Colour;

use super::inbox::{Inbox, Mail, RemoteAnswer};
use super::threads::sleep;
use crate::referee::remote::{RemoteControl, RemoteError, RemoteRequest};

/// The state is asked for this often, so that times left are not older.
const STATUS_EVERY: Duration = Duration::from_millis(500);
/// Time between two attempts to connect.
const RETRY_AFTER: Duration = Duration::from_secs(2);

/// Talks with the controller until `end` is set.
pub(super) fn talk(
    address: SocketAddr,
    colour: Colour,
    asked: Receiver<RemoteRequest>,
    mail: Arc<Inbox>,
    end: Arc<AtomicBool>,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut reported = String::new();
        while !end.load(Ordering::Relaxed) {
            let talked = RemoteControl::connect(address, colour).and_then(|control| {
                mail.put(Mail::Note(format!("remote control  registered at {address}")));
                reported.clear();
                serve(control, &asked, &mail, &end)
            });
            let Err(error) = talked else { return };
            mail.put(Mail::Remote(RemoteAnswer::State(None)));
            // What was asked for without a connection is not granted later.
            for _ in asked.try_iter() {
                mail.put(Mail::Remote(RemoteAnswer::Refused(error.to_string())));
            }
            if reported != error.to_string() {
                reported = error.to_string();
                mail.put(Mail::Note(format!("remote control  {error}; it is tried again")));
            }
            sleep(RETRY_AFTER, &end);
        }
    })
}

/// Passes requests and answers on until `end` is set; an error is the connection's.
fn serve(
    mut control: RemoteControl,
    asked: &Receiver<RemoteRequest>,
    mail: &Inbox,
    end: &AtomicBool,
) -> Result<(), RemoteError> {
    while !end.load(Ordering::Relaxed) {
        let request = match asked.recv_timeout(STATUS_EVERY) {
            Ok(request) => request,
            Err(RecvTimeoutError::Timeout) => RemoteRequest::Status,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        };
        match control.ask(request) {
            Ok(state) => mail.put(Mail::Remote(RemoteAnswer::State(Some(state)))),
            Err(RemoteError::Refused(reason)) => {
                mail.put(Mail::Remote(RemoteAnswer::Refused(format!("{}: {reason}", request.name()))));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
