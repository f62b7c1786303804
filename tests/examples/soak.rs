//! `soak`: plays the targets of `match_tests::soak` in turn for a while, and goes on where it stopped.
//! `cargo xtask soak --hours N [--dir DIR] [--jobs J] [--only NAME] | --repeat NAME:RECIPE`
//!
//! `DIR` (`out/soak`) keeps progress and corpus of every target, and a file for each finding, with the line
//! that repeats it. Exit code 1 where there is a finding.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use match_tests::soak::state::{Progress, keep, recipe};
use match_tests::soak::{Material, TARGETS, Target, catch_panics};

fn main() -> ExitCode {
    let Some(asked) = Asked::read(std::env::args().skip(1)) else {
        eprintln!(
            "usage: cargo xtask soak --hours N [--dir DIR] [--jobs J] [--only NAME] | --repeat NAME:SEED,SEED..."
        );
        return ExitCode::from(2);
    };
    match soak(&asked) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(findings) => {
            println!(
                "{findings} findings, each with the line that repeats it: {}",
                asked.directory.join("findings").display()
            );
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("soak: {error}");
            ExitCode::FAILURE
        }
    }
}

struct Asked {
    hours: f64,
    directory: PathBuf,
    jobs: usize,
    targets: Vec<Target>,
    repeat: Option<(&'static Target, Vec<u64>)>,
}

impl Asked {
    fn read(mut arguments: impl Iterator<Item = String>) -> Option<Self> {
        let jobs = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let mut asked =
            Self { hours: 0.0, directory: "out/soak".into(), jobs, targets: TARGETS.to_vec(), repeat: None };
        while let Some(flag) = arguments.next() {
            let value = arguments.next()?;
            match flag.as_str() {
                "--hours" => {
                    asked.hours = value.parse().ok().filter(|hours| (0.0..10_000.0).contains(hours))?;
                }
                "--dir" => asked.directory = value.into(),
                "--jobs" => asked.jobs = value.parse().ok().filter(|jobs| (1..=1024).contains(jobs))?,
                "--only" => asked.targets = vec![*Target::named(&value)?],
                "--repeat" => {
                    let (name, seeds) = value.split_once(':')?;
                    asked.repeat = Some((Target::named(name)?, recipe(seeds)?));
                }
                _ => return None,
            }
        }
        (asked.hours > 0.0 || asked.repeat.is_some()).then_some(asked)
    }
}

/// Plays until the time is up; returns the number of findings that the directory has.
fn soak(asked: &Asked) -> Result<u64, Box<dyn std::error::Error>> {
    let material = Material::gather()?;
    if let Some((target, recipe)) = &asked.repeat {
        let (labels, result) = target.play(&material, recipe);
        println!("{}: {} labels, {result:?}", target.name, labels.len());
        return Ok(u64::from(result.is_err()));
    }
    catch_panics();
    let until = Instant::now() + Duration::from_secs_f64(asked.hours * 3600.0);
    let slice = SLICE.min(Duration::from_secs_f64(asked.hours * 3600.0 / asked.targets.len() as f64));
    let mut all = Vec::new();
    for target in &asked.targets {
        all.push((target, Mutex::new(Progress::read(&asked.directory, target)?)));
    }
    while Instant::now() < until {
        for (target, progress) in &mut all {
            played(asked, &material, (target, progress), Instant::now() + slice)?;
        }
    }
    let mut findings = 0;
    println!(
        "{:8} {:>12} {:12} {:>9} {:>7} {:>8}",
        "target", "executions", "of", "a second", "labels", "findings"
    );
    for (target, progress) in all {
        let of = progress.into_inner().unwrap_or_default();
        let rate = of.executions as f64 / of.seconds.max(1e-3);
        println!(
            "{:8} {:12} {:12} {rate:9.1} {:7} {:8}",
            target.name,
            of.executions,
            target.unit,
            of.corpus.len(),
            of.findings
        );
        findings += of.findings;
    }
    println!("a second of one thread; progress and corpora: {}", asked.directory.display());
    Ok(findings)
}

/// Plays a target on all threads until then, and writes its progress.
fn played(
    asked: &Asked,
    material: &Material,
    (target, progress): (&Target, &mut Mutex<Progress>),
    until: Instant,
) -> std::io::Result<()> {
    std::thread::scope(|scope| {
        for _ in 0..asked.jobs {
            scope.spawn(
                || {
                    while Instant::now() < until && one(asked, material, target, progress).is_some() {}
                },
            );
        }
    });
    progress
        .get_mut()
        .map_err(|_| std::io::Error::other("a thread has ended"))?
        .write(&asked.directory, target)
}

/// Plays the next recipe. `None`: another thread has panicked outside a target.
fn one(asked: &Asked, material: &Material, target: &Target, progress: &Mutex<Progress>) -> Option<()> {
    let recipe = {
        let mut progress = progress.lock().ok()?;
        progress.next += 1;
        progress.recipe(progress.next - 1)
    };
    let begin = Instant::now();
    let (labels, result) = target.play(material, &recipe);
    let mut progress = progress.lock().ok()?;
    progress.seconds += begin.elapsed().as_secs_f64();
    progress.add(&recipe, labels);
    match result {
        Ok(executions) => progress.executions += executions,
        Err(what) => {
            progress.findings += 1;
            let kept = keep(&asked.directory, target, &recipe, &what);
            println!("{}: {} ({kept:?})", target.name, what.lines().next().unwrap_or_default());
        }
    }
    Some(())
}

/// Time of a target before the next one's turn; what it played is written then.
const SLICE: Duration = Duration::from_secs(30);
