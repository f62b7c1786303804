//! `attack`: best receiving position of our free kick: every cell of the grid, every receiver, by P(receive)
//! · P(goal) (Biswas et al. 2014 §4.2). Attack frame, m, probabilities.

use geometry::{Angle, Attack, Point, Vector, math};
use protocol::RobotId;
use protocol::host::KickOrder;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::super::view::{View, ViewRobot};
use super::grid::{CELLS, Cell};

/// Places tried around the best cell's middle: the paper takes the cell, this refines it
/// (docs/papers.md D18).
pub const SAMPLES: u32 = 24;
/// Their standard deviation, as a share of the cell's side: nearly all of them lie in the cell.
const SAMPLE_SIGMA_SHARE: f32 = 0.25;

/// Worth of a pass to a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worth {
    /// P(receive | x), 0–1.
    pub receive: f32,
    /// P(goal | receive, x), 0–1.
    pub goal: f32,
    /// Kick of the pass.
    pub kick: KickOrder,
    /// Target of the receiver's shot, m.
    pub aim: Point<Attack>,
}

impl Worth {
    /// P(goal | x): what is maximised.
    pub fn value(&self) -> f32 {
        self.receive * self.goal
    }
}

/// Start of passes, and the robot that plays them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassOrigin {
    /// Place of the ball, m.
    pub from: Point<Attack>,
    /// The robot that kicks it.
    pub kicker: RobotId,
}

/// Values passes and shots: section 3.1, as the planner needs it.
pub trait PassValue {
    /// Values of passes from `origin` to `receiver` at each of these places, against all opponents of the
    /// view and with all our robots in it.
    fn worths(
        &self,
        view: &View,
        origin: PassOrigin,
        receiver: &ViewRobot,
        places: &mut dyn Iterator<Item = Point<Attack>>,
        take: &mut dyn FnMut(Point<Attack>, Worth),
    );

    /// Probability that this opponent intercepts a pass from `from` to `to`.
    fn meets_pass(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32;

    /// Probability that it intercepts a shot.
    fn meets_shot(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32;
}

/// A pass to a receiver, and a shot from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttackPlan {
    /// The robot that receives.
    pub receiver: RobotId,
    /// The best cell of the grid.
    pub cell: Cell,
    /// The best place in that cell.
    pub at: Point<Attack>,
    /// P(receive) and P(goal) at that place.
    pub worth: Worth,
    /// Number of opponents taken into account.
    pub against: usize,
}

/// The best value found in each cell, 0 where no robot can receive, in the order of [`Cell::all`].
pub type CellValues = [f32; CELLS];

/// The least values of an attack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Least {
    /// Least P(receive | x).
    pub receive: f32,
    /// Least P(goal | x).
    pub value: f32,
}

impl Least {
    /// Whether both are reached.
    pub fn allows(self, worth: &Worth) -> bool {
        worth.receive >= self.receive && worth.value() > self.value
    }
}

/// A search for the best attack of one kicker.
#[derive(Clone, Copy, Debug)]
pub struct AttackSearch {
    /// The robot at the ball.
    pub kicker: RobotId,
    /// Least values that an attack must reach.
    pub least: Least,
    /// Seed of the [`SAMPLES`] places.
    pub seed: u64,
}

/// The best attack by one of `receivers` in this view that reaches the search's least, and the value of every
/// cell.
///
/// The middles of all cells decide; then [`SAMPLES`] places around the best one's middle are tried.
pub fn best_attack(
    view: &View,
    value: &dyn PassValue,
    search: AttackSearch,
    receivers: &[RobotId],
) -> (Option<AttackPlan>, CellValues) {
    let mut values = [0.0; CELLS];
    let Some(ball) = view.ball else { return (None, values) };
    let AttackSearch { kicker, least, seed } = search;
    let origin = PassOrigin { from: ball.position, kicker };
    let mut best: Option<AttackPlan> = None;
    for id in receivers {
        let Some(receiver) = view.our(*id) else { continue };
        let mut cells = Cell::all();
        let mut middles = Cell::all().map(|cell| cell.middle(&view.field));
        value.worths(view, origin, receiver, &mut middles, &mut |at, worth| {
            let Some(cell) = cells.next() else { return };
            values[cell.index()] = values[cell.index()].max(worth.value());
            if least.allows(&worth) && best.is_none_or(|best| worth.value() > best.worth.value()) {
                best = Some(AttackPlan { receiver: *id, cell, at, worth, against: view.theirs.len() });
            }
        });
    }
    let Some(mut found) = best else { return (None, values) };
    let Some(receiver) = view.our(found.receiver) else { return (best, values) };
    let (middle, size) = (found.at, Cell::size(&view.field));
    let mut random = Xoshiro128PlusPlus::seed_from_u64(seed);
    let mut around = (0..SAMPLES).map(|_| {
        let by = gaussian(&mut random);
        // Within the cell: a sample beyond it is moved to its border.
        let cut = |x: f32, side: f32| (x * side * SAMPLE_SIGMA_SHARE).clamp(-0.5 * side, 0.5 * side);
        middle + Vector::new(cut(by.x(), size.x()), cut(by.y(), size.y()))
    });
    value.worths(view, origin, receiver, &mut around, &mut |at, worth| {
        if least.allows(&worth) && worth.value() > found.worth.value() {
            (found.at, found.worth) = (at, worth);
        }
    });
    (Some(found), values)
}

/// Two independent normal numbers (Box and Muller).
fn gaussian(random: &mut Xoshiro128PlusPlus) -> Vector<Attack> {
    let share = 1.0 - (random.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0);
    let turn = (random.next_u32() >> 8) as f32 * (math::TAU / 16_777_216.0);
    Vector::polar(math::sqrt(-2.0 * math::ln(share)), Angle::new(turn))
}
