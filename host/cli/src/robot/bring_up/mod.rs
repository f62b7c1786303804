//! `onetwo robot bring-up`: the checks of a robot's first start, as its bring-up image tells them by radio
//! (docs/boards.md). It is that robot's host meanwhile: the check of the radio needs frames of one. With
//! `--kick` it measures the robot's kicker instead.
//!
//! [`progress`] reads the frames, [`kicks`] orders pulses, [`robot_log`] keeps the robot's log, [`lines`]
//! writes what is printed; here are the link and its clock.

mod failure;
mod kicks;
mod lines;
mod progress;
mod robot_log;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use clap::Args;
use host::config::{AirSettings, RobotLink};
use host::radio::To;
use host::run::{PublicKey, real_epoch};
use host::shell::{Link, SerialLink, UdpLink, key};
use protocol::frame::TeamKey;
use protocol::host::{HostMessage, WorldPart};
use protocol::host_link::HostLink;
use protocol::station::RadioPlan;
use protocol::{RobotId, TeamId};
use rules::Phase;

use crate::Failure;
use crate::args::parsers::{radio_team, robot_number, seconds};
use crate::output::{note, print_text};
use crate::stop::{signal, stopped_by_hand};
use failure::BringUpError;
use kicks::{KickOptions, Kicks};
use lines::Format;
use progress::Progress;
use robot_log::LogFile;

/// Arguments of `robot bring-up`.
#[derive(Debug, Args)]
pub(crate) struct BringUpArgs {
    /// Where the robot is, as for `onetwo control`: `udp://HOST:PORT` or `serial:DEVICE[:BAUD]`.
    #[arg(long, value_name = "LINK")]
    robots: String,
    /// Its team's number on the radio, as in its page: 1 yellow, 2 blue.
    #[arg(long, value_name = "N", value_parser = radio_team)]
    team: TeamId,
    /// The team's key: 32 hexadecimal digits in a file; the robot's page must be derived from it.
    #[arg(long, value_name = "FILE")]
    key_file: PathBuf,
    /// The robot's number; by default the first that reports a check.
    #[arg(long, value_name = "N", value_parser = robot_number)]
    robot: Option<RobotId>,
    #[command(flatten)]
    kick: KickOptions,
    /// Write the robot's log, as it comes by radio, to this file: `defmt-print -e IMAGE < FILE` shows it.
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// A JSON object a line: each check when it begins and when it ends, then the counts; or each pulse.
    #[arg(long)]
    json: bool,
    /// Fail after this number of seconds without a report, or in which the capacitor is not charged.
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = seconds)]
    patience: f64,
}

/// A snapshot goes out this often, as from a host in play.
const SNAPSHOT_EVERY: Duration = Duration::from_millis(10);
/// Snapshots for each order of a pulse: ten orders within the silence that disarms a robot.
const SNAPSHOTS_PER_ORDER: u8 = 5;
/// Least time for the rest of the log after all else: ten of its pieces.
const LOG_TAIL_MIN: Duration = Duration::from_millis(200);
/// Greatest time, if bytes are missing: a robot sends all that it keeps four times or more.
const LOG_TAIL_MAX: Duration = Duration::from_secs(5);

/// Exit code 1 if a check failed or a pulse was refused.
pub(super) fn run(args: &BringUpArgs) -> Result<ExitCode, Failure> {
    let robots = RobotLink::parse(&args.robots)?;
    let read = key::read(&args.key_file)?;
    if let Some(warning) = &read.warning {
        note!("warning: {warning}");
    }
    if read.key == TeamKey::ZERO {
        return Err(PublicKey { link: args.robots.clone(), file: Some(args.key_file.clone()) }.into());
    }
    let mut link = open(&robots, (args.team, AirSettings::default().plan(args.team, read.key)))?;
    let epoch = real_epoch();
    if let Some(warning) = &epoch.warning {
        note!("warning: {warning}");
    }
    let host = HostLink::new(args.team, read.key, epoch.epoch);
    let mut progress = Progress::new(args.team, &read.key, host.epoch(), args.robot);
    let mut log = match &args.log {
        Some(file) => Some(LogFile::create(file, &args.key_file)?),
        None => None,
    };
    let format = if args.json { Format::Json } else { Format::Text };
    let ended = follow(args, format, &mut *link, (host, &mut progress), log.as_mut());
    if let Some(mut log) = log {
        let counts = log.finish()?;
        print_text(&format.log(&log.path, counts))?;
        if !log.has_begun() && progress.summary().is_some() {
            note!(
                "warning: the robot sent no log: its image is older than this release, or does not log; build and flash its board's \
                 example bring_up_BOARD again"
            );
        }
    }
    ended
}

/// Prints what the robot reports, until all is done or nothing comes any more.
fn follow(
    args: &BringUpArgs,
    format: Format,
    link: &mut dyn Link,
    (mut host, progress): (HostLink, &mut Progress),
    mut log: Option<&mut LogFile>,
) -> Result<ExitCode, Failure> {
    let stopped = stopped_by_hand();
    note!("waiting for a robot's checks over {}; Ctrl-C ends it", args.robots);
    let began = Instant::now();
    let (mut news, mut due, mut snapshot) = (began, began, 0_u8);
    let (mut kicks, mut refused) = (Kicks::new(&args.kick, Duration::from_secs_f64(args.patience)), 0);
    let mut done = None;
    loop {
        if kicks.as_ref().map_or(progress.is_complete(), |kicks| kicks.next.is_none()) {
            let tail = done.get_or_insert_with(Instant::now).elapsed();
            let wanted = log.as_ref().map(|log| if log.is_whole() { LOG_TAIL_MIN } else { LOG_TAIL_MAX });
            if wanted.is_none_or(|wanted| tail > wanted) {
                break;
            }
        }
        if stopped.load(Ordering::Relaxed) {
            break;
        }
        if news.elapsed().as_secs_f64() > args.patience {
            return Err(silent(progress, args.patience, link).into());
        }
        if due <= Instant::now() {
            due = Instant::now() + SNAPSHOT_EVERY;
            snapshot = snapshot.wrapping_add(1);
            if link.has_room() {
                let now = protocol::Instant(began.elapsed().as_micros() as u64);
                link.send(To::All, &host.seal(now, &empty(snapshot)))?;
                if snapshot.is_multiple_of(SNAPSHOTS_PER_ORDER)
                    && let Some(order) = kicks.as_mut().and_then(|kicks| kicks.order(Instant::now()))
                    && let Some(robot) = args.robot
                {
                    link.send(To::One(robot), &host.seal_order(now, robot, &order))?;
                }
            }
        }
        let wait = due.saturating_duration_since(Instant::now());
        if let Some(packet) = link.receive(wait)? {
            let taken = progress.take(&packet);
            if taken.is_report {
                news = Instant::now();
            }
            if let (Some(log), Some((start, piece))) = (&mut log, &taken.log) {
                log.take(*start, piece)?;
            }
            if let Some(kicks) = &mut kicks {
                if let Some((pulse, result)) = taken.kicker.and_then(|report| kicks.take(news, report)) {
                    refused += u32::from(result.is_err());
                    print_text(&format.pulse(pulse, result))?;
                }
            } else {
                let text: String = taken.events.iter().map(|event| format.event(event)).collect();
                print_text(&text)?;
            }
        }
        while let Some(notice) = link.notice() {
            note!("{notice}");
        }
    }
    if kicks.is_some_and(|kicks| kicks.next.is_none()) {
        return Ok(if refused == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }
    if let Some(summary) = progress.summary() {
        if !summary.hears_us {
            note!(
                "warning: robot {} has not received this computer, so that these results may be a recording of an earlier start",
                summary.robot
            );
        }
        print_text(&format.summary(&summary))?;
        if progress.is_complete() {
            return Ok(if summary.failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE });
        }
    }
    Ok(signal().map_or(ExitCode::FAILURE, |(_, code)| code))
}

fn open(robots: &RobotLink, (team, plan): (TeamId, RadioPlan)) -> Result<Box<dyn Link>, Failure> {
    Ok(match robots {
        RobotLink::Udp(address) => Box::new(UdpLink::open(address)?),
        RobotLink::Serial { device, baud } => Box::new(SerialLink::open(device, *baud)?.planned(team, plan)),
        RobotLink::Simulator(_) => return Err(BringUpError::Simulator.into()),
    })
}

/// Why nothing arrives.
fn silent(progress: &Progress, seconds: f64, link: &dyn Link) -> BringUpError {
    let hint = progress.hint().unwrap_or_else(|| link.advice());
    match progress.summary() {
        None => BringUpError::Silent { seconds, hint },
        Some(summary) => BringUpError::WentSilent { robot: summary.robot, seconds, open: summary.open },
    }
}

/// A snapshot of an empty field, to no robot: what a base station and the check of the radio need.
fn empty(snapshot: u8) -> HostMessage {
    let (phase, robots) = (Phase::Halt, std::iter::empty().collect());
    HostMessage::World(WorldPart { snapshot, part: 0, parts: 1, phase, placement: None, ball: None, robots })
}
