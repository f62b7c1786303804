//! `practice`: tests of a team that practises on a part of the field, in whole matches.

use arena::game::{Game, GameConfig, NoWatcher};
use geometry::{Point, Vector};
use hil_sim::NativeBackend;
use hil_sim::small_size::Ball;
use host::config::ParameterChange;
use rules::{Colour, League, Phase};

#[test]
fn a_team_that_practises_on_its_half_stays_near_it_and_knows_no_ball_beyond() {
    let (mut ran, mut beyond) = (0, 0);
    let (mut robots, mut out, mut far_out) = (0, 0, 0);
    for seed in [3, 4, 5] {
        let mut game = practising(seed);
        while game.time() < 40.0 {
            game.step(&mut NoWatcher).unwrap();
            // Every ten seconds it rolls on the other half.
            if game.referee().phase() == Phase::Run && game.time().rem_euclid(10.0) < 0.005 {
                game.put_ball(Ball { velocity: Vector::new(0.5, 0.2), ..Ball::at(Point::new(-2.0, 0.0)) });
            }
            let ball = &game.host(Colour::Blue).world().ball;
            assert!(ball.as_ref().is_none_or(|ball| ball.position.x() >= -0.01), "{ball:?}");
            ran += u32::from(game.referee().phase() == Phase::Run);
            beyond += u32::from(game.world().ball.position.x() < -0.5);
            for robot in game.world().robots().iter().filter(|robot| robot.who.colour == Colour::Blue) {
                robots += 1;
                out += u32::from(robot.pose.position.x() < -0.2);
                far_out += u32::from(robot.pose.position.x() < -1.0);
            }
        }
        println!("seed {seed}: of {robots} robots' ticks {out} beyond 0.2 m, {far_out} beyond 1 m");
    }
    // Ordered places are inside; robots go round the ball, the centre circle and others, and leave for a
    // moment.
    assert!(out * 15 < robots && far_out * 200 < robots, "{out} and {far_out} of {robots}");
    assert!(ran > 1_500 && beyond > 200, "{ran} ticks of play, the ball beyond in {beyond}");
}

/// A match in which blue, which defends the goal at +x, practises on its half.
fn practising(seed: u64) -> Game<'static> {
    let config = GameConfig::new(League::DivisionB, seed, 60.0);
    let mut game = Game::new(&config, &mut NativeBackend::new(case_library::division_b())).unwrap();
    let change = ParameterChange::from_json(br#"{"key":"practice.within","value":"+x"}"#).unwrap();
    game.change(Colour::Blue, &change, &mut NoWatcher).unwrap();
    game
}
