//! `chip`: what both ends set in the chip, and its errors. Addresses: low byte first.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorKind as PinError, OutputPin};
use embedded_hal::spi::{ErrorKind as SpiError, SpiDevice};
use protocol::frame::VERSION;
use protocol::station::RadioPlan;
use protocol::{Duration, RobotId, TeamId};
use rf24::radio::prelude::{
    EsbAutoAck, EsbChannel, EsbDataRate, EsbFifo, EsbInit, EsbPayloadLength, EsbPipe, EsbRadio, EsbStatus,
};
use rf24::radio::{Nrf24Error, RF24, RadioConfig};
use rf24::{DataRate, StatusFlags};

use crate::fragment::{PAYLOAD_MAX, Payload};
use crate::settings::Settings;

/// Bits a second on the air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// 1 Mbit/s, −85 dBm at the receiver.
    Mbps1,
    /// 2 Mbit/s, −82 dBm at the receiver.
    Mbps2,
}

impl Rate {
    /// Time of a bit, ns.
    pub const fn bit_time(self) -> u64 {
        match self {
            Self::Mbps1 => 1_000,
            Self::Mbps2 => 500,
        }
    }
}

/// A team's place on the air: its base station and all its robots are set to the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The team's number on the radio.
    pub team: TeamId,
    /// Frequency, MHz above 2,400: 0 to 125. Two teams in range of each other need two, 2 apart at 2 Mbit/s
    /// (PS 6.3).
    pub megahertz: u8,
    /// Rate on the air.
    pub rate: Rate,
    /// Upper bytes of all addresses, so that teams of one number do not take each other for their own.
    pub address: u16,
}

impl Channel {
    /// A team's place by its plan.
    pub const fn of(team: TeamId, plan: RadioPlan) -> Self {
        let rate = if plan.megabits == 1 { Rate::Mbps1 } else { Rate::Mbps2 };
        Self { team, megahertz: plan.channel, rate, address: plan.address }
    }

    /// The plan that leads to it.
    pub const fn plan(self) -> RadioPlan {
        let megabits = match self.rate {
            Rate::Mbps1 => 1,
            Rate::Mbps2 => 2,
        };
        RadioPlan { channel: self.megahertz, megabits, address: self.address }
    }

    /// The address of one robot.
    pub(crate) const fn robot(self, robot: RobotId) -> [u8; 5] {
        self.address(0x20 | robot.number())
    }

    /// The address of all robots.
    pub(crate) const fn everyone(self) -> [u8; 5] {
        self.address(0x71)
    }

    /// Team and version are part of the address, so that no fragment of another one is ever joined.
    const fn address(self, low: u8) -> [u8; 5] {
        let [lower, upper] = self.address.to_le_bytes();
        [low, self.team.0, VERSION, lower, upper]
    }
}

/// Reason why a radio does not work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// A transfer on the SPI bus failed.
    #[error("SPI to the radio chip: {0}")]
    Spi(SpiError),
    /// The line CE cannot be set.
    #[error("line CE of the radio chip: {0}")]
    Pin(PinError),
    /// The chip does not hold its settings, or does not answer: supply, wiring, or another chip.
    #[error("the radio chip answers wrongly; check its supply and wiring")]
    Answer,
}

impl From<Nrf24Error<SpiError, PinError>> for Fault {
    fn from(error: Nrf24Error<SpiError, PinError>) -> Self {
        match error {
            Nrf24Error::Spi(error) => Self::Spi(error),
            Nrf24Error::Gpo(error) => Self::Pin(error),
            Nrf24Error::BinaryCorruption | Nrf24Error::NotAsTxError => Self::Answer,
        }
    }
}

/// A chip with its lines.
pub(crate) struct Lines<S, C, D> {
    pub(crate) radio: RF24<Settings<S>, C, D>,
}

impl<S: SpiDevice, C: OutputPin, D: DelayNs> Lines<S, C, D> {
    pub(crate) fn new(spi: S, chip_enable: C, pause: D) -> Self {
        Self { radio: RF24::new(chip_enable, Settings::new(spi), pause) }
    }

    /// Sets the chip up as after power on: 16 bits of check sum, payloads of any length, acknowledgements
    /// that carry payloads, packets that ask for none.
    pub(crate) fn start(&mut self, channel: Channel) -> Result<(), Fault> {
        self.radio.init()?;
        let config = RadioConfig::default()
            .with_channel(channel.megahertz.min(125))
            .with_crc_length(rf24::CrcLength::Bit16)
            .with_dynamic_payloads(true)
            .with_ack_payloads(true)
            .with_ask_no_ack(true)
            .with_auto_retries(REPEAT_DELAY, 0)
            .with_payload_length(PAYLOAD_MAX as u8);
        self.radio.with_config(&config)?;
        // `with_config` of rf24-rs 0.3.1 drops the bit of 2 Mbit/s; this call does not, and the answer is
        // read.
        self.set_rate(channel.rate)?;
        if !self.is_set()? {
            return Err(Fault::Answer);
        }
        Ok(())
    }

    fn set_rate(&mut self, rate: Rate) -> Result<(), Fault> {
        let rate = match rate {
            Rate::Mbps1 => DataRate::Mbps1,
            Rate::Mbps2 => DataRate::Mbps2,
        };
        self.radio.set_data_rate(rate)?;
        // It never waits for an acknowledgement of its own to end: no chip here changes its end.
        self.radio.tx_delay = 0;
        if self.radio.get_data_rate()? == rate { Ok(()) } else { Err(Fault::Answer) }
    }

    /// Listens elsewhere from now on; what waits to be sent is dropped.
    pub(crate) fn listen_on(&mut self, megahertz: u8, rate: Rate) -> Result<(), Fault> {
        self.radio.as_tx(None)?;
        self.radio.set_channel(megahertz)?;
        self.set_rate(rate)?;
        self.listen()
    }

    /// Whether there was power above -64 dBm since the chip listens (PS 6.4).
    pub(crate) fn has_power(&mut self) -> Result<bool, Fault> {
        Ok(self.radio.rpd()?)
    }

    /// Repeats of the packet that was sent last.
    pub(crate) fn repeats(&mut self) -> Result<u8, Fault> {
        Ok(self.radio.get_last_arc()?)
    }

    /// Returns whether the chip still has every setting: after a dip of its supply it has none, after an
    /// upset it lacks one. All registers are read for it ([`Settings`]).
    pub(crate) fn is_set(&mut self) -> Result<bool, Fault> {
        Ok(self.radio.get_payload_length()? == PAYLOAD_MAX as u8)
    }

    /// Opens a pipe for receiving.
    pub(crate) fn open(&mut self, pipe: u8, address: [u8; 5]) -> Result<(), Fault> {
        Ok(self.radio.open_rx_pipe(pipe, &address)?)
    }

    /// Listens from now on.
    pub(crate) fn listen(&mut self) -> Result<(), Fault> {
        Ok(self.radio.as_rx()?)
    }

    /// The chip's events now.
    pub(crate) fn events(&mut self) -> Result<StatusFlags, Fault> {
        self.radio.update()?;
        let mut flags = StatusFlags::default();
        self.radio.get_status_flags(&mut flags);
        Ok(flags)
    }

    /// The oldest payload received, with its pipe.
    pub(crate) fn receive(&mut self) -> Result<Option<(u8, Payload)>, Fault> {
        let mut pipe = 0;
        if !self.radio.available_pipe(&mut pipe)? {
            return Ok(None);
        }
        let mut payload = Payload::new();
        let _room = payload.resize_default(PAYLOAD_MAX);
        match self.radio.read(&mut payload, None) {
            Ok(len) => payload.truncate(usize::from(len)),
            // A length above 32: PS 8.3.1 asks to flush.
            Err(Nrf24Error::BinaryCorruption) => {
                self.radio.flush_rx()?;
                payload.clear();
            }
            Err(error) => return Err(error.into()),
        }
        // No payload is empty: a chip without its supply seems to have one always.
        Ok((!payload.is_empty()).then_some((pipe, payload)))
    }

    /// Sets the number of repetitions of a packet without acknowledgement.
    pub(crate) fn repeat(&mut self, count: u8) -> Result<(), Fault> {
        Ok(self.radio.set_auto_retries(REPEAT_DELAY, count)?)
    }
}

/// 500 µs from the end of a packet to its repeat: long enough for an acknowledgement of 32 bytes at 1 and at
/// 2 Mbit/s (PS 9.1, SETUP_RETR), in steps of 250 µs, less one.
const REPEAT_DELAY: u8 = 1;
/// Period in which the chip's registers are read back: 56 bytes on the bus, 0.1 ms at 8 MHz, and nothing on
/// the air. A quarter of the longest silence that an upset may cost, 100 ms.
pub(crate) const CHECK_EVERY: Duration = Duration::millis(25);
