//! `snapshot`: packs a snapshot into parts that fit into frames: ours first, then theirs, lowest number
//! first, spread over as few parts as hold them. Field frame.

use geometry::{Field, Point};
use protocol::host::{PARTS_MAX, WORLD_ROBOTS_MAX, WireBall, WireRobot, WireWho, WorldPart};
use protocol::quantized::{length_to_mm, saturate, whole_mm};
use rules::{Colour, Phase, Side};

use crate::world::{Ball, Robot, World};

/// Robots that fit into a snapshot; more (ghosts, many false detections) are left out from the end.
pub const PARTS_ROBOTS_MAX: usize = WORLD_ROBOTS_MAX;

/// The state of the game, beside the snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadioSituation {
    /// The colour our robots play with.
    pub us: Colour,
    /// The phase, by side (ours or theirs).
    pub phase: Phase<Side>,
    /// Where the ball is to be placed, during placement.
    pub placement: Option<Point<Field>>,
}

/// The parts of a snapshot for that number of robots.
pub(super) fn parts(
    snapshot: u8,
    addressees: usize,
    world: &World,
    situation: &RadioSituation,
) -> heapless::Vec<WorldPart, PARTS_MAX> {
    let us = situation.us;
    let ours = world.ours(us).map(|robot| wire_robot(Side::Ours, robot));
    let robots: heapless::Vec<WireRobot, PARTS_ROBOTS_MAX> = ours
        .chain(world.theirs(us).map(|robot| wire_robot(Side::Theirs, robot)))
        .take(PARTS_ROBOTS_MAX)
        .collect();
    let parts =
        robots.len().div_ceil(WorldPart::robots_max(addressees, situation.placement.is_some())).max(1);
    let per_part = robots.len().div_ceil(parts);
    let ball = world.ball.as_ref().map(wire_ball);
    let part = |part: usize| WorldPart {
        snapshot,
        part: part as u8,
        parts: parts as u8,
        phase: situation.phase,
        placement: situation.placement.map(Into::into),
        ball,
        robots: robots.iter().skip(part * per_part).take(per_part).copied().collect(),
    };
    (0..parts).map(part).collect()
}

fn wire_robot(side: Side, robot: &Robot) -> WireRobot {
    let (vx, vy) = (saturate(whole_mm(robot.velocity.x())), saturate(whole_mm(robot.velocity.y())));
    WireRobot { who: WireWho { side, id: robot.who.id }, pose: robot.pose.into(), vx, vy }
}

fn wire_ball(ball: &Ball) -> WireBall {
    WireBall {
        at: ball.position.into(),
        height: length_to_mm(ball.height),
        vx: saturate(whole_mm(ball.velocity.x())),
        vy: saturate(whole_mm(ball.velocity.y())),
    }
}
