//! `case_evidence`: what evidence and a report of learning say of one case, for the workbench of the page.

use std::collections::{BTreeMap, BTreeSet};

use case_tools::Files;
use serde::{Deserialize, Serialize};

use crate::learning::diff::text_of;
use crate::learning::edit::{Change, Edit};
use crate::learning::evidence::{Evidence, ScopeRing};
use crate::learning::variant::Variant;

/// Plays, and those of them in trials that ended with the ball in or close to the goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PlayCounts {
    /// Plays.
    pub plays: u64,
    /// Plays of these to goal.
    pub to_goal: u64,
}

impl PlayCounts {
    fn add(&mut self, plays: u64, to_goal: u64) {
        self.plays += plays;
        self.to_goal += to_goal;
    }
}

/// Successes and failures of a case, by where it was played.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CaseEvidence {
    /// All plays, in this library and in those before it that were learned from.
    pub all: PlayCounts,
    /// Plays in the library as it is now.
    pub now: PlayCounts,
    /// Plays with the ball in the inner half of the scope, and in the outer half.
    pub rings: [PlayCounts; 2],
    /// Plays by symmetry of the stored case.
    pub symmetries: [PlayCounts; 4],
    /// Plays with an opponent in each of the case's scopes, and without one in some.
    pub opponents: [PlayCounts; 2],
    /// Plays by area of the ball in the direction of attack: six strips along the field, each the middle and
    /// then the wings.
    pub areas: [PlayCounts; 12],
    /// All plays of any case or none in these areas: the rate that the case is compared with.
    pub usual: [PlayCounts; 12],
    /// Plays by their ends.
    pub ends: BTreeMap<String, u64>,
}

impl CaseEvidence {
    /// Sums the evidence of `case`; `library` is what is played now.
    pub fn of(evidence: &Evidence, library: &Variant, case: &str) -> Self {
        let now = format!("{:016x}", library.hash);
        let mut sums = Self::default();
        for (key, counts) in &evidence.0 {
            let (plays, to_goal) = (counts.plays, counts.to_goal);
            let area = usize::from(key.area).min(11);
            sums.usual[area].add(plays, to_goal);
            if key.case != case {
                continue;
            }
            sums.all.add(plays, to_goal);
            sums.areas[area].add(plays, to_goal);
            if key.library == now {
                sums.now.add(plays, to_goal);
            }
            sums.rings[usize::from(key.ring == ScopeRing::Risk)].add(plays, to_goal);
            sums.symmetries[usize::from(key.symmetry).min(3)].add(plays, to_goal);
            let met = key.pattern.split_once('/').is_some_and(|(held, of)| held == of);
            sums.opponents[usize::from(!met)].add(plays, to_goal);
            for (end, count) in &counts.ends {
                *sums.ends.entry(end.clone()).or_default() += count;
            }
        }
        sums
    }
}

/// A change of a case in a report of `onetwo cases learn`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProposalNote {
    /// The change in words.
    pub words: String,
    /// Reason for the try.
    pub reason: String,
    /// Verdict, as in the report.
    pub verdict: String,
    /// Pairs of its trials, and those that it raised and lowered.
    pub pairs: u64,
    /// Pairs that it raised.
    pub raised: u64,
    /// Pairs that it lowered.
    pub lowered: u64,
    /// Gain in the situations that it changes, points.
    pub gain: f64,
    /// Whether an author has refused it.
    pub refused: bool,
    /// The case's text with the change; none where it is deleted, or where the library has it already.
    pub after: Option<String>,
}

#[derive(Deserialize)]
struct Report {
    changes: Vec<Reported>,
}

#[derive(Deserialize)]
struct Reported {
    edit: Edit,
    text: String,
    reason: String,
    verdict: String,
    pairs: u64,
    raised: u64,
    lowered: u64,
    gain: f64,
}

/// The changes of `case` in the text of a `report.json`, as they would change these files; best first.
pub fn proposals_in(
    report: &str,
    files: &Files,
    case: &str,
    refused: &BTreeSet<Edit>,
) -> Result<Vec<ProposalNote>, serde_json::Error> {
    let report: Report = serde_json::from_str(report)?;
    let own = report.changes.into_iter().filter(|change| {
        // Drafts have names of their own.
        change.edit.case == case && !matches!(change.edit.change, Change::New(_) | Change::Setting(..))
    });
    let mut notes: Vec<ProposalNote> = own
        .map(|Reported { edit, text, reason, verdict, pairs, raised, lowered, gain }| {
            let after = edit.apply(files).ok().and_then(|after| text_of(&after, case).map(str::to_owned));
            let after = after.filter(|after| Some(after.as_str()) != text_of(files, case));
            let refused = refused.contains(&edit);
            ProposalNote { words: text, reason, verdict, pairs, raised, lowered, gain, refused, after }
        })
        .collect();
    notes.sort_by(|a, b| b.gain.total_cmp(&a.gain).then_with(|| a.words.cmp(&b.words)));
    Ok(notes)
}

/// The change of `case` with these words in the text of a `report.json`, if it has one.
pub fn edit_in(report: &str, case: &str, words: &str) -> Result<Option<Edit>, serde_json::Error> {
    let report: Report = serde_json::from_str(report)?;
    let own = report.changes.into_iter().find(|change| change.edit.case == case && change.text == words);
    Ok(own.map(|change| change.edit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::evidence::{EvidenceCounts, EvidenceKey};

    fn files() -> Files {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap()
    }

    #[test]
    fn plays_of_a_case_are_summed_by_ring_area_and_library() {
        let variant = Variant::new(files()).unwrap();
        let record = |library: u64, case: &str, ring, area, plays, to_goal| {
            let key = EvidenceKey {
                library: format!("{library:016x}"),
                world: String::new(),
                case: case.to_owned(),
                symmetry: 2,
                ring,
                pattern: "1/2".to_owned(),
                opponents: "dg".to_owned(),
                area,
            };
            let ends = BTreeMap::from([("finished".to_owned(), plays)]);
            (key, EvidenceCounts { plays, to_goal, ends })
        };
        let evidence = Evidence(BTreeMap::from([
            record(variant.hash, "a/b", ScopeRing::Security, 3, 10, 6),
            record(1, "a/b", ScopeRing::Risk, 3, 5, 1),
            record(1, "a/c", ScopeRing::Risk, 3, 85, 33),
        ]));
        let sums = CaseEvidence::of(&evidence, &variant, "a/b");
        let counts = |plays, to_goal| PlayCounts { plays, to_goal };
        assert_eq!((sums.all, sums.now), (counts(15, 7), counts(10, 6)));
        assert_eq!(sums.rings, [counts(10, 6), counts(5, 1)]);
        assert_eq!((sums.symmetries[2], sums.opponents[1]), (counts(15, 7), counts(15, 7)));
        assert_eq!((sums.areas[3], sums.usual[3]), (counts(15, 7), counts(100, 40)));
        assert_eq!(sums.ends["finished"], 15);
    }

    #[test]
    fn proposals_come_with_the_text_that_they_would_make() {
        let change = |edit: serde_json::Value, gain: f64| {
            serde_json::json!({ "edit": edit, "text": "x", "reason": "y", "verdict": "proposed", "pairs": 9,
                "raised": 5, "lowered": 2, "gain": gain, "e_value": 1.0 })
        };
        let case = "center/close-in";
        let report = serde_json::json!({ "changes": [
            change(serde_json::json!({ "case": case, "change": { "ball-scope": [610, 420] } }), 1.0),
            change(serde_json::json!({ "case": case, "change": "forget" }), 2.0),
            change(serde_json::json!({ "case": "front/shot", "change": "forget" }), 3.0),
        ] });
        let notes = proposals_in(&report.to_string(), &files(), case, &BTreeSet::new()).unwrap();
        assert_eq!(notes.iter().map(|note| note.after.is_some()).collect::<Vec<_>>(), [false, true]);
        assert!(notes[1].after.as_ref().unwrap().contains("scope = [610, 420]"));
        assert!(proposals_in("{}", &files(), case, &BTreeSet::new()).is_err());
    }
}
