//! `compare`: two traces played in step, tick by tick of 10 ms: their hosts decide again side by side, and
//! records, orders, positions and decisions on cases are compared. Exit code 1 where they differ.

use std::path::Path;
use std::process::ExitCode;

use arena::game::TICK_US;
use host::Host;
use host::record::header::{HostHeader, RecordingHeader};
use host::record::recheck::Recheck;
use host::record::trace::{Reader, Record};
use protocol::{Instant, RobotId, Who};
use rules::Colour;

use super::comparison::{Comparison, Ended, Report, settings};
use super::decided::Decided;
use super::decisions::Decisions;
use super::trace::{all, damage_of, key, unfinished};
use super::unlike::{self, What};
use super::{ReplayArgs, TRACE, begins, failed, open};
use crate::Failure;
use crate::failure::RecordedError;
use crate::live::library_handle_of;
use crate::output::print_text;
use crate::progress::Progress;

/// A trace that is played.
pub(super) struct Playing<'a> {
    pub(super) file: &'a Path,
    header: RecordingHeader,
    reader: Reader<Box<dyn std::io::Read>>,
    pub(super) recheck: Recheck,
    decisions: Decisions,
    /// The first record that was not played yet.
    next: Option<Record>,
    span: Option<(Instant, Instant)>,
}

impl<'a> Playing<'a> {
    pub(super) fn open(args: &ReplayArgs, file: &'a Path) -> Result<Self, Failure> {
        if !begins(file)?.starts_with(TRACE) {
            return Err(failed(file)(RecordedError::NoTrace));
        }
        let mut reader = Reader::new(open(file)?).map_err(RecordedError::Trace).map_err(failed(file))?;
        let header = RecordingHeader::from_json(reader.header())
            .map_err(RecordedError::Header)
            .map_err(failed(file))?;
        let league = header.league().map_err(RecordedError::Header).map_err(failed(file))?;
        let library_handle = library_handle_of(league, args.directory.library.as_deref())?;
        let recheck = Recheck::new(&header, key(args.key_file.as_deref(), file, &header)?)
            .map_err(RecordedError::Header)
            .map_err(failed(file))?;
        let next = reader.next();
        let decisions = Decisions::new(library_handle.as_ref());
        Ok(Self { file, header, reader, recheck, decisions, next, span: None })
    }

    /// The tick of the next record.
    fn tick(&self) -> Option<u64> {
        self.next.as_ref().map(|record| record.at.0 / TICK_US)
    }

    /// Plays all records up to the end of a tick, and returns them.
    pub(super) fn play(&mut self, tick: u64) -> Vec<Record> {
        let mut played = Vec::new();
        while self.tick().is_some_and(|next| next <= tick)
            && let Some(record) = self.next.take()
        {
            if let Some(feed) = self.recheck.host(0) {
                self.decisions.look(record.at, feed, &all(&self.recheck));
            }
            self.recheck.feed(&record);
            let (first, last) = self.span.get_or_insert((record.at, record.at));
            (*first, *last) = ((*first).min(record.at), (*last).max(record.at));
            played.push(record);
            self.next = self.reader.next();
        }
        played
    }

    fn finish(&mut self) -> Result<Ended, Failure> {
        if let Some(feed) = self.recheck.host(0) {
            self.decisions.finish(feed, &all(&self.recheck));
        }
        let damage = damage_of(self.reader.end()).or(unfinished(self.file, &self.recheck)?);
        let (first, last) = self.span.unwrap_or_default();
        Ok(Ended {
            file: self.file.display().to_string(),
            span_s: (first.0 as f64 * 1e-6, last.0 as f64 * 1e-6),
            damage,
        })
    }

    fn colours(&self) -> Result<Vec<Colour>, Failure> {
        let colours = self.header.hosts.iter().map(HostHeader::colour).collect::<Result<_, _>>();
        colours.map_err(RecordedError::Header).map_err(failed(self.file))
    }
}

/// Plays `args.file` and `other` in step, and prints what differs.
pub(super) fn run(args: &ReplayArgs, other: &Path) -> Result<ExitCode, Failure> {
    let report = compare(args, other)?;
    let output = if args.json {
        serde_json::to_string(&report).map_err(|error| Failure::Output(error.into()))? + "\n"
    } else {
        report.text()
    };
    print_text(&output)?;
    match report.damaged() {
        Some(i) => Err(failed([&args.file, other][i])(RecordedError::Damaged(report.damage(i)))),
        None if report.same() => Ok(ExitCode::SUCCESS),
        None => Ok(ExitCode::FAILURE),
    }
}

/// Plays `args.file` and `other` in step; what differs.
pub(super) fn compare(args: &ReplayArgs, other: &Path) -> Result<Report, Failure> {
    // What cannot be compared is told before hosts are built: a host refuses another case base by itself.
    comparable(&args.file, other)?;
    let mut pair = [Playing::open(args, &args.file)?, Playing::open(args, other)?];
    let colours = pair[0].colours()?;
    let mut comparison = Comparison::new(settings(&pair[0].header, &pair[1].header), &colours);
    let bar = Progress::open();
    // The first record of the trace that goes on where the other has ended, and which one it is.
    let mut more = None;
    while let (Some(a), Some(b)) = (pair[0].tick(), pair[1].tick()) {
        bar.add(1);
        let tick = a.min(b);
        let mut played = pair.each_mut().map(|trace| trace.play(tick));
        for (short, long) in [(0, 1), (1, 0)] {
            let end = played[short].len();
            if pair[short].next.is_none() && end < played[long].len() {
                let rest = played[long].split_off(end);
                comparison.goes_on(long, rest.len() as u64);
                more = rest.into_iter().next().map(|record| (long, record));
            }
        }
        comparison.records(tick, &played[0], &played[1], &colours);
        // In a tick that one of them has in part, hosts had other inputs.
        if more.is_none() {
            compare_hosts(tick, &pair, &mut comparison, &colours);
        }
    }
    for (i, trace) in pair.iter_mut().enumerate() {
        more = more.or(trace.next.clone().map(|record| (i, record)));
        comparison.goes_on(i, trace.play(u64::MAX).len() as u64);
    }
    if let Some((i, first)) = more {
        let ended = pair[1 - i].span.map_or(0.0, |(_, last)| last.0 as f64 * 1e-6);
        let words =
            (format!("ends at {ended:.6} s"), format!("goes on: {}", unlike::whole(&first, &colours)));
        let (a, b) = if i == 0 { (words.1, words.0) } else { words };
        comparison.find(first.at.0 as f64 * 1e-6, What::Length, || ("records".to_owned(), a, b));
    }
    drop(bar);
    let ended = [pair[0].finish()?, pair[1].finish()?];
    comparison.decisions(&pair[0].decisions.all, &pair[1].decisions.all);
    Ok(comparison.report(ended))
}

/// Refuses traces that have nothing to compare: other formats, leagues, hosts or case bases.
fn comparable(file: &Path, other: &Path) -> Result<(), Failure> {
    let header = |file: &Path| -> Result<(u32, RecordingHeader), Failure> {
        if !begins(file)?.starts_with(TRACE) {
            return Err(failed(file)(RecordedError::NoTrace));
        }
        let reader = Reader::new(open(file)?).map_err(RecordedError::Trace).map_err(failed(file))?;
        let header = RecordingHeader::from_json(reader.header());
        Ok((reader.version, header.map_err(RecordedError::Header).map_err(failed(file))?))
    };
    let ((a_version, a), (b_version, b)) = (header(file)?, header(other)?);
    let unlike = |what: String| Err(failed(other)(RecordedError::Unlike(what)));
    if a_version != b_version {
        return unlike(format!(
            "a trace of format {b_version}, the other is of format {a_version}: record both with the same program"
        ));
    }
    if a.league != b.league {
        return unlike(format!("a match of {}, the other is one of {}", b.league, a.league));
    }
    let hosts = |header: &RecordingHeader| {
        header.hosts.iter().map(|host| host.colour.clone()).collect::<Vec<_>>().join(", ")
    };
    if hosts(&a) != hosts(&b) {
        return unlike(format!("it has the hosts {}, the other has {}", hosts(&b), hosts(&a)));
    }
    for (a, b) in a.hosts.iter().zip(&b.hosts) {
        if let (Some(a), Some(b), colour) = (&a.cases, &b.cases, &a.colour)
            && a != b
        {
            return unlike(format!(
                "its host {colour} understood robots by case base {b}, the other by {a}: record both with the same library"
            ));
        }
    }
    Ok(())
}

/// Orders and positions after a tick.
fn compare_hosts(tick: u64, pair: &[Playing<'_>; 2], comparison: &mut Comparison, colours: &[Colour]) {
    let now = Instant((tick + 1) * TICK_US);
    let at_s = now.0 as f64 * 1e-6;
    let [left, right] = [0, 1].map(|i| all(&pair[i].recheck));
    if let (Some(a), Some(b)) = (left.first(), right.first()) {
        let (a, b) = (a.tracker().world(now), b.tracker().world(now));
        let unlike = unlike::worlds(&a, &b);
        comparison.positions(unlike.is_some());
        if let Some(values) = unlike {
            comparison.find(at_s, What::Position, || values);
        }
    }
    for (host, colour) in colours.iter().enumerate() {
        let (Some(a), Some(b)) = (left.get(host), right.get(host)) else { continue };
        let order = |host: &Host, id| host.orders().iter().find(|order| order.robot == id).cloned();
        let mut other = false;
        for id in RobotId::all() {
            let (one, two) = (order(a, id), order(b, id));
            if one.is_none() && two.is_none() {
                continue;
            }
            let differs = one != two;
            other |= differs;
            comparison.order(host, differs);
            if differs {
                let who = Who { colour: *colour, id };
                let text = |host: &Host| {
                    Decided::of(&[host], who).map_or_else(|| "no order".to_owned(), |order| order.text())
                };
                comparison.find(at_s, What::Order, || {
                    (format!("{} {}", colour.label(), id.number()), text(a), text(b))
                });
            }
        }
        comparison.orders_of_tick(host, other);
    }
}
