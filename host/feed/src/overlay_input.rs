//! `overlay_input`: the snapshot that overlays are computed from. m, s, field frame.

use host::referee::Game;
use host::world::World;
use protocol::Who;
use rules::{Colour, FieldSpec, League, RuleRole};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    pub(super) who: Who,
    pub(super) to: [f32; 2],
    pub(super) rule_role: RuleRole,
}

#[derive(Clone, Debug)]
pub(super) struct OverlayInput {
    /// Seconds since the start.
    pub(super) t: f64,
    pub(super) world: World,
    pub(super) game: Game,
    pub(super) field: FieldSpec,
    pub(super) league: League,
    /// The one team whose host is ours; `None` where both are, or neither.
    pub(super) us: Option<Colour>,
    pub(super) aims: Vec<Aim>,
}
