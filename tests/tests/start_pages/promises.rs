//! `promises`: what the start pages say that their commands print, write and show: `promises.txt`. A line of
//! it is a command, as it stands after `cargo run --release -- `; those under it, after two blanks, are its
//! promises.

/// The start pages.
pub(crate) const PAGES: [&str; 3] =
    ["docs/start/league-team.md", "docs/start/cbr-researcher.md", "docs/start/embedded.md"];

pub(crate) fn blocks<'t>(text: &'t str, kind: &str) -> Vec<Vec<&'t str>> {
    let head = format!("{kind}\n");
    let blocks = text.split("```").filter_map(|block| block.strip_prefix(&head));
    blocks.map(|block| block.lines().collect()).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Promise {
    /// Its output holds this.
    Prints(&'static str),
    /// This file is there afterwards, and is not empty.
    Writes(&'static str),
    /// Its trace, the hash of a whole trial, is that of this command.
    TraceOf(&'static str),
    /// It runs until it is ended, and prints this before.
    RunsUntil(&'static str),
    /// It runs until it is ended, with a page at port 8080 on which robots move.
    Page,
}

impl Promise {
    fn parse(line: &'static str) -> Option<Self> {
        let of = |start: &str| line.strip_prefix(start);
        of("prints ")
            .map(Self::Prints)
            .or_else(|| of("writes ").map(Self::Writes))
            .or_else(|| of("has the trace of ").map(Self::TraceOf))
            .or_else(|| of("runs until ").map(Self::RunsUntil))
            .or_else(|| of("shows a page").map(|_| Self::Page))
    }

    /// Whether the command ends by itself.
    #[allow(dead_code, reason = "one of the two tests that read promises runs commands")]
    pub(crate) fn ends(self) -> bool {
        !matches!(self, Self::RunsUntil(_) | Self::Page)
    }
}

/// All commands with their promises, in the pages' order.
pub(crate) fn all() -> Vec<(&'static str, Vec<Promise>)> {
    let mut commands: Vec<(&'static str, Vec<Promise>)> = Vec::new();
    for line in include_str!("promises.txt").lines() {
        match (line.strip_prefix("  ").and_then(Promise::parse), commands.last_mut()) {
            (Some(promise), Some((_, promises))) => promises.push(promise),
            _ => commands.push((line, Vec::new())),
        }
    }
    commands
}

/// What is promised of a line of a page; empty where nothing is.
pub(crate) fn promised(line: &str) -> Vec<Promise> {
    let found = all().into_iter().find(|(command, _)| *command == command_of(line));
    found.map_or_else(Vec::new, |(_, promises)| promises)
}

/// The program's arguments in a line that runs it, otherwise the line.
pub(crate) fn command_of(line: &str) -> &str {
    line.strip_prefix("cargo run --release -- ").unwrap_or(line)
}
