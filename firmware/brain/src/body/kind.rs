//! `kind`: robot bodies that this build supports. A firmware image contains the one body of its robot
//! (features `legged` and `omni`); on the PC both are built in.
//!
//! Everything that depends on the body asks [`BodyKind::of`] once and keeps its answer, with the proof that
//! the body is built in. Without the feature there is no such proof, so the compiler drops the code that
//! needs it.

#[cfg(not(all(feature = "legged", feature = "omni")))]
use core::convert::Infallible;

use rules::League;

/// A kind of body that is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// A body with four legs.
    Legged(Legs),
    /// A body with four omnidirectional wheels.
    Wheeled(WheeledKind),
}

/// Proof that the brain of a robot on legs is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Legs(#[cfg(not(feature = "legged"))] Infallible);

/// Proof that the brain of a robot on wheels is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheeledKind(#[cfg(not(feature = "omni"))] Infallible);

#[cfg(not(any(feature = "legged", feature = "omni")))]
compile_error!("a brain needs a body: turn on the feature `legged` or `omni`");

impl BodyKind {
    /// The body kind of that league's robots. If it is not built in ([`BodyKind::is_built`]), the kind that
    /// is: a caller that takes a configuration from outside must check first.
    pub fn of(league: League) -> Self {
        match league {
            #[cfg(feature = "legged")]
            League::FourLegged => Self::Legged(Legs()),
            #[cfg(feature = "omni")]
            League::Ssl2013 | League::DivisionB | League::DivisionA => Self::Wheeled(WheeledKind()),
            #[cfg(all(feature = "omni", not(feature = "legged")))]
            League::FourLegged => Self::Wheeled(WheeledKind()),
            #[cfg(all(feature = "legged", not(feature = "omni")))]
            League::Ssl2013 | League::DivisionB | League::DivisionA => Self::Legged(Legs()),
        }
    }

    /// Whether this build supports that league's robots.
    pub fn is_built(league: League) -> bool {
        match league {
            League::FourLegged => cfg!(feature = "legged"),
            League::Ssl2013 | League::DivisionB | League::DivisionA => cfg!(feature = "omni"),
        }
    }
}
