//! `case`: figure of one case, optionally with a problem: scopes, ball path, robots, and the correspondence.
//!
//! Over a problem everything is adapted, moved by `B_p` − `B_c`, except the ball's scope: that stays where
//! the case has it.

use casebase::{
    Action, Case, CaseBase, CaseRobot, CaseVerdict, GoalEnd, Leg, PointMm, Presence, Problem,
    RetrievalSettings, Scope, ScopeRule, adapted_position,
};

use crate::{Anchor, At, Colors, Font, Svg, Theme, draw_field, half_extent, wrapped};

use super::labels::Labels;
use super::verdict::caption_of;

/// A case to be drawn.
#[derive(Clone, Debug)]
pub struct CasePicture<'a> {
    /// The case base with its field.
    pub base: CaseBase<'a>,
    /// The case to draw.
    pub case: Case<'a>,
    /// The case's name, `region/name`, for the title.
    pub name: &'a str,
    /// The case's purpose, in its author's text.
    pub intent: &'a str,
    /// The problem to draw over it, if any.
    pub overlay: Option<Overlay<'a>>,
    /// Palette of the figure.
    pub theme: Theme,
}

/// A problem over a case.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// Ball, teammates and opponents, mm, field frame.
    pub problem: &'a Problem,
    /// The settings of the retrieval.
    pub settings: &'a RetrievalSettings,
    /// The verdict of [`casebase::explain()`] on the case.
    pub verdict: &'a CaseVerdict,
    /// The case's rank among the candidates, from 1, and their number; `None` where it is not a candidate.
    pub rank: Option<(usize, usize)>,
}

/// The figure as an SVG of about 900 px, in mm.
pub fn case_picture(picture: &CasePicture<'_>) -> String {
    let half = half_extent(&picture.base.field());
    let mut pen = scene(picture, 1.0);
    caption(&mut pen, picture, half)
}

/// The field with the case, symbols enlarged by `zoom`; without heading and caption, and without letters on a
/// small one.
pub(super) fn small(picture: &CasePicture<'_>, zoom: f64) -> Svg {
    scene(picture, zoom).svg
}

fn scene<'p>(picture: &'p CasePicture<'p>, zoom: f64) -> Pen {
    let colors = picture.theme.colors();
    let [x, _] = half_extent(&picture.base.field());
    let unit = 2.0 * x / 100.0 * zoom;
    let mut pen = Pen { svg: Svg::default(), labels: Labels::default(), colors, unit };
    draw_field(&mut pen.svg, &picture.base.field(), colors);
    let settings =
        picture.overlay.map_or_else(RetrievalSettings::default, |overlay| overlay.settings.clone());
    let ball = picture.overlay.map_or(picture.case.ball(), |overlay| overlay.problem.ball);
    let scene = Scene { picture, settings: &settings, ball };
    scene.reserve(&mut pen);
    scene.ball_scope(&mut pen);
    scene.opponents(&mut pen);
    scene.legs(&mut pen);
    scene.paths(&mut pen);
    scene.robots(&mut pen);
    if let Some(overlay) = &picture.overlay {
        scene.situation(&mut pen, overlay);
    }
    pen.ball(at(ball));
    let mut labels = std::mem::take(&mut pen.labels);
    labels.write(&mut pen.svg, unit * 1.4, colors.surface);
    if zoom <= 1.0 {
        scene.ring_names(&mut pen, &mut labels);
    }
    pen
}

struct Scene<'p, 'a> {
    picture: &'p CasePicture<'a>,
    settings: &'p RetrievalSettings,
    ball: PointMm,
}

impl Scene<'_, '_> {
    /// The rings at which the similarity interval changes, and the border.
    fn ball_scope(&self, pen: &mut Pen) {
        let (center, scope) = (at(self.picture.case.ball()), self.picture.case.ball_scope());
        let Colors { ball, .. } = pen.colors;
        for (similarity, _) in INTERVALS {
            let radii = ring(scope, -f64::ln(similarity));
            let style = format!(r#"fill="{ball}" fill-opacity="0.07" stroke="{ball}" stroke-width="8""#);
            pen.svg.ellipse(center, radii, style);
        }
        let radii = ring(scope, f64::from(self.settings.limit()));
        let style = format!(r#"fill="{ball}" fill-opacity="0.07" stroke="{ball}" stroke-width="16""#);
        pen.svg.ellipse(center, radii, style);
        if self.ball != self.picture.case.ball() {
            let style = format!(r#"fill="none" stroke="{ball}" stroke-width="14" stroke-dasharray="30 24""#);
            pen.svg.circle(center, pen.unit * 0.9, style);
        }
    }

    /// Positions of symbols: numbers of legs, names and letters do not overlap them.
    fn reserve(&self, pen: &mut Pen) {
        let unit = pen.unit;
        pen.labels.keep_free(at(self.ball), unit * 0.8);
        for robot in self.picture.case.robots() {
            pen.labels.keep_free(at(self.adapted(robot)), unit * 1.9);
        }
        let moved = self.scopes_moved();
        for (place, _) in self.picture.case.opponents() {
            pen.labels.keep_free(at(place.plus(moved)), unit * 1.5);
        }
        if let Some(Overlay { problem, .. }) = &self.picture.overlay {
            for place in problem.teammates.iter().map(|(_, place)| place).chain(&problem.opponents) {
                pen.labels.keep_free(at(*place), unit * 1.9);
            }
        }
    }

    /// The letters of the intervals: on the first ray where none overlaps a symbol or another letter, else
    /// each where it can; a letter without room is left out.
    fn ring_names(&self, pen: &mut Pen, labels: &mut Labels) {
        let size = pen.unit * 1.3;
        let half = size * 0.42;
        let ray = LETTER_RAYS.iter().find(|degrees| self.is_clear(**degrees, size, half, labels)).copied();
        let font = Font { size, fill: pen.colors.ink, bold: false, halo: Some(pen.colors.surface) };
        let letters = INTERVALS.map(|(_, letter)| letter).into_iter().chain(["L"]);
        for (band, letter) in letters.enumerate() {
            let places =
                ray.iter().chain(&LETTER_RAYS).map(|degrees| self.letter_place(*degrees, band, size));
            if let Some([x, y]) = labels.free(places, half) {
                labels.keep_free([x, y], half);
                pen.svg.text([x, y - size * 0.36], letter, Anchor::Middle, font);
            }
        }
    }

    /// Place of a band's letter on a ray from the ball: in the middle of the band; the outermost is thinner
    /// than a letter, whose place is outside.
    fn letter_place(&self, degrees: i32, band: usize, size: f64) -> At {
        let (center, scope) = (at(self.picture.case.ball()), self.picture.case.ball_scope());
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let [x, y] = [f64::from(scope.x) * cos, f64::from(scope.y) * sin];
        let rings = INTERVALS.map(|(similarity, _)| f64::sqrt(-f64::ln(similarity)));
        let share = match band {
            0 => 0.5 * rings[0],
            1 | 2 => f64::midpoint(rings[band - 1], rings[band]),
            _ => f64::from(self.settings.limit()).sqrt() + size * 0.7 / x.hypot(y),
        };
        [center[0] + x * share, center[1] + y * share]
    }

    /// True if all letters have room on a ray.
    fn is_clear(&self, degrees: i32, size: f64, half: f64, labels: &Labels) -> bool {
        let places = [0, 1, 2, 3].map(|band| self.letter_place(degrees, band, size));
        let are_apart = places
            .windows(2)
            .all(|pair| (0..2).any(|axis| (pair[0][axis] - pair[1][axis]).abs() >= 2.0 * half));
        are_apart && places.iter().all(|place| labels.free([*place], half).is_some())
    }

    /// Displacement of the opponents' scopes with the ball.
    fn scopes_moved(&self) -> PointMm {
        match self.settings.scopes {
            ScopeRule::Translated => self.picture.case.shift(self.ball),
            ScopeRule::Absolute => PointMm::new(0, 0),
        }
    }

    fn opponents(&self, pen: &mut Pen) {
        let Colors { opponent, .. } = pen.colors;
        let moved = self.scopes_moved();
        for (number, (place, scope)) in (1..).zip(self.picture.case.opponents()) {
            let center = at(place.plus(moved));
            let radii = ring(scope, f64::from(self.settings.limit()));
            let held = self.picture.overlay.is_some_and(|overlay| {
                overlay.problem.opponents.iter().any(|one| within(at(*one), center, radii))
            });
            let opacity = if held { 0.35 } else { 0.08 };
            let style = format!(
                r#"fill="{opponent}" fill-opacity="{opacity}" stroke="{opponent}" stroke-width="12" stroke-dasharray="40 28""#
            );
            pen.svg.ellipse(center, radii, style);
            let presence = self.picture.case.presence(number - 1);
            let ghost = self.picture.overlay.is_some();
            if presence != Presence::Excluded {
                pen.square(center, if ghost { "none" } else { opponent });
            }
            let name = match presence {
                Presence::Preferred => format!("opp{number}"),
                other => format!("opp{number} {}", other.label()),
            };
            pen.labels.name(center, pen.unit * 1.7, name, pen.colors.ink);
        }
    }

    fn legs(&self, pen: &mut Pen) {
        let blocked = match self.picture.overlay.map(|overlay| overlay.verdict) {
            Some(CaseVerdict::Path { index, .. }) => Some(*index),
            _ => None,
        };
        for (number, leg) in self.picture.case.legs(self.ball).enumerate() {
            let Some(corners) = trapezoid(&leg, f64::from(self.settings.limit())) else { continue };
            let color = if blocked == Some(number) { pen.colors.warning } else { pen.colors.path };
            let style = format!(
                r#"fill="{color}" fill-opacity="0.16" stroke="{color}" stroke-opacity="0.6" stroke-width="8""#
            );
            pen.svg.polygon(&corners, style);
            let (from, to) = (leg.from.map(f64::from), leg.to.map(f64::from));
            let along = |share: f64| [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
            // A robot that waits there would hide the head.
            let length = distance(from, to);
            let waits = |robot| distance(at(self.adapted(robot)), to) < pen.unit * 1.9;
            let short = if self.picture.case.robots().any(waits) { pen.unit * 2.0 } else { 0.0 };
            pen.arrow(from, along((1.0 - short / length).max(0.1)), color, "");
            let middle = pen
                .labels
                .free(LEG_NUMBER_SHARES.map(along), pen.unit * 1.2)
                .unwrap_or(along(LEG_NUMBER_SHARES[0]));
            let style = format!(r#"fill="{}" stroke="{color}" stroke-width="10""#, pen.colors.paper);
            pen.svg.circle(middle, pen.unit * 1.2, style);
            pen.labels.keep_free(middle, pen.unit * 1.2);
            let font = Font { size: pen.unit * 1.5, fill: pen.colors.ink, bold: true, halo: None };
            let text = (number + 1).to_string();
            pen.svg.text([middle[0], middle[1] - pen.unit * 0.55], &text, Anchor::Middle, font);
        }
    }

    /// Movements without the ball and with it.
    fn paths(&self, pen: &mut Pen) {
        let case = &self.picture.case;
        let shift = case.shift(self.ball);
        for robot in case.robots() {
            let mut place = at(self.adapted(robot));
            for (index, action) in case.gameplay(robot).enumerate() {
                let next = match action {
                    Action::GoToPoint(point) | Action::DribbleTo(point) => at(point.plus(shift)),
                    Action::GetBall | Action::ReceiveBall(_) => self.ball_reached_at(robot, index),
                    _ => continue,
                };
                let dash = match action {
                    Action::DribbleTo(_) => r#"stroke-dasharray="20 40" stroke-linecap="round""#,
                    _ => r#"stroke-dasharray="60 36""#,
                };
                pen.arrow(place, next, pen.colors.team, dash);
                place = next;
            }
        }
    }

    /// Position where a robot reaches the ball: at the end of the leg that brings it, or at the ball's start
    /// position.
    fn ball_reached_at(&self, robot: CaseRobot, action: usize) -> At {
        let case = &self.picture.case;
        let from = case.partner_of(robot, action);
        let leg = case.legs(self.ball).find(|leg| Some((leg.robot, leg.action)) == from);
        leg.map_or(at(self.ball), |leg| leg.to.map(f64::from))
    }

    fn robots(&self, pen: &mut Pen) {
        let ghost = self.picture.overlay.is_some();
        for robot in self.picture.case.robots() {
            let label = robot.to_string();
            let place = at(self.adapted(robot));
            pen.robot(place, "", ghost);
            pen.labels.name(place, pen.unit * 2.0, label, pen.colors.ink);
        }
    }

    /// The robots and opponents of the problem, and the correspondence.
    fn situation(&self, pen: &mut Pen, overlay: &Overlay<'_>) {
        let Overlay { problem, verdict, .. } = overlay;
        let pairs: Vec<_> = match verdict {
            CaseVerdict::Candidate(found) => {
                self.picture.case.robots().zip(found.correspondence.iter().copied()).collect()
            }
            CaseVerdict::TooFar { robot, player, .. } => vec![(*robot, *player)],
            _ => Vec::new(),
        };
        let is_far = matches!(verdict, CaseVerdict::TooFar { .. });
        let color = if is_far { pen.colors.warning } else { pen.colors.team };
        for (robot, player) in pairs {
            let teammate = problem.teammates.iter().find(|(other, _)| *other == player);
            let (Some((_, from)), to) = (teammate, at(self.adapted(robot))) else { continue };
            let from = at(*from);
            pen.svg.line(from, to, format!(r#"stroke="{color}" stroke-width="16""#));
            let length = distance(from, to);
            let middle = [f64::midpoint(from[0], to[0]), f64::midpoint(from[1], to[1])];
            pen.labels.name(middle, pen.unit * 0.4, format!("{length:.0} mm"), color);
        }
        for (id, place) in &problem.teammates {
            pen.robot(at(*place), &id.to_string(), false);
        }
        for (index, place) in problem.opponents.iter().enumerate() {
            match verdict {
                CaseVerdict::Path { opponent, inside_mm, .. } if *opponent == index => {
                    pen.square(at(*place), pen.colors.warning);
                    let text = format!("{inside_mm:.0} mm inside");
                    pen.labels.name(at(*place), pen.unit * 1.7, text, pen.colors.warning);
                }
                _ => pen.square(at(*place), pen.colors.opponent),
            }
        }
    }

    fn adapted(&self, robot: CaseRobot) -> PointMm {
        adapted_position(&self.picture.case, robot, self.ball, self.settings)
    }
}

/// Draws the symbols of these figures; `unit` is a hundredth of the figure's width, mm.
struct Pen {
    svg: Svg,
    labels: Labels,
    colors: &'static Colors,
    unit: f64,
}

impl Pen {
    fn ball(&mut self, place: At) {
        let style = format!(r#"fill="{}" stroke="{}" stroke-width="12""#, self.colors.ball, self.colors.ink);
        self.svg.circle(place, self.unit * 0.8, style);
    }

    fn robot(&mut self, place: At, label: &str, ghost: bool) {
        let Colors { team, paper, .. } = self.colors;
        let (fill, ink, dash) =
            if ghost { (paper, team, r#" stroke-dasharray="36 24""#) } else { (team, paper, "") };
        let style = format!(r#"fill="{fill}" stroke="{team}" stroke-width="14"{dash}"#);
        self.svg.circle(place, self.unit * 1.9, style);
        self.labels.keep_free(place, self.unit * 1.7);
        let font = Font { size: self.unit * 1.4, fill: ink, bold: true, halo: None };
        if !label.is_empty() {
            self.svg.text([place[0], place[1] - self.unit * 0.5], label, Anchor::Middle, font);
        }
    }

    fn square(&mut self, [x, y]: At, fill: &str) {
        self.labels.keep_free([x, y], self.unit * 1.5);
        let (half, ink) = (self.unit * 1.5, self.colors.opponent);
        let style = format!(r#"fill="{fill}" stroke="{ink}" stroke-width="14""#);
        self.svg.rect([x - half, y - half], [x + half, y + half], style);
    }

    /// An arrow whose head's tip is at `to`; nothing where it has no length.
    fn arrow(&mut self, from: At, to: At, color: &str, dash: &str) {
        if distance(from, to) >= 1.0 {
            self.svg.arrow(from, to, self.unit * 1.8, color, format_args!(r#"stroke-width="18" {dash}"#));
        }
    }
}

fn caption(pen: &mut Pen, picture: &CasePicture<'_>, [x, y]: [f64; 2]) -> String {
    let (unit, colors, case) = (pen.unit, pen.colors, &picture.case);
    let font = Font { size: unit * 2.4, fill: colors.ink, bold: true, halo: None };
    pen.svg.text([-x, y + unit * 1.6], picture.name, Anchor::Start, font);
    let towards = if case.defending() == GoalEnd::Negative { "right" } else { "left" };
    let side = format!("{} · id {} · attacks to the {towards}", case.symmetry().label(), case.id());
    let font = Font { size: unit * 1.7, fill: colors.faint, bold: false, halo: None };
    pen.svg.text([x, y + unit * 1.6], &side, Anchor::End, font);
    let verdict = picture.overlay.map(|overlay| caption_of(overlay.verdict, overlay.rank));
    let mut below = -y - unit * 0.6;
    for text in [Some(picture.intent.to_owned()), verdict, Some(LEGEND.to_owned())].into_iter().flatten() {
        for line in wrapped(&text, font.size, 2.0 * x) {
            below -= unit * 2.4;
            pen.svg.text([-x, below], &line, Anchor::Start, font);
        }
        below -= unit * 0.5;
    }
    let px_per_mm = 900.0 / (2.0 * (x + unit * 2.0));
    let (lower, upper) = ([-x - unit * 2.0, below - unit * 1.5], [x + unit * 2.0, y + unit * 5.0]);
    std::mem::take(&mut pen.svg).finish(lower, upper, px_per_mm, colors.paper, picture.name)
}

/// The corners of a leg as in retrieval: as wide as where μ falls to the threshold; `None` without a length.
fn trapezoid(leg: &Leg, limit: f64) -> Option<[At; 4]> {
    let (from, to) = (leg.from.map(f64::from), leg.to.map(f64::from));
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    let [foot, end] = [leg.r_min, leg.r_max].map(|radius| f64::from(radius) * limit.sqrt());
    let across = |[x, y]: At, radius: f64| [x - dy / length * radius, y + dx / length * radius];
    (length > 0.0).then(|| [across(from, foot), across(to, end), across(to, -end), across(from, -foot)])
}

/// The radii at which a scope's Gaussian has this exponent, mm.
fn ring(scope: Scope, exponent: f64) -> [f64; 2] {
    [f64::from(scope.x) * exponent.sqrt(), f64::from(scope.y) * exponent.sqrt()]
}

fn within([x, y]: At, center: At, radii: [f64; 2]) -> bool {
    ((x - center[0]) / radii[0]).powi(2) + ((y - center[1]) / radii[1]).powi(2) < 1.0
}

fn distance(from: At, to: At) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1])
}

fn at(point: PointMm) -> At {
    [f64::from(point.x), f64::from(point.y)]
}

/// Lower end of a similarity interval, and its letter (docs/case-format.md §3).
const INTERVALS: [(f64, &str); 3] = [(0.8, "H"), (0.6, "h"), (0.4, "l")];
/// Angles of the letters of the intervals around the ball, degrees, in order of preference.
const LETTER_RAYS: [i32; 16] = [-35, 35, -145, 145, 0, 180, -18, 18, -162, 162, -55, 55, -125, 125, -90, 90];
/// Positions of the number of a leg on it, as shares of its length.
const LEG_NUMBER_SHARES: [f64; 7] = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74];
const LEGEND: &str = "Circles: teammates, dashed where the case wants them. Squares: opponents, in their scopes. Orange: the ball and \
     its scope, rings at similarity 0.8 (H within), 0.6 (h), 0.4 (l) and its border (L). Trapezoids: legs of the ball, in order. Dashed arrows: \
     ways of robots, dotted with the ball.";

#[cfg(test)]
mod tests {
    use super::*;
    use casebase::LegKind;

    #[test]
    fn a_ring_is_the_scope_times_the_root_of_the_exponent() {
        // −ln 0.8 = 0.22314, its root 0.47238; −ln 0.367 = 1.00239, its root 1.00120.
        let scope = Scope { x: 450, y: 250 };
        for (similarity, wide, high) in [(0.8, 212.57, 118.10), (0.367, 450.54, 250.30)] {
            let [x, y] = ring(scope, -f64::ln(similarity));
            assert!((x - wide).abs() < 0.01 && (y - high).abs() < 0.01, "{similarity}: {x} {y}");
        }
    }

    #[test]
    fn a_trapezoid_is_as_wide_as_the_threshold_lets_it_be() {
        let robot = CaseRobot::new(0).unwrap();
        let kind = LegKind::Pass(robot);
        let leg =
            Leg { from: [0.0, 0.0], to: [1000.0, 0.0], r_min: 100.0, r_max: 350.0, robot, action: 1, kind };
        // 100 and 350 mm times 1.0012 are 100.12 and 350.42 mm.
        let wanted = [[0.0, 100.12], [1000.0, 350.42], [1000.0, -350.42], [0.0, -100.12]];
        let corners = trapezoid(&leg, 1.002_393).unwrap();
        for (corner, wanted) in corners.iter().zip(wanted) {
            assert!(
                (corner[0] - wanted[0]).abs() < 0.01 && (corner[1] - wanted[1]).abs() < 0.01,
                "{corner:?}"
            );
        }
        assert_eq!(trapezoid(&Leg { to: [0.0, 0.0], ..leg }, 1.0), None);
    }
}
