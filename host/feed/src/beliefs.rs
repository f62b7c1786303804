//! `beliefs`: estimated tactics of the opponents. The tactic that best explains each one's positions of the
//! last half second, by the second paper's models (Biswas et al. 2014 §4.1), and how well every tactic
//! explains them. Field frame, m.

use geometry::Point;
use host::strategy::View;
use host::strategy::coerce::detect::{Detected, Detector};
use host::strategy::coerce::tactics::{Models, Tactic};
use host::strategy::view::Flip;
use page::{Layer, Shape, Tone, milli};
use protocol::RobotId;
use rules::Colour;

/// If a robot of ours is nearer to the ball than this, no opponent is labelled as its marker, m.
const AT_BALL: f32 = 0.5;
/// Radius of the ring around an opponent, m: wider than any robot.
const RING_RADIUS_M: f32 = 0.14;

/// Beliefs of each team about the other.
#[derive(Debug)]
pub(super) struct Beliefs {
    of: [Detector; 2],
}

impl Default for Beliefs {
    fn default() -> Self {
        Self { of: [(); 2].map(|()| Detector::new(Models::default())) }
    }
}

impl Beliefs {
    pub(super) fn watch(&mut self, us: Colour, view: &View) {
        self.of[us as usize].watch(view, kicker(view));
    }

    /// The opponents of `us`, labelled.
    pub(super) fn layer(&self, us: Colour, view: Option<(&View, Flip)>) -> Layer {
        let shapes = view.map_or_else(Vec::new, |(view, flip)| {
            let read = self.of[us as usize].read(view, kicker(view));
            read.iter().flat_map(|opponent| shapes(opponent, us, view, flip)).collect()
        });
        Layer { name: "believed".into(), label: "what opponents seem to play".into(), on: false, shapes }
    }
}

/// Our robot at the ball.
fn kicker(view: &View) -> Option<RobotId> {
    let ball = view.ball?.position;
    let far = |robot: &&host::strategy::view::ViewRobot| robot.position.distance(ball);
    let nearest = view.ours.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
    (far(&nearest) < AT_BALL).then_some(nearest.id)
}

/// A ring to point at, its tactic as a label, and a line to the robot it marks.
fn shapes(opponent: &Detected, us: Colour, view: &View, flip: Flip) -> Vec<Shape> {
    let place = |at: Point<geometry::Attack>| {
        let at = flip.to_field(at);
        [milli(at.x()), milli(at.y())]
    };
    let at = place(opponent.at);
    let ring = |note| Shape::Ellipse { at, radii: [RING_RADIUS_M; 2], tone: Tone::Plain, fill: false, note };
    let mut out = vec![ring(note(opponent, us))];
    let Some(tactic) = opponent.tactic else { return out };
    let marked = opponent.follows.and_then(|id| view.our(id));
    if let Some(marked) = marked {
        let points = vec![at, place(marked.position)];
        out.push(Shape::Line { points, tone: Tone::Plain, arrow: true, dashed: true });
    }
    let text = match (tactic, marked) {
        (Tactic::Mark, Some(marked)) => format!("marks {}", marked.id.number()),
        (Tactic::Mark, None) => "marks".to_owned(),
        _ => tactic.name().to_owned(),
    };
    out.push(Shape::Text {
        at,
        text: format!("{text} {:.0} %", likely(opponent, tactic) * 100.0),
        tone: Tone::Plain,
    });
    out
}

fn likely(opponent: &Detected, tactic: Tactic) -> f32 {
    opponent.likelihoods[tactic as usize]
}

/// All evidence behind the label.
fn note(opponent: &Detected, us: Colour) -> String {
    let who = format!("{} {}", us.other().label(), opponent.opponent.number());
    let head = match (opponent.tactic, opponent.follows) {
        (Some(Tactic::Mark), Some(follows)) => {
            let side = if opponent.ball_side { "towards the ball" } else { "towards its goal" };
            format!("marks {} {}, {:.2} m {side}", us.label(), follows.number(), opponent.stand_off)
        }
        (Some(tactic), _) => format!("plays {}", tactic.name()),
        (None, _) => "does nothing that a model explains".to_owned(),
    };
    let all =
        Tactic::ALL.map(|tactic| format!("{} {:.0} %", tactic.name(), likely(opponent, tactic) * 100.0));
    format!("{who} {head}\nby its places of the last half second: {}", all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{GoalEnd, Vector};
    use rules::League;

    fn at(x: f32, y: f32) -> Point<geometry::Attack> {
        Point::new(x, y)
    }

    /// Ours: keeper 0, 1 at the ball, 2 waits. Theirs: keeper 0, 1 goal-side of our 2, 2 far from everything.
    fn labels(defends: GoalEnd) -> Vec<Shape> {
        let place = at(1.0, -1.5);
        let marker = place + (at(4.5, 0.0) - place).unit().unwrap_or(Vector::new(1.0, 0.0)) * 0.3;
        let ours = [at(-4.3, 0.0), at(-0.2, 1.0), place];
        let theirs = [at(4.3, -0.05), marker, at(-3.0, -2.5)];
        let view = View::still(League::DivisionB.field(), at(0.0, 1.0), ours, theirs);
        let mut beliefs = Beliefs::default();
        beliefs.watch(Colour::Blue, &view);
        beliefs.layer(Colour::Blue, Some((&view, Flip::defending(defends)))).shapes
    }

    fn notes(shapes: &[Shape]) -> Vec<&str> {
        let notes = shapes.iter().filter_map(|shape| match shape {
            Shape::Ellipse { note, .. } => Some(note.as_str()),
            _ => None,
        });
        notes.collect()
    }

    #[test]
    fn a_keeper_a_marker_and_one_that_nothing_explains_are_distinguished() {
        let shapes = labels(GoalEnd::Negative);
        let notes = notes(&shapes);
        assert!(notes[0].starts_with("yellow 0 plays goalkeeper\n"), "{notes:?}");
        assert!(notes[1].starts_with("yellow 1 marks blue 2, 0.30 m towards its goal\n"), "{notes:?}");
        assert!(notes[2].starts_with("yellow 2 does nothing that a model explains"), "{notes:?}");
        let description: Vec<_> = shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Text { text, .. } => Some(text.as_str()),
                _ => None,
            })
            .collect();
        // 0.092 m beside the line from (4.5, 0) to the ball: exp(−0.5 · (0.092 / 0.25)²) = 0.934.
        assert_eq!(description, ["goalkeeper 93 %", "marks 2 100 %"]);
        let line = shapes.iter().find_map(|shape| match shape {
            Shape::Line { points, .. } => Some(points.clone()),
            _ => None,
        });
        assert_eq!(line.unwrap()[1], [1.0, -1.5], "it ends at whom it marks");
    }

    #[test]
    fn labels_stand_on_the_field_whichever_goal_we_defend() {
        let ring = |shapes: &[Shape]| match &shapes[0] {
            Shape::Ellipse { at, .. } => *at,
            other => panic!("{other:?}"),
        };
        assert_eq!(ring(&labels(GoalEnd::Negative)), [4.3, -0.05]);
        assert_eq!(ring(&labels(GoalEnd::Positive)), [-4.3, 0.05]);
    }
}
