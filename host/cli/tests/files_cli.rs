//! `files_cli`: tests of files as people have them: recordings that were joined, are old, or were made with a
//! clock that was set; outputs that would destroy something; libraries with other files in them.

mod verb;

use std::fs;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::Value;
use ssl::Message as _;
use ssl::log::{LogWriter, MessageKind};
use ssl::referee::{Command as RefereeCommand, Referee};
use ssl::vision::{
    DetectionBall, DetectionFrame, DetectionRobot, GeometryData, GeometryFieldSize, WrapperPacket, legacy,
};

use verb::{directory, onetwo, text};

/// What `replay` reports of a file, and its exit code.
fn replay(file: &Path, more: &[&str]) -> (Value, Option<i32>, String) {
    let out = onetwo(&[&["replay", text(file), "--json"], more].concat());
    let stderr = String::from_utf8_lossy(&out.stderr).into_owned();
    (serde_json::from_slice(&out.stdout).unwrap_or_default(), out.status.code(), stderr)
}

/// Two robots that stand, and a ball that rolls at 1 m/s; by the camera's own clock in s.
fn frame(number: u32, t_capture: f64) -> DetectionFrame {
    let robot = |id, x| DetectionRobot {
        confidence: 1.0,
        robot_id: Some(id),
        x,
        y: 0.0,
        orientation: Some(0.0),
        ..DetectionRobot::default()
    };
    let ball =
        DetectionBall { confidence: 1.0, x: 1000.0 / 60.0 * number as f32, ..DetectionBall::default() };
    DetectionFrame {
        frame_number: number,
        t_capture,
        t_sent: t_capture,
        camera_id: 0,
        balls: vec![ball],
        robots_yellow: vec![robot(1, -1000.0)],
        robots_blue: vec![robot(2, 1000.0)],
        ..DetectionFrame::default()
    }
}

fn field(length: i32) -> GeometryData {
    let field = GeometryFieldSize {
        field_length: length,
        field_width: length * 2 / 3,
        goal_width: 1000,
        goal_depth: 180,
        boundary_width: 300,
        ..GeometryFieldSize::default()
    };
    GeometryData { field, ..GeometryData::default() }
}

/// A log of 2 s at 60 images a second; message `n` has the time stamp `stamp(n, seconds)`, ns.
fn log(length: i32, start: f64, stamp: impl Fn(u32, f64) -> i64) -> Vec<u8> {
    let mut writer = LogWriter::new(Vec::new()).expect("memory");
    for number in 0..120 {
        let t = start + f64::from(number) / 60.0;
        let geometry = (number % 60 == 0).then(|| field(length));
        let packet =
            WrapperPacket { detection: Some(frame(number, t)), geometry, ..WrapperPacket::default() };
        let at = stamp(number, t);
        writer.write(at, MessageKind::Vision2014, &packet.encode_to_vec()).expect("memory");
        if number % 2 == 0 {
            let referee = Referee {
                packet_timestamp: (t * 1e6) as u64,
                command: RefereeCommand::Halt as i32,
                command_counter: 1,
                ..Referee::default()
            };
            writer.write(at + 1000, MessageKind::Refbox2013, &referee.encode_to_vec()).expect("memory");
        }
    }
    writer.finish().expect("memory")
}

const START: f64 = 1_790_000_000.0;

fn right(_: u32, t: f64) -> i64 {
    (t * 1e9) as i64
}

fn gzipped(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write as _;
    let mut writer = GzEncoder::new(Vec::new(), Compression::fast());
    writer.write_all(bytes).expect("memory");
    writer.finish().expect("memory")
}

#[test]
fn joined_logs_are_read_to_the_last_and_a_cut_one_among_them_is_told() {
    let directory = directory("joined");
    let halves = [0.0, 301.0, 900.0].map(|later| log(9000, START + later, right));
    let file = directory.join("match.log");
    // Two, three, gzipped members, an index between them, and a first one that is cut within a message.
    let indexed = {
        let whole = directory.join("indexed.log");
        let mut writer = LogWriter::create(&whole).expect("a file");
        writer.write(1_789_999_000_000_000_000, MessageKind::Blank, &[]).expect("a file");
        writer.close().expect("a file");
        fs::read(&whole).expect("the file")
    };
    let cut = &halves[0][..halves[0].len() - 37];
    for (name, bytes, images, is_whole) in [
        ("two", halves[..2].concat(), 240, true),
        ("three", halves.concat(), 360, true),
        ("gzipped", [gzipped(&halves[0]), gzipped(&halves[1])].concat(), 240, true),
        ("one gzip", gzipped(&halves[..2].concat()), 240, true),
        ("an index between", [&indexed[..], &halves[0], &indexed, &halves[1]].concat(), 240, true),
        ("cut", [cut, &halves[1]].concat(), 239, false),
        ("cut twice", [cut, cut, &halves[1]].concat(), 358, false),
    ] {
        fs::write(&file, bytes).expect("a file");
        let (report, code, stderr) = replay(&file, &[]);
        assert_eq!(code, Some(i32::from(!is_whole)), "{name}: {stderr}");
        let counted = &report["messages"]["vision"]["messages"];
        // Of the cut file the last message is the referee's or vision's.
        assert!(counted.as_u64().is_some_and(|n| n + 2 >= images && n <= images), "{name}: {counted}");
        assert!(report["joined"].as_u64().is_some_and(|joined| joined > 0), "{name}: {report}");
        assert!(report["span_s"].as_f64().is_some_and(|span| span < 1000.0), "{name}");
        assert_eq!(report["messages"].as_object().map(serde_json::Map::len), Some(2), "{name}");
        assert!(is_whole || stderr.contains("where another log file begins"), "{name}: {stderr}");
    }
}

#[test]
fn a_recorder_s_clock_that_jumps_is_not_time_that_was_played() {
    let directory = directory("clock");
    let file = directory.join("clock.log");
    #[expect(clippy::type_complexity, reason = "one table of a test")]
    let stamps: [(&str, fn(u32, f64) -> i64); 5] = [
        ("from 1970", |n, t| if n < 3 { 0 } else { right(n, t) }),
        ("an hour on", |n, t| right(n, t) + if n < 40 { 0 } else { 3_600_000_000_000 }),
        ("a day on", |n, t| right(n, t) + if n < 41 { 0 } else { 86_400_000_000_000 }),
        ("ten seconds on, twice", |n, t| right(n, t) + i64::from(n / 50) * 10_000_000_000),
        (
            "no clock at all until the end",
            |n, t| if n < 100 { i64::from(n) * 16_666_667 } else { right(n, t) },
        ),
    ];
    for (name, stamp) in stamps {
        fs::write(&file, log(9000, START, stamp)).expect("a file");
        let (report, code, stderr) = replay(&file, &[]);
        assert_eq!(code, Some(0), "{name}: {stderr}");
        let span = report["span_s"].as_f64().expect("a number");
        assert!((1.8..2.2).contains(&span), "{name}: {span} s");
        let began = report["began_unix_s"].as_f64().expect("a number");
        assert!(began > 1.78e9, "{name}: it began at {began}");
        let (moment, code, stderr) = replay(&file, &["--at", "1.5"]);
        assert_eq!(code, Some(0), "{name}: {stderr}");
        let x = moment["ball"]["x"].as_f64().or(moment["ball"]["position"][0].as_f64());
        assert!(x.is_none_or(|x| (1.3..1.6).contains(&x)), "{name}: {moment}");
    }
}

#[test]
fn vision_of_until_2014_is_tracked_on_its_flat_field() {
    let directory = directory("legacy");
    let file = directory.join("2013.log");
    let flat = legacy::GeometryFieldSize {
        line_width: 10,
        field_length: 6050,
        field_width: 4050,
        boundary_width: 250,
        referee_width: 425,
        goal_width: 700,
        goal_depth: 180,
        center_circle_radius: 500,
        defense_radius: 800,
        defense_stretch: 350,
        ..legacy::GeometryFieldSize::default()
    };
    for kind in [MessageKind::Vision2010, MessageKind::Unknown] {
        let mut writer = LogWriter::create(&file).expect("a file");
        for number in 0..120 {
            let t = 1.38e9 + f64::from(number) / 60.0;
            let geometry = legacy::GeometryData { field: flat, calib: vec![] };
            let geometry = (number % 60 == 0).then_some(geometry);
            let packet = legacy::WrapperPacket { detection: Some(frame(number, t)), geometry };
            writer.write((t * 1e9) as i64, kind, &packet.encode_to_vec()).expect("a file");
        }
        writer.close().expect("a file");
        let (report, code, stderr) = replay(&file, &[]);
        assert_eq!(code, Some(0), "{kind}: {stderr}");
        assert_eq!(report["field"]["length"], 6.05, "{kind}");
        assert_eq!((&report["robots"]["blue"][0], &report["robots"]["yellow"][0]), (&2.into(), &1.into()));
        assert!(report["ball_speed_max"].as_f64().is_some_and(|speed| (0.9..1.2).contains(&speed)), "{kind}");
    }
}

#[test]
fn what_was_counted_and_is_of_no_use_fails_with_its_reason() {
    let directory = directory("unused");
    let file = directory.join("match.log");
    let whole = log(9000, START, right);
    let strange = |kind: MessageKind, payload: &[u8]| {
        let mut writer = LogWriter::new(Vec::new()).expect("memory");
        (0..5).for_each(|n| writer.write(n, kind, payload).expect("memory"));
        writer.finish().expect("memory")
    };
    for (name, bytes, said) in [
        (
            "a kind of another program",
            [&whole[..], &strange(MessageKind::Other(77), b"x")].concat(),
            "5 messages",
        ),
        (
            "vision that is none",
            [&whole[..], &strange(MessageKind::Vision2014, &[0xff; 9])].concat(),
            "5 messages",
        ),
        ("unknown that is nothing", strange(MessageKind::Unknown, b"hello"), "5 messages"),
        ("a field of no size", log(1, START, right), "geometries"),
    ] {
        fs::write(&file, bytes).expect("a file");
        let (report, code, stderr) = replay(&file, &[]);
        assert_eq!(code, Some(1), "{name}: {report}");
        assert!(stderr.contains(said), "{name}: {stderr}");
    }
    // Several fields are told, the last one counts, and all of it is of use.
    fs::write(&file, [log(9000, START, right), log(12_000, START + 60.0, right)].concat()).expect("a file");
    let (report, code, stderr) = replay(&file, &[]);
    assert_eq!((code, &report["field"]["length"]), (Some(0), &12.0.into()), "{stderr}");
    assert_eq!(report["other_fields"][0]["before"], "9.000 x 6.000 m", "{report}");
}

#[test]
fn no_output_replaces_an_input_a_key_or_a_file_of_another_kind() {
    let directory = directory("outputs");
    let at = |name: &str| directory.join(name);
    let put = |name: &str, text: &str| fs::write(at(name), text).expect("a file");
    put("team.key", "000102030405060708090a0b0c0d0e0f\n");
    put("team.toml", "keeper = 2\n");
    put("thesis.tex", "\\documentclass{article}\n");
    put("drives.csv", "distance_m,counts\n1,24000\n");
    put(
        "problems.jsonl",
        "{\"ball\":[-600,10],\"defending\":\"yellow\",\"teammates\":{\"1\":[-700,0]},\"opponents\":[]}\n",
    );
    fs::hard_link(at("problems.jsonl"), at("hard.csv")).expect("a link");
    let names = ["team.key", "team.toml", "thesis.tex", "drives.csv", "problems.jsonl"].map(&at);
    let before = names.each_ref().map(|name| fs::read(name).expect("a file"));
    let [key, settings, thesis, drives, problems] = names.each_ref().map(|name| text(name));
    let (hard, figure) = (at("hard.csv"), at("figure.svg"));
    let provision = ["firmware", "provision", "--robot", "1", "--team", "1", "--key-file", key, "--out"];
    let coverage = ["cases", "coverage", "--problems", "100", "--out"];
    let survey = ["cases", "coverage", "--from", problems, "--out", text(&hard)];
    let trial = ["trial", "--record", text(&figure), "--svg", text(&figure)];
    let render = ["cases", "render", "center/close-in", "--out"];
    let mut commands: Vec<Vec<&str>> = vec![survey.to_vec(), trial.to_vec()];
    for file in [key, settings, thesis, drives] {
        commands.push([&provision[..], &[file]].concat());
        commands.push(vec!["cases", "evidence", problems, "--out", file]);
        commands.push(vec!["trial", "--record", file]);
        commands.push(vec!["trial", "--svg", file]);
        commands.push([&render[..], &[file]].concat());
    }
    commands.push([&coverage[..], &[key]].concat());
    commands.push(vec!["cases", "evidence", problems, "--out", problems]);
    commands.push(vec![
        "control",
        "--robots",
        "sim://127.0.0.1",
        "--headless",
        "--duration",
        "0.1",
        "--learned",
        key,
    ]);
    for command in commands {
        let out = onetwo(&command);
        assert_ne!(out.status.code(), Some(0), "{command:?}");
        assert!(!out.stderr.is_empty(), "{command:?}");
        for (name, before) in names.iter().zip(&before) {
            assert_eq!(&fs::read(name).expect("it is there"), before, "{command:?}: {}", name.display());
        }
    }
    // A page, and the same page again.
    let page = at("robot.page");
    for _ in 0..2 {
        let out = onetwo(&[&provision[..], &[text(&page)]].concat());
        assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
        assert_eq!(fs::read(&page).expect("a page").len(), 64);
    }
}

#[cfg(unix)]
#[test]
fn a_calibrated_description_stays_behind_its_link_with_its_mode() {
    use std::os::unix::fs::PermissionsExt as _;

    let directory = directory("link");
    let (real, link) = (directory.join("real.toml"), directory.join("mine.toml"));
    let shown = onetwo(&["robot", "show", "ours", "--text"]);
    fs::write(&real, shown.stdout).expect("a file");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("a mode");
    std::os::unix::fs::symlink("real.toml", &link).expect("a link");
    let drives = directory.join("drives.csv");
    fs::write(&drives, "distance_m,counts\n1,24500\n2,49000\n").expect("a file");
    let out = onetwo(&["robot", "calibrate", text(&link), "--drive", text(&drives)]);
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    assert!(fs::symlink_metadata(&link).expect("a link").is_symlink());
    assert!(fs::read_to_string(&real).expect("a file").contains("# Fitted to 2 drives"));
    assert_eq!(fs::metadata(&real).expect("a file").permissions().mode() & 0o777, 0o640);
}

#[test]
fn a_library_is_read_with_other_files_and_endings_in_it_or_with_no_case_at_all() {
    let directory = directory("library");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../casebase/library/cases/four-legged");
    let library = directory.join("four-legged");
    fs::create_dir_all(library.join("center")).expect("a folder");
    let league = fs::read_to_string(source.join("league.toml")).expect("the league");
    let case = fs::read_to_string(source.join("center/close-in.toml")).expect("a case");
    fs::write(library.join("league.toml"), &league).expect("a file");
    let listed = |count: usize| {
        let out = onetwo(&["cases", "list", "--library", text(&library), "--json"]);
        assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
        let text = String::from_utf8_lossy(&out.stdout).into_owned();
        assert_eq!(text.matches("center/").count(), 4 * count, "{text}");
    };
    // No case: each answers, or says so.
    for (verb, code) in [
        (&["cases", "stats", "--problems", "200"][..], 0),
        (&["cases", "coverage", "--problems", "200"], 0),
        (&["cases", "check"], 0),
        (&["cases", "list"], 0),
        (&["cases", "render", "--all", "--out", text(&directory)], 1),
        (&["cases", "render", "--sheet", text(&directory.join("sheet.svg"))], 1),
    ] {
        let out = onetwo(&[verb, &["--library", text(&library)]].concat());
        let stderr = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(code), "{verb:?}: {stderr}");
        assert!(code == 0 || stderr.contains("holds no case"), "{verb:?}: {stderr}");
    }
    assert!(!directory.join("sheet.svg").exists());
    fs::write(library.join("center/CLOSE-IN.TOML"), &case).expect("a file");
    listed(1);
    fs::write(library.join("center/marked.toml"), format!("\u{feff}{case}")).expect("a file");
    listed(2);
    // What editors and other systems leave beside them.
    for name in ["._marked.toml", ".marked.toml.swp", "#marked.toml#", "marked.toml~", ".DS_Store"] {
        fs::write(library.join("center").join(name), b"\0\x05\x16\x07 not a case").expect("a file");
    }
    fs::create_dir_all(library.join(".git/refs/deep")).expect("a folder");
    fs::write(library.join(".git/refs/deep/one.toml"), "no case").expect("a file");
    #[cfg(unix)]
    std::os::unix::fs::symlink("me@host.1:1", library.join("center/.#marked.toml")).expect("a link");
    listed(2);
}
