//! `count`: counted instructions: of images under QEMU, of the calling program under callgrind; and where
//! tables of counts stand in READMEs. For benches.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::{env, fs};

use crate::{Install, MACHINE, Program, build_program, ensure_qemu, workspace_root};

/// An image and the emulator that counts its instructions.
#[derive(Clone, Debug)]
pub struct CountingImage {
    qemu: PathBuf,
    image: PathBuf,
}

impl CountingImage {
    /// Builds the image. The error names what is missing.
    pub fn new(program: Program) -> Result<Self, String> {
        let qemu = ensure_qemu(Install::ForUser).map_err(|error| error.to_string())?;
        let image = build_program(&workspace_root(), program).map_err(|error| error.to_string())?;
        Ok(Self { qemu, image })
    }

    /// Runs it to its end with these arguments for QEMU and reads what it prints, a `T` a line; there must be
    /// `count`.
    pub fn lines<T>(
        &self,
        more: &[String],
        read: impl Fn(&str) -> Option<T>,
        count: usize,
    ) -> Result<Vec<T>, String> {
        let output = Command::new(&self.qemu)
            .args(["-machine", MACHINE, "-display", "none", "-monitor", "none", "-serial", "none"])
            .args(["-icount", "shift=6,align=off", "-semihosting-config", "enable=on,target=native"])
            .args(more)
            .arg("-kernel")
            .arg(&self.image)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("{} does not start: {error}", self.qemu.display()))?;
        let printed = String::from_utf8_lossy(&output.stdout);
        let lines: Vec<T> = printed.lines().filter_map(read).collect();
        if output.status.success() && lines.len() == count {
            return Ok(lines);
        }
        let arguments = String::from_utf8_lossy(&output.stderr);
        let of = format!("{} of {count} lines", lines.len());
        Err(format!("the image ended with {} after {of}: {arguments}", output.status))
    }
}

/// Instructions of the calling program, started again with these arguments, in all.
pub fn callgrind(arguments: &[&str]) -> Result<u64, String> {
    let program = env::current_exe().map_err(|error| format!("which program is this? {error}"))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("valgrind does not start: {error}; install the package valgrind"))?;
    let printed = String::from_utf8_lossy(&output.stderr);
    let count = printed.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    count.filter(|_| output.status.success()).ok_or_else(|| format!("callgrind counted nothing: {printed}"))
}

/// Puts the text between the marks `<!-- NAME -->` and `<!-- end of NAME -->` of a file of the workspace.
pub fn write_between(file: &str, name: &str, table: &str) -> Result<(), String> {
    let file = workspace_root().join(file);
    let wrong = |error| format!("{}: {error}", file.display());
    let text = fs::read_to_string(&file).map_err(wrong)?;
    let Some(text) = between(&text, name, table) else {
        return Err(format!(
            "{} has no marks for the table: `<!-- {name} -->` and `<!-- end of {name} -->`",
            file.display()
        ));
    };
    fs::write(&file, text).map_err(wrong)
}

/// The text with what stands between the marks of that name replaced; `None` where a mark is missing.
fn between(text: &str, name: &str, table: &str) -> Option<String> {
    let (begin, end) = (format!("<!-- {name} -->"), format!("<!-- end of {name} -->"));
    let (before, rest) = text.split_once(&begin)?;
    let (_, after) = rest.split_once(&end)?;
    Some(format!("{before}{begin}\n{table}{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_takes_the_place_of_the_old_one_alone() {
        let text = "a\n<!-- x table -->\nold\n<!-- end of x table -->\nb\n";
        let written = between(text, "x table", "| new |\n").unwrap();
        assert_eq!(written, "a\n<!-- x table -->\n| new |\n<!-- end of x table -->\nb\n");
        assert_eq!(between(&written, "x table", "| new |\n").as_deref(), Some(written.as_str()));
        assert_eq!(between("no marks", "x table", ""), None);
        assert_eq!(between(text, "y table", ""), None);
    }
}
