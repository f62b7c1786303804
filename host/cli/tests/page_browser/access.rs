//! `access`: browser tests of who can use the page: the Tab key alone reaches everything that can be pressed
//! or set, and axe-core finds nothing, where `AXE_CORE` names its file (`npm pack axe-core`,
//! `package/axe.min.js`).

use page_browser::{Browser, Tab};

use crate::no_errors;
use crate::program::Program;

const TABS: [&str; 7] = ["why", "match", "health", "control", "cases", "bench", "tune"];

/// What can be pressed or set and is seen now.
const WANTED: &str = "(() => {
  const all = [...document.querySelectorAll('a[href], button, input, select, summary, textarea, [tabindex]')];
  const seen = (e) => e.checkVisibility({ visibilityProperty: true }) && !e.disabled && e.getClientRects().length > 0;
  window.wanted = all.filter(seen);
  window.reached = new Set();
  if (!window.listens) addEventListener('focusin', (event) => reached.add(event.target));
  window.listens = true;
  document.activeElement?.blur();
  return wanted.length;
})()";

const MISSED: &str = "wanted.filter((e) => e.isConnected && !reached.has(e)).map((e) => e.outerHTML.slice(0, 120)).join('\\n')";

fn play() -> Program {
    Program::play(&["--seed", "2"])
}

fn show(tab: &mut Tab<'_>, name: &str) {
    tab.eval(&format!("document.querySelector('[data-tab={name}]').click()")).unwrap();
    tab.wait(&format!("!document.getElementById('tab-{name}').hidden")).unwrap();
    // The first round asks the program for lists, the second shows the answers.
    for _ in 0..2 {
        tab.eval("onetwo.refresh()").unwrap();
        tab.wait("onetwo.requests() === 0").unwrap();
    }
    tab.eval("onetwo.refresh()").unwrap();
}

#[test]
fn the_tab_key_reaches_everything_that_can_be_pressed_or_set() {
    let mut browser = Browser::start().unwrap();
    let program = play();
    let mut tab = browser.open(&program.url("?theme=dark"), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12 && onetwo.store.scene.t > 8").unwrap();
    // What changes while it is counted cannot be compared.
    tab.eval("document.querySelector('[data-tab=control]').click()").unwrap();
    tab.wait("document.getElementById('pause')").unwrap();
    tab.click("#pause").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();
    for name in TABS {
        show(&mut tab, name);
        let wanted = tab.eval(WANTED).unwrap().as_u64().unwrap();
        assert!(wanted > 20, "{name}: {wanted}");
        for _ in 0..wanted + 20 {
            tab.key("Tab").unwrap();
        }
        assert_eq!(tab.eval(MISSED).unwrap(), "", "{name}");
        let stayed = tab.eval("wanted.filter((e) => e.isConnected).length").unwrap().as_u64().unwrap();
        assert!(stayed * 10 > wanted * 9, "{name}: {stayed} of {wanted} stayed");
    }
    no_errors(&mut tab);
}

#[test]
fn axe_core_finds_nothing_in_both_themes_and_on_a_narrow_screen() {
    let Some(file) = std::env::var_os("AXE_CORE") else {
        eprintln!("not run: AXE_CORE names no axe.min.js");
        return;
    };
    let axe = std::fs::read_to_string(file).unwrap();
    let mut browser = Browser::start().unwrap();
    let program = play();
    let mut tab = browser.open(&program.url("?theme=dark"), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12 && onetwo.store.scene.t > 8").unwrap();
    tab.eval(&format!("(() => {{ {axe}; return typeof axe; }})()")).unwrap();
    // A case on the workbench, so that its parts are there.
    tab.eval("document.querySelector('[data-tab=bench]').click()").unwrap();
    tab.wait("document.querySelector('#bench-case option')").unwrap();
    tab.click("#bench-open-case").unwrap();
    tab.wait("onetwo.workbench.sheet?.text.includes('intent')").unwrap();
    let run = "axe.run(document, { resultTypes: ['violations'] }).then((found) => found.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.html.slice(0, 160)).join(' | ')}`).join('\\n'))";
    // A picture without words is found: it looks at what is there.
    tab.eval("document.body.append(Object.assign(new Image(), { id: 'wordless' }))").unwrap();
    assert!(tab.eval(run).unwrap().as_str().unwrap().contains("image-alt"));
    tab.eval("document.getElementById('wordless').remove()").unwrap();
    let (mut found, mut runs) = (Vec::new(), 0);
    for (width, phone) in [(1400, false), (390, true)] {
        tab.resize(width, 900, phone).unwrap();
        for theme in ["dark", "light"] {
            tab.eval(&format!("document.documentElement.dataset.theme = '{theme}'")).unwrap();
            for name in TABS {
                show(&mut tab, name);
                let violations = tab.eval(run).unwrap();
                runs += 1;
                let violations = violations.as_str().unwrap();
                if !violations.is_empty() {
                    found.push(format!("{name}, {theme}, {width} px: {violations}"));
                }
            }
        }
    }
    println!("{runs} runs of axe-core, {} with violations", found.len());
    assert!(found.is_empty(), "{}", found.join("\n"));
    no_errors(&mut tab);
}
