//! `retrieval`: tests: retrieval decides as the paper and docs/case-format.md §3 specify. Situations worked
//! out by hand.

mod common;

use case_tools::Library;
use casebase::{CaseVerdict, Presence, Retrieval, RetrievalSettings, explain, retrieve, retrieve_best};
use common::{PASS_AROUND, library, problem, single};
use protocol::CaseId;

fn settings(assignments: &[(&str, &str)]) -> RetrievalSettings {
    let mut settings = RetrievalSettings::default();
    for (name, value) in assignments {
        settings.set(name, value).unwrap();
    }
    settings
}

fn ask(
    library: &case_tools::Library,
    problem: &casebase::Problem,
    settings: &RetrievalSettings,
) -> Retrieval {
    let found = retrieve(&library.base(), problem, settings);
    assert_eq!(retrieve_best(&library.base(), problem, settings), found.best);
    found
}

/// The id of the winner under the default settings.
fn winner(library: &case_tools::Library, problem: &casebase::Problem) -> Option<u16> {
    ask(library, problem, &RetrievalSettings::default()).best.map(|best| best.case.0)
}

#[test]
fn the_example_of_the_agreement() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    let problem = problem((-600, 10), &[(1, (-700, 0)), (3, (200, 800))], &[(-150, 40)]);
    let found = ask(&library, &problem, &RetrievalSettings::default());
    let best = found.best.unwrap();
    assert_eq!((found.candidates, best.case, best.conditions, best.teammates), (1, CaseId(0), 1, 2));
    // sim_B = exp(−(10/250)²); cost = |(−700, 0) − (−720, 10)| + |(200, 800) − (300, 910)|.
    assert!((f64::from(best.similarity) - (-0.0016_f64).exp()).abs() < 1e-6, "{}", best.similarity);
    let cost = 500.0_f64.sqrt() + 22_100.0_f64.sqrt();
    assert!((cost - 171.02).abs() < 0.005 && (f64::from(best.cost) - cost).abs() < 1e-3, "{}", best.cost);
    assert_eq!(best.correspondence.iter().map(|id| id.number()).collect::<Vec<_>>(), [1, 3]);
}

#[test]
fn an_opponent_in_a_leg_leaves_nothing() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    // Half way along the pass from (−600, 10) to (300, 910).
    let blocked = problem((-600, 10), &[(1, (-700, 0)), (3, (200, 800))], &[(-150, 460)]);
    assert_eq!(
        ask(&library, &blocked, &RetrievalSettings::default()),
        Retrieval { best: None, candidates: 0 }
    );
}

#[test]
fn a_point_exactly_on_the_ellipse_passes_and_one_beyond_the_literal_does_not() {
    let library = library(&[("a/a", &single("[0, 0]", "[1000, 500]", ""))]);
    let at = |x, y| winner(&library, &problem((x, y), &[(1, (x, y))], &[]));
    // exp(−1) = 0.36788 > 0.367: the literal accepts the ellipse, up to 1.001196 τ.
    assert_eq!(at(1000, 0), Some(0));
    assert_eq!(at(1001, 0), Some(0));
    assert_eq!(at(1002, 0), None);
    // At y = 0 the mirrored case is as similar, as near: the lower id wins; at the rim of y, too.
    assert_eq!(at(0, 500), Some(0));
    assert_eq!(at(0, 501), None);
}

#[test]
fn a_robot_may_travel_exactly_thr_c() {
    let library = library(&[("a/a", &single("[0, 0]", "[400, 400]", ""))]);
    let from = |x, y| winner(&library, &problem((100, 0), &[(5, (x, y))], &[]));
    // The adapted position is the ball's own place; 900, 1200, 1500 is a triangle.
    assert_eq!(from(1000, 1200), Some(0));
    assert_eq!(from(1000, 1201), None);
}

#[test]
fn too_few_robots_give_the_verdict_robots() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    let alone = problem((-600, 0), &[(1, (-700, 0))], &[]);
    assert_eq!(winner(&library, &alone), None);
    let mut verdicts = Vec::new();
    explain(&library.base(), &alone, &RetrievalSettings::default(), |id, verdict| {
        verdicts.push((id.0, verdict));
    });
    assert_eq!(verdicts, [0, 1].map(|id| (id, CaseVerdict::Robots { needed: 2, present: 1 })));
}

#[test]
fn one_opponent_may_fulfil_two_conditions_and_an_empty_scope_costs_nothing() {
    let two = single("[0, 0]", "[400, 400]", ", { kick = \"forward\" }")
        + "[[opponents]]\nat = [300, 500]\nscope = [200, 200]\n[[opponents]]\nat = [350, 550]\nscope = [200, 200]\n";
    let library = library(&[("a/two", &two)]);
    let conditions = |opponents: &[(i32, i32)]| {
        ask(&library, &problem((0, 100), &[(1, (0, 0))], opponents), &RetrievalSettings::default())
            .best
            .unwrap()
            .conditions
    };
    // Scopes move with the ball: their centres are now at (300, 600) and (350, 650).
    assert_eq!(conditions(&[(320, 620)]), 2);
    assert_eq!(conditions(&[(150, 500), (2000, 0)]), 1);
    assert_eq!(conditions(&[]), 0);
}

#[test]
fn scopes_may_be_read_where_the_case_has_them() {
    let case = single("[0, 0]", "[400, 400]", "") + "[[opponents]]\nat = [300, 0]\nscope = [100, 100]\n";
    let library = library(&[("a/a", &case)]);
    let moved = problem((300, 0), &[(1, (300, 0))], &[(300, 20)]);
    let conditions = |settings: &RetrievalSettings| ask(&library, &moved, settings).best.unwrap().conditions;
    assert_eq!(conditions(&RetrievalSettings::default()), 0);
    assert_eq!(conditions(&settings(&[("scopes", "absolute")])), 1);
}

#[test]
fn a_leg_blocks_abreast_of_it_within_its_trapezoid_only() {
    // One leg from (0, 0) to (1000, 0), radius 100 at the foot, 300 at the end.
    let library = library(&[("a/a", &single("[0, 0]", "[400, 400]", ", { kick = \"forward\" }"))]);
    let free = |x, y| winner(&library, &problem((0, 0), &[(1, (0, 0))], &[(x, y)])).is_some();
    assert!(free(-1, 0) && free(1001, 0));
    assert!(!free(0, 0) && !free(1000, 0));
    // Half way the radius is 200, its edge at 200 · 1.001196.
    assert!(!free(500, 200) && free(500, 201) && !free(500, -200) && free(500, -201));
    assert!(!free(1000, 300) && free(1000, 301));
}

#[test]
fn a_blocked_path_reports_the_leg_the_opponent_and_how_deep_it_stands() {
    let library = library(&[("a/a", &single("[0, 0]", "[400, 400]", ", { kick = \"forward\" }"))]);
    let blocked = problem((0, 0), &[(1, (0, 0))], &[(0, 900), (500, 150)]);
    let mut verdicts = Vec::new();
    explain(&library.base(), &blocked, &RetrievalSettings::default(), |_, verdict| verdicts.push(verdict));
    let CaseVerdict::Path { index: 0, opponent: 1, inside_mm, .. } = verdicts[0] else {
        panic!("{:?}", verdicts[0])
    };
    assert!((inside_mm - (200.239 - 150.0)).abs() < 0.01, "{inside_mm}");
}

#[test]
fn a_demand_on_a_scope_admits_the_case_with_an_opponent_or_without_alone() {
    let with = |presence: &str| {
        let case = single("[0, 0]", "[400, 400]", ", { dribble_to = [300, 0] }");
        let opponent = "[[opponents]]\nat = [1000, 500]\nscope = [300, 200]\n";
        library(&[("a/a", &format!("{case}{opponent}{presence}"))])
    };
    // The scope moves with the ball by (100, 50) and ends 1.0012 radii from its centre at (1100, 550).
    let verdict = |library: &Library, opponents: &[(i32, i32)]| {
        let problem = problem((100, 50), &[(1, (0, 0))], opponents);
        let mut first = None;
        explain(&library.base(), &problem, &RetrievalSettings::default(), |_, verdict| {
            first.get_or_insert(verdict);
        });
        let found = ask(library, &problem, &RetrievalSettings::default());
        let first = first.unwrap();
        // Across the x axis there is a copy with its scope on the other side.
        assert!(found.candidates <= 2);
        (first, found.best.map(|best| best.conditions))
    };
    let (inside, outside) = ((1399, 550), (1401, 550));
    let is_candidate = |verdict: &CaseVerdict| matches!(verdict, CaseVerdict::Candidate(_));
    let preferred = with("");
    assert!(
        is_candidate(&verdict(&preferred, &[inside]).0) && is_candidate(&verdict(&preferred, &[outside]).0)
    );
    let required = with("presence = \"required\"\n");
    assert!(is_candidate(&verdict(&required, &[outside, inside]).0));
    assert_eq!(verdict(&required, &[outside, inside]).1, Some(1));
    assert_eq!(
        verdict(&required, &[outside]).0,
        CaseVerdict::Opponents { scope: 0, presence: Presence::Required, opponent: None }
    );
    let excluded = with("presence = \"excluded\"\n");
    assert!(is_candidate(&verdict(&excluded, &[outside]).0));
    assert_eq!(
        verdict(&excluded, &[outside, inside]).0,
        CaseVerdict::Opponents { scope: 0, presence: Presence::Excluded, opponent: Some(1) }
    );
}

#[test]
fn a_leg_of_length_0_is_never_blocked() {
    let text = "intent = \"hand over\"\ndefending = \"yellow\"\nball = { at = [0, 0], scope = [400, 400] }\n\
        [[teammates]]\nat = [-100, 0]\ngameplay = [\"get_ball\", { pass_ball = 2 }]\n\
        [[teammates]]\nat = [0, 0]\ngameplay = [{ receive_ball = 1 }]\n";
    let library = library(&[("a/a", text)]);
    let found = ask(
        &library,
        &problem((0, 0), &[(1, (-100, 0)), (2, (0, 0))], &[(0, 0)]),
        &RetrievalSettings::default(),
    );
    assert_eq!(found.candidates, 2);
}

#[test]
fn a_shot_at_goal_ends_in_the_goal_wherever_the_ball_lies() {
    let library = library(&[("a/a", &single("[0, 0]", "[900, 700]", ", { kick = \"goal\" }"))]);
    let free = |opponent| winner(&library, &problem((0, 600), &[(1, (0, 600))], &[opponent])).is_some();
    // On the line from (0, 600) to (2700, 0), and where a shifted leg would have ended.
    assert!(!free((1350, 300)));
    assert!(free((2600, 600)));
}

#[test]
fn out_of_field_keeps_clamps_or_rejects() {
    let text = "intent = \"wing\"\ndefending = \"yellow\"\nball = { at = [0, 1500], scope = [400, 400] }\n\
        [[teammates]]\nat = [0, 1800]\ngameplay = [\"get_ball\"]\n";
    let library = library(&[("a/a", text)]);
    // Adapted: (0, 1900), 100 mm outside.
    let wide = problem((0, 1600), &[(1, (0, 1800))], &[]);
    let cost = |value| ask(&library, &wide, &settings(&[("out_of_field", value)])).best.map(|best| best.cost);
    assert_eq!((cost("keep"), cost("clamp"), cost("reject")), (Some(100.0), Some(0.0), None));
}

#[test]
fn clamped_positions_lead_the_ball_elsewhere() {
    let text = "intent = \"wing pass\"\ndefending = \"yellow\"\nball = { at = [0, 0], scope = [400, 400] }\n\
        [[teammates]]\nat = [0, 0]\ngameplay = [\"get_ball\", { pass_ball = 2 }]\n\
        [[teammates]]\nat = [0, 1800]\ngameplay = [{ receive_ball = 1 }]\n";
    let library = library(&[("a/a", text)]);
    // With the ball at (0, 300) the pass ends at (0, 2100), clamped at (0, 1800): an opponent beyond is not
    // abreast.
    let beyond = problem((0, 300), &[(1, (0, 300)), (2, (0, 1800))], &[(50, 1900)]);
    assert_eq!(ask(&library, &beyond, &RetrievalSettings::default()).candidates, 0);
    assert_eq!(ask(&library, &beyond, &settings(&[("out_of_field", "clamp")])).candidates, 1);
}

#[test]
fn another_threshold_widens_every_scope() {
    let library = library(&[("a/a", &single("[0, 0]", "[400, 400]", ""))]);
    let far = problem((600, 0), &[(1, (600, 0))], &[]);
    assert_eq!(ask(&library, &far, &RetrievalSettings::default()).candidates, 0);
    // exp(−2.25) = 0.105.
    assert_eq!(ask(&library, &far, &settings(&[("thr", "0.1")])).candidates, 2);
    assert_eq!(ask(&library, &far, &settings(&[("thr", "0.11")])).candidates, 0);
}

#[test]
fn a_fuzzy_path_prefers_the_freer_case_before_interval_and_cost() {
    let library = library(&[
        ("a/forward", &single("[0, 0]", "[400, 400]", ", { kick = \"forward\" }")),
        ("a/left", &single("[10, 0]", "[400, 400]", ", { kick = \"left\" }")),
    ]);
    // Beside the path ahead, not in it: the case ahead is the more similar, the one to the left the freer.
    let beside = problem((0, 0), &[(1, (0, 0))], &[(500, -250)]);
    assert_eq!(winner(&library, &beside), Some(0));
    let fuzzy = ask(&library, &beside, &settings(&[("free_path", "fuzzy")])).best.unwrap();
    assert_eq!((fuzzy.case, fuzzy.free), (CaseId(4), 1.0));
    // With a threshold of 1 only a path with no opponent abreast is free enough.
    let strict = settings(&[("free_path", "fuzzy"), ("free_min", "1")]);
    assert_eq!(ask(&library, &beside, &strict).candidates, 1);
}

#[test]
fn the_maximum_may_be_chosen_as_cost() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    let problem = problem((-600, 10), &[(1, (-700, 0)), (3, (200, 800))], &[]);
    let best = ask(&library, &problem, &settings(&[("cost", "max")])).best.unwrap();
    assert!((f64::from(best.cost) - 22_100.0_f64.sqrt()).abs() < 1e-3, "{}", best.cost);
}

#[test]
fn problems_at_the_ends_of_the_integers_do_no_harm() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    for x in [i32::MIN, i32::MAX] {
        for y in [i32::MIN, 0, i32::MAX] {
            let far = problem((x, y), &[(0, (y, x)), (15, (x, x))], &[(y, y), (x, y)]);
            assert_eq!(winner(&library, &far), None);
            let near = problem((-600, 0), &[(0, (y, x)), (15, (x, x))], &[(y, y), (x, y)]);
            assert_eq!(winner(&library, &near), None);
        }
    }
}

#[test]
fn hand_overs_lead_to_their_other_ends() {
    let library = library(&[("center/pass-around", PASS_AROUND)]);
    let case = library.base().case(CaseId(2)).unwrap();
    let [tm1, tm2] = [0, 1].map(|i| casebase::CaseRobot::new(i).unwrap());
    assert_eq!(case.partner_of(tm1, 1), Some((tm2, 1)));
    assert_eq!(case.partner_of(tm2, 1), Some((tm1, 1)));
    assert_eq!(case.partner_of(tm1, 0), None);
    assert_eq!(case.getter(), tm1);
}
