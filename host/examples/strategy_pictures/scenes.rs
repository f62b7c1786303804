//! `scenes`: situations of the figures. A free kick in the second paper's world: six against six on 6 × 4 m.

use geometry::Point;
use host::strategy::View;
use rules::{League, Phase, Side};

/// A moment with robots numbered from 0; the keepers are 0.
pub(crate) fn moment(league: League, ball: (f32, f32), ours: &[(f32, f32)], theirs: &[(f32, f32)]) -> View {
    let at = |&(x, y): &(f32, f32)| Point::new(x, y);
    View::still(league.field(), at(&ball), ours.iter().map(at), theirs.iter().map(at))
}

/// Our free kick near the right touch line: 1 takes it, 2 to 4 are followed, 5 is not.
pub(crate) fn free_kick() -> View {
    let ours = [(-2.8, 0.0), (0.15, -1.52), (0.75, 0.15), (1.75, 0.55), (0.9, 1.15), (-0.7, 0.6)];
    // Keeper, a primary defender, three markers, a wall.
    let theirs = [(2.82, -0.1), (2.2, -0.42), (1.04, 0.12), (2.0, 0.43), (1.17, 1.0), (0.62, -1.03)];
    View { phase: Phase::FreeKick(Side::Ours), ..moment(League::Ssl2013, (0.25, -1.5), &ours, &theirs) }
}
