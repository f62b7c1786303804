//! `matches`: tests of `onetwo evaluate matches` with matches of a few seconds.

use std::fs;
use std::thread::sleep;
use std::time::Duration;

use super::common::{json, onetwo, refused, scratch, stdout_of, table, text};

const MATCHES: [&str; 2] = ["evaluate", "matches"];

/// Matches of `duration` seconds each.
fn of<'a>(duration: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&MATCHES[..], &["--duration", duration], more].concat()
}

#[test]
fn jobs_shards_and_a_kill_change_no_byte_of_matches() {
    let plan = of("3", &["--matches", "2", "--seed", "3", "--opponents", "zone,ours-with-coerce"]);
    let run = |more: &[&str]| stdout_of(&[&plan[..], more].concat());
    let whole = scratch("matches-whole");
    let reported = run(&["--jobs", "1", "--out", text(&whole)]);
    let rows = table(&whole.join("matches.csv"));
    let teams: Vec<_> = rows.iter().map(|row| (&*row["own"], &*row["opponent"])).collect();
    assert_eq!(
        teams,
        [("ours", "zone"), ("ours", "zone"), ("ours", "ours-with-coerce"), ("ours", "ours-with-coerce")]
    );
    let data = json(&whole.join("matches.json"));
    assert!(reported.contains(data["csv_hash"].as_str().expect("a hash")), "{reported}");
    for picture in ["ratios.svg", "calibration.svg"] {
        assert!(fs::read_to_string(whole.join(picture)).expect("drawn").starts_with("<svg"), "{picture}");
    }

    let (parts, merged) = (scratch("matches-parts"), scratch("matches-merged"));
    let reported = run(&["--shard", "1/2", "--jobs", "2", "--out", text(&parts)]);
    assert!(reported.contains("--merge"), "{reported}");
    let merge = [&MATCHES[..], &["--merge", text(&parts), "--out", text(&merged)]].concat();
    assert!(refused(&merge, 1).contains("missing"));
    run(&["--shard", "2/2", "--out", text(&parts)]);
    stdout_of(&merge);
    for file in ["matches.csv", "matches.json", "ratios.svg", "calibration.svg"] {
        assert_eq!(fs::read(merged.join(file)).ok(), fs::read(whole.join(file)).ok(), "{file}");
    }

    // Killed without warning once a match is over.
    let killed = scratch("matches-killed");
    let file = killed.join("trials-1-of-1.csv");
    let kept = || fs::read_to_string(&file).map_or(0, |text| text.lines().count().saturating_sub(2));
    let arguments = [&plan[..], &["--jobs", "1", "--out", text(&killed)]].concat();
    let mut child = onetwo(&arguments).stdout(std::process::Stdio::null()).spawn().expect("it starts");
    while kept() < 1 && child.try_wait().expect("a child").is_none() {
        sleep(Duration::from_millis(1));
    }
    child.kill().expect("kill -9");
    child.wait().expect("it is gone");
    assert!(kept() >= 1);
    run(&["--out", text(&killed)]);
    assert_eq!(fs::read(killed.join("matches.csv")).ok(), fs::read(whole.join("matches.csv")).ok());
}

#[test]
fn every_part_is_played_against_the_usual_team_and_reported_with_its_effect() {
    let out = scratch("matches-ablations");
    let reported = stdout_of(&of("2", &["--matches", "2", "--ablations", "--out", text(&out)]));
    let data = json(&out.join("matches.json"));
    let effects = data["effects"].as_array().expect("a list");
    for part in ["threats", "second-level", "pass-ahead", "coerce"] {
        let effect = effects.iter().find(|effect| effect["part"] == part).expect(part);
        let sides = [&effect["with"], &effect["without"]].map(|side| side.as_str().expect("a team"));
        assert!(sides.contains(&"ours") && sides[0] != sides[1], "{sides:?}");
        assert!(effect["goals"]["low"].is_number() && effect["goals"]["p"].is_number(), "{effect}");
        assert_eq!(effect["matches"], 2);
        assert!(reported.contains(&format!("| {part} | {} | {} | 2 |", sides[0], sides[1])), "{reported}");
    }
    let robin = scratch("matches-robin");
    let teams = ["--round-robin", "--opponents", "marking,idle", "--matches", "1", "--out", text(&robin)];
    let reported = stdout_of(&of("1", &teams));
    let pairs = table(&robin.join("matches.csv"));
    assert_eq!(pairs.len(), 3, "each of three against each");
    assert!(reported.contains("| points |"), "{reported}");
}

#[test]
fn a_document_takes_the_tables_between_its_markers_in_both_leagues() {
    let out = scratch("matches-document");
    let file = out.join("report.md");
    let markers =
        |name: &str| format!("<!-- {name}: written by `cargo xtask matches` -->\n<!-- end of {name} -->\n");
    fs::write(&file, format!("# Ours\n{}{}the end\n", markers("here"), markers("small"))).expect("written");
    for (league, section) in [("division-b", "here"), ("ssl-2013", "small")] {
        let directory = out.join(league);
        let own =
            ["--league", league, "--opponents", "reactive", "--matches", "1", "--out", text(&directory)];
        let document = ["--markdown", text(&file), "--section", section];
        let done = onetwo(&of("2", &[&own[..], &document].concat())).output().expect("it starts");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    }
    let document = fs::read_to_string(&file).expect("there");
    assert!(document.starts_with("# Ours\n") && document.ends_with("the end\n"), "{document}");
    assert!(document.contains("on division-b (cases ") && document.contains("| ours | reactive | 1 |"));
    assert!(document.contains("on ssl-2013 (no cases come with this league"), "{document}");
    for picture in ["here-ratios", "here-calibration", "small-ratios", "small-calibration"] {
        assert!(document.contains(&format!("(report/{picture}.svg)")), "{document}");
        assert!(out.join(format!("report/{picture}.svg")).exists(), "{picture}");
    }
    let directory = out.join("division-b");
    let again = ["--opponents", "reactive", "--matches", "1", "--out", text(&directory)];
    let lost = of("2", &[&again[..], &["--markdown", text(&file), "--section", "nowhere"]].concat());
    assert!(refused(&lost, 1).contains("there is no line `<!-- nowhere"));
}

#[test]
fn matches_that_cannot_be_played_are_reported_with_their_hint() {
    let out = scratch("matches-refused");
    let reported = |description: &[&str], code| {
        refused(&[&MATCHES[..], description, &["--out", text(&out)]].concat(), code)
    };
    let unknown = reported(&["--opponents", "reactive,best"], 2);
    assert!(
        unknown.contains("`best`") && unknown.contains("marking") && unknown.contains("ours-with-A+B"),
        "{unknown}"
    );
    assert!(reported(&["--opponents", "ours-without-luck"], 2).contains("second-level"));
    assert!(reported(&["--shard", "4/3"], 2).contains("2/3"));
    assert!(reported(&["--shard", "1/2", "--merge", "x"], 2).contains("--merge"));
    assert!(reported(&["--league", "four-legged"], 2).contains("division-b"));
    assert!(reported(&["--section", "x"], 2).contains("--markdown"));
    assert!(reported(&["--merge", "no-such-folder"], 1).contains("no-such-folder"));
    stdout_of(&of("1", &["--matches", "1", "--opponents", "idle", "--out", text(&out)]));
    let other = reported(&["--duration", "1", "--matches", "1", "--opponents", "zone"], 1);
    assert!(other.contains("teams") && other.contains("--fresh"), "{other}");
}

#[test]
fn matches_are_compared_with_the_same_ones_and_others_are_refused() {
    let plan = of("3", &["--matches", "2", "--seed", "3", "--opponents", "zone"]);
    let (first, second) = (scratch("matches-before"), scratch("matches-now"));
    stdout_of(&[&plan[..], &["--out", text(&first)]].concat());
    let compare = ["--compare", text(&first), "--out", text(&second)];
    let reported = stdout_of(&[&plan[..], &compare].concat());
    assert!(reported.contains("| ours | zone | 2 | 0 : 0 | 0 : 0 | 0.00 (0.00 to 0.00) |"), "{reported}");
    let other = of("3", &["--matches", "2", "--seed", "4", "--opponents", "zone", "--fresh"]);
    let refusal = refused(&[&other[..], &compare].concat(), 1);
    assert!(refusal.contains("holds other matches: seed 3, not 4"), "{refusal}");
}
