//! `counters`: match counters of passes, free kicks and role changes. For reports (docs/papers.md D24).

use protocol::{Instant, RobotId};
use rules::{Colour, FieldSpec, Phase, Side};
use serde::{Deserialize, Serialize};

use super::order::{Order, Role};
use super::pass::{Ordered, PassCounters, PassVerdict, PassWatch};
use super::view::{Flip, View};
use crate::world::World;
use geometry::{Attack, Point};

/// A restart's pass that has just left, by the coach's plan; attack frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sent {
    /// The robot that kicked.
    pub passer: RobotId,
    /// The robot that shall receive it.
    pub receiver: RobotId,
    /// x0: place of the ball at the kick.
    pub from: Point<Attack>,
    /// x*: place of reception.
    pub to: Point<Attack>,
    /// T_b: predicted time of the ball from x0 to x*, s.
    pub flight: f32,
    /// Whether it is a chip.
    pub chip: bool,
    /// P(c1) … P(c5) as rated last before the kick.
    pub conditions: [f32; 5],
    /// Distance of the opponent nearest to x0, m.
    pub pressed: f32,
    /// Whether the receiver coerced before, if it ends a plan of the Coerce and Attack Planner.
    pub planned: Option<bool>,
}

/// Free kicks by the Coerce and Attack Planner: the second paper's Table 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CapCounters {
    /// Number of passes that left.
    pub attempts: u32,
    /// Passes of free kicks that the receiver, or another teammate, received.
    pub successes: u32,
    /// Passes of free kicks whose receiver had coerced an opponent before.
    pub reuses: u32,
    /// Number of [`Self::reuses`] that arrived.
    pub reuse_successes: u32,
}

/// Counts of one team.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlayCounters {
    /// Counts of passes from restarts.
    pub passes: PassCounters,
    /// Counts of free kicks by the planner.
    pub cap: CapCounters,
    /// Number of role changes of robots while the phase did not change; places within a role do not count.
    pub role_changes: u32,
}

/// Counters updated while a match is played.
#[derive(Clone, Debug, Default)]
pub struct Bookkeeper {
    counters: PlayCounters,
    watch: Option<(PassWatch, Option<bool>)>,
    judged: Option<(Ordered, PassVerdict)>,
    roles: [Option<Role>; RobotId::COUNT],
    phase: Option<Phase<Side>>,
}

impl Bookkeeper {
    /// The counts so far.
    pub fn counters(&self) -> &PlayCounters {
        &self.counters
    }

    /// The newest pass with its outcome.
    pub fn judged(&self) -> Option<&(Ordered, PassVerdict)> {
        self.judged.as_ref()
    }

    /// Takes the next snapshot: the orders in it, and the pass that started.
    pub fn note(
        &mut self,
        (world, view, field): (&World, &View, &FieldSpec),
        (us, flip): (Colour, Flip),
        orders: &[Order],
        sent: Option<Sent>,
    ) {
        let same = self.phase.replace(view.phase) == Some(view.phase);
        let before = core::mem::take(&mut self.roles);
        for order in orders {
            let slot = order.robot.index();
            self.roles[slot] = Some(order.role);
            let other = |had: Role| core::mem::discriminant(&had) != core::mem::discriminant(&order.role);
            self.counters.role_changes += u32::from(same && before[slot].is_some_and(other));
        }
        if let Some(sent) = sent {
            self.watch = Some((PassWatch::new(ordered(&sent, view.now, us, flip)), sent.planned));
        }
        let Some((watch, planned)) = &mut self.watch else { return };
        let Some(verdict) = watch.observe(world, field) else { return };
        self.counters.passes.record(watch.ordered(), &verdict);
        self.judged = Some((*watch.ordered(), verdict));
        if let Some(reused) = *planned {
            let (cap, good) = (&mut self.counters.cap, u32::from(verdict.is_success()));
            cap.attempts += 1;
            cap.successes += good;
            cap.reuses += u32::from(reused);
            cap.reuse_successes += u32::from(reused) * good;
        }
        self.watch = None;
    }
}

fn ordered(sent: &Sent, at: Instant, us: Colour, flip: Flip) -> Ordered {
    Ordered {
        at,
        us,
        passer: sent.passer,
        receiver: sent.receiver,
        from: flip.to_field(sent.from),
        to: flip.to_field(sent.to),
        flight: sent.flight,
        chip: sent.chip,
        conditions: sent.conditions,
        pressed: sent.pressed,
    }
}
