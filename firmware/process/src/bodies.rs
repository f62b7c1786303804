//! `bodies`: bodies in a simulator for robots whose brains are elsewhere, as firmware images: orders come as
//! datagrams, sensor frames go back, the league's simulation protocol moves the bodies.
//!
//! A datagram is postcard of `protocol::robot_io`'s `ActuatorFrame` or `SensorFrame`. They are not
//! authenticated: the sockets are this machine's own.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as Clock};

use prost::Message as _;
use protocol::robot_io::ActuatorFrame;
use protocol::{Duration as Span, Instant, RobotId};
use ssl::simulation::RobotControlResponse;

use crate::body::{SimulatedBody, TICK};

/// A brain that gives no orders for this long has stopped: its body stands.
const ORDERS_HOLD: Span = Span::millis(100);
/// The thread looks for datagrams this often.
const POLL_PERIOD: Duration = Duration::from_millis(1);
/// The longest datagram that is read: the league's programs send no longer ones.
const LEN_MAX: usize = 8192;

/// One body between its brain's socket and the simulator, without sockets.
#[derive(Debug)]
struct Bridge {
    body: SimulatedBody,
    ordered: Option<Instant>,
}

impl Bridge {
    fn new(id: RobotId) -> Self {
        Self { body: SimulatedBody::new(id), ordered: None }
    }

    /// Handles orders; anything else is dropped.
    fn handle_orders(&mut self, now: Instant, bytes: &[u8]) {
        if let Ok((order, [])) = postcard::take_from_bytes(bytes) {
            self.body.obey(order);
            self.ordered = Some(now);
        }
    }

    /// A step: the command for the simulator, and the sensor frame for the brain.
    fn step(&mut self, now: Instant) -> (Vec<u8>, Option<Vec<u8>>) {
        if self.ordered.is_some_and(|at| now.since(at) > ORDERS_HOLD) {
            self.ordered = None;
            self.body.obey(ActuatorFrame::Released);
        }
        let mut bytes = [0; SENSORS_LEN_MAX];
        let sensors =
            postcard::to_slice(&self.body.sensors(now), &mut bytes).ok().map(|bytes| bytes.to_vec());
        (self.body.control().encode_to_vec(), sensors)
    }
}

/// Bytes of the longest sensor frame.
const SENSORS_LEN_MAX: usize = 320;

/// A thread for the bodies of several robots; it ends when this is dropped.
#[derive(Debug)]
pub struct Bodies {
    addresses: Vec<(RobotId, SocketAddr)>,
    end: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Bodies {
    /// Bodies of these robots in the simulator that takes their team's commands at that address.
    pub fn open(robots: &[RobotId], simulator: SocketAddr) -> io::Result<Self> {
        let any: SocketAddr = match simulator {
            SocketAddr::V4(v4) if v4.ip().is_loopback() => ([127, 0, 0, 1], 0).into(),
            SocketAddr::V4(_) => ([0, 0, 0, 0], 0).into(),
            SocketAddr::V6(_) => ([0_u16; 8], 0).into(),
        };
        // One socket for all: some simulators answer only who spoke last.
        let outer = UdpSocket::bind(any)?;
        outer.set_nonblocking(true)?;
        let (mut inner, mut addresses) = (Vec::new(), Vec::new());
        for id in robots {
            let socket = UdpSocket::bind("127.0.0.1:0")?;
            socket.set_nonblocking(true)?;
            addresses.push((*id, socket.local_addr()?));
            inner.push(Seat { bridge: Bridge::new(*id), socket, brain: None });
        }
        let end = Arc::new(AtomicBool::new(false));
        let until = end.clone();
        let work = move || run(&outer, simulator, &mut inner, &until);
        let thread = thread::Builder::new().name("bodies".to_owned()).spawn(work)?;
        Ok(Self { addresses, end, thread: Some(thread) })
    }

    /// Addresses to which the robots' brains send their orders.
    pub fn addresses(&self) -> &[(RobotId, SocketAddr)] {
        &self.addresses
    }
}

impl Drop for Bodies {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Seat {
    bridge: Bridge,
    socket: UdpSocket,
    brain: Option<SocketAddr>,
}

fn run(outer: &UdpSocket, simulator: SocketAddr, seats: &mut [Seat], end: &AtomicBool) {
    let start = Clock::now();
    let now = || Instant(start.elapsed().as_micros() as u64);
    let mut bytes = [0; LEN_MAX];
    let mut due = now();
    while !end.load(Ordering::Relaxed) {
        while let Ok((len, from)) = outer.recv_from(&mut bytes) {
            let response = RobotControlResponse::decode(bytes.get(..len).unwrap_or(&[]));
            // Another sender, or another message: not ours.
            if let (Ok(response), true) = (response, from.port() == simulator.port()) {
                for seat in seats.iter_mut() {
                    seat.bridge.body.handle_response(now(), &response);
                }
            }
        }
        for seat in seats.iter_mut() {
            while let Ok((len, from)) = seat.socket.recv_from(&mut bytes) {
                seat.brain = Some(from);
                seat.bridge.handle_orders(now(), bytes.get(..len).unwrap_or(&[]));
            }
        }
        if now() >= due {
            for seat in seats.iter_mut() {
                // Without a brain there is no robot to command.
                let Some(brain) = seat.brain else { continue };
                let (control, sensors) = seat.bridge.step(now());
                let _ = outer.send_to(&control, simulator);
                let _ = sensors.map(|sensors| seat.socket.send_to(&sensors, brain));
            }
            // A delayed thread does not catch up: missed steps are skipped.
            due = if now().since(due) < TICK { due + TICK } else { now() + TICK };
        }
        thread::sleep(POLL_PERIOD);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::robot_io::{OmniKick, SensorFrame};
    use ssl::simulation::{MoveCommand, RobotControl, RobotFeedback, RobotMoveCommand};

    fn orders(rim: f32) -> Vec<u8> {
        let order = ActuatorFrame::Omni { wheels: [rim; 4], dribbler: 0.5, kick: OmniKick::Flat(3.0) };
        let mut bytes = [0; 64];
        postcard::to_slice(&order, &mut bytes).unwrap().to_vec()
    }

    /// Turning rate and kick of a command.
    fn commanded(bytes: &[u8]) -> (f32, Option<f32>) {
        let control = RobotControl::decode(bytes).unwrap();
        let command = &control.robot_commands[0];
        let Some(RobotMoveCommand { command: Some(MoveCommand::LocalVelocity(motion)) }) =
            &command.move_command
        else {
            panic!("{control:?}")
        };
        (motion.angular, command.kick_speed)
    }

    #[test]
    fn orders_move_the_body_until_none_came_for_a_tenth_of_a_second() {
        let mut bridge = Bridge::new(RobotId::new(4).unwrap());
        bridge.handle_orders(Instant(0), &orders(0.4));
        let (angular, kick) = commanded(&bridge.step(Instant(100_000)).0);
        assert!(angular > 1.0 && kick == Some(3.0), "{angular} {kick:?}");
        assert_eq!(commanded(&bridge.step(Instant(100_001)).0), (0.0, None));
        // What is no order changes nothing.
        bridge.handle_orders(Instant(100_002), &[0xff; 40]);
        assert_eq!(commanded(&bridge.step(Instant(100_003)).0), (0.0, None));
    }

    #[test]
    fn a_brain_gets_its_sensor_frame_and_the_simulator_its_command_over_sockets() {
        let simulator = UdpSocket::bind("127.0.0.1:0").unwrap();
        let brain = UdpSocket::bind("127.0.0.1:0").unwrap();
        for socket in [&simulator, &brain] {
            socket.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        }
        let id = RobotId::new(4).unwrap();
        let bodies = Bodies::open(&[id], simulator.local_addr().unwrap()).unwrap();
        let [(robot, address)] = *bodies.addresses() else { panic!("one robot") };
        assert_eq!(robot, id);
        let mut bytes = [0; 512];
        let mut contact = false;
        for _ in 0..200 {
            brain.send_to(&orders(0.4), address).unwrap();
            let (len, from) = simulator.recv_from(&mut bytes).unwrap();
            assert_eq!(RobotControl::decode(&bytes[..len]).unwrap().robot_commands[0].id, 4);
            let feedback = RobotFeedback { id: 4, dribbler_ball_contact: Some(true), ..Default::default() };
            let response = RobotControlResponse { errors: vec![], feedback: vec![feedback] };
            simulator.send_to(&response.encode_to_vec(), from).unwrap();
            let (len, _) = brain.recv_from(&mut bytes).unwrap();
            let sensors: SensorFrame = postcard::from_bytes(&bytes[..len]).unwrap();
            contact |= sensors.ball_contact;
            if contact {
                break;
            }
        }
        assert!(contact, "the simulator's report of the ball does not arrive");
    }
}
