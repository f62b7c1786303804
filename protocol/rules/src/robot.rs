//! `robot`: our robots on wheels, every number once: shape, motion limits, kicker, dribbler, wheel control.
//! SI units, body frame.
//!
//! Read by the planner and the skills (`brain`), the governor, the wheel and kicker control (`runtime`), the
//! boards, the host's passes and roles, the page, and the simulator (what it shares, and what not:
//! docs/robots.md). The numbers are those of a `robot.toml`, checked by crate `robots` and turned into
//! constants when this crate is built: they cost the robot neither flash nor time. `ONETWO_ROBOT` names the
//! description; `tests/tests/robot_spec.rs` compares it with the simulator's robots.

use crate::League;
use crate::limits::BALL_RADIUS;

/// A robot on wheels, and what is assumed of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotSpec {
    /// Name of the robot, as in its description.
    pub name: &'static str,
    /// Outline of the robot, seen from above.
    pub hull: HullSpec,
    /// Limits by which a motion is planned: below what the wheels hold, so that a plan can be kept.
    pub plan: DriveSpec,
    /// The same with the ball at the dribbler.
    pub plan_holding: DriveSpec,
    /// Limits by which a turn is planned.
    pub turn: TurnSpec,
    /// The same with the ball at the dribbler.
    pub turn_holding: TurnSpec,
    /// The same while a ball is placed.
    pub turn_placing: TurnSpec,
    /// The last limits before the motors.
    pub governor: GovernorSpec,
    /// Limits assumed of robots whose plans are not known: opponents, and ours as the host sees them.
    pub assumed: AssumedSpec,
    /// Kicker and the kicker's charge.
    pub kicker: KickerSpec,
    /// Dribbler, by the roller's speed.
    pub dribbler: DribblerSpec,
    /// Wheels and their speed control.
    pub wheels: WheelSpec,
    /// Battery and its voltages.
    pub battery: BatterySpec,
    /// The light barrier at the dribbler.
    pub break_beam: BreakBeamSpec,
    /// Gyroscope and accelerometer, with their limits.
    pub imu: ImuSpec,
    /// Parts that the board must be wired for.
    pub parts: PartsSpec,
    /// Abilities of the hardware, for the simulator.
    pub hardware: HardwareSpec,
}

/// A robot's shape, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullSpec {
    /// Radius of the hull, m.
    pub radius: f32,
    /// From the centre to the flat front, m.
    pub front: f32,
    /// Depth by which the dribbler's opening lets the ball into the disc of `radius`, m; for times of
    /// interception.
    pub opening: f32,
}

impl HullSpec {
    /// From the centre to a ball at the front, m.
    pub const fn ball_at(&self) -> f32 {
        self.front + BALL_RADIUS
    }
}

/// Limits of motion along the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSpec {
    /// Greatest speed of the centre, m/s.
    pub speed: f32,
    /// Greatest acceleration when speeding up, m/s².
    pub acceleration: f32,
    /// Greatest deceleration when slowing down, m/s².
    pub braking: f32,
}

/// Limits of turning about the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnSpec {
    /// Greatest turning rate, rad/s.
    pub rate: f32,
    /// Speeding up and slowing down, rad/s².
    pub acceleration: f32,
}

/// Limits that the governor lets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GovernorSpec {
    /// Greatest speed of the centre, m/s.
    pub speed: f32,
    /// Greatest turning rate, rad/s.
    pub turn: f32,
    /// Deceleration when it brakes, m/s²; the wheel control brakes with it too when the brain is silent.
    pub brake: f32,
    /// The same for turning, rad/s².
    pub brake_turn: f32,
}

/// Limits assumed of robots whose plans are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssumedSpec {
    /// Passes, interceptions and coercion: any robot of the league, ours too.
    pub pass: DriveSpec,
    /// The same robots' limits of turning.
    pub turn: TurnSpec,
    /// Role assignment: speed and acceleration over a few metres, other bodies that obstruct.
    pub role: TypicalSpec,
    /// Defence: acceleration of opponents and of our defenders, m/s².
    pub defence_acceleration: f32,
    /// A robot that looks for a gap to shoot through: acceleration of the opponents beside it, m/s².
    pub blocker_acceleration: f32,
    /// Share of the rules' ball speed that the host plans kicks with.
    pub kick_share: f32,
}

/// Average motion over a few metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TypicalSpec {
    /// Speed while driving, m/s.
    pub speed: f32,
    /// Acceleration and braking, m/s².
    pub acceleration: f32,
}

/// A kicker and its charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KickerSpec {
    /// The fastest ball that is ordered, m/s.
    pub fastest: f32,
    /// The same under the rules of 2013, m/s.
    pub fastest_2013: f32,
    /// Ball speed, m/s, and the pulse for it, µs; flat kicker.
    pub flat_pulses: &'static [(f32, u64)],
    /// The same of the chip kicker.
    pub chip_pulses: &'static [(f32, u64)],
    /// Angle of a chip above the ground, degrees.
    pub chip_degrees: f32,
    /// Rise over run of a chip: the tangent of `chip_degrees`.
    pub chip_slope: f32,
    /// The capacitor counts as full from this voltage on, V.
    pub full_volts: f32,
    /// Voltage below which the capacitor is safe to touch, V.
    pub empty_volts: f32,
    /// From one kick to the next, ms.
    pub pause_ms: u64,
}

impl KickerSpec {
    /// The fastest ball that is ordered in that league, m/s.
    pub const fn fastest_in(&self, league: League) -> f32 {
        match league {
            League::Ssl2013 => self.fastest_2013,
            League::FourLegged | League::DivisionB | League::DivisionA => self.fastest,
        }
    }
}

/// A dribbler: its roller's speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DribblerSpec {
    /// Speed of the roller at full share, rpm.
    pub full_rpm: f32,
}

/// Three or four wheels and their speed control; of three the last place stays empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpec {
    /// Number of wheels, 3 or 4.
    pub count: u8,
    /// Positions of the wheels, degrees counter-clockwise from the front: front right, back right, back left,
    /// front left. Of a wheel that is not tangential that of the tangential one with the same direction.
    pub degrees: [f32; 4],
    /// Speed of each rim for a turn of 1 rad/s, m/s: of a tangential wheel its distance from the centre, m.
    pub levers: [f32; 4],
    /// From the robot's centre to the farthest wheel, m.
    pub distance: f32,
    /// The board's motor output, 0 to 3, that drives each wheel.
    pub outputs: [u8; 4],
    /// Radius of a wheel, m.
    pub radius: f32,
    /// Counts of the encoder for a turn of the wheel; negative where it counts down when the wheel turns the
    /// robot counter-clockwise.
    pub counts_a_turn: f32,
    /// Rim speed at full voltage without load, m/s.
    pub free_speed: f32,
    /// Fastest rim that is ordered, m/s.
    pub rim_max: f32,
    /// Duty (share of full voltage) for an error of 1 m/s.
    pub proportional: f32,
    /// Duty that an error of 1 m/s adds in a second.
    pub integral: f32,
}

/// Voltages of the battery by which it is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatterySpec {
    /// The robot stops to play below it, V.
    pub low: f32,
    /// More is no battery but a wrong divider, V.
    pub full: f32,
}

/// A break-beam sensor with a lamp that blinks: shares of the receiver's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreakBeamSpec {
    /// The lamp lifts the receiver by less: a ball hides it.
    pub hidden: f32,
    /// The lamp lifts it by more: no ball.
    pub seen: f32,
    /// Daylight above which nothing is measured.
    pub blind: f32,
}

/// A gyroscope at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuSpec {
    /// Spread of its readings, rad/s.
    pub unrest: f32,
    /// Largest offset that is believed, rad/s.
    pub offset_max: f32,
}

/// Parts that a board is wired for, or is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartsSpec {
    /// Scheme by which the motors are driven.
    pub motors: MotorScheme,
    /// Model of the gyroscope.
    pub imu: ImuModel,
    /// Line to the radio.
    pub radio: RadioLine,
    /// Rate of the serial line to the radio, 1/s.
    pub baud: u32,
}

/// Schemes by which motors are driven (docs/boards.md).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorScheme {
    /// A PWM and a direction for each.
    PwmDirection,
    /// Three PWMs and hall sensors for each.
    ThreePwm,
    /// Drivers on a line, with a control loop of their own.
    Smart,
}

/// Gyroscopes with a driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImuModel {
    /// ICM-42688-P of TDK, on SPI.
    Icm42688P,
    /// No gyroscope: the robot relies on vision.
    None,
}

/// A board's end of the radio.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadioLine {
    /// A modem on a serial line.
    Serial,
    /// Radio chip nRF24L01+ on SPI.
    Nrf24,
}

/// Measured abilities of the robot, and those that only the simulator asks for; plans stay below them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardwareSpec {
    /// Height of the hull, m.
    pub height: f32,
    /// Half the width in which the roller holds a ball, m.
    pub mouth: f32,
    /// Mass of the whole robot, kg.
    pub mass: f32,
    /// Greatest speed of the centre, m/s.
    pub speed: f32,
    /// Greatest turning rate, rad/s.
    pub turn_speed: f32,
    /// Acceleration that the wheels hold, speeding up ahead, m/s².
    pub forward: f32,
    /// The same to the side, m/s².
    pub side: f32,
    /// The same, braking in any direction, m/s².
    pub brake: f32,
    /// Speeding up a turn, rad/s².
    pub turn: f32,
    /// Acceleration of a free wheel from standing, m/s².
    pub rim_acceleration: f32,
    /// Strongest flat kick, m/s.
    pub flat: f32,
    /// Strongest chip along its path, m/s.
    pub chip: f32,
    /// From kick to kick, s.
    pub recharge: f32,
    /// Acceleration with which the roller pulls a ball at full speed, m/s².
    pub pull: f32,
}

impl RobotSpec {
    /// Our robots, as the description says that this build is for: `robots/ours.toml`, or what `ONETWO_ROBOT`
    /// named.
    pub const OURS: Self = described::OURS;
    /// The default description, whatever this build is for: the robot that the simulator's worlds are
    /// written for.
    pub const REFERENCE: Self = described::REFERENCE;
    /// The text of the description that this build is for; its numbers are [`Self::OURS`].
    pub const TEXT: &str = described::TEXT;
    /// Source of that text: a built-in name, or a path from the workspace's root.
    pub const SOURCE: &str = described::SOURCE;
}

/// Written by the build script.
#[allow(clippy::excessive_precision, clippy::approx_constant, reason = "numbers as the description has them")]
mod described {
    use super::{
        AssumedSpec, BatterySpec, BreakBeamSpec, DribblerSpec, DriveSpec, GovernorSpec, HardwareSpec,
        HullSpec, ImuModel, ImuSpec, KickerSpec, MotorScheme, PartsSpec, RadioLine, RobotSpec, TurnSpec,
        TypicalSpec, WheelSpec,
    };

    include!(concat!(env!("OUT_DIR"), "/robot.rs"));
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: RobotSpec = RobotSpec::OURS;

    #[test]
    fn plans_stay_within_what_the_governor_lets_through() {
        for plan in [OURS.plan, OURS.plan_holding] {
            assert!(plan.speed <= OURS.governor.speed && plan.braking <= OURS.governor.brake, "{plan:?}");
        }
        for turn in [OURS.turn, OURS.turn_holding, OURS.turn_placing] {
            assert!(
                turn.rate <= OURS.governor.turn && turn.acceleration <= OURS.governor.brake_turn,
                "{turn:?}"
            );
        }
    }

    #[test]
    fn no_league_sees_a_kick_faster_than_its_rules_and_pulses_grow_with_the_speed() {
        for league in League::ON_WHEELS {
            let limit = league.limits().map_or(0.0, |limits| limits.ball_speed);
            let fastest = OURS.kicker.fastest_in(league);
            assert!(
                fastest * 1.04 <= limit && OURS.assumed.kick_share <= 1.0,
                "{league:?}: {fastest} of {limit}"
            );
        }
        for pulses in [OURS.kicker.flat_pulses, OURS.kicker.chip_pulses] {
            assert!(pulses.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1));
        }
    }

    #[test]
    fn the_body_holds_together() {
        const { assert!(OURS.hull.front < OURS.hull.radius && OURS.wheels.distance < OURS.hull.radius) };
        let slope = geometry::math::sin_cos(OURS.kicker.chip_degrees * (geometry::math::PI / 180.0));
        assert!((slope.0 / slope.1 - OURS.kicker.chip_slope).abs() < 1e-5);
    }
}
