//! `balance`: shares of the limits with which both axes arrive together (one angle α: cos α for x, sin α for
//! y).
//!
//! The more an axis gets, the sooner it arrives; so the times cross, and the crossing is the least of their
//! larger one. It is searched for between bounds: false position with halved weights ("Illinois"), on (tx −
//! ty) / (tx + ty), which is −1 and +1 at the ends however long an axis takes without a share.

use geometry::math;

/// Shares of the limits, x² + y² = 1, and the time both axes need with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Balance {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) time: f32,
}

/// Seeks the shares. `times(x, y)` are both axes' times with these shares; `first` is where to start, 0 (all
/// for x) to 1 (all for y). Ends early, with the shares found by then, once it is clear that the time is over
/// `within`.
#[inline]
pub(super) fn balance(
    first: f32,
    rounds: u32,
    tolerance: f32,
    within: f32,
    times: impl Fn(f32, f32) -> (f32, f32),
) -> Balance {
    let (mut low, mut low_value) = (0.0_f32, -1.0_f32);
    let (mut high, mut high_value) = (1.0_f32, 1.0_f32);
    let mut at = first.clamp(EDGE, 1.0 - EDGE);
    let mut best = Balance { x: 1.0, y: 1.0, time: f32::INFINITY };
    let mut side = 0;
    // Bounds at which x takes too long at least, and y at most: only places between could be in time.
    let (mut x_late_from, mut y_late_to) = (f32::INFINITY, f32::NEG_INFINITY);
    for _ in 0..rounds {
        let scale = 1.0 / math::hypot(1.0 - at, at);
        let (x, y) = ((1.0 - at) * scale, at * scale);
        let (tx, ty) = times(x, y);
        let time = math::max(tx, ty);
        if time < best.time {
            best = Balance { x, y, time };
        }
        if tx > within {
            x_late_from = math::min(x_late_from, at);
        }
        if ty > within {
            y_late_to = math::max(y_late_to, at);
        }
        if y_late_to >= x_late_from {
            break;
        }
        let value = (tx - ty) / (tx + ty);
        // NaN where both axes stand.
        if value.is_nan() || value.abs() <= tolerance {
            break;
        }
        if value < 0.0 {
            (low, low_value) = (at, value);
            if side == -1 {
                high_value *= 0.5;
            }
            side = -1;
        } else {
            (high, high_value) = (at, value);
            if side == 1 {
                low_value *= 0.5;
            }
            side = 1;
        }
        at = (low * high_value - high * low_value) / (high_value - low_value);
        at = at.clamp(EDGE, 1.0 - EDGE);
    }
    best
}

/// The least share an axis gets, which avoids a division by 0: a ten-thousandth, which takes less than 10⁻⁸
/// from the other.
const EDGE: f32 = 1e-4;
