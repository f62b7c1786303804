//! `coercing`: figure of the coerce plan. The optimistic attack and the coerce plan against it, by the
//! planner (§4.2, §4.3).

use figures::{Anchor, Svg};
use geometry::{Point, Vector};
use host::strategy::View;
use host::strategy::coerce::grid::Cell;
use host::strategy::coerce::tactics::Models;
use host::strategy::coerce::{ByPassLocation, CapPlan, CoerceSettings, Planner};
use host::strategy::pass::{Kicks, PassConstants};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use rules::League;

use crate::page::{GAP_PX, GREEN, Panel, RED, YELLOW, finish, lines_of_text};
use crate::{scenes, tactics};

/// SVG text of the figure.
pub(crate) fn draw() -> String {
    let league = League::Ssl2013;
    let view = scenes::free_kick();
    let kicker = view.ours[1].id;
    let kicks = Kicks::new(PassConstants::of(league), BallModel::default(), ChipModel::default());
    let mut planner = Planner::new(CoerceSettings::of(league), Models::default());
    planner.observe(&view, kicker);
    let Some(plan) = planner.plan(&view, &ByPassLocation::new(&kicks), kicker, PLANNER_SEED) else {
        return String::new();
    };
    let left = optimistic(&view, plan);
    let size = left.size();
    let right = coerced(&view, plan, size[0] + 2.0 * GAP_PX);
    let mut legend = Svg::default();
    let width = 2.0 * size[0] + 3.0 * GAP_PX;
    let first = plan.coerce.coercers.first().map_or(0, |coercer| coercer.robot.number());
    let text = format!(
        "Left: P(receive)·P(goal) of every cell in percent, against those who follow the ball alone (coloured squares; hollow ones follow \
         robots and do not count); the best cell, refined, is the optimistic attack, pass and shot in green. Right: the interference \
         likelihood of every cell for robot {first}, who is sent first, in percent (100 where none may be sent); where the robots go \
         (discs to hollow discs) and where their followers are expected (squares to hollow squares). T takes the kick, R receives. Free \
         kick on the field of 2013, towards the right."
    );
    lines_of_text(&mut legend, [GAP_PX, 88.0], width - 2.0 * GAP_PX, &text);
    finish(
        &[&left.svg, &right.svg],
        [width, size[1] + LEGEND_HEIGHT_PX + 32.0],
        &legend,
        "The Coerce and Attack Planner",
    )
}

/// Steps 1 and 2 of the planner.
fn optimistic(view: &View, plan: &CapPlan) -> Panel {
    let mut panel = Panel::whole(view.field, [GAP_PX, LEGEND_HEIGHT_PX], PX_PER_M);
    let most = plan.values.iter().copied().fold(1e-6, f32::max);
    for cell in Cell::all() {
        let value = plan.values[cell.index()];
        shade(&mut panel, view, cell, GREEN, 0.75 * value / most);
    }
    panel.lines();
    for cell in Cell::all() {
        percent(&mut panel, view, cell, plan.values[cell.index()]);
    }
    attack(&mut panel, view, plan);
    for known in &plan.detected {
        let fill = known.tactic.map_or("#bbbbbb", tactics::colour);
        let (fill, stroke) = if known.follows_robots() { ("none", RED) } else { (fill, "#1b1b1b") };
        panel.theirs(known.at, fill, stroke);
    }
    robots(&mut panel, view, plan);
    panel.title("Steps 1, 2: the optimistic attack");
    panel
}

/// Step 3 of the planner.
fn coerced(view: &View, plan: &CapPlan, left: f64) -> Panel {
    let mut panel = Panel::whole(view.field, [left, LEGEND_HEIGHT_PX], PX_PER_M);
    let sent = |cell: Cell| plan.coerce.first[cell.index()];
    for cell in Cell::all() {
        shade(&mut panel, view, cell, RED, 0.6 * sent(cell));
    }
    panel.lines();
    for cell in Cell::all() {
        percent(&mut panel, view, cell, sent(cell));
    }
    attack(&mut panel, view, plan);
    let dashed = r#"stroke-width="2" stroke-dasharray="6 4""#;
    for coercer in &plan.coerce.coercers {
        if let (Some(ours), Some(theirs)) =
            (view.our(coercer.robot), view.theirs.iter().find(|robot| robot.id == coercer.marker))
        {
            panel.arrow(theirs.position, coercer.expected, RED, dashed);
            panel.arrow(ours.position, coercer.at, "#8a8000", dashed);
        }
        panel.theirs(coercer.expected, "#ffffff", RED);
        panel.ours(coercer.at, &coercer.robot.number().to_string(), "#ffffff");
    }
    for known in &plan.detected {
        panel.theirs(known.at, known.tactic.map_or("#bbbbbb", tactics::colour), "#1b1b1b");
    }
    robots(&mut panel, view, plan);
    panel.title("Step 3: the coerce plan");
    panel
}

fn shade(panel: &mut Panel, view: &View, cell: Cell, fill: &str, opacity: f32) {
    let (middle, half) = (cell.middle(&view.field), Cell::size(&view.field) * 0.485);
    let (low, high) = (panel.at(middle - half), panel.at(middle + half));
    panel.svg.rect(low, high, format_args!(r#"fill="{fill}" fill-opacity="{opacity:.3}""#));
}

fn percent(panel: &mut Panel, view: &View, cell: Cell, value: f32) {
    let size = Cell::size(&view.field);
    let at = cell.middle(&view.field) + Vector::new(-0.46 * size.x(), 0.46 * size.y());
    let text = if value >= 0.9995 { "100".into() } else { format!("{:.1}", 100.0 * value) };
    panel.note(at, -11.0, &text, Anchor::Start);
}

fn attack(panel: &mut Panel, view: &View, plan: &CapPlan) {
    let from = view.ball.map_or(Point::default(), |ball| ball.position);
    let at = plan.optimistic.at;
    panel.arrow(from, at, GREEN, r#"stroke-width="3.5""#);
    panel.arrow(at, plan.optimistic.worth.aim, GREEN, r#"stroke-width="3.5" stroke-dasharray="2 5""#);
    let place = panel.at(at);
    let radius = panel.px(0.09);
    panel.svg.circle(place, radius, format_args!(r##"fill="#ffffff" stroke="{GREEN}" stroke-width="2""##));
    panel.label([place[0], place[1] - radius * 0.5], "R", Anchor::Middle, radius * 1.4, "#1b1b1b");
}

fn robots(panel: &mut Panel, view: &View, plan: &CapPlan) {
    for robot in &view.ours {
        let name = match robot.id {
            id if id == plan.kicker => "T".into(),
            id if id == plan.optimistic.receiver => "R".into(),
            id => id.number().to_string(),
        };
        panel.ours(robot.position, &name, YELLOW);
    }
    if let Some(ball) = view.ball {
        panel.ball(ball.position);
    }
}

const PX_PER_M: f64 = 104.0;
/// Height of the text below, px.
const LEGEND_HEIGHT_PX: f64 = 112.0;
const PLANNER_SEED: u64 = 1;
