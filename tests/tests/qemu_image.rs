//! Is the firmware image what a robot can carry, and does the emulator run programs of its kind?
//!
//! Needs QEMU and a compiler for the target (feature `qemu`); `cargo xtask test --only qemu` sees to both.

use std::collections::BTreeSet;
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use firmware_build::{
    Body, Install, MACHINE, Program, build_image, build_program, ensure_qemu, workspace_root,
};

#[test]
fn no_image_has_an_allocator_or_double_precision_in_software() {
    Body::ALL.into_iter().for_each(is_free_of_them);
}

fn is_free_of_them(body: Body) {
    let image = build_image(&workspace_root(), body).unwrap_or_else(|error| panic!("{error}"));
    let bytes = fs::read(&image).expect("the image that was just built");
    let names = symbols(&bytes).expect("an ELF file for a 32-bit Arm");
    assert!(
        names.contains("main") || names.contains("Reset"),
        "without symbols nothing can be said about the image"
    );
    let unwanted = names.iter().filter(|name| name.contains("rust_alloc") || SOFT_DOUBLE.contains(name));
    let unwanted: Vec<_> = unwanted.collect();
    assert!(unwanted.is_empty(), "{}: {unwanted:?}", image.display());
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

/// The names in an ELF file's symbol table; `None` where it is no 32-bit, little-endian file for an Arm.
fn symbols(elf: &[u8]) -> Option<BTreeSet<&str>> {
    let word = |at: usize| Some(u32::from_le_bytes(elf.get(at..at + 4)?.try_into().ok()?) as usize);
    let half = |at: usize| Some(u16::from_le_bytes(elf.get(at..at + 2)?.try_into().ok()?) as usize);
    if elf.get(..6)? != b"\x7fELF\x01\x01" || half(0x12)? != ARM {
        return None;
    }
    let (table, size, count) = (word(0x20)?, half(0x2e)?, half(0x30)?);
    let section = |index: usize| table + index * size;
    let of_symbols = (0..count).map(section).find(|at| word(at + 4) == Some(SYMBOL_TABLE))?;
    let names = word(section(word(of_symbols + 0x18)?) + 0x10)?;
    let (first, length) = (word(of_symbols + 0x10)?, word(of_symbols + 0x14)?);
    let name = |symbol: usize| {
        let rest = elf.get(names + word(symbol)?..)?;
        std::str::from_utf8(rest.split(|byte| *byte == 0).next()?).ok()
    };
    Some((first..first + length).step_by(SYMBOL).filter_map(name).collect())
}

/// `e_machine` of an Arm.
const ARM: usize = 40;
/// `sh_type` of the symbol table, and the size of its entries.
const SYMBOL_TABLE: usize = 2;
const SYMBOL: usize = 16;
/// The run-time library's double-precision arithmetic (run-time ABI for the Arm architecture, §5.1.2): some 250
/// instructions an operation on a processor that has single precision only.
const SOFT_DOUBLE: [&str; 12] = [
    "__aeabi_dadd",
    "__aeabi_dsub",
    "__aeabi_drsub",
    "__aeabi_dmul",
    "__aeabi_ddiv",
    "__aeabi_dcmplt",
    "__aeabi_dcmple",
    "__aeabi_dcmpgt",
    "__aeabi_dcmpge",
    "__aeabi_dcmpeq",
    "__aeabi_f2d",
    "__aeabi_d2f",
];
/// The hash takes a second or so; a machine ten times slower is still given its time.
const PATIENCE: Duration = Duration::from_mins(1);
