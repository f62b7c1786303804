//! `release`: archives and Debian packages of the program for machines without a toolchain: a static program,
//! the robots' images, manual pages, completions, README, licences and the examples in Python.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_build::Program;

use crate::context::{Context, Failure, run};

/// Builds archives and packages of the named targets, or of all of them, into `target/release-archives`.
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
    for example in EXAMPLES {
        put(&context.root().join(example), &directory.join("share/doc/onetwo/examples"))?;
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
    package(out, &name, target)?;
    run(Command::new("sh").current_dir(out).args(["-c", &format!("sha256sum {packed} > {packed}.sha256")]))
}

/// A Debian package of the archive's directory `name` of `out`, beside it, with its checksum.
fn package(out: &Path, name: &str, target: &str) -> Result<(), Failure> {
    let architecture = if target.starts_with("aarch64") { "arm64" } else { "amd64" };
    let mut script = Command::new("sh");
    script.current_dir(out).args(["-ec", PACKAGE, "sh", name, env!("CARGO_PKG_VERSION"), architecture]);
    run(&mut script)
}

fn context_files(root: &Path) -> [PathBuf; 4] {
    ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"].map(|name| root.join(name))
}

fn fresh(directory: &Path) -> Result<(), Failure> {
    let emptied = match fs::remove_dir_all(directory) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => fs::create_dir_all(directory),
    };
    emptied.map_err(|error| Failure::at(directory, error))
}

fn put(file: &Path, directory: &Path) -> Result<(), Failure> {
    let name = file.file_name().unwrap_or_default();
    fs::create_dir_all(directory)
        .and_then(|()| fs::copy(file, directory.join(name)))
        .map(drop)
        .map_err(|error| Failure::at(file, error))
}

/// Static programs, which run on any Linux.
const TARGETS: [&str; 2] = ["x86_64-unknown-linux-musl", "aarch64-unknown-linux-musl"];
/// Examples that need no toolchain.
const EXAMPLES: [&str; 2] = ["host/team/examples/python_team.py", "host/team/examples/velocities.py"];
/// The archive's directory, version and architecture as a package: where Debian has completions and manuals,
/// owned by root, without times.
const PACKAGE: &str = r#"
rm -rf debian; mkdir -p debian/DEBIAN; cp -r "$1" debian/usr
cd debian/usr/share
for shell in onetwo.bash:bash-completion/completions/onetwo _onetwo:zsh/vendor-completions/_onetwo \
    onetwo.fish:fish/vendor_completions.d/onetwo.fish; do
    install -D -m 644 "completions/${shell%%:*}" "${shell#*:}"
done
rm -r completions
gzip -9n man/man1/*
cat doc/onetwo/LICENSE-MIT doc/onetwo/LICENSE-APACHE > doc/onetwo/copyright
cd ../../..
cat > debian/DEBIAN/control <<END
Package: onetwo
Version: $2
Architecture: $3
Maintainer: the onetwo authors <onetwo@invalid>
Installed-Size: $(du -sk debian/usr | cut -f1)
Section: science
Priority: optional
Suggests: python3, qemu-system-arm
Description: case-based robot soccer of the Small Size League
 Simulator, team, live page and tools in one static program.
END
SOURCE_DATE_EPOCH=0 dpkg-deb --root-owner-group --build debian "onetwo_$2_$3.deb"
sha256sum "onetwo_$2_$3.deb" > "onetwo_$2_$3.deb.sha256"
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_package_has_program_manuals_and_completions_where_debian_has_them() {
        let out = std::env::temp_dir().join(format!("onetwo-package-{}", std::process::id()));
        let share = out.join("onetwo-0-x/share");
        for (directory, names) in [
            ("../bin", &["onetwo"][..]),
            ("completions", &["onetwo.bash", "_onetwo", "onetwo.fish"]),
            ("man/man1", &["onetwo.1"]),
            ("doc/onetwo", &["LICENSE-MIT", "LICENSE-APACHE"]),
        ] {
            fs::create_dir_all(share.join(directory)).unwrap();
            for name in names {
                fs::write(share.join(directory).join(name), name).unwrap();
            }
        }
        package(&out, "onetwo-0-x", "aarch64-unknown-linux-musl").unwrap();
        let deb = format!("onetwo_{}_arm64.deb", env!("CARGO_PKG_VERSION"));
        let listed = Command::new("dpkg-deb").arg("-c").arg(out.join(deb)).output().unwrap();
        let listed = String::from_utf8(listed.stdout).unwrap();
        for path in [
            "root/root",
            "./usr/bin/onetwo",
            "./usr/share/man/man1/onetwo.1.gz",
            "./usr/share/bash-completion/completions/onetwo",
            "./usr/share/zsh/vendor-completions/_onetwo",
            "./usr/share/doc/onetwo/copyright",
        ] {
            assert!(listed.contains(path), "{path} in {listed}");
        }
        fs::remove_dir_all(&out).unwrap();
    }
}
