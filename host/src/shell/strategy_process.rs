//! `strategy_process`: a strategy in a program of its own: views go to its standard input, answers come from
//! its standard output, a line each. One that ends or does not answer is ended and started again.

use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::external::{StrategyLink, StrategyStarter};

/// Longest time for an answer where nothing runs in real time: a program that plans for longer is stuck.
const ANSWER_WAIT_MAX: Duration = Duration::from_secs(5);
/// Misses in a row after which a program that has answered before is given up.
const MISSES_MAX: u32 = 3;
/// A program that ended is started again after this time.
const RESTART_AFTER: Duration = Duration::from_millis(500);
/// Longest line of an answer, bytes: 16 orders of 200.
const LINE_BYTES_MAX: u64 = 64 * 1024;
/// Answers that wait to be read.
const ANSWERS_KEPT: usize = 8;

/// A strategy's program and its pipes.
#[derive(Debug)]
pub struct StrategyProcess {
    command: String,
    within: Duration,
    running: Option<Running>,
    /// Not started again before this.
    again: Instant,
    starts: u32,
    /// Whether it ever answered, and the misses since its last answer.
    answered: bool,
    misses: u32,
    /// Why it did not answer the last time.
    miss: Option<Miss>,
}

/// Why an answer is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Miss {
    /// The program ended, or closed its input or output.
    Ended,
    /// No line came in time.
    TimedOut,
}

#[derive(Debug)]
struct Running {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
}

impl StrategyProcess {
    /// Starts `command` in a shell, with or without `cmd:` before it; an answer that takes longer than
    /// `within` counts as none.
    pub fn start(command: &str, within: Duration) -> io::Result<Self> {
        let command = command.strip_prefix("cmd:").unwrap_or(command);
        let running = Running::start(command)?;
        let command = command.to_owned();
        Ok(Self {
            command,
            within,
            running: Some(running),
            again: Instant::now(),
            starts: 1,
            answered: false,
            misses: 0,
            miss: None,
        })
    }

    /// A starter of this command for matches in the simulator, which wait for the answer.
    pub fn starter(command: &str) -> StrategyStarter {
        let own = command.to_owned();
        StrategyStarter::new(command, move || Ok(Box::new(Self::start(&own, ANSWER_WAIT_MAX)?)))
    }

    /// Number of starts of the process.
    pub fn starts(&self) -> u32 {
        self.starts
    }

    /// Identifier of the process, while it runs.
    pub fn id(&self) -> Option<u32> {
        self.running.as_ref().map(|running| running.child.id())
    }
}

impl Running {
    fn start(command: &str) -> io::Result<Self> {
        let mut child = Command::new("sh")
            .arg("-c")
            .arg(format!("exec {command}"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .process_group(0)
            .spawn()?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::Error::other("the program has no standard input and output"));
        };
        let (send, answers) = sync_channel(ANSWERS_KEPT);
        thread::Builder::new().name("strategy".to_owned()).spawn(move || read(output, &send))?;
        Ok(Self { child, input, answers })
    }

    /// The answer to a line; `Err`: the program is to be ended.
    fn ask(&mut self, view: &str, within: Duration) -> Result<String, Miss> {
        // Answers to earlier views came too late.
        while self.answers.try_recv().is_ok() {}
        let sent = self.input.write_all(view.as_bytes()).and_then(|()| self.input.write_all(b"\n"));
        sent.and_then(|()| self.input.flush()).map_err(|_| Miss::Ended)?;
        self.answers.recv_timeout(within).map_err(|error| match error {
            RecvTimeoutError::Timeout => Miss::TimedOut,
            RecvTimeoutError::Disconnected => Miss::Ended,
        })
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The processes that it started belong to its group, and end with it. It may have ended by itself.
        let group = format!("kill -KILL -{} 2>/dev/null", self.child.id());
        let _ = Command::new("sh").arg("-c").arg(group).status();
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl StrategyLink for StrategyProcess {
    fn answer(&mut self, view: &str) -> Option<String> {
        if self.running.is_none() && Instant::now() >= self.again {
            self.again = Instant::now() + RESTART_AFTER;
            self.running = Running::start(&self.command).ok();
            self.starts += u32::from(self.running.is_some());
        }
        match self.running.as_mut()?.ask(view, self.within) {
            Ok(answer) => {
                (self.answered, self.misses) = (true, 0);
                Some(answer)
            }
            Err(miss) => {
                (self.running, self.miss) = (None, Some(miss));
                self.misses += 1;
                None
            }
        }
    }

    fn failure(&self) -> Option<String> {
        let given_up = if self.answered { self.misses >= MISSES_MAX } else { self.misses > 0 };
        let miss = self.miss.filter(|_| given_up)?;
        let (command, ever) = (&self.command, if self.answered { "" } else { " without ever answering" });
        Some(match miss {
            Miss::Ended => format!(
                "the strategy `{command}` ended{ever}: does it run by itself, and read until its input ends?"
            ),
            Miss::TimedOut => format!(
                "no answer from the strategy `{command}` for {} s{}: does it flush its output after every line?",
                self.within.as_secs(),
                if self.answered { "" } else { ", it never answered" }
            ),
        })
    }
}

/// Passes lines on until the program closes its output or writes a line that is too long.
fn read(output: impl io::Read, send: &SyncSender<String>) {
    let mut lines = BufReader::new(output);
    loop {
        let mut line = Vec::new();
        let read = lines.by_ref().take(LINE_BYTES_MAX).read_until(b'\n', &mut line);
        if read.is_err() || line.last() != Some(&b'\n') {
            return;
        }
        // A program that writes without being asked fills the queue; it then waits.
        if send.send(String::from_utf8_lossy(&line).trim_end().to_owned()).is_err() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_answers_line_by_line_and_is_started_again_when_it_ends() {
        // Answers twice, then ends.
        let command = "sh -c 'for i in 1 2; do read line; echo \"$line back\"; done'";
        let mut process = StrategyProcess::start(command, Duration::from_secs(5)).unwrap();
        assert_eq!(process.answer("a").as_deref(), Some("a back"));
        assert_eq!(process.answer("b").as_deref(), Some("b back"));
        assert_eq!(process.answer("c"), None);
        let mut again = None;
        for _ in 0..100 {
            again = again.or_else(|| process.answer("d"));
            thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(again.as_deref(), Some("d back"));
        assert!(process.starts() >= 2);
    }

    #[test]
    fn one_that_does_not_answer_is_no_longer_waited_for() {
        let mut process = StrategyProcess::start("sleep 60", Duration::from_millis(50)).unwrap();
        assert_eq!(process.answer("a"), None);
        assert_eq!(process.id(), None, "it was ended");
        assert!(process.failure().is_some_and(|words| words.contains("does it flush")), "{process:?}");
    }

    #[test]
    fn a_program_that_is_not_there_or_ends_at_once_is_given_up_in_words() {
        for command in ["true", "false", "no-such-program-here 2>/dev/null", "exec >&-"] {
            let mut process = StrategyProcess::start(command, Duration::from_secs(5)).unwrap();
            assert_eq!(process.answer("a"), None, "{command}");
            let words = process.failure().unwrap_or_default();
            assert!(words.contains("without ever answering"), "{command}: {words}");
        }
    }

    #[test]
    fn the_children_of_a_strategy_end_with_it() {
        let name = format!("onetwo-strategy-{}", std::process::id());
        let marker = std::env::temp_dir().join(name).display().to_string();
        let command = format!("sh -c 'trap \"\" TERM; (sleep 2; echo alive > {marker}) & sleep 60'");
        let mut process = StrategyProcess::start(&command, Duration::from_millis(100)).unwrap();
        assert_eq!(process.answer("a"), None);
        drop(process);
        thread::sleep(Duration::from_millis(2_500));
        assert!(!std::path::Path::new(&marker).exists(), "a child went on");
    }
}
