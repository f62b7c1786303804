//! `axis`: one axis of a trajectory. Trapezoid or triangle; m or rad, s.
//!
//! Phases, any of which may be empty: brake (moving in the wrong direction, or above the speed limit), speed
//! up, cruise, brake.

use geometry::math;

use super::FreeLimits;

/// Limits of an axis with the values that every evaluation needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisLimits {
    speed: f32,
    acceleration: f32,
    braking: f32,
    /// Reciprocals: 1 / acceleration, 1 / braking, 1 / speed.
    per_acceleration: f32,
    per_braking: f32,
    per_speed: f32,
    /// A peak's square: `peak_distance`·d + `peak_start`·v₀².
    peak_distance: f32,
    peak_start: f32,
    speed_squared: f32,
}

/// What a direction of an axis has to do, turned so that the distance after braking is never negative.
#[derive(Clone, Copy)]
struct Ahead {
    /// +1, or −1 where the axis was turned round.
    sign: f32,
    distance: f32,
    speed: f32,
    /// Time and distance of braking from the wrong direction.
    first: f32,
}

impl AxisLimits {
    pub(super) fn new(limits: &FreeLimits) -> Self {
        let FreeLimits { speed, acceleration, braking } = *limits;
        let per_sum = 1.0 / (acceleration + braking);
        Self {
            speed,
            acceleration,
            braking,
            per_acceleration: 1.0 / acceleration,
            per_braking: 1.0 / braking,
            per_speed: 1.0 / speed,
            peak_distance: 2.0 * acceleration * braking * per_sum,
            peak_start: braking * per_sum,
            speed_squared: speed * speed,
        }
    }

    /// Time to standstill at `distance` ahead, moving with `speed` now, s.
    #[inline]
    pub(super) fn time(&self, distance: f32, speed: f32) -> f32 {
        let Ahead { distance, speed, first, .. } = self.ahead(distance, speed);
        if speed > self.speed {
            // Brake to the limit, cruise, brake: the two brakings together are one from `speed` to
            // standstill.
            let cruise = (distance - 0.5 * speed * speed * self.per_braking) * self.per_speed;
            return first + speed * self.per_braking + cruise;
        }
        let squared = self.peak_distance * distance + self.peak_start * speed * speed;
        if squared <= self.speed_squared {
            let peak = math::sqrt(squared);
            return first + (peak - speed) * self.per_acceleration + peak * self.per_braking;
        }
        let up = 0.5 * (self.speed_squared - speed * speed) * self.per_acceleration;
        let down = 0.5 * self.speed_squared * self.per_braking;
        first
            + (self.speed - speed) * self.per_acceleration
            + self.speed * self.per_braking
            + (distance - up - down) * self.per_speed
    }

    /// Approximate duration, for a first guess of an axis's share; exact between two standstills.
    #[inline]
    pub(super) fn effort(&self, distance: f32, speed: f32) -> f32 {
        let stop = 0.5 * speed * speed * self.per_braking;
        let beyond = if speed < 0.0 { distance + stop } else { distance - stop };
        beyond.abs() + stop
    }

    #[inline]
    fn ahead(&self, distance: f32, speed: f32) -> Ahead {
        let stop = 0.5 * speed * speed.abs() * self.per_braking;
        let sign = if distance < stop { -1.0 } else { 1.0 };
        let (distance, speed) = (sign * distance, sign * speed);
        if speed < 0.0 {
            let first = -speed * self.per_braking;
            Ahead { sign, distance: distance - 0.5 * speed * first, speed: 0.0, first }
        } else {
            Ahead { sign, distance, speed, first: 0.0 }
        }
    }

    /// The phases of the motion by `distance`, moving with `speed` now, when `share` of the limits is the
    /// axis's own.
    pub(super) fn phases(&self, distance: f32, speed: f32, share: f32) -> Phases {
        let per_share = 1.0 / share;
        let scaled = self.ahead(distance * per_share, speed * per_share);
        let unit = scaled.sign * share;
        let (v, d) = (scaled.speed, scaled.distance);
        let (peak, speeding, cruise) = if v > self.speed {
            let cruise = (d - 0.5 * v * v * self.per_braking) * self.per_speed;
            (self.speed, (self.speed - v) * self.per_braking, cruise)
        } else {
            let squared = self.peak_distance * d + self.peak_start * v * v;
            if squared <= self.speed_squared {
                // Where only braking is left, rounding may put the peak below the speed.
                let peak = math::max(math::sqrt(squared), v);
                (peak, (peak - v) * self.per_acceleration, 0.0)
            } else {
                let up = 0.5 * (self.speed_squared - v * v) * self.per_acceleration;
                let down = 0.5 * self.speed_squared * self.per_braking;
                (self.speed, (self.speed - v) * self.per_acceleration, (d - up - down) * self.per_speed)
            }
        };
        let rate = if speeding < 0.0 { -self.braking } else { self.acceleration };
        let turned = scaled.first;
        let peak_at = turned + speeding.abs();
        let brake_at = peak_at + math::max(cruise, 0.0);
        Phases {
            start: speed,
            end: distance,
            brake: unit * self.braking,
            rate: unit * rate,
            peak: unit * peak,
            turned,
            peak_at,
            brake_at,
            duration: brake_at + peak * self.per_braking,
        }
    }
}

/// One axis's motion from 0 to `end`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Phases {
    /// Speed at the start, m/s or rad/s.
    start: f32,
    /// Distance of its end from the start, m or rad.
    pub(super) end: f32,
    /// Size and direction of both brakings; of the speeding up, or of the slowing down to the limit.
    brake: f32,
    rate: f32,
    /// Speed before the last braking, m/s or rad/s.
    peak: f32,
    /// Ends of braking from the wrong direction, of speeding up, of cruising, of it all, s.
    turned: f32,
    peak_at: f32,
    brake_at: f32,
    pub(super) duration: f32,
}

impl Phases {
    /// Place, speed and acceleration at a time. The last two phases are computed from the end backwards, so
    /// that it arrives.
    pub(super) fn at(&self, time: f32) -> (f32, f32, f32) {
        if time >= self.duration {
            return (self.end, 0.0, 0.0);
        }
        if time >= self.brake_at {
            let left = self.duration - time;
            return (self.end - 0.5 * self.brake * left * left, self.brake * left, -self.brake);
        }
        if time >= self.peak_at {
            let down = self.duration - self.brake_at;
            let place = self.end - 0.5 * self.brake * down * down - self.peak * (self.brake_at - time);
            return (place, self.peak, 0.0);
        }
        if time < self.turned {
            let t = math::max(time, 0.0);
            return (self.start * t + 0.5 * self.brake * t * t, self.start + self.brake * t, self.brake);
        }
        let t = math::max(time - self.turned, 0.0);
        let (from, speed) =
            if self.turned > 0.0 { (0.5 * self.start * self.turned, 0.0) } else { (0.0, self.start) };
        (from + speed * t + 0.5 * self.rate * t * t, speed + self.rate * t, self.rate)
    }
}
