//! `opponents`: scripted opponents of paper 1. Ros et al. 2009 §5.1.2: each has a home region that it never
//! leaves; it walks to a ball inside that region and clears it, else it stands at the region's border nearest
//! the ball and faces it; a ball in its grasp there is cleared as well. m, s, field frame.
//!
//! They have the attackers' bodies and abilities: they walk, grab (which may fail), turn with the ball and
//! kick. **Clearance** (§5.1.2 "clears it", §5.3.1 "from its defending zone"): away from their own goal,
//! along a corridor without a robot, to a place within the lines, as a ball over a line is the other team's;
//! of the kicks that do so, the one that gains most. Without one they turn, the least that makes a hard kick
//! do so, and after the league's 3 s of holding they kick in whichever direction points most upfield. The
//! same rule against every approach. They see the true state, as in the paper's simulator; in the robots'
//! profile they act on a sight of the ball and on a localisation with errors (R40: "he may believe that the
//! ball is within his home region", §5.4), which they also report (§5.3).

use geometry::{Angle, Body, Field, Point, Pose, Segment, Twist, Vector, math};
use protocol::robot_io::{ActuatorFrame, LeggedKick, LeggedPrimitive};
use rules::League;
use serde::Deserialize;

use crate::four_legged::drift::Drift;
use crate::four_legged::parameters::{Noise, Parameters, Region};
use crate::four_legged::world::LeggedWorld;
use crate::rng::Stream;

geometry::labels! {
    /// Task of an opponent.
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
    /// The opponent plays from its role's home.
    #[default]
    AtHome,
    /// The opponent plays from this region instead.
    Within(Region),
    /// The opponent stays where it is: an obstacle that clears no ball.
    Standing,
}

/// A scripted opponent with its region.
#[derive(Clone, Debug)]
pub struct Opponent {
    /// Role from which its home follows.
    pub role: OpponentRole,
    /// Index in [`LeggedWorld::walkers`].
    robot: usize,
    /// Region where it plays; `None` where it only stands.
    home: Option<Region>,
    /// Control steps since it has the ball.
    held: u32,
    /// Perception with errors; `None`: the true state.
    perception: Option<Perception>,
}

/// Errors of an opponent's perception.
#[derive(Clone, Debug)]
struct Perception {
    noise: Noise,
    chance: Stream,
    /// Of its own pose: x, y, heading.
    pose: [Drift; 3],
    /// Of its sight of the ball: range, bearing.
    ball: [Drift; 2],
}

impl Perception {
    fn step(&mut self) {
        for drift in self.pose.iter_mut().chain(&mut self.ball) {
            drift.step(&mut self.chance);
        }
    }

    /// Believed pose of a robot at `pose`.
    fn located(&self, pose: Pose<Field>) -> Pose<Field> {
        let [x, y, heading] = &self.pose;
        let off = Vector::new(x.value(), y.value()) * self.noise.localisation;
        let turned = Angle::degrees(heading.value() * self.noise.localisation_deg);
        Pose { position: pose.position + off, heading: pose.heading + turned }
    }

    /// Position of `ball` as a robot at `pose` sees it, in its body frame: it faces the ball and follows it
    /// with its eyes, so that it is always in view, and its estimate is as correlated as the gait's sway.
    fn sees(&self, pose: Pose<Field>, ball: Point<Field>) -> Point<Body> {
        let [ranged, aimed] = &self.ball;
        let range = pose.position.distance(ball);
        let pixel = Angle::degrees(self.noise.pixel_deg).radians();
        let size = 2.0 * League::FourLegged.ball().radius;
        let sigma = self.noise.range_floor + range * range * pixel / size;
        let range = (range + sigma * ranged.value()).max(0.0);
        let sway = Angle::degrees((self.noise.joint_deg + self.noise.sway_deg) * aimed.value());
        let seen = Vector::<Body>::polar(range, pose.turn_to(ball) + sway);
        Point::new(seen.x(), seen.y())
    }
}

impl Opponent {
    /// An opponent in its home region, or in the region its conduct names.
    pub fn new(role: OpponentRole, conduct: Conduct, robot: usize, parameters: &Parameters) -> Self {
        let home = match conduct {
            Conduct::AtHome => Some(role.home(parameters)),
            Conduct::Within(region) => Some(region),
            Conduct::Standing => None,
        };
        Self { role, robot, home, held: 0, perception: None }
    }

    /// The same opponent with errors of perception, if `noise` has any.
    #[must_use]
    pub fn with_noise(mut self, noise: Noise, seed: u64) -> Self {
        if !noise.is_none() {
            let mut chance = Stream::new(seed, &format!("eyes {}", self.robot));
            let pose = [(); 3].map(|()| Drift::new(noise.localisation_time, CONTROL_STEP, &mut chance));
            let ball = [(); 2].map(|()| Drift::new(noise.sway_time, CONTROL_STEP, &mut chance));
            self.perception = Some(Perception { noise, chance, pose, ball });
        }
        self
    }

    /// Advances its perception by a control step.
    pub fn perceive(&mut self) {
        if let Some(perception) = &mut self.perception {
            perception.step();
        }
    }

    /// The position that it reports.
    pub fn reported(&self, world: &LeggedWorld) -> Point<Field> {
        let pose = world.walkers[self.robot].pose;
        self.perception.as_ref().map_or(pose, |perception| perception.located(pose)).position
    }

    /// Decides and orders its body, in every control step.
    pub fn act(&mut self, world: &mut LeggedWorld, parameters: &Parameters) {
        let Some(home) = self.home else { return };
        let (mut ball, mut pose) = (world.ball.position, world.walkers[self.robot].pose);
        let mut grasps = world.in_grasp(self.robot);
        if let Some(perception) = &self.perception {
            let seen = perception.sees(pose, ball);
            // The legs close on a ball where the opponent sees it; whether it is slow enough shows in its
            // motion.
            grasps = world.in_grasp_at(self.robot, pose.to_field(seen));
            pose = perception.located(pose);
            ball = pose.to_field(seen);
        }
        self.held = if world.holder() == Some(self.robot) { self.held + 1 } else { 0 };
        let (walk, primitive) = if self.held > 0 {
            self.clear(world, pose, ball, parameters)
        } else {
            let primitive = if grasps { LeggedPrimitive::Grab } else { LeggedPrimitive::None };
            // At its home's border where the ball is outside, at the ball where it is inside: the same
            // expression.
            (walk_to(pose, home.nearest(ball), ball, parameters), primitive)
        };
        world.command(self.robot, &ActuatorFrame::Legged { walk, primitive });
    }

    /// Stands, and starts nothing: all robots have to stop.
    pub fn stand(&self, world: &mut LeggedWorld) {
        let order = ActuatorFrame::Legged { walk: Twist::default(), primitive: LeggedPrimitive::None };
        world.command(self.robot, &order);
    }

    /// With the ball: the kick that clears it, or the turn towards one.
    fn clear(
        &self,
        world: &LeggedWorld,
        pose: Pose<Field>,
        ball: Point<Field>,
        parameters: &Parameters,
    ) -> (Twist<Body>, LeggedPrimitive) {
        let kicks = world.nominal_kicks();
        let kick = |kick| (Twist::default(), LeggedPrimitive::Kick(kick));
        let at_ball = Pose { position: ball, ..pose };
        let clears = |heading: Angle, kick| {
            self.clears(world, ball, kick_end(Pose { heading, ..at_ball }, kick), parameters)
        };
        if let Some(best) =
            most_upfield(at_ball, kicks.into_iter().filter(|kick| clears(pose.heading, *kick)))
        {
            return kick(best);
        }
        let steps = (0..=TURNS_PER_SIDE).flat_map(|i| [TURN_STEP * i as f32, -TURN_STEP * i as f32]);
        let turn = steps.skip(1).find(|turn| clears(pose.heading + Angle::new(*turn), kicks[0]));
        match turn {
            Some(turn) if (self.held as f32) * CONTROL_STEP < parameters.opponent.clear.hold => {
                let rate = parameters.carry.turn;
                let angular = (GAZE_GAIN * turn).clamp(-rate, rate);
                (Twist { linear: Vector::default(), angular }, LeggedPrimitive::None)
            }
            _ => kick(most_upfield(at_ball, kicks.into_iter()).unwrap_or(LeggedKick::ForwardHard)),
        }
    }

    /// True where a kick from `ball` to `end` leaves the own goal, meets no robot at once, and stays in the
    /// field.
    fn clears(
        &self,
        world: &LeggedWorld,
        ball: Point<Field>,
        end: Point<Field>,
        parameters: &Parameters,
    ) -> bool {
        let clear = &parameters.opponent.clear;
        let field = League::FourLegged.field();
        let Some(along) = (end - ball).unit() else { return false };
        let start = Segment::new(ball, ball + along * clear.corridor);
        let body = League::FourLegged.robot().radius + League::FourLegged.ball().radius;
        let blocks = |at: Point<Field>| (at - ball).dot(along) > 0.0 && start.distance_to(at) < body;
        let others = world.walkers.iter().enumerate().filter(|(index, _)| *index != self.robot);
        end.x() < ball.x()
            && field.clamp(end, clear.inside).distance(end) == 0.0
            && !others.map(|(_, walker)| walker.pose.position).any(blocks)
    }
}

/// A kick with its direction relative to the body and its length, m.
type NominalKick = (LeggedKick, Angle, f32);

/// Stop position of a ball kicked from `at` by a robot of that heading.
fn kick_end(at: Pose<Field>, (_, off, length): NominalKick) -> Point<Field> {
    at.position + Vector::polar(length, at.heading + off)
}

/// The kick from `at` that ends farthest upfield, towards −x; of equal ones the first.
fn most_upfield(at: Pose<Field>, kicks: impl Iterator<Item = NominalKick>) -> Option<LeggedKick> {
    let upfield = |kick: &NominalKick| at.position.x() - kick_end(at, *kick).x();
    kicks.reduce(|best, next| if upfield(&next) > upfield(&best) { next } else { best }).map(|best| best.0)
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

/// A control step, s (docs/architecture.md §2.3: four-legged, every 40 ms).
const CONTROL_STEP: f32 = 0.04;
/// Directions tried for a turn before a clearance: every 15°, half a turn to either side.
const TURN_STEP: f32 = math::PI / TURNS_PER_SIDE as f32;
/// Number of turns that are tried to one side.
const TURNS_PER_SIDE: u32 = 12;
/// Turning rate for an error of 1 rad, 1/s: three time constants in 0.75 s, well damped at 4 rad/s² and steps
/// of 40 ms.
const GAZE_GAIN: f32 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::four_legged::world::{Side, Walker, WorldEvent};

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
    fn with_the_ball_outside_an_opponent_faces_it_from_its_border() {
        let mut game = game(OpponentRole::Defender, (1500.0, 300.0), (-1.0, 0.5));
        game.run(8.0);
        assert!(game.pose().position.distance(Point::new(0.9, 0.5)) < 0.01, "{:?}", game.pose());
        assert!(game.pose().turn_to(Point::new(-1.0, 0.5)).abs() < 0.01);
        assert!(game.events.is_empty());
    }

    #[test]
    fn a_ball_in_the_home_region_is_kicked_upfield() {
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

    /// Ends of the clearances of 60 opponents that stand at `at` in that heading, with a robot at `beside`.
    fn clearances(at: (f32, f32), heading: f32, beside: Option<(f32, f32)>) -> Vec<Point<Field>> {
        let p = Parameters::four_legged();
        let pose = Pose::from_mm_deg(at.0 * 1000.0, at.1 * 1000.0, heading);
        let mut walkers = vec![Walker::at(Side::Opponents, pose)];
        let beside = beside.map(|(x, y)| Pose::from_mm_deg(x * 1000.0, y * 1000.0, 0.0));
        walkers.extend(beside.map(|pose| Walker::at(Side::Attackers, pose)));
        let ends = (0..60).filter_map(|seed| {
            let ball = pose.to_field(Point::new(0.13, 0.0));
            let mut game = Game {
                world: LeggedWorld::new(p, seed, ball, walkers.clone()),
                opponent: Opponent::new(OpponentRole::Defender, Conduct::AtHome, 0, p),
                events: Vec::new(),
            };
            game.run(5.0);
            game.events.iter().find_map(|event| match event {
                WorldEvent::Kicked { rest, .. } => Some(*rest),
                _ => None,
            })
        });
        ends.collect()
    }

    #[test]
    fn a_clearance_goes_away_from_the_own_goal_and_stays_in_the_field() {
        let field = rules::League::FourLegged.field();
        // Facing upfield, beside the side line facing it, and turned to the own goal.
        for (at, heading) in [((1.4, 0.0), 180.0), ((1.4, 1.45), 90.0), ((1.5, -1.2), -60.0)] {
            let ends = clearances(at, heading, None);
            assert!(ends.len() > 50, "{at:?}: {}", ends.len());
            let inside = ends.iter().filter(|end| field.contains(**end)).count();
            let upfield = ends.iter().filter(|end| end.x() < at.0).count();
            // The scatter of a kick puts a few out.
            assert!(inside * 10 >= ends.len() * 9, "{at:?}: {inside} of {}", ends.len());
            assert!(upfield * 10 >= ends.len() * 9, "{at:?}: {upfield} of {}", ends.len());
        }
    }

    #[test]
    fn a_clearance_avoids_a_robot_that_stands_in_its_path() {
        let free = clearances((1.4, 0.0), 180.0, None);
        let straight = free.iter().filter(|end| end.y().abs() < 0.45).count();
        // 2.15 m at 10° scatter by 0.37 m.
        assert!(straight * 10 >= free.len() * 6, "{straight} of {}", free.len());
        let blocked = clearances((1.4, 0.0), 180.0, Some((1.1, 0.0)));
        let straight = blocked.iter().filter(|end| end.y().abs() < 0.45 && end.x() < 0.0).count();
        assert!(blocked.len() > 50 && straight * 10 < blocked.len(), "{straight} of {}", blocked.len());
    }

    #[test]
    fn conduct_decides_whether_an_opponent_stands_or_which_region_it_keeps() {
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
    fn noise_makes_the_reported_position_drift_and_the_ball_seem_at_home() {
        let p = Parameters::four_legged();
        // A ball 5 cm before the goalie's home: without noise it stays out of reach of it.
        let goes = |noise: Noise, seed| {
            let mut game = game(OpponentRole::Goalie, (2300.0, 0.0), (1.99, 0.0));
            game.opponent = game.opponent.with_noise(noise, seed);
            let mut worst = 0.0_f32;
            let mut reported = Vec::new();
            for _ in 0..250 {
                game.opponent.perceive();
                game.run(DT);
                worst = worst.max(2.05 - game.pose().position.x());
                reported.push(game.opponent.reported(&game.world) - game.pose().position);
            }
            (worst, reported)
        };
        assert!((0..10).all(|seed| goes(Noise::NONE, seed).0 < 0.01));
        let outside = (0..20).filter(|&seed| goes(p.noise, seed).0 > 0.05).count();
        assert!(outside > 5, "{outside} of 20");
        let reported: Vec<_> = (0..40).flat_map(|seed| goes(p.noise, seed).1).collect();
        let squares: f32 = reported.iter().map(|off| off.x() * off.x()).sum();
        let sigma = math::sqrt(squares / reported.len() as f32);
        assert!((sigma - p.noise.localisation).abs() < 0.25 * p.noise.localisation, "{sigma}");
    }

    #[test]
    fn opponents_never_leave_their_home_regions() {
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
