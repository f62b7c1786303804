//! `side`: one side of a match: its host, its robots' computers, and the radio between them. Times in ticks
//! of 10 ms and µs.

use geometry::{Angle, GoalEnd, Pose};
use hil_sim::small_size::worlds::LinkModel;
use hil_sim::small_size::{Order, World};
use hil_sim::{Air, AirSettings, Backend, LinkLoss, Mcu, TraceHash};
use host::external::{StrategyLink, StrategyStarter};
use host::radio::{RadioSettings, Relay, To};
use host::{Host, HostSettings, Input};
use protocol::decision::DecisionReport;
use protocol::lockstep::TickIn;
use protocol::{Instant, RobotId, Who};
use rules::Colour;
use rules::restart::kickoff_places;

use super::{GameConfig, GameError, TICK_US, TeamSetup, Watcher, numbers};

pub(super) struct Team<'a> {
    pub(super) host: Box<Host>,
    strategy: Option<Box<dyn StrategyLink>>,
    colour: Colour,
    air: Air,
    players: Vec<Player<'a>>,
}

struct Player<'a> {
    who: Who,
    /// `None` while it is off.
    computer: Option<Box<dyn Mcu + 'a>>,
    /// The tick in which it booted: its clock's zero.
    booted: u32,
    epoch: u32,
    worst_instructions: u32,
    /// It moves along a recording: its body obeys none of its orders.
    led: bool,
}

impl<'a> Team<'a> {
    /// Robots on the field, computers and host started.
    pub(super) fn new(
        config: &GameConfig,
        setup: &TeamSetup,
        link: &LinkModel,
        world: &mut World,
        backend: &mut dyn Backend<'a>,
    ) -> Result<Self, GameError> {
        let colour = setup.colour;
        let own = own_goal(config, colour);
        let ids: Vec<RobotId> = match &config.start {
            Some(start) => start.robots(colour).collect(),
            None => numbers(setup.robots).collect(),
        };
        let mut players = Vec::new();
        // As for the other team's kick-off: no robot in the circle. The keeper comes first.
        let places = kickoff_places(&config.league.field(), own, false);
        let heading = if own == GoalEnd::Positive { Angle::HALF_TURN } else { Angle::ZERO };
        for (id, position) in ids.iter().zip(places) {
            let who = Who { colour, id: *id };
            world.put(who, Pose { position, heading });
            let brain = brain::BrainConfig { defending: own, ..setup.brain(config.league, *id) };
            let computer = backend.boot(&brain).map_err(|error| GameError::Computer(who, error))?;
            let epoch = brain.epoch;
            let (computer, led) = (Some(computer), false);
            players.push(Player { who, computer, booted: 0, epoch, worst_instructions: 0, led });
        }
        let settings = host_settings(config, colour);
        let seed = config.seed ^ colour as u64;
        let air = Air::with_host(link.over(&config.air), seed, &ids);
        let strategy = setup.strategy.as_ref().map(started).transpose()?;
        let host = Box::new(Host::new(settings, Instant(0)));
        Ok(Self { host, strategy, colour, air, players })
    }

    /// The newest decision of each robot whose computer can be looked into.
    pub(super) fn decisions(&self) -> impl Iterator<Item = (RobotId, DecisionReport)> {
        self.players.iter().filter_map(|player| Some((player.who.id, player.computer.as_ref()?.decision()?)))
    }

    pub(super) fn worst_instructions(&self) -> u32 {
        self.players.iter().map(|player| player.worst_instructions).max().unwrap_or(0)
    }

    /// Feeds an input to the host; its packets are sent by radio.
    pub(super) fn feed(&mut self, tick: u32, now: Instant, input: Input<'_>, watcher: &mut dyn Watcher) {
        watcher.input(now, self.colour, input);
        self.host.handle(now, input);
        while let Some((to, packet)) = self.host.poll_packet() {
            watcher.sent(now, self.colour, to, &packet);
            let to = match to {
                To::All => None,
                To::One(robot) => Some(robot),
            };
            self.air.send_from_host(tick, to, &packet);
        }
        // The answer to a view makes no further view.
        if let (Some(strategy), Some(view)) = (&mut self.strategy, self.host.poll_view())
            && let Some(answer) = strategy.answer(&view)
        {
            self.feed(tick, now, Input::Orders(answer.as_bytes()), watcher);
        }
    }

    /// Why its strategy will not answer any more.
    pub(super) fn strategy_failure(&self) -> Option<String> {
        self.strategy.as_ref().and_then(|strategy| strategy.failure())
    }

    /// Delivers the robots' frames to the host.
    pub(super) fn receive(&mut self, tick: u32, now: Instant, watcher: &mut dyn Watcher) {
        for packet in self.air.deliver_to_host(tick) {
            self.feed(tick, now, Input::Robot(&packet), watcher);
        }
    }

    /// Feeds the host's deadline if it is due: a host wakes up for it and does not wait for robots' steps.
    pub(super) fn deadline(&mut self, tick: u32, now: Instant, watcher: &mut dyn Watcher) {
        if self.host.poll_timeout().is_some_and(|due| due <= now) {
            self.feed(tick, now, Input::Timeout, watcher);
        }
    }

    /// Those of its robots move along a recording from now on, and no others.
    pub(super) fn lead(&mut self, led: &[(Who, Order)]) {
        for player in &mut self.players {
            player.led = led.iter().any(|(who, _)| *who == player.who);
        }
    }

    /// Makes its radio lose this share of packets from now on.
    pub(super) fn lose(&mut self, share: f32) {
        let settings = AirSettings { loss: share, ..self.air.settings().clone() };
        self.air.set(settings);
    }

    /// These links of its radio have their own loss from now on, and no others.
    pub(super) fn lose_links(&mut self, links: Vec<LinkLoss>) {
        let settings = AirSettings { links, ..self.air.settings().clone() };
        self.air.set(settings);
    }

    /// Switches a robot's computer off, or boots it into its next epoch; false where no such robot plays.
    pub(super) fn power(
        &mut self,
        config: &GameConfig,
        who: Who,
        on: bool,
        tick: u32,
        backend: &mut dyn Backend<'a>,
    ) -> Result<bool, GameError> {
        let Some(player) = self.players.iter_mut().find(|player| player.who == who) else { return Ok(false) };
        if !on {
            player.computer = None;
            return Ok(true);
        }
        if player.computer.is_some() {
            return Ok(true);
        }
        player.epoch = player.epoch.wrapping_add(1);
        let setup = &config.teams[who.colour as usize];
        let defending = self.host.game().own_goal(who.colour).unwrap_or(own_goal(config, who.colour));
        let brain =
            brain::BrainConfig { defending, epoch: player.epoch, ..setup.brain(config.league, who.id) };
        let computer = backend.boot(&brain).map_err(|error| GameError::Computer(who, error))?;
        (player.computer, player.booted) = (Some(computer), tick);
        Ok(true)
    }

    /// Runs one step of all its robots' brains; bodies get their orders, frames go to the radio.
    pub(super) fn think(
        &mut self,
        tick: u32,
        now: Instant,
        world: &mut World,
        trace: &mut TraceHash,
    ) -> Result<(), GameError> {
        let Self { air, players, .. } = self;
        let mut thinking = Vec::new();
        for (i, player) in players.iter_mut().enumerate() {
            let who = player.who;
            let Some(sensors) = world.sensors(who) else {
                // Off the field: its radio is off too.
                air.discard(tick, who.id);
                continue;
            };
            let Some(computer) = &mut player.computer else {
                air.discard(tick, who.id);
                continue;
            };
            let packets = air.deliver(tick, who.id);
            for packet in &packets {
                trace.small_size_packet(who, packet);
            }
            let own = Instant(now.0 - u64::from(player.booted) * TICK_US);
            let air = packets.iter().map(|packet| &packet[..]).collect();
            let input = TickIn { seq: tick, now: own, air, sensors };
            computer.post(&input).map_err(|error| GameError::Computer(who, error))?;
            thinking.push(i);
        }
        for i in thinking {
            let player = &mut players[i];
            let who = player.who;
            let Some(computer) = &mut player.computer else { continue };
            let reply = computer.collect().map_err(|error| GameError::Computer(who, error))?;
            player.worst_instructions = player.worst_instructions.max(reply.instructions);
            if let Some(order) = reply.actuators {
                trace.small_size_order(who, &order);
                if !player.led {
                    world.command(who, &order);
                }
            }
            for packet in &reply.packets {
                air.send(tick, who.id, packet);
            }
        }
        Ok(())
    }
}

fn started(starter: &StrategyStarter) -> Result<Box<dyn StrategyLink>, GameError> {
    starter.start().map_err(|error| GameError::Strategy(starter.name().to_owned(), error))
}

/// The settings that a team's host starts with; robots receive each other, so it relays nothing.
pub(super) fn host_settings(config: &GameConfig, colour: Colour) -> HostSettings {
    let defaults = HostSettings::new(colour, config.league, 1);
    HostSettings {
        defending: own_goal(config, colour),
        keeper: config.referee.team(colour).keeper,
        team: config.plays(colour),
        radio: RadioSettings { relay: Relay::No, ..defaults.radio },
        tactics: config.teams[colour as usize].tactics,
        external: config.teams[colour as usize].strategy.is_some(),
        cases: config.cases,
        ..defaults
    }
}

fn own_goal(config: &GameConfig, colour: Colour) -> GoalEnd {
    let blue_ahead = config.referee.blue_on_positive_half;
    if blue_ahead == (colour == Colour::Blue) { GoalEnd::Positive } else { GoalEnd::Negative }
}
