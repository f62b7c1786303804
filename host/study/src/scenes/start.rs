//! `start`: starts of scenes: positions of all robots and of the ball at moments of played matches.

use geometry::{Field, Point, Pose, Vector};
use hil_sim::small_size::Ball;
use hil_sim::{NativeBackend, Stream};
use protocol::Who;
use rayon::prelude::*;
use rules::Phase;
use rules::restart::nearest_free_kick_spot;

use super::{SceneKind, ScenePlan, US};
use crate::matches::MatchTeam;
use arena::game::{Game, GameError, NoWatcher};

/// Start of a scene: places of ball and robots. Robots stand; in a match they moved.
#[derive(Clone, Debug)]
pub struct SceneStart {
    /// All robots on the field.
    pub robots: Vec<(Who, Pose<Field>)>,
    /// Position of the ball.
    pub ball: Point<Field>,
    /// Velocity of the ball as play begins, m/s.
    pub velocity: Vector<Field>,
}

impl SceneStart {
    pub(super) fn ball(&self) -> Ball {
        Ball::rolling(self.ball, self.velocity)
    }
}

/// The starts against one opponent. Matches are played until there are enough moments: ours is the team that
/// the variants are compared with.
pub(super) fn draw(
    plan: &ScenePlan,
    opponent: MatchTeam,
) -> Result<Vec<(SceneKind, u32, SceneStart)>, GameError> {
    let wanted = plan.free_kicks.max(plan.open_play) as usize;
    let mut moments = Vec::new();
    let mut first = 0;
    while moments.len() < wanted && first < MATCHES_MAX {
        let missing = (wanted - moments.len()).div_ceil(EXPECTED_A_MATCH) as u32;
        let last = (first + missing).min(MATCHES_MAX);
        let played: Result<Vec<_>, _> =
            (first..last).into_par_iter().map(|number| of_match(plan, opponent, number)).collect();
        moments.extend(played?.into_iter().flatten());
        first = last;
    }
    let kicks = moments.iter().zip(0..plan.free_kicks).map(|(moment, number)| {
        (
            SceneKind::FreeKick,
            number,
            SceneStart { ball: spot(plan, number), velocity: Vector::default(), ..moment.clone() },
        )
    });
    let open = moments
        .iter()
        .zip(0..plan.open_play)
        .map(|(moment, number)| (SceneKind::OpenPlay, number, moment.clone()));
    Ok(kicks.chain(open).collect())
}

/// Moments of one match, [`APART_S`] apart.
pub(super) fn of_match(
    plan: &ScenePlan,
    opponent: MatchTeam,
    number: u32,
) -> Result<Vec<SceneStart>, GameError> {
    let mut seed = Stream::new(plan.seed ^ u64::from(number), "scene's match");
    let seed = u64::from(seed.whole(0, u32::MAX));
    // The first half alone: in the second the teams have changed ends.
    let config = plan.config(plan.team, opponent, seed, 2.0 * HALF_S);
    let mut game = Game::new(&config, &mut NativeBackend::new(case_library::division_b()))?;
    let (mut moments, mut next) = (Vec::new(), FIRST_S);
    let end = game.referee().own_end(US);
    while game.referee().own_end(US) == end && game.time() < 2.0 * HALF_S {
        game.step(&mut NoWatcher)?;
        if game.time() < next {
            continue;
        }
        if let Some(start) = moment(&game) {
            moments.push(start);
            next = game.time() + APART_S;
        }
    }
    Ok(moments)
}

/// The present moment, if the ball is in play outside the defence areas and one of our robots is nearest.
fn moment(game: &Game<'_>) -> Option<SceneStart> {
    if game.referee().phase() != Phase::Run {
        return None;
    }
    let (world, field) = (game.world(), game.config().league.field());
    let ball = world.ball;
    let in_area = [geometry::GoalEnd::Negative, geometry::GoalEnd::Positive]
        .into_iter()
        .any(|end| field.distance_to_area(end, ball.position) <= 0.0);
    let robots = world.robots().iter().filter(|robot| robot.present);
    let distance = |who: &&hil_sim::small_size::Robot| who.pose.position.distance(ball.position);
    let nearest = robots.clone().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let ours = nearest.who.colour == US;
    (ours && !in_area && !ball.in_the_air()).then(|| SceneStart {
        robots: robots.map(|robot| (robot.who, robot.pose)).collect(),
        ball: ball.position,
        velocity: ball.velocity,
    })
}

/// A place for a free kick in the half of the opponents' goal, at which the referee would leave the ball.
fn spot(plan: &ScenePlan, number: u32) -> Point<Field> {
    let mut chance = Stream::new(plan.seed_of(SceneKind::FreeKick, number), "scene's spot");
    let field = plan.league.field();
    let config = plan.config(plan.team, plan.team, 0, 0.0);
    // Blue defends its own half and kicks in the other.
    let other = if config.referee.blue_on_positive_half { -1.0 } else { 1.0 };
    let x = other * chance.between(0.0, 0.5 * field.length);
    let wanted = Point::new(x, chance.between(-0.5, 0.5) * field.width);
    match plan.league.limits() {
        Some(limits) => nearest_free_kick_spot(&field, &limits, wanted),
        None => wanted,
    }
}

/// Length of the half from which moments are taken, s.
const HALF_S: f64 = 90.0;
/// The first moment of a match: kick-off is over, s.
const FIRST_S: f64 = 10.0;
/// Time between moments of a match: another attack, s.
const APART_S: f64 = 5.0;
/// Moments expected of a match; where there are fewer, more matches are played.
const EXPECTED_A_MATCH: usize = 6;
/// Matches at most: a team that never has the ball gives fewer scenes than wanted.
const MATCHES_MAX: u32 = 2_000;
