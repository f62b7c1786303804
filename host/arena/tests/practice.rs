//! `practice`: tests of a team that practises on a part of the field, in whole matches.

use arena::game::{Game, GameConfig, NoWatcher};
use hil_sim::NativeBackend;
use host::config::ParameterChange;
use rules::{Colour, League, Phase};

#[test]
fn a_team_that_practises_on_its_half_stays_near_it_and_knows_no_ball_beyond() {
    let config = GameConfig::new(League::DivisionB, 3, 60.0);
    let mut game = Game::new(&config, &mut NativeBackend::new(case_library::division_b())).unwrap();
    // Blue defends the goal at +x.
    let change = ParameterChange::from_json(br#"{"key":"practice.within","value":"+x"}"#).unwrap();
    game.change(Colour::Blue, &change, &mut NoWatcher).unwrap();
    let (mut ran, mut beyond, mut worst) = (0, 0, 0.0_f32);
    while game.time() < 40.0 {
        game.step(&mut NoWatcher).unwrap();
        let host = game.host(Colour::Blue);
        assert!(
            host.world().ball.as_ref().is_none_or(|ball| ball.position.x() >= -0.01),
            "{:?}",
            host.world().ball
        );
        ran += u32::from(game.referee().phase() == Phase::Run);
        beyond += u32::from(game.world().ball.position.x() < -0.5);
        let blue = game.world().robots().iter().filter(|robot| robot.who.colour == Colour::Blue);
        let farthest = blue.map(|robot| robot.pose.position.x()).fold(f32::INFINITY, f32::min);
        worst = worst.min(farthest);
    }
    // Ordered places are inside; around the ball and others a robot may leave for a moment (0.81 m here).
    assert!(worst > -1.0, "a robot at x = {worst} m");
    assert!(ran > 500 && beyond > 200, "{ran} ticks of play, the ball beyond in {beyond}");
}
