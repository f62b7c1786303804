//! What does a robot on wheels hold true? What the host shows it, its light barrier and its wheels (DESIGN §3).
//!
//! Field frame, SI. The ball in its grip: the light barrier, bridged for a moment where the host shows the ball before the
//! mouth, as a rolling ball flickers. How far the ball was carried counts from the first touch until there is a gap that
//! everybody can see (rules 2026: dribbling).

use geometry::{Field, Point, Pose, Vector};
use motion::ball::BallModel;
use protocol::robot_io::SensorFrame;
use protocol::{Duration, Instant};
use rules::Side;

use crate::belief::{Ball, Belief, Other};
use crate::body::omni::{BALL_AT, FRONT};
use crate::picture::{IN_THE_AIR, Picture};

/// The ball's time at this robot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Handling {
    /// When the light barrier saw it last.
    touched: Option<Instant>,
    /// Where this touch began: where the ball was then.
    from: Option<Point<Field>>,
    /// How high the ball is, m.
    height: f32,
    /// The light barrier, this very moment.
    contact: bool,
}

impl Belief {
    /// Takes over what the host shows and what the wheels measure.
    pub fn show(&mut self, now: Instant, picture: &Picture, sensors: &SensorFrame) {
        if let Some(pose) = picture.own(now) {
            self.pose = pose;
        }
        let measured = sensors.odometry;
        if measured.linear.is_finite() && measured.angular.is_finite() {
            self.velocity = self.pose.vector_to_field(measured.linear);
            self.angular = measured.angular;
        }
        self.kicker_ready = sensors.health.kicker_ready;
        self.others.clear();
        self.opponents.clear();
        for shown in picture.others(now) {
            let other =
                Other { side: shown.who.side, id: shown.who.id, pose: shown.pose, velocity: shown.velocity };
            // Sixteen a side can be shown, eleven play: those over the capacity are not there by the rules.
            let _ = self.others.push(other);
            if other.side == Side::Theirs {
                let _ = self.opponents.push(other.pose.position);
            }
        }
        self.handling.height = 0.0;
        self.ball = picture.ball(now).map(|ball| {
            self.handling.height = ball.height;
            rolling(ball.position, ball.velocity)
        });
        self.handle(now, sensors.ball_contact);
    }

    /// The light barrier sees the ball this very moment.
    pub fn contact(&self) -> bool {
        self.handling.contact
    }

    /// The ball flies.
    pub fn ball_flies(&self) -> bool {
        self.handling.height > IN_THE_AIR
    }

    /// How far the ball has been carried since it was touched first, m.
    pub fn carried(&self) -> f32 {
        match (self.handling.from, self.holds_ball) {
            (Some(from), true) => from.distance(self.mouth()),
            _ => 0.0,
        }
    }

    /// Where a ball in its grip is.
    pub fn mouth(&self) -> Point<Field> {
        self.pose.position + Vector::polar(BALL_AT, self.pose.heading)
    }

    fn handle(&mut self, now: Instant, contact: bool) {
        self.handling.contact = contact;
        if contact {
            self.handling.touched = Some(now);
        }
        let shown = self.ball.map(|ball| ball.position);
        let at_mouth = shown.is_some_and(|at| is_at_mouth(self.pose, at));
        let recent = self.handling.touched.is_some_and(|last| now.since(last) <= BRIDGED);
        self.holds_ball = contact || (recent && at_mouth);
        let mouth = self.mouth();
        if self.holds_ball {
            self.handling.from.get_or_insert(mouth);
            // What the light barrier sees is where the ball is, sooner than any camera says so.
            if contact {
                self.ball = Some(Ball { position: mouth, velocity: self.velocity, rest: mouth });
            }
        } else if shown.is_none_or(|at| at.distance(mouth) > VISIBLE_GAP) {
            self.handling.from = None;
        }
    }
}

/// A ball that goes on as rolling balls do; whether it still slides nobody says.
fn rolling(position: Point<Field>, velocity: Vector<Field>) -> Ball {
    let path = BallModel::default().rolling(position, velocity);
    Ball { position, velocity, rest: path.rest() }
}

/// Before the flat front, as far as noise lets say.
fn is_at_mouth(pose: Pose<Field>, ball: Point<Field>) -> bool {
    let seen = pose.to_body(ball);
    (FRONT - 0.01..BALL_AT + AT_MOUTH_AHEAD).contains(&seen.x()) && seen.y().abs() < AT_MOUTH_BESIDE
}

/// The light barrier may miss the ball for so long: a few of its turns on the roller.
const BRIDGED: Duration = Duration::millis(60);
/// A gap between ball and mouth that the rules call visible, m.
const VISIBLE_GAP: f32 = 0.05;
/// How far before the roller the host may show a ball that is held, m: noise, and 30 ms of its delay.
const AT_MOUTH_AHEAD: f32 = 0.03;
/// How far beside the middle, m: half a mouth's width.
const AT_MOUTH_BESIDE: f32 = 0.05;
