//! Where would a pass lead to a goal, and from where threatens one? The second paper's pictures of the moment, by strategy's own
//! functions: a heat map of P(receive) · P(goal) for the team nearer to the ball, threats and open angles for the other.
//!
//! Worked out five times a second, whoever looks on: a scene costs the same with and without viewers. Field frame, m.

use geometry::{Attack, GoalEnd, Point};
use host::Host;
use host::referee::Game;
use host::strategy::pass::{Kicks, PassConstants, Scene};
use host::strategy::threat::angle::Opening;
use host::strategy::threat::{Memory, Settings, defend};
use host::strategy::view::{Game as ViewGame, RobotSet};
use host::strategy::{Flip, View};
use host::world::World;
use page::{Heat, Layer, Shape, Tone, milli};
use protocol::RobotId;
use rules::{Colour, FieldSpec, Phase};

/// Anew after so long, s.
const EVERY_S: f64 = 0.2;
/// Length and width of a cell of the map, m: three robots' widths.
const CELL: f32 = 0.3;
/// A pass that is worth less than this is not drawn.
const WORTHLESS: f32 = 0.02;

/// The two layers, and what they were made from.
#[derive(Debug, Default)]
pub(super) struct Tactics {
    kicks: Option<Kicks>,
    memory: [Memory; 2],
    made: Option<f64>,
    layers: [Layer; 2],
}

impl Tactics {
    /// The layers of a moment.
    pub(super) fn layers(&mut self, t: f64, eyes: &Host, world: &World, field: &FieldSpec) -> Vec<Layer> {
        if self.made.is_none_or(|made| t - made >= EVERY_S || t < made) {
            self.made = Some(t);
            self.layers = self.make(eyes, world, field);
        }
        self.layers.to_vec()
    }

    fn make(&mut self, eyes: &Host, world: &World, field: &FieldSpec) -> [Layer; 2] {
        let kicks = self.kicks.get_or_insert_with(|| {
            Kicks::new(PassConstants::of(eyes.settings().league), world.models.ground, world.models.chip)
        });
        let (mut passes, mut threats) = (Vec::new(), Vec::new());
        let nearest = world.ball.and_then(|ball| world.nearest(ball.position));
        if let Some((holder, _)) = nearest {
            let (game, attackers) = (eyes.game(), holder.who.colour);
            if let Some(view) = view(world, game, attackers, field) {
                passes = pass_map(&view, kicks, holder.who.id, defends(game, attackers));
            }
            let defenders = attackers.other();
            if let Some(view) = view(world, game, defenders, field) {
                let memory = &mut self.memory[defenders as usize];
                threats = threat_shapes(&view, memory, defends(game, defenders));
            }
        }
        let layer = |name: &str, label: &str, shapes| Layer {
            name: name.into(),
            label: label.into(),
            on: false,
            shapes,
        };
        [
            layer("pass-value", "pass that leads to a goal", passes),
            layer("threats", "threats and open angles", threats),
        ]
    }
}

fn defends(game: &Game, team: Colour) -> Option<GoalEnd> {
    game.own_goal(team)
}

/// The field as that team's strategy sees it, with every robot that is seen.
fn view(world: &World, game: &Game, us: Colour, field: &FieldSpec) -> Option<View> {
    if matches!(game.phase, Phase::Halt | Phase::Timeout(_)) {
        return None;
    }
    let sheet = ViewGame {
        phase: game.phase.seen_by(us),
        next: game.next.map(|phase| phase.seen_by(us)),
        placement: game.placement,
        defending: defends(game, us)?,
        keeper: game.team(us).keeper.unwrap_or(RobotId::ZERO),
        their_keeper: game.team(us.other()).keeper.unwrap_or(RobotId::ZERO),
    };
    Some(View::of(world, us, &sheet, *field, everybody(), RobotSet::default()))
}

fn everybody() -> RobotSet {
    let mut all = RobotSet::default();
    RobotId::all().for_each(|robot| all.insert(robot));
    all
}

/// For each place the value of a pass to the mate that is nearest to it.
fn pass_map(view: &View, kicks: &Kicks, passer: RobotId, defends: Option<GoalEnd>) -> Vec<Shape> {
    let (Some(ball), Some(defends)) = (view.ball, defends) else { return Vec::new() };
    let mates: Vec<_> = view.ours.iter().filter(|mate| mate.id != passer && mate.id != view.keeper).collect();
    let scenes: Vec<_> =
        mates.iter().map(|mate| Scene::of(view, kicks, ball.position, Some(passer), mate)).collect();
    let flip = Flip::defending(defends);
    let (half_x, half_y) = (view.field.length * 0.5, view.field.width * 0.5);
    let (columns, rows) =
        ((view.field.length / CELL).round() as u32, (view.field.width / CELL).round() as u32);
    let mut values = Vec::with_capacity((columns * rows) as usize);
    let mut best = (WORTHLESS, Point::default());
    for row in 0..rows {
        for column in 0..columns {
            let share = |i: u32, n: u32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
            let place = Point::new(share(column, columns) * half_x, share(row, rows) * half_y);
            let at = flip.point(place);
            let far = |i: &usize| mates[*i].position.distance(at);
            let nearest = (0..mates.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
            let value = nearest.map_or(0.0, |i| scenes[i].rate(at).value());
            if value > best.0 {
                best = (value, place);
            }
            values.push(value);
        }
    }
    let (most, place) = best;
    let cell = |value: f32| if value < WORTHLESS { 0 } else { (value / most.max(value) * 255.0) as u8 };
    let heat = Heat {
        low: [milli(-half_x), milli(-half_y)],
        high: [milli(half_x), milli(half_y)],
        columns,
        cells: values.into_iter().map(cell).collect(),
    };
    if most <= WORTHLESS {
        return Vec::new();
    }
    let at = [milli(place.x()), milli(place.y())];
    vec![Shape::Heat(heat), Shape::Text { at, text: format!("{most:.2}"), tone: Tone::Plain }]
}

/// The open angle of the nearest threat, then of everybody who could have the ball next.
fn threat_shapes(view: &View, memory: &mut Memory, defends: Option<GoalEnd>) -> Vec<Shape> {
    let Some(defends) = defends else { return Vec::new() };
    let defence = defend(view, everybody(), memory, &Settings::default());
    let flip = Flip::defending(defends);
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
        shapes.push(Shape::Text { at: [at[0], milli(at[1] + 0.22)], text, tone: Tone::Forbidden });
    }
    shapes
}
