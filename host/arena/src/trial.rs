//! `trial`: a trial of the first paper (Ros et al. 2009 §5.1;
//! docs/architecture.md §7, docs/case-format.md §5). Robots 1, 2, … are A, B, … and attack +x.

use std::collections::BTreeMap;

use brain::{Approach, BrainConfig, Positioning};
use casebase::{CaseBase, RetrievalSettings};
use hil_sim::{
    AirSettings, Backend, Configuration, Layout, Noise, OpponentRole, Parameters, Party, Referee, Scenario,
    ScheduledFault, Simulation, SimulationConfig, SimulationError, Tick, TrialOutcome, TrialVerdict,
    four_legged::world::LeggedWorld,
};
use protocol::CycleId;
use protocol::decision::DecisionReport;
use protocol::frame::{TeamKey, TeamKeys};
use protocol::link::overhear;
use protocol::team::{Beacon, Closure, TeamMessage};
use protocol::{Duration, RobotId, TeamId};

use crate::activity::ActivityCount;
use crate::backups::BackupCount;
use crate::cycles::{CycleEnd, CycleEvent, CycleLog};
use crate::defaults::{self, DefaultWatch};
use crate::names::{CaseNames, Cast};
use crate::report::{Backups, CaseCounts, CycleReport, Possession, TrialReport, in_seconds};

/// All settings that a trial depends on except its backend.
#[derive(Clone, Debug)]
pub struct TrialConfig<'a> {
    /// The paper's scenario, which gives the start positions.
    pub scenario: Scenario,
    /// Start positions if it is no named scenario.
    pub layout: Option<Layout>,
    /// The opponents: defender and goalie, or two defenders.
    pub opponents: Configuration,
    /// Approach of the attackers.
    pub approach: Approach,
    /// Random seed of the trial.
    pub seed: u64,
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Start of a case's actions.
    pub positioning: Positioning,
    /// Attackers, 1 to 4; the paper has 2.
    pub robots: usize,
    /// Number of them that may retrieve: those with the highest ids, so that the elector need not be one
    /// (paper §4.1).
    pub retrievers: usize,
    /// Radio settings: loss, delay, duplication, reordering and bursts.
    pub air: AirSettings,
    /// Noise of the robots' perception.
    pub noise: Noise,
    /// Time that robots stand still after every cycle.
    pub pause_after_cycle: Duration,
    /// Whether the opponents stand still in that time too: "all robots stop" (paper §5.3).
    pub opponents_pause: bool,
    /// Scheduled faults.
    pub faults: Vec<ScheduledFault>,
    /// Parameters of the simulated world.
    pub parameters: Parameters,
    /// The case base in every robot.
    pub base: CaseBase<'a>,
    /// Names of its cases.
    pub names: CaseNames,
}

impl TrialConfig<'static> {
    /// Trial as in the paper's simulated experiments, with the built-in library of the four-legged league.
    pub fn new(scenario: Scenario, opponents: Configuration, approach: Approach, seed: u64) -> Self {
        let league = case_library::league(LEAGUE);
        Self {
            scenario,
            layout: None,
            opponents,
            approach,
            seed,
            settings: RetrievalSettings::default(),
            positioning: Positioning::default(),
            robots: 2,
            retrievers: 2,
            air: AirSettings::default(),
            noise: Noise::NONE,
            pause_after_cycle: Duration(0),
            opponents_pause: true,
            faults: Vec::new(),
            parameters: Parameters::four_legged().clone(),
            base: case_library::four_legged(),
            names: CaseNames::new(league.map_or(&[][..], |league| league.names).iter().copied()),
        }
    }
}

impl<'a> TrialConfig<'a> {
    /// The same trial with another library.
    pub fn with_library(self, base: CaseBase<'a>, names: CaseNames) -> Self {
        Self { base, names, ..self }
    }

    /// The simulator's configuration of this trial.
    pub fn simulation(&self) -> SimulationConfig {
        let ids = (1..=self.robots).filter_map(|n| RobotId::new(u8::try_from(n).ok()?));
        let brains = ids.enumerate().map(|(i, robot)| BrainConfig {
            retriever: self.robots - i <= self.retrievers,
            positioning: self.positioning,
            approach: self.approach,
            settings: self.settings.clone(),
            pause_after_cycle: self.pause_after_cycle,
            ..BrainConfig::new(robot, TEAM)
        });
        let layout = self
            .layout
            .clone()
            .unwrap_or_else(|| self.scenario.layout(self.opponents, &self.parameters, self.seed));
        SimulationConfig {
            seed: self.seed,
            layout,
            configuration: self.opponents,
            brains: brains.collect(),
            air: self.air.clone(),
            noise: self.noise,
            parameters: self.parameters.clone(),
            faults: self.faults.clone(),
        }
    }
}

/// An observer at the edge of the field that sees everything and has a radio receiver.
pub trait Watcher {
    /// Called after every tick.
    fn watch(&mut self, moment: &Moment<'_>);

    /// Called at the end of the trial.
    fn end(&mut self, _moment: &Moment<'_>, _report: &TrialReport) {}
}

/// View of a watcher at each tick.
pub struct Moment<'a> {
    /// Configuration of the trial being watched.
    pub config: &'a TrialConfig<'a>,
    /// Identities of the robots.
    pub cast: &'a Cast,
    /// The true state of the field at the end of the tick.
    pub world: &'a LeggedWorld,
    /// The tick's perceptions, kicks and packets.
    pub tick: &'a Tick,
    /// The referee, with its counts.
    pub referee: &'a Referee,
    /// Beacons of the tick, in order; packets that are no beacons of this team are left out.
    pub beacons: &'a [(RobotId, Beacon)],
    /// The cycles so far, these beacons included.
    pub cycles: &'a CycleLog,
    /// Changes of the cycles by these beacons.
    pub events: &'a [CycleEvent],
    /// The decisions that attackers made in this tick, with their problems; none of emulated robots.
    pub decisions: &'a [(RobotId, DecisionReport)],
}

/// Plays a trial to its end.
pub fn run<'a>(
    config: &TrialConfig<'a>,
    backend: Box<dyn Backend<'a> + 'a>,
    watchers: &mut [&mut dyn Watcher],
) -> Result<TrialReport, SimulationError> {
    let mut game = Game::new(config, backend)?;
    let verdict = loop {
        game.step(watchers)?;
        if let Some(verdict) = game.moment().referee.verdict() {
            break verdict;
        }
    };
    Ok(game.end(verdict, watchers))
}

/// A running trial; its caller ends it.
pub(crate) struct Game<'c, 'a> {
    config: &'c TrialConfig<'a>,
    backend: &'static str,
    simulation: Simulation<'a>,
    cast: Cast,
    activity: ActivityCount,
    /// Seconds from kick-off until which all robots stand still after a cycle.
    paused_until: f32,
    backups: BackupCount,
    cycles: CycleLog,
    defaults: DefaultWatch,
    beacons: Vec<(RobotId, Beacon)>,
    events: Vec<CycleEvent>,
    decisions: Vec<(RobotId, DecisionReport)>,
    /// The newest decided cycle of each robot.
    decided: BTreeMap<RobotId, CycleId>,
    keys: TeamKeys,
}

impl<'c, 'a> Game<'c, 'a> {
    /// A trial at kick-off.
    pub(crate) fn new(
        config: &'c TrialConfig<'a>,
        backend: Box<dyn Backend<'a> + 'a>,
    ) -> Result<Self, SimulationError> {
        let name = backend.name();
        let simulation = Simulation::new(config.simulation(), backend)?;
        let cast = Cast {
            attackers: simulation.attackers().map(|(id, _)| id).collect(),
            opponents: simulation.opponents().collect(),
        };
        Ok(Self {
            config,
            backend: name,
            activity: ActivityCount::default(),
            paused_until: 0.0,
            backups: BackupCount::new(cast.attackers.iter().copied()),
            simulation,
            cast,
            cycles: CycleLog::default(),
            defaults: DefaultWatch::default(),
            beacons: Vec::new(),
            events: Vec::new(),
            decisions: Vec::new(),
            decided: BTreeMap::new(),
            keys: TeamKey::ZERO.of_team(),
        })
    }

    /// Runs one tick and passes it to the watchers.
    pub(crate) fn step(&mut self, watchers: &mut [&mut dyn Watcher]) -> Result<(), SimulationError> {
        let tick = self.simulation.step()?;
        self.beacons.clear();
        self.events.clear();
        for sent in &tick.sent {
            let Ok((from, TeamMessage::Beacon(beacon))) = overhear(&sent.packet, TEAM, &self.keys) else {
                continue;
            };
            self.backups.receive(tick.time, from, beacon.role);
            if let Some(state) = &beacon.cycle {
                self.events.push(self.cycles.receive(tick.time, state));
                self.cycles.shoots(state.id, beacon.status.shot().unwrap_or_default());
            }
            self.beacons.push((from, beacon));
        }
        self.decisions.clear();
        for (robot, decision) in self.simulation.decisions() {
            if self.decided.insert(robot, decision.cycle) != Some(decision.cycle) {
                self.decisions.push((robot, decision));
            }
        }
        self.pause();
        self.watch_defaults();
        let paused = self.simulation.time() <= self.paused_until;
        self.activity.tick(self.simulation.world(), paused);
        let moment = self.moment();
        for watcher in watchers.iter_mut() {
            watcher.watch(&moment);
        }
        Ok(())
    }

    /// Stops the opponents, if they do so, where the attackers pause after a gameplay.
    fn pause(&mut self) {
        let pause = self.config.pause_after_cycle;
        if pause == Duration(0) {
            return;
        }
        let paused_after = |events: &CycleEvent| {
            let CycleEvent::Ended(place) = *events else { return false };
            let end = self.cycles.cycles().get(place).and_then(|cycle| cycle.end);
            // Without a case no gameplay was run that robots would pause after.
            matches!(end, Some((_, CycleEnd::Closed(closure))) if closure != Closure::NoCase)
        };
        if self.events.iter().any(paused_after) {
            self.paused_until = self.simulation.time() + pause.as_secs_f32();
            if self.config.opponents_pause {
                self.simulation.stop_opponents(pause);
            }
        }
    }

    /// Tracks whether the team plays by a case, and if not, why.
    fn watch_defaults(&mut self) {
        let Self { config, simulation, cast, cycles, defaults, events, .. } = self;
        for events in events.iter() {
            let (CycleEvent::Decided(i) | CycleEvent::Ended(i)) = *events else { continue };
            // Late reports of an older cycle have no effect any more.
            if let [cycle] = &cycles.cycles()[i..] {
                let deceleration = config.parameters.ball.deceleration;
                let problem = defaults::problem(simulation.world(), &cast.attackers, deceleration);
                defaults.receive(cycle, &problem, &config.base, &config.settings);
            }
        }
        defaults.tick();
    }

    /// The state at the end of the last tick.
    pub(crate) fn moment(&self) -> Moment<'_> {
        Moment {
            config: self.config,
            cast: &self.cast,
            world: self.simulation.world(),
            tick: self.simulation.tick(),
            referee: self.simulation.referee(),
            beacons: &self.beacons,
            cycles: &self.cycles,
            events: &self.events,
            decisions: &self.decisions,
        }
    }

    pub(crate) fn end(mut self, verdict: TrialVerdict, watchers: &mut [&mut dyn Watcher]) -> TrialReport {
        self.cycles.finish(verdict.time);
        let report = self.report(verdict);
        let moment = self.moment();
        for watcher in watchers.iter_mut() {
            watcher.end(&moment, &report);
        }
        report
    }

    fn report(&self, verdict: TrialVerdict) -> TrialReport {
        let (config, referee) = (self.config, self.simulation.referee());
        let out_by = referee.last_touch().filter(|_| verdict.outcome == TrialOutcome::Out).map(Party::label);
        TrialReport {
            scenario: config.scenario,
            opponents: config.opponents,
            approach: approach_label(config.approach),
            backend: self.backend,
            seed: config.seed,
            outcome: verdict.outcome,
            time_s: in_seconds(verdict.time),
            possession: Possession {
                defender: referee.possessions(OpponentRole::Defender),
                midfield: referee.possessions(OpponentRole::Midfield),
            },
            backups: Backups(self.backups.counts()),
            out_by,
            cases: CaseCounts::of(self.cycles.cycles()),
            cycles: (self.cycles.cycles().iter())
                .map(|cycle| CycleReport::new(cycle, &config.names, verdict.time))
                .collect(),
            trace_hash: self.simulation.trace().digits(),
            settings: (config.settings.describe())
                .map(|(name, value)| (name, value.as_str().to_owned()))
                .collect(),
            positioning: positioning_label(config.positioning),
            case_base: format!("{:08x}", config.base.hash()),
            default: (config.approach != Approach::Reactive).then(|| self.defaults.report()),
            activity: self.activity.report(),
        }
    }
}

/// The label of an approach in options and reports.
pub const fn approach_label(approach: Approach) -> &'static str {
    match approach {
        Approach::Cases => "cbr",
        Approach::Reactive => "reactive",
        Approach::Hybrid => "hybrid",
    }
}

/// The approach with this label.
pub fn approach_from_label(label: &str) -> Option<Approach> {
    APPROACHES.into_iter().find(|approach| approach_label(*approach) == label)
}

/// All approaches, in the order of tables: the paper's two first.
pub const APPROACHES: [Approach; 3] = [Approach::Cases, Approach::Reactive, Approach::Hybrid];

/// The label of a positioning in options and reports.
pub const fn positioning_label(positioning: Positioning) -> &'static str {
    match positioning {
        Positioning::Dependent => "dependent",
        Positioning::Independent => "independent",
    }
}

/// The attackers' team on the radio.
pub const TEAM: TeamId = TeamId(1);
const LEAGUE: &str = "four-legged";

#[cfg(test)]
mod tests;
