//! `keeper`: the keeper's place while primary defenders are on their way to theirs. Attack frame, m, rad.
//!
//! The paper's three cases place the keeper beside primaries that are in place. A carrier near our area moves
//! faster than they do, and what the paper leaves to a primary is then open.

use geometry::{Attack, Point, math};

use super::super::super::view::View;
use super::super::angle::{Opening, Shadows, Span, widest};
use super::super::edge::Edge;
use super::super::{SHOT_SPEED_M_S, ThreatSettings};
use super::{Cover, Placing};

/// Directions from the threat in which the keeper may stand, to either side of the middle.
const RAYS: i8 = 12;

impl Cover {
    /// The keeper's place between `bodies`, ours at their present places: where the widest gap now and the
    /// widest gap once the primaries are in place are together the least, with what it costs to go there.
    /// Where the bodies leave no more than the primaries will, the paper's place.
    pub fn keeper_meanwhile(
        &self,
        view: &View,
        bodies: impl Iterator<Item = Point<Attack>>,
        settings: &ThreatSettings,
    ) -> Point<Attack> {
        let opening = &self.opening;
        let now = opening.shadows(bodies, f32::INFINITY);
        let then = opening.shadows(self.primaries.iter().copied(), f32::INFINITY);
        let [open_now, open_then] = [&now, &then].map(|shadows| widest(&opening.gaps_between(shadows)));
        if open_now <= open_then + settings.open_worth {
            return self.keeper;
        }
        let edge = Edge::of(&view.field, settings.off_area);
        let place = Placing { view, settings, opening: *opening, edge, upper_post: self.upper_post };
        let stands = view.our(view.keeper).map_or(self.keeper, |keeper| keeper.position);
        let choice = Choice { cover: self, place, shadows: [now, then], stands };
        choice.best()
    }
}

/// The keeper's places, and what they are compared by.
struct Choice<'c> {
    cover: &'c Cover,
    place: Placing<'c>,
    /// What primaries cover now, and at their places.
    shadows: [Shadows; 2],
    /// Where the keeper is, m.
    stands: Point<Attack>,
}

impl Choice<'_> {
    fn best(&self) -> Point<Attack> {
        let places = (-RAYS..=RAYS).flat_map(|ray| {
            let off = self.cover.opening.half * f32::from(ray) / f32::from(RAYS);
            let [back, front] = [0.0, math::FRAC_PI_2].map(|half| self.place.keeper(off, half).0);
            [back, back + (front - back) * 0.5, front]
        });
        let mut best = (self.cover.keeper, self.cost(self.cover.keeper));
        for at in places {
            // Its way alone may cost more than the best place.
            let [moves, differs] = self.ways(at);
            if moves + differs < best.1 {
                let cost = self.cost(at);
                if cost < best.1 {
                    best = (at, cost);
                }
            }
        }
        best.0
    }

    /// The widest gaps with the keeper there, now and later, and its way, rad.
    fn cost(&self, at: Point<Attack>) -> f32 {
        let (opening, settings) = (&self.cover.opening, self.place.settings);
        let covers =
            opening.shadow(at, f32::INFINITY).map(|body| widened(body, self.place.distance(at), settings));
        let [now, then] = &self.shadows;
        let [moves, differs] = self.ways(at);
        widest_beside(opening, now, covers) + widest_beside(opening, then, covers) + moves + differs
    }

    /// What its ways there from where it is and from its planned place cost, rad.
    fn ways(&self, at: Point<Attack>) -> [f32; 2] {
        let settings = self.place.settings;
        [
            settings.keeper_moves * at.distance(self.stands),
            settings.keeper_differs * at.distance(self.cover.keeper),
        ]
    }
}

/// The directions that a keeper covers with the way that it drives while a shot comes from `distance`.
fn widened(body: Span, distance: f32, settings: &ThreatSettings) -> Span {
    let seconds = (distance / SHOT_SPEED_M_S - settings.latency).max(0.0);
    let more = 0.5 * settings.acceleration * seconds * seconds / distance.max(f32::EPSILON);
    Span { right: body.right - more, left: body.left + more }
}

/// The widest gap between shadows and the keeper's, rad.
fn widest_beside(opening: &Opening, shadows: &Shadows, keeper: Option<Span>) -> f32 {
    let mut all = shadows.clone();
    if let Some(keeper) = keeper {
        let at = all.partition_point(|shadow| shadow.right < keeper.right);
        // Ours are half of the bodies that fit.
        let _ = all.insert(at, keeper);
    }
    widest(&opening.gaps_between(&all))
}
