//! `conditions`: the conditions of a pass and of a goal after it. Conditions c1–c5 and c1'–c4', one function
//! each, from a margin to a probability (Biswas et al. 2014 §3.1). SI units.
//!
//! "~0 where …, ~1 otherwise" is a logistic function of the margin: 1 / (1 + exp(−m/w)), 1/2 where the
//! condition just holds (docs/papers.md D3). The margins are computed by [`super::intercept`],
//! [`super::open`] and [`super::scene`].

use geometry::math;

use super::constants::PassConstants;

/// Shares of passes with the smallest and the greatest P(receive) after which we had the ball: most likely
/// values for three of four of 1,601 passes (80 matches of 300 s, division B, nominal world, seeds 201 to 216
/// against five teams; example `passes` of onetwo-study fits them again).
const OURS_P_MIN: f32 = 0.4;
const OURS_P_MAX: f32 = 0.9;
/// Widths of margin at which a logistic equals 0 or 1: exp(−14) is below 10⁻⁶.
const CERTAIN_WIDTHS: f32 = 14.0;

/// 1 / (1 + exp(−`margin`/`width`)).
#[inline]
pub fn likely(margin: f32, width: f32) -> f32 {
    let x = margin / width;
    // Beyond, it is 0 or 1 to six digits; NaN gives 0.
    if x > CERTAIN_WIDTHS {
        1.0
    } else if x > -CERTAIN_WIDTHS {
        1.0 / (1.0 + math::exp(-x))
    } else {
        0.0
    }
}

/// c1: no opponent can reach x faster than the receiver. Times of both to x, s.
#[inline]
pub fn first_there(receiver: f32, soonest_opponent: f32, c: &PassConstants) -> f32 {
    likely(soonest_opponent - receiver, c.time_width)
}

/// c2: no opponent intercepts the pass. `margin` is the least time, over the places of its path, by which an
/// opponent comes later than the ball, s.
#[inline]
pub fn not_intercepted(margin: f32, chip: bool, c: &PassConstants) -> f32 {
    let p = likely(margin, c.time_width);
    if chip { c.chip_prior * p } else { p }
}

/// c3: the pass is long enough to react to it. The ball's time to x, s.
#[inline]
pub fn time_to_react(ball_time: f32, c: &PassConstants) -> f32 {
    likely(ball_time - c.shortest_time, c.time_width)
}

/// c4: the pass is short enough to be accurate. |x − x0|, m.
#[inline]
pub fn short_enough(distance: f32, c: &PassConstants) -> f32 {
    likely(c.longest - distance, c.distance_width)
}

/// c5: x is a reliable place: off areas, lines and teammates. The least of these margins, m.
#[inline]
pub fn reliable_place(margin: f32, c: &PassConstants) -> f32 {
    likely(margin, c.distance_width)
}

/// c1': a shot is at the goal before the keeper can be at any point of it. The shot's time, s.
#[inline]
pub fn beats_the_keeper(shot_time: f32, c: &PassConstants) -> f32 {
    likely(c.keeper_time - shot_time, c.time_width)
}

/// c2': the open angle on the goal is wide enough: from p_gmin where it is 0 evenly to 1 at θ_max and beyond.
/// rad.
#[inline]
pub fn open_goal(angle: f32, c: &PassConstants) -> f32 {
    let share = (angle / c.open_enough).clamp(0.0, 1.0);
    c.closed_prior + (1.0 - c.closed_prior) * share
}

/// c3': a shot before opponents block it: at one touch, or after a turn.
#[inline]
pub fn shot_in_time(one_touch: bool, c: &PassConstants) -> f32 {
    if one_touch { 1.0 } else { c.turn_prior }
}

/// c4': a shot before opponents steal the ball: none may in their defence area. Where attackers may not enter
/// it either, no place is inside.
#[inline]
pub fn not_stolen(in_their_area: bool, c: &PassConstants) -> f32 {
    if in_their_area && !c.their_area_forbidden { 1.0 } else { c.outside_prior }
}

/// P(we have it) after a pass that was chosen with this P(receive): an opponent that could be in its way
/// often is not, a ball that is touched is often ours again, and a sure pass may miss. For calibration; of
/// passes that were not chosen it promises too much.
#[inline]
pub fn ours_after(receive: f32) -> f32 {
    OURS_P_MIN + (OURS_P_MAX - OURS_P_MIN) * receive
}

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    fn b() -> PassConstants {
        PassConstants::of(League::DivisionB)
    }

    fn close(is: f32, by_hand: f32) {
        assert!((is - by_hand).abs() < 2e-6, "{is}, by hand {by_hand}");
    }

    // The values are those of Python's `1/(1+math.exp(-m/w))` in double precision, m and w as written beside
    // them.

    #[test]
    fn a_condition_that_just_holds_is_a_toss_and_one_width_of_margin_is_0_731() {
        close(likely(0.0, 0.1), 0.5);
        close(likely(0.1, 0.1), 0.731_058_6); // m/w = 1
        close(likely(-0.2, 0.1), 0.119_202_9); // −2
        close(likely(5.0, 0.1), 1.0); // 50
        close(likely(-5.0, 0.1), 0.0);
        close(likely(f32::NAN, 0.1), 0.0);
    }

    #[test]
    fn c1_compares_the_receivers_time_with_the_soonest_opponents() {
        close(first_there(0.8, 1.05, &b()), 0.924_141_8); // 0.25 / 0.1
        close(first_there(1.0, 0.7, &b()), 0.047_425_87); // −0.3 / 0.1
    }

    #[test]
    fn c2_falls_with_the_margin_and_chips_have_a_prior() {
        close(not_intercepted(0.15, false, &b()), 0.817_574_5); // 0.15 / 0.1
        close(not_intercepted(0.15, true, &b()), 0.408_787_2); // 0.5 of it
        close(not_intercepted(-0.4, false, &b()), 0.017_986_21); // −0.4 / 0.1
    }

    #[test]
    fn c3_wants_three_tenths_of_a_second_and_c4_five_metres() {
        close(time_to_react(0.3, &b()), 0.5);
        close(time_to_react(0.5, &b()), 0.880_797_1); // 0.2 / 0.1
        close(short_enough(5.0, &b()), 0.5);
        close(short_enough(5.3, &b()), 0.119_202_9); // −0.3 / 0.15
        close(short_enough(3.0, &b()), 0.999_998_4); // 2 / 0.15
    }

    #[test]
    fn c5_is_a_toss_at_the_margin_itself() {
        close(reliable_place(0.0, &b()), 0.5);
        close(reliable_place(0.3, &b()), 0.880_797_1); // 0.3 / 0.15
        close(reliable_place(-0.15, &b()), 0.268_941_4); // −1
    }

    #[test]
    fn c1_prime_is_a_shot_of_less_than_four_tenths_of_a_second() {
        close(beats_the_keeper(0.25, &b()), 0.817_574_5); // 0.15 / 0.1
        close(beats_the_keeper(0.6, &b()), 0.119_202_9); // −0.2 / 0.1
    }

    #[test]
    fn c2_prime_rises_evenly_from_a_tenth_to_one_at_ten_degrees() {
        let degree = math::PI / 180.0;
        close(open_goal(0.0, &b()), 0.1);
        close(open_goal(4.0 * degree, &b()), 0.46); // 0.1 + 0.9 · 0.4
        close(open_goal(10.0 * degree, &b()), 1.0);
        close(open_goal(25.0 * degree, &b()), 1.0);
    }

    #[test]
    fn c3_prime_and_c4_prime_are_priors_and_the_area_counts_in_2013_only() {
        assert_eq!((shot_in_time(true, &b()), shot_in_time(false, &b())), (1.0, 0.4));
        assert_eq!((not_stolen(false, &b()), not_stolen(true, &b())), (0.7, 0.7));
        let paper = PassConstants::of(League::Ssl2013);
        assert_eq!((not_stolen(false, &paper), not_stolen(true, &paper)), (0.7, 1.0));
    }
}
