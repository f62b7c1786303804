//! Does the built `onetwo cases` do what DESIGN §4 and §8 say, seen from outside?

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
