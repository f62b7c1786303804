//! `danger`: second-level threats (Biswas et al. 2014 §5.2): two positions each, and their ranking. Attack
//! frame, m, s, rad.

use core::cmp::Ordering;

use geometry::{Attack, Point};
use motion::ball::BallModel;
use protocol::RobotId;

use super::super::view::{HAS_BALL_WITHIN_M, ROBOTS_MAX, View, ViewRobot};
use super::angle::{BODY, Opening, widest};
use super::cover::Cover;
use super::edge::Edge;
use super::receiving::{Because, FirstLevel};
use super::{Memory, SHOT_SPEED_M_S, ThreatSettings, legal};

/// Passes arrive with this speed, m/s, at which a receiver can shoot at once.
const PASS_ARRIVAL_M_S: f32 = 2.5;

/// An opponent as a second-level threat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Danger {
    /// Number of the opponent.
    pub opponent: RobotId,
    /// Place of the opponent, attack frame, m.
    pub at: Point<Attack>,
    /// Whether it is near to our side.
    pub near: bool,
    /// The widest gap to our goal that keeper and primaries at their places leave it, rad.
    pub open: f32,
    /// Time until it could have shot: the pass to it and the shot, s.
    pub time_to_shoot: f32,
}

/// Ball that a defender's position blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blocks {
    /// On the line from the opponent to the middle of our goal.
    Shot,
    /// Halfway between the opponent and the first-level threat.
    Pass,
}

/// A position to be given to a defender.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// The second-level threat that it blocks.
    pub danger: Danger,
    /// Whether the shot is blocked, or the pass.
    pub blocks: Blocks,
    /// Bonus of a position that a robot has already, as shares of the settings' worths.
    held: f32,
}

/// The second-level threats, by number; `memory` lists those that were near.
pub fn dangers(
    view: &View,
    threat: &FirstLevel,
    cover: &Cover,
    memory: &mut Memory,
    settings: &ThreatSettings,
) -> heapless::Vec<Danger, ROBOTS_MAX> {
    let mut near = super::RobotSet::default();
    let holder = holder(view, threat);
    let mut dangers = heapless::Vec::new();
    for robot in &view.theirs {
        let limit = settings.near + if memory.near.has(robot.id) { settings.near_hold } else { 0.0 };
        let is_near = robot.position.x() < limit;
        if is_near {
            near.insert(robot.id);
        }
        let keeper_at_home = robot.id == view.their_keeper && robot.position.x() > view.field.length * 0.25;
        if threat.receiver() == Some(robot.id) || holder == Some(robot.id) || keeper_at_home {
            continue;
        }
        // At most one per robot.
        let danger = Danger { near: is_near, ..danger(view, threat.at, cover, robot) };
        let _ = dangers.push(danger);
    }
    memory.near = near;
    dangers
}

/// The opponent that has the ball: it is the first-level threat by the ball's place.
fn holder(view: &View, threat: &FirstLevel) -> Option<RobotId> {
    let at_ball = super::super::view::nearest(view.theirs.iter(), view.ball?.position);
    at_ball
        .filter(|(_, off)| threat.because == Because::Ball && *off < HAS_BALL_WITHIN_M)
        .map(|(robot, _)| robot.id)
}

/// The danger of one opponent, before it is known whether it is near.
fn danger(view: &View, threat: Point<Attack>, cover: &Cover, robot: &ViewRobot) -> Danger {
    let (at, goal) = (robot.position, view.our_goal());
    let opening = Opening::of(at, goal, view.field.goal_width);
    let bodies = cover.primaries.iter().copied().chain([cover.keeper]);
    let gaps = opening.gaps(bodies, f32::INFINITY);
    Danger {
        opponent: robot.id,
        at,
        near: false,
        open: widest(&gaps),
        time_to_shoot: time_to_shoot(threat.distance(at), at.distance(goal)),
    }
}

/// Passing time plus shot time, s: a pass that arrives with 2.5 m/s, a shot of 6.2 m/s.
pub fn time_to_shoot(pass: f32, shot: f32) -> f32 {
    let model = BallModel::default();
    let time = |speed: f32, travel: f32| {
        let velocity = geometry::Vector::<Attack>::new(speed, 0.0);
        model.kicked(Point::default(), velocity).time_to(travel).unwrap_or(f32::INFINITY)
    };
    time(model.kick_speed(pass, PASS_ARRIVAL_M_S).min(SHOT_SPEED_M_S), pass) + time(SHOT_SPEED_M_S, shot)
}

/// On the line from our goal's middle to the opponent, as far out as our robot can react to its start in time
/// ([`share`]), off its body, and out of our area. With it the share of the distance.
pub fn block_shot(view: &View, opponent: Point<Attack>, settings: &ThreatSettings) -> (Point<Attack>, f32) {
    let (goal, travel) = (view.our_goal(), opponent - view.our_goal());
    let length = travel.norm().max(settings.clear);
    let share = share(settings).min(1.0 - settings.clear / length).max(0.0);
    let at = goal + travel * share;
    let edge = Edge::of(&view.field, settings.off_area);
    if edge.distance_to(at) >= 0.0 {
        return (legal(view, at, settings), share);
    }
    let at = edge.crossing(goal, travel);
    (legal(view, at, settings), at.distance(goal) / length)
}

/// The greatest share k of the distance from goal to opponent at which our robot still is in the line when
/// the opponent starts sideways with a_o: it has to move k·a_o·t²/2, and moves a_d·(t − τ)²/2. The greatest
/// lag, k·a_o·a_d·τ²/(2 (a_d − k·a_o)), is a body's half width r for k = r / (a_o·(τ²/2 + r/a_d)). Never
/// beyond the opponent.
pub fn share(settings: &ThreatSettings) -> f32 {
    let ThreatSettings { acceleration: a, latency: tau, .. } = *settings;
    let r = BODY;
    (r / (a * (0.5 * tau * tau + r / a))).min(1.0)
}

/// Positions against every danger, two each, best first: near opponents, then shots before passes, then the
/// larger open angle (all above a limit alike), then the sooner shot; then by number.
pub fn ranked(
    dangers: &[Danger],
    held: impl Fn(RobotId, Blocks) -> bool,
    settings: &ThreatSettings,
) -> heapless::Vec<Position, { 2 * ROBOTS_MAX }> {
    let mut positions: heapless::Vec<Position, { 2 * ROBOTS_MAX }> = heapless::Vec::new();
    for danger in dangers {
        for blocks in [Blocks::Shot, Blocks::Pass] {
            let held = if held(danger.opponent, blocks) { 1.0 } else { 0.0 };
            // Two for each danger fit.
            let _ = positions.push(Position { danger: *danger, blocks, held });
        }
    }
    positions.sort_unstable_by(|a, b| a.compare(b, settings));
    positions
}

impl Position {
    /// Place for the defender's centre against that first-level threat, m.
    pub fn place(&self, view: &View, threat: Point<Attack>, settings: &ThreatSettings) -> Point<Attack> {
        let at = self.danger.at;
        match self.blocks {
            Blocks::Shot => block_shot(view, at, settings).0,
            Blocks::Pass => legal(view, at + (threat - at) * 0.5, settings),
        }
    }

    fn compare(&self, other: &Self, settings: &ThreatSettings) -> Ordering {
        let open = |p: &Self| (p.danger.open + p.held * settings.open_worth).min(settings.open_enough);
        let time = |p: &Self| p.danger.time_to_shoot - p.held * settings.time_worth;
        let near = other.danger.near.cmp(&self.danger.near);
        near.then(self.blocks.cmp(&other.blocks))
            .then(open(other).total_cmp(&open(self)))
            .then(time(self).total_cmp(&time(other)))
            .then(self.danger.opponent.cmp(&other.danger.opponent))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use geometry::math;

    #[test]
    fn the_share_of_the_path_is_the_largest_that_keeps_the_robot_on_the_line() {
        // Python: .1115 / (4 * (.1**2/2 + .1115/4)) = 0.8479
        let settings = ThreatSettings::default();
        let k = share(&settings);
        assert!((k - 0.847_908_7).abs() < 1e-5, "{k}");
        // Simulated motion of both: with k the greatest lag is a body's half width, with a greater share it
        // is more.
        let lag = |k: f32| {
            let a = settings.acceleration;
            let lag = |i: i32| {
                let t = i as f32 * 1e-4;
                let ours = (t - settings.latency).max(0.0);
                k * a * t * t * 0.5 - a * ours * ours * 0.5
            };
            (0..20_000).map(lag).fold(0.0, f32::max)
        };
        assert!((lag(k) - BODY).abs() < 1e-4, "{}", lag(k));
        assert!(lag(k + 0.02) > BODY + 0.01);
        let slow = ThreatSettings { latency: 0.0, ..settings };
        assert_eq!(share(&slow), 1.0, "who needs no time can stand at the opponent");
    }

    #[test]
    fn the_two_positions_are_on_the_line_to_our_goal_and_half_way_to_the_ball() {
        let view = view((0.0, 2.0), &[], &[(0.0, -2.0)]);
        let settings = ThreatSettings::default();
        let mut memory = Memory::default();
        let threat = FirstLevel { at: Point::new(0.0, 2.0), because: Because::Ball };
        let cover = super::super::cover::cover(&view, threat.at, 2, None, &settings);
        let found = dangers(&view, &threat, &cover, &mut memory, &settings);
        let [danger] = found[..] else { panic!("{found:?}") };
        let places = ranked(&[danger], |_, _| false, &settings);
        let [shot, pass] = [0, 1].map(|n| places[n].place(&view, threat.at, &settings));
        assert!(pass.distance(Point::new(0.0, 0.0)) < 1e-5);
        // 0.8479 of the distance from (−4.5, 0) to (0, −2).
        assert!(shot.distance(Point::new(-0.684_411, -1.695_817)) < 1e-4, "{danger:?}");
        assert!((block_shot(&view, danger.at, &settings).1 - 0.847_908_7).abs() < 1e-5);
    }

    #[test]
    fn near_an_opponent_the_defender_stays_off_it_and_out_of_our_area() {
        let settings = ThreatSettings::default();
        let view = view((0.0, 0.0), &[], &[]);
        // 1.3 m before the goal: the edge (1.13 m) is the farthest place allowed.
        let (at, _) = block_shot(&view, Point::new(-3.2, 0.0), &settings);
        assert!(at.distance(Point::new(-3.37, 0.0)) < 1e-4, "{at:?}");
        // 1.5 m: 0.25 m off.
        let (at, share) = block_shot(&view, Point::new(-3.0, 0.0), &settings);
        assert!(at.distance(Point::new(-3.25, 0.0)) < 1e-4 && (share - 1.25 / 1.5).abs() < 1e-4, "{at:?}");
    }

    #[test]
    fn a_pass_of_two_metres_and_a_shot_of_three_take_their_times() {
        // Python, slide 3.9 to 5/7, roll 0.35: pass at kick_speed(2, 2.5) = 3.7155 m/s takes 0.7119 s, shot
        // at 6.2 takes 0.5873 s.
        let time = time_to_shoot(2.0, 3.0);
        assert!((time - PASS_AND_SHOT).abs() < 1e-3, "{time}");
    }
    const PASS_AND_SHOT: f32 = 1.299_194_6;

    fn made(n: u8, near: bool, open: f32, time_to_shoot: f32) -> Danger {
        let at = Point::new(0.0, f32::from(n));
        Danger { opponent: RobotId::new(n).unwrap(), at, near, open, time_to_shoot }
    }

    #[test]
    fn positions_are_ranked_by_the_papers_four_criteria_in_order() {
        let settings = ThreatSettings::default();
        let dangers = [
            made(0, false, 0.17, 0.5), // far, however open
            made(1, true, 0.05, 1.0),  // near, little open
            made(2, true, 0.30, 2.0),  // near, wide open, late
            made(3, true, 0.20, 1.5),  // near, equal to wide open, sooner
        ];
        let order = |held: &dyn Fn(RobotId, Blocks) -> bool| {
            let ranked = ranked(&dangers, held, &settings);
            ranked.iter().map(|p| (p.danger.opponent.number(), p.blocks)).collect::<Vec<_>>()
        };
        use Blocks::{Pass, Shot};
        let papers = [(3, Shot), (2, Shot), (1, Shot), (3, Pass), (2, Pass), (1, Pass), (0, Shot), (0, Pass)];
        assert_eq!(order(&|_, _| false), papers);
        // A position that a robot has counts slightly more, and no more than that.
        assert_eq!(order(&|id, _| id.number() == 1), papers);
        let close = [made(1, true, 0.100, 1.0), made(2, true, 0.099, 1.0)];
        let first =
            |held: u8| ranked(&close, |id, _| id.number() == held, &settings)[0].danger.opponent.number();
        assert_eq!((first(0), first(1), first(2)), (1, 1, 2));
    }

    #[test]
    fn the_widest_gap_is_what_keeper_and_primaries_leave() {
        let view = view((-1.0, 0.0), &[], &[(-2.0, 2.0)]);
        let settings = ThreatSettings::default();
        let threat = FirstLevel { at: Point::new(-1.0, 0.0), because: Because::Ball };
        let cover = super::super::cover::cover(&view, threat.at, 2, None, &settings);
        let found = dangers(&view, &threat, &cover, &mut Memory::default(), &settings);
        let whole = Opening::of(Point::new(-2.0, 2.0), view.our_goal(), 1.0).angle();
        assert!(found[0].open > 0.0 && found[0].open < whole && whole < math::FRAC_PI_2, "{found:?}");
    }
}
