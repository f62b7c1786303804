//! `learned`: what a host learns in a simulated world whose kickers, radio and field surface are known.

use std::collections::BTreeMap;

use arena::game::{Game, GameConfig, NoWatcher};
use brain::BrainConfig;
use casebase::CaseBase;
use geometry::{Point, Vector};
use hil_sim::small_size::camera::Cameras;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::{Ball, Parameters, World};
use hil_sim::{Backend, Mcu, McuError, NativeMcu, Reply};
use host::{Host, HostSettings, Input};
use protocol::lockstep::TickIn;
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::{Instant, RobotId, TeamId};
use rules::{Colour, League};
use ssl::Message;

/// Native brains whose kickers reach this share of the ordered speed, by team and robot.
struct Kickers {
    base: CaseBase<'static>,
    gain: fn(TeamId, RobotId) -> f32,
}

struct Computer {
    native: NativeMcu<'static>,
    gain: f32,
}

impl Backend<'static> for Kickers {
    fn name(&self) -> &'static str {
        "kickers"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'static>, McuError> {
        let gain = (self.gain)(config.team, config.robot);
        Ok(Box::new(Computer { native: NativeMcu::new(config, self.base), gain }))
    }
}

impl Mcu for Computer {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.native.post(tick)
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let mut reply = self.native.collect()?;
        if let Some(ActuatorFrame::Omni { kick: OmniKick::Flat(speed), .. }) = &mut reply.actuators {
            *speed *= self.gain;
        }
        Ok(reply)
    }
}

/// A match of `seconds` seconds with these kickers and `delay` ticks of 10 ms of radio latency.
fn play(seed: u64, seconds: u32, gain: fn(TeamId, RobotId) -> f32, delay: u32) -> Game<'static> {
    let mut config = GameConfig::new(League::DivisionB, seed, f64::from(seconds));
    config.air.delay = [delay, delay];
    let backend = Box::leak(Box::new(Kickers { base: case_library::division_b(), gain }));
    let mut game = Game::new(&config, backend).unwrap();
    (0..seconds * 100).for_each(|_| game.step(&mut NoWatcher).unwrap());
    game
}

#[test]
fn kickers_that_give_less_or_more_than_ordered_are_known_from_the_kicks_of_a_match() {
    let gain = |team: TeamId, _: RobotId| if team == TeamId::of(Colour::Blue) { 0.72 } else { 1.1 };
    let mut known = BTreeMap::new();
    // Most kicks are the robots' own, from which no gain is learned: few robots reach the kicks it takes,
    // and more of them in three whole matches than in six halves.
    for seed in 1..=3 {
        let game = play(seed, 600, gain, 1);
        for (colour, truth) in [(Colour::Blue, 0.72), (Colour::Yellow, 1.1)] {
            for id in RobotId::all() {
                if let Some(found) = game.host(colour).learned().kick(id) {
                    println!("seed {seed}, {} {id}: {found:?}", colour.label());
                    known.insert((seed, colour.label(), id), (found, truth));
                }
            }
        }
    }
    assert!(known.len() >= 6, "{known:?}");
    for (who, (found, truth)) in &known {
        assert!((found.value - truth).abs() < 0.1 * truth, "{who:?}: {found:?}, truly {truth}");
    }
}

#[test]
fn fifty_milliseconds_more_on_the_air_are_found_in_the_robots_latency() {
    let mean = |delay: u32| {
        let game = play(4, 240, |_, _| 1.0, delay);
        let known = [Colour::Blue, Colour::Yellow].into_iter().flat_map(|colour| {
            RobotId::all().filter_map(|id| game.host(colour).learned().latency(id)).collect::<Vec<_>>()
        });
        let known: Vec<f32> = known.map(|found| found.value).collect();
        println!("{delay} ticks: {known:?}");
        assert!(known.len() >= 4, "{known:?}");
        known.iter().sum::<f32>() / known.len() as f32
    };
    let (near, far) = (mean(1), mean(6));
    assert!((0.0..0.06).contains(&near), "{near}");
    assert!((0.03..0.07).contains(&(far - near)), "{near} {far}");
}

/// The friction that a host learns on a field surface on which `balls` roll, seen by the simulator's cameras.
fn friction(roll: f32, balls: u64) -> Option<f32> {
    let league = League::DivisionB;
    let mut parameters = Parameters::of(league).unwrap().clone();
    parameters.ball.roll = roll;
    let mut world = World::new(league, &parameters, 7);
    let mut cameras = Cameras::of(Profile::Ours, 0.0, &world, 7);
    let mut host = Host::new(HostSettings::new(Colour::Blue, league, 1), Instant(0));
    for ball in 0..balls {
        let velocity = Vector::new(2.0 + 0.2 * (ball % 4) as f32, 0.3 * (ball % 3) as f32);
        world.put_ball(Ball { velocity, ..Ball::at(Point::new(-4.0, -1.0 + 0.3 * (ball % 5) as f32)) });
        for _ in 0..4_000 {
            world.step();
            cameras.watch(&world);
            while let Some(mut packet) = cameras.poll(world.now()) {
                // Vision sends nothing about the ball: the tracker assumes the usual field surface, 0.35
                // m/s².
                if let Some(geometry) = &mut packet.geometry {
                    geometry.models = None;
                }
                host.handle(Instant(world.now() * 1_000), Input::Vision(&packet.encode_to_vec()));
            }
        }
    }
    host.learned().friction().map(|known| known.value)
}

#[test]
fn the_friction_of_a_surface_is_known_within_a_sixth_from_balls_that_roll_on_it() {
    for truth in [0.25, 0.35, 0.7] {
        let known = friction(truth, 8).expect("eight balls are enough");
        println!("truly {truth}, learned {known}");
        assert!((known - truth).abs() < truth / 6.0, "truly {truth}, learned {known}");
    }
}
