//! `network`: why a verb on the league's networks cannot continue: `onetwo control`, `simulate`, and every
//! page.

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use hil_sim::small_size::referee::NoRules;
use host::config::ConfigError;
use host::shell::LinkError;
use host::shell::key::KeyError;
use page::{NoToken, PageError};
use rules::League;

use crate::output::printable_path;

/// Why the verb ends.
#[derive(Debug)]
pub(crate) enum NetworkError {
    /// `--assistant` or `--autoref` beside the internal referee.
    InternalReferee,
    /// A league without wheels.
    NotOnWheels(League),
    /// A league without rules of the Small Size League.
    NoRules(NoRules),
    /// The ports of `--sync` cannot be had.
    Sync(SocketAddr, io::Error),
    /// The team's key cannot be used.
    Key(KeyError),
    /// Real robots on this link and a key that is public: that of the file, or none given.
    PublicKey {
        /// The link as in `--robots`.
        link: String,
        /// `--key-file`.
        file: Option<PathBuf>,
    },
    /// A file of settings cannot be read.
    ConfigUnreadable(PathBuf, io::Error),
    /// A file of settings is faulty.
    ConfigFile(PathBuf, ConfigError),
    /// Flags and settings together are faulty.
    Config(ConfigError),
    /// `sim://` names no machine that is known: what stands behind it.
    UnknownSimulator(String),
    /// The recording with this stem cannot be begun.
    Record(PathBuf, io::Error),
    /// This program's own file is unknown, which robots in a simulator are started from.
    Program(io::Error),
    /// The new settings file cannot be written.
    Init(PathBuf, io::Error),
    /// The program of the team's own strategy cannot be started.
    Strategy(io::Error),
    /// The link to the robots cannot be opened.
    Link(LinkError),
    /// The page cannot be served; the flag of its address.
    Page(PageError, &'static str),
    /// There are no random numbers for the page's token; the flag of its address.
    Token(NoToken, &'static str),
}

impl fmt::Display for NetworkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InternalReferee => f.write_str(
                "--assistant and --autoref serve a game controller elsewhere, and the internal referee needs neither; \
                 add --referee none, or the ADDRESS:PORT of its packets",
            ),
            Self::NotOnWheels(league) => write!(f, "{} is not played on wheels", league.name()),
            Self::NoRules(error) => write!(f, "{error}"),
            Self::Sync(blue, error) => {
                write!(f, "--sync {blue}: {error}; it and the next port must be free")
            }
            Self::Key(error) => write!(f, "{error}"),
            Self::PublicKey { link, file } => {
                write!(f, "{link}: ")?;
                match file {
                    Some(file) => write!(f, "the key in {} is all zeros, which is public", file.display())?,
                    None => f.write_str("there is no --key-file, and the key of zeros is public")?,
                }
                f.write_str(
                    ": anybody in radio range could command the robots. Make a key with `openssl rand -hex 16 > team.key`, \
                     provision the robots with it (docs/security.md) and add --key-file team.key; or add --insecure-zero-key",
                )
            }
            Self::ConfigUnreadable(path, error) => write!(f, "{}: {error}", printable_path(path)),
            Self::ConfigFile(path, error) => write!(f, "{}: {error}", printable_path(path)),
            Self::Config(error) => write!(f, "{error}"),
            Self::UnknownSimulator(host) => write!(
                f,
                "sim://{host}: no such machine; give sim://HOST or sim://HOST:PORT of a simulator"
            ),
            Self::Record(stem, error) => write!(f, "--record {}: {error}", stem.display()),
            Self::Program(error) => write!(f, "{error}"),
            Self::Init(path, error) if error.kind() == io::ErrorKind::AlreadyExists => {
                write!(f, "{}: exists already and is kept; name another file", printable_path(path))
            }
            Self::Init(path, error) => write!(f, "{}: {error}", printable_path(path)),
            Self::Strategy(error) => write!(f, "--strategy: its program cannot be started: {error}"),
            Self::Link(error) => write!(f, "{error}"),
            Self::Page(error, flag) => write!(f, "{error} ({flag})"),
            Self::Token(error, flag) => write!(f, "{error} ({flag})"),
        }
    }
}
