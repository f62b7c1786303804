//! `league_log`: replay of a league log file: one pass that counts, tracks, listens, and stops at a moment if
//! one is asked for.
//!
//! Times are those of [`LogMessages`], from the file's first message on: where the recorder's clock is set,
//! ours goes on.

use std::process::ExitCode;

use feed::recording::{LogMessages, Moment, RecordedError, RefereeEventFinder, Score, in_file, is_meant};
use host::referee::{Listener, SenderAddress};
use host::tracking::{Tracker, VisionVerdict};
use host::{Host, HostSettings, Input};
use protocol::Instant;
use rules::Colour;
use ssl::log::{MessageKind, Packet, Record};

use super::ReplayArgs;
use super::report::{self, Gap, Report};
use crate::Failure;
use crate::output::{json_line, print_text};
use crate::progress::Progress;

/// Vision that is silent longer than this is a gap: robots are blind after three missed periods at 60 Hz, and
/// teams complain from 0.2 s on.
const VISION_GAP_S: f64 = 0.2;
/// The referee's: pauses of 1.5 s come on a loaded machine.
const REFEREE_GAP_S: f64 = 2.0;

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let mut messages = LogMessages::open(&args.file)?;
    let mut pass = Pass::new(args)?;
    let bar = Progress::open();
    let mut at_moment = None;
    for (number, (at, record)) in (0_u64..).zip(messages.by_ref()) {
        bar.add(1);
        if let Some(moment) = pass.read(number, at, &record) {
            at_moment = Some(moment);
            break;
        }
    }
    drop(bar);
    if let Some(moment) = at_moment {
        print_text(&if args.json { json_line(&moment)? } else { moment.text() })?;
        return Ok(ExitCode::SUCCESS);
    }
    if args.at.is_some() || args.event.is_some() {
        let missing = RecordedError::NotThere { asked: pass.asked(args), damage: messages.damage() };
        return Err(in_file(&args.file)(missing).into());
    }
    let report = pass.finish(&messages);
    print_text(&if args.json { json_line(&report)? } else { report.text() })?;
    let nothing = report.messages.is_empty().then_some(RecordedError::Empty);
    let unused = (!report.unused.is_empty()).then(|| RecordedError::Unused(report.unused.join("; ")));
    match report.damage.map(RecordedError::Damaged).or(nothing).or(unused) {
        // What could be used is printed above; the exit code reports that it is not all.
        Some(error) => Err(in_file(&args.file)(error).into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

struct Pass<'a> {
    args: &'a ReplayArgs,
    report: Report,
    now: Instant,
    tracker: Tracker,
    listener: Listener,
    finder: RefereeEventFinder,
    team: Option<Team>,
    /// Number of requested events found so far.
    met: u32,
}

struct Team {
    host: Host,
    host_report: report::Host,
    hash: u64,
}

impl<'a> Pass<'a> {
    fn new(args: &'a ReplayArgs) -> Result<Self, Failure> {
        let limits = args.league.limits();
        let limits = limits.ok_or(RecordedError::NoRules).map_err(in_file(&args.file))?;
        let report = Report { kind: "log", file: args.file.display().to_string(), ..Report::default() };
        let team = args.team.map(|colour| Team {
            host: Host::new(HostSettings::new(colour, args.league, 1), Instant(0)),
            host_report: report::Host { colour: colour.label().to_owned(), ..report::Host::default() },
            hash: FNV_BASIS,
        });
        Ok(Self {
            args,
            report,
            now: Instant(0),
            tracker: Tracker::default(),
            listener: Listener::new(limits, None, Instant(0)),
            finder: RefereeEventFinder::default(),
            team,
            met: 0,
        })
    }

    /// Reads the next message; returns a moment, if this is the requested one.
    fn read(&mut self, number: u64, later: Instant, record: &Record) -> Option<Moment> {
        // The moment between two messages is before the second.
        if let Some(at) = self.args.at
            && later.0 as f64 * 1e-6 > at
        {
            let at = Instant((at * 1e6) as u64).max(self.now);
            return Some(self.moment(at, None));
        }
        self.now = later;
        let at_s = self.seconds();
        self.count(record, at_s);
        let decoded = match record.present() {
            Some((kind, bytes)) => {
                Packet::decode(kind, &bytes).map(|packet| packet.map(|packet| (packet, bytes)))
            }
            None => record.decode().map(|_| None),
        };
        let packet = match decoded {
            Ok(packet) => packet,
            Err(error) => {
                self.report.undecodable += 1;
                if let Some(kind) = self.report.messages.get_mut(&record.kind.to_string()) {
                    kind.undecodable += 1;
                }
                let first = || format!("message {number} at {at_s:.3} s: {error}");
                self.report.first_undecodable.get_or_insert_with(first);
                None
            }
        };
        match packet {
            Some((Packet::Vision(packet), bytes)) => {
                self.report.field(&packet, at_s);
                if let Some(image) = &packet.detection {
                    self.image(image.camera_id, at_s);
                }
                let received = self.tracker.handle(&packet, self.now);
                if matches!(received, VisionVerdict::Newest | VisionVerdict::Restarted) {
                    self.look();
                }
                self.feed(Input::Vision(&bytes));
            }
            Some((Packet::Referee(packet), bytes)) => {
                let ball = self.tracker.world(self.now).ball.map(|ball| ball.position);
                // A log file does not record the sender of its packets.
                self.listener.receive(&packet, SenderAddress::INTERNAL, self.now, ball);
                let before = self.report.match_events.len();
                self.finder.read(&packet, at_s, &mut self.report.match_events);
                self.report.sheet.referee(&packet);
                self.report.score = Score { blue: packet.blue.score, yellow: packet.yellow.score };
                self.feed(Input::Referee(&bytes, SenderAddress::INTERNAL));
                return self.asked_for(before);
            }
            _ => {}
        }
        None
    }

    /// The moment of the requested event, if it is among the newest.
    fn asked_for(&mut self, since: usize) -> Option<Moment> {
        let label = self.args.event.as_deref()?;
        for place in since..self.report.match_events.len() {
            if is_meant(&self.report.match_events[place], label) {
                self.met += 1;
                if self.met == self.args.nth {
                    let name = self.report.match_events[place].name.clone();
                    return Some(self.moment(self.now, Some(name)));
                }
            }
        }
        None
    }

    fn moment(&mut self, at: Instant, event: Option<String>) -> Moment {
        let world = self.tracker.world(at);
        self.listener.tick(at, world.ball.map(|ball| ball.position));
        Moment::new(at.0 as f64 * 1e-6, event, &world, self.listener.game(), &[])
    }

    fn asked(&self, args: &ReplayArgs) -> String {
        match (&args.event, args.at) {
            (Some(label), _) => {
                let mut known: Vec<_> = self.report.match_events.iter().map(|h| h.name.clone()).collect();
                known.sort_unstable();
                known.dedup();
                let known = if known.is_empty() { "no event".to_owned() } else { known.join(", ") };
                format!("{} `{label}` in it, not {}; it has: {known}", self.met, args.nth)
            }
            (None, at) => {
                format!("it ends after {:.3} s, before {} s", self.seconds(), at.unwrap_or_default())
            }
        }
    }

    fn count(&mut self, record: &Record, at_s: f64) {
        let name = record.kind.to_string();
        let known = self.report.messages.entry(name.clone()).or_default();
        known.messages += 1;
        known.bytes += record.payload.len() as u64;
        let longest = match record.kind {
            MessageKind::Vision2014 | MessageKind::Vision2010 => VISION_GAP_S,
            MessageKind::Refbox2013 => REFEREE_GAP_S,
            _ => f64::INFINITY,
        };
        if let Some(for_s) = known.rate.came(at_s).filter(|for_s| *for_s > longest) {
            self.report.gap(Gap { at_s: at_s - for_s, of: name, for_s });
        }
    }

    fn image(&mut self, camera: u32, at_s: f64) {
        // A damaged file may name any number; no field has more.
        if self.report.cameras.len() < CAMERAS_MAX || self.report.cameras.contains_key(&camera) {
            let camera = self.report.cameras.entry(camera).or_default();
            camera.images += 1;
            camera.rate.came(at_s);
        }
    }

    /// Records the current state of the tracker.
    fn look(&mut self) {
        let world = self.tracker.snapshot();
        for robot in world.robots() {
            let seen = match robot.who.colour {
                Colour::Blue => &mut self.report.robots.blue,
                Colour::Yellow => &mut self.report.robots.yellow,
            };
            seen.insert(robot.who.id.number());
        }
        if let Some(ball) = &world.ball {
            self.report.ball_speed_max = self.report.ball_speed_max.max(ball.velocity.norm());
        }
    }

    fn feed(&mut self, input: Input<'_>) {
        let Some(team) = &mut self.team else { return };
        while let Some(due) = team.host.poll_timeout().filter(|due| *due < self.now) {
            team.feed_input(due, Input::Timeout);
            // A deadline that is not moved after it was met would never end.
            if team.host.poll_timeout().is_some_and(|next| next <= due) {
                break;
            }
        }
        team.feed_input(self.now, input);
    }

    fn seconds(&self) -> f64 {
        self.now.0 as f64 * 1e-6
    }

    fn finish(mut self, messages: &LogMessages) -> Report {
        self.report.take(self.tracker.counts(), self.listener.counts());
        self.report.span_s = self.seconds();
        self.report.began_unix_s = messages.began_unix_s();
        self.report.damage = messages.damage();
        self.report.back_steps = messages.back_steps();
        let (steps, more) = messages.clock_steps();
        (self.report.clock_steps, self.report.clock_steps_more) = (steps.to_vec(), more);
        (self.report.joined, self.report.joined_at_s) = messages.joined();
        self.report.note_unused(self.tracker.counts().geometry_refused);
        for kind in self.report.messages.values_mut() {
            kind.rate_hz = kind.rate.hz();
        }
        for camera in self.report.cameras.values_mut() {
            camera.rate_hz = camera.rate.hz();
        }
        self.report.host = self
            .team
            .map(|team| report::Host { packets_hash: format!("{:016x}", team.hash), ..team.host_report });
        self.report
    }
}

impl Team {
    fn feed_input(&mut self, at: Instant, input: Input<'_>) {
        self.host_report.inputs += 1;
        self.host.handle(at, input);
        while let Some((_, packet)) = self.host.poll_packet() {
            self.host_report.packets += 1;
            self.host_report.bytes += packet.len() as u64;
            for byte in &packet[..] {
                self.hash = (self.hash ^ u64::from(*byte)).wrapping_mul(FNV_PRIME);
            }
        }
    }
}

/// Most cameras of a field.
const CAMERAS_MAX: usize = 64;
/// FNV-1a-64, as the trace hash (docs/architecture.md §2.5).
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;
