//! `skeleton`: tests: a new board's skeleton builds, and touches its own directory and one line elsewhere. In
//! a copy of what git knows, with crates of the registry from this workspace's target directory.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_build::inspect::{Allowed, Image, Sizes, panic_sites};
use firmware_build::{Board, ensure_target_of, new_board, target_dir, workspace_root};

/// A copy of the workspace, in git; removed with this value.
struct Copy(PathBuf);

impl Copy {
    fn new(name: &str) -> Self {
        let root = workspace_root();
        // Always the same place, so that crates built from the copy are found again.
        let copy = target_dir(&root).join("new-board").join(name);
        let _ = fs::remove_dir_all(&copy);
        let listed = git(&root, &["ls-files", "-z", "--cached", "--others", "--exclude-standard"]);
        for file in listed.split('\0').filter(|file| root.join(file).is_file()) {
            let to = copy.join(file);
            fs::create_dir_all(to.parent().unwrap()).unwrap();
            fs::copy(root.join(file), to).unwrap();
        }
        git(&copy, &["init", "--quiet"]);
        git(&copy, &["add", "--all"]);
        let me = ["-c", "user.name=test", "-c", "user.email=test@localhost"];
        git(&copy, &[&me[..], &["commit", "--quiet", "--message", "before"]].concat());
        Self(copy)
    }

    /// Lines of the files that differ from the copy: added, removed, path.
    fn changes(&self) -> Vec<(u32, u32, String)> {
        git(&self.0, &["add", "--all"]);
        let changes = git(&self.0, &["diff", "--cached", "--numstat"]);
        let line = |line: &str| {
            let [added, removed, path] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
            (added.parse().unwrap(), removed.parse().unwrap(), path.to_owned())
        };
        changes.lines().map(line).collect()
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        // A temporary directory that remains is not an error.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A firmware build in a copy, into this workspace's target directory; the arguments name what is built.
fn build(copy: &Copy, board: &Board, what: &[&str]) {
    let toolchain = ensure_target_of(&copy.0, &board.target).unwrap_or_else(|error| panic!("{error}"));
    let mut build = toolchain.cargo(&copy.0, "build");
    build.args(["--profile", "firmware", "--package", &board.package, "--target-dir"]);
    build.arg(target_dir(&workspace_root())).args(board.profile().into_iter().flatten()).args(what);
    assert!(build.status().expect("cargo starts").success(), "{} does not build", board.name);
}

fn git(directory: &Path, arguments: &[&str]) -> String {
    let output = Command::new("git").current_dir(directory).args(arguments).output().expect("git starts");
    assert!(output.status.success(), "git {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("names in UTF-8")
}

/// Builds the skeleton for `chip` in a copy, as the firmware is built; its sizes, and what changed.
fn built(chip: &str) -> (Sizes, Vec<(u32, u32, String)>) {
    let copy = Copy::new(chip);
    let name = format!("trial-{chip}");
    new_board(&copy.0, &name, chip).unwrap();
    let manifest = fs::read_to_string(copy.0.join("firmware/boards").join(&name).join("Cargo.toml")).unwrap();
    let board = Board::parse(&name, &manifest).unwrap();
    build(&copy, &board, &[]);
    let into = target_dir(&workspace_root());
    let firmware = board.firmware.unwrap();
    let image = into.join(&board.target).join("firmware").join(&firmware.image);
    let bytes = fs::read(&image).unwrap();
    let image = Image::parse(&bytes).unwrap();
    let sizes = Sizes::of(&image);
    // It may panic where every image may, and where its own list says.
    let own = format!("firmware/boards/{name}/panics.allow");
    let lists = ["firmware/panics.allow", &own].map(|list| fs::read_to_string(copy.0.join(list)).unwrap());
    // Only boards of this workspace are known as such: the trial's sites have its directory's name.
    let lists = lists.join("\n").replace(&format!("{} ", board.package), &format!("{name} "));
    let verdict = Allowed::parse(&lists).unwrap().judge(&panic_sites(&image));
    assert!(verdict.unknown.is_empty(), "{name} may panic: {:#?}", verdict.unknown);
    println!("{}: {} B flash, {} B RAM", firmware.image, sizes.flash, sizes.ram);
    assert!(sizes.flash <= firmware.flash && sizes.ram <= firmware.ram);
    (sizes, copy.changes())
}

/// Everything but the board's own directory: a row of the table of crates, and what cargo writes itself.
fn touches_one_line_elsewhere(chip: &str, changes: &[(u32, u32, String)]) {
    let own = format!("firmware/boards/trial-{chip}/");
    let elsewhere: Vec<_> =
        changes.iter().filter(|(_, _, path)| !path.starts_with(&own) && path != "Cargo.lock").collect();
    assert_eq!(elsewhere, [&(1, 0, "docs/architecture.md".to_owned())]);
    assert!(changes.len() > 8, "{changes:?}");
}

#[test]
fn a_skeleton_builds_and_touches_its_own_directory_and_one_line_elsewhere() {
    let (sizes, changes) = built("stm32f407vg");
    touches_one_line_elsewhere("stm32f407vg", &changes);
    // A whole robot, not an empty program: the brain and its cases are in it.
    assert!(sizes.flash > 100_000, "{}", sizes.flash);
}

#[test]
fn the_port_of_the_page_builds_from_the_skeleton_with_its_examples() {
    let copy = Copy::new("port");
    new_board(&copy.0, "mine", "stm32f407vg").unwrap();
    let directory = copy.0.join("firmware/boards/mine");
    let page = fs::read_to_string(copy.0.join("docs/port.md")).unwrap();
    let files = page.split("```rust ").skip(1).filter_map(|rest| rest.split("```").next()?.split_once('\n'));
    for (name, text) in files {
        fs::create_dir_all(directory.join(name).parent().unwrap()).unwrap();
        fs::write(directory.join(name), text).unwrap();
    }
    let change = page.split("```diff\n").nth(1).unwrap().split("```").next().unwrap();
    fs::write(copy.0.join("port.diff"), change).unwrap();
    git(&copy.0, &["apply", "--directory", "firmware/boards/mine", "port.diff"]);
    fs::remove_file(directory.join("build.rs")).unwrap();
    let manifest = fs::read_to_string(directory.join("Cargo.toml")).unwrap();
    build(&copy, &Board::parse("mine", &manifest).unwrap(), &["--bins", "--examples"]);
}

#[test]
#[cfg(feature = "all-skeletons")]
fn a_skeleton_for_an_stm32h743zi_builds_likewise() {
    touches_one_line_elsewhere("stm32h743zi", &built("stm32h743zi").1);
}

#[test]
#[cfg(feature = "all-skeletons")]
fn a_skeleton_for_an_rp2350_builds_likewise() {
    touches_one_line_elsewhere("rp2350", &built("rp2350").1);
}

#[test]
#[cfg(feature = "all-skeletons")]
fn a_skeleton_for_an_nrf52840_builds_likewise() {
    touches_one_line_elsewhere("nrf52840", &built("nrf52840").1);
}
