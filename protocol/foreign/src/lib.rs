//! `foreign`: reads files and prints text from untrusted sources. Sizes in bytes.
//!
//! - [`read`], [`read_text`] and [`open`] take regular files only: a device, pipe or socket may never end, or
//!   may never start. What is read into memory is read up to a limit.
//! - [`replace`] writes a file anew, as a whole or not at all; a link stays one, and the mode stays.
//! - [`printable`] escapes what a terminal executes instead of displaying it: control characters, and the
//!   marks that turn the direction of writing. [`Printable`] does the same to everything that is written
//!   through it, line ends aside.
//! - A [`Finding`] is what is wrong with such a file, in one line.
//!
//! **Invariants.** No input panics; nothing larger than the limit is allocated; [`printable`] changes no
//! other character.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod file;
mod finding;
mod text;

pub use file::{open, read, read_from, read_text, replace};
pub use finding::{Finding, Severity};
pub use text::{Printable, excerpt, printable, printable_path};
