//! `evidence`: what learning has left beside a library, on the workbench of the page.

use std::fs;

use page_browser::Browser;
use serde_json::json;

use crate::bench::library;
use crate::no_errors;
use crate::program::Program;

const CASE: &str = "center/one-two";

#[test]
fn evidence_of_a_case_is_shown_and_a_proposal_is_taken_and_undone() {
    let library = library("evidence");
    let beside = library.parent().unwrap();
    let record = |area: u32, plays: u32, to_goal: u32| {
        let record = json!({ "library": "1", "world": "2", "case": CASE, "symmetry": 1, "ring": "risk", "pattern": "1/1",
            "opponents": "dg", "area": area, "plays": plays, "to_goal": to_goal, "ends": { "finished": plays } });
        format!("{record}\n")
    };
    fs::write(beside.join("evidence.jsonl"), record(4, 30, 12) + &record(7, 10, 1)).unwrap();
    let change = json!({ "edit": { "case": CASE, "change": { "ball-scope": [330, 220] } },
        "text": "center/one-two: ball scope [330, 220]", "reason": "the risk ring fails", "verdict": "proposed",
        "pairs": 90, "raised": 30, "lowered": 12, "gain": 20.0 });
    fs::write(beside.join("report.json"), json!({ "changes": [change] }).to_string()).unwrap();

    let directory = library.to_str().unwrap();
    let program = Program::play(&["--library", directory, "--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=dark"), 1400, 900).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12").unwrap();
    tab.key("6").unwrap();
    tab.wait("document.querySelector('#bench-case option[value=\"center/one-two\"]')").unwrap();
    tab.eval("document.getElementById('bench-case').value = 'center/one-two'").unwrap();
    tab.click("#bench-open-case").unwrap();
    tab.wait("onetwo.workbench.sheet?.text.includes('intent')").unwrap();
    let opened = tab.eval("onetwo.workbench.sheet.text").unwrap();

    tab.click("#bench-learned").unwrap();
    tab.wait("document.getElementById('bench-told')?.textContent.startsWith('40 plays, 32.5 % to goal; 0 of them')")
        .unwrap();
    tab.wait("document.getElementById('bench-told').textContent.includes('beyond the middle')").unwrap();
    tab.wait("document.getElementById('bench-proposals').textContent.includes('the risk ring fails')")
        .unwrap();
    tab.click("[data-take]").unwrap();
    tab.wait("onetwo.workbench.sheet.text.includes('scope = [330, 220]')").unwrap();
    tab.wait("document.querySelector('[data-take]').disabled").unwrap();
    tab.click("#bench-undo").unwrap();
    tab.wait("!onetwo.workbench.sheet.text.includes('scope = [330, 220]')").unwrap();
    assert_eq!(tab.eval("onetwo.workbench.sheet.text").unwrap(), opened);
    tab.click("[data-refuse]").unwrap();
    tab.wait("document.querySelector('[data-refuse]').textContent === 'Propose again'").unwrap();
    let refused = fs::read_to_string(beside.join("refused.jsonl")).unwrap();
    assert_eq!(refused, format!("{{\"case\":\"{CASE}\",\"change\":{{\"ball-scope\":[330,220]}}}}\n"));
    tab.click("[data-refuse]").unwrap();
    tab.wait("document.querySelector('[data-refuse]').textContent === 'Refuse'").unwrap();
    assert_eq!(fs::read_to_string(beside.join("refused.jsonl")).unwrap(), "");
    no_errors(&mut tab);
    let _ = fs::remove_dir_all(beside);
}
