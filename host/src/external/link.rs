//! `link`: who answers the host's views: a strategy in this program or in another.

use std::fmt;
use std::io;
use std::sync::Arc;

/// Answers views with orders, line by line.
pub trait StrategyLink: Send {
    /// The answer to a view, as [`super::StrategyAnswer`]; `None`: there is none now.
    fn answer(&mut self, view: &str) -> Option<String>;

    /// Why it will not answer any more, once that is certain.
    fn failure(&self) -> Option<String> {
        None
    }
}

impl<F: FnMut(&str) -> Option<String> + Send> StrategyLink for F {
    fn answer(&mut self, view: &str) -> Option<String> {
        self(view)
    }
}

/// A way to start a strategy: once for each match.
#[derive(Clone)]
pub struct StrategyStarter {
    name: Arc<str>,
    start: Arc<dyn Fn() -> io::Result<Box<dyn StrategyLink>> + Send + Sync>,
}

impl StrategyStarter {
    /// With a name for reports and errors.
    pub fn new(
        name: &str,
        start: impl Fn() -> io::Result<Box<dyn StrategyLink>> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), start: Arc::new(start) }
    }

    /// Starts the program.
    pub fn start(&self) -> io::Result<Box<dyn StrategyLink>> {
        (self.start)()
    }

    /// Name of the program, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl fmt::Debug for StrategyStarter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("StrategyStarter").field(&self.name).finish()
    }
}
