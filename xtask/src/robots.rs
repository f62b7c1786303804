//! `robots`: the other robots that come with the project, each built, simulated and emulated
//! (docs/robots.md).
//!
//! A program is for one robot: each is a build of its own, in the same target directory. The step is the last
//! one, as the next build for ours compiles again.

use std::fs;

use firmware_build::inspect::{Image, Sizes};
use firmware_build::{ImageBody, Install, Program, ROBOT, boards, build_for_robot};

use crate::context::{Context, Failure, run};

pub(crate) const WHAT: &str =
    "the other robots of robots/ are built for QEMU and every board, and play natively as in QEMU";

/// Builds and compares every robot but the default one.
pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    let mut faults = Vec::new();
    for (name, _) in robots::BUILT_IN.iter().skip(1) {
        let real = boards().iter().filter(|board| board.firmware.is_some()).map(Program::Board);
        for program in real.chain([Program::Free, Program::Robot(ImageBody::Omni)]) {
            let path = build_for_robot(context.root(), program, name, name).map_err(Failure::Image)?;
            let bytes = fs::read(&path).map_err(|error| Failure::unreadable(&path, &error))?;
            let image = Image::parse(&bytes).map_err(|error| Failure::unreadable(&path, &error))?;
            let sizes = Sizes::of(&image);
            println!("xtask: {name}: {}: {} B flash, {} B RAM", program.name(), sizes.flash, sizes.ram);
            if let Err(over) = program.budget().check(&sizes) {
                faults.push(format!("{name}: {}: {over}", program.name()));
            }
        }
        run(context.cargo(COMPARED).env(ROBOT, name))?;
    }
    if faults.is_empty() { Ok(()) } else { Err(Failure::Firmware(faults)) }
}

/// The image for a robot against native brains for the same: skills alone, and six in a match; and the
/// robot against its simulation.
const COMPARED: &str = "test --release -p match-tests --test qemu_wheels --test qemu_match --test robot_spec";
