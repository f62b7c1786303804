//! `page_browser`: browser driver. Starts Chromium without a window and drives it by its own protocol (CDP);
//! runs on the PC, for tests and screenshots alone.
//!
//! A dozen of the protocol's commands are enough here. The crates with all of its commands (chromiumoxide,
//! headless_chrome) generate some hundred thousand lines of types: a minute and more of every clean build,
//! for the same dozen.
#![forbid(unsafe_code)]

mod browser;
mod tab;

pub use browser::{Browser, BrowserError, find};
pub use tab::Tab;
