//! `settings`: configuration of a page, and the service of its program that answers viewers' questions.

use std::net::SocketAddr;
use std::sync::Arc;

use crate::limits::Limits;
use crate::program_log::ProgramLog;
use crate::request::Powers;
use crate::token::Token;
use crate::workbench::WorkbenchRequest;

/// Settings of a page.
#[derive(Clone, Debug)]
pub struct PageSettings {
    /// Address that it is served on; port 0: any free port.
    pub listen: SocketAddr,
    /// Title of the page.
    pub title: String,
    /// True for a recording: viewers start at its beginning, not at its newest moment.
    pub recorded: bool,
    /// Requests that viewers may send.
    pub powers: Powers,
    /// Token that a viewer needs for requests; `None`: every viewer may send them.
    pub token: Option<Token>,
    /// Bounds on the resources that clients can hold.
    pub limits: Limits,
    /// Reports of the program, for viewers to read.
    pub log: Arc<ProgramLog>,
}

/// Answers viewers' questions, on another thread than the match.
pub trait ExplanationService: Send + Sync {
    /// Explains why a case is retrieved: `problem` as `onetwo cases explain` takes it; the answer as it gives
    /// it with `--json`.
    fn explain(&self, problem: &str) -> Result<String, String>;

    /// Answers a request of the case workbench; JSON in, JSON out.
    fn workbench(&self, _request: &WorkbenchRequest) -> Result<String, String> {
        Err("there is no workbench here".to_owned())
    }

    /// The situations that a simulation can be put into, by name.
    fn situations(&self) -> Vec<String> {
        Vec::new()
    }
}
