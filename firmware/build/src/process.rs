//! `process`: child processes with timeouts and one-line errors.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Output of the command on stdout, if it succeeds.
pub(crate) fn output_of(command: &mut Command) -> Result<String, String> {
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("`{}` does not start: {error}", line_of(command)))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let printed = String::from_utf8_lossy(&output.stderr);
        let last = printed.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no output");
        Err(format!("`{}` failed ({}): {}", line_of(command), output.status, last.trim()))
    }
}

/// Runs the command with its output on our stderr; kills it after `limit`, because a download may hang.
pub(crate) fn run_within(limit: Duration, command: &mut Command) -> Result<(), String> {
    let line = line_of(command);
    eprintln!("firmware: {line}");
    let started = Instant::now();
    let mut child = command
        .stdin(Stdio::null())
        .stdout(std::io::stderr())
        .spawn()
        .map_err(|error| format!("`{line}` does not start: {error}"))?;
    loop {
        match child.try_wait() {
            Ok(Some(status)) if status.success() => return Ok(()),
            Ok(Some(status)) => return Err(format!("`{line}` failed ({status})")),
            Ok(None) if started.elapsed() > limit => {
                // It may have ended between the two calls: then there is nothing left to kill.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("`{line}` gave no answer within {} s", limit.as_secs()));
            }
            Ok(None) => sleep(POLL_PERIOD),
            Err(error) => return Err(format!("`{line}` was lost: {error}")),
        }
    }
}

/// The command as a user would type it: by the program's name, not by its path.
pub(crate) fn line_of(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let parts = std::iter::once(program.file_stem().unwrap_or_default()).chain(command.get_args());
    parts.map(|part| part.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Path of the program, searched in `PATH` as a shell does.
pub(crate) fn in_path(program: &str) -> Option<PathBuf> {
    let name = format!("{program}{}", env::consts::EXE_SUFFIX);
    env::split_paths(&env::var_os("PATH")?).map(|directory| directory.join(&name)).find(|path| path.is_file())
}

/// Period in which a running command is polled: short against any download, long against the poll itself.
const POLL_PERIOD: Duration = Duration::from_millis(50);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_that_hangs_is_ended() {
        let started = Instant::now();
        let answer = run_within(Duration::from_millis(200), Command::new("sleep").arg("60"));
        assert!(answer.unwrap_err().contains("no answer within"));
        assert!(started.elapsed() < Duration::from_secs(30));
    }

    #[test]
    fn the_last_line_of_a_failed_command_is_kept() {
        let error =
            output_of(Command::new("sh").args(["-c", "echo first >&2; echo 'no such thing' >&2; exit 3"]));
        let error = error.unwrap_err();
        assert!(error.contains("no such thing") && error.contains('3'), "{error}");
    }

    #[test]
    fn a_program_that_is_not_there_is_not_found() {
        assert_eq!(in_path("onetwo-has-no-such-program"), None);
        assert!(in_path("cargo").is_some());
    }
}
