//! `manifest`: the workspace's crates and their dependencies.

use std::collections::BTreeSet;

use super::{Source, root};

/// Every crate of the workspace.
pub fn members() -> Vec<Manifest> {
    let workspace: toml::Table =
        Source::read(&root().join("Cargo.toml")).text.parse().expect("the workspace's manifest");
    let members = workspace["workspace"]["members"].as_array().expect("members");
    let members = members.iter().filter_map(|directory| directory.as_str());
    members.flat_map(directories).map(|directory| Manifest::read(&directory)).collect()
}

/// The directories of an entry of the list: itself, or for `DIRECTORY/*` the packages in it, by name.
fn directories(entry: &str) -> Vec<String> {
    let Some(above) = entry.strip_suffix("/*") else { return vec![entry.to_owned()] };
    let entries = std::fs::read_dir(root().join(above)).expect("the directory of a list's entry");
    let packages = entries.flatten().filter(|entry| entry.path().join("Cargo.toml").is_file());
    let mut all: Vec<_> =
        packages.map(|entry| format!("{above}/{}", entry.file_name().to_string_lossy())).collect();
    all.sort();
    all
}

/// A crate of the workspace, and its dependencies, except dev-dependencies.
pub struct Manifest {
    /// From the workspace's root.
    pub directory: String,
    /// Its name as a dependency and a library.
    pub name: String,
    /// Its name as a package, `cargo -p`: [`Self::name`], with `onetwo-` in front where it is a library.
    pub package: String,
    /// Crates that end up in the same program.
    pub linked: BTreeSet<String>,
    /// Those, and the dependencies of the build script.
    pub all: BTreeSet<String>,
}

impl Manifest {
    /// The manifest of the crate in this directory.
    pub fn read(directory: &str) -> Self {
        Self::from_text(directory, &Source::read(&root().join(directory).join("Cargo.toml")).text)
    }

    /// From the text of its `Cargo.toml`.
    pub fn from_text(directory: &str, text: &str) -> Self {
        let table: toml::Table =
            text.parse().unwrap_or_else(|error| panic!("{directory}/Cargo.toml: {error}"));
        let package = table["package"]["name"].as_str().unwrap_or_default().to_string();
        let name = without_prefix(&package).to_string();
        let targets =
            table.get("target").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::values);
        let tables: Vec<_> =
            std::iter::once(&table).chain(targets.filter_map(toml::Value::as_table)).collect();
        let of =
            |kind: &str| tables.iter().flat_map(|table| dependencies(table, kind)).collect::<BTreeSet<_>>();
        let linked = of("dependencies");
        let all = linked.union(&of("build-dependencies")).cloned().collect();
        Self { directory: directory.into(), name, package, linked, all }
    }
}

fn dependencies(table: &toml::Table, kind: &str) -> Vec<String> {
    let Some(entries) = table.get(kind).and_then(toml::Value::as_table) else { return vec![] };
    let name = |(key, value): (&String, &toml::Value)| {
        without_prefix(value.get("package").and_then(|p| p.as_str()).unwrap_or(key)).to_string()
    };
    entries.iter().map(name).collect()
}

/// Packages carry the project's name, so that they could be published; libraries and dependencies do not.
fn without_prefix(package: &str) -> &str {
    package.strip_prefix("onetwo-").unwrap_or(package)
}
