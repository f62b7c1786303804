//! Which moments are drawn? A free kick in the second paper's world: six against six on 6 × 4 m.

use geometry::{Angle, Attack, Point, Vector};
use host::strategy::View;
use host::strategy::view::{Ball, ROBOTS_MAX, Robot, RobotSet};
use protocol::{Instant, RobotId};
use rules::{League, Phase, Side};

/// A moment with robots numbered from 0; the keepers are 0.
pub(crate) fn moment(league: League, ball: (f32, f32), ours: &[(f32, f32)], theirs: &[(f32, f32)]) -> View {
    let robots = |places: &[(f32, f32)]| {
        let robot = |(id, (x, y)): (RobotId, &(f32, f32))| Robot {
            id,
            position: Point::new(*x, *y),
            heading: Angle::ZERO,
            velocity: Vector::default(),
        };
        RobotId::all().zip(places).map(robot).collect()
    };
    let position: Point<Attack> = Point::new(ball.0, ball.1);
    View {
        now: Instant(1_000_000),
        phase: Phase::FreeKick(Side::Ours),
        next: None,
        placement: None,
        ball: Some(Ball { position, velocity: Vector::default(), rest: position, height: 0.0 }),
        ours: robots(ours),
        theirs: robots(theirs),
        keeper: RobotId::ZERO,
        their_keeper: RobotId::ZERO,
        allowed: ROBOTS_MAX,
        in_play: RobotSet::default(),
        field: league.field(),
    }
}

/// Our free kick near the right touch line: 1 takes it, 2 to 4 are followed, 5 is not.
pub(crate) fn free_kick() -> View {
    let ours = [(-2.8, 0.0), (0.15, -1.52), (0.75, 0.15), (1.75, 0.55), (0.9, 1.15), (-0.7, 0.6)];
    // Keeper, a primary defender, three markers, a wall.
    let theirs = [(2.82, -0.1), (2.2, -0.42), (1.04, 0.12), (2.0, 0.43), (1.17, 1.0), (0.62, -1.03)];
    moment(League::Ssl2013, (0.25, -1.5), &ours, &theirs)
}
