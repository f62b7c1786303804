//! `opponents`: scripted opponents of paper 1. Ros et al. 2009 §5.1.2: each has a home region that it never
//! leaves; it walks to a ball inside that region and clears it, else it stands at the region's border nearest
//! the ball and faces it; a ball in its grasp there is cleared as well. m, s, field frame.
//!
//! They have the attackers' bodies and abilities: they walk, grab (which may fail) and then kick at once in
//! whichever of the body's three directions (ahead, left, right) points most upfield. They see the true
//! state, as in the paper's simulator.

use geometry::{Angle, Body, Field, Point, Pose, Twist, Vector, math};
use protocol::robot_io::{ActuatorFrame, LeggedKick, LeggedPrimitive};
use serde::Deserialize;

use crate::four_legged::parameters::{Parameters, Region};
use crate::four_legged::world::LeggedWorld;

crate::labels! {
    /// What an opponent is there for.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum OpponentRole {
        /// Between midfield and penalty area.
        Defender = "defender",
        /// Around the centre line.
        Midfield = "midfield",
        /// In the penalty area.
        Goalie = "goalie",
    }
}

impl OpponentRole {
    /// Home region of the role, m, field frame.
    pub fn home(self, parameters: &Parameters) -> Region {
        match self {
            Self::Defender => parameters.opponent.defender,
            Self::Midfield => parameters.opponent.midfield,
            Self::Goalie => parameters.opponent.goalie,
        }
    }
}

/// Behaviour of a scripted opponent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Conduct {
    /// It plays from its role's home.
    #[default]
    AtHome,
    /// It plays from this region instead.
    Within(Region),
    /// It stays where it is: an obstacle that clears no ball.
    Standing,
}

/// A scripted opponent with its region.
#[derive(Clone, Debug)]
pub struct Opponent {
    /// Role from which its home follows.
    pub role: OpponentRole,
    /// Its index in [`LeggedWorld::walkers`].
    robot: usize,
    /// Region where it plays; `None` where it only stands.
    home: Option<Region>,
}

impl Opponent {
    /// An opponent in its home region, or in the region its conduct names.
    pub fn new(role: OpponentRole, conduct: Conduct, robot: usize, parameters: &Parameters) -> Self {
        let home = match conduct {
            Conduct::AtHome => Some(role.home(parameters)),
            Conduct::Within(region) => Some(region),
            Conduct::Standing => None,
        };
        Self { role, robot, home }
    }

    /// Decides and orders its body, in every control step.
    pub fn act(&self, world: &mut LeggedWorld, parameters: &Parameters) {
        let Some(home) = self.home else { return };
        let (ball, pose) = (world.ball.position, world.walkers[self.robot].pose);
        let primitive = if world.holder() == Some(self.robot) {
            LeggedPrimitive::Kick(most_upfield(world.kick_directions(pose.heading)))
        } else if world.in_grasp(self.robot) {
            LeggedPrimitive::Grab
        } else {
            LeggedPrimitive::None
        };
        // At its home's border where the ball is outside, at the ball where it is inside: the same
        // expression.
        let walk = walk_to(pose, home.nearest(ball), ball, parameters);
        world.command(self.robot, &ActuatorFrame::Legged { walk, primitive });
    }
}

/// The kick whose direction (ahead, left, right) points most towards -x.
fn most_upfield(directions: [Angle; 3]) -> LeggedKick {
    let kicks = [LeggedKick::ForwardHard, LeggedKick::Left, LeggedKick::Right];
    let upfield = |to: &Angle| -to.sin_cos().1;
    let pairs = directions.into_iter().zip(kicks);
    pairs
        .reduce(|best, next| if upfield(&next.0) > upfield(&best.0) { next } else { best })
        .map_or(LeggedKick::ForwardHard, |(_, kick)| kick)
}

impl Region {
    /// Inside or on the border.
    pub fn contains(&self, point: Point<Field>) -> bool {
        (self.x[0]..=self.x[1]).contains(&point.x()) && (self.y[0]..=self.y[1]).contains(&point.y())
    }

    /// The point of the region nearest to `point`.
    pub fn nearest(&self, point: Point<Field>) -> Point<Field> {
        Point::new(point.x().clamp(self.x[0], self.x[1]), point.y().clamp(self.y[0], self.y[1]))
    }
}

/// The velocity that brings a body to `target` without overshooting, heading towards `gaze`.
fn walk_to(
    pose: Pose<Field>,
    target: Point<Field>,
    gaze: Point<Field>,
    parameters: &Parameters,
) -> Twist<Body> {
    let p = &parameters.walk;
    let offset = pose.vector_to_body(target - pose.position);
    let distance = offset.norm();
    // Half of the maximum deceleration of the legs, so that the order of the next step is never too late.
    let speed = math::sqrt(p.acceleration * distance).min(p.forward);
    let linear = offset.unit().map_or(Vector::default(), |direction| direction * speed);
    let turn = pose.turn_to(gaze).radians();
    Twist { linear, angular: (GAZE_GAIN * turn).clamp(-p.turn, p.turn) }
}

/// Turning rate for an error of 1 rad, 1/s: three time constants in 0.75 s, well damped at 4 rad/s² and steps
/// of 40 ms.
const GAZE_GAIN: f32 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::four_legged::world::{Side, Walker, WorldEvent};
    use crate::rng::Stream;

    const DT: f32 = 0.04;

    struct Game {
        world: LeggedWorld,
        opponent: Opponent,
        events: Vec<WorldEvent>,
    }

    fn game(role: OpponentRole, at: (f32, f32), ball: (f32, f32)) -> Game {
        let p = Parameters::four_legged();
        let walker = Walker::at(Side::Opponents, Pose::from_mm_deg(at.0, at.1, 180.0));
        let world = LeggedWorld::new(p, 1, Point::new(ball.0, ball.1), vec![walker]);
        Game { world, opponent: Opponent::new(role, Conduct::AtHome, 0, p), events: Vec::new() }
    }

    impl Game {
        fn run(&mut self, seconds: f32) {
            for _ in 0..(seconds / DT + 0.5) as u32 {
                self.opponent.act(&mut self.world, Parameters::four_legged());
                (0..4).for_each(|_| self.world.step());
            }
            self.world.take_events(&mut self.events);
        }

        fn pose(&self) -> Pose<Field> {
            self.world.walkers[0].pose
        }
    }

    #[test]
    fn with_the_ball_elsewhere_it_stands_at_its_border_and_faces_it() {
        let mut game = game(OpponentRole::Defender, (1500.0, 300.0), (-1.0, 0.5));
        game.run(8.0);
        assert!(game.pose().position.distance(Point::new(0.9, 0.5)) < 0.01, "{:?}", game.pose());
        assert!(game.pose().turn_to(Point::new(-1.0, 0.5)).abs() < 0.01);
        assert!(game.events.is_empty());
    }

    #[test]
    fn a_ball_in_its_home_is_gone_for_and_kicked_upfield() {
        let mut game = game(OpponentRole::Defender, (1900.0, 0.0), (1.2, 0.3));
        game.run(6.0);
        let kick = game.events.iter().find_map(|event| match event {
            WorldEvent::Kicked { from, rest, .. } => Some(*rest - *from),
            _ => None,
        });
        assert!(kick.unwrap().x() < 0.0, "{kick:?}");
    }

    #[test]
    fn a_clearance_takes_a_grab_and_a_kick() {
        // In its grasp from the start: 0.5 s of closing the legs and 0.4 s of kicking, in steps of 40 ms.
        let kicked = |seed, seconds| {
            let mut game = game(OpponentRole::Defender, (1400.0, 0.0), (1.25, 0.0));
            game.world = LeggedWorld::new(
                Parameters::four_legged(),
                seed,
                game.world.ball.position,
                game.world.walkers.clone(),
            );
            game.run(seconds);
            game.events.iter().any(|e| matches!(e, WorldEvent::Kicked { .. }))
        };
        assert_eq!((0..40).filter(|&seed| kicked(seed, 0.88)).count(), 0);
        // Three grabs in four keep the ball: 30 of 40, four deviations of 2.7.
        let at_once = (0..40).filter(|&seed| kicked(seed, 1.0)).count();
        assert!((19..40).contains(&at_once), "{at_once}");
    }

    #[test]
    fn one_that_stands_neither_moves_nor_clears_and_one_with_a_region_of_its_own_keeps_to_it() {
        let p = Parameters::four_legged();
        let mut standing = game(OpponentRole::Defender, (1400.0, 0.0), (1.2, 0.0));
        standing.opponent = Opponent::new(OpponentRole::Defender, Conduct::Standing, 0, p);
        standing.run(3.0);
        assert!(standing.pose().position.distance(Point::new(1.4, 0.0)) < 1e-3, "{:?}", standing.pose());
        assert!(!standing.events.iter().any(|e| matches!(e, WorldEvent::Kicked { .. })));
        let region = Region { x: [-1.5, -0.5], y: [-0.5, 0.5] };
        let mut presser = game(OpponentRole::Defender, (-1000.0, 0.0), (-2.0, 1.0));
        presser.opponent = Opponent::new(OpponentRole::Defender, Conduct::Within(region), 0, p);
        presser.run(10.0);
        assert!(presser.pose().position.distance(Point::new(-1.5, 0.5)) < 0.05, "{:?}", presser.pose());
    }

    #[test]
    fn no_one_leaves_home_whatever_the_ball_does() {
        let p = Parameters::four_legged();
        for (role, at) in [
            (OpponentRole::Defender, 1500.0),
            (OpponentRole::Midfield, 500.0),
            (OpponentRole::Goalie, 2400.0),
        ] {
            let mut game = game(role, (at, 0.0), (0.0, 0.0));
            let mut chance = Stream::new(5, "test");
            for _ in 0..60 {
                let to = Point::new(chance.between(-2.7, 2.7), chance.between(-1.8, 1.8));
                game.world.ball = crate::four_legged::world::LeggedBall::at(to);
                for _ in 0..50 {
                    game.run(DT);
                    let (place, home) = (game.pose().position, role.home(p));
                    assert!(place.distance(home.nearest(place)) < 0.01, "{role:?} at {place:?}");
                }
            }
        }
    }
}
