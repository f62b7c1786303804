//! Tests: a scene agrees with the truth. A short match, compared with the simulated world and with retrieval
//! itself.

use std::collections::BTreeSet;
use std::sync::Arc;

use arena::cases::{Chosen, LibraryHandle};
use arena::game::{Game, GameConfig, Watcher, Watchers};
use casebase::RetrievalSettings;
use hil_sim::NativeBackend;
use host::strategy::Tactics;
use page::{MatchEvent, MatchEventKind, PageTeam, Scene, Shape};
use rules::{Colour, League};

use super::{Composer, Moment, explained};

struct Feed(Composer);

impl Watcher for Feed {
    fn vision(&mut self, _now: protocol::Instant, bytes: &[u8]) {
        self.0.vision(bytes);
    }
    fn referee(&mut self, now: protocol::Instant, bytes: &[u8]) {
        self.0.referee(bytes, now.0 as f64 * 1e-6, true);
    }
}

#[derive(Default)]
struct Played {
    scene: Scene,
    match_events: Vec<MatchEvent>,
    /// The most bytes that a scene took.
    most: usize,
    /// Robots that cameras saw in its last second: one camera frame in a hundred lacks one.
    seen: BTreeSet<(PageTeam, u8)>,
    /// Scenes with a map of passes, and all scenes; scenes with a keeper labelled as one, and
    /// scenes with labels.
    maps: (u32, u32),
    keepers: (u32, u32),
    /// Scenes in which a robot's reason has the list that its order is the best of.
    rated: u32,
}

impl Played {
    /// Compares the labels of keepers with the roles that their own host ordered.
    fn judge(&mut self, scene: &Scene) {
        let shapes = |name: &str| &scene.layers.iter().find(|layer| layer.name == name).unwrap().shapes;
        self.maps.0 += u32::from(!shapes("pass-receive").is_empty());
        self.maps.1 += 1;
        let rated = |robot: &page::SceneRobot| {
            robot.detail.as_ref().is_some_and(|detail| detail.why.contains("; rated: "))
        };
        self.rated += u32::from(scene.robots.iter().any(rated));
        let believed = shapes("believed");
        let labelled = |at: [f32; 2]| {
            let label = believed.iter().find_map(|shape| match shape {
                Shape::Text { at: place, text, .. } if *place == at => Some(text.as_str()),
                _ => None,
            });
            let ring = believed
                .iter()
                .any(|shape| matches!(shape, Shape::Ellipse { at: place, .. } if *place == at));
            ring.then_some(label.unwrap_or_default())
        };
        let keepers = scene
            .robots
            .iter()
            .filter(|robot| robot.detail.as_ref().is_some_and(|detail| detail.role == "keeper"));
        for label in keepers.filter_map(|keeper| labelled(keeper.at)) {
            self.keepers.0 += u32::from(label.starts_with("goalkeeper"));
            self.keepers.1 += 1;
        }
    }
}

/// A match of this duration, s.
fn played(seconds: u32, tactics: Tactics) -> Played {
    let library_handle = Some(LibraryHandle::named("division-b").unwrap());
    let base = library_handle.as_ref().unwrap().lasting_base();
    let mut backend = NativeBackend::new(base);
    let mut config = GameConfig::new(League::DivisionB, 1, 600.0);
    config.teams.iter_mut().for_each(|team| team.tactics = tactics);
    let mut game = Game::new(&config, &mut backend).unwrap();
    let mut feed = Feed(Composer::new(library_handle.as_ref(), Arc::default()));
    let mut out = Played::default();
    let ticks = seconds * 100;
    for tick in 0..ticks {
        game.step(&mut Watchers(vec![&mut feed])).unwrap();
        if tick % 4 == 3 {
            let hosts = [game.host(Colour::Blue), game.host(Colour::Yellow)];
            let deferred_scene = feed.0.compose(Moment {
                t: game.time(),
                now: game.now(),
                feed: hosts[0],
                hosts: &hosts,
                truth: Some(game.world()),
                referee: Some(game.referee()),
                gauges: Vec::new(),
            });
            let scene = deferred_scene.finished();
            out.most = out.most.max(serde_json::to_string(&scene).unwrap().len());
            out.match_events.extend(feed.0.take_match_events());
            if tick + 100 > ticks {
                out.seen.extend(scene.raw.robots.iter().map(|robot| (robot.0, robot.1)));
            }
            // By then the learned field parameters have settled.
            if tick >= 500 {
                out.judge(&scene);
            }
            out.scene = scene;
        }
    }
    out
}

#[test]
fn a_match_fills_scenes_that_hold_against_the_truth() {
    let Played { scene, match_events, most, seen, maps, keepers, rated } = played(45, Tactics::default());
    assert!(rated > 100, "{rated}");
    assert_eq!(scene.robots.len(), 12);
    let truth = scene.layers.iter().find(|layer| layer.name == "truth").unwrap();
    for robot in &scene.robots {
        assert!(robot.detail.is_some() && robot.vitals.is_some(), "{robot:?}");
        let near = truth.shapes.iter().any(|shape| match shape {
            Shape::Ellipse { at, .. } => (at[0] - robot.at[0]).abs() + (at[1] - robot.at[1]).abs() < 0.15,
            _ => false,
        });
        assert!(near, "{robot:?}");
    }
    assert_eq!(seen.len(), 12, "{seen:?}");
    let sheet = &scene.game;
    assert_eq!(sheet.teams.blue.defends, -sheet.teams.yellow.defends);
    assert!(
        (sheet.teams.blue.possession.unwrap() + sheet.teams.yellow.possession.unwrap() - 1.0).abs() < 0.01
    );
    assert!(scene.ball.unwrap().trail.len() > 20);
    let names: BTreeSet<_> = scene.layers.iter().map(|layer| &layer.name).collect();
    assert_eq!(names.len(), scene.layers.len(), "each layer has a name of its own");
    // The map does not depend on a robot's search; and a keeper is labelled as one by both hosts.
    assert_eq!(maps.0, maps.1);
    assert!(keepers.1 > 500 && keepers.0 * 10 > keepers.1 * 8, "{keepers:?}");
    // 25 of them a second have to go through any network and a browser's parser.
    assert!(most < 40_000, "{most} bytes");
    assert!(match_events.iter().any(|match_event| match_event.kind == MatchEventKind::Command));
    assert!(match_events.windows(2).all(|pair| pair[0].t <= pair[1].t + 0.05), "in order");
}

#[test]
fn a_retrieval_that_is_reported_can_be_explained_and_mostly_comes_to_the_same_case() {
    // Who plays by the rated list decides on cases more rarely.
    let match_events = played(400, Tactics::ROUND_1).match_events;
    let library_handle = LibraryHandle::named("division-b").unwrap();
    let chosen = Chosen { settings: RetrievalSettings::default(), changed: Vec::new() };
    let (mut reported, mut same) = (0, 0);
    for match_event in match_events.iter().filter(|match_event| match_event.kind == MatchEventKind::Case) {
        let problem = match_event.problem.as_ref().unwrap().to_string();
        let answer: serde_json::Value =
            serde_json::from_str(&explained(&library_handle, &chosen, &problem).unwrap()).unwrap();
        let winner = answer["cases"].as_array().unwrap().iter().find(|row| row["id"] == answer["winner"]);
        let name = winner.and_then(|row| row["case"].as_str()).unwrap_or("none");
        reported += 1;
        same += u32::from(match_event.description.contains(name));
    }
    // Who was taken away from a play is told, and for what.
    let ends = match_events.iter().filter(|event| event.description.contains(": case reassigned"));
    let ends: Vec<_> = ends.map(|event| event.description.as_str()).collect();
    assert!(!ends.is_empty() && ends.iter().all(|end| end.contains(": robot ")), "{ends:?}");
    let told = ends.iter().filter(|end| end.contains(", now ") && !end.contains("play cases"));
    assert!(told.count() * 2 > ends.len(), "{ends:?}");
    // The coordinator retrieved by its own belief of a moment before: where two cases are similar it may
    // differ.
    assert!(reported >= 5 && same * 2 > reported, "{same} of {reported}");
}
