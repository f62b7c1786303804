//! `measure`: stack depth and worst step of a firmware image. It plays under QEMU: for a walking robot a
//! trial of each of the paper's cells, for a wheeled robot a match of six against six (docs/architecture.md
//! §9).
//!
//! Instructions of the guest and bytes: the same on every machine for the same firmware.

use arena::game::{Game, GameConfig, NoWatcher};
use arena::{TrialConfig, run};
use brain::Approach;
use firmware_build::{ImageBody, Install, Program, ensure_qemu};
use hil_sim::{ByTeam, Configuration, Meter, Metered, NativeBackend, QemuBackend, Scenario};
use protocol::TeamId;
use rules::{Colour, League};

use super::build;
use crate::Failure;

/// Deepest stack and longest step of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Measured {
    /// Bytes of stack.
    pub(super) stack: u32,
    /// Instructions of the median step.
    pub(super) median: u32,
    /// Of the worst step.
    pub(super) worst: u32,
    pub(super) steps: usize,
}

/// Plays; `None` for a program that no simulator drives.
pub(super) fn measure(program: Program, seconds: f64) -> Result<Option<Measured>, Failure> {
    let meter = Meter::default();
    match program {
        Program::Robot(ImageBody::Legged) => trials(&meter)?,
        Program::Robot(ImageBody::Omni) => play(&meter, seconds)?,
        _ => return Ok(None),
    }
    let (median, worst) = meter.median_and_worst();
    Ok(Some(Measured { stack: meter.stack(), median, worst, steps: meter.steps() }))
}

fn trials(meter: &Meter) -> Result<(), Failure> {
    let image = emulated(ImageBody::Legged)?;
    for scenario in Scenario::PAPER {
        for opponents in [Configuration::DefenderGoalie, Configuration::TwoDefenders] {
            let config = TrialConfig::new(scenario, opponents, Approach::Cases, SEED);
            let backend = Metered::new(QemuBackend::new(&image), meter);
            run(&config, Box::new(backend), &mut [])?;
        }
    }
    Ok(())
}

fn play(meter: &Meter, seconds: f64) -> Result<(), Failure> {
    let image = emulated(ImageBody::Omni)?;
    let config = GameConfig::new(League::DivisionB, SEED, seconds);
    let base = case_library::division_b();
    let mut backend = ByTeam {
        team: TeamId::of(Colour::Blue),
        its: Metered::new(QemuBackend::new(&image), meter),
        others: NativeBackend::new(base),
    };
    let mut game = Game::new(&config, &mut backend)?;
    for _ in 0..(seconds * TICKS_A_SECOND) as u64 {
        game.step(&mut NoWatcher)?;
    }
    Ok(())
}

fn emulated(body: ImageBody) -> Result<std::path::PathBuf, Failure> {
    ensure_qemu(Install::ForUser)?;
    build(Program::Robot(body))
}

/// One seed, so that two runs of the same firmware measure the same.
const SEED: u64 = 1;
/// Steps of a match (docs/architecture.md §2.3).
const TICKS_A_SECOND: f64 = 100.0;
