//! `terminals`: blocks of the start pages whose commands run beside each other, each in a terminal of its own
//! until Ctrl-C: all are started in their order, each once the one before shows what is promised of it, and
//! then ended.

use std::collections::BTreeSet;
use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::net::TcpStream;
use std::os::unix::process::CommandExt as _;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use flate2::read::GzDecoder;
use match_tests::workspace::root;

use crate::is_there;
use crate::promises::{Promise, command_of, promised};

/// Longest time until a promised line comes; however busy the machine is.
const PATIENCE: Duration = Duration::from_mins(3);
/// Time between two looks.
const LOOK_PERIOD: Duration = Duration::from_millis(200);
/// The pseudo terminal that a page names; the real one is printed by the command before.
const NAMED_TERMINAL: &str = "/dev/pts/0";
/// The built program, from the workspace's root: `cargo run` would stay between it and a signal.
const PROGRAM: &str = "target/release/onetwo";
/// More places than those of the robots and the ball at one time.
const PLACES_MIN: usize = 40;

/// Files that the blocks write into the clone; removed with this value.
pub(crate) struct Written;

impl Written {
    const FILES: [&str; 3] = ["team.key", "robot0.page", "robot1.page"];

    pub(crate) fn new() -> Self {
        for file in Self::FILES {
            assert!(!root().join(file).exists(), "{file} is in the clone already: move it elsewhere");
        }
        Self
    }
}

impl Drop for Written {
    fn drop(&mut self) {
        for file in Self::FILES {
            // One that was not written is no error of its own.
            let _ = std::fs::remove_file(root().join(file));
        }
    }
}

pub(crate) fn block(lines: &[&str]) {
    let mut running: Vec<Terminal> = Vec::new();
    for line in lines {
        let promises = promised(line);
        let pty = running.iter().find_map(|terminal| terminal.pty.clone());
        let mut terminal =
            Terminal::start(&line.replace(NAMED_TERMINAL, pty.as_deref().unwrap_or(NAMED_TERMINAL)));
        if promises.iter().all(|promise| promise.ends()) {
            assert!(terminal.child.wait().expect("our own child").success(), "`{line}`");
            for promise in promises {
                assert!(matches!(promise, Promise::Writes(file) if is_there(file)), "`{line}`: {promise:?}");
            }
        } else {
            promises.into_iter().for_each(|promise| terminal.see(promise));
            running.push(terminal);
        }
    }
}

/// A running command; ended with this value.
struct Terminal {
    line: String,
    child: Child,
    output: Receiver<String>,
    printed: Vec<String>,
    /// A pseudo terminal that it has opened.
    pty: Option<String>,
}

impl Terminal {
    fn start(line: &str) -> Self {
        println!("$ {line}");
        let arguments = command_of(line);
        let is_program = arguments != line;
        let mut command = Command::new(if is_program { root().join(PROGRAM) } else { "sh".into() });
        if is_program {
            command.args(arguments.split_whitespace());
        } else {
            command.args(["-c", line]);
        }
        command
            .process_group(0)
            .current_dir(root())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        let (send, output) = channel();
        let pipes: [Box<dyn Read + Send>; 2] =
            [Box::new(child.stdout.take().expect("piped")), Box::new(child.stderr.take().expect("piped"))];
        for pipe in pipes {
            let send = send.clone();
            thread::spawn(move || {
                for line in BufReader::new(pipe).lines().map_while(Result::ok) {
                    // The block may be over.
                    let _ = send.send(line);
                }
            });
        }
        Self { line: line.to_owned(), child, output, printed: Vec::new(), pty: None }
    }

    /// Waits for what is promised while it runs.
    fn see(&mut self, promise: Promise) {
        let until = Instant::now() + PATIENCE;
        match promise {
            Promise::Page => assert!(robots_move(until), "`{}`: no robot moves on its page", self.line),
            Promise::RunsUntil(text) | Promise::Prints(text) => self.wait_for(text, until),
            Promise::Writes(_) | Promise::TraceOf(_) => panic!("`{}` does not end: {promise:?}", self.line),
        }
    }

    fn wait_for(&mut self, text: &str, until: Instant) {
        while !self.printed.iter().any(|line| line.contains(text)) {
            match self.output.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(line) => {
                    let pty = line.split_whitespace().find(|word| word.starts_with("/dev/pts/"));
                    self.pty = self.pty.take().or_else(|| pty.map(str::to_owned));
                    self.printed.push(line);
                }
                Err(error) => panic!("`{}` did not print `{text}` ({error}): {:#?}", self.line, self.printed),
            }
        }
    }

    /// Sends a signal to the command and all that it has started.
    fn signal(&self, name: &str) {
        let group = format!("-{}", self.child.id());
        let _ = Command::new("kill").args([name, "--", &group]).stderr(Stdio::null()).status();
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // As Ctrl-C does, to the command and what it has started; then, where it does not listen, without
        // asking. It may have ended by itself.
        self.signal("-INT");
        let until = Instant::now() + Duration::from_secs(10);
        while Instant::now() < until && matches!(self.child.try_wait(), Ok(None)) {
            thread::sleep(LOOK_PERIOD);
        }
        self.signal("-KILL");
        let _ = self.child.wait();
    }
}

/// Whether something on the page at port 8080 is elsewhere in a later second of the match.
fn robots_move(until: Instant) -> bool {
    let (mut places, mut second) = (BTreeSet::new(), 0);
    while places.len() < PLACES_MIN && Instant::now() < until {
        let scenes = get(&format!("/api/second/{second}")).unwrap_or_default();
        if scenes.contains("\"robots\":[{") {
            let at = scenes.split("\"at\":[").skip(1).filter_map(|rest| rest.split(']').next());
            places.extend(at.map(str::to_owned));
            second += 1;
        } else {
            thread::sleep(LOOK_PERIOD);
        }
    }
    places.len() >= PLACES_MIN
}

/// The page's answer to a request, its gzip taken off.
fn get(path: &str) -> std::io::Result<String> {
    let mut stream = TcpStream::connect("127.0.0.1:8080")?;
    write!(stream, "GET {path} HTTP/1.1\r\nHost: 127.0.0.1:8080\r\nConnection: close\r\n\r\n")?;
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer)?;
    let body = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").map_or(answer.len(), |at| at + 4);
    let (head, body) = answer.split_at(body);
    let mut text = String::new();
    if String::from_utf8_lossy(head).contains("content-encoding: gzip") {
        GzDecoder::new(body).read_to_string(&mut text)?;
    } else {
        text.push_str(&String::from_utf8_lossy(body));
    }
    Ok(text)
}
