//! `planner`: sequence of the planner: the seven steps over time (Biswas et al. 2014 §4). Attack frame, s, m.

use geometry::{Attack, Point};
use protocol::{Instant, RobotId};
use rules::{Phase, Side};

use super::super::view::{ROBOTS_MAX, View, ViewRobot};
use super::CoerceSettings;
use super::attack::{AttackPlan, AttackSearch, CellValues, PassOrigin, PassValue, Worth, best_attack};
use super::coercing::{CoercePlan, Coercer, Pair, coerce, pairs};
use super::detect::{Detected, Detector};
use super::tactics::{CoerceSituation, Models};

/// The plan of a free kick, with its reasons.
#[derive(Clone, Debug, PartialEq)]
pub struct CapPlan {
    /// The robot that takes the kick.
    pub kicker: RobotId,
    /// The estimated tactic of each opponent (step 1).
    pub detected: heapless::Vec<Detected, ROBOTS_MAX>,
    /// The attack against the opponents that follow the ball only (step 2).
    pub optimistic: AttackPlan,
    /// The value of every cell in that attack.
    pub values: CellValues,
    /// The robots that coerce, with their opponents (step 3).
    pub coerce: CoercePlan,
    /// The robots that coerce no opponent and attack.
    pub attackers: heapless::Vec<RobotId, ROBOTS_MAX>,
}

impl CapPlan {
    /// The part of a robot of ours in the coerce plan.
    pub fn coercer(&self, robot: RobotId) -> Option<&Coercer> {
        self.coerce.coercers.iter().find(|coercer| coercer.robot == robot)
    }
}

/// Whether the opponents reacted as expected (step 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Followed {
    /// All that follow robots are where they were expected: the optimistic attack is kept.
    AsExpected {
        /// Largest distance of one from its expected place, m; 0 where none was coerced.
        worst: f32,
    },
    /// One is not: a new attack against all opponents.
    Otherwise {
        /// The opponent that is farthest off.
        opponent: RobotId,
        /// Distance from where it was expected, m.
        off: f32,
    },
    /// Followers are where expected, but others obstruct the pass: a new attack.
    Unlikely {
        /// P(receive | x) against all opponents.
        receive: f32,
    },
    /// Followers are where expected, but the attack's receiver, a coercer to be used again, is marked: a new
    /// attack.
    ReceiverMarked {
        /// The opponent that marks the receiver.
        opponent: RobotId,
        /// Distance from it to the receiver, m.
        near: f32,
    },
}

/// The attack that is played (steps 6 and 7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinalAttack {
    /// The pass and the shot after it.
    pub plan: AttackPlan,
    /// Reaction of the opponents to the coercion.
    pub followed: Followed,
    /// Whether the receiver has coerced an opponent before (the paper's Table 1 counts them).
    pub reused: bool,
}

/// Progress of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoerceProgress {
    /// No plan, as outside free kicks.
    Idle,
    /// Robots go to the places of the coerce plan (step 4).
    Coercing {
        /// Number of coercers that have arrived.
        arrived: usize,
        /// Number of coercers of the plan.
        of: usize,
        /// Time left for coercing, s.
        left: f32,
    },
    /// The attack has started (step 7): the pass goes to the receiver, ahead of it.
    Attacking(FinalAttack),
    /// The plan has ended.
    Over(CoerceEnd),
}

/// Why it has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoerceEnd {
    /// The ball is in play.
    InPlay,
    /// The referee has changed the command.
    Stopped,
    /// No robot can receive a pass anywhere, or kicker or receiver are missing.
    NoAttack,
}

/// A robot's part in the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoercePart {
    /// Takes the free kick.
    Takes,
    /// Draws this opponent away.
    Coerces {
        /// The opponent that follows the robot.
        marker: RobotId,
        /// Expected place of the opponent then, m.
        expected: Point<Attack>,
    },
    /// Holds its place until the attack: a robot that moves there early reveals the pass.
    Waits,
    /// Receives the pass, at that place, moving there at the time that pass-ahead sets.
    Receives,
}

/// The place and part of one robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posting {
    /// Our robot, by its number.
    pub robot: RobotId,
    /// Place that it goes to, attack frame, m.
    pub at: Point<Attack>,
    /// Part of the robot in the plan.
    pub part: CoercePart,
}

/// State of the planner between snapshots.
#[derive(Clone, Debug)]
pub struct Planner {
    settings: CoerceSettings,
    detector: Detector,
    seed: u64,
    plan: Option<CapPlan>,
    /// When coercing started: with the free kick, or with the plan.
    begun: Option<Instant>,
    /// When the last coercer arrived.
    arrived: Option<Instant>,
    attack: Option<FinalAttack>,
    over: Option<CoerceEnd>,
}

impl Planner {
    /// A planner without observations.
    pub fn new(settings: CoerceSettings, models: Models) -> Self {
        Self {
            settings,
            detector: Detector::new(models),
            seed: 0,
            plan: None,
            begun: None,
            arrived: None,
            attack: None,
            over: None,
        }
    }

    /// The plan, if there is one.
    pub fn current(&self) -> Option<&CapPlan> {
        self.plan.as_ref()
    }

    /// Takes a snapshot for step 1; from some time before the plan is requested, on STOP for instance.
    pub fn observe(&mut self, view: &View, kicker: RobotId) {
        self.detector.watch(view, Some(kicker));
    }

    /// Steps 1 to 3, for our free kick with `kicker` at the ball. `None` where no attack is possible.
    pub fn plan(
        &mut self,
        view: &View,
        value: &dyn PassValue,
        kicker: RobotId,
        seed: u64,
    ) -> Option<&CapPlan> {
        (self.seed, self.begun, self.arrived, self.attack, self.over) = (seed, None, None, None, None);
        self.plan = self.make(view, value, kicker);
        if self.plan.is_none() {
            self.over = Some(CoerceEnd::NoAttack);
        }
        self.plan.as_ref()
    }

    fn make(&self, view: &View, value: &dyn PassValue, kicker: RobotId) -> Option<CapPlan> {
        let detected = self.detector.read(view, Some(kicker));
        let players: heapless::Vec<RobotId, ROBOTS_MAX> =
            view.ours.iter().map(|robot| robot.id).filter(|id| *id != view.keeper && *id != kicker).collect();
        let pairs = pairs(view, &detected, &players);
        let coerces = |id: &RobotId| pairs.iter().any(|pair: &Pair| pair.robot == *id);
        let attackers: heapless::Vec<RobotId, ROBOTS_MAX> =
            players.iter().copied().filter(|id| !coerces(id)).collect();
        // All of them coerce: one will be used again.
        let receivers = if attackers.is_empty() { &players } else { &attackers };
        let imagined = optimistic(view, &detected, kicker, receivers);
        let (attack, values) = best_attack(&imagined, value, self.search(kicker), receivers);
        let attack = attack?;
        let situation = CoerceSituation::new(view, *self.detector.models(), Some(kicker));
        let coerce = coerce(value, &situation, &pairs, &attack, &self.settings);
        Some(CapPlan { kicker, detected, optimistic: attack, values, coerce, attackers })
    }

    /// Handles an attack that has become unlikely before the ball left: another one is searched while there
    /// is time to coerce; false where there is none.
    pub fn reconsider(&mut self, now: Instant) -> bool {
        let left = self.begun.is_some_and(|begun| now.since(begun).as_secs_f32() < self.settings.coerce_time);
        if self.over.is_none() && left {
            self.attack = None;
        }
        self.over.is_none() && left
    }

    /// Steps 4 to 7: progress of the plan in this snapshot.
    pub fn watch(&mut self, view: &View, value: &dyn PassValue) -> CoerceProgress {
        if let Some(end) = self.over {
            return CoerceProgress::Over(end);
        }
        let Some(plan) = &self.plan else { return CoerceProgress::Idle };
        self.detector.watch(view, Some(plan.kicker));
        let end = match view.phase {
            Phase::FreeKick(Side::Ours) | Phase::Stop | Phase::BallPlacement(Side::Ours) => None,
            Phase::Run => Some(CoerceEnd::InPlay),
            _ => Some(CoerceEnd::Stopped),
        };
        let gone = view.our(plan.kicker).is_none()
            || self.attack.is_some_and(|attack| view.our(attack.plan.receiver).is_none());
        if let Some(end) = end.or(gone.then_some(CoerceEnd::NoAttack)) {
            self.over = Some(end);
            return CoerceProgress::Over(end);
        }
        if let Some(attack) = self.attack {
            return CoerceProgress::Attacking(attack);
        }
        let free_kick = view.phase == Phase::FreeKick(Side::Ours);
        let coercers = &plan.coerce.coercers;
        let of = coercers.len();
        let arrived = coercers.iter().filter(|coercer| self.has_arrived(view, coercer)).count();
        if arrived == of {
            self.arrived.get_or_insert(view.now);
        } else {
            self.arrived = None;
        }
        if !free_kick {
            return CoerceProgress::Coercing { arrived, of, left: self.settings.coerce_time };
        }
        let begun = *self.begun.get_or_insert(view.now);
        let left = self.settings.coerce_time - view.now.since(begun).as_secs_f32();
        let settled = self
            .arrived
            .is_some_and(|since| of == 0 || view.now.since(since).as_secs_f32() >= self.settings.follow_time);
        if !settled && left > 0.0 {
            return CoerceProgress::Coercing { arrived, of, left };
        }
        let attack = self.attack_now(view, value, plan);
        self.attack = attack;
        if let Some(attack) = attack {
            return CoerceProgress::Attacking(attack);
        }
        if left > 0.0 {
            // A robot that still moves may open a path.
            return CoerceProgress::Coercing { arrived, of, left };
        }
        self.over = Some(CoerceEnd::NoAttack);
        CoerceProgress::Over(CoerceEnd::NoAttack)
    }

    fn search(&self, kicker: RobotId) -> AttackSearch {
        AttackSearch { kicker, least: self.settings.least, seed: self.seed }
    }

    /// Step 6: the final attack.
    fn attack_now(&self, view: &View, value: &dyn PassValue, plan: &CapPlan) -> Option<FinalAttack> {
        let followed = self.verify(view, value, plan);
        let coerced = |id: RobotId| plan.coercer(id).is_some();
        if matches!(followed, Followed::AsExpected { .. }) && view.our(plan.optimistic.receiver).is_some() {
            let reused = coerced(plan.optimistic.receiver);
            return Some(FinalAttack { plan: plan.optimistic, followed, reused });
        }
        // Against all opponents at their present places; by robots that are free, and coercers that no
        // opponent marks.
        let mut receivers: heapless::Vec<RobotId, ROBOTS_MAX> = plan.attackers.clone();
        let coercers = || plan.coerce.coercers.iter().map(|coercer| coercer.robot);
        receivers.extend(coercers().filter(|id| self.marked(view, *id).is_none()));
        if receivers.is_empty() {
            receivers.extend(coercers());
        }
        let (attack, _) = best_attack(view, value, self.search(plan.kicker), &receivers);
        attack.map(|attack| FinalAttack { plan: attack, followed, reused: coerced(attack.receiver) })
    }

    /// Step 5: whether the opponents reacted as expected.
    fn verify(&self, view: &View, value: &dyn PassValue, plan: &CapPlan) -> Followed {
        let mut worst: Option<(RobotId, f32)> = None;
        for coercer in &plan.coerce.coercers {
            // An opponent that left the field obstructs no pass.
            let Some(marker) = view.theirs.iter().find(|robot| robot.id == coercer.marker) else { continue };
            let off = marker.position.distance(coercer.expected);
            if worst.is_none_or(|(_, most)| off > most) {
                worst = Some((coercer.marker, off));
            }
        }
        match worst {
            Some((opponent, off)) if off > self.settings.expected_within => {
                return Followed::Otherwise { opponent, off };
            }
            _ => {}
        }
        let receiver = plan.optimistic.receiver;
        if plan.coercer(receiver).is_some()
            && let Some((opponent, near)) = self.marked(view, receiver)
        {
            return Followed::ReceiverMarked { opponent, near };
        }
        let mut worth: Option<Worth> = None;
        if let (Some(ball), Some(receiver)) = (view.ball, view.our(receiver)) {
            let mut place = [plan.optimistic.at].into_iter();
            let origin = PassOrigin { from: ball.position, kicker: plan.kicker };
            value.worths(view, origin, receiver, &mut place, &mut |_, now| {
                worth = Some(now);
            });
        }
        if let Some(worth) = worth.filter(|worth| !self.settings.least.allows(worth)) {
            return Followed::Unlikely { receive: worth.receive };
        }
        Followed::AsExpected { worst: worst.map_or(0.0, |(_, off)| off) }
    }

    /// The opponent that marks our robot, and its distance, m.
    fn marked(&self, view: &View, ours: RobotId) -> Option<(RobotId, f32)> {
        let at = view.our(ours)?.position;
        let nearest = view.nearest_theirs(at).map(|(robot, near)| (robot.id, near));
        nearest.filter(|(_, near)| *near < self.settings.marked_within)
    }

    /// The place and part of each robot now, by number.
    pub fn postings(&self, view: &View) -> heapless::Vec<Posting, ROBOTS_MAX> {
        let Some(plan) = self.plan.as_ref().filter(|_| self.over.is_none()) else {
            return heapless::Vec::new();
        };
        let players = view.ours.iter().filter(|robot| robot.id != view.keeper);
        players.map(|robot| self.posting(view, plan, robot)).collect()
    }

    fn posting(&self, view: &View, plan: &CapPlan, robot: &ViewRobot) -> Posting {
        let id = robot.id;
        let (at, part) = if id == plan.kicker {
            (view.ball.map_or(robot.position, |ball| ball.position), CoercePart::Takes)
        } else if let Some(attack) = self.attack.filter(|attack| attack.plan.receiver == id) {
            (attack.plan.at, CoercePart::Receives)
        } else if let Some(coercer) = plan.coercer(id) {
            let Coercer { marker, expected, .. } = *coercer;
            (coercer.at, CoercePart::Coerces { marker, expected })
        } else {
            (robot.position, CoercePart::Waits)
        };
        Posting { robot: id, at, part }
    }

    /// Whether a coercer is at its place; one that left the field holds up no plan.
    fn has_arrived(&self, view: &View, coercer: &Coercer) -> bool {
        let robot = view.our(coercer.robot);
        robot.is_none_or(|robot| robot.position.distance(coercer.at) < self.settings.arrived)
    }
}

/// The view without the opponents that follow robots, and of ours only with keeper, kicker and the receivers
/// (§4.2: "only … ball-following tactics" count; and coercers will have left).
fn optimistic(view: &View, detected: &[Detected], kicker: RobotId, receivers: &[RobotId]) -> View {
    let mut imagined = view.clone();
    let follows = |id| detected.iter().any(|known| known.opponent == id && known.follows_robots());
    imagined.theirs.retain(|robot| !follows(robot.id));
    imagined
        .ours
        .retain(|robot| robot.id == view.keeper || robot.id == kicker || receivers.contains(&robot.id));
    imagined
}
