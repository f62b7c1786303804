//! `trace`: replay of a trace: its hosts decide again, and their packets are compared with the record. Exit
//! code 1 where they differ.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::ExitCode;

use arena::ledger::CaseTable;
use feed::recording::{
    Decision, Decisions, Moment, RecordedError, RefereeEvent, RefereeEventFinder, Sheet, TraceFile, hosts_of,
    in_file, is_meant, record_label,
};
use foreign::{excerpt, printable};
use hil_sim::small_size::worlds::WorldChoice;
use host::Host;
use host::record::header::RecordingHeader;
use host::record::trace::RecordKind;
use protocol::Instant;
use serde::Serialize;
use ssl::Message;
use ssl::referee::Referee;
use ssl::vision::WrapperPacket;

use super::ReplayArgs;
use crate::Failure;
use crate::library;
use crate::output::{json_line, note, print_text};
use crate::progress::Progress;

#[derive(Debug, Serialize)]
struct Report<'a> {
    kind: &'static str,
    file: String,
    header: &'a RecordingHeader,
    /// On the hosts' clock.
    span_s: (f64, f64),
    records: BTreeMap<&'static str, u64>,
    /// Records of hosts that the header does not name.
    strays: u64,
    /// Last state of field and teams.
    #[serde(flatten)]
    sheet: Sheet,
    #[serde(skip_serializing_if = "Option::is_none")]
    damage: Option<String>,
    #[serde(rename = "events")]
    match_events: &'a [RefereeEvent],
    hosts: Vec<Outcome>,
    same_decisions: bool,
    /// Results of every case, by team.
    cases: BTreeMap<&'static str, CaseTable>,
    /// Every decision, with its problem.
    decisions: &'a [Decision],
}

#[derive(Debug, Serialize)]
struct Outcome {
    colour: String,
    inputs: u64,
    same_packets: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<String>,
}

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let file = &args.file;
    let mut trace = TraceFile::open(file)?;
    let bar = Progress::open();
    let mut recheck = trace.recheck(args.key_file.as_deref(), &bar)?;
    let (mut finder, mut match_events, mut sheet) =
        (RefereeEventFinder::default(), Vec::new(), Sheet::default());
    let (mut records, mut strays, mut met) = (BTreeMap::new(), 0, 0);
    let mut span: Option<(Instant, Instant)> = None;
    // Every host receives the same referee; events are taken from the host that is displayed.
    let first_shown =
        trace.header.hosts.iter().position(|host| Some(&*host.colour) == args.team.map(rules::Colour::label));
    let first_shown = first_shown.unwrap_or(0);
    let library = library::of_league(trace.league, args.directory.library.as_deref())?;
    let mut decisions = Decisions::new(library.as_ref());
    for record in trace.by_ref() {
        bar.add(1);
        if let Some(at) = args.at
            && record.at.0 as f64 * 1e-6 > at
            && let Some(host) = recheck.host(first_shown)
        {
            drop(bar);
            return show(args, host, &hosts_of(&recheck), Instant((at * 1e6) as u64), None);
        }
        let (first, last) = span.get_or_insert((record.at, record.at));
        (*first, *last) = ((*first).min(record.at), (*last).max(record.at));
        *records.entry(record_label(record.kind)).or_insert(0) += 1;
        if let Some(feed) = recheck.host(first_shown) {
            decisions.look(record.at, feed, &hosts_of(&recheck));
        }
        strays += u64::from(!recheck.feed(&record));
        if record.kind == RecordKind::Vision
            && usize::from(record.host) == first_shown
            && let Ok(packet) = WrapperPacket::decode(&record.bytes[..])
        {
            sheet.vision(&packet);
        }
        if record.kind == RecordKind::Referee && usize::from(record.host) == first_shown {
            let before = match_events.len();
            if let Ok(packet) = Referee::decode(&record.bytes[..]) {
                sheet.referee(&packet);
                finder.read(&packet, record.at.0 as f64 * 1e-6, &mut match_events);
            }
            let asked = |h: &&RefereeEvent| args.event.as_deref().is_some_and(|name| is_meant(h, name));
            for match_event in match_events[before..].iter().filter(asked) {
                met += 1;
                if met == args.nth
                    && let Some(host) = recheck.host(first_shown)
                {
                    drop(bar);
                    return show(args, host, &hosts_of(&recheck), record.at, Some(match_event.name.clone()));
                }
            }
        }
    }
    drop(bar);
    let damage = trace.cut(&recheck)?;
    if args.at.is_some() || args.event.is_some() {
        let (_, last) = span.unwrap_or_default();
        let end = last.0 as f64 * 1e-6;
        let asked = match &args.event {
            None => format!("{} s is after its end; it ends at {end:.3} s", args.at.unwrap_or_default()),
            Some(name) => format!("{met} `{name}` in it, not {}; it ends at {end:.3} s", args.nth),
        };
        return Err(in_file(file)(RecordedError::NotThere { asked, damage }).into());
    }
    if let Some(feed) = recheck.host(first_shown) {
        decisions.finish(feed, &hosts_of(&recheck));
    }
    recheck.finish(damage.is_some());
    let cases = decisions.tables(&hosts_of(&recheck));
    let hosts: Vec<Outcome> = (trace.header.hosts.iter().zip(recheck.results()))
        .map(|(host, (counts, difference))| Outcome {
            colour: host.colour.clone(),
            inputs: counts.inputs,
            same_packets: counts.same,
            difference: difference.map(ToString::to_string),
        })
        .collect();
    let (first, last) = span.unwrap_or_default();
    let report = Report {
        kind: "trace",
        file: file.display().to_string(),
        header: &trace.header,
        span_s: (first.0 as f64 * 1e-6, last.0 as f64 * 1e-6),
        records,
        strays,
        sheet,
        damage,
        match_events: &match_events,
        same_decisions: hosts.iter().all(|host| host.difference.is_none()) && strays == 0,
        hosts,
        cases,
        decisions: &decisions.all,
    };
    let output = if args.problems {
        problems(args, &decisions)
    } else if args.json {
        json_line(&report)?
    } else {
        report.text()
    };
    print_text(&output)?;
    match report.damage {
        // What could be read is printed above.
        Some(place) => Err(in_file(file)(RecordedError::Damaged(place)).into()),
        None if report.same_decisions => Ok(ExitCode::SUCCESS),
        None => Ok(ExitCode::FAILURE),
    }
}

/// The problems of the trace, one a line; on stderr how many of them robots did not report.
fn problems(args: &ReplayArgs, decisions: &Decisions) -> String {
    let wanted = |decision: &&Decision| args.team.is_none_or(|team| team.label() == decision.team);
    let (mut text, mut rebuilt) = (String::new(), 0);
    for decision in decisions.all.iter().filter(wanted) {
        if let Some(line) = decision.problem_line() {
            text += &line;
            text.push('\n');
            rebuilt += u32::from(!decision.note.reported);
        }
    }
    if rebuilt > 0 {
        note!(
            "{rebuilt} of {} problems were not reported: they are as the host saw them",
            text.lines().count()
        );
    }
    text
}

/// Prints the moment as `host` sees it, with what every host decides.
fn show(
    args: &ReplayArgs,
    host: &Host,
    hosts: &[&Host],
    at: Instant,
    event: Option<String>,
) -> Result<ExitCode, Failure> {
    let moment = Moment::new(at.0 as f64 * 1e-6, event, &host.tracker().world(at), host.game(), hosts);
    print_text(&if args.json { json_line(&moment)? } else { moment.text() })?;
    Ok(ExitCode::SUCCESS)
}

impl Report<'_> {
    fn text(&self) -> String {
        let (first, last) = self.span_s;
        let header = self.header;
        let file = printable(&self.file);
        let mut out = format!("{file}: a trace from {first:.3} to {last:.3} s, {}", header.league);
        if let Some(seed) = header.seed {
            let _ = write!(out, ", seed {seed}");
        }
        // A name from the file is printed only if it is valid.
        if let Some(world) = header.world.as_ref().and_then(|world| world.parse::<WorldChoice>().ok())
            && world != WorldChoice::Nominal
        {
            let _ = write!(out, ", world {world}");
        }
        let (version, commit) = (excerpt(&header.version, VERSION_LEN), excerpt(&header.commit, VERSION_LEN));
        let _ = writeln!(out, ", by onetwo {version} (commit {commit})");
        for (name, n) in &self.records {
            let _ = writeln!(out, "  {n:>8} {name}");
        }
        for line in self.sheet.text().into_iter().chain(self.match_events.iter().map(RefereeEvent::line)) {
            let _ = writeln!(out, "{line}");
        }
        if self.strays > 0 {
            let _ = writeln!(out, "{} records are of hosts that its header does not tell of", self.strays);
        }
        if let Some(damage) = &self.damage {
            let _ = writeln!(out, "the file is damaged: {}", printable(damage));
        }
        for host in &self.hosts {
            let _ = match &host.difference {
                None => writeln!(
                    out,
                    "{}: same decisions: {} packets, from {} inputs",
                    host.colour, host.same_packets, host.inputs
                ),
                Some(difference) => writeln!(out, "{}: other decisions {difference}", host.colour),
            };
        }
        for (team, table) in &self.cases {
            let _ = writeln!(out, "{team}: {}", table.summary());
        }
        out
    }
}

/// Longest version and commit of the recording program that are printed, characters.
const VERSION_LEN: usize = 60;
