//! `snapshot`: packs a snapshot into parts that fit into frames: ours first, then theirs, lowest number
//! first, spread over as few parts as hold them. Where more robots stand about than robots take (both teams
//! of division A, and bystanders), those nearest to the addressees are sent: the others are no obstacles yet.
//! Field frame.

use geometry::{Field, Point};
use protocol::RobotId;
use protocol::frame::Audience;
use protocol::host::{PARTS_MAX, WORLD_ROBOTS_MAX, WireBall, WireRobot, WireWho, WorldPart};
use protocol::quantized::{length_to_mm, saturate, whole_mm};
use protocol::robot_io::OPPONENTS_MAX;
use rules::{Colour, Phase, Side};

use crate::world::{Ball, Robot, World};

/// Robots in a snapshot: as many as a robot takes, both teams of the largest league.
pub const PARTS_ROBOTS_MAX: usize = 2 * OPPONENTS_MAX;
const _: () = assert!(PARTS_ROBOTS_MAX <= WORLD_ROBOTS_MAX, "a snapshot holds them");

/// The state of the game, beside the snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadioSituation {
    /// The colour our robots play with.
    pub us: Colour,
    /// The phase, by side (ours or theirs).
    pub phase: Phase<Side>,
    /// Place for the ball during a placement.
    pub placement: Option<Point<Field>>,
}

/// The parts of a snapshot for these robots.
pub(super) fn parts(
    snapshot: u8,
    audience: Audience,
    world: &World,
    situation: &RadioSituation,
) -> heapless::Vec<WorldPart, PARTS_MAX> {
    let robots = sent(world, situation.us, audience);
    let parts =
        robots.len().div_ceil(WorldPart::robots_max(audience.len(), situation.placement.is_some())).max(1);
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

/// The robots of a snapshot: all addressees, and those nearest to any of them.
fn sent(world: &World, us: Colour, audience: Audience) -> heapless::Vec<WireRobot, PARTS_ROBOTS_MAX> {
    let hears = |robot: &Robot| robot.who.colour == us && audience.has(robot.who.id);
    let near = |robot: &Robot| {
        let to = |other: &Robot| other.pose.position.distance(robot.pose.position);
        world.ours(us).filter(|other| hears(other)).map(to).fold(f32::INFINITY, f32::min)
    };
    let all = || world.ours(us).chain(world.theirs(us));
    // An addressee is at distance 0 from itself.
    let mut distances: heapless::Vec<f32, { 2 * RobotId::COUNT }> = all().map(near).collect();
    let farthest = if distances.len() > PARTS_ROBOTS_MAX {
        distances.sort_unstable_by(f32::total_cmp);
        distances[PARTS_ROBOTS_MAX - 1]
    } else {
        f32::INFINITY
    };
    let side = |robot: &Robot| if robot.who.colour == us { Side::Ours } else { Side::Theirs };
    let kept = all().filter(|robot| near(robot) <= farthest);
    kept.map(|robot| wire_robot(side(robot), robot)).take(PARTS_ROBOTS_MAX).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::BallModels;
    use geometry::{Angle, Pose, Vector};
    use protocol::{Instant, Who};

    fn robot(colour: Colour, id: usize, x: f32, y: f32) -> Robot {
        let who = Who { colour, id: RobotId::all().nth(id).unwrap() };
        let pose = Pose { position: Point::new(x, y), heading: Angle::ZERO };
        let (velocity, seen) = (Vector::default(), Instant(0));
        Robot { who, pose, velocity, angular: 0.0, confidence: 1.0, seen }
    }

    #[test]
    fn of_more_robots_than_fit_those_far_from_ours_are_left_out_whatever_their_numbers() {
        let mut world = World::empty(Instant(0), BallModels::default());
        for id in 0..11 {
            world.put(robot(Colour::Blue, id, 0.0, 0.3 * id as f32));
            // Those with the highest numbers are the nearest.
            world.put(robot(Colour::Yellow, id, 5.0 - 0.4 * id as f32, 1.0));
        }
        // Robots that stand about far away, of our colour and deaf, and of theirs.
        for id in 11..16 {
            world.put(robot(Colour::Blue, id, -5.5, -4.0 + 0.3 * id as f32));
            world.put(robot(Colour::Yellow, id, -5.5, 0.5 * id as f32 - 9.0));
        }
        let audience: Audience = RobotId::all().take(11).collect();
        let sent = sent(&world, Colour::Blue, audience);
        assert_eq!(sent.len(), PARTS_ROBOTS_MAX);
        for side in [Side::Ours, Side::Theirs] {
            let numbers: Vec<u8> = sent
                .iter()
                .filter(|robot| robot.who.side == side)
                .map(|robot| robot.who.id.number())
                .collect();
            assert_eq!(numbers, (0..11).collect::<Vec<u8>>(), "{side:?}");
        }
    }
}
