//! `image`: freshness check of a firmware image, called before every run on QEMU.
//!
//! cargo itself decides on freshness: an up-to-date image costs one short call without output.

use std::env;
use std::io::{BufRead, BufReader, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use crate::board::smallest;
use crate::inspect::Budget;
use crate::process::{line_of, output_of};
use crate::sources::source_hash;
use crate::target::cargo_program;
use crate::{Board, TARGET, TargetError, boards, ensure_target_of};

/// Environment variable of an image's build: the hash of its sources, hexadecimal.
const SOURCE_HASH: &str = "ONETWO_IMAGE";

/// The firmware of a robot with that body for [`MACHINE`](crate::MACHINE), built first where it is missing or
/// older than its sources.
///
/// Where the sources or cargo are gone (an installed program), an existing build is used.
pub fn build_image(root: &Path, body: ImageBody) -> Result<PathBuf, BuildError> {
    build_program(root, Program::Robot(body))
}

/// Builds as [`build_image`] does, for any program of a board. An image that came with this program is used
/// as it is.
pub fn build_program(root: &Path, program: Program) -> Result<PathBuf, BuildError> {
    let own = env::current_exe().ok().and_then(|own| shipped(&own, program));
    own.map_or_else(|| build_into(&target_dir(root), root, program), Ok)
}

/// Builds as [`build_program`] does, for the robot of another description: `source` is a built-in name or an
/// absolute path, as the environment variable [`ROBOT`] takes it, `name` the robot's. The image is copied to
/// `robots/NAME` in the target directory, as the next build for another robot replaces the original.
pub fn build_for_robot(
    root: &Path,
    program: Program,
    source: &str,
    name: &str,
) -> Result<PathBuf, BuildError> {
    let target = target_dir(root);
    let built = build_as(&target, root, program, Some(source))?;
    let image = target.join("robots").join(name).join(program.name());
    let copied = image.parent().map_or(Ok(()), std::fs::create_dir_all);
    copied
        .and_then(|()| std::fs::copy(&built, &image))
        .map_err(|error| BuildError::Copy(image.clone(), error))?;
    Ok(image)
}

/// The image in the release archive of which `own` is the program.
fn shipped(own: &Path, program: Program) -> Option<PathBuf> {
    // A link in a directory of programs leads to the archive.
    let own = own.canonicalize().ok()?;
    let image = own.parent()?.parent()?.join(SHIPPED_IMAGES).join(program.name());
    image.is_file().then_some(image)
}

fn build_into(target_dir: &Path, root: &Path, program: Program) -> Result<PathBuf, BuildError> {
    build_as(target_dir, root, program, OWN_ROBOT)
}

/// Builds for the robot that `robot` names, the default where it is `None`: whatever this process was started
/// with, an image is for the robot it is wanted for.
fn build_as(
    target_dir: &Path,
    root: &Path,
    program: Program,
    robot: Option<&str>,
) -> Result<PathBuf, BuildError> {
    let image = target_dir.join(program.target()).join(PROFILE).join(program.name());
    if let Some(why) = cannot_build(root) {
        return if image.is_file() { Ok(image) } else { Err(BuildError::NothingToBuild(why, image)) };
    }
    let toolchain = ensure_target_of(root, program.target()).map_err(BuildError::Target)?;
    let mut build = toolchain.cargo(root, "build");
    build
        .args(["--package", program.package(), "--bin", program.name(), "--profile", PROFILE, "--target-dir"])
        .arg(target_dir);
    if let Program::Robot(body) = program {
        build.args(["--no-default-features", "--features", body.label()]);
    }
    if let Program::Free | Program::Udp = program {
        build.args(["--no-default-features", "--features", ImageBody::Omni.label()]);
    }
    if program == Program::Free {
        // Steps of the image that runs by its own clock are not counted: 1.3 kB and 0.8 kB less.
        build.args(smallest("board-mps2")).args(smallest("onetwo-protocol"));
    }
    if program == Program::Udp {
        build.args(["--features", "ethernet"]);
    }
    if program == Program::RetrievalBench {
        build.args(["--features", "words"]);
    }
    if let Program::Board(board) | Program::More(board, _) = program {
        build.args(board.profile().into_iter().flatten());
    }
    match robot.filter(|robot| !robot.is_empty()) {
        Some(robot) => build.env(ROBOT, robot),
        None => build.env_remove(ROBOT),
    };
    // Robots report it, and their host knows it by its own build.
    if let Some(hash) = source_hash(root) {
        build.env(SOURCE_HASH, format!("{hash:08x}"));
    }
    run_cargo(&mut build)?;
    if image.is_file() { Ok(image) } else { Err(BuildError::NoImage(image)) }
}

/// Programs that can be built for the boards: for the emulated one, where not stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// A whole robot: the brain for its body, its library and its tasks.
    Robot(ImageBody),
    /// A robot on wheels that runs by its own clock, with a serial line for a radio.
    Free,
    /// The same with UDP over Ethernet for a radio, and a body in a simulator. No robot's image: its network
    /// stack, of others, has places that may panic, and it is larger (`qemu_udp` holds its size).
    Udp,
    /// A robot on wheels for the board of a real one, which the emulator does not support.
    Board(&'static Board),
    /// Another program of a real board, by its binary's name.
    More(&'static Board, &'static str),
    /// Succeeds where `geometry::math` has the bits it has on the PC.
    MathHash,
    /// Program that counts the instructions of retrievals.
    RetrievalBench,
    /// Program that counts the instructions of motion planning.
    MotionBench,
    /// Program that counts the instructions of radio frames.
    RadioBench,
}

impl Program {
    /// Whole robots, which are held to the budgets of their firmware: the emulated ones, then one for each
    /// real board.
    pub fn images() -> Vec<Self> {
        let emulated = [Self::Robot(ImageBody::Legged), Self::Robot(ImageBody::Omni), Self::Free];
        let real = boards().iter().filter_map(|board| Some((board, board.firmware.as_ref()?)));
        let real = real.flat_map(|(board, firmware)| {
            let more = firmware.more.iter().map(move |name| Self::More(board, name));
            std::iter::once(Self::Board(board)).chain(more)
        });
        emulated.into_iter().chain(real).collect()
    }

    /// The firmware of the real board of that name.
    pub fn of_board(name: &str) -> Option<Self> {
        let real = boards().iter().find(|board| board.name == name && board.firmware.is_some());
        real.map(Self::Board)
    }

    /// The name of the binary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robot(ImageBody::Legged) => "onetwo-mps2-legged",
            Self::Robot(ImageBody::Omni) => "onetwo-mps2-omni",
            Self::Free => "onetwo-mps2-free",
            Self::Udp => "onetwo-mps2-udp",
            Self::Board(board) => {
                board.firmware.as_ref().map_or(board.package.as_str(), |firmware| &firmware.image)
            }
            Self::More(_, name) => name,
            Self::MathHash => "math-hash",
            Self::RetrievalBench => "retrieval-bench",
            Self::MotionBench => "motion-bench",
            Self::RadioBench => "radio-bench",
        }
    }

    /// Limits of its size.
    pub fn budget(self) -> Budget {
        let firmware = match self {
            Self::Board(board) | Self::More(board, _) => board.firmware.as_ref(),
            _ => None,
        };
        firmware.map_or(Budget::IMAGE, |firmware| Budget { flash: firmware.flash, ram: firmware.ram })
    }

    fn package(self) -> &'static str {
        match self {
            Self::Board(board) | Self::More(board, _) => &board.package,
            _ => PACKAGE,
        }
    }

    fn target(self) -> &'static str {
        match self {
            Self::Board(board) | Self::More(board, _) => &board.target,
            _ => TARGET,
        }
    }
}

/// The body whose brain a firmware image contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageBody {
    /// A robot on four legs.
    Legged,
    /// A robot on omnidirectional wheels.
    Omni,
}

impl ImageBody {
    /// Both bodies: legs, then wheels.
    pub const ALL: [Self; 2] = [Self::Legged, Self::Omni];

    /// Name in options, which is the feature's name.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Legged => "legged",
            Self::Omni => "omni",
        }
    }
}

/// Directory of cargo's output: `CARGO_TARGET_DIR` as cargo reads it, or the workspace's own `target`.
pub fn target_dir(root: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR")
        .filter(|directory| !directory.is_empty())
        .and_then(|directory| std::path::absolute(directory).ok())
        .unwrap_or_else(|| root.join("target"))
}

/// Reason why there is no firmware image to run.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// No compiler here builds for the robot's processor.
    #[error("the firmware cannot be built: {0}")]
    Target(#[source] TargetError),
    /// The sources or cargo are missing, and there is no earlier build.
    #[error("the firmware cannot be built: {0}, and there is no image at {image}; install rustup and run in a clone of the \
         project, or set CARGO_TARGET_DIR to where an image was built", image = .1.display())]
    NothingToBuild(String, PathBuf),
    /// cargo could not be run by this command.
    #[error("`{0}` does not run: {1}")]
    Cargo(String, #[source] std::io::Error),
    /// The firmware does not compile by this command; the compiler's output is on stderr.
    #[error("the firmware does not build: `{0}` failed ({1})")]
    Failed(String, ExitStatus),
    /// The image cannot be put where it is kept.
    #[error("the image cannot be copied to {image}: {1}", image = .0.display())]
    Copy(PathBuf, #[source] std::io::Error),
    /// cargo succeeded, but its output is not where it belongs.
    #[error("cargo left no image at {}", .0.display())]
    NoImage(PathBuf),
}

/// Runs cargo with its output on our stderr, except where it had nothing to do: then without output.
fn run_cargo(build: &mut Command) -> Result<(), BuildError> {
    let color = if std::io::stderr().is_terminal() { "always" } else { "never" };
    build.args(["--color", color]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let command = line_of(build);
    let lost = |error| BuildError::Cargo(command.clone(), error);
    let mut child = build.spawn().map_err(lost)?;
    if let Some(stderr) = child.stderr.take() {
        let mut announced = false;
        for line in BufReader::new(stderr).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line).into_owned();
            if announced || !line.contains("Finished") {
                if !announced {
                    eprintln!("firmware: building the image ({command})");
                }
                announced = true;
                eprintln!("{line}");
            }
        }
    }
    let status = child.wait().map_err(lost)?;
    if status.success() { Ok(()) } else { Err(BuildError::Failed(command, status)) }
}

/// Obstacle to any build, independent of the compiler.
fn cannot_build(root: &Path) -> Option<String> {
    let manifest = root.join(MANIFEST);
    if !manifest.is_file() {
        return Some(format!("its sources are not here ({})", manifest.display()));
    }
    output_of(Command::new(cargo_program()).current_dir(root).arg("--version")).err()
}

/// The environment variable that names the robot's description for a build (crate `robots`, which this crate
/// does without).
pub const ROBOT: &str = "ONETWO_ROBOT";
/// The robot that this program itself is compiled for: images for it must be for the same.
const OWN_ROBOT: Option<&str> = option_env!("ONETWO_ROBOT");
/// Directory of the images in a release archive; its program is in `bin` beside `share`.
pub const SHIPPED_IMAGES: &str = "share/onetwo/images";
/// The board that QEMU emulates.
const PACKAGE: &str = "board-mps2";
const MANIFEST: &str = "firmware/boards/mps2/Cargo.toml";
/// The one profile firmware is built with (Cargo.toml explains why); a debug build would run 30 times slower.
const PROFILE: &str = "firmware";

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const ROBOT: Program = Program::Robot(ImageBody::Omni);

    #[test]
    fn the_board_is_where_we_look_for_it() {
        let manifest = fs::read_to_string(crate::workspace_root().join(MANIFEST)).unwrap();
        for name in
            [PACKAGE, ROBOT.name(), Program::Robot(ImageBody::Legged).name(), Program::MathHash.name()]
        {
            assert!(manifest.contains(&format!("name = \"{name}\"")), "{name}");
        }
        let workspace = fs::read_to_string(crate::workspace_root().join("Cargo.toml")).unwrap();
        assert!(workspace.contains(&format!("[profile.{PROFILE}]")));
    }

    #[test]
    fn without_sources_an_image_that_is_there_will_do() {
        let root = env::temp_dir().join(format!("onetwo-no-sources-{}", std::process::id()));
        let target = root.join("target");
        let Err(error) = build_into(&target, &root, ROBOT) else { panic!("built from nothing") };
        let BuildError::NothingToBuild(_, image) = &error else { panic!("{error}") };
        let (image, error) = (image.clone(), error.to_string());
        assert!(error.contains("its sources are not here") && error.contains("install rustup"), "{error}");
        fs::create_dir_all(image.parent().unwrap()).unwrap();
        fs::write(&image, b"an image").unwrap();
        assert_eq!(build_into(&target, &root, ROBOT).unwrap(), image);
        fs::remove_dir_all(&root).unwrap();
    }

    #[test]
    fn a_release_archive_s_program_takes_the_images_beside_it() {
        let root = env::temp_dir().join(format!("onetwo-archive-{}", std::process::id()));
        let (own, images) = (root.join("bin/onetwo"), root.join(SHIPPED_IMAGES));
        fs::create_dir_all(own.parent().unwrap()).unwrap();
        fs::write(&own, b"a program").unwrap();
        assert_eq!(shipped(&own, ROBOT), None);
        fs::create_dir_all(&images).unwrap();
        fs::write(images.join(ROBOT.name()), b"an image").unwrap();
        assert_eq!(shipped(&own, ROBOT), Some(images.canonicalize().unwrap().join(ROBOT.name())));
        assert_eq!(shipped(&own, Program::of_board("stm32").unwrap()), None);
        fs::remove_dir_all(&root).unwrap();
    }

    #[test]
    fn a_build_that_fails_reports_its_command() {
        let error = run_cargo(Command::new(cargo_program()).args(["build", "--package", "no-such-board"]))
            .unwrap_err();
        let BuildError::Failed(command, status) = &error else { panic!("{error}") };
        assert!(command.contains("build --package no-such-board") && !status.success());
    }
}
