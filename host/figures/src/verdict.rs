//! `verdict`: verdict of a retrieval as one sentence for captions; mm.

use casebase::CaseVerdict;

/// The verdict with its evidence.
pub(super) fn caption_of(verdict: &CaseVerdict, rank: Option<(usize, usize)>) -> String {
    match verdict {
        CaseVerdict::Candidate(found) => {
            let rank = rank.map_or_else(String::new, |(rank, of)| format!(", rank {rank} of {of}"));
            format!(
                "Candidate{rank}: occupied opponent scopes {}, teammates {}, similarity {:.3}, cost {:.0} mm.",
                found.conditions, found.teammates, found.similarity, found.cost
            )
        }
        CaseVerdict::Ball { similarity, .. } => {
            format!("Not applicable: the ball lies outside its scope, similarity {similarity:.3}.")
        }
        CaseVerdict::Robots { needed, present } => {
            format!("Not applicable: it needs {needed} robots, {present} are there.")
        }
        CaseVerdict::OutOfField { robot } => {
            format!("Not applicable: {robot} would stand outside the field.")
        }
        CaseVerdict::TooFar { robot, player, distance, margin } => format!(
            "Not applicable: robot {player} would have {distance:.0} mm to go as {robot}, {margin:.0} mm too far."
        ),
        CaseVerdict::Path { index, opponent, inside_mm, .. } => format!(
            "Not applicable: opponent {} stands {inside_mm:.0} mm inside leg {}.",
            opponent + 1,
            index + 1
        ),
        CaseVerdict::Opponents { scope, opponent: Some(opponent), .. } => {
            format!("Not applicable: opponent {} stands where opp{} excludes one.", opponent + 1, scope + 1)
        }
        CaseVerdict::Opponents { scope, opponent: None, .. } => {
            format!("Not applicable: no opponent stands where opp{} requires one.", scope + 1)
        }
    }
}
