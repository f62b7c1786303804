//! `page`: the page's flag, and the page that it opens.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use clap::Args;
use feed::CaseExplanations;
use page::{Limits, NoToken, Page, PageError, PageSettings, Powers, Token};
use thiserror::Error;

use super::parsers::address;
use crate::output::{note, print_secret, program_log};
use crate::stop::stopped_by_hand;

/// Where the page is served.
#[derive(Clone, Debug, Args)]
pub(crate) struct PageArgs {
    /// Address of the page; it is reachable from other machines only if an address other than the loopback is
    /// given.
    #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:8080", value_parser = address)]
    listen: SocketAddr,
    /// Name of the flag at this verb, for messages.
    #[arg(skip = LISTEN)]
    flag: &'static str,
}

/// Name of the flag at most verbs.
const LISTEN: &str = "--listen";

/// Why there is no page; with the flag of its address.
#[derive(Debug, Error)]
pub(crate) enum NoPage {
    #[error("{0} ({1})")]
    Page(PageError, &'static str),
    #[error("{0} ({1})")]
    Token(NoToken, &'static str),
}

impl PageArgs {
    /// Arguments for a page at `listen`, by a verb that has another name for the flag.
    pub(crate) fn at(listen: SocketAddr, flag: &'static str) -> Self {
        Self { listen, flag }
    }

    /// Opens the page and prints its address.
    pub(crate) fn open(
        &self,
        title: String,
        recorded: bool,
        powers: Powers,
        explanations: CaseExplanations,
    ) -> Result<Page, NoPage> {
        let open = !self.listen.ip().to_canonical().is_loopback();
        let token = open.then(Token::random).transpose();
        let token = token.map_err(|error| NoPage::Token(error, self.flag))?;
        let (listen, log, limits) = (self.listen, program_log(), Limits::default());
        let settings = PageSettings { listen, title, recorded, powers, token: token.clone(), limits, log };
        let page =
            Page::open(settings, Arc::new(explanations)).map_err(|error| NoPage::Page(error, self.flag))?;
        let at = page.address();
        match token {
            None => note!("page     http://{at}"),
            Some(token) => {
                print_secret(format_args!("page     http://{at}/?token={}", token.as_str()));
                note!(
                    "page     all that reach this machine can look on at http://{at}; to ask for anything takes the address with the token"
                );
            }
        }
        Ok(page)
    }
}

/// Keeps the page open after everything was played, until the operator ends the program.
pub(crate) fn stay(page: Page, end: &str) {
    note!("{end}; the page stays until Ctrl-C");
    while !stopped_by_hand().load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(50));
    }
    drop(page);
}
