//! Does tracking see what is there? Made-up fields whose truth is known, and the recordings of the league's programs.

mod ball;
mod clocks;
mod order;
mod robots;
mod stadium;
