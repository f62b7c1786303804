//! `opponents`: opponent teams that our play is measured against. Honest teams that share our view, motion,
//! limits, skills, keeper and restarts, and differ in open play alone; each does one thing that teams of the
//! league are known for (Biswas et al. 2014 §6).
//!
//! [`Team`] names them. Each is a module: `reactive` runs for the ball and shoots, `marking` stays with every opponent, `zone`
//! follows the ball with a wall. Attack frame, m, m/s, s.

mod marking;
mod reactive;
mod zone;

use geometry::{Angle, Attack, Point};
use protocol::{Duration, Instant, RobotId};
use serde::{Deserialize, Serialize};

use super::order::{Order, Role, Task, Why};
use super::support::{self, Target};
use super::view::{Ball, ROBOTS_MAX, View};
use super::{Orders, defence, restart, roles};

/// Who decides a side's open play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Team {
    /// We.
    #[default]
    Ours,
    /// The nearest runs for the ball and shoots or clears, a second backs it up.
    Reactive,
    /// Swift man-to-man: everybody stays between an opponent and the own goal.
    Marking,
    /// A wall between ball and goal that follows the ball.
    Zone,
    /// Its robots stand, whatever happens: who cannot score against it cannot score.
    Idle,
}

impl Team {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Ours, Self::Reactive, Self::Marking, Self::Zone, Self::Idle];
    /// Those that play and are not we.
    pub const OPPONENTS: [Self; 3] = [Self::Reactive, Self::Marking, Self::Zone];

    /// Its name on command lines and in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Reactive => "reactive",
            Self::Marking => "marking",
            Self::Zone => "zone",
            Self::Idle => "idle",
        }
    }

    /// The team of that name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|team| team.word() == word)
    }
}

/// The open play of one of [`Team::OPPONENTS`], with what it remembers.
#[derive(Clone, Debug)]
pub(super) struct Rival {
    style: Style,
    /// Who goes for the ball.
    first: Option<RobotId>,
    /// What the ball is meant for, since when, from where.
    aim: Option<(Instant, Point<Attack>, Target)>,
    /// Who had which of the style's places.
    held: [Option<RobotId>; PLACES],
}

/// What tells one opponent from another.
#[derive(Clone, Copy, Debug)]
struct Style {
    /// What the one at the ball does with it.
    target: fn(&View, RobotId, Point<Attack>) -> Target,
    /// Where the others stand, most urgent first, while `wanted` of them are free.
    places: fn(&View, &Ball, usize) -> Places,
}

/// A place to be taken, as what, and why.
type Place = (Point<Attack>, Role, Why);
type Places = heapless::Vec<Place, ROBOTS_MAX>;
type Free = heapless::Vec<RobotId, ROBOTS_MAX>;

impl Rival {
    /// Of that team; none for those whose open play is not here.
    pub(super) fn of(team: Team) -> Option<Self> {
        let style = match team {
            Team::Reactive => reactive::STYLE,
            Team::Marking => marking::STYLE,
            Team::Zone => zone::STYLE,
            Team::Ours | Team::Idle => return None,
        };
        Some(Self { style, first: None, aim: None, held: [None; PLACES] })
    }

    /// Orders in open play for those of `free`, who are taken out of it; `barred` must not touch the ball.
    pub(super) fn open_play(&mut self, view: &View, free: &mut Free, barred: Option<RobotId>) -> Orders {
        let mut orders = Orders::new();
        // One order a robot, and as many places as robots.
        let mut order = |free: &mut Free, robot: RobotId, role: Role, task: Task, why: Why| {
            free.retain(|other| *other != robot);
            let _ = orders.push(Order { robot, role, task, why });
        };
        if free.contains(&view.keeper) {
            let (task, why) = defence::keeper(view);
            order(free, view.keeper, Role::Keeper, task, why);
        }
        let Some(ball) = view.ball else { return orders };
        if let Some((robot, seconds)) = self.choose_first(view, &ball, free, barred) {
            let target = self.target(view, robot, &ball);
            let (task, why) = restart::take(view, &ball, Some(target));
            let why = if ball.velocity.norm() > LIES { Why::SoonestAtBall { seconds } } else { why };
            order(free, robot, Role::Player, task, why);
            if let Target::Mate { id, at, room } = target
                && free.contains(&id)
            {
                order(free, id, Role::Receiver, Task::Receive { at, then: None }, Why::BestTarget { room });
            }
        } else {
            self.aim = None;
        }
        let wanted = free.len();
        let places = (self.style.places)(view, &ball, wanted);
        let lawful = |at: Point<Attack>| off_areas(view, off_ball(view, &ball, at));
        let at: heapless::Vec<_, ROBOTS_MAX> =
            places.iter().take(wanted).map(|(at, _, _)| lawful(*at)).collect();
        self.held = roles::assign(view, free, &at, &self.held);
        for (i, robot) in self.held.into_iter().enumerate() {
            if let (Some(robot), Some(at), Some((_, role, why))) = (robot, at.get(i), places.get(i)) {
                let role = if Some(robot) == barred { Role::Barred } else { *role };
                order(free, robot, role, facing(view, *at), *why);
            }
        }
        orders
    }

    /// Who goes for the ball; nobody where only keepers may touch it.
    fn choose_first(
        &mut self,
        view: &View,
        ball: &Ball,
        free: &Free,
        barred: Option<RobotId>,
    ) -> Option<(RobotId, f32)> {
        let forbidden = view.in_their_area(ball.position, 0.0) || view.in_our_area(ball.position, 0.0);
        let able = view.ours.iter().filter(|robot| free.contains(&robot.id) && Some(robot.id) != barred);
        let first = roles::choose(able, self.first, roles::WORTH, |robot| roles::time_to(robot, ball.rest));
        let first = first.filter(|_| !forbidden);
        self.first = first.map(|(id, _)| id);
        first
    }

    /// What the ball is meant for: held for a while, so that whoever walks around the ball does not turn back.
    fn target(&mut self, view: &View, robot: RobotId, ball: &Ball) -> Target {
        match self.aim {
            Some((since, from, target))
                if view.now.since(since) < AIM_STANDS && from.distance(ball.position) < AIM_MOVES =>
            {
                target
            }
            _ => {
                let target = (self.style.target)(view, robot, ball.position);
                self.aim = Some((view.now, ball.position, target));
                target
            }
        }
    }
}

/// The two places before our area, of defenders.
fn defenders(view: &View) -> [Place; 2] {
    let ([first, second], why) = defence::defenders(view);
    [(first, Role::Defender(0), why), (second, Role::Defender(1), why)]
}

/// Free places for a pass from the ball, as many as are wanted.
fn free_places(view: &View, ball: &Ball, wanted: usize) -> impl Iterator<Item = Place> {
    let places = support::places(view, ball.position, wanted);
    (0_u8..).zip(places).map(|(i, (at, worth))| (at, Role::Support(i), Why::FreePlace { worth }))
}

fn facing(view: &View, at: Point<Attack>) -> Task {
    let face = view.ball.map_or(Angle::ZERO, |ball| at.direction_to(ball.position));
    Task::GoTo { at, face }
}

/// Away from the ball that a mate plays: who only helps does not stand in its way.
fn off_ball(view: &View, ball: &Ball, at: Point<Attack>) -> Point<Attack> {
    let away = at - ball.position;
    if away.norm() >= OFF_MATES_BALL {
        return at;
    }
    let out = away.unit().or_else(|| (view.our_goal() - ball.position).unit()).unwrap_or_default();
    ball.position + out * OFF_MATES_BALL
}

/// Out of both areas, straight away from their goal lines' middles, and inside the lines.
fn off_areas(view: &View, at: Point<Attack>) -> Point<Attack> {
    let mut at = view.clamp(at, INSIDE);
    for goal in [view.our_goal(), view.their_goal()] {
        let home = goal.x() < 0.0;
        let inside = |p: Point<Attack>| {
            if home { view.in_our_area(p, defence::EDGE) } else { view.in_their_area(p, OFF_THEIR_AREA) }
        };
        let to_middle = (Point::new(0.0, at.y()) - at).unit().unwrap_or_default();
        while inside(at) {
            at += to_middle * STEP;
        }
    }
    at
}

/// Places that a style gives out: field players of a team of eleven.
const PLACES: usize = 10;
/// A ball slower than this lies, m/s.
const LIES: f32 = 0.25;
/// A target stands for this long, unless the ball moves: to walk around it, aim and kick.
const AIM_STANDS: Duration = Duration::millis(1500);
/// A ball moved by more than this is aimed anew, m.
const AIM_MOVES: f32 = 0.3;
/// Who helps keeps this far from the ball, m: two bodies and room to turn with it.
const OFF_MATES_BALL: f32 = 0.5;
/// Nobody is sent nearer to a line than this, m.
const INSIDE: f32 = 0.15;
/// Centres keep this far off their area, m: the rules' 0.2 m at restarts, a body and what control errs by.
const OFF_THEIR_AREA: f32 = 0.35;
/// Steps out of an area, m.
const STEP: f32 = 0.02;

#[cfg(test)]
mod tests;
