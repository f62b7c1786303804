//! `page_browser`: browser tests of the page. A real Chromium on the built program: it loads, robots move,
//! layers switch, an explanation opens, a drag works, a recording seeks to its goal, a lost connection is
//! displayed and recovers, no error on the console.
//!
//! `cargo xtask test --only page` installs the browser where it can and runs this; plain `cargo test` does
//! without.

mod access;
mod bench;
mod evidence;
mod health;
mod look;
mod program;
#[path = "../running/mod.rs"]
mod running;
mod testday;
mod touch;
mod tune;

use page_browser::{Browser, Tab};
use program::Program;

/// No error on the browser's console.
fn no_errors(tab: &mut Tab<'_>) {
    assert_eq!(tab.errors(), Vec::<String>::new());
}

fn number(tab: &mut Tab<'_>, script: &str) -> f64 {
    tab.eval(script).unwrap().as_f64().unwrap_or_else(|| panic!("{script} is no number"))
}

#[test]
fn a_match_is_watched_asked_and_touched() {
    let program = Program::play(&["--seed", "2", "--speed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=dark"), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12").unwrap();
    tab.wait("document.getElementById('connection').dataset.state === 'live'").unwrap();

    // Robots move, and the field with them.
    tab.wait("onetwo.store.scene.game.phase !== 'halt' && onetwo.store.scene.robots.some((r) => Math.hypot(...r.velocity) > 0.3)").unwrap();
    let before = number(&mut tab, "onetwo.frames()");
    // Frames are drawn.
    tab.wait(&format!("onetwo.frames() > {before} + 2")).unwrap();
    tab.eval("(() => { const c = document.getElementById('field'); return c.getContext('2d').getImageData(c.width / 2, c.height / 2, 1, 1).data[3] })()")
        .map(|alpha| assert_eq!(alpha, 255, "the field is painted"))
        .unwrap();

    // Why: a card for each robot, and the explanation of this moment.
    tab.wait("document.querySelectorAll('#tab-why .card').length === 12").unwrap();
    tab.click("[data-robot=blue2]").unwrap();
    tab.wait("onetwo.store.chosen?.id === 2").unwrap();
    // Texts on cards change many times a second: a pressed element stays until it is released.
    let pressed = "(async () => {
      const card = document.querySelector('[data-robot=blue3]');
      card.dispatchEvent(new PointerEvent('pointerdown', { bubbles: true }));
      await new Promise((later) => setTimeout(later, 800));
      const stays = card.isConnected;
      card.dispatchEvent(new PointerEvent('pointerup', { bubbles: true }));
      return stays;
    })()";
    assert_eq!(tab.eval(pressed).unwrap().as_bool(), Some(true));
    // From the first decision that had a ball on; by the click a later one may name the reason why it had
    // no problem. What would be retrieved at this moment is there always.
    tab.wait("onetwo.store.scene.cycles.some((c) => c.team === 'blue' && c.decided?.problem)").unwrap();
    explained_now(&mut tab);

    // Layers switch, and a layer that is off draws nothing.
    tab.click("#layers-open").unwrap();
    tab.wait("document.querySelector('[data-layer=truth]')").unwrap();
    tab.click("[data-layer=truth]").unwrap();
    tab.wait("onetwo.layers().find((l) => l.name === 'truth').shown").unwrap();
    tab.click("[data-layer=keep-out]").unwrap();
    tab.wait("!onetwo.layers().find((l) => l.name === 'keep-out').shown").unwrap();

    explained_on_the_field(&mut tab);
    control(&mut tab);
    look_back(&mut tab);
    cases(&mut tab);
    no_errors(&mut tab);
}

/// The newest decision is explained. One that was replaced before its report was due is said to be unreported
/// (about one in 400): then the next one is asked for.
fn explained_now(tab: &mut Tab<'_>) {
    for _ in 0..4 {
        tab.click("[data-explain=blue]").unwrap();
        tab.wait("document.getElementById('dialog').open").unwrap();
        tab.wait("document.querySelectorAll('#would-be tbody tr').length > 5").unwrap();
        let explained = tab
            .eval("document.querySelectorAll('#decided tbody tr').length > 5 || document.getElementById('decided')?.tagName === 'P'")
            .unwrap();
        let unreported = tab.eval("document.getElementById('unreported') !== null").unwrap();
        assert_eq!(unreported.as_bool(), explained.as_bool().map(|explained| !explained));
        tab.click("#dialog button").unwrap();
        tab.wait("!document.getElementById('dialog').open").unwrap();
        if explained.as_bool() == Some(true) {
            return;
        }
    }
    panic!("four decisions in a row without a report");
}

/// What became of every case follows the running match.
fn cases(tab: &mut Tab<'_>) {
    tab.key("5").unwrap();
    tab.wait("!document.getElementById('tab-cases').hidden").unwrap();
    let counted = "/^[1-9][0-9]* decisions/.test(document.querySelector('[data-no-case=blue]')?.textContent)";
    tab.wait(counted).unwrap();
}

/// What maps and labels mean at a place is displayed where the pointer is; texts do not overlap.
fn explained_on_the_field(tab: &mut Tab<'_>) {
    tab.eval("['pass-receive', 'believed'].forEach((name) => onetwo.setLayer(name, true))").unwrap();
    tab.wait("onetwo.layers().filter((l) => ['pass-receive', 'believed'].includes(l.name)).every((l) => l.shown && l.count > 0)")
        .unwrap();
    // The best place of the map that is free of robots: over a robot the pointer selects the robot.
    let reported = "(() => {
      const { layers, robots, ball } = onetwo.store.scene;
      const heat = layers.find((l) => l.name === 'pass-receive').shapes[0];
      const free = (at) => [...robots.map((r) => r.at), ball.at].every((b) => Math.hypot(at[0] - b[0], at[1] - b[1]) > 0.5);
      const rows = heat.cells.length / heat.columns;
      const middle = (i) => [[i % heat.columns, heat.columns], [Math.floor(i / heat.columns), rows]].map(([k, n], axis) => heat.low[axis] + ((k + 0.5) / n) * (heat.high[axis] - heat.low[axis]));
      const best = heat.cells.map((value, i) => [value, i]).sort((a, b) => b[0] - a[0]).find(([, i]) => free(middle(i)));
      const [x, y] = onetwo.camera.to(middle(best[1]));
      const box = document.getElementById('field').getBoundingClientRect();
      document.getElementById('field').dispatchEvent(new PointerEvent('pointermove', { clientX: box.x + x, clientY: box.y + y, pointerId: 9 }));
      return document.getElementById('note').textContent;
    })()";
    onetwo_prints(tab, reported, "a pass to here arrives: ");
    let pointed = "(() => {
      const { layers } = onetwo.store.scene;
      const ring = layers.find((l) => l.name === 'believed').shapes.find((s) => s.is === 'ellipse');
      const [x, y] = onetwo.camera.to(ring.at);
      const box = document.getElementById('field').getBoundingClientRect();
      document.getElementById('field').dispatchEvent(new PointerEvent('pointermove', { clientX: box.x + x, clientY: box.y + y, pointerId: 9 }));
      return document.getElementById('note').textContent;
    })()";
    onetwo_prints(tab, pointed, "by its places of the last half second: goalkeeper ");
    tab.eval("['pass-receive', 'believed'].forEach((name) => onetwo.setLayer(name, false))").unwrap();
}

/// Waits until the script answers so: what is pointed at moves, and is not there in each scene.
fn onetwo_prints(tab: &mut Tab<'_>, script: &str, description: &str) {
    tab.wait(&format!("({script}).includes('{description}')")).unwrap();
}

/// Pause, single step, drag the ball, restart.
fn control(tab: &mut Tab<'_>) {
    tab.key("4").unwrap();
    tab.wait("!document.getElementById('tab-control').hidden").unwrap();
    tab.click("#pause").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();
    let still = number(tab, "onetwo.store.latest.t");
    tab.click("#step").unwrap();
    tab.wait(&format!("Math.abs(onetwo.store.latest.t - {still} - 0.01) < 0.002")).unwrap();
    let at = tab.eval("onetwo.camera.to(onetwo.store.latest.ball.at)").unwrap();
    let stage = tab.eval("(() => { const b = document.getElementById('field').getBoundingClientRect(); return [b.x, b.y] })()").unwrap();
    let spot = [0, 1].map(|i: usize| at[i].as_f64().unwrap() + stage[i].as_f64().unwrap());
    tab.click("#layers-open").unwrap();
    tab.drag(spot, [spot[0] + 120.0, spot[1] - 60.0]).unwrap();
    // A ball that is put is at once where the truth has it; the host sees it with the next camera frame.
    tab.eval("onetwo.setLayer('truth', true)").unwrap();
    tab.wait(
        &format!("(() => {{ const s = onetwo.store.latest.layers.find((l) => l.name === 'truth').shapes.at(-1).at; const p = onetwo.camera.to(s); return Math.hypot(p[0] - {} - 120, p[1] - {} + 60) < 12 }})()", at[0], at[1]))
    .unwrap();
    tab.click("#pause").unwrap();
    tab.wait("!onetwo.store.latest.paused").unwrap();
    tab.click("[data-command=HALT]").unwrap();
    tab.wait("onetwo.store.latest.game.phase === 'halt'").unwrap();
    tab.click("[data-command=FORCE_START]").unwrap();
    tab.wait("onetwo.store.latest.game.phase !== 'halt'").unwrap();
}

/// Seeks back while the match goes on, and returns to its newest moment.
fn look_back(tab: &mut Tab<'_>) {
    tab.eval("location.hash = '#t=1.00'").unwrap();
    tab.wait("!onetwo.time.live && Math.abs(onetwo.store.scene.t - 1) < 0.1").unwrap();
    tab.key("l").unwrap();
    tab.wait("onetwo.time.live && onetwo.store.scene.t > 2").unwrap();
    // What is not played yet cannot be displayed.
    tab.eval("location.hash = '#t=9999'").unwrap();
    tab.wait("onetwo.time.live && /not played yet/.test(document.getElementById('note').textContent)")
        .unwrap();
}

#[test]
fn a_recording_seeks_to_its_goal_and_to_the_moment_of_an_address() {
    // One of the third of all trials that end in a goal.
    let program = Program::start(&["trial", "--seed", "64", "--watch", "--listen", "127.0.0.1:0"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?tab=match#t=2.00"), 1200, 800).unwrap();
    tab.wait("window.onetwo?.store.scene && Math.abs(onetwo.store.scene.t - 2) < 0.1").unwrap();
    tab.wait("onetwo.store.matchEvents.some((h) => h.kind === 'goal')").unwrap();
    // From 5 s before it, with whose it is.
    let goal = "onetwo.store.matchEvents.find((h) => h.kind === 'goal')";
    tab.key("g").unwrap();
    tab.wait(&format!("Math.abs(onetwo.store.scene.t - {goal}.t + 5) < 0.2")).unwrap();
    let note = format!("document.getElementById('note').textContent.includes({goal}.words)");
    assert_eq!(tab.eval(&note).unwrap(), true);
    tab.eval(&format!("location.hash = '#t=' + {goal}.t.toFixed(2)")).unwrap();
    tab.wait(&format!("Math.abs(onetwo.store.scene.t - {goal}.t) < 0.2")).unwrap();
    assert!(number(&mut tab, "Math.abs(onetwo.store.scene.ball.at[0])") > 2.5, "the ball is in the goal");
    tab.wait("/#t=/.test(location.hash)").unwrap();
    // A moment that is no number, and one after the end: reported, and the last one is displayed.
    tab.eval("location.hash = '#t=soon'").unwrap();
    tab.wait("/names no moment/.test(document.getElementById('note').textContent)").unwrap();
    tab.eval("location.hash = '#t=9999'").unwrap();
    tab.wait("/this ends at/.test(document.getElementById('note').textContent)").unwrap();
    tab.wait(
        "Math.abs(onetwo.time.at - onetwo.store.latest.t) < 0.01 && Math.abs(onetwo.store.scene.t - onetwo.time.at) < 0.1")
    .unwrap();
    // A moment is exported as a problem that retrieval accepts.
    let line = tab
        .eval("fetch('/api/freeze', { method: 'POST', body: JSON.stringify({ t: 2, team: 'blue' }) }).then((a) => a.text())")
        .unwrap();
    let answer = program::onetwo(&["cases", "retrieve"], line.as_str().unwrap());
    assert!(answer.contains("\"candidates\""), "{answer}");
    no_errors(&mut tab);
}

#[test]
fn a_lost_connection_is_displayed_and_heals() {
    let arguments = ["play", "--duration", "600", "--seed", "3", "--listen"];
    let first = Program::start(&[&arguments[..], &["127.0.0.1:0"]].concat());
    let mut browser = Browser::start().unwrap();
    // At a telephone's width everything is within the screen.
    let mut tab = browser.open(&first.url(""), 390, 844).unwrap();
    tab.resize(390, 844, true).unwrap();
    tab.wait("window.onetwo?.store.scene").unwrap();
    assert!(number(&mut tab, "document.documentElement.scrollWidth") <= 390.0, "nothing hangs over");
    let address = first.address().to_owned();
    drop(first);
    tab.wait("!document.getElementById('lost').hidden").unwrap();
    let _second = Program::start(&[&arguments[..], &[&address]].concat());
    tab.wait("document.getElementById('lost').hidden && document.getElementById('connection').dataset.state === 'live'").unwrap();
    tab.wait("onetwo.store.scene.t > 0.5").unwrap();
    // A socket without an answer is reported by the browser itself; any other error would be ours.
    let reported: Vec<_> =
        tab.errors().into_iter().filter(|error| !error.contains("ERR_CONNECTION")).collect();
    assert_eq!(reported, Vec::<String>::new());
}

#[test]
fn the_cases_of_a_recording_are_counted_up_to_the_moment_and_open_by_key() {
    let stem = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("page-browser-cases");
    let stem = stem.to_str().unwrap();
    let trace = format!("{stem}.trace");
    let tactics = ["--blue-tactics", "none", "--yellow-tactics", "none"];
    let play = ["play", "--headless", "--duration", "60", "--seed", "5", "--record", stem];
    program::onetwo(&[&play[..], &tactics].concat(), "");
    let replayed = program::onetwo(&["replay", &trace, "--json"], "");
    let replayed: serde_json::Value = serde_json::from_str(&replayed).unwrap();
    let program = Program::start(&["replay", &trace, "--watch", "--listen", "127.0.0.1:0"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?tab=cases&theme=light#t=0.50"), 1400, 900).unwrap();
    program.wait_for("the page stays");
    // Before the first decision there is nothing to count.
    tab.wait("document.querySelector('#tab-cases')?.textContent && !document.querySelector('.case-name')")
        .unwrap();
    tab.eval("location.hash = '#t=59.90'").unwrap();
    tab.wait("document.querySelector('.case-name')").unwrap();
    for team in ["blue", "yellow"] {
        let cases = &replayed["cases"][team];
        let line = &cases["cases"][0];
        let (case, retrieved) = (line["case"].as_str().unwrap(), &line["retrieved"]);
        let row = format!(
            "document.querySelector('[data-case=\"{team} {case}\"]').closest('tr').children[1].textContent"
        );
        tab.wait(&format!("{row} === '{retrieved}'")).unwrap();
        let none = format!("document.querySelector('[data-no-case={team}]').textContent");
        assert!(tab.eval(&none).unwrap().as_str().unwrap().starts_with(&format!("{} ", cases["no_case"])));
    }
    // By key alone: another tab and back, a case, and its ends.
    tab.key("2").unwrap();
    tab.key("5").unwrap();
    tab.wait("!document.getElementById('tab-cases').hidden").unwrap();
    tab.eval("document.querySelector('.case-name').focus()").unwrap();
    tab.key("Enter").unwrap();
    let ends = &replayed["cases"]["blue"]["cases"][0]["ends"];
    let (end, n) = ends.as_object().unwrap().iter().next().unwrap();
    let described = format!("{n} {}", end.replace('-', " "));
    tab.wait(&format!("document.querySelector('[data-detail]')?.textContent.includes('{described}')"))
        .unwrap();
    assert_eq!(tab.eval("document.activeElement.getAttribute('aria-expanded')").unwrap(), "true");
    tab.key("Enter").unwrap();
    tab.wait("!document.querySelector('[data-detail]')").unwrap();
    no_errors(&mut tab);
}

#[test]
fn two_traces_are_shown_in_step_with_their_first_difference() {
    let record = |seed: &str| {
        let stem = std::env::temp_dir().join(format!("onetwo-beside-{}-{seed}", std::process::id()));
        let stem = stem.to_str().unwrap().to_owned();
        program::onetwo(&["play", "--headless", "--duration", "20", "--seed", seed, "--record", &stem], "");
        format!("{stem}.trace")
    };
    let (a, b) = (record("5"), record("6"));
    let program = Program::start(&["replay", &a, "--compare", &b, "--watch", "--listen", "127.0.0.1:0"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=dark"), 1400, 900).unwrap();
    tab.wait("onetwo?.store.matchEvents.some((e) => e.words.includes('the traces differ first here'))")
        .unwrap();
    tab.wait("onetwo.store.scene?.layers.find((l) => l.name === 'other-trace')?.shapes.filter((s) => s.is === 'ellipse').length === 13").unwrap();
    tab.wait("onetwo.layers().some((l) => l.name === 'other-trace' && l.shown && l.label.startsWith('B: '))")
        .unwrap();
    no_errors(&mut tab);
    for trace in [a, b] {
        std::fs::remove_file(trace.replace(".trace", ".log.gz")).unwrap();
        std::fs::remove_file(trace).unwrap();
    }
}
