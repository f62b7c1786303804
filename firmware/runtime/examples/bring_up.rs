//! `bring_up`: plays the checks of a robot's first start on simulated parts with a fault, as a board plays it
//! on its own: `cargo run -p onetwo-runtime --example bring_up -- reversed-motor`.

use std::process::ExitCode;

use runtime::bring_up::bench::{Fault, play};

/// The faults that can be planted, by name; of wheels the first or the first two.
const FAULTS: [(&str, Fault); 17] = [
    ("none", Fault::None),
    ("no-divider", Fault::NoDivider),
    ("empty-battery", Fault::EmptyBattery),
    ("no-imu", Fault::NoImu),
    ("imu-upside-down", Fault::ImuUpsideDown),
    ("swapped-encoders", Fault::SwappedEncoders(0, 1)),
    ("reversed-motor", Fault::ReversedMotor(0)),
    ("reversed-encoder", Fault::ReversedEncoder(0)),
    ("dead-wheel", Fault::DeadWheel(0)),
    ("stuck-direction", Fault::StuckDirection(0)),
    ("joined-drivers", Fault::JoinedDrivers(0)),
    ("coarse-encoder", Fault::CoarseEncoder(0)),
    ("no-radio", Fault::NoRadio),
    ("loose-radio", Fault::LooseRadio),
    ("no-antenna", Fault::NoAntenna),
    ("no-lamp", Fault::NoLamp),
    ("stuck-beam", Fault::StuckBeam),
];

fn main() -> ExitCode {
    let asked = std::env::args().nth(1).unwrap_or_else(|| "none".to_owned());
    let Some((_, fault)) = FAULTS.iter().find(|(name, _)| *name == asked) else {
        let names: Vec<_> = FAULTS.iter().map(|(name, _)| *name).collect();
        eprintln!("{asked}: no such fault; expected one of {}", names.join(", "));
        return ExitCode::from(2);
    };
    let mut failed = 0;
    let took = play(*fault, 1, |report| match report.result {
        Ok(value) => println!("pass  {}  ({value:.2})", report.check),
        Err(finding) => {
            failed += 1;
            println!("FAIL  {}\n      {finding}", report.check);
        }
    });
    println!("{failed} failed; it takes {:.0} s", took.0 as f64 * 1e-6);
    if failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
