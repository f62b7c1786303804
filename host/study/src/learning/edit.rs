//! `edit`: one edit to one case file of a library, or to one setting of its retrieval, as data; the
//! workbench's editor changes the text. mm.

use std::fmt;

use case_tools::workbench::{CaseText, Edit as TextEdit, EditError as TextError, Part};
use case_tools::{Files, SourceFile};
use casebase::Presence;
use serde::{Deserialize, Serialize};

/// Change of a case file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// Radii of the ball's scope.
    BallScope([i32; 2]),
    /// Radii of an opponent's scope, by its number from 0.
    OpponentScope(usize, [i32; 2]),
    /// Demand of an opponent's scope, by its number from 0.
    OpponentPresence(usize, Presence),
    /// One more opponent, with the radii of its scope and what that demands.
    AddOpponent([i32; 2], [i32; 2], Presence),
    /// A robot's position, by its number from 0.
    Position(usize, [i32; 2]),
    /// A robot's action, both numbered from 0, in TOML; one behind the last is added.
    Action(usize, usize, String),
    /// The file is deleted.
    Forget,
    /// A new file with this text.
    New(String),
    /// A setting of retrieval, by name and value (docs/case-format.md §3.2); no file changes.
    Setting(String, String),
}

/// Name in place of a case's in edits of settings.
pub const RETRIEVAL: &str = "retrieval";

/// One change to one case file, or to one setting.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Edit {
    /// `region/name` of the case; [`RETRIEVAL`] for a setting.
    pub case: String,
    /// Change of its file.
    pub change: Change,
}

/// Refusal of an edit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{case}: {what}")]
pub struct EditError {
    /// `region/name` of the case.
    pub case: String,
    /// Missing or wrong part.
    pub what: String,
}

impl fmt::Display for Edit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let case = &self.case;
        match &self.change {
            Change::BallScope([x, y]) => write!(f, "{case}: ball scope [{x}, {y}]"),
            Change::OpponentScope(n, [x, y]) => write!(f, "{case}: scope of opponent {} [{x}, {y}]", n + 1),
            Change::OpponentPresence(n, presence) => {
                write!(f, "{case}: opponent {} {}", n + 1, presence.label())
            }
            Change::AddOpponent([x, y], [a, b], presence) => {
                write!(f, "{case}: opponent at [{x}, {y}], scope [{a}, {b}], {}", presence.label())
            }
            Change::Position(n, [x, y]) => write!(f, "{case}: tm{} at [{x}, {y}]", n + 1),
            Change::Action(n, i, action) => write!(f, "{case}: action {} of tm{} is {action}", i + 1, n + 1),
            Change::Forget => write!(f, "{case}: forgotten"),
            Change::New(_) => write!(f, "{case}: new"),
            Change::Setting(name, value) => write!(f, "{case}: {name}={value}"),
        }
    }
}

impl Edit {
    /// Whether the problems themselves change, not retrieval's answers to them: robots look ahead over
    /// another time.
    pub(crate) fn changes_problems(&self) -> bool {
        matches!(&self.change, Change::Setting(name, _) if name == "lookahead")
    }

    /// The library's files after the edit.
    pub fn apply(&self, files: &Files) -> Result<Files, EditError> {
        let file = files.cases.iter().find(|file| file.name == self.case);
        match (&self.change, file) {
            (Change::Setting(..), _) => Ok(files.clone()),
            (Change::New(text), None) => Ok(files.with(&self.case, text)),
            (Change::New(_), Some(_)) => Err(self.error("the library has a case of this name; take another")),
            (_, None) => Err(self.error("no such case; `onetwo cases list` names them")),
            (Change::Forget, Some(_)) => Ok(files.without(&self.case)),
            (Change::BallScope(radii), Some(file)) => {
                self.rewritten(files, file, &TextEdit::Scope { part: Part::Ball, radii: *radii })
            }
            (Change::OpponentScope(n, radii), Some(file)) => {
                self.rewritten(files, file, &TextEdit::Scope { part: Part::Opponent(n + 1), radii: *radii })
            }
            (Change::OpponentPresence(n, presence), Some(file)) => {
                let edit = TextEdit::Presence { opponent: n + 1, presence: *presence };
                self.rewritten(files, file, &edit)
            }
            (Change::AddOpponent(at, scope, presence), Some(file)) => {
                let added = self.rewritten(files, file, &TextEdit::AddOpponent { at: *at, scope: *scope })?;
                let file = added.cases.iter().find(|file| file.name == self.case).unwrap_or(file);
                let case = CaseText::read(&file.text).map_err(|error| self.error(error.to_string()))?;
                let edit = TextEdit::Presence { opponent: case.opponents(), presence: *presence };
                self.rewritten(&added, file, &edit)
            }
            (Change::Position(n, at), Some(file)) => {
                self.rewritten(files, file, &TextEdit::Move { part: Part::Robot(n + 1), to: *at })
            }
            (Change::Action(n, index, action), Some(file)) => {
                let action = action.parse().map_err(|error: TextError| self.error(error.to_string()))?;
                let case = CaseText::read(&file.text).map_err(|error| self.error(error.to_string()))?;
                let (robot, number) = (n + 1, index + 1);
                let edit = if case.actions(robot).len() == *index {
                    TextEdit::AddAction { robot, number, action }
                } else {
                    TextEdit::SetAction { robot, number, action }
                };
                self.rewritten(files, file, &edit)
            }
        }
    }

    fn rewritten(&self, files: &Files, file: &SourceFile, edit: &TextEdit) -> Result<Files, EditError> {
        let text = edit.apply(&file.text).map_err(|error| self.error(error.to_string()))?;
        Ok(files.with(&self.case, &text))
    }

    fn error(&self, what: impl Into<String>) -> EditError {
        EditError { case: self.case.clone(), what: what.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# why\nintent = \"x\" # kept\ndefending = \"yellow\"\nball = { at = [1, 2], scope = [900, 700] }\n\n\
                        [[teammates]]\nat = [0, 2]\ngameplay = [\"get_ball\", { kick = \"goal\" }]\n\n\
                        [[opponents]]\nat = [500, 2]\nscope = [300, 200]\n";

    fn edited(change: Change) -> String {
        let files = Files::from_texts("l", "", &[("a/b", TEXT), ("a/c", TEXT)]);
        let edit = Edit { case: "a/b".to_owned(), change };
        let after = edit.apply(&files).unwrap();
        assert_eq!(after.cases.last().unwrap().text, TEXT, "another file");
        after.cases[0].text.clone()
    }

    #[test]
    fn an_edit_changes_its_value_and_nothing_else() {
        let cases = [
            (Change::BallScope([600, 500]), "scope = [900, 700]", "scope = [600, 500]"),
            (Change::OpponentScope(0, [9, 8]), "scope = [300, 200]", "scope = [9, 8]"),
            (
                Change::OpponentPresence(0, Presence::Required),
                "scope = [300, 200]",
                "scope = [300, 200]\npresence = \"required\"",
            ),
            (
                Change::AddOpponent([600, 0], [500, 400], Presence::Excluded),
                "scope = [300, 200]\n",
                "scope = [300, 200]\n\n[[opponents]]\nat = [600, 0]\nscope = [500, 400]\npresence = \"excluded\"\n",
            ),
            (Change::Position(0, [-5, 6]), "at = [0, 2]", "at = [-5, 6]"),
            (
                Change::Action(0, 1, "{ kick = \"left\" }".to_owned()),
                "{ kick = \"goal\" }",
                "{ kick = \"left\" }",
            ),
            (
                Change::Action(0, 2, "\"wait\"".to_owned()),
                "{ kick = \"goal\" }]",
                "{ kick = \"goal\" }, \"wait\"]",
            ),
        ];
        for (change, old, new) in cases {
            assert_eq!(edited(change), TEXT.replace(old, new));
        }
    }

    #[test]
    fn what_is_missing_is_refused_with_the_cases_name() {
        let files = Files::from_texts("l", "", &[("a/b", TEXT)]);
        let refused = |case: &str, change| Edit { case: case.to_owned(), change }.apply(&files).unwrap_err();
        assert!(refused("a/z", Change::Forget).to_string().starts_with("a/z: no such case"));
        for change in [
            Change::OpponentScope(1, [1, 1]),
            Change::Position(1, [1, 1]),
            Change::Action(0, 3, "\"wait\"".to_owned()),
            Change::Action(0, 0, "{".to_owned()),
            Change::New(TEXT.to_owned()),
        ] {
            assert_eq!(refused("a/b", change).case, "a/b");
        }
    }
}
