//! `ssl`: fuzz target: the league's packets.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::league(bytes));
