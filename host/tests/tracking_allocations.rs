//! `tracking_allocations`: test: tracking does not allocate after the first seconds of a match
//! (docs/architecture.md §9).
#![allow(unsafe_code, reason = "an allocator that counts is one by an unsafe trait")]

mod allocations;

use std::path::Path;

use host::tracking::{Publisher, Tracker};
use protocol::Instant;
use ssl::log::Packet;
use ssl::vision::WrapperPacket;

fn packets(name: &str) -> Vec<(Instant, WrapperPacket)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data").join(name);
    let records = ssl::log::open(&path).unwrap();
    let vision = records.filter_map(|record| match record.decode().unwrap() {
        Some(Packet::Vision(packet)) => Some((Instant(record.timestamp_ns as u64 / 1000), packet)),
        _ => None,
    });
    vision.collect()
}

#[test]
fn frames_snapshots_and_tracker_packets_need_no_heap() {
    // The one with geometry in every packet, and the one with four cameras and geometry at intervals.
    for name in ["erforce_divB_realistic_22s.log.gz", "grsim_divB_22s.log.gz"] {
        let packets = packets(name);
        let (mut tracker, mut publisher) = (Tracker::default(), Publisher::new("test", "onetwo"));
        let steady = packets.len() / 4;
        let mut before = 0;
        for (i, (arrived, packet)) in packets.iter().enumerate() {
            if i == steady {
                before = allocations::count();
            }
            tracker.handle(packet, *arrived);
            let world = tracker.world(*arrived);
            assert!(i < steady || world.robots().count() > 0);
            assert!(publisher.publish(&tracker).is_some());
        }
        let taken = allocations::count() - before;
        assert_eq!(taken, 0, "{name}: {taken} allocations in {} packets", packets.len() - steady);
        assert!(before > 0, "the counter counts");
    }
}
