//! `verdicts`: claims and verdicts as terminal text. The claims of the paper in a line each, the lines of the
//! pattern with their numbers.

use std::fmt::Write as _;

use super::claims::{Claim, ClaimVerdict, Judgement};
use super::judge::JudgementLine;
use super::results::Results;

/// Both, as text; `claims.json` has the numbers behind every claim.
pub fn verdicts(results: &Results) -> String {
    claims(&results.claims) + &lines(&results.lines)
}

fn claims(claims: &[Claim]) -> String {
    let mut text =
        "What the paper says, by our trials and by its own tables (claims.json has the numbers)\n".to_owned();
    let has_more = claims.iter().any(|claim| claim.ours_as_paper.is_some());
    // The verdict of as many trials as the paper's, where there were more.
    let as_paper = |label: &str| if has_more { format!("{label:14}") } else { String::new() };
    let _ = writeln!(text, "  {:14}{}{:14}§", "ours", as_paper("ours, of 30"), "the paper's");
    for Claim { section, sentence, ours, ours_as_paper, paper, .. } in claims {
        let label = |judgement: &Judgement| judgement.verdict.label();
        let of_30 = as_paper(ours_as_paper.as_ref().map_or("", label));
        let _ = writeln!(text, "  {:14}{of_30}{:14}{section:7}{sentence}", label(ours), label(paper));
    }
    let count = |verdict| claims.iter().filter(|claim| claim.ours.verdict == verdict).count();
    let _ = writeln!(
        text,
        "{} supported, {} contradicted, {} undecided, {} unmeasured\n",
        count(ClaimVerdict::Supported),
        count(ClaimVerdict::Contradicted),
        count(ClaimVerdict::Undecided),
        count(ClaimVerdict::Unmeasured)
    );
    text
}

fn lines(lines: &[JudgementLine]) -> String {
    let mut text = "The pattern of its results, and what is asked of ours\n".to_owned();
    let width = lines.iter().map(|line| line.id.len()).max().unwrap_or_default();
    for JudgementLine { id, line, verdict, evidence } in lines {
        let _ = writeln!(text, "  {:10}  {id:width$}  {line}", verdict.label());
        if !evidence.is_empty() {
            let _ = writeln!(text, "  {:10}  {:width$}  {evidence}", "", "");
        }
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::claims::claims as judged;
    use crate::evaluation::judge::judge;
    use crate::evaluation::paper::paper;

    #[test]
    fn every_claim_and_line_is_there_with_its_verdict() {
        let (claimed, judged) = (judged(paper(), paper()), judge(paper()));
        let (first, second) = (claims(&claimed), lines(&judged));
        assert_eq!(first.lines().count(), claimed.len() + 4);
        let of_out =
            "  supported     supported     5.2.1  Fewer balls go out with cases, in all four scenarios.";
        assert!(first.contains(of_out), "{first}");
        assert!(
            second.contains("  held        g                 trials of 15 to 34 s on average"),
            "{second}"
        );
        assert!(second.contains("24.4, 28.7, 27.0, 15.9, 20.4"), "{second}");
    }
}
