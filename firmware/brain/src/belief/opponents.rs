//! `opponents`: tracks of the opponents from the places that they report. SI units, field frame.
//!
//! A report belongs to the nearest track within reach, else it starts a track. A track without a report walks
//! on as it did, grows uncertain, and is dropped after a second. What a report is wrong by drifts as slowly
//! as robots walk (2 s): filters that smooth it were measured to add more lag than they remove error, so a
//! track's place is its last report.

use geometry::{Field, Point, Vector};
use protocol::robot_io::OPPONENTS_SEEN_MAX;

use super::model;

/// The known opponents.
#[derive(Clone, Debug, Default)]
pub struct Tracks {
    tracks: heapless::Vec<Track, OPPONENTS_SEEN_MAX>,
}

/// An opponent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Track {
    /// Its place.
    pub place: Point<Field>,
    /// Its velocity, m/s, smoothed over `SMOOTHED`.
    pub velocity: Vector<Field>,
    /// s since its last report.
    age: f32,
}

impl Tracks {
    /// Carries on over `dt` s and takes in the reports of this frame.
    pub fn update(&mut self, reports: &[Point<Field>], dt: f32) {
        for track in &mut self.tracks {
            track.predict(dt);
        }
        let mut taken = [false; OPPONENTS_SEEN_MAX];
        for &report in reports.iter().filter(|report| report.is_finite()) {
            let distance = |track: &Track| track.place.distance(report);
            let free = self.tracks.iter_mut().zip(&mut taken);
            let free = free.filter(|(track, taken)| !**taken && distance(track) < GATE);
            match free.reduce(|a, b| if distance(b.0) < distance(a.0) { b } else { a }) {
                Some((track, taken)) => {
                    *taken = true;
                    track.see(report, dt);
                }
                // A team has no more robots than there are tracks.
                None => {
                    if let Some(taken) = taken.get_mut(self.tracks.len())
                        && self.tracks.push(Track::at(report)).is_ok()
                    {
                        *taken = true;
                    }
                }
            }
        }
        self.tracks.retain(|track| track.age < LEASE);
    }

    /// All tracks.
    pub fn iter(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter()
    }
}

impl Track {
    fn at(place: Point<Field>) -> Self {
        Self { place, velocity: Vector::default(), age: 0.0 }
    }

    /// Variance of a coordinate of its place, m².
    pub fn variance(&self) -> f32 {
        let walked = WALKING * self.age;
        model::REPORTED * model::REPORTED + walked * walked
    }

    fn predict(&mut self, dt: f32) {
        self.age += dt;
        self.place += self.velocity * dt;
    }

    fn see(&mut self, report: Point<Field>, dt: f32) {
        // What the velocity did not predict over its age.
        let off = report - self.place;
        self.velocity = (self.velocity + off * (dt / (SMOOTHED * self.age.max(dt)))).clamped(WALKING);
        (self.place, self.age) = (report, 0.0);
    }
}

/// A report farther from a track is another robot's, m: two bodies and five deviations.
const GATE: f32 = 0.7;
/// A track without a report is dropped after this, s.
const LEASE: f32 = 1.0;
/// Time over which a velocity is smoothed, s: the drift of a report alone looks like 0.07 m/s then.
const SMOOTHED: f32 = 1.0;
/// A robot walks no faster, m/s.
const WALKING: f32 = motion::legged::WALK_FORWARD;

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::belief::random::RandomStream;

    #[test]
    fn a_track_knows_how_a_robot_walks_and_walks_on_without_reports() {
        for speed in [0.0_f64, 0.25] {
            let (mut squares, mut carried, runs) = (0.0, 0.0, 100);
            for seed in 0..runs {
                let mut random = RandomStream::new(seed);
                let keep = (-0.04_f64 / 2.0).exp();
                let mut drift = random.normal();
                let mut tracks = Tracks::default();
                for step in 0..=150 {
                    drift = keep * drift + (1.0 - keep * keep).sqrt() * random.normal();
                    let x = speed * 0.04 * f64::from(step) + f64::from(model::REPORTED) * drift;
                    tracks.update(&[Point::new(x as f32, 0.0)], 0.04);
                }
                let off = f64::from(tracks.iter().next().unwrap().velocity.x()) - speed;
                squares += off * off;
                (0..20).for_each(|_| tracks.update(&[], 0.04));
                let track = tracks.iter().next().unwrap();
                let off = f64::from(track.place.x()) - speed * 0.04 * 170.0;
                carried += off * off / f64::from(track.variance());
            }
            let rmse = (squares / f64::from(runs as u32)).sqrt();
            assert!(rmse < 0.09, "{speed} m/s: {rmse}");
            let normalised = carried / f64::from(runs as u32);
            assert!(normalised < 1.3, "{speed} m/s: {normalised}");
        }
    }

    #[test]
    fn reports_belong_to_the_nearest_track_and_a_silent_one_is_dropped() {
        let mut tracks = Tracks::default();
        let (one, two) = (Point::new(1.0, 0.0), Point::new(2.0, 0.5));
        for step in 0..50 {
            // In any order.
            let reports = if step % 2 == 0 { [one, two] } else { [two, one] };
            tracks.update(&reports, 0.04);
        }
        assert_eq!(tracks.iter().count(), 2);
        assert!(
            tracks.iter().all(|track| track.place.distance(one) < 0.01 || track.place.distance(two) < 0.01)
        );
        (0..30).for_each(|_| tracks.update(&[two], 0.04));
        assert_eq!(tracks.iter().count(), 1);
        tracks.update(&[Point::new(f32::NAN, 0.0); 9], 0.04);
        assert!(tracks.iter().count() <= 1);
    }
}
