//! `prepare`: tests: a whole team stands where it must after a PREPARE command, from any start positions.
//! Hosts, radio, brains and wheels as in a match; the judge is `rules::keep_out` on the simulator's truth.

use arena::game::{Game, GameConfig, NoWatcher};
use geometry::{Angle, Field, Point, Pose};
use hil_sim::NativeBackend;
use protocol::{Duration, Who};
use rules::keep_out::{KeepOutReason, Situation, keep_out};
use rules::limits::ROBOT_RADIUS;
use rules::state::RefereeCommand;
use rules::{Colour, League, Phase, RuleRole};

/// Time that the controller gives teams to prepare, s.
const TIME: f64 = 10.0;
/// A robot that has to move stands no longer than this, s.
const STANDS: f64 = 1.0;
const STANDING: f32 = 0.03;

fn share(state: &mut u64) -> f32 {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40) as f32 / 8_388_608.0 - 1.0
}

/// All robots to random places of the field, apart from each other, from the ball and from goals' walls.
fn scatter(game: &mut Game<'_>, league: League, state: &mut u64) {
    let field = league.field();
    let who: Vec<Who> = game.world().robots().iter().filter(|robot| robot.present).map(|r| r.who).collect();
    let ball = game.world().ball.position;
    let mut taken: Vec<Point<Field>> = Vec::new();
    for who in who {
        let at = loop {
            let x = share(state) * (0.5 * field.length + field.goal_line_margin - 0.1);
            let at = Point::new(x, share(state) * (0.5 * field.width + field.margin - 0.1));
            let in_goal = x.abs() > 0.5 * field.length - 0.1 && at.y().abs() < 0.5 * field.goal_width + 0.15;
            if !in_goal && at.distance(ball) > 0.2 && taken.iter().all(|other| other.distance(at) > 0.25) {
                break at;
            }
        };
        taken.push(at);
        let heading = Angle::new(share(state) * core::f32::consts::PI);
        game.put_robot(who, Pose { position: at, heading });
    }
}

/// The reason why a robot must not be where it is, if any.
fn offence(game: &Game<'_>, league: League, who: Who) -> Option<KeepOutReason> {
    let field = league.field();
    let host = game.host(who.colour);
    let order = host.orders().iter().find(|order| order.robot == who.id);
    let kicker = order.is_some_and(|order| order.role == host::strategy::Role::Kicker);
    let keeper = game.referee().accounts().is_keeper(who);
    let phase = game.referee().phase().seen_by(who.colour);
    let situation = Situation {
        field: &field,
        own: game.referee().own_end(who.colour),
        phase,
        rule_role: if keeper {
            RuleRole::Keeper
        } else if kicker {
            RuleRole::Kicker
        } else {
            RuleRole::Player
        },
        ball: Some(game.world().ball.position),
        placement: None,
        ball_in_play: false,
    };
    let at = game.world().robot(who)?.pose.position;
    keep_out(&situation).offence(at, ROBOT_RADIUS).filter(|why| why.offends(phase))
}

/// Offences at the end of one preparation.
fn prepare(league: League, command: RefereeCommand, seed: u64) -> Vec<String> {
    let mut config = GameConfig::new(league, seed, 60.0);
    // Longer than the test: the referee does not start play by itself.
    config.referee.patience = Duration::millis(30_000);
    let mut game = Game::new(&config, &mut NativeBackend::new(case_library::division_b())).unwrap();
    let mut state = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let wanted = command.leads_to(Phase::Stop).expect("it leads somewhere");
    let mut asked = false;
    while game.time() < 20.0 && game.referee().phase() != wanted {
        if !asked && game.time() > 0.5 {
            asked = game.command(command);
        }
        game.step(&mut NoWatcher).unwrap();
    }
    assert_eq!(game.referee().phase(), wanted, "seed {seed}: the referee prepares");
    scatter(&mut game, league, &mut state);
    let begun = game.time();
    let all: Vec<Who> = game.world().robots().iter().filter(|robot| robot.present).map(|r| r.who).collect();
    let mut stood = vec![(0.0_f64, 0.0_f64); all.len()];
    while game.time() - begun < TIME && game.referee().phase() == wanted {
        game.step(&mut NoWatcher).unwrap();
        for (who, (now, longest)) in all.iter().zip(&mut stood) {
            let stands = game.world().robot(*who).is_some_and(|robot| robot.velocity.norm() < STANDING);
            // The tracked state of a robot that was lifted elsewhere settles within the first half second.
            let late = game.time() - begun > 0.5;
            *now = if late && stands && offence(&game, league, *who).is_some() { *now + 0.01 } else { 0.0 };
            *longest = longest.max(*now);
        }
    }
    // If the referee went on, it has seen all robots ready.
    let ended = game.referee().phase() == wanted;
    let mut wrong = Vec::new();
    for (who, (_, longest)) in all.iter().zip(&stood) {
        let at = game.world().robot(*who).map(|robot| robot.pose.position);
        let reported = || {
            format!("{} {command:?}, seed {seed}: {} {} at {at:?}", league.name(), who.colour.label(), who.id)
        };
        if let Some(why) = offence(&game, league, *who).filter(|_| ended) {
            wrong.push(format!("{} ends in {why:?}", reported()));
        } else if *longest > STANDS {
            wrong.push(format!("{} stood for {longest:.2} s where it must not be", reported()));
        }
    }
    wrong
}

fn all(league: League, seeds: u64) {
    let seeds = std::env::var("PREPARE_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(seeds);
    let mut wrong = Vec::new();
    for seed in 0..seeds {
        for colour in [Colour::Yellow, Colour::Blue] {
            wrong.extend(prepare(league, RefereeCommand::PreparePenalty(colour), seed));
            wrong.extend(prepare(league, RefereeCommand::PrepareKickoff(colour), seed));
        }
    }
    assert!(wrong.is_empty(), "{} robots:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn a_team_of_division_b_is_where_it_must_be_10_s_after_every_preparation() {
    all(League::DivisionB, 4);
}

#[test]
fn a_team_of_2013_is_too() {
    all(League::Ssl2013, 3);
}

#[test]
fn a_team_of_division_a_is_too() {
    all(League::DivisionA, 2);
}
