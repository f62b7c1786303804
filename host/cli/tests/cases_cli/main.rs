//! `cases_cli`: black-box tests of `onetwo cases` against docs/case-format.md §1–§5.

mod common;
mod explain;
mod inspect;
mod learn;
mod new;
mod oracle;
mod play;
mod render;
mod retrieve;
mod schema;
mod survey;
