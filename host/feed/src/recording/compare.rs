//! `compare`: two traces played in step, tick by tick of 10 ms: their hosts decide again side by side, and
//! records, orders, positions and decisions on cases are compared.

use std::path::Path;

use arena::cases::LibraryHandle;
use arena::game::TICK_US;
use host::Host;
use host::record::header::{HostHeader, RecordingHeader};
use host::record::recheck::Recheck;
use host::record::trace::Record;
use protocol::{Instant, RobotId, Who};
use rules::{Colour, League};

use super::ReadObserver;
use super::comparison::{Comparison, Ended, Report, settings};
use super::decisions::Decisions;
use super::failure::{RecordedError, RecordingFailure, in_file};
use super::trace_file::{TraceFile, begins_as_trace, hosts_of};
use super::unlike::{self, What};
use crate::decided::Decided;

/// Names, key and observer of the playing of traces.
#[derive(Clone, Copy)]
pub struct PlaySettings<'a> {
    /// Names of the cases, where there are any.
    pub library: Option<&'a LibraryHandle>,
    /// File of the key that the hosts' frames are sealed with.
    pub key_file: Option<&'a Path>,
    /// Takes warnings, and counts what was read.
    pub observer: &'a dyn ReadObserver,
}

pub(super) struct Playing<'a> {
    trace: TraceFile<'a>,
    pub(super) recheck: Recheck,
    decisions: Decisions,
    next: Option<Record>,
    span: Option<(Instant, Instant)>,
}

impl<'a> Playing<'a> {
    pub(super) fn open(file: &'a Path, settings: PlaySettings<'_>) -> Result<Self, RecordingFailure> {
        let mut trace = TraceFile::open(file)?;
        let recheck = trace.recheck(settings.key_file, settings.observer)?;
        let next = trace.next();
        let decisions = Decisions::new(settings.library);
        Ok(Self { trace, recheck, decisions, next, span: None })
    }

    /// The path that the trace was opened by.
    pub(super) const fn file(&self) -> &'a Path {
        self.trace.file()
    }

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
                self.decisions.look(record.at, feed, &hosts_of(&self.recheck));
            }
            self.recheck.feed(&record);
            let (first, last) = self.span.get_or_insert((record.at, record.at));
            (*first, *last) = ((*first).min(record.at), (*last).max(record.at));
            played.push(record);
            self.next = self.trace.next();
        }
        played
    }

    fn finish(&mut self) -> Result<Ended, RecordingFailure> {
        if let Some(feed) = self.recheck.host(0) {
            self.decisions.finish(feed, &hosts_of(&self.recheck));
        }
        let damage = self.trace.cut(&self.recheck)?;
        let (first, last) = self.span.unwrap_or_default();
        Ok(Ended {
            file: self.file().display().to_string(),
            span_s: (first.0 as f64 * 1e-6, last.0 as f64 * 1e-6),
            damage,
        })
    }

    fn colours(&self) -> Result<Vec<Colour>, RecordingFailure> {
        let colours = self.trace.header.hosts.iter().map(HostHeader::colour).collect::<Result<_, _>>();
        colours.map_err(in_file(self.file()))
    }
}

/// Plays two traces in step; what differs. They are to be [`comparable`].
pub fn compare(files: [&Path; 2], with: PlaySettings<'_>) -> Result<Report, RecordingFailure> {
    let mut pair = [Playing::open(files[0], with)?, Playing::open(files[1], with)?];
    let colours = pair[0].colours()?;
    let mut comparison = Comparison::new(settings(&pair[0].trace.header, &pair[1].trace.header), &colours);
    // The first record of the trace that goes on where the other has ended, and which one it is.
    let mut more = None;
    while let (Some(a), Some(b)) = (pair[0].tick(), pair[1].tick()) {
        with.observer.record();
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
        let texts =
            (format!("ends at {ended:.6} s"), format!("goes on: {}", unlike::whole(&first, &colours)));
        let (a, b) = if i == 0 { (texts.1, texts.0) } else { texts };
        comparison.find(first.at.0 as f64 * 1e-6, What::Length, || ("records".to_owned(), a, b));
    }
    let ended = [pair[0].finish()?, pair[1].finish()?];
    comparison.decisions(&pair[0].decisions.all, &pair[1].decisions.all);
    Ok(comparison.report(ended))
}

/// Refuses traces that have nothing to compare: other formats, leagues, hosts or case bases. Their league.
pub fn comparable(file: &Path, other: &Path) -> Result<League, RecordingFailure> {
    for file in [file, other] {
        if !begins_as_trace(file)? {
            return Err(in_file(file)(RecordedError::NoTrace));
        }
    }
    let (one, two) = (TraceFile::open(file)?, TraceFile::open(other)?);
    let ((a_version, a), (b_version, b)) = ((one.version(), &one.header), (two.version(), &two.header));
    let unlike = |what: String| Err(in_file(other)(RecordedError::Unlike(what)));
    if one.has_senders() != two.has_senders() {
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
    if hosts(a) != hosts(b) {
        return unlike(format!("it has the hosts {}, the other has {}", hosts(b), hosts(a)));
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
    Ok(one.league)
}

/// Orders and positions after a tick.
fn compare_hosts(tick: u64, pair: &[Playing<'_>; 2], comparison: &mut Comparison, colours: &[Colour]) {
    let now = Instant((tick + 1) * TICK_US);
    let at_s = now.0 as f64 * 1e-6;
    let [left, right] = [0, 1].map(|i| hosts_of(&pair[i].recheck));
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
