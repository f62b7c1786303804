//! `course`: tries that are played one after the other on a thread of their own, beside the match; all that
//! were finished can be read at any time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Tries that are being played, or were.
pub(super) struct Course<T> {
    stopped: AtomicBool,
    finished: Mutex<Finished<T>>,
}

pub(super) struct Finished<T> {
    pub(super) results: Vec<T>,
    /// Why they were broken off.
    pub(super) error: Option<String>,
    /// Whether no more will follow.
    pub(super) over: bool,
}

/// Ends the course, however its thread ends.
struct End<T>(Arc<Course<T>>);

impl<T> Drop for End<T> {
    fn drop(&mut self) {
        self.0.finished().over = true;
    }
}

impl<T: Send + 'static> Course<T> {
    /// Plays on a thread of that name.
    pub(super) fn start(
        name: &str,
        play: impl FnOnce(&Self) -> Result<(), String> + Send + 'static,
    ) -> Result<Arc<Self>, String> {
        let finished = Mutex::new(Finished { results: Vec::new(), error: None, over: false });
        let course = Arc::new(Self { stopped: AtomicBool::new(false), finished });
        let end = End(course.clone());
        let work = move || {
            if let Err(error) = play(&end.0) {
                end.0.finished().error = Some(error);
            }
        };
        let worker = thread::Builder::new().name(name.to_owned()).spawn(work);
        worker.map_err(|error| format!("no thread for the tries: {error}"))?;
        Ok(course)
    }
}

impl<T> Course<T> {
    pub(super) fn finished(&self) -> MutexGuard<'_, Finished<T>> {
        self.finished.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// No further try starts.
    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}
