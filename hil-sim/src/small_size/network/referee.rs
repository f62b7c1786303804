//! `referee`: the referee beside a field on the network: the internal one, a game controller that the field's
//! clock leads, an external one with its services, or none.

use std::time::Duration;

use ssl::Message;
use ssl::net::{NetSender, addresses};

use super::ci::{CiController, ControllerChoice};
use super::controller::ExternalController;
use super::failure::CiError;
use super::{NetworkSettings, RefereeKind};
use crate::small_size::camera::Cameras;
use crate::small_size::referee::{InternalReferee, NoRules, RefereeSettings};
use crate::small_size::{PhysicsEvent, World};

/// Period of the referee, simulated ms: its detectors are tuned for it.
pub(super) const REFEREE_EVERY_MS: u64 = 10;

/// The referee source, and what it published.
pub(super) struct Referee {
    source: RefereeSource,
    sender: NetSender,
    /// Packets are sent: the field's ports are its own.
    pub(super) sends: bool,
    events: Vec<PhysicsEvent>,
    /// The step of the world at its last call.
    looked: u64,
    /// Time that the world has been advanced to, µs.
    pub(super) advanced: u64,
    /// Packets that were sent or received since the spectator last took them.
    pub(super) packets: Vec<Vec<u8>>,
    /// The controller that the field leads failed.
    pub(super) failure: Option<CiError>,
}

enum RefereeSource {
    Internal(Box<InternalReferee>),
    None,
    External(Box<ExternalController>),
    Led(Box<Led>),
}

/// A game controller whose clock is the field's, with the internal referee that follows it.
struct Led {
    choice: ControllerChoice,
    controller: CiController,
    referee: InternalReferee,
}

impl Led {
    fn start(
        choice: &ControllerChoice,
        settings: &NetworkSettings,
        seed: u64,
        world: &World,
    ) -> Result<Box<Self>, CiError> {
        let referee = settings_of(settings);
        let vision = settings.server.model.vision;
        let cameras = Cameras::of_model(settings.server.profile, 0.0, world, vision, seed);
        let controller = CiController::start(choice, &referee, seed, cameras.geometry(world, None))?;
        let referee = InternalReferee::new(referee, seed)?;
        Ok(Box::new(Self { choice: choice.clone(), controller, referee }))
    }
}

impl Referee {
    pub(super) fn new(settings: &NetworkSettings, world: &World) -> Result<Self, CiError> {
        let league = settings.server.league;
        let external = |from| {
            let (assistant, autoref) = (settings.assistant, settings.autoref.as_deref());
            ExternalController::new(from, league, assistant, autoref)
                .map(|controller| RefereeSource::External(Box::new(controller)))
        };
        let serves = settings.assistant || settings.autoref.is_some();
        let seed = settings.server.seed;
        let source = match settings.referee {
            _ if let Some(choice) = &settings.controller => {
                RefereeSource::Led(Led::start(choice, settings, seed, world)?)
            }
            RefereeKind::Internal => RefereeSource::Internal(internal(settings, seed)?),
            RefereeKind::None if serves => external(addresses::REFEREE.into())?,
            RefereeKind::None => RefereeSource::None,
            RefereeKind::Received(from) => external(from)?,
        };
        let sender = NetSender::new(settings.referee_to, settings.interface.as_deref());
        Ok(Self {
            source,
            sender,
            sends: true,
            events: Vec::new(),
            looked: 0,
            advanced: 0,
            packets: Vec::new(),
            failure: None,
        })
    }

    /// Another game starts; the internal referee starts again with it, an external game controller does not
    /// know of it.
    pub(super) fn restart(
        &mut self,
        settings: &NetworkSettings,
        seed: u64,
        world: &World,
    ) -> Result<(), CiError> {
        match &mut self.source {
            RefereeSource::Led(led) => {
                let choice = led.choice.clone();
                // A controller takes one connection at a time: the old one ends first.
                self.source = RefereeSource::None;
                self.source = RefereeSource::Led(Led::start(&choice, settings, seed, world)?);
            }
            RefereeSource::Internal(referee) => *referee = internal(settings, seed)?,
            RefereeSource::External(controller) => controller.restart()?,
            RefereeSource::None => {}
        }
        self.events.clear();
        self.looked = 0;
        Ok(())
    }

    pub(super) fn lines(&self) -> Vec<String> {
        match &self.source {
            RefereeSource::Internal(_) => vec![format!("referee  internal, to {}", self.sender.to())],
            RefereeSource::None => vec!["referee  none".to_owned()],
            RefereeSource::Led(led) => vec![format!(
                "referee  game controller {}, by this field's clock, to {}",
                led.choice,
                self.sender.to()
            )],
            RefereeSource::External(controller) => controller.lines(),
        }
    }

    pub(super) fn internal(&mut self) -> Option<&mut InternalReferee> {
        match &mut self.source {
            RefereeSource::Internal(referee) => Some(referee),
            RefereeSource::None | RefereeSource::External(_) | RefereeSource::Led(_) => None,
        }
    }

    pub(super) fn state(&self) -> String {
        match &self.source {
            RefereeSource::Internal(referee) => referee.phase().to_string(),
            RefereeSource::None => "no referee".to_owned(),
            RefereeSource::Led(led) => led.referee.phase().to_string(),
            RefereeSource::External(controller) => controller.state(),
        }
    }

    /// The referee observes the world, and the assistant's tasks are done.
    pub(super) fn look(&mut self, world: &mut World, lines: &mut Vec<String>) {
        world.take_events(&mut self.events);
        if world.now() < self.looked + REFEREE_EVERY_MS {
            return;
        }
        self.looked = world.now();
        let mut published = Vec::new();
        match &mut self.source {
            RefereeSource::Internal(referee) => {
                referee.look(world, &self.events);
                while let Some(order) = referee.poll_order() {
                    order.carry_out(world);
                }
                published.extend(std::iter::from_fn(|| referee.poll_packet()));
            }
            RefereeSource::Led(led) => match led.controller.look(world, &self.events, &mut led.referee) {
                Ok(packets) => published = packets,
                Err(error) => self.failure = Some(error),
            },
            RefereeSource::External(controller) => controller.look(world, &self.events, lines),
            RefereeSource::None => {}
        }
        self.events.clear();
        for packet in published {
            let bytes = packet.encode_to_vec();
            if self.sends {
                lines.extend(self.sender.send(&bytes));
            }
            self.packets.push(bytes);
        }
    }

    /// Receives an external game controller, if there is one.
    pub(super) fn listen(&mut self, world: &World, running: Duration, lines: &mut Vec<String>) {
        if let RefereeSource::External(controller) = &mut self.source {
            controller.listen(world, running, &mut self.packets, lines);
        }
    }
}

fn internal(settings: &NetworkSettings, seed: u64) -> Result<Box<InternalReferee>, NoRules> {
    InternalReferee::new(settings_of(settings), seed).map(Box::new)
}

fn settings_of(settings: &NetworkSettings) -> RefereeSettings {
    RefereeSettings {
        epoch_us: settings.unix_us,
        blue_on_positive_half: false,
        max_robots: settings.robots,
        ..RefereeSettings::new(settings.server.league)
    }
}
