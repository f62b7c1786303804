//! `values`: tests: numbers in documents are those of the code: the budgets of docs/architecture.md §9, the
//! limits of protocol/SPEC.md, and the places that repeat them.

use std::path::Path;

use firmware_build::inspect::{Budget, STACK_BUDGET, STEP_BUDGET};
use host::radio::UNAUTHENTICATED_EVERY;
use match_tests::workspace::{Source, root};
use protocol::frame::{FRAME_LEN_MAX, OVERHEAD, PAYLOAD_LEN_MAX, Refusal, VERSION};
use protocol::host::{COMMAND_LEN_MAX, DriveLimits, PART_ROBOTS_MAX, RuleRole};
use protocol::team::{KNOWN_EPOCHS_MAX, TEAM_MESSAGE_LEN_MAX};
use protocol::{decision, host as host_messages, host_clock};

#[test]
fn budgets_of_the_architecture_are_the_codes() {
    let text = document("docs/architecture.md");
    let section = text.split("\n## ").find(|section| section.starts_with("9. Budgets")).expect("section 9");
    let rows: Vec<_> = section.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    let mut faults = Vec::new();
    for (what, budget) in budgets() {
        match rows.iter().find(|row| row.starts_with(&format!("| {what}"))) {
            None => faults.push(format!("no row begins with `{what}`")),
            Some(row) if !row.contains(&budget) => faults.push(format!("{row}\n    does not say `{budget}`")),
            Some(_) => {}
        }
    }
    assert_eq!(
        rows.len(),
        budgets().len(),
        "a row of docs/architecture.md §9 that no constant is compared with"
    );
    assert!(faults.is_empty(), "docs/architecture.md §9\n{}", faults.join("\n"));
}

#[test]
fn the_wire_format_states_the_limits_of_the_code() {
    all_stated("protocol/SPEC.md", &wire_limits());
}

#[test]
fn pages_repeat_budgets_as_they_are() {
    let (flash, step, stack) = (size(Budget::IMAGE.flash), thousands(STEP_BUDGET), thousands(STACK_BUDGET));
    all_stated("README.md", &[format!("fits into {flash} of flash")]);
    all_stated("docs/robots.md", &[format!("The budget of a step, {step} instructions")]);
    all_stated("firmware/boards/stm32/README.md", &[format!("longest step, {step}")]);
    let f407 = [format!("{stack} B allowed"), format!("{step} instructions are allowed")];
    all_stated("firmware/boards/f407/README.md", &f407);
    let Budget { flash, ram } = Budget::IMAGE;
    let heads =
        [format!("flash, of {flash} B"), format!("RAM, of {ram} B"), format!("stack, of {STACK_BUDGET} B")];
    all_stated("docs/firmware.md", &heads);
    all_stated("docs/firmware.md", &[format!("worst step, of {STEP_BUDGET} instructions")]);
}

/// A row of docs/architecture.md §9 by how it begins, and what it must contain.
fn budgets() -> Vec<(&'static str, String)> {
    let retrieval = |name| written(literal("tests/benches/retrieval/figures.rs", name));
    let motion = |name| written(literal("tests/benches/motion/figures.rs", name));
    let radio = |name| written(literal("tests/benches/radio/counts.rs", name));
    let millions = |file, name| written(literal(file, name) / 1e6);
    let game = |name| millions("xtask/src/game_cost.rs", name);
    let first_build = "xtask/src/first_build.rs";
    vec![
        (
            "one retrieval",
            format!("median ≤ {}, worst ≤ {} instructions", retrieval("MEDIAN"), retrieval("WORST")),
        ),
        (
            "the same with 10,000 stored cases",
            format!(
                "mean ≤ {} + {} per case in the ball gate, worst ≤ {}; ≥ {} × fewer than a scan",
                retrieval("FIXED"),
                retrieval("PER_GATED"),
                retrieval("LARGE_WORST"),
                retrieval("SCAN_RATIO")
            ),
        ),
        ("a stored case in flash", format!("≤ {} B on average", retrieval("BYTES"))),
        ("one brain step", format!("≤ {} instructions;", thousands(STEP_BUDGET))),
        (
            "QEMU image with all cases",
            format!("≤ {} flash, ≤ {} static RAM", size(Budget::IMAGE.flash), size(Budget::IMAGE.ram)),
        ),
        (
            "a trial of the first paper",
            format!(
                "≤ {} M instructions per simulated second",
                millions("xtask/src/trial_cost.rs", "TRIAL_SECOND_MAX")
            ),
        ),
        (
            "simulator, 11 v 11",
            format!(
                "≤ {} M instructions per simulated second",
                millions("xtask/src/example_cost.rs", "SIMULATOR_SECOND_MAX")
            ),
        ),
        (
            "6 v 6 with two full teams",
            format!("≤ {} M instructions per simulated second", game("GAME_SECOND_MAX")),
        ),
        (
            "host, 11 v 11",
            format!(
                "mean ≤ {} M, 99.9 % ≤ {} M instructions",
                game("PACKET_MEAN_MAX"),
                game("PACKET_LATE_MAX")
            ),
        ),
        (
            "one pass location rated",
            format!(
                "≤ {} instructions on the PC",
                written(literal("xtask/src/example_cost.rs", "PASS_LOCATION_MAX"))
            ),
        ),
        (
            "planned motion",
            format!(
                "without drag ≤ {} on the PC and ≤ {} on thumbv7em; with drag ≤ {};",
                motion("FREE_HOST_MAX"),
                motion("FREE_GUEST_MAX"),
                motion("DRAG_HOST_MAX")
            ),
        ),
        (
            "first build",
            format!(
                "≤ {}; ≤ {} MB",
                written(literal(first_build, "CRATES_MAX")),
                millions(first_build, "PROGRAM_MAX")
            ),
        ),
        (
            "a radio frame",
            format!(
                "≤ {} instructions to 32 B, ≤ {} to 64 B",
                radio("SHORT_FRAME_MAX"),
                radio("LONG_FRAME_MAX")
            ),
        ),
    ]
}

/// Limits as protocol/SPEC.md states them.
fn wire_limits() -> Vec<String> {
    let roles = [RuleRole::Player, RuleRole::Keeper, RuleRole::Kicker];
    let roles: Vec<_> = roles.iter().map(|role| format!("{} {role:?}", *role as u8).to_lowercase()).collect();
    let ms = |duration: protocol::Duration| duration.0 / 1_000;
    let ahead = literal("protocol/src/host_clock.rs", "AHEAD_MAX") * f64::from(1 << 6) / 1e3;
    vec![
        format!("| 1 | version, {VERSION} |"),
        format!("| n | payload, at most {PAYLOAD_LEN_MAX} |"),
        format!(
            "A frame is at most {FRAME_LEN_MAX} bytes; one with a robot's message at most {}, one with a command at most {}.",
            TEAM_MESSAGE_LEN_MAX + OVERHEAD,
            COMMAND_LEN_MAX + OVERHEAD
        ),
        format!(
            "A beacon is at most {TEAM_MESSAGE_LEN_MAX} bytes, so that a frame with it stays within {}",
            TEAM_MESSAGE_LEN_MAX + OVERHEAD
        ),
        format!("at most every {} ms for a robot", ms(UNAUTHENTICATED_EVERY)),
        format!("A frame older than {} ms is refused as stale", ms(host_clock::AGE_MAX)),
        format!("from the future by more than {ahead:.0} ms"),
        format!("A list, at most {KNOWN_EPOCHS_MAX}, of:"),
        format!("cut into parts of at most {} bytes", decision::PART_LEN),
        format!("part < parts ≤ {}, else ignored", decision::PARTS_MAX),
        format!("part < parts ≤ {}, else refused", host_messages::PARTS_MAX),
        format!("list, at most {PART_ROBOTS_MAX} (fewer"),
        format!("| refused | {} × fixed u16 |", Refusal::KINDS),
        format!("role under the rules ({}), directive", roles.join(", ")),
        format!("greatest speed, mm/s, at least {}", DriveLimits::SPEED_MIN),
        format!(
            "greatest acceleration, mm/s², at least {}; {}: the robot's own",
            DriveLimits::ACCELERATION_MIN,
            DriveLimits::NONE
        ),
    ]
}

fn document(path: &str) -> String {
    Source::read(&root().join(path)).text
}

/// Fails where a document lacks one of these; how its lines are wrapped does not matter.
fn all_stated(path: &str, wanted: &[String]) {
    let text = document(path).split_whitespace().collect::<Vec<_>>().join(" ");
    let missing: Vec<_> = wanted.iter().filter(|wanted| !text.contains(*wanted)).collect();
    assert!(missing.is_empty(), "{path} does not state, as the code does, {missing:#?}");
}

/// The value of a constant of a program or bench, which no other crate can name: a number, or a product.
fn literal(path: &str, name: &str) -> f64 {
    let source = Source::read(Path::new(&root().join(path)));
    let declares = format!("const {name}: ");
    let value = source.text.lines().find_map(|line| {
        let (_, value) = line.split_once(&declares)?.1.split_once(" = ")?;
        let factors = value.trim_end_matches(';').replace('_', "");
        factors.split(" * ").map(|factor| factor.parse::<f64>().ok()).product::<Option<f64>>()
    });
    value.unwrap_or_else(|| panic!("{path}: no constant `{name}` with a number"))
}

/// As documents write numbers: thousands apart, decimals only where there are any.
fn written(value: f64) -> String {
    if value.fract() == 0.0 { thousands(value as u32) } else { value.to_string() }
}

fn thousands(value: u32) -> String {
    if value < 1_000 {
        value.to_string()
    } else {
        format!("{},{:03}", thousands(value / 1_000), value % 1_000)
    }
}

/// Bytes, in KiB where they are whole ones.
fn size(bytes: u64) -> String {
    if bytes.is_multiple_of(1_024) {
        format!("{} KiB", bytes / 1_024)
    } else {
        format!("{} B", thousands(bytes as u32))
    }
}

#[test]
fn numbers_are_written_as_in_documents() {
    assert_eq!([1.5, 12.0, 1_500.0, 1_234_005.0].map(written), ["1.5", "12", "1,500", "1,234,005"]);
    assert_eq!([48 * 1_024, 14_750].map(size), ["48 KiB", "14,750 B"]);
    assert!(literal("xtask/src/first_build.rs", "CRATES_MAX") > 100.0);
}
