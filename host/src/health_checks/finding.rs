//! `finding`: the one kind of report of what does not fit: what, its evidence, a remedy, and since when.

use std::fmt;

use protocol::{Duration, Instant};

use super::Fault;

/// A finding that was absent for this time begins again.
const FORGOTTEN_AFTER: Duration = Duration::millis(10_000);

/// Something that does not fit, as long as it lasts.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What does not fit, with its figures.
    pub fault: Fault,
    /// Since when, on the host's clock.
    pub since: Instant,
}

impl Finding {
    /// The evidence: what was seen, with its figures.
    pub fn evidence(&self) -> String {
        self.parts().0
    }

    /// What to do.
    pub fn remedy(&self) -> String {
        self.parts().1
    }

    /// A fault's text ends with its remedy: after its last full stop, else semicolon, else colon.
    fn parts(&self) -> (String, String) {
        let text = self.fault.to_string();
        let parts = [". ", "; ", ": "].iter().find_map(|separator| text.rsplit_once(separator));
        let (evidence, remedy) = parts.unwrap_or((&text, ""));
        (evidence.to_owned(), remedy.to_owned())
    }

    /// As an object for programs: `part`, `what`, `evidence`, `remedy`, and `since_s`, s on the host's clock.
    pub fn to_json(&self) -> serde_json::Value {
        let (evidence, remedy) = self.parts();
        serde_json::json!({
            "part": self.fault.heading(),
            "what": self.fault.what(),
            "evidence": evidence,
            "remedy": remedy,
            "since_s": self.since.0 as f64 * 1e-6,
        })
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<8} {}", self.fault.heading(), self.fault)
    }
}

/// Faults with the time at which each began.
#[derive(Clone, Debug, Default)]
pub struct Since {
    /// Matter, begin, and when it was seen last.
    known: Vec<(String, Instant, Instant)>,
}

impl Since {
    /// The faults of now as findings.
    pub fn date(&mut self, now: Instant, faults: Vec<Fault>) -> Vec<Finding> {
        self.known.retain(|(_, _, seen)| now.since(*seen) < FORGOTTEN_AFTER);
        faults.into_iter().map(|fault| Finding { since: self.since(now, fault.matter()), fault }).collect()
    }

    fn since(&mut self, now: Instant, matter: String) -> Instant {
        if let Some((_, since, seen)) = self.known.iter_mut().find(|(known, ..)| *known == matter) {
            *seen = now;
            return *since;
        }
        self.known.push((matter, now, now));
        now
    }
}
