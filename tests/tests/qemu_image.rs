//! `qemu_image`: tests of the firmware image and of the emulator.
//!
//! Needs QEMU and a compiler for the target; `cargo xtask test --only qemu` provides both.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use firmware_build::inspect::Image;
use firmware_build::{
    ImageBody, Install, MACHINE, Program, build_image, build_program, ensure_qemu, workspace_root,
};

#[test]
fn no_image_has_an_allocator_or_double_precision_in_software() {
    ImageBody::ALL.into_iter().for_each(is_free_of_them);
}

fn is_free_of_them(body: ImageBody) {
    let path = build_image(&workspace_root(), body).unwrap_or_else(|error| panic!("{error}"));
    let bytes = fs::read(&path).expect("the image that was just built");
    let image = Image::parse(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(
        image.symbol_names().any(|name| name == "main" || name == "Reset"),
        "without symbols nothing can be said about the image"
    );
    let allocator = image.symbol_names().find(|name| name.contains("rust_alloc"));
    assert_eq!((allocator, image.soft_double()), (None, None), "{}", path.display());
}

#[test]
fn the_robots_mathematics_has_the_bits_of_the_pc() {
    let qemu = ensure_qemu(Install::ForUser).unwrap_or_else(|error| panic!("{error}"));
    let image = build_program(&workspace_root(), Program::MathHash).unwrap_or_else(|error| panic!("{error}"));
    let mut child = Command::new(qemu)
        .args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(&image)
        .stdin(Stdio::null())
        .spawn()
        .expect("the emulator that was just found");
    let started = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("our own child") {
            break status;
        }
        if started.elapsed() > PATIENCE {
            child.kill().expect("our own child");
            panic!("{} does not end", image.display());
        }
        sleep(Duration::from_millis(10));
    };
    assert!(status.success(), "{} ended with {status}: the hash differs from the PC's", image.display());
}

/// The hash takes a second or so; a machine ten times slower still has enough time.
const PATIENCE: Duration = Duration::from_mins(1);
