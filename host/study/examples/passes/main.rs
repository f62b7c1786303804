//! `passes`: plays matches and compares the probabilities of passes and shots with what became of them: fits
//! P(we have it) on three of four seeds, and reports on the fourth.
//!
//! `cargo run --release -p onetwo-study --example passes -- LEAGUE OPPONENTS FIRST_SEED COUNT SECONDS`, as in
//! `passes division-b ours,zone,reactive,marking,round-1 201 16 300`; passes are ours, shots are both teams'.

mod fit;

use arena::attack::BallEvent;
use arena::game::{Game, GameConfig, Watcher, play};
use casebase::CaseBase;
use fit::Sample;
use geometry::{Attack, Field, Point};
use hil_sim::NativeBackend;
use host::strategy::Team;
use host::strategy::pass::open::GoalOpening;
use host::strategy::pass::{Kicks, Ordered, PassConstants, PassVerdict, conditions};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use protocol::{Instant, Who};
use rayon::prelude::*;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{Colour, League};
use study::matches::MatchTeam;

const USAGE: &str =
    "usage: passes LEAGUE OPPONENTS FIRST_SEED COUNT SECONDS, as in `passes division-b ours,zone 201 16 300`";

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [league, opponents, first, count, seconds] = &arguments[..] else { return Err(USAGE.into()) };
    let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
    let league = leagues.into_iter().find(|known| known.name() == league).ok_or(USAGE)?;
    let opponents = opponents.split(',').map(MatchTeam::parse).collect::<Result<Vec<_>, _>>()?;
    let number = |text: &str| text.parse::<u64>().map_err(|error| format!("{text}: {error}; {USAGE}"));
    let (first, count, seconds) = (number(first)?, number(count)?, number(seconds)?);
    let matches: Vec<_> =
        opponents.iter().flat_map(|team| (first..first + count).map(move |seed| (*team, seed))).collect();
    let played: Vec<(u64, Account)> = matches
        .par_iter()
        .map(|&(opponent, seed)| Ok((seed, one(league, opponent, seed, seconds as f64)?)))
        .collect::<Result<_, String>>()?;
    let sample = |seed: u64, predicted: f32, seen| Sample {
        predicted: f64::from(predicted),
        seen,
        train: !seed.is_multiple_of(4),
    };
    let mut passes = Vec::new();
    let mut shots = Vec::new();
    for (seed, account) in &played {
        let kicked =
            account.passes.iter().filter(|(_, verdict)| !matches!(verdict, PassVerdict::NoKick { .. }));
        passes
            .extend(kicked.map(|(pass, verdict)| {
                sample(*seed, pass.conditions.iter().product(), verdict.is_success())
            }));
        shots.extend(account.shots.iter().map(|(goal, scored)| sample(*seed, *goal, *scored)));
    }
    let held_out =
        |all: &[Sample]| all.iter().filter(|sample| !sample.train).copied().collect::<Vec<Sample>>();
    let (least, most) = fit::bounds(&passes);
    let fitted = |p: f64| least + (most - least) * p;
    let rest = held_out(&passes);
    println!("{} passes; P(we have it) = {least:.3} + {:.3} · P(receive)", passes.len(), most - least);
    println!(
        "mean log-likelihood of the {} not used for it: {:.3}, of P(receive) itself {:.3}",
        rest.len(),
        fit::mean_log_likelihood(&rest, fitted),
        fit::mean_log_likelihood(&rest, |p| p)
    );
    fit::print_reliability(&rest, fitted);
    println!("as the program has it, all passes:");
    fit::print_reliability(&passes, |p| f64::from(conditions::ours_after(p as f32)));
    println!("P(goal) of {} shots, both teams':", shots.len());
    fit::print_reliability(&shots, |p| p);
    Ok(())
}

fn one(league: League, opponent: MatchTeam, seed: u64, seconds: f64) -> Result<Account, String> {
    let mut config = GameConfig::new(league, seed, seconds).between(Team::Ours, opponent.team);
    for team in config.teams.iter_mut().filter(|team| team.colour == Colour::Yellow) {
        (team.tactics, team.approach) = (opponent.host_tactics(), opponent.approach());
    }
    let base = match league {
        League::DivisionB => case_library::division_b(),
        _ => CaseBase::default(),
    };
    let mut account = Account::default();
    play(&config, &mut NativeBackend::new(base), &mut account).map_err(|error| error.to_string())?;
    Ok(account)
}

/// What became of the blue team's passes, and of all shots.
#[derive(Clone, Debug, Default)]
struct Account {
    newest: Option<Instant>,
    passes: Vec<(Ordered, PassVerdict)>,
    /// The shot that is under way: its team, and P(goal).
    shot: Option<(Colour, f32)>,
    shots: Vec<(f32, bool)>,
}

impl Watcher for Account {
    fn tick(&mut self, game: &Game<'_>) {
        for event in game.ledger().attack().events() {
            match *event {
                BallEvent::Shot { by } => {
                    self.over(None);
                    self.shot = Some((by.colour, goal(game, by)));
                }
                BallEvent::Goal { team } => self.over(Some(team)),
                BallEvent::Stopped => self.over(None),
                _ => {}
            }
        }
        let Some(judged) = game.host(Colour::Blue).judged_pass() else { return };
        if self.newest.replace(judged.0.at) != Some(judged.0.at) {
            self.passes.push(*judged);
        }
    }
}

impl Account {
    fn over(&mut self, scored: Option<Colour>) {
        if let Some((team, goal)) = self.shot.take() {
            self.shots.push((goal, scored == Some(team)));
        }
    }
}

/// P(goal) of a shot that leaves now, rated on the true places.
fn goal(game: &Game<'_>, by: Who) -> f32 {
    let (world, league) = (game.world(), game.config().league);
    let field = league.field();
    let sign = game.referee().own_end(by.colour).opposite().sign() as f32;
    let turned = |at: Point<Field>| Point::<Attack>::new(at.x() * sign, at.y() * sign);
    let opponents = world.robots().iter().filter(|robot| robot.present && robot.who.colour != by.colour);
    let opening = GoalOpening {
        x: field.length * 0.5,
        half: field.goal_width * 0.5 - BALL_RADIUS,
        body: ROBOT_RADIUS + BALL_RADIUS,
    };
    let from = turned(world.ball.position);
    let open = opening.open_from(from, opponents.map(|robot| turned(robot.pose.position)));
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let c = kicks.constants();
    let time = kicks.shot().at(from.distance(open.aim)).0;
    conditions::beats_the_keeper(time, c)
        * conditions::open_goal(open.angle, c)
        * conditions::not_stolen(false, c)
}
