//! `look`: what the page looks like and how it is handled: a match that is over, a robot's card, drags, goals
//! and teams, maps, lists, keys, contrast, and a narrow screen.

use page_browser::{Browser, Tab};

use super::program::Program;
use super::{no_errors, number};

fn is(tab: &mut Tab<'_>, script: &str) -> bool {
    tab.eval(&format!("Boolean({script})")).unwrap().as_bool().unwrap()
}

/// A click on the field, at a place that the script returns in field coordinates.
fn click_field(tab: &mut Tab<'_>, at: &str) {
    let at = on_screen(tab, at);
    tab.drag(at, at).unwrap();
}

/// The place on the screen of a place on the field, CSS pixels.
fn on_screen(tab: &mut Tab<'_>, at: &str) -> [f64; 2] {
    let script = format!(
        "(() => {{ const b = document.getElementById('field').getBoundingClientRect(); const [x, y] = onetwo.camera.to({at}); return [b.x + x, b.y + y]; }})()"
    );
    let at = tab.eval(&script).unwrap();
    [0, 1].map(|i: usize| at[i].as_f64().unwrap())
}

#[test]
fn a_match_that_is_over_says_so_and_offers_what_next() {
    let program = Program::start(&[
        "play",
        "--duration",
        "6",
        "--seed",
        "4",
        "--listen",
        "127.0.0.1:0",
        "--speed",
        "10",
    ]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url(""), 1400, 900).unwrap();
    let over = "!document.getElementById('over').hidden && /^Full time [0-9]+ : [0-9]+/.test(document.getElementById('over').textContent)";
    tab.wait(over).unwrap();
    // No scene comes any more, and that is no fault: longer than a silent match is waited for.
    tab.wait("onetwo.silence() > 4000").unwrap();
    assert!(is(&mut tab, over) && is(&mut tab, "document.getElementById('lost').hidden"));
    assert!(is(&mut tab, "document.getElementById('connection').textContent === 'full time'"));
    tab.wait("document.getElementById('phase-now').textContent === 'full time'").unwrap();
    // Once more from its beginning.
    tab.click("#again").unwrap();
    tab.wait("!onetwo.time.live && onetwo.store.scene.t < 3 && document.getElementById('over').hidden")
        .unwrap();
    tab.key("l").unwrap();
    tab.wait(over).unwrap();
    // What cannot be done any more is answered.
    tab.key("4").unwrap();
    tab.click("[data-command=HALT]").unwrap();
    tab.wait("/the match is over/.test(document.getElementById('note').textContent)").unwrap();
    tab.click("#another").unwrap();
    tab.wait("onetwo.store.latest.seed === 5 && !onetwo.store.latest.over").unwrap();
    tab.wait("document.getElementById('over').hidden").unwrap();
    no_errors(&mut tab);
}

#[test]
fn robots_goals_lists_and_keys_answer_a_hand() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?theme=dark&tab=health"), 1400, 760).unwrap();
    tab.wait("window.onetwo?.store.scene?.robots.length === 12 && onetwo.store.scene.t > 3").unwrap();
    lists(&mut tab);
    tab.key("3").unwrap();
    tab.key(" ").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();
    cards(&mut tab);
    drags(&mut tab);
    space(&mut tab);
    goals_and_teams(&mut tab);
    maps(&mut tab);
    contrast(&mut tab);
    no_errors(&mut tab);
}

/// Rows that are there stay the same elements while the list grows, in the order of time.
fn lists(tab: &mut Tab<'_>) {
    tab.key("2").unwrap();
    tab.wait("document.querySelectorAll('#match-events li').length > 2").unwrap();
    tab.eval(
        "window.row = document.querySelector('#match-events li'); window.many = onetwo.store.matchEvents.length",
    )
    .unwrap();
    tab.eval("row.querySelector('button').focus()").unwrap();
    tab.wait("document.querySelector('#match-events li') !== row").unwrap();
    assert!(is(tab, "row.isConnected && document.activeElement === row.querySelector('button')"));
    assert!(is(tab, "onetwo.store.matchEvents.length > many"));
    assert!(is(tab, "onetwo.store.matchEvents.every((h, i, all) => i === 0 || all[i - 1].t <= h.t)"));
    tab.eval("document.activeElement.blur()").unwrap();
    // Jumps stop at the kinds that are shown.
    let others = "[...document.querySelectorAll('.filters button.on:not([data-kind=command])')]";
    tab.eval(&format!("window.others = {others}; others.forEach((button) => button.click())")).unwrap();
    tab.key("[").unwrap();
    let at_command = "!onetwo.time.live && onetwo.store.matchEvents.some((h) => h.kind === 'command' && Math.abs(h.t - onetwo.time.at) < 0.2)";
    tab.key(" ").unwrap();
    tab.wait(at_command).unwrap();
    tab.eval("others.forEach((button) => button.click())").unwrap();
    tab.key("l").unwrap();
    tab.wait("onetwo.time.live").unwrap();
}

/// A robot that is clicked on the field shows its card, wherever the panel stood.
fn cards(tab: &mut Tab<'_>) {
    let robot = "onetwo.store.scene.robots.filter((r) => r.team === 'yellow' && Math.hypot(r.at[0] - onetwo.store.scene.ball.at[0], r.at[1] - onetwo.store.scene.ball.at[1]) > 0.4).at(-1)";
    click_field(tab, &format!("{robot}.at"));
    let seen = "(() => {
      const card = document.querySelector('#tab-why .card.chosen');
      const [box, at] = [document.getElementById('tab-why'), card].map((e) => e.getBoundingClientRect());
      return card.dataset.robot === `${onetwo.store.chosen.team}${onetwo.store.chosen.id}` && at.height > 0 && at.top >= box.top && at.bottom <= box.bottom;
    })()";
    tab.wait(seen).unwrap();
    assert!(is(
        tab,
        "document.getElementById('tab-why').scrollHeight > document.getElementById('tab-why').clientHeight"
    ));
}

/// While the match is paused a dragged robot is drawn where the hand leaves it.
fn drags(tab: &mut Tab<'_>) {
    let before = number(tab, "onetwo.store.latest.t");
    let robot = "onetwo.store.scene.robots.find((r) => r.team === 'blue' && r.id === 2)";
    let from = on_screen(tab, &format!("{robot}.at"));
    let to = on_screen(tab, "[1.5, -1.2]");
    tab.drag(from, to).unwrap();
    tab.wait(&format!("Math.hypot({robot}.at[0] - 1.5, {robot}.at[1] + 1.2) < 0.03")).unwrap();
    assert!((number(tab, "onetwo.store.latest.t") - before).abs() < 1e-9, "no time has passed");
    // With time the host sees it there itself.
    tab.key("4").unwrap();
    for _ in 0..3 {
        let before = number(tab, "onetwo.store.latest.t");
        tab.eval("[...document.querySelectorAll('#tab-control button')].find((b) => b.textContent === '10 ticks').click()")
            .unwrap();
        tab.wait(&format!("onetwo.store.latest.t > {before} + 0.099")).unwrap();
    }
    tab.wait(
        "(() => { const r = onetwo.store.latest.robots.find((r) => r.team === 'blue' && r.id === 2); return Math.hypot(r.at[0] - 1.5, r.at[1] + 1.2) < 0.3; })()")
    .unwrap();
}

/// The space after a click pauses or resumes; on a button with visible focus it presses that.
fn space(tab: &mut Tab<'_>) {
    tab.click("#flip").unwrap();
    assert!(is(tab, "onetwo.camera.flipped"));
    tab.key(" ").unwrap();
    tab.wait("!onetwo.store.latest.paused").unwrap();
    assert!(is(tab, "onetwo.camera.flipped"), "the button is not pressed again");
    tab.eval("document.getElementById('flip').focus()").unwrap();
    tab.key(" ").unwrap();
    tab.wait("!onetwo.camera.flipped").unwrap();
    assert!(is(tab, "!onetwo.store.latest.paused"));
    tab.eval("document.activeElement.blur()").unwrap();
    tab.key(" ").unwrap();
    tab.wait("onetwo.store.latest.paused").unwrap();
}

/// Goals have the colours of who defends them; yellow robots carry a dark square, blue ones do not.
fn goals_and_teams(tab: &mut Tab<'_>) {
    let pixel = |at: &str| {
        format!(
            "(() => {{ const c = document.getElementById('field'); const [x, y] = onetwo.camera.to({at}); return [...c.getContext('2d').getImageData(Math.round(x), Math.round(y), 1, 1).data]; }})()"
        )
    };
    // Away from the middle of the goal: a keeper may stand there.
    let goal = |team: &str| {
        pixel(&format!(
            "(({{ field, game }}) => [game.teams.{team}.defends * (field.length / 2 + field.goal_depth * 0.6), field.goal_width * 0.42])(onetwo.store.scene)"
        ))
    };
    let blue = tab.eval(&goal("blue")).unwrap();
    let yellow = tab.eval(&goal("yellow")).unwrap();
    let part = |colour: &serde_json::Value, i: usize| colour[i].as_i64().unwrap();
    assert!(part(&blue, 2) > part(&blue, 0) + 20, "blue's goal: {blue}");
    assert!(part(&yellow, 0) > part(&yellow, 2) + 20, "yellow's goal: {yellow}");
    // A corner of the square, which ends 0.62 of a radius off the middle along both axes: nearer to its edge
    // a pixel may be blended. Of the robot that is farthest from the ball.
    let corner = |team: &str| {
        pixel(&format!(
            "(({{ robots, ball, field }}) => {{ const far = (r) => Math.hypot(r.at[0] - ball.at[0], r.at[1] - ball.at[1]); const r = robots.filter((r) => r.team === '{team}').sort((a, b) => far(b) - far(a))[0]; const d = Math.max(field.robot_radius, 7 / onetwo.camera.scale) * 0.45; return [r.at[0] - d, r.at[1] - d]; }})(onetwo.store.scene)"
        ))
    };
    let light = |colour: &serde_json::Value| (0..3).map(|i| part(colour, i)).sum::<i64>();
    let blue = tab.eval(&corner("blue")).unwrap();
    let yellow = tab.eval(&corner("yellow")).unwrap();
    assert!(light(&blue) > 300 && light(&yellow) < 120, "blue {blue}, yellow {yellow}");
}

/// Of two maps one is displayed, with the meaning of its colours.
fn maps(tab: &mut Tab<'_>) {
    tab.key(" ").unwrap();
    tab.eval("['pass-receive', 'pass-value'].forEach((name) => onetwo.setLayer(name, true))").unwrap();
    let shown =
        "onetwo.layers().filter((l) => l.name.startsWith('pass-') && l.shown).map((l) => l.name).join()";
    tab.wait(&format!("{shown} === 'pass-value' && !document.getElementById('legend').hidden")).unwrap();
    tab.eval("onetwo.setLayer('pass-receive', true)").unwrap();
    tab.wait(&format!("{shown} === 'pass-receive'")).unwrap();
    assert!(is(tab, "/a pass to here arrives/.test(document.getElementById('legend').textContent)"));
    assert!(is(tab, "/^[0-9.]+ %$/.test(document.getElementById('legend-most').textContent)"));
    tab.eval("onetwo.setLayer('pass-receive', false)").unwrap();
    tab.wait("document.getElementById('legend').hidden").unwrap();
}

/// Marks stand out from the field surface by 3 : 1, words from what they stand on by 4.5 : 1, in both themes.
fn contrast(tab: &mut Tab<'_>) {
    let script = "(() => {
      const style = getComputedStyle(document.documentElement);
      const part = (c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
      const light = (name) => {
        const hex = style.getPropertyValue(`--${name}`).trim();
        const [r, g, b] = [1, 3, 5].map((i) => part(parseInt(hex.slice(i, i + 2), 16) / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const ratio = (a, b) => { const [high, low] = [light(a), light(b)].sort((x, y) => y - x); return (high + 0.05) / (low + 0.05); };
      const marks = ['blue-line', 'yellow-line', 'ball', 'case', 'forbidden', 'good', 'plain', 'accent', 'warn', 'bad'];
      const pairs = marks.flatMap((mark) => ['surface', 'margin', 'panel'].map((ground) => [mark, ground, 3]));
      const words = ['text', 'dim'].flatMap((word) => ['panel', 'back', 'raised'].map((ground) => [word, ground, 4.5]));
      return [...pairs, ['line', 'surface', 3], ...words, ['blue-ink', 'blue', 4.5], ['yellow-ink', 'yellow', 4.5], ['bad-ink', 'bad', 4.5]]
        .filter(([a, b, least]) => ratio(a, b) < least).map(([a, b]) => `${a} on ${b}: ${ratio(a, b).toFixed(2)}`).join(', ');
    })()";
    for theme in ["dark", "light"] {
        tab.eval(&format!("document.documentElement.dataset.theme = '{theme}'")).unwrap();
        assert_eq!(tab.eval(script).unwrap(), "", "{theme}");
    }
}

#[test]
fn a_narrow_screen_shows_candidates_as_cards() {
    let program = Program::play(&["--seed", "2"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url(""), 390, 844).unwrap();
    tab.resize(390, 844, true).unwrap();
    tab.wait("window.onetwo?.store.scene?.ball && onetwo.store.scene.t > 5").unwrap();
    tab.eval("document.querySelector('[data-explain=blue]').click()").unwrap();
    tab.wait("document.querySelectorAll('#would-be tbody tr').length > 5").unwrap();
    let card = "(() => {
      const cells = [...document.querySelectorAll('#would-be tbody tr')][0].querySelectorAll('td');
      const [name, why] = [cells[1], cells[3]].map((cell) => cell.getBoundingClientRect());
      return why.top >= name.bottom && why.width > 250 && cells[3].dataset.head === 'why' && why.right <= 390;
    })()";
    assert!(is(&mut tab, card));
    assert!(number(&mut tab, "document.getElementById('dialog-body').scrollWidth") <= 390.0);
    no_errors(&mut tab);
}

/// Tabs whose words need more room than they have, or that stand in a second row; then parts of Health that
/// are wider than what is seen of them.
const TOO_WIDE: &str = "(() => {
  const tabs = [...document.querySelectorAll('#tabs button')];
  const full = tabs.filter((tab) => tab.scrollWidth > tab.clientWidth || tab.offsetTop !== tabs[0].offsetTop);
  const health = [...document.querySelectorAll('#tab-health, #tab-health .scroll')].filter((part) => part.scrollWidth > part.clientWidth);
  return [...full, ...health].map((one) => one.dataset.tab ?? one.getAttribute('aria-label') ?? one.id).join();
})()";

#[test]
fn tabs_and_health_have_room_from_1100_to_1600_pixels() {
    let program = Program::play(&["--seed", "2", "--league", "division-a"]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url("?tab=health"), 1440, 900).unwrap();
    tab.wait("document.querySelectorAll('#tab-health .scroll tbody tr').length > 20").unwrap();
    for width in [1100, 1280, 1366, 1440, 1600] {
        tab.resize(width, 900, false).unwrap();
        tab.wait(&format!("innerWidth === {width}")).unwrap();
        assert_eq!(tab.eval(TOO_WIDE).unwrap(), "", "{width} px");
    }
    no_errors(&mut tab);
}

#[test]
fn a_host_without_vision_says_so_on_its_page() {
    let program = Program::start(&[
        "control",
        "--robots",
        "udp://127.0.0.1:9",
        "--insecure-zero-key",
        "--vision",
        "127.0.0.1:20906",
        "--referee",
        "127.0.0.1:20903",
        "--tracker",
        "127.0.0.1:20910",
        "--listen",
        "127.0.0.1:0",
    ]);
    let mut browser = Browser::start().unwrap();
    let mut tab = browser.open(&program.url(""), 1200, 800).unwrap();
    let said = "!document.getElementById('alarms').hidden && /vision/.test(document.getElementById('alarms').textContent)";
    tab.wait(said).unwrap();
    tab.wait("/^[0-9]+ alarms?$/.test(document.getElementById('connection').textContent)").unwrap();
    assert!(
        is(&mut tab, "/--vision/.test(document.getElementById('alarms').textContent)"),
        "with the remedy"
    );
    no_errors(&mut tab);
}
