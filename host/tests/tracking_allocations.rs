//! `tracking_allocations`: test: tracking does not allocate after the first seconds of a match
//! (docs/architecture.md §9).
#![allow(unsafe_code, reason = "an allocator that counts is one by an unsafe trait")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use host::tracking::{Publisher, Tracker};
use protocol::Instant;
use ssl::log::Packet;
use ssl::vision::WrapperPacket;

struct Counting;

thread_local! {
    // Per thread, so that the test harness's own do not count.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps alloc's contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps dealloc's contract.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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
fn images_pictures_and_tracker_packets_need_no_heap() {
    // The one with geometry in every packet, and the one with four cameras and geometry now and then.
    for name in ["erforce_divB_realistic_22s.log.gz", "grsim_divB_22s.log.gz"] {
        let packets = packets(name);
        let (mut tracker, mut publisher) = (Tracker::default(), Publisher::new("test", "onetwo"));
        let steady = packets.len() / 4;
        let mut before = 0;
        for (i, (arrived, packet)) in packets.iter().enumerate() {
            if i == steady {
                before = COUNT.with(Cell::get);
            }
            tracker.handle(packet, *arrived);
            let world = tracker.world(*arrived);
            assert!(i < steady || world.robots().count() > 0);
            assert!(publisher.publish(&tracker).is_some());
        }
        let taken = COUNT.with(Cell::get) - before;
        assert_eq!(taken, 0, "{name}: {taken} allocations in {} packets", packets.len() - steady);
        assert!(before > 0, "the counter counts");
    }
}
