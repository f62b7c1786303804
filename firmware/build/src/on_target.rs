//! `on_target`: on-target test runner.
//!
//! Test programs of `embedded-test` list their tests in a section that is not loaded: a symbol a test, whose
//! name is a JSON object, at a pair of the test's function and its module's path. The program's command line
//! selects the function to call (semihosting), and its exit code reports the result. `probe-rs run` does the
//! same on hardware.

use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use object::{Object as _, ObjectSection as _, ObjectSymbol as _};
use serde_json::Value;

use crate::MACHINE;

/// A test in a firmware image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OnTarget {
    /// Module and function of the test.
    pub name: String,
    address: u32,
    should_panic: bool,
    /// True if the test is not to be run.
    pub ignored: bool,
    timeout: Duration,
}

/// Result of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestVerdict {
    /// The test ended as expected.
    Passed,
    /// Any other result, with its output.
    Failed(String),
}

/// Reason why the tests of a file cannot be listed.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("its tests cannot be listed: {0}")]
pub struct NoTests(&'static str);

/// The tests of a firmware image by name; `None` where it holds no tests.
pub fn tests_in(elf: &[u8]) -> Result<Option<Vec<OnTarget>>, NoTests> {
    let file = object::File::parse(elf).map_err(|_| NoTests("it is no ELF file"))?;
    let Some(section) = file.section_by_name(SECTION) else { return Ok(None) };
    let table = section.data().map_err(|_| NoTests("their section cannot be read"))?;
    let mut tests = Vec::new();
    for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(section.index())) {
        // The others are the section's own, such as the version of its form.
        let Some(json) = symbol.name().ok().filter(|name| name.starts_with('{')) else { continue };
        let test: Value = serde_json::from_str(json).map_err(|_| NoTests("a test's name is no JSON"))?;
        let at = symbol.address().checked_sub(section.address()).and_then(|at| usize::try_from(at).ok());
        let entry = at.and_then(|at| table.get(at..)?.first_chunk::<12>());
        let Some(entry) = entry else { return Err(NoTests("a test has no function")) };
        let [address, path, len] =
            [0, 4, 8].map(|at| u32::from_le_bytes([0, 1, 2, 3].map(|byte| entry[at + byte])));
        let module = text_at(&file, path, len).unwrap_or_default();
        // Without the crate's name, and without the module that every file has.
        let module = module.split_once("::").map_or("", |(_, path)| path).trim_end_matches("::tests");
        let name = test["name"].as_str().ok_or(NoTests("a test has no name"))?;
        let flag = |key: &str| test[key].as_bool().unwrap_or(false);
        tests.push(OnTarget {
            name: format!("{module}::{name}"),
            address,
            should_panic: flag("should_panic"),
            ignored: flag("ignored"),
            timeout: test["timeout"].as_u64().map_or(DEFAULT_TIMEOUT, Duration::from_secs),
        });
    }
    tests.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(Some(tests))
}

fn text_at(file: &object::File<'_>, address: u32, len: u32) -> Option<String> {
    let bytes = file.sections().find_map(|section| section.data_range(address.into(), len.into()).ok()?)?;
    String::from_utf8(bytes.to_vec()).ok()
}

/// Runs one test in an emulator of its own.
pub fn run_test(qemu: &Path, image: &Path, test: &OnTarget) -> std::io::Result<TestVerdict> {
    let mut child = Command::new(qemu)
        .args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "none"])
        .arg("-semihosting-config")
        .arg(format!("enable=on,target=native,arg=run_addr,arg={}", test.address))
        .arg("-kernel")
        .arg(image)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let started = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if started.elapsed() > test.timeout {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(EXIT_POLL_PERIOD);
    };
    let mut output = String::new();
    // Output that is not text is dropped; the status is reported anyway.
    if let Some(mut stdout) = child.stdout.take() {
        let _ = stdout.read_to_string(&mut output);
    }
    if let Some(mut stderr) = child.stderr.take() {
        let _ = stderr.read_to_string(&mut output);
    }
    Ok(judged(test, status.map(|status| status.success()), output.trim()))
}

/// The verdict for an exit status; `None` is no exit within the test's time.
fn judged(test: &OnTarget, well: Option<bool>, output: &str) -> TestVerdict {
    match (well, test.should_panic) {
        (Some(true), false) | (Some(false), true) => TestVerdict::Passed,
        (Some(false), false) => TestVerdict::Failed(output.to_owned()),
        (Some(true), true) => TestVerdict::Failed("it should have panicked".to_owned()),
        (None, _) => {
            TestVerdict::Failed(format!("it did not end within {} s; {output}", test.timeout.as_secs()))
        }
    }
}

/// Section in which `embedded-test` lists its tests.
const SECTION: &str = ".embedded_test";
/// Time limit of a test that names none: a hundred times the longest run, for a busy machine.
const DEFAULT_TIMEOUT: Duration = Duration::from_mins(1);
/// Period in which an emulator is polled.
const EXIT_POLL_PERIOD: Duration = Duration::from_millis(5);

#[cfg(test)]
mod tests {
    use super::*;

    fn test(should_panic: bool) -> OnTarget {
        OnTarget { name: "a::b".into(), address: 1, should_panic, ignored: false, timeout: DEFAULT_TIMEOUT }
    }

    #[test]
    fn a_panic_fails_a_test_unless_it_should_and_a_hang_fails_any() {
        assert_eq!(judged(&test(false), Some(true), ""), TestVerdict::Passed);
        assert_eq!(judged(&test(true), Some(false), "panicked"), TestVerdict::Passed);
        assert_eq!(judged(&test(false), Some(false), "why"), TestVerdict::Failed("why".into()));
        assert!(matches!(judged(&test(true), Some(true), ""), TestVerdict::Failed(_)));
        for should_panic in [false, true] {
            let TestVerdict::Failed(reason) = judged(&test(should_panic), None, "") else { panic!("passed") };
            assert!(reason.contains("60 s"), "{reason}");
        }
    }

    #[test]
    fn other_bytes_than_an_image_have_no_tests() {
        assert!(tests_in(b"no image").is_err());
    }
}
