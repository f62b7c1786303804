//! Tests: the outcome of a pass is recognised. Balls and robots are moved by hand every 10 ms.

use super::*;
use crate::world::{BallModels, Robot};
use geometry::{Angle, Pose};
use rules::League;

fn who(colour: Colour, id: u8) -> Who {
    Who { colour, id: RobotId::new(id).unwrap() }
}

/// A pass by blue 1 from the middle to blue 2 at (2, 0), kicked at 0.2 s with 2.5 m/s; at constant speed.
struct Play {
    robots: Vec<(Who, Point<Field>)>,
    ball: Box<dyn Fn(f32) -> Seen>,
}

/// A ball's place, velocity and height.
type Seen = (Point<Field>, Vector<Field>, f32);

impl Play {
    fn new(ball: impl Fn(f32) -> Seen + 'static) -> Self {
        let robots = vec![
            (who(Colour::Blue, 1), Point::new(-0.11, 0.0)),
            (who(Colour::Blue, 2), Point::new(2.11, 0.0)),
            (who(Colour::Yellow, 5), Point::new(1.0, 1.5)),
        ];
        Self { robots, ball: Box::new(ball) }
    }

    fn with(mut self, who: Who, at: (f32, f32)) -> Self {
        self.robots.retain(|(other, _)| *other != who);
        self.robots.push((who, Point::new(at.0, at.1)));
        self
    }

    fn verdict(&self) -> PassVerdict {
        let field = League::DivisionB.field();
        let mut watch = PassWatch::new(Ordered {
            at: Instant(0),
            us: Colour::Blue,
            passer: RobotId::new(1).unwrap(),
            receiver: RobotId::new(2).unwrap(),
            from: Point::new(0.0, 0.0),
            to: Point::new(2.0, 0.0),
            flight: 0.8,
            chip: false,
            conditions: [0.7, 1.0, 1.0, 1.0, 1.0],
            pressed: 1.0,
        });
        for tick in 0..1_000_u64 {
            let mut world = World::empty(Instant(tick * 10_000), BallModels::default());
            for (who, position) in &self.robots {
                world.put(Robot {
                    who: *who,
                    pose: Pose { position: *position, heading: Angle::ZERO },
                    velocity: Vector::default(),
                    angular: 0.0,
                    confidence: 1.0,
                    seen: world.time,
                });
            }
            let (position, velocity, height) = (self.ball)(tick as f32 * 0.01);
            world.ball = Some(Ball { height, velocity, ..Ball::at_rest(position, world.time) });
            if let Some(verdict) = watch.observe(&world, &field) {
                return verdict;
            }
        }
        panic!("no verdict in 10 s");
    }
}

/// Rolls along `direction` from 0.2 s on, until `stops` m, where it stops.
fn rolling(direction: (f32, f32), stops: f32) -> impl Fn(f32) -> Seen {
    move |time| {
        let along = Vector::new(direction.0, direction.1);
        let path = (2.5 * (time - 0.2)).clamp(0.0, stops);
        let moves = time > 0.2 && path < stops;
        let velocity = if moves { along * 2.5 } else { Vector::default() };
        (Point::new(0.0, 0.0) + along * path, velocity, 0.0)
    }
}

#[test]
fn a_ball_that_stops_at_the_receivers_dribbler_is_received_in_time() {
    let verdict = Play::new(rolling((1.0, 0.0), 2.0)).verdict();
    let PassVerdict::Received { off, late } = verdict else { panic!("{verdict:?}") };
    // 2 m take 0.8 s; the kick is known by the snapshot in which the ball has left the passer.
    assert!(off < 0.02 && late.abs() < 0.05, "{verdict:?}");
    assert!(verdict.is_success());
}

#[test]
fn a_ball_that_a_teammate_stops_is_the_teams_but_not_the_receivers() {
    let play = Play::new(rolling((1.0, 0.0), 1.2)).with(who(Colour::Blue, 4), (1.31, 0.0));
    let verdict = play.verdict();
    let PassVerdict::ByTeammate { by, off } = verdict else { panic!("{verdict:?}") };
    assert!(by.number() == 4 && (off - 0.8).abs() < 0.03 && verdict.is_success());
}

#[test]
fn a_ball_that_an_opponent_turns_aside_is_intercepted_where_it_was() {
    // At 1 m it is deflected to the side.
    let play = Play::new(|time| {
        let path = (2.5 * (time - 0.2)).max(0.0);
        if path <= 1.0 {
            let speed = if time > 0.2 { 2.5 } else { 0.0 };
            return (Point::new(path, 0.0), Vector::new(speed, 0.0), 0.0);
        }
        (Point::new(1.0, path - 1.0), Vector::new(0.0, 2.0), 0.0)
    });
    let verdict = play.with(who(Colour::Yellow, 5), (1.1, -0.06)).verdict();
    let PassVerdict::Intercepted { by, along, after } = verdict else { panic!("{verdict:?}") };
    assert!(by.number() == 5 && (along - 1.0).abs() < 0.06 && (after - 0.36).abs() < 0.06, "{verdict:?}");
    assert!(!verdict.is_success());
}

#[test]
fn a_ball_that_rolls_past_an_opponent_or_over_it_is_not_intercepted() {
    let beside = Play::new(rolling((1.0, 0.0), 2.0)).with(who(Colour::Yellow, 5), (1.0, 0.125));
    assert!(matches!(beside.verdict(), PassVerdict::Received { .. }), "near, but its way does not change");
    let chip = Play::new(|time| {
        let path = (2.5 * (time - 0.2)).clamp(0.0, 2.0);
        let speed = if time > 0.2 && path < 2.0 { 2.5 } else { 0.0 };
        (Point::new(path, 0.0), Vector::new(speed, 0.0), (path * (2.0 - path)).max(0.0))
    });
    assert!(matches!(chip.with(who(Colour::Yellow, 5), (1.0, 0.0)).verdict(), PassVerdict::Received { .. }));
}

#[test]
fn a_ball_beside_a_receiver_that_stands_there_is_missed() {
    // 15° off: 0.518 m beside x* at its nearest.
    let verdict = Play::new(rolling((0.965_926, 0.258_819), 2.5)).verdict();
    let PassVerdict::Missed { by } = verdict else { panic!("{verdict:?}") };
    assert!((by - 0.5176).abs() < 0.01, "{verdict:?}");
    // One that stops short, too.
    let short = Play::new(rolling((1.0, 0.0), 1.0)).verdict();
    assert!(matches!(short, PassVerdict::Missed { by } if (by - 1.0).abs() < 0.03), "{short:?}");
}

#[test]
fn a_ball_that_comes_to_x_before_the_receiver_makes_it_late() {
    let play = Play::new(rolling((1.0, 0.0), 3.0)).with(who(Colour::Blue, 2), (2.0, -0.7));
    let verdict = play.verdict();
    assert!(
        matches!(verdict, PassVerdict::Late { receiver_off } if (receiver_off - 0.7).abs() < 1e-4),
        "{verdict:?}"
    );
}

#[test]
fn a_ball_over_the_line_is_out_there() {
    let verdict = Play::new(rolling((0.0, 1.0), 4.0)).verdict();
    let PassVerdict::Out { at } = verdict else { panic!("{verdict:?}") };
    assert!(at.y() > 3.02 && at.y() < 3.06 && at.x() == 0.0);
}

#[test]
fn a_pass_that_never_leaves_is_no_kick_and_an_interceptor_is_named() {
    let lies = |_: f32| (Point::new(0.0, 0.0), Vector::default(), 0.0);
    let verdict = Play::new(lies).verdict();
    assert!(matches!(verdict, PassVerdict::NoKick { after, lost_to: None } if after > 5.0), "{verdict:?}");
    let stolen =
        Play::new(lies).with(who(Colour::Blue, 1), (-0.4, 0.0)).with(who(Colour::Yellow, 5), (0.1, 0.0));
    assert!(
        matches!(stolen.verdict(), PassVerdict::NoKick { lost_to: Some(by), .. } if by.number() == 5),
        "{stolen:?}",
        stolen = stolen.verdict()
    );
}
