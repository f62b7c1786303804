//! `described`: the described robot in a world. Leagues' files and worlds are written for the reference robot
//! (`RobotSpec::REFERENCE`); a robot of another description differs from theirs as it differs from the
//! reference.
//!
//! Lengths and angles keep the difference, speeds, accelerations, masses and voltages the ratio; for the
//! reference itself every number stays, bit by bit. What a description does not have stays the world's: ball,
//! bounces, friction, scatter of kicks, reach of kicker and roller, the battery's energy, cameras, noise
//! (docs/robots.md says why).

use rules::RobotSpec;

use super::{
    BatteryParameters, BodyParameters, DribblerParameters, DriveParameters, KickParameters, Parameters,
};

impl Parameters {
    /// These parameters, as they would be written for `own` in place of the reference robot.
    #[must_use]
    pub fn for_robot(&self, own: &RobotSpec) -> Self {
        let (a, b) = (own.hardware, REFERENCE.hardware);
        let (of, drive, kick, battery) = (&self.robot, &self.drive, &self.kick, &self.battery);
        let radius = of.radius + (own.hull.radius - REFERENCE.hull.radius);
        let mut wheels_deg = of.wheels_deg;
        for ((angle, own), reference) in
            wheels_deg.iter_mut().zip(own.wheels.degrees).zip(REFERENCE.wheels.degrees)
        {
            *angle += own - reference;
        }
        let pull = a.pull / b.pull;
        Self {
            robot: BodyParameters {
                radius,
                height: of.height + (a.height - b.height),
                // A world whose robots have another shape may leave less room than the reference's does.
                front: (of.front + (own.hull.front - REFERENCE.hull.front)).min(radius),
                mouth: (of.mouth + (a.mouth - b.mouth)).min(radius),
                mass: of.mass * (a.mass / b.mass),
                wheels_deg,
                wheel_distance: (of.wheel_distance + (own.wheels.distance - REFERENCE.wheels.distance))
                    .min(radius),
                wheel_levers: own.wheels.levers.map(|lever| lever / own.wheels.distance),
                wheel_count: own.wheels.count,
            },
            drive: DriveParameters {
                forward: drive.forward * (a.forward / b.forward),
                side: drive.side * (a.side / b.side),
                brake: drive.brake * (a.brake / b.brake),
                turn: drive.turn * (a.turn / b.turn),
                speed: drive.speed * (a.speed / b.speed),
                turn_speed: drive.turn_speed * (a.turn_speed / b.turn_speed),
                rim_speed: drive.rim_speed * (own.wheels.free_speed / REFERENCE.wheels.free_speed),
                rim_acceleration: drive.rim_acceleration * (a.rim_acceleration / b.rim_acceleration),
                order_lasts: drive.order_lasts,
            },
            kick: KickParameters {
                flat: kick.flat * (a.flat / b.flat),
                chip: kick.chip * (a.chip / b.chip),
                chip_deg: kick.chip_deg + (own.kicker.chip_degrees - REFERENCE.kicker.chip_degrees),
                recharge: kick.recharge * (a.recharge / b.recharge),
                ..*kick
            },
            dribbler: DribblerParameters {
                pull: self.dribbler.pull * pull,
                side: self.dribbler.side * pull,
                full_rpm: self.dribbler.full_rpm * (own.dribbler.full_rpm / REFERENCE.dribbler.full_rpm),
                ..self.dribbler
            },
            battery: BatteryParameters {
                full: battery.full * (own.battery.full / REFERENCE.battery.full),
                empty: battery.empty * (own.battery.low / REFERENCE.battery.low),
                ..*battery
            },
            ..self.clone()
        }
    }
}

const REFERENCE: RobotSpec = RobotSpec::REFERENCE;

#[cfg(test)]
mod tests {
    use rules::{HardwareSpec, HullSpec, League, WheelSpec};

    use super::*;
    use crate::small_size::worlds::{NamedWorld, WorldChoice, WorldModel};

    #[test]
    fn the_reference_robot_leaves_the_files_numbers_bit_by_bit() {
        for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
            let file = Parameters::of_file(league).unwrap();
            assert_eq!(&file.for_robot(&REFERENCE), file, "{league:?}");
        }
    }

    #[test]
    fn a_described_robots_speed_and_wheels_hold_in_every_world() {
        let hardware = HardwareSpec { speed: 0.5 * REFERENCE.hardware.speed, ..REFERENCE.hardware };
        let wheels = WheelSpec { degrees: [-45.0, -135.0, 135.0, 45.0], ..REFERENCE.wheels };
        let hull = HullSpec { front: REFERENCE.hull.front + 0.002, ..REFERENCE.hull };
        let own = RobotSpec { hardware, wheels, hull, ..REFERENCE };
        let file = Parameters::of_file(League::DivisionB).unwrap();
        for named in NamedWorld::ALL {
            let world = WorldModel::from_toml(named.label(), named.text(), file).unwrap().parameters;
            let theirs = world.for_robot(&own);
            assert_eq!(theirs.drive.speed, 0.5 * world.drive.speed, "{named:?}");
            assert_eq!(theirs.robot.wheels_deg, [-45.0, -135.0, 135.0, 45.0], "{named:?}");
            assert!((theirs.robot.front - world.robot.front - 0.002).abs() < 1e-6, "{named:?}");
            assert_eq!((theirs.ball, theirs.noise, theirs.bounce), (world.ball, world.noise, world.bounce));
        }
    }

    #[test]
    fn the_wheels_of_the_built_robot_drive_in_every_world() {
        let named = NamedWorld::ALL.map(WorldChoice::Named);
        let choices = named.into_iter().chain((0..50).map(WorldChoice::Random));
        for choice in choices.chain([WorldChoice::Nominal]) {
            let world = WorldModel::of(League::DivisionB, &choice).unwrap();
            assert_eq!(world.check(), Ok(()), "{choice}");
        }
    }
}
