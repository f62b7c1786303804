//! `pass_probability`: figures of pass and goal probabilities. The paper's Figures 2 and 3, and the value
//! that is maximised (Biswas et al. 2014 §3.1): c2 for flat passes and for chips, c2', and P(receive) ·
//! P(goal) with the place that the search finds.

use figures::{Anchor, At, Svg, field_lines, half_extent};
use geometry::{Attack, Point};
use host::strategy::View;
use host::strategy::pass::{Kicks, PassConstants, PassScene, Rating, SAMPLES, Search};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use rules::League;

use super::field::{LETTER_SIZE_MM, colors, label, legend, map, mm, robots, text};
use super::scenes::moment;

/// Draws it: two columns of panels.
pub(crate) fn draw() -> String {
    let league = League::Ssl2013;
    let view = moment(league, BALL, &OURS, &THEIRS);
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let (Some(ball), [_, passer, receiver, ..]) = (view.ball, &view.ours[..]) else { return String::new() };
    let scene = PassScene::of(&view, &kicks, ball.position, Some(passer.id), receiver);
    let mut search = Search::new(1);
    let best = (0..20).fold(search.step(&scene, SAMPLES), |_, _| search.step(&scene, SAMPLES));
    let [half_x, half_y] = half_extent(&view.field);
    let (wide, high) = (2.0 * half_x + PANEL_GAP_MM, 2.0 * half_y + PANEL_GAP_MM + TITLE_HEIGHT_MM);
    let most = f64::from(best.value());
    let panels: [Panel<'_>; 4] = [
        ("flat pass: P(c2), not intercepted", Box::new(|at| scene.not_intercepted(at)[0]), 1.0),
        ("chip: P(c2), with its prior", Box::new(|at| scene.not_intercepted(at)[1]), 1.0),
        ("P(c2'), a wide enough open angle on the goal", Box::new(|at| scene.rate(at).goal_factors[1]), 1.0),
        ("P(receive) · P(goal) and the best place found", Box::new(|at| scene.rate(at).value()), most),
    ];
    let mut svg = Svg::default();
    for (i, (title, value, full)) in panels.iter().enumerate() {
        let at = [wide * (i % 2) as f64, -high * (i / 2) as f64];
        let mut panel = Svg::default();
        let surface = format!(r#"fill="{}""#, colors().surface);
        panel.rect([-half_x, -half_y], [half_x, half_y], surface);
        map(&mut panel, &view.field, CELL_M, |at| value(at) / *full as f32);
        over(&mut panel, &view, (i == 3).then_some(&best));
        if i < 2 {
            for (name, (x, y)) in NAMED_PLACES {
                label(&mut panel, Point::new(x, y), name);
            }
        }
        panel.text([-half_x, half_y + 110.0], title, Anchor::Start, text(LETTER_SIZE_MM));
        let to = if *full < 1.0 { format!("{full:.2}") } else { "1".into() };
        legend(&mut panel, [half_x - 1700.0, half_y + 220.0], [1200.0, 130.0], ["0", &to]);
        svg.inset(&panel, at);
    }
    let table = constants(&kicks);
    let foot: At = [-half_x, -high - half_y - 320.0];
    for (i, line) in table.iter().enumerate() {
        svg.text([foot[0], foot[1] - i as f64 * 250.0], line, Anchor::Start, text(LETTER_SIZE_MM * 0.9));
    }
    let bottom = foot[1] - table.len() as f64 * 250.0;
    let (low, top) = ([-half_x - 150.0, bottom], [wide + half_x + 150.0, half_y + 420.0]);
    svg.finish(low, top, 0.085, colors().paper, "Where a pass would arrive, and where it would end in a goal")
}

type Panel<'a> = (&'static str, Box<dyn Fn(Point<Attack>) -> f32 + 'a>, f64);

/// Lines, robots, and the pass that was chosen.
fn over(svg: &mut Svg, view: &View, best: Option<&Rating>) {
    field_lines(svg, &view.field, colors(), colors().line);
    if let (Some(best), Some(ball)) = (best, view.ball) {
        let width = r#"stroke-width="45""#;
        svg.arrow(mm(ball.position), mm(best.at), 160.0, "#ffffff", width);
        let dashed = format!(r#"{width} stroke-dasharray="120 80""#);
        svg.arrow(mm(best.at), mm(best.shot.aim), 160.0, "#ffffff", dashed);
    }
    robots(svg, view);
    if let Some(best) = best {
        let kick = if best.kick.is_chip() { "chip" } else { "flat" };
        let name = format!("{kick}: {:.2} · {:.2}", best.receive(), best.goal());
        label(svg, best.at, &name);
    }
}

/// The constants it was drawn with.
fn constants(kicks: &Kicks) -> Vec<String> {
    let c = kicks.constants();
    vec![
        format!(
            "Field of 2013 (6 × 4 m): orange the ball, blue our team (passer at the ball, receiver above it), grey opponents. Passes arrive with {} m/s,",
            c.arrival
        ),
        format!(
            "opponents see a kick after {} s and drive {} m/s, {} m/s². ~0 to ~1 within ± {} s; chip prior {}; p_gmin {}, θ_max {:.0}°, p_turn {}, p_out {}.",
            c.reaction,
            c.opponent.speed,
            c.opponent.acceleration,
            3.0 * c.time_width,
            c.chip_prior,
            c.closed_prior,
            c.open_enough.to_degrees(),
            c.turn_prior,
            c.outside_prior,
        ),
        "a: far from everybody. b: just behind an opponent, who meets flat pass and chip. c: farther behind it, where a chip comes down out of its".into(),
        "reach, at the lower prior of chips. No chip is shorter than 1 m: its arch would not clear a robot.".into(),
    ]
}

/// The moment: a free kick in the own half, an opponent between ball and goal, as in the paper's Fig. 2.
const BALL: (f32, f32) = (-0.4, -1.2);
const OURS: [(f32, f32); 4] = [(-2.9, 0.0), (-0.5, -1.25), (0.9, 0.9), (-1.8, -0.6)];
const THEIRS: [(f32, f32); 5] = [(2.85, -0.05), (2.15, -0.35), (2.1, 0.3), (0.45, -0.75), (0.1, 0.7)];
/// Places as the paper's figure names them.
const NAMED_PLACES: [(&str, (f32, f32)); 3] = [("a", (-1.3, 1.2)), ("b", (0.95, -0.45)), ("c", (1.55, -0.3))];
/// Side of a square of the maps, m.
const CELL_M: f32 = 0.05;
/// Gap between panels, mm.
const PANEL_GAP_MM: f64 = 120.0;
/// Space for a panel's title, mm.
const TITLE_HEIGHT_MM: f64 = 320.0;
