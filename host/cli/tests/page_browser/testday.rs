//! `testday`: browser tests of what a test day needs: a robot's kicker is tested, fitted and its gain taken;
//! a moment of the simulated field is kept, returned to, saved and loaded; a recording is sent as the page
//! plays it.

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use page_browser::{Browser, Tab};
use ssl::Message as _;
use ssl::vision::WrapperPacket;

use crate::program::Program;
use crate::{no_errors, number};

fn open<'b>(browser: &'b mut Browser, program: &Program, tab: &str) -> Tab<'b> {
    let mut tab = browser.open(&program.url(&format!("?theme=light&tab={tab}")), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12").unwrap();
    tab
}

#[test]
fn a_kicker_is_tested_on_the_page_and_its_gain_is_taken() {
    let program = Program::play(&["--world", "weak-kickers", "--seed", "2", "--speed", "5"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "tune");
    tab.wait("document.querySelectorAll('#kicks-blue option').length === 6").unwrap();
    // By keys: the last robot is chosen at first.
    tab.eval("document.querySelector('[data-kicks=blue]').focus()").unwrap();
    tab.key("Enter").unwrap();
    tab.wait("onetwo.store.matchEvents.some((e) => e.words.includes('the kicker of robot 5 is tested'))")
        .unwrap();
    // Why its robots do what they do is told as it is.
    tab.wait(
        "onetwo.store.scene.robots.find((r) => r.team === 'blue' && r.id === 1).mind.why === 'a kicker is tested'")
    .unwrap();
    tab.wait("document.querySelector('[data-kicks-state=done]')").unwrap();
    assert_eq!(
        tab.eval("document.querySelectorAll('[data-kicks-state] tbody tr').length").unwrap().as_f64(),
        Some(10.0)
    );
    let fitted =
        "Number(document.querySelector('[data-kicks-state]').textContent.match(/Gain ([0-9.]+)/)[1])";
    let fitted = tab.eval(fitted).unwrap().as_f64().unwrap();
    assert!((0.4..0.95).contains(&fitted), "{fitted}: a weak kicker");
    tab.click("[data-kicks-take=blue]").unwrap();
    let taken = format!("document.getElementById('tune-blue-calibration-kick-5')?.value === '{fitted}'");
    tab.wait(&taken).unwrap();
    tab.wait(
        "decodeURIComponent(document.querySelector('a[download=\"team-blue.toml\"]').href).includes('robot = 5')")
    .unwrap();
    tab.click("[data-kicks-end=blue]").unwrap();
    tab.wait("!document.querySelector('[data-kicks-state]')").unwrap();
    no_errors(&mut tab);
}

#[test]
fn a_moment_is_kept_returned_to_and_loaded_from_its_file() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "control");
    tab.wait("onetwo.store.scene.robots.some((r) => Math.hypot(...r.velocity) > 0.3)").unwrap();
    tab.click("#snapshot-keep").unwrap();
    tab.wait("document.querySelector('[data-return=\"0\"]')").unwrap();
    let kept = "fetch('/api/snapshots').then((a) => a.json()).then((all) => { window.kept = all; return all.length; })";
    assert_eq!(tab.eval(kept).unwrap().as_f64(), Some(1.0));
    tab.wait("onetwo.store.latest.t > kept[0].t + 4").unwrap();
    // Paused, so that it is seen where it was put.
    tab.click("#pause").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();
    tab.click("[data-return=\"0\"]").unwrap();
    tab.eval("onetwo.setLayer('truth', true)").unwrap();
    let back = "(() => { const shapes = onetwo.store.latest.layers.find((l) => l.name === 'truth').shapes; \
        const near = (at) => shapes.some((s) => Math.hypot(s.at[0] - at[0], s.at[1] - at[1]) < 0.002); \
        return kept[0].robots.every((r) => near(r.at)) && near(kept[0].ball.at); })()";
    tab.wait(back).unwrap();
    // Its file, changed by hand: the ball lies elsewhere; and one that is none is refused.
    let load = |change: &str| {
        format!(
            "(() => {{ const one = JSON.parse(decodeURIComponent(document.querySelector('[download=\"snapshot-0.json\"]').href.split(',').slice(1).join())); {change}; \
             const files = new DataTransfer(); files.items.add(new File([JSON.stringify(one)], 'snapshot.json')); \
             const input = document.getElementById('snapshot-file'); input.files = files.files; input.dispatchEvent(new Event('change')); }})()"
        )
    };
    tab.eval(&load("one.ball.at = [1.5, -1]; one.ball.velocity = [0, 0]")).unwrap();
    tab.wait("document.querySelector('[data-return=\"1\"]')").unwrap();
    tab.click("[data-return=\"1\"]").unwrap();
    tab.wait(
        "(() => { const at = onetwo.store.latest.layers.find((l) => l.name === 'truth').shapes.at(-1).at; return Math.hypot(at[0] - 1.5, at[1] + 1) < 0.01; })()")
    .unwrap();
    tab.eval(&load("one.league = 'ssl-2013'")).unwrap();
    tab.wait("/the snapshot is of ssl-2013/.test(document.getElementById('note').textContent)").unwrap();
    no_errors(&mut tab);
}

#[test]
fn a_skill_is_tried_beside_the_match_and_counted() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "control");
    tab.wait("document.querySelector('#skill-skill option')").unwrap();
    tab.eval(
        "(() => { const set = (id, value) => { const one = document.getElementById(id); one.value = value; one.dispatchEvent(new Event('change')); }; \
         set('skill-skill', 'get-ball'); set('skill-tries', '6'); })()",
    )
    .unwrap();
    tab.click("#skill-try").unwrap();
    tab.wait(
        "document.querySelector('[data-tries-over=true]')?.textContent.match(/^[0-6] of 6 tries succeeded/)",
    )
    .unwrap();
    tab.wait("document.querySelector('#skill-result tbody td').textContent === 'get-ball'").unwrap();
    no_errors(&mut tab);
}

#[test]
fn a_robot_driven_by_hand_stands_when_the_page_is_silent_and_in_a_halt() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "control");
    tab.wait("document.querySelectorAll('#hand-robot option').length === 12").unwrap();
    tab.click("[data-command=FORCE_START]").unwrap();
    tab.wait("onetwo.store.newest.game.phase === 'run'").unwrap();
    tab.eval("document.getElementById('hand-robot').value = 'blue 3'").unwrap();
    let robot = "onetwo.store.newest.robots.find((r) => r.team === 'blue' && r.id === 3)";
    let moves =
        format!("Math.hypot(...{robot}.velocity) > 0.35 && {robot}.mind.why === 'a robot is driven by hand'");
    let stands = "onetwo.store.newest.robots.filter((r) => r.team === 'blue').every((r) => Math.hypot(...r.velocity) < 0.05)";
    let hold = |tab: &mut Tab<'_>, kind: &str| {
        tab.eval(&format!(
            "(() => {{ const pad = document.getElementById('hand-pad'); pad.focus(); pad.dispatchEvent(new KeyboardEvent('{kind}', {{ key: 'w', bubbles: true, cancelable: true }})); }})()"
        ))
        .unwrap();
    };
    hold(&mut tab, "keydown");
    tab.wait(&moves).unwrap();
    tab.wait("/blue 3 is driven/.test(document.getElementById('hand-state').textContent)").unwrap();
    // Nothing of the hand arrives any more, though the key is held: neither orders nor a stop.
    tab.eval(
        "window.real = WebSocket.prototype.send; WebSocket.prototype.send = function (text) { if (!text.includes('drive')) real.call(this, text); }",
    )
    .unwrap();
    tab.wait(stands).unwrap();
    // It comes back, is halted with the key still held, and goes on after a force start.
    tab.eval("WebSocket.prototype.send = real").unwrap();
    tab.wait(&moves).unwrap();
    tab.click("[data-command=HALT]").unwrap();
    hold(&mut tab, "keydown");
    tab.wait(&format!("onetwo.store.newest.game.phase === 'halt' && {stands}")).unwrap();
    tab.wait("/waits for force start/.test(document.getElementById('hand-state').textContent)").unwrap();
    tab.click("[data-command=FORCE_START]").unwrap();
    hold(&mut tab, "keydown");
    tab.wait(&moves).unwrap();
    // A release stops it.
    hold(&mut tab, "keyup");
    tab.wait(stands).unwrap();
    // Which one is it: it turns to and fro on its place, while the button is held.
    tab.eval(&format!("window.seen = []; window.from = {robot}.at; window.look = setInterval(() => window.seen.push({robot}.heading), 40)")).unwrap();
    tab.eval("document.querySelector('[data-hand=show]').dispatchEvent(new PointerEvent('pointerdown', { bubbles: true }))").unwrap();
    tab.wait("Math.max(...seen) - Math.min(...seen) > 0.5 && seen.length > 50").unwrap();
    assert!(number(&mut tab, &format!("Math.hypot({robot}.at[0] - from[0], {robot}.at[1] - from[1])")) < 0.1);
    tab.eval("document.querySelector('[data-hand=show]').dispatchEvent(new PointerEvent('pointerup', { bubbles: true })); clearInterval(look)").unwrap();
    tab.wait(stands).unwrap();
    // The coach takes it back.
    tab.click("#hand-end").unwrap();
    tab.wait(&format!("{robot}.mind.why !== 'a robot is driven by hand'")).unwrap();
    no_errors(&mut tab);
}

#[test]
fn a_moment_is_played_on_from_a_recording_and_from_a_match() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../protocol/ssl/tests/data/grsim_divB_22s.log.gz");
    let mut browser = Browser::start().unwrap();
    for arguments in [&["replay", log, "--watch"][..], &["play", "--seed", "2"][..]] {
        let program = Program::start(&[arguments, &["--listen", "127.0.0.1:0"]].concat());
        let mut tab = open(&mut browser, &program, "control");
        // Half a second of the moment's past is needed.
        tab.wait("onetwo.store.latest.t > 2").unwrap();
        tab.wait("document.querySelector('#playon-tries')").unwrap();
        tab.eval("document.querySelector('#playon-tries').value = '3'").unwrap();
        tab.click("#playon-begin").unwrap();
        tab.wait("document.querySelector('[data-playon-over=true]')").unwrap();
        let text = tab.eval("document.querySelector('[data-playon-over]').textContent").unwrap();
        assert!(text.as_str().unwrap().starts_with("3 of 3 tries of 20 s from"), "{arguments:?}: {text}");
        assert!(!text.as_str().unwrap().contains("ended:"), "{arguments:?}: {text}");
        let rows = tab.eval("document.querySelectorAll('#playon-result tbody tr').length").unwrap();
        assert_eq!(rows.as_f64(), Some(3.0));
        no_errors(&mut tab);
    }
}

/// Packets that a port of this machine receives: when the camera saw each, s.
struct Camera(UdpSocket);

impl Camera {
    /// Time of the camera in the next frame; none where nothing comes for half a second.
    fn next(&self) -> Option<f64> {
        let mut bytes = [0; 65_536];
        loop {
            let length = self.0.recv(&mut bytes).ok()?;
            let packet = WrapperPacket::decode(&bytes[..length]).expect("a packet of the vision");
            if let Some(detection) = packet.detection {
                return Some(detection.t_capture);
            }
        }
    }

    /// Drops what has come, until nothing comes any more.
    fn drain(&self) {
        assert!((0..5_000).any(|_| self.next().is_none()), "packets keep coming");
    }

    /// Drops what has come.
    fn drain_queue(&self) {
        self.0.set_nonblocking(true).expect("a socket");
        self.drain();
        self.0.set_nonblocking(false).expect("a socket");
    }

    /// Packets within a second, and the recording's time that they span, s.
    fn of_a_second(&self) -> (usize, f64) {
        let (until, first) = (Instant::now() + Duration::from_secs(1), self.next().expect("it is sent"));
        let (mut count, mut last) = (1, first);
        while Instant::now() < until {
            (count, last) = (count + 1, self.next().expect("it is sent"));
        }
        (count, last - first)
    }
}

/// Time of the camera in the first frame from a moment of the log on, s.
fn captured(log: &str, from_s: f64) -> f64 {
    let mut began_ns = None;
    let later = ssl::log::open(std::path::Path::new(log)).unwrap().filter(|record| {
        let began_ns = *began_ns.get_or_insert(record.timestamp_ns);
        (record.timestamp_ns - began_ns) as f64 * 1e-9 >= from_s
    });
    let mut frames = later.filter_map(|record| WrapperPacket::decode(&record.payload[..]).ok()?.detection);
    frames.next().unwrap().t_capture
}

#[test]
fn a_recording_is_sent_as_the_page_plays_pauses_and_seeks_it() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../protocol/ssl/tests/data/grsim_divB_22s.log.gz");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
    let to = socket.local_addr().unwrap().to_string();
    let camera = Camera(socket);
    // Slow and mostly paused: the recording of 22 s is not over before a browser is there.
    let send =
        ["--watch", "--send", "127.0.0.1", "--vision", &to, "--listen", "127.0.0.1:0", "--speed", "0.5"];
    let program = Program::start(&[&["replay", log], &send[..]].concat());
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "control");
    tab.wait("/goes out to the network/.test(document.getElementById('tab-control').textContent)").unwrap();
    tab.wait("document.getElementById('connection').textContent === 'sending'").unwrap();
    // Paused, nothing comes; the page stands where the program does.
    tab.wait("onetwo.time.playing && onetwo.time.at > 1").unwrap();
    tab.click("#play").unwrap();
    tab.wait("!onetwo.time.playing").unwrap();
    camera.drain();
    assert_eq!(camera.next(), None, "paused");
    // Another moment while paused: the packets there come next.
    tab.eval("location.hash = '#t=15.00'").unwrap();
    tab.wait("Math.abs(onetwo.store.scene.t - 15) < 0.1").unwrap();
    assert_eq!(camera.next(), None, "moved, and still paused");
    tab.click("#play").unwrap();
    let at = camera.next().expect("it is sent again");
    assert!((at - captured(log, 15.0)).abs() < 0.1, "{at} s");
    tab.click("#play").unwrap();
    tab.wait("!onetwo.time.playing").unwrap();
    // A second viewer sees the same moment, and sets another speed for all.
    let mut other = browser.open(&program.url("?theme=light"), 900, 700).unwrap();
    other.wait("onetwo.time.at > 14 && !onetwo.time.playing").unwrap();
    other.eval("(() => { const pace = document.getElementById('pace'); pace.value = '0.25'; pace.dispatchEvent(new Event('change')); })()").unwrap();
    other.wait("onetwo.time.pace === 0.25").unwrap();
    other.click("#play").unwrap();
    other.wait("onetwo.time.playing").unwrap();
    no_errors(&mut other);
    drop(other);
    let mut tab = browser.open(&program.url("?theme=light"), 900, 700).unwrap();
    tab.wait("onetwo.time.pace === 0.25 && document.getElementById('pace').value === '0.25'").unwrap();
    camera.drain_queue();
    let (packets, span_s) = camera.of_a_second();
    assert!((0.15..0.4).contains(&span_s) && packets > 5, "{packets} packets of {span_s} s in a second");
    // Back, to before what was sent.
    let [wanted, before] = [2.0, 10.0].map(|from_s| captured(log, from_s));
    tab.eval("location.hash = '#t=2.00'").unwrap();
    // An address names a moment that stands.
    tab.wait("!onetwo.time.playing").unwrap();
    tab.click("#play").unwrap();
    let back = std::iter::from_fn(|| camera.next()).find(|at| *at < before);
    assert!(back.is_some_and(|at| (at - wanted).abs() < 0.1), "{back:?} s, not {wanted}");
    no_errors(&mut tab);
}
