//! Tests: a trial runs as its configuration states. With scripted computers in place of brains.

use std::cell::RefCell;
use std::rc::Rc;

use geometry::{Point, Pose, Twist, Vector};
use protocol::TeamId;
use protocol::robot_io::{LeggedKick, LeggedPrimitive, SensorFrame};

use super::*;
use crate::four_legged::parameters::FOUR_LEGGED_TOML;
use crate::four_legged::scenario::Scenario;
use crate::mcu::Reply;

/// Inputs of a scripted computer that the tests check.
#[derive(Clone, Debug, PartialEq)]
struct Given {
    robot: u8,
    epoch: u32,
    seq: u32,
    now: u64,
    air: Vec<Vec<u8>>,
}

type Log = Rc<RefCell<Vec<Given>>>;

/// Computers that walk to the ball, grab it, kick it in each direction a body supports, and report their ids.
#[derive(Default)]
struct Scripts(Log);

struct Script {
    config: BrainConfig,
    log: Log,
    kicks: usize,
    held: u32,
    ticks: u32,
    reply: Reply,
    placed: Option<Pose<geometry::Field>>,
    ball: Option<Point<geometry::Field>>,
}

impl Backend<'static> for Scripts {
    fn name(&self) -> &'static str {
        "script"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu>, McuError> {
        let (config, log) = (config.clone(), self.0.clone());
        Ok(Box::new(Script {
            config,
            log,
            kicks: 0,
            held: 0,
            ticks: 0,
            reply: Reply::default(),
            placed: None,
            ball: None,
        }))
    }
}

impl Mcu for Script {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        let robot = self.config.robot.number();
        self.log.borrow_mut().push(Given {
            robot,
            epoch: self.config.epoch,
            seq: tick.seq,
            now: tick.now.0,
            air: tick.air.iter().map(|packet| packet.to_vec()).collect(),
        });
        let reported = Packet::from_slice(&[robot, tick.seq as u8]).unwrap();
        self.reply = Reply { actuators: Some(self.order(&tick.sensors)), ..Reply::default() };
        self.reply.packets.push(reported).unwrap();
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        Ok(self.reply.clone())
    }
}

impl Script {
    /// Pose and ball: as measured, or from the sights of this frame with the pose of the first.
    fn believes(&mut self, sensors: &SensorFrame) -> Option<(Pose<geometry::Field>, Point<geometry::Field>)> {
        let Some(camera) = &sensors.camera else { return Some((sensors.pose?, sensors.ball?.position)) };
        self.placed = sensors.pose.or(self.placed);
        let mut pose = self.placed?;
        pose.position += pose.vector_to_field(sensors.odometry.linear) * TICK;
        pose.heading = pose.heading + geometry::Angle::new(sensors.odometry.angular * TICK);
        self.placed = Some(pose);
        if let Some(seen) = camera.ball.or(camera.landmarks.first().map(|seen| seen.sight)) {
            let seen = Vector::<geometry::Body>::polar(seen.range(), seen.bearing());
            self.ball = Some(pose.to_field(Point::new(seen.x(), seen.y())));
        }
        self.ball.map(|ball| (pose, ball))
    }

    fn order(&mut self, sensors: &SensorFrame) -> ActuatorFrame {
        let kicks = [
            LeggedKick::ForwardSoft,
            LeggedKick::Left,
            LeggedKick::Right,
            LeggedKick::Pass(0.01),
            LeggedKick::Pass(9.0),
            LeggedKick::ForwardHard,
        ];
        self.ticks += 1;
        let (mut walk, mut primitive) = (Twist::default(), LeggedPrimitive::None);
        let Some((pose, ball)) = self.believes(sensors) else {
            return ActuatorFrame::Legged {
                walk: Twist { linear: Vector::new(0.1, 0.0), angular: 1.0 },
                primitive: LeggedPrimitive::None,
            };
        };
        let offset = pose.to_body(ball);
        let turn = pose.turn_to(ball).radians();
        self.held = if sensors.ball_contact { self.held + 1 } else { 0 };
        if self.held > 20 {
            primitive = LeggedPrimitive::Kick(kicks[self.kicks % kicks.len()]);
            self.kicks += usize::from(!sensors.busy);
        } else if sensors.ball_contact {
            walk = Twist { linear: Vector::new(0.5, sensors.opponents[0].y()), angular: 3.0 };
        } else if self.config.robot.number() != 1 {
            // Now and then into the ball, sideways on.
            let to_ball = if self.ticks % 500 < 100 { 1.0 } else { -1.0 };
            walk =
                Twist { linear: Vector::new(offset.x(), offset.y()) * to_ball, angular: 4.0 * (turn - 1.5) };
        } else if offset.x() > 0.0 && offset.x() < 0.165 && turn.abs() < 0.38 {
            primitive = LeggedPrimitive::Grab;
        } else {
            walk = Twist { linear: Vector::new(offset.x(), offset.y()), angular: 4.0 * turn };
        }
        ActuatorFrame::Legged { walk, primitive }
    }
}

fn config(scenario: Scenario, configuration: Configuration, seed: u64, robots: u8) -> SimulationConfig {
    let parameters = Parameters::four_legged().clone();
    let brain = |n| BrainConfig::new(RobotId::new(n).unwrap(), TeamId(1));
    SimulationConfig {
        seed,
        layout: scenario.layout(configuration, &parameters, seed),
        configuration,
        brains: (1..=robots).map(brain).collect(),
        air: AirSettings::default(),
        noise: Noise::NONE,
        parameters,
        faults: Vec::new(),
    }
}

fn simple(seed: u64) -> SimulationConfig {
    config(Scenario::DefenderAhead, Configuration::DefenderGoalie, seed, 2)
}

/// Runs for `ticks`; returns the simulation and the inputs of its computers.
fn run(config: SimulationConfig, ticks: u32) -> (Simulation<'static>, Vec<Given>) {
    let log = Log::default();
    let mut simulation = Simulation::new(config, Box::new(Scripts(log.clone()))).unwrap();
    for _ in 0..ticks {
        simulation.step().unwrap();
    }
    let given = log.borrow().clone();
    (simulation, given)
}

fn hash(config: SimulationConfig) -> String {
    run(config, 500).0.trace().digits()
}

#[test]
fn equal_configurations_run_equally_and_other_seeds_otherwise() {
    assert_eq!(hash(simple(1)), hash(simple(1)));
    assert_ne!(hash(simple(1)), hash(simple(2)));
}

#[test]
fn one_flipped_bit_of_one_order_changes_the_trace_hash() {
    let flip = |bit| {
        let fault = Fault::FlipOrderBit { robot: RobotId::new(2).unwrap(), bit };
        SimulationConfig { faults: vec![ScheduledFault { tick: 30, fault }], ..simple(1) }
    };
    let untouched = hash(simple(1));
    for bit in [0, 7, 22, 31] {
        assert_ne!(hash(flip(bit)), untouched, "bit {bit}");
    }
}

#[test]
fn a_packet_is_received_one_tick_after_it_was_sent() {
    let (_, given) = run(simple(1), 3);
    let received: Vec<_> = given.iter().map(|g| (g.seq, g.robot, g.air.clone())).collect();
    assert_eq!(received[..2], [(0, 1, vec![]), (0, 2, vec![])]);
    assert_eq!(received[2..4], [(1, 1, vec![vec![2, 0]]), (1, 2, vec![vec![1, 0]])]);
    assert_eq!(given[4].now, 80_000);
}

#[test]
fn a_crashed_robot_gets_no_tick_and_reboots_with_a_new_epoch_and_clock() {
    let robot = RobotId::new(2).unwrap();
    let at = |tick, fault| ScheduledFault { tick, fault };
    let faults =
        vec![at(25, Fault::Return(robot)), at(10, Fault::Crash(robot)), at(30, Fault::Return(robot))];
    let (simulation, given) = run(SimulationConfig { faults, ..simple(1) }, 40);
    let of_two: Vec<_> = given.iter().filter(|g| g.robot == 2).collect();
    assert_eq!(of_two.len(), 10 + 15);
    assert_eq!((of_two[9].seq, of_two[9].epoch), (9, 1));
    assert_eq!((of_two[10].seq, of_two[10].epoch, of_two[10].now), (25, 2, 0));
    assert_eq!(of_two[10].air, [vec![1, 24]], "what it missed is lost");
    assert_eq!(of_two[15].epoch, 2, "who runs does not return");
    assert!(simulation.attackers().all(|(_, runs)| runs));
}

#[test]
fn the_air_can_change_during_a_trial() {
    let faults = vec![ScheduledFault { tick: 5, fault: Fault::Air(AirSettings::with_loss(1.0)) }];
    let (_, given) = run(SimulationConfig { faults, ..simple(1) }, 20);
    // Sent in tick 4, received in 5; sent in 5 and lost.
    assert!(given.iter().all(|g| g.air.is_empty() == (g.seq == 0 || g.seq > 5)));
}

#[test]
fn too_many_robots_and_confused_ids_are_refused() {
    let refuse = |config| Simulation::new(config, Box::new(Scripts::default())).err().unwrap().to_string();
    let five = config(Scenario::LeftSide, Configuration::DefenderGoalie, 1, 5);
    assert_eq!(refuse(five), "5 robots, but the scenario has places for 4");
    let mut twice = simple(1);
    twice.brains[1].robot = twice.brains[0].robot;
    assert_eq!(refuse(twice), "robot 1 is named twice or out of order");
}

#[test]
fn defenders_never_enter_the_penalty_area() {
    let field = rules::League::FourLegged.field();
    for seed in 0..6 {
        for configuration in [Configuration::DefenderGoalie, Configuration::TwoDefenders] {
            let config = config(Scenario::Random, configuration, seed, 4);
            let mut simulation = Simulation::new(config, Box::new(Scripts::default())).unwrap();
            for _ in 0..750 {
                simulation.step().unwrap();
                let first = simulation.attackers().count();
                for (i, role) in
                    simulation.opponents().enumerate().filter(|(_, r)| *r != OpponentRole::Goalie)
                {
                    let place = simulation.world().walkers[first + i].pose.position;
                    // A shove can move a robot a little before its legs react.
                    let deeper = geometry::Point::new(place.x() - 0.1, place.y());
                    assert!(
                        !field.in_penalty_area(geometry::GoalEnd::Positive, deeper),
                        "{role:?} at {place:?}"
                    );
                }
            }
        }
    }
}

/// Every number of the file, by its path.
fn leaves(value: &mut toml::Value, path: &str, visit: &mut dyn FnMut(&str, &mut f64)) {
    match value {
        toml::Value::Float(number) => visit(path, number),
        toml::Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                leaves(value, &format!("{path}.{key}"), visit);
            }
        }
        toml::Value::Array(values) => {
            for (i, value) in values.iter_mut().enumerate() {
                leaves(value, &format!("{path}.{i}"), visit);
            }
        }
        other => panic!("{path} is no decimal number: {other}"),
    }
}

#[test]
fn every_parameter_of_the_file_changes_the_trial() {
    let file: toml::Value = toml::from_str(FOUR_LEGGED_TOML).unwrap();
    let mut paths = Vec::new();
    leaves(&mut file.clone(), "", &mut |path, _| paths.push(path.to_owned()));
    // The referee's numbers do not change the physics: its own tests check them.
    paths.retain(|path| !path.starts_with(".referee"));
    let (dg, two) = (Configuration::DefenderGoalie, Configuration::TwoDefenders);
    let high = Layout { ball: Point::new(1.9, 1.7), ..simple(0).layout };
    let aside = config(Scenario::LeftSide, two, 0, 2).layout;
    let mid = Layout { ball: Point::new(1.25, -1.0), ..aside.clone() };
    let deep = Layout { ball: Point::new(2.6, 0.6), ..simple(0).layout };
    let ahead = config(Scenario::DefenderAhead, dg, 0, 2).layout;
    // An attacker and the defender face each other with the ball between them: they fight for it.
    let mut duel = ahead.clone();
    duel.ball = Point::new(1.2, 0.0);
    duel.attackers[0] = Pose::from_mm_deg(1060.0, 0.0, 0.0);
    duel.opponents[0].pose = Pose::from_mm_deg(1340.0, 0.0, 180.0);
    let play = |parameters: &Parameters| {
        let games = [
            (&ahead, dg, 0),
            (&ahead, dg, 1),
            (&aside, two, 0),
            (&aside, two, 1),
            (&high, dg, 0),
            (&deep, dg, 0),
            (&mid, two, 0),
            (&duel, dg, 0),
            (&duel, dg, 2),
        ];
        let hashes = games.map(|(layout, configuration, seed)| {
            let noise = if seed == 0 { Noise::NONE } else { parameters.noise };
            let (parameters, layout) = (parameters.clone(), layout.clone());
            let config = SimulationConfig { seed, layout, configuration, noise, parameters, ..simple(seed) };
            run(config, 1_500).0.trace().digits()
        });
        hashes.concat()
    };
    let untouched = play(Parameters::four_legged());
    for wanted in &paths {
        // The smallest change first; a larger one may be needed before a threshold is crossed.
        let differs = [0.9, 0.6, 0.1].into_iter().any(|factor| {
            let mut changed = file.clone();
            leaves(&mut changed, "", &mut |path, number| {
                if path == wanted {
                    *number *= factor;
                }
            });
            let parameters = Parameters::from_toml(&toml::to_string(&changed).unwrap());
            parameters.is_ok_and(|parameters| play(&parameters) != untouched)
        });
        assert!(differs, "{wanted} changes nothing");
    }
}
