//! `cases_cli`: black-box tests of `onetwo cases` against DESIGN §4 and §8.

mod common;
mod explain;
mod inspect;
mod new;
mod oracle;
mod play;
mod render;
mod retrieve;
mod schema;
mod survey;
