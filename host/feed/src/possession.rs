//! `possession`: possession statistics. Counted from vision, where there is no referee of our own (Biswas et
//! al. 2014 §6).

use host::world::World;
use rules::{Colour, Phase, contact};

/// A robot whose centre is nearer to the ball than this touches it, m.
const TOUCHES_WITHIN_M: f32 = contact::POSSESSION_WITHIN;
/// Between two looks no more than this counts, s: what is longer is a gap.
const GAP_S: f64 = 0.5;

/// Seconds by team: yellow, blue.
#[derive(Clone, Debug, Default)]
pub(super) struct Possession {
    last: Option<f64>,
    holder: Option<Colour>,
    had: [f64; 2],
    /// The ball in the half that this team attacks.
    ahead: [f64; 2],
}

impl Possession {
    pub(super) fn look(&mut self, t: f64, world: &World, phase: Phase<Colour>, blue_defends: Option<i8>) {
        let passed = self.last.replace(t).map_or(0.0, |last| t - last);
        let running = matches!(phase, Phase::Run | Phase::FreeKick(_) | Phase::Kickoff(_));
        let Some(ball) = world.ball.filter(|_| running) else { return };
        if let Some((robot, far)) = world.nearest(ball.position)
            && far < TOUCHES_WITHIN_M
        {
            self.holder = Some(robot.who.colour);
        }
        if !(0.0..GAP_S).contains(&passed) {
            return;
        }
        if let Some(holder) = self.holder {
            self.had[holder as usize] += passed;
        }
        if let Some(blue) = blue_defends {
            let on_blues_half = ball.position.x() * f32::from(blue) > 0.0;
            let attacks = if on_blues_half { Colour::Yellow } else { Colour::Blue };
            self.ahead[attacks as usize] += passed;
        }
    }

    pub(super) fn share(&self, team: Colour) -> Option<f32> {
        let all: f64 = self.had.iter().sum();
        (all > 0.0).then(|| (self.had[team as usize] / all) as f32)
    }

    pub(super) fn offence_ratio(&self, team: Colour) -> Option<f32> {
        let own = self.ahead[team.other() as usize];
        (own > 0.0).then(|| (self.ahead[team as usize] / own) as f32)
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Angle, Point, Pose, Vector};
    use host::world::{Ball, Robot};
    use protocol::{Instant, RobotId, Who};

    use super::*;

    fn world(ball: f32, robot: f32) -> World {
        let mut world = World::default();
        let at = |x| Point::new(x, 0.0);
        world.ball = Some(Ball::at_rest(at(ball), Instant(0)));
        world.put(Robot {
            who: Who { colour: Colour::Yellow, id: RobotId::ZERO },
            pose: Pose { position: at(robot), heading: Angle::ZERO },
            velocity: Vector::default(),
            angular: 0.0,
            confidence: 1.0,
            seen: Instant(0),
        });
        world
    }

    #[test]
    fn who_touched_the_ball_last_has_it_and_the_half_is_counted_for_who_attacks_there() {
        let mut possession = Possession::default();
        // Blue defends +x. Yellow touches at x = 1 and the ball lies there for 1 s, then for 0.5 s at x = −1.
        for (t, ball, robot) in [
            (0.0, 1.0, 1.1),
            (0.4, 1.0, 1.1),
            (0.8, 1.0, 3.0),
            (1.0, 1.0, 3.0),
            (1.25, -1.0, 3.0),
            (1.49, -1.0, 3.0),
        ] {
            possession.look(t, &world(ball, robot), Phase::Run, Some(1));
        }
        assert_eq!(possession.share(Colour::Yellow), Some(1.0));
        assert_eq!(possession.share(Colour::Blue), Some(0.0));
        let ratio = possession.offence_ratio(Colour::Yellow).unwrap();
        assert!((ratio - 1.0 / 0.49).abs() < 1e-3, "{ratio}");
        // A gap in the recording counts for neither team.
        possession.look(9.0, &world(1.0, 3.0), Phase::Run, Some(1));
        assert!((possession.offence_ratio(Colour::Yellow).unwrap() - ratio).abs() < 1e-6);
    }
}
