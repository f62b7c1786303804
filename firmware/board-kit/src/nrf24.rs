//! `nrf24`: a radio chip nRF24L01+ on any chip's SPI: a robot's radio, and a base station between the host's
//! serial line and the air. Registers and protocol are those of the crate `nrf24`.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel as Queue;
use embassy_time::{Duration, Instant, Timer};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::spi::SpiDevice;
use nrf24::{Channel, Fault, Robot, SERVE_EVERY};
use protocol::link::Packet;
use protocol::station::RadioPlan;
use runtime::ports::{RadioReceiver, RadioSender};

use crate::robot::Identity;

/// The time by embassy's clock.
pub fn now() -> protocol::Instant {
    protocol::Instant(Instant::now().as_micros())
}

/// Wires of a chip, besides its supply.
#[derive(Debug)]
pub struct ChipWires<S, E, N, D> {
    /// SPI bus with the chip's own select.
    pub spi: S,
    /// CE: high while the radio listens or sends.
    pub enable: E,
    /// IRQ, low when there is something to do.
    pub irq: N,
    /// Timer for pauses of microseconds.
    pub pause: D,
}

/// Frames that wait for the chip.
static OUTGOING: Queue<CriticalSectionRawMutex, Packet, 4> = Queue::new();

/// A robot's radio: serves the chip, and receives.
#[allow(missing_debug_implementations, reason = "the chip's driver has none")]
pub struct ChipReceiver<S, E, N, D> {
    robot: Robot<S, E, D>,
    irq: N,
    served: Instant,
}

/// A robot's radio: sends.
#[derive(Debug)]
pub struct ChipSender(());

/// Both directions of a robot's radio.
pub type ChipRadio<S, E, N, D> = (ChipSender, ChipReceiver<S, E, N, D>);

/// Both directions of a robot's radio. It starts on its team's default channel, with the address of its
/// team's key, and searches for its base station. Call once.
pub fn robot<S: SpiDevice, E: OutputPin, N: InputPin, D: DelayNs>(
    who: &Identity,
    wires: ChipWires<S, E, N, D>,
) -> Result<ChipRadio<S, E, N, D>, Fault> {
    let (team, address) = (who.config.team, who.keys.team.radio_address());
    let channel = Channel::of(team, RadioPlan { address, ..RadioPlan::of_team(team) });
    let robot = Robot::start(now(), channel, who.config.robot, wires.spi, wires.enable, wires.pause)?;
    Ok((ChipSender(()), ChipReceiver { robot, irq: wires.irq, served: Instant::now() }))
}

impl RadioSender for ChipSender {
    async fn send(&mut self, packet: Packet) {
        OUTGOING.send(packet).await;
    }
}

impl<S: SpiDevice, E: OutputPin, N: InputPin, D: DelayNs> RadioReceiver for ChipReceiver<S, E, N, D> {
    async fn receive(&mut self) -> Packet {
        loop {
            let mut is_due = is_due(&mut self.irq, self.served);
            while let Ok(packet) = OUTGOING.try_receive() {
                // No frame, or no room: counted there, and a newer one follows.
                let _ = self.robot.send(now(), &packet);
                is_due = true;
            }
            if is_due {
                self.served = Instant::now();
                match self.robot.poll(now()) {
                    Ok(Some(packet)) => return packet,
                    Ok(None) => {}
                    // The chip's supply dipped, or a wire is loose: its next turn starts it again.
                    Err(_) => Timer::after(FAULT_PAUSE).await,
                }
            }
            Timer::after(IRQ_POLL_PERIOD).await;
        }
    }

    fn faults(&self) -> u32 {
        self.robot.counts().restarts
    }
}

/// Tells whether the chip has to be served. A line that cannot be read counts as low.
fn is_due(irq: &mut impl InputPin, served: Instant) -> bool {
    irq.is_low().unwrap_or(true) || served.elapsed() >= Duration::from_micros(SERVE_EVERY.0)
}

/// Period in which the wire IRQ is read: a fifth of the shortest exchange at 2 Mbit/s.
pub const IRQ_POLL_PERIOD: Duration = Duration::from_micros(100);
/// Pause after a fault before the chip is served again.
pub const FAULT_PAUSE: Duration = Duration::from_millis(10);
