//! `ethernet`: parts of the free-running board on a network: radio frames as UDP datagrams over its Ethernet
//! controller, and a body in a simulator, whose orders and sensor frames are datagrams too.
//!
//! Addresses are those of a page in flash ([`protocol::network_page`]). Radio frames are authenticated as on
//! every link; datagrams of the body are not: a robot with motors of its own has none. What the brain takes
//! in and gives out is written into the board's second memory, if the emulator prepared it
//! ([`protocol::journal`]).

mod driver;
#[path = "../lan9118.rs"]
mod lan9118;
mod ports;
#[path = "../register.rs"]
mod register;

use casebase::CaseBase;
use cortex_m_rt::exception;
use embassy_executor::{SpawnError, Spawner};
use embassy_net::udp::{PacketMetadata, UdpSocket};
use embassy_net::{Config, Ipv4Cidr, Runner, Stack, StackResources, StaticConfigV4};
use protocol::frame::RobotKeys;
use protocol::journal::Writer;
use protocol::network_page::{self, NetworkPage, PAGE_LEN};
use protocol::slot::{JOURNAL_ADDRESS, JOURNAL_LEN, NETWORK_ADDRESS};
use runtime::{BrainConfig, Mailboxes, hardware, tasks};
use static_cell::StaticCell;

use driver::Ethernet;

pub(crate) static BOXES: Mailboxes = Mailboxes::new();

/// Sends no more orders: the simulator's body stands when none come.
pub(crate) fn stop() {
    ports::stop();
}

pub(crate) struct Radio(NetworkPage);

/// Reads the page of the network.
pub(crate) fn open() -> Result<Radio, &'static [u8]> {
    // SAFETY: plain memory of the board above the firmware (build.rs), never written after the start.
    let page = unsafe { core::slice::from_raw_parts(NETWORK_ADDRESS as *const u8, PAGE_LEN) };
    network_page::read(page).map(Radio).ok_or(b"no page of a network; `onetwo firmware run --udp` writes it")
}

pub(crate) fn start(
    spawner: Spawner,
    Radio(page): Radio,
    config: BrainConfig,
    base: CaseBase<'static>,
    keys: RobotKeys,
) -> Result<(), SpawnError> {
    let ethernet = Ethernet::start(config.robot).expect("the machine has a LAN9118: mps2-an386");
    let address = StaticConfigV4 {
        address: Ipv4Cidr::new(page.own, page.prefix),
        gateway: Some(page.gateway),
        dns_servers: heapless::Vec::new(),
    };
    static RESOURCES: StaticCell<StackResources<2>> = StaticCell::new();
    let resources = RESOURCES.init(StackResources::new());
    let seed = u64::from(config.robot.number());
    let (stack, runner) = embassy_net::new(ethernet, Config::ipv4_static(address), resources, seed);
    spawner.spawn(network(runner)?);
    let radio = sockets::radio(stack, page.port);
    let body = sockets::body(stack, page.port.wrapping_add(1));
    spawner.spawn(body_sensors(body, page)?);
    spawner.spawn(senses()?);
    spawner.spawn(orders(body, page)?);
    spawner.spawn(radio_send(radio, page)?);
    spawner.spawn(radio_receive(radio)?);
    spawner.spawn(brain(config, base, keys)?);
    Ok(())
}

/// The two sockets, in fixed memory.
mod sockets {
    use super::{PacketMetadata, Stack, StaticCell, UdpSocket};

    /// Buffers of a socket: `N` datagrams of some 128 bytes.
    struct Room<const N: usize, const LEN: usize> {
        meta: [PacketMetadata; N],
        bytes: [u8; LEN],
    }

    impl<const N: usize, const LEN: usize> Room<N, LEN> {
        const fn new() -> Self {
            Self { meta: [PacketMetadata::EMPTY; N], bytes: [0; LEN] }
        }
    }

    /// Frames of the host: those of two snapshots, their commands, and beacons passed on. Own frames: as
    /// many as the outbox holds.
    pub(super) fn radio(stack: Stack<'static>, port: u16) -> &'static UdpSocket<'static> {
        static RX: StaticCell<Room<32, 4096>> = StaticCell::new();
        static TX: StaticCell<Room<8, 1024>> = StaticCell::new();
        static SOCKET: StaticCell<UdpSocket<'static>> = StaticCell::new();
        SOCKET.init(opened(stack, port, RX.init(Room::new()), TX.init(Room::new())))
    }

    /// One of each direction, and one more while the first is handled.
    pub(super) fn body(stack: Stack<'static>, port: u16) -> &'static UdpSocket<'static> {
        static RX: StaticCell<Room<2, 640>> = StaticCell::new();
        static TX: StaticCell<Room<2, 256>> = StaticCell::new();
        static SOCKET: StaticCell<UdpSocket<'static>> = StaticCell::new();
        SOCKET.init(opened(stack, port, RX.init(Room::new()), TX.init(Room::new())))
    }

    fn opened<const N: usize, const M: usize, const A: usize, const B: usize>(
        stack: Stack<'static>,
        port: u16,
        inward: &'static mut Room<N, A>,
        outward: &'static mut Room<M, B>,
    ) -> UdpSocket<'static> {
        let (rx, tx) = ((&mut inward.meta, &mut inward.bytes), (&mut outward.meta, &mut outward.bytes));
        let mut socket = UdpSocket::new(stack, rx.0, rx.1, tx.0, tx.1);
        // A socket that was just made is closed, and both ports are ours.
        let _bound = socket.bind(port);
        socket
    }
}

/// Only the Ethernet controller's interrupt is enabled.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    driver::interrupt();
}

#[embassy_executor::task]
async fn network(mut runner: Runner<'static, Ethernet>) -> ! {
    runner.run().await
}

#[embassy_executor::task]
async fn brain(config: BrainConfig, base: CaseBase<'static>, keys: RobotKeys) -> ! {
    // SAFETY: plain memory of the board that nothing else uses: build.rs gives the program another one, and
    // this task is started once.
    let memory = unsafe { core::slice::from_raw_parts_mut(JOURNAL_ADDRESS as *mut u8, JOURNAL_LEN) };
    tasks::brain_with_journal(&config, base, keys, &BOXES, Writer::new(memory)).await
}

#[embassy_executor::task]
async fn senses() -> ! {
    tasks::sensors(ports::Senses::new(), &BOXES).await
}

#[embassy_executor::task]
async fn body_sensors(socket: &'static UdpSocket<'static>, page: NetworkPage) -> ! {
    ports::receive_sensors(socket, page.body).await
}

#[embassy_executor::task]
async fn orders(socket: &'static UdpSocket<'static>, page: NetworkPage) -> ! {
    tasks::body(ports::Body { socket, to: page.body }, &BOXES).await
}

#[embassy_executor::task]
async fn radio_send(socket: &'static UdpSocket<'static>, page: NetworkPage) -> ! {
    tasks::radio_send(ports::UdpSender { socket, to: page.radio }, &BOXES).await
}

#[embassy_executor::task]
async fn radio_receive(socket: &'static UdpSocket<'static>) -> ! {
    hardware::radio_receive(ports::UdpReceiver(socket), &BOXES).await
}
