//! Does the page work in a real browser, what does it look like, and what does it cost? `cargo xtask test --only page`, `cargo xtask
//! screenshots` and `cargo xtask bench page`.

use std::io::{self, BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use crate::context::{Context, Failure, run};
use crate::cost::between;

/// What holds when the step passes.
pub(crate) const WHAT: &str = "the page works in a real browser";

/// Where systems have it; as in the crate that drives it.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// The tests in the browser, one after the other: each has a match and a browser of its own.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    run(&mut context
        .cargo("test --package onetwo --features browser --test page_browser -- --test-threads 1"))
}

/// Takes the documentation's pictures anew.
pub(crate) fn pictures(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    tour(context, "pictures docs/page")
}

fn tour(context: &Context, words: &str) -> Result<(), Failure> {
    let program = built(context)?;
    let mut tour = context.cargo("run --release --package page-browser --example tour --");
    run(tour.arg(program).args(words.split_whitespace()))
}

/// What the tour says of frames: how often an empty frame's cost a full one's is, and after a colon the times of this machine.
fn frames(context: &Context) -> Result<String, Failure> {
    let program = built(context)?;
    let mut tour = context.cargo("run --release --package page-browser --example tour --");
    tour.arg(program).arg("frames").stderr(Stdio::inherit());
    let failed = |error| Failure::Start { line: "tour frames".to_owned(), error };
    let out = tour.output().map_err(failed)?;
    let said = String::from_utf8_lossy(&out.stdout).trim().to_owned();
    if out.status.success() && !said.is_empty() { Ok(said) } else { Err(failed(io::Error::other(said))) }
}

/// The program itself.
fn built(context: &Context) -> Result<PathBuf, Failure> {
    run(&mut context.cargo("build --release --package onetwo"))?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| context.root().join("target"), PathBuf::from);
    Ok(target.join("release/onetwo"))
}

/// What a frame costs the page's script, and what viewers cost the match; with `write` both go into host/page/README.md.
pub(crate) fn bench(context: &Context, write: bool) -> Result<(), Failure> {
    ensure_browser()?;
    let frame = frames(context)?;
    println!("{frame}");
    run(&mut context.cargo("build --release --package page --example viewers"))?;
    let alone = count(context, 0)?;
    let watched = count(context, 5)?;
    let viewers = format!(
        "the match's thread takes {:.1} M instructions for {SECONDS} s of match without viewers and {:+.3} % with five",
        alone as f64 * 1e-6,
        (watched as f64 / alone as f64 - 1.0) * 100.0
    );
    println!("{viewers}");
    if write {
        let file = context.root().join("host/page/README.md");
        let start = |error| Failure::Start { line: file.display().to_string(), error };
        let text = fs::read_to_string(&file).map_err(start)?;
        // Times are this machine's: the ratio alone is kept.
        let ratio = frame.split(':').next().unwrap_or(&frame);
        let list = format!("\n- {ratio};\n- {viewers}.\n\n");
        fs::write(&file, between(&text, MARKS, &list)).map_err(start)?;
    }
    let more = watched.saturating_sub(alone);
    if more as f64 > alone as f64 * SLACK {
        return Err(Failure::Budget(format!("five viewers cost the match {more} of {alone} instructions")));
    }
    Ok(())
}

/// Around the figures in the page's README.
const MARKS: (&str, &str) = ("<!-- page figures -->", "<!-- end of page figures -->");
/// Simulated seconds that are counted.
const SECONDS: u32 = 4;
/// How much two runs may differ: sleeping, and when the clock is looked at.
const SLACK: f64 = 0.005;

/// Instructions of the match's own thread with so many viewers: one reads, one never does, one vanishes, …
fn count(context: &Context, viewers: u32) -> Result<u64, Failure> {
    let program = built(context)?;
    let folder = program.with_file_name(format!("page-{viewers}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder)
        .map_err(|error| Failure::Start { line: folder.display().to_string(), error })?;
    let out = folder.join("out");
    let line = format!("valgrind {} play", program.display());
    let failed = |error| Failure::Start { line: line.clone(), error };
    let mut child = Command::new("valgrind")
        .args(["--tool=callgrind", "--separate-threads=yes"])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(&program)
        .args(["play", "--seed", "1", "--speed", "20", "--listen", "127.0.0.1:0", "--duration"])
        .arg(SECONDS.to_string())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let mut looking = None;
    let lines =
        BufReader::new(child.stderr.take().into_iter().next().ok_or_else(|| failed(silent()))?).lines();
    for line in lines.map_while(Result::ok) {
        if let Some(address) = line.strip_prefix("page     http://")
            && viewers > 0
        {
            let mut viewing = Command::new(program.with_file_name("examples/viewers"));
            looking = Some(viewing.args([address, &viewers.to_string(), "600"]).spawn().map_err(failed)?);
        }
        if line.starts_with("the match is over") {
            break;
        }
    }
    thread::sleep(Duration::from_millis(500));
    let id = child.id().to_string();
    run(Command::new("kill").args(["-INT", &id]))?;
    let _ = child.wait();
    if let Some(mut looking) = looking {
        let _ = looking.kill();
        let _ = looking.wait();
    }
    let main = fs::read_to_string(folder.join("out-01")).map_err(failed)?;
    let totals = main.lines().find_map(|line| line.strip_prefix("totals: "));
    totals.and_then(|words| words.trim().parse().ok()).ok_or_else(|| failed(silent()))
}

fn silent() -> std::io::Error {
    std::io::Error::other("valgrind tells nothing; is it installed?")
}

/// A browser, installed first where that can be done.
fn ensure_browser() -> Result<(), Failure> {
    let there = |name: &str| {
        let mut question = Command::new(name);
        question.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        question.status().is_ok_and(|status| status.success())
    };
    let found = || env::var_os("ONETWO_BROWSER").is_some() || NAMES.iter().any(|name| there(name));
    if found() {
        return Ok(());
    }
    // Whether it helped is seen in the answer to the same question again.
    let _ = run(Command::new("apt-get").args(["install", "-y", "chromium"]));
    if found() { Ok(()) } else { Err(Failure::Browser) }
}
