//! `tactics`: figure of the tactic models. P(p | M_t, W) of the four models over the field, as the paper's
//! Figure 5.

use figures::{Anchor, Font, Svg};
use geometry::Point;
use host::strategy::coerce::detect::Detector;
use host::strategy::coerce::tactics::{CoerceSituation, Models, Tactic};

use crate::page::{BLUE, GAP_PX, GREEN, PURPLE, Panel, RED, TEXT_SIZE_PX, YELLOW, finish, lines_of_text};
use crate::scenes;

/// SVG text of the figure.
pub(crate) fn draw() -> String {
    let view = scenes::free_kick();
    let kicker = view.ours[1].id;
    let mut panel = Panel::whole(view.field, [GAP_PX, 118.0], 120.0);
    let situation = CoerceSituation::new(&view, Models::default(), Some(kicker));
    for tactic in [Tactic::Mark, Tactic::Wall, Tactic::PrimaryDefence, Tactic::Goalkeeper] {
        let which = Tactic::ALL.iter().position(|other| *other == tactic).unwrap_or(0);
        for level in LIKELIHOOD_LEVELS {
            let style = format!(r#"fill="{}" fill-opacity="0.2""#, colour(tactic));
            panel.area_above(0.05, level, style, |at| situation.likelihoods(at)[which]);
        }
    }
    panel.lines();
    let mut detector = Detector::new(Models::default());
    detector.watch(&view, Some(kicker));
    for robot in &view.ours {
        let name = if robot.id == kicker { "T".into() } else { robot.id.number().to_string() };
        panel.ours(robot.position, &name, YELLOW);
    }
    for known in detector.read(&view, Some(kicker)) {
        let fill = known.tactic.map_or("#bbbbbb", colour);
        panel.theirs(known.at, fill, "#1b1b1b");
        let most = known.likelihoods.iter().copied().fold(0.0, f32::max);
        let right = known.at.x() < 2.4;
        let at = Point::new(known.at.x() + if right { 0.13 } else { 0.0 }, known.at.y());
        let (up, anchor) = if right { (-4.0, Anchor::Start) } else { (14.0, Anchor::Middle) };
        panel.note(at, up, &format!("{most:.2}"), anchor);
    }
    if let Some(ball) = view.ball {
        panel.ball(ball.position);
    }
    let [width, height] = panel.size();
    let mut legend = Svg::default();
    let mut x = GAP_PX;
    for tactic in Tactic::ALL {
        legend.rect(
            [x, 92.0],
            [x + 26.0, 106.0],
            format_args!(r#"fill="{}" fill-opacity="0.75""#, colour(tactic)),
        );
        let font = Font { size: TEXT_SIZE_PX, fill: "#1b1b1b", bold: false, halo: None };
        legend.text([x + 34.0, 94.0], tactic.name(), Anchor::Start, font);
        x += 56.0 + figures::width(tactic.name(), TEXT_SIZE_PX);
    }
    let text = "Bands: the model's likelihood is above 0.2 (α, the threshold), 0.4, 0.6 and 0.8. Discs: our robots, T takes the free kick, 0 is \
                the keeper. Squares: opponents in the colour of the tactic that explains their place best, with its likelihood. We attack \
                to the right; field of 2013.";
    lines_of_text(&mut legend, [GAP_PX, 66.0], width, text);
    finish(
        &[&panel.svg],
        [width + 2.0 * GAP_PX, height + 118.0 + GAP_PX],
        &legend,
        "Tactics of opponents at a free kick",
    )
}

pub(crate) fn colour(tactic: Tactic) -> &'static str {
    match tactic {
        Tactic::Goalkeeper => BLUE,
        Tactic::PrimaryDefence => GREEN,
        Tactic::Mark => RED,
        Tactic::Wall => PURPLE,
    }
}

const LIKELIHOOD_LEVELS: [f32; 4] = [0.2, 0.4, 0.6, 0.8];
