//! Tests: equal evaluations give equal files, independent of threads, shards and interrupts.

use std::fs;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use brain::Approach;
use hil_sim::{Configuration, Scenario};

use super::*;
use crate::evaluation::plan::EvaluationCell;
use crate::store::{RunProgress, csv_hash, merge, read, to_csv};
use crate::testing::{Directory, GO_ON, on_threads};
use arena::Profile;

fn evaluation() -> Evaluation<'static> {
    let cell = |profile, scenario, approach| EvaluationCell {
        profile,
        configuration: Configuration::TwoDefenders,
        scenario,
        approach,
        trials: 2,
    };
    let simulated = [Approach::Cases, Approach::Reactive]
        .map(|approach| cell(Profile::Simulated, Scenario::DefenderClose, approach));
    let cells = simulated.into_iter().chain([cell(Profile::Robots, Scenario::Random, Approach::Cases)]);
    Evaluation {
        plan: EvaluationPlan { seed: 7, cells: cells.collect() },
        base: case_library::four_legged(),
        names: CaseNames::default(),
        library: "four-legged".to_owned(),
        setup: Setup::default(),
        program: "test".to_owned(),
    }
}

fn hash(rows: &[TrialRow]) -> String {
    csv_hash(&to_csv(rows).unwrap())
}

fn played(directory: &Directory, shard: Shard, threads: usize) -> Vec<TrialRow> {
    on_threads(threads, || evaluation().play_shard(shard, &directory.file(shard), GO_ON)).unwrap()
}

#[test]
fn threads_shards_and_interrupts_change_no_byte() {
    let directory = Directory::new("same");
    let one = played(&directory, Shard::WHOLE, 1);
    assert_eq!(one.iter().map(|row| row.trial).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    assert_eq!((one[0].seed, one[1].seed), (one[2].seed, one[3].seed), "common random numbers");
    let expected = hash(&one);
    assert_eq!(hash(&played(&Directory::new("two"), Shard::WHOLE, 2)), expected);

    let thirds = Directory::new("thirds");
    let shards = [1, 2, 3].map(|i| Shard::new(i, 3).unwrap());
    let files = shards.map(|shard| {
        assert_eq!(played(&thirds, shard, 2).len(), 2);
        read::<TrialRow>(&thirds.file(shard)).unwrap().unwrap()
    });
    let (identity, merged) = merge(files.iter().rev().cloned().collect()).unwrap();
    assert_eq!((hash(&merged), identity), (expected.clone(), evaluation().identity()));
    let lacking = merge(files[..2].to_vec()).unwrap_err().to_string();
    assert!(lacking.starts_with("2 of 6 trials are missing, the first is 2;"), "{lacking}");
    assert!(lacking.ends_with("\n  --shard 3/3: trials-3-of-3.csv lacks 2 of 2 trials"), "{lacking}");

    // Stopped after two trials, killed in the middle of a line, continued.
    let torn = Directory::new("torn");
    let file = torn.file(Shard::WHOLE);
    let stop = |progress: RunProgress| {
        if progress.done < 2 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let stopped = on_threads(1, || evaluation().play_shard(Shard::WHOLE, &file, &stop));
    assert!(matches!(stopped, Err(EvaluationError::Stopped)), "{stopped:?}");
    let kept = read::<TrialRow>(&file).unwrap().unwrap().rows;
    assert_eq!(kept.len(), 2);
    let whole = fs::read(&file).unwrap();
    fs::write(&file, &whole[..whole.len() - 7]).unwrap();
    assert_eq!(read::<TrialRow>(&file).unwrap().unwrap().rows, kept[..1]);
    let reported = AtomicUsize::new(0);
    let count = |_| {
        reported.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let resumed = evaluation().play_shard(Shard::WHOLE, &file, &count).unwrap();
    assert_eq!(hash(&resumed), expected);
    assert_eq!(reported.into_inner(), 1 + 5, "one trial of six was kept");
    assert_eq!(read::<TrialRow>(&file).unwrap().unwrap().rows.len(), 6);
}

#[test]
fn another_evaluation_is_not_mixed_in() {
    let directory = Directory::new("another");
    let file = directory.file(Shard::WHOLE);
    let small = |seed| {
        let mut small = evaluation();
        small.plan.cells.truncate(1);
        Evaluation { plan: EvaluationPlan { seed, ..small.plan.with_trials(1) }, ..evaluation() }
    };
    small(1).play_shard(Shard::WHOLE, &file, GO_ON).unwrap();
    let refused = small(2).play_shard(Shard::WHOLE, &file, GO_ON);
    assert!(matches!(refused, Err(EvaluationError::Another { .. })), "{refused:?}");

    let kept = read::<TrialRow>(&file).unwrap().unwrap();
    let mut elsewhere = kept.clone();
    elsewhere.file = directory.0.join("trials-2-of-2.csv");
    elsewhere.identity.case_base = "12345678".to_owned();
    let hash = &kept.identity.case_base;
    let refused = merge(vec![kept.clone(), elsewhere]).unwrap_err().to_string();
    assert!(refused.contains("trials-2-of-2.csv: is not of the evaluation of "), "{refused}");
    assert!(refused.contains(&format!("cases 12345678, not {hash}; merge")), "{refused}");

    let mut unlike = kept.clone();
    unlike.rows[0].time_s += 1.0;
    assert!(matches!(merge(vec![kept.clone(), kept.clone()]), Ok((_, rows)) if rows == kept.rows));
    assert!(matches!(merge(vec![kept.clone(), unlike]), Err(EvaluationError::Unlike(0))));
    assert!(matches!(merge::<TrialRow>(Vec::new()), Err(EvaluationError::Nothing)));
}

#[test]
fn the_trial_of_a_row_is_played_again_by_its_seed() {
    let evaluation = evaluation();
    let planned = evaluation.plan.get(1).unwrap();
    let row = evaluation.play(&planned).unwrap();
    let cell = planned.cell;
    let alone = TrialConfig::new(cell.scenario, cell.configuration, cell.approach, row.seed);
    let report = run(&alone, Box::new(NativeBackend::new(alone.base)), &mut []).unwrap();
    assert_eq!(report.trace_hash, row.trace_hash);
    let default = report.default.unwrap();
    assert_eq!(default.causes.total(), report.cases.none);
    assert!(default.time_s <= report.time_s);
    assert_eq!(row.default_s, Some(default.time_s));
}
