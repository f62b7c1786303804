//! `replay_output_cli`: tests of `onetwo replay` with `--send`, `--cut`, `--join` and `--export`.

mod verb;

use std::collections::BTreeMap;
use std::fs;
use std::net::UdpSocket;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use ssl::log::{MessageKind, Record, open};

use verb::recording;

fn done(arguments: &[&str]) -> String {
    verb::done(&[&["replay"], arguments].concat())
}

fn refused(arguments: &[&str], code: i32) -> String {
    verb::failed(&[&["replay"], arguments].concat(), code)
}

fn scratch(name: &str) -> String {
    verb::scratch(name).display().to_string()
}

fn records(file: &str) -> Vec<Record> {
    open(Path::new(file)).expect("a log").collect()
}

/// All packets that a port of this host receives until it is silent for 3 s.
fn listen() -> (String, thread::JoinHandle<Vec<Vec<u8>>>) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let address = socket.local_addr().expect("its address").to_string();
    let heard = thread::spawn(move || {
        let (mut heard, mut buffer) = (Vec::new(), vec![0; 65_536]);
        // The program needs a moment to start.
        socket.set_read_timeout(Some(Duration::from_secs(30))).expect("a timeout");
        while let Ok(bytes) = socket.recv(&mut buffer) {
            heard.push(buffer[..bytes].to_vec());
            socket.set_read_timeout(Some(Duration::from_secs(3))).expect("a timeout");
        }
        heard
    });
    (address, heard)
}

fn payloads(records: &[Record], kind: MessageKind) -> Vec<Vec<u8>> {
    records.iter().filter(|record| record.kind == kind).map(|record| record.payload.clone()).collect()
}

#[test]
fn a_replayed_log_reaches_receivers_byte_for_byte_with_its_timing() {
    let file = recording("grsim_divB_22s.log.gz");
    let ((vision, seen), (referee, heard)) = (listen(), listen());
    let began = Instant::now();
    let text = done(&[
        &file,
        "--send",
        "127.0.0.1",
        "--vision",
        &vision,
        "--referee",
        &referee,
        "--at",
        "10",
        "--speed",
        "4",
        "--json",
    ]);
    let took_s = began.elapsed().as_secs_f64();
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let all = records(&file);
    let start_ns = all[0].timestamp_ns + 10_000_000_000;
    let later: Vec<_> = all.into_iter().skip_while(|record| record.timestamp_ns < start_ns).collect();
    let span_s = (later[later.len() - 1].timestamp_ns - later[0].timestamp_ns) as f64 * 1e-9;
    assert!((span_s / 4.0..span_s / 4.0 + 3.0).contains(&took_s), "{took_s} s for {span_s} s");
    let (seen, heard) = (seen.join().expect("it ends"), heard.join().expect("it ends"));
    assert!(seen == payloads(&later, MessageKind::Vision2014), "vision differs: {} packets", seen.len());
    assert!(heard == payloads(&later, MessageKind::Refbox2013), "the referee differs: {}", heard.len());
    assert_eq!(report["sent"]["vision"]["packets"], seen.len());
    assert_eq!(report["sent"]["referee"]["failed"], 0);
}

#[test]
fn two_parts_of_a_log_joined_are_the_whole() {
    let file = recording("grsim_divB_22s.log.gz");
    let [first, second, whole] = ["first.log", "second.log.gz", "whole.log.gz"].map(scratch);
    done(&[&file, "--cut", "0", "8", "--out", &first]);
    done(&[&file, "--cut", "8", "1e6", "--out", &second]);
    done(&[&first, "--join", &second, "--out", &whole]);
    assert!(records(&file) == records(&whole), "time, kind and bytes of every message");
    let all = records(&file);
    let inside = |record: &Record| record.timestamp_ns < all[0].timestamp_ns + 8_000_000_000;
    // Neighbours may be out of order by fractions of a millisecond.
    assert!(records(&first).len().abs_diff(all.iter().filter(|record| inside(record)).count()) <= 2);
}

#[test]
fn a_joined_file_that_starts_too_early_is_shifted_and_reported() {
    let (file, out) = (recording("grsim_divB_22s.log.gz"), scratch("twice.log.gz"));
    let printed = verb::onetwo(&["replay", &file, "--join", &file, "--out", &out]);
    assert_eq!(printed.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&printed.stderr).contains("shifted by"));
    let (once, twice) = (records(&file), records(&out));
    assert_eq!(twice.len(), 2 * once.len());
    assert!(once.iter().zip(&twice[once.len()..]).all(|(a, b)| a.payload == b.payload));
    let end_ns = once.iter().map(|record| record.timestamp_ns).max().expect("messages");
    assert_eq!(twice[once.len()].timestamp_ns, end_ns + 1_000_000_000);
}

#[test]
fn a_table_agrees_with_a_moment_and_csv_with_jsonl() {
    let (file, out) = (recording("erforce_divB_realistic_22s.log.gz"), scratch("field.csv"));
    done(&[&file, "--export", "csv", "--out", &out]);
    let mut table = csv::Reader::from_path(&out).expect("a table");
    let columns: Vec<_> = table.headers().expect("names").iter().map(str::to_owned).collect();
    let rows: Vec<BTreeMap<String, String>> = (table.records())
        .map(|row| columns.iter().cloned().zip(row.expect("a row").iter().map(str::to_owned)).collect())
        .collect();
    let lines: Vec<Value> = (done(&[&file, "--export", "jsonl"]).lines())
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    assert_eq!(rows.len(), lines.len());
    for (row, line) in rows.iter().zip(&lines) {
        let known: Vec<_> = row.iter().filter(|(_, value)| !value.is_empty()).collect();
        assert_eq!(known.len(), line.as_object().expect("an object").len());
        for (column, value) in known {
            let cell = &line[column];
            assert_eq!(*value, cell.as_str().map_or_else(|| cell.to_string(), str::to_owned), "{column}");
        }
    }
    let row = &rows[rows.len() / 2];
    let moment: Value =
        serde_json::from_str(&done(&[&file, "--at", &row["time_s"], "--json"])).expect("JSON");
    for robot in moment["yellow"].as_array().expect("robots") {
        for (axis, name) in ["x_m", "y_m"].iter().enumerate() {
            let column = format!("yellow_{}_{name}", robot["id"]);
            let difference =
                row[&column].parse::<f64>().expect("a number") - robot["at"][axis].as_f64().expect("m");
            assert!(difference.abs() < 2e-4, "{column}: {difference}");
        }
    }
    let summary: Value = serde_json::from_str(&done(&[&file, "--json"])).expect("JSON");
    let exported: usize = rows
        .iter()
        .filter(|row| !row["events"].is_empty())
        .map(|row| row["events"].split("; ").count())
        .sum();
    assert_eq!(exported, summary["events"].as_array().expect("events").len());
}

#[test]
fn of_a_damaged_file_what_can_be_read_is_joined_and_the_damage_is_reported() {
    let (file, cut, out) = (recording("grsim_divB_22s.log.gz"), scratch("cut.log"), scratch("joined.log"));
    done(&[&file, "--cut", "0", "2", "--out", &cut]);
    let (bytes, whole) = (fs::read(&cut).expect("a log"), records(&cut));
    // The header and a few bytes of the first message, or half of all.
    for length in [20, bytes.len() / 2] {
        let damaged = scratch("damaged.log");
        fs::write(&damaged, &bytes[..length]).expect("a copy");
        let left = records(&damaged).len();
        let error = refused(&[&damaged, "--join", &cut, "--out", &out], 1);
        assert!(error.contains("damaged.log"), "{length}: {error}");
        assert_eq!(records(&out).len(), left + whole.len(), "{length}: {error}");
    }
}

#[test]
fn a_refused_command_leaves_all_files_intact() {
    let (file, copy) = (recording("grsim_divB_22s.log.gz"), scratch("copy.log.gz"));
    fs::copy(&file, &copy).expect("a copy");
    assert!(refused(&[&copy, "--cut", "0", "1", "--out", &copy], 1).contains("copy.log.gz"));
    assert!(fs::read(&copy).expect("it is there") == fs::read(&file).expect("it is there"));
    assert!(refused(&[&file, "--cut", "5", "2", "--out", &scratch("none.log")], 1).contains("less than TO"));
    assert!(
        refused(&[&file, "--cut", "50", "60", "--out", &scratch("none.log")], 1)
            .contains("no packet from 50 s")
    );
    assert!(
        refused(&[&file, "--cut", "0", "1", "--out", &scratch("none.txt")], 1)
            .contains("must end in .log or .log.gz")
    );
    assert!(refused(&[&file, "--send", "127.0.0.1", "--at", "99"], 1).contains("it ends after"));
    let absent = ["--export", "csv", "--tracked", "recorded", "--tracker-name", "absent"];
    assert!(refused(&[&[&*file], &absent[..]].concat(), 1).contains("no tracker of that name; it has"));
    for usage in
        [&["--cut", "0", "1"][..], &["--out", "x.csv"], &["--speed", "2"], &["--send", "127.0.0.1:1"]]
    {
        refused(&[&[&*file], usage].concat(), 2);
    }
    assert!(!Path::new(&scratch("none.log")).exists());
}
