//! `replay_cli`: tests of `onetwo replay` on recordings of the league's own programs.

mod verb;

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use host::radio::To;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, RecordKind, Writer};
use host::referee::SenderAddress;
use host::strategy::OrderReason;
use host::{Host, HostSettings, Input};
use protocol::Instant;
use protocol::frame::TeamKey;
use rules::{Colour, League};
use serde_json::Value;
use ssl::log::{MessageKind, open};

use verb::{done, failed, recording, scratch, text};

fn onetwo(arguments: &[&str]) -> Output {
    verb::onetwo(&[&["replay"], arguments].concat())
}

fn json(arguments: &[&str], code: i32) -> Value {
    verb::json(&[&["replay"], arguments].concat(), code)
}

fn refused(arguments: &[&str]) -> String {
    failed(&[&["replay"], arguments].concat(), 1)
}

#[test]
fn a_recording_of_grsim_and_the_game_controller_is_counted() {
    let report = json(&[&recording("grsim_divB_22s.log.gz")], 0);
    assert_eq!((&report["kind"], &report["undecodable"]), (&"log".into(), &0.into()));
    assert_eq!(report["cameras"].as_object().map(serde_json::Map::len), Some(4), "grSim has four cameras");
    let names: Vec<_> = report["events"].as_array().expect("a list").iter().map(|h| &h["name"]).collect();
    assert!(
        names.contains(&&"PREPARE_KICKOFF_YELLOW".into()) || names.contains(&&"PREPARE_KICKOFF_BLUE".into()),
        "{names:?}"
    );
    assert!(report["span_s"].as_f64().is_some_and(|s| (20.0..25.0).contains(&s)), "{}", report["span_s"]);
    assert_eq!(report["tracker"]["nonsense"], 0);
    assert!(report["damage"].is_null() && report["host"].is_null());
}

#[test]
fn gzipped_and_indexed_tell_the_same() {
    let mut zipped = json(&[&recording("grsim_divB_22s.log.gz")], 0);
    let mut plain = json(&[&recording("grsim_divB_22s_indexed.log")], 0);
    for report in [&mut zipped, &mut plain] {
        report["file"] = Value::Null;
    }
    assert_eq!(zipped, plain);
}

#[test]
fn an_event_is_found_and_the_field_displayed_as_it_was() {
    let file = recording("grsim_divB_noisy_64s.log.gz");
    let report = json(&[&file], 0);
    let stops: Vec<f64> = (report["events"].as_array().expect("a list").iter())
        .filter(|h| h["name"] == "STOP")
        .filter_map(|h| h["at_s"].as_f64())
        .collect();
    assert!(stops.len() >= 2, "{stops:?}");
    let second = json(&[&file, "--event", "stop", "--nth", "2"], 0);
    assert_eq!(second["at_s"].as_f64(), Some(stops[1]));
    assert_eq!((&second["phase"], &second["event"]), (&"stop".into(), &"STOP".into()));
    assert!(second["blue"].as_array().is_some_and(|robots| !robots.is_empty()));
    let error = refused(&[&file, "--event", "stop", "--nth", "99"]);
    assert!(error.contains("not 99") && error.contains("HALT"), "{error}");
}

#[test]
fn a_moment_is_displayed_and_one_after_the_end_refused() {
    let file = recording("erforce_divB_realistic_22s.log.gz");
    let moment = json(&[&file, "--at", "10"], 0);
    assert_eq!(moment["at_s"].as_f64(), Some(10.0));
    assert!(
        moment["ball"].is_object() && moment["yellow"].as_array().is_some_and(|r| !r.is_empty()),
        "{moment}"
    );
    assert!(refused(&[&file, "--at", "1000"]).contains("it ends after"));
}

#[test]
fn a_host_fed_twice_sends_the_same() {
    let file = recording("erforce_divB_realistic_22s.log.gz");
    let first = json(&[&file, "--team", "blue"], 0);
    assert!(first["host"]["packets"].as_u64().is_some_and(|n| n > 1000), "{}", first["host"]);
    assert_eq!(first["host"], json(&[&file, "--team", "blue"], 0)["host"]);
    assert_ne!(first["host"]["packets_hash"], json(&[&file, "--team", "yellow"], 0)["host"]["packets_hash"]);
}

#[test]
fn cut_and_foreign_files_are_reported_with_their_place() {
    let bytes = fs::read(recording("grsim_divB_22s_indexed.log")).expect("the recording");
    let cut = scratch("cut.log");
    fs::write(&cut, &bytes[..100_001]).expect("a file");
    let report = json(&[&cut.display().to_string()], 1);
    assert!(
        report["damage"].as_str().is_some_and(|description| description.contains("byte")),
        "{}",
        report["damage"]
    );
    assert!(report["messages"].as_object().is_some_and(|kinds| !kinds.is_empty()));
    let foreign = scratch("foreign.log");
    fs::write(&foreign, "goals: none\n").expect("a file");
    assert!(refused(&[&foreign.display().to_string()]).contains("SSL_LOG_FILE"));
    assert!(refused(&["no-such-file.log"]).contains("no-such-file.log"));
    assert!(refused(&[&recording("grsim_divB_22s.log.gz"), "--check"]).contains("no trace"));
}

/// A trace of a host that receives a recording, as a match writes it.
fn trace(name: &str, change: impl Fn(&mut Vec<u8>, usize)) -> String {
    let settings = HostSettings::new(Colour::Blue, League::DivisionB, 7);
    let header = RecordingHeader {
        version: "0".to_owned(),
        commit: "unknown".to_owned(),
        ..RecordingHeader::of(&settings)
    };
    let mut host = Host::new(settings, Instant(0));
    let json = header.to_json();
    let mut writer = Writer::new(Vec::new(), &json).expect("memory");
    // Magic, version and length come before the header, 14 bytes before each record.
    let (mut length, mut last_sent) = (20 + json.len(), 0);
    let log = open(Path::new(&recording("erforce_divB_realistic_22s.log.gz"))).expect("the recording");
    for (number, record) in (1_u64..).zip(log.take(2000)) {
        let (kind, input) = match record.kind {
            MessageKind::Vision2014 => (RecordKind::Vision, Input::Vision(&record.payload)),
            MessageKind::Refbox2013 => {
                (RecordKind::Referee, Input::Referee(&record.payload, SenderAddress::INTERNAL))
            }
            _ => continue,
        };
        let at = Instant(number * 5_000);
        // A packet of the referee is preceded by its sender.
        let sender = SenderAddress::INTERNAL.to_bytes();
        let sender = if kind == RecordKind::Referee { &sender[..] } else { &[] };
        writer.write(at, 0, kind, &[sender, &record.payload]).expect("memory");
        length += 14 + sender.len() + record.payload.len();
        host.handle(at, input);
        while let Some((to, packet)) = host.poll_packet() {
            let to = if let To::One(robot) = to { robot.number() } else { u8::MAX };
            writer.write(at, 0, RecordKind::Sent, &[&[to], &packet]).expect("memory");
            length += 14 + 1 + packet.len();
            last_sent = length;
        }
    }
    let mut bytes = writer.finish().expect("memory");
    change(&mut bytes, last_sent);
    let file = scratch(name);
    fs::write(&file, bytes).expect("a file");
    file.display().to_string()
}

#[test]
fn from_its_trace_a_host_decides_the_same_again() {
    let file = trace("same.trace", |_, _| {});
    let report = json(&[&file, "--check"], 0);
    assert_eq!((&report["kind"], &report["same_decisions"]), (&"trace".into(), &true.into()));
    assert!(report["hosts"][0]["same_packets"].as_u64().is_some_and(|n| n > 500), "{}", report["hosts"]);
    assert_eq!(report["records"]["sent"], report["hosts"][0]["same_packets"]);
    let out = onetwo(&[&file]);
    assert!(String::from_utf8_lossy(&out.stdout).contains("blue: same decisions: "));
}

#[test]
fn one_bit_that_was_turned_in_a_packet_is_found() {
    let file = trace("turned.trace", |bytes, last_sent| {
        bytes[last_sent - 3] ^= 1;
    });
    let report = json(&[&file], 1);
    assert_eq!(report["same_decisions"], false);
    assert!(
        report["hosts"][0]["difference"]
            .as_str()
            .is_some_and(|description| description.contains("differs from byte")),
        "{report}"
    );
}

#[test]
fn a_trace_cut_in_a_record_is_checked_up_to_there() {
    let file = trace("cut.trace", |bytes, _| bytes.truncate(bytes.len() / 2));
    let report = json(&[&file], 1);
    assert!(
        report["damage"].as_str().is_some_and(|description| description.contains("cut at byte")),
        "{}",
        report["damage"]
    );
    assert_eq!(report["same_decisions"], true);
    let begin = trace("begin.trace", |bytes, _| bytes.truncate(20));
    assert!(refused(&[&begin]).contains("header"));
}

#[test]
fn a_moment_of_a_match_says_what_each_robot_has_to_do_and_why() {
    let name = scratch("decided").display().to_string();
    done(&["play", "--headless", "--duration", "12", "--seed", "1", "--record", &name]);
    let file = format!("{name}.trace");
    let moment = json(&[&file, "--at", "11"], 0);
    for team in ["blue", "yellow"] {
        let robots = moment[team].as_array().expect("a list");
        assert_eq!(robots.len(), 6, "{moment}");
        for robot in robots {
            for printed in ["role", "directive", "why"] {
                assert!(
                    robot[printed].as_str().is_some_and(|description| !description.is_empty()),
                    "{printed} of {robot}"
                );
            }
        }
        assert_eq!(robots.iter().filter(|robot| robot["role"] == "keeper").count(), 1, "{moment}");
    }
    let reported = onetwo(&[&file, "--at", "11"]);
    assert!(String::from_utf8_lossy(&reported.stdout).contains("keeper: go to ("));
}

/// Plays with the bridge between the papers and records it.
fn bridged(seed: u32) -> PathBuf {
    let stem = scratch(&format!("bridged-{seed}"));
    let tactics = "threats,second-level,attack,bridge";
    let play = ["play", "--headless", "--duration", "60", "--seed", &seed.to_string()];
    let record = ["--record", text(&stem), "--blue-tactics", tactics, "--yellow-tactics", tactics];
    done(&[&play[..], &record].concat());
    stem.with_extension("trace")
}

/// What is `found` in the reasons of all orders while a trace is decided again, each once.
fn found_in_orders<T: Ord>(file: &Path, found: impl Fn(OrderReason) -> Option<T>) -> BTreeSet<T> {
    let unpacked = flate2::read::MultiGzDecoder::new(fs::File::open(file).expect("the trace"));
    let mut reader = Reader::new(unpacked).expect("a trace");
    let header = RecordingHeader::from_json(reader.header()).expect("a header");
    assert!(header.hosts.iter().all(|host| host.cases.is_some()), "{header:?}");
    let mut recheck = Recheck::new(&header, TeamKey::ZERO).expect("hosts");
    let mut all = BTreeSet::new();
    for record in reader.by_ref() {
        recheck.feed(&record);
        let Some(host) = recheck.host(usize::from(record.host)) else { continue };
        all.extend(host.orders().iter().filter_map(|order| found(order.why)));
    }
    all
}

/// The case and its robots of every order of a case's pass.
fn parts_in_passes_of_cases(file: &Path) -> BTreeSet<(u16, usize)> {
    found_in_orders(file, |why| match why {
        OrderReason::OfCase { case, part, .. } => Some((case.0, part.index())),
        _ => None,
    })
}

#[test]
fn hosts_that_refine_passes_of_cases_decide_the_same_again() {
    for seed in 1..8 {
        let file = bridged(seed);
        let parts = parts_in_passes_of_cases(&file);
        // Such passes are rare: not every minute has one.
        let Some((case, _)) = parts.first() else { continue };
        assert!(parts.iter().filter(|(of, _)| of == case).count() >= 2, "passer and receiver: {parts:?}");
        assert_eq!(json(&[&file.display().to_string(), "--check"], 0)["same_decisions"], true);
        return;
    }
    panic!("no case's pass in seven minutes");
}

/// A match that is played and recorded: the report of `play`, and the trace.
fn recorded(name: &str, seed: &str) -> (Value, String) {
    let stem = scratch(name).display().to_string();
    let play = ["play", "--duration", "90", "--seed", seed, "--record", &stem];
    // Robots that are left to themselves play most cases.
    let free = ["--blue-tactics", "none", "--yellow-tactics", "none"];
    (verb::json(&[&play[..], &free].concat(), 0), format!("{stem}.trace"))
}

/// What another verb answers to these lines.
fn asked(arguments: &[&str], lines: &str) -> Vec<Value> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut input = child.stdin.take().expect("a pipe");
    let lines = lines.to_owned();
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let out = child.wait_with_output().expect("answers");
    assert!(out.status.success() && writer.join().expect("a thread").is_ok());
    let text = String::from_utf8(out.stdout).expect("words in UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn a_trace_gives_the_matchs_ledger_and_problems_that_explain_its_decisions() {
    let (played, file) = recorded("ledger", "5");
    let replayed = json(&[&file], 0);
    for team in ["blue", "yellow"] {
        let (played, replayed) = (&played["metrics"][team]["cases"], &replayed["cases"][team]);
        for key in ["retrieved", "no_case", "no_case_by_opponents", "no_case_because"] {
            assert_eq!(played[key], replayed[key], "{team} {key}");
        }
        let uses = |table: &Value| {
            let lines = table["cases"].as_array().expect("a list").iter();
            lines
                .map(|line| {
                    [&line["case"], &line["retrieved"], &line["finished"], &line["ends"]].map(Clone::clone)
                })
                .collect::<Vec<_>>()
        };
        assert_eq!(uses(played), uses(replayed), "{team}");
        let opponents = |table: &Value| {
            let lines = table["cases"].as_array().expect("a list").iter();
            let keys = |line: &Value| {
                line["by_opponents"].as_object().map(|by| by.keys().cloned().collect::<Vec<_>>())
            };
            lines.map(keys).collect::<Vec<_>>()
        };
        assert_eq!(opponents(played), opponents(replayed), "{team}");
    }
    let decisions = replayed["decisions"].as_array().expect("a list");
    let counted = |table: &Value| table["retrieved"].as_u64().zip(table["no_case"].as_u64());
    let of_cycles: u64 = [&replayed["cases"]["blue"], &replayed["cases"]["yellow"]]
        .into_iter()
        .filter_map(counted)
        .map(|(cases, none)| cases + none)
        .sum();
    assert_eq!(decisions.len() as u64, of_cycles, "every cycle that was decided is a decision");
    let out = onetwo(&[&file, "--problems"]);
    let lines = String::from_utf8(out.stdout).expect("words in UTF-8");
    let with_problem: Vec<&Value> =
        decisions.iter().filter(|decision| !decision["problem"].is_null()).collect();
    assert_eq!(lines.lines().count(), with_problem.len());
    let answers = asked(&["cases", "retrieve", "--league", "division-b"], &lines);
    let explained = asked(&["cases", "explain", "--json", "--league", "division-b"], &lines);
    let mut checked = 0;
    for ((decision, answer), explained) in with_problem.iter().zip(&answers).zip(&explained) {
        assert!(answer.get("error").is_none(), "{answer}");
        // A host that proposes a case, or a rule about the ball, decides on other grounds than retrieval.
        if decision["reported"] == true && decision["grounds"] == "" {
            assert_eq!(decision["id"], answer["id"], "{decision}");
            assert_eq!(decision["id"], explained["winner"], "{decision}");
            checked += 1;
        }
    }
    assert!(checked > 40, "{checked} of {}", with_problem.len());
    let blue = onetwo(&[&file, "--problems", "--team", "blue"]);
    let of_blue = with_problem.iter().filter(|decision| decision["team"] == "blue").count();
    assert_eq!(String::from_utf8_lossy(&blue.stdout).lines().count(), of_blue);
    gaps_are_played(&lines);
    assert!(refused(&[&recording("grsim_divB_22s.log.gz"), "--problems"]).contains("no trace"));
}

/// The problems of a match in `cases coverage`: its gaps are problems of the match without a case.
fn gaps_are_played(lines: &str) {
    let file = scratch("problems.jsonl");
    fs::write(&file, lines).expect("a file");
    let file = file.display().to_string();
    let gaps = ["cases", "coverage", "--league", "division-b", "--from", &file, "--gaps", "5"];
    let gaps = done(&gaps);
    assert!(gaps.lines().count() > 0);
    assert!(gaps.lines().all(|gap| lines.lines().any(|line| line == gap)), "{gaps}");
    let answers = asked(&["cases", "retrieve", "--league", "division-b"], &gaps);
    assert!(answers.iter().all(|answer| answer["case"].is_null()), "{answers:?}");
}

/// Division B's cases but one, as files.
fn smaller_library() -> PathBuf {
    let directory = scratch("smaller-library");
    let league = case_library::league("division-b").expect("it comes with cases");
    fs::create_dir_all(&directory).expect("a directory");
    fs::write(directory.join("league.toml"), league.rules).expect("written");
    let kept = league.names.iter().zip(league.sources).filter(|(name, _)| **name != "corner/short");
    for (name, text) in kept {
        let file = directory.join(format!("{name}.toml"));
        fs::create_dir_all(file.parent().expect("a region")).expect("a directory");
        fs::write(file, text).expect("written");
    }
    directory
}

#[test]
fn hosts_play_the_cases_of_a_library_and_a_trace_replays_without_it() {
    let (library, stem) = (smaller_library(), scratch("with-library"));
    let play = ["play", "--headless", "--duration", "90", "--seed", "11", "--library", text(&library)];
    done(&[&play[..], &["--record", text(&stem)]].concat());
    fs::remove_dir_all(&library).expect("it is there");
    let trace = stem.with_extension("trace");
    done(&["replay", text(&trace)]);
    let proposed = found_in_orders(&trace, |why| match why {
        OrderReason::PlaysCase { case } => Some(case.0),
        _ => None,
    });
    assert!(proposed.len() >= 2, "hosts propose the library's cases: {proposed:?}");
}
