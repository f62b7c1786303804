//! `bench`: the commands `cargo xtask bench …`. Starts a bench or an example of the crate `match-tests`,
//! after installing what it needs.

use firmware_build::Install;

use crate::context::{Context, Failure, run};

/// Starts a bench; `arguments` are its own arguments, which it checks itself.
pub(crate) fn start(context: &Context, name: &str, arguments: &[String]) -> Result<(), Failure> {
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    context.ensure_target()?;
    run(context.cargo(&format!("bench --package match-tests --bench {name} --")).args(arguments))
}

/// Likewise for an example, which needs nothing to be installed.
pub(crate) fn start_example(context: &Context, name: &str, arguments: &[String]) -> Result<(), Failure> {
    run(context.cargo(&format!("run --release --package match-tests --example {name} --")).args(arguments))
}

/// Starts the example `soak`, built with checks of overflow and debug assertions.
pub(crate) fn soak(context: &Context, arguments: &[String]) -> Result<(), Failure> {
    run(context.cargo("run --package match-tests --example soak --").args(arguments))
}
