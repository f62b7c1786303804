//! `citations`: tests: everything that comments and documents cite is in the repository. Sections, marks of
//! the papers, links, files, commands, tests and the glossary's names.
//!
//! A citation is text, so no other check notices when its target moves. Every finding names file and line.

mod commands;
mod glossary;
mod links;
mod prose;
mod sections;

use match_tests::workspace::{Finding, Source, rust_sources, text_sources};

use links::Files;

#[test]
fn every_cited_section_exists() {
    let sections = sections::Sections::read();
    check(&text_sources(), |source| sections.dangling(source));
}

#[test]
fn every_cited_mark_of_the_papers_exists() {
    let marks = sections::Marks::read();
    check(&rust_sources(), |source| marks.dangling(source));
}

#[test]
fn nothing_cites_what_is_not_in_the_repository() {
    check(&text_sources(), sections::outside);
}

#[test]
fn every_relative_link_leads_somewhere() {
    check(&documents(), |source| links::dangling(source, &Files));
}

#[test]
fn every_file_that_is_named_exists_and_holds_what_is_named_in_it() {
    check(&text_sources(), |source| links::missing_files(source, &Files));
}

#[test]
fn every_command_that_is_named_can_be_given() {
    let known = commands::Known::read();
    check(&text_sources(), |source| known.unknown(source));
}

#[test]
fn every_page_opens_with_a_summary_and_is_in_the_index() {
    let index = sections::page("docs/README.md").text;
    check(&documents(), |source| {
        let mut findings = Vec::new();
        if !links::opens_with_a_summary(&source.text) {
            findings.push(source.at(1, "no summary", "open with `# Title`, a blank line and a paragraph"));
        }
        let listed = source
            .path
            .strip_prefix("docs/")
            .is_none_or(|name| name == "README.md" || index.contains(&format!("]({name})")));
        if !listed {
            findings.push(source.at(1, "not in docs/README.md", "link it there"));
        }
        findings
    });
}

#[test]
fn every_term_stands_once_in_the_glossary_and_names_what_exists() {
    let page = sections::page("docs/glossary.md");
    check(&[page], |source| glossary::faults(source, &glossary::Names::read()));
}

#[test]
fn every_item_of_a_crate_that_a_document_names_exists() {
    let names = glossary::Names::read();
    check(&documents(), |source| glossary::unknown(source, &names));
}

#[test]
fn the_version_to_cite_is_the_workspaces() {
    let version = |path: &str, begin: &str| {
        let text = sections::page(path).text;
        let line = text.lines().find_map(|line| line.strip_prefix(begin));
        line.unwrap_or_default().trim_matches('"').to_owned()
    };
    assert_eq!(version("CITATION.cff", "version: "), version("Cargo.toml", "version = "));
}

/// Markdown files, without the issue templates.
fn documents() -> Vec<Source> {
    text_sources()
        .into_iter()
        .filter(is_document)
        .filter(|source| !source.path.starts_with(".github/"))
        .collect()
}

fn is_document(source: &Source) -> bool {
    std::path::Path::new(&source.path).extension().is_some_and(|extension| extension == "md")
}

fn check(sources: &[Source], rule: impl Fn(&Source) -> Vec<Finding>) {
    assert!(!sources.is_empty(), "nothing to look at");
    let findings: Vec<_> = sources.iter().flat_map(rule).map(|finding| finding.to_string()).collect();
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
}
