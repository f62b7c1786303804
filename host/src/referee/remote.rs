//! `remote`: a team's remote control at the game controller (TCP 10011): time-outs, emergency stop,
//! challenge flag, substitution, keeper, a failed placement. Each request is answered with the team's state.
//!
//! The controller sends first, and takes one remote control for each team. Messages are unsigned: it accepts
//! those unless it has a key of the team.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use foreign::excerpt;
use protocol::RobotId;
use rules::Colour;
use serde::Serialize;
use ssl::Message;
use ssl::controller::StatusCode;
use ssl::controller::remote::{
    ControllerToRemote, RemoteKind, RemoteMessage, RemoteOnce, RemoteRegistration, RemoteTeamState,
    RemoteToController,
};
use ssl::stream::{FrameReader, MESSAGE_MAX, delimited};
use thiserror::Error;

use super::description::team_of;

/// The controller answers within this; see [`super::team_port::REPLY_TIME`].
const REPLY_TIME: Duration = Duration::from_secs(3);
/// Longest name of a request that is repeated, characters.
const NAME_CHARS_MAX: usize = 40;
/// Longest reason that is repeated, characters.
const REASON_CHARS_MAX: usize = 200;

/// What is asked of the game controller for our team.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemoteRequest {
    /// Nothing: the state alone.
    Status,
    /// A timeout at the next stoppage; `false` withdraws it.
    Timeout(bool),
    /// The end of our timeout.
    EndTimeout,
    /// An emergency stop; `false` withdraws it.
    EmergencyStop(bool),
    /// A challenge flag; it cannot be withdrawn.
    Challenge,
    /// A substitution at the next opportunity; `false` withdraws it.
    Substitution(bool),
    /// This robot, by its shell, as our keeper.
    Keeper(RobotId),
    /// Our ball placement counts as failed.
    FailPlacement,
}

/// Names of the requests that need no robot.
const NAMES: [(&str, RemoteRequest); 10] = [
    ("status", RemoteRequest::Status),
    ("timeout", RemoteRequest::Timeout(true)),
    ("withdraw-timeout", RemoteRequest::Timeout(false)),
    ("end-timeout", RemoteRequest::EndTimeout),
    ("emergency-stop", RemoteRequest::EmergencyStop(true)),
    ("withdraw-emergency-stop", RemoteRequest::EmergencyStop(false)),
    ("challenge", RemoteRequest::Challenge),
    ("substitution", RemoteRequest::Substitution(true)),
    ("withdraw-substitution", RemoteRequest::Substitution(false)),
    ("fail-placement", RemoteRequest::FailPlacement),
];

impl RemoteRequest {
    /// The request of that name; `keeper` is for the one of that name alone. Error: what is expected.
    pub fn named(name: &str, keeper: Option<u8>) -> Result<Self, String> {
        let known = NAMES.iter().find(|(known, _)| *known == name);
        match (known, keeper) {
            (Some((_, request)), None) => Ok(*request),
            (Some(_), Some(_)) => Err(format!("{name}: it is for no robot: leave the number out")),
            (None, _) if name == "keeper" => {
                let robot = keeper.and_then(RobotId::new);
                robot.map(Self::Keeper).ok_or_else(|| "keeper: name a robot, 0 to 15".to_owned())
            }
            (None, _) => {
                let names: Vec<_> = Self::names().collect();
                let name = excerpt(name, NAME_CHARS_MAX);
                Err(format!("`{name}` is no request of a remote control: {}", names.join(", ")))
            }
        }
    }

    /// Names of all requests.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|(name, _)| *name).chain(["keeper"])
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, request)| *request == self).map_or("keeper", |(name, _)| name)
    }

    fn message(self) -> RemoteMessage {
        match self {
            Self::Status => RemoteMessage::Once(RemoteOnce::Ping as i32),
            Self::Timeout(on) => RemoteMessage::Timeout(on),
            Self::EndTimeout => RemoteMessage::Once(RemoteOnce::StopTimeout as i32),
            Self::EmergencyStop(on) => RemoteMessage::EmergencyStop(on),
            Self::Challenge => RemoteMessage::Once(RemoteOnce::ChallengeFlag as i32),
            Self::Substitution(on) => RemoteMessage::Substitution(on),
            Self::Keeper(robot) => RemoteMessage::DesiredKeeper(i32::from(robot.number())),
            Self::FailPlacement => RemoteMessage::Once(RemoteOnce::FailBallPlacement as i32),
        }
    }
}

/// State of our team, as the game controller gives it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RemoteState {
    /// Requests that can be made now, by the names of [`RemoteRequest`].
    pub available: Vec<&'static str>,
    /// Requests that wait.
    pub active: Vec<&'static str>,
    /// Shell number of the keeper.
    pub keeper: Option<i32>,
    /// Time until the emergency stop, s; 0: none is requested.
    pub emergency_stop_in_s: f32,
    /// Number of timeouts left.
    pub timeouts_left: i32,
    /// Time of timeouts left, s.
    pub timeout_left_s: f32,
    /// Number of challenge flags left.
    pub challenge_flags_left: i32,
    /// Number of robots allowed now.
    pub max_robots: i32,
    /// Number of robots that the controller has on the field.
    pub robots_on_field: i32,
    /// Time until each yellow card ends, s.
    pub yellow_cards_due_s: Vec<f32>,
    /// Whether robots may be substituted now.
    pub can_substitute: bool,
    /// Number of substitutions left in this half.
    pub substitutions_left: u32,
    /// Time left for the present substitution, s.
    pub substitution_left_s: f32,
}

impl From<RemoteTeamState> for RemoteState {
    fn from(state: RemoteTeamState) -> Self {
        Self {
            available: state.available_requests().filter_map(name_of).collect(),
            active: state.active_requests().filter_map(name_of).collect(),
            keeper: state.keeper_id,
            emergency_stop_in_s: state.emergency_stop_in(),
            timeouts_left: state.timeouts_left(),
            timeout_left_s: state.timeout_time_left(),
            challenge_flags_left: state.challenge_flags_left(),
            max_robots: state.max_robots(),
            robots_on_field: state.robots_on_field(),
            yellow_cards_due_s: state.yellow_cards_due.clone(),
            can_substitute: state.can_substitute_robot(),
            substitutions_left: state.bot_substitutions_left(),
            substitution_left_s: state.bot_substitution_time_left(),
        }
    }
}

const fn name_of(kind: RemoteKind) -> Option<&'static str> {
    Some(match kind {
        RemoteKind::Unknown => return None,
        RemoteKind::EmergencyStop => "emergency-stop",
        RemoteKind::RobotSubstitution => "substitution",
        RemoteKind::Timeout => "timeout",
        RemoteKind::ChallengeFlag => "challenge",
        RemoteKind::ChangeKeeper => "keeper",
        RemoteKind::StopTimeout => "end-timeout",
        RemoteKind::FailBallPlacement => "fail-placement",
    })
}

/// Why a request was not granted.
#[derive(Debug, Error)]
pub enum RemoteError {
    /// The connection could not be opened, or has failed.
    #[error(
        "no game controller's remote control port at {0}: {1}; is the controller running (its port is 10011)?"
    )]
    Connection(String, io::Error),
    /// The answer is no message of the protocol.
    #[error("this is not the game controller's remote control port (10011): {0}")]
    Foreign(String),
    /// The controller has refused us.
    #[error(
        "the game controller refuses this remote control: {0}; end the other one of this team, if there is one"
    )]
    NotRegistered(String),
    /// The controller has refused the request.
    #[error("the game controller refuses: {0}")]
    Refused(String),
}

impl RemoteError {
    /// The error as that of a registration.
    fn of_registration(self) -> Self {
        match self {
            Self::Refused(reason) => Self::NotRegistered(reason),
            other => other,
        }
    }
}

fn open(address: SocketAddr) -> io::Result<TcpStream> {
    let stream = TcpStream::connect_timeout(&address, REPLY_TIME)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(REPLY_TIME))?;
    stream.set_write_timeout(Some(REPLY_TIME))?;
    Ok(stream)
}

/// A registered remote control.
#[derive(Debug)]
pub struct RemoteControl<S = TcpStream> {
    stream: S,
    reader: FrameReader,
    address: String,
}

impl RemoteControl {
    /// Connects to the controller and registers for `colour`.
    pub fn connect(address: SocketAddr, colour: Colour) -> Result<Self, RemoteError> {
        let stream = open(address).map_err(|error| RemoteError::Connection(address.to_string(), error))?;
        Self::register(stream, address.to_string(), colour)
    }
}

impl<S: Read + Write> RemoteControl<S> {
    fn register(stream: S, address: String, colour: Colour) -> Result<Self, RemoteError> {
        let mut control = Self { stream, reader: FrameReader::new(MESSAGE_MAX), address };
        control.answer().map_err(RemoteError::of_registration)?;
        control.send(&RemoteRegistration { team: team_of(colour) as i32, signature: None })?;
        control.answer().map_err(RemoteError::of_registration)?;
        Ok(control)
    }

    /// Asks for something; returns the team's state after it.
    pub fn ask(&mut self, request: RemoteRequest) -> Result<RemoteState, RemoteError> {
        self.send(&RemoteToController { signature: None, msg: Some(request.message()) })?;
        let state =
            self.answer()?.ok_or_else(|| RemoteError::Foreign("an answer without a state".to_owned()))?;
        Ok(state.into())
    }

    fn send(&mut self, message: &impl Message) -> Result<(), RemoteError> {
        let sent = self.stream.write_all(&delimited(message));
        sent.map_err(|error| RemoteError::Connection(self.address.clone(), error))
    }

    /// The controller's next answer.
    fn answer(&mut self) -> Result<Option<RemoteTeamState>, RemoteError> {
        let mut chunk = [0; 4096];
        loop {
            if let Some(message) =
                self.reader.next_message().map_err(|error| RemoteError::Foreign(error.to_string()))?
            {
                let answer = ControllerToRemote::decode(message)
                    .map_err(|error| RemoteError::Foreign(error.to_string()))?;
                // A message without a reply is one of a newer controller.
                let Some(reply) = answer.controller_reply else { continue };
                if reply.status_code() != StatusCode::Rejected {
                    return Ok(answer.state);
                }
                let reason = reply.reason.as_deref().unwrap_or("without a reason");
                return Err(RemoteError::Refused(excerpt(reason, REASON_CHARS_MAX)));
            }
            let read = self.stream.read(&mut chunk);
            let read =
                read.and_then(|n| if n > 0 { Ok(n) } else { Err(io::ErrorKind::UnexpectedEof.into()) });
            let read = read.map_err(|error| RemoteError::Connection(self.address.clone(), error))?;
            self.reader.push(&chunk[..read]);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use super::*;

    /// What ssl-game-controller (78a9b3bb) sent to a remote control of blue in HALT, and what it was sent:
    /// after its greeting registration, timeout, end of the timeout, keeper 3, emergency stop.
    const DIALOGUE: [(&str, &str); 6] = [
        ("", "0a2a08011a2431393338653539622d626235392d343237612d393134612d3138333963373466353765372001"),
        ("0802", "0a0408012002"),
        (
            "2801",
            "0a04080120021229080308020804080510031800250000000028043003380b480055000096435800600268057500000000",
        ),
        (
            "1003",
            "0a370802123143616e206e6f742073746f702074696d656f75743a2054696d656f7574206e6f742061637469766520666f72207465616d2002",
        ),
        (
            "1803",
            "0a0408012002122708030802080408051803250000000028043003380b480055000096435800600268057500000000",
        ),
        (
            "3001",
            "0a460802124043616e206e6f74207265717565737420656d657267656e63792073746f703a2047616d6520737461746520697320696e76616c69643a20747970653a48414c542002",
        ),
    ];

    /// The controller's side of the dialogue.
    struct Recorded {
        left: VecDeque<(Vec<u8>, Vec<u8>)>,
    }

    impl Recorded {
        fn new() -> Self {
            let bytes = |digits: &str| -> Vec<u8> {
                let pairs = digits.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).unwrap());
                let bytes: Vec<u8> = pairs.map(|pair| u8::from_str_radix(pair, 16).unwrap()).collect();
                if bytes.is_empty() { bytes } else { [vec![bytes.len() as u8], bytes].concat() }
            };
            Self { left: DIALOGUE.iter().map(|(sent, answer)| (bytes(sent), bytes(answer))).collect() }
        }
    }

    impl Read for Recorded {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let Some((sent, answer)) = self.left.front_mut() else { return Ok(0) };
            assert!(sent.is_empty(), "{sent:02x?} was not sent");
            // In pieces of seven bytes.
            let n = answer.len().min(7);
            buffer[..n].copy_from_slice(&answer[..n]);
            answer.drain(..n);
            if answer.is_empty() {
                self.left.pop_front();
            }
            Ok(n)
        }
    }

    impl Write for Recorded {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let (sent, _) = self.left.front_mut().expect("an answer is recorded");
            assert_eq!(sent, bytes);
            sent.clear();
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn the_recorded_dialogue_of_the_leagues_controller_is_spoken_and_understood() {
        let mut control =
            RemoteControl::register(Recorded::new(), "recorded".to_owned(), Colour::Blue).unwrap();
        let state = control.ask(RemoteRequest::Timeout(true)).unwrap();
        assert_eq!(state.active, ["timeout"]);
        assert_eq!(state.available, ["timeout", "substitution", "challenge", "keeper"]);
        assert_eq!((state.timeouts_left, state.timeout_left_s, state.max_robots), (4, 300.0, 11));
        assert_eq!((state.challenge_flags_left, state.substitutions_left, state.keeper), (3, 5, Some(0)));
        let refused = control.ask(RemoteRequest::EndTimeout).unwrap_err().to_string();
        assert!(refused.ends_with("Timeout not active for team"), "{refused}");
        let keeper = control.ask(RemoteRequest::named("keeper", Some(3)).unwrap()).unwrap();
        assert_eq!((keeper.keeper, keeper.active.len()), (Some(3), 0));
        let refused = control.ask(RemoteRequest::EmergencyStop(true)).unwrap_err().to_string();
        assert!(refused.contains("Game state is invalid"), "{refused}");
    }

    #[test]
    fn every_request_has_a_name_that_leads_back_to_it() {
        for name in RemoteRequest::names() {
            let robot = (name == "keeper").then_some(3);
            assert_eq!(RemoteRequest::named(name, robot).unwrap().name(), name);
        }
        assert!(RemoteRequest::named("keeper", None).unwrap_err().contains("0 to 15"));
        assert!(RemoteRequest::named("status", Some(1)).is_err());
        assert!(RemoteRequest::named("goal", None).unwrap_err().contains("withdraw-timeout"));
    }
}
