//! `facts`: numbers that may stand in one place only: the robot's, contact distances, leases, ports, the
//! step's budget.

use std::collections::BTreeSet;

use firmware_build::inspect::STEP_BUDGET;
use match_tests::workspace::{Source, members, root, rust_sources};

#[test]
fn every_guarded_place_exists() {
    let places = FACTS.iter().flat_map(|fact| {
        let folders = match fact.guarded {
            Guarded::Folders(folders) => folders,
            Guarded::Linking(_) => &[],
        };
        folders.iter().chain([&fact.home]).chain(fact.other.iter().map(|(path, _)| path))
    });
    let gone: BTreeSet<_> = places.filter(|place| !root().join(place).exists()).collect();
    assert!(gone.is_empty(), "not there any more, so that nothing guards them: {gone:?}; mend FACTS");
    let folders = CODE_OF_ROBOTS.folders();
    for wanted in ["firmware/brain/src", "hil-sim/src", "host/src", "host/cli/src", "host/arena/src"] {
        assert!(folders.iter().any(|folder| folder == wanted), "{wanted} is not among {folders:?}");
    }
}

#[test]
fn a_fact_has_one_place() {
    let sources = rust_sources();
    let findings: Vec<_> = FACTS.iter().flat_map(|fact| retyped(fact, &sources)).collect();
    assert!(findings.is_empty(), "{} findings\n{}", findings.len(), findings.join("\n"));
}

#[test]
fn a_retyped_number_is_found_and_so_is_an_exception_that_nothing_needs() {
    let guarded = Guarded::Folders(&["a"]);
    let fact = |patterns, other| Fact { name: "x", patterns, guarded, home: "a/home.rs", other };
    let code = |text: &str| vec![Source { path: "a/b.rs".into(), text: text.into() }];
    let home = || Source { path: "a/home.rs".into(), text: "const X: f32 = 0.09;\n".into() };
    let found = |fact: &Fact, text: &str| {
        let mut sources = code(text);
        sources.push(home());
        retyped(fact, &sources).len()
    };
    let radius = fact(&["0.09"], &[]);
    for (text, findings) in [
        ("let a = 0.09;\nlet b = 2.0 * 0.090_0_f32;\n", 2),
        ("let a = 0.091; // 0.09\nlet b = \"0.09\";\nlet c = x0.09;\n", 0),
        ("say(\"so \\\n     far 0.09\");\nlet a = .3 + 0.09;\n", 1),
        ("#[cfg(test)]\nmod tests {\n    let a = 0.09;\n}\n", 0),
    ] {
        assert_eq!(found(&radius, text), findings, "{text}");
    }
    let brakes = fact(&["0.09", "braking: #", "BRAKE #"], &[]);
    assert_eq!(found(&brakes, "L { braking: 3.5 }\nconst BRAKE: f32 = 5.0;\nL { braking: x }\n"), 2);
    // An exception holds for its line alone, and is found when nothing needs it any more; so is a home that
    // moved.
    let gap = fact(&["0.09"], &[("a/b.rs", "GAP")]);
    assert_eq!(found(&gap, "const GAP: f32 = 0.09;\nconst GO: f32 = 0.09;\n"), 1);
    assert_eq!(found(&gap, "const GAP: f32 = 0.08;\n"), 1);
    assert_eq!(retyped(&radius, &code("")).len(), 1);
}

/// Where a fact is written as a number outside its home, and exceptions that nothing needs any more.
fn retyped(fact: &Fact, sources: &[Source]) -> Vec<String> {
    let Fact { name, patterns, guarded, home, other } = fact;
    let folders = guarded.folders();
    let mut findings = Vec::new();
    let mut needed = BTreeSet::new();
    let of_tests = |path: &str| path.ends_with("tests.rs") || path.contains("/tests/");
    let within = |path: &str| {
        folders.iter().any(|directory| path == directory || path.starts_with(&format!("{directory}/")))
    };
    for source in sources.iter().filter(|source| within(&source.path) && !of_tests(&source.path)) {
        let mut in_text = false;
        for (number, line) in source.code() {
            let code = without_texts(line, &mut in_text);
            let Some(pattern) = patterns.iter().find(|pattern| writes(&code, pattern)) else { continue };
            let exception =
                other.iter().find(|(path, description)| *path == source.path && line.contains(description));
            if source.path == *home {
                needed.insert(*home);
            } else if let Some((_, description)) = exception {
                needed.insert(*description);
            } else {
                let hint = format!("read it from {home}, or say in FACTS why it is another fact");
                findings.push(source.at(number, &format!("{name}, `{pattern}`"), &hint).to_string());
            }
        }
    }
    // The description is data: its numbers stand at keys, not in code.
    let code = (*home != ROBOT).then_some(*home);
    let description = other.iter().map(|(_, description)| *description).chain(code);
    let stale = description.filter(|description| !needed.contains(description));
    findings.extend(stale.map(|description| format!("{description}: nothing there is {name}; mend FACTS")));
    findings
}

/// A line of code without its texts; `in_text` is whether one goes on from the line before, and into the
/// next.
fn without_texts(line: &str, in_text: &mut bool) -> String {
    let (mut code, mut escaped) = (String::new(), false);
    for letter in line.chars() {
        let ends = letter == '"' && !escaped;
        escaped = *in_text && letter == '\\' && !escaped;
        if ends {
            *in_text = !*in_text;
        } else if !*in_text {
            code.push(letter);
        }
    }
    // Only an escaped end of the line goes on; anything else was no text (a quote as a character).
    *in_text &= escaped;
    code
}

/// Whether code writes a fact: a number of that value, or a name (field or constant) that gets a number
/// (`NAME #`).
fn writes(code: &str, pattern: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    if let Some(name) = pattern.strip_suffix(" #") {
        let digit = |text: &str| text.trim_start().starts_with(|c: char| c.is_ascii_digit());
        let part_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        return code.match_indices(name).any(|(at, _)| {
            let after = &code[at + name.len()..];
            // A constant's name may go on; a field's begins here.
            let field = name.ends_with(':') && !code[..at].ends_with(part_of_name) && digit(after);
            let number = |value: &str| value.split(|c| !is_part(c)).any(digit);
            let constant =
                code.contains("const ") && after.split_once('=').is_some_and(|(_, value)| number(value));
            field || (!name.ends_with(':') && constant)
        });
    }
    let value =
        |text: &str| text.replace('_', "").trim_end_matches("f32").trim_end_matches("f64").parse().ok();
    let wanted: Option<f64> = if pattern == OF_STEP { Some(f64::from(STEP_BUDGET)) } else { value(pattern) };
    code.split(|c| !is_part(c)).any(|token| wanted.is_some() && value(token) == wanted)
}

/// A fact of the robot, the league or the protocol, and where its number stands.
struct Fact {
    name: &'static str,
    /// Its number; or `NAME #`, a constant or `field: #`, a field that no number may be given to.
    patterns: &'static [&'static str],
    guarded: Guarded,
    home: &'static str,
    /// Lines where the same number is another fact.
    other: &'static [(&'static str, &'static str)],
}

/// Pattern that stands for the value of [`STEP_BUDGET`].
const OF_STEP: &str = "STEP_BUDGET";

/// Where a number means a fact.
#[derive(Clone, Copy)]
enum Guarded {
    /// In these folders and files.
    Folders(&'static [&'static str]),
    /// In each crate that links this one, and in that one itself; but for crates of tests, which write
    /// numbers down so that they can disagree.
    Linking(&'static str),
}

impl Guarded {
    fn folders(self) -> Vec<String> {
        match self {
            Self::Folders(folders) => folders.iter().map(|folder| (*folder).to_owned()).collect(),
            Self::Linking(name) => members()
                .into_iter()
                .filter(|member| member.name == name || member.linked.contains(name))
                .filter(|member| !OF_TESTS.contains(&member.name.as_str()))
                .map(|member| format!("{}/src", member.directory))
                .collect(),
        }
    }
}

/// Crates of tests.
const OF_TESTS: [&str; 3] = ["match-tests", "page-browser", "on-target"];
/// Its numbers are no code: `tests/tests/robot_spec.rs` holds them to what is built.
const ROBOT: &str = "robots/ours.toml";
const CODE_OF_ROBOTS: Guarded = Guarded::Linking("rules");
const FACTS: [Fact; 10] = [
    Fact {
        name: "the ball's radius",
        patterns: &["0.0215"],
        guarded: CODE_OF_ROBOTS,
        home: "protocol/rules/src/limits.rs",
        other: &[],
    },
    Fact {
        name: "a robot's radius",
        patterns: &["0.09"],
        guarded: CODE_OF_ROBOTS,
        home: "protocol/rules/src/limits.rs",
        other: &[
            // Half a body is misread for sure.
            ("host/src/tracking/robots.rs", "SAME_PLACE"),
            // What a robot leaves to a ball and stands off by.
            ("host/src/strategy/coach/ahead.rs", "WAITING_WITHIN_M"),
            // Nine times the noise of vision.
            ("host/src/learned/latency.rs", "MOVED_LAST_M"),
            // A share of the field between pictures.
            ("host/figures/src/sheet.rs", "let (gap, text)"),
        ],
    },
    Fact {
        name: "a robot's front or wheels",
        patterns: &["0.073", "0.0945", "0.081"],
        guarded: CODE_OF_ROBOTS,
        home: ROBOT,
        other: &[],
    },
    Fact {
        name: "a limit of motion",
        patterns: &["acceleration: #", "braking: #", "ACCELERATION #", "BRAK #"],
        guarded: CODE_OF_ROBOTS,
        home: ROBOT,
        other: &[
            // The legged robot's, of the first paper's simulator.
            ("firmware/motion/src/legged.rs", "WALK_ACCELERATION"),
            // How gently a skill closes in on a ball.
            ("firmware/brain/src/skills/wheels/get_ball.rs", "CLOSING_BRAKE"),
            // m, not m/s².
            ("firmware/motion/src/avoid/item.rs", "BRAKE_SKIN"),
            // The lowest limit that a message may name.
            ("protocol/src/host.rs", "ACCELERATION_MIN"),
            // A share of a world's acceleration.
            ("hil-sim/src/small_size/worlds/model.rs", "kick_gain"),
            // What both of two robots that close are trusted with.
            ("firmware/brain/src/actuation/bodies.rs", "BOTH_BRAKE"),
            // How gently a carried ball is brought to its place.
            ("firmware/brain/src/skills/wheels/dribble.rs", "BRAKES"),
            // The champions' robots, as their team ships them for simulation.
            ("host/study/src/drills/script.rs", "ACCELERATION_M_S2"),
            ("host/study/src/drills/script.rs", "BRAKE_M_S2"),
        ],
    },
    Fact {
        name: "the governor's speed, turn or brake",
        patterns: &["SPEED_MAX #", "TURN_MAX #", "speed: #", "turn: #", "brake: #"],
        guarded: Guarded::Folders(&[
            "firmware/brain/src/governor.rs",
            "firmware/runtime/src/wheel.rs",
            "protocol/rules/src",
        ]),
        home: ROBOT,
        other: &[],
    },
    Fact {
        name: "kicker and wheel control",
        patterns: &[
            "6.24",
            "7.1",
            "PULSE #",
            "VOLTS #",
            "PAUSE #",
            "PROPORTIONAL #",
            "INTEGRAL #",
            "_pulses: #",
            "proportional: #",
        ],
        guarded: Guarded::Folders(&[
            "firmware/brain/src",
            "firmware/runtime/src",
            "protocol/rules/src",
            "host/src/strategy",
        ]),
        home: ROBOT,
        other: &[],
    },
    Fact {
        name: "contact of robot and ball",
        patterns: &[
            "0.0135",
            "0.0145",
            "0.0285",
            "0.1115",
            "0.1215",
            "0.125",
            "0.126",
            "0.1315",
            "0.14",
            "TOUCHES_WITHIN #",
            "CENTERS #",
            "TOUCH #",
        ],
        guarded: CODE_OF_ROBOTS,
        home: "protocol/rules/src/contact.rs",
        other: &[
            // The legged robot's path to a ball.
            ("firmware/brain/src/skills/legged/get_ball.rs", "STAND_OFF"),
            // Steps between two contacts.
            ("hil-sim/src/small_size/mod.rs", "TOUCH_GAP_STEPS"),
            // A statistic.
            ("host/study/src/learning/paired.rs", "TOUCHES_Z"),
            // A number of situations.
            ("host/study/src/learning/trials/search.rs", "TOUCHED_MIN"),
            // Start and end of a path.
            ("firmware/motion/src/avoid/item.rs", "TOUCH"),
            // A speed of bodies, and an angle beside an opponent.
            ("firmware/brain/src/actuation/bodies.rs", "TOUCHES_AT"),
            ("firmware/brain/src/skills/wheels/get_ball.rs", "ASKEW_TOUCHING"),
            // From where a pushed ball rolls on by itself.
            ("firmware/brain/src/skills/wheels/place_ball.rs", "PUSHED"),
            // A share of a radius.
            ("host/src/strategy/pass/bridge.rs", "FIRST_STEP"),
            // Off the goal line: a body, and less than a ball.
            ("host/src/strategy/threat/mod.rs", "keeper_back"),
            // A ring that is drawn.
            ("host/feed/src/beliefs.rs", "RING_RADIUS_M"),
        ],
    },
    Fact {
        name: "how long a robot counts as present",
        patterns: &["PRESENCE_LEASE #", "BEACON_LEASE #"],
        guarded: Guarded::Folders(&["protocol/src", "firmware/brain/src", "host/src"]),
        home: "protocol/src/team.rs",
        other: &[],
    },
    Fact {
        name: "a port",
        patterns: &["10300", "10301", "10302", "10020", "10006", "10003", "10010", "10005", "20011"],
        guarded: Guarded::Linking("ssl"),
        home: "protocol/ssl/src/net/mod.rs",
        other: &[],
    },
    Fact {
        name: "the step's budget",
        patterns: &[OF_STEP],
        guarded: Guarded::Folders(&["firmware/build/src", "host/cli/src", "xtask/src"]),
        home: "firmware/build/src/inspect/budget.rs",
        other: &[],
    },
];
