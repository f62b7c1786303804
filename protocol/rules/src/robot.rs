//! `robot`: our robots on wheels, every number once: shape, motion limits, kicker, dribbler, wheel control.
//! SI units, body frame.
//!
//! Read by the planner and the skills (`brain`), the governor, the wheel and kicker control (`runtime`), the
//! host's passes and roles, and the robot that plays in another team's simulator. A team with other robots
//! changes [`RobotSpec::OURS`] and rebuilds: constants cost the robot neither flash nor time. The simulator's
//! robots have numbers of their own (`hil-sim/data/division-b.toml`), as physics must not agree with the plan
//! by construction; `tests/tests/robot_spec.rs` compares the two.

use crate::League;
use crate::limits::{BALL_RADIUS, ROBOT_RADIUS};

/// A robot on wheels, and what is assumed of others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotSpec {
    /// Its shape, seen from above.
    pub hull: HullSpec,
    /// What a motion is planned with: below what the wheels hold, so that a plan can be kept.
    pub plan: DriveSpec,
    /// The same with the ball at the dribbler.
    pub plan_holding: DriveSpec,
    /// What a turn is planned with.
    pub turn: TurnSpec,
    /// The same with the ball at the dribbler.
    pub turn_holding: TurnSpec,
    /// The same while a ball is placed.
    pub turn_placing: TurnSpec,
    /// The last limits before the motors.
    pub governor: GovernorSpec,
    /// What is assumed of robots whose plans are not known: opponents, and ours as the host sees them.
    pub assumed: AssumedSpec,
    /// Its kicker and the kicker's charge.
    pub kicker: KickerSpec,
    /// Its dribbler, by the roller's speed.
    pub dribbler: DribblerSpec,
    /// Its wheels and their speed control.
    pub wheels: WheelSpec,
}

/// A robot's shape, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullSpec {
    /// Radius of the hull, m.
    pub radius: f32,
    /// From the centre to the flat front, m.
    pub front: f32,
    /// How far the dribbler's opening lets the ball into the disc of `radius`, m; for times of interception.
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

/// What the governor lets through.
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

/// What is assumed of robots whose plans are not known.
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
    /// It is safe to touch below this, V.
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

/// Four wheels and their speed control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelSpec {
    /// Where they stand, degrees counter-clockwise from the front: front right, back right, back left, front
    /// left.
    pub degrees: [f32; 4],
    /// From the robot's centre to a wheel, m.
    pub distance: f32,
    /// Rim speed at full voltage without load, m/s.
    pub free_speed: f32,
    /// Duty (share of full voltage) for an error of 1 m/s.
    pub proportional: f32,
    /// Duty that an error of 1 m/s adds in a second.
    pub integral: f32,
}

impl RobotSpec {
    /// The specification of our robots, each number with its source.
    pub const OURS: Self = Self {
        hull: HullSpec {
            // The rules' distances assume it.
            radius: ROBOT_RADIUS,
            // Usual for robots 180 mm wide.
            front: 0.073,
            // Paper 2's robots; docs/papers.md D2.
            opening: 0.01,
        },
        // Wheels hold 3.5 to 5.5 m/s² in the simulator; 3 m/s is what the league's 2013 robots exceed (paper
        // 2 §1).
        plan: DriveSpec { speed: 3.0, acceleration: 3.0, braking: 3.5 },
        // The dribbler pulls with some 6 m/s² and holds aside with 4: it brakes a ball that it caught on the
        // run before the rules' metre is over (2.2 m/s in 0.97 m), and backs up no harder than the roller
        // follows.
        plan_holding: DriveSpec { speed: 1.5, acceleration: 1.8, braking: 2.5 },
        // Estimates; a simulated robot turns with 50 rad/s² and 15 rad/s at most.
        turn: TurnSpec { rate: 8.0, acceleration: 30.0 },
        // ω² · 95 mm stays below 1.2 m/s².
        turn_holding: TurnSpec { rate: 3.5, acceleration: 12.0 },
        // 0.4 m/s² along the roller: there is time.
        turn_placing: TurnSpec { rate: 1.5, acceleration: 4.0 },
        governor: GovernorSpec {
            // An estimate: the fastest teams publish 4.
            speed: 4.0,
            // An estimate.
            turn: 20.0,
            // What wheels hold: the simulator's 5.5, less a tenth.
            brake: 5.0,
            // An estimate.
            brake_turn: 40.0,
        },
        assumed: AssumedSpec {
            // The league's 2013 robots exceed 3 m/s (paper 2 §1); no paper prints accelerations, 3.5 m/s²
            // lies between published teams' 2 and 4.5. Opponents may have it; our own robots plan with
            // `plan`.
            pass: DriveSpec { speed: 3.0, acceleration: 3.5, braking: 3.5 },
            // ER-Force's simulated robot of 2020 turns with 6 rad/s; half its 60 rad/s², which no wheel on a
            // field keeps.
            turn: TurnSpec { rate: 6.0, acceleration: 30.0 },
            // Of the 3 m/s and more that teams drive, what is left on average; the weakest of the 3 to 4.7
            // m/s² they publish.
            role: TypicalSpec { speed: 2.0, acceleration: 3.0 },
            // Within the 3 to 4.7 m/s² that teams publish; a defence assumes a strong opponent.
            defence_acceleration: 4.0,
            // The weakest of the same: from a standing start to the side, where wheels stand steeper
            // (estimate).
            blocker_acceleration: 3.0,
            // A kicker may err by 4 % (estimate).
            kick_share: 0.96,
        },
        kicker: KickerSpec {
            // The rules' 6.5 less 11 %: a kicker may give 10 % more than it is ordered (the worlds' spread;
            // docs/fields.md).
            fastest: 5.8,
            // The same of 8 (paper 2 §1).
            fastest_2013: 7.1,
            // Estimates that stand in for a robot's own calibration.
            flat_pulses: &[(2.0, 1_500), (4.0, 2_600), (6.5, 4_500)],
            chip_pulses: &[(2.0, 2_000), (4.0, 3_800), (6.0, 6_000)],
            // Usual; ER-Force's simulator knows 0° and 45° only.
            chip_degrees: 45.0,
            chip_slope: 1.0,
            // Teams use 180 to 240.
            full_volts: 200.0,
            // Half of the 60 V of direct current that count as extra-low voltage.
            empty_volts: 30.0,
            // The plunger must come back (estimate).
            pause_ms: 500,
        },
        // What ours and most simulated robots turn at; ER-Force's is full at 1432.
        dribbler: DribblerSpec { full_rpm: 1000.0 },
        wheels: WheelSpec {
            // Usual: 60° in front make room for the dribbler, 135° behind; grSim's default.
            degrees: [-60.0, -135.0, 135.0, 60.0],
            // Within the hull of 90 mm (estimate).
            distance: 0.081,
            // The simulator's; to be measured on a robot.
            free_speed: 6.0,
            // A tenth of full voltage for 0.25 m/s (an estimate, to be tuned on a robot).
            proportional: 0.4,
            // An estimate, likewise.
            integral: 6.0,
        },
    };
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
        for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
            let limit = league.limits().map_or(0.0, |limits| limits.ball_speed);
            let fastest = OURS.kicker.fastest_in(league);
            assert!(
                fastest * 1.1 <= limit && OURS.assumed.kick_share <= 1.0,
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
