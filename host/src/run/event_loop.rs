//! `event_loop`: feeds what arrives on the channel to the host, with the time of a monotonic clock, and sends
//! the host's packets.
//!
//! Event-driven: it waits for mail or for the host's deadline, whichever is first. Times on the host's clock,
//! which is 0 when the loop starts.

use std::io;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use protocol::frame::TeamKey;
use protocol::version::{VersionReport, hash_of, parse_hash, parts_of};
use rules::{Colour, Phase, RobotSpec};
use ssl::Message;
use ssl::log::MessageKind;
use ssl::net::{Interfaces, NetSender};

use super::alarms::Alarms;
use super::inbox::{Inbox, Mail, RemoteAnswer, Source};
use super::radio_alarms::RadioAlarms;
use super::remote_thread;
use super::tracker_input::TrackerInput;
use super::tuning::{Tuning, keep_learned};
use super::watch::Watch;
use super::{Operator, Program, RunError, RunSettings, identity, port_for_teams, threads};
use crate::config::{RobotLink, TeamConfig, TrackerIn};
use crate::radio::RadioSettings;
use crate::record::header::RecordingHeader;
use crate::record::{BackgroundRecorder, Recorder};
use crate::referee::remote::RemoteRequest;
use crate::referee::team_port::TeamPortRequest;
use crate::shell::{Link, Outbox, StrategyProcess};
use crate::strategy::Task;
use crate::tracking::senders::{Admission, ExpectedRobots, VisionSenders};
use crate::tracking::{Publisher, VisionVerdict};
use crate::{Host, HostSettings, Input, InputVerdict};

/// Longest time between two checks for missing sources and the end.
const CHECK_EVERY: Duration = Duration::from_millis(100);
/// An answer of the team's own strategy takes at most this long: it is started again if it has hung. Its
/// robots stand long before ([`crate::external::ANSWERS_WITHIN`]).
const STRATEGY_PATIENCE: Duration = Duration::from_secs(1);
/// HALT is sent for this time before the loop ends: thirty snapshots, so that one of them arrives over a
/// lossy radio.
const HALT_TIME: Duration = Duration::from_millis(300);
/// Period of HALT frames.
const HALT_EVERY: Duration = Duration::from_millis(10);

/// Leads the robots behind `link` until `stopped` is set.
pub(super) fn run(
    settings: &RunSettings<'_>,
    key: TeamKey,
    link: Box<dyn Link>,
    operator: &mut dyn Operator,
    stopped: &AtomicBool,
) -> Result<(), RunError> {
    let config = settings.config;
    let epoch = identity::this_epoch(config);
    if let Some(warning) = &epoch.warning {
        operator.line(format!("warning: {warning}"));
    }
    let by_default = HostSettings::new(config.colour, config.league, epoch.epoch);
    let host_settings = HostSettings {
        keeper: config.keeper,
        referee: config.referee_source.clone(),
        referee_silence: config.referee_silence,
        kick: config.kick,
        roll: config.roll,
        limits: config.limits,
        tactics: config.tactics,
        practice: config.practice,
        learns: settings.learns,
        radio: RadioSettings { key, relay: link.relay(), numbers: config.numbers, ..by_default.radio },
        external: config.strategy.is_some(),
        cases: settings.cases,
        ..by_default
    };
    // Robots in a simulator are processes of this program.
    let expected = (!matches!(config.robots, RobotLink::Simulator(_))).then(|| VersionReport {
        version: parts_of(settings.program.version),
        image: parse_hash(settings.program.image),
        robot: hash_of(RobotSpec::TEXT.as_bytes()),
        case_base: host_settings.case_base().hash(),
    });
    let host_settings = HostSettings { expected, ..host_settings };
    let strategy =
        config.strategy.as_deref().map(|command| StrategyProcess::start(command, STRATEGY_PATIENCE));
    let strategy = strategy.transpose().map_err(RunError::Strategy)?;
    let recorder = settings.output.record.map(|stem| {
        Recorder::begin(stem, &header(&host_settings, settings.program))
            .and_then(BackgroundRecorder::start)
            .map_err(|error| RunError::Record(stem.to_owned(), error))
    });
    let recorder = recorder.transpose()?;
    operator.started();

    let watch = Watch::new(link.advice());
    let (channels, threads) = Threads::start(config, link, strategy, settings.remote);
    let own = identity::own_uuid(config);
    let mut event_loop = EventLoop {
        host: Host::new(host_settings, protocol::Instant(0)),
        began: Instant::now(),
        channels,
        us: config.colour,
        recorder,
        recording: Ok(()),
        trace_ended: false,
        watch,
        senders: VisionSenders::new(config.colour),
        alarms: Alarms::new(&config.name),
        radio_alarms: RadioAlarms::default(),
        publisher: Publisher::new(&own, &config.name),
        tracker: config.tracker_in.clone().map(|wanted| TrackerInput::new(wanted, own)),
        sender: NetSender::new(config.tracker, config.interface.as_deref()),
        counts: Counts::default(),
        lines: Vec::new(),
        operator,
        tuning: Tuning::new(config, settings.output.config),
    };
    event_loop.lead(config, settings.duration, stopped);
    // HALT before anything that may wait: the disk, the terminal.
    let recorder = event_loop.recorder.take();
    event_loop.halt();
    threads.join();
    event_loop.operator.ended();
    event_loop.end_recording(recorder);
    let learned = settings.output.learned.map(|path| keep_learned(path, event_loop.host.learned()));
    event_loop.lines.extend(learned);
    let Counts { vision, referee, robots, sent } = event_loop.counts;
    event_loop.lines.push(format!(
        "robots halted; ended after {vision} vision and {referee} referee packets, {robots} frames from robots and \
         {sent} to them"
    ));
    event_loop.print();
    event_loop.recording.map_err(RunError::NotWhole)
}

fn header(settings: &HostSettings, program: Program<'_>) -> RecordingHeader {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    RecordingHeader {
        version: program.version.to_owned(),
        commit: program.commit.to_owned(),
        zero_unix_us: Some(unix.as_micros() as u64),
        ..RecordingHeader::of(settings)
    }
}

/// What connects the loop with its threads.
pub(super) struct Channels {
    mail: Arc<Inbox>,
    /// Frames to the robots.
    out: Arc<Mutex<Outbox>>,
    /// Requests to the game controller.
    ask: Sender<TeamPortRequest>,
    /// Requests to the game controller as a remote control.
    pub(super) remote: Sender<RemoteRequest>,
    /// Views for the team's own strategy.
    view: Sender<String>,
}

struct Threads {
    end: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Threads {
    fn start(
        config: &TeamConfig,
        link: Box<dyn Link>,
        strategy: Option<StrategyProcess>,
        remote_port: Option<SocketAddr>,
    ) -> (Channels, Self) {
        let (mail, out) = (Arc::new(Inbox::new()), Arc::new(Mutex::new(Outbox::default())));
        let end = Arc::new(AtomicBool::new(false));
        let by = config.interface.clone().map_or(Interfaces::All, |name| Interfaces::These(vec![name]));
        let tracker_by = by.clone();
        let mut threads = vec![
            threads::receive(Source::Vision, config.vision, by.clone(), mail.clone(), end.clone()),
            threads::receive(Source::Referee, config.referee, by, mail.clone(), end.clone()),
            threads::carry(link, out.clone(), mail.clone(), end.clone()),
        ];
        if let Some(TrackerIn { address, .. }) = config.tracker_in {
            threads.push(threads::receive(Source::Tracker, address, tracker_by, mail.clone(), end.clone()));
        }
        let (ask, asked): (_, Receiver<TeamPortRequest>) = mpsc::channel();
        if let Some(address) = config.game_controller {
            let who = (config.name.clone(), config.colour, config.keeper);
            threads.push(port_for_teams::talk(address, who, asked, mail.clone(), end.clone()));
        }
        let (remote, asked) = mpsc::channel();
        if let Some(address) = remote_port {
            threads.push(remote_thread::talk(address, config.colour, asked, mail.clone(), end.clone()));
        }
        let (view, views) = mpsc::channel();
        if let Some(strategy) = strategy {
            threads.push(threads::ask_strategy(strategy, views, mail.clone(), end.clone()));
        }
        (Channels { mail, out, ask, remote, view }, Self { end, threads })
    }

    /// Ends all of them.
    fn join(self) {
        self.end.store(true, Ordering::Relaxed);
        for thread in self.threads {
            let _ = thread.join();
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    vision: u64,
    referee: u64,
    robots: u64,
    sent: u64,
}

pub(super) struct EventLoop<'o> {
    pub(super) host: Host,
    began: Instant,
    pub(super) channels: Channels,
    us: Colour,
    recorder: Option<BackgroundRecorder>,
    /// Error of a recording that ended before the match.
    recording: io::Result<()>,
    /// Whether the end of the trace was reported.
    trace_ended: bool,
    pub(super) watch: Watch,
    senders: VisionSenders,
    pub(super) alarms: Alarms,
    radio_alarms: RadioAlarms,
    publisher: Publisher,
    tracker: Option<TrackerInput>,
    sender: NetSender,
    counts: Counts,
    /// Lines for the operator that were not printed yet.
    pub(super) lines: Vec<String>,
    pub(super) operator: &'o mut dyn Operator,
    pub(super) tuning: Tuning,
}

impl EventLoop<'_> {
    pub(super) fn now(&self) -> protocol::Instant {
        protocol::Instant(self.began.elapsed().as_micros() as u64)
    }

    /// Runs until `stopped` is set, or for `duration` seconds.
    fn lead(&mut self, config: &TeamConfig, duration: Option<f64>, stopped: &AtomicBool) {
        let mut checked = Instant::now();
        while !stopped.load(Ordering::Relaxed)
            && duration.is_none_or(|s| self.began.elapsed().as_secs_f64() < s)
        {
            self.wait();
            self.show();
            if checked.elapsed() >= CHECK_EVERY {
                checked = Instant::now();
                let now = self.now();
                self.watch.look(now, &self.host, config, &mut self.lines);
                self.look_at_tracker(now);
                self.look_at_alarms(now, config);
                self.look_at_recording();
                self.look_at_radio(now);
                let status = self.status();
                self.operator.status(status);
            }
            self.print();
        }
    }

    fn print(&mut self) {
        for line in self.lines.drain(..) {
            self.operator.line(line);
        }
    }

    /// Waits for mail or the host's deadline, and handles it.
    fn wait(&mut self) {
        let due = self.host.poll_timeout().map(|due| Duration::from_micros(due.since(self.now()).0));
        if let Some(mail) = self.channels.mail.take(due.unwrap_or(CHECK_EVERY).min(CHECK_EVERY)) {
            self.open(mail);
        }
        let now = self.now();
        self.alarms.ran(now);
        if self.host.poll_timeout().is_some_and(|due| due <= now) {
            self.feed(now, Input::Timeout);
        }
    }

    fn open(&mut self, mail: Mail) {
        let now = self.now();
        match mail {
            Mail::Vision(bytes, from) => {
                self.counts.vision += 1;
                let admission = self.senders.receive(now, from, &bytes, self.host.world());
                let used = match &self.tracker {
                    _ if admission != Admission::Used => None,
                    Some(tracker) => tracker.vision(now, bytes),
                    None => Some(bytes),
                };
                self.see(now, used);
            }
            Mail::Tracker(bytes) => {
                let used = self.tracker.as_mut().and_then(|tracker| tracker.receive(now, &bytes));
                self.see(now, used);
            }
            Mail::Referee(bytes, from) => {
                self.counts.referee += 1;
                self.feed(now, Input::Referee(&bytes, from));
            }
            Mail::Robot(packet) => {
                self.counts.robots += 1;
                self.feed(now, Input::Robot(&packet));
            }
            Mail::Orders(line) => {
                self.feed(now, Input::Orders(line.as_bytes()));
            }
            Mail::Opened { source, route } => self.watch.open(source, &route),
            Mail::Trouble(source, reason) => {
                let line = self.watch.trouble(source, &reason);
                self.lines.push(line);
            }
            Mail::Note(line) => self.lines.push(line),
            Mail::Remote(RemoteAnswer::State(state)) => self.operator.remote(state.as_ref()),
            Mail::Remote(RemoteAnswer::Refused(reason)) => {
                self.lines.push(format!("remote control  {reason}"));
                self.operator.refuse(reason);
            }
            Mail::Slow(line) => self.alarms.slow(now, line),
        }
    }

    /// Feeds a camera frame, and publishes the field that follows.
    fn see(&mut self, now: protocol::Instant, bytes: Option<Vec<u8>>) {
        let Some(bytes) = bytes else { return };
        let verdict = self.feed(now, Input::Vision(&bytes));
        if matches!(verdict, InputVerdict::Vision(VisionVerdict::Newest | VisionVerdict::Restarted)) {
            self.publish(now);
        }
    }

    /// Feeds one input to the host, then handles its output.
    pub(super) fn feed(&mut self, now: protocol::Instant, input: Input<'_>) -> InputVerdict {
        if let Some(recorder) = &mut self.recorder {
            match input {
                Input::Vision(bytes) => recorder.received(now, MessageKind::Vision2014, bytes),
                Input::Referee(bytes, _) => recorder.received(now, MessageKind::Refbox2013, bytes),
                _ => {}
            }
            recorder.input(now, self.us, input);
        }
        let began = Instant::now();
        let verdict = self.host.handle(now, input);
        self.operator.took(began.elapsed());
        match input {
            Input::Vision(bytes) => self.operator.vision(bytes),
            Input::Referee(bytes, _) => self.operator.referee(now, bytes),
            _ => {}
        }
        self.send(now);
        verdict
    }

    fn send(&mut self, now: protocol::Instant) {
        while let Some(request) = self.host.poll_request() {
            // Without a game controller no thread receives the request.
            let _ = self.channels.ask.send(request);
        }
        if let Some(view) = self.host.poll_view() {
            // Its thread lasts as long as the host asks.
            let _ = self.channels.view.send(view);
        }
        let mut batch = Vec::new();
        while let Some((to, packet)) = self.host.poll_packet() {
            if let Some(recorder) = &mut self.recorder {
                recorder.sent(now, self.us, to, &packet);
            }
            self.counts.sent += 1;
            batch.push((to, packet));
        }
        self.channels.out.lock().unwrap_or_else(PoisonError::into_inner).push(batch, self.host.is_halting());
    }

    fn publish(&mut self, now: protocol::Instant) {
        let Some(packet) = self.publisher.publish(self.host.tracker()) else { return };
        let bytes = packet.encode_to_vec();
        self.lines.extend(self.sender.send(&bytes).map(|line| format!("tracker  {line}")));
        if let Some(recorder) = &mut self.recorder {
            recorder.received(now, MessageKind::Tracker2020, &bytes);
        }
    }

    /// Reports which source the field comes from, where that changes.
    fn look_at_tracker(&mut self, now: protocol::Instant) {
        let Some(tracker) = &mut self.tracker else { return };
        if let Some(line) = tracker.look(now) {
            self.operator.fault(now, line.clone());
            self.lines.push(line);
        }
        self.watch.misses(now, tracker.missing(now));
    }

    /// Reports refused handshakes and frames between robots and host to the operator.
    fn look_at_radio(&mut self, now: protocol::Instant) {
        for line in self.radio_alarms.look(now, self.host.radio()) {
            self.operator.fault(now, line.clone());
            self.lines.push(line);
        }
    }

    fn look_at_alarms(&mut self, now: protocol::Instant, config: &TeamConfig) {
        self.senders.look(now, self.expected_robots(now));
        let vision = format!("{}, {}", config.vision, self.watch.vision_path());
        let (dropped, second) = (self.channels.mail.dropped(), self.senders.second(now));
        let missing = self.watch.missing();
        self.lines.extend(self.alarms.look(now, &self.host, dropped, second, (&vision, missing)));
    }

    /// The robots that the right vision shows, and shows in motion.
    fn expected_robots(&self, now: protocol::Instant) -> ExpectedRobots {
        let mut expected = ExpectedRobots::default();
        for robot in self.host.radio().present(now) {
            expected.heard[robot.index()] = true;
        }
        // In open play a robot with a task never stands for long.
        if !self.host.is_halting() && self.host.game().phase == Phase::Run {
            for order in self.host.orders().iter().filter(|order| !matches!(order.task, Task::Stand)) {
                let robot = order.robot.index();
                expected.ordered[robot] = expected.heard[robot];
            }
        }
        expected
    }

    /// Checks whether the recording keeps up and the disk accepts it.
    fn look_at_recording(&mut self) {
        let Some(recorder) = &self.recorder else { return };
        if recorder.failed() {
            let recorder = self.recorder.take();
            self.end_recording(recorder);
        } else if let (Some(at), false) = (recorder.trace_ended(), self.trace_ended) {
            self.trace_ended = true;
            self.lines.push(format!(
                "recording  the disk is too slow: the trace ends at {:.1} s, the log goes on with gaps",
                at.0 as f64 * 1e-6
            ));
        }
    }

    fn end_recording(&mut self, recorder: Option<BackgroundRecorder>) {
        let Some(recorder) = recorder else { return };
        if recorder.dropped() > 0 {
            self.lines.push(format!(
                "recording  {} messages were dropped: the disk was too slow",
                recorder.dropped()
            ));
        }
        self.recording = recorder.finish();
        if let Err(error) = &self.recording {
            self.lines.push(format!("recording  {error}: nothing more is kept; is the disk full?"));
        }
    }

    /// Halts the robots before the program stops controlling them.
    fn halt(&mut self) {
        let began = Instant::now();
        while began.elapsed() < HALT_TIME {
            let now = self.now();
            self.host.handle(now, Input::Halt);
            if self.host.poll_timeout().is_some_and(|due| due <= now) {
                self.host.handle(now, Input::Timeout);
            }
            self.send(now);
            std::thread::sleep(HALT_EVERY);
        }
    }

    /// The status line for a terminal.
    fn status(&self) -> String {
        let (now, host) = (self.now(), &self.host);
        let seen = host.world().ours(host.settings().us).count();
        format!(
            "{}, vision {} packets{}, {} of ours seen, {} received, {} frames to robots",
            host.game().phase,
            self.counts.vision,
            self.tracker
                .as_ref()
                .map_or_else(String::new, |input| format!(", field by {}", input.source(now))),
            seen,
            host.radio().present(now).count(),
            self.counts.sent
        )
    }
}
