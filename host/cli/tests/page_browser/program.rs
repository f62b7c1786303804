//! `program`: the built program with its page: started, connected, and ended with the test.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

/// A verb that serves a page.
pub(crate) struct Program {
    child: Child,
    address: String,
    token: Option<String>,
    lines: Receiver<String>,
}

impl Program {
    /// Starts a match of ten minutes with its page.
    #[allow(dead_code, reason = "one of the tests that share this file plays none")]
    pub(crate) fn play(more: &[&str]) -> Self {
        Self::start(&[&["play", "--duration", "600", "--listen", "127.0.0.1:0"], more].concat())
    }

    /// Starts it and waits for the page's address.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_onetwo"))
            .args(arguments)
            // The host's epoch is kept there, not in the home of the user that runs the tests.
            .env("XDG_STATE_HOME", env!("CARGO_TARGET_TMPDIR"))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let mut reported = Vec::new();
        let address = loop {
            match lines.next() {
                Some(Ok(line)) => match line.strip_prefix("page     http://") {
                    Some(address) => break address.to_owned(),
                    None => reported.push(line),
                },
                _ => panic!("no page: {reported:?}"),
            }
        };
        let (address, token) = match address.split_once("/?token=") {
            Some((address, token)) => (address.to_owned(), Some(token.to_owned())),
            None => (address, None),
        };
        // A full pipe would block it.
        let (send, later) = channel();
        thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let _ = send.send(line);
            }
        });
        Self { child, address, token, lines: later }
    }

    pub(crate) fn address(&self) -> &str {
        &self.address
    }

    /// The token that its page requires for requests.
    #[allow(dead_code, reason = "one of the two tests that share this file asks without a browser")]
    pub(crate) fn token(&self) -> Option<&str> {
        self.token.as_deref()
    }

    /// Waits for a line on stderr that contains `arguments`.
    #[allow(dead_code, reason = "one of the two tests that share this file listens")]
    pub(crate) fn wait_for(&self, arguments: &str) {
        while let Ok(line) = self.lines.recv_timeout(Duration::from_secs(40)) {
            if line.contains(arguments) {
                return;
            }
        }
        panic!("`{arguments}` was not printed");
    }

    /// The page's whole answer to a request for `path`, with its head.
    #[allow(dead_code, reason = "tests without a browser ask for it")]
    pub(crate) fn get(&self, path: &str) -> String {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", self.address).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    #[allow(dead_code, reason = "the browser's tests ask for it")]
    pub(crate) fn url(&self, more: &str) -> String {
        format!("http://{}/{more}", self.address)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[allow(dead_code, reason = "the browser's tests run it")]
/// Runs the program with that input, to its end.
pub(crate) fn onetwo(arguments: &[&str], input: &str) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    String::from_utf8(child.wait_with_output().unwrap().stdout).unwrap()
}
