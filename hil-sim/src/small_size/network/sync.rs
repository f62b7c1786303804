//! `sync`: the simulation protocol's synchronous mode, `--sync`. TCP, each message after its length as a
//! varint, one port for each team; simulated time passes only where a client asks for a step, so that the
//! same requests give the same answers.
//!
//! The protocol has the messages and proposes this transport; it names no port, so there is none by default.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::time::Duration;

use crate::small_size::World;
use crate::small_size::server::Server;
use rules::Colour;
use ssl::net::Connection;
use ssl::simulation::SimulationSyncRequest;

/// Clients of one team's port; more are turned away.
const CLIENTS_MAX: usize = 8;
/// Most requests of one client in one period of the simulator: Ctrl-C and the page must be served too.
const REQUESTS_MAX: usize = 64;

pub(super) struct SyncPorts {
    teams: [TeamPort; 2],
}

struct TeamPort {
    colour: Colour,
    listener: TcpListener,
    clients: Vec<Connection>,
}

impl SyncPorts {
    /// Blue's port, and yellow's at the next one. With port 0 any two that are free.
    pub(super) fn open(blue: SocketAddr) -> io::Result<Self> {
        let team = |colour, address: SocketAddr| {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            Ok::<_, io::Error>(TeamPort { colour, listener, clients: Vec::new() })
        };
        let mut yellow = blue;
        if blue.port() != 0 {
            let next = blue.port().checked_add(1).ok_or(io::ErrorKind::InvalidInput)?;
            yellow.set_port(next);
        }
        Ok(Self { teams: [team(Colour::Blue, blue)?, team(Colour::Yellow, yellow)?] })
    }

    /// The address that clients connect to, for the operator.
    pub(super) fn line(&self) -> String {
        let [blue, yellow] = self.teams.each_ref().map(|team| match team.listener.local_addr() {
            Ok(address) => address.to_string(),
            Err(error) => error.to_string(),
        });
        format!(
            "sync     blue {blue}, yellow {yellow} (TCP): time passes only where a client asks for a step"
        )
    }

    /// Handles clients' requests; `each` gets the world after every step of it.
    pub(super) fn serve(
        &mut self,
        server: &mut Server,
        lines: &mut Vec<String>,
        mut each: impl FnMut(&mut World, &mut Vec<String>),
    ) {
        for team in &mut self.teams {
            while let Ok((stream, from)) = team.listener.accept() {
                if team.clients.len() >= CLIENTS_MAX {
                    lines.push(format!(
                        "sync     {from} turned away: {CLIENTS_MAX} clients are connected already"
                    ));
                    continue;
                }
                // On some systems a connection inherits the listener's mode.
                match stream.set_nonblocking(false).map_err(ssl_io).and_then(|()| Connection::over(stream)) {
                    Ok(client) => team.clients.push(client),
                    Err(error) => lines.push(format!("sync     {error}")),
                }
            }
            let colour = team.colour;
            team.clients.retain_mut(|client| match answer(client, colour, server, lines, &mut each) {
                Ok(()) => true,
                Err(error) => {
                    lines.push(format!("sync     {error}"));
                    false
                }
            });
        }
    }
}

fn ssl_io(error: io::Error) -> ssl::net::NetError {
    ssl::net::NetError::System { doing: "talk with", address: SocketAddr::from(([0; 4], 0)), error }
}

/// Answers the requests of one client; an error ends the connection.
fn answer(
    client: &mut Connection,
    colour: Colour,
    server: &mut Server,
    lines: &mut Vec<String>,
    each: &mut impl FnMut(&mut World, &mut Vec<String>),
) -> Result<(), ssl::net::NetError> {
    for _ in 0..REQUESTS_MAX {
        let Some(request) = client.receive::<SimulationSyncRequest>(Duration::ZERO)? else { break };
        let response = server.synchronous(colour, &request, |world| each(world, lines));
        client.send(&response)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::thread;

    use crate::small_size::compatibility::Profile;
    use crate::small_size::server::ServerSettings;
    use rules::League;
    use ssl::Message;
    use ssl::simulation::{
        MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotMoveCommand, SimulationSyncResponse,
    };

    use super::*;

    fn request(step: f32, speed: f32) -> SimulationSyncRequest {
        let local = MoveLocalVelocity { forward: speed, left: 0.0, angular: 0.0 };
        let command = Some(MoveCommand::LocalVelocity(local));
        let robot =
            RobotCommand { id: 1, move_command: Some(RobotMoveCommand { command }), ..Default::default() };
        SimulationSyncRequest {
            sim_step: Some(step),
            simulator_command: None,
            robot_control: Some(RobotControl { robot_commands: vec![robot] }),
        }
    }

    /// A client of each team takes turns for `steps` steps of 16 ms; returns all answers.
    fn play(steps: u32) -> Vec<u8> {
        let settings =
            ServerSettings::of(League::DivisionB, Profile::Ours, 3, 0.0).expect("a league on wheels");
        let mut server = Server::new(&settings);
        let mut ports = SyncPorts::open(SocketAddr::from(([127, 0, 0, 1], 0))).expect("free ports");
        let addresses = ports.teams.each_ref().map(|team| team.listener.local_addr().expect("an address"));
        let clients = thread::spawn(move || {
            let wait = Duration::from_secs(20);
            let mut talks = addresses.map(|address| Connection::open(address, wait).expect("connected"));
            let mut received = Vec::new();
            for step in 0..steps {
                for (talk, length) in talks.iter_mut().zip([0.0, 0.016]) {
                    talk.send(&request(length, step as f32 * 0.01)).expect("sent");
                    let answer: Option<SimulationSyncResponse> = talk.receive(wait).expect("no error");
                    received.extend(answer.expect("an answer").encode_to_vec());
                }
            }
            received
        });
        let (mut lines, mut looked) = (Vec::new(), 0_u64);
        while !clients.is_finished() {
            ports.serve(&mut server, &mut lines, |_, _| looked += 1);
        }
        assert_eq!((server.world().now(), looked), (u64::from(steps) * 16, u64::from(steps) * 16));
        clients.join().expect("the clients' thread")
    }

    #[test]
    fn two_teams_step_the_field_by_tcp_and_the_same_requests_give_the_same_bytes() {
        let first = play(50);
        assert!(first.len() > 10_000, "{}", first.len());
        assert_eq!(first, play(50));
    }
}
