//! `hidden`: position of a ball that no camera sees: under a robot, or where it was placed; field frame, SI.
//!
//! With one of our robots, it is at the robot whose sensor detects it, and after release beside where that
//! robot detected it last; of several such robots at the nearest, and at none that it cannot have reached: a
//! stuck sensor on the other side of the field does not move it there. With theirs, at the one whose front
//! was at it when it vanished. Tracking leaves a ball that vanished at a robot's front there; where that
//! robot is ours and its sensor does not detect the ball, the opponent beside it has taken it, or it lies
//! where it was last seen; where it is theirs and a robot of ours beside it, or beside the place where it
//! vanished, detects the ball, ours has it. At a restart after a placement it lies where it was placed: the
//! robot that brought it there hid it on the path, and the last visible place is metres off. Else it lies at
//! its stop position. Without this a robot that must keep off the ball would approach it as soon as it is
//! hidden, and one that backs off a ball it hides would search it elsewhere.

use geometry::{Field, Point, Vector};
use protocol::{Duration, Instant, RobotId, Who};
use rules::{Colour, Phase};

use crate::referee::Game;
use crate::world::{Ball, Robot, World};

/// A ball this near the middle of a robot's front may lie in its dribbler opening, m: the opening's half
/// width and the vision's noise.
const HIDES_WITHIN_M: f32 = 0.06;
/// A ball this far beside the middle of a front is not in the opening, m: a ball's diameter.
const BESIDE_M: f32 = 2.0 * rules::limits::BALL_RADIUS;
/// A break-beam sensor detects a ball that is this near to the front, m: `barrier` of the simulator's
/// division B (estimate).
const FELT_WITHIN_M: f32 = 0.015;
/// Time unseen after which a robot's sensor decides whether it has the ball: two telemetry periods, and
/// vision's delay.
const SENSOR_DECIDES_AFTER: Duration = Duration::millis(300);
/// Time unseen after which the ball is hidden: a frame of slow cameras, and vision's delay.
const HIDDEN_AFTER: Duration = Duration::millis(60);
/// A robot's front is this near a ball that it takes off another team's, m: a robot's diameter.
const TAKES_WITHIN_M: f32 = 2.0 * rules::limits::ROBOT_RADIUS;
/// No ball moves faster, m/s: the rules' limit of a kick, 6.5 m/s, and 0.5 m/s by which kickers err.
const BALL_SPEED_MAX_M_S: f32 = 7.0;

/// The ball's last visible state, and its placement.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HiddenBall {
    /// The ball as it was when last seen, or detected by a sensor of ours since.
    last: Option<Ball>,
    /// Where cameras last saw it.
    vanished: Option<Point<Field>>,
    /// When one of our sensors last detected it.
    felt: Option<Instant>,
    /// The opponent that hides it from all cameras, if one does.
    by: Option<Who>,
    /// Place where it was put for the restart that is to come.
    placed: Option<Point<Field>>,
}

impl HiddenBall {
    /// Puts a ball into a world without one, for the team `us`; `feels` returns whether one of its robots has
    /// the ball, `None` where it has not reported lately.
    pub(crate) fn fill(
        &mut self,
        now: Instant,
        world: &mut World,
        us: Colour,
        game: &Game,
        feels: impl Fn(RobotId) -> Option<bool>,
    ) {
        match game.phase {
            Phase::BallPlacement(_) => self.placed = game.placement.or(self.placed),
            Phase::Stop | Phase::FreeKick(_) => {}
            _ => self.placed = None,
        }
        if let Some(ball) = world.ball {
            let hides = |robot: &&Robot| dribbler_point(robot).distance(ball.position) < HIDES_WITHIN_M;
            let contradicts = |robot: &Robot| match feels(robot.who.id) {
                Some(true) => !hides(&robot) && self.was_beside(robot),
                Some(false) => hides(&robot),
                None => false,
            };
            if now.since(ball.seen) < SENSOR_DECIDES_AFTER || !world.ours(us).any(contradicts) {
                self.last = Some(ball);
                if now.since(ball.seen) < HIDDEN_AFTER {
                    self.vanished = Some(ball.position);
                }
                self.by = world.theirs(us).find(hides).map(|robot| robot.who);
                return;
            }
            self.by = self.by.or_else(|| self.taken_by(world, us));
            world.ball = None;
        }
        let holder = self.holder(now, world.ours(us).filter(|robot| feels(robot.who.id) == Some(true)));
        if let (Some(robot), Some(last)) = (holder, &mut self.last) {
            // Where it lies if it is released: a ball released at speed is soon visible.
            (last.position, last.velocity) = (dribbler_point(robot), Vector::default());
            (last.height, last.climb) = (0.0, 0.0);
            (self.by, self.felt) = (None, Some(now));
        }
        let theirs = |robot: &&Robot| Some(robot.who) == self.by;
        let hider = holder.or_else(|| world.theirs(us).find(theirs));
        // A placer that does not feel the ball backs off by itself, so that cameras see it.
        let places = matches!(game.phase, Phase::BallPlacement(_));
        let felt = self.felt.is_some_and(|felt| now.since(felt) < SENSOR_DECIDES_AFTER);
        if hider.is_none() && !felt && !places {
            self.move_beside(world.ours(us).filter(|robot| feels(robot.who.id) == Some(false)));
        }
        let lies = matches!(game.phase, Phase::Stop | Phase::FreeKick(_));
        let (position, velocity) = match (hider, self.placed, &self.last) {
            (Some(robot), ..) => (dribbler_point(robot), robot.velocity),
            (None, Some(placed), _) if lies => (placed, Vector::default()),
            (None, _, Some(last)) => (last.rest(&world.models), Vector::default()),
            (None, _, None) => return,
        };
        let seen = self.last.map_or(now, |last| last.seen);
        world.ball = Some(Ball { velocity, confidence: 0.0, ..Ball::at_rest(position, seen) });
    }

    /// Whether the ball was last, or vanished, so near to the robot's front that the robot may have taken it.
    fn was_beside(&self, robot: &Robot) -> bool {
        let mut places = self.last.map(|last| last.position).into_iter().chain(self.vanished);
        places.any(|place| dribbler_point(robot).distance(place) < TAKES_WITHIN_M)
    }

    /// Of our robots whose sensors detect the ball, the one nearest to where it was last, if the ball can
    /// have come there since it was seen.
    fn holder<'a>(&self, now: Instant, feeling: impl Iterator<Item = &'a Robot>) -> Option<&'a Robot> {
        let last = self.last?;
        let reach = TAKES_WITHIN_M + BALL_SPEED_MAX_M_S * now.since(last.seen).as_secs_f32();
        feeling
            .map(|robot| (dribbler_point(robot).distance(last.position), robot))
            .filter(|(off, _)| *off < reach)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, robot)| robot)
    }

    /// Moves a ball out of the opening of a robot whose sensor does not detect it: it lies beside. One that
    /// lies farther before the front stays where it is: there the robot hides it too, and does not feel it.
    /// Not while a ball is placed: in ER-Force's simulator a sensor misses a ball that lies in the opening.
    fn move_beside<'a>(&mut self, mut unfelt: impl Iterator<Item = &'a Robot>) {
        let Some(last) = &mut self.last else { return };
        let robot = unfelt.find(|robot| {
            let ahead = robot.pose.to_body(last.position).x() - rules::limits::ROBOT_RADIUS;
            ahead < FELT_WITHIN_M && dribbler_point(robot).distance(last.position) < BESIDE_M
        });
        if let Some(robot) = robot {
            let side = robot.pose.to_body(last.position).y();
            let beside = Point::new(rules::limits::ROBOT_RADIUS, BESIDE_M.copysign(side));
            (last.position, last.velocity) = (robot.pose.to_field(beside), Vector::default());
        }
    }

    /// The opponent that has taken a ball which vanished between it and one of ours: whose front is nearest
    /// to where it was last seen, and near.
    fn taken_by(&self, world: &World, us: Colour) -> Option<Who> {
        let last = self.last?.position;
        let fronts = world.theirs(us).map(|robot| (dribbler_point(robot).distance(last), robot.who));
        let near = fronts.filter(|(off, _)| *off < TAKES_WITHIN_M);
        near.reduce(|best, next| if next.0 < best.0 { next } else { best }).map(|(_, who)| who)
    }
}

/// The middle of a robot's front, where a ball at the dribbler is.
fn dribbler_point(robot: &Robot) -> Point<Field> {
    robot.pose.to_field(Point::new(rules::limits::ROBOT_RADIUS, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Pose;

    const NO_ROBOT: fn(RobotId) -> Option<bool> = |_| Some(false);

    fn robot(who: Who, x: f32) -> Robot {
        Robot {
            who,
            pose: Pose { position: Point::new(x, 0.0), ..Pose::default() },
            velocity: Vector::default(),
            angular: 0.0,
            confidence: 1.0,
            seen: Instant(0),
        }
    }

    fn ball(x: f32) -> Ball {
        Ball::at_rest(Point::new(x, 0.0), Instant(0))
    }

    fn x_of(
        hidden: &mut HiddenBall,
        world: &World,
        phase: Phase<Colour>,
        feels: fn(RobotId) -> Option<bool>,
    ) -> Option<f32> {
        let mut world = world.clone();
        let placement = matches!(phase, Phase::BallPlacement(_)).then(|| Point::new(-4.0, 0.0));
        let mut game = Game::default();
        (game.phase, game.placement) = (phase, placement);
        hidden.fill(Instant(1_000_000), &mut world, Colour::Yellow, &game, feels);
        world.ball.map(|ball| ball.position.x())
    }

    #[test]
    fn it_is_at_our_robot_that_feels_it_or_at_theirs_that_had_it_or_where_it_was_last() {
        let (ours, theirs) = (Who::yellow(RobotId::ZERO), Who::blue(RobotId::ZERO));
        let mut hidden = HiddenBall::default();
        let mut world = World::default();
        world.put(robot(ours, 1.0));
        world.put(robot(theirs, 2.0));
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), None, "nobody has ever seen it");
        world.ball = Some(ball(3.0));
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), Some(3.0));
        world.ball = None;
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), Some(3.0));
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, |_| Some(true)), Some(1.09));
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), Some(1.09), "let go, and still hidden");
        let lies = hidden.last.unwrap().position;
        hidden.felt = None;
        x_of(&mut hidden, &world, Phase::Run, NO_ROBOT);
        let beside = hidden.last.unwrap().position;
        assert_eq!((lies.y(), beside.y().abs()), (0.0, BESIDE_M), "no longer in the opening");
        world.ball = Some(ball(2.1));
        x_of(&mut hidden, &world, Phase::Run, NO_ROBOT);
        world.ball = None;
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), Some(2.09));
    }

    /// A robot on its way to it hides it from 4 cm on, and its sensor reaches 1.5 cm.
    #[test]
    fn a_ball_that_lies_before_a_front_unseen_and_unfelt_stays_where_it_was_seen() {
        let at = |x_of_ball: f32, phase| {
            let (mut hidden, mut world) = (HiddenBall::default(), World::default());
            world.put(robot(Who::yellow(RobotId::ZERO), 1.0));
            world.ball = Some(Ball::at_rest(Point::new(x_of_ball, 0.0), Instant(1_000_000)));
            x_of(&mut hidden, &world, phase, NO_ROBOT);
            world.ball = None;
            x_of(&mut hidden, &world, phase, NO_ROBOT);
            hidden.last.unwrap().position
        };
        assert_eq!(at(1.13, Phase::Run), Point::new(1.13, 0.0));
        assert_eq!(at(1.1, Phase::Run).y().abs(), BESIDE_M, "it would be felt there");
        assert_eq!(at(0.9, Phase::Run), Point::new(0.9, 0.0), "at its back");
        assert_eq!(at(1.1, Phase::BallPlacement(Colour::Yellow)).y(), 0.0, "a placer backs off itself");
    }

    #[test]
    fn of_two_robots_that_feel_it_the_one_near_it_holds_it_and_none_out_of_its_reach() {
        let (mut hidden, mut world) = (HiddenBall::default(), World::default());
        let numbered = |id| Who::yellow(RobotId::new(id).unwrap());
        world.put(robot(numbered(0), -4.0));
        world.put(robot(numbered(1), 1.9));
        world.ball = Some(ball(2.0));
        let mut at = |ms: u64, world: &World, feels: fn(RobotId) -> Option<bool>| {
            let mut world = world.clone();
            hidden.fill(Instant(ms * 1000), &mut world, Colour::Yellow, &Game::default(), feels);
            (world.ball.unwrap().position.x() * 1000.0).round()
        };
        assert_eq!(at(0, &world, NO_ROBOT), 2000.0);
        world.ball = None;
        assert_eq!(at(400, &world, |_| Some(true)), 1990.0);
        let stuck: fn(RobotId) -> Option<bool> = |id| Some(id == RobotId::ZERO);
        assert_eq!(at(500, &world, stuck), 1990.0, "5.9 m in 0.5 s: no ball");
        assert_eq!(at(1000, &world, stuck), -3910.0, "it may have rolled there unseen");
    }

    #[test]
    fn an_unfelt_ball_that_vanished_at_ours_is_at_the_opponent_or_where_it_was_seen() {
        let (ours, theirs) = (Who::yellow(RobotId::ZERO), Who::blue(RobotId::ZERO));
        let (mut hidden, mut world) = (HiddenBall::default(), World::default());
        world.put(robot(ours, 1.0));
        world.ball = Some(ball(1.08));
        let mut at = |ms: u64, world: &World, feels: fn(RobotId) -> Option<bool>| {
            let mut world = world.clone();
            let now = Instant(ms * 1000);
            hidden.fill(now, &mut world, Colour::Yellow, &Game::default(), feels);
            (world.ball.unwrap().position.x() * 1000.0).round()
        };
        assert_eq!(at(100, &world, NO_ROBOT), 1080.0, "just vanished");
        // It moves off; tracking carries the ball along.
        world.put(robot(ours, 1.5));
        world.ball = Some(ball(1.58));
        assert_eq!(at(400, &world, |_| Some(true)), 1580.0, "felt");
        assert_eq!(at(400, &world, |_| None), 1580.0, "it has not reported");
        world.put(robot(ours, 2.0));
        world.ball = Some(ball(2.08));
        assert_eq!(at(500, &world, NO_ROBOT), 1580.0, "where it was last believed");
        world.put(robot(theirs, 1.45));
        world.ball = Some(ball(2.08));
        assert_eq!(at(600, &world, NO_ROBOT), 1540.0, "the opponent's front was beside it");
    }

    /// Tracking carries it along with the opponent's front, and the sensor of ours detects it all the time.
    #[test]
    fn a_ball_that_vanished_at_an_opponent_is_at_our_robot_beside_it_that_feels_it() {
        let (ours, theirs) = (Who::yellow(RobotId::ZERO), Who::blue(RobotId::ZERO));
        let mut hidden = HiddenBall::default();
        let mut at = |ms: u64, (x_of_ours, x_of_theirs): (f32, f32)| {
            let mut world = World::default();
            world.put(robot(ours, x_of_ours));
            world.put(robot(theirs, x_of_theirs));
            world.ball = Some(ball(x_of_theirs + 0.09));
            hidden.fill(Instant(ms * 1000), &mut world, Colour::Yellow, &Game::default(), |_| Some(true));
            (world.ball.unwrap().position.x() * 1000.0).round()
        };
        assert_eq!(at(200, (1.1, 1.0)), 1090.0, "just vanished");
        assert_eq!(at(300, (1.1, 1.0)), 1190.0);
        assert_eq!(at(400, (1.2, 0.9)), 1290.0, "they part");
        let mut far = HiddenBall::default();
        let mut world = World::default();
        world.put(robot(ours, 1.5));
        world.put(robot(theirs, 1.0));
        world.ball = Some(ball(1.09));
        for ms in [100, 400] {
            let mut world = world.clone();
            far.fill(Instant(ms * 1000), &mut world, Colour::Yellow, &Game::default(), |_| Some(true));
            assert_eq!(world.ball.unwrap().position.x(), 1.09, "half a metre off: a stuck sensor");
        }
    }

    /// The opponent turned away with what tracking left at its front before the sensor of ours detected it.
    #[test]
    fn a_ball_is_at_our_robot_that_feels_it_where_it_vanished() {
        let mut hidden = HiddenBall::default();
        let mut at = |ms: u64, x_of_theirs: f32, feels: fn(RobotId) -> Option<bool>| {
            let mut world = World::default();
            world.put(robot(Who::yellow(RobotId::ZERO), 1.0));
            world.put(robot(Who::blue(RobotId::ZERO), x_of_theirs));
            world.ball = Some(ball(x_of_theirs + 0.09));
            hidden.fill(Instant(ms * 1000), &mut world, Colour::Yellow, &Game::default(), feels);
            (world.ball.unwrap().position.x() * 1000.0).round()
        };
        assert_eq!(at(0, 1.05, NO_ROBOT), 1140.0, "seen");
        assert_eq!(at(400, 1.5, NO_ROBOT), 1590.0, "gone with theirs");
        assert_eq!(at(500, 1.6, |_| Some(true)), 1090.0, "ours has had it");
    }

    #[test]
    fn at_the_restart_after_a_placement_it_lies_where_it_was_placed() {
        let (mut hidden, mut world) = (HiddenBall::default(), World::default());
        let (placement, free_kick) = (Phase::BallPlacement(Colour::Blue), Phase::FreeKick(Colour::Blue));
        world.ball = Some(ball(3.0));
        x_of(&mut hidden, &world, placement, NO_ROBOT);
        world.ball = None;
        assert_eq!(x_of(&mut hidden, &world, placement, NO_ROBOT), Some(3.0), "it is still on its way");
        assert_eq!(x_of(&mut hidden, &world, Phase::Stop, NO_ROBOT), Some(-4.0));
        assert_eq!(x_of(&mut hidden, &world, free_kick, NO_ROBOT), Some(-4.0));
        assert_eq!(x_of(&mut hidden, &world, Phase::Run, NO_ROBOT), Some(3.0));
        assert_eq!(x_of(&mut hidden, &world, free_kick, NO_ROBOT), Some(3.0), "another restart, not placed");
    }
}
