//! `server`: HTTP and WebSocket server on threads of its own: one that accepts, one for each connection.
//!
//! A viewer's socket carries the newest scene whenever the viewer has taken the one before: it acknowledges
//! with a dot. So a slow viewer sees fewer scenes, none of them old, and one that is gone holds nothing up.
//! Connections are served within [`Limits`](crate::Limits): a bounded number at once, each for a bounded
//! time.

use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::guard;
use crate::http::{Answer, Head, NoRequest, Status, Wire};
use crate::limits::Seat;
use crate::places::{Place, Places};
use crate::request::UserRequest;
use crate::routes;
use crate::shared::{Ask, Shared};
use crate::socket::{self, Received};
use crate::viewers::{Mailbox, Sent, Viewers};

/// Time after which a viewer that takes nothing counts as gone.
const VIEWER_TIMEOUT: Duration = Duration::from_secs(30);
/// Pause before the next attempt where no connection can be taken: no descriptor is left.
const ACCEPT_RETRY: Duration = Duration::from_millis(50);
/// The longest message of a viewer, bytes: a request, a problem.
const MESSAGE_LEN_MAX: usize = 16 * 1024;
/// The longest request of the case workbench, bytes: a case file, and the one that it replaces.
const WORKBENCH_MAX: usize = 128 * 1024;
/// Time limit of the page's own connection that wakes its server for the end.
const WAKE_TIMEOUT: Duration = Duration::from_millis(200);

/// A server that goes on until this is dropped.
#[derive(Debug)]
pub(crate) struct Server {
    address: SocketAddr,
    viewers: Arc<Viewers>,
    accepting: Option<JoinHandle<()>>,
}

impl Server {
    /// Serves on threads of its own.
    pub(crate) fn start(listener: TcpListener, shared: Shared) -> io::Result<Self> {
        let (address, viewers) = (listener.local_addr()?, shared.viewers.clone());
        let accepting = thread::Builder::new().spawn(move || accept(&listener, &Arc::new(shared)))?;
        Ok(Self { address, viewers, accepting: Some(accepting) })
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.viewers.end();
        // It waits for a connection; that of an address of all interfaces is this machine's.
        let mut address = self.address;
        if address.ip().is_unspecified() {
            address.set_ip(if address.is_ipv4() {
                [127, 0, 0, 1].into()
            } else {
                [0, 0, 0, 0, 0, 0, 0, 1].into()
            });
        }
        let woken = TcpStream::connect_timeout(&address, WAKE_TIMEOUT).is_ok();
        if let Some(accepting) = self.accepting.take().filter(|_| woken) {
            let until = Instant::now() + WAKE_TIMEOUT;
            // Where every place is taken it wakes later, and finds that the page has ended.
            while !accepting.is_finished() && Instant::now() < until {
                thread::sleep(Duration::from_millis(1));
            }
        }
    }
}

/// Takes connection by connection, and serves no more at once than the limits allow.
fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    let places = Arc::new(Places::default());
    let (served, page) = (places.clone(), shared.clone());
    let server = thread::Builder::new().spawn(move || serve_all(&served, &page));
    while !shared.viewers.have_ended() && server.is_ok() {
        match listener.accept() {
            Ok((stream, from)) => places.queue(stream, from.ip().to_canonical()),
            Err(_) => thread::sleep(ACCEPT_RETRY),
        }
    }
    places.end();
}

/// Serves the connections that have a place, each on a thread of its own.
fn serve_all(places: &Arc<Places>, shared: &Arc<Shared>) {
    while let Some((stream, place)) =
        places.next(shared.settings.limits.connections, |request| shared.shows_token(request))
    {
        // Scenes are small and needed at once.
        let _ = stream.set_nodelay(true);
        let shared = shared.clone();
        // Where no thread can be had the connection closes.
        let _ = thread::Builder::new().spawn(move || serve(stream, &shared, place));
    }
}

/// Answers the requests of one connection, until it ends or becomes a viewer's socket.
fn serve(stream: TcpStream, shared: &Shared, place: Place) {
    let limits = shared.settings.limits;
    let mut wire = Wire::new(stream);
    let closes = Instant::now() + limits.connection;
    loop {
        let by = closes.min(Instant::now() + limits.header);
        let head = match Head::read(&mut wire, by) {
            Ok(head) => head,
            Err(NoRequest::Refused(status)) => return Answer::bare(status).end(&mut wire, by),
            Err(NoRequest::Gone) => return,
        };
        if shared.viewers.have_ended() {
            return;
        }
        let answered = Instant::now() + limits.request;
        let most = if head.path == "/api/workbench" { WORKBENCH_MAX } else { MESSAGE_LEN_MAX };
        let body = match guard::check(&head, shared.port) {
            Err(foreign) => {
                return Answer::text(Status::FORBIDDEN, foreign.to_string()).end(&mut wire, closes);
            }
            Ok(()) => head.body(&mut wire, most, closes.min(answered)),
        };
        let body = match body {
            Ok(body) => body,
            Err(NoRequest::Refused(status)) => return guarded(Answer::bare(status)).end(&mut wire, closes),
            Err(NoRequest::Gone) => return,
        };
        if head.path == "/socket" {
            match admit(shared, &head) {
                Ok(admission) => return look_on(wire, shared, &head, admission, place),
                Err(answer) => {
                    if !matches!(guarded(answer).send(&mut wire, &head, closes), Ok(true)) {
                        return;
                    }
                    continue;
                }
            }
        }
        let within = closes.min(answered).saturating_duration_since(Instant::now());
        let answer = routes::answer(shared, &head, body, within);
        if !matches!(guarded(answer).send(&mut wire, &head, closes), Ok(true)) {
            return;
        }
    }
}

/// Adds the headers that restrict what browsers let this page do.
fn guarded(mut answer: Answer) -> Answer {
    answer.headers.extend(HEADERS.map(|(name, value)| (name, value.into())));
    answer
}

/// Nothing from elsewhere, not in another page's frame, nothing cached by the browser: another version may be
/// served tomorrow.
const HEADERS: [(&str, &str); 5] = [
    (
        "content-security-policy",
        "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("x-frame-options", "DENY"),
    ("referrer-policy", "no-referrer"),
    ("cache-control", "no-store"),
];

/// A viewer's place and the answer that makes its connection a socket.
struct Admission {
    seat: Seat,
    answer: Answer,
}

fn admit(shared: &Shared, head: &Head) -> Result<Admission, Answer> {
    if head.method != "GET" {
        return Err(Answer::bare(Status::NOT_ALLOWED).with("allow", "GET"));
    }
    let answer = socket::handshake(head)?;
    // Taken before the answer: of those that come at once none can pass while the others are not counted yet.
    match Seat::take(&shared.seats, shared.settings.limits.viewers) {
        Some(seat) => Ok(Admission { seat, answer }),
        None => Err(Answer::text(Status::UNAVAILABLE, "too many viewers")),
    }
}

/// One viewer, until it goes.
fn look_on(mut wire: Wire, shared: &Shared, head: &Head, admission: Admission, place: Place) {
    let Admission { seat, answer } = admission;
    let may_ask = shared.may_ask(head.asked("token"));
    let Ok(mut out) = wire.writer() else { return };
    if guarded(answer).send(&mut wire, head, Instant::now() + VIEWER_TIMEOUT).is_err() {
        return;
    }
    // Its time is its own from now on (`VIEWER_TIMEOUT`).
    drop(place);
    let mailbox = shared.viewers.join();
    let sending = mailbox.clone();
    let sender = thread::Builder::new().spawn(move || send(&mut out, &sending));
    if sender.is_ok() {
        listen(&mut wire, shared, &mailbox, may_ask);
    }
    mailbox.leave();
    wire.close();
    drop(seat);
}

/// Sends a viewer what is for it, until its socket is over.
fn send(wire: &mut Wire, mailbox: &Mailbox) {
    while let Some(sent) = mailbox.next() {
        let frame = match sent {
            Sent::Scene(text) | Sent::Transport(text) => socket::text(&text),
            Sent::Refusal(reason) => socket::text(&serde_json::json!({ "refused": reason }).to_string()),
            Sent::Pong(payload) => socket::pong(&payload),
        };
        if wire.send(&frame, Instant::now() + VIEWER_TIMEOUT).is_err() {
            break;
        }
    }
    // The match is over with its page: the socket closes, and viewers show it.
    let _ = wire.send(&socket::close(), Instant::now() + WAKE_TIMEOUT);
    wire.close();
}

/// Reads what a viewer sends, until it closes.
fn listen(wire: &mut Wire, shared: &Shared, mailbox: &Arc<Mailbox>, may_ask: bool) {
    let mut begun = None;
    loop {
        match socket::receive(wire, &mut begun, MESSAGE_LEN_MAX, Instant::now() + VIEWER_TIMEOUT) {
            Ok(Received::Text(text)) if text == "." => mailbox.take(),
            // A viewer of something that stands still sends a sign that it is there.
            Ok(Received::Text(text)) if text.is_empty() => {}
            Ok(Received::Text(text)) => {
                let asked = if may_ask { ask(shared, mailbox, &text) } else { Err(NO_TOKEN.to_owned()) };
                if let Err(reason) = asked {
                    mailbox.refuse(reason);
                }
            }
            Ok(Received::Ping(payload)) => mailbox.ping(payload),
            Ok(Received::Pong) => {}
            Ok(Received::Close) | Err(_) => return,
        }
    }
}

/// Answer to a viewer without the token.
const NO_TOKEN: &str = "this page is open to the network: to ask for anything, open it by the address with ?token= that the program \
                        printed when it started";

fn ask(shared: &Shared, asker: &Arc<Mailbox>, text: &str) -> Result<(), String> {
    let request = UserRequest::read(text, shared.settings.powers).map_err(|refused| refused.to_string())?;
    shared
        .asks
        .try_send(Ask { request, asker: asker.clone() })
        .map_err(|_| "the match is busy: ask again".to_owned())
}
