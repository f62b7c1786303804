//! `event_loop`: event loop of `onetwo control`: feeds what arrives on the channel to the host, with the time
//! of a monotonic clock, and sends the host's packets.
//!
//! Event-driven: it waits for mail or for the host's deadline, whichever is first. Times on the host's clock,
//! which is 0 when the program starts.

mod requests;

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use host::config::TeamConfig;
use host::radio::RadioSettings;
use host::record::header::RecordingHeader;
use host::record::{BackgroundRecorder, Recorder};
use host::referee::team_port::TeamPortRequest;
use host::shell::{Outbox, SimSettings, StrategyProcess};
use host::tracking::{Publisher, VisionVerdict};
use host::{Host, HostSettings, Input, InputVerdict};
use page::Powers;
use protocol::RobotId;
use protocol::frame::TeamKey;
use rules::Colour;
use ssl::Message;
use ssl::log::MessageKind;
use ssl::net::Interfaces;

use super::alarms::Alarms;
use super::board::Board;
use super::failure::ControlError;
use super::inbox::{Inbox, Mail, Source};
use super::radio_alarms::RadioAlarms;
use super::terminal::Terminal;
use super::threads;
use super::tuning::{Tuning, keep_learned};
use super::watch::Watch;
use super::{Cases, port_for_teams, simulator};
use crate::Failure;
use crate::args::page::PageArgs;
use crate::identity;
use crate::net::NetSender;
use crate::output::note;
use crate::stop::stopped_by_hand;

/// Longest time between two checks for missing sources and Ctrl-C.
const LOOK: Duration = Duration::from_millis(100);
/// An answer of the team's own strategy takes at most this long: it is started again if it has hung. Its
/// robots stand long before ([`host::external::ANSWERS_WITHIN`]).
const STRATEGY_PATIENCE: Duration = Duration::from_secs(1);
/// HALT is sent for this time before the program ends: thirty snapshots, so that one of them arrives over a
/// lossy radio.
const HALTING: Duration = Duration::from_millis(300);
/// Period of HALT frames.
const HALT_EVERY: Duration = Duration::from_millis(10);

/// Files that are written, and by whom.
pub(super) struct Keeps<'p> {
    /// The recording of the match, as `onetwo replay` takes it.
    pub(super) record: Option<&'p Path>,
    /// Learned values, as lines of `team.toml`.
    pub(super) learned: Option<&'p Path>,
    /// The team's file that was read; changed parameters are saved to it.
    pub(super) config: Option<&'p Path>,
    /// The page may change parameters.
    pub(super) live: bool,
}

/// Runs until the operator ends it.
pub(super) fn run(
    config: &TeamConfig,
    learns: bool,
    robots: &[RobotId],
    cases: Cases,
    keeps: &Keeps<'_>,
    duration: Option<f64>,
    page: Option<&PageArgs>,
) -> Result<ExitCode, Failure> {
    let stopped = stopped_by_hand();
    let key = identity::team_key(config)?;
    let Cases { library_handle, settings: retrieval, robot_arguments } = cases;
    let link = open_link(config, robots, key, robot_arguments)?;
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let usual = HostSettings::new(config.colour, config.league, identity::this_epoch(config));
    let settings = HostSettings {
        keeper: config.keeper,
        referee: config.referee_source.clone(),
        referee_silence: config.referee_silence,
        kick: config.kick,
        roll: config.roll,
        limits: config.limits,
        tactics: config.tactics,
        learns,
        radio: RadioSettings { key, relay: link.relay(), ..usual.radio },
        external: config.strategy.is_some(),
        cases: library_handle.as_ref().map(arena::cases::LibraryHandle::lasting_base),
        ..usual
    };
    let strategy =
        config.strategy.as_deref().map(|command| StrategyProcess::start(command, STRATEGY_PATIENCE));
    let strategy = strategy.transpose().map_err(ControlError::Strategy)?;
    let recorder = keeps.record.map(|stem| {
        Recorder::begin(stem, &header(&settings))
            .and_then(BackgroundRecorder::start)
            .map_err(|error| ControlError::Record(stem.to_owned(), error))
    });
    let recorder = recorder.transpose()?;
    note!(
        "controlling {}, {}, {}; Ctrl-C halts the robots and ends it",
        config.name,
        config.colour.label(),
        config.league.name()
    );

    let title = format!("{}, {}", config.name, config.colour.label());
    let powers = if keeps.live { Powers::Tune } else { Powers::Halt };
    let board = page.and_then(|args| Board::open(args, title, powers, library_handle, retrieval));

    let mail = Arc::new(Inbox::new());
    let out = Arc::new(Mutex::new(Outbox::default()));
    let end = Arc::new(AtomicBool::new(false));
    let by = config.interface.map_or(Interfaces::All, |ip| Interfaces::These(vec![ip.to_string()]));
    let watch = Watch::new(link.advice());
    let mut threads = vec![
        threads::receive(Source::Vision, config.vision, by.clone(), mail.clone(), end.clone()),
        threads::receive(Source::Referee, config.referee, by, mail.clone(), end.clone()),
        threads::carry(link, out.clone(), mail.clone(), end.clone()),
    ];
    let (ask, asked) = mpsc::channel();
    if let Some(address) = config.game_controller {
        let who = (config.name.clone(), config.colour, config.keeper);
        threads.push(port_for_teams::talk(address, who, asked, mail.clone(), end.clone()));
    }
    let (view, views) = mpsc::channel();
    if let Some(strategy) = strategy {
        threads.push(threads::ask_strategy(strategy, views, mail.clone(), end.clone()));
    }
    let speaks_by = config.interface.map(|ip| ip.to_string());
    let mut event_loop = EventLoop {
        host: Host::new(settings, protocol::Instant(0)),
        began: Instant::now(),
        out,
        ask,
        view,
        us: config.colour,
        recorder,
        recording: Ok(()),
        trace_ended: false,
        watch,
        alarms: Alarms::default(),
        radio_alarms: RadioAlarms::default(),
        publisher: Publisher::new(
            &format!("onetwo-{}-{}", config.colour.label(), unix.as_secs()),
            &config.name,
        ),
        sender: NetSender::new(config.tracker, speaks_by.as_deref()),
        counts: Counts::default(),
        description: Vec::new(),
        board,
        tuning: Tuning::new(config, keeps.config),
    };
    let mut terminal = Terminal::open();
    let mut looked = Instant::now();
    while !stopped.load(Ordering::Relaxed)
        && duration.is_none_or(|s| event_loop.began.elapsed().as_secs_f64() < s)
    {
        event_loop.wait(&mail);
        event_loop.show();
        if looked.elapsed() >= LOOK {
            looked = Instant::now();
            let now = event_loop.now();
            event_loop.watch.look(now, &event_loop.host, config, &mut event_loop.description);
            event_loop.look_at_alarms(now, config, &mail);
            event_loop.look_at_recording();
            event_loop.look_at_radio(now);
            terminal.status(event_loop.status());
        }
        event_loop.description.drain(..).for_each(|description| terminal.line(description));
    }
    // HALT before anything that may wait: the disk, the terminal.
    let recorder = event_loop.recorder.take();
    event_loop.halt();
    end.store(true, Ordering::Relaxed);
    for thread in threads {
        let _ = thread.join();
    }
    terminal.close();
    event_loop.end_recording(recorder);
    event_loop.description.extend(keeps.learned.map(|path| keep_learned(path, event_loop.host.learned())));
    event_loop.description.drain(..).for_each(|description| note!("{description}"));
    let EventLoop { counts, recording, .. } = event_loop;
    note!(
        "robots halted; ended after {} vision and {} referee packets, {} frames from robots and {} to them",
        counts.vision,
        counts.referee,
        counts.robots,
        counts.sent
    );
    recording.map_err(|error| Failure::Recording { stem: None, error })?;
    Ok(ExitCode::SUCCESS)
}

fn header(settings: &HostSettings) -> RecordingHeader {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    RecordingHeader {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("ONETWO_COMMIT").to_owned(),
        zero_unix_us: Some(unix.as_micros() as u64),
        ..RecordingHeader::of(settings)
    }
}

fn open_link(
    config: &TeamConfig,
    robots: &[RobotId],
    key: TeamKey,
    more: Vec<OsString>,
) -> Result<Box<dyn host::shell::Link>, Failure> {
    let at = match &config.robots {
        host::config::RobotLink::Simulator(host) => simulator(host, config.colour)?,
        _ => ([127, 0, 0, 1], 0).into(),
    };
    let program = std::env::current_exe()?;
    let sim = |_: &str| SimSettings {
        program,
        colour: config.colour,
        league: config.league,
        robots: robots.to_vec(),
        simulator: at,
        key,
        more,
    };
    Ok(host::shell::open(&config.robots, sim)?)
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    vision: u64,
    referee: u64,
    robots: u64,
    sent: u64,
}

struct EventLoop {
    host: Host,
    began: Instant,
    /// Requests to the game controller.
    ask: Sender<TeamPortRequest>,
    /// Views for the team's own strategy.
    view: Sender<String>,
    out: Arc<Mutex<Outbox>>,
    us: Colour,
    recorder: Option<BackgroundRecorder>,
    /// Error of a recording that ended before the match.
    recording: io::Result<()>,
    /// Whether the end of the trace was reported.
    trace_ended: bool,
    watch: Watch,
    alarms: Alarms,
    radio_alarms: RadioAlarms,
    publisher: Publisher,
    sender: NetSender,
    counts: Counts,
    description: Vec<String>,
    board: Option<Board>,
    tuning: Tuning,
}

impl EventLoop {
    fn now(&self) -> protocol::Instant {
        protocol::Instant(self.began.elapsed().as_micros() as u64)
    }

    /// Waits for mail or the host's deadline, and handles it.
    fn wait(&mut self, inbox: &Inbox) {
        let due = self.host.poll_timeout().map(|due| Duration::from_micros(due.since(self.now()).0));
        if let Some(mail) = inbox.take(due.unwrap_or(LOOK).min(LOOK)) {
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
            Mail::Vision(bytes) => {
                self.counts.vision += 1;
                if matches!(
                    self.feed(now, Input::Vision(&bytes)),
                    InputVerdict::Vision(VisionVerdict::Newest | VisionVerdict::Restarted)
                ) {
                    self.publish(now);
                }
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
                if let InputVerdict::NoAnswer(error) = self.feed(now, Input::Orders(line.as_bytes())) {
                    self.alarms.bad_answer(now, format!("strategy  an answer is refused: {error}"));
                }
            }
            Mail::Open(source, description_of_path) => self.watch.open(source, &description_of_path),
            Mail::Trouble(source, description) => {
                let description = self.watch.trouble(source, &description);
                self.description.push(description);
            }
            Mail::Label(description) => self.description.push(description),
            Mail::Slow(description) => self.alarms.slow(now, description),
        }
    }

    /// Feeds one input to the host, then handles its output.
    fn feed(&mut self, now: protocol::Instant, input: Input<'_>) -> InputVerdict {
        if let Some(recorder) = &mut self.recorder {
            let received = match input {
                Input::Vision(bytes) => Some((MessageKind::Vision2014, bytes)),
                Input::Referee(bytes, _) => Some((MessageKind::Refbox2013, bytes)),
                Input::Robot(_)
                | Input::Orders(_)
                | Input::Parameter(_)
                | Input::Test(_)
                | Input::Halt
                | Input::Timeout => None,
            };
            if let Some((kind, bytes)) = received {
                recorder.received(now, kind, bytes);
            }
            recorder.input(now, self.us, input);
        }
        let began = Instant::now();
        let verdict = self.host.handle(now, input);
        if let Some(board) = &mut self.board {
            board.took(began.elapsed());
            match input {
                Input::Vision(bytes) => board.vision(bytes),
                Input::Referee(bytes, _) => board.referee(bytes, now),
                Input::Robot(_)
                | Input::Orders(_)
                | Input::Parameter(_)
                | Input::Test(_)
                | Input::Halt
                | Input::Timeout => {}
            }
        }
        self.send(now);
        verdict
    }

    fn send(&mut self, now: protocol::Instant) {
        while let Some(request) = self.host.poll_request() {
            // Without a game controller no thread receives the request.
            let _ = self.ask.send(request);
        }
        if let Some(view) = self.host.poll_view() {
            // Its thread lasts as long as the host asks.
            let _ = self.view.send(view);
        }
        let mut batch = Vec::new();
        while let Some((to, packet)) = self.host.poll_packet() {
            if let Some(recorder) = &mut self.recorder {
                recorder.sent(now, self.us, to, &packet);
            }
            self.counts.sent += 1;
            batch.push((to, packet));
        }
        self.out.lock().unwrap_or_else(PoisonError::into_inner).push(batch, self.host.is_halting());
    }

    fn publish(&mut self, now: protocol::Instant) {
        let Some(packet) = self.publisher.publish(self.host.tracker()) else { return };
        let bytes = packet.encode_to_vec();
        self.description
            .extend(self.sender.send(&bytes).map(|description| format!("tracker  {description}")));
        if let Some(recorder) = &mut self.recorder {
            recorder.received(now, MessageKind::Tracker2020, &bytes);
        }
    }

    /// Reports refused handshakes and frames between robots and host on terminal and page.
    fn look_at_radio(&mut self, now: protocol::Instant) {
        for description in self.radio_alarms.look(now, self.host.radio()) {
            if let Some(board) = &mut self.board {
                board.fault(now, description.clone());
            }
            self.description.push(description);
        }
    }

    fn look_at_alarms(&mut self, now: protocol::Instant, config: &TeamConfig, inbox: &Inbox) {
        let description_of_path = self.watch.vision_path();
        let vision = || format!("{}, {description_of_path}", config.vision);
        self.description.extend(self.alarms.look(now, &self.host, inbox.dropped(), vision));
    }

    /// Checks whether the recording keeps up and the disk accepts it.
    fn look_at_recording(&mut self) {
        let Some(recorder) = &self.recorder else { return };
        if recorder.failed() {
            let recorder = self.recorder.take();
            self.end_recording(recorder);
        } else if let (Some(at), false) = (recorder.trace_ended(), self.trace_ended) {
            self.trace_ended = true;
            self.description.push(format!(
                "recording  the disk is too slow: the trace ends at {:.1} s, the log goes on with gaps",
                at.0 as f64 * 1e-6
            ));
        }
    }

    fn end_recording(&mut self, recorder: Option<BackgroundRecorder>) {
        let Some(recorder) = recorder else { return };
        if recorder.dropped() > 0 {
            self.description.push(format!(
                "recording  {} messages were dropped: the disk was too slow",
                recorder.dropped()
            ));
        }
        self.recording = recorder.finish();
        if let Err(error) = &self.recording {
            self.description.push(format!("recording  {error}: nothing more is kept; is the disk full?"));
        }
    }

    /// Halts the robots before the program stops controlling them.
    fn halt(&mut self) {
        let began = Instant::now();
        while began.elapsed() < HALTING {
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
            "{}, vision {} packets, {} of ours seen, {} received, {} frames to robots",
            host.game().phase,
            self.counts.vision,
            seen,
            host.radio().present(now).count(),
            self.counts.sent
        )
    }
}
