//! `emulate`: cargo runner for the robot's processor, in QEMU. An image with tests is run test by test, each
//! in an emulator of its own, with the arguments of Rust's own test runner (`.cargo/config.toml` names this
//! as the target's runner).

use std::fs;
use std::path::Path;
use std::process::Command;

use firmware_build::on_target::{OnTarget, TestVerdict, run_test, tests_in};
use firmware_build::{Install, MACHINE, ensure_qemu};

use crate::context::{Context, Failure, line_of, run};

/// The tests that run on the robot's processor; arguments select among them.
pub(crate) fn on_target(context: &Context, arguments: &[String]) -> Result<(), Failure> {
    let mut command = context.cargo_thumb("test --profile firmware --package on-target")?;
    run(command.arg("--").args(arguments))
}

/// Runs the program that the first argument names.
pub(crate) fn emulate(arguments: &[String]) -> Result<(), Failure> {
    let Some((image, arguments)) = arguments.split_first() else {
        return Err(Failure::Firmware(vec!["emulate needs an image".into()]));
    };
    let image = Path::new(image);
    let qemu = ensure_qemu(Install::ForUser).map_err(Failure::Qemu)?;
    let bytes = fs::read(image).map_err(|error| Failure::unreadable(image, &error))?;
    if let Some(tests) = tests_in(&bytes).map_err(|error| Failure::unreadable(image, &error))? {
        return run_tests(&qemu, image, &tests, arguments);
    }
    let mut command = Command::new(qemu);
    command.args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "stdio"]);
    command.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(image);
    let line = line_of(&command);
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Command { line, status }),
        Err(error) => Err(Failure::Start { line, error }),
    }
}

fn run_tests(qemu: &Path, image: &Path, tests: &[OnTarget], arguments: &[String]) -> Result<(), Failure> {
    // Options of Rust's own runner (`--nocapture`) select no test.
    let chosen: Vec<&OnTarget> = tests.iter().filter(|test| is_chosen(&test.name, arguments)).collect();
    println!("\nrunning {} tests", chosen.len());
    let mut failures = Vec::new();
    let mut ignored = 0;
    for test in &chosen {
        if test.ignored {
            ignored += 1;
            println!("test {} ... ignored", test.name);
            continue;
        }
        let verdict =
            run_test(qemu, image, test).map_err(|error| Failure::Start { line: test.name.clone(), error })?;
        match verdict {
            TestVerdict::Passed => println!("test {} ... ok", test.name),
            TestVerdict::Failed(output) => {
                println!("test {} ... FAILED\n{output}", test.name);
                failures.push(format!("{}: {}", test.name, output.lines().next().unwrap_or("no output")));
            }
        }
    }
    let (failed, passed) = (failures.len(), chosen.len() - failures.len() - ignored);
    let filtered = tests.len() - chosen.len();
    let label = if failed == 0 { "ok" } else { "FAILED" };
    println!(
        "\ntest result: {label}. {passed} passed; {failed} failed; {ignored} ignored; {filtered} filtered out\n"
    );
    if tests.is_empty() {
        return Err(Failure::Firmware(vec![format!("{} lists no test", image.display())]));
    }
    if failures.is_empty() { Ok(()) } else { Err(Failure::Firmware(failures)) }
}

/// Whether an argument names it, or none is given.
fn is_chosen(name: &str, arguments: &[String]) -> bool {
    let mut arguments = arguments.iter().filter(|argument| !argument.starts_with('-')).peekable();
    arguments.peek().is_none() || arguments.any(|argument| name.contains(argument.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_choose_by_a_part_of_the_name_and_options_choose_nothing() {
        let arguments =
            |list: &[&str]| list.iter().map(|argument| (*argument).to_owned()).collect::<Vec<_>>();
        assert!(
            is_chosen("frames::a", &arguments(&[])) && is_chosen("frames::a", &arguments(&["--nocapture"]))
        );
        assert!(
            is_chosen("frames::a", &arguments(&["timers", "fram"]))
                && !is_chosen("frames::a", &arguments(&["timers"]))
        );
    }
}
