//! `firmware_cli`: tests of `onetwo firmware` without a target compiler and without a probe
//! (docs/case-format.md §5).

mod verb;

use std::fs;
use std::process::{Command, Output};

use protocol::frame::TeamKey;
use protocol::provision::read;
use protocol::{RobotId, TeamId};
use rules::League;

use verb::names_in;

fn onetwo(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(arguments)
        // Without probe-rs, even where one is installed.
        .env("PATH", "")
        .output()
        .expect("the program starts")
}

#[test]
fn the_page_that_is_written_is_the_one_a_robot_reads_and_its_owner_alone_may() {
    let at = names_in("page");
    let (key, page) = (at("key"), at("robot.page"));
    fs::write(&key, "000102030405060708090a0b0c0d0e0f\n").expect("a file");
    let description =
        ["firmware", "provision", "--robot", "5", "--team", "2", "--key-file", &key, "--out", &page];
    // A file that is no page stays; an existing page that is open to all is closed to others.
    fs::write(&page, "old").expect("a file");
    assert_eq!(onetwo(&description).status.code(), Some(1));
    assert_eq!(fs::read(&page).expect("it is there"), b"old");
    fs::remove_file(&page).expect("a file");
    assert!(onetwo(&description).status.success());
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        fs::set_permissions(&page, fs::Permissions::from_mode(0o644)).expect("a mode");
    }
    let reported = onetwo(&description);
    assert!(reported.status.success(), "{}", String::from_utf8_lossy(&reported.stderr));
    let who = read(&fs::read(&page).expect("the page"), false).expect("a robot can read it");
    assert_eq!((Some(who.robot), who.team, who.league), (RobotId::new(5), TeamId(2), League::DivisionB));
    let team = TeamKey(std::array::from_fn(|n| n as u8));
    assert_eq!(who.keys, team.of_robot(who.robot));
    let bytes = fs::read(&page).expect("the page");
    assert!(!bytes.windows(16).any(|window| window == team.0), "the team's key stays at home");
    assert!(
        !String::from_utf8_lossy(&reported.stdout).contains("0001020304"),
        "the key is nobody's business"
    );
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let mode = fs::metadata(&page).expect("the page").permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
}

#[test]
fn what_no_robot_could_use_is_refused_with_a_hint() {
    let at = names_in("refused");
    let (key, zeros, page) = (at("key"), at("zeros"), at("robot.page"));
    fs::write(&key, "0123").expect("a file");
    fs::write(&zeros, "0".repeat(32)).expect("a file");
    for (robot, key, description) in
        [("5", &key, "32 hexadecimal digits"), ("5", &zeros, "all zeros"), ("16", &zeros, "none of 0–15")]
    {
        let reported = onetwo(&[
            "firmware",
            "provision",
            "--robot",
            robot,
            "--team",
            "1",
            "--key-file",
            key,
            "--out",
            &page,
        ]);
        assert_eq!(reported.status.code(), Some(1));
        let printed = String::from_utf8_lossy(&reported.stderr).into_owned();
        assert!(printed.contains(description), "{printed}");
        assert!(!fs::exists(&page).expect("a directory"), "a page of {description}");
    }
}

#[test]
fn without_probe_rs_flashing_says_what_to_install() {
    let reported = onetwo(&["firmware", "flash", "--chip", "STM32H743ZITx", "--elf", "image"]);
    assert_eq!(reported.status.code(), Some(1));
    let printed = String::from_utf8_lossy(&reported.stderr).into_owned();
    assert!(
        printed.contains("probe-rs is not installed") && printed.contains("cargo install probe-rs-tools"),
        "{printed}"
    );
}

#[test]
fn a_new_board_s_wrong_name_or_chip_is_refused_and_the_known_chips_are_listed() {
    for (name, chip, description) in [
        ("mps2", "rp2350", "is there already"),
        ("Robot", "rp2350", "is no name for a board"),
        ("../x", "rp2350", "is no name for a board"),
        ("omni", "rp2350", "names something else"),
        ("mine", "stm32f103", "there are: nrf52840, rp2350, stm32f407vg, stm32h743zi"),
    ] {
        let reported = onetwo(&["firmware", "new-board", name, "--chip", chip]);
        assert_eq!(reported.status.code(), Some(1), "{name}");
        let printed = String::from_utf8_lossy(&reported.stderr).into_owned();
        assert!(printed.contains(description), "{printed}");
    }
    let boards = concat!(env!("CARGO_MANIFEST_DIR"), "/../../firmware/boards");
    assert!(!fs::exists(format!("{boards}/mine")).expect("a directory"));
}

#[test]
fn an_image_that_is_none_names_those_there_are() {
    let reported = onetwo(&["firmware", "build", "--image", "stm"]);
    let printed = String::from_utf8_lossy(&reported.stderr).into_owned();
    assert!(printed.contains("legged, omni, free, udp, or a board: f407, stm32"), "{printed}");
}

#[test]
fn wrong_words_are_wrong_usage() {
    for description in [
        &["firmware"][..],
        &["firmware", "flash", "--elf", "image"],
        &["firmware", "flash", "--page-address", "0x0"],
        &["firmware", "size", "--image", "stm"],
    ] {
        assert_eq!(onetwo(description).status.code(), Some(2), "{description:?}");
    }
}
