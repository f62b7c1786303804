//! `config`: run-time configuration of the simulator. Robots' bodies, the field, noise and losses, vision's
//! port.
//!
//! A setting is checked as a whole before anything changes; a refused one changes nothing. Units on the wire:
//! mm in geometry, SI elsewhere, ns for delays.

use rules::FieldSpec;
use ssl::Message;
use ssl::common::Any;
use ssl::simulation::{RealismConfig, RealismConfigErForce, RobotSpecErForce, RobotSpecs, SimulatorConfig};
use ssl::vision::{GeometryData, GeometryFieldSize, GeometryModels};

use super::control::who;
use super::{Refusal, Server};
use crate::small_size::{BallParameters, BodyParameters, DriveParameters, Pitch, Robot};

impl Server {
    pub(super) fn configure(&mut self, config: &SimulatorConfig, refused: &mut Vec<Refusal>) {
        let only_specs = self.cameras.settings().compatibility.only_specs;
        for specs in &config.robot_specs {
            if let Err(refusal) = self.specify(specs, refused) {
                refused.push(refusal);
            }
        }
        if only_specs {
            // One error for all of them, as in grSim.
            let others = [
                (config.geometry.is_some(), "geometry"),
                (config.realism_config.is_some(), "realism_config"),
                (config.vision_port.is_some(), "vision_port"),
            ];
            refused
                .extend(others.into_iter().find(|(set, _)| *set).map(|(_, what)| Refusal::ModesConfig(what)));
            return;
        }
        if let Some(geometry) = &config.geometry {
            self.lay_out(geometry, refused);
        }
        if let Some(realism) = &config.realism_config {
            self.blur(realism, refused);
        }
        match config.vision_port.map(|port| (port, u16::try_from(port))) {
            Some((_, Ok(port))) if port > 0 => self.vision_port = port,
            Some((port, _)) => refused.push(Refusal::VisionPort(port)),
            None => {}
        }
    }

    fn specify(&mut self, specs: &RobotSpecs, refused: &mut Vec<Refusal>) -> Result<(), Refusal> {
        let who = who(&specs.id)?;
        if !self.cameras.settings().compatibility.partial
            && let Some(lack) = lack(specs)
        {
            return Err(Refusal::SpecsLack(lack));
        }
        if self.world.robot(who).is_none() {
            // Known from now on, but not on the field until it is teleported there.
            self.world.put(who, geometry::Pose::default());
            self.world.remove(who);
        }
        let mut asked =
            self.world.robot(who).cloned().ok_or(Refusal::UnknownRobot(u32::from(who.id.number())))?;
        shape(&mut asked, specs);
        for custom in &specs.custom {
            match custom_of::<RobotSpecErForce>(custom, "RobotSpecErForce") {
                Ok(of) => {
                    asked.body.front = of.shoot_radius.unwrap_or(asked.body.front);
                    asked.body.mouth = of.dribbler_width.map_or(asked.body.mouth, |width| width * 0.5);
                }
                Err(refusal) => refused.push(refusal),
            }
        }
        asked.body.check().map_err(Refusal::Specs)?;
        asked.limits().check().map_err(Refusal::Specs)?;
        let kick = crate::small_size::KickParameters {
            flat: asked.kick_limits[0],
            chip: asked.kick_limits[1],
            ..self.world.parameters().kick
        };
        kick.check().map_err(Refusal::Specs)?;
        self.world.alter(who, |robot| {
            robot.set_body(asked.body);
            robot.set_limits(*asked.limits());
            robot.kick_limits = asked.kick_limits;
        });
        Ok(())
    }

    fn lay_out(&mut self, geometry: &GeometryData, refused: &mut Vec<Refusal>) {
        let pitch = *self.world.pitch();
        match field_of(&geometry.field, pitch.field).checked() {
            Ok(field) => {
                self.world.set_pitch(Pitch { field, ..pitch });
                self.cameras.hang(&self.world);
            }
            Err(fault) => refused.push(Refusal::Geometry(fault)),
        }
        if !geometry.calib.is_empty() {
            refused.push(Refusal::Unsupported("geometry.calib"));
        }
        if let Some(models) = &geometry.models {
            let mut ball = self.world.parameters().ball;
            ball.radius = geometry.field.ball_radius.map_or(ball.radius, |mm| mm / 1000.0);
            match ball_of(models, ball) {
                Ok(ball) => {
                    self.world.set_ball_parameters(ball);
                    let switch = models.straight_two_phase.map(|flat| flat.k_switch);
                    let other = switch.filter(|switch| (switch - SOLID_BALL_SWITCH).abs() > SWITCH_TOLERANCE);
                    refused.extend(other.map(Refusal::BallSwitch));
                }
                Err(why) => refused.push(Refusal::BallModel(why)),
            }
        }
    }

    fn blur(&mut self, realism: &RealismConfig, refused: &mut Vec<Refusal>) {
        for custom in &realism.custom {
            match custom_of::<RealismConfigErForce>(custom, "RealismConfigErForce") {
                Ok(asked) => {
                    if let Err(refusal) = self.blur_as(&asked, refused) {
                        refused.push(refusal);
                    }
                }
                Err(refusal) => refused.push(refusal),
            }
        }
    }

    fn blur_as(&mut self, asked: &RealismConfigErForce, refused: &mut Vec<Refusal>) -> Result<(), Refusal> {
        let settings = *self.cameras.settings();
        let (mut camera, mut noise) = (settings.camera, settings.noise);
        set(&mut noise.ball, asked.stddev_ball_p);
        set(&mut noise.robot, asked.stddev_robot_p);
        set(&mut noise.heading, asked.stddev_robot_phi);
        set(&mut noise.missing_ball, asked.missing_ball_detections);
        set(&mut noise.missing_robot, asked.missing_robot_detections);
        set(&mut noise.hidden_ball, asked.ball_visibility_threshold);
        if asked.enable_invisible_ball == Some(false) {
            noise.hidden_ball = 0.0;
        }
        set(&mut camera.overlap, asked.camera_overlap);
        set(&mut camera.delay, asked.vision_delay.map(|ns| ns as f32 * 1e-9));
        let processing = asked.vision_processing_time.map(|ns| ns as f32 * 1e-9);
        set(&mut camera.processing, processing);
        if processing.is_none() {
            camera.processing = camera.processing.min(camera.delay.max(0.0));
        }
        let mut radio = self.radio;
        set(&mut radio.command_loss, asked.robot_command_loss);
        set(&mut radio.answer_loss, asked.robot_response_loss);
        if let Some(ns) = asked.command_delay {
            radio.delay = ns / 1_000_000;
        }
        let mut parameters = self.world.parameters().clone();
        (parameters.camera, parameters.noise) = (camera, noise);
        parameters.check().map_err(Refusal::Realism)?;
        for (name, value, high) in [
            ("realism.robot_command_loss", radio.command_loss, 1.0),
            ("realism.robot_response_loss", radio.answer_loss, 1.0),
            ("realism.command_delay", radio.delay as f32 * 0.001, COMMAND_DELAY_MAX),
        ] {
            if !(0.0..=high).contains(&value) {
                let error = crate::parameters::ParameterError::Range { name, value, low: 0.0, high };
                return Err(Refusal::Realism(error));
            }
        }
        self.radio = radio;
        self.cameras.set_realism(camera, noise);
        if asked.camera_overlap.is_some() {
            self.cameras.hang(&self.world);
        }
        let nowhere = [
            (asked.stddev_ball_area, "realism.stddev_ball_area"),
            (asked.dribbler_ball_detections, "realism.dribbler_ball_detections"),
            (asked.camera_position_error, "realism.camera_position_error"),
            (asked.object_position_offset, "realism.object_position_offset"),
            (asked.simulate_dribbling.map(|on| f32::from(u8::from(on))), "realism.simulate_dribbling"),
        ];
        let wanted = nowhere.into_iter().filter(|(value, _)| value.is_some_and(|value| value != 0.0));
        refused.extend(wanted.map(|(_, what)| Refusal::Unsupported(what)));
        Ok(())
    }
}

/// Value that a specification lacks for a simulator that requires complete ones.
fn lack(specs: &RobotSpecs) -> Option<&'static str> {
    let limits = specs.limits.unwrap_or_default();
    let custom = specs
        .custom
        .iter()
        .find_map(|custom| custom_of::<RobotSpecErForce>(custom, "RobotSpecErForce").ok())
        .unwrap_or_default();
    let needed = [
        (specs.mass, "mass"),
        (specs.center_to_dribbler, "center_to_dribbler"),
        (limits.acc_speedup_absolute_max, "limits.acc_speedup_absolute_max"),
        (limits.acc_speedup_angular_max, "limits.acc_speedup_angular_max"),
        (limits.acc_brake_absolute_max, "limits.acc_brake_absolute_max"),
        (limits.acc_brake_angular_max, "limits.acc_brake_angular_max"),
        (limits.vel_absolute_max, "limits.vel_absolute_max"),
        (limits.vel_angular_max, "limits.vel_angular_max"),
        (custom.shoot_radius, "custom RobotSpecErForce.shoot_radius"),
        (custom.dribbler_width, "custom RobotSpecErForce.dribbler_width"),
    ];
    needed.into_iter().find(|(value, _)| value.is_none()).map(|(_, name)| name)
}

fn set(place: &mut f32, value: Option<f32>) {
    if let Some(value) = value {
        *place = value;
    }
}

fn shape(robot: &mut Robot, specs: &RobotSpecs) {
    let BodyParameters { radius, height, mass, front, .. } = &mut robot.body;
    set(radius, specs.radius);
    set(height, specs.height);
    set(mass, specs.mass);
    set(front, specs.center_to_dribbler);
    set(&mut robot.kick_limits[0], specs.max_linear_kick_speed);
    set(&mut robot.kick_limits[1], specs.max_chip_kick_speed);
    if let Some(angles) = specs.wheel_angles {
        let angles = [angles.front_right, angles.back_right, angles.back_left, angles.front_left];
        robot.body.wheels_deg = angles.map(|radians| radians * (180.0 / geometry::math::PI));
    }
    if let Some(asked) = specs.limits {
        let mut limits = *robot.limits();
        let DriveParameters { forward, side, brake, turn, speed, turn_speed, .. } = &mut limits;
        set(forward, asked.acc_speedup_absolute_max);
        set(side, asked.acc_speedup_absolute_max);
        set(brake, asked.acc_brake_absolute_max);
        // There is one limit of turning here for both directions: the weaker of the two.
        let turns = [asked.acc_speedup_angular_max, asked.acc_brake_angular_max];
        set(turn, turns.into_iter().flatten().reduce(f32::min));
        set(speed, asked.vel_absolute_max);
        set(turn_speed, asked.vel_angular_max);
        robot.set_limits(limits);
    }
}

/// Applies the field of a geometry packet to the present one.
fn field_of(reported: &GeometryFieldSize, before: FieldSpec) -> FieldSpec {
    // Divided, not multiplied by 0.001: 180 mm are the 0.18 m that the league's files have.
    let m = |mm: i32| mm as f32 / 1000.0;
    let or = |value: Option<i32>, before: f32| value.map_or(before, m);
    let stretch = reported.field_lines.iter().find(|line| line.name == "LeftPenaltyStretch");
    let drawn = stretch.map(|line| {
        [
            (reported.field_length as f32 * 0.5 - line.p1.x.abs()) / 1000.0,
            (line.p2.y - line.p1.y).abs() / 1000.0,
        ]
    });
    FieldSpec {
        length: m(reported.field_length),
        width: m(reported.field_width),
        margin: m(reported.boundary_width),
        goal_line_margin: m(reported.boundary_width_goal_line.unwrap_or(reported.boundary_width)),
        goal_substitution: or(reported.goal_substitution_area_width, before.goal_substitution),
        goal_width: m(reported.goal_width),
        goal_depth: m(reported.goal_depth),
        goal_height: or(reported.goal_height, before.goal_height),
        penalty_depth: reported.penalty_area_depth.map_or(drawn.map_or(before.penalty_depth, |d| d[0]), m),
        penalty_width: reported.penalty_area_width.map_or(drawn.map_or(before.penalty_width, |d| d[1]), m),
        penalty_mark: or(reported.goal_center_to_penalty_mark, before.penalty_mark),
        center_radius: or(reported.center_circle_radius, before.center_radius),
        line_width: or(reported.line_thickness, before.line_width),
        ..before
    }
}

/// Applies the ball model of a geometry packet to the present one.
fn ball_of(models: &GeometryModels, mut ball: BallParameters) -> Result<BallParameters, String> {
    if let Some(flat) = models.straight_two_phase {
        // grSim's 0.7 and ER-Force's 0.69 approximate this value; a NaN is in no range.
        if !(0.684..0.744).contains(&flat.k_switch) {
            return Err(format!("k_switch {} is not that of a solid ball, 5/7", flat.k_switch));
        }
        (ball.slide, ball.roll) = (-flat.acc_slide as f32, -flat.acc_roll as f32);
    }
    if let Some(chip) = models.chip_fixed_loss {
        ball.hop_along = chip.damping_xy_first_hop as f32;
        ball.hop_along_later = chip.damping_xy_other_hops as f32;
        ball.hop_up = chip.damping_z as f32;
    }
    ball.check().map_err(|error| error.to_string())?;
    Ok(ball)
}

/// Decodes a custom setting as the message it claims to be.
fn custom_of<T: Message + Default>(custom: &Any, name: &str) -> Result<T, Refusal> {
    let url = custom.type_url.clone().unwrap_or_default();
    // `type.googleapis.com/package.Name`; ER-Force puts one of its messages into a package and the other into
    // none.
    if url.rsplit(['/', '.']).next() != Some(name) {
        return Err(Refusal::UnknownCustom(url));
    }
    T::decode(custom.value.as_deref().unwrap_or_default()).map_err(|_| Refusal::BrokenCustom(url))
}

/// Share of a kick's speed below which a solid ball rolls.
const SOLID_BALL_SWITCH: f64 = 5.0 / 7.0;
/// Tolerance for a rounded share on the wire.
const SWITCH_TOLERANCE: f64 = 1e-3;
/// Maximum delay of commands, s: larger values are refused.
const COMMAND_DELAY_MAX: f32 = 1.0;
