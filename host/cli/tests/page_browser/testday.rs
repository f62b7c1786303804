//! `testday`: browser test of what a test day needs: a robot's kicker is tested, fitted and its gain taken.

use page_browser::{Browser, Tab};

use crate::no_errors;
use crate::program::Program;

fn open<'b>(browser: &'b mut Browser, program: &Program, tab: &str) -> Tab<'b> {
    let mut tab = browser.open(&program.url(&format!("?theme=light&tab={tab}")), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12", 60).unwrap();
    tab
}

#[test]
fn a_kicker_is_tested_on_the_page_and_its_gain_is_taken() {
    let program = Program::start(&[
        "play",
        "--world",
        "weak-kickers",
        "--duration",
        "600",
        "--seed",
        "2",
        "--speed",
        "5",
        "--listen",
        "127.0.0.1:0",
    ]);
    let mut browser = Browser::start().unwrap();
    let mut tab = open(&mut browser, &program, "tune");
    tab.wait("document.querySelectorAll('#kicks-blue option').length === 6", 20).unwrap();
    // By keys: the last robot is chosen at first.
    tab.eval("document.querySelector('[data-kicks=blue]').focus()").unwrap();
    tab.key("Enter").unwrap();
    tab.wait("onetwo.store.matchEvents.some((e) => e.words.includes('the kicker of robot 5 is tested'))", 10)
        .unwrap();
    // Why its robots do what they do is told as it is.
    tab.wait(
        "onetwo.store.scene.robots.find((r) => r.team === 'blue' && r.id === 1).mind.why === 'a kicker is tested'",
        10,
    )
    .unwrap();
    tab.wait("document.querySelector('[data-kicks-state=done]')", 120).unwrap();
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
    tab.wait(&taken, 10).unwrap();
    tab.wait(
        "decodeURIComponent(document.querySelector('a[download=\"team-blue.toml\"]').href).includes('robot = 5')",
        5,
    )
    .unwrap();
    tab.click("[data-kicks-end=blue]").unwrap();
    tab.wait("!document.querySelector('[data-kicks-state]')", 10).unwrap();
    no_errors(&mut tab);
}
