//! What does the referee see of the simulated field? Its observation, filled from the world.

use hil_sim::small_size::referee::{BallSeen, CrashSeen, InternalReferee, Observation, RobotSeen};
use hil_sim::small_size::{Event, World};
use protocol::Instant;

/// Shows the world to the referee, with what happened since it last looked.
pub(super) fn show(referee: &mut InternalReferee, now: Instant, world: &World, events: &[Event]) {
    let touched = |who| {
        events.iter().any(|event| match event {
            Event::Touched { robot, .. } | Event::Kicked { robot, .. } => *robot == who,
            _ => false,
        })
    };
    let robots: Vec<RobotSeen> = (world.robots().iter().filter(|robot| robot.present))
        .map(|robot| RobotSeen {
            who: robot.who,
            pose: robot.pose,
            velocity: robot.velocity,
            touches_ball: robot.touching || touched(robot.who),
        })
        .collect();
    let crashes: Vec<CrashSeen> = events
        .iter()
        .filter_map(|event| match event {
            Event::Crash { robots, velocities, .. } => {
                Some(CrashSeen { between: *robots, velocities: *velocities })
            }
            _ => None,
        })
        .collect();
    let ball = &world.ball;
    let ball =
        BallSeen { position: ball.position, height: ball.height, velocity: ball.velocity, climb: ball.climb };
    let kicked = |event: &Event| if let Event::Kicked { speed, .. } = event { *speed } else { 0.0 };
    let fastest = events.iter().map(kicked).fold(0.0, f32::max);
    referee.observe(&Observation {
        time: now,
        ball: Some(ball),
        fastest,
        robots: &robots,
        crashes: &crashes,
    });
}
