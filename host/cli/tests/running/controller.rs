//! `controller`: a scripted game controller for tests: it sends the referee's packet until it is dropped.

use std::net::UdpSocket;
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use ssl::Message as _;
use ssl::referee::{Command, Referee, Stage, TeamInfo};

/// Sends the packet of the script about a hundred times a second, until it is dropped.
pub(crate) struct Controller {
    script: Arc<Script>,
}

/// The packet that is sent, and how often it was sent as it is; no packet at the end.
#[derive(Default)]
struct Script {
    packet: Mutex<(Option<Referee>, u32)>,
    sent: Condvar,
}

impl Script {
    /// The packet at this time since the start, counted as sent; none at the end.
    fn next(&self, time: Duration) -> Option<Vec<u8>> {
        let mut script = self.packet.lock().expect("the script");
        let packet = script.0.as_mut()?;
        packet.packet_timestamp = 1_000_000 + time.as_micros() as u64;
        let bytes = packet.encode_to_vec();
        script.1 += 1;
        self.sent.notify_all();
        Some(bytes)
    }
}

/// A packet was sent as often as this before the next one replaces it: none is lost on the way to a busy
/// receiver.
const REPEATS: u32 = 30;

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
        let script = Arc::new(Script { packet: Mutex::new((Some(packet), 0)), ..Script::default() });
        let (sender, to) = (script.clone(), to.to_owned());
        let (socket, began) = (UdpSocket::bind("127.0.0.1:0").expect("a port"), Instant::now());
        thread::spawn(move || {
            while let Some(bytes) = sender.next(began.elapsed()) {
                // The receiver may not be open yet.
                let _ = socket.send_to(&bytes, &to);
                thread::sleep(Duration::from_millis(10));
            }
        });
        Self { script }
    }

    /// Changes the packet, which is a new command then, and waits until it was sent [`REPEATS`] times.
    pub(crate) fn send(&self, change: impl FnOnce(&mut Referee)) {
        let mut script = self.script.packet.lock().expect("the script");
        let packet = script.0.as_mut().expect("still running");
        change(packet);
        packet.command_counter += 1;
        script.1 = 0;
        let _sent =
            self.script.sent.wait_while(script, |(_, repeats)| *repeats < REPEATS).expect("the script");
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        self.script.packet.lock().expect("the script").0 = None;
    }
}
