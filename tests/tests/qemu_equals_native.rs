//! `qemu_equals_native`: tests: firmware image and native brain play the same trial, bit for bit
//! (docs/architecture.md §2.5, §7.2).
//!
//! Each robot runs in a QEMU of its own; trace hashes are computed by the simulator, so by the same code for
//! both. Needs QEMU and a compiler for the target; `cargo xtask test --only qemu` provides
//! both.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use arena::Profile;
use arena::{CaseNames, TrialConfig, TrialReport, run};
use brain::{Approach, BrainConfig};
use firmware_build::inspect::{STACK_BUDGET, STEP_BUDGET};
use hil_sim::{
    AirSettings, Backend, Configuration, Fault, McuError, Metered, NativeBackend, QemuBackend, Scenario,
    ScheduledFault,
};
use protocol::{RobotId, TeamId};

/// Number of seeds of each scenario and configuration of the paper.
const SEEDS: u64 = 5;

#[test]
fn native_equals_qemu() {
    let mut meter = Meter::default();
    for (number, (scenario, opponents)) in paper().enumerate() {
        for seed in 1..=SEEDS {
            let config = TrialConfig::new(scenario, opponents, Approach::Cases, 100 * number as u64 + seed);
            both(&config, QemuBackend::new(&*IMAGE), &mut meter);
        }
    }
    assert_eq!(meter.trials, 8 * SEEDS);
    assert!(meter.gameplays > meter.trials, "trials without cases prove little: {meter:?}");
    meter.check();
}

#[test]
fn native_equals_qemu_under_loss_and_a_reboot() {
    let mut meter = Meter::default();
    let robot = RobotId::new(1).expect("an id");
    for seed in 1..=3 {
        let mut config =
            TrialConfig::new(Scenario::Random, Configuration::DefenderGoalie, Approach::Cases, seed);
        config.robots = 3;
        config.air =
            AirSettings { delay: [1, 2], duplication: 0.1, reordering: 0.1, ..AirSettings::with_loss(0.3) };
        config.faults = vec![
            ScheduledFault { tick: 40, fault: Fault::Crash(robot) },
            ScheduledFault { tick: 70, fault: Fault::Return(robot) },
        ];
        both(&config, QemuBackend::new(&*IMAGE), &mut meter);
    }
    meter.check();
}

#[test]
fn native_equals_qemu_with_the_robots_perception() {
    let mut meter = Meter::default();
    for (scenario, approach) in [
        (Scenario::DefenderAhead, Approach::Cases),
        (Scenario::DefenderClose, Approach::Hybrid),
        (Scenario::Random, Approach::Reactive),
    ] {
        for seed in 1..=2 {
            let config = TrialConfig::new(scenario, Configuration::DefenderGoalie, approach, seed);
            both(&Profile::Robots.apply(config), QemuBackend::new(&*IMAGE), &mut meter);
        }
    }
    meter.check();
}

#[test]
fn a_library_in_flash_replaces_the_built_in_one() {
    let directory = Directory::with(&["league.toml", "center/pass-around.toml", "front/shot.toml"]);
    let library = case_tools::load(&directory.0).unwrap_or_else(|findings| panic!("{findings:?}"));
    let built_in = TrialConfig::new(Scenario::MiddleBack, Configuration::TwoDefenders, Approach::Cases, 5);
    let names = CaseNames::new(library.names.iter().cloned());
    let config = built_in.clone().with_library(library.base(), names);
    let backend = QemuBackend::new(&*IMAGE).with_library(library.base().bytes()).expect("room for it");
    let hash = both(&config, backend, &mut Meter::default());
    let other = run(&built_in, Box::new(NativeBackend::new(built_in.base)), &mut []).expect("a trial");
    assert_ne!(hash, other.trace_hash, "the library makes no difference");
}

#[test]
fn an_invalid_library_is_refused() {
    let mut backend = QemuBackend::new(&*IMAGE).with_library(&[7; 100]).expect("room for it");
    let config = BrainConfig::new(RobotId::new(1).expect("an id"), TeamId(0));
    assert!(matches!(backend.boot(&config), Err(McuError::Unusable)));
}

/// Plays a trial on both back ends; returns their common hash.
fn both<'a>(config: &TrialConfig<'a>, qemu: QemuBackend, meter: &mut Meter) -> String {
    let play = |backend: Box<dyn Backend<'a> + 'a>| -> TrialReport {
        let name = backend.name();
        run(config, backend, &mut []).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    let native = play(Box::new(NativeBackend::new(config.base)));
    let emulated = play(Box::new(Metered::new(qemu, &meter.taken)));
    let which = format!("scenario {} {} seed {}", config.scenario, config.opponents.label(), config.seed);
    assert_eq!(native.trace_hash, emulated.trace_hash, "{which}");
    meter.trials += 1;
    meter.gameplays += emulated.cycles.iter().filter(|cycle| cycle.case.is_some()).count() as u64;
    native.trace_hash
}

/// Instructions and stack use of the emulated trials.
#[derive(Debug, Default)]
struct Meter {
    trials: u64,
    gameplays: u64,
    taken: hil_sim::Meter,
}

impl Meter {
    /// Checks that the worst step and the maximum stack use are within their budgets; prints them, and the
    /// median step.
    fn check(&self) {
        let ((median, worst), stack) = (self.taken.median_and_worst(), self.taken.stack());
        let (trials, gameplays, count) = (self.trials, self.gameplays, self.taken.steps());
        println!(
            "{trials} trials, {gameplays} gameplays, {count} steps: median {median}, worst {worst} instructions; \
             deepest stack {stack} B"
        );
        assert!((1..=STACK_BUDGET).contains(&stack), "{stack} B of stack");
        assert!((1..=STEP_BUDGET).contains(&worst), "the worst step took {worst} instructions");
    }
}

/// The paper's scenarios with both of its configurations.
fn paper() -> impl Iterator<Item = (Scenario, Configuration)> {
    let both = |scenario| [Configuration::DefenderGoalie, Configuration::TwoDefenders].map(|c| (scenario, c));
    Scenario::PAPER.into_iter().flat_map(both)
}

/// The firmware image, built where it is missing or old.
static IMAGE: LazyLock<PathBuf> = LazyLock::new(|| {
    let root = firmware_build::workspace_root();
    firmware_build::build_image(&root, firmware_build::ImageBody::Legged)
        .unwrap_or_else(|error| panic!("{error}"))
});

/// A directory with some files of the built-in library; deleted on drop.
struct Directory(PathBuf);

impl Directory {
    fn with(files: &[&str]) -> Self {
        let directory = std::env::temp_dir().join(format!("onetwo-some-cases-{}", std::process::id()));
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged");
        for file in files {
            let to = directory.join(file);
            fs::create_dir_all(to.parent().expect("a file in a directory")).expect("a temporary folder");
            fs::copy(from.join(file), to).expect("a case of the built-in library");
        }
        Self(directory)
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        // A temporary directory that stays is no error.
        let _ = fs::remove_dir_all(&self.0);
    }
}
