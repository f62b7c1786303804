//! `collected`: what recordings give to learning: evidence, and successful plays. Both merge in any order.

use std::collections::BTreeSet;

use arena::successful_plays::SuccessfulPlay;
use serde::{Deserialize, Serialize};

use crate::learning::evidence::{Evidence, PLAY_LINE};

/// Evidence and plays; as text `evidence.jsonl` with a line for each play behind the records.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Collected {
    /// Outcomes of cases.
    pub evidence: Evidence,
    /// Plays that led to a shot or a goal. The same play of two files is one.
    pub plays: BTreeSet<SuccessfulPlay>,
}

#[derive(Serialize, Deserialize)]
struct PlayLine {
    play: SuccessfulPlay,
}

impl From<Evidence> for Collected {
    fn from(evidence: Evidence) -> Self {
        Self { evidence, plays: BTreeSet::new() }
    }
}

impl Collected {
    /// The sum of both; their evidence must be of different trials and matches.
    #[must_use]
    pub fn merge(mut self, other: Self) -> Self {
        self.plays.extend(other.plays);
        Self { evidence: self.evidence.merge(other.evidence), plays: self.plays }
    }

    /// The text of `evidence.jsonl`.
    pub fn to_jsonl(&self) -> String {
        let mut text = self.evidence.to_jsonl();
        for play in &self.plays {
            // Whole numbers and strings: it always serialises.
            text += &serde_json::to_string(&PlayLine { play: play.clone() }).unwrap_or_default();
            text.push('\n');
        }
        text
    }

    /// Reads such a text; an error names its line.
    pub fn from_jsonl(text: &str) -> Result<Self, String> {
        let mut collected = Self::from(Evidence::from_jsonl(text)?);
        for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| line.starts_with(PLAY_LINE)) {
            let PlayLine { play } =
                serde_json::from_str(line).map_err(|error| format!("line {number}: {error}"))?;
            if !play.is_sane() {
                return Err(format!("line {number}: a play outside any field; collect the evidence again"));
            }
            collected.plays.insert(play);
        }
        Ok(collected)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use arena::successful_plays::{Holding, PlayEnd};

    use super::*;

    /// A pass of robot 1 from (-200, 100) to robot 2 at (900, -700), which carries on and shoots.
    pub(crate) fn play() -> SuccessfulPlay {
        SuccessfulPlay {
            field: [5400, 3600],
            teammates: vec![(1, [-350, 100]), (2, [880, -720]), (4, [-2000, 0])],
            opponents: vec![[400, 900], [2500, 0], [-2500, -1500]],
            holdings: vec![
                Holding { robot: 1, got: [-200, 100], left: [-150, 100] },
                Holding { robot: 2, got: [900, -700], left: [1300, -500] },
            ],
            end: PlayEnd::Shot(280),
            goal: true,
        }
    }

    #[test]
    fn plays_stand_behind_the_records_and_merge_in_any_order() {
        let one = Collected { plays: BTreeSet::from([play()]), ..Collected::default() };
        let other = SuccessfulPlay { goal: false, ..play() };
        let two = Collected { plays: BTreeSet::from([other, play()]), ..Collected::default() };
        let both = one.clone().merge(two.clone());
        assert_eq!((both.plays.len(), &both), (2, &two.merge(one)));
        let text = both.to_jsonl();
        assert_eq!(Collected::from_jsonl(&text), Ok(both));
        assert_eq!(
            Evidence::from_jsonl(&text),
            Ok(Evidence::default()),
            "for those that ask for cases alone"
        );
    }

    #[test]
    fn a_play_that_is_none_is_refused_with_its_line() {
        let one = Collected { plays: BTreeSet::from([play()]), ..Collected::default() };
        let text = one.to_jsonl();
        for (from, to) in [("5400", "-5"), ("\"robot\":2", "\"robot\":9"), ("280", "2000000000"), ("}}", "")]
        {
            assert!(text.contains(from));
            let fault = Collected::from_jsonl(&format!("\n{}", text.replacen(from, to, 1))).unwrap_err();
            assert!(fault.starts_with("line 2: "), "{fault}");
        }
    }
}
