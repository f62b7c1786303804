//! `opponents`: opponent teams as a reference for our play. They share our view, motion, limits, skills,
//! keeper and own restarts, and differ in open play and in how they defend against a free kick; each imitates
//! one property of teams of the league (Biswas et al. 2014 §6).
//!
//! [`Team`] names them. Each is a module: `reactive` runs for the ball and shoots, `marking` marks every
//! opponent, `zone` follows the ball with a wall. Attack frame, m, m/s, s.

mod marking;
mod reactive;
mod zone;

use geometry::{Angle, Attack, Point};
use protocol::{Duration, Instant, RobotId};
use serde::{Deserialize, Serialize};

use super::order::{Order, OrderReason, Role, Task};
use super::support::{self, Target};
use super::view::{ROBOTS_MAX, View, ViewBall};
use super::{Orders, defence, restart, roles};

/// Most places of a style: field players of a team of eleven.
const PLACES_MAX: usize = 10;
/// A ball slower than this counts as stopped, m/s.
const LYING_SPEED_MAX_M_S: f32 = 0.25;
/// A target is kept for this long, unless the ball moves: to move around it, aim and kick.
const AIM_KEPT: Duration = Duration::millis(1500);
/// Distance the ball moves from which a new target is chosen, m.
const AIM_MOVED_M: f32 = 0.3;
/// A supporting robot keeps this far from the ball, m: two bodies and room to turn with it.
const OFF_TEAMMATES_BALL_M: f32 = 0.5;
/// No robot is sent nearer to a line than this, m.
const INSIDE_LINES_M: f32 = 0.15;
/// Centres keep this far off their area, m: the rules' 0.2 m at restarts, a body and the control error.
const OFF_THEIR_AREA_M: f32 = 0.35;
/// Steps out of an area, m.
const AREA_STEP_M: f32 = 0.02;

/// Team whose open play a side plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Team {
    /// Our own play: cases and the coach.
    #[default]
    Ours,
    /// The nearest goes for the ball and shoots or clears, a second backs it up.
    Reactive,
    /// Fast man-to-man defence: every robot stays between an opponent and the own goal.
    Marking,
    /// A wall between ball and goal that follows the ball.
    Zone,
    /// Robots that always stand still: a team that does not score against it cannot score.
    Idle,
}

impl Team {
    /// All teams, ours first.
    pub const ALL: [Self; 5] = [Self::Ours, Self::Reactive, Self::Marking, Self::Zone, Self::Idle];
    /// Those that move and are not ours.
    pub const OPPONENTS: [Self; 3] = [Self::Reactive, Self::Marking, Self::Zone];

    /// Name on command lines and in files.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Reactive => "reactive",
            Self::Marking => "marking",
            Self::Zone => "zone",
            Self::Idle => "idle",
        }
    }

    /// The team of that name.
    pub fn from_label(label: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|team| team.label() == label)
    }
}

/// The open play of one of [`Team::OPPONENTS`], with its state.
#[derive(Clone, Debug)]
pub(super) struct OpponentModel {
    style: Style,
    /// The robot that goes for the ball.
    first: Option<RobotId>,
    /// Target of the ball, since when, from where.
    aim: Option<(Instant, Point<Attack>, Target)>,
    /// Robots that had the style's places, by place.
    held: [Option<RobotId>; PLACES_MAX],
}

/// The functions that distinguish one opponent team from another.
#[derive(Clone, Copy, Debug)]
struct Style {
    /// The target chosen for the robot at the ball.
    target: fn(&View, RobotId, Point<Attack>) -> Target,
    /// Places of the others, most urgent first, while `wanted` of them are free.
    places: fn(&View, &ViewBall, usize) -> Places,
    /// Whether they stand there against a free kick too; else two defend, one is the wall and the others
    /// mark.
    keeps_places_at_free_kicks: bool,
}

/// A place to be taken, its role, and the reason.
pub(super) type Place = (Point<Attack>, Role, OrderReason);
pub(super) type Places = heapless::Vec<Place, ROBOTS_MAX>;
type Free = heapless::Vec<RobotId, ROBOTS_MAX>;

impl OpponentModel {
    /// The state for that team; `None` for those whose open play is not here.
    pub(super) fn of(team: Team) -> Option<Self> {
        let style = match team {
            Team::Reactive => reactive::STYLE,
            Team::Marking => marking::STYLE,
            Team::Zone => zone::STYLE,
            Team::Ours | Team::Idle => return None,
        };
        Some(Self { style, first: None, aim: None, held: [None; PLACES_MAX] })
    }

    /// Orders in open play for those of `free`, which are removed from it; `double_touch_blocked` must not
    /// touch the ball.
    pub(super) fn open_play(
        &mut self,
        view: &View,
        free: &mut Free,
        double_touch_blocked: Option<RobotId>,
    ) -> Orders {
        let mut orders = Orders::new();
        // At most one order per robot, and as many places as robots.
        let mut order = |free: &mut Free, robot: RobotId, role: Role, task: Task, why: OrderReason| {
            free.retain(|other| *other != robot);
            let _ = orders.push(Order { robot, role, task, why });
        };
        if free.contains(&view.keeper) {
            let (task, why) = defence::keeper(view);
            order(free, view.keeper, Role::Keeper, task, why);
        }
        let Some(ball) = view.ball else { return orders };
        if let Some((robot, seconds)) = self.choose_first(view, &ball, free, double_touch_blocked) {
            let target = self.target(view, robot, &ball);
            let (task, why) = restart::take(view, &ball, Some(target));
            let why = if ball.velocity.norm() > LYING_SPEED_MAX_M_S {
                OrderReason::SoonestAtBall { seconds }
            } else {
                why
            };
            order(free, robot, Role::Player, task, why);
            if let Target::Teammate { id, at, room } = target
                && free.contains(&id)
            {
                order(
                    free,
                    id,
                    Role::Receiver,
                    Task::Receive { at, then: None },
                    OrderReason::BestTarget { room },
                );
            }
        } else {
            self.aim = None;
        }
        let wanted = free.len();
        let places = (self.style.places)(view, &ball, wanted);
        let legal = |at: Point<Attack>| off_areas(view, off_ball(view, &ball, at));
        let at: heapless::Vec<_, ROBOTS_MAX> =
            places.iter().take(wanted).map(|(at, _, _)| legal(*at)).collect();
        self.held = roles::assign(view, free, &at, &self.held);
        for (i, robot) in self.held.into_iter().enumerate() {
            if let (Some(robot), Some(at), Some((_, role, why))) = (robot, at.get(i), places.get(i)) {
                let role = if Some(robot) == double_touch_blocked { Role::DoubleTouchBlocked } else { *role };
                order(free, robot, role, facing(view, *at), *why);
            }
        }
        orders
    }

    /// Places of `wanted` robots against a free kick, most urgent first; `None`: as all teams do.
    pub(super) fn against_free_kick(&self, view: &View, ball: &ViewBall, wanted: usize) -> Option<Places> {
        let mut places =
            self.style.keeps_places_at_free_kicks.then(|| (self.style.places)(view, ball, wanted))?;
        for (at, _, _) in &mut places {
            *at = off_areas(view, *at);
        }
        Some(places)
    }

    /// The robot that goes for the ball; none where only keepers may touch it.
    fn choose_first(
        &mut self,
        view: &View,
        ball: &ViewBall,
        free: &Free,
        double_touch_blocked: Option<RobotId>,
    ) -> Option<(RobotId, f32)> {
        let forbidden = view.in_their_area(ball.position, 0.0) || view.in_our_area(ball.position, 0.0);
        let able = view
            .ours
            .iter()
            .filter(|robot| free.contains(&robot.id) && Some(robot.id) != double_touch_blocked);
        let first = roles::choose(able, self.first, roles::WORTH, |robot| roles::time_to(robot, ball.rest));
        let first = first.filter(|_| !forbidden);
        self.first = first.map(|(id, _)| id);
        first
    }

    /// The ball's target: held for a while, so that a robot that moves around the ball does not turn back.
    fn target(&mut self, view: &View, robot: RobotId, ball: &ViewBall) -> Target {
        match self.aim {
            Some((since, from, target))
                if view.now.since(since) < AIM_KEPT && from.distance(ball.position) < AIM_MOVED_M =>
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

/// Free places for a pass from the ball, at most `wanted` of them.
fn free_places(view: &View, ball: &ViewBall, wanted: usize) -> impl Iterator<Item = Place> {
    let places = support::places(view, ball.position, wanted);
    (0_u8..).zip(places).map(|(i, (at, worth))| (at, Role::Support(i), OrderReason::FreePlace { worth }))
}

fn facing(view: &View, at: Point<Attack>) -> Task {
    let face = view.ball.map_or(Angle::ZERO, |ball| at.direction_to(ball.position));
    Task::GoTo { at, face }
}

/// Away from the ball that a teammate plays: a supporting robot does not obstruct it.
fn off_ball(view: &View, ball: &ViewBall, at: Point<Attack>) -> Point<Attack> {
    let away = at - ball.position;
    if away.norm() >= OFF_TEAMMATES_BALL_M {
        return at;
    }
    let out = away.unit().or_else(|| (view.our_goal() - ball.position).unit()).unwrap_or_default();
    ball.position + out * OFF_TEAMMATES_BALL_M
}

/// Out of both areas, straight away from their goal lines' middles, and inside the lines.
fn off_areas(view: &View, at: Point<Attack>) -> Point<Attack> {
    let mut at = view.clamp(at, INSIDE_LINES_M);
    for goal in [view.our_goal(), view.their_goal()] {
        let home = goal.x() < 0.0;
        let inside = |p: Point<Attack>| {
            if home { view.in_our_area(p, defence::EDGE) } else { view.in_their_area(p, OFF_THEIR_AREA_M) }
        };
        let to_middle = (Point::new(0.0, at.y()) - at).unit().unwrap_or_default();
        while inside(at) {
            at += to_middle * AREA_STEP_M;
        }
    }
    at
}

#[cfg(test)]
mod tests;
