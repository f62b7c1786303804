//! `failure`: why a field cannot be served, or a match not be played under a game controller.

use std::io;
use std::net::SocketAddr;

use ssl::net::NetError;
use thiserror::Error;

use crate::small_size::referee::NoRules;

/// Why there is no field on the network.
#[derive(Debug, Error)]
pub enum NetworkError {
    /// A league without rules of the Small Size League.
    #[error(transparent)]
    NoRules(#[from] NoRules),
    /// The game controller that the field leads.
    #[error(transparent)]
    Controller(#[from] CiError),
    /// The ports of the synchronous mode cannot be had.
    #[error("--sync {0}: {1}; it and the next port must be free")]
    Sync(SocketAddr, io::Error),
}

/// Error that keeps a match from being played under a game controller.
#[derive(Debug, Error)]
pub enum CiError {
    /// A league without rules of the Small Size League.
    #[error(transparent)]
    NoRules(#[from] NoRules),
    /// The connection.
    #[error(transparent)]
    Net(#[from] NetError),
    /// The address names no host.
    #[error("{0}: {1}; expected HOST:PORT, or the path of the program")]
    Address(String, String),
    /// The controller does not answer.
    #[error(
        "the game controller at {at} has not answered for {seconds} s; is its time-acquisition-mode `ci`, and no other program connected?"
    )]
    Silent {
        /// Address of the controller.
        at: SocketAddr,
        /// Time that was waited, s.
        seconds: u64,
    },
    /// The program cannot be started.
    #[error(
        "the game controller `{0}` does not start: {1}; it is the league's ssl-game-controller, one program for each system, from https://github.com/RoboCup-SSL/ssl-game-controller/releases (docs/start/league-team.md)"
    )]
    NoProgram(String, io::Error),
    /// The program ended, or does not listen.
    #[error("the game controller `{0}` does not listen; its last lines: {1}")]
    NotListening(String, String),
}
