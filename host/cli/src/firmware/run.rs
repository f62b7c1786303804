//! `onetwo firmware run`: a robot without hardware. The firmware that runs by its own clock, in QEMU's
//! emulated board, its radio on a serial line.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use firmware_build::{Install, MACHINE, Program, ensure_qemu};
use protocol::provision::read;
use protocol::slot::PAGE_ADDRESS;

use super::{at, build, failed};
use crate::Failure;
use crate::failure::FirmwareError;

/// How a robot is run.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The page that `provision` wrote; without it the robot accepts no host.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    /// Where its radio's line ends, in QEMU's syntax: `null`, `pty`, `unix:PATH,server=on`,
    /// `tcp:HOST:PORT,server=on`.
    #[arg(long, value_name = "LINE", default_value = "pty")]
    serial: String,
}

/// Runs it until it is ended; the robot's log is on stderr.
pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    // Checked before anything is built or started.
    let page = args.page.as_deref().map(|file| check(file).map(|()| file)).transpose()?;
    let qemu = ensure_qemu(Install::ForUser).map_err(failed)?;
    let mut command = Command::new(qemu);
    command.args(qemu_arguments(&build(Program::Free)?, page, &args.serial)).stdin(Stdio::null());
    let status = command.status().map_err(FirmwareError::Emulator)?;
    if status.success() { Ok(()) } else { Err(failed(FirmwareError::Ended(status))) }
}

/// Longest file of a key page that is read, bytes: one sector of flash.
const PAGE_FILE_LEN_MAX: u64 = 1 << 17;

/// Whether a robot could read the page.
fn check(file: &Path) -> Result<(), Failure> {
    let bytes = foreign::read(file, PAGE_FILE_LEN_MAX).map_err(at(file, FirmwareError::File))?;
    read(&bytes, false).map(|_| ()).map_err(at(file, FirmwareError::PageFile))
}

/// Arguments of QEMU.
fn qemu_arguments(image: &Path, page: Option<&Path>, serial: &str) -> Vec<String> {
    let mut arguments: Vec<String> =
        ["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", serial]
            .map(str::to_owned)
            .into();
    arguments.extend(["-semihosting-config", "enable=on,target=native", "-kernel"].map(str::to_owned));
    arguments.push(image.display().to_string());
    if let Some(file) = page {
        // In QEMU's options a doubled comma stands for one.
        let path = file.to_string_lossy().replace(',', ",,");
        arguments.push("-device".to_owned());
        arguments.push(format!("loader,file={path},addr={PAGE_ADDRESS:#x},force-raw=on"));
    }
    arguments
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
