//! `team`: fuzz target: robots' messages.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::team(bytes));
