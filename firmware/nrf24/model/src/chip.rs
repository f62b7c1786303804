//! `chip`: registers, FIFOs and SPI commands of one chip (PS 8.3, 9.1). What it does on the air is in `air`.

use std::collections::VecDeque;

pub(crate) const CONFIG: u8 = 0x00;
pub(crate) const EN_AA: u8 = 0x01;
pub(crate) const EN_RXADDR: u8 = 0x02;
pub(crate) const SETUP_RETR: u8 = 0x04;
pub(crate) const RF_CH: u8 = 0x05;
pub(crate) const RF_SETUP: u8 = 0x06;
pub(crate) const STATUS: u8 = 0x07;
pub(crate) const OBSERVE_TX: u8 = 0x08;
pub(crate) const RX_ADDR_P0: u8 = 0x0a;
pub(crate) const RX_ADDR_P1: u8 = 0x0b;
pub(crate) const TX_ADDR: u8 = 0x10;
pub(crate) const RX_PW_P0: u8 = 0x11;
pub(crate) const FIFO_STATUS: u8 = 0x17;
pub(crate) const DYNPD: u8 = 0x1c;
pub(crate) const FEATURE: u8 = 0x1d;

pub(crate) const RX_DR: u8 = 0x40;
pub(crate) const TX_DS: u8 = 0x20;
pub(crate) const MAX_RT: u8 = 0x10;
const EVENTS: u8 = RX_DR | TX_DS | MAX_RT;
pub(crate) const PWR_UP: u8 = 0x02;
pub(crate) const PRIM_RX: u8 = 0x01;
const EN_DPL: u8 = 0x04;
const EN_ACK_PAY: u8 = 0x02;
const EN_DYN_ACK: u8 = 0x01;

/// Payloads in each FIFO (PS 8.4).
pub(crate) const FIFO: usize = 3;
const PAYLOAD_MAX: usize = 32;

/// A payload in the FIFO for sending.
#[derive(Clone, Debug)]
pub(crate) struct ToSend {
    pub(crate) payload: Vec<u8>,
    /// The pipe whose acknowledgement carries it; `None` for a packet.
    pub(crate) pipe: Option<u8>,
    pub(crate) no_ack: bool,
    /// It has been on the air at least once.
    pub(crate) sent: bool,
}

/// What the chip is doing on the air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Power down or standby.
    Idle,
    /// Settles before a packet.
    Settling { until: u64 },
    /// Sends a packet, as its first end.
    Sending { until: u64 },
    /// Listens for the acknowledgement from `since`; sends again at `until`.
    Awaiting { since: u64, until: u64 },
    /// Listens, as its second end.
    Listening { since: u64 },
    /// Settles before an acknowledgement of this pipe.
    Turning { until: u64, pipe: u8 },
    /// Sends an acknowledgement.
    Acknowledging { until: u64 },
}

#[derive(Debug)]
pub(crate) struct Registers {
    /// Single bytes; addresses apart.
    bytes: [u8; 0x20],
    addresses: [[u8; 5]; 3],
    pub(crate) to_send: VecDeque<ToSend>,
    pub(crate) received: VecDeque<(u8, Vec<u8>)>,
    pub(crate) enabled: bool,
    pub(crate) has_supply: bool,
    pub(crate) spent: u64,
    pub(crate) mode: Mode,
    pub(crate) packet: u8,
    pub(crate) repeats: u8,
    /// Identity and check sum of the last packet of each pipe (PS 7.3.3.2).
    pub(crate) last: [Option<(u8, u16)>; 6],
}

/// An SPI transaction under way.
#[derive(Debug, Default)]
pub(crate) struct Exchange {
    command: Option<u8>,
    bytes: Vec<u8>,
    answer: Vec<u8>,
}

impl Registers {
    /// After power on (PS 9.1: reset values).
    pub(crate) fn new() -> Self {
        let mut bytes = [0; 0x20];
        for (register, value) in [
            (CONFIG, 0x08),
            (EN_AA, 0x3f),
            (EN_RXADDR, 0x03),
            (0x03, 0x03),
            (SETUP_RETR, 0x03),
            (RF_CH, 0x02),
            (RF_SETUP, 0x0e),
            (0x0c, 0xc3),
            (0x0d, 0xc4),
            (0x0e, 0xc5),
            (0x0f, 0xc6),
        ] {
            bytes[usize::from(register)] = value;
        }
        Self {
            bytes,
            addresses: [[0xe7; 5], [0xc2; 5], [0xe7; 5]],
            to_send: VecDeque::new(),
            received: VecDeque::new(),
            enabled: false,
            has_supply: true,
            spent: 0,
            mode: Mode::Idle,
            packet: 0,
            repeats: 0,
            last: [None; 6],
        }
    }

    pub(crate) fn register(&self, register: u8) -> u8 {
        match register {
            STATUS => self.status(),
            FIFO_STATUS => {
                let flags = |len: usize| u8::from(len == 0) | u8::from(len == FIFO) << 1;
                flags(self.received.len()) | flags(self.to_send.len()) << 4
            }
            RX_ADDR_P0 => self.addresses[0][0],
            RX_ADDR_P1 => self.addresses[1][0],
            TX_ADDR => self.addresses[2][0],
            _ => self.bytes[usize::from(register & 0x1f)],
        }
    }

    fn status(&self) -> u8 {
        let pipe = self.received.front().map_or(7, |(pipe, _)| *pipe);
        let full = u8::from(self.to_send.len() == FIFO);
        self.bytes[usize::from(STATUS)] & EVENTS | pipe << 1 | full
    }

    /// Sets the register RPD.
    pub(crate) fn set_power(&mut self, is_there: bool) {
        self.bytes[0x09] = u8::from(is_there);
    }

    pub(crate) fn raise(&mut self, event: u8) {
        self.bytes[usize::from(STATUS)] |= event;
    }

    pub(crate) fn has(&self, event: u8) -> bool {
        self.bytes[usize::from(STATUS)] & event != 0
    }

    /// Bits 6 to 4 of CONFIG mask the events (PS 9.1).
    pub(crate) fn wants_attention(&self) -> bool {
        self.bytes[usize::from(STATUS)] & EVENTS & !self.bytes[usize::from(CONFIG)] != 0
    }

    /// A lost packet: bits 7 to 4 count them up to 15, bits 3 to 0 the repeats of the newest (PS 9.1).
    pub(crate) fn observe(&mut self, lost: bool) {
        let before = self.bytes[usize::from(OBSERVE_TX)] >> 4;
        let count = if lost { (before + 1).min(15) } else { before };
        self.bytes[usize::from(OBSERVE_TX)] = count << 4 | self.repeats;
    }

    pub(crate) fn is_up(&self) -> bool {
        self.bytes[usize::from(CONFIG)] & PWR_UP != 0 && self.enabled
    }

    pub(crate) fn is_receiver(&self) -> bool {
        self.bytes[usize::from(CONFIG)] & PRIM_RX != 0
    }

    pub(crate) fn channel(&self) -> u8 {
        self.bytes[usize::from(RF_CH)]
    }

    /// ns of a bit: bit 3 of RF_SETUP is 2 Mbit/s, bit 5 is 250 kbit/s (PS 9.1).
    pub(crate) fn bit_time(&self) -> u64 {
        match self.bytes[usize::from(RF_SETUP)] & 0x28 {
            0x08 => 500,
            0x20 => 4_000,
            _ => 1_000,
        }
    }

    /// From the end of a packet to the start of its repeat, ns; and how often (PS 9.1: SETUP_RETR).
    pub(crate) fn repeats(&self) -> (u64, u8) {
        let value = self.bytes[usize::from(SETUP_RETR)];
        (250_000 * (u64::from(value >> 4) + 1), value & 0x0f)
    }

    pub(crate) fn target(&self) -> [u8; 5] {
        self.addresses[2]
    }

    /// The pipe that this address is for, if it is open.
    pub(crate) fn pipe(&self, address: [u8; 5]) -> Option<u8> {
        let open = |pipe: &u8| self.bytes[usize::from(EN_RXADDR)] & 1 << pipe != 0;
        (0..6).filter(open).find(|pipe| self.address(*pipe) == address)
    }

    /// A pipe's address; pipes 2 to 5 share the upper bytes of pipe 1 (PS 7.6).
    pub(crate) fn address(&self, pipe: u8) -> [u8; 5] {
        match pipe {
            0 | 1 => self.addresses[usize::from(pipe)],
            _ => {
                let mut own = self.addresses[1];
                own[0] = self.bytes[usize::from(RX_ADDR_P0 + pipe)];
                own
            }
        }
    }

    pub(crate) fn acknowledges(&self, pipe: u8) -> bool {
        self.bytes[usize::from(EN_AA)] & 1 << pipe != 0
    }

    pub(crate) fn has_ack_payloads(&self) -> bool {
        self.bytes[usize::from(FEATURE)] & EN_ACK_PAY != 0
    }

    fn has_own_lengths(&self, pipe: u8) -> bool {
        self.bytes[usize::from(FEATURE)] & EN_DPL != 0 && self.bytes[usize::from(DYNPD)] & 1 << pipe != 0
    }

    /// Whether a payload of this length is one for that pipe: any, or the one that RX_PW says (PS 7.3.4).
    pub(crate) fn takes(&self, pipe: u8, len: usize) -> bool {
        self.has_own_lengths(pipe) || usize::from(self.bytes[usize::from(RX_PW_P0 + pipe)]) == len
    }

    /// A byte each way; the first answer is STATUS (PS 8.3.1).
    pub(crate) fn exchange(&self, exchange: &mut Exchange, byte: u8) -> u8 {
        if !self.has_supply {
            return 0;
        }
        let Some(_command) = exchange.command else {
            exchange.command = Some(byte);
            exchange.answer = match byte {
                0x00..0x20 => self.read(byte),
                0x60 => vec![self.received.front().map_or(0, |(_, payload)| payload.len() as u8)],
                0x61 => self.received.front().map_or_else(Vec::new, |(_, payload)| payload.clone()),
                _ => Vec::new(),
            };
            return self.status();
        };
        let answer = exchange.answer.get(exchange.bytes.len()).or(exchange.answer.last());
        let answer = answer.copied().unwrap_or(0);
        exchange.bytes.push(byte);
        answer
    }

    fn read(&self, register: u8) -> Vec<u8> {
        match register {
            RX_ADDR_P0 => self.addresses[0].to_vec(),
            RX_ADDR_P1 => self.addresses[1].to_vec(),
            TX_ADDR => self.addresses[2].to_vec(),
            _ => vec![self.register(register)],
        }
    }

    /// The end of a transaction: now its command takes effect.
    pub(crate) fn deselect(&mut self, exchange: Exchange) {
        let Exchange { command: Some(command), bytes, .. } = exchange else { return };
        if !self.has_supply {
            return;
        }
        match command {
            0x20..0x40 => self.write(command & 0x1f, &bytes),
            0x61 if !bytes.is_empty() => {
                self.received.pop_front();
            }
            0xa0 => self.load(bytes, None, false),
            0xb0 => self.load(bytes, None, self.bytes[usize::from(FEATURE)] & EN_DYN_ACK != 0),
            0xa8..0xae if self.has_ack_payloads() => self.load(bytes, Some(command & 7), false),
            0xe1 => self.to_send.clear(),
            0xe2 => self.received.clear(),
            _ => {}
        }
    }

    fn load(&mut self, payload: Vec<u8>, pipe: Option<u8>, no_ack: bool) {
        if self.to_send.len() < FIFO && (1..=PAYLOAD_MAX).contains(&payload.len()) {
            self.to_send.push_back(ToSend { payload, pipe, no_ack, sent: false });
        }
    }

    fn write(&mut self, register: u8, bytes: &[u8]) {
        let Some(&first) = bytes.first() else { return };
        let address = match register {
            RX_ADDR_P0 => Some(0),
            RX_ADDR_P1 => Some(1),
            TX_ADDR => Some(2),
            _ => None,
        };
        match (register, address) {
            (_, Some(index)) => {
                // The first byte on the line is the lowest (PS 8.3.1).
                self.addresses[index].iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
            }
            // Writing 1 clears an event.
            (STATUS, _) => self.bytes[usize::from(STATUS)] &= !(first & EVENTS),
            (RF_CH, _) => {
                self.bytes[usize::from(RF_CH)] = first & 0x7f;
                self.bytes[usize::from(OBSERVE_TX)] &= 0x0f;
            }
            (OBSERVE_TX | FIFO_STATUS | 0x09, _) => {}
            _ => self.bytes[usize::from(register)] = first,
        }
    }
}
