//! `drafts`: drafts of new cases: for a situation of play, plans over the case actions, each as the text of a
//! case. mm, attack towards +x.

use std::fmt::Write as _;

use case_tools::self_blocking::{WARNS_ABOVE, share};
use case_tools::{Files, SourceFile, build_without_warnings};
use casebase::{Case, CaseBase, OPPONENTS_MAX, PointMm, Presence, Scope};
use hil_sim::{Fnv, Stream};

use crate::learning::edit::{Change, Edit};
use crate::learning::goalkeeper;
use crate::learning::occasion::Occasion;
use crate::learning::trial::Situation;

/// A draft for every plan in a situation that the league's rules allow.
pub(crate) fn drafts(situation: &Situation, kicks: &[String], rules: &SourceFile) -> Vec<Edit> {
    plans(situation, kicks).iter().filter_map(|plan| draft(situation, plan, rules)).collect()
}

/// The largest scope of an opponent at `at` in which it does not forbid what it is a condition of; none where
/// it stands in the way of the case's own ball.
pub(crate) fn opponent_scope(case: &Case<'_>, base: &CaseBase<'_>, at: [i32; 2]) -> Option<[i32; 2]> {
    let centre = PointMm { x: at[0], y: at[1] };
    let fits = |[x, y]: &[i32; 2]| share(case, base, centre, Scope { x: *x, y: *y }) <= WARNS_ABOVE;
    OPPONENT_SCOPES.into_iter().find(fits)
}

/// The same draft with a smaller scope of the ball, under another name.
pub(crate) fn narrowed(edit: &Edit) -> Option<Edit> {
    let Change::New(text) = &edit.change else { return None };
    let scope = |[x, y]: [i32; 2]| format!("scope = [{x}, {y}] }}");
    let text = text.replace(&scope(BALL_SCOPE), &scope(NARROW_BALL_SCOPE));
    Some(Edit { case: format!("{}-narrow", edit.case), change: Change::New(text) })
}

/// The same draft without a demand on a goalkeeper, under another name: played with one and without.
pub(crate) fn without_demands(edit: &Edit) -> Option<Edit> {
    let Change::New(text) = &edit.change else { return None };
    let excluded = opponent(goalkeeper::PLACE, goalkeeper::SCOPE, Presence::Excluded);
    let text = text.replace(&excluded, "").replace(&demand(Presence::Required), "");
    Some(Edit { case: format!("{}-wide", edit.case), change: Change::New(text) })
}

/// Occasions, as many without a case as with one where there are enough, drawn with the seed.
pub(crate) fn choose(occasions: &[Occasion], count: u32, seed: u64) -> Vec<&Occasion> {
    let mut chance = Stream::new(seed, "occasions");
    let mut chosen = Vec::new();
    for without in [true, false] {
        let fits = |occasion: &&Occasion| occasion.without_case == without && occasion.situation.is_usable();
        let pool: Vec<&Occasion> = occasions.iter().filter(fits).collect();
        if let Some(last) = pool.len().checked_sub(1) {
            let wanted = if without { count / 2 } else { count - chosen.len() as u32 };
            chosen.extend((0..wanted).map(|_| pool[chance.whole(0, last as u32) as usize]));
        }
    }
    chosen
}

/// Plan of a draft: where the partner stands, and both action lists as TOML.
struct DraftPlan {
    purpose: String,
    gets: String,
    /// The partner's place and actions; without them it plays as it does without a case.
    partner: Option<([i32; 2], String)>,
}

fn plans(situation: &Situation, kicks: &[String]) -> Vec<DraftPlan> {
    let [x, y] = situation.ball;
    let inside = |[x, y]: [i32; 2]| [x.clamp(-2600, 2600) / 10 * 10, y.clamp(-1700, 1700) / 10 * 10];
    let getter = getter(situation);
    let partner = situation.teammates.iter().find(|(id, _)| *id != getter).map_or([x, y], |(_, at)| *at);
    let partner = inside(partner);
    let ahead = inside([partner[0] + 400, partner[1]]);
    let supports = format!("{{ go_to_point = [{}, {}] }}", ahead[0], ahead[1]);
    let mut plans = Vec::new();
    let mut both = |purpose: String, gets: String| {
        plans.push(DraftPlan { purpose: purpose.clone(), gets: gets.clone(), partner: None });
        plans.push(DraftPlan { purpose, gets, partner: Some((partner, supports.clone())) });
    };
    for [dx, dy] in CARRIES {
        let [x, y] = inside([x + dx, y + dy]);
        both(format!("carry the ball to [{x}, {y}]"), format!("\"get_ball\", {{ dribble_to = [{x}, {y}] }}"));
    }
    for kick in kicks {
        both(format!("kick {kick}"), format!("\"get_ball\", {{ kick = \"{kick}\" }}"));
    }
    let receptions = [partner, ahead, inside([x + 700, y + 700]), inside([x + 700, y - 700])];
    for at in receptions {
        for (then, purpose) in [("", "pass"), (", { kick = \"goal\" }", "pass and shoot")] {
            plans.push(DraftPlan {
                purpose: format!("{purpose} to [{}, {}]", at[0], at[1]),
                gets: "\"get_ball\", { pass_ball = 2 }".to_owned(),
                partner: Some((at, format!("\"wait\", {{ receive_ball = 1 }}{then}"))),
            });
        }
    }
    plans
}

/// The robot nearest to the ball.
fn getter(situation: &Situation) -> u8 {
    let [x, y] = situation.ball;
    let square = |[a, b]: [i32; 2]| i64::from(a - x).pow(2) + i64::from(b - y).pow(2);
    situation.teammates.iter().min_by_key(|(id, at)| (square(*at), *id)).map_or(0, |(id, _)| *id)
}

fn draft(situation: &Situation, plan: &DraftPlan, rules: &SourceFile) -> Option<Edit> {
    let [x, y] = situation.ball.map(|value| value / 10 * 10);
    let mut text = format!(
        "# Learned from play: the best of the plans that were tried in situations like this one.\n\
         intent = \"Learned: {}.\"\ndefending = \"yellow\"\n\
         ball = {{ at = [{x}, {y}], scope = [{}, {}] }}\n\n\
         [[teammates]]\nat = [{}, {y}]\ngameplay = [{}]\n",
        plan.purpose,
        BALL_SCOPE[0],
        BALL_SCOPE[1],
        (x - 150).max(-2700),
        plan.gets,
    );
    if let Some(([a, b], actions)) = &plan.partner {
        let _ = write!(text, "\n[[teammates]]\nat = [{a}, {b}]\ngameplay = [{actions}]\n");
    }
    let files = Files::from_texts("draft", &rules.text, &[("draft/new", &text)]);
    let library = build_without_warnings(&files).ok()?;
    let base = library.base();
    let stored = base.case(protocol::CaseId(0))?;
    let mut opponents = situation.opponents.clone();
    opponents.sort_by_key(|[a, b]| (i64::from(a - x).pow(2) + i64::from(b - y).pow(2), *a, *b));
    let keeper = goalkeeper::among(&opponents);
    for (number, [a, b]) in opponents.iter().enumerate() {
        let at = [a.clamp(&-2700, &2700) / 10 * 10, b.clamp(&-1800, &1800) / 10 * 10];
        if keeper == Some(number) {
            text.push_str(&opponent(at, goalkeeper::SCOPE, Presence::Required));
        } else if let Some(scope) = opponent_scope(&stored, &base, at) {
            text.push_str(&opponent(at, scope, Presence::Preferred));
        }
    }
    if keeper.is_none() && opponents.len() < OPPONENTS_MAX {
        text.push_str(&opponent(goalkeeper::PLACE, goalkeeper::SCOPE, Presence::Excluded));
    }
    let region = region(FIELD, [x, y]);
    let mut hash = Fnv::default();
    hash.add(text.as_bytes());
    let case = format!("{region}/learned-{:06x}", hash.value() >> 40);
    Some(Edit { case, change: Change::New(text) })
}

/// The region of the library that a case belongs to, by its ball's place on a field of this length and width.
pub(crate) fn region([length, width]: [i32; 2], [x, y]: [i32; 2]) -> &'static str {
    match (9 * x, 18 * y.abs()) {
        (back, _) if back < -2 * length => "back",
        (_, aside) if aside >= 5 * width => "side",
        (front, _) if front >= 2 * length => "front",
        _ => "center",
    }
}

fn opponent(at: [i32; 2], scope: [i32; 2], presence: Presence) -> String {
    let demand = match presence {
        Presence::Preferred => String::new(),
        other => demand(other),
    };
    format!("\n[[opponents]]\nat = {at:?}\nscope = {scope:?}\n{demand}")
}

fn demand(presence: Presence) -> String {
    format!("presence = \"{}\"\n", presence.label())
}

/// Displacements by which a draft carries the ball, mm: ahead, aslant, to the sides.
const CARRIES: [[i32; 2]; 6] = [[500, 0], [400, 350], [400, -350], [100, 500], [100, -500], [900, 0]];
/// Length and width of the four-legged league's field, mm.
pub(crate) const FIELD: [i32; 2] = [5400, 3600];
/// Radii of a draft's ball scope, mm: those that the authors of the four-legged library took most often.
pub(crate) const BALL_SCOPE: [i32; 2] = [700, 500];
/// Radii of the narrowed scope, mm: a third of the area.
const NARROW_BALL_SCOPE: [i32; 2] = [400, 300];
/// Radii of opponents' scopes, mm, the first that does not block the case's own path: a robot that moves for
/// half a second, half of that area, and what still tells an opponent's side.
const OPPONENT_SCOPES: [[i32; 2]; 3] = [[500, 450], [350, 320], [200, 180]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::variant::Variant;

    #[test]
    fn drafts_are_accepted_by_the_checks_and_retrieved_in_their_situation() {
        let league = case_library_files();
        let variant = Variant::new(league).unwrap();
        let situation = Situation {
            ball: [303, 201],
            defending_positive: false,
            teammates: vec![(1, [100, 200]), (2, [250, -650])],
            opponents: vec![[1200, 300], [2400, 0]],
        };
        let problem = situation.problem();
        let kicks = ["goal", "forward", "left"].map(str::to_owned);
        let plans = plans(&situation, &kicks);
        assert_eq!(plans.len(), 2 * (6 + 3) + 8);
        let retrieved = plans.iter().filter(|plan| {
            let Some(edit) = draft(&situation, plan, &variant.files.rules) else { return false };
            let Ok(drafted) = variant.edited(&edit) else { return false };
            drafted.answer(&drafted.base(), &problem).is_some_and(|(name, _, _)| name == edit.case)
        });
        assert!(retrieved.count() >= 10);
        let edit = draft(&situation, &plans[0], &variant.files.rules).unwrap();
        let narrow = variant.edited(&narrowed(&edit).unwrap()).unwrap();
        assert!(narrow.files.cases.iter().any(|file| file.text.contains("scope = [400, 300] }")));
    }

    #[test]
    fn no_opponent_of_a_draft_stands_in_the_way_of_its_own_ball() {
        let variant = Variant::new(case_library_files()).unwrap();
        let before = variant.warnings().unwrap();
        let situation = Situation {
            ball: [370, -800],
            defending_positive: false,
            teammates: vec![(1, [220, -800]), (2, [1070, 570])],
            opponents: vec![[370, -580], [900, -750]],
        };
        let drafts = drafts(&situation, &["goal".to_owned()], &variant.files.rules);
        assert!(drafts.len() >= 10, "{}", drafts.len());
        for edit in &drafts {
            let warnings = variant.edited(edit).unwrap().warnings().unwrap();
            let own = |(file, code): &&(String, &'static str)| {
                file.contains(&edit.case) && ["self-blocking", "scope-in-path"].contains(code)
            };
            assert_eq!(warnings.difference(&before).find(own), None, "{edit:?}");
        }
        let kept =
            |edit: &&Edit| matches!(&edit.change, Change::New(text) if text.contains("at = [370, -580]"));
        assert!(drafts.iter().any(|edit| kept(&edit)) && !drafts.iter().all(|edit| kept(&edit)));
    }

    #[test]
    fn drafts_keep_to_opponents_with_a_goalkeeper_or_without() {
        let variant = Variant::new(case_library_files()).unwrap();
        let with = |keeper: [i32; 2]| Situation {
            ball: [303, 201],
            defending_positive: false,
            teammates: vec![(1, [100, 200]), (2, [250, -650])],
            opponents: vec![[1200, 300], keeper],
        };
        let (guarded, open) = (with([2400, 50]), with([1500, -600]));
        for (own, other) in [(&guarded, &open), (&open, &guarded)] {
            let edit = draft(own, &plans(own, &[])[0], &variant.files.rules).unwrap();
            let wide = without_demands(&edit).unwrap();
            let played = |edit: &Edit, situation: &Situation| {
                let drafted = variant.edited(edit).unwrap();
                drafted
                    .answer(&drafted.base(), &situation.problem())
                    .is_some_and(|(name, ..)| name == edit.case)
            };
            assert!(played(&edit, own) && !played(&edit, other), "{edit:?}");
            assert!(played(&wide, own) && !wide.case.is_empty());
            let Change::New(text) = &wide.change else { panic!("{wide:?}") };
            assert!(!text.contains("presence"), "{text}");
        }
    }

    fn case_library_files() -> case_tools::Files {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap()
    }
}
