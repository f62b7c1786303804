//! `tracking`: tests of tracking. Made-up fields whose truth is known, and the recordings of the league's
//! programs.

mod ball;
mod clocks;
mod order;
mod publish;
mod recordings;
mod robots;
mod stadium;
