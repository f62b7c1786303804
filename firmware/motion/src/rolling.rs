//! `rolling`: distance and time of a rolling ball. Constant deceleration until it stops; m, s, m/s, m/s².

use geometry::math;

/// A ball that slows down evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingBall {
    /// Deceleration, m/s², > 0.
    pub deceleration: f32,
}

impl RollingBall {
    /// Distance from `speed` to its stop, m.
    pub fn rest_distance(self, speed: f32) -> f32 {
        speed * speed / (2.0 * self.deceleration)
    }

    /// The speed that makes it stop after `distance`, m/s.
    pub fn speed_for(self, distance: f32) -> f32 {
        math::sqrt(2.0 * self.deceleration * distance.max(0.0))
    }

    /// Time for `distance`, s; `None` if it stops before.
    pub fn travel_time(self, speed: f32, distance: f32) -> Option<f32> {
        let squared = speed * speed - 2.0 * self.deceleration * distance;
        (squared >= 0.0 && distance >= 0.0).then(|| (speed - math::sqrt(squared)) / self.deceleration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_at_one_metre_per_second_rolls_s_equals_v_squared_over_two_a() {
        let ball = RollingBall { deceleration: 0.35 };
        assert!((ball.rest_distance(1.0) - 1.428_571_4).abs() < 1e-6);
        assert!((ball.speed_for(ball.rest_distance(1.0)) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn time_and_distance_agree_with_s_equals_vt_minus_half_a_t_squared() {
        let ball = RollingBall { deceleration: 0.35 };
        let t = ball.travel_time(1.2, 0.8).unwrap();
        assert!((1.2 * t - 0.5 * 0.35 * t * t - 0.8).abs() < 1e-5);
        assert_eq!(ball.travel_time(0.1, 1.0), None);
    }
}
