//! `tracking`: tests of tracking. Artificial fields with known ground truth, and the recordings of the
//! league's programs.

mod ball;
mod clocks;
mod order;
mod other_balls;
mod publish;
mod recordings;
mod robots;
mod sources;
mod stadium;
