//! `circles`: files, and folders, of one crate that use each other in a circle. Of folders there is none, and
//! no file may be added to those in [`KNOWN`].
//!
//! A file uses another one where its code names it by `crate::`, `super::` or `self::`. Parents and children
//! are left out: a `mod.rs` that names its files, and files that use their parent's items, are a hierarchy. A
//! folder uses its neighbour, a folder or a file, where one of its files uses a file there.

use std::collections::{BTreeMap, BTreeSet};

use match_tests::workspace::{Source, members, rust_sources};

/// `a::b` as `["a", "b"]`; the root is empty.
type Module = Vec<String>;
type Graph = BTreeMap<Module, BTreeSet<Module>>;

#[test]
fn files_of_a_crate_use_each_other_in_no_circle_but_known_ones() {
    only_known(&KNOWN, circles);
}

#[test]
fn folders_of_a_crate_use_each_other_in_no_circle() {
    only_known(&[], circles_of_folders);
}

/// Holds the circles of all crates, as `find` finds them in the graph of a crate's files, to the known ones.
fn only_known(known: &[(&str, &[&str])], find: impl Fn(&Graph) -> BTreeSet<BTreeSet<Module>>) {
    let known: BTreeSet<(String, Vec<String>)> = known
        .iter()
        .map(|(name, files)| ((*name).into(), files.iter().map(|f| (*f).into()).collect()))
        .collect();
    let sources = rust_sources();
    let mut found = BTreeSet::new();
    for crate_ in members() {
        let files: BTreeMap<Module, &Source> =
            sources.iter().filter_map(|source| Some((module(&crate_.directory, source)?, source))).collect();
        for circle in find(&graph(&files)) {
            found.insert((crate_.name.clone(), circle.iter().map(|module| module.join("::")).collect()));
        }
    }
    let new: Vec<_> = found.difference(&known).map(|circle| format!("new or grown: {circle:?}")).collect();
    let gone: Vec<_> =
        known.difference(&found).map(|circle| format!("gone or smaller: {circle:?}")).collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "\n{}\nmove what both need into a file below both; the list of known circles only gets shorter",
        [new, gone].concat().join("\n")
    );
}

/// Circles among neighbours, where at least one of a circle is a folder.
fn circles_of_folders(graph: &Graph) -> BTreeSet<BTreeSet<Module>> {
    let mut neighbours = Graph::new();
    for (from, uses) in graph {
        for to in uses {
            let common = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            let (from, to) = (from[..=common].to_vec(), to[..=common].to_vec());
            neighbours.entry(to.clone()).or_default();
            neighbours.entry(from).or_default().insert(to);
        }
    }
    let is_folder =
        |place: &Module| graph.keys().any(|file| file.len() > place.len() && file.starts_with(place));
    circles(&neighbours).into_iter().filter(|circle| circle.iter().any(is_folder)).collect()
}

/// The module of a file of that crate, tests and programs in `src/bin` excluded.
fn module(directory: &str, source: &Source) -> Option<Module> {
    let path = source.path.strip_prefix(directory)?.strip_prefix("/src/")?.strip_suffix(".rs")?;
    let mut module: Module = path.split('/').map(String::from).collect();
    if module.iter().any(|part| matches!(part.as_str(), "tests" | "bin")) {
        return None;
    }
    if matches!(module.last()?.as_str(), "mod" | "lib" | "main") {
        module.pop();
    }
    Some(module)
}

fn graph(files: &BTreeMap<Module, &Source>) -> Graph {
    let uses = |(own, source): (&Module, &&Source)| {
        let code: Vec<_> = source.code().map(|(_, line)| line).collect();
        let code = code.join("\n");
        let named = paths(&code).into_iter().filter_map(|path| resolve(own, &path, files));
        let apart = |other: &Module| !other.starts_with(own) && !own.starts_with(other);
        (own.clone(), named.filter(apart).collect())
    };
    files.iter().map(uses).collect()
}

/// Every path that starts with `crate`, `super` or `self`; those in braces one by one.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if !before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | ':' | '$')) {
                branch(&code[at..], &[], &mut found);
            }
        }
    }
    found
}

/// Reads one path of a tree such as `a::{b, c::{d, e}}`; returns the text behind it.
fn branch<'t>(text: &'t str, above: &[String], found: &mut Vec<Vec<String>>) -> &'t str {
    let mut path = above.to_vec();
    let mut rest = text.trim_start();
    loop {
        let len = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        path.push(rest[..len].to_string());
        rest = &rest[len..];
        let Some(behind) = rest.strip_prefix("::") else { break };
        let Some(inner) = behind.strip_prefix('{') else {
            rest = behind;
            continue;
        };
        rest = inner;
        loop {
            rest = branch(rest, &path, found).trim_start();
            match rest.strip_prefix(',') {
                Some(next) if !next.trim_start().starts_with('}') => rest = next,
                Some(next) => return next.trim_start().strip_prefix('}').unwrap_or(next),
                None => return rest.strip_prefix('}').unwrap_or(rest),
            }
        }
    }
    found.push(path);
    // `as NAME`, and whatever else stands behind a name in braces.
    rest.find([',', '}']).map_or(rest, |end| if above.is_empty() { rest } else { &rest[end..] })
}

/// The file in which a path from the file `own` ends; `None` for the root.
fn resolve(own: &Module, path: &[String], files: &BTreeMap<Module, &Source>) -> Option<Module> {
    let mut module = if path[0] == "crate" { Module::new() } else { own.clone() };
    for part in path.iter().skip(usize::from(path[0] != "super")) {
        if part == "super" {
            module.pop();
        } else if part != "self" {
            module.push(part.clone());
        }
    }
    while !module.is_empty() && !files.contains_key(&module) {
        module.pop();
    }
    (!module.is_empty()).then_some(module)
}

fn circles(graph: &Graph) -> BTreeSet<BTreeSet<Module>> {
    let reached: BTreeMap<&Module, BTreeSet<&Module>> =
        graph.keys().map(|from| (from, reachable(graph, from))).collect();
    let circle = |from: &Module| {
        let back = |other: &&&Module| reached.get(**other).is_some_and(|all| all.contains(from));
        reached[from].iter().filter(back).map(|module| (*module).clone()).collect::<BTreeSet<_>>()
    };
    graph.keys().map(circle).filter(|circle| circle.len() > 1).collect()
}

fn reachable<'g>(graph: &'g Graph, from: &'g Module) -> BTreeSet<&'g Module> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(module) = open.pop() {
        open.extend(graph.get(module).into_iter().flatten().filter(|next| seen.insert(*next)));
    }
    seen
}

#[test]
fn a_circle_is_found_through_braces_and_a_hierarchy_is_none() {
    let source = |path: &str, text: &str| Source { path: format!("x/src/{path}.rs"), text: text.into() };
    let sources = [
        source("lib", "mod a;\nuse crate::a::A;\n"),
        source("a", "use crate::{F, b::{self, B as C}};\n"),
        source("b", "fn f() { super::c::g() }\n"),
        source("c", "use super::{\n    a::A,\n    d,\n};\n"),
        source("d/mod", "use self::e::E;\n#[cfg(test)]\nmod tests {\n    use crate::a;\n}\n"),
        source("d/e", "use super::D; // crate::a::A\n"),
    ];
    let files: BTreeMap<Module, &Source> =
        sources.iter().filter_map(|source| Some((module("x", source)?, source))).collect();
    let found: Vec<Vec<String>> = circles(&graph(&files))
        .into_iter()
        .map(|circle| circle.into_iter().map(|module| module.join("::")).collect())
        .collect();
    assert_eq!(found, [["a", "b", "c"]]);
    assert!(circles_of_folders(&graph(&files)).is_empty(), "none of them is a folder");
}

#[test]
fn a_circle_of_folders_is_found_though_no_file_is_in_one() {
    let source = |path: &str, text: &str| Source { path: format!("x/src/{path}.rs"), text: text.into() };
    let sources = [
        source("a/mod", "mod b;\nmod c;\n"),
        source("a/b", "use crate::d::F;\n"),
        source("a/c", ""),
        source("d/mod", "mod e;\n"),
        source("d/e", "use crate::a::c::C;\n"),
    ];
    let files: BTreeMap<Module, &Source> =
        sources.iter().filter_map(|source| Some((module("x", source)?, source))).collect();
    let graph = graph(&files);
    assert!(circles(&graph).is_empty());
    let found: Vec<Vec<String>> = circles_of_folders(&graph)
        .into_iter()
        .map(|circle| circle.into_iter().map(|module| module.join("::")).collect())
        .collect();
    assert_eq!(found, [["a", "d"]]);
}

/// Circles that are left, by crate: files in the order of their names. Only to be shortened.
const KNOWN: [(&str, &[&str]); 4] = [
    ("study", &["evaluation::comparison", "evaluation::tables"]),
    (
        "study",
        &[
            "skills::catches",
            "skills::drill",
            "skills::kicks",
            "skills::placement",
            "skills::save",
            "skills::story",
        ],
    ),
    ("onetwo", &["evaluate::merge", "evaluate::report", "evaluate::work"]),
    ("match-tests", &["oracle::library", "oracle::walk"]),
];
