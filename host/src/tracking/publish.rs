//! `publish`: the league's tracker packets: m, m/s, rad, rad/s, seconds on vision's clock.

use rules::Colour;
use ssl::common::{Vector2, Vector3};
use ssl::tracker::{
    Capability, KickedBall, TeamColor, TrackedBall, TrackedFrame, TrackedRobot, TrackedRobotId,
    TrackerWrapperPacket,
};

use super::Tracker;
use crate::world::{Ball, Kick, Robot, World};
use protocol::Who;

/// Makes tracker packets, one per world; the packet's memory is reused.
#[derive(Clone, Debug)]
pub struct Publisher {
    packet: TrackerWrapperPacket,
    frame: TrackedFrame,
}

impl Publisher {
    /// Sends as `uuid`, by which others distinguish sources; `name` is for display.
    pub fn new(uuid: &str, name: &str) -> Self {
        let packet =
            TrackerWrapperPacket { uuid: uuid.into(), source_name: Some(name.into()), tracked_frame: None };
        let capabilities = [Capability::DetectFlyingBalls, Capability::DetectKickedBalls].map(|c| c as i32);
        Self { packet, frame: TrackedFrame { capabilities: capabilities.into(), ..TrackedFrame::default() } }
    }

    /// The newest world as a packet; `None` before the first camera frame.
    pub fn publish(&mut self, tracker: &Tracker) -> Option<&TrackerWrapperPacket> {
        let captured = tracker.captured()?;
        let world = tracker.snapshot();
        // Taken out and put back, so that its lists keep their memory.
        let mut frame = self.packet.tracked_frame.take().unwrap_or_else(|| self.frame.clone());
        frame.frame_number = self.frame.frame_number;
        self.frame.frame_number = self.frame.frame_number.wrapping_add(1);
        frame.timestamp = captured;
        frame.balls.clear();
        frame.balls.extend(world.ball.as_ref().map(tracked_ball));
        frame.robots.clear();
        frame.robots.extend(world.robots().map(tracked_robot));
        frame.kicked_ball = world.ball.as_ref().and_then(|ball| kicked_ball(ball, &world, captured));
        self.packet.tracked_frame = Some(frame);
        Some(&self.packet)
    }
}

fn tracked_ball(ball: &Ball) -> TrackedBall {
    TrackedBall {
        pos: Vector3 { x: ball.position.x(), y: ball.position.y(), z: ball.height },
        vel: Some(Vector3 { x: ball.velocity.x(), y: ball.velocity.y(), z: ball.climb }),
        visibility: Some(ball.confidence),
    }
}

fn tracked_robot(robot: &Robot) -> TrackedRobot {
    TrackedRobot {
        robot_id: tracked_id(robot.who),
        pos: Vector2 { x: robot.pose.position.x(), y: robot.pose.position.y() },
        orientation: robot.pose.heading.radians(),
        vel: Some(Vector2 { x: robot.velocity.x(), y: robot.velocity.y() }),
        vel_angular: Some(robot.angular),
        visibility: Some(robot.confidence),
    }
}

fn kicked_ball(ball: &Ball, world: &World, captured: f64) -> Option<KickedBall> {
    let Kick { by, from, velocity, climb, at } = ball.kicked?;
    let rest = ball.rest(&world.models);
    let ago = (world.time.0 as f64 - at.0 as f64) * 1e-6;
    Some(KickedBall {
        pos: Vector2 { x: from.x(), y: from.y() },
        vel: Vector3 { x: velocity.x(), y: velocity.y(), z: climb },
        start_timestamp: captured - ago,
        stop_timestamp: Some(captured + f64::from(ball.rests_in(&world.models))),
        stop_pos: Some(Vector2 { x: rest.x(), y: rest.y() }),
        robot_id: by.map(tracked_id),
    })
}

fn tracked_id(who: Who) -> TrackedRobotId {
    let team_color = match who.colour {
        Colour::Yellow => TeamColor::Yellow,
        Colour::Blue => TeamColor::Blue,
    };
    TrackedRobotId { id: u32::from(who.id.number()), team_color: team_color as i32 }
}
