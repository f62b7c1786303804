//! `evaluation`: `cargo xtask evaluation`: figures of `docs/results/evaluation.md`, and of the tables of
//! matches and skills.

use crate::context::{Context, Failure, run};

/// Plays our team against each other team, each against each, our team without or with each part of the
/// second paper, and the paper's own league, and writes `docs/results/matches.md`. Played matches are kept:
/// the same command continues after an interrupt.
pub(crate) fn write_matches(context: &Context, fresh: bool) -> Result<(), Failure> {
    for (section, description) in MATCHES {
        let line = format!(
            "evaluate matches {description} --out out/matches/{section} --markdown docs/results/matches.md --section {section}{}",
            if fresh { " --fresh" } else { "" }
        );
        run(&mut context.cargo(&format!("run --release -- {line}")))?;
    }
    Ok(())
}

/// Sections of `docs/results/matches.md`, and what is played for each: 40 matches distinguish a goal a match
/// from chance, 10 the order of teams.
const MATCHES: [(&str, &str); 5] = [
    ("opponents", "--matches 40"),
    ("round-robin", "--round-robin --matches 10"),
    ("coerce", "--team ours-with-coerce --opponents zone --matches 40"),
    ("ablations", "--ablations --matches 40"),
    ("ssl-2013", "--league ssl-2013 --matches 10"),
];

/// Tests single skills in the league's own world and in random ones, and writes the tables of
/// `docs/skills.md`.
pub(crate) fn write_skills(context: &Context) -> Result<(), Failure> {
    for (section, description) in
        [("nominal", "--tries 50"), ("random", "--world random --worlds 200 --tries 2")]
    {
        let line = format!("evaluate skills {description} --markdown docs/skills.md --section {section}");
        run(&mut context.cargo(&format!("run --release -- {line}")))?;
    }
    Ok(())
}

/// Plays the paper's evaluation and the ablations, and writes tables and plots into the documentation; the
/// complete reports, which are not committed, stay under `out`.
pub(crate) fn write(context: &Context) -> Result<(), Failure> {
    // `--fresh`: trials of an earlier uncommitted version of the program would count as its own.
    for line in [
        "evaluate --random --fresh --maps 0 --out out/evaluation",
        "evaluate report out/evaluation --markdown docs/results/evaluation.md",
        "evaluate ablations --fresh --out out/ablations --markdown docs/results/evaluation.md",
    ] {
        run(&mut context.cargo(&format!("run --release -- {line}")))?;
    }
    Ok(())
}
