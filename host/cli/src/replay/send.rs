//! `send`: replays a recording's packets to the network, byte for byte, with their original timing.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use clap::Args;
use feed::recording::{LeaguePacket, LeaguePackets, RecordedError, in_file};
use serde::Serialize;
use ssl::log::{MessageKind, guess};
use ssl::net::{NetSender, addresses};

use super::transport::{Due, Transport};
use super::{ReplayArgs, show};
use crate::Failure;
use crate::args::parsers::{destination, machine, match_speed};
use crate::output::{json_line, note, print_text};
use crate::stop::stopped_by_hand;

/// Where packets are sent to, and how fast.
#[derive(Debug, Args)]
pub(super) struct SendArgs {
    /// Replay the recording's packets of vision, referee and trackers to the network, byte for byte and with
    /// their original timing: to the league's groups and ports, or with HOST to the same ports of a host or
    /// multicast group; with --at, from that moment on. With --watch the page shows the recording, and
    /// pauses, moves and speeds up what is sent.
    #[arg(long, value_name = "HOST", num_args = 0..=1, value_parser = machine,
        conflicts_with_all = ["event", "problems", "team", "check", "compare", "cut", "join", "export"])]
    #[expect(clippy::option_option, reason = "clap's form of a flag with an optional value")]
    send: Option<Option<IpAddr>>,
    /// Send vision to this address instead.
    #[arg(long, value_name = "HOST:PORT", value_parser = destination, requires = "send")]
    vision: Option<SocketAddr>,
    /// Send the referee's packets to this address instead.
    #[arg(long, value_name = "HOST:PORT", value_parser = destination, requires = "send")]
    referee: Option<SocketAddr>,
    /// Send trackers' packets to this address instead.
    #[arg(long, value_name = "HOST:PORT", value_parser = destination, requires = "send")]
    tracker: Option<SocketAddr>,
    /// Playback speed, 0.05 to 20; 1 is real time.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = match_speed, requires = "send")]
    speed: f32,
    /// Network interface for multicast, by name or address; by default the system chooses.
    #[arg(long, value_name = "NAME", requires = "send")]
    interface: Option<String>,
}

/// What was sent.
#[derive(Debug, Default, Serialize)]
#[serde(tag = "kind", rename = "sent")]
struct Report {
    file: String,
    from_s: f64,
    to_s: f64,
    /// By the name of the message.
    sent: BTreeMap<&'static str, Channel>,
    /// Number of messages that belong to no channel of the league's network.
    left_out: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    damage: Option<String>,
}

#[derive(Debug, Serialize)]
struct Channel {
    to: SocketAddr,
    packets: u64,
    bytes: u64,
    /// Number of packets that the system refused to send.
    failed: u64,
    #[serde(skip)]
    sender: NetSender,
}

impl Channel {
    fn send(&mut self, name: &str, bytes: &[u8]) {
        let before = self.sender.sent;
        if let Some(trouble) = self.sender.send(bytes) {
            note!("{name}: {trouble}");
        }
        if self.sender.sent > before {
            self.packets += 1;
            self.bytes += bytes.len() as u64;
        } else {
            self.failed += 1;
        }
    }
}

impl SendArgs {
    /// Whether packets are to be sent.
    pub(super) const fn is_wanted(&self) -> bool {
        self.send.is_some()
    }

    /// The name and the destination of a packet; `None` for one of no channel of the league's network.
    fn channel(&self, packet: &LeaguePacket) -> Option<(&'static str, SocketAddr)> {
        let kind = match packet.kind {
            MessageKind::Unknown => guess(&packet.bytes)?,
            kind => kind,
        };
        let (name, group, given) = match kind {
            MessageKind::Vision2014 => ("vision", addresses::VISION, self.vision),
            MessageKind::Vision2010 => ("vision of 2014", addresses::VISION_LEGACY, self.vision),
            MessageKind::Refbox2013 => ("referee", addresses::REFEREE, self.referee),
            MessageKind::Tracker2020 => ("tracker", addresses::TRACKER, self.tracker),
            _ => return None,
        };
        let host = self.send.flatten().unwrap_or(IpAddr::V4(*group.ip()));
        Some((name, given.unwrap_or(SocketAddr::new(host, group.port()))))
    }
}

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let page = if args.watch { Some(show::load(args)?) } else { None };
    if stopped_by_hand().load(Ordering::Relaxed) {
        return Ok(ExitCode::SUCCESS);
    }
    let mut sending = Sending::new(args, Transport::new(args.send.speed, page));
    let mut from_us = args.at.map_or(0, |at| (at * 1e6) as u64);
    while let Some(again_us) = sending.pass(from_us)? {
        from_us = again_us;
    }
    sending.finish()
}

/// A recording on its way to the network.
struct Sending<'a> {
    args: &'a ReplayArgs,
    transport: Transport,
    report: Report,
    /// A packet was due.
    started: bool,
    /// Time of the newest packet that was read, µs.
    last_us: u64,
}

impl<'a> Sending<'a> {
    fn new(args: &'a ReplayArgs, transport: Transport) -> Self {
        let file = args.file.display().to_string();
        let report = Report { file, ..Report::default() };
        Self { args, transport, report, started: false, last_us: 0 }
    }

    /// Sends the file's packets from a time on, µs; the time to start again from, none at the end.
    fn pass(&mut self, mut from_us: u64) -> Result<Option<u64>, Failure> {
        let mut packets = LeaguePackets::open(&self.args.file)?;
        let mut moved = true;
        for packet in packets.by_ref() {
            self.last_us = packet.at.0;
            if self.last_us < from_us {
                continue;
            }
            if std::mem::take(&mut moved) {
                self.start(self.last_us);
            }
            match self.transport.wait_until(self.last_us) {
                Due::Now => self.send(&packet),
                Due::From(later_us) if later_us > self.last_us => (from_us, moved) = (later_us, true),
                Due::From(earlier_us) => return Ok(Some(earlier_us)),
                Due::Stopped => return Ok(None),
            }
        }
        self.report.damage = packets.damage();
        if !self.transport.has_page() || !self.started {
            return Ok(None);
        }
        match self.transport.wait_at_end(self.last_us) {
            Due::From(again_us) => Ok(Some(again_us)),
            Due::Now | Due::Stopped => Ok(None),
        }
    }

    /// Time goes on from the first packet that is wanted.
    fn start(&mut self, at_us: u64) {
        self.transport.set(at_us);
        if !std::mem::replace(&mut self.started, true) {
            self.report.from_s = at_us as f64 * 1e-6;
            let speed = self.args.send.speed;
            note!("sending from {:.3} s at {speed} × real time; Ctrl-C stops", self.report.from_s);
        }
    }

    fn send(&mut self, packet: &LeaguePacket) {
        self.report.to_s = packet.at.0 as f64 * 1e-6;
        let args = &self.args.send;
        let Some((name, to)) = args.channel(packet) else {
            self.report.left_out += 1;
            return;
        };
        let channel = self.report.sent.entry(name).or_insert_with(|| {
            let sender = NetSender::new(to, args.interface.as_deref());
            Channel { to, packets: 0, bytes: 0, failed: 0, sender }
        });
        channel.send(name, &packet.bytes);
    }

    fn finish(self) -> Result<ExitCode, Failure> {
        let Self { args, report, started, last_us, .. } = self;
        if !started {
            let asked = match args.at {
                Some(at) => format!("it ends after {:.3} s, before {at} s", last_us as f64 * 1e-6),
                None => "it holds no packet".to_owned(),
            };
            let missing = RecordedError::NotThere { asked, damage: report.damage };
            return Err(in_file(&args.file)(missing).into());
        }
        print_text(&if args.json { json_line(&report)? } else { report.text() })?;
        let failed = report.sent.values().any(|channel| channel.failed > 0);
        match report.damage {
            Some(damage) => Err(in_file(&args.file)(RecordedError::Damaged(damage)).into()),
            None if failed || report.sent.is_empty() => Ok(ExitCode::FAILURE),
            None => Ok(ExitCode::SUCCESS),
        }
    }
}

impl Report {
    fn text(&self) -> String {
        let mut lines = vec![format!("sent     {:.3} s to {:.3} s of {}", self.from_s, self.to_s, self.file)];
        for (name, channel) in &self.sent {
            let Channel { to, packets, bytes, failed, .. } = channel;
            let failed = if *failed > 0 { format!(", {failed} could not be sent") } else { String::new() };
            lines.push(format!("         {name} to {to}: {packets} packets, {bytes} bytes{failed}"));
        }
        if self.left_out > 0 {
            lines.push(format!("         {} messages of other kinds left out", self.left_out));
        }
        lines.join("\n") + "\n"
    }
}
