//! `failure`: why `onetwo robot bring-up` cannot show a robot's checks, and how to fix it.

use protocol::RobotId;
use thiserror::Error;

#[derive(Debug, Error)]
pub(super) enum BringUpError {
    #[error(
        "--robots: a simulator's robots have nothing to be wired; give udp://HOST:PORT or serial:DEVICE[:BAUD]"
    )]
    Simulator,
    #[error(
        "no robot reported its checks for {seconds} s: {hint} It must run its board's example bring_up_BOARD and have \
         its page (onetwo firmware provision, onetwo firmware flash --page); what it finds is on its log too \
         (docs/boards.md)"
    )]
    Silent { seconds: f64, hint: String },
    #[error(
        "robot {robot} fell silent {seconds} s ago; checks without a result: {}. Is it on, in range, and its \
         radio plugged in? What it finds is on its log too (docs/boards.md)",
        open.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
    )]
    WentSilent {
        robot: RobotId,
        seconds: f64,
        /// Numbers of the checks without a result.
        open: Vec<usize>,
    },
}
