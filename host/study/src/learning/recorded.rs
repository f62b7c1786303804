//! `recorded`: drafts of cases from successful plays of recordings: passes, receptions and the shot as
//! actions, the opponents near the ball's path with scopes. mm, attack towards +x.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use arena::successful_plays::{Holding, PlayEnd, SuccessfulPlay};
use case_tools::{CaseLeague, Files, SourceFile, build_without_warnings};
use casebase::{FieldMm, KickAim, OPPONENTS_MAX, PointMm, RetrievalSettings, retrieve_best};
use geometry::{Field, Point, Segment};
use hil_sim::Fnv;

use crate::learning::aim::distance;
use crate::learning::drafts::{BALL_SCOPE, FIELD, narrowed, opponent_scope, region};
use crate::learning::edit::{Change, Edit};
use crate::learning::proposals::{Kind, Proposal};
use crate::learning::trial::Situation;

/// Reason for which a play becomes no draft.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DraftError {
    /// Played on another field than the league's; length and width of both, mm.
    #[error(
        "played on a field of {} x {} mm, the league's is {} x {}; take a library of its league", .0[0], .0[1], .1[0], .1[1]
    )]
    Field([i32; 2], [i32; 2]),
    /// `league.toml` is refused, or has no kick at the goal.
    #[error("league.toml is refused or has no kick at the goal; correct it")]
    League,
    /// A case of the league cannot say it: what the checks say.
    #[error("{0}")]
    Refused(String),
}

/// A drafted case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedDraft {
    /// The new case.
    pub edit: Edit,
    /// Whether it is retrieved in the situation that it comes from, as the only case. It is not where an
    /// opponent stood in the ball's path and went away, or the ball was chipped over it.
    pub retrieved: bool,
}

/// The draft of a case that plays as the play did, in the league of these rules. Of the kicks that may stand
/// for the shot the nearest one that is retrieved is taken, else the nearest one.
pub fn draft(play: &SuccessfulPlay, rules: &SourceFile) -> Result<RecordedDraft, DraftError> {
    let league = CaseLeague::of(rules).ok_or(DraftError::League)?;
    if !play.fits(&league.field) {
        return Err(DraftError::Field(play.field, [league.field.length, league.field.width]));
    }
    let mut best = Err(DraftError::League);
    for end in ends(play, &league) {
        let plan = Plan::new(play, &league.field, &end);
        match plan.text(rules).map_err(DraftError::Refused) {
            Ok(text) => {
                let retrieved = plan.is_retrieved(rules, &text);
                if retrieved || best.is_err() {
                    best = Ok(RecordedDraft { edit: named(&plan, text), retrieved });
                }
                if retrieved {
                    break;
                }
            }
            Err(refused) if best.is_err() => best = Err(refused),
            Err(_) => {}
        }
    }
    best
}

/// Drafts of all plays that fit the league as proposals, each whole and with a narrow scope.
pub(crate) fn proposals(plays: &BTreeSet<SuccessfulPlay>, rules: &SourceFile) -> Vec<Proposal> {
    let mut proposals: Vec<Proposal> = Vec::new();
    let mut known = BTreeSet::new();
    for play in plays {
        let Ok(RecordedDraft { edit, .. }) = draft(play, rules) else { continue };
        if !known.insert(edit.case.clone()) {
            continue;
        }
        let reason = format!("recorded: {}", purpose(play));
        let weight = if play.goal { GOAL_WEIGHT } else { 1.0 };
        let proposed = |edit| Proposal { kind: Kind::New, edit, reason: reason.clone(), weight };
        proposals.extend(narrowed(&edit).map(&proposed));
        proposals.push(proposed(edit));
    }
    proposals
}

/// The last actions that may stand for the play's end, the likeliest first.
fn ends(play: &SuccessfulPlay, league: &CaseLeague) -> Vec<String> {
    let PlayEnd::Shot(y) = play.end else {
        let [x, y] = place(&league.field, play.holdings.last().map_or([0, 0], |last| last.left));
        return vec![format!("{{ dribble_to = [{x}, {y}] }}")];
    };
    let mut kicks: Vec<(i32, i32, &String)> = Vec::new();
    for (name, kick) in &league.kicks {
        if let KickAim::Goal { offset_mm: at } = kick.aim {
            kicks.push(((at - y).abs(), at.abs(), name));
        }
    }
    kicks.sort_unstable();
    // A name from league.toml needs no escapes but as a string of TOML, which JSON's is.
    kicks.iter().map(|(_, _, name)| format!("{{ kick = {} }}", serde_json::json!(name))).collect()
}

/// A case's parts.
struct Plan<'p> {
    play: &'p SuccessfulPlay,
    field: FieldMm,
    /// Robots in the order in which they had the ball first: id, place, actions.
    robots: Vec<(u8, [i32; 2], Vec<String>)>,
}

impl<'p> Plan<'p> {
    fn new(play: &'p SuccessfulPlay, field: &FieldMm, end: &str) -> Self {
        let at: BTreeMap<u8, [i32; 2]> = play.teammates.iter().copied().collect();
        let mut robots: Vec<(u8, [i32; 2], Vec<String>)> = Vec::new();
        // Where each robot was last, to know whether it has to go to where it receives.
        let mut places: Vec<[i32; 2]> = Vec::new();
        let mut passer = 0;
        for (i, holding) in play.holdings.iter().enumerate() {
            let Holding { robot, left, .. } = *holding;
            let got = received(holding);
            let known = robots.iter().position(|(id, _, _)| *id == robot);
            let number = known.unwrap_or(robots.len());
            if known.is_none() {
                let stood = at.get(&robot).copied().unwrap_or(got);
                let waits = i > 0 && distance(stood, got) <= STANDS_WITHIN;
                let from = if waits { got } else { stood };
                robots.push((robot, place(field, from), Vec::new()));
                places.push(from);
            }
            let actions = &mut robots[number].2;
            if i == 0 {
                actions.push("\"get_ball\"".to_owned());
            } else {
                if distance(places[number], got) > STANDS_WITHIN {
                    actions.push(point("go_to_point", place(field, got)));
                } else if actions.is_empty() {
                    actions.push("\"wait\"".to_owned());
                }
                actions.push(format!("{{ receive_ball = {} }}", passer + 1));
            }
            let next = play.holdings.get(i + 1).map(|next| next.robot);
            if distance(got, left) > CARRIED_FROM && (next.is_some() || play.end != PlayEnd::Carried) {
                actions.push(point("dribble_to", place(field, left)));
            }
            if let Some(next) = next {
                let known = robots.iter().position(|(id, _, _)| *id == next);
                let receiver = known.unwrap_or(robots.len()) + 1;
                robots[number].2.push(format!("{{ pass_ball = {receiver} }}"));
            } else {
                robots[number].2.push(end.to_owned());
            }
            (places[number], passer) = (left, number);
        }
        Self { play, field: *field, robots }
    }

    fn ball(&self) -> [i32; 2] {
        place(&self.field, self.play.holdings.first().map_or([0, 0], received))
    }

    /// The text that the checks accept; else their first finding.
    fn text(&self, rules: &SourceFile) -> Result<String, String> {
        let [x, y] = self.ball();
        let scope = [
            (BALL_SCOPE[0] * self.field.length / FIELD[0]).min(BALL_SCOPE_MAX[0]),
            (BALL_SCOPE[1] * self.field.width / FIELD[1]).min(BALL_SCOPE_MAX[1]),
        ];
        let mut text = format!(
            "# Drafted from a recording, as it was played: try it with `onetwo cases play`.\n\
             intent = \"Recorded: {}.\"\ndefending = \"yellow\"\n\
             ball = {{ at = [{x}, {y}], scope = [{}, {}] }}\n",
            purpose(self.play),
            scope[0],
            scope[1],
        );
        for (_, [x, y], actions) in &self.robots {
            let actions = actions.join(", ");
            let _ = write!(text, "\n[[teammates]]\nat = [{x}, {y}]\ngameplay = [{actions}]\n");
        }
        let files = Files::from_texts("draft", &rules.text, &[("draft/new", &text)]);
        let library = build_without_warnings(&files).map_err(|findings| {
            let first = findings.first();
            first.map_or_else(String::new, |finding| format!("{}; {}", finding.message, finding.hint))
        })?;
        let base = library.base();
        let stored = base.case(protocol::CaseId(0));
        for at in self.opponents() {
            if let Some([a, b]) = stored.as_ref().and_then(|case| opponent_scope(case, &base, at)) {
                let [x, y] = at;
                let _ = write!(text, "\n[[opponents]]\nat = [{x}, {y}]\nscope = [{a}, {b}]\n");
            }
        }
        Ok(text)
    }

    /// Whether the case of that text is retrieved where the play began.
    fn is_retrieved(&self, rules: &SourceFile, text: &str) -> bool {
        let files = Files::from_texts("draft", &rules.text, &[("draft/new", text)]);
        let situation = Situation {
            ball: self.ball(),
            defending_positive: false,
            teammates: self.play.teammates.clone(),
            opponents: self.play.opponents.clone(),
        };
        build_without_warnings(&files).is_ok_and(|library| {
            let settings = RetrievalSettings::default();
            retrieve_best(&library.base(), &situation.problem(), &settings).is_some()
        })
    }

    /// The opponents nearest to the ball's path.
    fn opponents(&self) -> Vec<[i32; 2]> {
        let mut path: Vec<[i32; 2]> =
            self.play.holdings.iter().flat_map(|holding| [holding.got, holding.left]).collect();
        if let PlayEnd::Shot(y) = self.play.end {
            path.push([self.field.length / 2, y]);
        }
        let off = |at: &[i32; 2]| {
            let legs = path.windows(2).map(|leg| distance_to_leg(*at, leg[0], leg[1]));
            legs.fold(f32::INFINITY, f32::min)
        };
        let mut near: Vec<(f32, [i32; 2])> = self.play.opponents.iter().map(|at| (off(at), *at)).collect();
        near.retain(|(off, _)| *off <= NEAR_PATH);
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
        near.into_iter().take(OPPONENTS_MAX).map(|(_, at)| place(&self.field, at)).collect()
    }
}

/// Place where a robot got the ball: where it kicked it unless it carried it. A kick's place is known better.
fn received(holding: &Holding) -> [i32; 2] {
    if distance(holding.got, holding.left) > CARRIED_FROM { holding.got } else { holding.left }
}

/// The play as a sentence without its end.
fn purpose(play: &SuccessfulPlay) -> String {
    let passes = match play.holdings.len().saturating_sub(1) {
        0 => String::new(),
        1 => "a pass and ".to_owned(),
        n => format!("{n} passes and "),
    };
    let end = match play.end {
        PlayEnd::Shot(_) => "a shot",
        PlayEnd::Carried => "the ball carried home",
    };
    format!("{passes}{end}{}", if play.goal { " that scored" } else { "" })
}

fn named(plan: &Plan<'_>, text: String) -> Edit {
    let ([x, y], FieldMm { length, width, .. }) = (plan.ball(), plan.field);
    let region = region([length, width], [x, y]);
    let mut hash = Fnv::default();
    hash.add(text.as_bytes());
    Edit { case: format!("{region}/recorded-{:06x}", hash.value() >> 40), change: Change::New(text) }
}

/// Inside the field, to 10 mm.
fn place(field: &FieldMm, [x, y]: [i32; 2]) -> [i32; 2] {
    let round = |v: i32| (f64::from(v) * 0.1).round() as i32 * 10;
    let at = field.clamp(PointMm { x: round(x), y: round(y) });
    [at.x, at.y]
}

fn point(action: &str, [x, y]: [i32; 2]) -> String {
    format!("{{ {action} = [{x}, {y}] }}")
}

/// Distance of a point from a leg, mm.
fn distance_to_leg(at: [i32; 2], from: [i32; 2], to: [i32; 2]) -> f32 {
    let point = |[x, y]: [i32; 2]| Point::<Field>::new(x as f32, y as f32);
    Segment::new(point(from), point(to)).distance_to(point(at))
}

/// A receiver that stands as near as this to where it receives waits there, mm: a robot's length.
const STANDS_WITHIN: f64 = 300.0;
/// A ball that was moved farther by the robot that had it was carried, mm: more than a turn with it.
const CARRIED_FROM: f64 = 200.0;
/// Opponents as near as this to the ball's path take part, mm: what they run in a second.
const NEAR_PATH: f32 = 1000.0;
/// Largest radii of the ball's scope, mm: above them `cases check` warns (docs/case-format.md §1.2).
const BALL_SCOPE_MAX: [i32; 2] = [900, 700];
/// A play that scored is tried before others.
const GOAL_WEIGHT: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::collected::tests::play;
    use crate::learning::variant::Variant;

    fn files(league: &str) -> Files {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        Files::read(&root.join("../../casebase/library/cases").join(league)).unwrap()
    }

    fn text(edit: &Edit) -> &str {
        let Change::New(text) = &edit.change else { panic!("{edit}") };
        text
    }

    #[test]
    fn a_pass_and_a_shot_become_a_case_with_their_places() {
        let files = files("four-legged");
        let edit = draft(&play(), &files.rules).unwrap().edit;
        let text = text(&edit);
        for part in [
            "ball = { at = [-150, 100], scope = [700, 500] }",
            "at = [-350, 100]\ngameplay = [\"get_ball\", { pass_ball = 2 }]",
            "at = [900, -700]\ngameplay = [\"wait\", { receive_ball = 1 }, { dribble_to = [1300, -500] }, { kick = \"goal",
            "[[opponents]]\nat = [400, 900]",
            "that scored",
        ] {
            assert!(text.contains(part), "{part}\n{text}");
        }
        assert!(!text.contains("-2500"), "far from the path:\n{text}");
        // Accepted, and retrieved in the situation that it comes from.
        let drafted = Variant::new(files.clone()).unwrap().edited(&edit).unwrap();
        let checked = case_tools::build(&drafted.files).unwrap();
        let own = |finding: &&case_tools::Finding| finding.file.ends_with(format!("{}.toml", edit.case));
        let codes: Vec<_> = checked.findings.iter().filter(own).map(|finding| finding.code).collect();
        assert!(!codes.contains(&"self-blocking"), "{codes:?}");
    }

    #[test]
    fn of_kicks_at_the_goal_one_is_taken_whose_path_was_free() {
        let rules = files("four-legged").rules;
        let of = |opponents: Vec<[i32; 2]>| draft(&SuccessfulPlay { opponents, ..play() }, &rules).unwrap();
        let free = of(vec![[400, 900]]);
        assert!(free.retrieved && text(&free.edit).contains("goal_left"), "{free:?}");
        let goalie = of(vec![[2400, 190]]);
        assert!(goalie.retrieved && !text(&goalie.edit).contains("goal_left"), "{goalie:?}");
        let blocked = of(vec![[300, -300]]);
        assert!(!blocked.retrieved && text(&blocked.edit).contains("goal_left"), "{blocked:?}");
    }

    #[test]
    fn a_robot_that_gets_the_ball_back_runs_there_and_receives_it() {
        let holdings = vec![
            Holding { robot: 1, got: [-200, 100], left: [-200, 100] },
            Holding { robot: 2, got: [900, -700], left: [900, -700] },
            Holding { robot: 1, got: [1400, 300], left: [1400, 300] },
        ];
        let edit = draft(&SuccessfulPlay { holdings, ..play() }, &files("four-legged").rules).unwrap().edit;
        let own =
            "[\"get_ball\", { pass_ball = 2 }, { go_to_point = [1400, 300] }, { receive_ball = 2 }, { kick";
        assert!(text(&edit).contains(own), "{edit:?}");
        assert!(text(&edit).contains("[\"wait\", { receive_ball = 1 }, { pass_ball = 1 }]"));
    }

    #[test]
    fn what_the_league_cannot_say_is_refused_with_a_reason() {
        let rules = files("four-legged").rules;
        let far = vec![
            Holding { robot: 1, got: [-2200, 100], left: [-2200, 100] },
            Holding { robot: 2, got: [900, -700], left: [900, -700] },
        ];
        let refused = draft(&SuccessfulPlay { holdings: far, ..play() }, &rules).unwrap_err();
        assert!(matches!(refused, DraftError::Refused(_)), "{refused}");
        let refused = draft(&play(), &files("division-b").rules).unwrap_err();
        assert!(refused.to_string().contains("5400 x 3600"), "{refused}");
    }

    /// A play without the opponent before the goal.
    fn quiet() -> SuccessfulPlay {
        SuccessfulPlay { opponents: Vec::new(), ..play() }
    }

    #[test]
    fn a_carried_ball_ends_the_case_where_it_counted_and_a_shot_takes_the_nearest_kick() {
        let rules = files("four-legged").rules;
        let carried = draft(&SuccessfulPlay { end: PlayEnd::Carried, ..play() }, &rules).unwrap().edit;
        assert!(text(&carried).contains("{ receive_ball = 1 }, { dribble_to = [1300, -500] }]"));
        for (y, kick) in [(-390, "goal_right"), (10, "\"goal\""), (700, "goal_left")] {
            let edit = draft(&SuccessfulPlay { end: PlayEnd::Shot(y), ..quiet() }, &rules).unwrap().edit;
            assert!(text(&edit).contains(kick), "{y}");
        }
    }

    #[test]
    fn every_play_is_proposed_whole_and_narrow_and_once() {
        let again = SuccessfulPlay { opponents: [play().opponents, vec![[-2600, 1700]]].concat(), ..play() };
        let proposals = proposals(&BTreeSet::from([play(), again]), &files("four-legged").rules);
        assert_eq!(proposals.len(), 2);
        assert!(text(&proposals[0].edit).contains("scope = [400, 300] }"));
    }
}
