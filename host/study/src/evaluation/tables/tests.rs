//! Tests: rows have the agreed fields, and trials are counted in the right row.

use super::*;
use crate::evaluation::row::tests::row;

fn trial(approach: Approach, configuration: Configuration, outcome: TrialOutcome, time_s: f64) -> TrialRow {
    let out_by = (outcome == TrialOutcome::Out).then(|| "defender".to_owned());
    let of_all = TrialRow { configuration, approach, outcome, time_s, out_by, ..row() };
    if approach == Approach::Cases {
        return of_all;
    }
    TrialRow {
        individual: 0,
        cooperative: 0,
        none: 0,
        default_s: None,
        default_spells: None,
        no_case_ball: None,
        no_case_robots: None,
        no_case_thr_c: None,
        no_case_path: None,
        no_case_held: None,
        ..of_all
    }
}

#[test]
fn a_row_has_the_fields_of_the_agreement_in_their_order() {
    let rows = [
        trial(Approach::Cases, Configuration::DefenderGoalie, TrialOutcome::Goal, 10.0),
        trial(Approach::Cases, Configuration::DefenderGoalie, TrialOutcome::Out, 30.0),
        trial(Approach::Cases, Configuration::DefenderGoalie, TrialOutcome::Close, 20.0),
    ];
    let json = serde_json::to_string(&tables(&rows)[0]).unwrap();
    assert!(
        json.starts_with(
            "{\"table\":\"1\",\"configuration\":\"dg\",\"scenario\":2,\"approach\":\"cbr\",\"trials\":3,\
             \"goal\":33.3333,\"close\":33.3333,\"block\":0.0,\"out\":33.3333,\"timeout\":0.0,\"to_goal\":66.6667,\
             \"possession_mean\":2.0,\"possession_sd\":0.0,\"possession2_mean\":null,\"possession2_sd\":null,\
             \"time_mean\":20.0,\"time_sd\":10.0,\"backups_a\":null,\"backups_b\":null,\"individual\":3.0,\
             \"cooperative\":5.0,\"none\":1.0,\"out_by_attackers\":0,\"out_by_opponents\":1,\"default_time\":10.0,"
        ),
        "{json}"
    );
    assert!(json.contains("\"time_to_goal_mean\":15.0,\"cases_to_goal_mean\":8.0,"), "{json}");
    assert!(
        json.contains("\"backups_a_sd\":null,\"backups_b_sd\":null,\"sample\":\"paper\",\"goal_low\":"),
        "{json}"
    );
}

#[test]
fn every_trial_stands_in_the_tables_of_its_kind() {
    let (dg, two) = (Configuration::DefenderGoalie, Configuration::TwoDefenders);
    let mut robots = trial(Approach::Reactive, dg, TrialOutcome::Block, 9.0);
    robots.profile = Profile::Robots;
    let rows = [
        trial(Approach::Cases, dg, TrialOutcome::Goal, 10.0),
        trial(Approach::Reactive, dg, TrialOutcome::Goal, 10.0),
        trial(Approach::Reactive, two, TrialOutcome::Goal, 10.0),
        trial(Approach::Reactive, two, TrialOutcome::Timeout, 60.0),
        robots,
    ];
    let tables = tables(&rows);
    let of: Vec<_> = tables.iter().map(|row| (row.table, row.approach, row.trials)).collect();
    let (cbr, reactive) = (Approach::Cases, Approach::Reactive);
    let expected = [
        (1, cbr, 1),
        (1, reactive, 1),
        (2, reactive, 1),
        (3, cbr, 1),
        (4, reactive, 2),
        (5, reactive, 1),
        (6, reactive, 1),
    ];
    assert_eq!(of, expected);
    let (four, five) = (&tables[4], &tables[5]);
    assert_eq!((four.to_goal, four.timeout, four.goal), (Some(50.0), Some(50.0), None));
    assert_eq!((five.to_goal, five.time_mean, five.possession2_mean), (None, Some(10.0), Some(1.0)));
    assert_eq!((tables[2].backups_b, tables[2].individual), (Some(16.0), None));
}

#[test]
fn more_trials_of_robots_than_the_papers_are_distinguished() {
    let mut robots = trial(Approach::Cases, Configuration::DefenderGoalie, TrialOutcome::Goal, 9.0);
    robots.profile = Profile::Robots;
    let out = TrialRow { outcome: TrialOutcome::Out, ..robots.clone() };
    let rows = [vec![robots; 30], vec![out; 10]].concat();
    let shares: Vec<_> =
        tables(&rows).iter().map(|row| (row.table, row.sample, row.trials, row.goal)).collect();
    assert_eq!(shares, [(6, Extent::Paper, 30, Some(100.0)), (6, Extent::Large, 40, Some(75.0))]);
    assert_eq!(tables(&rows[..30]).len(), 1, "nothing more to say");
}

#[test]
fn shares_have_wilsons_intervals() {
    // 15 of 148 (Newcombe 1998, table I, method 3): 6.24 % to 16.05 %.
    let (cases, dg) = (Approach::Cases, Configuration::DefenderGoalie);
    let rows = [
        vec![trial(cases, dg, TrialOutcome::Goal, 9.0); 15],
        vec![trial(cases, dg, TrialOutcome::Out, 9.0); 133],
    ]
    .concat();
    let row = &tables(&rows)[0];
    let near = |value: Option<f64>, expected: f64| (value.unwrap() - expected).abs() < 0.006;
    assert!(near(row.goal_low, 6.24) && near(row.goal_high, 16.05), "{row:?}");
    assert!(near(row.out_low, 100.0 - 16.05) && near(row.out_high, 100.0 - 6.24), "{row:?}");
    assert_eq!(row.timeout_low, Some(0.0));
    let two = &tables(&[trial(cases, Configuration::TwoDefenders, TrialOutcome::Goal, 9.0)])[0];
    assert_eq!((two.goal_low, two.to_goal_high), (None, Some(100.0)), "not measured there");
}
