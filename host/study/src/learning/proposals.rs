//! `proposals`: single edits that evidence suggests: scopes grown and shrunk, positions and actions varied,
//! cases forgotten. mm.
//!
//! Ring by ring as Ros & Arcos 2007: the risk ring moves, the security ring stands, so a scope shrinks to
//! half its area at most in one step. A proposal's weight is the number of plays that it touches times how
//! far they are from what is usual there; trials decide, weights only say what to try first.

use std::collections::BTreeMap;

use case_tools::CaseLeague;
use case_tools::workbench::{ActionText, CaseText, Part};
use casebase::{OPPONENTS_MAX, Presence};
use serde::{Deserialize, Serialize};

use crate::learning::competence::{CaseStanding, Standing};
use crate::learning::edit::{Change, Edit, RETRIEVAL};
use crate::learning::goalkeeper;
use crate::learning::variant::Variant;

geometry::labels! {
    /// Kinds of changes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Kind {
        /// Radii of ball and opponents' scopes.
        Scopes = "scopes",
        /// Positions and actions.
        Actions = "actions",
        /// New cases.
        New = "new",
        /// Deleted cases.
        Forget = "forget",
        /// The ranking's order, and the thresholds and rules of retrieval.
        Order = "order",
    }
}

/// A change to be tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proposal {
    /// Kind of change.
    pub kind: Kind,
    /// The edit.
    pub edit: Edit,
    /// Reason for it: the evidence, as a sentence.
    pub reason: String,
    /// Estimate of its worth, plays times rate.
    pub weight: f64,
}

/// Number of times that an edit was tried, by the hash of the text that it was tried on.
pub(crate) type Tried = BTreeMap<(u64, Edit), u32>;

/// An edit that was tried as often is not proposed again.
pub(crate) const TRIED_MAX: u32 = 3;

/// Proposals of a kind from evidence, heaviest first; every time that one was tried halves its weight.
pub(crate) fn from_evidence(
    variant: &Variant,
    standings: &BTreeMap<String, CaseStanding>,
    kind: Kind,
    tried: &Tried,
) -> Vec<Proposal> {
    let mut proposals = Vec::new();
    let kicks = kicks(variant);
    let typical = typical_scope(variant);
    for file in &variant.files.cases {
        let (Ok(text), Some(standing)) = (CaseText::read(&file.text), standings.get(&file.name)) else {
            continue;
        };
        if standing.all.plays() < PLAYS_MIN {
            continue;
        }
        let draft = Draft { case: &file.name, text: &text, standing };
        match kind {
            Kind::Scopes => {
                draft.scopes(typical, &mut proposals);
                draft.presences(&mut proposals);
            }
            Kind::Actions => draft.actions(&kicks, &mut proposals),
            Kind::Forget => draft.forget(&mut proposals),
            Kind::New | Kind::Order => {}
        }
    }
    if kind == Kind::Order {
        proposals.extend(order_proposals(variant));
    }
    weigh(proposals, variant, tried)
}

/// Proposals that may still be tried, heaviest first; every try halves the weight.
pub(crate) fn weigh(mut proposals: Vec<Proposal>, variant: &Variant, tried: &Tried) -> Vec<Proposal> {
    proposals.retain_mut(|proposal| {
        let key = (text_hash(variant, &proposal.edit.case), proposal.edit.clone());
        let times = tried.get(&key).copied().unwrap_or_default();
        (0..times).for_each(|_| proposal.weight *= 0.5);
        times < TRIED_MAX
    });
    proposals.sort_by(|a, b| b.weight.total_cmp(&a.weight).then_with(|| a.edit.cmp(&b.edit)));
    proposals
}

/// One setting of retrieval at another value, the others as they are: the edits that learning tries.
pub fn order_edits(variant: &Variant) -> Vec<Edit> {
    order_proposals(variant).into_iter().map(|proposal| proposal.edit).collect()
}

fn order_proposals(variant: &Variant) -> Vec<Proposal> {
    let now: BTreeMap<String, String> = (variant.settings.describe())
        .map(|(name, value)| (name.to_owned(), value.as_str().to_owned()))
        .collect();
    let mut values: Vec<(&str, String)> = Vec::new();
    let criteria = ["conditions", "teammates", "interval-cost"];
    for (i, first) in criteria.iter().enumerate() {
        let [a, b] = [criteria[(i + 1) % 3], criteria[(i + 2) % 3]];
        values.extend([[a, b], [b, a]].map(|[a, b]| ("ranking", format!("{first},{a},{b}"))));
    }
    for (name, rules) in RULES {
        values.extend(rules.iter().map(|rule| (*name, (*rule).to_owned())));
    }
    for (name, times) in TIMES {
        values.extend(times.iter().map(|time| (*name, format!("{time}"))));
    }
    for (name, factors) in FACTORS {
        let value: Option<f64> = now.get(*name).and_then(|value| value.parse().ok());
        values.extend(value.into_iter().flat_map(|value| {
            factors
                .iter()
                .map(move |factor| (*name, format!("{}", (value * factor * 1000.0).round() / 1000.0)))
        }));
    }
    let other = values.into_iter().filter(|(name, value)| now.get(*name) != Some(value));
    other
        .map(|(name, value)| Proposal {
            kind: Kind::Order,
            reason: format!("{name} is {}", now.get(name).map_or("", String::as_str)),
            edit: Edit { case: RETRIEVAL.to_owned(), change: Change::Setting(name.to_owned(), value) },
            weight: 1.0,
        })
        .collect()
}

/// Rules of retrieval with the values that they can have.
const RULES: &[(&str, &[&str])] = &[
    ("correspondence", &["min-then-test", "constrained"]),
    ("cost", &["sum", "max"]),
    ("out_of_field", &["keep", "clamp", "reject"]),
    ("scopes", &["translated", "absolute"]),
    ("free_path", &["crisp", "fuzzy"]),
];
/// Times of retrieval with the values that are tried, s.
const TIMES: &[(&str, &[f64])] = &[("lookahead", &[0.0, 0.3, 0.6, 1.0])];
/// Lengths and thresholds of retrieval with the factors that are tried.
const FACTORS: &[(&str, &[f64])] = &[("thr_c", &[0.67, 0.8, 1.25, 1.5]), ("thr", &[0.8, 1.25])];

/// Hash of a case's text; of an empty one where the library lacks it.
pub(crate) fn text_hash(variant: &Variant, case: &str) -> u64 {
    let text = variant.files.cases.iter().find(|file| file.name == case).map(|file| file.text.as_str());
    let mut hash = hil_sim::Fnv::default();
    hash.add(text.unwrap_or_default().as_bytes());
    hash.value()
}

/// The league's kick kinds.
pub(crate) fn kicks(variant: &Variant) -> Vec<String> {
    CaseLeague::of(&variant.files.rules)
        .map(|league| league.kicks.iter().map(|(name, _)| name.clone()).collect())
        .unwrap_or_default()
}

struct Draft<'d> {
    case: &'d str,
    text: &'d CaseText,
    standing: &'d CaseStanding,
}

impl Draft<'_> {
    fn push(&self, proposals: &mut Vec<Proposal>, kind: Kind, change: Change, reason: String, weight: f64) {
        let edit = Edit { case: self.case.to_owned(), change };
        proposals.push(Proposal { kind, edit, reason, weight });
    }

    /// Scopes scaled as evidence says, and an odd one of the ball with the library's `typical` radii.
    fn scopes(&self, typical: [i32; 2], proposals: &mut Vec<Proposal>) {
        let CaseStanding { risk, met, unmet, .. } = self.standing;
        let advantage = risk.advantage();
        let grows = advantage > 0.0;
        let factor = if grows { GROW } else { SHRINK };
        let reason = format!(
            "{:.0} plays with the ball in the risk ring: {:+.1} points against the average there",
            risk.plays(),
            100.0 * advantage
        );
        let weight = risk.plays() * advantage.abs();
        // Both axes first: one alone moves half as many plays.
        let axes = [([true, true], 1.0), ([true, false], 0.5), ([false, true], 0.5)];
        let scope = self.text.scope_of(&Part::Ball);
        if let Some([x, y]) = scope.filter(|scope| is_odd(*scope)) {
            let all = self.standing.all;
            let reason = format!(
                "its scope of {x} × {y} mm is odd; {:.0} plays, {:+.1} points",
                all.plays(),
                100.0 * all.advantage()
            );
            // As heavy as a change of every play.
            let weight = all.plays() * all.advantage().abs().max(0.05);
            self.push(proposals, Kind::Scopes, Change::BallScope(typical), reason, weight);
        }
        for ([x, y], (axes, part)) in scope.into_iter().flat_map(|scope| axes.map(|axes| (scope, axes))) {
            let scaled =
                |value: i32, axis: bool, most: i32| if axis { scale(value, factor, most) } else { value };
            let radii = [scaled(x, axes[0], BALL_SCOPE_MAX[0]), scaled(y, axes[1], BALL_SCOPE_MAX[1])];
            if radii != [x, y] {
                self.push(proposals, Kind::Scopes, Change::BallScope(radii), reason.clone(), weight * part);
            }
        }
        for (n, scope) in (1..).map_while(|n| self.text.scope_of(&Part::Opponent(n))).enumerate() {
            let (side, factor) =
                if met.advantage() >= unmet.advantage() { (met, GROW) } else { (unmet, SHRINK) };
            let radii = scope.map(|value| scale(value, factor, OPPONENT_SCOPE_MAX));
            let reason = format!(
                "with an opponent in every scope {:+.1} points in {:.0} plays, else {:+.1} in {:.0}",
                100.0 * met.advantage(),
                met.plays(),
                100.0 * unmet.advantage(),
                unmet.plays()
            );
            let weight = 0.5 * side.plays() * (met.advantage() - unmet.advantage()).abs();
            if radii != scope {
                self.push(proposals, Kind::Scopes, Change::OpponentScope(n, radii), reason, weight);
            }
        }
    }

    /// Demands of opponents' scopes, and a goalkeeper's own: evidence shows where the case does worse than
    /// usual, and a demand keeps it from being played there.
    fn presences(&self, proposals: &mut Vec<Proposal>) {
        let CaseStanding { met, unmet, goalie, no_goalie, .. } = self.standing;
        let mut push = |change, side: &Standing, what: &str| {
            let (plays, advantage) = (side.plays(), side.advantage());
            if plays * -advantage > 0.0 {
                let reason = format!("{what}: {plays:.0} plays, {:+.1} points", 100.0 * advantage);
                self.push(proposals, Kind::Scopes, change, reason, plays * -advantage);
            }
        };
        for (n, presence) in (1..).map_while(|n| self.text.presence_of(n)).enumerate() {
            for (other, side, what) in [
                (Presence::Required, unmet, "without an opponent in every scope"),
                (Presence::Excluded, met, "with an opponent in every scope"),
            ] {
                if presence != other {
                    push(Change::OpponentPresence(n, other), side, what);
                }
            }
        }
        if self.text.opponents() < OPPONENTS_MAX && !goalkeeper::is_demanded(self.text) {
            let change = |presence| goalkeeper::demanded(self.text, presence);
            push(change(Presence::Required), no_goalie, "against two defenders");
            push(change(Presence::Excluded), goalie, "against defender and goalie");
        }
    }

    fn actions(&self, kicks: &[String], proposals: &mut Vec<Proposal>) {
        let all = self.standing.all;
        // A variant of a weak case has more to gain; a strong one's may still be better.
        let weight = all.plays() * (0.05 - all.advantage()).max(0.01);
        let reason = format!(
            "{:.0} plays, {:+.1} points against the average there",
            all.plays(),
            100.0 * all.advantage()
        );
        let mut change = |n, i, action: &ActionText| {
            let change = Change::Action(n, i, action.to_string());
            self.push(proposals, Kind::Actions, change, reason.clone(), weight);
        };
        for n in 0..self.text.robots() {
            let actions = self.text.actions(n + 1);
            for (i, action) in actions.iter().enumerate() {
                for variant in &variants(action, kicks) {
                    change(n, i, variant);
                }
            }
            if let Some(ActionText::DribbleTo(_)) = actions.last() {
                for kick in kicks {
                    change(n, actions.len(), &ActionText::Kick(kick.clone()));
                }
            }
        }
    }

    fn forget(&self, proposals: &mut Vec<Proposal>) {
        let all = self.standing.all;
        if all.advantage() < 0.0 {
            let reason = format!(
                "{:.0} plays, {:+.1} points against the average there",
                all.plays(),
                100.0 * all.advantage()
            );
            let weight = all.plays() * -all.advantage();
            self.push(proposals, Kind::Forget, Change::Forget, reason, weight);
        }
    }
}

/// The median radii of the ball's scopes, to 10 mm.
fn typical_scope(variant: &Variant) -> [i32; 2] {
    let scopes = variant.files.cases.iter().filter_map(|file| {
        let text = CaseText::read(&file.text).ok()?;
        text.scope_of(&Part::Ball)
    });
    let (mut x, mut y): (Vec<i32>, Vec<i32>) = scopes.map(|[x, y]| (x, y)).unzip();
    [&mut x, &mut y].map(|radii| {
        radii.sort_unstable();
        radii.get(radii.len() / 2).map_or(SCOPE_MIN, |radius| radius / 10 * 10)
    })
}

/// Whether a radius of the ball's scope lies outside of what a case has use for.
fn is_odd(scope: [i32; 2]) -> bool {
    scope.into_iter().zip(BALL_SCOPE_MAX).any(|(radius, most)| !(SCOPE_MIN..=most).contains(&radius))
}

/// Variants of an action: its point moved, its kick another.
fn variants(action: &ActionText, kicks: &[String]) -> Vec<ActionText> {
    let moved = |[x, y]: [i32; 2]| MOVES.map(|[dx, dy]| [x + dx, y + dy]).into_iter();
    match action {
        ActionText::Kick(kind) => {
            kicks.iter().filter(|other| *other != kind).cloned().map(ActionText::Kick).collect()
        }
        ActionText::GoToPoint(at) => moved(*at).map(ActionText::GoToPoint).collect(),
        ActionText::DribbleTo(at) => moved(*at).map(ActionText::DribbleTo).collect(),
        _ => Vec::new(),
    }
}

fn scale(value: i32, factor: [i32; 2], most: i32) -> i32 {
    let scaled = value * factor[0] / factor[1] / 10 * 10;
    // A scope that the author made larger than the limit may only shrink.
    if factor[0] > factor[1] { scaled.min(most.max(value)) } else { scaled.max(SCOPE_MIN) }
}

/// Decayed plays below which a case's evidence proposes nothing.
const PLAYS_MIN: f64 = 20.0;
/// Factor of a growing radius: half as much area again.
const GROW: [i32; 2] = [5, 4];
/// Factor of a shrinking radius: the security ring, half of the area, is what stays.
const SHRINK: [i32; 2] = [71, 100];
/// Radii above which `cases check` warns, mm (docs/case-format.md §1.2).
const BALL_SCOPE_MAX: [i32; 2] = [900, 700];
/// Largest radius of an opponent's scope, mm: the skeletons' own limit.
const OPPONENT_SCOPE_MAX: i32 = 700;
/// Smallest radius, mm: below that a robot's own width decides.
const SCOPE_MIN: i32 = 120;
/// Displacements of points, mm: a step or two of a robot.
const MOVES: [[i32; 2]; 6] = [[250, 0], [-250, 0], [0, 250], [0, -250], [250, 250], [250, -250]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::evidence::EvidenceCounts;

    #[test]
    fn an_odd_scope_is_proposed_with_the_usual_radii_before_anything_else() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let files = case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
        let authored = Variant::new(files).unwrap();
        let [x, y] = typical_scope(&authored);
        assert!((600..=800).contains(&x) && (450..=650).contains(&y), "{x} {y}");
        for (radii, odd) in [([2200, 1500], true), ([60, 650], true), ([900, 700], false)] {
            let case = "center/close-in".to_owned();
            let spoiled = Edit { case: case.clone(), change: Change::BallScope(radii) };
            let spoiled = authored.edited(&spoiled).unwrap();
            let mut standing = CaseStanding::default();
            let counts = EvidenceCounts { plays: 100, to_goal: 10, ends: BTreeMap::new() };
            standing.all.posterior.add(&counts, 1.0);
            let known = BTreeMap::from([(case.clone(), standing)]);
            let proposals = from_evidence(&spoiled, &known, Kind::Scopes, &Tried::new());
            let repaired = Edit { case, change: Change::BallScope(typical_scope(&spoiled)) };
            assert_eq!(proposals.first().is_some_and(|first| first.edit == repaired), odd, "{radii:?}");
        }
    }

    #[test]
    fn an_action_varies_in_its_kick_or_its_point_alone() {
        let kicks = ["goal", "left", "right"].map(str::to_owned);
        let varied = |action: &str| -> Vec<String> {
            variants(&action.parse().unwrap(), &kicks).iter().map(ToString::to_string).collect()
        };
        assert_eq!(varied("{ kick = \"left\" }"), ["{ kick = \"goal\" }", "{ kick = \"right\" }"]);
        let moved = varied("{ dribble_to = [400, -150] }");
        assert_eq!((moved.len(), moved[0].as_str()), (6, "{ dribble_to = [650, -150] }"));
        for fixed in ["\"wait\"", "{ pass_ball = 2 }", "{ turn = { face = [1, 2] } }"] {
            assert!(varied(fixed).is_empty(), "{fixed}");
        }
    }

    #[test]
    fn every_order_of_the_ranking_and_every_rule_but_the_present_ones_is_proposed() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let files = case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap();
        let variant = Variant::new(files).unwrap();
        let proposals = order_proposals(&variant);
        let of = |name: &str| {
            let text = format!("retrieval: {name}=");
            proposals.iter().filter(|one| one.edit.to_string().starts_with(&text)).count()
        };
        assert_eq!(
            ["ranking", "cost", "out_of_field", "free_path", "thr_c", "thr"].map(of),
            [5, 1, 2, 1, 4, 2]
        );
        for proposal in &proposals {
            let changed = variant.edited(&proposal.edit).unwrap();
            assert_eq!(changed.changed_settings().len(), 1, "{}", proposal.edit);
            assert_ne!(changed.hash, variant.hash);
            // From there the usual value is a proposal again.
            assert!(
                order_proposals(&changed)
                    .iter()
                    .any(|back| { changed.edited(&back.edit).is_ok_and(|back| back.hash == variant.hash) })
                    || proposal.edit.to_string().contains("thr")
            );
        }
    }

    #[test]
    fn a_scope_keeps_its_security_ring_when_it_shrinks_and_its_limit_when_it_grows() {
        let radii = [scale(500, SHRINK, 900), scale(400, SHRINK, 700)];
        // The inner half of the area, to the next 10 mm.
        let share = f64::from(radii[0] * radii[1]) / (500.0 * 400.0);
        assert!((0.47..=0.51).contains(&share), "{share}");
        assert_eq!(
            [scale(800, GROW, 900), scale(1000, GROW, 900), scale(130, SHRINK, 900)],
            [900, 1000, 120]
        );
    }
}
