//! `tasks`: table of xtask commands. One row per command: its name, its arguments, its effect, and its
//! function.

use std::fmt::Write as _;

use crate::context::{Context, Failure, run};
use crate::{
    bench, budgets, cost, docs, emulate, evaluation, example_cost, game_cost, page, pictures, release,
    trial_cost, wheels,
};

/// An xtask command other than `test`.
#[derive(Debug)]
pub(crate) struct Task {
    pub(crate) name: &'static str,
    /// The arguments after the name, as the usage prints them; empty where it takes none.
    pub(crate) takes: &'static str,
    pub(crate) what: &'static str,
    /// Runs it; the arguments are those after its name.
    pub(crate) run: fn(&Context, &[String]) -> Result<(), Failure>,
    /// Whether another program checks its arguments.
    free: bool,
}

impl Task {
    /// The command named by these arguments, and its remaining arguments.
    pub(crate) fn asked(arguments: &[String]) -> Result<(&'static Self, Vec<String>), String> {
        let Some(task) = TASKS.iter().find(|task| task.is_named_by(arguments)) else {
            let first = arguments.first().map_or("", String::as_str);
            let names: Vec<_> = TASKS.iter().filter_map(|task| task.name.strip_prefix("bench ")).collect();
            return Err(match first {
                "bench" => format!("bench needs a name: {}", names.join(", ")),
                _ => format!("no verb `{first}`"),
            });
        };
        let rest = arguments[task.name.split(' ').count()..].to_vec();
        let known = |label: &String| task.takes.split(['[', ']', '|', ' ']).any(|known| known == label);
        match rest.iter().find(|argument| !task.free && !known(argument)) {
            Some(label) => Err(format!("unknown argument `{label}`; `{}` takes {}", task.name, task.taken())),
            None => Ok((task, rest)),
        }
    }

    /// Whether the arguments begin with its name.
    fn is_named_by(&self, arguments: &[String]) -> bool {
        let name = self.name.split(' ');
        arguments.len() >= name.clone().count() && name.zip(arguments).all(|(name, label)| name == label)
    }

    fn taken(&self) -> &str {
        if self.takes.is_empty() { "none" } else { self.takes }
    }
}

pub(crate) fn usage() -> String {
    let mut text = String::new();
    for task in &TASKS {
        let head = format!("{} {}", task.name, task.takes);
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {}\n                 {}", head.trim_end(), task.what);
    }
    text
}

/// Whether `--write` is among the arguments.
fn writes(arguments: &[String]) -> bool {
    arguments.iter().any(|argument| argument == "--write")
}

const fn task(
    name: &'static str,
    takes: &'static str,
    what: &'static str,
    run: fn(&Context, &[String]) -> Result<(), Failure>,
) -> Task {
    Task { name, takes, what, run, free: false }
}

/// A command whose arguments another program checks.
const fn handed_on(
    name: &'static str,
    takes: &'static str,
    what: &'static str,
    run: fn(&Context, &[String]) -> Result<(), Failure>,
) -> Task {
    Task { name, takes, what, run, free: true }
}

static TASKS: [Task; 24] = [
    handed_on(
        "soak",
        "[--hours N [--dir DIR] [--jobs J] [--only NAME] | --repeat NAME:RECIPE]",
        "run the tests with what depends on how fast or busy this machine is, which `test` leaves out: how long HALT and\n\
        \x20                alarms take, and frames of the page; --hours plays swarm runs, matches, and mutated packets, files\n\
        \x20                and bytes for so long, goes on where it stopped, and keeps corpora and findings in out/soak",
        |context, arguments| {
            if arguments.is_empty() { page::soak(context) } else { bench::soak(context, arguments) }
        },
    ),
    handed_on(
        "docs",
        "[--only NAME]... [--list]",
        "make all figures of the documentation again, or those named, and note their commit in the pages; two hours in all",
        docs::make,
    ),
    task(
        "lines",
        "",
        "record each crate's product lines: a test holds it to them, and a tenth",
        |context, _| {
            let line = "test --package match-tests --test tidy -- size::no_crate";
            run(context.cargo(line).env("ONETWO_RECORD_LINES", "1"))
        },
    ),
    handed_on(
        "release",
        "[TARGET]...",
        "build archives for machines without a toolchain: a static program for x86-64 and aarch64 Linux, the robots' images,\n\
        \x20                manual pages and completions; they lie in target/release-archives",
        release::build,
    ),
    handed_on(
        "wheels",
        "[x86_64|aarch64]...",
        "build the Python package's manylinux wheels and test this machine's in empty environments; they lie in\n\
        \x20                target/wheels-manylinux",
        wheels::build,
    ),
    handed_on(
        "swarm",
        "[--plan faults|referee] [--seeds N] [--first N] [--jobs J] [--record STEM]",
        "play N runs (100 if not said) drawn from their seeds, and hold them to what is promised: a team with faults of radio,\n\
        \x20                clocks and sensors, or matches of 60 s with cards, keeper changes, penalties, halts and restarts;\n\
         \x20                --record plays the match of --first alone and records it for `onetwo replay`",
        |context, arguments| bench::start_example(context, "swarm", arguments),
    ),
    handed_on(
        "faults",
        "[--seeds N] [--write]",
        "what loss costs a team; --write puts table and picture into docs/faults.md",
        |context, arguments| bench::start_example(context, "faults", arguments),
    ),
    handed_on(
        "on-target",
        "[NAME]...",
        "run the tests that run on the robot's processor, in QEMU; names choose among them",
        emulate::on_target,
    ),
    handed_on(
        "emulate",
        "IMAGE [NAME]...",
        "run a program for the robot's processor in QEMU; what `cargo run` and `cargo test` for that target call",
        |_, arguments| emulate::emulate(arguments),
    ),
    task("pictures", "", "draw the documentation's pictures again", |context, _| pictures::draw(context)),
    task(
        "screenshots",
        "",
        "take the page's pictures again, in a browser; they lie in docs/page",
        |context, _| page::pictures(context),
    ),
    task(
        "evaluation",
        "",
        "play the paper's evaluation and write docs/results/evaluation.md's figures; the report lies in out/evaluation",
        |context, _| evaluation::write(context),
    ),
    task(
        "matches",
        "[--fresh]",
        "play our team against each other, each against each, and without each part, and write docs/results/matches.md; the rest\n\
        \x20                lies in out/matches. Some 490 matches, 45 minutes of one core; goes on where it was stopped, --fresh\n\
        \x20                begins anew (another commit's matches are refused)",
        |context, arguments| {
            evaluation::write_matches(context, arguments.iter().any(|argument| argument == "--fresh"))
        },
    ),
    task(
        "skills",
        "",
        "try single skills in the nominal world and in random worlds, and write docs/skills.md; some minutes of one core",
        |context, _| evaluation::write_skills(context),
    ),
    task(
        "budgets",
        "",
        "count trial, game, strategy and simulator as below, and write docs/budgets.md",
        |context, _| budgets::write(context),
    ),
    handed_on(
        "bench retrieval",
        "[--write | --guest | --verify]",
        "count a retrieval's instructions on the robot's processor and here, and hold them to the budgets; --write puts\n\
        \x20                the table into casebase/README.md, --guest leaves this machine out, --verify holds 10^6 answers to a\n\
        \x20                plain scan's instead",
        |context, arguments| bench::start(context, "retrieval", arguments),
    ),
    handed_on(
        "bench motion",
        "[--write | --guest | --verify]",
        "likewise for planned motions, interception and ways around others; the table is firmware/motion/README.md's,\n\
        \x20                --verify holds 10^6 times to the best of all shares between the axes instead",
        |context, arguments| bench::start(context, "motion", arguments),
    ),
    handed_on(
        "bench radio",
        "[--write]",
        "likewise for radio frames on the robot's processor; the table is protocol/README.md's",
        |context, arguments| bench::start(context, "radio", arguments),
    ),
    handed_on(
        "bench hil",
        "[--seconds N] [--seed N]",
        "play a match with six robots as images under QEMU and with native ones in one run; compare hashes and wall speed",
        |context, arguments| bench::start_example(context, "hil", arguments),
    ),
    task(
        "bench page",
        "[--write]",
        "measure what a frame costs the page's script, full over empty, and count what five viewers cost a match; --write puts\n\
        \x20                both into host/page/README.md",
        |context, arguments| page::bench(context, writes(arguments)),
    ),
    task(
        "bench trial",
        "",
        "count the instructions of a simulated second of the paper's trials and hold them to the budget",
        |context, _| cost::judge(&trial_cost::rows(context)?),
    ),
    task(
        "bench game",
        "",
        "likewise of a host with eleven robots, per packet of vision, and of a match of two whole teams",
        |context, _| cost::judge(&game_cost::rows(context)?),
    ),
    task("bench strategy", "", "likewise of one decision of strategy's, of each kind", |context, _| {
        cost::judge(&example_cost::STRATEGY.rows(context)?)
    }),
    task(
        "bench simulator",
        "[--write]",
        "likewise of a second of eleven against eleven on wheels; --write puts the table into hil-sim/README.md",
        |context, arguments| {
            if writes(arguments) {
                return example_cost::write_simulator(context);
            }
            cost::judge(&example_cost::SIMULATOR.rows(context)?)
        },
    ),
];
