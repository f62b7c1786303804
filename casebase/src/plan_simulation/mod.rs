//! `plan_simulation`: simulation of a case's plan: the ball's path when its gameplays are played as written
//! (docs/case-format.md §3.1; paper §3.3.1).
//!
//! The gameplays are simulated symbolically: which robot holds the ball, where each robot is, which legs the
//! ball runs. The same simulation checks a case when a library is built, computes the legs that are stored
//! with it, and gives the robots at run time the actions that hand the ball over. Positions are relative to
//! the ball's start position, mm, axes of the field; the attacked goal is a fixed point of the field.

use geometry::math;

use crate::action::{Action, CaseKick, CaseRobot, FieldMm, KickAim, KickId, Pass, TEAMMATES_MAX};
use crate::leg::LegKind;
use crate::table::CaseBase;
use crate::{GoalEnd, PointMm};

/// A case to be simulated, in its own coordinates.
pub trait Script {
    /// Number of robots, 1 to 4.
    fn teammates(&self) -> usize;
    /// The goal defended: headings are relative to the direction of attack.
    fn defending(&self) -> GoalEnd;
    /// The ball's start position.
    fn ball(&self) -> PointMm;
    /// A robot's start position.
    fn position(&self, robot: CaseRobot) -> PointMm;
    /// A robot's action, `None` behind the last.
    fn action(&self, robot: CaseRobot, index: usize) -> Option<Action>;
}

/// The league's parameters of kicked balls.
pub trait Kicks {
    /// The kick kind with this id; `None` if unknown.
    fn kick(&self, id: KickId) -> Option<CaseKick>;
    /// The radii of passes.
    fn pass(&self) -> Pass;
    /// Dimensions of the league's field, mm.
    fn field(&self) -> FieldMm;
}

impl Kicks for CaseBase<'_> {
    fn kick(&self, id: KickId) -> Option<CaseKick> {
        self.kick(id)
    }
    fn pass(&self) -> Pass {
        self.pass()
    }
    fn field(&self) -> FieldMm {
        self.field()
    }
}

/// Simulates the gameplays and passes every step to `sink`, in the order of play.
pub fn plan_simulation(
    script: &impl Script,
    kicks: &impl Kicks,
    sink: impl FnMut(PlanStep),
) -> Result<(), PlanError> {
    let getter = CaseRobot::first(script.teammates())
        .find(|robot| script.action(*robot, 0) == Some(Action::GetBall))
        .ok_or(PlanError::NoGetter)?;
    let places = core::array::from_fn(|i| {
        let position = CaseRobot::new(i).map_or(PointMm::new(0, 0), |robot| script.position(robot));
        Spot::relative(position.minus(script.ball()))
    });
    let ball = Spot::relative(PointMm::new(0, 0));
    let mut walker = Walker { script, kicks, sink, next: [0; TEAMMATES_MAX], places, ball, carried: None };
    let mut holder = Some(getter);
    while let Some(robot) = holder {
        holder = walker.play(robot)?;
    }
    walker.leftovers()
}

/// A position in the simulation, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// x and y, axes of the field.
    pub at: [f32; 2],
    /// True for a fixed point of the field; else the position is relative to the ball's start.
    pub on_field: bool,
}

impl Spot {
    /// The position in the field frame, mm, for a ball that starts at `ball`.
    pub fn in_field(&self, ball: PointMm) -> [f32; 2] {
        let [x, y] = if self.on_field { [0.0; 2] } else { ball.to_f32() };
        [self.at[0] + x, self.at[1] + y]
    }

    fn relative(displacement: PointMm) -> Self {
        Self { at: displacement.to_f32(), on_field: false }
    }
}

/// An event of the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanStep {
    /// The ball runs along a leg.
    Leg {
        /// The case robot that passes or kicks.
        robot: CaseRobot,
        /// Number of that action in the kicker's gameplay.
        action: usize,
        /// Start of the leg, mm; relative to the ball unless on the field.
        from: Spot,
        /// Stop position of the ball, mm; relative to its start unless on the field.
        to: Spot,
        /// r_min and r_max, mm.
        radii: [i32; 2],
        /// Action that sends the ball: a pass or a kick.
        kind: LegKind,
        /// The `dribble_to` that carried it to `from` after the leg before.
        carried_by: Option<(CaseRobot, usize)>,
    },
    /// The ball goes from one robot to another.
    HandOver(HandOver),
    /// No kick ever hands the ball to this `get_ball`.
    NeverReached {
        /// The case robot that waits for the ball.
        robot: CaseRobot,
        /// Number of the `get_ball`.
        action: usize,
    },
}

impl PlanStep {
    /// The hand-over, if it is one.
    pub const fn hand_over(self) -> Option<HandOver> {
        if let Self::HandOver(hand_over) = self { Some(hand_over) } else { None }
    }
}

/// A hand-over of the ball: giving and receiving robot, each with the number of the action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HandOver {
    /// The `pass_ball` or `kick`.
    pub from: (CaseRobot, usize),
    /// The `receive_ball` or `get_ball`.
    pub to: (CaseRobot, usize),
    /// True for a pass, false for a kick.
    pub by_pass: bool,
}

/// Reason why gameplays cannot be simulated, with the robot and its action (from 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanError {
    /// No robot's first action is `get_ball`.
    #[error("no robot begins with get_ball")]
    NoGetter,
    /// A robot without the ball should dribble, pass or kick it.
    #[error("{0} does not hold the ball at its action {n}", n = .1 + 1)]
    NotHolding(CaseRobot, usize),
    /// The robot that is passed to never comes to receive this pass.
    #[error("{0} passes to a robot that does not receive it at its action {n}", n = .1 + 1)]
    PassUnanswered(CaseRobot, usize),
    /// The pass for which a robot waits is never played.
    #[error("{0} waits for a pass that no robot plays at its action {n}", n = .1 + 1)]
    ReceiveUnanswered(CaseRobot, usize),
    /// The league has no such kick kind.
    #[error("{0} uses a kick the league does not define at its action {n}", n = .1 + 1)]
    UnknownKick(CaseRobot, usize),
}

/// The state of a simulation: each robot's progress in its list and position, and the ball's position.
struct Walker<'s, S, K, F> {
    script: &'s S,
    kicks: &'s K,
    sink: F,
    next: [usize; TEAMMATES_MAX],
    places: [Spot; TEAMMATES_MAX],
    ball: Spot,
    carried: Option<(CaseRobot, usize)>,
}

impl<S: Script, K: Kicks, F: FnMut(PlanStep)> Walker<'_, S, K, F> {
    /// Plays the holder's actions until the ball leaves it; returns the next holder, `None` where there is
    /// none.
    fn play(&mut self, robot: CaseRobot) -> Result<Option<CaseRobot>, PlanError> {
        let mine = robot.index();
        while let Some(action) = self.script.action(robot, self.next[mine]) {
            let index = self.next[mine];
            self.next[mine] += 1;
            match action {
                Action::Wait | Action::Turn(_) => {}
                Action::GoToPoint(point) => self.places[mine] = self.spot(point),
                Action::GetBall => self.places[mine] = self.ball,
                Action::DribbleTo(point) => {
                    self.ball = self.spot(point);
                    self.places[mine] = self.ball;
                    self.carried = Some((robot, index));
                }
                Action::ReceiveBall(_) => return Err(PlanError::ReceiveUnanswered(robot, index)),
                Action::PassBall(receiver) => return self.pass(robot, index, receiver).map(Some),
                Action::Kick(id) => {
                    let kick = self.kicks.kick(id).ok_or(PlanError::UnknownKick(robot, index))?;
                    let end = self.kick_end(kick.aim);
                    self.leg(robot, index, end, [kick.r_min, kick.r_max], LegKind::Kick(id));
                    return Ok(self.chaser((robot, index)));
                }
            }
        }
        Ok(None)
    }

    /// The receiver advances to the `receive_ball` that answers this pass; the ball runs to it.
    fn pass(&mut self, robot: CaseRobot, index: usize, receiver: CaseRobot) -> Result<CaseRobot, PlanError> {
        let theirs = receiver.index();
        if receiver == robot || theirs >= self.script.teammates() {
            return Err(PlanError::PassUnanswered(robot, index));
        }
        let action = self.walk_on(receiver);
        let there = self.next[theirs];
        match action {
            Some(Action::ReceiveBall(from)) if from == robot => {}
            Some(Action::DribbleTo(_) | Action::PassBall(_) | Action::Kick(_)) => {
                return Err(PlanError::NotHolding(receiver, there));
            }
            _ => return Err(PlanError::PassUnanswered(robot, index)),
        }
        let Pass { r_min, r_max } = self.kicks.pass();
        self.leg(robot, index, self.places[theirs], [r_min, r_max], LegKind::Pass(receiver));
        let (from, to) = ((robot, index), (receiver, there));
        (self.sink)(PlanStep::HandOver(HandOver { from, to, by_pass: true }));
        self.next[theirs] += 1;
        Ok(receiver)
    }

    /// The lowest-numbered robot whose next ball action is `get_ball`, advanced to that action.
    fn chaser(&mut self, from: (CaseRobot, usize)) -> Option<CaseRobot> {
        let mut robots = CaseRobot::first(self.script.teammates());
        let robot = robots.find(|robot| self.next_ball_action(*robot) == Some(Action::GetBall))?;
        self.walk_on(robot);
        let to = (robot, self.next[robot.index()]);
        (self.sink)(PlanStep::HandOver(HandOver { from, to, by_pass: false }));
        Some(robot)
    }

    /// The robot's next action that concerns the ball.
    fn next_ball_action(&self, robot: CaseRobot) -> Option<Action> {
        let mut actions = (self.next[robot.index()]..).map_while(|index| self.script.action(robot, index));
        actions.find(|action| action.concerns_ball())
    }

    /// Advances a robot without the ball to its next ball action, and returns it.
    fn walk_on(&mut self, robot: CaseRobot) -> Option<Action> {
        let mine = robot.index();
        loop {
            let action = self.script.action(robot, self.next[mine])?;
            if action.concerns_ball() {
                return Some(action);
            }
            if let Action::GoToPoint(point) = action {
                self.places[mine] = self.spot(point);
            }
            self.next[mine] += 1;
        }
    }

    /// The ball runs to `to`.
    fn leg(&mut self, robot: CaseRobot, action: usize, to: Spot, radii: [i32; 2], kind: LegKind) {
        let (from, carried_by) = (self.ball, self.carried.take());
        (self.sink)(PlanStep::Leg { robot, action, from, to, radii, kind, carried_by });
        self.ball = to;
    }

    /// End of a kick from the ball's position.
    fn kick_end(&self, aim: KickAim) -> Spot {
        let sign = self.script.defending().attack_sign();
        match aim {
            KickAim::Heading { degrees, length_mm } => {
                let [x, y] = unit_of_degrees(degrees);
                let forward = length_mm as f32 * sign as f32;
                let at = [self.ball.at[0] + forward * x, self.ball.at[1] + forward * y];
                Spot { at, on_field: self.ball.on_field }
            }
            KickAim::Goal { offset_mm } => {
                let goal_line = self.kicks.field().length as f32 / 2.0;
                Spot { at: [goal_line * sign as f32, (offset_mm as f32) * sign as f32], on_field: true }
            }
        }
    }

    /// Checks the remaining actions when the ball has stopped for the last time: none may need it.
    fn leftovers(&mut self) -> Result<(), PlanError> {
        for robot in CaseRobot::first(self.script.teammates()) {
            let first = self.next[robot.index()];
            for index in first.. {
                match self.script.action(robot, index) {
                    None => break,
                    Some(Action::Wait | Action::Turn(_) | Action::GoToPoint(_)) => {}
                    Some(Action::GetBall) => (self.sink)(PlanStep::NeverReached { robot, action: index }),
                    Some(Action::ReceiveBall(_)) => return Err(PlanError::ReceiveUnanswered(robot, index)),
                    Some(Action::DribbleTo(_) | Action::PassBall(_) | Action::Kick(_)) => {
                        return Err(PlanError::NotHolding(robot, index));
                    }
                }
            }
        }
        Ok(())
    }

    fn spot(&self, point: PointMm) -> Spot {
        Spot::relative(point.minus(self.script.ball()))
    }
}

/// (cos, sin) of whole degrees, exact at quarter turns and equal in size left and right.
fn unit_of_degrees(degrees: i32) -> [f32; 2] {
    let turn = degrees.rem_euclid(360);
    let (quarter, rest) = (turn / 90, turn % 90);
    // From 45° on the complement is used, so that mirrored headings use the same two numbers.
    let small = |d: i32| math::sin_cos(d as f32 * (math::PI / 180.0));
    let (sin, cos) = match rest {
        45 => (core::f32::consts::FRAC_1_SQRT_2, core::f32::consts::FRAC_1_SQRT_2),
        0..45 => small(rest),
        _ => {
            let (sin, cos) = small(90 - rest);
            (cos, sin)
        }
    };
    match quarter {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

#[cfg(test)]
mod tests;
