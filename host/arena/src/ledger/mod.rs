//! `ledger`: what became of every case that a team played: how often it was retrieved, how its plays ended,
//! whether its passes arrived, and what followed. Cycles and their problems as robots report them by radio;
//! the ball as [`AttackWatch`] judges it. s.
//!
//! | word | meaning |
//! |---|---|
//! | retrieved | a coordinator decided to play the case |
//! | ends | [`CycleEnd`]'s labels; `running` for a play that has not ended |
//! | pass | a kick that is no shot ([`attack`](crate::attack)) by one of the play's robots while it plays |
//! | followed by | the best of goal, shot, loss, out and stop in the play's window |
//! | window | from the decision until the team's possession ends or play stops, at the latest [`FOLLOWS_WITHIN`] after the play's end; a goal counts until [`REBOUND_WITHIN`] after a shot that ended the possession |
//! | opponents | their number in the problem that was decided on; where no robot reported it, those that the host saw |

mod situation;
mod table;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use host::Host;
use protocol::decision::{DecisionReport, Grounds};
use protocol::team::CycleState;
use protocol::{CaseId, CycleId, RobotId};
use rules::Colour;

pub use situation::Situation;
pub use table::{CaseLine, CaseTable, CaseTally, FOLLOWED, Followed, SituationTally};

use crate::attack::{AttackWatch, BallEvent, BallLook, HostView};
use crate::cycles::{CycleEnd, CycleEvent, CycleLog, CycleSeen};
use crate::names::CaseNames;
use situation::Possessions;

/// After a play's end, what follows within this time counts for it, s.
pub const FOLLOWS_WITHIN: f64 = 10.0;
/// A goal within this time of the shot that ended a possession is that shot's, s.
pub const REBOUND_WITHIN: f64 = 2.0;

/// The ledgers of both teams, over the same ball.
#[derive(Clone, Debug, Default)]
pub struct MatchLedger {
    attack: AttackWatch,
    view: HostView,
    teams: [TeamLedger; 2],
    possessions: Possessions,
}

impl MatchLedger {
    /// Takes a moment of a match whose true state is known, and what these hosts have received by radio.
    pub fn look(&mut self, look: &BallLook<'_>, hosts: &[&Host]) {
        self.attack.look(look);
        self.possessions.look(look, &self.attack);
        for host in hosts {
            self.team_mut(host.settings().us).receive(host, look.now);
        }
        self.follow(look.now);
    }

    /// Takes a moment as `feed` sees it, and what these hosts have received by radio.
    pub fn look_through(&mut self, feed: &Host, hosts: &[&Host], now: f64) {
        for host in hosts {
            self.team_mut(host.settings().us).receive(host, now);
        }
        if let Some(look) = self.view.look(feed, now) {
            self.attack.look(&look);
            self.possessions.look(&look, &self.attack);
            self.follow(now);
        }
    }

    fn follow(&mut self, now: f64) {
        for event in self.attack.events() {
            for (team, ledger) in [Colour::Yellow, Colour::Blue].into_iter().zip(&mut self.teams) {
                ledger.follow(team, now, event);
            }
        }
    }

    /// Possessions, kicks and shots of both teams.
    pub fn attack(&self) -> &AttackWatch {
        &self.attack
    }

    /// The ledger of a team.
    pub fn team(&self, team: Colour) -> &TeamLedger {
        &self.teams[team as usize]
    }

    /// The plays of a team by case, and its possessions by situation. Where the match is over, plays that
    /// have not ended end with it.
    pub fn table(&self, team: Colour, names: &CaseNames, over: bool) -> CaseTable {
        let ledger = self.team(team);
        CaseTable { by_situation: self.possessions.of(team, ledger, over), ..ledger.table(names, over) }
    }

    /// [`Self::table`] of these hosts' teams, by the team's name.
    pub fn tables(
        &self,
        hosts: &[&Host],
        names: &CaseNames,
        over: bool,
    ) -> BTreeMap<&'static str, CaseTable> {
        let teams = hosts.iter().map(|host| host.settings().us);
        teams.map(|us| (us.label(), self.table(us, names, over))).collect()
    }

    fn team_mut(&mut self, team: Colour) -> &mut TeamLedger {
        &mut self.teams[team as usize]
    }
}

/// The plays of one team.
#[derive(Clone, Debug, Default)]
pub struct TeamLedger {
    cycles: CycleLog,
    decided: BTreeMap<CycleId, Decided>,
    /// The cycles of the reports taken last, by robot: a host holds the newest until the next.
    taken: [Option<CycleId>; RobotId::COUNT],
}

/// Knowledge of a decided cycle beside the log of cycles.
#[derive(Clone, Copy, Debug)]
struct Decided {
    at: f64,
    opponents: usize,
    /// Grounds of the decision, once its coordinator has reported them.
    grounds: Option<Grounds>,
    passes: u32,
    arrived: u32,
    followed: Followed,
    window: Window,
}

/// The time in which events count for a play.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Window {
    Open,
    /// Only goals until then.
    Rebound(f64),
    /// Play has stopped: only the goal that it was stopped for.
    Stopped,
    Over,
}

impl TeamLedger {
    /// Takes the newest beacons and reports that the team's host has received.
    fn receive(&mut self, host: &Host, now: f64) {
        let opponents = host.world().theirs(host.settings().us).count();
        for robot in RobotId::all() {
            if let Some(state) = host.beacon(robot).and_then(|beacon| beacon.cycle.as_ref()) {
                self.hear(state, opponents, now);
            }
        }
        for robot in RobotId::all() {
            let taken = self.taken[robot.index()];
            let new = host.decision(robot).filter(|report| taken != Some(report.cycle));
            if let Some(report) = new
                && self.report(report)
            {
                self.taken[robot.index()] = Some(report.cycle);
            }
        }
    }

    /// A robot's beacon, while its host sees that number of opponents.
    fn hear(&mut self, state: &CycleState, opponents: usize, now: f64) {
        if let CycleEvent::Decided(place) = self.cycles.receive(now as f32, state) {
            let decided = Decided {
                at: now,
                opponents,
                grounds: None,
                passes: 0,
                arrived: 0,
                followed: Followed::Nothing,
                window: Window::Open,
            };
            self.decided.entry(self.cycles.cycles()[place].id).or_insert(decided);
        }
    }

    /// A coordinator's report of its decision; false where no beacon has reported it yet.
    fn report(&mut self, report: &DecisionReport) -> bool {
        let Some(decided) = self.decided.get_mut(&report.cycle) else { return false };
        if decided.grounds.replace(report.grounds).is_none() {
            decided.opponents = report.opponents.len();
        }
        true
    }

    fn follow(&mut self, us: Colour, now: f64, event: &BallEvent) {
        for (id, decided) in &mut self.decided {
            if decided.window == Window::Over {
                continue;
            }
            let Some(cycle) = seen(&self.cycles, *id) else { continue };
            decided.follow(cycle, us, now, event);
        }
    }

    /// The log of its cycles.
    pub fn cycles(&self) -> &CycleLog {
        &self.cycles
    }

    /// Every decision to play a case, in the order of cycles, with the best that followed it.
    pub fn plays(&self) -> impl Iterator<Item = (&CycleSeen, Followed)> {
        self.cycles.cycles().iter().filter(|cycle| cycle.play.is_some()).map(|cycle| {
            let decided = self.decided.get(&cycle.id);
            (cycle, decided.map_or(Followed::Nothing, |decided| decided.followed))
        })
    }

    /// Every decision to play a case: from when until when it was played, and the label of its end.
    fn spans(&self, over: bool) -> impl Iterator<Item = (f64, f64, &'static str)> {
        let plays = self.cycles.cycles().iter().filter(|cycle| cycle.play.is_some());
        plays.filter_map(move |cycle| {
            let until = cycle.end.map_or(f64::INFINITY, |(at, _)| f64::from(at));
            Some((self.decided.get(&cycle.id)?.at, until, end_label(cycle, over)))
        })
    }

    /// The plays by case. Where the match is over, plays that have not ended end with it.
    fn table(&self, names: &CaseNames, over: bool) -> CaseTable {
        let (mut table, mut tallies) = (CaseTable::default(), BTreeMap::new());
        for cycle in self.cycles.cycles() {
            let decided = self.decided.get(&cycle.id);
            let opponents = decided.map_or(0, |decided| decided.opponents);
            let Some(play) = &cycle.play else {
                if cycle.no_case {
                    let grounds = decided.and_then(|decided| decided.grounds);
                    table.add_no_case(opponents, because(grounds));
                }
                continue;
            };
            // The four stored cases of an authored one count together.
            let authored = CaseId(play.case.0 / 4 * 4);
            let tally: &mut CaseTally = tallies.entry((authored, opponents)).or_default();
            tally.count(
                end_label(cycle, over),
                decided.map_or((0, 0), |decided| (decided.passes, decided.arrived)),
                decided.map_or(Followed::Nothing, |decided| decided.followed),
            );
        }
        for ((case, opponents), tally) in &tallies {
            table.add(&names.of(*case), *opponents, tally);
        }
        table
    }
}

/// Reason for which no case is played, as a name for programs.
const fn because(grounds: Option<Grounds>) -> &'static str {
    match grounds {
        Some(Grounds::Retrieved) => "none-fits",
        Some(Grounds::Holds(_)) => "ball-is-held",
        Some(Grounds::BallRolls) => "ball-rolls",
        Some(Grounds::Proposed) => "proposed",
        Some(Grounds::ShootsSooner) => "shoots-sooner",
        Some(Grounds::NoBall) => "no-ball",
        None => "unreported",
    }
}

/// How a cycle ended; where the match is over, one that has not ended ends with it.
fn end_label(cycle: &CycleSeen, over: bool) -> &'static str {
    let end = cycle.end.map(|(_, end)| end).or(over.then_some(CycleEnd::TrialOver));
    end.map_or("running", CycleEnd::label)
}

fn seen(log: &CycleLog, id: CycleId) -> Option<&CycleSeen> {
    let cycles = log.cycles();
    cycles.binary_search_by_key(&id, |cycle| cycle.id).ok().map(|place| &cycles[place])
}

impl Decided {
    fn follow(&mut self, cycle: &CycleSeen, us: Colour, now: f64, event: &BallEvent) {
        let Some(play) = &cycle.play else {
            self.window = Window::Over;
            return;
        };
        let ended = cycle.end.map(|(at, _)| f64::from(at));
        if let BallEvent::Kick { by, at, arrived } = *event
            && by.colour == us
            && play.robots.contains(&by.id)
            && at >= self.at
            && ended.is_none_or(|end| at <= end)
        {
            self.passes += 1;
            self.arrived += u32::from(arrived);
        }
        let passed = match self.window {
            Window::Open => ended.is_some_and(|end| now > end + FOLLOWS_WITHIN),
            Window::Rebound(until) => now > until,
            Window::Stopped => *event == BallEvent::Resumed,
            Window::Over => true,
        };
        if passed {
            self.window = Window::Over;
            return;
        }
        let open = self.window == Window::Open;
        match *event {
            BallEvent::Goal { team } if team == us => {
                (self.followed, self.window) = (Followed::Goal, Window::Over);
            }
            BallEvent::Shot { by } if by.colour == us && open => {
                self.followed = self.followed.max(Followed::Shot);
            }
            BallEvent::Lost { team, end } if team == us && open => {
                let followed = Followed::from(end);
                let window = match followed {
                    Followed::Goal | Followed::Shot => Window::Rebound(now + REBOUND_WITHIN),
                    Followed::Loss => Window::Over,
                    // Play has stopped: a goal may be given for it.
                    Followed::Out | Followed::Stop | Followed::Nothing => Window::Open,
                };
                (self.followed, self.window) = (self.followed.max(followed), window);
            }
            BallEvent::Stopped => self.window = Window::Stopped,
            _ => {}
        }
    }
}
