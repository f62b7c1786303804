//! `tune`: browser test of the tab Parameters: the list is that of `control --print-config`, and a value set
//! by hand changes what the robots do.

use std::process::Command;

use page_browser::Browser;

use crate::no_errors;
use crate::program::Program;

#[test]
fn the_list_is_that_of_the_file_and_a_limit_set_on_the_page_slows_the_robots() {
    let printed = Command::new(env!("CARGO_BIN_EXE_onetwo")).args(["control", "--print-config"]).output();
    let printed = String::from_utf8(printed.unwrap().stdout).unwrap();

    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=light&tab=tune"), 1400, 900).unwrap();
    tab.wait("document.querySelectorAll('#tab-tune input').length > 10").unwrap();
    let keys = tab
        .eval("[...new Set([...document.querySelectorAll('#tab-tune .param')].map((p) => p.dataset.key.split(' ')[0]))].sort().join()")
        .unwrap();
    let keys = keys.as_str().unwrap().to_owned();
    // Every line `name = value` of the file, commented out or not, after the name of its table.
    let mut table = String::new();
    let mut written: Vec<String> = Vec::new();
    for line in printed.lines().map(|line| line.trim_start_matches("# ")) {
        if line.starts_with('[') {
            table = line.trim_matches(['[', ']']).to_owned() + ".";
        } else if let Some((name, _)) = line.split_once(" = ")
            && !name.contains(' ')
            && name != "robot"
        {
            written.push(format!("{table}{name}"));
        }
    }
    written.sort();
    assert_eq!(keys, written.join(","));

    // A search shows what has all its words, those read at the start too; an empty one shows everything.
    let shown = "[...document.querySelectorAll('#tab-tune .param')].filter((p) => p.checkVisibility()).map((p) => p.dataset.key.split(' ')[0])";
    let search = |text: &str| {
        format!(
            "(() => {{ const s = document.getElementById('tune-search'); s.value = '{text}'; s.dispatchEvent(new Event('input')); }})()"
        )
    };
    tab.eval(&search("multicast REFEREE")).unwrap();
    tab.wait(&format!("new Set({shown}).size === 1 && {shown}[0] === 'referee'")).unwrap();
    tab.eval(&search("")).unwrap();
    tab.wait(&format!("{shown}.includes('calibration.kick')")).unwrap();

    // What is refused is told, and what was set stays.
    let set = |key: &str, value: &str| {
        format!(
            "(() => {{ const b = document.querySelector('[data-key=\"{key}\"] input'); b.focus(); b.value = '{value}'; b.dispatchEvent(new Event('change')); b.blur(); }})()"
        )
    };
    tab.eval(&set("tactics", "hope")).unwrap();
    tab.wait("document.getElementById('note').textContent.includes('no tactic')").unwrap();
    // Blue is slowed down, yellow is not.
    tab.eval(
        "document.querySelector('#tune-blue-limits-speed').focus(); document.querySelector('#tune-blue-limits-speed').value = '0.4'; document.querySelector('#tune-blue-limits-speed').dispatchEvent(new Event('change')); document.querySelector('#tune-blue-limits-speed').blur()",
    )
    .unwrap();
    tab.wait("document.querySelector('#tune-blue-limits-speed').value === '0.4' && document.querySelector('#tune-blue-limits-speed').closest('.param').classList.contains('differs')").unwrap();
    tab.wait("onetwo.store.matchEvents.some((e) => e.words.includes('limits.speed is now 0.4'))").unwrap();
    tab.eval("globalThis.fastest = { blue: 0, yellow: 0 }; globalThis.from = onetwo.store.scene.t + 3; setInterval(() => { const s = onetwo.store.scene; if (s.t > from) for (const r of s.robots) fastest[r.team] = Math.max(fastest[r.team], Math.hypot(...r.velocity ?? [0, 0])); }, 50)").unwrap();
    tab.wait("onetwo.store.scene.t > from + 15").unwrap();
    let fastest = tab.eval("JSON.stringify(fastest)").unwrap();
    let fastest: serde_json::Value = serde_json::from_str(fastest.as_str().unwrap()).unwrap();
    let of = |team: &str| fastest[team].as_f64().unwrap();
    assert!(of("blue") < 0.8 && of("yellow") > 1.0, "{fastest}");
    // The text to download has the value.
    tab.wait("decodeURIComponent(document.querySelector('a[download=\"team-blue.toml\"]').href).includes('speed = 0.4')").unwrap();
    no_errors(&mut tab);
}
