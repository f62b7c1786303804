//! `page`: the web page: what happens on the field, and why. It is served by the program itself (runs on the
//! PC).
//!
//! The driver of a match fills a [`Scene`] some 25 times a second and passes it to [`Page::show`], which
//! never waits; expensive parts are computed later, on the page's own thread ([`DeferredScene`]). Viewers get
//! the newest one over a WebSocket; the seconds that have passed are kept, so that every viewer can seek back
//! for itself. Viewers' requests come back as [`UserRequest`]s, which the driver takes when it has time
//! ([`Page::next_request`]).
//!
//! ```text
//! match ─► scenes ─► archive: finished and encoded once ─┬─► newest ─► every viewer at its own pace
//!   ▲                                                  └─► seconds, events, plots ─► HTTP, on demand
//!   └──────── requests ◄ WebSocket ◄── viewers of this very page only (Origin and Host are checked)
//! ```
//! **Invariants.** It knows no host, no simulator and no strategy: what it draws beyond ball, robots and
//! lines are named layers of plain shapes. Slow, lost or many viewers cost the match nothing; connections are
//! counted and timed ([`Limits`]). Viewing is free for all that reach the page; requests need its [`Token`],
//! where it has one. SI units, field frame.
#![forbid(unsafe_code)]

mod archive;
mod deferred_scene;
mod files;
mod guard;
mod http;
mod limits;
mod match_event;
mod page;
mod places;
mod problem;
mod program_log;
mod request;
mod routes;
mod scene;
mod server;
mod settings;
mod shape;
mod shared;
mod socket;
mod token;
mod viewers;
mod workbench;

pub use archive::ArchiveSample;
pub use deferred_scene::DeferredScene;
pub use limits::Limits;
pub use match_event::{DecisionNote, MatchEvent, MatchEventKind};
pub use page::{Page, PageError, Transport};
pub use problem::problem;
pub use program_log::{LogEntry, LogLevel, ProgramLog};
pub use request::{PageTeam, Powers, Refused, UserRequest};
pub use scene::{
    AirCounts, CameraNote, Cycle, Field, Gauge, Intent, LinkWindow, Match, MatchEnd, PerTeam, Raw,
    RobotDetail, Scene, SceneBall, SceneRobot, TeamSheet, Timer, Vitals, Windowed,
};
pub use settings::{ExplanationService, PageSettings};
pub use shape::{Heat, Layer, Shape, Tone};
pub use token::{NoToken, Token};
pub use workbench::{MatchProblem, WorkbenchRequest};

/// Rounded to a thousandth: millimetres are enough for the page, and JSON is shorter.
pub fn milli(x: f32) -> f32 {
    // Rounds halves away from zero; what is not finite becomes 0.
    if x.is_finite() { (x * 1000.0).round() / 1000.0 } else { 0.0 }
}
