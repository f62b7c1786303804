//! Placeholder: being built.
#![no_std]
