//! `onetwo robot scan`: the power on the radio's channels, as a base station with a chip nRF24L01+ measures
//! it (protocol/SPEC.md: StationMessage). Only while no host speaks: a base station in play refuses.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use host::config::RobotLink;
use host::radio::To;
use host::shell::{Link as _, SerialLink};
use protocol::station::{self, CHANNEL_MAX, CHANNEL_MIN, SCANNED, StationMessage};
use serde::Deserialize;
use serde_json::json;

use crate::Failure;
use crate::output::{note, print_text};

/// Arguments of `robot scan`.
#[derive(Debug, Args)]
pub(crate) struct ScanArgs {
    /// The base station, as for `onetwo control`: `serial:DEVICE[:BAUD]`.
    #[arg(long, value_name = "LINK")]
    robots: String,
    /// How often each channel is measured; a sweep takes a tenth of a second.
    #[arg(long, value_name = "N", default_value = "50", value_parser = clap::value_parser!(u8).range(1..))]
    sweeps: u8,
    /// One JSON object: sweeps, counts of channels 0 on, the quietest channels.
    #[arg(long)]
    json: bool,
}

/// Why there is no spectrum.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ScanError {
    /// Only base stations with a chip measure.
    #[error("--robots {0}: no base station at a serial line; give serial:DEVICE[:BAUD]")]
    NoStation(String),
    /// The base station leads robots.
    #[error("the base station at {0} has frames of a host: robots are led by it; end `onetwo control` first")]
    InPlay(String),
    /// Nothing came.
    #[error(
        "the base station at {0} does not answer: is its image of this release, its chip wired, and the line's rate right?"
    )]
    Silent(String),
    /// The file of a scan cannot be read.
    #[error("{}: {error}", foreign::printable_path(.0), error = .1)]
    Unreadable(PathBuf, std::io::Error),
    /// It is none.
    #[error("{}: no scan ({why}); write one with `onetwo robot scan --robots LINK --json`", foreign::printable_path(.0), why = .1)]
    NoScan(PathBuf, String),
}

/// Power on the channels, as `--json` prints it.
#[derive(Debug, Deserialize)]
pub(crate) struct Spectrum {
    sweeps: u8,
    /// Sweeps with power, for channels 0 on.
    counts: Vec<u8>,
}

impl Spectrum {
    /// Reads the output of `robot scan --json` from a file.
    pub(crate) fn read(path: &Path) -> Result<Self, ScanError> {
        let text = foreign::read_text(path, SCAN_LEN_MAX)
            .map_err(|error| ScanError::Unreadable(path.to_owned(), error))?;
        Self::parse(&text).map_err(|why| ScanError::NoScan(path.to_owned(), why))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let scan: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if scan.sweeps == 0 || scan.counts.is_empty() || scan.counts.len() > SCANNED {
            return Err(format!("{} sweeps of {} channels", scan.sweeps, scan.counts.len()));
        }
        match (0_u8..).zip(&scan.counts).find(|(_, count)| **count > scan.sweeps) {
            Some((at, count)) => Err(format!("channel {at}: power in {count} of {} sweeps", scan.sweeps)),
            None => Ok(scan),
        }
    }

    /// What the page shows, with the team's channel.
    pub(crate) fn to_page(&self, channel: u8) -> serde_json::Value {
        let quietest = quietest(&self.counts);
        json!({ "sweeps": self.sweeps, "counts": self.counts, "quietest": quietest, "channel": channel })
    }
}

/// Longest file that is read, bytes: 84 counts take some 400.
const SCAN_LEN_MAX: u64 = 10_000;

/// Longest time of a sweep in the base station, and of all besides.
const SWEEP_MAX: Duration = Duration::from_millis(120);
const ANSWER_MAX: Duration = Duration::from_secs(2);
/// A base station that just started takes the first order for its start alone.
const TRIES_MAX: u8 = 2;
/// Quietest channels that are named.
const NAMED_MAX: usize = 5;
/// Their least distance, MHz: twice what 2 Mbit/s take.
const APART_MIN: u8 = 4;
/// Length of the plot's longest bar, characters.
const BAR_LEN_MAX: usize = 40;

pub(super) fn run(args: &ScanArgs) -> Result<(), Failure> {
    let RobotLink::Serial { device, baud } = RobotLink::parse(&args.robots)? else {
        return Err(ScanError::NoStation(args.robots.clone()).into());
    };
    let mut link = SerialLink::open(&device, baud)?;
    note!("measuring {} sweeps of {SCANNED} channels", args.sweeps);
    for _ in 0..TRIES_MAX {
        link.send(To::All, &station::packet(&StationMessage::Scan(args.sweeps)))?;
        let until = Instant::now() + SWEEP_MAX * u32::from(args.sweeps) + ANSWER_MAX;
        while Instant::now() < until {
            let received = link.receive(Duration::from_millis(100))?;
            match received.as_deref().and_then(station::read) {
                Some(StationMessage::Spectrum(0, _)) => return Err(ScanError::InPlay(device).into()),
                Some(StationMessage::Spectrum(sweeps, counts)) => {
                    let text = if args.json { as_json(sweeps, &counts) } else { plot(sweeps, &counts) };
                    return print_text(&text);
                }
                _ => {}
            }
        }
    }
    Err(ScanError::Silent(device).into())
}

fn as_json(sweeps: u8, counts: &[u8]) -> String {
    format!("{}\n", json!({ "sweeps": sweeps, "counts": counts, "quietest": quietest(counts) }))
}

/// Each channel that had power with a bar, then the quietest.
fn plot(sweeps: u8, counts: &[u8]) -> String {
    let mut text = String::from("channel   MHz  busy %\n");
    for (channel, count) in (0_u16..).zip(counts).filter(|(_, count)| **count > 0) {
        let share = f32::from(*count) / f32::from(sweeps);
        let bar = "#".repeat((share * BAR_LEN_MAX as f32).ceil() as usize);
        let _ = writeln!(text, "{channel:>7}  {:>4}  {:>6.0}  {bar}", 2400 + channel, 100.0 * share);
    }
    let quiet: Vec<String> = quietest(counts).iter().map(u8::to_string).collect();
    let _ = writeln!(text, "quietest: {} (team.toml: [radio] channel = N)", quiet.join(", "));
    text
}

/// The channels with the least power on them and beside them, those furthest from any power first.
fn quietest(counts: &[u8]) -> Vec<u8> {
    let mut channels: Vec<u8> = (CHANNEL_MIN..=CHANNEL_MAX).collect();
    channels.sort_by_key(|at| (power_around(counts, *at), u8::MAX - distance_to_power(counts, *at), *at));
    let mut named: Vec<u8> = Vec::new();
    for channel in channels {
        if named.len() < NAMED_MAX && named.iter().all(|known| known.abs_diff(channel) >= APART_MIN) {
            named.push(channel);
        }
    }
    named
}

/// Sweeps with power on a channel and on its two neighbours.
fn power_around(counts: &[u8], channel: u8) -> u32 {
    counts.iter().skip(usize::from(channel - 1)).take(3).copied().map(u32::from).sum()
}

/// MHz from a channel to the next with power.
fn distance_to_power(counts: &[u8], channel: u8) -> u8 {
    let busy = (0_u8..).zip(counts).filter(|(_, count)| **count > 0);
    busy.map(|(at, _)| at.abs_diff(channel)).min().unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two stations of a wireless network, and one narrow carrier.
    fn spectrum() -> Vec<u8> {
        let busy = |channel: u8| match channel {
            2..=22 => 30,
            52..=72 => 12,
            40 => 50,
            _ => 0,
        };
        (0..84).map(busy).collect()
    }

    #[test]
    fn the_quietest_channels_are_far_from_all_power_and_apart() {
        let named = quietest(&spectrum());
        assert_eq!(named.len(), NAMED_MAX);
        assert_eq!(named[0], 31, "midway between 22 and 40: {named:?}");
        for (at, channel) in named.iter().enumerate() {
            assert!(
                (24..=38).contains(channel) || (42..=50).contains(channel) || *channel >= 74,
                "{named:?}"
            );
            assert!(named[..at].iter().all(|known| known.abs_diff(*channel) >= APART_MIN), "{named:?}");
        }
    }

    #[test]
    fn a_scan_is_read_as_it_was_printed_and_others_are_refused() {
        let scan = Spectrum::parse(&as_json(50, &spectrum())).unwrap();
        assert_eq!((scan.sweeps, scan.counts), (50, spectrum()));
        let wrong = ["", "{}", r#"{"sweeps":0,"counts":[0]}"#, r#"{"sweeps":5,"counts":[]}"#];
        for text in wrong {
            assert!(Spectrum::parse(text).is_err(), "{text}");
        }
        let error = Spectrum::parse(r#"{"sweeps":5,"counts":[0,6]}"#).unwrap_err();
        assert_eq!(error, "channel 1: power in 6 of 5 sweeps");
        assert!(Spectrum::parse(&as_json(5, &[0; SCANNED + 1])).is_err());
    }

    #[test]
    fn the_plot_has_a_bar_for_each_channel_with_power() {
        let text = plot(50, &spectrum());
        assert_eq!(text.lines().count(), 2 + 21 + 21 + 1);
        let carrier = text.lines().find(|line| line.contains("2440")).unwrap();
        assert_eq!(carrier, format!("     40  2440     100  {}", "#".repeat(BAR_LEN_MAX)));
        assert!(text.ends_with("[radio] channel = N)\n"));
    }
}
