//! The referee before the simulator's world: a kick-off and a shot, seen with the simulator's own events.

use super::*;
use crate::small_size::{Ball, Drive, Kick, Order, Parameters, World};

struct Match {
    world: World,
    referee: InternalReferee,
    events: Vec<crate::small_size::Event>,
}

impl Match {
    fn new(speed_sd: f32) -> Self {
        let mut parameters = Parameters::of(League::DivisionB).unwrap().clone();
        parameters.kick.speed_sd = speed_sd;
        parameters.kick.angle_sd_deg = 0.0;
        let mut world = World::new(League::DivisionB, &parameters, 1);
        world.put_ball(Ball::at(at(1.0, 1.0)));
        for (who, x, y) in [(yellow(0), -4.4, 0.0), (blue(0), 4.4, 0.7), (blue(1), 2.0, 2.0)] {
            world.put(who, Pose { position: at(x, y), heading: Angle::ZERO });
        }
        Self { world, referee: InternalReferee::new(settings(), 1).unwrap(), events: Vec::new() }
    }

    /// 10 ms, with that order for yellow's robot 1.
    fn step(&mut self, order: Order) {
        self.world.order(yellow(1), order);
        for _ in 0..10 {
            self.world.step();
        }
        self.world.take_events(&mut self.events);
        self.referee.look(&self.world, &self.events);
        self.events.clear();
        while let Some(order) = self.referee.poll_order() {
            order.carry_out(&mut self.world);
        }
    }

    fn until(&mut self, phase: Phase<Colour>, seconds: f32, order: Order) {
        for _ in 0..(seconds * 100.0) as u32 {
            if self.referee.phase() == phase {
                return;
            }
            self.step(order);
        }
        panic!("{:?}; {:#?}", self.referee.phase(), self.referee.events());
    }
}

/// Yellow's robot 1 kicks off with that speed, from before the ball.
fn kick_off(speed: f32) -> Match {
    let mut game = Match::new(0.0);
    game.until(Phase::PrepareKickoff(Colour::Yellow), 20.0, Order::default());
    assert_eq!(game.world.ball.position, at(0.0, 0.0));
    game.world.put(yellow(1), Pose { position: at(-0.15, 0.0), heading: Angle::ZERO });
    game.until(Phase::Kickoff(Colour::Yellow), 5.0, Order::default());
    let ahead = geometry::Twist { linear: Vector::new(0.3, 0.0), angular: 0.0 };
    let kick = Some(Kick { speed, angle: 0.0 });
    let order = Order { drive: Drive::Local(ahead), kick, ..Order::default() };
    game.until(Phase::Run, 2.0, order);
    game
}

#[test]
fn a_kick_off_into_the_open_goal_counts_and_is_no_double_touch() {
    let mut game = kick_off(6.0);
    game.until(Phase::Halt, 3.0, Order::default());
    assert_eq!(game.referee.accounts().yellow.score, 1);
    let kinds: Vec<Kind> = game.referee.events().iter().map(|event| event.what.kind()).collect();
    assert_eq!(kinds, [Kind::PossibleGoal, Kind::Goal]);
    game.until(Phase::PrepareKickoff(Colour::Blue), 20.0, Order::default());
    assert_eq!(game.world.ball.position, at(0.0, 0.0));
}

#[test]
fn the_speed_of_a_kick_is_the_simulators_own() {
    let mut game = kick_off(6.51);
    game.until(Phase::Halt, 3.0, Order::default());
    assert!(game.referee.events().iter().all(|event| event.what.kind() != Kind::BallTooFast));
    let game = kick_off(6.55);
    let kinds: Vec<Kind> = game.referee.events().iter().map(|event| event.what.kind()).collect();
    assert_eq!(kinds, [Kind::BallTooFast]);
}
