//! `layers`: overlays of cases and rules. Scopes, the ball's path, adapted positions, keep-out zones, the
//! truth; as plain shapes in m, field frame.

use casebase::{Case, CaseBase, CaseRobot};
use geometry::{Attack, GoalEnd, Point};
use host::Host;
use host::external::StrategyShape;
use page::{Layer, Shape, Tone, milli};
use protocol::RobotId;
use protocol::team::Play;
use rules::keep_out::{KeepOutReason, Situation, keep_out};
use rules::{Colour, FieldSpec, Phase, RuleRole};

use super::description::spaced;

/// A keep-out zone larger than this share of the field is drawn by its border alone.
const FILLED_AREA_MAX: f32 = 0.35;

pub(super) struct Played<'a> {
    pub(super) case: Case<'a>,
    pub(super) name: String,
    pub(super) play: &'a Play,
}

impl<'a> Played<'a> {
    pub(super) fn of(
        base: &CaseBase<'a>,
        name: impl Fn(protocol::CaseId) -> String,
        play: &'a Play,
    ) -> Option<Self> {
        Some(Self { case: base.case(play.case)?, name: name(play.case), play })
    }

    pub(super) fn place_of(&self, robot: RobotId) -> Option<(CaseRobot, [f32; 2])> {
        let part = CaseRobot::new(self.play.part_of(robot)?)?;
        Some((part, mm(self.case.adapted(part, self.play.ball.into()))))
    }

    fn scopes(&self, shapes: &mut Vec<Shape>) {
        let scope = self.case.ball_scope();
        let ball = self.case.ball();
        shapes.push(ellipse(mm(ball), scope, Tone::Ball, format!("scope of the ball: {}", self.name)));
        let at: casebase::PointMm = self.play.ball.into();
        for (i, (centre, scope)) in self.case.opponents().enumerate() {
            let moved = casebase::PointMm::new(centre.x + at.x - ball.x, centre.y + at.y - ball.y);
            let note = format!("scope of opponent {}: {}", i + 1, self.name);
            shapes.push(ellipse(mm(moved), scope, Tone::Case, note));
        }
    }

    fn legs(&self, shapes: &mut Vec<Shape>) {
        for (i, leg) in self.case.legs(self.play.ball.into()).enumerate() {
            let ([x0, y0], [x1, y1]) = (leg.from, leg.to);
            let (dx, dy) = (x1 - x0, y1 - y0);
            let length = geometry::math::sqrt(dx * dx + dy * dy);
            if length < 1.0 {
                continue;
            }
            let (nx, ny) = (-dy / length, dx / length);
            let side = |x: f32, y: f32, r: f32| [milli((x + nx * r) * 0.001), milli((y + ny * r) * 0.001)];
            shapes.push(Shape::Polygon {
                points: vec![
                    side(x0, y0, leg.r_min),
                    side(x1, y1, leg.r_max),
                    side(x1, y1, -leg.r_max),
                    side(x0, y0, -leg.r_min),
                ],
                tone: Tone::Case,
                fill: true,
                note: format!("leg {} of the ball's path: {}", i + 1, self.name),
            });
            shapes.push(Shape::Line {
                points: vec![[milli(x0 * 0.001), milli(y0 * 0.001)], [milli(x1 * 0.001), milli(y1 * 0.001)]],
                tone: Tone::Case,
                arrow: true,
                dashed: false,
            });
        }
    }

    fn adapted(&self, team: Colour, shapes: &mut Vec<Shape>) {
        let tone = tone(team);
        for robot in &self.play.robots {
            let Some((part, at)) = self.place_of(*robot) else { continue };
            let note = format!("place of case robot {}, played by {}", part.number(), robot.number());
            shapes.push(Shape::Ellipse { at, radii: [0.12, 0.12], tone, fill: true, note });
            shapes.push(Shape::Text {
                at: [at[0], at[1] + 0.2],
                text: format!("{} → {}", robot.number(), part.number()),
                tone: Tone::Case,
            });
        }
    }
}

fn mm(point: casebase::PointMm) -> [f32; 2] {
    [milli(point.x as f32 * 0.001), milli(point.y as f32 * 0.001)]
}

fn ellipse(at: [f32; 2], scope: casebase::Scope, tone: Tone, note: String) -> Shape {
    let radii = [milli(scope.x as f32 * 0.001), milli(scope.y as f32 * 0.001)];
    Shape::Ellipse { at, radii, tone, fill: true, note }
}

pub(super) const fn tone(team: Colour) -> Tone {
    match team {
        Colour::Blue => Tone::Blue,
        Colour::Yellow => Tone::Yellow,
    }
}

/// The three layers of cases.
pub(super) fn of_cases(plays: &[(Colour, Played<'_>)]) -> [Layer; 3] {
    let layer = |name: &str, label: &str, add: &dyn Fn(Colour, &Played<'_>, &mut Vec<Shape>)| {
        let mut shapes = Vec::new();
        for (team, played) in plays {
            add(*team, played, &mut shapes);
        }
        Layer { name: name.to_owned(), label: label.to_owned(), on: true, shapes }
    };
    [
        layer("case-scopes", "case scopes", &|_, played, shapes| played.scopes(shapes)),
        layer("ball-path", "the ball's path", &|_, played, shapes| played.legs(shapes)),
        layer("adapted", "adapted positions", &|team, played, shapes| played.adapted(team, shapes)),
    ]
}

/// Drawings of the teams' own strategies; `None` where no team has one.
pub(super) fn of_strategies(hosts: &[&Host]) -> Option<Layer> {
    let drawings: Vec<_> =
        hosts.iter().filter_map(|host| Some((host.settings().us, host.strategy_drawing()?))).collect();
    let shapes = drawings.iter().flat_map(|(team, (flip, drawing))| {
        let place = |[x, y]: [f32; 2]| {
            let place = flip.to_field(Point::<Attack>::new(x, y));
            [milli(place.x()), milli(place.y())]
        };
        let tone = tone(*team);
        drawing.shapes.iter().map(move |shape| match shape {
            StrategyShape::Line { from, to, arrow } => {
                Shape::Line { points: vec![place(*from), place(*to)], tone, arrow: *arrow, dashed: false }
            }
            StrategyShape::Circle { at, radius } => Shape::Ellipse {
                at: place(*at),
                radii: [milli(*radius); 2],
                tone,
                fill: false,
                note: String::new(),
            },
            StrategyShape::Text { at, text } => Shape::Text { at: place(*at), text: text.clone(), tone },
        })
    });
    let (name, label) = ("strategy".to_owned(), "the team's own strategy".to_owned());
    (!drawings.is_empty()).then(|| Layer { name, label, on: true, shapes: shapes.collect() })
}

/// Zones that field players of each team must keep out of at the moment.
pub(super) fn keep_outs(
    field: &FieldSpec,
    phase: Phase<Colour>,
    ball: Option<Point<geometry::Field>>,
    placement: Option<Point<geometry::Field>>,
    blue_goal: Option<GoalEnd>,
) -> Layer {
    let mut shapes = Vec::new();
    for team in [Colour::Blue, Colour::Yellow] {
        let Some(own) = blue_goal.map(|goal| if team == Colour::Blue { goal } else { goal.opposite() })
        else {
            break;
        };
        let situation = Situation {
            field,
            own,
            phase: phase.seen_by(team),
            rule_role: RuleRole::Player,
            ball,
            placement,
            ball_in_play: true,
        };
        for forbidden in &keep_out(&situation).forbidden {
            // In open play both teams must keep out of the defence areas: drawing that adds no information.
            if matches!(phase, Phase::Run)
                && matches!(forbidden.why, KeepOutReason::OwnArea | KeepOutReason::OpponentArea)
            {
                continue;
            }
            let note = format!("{} keeps out: {}", team.label(), spaced(&format!("{:?}", forbidden.why)));
            shapes.push(region(&forbidden.shape, field, note));
        }
    }
    // The same for both teams, such as the stop's circle: drawn once.
    shapes.dedup_by(|a, b| same_place(a, b));
    Layer { name: "keep-out".to_owned(), label: "keep-out zones".to_owned(), on: true, shapes }
}

fn same_place(a: &Shape, b: &Shape) -> bool {
    match (a, b) {
        (Shape::Ellipse { at, radii, .. }, Shape::Ellipse { at: other, radii: others, .. }) => {
            at == other && radii == others
        }
        _ => false,
    }
}

fn region(shape: &geometry::Shape<geometry::Field>, field: &FieldSpec, note: String) -> Shape {
    let at = |point: Point<geometry::Field>| [milli(point.x()), milli(point.y())];
    let tone = Tone::Forbidden;
    match *shape {
        geometry::Shape::Disc { center, radius } => {
            Shape::Ellipse { at: at(center), radii: [milli(radius); 2], tone, fill: true, note }
        }
        geometry::Shape::Capsule { spine, radius } => {
            Shape::Capsule { from: at(spine.from), to: at(spine.to), radius: milli(radius), tone, note }
        }
        geometry::Shape::Box { low, high } => {
            // Half-planes are unbounded: they are clipped at the edge of the field surface.
            let (x, y) = (field.length * 0.5 + field.goal_line_margin, field.width * 0.5 + field.margin);
            let [x0, y0] = [low.x().clamp(-x, x), low.y().clamp(-y, y)].map(milli);
            let [x1, y1] = [high.x().clamp(-x, x), high.y().clamp(-y, y)].map(milli);
            // Half a field, filled for each team, would hide everything: only its border is drawn.
            let fill = (x1 - x0) * (y1 - y0) < FILLED_AREA_MAX * field.length * field.width;
            Shape::Polygon { points: vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]], tone, fill, note }
        }
    }
}
