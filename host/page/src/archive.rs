//! `archive`: history of scenes. Scenes are finished and encoded here, once each, off the match's own thread:
//! the newest for viewers, whole seconds gzipped for viewers that seek back, one sample a second for plots.

use std::collections::BTreeMap;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde::Serialize;

use crate::deferred_scene::DeferredScene;
use crate::match_event::MatchEvent;
use crate::request::PageTeam;
use crate::scene::Scene;
use crate::viewers::Viewers;

/// Scenes that may wait to be finished and encoded, a third of a second of them: further ones are left out,
/// because old scenes are of no use.
const WAITING_MAX: usize = 8;
/// Number of seconds that are kept, an hour: some 25 kB each.
const SECONDS_MAX: usize = 3_600;
/// Number of newest events that are kept: a match has some thousand.
const MATCH_EVENTS_MAX: usize = 100_000;

/// Values of one second, for plots.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ArchiveSample {
    /// Seconds since the start.
    pub t: f64,
    /// `group/name` of a gauge, with its value.
    pub values: BTreeMap<String, f32>,
    /// Numbers of each robot, by team and number (`blue3`), in the order of `ROBOT_NUMBERS`.
    pub robots: BTreeMap<String, [Option<f32>; ROBOT_NUMBERS]>,
}

/// Numbers of a robot in a sample: speed, m/s; battery, V; mean round trip, ms; loss to and from it, percent;
/// frames and telemetry received a second (these five over 1 s); time since it was heard and seen, ms.
const ROBOT_NUMBERS: usize = 9;

/// Time of a scene, s, and its JSON.
type Encoded = (f64, Arc<str>);

#[derive(Debug, Default)]
pub(crate) struct Kept {
    seconds: BTreeMap<u32, Arc<[u8]>>,
    open: Option<(u32, Vec<Encoded>)>,
    pub(crate) match_events: Vec<MatchEvent>,
    pub(crate) samples: Vec<ArchiveSample>,
    /// Tables of cases, gzipped, by the time up to which they count.
    cases: Vec<(f64, Arc<[u8]>)>,
    /// Time of the first and the last scene, s.
    pub(crate) span: Option<(f64, f64)>,
    /// Number of times that the history was dropped: each restart of the match is one.
    pub(crate) generation: u32,
}

/// A message to the archive's thread.
enum Mail {
    DeferredScene(Box<DeferredScene>),
    MatchEvent(Box<MatchEvent>),
    Cases(f64, String),
    Clear,
}

/// The match's handle of the archive.
#[derive(Debug)]
pub(crate) struct Archive {
    mail: Sender<Mail>,
    waiting: Arc<AtomicUsize>,
    kept: Arc<Mutex<Kept>>,
}

impl Archive {
    /// Begins; every newest scene goes to `viewers`.
    pub(crate) fn begin(viewers: Arc<Viewers>) -> Self {
        let (mail, inbox) = channel();
        let (waiting, kept) = (Arc::new(AtomicUsize::new(0)), Arc::new(Mutex::new(Kept::default())));
        let worker = Worker { inbox, waiting: waiting.clone(), kept: kept.clone(), viewers };
        thread::spawn(move || worker.work());
        Self { mail, waiting, kept }
    }

    /// Passes a scene to the archive, unless it is behind. Never waits.
    pub(crate) fn show(&self, deferred_scene: DeferredScene) -> bool {
        if self.waiting.load(Ordering::Relaxed) >= WAITING_MAX {
            return false;
        }
        self.push(deferred_scene);
        true
    }

    /// Passes a scene to the archive in any case, and waits for it.
    pub(crate) fn keep(&self, deferred_scene: DeferredScene) {
        while self.waiting.load(Ordering::Relaxed) >= WAITING_MAX {
            thread::sleep(Duration::from_millis(1));
        }
        self.push(deferred_scene);
    }

    fn push(&self, deferred_scene: DeferredScene) {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        // The receiver is gone only while the program ends.
        let _ = self.mail.send(Mail::DeferredScene(Box::new(deferred_scene)));
    }

    pub(crate) fn keep_event(&self, match_event: MatchEvent) {
        let _ = self.mail.send(Mail::MatchEvent(Box::new(match_event)));
    }

    /// Takes tables of cases.
    pub(crate) fn keep_cases(&self, t: f64, tables: String) {
        let _ = self.mail.send(Mail::Cases(t, tables));
    }

    /// Drops everything: another match starts.
    pub(crate) fn clear(&self) {
        let _ = self.mail.send(Mail::Clear);
    }

    pub(crate) fn kept(&self) -> Arc<Mutex<Kept>> {
        self.kept.clone()
    }
}

/// Accesses the history; a thread that panicked left it consistent.
pub(crate) fn look<T>(kept: &Mutex<Kept>, at: impl FnOnce(&mut Kept) -> T) -> T {
    at(&mut kept.lock().unwrap_or_else(PoisonError::into_inner))
}

struct Worker {
    inbox: Receiver<Mail>,
    waiting: Arc<AtomicUsize>,
    kept: Arc<Mutex<Kept>>,
    viewers: Arc<Viewers>,
}

impl Worker {
    fn work(self) {
        while let Ok(mail) = self.inbox.recv() {
            match mail {
                Mail::DeferredScene(deferred_scene) => {
                    let scene = deferred_scene.finished();
                    // Strings, numbers and lists of them: nothing that JSON cannot hold.
                    let text: Arc<str> = Arc::from(serde_json::to_string(&scene).unwrap_or_default());
                    look(&self.kept, |kept| kept.add(&scene, text.clone()));
                    self.viewers.show(&text);
                    self.waiting.fetch_sub(1, Ordering::Relaxed);
                }
                Mail::MatchEvent(match_event) => look(&self.kept, |kept| {
                    if kept.match_events.len() < MATCH_EVENTS_MAX {
                        kept.match_events.push(*match_event);
                    }
                }),
                Mail::Cases(t, tables) => {
                    let tables = gzip(&tables);
                    look(&self.kept, |kept| kept.add_cases(t, tables));
                }
                Mail::Clear => {
                    look(&self.kept, |kept| {
                        *kept = Kept { generation: kept.generation + 1, ..Kept::default() }
                    });
                }
            }
        }
    }
}

impl Kept {
    fn add(&mut self, scene: &Scene, text: Arc<str>) {
        let second = scene.t.max(0.0) as u32;
        let same = matches!(&self.open, Some((open, _)) if *open == second);
        if same {
            if let Some((_, texts)) = &mut self.open {
                // While paused, the same moment arrives repeatedly and is kept once.
                if texts.last().is_some_and(|(t, _)| *t == scene.t) {
                    texts.pop();
                }
                texts.push((scene.t, text));
            }
        } else {
            self.close();
            self.samples.push(sample(scene));
            if self.samples.len() > SECONDS_MAX {
                self.samples.remove(0);
            }
            self.open = Some((second, vec![(scene.t, text)]));
        }
        let (first, _) = self.span.get_or_insert((scene.t, scene.t));
        self.span = Some((*first, scene.t));
    }

    fn close(&mut self) {
        let Some((second, texts)) = self.open.take() else { return };
        self.seconds.insert(second, gzip(&list(&texts)));
        while self.seconds.len() > SECONDS_MAX
            && let Some((dropped, _)) = self.seconds.pop_first()
        {
            self.span = self.span.map(|(_, last)| (f64::from(dropped + 1), last));
        }
    }

    /// The scenes of a second as a JSON list, gzipped.
    pub(crate) fn second(&self, second: u32) -> Option<Arc<[u8]>> {
        let open = self.open.as_ref().filter(|(open, _)| *open == second);
        open.map(|(_, texts)| gzip(&list(texts))).or_else(|| self.seconds.get(&second).cloned())
    }

    fn add_cases(&mut self, t: f64, tables: Arc<[u8]>) {
        if self.cases.last().is_some_and(|(_, last)| *last == tables) {
            return;
        }
        self.cases.push((t, tables));
        if self.cases.len() > SECONDS_MAX {
            self.cases.remove(0);
        }
    }

    /// The newest tables of cases that count up to `t` at most, gzipped.
    pub(crate) fn cases_at(&self, t: f64) -> Option<Arc<[u8]>> {
        let after = self.cases.partition_point(|(at, _)| *at <= t + 1e-6);
        Some(self.cases.get(after.checked_sub(1)?)?.1.clone())
    }

    /// The last scene at or before `t`.
    pub(crate) fn scene_at(&self, t: f64) -> Option<Scene> {
        let mut text = String::new();
        std::io::Read::read_to_string(
            &mut flate2::read::GzDecoder::new(&self.second(t as u32)?[..]),
            &mut text,
        )
        .ok()?;
        let scenes: Vec<Scene> = serde_json::from_str(&text).ok()?;
        let after = scenes.partition_point(|scene| scene.t <= t + 1e-6);
        scenes.into_iter().nth(after.saturating_sub(1))
    }
}

fn sample(scene: &Scene) -> ArchiveSample {
    let values = scene.gauges.iter().map(|gauge| (format!("{}/{}", gauge.group, gauge.name), gauge.value));
    let robots = scene.robots.iter().map(|robot| {
        let [vx, vy] = robot.velocity;
        let vitals = robot.vitals.as_ref();
        let link = vitals.map(|vitals| vitals.link).unwrap_or_default();
        let numbers = [
            Some(crate::milli(vx.hypot(vy))),
            vitals.and_then(|vitals| vitals.battery),
            link.trip_ms[0],
            link.loss_down[0],
            link.loss_up[0],
            link.frames[0],
            link.telemetry[0],
            vitals.and_then(|vitals| vitals.silence_ms),
            vitals.map(|vitals| vitals.unseen_ms),
        ];
        let team = match robot.team {
            PageTeam::Blue => "blue",
            PageTeam::Yellow => "yellow",
        };
        (format!("{team}{}", robot.id), numbers)
    });
    ArchiveSample { t: scene.t, values: values.collect(), robots: robots.collect() }
}

/// These scenes as a JSON list.
fn list(texts: &[Encoded]) -> String {
    let texts: Vec<&str> = texts.iter().map(|(_, text)| &**text).collect();
    format!("[{}]", texts.join(","))
}

pub(crate) fn gzip(text: &str) -> Arc<[u8]> {
    let mut out = GzEncoder::new(Vec::new(), Compression::fast());
    // Writing to memory cannot fail.
    let _ = out.write_all(text.as_bytes());
    out.finish().unwrap_or_default().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(t: f64) -> (Scene, Arc<str>) {
        let scene = Scene { t, ..Scene::default() };
        let text = serde_json::to_string(&scene).unwrap().into();
        (scene, text)
    }

    #[test]
    fn a_moment_that_has_passed_is_found_again_in_open_and_closed_seconds() {
        let mut kept = Kept::default();
        for i in 0..60 {
            let (scene, text) = scene(f64::from(i) * 0.04);
            kept.add(&scene, text);
        }
        assert_eq!(kept.span.map(|(first, last)| (first, (last * 100.0) as u32)), Some((0.0, 236)));
        for (asked, found) in [(0.0, 0.0), (0.5, 0.48), (1.99, 1.96), (2.3, 2.28)] {
            assert!((kept.scene_at(asked).unwrap().t - found).abs() < 1e-9, "{asked}");
        }
        assert_eq!(kept.scene_at(7.0), None);
        assert_eq!(kept.samples.len(), 3, "one a second");
    }

    #[test]
    fn tables_of_cases_are_those_of_the_moment() {
        let mut kept = Kept::default();
        assert_eq!(kept.cases_at(9.0), None);
        for (t, text) in [(1.0, "a"), (2.0, "b"), (3.0, "b"), (4.0, "a")] {
            kept.add_cases(t, gzip(text));
        }
        let at = |t| kept.cases_at(t).map(|tables| tables == gzip("a"));
        assert_eq!(
            [0.5, 1.0, 1.9, 3.5, 4.0, 99.0].map(at),
            [None, Some(true), Some(true), Some(false), Some(true), Some(true)]
        );
        for t in 0..SECONDS_MAX + 10 {
            kept.add_cases(10.0 + t as f64, gzip(&t.to_string()));
        }
        assert_eq!(kept.cases.len(), SECONDS_MAX);
    }

    #[test]
    fn the_oldest_second_is_dropped_when_the_archive_is_full() {
        let mut kept = Kept::default();
        for i in 0..SECONDS_MAX as u32 + 10 {
            let (scene, text) = scene(f64::from(i));
            kept.add(&scene, text);
        }
        assert_eq!(kept.seconds.len(), SECONDS_MAX);
        assert!(kept.second(0).is_none());
        let (first, _) = kept.span.unwrap();
        assert!(kept.second(first as u32).is_some());
    }
}
