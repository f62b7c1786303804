//! `airtime`: what payloads and acknowledgements cost of the air. Times in ns.
//!
//! "PS" is Nordic's *nRF24L01+ Preliminary Product Specification v1.0* (2008).

use crate::Rate;
use crate::fragment::{DATA_MAX, HEADER};

/// Settling before every packet and every acknowledgement (PS 6.1.7, table 16). Whether a chip that finds the
/// next payload waiting settles again, PS 7.5.1 answers with a figure in which it does.
pub const SETTLING: u64 = 130_000;
/// Bits of a packet around its payload: preamble 8, address 40, control field 9, check sum 16 (PS 7.3).
pub const FRAMING_BITS: u64 = 8 + 40 + 9 + 16;

/// A packet of `payload` bytes that asks for no acknowledgement, settling included.
pub const fn packet(rate: Rate, payload: u64) -> u64 {
    SETTLING + (FRAMING_BITS + 8 * payload) * rate.bit_time()
}

/// A packet of `payload` bytes and its acknowledgement of `answer` bytes.
pub const fn exchange(rate: Rate, payload: u64, answer: u64) -> u64 {
    packet(rate, payload) + packet(rate, answer)
}

/// All packets of a frame of `frame` bytes to every robot.
pub const fn broadcast(rate: Rate, frame: u64) -> u64 {
    let data = frame.saturating_sub(crate::fragment::ELIDED as u64);
    let (full, rest) = (data / DATA_MAX as u64, data % DATA_MAX as u64);
    let last = if rest > 0 { packet(rate, HEADER as u64 + rest) } else { 0 };
    full * packet(rate, (HEADER + DATA_MAX) as u64) + last
}
