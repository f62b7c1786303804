//! `release`: archives of the program for machines without a toolchain: a static program, the robots' images,
//! manual pages, completions, README and licences.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_build::Program;

use crate::context::{Context, Failure, run};

/// Builds the archives of the named targets, or of all of them, into `target/release-archives`.
pub(crate) fn build(context: &Context, names: &[String]) -> Result<(), Failure> {
    let chosen =
        TARGETS.into_iter().filter(|target| names.is_empty() || names.iter().any(|name| name == target));
    context.ensure_target()?;
    let out = firmware_build::target_dir(context.root()).join("release-archives");
    let pages = manuals(context, &out)?;
    let images: Vec<PathBuf> = Program::images()
        .into_iter()
        .chain([Program::Udp])
        .map(|program| firmware_build::build_program(context.root(), program).map_err(Failure::Image))
        .collect::<Result<_, _>>()?;
    for target in chosen {
        archive(context, target, &out, &pages, &images)?;
    }
    Ok(())
}

/// Manual pages and completions, written by the program itself.
fn manuals(context: &Context, out: &Path) -> Result<PathBuf, Failure> {
    let pages = out.join("manuals");
    fresh(&pages)?;
    let mut write = context.cargo("run --release -p onetwo --features manuals -- manuals");
    run(write.arg(&pages))?;
    Ok(pages)
}

/// One archive, and its checksum beside it.
fn archive(
    context: &Context,
    target: &str,
    out: &Path,
    pages: &Path,
    images: &[PathBuf],
) -> Result<(), Failure> {
    run(Command::new("rustup").current_dir(context.root()).args(["target", "add", target]))?;
    let mut build = context.cargo("build --release --locked --bin onetwo --target");
    // The toolchain's own linker and start files: no other compiler is needed for another processor.
    let flags = "-Clinker=rust-lld -Clink-self-contained=yes -Cstrip=symbols";
    let variable = target.to_uppercase().replace('-', "_");
    run(build.arg(target).env(format!("CARGO_TARGET_{variable}_RUSTFLAGS"), flags))?;
    let name = format!("onetwo-{}-{target}", env!("CARGO_PKG_VERSION"));
    let directory = out.join(&name);
    fresh(&directory)?;
    let built = firmware_build::target_dir(context.root()).join(target).join("release/onetwo");
    put(&built, &directory.join("bin"))?;
    for image in images {
        put(image, &directory.join(firmware_build::SHIPPED_IMAGES))?;
    }
    for page in context_files(context.root()) {
        put(&page, &directory.join("share/doc/onetwo"))?;
    }
    run(Command::new("cp")
        .arg("-r")
        .arg(pages.join("man"))
        .arg(pages.join("completions"))
        .arg(directory.join("share")))?;
    // Sorted, without owners and times: equal contents give equal bytes.
    let packed = format!("{name}.tar.gz");
    let mut tar = Command::new("tar");
    tar.current_dir(out).args([
        "--sort=name",
        "--owner=0",
        "--group=0",
        "--numeric-owner",
        "--mtime=@0",
        "-czf",
    ]);
    run(tar.arg(&packed).arg(&name))?;
    run(Command::new("sh").current_dir(out).args(["-c", &format!("sha256sum {packed} > {packed}.sha256")]))
}

fn context_files(root: &Path) -> [PathBuf; 4] {
    ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"].map(|name| root.join(name))
}

/// An empty directory.
fn fresh(directory: &Path) -> Result<(), Failure> {
    let emptied = match fs::remove_dir_all(directory) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => fs::create_dir_all(directory),
    };
    emptied.map_err(|error| Failure::at(directory, error))
}

/// Copies a file into a directory.
fn put(file: &Path, directory: &Path) -> Result<(), Failure> {
    let name = file.file_name().unwrap_or_default();
    fs::create_dir_all(directory)
        .and_then(|()| fs::copy(file, directory.join(name)))
        .map(drop)
        .map_err(|error| Failure::at(file, error))
}

/// Static programs, which run on any Linux.
const TARGETS: [&str; 2] = ["x86_64-unknown-linux-musl", "aarch64-unknown-linux-musl"];
