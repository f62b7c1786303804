//! `cases`: questions to a case library. It is opened, asked and answers as JSON, the same for the command
//! line, the page and other programs (docs/case-format.md §5.1, §5.2). mm, field frame.

mod answer;
mod explanation;
mod handle;
pub mod problem;
mod settings;
mod whatif;

pub use answer::{Answer, Found, write_line};
pub use explanation::{Explanation, NEAREST, candidate, explained_by, reason};
pub use handle::{LibraryError, LibraryHandle, league_of};
pub use settings::{Chosen, SettingFailure, described};

/// Gives `region/name` of a stored case.
pub type NameOf<'a, 'f> = &'f dyn Fn(protocol::CaseId) -> &'a str;

/// `1 robot`, `2 robots`.
pub fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
