//! `risk`: figure of the probability to receive a moving ball. Equation 6 over the field for c = 5 and 20, as
//! the paper's Figure 6.

use figures::{Anchor, Svg};
use geometry::{Attack, Point, Vector};
use host::strategy::threat::ThreatSettings;
use host::strategy::threat::receiving::{isocontour, risk_of_receiving};
use rules::League;

use crate::page::{GAP_PX, GREEN, Panel, YELLOW, finish, lines_of_text};

/// SVG text of the figure.
pub(crate) fn draw() -> String {
    let field = League::Ssl2013.field();
    let threshold = ThreatSettings::default().risk_threshold;
    let (ball, velocity) = (Point::<Attack>::new(0.6, -0.9), Vector::new(-1.35, 1.05));
    let opponents = [(-0.35, -0.1), (-1.5, 0.95), (-1.2, -0.95), (1.45, -0.1), (-2.2, 0.2)];
    let mut panels = Vec::new();
    let mut size = [0.0, 0.0];
    for (i, c) in [5.0, 20.0].into_iter().enumerate() {
        let mut panel = Panel::whole(field, [GAP_PX + i as f64 * (size[0] + GAP_PX), 92.0], 86.0);
        size = panel.size();
        let ellipse = |risk: f32| {
            let (centre, along, across) = isocontour(velocity.norm(), c, risk);
            let places = (0..90).map(|i| {
                let (s, o) = geometry::math::sin_cos(i as f32 * geometry::math::TAU / 90.0);
                let place = Vector::<Attack>::new(centre + along * o, across * s);
                ball + place.rotated(velocity.angle())
            });
            places.collect::<Vec<_>>()
        };
        let mut bands = Svg::default();
        for risk in RISK_LEVELS_S {
            let corners: Vec<_> = ellipse(risk).into_iter().map(|place| panel.at(place)).collect();
            bands.polygon(&corners, r##"fill="#d55e00" fill-opacity="0.16""##);
        }
        panel.clipped(&bands);
        panel.lines();
        let mut line = Svg::default();
        let corners: Vec<_> = ellipse(threshold).into_iter().map(|place| panel.at(place)).collect();
        line.polygon(&corners, format_args!(r#"fill="none" stroke="{YELLOW}" stroke-width="3.5""#));
        panel.clipped(&line);
        for (x, y) in opponents {
            let at = Point::new(x, y);
            let risk = risk_of_receiving(ball, velocity, at, c);
            let receives = risk > threshold;
            panel.theirs(at, if receives { "#1b1b1b" } else { "#bbbbbb" }, "#1b1b1b");
            panel.note(at, 12.0, &format!("{risk:.1} s").replace('-', "−"), Anchor::Middle);
        }
        panel.arrow(ball, ball + velocity * 0.4, GREEN, r#"stroke-width="4""#);
        panel.ball(ball);
        panel.title(&format!("c = {c:.0}"));
        panels.push(panel.svg);
    }
    let mut legend = Svg::default();
    let text = format!(
        "Risk of receiving −(|d|/|v|)·(1 + c·(1 − cos θ)) of a ball (orange) that moves at {:.1} m/s (green). Bands: above −2, −1.5, −1, −0.75, \
         −0.5 and −0.25 s; yellow: {threshold:.0} s, the threshold. Places of equal risk are ellipses with the ball in a focus. Squares: \
         opponents, black where the ball may be headed to them. We defend the left goal.",
        velocity.norm()
    )
    .replace(": -1 s", ": −1 s");
    let width = 2.0 * size[0] + 3.0 * GAP_PX;
    lines_of_text(&mut legend, [GAP_PX, 68.0], width - 2.0 * GAP_PX, &text);
    let panels: Vec<_> = panels.iter().collect();
    finish(&panels, [width, size[1] + 92.0 + 32.0], &legend, "Risk of receiving (equation 6)")
}

/// Levels of risk drawn, s.
const RISK_LEVELS_S: [f32; 6] = [-2.0, -1.5, -1.0, -0.75, -0.5, -0.25];
