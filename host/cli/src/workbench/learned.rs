//! `learned`: what `onetwo cases learn` has left beside a library: its evidence and its report.

use std::path::{Path, PathBuf};

use case_tools::Files;
use learning::{CaseEvidence, Evidence, Variant, proposals_in};
use serde_json::{Value, json};

/// Longest file that is read, bytes.
const LEN_MAX: u64 = 1 << 28;

/// What is known of a case. The files lie where `cases learn --out DIR` puts them: beside the directory of
/// the league, or in it.
pub(super) fn of_case(library: Option<&Path>, files: &Files, case: &str) -> Result<Value, String> {
    let Some(directory) = library else { return Err(super::NO_DIRECTORY.to_owned()) };
    let evidence = found(directory, "evidence.jsonl");
    let report = found(directory, "report.json");
    if evidence.is_none() && report.is_none() {
        let hint =
            "open a directory that `onetwo cases learn --out` has written, or copy both files beside it";
        return Err(format!("no evidence.jsonl and no report.json beside {}; {hint}", directory.display()));
    }
    let variant = Variant::new(files.clone()).map_err(|_| "the library is refused: correct it first")?;
    let told = evidence.map(|path| {
        let evidence = Evidence::from_jsonl(&read(&path)?).map_err(|what| unreadable(&path, &what))?;
        Ok::<_, String>(CaseEvidence::of(&evidence, &variant, case))
    });
    let proposals = report.map(|path| {
        proposals_in(&read(&path)?, files, case).map_err(|error| unreadable(&path, &error.to_string()))
    });
    Ok(json!({ "told": told.transpose()?, "proposals": proposals.transpose()? }))
}

fn found(directory: &Path, name: &str) -> Option<PathBuf> {
    let places = [Some(directory), directory.parent()];
    places.into_iter().flatten().map(|place| place.join(name)).find(|path| path.is_file())
}

fn read(path: &Path) -> Result<String, String> {
    foreign::read_text(path, LEN_MAX).map_err(|error| unreadable(path, &error.to_string()))
}

/// Viewers see the file's name, not where it lies.
fn unreadable(path: &Path, what: &str) -> String {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    format!("{name}: {what}")
}
