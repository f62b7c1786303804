//! Tests of the match statistics, against counts made by hand.

use super::*;

#[test]
fn match_running_and_in_play_time_are_counted_apart() {
    let mut stage = kickoff(settings());
    let before = stage.referee.metrics().match_s;
    stage.run(4.0);
    stage.move_ball(at(0.2, 0.0));
    stage.step();
    stage.run(6.0);
    stage.move_ball(at(-1.0, 0.0));
    stage.run(2.0);
    let metrics = stage.referee.metrics();
    assert!((metrics.match_s - before - 12.01).abs() < 0.02);
    assert!((metrics.running_s - 12.01).abs() < 0.02, "{metrics:?}");
    assert!((metrics.in_play_s - 8.0).abs() < 0.02);
    // Yellow defends −x: 6 s in blue's half, 2 s in yellow's; no robot touched the ball.
    assert!((metrics.yellow.ball_in_their_half_s - 6.0).abs() < 0.03);
    assert!((metrics.offence_ratio(Colour::Yellow).unwrap() - 3.0).abs() < 0.05);
    assert!((metrics.ball_in_play() - metrics.in_play_s / metrics.match_s).abs() < 1e-6);
    assert_eq!((metrics.yellow.possession_s, metrics.attack_ratio(Colour::Yellow)), (0.0, None));
}

/// Yellow's robot 2 kicks the ball from there with this velocity, and no robot stops it for half a second.
fn shot(from: Point<Field>, x: f32, y: f32) -> TeamMetrics {
    let mut stage = in_play();
    stage.kick_from(from, yellow(2), [x, y]);
    stage.run(0.5);
    stage.referee.metrics().yellow
}

#[test]
fn shots_aim_near_the_goal_and_chances_between_the_posts() {
    let count = |team: TeamMetrics| (team.shots, team.chances);
    // From (2, 0) the posts at (4.5, ±0.5) lie at ±0.2 of the forward distance, one goal's width beside them
    // at ±0.6.
    assert_eq!(count(shot(at(2.0, 0.0), 4.0, 0.0)), (1, 1));
    assert_eq!(count(shot(at(2.0, 0.0), 4.0, 0.7)), (1, 1));
    assert_eq!(count(shot(at(2.0, 0.0), 4.0, 0.9)), (1, 0));
    assert_eq!(count(shot(at(2.0, 0.0), 4.0, 2.5)), (0, 0));
    // Away from the goal; from the own half; too slow for a shot; too slow to get there: 1.5²/(2 · 0.35) =
    // 3.2 m.
    assert_eq!(count(shot(at(2.0, 0.0), -4.0, 0.0)), (0, 0));
    assert_eq!(count(shot(at(-1.0, 0.0), 4.0, 0.0)), (0, 0));
    assert_eq!(count(shot(at(2.0, 0.0), 1.4, 0.0)), (0, 0));
    assert_eq!(count(shot(at(0.5, 0.0), 1.55, 0.0)), (1, 0));
}

#[test]
fn a_touch_of_a_teammate_half_a_metre_on_is_a_pass_of_an_opponent_a_loss() {
    let mut stage = in_play();
    // Yellow's kick-off that blue's robot 1 got.
    let metrics = stage.referee.metrics();
    assert_eq!((metrics.yellow.passes, metrics.yellow.losses), (0, 1));
    for (who, x) in [(yellow(1), -2.0), (yellow(2), -1.0), (yellow(1), -0.8), (blue(1), 0.0), (blue(2), 1.0)]
    {
        stage.move_ball(at(x, 1.0));
        stage.touch(who);
        stage.step();
    }
    let metrics = stage.referee.metrics();
    // Blue's loss; yellow's 1 to 2 (1 m: a pass), 2 to 1 (0.2 m: none); yellow's loss; blue's 1 to 2 (a
    // pass).
    assert_eq!((metrics.yellow.passes, metrics.yellow.losses), (1, 2));
    assert_eq!((metrics.blue.passes, metrics.blue.losses), (1, 1));
}

#[test]
fn possession_is_the_time_after_a_teams_touch() {
    let mut stage = in_play();
    let before = stage.referee.metrics().clone();
    stage.move_ball(at(1.0, 0.0));
    stage.touch(yellow(1));
    stage.run(2.0);
    stage.touch(blue(1));
    stage.run(1.0);
    let metrics = stage.referee.metrics();
    assert!((metrics.yellow.possession_s - before.yellow.possession_s - 2.01).abs() < 0.02, "{metrics:?}");
    assert!((metrics.blue.possession_s - before.blue.possession_s - 1.01).abs() < 0.02);
}

#[test]
fn offences_are_counted_by_team_and_kind() {
    let mut stage = in_play();
    for _ in 0..2 {
        stage.kick_from(at(-3.0, 1.0), yellow(1), [7.0, 0.0]);
        stage.step();
        stage.kick(0.0, 0.0);
        stage.run(0.5);
    }
    let offences = &stage.referee.metrics().offences;
    assert_eq!(offences.team(Colour::Yellow).collect::<Vec<_>>(), [(Kind::BallTooFast, 2)]);
    assert_eq!(offences.team(Colour::Blue).count(), 0);
    assert_eq!(Kind::BallTooFast.label(), "bot_kicked_ball_too_fast");
}
