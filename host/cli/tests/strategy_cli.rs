//! `strategy_cli`: a team's own strategy in a program of its own, in real time and in the simulator: the
//! Python example of `onetwo-team`, with the built `onetwo`. Needs python3.
#![cfg(target_os = "linux")]

mod running;

use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use host::external::ANSWERS_WITHIN;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, Record, RecordKind};
use host::strategy::{OrderReason, Task};
use protocol::frame::TeamKey;
use running::controller::Controller;
use running::{PATIENCE, Running, free};
use ssl::referee::Command as Wire;

/// Images of both cameras within 20 ms, at 75 Hz: with the 80 ms of silence the 100 ms that
/// docs/strategy-protocol.md promises.
const IMAGES_LATE: u32 = 4;

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../team/examples/python_team.py")
}

fn in_tmp(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// The example as a program of several lives, with its files in a directory. Answers of life N begin with N
/// blanks, so that a trace tells which life gave them; the life after `killed` was made takes half a second
/// to begin.
struct Mortal {
    directory: PathBuf,
}

impl Mortal {
    fn new(name: &str) -> Self {
        let directory = in_tmp(name);
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(&directory).expect("a directory");
        let script = format!(
            "cd {}\necho life >> lives\nn=$(wc -l < lives)\nrm killed 2>/dev/null && sleep 0.5\n\
             sh -c 'echo $$ > process; exec python3 {}' | sed -u \"s/^/$(printf \"%${{n}}s\" '')/\" | tee -a answers\n",
            directory.display(),
            example().display()
        );
        fs::write(directory.join("program.sh"), script).expect("a file");
        Self { directory }
    }

    fn command(&self) -> String {
        format!("sh {}", self.directory.join("program.sh").display())
    }

    /// Waits until a life after that one has given a hundred answers; returns that life's number.
    fn answering(&self, after: usize) -> usize {
        let until = Instant::now() + PATIENCE;
        loop {
            let answers = fs::read_to_string(self.directory.join("answers")).unwrap_or_default();
            let lives: Vec<_> = answers.lines().map(life).filter(|life| *life > after).collect();
            let newest = lives.iter().max().copied().unwrap_or(0);
            if lives.iter().filter(|life| **life == newest).count() > 100 {
                return newest;
            }
            assert!(Instant::now() < until, "{} answers: is python3 installed?", lives.len());
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Kills the life that runs.
    fn kill(&self) {
        fs::write(self.directory.join("killed"), "").expect("a file");
        let process = fs::read_to_string(self.directory.join("process")).expect("it was started");
        let killed = Command::new("kill").args(["-9", process.trim()]).status().expect("kill");
        assert!(killed.success(), "it ran");
    }
}

/// The life that gave an answer.
fn life(answer: &str) -> usize {
    answer.len() - answer.trim_start().len()
}

/// The records of a trace, with its header.
fn records(trace: &Path) -> (RecordingHeader, Vec<Record>) {
    let file = BufReader::new(foreign::open(trace).expect("a trace"));
    let reader = Reader::new(flate2::bufread::MultiGzDecoder::new(file)).expect("its header");
    let header = RecordingHeader::from_json(reader.header()).expect("a header");
    (header, reader.collect())
}

#[test]
fn robots_of_a_killed_strategy_stand_within_a_tenth_of_a_second_and_it_comes_back() {
    let (vision, referee) = (free(), free());
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--headless", "--referee", "none"];
    let mut simulator = Running::start(&[&simulate[..], &["--vision", &vision]].concat());
    let robots = format!("sim://127.0.0.1:{}", simulator.control_port());
    let (program, stem) = (Mortal::new("mortal-strategy"), in_tmp("strategy"));
    let control = ["control", "--headless", "--robots", &robots, "--vision", &vision, "--referee", &referee];
    let more =
        ["--tracker", &free(), "--strategy", &program.command(), "--record", &stem.display().to_string()];
    let mut control = Running::start(&[&control[..], &more[..]].concat());
    let controller = Controller::new(&referee);
    control.wait_for("robots are received");
    controller.send(|packet| packet.command = Wire::Stop as i32);
    controller.send(|packet| packet.command = Wire::ForceStart as i32);
    let killed = program.answering(0);
    program.kill();
    program.answering(killed);
    control.interrupt();
    control.wait_for("strategy  started again");
    control.wait_for("robots halted");

    let (header, records) = records(&stem.with_extension("trace"));
    let life = |record: &&Record| life(&String::from_utf8_lossy(&record.bytes));
    let answers: Vec<_> = records.iter().filter(|record| record.kind == RecordKind::Orders).collect();
    let last = answers.iter().rposition(|record| life(record) <= killed).expect("answers before");
    let gap = [last, last + 1].map(|index| answers.get(index).expect("answers before and after").at);
    let silence = gap[1].since(gap[0]).0;
    eprintln!("{} answers; the program was gone for {} ms", answers.len(), silence / 1_000);
    assert!(silence > 200_000, "{silence} µs");
    // The host decides again from the trace: what did it order, and when?
    let mut again = Recheck::new(&header, TeamKey::ZERO).expect("a host");
    let (mut stood, mut images, mut came_back) = (None, 0, false);
    for record in &records {
        again.feed(record);
        let silent = record.at > gap[0] && record.at.since(gap[0]) >= ANSWERS_WITHIN;
        images += u32::from(silent && stood.is_none() && record.kind == RecordKind::Vision);
        let Some(host) = again.host(0) else { continue };
        let external = |reason: &OrderReason| host.orders().iter().any(|order| order.why == *reason);
        if record.at > gap[0] && record.at < gap[1] && external(&OrderReason::ExternalSilent) {
            assert!(host.orders().iter().all(|order| order.task == Task::Stand), "{:?}", host.orders());
            stood = stood.or(Some(record.at));
        }
        came_back |= record.at > gap[1] && external(&OrderReason::External);
    }
    let after = stood.expect("robots stand").since(gap[0]).0;
    eprintln!(
        "robots were ordered to stand {} ms after the last answer, {images} images late",
        after / 1_000
    );
    // Counted in images: a loaded machine may wake the host late. One of each camera comes within 14 ms.
    assert!(images <= IMAGES_LATE, "{images} images came before robots stood");
    assert!(came_back, "its orders are followed again");
    again.finish(false);
    assert!(again.results().all(|(_, difference)| difference.is_none()), "a replay decides alike");
}

#[test]
fn the_python_team_plays_in_the_simulator_and_its_match_replays() {
    let stem = in_tmp("python-team");
    let strategy = format!("cmd:python3 {}", example().display());
    let play = ["play", "--headless", "--seed", "2", "--duration", "60", "--yellow", "idle"];
    let out = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(play)
        .args(["--json", "--blue-strategy", &strategy, "--record", &stem.display().to_string()])
        .output()
        .expect("it plays");
    let (stdout, stderr) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
    assert!(out.status.success(), "{stderr}");
    assert!(!stderr.contains("Traceback"), "{stderr}");
    let played: serde_json::Value = serde_json::from_str(&stdout).expect("JSON");
    // Whether the match has a shot depends on its seed; that the team plays the ball does not.
    let possessed_s = played["metrics"]["blue"]["attack"]["possessed_s"].as_f64();
    assert!(possessed_s.is_some_and(|seconds| seconds > 5.0), "{stdout}");
    let trace = stem.with_extension("trace");
    let (_, records) = records(&trace);
    assert!(records.iter().filter(|record| record.kind == RecordKind::Orders).count() > 100);
    let out = Command::new(env!("CARGO_BIN_EXE_onetwo")).arg("replay").arg("--check").arg(&trace).output();
    let out = out.expect("it replays");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stdout));
}

#[test]
fn a_team_named_strategy_needs_its_command() {
    let out = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["evaluate", "matches", "--team", "strategy", "--opponents", "idle", "--matches", "1"])
        .args(["--out", &in_tmp("no-strategy").display().to_string()])
        .output()
        .expect("it starts");
    assert!(!out.status.success());
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert!(stderr.contains("--strategy COMMAND"), "{stderr}");
}
