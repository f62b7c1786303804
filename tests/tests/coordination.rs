//! `coordination`: tests: a team's invariants hold when packets are lost and robots crash
//! (docs/architecture.md §5.4, checked from outside).
//!
//! Every seed is a trial of its own in the four-legged simulator: its team size, its retrievers, its scenario
//! and its faults are drawn from the seed. A failure prints the seed; `ONETWO_SEED=N cargo test -p
//! match-tests --test coordination` repeats it alone, and `ONETWO_SEEDS=6000 cargo test --release -p
//! match-tests --test coordination -- --nocapture` is a longer run.

use std::collections::BTreeMap;

use brain::BrainConfig;
use hil_sim::{
    AirSettings, Configuration, Fault, NativeBackend, Noise, Parameters, Scenario, ScheduledFault,
    Simulation, SimulationConfig, Stream, TICK_US,
};
use match_tests::invariants::{Air, RECOVER_WITHIN, Seen, Watcher};
use match_tests::swarm::honest::{Believed, Honest, SentPackets};
use protocol::frame::TeamKey;
use protocol::link::overhear;
use protocol::team::TeamMessage;
use protocol::{CycleId, Instant, RobotId, TeamId};

/// The team of the trials.
const TEAM: TeamId = TeamId(0);
/// Default number of seeds of a test.
const SEEDS: u64 = 200;
/// Ticks of a trial: 12 s.
const TICKS: u32 = 300;

#[test]
fn without_loss_gameplays_do_not_overlap() {
    let counters = for_each_seed(|seed| {
        let team = Team::drawn(seed);
        watch(&team, AirSettings::default(), vec![], Air::Lossless)
    });
    assert!(counters.gameplays > counters.seeds || counters.seeds == 1, "{counters:?}");
}

#[test]
fn under_loss_robots_leave_a_gameplay_for_a_newer_one() {
    let counters = for_each_seed(|seed| {
        let air = AirSettings {
            loss: 0.3,
            delay: [1, 2],
            duplication: 0.05,
            reordering: 0.05,
            ..AirSettings::default()
        };
        watch(&Team::drawn(seed), air, vec![], Air::Lossy)
    });
    println!("30 % loss: {counters:?}");
    assert!(counters.gameplays > counters.seeds || counters.seeds == 1, "{counters:?}");
}

#[test]
fn a_robot_may_crash_and_return_at_any_time() {
    let counters = for_each_seed(|seed| {
        let team = Team::drawn(seed);
        let faults = crash_and_return(&team);
        watch(&team, AirSettings::default(), faults, Air::Lossless)
    });
    println!("crash and return: {counters:?}");
    assert!(counters.slowest_ms > 0 || counters.seeds == 1, "{counters:?}");
}

#[test]
fn a_robot_may_crash_and_return_while_packets_are_lost() {
    let counters = for_each_seed(|seed| {
        let team = Team::drawn(seed);
        let faults = crash_and_return(&team);
        watch(&team, AirSettings { loss: 0.3, delay: [1, 2], ..AirSettings::default() }, faults, Air::Lossy)
    });
    println!("crash and return under 30 % loss: {counters:?}");
    assert!(counters.slowest_ms > 0 || counters.seeds == 1, "{counters:?}");
}

#[test]
fn partitions_unite_within_a_second_of_healing() {
    for_each_seed(|seed| {
        let team = Team::drawn(seed);
        let mut chance = Stream::new(seed, "partition");
        let (cut, heal) = (chance.whole(20, 80), chance.whole(100, 180));
        let mut groups = [0; RobotId::COUNT];
        for (i, id) in team.ids.iter().enumerate() {
            groups[id.index()] = u8::from(i % 2 == 1);
        }
        let faults = vec![
            ScheduledFault { tick: cut, fault: Fault::Air(AirSettings { groups, ..AirSettings::default() }) },
            ScheduledFault { tick: heal, fault: Fault::Air(AirSettings::default()) },
        ];
        let mut simulation = team.simulation(AirSettings::default(), faults);
        let mut observer = Observer::new(Air::Lossy, &team);
        let mut united = None;
        for tick in 0..TICKS {
            observer.step(&mut simulation);
            let newest = observer.watcher.newest_by_robot();
            let same = newest.windows(2).all(|pair| pair[0] == pair[1]);
            if tick > heal && same && united.is_none() {
                united = Some(u64::from(tick - heal) * TICK_US);
            }
        }
        let united = united.unwrap_or(u64::MAX);
        if united > RECOVER_WITHIN.0 {
            return Err(format!("not one team {} ms after healing", united / 1000));
        }
        report(&observer.watcher)
    });
}

/// At a time drawn from the seed a robot crashes, for up to three seconds. A third of the seeds each: any
/// robot, the lowest id (the elector), the coordinator of that moment.
fn crash_and_return(team: &Team) -> Vec<ScheduledFault> {
    let mut chance = Stream::new(team.seed, "crash");
    let at = chance.whole(30, 200);
    let victim = match team.seed % 3 {
        0 => team.ids[chance.whole(0, team.ids.len() as u32 - 1) as usize],
        1 => team.ids[0],
        _ => coordinator_at(team, at).unwrap_or(team.ids[0]),
    };
    let away = chance.whole(1, 75);
    vec![
        ScheduledFault { tick: at, fault: Fault::Crash(victim) },
        ScheduledFault { tick: at + away, fault: Fault::Return(victim) },
    ]
}

/// A team drawn from a seed.
struct Team {
    seed: u64,
    ids: Vec<RobotId>,
    retrievers: Vec<bool>,
}

impl Team {
    fn drawn(seed: u64) -> Self {
        let mut chance = Stream::new(seed, "team");
        let size = 2 + (seed % 3) as usize;
        let ids: Vec<RobotId> = [1, 2, 5, 9][..size].iter().filter_map(|&n| RobotId::new(n)).collect();
        // k = n or k = 1; the lone retriever may be any robot.
        let lone = (seed / 3 % 2 == 1).then(|| chance.whole(0, size as u32 - 1) as usize);
        let retrievers = (0..size).map(|i| lone.is_none_or(|lone| lone == i)).collect();
        Self { seed, ids, retrievers }
    }

    fn simulation(&self, air: AirSettings, faults: Vec<ScheduledFault>) -> Simulation<'static> {
        let parameters = Parameters::four_legged();
        let configuration = if self.seed.is_multiple_of(2) {
            Configuration::DefenderGoalie
        } else {
            Configuration::TwoDefenders
        };
        let scenario = Scenario::PAPER[(self.seed / 2 % 4) as usize];
        let brains = self.ids.iter().zip(&self.retrievers);
        let brains =
            brains.map(|(&id, &retriever)| BrainConfig { retriever, ..BrainConfig::new(id, TEAM) }).collect();
        let config = SimulationConfig {
            seed: self.seed,
            layout: scenario.layout(configuration, parameters, self.seed),
            configuration,
            brains,
            air,
            noise: Noise::NONE,
            parameters: parameters.clone(),
            faults,
        };
        let backend = Box::new(NativeBackend::new(case_library::four_legged()));
        Simulation::new(config, backend).expect("the simulation starts")
    }
}

#[derive(Clone, Copy, Debug, Default)]
#[allow(dead_code, reason = "read by Debug in the printed line")]
struct Counters {
    seeds: u32,
    cycles: u32,
    gameplays: u32,
    overlaps: u32,
    slowest_ms: u64,
}

/// Runs every seed, or the one that ONETWO_SEED names; panics with the first seed that fails.
fn for_each_seed(trial: impl Fn(u64) -> Result<Counters, String>) -> Counters {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let all = 0..number("ONETWO_SEEDS").unwrap_or(SEEDS);
    let seeds = number("ONETWO_SEED").map_or(all, |seed| seed..seed + 1);
    let mut sum = Counters::default();
    for seed in seeds {
        match trial(seed) {
            Ok(counters) => {
                sum.seeds += 1;
                sum.cycles += counters.cycles;
                sum.gameplays += counters.gameplays;
                sum.overlaps += counters.overlaps;
                sum.slowest_ms = sum.slowest_ms.max(counters.slowest_ms);
            }
            Err(what) => panic!(
                "seed {seed}: {what}\nrepeat: ONETWO_SEED={seed} cargo test -p match-tests --test coordination"
            ),
        }
    }
    sum
}

fn watch(team: &Team, air: AirSettings, faults: Vec<ScheduledFault>, kind: Air) -> Result<Counters, String> {
    let mut simulation = team.simulation(air, faults);
    let mut observer = Observer::new(kind, team);
    for _ in 0..TICKS {
        observer.step(&mut simulation);
    }
    report(&observer.watcher)
}

fn report(watcher: &Watcher) -> Result<Counters, String> {
    if let Some(violation) = watcher.violations().first() {
        let all = watcher.violations().len();
        return Err(format!("at {} ms: {} ({all} in all)", violation.at.0 / 1000, violation.what));
    }
    Ok(Counters {
        seeds: 1,
        cycles: watcher.cycles,
        gameplays: watcher.gameplays,
        overlaps: watcher.overlaps,
        slowest_ms: watcher.slowest_recovery.0 / 1000,
    })
}

/// Tells a watcher what happens in a trial: each beacon that a robot received and may believe.
struct Observer {
    watcher: Watcher,
    /// All packets sent so far.
    sent_packets: SentPackets,
    /// Each robot as a receiver, with its epoch.
    receivers: BTreeMap<RobotId, (u32, Honest)>,
}

impl Observer {
    fn new(kind: Air, team: &Team) -> Self {
        let epoch = BrainConfig::new(RobotId::ZERO, TEAM).epoch;
        let receivers = team.ids.iter().map(|&id| (id, (epoch, Honest::new(id, epoch)))).collect();
        Self { watcher: Watcher::new(kind), sent_packets: SentPackets::default(), receivers }
    }

    /// One tick of the trial.
    fn step(&mut self, simulation: &mut Simulation<'_>) {
        let tick = simulation.step().expect("native computers do not fail");
        let now = Instant(u64::from(tick.number) * TICK_US);
        if tick.number == 0 {
            for id in self.receivers.keys() {
                self.watcher.see(now, &Seen::Booted(*id));
            }
        }
        for fault in &tick.faults {
            match fault {
                Fault::Crash(id) => self.watcher.see(now, &Seen::Crashed(*id)),
                Fault::Return(id) => {
                    if let Some((epoch, receiver)) = self.receivers.get_mut(id) {
                        *epoch += 1;
                        *receiver = Honest::new(*id, *epoch);
                    }
                    self.watcher.see(now, &Seen::Booted(*id));
                }
                Fault::Air(_) | Fault::FlipOrderBit { .. } => {}
            }
        }
        for received in &tick.received {
            let receiver = self.receivers.get_mut(&received.to);
            let believed =
                receiver.and_then(|(_, robot)| robot.receive(&received.packet, &self.sent_packets));
            if let Some(Believed::Teammate(from, TeamMessage::Beacon(beacon))) = believed {
                self.watcher.see(now, &Seen::Received(received.to, from, beacon));
            }
        }
        for sent in &tick.sent {
            self.sent_packets.add(&sent.packet);
            if let Ok((from, TeamMessage::Beacon(beacon))) =
                overhear(&sent.packet, TEAM, &TeamKey::ZERO.of_team())
            {
                self.watcher.see(now, &Seen::Sent(from, beacon));
            }
        }
        self.watcher.end_of_step(now);
    }
}

/// The coordinator of the newest cycle at that tick, found by running the same trial up to it.
fn coordinator_at(team: &Team, tick: u32) -> Option<RobotId> {
    let mut simulation = team.simulation(AirSettings::default(), vec![]);
    let mut newest: Option<(CycleId, RobotId)> = None;
    for _ in 0..tick {
        let seen = simulation.step().expect("native computers do not fail");
        for sent in &seen.sent {
            if let Ok((_, TeamMessage::Beacon(beacon))) =
                overhear(&sent.packet, TEAM, &TeamKey::ZERO.of_team())
                && let Some(cycle) = beacon.cycle
                && newest.is_none_or(|(id, _)| cycle.id > id)
            {
                newest = Some((cycle.id, cycle.coordinator));
            }
        }
    }
    newest.map(|(_, coordinator)| coordinator)
}
