//! `start`: the moment of another match that a match starts from: its field, its referee, and the recorded
//! tracks before and after it. m, m/s, rad, rad/s, field frame; a frame each tick of 10 ms.
//!
//! Before the moment ball and robots move as recorded for [`LEAD_IN_TICKS`], while cameras, hosts, radio and
//! robots' computers already run: at the moment everyone knows where everything is and how it moves. From
//! then on the simulation decides, but for robots of a team that is led along its tracks.

use geometry::{Angle, Twist, Vector};
use hil_sim::small_size::referee::remote::RemoteMatch;
use hil_sim::small_size::{Drive, Order, World};
use protocol::{RobotId, Who};
use rules::Colour;

use super::STEPS_A_TICK;
use crate::snapshot::{RobotState, Snapshot};

/// Ticks before the moment in which everything moves as recorded: 0.5 s, 30 frames of the cameras, after
/// which trackers know positions and velocities.
pub const LEAD_IN_TICKS: u32 = 50;

/// A moment of a recorded or running match.
#[derive(Clone, Debug)]
pub struct GameStart {
    /// The field each tick: [`LEAD_IN_TICKS`] frames, the moment itself, and what was recorded after it.
    pub frames: Vec<Snapshot>,
    /// The referee's state at the moment.
    pub referee: RemoteMatch,
    /// Whether blue's goal is at +x.
    pub blue_on_positive: bool,
    /// The team whose robots are led along their recorded tracks after the moment.
    pub led: Option<Colour>,
}

impl GameStart {
    /// The field at the moment; at the last frame of a recording that ends before it.
    pub fn moment(&self) -> Option<&Snapshot> {
        self.frames.get(LEAD_IN_TICKS as usize).or(self.frames.last())
    }

    /// Numbers of a team's robots at the moment, in order.
    pub fn robots(&self, team: Colour) -> impl Iterator<Item = RobotId> + '_ {
        self.moment()
            .into_iter()
            .flat_map(Snapshot::present)
            .filter(move |who| who.colour == team)
            .map(|who| who.id)
    }

    /// Robots that are led after the moment.
    pub(super) fn on_track(&self) -> impl Iterator<Item = Who> + '_ {
        self.led.into_iter().flat_map(|colour| self.robots(colour).map(move |id| Who { colour, id }))
    }

    /// Places ball and robots as they were in this tick.
    pub(super) fn place(&self, tick: u32, world: &mut World) {
        if let Some(frame) = self.frames.get(tick as usize) {
            frame.restore(world);
        }
    }

    /// Begins a tick: until the moment everything is placed, later the robots that are not on their track any
    /// more leave `on_track`. Returns the orders of all robots that are led in this tick.
    pub(super) fn lead(&self, tick: u32, world: &mut World, on_track: &mut Vec<Who>) -> Vec<(Who, Order)> {
        if tick <= LEAD_IN_TICKS {
            self.place(tick, world);
        }
        let frame = self.frames.get(tick as usize);
        if tick < LEAD_IN_TICKS {
            let frame = frame.into_iter();
            let robots = frame.flat_map(|frame| frame.robots.iter());
            return robots.filter_map(|track| Some((track.who()?, order(track, track)))).collect();
        }
        let mut led = Vec::new();
        on_track.retain(|who| {
            let track = frame.and_then(|frame| frame.robots.iter().find(|track| track.who() == Some(*who)));
            let order = track.and_then(|track| follow(world, *who, track));
            led.extend(order.map(|order| (*who, order)));
            order.is_some()
        });
        led
    }
}

/// The order that keeps a robot on its track; none where it is pushed off it, or at the ball: there it
/// decides by itself, as the recording knows nothing of this ball.
fn follow(world: &World, who: Who, track: &RobotState) -> Option<Order> {
    let robot = world.robot(who).filter(|robot| robot.present)?;
    let (at, heading) = (robot.pose.position, robot.pose.heading.radians());
    let own = RobotState { at: [at.x(), at.y()], heading, ..*track };
    let off = Vector::<geometry::Field>::new(track.at[0] - own.at[0], track.at[1] - own.at[1]);
    let touches =
        world.last_touch().is_some_and(|(by, step)| by == who && step + STEPS_A_TICK >= world.now());
    (off.norm() <= OFF_TRACK_M && !touches).then(|| order(track, &own))
}

/// The recorded velocity, and what leads back to the track.
fn order(track: &RobotState, own: &RobotState) -> Order {
    let along = [0, 1].map(|axis| track.velocity[axis] + TRACK_GAIN * (track.at[axis] - own.at[axis]));
    let turn = (Angle::new(track.heading) - Angle::new(own.heading)).radians();
    let twist = Twist { linear: Vector::new(along[0], along[1]), angular: track.turning + TRACK_GAIN * turn };
    Order { drive: Drive::Global(twist), ..Order::default() }
}

/// A robot farther off its track is released, m: more than a robot's radius and the tracker's error; a robot
/// in its way keeps its centre two radii off.
const OFF_TRACK_M: f32 = 0.15;
/// Rate by error, 1/s: half of an error is gone after 0.14 s; faster ones swing (estimate).
const TRACK_GAIN: f32 = 5.0;
