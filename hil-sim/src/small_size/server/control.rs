//! `control`: simulator control. Teleports and the simulation's speed, port 10300; m, m/s, rad.
//!
//! Fields that a message leaves out stay unchanged.

use geometry::{Angle, Point, Pose, Vector};
use protocol::{RobotId, Who};
use rules::Colour;
use ssl::common::Team;
use ssl::simulation::{SimulatorCommand, SimulatorControl, TeleportBall, TeleportRobot};

use super::{Refusal, SPEED_MAX, Server};
use crate::small_size::Ball;

impl Server {
    /// Carries out a command of port 10300; returns what could not be done.
    pub(super) fn steer(&mut self, command: &SimulatorCommand) -> Vec<Refusal> {
        let mut refused = Vec::new();
        // Settings first: teleports refer to the new field.
        if let Some(config) = &command.config {
            self.configure(config, &mut refused);
        }
        if let Some(control) = &command.control {
            self.control(control, &mut refused);
        }
        refused
    }

    fn control(&mut self, control: &SimulatorControl, refused: &mut Vec<Refusal>) {
        for teleport in &control.teleport_robot {
            if let Err(refusal) = self.teleport_robot(teleport, refused) {
                refused.push(refusal);
            }
        }
        // After the robots: a ball moves robots off its position where they stand then.
        if let Some(teleport) = &control.teleport_ball {
            self.teleport_ball(teleport, refused);
        }
        if let Some(pace) = control.simulation_speed {
            if (0.0..=SPEED_MAX).contains(&pace) {
                self.pace = pace;
            } else {
                refused.push(Refusal::Pace(pace));
            }
        }
    }

    pub(super) fn teleport_ball(&mut self, asked: &TeleportBall, refused: &mut Vec<Refusal>) {
        let compatibility = self.cameras.settings().compatibility;
        let numbers = [asked.x, asked.y, asked.z, asked.vx, asked.vy, asked.vz];
        if numbers.into_iter().flatten().any(|number| !number.is_finite()) {
            refused.push(Refusal::NotANumber("teleport_ball"));
            return;
        }
        let by_force = asked.by_force.unwrap_or(false);
        if !compatibility.partial
            && let Some(refusal) = partial_ball(asked)
        {
            refused.push(refusal);
            return;
        }
        let before = self.world.ball;
        let here = self.world.ball_pulled_to().filter(|_| by_force).unwrap_or(before.position);
        let to = Point::new(asked.x.unwrap_or(here.x()), asked.y.unwrap_or(here.y()));
        let height = asked.z.unwrap_or(before.height);
        if !self.in_hall(to) || !(0.0..=HALL_HEIGHT).contains(&height) {
            refused.push(Refusal::OutsideHall("teleport_ball"));
            return;
        }
        if by_force {
            if asked.z.is_some_and(|z| z > 0.0) {
                refused.push(Refusal::Unsupported("teleport_ball.z with by_force"));
            }
            self.world.pull_ball(to);
            return;
        }
        self.world.let_go_ball();
        let flat =
            Vector::new(asked.vx.unwrap_or(before.velocity.x()), asked.vy.unwrap_or(before.velocity.y()));
        let velocity = flat.clamped(BALL_SPEED_MAX);
        let climb = asked.vz.unwrap_or(before.climb).clamp(-BALL_SPEED_MAX, BALL_SPEED_MAX);
        for (what, asked) in
            [("teleport_ball.vx, vy", flat.norm()), ("teleport_ball.vz", asked.vz.unwrap_or(0.0).abs())]
        {
            if asked > BALL_SPEED_MAX {
                refused.push(Refusal::TooFast { what, asked, most: BALL_SPEED_MAX });
            }
        }
        // A simulator that does not support these reports it even where they are false.
        if !compatibility.safe_teleport {
            refused.extend(asked.teleport_safely.map(|_| Refusal::ModesSafely));
            refused.extend(asked.roll.map(|_| Refusal::ModesRoll));
        }
        let moved = asked.vx.is_some() || asked.vy.is_some();
        let placed = asked.x.is_some() || asked.y.is_some() || asked.z.is_some();
        let roll = asked.roll.unwrap_or(false) && compatibility.safe_teleport;
        let spin = match (roll, moved) {
            (true, _) => velocity,
            (false, true) => Vector::default(),
            (false, false) => before.spin,
        };
        // A message without values ends a pull and moves nothing.
        if moved || placed || roll || asked.vz.is_some() {
            self.world.put_ball(Ball { position: to, height, velocity, climb, spin, hops: 0 });
        }
        if asked.teleport_safely.unwrap_or(false) && compatibility.safe_teleport {
            self.world.make_room_for_ball();
        }
    }

    pub(super) fn teleport_robot(
        &mut self,
        asked: &TeleportRobot,
        refused: &mut Vec<Refusal>,
    ) -> Result<(), Refusal> {
        let who = who(&asked.id)?;
        let id = u32::from(who.id.number());
        let compatibility = self.cameras.settings().compatibility;
        let numbers = [asked.x, asked.y, asked.orientation, asked.v_x, asked.v_y, asked.v_angular];
        if numbers.into_iter().flatten().any(|number| !number.is_finite()) {
            return Err(Refusal::NotANumber("teleport_robot"));
        }
        if asked.present == Some(false) {
            self.parked.remove(&who);
            self.world.remove(who);
            return Ok(());
        }
        let known = self.world.robot(who).map(|robot| (robot.present, robot.pose));
        let (present, pose) = known.unwrap_or_default();
        let present = present || self.parked.contains(&who);
        if !present && asked.present != Some(true) {
            return Err(Refusal::UnknownRobot(id));
        }
        if !compatibility.partial {
            whole_robot(asked, present, known.is_some())?;
        }
        let by_force = asked.by_force.unwrap_or(false);
        let to = Pose {
            position: Point::new(asked.x.unwrap_or(pose.position.x()), asked.y.unwrap_or(pose.position.y())),
            heading: asked.orientation.map_or(pose.heading, Angle::new),
        };
        if !self.in_hall(to.position) {
            if !compatibility.parks {
                return Err(Refusal::OutsideHall("teleport_robot"));
            }
            // So far away no camera sees it and nothing touches it: it is off the field surface until it is
            // placed there again.
            if known.is_some() {
                self.world.remove(who);
                self.parked.insert(who);
            }
            return Ok(());
        }
        self.parked.remove(&who);
        if present && by_force {
            self.world.pull_robot(who, to.position, asked.orientation.map(Angle::new));
            return Ok(());
        }
        self.world.let_go_robot(who);
        let moves = asked.v_x.is_some() || asked.v_y.is_some() || asked.v_angular.is_some();
        let here = self.world.robot(who).is_some_and(|robot| robot.present);
        let placed = asked.x.is_some() || asked.y.is_some() || asked.orientation.is_some() || !here;
        if !placed && !moves {
            return Ok(());
        }
        // A teleported robot stands, as the protocol's defaults of 0 state, unless it gets a velocity.
        let wanted = Vector::new(asked.v_x.unwrap_or(0.0), asked.v_y.unwrap_or(0.0));
        let turning = asked.v_angular.unwrap_or(0.0);
        let robot = self.world.put(who, to);
        let (speed, turn) = (robot.limits().speed, robot.limits().turn_speed);
        robot.push(wanted.clamped(speed), turning.clamp(-turn, turn));
        for (what, asked, most) in [
            ("teleport_robot.v_x, v_y", wanted.norm(), speed),
            ("teleport_robot.v_angular", turning.abs(), turn),
        ] {
            if asked > most {
                refused.push(Refusal::TooFast { what, asked, most });
            }
        }
        Ok(())
    }

    fn in_hall(&self, p: Point<geometry::Field>) -> bool {
        let [x, y] = self.world.pitch().corner();
        p.x().abs() <= x + HALL_MARGIN && p.y().abs() <= y + HALL_MARGIN
    }
}

/// Errors of a ball's teleport in a simulator that requires both coordinates.
fn partial_ball(asked: &TeleportBall) -> Option<Refusal> {
    let place = [asked.x.is_some(), asked.y.is_some()];
    if asked.teleport_safely.unwrap_or(false) && place != [true, true] {
        return Some(Refusal::PartialSafely);
    }
    if place[0] != place[1] || asked.z.is_some() && !place[0] {
        return Some(Refusal::Partial("teleport_ball"));
    }
    if asked.vx.is_some() && asked.vy.is_none() {
        return Some(Refusal::Partial("teleport_ball"));
    }
    let moves = [asked.vx, asked.vy, asked.vz].into_iter().flatten().any(|v| v != 0.0);
    let force = asked.by_force.unwrap_or(false) && asked.vx.is_some() && moves;
    force.then_some(Refusal::VelocityForce("teleport_ball"))
}

/// The same for a robot's teleport; `present`: it is on the field, `known`: it was there once, or was
/// specified.
fn whole_robot(asked: &TeleportRobot, present: bool, known: bool) -> Result<(), Refusal> {
    let id = asked.id.id.unwrap_or_default();
    if !present && !known {
        return Err(Refusal::Unspecified(id));
    }
    if !present && (asked.x.is_none() || asked.y.is_none()) {
        return Err(Refusal::NoPlace(id));
    }
    let by_force = asked.by_force.unwrap_or(false);
    let place = [asked.x.is_some(), asked.y.is_some()];
    let turned = asked.orientation.is_some() || by_force || !place[0];
    if place[0] != place[1] || !turned || asked.v_x.is_some() != asked.v_y.is_some() {
        return Err(Refusal::Partial("teleport_robot"));
    }
    let moves = [asked.v_x, asked.v_y, asked.v_angular].into_iter().flatten().any(|v| v != 0.0);
    if by_force && moves { Err(Refusal::VelocityForce("teleport_robot")) } else { Ok(()) }
}

pub(super) fn who(id: &ssl::common::RobotId) -> Result<Who, Refusal> {
    let number = id.id.ok_or(Refusal::NoSuchId(None))?;
    let number = u8::try_from(number).ok().and_then(RobotId::new).ok_or(Refusal::NoSuchId(id.id))?;
    match id.team.and_then(|team| Team::try_from(team).ok()) {
        Some(Team::Yellow) => Ok(Who { colour: Colour::Yellow, id: number }),
        Some(Team::Blue) => Ok(Who { colour: Colour::Blue, id: number }),
        Some(Team::Unknown) | None => Err(Refusal::NoTeam),
    }
}

/// Distance from the boards to the walls of the venue, m.
const HALL_MARGIN: f32 = 2.0;
/// Height of the venue, m.
const HALL_HEIGHT: f32 = 20.0;
/// Maximum speed of a teleported ball, m/s.
const BALL_SPEED_MAX: f32 = 20.0;
