//! `tactics`: the parts of the second paper that a team plays with. Each can be switched off, so that its
//! value can be measured: an ablation is a setting (docs/papers.md D24).

use serde::{Deserialize, Serialize};

/// The name of [`Tactics::ROUND_1`].
pub const ROUND_1: &str = "round-1";

/// What the coach uses beyond rule-compliant play. A part that a recording's header does not name was not
/// played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Tactics {
    /// Keeper and primary defenders by the first-level threat (Biswas et al. 2014 §5.1), not by the ball's
    /// line alone.
    #[serde(default)]
    pub threats: bool,
    /// While the ball is theirs, the others against second-level threats (§5.2).
    #[serde(default)]
    pub second_level: bool,
    /// Passes of our restarts by P(receive) · P(goal), timed by pass-ahead (§3).
    #[serde(default)]
    pub pass_ahead: bool,
    /// Our free kicks by the Coerce and Attack Planner (§4).
    #[serde(default)]
    pub coerce: bool,
    /// Shots and passes of open play: the robot first at the ball shoots or passes by P(goal) where that is
    /// worth it; else cases are played.
    #[serde(default)]
    pub attack: bool,
    /// Passes of the case that is played, as refined by pass location and pass-ahead (docs/papers.md §8);
    /// with `rated`, the case that robots would retrieve is one of the rated actions.
    #[serde(default)]
    pub bridge: bool,
    /// Open play by possession and one rated list of actions; else by the thresholds of `attack`.
    #[serde(default)]
    pub rated: bool,
    /// Rated actions by score and time left: risks when behind, none when ahead. No part of the paper.
    #[serde(default)]
    pub by_score: bool,
}

impl Tactics {
    /// No part of the paper: every tactic off.
    pub const NONE: Self = Self {
        threats: false,
        second_level: false,
        pass_ahead: false,
        coerce: false,
        attack: false,
        bridge: false,
        rated: false,
        by_score: false,
    };
    /// All parts of the paper; the default has fewer.
    pub const ALL: Self = Self {
        threats: true,
        second_level: true,
        pass_ahead: true,
        coerce: true,
        attack: true,
        bridge: true,
        rated: true,
        by_score: false,
    };

    /// Open play by thresholds and cases: a reference opponent that stays as it is when the default tactics
    /// change.
    pub const ROUND_1: Self = Self { threats: true, second_level: true, attack: true, ..Self::NONE };

    /// None: the meaning of a header without tactics.
    pub fn none() -> Self {
        Self::NONE
    }

    /// Text that [`Tactics::parse`] reads.
    pub fn description(&self) -> String {
        let Self { threats, second_level, pass_ahead, coerce, attack, bridge, rated, by_score } = *self;
        let named = [
            (threats, "threats"),
            (second_level, "second-level"),
            (pass_ahead, "pass-ahead"),
            (coerce, "coerce"),
            (attack, "attack"),
            (bridge, "bridge"),
            (rated, "rated"),
            (by_score, "by-score"),
        ];
        let description: Vec<_> = named.into_iter().filter(|(on, _)| *on).map(|(_, name)| name).collect();
        if description.is_empty() { "none".to_owned() } else { description.join(",") }
    }

    /// From `none`, `all`, `default` (`usual` until version 0.2), [`ROUND_1`], or names with commas between,
    /// such as `threats,pass-ahead`.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "none" => return Ok(Self::NONE),
            "all" => return Ok(Self::ALL),
            "default" | "usual" => return Ok(Self::default()),
            ROUND_1 => return Ok(Self::ROUND_1),
            _ => {}
        }
        let mut tactics = Self::NONE;
        for label in text.split(',') {
            let part = match label {
                "threats" => &mut tactics.threats,
                "second-level" => &mut tactics.second_level,
                "pass-ahead" => &mut tactics.pass_ahead,
                "coerce" => &mut tactics.coerce,
                "attack" => &mut tactics.attack,
                "bridge" => &mut tactics.bridge,
                "rated" => &mut tactics.rated,
                "by-score" => &mut tactics.by_score,
                _ => {
                    return Err(format!(
                        "`{label}` is no tactic; none, all, default, {ROUND_1}, or some of threats, second-level, pass-ahead, coerce, attack, bridge, rated, by-score"
                    ));
                }
            };
            *part = true;
        }
        Ok(tactics)
    }
}

impl Default for Tactics {
    /// The parts that win matches. `docs/matches.md` (`cargo xtask matches`) has the value of each part
    /// against our team without it: threats and their second level gain goals; the effects of pass-ahead and
    /// coerce are not significant. The rated list with cases in it wins more goals than [`Self::ROUND_1`]
    /// (docs/strategy.md).
    fn default() -> Self {
        Self { bridge: true, rated: true, ..Self::ROUND_1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tactics_are_named_one_by_one_and_a_wrong_name_is_reported() {
        assert_eq!(Tactics::parse("none"), Ok(Tactics::NONE));
        assert_eq!(
            ["default", "usual"].map(Tactics::parse),
            [Ok(Tactics::default()), Ok(Tactics::default())]
        );
        let some = Tactics::parse("threats,coerce").unwrap();
        assert_eq!(some, Tactics { threats: true, coerce: true, ..Tactics::NONE });
        for tactics in [Tactics::NONE, some, Tactics::ALL] {
            assert_eq!(Tactics::parse(&tactics.description()), Ok(tactics));
        }
        assert_eq!(Tactics::parse(ROUND_1), Tactics::parse("threats,second-level,attack"));
        assert!(Tactics::parse("threats,").unwrap_err().contains("second-level"));
    }

    #[test]
    fn what_a_header_does_not_name_was_not_played() {
        let read: Tactics = serde_json::from_str("{\"threats\":true}").unwrap();
        assert_eq!(read, Tactics { threats: true, ..Tactics::NONE });
    }
}
