//! `commands`: commands in documents and comments: verbs and flags of `onetwo`, of `cargo xtask`, and cargo's
//! own with their packages, tests and examples.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use match_tests::workspace::{Finding, Source, members, root, rust_sources};

use crate::prose::Quoted;
use crate::sections::page;

pub(crate) struct Known {
    /// Verbs of the program, each with the verbs below it.
    verbs: BTreeMap<String, BTreeSet<String>>,
    /// The program's sources, which contain its flags.
    program: String,
    /// Steps of `cargo xtask test`.
    steps: BTreeSet<String>,
    /// The other commands of xtask, with all their arguments.
    tasks: Vec<String>,
    /// The source that contains their flags.
    xtask: String,
    packages: BTreeMap<String, String>,
}

impl Known {
    /// Reads them from the present sources and directories.
    pub(crate) fn read() -> Self {
        let below = |path: &str, name: &str| variants(&page(path).text, name);
        let mut verbs: BTreeMap<_, _> =
            below("host/cli/src/verbs.rs", "Verb").into_iter().map(|verb| (verb, BTreeSet::new())).collect();
        for (verb, path, name) in [
            ("cases", "host/cli/src/cases/mod.rs", "CasesVerb"),
            ("firmware", "host/cli/src/firmware/mod.rs", "FirmwareVerb"),
            ("evaluate", "host/cli/src/evaluate/mod.rs", "EvaluateVerb"),
            ("robot", "host/cli/src/robot/mod.rs", "RobotVerb"),
        ] {
            verbs.insert(verb.to_owned(), below(path, name));
        }
        let steps = page("xtask/src/steps.rs").text;
        let tasks = page("xtask/src/tasks.rs").text;
        let own = |source: &&Source| source.path.starts_with("host/cli/src/");
        Self {
            verbs,
            program: rust_sources().iter().filter(own).map(|source| source.text.as_str()).collect(),
            steps: after(&steps, "name: ").collect(),
            tasks: after(&tasks, "task(").chain(after(&tasks, "handed_on(")).collect(),
            xtask: tasks + &page("xtask/src/main.rs").text,
            packages: members().into_iter().map(|crate_| (crate_.package, crate_.directory)).collect(),
        }
    }

    /// Commands that do not exist.
    pub(crate) fn unknown(&self, source: &Source) -> Vec<Finding> {
        let Quoted { spans, fenced } = Quoted::of(source);
        let commands = spans.iter().chain(&fenced);
        let faults = commands.filter_map(|(line, command)| {
            let fault = self.fault(command)?;
            Some(source.at(*line, &format!("`{}`: {fault}", command.trim()), "name a command that there is"))
        });
        faults.collect()
    }

    /// What is wrong with a command; `None` for a valid one, and for text that is no command.
    fn fault(&self, command: &str) -> Option<String> {
        let ends = |label: &&str| !matches!(*label, "|" | ">" | "<" | "&&" | ";" | "#" | "\\" | "…");
        let arguments: Vec<_> =
            command.split_whitespace().skip_while(|word| *word == "$").take_while(ends).collect();
        match arguments.as_slice() {
            ["onetwo", rest @ ..] => self.of_program(rest),
            // A command that continues with `…` names several.
            ["cargo", "xtask", rest @ ..] if command.contains('…') && self.begins(&rest.join(" ")) => None,
            ["cargo", "xtask", rest @ ..] => self.of_xtask(rest),
            ["cargo", "run" | "test", rest @ ..] => {
                let (own, program) = match rest.iter().position(|word| *word == "--") {
                    Some(at) => (&rest[..at], Some(&rest[at + 1..])),
                    None => (rest, None),
                };
                let fault = self.of_cargo(own);
                let runs_program = arguments[1] == "run" && !own.contains(&"-p");
                fault.or_else(|| {
                    program.filter(|_| runs_program).and_then(|arguments| self.of_program(arguments))
                })
            }
            _ => None,
        }
    }

    fn of_program(&self, arguments: &[&str]) -> Option<String> {
        let (verb, rest) = arguments.split_first()?;
        if verb.starts_with('-') {
            return (!matches!(*verb, "--version" | "--help")).then(|| format!("no flag `{verb}`"));
        }
        let Some(below) = self.verbs.get(*verb) else { return Some(format!("no verb `{verb}`")) };
        let next = rest.first().filter(|word| word.chars().all(|c| c.is_ascii_lowercase()));
        if let Some(next) = next.filter(|next| !below.is_empty() && !below.contains(**next)) {
            return Some(format!("`{verb}` has no verb `{next}`"));
        }
        let known = |flag: &str| {
            let field = format!("{}:", flag.replace('-', "_"));
            flag == "help" || self.program.contains(&field) || self.program.contains(&format!("\"{flag}\""))
        };
        unknown_flag(rest, known)
    }

    fn begins(&self, line: &str) -> bool {
        self.tasks.iter().any(|task| task.starts_with(&format!("{line} ")))
    }

    fn of_xtask(&self, arguments: &[&str]) -> Option<String> {
        match arguments {
            [] => None,
            ["test", rest @ ..] => {
                let chosen = rest.windows(2).filter(|pair| pair[0] == "--only").map(|pair| pair[1]);
                let placeholder = |step: &&str| step.chars().all(|c| c.is_ascii_uppercase());
                let mut chosen = chosen.filter(|step| !placeholder(step));
                let unknown = chosen.find(|step| !self.steps.contains(*step));
                let unknown = unknown.map(|step| format!("no step `{step}`"));
                unknown.or_else(|| unknown_flag(rest, |flag| matches!(flag, "only" | "list")))
            }
            _ => {
                let line = arguments.join(" ");
                let named = |task: &&String| {
                    line.strip_prefix(task.as_str())
                        .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
                };
                let Some(task) = self.tasks.iter().find(named) else {
                    return Some(format!("no command `{line}`"));
                };
                let rest = &arguments[task.split(' ').count()..];
                unknown_flag(rest, |flag| self.xtask.contains(&format!("--{flag}")))
            }
        }
    }

    /// Packages, tests and examples of cargo's own arguments.
    fn of_cargo(&self, arguments: &[&str]) -> Option<String> {
        let value = |flag: &str| arguments.windows(2).find(|pair| pair[0] == flag).map(|pair| pair[1]);
        let placeholder = |name: &str| name.chars().all(|c| c.is_ascii_uppercase());
        let package = value("-p").or_else(|| value("--package")).filter(|name| !placeholder(name));
        let package = package?;
        let Some(directory) = self.packages.get(package) else {
            return Some(format!("no package `{package}`"));
        };
        for (flag, sub) in [("--test", "tests"), ("--example", "examples"), ("--bench", "benches")] {
            let Some(name) = value(flag).filter(|name| !placeholder(name) && !name.contains('*')) else {
                continue;
            };
            let there = |path: String| root().join(directory).join(sub).join(path).is_file();
            if !there(format!("{name}.rs")) && !there(format!("{name}/main.rs")) {
                return Some(format!("{} has no `{name}`", Path::new(directory).join(sub).display()));
            }
        }
        None
    }
}

fn unknown_flag(arguments: &[&str], known: impl Fn(&str) -> bool) -> Option<String> {
    let flags = arguments.iter().filter_map(|argument| argument.strip_prefix("--"));
    let names = flags.map(|flag| flag.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').next());
    let mut names = names.map(Option::unwrap_or_default).filter(|flag| !flag.is_empty());
    names.find(|flag| !known(flag)).map(|flag| format!("no flag `--{flag}`"))
}

/// The variants of an enum, as they are written on the command line.
fn variants(text: &str, name: &str) -> BTreeSet<String> {
    let body = text.split_once(&format!("enum {name} {{")).map_or("", |(_, body)| body);
    let body = body.split("\n}").next().unwrap_or_default();
    // Fields of a variant are indented deeper.
    let lines = body.lines().filter_map(|line| line.strip_prefix("    "));
    let lines = lines.filter(|line| line.starts_with(|first: char| first.is_ascii_uppercase()));
    let names = lines.filter_map(|line| line.split(|c: char| !c.is_ascii_alphanumeric()).next());
    names.map(kebab).collect()
}

fn kebab(name: &str) -> String {
    let mut label = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !label.is_empty() {
            label.push('-');
        }
        label.push(c.to_ascii_lowercase());
    }
    label
}

/// The first string after each occurrence of `begin`.
fn after<'a>(text: &'a str, begin: &'a str) -> impl Iterator<Item = String> + 'a {
    text.split(begin).skip(1).filter_map(|rest| {
        let string = rest.trim_start().strip_prefix('"')?;
        Some(string.split('"').next()?.to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verbs_steps_flags_packages_tests_and_examples_that_are_not_there_are_found() {
        let known = Known::read();
        for right in [
            "onetwo play --headless --seed 1 --json",
            "$ onetwo cases check --strict | less --x",
            "onetwo evaluate --trials 5 --out DIR",
            "onetwo evaluate merge DIR…",
            "onetwo --version",
            "cargo run --release -- trial --scenario 3 --opponents 2d",
            "cargo xtask test --only fmt --only clippy",
            "cargo xtask test --only STEP",
            "cargo xtask bench retrieval --write",
            "cargo xtask …",
            "cargo xtask bench …",
            "cargo test -p match-tests --test tidy",
            "cargo test --release -p match-tests --test qemu_*",
            "cargo run --release -p onetwo-host --example track -- --x",
            "cargo fuzz run frame",
            "play --bad",
        ] {
            assert_eq!(known.fault(right), None, "{right}");
        }
        for wrong in [
            "onetwo plays",
            "onetwo cases checks",
            "onetwo evaluate merges DIR",
            "onetwo play --headles",
            "onetwo --versions",
            "cargo run --release -- trials",
            "cargo xtask test --only format",
            "cargo xtask test --quick",
            "cargo xtask bench",
            "cargo xtask bench retrieval --writes",
            "cargo test -p match-test",
            "cargo test -p match-tests --test tidiness",
            "cargo run -p onetwo-host --example tracks",
        ] {
            assert!(known.fault(wrong).is_some(), "{wrong}");
        }
    }

    #[test]
    fn variants_are_words_of_the_command_line() {
        let text = "enum Verb {\n    /// A.\n    Play(A),\n    Cases {\n        Verb: B,\n    },\n    VirtualRobot(C),\n}\nenum X {\n    Y,\n}\n";
        assert_eq!(
            variants(text, "Verb").into_iter().collect::<Vec<_>>(),
            ["cases", "play", "virtual-robot"]
        );
    }
}
