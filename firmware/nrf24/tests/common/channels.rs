//! `channels`: one team in the modelled air, whose channel changes while it runs. Times in µs.

use nrf24::Rate;
use nrf24_model::{Air, Faults};
use protocol::Instant;
use protocol::serial::line;
use protocol::station::{self, StationMessage, StationReport};

use super::{Believer, Outcome, Plan, STEP, Team, serve, traffic};

/// One team whose channel changes while it runs.
pub(crate) struct Channels {
    pub(crate) air: Air,
    pub(crate) now: u64,
    /// The host sends nothing.
    pub(crate) is_silent: bool,
    /// Newest report on each robot, by number.
    pub(crate) reports: Vec<StationReport>,
    /// Sweeps and counts of the last scan.
    pub(crate) spectrum: Option<(u8, Vec<u8>)>,
    /// Frames believed twice or altered.
    pub(crate) wrong: u64,
    plan: Plan,
    team: Team,
}

impl Channels {
    pub(crate) fn new(faults: Faults, seed: u64) -> Self {
        Self::at(Rate::Mbps2, faults, seed)
    }

    pub(crate) fn at(rate: Rate, faults: Faults, seed: u64) -> Self {
        let plan = Plan { seed, ..Plan::one_team(rate, faults) };
        let air = Air::new(plan.faults, plan.seed);
        let team = Team::new(&air, 0, &plan);
        let (reports, spectrum) = (Vec::new(), None);
        Self { air, now: 0, is_silent: false, reports, spectrum, wrong: 0, plan, team }
    }

    pub(crate) fn run(&mut self, duration: u64) {
        let (until, mut outcome) = (self.now + duration, Outcome::default());
        while self.now < until {
            self.air.advance(self.now * 1_000);
            if !self.is_silent {
                traffic(&self.plan, &mut self.team, self.now, 0, false, &mut outcome);
            }
            serve(&mut self.team, self.now, &mut outcome);
            self.now += STEP;
        }
        self.wrong += outcome.twice + outcome.altered;
        for answer in self.team.answers.drain(..) {
            match answer {
                StationMessage::Report(report) => {
                    self.reports.retain(|known| known.robot != report.robot);
                    self.reports.push(report);
                }
                StationMessage::Spectrum(sweeps, counts) => self.spectrum = Some((sweeps, counts.to_vec())),
                other => panic!("a base station does not say {other:?}"),
            }
        }
    }

    pub(crate) fn order(&mut self, message: &StationMessage) {
        self.team.station.end.push(Instant(self.now), &line(&station::packet(message)));
        self.team.station_news = true;
    }

    /// The newest report; all name the same plan.
    pub(crate) fn report(&self) -> Option<StationReport> {
        self.reports.last().copied()
    }

    /// When the last robot believed its host again after that time; `None`: not all did.
    pub(crate) fn all_heard_after(&self, since: u64) -> Option<u64> {
        let first = |robot: &Believer| robot.host_times.iter().find(|at| **at > since).copied();
        self.team.at_robots.iter().map(first).try_fold(0, |last, at| Some(last.max(at?)))
    }

    pub(crate) fn robots_are_at(&self, megahertz: u8) -> bool {
        self.team.robots.iter().all(|robot| robot.end.channel().megahertz == megahertz)
    }

    pub(crate) fn power_robots(&self, on: bool) {
        self.team.robots.iter().for_each(|robot| robot.chip.power(on));
    }

    pub(crate) fn reset_base(&self) {
        self.team.station.chip.power(false);
        self.team.station.chip.power(true);
    }
}
