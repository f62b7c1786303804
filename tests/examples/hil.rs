//! `hil`: speed of six firmware images in QEMU. `cargo xtask bench hil [--seconds N] [--seed N]`
//!
//! Both matches run in one process, alternating tick by tick, so that a slow machine slows both equally;
//! hashes are compared, and the images are held to the budgets of a step and of the stack: `--seconds 600`
//! takes about ten minutes.

use std::process::ExitCode;

use firmware_build::inspect::{STACK_BUDGET, STEP_BUDGET};
use match_tests::hil::Pair;

fn main() -> ExitCode {
    let (mut seconds, mut seed) = (20.0, 1);
    let mut arguments = std::env::args().skip(1);
    while let Some(label) = arguments.next() {
        let value = arguments.next();
        let parsed: Option<f64> = value.as_deref().and_then(|value| value.parse().ok());
        match (label.as_str(), parsed.filter(|number| *number > 0.0)) {
            ("--seconds", Some(number)) => seconds = number,
            ("--seed", Some(number)) => seed = number as u64,
            _ => {
                eprintln!("usage: cargo xtask bench hil [--seconds N] [--seed N]");
                return ExitCode::from(2);
            }
        }
    }
    let image =
        firmware_build::build_image(&firmware_build::workspace_root(), firmware_build::ImageBody::Omni);
    let reported = match image {
        Ok(image) => Pair::new(seed, seconds, &image).and_then(|mut pair| pair.play(|_, _| {})),
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    match reported {
        Ok(reported) => {
            println!("{reported}");
            let equal = reported.hashes[0] == reported.hashes[1];
            let kept = reported.worst_instructions <= STEP_BUDGET && reported.worst_stack <= STACK_BUDGET;
            if equal && kept { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
