//! `send`: replays a recording's packets to the network, byte for byte, with their original timing.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::thread::sleep;
use std::time::{Duration, Instant};

use clap::Args;
use feed::recording::{LeaguePacket, LeaguePackets, RecordedError, in_file};
use serde::Serialize;
use ssl::log::{MessageKind, guess};
use ssl::net::{NetSender, addresses};

use super::ReplayArgs;
use crate::Failure;
use crate::args::parsers::{destination, machine, match_speed};
use crate::output::{json_line, note, print_text};
use crate::stop::stopped_by_hand;

/// Where packets are sent to, and how fast.
#[derive(Debug, Args)]
pub(super) struct SendArgs {
    /// Replay the recording's packets of vision, referee and trackers to the network, byte for byte and with
    /// their original timing: to the league's groups and ports, or with HOST to the same ports of a host or
    /// multicast group; with --at, from that moment on.
    #[arg(long, value_name = "HOST", num_args = 0..=1, value_parser = machine,
        conflicts_with_all = ["watch", "event", "problems", "team", "check", "compare", "cut", "join", "export"])]
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
#[derive(Debug, Serialize)]
struct Report {
    kind: &'static str,
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
    let mut packets = LeaguePackets::open(&args.file)?;
    let from_us = args.at.map_or(0, |at| (at * 1e6) as u64);
    let mut report = Report {
        kind: "sent",
        file: args.file.display().to_string(),
        from_s: 0.0,
        to_s: 0.0,
        sent: BTreeMap::new(),
        left_out: 0,
        damage: None,
    };
    let (mut pace, mut last_us, stopped) = (None, 0, stopped_by_hand());
    for packet in packets.by_ref() {
        last_us = packet.at.0;
        if last_us < from_us {
            continue;
        }
        let pace = pace.get_or_insert_with(|| {
            report.from_s = last_us as f64 * 1e-6;
            note!("sending from {:.3} s at {} × real time; Ctrl-C stops", report.from_s, args.send.speed);
            Pace { start: Instant::now(), start_us: last_us, speed: args.send.speed }
        });
        pace.wait_until(last_us);
        if stopped.load(Ordering::Relaxed) {
            break;
        }
        report.to_s = last_us as f64 * 1e-6;
        let Some((name, to)) = args.send.channel(&packet) else {
            report.left_out += 1;
            continue;
        };
        let channel = report.sent.entry(name).or_insert_with(|| {
            let sender = NetSender::new(to, args.send.interface.as_deref());
            Channel { to, packets: 0, bytes: 0, failed: 0, sender }
        });
        channel.send(name, &packet.bytes);
    }
    if pace.is_none() {
        let asked = match args.at {
            Some(at) => format!("it ends after {:.3} s, before {at} s", last_us as f64 * 1e-6),
            None => "it holds no packet".to_owned(),
        };
        return Err(in_file(&args.file)(RecordedError::NotThere { asked, damage: packets.damage() }).into());
    }
    report.damage = packets.damage();
    print_text(&if args.json { json_line(&report)? } else { report.text() })?;
    let failed = report.sent.values().any(|channel| channel.failed > 0);
    match report.damage {
        Some(damage) => Err(in_file(&args.file)(RecordedError::Damaged(damage)).into()),
        None if failed || report.sent.is_empty() => Ok(ExitCode::FAILURE),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// Schedule of packets on this computer's clock.
struct Pace {
    start: Instant,
    /// Time of the first packet, µs.
    start_us: u64,
    speed: f32,
}

impl Pace {
    /// Waits until a packet is due. After a suspension of the program the schedule is shifted, so that
    /// packets keep their intervals instead of leaving in a burst.
    fn wait_until(&mut self, at_us: u64) {
        let since_s = at_us.saturating_sub(self.start_us) as f64 * 1e-6 / f64::from(self.speed);
        let due = self.start + Duration::from_secs_f64(since_s);
        while let Some(left) = due.checked_duration_since(Instant::now()).filter(|left| !left.is_zero()) {
            sleep(left.min(WAIT_MAX));
            if stopped_by_hand().load(Ordering::Relaxed) {
                return;
            }
        }
        let late = due.elapsed();
        if late > LATE_MAX {
            self.start += late;
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

/// Longest sleep between two checks for Ctrl-C: no operator notices the delay.
const WAIT_MAX: Duration = Duration::from_millis(100);
/// A packet that is later than this was held up by a suspended program, not by the scheduler: loops of the
/// league's programs are 10 to 20 ms, and a loaded machine delays by 100 ms.
const LATE_MAX: Duration = Duration::from_millis(500);
