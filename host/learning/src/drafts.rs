//! `drafts`: new cases by search: in situations from play, plans over the case actions are rolled out in the
//! simulator, and the best becomes the draft of a case. mm, attack towards +x.
//!
//! A draft starts with a small scope around its situation, as Ros & Arcos 2007 introduce cases; later rounds
//! grow it where that pays.

use std::fmt::Write as _;

use case_tools::CaseLeague;
use hil_sim::{Fnv, Stream};

use crate::aim::usable;
use crate::edit::{Change, Edit};
use crate::proposals::{Kind, Proposal};
use crate::trial::{LearningTrial, Situation};
use crate::variant::Variant;
use crate::work::{PlayError, Player, Unit, Work};

/// A situation of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Occasion {
    /// Where everything stood.
    pub(crate) situation: Situation,
    /// Whether the opponents were two defenders.
    pub(crate) two_defenders: bool,
    /// Whether no case was played.
    pub(crate) without_case: bool,
}

/// How much is searched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchSize {
    /// Situations.
    pub(crate) situations: u32,
    /// Roll-outs a plan; the best few plans, and playing without one, get [`AGAIN`] times as many.
    pub(crate) rollouts: u32,
}

/// Drafts for some of these occasions, best first, and the trials that it took.
pub(crate) fn search(
    variant: &Variant,
    occasions: &[Occasion],
    size: SearchSize,
    seed: u64,
    player: &mut impl Player,
) -> Result<(Vec<Proposal>, u64), PlayError> {
    let chosen = choose(occasions, size.situations, seed);
    let league = CaseLeague::of(&variant.files.rules);
    let kicks: Vec<String> =
        league.map(|league| league.kicks.into_iter().map(|(name, _)| name).collect()).unwrap_or_default();
    let mut drafts: Vec<(usize, Edit, Variant)> = Vec::new();
    for (number, occasion) in chosen.iter().enumerate() {
        for plan in plans(&occasion.situation, &kicks) {
            let edit = draft(&occasion.situation, &plan);
            // A plan that the checks refuse, such as a pass beyond its reach, is no plan.
            let Ok(drafted) = variant.edited(&edit) else { continue };
            let problem = occasion.situation.problem();
            let answer = drafted.answer(&drafted.base(), &problem);
            if answer.is_some_and(|(name, _, _)| name == edit.case) {
                drafts.push((number, edit, drafted));
            }
        }
    }
    let work = |occasion: &Occasion, trials| Work::Situation {
        situation: occasion.situation.clone(),
        two_defenders: occasion.two_defenders,
        first: 0,
        trials,
    };
    let first: Vec<Unit<'_>> = (drafts.iter())
        .map(|(n, _, drafted)| Unit { variant: drafted, work: work(chosen[*n], size.rollouts) })
        .collect();
    let played = player.play(&first)?;
    let mut spent: u64 = first.iter().map(|unit| u64::from(unit.trials())).sum();
    // The best plans of each situation, rolled out again: the best of many few is mostly luck.
    let mut order: Vec<usize> = (0..drafts.len()).collect();
    order.sort_by(|a, b| {
        let key = |i: usize| (drafts[i].0, std::cmp::Reverse(goals(&played[i])), i);
        key(*a).cmp(&key(*b))
    });
    let place = |at: usize| order[..at].iter().filter(|i| drafts[**i].0 == drafts[order[at]].0).count();
    let again: Vec<usize> = (0..order.len()).filter(|at| place(*at) < BEST).map(|at| order[at]).collect();
    let mut units: Vec<Unit<'_>> = (chosen.iter())
        .map(|occasion| Unit { variant, work: work(occasion, AGAIN * size.rollouts) })
        .collect();
    units.extend(again.iter().map(|i| {
        let (n, _, drafted) = &drafts[*i];
        Unit { variant: drafted, work: work(chosen[*n], AGAIN * size.rollouts) }
    }));
    let played = player.play(&units)?;
    spent += units.iter().map(|unit| u64::from(unit.trials())).sum::<u64>();
    let rate = |trials: &[LearningTrial]| goals(trials) as f64 / trials.len().max(1) as f64;
    let mut best: Vec<Option<(f64, f64, &Edit)>> = vec![None; chosen.len()];
    for (i, trials) in again.iter().zip(&played[chosen.len()..]) {
        let (number, edit, _) = &drafts[*i];
        let (with, without) = (rate(trials), rate(&played[*number]));
        if best[*number].is_none_or(|(known, _, _)| with > known) {
            best[*number] = Some((with, without, edit));
        }
    }
    let good = best.into_iter().flatten().filter(|(with, without, _)| with - without >= GAIN_MIN);
    let mut proposals = Vec::new();
    for (with, without, edit) in good {
        let reason = format!(
            "best of the plans rolled out from its situation: to goal {:.0} % in {} trials, without it {:.0} %",
            100.0 * with,
            AGAIN * size.rollouts,
            100.0 * without
        );
        let proposal = |edit, weight| Proposal { kind: Kind::New, edit, reason: reason.clone(), weight };
        proposals.push(proposal(edit.clone(), with - without));
        // The same plan for more situations; trials show which scopes are right.
        proposals.extend(widened(edit).into_iter().map(|wide| proposal(wide, with - without)));
    }
    proposals.sort_by(|a, b| b.weight.total_cmp(&a.weight).then_with(|| a.edit.cmp(&b.edit)));
    Ok((proposals, spent))
}

fn goals(trials: &[LearningTrial]) -> usize {
    trials.iter().filter(|trial| trial.to_goal()).count()
}

/// The same draft for more situations, under other names: with wider scopes, then also with the opponent
/// nearest to the ball alone, then with none.
fn widened(edit: &Edit) -> Vec<Edit> {
    let Change::New(text) = &edit.change else { return Vec::new() };
    let scope = |[x, y]: [i32; 2]| format!("scope = [{x}, {y}]");
    let text = text.replace(&scope(BALL_SCOPE), &scope(WIDE_BALL_SCOPE));
    let text = text.replace(&scope(OPPONENT_SCOPE), &scope(WIDE_OPPONENT_SCOPE));
    let named = |suffix: &str, text: &str| Edit {
        case: format!("{}-{suffix}", edit.case),
        change: Change::New(text.to_owned()),
    };
    let mut drafts = vec![named("wide", &text)];
    let opponents: Vec<usize> = text.match_indices(OPPONENT).map(|(at, _)| at).collect();
    for (left, suffix) in [(1, "nearest"), (0, "alone")] {
        if let Some(end) = opponents.get(left) {
            drafts.push(named(suffix, &text[..*end]));
        }
    }
    drafts
}

/// Occasions, as many without a case as with one where there are enough, drawn with the seed.
fn choose(occasions: &[Occasion], count: u32, seed: u64) -> Vec<&Occasion> {
    let mut chance = Stream::new(seed, "occasions");
    let mut chosen = Vec::new();
    for without in [true, false] {
        let fits = |occasion: &&Occasion| occasion.without_case == without && usable(&occasion.situation);
        let pool: Vec<&Occasion> = occasions.iter().filter(fits).collect();
        if let Some(last) = pool.len().checked_sub(1) {
            let wanted = if without { count / 2 } else { count - chosen.len() as u32 };
            chosen.extend((0..wanted).map(|_| pool[chance.whole(0, last as u32) as usize]));
        }
    }
    chosen
}

/// What the robots do: where the partner stands, and both action lists as TOML.
struct DraftPlan {
    purpose: String,
    partner: [i32; 2],
    gets: String,
    partners: String,
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
    for [dx, dy] in CARRIES {
        let [x, y] = inside([x + dx, y + dy]);
        plans.push(DraftPlan {
            purpose: format!("carry the ball to [{x}, {y}]"),
            partner,
            gets: format!("\"get_ball\", {{ dribble_to = [{x}, {y}] }}"),
            partners: supports.clone(),
        });
    }
    for kick in kicks {
        plans.push(DraftPlan {
            purpose: format!("kick {kick}"),
            partner,
            gets: format!("\"get_ball\", {{ kick = \"{kick}\" }}"),
            partners: supports.clone(),
        });
    }
    let receptions = [partner, ahead, inside([x + 700, y + 700]), inside([x + 700, y - 700])];
    for at in receptions {
        for (then, purpose) in [("", "pass"), (", { kick = \"goal\" }", "pass and shoot")] {
            plans.push(DraftPlan {
                purpose: format!("{purpose} to [{}, {}]", at[0], at[1]),
                partner: at,
                gets: "\"get_ball\", { pass_ball = 2 }".to_owned(),
                partners: format!("\"wait\", {{ receive_ball = 1 }}{then}"),
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

fn draft(situation: &Situation, plan: &DraftPlan) -> Edit {
    let [x, y] = situation.ball.map(|value| value / 10 * 10);
    let mut text = format!(
        "# Learned from play: the best plan rolled out from this situation.\n\
         intent = \"Learned: {}.\"\ndefending = \"yellow\"\n\
         ball = {{ at = [{x}, {y}], scope = [{}, {}] }}\n\n\
         [[teammates]]\nat = [{}, {y}]\ngameplay = [{}]\n\n\
         [[teammates]]\nat = [{}, {}]\ngameplay = [{}]\n",
        plan.purpose,
        BALL_SCOPE[0],
        BALL_SCOPE[1],
        (x - 150).max(-2700),
        plan.gets,
        plan.partner[0],
        plan.partner[1],
        plan.partners,
    );
    let mut opponents = situation.opponents.clone();
    opponents.sort_by_key(|[a, b]| (i64::from(a - x).pow(2) + i64::from(b - y).pow(2), *a, *b));
    for [a, b] in &opponents {
        let at = [a.clamp(&-2700, &2700) / 10 * 10, b.clamp(&-1800, &1800) / 10 * 10];
        let _ = write!(
            text,
            "{OPPONENT}at = [{}, {}]\nscope = [{}, {}]\n",
            at[0], at[1], OPPONENT_SCOPE[0], OPPONENT_SCOPE[1]
        );
    }
    let region = match (x, y.abs()) {
        (..-1200, _) => "back",
        (_, 1000..) => "side",
        (1200.., _) => "front",
        _ => "center",
    };
    let mut hash = Fnv::default();
    hash.add(text.as_bytes());
    let case = format!("{region}/learned-{:06x}", hash.value() >> 40);
    Edit { case, change: Change::New(text) }
}

/// What the text of an opponent begins with.
const OPPONENT: &str = "\n[[opponents]]\n";
/// Least gain of a draft in its own situation that makes it a proposal, as a share: two standard errors of
/// the roll-outs would be more, but trials decide.
const GAIN_MIN: f64 = 0.1;
/// Plans of a situation that are rolled out again.
const BEST: usize = 4;
/// How many times as often.
const AGAIN: u32 = 4;
/// Where a draft carries the ball, from its place, mm: ahead, aslant, to the sides.
const CARRIES: [[i32; 2]; 6] = [[500, 0], [400, 350], [400, -350], [100, 500], [100, -500], [900, 0]];
/// Radii of a draft's ball scope, mm: half of what `cases check` allows, a fifth of its area.
const BALL_SCOPE: [i32; 2] = [450, 350];
/// Radii of a wider draft's ball scope, mm.
const WIDE_BALL_SCOPE: [i32; 2] = [750, 600];
/// Radii of its opponents' scopes, mm.
const WIDE_OPPONENT_SCOPE: [i32; 2] = [800, 700];
/// Radii of its opponents' scopes, mm.
const OPPONENT_SCOPE: [i32; 2] = [500, 450];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draft_is_widened_step_by_step_until_no_opponent_is_left() {
        let situation = Situation {
            ball: [303, 201],
            defending_positive: false,
            teammates: vec![(1, [100, 200]), (2, [250, -650])],
            opponents: vec![[2400, 0], [1200, 300]],
        };
        let edit = draft(&situation, &plans(&situation, &[])[0]);
        let current = Variant::new(case_library_files()).unwrap();
        let wider = widened(&edit);
        let opponents = wider.iter().map(|wide| {
            let Change::New(text) = &wide.change else { panic!("{wide}") };
            current.edited(wide).unwrap();
            // The nearest one stays last.
            (text.matches("[[opponents]]").count(), text.contains("at = [1200, 300]"))
        });
        assert_eq!(opponents.collect::<Vec<_>>(), [(2, true), (1, true), (0, false)]);
    }

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
        assert_eq!(plans.len(), 6 + 3 + 8);
        let retrieved = plans.iter().filter(|plan| {
            let edit = draft(&situation, plan);
            let Ok(drafted) = variant.edited(&edit) else { return false };
            drafted.answer(&drafted.base(), &problem).is_some_and(|(name, _, _)| name == edit.case)
        });
        assert!(retrieved.count() >= 10);
    }

    fn case_library_files() -> case_tools::Files {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        case_tools::Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap()
    }
}
