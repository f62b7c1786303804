//! `picture`: an episode's field, ball and robots as SVG and as pixels. mm, field frame.

use figures::{At, Svg, Theme, draw_field, half_extent};
use hil_sim::small_size::Robot;
use protocol::{RobotId, Who};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg;
use rules::Colour;

use crate::state::State;

/// Red, green and blue of each pixel, row by row from the top.
pub struct Pixels {
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
    /// Width, height.
    pub size: [u32; 2],
}

/// The state as an SVG `width` pixels wide: own robots blue, those of the caller framed, opponents grey.
pub fn svg(state: &State, width: u32) -> String {
    let (settings, colors) = (&state.settings, Theme::Light.colors());
    let mut svg = Svg::default();
    let field = settings.league.field();
    draw_field(&mut svg, &field, colors);
    for colour in [Colour::Yellow, Colour::Blue] {
        for (n, id) in RobotId::all().take(settings.count(colour)).enumerate() {
            let Some(robot) = state.world.robot(Who { colour, id }) else { continue };
            let is_framed = colour == Colour::Blue && n < settings.agents;
            let fill = colour.pick(colors.opponent, colors.team);
            hull(&mut svg, robot, [fill, if is_framed { colors.ink } else { fill }, colors.line]);
        }
    }
    let ball = &state.world.ball;
    let radius = BALL_MM * f64::from(1.0 + ball.height);
    let style = format!(r#"fill="{}" stroke="{}" stroke-width="12""#, colors.ball, colors.ink);
    svg.circle(at(ball.position.x(), ball.position.y()), radius, style);
    let [x, y] = half_extent(&field);
    svg.finish([-x, -y], [x, y], f64::from(width) / (2.0 * x), colors.paper, "onetwo")
}

/// The disc of a robot's hull, cut straight at the front; colours of the disc, its frame and its front.
fn hull(svg: &mut Svg, robot: &Robot, [fill, frame, front]: [&str; 3]) {
    let (body, place, heading) = (robot.body, robot.pose.position, robot.pose.heading.radians());
    let open = (body.front / body.radius).acos();
    let corners: Vec<At> = (0..=CORNERS)
        .map(|n| heading + open + (std::f32::consts::TAU - 2.0 * open) * (n as f32 / CORNERS as f32))
        .map(|angle| at(place.x() + body.radius * angle.cos(), place.y() + body.radius * angle.sin()))
        .collect();
    svg.polygon(&corners, format_args!(r#"fill="{fill}" stroke="{frame}" stroke-width="16""#));
    svg.line(corners[CORNERS], corners[0], format_args!(r#"stroke="{front}" stroke-width="28""#));
}

/// A drawing as pixels; width and height are even, as encoders of videos need them.
pub fn pixels(svg: &str) -> Result<Pixels, String> {
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).map_err(|error| error.to_string())?;
    let size = [tree.size().width(), tree.size().height()].map(|side| side as u32 & !1);
    let mut drawn = Pixmap::new(size[0], size[1]).ok_or("the picture is empty")?;
    drawn.fill(Color::WHITE);
    resvg::render(&tree, Transform::identity(), &mut drawn.as_mut());
    let rgb = drawn.data().chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    Ok(Pixels { rgb, size })
}

/// mm of a place in m.
fn at(x: f32, y: f32) -> At {
    [x, y].map(|metres| f64::from(metres) * 1000.0)
}

/// Radius of the drawn ball, mm: twice the true one, to be seen.
const BALL_MM: f64 = 43.0;
/// Corners of a hull's round part.
const CORNERS: usize = 24;
/// Widths that are drawn, px: from a thumbnail to a screen of 4,096.
pub const WIDTHS: std::ops::RangeInclusive<u32> = 64..=4096;
