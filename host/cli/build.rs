//! `build`: build script: the commit that this program is built from, and its date, answered by git at build
//! time, for `onetwo --version` and for everything that records where it came from; "unknown" where there is
//! no git or no repository of ours. Also the hash of the sources of the robots' images.
#![forbid(unsafe_code)]

use std::path::Path;
use std::process::Command;

#[path = "../../firmware/build/src/sources.rs"]
mod sources;

fn main() {
    let tracked = is_tracked();
    let answers = [
        ("ONETWO_COMMIT", &["rev-parse", "HEAD"][..]),
        ("ONETWO_COMMIT_SHORT", &["rev-parse", "--short=12", "HEAD"]),
        ("ONETWO_COMMIT_DATE", &["show", "--no-patch", "--format=%cs", "HEAD"]),
    ];
    for (name, question) in answers {
        let answer = if tracked { git(question) } else { None };
        println!("cargo::rustc-env={name}={}", answer.as_deref().unwrap_or("unknown"));
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if let Some(hash) = sources::source_hash(&root) {
        println!("cargo::rustc-env=ONETWO_IMAGE_SOURCES={hash:08x}");
    }
    for source in sources::SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    rerun_when_head_moves();
}

/// A source archive unpacked inside a foreign repository must not be labelled with that repository's commit.
fn is_tracked() -> bool {
    git(&["ls-files", "--error-unmatch", "build.rs"]).is_some()
}

/// HEAD itself changes on a checkout, the branch it names on a commit; a packed branch is stored in
/// `packed-refs`.
fn rerun_when_head_moves() {
    println!("cargo::rerun-if-changed=build.rs");
    let branch = git(&["symbolic-ref", "-q", "HEAD"]);
    let places = ["HEAD", "logs/HEAD", "packed-refs"].into_iter().map(str::to_owned).chain(branch);
    for path in places.filter_map(|place| git(&["rev-parse", "--git-path", &place])) {
        // A file that is named and missing would rerun this script on every build.
        if Path::new(&path).exists() {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}

/// What git answers, if it answers.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    if !output.status.success() {
        return None;
    }
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (!text.is_empty()).then_some(text)
}
