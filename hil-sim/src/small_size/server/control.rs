//! What is moved, and how fast does time pass? Teleports and the simulation's speed, port 10300; m, m/s, rad.
//!
//! What a message leaves out stays as it is.

use geometry::{Angle, Point, Pose, Vector};
use protocol::{RobotId, Who};
use rules::Colour;
use ssl::common::Team;
use ssl::simulation::{SimulatorCommand, SimulatorControl, TeleportBall, TeleportRobot};

use super::{Refusal, SPEED_MAX, Server};
use crate::small_size::Ball;

impl Server {
    /// Does what a command of port 10300 asks for; gives what could not be done.
    pub(super) fn steer(&mut self, command: &SimulatorCommand) -> Vec<Refusal> {
        let mut refused = Vec::new();
        // Settings first: what is moved is moved on the field that was asked for.
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
            if let Err(refusal) = self.teleport_robot(teleport) {
                refused.push(refusal);
            }
        }
        // After the robots: a ball asks them to make room where they stand then.
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

    fn teleport_ball(&mut self, asked: &TeleportBall, refused: &mut Vec<Refusal>) {
        let numbers = [asked.x, asked.y, asked.z, asked.vx, asked.vy, asked.vz];
        if numbers.into_iter().flatten().any(|number| !number.is_finite()) {
            refused.push(Refusal::NotANumber("teleport_ball"));
            return;
        }
        let before = self.world.ball;
        let to = Point::new(asked.x.unwrap_or(before.position.x()), asked.y.unwrap_or(before.position.y()));
        let height = asked.z.unwrap_or(before.height);
        if !self.in_hall(to) || !(0.0..=HALL_HEIGHT).contains(&height) {
            refused.push(Refusal::OutsideHall("teleport_ball"));
            return;
        }
        let known = self.cameras.settings().quirks.safe_teleport;
        if asked.by_force.unwrap_or(false) {
            self.world.drag_ball(to);
            return;
        }
        let velocity =
            Vector::new(asked.vx.unwrap_or(before.velocity.x()), asked.vy.unwrap_or(before.velocity.y()))
                .clamped(BALL_SPEED_MAX);
        let climb = asked.vz.unwrap_or(before.climb).clamp(-BALL_SPEED_MAX, BALL_SPEED_MAX);
        let roll = asked.roll.unwrap_or(false);
        if roll && !known {
            refused.push(Refusal::MannersTeleport("teleport_ball.roll"));
        }
        let moved = asked.vx.is_some() || asked.vy.is_some();
        let spin = match (roll && known, moved) {
            (true, _) => velocity,
            (false, true) => Vector::default(),
            (false, false) => before.spin,
        };
        self.world.put_ball(Ball { position: to, height, velocity, climb, spin, hops: 0 });
        if asked.teleport_safely.unwrap_or(false) {
            if known {
                self.world.make_room_for_ball();
            } else {
                refused.push(Refusal::MannersTeleport("teleport_ball.teleport_safely"));
            }
        }
    }

    fn teleport_robot(&mut self, asked: &TeleportRobot) -> Result<(), Refusal> {
        let who = who(&asked.id)?;
        let numbers = [asked.x, asked.y, asked.orientation, asked.v_x, asked.v_y, asked.v_angular];
        if numbers.into_iter().flatten().any(|number| !number.is_finite()) {
            return Err(Refusal::NotANumber("teleport_robot"));
        }
        if asked.present == Some(false) {
            self.world.remove(who);
            return Ok(());
        }
        let known =
            self.world.robot(who).map(|robot| (robot.present, robot.pose, robot.velocity, robot.turning));
        let (present, pose, velocity, turning) = known.unwrap_or_default();
        if !present && asked.present != Some(true) {
            return Err(Refusal::UnknownRobot(u32::from(who.id.number())));
        }
        let to = Pose {
            position: Point::new(asked.x.unwrap_or(pose.position.x()), asked.y.unwrap_or(pose.position.y())),
            heading: asked.orientation.map_or(pose.heading, Angle::new),
        };
        if !self.in_hall(to.position) {
            return Err(Refusal::OutsideHall("teleport_robot"));
        }
        if present && asked.by_force.unwrap_or(false) {
            self.world.drag_robot(who, to.position, asked.orientation.map(Angle::new));
            return Ok(());
        }
        let moves = asked.v_x.is_some() || asked.v_y.is_some() || asked.v_angular.is_some();
        let placed = asked.x.is_some() || asked.y.is_some() || asked.orientation.is_some() || !present;
        // A robot put somewhere stands there, as the protocol's defaults of 0 say, unless it is told to move.
        let (velocity, turning) = if placed || moves {
            (Vector::new(asked.v_x.unwrap_or(0.0), asked.v_y.unwrap_or(0.0)), asked.v_angular.unwrap_or(0.0))
        } else {
            (velocity, turning)
        };
        let robot = self.world.put(who, to);
        let (speed, turn) = (robot.limits().speed, robot.limits().turn_speed);
        robot.push(velocity.clamped(speed), turning.clamp(-turn, turn));
        Ok(())
    }

    fn in_hall(&self, p: Point<geometry::Field>) -> bool {
        let [x, y] = self.world.pitch().corner();
        p.x().abs() <= x + HALL && p.y().abs() <= y + HALL
    }
}

/// A robot as the protocol names it.
pub(super) fn who(id: &ssl::common::RobotId) -> Result<Who, Refusal> {
    let number = id.id.ok_or(Refusal::NoSuchId(None))?;
    let number = u8::try_from(number).ok().and_then(RobotId::new).ok_or(Refusal::NoSuchId(id.id))?;
    match id.team.and_then(|team| Team::try_from(team).ok()) {
        Some(Team::Yellow) => Ok(Who { colour: Colour::Yellow, id: number }),
        Some(Team::Blue) => Ok(Who { colour: Colour::Blue, id: number }),
        Some(Team::Unknown) | None => Err(Refusal::NoTeam),
    }
}

/// m of hall beyond the boards.
const HALL: f32 = 2.0;
/// m.
const HALL_HEIGHT: f32 = 20.0;
/// m/s: no ball is put down faster.
const BALL_SPEED_MAX: f32 = 20.0;
