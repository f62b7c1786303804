//! `math`: elementary functions with equal bits on PC and Cortex-M (docs/architecture.md §2.4).
//!
//! √ is one `vsqrt.f32` on the target and libm on the host (both correctly rounded, so equal); sine and
//! cosine are single-precision polynomials (libm's use doubles: soft-float on an M4F, about 50 times dearer);
//! all other functions are libm's, rounding is micromath's (exact). Never call `f32`'s own methods of these
//! names in shared code: on the host they are the C library's, whose bits differ.
#![cfg_attr(target_arch = "arm", allow(unsafe_code, reason = "one instruction that core does not offer"))]

pub use core::f32::consts::{FRAC_PI_2, PI, TAU};

/// Square root, correctly rounded. Negative input gives NaN.
#[inline]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(target_arch = "arm")]
    {
        onetwo_vsqrt(x)
    }
    #[cfg(not(target_arch = "arm"))]
    {
        libm::sqrtf(x)
    }
}

/// √(x² + y²), without protection against overflow (unlikely for lengths of a field).
#[inline]
pub fn hypot(x: f32, y: f32) -> f32 {
    sqrt(x * x + y * y)
}

/// The larger of two numbers, as `f32::max`: of a NaN and a number it is the number. On an M4F that one is a
/// call; this is two comparisons, and one where the second is a known number.
#[inline]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b || b.is_nan() { a } else { b }
}

/// The smaller of two numbers, as `f32::min`; see [`max`].
#[inline]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b || b.is_nan() { a } else { b }
}

/// `(sin x, cos x)`; absolute error below 2e-7 for |x| < 1,000 rad (tested), invalid beyond 10,000.
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (r, quadrant) = reduce(x);
    let (s, c) = (sin_core(r), cos_core(r));
    let (a, b) = if quadrant & 1 == 0 { (s, c) } else { (c, s) };
    (if quadrant & 2 == 0 { a } else { -a }, if quadrant.wrapping_add(1) & 2 == 0 { b } else { -b })
}

/// Angle of the vector (x, y) from +x, in (−π, π]; `atan2(0, 0)` is 0.
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// Exponential function, eˣ, by libm.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// Natural logarithm by libm; NaN below 0.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// Largest whole number not above `x`; exact for |x| < 2³¹.
#[inline]
pub fn floor(x: f32) -> f32 {
    micromath::F32(x).floor().0
}

/// `x` within `[low, high]`; NaN stays NaN. Never panics, unlike `f32::clamp`: bounds that contradict each
/// other, or are NaN, give `high`, or are no bounds.
#[inline]
pub fn clamp(x: f32, low: f32, high: f32) -> f32 {
    let x = if x < low { low } else { x };
    if x > high { high } else { x }
}

/// Nearest whole number, halves away from zero, as `i32`; saturates, NaN gives 0.
#[inline]
pub fn round_to_i32(x: f32) -> i32 {
    if x >= 0.0 { (x + 0.5) as i32 } else { (x - 0.5) as i32 }
}

/// FNV-1a-64 over the bits of `rounds` evaluations of every function here, on a fixed pseudo-random input.
///
/// Host and target must print the same number; [`GOLDEN_ROUNDS`] and [`GOLDEN_HASH`] fix it.
pub fn golden_hash(rounds: u32) -> u64 {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for _ in 0..rounds {
        let (a, b) = (pseudo_random(&mut state, 50.0), pseudo_random(&mut state, 8.0));
        let (s, c) = sin_cos(a);
        let rotated = nalgebra::Matrix2::new(c, -s, s, c) * nalgebra::Vector2::new(a, b);
        let powers = [sqrt(a * a), hypot(a, b), atan2(a, b), exp(b), ln(a * a + 1.0)];
        let rounded = [floor(a), round_to_i32(a * 100.0) as f32];
        let values = [s, c].into_iter().chain(powers).chain(rounded).chain([rotated.x, rotated.y]);
        for byte in values.flat_map(|value| value.to_bits().to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    hash
}

/// The next number from −`range` to `range` of a fixed sequence: xorshift64.
fn pseudo_random(state: &mut u64, range: f32) -> f32 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (((*state >> 40) as i32) - (1 << 23)) as f32 * (range / 8_388_608.0)
}

/// Rounds of [`golden_hash`] that [`GOLDEN_HASH`] was taken with.
pub const GOLDEN_ROUNDS: u32 = 10_000;
/// The value of [`golden_hash`] on every platform; a new value means that shared mathematics changed its
/// bits.
pub const GOLDEN_HASH: u64 = 0x1c00e65377661807;

/// Cody–Waite reduction by π/2 in three pieces: the remainder in about ±π/4 and the quadrant.
#[inline]
fn reduce(x: f32) -> (f32, i32) {
    let quadrant = round_to_i32(x * core::f32::consts::FRAC_2_PI);
    let q = quadrant as f32;
    (((x - q * 1.570_312_5) - q * 4.837_513e-4) - q * 7.549_79e-8, quadrant)
}

/// Minimax polynomial of sine on ±π/4 (Cephes' coefficients).
#[inline]
fn sin_core(r: f32) -> f32 {
    let z = r * r;
    r + r * z * (-1.666_665_5e-1 + z * (8.332_161e-3 + z * -1.951_529_6e-4))
}

/// Minimax polynomial of cosine on ±π/4 (Cephes' coefficients).
#[inline]
fn cos_core(r: f32) -> f32 {
    let z = r * r;
    1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5))
}

// rustc 1.95 refuses `asm!`'s `sreg` operands on this target, so the instruction is reached through the
// hard-float calling convention: three instructions with the call, against 77 for libm's.
#[cfg(target_arch = "arm")]
core::arch::global_asm!(
    ".syntax unified",
    ".thumb",
    ".fpu fpv4-sp-d16",
    ".section .text.onetwo_vsqrt,\"ax\",%progbits",
    ".global onetwo_vsqrt",
    ".type onetwo_vsqrt,%function",
    ".thumb_func",
    "onetwo_vsqrt:",
    "vsqrt.f32 s0, s0",
    "bx lr",
);

#[cfg(target_arch = "arm")]
unsafe extern "C" {
    safe fn onetwo_vsqrt(x: f32) -> f32;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clamp_is_the_standards_where_that_has_an_answer_and_never_panics() {
        for x in [-3.0, -1.0, -0.0, 0.0, 0.5, 1.0, 2.0, f32::INFINITY, f32::NEG_INFINITY] {
            for (low, high) in [(-1.0, 1.0), (0.0, 0.0), (-0.0, 0.0), (0.25, 0.75)] {
                assert_eq!(clamp(x, low, high).to_bits(), x.clamp(low, high).to_bits(), "{x} {low} {high}");
            }
        }
        assert!(clamp(f32::NAN, -1.0, 1.0).is_nan());
        assert_eq!(clamp(0.5, 1.0, -1.0), -1.0);
        assert_eq!(clamp(7.0, f32::NAN, f32::NAN), 7.0);
    }

    #[test]
    fn the_larger_and_the_smaller_are_the_standard_librarys() {
        let all =
            [f32::NEG_INFINITY, -2.5, -f32::MIN_POSITIVE, 0.0, 1e-40, 1.0, f32::MAX, f32::INFINITY, f32::NAN];
        for a in all {
            for b in all {
                assert_eq!(max(a, b).to_bits(), a.max(b).to_bits(), "{a} {b}");
                assert_eq!(min(a, b).to_bits(), a.min(b).to_bits(), "{a} {b}");
            }
        }
    }

    #[test]
    fn sine_and_cosine_are_within_two_parts_in_ten_million() {
        let mut worst = 0.0_f64;
        for i in -100_000..=100_000 {
            let x = i as f32 * 0.01;
            let (s, c) = sin_cos(x);
            worst = worst.max((f64::from(s) - libm::sin(f64::from(x))).abs());
            worst = worst.max((f64::from(c) - libm::cos(f64::from(x))).abs());
        }
        assert!(worst < 2e-7, "worst error {worst}");
    }

    #[test]
    fn rounding_is_to_nearest_and_halves_go_away_from_zero() {
        assert_eq!([0.4, 0.5, -0.5, -1.49, 2.5].map(round_to_i32), [0, 1, -1, -1, 3]);
        assert_eq!([-0.5, 0.5, 3.0, -3.0].map(floor), [-1.0, 0.0, 3.0, -3.0]);
        assert_eq!(round_to_i32(f32::NAN), 0);
        assert_eq!(round_to_i32(1e20), i32::MAX);
    }

    #[test]
    fn the_golden_hash_stands() {
        let hash = golden_hash(GOLDEN_ROUNDS);
        assert_eq!(hash, GOLDEN_HASH, "golden hash is {hash:#018x}");
    }
}
