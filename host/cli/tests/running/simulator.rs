//! `simulator`: requests to the simulator's control port, for tests.

use std::net::SocketAddr;

use ssl::Message as _;
use ssl::simulation::{SimulatorCommand, SimulatorControl, TeleportBall};

use super::socket;

/// Puts the ball where `ball` says, m, m/s.
pub(crate) fn teleport(to: SocketAddr, ball: TeleportBall) {
    let control = SimulatorControl { teleport_ball: Some(ball), ..SimulatorControl::default() };
    let command = SimulatorCommand { control: Some(control), config: None };
    socket().send_to(&command.encode_to_vec(), to).expect("sent");
}
