//! `picture`: figure of a whole trial on one sheet. An SVG: field, tracks, the ball's path and its kickers,
//! kicks, gameplays, outcome.
//!
//! Attackers are circles and opponents squares, as in the paper's figures; hollow where they started, filled
//! where they ended. The ball's path is thick where it was carried and dotted where it rolled, in the colour
//! of the robot that carried or last kicked it. Numbers stand where the ball was when a gameplay started; the
//! list below names them. Colours are Okabe and Ito's, distinguishable with colour blindness.

mod legend;
mod page;

use geometry::{Field, Point, Pose};
use hil_sim::{Configuration, OpponentRole, Scenario};
use rules::League;

use crate::names::letter;
use crate::recording::{RecordedSample, Recording, Start};
use crate::report::TrialReport;
use figures::{Anchor, Font};

use page::{Page, Px, SCALE, bold, font};

/// The figure of a trial that has ended; an empty field for an empty recording.
pub fn picture(recording: &Recording) -> String {
    let mut page = Page::new(Px::new(WIDTH * 0.5, HEADER + HALF_HEIGHT));
    let starts = displayed_starts(recording);
    let Some((first, last)) = recording.samples.first().zip(recording.samples.last()) else {
        return page.finish(WIDTH, HEADER + 2.0 * HALF_HEIGHT, "a trial");
    };
    let attackers = recording.cast.attackers.len();
    for robot in 0..first.robots.len() {
        track(&mut page, recording, robot);
    }
    ball_path(&mut page, recording);
    let mut taken = Vec::new();
    for (robot, (start, end)) in first.robots.iter().zip(&last.robots).enumerate() {
        let actor = Actor { robot, attackers, recording };
        taken.extend([page.place(start.position), page.place(end.position)]);
        actor.draw(&mut page, start, false);
        actor.draw(&mut page, end, true);
    }
    ball(&mut page, first.ball, false);
    ball(&mut page, last.ball, true);
    taken.extend([page.place(first.ball), page.place(last.ball)]);
    seconds(&mut page, &recording.samples, &mut taken);
    for (number, start) in starts.iter().enumerate() {
        let at = page.place(start.ball);
        badge(&mut page, number + 1, at, &mut taken);
    }
    let bottom = HEADER + 2.0 * HALF_HEIGHT;
    let height = legend::draw(&mut page, recording, &starts, WIDTH, bottom);
    let title = recording.report.as_ref().map_or_else(|| "a trial".to_owned(), title);
    if let Some(report) = &recording.report {
        header(&mut page, report);
    }
    page.finish(WIDTH, height, &title)
}

/// The gameplays that lasted long enough to be visible.
fn displayed_starts(recording: &Recording) -> Vec<&Start> {
    let lived = |start: &&Start| {
        let cycles = recording.report.as_ref().map(|report| &report.cycles);
        cycles.and_then(|cycles| cycles.get(start.cycle)).is_none_or(|c| c.end_s - c.start_s >= SHORTEST)
    };
    recording.starts.iter().filter(lived).collect()
}

fn title(report: &TrialReport) -> String {
    match report.scenario {
        Scenario::Random => "A random scenario".to_owned(),
        scenario => format!("Scenario {scenario}: {}", scenario.title()),
    }
}

fn header(page: &mut Page, report: &TrialReport) {
    let opponents = match report.opponents {
        Configuration::DefenderGoalie => "a defender and a goalie",
        Configuration::TwoDefenders => "two defenders",
    };
    let approach = if report.approach == "cbr" { "Case-based" } else { "Reactive" };
    let below =
        format!("{approach} attackers, playing to the right, against {opponents} · seed {}", report.seed);
    let outcome = format!("{} after {:.1} s", report.outcome.label(), report.time_s);
    let (left, right) = (SIDE, WIDTH - SIDE);
    page.text(Px::new(left, 34.0), &title(report), Anchor::Start, bold(21.0, INK));
    page.text(Px::new(left, 56.0), &below, Anchor::Start, font(14.0, FAINT));
    page.text(Px::new(right, 34.0), &outcome, Anchor::End, bold(21.0, INK));
    if let Some(by) = report.out_by {
        let by = format!("last touched by the {by}");
        page.text(Px::new(right, 56.0), &by, Anchor::End, font(14.0, FAINT));
    }
}

fn track(page: &mut Page, recording: &Recording, robot: usize) {
    let places =
        recording.samples.iter().filter_map(|sample| sample.robots.get(robot)).map(|pose| pose.position);
    let points = thinned(page, places);
    let color = color(robot, recording.cast.attackers.len());
    let style = format!(r#"stroke="{color}" stroke-width="2" stroke-opacity="0.45" stroke-linejoin="round""#);
    page.path(&points, &style);
}

/// The ball's path in stretches of one carrier or one kicker each.
fn ball_path(page: &mut Page, recording: &Recording) {
    let attackers = recording.cast.attackers.len();
    let mut kicks = recording.kicks.iter().peekable();
    let mut sender = None;
    let mut stretches: Vec<(Control, Vec<Point<Field>>)> = Vec::new();
    for sample in &recording.samples {
        let mut kicked_from = None;
        while let Some(kick) = kicks.next_if(|kick| kick.time <= sample.time) {
            (sender, kicked_from) = (Some(kick.robot), Some(kick.from));
        }
        let control = sample.holder.map_or(Control::Rolls(sender), Control::Carried);
        match stretches.last_mut() {
            Some((now, points)) if *now == control && kicked_from.is_none() => points.push(sample.ball),
            before => {
                let joint = kicked_from.or(before.and_then(|(_, points)| points.last().copied()));
                stretches.push((control, joint.into_iter().chain([sample.ball]).collect()));
            }
        }
    }
    for (control, places) in &stretches {
        let points = thinned(page, places.iter().copied());
        match *control {
            Control::Carried(robot) => {
                let color = color(robot, attackers);
                let style = format!(
                    r#"stroke="{color}" stroke-width="6" stroke-linecap="round" stroke-linejoin="round""#
                );
                page.path(&points, &style);
            }
            Control::Rolls(sender) => {
                let color = sender.map_or(INK, |robot| color(robot, attackers));
                let style = format!(
                    r#"stroke="{color}" stroke-width="4.5" stroke-linecap="round" stroke-dasharray="0.1 9" stroke-linejoin="round""#
                );
                page.path(&points, &style);
                arrow_on(page, &points, color);
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Control {
    Carried(usize),
    /// After this robot's kick, if there was one yet.
    Rolls(Option<usize>),
}

/// An arrowhead at the middle of a path that is long enough for one.
fn arrow_on(page: &mut Page, points: &[Px], color: &str) {
    let length: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if length < SHORTEST_ARROW {
        return;
    }
    let mut gone = 0.0;
    for pair in points.windows(2) {
        gone += pair[0].distance(pair[1]);
        if gone >= length * 0.5 {
            return page.arrowhead(pair[1], (pair[1].x - pair[0].x, pair[1].y - pair[0].y), 15.0, color);
        }
    }
}

struct Actor<'a> {
    robot: usize,
    attackers: usize,
    recording: &'a Recording,
}

impl Actor<'_> {
    fn draw(&self, page: &mut Page, pose: &Pose<Field>, filled: bool) {
        let at = page.place(pose.position);
        let color = color(self.robot, self.attackers);
        let radius = League::FourLegged.robot().radius * SCALE;
        let (fill, ink) = if filled { (color, "white") } else { ("white", color) };
        let style = format!(r#"fill="{fill}" stroke="{color}" stroke-width="2.5""#);
        let (sin, cos) = pose.heading.sin_cos();
        let nose = at.moved(cos * (radius + 8.0), -sin * (radius + 8.0));
        page.line(at, nose, &format!(r#"stroke="{color}" stroke-width="4" stroke-linecap="round""#));
        if self.robot < self.attackers {
            page.circle(at, radius, &style);
        } else {
            let half = radius * 0.9;
            page.rect(at.moved(-half, -half), 2.0 * half, 2.0 * half, &format!(r#"{style} rx="3""#));
        }
        page.text(at.moved(0.0, 6.0), &self.letter(), Anchor::Middle, bold(17.0, ink));
    }

    fn letter(&self) -> String {
        let role = self.robot.checked_sub(self.attackers).and_then(|i| self.recording.cast.opponents.get(i));
        match role {
            None => letter(self.robot).to_string(),
            Some(OpponentRole::Defender) => "D".to_owned(),
            Some(OpponentRole::Midfield) => "M".to_owned(),
            Some(OpponentRole::Goalie) => "G".to_owned(),
        }
    }
}

fn ball(page: &mut Page, at: Point<Field>, filled: bool) {
    let fill = if filled { BALL } else { "white" };
    let style = format!(r#"fill="{fill}" stroke="{INK}" stroke-width="2""#);
    let at = page.place(at);
    page.circle(at, League::FourLegged.ball().radius * SCALE, &style);
}

/// Small time labels along the ball's path, where the ball has moved since the last.
fn seconds(page: &mut Page, samples: &[RecordedSample], taken: &mut Vec<Px>) {
    let mut last: Option<Px> = None;
    let mut next = EVERY;
    for sample in samples {
        if sample.time < next {
            continue;
        }
        let at = page.place(sample.ball);
        if last.is_none_or(|last| last.distance(at) > 40.0) {
            let spot = free_spot(at, 22.0, taken);
            let letters = Font { halo: Some(SURFACE), ..font(12.0, INK) };
            page.circle(at, 2.6, &format!(r#"fill="{INK}""#));
            page.text(spot.moved(0.0, 4.0), &format!("{next:.0} s"), Anchor::Middle, letters);
            taken.push(spot);
            last = Some(at);
        }
        next += EVERY;
    }
}

/// A numbered disc near `at`, connected to it.
fn badge(page: &mut Page, number: usize, at: Px, taken: &mut Vec<Px>) {
    let spot = free_spot(at, 34.0, taken);
    page.line(at, spot, &format!(r#"stroke="{INK}" stroke-width="1""#));
    legend::number(page, spot, number);
    taken.push(spot);
}

/// A spot at distance `away` from `at`, or farther, clear of everything taken; upwards first.
fn free_spot(at: Px, away: f32, taken: &[Px]) -> Px {
    let mut best = (f32::MIN, at);
    for ring in 0..3 {
        let radius = away + 16.0 * ring as f32;
        for (dx, dy) in DIRECTIONS {
            let spot = at.moved(dx * radius, dy * radius);
            let clear = taken.iter().map(|other| other.distance(spot)).fold(CLEAR, f32::min);
            if clear >= CLEAR {
                return spot;
            }
            if clear > best.0 {
                best = (clear, spot);
            }
        }
    }
    best.1
}

/// Places with at least two centimetres between them, the last one always kept.
fn thinned(page: &Page, places: impl Iterator<Item = Point<Field>>) -> Vec<Px> {
    let mut points: Vec<Px> = Vec::new();
    let mut skipped = None;
    for place in places {
        let point = page.place(place);
        skipped = points.last().is_some_and(|last| last.distance(point) < 0.02 * SCALE).then_some(point);
        if skipped.is_none() {
            points.push(point);
        }
    }
    points.extend(skipped);
    points
}

/// A robot's colour: each attacker has its own, the opponents' are grey.
fn color(robot: usize, attackers: usize) -> &'static str {
    match robot.checked_sub(attackers) {
        None => ATTACKERS[robot % ATTACKERS.len()],
        Some(i) => OPPONENTS[i % OPPONENTS.len()],
    }
}

/// Blue, vermilion, bluish green, reddish purple (Okabe and Ito).
const ATTACKERS: [&str; 4] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"];
const OPPONENTS: [&str; 2] = ["#5f6368", "#303336"];
const INK: &str = "#202124";
const FAINT: &str = "#5f6368";
/// Colour of the field, behind labels on it.
const SURFACE: &str = "#e3eedd";
/// Orange (Okabe and Ito), as the league's ball.
const BALL: &str = "#E69F00";
/// Width of the figure, px.
const WIDTH: f32 = 1000.0;
/// White margin to the left and right, px.
const SIDE: f32 = 18.0;
/// Height of the title, px.
const HEADER: f32 = 72.0;
/// Half the height of the drawn part of the field, px.
const HALF_HEIGHT: f32 = 2.06 * SCALE;
/// Seconds between times along the ball's path.
const EVERY: f32 = 5.0;
/// A gameplay superseded sooner than this leaves no visible path, s.
const SHORTEST: f64 = 0.1;
/// Least path length for an arrowhead, px.
const SHORTEST_ARROW: f32 = 40.0;
/// Distance that keeps labels from touching, px.
const CLEAR: f32 = 30.0;
/// Directions of labels, the best first: up, then around.
const DIRECTIONS: [(f32, f32); 8] = [
    (0.0, -1.0),
    (0.71, -0.71),
    (-0.71, -0.71),
    (0.0, 1.0),
    (0.71, 0.71),
    (-0.71, 0.71),
    (1.0, 0.0),
    (-1.0, 0.0),
];

#[cfg(test)]
mod tests;
