//! `derived`: what follows from a robot's description: wheels, speeds, times to stop, ranges of kicks. SI.

use std::f32::consts::PI;

use geometry::{Angle, Field, Point, Vector};
use motion::ball::BallModel;
use motion::omni::{Omni, Wheels};
use motion::trajectory::{CalcMotion, FreeLimits};
use robots::Description;

/// A derived number: its name, value and unit.
pub(super) type Row = (&'static str, f32, &'static str);

/// Quantities that follow from the description.
pub(super) fn rows(of: &Description) -> Vec<Row> {
    let (own, radius) = (of.wheels(), of.number("wheels.radius"));
    let slots = robots::wheel_slots(&own);
    let [free, rim] = [of.number("wheels.free_speed"), of.number("wheels.rim_max")];
    let driven = std::array::from_fn(|wheel| wheel < own.len());
    let wheels = Wheels { angles: slots.degrees.map(Angle::degrees), levers: slots.levers, driven };
    let counts = 4.0 * of.number("wheels.encoder_lines") * of.number("wheels.encoder_gear").abs();
    let mut rows = vec![
        ("wheels, condition of the matrix (1 is even)", robots::condition(&own) as f32, ""),
        ("wheel at free speed", 60.0 * free / (2.0 * PI * radius), "rpm"),
        ("encoder", counts / (2.0 * PI * radius), "counts/m"),
        ("longest drive that a counter of 16 bits measures", COUNTER_MAX * 2.0 * PI * radius / counts, "m"),
        ("rim for a count", 1e3 * 2.0 * PI * radius / counts, "mm"),
    ];
    // A checked description has wheels that drive everywhere.
    if let Ok(omni) = Omni::new(&wheels) {
        for (name, degrees) in [
            ("top speed ahead, by the rims", 0.0),
            ("top speed to the side, by the rims", 90.0),
            ("top speed at 45°, by the rims", 45.0),
        ] {
            rows.push((name, omni.speed_limit(Angle::degrees(degrees), 0.0, rim), "m/s"));
        }
    }
    let [speed, braking] = [of.number("plan.speed"), of.number("plan.braking")];
    let plan = FreeLimits { speed, acceleration: of.number("plan.acceleration"), braking };
    let from = Point::<Field>::new(0.0, 0.0);
    rows.push(("top turning rate, by the rims", rim / slots.levers.into_iter().fold(0.0, f32::max), "rad/s"));
    rows.push(("time to stop from plan.speed", speed / braking, "s"));
    rows.push(("distance to stop from plan.speed", speed * speed / (2.0 * braking), "m"));
    rows.push((
        "2 m from standing to standing",
        plan.time(from, Vector::default(), Point::new(2.0, 0.0)),
        "s",
    ));
    let fastest = of.number("kicker.fastest");
    let path = BallModel::default().kicked(from, Vector::new(fastest, 0.0));
    rows.push(("a flat kick of kicker.fastest comes to rest after", path.rest_distance(), "m"));
    rows.push(("pulse of that kick", pulse(of.pulses("kicker.flat_pulses"), fastest), "µs"));
    let slope = of.number("kicker.chip_degrees").to_radians();
    let chip = of.pulses("kicker.chip_pulses").last().map_or(0.0, |(speed, _)| *speed);
    rows.push(("the longest chip lands after", chip * chip * (2.0 * slope).sin() / GRAVITY, "m"));
    rows
}

/// The pulse for a ball speed, as the robot computes it: straight lines between the pairs.
fn pulse(table: &[(f32, u64)], speed: f32) -> f32 {
    let mut last = (0.0, 0.0);
    for (to, micros) in table.iter().map(|(to, micros)| (*to, *micros as f32)) {
        if speed <= to {
            return last.1 + (speed - last.0) / (to - last.0) * (micros - last.1);
        }
        last = (to, micros);
    }
    last.1
}

/// Most counts of a wheel's counter on a board.
pub(super) const COUNTER_MAX: f32 = 65_535.0;
/// Of the Earth, m/s².
const GRAVITY: f32 = 9.81;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_our_robot_agree_with_a_calculation_by_hand() {
        let ours = Description::read("ours", robots::built_in("ours").unwrap()).unwrap();
        let rows = rows(&ours);
        let of = |name: &str| rows.iter().find(|(row, ..)| row.starts_with(name)).unwrap().1;
        // 6 m/s on 27 mm; 4096 counts on a circumference of 0.169646 m.
        assert!((of("wheel at free speed") - 2_122.07).abs() < 0.1);
        assert!((of("encoder") - 24_144.0).abs() < 2.0);
        // 65,535 of these.
        assert!((of("longest drive") - 2.7143).abs() < 1e-3);
        // 5 m/s over sin 60°; to the side the back wheels' cos 135° is the larger part.
        assert!((of("top speed ahead") - 5.7735).abs() < 1e-3);
        assert!((of("top speed to the side") - 7.0711).abs() < 1e-3);
        assert!((of("time to stop") - 3.0 / 3.5).abs() < 1e-6);
        // 3 m/s and 3.5 m/s² are not reached: 2 m = v²/2 · (1/3 + 1/3.5).
        let top = (4.0_f32 / (1.0 / 3.0 + 1.0 / 3.5)).sqrt();
        assert!((of("2 m from standing") - (top / 3.0 + top / 3.5)).abs() < 2e-3);
        // Between 4 m/s, 2600 µs and 6.5 m/s, 4500 µs.
        assert!((of("pulse of that kick") - 4_302.4).abs() < 1.0);
        // 36 / 9.81.
        assert!((of("the longest chip") - 3.6697).abs() < 1e-3);
    }
}
