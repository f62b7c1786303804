//! The desk: whatever comes by the channel goes to the host with the time of a monotonic clock, and what the host says goes out.
//!
//! Event-driven: it waits for mail or for the host's deadline, whichever is first. Times on the host's clock, which shows 0 when
//! the program starts.

use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use host::config::TeamConfig;
use host::radio::{RadioSettings, To};
use host::recording::{HostHeader, RecordingHeader};
use host::referee::team_port::Request;
use host::shell::{Recorder, SimSettings, key};
use host::tracking::{Heard, Publisher};
use host::{Host, HostSettings, Input, Verdict};
use indicatif::ProgressBar;
use protocol::RobotId;
use protocol::frame::TeamKey;
use protocol::link::Packet;
use rules::Colour;
use ssl::Message;
use ssl::log::MessageKind;
use ssl::net::Interfaces;

use super::board::Board;
use super::threads::{self, Mail, Source};
use super::watch::Watch;
use super::{Cases, port_for_teams, simulator};
use crate::Failure;
use crate::live::PageArgs;
use crate::net::Mouth;
use crate::stop::stopped_by_hand;

/// Looks at what is missing, and at Ctrl-C, at least this often.
const LOOK: Duration = Duration::from_millis(100);
/// HALT is sent so long before the program ends: thirty pictures, so that a lossy radio brings one of them.
const HALTING: Duration = Duration::from_millis(300);
/// One HALT after the other.
const HALT_EVERY: Duration = Duration::from_millis(10);

/// Runs until somebody ends it.
pub(super) fn run(
    config: &TeamConfig,
    robots: &[RobotId],
    cases: Cases,
    record: Option<&Path>,
    duration: Option<f64>,
    page: Option<&PageArgs>,
) -> Result<ExitCode, Failure> {
    let stopped = stopped_by_hand();
    let key = team_key(config)?;
    let Cases { shelf, settings: retrieval, words } = cases;
    let link = open_link(config, robots, key, words)?;
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let usual = HostSettings::new(config.colour, config.league, unix.as_secs() as u32);
    let settings = HostSettings {
        keeper: config.keeper,
        kick: config.kick,
        radio: RadioSettings { key, relay: link.relay(), ..usual.radio },
        ..usual
    };
    let recorder = record.map(|stem| {
        Recorder::begin(stem, &header(&settings))
            .map_err(|error| Failure::Network(format!("--record {}: {error}", stem.display())))
    });
    let recorder = recorder.transpose()?;
    eprintln!(
        "controlling {}, {}, {}; Ctrl-C halts the robots and ends it",
        config.name,
        config.colour.word(),
        config.league.name()
    );

    let title = format!("{}, {}", config.name, config.colour.word());
    let board = page.and_then(|args| Board::open(args, title, shelf, retrieval));

    let (mail, inbox) = mpsc::channel();
    let (out, frames) = mpsc::channel();
    let end = Arc::new(AtomicBool::new(false));
    let by = config.interface.map_or(Interfaces::All, |ip| Interfaces::These(vec![ip.to_string()]));
    let watch = Watch::new(link.advice());
    let mut threads = vec![
        threads::hear(Source::Vision, config.vision, by.clone(), mail.clone(), end.clone()),
        threads::hear(Source::Referee, config.referee, by, mail.clone(), end.clone()),
        threads::carry(link, frames, mail.clone(), end.clone()),
    ];
    let (ask, asked) = mpsc::channel();
    if let Some(address) = config.game_controller {
        let who = (config.name.clone(), config.colour, config.keeper);
        threads.push(port_for_teams::talk(address, who, asked, mail.clone(), end.clone()));
    }
    drop(mail);
    let speaks_by = config.interface.map(|ip| ip.to_string());
    let mut desk = Desk {
        host: Host::new(settings, protocol::Instant(0)),
        began: Instant::now(),
        out,
        ask,
        us: config.colour,
        recorder,
        recording: Ok(()),
        watch,
        publisher: Publisher::new(
            &format!("onetwo-{}-{}", config.colour.word(), unix.as_secs()),
            &config.name,
        ),
        mouth: Mouth::new(config.tracker, speaks_by.as_deref()),
        counts: Counts::default(),
        words: Vec::new(),
        board,
    };
    let bar = ProgressBar::new_spinner();
    let mut looked = Instant::now();
    while !stopped.load(Ordering::Relaxed) && duration.is_none_or(|s| desk.began.elapsed().as_secs_f64() < s)
    {
        desk.wait(&inbox);
        desk.show();
        if looked.elapsed() >= LOOK {
            looked = Instant::now();
            let now = desk.now();
            desk.watch.look(now, &desk.host, config, &mut desk.words);
            if desk.recorder.as_ref().is_some_and(Recorder::failed) {
                desk.end_recording();
            }
            bar.set_message(desk.status());
            bar.tick();
        }
        for words in desk.words.drain(..) {
            bar.suspend(|| eprintln!("{words}"));
        }
    }
    bar.finish_and_clear();
    desk.end_recording();
    desk.halt();
    end.store(true, Ordering::Relaxed);
    let Desk { counts, out, recording, .. } = desk;
    drop(out);
    for thread in threads {
        let _ = thread.join();
    }
    eprintln!(
        "robots halted; ended after {} vision and {} referee packets, {} frames from robots and {} to them",
        counts.vision, counts.referee, counts.robots, counts.sent
    );
    recording.map_err(|error| Failure::Recording(format!("it is not whole: {error}")))?;
    Ok(ExitCode::SUCCESS)
}

/// With what the host begins; its clock shows 0 now.
fn header(settings: &HostSettings) -> RecordingHeader {
    let unix = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    RecordingHeader {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("ONETWO_COMMIT").to_owned(),
        seed: None,
        league: settings.league.name().to_owned(),
        zero_unix_us: Some(unix.as_micros() as u64),
        hosts: vec![HostHeader::of(settings, protocol::Instant(0))],
    }
}

fn team_key(config: &TeamConfig) -> Result<TeamKey, Failure> {
    let Some(file) = &config.key_file else { return Ok(TeamKey::ZERO) };
    let read = key::read(file).map_err(|error| Failure::Network(error.to_string()))?;
    if let Some(warning) = read.warning {
        eprintln!("warning: {warning}");
    }
    Ok(read.key)
}

fn open_link(
    config: &TeamConfig,
    robots: &[RobotId],
    key: TeamKey,
    more: Vec<OsString>,
) -> Result<Box<dyn host::shell::Link>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Network(error.to_string());
    let at = match &config.robots {
        host::config::RobotLink::Simulator(host) => simulator(host, config.colour)?,
        _ => ([127, 0, 0, 1], 0).into(),
    };
    let program = std::env::current_exe().map_err(|error| failed(&error))?;
    let sim = |_: &str| SimSettings {
        program,
        colour: config.colour,
        league: config.league,
        robots: robots.to_vec(),
        simulator: at,
        key,
        more,
    };
    host::shell::open(&config.robots, sim).map_err(|error| failed(&error))
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    vision: u64,
    referee: u64,
    robots: u64,
    sent: u64,
}

struct Desk {
    host: Host,
    began: Instant,
    out: Sender<(To, Packet)>,
    /// What is asked of the game controller.
    ask: Sender<Request>,
    us: Colour,
    recorder: Option<Recorder>,
    /// How a recording ended that ended before the match.
    recording: io::Result<()>,
    watch: Watch,
    publisher: Publisher,
    mouth: Mouth,
    counts: Counts,
    words: Vec<String>,
    board: Option<Board>,
}

impl Desk {
    fn now(&self) -> protocol::Instant {
        protocol::Instant(self.began.elapsed().as_micros() as u64)
    }

    /// Waits for mail or the host's deadline, and does what it brings.
    fn wait(&mut self, inbox: &Receiver<Mail>) {
        let due = self.host.poll_timeout().map(|due| Duration::from_micros(due.since(self.now()).0));
        match inbox.recv_timeout(due.unwrap_or(LOOK).min(LOOK)) {
            Ok(mail) => self.open(mail),
            // Everybody has hung up: nothing will come but deadlines.
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(HALT_EVERY),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let now = self.now();
        if self.host.poll_timeout().is_some_and(|due| due <= now) {
            self.tell(now, Input::Timeout);
        }
    }

    fn open(&mut self, mail: Mail) {
        let now = self.now();
        match mail {
            Mail::Vision(bytes) => {
                self.counts.vision += 1;
                self.watch.vision_came(now);
                if matches!(
                    self.tell(now, Input::Vision(&bytes)),
                    Verdict::Vision(Heard::Newest | Heard::Restarted)
                ) {
                    self.publish(now);
                }
            }
            Mail::Referee(bytes) => {
                self.counts.referee += 1;
                self.tell(now, Input::Referee(&bytes));
            }
            Mail::Robot(packet) => {
                self.counts.robots += 1;
                self.tell(now, Input::Robot(&packet));
            }
            Mail::Open(source, way) => self.watch.open(source, &way),
            Mail::Trouble(source, words) => {
                let words = self.watch.trouble(source, &words);
                self.words.push(words);
            }
            Mail::Word(words) => self.words.push(words),
        }
    }

    /// One input, then what the host says to it.
    fn tell(&mut self, now: protocol::Instant, input: Input<'_>) -> Verdict {
        if let Some(recorder) = &mut self.recorder {
            let heard = match input {
                Input::Vision(bytes) => Some((MessageKind::Vision2014, bytes)),
                Input::Referee(bytes) => Some((MessageKind::Refbox2013, bytes)),
                Input::Robot(_) | Input::Timeout => None,
            };
            if let Some((kind, bytes)) = heard {
                recorder.heard(now, kind, bytes);
            }
            recorder.input(now, self.us, input);
        }
        let began = Instant::now();
        let verdict = self.host.handle(now, input);
        if let Some(board) = &mut self.board {
            board.took(began.elapsed());
            match input {
                Input::Vision(bytes) => board.vision(bytes),
                Input::Referee(bytes) => board.referee(bytes, now),
                Input::Robot(_) | Input::Timeout => {}
            }
        }
        self.send(now);
        verdict
    }

    fn send(&mut self, now: protocol::Instant) {
        while let Some(request) = self.host.poll_request() {
            // Without a controller to ask there is no thread that takes it.
            let _ = self.ask.send(request);
        }
        while let Some((to, packet)) = self.host.poll_packet() {
            if let Some(recorder) = &mut self.recorder {
                recorder.sent(now, self.us, to, &packet);
            }
            self.counts.sent += 1;
            let _ = self.out.send((to, packet));
        }
    }

    /// The moment on the page, and HALT if somebody there asks for it.
    fn show(&mut self) {
        let now = self.now();
        let Some(board) = &mut self.board else { return };
        if board.look(now, &self.host) {
            self.words.push("HALT was asked for on the page: the robots stand until the end".to_owned());
            self.host.halt(now);
            self.send(now);
        }
    }

    fn publish(&mut self, now: protocol::Instant) {
        let Some(packet) = self.publisher.publish(self.host.tracker()) else { return };
        let bytes = packet.encode_to_vec();
        self.words.extend(self.mouth.send(&bytes).map(|words| format!("tracker  {words}")));
        if let Some(recorder) = &mut self.recorder {
            recorder.heard(now, MessageKind::Tracker2020, &bytes);
        }
    }

    fn end_recording(&mut self) {
        let Some(recorder) = self.recorder.take() else { return };
        self.recording = recorder.finish();
        if let Err(error) = &self.recording {
            self.words.push(format!("recording  {error}: nothing more is kept; is the disk full?"));
        }
    }

    /// Robots stand before nobody leads them any more.
    fn halt(&mut self) {
        let began = Instant::now();
        while began.elapsed() < HALTING {
            let now = self.now();
            self.host.halt(now);
            if self.host.poll_timeout().is_some_and(|due| due <= now) {
                self.host.handle(now, Input::Timeout);
            }
            self.send(now);
            std::thread::sleep(HALT_EVERY);
        }
    }

    /// A line for a terminal.
    fn status(&self) -> String {
        let (now, host) = (self.now(), &self.host);
        let seen = host.world().ours(host.settings().us).count();
        format!(
            "{}, vision {} packets, {} of ours seen, {} heard, {} frames to robots",
            crate::replay::phase_words(host.game().phase),
            self.counts.vision,
            seen,
            host.radio().present(now).count(),
            self.counts.sent
        )
    }
}
