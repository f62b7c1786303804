//! `plan`: faults of a swarm run: which faults are on, their strength, for which robots, and from when to
//! when.
//!
//! Everything is drawn from the seed, faults independently of each other, so that a few thousand seeds
//! contain most pairs and triples of them. A run has a fault-free phase, a phase with all selected faults,
//! and a recovery phase, which starts for all faults at one moment. Times in ms.

use std::fmt;

use brain::BrainConfig;
use hil_sim::{AirSettings, Bursts, Stream};
use protocol::frame::TeamKey;
use protocol::{RobotId, TeamId};
use rules::League;

geometry::labels! {
    /// A kind of fault.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Fault {
        /// Packets are lost independently, up to half of them.
        Loss = "Loss",
        /// Packets are lost in bursts.
        Bursts = "Bursts",
        /// Packets are duplicated, up to half of them.
        Duplication = "Duplication",
        /// Packets overtake each other.
        Reordering = "Reordering",
        /// Packets have a long delay.
        Delay = "Delay",
        /// The team is partitioned into two parts that do not receive each other.
        Partition = "Partition",
        /// Robots' computers crash and reboot.
        Reboot = "Reboot",
        /// Robots' clocks run 100 ppm fast or slow, and started long ago.
        Skew = "Skew",
        /// A second host sends with the team's key.
        SecondHost = "SecondHost",
        /// Earlier packets are sent again: from this epoch of the receiver, from an earlier one, and from an
        /// earlier match.
        Replays = "Replays",
        /// Other teams are on the radio, and a sender who guesses keys.
        Foreign = "Foreign",
        /// Bits of packets flip.
        FlippedBits = "FlippedBits",
        /// A sensor repeats the same values.
        Stuck = "Stuck",
        /// A sensor reports NaN.
        NotANumber = "NotANumber",
        /// A robot lies on its side, spins, or has an empty battery.
        Body = "Body",
    }
}

/// The robots of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Squad {
    /// Walking robots without a host.
    Legged,
    /// Robots on wheels with a host.
    Wheels,
}

impl Squad {
    /// Period of a brain's tick, ms (docs/architecture.md §2.3).
    pub const fn tick_ms(self) -> u32 {
        match self {
            Self::Legged => 40,
            Self::Wheels => 10,
        }
    }
}

/// A time span of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// From this moment, ms.
    pub from: u32,
    /// Until before this one, ms.
    pub to: u32,
}

impl Span {
    /// Whether that moment is in it.
    pub fn has(self, ms: u32) -> bool {
        (self.from..self.to).contains(&ms)
    }
}

/// Fault of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorFault {
    /// The frame at its start is repeated.
    Stuck,
    /// The numbers whose bits are set are NaN: odometry, battery, pose, ball.
    NotANumber(u8),
    /// It lies on its side.
    Tipped,
    /// It turns at this rate, rad/s.
    Spins(f32),
    /// Its battery has this voltage, V.
    Battery(f32),
    /// Its break-beam sensor reports this.
    Contact(bool),
}

/// A run: its robots, its faults and their times.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Seed from which everything is drawn.
    pub seed: u64,
    /// Kind of the robots: legs or wheels.
    pub squad: Squad,
    /// The faults that are on.
    pub on: Vec<Fault>,
    /// The team's robots, lowest number first, in their first epoch of the run.
    pub brains: Vec<BrainConfig>,
    /// Key of the team's radio.
    pub key: TeamKey,
    /// The phase with all selected faults.
    pub trouble: Span,
    /// End of the run, ms.
    pub end: u32,
    /// The radio settings during that phase.
    pub air: AirSettings,
    /// When the team is partitioned, and the members of the second part; bit 16 is the host.
    pub partition: Option<(Span, u32)>,
    /// Robots whose computers crash, from the crash to the reboot.
    pub reboots: Vec<(RobotId, Span)>,
    /// Robots whose sensors are faulty, when and how.
    pub sensor_faults: Vec<(RobotId, Span, SensorFault)>,
    /// When a second host sends, and whether its epoch is the later one.
    pub second_host: Option<(Span, bool)>,
    /// Probability that a robot receives a replayed packet in a tick.
    pub replays: f32,
    /// Probability that it receives a foreign packet.
    pub foreign: f32,
    /// Probability that a packet's bits flip on the path to one robot.
    pub flips: f32,
}

impl Plan {
    /// The run of that seed.
    pub fn drawn(seed: u64) -> Self {
        let mut chance = Stream::new(seed, "swarm plan");
        let squad = if seed.is_multiple_of(2) { Squad::Legged } else { Squad::Wheels };
        let on: Vec<Fault> = Fault::ALL
            .into_iter()
            .filter(|_| chance.chance(ON))
            .filter(|fault| *fault != Fault::SecondHost || squad == Squad::Wheels)
            .collect();
        let has = |fault| on.contains(&fault);
        let from = chance.whole(1_500, 2_500);
        let trouble = Span { from, to: from + chance.whole(1_500, 5_000) };
        let brains = team(seed, squad, &mut chance);
        let ids: Vec<RobotId> = brains.iter().map(|brain| brain.robot).collect();
        let some = |chance: &mut Stream| ids[chance.whole(0, ids.len() as u32 - 1) as usize];
        let within = |chance: &mut Stream, longest: u32| {
            let from = chance.whole(trouble.from, trouble.to - 1);
            Span { from, to: (from + chance.whole(1, longest)).min(trouble.to) }
        };
        let air = air(&on, squad, &mut chance);
        let partition = has(Fault::Partition).then(|| {
            let members = chance.whole(1, (1 << 17) - 1);
            (within(&mut chance, 3_000), members)
        });
        let mut reboots: Vec<(RobotId, Span)> = Vec::new();
        for _ in 0..if has(Fault::Reboot) { chance.whole(1, 4) } else { 0 } {
            let (robot, span) = (some(&mut chance), within(&mut chance, 2_000));
            // One at a time per robot: a computer that is off cannot be switched off.
            let apart = |other: &(RobotId, Span)| {
                other.0 != robot || span.to + 200 < other.1.from || other.1.to + 200 < span.from
            };
            if reboots.iter().all(apart) {
                reboots.push((robot, span));
            }
        }
        let mut sensor_faults = Vec::new();
        for fault in [Fault::Stuck, Fault::NotANumber, Fault::Body] {
            for _ in 0..if has(fault) { chance.whole(1, 3) } else { 0 } {
                let (robot, span) = (some(&mut chance), within(&mut chance, 2_500));
                sensor_faults.push((robot, span, sensor_fault(fault, &mut chance)));
            }
        }
        let second_host = has(Fault::SecondHost).then(|| (within(&mut chance, 4_000), chance.chance(0.5)));
        let key = TeamKey(std::array::from_fn(|_| chance.whole(0, 255) as u8));
        let mut rate = |fault, most: f32| if has(fault) { chance.between(0.0, most) } else { 0.0 };
        let (replays, foreign, flips) =
            (rate(Fault::Replays, 0.6), rate(Fault::Foreign, 0.6), rate(Fault::FlippedBits, 0.3));
        let end = trouble.to + AFTERWARDS;
        Self {
            seed,
            squad,
            on,
            brains,
            key,
            trouble,
            end,
            air,
            partition,
            reboots,
            sensor_faults,
            second_host,
            replays,
            foreign,
            flips,
        }
    }

    /// A run of `ms` milliseconds whose only faults are those of the radio.
    pub fn with_air(seed: u64, squad: Squad, ms: u32, air: AirSettings) -> Self {
        let mut chance = Stream::new(seed, "swarm plan");
        let trouble = Span { from: 2_000, to: 2_000 + ms };
        Self {
            seed,
            squad,
            on: Vec::new(),
            brains: team(seed, squad, &mut chance),
            key: TeamKey::ZERO,
            trouble,
            end: trouble.to + AFTERWARDS,
            air,
            partition: None,
            reboots: Vec::new(),
            sensor_faults: Vec::new(),
            second_host: None,
            replays: 0.0,
            foreign: 0.0,
            flips: 0.0,
        }
    }

    /// Numbers of the team's robots, lowest first.
    pub fn ids(&self) -> impl Iterator<Item = RobotId> + '_ {
        self.brains.iter().map(|brain| brain.robot)
    }

    /// The radio settings at that moment.
    pub fn air_at(&self, ms: u32) -> AirSettings {
        if !self.trouble.has(ms) {
            return AirSettings::default();
        }
        let mut air = self.air.clone();
        if let Some((_, members)) = self.partition.filter(|(span, _)| span.has(ms)) {
            air.groups = std::array::from_fn(|i| u8::from(members & (1 << i) != 0));
            air.host_group = u8::from(members & (1 << RobotId::COUNT) != 0);
        }
        air
    }

    /// Moments at which the radio settings change, in order.
    pub fn air_changes(&self) -> Vec<u32> {
        let mut all = vec![self.trouble.from, self.trouble.to];
        all.extend(self.partition.iter().flat_map(|(span, _)| [span.from, span.to]));
        all.sort_unstable();
        all.dedup();
        all
    }
}

impl fmt::Display for Plan {
    /// The robots, the faults and their times.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let robots: Vec<String> = self.ids().map(|id| id.to_string()).collect();
        write!(f, "{:?} {}: ", self.squad, robots.join(" "))?;
        let faults: Vec<_> = self.on.iter().map(|fault| fault.label()).collect();
        let faults = if faults.is_empty() { "nothing".into() } else { faults.join(", ") };
        write!(f, "{faults} from {} to {} ms", self.trouble.from, self.trouble.to)
    }
}

fn team(seed: u64, squad: Squad, chance: &mut Stream) -> Vec<BrainConfig> {
    let size = chance.whole(2, 4) as usize;
    let lone = chance.chance(0.3).then(|| chance.whole(0, size as u32 - 1) as usize);
    let numbers = [1, 2, 5, 9].into_iter().filter_map(RobotId::new).take(size);
    let brain = |(i, id): (usize, RobotId)| {
        let base = match squad {
            Squad::Legged => BrainConfig::new(id, TEAM),
            Squad::Wheels => BrainConfig::hosted(id, TEAM, League::DivisionB),
        };
        // Epochs before this one were recorded.
        let epoch = FIRST_BOOT_EPOCH + (seed % 3) as u32;
        BrainConfig { epoch, retriever: lone.is_none_or(|lone| lone == i), ..base }
    };
    numbers.enumerate().map(brain).collect()
}

fn air(on: &[Fault], squad: Squad, chance: &mut Stream) -> AirSettings {
    let has = |fault| on.contains(&fault);
    let mut air = AirSettings::default();
    if has(Fault::Loss) {
        air.loss = chance.between(0.0, 0.5);
    }
    if has(Fault::Bursts) {
        let ms = chance.between(40.0, 400.0);
        air.bursts = Some(Bursts { share: chance.between(0.05, 0.5), ticks: ms / squad.tick_ms() as f32 });
    }
    if has(Fault::Duplication) {
        air.duplication = chance.between(0.0, 0.5);
    }
    if has(Fault::Reordering) {
        air.reordering = chance.between(0.0, 0.5);
        // A packet that is received in the next tick anyway cannot overtake another.
        air.delay = [1, 2];
    }
    if has(Fault::Delay) {
        air.delay = [1, 1 + chance.whole(40, 300) / squad.tick_ms()];
    }
    air
}

fn sensor_fault(fault: Fault, chance: &mut Stream) -> SensorFault {
    match (fault, chance.whole(0, 3)) {
        (Fault::Stuck, 0) => SensorFault::Contact(chance.chance(0.5)),
        (Fault::Stuck, _) => SensorFault::Stuck,
        (Fault::NotANumber, _) => SensorFault::NotANumber(chance.whole(1, 15) as u8),
        (_, 0 | 1) => SensorFault::Tipped,
        (_, 2) => SensorFault::Spins(if chance.chance(0.5) { 45.0 } else { -45.0 }),
        (_, _) => SensorFault::Battery(chance.between(5.0, 13.9)),
    }
}

/// The team of the run.
pub const TEAM: TeamId = TeamId(1);
/// Epochs before this one were recorded, and the recordings are replayed.
pub const FIRST_BOOT_EPOCH: u32 = 5;
/// Share of the runs in which each fault is on: five of fifteen in a typical one.
const ON: f32 = 0.35;
/// Time for which the team is checked after everything has healed, ms.
const AFTERWARDS: u32 = 3_000;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_few_hundred_seeds_meet_every_pair_of_faults_on_wheels() {
        let mut pairs = BTreeSet::new();
        for seed in (1..600).step_by(2) {
            let on = Plan::drawn(seed).on;
            pairs.extend(on.iter().flat_map(|a| on.iter().map(move |b| (*a, *b))));
        }
        assert_eq!(pairs.len(), Fault::ALL.len() * Fault::ALL.len());
    }

    #[test]
    fn faults_are_on_only_in_the_trouble_span() {
        for seed in 0..400 {
            let plan = Plan::drawn(seed);
            let outside = |span: &Span| span.from < plan.trouble.from || span.to > plan.trouble.to;
            assert!(!plan.reboots.iter().any(|(_, span)| outside(span)), "seed {seed}");
            assert!(!plan.sensor_faults.iter().any(|(_, span, _)| outside(span)), "seed {seed}");
            assert!(!plan.second_host.iter().any(|(span, _)| outside(span)), "seed {seed}");
            for ms in [plan.trouble.from - 1, plan.trouble.to] {
                assert_eq!(plan.air_at(ms), AirSettings::default(), "seed {seed}");
            }
        }
    }
}
