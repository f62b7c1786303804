//! `hostile_cli`: truncated recordings, files of other formats, text with terminal control characters, and
//! signals, against the built program.

#![cfg(unix)]

mod verb;

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::bufread::MultiGzDecoder;
use flate2::write::GzEncoder;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, RecordKind, TraceEnd};
use host::referee::SenderAddress;
use protocol::frame::TeamKey;
use serde_json::Value;
use ssl::Message;
use ssl::event::GameEvent;
use ssl::log::{LogWriter, MessageKind};
use ssl::referee::{Command as Order, Referee};
use ssl::vision::{DetectionFrame, WrapperPacket};

use verb::{scratch, text};

/// Generous: a loaded machine is no failure.
const PATIENCE: Duration = Duration::from_mins(2);

fn start(arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Runs to its end; a program that does not end is killed, and fails the test.
fn onetwo(arguments: &[&str]) -> Output {
    let mut child = start(arguments);
    let (mut out, mut err) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let read = |pipe: &mut dyn Read| {
        let mut bytes = Vec::new();
        let _ = pipe.read_to_end(&mut bytes);
        bytes
    };
    let (out, err) = (thread::spawn(move || read(&mut out)), thread::spawn(move || read(&mut err)));
    let status = ended(&mut child).unwrap_or_else(|| panic!("{arguments:?} does not end"));
    Output { status, stdout: out.join().unwrap(), stderr: err.join().unwrap() }
}

fn ended(child: &mut Child) -> Option<std::process::ExitStatus> {
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        thread::sleep(Duration::from_millis(10));
    }
    let _ = child.kill();
    let _ = child.wait();
    None
}

fn json(arguments: &[&str], code: i32) -> Value {
    let out = onetwo(&[arguments, &["--json"]].concat());
    assert_eq!(out.status.code(), Some(code), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).expect("one JSON value on stdout and nothing else")
}

/// A recorded match of `seconds` seconds.
fn recorded(name: &str, seconds: &str) -> PathBuf {
    let stem = scratch(name);
    let out = onetwo(&["play", "--headless", "--duration", seconds, "--record", text(&stem)]);
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    stem
}

/// The file that a killed program leaves: what was flushed, without the end.
fn left(bytes: &[u8]) -> Vec<u8> {
    let mut zip = GzEncoder::new(Vec::new(), Compression::fast());
    zip.write_all(bytes).unwrap();
    zip.flush().unwrap();
    zip.get_ref().clone()
}

/// The place behind the checksums that stand at `at`: 14 bytes, of which the tenth is 255, and 4.
fn after_checksums(trace: &[u8], mut at: usize) -> usize {
    while trace.get(at + 9) == Some(&255) {
        at += 18;
    }
    at
}

#[test]
fn a_recording_cut_between_any_two_records_is_cut_and_never_other_decisions() {
    let stem = recorded("cuts", "1");
    let mut whole = Vec::new();
    MultiGzDecoder::new(&fs::read(stem.with_extension("trace")).unwrap()[..])
        .read_to_end(&mut whole)
        .unwrap();
    let mut reader = Reader::new(&whole[..]).unwrap();
    let header = RecordingHeader::from_json(reader.header()).unwrap();
    let mut at = 20 + reader.header().len();
    let mut recheck = Recheck::new(&header, TeamKey::ZERO).unwrap();
    let mut boundaries = vec![(at, None)];
    for record in reader.by_ref() {
        // A referee's packet is preceded by its sender's address.
        let sender = if record.kind == RecordKind::Referee { SenderAddress::LEN } else { 0 };
        at = after_checksums(&whole, at);
        at += 14 + sender + record.bytes.len();
        boundaries.push((at, Some(record.kind)));
        // A truncated trace is checked up to its last record: the result must equal that of the trace
        // truncated here.
        recheck.feed(&record);
        assert!(recheck.results().all(|(_, difference)| difference.is_none()), "after byte {at}");
    }
    at = after_checksums(&whole, at);
    assert_eq!((at, reader.end()), (whole.len(), Some(&TraceEnd::Whole)));
    assert!(boundaries.len() > 500, "{} records", boundaries.len());
    let mut zip = GzEncoder::new(Vec::new(), Compression::fast());
    let mut written = 0;
    let flushed = boundaries.iter().map(|(at, _)| {
        zip.write_all(&whole[written..*at]).unwrap();
        zip.flush().unwrap();
        written = *at;
        zip.get_ref().len()
    });
    let flushed: Vec<usize> = flushed.collect();
    let zip = zip.finish().unwrap();
    for (records, ((at, _), end)) in boundaries.iter().zip(flushed).enumerate() {
        let mut reader = Reader::new(MultiGzDecoder::new(&zip[..end])).unwrap();
        assert_eq!(reader.by_ref().count(), records);
        assert!(
            matches!(reader.end(), Some(TraceEnd::Cut { at: cut, .. }) if *cut == *at as u64),
            "byte {at}: {:?}",
            reader.end()
        );
    }
    // With the program itself, after records of each kind, gzipped and not.
    let mut tried = 0;
    for kind in [RecordKind::Vision, RecordKind::Referee, RecordKind::Robot, RecordKind::Sent] {
        let of_kind: Vec<_> = boundaries.iter().filter(|(_, of)| *of == Some(kind)).collect();
        for place in [of_kind.len() / 3, of_kind.len() / 2] {
            let Some((at, _)) = of_kind.get(place) else { continue };
            let file = scratch("cut.trace");
            fs::write(&file, left(&whole[..*at])).unwrap();
            let report = json(&["replay", text(&file)], 1);
            assert!(
                report["damage"].as_str().is_some_and(|description| description.contains("cut at byte")),
                "{report}"
            );
            assert_eq!(report["same_decisions"], true, "after {kind:?} at byte {at}: {}", report["hosts"]);
            let out = onetwo(&["replay", text(&file)]);
            let (reported, why) =
                (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
            assert!(
                reported.contains("the file is damaged: cut at byte") && why.contains("cut at byte"),
                "{reported}{why}"
            );
            assert!(!reported.contains("other decisions"), "{reported}");
            // Without gzip's end mark only missing packets reveal that it was truncated; in both cases no
            // other decisions.
            fs::write(&file, &whole[..*at]).unwrap();
            let reported = onetwo(&["replay", text(&file)]).stdout;
            assert!(
                !String::from_utf8_lossy(&reported).contains("other decisions"),
                "after {kind:?} at byte {at}"
            );
            tried += 1;
        }
    }
    assert!(tried >= 6, "{tried}");
    let log = stem.with_extension("log.gz");
    let bytes = fs::read(&log).unwrap();
    let cut = scratch("cut.log.gz");
    for parts in [2, 3, 7] {
        fs::write(&cut, &bytes[..bytes.len() * (parts - 1) / parts]).unwrap();
        let report = json(&["replay", text(&cut)], 1);
        assert!(
            report["damage"].as_str().is_some_and(|description| description.starts_with("cut: ")),
            "{}",
            report["damage"]
        );
    }
}

/// A match that is being recorded, some seconds after its start.
fn under_way(name: &str) -> (Child, PathBuf) {
    let stem = scratch(name);
    let log = stem.with_extension("log.gz");
    let _ = fs::remove_file(&log);
    let child = start(&["play", "--headless", "--duration", "36000", "--record", text(&stem)]);
    let begun = Instant::now();
    // Three seconds are some 100 kB.
    while fs::metadata(&log).map_or(0, |file| file.len()) < 100_000 {
        assert!(begun.elapsed() < PATIENCE, "nothing is recorded");
        thread::sleep(Duration::from_millis(10));
    }
    (child, stem)
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()));
}

#[test]
fn a_match_that_is_ended_by_a_signal_ends_in_order_and_its_recording_is_whole() {
    for (name, code) in [("TERM", 143), ("INT", 130)] {
        let (child, stem) = under_way(&format!("ended-{name}"));
        signal(&child, name);
        let out = child.wait_with_output().unwrap();
        let (reported, why) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        assert_eq!(out.status.code(), Some(code), "{why}");
        assert!(
            reported.contains("ball in play") && reported.contains("to see it again"),
            "the summary: {reported}"
        );
        assert!(why.contains("ended by ") && why.contains(name), "{why}");
        let log = json(&["replay", text(&stem.with_extension("log.gz"))], 0);
        assert!(log["damage"].is_null() && log["span_s"].as_f64().is_some_and(|s| s > 1.0), "{log}");
        let trace = json(&["replay", text(&stem.with_extension("trace")), "--at", "0.5"], 0);
        assert!(trace["ball"].is_object(), "{trace}");
        let zipped = fs::read(stem.with_extension("trace")).unwrap();
        let whole = MultiGzDecoder::new(&zipped[..]).read_to_end(&mut Vec::new());
        assert!(whole.is_ok(), "gzip's checksum is right");
    }
}

#[test]
fn a_match_that_is_killed_has_lost_a_second_at_most() {
    let (mut child, stem) = under_way("killed");
    child.kill().unwrap();
    child.wait().unwrap();
    let report = json(&["replay", text(&stem.with_extension("trace"))], 1);
    assert!(
        report["damage"].as_str().is_some_and(|description| description.contains("cut at byte")),
        "{report}"
    );
    assert_eq!(report["same_decisions"], true, "{}", report["hosts"]);
    let of_trace = report["span_s"][1].as_f64().unwrap();
    let of_log = json(&["replay", text(&stem.with_extension("log.gz"))], 1)["span_s"].as_f64().unwrap();
    // Both are flushed at the same moments of the match; either may hold more by what its buffers flushed in
    // between.
    assert!(of_trace > 1.0 && of_log > 1.0, "{of_trace} {of_log}");
}

/// The first control character that a terminal would obey.
fn obeyed(text: &str) -> Option<char> {
    text.chars().find(|character| character.is_control() && !matches!(character, '\n' | '\t'))
}

/// A log with such a referee, and vision at 75 Hz; the recorder's clock is set by `by` ns from its middle on.
fn log(file: &Path, referee: &Referee, by: i64) {
    let mut log = LogWriter::create(file).unwrap();
    for n in 0..300_i64 {
        let at = 1_700_000_000_000_000_000 + n * 13_333_333 + if n >= 150 { by } else { 0 };
        let detection = DetectionFrame {
            frame_number: n as u32,
            t_capture: n as f64 / 75.0,
            ..DetectionFrame::default()
        };
        let packet = WrapperPacket { detection: Some(detection), ..WrapperPacket::default() };
        log.write(at, MessageKind::Vision2014, &packet.encode_to_vec()).unwrap();
        if n % 2 == 0 {
            log.write(at, MessageKind::Refbox2013, &referee.encode_to_vec()).unwrap();
        }
    }
    log.close().unwrap();
}

#[test]
fn a_log_cannot_speak_to_the_terminal_nor_write_lines_of_its_own() {
    let hostile = "\u{1b}[31mEVIL\u{1b}]0;pwn\u{7}\n     0.00 s  GOAL\r\u{9b}2J\u{202e}";
    let mut referee = Referee {
        command: Order::BallPlacementBlue as i32,
        source_identifier: Some(hostile.to_owned()),
        status_message: Some(hostile.to_owned()),
        ..Referee::default()
    };
    referee.blue.name = hostile.to_owned();
    referee.game_events = vec![GameEvent {
        id: Some(hostile.to_owned()),
        origin: vec![hostile.to_owned()],
        ..GameEvent::default()
    }];
    let file = scratch("\u{1b}]0;name\u{7}\nforged: all is well.log");
    log(&file, &referee, 0);
    let out = onetwo(&["replay", text(&file)]);
    let reported = String::from_utf8(out.stdout).unwrap();
    assert_eq!(obeyed(&reported), None, "{reported:?}");
    assert!(
        reported.contains("\\u001b[31mEVIL\\u001b]0;pwn\\u0007\\n     0.00 s  GOAL\\r\\u009b2J\\u202e"),
        "{reported}"
    );
    for line in reported.lines() {
        assert!(!line.starts_with("forged") && !line.ends_with("  GOAL"), "a line of its own: {line}");
    }
    let report = json(&["replay", text(&file)], 0);
    assert_eq!(report["teams"]["blue"]["name"], hostile, "data is kept as it is");
    // Errors name files too, and so do findings about case files.
    let out = onetwo(&["replay", text(&scratch("\u{1b}[2Jno\nsuch.log"))]);
    let stderr = String::from_utf8(out.stderr).unwrap();
    assert_eq!((obeyed(&stderr), stderr.lines().count()), (None, 1), "{stderr:?}");
    let library = scratch("library-\u{1b}[31m");
    fs::create_dir_all(library.join("center")).unwrap();
    fs::write(library.join("league.toml"), "\u{1b}[2J = \"\u{1b}]0;x\u{7}\"").unwrap();
    fs::write(library.join("center/a\u{1b}[2J.toml"), "x = 1").unwrap();
    for arguments in
        [["cases", "check", "--library", text(&library)], ["cases", "list", "--library", text(&library)]]
    {
        let out = onetwo(&arguments);
        assert_ne!(out.status.code(), Some(0));
        let output = String::from_utf8([out.stdout, out.stderr].concat()).unwrap();
        assert!(!output.is_empty() && obeyed(&output).is_none(), "{output:?}");
    }
}

#[test]
fn a_recorder_s_clock_that_is_set_changes_no_rate() {
    let file = scratch("steps.log");
    for by in [0, -4_000_000_000, -500_000_000, 5_000_000_000] {
        log(&file, &Referee::default(), by);
        let report = json(&["replay", text(&file)], 0);
        for (kind, hz) in [("vision", 75.0), ("referee", 37.5)] {
            let rate = report["messages"][kind]["rate_hz"].as_f64().unwrap();
            assert!((rate / hz - 1.0).abs() < 0.02, "set by {by} ns: {rate} {kind} a second");
        }
        let steps = report["clock_steps"].as_array().unwrap();
        assert_eq!(steps.len(), usize::from(by != 0), "{by}: {steps:?}");
        let gaps = report["gaps"].as_array().unwrap();
        assert!(gaps.is_empty(), "{by}: a clock that is set is no gap, by the cameras' own time: {gaps:?}");
    }
}

#[test]
fn field_names_cards_robots_and_places_of_a_recording_are_reported() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../protocol/ssl/tests/data/grsim_divB_noisy_64s.log.gz");
    let report = json(&["replay", text(&data)], 0);
    assert_eq!(
        (report["field"]["length"].as_f64(), report["field"]["width"].as_f64()),
        (Some(9.0), Some(6.0))
    );
    for team in ["blue", "yellow"] {
        let sheet = &report["teams"][team];
        assert!(sheet["name"].is_string() && sheet["max_bots"].as_u64().is_some_and(|n| n <= 6), "{sheet}");
    }
    let cards: u64 =
        ["blue", "yellow"].iter().filter_map(|team| report["teams"][team]["yellow_cards"].as_u64()).sum();
    assert_eq!(cards, 1, "README of the recordings: one yellow card");
    let match_events = report["events"].as_array().unwrap();
    let named = |name: &str| match_events.iter().filter(|h| h["name"] == name).collect::<Vec<_>>();
    assert_eq!(named("YELLOW_CARD").len(), 1);
    assert!(!named("MAX_BOTS").is_empty(), "a card takes a robot off");
    let placed: Vec<_> = match_events
        .iter()
        .filter(|h| h["words"].as_str().is_some_and(|description| description.contains("the ball to (")))
        .collect();
    assert!(!placed.is_empty());
    let reported = String::from_utf8(onetwo(&["replay", text(&data)]).stdout).unwrap();
    assert!(reported.contains("field: 9.000 x 6.000 m") && reported.contains("max bots"), "{reported}");
    assert_eq!(json(&["replay", text(&data), "--event", "yellow_card"], 0)["event"], "YELLOW_CARD");
}

#[test]
fn special_files_are_refused_by_what_they_are_wherever_a_file_is_read() {
    let pipe = scratch("pipe");
    let _ = fs::remove_file(&pipe);
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let library = scratch("library");
    let _ = fs::remove_dir_all(&library);
    fs::create_dir_all(library.join("center")).unwrap();
    fs::write(library.join("league.toml"), "").unwrap();
    let case = library.join("center/z.toml");
    for special in ["/dev/zero", "/dev/full", text(&pipe)] {
        let _ = fs::remove_file(&case);
        std::os::unix::fs::symlink(special, &case).unwrap();
        let trial = text(&library);
        let robots =
            ["control", "--robots", "udp://127.0.0.1:9", "--colour", "blue", "--name", "T", "--headless"];
        let control = |flag| [&robots[..], &["--duration", "1", flag, special]].concat();
        let all = [
            vec!["replay", special],
            vec!["replay", special, "--at", "1"],
            control("--config"),
            control("--key-file"),
            vec!["cases", "check", "--library", trial],
            vec!["cases", "new", "--from", special],
            vec!["cases", "render", "--problem", special],
            vec!["cases", "coverage", "--from", special],
            vec!["firmware", "run", "--page", special],
        ];
        for arguments in all {
            let out = onetwo(&arguments);
            let output = String::from_utf8_lossy(&[out.stdout, out.stderr].concat()).into_owned();
            assert_ne!(out.status.code(), Some(0), "{arguments:?}: {output}");
            // Some verbs have no such flag for files: clap exits with 2.
            if out.status.code() == Some(1) {
                let kind = if special.starts_with("/dev") { "this is a device" } else { "this is a pipe" };
                assert!(output.contains(kind), "{arguments:?}: {output}");
            }
        }
    }
}

#[test]
fn a_bad_line_of_fifty_megabytes_is_refused_in_a_few_words() {
    let config = scratch("long.toml");
    fs::write(&config, format!("name = \"a\"\n{}\n", "x".repeat(900_000))).unwrap();
    let control = ["control", "--headless", "--duration", "1", "--config", text(&config)];
    let out = onetwo(&control);
    assert_eq!(out.status.code(), Some(1));
    assert!(out.stderr.len() < 2_000, "{} bytes", out.stderr.len());
    assert!(
        String::from_utf8_lossy(&out.stderr).contains("line 2"),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    fs::File::create(&config).unwrap().set_len(50_000_000).unwrap();
    let out = onetwo(&control);
    assert!(String::from_utf8_lossy(&out.stderr).contains("longer than 1048576 bytes"));
    fs::remove_file(&config).unwrap();
}
