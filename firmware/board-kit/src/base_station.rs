//! `base_station`: a base station on any chip: the host's serial line on one side, a radio chip nRF24L01+ on
//! the other. It holds no keys: it neither believes nor makes a frame.
//!
//! Its team and channel are those of the host's plan, or by the team of its first frame, so that nothing is
//! written into it.

use core::cell::{Cell, RefCell};

use embassy_futures::select::{Either3, select3};
use embassy_sync::blocking_mutex::raw::NoopRawMutex;
use embassy_sync::channel::Channel as Queue;
use embassy_time::{Duration, Instant, Timer};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::spi::SpiDevice;
use embedded_io_async::{Read, Write};
use nrf24::{Base, Channel, Fault, SERVE_EVERY, Station};
use protocol::TeamId;
use protocol::frame::VERSION;
use protocol::serial::{Line, Lines};
use protocol::station::{self, RadioPlan, StationMessage};

use crate::nrf24::{ChipWires, IRQ_POLL_PERIOD, now};
use crate::radio::{UartReceiver, UartSender};

/// Runs until the chip fails: its supply, its wiring, or another chip.
pub async fn run<S: SpiDevice, E: OutputPin, N: InputPin, D: DelayNs>(
    mut from_host: UartReceiver<impl Read>,
    mut to_host: UartSender<impl Write>,
    mut wires: ChipWires<S, E, N, D>,
    mut alive: impl OutputPin,
) -> Fault {
    let channel = first_channel(&mut from_host).await;
    defmt::info!("team {=u8}, channel {=u8}", channel.team.0, channel.megahertz);
    let base = match Base::start(now(), channel, wires.spi, wires.enable, wires.pause) {
        Ok(base) => base,
        Err(fault) => return fault,
    };
    let station = RefCell::new(Station::new(base));
    let has_work = Cell::new(false);
    let lines: Queue<NoopRawMutex, Line, LINE_QUEUE_LEN> = Queue::new();
    let take = async {
        loop {
            let bytes = from_host.bytes().await;
            station.borrow_mut().push(now(), bytes);
            has_work.set(true);
        }
    };
    let give = async {
        loop {
            to_host.send_bytes(&lines.receive().await).await;
        }
    };
    let serve = async {
        let mut served = Instant::now();
        let mut blink = served;
        let mut is_lit = false;
        loop {
            let is_quiet = served.elapsed() < Duration::from_micros(SERVE_EVERY.0);
            if has_work.take() || !is_quiet || wires.irq.is_low().unwrap_or(true) {
                served = Instant::now();
                let line = station.borrow_mut().poll(now());
                match line {
                    Ok(Some(line)) => {
                        // A line that does not keep up loses a robot's frame, and the next one says more.
                        let _ = lines.try_send(line);
                        has_work.set(true);
                    }
                    Ok(None) => {}
                    Err(fault) => break fault,
                }
            }
            if blink.elapsed() >= BLINK_HALF_PERIOD {
                blink = Instant::now();
                is_lit = !is_lit;
                let _ = alive.set_state(is_lit.into());
                let counts = station.borrow().counts();
                defmt::debug!(
                    "sent {=u32}, unacknowledged {=u32}, late {=u32}",
                    counts.sent,
                    counts.unacknowledged,
                    counts.late
                );
            }
            Timer::after(IRQ_POLL_PERIOD).await;
        }
    };
    // Only the chip's part ends.
    match select3(take, give, serve).await {
        Either3::First(fault) | Either3::Second(fault) | Either3::Third(fault) => fault,
    }
}

/// The channel of the host's first plan, or by default that of the team of its first frame. For a scan,
/// which the host asks for again, any will do.
async fn first_channel(from_host: &mut UartReceiver<impl Read>) -> Channel {
    let mut lines = Lines::new();
    loop {
        for byte in from_host.bytes().await {
            let Some(frame) = lines.push(*byte) else { continue };
            match (station::read(&frame), &frame[..]) {
                (Some(StationMessage::Plan(team, plan)), _) => return Channel::of(team, plan),
                (Some(StationMessage::Scan(_)), _) => {
                    return Channel::of(TeamId(0), RadioPlan::of_team(TeamId(0)));
                }
                (None, [VERSION, team, _, ..]) => {
                    return Channel::of(TeamId(*team), RadioPlan::of_team(TeamId(*team)));
                }
                _ => {}
            }
        }
    }
}

/// Robots' frames that wait for the line: a beacon of each robot of the largest team.
const LINE_QUEUE_LEN: usize = 12;
/// Half of the lamp's period of a second.
const BLINK_HALF_PERIOD: Duration = Duration::from_millis(500);
