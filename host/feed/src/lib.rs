//! `live`: feed of the page. A match, a host or a recording becomes a [`page::Scene`] some 25 times a second.
//!
//! [`Composer`] fills scenes from hosts, the same for `play`, `control` and `replay`; [`explanations`]
//! answers why a case was chosen. Everything here only observes: no decision is made here.

mod beliefs;
mod cameras;
mod composer;
mod cycles;
pub(crate) mod description;
mod explanations;
mod gauges;
mod layers;
mod ledger_feed;
mod legged;
mod match_events;
mod match_runner;
mod minds;
mod names;
mod overlay_builder;
mod parameter_feed;
mod paths;
mod possession;
mod raw;
mod snapshots;
mod tactics;
#[cfg(test)]
mod tests;
mod windows;

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use arena::cases::LibraryHandle;
use clap::Args;
use page::{Limits, Page, PageTeam, Powers, Token};
use rules::{Colour, League};

use crate::Failure;
use crate::args::{DirectoryArgs, LibraryArgs};
use crate::failure::NetworkError;
use crate::output::{note, print_secret, program_log};
use crate::stop::stopped_by_hand;

pub(crate) use composer::{Composer, Moment};
pub(crate) use cycles::{TeamCycles, reported};
use description::spaced;
pub(crate) use explanations::CaseExplanations;
pub(crate) use gauges::tick;
pub(crate) use ledger_feed::LedgerFeed;
pub(crate) use legged::Legged;
pub(crate) use match_runner::{End, MatchRunner, RestartWatcher, command_of};
pub(crate) use names::Names;
pub(crate) use parameter_feed::{ParameterFeed, change_of, description_of, description_of_test, test_of};
pub(crate) use snapshots::{SnapshotRequest, Snapshots};

/// Period of scenes, s: smooth motion, with the page interpolating in between.
pub(crate) const SCENE_EVERY_S: f64 = 0.04;

/// Where the page is served.
#[derive(Clone, Debug, Args)]
pub(crate) struct PageArgs {
    /// Address of the page; it is reachable from other machines only if an address other than the loopback is
    /// given.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Name of the flag at this verb, for messages.
    #[arg(skip = LISTEN)]
    flag: &'static str,
}

/// The usual name of the flag.
const LISTEN: &str = "--listen";

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
    ) -> Result<Page, Failure> {
        let open = !self.listen.ip().to_canonical().is_loopback();
        let token = open.then(Token::random).transpose();
        let token = token.map_err(|error| NetworkError::Token(error, self.flag))?;
        let limits = Limits::default();
        let (listen, log) = (self.listen, program_log());
        let settings =
            page::PageSettings { listen, title, recorded, powers, token: token.clone(), limits, log };
        let page = Page::open(settings, Arc::new(explanations))
            .map_err(|error| NetworkError::Page(error, self.flag))?;
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
pub(crate) fn stay(page: Page, description: &str) {
    note!("{description}; the page stays until Ctrl-C");
    while !stopped_by_hand().load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(50));
    }
    drop(page);
}

/// The cases that come with a league, or those of a directory; none if neither exists.
pub(crate) fn library_handle_of(
    league: League,
    directory: Option<&std::path::Path>,
) -> Result<Option<LibraryHandle>, Failure> {
    let known = case_library::league(league.name()).is_some();
    if directory.is_none() && !known {
        return Ok(None);
    }
    let directory = DirectoryArgs { library: directory.map(std::path::Path::to_owned) };
    crate::library::open(&LibraryArgs { directory, league: league.name().to_owned() }).map(Some)
}

/// A colour in the page's format.
pub(crate) const fn team(colour: Colour) -> PageTeam {
    match colour {
        Colour::Blue => PageTeam::Blue,
        Colour::Yellow => PageTeam::Yellow,
    }
}

/// The inverse of [`team`].
pub(crate) const fn colour(team: PageTeam) -> Colour {
    match team {
        PageTeam::Blue => Colour::Blue,
        PageTeam::Yellow => Colour::Yellow,
    }
}
