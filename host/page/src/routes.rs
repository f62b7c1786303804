//! `routes`: what is answered to a request: files of the page, seconds that are kept, explanations, frozen
//! moments.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use serde::Deserialize;
use serde_json::json;

use crate::archive::{gzip, look};
use crate::files;
use crate::http::{Answer, Head, Status};
use crate::problem::problem;
use crate::request::PageTeam;
use crate::shared::Shared;
use crate::workbench::{WorkbenchRequest, problems};

/// Events in one answer.
const MATCH_EVENTS_A_TIME: usize = 5_000;
const JSON: &str = "application/json";

/// The answer to anything but a viewer's socket, worked out `within` that time.
pub(crate) fn answer(shared: &Shared, head: &Head, body: Vec<u8>, within: Duration) -> Answer {
    let reads = matches!(&*head.method, "GET" | "HEAD");
    let allowed =
        |method, allowed, answer: &dyn Fn() -> Answer| if allowed { answer() } else { not_allowed(method) };
    match &*head.path {
        "/api/state" => allowed("GET, HEAD", reads, &|| state(shared, head)),
        "/api/events" => allowed("GET, HEAD", reads, &|| match_events(shared, head)),
        "/api/plots" => allowed("GET, HEAD", reads, &|| plots(shared)),
        "/api/log" => allowed("GET, HEAD", reads, &|| program_log(shared, head)),
        "/api/parameters" => allowed("GET, HEAD", reads, &|| list(&shared.parameters)),
        "/api/snapshots" => allowed("GET, HEAD", reads, &|| list(&shared.snapshots)),
        "/api/cases" => allowed("GET, HEAD", reads, &|| cases(shared, head)),
        "/api/freeze" => allowed("POST", head.method == "POST", &|| freeze(shared, &body)),
        "/api/workbench" if head.method == "POST" => workbench(shared, head, body, within),
        "/api/explain" if head.method == "POST" => explain(shared, body, within),
        "/api/workbench" | "/api/explain" => not_allowed("POST"),
        path => match path.strip_prefix("/api/second/") {
            Some(digits) => allowed("GET, HEAD", reads, &|| second(shared, digits)),
            None => allowed("GET, HEAD", reads, &|| file(path)),
        },
    }
}

fn not_allowed(methods: &'static str) -> Answer {
    Answer::bare(Status::NOT_ALLOWED).with("allow", methods)
}

fn file(path: &str) -> Answer {
    match files::find(path) {
        Some(file) => Answer::of(file.kind, file.text.as_bytes()),
        None => Answer::text(Status::NOT_FOUND, "nothing here"),
    }
}

fn state(shared: &Shared, head: &Head) -> Answer {
    let (span, generation) = look(&shared.kept, |kept| (kept.span, kept.generation));
    let settings = &shared.settings;
    let state = json!({
        "title": settings.title,
        "recorded": settings.recorded,
        "powers": settings.powers,
        "may_ask": shared.may_ask(head.asked("token")),
        "situations": shared.explanations.situations(),
        "spectrum": shared.spectrum.get(),
        "span": span,
        "life": generation,
    });
    Answer::of(JSON, state.to_string().into_bytes())
}

fn second(shared: &Shared, digits: &str) -> Answer {
    let Ok(second) = digits.parse() else {
        return Answer::text(Status::BAD_REQUEST, "expected a whole number of seconds");
    };
    match look(&shared.kept, |kept| kept.second(second)) {
        Some(bytes) => Answer::of(JSON, bytes.to_vec()).with("content-encoding", "gzip"),
        None => Answer::text(Status::NOT_FOUND, "not kept"),
    }
}

fn match_events(shared: &Shared, head: &Head) -> Answer {
    let Ok(from) = head.asked("from").unwrap_or("0").parse::<usize>() else {
        return Answer::text(Status::BAD_REQUEST, "from: expected a whole number");
    };
    let text = look(&shared.kept, |kept| {
        let all = &kept.match_events;
        let until = all.len().min(from.saturating_add(MATCH_EVENTS_A_TIME));
        serde_json::to_string(&all[from.min(until)..until]).unwrap_or_default()
    });
    Answer::of(JSON, text.into_bytes())
}

fn plots(shared: &Shared) -> Answer {
    // An hour with every robot's numbers has megabytes; encoding waits for no match, which only locks to add.
    let samples = look(&shared.kept, |kept| kept.samples.clone());
    let text = serde_json::to_string(&samples).unwrap_or_default();
    Answer::of(JSON, gzip(&text).to_vec()).with("content-encoding", "gzip")
}

/// Reports of the program, from an entry on.
fn program_log(shared: &Shared, head: &Head) -> Answer {
    let Ok(from) = head.asked("from").unwrap_or("0").parse::<u64>() else {
        return Answer::text(Status::BAD_REQUEST, "from: expected a whole number");
    };
    let entries = shared.settings.log.from(from);
    Answer::of(JSON, serde_json::to_string(&entries).unwrap_or_default().into_bytes())
}

/// A list that the program keeps: parameters, or moments.
fn list(of: &Mutex<String>) -> Answer {
    let text = of.lock().unwrap_or_else(PoisonError::into_inner).clone();
    Answer::of(JSON, text.into_bytes())
}

/// Results of every case up to a moment; an empty object before anything is known.
fn cases(shared: &Shared, head: &Head) -> Answer {
    let Ok(at) = head.asked("at").unwrap_or("0").parse::<f64>() else {
        return Answer::text(Status::BAD_REQUEST, "at: expected seconds");
    };
    match look(&shared.kept, |kept| kept.cases_at(at)) {
        Some(bytes) => Answer::of(JSON, bytes.to_vec()).with("content-encoding", "gzip"),
        None => Answer::of(JSON, b"{}".to_vec()),
    }
}

fn explain(shared: &Shared, body: Vec<u8>, within: Duration) -> Answer {
    answered(shared.in_time(within, move |explanations| match std::str::from_utf8(&body) {
        Ok(problem) => explanations.explain(problem),
        Err(_) => Err("a problem is text".to_owned()),
    }))
}

/// Request of the case workbench; one that changes something, or takes long, needs the token.
fn workbench(shared: &Shared, head: &Head, body: Vec<u8>, within: Duration) -> Answer {
    let (may_ask, powers) = (shared.may_ask(head.asked("token")), shared.settings.powers);
    let kept = shared.kept.clone();
    let problems = Box::new(move || problems(&kept));
    answered(shared.in_time(within, move |explanations| match String::from_utf8(body) {
        Ok(text) => explanations.workbench(&WorkbenchRequest { text, may_ask, powers, problems }),
        Err(_) => Err("a request is text".to_owned()),
    }))
}

fn answered(answer: Result<Result<String, String>, Status>) -> Answer {
    match answer {
        Ok(Ok(text)) => Answer::of(JSON, text.into_bytes()),
        Ok(Err(reason)) => Answer::text(Status::UNPROCESSABLE, reason),
        Err(Status::TIMED_OUT) => Answer::text(Status::TIMED_OUT, "it took too long"),
        Err(status) => Answer::text(status, "no answer"),
    }
}

#[derive(Deserialize)]
struct Frozen {
    t: f64,
    team: PageTeam,
}

fn freeze(shared: &Shared, body: &[u8]) -> Answer {
    let Ok(asked) = serde_json::from_slice::<Frozen>(body) else {
        return Answer::text(Status::UNPROCESSABLE, "expected t and team");
    };
    let scene = look(&shared.kept, |kept| kept.scene_at(asked.t));
    match scene.and_then(|scene| problem(&scene, asked.team)) {
        Some(line) => Answer::text(Status::OK, line + "\n"),
        None => Answer::text(Status::UNPROCESSABLE, "no ball or no such team at that moment"),
    }
}
