//! How is something said on stdout? Whole or not at all; whoever closed it has read enough.

use std::io::{self, Write};

use crate::Failure;

/// Says it on stdout.
pub(crate) fn say(words: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(words.as_bytes()).and_then(|()| out.flush()).map_err(Failure::Output)
}
