//! `debian`: toolchain fallback on Debian-like systems without access to rustup's server: packages and
//! `core`'s sources.
//!
//! The sources of `core` must be of exactly the compiler's release. Debian's backports carry them as
//! `rust-src`; they are read through an apt state of our own (lists, cache, one source), so that the system's
//! sources stay untouched.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::process::{in_path, output_of, run_within};

/// Unpacks `rust-src` of this very release into the user's cache; returns the directory that holds
/// `library/`.
pub(crate) fn rust_sources(release: &str) -> Result<PathBuf, String> {
    let cache = cache_folder()?.join(format!("rust-src-{release}"));
    let sources = cache.join(format!("usr/src/rustc-{release}"));
    if sources.join("library/core/src/lib.rs").is_file() {
        return Ok(sources);
    }
    let mirror = mirror().ok_or("no Debian mirror in apt's sources")?;
    for folder in ["lists/partial", "cache/archives/partial"] {
        fs::create_dir_all(cache.join(folder)).map_err(|error| format!("{}: {error}", cache.display()))?;
    }
    let list = cache.join("one.list");
    let source = format!("deb [signed-by={KEYRING}] {mirror} {SUITE} main\n");
    fs::write(&list, source).map_err(|error| format!("{}: {error}", list.display()))?;
    let apt = |program: &str| {
        let mut command = Command::new(program);
        command.current_dir(&cache);
        for option in [
            format!("Dir::State::Lists={}", cache.join("lists").display()),
            format!("Dir::Cache={}", cache.join("cache").display()),
            format!("Dir::Etc::SourceList={}", list.display()),
            "Dir::Etc::SourceParts=/dev/null".into(),
            // The download's own user could not read a private directory.
            "APT::Sandbox::User=root".into(),
        ] {
            command.args(["-o", &option]);
        }
        command
    };
    run_within(DOWNLOAD, apt("apt-get").args(["-qq", "update"]))?;
    let offered = output_of(apt("apt-cache").args(["madison", "rust-src"]))?;
    let version = matching_version(&offered, release).ok_or(format!("{SUITE} has no rust-src {release}"))?;
    run_within(DOWNLOAD, apt("apt-get").args(["-qq", "download", &format!("rust-src={version}")]))?;
    let package = fs::read_dir(&cache)
        .map_err(|error| format!("{}: {error}", cache.display()))?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.extension().is_some_and(|extension| extension == "deb"))
        .ok_or("apt-get left no package")?;
    output_of(Command::new("dpkg-deb").arg("-x").args([&package, &cache]))?;
    if sources.join("library/core/src/lib.rs").is_file() {
        Ok(sources)
    } else {
        Err(format!("{} holds no library/core", package.display()))
    }
}

/// Installs system packages where we are root on a Debian-like system.
pub(crate) fn install(packages: &[&str]) -> Result<(), String> {
    if in_path("apt-get").is_none() {
        return Err("no apt-get on this system".into());
    }
    if !is_root() {
        return Err("not root".into());
    }
    let mut install = Command::new("apt-get");
    install.env("DEBIAN_FRONTEND", "noninteractive");
    install.args(["install", "-y", "-qq", "--no-install-recommends"]).args(packages);
    // A fresh system has no package lists yet; elsewhere the first attempt is enough.
    if run_within(DOWNLOAD, &mut install).is_ok() {
        return Ok(());
    }
    run_within(DOWNLOAD, Command::new("apt-get").args(["-qq", "update"]))?;
    run_within(DOWNLOAD, &mut install)
}

/// The version of exactly this release in `apt-cache madison`'s table.
fn matching_version(madison: &str, release: &str) -> Option<String> {
    madison
        .lines()
        .filter_map(|line| Some(line.split('|').nth(1)?.trim()))
        .find(|version| {
            version
                .strip_prefix(release)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['+', '-', '~']))
        })
        .map(str::to_string)
}

/// The mirror that the system uses, from the new or the old format of apt's sources.
fn mirror() -> Option<String> {
    let new = fs::read_to_string(Path::new(APT).join("sources.list.d/debian.sources")).unwrap_or_default();
    let old = fs::read_to_string(Path::new(APT).join("sources.list")).unwrap_or_default();
    mirror_in(&new, &old)
}

fn mirror_in(new: &str, old: &str) -> Option<String> {
    let from_new = new.lines().find_map(|line| line.strip_prefix("URIs:")?.split_whitespace().next());
    let from_old = || {
        let lines = old.lines().filter(|line| line.starts_with("deb "));
        lines.flat_map(str::split_whitespace).find(|word| word.contains("://"))
    };
    from_new.or_else(from_old).map(str::to_string)
}

fn cache_folder() -> Result<PathBuf, String> {
    let base = env::var_os("XDG_CACHE_HOME")
        .map(PathBuf::from)
        .filter(|path| path.is_absolute())
        .or_else(|| Some(PathBuf::from(env::var_os("HOME")?).join(".cache")))
        .ok_or("neither XDG_CACHE_HOME nor HOME is set")?;
    Ok(base.join("onetwo"))
}

fn is_root() -> bool {
    output_of(Command::new("id").arg("-u")).is_ok_and(|user| user.trim() == "0")
}

const APT: &str = "/etc/apt";
/// Keys that sign Debian's archives, as the package `debian-archive-keyring` installs them.
const KEYRING: &str = "/usr/share/keyrings/debian-archive-keyring.gpg";
/// The suite that keeps several releases of the compiler's sources side by side.
const SUITE: &str = "trixie-backports";
/// Time limit of the download: 45 MB at 200 kB/s, the slowest connection supported.
const DOWNLOAD: Duration = Duration::from_mins(4);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_sources_of_the_very_release_will_do() {
        let table =
            " rust-src | 1.96.0+dfsg1-1~bpo13+1 | mirror\n rust-src | 1.95.0+dfsg1-2~bpo13+1 | mirror\n";
        assert_eq!(matching_version(table, "1.95.0").as_deref(), Some("1.95.0+dfsg1-2~bpo13+1"));
        assert_eq!(matching_version(table, "1.9"), None);
        assert_eq!(matching_version("", "1.95.0"), None);
    }

    #[test]
    fn the_mirror_is_read_from_either_format() {
        let new = "Types: deb\nURIs: http://mirror.example/debian\nSuites: bookworm\n";
        let old = "# deb cdrom:\ndeb [arch=amd64] https://old.example/debian bookworm main\n";
        assert_eq!(mirror_in(new, old).as_deref(), Some("http://mirror.example/debian"));
        assert_eq!(mirror_in("", old).as_deref(), Some("https://old.example/debian"));
        assert_eq!(mirror_in("", ""), None);
    }
}
