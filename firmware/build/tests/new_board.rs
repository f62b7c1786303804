//! `new_board`: tests: what is refused leaves nothing behind.

use std::fs;

use firmware_build::{NewBoardError, new_board};

#[test]
fn a_refused_board_leaves_no_files() {
    let copy = std::env::temp_dir().join(format!("onetwo-new-board-refused-{}", std::process::id()));
    fs::create_dir_all(copy.join("firmware/boards/there")).unwrap();
    fs::create_dir_all(copy.join("docs")).unwrap();
    let table = copy.join("docs/architecture.md");
    fs::write(&table, "| `board-there` | x |\n").unwrap();
    let refused = |name: &str, chip: &str| new_board(&copy, name, chip).unwrap_err();
    assert!(matches!(refused("there", "rp2350"), NewBoardError::Exists(_)));
    for name in ["", "A", "1a", "a_b", "a/b", "..", "a-", &"a".repeat(33)] {
        assert!(matches!(refused(name, "rp2350"), NewBoardError::Name(_)), "{name}");
    }
    assert!(matches!(refused("omni", "rp2350"), NewBoardError::Reserved(_)));
    assert!(refused("new", "z80").to_string().contains("nrf52840, rp2350, stm32f407vg, stm32h743zi"));
    fs::write(&table, "no table\n").unwrap();
    assert!(matches!(refused("new", "rp2350"), NewBoardError::NoTable(_)));
    assert!(!copy.join("firmware/boards/new").exists());
    fs::write(&table, "| `board-there` | x |\nrest\n").unwrap();
    let written = new_board(&copy, "new", "rp2350").unwrap();
    assert!(written.directory.join("src/robot.rs").is_file());
    let text = fs::read_to_string(&table).unwrap();
    assert!(
        text.starts_with("| `board-there` | x |\n| `board-new` |") && text.ends_with("\nrest\n"),
        "{text}"
    );
    assert!(matches!(refused("new", "rp2350"), NewBoardError::Exists(_)), "twice");
    fs::remove_dir_all(&copy).unwrap();
}
