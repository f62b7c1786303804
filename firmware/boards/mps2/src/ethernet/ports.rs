//! `ports`: radio, orders and sensor frames as UDP datagrams: a radio frame, or postcard of
//! [`ActuatorFrame`] or [`SensorFrame`], in each.

use core::cell::RefCell;
use core::net::SocketAddrV4;
use core::sync::atomic::{AtomicBool, Ordering};

use critical_section::Mutex;
use embassy_net::udp::UdpSocket;
use embassy_time::{Duration, Instant, Ticker};
use protocol::frame::FRAME_LEN_MAX;
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame, WHEELED_STEP};
use runtime::ports::{BodyPort, RadioReceiver, RadioSender, Senses as SensesPort};
use runtime::progress::RobotPart;

use super::BOXES;

/// Receiver of frames, from any address: their tags authenticate them.
pub(crate) struct UdpReceiver(pub(crate) &'static UdpSocket<'static>);

impl RadioReceiver for UdpReceiver {
    async fn receive(&mut self) -> Packet {
        loop {
            let mut bytes = [0; FRAME_LEN_MAX];
            // A longer datagram is no frame.
            if let Ok((len, _)) = self.0.recv_from(&mut bytes).await
                && let Ok(packet) = Packet::from_slice(bytes.get(..len).unwrap_or_default())
            {
                return packet;
            }
        }
    }
}

pub(crate) struct UdpSender {
    pub(crate) socket: &'static UdpSocket<'static>,
    pub(crate) to: SocketAddrV4,
}

impl RadioSender for UdpSender {
    async fn send(&mut self, packet: Packet) {
        // Without a route it is lost, as on any air.
        let _ = self.socket.send_to(&packet, self.to).await;
    }
}

pub(crate) struct Body {
    pub(crate) socket: &'static UdpSocket<'static>,
    pub(crate) to: SocketAddrV4,
}

impl BodyPort for Body {
    async fn act(&mut self, wanted: ActuatorFrame) {
        let mut bytes = [0; ORDER_LEN_MAX];
        if let Ok(order) = postcard::to_slice(&wanted, &mut bytes)
            && !STOPPED.load(Ordering::Relaxed)
        {
            let _ = self.socket.send_to(order, self.to).await;
        }
        BOXES.mark(RobotPart::Control);
    }
}

/// Sends no more orders.
pub(crate) fn stop() {
    STOPPED.store(true, Ordering::Relaxed);
}

static STOPPED: AtomicBool = AtomicBool::new(false);

/// The last sensor frame that the body sent, and when it came.
static SEEN: Mutex<RefCell<Option<(Instant, SensorFrame)>>> = Mutex::new(RefCell::new(None));

/// Keeps the sensor frames that come from the body's address.
pub(crate) async fn receive_sensors(socket: &'static UdpSocket<'static>, body: SocketAddrV4) -> ! {
    loop {
        let mut bytes = [0; SENSORS_LEN_MAX];
        let Ok((len, meta)) = socket.recv_from(&mut bytes).await else { continue };
        let is_body = meta.endpoint == embassy_net::IpEndpoint::from(body);
        if let Ok((snapshot, [])) = postcard::take_from_bytes(bytes.get(..len).unwrap_or_default())
            && is_body
        {
            critical_section::with(|cs| *SEEN.borrow_ref_mut(cs) = Some((Instant::now(), snapshot)));
        }
    }
}

/// A sensor frame every step, by the robot's own clock.
pub(crate) struct Senses(Ticker);

impl Senses {
    pub(crate) fn new() -> Self {
        Self(Ticker::every(Duration::from_micros(WHEELED_STEP.0)))
    }
}

impl SensesPort for Senses {
    async fn sense(&mut self) -> SensorFrame {
        self.0.next().await;
        let now = Instant::now();
        let last = critical_section::with(|cs| SEEN.borrow_ref(cs).clone());
        let fresh = last.filter(|(at, _)| now.duration_since(*at) <= SENSOR_FRAME_AGE_MAX);
        // A robot whose body is silent stands, and has neither ball nor kicker.
        fresh.map(|(_, snapshot)| snapshot).unwrap_or_default()
    }
}

/// Longest validity of a sensor frame: five of the body's steps.
const SENSOR_FRAME_AGE_MAX: Duration = Duration::from_millis(50);
/// Bytes of the longest orders: a tag, five floats, and a kick with its speed.
const ORDER_LEN_MAX: usize = 32;
/// Bytes of the longest sensor frame, of the datagrams that are read.
const SENSORS_LEN_MAX: usize = 320;
