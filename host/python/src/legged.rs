//! `legged`: trials of the first paper as episodes (`hil_sim::Simulation`): four-legged robots, its scripted
//! opponents and its referee. Ticks of 40 ms; m, s.
//!
//! The episode's world carries orders there, and ball and robots back; its own physics rests.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc::Receiver;

use arena::TrialConfig;
use brain::{Approach, BrainConfig};
use geometry::math;
use hil_sim::four_legged::world::LeggedWorld;
use hil_sim::small_size::{Ball, Drive, Robot, World};
use hil_sim::{Backend, Conduct, Configuration, Mcu, McuError, NativeBackend, Parameters, Reply};
use hil_sim::{Scenario, Simulation, TrialOutcome};
use protocol::lockstep::TickIn;
use protocol::robot_io::{ActuatorFrame, LeggedKick, LeggedPrimitive};
use protocol::{RobotId, Who};
use rules::{Colour, League};

use crate::computers::Judgement;
use crate::driver::Driver;
use crate::settings::{End, Settings};

/// Orders of the caller, by robot.
type Orders = Rc<RefCell<Vec<ActuatorFrame>>>;

/// Computers of the own team: those that obey the caller, and brains with cases.
struct Computers<'a> {
    orders: Orders,
    brains: NativeBackend<'a>,
    /// Number of robots, from the first, without a brain.
    led: usize,
}

/// A computer that passes the caller's orders on.
struct Led {
    orders: Orders,
    robot: usize,
}

impl<'a> Backend<'a> for Computers<'a> {
    fn name(&self) -> &'static str {
        "orders"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        // Robots of a trial are numbered from 1.
        let robot = usize::from(config.robot.number()).saturating_sub(1);
        if robot < self.led {
            return Ok(Box::new(Led { orders: self.orders.clone(), robot }));
        }
        self.brains.boot(config)
    }
}

impl Mcu for Led {
    fn post(&mut self, _tick: &TickIn<'_>) -> Result<(), McuError> {
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let actuators = self.orders.borrow().get(self.robot).copied();
        Ok(Reply { actuators, ..Reply::default() })
    }
}

/// The thread's body: a first world at kick-off, then one for each that comes, judged, until `answer` fails.
pub fn play(
    settings: &Settings,
    (scenario, seed): (Scenario, u64),
    mut world: World,
    inbox: &Receiver<World>,
    mut answer: impl FnMut(World, Judgement) -> bool,
) -> Result<(), String> {
    let config = trial(settings, scenario, seed);
    let orders = Orders::default();
    let has_brains = settings.driver(Colour::Blue).team().is_some();
    let led = if has_brains { settings.agents } else { settings.own };
    let computers = Computers { orders: orders.clone(), brains: NativeBackend::new(config.base), led };
    let simulation = Simulation::new(config.simulation(), Box::new(computers));
    let mut simulation = simulation.map_err(|error| error.to_string())?;
    show(simulation.world(), settings.own, &mut world);
    let mut judgement = Judgement::default();
    while answer(world, judgement) {
        let Ok(next) = inbox.recv() else { break };
        world = next;
        *orders.borrow_mut() = own(&world).map(order).collect();
        simulation.step().map_err(|error| error.to_string())?;
        show(simulation.world(), settings.own, &mut world);
        judgement.end = simulation.referee().outcome().map(end_of);
    }
    Ok(())
}

/// The trial as `onetwo trial` plays it, with the settings' numbers of robots.
fn trial(settings: &Settings, scenario: Scenario, seed: u64) -> TrialConfig<'static> {
    let opponents = match settings.opponents_by {
        Driver::TwoDefenders => Configuration::TwoDefenders,
        _ => Configuration::DefenderGoalie,
    };
    let mut config = TrialConfig::new(scenario, opponents, Approach::Cases, seed);
    (config.robots, config.retrievers) = (settings.own, settings.own);
    let mut layout = scenario.layout(opponents, &config.parameters, seed);
    layout.opponents.truncate(settings.opponents);
    if settings.opponents_by == Driver::None {
        layout.opponents.iter_mut().for_each(|placed| placed.conduct = Conduct::Standing);
    }
    config.layout = Some(layout);
    config
}

fn own(world: &World) -> impl Iterator<Item = &Robot> {
    world.robots().iter().filter(|robot| robot.who.colour == Colour::Blue)
}

/// A walking robot's order: it kicks a ball that it holds, and grabs one in its reach.
fn order(robot: &Robot) -> ActuatorFrame {
    let order = robot.order();
    let walk = if let Drive::Local(twist) = order.drive { twist } else { geometry::Twist::default() };
    let deceleration = Parameters::four_legged().ball.deceleration;
    let primitive = match order.kick {
        Some(kick) if robot.ball_contact => {
            LeggedPrimitive::Kick(LeggedKick::Pass(kick.speed * kick.speed / (2.0 * deceleration)))
        }
        _ if order.dribbler > 0.0 && robot.touching && !robot.ball_contact => LeggedPrimitive::Grab,
        _ => LeggedPrimitive::None,
    };
    ActuatorFrame::Legged { walk, primitive }
}

/// Ball and robots of the trial in the episode's world.
fn show(of: &LeggedWorld, own: usize, world: &mut World) {
    world.put_ball(Ball::rolling(of.ball.position, of.ball.velocity));
    let (grab, radius) = (&Parameters::four_legged().grab, League::FourLegged.robot().radius);
    for (n, walker) in of.walkers.iter().enumerate() {
        let (colour, number) = if n < own { (Colour::Blue, n) } else { (Colour::Yellow, n - own) };
        let Some(id) = RobotId::new(number as u8) else { continue };
        let robot = world.put(Who { colour, id }, walker.pose);
        (robot.velocity, robot.turning) = (walker.velocity(), walker.twist.angular);
        (robot.body.radius, robot.body.front) = (radius, FRONT_SHARE * radius);
        let (distance, angle) = walker.bearing(of.ball.position);
        robot.touching = distance <= grab.reach && angle.abs() <= grab.half_angle;
        robot.ball_contact = of.holder() == Some(n);
    }
}

const fn end_of(outcome: TrialOutcome) -> End {
    match outcome {
        TrialOutcome::Goal => End::Goal,
        TrialOutcome::Close => End::Close,
        TrialOutcome::Block => End::Lost,
        TrialOutcome::Out => End::Out,
        TrialOutcome::Timeout => End::Time,
    }
}

/// What an action or an observation of 1 stands for: a robot's speed, m/s, and turn, rad/s, and the speed,
/// m/s, of a ball that rolls as far as the strongest pass.
pub fn scales() -> [f32; 3] {
    let of = Parameters::four_legged();
    [of.walk.forward, of.walk.turn, math::sqrt(2.0 * of.ball.deceleration * of.kick.pass_max)]
}

/// Length of a tick, ms.
pub const TICK_MS: u32 = (hil_sim::TICK_US / 1000) as u32;
/// Most opponents of a trial.
pub const OPPONENTS_MAX: usize = 2;
/// Where pictures cut a robot's disc, as a share of its radius: an estimate.
const FRONT_SHARE: f32 = 0.8;
