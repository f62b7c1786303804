//! `health`: browser test of the tab Health: cameras, links over windows, the plot's cursor, and the log.

use page_browser::{Browser, Tab};

use crate::program::Program;
use crate::{no_errors, number};

fn key(tab: &mut Tab<'_>, target: &str, key: &str) {
    let press = format!(
        "document.querySelector('{target}').dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}', bubbles: true, cancelable: true }}))"
    );
    tab.eval(&press).unwrap();
}

#[test]
fn plots_have_a_cursor_and_seek_and_the_log_is_searched() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=dark&tab=health"), 1400, 900).unwrap();
    tab.wait("onetwo?.store.scene?.t > 6").unwrap();
    // Windows of a second are told for robots and cameras.
    tab.wait("onetwo.store.scene.robots.some((r) => r.vitals?.link.frames[0] > 20 && r.vitals.link.trip_ms[1] > 0)").unwrap();
    tab.wait(
        "onetwo.store.scene.cameras.length > 0 && onetwo.store.scene.cameras.every((c) => c.frames[0] > 30)",
    )
    .unwrap();
    tab.wait("document.querySelectorAll('#cameras tbody tr').length === onetwo.store.scene.cameras.length")
        .unwrap();
    // Our robots at a glance: camera and radio of each, and no fault.
    tab.wait("onetwo.store.scene.glance.length === 12 && onetwo.store.scene.glance.every((r) => r.cameras[0][1] < 500 && r.heard_ms < 500 && r.radio === r.shell)").unwrap();
    tab.wait("document.querySelectorAll('#glance tbody tr').length === 12").unwrap();
    tab.wait("/^4\\s*4\\d: \\d+ ms.*none/.test(document.querySelector('[data-glance=blue4]').closest('tr').textContent)").unwrap();
    tab.click("[data-glance=blue4]").unwrap();

    // The plot of a robot's speed: the value at the moment, then at a cursor that keys move.
    tab.eval("document.querySelector('[data-plot-robot=yellow0]').click()").unwrap();
    tab.wait(
        "/blue 0 \\d.*m\\/s, yellow 0 \\d.*m\\/s/.test(document.getElementById('plot-values').textContent)",
    )
    .unwrap();
    let at = "Number(document.getElementById('plot').getAttribute('aria-valuenow'))";
    let before = number(&mut tab, at);
    key(&mut tab, "#plot", "Home");
    key(&mut tab, "#plot", "ArrowRight");
    tab.wait(&format!("{at} < {before} - 1")).unwrap();
    tab.wait("onetwo.time.live").unwrap();
    let chosen = number(&mut tab, at);
    key(&mut tab, "#plot", "Enter");
    tab.wait(&format!("!onetwo.time.live && Math.abs(onetwo.time.at - {chosen}) < 0.2")).unwrap();
    // A pointer seeks where it clicks, and the value there is told.
    tab.eval(
        "(() => { const c = document.getElementById('plot'); c.scrollIntoView(); const b = c.getBoundingClientRect();
        c.dispatchEvent(new MouseEvent('click', { clientX: b.left + 46 + (b.width - 54) * 0.1, clientY: b.top + 40, bubbles: true })); })()",
    )
    .unwrap();
    tab.wait(&format!("!onetwo.time.live && Math.abs(onetwo.time.at - {chosen}) > 0.5")).unwrap();
    // A gauge is shown large by its name.
    tab.eval("document.querySelector('[data-large=\"vision/packets a second\"]').click()").unwrap();
    tab.wait("document.getElementById('plot-name').value === 'vision/packets a second' && document.activeElement.id === 'plot' && document.getElementById('plot-robots').hidden")
        .unwrap();

    // The log: what the program printed, searched, and its levels hidden.
    tab.wait("document.querySelectorAll('#log li').length > 0").unwrap();
    let write = |tab: &mut Tab<'_>, text: &str| {
        tab.eval(&format!(
            "(() => {{ const s = document.getElementById('log-search'); s.value = '{text}'; s.dispatchEvent(new Event('input')); }})()"
        ))
        .unwrap();
    };
    write(&mut tab, "HTTP://");
    tab.wait("[...document.querySelectorAll('#log li')].every((li) => li.textContent.includes('http://')) && document.querySelectorAll('#log li').length > 0").unwrap();
    write(&mut tab, "no such words");
    tab.wait("document.querySelectorAll('#log li').length === 0").unwrap();
    write(&mut tab, "");
    tab.wait("document.querySelectorAll('#log li.note').length > 0").unwrap();
    tab.click("[data-level=note]").unwrap();
    tab.wait("document.querySelectorAll('#log li.note').length === 0").unwrap();
    no_errors(&mut tab);
}
