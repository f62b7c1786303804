//! `composer`: composition of the page's scene from hosts and other sources; it stores only what is displayed
//! over time.

use std::collections::VecDeque;
use std::sync::Arc;

use arena::cases::LibraryHandle;
use casebase::CaseBase;
use hil_sim::small_size::World as Truth;
use hil_sim::small_size::referee::InternalReferee;
use host::Host;
use host::health_checks::{Finding, HealthChecks, Since};
use host::referee::Game;
use host::world::{Ball, Robot, World};
use page::{
    DeferredScene, Field, Gauge, Layer, LogLevel, Match, MatchEvent, ProgramLog, Scene, SceneBall,
    SceneRobot, Shape, TeamSheet, milli,
};
use protocol::Instant;
use rules::limits::BALL_RADIUS;
use rules::{AreaForm, Colour, FieldSpec, RobotSpec};

use super::cameras::Cameras;
use super::cycles::TeamCycles;
use super::gauges::{self, Rate};
use super::layers;
use super::match_events::EventFeed;
use super::minds::{self, Clocks, Faults};
use super::names::Names;
use super::overlay_builder::OverlayBuilder;
use super::overlay_input::OverlayInput;
use super::possession::Possession;
use super::raw::Images;
use super::windows::Links;
use super::{spaced, team};

/// Length of the ball's trail, s.
const TRAIL_S: f64 = 1.5;
/// Number of points of the ball's prediction, one each tenth of a second; it ends at the stop position.
const PREDICTED_POINTS: usize = 15;

/// Inputs of a scene.
pub struct Moment<'a> {
    /// Seconds since the start.
    pub t: f64,
    /// On the hosts' clock.
    pub now: Instant,
    /// The host whose world is displayed.
    pub feed: &'a Host,
    /// The hosts whose robots' states are displayed.
    pub hosts: &'a [&'a Host],
    /// The true state, in a simulation.
    pub truth: Option<&'a Truth>,
    /// The simulation's own referee.
    pub referee: Option<&'a InternalReferee>,
    /// Measurements of the loop itself.
    pub gauges: Vec<Gauge>,
}

/// Fills scenes.
#[derive(Default)]
pub struct Composer {
    log: Arc<ProgramLog>,
    base: Option<CaseBase<'static>>,
    names: Names,
    images: Images,
    cameras: Cameras,
    links: Links,
    rate: Rate,
    trail: VecDeque<(f64, [f32; 2])>,
    events: EventFeed,
    cycles: [TeamCycles; 2],
    clocks: Clocks,
    faults: Faults,
    health_checks: [HealthChecks; 2],
    since: [Since; 2],
    possession: Possession,
    overlay_builder: OverlayBuilder,
    match_events: Vec<MatchEvent>,
    /// Subjects of the alarms of the last scene.
    alarmed: Vec<String>,
}

impl Composer {
    /// A composer for matches with these cases; faults of robots and alarms go to `log` too.
    pub fn new(library_handle: Option<&LibraryHandle>, log: Arc<ProgramLog>) -> Self {
        Self {
            log,
            base: library_handle.map(LibraryHandle::lasting_base),
            names: Names::new(library_handle),
            ..Self::default()
        }
    }

    /// A datagram of the vision.
    pub fn vision(&mut self, bytes: &[u8]) {
        self.images.receive(bytes);
        self.cameras.receive(bytes);
    }

    /// A datagram of the referee; `own` where the simulation's referee is part of the moment too.
    pub fn referee(&mut self, bytes: &[u8], t: f64, own: bool) {
        self.events.packet(bytes, t, own, &mut self.match_events);
    }

    /// Events since the last call.
    pub fn take_match_events(&mut self) -> Vec<MatchEvent> {
        std::mem::take(&mut self.match_events)
    }

    /// The scene of a moment: what is known at once, and what the page's thread computes from a snapshot.
    pub fn compose(&mut self, moment: Moment<'_>) -> DeferredScene {
        let Moment { t, now, feed, .. } = moment;
        let (world, game, field) = (feed.world(), feed.game(), feed.field());
        for host in moment.hosts {
            self.cycles[host.settings().us as usize].receive(host, t, &self.names, &mut self.match_events);
            for fault in self.faults.look(host, now) {
                self.log.add(LogLevel::Warning, "robots", Some(t), &fault);
                let team = Some(team(host.settings().us));
                self.match_events.push(MatchEvent { team, ..MatchEvent::fault(t, fault) });
            }
        }
        let (mut alarms, mut alarmed, mut findings) = (Vec::new(), Vec::new(), Vec::new());
        for host in moment.hosts {
            let us = host.settings().us;
            let faults = self.health_checks[us as usize].look(now, host);
            for found in self.since[us as usize].date(now, faults) {
                // The text changes with its figures; the heading stays.
                let (source, heading) = (format!("{} host", us.label()), found.fault.heading());
                let matter = format!("{source}: {heading}");
                if !self.alarmed.contains(&matter) {
                    self.log.add(LogLevel::Alarm, &source, Some(t), &format!("{heading}: {}", found.fault));
                }
                alarmed.push(matter);
                alarms.push(format!("{source}: {heading}: {}", found.fault));
                findings.push(Finding::to_json(&found));
            }
        }
        self.alarmed = alarmed;
        if let Some(referee) = moment.referee {
            self.events.referee(referee, t, &mut self.match_events);
        }
        self.events.kick(world.ball.and_then(|ball| ball.kicked), t, &mut self.match_events);
        let defends = |team: Colour| game.own_goal(team).map(|goal| goal.sign() as i8);
        self.possession.look(t, world, game.phase, defends(Colour::Blue));

        let Self { base, names, cycles, clocks, .. } = self;
        let played = |team: Colour| cycles[team as usize].played(base.as_ref(), names);
        let plays: Vec<_> = [Colour::Yellow, Colour::Blue]
            .into_iter()
            .filter_map(|team| Some((team, played(team)?)))
            .collect();
        let links = moment.hosts.iter().map(|host| self.links.look(t, host)).collect::<Vec<_>>();
        let mut aims = Vec::new();
        let robots = world
            .robots()
            .map(|robot| {
                let colour = robot.who.colour;
                let host = moment.hosts.iter().find(|host| host.settings().us == colour);
                let played = plays.iter().find(|(team, _)| *team == colour).map(|(_, played)| played);
                let detail =
                    host.and_then(|host| minds::detail(host, robot, played, names, clocks, (now, t)));
                let (detail, aim) = detail.unzip();
                aims.extend(aim.flatten());
                SceneRobot {
                    detail,
                    vitals: host.and_then(|host| {
                        let link = moment.hosts.iter().position(|other| other.settings().us == colour);
                        let link = link.and_then(|i| links[i].get(&robot.who.id.number())).copied();
                        minds::vitals(host, robot, now, link.unwrap_or_default())
                    }),
                    ..scene_robot(robot)
                }
            })
            .collect();
        let mut layers = Vec::from(layers::of_cases(&plays));
        let ball = world.ball.map(|ball| ball.position);
        layers.push(layers::keep_outs(&field, game.phase, ball, game.placement, game.own_goal(Colour::Blue)));
        layers.extend(moment.truth.map(truth));
        layers.extend(layers::of_strategies(moment.hosts));
        let rows = |host: &&Host| {
            let us = host.settings().us;
            cycles[us as usize].rows(us, t, base.as_ref(), names)
        };
        let cycles = moment.hosts.iter().filter_map(rows).collect();
        let mut gauges = gauges::of_hosts(
            if moment.hosts.is_empty() { std::slice::from_ref(&feed) } else { moment.hosts },
            now,
            self.rate.of(t, self.images.count),
        );
        gauges.extend(moment.gauges);
        let glance = moment.hosts.iter().flat_map(|host| host::glance::robots(host, now));
        let scene = Scene {
            t,
            ball: world.ball.map(|ball| self.ball(t, &ball, world)),
            robots,
            raw: self.images.seen(),
            game: sheet(game, moment.referee, &self.possession),
            cycles,
            layers,
            cameras: self.cameras.look(t),
            gauges,
            alarms,
            findings,
            glance: glance.filter_map(|robot| serde_json::to_value(robot).ok()).collect(),
            ..scene_of(t, &World::default(), &field)
        };
        let input = OverlayInput {
            t,
            world: world.clone(),
            game: game.clone(),
            field,
            league: feed.settings().league,
            us: match moment.hosts {
                [only] => Some(only.settings().us),
                _ => None,
            },
            aims,
        };
        self.overlay_builder.deferred_scene(scene, input)
    }

    fn ball(&mut self, t: f64, ball: &Ball, world: &World) -> SceneBall {
        let seen = scene_ball(ball);
        let at = seen.at;
        if self.trail.back().is_some_and(|(last, _)| *last > t) {
            self.trail.clear();
        }
        if self.trail.back().is_none_or(|(last, _)| *last < t) {
            self.trail.push_back((t, at));
        }
        while self.trail.front().is_some_and(|(first, _)| t - first > TRAIL_S) {
            self.trail.pop_front();
        }
        let rests = ball.rests_in(&world.models);
        let moves = ball.velocity.norm() > 0.05 || ball.height > 0.0;
        let steps = if moves { PREDICTED_POINTS.min((rests * 10.0).ceil().max(0.0) as usize) } else { 0 };
        let ahead = (0..=steps).map(|step| {
            let later = ball.after((step as f32 * 0.1).min(rests), &world.models).position;
            [milli(later.x()), milli(later.y())]
        });
        SceneBall { trail: self.trail.iter().map(|(_, at)| *at).collect(), ahead: ahead.collect(), ..seen }
    }
}

/// The scene of anybody's positions: field, ball and robots, with nothing that a host of ours would know.
/// `t` in s since the start; layers, events and the score are the caller's to add.
pub fn scene_of(t: f64, world: &World, field: &FieldSpec) -> Scene {
    Scene {
        t,
        field: field_of(field),
        ball: world.ball.as_ref().map(scene_ball),
        robots: world.robots().map(scene_robot).collect(),
        ..Scene::default()
    }
}

fn scene_ball(ball: &Ball) -> SceneBall {
    SceneBall {
        at: [milli(ball.position.x()), milli(ball.position.y())],
        height: milli(ball.height),
        velocity: [milli(ball.velocity.x()), milli(ball.velocity.y())],
        confidence: milli(ball.confidence),
        ..SceneBall::default()
    }
}

fn scene_robot(robot: &Robot) -> SceneRobot {
    let at = robot.pose.position;
    SceneRobot {
        team: team(robot.who.colour),
        id: robot.who.id.number(),
        at: [milli(at.x()), milli(at.y())],
        heading: milli(robot.pose.heading.radians()),
        velocity: [milli(robot.velocity.x()), milli(robot.velocity.y())],
        confidence: milli(robot.confidence),
        detail: None,
        vitals: None,
    }
}

/// A field in the page's format.
pub fn field_of(field: &FieldSpec) -> Field {
    Field {
        length: milli(field.length),
        width: milli(field.width),
        margin: milli(field.margin.max(field.goal_line_margin)),
        goal_width: milli(field.goal_width),
        goal_depth: milli(field.goal_depth),
        area_depth: milli(field.penalty_depth),
        area_width: milli(match field.penalty_form {
            AreaForm::Box => field.penalty_width,
            AreaForm::QuarterCircles => field.penalty_width - 2.0 * field.penalty_depth,
        }),
        area_radius: (field.penalty_form == AreaForm::QuarterCircles).then(|| milli(field.penalty_depth)),
        centre_radius: milli(field.center_radius),
        robot_radius: milli(RobotSpec::OURS.hull.radius),
        ball_radius: milli(BALL_RADIUS),
    }
}

fn sheet(game: &Game, referee: Option<&InternalReferee>, seen: &Possession) -> Match {
    let mut out = Match {
        phase: game.phase.to_string(),
        next: game.next.map(|phase| phase.to_string()).unwrap_or_default(),
        stage: spaced(&format!("{:?}", game.stage)),
        stage_left: game.stage_time_left.map(milli),
        action_left: game.action_time_left.map(milli),
        placement: game.placement.map(|at| [milli(at.x()), milli(at.y())]),
        in_play: referee.map(|referee| milli(referee.metrics().ball_in_play())),
        ..Match::default()
    };
    let all: f32 = referee.map_or(0.0, |referee| {
        [Colour::Blue, Colour::Yellow].map(|team| referee.metrics().team(team).possession_s).iter().sum()
    });
    for colour in [Colour::Blue, Colour::Yellow] {
        let account = game.team(colour);
        let counted = referee.map(InternalReferee::metrics);
        let own = counted.map(|metrics| metrics.team(colour));
        *out.teams.of_mut(team(colour)) = TeamSheet {
            name: if account.name.is_empty() { colour.label().to_owned() } else { account.name.clone() },
            score: account.score,
            defends: game.own_goal(colour).map_or(0, |goal| goal.sign() as i8),
            keeper: account.keeper.map(protocol::RobotId::number),
            allowed: account.robots_allowed,
            yellow_cards: account.yellow_card_times.iter().map(|left| milli(*left)).collect(),
            red_cards: account.red_cards,
            fouls: account.fouls,
            timeouts: account.timeouts,
            possession: match own {
                Some(own) => (all > 0.0).then(|| milli(own.possession_s / all)),
                None => seen.share(colour).map(milli),
            },
            offence_ratio: match counted {
                Some(metrics) => metrics.offence_ratio(colour).map(milli),
                None => seen.offence_ratio(colour).map(milli),
            },
            attack_ratio: counted.and_then(|metrics| metrics.attack_ratio(colour)).map(milli),
            counts: own.map_or_else(Vec::new, |own| {
                [
                    ("shots", own.shots),
                    ("chances", own.chances),
                    ("passes", own.passes),
                    ("balls lost", own.losses),
                ]
                .map(|(name, n)| (name.to_owned(), n))
                .into()
            }),
        };
    }
    out
}

/// The true state of everything, to compare with what is believed.
fn truth(world: &Truth) -> Layer {
    let mut shapes: Vec<Shape> = world
        .robots()
        .iter()
        .filter(|robot| robot.present)
        .map(|robot| Shape::Ellipse {
            at: [milli(robot.pose.position.x()), milli(robot.pose.position.y())],
            radii: [milli(robot.body.radius); 2],
            tone: layers::tone(robot.who.colour),
            fill: false,
            note: format!("{} {}, as it truly stands", robot.who.colour.label(), robot.who.id.number()),
        })
        .collect();
    let ball = world.ball.position;
    shapes.push(Shape::Ellipse {
        at: [milli(ball.x()), milli(ball.y())],
        radii: [milli(BALL_RADIUS * 2.0); 2],
        tone: page::Tone::Ball,
        fill: false,
        note: "the ball, as it truly lies".to_owned(),
    });
    Layer { name: "truth".to_owned(), label: "the simulation's truth".to_owned(), on: false, shapes }
}
