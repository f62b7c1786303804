//! `qemu`: detection of QEMU.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use crate::Install;
use crate::process::{in_path, output_of, run_within};

/// The emulator's program, able to run the firmware; installed first where `install` allows it.
pub fn ensure_qemu(install: Install) -> Result<PathBuf, QemuError> {
    let program = match in_path(QEMU) {
        Some(program) => program,
        None if install == Install::SystemWide => {
            install_package().map_err(|why| QemuError::Missing { why: Some(why) })?;
            in_path(QEMU).ok_or(QemuError::Missing { why: None })?
        }
        None => return Err(QemuError::Missing { why: None }),
    };
    let machines = output_of(Command::new(&program).args(["-machine", "help"]))
        .map_err(|why| QemuError::Broken { why })?;
    let knows = machines.lines().any(|line| line.split_whitespace().next() == Some(MACHINE));
    if knows { Ok(program) } else { Err(QemuError::UnknownMachine { program }) }
}

/// Installs it as a package where we are root on a Debian-like system.
fn install_package() -> Result<(), String> {
    if in_path("apt-get").is_none() {
        return Err("no apt-get on this system".into());
    }
    if output_of(Command::new("id").arg("-u"))?.trim() != "0" {
        return Err("not root".into());
    }
    let mut install = Command::new("apt-get");
    install.env("DEBIAN_FRONTEND", "noninteractive");
    install.args(["install", "-y", "-qq", "--no-install-recommends", QEMU]);
    // A fresh system has no package lists yet; elsewhere the first attempt is enough.
    run_within(DOWNLOAD_TIMEOUT, &mut install).or_else(|_| {
        run_within(DOWNLOAD_TIMEOUT, Command::new("apt-get").args(["-qq", "update"]))?;
        run_within(DOWNLOAD_TIMEOUT, &mut install)
    })
}

/// 45 MB at 200 kB/s, the slowest line we would wait for.
const DOWNLOAD_TIMEOUT: Duration = Duration::from_mins(4);

/// Reason why there is no QEMU to run the image with.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QemuError {
    /// QEMU is not installed, and its installation failed (where that was tried).
    #[error("{QEMU} is not installed{}; {HOW_TO_INSTALL}", why.as_ref().map_or_else(String::new, |why| format!(" ({why})")))]
    Missing {
        /// Obstacle to its installation.
        why: Option<String>,
    },
    /// QEMU is installed but does not run.
    #[error("{QEMU} does not run: {why}; {HOW_TO_INSTALL}")]
    Broken {
        /// Reason or output of its failed start.
        why: String,
    },
    /// QEMU lacks the machine our firmware is made for: too old, or built without it.
    #[error("{} has no machine {MACHINE}; QEMU 7.2 or newer is needed", program.display())]
    UnknownMachine {
        /// The program that was run.
        program: PathBuf,
    },
}

/// The emulator for 32-bit Arm.
pub const QEMU: &str = "qemu-system-arm";
/// The emulated board: Arm MPS2 with the AN386 FPGA configuration, a Cortex-M4F.
pub const MACHINE: &str = "mps2-an386";

const HOW_TO_INSTALL: &str = "\
install it, for example with
  Debian, Ubuntu:  apt-get install qemu-system-arm
  Fedora:          dnf install qemu-system-arm-core
  Arch:            pacman -S qemu-system-arm
  macOS:           brew install qemu
  Windows:         winget install SoftwareFreedomConservancy.QEMU";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_qemu_the_error_says_what_to_install() {
        let text = QemuError::Missing { why: Some("not root".into()) }.to_string();
        assert!(text.starts_with("qemu-system-arm is not installed (not root); install it"), "{text}");
        for system in ["apt-get install qemu-system-arm", "dnf install", "pacman -S", "brew install qemu"] {
            assert!(text.contains(system), "{text}");
        }
    }

    #[test]
    fn an_emulator_that_is_found_runs_the_machine() {
        // Either holds on this machine: a program that knows the board, or an error that names what is
        // missing.
        match ensure_qemu(Install::ForUser) {
            Ok(program) => assert!(program.is_file()),
            Err(error) => assert!(error.to_string().starts_with(QEMU), "{error}"),
        }
    }
}
