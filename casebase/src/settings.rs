//! `settings`: the named settings of retrieval (docs/case-format.md §3.2), one for each reading of the paper,
//! each declared once.
//!
//! `--set name=value` reaches [`RetrievalSettings::set`]; [`RetrievalSettings::describe`] is recorded with
//! every result.

use core::fmt::{self, Write as _};

use geometry::math;
use serde::{Deserialize, Serialize};

/// Value of its Gaussian at which a scope or a trajectory ends: about e⁻¹, the ellipse with radii τx, τy; the
/// paper's literal (Ros et al. 2009, §3.1).
pub const SCOPE_THRESHOLD: f32 = 0.367;
/// −ln [`SCOPE_THRESHOLD`]: exponents below it are inside.
pub const SCOPE_EXPONENT: f32 = 1.002_393_4;
/// thr_c: maximum distance from a robot to its adapted position, mm (Ros et al. 2009, §3.2).
pub const TRAVEL_MAX_MM: f32 = 1500.0;
/// Minimum freedom of a fuzzy path: 1 − [`SCOPE_THRESHOLD`], which accepts the same cases as `crisp`.
pub const FREE_MIN: f32 = 1.0 - SCOPE_THRESHOLD;

/// Longest `lookahead`, s: nothing keeps its velocity for longer.
const LOOKAHEAD_MAX_S: f32 = 3.0;

/// The options of retrieval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RetrievalSettings {
    /// `correspondence`: when thr_c applies.
    pub correspondence: CorrespondenceRule,
    /// `cost`: cost of a correspondence.
    pub cost: CostRule,
    /// `ranking`: order of the criteria.
    pub ranking: [Criterion; 3],
    /// `out_of_field`: treatment of an adapted position outside the lines.
    pub out_of_field: OutOfField,
    /// `scopes`: whether the opponents' scopes move with the ball.
    pub scopes: ScopeRule,
    /// `free_path`: whether a path is free or not, or free to a degree.
    pub free_path: FreePathRule,
    /// `thr_c`: maximum distance of a robot to its adapted position, mm.
    pub travel_max_mm: f32,
    /// `thr`: thr_b, thr_opp and thr_t.
    pub threshold: f32,
    /// `free_min`: minimum freedom of a fuzzy path.
    pub free_min: f32,
    /// `lookahead`: opponents are tested where they will be after so long at their present velocity, s.
    pub lookahead_s: f32,
}

geometry::labels! {
    /// Time at which the travel limit applies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum CorrespondenceRule {
        /// The cheapest correspondence is found, then tested (Algorithm 1 as printed).
        MinThenTest = "min-then-test",
        /// Only correspondences within the limit are searched (the text of §3.2).
        Constrained = "constrained",
    }

    /// Cost of a correspondence.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum CostRule {
        /// The sum of the distances: the paper's choice, no crossing paths.
        Sum = "sum",
        /// The largest of the distances.
        Max = "max",
    }

    /// One step of the ranking.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Criterion {
        /// More opponent scopes occupied.
        Conditions = "conditions",
        /// More robots in the case.
        Teammates = "teammates",
        /// Higher similarity interval, then lower cost.
        IntervalCost = "interval-cost",
    }

    /// Treatment of an adapted position outside the lines.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum OutOfField {
        /// The position stays where it is.
        Keep = "keep",
        /// The position moves to the nearest point of the field; costs and legs follow.
        Clamp = "clamp",
        /// The case is not a candidate.
        Reject = "reject",
    }

    /// Position of the opponents' scopes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ScopeRule {
        /// Moved with the ball, as in the paper's text and Fig. 2b.
        Translated = "translated",
        /// At the case's own positions, as in the paper's formula.
        Absolute = "absolute",
    }

    /// Required freedom of a path.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum FreePathRule {
        /// No opponent above the threshold in any leg.
        Crisp = "crisp",
        /// Free to the degree 1 − max μ: a candidate needs `free_min`, and among cases equal so far the freer
        /// ranks before interval and cost.
        Fuzzy = "fuzzy",
    }
}

impl Default for RetrievalSettings {
    fn default() -> Self {
        Self {
            correspondence: CorrespondenceRule::MinThenTest,
            cost: CostRule::Sum,
            ranking: [Criterion::Conditions, Criterion::Teammates, Criterion::IntervalCost],
            out_of_field: OutOfField::Keep,
            scopes: ScopeRule::Translated,
            free_path: FreePathRule::Crisp,
            travel_max_mm: TRAVEL_MAX_MM,
            threshold: SCOPE_THRESHOLD,
            free_min: FREE_MIN,
            lookahead_s: 0.0,
        }
    }
}

impl RetrievalSettings {
    /// Sets one option by its name; on an error the settings stay unchanged.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), SettingError> {
        let setting =
            SETTINGS.iter().find(|setting| setting.name == name).ok_or(SettingError::UnknownName)?;
        (setting.set)(self, value.trim())
            .ok_or(SettingError::BadValue { name: setting.name, expected: setting.expected })
    }

    /// Name and value of every setting, in a fixed order; [`RetrievalSettings::set`] reads them back.
    pub fn describe(&self) -> impl Iterator<Item = (&'static str, SettingValue)> + '_ {
        SETTINGS.iter().map(|setting| {
            let mut text = SettingValue::new();
            // The longest value is a ranking of 33 letters, or an f32 of at most 50 digits: it fits.
            let _ = (setting.get)(self, &mut text);
            (setting.name, text)
        })
    }

    /// The exponent at which a scope or a trajectory ends.
    #[inline]
    pub fn limit(&self) -> f32 {
        if self.threshold == SCOPE_THRESHOLD { SCOPE_EXPONENT } else { -math::ln(self.threshold) }
    }
}

/// A setting's value as text.
pub type SettingValue = heapless::String<64>;

/// Reason why a setting was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingError {
    /// No setting has this name.
    UnknownName,
    /// The setting does not accept this value.
    BadValue {
        /// Name of the setting, as `--set` takes it.
        name: &'static str,
        /// The accepted values, as text for the error message.
        expected: &'static str,
    },
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownName => {
                f.write_str("no such setting; there are ")?;
                for (i, setting) in SETTINGS.iter().enumerate() {
                    f.write_str(if i == 0 { "" } else { ", " })?;
                    f.write_str(setting.name)?;
                }
                Ok(())
            }
            Self::BadValue { name, expected } => write!(f, "{name} takes {expected}"),
        }
    }
}
impl core::error::Error for SettingError {}

/// A setting's name, its accepted values, and how it is written and read.
struct Setting {
    name: &'static str,
    expected: &'static str,
    set: fn(&mut RetrievalSettings, &str) -> Option<()>,
    get: fn(&RetrievalSettings, &mut SettingValue) -> fmt::Result,
}

/// A permutation of the three criteria, with or without brackets.
fn parse_ranking(value: &str) -> Option<[Criterion; 3]> {
    let inner = value.strip_prefix('[').and_then(|v| v.strip_suffix(']')).unwrap_or(value);
    let mut criteria = inner.split(',').map(|name| Criterion::from_label(name.trim()));
    let ranking = [criteria.next()??, criteria.next()??, criteria.next()??];
    let all_different = ranking[0] != ranking[1] && ranking[1] != ranking[2] && ranking[0] != ranking[2];
    (criteria.next().is_none() && all_different).then_some(ranking)
}

fn parse_number(value: &str, allowed: impl Fn(f32) -> bool) -> Option<f32> {
    value.parse().ok().filter(|number: &f32| number.is_finite() && allowed(*number))
}

/// A setting that is one of an enum's labels, or a number that is allowed.
macro_rules! setting {
    ($name:literal, $field:ident: $rule:ident, $expected:literal) => {
        Setting {
            name: $name,
            expected: $expected,
            set: |s, v| $rule::from_label(v).map(|v| s.$field = v),
            get: |s, out| out.write_str(s.$field.label()),
        }
    };
    ($name:literal, $field:ident, $expected:literal, $allowed:expr) => {
        Setting {
            name: $name,
            expected: $expected,
            set: |s, v| parse_number(v, $allowed).map(|v| s.$field = v),
            get: |s, out| write!(out, "{}", s.$field),
        }
    };
}

const SETTINGS: &[Setting] = &[
    setting!("correspondence", correspondence: CorrespondenceRule, "min-then-test or constrained"),
    setting!("cost", cost: CostRule, "sum or max"),
    Setting {
        name: "ranking",
        expected: "conditions,teammates,interval-cost in any order",
        set: |s, v| parse_ranking(v).map(|v| s.ranking = v),
        get: |s, out| {
            let [a, b, c] = s.ranking.map(Criterion::label);
            write!(out, "{a},{b},{c}")
        },
    },
    setting!("out_of_field", out_of_field: OutOfField, "keep, clamp or reject"),
    setting!("scopes", scopes: ScopeRule, "translated or absolute"),
    setting!("free_path", free_path: FreePathRule, "crisp or fuzzy"),
    setting!("thr_c", travel_max_mm, "a distance in mm, 0 or more", |n| n >= 0.0),
    setting!("thr", threshold, "a number above 0 and below 1", |n| n > 0.0 && n < 1.0),
    setting!("free_min", free_min, "a number from 0 to 1", |n| (0.0..=1.0).contains(&n)),
    setting!("lookahead", lookahead_s, "a time in s from 0 to 3", |n| (0.0..=LOOKAHEAD_MAX_S).contains(&n)),
];

#[cfg(test)]
mod tests {
    extern crate std;
    use std::string::ToString;

    use super::*;

    #[test]
    fn the_limit_is_the_negated_logarithm_of_the_papers_literal() {
        assert!((f64::from(SCOPE_EXPONENT) + 0.367_f64.ln()).abs() < 1e-7);
        assert_eq!(RetrievalSettings::default().limit(), SCOPE_EXPONENT);
        let half = RetrievalSettings { threshold: 0.5, ..RetrievalSettings::default() };
        assert!((half.limit() - core::f32::consts::LN_2).abs() < 1e-6);
    }

    #[test]
    fn described_settings_can_be_set_again() {
        let mut changed = RetrievalSettings::default();
        for (name, value) in [
            ("correspondence", "constrained"),
            ("cost", "max"),
            ("ranking", "[teammates, interval-cost, conditions]"),
            ("out_of_field", "clamp"),
            ("scopes", "absolute"),
            ("free_path", "fuzzy"),
            ("thr_c", "900.5"),
            ("thr", "0.5"),
            ("free_min", "0.25"),
            ("lookahead", "0.5"),
        ] {
            changed.set(name, value).unwrap();
        }
        let mut copy = RetrievalSettings::default();
        for (name, value) in changed.describe() {
            copy.set(name, &value).unwrap();
        }
        assert_eq!(copy, changed);
        assert_eq!(copy.describe().count(), 10);
    }

    #[test]
    fn a_wrong_setting_says_what_is_allowed() {
        let mut settings = RetrievalSettings::default();
        let unknown = settings.set("thr_x", "1").unwrap_err();
        assert!(unknown.to_string().contains("thr_c, thr, free_min, lookahead"), "{unknown}");
        for (name, value) in [
            ("cost", "avg"),
            ("ranking", "conditions,conditions,teammates"),
            ("ranking", "conditions,teammates"),
            ("thr", "0"),
            ("thr", "nan"),
            ("thr_c", "-1"),
            ("lookahead", "4"),
        ] {
            let error = settings.set(name, value).unwrap_err();
            assert!(error.to_string().starts_with(name), "{error}");
        }
        assert_eq!(settings, RetrievalSettings::default());
    }
}
