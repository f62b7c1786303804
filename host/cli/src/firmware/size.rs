//! `onetwo firmware size`: resource usage of firmware images. Flash and RAM by crate and by symbol, statics
//! that hold RAM for good, the deepest stack and the worst step under QEMU, each against the budgets of
//! docs/architecture.md §9 and as a share of three robots' computers.

use std::fmt::Write as _;

use clap::Args;
use firmware_build::inspect::{Budget, Chip, STACK_BUDGET, STEP_BUDGET, SizePart, Sizes};
use firmware_build::{ImageBody, Program};
use serde::Serialize;

use super::measure::{Measured, measure};
use super::{ImagesArgs, build, sizes_of};
use crate::Failure;
use crate::args::parsers;
use crate::output::print_text;

/// Output format of the sizes.
#[derive(Debug, Args)]
pub(crate) struct SizeArgs {
    #[command(flatten)]
    images: ImagesArgs,
    /// Number of crates and symbols to list.
    #[arg(long, default_value_t = 20, value_name = "N")]
    largest: usize,
    /// Inspect the files only: no QEMU, so neither stack nor worst step.
    #[arg(long)]
    still: bool,
    /// Simulated seconds of the match that robots on wheels are measured in.
    #[arg(long, default_value_t = 5.0, value_name = "SECONDS", value_parser = parsers::measured_seconds, conflicts_with = "still")]
    seconds: f64,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

/// All measurements of a firmware image.
pub(super) struct Known {
    pub(super) program: Program,
    pub(super) sizes: Sizes,
    pub(super) measured: Option<Measured>,
}

impl Known {
    /// Builds and inspects the program; plays for this number of seconds, or not at all.
    pub(super) fn of(program: Program, seconds: Option<f64>) -> Result<Self, Failure> {
        let sizes = sizes_of(&build(program)?)?;
        let measured = seconds.map(|seconds| measure(program, seconds)).transpose()?.flatten();
        Ok(Self { program, sizes, measured })
    }

    /// In percent of that computer.
    pub(super) fn share(&self, chip: &Chip) -> Share {
        let share = |part: u64, all: u64| (1e4 * part as f64 / all as f64).round() / 100.0;
        let taken = self.sizes.ram + self.measured.map_or(0, |measured| u64::from(measured.stack));
        // On a chip without flash the program itself is loaded into RAM.
        let ram = if chip.flash.is_some() { taken } else { self.sizes.flash + taken };
        let step = self.measured.zip(self.steps_a_second());
        Share {
            name: chip.name,
            flash: chip.flash.map(|flash| share(self.sizes.flash, flash)),
            ram: share(ram, chip.ram),
            step: step.map(|(measured, steps)| share(u64::from(measured.worst) * steps, chip.clock)),
        }
    }

    /// The limits of its board's manifest, else those of a robot's firmware.
    pub(super) fn budget(&self) -> Budget {
        let firmware = match self.program {
            Program::Board(board) | Program::More(board, _) => board.firmware.as_ref(),
            _ => None,
        };
        firmware.map_or(Budget::IMAGE, |firmware| Budget { flash: firmware.flash, ram: firmware.ram })
    }

    /// Steps of its brain in a second (docs/architecture.md §2.3).
    fn steps_a_second(&self) -> Option<u64> {
        match self.program {
            Program::Robot(ImageBody::Legged) => Some(25),
            Program::Robot(ImageBody::Omni) | Program::Free => Some(100),
            _ => None,
        }
    }
}

/// Shares of a computer in percent.
#[derive(Serialize)]
pub(super) struct Share {
    pub(super) name: &'static str,
    pub(super) flash: Option<f64>,
    /// Statics and the deepest stack.
    pub(super) ram: f64,
    /// Of its time, if every step were the worst and every instruction took one cycle.
    pub(super) step: Option<f64>,
}

/// A firmware image in `size --json`.
#[derive(Serialize)]
struct SizeJson<'a> {
    image: &'a str,
    flash: u64,
    ram: u64,
    stack: Option<u32>,
    step: Option<StepJson>,
    budget: BudgetJson,
    chips: Vec<Share>,
    crates: Vec<PartJson<'a>>,
    symbols: Vec<PartJson<'a>>,
    pools: Vec<PoolJson<'a>>,
}

#[derive(Serialize)]
struct StepJson {
    median: u32,
    worst: u32,
    steps: usize,
}

#[derive(Serialize)]
struct BudgetJson {
    flash: u64,
    ram: u64,
    stack: u32,
    step: u32,
}

#[derive(Serialize)]
struct PartJson<'a> {
    name: &'a str,
    flash: u64,
    ram: u64,
}

#[derive(Serialize)]
struct PoolJson<'a> {
    name: &'a str,
    owner: &'a str,
    ram: u64,
}

impl<'a> From<&'a SizePart> for PartJson<'a> {
    fn from(part: &'a SizePart) -> Self {
        Self { name: &part.name, flash: part.flash, ram: part.ram }
    }
}

pub(super) fn run(args: &SizeArgs) -> Result<(), Failure> {
    let seconds = (!args.still).then_some(args.seconds);
    let images: Vec<_> = args.images.programs();
    let all: Vec<_> =
        images.into_iter().map(|program| Known::of(program, seconds)).collect::<Result<_, Failure>>()?;
    if args.json {
        let data: Vec<_> = all.iter().map(|known| json(known, args.largest)).collect();
        return print_text(&(serde_json::to_string_pretty(&data)? + "\n"));
    }
    let mut text = String::new();
    for known in &all {
        write_sizes(known, args.largest, &mut text);
    }
    print_text(&text)
}

fn json(known: &Known, largest: usize) -> SizeJson<'_> {
    let sizes = &known.sizes;
    SizeJson {
        image: known.program.name(),
        flash: sizes.flash,
        ram: sizes.ram,
        stack: known.measured.map(|measured| measured.stack),
        step: known.measured.map(|Measured { median, worst, steps, .. }| StepJson { median, worst, steps }),
        budget: BudgetJson {
            flash: known.budget().flash,
            ram: known.budget().ram,
            stack: STACK_BUDGET,
            step: STEP_BUDGET,
        },
        chips: Chip::ALL.iter().map(|chip| known.share(chip)).collect(),
        crates: sizes.crates.iter().take(largest).map(PartJson::from).collect(),
        symbols: sizes.symbols.iter().take(largest).map(PartJson::from).collect(),
        pools: sizes
            .pools(POOL_LEAST)
            .into_iter()
            .map(|(owner, part)| PoolJson { name: &part.name, owner, ram: part.ram })
            .collect(),
    }
}

/// The remark on a number that is over its budget.
const fn over(is_over: bool) -> &'static str {
    if is_over { "; over its budget" } else { "" }
}

fn write_sizes(known: &Known, largest: usize, text: &mut String) {
    let Known { program, sizes, measured } = known;
    let Budget { flash, ram } = known.budget();
    let over_size = over(known.budget().check(sizes).is_err());
    let name = program.name();
    let _ = writeln!(
        text,
        "{name}: {} of {flash} B flash, {} of {ram} B RAM before the stack{over_size}",
        sizes.flash, sizes.ram
    );
    if let Some(Measured { stack, median, worst, steps }) = measured {
        let _ = writeln!(text, "  deepest stack {stack} of {STACK_BUDGET} B{}", over(*stack > STACK_BUDGET));
        let _ = writeln!(
            text,
            "  worst of {steps} steps {worst} of {STEP_BUDGET} instructions, median {median}{}",
            over(*worst > STEP_BUDGET)
        );
    }
    for chip in &Chip::ALL {
        let Share { name, flash, ram, step } = known.share(chip);
        let of = |share: Option<f64>| share.map_or_else(|| "–".to_owned(), |share| format!("{share:.2} %"));
        let (flash, step) = (of(flash), of(step));
        let _ = writeln!(text, "  {name:<12} flash {flash:>8}, RAM {ram:6.2} %, time {step:>8}");
    }
    for (title, parts) in [("crate", &sizes.crates), ("symbol", &sizes.symbols)] {
        let _ = writeln!(text, "  {:>7} {:>6}  {title}", "flash", "RAM");
        for part in parts.iter().take(largest) {
            let _ = writeln!(text, "  {:7} {:6}  {}", part.flash, part.ram, part.name);
        }
    }
    let _ = writeln!(text, "  {:>7} {:>6}  static of {POOL_LEAST} B or more, and its owner", "", "RAM");
    for (owner, part) in sizes.pools(POOL_LEAST) {
        let _ = writeln!(text, "  {:7} {:6}  {} ({owner})", "", part.ram, part.name);
    }
}

/// Least size of a static that is listed, bytes: smaller ones are flags and counters.
pub(super) const POOL_LEAST: u64 = 256;
