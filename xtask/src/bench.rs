//! What does a retrieval cost? Starts the bench of the crate `match-tests`, with what it needs installed first.

use firmware_build::Install;

use crate::context::{Context, Failure, run};

/// `words` are the bench's own: it knows them and says so where it does not.
pub(crate) fn retrieval(context: &Context, words: &[String]) -> Result<(), Failure> {
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    context.ensure_target()?;
    run(context.cargo("bench --package match-tests --bench retrieval --").args(words))
}
