//! `tactics`: overlays of passes and threats. The second paper's figures for the current moment, by
//! strategy's own functions: maps of P(receive) and of P(receive) · P(goal) for the team in possession,
//! threats and open angles for the other, and what the one believes of the other ([`super::beliefs`]).
//!
//! Computed from a snapshot, on the page's thread (`overlay_builder`); maps five times a second.
//! Field frame, m.

use geometry::{Attack, Point};
use host::strategy::pass::{Kicks, PassConstants, PassScene};
use host::strategy::stakes::Stakes;
use host::strategy::threat::angle::Opening;
use host::strategy::threat::{Memory, ThreatSettings, defend};
use host::strategy::view::{RobotSet, ViewGame};
use host::strategy::{Flip, View};
use page::{Heat, Layer, Shape, Tone, milli};
use protocol::RobotId;
use rules::{Colour, Phase};

use super::beliefs::Beliefs;
use super::overlay_input::OverlayInput;

/// Period of the maps, s.
const EVERY_S: f64 = 0.2;
/// Another team has the ball once its robot was the nearest for this time, s: a robot that only passes by
/// changes nothing.
const TAKEN_S: f64 = 0.4;
/// Length and width of a cell of the maps, m: three robots' widths.
const CELL_M: f32 = 0.3;
/// A map whose best place is worth less than this is empty.
const WORTH_MIN: f32 = 0.001;
/// What is worth less than this share of the best place is not drawn.
const DRAWN_SHARE_MIN: f32 = 0.04;

/// State from one moment to the next.
#[derive(Debug, Default)]
pub(super) struct Tactics {
    kicks: Option<Kicks>,
    memory: [Memory; 2],
    beliefs: Beliefs,
    /// The moment before, s.
    last: Option<f64>,
    /// The team in possession, and since when another team's robot is nearer to the ball.
    attackers: Option<Colour>,
    nearer_since: Option<f64>,
    /// When the maps were computed, s.
    made: Option<f64>,
    maps: [Vec<Shape>; 2],
}

impl Tactics {
    /// The layers of a moment: maps, which are drawn under everything else, and the layers above.
    pub(super) fn layers(&mut self, input: &OverlayInput) -> [[Layer; 2]; 2] {
        let OverlayInput { t, world, game, us, .. } = input;
        // Another match, or a recording from its beginning.
        if self.last.replace(*t).is_some_and(|last| *t < last) {
            *self = Self { last: Some(*t), ..Self::default() };
        }
        self.see_who_attacks(input);
        let view = |us: Colour| view(input, us).zip(game.own_goal(us).map(Flip::defending));
        let views = [Colour::Yellow, Colour::Blue].map(|team| (team, view(team)));
        let of = |us: Colour| views.iter().find(|(team, _)| *team == us).and_then(|(_, view)| view.as_ref());
        if self.made.is_none_or(|made| t - made >= EVERY_S) {
            self.made = Some(*t);
            let kicks = self.kicks.get_or_insert_with(|| {
                Kicks::new(PassConstants::of(input.league), world.models.ground, world.models.chip)
            });
            let attack = self.attackers.and_then(of);
            self.maps = attack.map_or_else(Default::default, |(view, flip)| maps(view, *flip, kicks));
        }
        // While the game is halted, positions carry no information.
        let plays = !matches!(game.phase, Phase::Halt | Phase::Timeout(_));
        let mut threats = Vec::new();
        let defenders = self.attackers.map(Colour::other);
        if let Some((team, (view, flip))) =
            defenders.filter(|_| plays).and_then(|team| Some((team, of(team)?)))
        {
            threats = threat_shapes(view, *flip, &mut self.memory[team as usize]);
        }
        for (team, view) in views.iter().filter(|_| plays) {
            if let Some((view, _)) = view {
                self.beliefs.watch(*team, view);
            }
        }
        // Beside a foreign team our host is the observer; between two teams of ours the attacking one
        // observes the defending one.
        let watcher = us.or(self.attackers).filter(|_| plays);
        let seen = watcher.and_then(of).map(|(view, flip)| (view, *flip));
        let [receive, value] = self.maps.clone();
        let layer = |name: &str, label: &str, shapes| Layer {
            name: name.into(),
            label: label.into(),
            on: false,
            shapes,
        };
        [
            [
                layer("pass-receive", "where a pass arrives", receive),
                layer("pass-value", "pass that leads to a goal", value),
            ],
            [
                layer("threats", "threats and open angles", threats),
                self.beliefs.layer(watcher.unwrap_or(Colour::Blue), seen),
            ],
        ]
    }

    fn see_who_attacks(&mut self, input: &OverlayInput) {
        let ball = input.world.ball.map(|ball| ball.position);
        let Some((nearest, _)) = ball.and_then(|ball| input.world.nearest(ball)) else { return };
        let team = nearest.who.colour;
        if self.attackers == Some(team) {
            self.nearer_since = None;
            return;
        }
        let since = *self.nearer_since.get_or_insert(input.t);
        if self.attackers.is_none() || input.t - since >= TAKEN_S {
            (self.attackers, self.nearer_since) = (Some(team), None);
        }
    }
}

/// The field as that team's strategy sees it, with every visible robot; `None` until it is known which team
/// defends which goal.
fn view(input: &OverlayInput, us: Colour) -> Option<View> {
    let game = &input.game;
    let sheet = ViewGame {
        phase: game.phase.seen_by(us),
        next: game.next.map(|phase| phase.seen_by(us)),
        placement: game.placement,
        defending: game.own_goal(us)?,
        keeper: game.team(us).keeper.unwrap_or(RobotId::ZERO),
        their_keeper: game.team(us.other()).keeper.unwrap_or(RobotId::ZERO),
        stakes: Stakes::EVEN,
    };
    Some(View::of(&input.world, us, &sheet, input.field, all_robots()))
}

fn all_robots() -> RobotSet {
    let mut all = RobotSet::default();
    RobotId::all().for_each(|robot| all.insert(robot));
    all
}

/// A place of the maps.
struct Rated {
    place: Point<geometry::Field>,
    receive: f32,
    value: f32,
}

/// For each place the probability that a pass by the robot nearest to the ball arrives at the teammate
/// nearest to the place, and the value of that pass.
fn maps(view: &View, flip: Flip, kicks: &Kicks) -> [Vec<Shape>; 2] {
    let Some(ball) = view.ball else { return Default::default() };
    let off = |teammate: &&host::strategy::view::ViewRobot| teammate.position.distance(ball.position);
    let passer = view.ours.iter().min_by(|a, b| off(a).total_cmp(&off(b))).map(|robot| robot.id);
    let teammates: Vec<_> = view
        .ours
        .iter()
        .filter(|teammate| Some(teammate.id) != passer && teammate.id != view.keeper)
        .collect();
    let scenes: Vec<_> = teammates
        .iter()
        .map(|teammate| PassScene::of(view, kicks, ball.position, passer, teammate))
        .collect();
    let (half_x, half_y) = (view.field.length * 0.5, view.field.width * 0.5);
    let (columns, rows) =
        ((view.field.length / CELL_M).round() as u32, (view.field.width / CELL_M).round() as u32);
    let mut rated = Vec::with_capacity((columns * rows) as usize);
    for row in 0..rows {
        for column in 0..columns {
            let share = |i: u32, n: u32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
            let place = Point::new(share(column, columns) * half_x, share(row, rows) * half_y);
            let at = flip.point(place);
            let far = |i: &usize| teammates[*i].position.distance(at);
            let nearest = (0..teammates.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            let rating = nearest.map(|i| scenes[i].rate(at));
            let [receive, value] = rating.map_or([0.0; 2], |rating| [rating.receive(), rating.value()]);
            rated.push(Rated { place, receive, value });
        }
    }
    let grid = Grid { half_x, half_y, columns };
    [
        grid.map(&rated, "a pass to here arrives", |rated| rated.receive),
        grid.map(&rated, "a pass to here and a shot from here end in a goal", |rated| rated.value),
    ]
}

/// Half a field, m, and the number of cells along it.
struct Grid {
    half_x: f32,
    half_y: f32,
    columns: u32,
}

impl Grid {
    /// The map of one value of the places, with the best of them labelled; nothing where none is worth it.
    fn map(&self, rated: &[Rated], note: &str, of: fn(&Rated) -> f32) -> Vec<Shape> {
        let Some(best) = rated.iter().max_by(|a, b| of(a).total_cmp(&of(b))) else { return Vec::new() };
        let most = of(best);
        if most <= WORTH_MIN {
            return Vec::new();
        }
        let cell = |value: f32| if value < most * DRAWN_SHARE_MIN { 0 } else { (value / most * 255.0) as u8 };
        let heat = Heat {
            low: [milli(-self.half_x), milli(-self.half_y)],
            high: [milli(self.half_x), milli(self.half_y)],
            columns: self.columns,
            cells: rated.iter().map(|place| cell(of(place))).collect(),
            most,
            note: note.to_owned(),
        };
        let text =
            if most < 0.1 { format!("{:.1} %", most * 100.0) } else { format!("{:.0} %", most * 100.0) };
        let at = [milli(best.place.x()), milli(best.place.y())];
        vec![Shape::Heat(heat), Shape::Text { at, text, tone: Tone::Plain }]
    }
}

/// The open angle of the nearest threat, then of every robot that could receive the ball next.
fn threat_shapes(view: &View, flip: Flip, memory: &mut Memory) -> Vec<Shape> {
    let defence = defend(view, all_robots(), memory, &ThreatSettings::default());
    let on_field = |at: Point<Attack>| {
        let at = flip.to_field(at);
        [milli(at.x()), milli(at.y())]
    };
    let goal = view.our_goal();
    let posts = [-0.5, 0.5].map(|side| Point::new(goal.x(), goal.y() + side * view.field.goal_width));
    let wedge = |from: Point<Attack>, fill, note| Shape::Polygon {
        points: vec![on_field(from), on_field(posts[0]), on_field(posts[1])],
        tone: Tone::Forbidden,
        fill,
        note,
    };
    let first = defence.threat.at;
    let open = Opening::of(first, goal, view.field.goal_width).half * 2.0;
    let mut shapes =
        vec![wedge(first, true, format!("the nearest threat: sees {:.0}° of the goal", open.to_degrees()))];
    for danger in &defence.dangers {
        let note = format!(
            "robot {} could shoot in {:.1} s through {:.0}°",
            danger.opponent.number(),
            danger.time_to_shoot,
            danger.open.to_degrees()
        );
        let at = on_field(danger.at);
        shapes.push(wedge(danger.at, false, note));
        let text = format!("{:.0}°, {:.1} s", danger.open.to_degrees(), danger.time_to_shoot);
        shapes.push(Shape::Text { at, text, tone: Tone::Forbidden });
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Angle, GoalEnd, Pose, Vector};
    use host::referee::Game;
    use host::world::{Ball, Robot, World};
    use protocol::{Instant, Who};
    use rules::League;

    /// Blue defends −x and has the ball; two of three of each team are field players.
    fn input(t: f64, ball: (f32, f32), phase: Phase<Colour>) -> OverlayInput {
        let mut world = World::default();
        world.ball = Some(Ball::at_rest(Point::new(ball.0, ball.1), Instant(0)));
        let teams = [
            (Colour::Blue, [(-4.4, 0.0), (0.1, 0.0), (2.0, 1.5)]),
            (Colour::Yellow, [(4.4, 0.0), (3.0, -0.5), (1.0, -1.5)]),
        ];
        for (colour, places) in teams {
            for ((x, y), id) in places.into_iter().zip(RobotId::all()) {
                world.put(Robot {
                    who: Who { colour, id },
                    pose: Pose { position: Point::new(x, y), heading: Angle::ZERO },
                    velocity: Vector::default(),
                    angular: 0.0,
                    confidence: 1.0,
                    seen: Instant(0),
                });
            }
        }
        let mut game = Game::default();
        (game.phase, game.blue_goal) = (phase, Some(GoalEnd::Negative));
        let league = League::DivisionB;
        OverlayInput { t, world, game, field: league.field(), league, us: None, aims: Vec::new() }
    }

    fn shapes(layers: &[[Layer; 2]; 2], name: &str) -> Vec<Shape> {
        layers.iter().flatten().find(|layer| layer.name == name).map(|layer| layer.shapes.clone()).unwrap()
    }

    #[test]
    fn a_cell_of_the_map_holds_what_strategy_rates_its_middle_with() {
        let input = input(0.0, (0.2, 0.0), Phase::Run);
        let layers = Tactics::default().layers(&input);
        let Shape::Heat(heat) = &shapes(&layers, "pass-receive")[0] else { panic!("no map") };
        assert_eq!((heat.columns, heat.cells.len()), (30, 600));
        let view = view(&input, Colour::Blue).unwrap();
        let kicks = Kicks::new(
            PassConstants::of(League::DivisionB),
            input.world.models.ground,
            input.world.models.chip,
        );
        let scene = PassScene::of(&view, &kicks, Point::new(0.2, 0.0), Some(view.ours[1].id), &view.ours[2]);
        for (column, row) in [(20, 14), (22, 12), (5, 5), (25, 10)] {
            let middle = Point::new(-4.35 + 0.3 * column as f32, -2.85 + 0.3 * row as f32);
            let cell = f32::from(heat.cells[row * 30 + column]) / 255.0 * heat.most;
            let rated = scene.rate(middle).receive();
            assert!(
                (cell - rated).abs() < 0.005 || (cell == 0.0 && rated < DRAWN_SHARE_MIN * heat.most),
                "{column} {row}: {cell}, {rated}"
            );
        }
    }

    #[test]
    fn maps_are_there_in_a_halt_too_but_no_one_is_judged_by_where_he_stands() {
        let layers = Tactics::default().layers(&input(0.0, (0.2, 0.0), Phase::Halt));
        assert!(!shapes(&layers, "pass-receive").is_empty());
        assert!(shapes(&layers, "threats").is_empty() && shapes(&layers, "believed").is_empty());
    }

    #[test]
    fn who_is_near_the_ball_for_a_moment_does_not_attack_yet() {
        let mut tactics = Tactics::default();
        tactics.layers(&input(0.0, (0.2, 0.0), Phase::Run));
        // Yellow 2 stands there.
        for (t, team) in [(0.1, Colour::Blue), (0.4, Colour::Blue), (0.6, Colour::Yellow)] {
            tactics.layers(&input(t, (1.0, -1.4), Phase::Run));
            assert_eq!(tactics.attackers, Some(team), "{t}");
        }
    }
}
