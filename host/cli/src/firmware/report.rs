//! `onetwo firmware report`: the tables of docs/firmware.md. Resource usage of the firmware, and what a robot
//! does when something breaks; written by `firmware report --write`.

use std::fmt::Write as _;

use clap::Args;
use firmware_build::inspect::{Budget, Chip, STACK_BUDGET, STEP_BUDGET};
use firmware_build::{Program, workspace_root};

use super::failsafe;
use super::size::{Known, POOL_LEAST, Share};
use crate::Failure;
use crate::args::parsers;
use crate::destination;
use crate::output::print_text;

/// Output of the report.
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Write into docs/firmware.md instead of onto stdout.
    #[arg(long)]
    write: bool,
    /// Simulated seconds of the match that robots on wheels are measured in.
    #[arg(long, default_value_t = 60.0, value_name = "SECONDS", value_parser = parsers::measured_seconds)]
    seconds: f64,
}

/// Builds, plays, and writes the report.
pub(super) fn run(args: &ReportArgs) -> Result<(), Failure> {
    let all: Vec<_> = Program::images()
        .into_iter()
        .map(|program| Known::of(program, Some(args.seconds)))
        .collect::<Result<_, Failure>>()?;
    let text = text(&all, args.seconds);
    if !args.write {
        return print_text(&text);
    }
    let path = workspace_root().join(FILE);
    Ok(destination::replace(&path, &text)?)
}

fn text(all: &[Known], seconds: f64) -> String {
    let mut text = String::from(HEAD);
    let _ = writeln!(
        text,
        "Stack and steps are those of eight trials of the first paper on legs (seed 1, one for each of its cells) and of a match of six \
         against six on wheels, {seconds:.0} s, as images under QEMU. Steps of the image that runs by its own clock are not \
         counted; its stack limit is checked by the test `qemu_free`.\n"
    );
    budgets(all, &mut text);
    text += SHARES_HEAD;
    shares(all, &mut text);
    for known in all {
        let _ = writeln!(
            text,
            "\n### {}, by crate\n\n| crate | flash, B | RAM, B |\n|---|---:|---:|",
            known.program.name()
        );
        for part in known.sizes.crates.iter().take(CRATES_NAMED) {
            let _ = writeln!(text, "| {} | {} | {} |", part.name, part.flash, part.ram);
        }
        let _ = writeln!(text, "\n| static of {POOL_LEAST} B or more | owner | RAM, B |\n|---|---|---:|");
        for (owner, part) in known.sizes.pools(POOL_LEAST) {
            let _ = writeln!(text, "| `{}` | {owner} | {} |", part.name, part.ram);
        }
    }
    text += failsafe::HEAD;
    text += &failsafe::table();
    text += failsafe::BELOW;
    text
}

fn budgets(all: &[Known], text: &mut String) {
    let Budget { flash, ram } = Budget::IMAGE;
    let _ = writeln!(
        text,
        "| image | flash, of {flash} B | RAM, of {ram} B | deepest stack, of {STACK_BUDGET} B | worst step, of {STEP_BUDGET} instructions | median step |"
    );
    *text += "|---|---:|---:|---:|---:|---:|\n";
    for Known { program, sizes, measured } in all {
        let part = |part: u64, of: u64| format!("{part} ({:.1} %)", 100.0 * part as f64 / of as f64);
        let measured = measured.map_or_else(
            || "– | – | –".to_owned(),
            |m| {
                let stack = part(m.stack.into(), STACK_BUDGET.into());
                let worst = part(m.worst.into(), STEP_BUDGET.into());
                format!("{stack} | {worst} | {}", m.median)
            },
        );
        let (flash, ram) = (part(sizes.flash, flash), part(sizes.ram, ram));
        let _ = writeln!(text, "| {} | {flash} | {ram} | {measured} |", program.name());
    }
}

fn shares(all: &[Known], text: &mut String) {
    *text += "| image | computer | flash | RAM | time |\n|---|---|---:|---:|---:|\n";
    for known in all {
        for chip in &Chip::ALL {
            let Share { name, flash, ram, step } = known.share(chip);
            let of =
                |share: Option<f64>| share.map_or_else(|| "–".to_owned(), |share| format!("{share:.2} %"));
            let _ = writeln!(
                text,
                "| {} | {name} | {} | {ram:.2} % | {} |",
                known.program.name(),
                of(flash),
                of(step)
            );
        }
    }
}

const FILE: &str = "docs/firmware.md";
/// Crates named in the report.
const CRATES_NAMED: usize = 12;
const HEAD: &str = "\
# What the robots' firmware takes, and what it does when something breaks

What the images of the robots take of flash, RAM, stack and time, and how a robot fails safe.
Written by `onetwo firmware report --write`. Held by `cargo xtask test`: flash, RAM and places that may panic by the step `image`,
stacks by the step `qemu` (`qemu_equals_native`, `qemu_wheels`, `qemu_match`, `qemu_free`), steps by `qemu_equals_native` on legs and by
`qemu_wheels` and `qemu_match` on wheels. A share above 100 % is over its budget. The table of what robots do when something breaks is
compared with this file by a test of `onetwo`; sizes and steps are those of the day they were written. What a radio frame costs stands in
[protocol](../protocol/README.md), what retrieval and motion cost in [casebase](../casebase/README.md) and
[motion](../firmware/motion/README.md); what a board is and how to add one in [boards](boards.md).

## What images take

RAM is what is taken before the program begins; the stack comes on top.

";
const SHARES_HEAD: &str = "
### Of a robot's computer

An AIBO ERS-7 (576 MHz, 64 MB, programs lie in RAM), an STM32F405 (168 MHz, 1 MiB, 192 KiB) and an STM32H743 (480 MHz, 2 MiB,
1 MiB). RAM is statics and the deepest stack. Time is that of a robot every step of which is the worst, at one instruction a cycle:
none of these has been timed, and flash that is slower than the core costs more.

";

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn the_written_table_of_what_robots_do_is_what_the_governor_does_now() {
        let path = workspace_root().join(FILE);
        let written = fs::read_to_string(&path).expect("docs/firmware.md");
        assert!(
            written.contains(&failsafe::table()),
            "{FILE} is out of date; write it again with `onetwo firmware report --write`"
        );
    }
}
