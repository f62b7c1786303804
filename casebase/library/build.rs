//! Build script: checks the built-in libraries and encodes their tables. `cases/<league>/` → one blob each.
//!
//! A faulty library fails the build with its findings; doubts are reported as warnings of the build.
#![forbid(unsafe_code)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use case_tools::Library;

fn main() {
    let cases = Path::new(&variable("CARGO_MANIFEST_DIR")).join("cases");
    println!("cargo::rerun-if-changed={}", cases.display());
    let mut folders: Vec<PathBuf> = fs::read_dir(&cases)
        .unwrap_or_else(|error| panic!("{} cannot be read: {error}", cases.display()))
        .map(|entry| entry.expect("a readable entry").path())
        .filter(|path| path.is_dir())
        .collect();
    folders.sort();

    let out = PathBuf::from(variable("OUT_DIR"));
    let mut code = String::new();
    let mut names = String::new();
    for directory in &folders {
        let (library, rules) = read(directory);
        let constant = library.league.to_uppercase().replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let blob = out.join(format!("{}.table", library.league));
        fs::write(&blob, library.table.bytes()).expect("the output directory is writable");
        write_league(&mut code, &constant, &blob, &library, &rules);
        write!(names, "{constant}, ").expect("a string takes everything");
    }
    writeln!(code, "/// Every built-in league.\npub static LEAGUES: &[League] = &[{names}];")
        .expect("a string takes everything");
    fs::write(out.join("leagues.rs"), code).expect("the output directory is writable");
}

/// A league's library and the text of its `league.toml`; a failure ends the build.
fn read(directory: &Path) -> (Library, String) {
    let library = case_tools::load(directory).unwrap_or_else(|findings| {
        for finding in &findings {
            println!("cargo::error={finding}");
        }
        panic!("the case library in {} is refused: see the findings", directory.display());
    });
    for finding in &library.findings {
        println!("cargo::warning={finding}");
    }
    let rules = fs::read_to_string(directory.join("league.toml")).expect("read a moment ago");
    (library, rules)
}

/// The table as one static (all that firmware links), names and texts as another.
fn write_league(code: &mut String, constant: &str, blob: &Path, library: &Library, rules: &str) {
    let Library { league, names, sources, kicks, .. } = library;
    let blob = blob.to_str().expect("a path in UTF-8");
    writeln!(
        code,
        "static {constant}_TABLE: &Aligned<[u8]> = &Aligned(*include_bytes!({blob:?}));\n\
         const {constant}: League = League {{ name: {league:?}, table: &{constant}_TABLE.0, names: &{names:?}, \
         kicks: &{kicks:?}, rules: {rules:?}, sources: &{sources:?} }};"
    )
    .expect("a string takes everything");
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_else(|_| panic!("cargo sets {name}"))
}
