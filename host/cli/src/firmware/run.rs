//! `onetwo firmware run`: robots without hardware. The firmware that runs by its own clock, in QEMU's
//! emulated board: one robot with its radio on a serial line, or a team's with theirs on UDP ([`mod@udp`]).

mod emulator_log;
mod udp;

use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use firmware_build::{Install, MACHINE, Program, ensure_qemu};
use protocol::provision::{Provision, read};
use protocol::slot::PAGE_ADDRESS;

use super::failure::FirmwareError;
use super::{at, build};
use crate::Failure;
use crate::args::parsers;
use crate::stop::stopped_by_hand;

/// How robots are run.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The page that `provision` wrote; without it the robot accepts no host. With --udp once for each robot.
    #[arg(long, value_name = "FILE")]
    page: Vec<PathBuf>,
    /// Where its radio's line ends, in QEMU's syntax: `null`, `pty`, `unix:PATH,server=on`,
    /// `tcp:HOST:PORT,server=on`.
    #[arg(long, value_name = "LINE", default_value = "pty", conflicts_with = "udp")]
    serial: String,
    /// The robots' radio is UDP over the board's Ethernet: this address takes the frames of `control --robots
    /// udp://ADDRESS:PORT` and passes them to all robots, as a base station would.
    #[arg(long, value_name = "HOST:PORT", value_parser = crate::args::parsers::address)]
    udp: Option<SocketAddr>,
    /// Where the robots' bodies are: a simulator, as HOST or HOST:PORT; without a port the league's for their
    /// team, 10301 blue, 10302 yellow. Without it their orders move nothing.
    #[arg(long, value_name = "HOST[:PORT]", requires = "udp")]
    simulator: Option<String>,
    /// Write what each brain took in and gave out, with its times, to robotN.journal in this directory.
    #[arg(long, value_name = "DIRECTORY", requires = "udp")]
    journal: Option<PathBuf>,
    /// End after this number of seconds.
    #[arg(short, long, value_name = "SECONDS", value_parser = parsers::seconds)]
    duration: Option<f64>,
}

/// Runs them until they are ended; the robots' log is on stderr.
pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    if let Some(address) = args.udp {
        return udp::run(address, args);
    }
    let page = match args.page.as_slice() {
        [] => None,
        [file] => Some(file.as_path()),
        [..] => return Err(FirmwareError::OneLine(args.page.len()).into()),
    };
    // Checked before anything is built or started.
    page.map(check).transpose()?;
    let qemu = ensure_qemu(Install::ForUser)?;
    let image = build(Program::Free)?;
    let stopped = stopped_by_hand();
    let mut emulator = Emulator::start(&qemu, &qemu_arguments(&image, page, &args.serial), "")?;
    let end = args.duration.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    while !stopped.load(Ordering::Relaxed) && end.is_none_or(|end| Instant::now() < end) {
        match emulator.0.try_wait()? {
            Some(status) if status.success() => break,
            Some(status) => return Err(FirmwareError::Ended(status).into()),
            None => thread::sleep(CHECK_EVERY),
        }
    }
    Ok(())
}

/// A running emulator; killed when this is dropped, and by the kernel when this process is killed.
struct Emulator(Child);

impl Emulator {
    /// Starts it; its log goes to stderr, each line behind `prefix`.
    fn start(qemu: &Path, arguments: &[String], prefix: &str) -> io::Result<Self> {
        let mut command = hil_sim::emulator_command(qemu);
        let mut child = command.args(arguments).stdin(Stdio::null()).stderr(Stdio::piped()).spawn()?;
        emulator_log::follow(&mut child, prefix);
        Ok(Self(child))
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // It may have ended by itself; either way nothing remains to be done.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The emulators are looked after this often.
const CHECK_EVERY: Duration = Duration::from_millis(100);

/// Longest file of a key page that is read, bytes: one sector of flash.
const PAGE_FILE_LEN_MAX: u64 = 1 << 17;

/// The page as a robot reads it.
fn check(file: &Path) -> Result<Provision, Failure> {
    let bytes = foreign::read(file, PAGE_FILE_LEN_MAX).map_err(at(file))?;
    read(&bytes, false).map_err(at(file))
}

fn qemu_arguments(image: &Path, page: Option<&Path>, serial: &str) -> Vec<String> {
    let mut arguments: Vec<String> =
        ["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", serial]
            .map(str::to_owned)
            .into();
    arguments.extend(["-semihosting-config", "enable=on,target=native", "-kernel"].map(str::to_owned));
    arguments.push(image.display().to_string());
    if let Some(file) = page {
        arguments.push("-device".to_owned());
        arguments.push(format!("loader,file={},addr={PAGE_ADDRESS:#x},force-raw=on", in_option(file)));
    }
    arguments
}

/// A path in QEMU's options, where a doubled comma stands for one.
fn in_option(path: &Path) -> String {
    path.to_string_lossy().replace(',', ",,")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_goes_to_its_address_even_from_a_path_with_a_comma() {
        let arguments = qemu_arguments(Path::new("image"), Some(Path::new("a,b.page")), "null");
        let last = arguments.last().map(String::as_str);
        let expected = format!("loader,file=a,,b.page,addr={PAGE_ADDRESS:#x},force-raw=on");
        assert_eq!(last, Some(expected.as_str()));
        assert!(arguments.windows(2).any(|pair| pair == ["-serial", "null"]), "{arguments:?}");
    }

    #[test]
    fn a_page_that_no_robot_could_read_is_refused_before_anything_starts() {
        let file = std::env::temp_dir().join(format!("onetwo-no-page-{}", std::process::id()));
        std::fs::write(&file, [0xff; 64]).expect("a temporary file");
        let message = check(&file).map_err(|error| error.to_string());
        std::fs::remove_file(&file).expect("our own file");
        assert!(message.is_err_and(|error| error.contains("firmware provision")));
    }
}
