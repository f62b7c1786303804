//! `wheels`: the Python package for machines without a compiler: manylinux wheels for x86-64 and aarch64,
//! this machine's tested in empty environments of the Pythons that are here.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::context::{Context, Failure, run};
use crate::python::{Environment, is_fit};

/// Builds the wheels of the named processors, or of all of them, into `target/wheels-manylinux`.
pub(crate) fn build(context: &Context, names: &[String]) -> Result<(), Failure> {
    let environment = Environment::ensure(context)?;
    run(environment.python(context).args(["-m", "pip", "install", "--quiet", ZIG]))?;
    let out = firmware_build::target_dir(context.root()).join("wheels-manylinux");
    for processor in PROCESSORS.into_iter().filter(|one| names.is_empty() || names.iter().any(|n| n == one)) {
        let target = format!("{processor}-unknown-linux-gnu");
        run(Command::new("rustup").current_dir(context.root()).args(["target", "add", &target]))?;
        let line =
            format!("-m maturin build --release --locked --zig --compatibility {GLIBC} --target {target}");
        for kind in [&[][..], &OLDEST] {
            let mut build = environment.python(context);
            build.args(line.split(' ')).args(kind);
            run(build.args(["--manifest-path", "host/python/Cargo.toml", "--out"]).arg(&out))?;
        }
    }
    let (mut tried, mut missing) = (Vec::new(), Vec::new());
    for version in VERSIONS {
        let python = format!("python3.{version}");
        if is_fit(Path::new(&python), version) {
            let tag = if version == *VERSIONS.start() { "-cp310-" } else { "-abi3-" };
            test(context, &python, &wheel_of(&out, tag, std::env::consts::ARCH)?)?;
            tried.push(python);
        } else {
            missing.push(python);
        }
    }
    println!("{}: {}; not here: {}", out.display(), tried.join(", "), missing.join(", "));
    Ok(())
}

/// Installs this machine's wheel in an empty environment, without compiler or other packages, and asks it.
fn test(context: &Context, python: &str, wheel: &Path) -> Result<(), Failure> {
    let directory = firmware_build::target_dir(context.root()).join("wheel-test");
    run(Command::new(python).args(["-m", "venv", "--clear"]).arg(&directory))?;
    let inside = directory.join("bin/python");
    run(Command::new(&inside)
        .args(["-m", "pip", "install", "--quiet", "--no-deps", "--no-index"])
        .arg(wheel))?;
    run(Command::new(inside).current_dir(&directory).args(["-c", QUESTION]))
}

/// The newest wheel with that tag for a processor.
fn wheel_of(wheels: &Path, tag: &str, processor: &str) -> Result<PathBuf, Failure> {
    let entries = fs::read_dir(wheels).map_err(|error| Failure::at(wheels, error))?;
    let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let end = format!("{processor}.whl");
    let files = files.filter(|file| {
        let name = file.to_string_lossy();
        name.ends_with(&end) && name.contains(tag)
    });
    let newest = files.max_by_key(|file| fs::metadata(file).and_then(|of| of.modified()).ok());
    newest.ok_or_else(|| {
        Failure::Documentation(format!("{}: no wheel {tag} for {processor}", wheels.display()))
    })
}

/// Processors that wheels are built for.
const PROCESSORS: [&str; 2] = ["x86_64", "aarch64"];
/// The C library that wheels need: glibc 2.17 of 2012, older than any that Rust's own programs run on.
const GLIBC: &str = "manylinux2014";
/// Linker for any processor and C library, as a package of Python.
const ZIG: &str = "ziglang==0.13.0";
/// Pythons 3.x, as far as PyO3 0.30 goes. One wheel serves all but the first, whose stable interface has no
/// buffers.
const VERSIONS: std::ops::RangeInclusive<u32> = 10..=15;
/// What builds the wheel of the first alone.
const OLDEST: [&str; 3] = ["--no-default-features", "--interpreter", "3.10"];
/// What a wheel is asked: a case, a period of the simulator with its picture, a copy.
const QUESTION: &str = "
import copy, onetwo
case = onetwo.retrieve({'ball': [-600, 10], 'defending': 'yellow', 'teammates': {1: [-700, 0], 3: [200, 800]}, 'opponents': []})
simulator = onetwo.Simulator(task='keep-away', seed=1)
other = copy.deepcopy(simulator)
assert simulator.step([0.1] * 15) == other.step([0.1] * 15) and simulator.trace_hash == other.trace_hash
assert case['case'] and len(simulator.pixels(96)[0]) == 3 * 96 * 66
import sys; print(sys.version.split()[0], onetwo.__version__, case['case'], simulator.trace_hash)
";
