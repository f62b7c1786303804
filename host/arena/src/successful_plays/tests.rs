//! Tests of `successful_plays`: plays of a made-up match, and of trials.

use geometry::{GoalEnd, Vector};
use hil_sim::{Configuration, NativeBackend, Scenario, TrialOutcome};
use protocol::{RobotId, Who};
use rules::{Colour, League, Phase};

use super::finder::Follower;
use super::*;
use crate::attack::{BallContact, BallLook};
use crate::trial::{TrialConfig, run};

fn who(colour: Colour, id: u8) -> Who {
    Who { colour, id: RobotId::new(id).unwrap() }
}

/// A match whose robots stand and whose ball rolls as it is told; blue attacks towards -x.
struct Match {
    follower: Follower,
    now: f64,
    ball: [f32; 2],
    robots: Vec<(Who, Point<Field>)>,
    phase: Phase<Colour>,
    score: [u32; 2],
}

impl Match {
    fn new() -> Self {
        let at = |colour, id, x, y| (who(colour, id), Point::new(x, y));
        let robots = vec![
            at(Colour::Blue, 1, 0.6, 0.0),
            at(Colour::Blue, 2, -1.5, -1.0),
            at(Colour::Blue, 3, 4.0, 0.0),
            at(Colour::Yellow, 5, -2.0, 0.5),
        ];
        Self {
            follower: Follower::default(),
            now: 10.0,
            ball: [0.5, 0.0],
            robots,
            phase: Phase::Run,
            score: [0; 2],
        }
    }

    fn look(&mut self, contacts: &[BallContact]) {
        self.now += 0.01;
        self.follower.look(&BallLook {
            now: self.now,
            field: &League::DivisionB.field(),
            ball: Point::new(self.ball[0], self.ball[1]),
            height: 0.0,
            robots: &self.robots,
            phase: self.phase,
            score: self.score,
            own_ends: [GoalEnd::Negative, GoalEnd::Positive],
            contacts,
        });
    }

    fn touch(&mut self, colour: Colour, id: u8) {
        let at = Point::new(self.ball[0], self.ball[1]);
        self.look(&[BallContact::Touched { by: who(colour, id), at }]);
    }

    /// Rolls the ball there in a time, s, after the robot's kick.
    fn kick(&mut self, id: u8, to: [f32; 2], time: f32) {
        let from = self.ball;
        let velocity = Vector::new((to[0] - from[0]) / time, (to[1] - from[1]) / time);
        let by = who(Colour::Blue, id);
        let kicked = BallContact::Kicked { by, at: self.now, from: Point::new(from[0], from[1]), velocity };
        self.look(&[kicked]);
        let ticks = (time * 100.0) as i32;
        for tick in 1..=ticks {
            let part = tick as f32 / ticks as f32;
            self.ball = [0, 1].map(|i| from[i] + part * (to[i] - from[i]));
            self.look(&[]);
        }
    }

    fn plays(self) -> Vec<SuccessfulPlay> {
        self.follower.found.into_iter().map(|found| found.play).collect()
    }
}

#[test]
fn a_pass_and_a_shot_are_one_play_seen_in_attack_towards_the_positive_end() {
    let mut game = Match::new();
    // Robots are known some camera frames after the ball.
    let robots = std::mem::take(&mut game.robots);
    (0..3).for_each(|_| game.look(&[]));
    game.robots = robots;
    game.touch(Colour::Blue, 1);
    game.kick(1, [-1.4, -1.0], 0.7);
    game.touch(Colour::Blue, 2);
    (0..20).for_each(|_| game.look(&[]));
    game.kick(2, [-4.5, -0.3], 0.6);
    let plays = game.plays();
    assert_eq!(plays.len(), 1);
    let play = &plays[0];
    let passed = Holding { robot: 1, got: [-500, 0], left: [-500, 0] };
    let shot = Holding { robot: 2, got: [1400, 1000], left: [1400, 1000] };
    assert_eq!(play.holdings, [passed, shot]);
    assert_eq!((play.end, play.goal, play.field), (PlayEnd::Shot(300), false, [9000, 6000]));
    assert_eq!(play.opponents, [[2000, -500]]);
    assert!(play.teammates.contains(&(3, [-4000, 0])) && play.is_sane());
}

#[test]
fn a_goal_is_given_to_the_shot_before_it_and_to_a_slow_kick_where_there_was_none() {
    for (time, shots) in [(0.6, true), (1.5, false)] {
        let mut game = Match::new();
        game.touch(Colour::Blue, 2);
        game.ball = [-1.4, -1.0];
        game.kick(2, [-4.5, -0.3], time);
        assert_eq!(game.follower.found.len(), usize::from(shots));
        (game.phase, game.score) = (Phase::Stop, [0, 1]);
        game.look(&[]);
        let plays = game.plays();
        assert_eq!((plays.len(), plays[0].goal, plays[0].holdings.len()), (1, true, 1), "{time} s");
    }
}

#[test]
fn a_ball_that_an_opponent_had_between_is_no_pass() {
    let mut game = Match::new();
    game.touch(Colour::Blue, 1);
    game.kick(1, [-2.0, 0.4], 0.8);
    (0..10).for_each(|_| game.touch(Colour::Yellow, 5));
    game.ball = [-1.4, -1.0];
    game.touch(Colour::Blue, 2);
    game.kick(2, [-4.5, -0.3], 0.6);
    let plays = game.plays();
    assert_eq!(plays.len(), 1);
    assert_eq!(plays[0].holdings.iter().map(|holding| holding.robot).collect::<Vec<_>>(), [2]);
}

#[test]
fn trials_to_goal_have_a_play_that_ends_with_their_last_kick_and_others_have_none() {
    let (mut passes, mut found) = (0, 0);
    for seed in 1..=12 {
        let config =
            TrialConfig::new(Scenario::Random, Configuration::DefenderGoalie, brain::Approach::Cases, seed);
        let (mut play, mut recording) = (LeggedPlay::default(), crate::Recording::default());
        let report =
            run(&config, Box::new(NativeBackend::new(config.base)), &mut [&mut play, &mut recording]);
        let to_goal = matches!(report.unwrap().outcome, TrialOutcome::Goal | TrialOutcome::Close);
        assert_eq!(play.found().is_some(), to_goal, "seed {seed}");
        let Some(play) = play.found() else { continue };
        found += 1;
        passes += play.holdings.len() - 1;
        let last = play.holdings.last().unwrap();
        let kick = recording.kicks.iter().rfind(|kick| kick.robot < 2).unwrap();
        if let PlayEnd::Shot(_) = play.end {
            assert_eq!((last.left, usize::from(last.robot)), (seen(kick.from, 1.0), kick.robot + 1));
        }
        assert!(play.is_sane());
    }
    assert!(found >= 3 && passes >= 1, "{found} plays, {passes} passes");
}
