//! `first_build`: what a newcomer's first `cargo run --release` compiles and links: crates counted, program
//! weighed.
//!
//! Crates are those of `cargo tree` on this machine, our own and build scripts' among them; the program is
//! weighed without symbols.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use crate::context::{Context, Failure, output_of, run};

/// What holds when the step passes.
pub(crate) const WHAT: &str =
    "what a first build compiles and links stays small, and no crate stands in it in two versions";

/// Crates that a first build may compile. On Linux; other systems may need some more.
const CRATES_MAX: usize = 116;
/// Bytes of the program without symbols.
const PROGRAM_MAX: u64 = 20_000_000;

pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    let mut tree = context.cargo("tree --locked -e normal,build --prefix none --no-dedupe");
    let crates = crates(&output_of(&mut tree)?);
    run(&mut context.cargo("build --release --bin onetwo"))?;
    let built = firmware_build::target_dir(context.root());
    let program = built.join("release").join(format!("onetwo{}", std::env::consts::EXE_SUFFIX));
    let stripped = built.join("onetwo-stripped");
    run(Command::new("strip").arg("-o").arg(&stripped).arg(&program))?;
    let size = fs::metadata(&stripped).map_err(|error| Failure::at(&stripped, error))?.len();
    println!(
        "xtask: a first build compiles {} crates; the program has {size} B without symbols",
        crates.len()
    );
    let faults = faults(&crates, size);
    if faults.is_empty() { Ok(()) } else { Err(Failure::Budget(faults.join("; "))) }
}

/// Name and version of each crate of a tree.
fn crates(tree: &str) -> BTreeSet<(String, String)> {
    let lines = tree.lines().filter_map(|line| {
        let mut fields = line.split(' ');
        Some((fields.next()?.to_owned(), fields.next()?.to_owned()))
    });
    lines.collect()
}

fn faults(crates: &BTreeSet<(String, String)>, size: u64) -> Vec<String> {
    let mut faults = Vec::new();
    if crates.len() > CRATES_MAX {
        faults.push(format!(
            "{} crates of at most {CRATES_MAX}; `cargo tree -e normal,build` shows what brings them: \
             do without, or put what few need behind a feature as `png` is",
            crates.len()
        ));
    }
    let mut versions = BTreeMap::<_, Vec<_>>::new();
    for (name, version) in crates {
        versions.entry(name).or_default().push(version.as_str());
    }
    for (name, versions) in versions.into_iter().filter(|(_, versions)| versions.len() > 1) {
        faults.push(format!(
            "{name} stands in it as {}; take one of them: `cargo update --precise`",
            versions.join(" and ")
        ));
    }
    if size > PROGRAM_MAX {
        faults.push(format!("a program of {size} B without symbols, of at most {PROGRAM_MAX}"));
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_is_counted_by_name_and_version_and_too_much_of_it_is_a_fault() {
        let tree = "onetwo v0.1.0 (/somewhere)\nsyn v2.0.1\nserde v1.0.1\nsyn v2.0.1\n";
        let mut crates = crates(tree);
        assert_eq!(crates.len(), 3);
        assert!(faults(&crates, PROGRAM_MAX).is_empty());
        assert!(faults(&crates, PROGRAM_MAX + 1)[0].contains("without symbols"));
        crates.insert(("syn".to_owned(), "v3.0.0".to_owned()));
        assert!(faults(&crates, 0)[0].contains("syn stands in it as v2.0.1 and v3.0.0"));
        crates.extend((0..CRATES_MAX).map(|n| (format!("crate-{n}"), "v1.0.0".to_owned())));
        assert!(faults(&crates, 0)[0].contains("of at most"));
    }
}
