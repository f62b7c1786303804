//! `line`: fuzz target: serial lines.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::line(bytes));
