//! `recordings`: the recordings and their contents. Read once a test, whole.

#![allow(dead_code, reason = "each test takes what it needs")]

use std::path::PathBuf;

use ssl::log::{LogReader, Packet, Record};
use ssl::referee::Referee;
use ssl::vision::WrapperPacket;

/// grSim: four cameras, clock of its own.
pub(crate) const GRSIM: &str = "grsim_divB_22s.log.gz";
/// The same, not gzipped, with an index, as the league's recorder wrote it.
pub(crate) const GRSIM_INDEXED: &str = "grsim_divB_22s_indexed.log";
/// grSim with noise; kickoff, placement, card, penalty, time-out, half time.
pub(crate) const GRSIM_NOISY: &str = "grsim_divB_noisy_64s.log.gz";
/// ER-Force's simulator with noise and dropouts: one camera, Unix time.
pub(crate) const ERFORCE: &str = "erforce_divB_realistic_22s.log.gz";

pub(crate) fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

pub(crate) fn open(name: &str) -> LogReader<ssl::log::Source> {
    ssl::log::open(&path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn records(name: &str) -> Vec<Record> {
    open(name).collect()
}

/// Vision packets with the recorder's times, ns.
pub(crate) fn vision(name: &str) -> Vec<(i64, WrapperPacket)> {
    open(name)
        .filter_map(|record| match record.decode() {
            Ok(Some(Packet::Vision(packet))) => Some((record.timestamp_ns, packet)),
            _ => None,
        })
        .collect()
}

/// Referee packets with the recorder's times, ns.
pub(crate) fn referee(name: &str) -> Vec<(i64, Referee)> {
    open(name)
        .filter_map(|record| match record.decode() {
            Ok(Some(Packet::Referee(packet))) => Some((record.timestamp_ns, packet)),
            _ => None,
        })
        .collect()
}
