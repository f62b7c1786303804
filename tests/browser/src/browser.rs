//! `browser`: Chromium process and its one socket; answers are matched by the numbers of their requests.

use std::collections::HashMap;
use std::env;
use std::fmt;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

use crate::Tab;

/// Timeout of an answer: a loaded machine takes seconds to start a page.
const PATIENCE: Duration = Duration::from_mins(1);
/// Interval at which the socket is polled.
const LOOK: Duration = Duration::from_millis(50);
/// Names of the program on various systems.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// Why there is no browser, or no answer.
#[derive(Debug)]
pub enum BrowserError {
    /// No browser is installed.
    Missing,
    /// It does not start, or ended.
    Start(String),
    /// It sent something other than an answer.
    Answer(String),
}

impl fmt::Display for BrowserError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str(
                "no Chromium is found: install it (Debian: apt-get install chromium), or name one in ONETWO_BROWSER",
            ),
            Self::Start(reason) => write!(f, "the browser does not start: {reason}"),
            Self::Answer(reason) => write!(f, "the browser: {reason}"),
        }
    }
}

impl std::error::Error for BrowserError {}

/// The browser of this machine.
pub fn find() -> Result<PathBuf, BrowserError> {
    if let Some(reported) = env::var_os("ONETWO_BROWSER") {
        return Ok(reported.into());
    }
    let paths: Vec<PathBuf> =
        env::var_os("PATH").map(|paths| env::split_paths(&paths).collect()).unwrap_or_default();
    let there = |name: &str| paths.iter().map(|directory| directory.join(name)).find(|file| file.is_file());
    NAMES.iter().find_map(|name| there(name)).ok_or(BrowserError::Missing)
}

/// A running browser; it ends with this value.
pub struct Browser {
    child: Child,
    directory: PathBuf,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    asked: u64,
    answers: HashMap<u64, Value>,
    /// Events that pages sent without a request: session, method, parameters.
    pub(crate) events: Vec<(String, String, Value)>,
}

impl Browser {
    /// Starts one with a temporary profile.
    pub fn start() -> Result<Self, BrowserError> {
        let start = |error: &dyn fmt::Display| BrowserError::Start(error.to_string());
        let clock = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
        let directory =
            env::temp_dir().join(format!("onetwo-browser-{}-{}", std::process::id(), clock.as_nanos()));
        let mut child = Command::new(find()?)
            .args([
                "--headless=new",
                // Containers provide no namespaces for sandboxes; only our own page is ever opened here.
                "--no-sandbox",
                "--remote-debugging-port=0",
                "--no-first-run",
                "--no-default-browser-check",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--disable-background-timer-throttling",
                "--disable-renderer-backgrounding",
                "--disable-backgrounding-occluded-windows",
                "--hide-scrollbars",
                "--mute-audio",
                "about:blank",
            ])
            .arg(format!("--user-data-dir={}", directory.display()))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| start(&error))?;
        let mut reported = Vec::new();
        let mut address = None;
        if let Some(stderr) = child.stderr.take() {
            let mut lines = BufReader::new(stderr).lines();
            for line in lines.by_ref().map_while(Result::ok) {
                if let Some(found) = line.strip_prefix("DevTools listening on ") {
                    address = Some(found.trim().to_owned());
                    break;
                }
                reported.push(line);
            }
            // A full pipe would block it.
            std::thread::spawn(move || lines.for_each(drop));
        }
        let Some(address) = address else {
            let _ = child.kill();
            return Err(BrowserError::Start(reported.join("\n")));
        };
        let (socket, _) = tungstenite::connect(&address).map_err(|error| start(&error))?;
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(LOOK)).map_err(|error| start(&error))?;
        }
        Ok(Self { child, directory, socket, asked: 0, answers: HashMap::new(), events: Vec::new() })
    }

    /// A new page of that size, CSS pixels.
    pub fn open(&mut self, url: &str, width: u32, height: u32) -> Result<Tab<'_>, BrowserError> {
        let made = self.ask(None, "Target.createTarget", &json!({ "url": "about:blank" }))?;
        let attached = self.ask(
            None,
            "Target.attachToTarget",
            &json!({ "targetId": made["targetId"], "flatten": true }),
        )?;
        let session = attached["sessionId"].as_str().unwrap_or_default().to_owned();
        Tab::new(self, session, url, width, height)
    }

    /// Sends a request, and waits for the answer.
    pub(crate) fn ask(
        &mut self,
        session: Option<&str>,
        method: &str,
        what: &Value,
    ) -> Result<Value, BrowserError> {
        self.asked += 1;
        let id = self.asked;
        let mut question = json!({ "id": id, "method": method, "params": what });
        if let Some(session) = session {
            question["sessionId"] = json!(session);
        }
        self.socket
            .send(Message::text(question.to_string()))
            .map_err(|error| BrowserError::Answer(error.to_string()))?;
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            if let Some(answer) = self.answers.remove(&id) {
                return match answer.get("error") {
                    Some(error) => Err(BrowserError::Answer(format!("{method}: {error}"))),
                    None => Ok(answer["result"].clone()),
                };
            }
            self.listen()?;
        }
        Err(BrowserError::Answer(format!("{method}: no answer within a minute")))
    }

    /// Takes received messages, or waits a moment for them.
    pub(crate) fn listen(&mut self) -> Result<(), BrowserError> {
        match self.socket.read() {
            Ok(Message::Text(text)) => {
                let label: Value =
                    serde_json::from_str(&text).map_err(|error| BrowserError::Answer(error.to_string()))?;
                if let Some(id) = label["id"].as_u64() {
                    self.answers.insert(id, label);
                } else {
                    let text = |key: &str| label[key].as_str().unwrap_or_default().to_owned();
                    self.events.push((text("sessionId"), text("method"), label["params"].clone()));
                }
                Ok(())
            }
            Ok(_) => Ok(()),
            Err(tungstenite::Error::Io(error))
                if matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut) =>
            {
                Ok(())
            }
            Err(error) => Err(BrowserError::Answer(error.to_string())),
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.socket.send(Message::text(json!({ "id": 0, "method": "Browser.close" }).to_string()));
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(3) && matches!(self.child.try_wait(), Ok(None)) {
            std::thread::sleep(LOOK);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.directory);
    }
}
