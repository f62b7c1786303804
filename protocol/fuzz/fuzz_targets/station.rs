//! `station`: fuzz target: messages between host and base station.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::station(bytes));
