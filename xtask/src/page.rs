//! Does the page work in a real browser, what does it look like, and what does it cost? `cargo xtask test --only page`, `cargo xtask
//! screenshots` and `cargo xtask bench page`.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use crate::context::{Context, Failure, run};

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

/// The program itself.
fn built(context: &Context) -> Result<PathBuf, Failure> {
    run(&mut context.cargo("build --release --package onetwo"))?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| context.root().join("target"), PathBuf::from);
    Ok(target.join("release/onetwo"))
}

/// What a frame costs the page's script, and what viewers cost the match.
pub(crate) fn bench(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    tour(context, "frames")?;
    run(&mut context.cargo("build --release --package page --example viewers"))?;
    let alone = count(context, 0)?;
    let watched = count(context, 5)?;
    println!(
        "the match's thread takes {alone} instructions for {SECONDS} s without viewers and {watched} with five: {:+.3} %",
        (watched as f64 / alone as f64 - 1.0) * 100.0
    );
    let more = watched.saturating_sub(alone);
    if more as f64 > alone as f64 * SLACK {
        return Err(Failure::Budget(format!("five viewers cost the match {more} of {alone} instructions")));
    }
    Ok(())
}

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
