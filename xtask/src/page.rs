//! `page`: browser checks, screenshots and cost of the page. `cargo xtask test --only page`, `cargo xtask
//! screenshots` and `cargo xtask bench page`.

use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use crate::context::{Context, Failure, answers, run, run_tests};
use crate::cost::write_between;

/// The property checked by the step.
pub(crate) const WHAT: &str = "the page works in a real browser";

/// Names of the browser on various systems; as in the crate that drives it.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// The tests in the browser, one after the other: each has a match and a browser of its own.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    // The selection and features of the step `test`, so that nothing is built again.
    let line = "test --workspace --features onetwo/png --test page_browser -- --test-threads 1";
    run(&mut context.cargo(line))
}

/// The tests of the program, in a browser too, with what is held on an idle machine alone.
pub(crate) fn soak(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    let tests = "--test halt_cli --test net_cli --test page_browser -- --nocapture --test-threads 1";
    run_tests(
        context.cargo(&format!("test --workspace --features onetwo/png {tests}")).env("ONETWO_SOAK", "1"),
    )
}

/// Takes the documentation's screenshots again.
pub(crate) fn pictures(context: &Context) -> Result<(), Failure> {
    ensure_browser()?;
    tour(context, "pictures docs/page")
}

fn tour(context: &Context, description: &str) -> Result<(), Failure> {
    let program = built(context)?;
    let mut tour = context.cargo("run --release --package page-browser --example tour --");
    run(tour.arg(program).args(description.split_whitespace()))
}

/// Output of the tour about frames: the ratio of a full frame's cost to an empty one's, and after a colon the
/// times of this machine.
fn frames(context: &Context, program: &Path) -> Result<String, Failure> {
    let mut tour = context.cargo("run --release --package page-browser --example tour --");
    tour.arg(program).arg("frames").stderr(Stdio::inherit());
    let line = "tour frames".to_owned();
    let out = tour.output().map_err(|error| Failure::Start { line: line.clone(), error })?;
    let printed = String::from_utf8_lossy(&out.stdout).trim().to_owned();
    if out.status.success() && !printed.is_empty() {
        Ok(printed)
    } else {
        Err(Failure::Start { line, error: io::Error::other(printed) })
    }
}

fn built(context: &Context) -> Result<PathBuf, Failure> {
    run(&mut context.cargo("build --release --package onetwo"))?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| context.root().join("target"), PathBuf::from);
    Ok(target.join("release/onetwo"))
}

/// Cost of a frame in the page's script, and of viewers for the match; with `write` both are written into
/// host/page/README.md.
pub(crate) fn bench(context: &Context, write: bool) -> Result<(), Failure> {
    ensure_browser()?;
    let program = built(context)?;
    let frame = frames(context, &program)?;
    println!("{frame}");
    run(&mut context.cargo("build --release --package onetwo-page --example viewers"))?;
    let alone = count(&program, "")?;
    let watched = count(&program, READING_VIEWERS)?;
    let slow = count(&program, SLOW_VIEWERS)?;
    let more = |with: &Counted| with.instructions as f64 / alone.instructions as f64 - 1.0;
    let viewers = format!(
        "a tick of the match's thread (simulator, both hosts, the scenes shown) takes {:.0} k instructions without viewers, {:+.3} % with \
         five that read all they can ({} scenes taken) and {:+.3} % with five of which two are slow, two never read and one vanishes",
        alone.instructions as f64 / f64::from(SECONDS * TICKS_A_SECOND * 1000),
        more(&watched) * 100.0,
        watched.taken,
        more(&slow) * 100.0
    );
    println!("{viewers}");
    if write {
        // Times are this machine's: the ratio alone is kept.
        let ratio = frame.split(':').next().unwrap_or(&frame);
        let list = format!("\n- {ratio};\n- {viewers}.\n\n");
        write_between("host/page/README.md", "page figures", &list)?;
    }
    for (paths, with) in [(READING_VIEWERS, &watched), (SLOW_VIEWERS, &slow)] {
        if with.taken == 0 {
            return Err(Failure::Budget(format!("viewers {paths} took no scene: nothing was measured")));
        }
        if more(with) > COUNT_DIFFERENCE_MAX {
            let (with, alone) = (with.instructions, alone.instructions);
            return Err(Failure::Budget(format!(
                "with viewers {paths} the match takes {with}, alone {alone}"
            )));
        }
    }
    Ok(())
}

/// Simulated seconds that are counted.
const SECONDS: u32 = 4;
/// Ticks of brains and hosts in each.
const TICKS_A_SECOND: u32 = 100;
/// Permitted difference of two runs: sleeping, and times at which the clock is read.
const COUNT_DIFFERENCE_MAX: f64 = 0.005;
/// Five viewers, in the notation of the example of the same name.
const READING_VIEWERS: &str = "rrrrr";
const SLOW_VIEWERS: &str = "sdsdv";

struct Counted {
    /// Instructions of the match's own thread.
    instructions: u64,
    /// Number of scenes sent to viewers.
    taken: u64,
}

/// A match under callgrind with viewers of these kinds.
fn count(program: &Path, paths: &str) -> Result<Counted, Failure> {
    let directory = program.with_file_name(format!("page-{paths}"));
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).map_err(|error| Failure::at(&directory, error))?;
    let line = format!("valgrind {} play", program.display());
    let failed = |error| Failure::Start { line: line.clone(), error };
    let mut child = Command::new("valgrind")
        .args(["--tool=callgrind", "--separate-threads=yes"])
        .arg(format!("--callgrind-out-file={}", directory.join("out").display()))
        .arg(program)
        .args(["play", "--seed", "1", "--listen", "127.0.0.1:0", "--duration"])
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
            && !paths.is_empty()
        {
            let mut viewing = Command::new(program.with_file_name("examples/viewers"));
            let viewing = viewing.args([address, paths]).stdin(Stdio::null()).stdout(Stdio::piped());
            looking = Some(viewing.spawn().map_err(failed)?);
        }
        if line.starts_with("the match is over") {
            break;
        }
    }
    thread::sleep(Duration::from_millis(500));
    run(Command::new("kill").args(["-TERM", &child.id().to_string()]))?;
    let _ = child.wait();
    let mut taken = 0;
    if let Some(looking) = looking {
        // They end with the page.
        let printed = looking.wait_with_output().map_err(failed)?;
        taken = String::from_utf8_lossy(&printed.stdout).trim().parse().unwrap_or(0);
    }
    let main = fs::read_to_string(directory.join("out-01")).map_err(failed)?;
    let totals = main.lines().find_map(|line| line.strip_prefix("totals: "));
    let instructions =
        totals.and_then(|description| description.trim().parse().ok()).ok_or_else(|| failed(silent()))?;
    Ok(Counted { instructions, taken })
}

fn silent() -> std::io::Error {
    std::io::Error::other("valgrind prints nothing; is it installed?")
}

/// Finds a browser, installed first where that is possible.
fn ensure_browser() -> Result<(), Failure> {
    if has_browser() {
        return Ok(());
    }
    // The next check shows whether it helped.
    let _ = run(Command::new("apt-get").args(["install", "-y", "chromium"]));
    if has_browser() { Ok(()) } else { Err(Failure::Browser) }
}

fn has_browser() -> bool {
    env::var_os("ONETWO_BROWSER").is_some() || NAMES.iter().any(|name| answers(&mut Command::new(name)))
}
