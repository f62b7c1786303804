//! `controller`: a match that an external game controller runs: its packets are received, an automatic
//! referee reports to it, and the human's tasks are done.

use std::net::SocketAddr;
use std::time::Duration;

use crate::small_size::referee::NoRules;
use crate::small_size::referee::remote::{Assistant, AutoReferee, Decider, RemoteMatch};
use crate::small_size::{PhysicsEvent, World};
use rules::League;
use ssl::Message;
use ssl::net::{Interfaces, NetReceiver};

use super::autoref::Reporter;

/// A port or group that cannot be opened is tried again this often.
const REOPEN_AFTER: Duration = Duration::from_secs(1);
/// Most packets received in one step: a flood must not stop the world.
const PACKETS_MAX: usize = 64;

/// The external controller's receiver, and the services for it.
pub(super) struct ExternalController {
    from: SocketAddr,
    receiver: Option<NetReceiver>,
    /// When opening the receiver was last tried, running time.
    tried: Option<Duration>,
    troubled: bool,
    silent: bool,
    league: League,
    game: RemoteMatch,
    assistant: Option<Assistant>,
    autoref: Option<(AutoReferee, Reporter)>,
}

impl ExternalController {
    /// Receives the controller at `from`; `assistant` and `autoref` enable the services.
    pub(super) fn new(
        from: SocketAddr,
        league: League,
        assistant: bool,
        autoref: Option<&str>,
    ) -> Result<Self, NoRules> {
        Ok(Self {
            from,
            receiver: None,
            tried: None,
            troubled: false,
            silent: true,
            league,
            game: RemoteMatch::new(league)?,
            assistant: assistant.then(Assistant::default),
            autoref: autoref.map(|to| (AutoReferee::new(decider(assistant)), Reporter::new(to))),
        })
    }

    /// Another simulated game starts; the controller's own goes on.
    pub(super) fn restart(&mut self) -> Result<(), NoRules> {
        self.game = RemoteMatch::new(self.league)?;
        let decides = self.assistant.is_some();
        self.assistant = self.assistant.take().map(|_| Assistant::default());
        if let Some((autoref, _)) = &mut self.autoref {
            *autoref = AutoReferee::new(decider(decides));
        }
        Ok(())
    }

    /// Lines that describe its services, for the operator.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = vec![format!("referee  received at {}", self.from)];
        if self.assistant.is_some() {
            lines.push("assistant  puts the ball, takes robots off and brings them back".to_owned());
        }
        if let Some((_, reporter)) = &self.autoref {
            let goals =
                if self.assistant.is_some() { "goals are decided" } else { "goals are left to a person" };
            lines.push(format!("autoref  reports to {}; {goals}", reporter.to()));
        }
        lines
    }

    pub(super) fn state(&self) -> String {
        if self.silent { "no referee".to_owned() } else { self.game.phase().to_string() }
    }

    /// Receives waiting packets; they go to `packets`, lines for the operator to `lines`.
    pub(super) fn listen(
        &mut self,
        world: &World,
        running: Duration,
        packets: &mut Vec<Vec<u8>>,
        lines: &mut Vec<String>,
    ) {
        if self.receiver.is_none()
            && self.tried.is_none_or(|tried| running.saturating_sub(tried) >= REOPEN_AFTER)
        {
            self.tried = Some(running);
            match NetReceiver::open(self.from, &Interfaces::All) {
                Ok(receiver) => {
                    self.troubled = false;
                    self.receiver = Some(receiver);
                }
                Err(error) if !std::mem::replace(&mut self.troubled, true) => {
                    lines.push(format!("referee  {error}; it is tried again every second"));
                }
                Err(_) => {}
            }
        }
        let (now, ball) = (time_of(world), world.ball.position);
        if let Some(receiver) = &mut self.receiver {
            for _ in 0..PACKETS_MAX {
                match receiver.receive(Duration::ZERO) {
                    Ok(Some(datagram)) => {
                        if let Ok(packet) = ssl::referee::Referee::decode(datagram.bytes) {
                            packets.push(datagram.bytes.to_vec());
                            self.game.receive(packet, now, ball);
                        }
                    }
                    Ok(None) => break,
                    Err(error) => {
                        lines.push(format!("referee  {error}; it is opened again"));
                        self.receiver = None;
                        break;
                    }
                }
            }
        }
        let silent = self.game.is_silent(now);
        if silent != std::mem::replace(&mut self.silent, silent) {
            lines.push(if silent {
                format!("referee  nothing received at {}", self.from)
            } else {
                format!("referee  a game controller is received at {}", self.from)
            });
        }
        if let Some((_, reporter)) = &mut self.autoref {
            lines.extend(std::iter::from_fn(|| reporter.next_line()).map(|line| format!("autoref  {line}")));
        }
    }

    /// Runs the services on the world; `events` are the world's since the last call.
    pub(super) fn look(&mut self, world: &mut World, events: &[PhysicsEvent], lines: &mut Vec<String>) {
        self.game.set_field(world.pitch().field);
        self.game.tick(time_of(world), world.ball.position);
        if let Some((autoref, reporter)) = &mut self.autoref {
            for event in autoref.look(&self.game, world, events) {
                // Time and identifier are the controller's: its clock is not the simulation's.
                let Some(mut reported) = event.to_wire(0) else { continue };
                (reported.created_timestamp, reported.id) = (None, None);
                lines.push(format!("autoref  {}", line_of(&event)));
                reporter.report(reported);
            }
        }
        if let Some(assistant) = &mut self.assistant {
            for action in assistant.look(&self.game, world) {
                action.order.carry_out(world);
                lines.push(format!("assistant  {action}"));
            }
        }
    }
}

/// Without a human at the controller the automatic referee decides about goals too.
const fn decider(assistant: bool) -> Decider {
    if assistant { Decider::AutoReferee } else { Decider::Person }
}

fn line_of(event: &crate::small_size::referee::RefereeEvent) -> String {
    let by = match (event.by, event.robot) {
        (Some(team), Some(robot)) => format!(" by {} {}", team.label(), robot.number()),
        (Some(team), None) => format!(" by {}", team.label()),
        (None, _) => String::new(),
    };
    format!("{}{by} at ({:.2}, {:.2}) m", event.what.kind().label(), event.place.x(), event.place.y())
}

fn time_of(world: &World) -> protocol::Instant {
    protocol::Instant(world.now() * 1000)
}
