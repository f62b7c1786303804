//! `frozen`: detects robots that have to move and do not. s, m, field frame.

use std::collections::{BTreeMap, VecDeque};

use geometry::{Field, Point};
use protocol::Who;

/// Why a robot has to move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Must {
    /// It is at a forbidden position.
    Leave,
    /// The referee waits for it.
    MakeWay,
    /// Its host sends it to a position at this distance, m.
    GoTo(f32),
    /// It has to play the ball, at this distance, m.
    Play(f32),
}

/// A robot that has to move and has not for [`LONGEST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frozen {
    /// The robot that stands still.
    pub who: Who,
    /// Why it has to move.
    pub must: Must,
    /// Position of its centre, m.
    pub at: Point<Field>,
}

/// Maximum time that a robot that has to move may stand, s (required bound).
pub const LONGEST: f32 = 5.0;
/// Distance within which a robot has not moved, m: less than half its radius.
const STILL: f32 = 0.04;
/// Interval between recorded positions, s.
const EVERY: f32 = 0.1;

/// Monitors all robots of both teams; keeps their positions of the last seconds.
#[derive(Clone, Debug, Default)]
pub struct Stands {
    tracks: BTreeMap<Who, Track>,
}

#[derive(Clone, Debug, Default)]
struct Track {
    /// Positions while it had to move, oldest first.
    places: VecDeque<(f32, Point<Field>)>,
}

impl Stands {
    /// Takes one moment: positions of the robots, and which have to move. Returns new violations; each robot
    /// once per stand.
    pub fn look(&mut self, time: f32, robots: &[(Who, Point<Field>, Option<Must>)]) -> Vec<Frozen> {
        let mut found = Vec::new();
        self.tracks.retain(|who, _| robots.iter().any(|robot| robot.0 == *who));
        for &(who, at, must) in robots {
            let track = self.tracks.entry(who).or_default();
            let Some(must) = must else {
                track.places.clear();
                continue;
            };
            if track.places.back().is_none_or(|(last, _)| time - last >= EVERY) {
                track.places.push_back((time, at));
            }
            while track.places.front().is_some_and(|(first, _)| time - first > LONGEST + EVERY) {
                track.places.pop_front();
            }
            let Some(&(first, _)) = track.places.front() else { continue };
            let stood = track.places.iter().all(|(_, place)| place.distance(at) < STILL);
            if time - first >= LONGEST && stood {
                found.push(Frozen { who, must, at });
                track.places.clear();
            }
        }
        found
    }
}
