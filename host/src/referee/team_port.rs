//! `team_port`: client of the game controller's port for teams (TCP 10008), without the socket.
//!
//! The controller sends first (a reply with a token), the client registers under the name configured there,
//! and every request gets a reply, one at a time. The shell connects where [`TeamPort::wants_connection`] is
//! true, reports [`connected`](TeamPort::connected) and [`lost`](TeamPort::lost), passes bytes to
//! [`receive`](TeamPort::receive), sends the bytes of [`poll_transmit`](TeamPort::poll_transmit), calls
//! [`tick`](TeamPort::tick) and reports the events of [`poll_event`](TeamPort::poll_event) to the operator.
//! Requests are unsigned: the controller accepts those unless it has the team's public key, and otherwise
//! reports the refusal. The token of the next message is kept for a caller that signs ([`TeamPort::token`]).

use std::collections::VecDeque;

use protocol::{Duration, Instant, RobotId};
use rules::Colour;
use ssl::Message;
use ssl::controller::{
    AdvantageChoice, ControllerReply, ControllerToTeam, StatusCode, TeamRegistration, TeamRequest,
    TeamToController, Verification,
};
use ssl::stream::{FrameReader, MESSAGE_MAX, delimited};
use thiserror::Error;

use super::description::team_of;

/// The controller answers within this, or the connection is closed. It answers at once; a loaded machine was
/// seen to pause for 1.6 s.
pub const REPLY_TIME: Duration = Duration::millis(3_000);
/// An idle connection is checked this often: a controller that is gone is detected between two stoppages.
pub const PING_EVERY: Duration = Duration::millis(5_000);
/// Between two attempts to connect or to register: long enough not to fill the controller's log, short enough
/// for a name that its operator just entered.
pub const RETRY_AFTER: Duration = Duration::millis(2_000);
/// Requests that a team may send.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TeamPortRequest {
    /// This robot is our goalkeeper from now on; granted while the ball is out of play or in their half.
    Keeper(RobotId),
    /// We request the substitution of a robot at the next opportunity, or withdraw the request.
    Substitute(bool),
    /// After a card against them: continue, or stop.
    Advantage {
        /// Whether the game continues.
        go_on: bool,
    },
    /// Checks that the connection is alive.
    Ping,
}

/// Events for the operator or the host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TeamPortEvent {
    /// The controller has accepted our registration; `verified`: by a signature.
    Registered {
        /// Whether the registration was verified by a signature.
        verified: bool,
    },
    /// The registration is refused; we try again after [`RETRY_AFTER`].
    RegistrationRefused {
        /// The controller's reason, as text.
        reason: String,
    },
    /// A request was granted.
    Granted(TeamPortRequest),
    /// A request was refused.
    Refused {
        /// The request that was refused.
        request: TeamPortRequest,
        /// The controller's reason, as text.
        reason: String,
    },
    /// The connection is closed; we connect again after [`RETRY_AFTER`].
    GivenUp(Trouble),
}

/// Why a connection is given up.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Trouble {
    /// The connection was closed, or could not be opened; the requests that waited are kept.
    #[error("the game controller's port for teams closed, or is not open")]
    Closed,
    /// No answer within [`REPLY_TIME`].
    #[error("no answer from the game controller within {} s", REPLY_TIME.as_secs_f32())]
    NoAnswer,
    /// The bytes received are not the protocol of the port for teams.
    #[error("this is not the game controller's port for teams (10008): {0}")]
    NotTheTeamPort(String),
}

/// State of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConnectionStage {
    /// Not connected to the controller.
    Apart,
    /// Connected; the controller sends first.
    KnownEpoch,
    /// Our registration was sent.
    Registering,
    /// The controller has accepted it.
    Registered,
}

/// A team's connection with the game controller.
#[derive(Debug)]
pub struct TeamPort {
    name: String,
    colour: Colour,
    stage: ConnectionStage,
    reader: FrameReader,
    token: Option<String>,
    out: VecDeque<Vec<u8>>,
    events: VecDeque<TeamPortEvent>,
    waiting: VecDeque<TeamPortRequest>,
    /// The request whose reply is awaited.
    asked: Option<TeamPortRequest>,
    /// When the next reply must have come, if one is due.
    deadline: Option<Instant>,
    /// Earliest time of the next attempt.
    retry: Instant,
    /// When the last message went out.
    spoke: Instant,
}

impl TeamPort {
    /// A team of that name and colour; nothing is connected.
    pub fn new(name: impl Into<String>, colour: Colour) -> Self {
        Self {
            name: name.into(),
            colour,
            stage: ConnectionStage::Apart,
            reader: FrameReader::new(MESSAGE_MAX),
            token: None,
            out: VecDeque::new(),
            events: VecDeque::new(),
            waiting: VecDeque::new(),
            asked: None,
            deadline: None,
            retry: Instant(0),
            spoke: Instant(0),
        }
    }

    /// State of the connection.
    pub fn stage(&self) -> ConnectionStage {
        self.stage
    }

    /// The token that a signature of the next message would cover.
    pub fn token(&self) -> Option<&str> {
        self.token.as_deref()
    }

    /// Whether the shell should (try to) connect now.
    pub fn wants_connection(&self, now: Instant) -> bool {
        self.stage == ConnectionStage::Apart && now >= self.retry
    }

    /// Handles an opened connection.
    pub fn connected(&mut self, now: Instant) {
        self.forget();
        self.stage = ConnectionStage::KnownEpoch;
        self.deadline = Some(now + REPLY_TIME);
    }

    /// Handles a connection that was closed, or could not be opened.
    pub fn lost(&mut self, now: Instant) {
        self.give_up(Trouble::Closed, now);
    }

    /// Sends a request as soon as the client is registered and has the answer to the one before. A request
    /// takes the place of one of its kind that still waits, so no more wait than there are kinds.
    pub fn ask(&mut self, request: TeamPortRequest, now: Instant) {
        match self.waiting.iter_mut().find(|waiting| same_kind(**waiting, request)) {
            Some(waiting) => *waiting = request,
            None => self.waiting.push_back(request),
        }
        self.send_next(now);
    }

    /// Takes bytes that were received, in pieces of any length.
    pub fn receive(&mut self, bytes: &[u8], now: Instant) {
        if self.stage == ConnectionStage::Apart {
            return;
        }
        self.reader.push(bytes);
        loop {
            let reply = match self.reader.next_message() {
                Ok(None) => return,
                Ok(Some(message)) => match ControllerToTeam::decode(message) {
                    Ok(ControllerToTeam { controller_reply: Some(reply) }) => reply,
                    // A message of a newer controller that the client does not use.
                    Ok(_) => continue,
                    Err(broken) => return self.give_up(Trouble::NotTheTeamPort(broken.to_string()), now),
                },
                Err(broken) => return self.give_up(Trouble::NotTheTeamPort(broken.to_string()), now),
            };
            self.reply(reply, now);
            if self.stage == ConnectionStage::Apart {
                return;
            }
        }
    }

    /// Handles deadlines at `now`.
    pub fn tick(&mut self, now: Instant) {
        if self.deadline.is_some_and(|deadline| now >= deadline) {
            self.give_up(Trouble::NoAnswer, now);
        } else if self.stage == ConnectionStage::Registered
            && self.asked.is_none()
            && now.since(self.spoke) >= PING_EVERY
        {
            self.ask(TeamPortRequest::Ping, now);
        }
    }

    /// Bytes to be sent, in order.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// Events, in order. On [`TeamPortEvent::GivenUp`] and [`TeamPortEvent::RegistrationRefused`] the shell
    /// closes the connection.
    pub fn poll_event(&mut self) -> Option<TeamPortEvent> {
        self.events.pop_front()
    }

    fn reply(&mut self, reply: ControllerReply, now: Instant) {
        let code = reply.status_code();
        let rejected = code == StatusCode::Rejected;
        let verified = reply.verification() == Verification::Verified;
        let reason = reply.reason.unwrap_or_else(|| "without a reason".to_owned());
        self.token = reply.next_token.or(self.token.take());
        self.deadline = None;
        match self.stage {
            ConnectionStage::Apart => {}
            ConnectionStage::KnownEpoch => {
                let registration = TeamRegistration {
                    team_name: self.name.clone(),
                    signature: None,
                    team: Some(team_of(self.colour) as i32),
                };
                self.stage = ConnectionStage::Registering;
                self.send(delimited(&registration), now);
            }
            ConnectionStage::Registering if rejected => {
                self.forget();
                self.retry = now + RETRY_AFTER;
                self.events.push_back(TeamPortEvent::RegistrationRefused { reason });
            }
            ConnectionStage::Registering => {
                self.stage = ConnectionStage::Registered;
                self.events.push_back(TeamPortEvent::Registered { verified });
                self.send_next(now);
            }
            ConnectionStage::Registered => {
                // A reply without a request changes nothing.
                match self.asked.take() {
                    None | Some(TeamPortRequest::Ping) => {}
                    Some(request) if rejected => {
                        self.events.push_back(TeamPortEvent::Refused { request, reason });
                    }
                    Some(request) => self.events.push_back(TeamPortEvent::Granted(request)),
                }
                self.send_next(now);
            }
        }
    }

    fn send_next(&mut self, now: Instant) {
        if self.stage != ConnectionStage::Registered || self.asked.is_some() {
            return;
        }
        let Some(request) = self.waiting.pop_front() else { return };
        let msg = match request {
            TeamPortRequest::Keeper(id) => TeamRequest::DesiredKeeper(i32::from(id.number())),
            TeamPortRequest::Substitute(wanted) => TeamRequest::SubstituteBot(wanted),
            TeamPortRequest::Advantage { go_on: true } => {
                TeamRequest::AdvantageChoice(AdvantageChoice::Continue as i32)
            }
            TeamPortRequest::Advantage { go_on: false } => {
                TeamRequest::AdvantageChoice(AdvantageChoice::Stop as i32)
            }
            TeamPortRequest::Ping => TeamRequest::Ping(true),
        };
        self.asked = Some(request);
        self.send(delimited(&TeamToController { signature: None, msg: Some(msg) }), now);
    }

    fn send(&mut self, bytes: Vec<u8>, now: Instant) {
        self.out.push_back(bytes);
        self.spoke = now;
        self.deadline = Some(now + REPLY_TIME);
    }

    fn give_up(&mut self, trouble: Trouble, now: Instant) {
        // A request without an answer is sent again, unless a newer one of its kind waits.
        let asked = self.asked.take();
        if let Some(asked) = asked
            && !self.waiting.iter().any(|waiting| same_kind(*waiting, asked))
        {
            self.waiting.push_front(asked);
        }
        self.forget();
        self.retry = now + RETRY_AFTER;
        self.events.push_back(TeamPortEvent::GivenUp(trouble));
    }

    /// Drops the connection's state; requests are kept, except pings.
    fn forget(&mut self) {
        self.stage = ConnectionStage::Apart;
        self.reader = FrameReader::new(MESSAGE_MAX);
        self.token = None;
        self.out.clear();
        self.asked = None;
        self.deadline = None;
        self.waiting.retain(|request| *request != TeamPortRequest::Ping);
    }
}

fn same_kind(a: TeamPortRequest, b: TeamPortRequest) -> bool {
    std::mem::discriminant(&a) == std::mem::discriminant(&b)
}

#[cfg(test)]
mod tests;
