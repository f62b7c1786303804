//! `led_robot`: common parts of tests with robots on wheels under a host: a frame of sensors that see
//! nothing, a command to drive on, and a world in which blue's robots stand. m, rad, field frame.

use geometry::{Field, GoalEnd, Pose, Vector};
use host::radio::RadioSituation;
use host::world::{BallModels, Robot, World};
use protocol::host::{Directive, HostCommand, RuleRole};
use protocol::quantized::{WirePoint, WirePose};
use protocol::robot_io::{Health, SensorFrame};
use protocol::{Instant, RobotId, Who};
use rules::{Colour, Phase};

/// Situation of the host's radio: blue, in a running game.
pub const RUNNING: RadioSituation = RadioSituation { us: Colour::Blue, phase: Phase::Run, placement: None };

/// Sensor frame of a robot that sees nothing, does not move, and whose hardware is in order.
pub fn blind_sensors() -> SensorFrame {
    let health = Health { battery: Some(16.0), tipped: false, kicker_ready: true };
    SensorFrame { health, ..SensorFrame::default() }
}

/// Command to drive to (3, 0), which no robot of these tests reaches.
pub fn drive_on(to: RobotId) -> HostCommand {
    HostCommand {
        to,
        defending: GoalEnd::Negative,
        phase: Phase::Run,
        rule_role: RuleRole::Player,
        directive: Directive::GoTo { pose: WirePose { at: WirePoint { x: 3_000, y: 0 }, heading: 0 } },
    }
}

/// A world without a ball in which these robots of blue stand.
pub fn standing(now: Instant, robots: impl IntoIterator<Item = (RobotId, Pose<Field>)>) -> World {
    let mut world = World::empty(now, BallModels::default());
    for (id, pose) in robots {
        world.put(Robot {
            who: Who { colour: Colour::Blue, id },
            pose,
            velocity: Vector::default(),
            angular: 0.0,
            confidence: 1.0,
            seen: now,
        });
    }
    world
}
