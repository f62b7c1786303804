//! `counts`: tests of what is counted and may only become less: named closures, constants named by one bare
//! word, test names that are too long.

use match_tests::workspace::{Product, Source, product, rust_sources};

#[test]
fn named_closures_become_fewer() {
    let sources = rust_sources();
    at_most(
        NAMED_CLOSURES_MAX,
        &in_product(&sources, |line| named_closure(line).is_some()),
        "make it a function or a plain expression",
    );
}

#[test]
fn constants_say_what_and_in_which_unit() {
    let sources = rust_sources();
    let bare = |line: &str| constant(line).is_some_and(|name| BARE_WORDS.contains(&name));
    at_most(
        BARE_CONSTANTS_MAX,
        &in_product(&sources, bare),
        "say what and in which unit: `RESTART_BALL_MOVED_M`",
    );
}

#[test]
fn test_names_are_at_most_80_characters_long() {
    let sources = rust_sources();
    let long: Vec<_> = sources
        .iter()
        .flat_map(|source| {
            let names = test_names(&source.text).into_iter();
            let long = names.filter(|(_, name)| name.chars().count() > TEST_NAME_LEN_MAX);
            long.map(|(number, name)| format!("{}:{number}: {name}", source.path))
        })
        .collect();
    at_most(LONG_TEST_NAMES_MAX, &long, "say in fewer words what is tested");
}

#[test]
fn closures_constants_and_tests_are_found() {
    for (line, found) in [
        ("    let near = |robot: &Robot| robot.is_near(ball);", true),
        ("let mut count: fn(u8) -> u8 = |n| n;", true),
        ("let send = move || {", true),
        ("let near = robots.iter().any(|robot| robot.is_near(ball));", false),
        ("// let near = |robot| x;", false),
    ] {
        assert_eq!(named_closure(line).is_some(), found, "{line}");
    }
    assert_eq!(constant("    pub(super) const LEFT: f32 = 0.05;"), Some("LEFT"));
    assert_eq!(constant("pub static LEFT: f32 = 0.05;"), Some("LEFT"));
    assert_eq!(constant("const fn left() -> f32 {"), None);
    assert_eq!(test_names("#[test]\n#[cfg(unix)]\nfn a_b() {}\nfn c() {}\n"), [(3, "a_b")]);
}

/// Fails where more is found than there may be; says how many there are where it became less.
fn at_most(most: usize, found: &[String], hint: &str) {
    if found.len() < most {
        println!("{} of at most {most}: lower the number", found.len());
    }
    assert!(found.len() <= most, "{} of at most {most}; {hint}\n{}", found.len(), found.join("\n"));
}

/// Places in the product whose line is one of these.
fn in_product(sources: &[Source], is_one: impl Fn(&str) -> bool) -> Vec<String> {
    let places = |file: Product<'_>| {
        let path = &file.source.path;
        let found = file.lines.iter().filter(|(_, line)| is_one(line));
        found.map(|(number, line)| format!("{path}:{number}: {}", line.trim())).collect::<Vec<_>>()
    };
    product(sources).into_iter().flat_map(places).collect()
}

/// The name of a closure that a line binds: `let NAME = |…|`.
fn named_closure(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix("let ")?;
    let (name, value) = rest.strip_prefix("mut ").unwrap_or(rest).split_once(" = ")?;
    let value = value.strip_prefix("move ").unwrap_or(value);
    value.starts_with('|').then_some(name)
}

/// The name of a constant or static that a line declares.
fn constant(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let item = match line.strip_prefix("pub") {
        Some(rest) => rest.split_once(' ')?.1,
        None => line,
    };
    let named = item.strip_prefix("const ").or_else(|| item.strip_prefix("static "))?;
    named.split_once(": ").map(|(name, _)| name)
}

/// Names of test functions, and the numbers of their lines.
fn test_names(text: &str) -> Vec<(usize, &str)> {
    let lines: Vec<_> = (1..).zip(text.lines().map(str::trim)).collect();
    let name_after = |at: usize| {
        let (number, line) = lines[at + 1..].iter().find(|(_, line)| !line.starts_with(['#', '/']))?;
        let name = line.strip_prefix("async ").unwrap_or(line).strip_prefix("fn ")?;
        Some((*number, name.split(['(', '<']).next()?))
    };
    (0..lines.len()).filter(|at| lines[*at].1 == "#[test]").filter_map(name_after).collect()
}

/// Closures that a `let` gives a name, in the product.
const NAMED_CLOSURES_MAX: usize = 714;
/// Constants of the product whose name is one of [`BARE_WORDS`].
const BARE_CONSTANTS_MAX: usize = 12;
/// Test names longer than [`TEST_NAME_LEN_MAX`].
const LONG_TEST_NAMES_MAX: usize = 0;
/// Characters of a test's name that are read at a glance.
const TEST_NAME_LEN_MAX: usize = 80;

/// Adverbs, verbs and the like: alone they say neither what a constant is nor its unit.
const BARE_WORDS: [&str; 92] = [
    "ACROSS",
    "AFTER",
    "AGAIN",
    "AHEAD",
    "ALMOST",
    "ALONG",
    "ALWAYS",
    "APART",
    "AROUND",
    "AT",
    "AWAY",
    "BACK",
    "BARELY",
    "BEFORE",
    "BEHIND",
    "BESIDE",
    "BEYOND",
    "BY",
    "CLOSE",
    "CLOSE_ENOUGH",
    "COMING",
    "DOWN",
    "EARLY",
    "ENOUGH",
    "FAR",
    "FAST",
    "FIRM",
    "FIRST",
    "FORGET",
    "FORGETS",
    "FRESH",
    "FRONT",
    "GIVE",
    "GONE",
    "HARDLY",
    "HELD",
    "HOLDS",
    "INSIDE",
    "KEEP",
    "KEEPS",
    "LAST",
    "LATE",
    "LEAST",
    "LEFT",
    "LIES",
    "LIKELY",
    "LITTLE",
    "LONG",
    "LONG_ENOUGH",
    "LOOK",
    "LOST",
    "MARGIN",
    "MOST",
    "MOVING",
    "MUCH",
    "NEAR",
    "NEARLY",
    "NEAR_ENOUGH",
    "NEVER",
    "OFF",
    "OLD",
    "ON",
    "ONCE",
    "OUT",
    "PATIENCE",
    "REACHES",
    "ROOM",
    "SAME",
    "SETTLED",
    "SHORT",
    "SLACK",
    "SLOW",
    "SOON",
    "STALE",
    "STANDS",
    "STEADY",
    "STILL",
    "STOPS",
    "STRAIGHT",
    "SURE",
    "SURELY",
    "TAKEN",
    "THERE",
    "TOGETHER",
    "TOUCH",
    "TOUCHES",
    "TURNS",
    "UP",
    "WAIT",
    "WAITS",
    "WITHIN",
    "WORTH_IT",
];
