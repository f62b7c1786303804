//! Tests of the referee with the simulator's world: a kick-off and a shot, with the simulator's own events.

use super::*;
use crate::small_size::{Ball, Drive, KickCommand, Order, Parameters, World};

struct Match {
    world: World,
    referee: InternalReferee,
    events: Vec<crate::small_size::PhysicsEvent>,
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

/// Yellow's robot 1 kicks off with that speed, from behind the ball.
fn kick_off(speed: f32) -> Match {
    let mut game = Match::new(0.0);
    game.until(Phase::PrepareKickoff(Colour::Yellow), 20.0, Order::default());
    assert_eq!(game.world.ball.position, at(0.0, 0.0));
    game.world.put(yellow(1), Pose { position: at(-0.15, 0.0), heading: Angle::ZERO });
    game.until(Phase::Kickoff(Colour::Yellow), 5.0, Order::default());
    let ahead = geometry::Twist { linear: Vector::new(0.3, 0.0), angular: 0.0 };
    let kick = Some(KickCommand { speed, angle: 0.0 });
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
    // The kicker stands at the target position of the ball.
    game.world.put(yellow(1), Pose { position: at(-1.5, 0.0), heading: Angle::ZERO });
    game.until(Phase::PrepareKickoff(Colour::Blue), 20.0, Order::default());
    assert_eq!(game.world.ball.position, at(0.0, 0.0));
}

#[test]
fn the_referee_uses_the_simulators_kick_speed() {
    let mut game = kick_off(6.51);
    game.until(Phase::Halt, 3.0, Order::default());
    assert!(game.referee.events().iter().all(|event| event.what.kind() != Kind::BallTooFast));
    let game = kick_off(6.55);
    let kinds: Vec<Kind> = game.referee.events().iter().map(|event| event.what.kind()).collect();
    assert_eq!(kinds, [Kind::BallTooFast]);
}

/// A rough team: in play the robot nearest to the ball drives through it towards the goal and kicks, the
/// others stay at home; else all robots drive home slowly, and stand still in a halt.
fn rough(game: &Match, who: Who, home: Point<Field>) -> Order {
    let Some(robot) = game.world.robot(who) else { return Order::default() };
    let (place, ball) = (robot.pose.position, game.world.ball.position);
    let phase = game.referee.phase();
    let global = |linear: Vector<Field>, turn: f32| Order {
        drive: Drive::Global(geometry::Twist { linear, angular: turn }),
        ..Order::default()
    };
    let plays = match phase {
        Phase::Halt | Phase::Timeout(_) => return Order::default(),
        Phase::Run => true,
        Phase::Kickoff(team) | Phase::FreeKick(team) | Phase::Penalty(team) => team == who.colour,
        _ => false,
    };
    let teammates =
        game.world.robots().iter().filter(|robot| robot.present && robot.who.colour == who.colour);
    let nearest =
        teammates.min_by(|a, b| a.pose.position.distance(ball).total_cmp(&b.pose.position.distance(ball)));
    if !plays || nearest.is_none_or(|robot| robot.who != who) {
        return global(((home - place) * 2.0).clamped(1.2), 0.0);
    }
    let goal = game.referee.own_end(who.colour.other()).sign() as f32 * 4.5;
    let direction = (at(goal, 0.0) - ball).unit().unwrap_or_default();
    let behind = ball - direction * 0.25;
    let turn = (direction.angle() - robot.pose.heading).radians() * 5.0;
    let lined_up = (ball - place).unit().is_some_and(|to| to.dot(direction) > 0.95);
    let target = if lined_up { ball + direction * 0.2 } else { behind };
    let kick = Some(KickCommand { speed: 5.0, angle: 0.0 });
    Order { kick, ..global(((target - place) * 3.0).clamped(1.5), turn) }
}

#[test]
fn robots_that_obey_halt_and_stop_get_no_fouls_in_a_rough_match() {
    let mut game = Match::new(0.0);
    let clock = MatchClock::Simulated { total: Duration::millis(120_000) };
    // The ball is placed by hand: these robots cannot place it.
    let mut settings = RefereeSettings { clock, ..settings() };
    (settings.yellow.can_place_ball, settings.blue.can_place_ball) = (false, false);
    game.referee = InternalReferee::new(settings, 1).unwrap();
    let homes = [at(-1.0, 1.8), at(-1.0, -1.8), at(-2.5, 1.8), at(-2.5, -1.8)];
    for (number, home) in (1..).zip(homes) {
        for who in [yellow(number), blue(number)] {
            let side = game.referee.own_end(who.colour).sign() as f32;
            game.world.put(who, Pose { position: at(-home.x() * side, home.y()), heading: Angle::ZERO });
        }
    }
    game.world.put(blue(0), Pose { position: at(4.3, 0.0), heading: Angle::ZERO });
    while !game.referee.is_over() {
        for (number, home) in (0..).zip([at(-4.3, 0.0)].into_iter().chain(homes)) {
            for who in [yellow(number), blue(number)] {
                let side = game.referee.own_end(who.colour).sign() as f32;
                let order = rough(&game, who, at(-home.x() * side, home.y()));
                game.world.order(who, order);
            }
        }
        for _ in 0..10 {
            game.world.step();
        }
        game.world.take_events(&mut game.events);
        game.referee.look(&game.world, &game.events);
        game.events.clear();
        while let Some(order) = game.referee.poll_order() {
            order.carry_out(&mut game.world);
        }
    }
    let metrics = game.referee.metrics();
    assert_eq!(game.referee.off_graph(), 0);
    for team in [Colour::Yellow, Colour::Blue] {
        for kind in [Kind::MovedInHalt, Kind::TooFastInStop, Kind::BallTooFast] {
            assert_eq!(metrics.offences.of(team, kind), 0, "{team:?} {kind:?}");
        }
    }
    assert!(metrics.in_play_s > 10.0 && metrics.yellow.shots + metrics.blue.shots > 3, "{metrics:#?}");
}
