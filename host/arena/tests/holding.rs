//! `holding`: tests: a robot with the ball always acts on it. Situations in which robots stood with the ball,
//! or beside it, set up in a match in play; seconds until the ball has moved on.

use arena::game::{Game, GameConfig, GameReport, NoWatcher};
use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use hil_sim::NativeBackend;
use hil_sim::small_size::Ball;
use host::strategy::Team;
use protocol::{RobotId, Who};
use rules::{Colour, League, Phase};

const LEAGUE: League = League::DivisionB;

fn who(colour: Colour, number: u8) -> Who {
    Who { colour, id: RobotId::new(number).unwrap() }
}

/// A match in play, blue ours; places are given as blue attacks +x, its own goal at −4.5 m.
struct Stage<'a> {
    game: Game<'a>,
    config: GameConfig,
    sign: f32,
}

impl Stage<'_> {
    fn new(seed: u64, opponent: Team) -> Self {
        let config = GameConfig::new(LEAGUE, seed, 600.0).between(Team::Ours, opponent);
        let backend = Box::leak(Box::new(NativeBackend::new(case_library::division_b())));
        let mut game = Game::new(&config, backend).unwrap();
        while game.referee().phase() != Phase::Run {
            game.step(&mut NoWatcher).unwrap();
        }
        let sign = if game.referee().own_end(Colour::Blue) == GoalEnd::Negative { 1.0 } else { -1.0 };
        Self { game, config, sign }
    }

    fn at(&self, x: f32, y: f32) -> Point<Field> {
        Point::new(self.sign * x, self.sign * y)
    }

    fn put(&mut self, colour: Colour, places: &[(f32, f32, f32)]) {
        for (number, (x, y, degrees)) in (0..).zip(places) {
            let turn = if self.sign > 0.0 { 0.0 } else { 180.0 };
            let pose = Pose { position: self.at(*x, *y), heading: Angle::degrees(degrees + turn) };
            self.game.put_robot(who(colour, number), pose);
        }
    }

    fn ball(&mut self, x: f32, y: f32) {
        let at = self.at(x, y);
        self.game.put_ball(Ball::at(at));
    }

    /// Plays on; the seconds until the ball is farther than `at_least` from where it lay, if that comes
    /// within `seconds`.
    fn until_moved(
        &mut self,
        seconds: f64,
        at_least: f32,
        mut meanwhile: impl FnMut(&mut Self),
    ) -> Option<f64> {
        let (from, begin) = (self.game.world().ball.position, self.game.time());
        while self.game.time() - begin < seconds {
            meanwhile(self);
            self.game.step(&mut NoWatcher).unwrap();
            if self.game.world().ball.position.distance(from) > at_least {
                return Some(self.game.time() - begin);
            }
        }
        None
    }

    fn report(&self) -> GameReport {
        GameReport::of(&self.config, &self.game)
    }
}

const OURS: [(f32, f32, f32); 6] = [
    (-4.3, 0.0, 0.0),
    (0.5, 0.0, 0.0),
    (-3.3, 0.2, 0.0),
    (-3.3, -0.2, 0.0),
    (0.0, 2.0, 0.0),
    (0.0, -2.0, 0.0),
];

/// An opponent that stays on the line from the ball to its goal, this far before the ball, no faster than 1.5
/// m/s.
fn mirror(stage: &mut Stage<'_>, number: u8, off: f32) {
    let ball = stage.game.world().ball.position;
    let goal = stage.at(4.5, 0.0);
    let me = who(Colour::Yellow, number);
    let Some(robot) = stage.game.world().robot(me) else { return };
    let at_least: Vector<Field> = (goal - ball).unit().unwrap_or_default();
    let here = robot.pose.position;
    let position = here + (ball + at_least * off - here).clamped(0.015);
    stage.game.put_robot(me, Pose { position, heading: position.direction_to(ball) });
}

#[test]
fn a_holder_with_an_opponent_mirroring_it_has_let_the_ball_go_within_four_seconds() {
    let mut longest = Vec::new();
    for (seed, off) in (1..=8).zip([0.3, 0.35, 0.4, 0.45, 0.5, 0.3, 0.35, 0.4]) {
        let mut stage = Stage::new(seed, Team::Idle);
        let x = 0.5 + 0.3 * seed as f32;
        stage.put(Colour::Yellow, &[(4.4, 0.0, 180.0), (x + 0.1 + off, 0.0, 180.0)]);
        let mut ours = OURS;
        ours[1] = (x, 0.0, 0.0);
        stage.put(Colour::Blue, &ours);
        stage.ball(x + 0.0955, 0.0);
        let _ = stage.until_moved(12.0, 10.0, |stage| mirror(stage, 1, off));
        longest.push(stage.report().longest_hold_s);
    }
    println!("mirrored: {longest:?}");
    assert!(longest.iter().all(|hold| *hold < 4.0), "{longest:?}");
}

#[test]
fn a_wall_of_five_before_the_goal_does_not_stop_the_match() {
    let mut stops = Vec::new();
    for seed in 1..=4 {
        let mut stage = Stage::new(seed, Team::Idle);
        let wall: Vec<_> = (0..5).map(|i| (3.3, 0.2 * i as f32 - 0.4, 180.0)).collect();
        let mut theirs = vec![(4.4, 0.0, 180.0)];
        theirs.extend(wall);
        stage.put(Colour::Yellow, &theirs);
        let mut ours = OURS;
        ours[1] = (2.3, 0.1 * seed as f32, 0.0);
        stage.put(Colour::Blue, &ours);
        stage.ball(2.5, 0.1 * seed as f32);
        let (before, goals) = (stage.report().no_progress, stage.report().score.blue);
        let _ = stage.until_moved(40.0, 20.0, |_| {});
        let report = stage.report();
        stops.push((report.no_progress - before, report.longest_hold_s, report.score.blue - goals));
    }
    println!("wall (no progress, longest hold, goals): {stops:?}");
    assert!(stops.iter().all(|(stops, hold, _)| *stops == 0 && *hold < 4.0), "{stops:?}");
}

#[test]
fn a_ball_just_before_their_area_is_played() {
    let mut took = Vec::new();
    for (seed, (x, y)) in
        (1..).zip([(3.48, 0.0), (3.48, 0.6), (3.47, -0.9), (3.49, 0.3), (4.0, 1.02), (3.46, 0.0)])
    {
        let mut stage = Stage::new(seed, Team::Idle);
        stage.put(Colour::Yellow, &[(4.4, 0.0, 180.0), (1.0, 2.5, 0.0), (1.0, -2.5, 0.0)]);
        let mut ours = OURS;
        ours[1] = (2.5, 0.3, 0.0);
        stage.put(Colour::Blue, &ours);
        stage.ball(x, y);
        took.push(stage.until_moved(9.0, 0.3, |_| {}));
    }
    println!("before their area: {took:?}");
    assert!(took.iter().all(Option::is_some), "{took:?}");
}

#[test]
fn a_ball_just_outside_our_area_is_played_by_whoever_is_there_first() {
    let mut took = Vec::new();
    for (seed, (x, y)) in
        (1..).zip([(-3.45, 0.0), (-3.4, 0.5), (-3.35, -0.5), (-3.25, 0.2), (-4.0, 1.15), (-3.3, 1.1)])
    {
        let mut stage = Stage::new(seed, Team::Idle);
        stage.put(Colour::Yellow, &[(4.4, 0.0, 180.0), (1.0, 2.5, 0.0), (1.0, -2.5, 0.0)]);
        let mut ours = OURS;
        ours[2] = (-3.3 + 0.2, y + 0.05, 180.0);
        ours[3] = (-3.3, y - 0.3, 90.0);
        stage.put(Colour::Blue, &ours);
        stage.ball(x, y);
        took.push(stage.until_moved(8.0, 0.8, |_| {}));
    }
    println!("before our area: {took:?}");
    assert!(took.iter().all(|took| took.is_some_and(|seconds| seconds < 4.0)), "{took:?}");
}
