//! `beside`: a second trace on the page, in step with the first: a layer with its robots and ball, and an
//! event where the two differ first.

use std::path::Path;

use arena::game::TICK_US;
use geometry::{Field, Point};
use page::{Layer, MatchEvent, Shape, Tone, milli};
use protocol::Instant;
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

use super::compare::{PlaySettings, Playing, compare};
use super::failure::RecordingFailure;
use super::unlike::Unlike;

/// Least distance of a robot's places in the two traces that are joined by a line, m: the width of a line.
const JOINED_FROM_M: f32 = 0.02;

/// The second trace, played as far as the first.
pub struct Beside<'a> {
    playing: Playing<'a>,
    /// The first difference, until it was reported.
    first: Option<MatchEvent>,
}

impl<'a> Beside<'a> {
    /// Compares both traces as a whole for their first difference, then begins to play the second.
    pub fn open(file: &Path, other: &'a Path, with: PlaySettings<'_>) -> Result<Self, RecordingFailure> {
        let report = compare([file, other], with)?;
        let first = report.first().map(|Unlike { at_s, what, of, a, b, .. }| {
            let label = what.label();
            MatchEvent::fault(*at_s, format!("the traces differ first here: {label}: {of}; A: {a}; B: {b}"))
        });
        Ok(Self { playing: Playing::open(other, with)?, first })
    }

    /// The first difference in words, for the terminal.
    pub fn first_difference(&self) -> String {
        let found = self.first.as_ref();
        found.map_or_else(
            || "the traces are equal".to_owned(),
            |event| format!("{:.2} s: {}", event.t, event.description),
        )
    }

    /// Plays on to `now`; the event of the first difference once it is reached.
    pub fn play(&mut self, now: Instant) -> Option<MatchEvent> {
        self.playing.play(now.0 / TICK_US);
        self.first.take_if(|event| event.t <= now.0 as f64 * 1e-6)
    }

    /// Ball and robots of the second trace at `now`, joined with those of `world`.
    pub fn layer(&self, now: Instant, world: &host::world::World) -> Layer {
        let name =
            self.playing.file().file_name().map_or_else(Default::default, |name| name.to_string_lossy());
        let mut layer = Layer {
            name: "other-trace".to_owned(),
            label: format!("B: {}", foreign::printable(&name)),
            on: true,
            shapes: Vec::new(),
        };
        let Some(host) = self.playing.recheck.host(0) else { return layer };
        let other = host.tracker().world(now);
        let mut add =
            |at: Point<Field>, with: Option<Point<Field>>, radius: f32, tone: Tone, note: String| {
                let place = |point: Point<Field>| [milli(point.x()), milli(point.y())];
                let radii = [radius, radius];
                layer.shapes.push(Shape::Ellipse { at: place(at), radii, tone, fill: false, note });
                if let Some(with) = with.filter(|with| with.distance(at) > JOINED_FROM_M) {
                    let points = vec![place(with), place(at)];
                    layer.shapes.push(Shape::Line { points, tone, arrow: true, dashed: true });
                }
            };
        for robot in other.robots() {
            let tone = robot.who.colour.pick(Tone::Yellow, Tone::Blue);
            let with = world.robot(robot.who).map(|robot| robot.pose.position);
            let note = format!("{} {} of trace B", robot.who.colour.label(), robot.who.id.number());
            add(robot.pose.position, with, ROBOT_RADIUS, tone, note);
        }
        if let Some(ball) = &other.ball {
            let with = world.ball.as_ref().map(|ball| ball.position);
            // Larger than the ball: it is seen around it.
            add(ball.position, with, 2.0 * BALL_RADIUS, Tone::Ball, "the ball of trace B".to_owned());
        }
        layer
    }
}
