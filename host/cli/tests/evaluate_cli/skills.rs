//! `skills`: tests of `onetwo evaluate skills`: format, and equal output for any number of threads.

use serde_json::Value;

use super::common::{refused, stdout_of};

const SKILLS: [&str; 8] =
    ["placement", "get-ball", "receive", "dribble", "turn-with-ball", "kick", "chip", "save"];

fn rows(more: &[&str]) -> (String, Vec<Value>) {
    let text = stdout_of(&[&["evaluate", "skills", "--tries", "1", "--json"], more].concat());
    let rows: Value = serde_json::from_str(&text).expect("JSON");
    (text, rows.as_array().expect("a list").clone())
}

#[test]
fn the_list_has_a_row_a_skill_with_the_agreed_keys_whatever_the_threads() {
    let (one, list) = rows(&["--jobs", "1"]);
    let (two, _) = rows(&["--jobs", "2"]);
    assert_eq!(one, two);
    let names: Vec<_> = list.iter().map(|row| row["skill"].as_str().expect("a name")).collect();
    assert_eq!(names, SKILLS);
    for row in &list {
        let keys: Vec<_> = row.as_object().expect("an object").keys().map(String::as_str).collect();
        for key in ["skill", "league", "world", "worlds", "tries", "succeeded", "time_median_s", "time_p95_s"]
        {
            assert!(keys.contains(&key), "{row}");
        }
        assert_eq!(keys.len(), 8, "{row}");
        assert_eq!((&row["league"], &row["world"]), (&"division-b".into(), &"nominal".into()));
        assert!(row["succeeded"].as_u64() <= row["tries"].as_u64());
    }
}

#[test]
fn random_worlds_are_counted_and_failures_tell_how_to_repeat_them() {
    let (_, list) = rows(&["--world", "random", "--worlds", "3", "--skill", "save,kick"]);
    assert_eq!(list.len(), 2);
    for row in &list {
        assert_eq!((row["worlds"].as_u64(), row["tries"].as_u64()), (Some(3), Some(3)));
    }
    let reported = stdout_of(&["evaluate", "skills", "--skill", "get-ball", "--tries", "4", "--failures"]);
    assert!(reported.starts_with("| skill |"), "{reported}");
    assert_eq!(reported.contains("--story"), reported.contains(" in nominal: "), "{reported}");
    assert!(refused(&["evaluate", "skills", "--skill", "luck"], 2).contains("turn-with-ball"));
    assert!(refused(&["evaluate", "skills", "--world", "mars"], 2).contains("nominal"));
}
