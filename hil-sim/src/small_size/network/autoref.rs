//! `autoref`: an automatic referee's connection to the league's game controller (TCP 10007). A thread of its
//! own connects, registers, and reports events; messages for the operator come back as lines.

use std::net::{SocketAddr, ToSocketAddrs};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, TrySendError, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use ssl::controller::{
    AutoRefRegistration, AutoRefToController, ControllerReply, ControllerToAutoRef, StatusCode,
};
use ssl::event::{GameEvent, GameEventType};
use ssl::net::Connection;

/// The name it registers under; a controller that has a key for this name asks for a signature.
pub(super) const NAME: &str = "onetwo";
/// Between two attempts to connect.
const RETRY_AFTER: Duration = Duration::from_secs(2);
/// The controller answers within its tick of 25 ms; a loaded machine was seen to pause for 1.6 s.
const REPLY_TIME: Duration = Duration::from_secs(3);
/// An idle connection is checked this often for being alive.
const ALIVE_CHECK: Duration = Duration::from_millis(200);
/// Events that wait for the connection; more are dropped.
const WAITING_MAX: usize = 64;
/// An event that waited longer is not reported: the game has moved on.
const REPORTED_WITHIN: Duration = Duration::from_secs(1);

/// Reports events to a controller.
#[derive(Debug)]
pub(super) struct Reporter {
    to: String,
    events: SyncSender<(Instant, GameEvent)>,
    lines: Receiver<String>,
    dropped: u64,
}

impl Reporter {
    /// Starts to connect, and retries until it is dropped.
    pub(super) fn new(to: &str) -> Self {
        let (events, incoming) = sync_channel(WAITING_MAX);
        let (outgoing, lines) = channel();
        let mut talk = Talk { to: to.to_owned(), events: incoming, lines: outgoing, trouble: None };
        // If no thread can be started, the closed channel reports that.
        let _ = thread::Builder::new().name("autoref".to_owned()).spawn(move || talk.run());
        Self { to: to.to_owned(), events, lines, dropped: 0 }
    }

    pub(super) fn to(&self) -> &str {
        &self.to
    }

    /// Reports an event as soon as the controller is connected.
    pub(super) fn report(&mut self, event: GameEvent) {
        match self.events.try_send((Instant::now(), event)) {
            Ok(()) => {}
            Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => self.dropped += 1,
        }
    }

    pub(super) fn next_line(&mut self) -> Option<String> {
        if let Ok(line) = self.lines.try_recv() {
            return Some(line);
        }
        let dropped = std::mem::take(&mut self.dropped);
        (dropped > 0)
            .then(|| format!("{dropped} events not reported: the game controller does not take them"))
    }
}

/// The part that runs on the thread.
struct Talk {
    to: String,
    events: Receiver<(Instant, GameEvent)>,
    lines: Sender<String>,
    /// The last reported reason why there is no connection.
    trouble: Option<String>,
}

/// The program has dropped the connection.
struct Ended;

impl Talk {
    fn run(&mut self) {
        loop {
            let Err(trouble) = self.connect_and_report() else { return };
            if self.trouble.as_ref() != Some(&trouble) {
                let again = RETRY_AFTER.as_secs();
                let line = format!("{trouble}; it is tried again every {again} s");
                self.trouble = Some(trouble);
                if self.lines.send(line).is_err() {
                    return;
                }
            }
            thread::sleep(RETRY_AFTER);
        }
    }

    /// Runs until the connection fails (with the reason), or the program ends.
    fn connect_and_report(&mut self) -> Result<Ended, String> {
        let mut connection =
            Connection::open(self.address()?, REPLY_TIME).map_err(|error| error.to_string())?;
        // The controller sends first.
        reply(&mut connection)?;
        send(&mut connection, &AutoRefRegistration { identifier: NAME.to_owned(), signature: None })?;
        let answer = reply(&mut connection)?;
        if let Some(reason) = refused(&answer) {
            return Err(format!(
                "{}: registration as `{NAME}` refused: {reason} (a controller with a public key of that name wants a signature, which this program does not make; remove the key)",
                self.to
            ));
        }
        self.trouble = None;
        let _ = self.lines.send(format!("registered at {} as `{NAME}`", connection.peer()));
        loop {
            let (since, event) = match self.events.recv_timeout(ALIVE_CHECK) {
                Ok(event) => event,
                Err(RecvTimeoutError::Disconnected) => return Ok(Ended),
                Err(RecvTimeoutError::Timeout) => {
                    // No message is expected; the call detects a closed connection.
                    let idle = connection.receive::<ControllerToAutoRef>(Duration::ZERO);
                    idle.map_err(|error| error.to_string())?;
                    continue;
                }
            };
            if since.elapsed() > REPORTED_WITHIN {
                continue;
            }
            let kind = name_of(&event);
            send(&mut connection, &AutoRefToController { signature: None, game_event: Some(event) })?;
            let answer = reply(&mut connection)?;
            if let Some(reason) = refused(&answer) {
                let _ = self.lines.send(format!("{kind} refused by the game controller: {reason}"));
            }
        }
    }

    fn address(&self) -> Result<SocketAddr, String> {
        let unknown = |why: String| format!("{}: {why}; expected HOST or HOST:PORT", self.to);
        let mut found = self.to.to_socket_addrs().map_err(|error| unknown(error.to_string()))?;
        found.next().ok_or_else(|| unknown("no address".to_owned()))
    }
}

fn send(connection: &mut Connection, message: &impl ssl::Message) -> Result<(), String> {
    connection.send(message).map_err(|error| error.to_string())
}

fn reply(connection: &mut Connection) -> Result<ControllerReply, String> {
    let received =
        connection.receive::<ControllerToAutoRef>(REPLY_TIME).map_err(|error| error.to_string())?;
    received.and_then(|message| message.controller_reply).ok_or_else(|| {
        format!(
            "no answer from {} within {} s; is it a game controller's port for automatic referees?",
            connection.peer(),
            REPLY_TIME.as_secs()
        )
    })
}

fn refused(reply: &ControllerReply) -> Option<String> {
    let rejected = reply.status_code == Some(StatusCode::Rejected as i32);
    rejected.then(|| reply.reason.clone().unwrap_or_else(|| "no reason given".to_owned()))
}

fn name_of(event: &GameEvent) -> String {
    let kind = event.r#type.and_then(|kind| GameEventType::try_from(kind).ok());
    format!("{:?}", kind.unwrap_or(GameEventType::Unknown))
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    /// A controller's side of one connection: sends its first message, takes the registration, answers it
    /// with `code`.
    fn shake_hands(listener: &TcpListener, code: StatusCode) -> (Connection, AutoRefRegistration) {
        let (stream, _) = listener.accept().expect("a connection");
        let mut talk = Connection::over(stream).expect("a talk");
        let answer = |code: StatusCode| ControllerToAutoRef {
            controller_reply: Some(ControllerReply {
                status_code: Some(code as i32),
                reason: Some("Missing signature".to_owned()),
                next_token: None,
                verification: None,
            }),
        };
        talk.send(&answer(StatusCode::Ok)).expect("greeted");
        let registration = talk.receive(REPLY_TIME).expect("no error").expect("a registration");
        talk.send(&answer(code)).expect("answered");
        (talk, registration)
    }

    fn line(reporter: &mut Reporter) -> String {
        let until = Instant::now() + Duration::from_secs(20);
        while Instant::now() < until {
            if let Some(line) = reporter.next_line() {
                return line;
            }
            thread::sleep(Duration::from_millis(5));
        }
        String::new()
    }

    #[test]
    fn it_registers_reports_and_comes_back_after_the_connection_was_lost() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let mut reporter = Reporter::new(&listener.local_addr().expect("an address").to_string());
        for _ in 0..2 {
            let (mut talk, registration) = shake_hands(&listener, StatusCode::Ok);
            assert_eq!(registration.identifier, NAME);
            assert!(registration.signature.is_none());
            assert!(line(&mut reporter).contains("registered"));
            let event =
                GameEvent { r#type: Some(GameEventType::PossibleGoal as i32), ..GameEvent::default() };
            reporter.report(event.clone());
            let received: AutoRefToController =
                talk.receive(REPLY_TIME).expect("no error").expect("an event");
            assert_eq!(received.game_event, Some(event));
            drop(talk);
            assert!(line(&mut reporter).contains("tried again"));
        }
    }

    #[test]
    fn a_controller_that_wants_a_signature_is_reported_with_the_remedy() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let mut reporter = Reporter::new(&listener.local_addr().expect("an address").to_string());
        let _talk = shake_hands(&listener, StatusCode::Rejected);
        let line = line(&mut reporter);
        assert!(line.contains("Missing signature") && line.contains("remove the key"), "{line}");
    }
}
