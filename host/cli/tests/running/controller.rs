//! `controller`: a scripted game controller for tests: it sends the referee's packet until it is dropped.

use std::net::UdpSocket;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use ssl::Message as _;
use ssl::referee::{Command, Referee, Stage, TeamInfo};

/// Sends the packet of the script about a hundred times a second, until it is dropped.
pub(crate) struct Controller {
    packet: Arc<Mutex<Option<Referee>>>,
}

impl Controller {
    pub(crate) fn new(to: &str) -> Self {
        let team =
            || TeamInfo { max_allowed_bots: Some(6), can_place_ball: Some(true), ..TeamInfo::default() };
        let packet = Referee {
            stage: Stage::NormalFirstHalf as i32,
            command: Command::Halt as i32,
            yellow: team(),
            blue: team(),
            blue_team_on_positive_half: Some(false),
            source_identifier: Some("scripted".into()),
            ..Referee::default()
        };
        let packet = Arc::new(Mutex::new(Some(packet)));
        let (printed, to) = (packet.clone(), to.to_owned());
        let (socket, began) = (UdpSocket::bind("127.0.0.1:0").expect("a port"), Instant::now());
        thread::spawn(move || {
            while let Some(packet) = &mut *printed.lock().expect("the script") {
                packet.packet_timestamp = 1_000_000 + began.elapsed().as_micros() as u64;
                // The receiver may not be open yet.
                let _ = socket.send_to(&packet.encode_to_vec(), &to);
                thread::sleep(Duration::from_millis(10));
            }
        });
        Self { packet }
    }

    /// Changes the packet; the next one is a new command.
    pub(crate) fn wait_for(&self, change: impl FnOnce(&mut Referee)) {
        let mut packet = self.packet.lock().expect("the script");
        let packet = packet.as_mut().expect("still running");
        change(packet);
        packet.command_counter += 1;
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        *self.packet.lock().expect("the script") = None;
    }
}
