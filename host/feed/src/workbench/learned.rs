//! `learned`: what `onetwo cases learn` has left beside a library, its evidence and its report, and the
//! changes that the author has refused.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use case_tools::Files;
use serde_json::{Value, json};
use study::learning::{
    CaseEvidence, Edit, Evidence, REFUSALS, Variant, edit_in, proposals_in, read_refusals, refusals_to_jsonl,
};

/// Longest file that is read, bytes.
const LEN_MAX: u64 = 1 << 28;

/// Evidence and proposals of a case. The files lie where `cases learn --out DIR` puts them: beside the
/// directory of the league, or in it.
pub(super) fn of_case(library: Option<&Path>, files: &Files, case: &str) -> Result<Value, String> {
    let Some(directory) = library else { return Err(super::NO_DIRECTORY.to_owned()) };
    let evidence = found(directory, "evidence.jsonl");
    let report = found(directory, REPORT_FILE);
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
    let refused = refusals(directory)?;
    let proposals = report.map(|path| {
        proposals_in(&read(&path)?, files, case, &refused)
            .map_err(|error| unreadable(&path, &error.to_string()))
    });
    Ok(json!({ "told": told.transpose()?, "proposals": proposals.transpose()? }))
}

/// The changes that the author of the library in `directory` has refused.
pub fn refusals(directory: &Path) -> Result<BTreeSet<Edit>, String> {
    found(directory, REFUSALS).map_or_else(
        || Ok(BTreeSet::new()),
        |path| read_refusals(&read(&path)?).map_err(|what| unreadable(&path, &what)),
    )
}

/// Refuses the change of `case` with these words in the report, or takes the refusal back. The list lies
/// beside the report; it is replaced whole.
pub(super) fn refuse(library: Option<&Path>, case: &str, words: &str, refuses: bool) -> Result<(), String> {
    let directory = library.ok_or(super::NO_DIRECTORY)?;
    let report = found(directory, REPORT_FILE)
        .ok_or_else(|| format!("there is no {REPORT_FILE} beside the library"))?;
    let edit =
        edit_in(&read(&report)?, case, words).map_err(|error| unreadable(&report, &error.to_string()))?;
    let edit = edit.ok_or("the report has no such change: look again at what learning has found")?;
    let mut refused = refusals(directory)?;
    let changed = if refuses { refused.insert(edit) } else { refused.remove(&edit) };
    if !changed {
        return Ok(());
    }
    let file = found(directory, REFUSALS).unwrap_or_else(|| report.with_file_name(REFUSALS));
    let failed = |error: std::io::Error| format!("{REFUSALS} cannot be written: {error}");
    foreign::replace(&file, refusals_to_jsonl(&refused).as_bytes()).map_err(failed)
}

const REPORT_FILE: &str = "report.json";

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
