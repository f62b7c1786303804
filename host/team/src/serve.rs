//! `serve`: a strategy as a program: reads views from standard input and writes answers to standard output.

use std::io::{self, BufRead, Write};

use crate::{Strategy, StrategyView};

/// Answers views until standard input ends. Standard output belongs to the answers: print to standard error.
pub fn serve(strategy: &mut impl Strategy) -> io::Result<()> {
    serve_lines(strategy, io::stdin().lock(), io::stdout().lock())
}

/// The same over any lines.
pub fn serve_lines(strategy: &mut impl Strategy, views: impl BufRead, mut out: impl Write) -> io::Result<()> {
    for view in views.lines() {
        let answer = answers(strategy, &view?)?;
        writeln!(out, "{answer}")?;
        out.flush()?;
    }
    Ok(())
}

/// The answer to one line.
pub fn answers(strategy: &mut impl Strategy, view: &str) -> io::Result<String> {
    let view: StrategyView = serde_json::from_str(view)?;
    if view.version != StrategyView::VERSION {
        let error =
            format!("views are of version {}, this team reads {}", view.version, StrategyView::VERSION);
        return Err(io::Error::other(error));
    }
    Ok(serde_json::to_string(&strategy.answer(&view))?)
}
