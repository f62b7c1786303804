//! `script`: the scripted opponents of the drills. They see the truth and drive their bodies without a brain
//! of ours, so that a better skill of ours does not make a better opponent. m, m/s, rad; they attack −x.

use geometry::{Angle, Field, Point, Pose, Twist, Vector};
use hil_sim::small_size::{Drive, KickCommand, Order, Robot, World};
use motion::ball::BallModel;
use protocol::{RobotId, Who};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{Colour, Phase};

use super::DrillKind;
use super::start::{BALL_AHEAD_M, DrillStart, OUR_END, off_area};

/// Colour of the scripted team.
pub(super) const THEM: Colour = Colour::Yellow;
/// Our colour.
pub(super) const US: Colour = Colour::Blue;

#[derive(Clone, Debug)]
pub(super) struct Script {
    drill: DrillKind,
    start: DrillStart,
    /// Side to which the carrier goes first, ±1, along y.
    side: f32,
    /// Time at which the ball came into play, s.
    began_s: Option<f64>,
    /// Offset of each marker from the one of ours that it follows.
    follows: Vec<Option<(Who, Vector<Field>)>>,
    /// Whether the ball has been played by another robot than the lead since the beginning.
    loose: bool,
    /// Time at which their free kick was given, s.
    given_s: Option<f64>,
    kicked: bool,
}

/// Motion wanted of a robot.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    at: Point<Field>,
    face: Angle,
    speed: f32,
    kick: Option<f32>,
    dribbler: f32,
}

impl Wanted {
    fn go(at: Point<Field>, face: Angle) -> Self {
        Self { at, face, speed: SPEED_M_S, kick: None, dribbler: 0.0 }
    }
}

impl Script {
    pub(super) fn new(drill: DrillKind, start: &DrillStart) -> Self {
        let keepers_side = start.ours[0].position.y();
        let lead = start.theirs[start.lead].position;
        Self {
            drill,
            // Away from our keeper.
            side: if lead.y() >= keepers_side { 1.0 } else { -1.0 },
            began_s: None,
            follows: follows(drill, start),
            loose: matches!(drill, DrillKind::Rebound | DrillKind::GoalLine | DrillKind::Contested),
            given_s: None,
            kicked: false,
            start: start.clone(),
        }
    }

    /// Orders for all of theirs, every 10 ms.
    pub(super) fn orders(&mut self, world: &World, phase: Phase<Colour>) -> Vec<(Who, Order)> {
        let now = world.time();
        if phase == Phase::FreeKick(THEM) {
            self.given_s.get_or_insert(now);
        }
        if phase == Phase::Run {
            self.began_s.get_or_insert(now);
        }
        if world.last_touch().is_some_and(|(who, _)| who != them(self.start.lead)) && phase == Phase::Run {
            self.loose = true;
        }
        let chaser = if self.loose && phase == Phase::Run { self.chaser(world) } else { None };
        (0..self.start.theirs.len())
            .filter_map(|number| {
                let who = them(number);
                let robot = world.robot(who).filter(|robot| robot.present)?;
                let wanted = self.wanted(world, phase, number, robot, chaser);
                Some((who, order(robot, wanted)))
            })
            .collect()
    }

    fn wanted(
        &mut self,
        world: &World,
        phase: Phase<Colour>,
        number: usize,
        robot: &Robot,
        chaser: Option<usize>,
    ) -> Wanted {
        let lead = number == self.start.lead;
        let shooter = self.start.shooter.filter(|(shooter, _)| *shooter == number);
        match phase {
            Phase::Run if chaser == Some(number) => chase(world, robot),
            Phase::Run if lead && !self.loose => match self.drill {
                DrillKind::Carrier => self.carry(world, robot),
                DrillKind::Shielder => self.shield(world, robot),
                _ => self.hold(world, number, robot),
            },
            Phase::Run | Phase::FreeKick(THEM) if shooter.is_some() => {
                let at = shooter.map_or(robot.pose.position, |(_, at)| at);
                self.shoot_first(world, robot, at)
            }
            Phase::FreeKick(THEM) if lead => self.take_free_kick(world, robot),
            Phase::Stop | Phase::FreeKick(US) if lead && self.drill == DrillKind::Marker => {
                step_into_line(world, robot)
            }
            _ => self.hold(world, number, robot),
        }
    }

    /// Stands where it was, or follows the one of ours that it marks, outside our area.
    fn hold(&self, world: &World, number: usize, robot: &Robot) -> Wanted {
        let face = robot.pose.position.direction_to(world.ball.position);
        let marked =
            self.follows[number].and_then(|(who, offset)| Some(world.robot(who)?.pose.position + offset));
        let at = marked.unwrap_or(self.start.theirs[number].position);
        let field = &world.pitch().field;
        let off = off_area(field, at, AREA_OFF_M);
        let to = off_ball(world, off, RESTART_OFF_M);
        // It pushes none of ours out of its way.
        let me = robot.pose.position;
        let blocked =
            world.robots().iter().filter(|other| other.present && other.who.colour == US).any(|other| {
                let away = other.pose.position - me;
                away.norm() < PUSHES_WITHIN_M && away.dot(to - me) > 0.0
            });
        Wanted::go(if blocked { me } else { to }, face)
    }

    /// To and fro along our area with the ball, and a shot as soon as the goal is open.
    fn carry(&self, world: &World, robot: &Robot) -> Wanted {
        let field = &world.pitch().field;
        let gap = gap(world, world.ball.position);
        let face = robot.pose.position.direction_to(gap.aim);
        if !robot.ball_contact {
            return take_ball(world, robot);
        }
        let carried = robot.pose.position.distance(self.start.theirs[self.start.lead].position);
        let held_s = self.began_s.map_or(0.0, |began| (world.time() - began) as f32);
        let aimed = (face - robot.pose.heading).abs() < AIMED_RAD;
        let opens = gap.angle > OPEN_DEG.to_radians();
        let shoots = opens || carried > CARRIES_MAX_M || held_s > CARRIES_FOR_S;
        let goal = field.goal_center(OUR_END);
        let out = (robot.pose.position - goal).unit().unwrap_or(Vector::new(1.0, 0.0));
        let along = out.rotated(Angle::new(self.side_after(held_s) * std::f32::consts::FRAC_PI_2));
        let at = off_area(field, robot.pose.position + along * 0.5, BALL_AHEAD_M + 0.1);
        Wanted {
            at: if shoots { robot.pose.position } else { at },
            face,
            speed: SIDEWAYS_M_S,
            kick: (shoots && aimed).then_some(SHOT_M_S),
            dribbler: 1.0,
        }
    }

    /// Side to which the carrier goes after `held_s` seconds, ±1.
    fn side_after(&self, held_s: f32) -> f32 {
        let mut turns_s = 0.0;
        let mut side = self.side;
        for leg_s in &self.start.legs_s {
            turns_s += leg_s;
            if held_s < turns_s {
                break;
            }
            side = -side;
        }
        side
    }

    /// Keeps the ball at its front with its back to the nearest of ours, and moves away from it, as far as
    /// the rules let it dribble.
    fn shield(&self, world: &World, robot: &Robot) -> Wanted {
        let field = &world.pitch().field;
        if !robot.ball_contact {
            return take_ball(world, robot);
        }
        let me = robot.pose.position;
        let ours = world.robots().iter().filter(|robot| robot.present && robot.who.colour == US);
        let places = ours.map(|robot| robot.pose.position);
        let threat = places.min_by(|a, b| a.distance(me).total_cmp(&b.distance(me)));
        let away = threat.map_or(robot.pose.heading, |threat| threat.direction_to(me));
        let from = self.start.theirs[self.start.lead].position;
        let wanted = me + Vector::polar(0.3, away);
        let within = from + (wanted - from).clamped(SHIELDS_WITHIN_M);
        let at = off_area(field, within, BALL_AHEAD_M + 0.1);
        Wanted { at, face: away, speed: CARRY_SPEED_M_S, kick: None, dribbler: 1.0 }
    }

    /// Behind the ball until the free kick's time has come, then a cross to the shooter's place.
    fn take_free_kick(&mut self, world: &World, robot: &Robot) -> Wanted {
        let ball = world.ball.position;
        let at = self.start.shooter.map_or(ball, |(_, at)| at);
        let face = ball.direction_to(at);
        let waits = self.given_s.is_none_or(|given| world.time() < given + CROSS_AFTER_S);
        let back = if waits { WAITS_BACK_M } else { BALL_AHEAD_M - 0.01 };
        let speed = BallModel::default().kick_speed(ball.distance(at), ARRIVAL_M_S);
        let aimed = (face - robot.pose.heading).abs() < AIMED_RAD;
        self.kicked |= robot.kicked().is_some_and(|(step, _)| step + 300 > world.now());
        Wanted {
            at: ball - Vector::polar(back, face),
            face,
            speed: 0.8,
            kick: (!waits && aimed).then_some(speed),
            dribbler: 0.0,
        }
    }

    /// To where the cross comes, turned to the goal's gap so that the ball crosses its front: a first-touch
    /// shot. Before the kick it waits where it stood.
    fn shoot_first(&self, world: &World, robot: &Robot, at: Point<Field>) -> Wanted {
        let field = &world.pitch().field;
        if !self.kicked && world.ball.speed() < COMING_M_S {
            let face = robot.pose.position.direction_to(world.ball.position);
            return Wanted::go(off_area(field, robot.pose.position, AREA_OFF_M), face);
        }
        let (ball, velocity) = (world.ball.position, world.ball.velocity);
        let Some(along) = velocity.unit().filter(|_| velocity.norm() > COMING_M_S) else {
            return take_ball(world, robot);
        };
        let passes = ball + along * (at - ball).dot(along).max(0.0);
        let aim = gap(world, passes).aim;
        let face = passes.direction_to(aim);
        let left = passes.distance(ball);
        Wanted {
            at: off_area(field, passes - Vector::polar(BALL_AHEAD_M + 0.003, face), 0.02),
            face,
            speed: SPEED_M_S,
            kick: (left < 0.6).then_some(SHOT_M_S),
            dribbler: 0.0,
        }
    }

    /// The one of theirs that is soonest at the ball, if it may be played where it lies.
    fn chaser(&self, world: &World) -> Option<usize> {
        let field = &world.pitch().field;
        let ball = BallModel::default().rolling(world.ball.position, world.ball.velocity).rest();
        let near = world.ball.position;
        if field.distance_to_area(OUR_END, near) < BALL_RADIUS {
            return None;
        }
        let lead_may_not = matches!(self.start.opening, super::start::Opening::TheirFreeKick);
        let touched_by_lead = world.last_touch().is_some_and(|(who, _)| who == them(self.start.lead));
        let able = (0..self.start.theirs.len())
            .filter(|number| !(lead_may_not && touched_by_lead && *number == self.start.lead));
        able.filter_map(|number| {
            let at = world.robot(them(number)).filter(|robot| robot.present)?.pose.position;
            Some((number, at.distance(ball).min(at.distance(near))))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(number, _)| number)
    }
}

/// Which of theirs follow whom: those that stood near one of ours.
fn follows(drill: DrillKind, start: &DrillStart) -> Vec<Option<(Who, Vector<Field>)>> {
    let lead_and_shooter =
        |number| number == start.lead || start.shooter.is_some_and(|(shooter, _)| shooter == number);
    let mut taken = vec![false; start.ours.len()];
    let follow = |(number, pose): (usize, &Pose<Field>)| {
        if lead_and_shooter(number) || !matches!(drill, DrillKind::Marker | DrillKind::Contested) {
            return None;
        }
        let others = start.ours.iter().enumerate().skip(1).filter(|(ours, _)| !taken[*ours]);
        let (ours, offset) = others
            .map(|(ours, marked)| (ours, pose.position - marked.position))
            .min_by(|a, b| a.1.norm().total_cmp(&b.1.norm()))
            .filter(|(_, offset)| offset.norm() < MARKS_WITHIN_M)?;
        taken[ours] = true;
        let who = Who { colour: US, id: id(ours) };
        Some((who, offset.clamped(MARKS_AT_M)))
    };
    start.theirs.iter().enumerate().map(follow).collect()
}

/// Onto the line on which our kicker lines up, off the ball as the rules ask.
fn step_into_line(world: &World, robot: &Robot) -> Wanted {
    let field = &world.pitch().field;
    let ball = world.ball.position;
    let ours = world.robots().iter().filter(|robot| robot.present && robot.who.colour == US);
    let near = ours.map(|robot| (robot, robot.pose.position.distance(ball)));
    let kicker = near.min_by(|a, b| a.1.total_cmp(&b.1));
    let lined_up = kicker.filter(|(_, distance)| *distance < LINED_UP_WITHIN_M).map(|(kicker, _)| kicker);
    let towards = lined_up.map_or(ball.direction_to(robot.pose.position), |kicker| {
        // As its heading goes, once it is near the ball.
        kicker.pose.heading
    });
    let at = off_area(field, ball + Vector::polar(MARKER_AT_M, towards), AREA_OFF_M);
    Wanted { speed: 1.4, ..Wanted::go(off_ball(world, at, RESTART_OFF_M), towards + Angle::HALF_TURN) }
}

/// To a loose ball, and with it a shot at the largest gap.
fn chase(world: &World, robot: &Robot) -> Wanted {
    if !robot.ball_contact {
        return take_ball(world, robot);
    }
    let aim = gap(world, world.ball.position).aim;
    let face = robot.pose.position.direction_to(aim);
    let aimed = (face - robot.pose.heading).abs() < AIMED_RAD;
    Wanted {
        at: robot.pose.position,
        face,
        speed: CARRY_SPEED_M_S,
        kick: aimed.then_some(SHOT_M_S),
        dribbler: 1.0,
    }
}

/// To the ball, front first, to where the robot can meet it.
fn take_ball(world: &World, robot: &Robot) -> Wanted {
    let me = robot.pose.position;
    let path = BallModel::default().rolling(world.ball.position, world.ball.velocity);
    let along = world.ball.velocity.unit().unwrap_or_default();
    let mut meet = path.rest();
    for step in 0..MEETS_STEPS {
        let time = step as f32 * MEETS_STEP_S;
        let at = world.ball.position + along * path.progress(time).0;
        if me.distance(at) - BALL_AHEAD_M < SPEED_M_S * (time - 0.15).max(0.0) {
            meet = at;
            break;
        }
    }
    let face = me.direction_to(meet);
    let at = meet - Vector::polar(BALL_AHEAD_M - 0.005, face);
    let field = &world.pitch().field;
    Wanted { dribbler: 1.0, ..Wanted::go(off_area(field, at, 0.1), face) }
}

/// The widest open part of our goal from a place.
struct Gap {
    aim: Point<Field>,
    /// Its angle, rad.
    angle: f32,
}

fn gap(world: &World, from: Point<Field>) -> Gap {
    let field = &world.pitch().field;
    let line = field.goal_line(OUR_END);
    let half = 0.5 * field.goal_width - BALL_RADIUS;
    let step = 2.0 * half / (AIMS - 1) as f32;
    let (mut best, mut run) = ((0_usize, 0_usize), 0_usize);
    for number in 0..AIMS {
        run = if is_open(world, from, Point::new(line, -half + number as f32 * step)) { run + 1 } else { 0 };
        if run > best.1 {
            best = (number, run);
        }
    }
    if best.1 == 0 {
        return Gap { aim: Point::new(line, 0.0), angle: 0.0 };
    }
    let (first, last) = ((best.0 + 1 - best.1) as f32, best.0 as f32);
    let [low, aim, high] =
        [first, 0.5 * (first + last), last].map(|number| Point::new(line, -half + number * step));
    Gap { aim, angle: (from.direction_to(low) - from.direction_to(high)).abs() }
}

/// Whether none of ours stands in a ball's way.
fn is_open(world: &World, from: Point<Field>, aim: Point<Field>) -> bool {
    let way = geometry::Segment::new(from, aim);
    let ours = world.robots().iter().filter(|robot| robot.present && robot.who.colour == US);
    ours.map(|robot| way.distance_to(robot.pose.position)).all(|off| off > ROBOT_RADIUS + BALL_RADIUS)
}

fn off_ball(world: &World, at: Point<Field>, distance: f32) -> Point<Field> {
    let ball = world.ball.position;
    let away = at - ball;
    if away.norm() >= distance { at } else { ball + away.unit().unwrap_or(Vector::new(1.0, 0.0)) * distance }
}

/// The order that moves a robot there, by its own limits.
fn order(robot: &Robot, wanted: Wanted) -> Order {
    let way = wanted.at - robot.pose.position;
    let distance = way.norm();
    let fastest = wanted.speed.min((2.0 * BRAKE_M_S2 * distance).sqrt());
    let to = way.unit().unwrap_or_default() * fastest;
    // No faster change than the champions' robots make.
    let change = (to - robot.velocity).clamped(ACCELERATION_M_S2 * TICKS_AHEAD_S);
    let off = (wanted.face - robot.pose.heading).radians();
    let turn_max =
        if wanted.dribbler > 0.0 && robot.ball_contact { TURN_WITH_BALL_RAD_S } else { TURN_RAD_S };
    let angular = (off * TURN_GAIN).clamp(-turn_max, turn_max);
    Order {
        drive: Drive::Global(Twist { linear: robot.velocity + change, angular }),
        kick: wanted.kick.map(|speed| KickCommand { speed, angle: 0.0 }),
        dribbler: wanted.dribbler,
        discharge: false,
    }
}

pub(super) fn them(number: usize) -> Who {
    Who { colour: THEM, id: id(number) }
}

/// The id of that number; starts have at most 16 robots a team.
pub(super) fn id(number: usize) -> RobotId {
    RobotId::all().nth(number).unwrap_or(RobotId::ZERO)
}

/// Limits as the champions' team ships them for simulation: m/s, m/s².
const SPEED_M_S: f32 = 3.0;
const ACCELERATION_M_S2: f32 = 3.0;
const BRAKE_M_S2: f32 = 3.0;
/// An order may change the velocity by what these seconds of acceleration do.
const TICKS_AHEAD_S: f32 = 0.04;
/// Turning, rad/s, freely and with the ball; and rate by error, 1/s.
const TURN_RAD_S: f32 = 10.0;
const TURN_WITH_BALL_RAD_S: f32 = 4.0;
const TURN_GAIN: f32 = 8.0;
/// Speed with the ball, m/s.
const CARRY_SPEED_M_S: f32 = 0.8;
/// Speed along our area with the ball, m/s: carriers of the recorded situations reach 0.9 to 1.1.
const SIDEWAYS_M_S: f32 = 1.0;
/// It shoots at the latest after this time, s: their longest hold before a goal.
const CARRIES_FOR_S: f32 = 2.5;
/// A carrier shoots at the latest after this way, m: the rules' 1 m less what the ball rolls.
const CARRIES_MAX_M: f32 = 0.8;
/// A shielder stays this near to where it began, m.
const SHIELDS_WITHIN_M: f32 = 0.35;
/// Open angle at which it shoots, degrees: the least with which goals fell.
const OPEN_DEG: f32 = 8.0;
/// Heading error of a shot, rad.
const AIMED_RAD: f32 = 0.05;
/// Speed of shots, m/s.
const SHOT_M_S: f32 = 5.0;
/// Their free kick leaves this long after it was given, s: the champions' median.
const CROSS_AFTER_S: f64 = 4.2;
/// Speed of the cross where it is shot, m/s.
const ARRIVAL_M_S: f32 = 2.2;
/// A ball faster than this has been kicked, m/s.
const COMING_M_S: f32 = 0.5;
/// Distance of their kicker behind the ball while it waits, m.
const WAITS_BACK_M: f32 = 0.2;
/// A robot of ours this near the ball lines up for the kick, m.
const LINED_UP_WITHIN_M: f32 = 0.4;
/// Distance of the marker from our free kick, m.
const MARKER_AT_M: f32 = 0.7;
/// Distance from the ball at restarts, m.
const RESTART_OFF_M: f32 = 0.6;
/// A robot of ours this near in its way stops one that marks, m: two radii and its way to a stop.
const PUSHES_WITHIN_M: f32 = 0.3;
/// Distance of centres from our area, m.
const AREA_OFF_M: f32 = 0.12;
/// One of theirs this near one of ours marks it, m; from then on at most this far off, m.
const MARKS_WITHIN_M: f32 = 2.0;
const MARKS_AT_M: f32 = 0.5;
/// Steps in which a meeting with the ball is looked for.
const MEETS_STEPS: usize = 50;
const MEETS_STEP_S: f32 = 0.04;
/// Aims along the goal line.
const AIMS: usize = 41;
