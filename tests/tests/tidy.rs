//! `tidy`: style tests of the source, in place of repeated remarks of reviewers.
//!
//! Reads the repository from this crate's directory upwards. Every finding names file and line, the fault and
//! the fix. The rules are docs/architecture.md §1.2, §2.4: shared crates give the same bits everywhere,
//! allocate nothing and do no I/O; dependencies between crates have one direction; and nothing unfinished is
//! left behind.

#[path = "tidy/circles.rs"]
mod circles;
#[path = "tidy/counts.rs"]
mod counts;
#[path = "tidy/facts.rs"]
mod facts;
#[path = "tidy/size.rs"]
mod size;
#[path = "tidy/values.rs"]
mod values;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use match_tests::workspace::{Finding, Manifest, Source, members, root, rust_sources, text_sources};

#[test]
fn every_file_opens_with_a_line_that_names_it_and_asks_nothing() {
    check(&rust_sources(), |source| {
        let hint = "open with `//! `NAME`: what it is and does. Units, frame.`";
        match source.text.lines().take(OPENING_LINES).find(|line| line.starts_with("//!")) {
            None => vec![source.at(1, "no `//!` at the top", hint)],
            Some(line) if line.contains('?') => vec![source.at(1, "its first line is a question", hint)],
            Some(_) => vec![],
        }
    });
}

#[test]
fn every_script_of_the_page_opens_with_its_name_and_what_it_does() {
    let scripts: Vec<_> = text_sources()
        .into_iter()
        .filter(|source| {
            let is_script = Path::new(&source.path).extension().is_some_and(|extension| extension == "js");
            is_script && source.path.starts_with("host/page/web/")
        })
        .collect();
    assert!(scripts.len() > 30, "{} scripts", scripts.len());
    check(&scripts, |source| {
        let name = source.path.trim_start_matches("host/page/web/").trim_end_matches(".js");
        let first = source.text.lines().next().unwrap_or_default();
        let named = first.strip_prefix(&format!("// {name}: ")).is_some_and(|rest| !rest.contains('?'));
        let hint = "open with `// NAME: what it is and does.`";
        if named { vec![] } else { vec![source.at(1, "its first line does not name it", hint)] }
    });
}

#[test]
fn no_file_is_longer_than_a_reader_holds_in_mind() {
    check(&rust_sources(), |source| {
        let lines = source.text.lines().count();
        let hint = "split it along its purposes; 100 to 400 lines read best";
        if lines <= LINES_MAX { vec![] } else { vec![source.at(lines, &format!("{lines} lines"), hint)] }
    });
}

#[test]
fn comments_are_no_wider_than_rustfmt_makes_code() {
    check(&rust_sources(), too_wide);
}

#[test]
fn shared_arithmetic_goes_through_geometry_math() {
    let folders = folders(&SAME_BITS);
    let sources = rust_sources()
        .into_iter()
        .filter(|source| source.is_under(&folders) && !source.path.starts_with("protocol/geometry/src/math"));
    check(&sources.collect::<Vec<_>>(), inexact_floats);
}

#[test]
fn nalgebra_stays_within_geometry_and_without_its_roots_and_rotations() {
    let folders = folders(&SAME_BITS);
    let sources = rust_sources().into_iter().filter(|source| source.is_under(&folders));
    check(&sources.collect::<Vec<_>>(), |source| {
        let hint =
            "use geometry's own `norm`, `distance` and `Angle`: nalgebra's reach for libm's √ and sine";
        source.code_with(&NALGEBRA_INEXACT, hint)
    });
}

#[test]
fn nothing_half_done_stays_behind() {
    check(&text_sources(), |source| {
        let marks = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X:")];
        source.text_with(&marks, "do it, or write into README what is not done yet")
    });
    check(&rust_sources(), |source| {
        let stubs = ["todo", "unimplemented", "dbg"].map(|name| format!("{name}!("));
        let stubs: Vec<_> = stubs.iter().map(String::as_str).chain([concat!("#[ig", "nore")]).collect();
        source.text_with(&stubs, "finish it, or take it out")
    });
}

#[test]
fn no_file_knows_the_machine_it_was_written_on() {
    check(&text_sources(), |source| {
        let hint = "use a path relative to the workspace, or `std::env::temp_dir()`";
        let roots =
            [concat!("/wo", "rk/"), concat!("/tm", "p/"), concat!("/ho", "me/"), concat!("/ro", "ot/")];
        let within = |line: &str, root: &str| {
            line.match_indices(root)
                .any(|(at, _)| !line[..at].ends_with(|before: char| before.is_alphanumeric()))
        };
        let lines = (1..).zip(source.text.lines());
        let found = lines.filter_map(|(number, line)| {
            let root = roots.into_iter().find(|root| within(line, root))?;
            Some(source.at(number, &format!("`{root}…`"), hint))
        });
        found.collect()
    });
}

#[test]
fn robots_crates_are_no_std_and_allocate_nothing() {
    let crates = NO_STD.into_iter().chain(KITS).map(|name| (directory_of(name), "src/lib.rs"));
    let boards = board_folders().into_iter().map(|directory| (directory, "src/main.rs"));
    let all: Vec<_> = crates.chain(boards).collect();
    let heads: Vec<_> =
        all.iter().map(|(directory, file)| Source::read(&root().join(directory).join(file))).collect();
    check(&heads, |source| {
        let says_so = source.code().any(|(_, line)| line.starts_with("#![") && line.contains("no_std"));
        let finding = source.at(1, "not `no_std`", "add `#![no_std]`: the crate runs on the robot");
        if says_so { vec![] } else { vec![finding] }
    });
    let folders: Vec<_> = all.into_iter().map(|(directory, _)| directory).collect();
    let sources = rust_sources().into_iter().filter(|source| source.is_under(&folders));
    check(&sources.collect::<Vec<_>>(), |source| {
        source.code_with(
            &ALLOCATES,
            "take a capacity as a named constant and `heapless`; when full, the value comes back",
        )
    });
}

#[test]
fn only_runtime_calls_the_brain_on_a_board() {
    let boards = board_folders();
    assert!(!boards.is_empty());
    let sources = rust_sources().into_iter().filter(|source| source.is_under(&boards));
    check(&sources.collect::<Vec<_>>(), |source| {
        source.code_with(&["brain::"], "start `runtime`'s tasks; a board is pins, clocks and drivers")
    });
    for directory in boards {
        let manifest = Manifest::read(&directory);
        assert!(
            !manifest.all.contains("brain"),
            "{directory}/Cargo.toml: depends on brain; depend on runtime instead"
        );
    }
}

#[test]
fn robots_crates_do_no_io() {
    let mut findings = Vec::new();
    for name in NO_STD.iter().filter(|name| **name != "runtime") {
        let Manifest { directory, linked, .. } = Manifest::read(&directory_of(name));
        for dependency in linked.iter().filter(|name| !is_pure(name)) {
            let hint =
                "is not known to be free of I/O and clocks; do without, or add it to PURE with a reason";
            findings.push(format!("{directory}/Cargo.toml: `{dependency}` {hint}"));
        }
    }
    assert!(findings.is_empty(), "\n{}", findings.join("\n"));
}

#[test]
fn a_crate_without_unsafe_forbids_it() {
    let mut findings = Vec::new();
    for Manifest { directory, .. } in members() {
        let own = [directory.clone()];
        let sources: Vec<_> = rust_sources().into_iter().filter(|source| source.is_under(&own)).collect();
        let roots = ["lib.rs", "main.rs"].map(|name| format!("{directory}/src/{name}"));
        let is_root = |source: &&Source| roots.contains(&source.path);
        let uses = |source: &Source| {
            source.code().any(|(_, line)| line.contains("unsafe ") || line.contains("unsafe("))
        };
        if sources.iter().any(uses) {
            continue;
        }
        let forbids = |source: &Source| source.text.contains("forbid(unsafe_code)");
        for root in sources.iter().filter(is_root).filter(|root| !forbids(root)) {
            findings.push(
                root.at(1, "no `#![forbid(unsafe_code)]`", "add it: the crate has no `unsafe`").to_string(),
            );
        }
    }
    assert!(findings.is_empty(), "\n{}", findings.join("\n"));
}

#[test]
fn dependencies_point_one_way() {
    let crates: BTreeMap<String, Manifest> = members().into_iter().map(|m| (m.name.clone(), m)).collect();
    let mut findings = upward(&crates);
    for (from, to, hint) in NEVER_LINKED {
        // A crate that does not exist links nothing.
        if crates.contains_key(from) && reachable(&crates, from).contains(to) {
            findings.push(format!("{from} links {to}; {hint}"));
        }
    }
    assert!(findings.is_empty(), "\n{}", findings.join("\n"));
}

#[test]
fn the_rules_find_what_they_look_for() {
    let source = |text: &str| Source { path: "x.rs".into(), text: text.into() };
    let lines = |findings: Vec<Finding>| findings.iter().map(|finding| finding.line).collect::<Vec<_>>();

    let floats = source(
        "let a = x.sqrt();\nlet b = f32::hypot(x, y); // y.sqrt()\n// z.sin()\nlet c = math::sqrt(x);\nx.powi(2)\n",
    );
    assert_eq!(lines(inexact_floats(&floats)), [1, 2, 5]);
    let tested = source("fn f() {}\n#[cfg(test)]\nmod tests {\n    let a = x.sqrt();\n}\n");
    assert!(inexact_floats(&tested).is_empty());
    let beside = source("#[cfg(test)]\nmod tests;\nfn f(x: f32) -> f32 { x.exp() }\n");
    assert_eq!(lines(inexact_floats(&beside)), [3]);
    let allocating = source("extern crate alloc;\nuse alloc::vec::Vec;\nlet my_alloc::x = 1;\n");
    assert_eq!(lines(allocating.code_with(&ALLOCATES, "")), [1, 2]);

    let wide = "é".repeat(WIDTH);
    let commented =
        format!("// {wide}\nlet x = \"{wide}\";\n/// | {wide} |\n//! ```\n//! {wide}\n//! ```\n//! {wide}\n");
    assert_eq!(lines(too_wide(&source(&commented))), [1, 7]);

    let manifest = |text: &str| Manifest::from_text("x", text);
    let dependent = manifest("[package]\nname = \"geometry\"\n[dependencies]\nbrain.workspace = true\n");
    let crates = BTreeMap::from([("geometry".to_string(), dependent)]);
    assert_eq!(upward(&crates).len(), 1);
    let renamed = manifest(
        "[package]\nname = \"y\"\n[target.'cfg(unix)'.dependencies]\nmind = { package = \"brain\", path = \"b\" }\n",
    );
    assert!(renamed.all.contains("brain") && renamed.linked.contains("brain"));
}

// Rules

/// Comments wider than code, except tables and fenced text.
fn too_wide(source: &Source) -> Vec<Finding> {
    let (mut fenced, mut findings) = (false, Vec::new());
    for (number, line) in (1..).zip(source.text.lines()) {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            fenced = false;
            continue;
        };
        let text = comment.trim_start_matches(['/', '!']).trim_start();
        fenced ^= text.starts_with("```");
        let columns = line.chars().count();
        if columns > WIDTH && !fenced && !text.starts_with('|') {
            let hint = "wrap it at the `max_width` of rustfmt.toml";
            findings.push(source.at(number, &format!("a comment of {columns} columns"), hint));
        }
    }
    findings
}

fn inexact_floats(source: &Source) -> Vec<Finding> {
    let calls = FLOAT_METHODS
        .iter()
        .flat_map(|name| [format!(".{name}("), format!("f32::{name}"), format!("f64::{name}")]);
    let calls: Vec<_> = calls.collect();
    let calls: Vec<_> = calls.iter().map(String::as_str).collect();
    source.code_with(&calls, "call `geometry::math`: std's answer differs from the robot's")
}

/// Dependencies on a crate of a higher or the same level.
fn upward(crates: &BTreeMap<String, Manifest>) -> Vec<String> {
    let is_board = |name: &str| crates.get(name).is_some_and(|known| known.directory.starts_with(BOARDS));
    let height = |name: &str| {
        let place = if is_board(name) { BOARDS } else { name };
        LOWEST_FIRST.iter().position(|known| *known == place)
    };
    let mut findings = Vec::new();
    for manifest in crates.values() {
        let Some(own) = height(&manifest.name) else {
            findings.push(format!(
                "{}/Cargo.toml: `{}` has no place in LOWEST_FIRST; give it one",
                manifest.directory, manifest.name
            ));
            continue;
        };
        for dependency in manifest.all.iter().filter(|name| height(name).is_some_and(|other| other >= own)) {
            findings.push(format!(
                "{}/Cargo.toml: `{}` depends on `{dependency}`, which stands above it; turn the dependency round (docs/architecture.md §1.2)",
                manifest.directory, manifest.name
            ));
        }
    }
    findings
}

/// Everything that is linked into the same program.
fn reachable<'a>(crates: &'a BTreeMap<String, Manifest>, from: &'a str) -> BTreeSet<&'a str> {
    let mut seen = BTreeSet::new();
    let mut open: Vec<&str> = vec![from];
    while let Some(manifest) = open.pop().and_then(|name| crates.get(name)) {
        open.extend(
            manifest
                .linked
                .iter()
                .map(String::as_str)
                .filter(|name| crates.contains_key(*name) && seen.insert(*name)),
        );
    }
    seen
}

fn is_pure(name: &str) -> bool {
    PURE.contains(&name) || NO_STD.contains(&name)
}

fn check(sources: &[Source], rule: impl Fn(&Source) -> Vec<Finding>) {
    assert!(!sources.is_empty(), "nothing to look at");
    let findings = sources.iter().flat_map(rule).map(|finding| finding.to_string());
    let findings: Vec<_> = findings.collect();
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
}

fn directory_of(name: &str) -> String {
    let found = members().into_iter().find(|manifest| manifest.name == name);
    found
        .unwrap_or_else(|| {
            panic!("no crate `{name}` in the workspace; mend the lists at the end of this file")
        })
        .directory
}

fn folders(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| directory_of(name)).collect()
}

fn board_folders() -> Vec<String> {
    let folders = members().into_iter().map(|manifest| manifest.directory);
    folders.filter(|directory| directory.starts_with(BOARDS)).collect()
}

// What we agreed on

/// A file's first comment starts within these lines, so that a lint or a shebang may come first.
const OPENING_LINES: usize = 3;
const LINES_MAX: usize = 500;
/// Columns of a comment, as rustfmt.toml has it for code.
const WIDTH: usize = 110;

/// Crates on a robot.
const NO_STD: [&str; 9] =
    ["geometry", "protocol", "rules", "motion", "casebase", "case-library", "nrf24", "brain", "runtime"];
/// What boards share; they do I/O.
const KITS: [&str; 2] = ["board-kit", "stm32-kit"];
/// Crates whose numbers enter a trace hash.
const SAME_BITS: [&str; 9] =
    ["geometry", "protocol", "rules", "motion", "casebase", "case-library", "brain", "runtime", "hil-sim"];
/// External crates that only compute: no files, sockets, clocks or threads.
const PURE: [&str; 13] = [
    "nalgebra",
    "libm",
    "micromath",
    "heapless",
    "serde",
    "postcard",
    "siphasher",
    "cobs",
    "zerocopy",
    "defmt",
    // Derives `Display` and `Error` when the crate is compiled.
    "thiserror",
    // Traits of pins and buses; their implementations do the I/O.
    "embedded-hal",
    "rf24-rs",
];

/// Where boards lie; in [`LOWEST_FIRST`] all of them.
const BOARDS: &str = "firmware/boards/";
/// docs/architecture.md §1.2; a crate depends on earlier ones only.
const LOWEST_FIRST: [&str; 35] = [
    "foreign",
    "robots",
    "geometry",
    "rules",
    "protocol",
    "motion",
    "ssl",
    "casebase",
    "case-tools",
    "case-library",
    "figures",
    "workloads",
    "nrf24-model",
    "nrf24",
    "brain",
    "runtime",
    "board-kit",
    "stm32-kit",
    BOARDS,
    "on-target",
    "firmware-build",
    "page",
    "page-browser",
    "hil-sim",
    "virtual-robot",
    "host",
    "arena",
    "study",
    "report",
    "feed",
    "team",
    "onetwo",
    "match-tests",
    "xtask",
    "fuzz",
];
/// Pairs of crates of which one is never linked into the other's program, over any number of crates between.
const NEVER_LINKED: [(&str, &str, &str); 4] = [
    ("host", "brain", "they know each other through `protocol` only"),
    ("hil-sim", "host", "the simulator plays with anybody's host"),
    ("brain", "case-library", "the brain takes a `&CaseBase`; whoever starts it picks the library"),
    ("runtime", "case-library", "the board picks the library"),
];

/// Methods of `std` that may differ between platforms.
const FLOAT_METHODS: [&str; 26] = [
    "sqrt", "cbrt", "hypot", "powi", "powf", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log2", "log10", "sin",
    "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "floor", "ceil", "round",
    "mul_add",
];
const NALGEBRA_INEXACT: [&str; 10] = [
    "Rotation2",
    "Rotation3",
    "UnitComplex",
    "UnitQuaternion",
    "nalgebra::distance",
    ".0.norm(",
    ".0.magnitude(",
    ".0.normalize(",
    "coords.norm(",
    ".metric_distance(",
];
const ALLOCATES: [&str; 3] = ["extern crate alloc", "alloc::", "global_allocator"];
