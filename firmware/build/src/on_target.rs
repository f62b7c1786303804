//! `on_target`: on-target test runner.
//!
//! Test programs of `embedded-test` list their tests in a section that is not loaded: a symbol a test, whose
//! name is a JSON object, at a pair of the test's function and its module's path. The program's command line
//! selects the function to call (semihosting), and its exit code reports the result. `probe-rs run` does the
//! same on hardware.

use std::fmt;
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
    /// Address of its function.
    address: u32,
    should_panic: bool,
    /// Whether the test is not to be run.
    pub ignored: bool,
    timeout: Duration,
}

/// Result of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TestVerdict {
    /// It ended as expected.
    Passed,
    /// Any other result, with its output.
    Failed(String),
}

/// Why the tests of a file cannot be listed.
#[derive(Debug, PartialEq, Eq)]
pub struct NoTests(&'static str);

impl fmt::Display for NoTests {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "its tests cannot be listed: {}", self.0)
    }
}

impl std::error::Error for NoTests {}

/// The tests of a firmware image by name; `None` where it holds no tests.
pub fn tests_in(elf: &[u8]) -> Result<Option<Vec<OnTarget>>, NoTests> {
    let file = object::File::parse(elf).map_err(|_| NoTests("it is no ELF file"))?;
    let Some(section) = file.section_by_name(SECTION) else { return Ok(None) };
    let table = section.data().map_err(|_| NoTests("their section cannot be read"))?;
    let mut tests = Vec::new();
    for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(section.index())) {
        // The others are the section's own, such as the version of its form.
        let Some(reported) = symbol.name().ok().filter(|name| name.starts_with('{')) else { continue };
        let reported: Value =
            serde_json::from_str(reported).map_err(|_| NoTests("a test's name is no JSON"))?;
        let at = symbol.address().checked_sub(section.address()).and_then(|at| usize::try_from(at).ok());
        let label = |n: usize| {
            let bytes = table.get(at? + 4 * n..)?.first_chunk()?;
            Some(u32::from_le_bytes(*bytes))
        };
        let (Some(address), Some(path), Some(len)) = (label(0), label(1), label(2)) else {
            return Err(NoTests("a test has no function"));
        };
        let module = text_at(&file, path, len).unwrap_or_default();
        // Without the crate's name, and without the module that every file has.
        let module = module.split_once("::").map_or("", |(_, path)| path).trim_end_matches("::tests");
        let name = reported["name"].as_str().ok_or(NoTests("a test has no name"))?;
        let flag = |key: &str| reported[key].as_bool().unwrap_or(false);
        tests.push(OnTarget {
            name: format!("{module}::{name}"),
            address,
            should_panic: flag("should_panic"),
            ignored: flag("ignored"),
            timeout: reported["timeout"].as_u64().map_or(TIMEOUT, Duration::from_secs),
        });
    }
    tests.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(Some(tests))
}

/// A text of the program, by its address in memory.
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
        std::thread::sleep(LOOK);
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
const TIMEOUT: Duration = Duration::from_mins(1);
/// Period in which an emulator is polled.
const LOOK: Duration = Duration::from_millis(5);

#[cfg(test)]
mod tests {
    use super::*;

    fn test(should_panic: bool) -> OnTarget {
        OnTarget { name: "a::b".into(), address: 1, should_panic, ignored: false, timeout: TIMEOUT }
    }

    #[test]
    fn a_panic_fails_a_test_unless_it_should_and_a_hang_fails_any() {
        assert_eq!(judged(&test(false), Some(true), ""), TestVerdict::Passed);
        assert_eq!(judged(&test(true), Some(false), "panicked"), TestVerdict::Passed);
        assert_eq!(judged(&test(false), Some(false), "why"), TestVerdict::Failed("why".into()));
        assert!(matches!(judged(&test(true), Some(true), ""), TestVerdict::Failed(_)));
        for should_panic in [false, true] {
            let TestVerdict::Failed(description) = judged(&test(should_panic), None, "") else {
                panic!("passed")
            };
            assert!(description.contains("60 s"), "{description}");
        }
    }

    #[test]
    fn what_is_no_image_has_no_tests() {
        assert!(tests_in(b"no image").is_err());
    }
}
