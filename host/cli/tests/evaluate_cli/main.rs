//! `evaluate_cli`: black-box tests of `onetwo evaluate`. Few trials of each kind.

mod common;
mod matches;
mod report;
mod skills;

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use common::{json, onetwo, refused, scratch, stdout_of, table, text};

/// Short trials: against two defenders they end after 60 s.
const SHORT: [&str; 6] = ["evaluate", "--opponents", "2d", "--scenario", "4", "--seed"];

fn hash(out: &Path) -> String {
    json(&out.join("run.json"))["csv_hash"].as_str().expect("a hash").to_owned()
}

fn rows_kept(file: &Path) -> usize {
    fs::read_to_string(file).map_or(0, |text| text.lines().count().saturating_sub(2))
}

#[test]
fn tables_json_has_the_rows_of_the_agreement() {
    let out = scratch("tables");
    let output =
        stdout_of(&["evaluate", "--trials", "2", "--scenario", "3", "--random", "--out", text(&out)]);
    let tables = json(&out.join("tables.json"));
    let rows = tables.as_array().expect("a list");
    let of = |table: &str, scenario: serde_json::Value| {
        rows.iter().filter(|row| row["table"] == table && row["scenario"] == scenario).count()
    };
    for table in ["1", "4"] {
        assert!(of(table, 3.into()) >= 2 && of(table, "random".into()) >= 2, "table {table}");
        assert!(output.contains(&format!("Table {table}: ")), "{output}");
    }
    assert!(of("2", 3.into()) >= 1 && of("3", 3.into()) >= 1 && of("6", 3.into()) >= 2);
    assert_eq!((of("6", "random".into()), of("1", 1.into())), (0, 0));
    let shares = |row: &serde_json::Value| {
        ["goal", "close", "block", "out", "timeout"].iter().filter_map(|key| row[key].as_f64()).sum::<f64>()
    };
    let first = rows.iter().filter(|row| row["table"] == "1");
    assert!(first.clone().all(|row| (shares(row) - 100.0).abs() < 1e-3 && row["trials"] == 2));

    let run = json(&out.join("run.json"));
    assert_eq!((&run["plan"]["seed"], &run["settings"]["thr_c"]), (&1.into(), &"1500".into()));
    assert_eq!(run["cases"].as_array().map(Vec::len), Some(34));
    assert!(run["program"].as_str().is_some_and(|program| program.contains("commit")));
    assert!(run["parameters"]["grab"]["success"].is_number());
    assert!(output.contains(run["csv_hash"].as_str().expect("a hash")), "{output}");
    let cases = table(&out.join("cases.csv"));
    let retrieved: u32 = cases.iter().map(|case| case["retrieved"].parse::<u32>().expect("a number")).sum();
    let trials = table(&out.join("trials.csv"));
    let counted =
        |column: &str| trials.iter().map(|row| row[column].parse::<u32>().expect("a number")).sum::<u32>();
    assert!(retrieved > 0);
    assert_eq!(retrieved, counted("individual") + counted("cooperative"));
    assert!(json(&out.join("comparisons.json")).as_array().is_some_and(|list| !list.is_empty()));
}

#[test]
fn jobs_shards_and_a_kill_change_no_byte() {
    let whole = scratch("whole");
    let options = [&SHORT[..], &["3", "--trials", "12"]].concat();
    let run = |more: &[&str]| stdout_of(&[&options, more].concat());
    run(&["--jobs", "1", "--out", text(&whole)]);
    let (expected, bytes) = (hash(&whole), fs::read(whole.join("trials.csv")).expect("written"));

    let (here, there, merged) = (scratch("here"), scratch("there"), scratch("merged"));
    let reported = run(&["--shard", "1/3", "--jobs", "2", "--out", text(&here)]);
    assert!(reported.contains("onetwo evaluate merge"), "{reported}");
    run(&["--shard", "3/3", "--out", text(&here)]);
    let lacking = refused(&["evaluate", "merge", text(&here), "--out", text(&merged)], 1);
    assert!(lacking.contains("12 of 36 trials are missing"), "{lacking}");
    assert!(lacking.contains("\n  --shard 2/3: trials-2-of-3.csv lacks 12 of 12 trials"), "{lacking}");
    // A shard that starts again keeps the others' trials.
    run(&["--shard", "3/3", "--fresh", "--out", text(&here)]);
    run(&["--shard", "2/3", "--out", text(&there)]);
    stdout_of(&["evaluate", "merge", text(&here), text(&there), "--out", text(&merged)]);
    assert_eq!((hash(&merged), fs::read(merged.join("trials.csv")).ok()), (expected.clone(), Some(bytes)));
    for file in ["tables.json", "comparisons.json", "cases.csv", "run.json"] {
        assert_eq!(fs::read(merged.join(file)).ok(), fs::read(whole.join(file)).ok(), "{file}");
    }

    // Killed without warning once some trials are over.
    let killed = scratch("killed");
    let file = killed.join("trials-1-of-1.csv");
    let arguments = [&options[..], &["--jobs", "1", "--out", text(&killed)]].concat();
    let mut child = onetwo(&arguments).stdout(std::process::Stdio::null()).spawn().expect("it starts");
    while rows_kept(&file) < 3 && child.try_wait().expect("a child").is_none() {
        sleep(Duration::from_millis(1));
    }
    child.kill().expect("kill -9");
    child.wait().expect("it is gone");
    let kept = rows_kept(&file);
    assert!(!killed.join("tables.json").exists() && kept >= 3, "{kept} trials kept");
    run(&["--out", text(&killed)]);
    assert_eq!(hash(&killed), expected);
}

#[cfg(target_os = "linux")]
#[test]
fn ctrl_c_keeps_what_is_over_and_says_how_to_go_on() {
    let out = scratch("ctrl-c");
    let file = out.join("trials-1-of-1.csv");
    let arguments = [&SHORT[..], &["5", "--trials", "400", "--jobs", "1", "--out", text(&out)]].concat();
    // A test run that was started in the background ignores Ctrl-C, and so do its children.
    let deaf = onetwo(&arguments);
    let mut command = std::process::Command::new("env");
    command.arg("--default-signal=INT").arg(deaf.get_program()).args(deaf.get_args());
    let child = command.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::piped()).spawn();
    let mut child = child.expect("it starts");
    while rows_kept(&file) < 2 && child.try_wait().expect("a child").is_none() {
        sleep(Duration::from_millis(1));
    }
    let interrupt = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.expect("kill is there").success());
    let end = child.wait_with_output().expect("it ends");
    let stderr = String::from_utf8(end.stderr).expect("UTF-8");
    assert_eq!(end.status.code(), Some(1), "{} {stderr}", end.status);
    assert!(stderr.contains("goes on from here"), "{stderr}");
    let kept = fs::read_to_string(&file).expect("kept");
    assert!(kept.ends_with('\n') && rows_kept(&file) >= 2, "no line is torn");
}

#[test]
fn any_row_is_played_again_alone() {
    let out = scratch("again");
    stdout_of(&["evaluate", "--trials", "2", "--scenario", "4", "--seed", "9", "--out", text(&out)]);
    let rows = table(&out.join("trials.csv"));
    let worlds = |profile: &str| rows.iter().filter(|row| row["profile"] == profile).count();
    assert!(worlds("simulated") >= 8 && worlds("robots") >= 4);
    for row in rows {
        let picture = out.join("trial.svg");
        let again = stdout_of(&[
            "trial",
            "--json",
            "--scenario",
            &row["scenario"],
            "--opponents",
            &row["configuration"],
            "--approach",
            &row["approach"],
            "--profile",
            &row["profile"],
            "--seed",
            &row["seed"],
            "--svg",
            text(&picture),
        ]);
        let report: serde_json::Value = serde_json::from_str(&again).expect("JSON");
        assert_eq!(report["trace_hash"], row["trace_hash"].as_str());
        assert!(fs::read_to_string(&picture).expect("a picture").starts_with("<svg"));
    }
}

#[test]
fn a_change_to_the_team_is_recorded_and_reaches_the_robots() {
    let out = scratch("changed");
    let base = |flags: &[&str]| {
        let directory = out.join(flags.concat());
        stdout_of(
            &[&SHORT[..], &["2", "--trials", "2", "--approach", "cbr"], flags, &["--out", text(&directory)]]
                .concat(),
        );
        json(&directory.join("run.json"))
    };
    let plain = base(&[]);
    for (flags, key) in [
        (&["--no-symmetry"][..], "case_base"),
        (&["--no-opponents"], "case_base"),
        (&["--loss", "0.3"], "loss"),
        (&["--retrievers", "1"], "retrievers"),
        (&["--positioning", "independent"], "positioning"),
        (&["--set", "cost=max"], "settings"),
    ] {
        let run = base(flags);
        assert_ne!(run[key], plain[key], "{flags:?}");
        // One retriever of two, or the largest distance instead of the sum, may have no effect in two trials.
        if !matches!(key, "retrievers" | "settings") {
            assert_ne!(run["csv_hash"], plain["csv_hash"], "{flags:?}");
        }
    }
}

#[test]
fn what_cannot_be_done_is_reported_with_its_hint() {
    let out = scratch("refused");
    let short = |seed: &'static str, loss: &'static str| {
        let own = [seed, "--loss", loss, "--trials", "1", "--approach", "cbr", "--out", text(&out)];
        [&SHORT[..], &own].concat()
    };
    stdout_of(&short("1", "0"));
    let error = refused(&short("2", "0.1"), 1);
    assert!(error.contains("loss 0, not 0.1; seed 1, not 2;"), "{error}");
    assert!(error.contains("trials-1-of-1.csv: holds trials of another evaluation"), "{error}");
    assert!(error.contains("--fresh"), "{error}");
    stdout_of(&[&short("2", "0.1")[..], &["--fresh"]].concat());
    assert_eq!(json(&out.join("run.json"))["plan"]["seed"], 2);

    let empty = scratch("empty");
    assert!(
        refused(&["evaluate", "merge", text(&empty), "--out", text(&empty)], 1).contains("no trials there")
    );
    let nowhere = empty.join("no-folder");
    assert!(refused(&["evaluate", "merge", text(&nowhere), "--out", text(&empty)], 1).contains("no-folder"));
    assert!(
        refused(&["evaluate", "--profile", "robots", "--opponents", "2d"], 1).contains("leave out a filter")
    );
    assert!(refused(&["evaluate", "--shard", "4/3"], 2).contains("2/3"));
    assert!(refused(&["evaluate", "--approach", "best"], 2).contains("cbr or reactive"));
    assert!(refused(&["evaluate", "--trials", "0"], 2).contains("--trials"));
    assert!(refused(&["evaluate", "merge"], 2).contains("--out"));
    assert!(refused(&["evaluate", "--league", "division-b", "--out", text(&empty)], 1).contains("another"));
}

#[test]
fn every_claim_of_the_paper_is_judged_on_our_trials_and_on_its_own_tables() {
    let out = scratch("claims");
    let output = stdout_of(&["evaluate", "--trials", "2", "--seed", "4", "--out", text(&out)]);
    let claims = json(&out.join("claims.json"));
    let claims = claims.as_array().expect("a list");
    assert!(claims.len() >= 30);
    for claim in claims {
        for side in ["ours", "paper"] {
            let verdict = claim[side]["verdict"].as_str().expect("a word");
            let evidence = claim[side]["evidence"].as_str().expect("words");
            assert!(["supported", "contradicted", "undecided", "unmeasured"].contains(&verdict), "{verdict}");
            assert_eq!(evidence.is_empty(), verdict == "unmeasured", "{claim}");
        }
        assert!(output.contains(claim["sentence"].as_str().expect("words")), "{output}");
    }
    let verdicts =
        |side: &str, verdict: &str| claims.iter().filter(|c| c[side]["verdict"] == verdict).count();
    assert!(verdicts("paper", "supported") > 10 && verdicts("paper", "contradicted") > 0);
}

#[test]
fn judge_reports_every_line_with_numbers_and_misses_are_no_error() {
    let out = scratch("judge");
    let output = stdout_of(&["evaluate", "judge", "--trials", "1", "--out", text(&out)]);
    let lines = json(&out.join("judge.json"));
    for line in lines.as_array().expect("a list") {
        let verdict = line["verdict"].as_str().expect("a word");
        assert!(["held", "missed", "unmeasured"].contains(&verdict), "{line}");
        assert!(output.contains(line["line"].as_str().expect("words")), "{output}");
    }
    let run = json(&out.join("run.json"));
    assert_eq!(run["plan"]["seed"], 2009);
    let random = run["plan"]["cells"].as_array().expect("cells").iter().filter(|c| c["scenario"] == "random");
    assert!(random.count() >= 4);
}

#[test]
fn an_ablation_compares_pairs_and_goes_on_with_more_arms() {
    let out = scratch("ablations");
    let run = |arms: &[&str]| {
        let arms: Vec<_> = arms.iter().flat_map(|arm| ["--arm", arm]).collect();
        let options = ["evaluate", "ablations", "--trials", "1", "--out", text(&out)];
        stdout_of(&[&options[..], &arms].concat())
    };
    run(&["loss-50"]);
    let kept = |arm: &str| fs::read(out.join(format!("arms/{arm}.csv"))).expect("kept");
    let before = (kept("default"), kept("loss-50"));
    let output = run(&["loss-50", "no-symmetry"]);
    assert!(output.contains("no-symmetry") && output.contains("to_goal"), "{output}");
    assert_eq!((kept("default"), kept("loss-50")), before, "nothing is played twice");
    let effects = json(&out.join("ablations.json"));
    let effects = effects.as_array().expect("a list");
    assert_eq!(effects.len(), 2 * 9 * 7, "arms, cells and all of them, measures");
    let all = effects.iter().filter(|effect| effect["scenario"].is_null());
    assert!(all.clone().all(|effect| effect["trials"] == 8));
    let differs = |arm: &str| all.clone().any(|e| e["arm"] == arm && e["difference"].as_f64() != Some(0.0));
    assert!(differs("loss-50") && differs("no-symmetry"));
    assert_eq!(table(&out.join("ablations.csv")).len(), effects.len());
    assert!(refused(&["evaluate", "ablations", "--arm", "none"], 2).contains("thr_c-none"));
}
