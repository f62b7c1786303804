//! `server`: HTTP and WebSocket server on a thread of its own.
//!
//! A viewer's socket carries the newest scene whenever the viewer has taken the one before: it acknowledges
//! with a dot. So a slow viewer sees fewer scenes, none of them old, and one that is gone holds nothing up.
//! Connections are served within [`Limits`](crate::Limits): a bounded number at once, each for a bounded
//! time.

use std::io;
use std::net::TcpListener;
use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::extract::ws::{Message, Utf8Bytes, WebSocket, WebSocketUpgrade};
use axum::extract::{Path, Query, Request as HttpRequest, State};
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use serde::Deserialize;
use serde_json::json;
use tokio::sync::{Semaphore, mpsc, oneshot, watch};
use tokio::time::{sleep, timeout};

use crate::archive::{Kept, look};
use crate::limits::{Limits, Seat};
use crate::page::{Oracle, Settings};
use crate::problem::{Freeze, problem, skeleton};
use crate::request::{Request, Team};
use crate::{files, guard};

/// Scenes sent to a viewer that it has not yet acknowledged.
const UNTAKEN_MAX: u32 = 2;
/// A viewer that takes nothing for this time is gone.
const GONE: Duration = Duration::from_secs(30);
/// Refusals that wait for a viewer that does not read; more are dropped.
const REFUSALS_MAX: usize = 16;
/// If no connection can be accepted (no descriptor is left), the next attempt is after this time.
const ACCEPT_AGAIN: Duration = Duration::from_millis(50);
/// The longest message of a viewer, bytes: a request, a problem.
const WORD_MAX: usize = 16 * 1024;
/// Events in one answer.
const HAPPENINGS_A_TIME: usize = 5_000;

/// State shared by all request handlers.
pub(crate) struct Shared {
    pub(crate) port: u16,
    pub(crate) settings: Settings,
    pub(crate) oracle: Arc<dyn Oracle>,
    pub(crate) news: watch::Receiver<Utf8Bytes>,
    pub(crate) kept: Arc<Mutex<Kept>>,
    pub(crate) asks: SyncSender<Ask>,
    pub(crate) viewers: Arc<AtomicUsize>,
}

/// Channel to a viewer for the reasons why its requests are refused.
pub(crate) type Refusals = mpsc::Sender<String>;

/// A viewer's request, and the channel for the answer if it is refused.
pub(crate) struct Ask {
    pub(crate) request: Request,
    pub(crate) asker: Refusals,
}

impl Shared {
    /// Whether a viewer with this token may send requests.
    fn may_ask(&self, brought: Option<&str>) -> bool {
        self.settings.token.as_ref().is_none_or(|token| brought.is_some_and(|brought| token.is(brought)))
    }
}

/// Serves on a thread of its own until `ended` is signalled or dropped.
pub(crate) fn serve(listener: TcpListener, shared: Shared, ended: oneshot::Receiver<()>) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    thread::spawn(move || {
        runtime.block_on(async move {
            let Ok(listener) = tokio::net::TcpListener::from_std(listener) else { return };
            let shared = Arc::new(shared);
            let limits = shared.settings.limits;
            let routes = Router::new()
                .route("/socket", get(socket))
                .route("/api/state", get(state))
                .route("/api/second/{second}", get(second))
                .route("/api/happenings", get(happenings))
                .route("/api/plots", get(plots))
                .route("/api/explain", post(explain))
                .route("/api/freeze", post(freeze))
                .fallback(get(file))
                .layer(axum::extract::DefaultBodyLimit::max(WORD_MAX))
                .layer(from_fn_with_state(shared.clone(), guarded))
                .with_state(shared);
            tokio::select! {
                () = accept(listener, routes, limits) => {}
                _ = ended => {}
            }
        });
    });
    Ok(())
}

/// Serves connection by connection, at most the limit's number at once.
async fn accept(listener: tokio::net::TcpListener, routes: Router, limits: Limits) {
    let places = Arc::new(Semaphore::new(limits.connections));
    loop {
        // The semaphore is never closed.
        let Ok(place) = places.clone().acquire_owned().await else { return };
        let Ok((stream, _)) = listener.accept().await else {
            sleep(ACCEPT_AGAIN).await;
            continue;
        };
        // Scenes are small and needed at once.
        let _ = stream.set_nodelay(true);
        let service = TowerToHyperService::new(routes.clone());
        let mut builder = http1::Builder::new();
        builder.timer(TokioTimer::new()).header_read_timeout(limits.header).half_close(false);
        let connection = builder.serve_connection(TokioIo::new(stream), service).with_upgrades();
        tokio::spawn(async move {
            // A viewer's socket leaves its connection with the answer to its request: it has a time limit of
            // its own (`GONE`).
            let _ = timeout(limits.connection, connection).await;
            drop(place);
        });
    }
}

/// Refuses foreign pages, and sends browsers the headers that restrict this page.
async fn guarded(State(shared): State<Arc<Shared>>, request: HttpRequest, next: Next) -> Response {
    if let Err(foreign) = guard::check(request.headers(), shared.port) {
        return (StatusCode::FORBIDDEN, foreign.words()).into_response();
    }
    let Ok(mut response) = timeout(shared.settings.limits.request, next.run(request)).await else {
        return (StatusCode::REQUEST_TIMEOUT, "it took too long").into_response();
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
    response
}

/// Nothing from elsewhere, not in another page's frame, nothing cached by the browser: another version may be
/// served tomorrow.
const HEADERS: [(&str, &str); 5] = [
    (
        "content-security-policy",
        "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("x-frame-options", "DENY"),
    ("referrer-policy", "no-referrer"),
    ("cache-control", "no-store"),
];

const JSON: (HeaderName, &str) = (header::CONTENT_TYPE, "application/json");

async fn file(request: HttpRequest) -> Response {
    match files::find(request.uri().path()) {
        Some(file) => ([(header::CONTENT_TYPE, file.kind)], file.text).into_response(),
        None => (StatusCode::NOT_FOUND, "nothing here").into_response(),
    }
}

async fn state(State(shared): State<Arc<Shared>>, Query(Brought { token }): Query<Brought>) -> Response {
    let (span, life) = look(&shared.kept, |kept| (kept.span, kept.life));
    let settings = &shared.settings;
    let state = json!({
        "title": settings.title,
        "recorded": settings.recorded,
        "powers": settings.powers,
        "may_ask": shared.may_ask(token.as_deref()),
        "situations": shared.oracle.situations(),
        "span": span,
        "life": life,
    });
    ([JSON], state.to_string()).into_response()
}

async fn second(State(shared): State<Arc<Shared>>, Path(second): Path<u32>) -> Response {
    match look(&shared.kept, |kept| kept.second(second)) {
        Some(bytes) => ([JSON, (header::CONTENT_ENCODING, "gzip")], bytes).into_response(),
        None => (StatusCode::NOT_FOUND, "not kept").into_response(),
    }
}

#[derive(Deserialize)]
struct From {
    #[serde(default)]
    from: usize,
}

async fn happenings(State(shared): State<Arc<Shared>>, Query(From { from }): Query<From>) -> Response {
    let text = look(&shared.kept, |kept| {
        let all = &kept.happenings;
        let until = all.len().min(from.saturating_add(HAPPENINGS_A_TIME));
        serde_json::to_string(&all[from.min(until)..until]).unwrap_or_default()
    });
    ([JSON], text).into_response()
}

async fn plots(State(shared): State<Arc<Shared>>) -> Response {
    let text = look(&shared.kept, |kept| serde_json::to_string(&kept.samples).unwrap_or_default());
    ([JSON], text).into_response()
}

async fn explain(State(shared): State<Arc<Shared>>, body: Bytes) -> Response {
    let oracle = shared.oracle.clone();
    let answer = tokio::task::spawn_blocking(move || match std::str::from_utf8(&body) {
        Ok(problem) => oracle.explain(problem),
        Err(_) => Err("a problem is text".to_owned()),
    });
    match answer.await {
        Ok(Ok(text)) => ([JSON], text).into_response(),
        Ok(Err(words)) => (StatusCode::UNPROCESSABLE_ENTITY, words).into_response(),
        Err(_) => (StatusCode::INTERNAL_SERVER_ERROR, "no answer").into_response(),
    }
}

#[derive(Deserialize)]
struct Frozen {
    t: f64,
    team: Team,
    what: Freeze,
}

async fn freeze(State(shared): State<Arc<Shared>>, body: Bytes) -> Response {
    let Ok(asked) = serde_json::from_slice::<Frozen>(&body) else {
        return (StatusCode::UNPROCESSABLE_ENTITY, "expected t, team and what").into_response();
    };
    let scene = look(&shared.kept, |kept| kept.scene_at(asked.t));
    let text = scene.and_then(|scene| match asked.what {
        Freeze::Problem => problem(&scene, asked.team).map(|line| line + "\n"),
        Freeze::Case => skeleton(&scene, asked.team),
    });
    match text {
        Some(text) => ([(header::CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response(),
        None => (StatusCode::UNPROCESSABLE_ENTITY, "no ball or no such team at that moment").into_response(),
    }
}

/// The token in a viewer's address.
#[derive(Deserialize)]
struct Brought {
    token: Option<String>,
}

async fn socket(
    State(shared): State<Arc<Shared>>,
    Query(Brought { token }): Query<Brought>,
    upgrade: WebSocketUpgrade,
) -> Response {
    // Taken before the answer: of simultaneous requests none can pass while the others are not counted yet.
    let Some(seat) = Seat::take(&shared.viewers, shared.settings.limits.viewers) else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many look on").into_response();
    };
    let may_ask = shared.may_ask(token.as_deref());
    let upgrade = upgrade.max_message_size(WORD_MAX).max_frame_size(WORD_MAX);
    upgrade.on_upgrade(move |socket| async move {
        look_on(socket, &shared, may_ask).await;
        drop(seat);
    })
}

/// Serves one viewer until it disconnects.
async fn look_on(mut socket: WebSocket, shared: &Shared, may_ask: bool) {
    let mut news = shared.news.clone();
    news.mark_changed();
    let (asker, mut refusals) = mpsc::channel(REFUSALS_MAX);
    let mut untaken = 0;
    loop {
        let sends = untaken < UNTAKEN_MAX;
        tokio::select! {
            changed = news.changed(), if sends => {
                let scene = news.borrow_and_update().clone();
                // The match is over with its page: the socket closes, and viewers display that.
                if changed.is_err() { return; }
                if scene.is_empty() { continue; }
                if !sent(&mut socket, scene).await { return; }
                untaken += 1;
            }
            Some(words) = refusals.recv() => {
                if !refused(&mut socket, words).await { return; }
            }
            word = timeout(GONE, socket.recv()) => match word {
                Ok(Some(Ok(Message::Text(word)))) if word.as_str() == "." => untaken = untaken.saturating_sub(1),
                // A viewer of a paused match reports that it is still connected.
                Ok(Some(Ok(Message::Text(word)))) if word.is_empty() => {}
                Ok(Some(Ok(Message::Text(word)))) => {
                    let asked = if may_ask { ask(shared, &asker, &word) } else { Err(NO_TOKEN.to_owned()) };
                    if let Err(words) = asked && !refused(&mut socket, words).await {
                        return;
                    }
                }
                Ok(Some(Ok(Message::Ping(_) | Message::Pong(_)))) => {}
                _ => return,
            },
        }
    }
}

/// Answer to a viewer without the token.
const NO_TOKEN: &str = "this page is open to the network: to ask for anything, open it by the address with ?token= that the program \
                        printed when it started";

fn ask(shared: &Shared, asker: &Refusals, word: &str) -> Result<(), String> {
    let request = Request::read(word, shared.settings.powers).map_err(|refused| refused.to_string())?;
    shared
        .asks
        .try_send(Ask { request, asker: asker.clone() })
        .map_err(|_| "the match is busy: ask again".to_owned())
}

async fn refused(socket: &mut WebSocket, words: String) -> bool {
    sent(socket, json!({ "refused": words }).to_string().into()).await
}

async fn sent(socket: &mut WebSocket, text: Utf8Bytes) -> bool {
    matches!(timeout(GONE, socket.send(Message::Text(text))).await, Ok(Ok(())))
}
