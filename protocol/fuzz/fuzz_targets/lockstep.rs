//! `lockstep`: fuzz target: lockstep messages.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::lockstep(bytes));
