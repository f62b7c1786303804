//! `bring_up`: why `onetwo robot bring-up` cannot show a robot's checks, and how to fix it.

use std::fmt;

use protocol::RobotId;

/// Why the verb ends.
#[derive(Debug)]
pub(crate) enum BringUpError {
    /// A simulator has no robot to be wired.
    Simulator,
    /// No report came at all.
    Silent {
        /// For that long.
        seconds: f64,
        /// What to look at.
        hint: String,
    },
    /// No further report came.
    WentSilent {
        /// The robot that had reported.
        robot: RobotId,
        /// For that long.
        seconds: f64,
        /// Numbers of the checks without a result.
        open: Vec<usize>,
    },
}

impl fmt::Display for BringUpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulator => f.write_str(
                "--robots: a simulator's robots have nothing to be wired; give udp://HOST:PORT or serial:DEVICE[:BAUD]",
            ),
            Self::Silent { seconds, hint } => write!(
                f,
                "no robot reported its checks for {seconds} s: {hint} It must run its board's example bring_up_BOARD and have its page \
                 (onetwo firmware provision, onetwo firmware flash --page); what it finds is on its log too (docs/boards.md)"
            ),
            Self::WentSilent { robot, seconds, open } => {
                let open: Vec<_> = open.iter().map(usize::to_string).collect();
                write!(
                    f,
                    "robot {robot} fell silent {seconds} s ago; checks without a result: {}. Is it on, in range, and its radio \
                     plugged in? What it finds is on its log too (docs/boards.md)",
                    open.join(", ")
                )
            }
        }
    }
}
