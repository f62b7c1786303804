//! `files`: mutated files into the program's readers: cases and leagues, robot.toml, team.toml, traces and
//! logs.

use std::fs;
use std::path::Path;

use case_tools::Severity;
use hil_sim::Stream;
use host::config::TeamSettings;
use host::record::trace::Reader;
use ssl::log::LogReader;

use super::{Labels, Material, label};

/// A kind of file: its reader, and examples.
#[derive(Debug)]
struct Kind {
    read: fn(&[u8], &mut Labels),
    examples: Vec<Vec<u8>>,
}

/// Examples of every kind.
#[derive(Debug)]
pub struct Files {
    kinds: Vec<Kind>,
}

impl Files {
    /// The committed files.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read() -> Result<Self, String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let cases = root.join("casebase/library/cases/division-b");
        let logs = root.join("protocol/ssl/tests/data");
        let team = TeamSettings::default().complete().map_or_else(|_| String::new(), |team| team.to_toml());
        Ok(Self {
            kinds: vec![
                Kind { read: case, examples: below(&cases, "toml")? },
                Kind { read: robot, examples: below(&root.join("robots"), "toml")? },
                Kind { read: settings, examples: vec![team.into_bytes(), TEAM.as_bytes().to_vec()] },
                Kind { read: trace, examples: vec![super::packets::short_trace()?] },
                Kind { read: log, examples: below(&logs, "log")? },
            ],
        })
    }
}

/// The files below a directory with that ending, in the order of their paths.
fn below(directory: &Path, ending: &str) -> Result<Vec<Vec<u8>>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", directory.display());
    let mut places = Vec::new();
    let mut open = vec![directory.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|found| found == ending) {
                places.push(path);
            }
        }
    }
    places.sort();
    let read = |path| fs::read(path).map(|bytes| bytes.into_iter().take(FILE_LEN).collect()).map_err(failed);
    places.iter().map(read).collect()
}

#[expect(clippy::unnecessary_wraps, reason = "the form of every target")]
pub(super) fn play(material: &Material, recipe: &[u64], labels: &mut Labels) -> Result<u64, String> {
    let kinds: Vec<&Kind> = material.files.kinds.iter().filter(|kind| !kind.examples.is_empty()).collect();
    let mut chance = Stream::new(recipe.first().copied().unwrap_or_default(), "soak file");
    let kind = kinds[chance.whole(0, kinds.len() as u32 - 1) as usize];
    let mut bytes = pick(&kind.examples, &mut chance).clone();
    for seed in recipe {
        mutate(&mut bytes, &kind.examples, &mut Stream::new(*seed, "soak file mutated"));
    }
    (kind.read)(&bytes, labels);
    Ok(1)
}

fn pick<'a, T>(of: &'a [T], chance: &mut Stream) -> &'a T {
    &of[chance.whole(0, of.len() as u32 - 1) as usize]
}

/// One to four changes: bits, bytes, whole lines, words of numbers, the rest of another example.
fn mutate(bytes: &mut Vec<u8>, examples: &[Vec<u8>], chance: &mut Stream) {
    for _ in 0..=chance.whole(0, 3) {
        let at = chance.whole(0, bytes.len() as u32) as usize;
        match chance.whole(0, 6) {
            0 if at < bytes.len() => bytes[at] ^= 1 << chance.whole(0, 7),
            1 if at < bytes.len() => bytes[at] = chance.whole(0, 255) as u8,
            2 if chance.chance(0.2) => bytes.truncate(at),
            3 => {
                let number = *pick(&NUMBERS, chance);
                let digits = bytes[at..].iter().position(u8::is_ascii_digit).map_or(at, |found| at + found);
                let rest =
                    bytes[digits..].iter().take_while(|byte| byte.is_ascii_digit() || **byte == b'.').count();
                bytes.splice(digits..digits + rest, number.bytes());
            }
            4 => {
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
                let (from, to) = (
                    chance.whole(0, lines.len() as u32) as usize,
                    chance.whole(0, lines.len() as u32) as usize,
                );
                if let Some(line) = lines.get(from).copied() {
                    lines.insert(to, line);
                    if chance.chance(0.5) {
                        lines.remove(if to <= from { from + 1 } else { from });
                    }
                }
                *bytes = lines.concat();
            }
            5 => {
                let other = pick(examples, chance);
                bytes.truncate(at);
                bytes.extend(&other[other.len().min(at)..]);
            }
            _ => bytes.insert(at, chance.whole(0, 255) as u8),
        }
    }
}

/// A league of one case, or a league's own file.
fn case(bytes: &[u8], labels: &mut Labels) {
    let text = String::from_utf8_lossy(bytes);
    let is_league = text.contains("[field]");
    let rules = if is_league { &text } else { LEAGUE };
    let cases = if is_league { vec![] } else { vec![("center/mutated", &*text)] };
    let read = case_tools::build(&case_tools::Files::from_texts("division-b", rules, &cases));
    let findings = match &read {
        Ok(library) => &library.findings,
        Err(findings) => findings,
    };
    for finding in findings {
        let refuses = finding.severity == Severity::Error;
        labels.insert(format!("case {refuses} {}", finding.code));
    }
}

fn robot(bytes: &[u8], labels: &mut Labels) {
    match robots::Description::read("mutated", &String::from_utf8_lossy(bytes)) {
        Ok(read) => labels.extend(read.warnings().iter().map(|found| format!("robot doubt {}", found.code))),
        Err(findings) => {
            labels.extend(findings.iter().map(|found| format!("robot {}", found.code)));
        }
    }
}

fn settings(bytes: &[u8], labels: &mut Labels) {
    let read = TeamSettings::from_toml(&String::from_utf8_lossy(bytes)).and_then(TeamSettings::complete);
    labels.insert(match read {
        Ok(team) => format!("team {}", label(&team.to_toml()).len()),
        Err(error) => format!("team {}", label(&error.to_string())),
    });
}

fn trace(bytes: &[u8], labels: &mut Labels) {
    match Reader::new(bytes) {
        Ok(mut reader) => {
            let records = reader.by_ref().count();
            labels.insert(format!(
                "trace {} {:?}",
                records.min(1000) / 100,
                reader.end().map(|end| label(&format!("{end:?}")))
            ));
        }
        Err(error) => drop(labels.insert(format!("trace {}", label(&error.to_string())))),
    }
}

fn log(bytes: &[u8], labels: &mut Labels) {
    match LogReader::new(bytes) {
        Ok(mut reader) => {
            let decoded = reader.by_ref().filter(|message| message.decode().is_ok()).count();
            labels.insert(format!("log {decoded} {:?}", reader.end().map(|end| label(&end.to_string()))));
        }
        Err(error) => drop(labels.insert(format!("log {}", label(&error.to_string())))),
    }
}

/// Bytes of an example that are used: a log has megabytes.
const FILE_LEN: usize = 65_536;
/// Numbers that readers seldom see.
const NUMBERS: [&str; 10] =
    ["0", "-1", "255", "256", "65536", "4294967296", "1e39", "nan", "0.0000001", "99999999999999999999"];
/// The league of a mutated case.
const LEAGUE: &str = include_str!("../../../casebase/library/cases/division-b/league.toml");
/// A team's settings with every kind of value.
const TEAM: &str = "name = \"a\"\ncolour = \"blue\"\nleague = \"division-b\"\nkeeper = 0\nrobots = \"sim://127.0.0.1\"\n\
                    [[calibration]]\nrobot = 3\nkick = 1.06\n[ball]\nroll = 0.35\n";
