//! `space`: disk-space check, before the run starts, rather than by a compiler error after a quarter of an
//! hour.

use std::path::Path;
use std::process::Command;

/// A warning where little space is free; `None` where enough is, or where it cannot be determined.
pub(crate) fn warning(root: &Path) -> Option<String> {
    // xtask itself lies in `target/debug`; documentation exists once a run has completed about half of its
    // steps.
    let built = root.join("target/doc").is_dir() || std::env::var_os("CARGO_TARGET_DIR").is_some();
    let listing = Command::new("df").arg("-Pk").arg(root).output().ok()?;
    let free = free_kib(&String::from_utf8_lossy(&listing.stdout))? / 1024;
    (!built && free < NEEDED_MIB).then(|| {
        format!(
            "{free} MiB are free where this lies; a first whole run takes {NEEDED_MIB} with CARGO_INCREMENTAL=0, and more without; \
             CARGO_TARGET_DIR names another place"
        )
    })
}

/// The fourth column of the second line that POSIX's `df -Pk` prints.
fn free_kib(listing: &str) -> Option<u64> {
    listing.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()
}

/// What `du -sm target` gives after `.ci/run` in a fresh clone, rounded up.
const NEEDED_MIB: u64 = 7_200;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_free_is_read_from_what_df_prints() {
        let listing = "Filesystem 1024-blocks Used Available Capacity Mounted on\n/dev/vda 263174212 87031160 8412000 92% /\n";
        assert_eq!(free_kib(listing), Some(8_412_000));
        assert_eq!(free_kib("df: no such place\n"), None);
    }
}
