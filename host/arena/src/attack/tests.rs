//! Tests of `attack`.

use protocol::{RobotId, Who};

use super::left::LeftBalls;
use super::*;

fn who(colour: Colour, id: u8) -> Who {
    Who { colour, id: RobotId::new(id).unwrap() }
}

fn at(x: f32, y: f32) -> Point<Field> {
    Point::new(x, y)
}

#[test]
fn a_free_ball_that_a_robot_drove_away_from_is_left_and_a_kicked_one_is_not() {
    let mut left = LeftBalls::default();
    let look = |left: &mut LeftBalls, now: f64, ball: Point<Field>, robot: Point<Field>| {
        left.look(now, ball, [(who(Colour::Blue, 1), robot)].into_iter(), true)
    };
    assert!(look(&mut left, 0.0, at(0.0, 0.0), at(0.1, 0.0)).is_empty());
    assert!(look(&mut left, 0.5, at(0.0, 0.0), at(0.2, 0.0)).is_empty());
    assert_eq!(look(&mut left, 0.9, at(0.0, 0.0), at(0.3, 0.0)), [Colour::Blue]);
    assert!(look(&mut left, 2.0, at(0.0, 0.0), at(0.3, 0.0)).is_empty(), "counted once");
    assert!(look(&mut left, 3.0, at(0.0, 0.0), at(0.1, 0.0)).is_empty());
    assert!(look(&mut left, 3.9, at(2.0, 0.0), at(0.3, 0.0)).is_empty(), "kicked");
}

#[test]
fn a_ball_with_an_opponent_near_is_not_left_but_disputed() {
    let mut left = LeftBalls::default();
    let robots = |x: f32| [(who(Colour::Blue, 1), at(x, 0.0)), (who(Colour::Yellow, 1), at(-0.3, 0.0))];
    assert!(left.look(0.0, at(0.0, 0.0), robots(0.1).into_iter(), true).is_empty());
    assert!(left.look(0.9, at(0.0, 0.0), robots(0.4).into_iter(), true).is_empty());
}

#[test]
fn possessions_end_by_what_the_last_owner_did() {
    let mut watch = AttackWatch::default();
    // Blue has the ball for a second and is tackled.
    watch.possess(0.0, Colour::Blue);
    watch.possession.as_mut().unwrap().pressed = 0.9;
    watch.possess(1.0, Colour::Yellow);
    // Yellow kicks to a teammate, who leaves it; blue comes later.
    let flight = |colour, id, shot| Flight {
        by: who(colour, id),
        at: 0.0,
        from: at(0.0, 0.0),
        speed: 2.5,
        shot,
        landed: false,
    };
    watch.flight = Some(flight(Colour::Yellow, 1, false));
    watch.touched(2.0, who(Colour::Yellow, 2), at(1.5, 0.0));
    watch.possess(4.0, Colour::Blue);
    // Blue's pass goes to yellow, whose shot scores.
    watch.flight = Some(flight(Colour::Blue, 1, false));
    watch.touched(5.0, who(Colour::Yellow, 2), at(1.2, 0.0));
    watch.possess(5.1, Colour::Yellow);
    watch.flight = Some(flight(Colour::Yellow, 2, true));
    watch.stopped(6.0, at(4.6, 0.0), Some(Colour::Yellow), true);
    let named = |team| {
        let texts: Vec<_> = watch.of(team).named().map(|(name, n)| format!("{name}:{n}")).collect();
        texts.join(" ")
    };
    assert_eq!(named(Colour::Blue), "end.kick-to-opponent:1 end.tackle:1 kick.2-3/1-2/lost:1");
    assert_eq!(named(Colour::Yellow), "end.goal:1 end.left:1 kick.2-3/1-2/team:1 shot.goal:1");
}

#[test]
fn a_kick_is_counted_once_by_who_touches_it_first() {
    let mut watch = AttackWatch::default();
    watch.possess(0.0, Colour::Blue);
    let by = who(Colour::Blue, 1);
    watch.flight = Some(Flight { by, at: 0.0, from: at(0.0, 0.0), speed: 2.5, shot: false, landed: false });
    // It passes from opponent to opponent before one of them has it, and goes out.
    watch.touched(1.0, who(Colour::Yellow, 2), at(1.5, 0.0));
    watch.touched(1.02, who(Colour::Yellow, 3), at(1.7, 0.0));
    watch.stopped(2.0, at(1.8, 3.1), None, true);
    let kicks: Vec<_> = watch.of(Colour::Blue).named().filter(|(name, _)| name.starts_with("kick")).collect();
    assert_eq!(kicks.len(), 1, "{kicks:?}");
    assert_eq!((kicks[0].0.as_str(), kicks[0].1), ("kick.2-3/1-2/lost", 1));
}
