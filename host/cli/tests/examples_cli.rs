//! `examples_cli`: tests of the documents: every example of a command is one that the program takes, every
//! problem is answered, the first case is one that a library can have.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A fenced block of a page, with its first line's number and its language.
struct Block {
    page: PathBuf,
    line: usize,
    language: String,
    lines: Vec<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages of the documents, and the READMEs.
fn pages() -> Vec<PathBuf> {
    let (mut left, mut pages) =
        (vec![root().join("docs"), root().join("firmware"), root().join("host")], vec![]);
    while let Some(directory) = left.pop() {
        for entry in fs::read_dir(directory).expect("a directory").flatten() {
            let path = entry.path();
            if path.is_dir() {
                left.push(path);
            } else if path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path);
            }
        }
    }
    pages.push(root().join("README.md"));
    pages.sort();
    pages
}

fn blocks() -> Vec<Block> {
    let mut blocks = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let mut open: Option<Block> = None;
        for (number, line) in (1..).zip(text.lines()) {
            match (line.strip_prefix("```"), &mut open) {
                (Some(_), Some(_)) => blocks.extend(open.take()),
                (Some(language), None) => {
                    let (page, language) = (page.clone(), language.to_owned());
                    open = Some(Block { page, line: number, language, lines: Vec::new() });
                }
                (None, Some(block)) => block.lines.push(line.to_owned()),
                (None, None) => {}
            }
        }
    }
    blocks
}

/// The words after the program's name, as a shell reads them up to a comment, a pipe or a redirection; `None`
/// of a line that does not run the program.
fn arguments(line: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let (mut word, mut quote) = (None::<String>, None);
    for letter in line.trim().trim_start_matches("$ ").chars() {
        match (letter, quote) {
            ('"' | '\'', None) => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (letter, Some(open)) if letter == open => quote = None,
            ('#' | '|' | '>' | '&', None) if word.is_none() => break,
            (' ', None) => words.extend(word.take()),
            (letter, _) => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    let is_variable =
        |word: &String| word.split_once('=').is_some_and(|(name, _)| name.to_uppercase() == name);
    let words: Vec<String> = words.into_iter().skip_while(is_variable).collect();
    let by_cargo = ["cargo", "run", "--release", "--"];
    let skipped = match words.first().map(String::as_str) {
        Some("onetwo" | "target/release/onetwo") => 1,
        Some("cargo") if words.iter().zip(by_cargo).all(|(word, known)| word == known) => by_cargo.len(),
        _ => return None,
    };
    Some(words.into_iter().skip(skipped).collect())
}

fn onetwo(arguments: &[&str], input: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_onetwo"));
    program.args(arguments).current_dir(root());
    program.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = program.spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it has a stdin");
    // A program that reads nothing may have ended.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    child.wait_with_output().expect("it ends")
}

#[test]
fn every_example_of_a_command_is_one_that_the_program_takes() {
    let mut count = 0;
    for Block { page, line, lines, .. } in blocks() {
        for (number, text) in (line + 1..).zip(&lines) {
            let Some(mut arguments) = arguments(text) else { continue };
            // What stands before it is read first: an unknown flag or value is refused, and nothing is done.
            arguments.push("--help".to_owned());
            let out = onetwo(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), "");
            let stderr = String::from_utf8_lossy(&out.stderr);
            assert_eq!(out.status.code(), Some(0), "{}:{number}: {text}\n{stderr}", page.display());
            count += 1;
        }
    }
    assert!(count > 80, "{count} examples");
}

#[test]
fn every_problem_of_the_documents_is_answered() {
    let mut count = 0;
    for Block { page, line, lines, .. } in blocks() {
        let is_problem = |text: &&String| text.starts_with("{\"ball\":") && text.ends_with('}');
        for problem in lines.iter().filter(is_problem) {
            let out = onetwo(&["cases", "retrieve"], problem);
            let answer = String::from_utf8_lossy(&out.stdout).into_owned();
            let place = format!("{}:{line}: {problem}", page.display());
            assert_eq!(out.status.code(), Some(0), "{place}");
            assert!(answer.contains("\"candidates\"") && !answer.contains("\"error\""), "{place}: {answer}");
            count += 1;
        }
    }
    assert!(count > 0);
}

#[test]
fn every_case_of_the_documents_is_one_that_the_four_legged_league_takes() {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("examples-cli/four-legged");
    let league = root().join("casebase/library/cases/four-legged/league.toml");
    let mut count = 0;
    for Block { page, line, language, lines } in blocks() {
        if language != "toml" || !lines.iter().any(|text| text == "[[teammates]]") {
            continue;
        }
        let _ = fs::remove_dir_all(&directory);
        fs::create_dir_all(directory.join("center")).expect("a folder");
        fs::copy(&league, directory.join("league.toml")).expect("the league");
        fs::write(directory.join("center/example.toml"), lines.join("\n") + "\n").expect("a file");
        let out = onetwo(&["cases", "check", "--library", directory.to_str().expect("a name")], "");
        let said = String::from_utf8_lossy(&out.stdout).into_owned();
        assert_eq!(out.status.code(), Some(0), "{}:{line}: {said}", page.display());
        assert!(!said.contains("error["), "{}:{line}: {said}", page.display());
        count += 1;
    }
    assert!(count > 0);
}
