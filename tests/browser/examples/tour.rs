//! Drives the page in a real browser: `tour PROGRAM pictures FOLDER` takes the documentation's screenshots,
//! `tour PROGRAM frames` reports the cost of a frame in the page's script, full and empty, in the same run.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, ExitCode, Stdio};
use std::thread;

use page_browser::{Browser, BrowserError, Tab};

type Reported<T> = Result<T, BrowserError>;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        [program, "pictures", directory] => pictures(program, Path::new(directory)),
        [program, "frames"] => frames(program),
        _ => {
            eprintln!("usage: tour PROGRAM pictures FOLDER | tour PROGRAM frames");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("tour: {error}");
            ExitCode::FAILURE
        }
    }
}

struct LayerState {
    child: Child,
    address: String,
}

impl LayerState {
    fn start(program: &str, arguments: &[&str]) -> Reported<Self> {
        let failed = |arguments: String| BrowserError::Start(format!("{program}: {arguments}"));
        let mut child = Command::new(program)
            .args(arguments)
            .args(["--listen", "127.0.0.1:0"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| failed(error.to_string()))?;
        let Some(stderr) = child.stderr.take() else { return Err(failed("says nothing".to_owned())) };
        let mut lines = BufReader::new(stderr).lines();
        let mut reported = Vec::new();
        for line in lines.by_ref().map_while(Result::ok) {
            if let Some(address) = line.strip_prefix("page     http://") {
                let address = address.to_owned();
                thread::spawn(move || lines.for_each(drop));
                return Ok(Self { child, address });
            }
            reported.push(line);
        }
        Err(failed(reported.join("\n")))
    }

    fn url(&self, more: &str) -> String {
        format!("http://{}/{more}", self.address)
    }
}

impl Drop for LayerState {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The match of the screenshots: its seed, and how long it is played before, s.
const SEED: &str = "1";
const PLAYED_S: u32 = 90;

fn pictures(program: &str, directory: &Path) -> Reported<()> {
    std::fs::create_dir_all(directory).map_err(|error| BrowserError::Answer(error.to_string()))?;
    let displayed = LayerState::start(program, &["play", "--seed", SEED, "--speed", "20"])?;
    let mut browser = Browser::start()?;
    let mut tab = browser.open(&displayed.url("?theme=dark&tab=why"), 1440, 900)?;
    tab.wait(&format!("window.onetwo?.store.latest?.t > {PLAYED_S}"))?;
    tab.eval("fetch('/api/state')")?;
    // A moment in which a case is executed and robots move: the middle of the first such play.
    tab.wait("onetwo.store.matchEvents.some((h) => h.kind === 'case')")?;
    let at = tab.eval(BUSY)?.as_f64().unwrap_or(30.0);
    let here = |tab: &mut Tab<'_>, at: f64| -> Reported<()> {
        tab.eval(&format!("location.hash = '#t={at:.2}'"))?;
        tab.wait(&format!("Math.abs(onetwo.store.scene.t - {at}) < 0.25"))?;
        thread::sleep(std::time::Duration::from_millis(400));
        Ok(())
    };
    here(&mut tab, at)?;
    take(&mut tab, &directory.join("field.png"))?;
    tab.click("#layers-open")?;
    tab.wait("document.querySelector('[data-layer=truth]')")?;
    // The list lies over the left half: the page is turned so that play is on the right.
    if tab.eval("onetwo.store.scene.ball.at[0] < 0")?.as_bool() == Some(true) {
        tab.key("f")?;
    }
    tab.eval("['pass-receive', 'believed'].forEach((name) => onetwo.setLayer(name, true))")?;
    take(&mut tab, &directory.join("layers.png"))?;
    tab.eval("['pass-receive', 'believed'].forEach((name) => onetwo.setLayer(name, false))")?;
    tab.click("#layers-open")?;
    tab.eval(
        "(document.querySelector('[data-retrieval]') ?? document.querySelector('[data-explain]')).click()",
    )?;
    tab.wait("document.querySelectorAll('#decided tbody tr').length > 0")?;
    take(&mut tab, &directory.join("why.png"))?;
    tab.click("#dialog button")?;
    for (key, name) in [("2", "match.png"), ("3", "health.png"), ("4", "control.png")] {
        tab.key(key)?;
        take(&mut tab, &directory.join(name))?;
    }
    // Cases are counted up to the shown moment.
    here(&mut tab, f64::from(PLAYED_S))?;
    tab.key("5")?;
    take(&mut tab, &directory.join("cases.png"))?;
    here(&mut tab, at)?;
    tab.key("6")?;
    tab.wait("document.querySelectorAll('#bench-case option').length > 0")?;
    // The team of the play at that moment.
    tab.eval("document.querySelector(`[data-draft=${onetwo.store.scene.cycles.find((c) => c.state === 'playing')?.team ?? 'blue'}]`).click()")?;
    tab.wait("onetwo.workbench.sheet?.copies.length === 4")?;
    take(&mut tab, &directory.join("workbench.png"))?;
    tab.key("1")?;
    tab.key("t")?;
    take(&mut tab, &directory.join("light.png"))?;
    tab.key("t")?;
    tab.resize(390, 844, true)?;
    take(&mut tab, &directory.join("phone.png"))
}

/// The time of a play in the match that was not over at once: a third of its duration.
const BUSY: &str = "(async () => {
  const all = onetwo.store.matchEvents;
  const plays = all.filter((h) => h.kind === 'case').map((h) => {
    const end = all.find((e) => e.kind === 'cycle' && e.team === h.team && e.t > h.t);
    return [h.t, end ? end.t - h.t : 0];
  });
  // Short enough that the game was not stopped during it.
  const long = plays.filter(([t, s]) => t > 8 && s < 4).sort((a, b) => b[1] - a[1])[0] ?? plays[0];
  return long[0] + long[1] * 0.4;
})()";

fn take(tab: &mut Tab<'_>, file: &Path) -> Reported<()> {
    thread::sleep(std::time::Duration::from_millis(700));
    tab.picture(file)?;
    println!("{}", file.display());
    Ok(())
}

fn frames(program: &str) -> Reported<()> {
    // Eleven a side, so that there are 22 robots.
    let displayed =
        LayerState::start(program, &["play", "--seed", SEED, "--league", "division-a", "--speed", "20"])?;
    let mut browser = Browser::start()?;
    let mut tab = browser.open(&displayed.url(""), 1440, 900)?;
    tab.wait(BUSY_FRAME)?;
    tab.eval(&format!("({FILL})()"))?;
    let reported = tab.eval("onetwo.bench(onetwo.full)")?;
    let number = |key: &str| reported[key].as_f64().unwrap_or_default();
    println!(
        "a frame with {} robots and {} layers of {} shapes, two maps among them, costs {:.1} times an empty field's: {:.3} ms and {:.3} ms \
         here, median of 15 rounds",
        number("robots"),
        number("layers"),
        number("shapes"),
        number("times"),
        number("full_ms"),
        number("empty_ms")
    );
    let parts = reported["parts"].as_array().into_iter().flatten();
    let parts = parts.filter_map(|part| Some(format!("{} {:.1}", part[0].as_str()?, part[1].as_f64()?)));
    eprintln!("each alone, in empty frames: {}", parts.collect::<Vec<_>>().join(", "));
    Ok(())
}

/// The present scene, with every layer on. Eleven a side have no cases: each team gets one of the second
/// level's size.
const FILL: &str = "() => {
  const scene = structuredClone(onetwo.store.latest);
  const named = (name) => scene.layers.find((l) => l.name === name).shapes;
  scene.robots.filter((robot) => robot.id % 3 === 1).forEach((robot, i, all) => {
    const next = all[(i + 1) % all.length].at;
    named('case-scopes').push({ is: 'ellipse', at: robot.at, radii: [0.45, 0.25], tone: 'case', fill: true, note: 'scope' });
    named('ball-path').push({ is: 'polygon', points: [robot.at, next, [next[0], next[1] - 0.2], [robot.at[0], robot.at[1] - 0.2]], tone: 'case', fill: true, note: 'leg' },
      { is: 'line', points: [robot.at, next], tone: 'case', arrow: true, dashed: false });
    named('adapted').push({ is: 'ellipse', at: robot.at, radii: [0.12, 0.12], tone: robot.team, fill: true, note: 'place' },
      { is: 'text', at: [robot.at[0], robot.at[1] + 0.2], text: `${robot.id} → 1`, tone: 'case' });
  });
  onetwo.full = scene;
}";

/// Play runs with all layers shown: maps, threats, beliefs, paths.
const BUSY_FRAME: &str = "(() => {
  const scene = window.onetwo?.store.latest;
  const full = (name) => scene.layers.find((l) => l.name === name)?.shapes.length > 3;
  return scene?.robots.length === 22 && scene.t > 10 && full('believed') && full('threats') && onetwo.layers().find((l) => l.name === 'pass-value').count > 0
    && scene.robots.filter((robot) => robot.mind?.intent.path.length > 2).length > 10;
})()";
