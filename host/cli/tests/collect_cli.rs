//! `collect_cli`: tests of what recordings give to learning: `trial --record`, `cases evidence`, `cases
//! draft` and `cases learn --from`.

mod verb;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use ssl::Message;
use ssl::log::{LogWriter, MessageKind};
use ssl::referee::{Command as Order, Referee, Stage};
use ssl::vision::{
    DetectionBall, DetectionFrame, DetectionRobot, GeometryData, GeometryFieldSize, WrapperPacket,
};

use verb::{done, failed, names_in};

/// Plays and plays to goal by case.
fn counted(file: &str) -> BTreeMap<String, (u64, u64)> {
    let mut counts = BTreeMap::<String, (u64, u64)>::new();
    for line in
        fs::read_to_string(file).expect("evidence").lines().filter(|line| !line.starts_with("{\"play\""))
    {
        let record: Value = serde_json::from_str(line).expect("a record");
        let of = |key: &str| record[key].as_u64().expect("a number");
        let sum = counts.entry(record["case"].as_str().expect("a name").to_owned()).or_default();
        *sum = (sum.0 + of("plays"), sum.1 + of("to_goal"));
    }
    counts
}

/// A match in which robots are left to themselves.
fn recorded(stem: &str, seed: &str) {
    let free = ["--blue-tactics", "none", "--yellow-tactics", "none"];
    done(&[&["play", "--json", "--duration", "90", "--seed", seed, "--record", stem], &free[..]].concat());
}

/// Plays of each case in the ledger of a trace, and those followed by a goal.
fn in_ledger(trace: &str) -> BTreeMap<String, (u64, u64)> {
    let replayed: Value = serde_json::from_str(&done(&["replay", trace, "--json"])).expect("JSON");
    let mut ledger = BTreeMap::<String, (u64, u64)>::new();
    for team in ["blue", "yellow"] {
        for case in replayed["cases"][team]["cases"].as_array().expect("a list") {
            let sum = ledger.entry(case["case"].as_str().expect("a name").to_owned()).or_default();
            sum.0 += case["retrieved"].as_u64().expect("a number");
            sum.1 += case["followed_by"]["goal"].as_u64().unwrap_or(0);
        }
    }
    ledger
}

#[test]
fn evidence_of_a_trace_agrees_with_its_ledger_case_by_case_in_any_order_of_files() {
    let at = names_in("trace");
    let [a, b] = [at("a.trace"), at("b.trace")];
    let scores = (4..20).any(|seed| {
        recorded(&at("a"), &seed.to_string());
        in_ledger(&a).values().any(|(_, goals)| *goals > 0)
    });
    assert!(scores, "in none of 16 matches a goal after a case");
    recorded(&at("b"), "3");
    let evidence = |files: &[&str], out: &str| {
        done(&[&["cases", "evidence", "--league", "division-b", "--out", &at(out)], files].concat());
        at(out)
    };
    let mut ledger = in_ledger(&a);
    for (case, (plays, goals)) in in_ledger(&b) {
        let sum = ledger.entry(case).or_default();
        *sum = (sum.0 + plays, sum.1 + goals);
    }
    assert!(ledger.len() > 5, "{ledger:?}");
    let both = evidence(&[&a, &b], "both.jsonl");
    assert_eq!(counted(&both), ledger);
    let text = |file: &str| fs::read_to_string(file).expect("evidence");
    assert_eq!(text(&evidence(&[&b, &a, &b], "turned.jsonl")), text(&both), "order, and a file given twice");
    // What was collected merges as what it was collected from.
    let [one, other] = [evidence(&[&a], "a.jsonl"), evidence(&[&b], "b.jsonl")];
    assert_eq!(text(&evidence(&[&other, &one], "merged.jsonl")), text(&both));
    assert!(text(&both).lines().any(|line| line.starts_with("{\"play\"")), "and the successful plays");
}

#[test]
fn a_trace_of_another_league_or_library_is_refused_with_what_to_give_instead() {
    let at = names_in("other");
    recorded(&at("m"), "3");
    let (trace, out) = (at("m.trace"), at("out"));
    for verb in [
        &["cases", "evidence", &trace, "--out", &out][..],
        &["cases", "learn", "--from", &trace, "--out", &out],
        &["cases", "draft", "--from", &trace, "--out", &out],
    ] {
        let error = failed(verb, 1);
        assert!(error.contains("division-b") && error.contains("four-legged"), "{error}");
    }
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../casebase/library/cases/division-b");
    let library = at("division-b");
    fs::create_dir_all(Path::new(&library).join("front")).expect("a directory");
    for file in ["league.toml", "front/shot.toml"] {
        fs::copy(from.join(file), Path::new(&library).join(file)).expect("a copy");
    }
    let error = failed(&["cases", "evidence", &trace, "--library", &library, "--out", &out], 1);
    assert!(error.contains("case base") && error.contains("cases evidence --library"), "{error}");
    // Drafts need no names of cases.
    done(&["cases", "draft", "--from", &trace, "--library", &library, "--out", &at("drafts")]);
}

/// A log file of a match in which blue 1 passes to blue 2, which shoots: mm, attack towards +x.
fn a_pass_and_a_shot(file: &str) {
    let mut log = LogWriter::create(Path::new(file)).expect("a file");
    // A robot that kicks has the ball before it.
    let robot = |id: u32, x: f32, y: f32, orientation: f32| DetectionRobot {
        confidence: 1.0,
        robot_id: Some(id),
        x,
        y,
        orientation: Some(orientation),
        ..DetectionRobot::default()
    };
    // Places of the ball with their times: a pass at 4 m/s, a shot at 6.
    let ways = [
        (1.0, [0.0, 0.0]),
        (1.48, [1500.0, 1200.0]),
        (2.0, [1500.0, 1200.0]),
        (2.52, [4500.0, 300.0]),
        (3.0, [4700.0, 240.0]),
    ];
    let ball = |t: f64| {
        let next = ways.iter().position(|(at, _)| *at > t).unwrap_or(ways.len() - 1).max(1);
        let ((from, a), (to, b)) = (ways[next - 1], ways[next]);
        let part = ((t - from) / (to - from)).clamp(0.0, 1.0) as f32;
        [0, 1].map(|i| a[i] + part * (b[i] - a[i]))
    };
    for number in 0..210_u32 {
        let t = f64::from(number) / 75.0;
        let [x, y] = ball(t);
        let detection = DetectionFrame {
            frame_number: number,
            t_capture: 1000.0 + t,
            t_sent: 1000.0 + t,
            balls: vec![DetectionBall { confidence: 1.0, x, y, ..DetectionBall::default() }],
            robots_blue: vec![
                robot(0, -4400.0, 0.0, 0.0),
                robot(1, -80.0, -64.0, 0.675),
                robot(2, 1405.0, 1232.0, -0.29),
            ],
            robots_yellow: vec![robot(0, 4400.0, -300.0, 3.0), robot(4, 1200.0, -200.0, 3.0)],
            ..DetectionFrame::default()
        };
        let field = GeometryFieldSize {
            field_length: 9000,
            field_width: 6000,
            goal_width: 1000,
            goal_depth: 180,
            boundary_width: 300,
            ..GeometryFieldSize::default()
        };
        let geometry = (number == 0).then(|| GeometryData { field, ..GeometryData::default() });
        let vision = WrapperPacket { detection: Some(detection), geometry, ..WrapperPacket::default() };
        let mut referee = Referee {
            packet_timestamp: (t * 1e6) as u64 + 1_000_000_000,
            command_counter: 1,
            command_timestamp: 1_000_000_000,
            blue_team_on_positive_half: Some(false),
            ..Referee::default()
        };
        referee.set_stage(Stage::NormalFirstHalf);
        referee.set_command(Order::ForceStart);
        let stamp = 1_700_000_000_000_000_000 + (t * 1e9) as i64;
        if number % 3 == 0 {
            log.write(stamp, MessageKind::Refbox2013, &referee.encode_to_vec()).expect("a message");
        }
        log.write(stamp, MessageKind::Vision2014, &vision.encode_to_vec()).expect("a message");
    }
    log.close().expect("a whole file");
}

#[test]
fn a_log_with_one_pass_and_a_shot_becomes_one_case_of_that_geometry() {
    let at = names_in("log");
    a_pass_and_a_shot(&at("match.log"));
    a_pass_and_a_shot(&at("match.log.gz"));
    let draft = |from: &str, out: &str| {
        let told = done(&["cases", "draft", "--from", from, "--league", "division-b", "--out", &at(out)]);
        told.lines().next().expect("a line").to_owned()
    };
    let name = draft(&at("match.log"), "drafts");
    assert_eq!(draft(&at("match.log.gz"), "zipped"), name, "the same case");
    let read =
        |out: &str| fs::read_to_string(Path::new(&at(out)).join(format!("{name}.toml"))).expect("a case");
    let text = read("drafts");
    assert_eq!(read("zipped"), text);
    let case: toml::Table = text.parse().expect("TOML");
    let near = |value: &toml::Value, to: [i64; 2]| {
        let [x, y] = [0, 1].map(|i| value[i].as_integer().expect("mm"));
        assert!((x - to[0]).abs() <= 50 && (y - to[1]).abs() <= 50, "[{x}, {y}] is not {to:?}\n{text}");
    };
    near(&case["ball"]["at"], [0, 0]);
    let robots = case["teammates"].as_array().expect("robots");
    assert_eq!(robots.len(), 2, "{text}");
    near(&robots[0]["at"], [-80, -64]);
    near(&robots[1]["at"], [1500, 1200]);
    for part in
        ["\"get_ball\", { pass_ball = 2 }", "\"wait\", { receive_ball = 1 }, { kick = \"goal_left\" }"]
    {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let opponents = case["opponents"].as_array().expect("opponents");
    // Nearest to the path first: their keeper, and the one beside the pass.
    assert_eq!(opponents.len(), 2, "{text}");
    near(&opponents[1]["at"], [1200, -200]);
    let checked = done(&["cases", "check", "--library", &at("drafts")]);
    assert!(checked.contains("1 case file,") && checked.contains("0 errors"), "{checked}");
}

#[test]
fn a_recorded_trial_counts_its_plays_as_its_report_and_its_play_becomes_a_draft() {
    let at = names_in("trial");
    let mut files = Vec::new();
    let mut cycles = BTreeMap::<String, (u64, u64)>::new();
    for seed in 1..=6 {
        let file = at(&format!("{seed}.jsonl"));
        let report = done(&[
            "trial",
            "--scenario",
            "random",
            "--seed",
            &seed.to_string(),
            "--json",
            "--record",
            &file,
        ]);
        let report: Value = serde_json::from_str(&report).expect("JSON");
        let to_goal = matches!(report["outcome"].as_str(), Some("goal" | "close"));
        for cycle in report["cycles"].as_array().expect("a list") {
            let Some(case) = cycle["case"].as_str() else { continue };
            let sum = cycles.entry(case.to_owned()).or_default();
            *sum = (sum.0 + 1, sum.1 + u64::from(to_goal));
        }
        files.push(file);
    }
    let (all, again) = (at("all.jsonl"), at("again.jsonl"));
    fn arguments<'a>(out: &'a str, files: &'a [String]) -> Vec<&'a str> {
        ["cases", "evidence", "--out", out].into_iter().chain(files.iter().map(String::as_str)).collect()
    }
    let told = done(&arguments(&all, &files));
    let mut known = counted(&all);
    known.remove("");
    assert_eq!(known, cycles, "plays and trials to goal");
    files.reverse();
    assert_eq!(done(&arguments(&again, &files)).replace("again", "all"), told);
    assert_eq!(fs::read(&all).expect("a file"), fs::read(&again).expect("a file"));
    let drafts = at("drafts");
    let drafted = done(&["cases", "draft", "--from", &all, "--out", &drafts]);
    assert!(drafted.lines().count() > 1, "{drafted}");
    assert!(done(&["cases", "check", "--library", &drafts]).contains("0 errors"));
}

#[test]
fn what_is_no_recording_is_refused_with_the_file_and_the_remedy() {
    let at = names_in("garbage");
    recorded(&at("m"), "3");
    let trace = fs::read(at("m.trace")).expect("a trace");
    let files: [(&str, Vec<u8>, &str); 8] = [
        ("bytes", (0..9999_u32).map(|i| ((i * 193) >> 3) as u8 | 0x80).collect(), "neither evidence.jsonl"),
        ("text.jsonl", b"goals: none\n".to_vec(), "neither evidence.jsonl"),
        ("cut.jsonl", b"{\"library\":\"a\"".to_vec(), "line 1: "),
        ("play.jsonl", b"{\"play\":{\"field\":[1,2]}}\n".to_vec(), "line 1: "),
        ("begin.trace", trace[..20].to_vec(), "trace"),
        ("header.trace", [&trace[..16], &[0xff; 64][..]].concat(), "trace"),
        ("cut.log", b"SSL_LOG_FI".to_vec(), "neither evidence.jsonl"),
        ("gzip.log.gz", [&[0x1f, 0x8b][..], &[7; 50]].concat(), "gzip"),
    ];
    for (name, bytes, word) in files {
        fs::write(at(name), bytes).expect("a file");
        let (out, file) = (at("out"), at(name));
        for verb in ["evidence", "draft"] {
            let from = if verb == "draft" { &["--from"][..] } else { &[] };
            let own = [&["cases", verb, "--league", "division-b", "--out", &out], from, &[&file]].concat();
            let error = failed(&own, 1);
            assert!(error.contains(name) && error.contains(word), "{name}: {error}");
        }
    }
    assert!(failed(&["cases", "draft", "--from", "no-such.log", "--out", "x"], 1).contains("no-such.log"));
    // A trace that was cut counts as far as it goes.
    fs::write(at("half.trace"), &trace[..trace.len() / 2]).expect("a file");
    done(&["cases", "evidence", &at("half.trace"), "--league", "division-b", "--out", &at("half.jsonl")]);
}
