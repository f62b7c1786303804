//! `onetwo replay`: contents of a recorded match, the field at a moment, and whether the host decides the
//! same again; replay to the network, log files of its parts, and tables.
//!
//! Two kinds of files, distinguished by their first bytes: the league's log files (of any team) and traces of
//! ours (docs/architecture.md §7.4).

mod compare;
mod export;
mod league_log;
mod report;
mod rewrite;
mod send;
mod show;
mod trace;
mod transport;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{ArgGroup, Args};
use feed::recording::{RecordedError, begins_as_trace, in_file};
use rules::{Colour, League};

use crate::Failure;
use crate::args::DirectoryArgs;
use crate::args::page::PageArgs;
use crate::args::parsers::{colour, league, moment_in_seconds};

/// The file, and what to print of it.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, group(ArgGroup::new("output").args(["cut", "join", "export"])))]
pub(crate) struct ReplayArgs {
    /// A log file of the league (.log, .log.gz) or a trace of ours (.trace), gzipped or not.
    file: PathBuf,
    /// Print the result as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    /// Display it on the page, every moment of it, until Ctrl-C.
    #[arg(long, conflicts_with_all = ["json", "at", "event", "check"])]
    watch: bool,
    #[command(flatten)]
    page: PageArgs,
    /// Print the field and the referee this number of seconds after the file's start.
    #[arg(long, value_name = "SECONDS", value_parser = moment_in_seconds, conflicts_with = "event")]
    at: Option<f64>,
    /// Print the field and the referee at an event: goal, a command such as halt, stop or prepare_kickoff, a
    /// game event such as ball_left_field, or a stage; the start of a name is enough.
    #[arg(long, value_name = "NAME")]
    event: Option<String>,
    /// Which of several such events, from 1.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "event", value_parser = clap::value_parser!(u32).range(1..))]
    nth: u32,
    /// Print the problems that the robots of a trace decided on, one a line, as `cases retrieve` and
    /// `cases coverage --from` read them; with --team, that team's.
    #[arg(long, conflicts_with_all = ["json", "at", "event", "watch"])]
    problems: bool,
    /// Feed the host of this team with a log file's messages, and print what it would have sent.
    #[arg(long, value_name = "COLOUR", value_parser = colour)]
    team: Option<Colour>,
    /// The league of that host: ssl-2013, division-b or division-a; a trace knows its own.
    #[arg(long, value_name = "NAME", default_value = "division-b", value_parser = league)]
    league: League,
    /// Feed the hosts of a trace again and compare every packet they send with the record, byte for byte:
    /// this is done with every trace, and an error with any other file.
    #[arg(long)]
    check: bool,
    /// Play this trace in step with FILE, and print where they differ first: records, orders, positions and
    /// decisions on cases, with both values. With --watch: both on the page, in step, this one as a layer.
    #[arg(long, value_name = "TRACE", conflicts_with_all = ["at", "event", "problems", "team"])]
    compare: Option<PathBuf>,
    #[command(flatten)]
    send: send::SendArgs,
    #[command(flatten)]
    rewrite: rewrite::RewriteArgs,
    #[command(flatten)]
    export: export::ExportArgs,
    /// The file that --cut, --join or --export writes.
    #[arg(long, value_name = "FILE", requires = "output")]
    out: Option<PathBuf>,
    #[command(flatten)]
    directory: DirectoryArgs,
    /// The key of the team that recorded a trace, if it had one: 32 hexadecimal digits in a file.
    #[arg(long, value_name = "FILE")]
    key_file: Option<PathBuf>,
}

const EXIT_CODES: &str = "\
Exit codes: 0 the file is whole and all of it was of use, and the hosts of a trace decide as recorded; 1 the file is cut or damaged
(what could be read is told, and where it ends on stderr), messages in it could not be used, hosts decide otherwise, or what was asked
for is not in it; 2 wrong usage.
With --compare: 0 the traces are equal, 1 they differ, or one of them is damaged or cannot be compared with the other; 2 wrong usage.";

pub(crate) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    if args.send.is_wanted() {
        return send::run(args);
    }
    match &args.out {
        Some(out) if args.rewrite.is_wanted() => return rewrite::run(args, out),
        _ => {}
    }
    if let Some(form) = args.export.form() {
        return export::run(args, form);
    }
    if args.watch {
        return show::run(args);
    }
    if let Some(other) = &args.compare {
        return compare::run(args, other);
    }
    if begins_as_trace(&args.file)? {
        return trace::run(args);
    }
    if args.check {
        return Err(in_file(&args.file)(RecordedError::NoTrace).into());
    }
    if args.problems {
        return Err(in_file(&args.file)(RecordedError::NoDecisions).into());
    }
    league_log::run(args)
}
