//! `emulator_log`: an emulated robot's log, with this machine named where it is the cause. The emulator runs
//! by the machine's clock: where it gets no processor for a while, the robot's watchdog ends it as if a task
//! hung.

use std::collections::VecDeque;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::Child;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::output::note;

/// Passes on what the emulator writes on its stderr, which must be piped, until it ends; `name` stands before
/// each line.
pub(super) fn follow(child: &mut Child, name: &str) {
    let (Some(stderr), id, name) = (child.stderr.take(), child.id(), name.to_owned()) else { return };
    let waited = Arc::new(Mutex::new(VecDeque::new()));
    let samples = waited.clone();
    thread::spawn(move || sample(id, &samples));
    thread::spawn(move || {
        let mut lost = LostPackets::default();
        for line in BufReader::new(stderr).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line);
            let line = line.trim_end_matches('\r');
            if !line.starts_with(LOST_PACKET) {
                note!("{name}{}", told(line, &waited));
            } else if let Some(line) = lost.count(Instant::now()) {
                note!("{name}{line}");
            }
        }
    });
}

/// Packets that the emulator's network could not send, which it writes a line of for each.
#[derive(Debug, Default)]
struct LostPackets {
    all: u64,
    told: Option<Instant>,
}

impl LostPackets {
    /// Counts one; returns a line for all of them, seldom.
    fn count(&mut self, now: Instant) -> Option<String> {
        self.all += 1;
        if self.told.is_some_and(|told| now.duration_since(told) < LOST_TOLD_EVERY) {
            return None;
        }
        self.told = Some(now);
        Some(format!(
            "the emulator's network loses packets ({} so far): this machine is too slow for real time; end other programs (it is no attack and no fault of the firmware)",
            self.all
        ))
    }
}

/// The line, or what has caused it.
fn told(line: &str, waited: &Mutex<VecDeque<Duration>>) -> String {
    let waited = waited.lock().unwrap_or_else(PoisonError::into_inner);
    let lately = waited.back().zip(waited.front()).map(|(last, first)| last.saturating_sub(*first));
    match lately.filter(|waited| *waited >= WAIT_MIN) {
        Some(_) if line.contains(AWAKE) => "robot: awake again".to_owned(),
        Some(waited) if line.contains(BITE) => format!(
            "this machine is too slow for real time: the emulator got no processor for {} ms, and the robot starts again; end other programs (it is no fault of the firmware)",
            waited.as_millis()
        ),
        _ => line.to_owned(),
    }
}

/// Notes how long the process has waited for a processor, until it is gone.
fn sample(process: u32, into: &Mutex<VecDeque<Duration>>) {
    while let Some(waited) = time_waited(process) {
        let mut samples = into.lock().unwrap_or_else(PoisonError::into_inner);
        samples.push_back(waited);
        if samples.len() > SAMPLES {
            samples.pop_front();
        }
        drop(samples);
        thread::sleep(SAMPLE_EVERY);
    }
}

/// Time that all threads of a process could have run and had no processor (Linux; elsewhere it is unknown).
fn time_waited(process: u32) -> Option<Duration> {
    let tasks = fs::read_dir(format!("/proc/{process}/task")).ok()?.flatten();
    let statistics = tasks.filter_map(|task| fs::read_to_string(task.path().join("schedstat")).ok());
    let nanoseconds = statistics.filter_map(|text| text.split(' ').nth(1)?.parse::<u64>().ok()).sum();
    Some(Duration::from_nanos(nanoseconds))
}

/// Parts of the lines that a robot logs when its watchdog bites, and at the start that follows.
const BITE: &str = "watchdog: a task hangs";
const AWAKE: &str = "awake after the watchdog's bite";
/// Begin of the line that the emulator's network writes for each packet that found no room.
const LOST_PACKET: &str = "Slirp: Failed to send packet";
/// Lost packets are reported at the first and then this often.
const LOST_TOLD_EVERY: Duration = Duration::from_secs(10);
/// One sample after the other, and how many are kept: 2 s.
const SAMPLE_EVERY: Duration = Duration::from_millis(200);
const SAMPLES: usize = 10;
/// Waiting in these 2 s from which on the machine is the cause: a tenth of the shortest time in which a
/// watchdog bites.
const WAIT_MIN: Duration = Duration::from_millis(50);

#[cfg(test)]
mod tests {
    use super::*;

    fn waited(milliseconds: &[u64]) -> Mutex<VecDeque<Duration>> {
        Mutex::new(milliseconds.iter().copied().map(Duration::from_millis).collect())
    }

    #[test]
    fn a_bite_under_load_names_the_machine_and_any_other_line_stays() {
        let bite = "robot: watchdog: a task hangs; motors off";
        let awake = "robot: awake after the watchdog's bite";
        let loaded = told(bite, &waited(&[100, 200, 600]));
        assert!(loaded.contains("no processor for 500 ms") && !loaded.contains("watchdog"), "{loaded}");
        for quiet in [&[][..], &[700], &[700, 720], &[700, 700, 749]] {
            assert_eq!(told(bite, &waited(quiet)), bite, "{quiet:?}");
            assert_eq!(told(awake, &waited(quiet)), awake, "{quiet:?}");
        }
        assert!(!told(awake, &waited(&[100, 200, 600])).contains("watchdog"));
        assert_eq!(told("radio: up", &waited(&[0, 900])), "radio: up");
    }

    #[test]
    fn lost_packets_are_one_line_in_ten_seconds_with_their_number() {
        let (mut lost, start) = (LostPackets::default(), Instant::now());
        let told: Vec<_> = (0..310).map(|n| lost.count(start + Duration::from_millis(50 * n))).collect();
        let lines: Vec<_> = told.into_iter().flatten().collect();
        assert_eq!(lines.len(), 2, "{lines:?}");
        assert!(lines[0].contains("(1 so far)") && lines[1].contains("(201 so far)"), "{lines:?}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_time_a_process_waits_is_known_while_it_runs() {
        assert!(time_waited(std::process::id()).is_some());
        assert!(time_waited(u32::MAX).is_none());
    }
}
