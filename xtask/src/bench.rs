//! `bench`: the commands `cargo xtask bench …`. Starts a bench or an example of the crate `match-tests`, with what
//! it needs installed first.

use firmware_build::Install;

use crate::context::{Context, Failure, run};

/// `words` are the bench's own: it knows them and says so where it does not.
pub(crate) fn start(context: &Context, name: &str, words: &[String]) -> Result<(), Failure> {
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    context.ensure_target()?;
    run(context.cargo(&format!("bench --package match-tests --bench {name} --")).args(words))
}

/// Likewise an example, which needs no more than this machine.
pub(crate) fn start_example(context: &Context, name: &str, words: &[String]) -> Result<(), Failure> {
    run(context.cargo(&format!("run --release --package match-tests --example {name} --")).args(words))
}
