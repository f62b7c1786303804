//! `product`: lines of the product: those of no test, example, bench or fuzz target.

use std::collections::{BTreeMap, BTreeSet};

use super::{Source, files};

/// The product's lines of one file.
pub struct Product<'s> {
    /// The file.
    pub source: &'s Source,
    /// Directory of its crate, from the workspace's root.
    pub directory: String,
    /// Lines with their numbers, from 1; comments included.
    pub lines: Vec<(usize, &'s str)>,
}

/// The product's part of these files; files of tests are left out.
pub fn product(sources: &[Source]) -> Vec<Product<'_>> {
    let mut directories: Vec<String> = files(&|path| path.ends_with("Cargo.toml"))
        .into_iter()
        .filter_map(|manifest| Some(manifest.path.strip_suffix("/Cargo.toml")?.to_owned()))
        .collect();
    // A crate may lie in another one's directory.
    directories.sort_by_key(|directory| std::cmp::Reverse(directory.len()));
    let of_tests = test_files(sources);
    let mut found = Vec::new();
    for source in sources {
        let within = |directory: &&String| source.path.starts_with(&format!("{directory}/"));
        let Some(directory) = directories.iter().find(within) else { continue };
        if of_tests.contains(source.path.as_str())
            || !is_product(&source.path[directory.len() + 1..], directory)
        {
            continue;
        }
        let lines: Vec<_> = source.text.lines().collect();
        let tests = test_items(&lines);
        let kept = (1..).zip(lines).filter(|(number, _)| !tests.iter().any(|item| item.holds(*number)));
        found.push(Product { source, directory: directory.clone(), lines: kept.collect() });
    }
    found
}

/// Number of product lines by the crate's directory.
pub fn product_lines(sources: &[Source]) -> BTreeMap<String, usize> {
    let mut counted = BTreeMap::new();
    for file in product(sources) {
        *counted.entry(file.directory).or_default() += file.lines.len();
    }
    counted
}

fn is_product(within: &str, directory: &str) -> bool {
    let folder = within.split('/').next().unwrap_or_default();
    let file = within.rsplit('/').next().unwrap_or_default();
    !TEST_CRATES.contains(&directory)
        && !matches!(folder, "tests" | "benches" | "examples")
        && !matches!(file, "tests.rs" | "test.rs")
}

/// An item for tests alone: numbers of its first and last line, and the file where it is a module of its own.
struct TestItem {
    first: usize,
    last: usize,
    file: Option<ModuleFile>,
}

/// Where a module's text lies: below the file that declares it, or at a path from that file's directory.
enum ModuleFile {
    Named(String),
    At(String),
}

impl TestItem {
    fn holds(&self, number: usize) -> bool {
        (self.first..=self.last).contains(&number)
    }
}

/// Items behind `#[cfg(test)]`, `#[cfg(all(test, …))]` and the like.
fn test_items(lines: &[&str]) -> Vec<TestItem> {
    let mut items = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let first = at;
        at += 1;
        if !is_for_tests(lines[first]) {
            continue;
        }
        while at < lines.len() && lines[at].trim_start().starts_with(['#', '/']) {
            at += 1;
        }
        let Some(line) = lines.get(at) else { break };
        let file = declared_module(line).map(|name| {
            let path =
                lines[first..at].iter().find_map(|line| line.split_once("#[path = \"")?.1.split('"').next());
            path.map_or_else(|| ModuleFile::Named(name.to_owned()), |path| ModuleFile::At(path.to_owned()))
        });
        if !line.trim_end().ends_with([';', '}']) {
            let indent = indent_of(line);
            let closes = |line: &str| line.trim_start().starts_with('}') && indent_of(line) == indent;
            at += lines[at..].iter().position(|line| closes(line)).unwrap_or(lines.len() - at - 1);
        }
        items.push(TestItem { first: first + 1, last: at + 1, file });
        at += 1;
    }
    items
}

fn indent_of(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn is_for_tests(line: &str) -> bool {
    let Some(condition) = line.trim_start().strip_prefix("#[cfg(") else { return false };
    let condition = condition.strip_prefix("all(").unwrap_or(condition);
    condition.strip_prefix("test").is_some_and(|rest| rest.starts_with([')', ',']))
}

/// The name of a module that lies in a file of its own.
fn declared_module(line: &str) -> Option<&str> {
    line.trim().strip_suffix(';')?.rsplit_once("mod ").map(|(_, name)| name)
}

/// Files of modules that are compiled for tests alone, and of the modules in them.
fn test_files(sources: &[Source]) -> BTreeSet<&str> {
    let by_path: BTreeMap<&str, &Source> =
        sources.iter().map(|source| (source.path.as_str(), source)).collect();
    let mut open = Vec::new();
    for source in sources {
        let lines: Vec<_> = source.text.lines().collect();
        let modules = test_items(&lines).into_iter().filter_map(|item| item.file);
        open.extend(modules.flat_map(|module| candidates(&source.path, &module)));
    }
    let mut found = BTreeSet::new();
    while let Some(path) = open.pop() {
        let Some((path, source)) = by_path.get_key_value(path.as_str()) else { continue };
        if found.insert(*path) {
            let modules = source.text.lines().filter_map(declared_module);
            open.extend(modules.flat_map(|name| candidates(path, &ModuleFile::Named(name.to_owned()))));
        }
    }
    found
}

/// Paths at which the text of a module may lie that this file declares.
fn candidates(path: &str, module: &ModuleFile) -> Vec<String> {
    let (directory, file) = path.rsplit_once('/').unwrap_or(("", path));
    match module {
        ModuleFile::At(path) => {
            let mut parts: Vec<_> = directory.split('/').collect();
            for part in path.split('/') {
                if part == ".." { parts.pop().map(drop).unwrap_or_default() } else { parts.push(part) }
            }
            vec![parts.join("/")]
        }
        ModuleFile::Named(name) => {
            let stem = file.trim_end_matches(".rs");
            let below = match stem {
                "mod" | "lib" | "main" => directory.to_owned(),
                _ => format!("{directory}/{stem}"),
            };
            vec![format!("{below}/{name}.rs"), format!("{below}/{name}/mod.rs")]
        }
    }
}

/// Crates that are tests as a whole.
const TEST_CRATES: [&str; 5] =
    ["tests", "tests/browser", "firmware/on-target", "firmware/nrf24/model", "protocol/fuzz"];

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(text: &str) -> Vec<usize> {
        let lines: Vec<_> = text.lines().collect();
        let tests = test_items(&lines);
        (1..=lines.len()).filter(|number| !tests.iter().any(|item| item.holds(*number))).collect()
    }

    #[test]
    fn items_behind_cfg_test_are_left_out_whatever_their_form() {
        assert_eq!(kept("a\n#[cfg(test)]\nmod tests;\nb\n"), [1, 4]);
        assert_eq!(kept("a\n#[cfg(test)]\n#[allow(x)]\nmod tests {\n    fn f() {\n    }\n}\nb\n"), [1, 8]);
        assert_eq!(kept("    #[cfg(all(test, unix))]\n    fn f() {\n        g();\n    }\n    b\n"), [5]);
        assert_eq!(kept("#[cfg(test)]\nuse a::b;\n#[cfg(testing)]\nc\n"), [3, 4]);
    }

    #[test]
    fn a_module_for_tests_takes_the_modules_below_it_along() {
        let source = |path: &str, text: &str| Source { path: path.into(), text: text.into() };
        let sources = [
            source(
                "x/src/lib.rs",
                "#[cfg(test)]\nmod a;\nmod c;\n#[cfg(test)]\n#[path = \"../d.rs\"]\nmod e;\n",
            ),
            source("x/src/a.rs", "mod b;\n"),
            source("x/src/a/b.rs", ""),
            source("x/src/c.rs", "mod b;\n"),
            source("x/src/c/b.rs", ""),
        ];
        assert_eq!(test_files(&sources).into_iter().collect::<Vec<_>>(), ["x/src/a.rs", "x/src/a/b.rs"]);
    }
}
