//! `program`: the built program with its page: started, connected, and ended with the test.

use std::cell::RefCell;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};

use crate::running::Running;

/// A verb that serves a page.
pub(crate) struct Program {
    running: RefCell<Running>,
    address: String,
    token: Option<String>,
}

impl Program {
    /// Starts a match of ten minutes with its page.
    #[allow(dead_code, reason = "one of the tests that share this file plays none")]
    pub(crate) fn play(more: &[&str]) -> Self {
        Self::start(&[&["play", "--duration", "600", "--listen", "127.0.0.1:0"], more].concat())
    }

    /// Starts it and waits for the page's address.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut running = Running::start(arguments);
        let (_, line) = running.wait_for("page     http://");
        let address = line.trim_start_matches("page     http://");
        let (address, token) = match address.split_once("/?token=") {
            Some((address, token)) => (address, Some(token.to_owned())),
            None => (address, None),
        };
        Self { address: address.to_owned(), token, running: RefCell::new(running) }
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
        self.running.borrow_mut().wait_for(arguments);
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
