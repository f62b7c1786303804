//! `refusals`: changes that an author has refused, as they lie beside a library: an edit a line, in JSON. No
//! run of learning proposes them again.

use std::collections::BTreeSet;

use crate::learning::edit::Edit;

/// Name of the file.
pub const REFUSALS: &str = "refused.jsonl";

/// Reads the text of such a file; an error names its line.
pub fn read_refusals(text: &str) -> Result<BTreeSet<Edit>, String> {
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let edits = lines.map(|(number, line)| {
        serde_json::from_str(line)
            .map_err(|error| format!("line {number}: {error}; delete it, and refuse the change again"))
    });
    edits.collect()
}

/// The text of such a file.
pub fn refusals_to_jsonl(refused: &BTreeSet<Edit>) -> String {
    // Strings and whole numbers: it always serialises.
    refused.iter().map(|edit| serde_json::to_string(edit).unwrap_or_default() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::edit::Change;

    #[test]
    fn refusals_are_read_as_they_were_written_and_a_faulty_line_is_named() {
        let edit = |case: &str, change| Edit { case: case.to_owned(), change };
        let refused = BTreeSet::from([
            edit("front/shot", Change::Forget),
            edit("front/shot", Change::Action(0, 1, "{ kick = \"goal\" }".to_owned())),
        ]);
        let text = refusals_to_jsonl(&refused);
        assert_eq!(text.lines().count(), 2);
        assert_eq!(read_refusals(&text), Ok(refused));
        assert_eq!(read_refusals("\n"), Ok(BTreeSet::new()));
        let fault = read_refusals(&format!("{text}forget it\n")).unwrap_err();
        assert!(fault.starts_with("line 3: "), "{fault}");
    }
}
