//! `legged`: a trial of the four-legged league on the page: the true state of the field, and the attackers'
//! radio messages.

use arena::{CycleEvent, Moment, TrialReport, Watcher};
use casebase::CaseBase;
use page::{
    Cycle, DecisionNote, Intent, Match, MatchEvent, MatchEventKind, Page, PageTeam, RobotDetail, Scene,
    SceneRobot, Shape, Tone, milli,
};
use protocol::RobotId;
use protocol::team::{Beacon, CycleState, Role};
use rules::{Colour, League};

use super::composer::field_of;
use super::cycles::reported;
use super::description;
use super::layers::{self, Played};

/// The ball's trail, in ticks of 40 ms.
const TRAIL_TICKS: usize = 40;

/// Keeps a trial's course for the page. Attackers are blue, opponents yellow.
pub struct Legged {
    page: Page,
    base: CaseBase<'static>,
    beacons: Vec<(RobotId, Beacon)>,
    newest: Option<CycleState>,
    trail: Vec<[f32; 2]>,
    decided: Option<DecisionNote>,
}

impl Legged {
    /// A feed of `page` for trials that are played with the cases of `base`.
    pub fn new(page: Page, base: CaseBase<'static>) -> Self {
        Self { page, base, beacons: Vec::new(), newest: None, trail: Vec::new(), decided: None }
    }

    fn receive(&mut self, moment: &Moment<'_>) {
        if let Some((robot, report)) = moment.decisions.last() {
            self.decided = Some(reported(*robot, report));
        }
        for (from, beacon) in moment.beacons {
            if let Some(state) = &beacon.cycle
                && state.is_newer_than(self.newest.as_ref())
            {
                self.newest = Some(state.clone());
            }
            match self.beacons.iter_mut().find(|(id, _)| id == from) {
                Some((_, known)) => known.clone_from(beacon),
                None => self.beacons.push((*from, beacon.clone())),
            }
        }
    }

    fn add_events(&mut self, moment: &Moment<'_>, t: f64) {
        for event in moment.events {
            let (CycleEvent::Decided(i) | CycleEvent::Ended(i)) = *event else { continue };
            let Some(cycle) = moment.cycles.cycles().get(i) else { continue };
            let (kind, description) = match (event, &cycle.play) {
                (CycleEvent::Decided(_), Some(play)) => {
                    (MatchEventKind::Case, moment.config.names.of(play.case))
                }
                (CycleEvent::Ended(_), Some(_)) => {
                    let end = cycle.end.map_or_else(String::new, |(_, end)| description::end(end));
                    (MatchEventKind::Cycle, format!("case {end}"))
                }
                _ => continue,
            };
            // Emulated robots tell the page no problems: what is rebuilt from the field explains nothing.
            let own = self.decided.as_ref().filter(|decided| decided.cycle == cycle.id.counter);
            let decided = (kind == MatchEventKind::Case).then(|| {
                own.cloned().unwrap_or_else(|| DecisionNote {
                    by: cycle.coordinator.number(),
                    cycle: cycle.id.counter,
                    id: cycle.play.as_ref().map(|play| play.case.0),
                    problem: Some(problem(moment)),
                    ..DecisionNote::default()
                })
            });
            let problem = decided.as_ref().and_then(|decided| decided.problem.clone());
            let event = MatchEvent::new(t, kind, Some(PageTeam::Blue), description);
            self.page.push(MatchEvent { problem, decided, ..event });
        }
    }

    fn detail(
        &self,
        id: RobotId,
        at: [f32; 2],
        played: Option<&Played<'_>>,
        moment: &Moment<'_>,
    ) -> Option<RobotDetail> {
        let (_, beacon) = self.beacons.iter().find(|(known, _)| *known == id)?;
        let part = played.and_then(|played| Some((played, played.place_of(id)?)));
        let (state, step) = description::progress(
            beacon.progress,
            part.as_ref().map(|(played, (robot, _))| (&played.case, *robot)),
        );
        let to = part.as_ref().filter(|_| state == "adapt").map(|(_, (_, to))| *to);
        let reactive = match beacon.role {
            Role::Attacker => "attacks",
            Role::Supporter => "backs up",
            Role::None => "",
        };
        Some(RobotDetail {
            role: format!("robot {}", moment.cast.name_of(id)),
            directive: if part.is_some() { "plays a case".into() } else { "plays by itself".into() },
            state,
            step,
            part: part.map_or_else(String::new, |(played, (robot, _))| {
                format!("case robot {} of {}", robot.number(), moment.config.names.of(played.play.case))
            }),
            reactive: reactive.to_owned(),
            intent: Intent { path: to.map_or_else(Vec::new, |to| vec![at, to]), ball_to: None },
            ..RobotDetail::default()
        })
    }

    fn scene(&mut self, moment: &Moment<'_>, t: f64) -> Scene {
        let play = self.newest.as_ref().and_then(CycleState::play);
        let played = play.and_then(|play| Played::of(&self.base, |case| moment.config.names.of(case), play));
        let attackers = moment.cast.attackers.len();
        let robots = moment.world.walkers.iter().enumerate().map(|(i, walker)| {
            let at = [milli(walker.pose.position.x()), milli(walker.pose.position.y())];
            let id = moment.cast.attackers.get(i);
            SceneRobot {
                team: if id.is_some() { PageTeam::Blue } else { PageTeam::Yellow },
                id: id.map_or((i - attackers.min(i)) as u8 + 1, |id| id.number()),
                at,
                heading: milli(walker.pose.heading.radians()),
                velocity: [0.0; 2],
                confidence: 1.0,
                detail: id.and_then(|id| self.detail(*id, at, played.as_ref(), moment)),
                vitals: None,
            }
        });
        let robots = robots.collect();
        let cycle = self.newest.as_ref().map(|state| Cycle {
            team: Some(PageTeam::Blue),
            number: state.id.counter,
            coordinator: state.coordinator.number(),
            state: description::decision(&state.decision),
            case: play.map(|play| moment.config.names.of(play.case)).unwrap_or_default(),
            players: play.map(|play| play.robots.iter().map(|id| id.number()).collect()).unwrap_or_default(),
            decided: self.decided.clone(),
            ..Cycle::default()
        });
        let layers =
            played.map(|played| layers::of_cases(&[(Colour::Blue, played)]).into()).unwrap_or_default();
        let ball = moment.world.ball.position;
        let at = [milli(ball.x()), milli(ball.y())];
        let mut game = Match {
            phase: "trial".into(),
            stage: format!("scenario {}", moment.config.scenario.label()),
            ..Match::default()
        };
        game.teams.blue.name = "attackers".into();
        game.teams.blue.defends = -1;
        game.teams.yellow.name = "opponents".into();
        game.teams.yellow.defends = 1;
        self.trail.push(at);
        if self.trail.len() > TRAIL_TICKS {
            self.trail.remove(0);
        }
        Scene {
            t,
            field: field_of(&League::FourLegged.field()),
            ball: Some(page::SceneBall {
                at,
                confidence: 1.0,
                trail: self.trail.clone(),
                ..page::SceneBall::default()
            }),
            robots,
            game,
            cycles: cycle.into_iter().collect(),
            layers,
            seed: Some(moment.config.seed),
            ..Scene::default()
        }
    }

    /// The trial's page, which stays open.
    pub fn into_page(self) -> Page {
        self.page
    }
}

impl Watcher for Legged {
    fn watch(&mut self, moment: &Moment<'_>) {
        let t = f64::from(moment.tick.time);
        self.receive(moment);
        self.add_events(moment, t);
        let scene = self.scene(moment, t);
        self.page.keep(scene);
    }

    fn end(&mut self, moment: &Moment<'_>, report: &TrialReport) {
        let t = f64::from(moment.tick.time);
        let kind = if report.outcome == hil_sim::TrialOutcome::Goal {
            MatchEventKind::Goal
        } else {
            MatchEventKind::Event
        };
        let description = format!("the trial ends: {}", report.outcome.label());
        self.page.push(MatchEvent::new(t, kind, Some(PageTeam::Blue), description));
        let mut scene = self.scene(moment, t + 0.04);
        scene.layers.push(page::Layer {
            name: "outcome".into(),
            label: "how it ended".into(),
            on: true,
            shapes: vec![Shape::Text {
                at: [0.0, 0.0],
                text: report.outcome.label().to_owned(),
                tone: Tone::Plain,
            }],
        });
        self.page.keep(scene);
    }
}

/// The situation that the attackers retrieve in, as `cases explain` takes it.
fn problem(moment: &Moment<'_>) -> serde_json::Value {
    let mm = |at: geometry::Point<geometry::Field>| {
        [(at.x() * 1000.0).round() as i32, (at.y() * 1000.0).round() as i32]
    };
    let attackers = moment.cast.attackers.len();
    let walkers = &moment.world.walkers;
    let teammates: serde_json::Map<String, serde_json::Value> = moment
        .cast
        .attackers
        .iter()
        .zip(walkers)
        .map(|(id, walker)| (id.number().to_string(), serde_json::json!(mm(walker.pose.position))))
        .collect();
    let opponents: Vec<_> = walkers.iter().skip(attackers).map(|walker| mm(walker.pose.position)).collect();
    serde_json::json!({
        "ball": mm(moment.world.ball.position), "defending": "yellow", "teammates": teammates, "opponents": opponents,
    })
}
