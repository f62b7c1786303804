//! `onetwo cases`: contents, soundness and answers of a case base. The verb `cases` (docs/case-format.md §5).

mod check;
mod coverage;
mod diff;
mod draft;
mod evidence;
mod explain;
mod failure;
mod learn;
mod lines;
mod list;
mod new;
mod play;
mod playable;
mod render;
mod retrieve;
mod schema;
mod show;
mod stats;
mod survey;

use std::process::ExitCode;

use clap::Subcommand;

use crate::Failure;

/// One file per verb.
#[derive(Debug, Subcommand)]
pub(crate) enum CasesVerb {
    /// Check a library: every error and warning with its file, line and fix.
    Check(check::CheckArgs),
    /// List the stored cases.
    List(list::ListArgs),
    /// Print a stored case: the situation, each robot's gameplay, the ball's path.
    Show(show::ShowArgs),
    /// Draft a case for a situation: a first version of the file, to author from.
    #[command(after_help = PROBLEM_HELP)]
    New(new::NewArgs),
    /// Print a JSON schema of case files or of league.toml, for editors that complete and check by one.
    Schema(schema::SchemaArgs),
    /// Play each case from its own situation, many times, against standing and playing opponents, and report
    /// how often it works.
    Play(play::PlayArgs),
    /// Retrieve a case for each situation: problems on stdin, answers on stdout, one JSON object a line.
    #[command(after_help = PROBLEM_HELP)]
    Retrieve(retrieve::RetrieveArgs),
    /// Explain a retrieval: every case's verdict for each problem on stdin.
    #[command(after_help = PROBLEM_HELP)]
    Explain(explain::ExplainArgs),
    /// Measure where on the field no case fits: maps and shares over drawn problems.
    Coverage(coverage::CoverageArgs),
    /// Count how often each case is retrieved, which are shadowed, and which could be removed.
    Stats(stats::StatsArgs),
    /// Learn from play: revise, add and forget cases, each change tested in paired trials.
    Learn(learn::LearnArgs),
    /// Collect what became of cases in recordings, and the successful plays, into one evidence.jsonl.
    Evidence(evidence::EvidenceArgs),
    /// Draft cases from the plays of recordings that led to a shot or a goal.
    Draft(draft::DraftArgs),
    /// Draw a case, and a problem over it, as SVG.
    #[command(after_help = PROBLEM_HELP)]
    Render(render::RenderArgs),
}

pub(crate) fn run(verb: &CasesVerb) -> Result<ExitCode, Failure> {
    match verb {
        CasesVerb::Check(args) => check::run(args),
        CasesVerb::List(args) => list::run(args),
        CasesVerb::Show(args) => show::run(args),
        CasesVerb::New(args) => new::run(args),
        CasesVerb::Schema(args) => schema::run(args),
        CasesVerb::Play(args) => play::run(args),
        CasesVerb::Retrieve(args) => retrieve::run(args),
        CasesVerb::Explain(args) => explain::run(args),
        CasesVerb::Coverage(args) => coverage::run(args),
        CasesVerb::Stats(args) => stats::run(args),
        CasesVerb::Learn(args) => learn::run(args),
        CasesVerb::Evidence(args) => evidence::run(args),
        CasesVerb::Draft(args) => draft::run(args),
        CasesVerb::Render(args) => render::run(args),
    }
}

/// Format of a line of stdin.
const PROBLEM_HELP: &str = r#"A problem is one line of JSON; mm, field frame (origin at the centre, +x along the length):
{"ball":[-600,10],"defending":"yellow","teammates":{"1":[-700,0],"3":[200,800]},"opponents":[[-150,40]]}
"defending" is "yellow" (the goal at -x: attacks towards +x) or "cyan"; teammates go by robot id, 0 to 15."#;
