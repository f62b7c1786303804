//! Does a robot's message bring its reader down, whatever its bytes?
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::team(bytes));
