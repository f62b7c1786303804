//! `save`: writes a case file into a library: within its directory, whole or not at all, and never over a
//! text that the author has not seen.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use case_tools::Severity;
use case_tools::workbench::{Sheet, is_case_name};

/// Writes the text of a sheet; `over` is the text that it replaces.
pub(super) fn save(directory: &Path, sheet: &Sheet, over: Option<&str>) -> Result<(), String> {
    if !is_case_name(&sheet.name) {
        return Err(super::NAME_FORM.to_owned());
    }
    let error = Severity::Error.to_string();
    if let Some(finding) = sheet.findings.iter().find(|finding| finding.severity == error) {
        let (line, message, hint) = (finding.line, &finding.message, &finding.hint);
        return Err(format!("a faulty case would refuse the whole library: line {line}: {message}; {hint}"));
    }
    let failed = |error: std::io::Error| format!("{}.toml cannot be written: {error}", sheet.name);
    let file = directory.join(format!("{}.toml", sheet.name));
    let region = file.parent().ok_or_else(|| super::NAME_FORM.to_owned())?;
    fs::create_dir_all(region).map_err(failed)?;
    // A region may be a link to elsewhere.
    let inside =
        region.canonicalize().map_err(failed)?.starts_with(directory.canonicalize().map_err(failed)?);
    let is_link = fs::symlink_metadata(&file).is_ok_and(|data| data.is_symlink());
    if !inside || is_link {
        return Err(format!("{}.toml lies outside the library: nothing is written there", sheet.name));
    }
    match fs::read_to_string(&file) {
        Ok(text) if Some(text.as_str()) == over => {}
        Ok(_) if over.is_some() => {
            return Err(format!(
                "{}.toml was changed meanwhile: open it again, or save under another name",
                sheet.name
            ));
        }
        Ok(_) => return Err(format!("{EXISTS}: {}; save over it, or under another name", sheet.name)),
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(failed(error)),
    }
    foreign::replace(&file, sheet.text.as_bytes()).map_err(failed)
}

/// Start of the refusal to save over a case.
const EXISTS: &str = "there is a case of that name";
