//! `at_ball`: how our robots (blue) handle the ball in play: balls that lie beside them, times to contact and
//! to the kick, changes of the chosen pass, hidden balls. From the true world and the host's. s, m.

use arena::game::Game;
use geometry::{Attack, GoalEnd, Vector};
use hil_sim::small_size::PhysicsEvent;
use host::strategy::{Flip, Task};
use protocol::{Duration, RobotId, Who};
use rules::{Colour, Phase};

/// A slower ball lies, m/s.
const LIES_M_S: f32 = 0.3;
/// A robot whose centre is this near is at the ball, m.
const NEAR_M: f32 = 0.25;
/// A ball that lies beside a robot for longer is left, s.
const LEFT_AFTER_S: f64 = 1.2;
/// A robot that moves or turns faster carries the ball that it touches, or shields it, m/s and rad/s.
const CARRIES_M_S: f32 = 0.1;
const CARRIES_RAD_S: f32 = 0.5;
/// A pass whose direction changes by more is another one, rad: 3°.
const SAME_WITHIN_RAD: f32 = 0.052;
/// A robot that faces the direction of its kick within this is aimed, rad: 15°.
const AIMED_WITHIN_RAD: f32 = 0.26;
/// Time unseen from which a ball is hidden.
const HIDDEN_AFTER: Duration = Duration::millis(600);
/// A hidden ball farther from where it is believed is lost, m.
const LOST_BEYOND_M: f32 = 0.4;
/// One tick, s.
const TICK_S: f64 = arena::game::TICK_US as f64 * 1e-6;

/// What was seen in a match.
#[derive(Clone, Debug, Default)]
pub(super) struct AtBall {
    /// Time in play, with a ball that lies with our kicker's pass ordered, with a left ball, s.
    running: f64,
    ordered: f64,
    left: f64,
    /// Times from near the ball to contact, s.
    approaches: Vec<f64>,
    /// Times from contact to the kick of robots that were ordered to kick at contact, s.
    releases: Vec<(Aim, f64)>,
    /// Changes of receiver or direction while the ball lies.
    changes: u32,
    /// Hidden spells, and those at whose end the belief was lost.
    hidden: u32,
    lost: u32,
    /// Since when a ball lies beside one of ours, which does not carry it.
    beside_since: Option<f64>,
    /// Since when ours is near a ball that lies, and whether it has touched it.
    near: Option<(f64, bool)>,
    /// Robot of ours that was ordered to kick when it touched the ball.
    contact: Option<Contact>,
    /// Passer, receiver and direction of the pass that is ordered.
    pass: Option<(RobotId, RobotId, Vector<Attack>)>,
    /// How far off a ball hidden for long enough was believed last, m; infinite: nowhere.
    believed: Option<f32>,
}

/// A robot with the ball, from contact to its kick.
#[derive(Clone, Copy, Debug)]
struct Contact {
    who: Who,
    at_s: f64,
    aim: Aim,
    /// Direction of the kick that was ordered last.
    way: Vector<Attack>,
}

/// How a robot comes to face the direction of its kick.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    /// It did at contact.
    AtContact,
    /// It turned after contact.
    Turned,
    /// Another direction was ordered after contact.
    Changed,
}

impl AtBall {
    pub(super) fn look(&mut self, game: &Game<'_>) {
        if game.referee().phase() != Phase::Run {
            (self.beside_since, self.near, self.contact) = (None, None, None);
            (self.pass, self.believed) = (None, None);
            return;
        }
        self.running += TICK_S;
        self.look_at_touches(game);
        self.look_at_pass(game);
        self.look_at_hidden(game);
    }

    fn look_at_touches(&mut self, game: &Game<'_>) {
        let (now, world) = (game.time(), game.world());
        let ball = &world.ball;
        let ours = world.robots().iter().filter(|robot| robot.who.colour == Colour::Blue && robot.present);
        let nearest = ours.min_by(|a, b| {
            let off = |robot: &hil_sim::small_size::Robot| robot.pose.position.distance(ball.position);
            off(a).total_cmp(&off(b))
        });
        let Some(robot) = nearest else { return };
        let near = robot.pose.position.distance(ball.position) < NEAR_M;
        let lies = ball.velocity.norm() < LIES_M_S;
        let carries =
            robot.touching && (robot.velocity.norm() > CARRIES_M_S || robot.turning.abs() > CARRIES_RAD_S);
        self.count_left(now, near && lies && !carries);
        self.near = (near && lies).then_some(self.near.unwrap_or((now, false)));
        let at_ball = |who: Who| {
            let robots = world.robots().iter().filter(|robot| robot.who == who);
            robots.map(|robot| robot.pose.position.distance(ball.position)).any(|off| off < NEAR_M)
        };
        // A kicked ball has left before its event is read.
        let kicked = game.events().iter().any(|event| matches!(event, PhysicsEvent::Kicked { .. }));
        self.contact = self.contact.filter(|contact| kicked || at_ball(contact.who));
        if let Some(contact) = &mut self.contact
            && let Some((_, way)) = kick_of(game, contact.who)
        {
            if way.dot(contact.way) < SAME_WITHIN_RAD.cos() {
                contact.aim = Aim::Changed;
            }
            contact.way = way;
        }
        for event in game.events() {
            match *event {
                PhysicsEvent::Touched { robot, .. } => {
                    if let Some((since, touched)) = &mut self.near
                        && robot.colour == Colour::Blue
                        && !std::mem::replace(touched, true)
                    {
                        self.approaches.push(now - *since);
                    }
                    if self.contact.is_none_or(|contact| contact.who != robot) {
                        self.contact = kick_of(game, robot).map(|(ahead, way)| {
                            let aimed = ahead.dot(way) > AIMED_WITHIN_RAD.cos();
                            let aim = if aimed { Aim::AtContact } else { Aim::Turned };
                            Contact { who: robot, at_s: now, aim, way }
                        });
                    }
                }
                PhysicsEvent::Kicked { robot, .. } => {
                    let contact = self.contact.take().filter(|contact| contact.who == robot);
                    self.releases.extend(contact.map(|contact| (contact.aim, now - contact.at_s)));
                }
                _ => {}
            }
        }
    }

    fn count_left(&mut self, now: f64, beside: bool) {
        if !beside {
            self.beside_since = None;
            return;
        }
        let lasts = now - *self.beside_since.get_or_insert(now);
        if lasts >= LEFT_AFTER_S {
            // The spell counts from its start.
            self.left += if lasts < LEFT_AFTER_S + TICK_S { LEFT_AFTER_S } else { TICK_S };
        }
    }

    fn look_at_pass(&mut self, game: &Game<'_>) {
        let host = game.host(Colour::Blue);
        let seen = host.world().ball.filter(|ball| ball.velocity.norm() < LIES_M_S);
        let pass = host.orders().iter().find_map(|order| match order.task {
            Task::Pass { at, receiver, .. } => Some((order.robot, receiver, at)),
            _ => None,
        });
        let (Some(ball), Some((who, receiver, at))) = (seen, pass) else {
            self.pass = None;
            return;
        };
        self.ordered += TICK_S;
        let Some(way) = (at - flip_of(game).point(ball.position)).unit() else { return };
        if let Some((passer, to, before)) = self.pass
            && passer == who
            && (to != receiver || way.dot(before) < SAME_WITHIN_RAD.cos())
        {
            self.changes += 1;
        } else if self.pass.is_some_and(|(passer, ..)| passer == who) {
            return;
        }
        self.pass = Some((who, receiver, way));
    }

    fn look_at_hidden(&mut self, game: &Game<'_>) {
        let truth = game.world().ball.position;
        let believed = game.host(Colour::Blue).world().ball;
        let hidden = believed.is_none_or(|ball| game.now().since(ball.seen) >= HIDDEN_AFTER);
        if hidden {
            self.believed = Some(believed.map_or(f32::INFINITY, |ball| ball.position.distance(truth)));
        } else if let Some(off) = self.believed.take() {
            self.hidden += 1;
            self.lost += u32::from(off > LOST_BEYOND_M);
        }
    }
}

/// Heading of that robot of ours, and direction of the kick or pass that our host has ordered it.
fn kick_of(game: &Game<'_>, who: Who) -> Option<(Vector<Attack>, Vector<Attack>)> {
    let mut orders = game.host(Colour::Blue).orders().iter();
    let order = orders.find(|order| who.colour == Colour::Blue && order.robot == who.id)?;
    let (Task::Kick { at, .. } | Task::Pass { at, ready: true, .. }) = order.task else { return None };
    let robot = game.world().robots().iter().find(|robot| robot.who == who)?;
    let flip = flip_of(game);
    let ahead = flip.vector(Vector::polar(1.0, robot.pose.heading));
    Some((ahead, (at - flip.point(robot.pose.position)).unit()?))
}

/// From the field to our host's attack frame.
fn flip_of(game: &Game<'_>) -> Flip {
    let goal = game.host(Colour::Blue).game().own_goal(Colour::Blue);
    Flip::defending(goal.unwrap_or(GoalEnd::Negative))
}

/// Prints the sums of all matches.
pub(super) fn print<'a>(matches: impl Iterator<Item = &'a AtBall>) {
    let mut sum = AtBall::default();
    for one in matches {
        sum.running += one.running;
        sum.ordered += one.ordered;
        sum.left += one.left;
        sum.approaches.extend(&one.approaches);
        sum.releases.extend(&one.releases);
        sum.changes += one.changes;
        sum.hidden += one.hidden;
        sum.lost += one.lost;
    }
    let quantile = |values: &mut Vec<f64>, share: f64| {
        values.sort_unstable_by(f64::total_cmp);
        values.get((share * values.len().saturating_sub(1) as f64) as usize).copied().unwrap_or(f64::NAN)
    };
    println!(
        "at the ball: left for {:.1} % of {:.0} s in play; from {NEAR_M} m to contact {:.2} s in the median",
        100.0 * sum.left / sum.running.max(TICK_S),
        sum.running,
        quantile(&mut sum.approaches, 0.5),
    );
    let kinds = [
        ("", None),
        (", aimed at contact", Some(Aim::AtContact)),
        (", turned after contact", Some(Aim::Turned)),
        (", another direction ordered after contact", Some(Aim::Changed)),
    ];
    for (name, aim) in kinds {
        let kept = sum.releases.iter().filter(|(of, _)| aim.is_none_or(|aim| aim == *of));
        let mut after: Vec<f64> = kept.map(|(_, after)| *after).collect();
        let (median, most) = (quantile(&mut after, 0.5), quantile(&mut after, 0.9));
        println!(
            "from contact to the kick{name}: median {median:.2} s, 90 % {most:.2} s ({} kicks)",
            after.len()
        );
    }
    println!(
        "passes: {} changes in {:.0} s ({:.2} a second); hidden for 0.6 s: {} times, lost {} ({:.1} %)",
        sum.changes,
        sum.ordered,
        f64::from(sum.changes) / sum.ordered.max(TICK_S),
        sum.hidden,
        sum.lost,
        100.0 * f64::from(sum.lost) / f64::from(sum.hidden.max(1))
    );
}
