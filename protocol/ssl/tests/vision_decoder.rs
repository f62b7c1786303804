//! `vision_decoder`: tests: the allocation-free decoder gives what a plain decode gives, and does not
//! allocate.
#![allow(unsafe_code, reason = "an allocator that counts is one by an unsafe trait")]

#[path = "support/messages.rs"]
mod messages;
#[path = "support/mutate.rs"]
#[allow(dead_code, reason = "of the fuzz run only its broken packets are needed")]
mod mutate;
#[path = "support/recordings.rs"]
mod recordings;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use recordings::{ERFORCE, GRSIM, GRSIM_NOISY};
use ssl::Message;
use ssl::log::MessageKind;
use ssl::vision::{Decoder, WrapperPacket};

#[test]
fn packets_of_all_programs_mixed_decode_as_they_do_alone() {
    let mut decoder = Decoder::default();
    let (grsim, erforce) = (vision(GRSIM), vision(ERFORCE));
    for (one, other) in grsim.iter().zip(erforce.iter().cycle()) {
        for bytes in [one, other, other, one] {
            let alone = WrapperPacket::decode(&bytes[..]).expect("a sound packet");
            assert_eq!(decoder.decode(bytes), Ok(&alone));
        }
    }
}

#[test]
fn broken_packets_are_refused_as_by_a_plain_decode_and_leave_no_trace() {
    let seeds = mutate::seeds(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"));
    let sound: Vec<_> = seeds.iter().filter(|(_, bytes)| WrapperPacket::decode(&bytes[..]).is_ok()).collect();
    let sound: Vec<_> = sound.into_iter().cloned().collect();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let mut decoder = Decoder::default();
    let mut refused = 0;
    for round in 0..10_000 {
        let (_, broken) = mutate::mutated(&sound, &mut random);
        let (_, whole) = &sound[round % sound.len()];
        for bytes in [&broken, whole] {
            match (decoder.decode(bytes), WrapperPacket::decode(&bytes[..])) {
                // Compared by bytes, so that NaNs differ.
                (Ok(packet), Ok(alone)) => {
                    assert_eq!(packet.encode_to_vec(), alone.encode_to_vec(), "round {round}");
                }
                (Err(_), Err(_)) => refused += 1,
                (ours, alone) => panic!("round {round}: {ours:?}, alone {alone:?}"),
            }
        }
    }
    assert!((1000..9000).contains(&refused), "{refused}");
}

#[test]
fn in_the_steady_state_a_packet_takes_no_memory() {
    for name in [GRSIM_NOISY, ERFORCE] {
        let packets = vision(name);
        let mut decoder = Decoder::default();
        let (first, rest) = packets.split_at(500);
        for bytes in first {
            decoder.decode(bytes).expect("sound");
        }
        let mut grown = 0;
        let before = taken();
        for bytes in rest {
            let at = taken();
            let packet = decoder.decode(bytes).expect("sound");
            // grSim sends another camera with each field: that is not the steady state.
            let another_field = name == GRSIM_NOISY && packet.geometry.is_some();
            if taken() > at && !another_field {
                grown += 1;
            }
        }
        assert_eq!(grown, 0, "{name}: of {} packets", rest.len());
        assert!(name == ERFORCE || taken() > before, "the count does not count");
    }
}

fn vision(name: &str) -> Vec<Vec<u8>> {
    let records = recordings::open(name).filter(|record| record.kind == MessageKind::Vision2014);
    records.map(|record| record.payload).collect()
}

/// Number of allocations of this thread.
fn taken() -> u64 {
    TAKEN.get()
}

thread_local! {
    static TAKEN: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

// SAFETY: everything is handed to the system's allocator as it came; the count takes no memory itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        TAKEN.set(TAKEN.get() + 1);
        // SAFETY: the caller's promise is handed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the pointer came from `alloc` or `realloc`, which is the system's.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        TAKEN.set(TAKEN.get() + 1);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}
