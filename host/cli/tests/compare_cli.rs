//! `compare_cli`: tests of `onetwo replay A --compare B` on traces of a played match in which one record is
//! changed.

mod verb;

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use host::record::header::RecordingHeader;
use host::record::trace::{Reader, Record, RecordKind, Writer};
use serde_json::Value;
use ssl::Message;
use ssl::vision::WrapperPacket;

use verb::{json, onetwo, scratch};

/// A changed record is after this time, µs: play runs by then.
const CHANGED_AFTER_US: u64 = 5_000_000;

/// Eight seconds of a match, played once for all tests.
fn match_trace() -> &'static (RecordingHeader, Vec<Record>) {
    static PLAYED: OnceLock<(RecordingHeader, Vec<Record>)> = OnceLock::new();
    PLAYED.get_or_init(|| {
        let stem = scratch("match").display().to_string();
        let out = onetwo(&["play", "--headless", "--duration", "8", "--seed", "1", "--record", &stem]);
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        let file = fs::File::open(format!("{stem}.trace")).expect("the trace");
        let mut reader = Reader::new(flate2::read::MultiGzDecoder::new(file)).expect("a trace");
        let header = RecordingHeader::from_json(reader.header()).expect("a header");
        let records = reader.by_ref().collect();
        (header, records)
    })
}

/// The match's trace with a changed header and changed records.
fn trace(name: &str, change: impl FnOnce(&mut RecordingHeader, &mut Vec<Record>)) -> String {
    let (mut header, mut records) = match_trace().clone();
    change(&mut header, &mut records);
    let mut writer = Writer::new(Vec::new(), &header.to_json()).expect("memory");
    for record in &records {
        let sender = record.from.to_bytes();
        let sender = if record.kind == RecordKind::Referee { &sender[..] } else { &[] };
        writer.write(record.at, record.host, record.kind, &[sender, &record.bytes]).expect("memory");
    }
    let file = scratch(name);
    fs::write(&file, writer.finish().expect("memory")).expect("a file");
    file.display().to_string()
}

fn compared(a: &str, b: &str, code: i32) -> Value {
    json(&["replay", a, "--compare", b], code)
}

fn refused(a: &str, b: &str) -> String {
    let out = onetwo(&["replay", a, "--compare", b]);
    assert_eq!(out.status.code(), Some(1));
    assert!(out.stdout.is_empty());
    String::from_utf8(out.stderr).expect("words in UTF-8")
}

/// The place of a record that is changed: the first of its kind after [`CHANGED_AFTER_US`] that `is_meant`.
fn place(records: &[Record], kind: RecordKind, is_meant: impl Fn(&Record) -> bool) -> usize {
    let late = |record: &Record| record.at.0 > CHANGED_AFTER_US && record.kind == kind;
    records.iter().position(|record| late(record) && is_meant(record)).expect("such a record")
}

#[test]
fn equal_traces_are_equal() {
    let (a, b) = (trace("same-a.trace", |_, _| {}), trace("same-b.trace", |_, _| {}));
    let report = compared(&a, &b, 0);
    assert_eq!((&report["same"], &report["first"]), (&true.into(), &Value::Null));
    assert_eq!(report["records"]["same"].as_u64(), Some(match_trace().1.len() as u64));
    for team in ["blue", "yellow"] {
        assert!(report["orders"][team]["compared"].as_u64().is_some_and(|n| n > 3_000), "{report}");
        assert_eq!(report["orders"][team]["different"], 0);
    }
    assert!(report["ticks"].as_u64().is_some_and(|n| n > 700), "{report}");
}

#[test]
fn a_robot_that_one_camera_frame_moved_is_found_and_what_follows_from_it() {
    let a = trace("moved-a.trace", |_, _| {});
    let mut changed = (0, 0.0);
    let b = trace("moved-b.trace", |_, records| {
        let decoded = |record: &Record| WrapperPacket::decode(&record.bytes[..]).ok();
        let has_blue = |record: &Record| {
            let detection = decoded(record).and_then(|packet| packet.detection);
            record.host == 0 && detection.is_some_and(|image| !image.robots_blue.is_empty())
        };
        let at = place(records, RecordKind::Vision, has_blue);
        let mut packet = decoded(&records[at]).expect("a packet");
        let robot = &mut packet.detection.as_mut().expect("a frame").robots_blue[0];
        robot.x += 37.0;
        changed = (records[at].at.0, robot.x);
        records[at].bytes = packet.encode_to_vec();
    });
    let report = compared(&a, &b, 1);
    let first = &report["first"];
    assert_eq!((&report["same"], &first["what"]), (&false.into(), &"record".into()));
    assert_eq!(first["tick"].as_u64(), Some(changed.0 / 10_000));
    assert_eq!(first["of"], "vision of yellow, detection robots_blue 1 x");
    let value = |which: &str| first[which].as_str().and_then(|x| x.parse::<f32>().ok()).expect("a number");
    assert!((value("b") - changed.1).abs() < 0.01 && (value("b") - value("a") - 37.0).abs() < 0.01);
    let kinds: Vec<&str> =
        report["firsts"].as_array().expect("a list").iter().filter_map(|one| one["what"].as_str()).collect();
    assert!(kinds.contains(&"position"), "the tracked robot moves with it: {kinds:?}");
    assert_eq!(report["records"]["different"], 1);
    assert!(report["positions_different"].as_u64().is_some_and(|n| n >= 1), "{report}");
    assert_eq!(report["orders"]["blue"]["different"], 0, "its host was fed the same");
    let out = onetwo(&["replay", &a, "--compare", &b]);
    let text = String::from_utf8_lossy(&out.stdout);
    assert!(
        text.contains("first difference: record: vision of yellow") && text.contains("first position: blue"),
        "{text}"
    );
}

#[test]
fn one_bit_of_a_packet_to_a_robot_is_found_with_robot_and_byte() {
    let a = trace("bit-a.trace", |_, _| {});
    let mut to = 0;
    let b = trace("bit-b.trace", |_, records| {
        let at = place(records, RecordKind::Sent, |record| record.host == 1 && record.bytes[0] < 16);
        to = records[at].bytes[0];
        let last = records[at].bytes.len() - 1;
        records[at].bytes[last] ^= 1;
    });
    let report = compared(&a, &b, 1);
    let of = report["first"]["of"].as_str().unwrap_or_default();
    assert!(of.starts_with(&format!("sent of blue to robot {to}, byte ")), "{of}");
    let different = |team: &str| report["orders"][team]["different"].as_u64();
    assert_eq!((different("blue"), different("yellow")), (Some(0), Some(0)), "hosts decided the same");
}

#[test]
fn a_shorter_trace_differs_where_it_ends() {
    let a = trace("long.trace", |_, _| {});
    // Up to an input, so that nothing is missing of what follows from it.
    let b = trace("short.trace", |_, records| {
        let end = place(records, RecordKind::Vision, |_| true);
        records.truncate(end);
    });
    let report = compared(&a, &b, 1);
    assert_eq!((&report["firsts"][0]["what"], &report["records"]["only_b"]), (&"length".into(), &0.into()));
    assert!(report["records"]["only_a"].as_u64().is_some_and(|n| n > 1_000), "{report}");
    assert!(report["first"]["b"].as_str().is_some_and(|text| text.starts_with("ends at 5.")), "{report}");
}

#[test]
fn another_seed_is_named_and_plays_another_match() {
    let a = trace("seed-a.trace", |_, _| {});
    let b = trace("seed-b.trace", |header, records| {
        header.seed = Some(99);
        records.truncate(records.len() / 2);
    });
    let report = compared(&a, &b, 1);
    assert_eq!(report["settings"][0]["name"], "seed");
    assert_eq!((&report["settings"][0]["a"], &report["settings"][0]["b"]), (&1.into(), &99.into()));
}

#[test]
fn what_cannot_be_compared_is_refused_with_the_reason() {
    let a = trace("unlike-a.trace", |_, _| {});
    let league = trace("league.trace", |header, _| header.league = "division-a".to_owned());
    assert!(refused(&a, &league).contains("a match of division-a, the other is one of division-b"));
    let hosts = trace("hosts.trace", |header, _| {
        header.hosts.pop();
    });
    assert!(refused(&a, &hosts).contains("it has the hosts yellow, the other has yellow, blue"));
    let cases = |name, hash: &str| trace(name, |header, _| header.hosts[0].cases = Some(hash.to_owned()));
    let (one, two) = (cases("cases-a.trace", "11111111"), cases("cases-b.trace", "22222222"));
    assert!(refused(&one, &two).contains("case base 22222222, the other by 11111111"));
    let old = scratch("old.trace");
    let mut bytes = fs::read(&a).expect("the trace");
    bytes[12..16].copy_from_slice(&1_u32.to_le_bytes());
    fs::write(&old, bytes).expect("a file");
    assert!(
        refused(&a, &old.display().to_string()).contains("a trace of format 1, the other is of format 3")
    );
    let log =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../protocol/ssl/tests/data/grsim_divB_22s.log.gz");
    assert!(refused(&a, &log.display().to_string()).contains("no trace"));
    assert_eq!(onetwo(&["replay", &a, "--compare", &a, "--at", "3"]).status.code(), Some(2));
}
