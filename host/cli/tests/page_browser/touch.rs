//! `touch`: touch input on a phone's screen selects and drags robots, zooms the field, and edits a case on
//! the workbench.

use page_browser::{Browser, Tab};

use crate::bench::{COPY, pixel};
use crate::program::Program;
use crate::{no_errors, number};

/// The pixel of a robot, CSS pixels.
fn robot(tab: &mut Tab<'_>, index: usize) -> [f64; 2] {
    pixel(tab, &format!("onetwo.store.scene.robots[{index}].at.map((x) => x * 1000)"))
}

#[test]
fn touch_selects_drags_zooms_and_edits_a_case() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url(""), 390, 844).unwrap();
    tab.resize(390, 844, true).unwrap();
    tab.emulate_touch().unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12").unwrap();
    // Its first press counts: what a viewer may ask for is known before the first scene is shown.
    assert_eq!(tab.eval("onetwo.store.state.powers").unwrap(), "simulation");
    tab.tap("#play").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();

    // A tap chooses a robot; a swipe puts it elsewhere.
    let chosen = "onetwo.store.chosen";
    let at = robot(&mut tab, 2);
    tab.tap_at(at).unwrap();
    tab.wait(&format!("{chosen} && {chosen}.id === onetwo.store.scene.robots[2].id")).unwrap();
    let to = [at[0] + 40.0, at[1] + 60.0];
    let aim = tab.eval(&format!("(() => {{ const b = document.getElementById('field').getBoundingClientRect(); return onetwo.camera.from([{} - b.x, {} - b.y]); }})()", to[0], to[1])).unwrap();
    tab.swipe(&[[at, to]]).unwrap();
    let off = format!(
        "Math.hypot(...onetwo.store.scene.robots[2].at.map((x, i) => x - [{}, {}][i]))",
        aim[0], aim[1]
    );
    tab.wait(&format!("{off} < 0.15")).unwrap();

    // A pinch zooms.
    let before = number(&mut tab, "onetwo.camera.scale");
    let middle = pixel(&mut tab, "[0, 0]");
    let finger = |side: f64| [[middle[0] + side * 30.0, middle[1]], [middle[0] + side * 60.0, middle[1]]];
    tab.swipe(&[finger(-1.0), finger(1.0)]).unwrap();
    let after = number(&mut tab, "onetwo.camera.scale");
    assert!((after / before - 2.0).abs() < 0.2, "{before} px/m became {after}");
    tab.swipe(&[[finger(-1.0)[1], finger(-1.0)[0]], [finger(1.0)[1], finger(1.0)[0]]]).unwrap();

    // A case is opened, its robot is put elsewhere, and that is undone.
    tab.tap("[data-tab=bench]").unwrap();
    tab.wait("document.querySelector('#bench-case option')").unwrap();
    tab.tap("#bench-open-case").unwrap();
    tab.wait("onetwo.workbench.sheet?.copies.length === 4").unwrap();
    tab.eval("document.getElementById('field').scrollIntoView()").unwrap();
    let from = pixel(&mut tab, &format!("{COPY}.robots[0].at"));
    let place = tab.eval(&format!("{COPY}.robots[0].at")).unwrap();
    tab.swipe(&[[from, [from[0] + 30.0, from[1] - 20.0]]]).unwrap();
    tab.wait("onetwo.workbench.past.length === 1").unwrap();
    assert_ne!(tab.eval(&format!("{COPY}.robots[0].at")).unwrap(), place);
    tab.tap("#bench-undo").unwrap();
    tab.wait("onetwo.workbench.past.length === 0").unwrap();
    assert_eq!(tab.eval(&format!("{COPY}.robots[0].at")).unwrap(), place);
    no_errors(&mut tab);
}
