//! `target`: compiler detection for the robot's processor.
//!
//! rustup's target where it is, or can be fetched. Where it cannot, `core` is compiled from its sources of
//! the same release; last comes the distribution's own compiler. Each method that fails leaves its reason,
//! and all reasons together are the error.

use std::env;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::process::{in_path, output_of, run_within};
use crate::{Install, TARGET, debian};

/// Finds a compiler for [`TARGET`], fetching what is missing as far as `install` allows.
pub fn ensure_target(root: &Path, install: Install) -> Result<ThumbToolchain, TargetError> {
    let compiler = Compiler::of(root).map_err(|why| TargetError::NoCompiler { why })?;
    let mut attempts = Vec::new();
    for (way, attempt) in WAYS {
        match attempt(&compiler, install) {
            Ok(toolchain) => return Ok(toolchain),
            Err(why) => attempts.push(Attempt { way, why }),
        }
    }
    Err(TargetError::NoWay { attempts })
}

/// Toolchain that compiles for the robot's processor on this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ThumbToolchain {
    /// The toolchain has `core` prebuilt for the target.
    Prebuilt,
    /// The toolchain compiles `core` from its sources first.
    FromSources,
    /// The distribution's compiler and sources, with a linker found elsewhere.
    Distribution {
        /// Path of an LLVM linker.
        linker: PathBuf,
    },
}

impl ThumbToolchain {
    /// `cargo`, in the workspace, with what this toolchain needs; add a verb, packages and a profile, then
    /// run it. Every build for the target has to start here: other flags would compile all of it again.
    pub fn cargo(&self, root: &Path, verb: &str) -> Command {
        let mut command = match self {
            Self::Prebuilt | Self::FromSources => Command::new(cargo_program()),
            Self::Distribution { .. } => Command::new("/usr/bin/cargo"),
        };
        command.current_dir(root).arg(verb).args(["--target", TARGET]);
        if *self != Self::Prebuilt {
            // Building `core` is an unstable feature, which the stable compiler must be allowed to use.
            command.env("RUSTC_BOOTSTRAP", "1").env("CARGO_UNSTABLE_BUILD_STD", "core,alloc");
        }
        if let Self::Distribution { linker } = self {
            let variable = format!("CARGO_TARGET_{}_LINKER", TARGET.to_uppercase().replace('-', "_"));
            command.env("RUSTC", "/usr/bin/rustc").env(variable, linker);
        }
        command
    }
}

impl fmt::Display for ThumbToolchain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prebuilt => write!(f, "the toolchain's own {TARGET}"),
            Self::FromSources => write!(f, "`core` for {TARGET} compiled from the toolchain's sources"),
            Self::Distribution { linker } => {
                write!(f, "the distribution's compiler for {TARGET}, linked by {}", linker.display())
            }
        }
    }
}

/// One method that was tried, and why it failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attempt {
    /// The method.
    pub way: &'static str,
    /// Why it failed.
    pub why: String,
}

/// Why this machine cannot build for the robot's processor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TargetError {
    /// There is no Rust compiler at all.
    NoCompiler {
        /// Output of the attempt.
        why: String,
    },
    /// Every method failed.
    NoWay {
        /// The attempts, in their order.
        attempts: Vec<Attempt>,
    },
}

impl fmt::Display for TargetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCompiler { why } => {
                write!(f, "no Rust compiler ({why}); install rustup, then `rustup target add {TARGET}`")
            }
            Self::NoWay { attempts } => {
                writeln!(
                    f,
                    "nothing here compiles for {TARGET}; install it with `rustup target add {TARGET}`; tried:"
                )?;
                for (index, Attempt { way, why }) in attempts.iter().enumerate() {
                    let end = if index + 1 == attempts.len() { "" } else { "\n" };
                    write!(f, "  {way}: {why}{end}")?;
                }
                Ok(())
            }
        }
    }
}

impl std::error::Error for TargetError {}

/// `cargo` as it was called, so that the same toolchain is used.
pub(crate) fn cargo_program() -> PathBuf {
    env::var_os("CARGO").map(PathBuf::from).filter(|path| path.is_file()).unwrap_or_else(|| "cargo".into())
}

/// The compiler that the workspace's toolchain file, or the caller, has chosen.
struct Compiler {
    root: PathBuf,
    sysroot: PathBuf,
    /// Release of the compiler, such as `1.95.0`.
    release: String,
}

impl Compiler {
    fn of(root: &Path) -> Result<Self, String> {
        let ask = |arguments: &[&str]| output_of(rustc().current_dir(root).args(arguments));
        let sysroot = PathBuf::from(ask(&["--print", "sysroot"])?.trim());
        let version = ask(&["-vV"])?;
        let release = version
            .lines()
            .find_map(|line| line.strip_prefix("release: "))
            .ok_or("rustc names no release")?;
        Ok(Self { root: root.to_path_buf(), sysroot, release: release.trim().to_string() })
    }

    fn sources(&self) -> PathBuf {
        self.sysroot.join("lib/rustlib/src/rust")
    }
}

fn rustc() -> Command {
    Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

type Way = fn(&Compiler, Install) -> Result<ThumbToolchain, String>;

/// Cheapest and most usual first. Sources that an earlier run linked come before rustup's server, which did
/// not answer then.
const WAYS: [(&str, Way); 6] = [
    ("the installed target", prebuilt),
    ("sources linked by an earlier run", linked_sources),
    ("rustup target add", fetched_by_rustup),
    ("sources in the toolchain (rust-src)", own_sources),
    ("Debian's rust-src of the same release", debian_sources),
    ("the distribution's compiler", distribution),
];

fn prebuilt(compiler: &Compiler, _: Install) -> Result<ThumbToolchain, String> {
    let mut question = rustc();
    question.current_dir(&compiler.root).args(["--print", "target-libdir", "--target", TARGET]);
    let folder = PathBuf::from(output_of(&mut question)?.trim());
    let entries = fs::read_dir(&folder).map_err(|_| "not installed".to_string())?;
    let has_core = entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore-"));
    if has_core { Ok(ThumbToolchain::Prebuilt) } else { Err("without `core`".into()) }
}

fn linked_sources(compiler: &Compiler, install: Install) -> Result<ThumbToolchain, String> {
    if compiler.sources().is_symlink() { own_sources(compiler, install) } else { Err("none".into()) }
}

fn fetched_by_rustup(compiler: &Compiler, install: Install) -> Result<ThumbToolchain, String> {
    let rustup = in_path("rustup").ok_or("rustup is not installed")?;
    run_within(RUSTUP, Command::new(rustup).current_dir(&compiler.root).args(["target", "add", TARGET]))?;
    prebuilt(compiler, install)
}

fn own_sources(compiler: &Compiler, _: Install) -> Result<ThumbToolchain, String> {
    if compiler.sources().join("library/core/src/lib.rs").is_file() {
        Ok(ThumbToolchain::FromSources)
    } else {
        Err("none".into())
    }
}

fn debian_sources(compiler: &Compiler, install: Install) -> Result<ThumbToolchain, String> {
    if in_path("apt-get").is_none() || in_path("dpkg-deb").is_none() {
        return Err("not a Debian system".into());
    }
    let unpacked = debian::rust_sources(&compiler.release)?;
    link(&unpacked, &compiler.sources())?;
    own_sources(compiler, install)
}

#[cfg(unix)]
fn link(from: &Path, at: &Path) -> Result<(), String> {
    let said = |error: std::io::Error| format!("cannot link {}: {error}", at.display());
    if let Some(folder) = at.parent() {
        fs::create_dir_all(folder).map_err(said)?;
    }
    // A link that an earlier run left, to sources that are gone.
    if at.is_symlink() {
        fs::remove_file(at).map_err(said)?;
    }
    std::os::unix::fs::symlink(from, at).map_err(said)
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> Result<(), String> {
    Err("no symbolic links here".into())
}

fn distribution(compiler: &Compiler, install: Install) -> Result<ThumbToolchain, String> {
    let complete = || DISTRIBUTION.iter().all(|path| Path::new(path).exists());
    if !complete() && install == Install::SystemWide {
        debian::install(&["rustc-web", "cargo-web", "rust-web-src"])?;
    }
    if !complete() {
        return Err(format!("needs {}", DISTRIBUTION.join(", ")));
    }
    let beside = fs::read_dir(compiler.sysroot.join("lib/rustlib")).ok().and_then(|targets| {
        targets.flatten().map(|target| target.path().join("bin/rust-lld")).find(|linker| linker.is_file())
    });
    let linker = beside.or_else(|| in_path("ld.lld")).or_else(|| in_path("ld.lld-19"));
    Ok(ThumbToolchain::Distribution { linker: linker.ok_or("no LLVM linker (package lld-19)")? })
}

/// Parts of the distribution's compiler, sources of its `core` included.
const DISTRIBUTION: [&str; 3] = ["/usr/bin/rustc", "/usr/bin/cargo", "/usr/lib/rustlib/src/rust/library"];
/// The target is 10 MB; a server that is silent for this time is given up.
const RUSTUP: Duration = Duration::from_mins(2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_is_told_and_what_to_install_comes_first() {
        let attempts = vec![
            Attempt { way: "rustup target add", why: "no answer within 120 s".into() },
            Attempt { way: "the distribution's compiler", why: "not root".into() },
        ];
        let text = TargetError::NoWay { attempts }.to_string();
        let expected = "nothing here compiles for thumbv7em-none-eabihf; install it with `rustup target add \
            thumbv7em-none-eabihf`; tried:\n  rustup target add: no answer within 120 s\n  the distribution's compiler: not root";
        assert_eq!(text, expected);
    }

    #[test]
    fn only_builds_of_core_are_told_to_bootstrap() {
        let asks = |toolchain: &ThumbToolchain| {
            toolchain.cargo(Path::new("."), "build").get_envs().any(|(name, _)| name == "RUSTC_BOOTSTRAP")
        };
        assert!(!asks(&ThumbToolchain::Prebuilt));
        assert!(asks(&ThumbToolchain::FromSources));
        let distribution = ThumbToolchain::Distribution { linker: "ld.lld".into() };
        assert!(asks(&distribution));
        let command = distribution.cargo(Path::new("."), "build");
        let linker =
            command.get_envs().find(|(name, _)| *name == "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER");
        assert_eq!(linker.and_then(|(_, value)| value), Some("ld.lld".as_ref()));
    }

    #[test]
    fn the_compiler_that_compiled_this_test_is_found() {
        let compiler = Compiler::of(&crate::workspace_root()).unwrap();
        assert!(compiler.sysroot.join("lib").is_dir());
        assert_eq!(compiler.release.split('.').count(), 3, "{}", compiler.release);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_sources_that_are_gone_is_replaced() {
        let folder = env::temp_dir().join(format!("onetwo-link-{}", std::process::id()));
        let (gone, there, at) = (folder.join("gone"), folder.join("there"), folder.join("sysroot/src/rust"));
        fs::create_dir_all(&there).unwrap();
        link(&gone, &at).unwrap();
        assert!(!at.exists());
        link(&there, &at).unwrap();
        assert!(at.is_dir());
        fs::remove_dir_all(&folder).unwrap();
    }
}
