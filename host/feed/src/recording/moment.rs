//! `moment`: the state of a recorded match at one moment. Tracker, referee and hosts at that time. SI, field
//! frame.

use geometry::{Field, Point};
use host::Host;
use host::referee::Game;
use host::world::World;
use rules::Colour;
use serde::Serialize;

use crate::decided::Decided;
use crate::spaced;

/// A moment, as text and as JSON.
#[derive(Debug, Serialize)]
pub struct Moment {
    at_s: f64,
    /// The event that it was requested by, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    event: Option<String>,
    phase: String,
    stage: String,
    score: Score,
    /// Place for the ball in a ball placement, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    placement: Option<[f32; 2]>,
    ball: Option<Ball>,
    blue: Vec<Robot>,
    yellow: Vec<Robot>,
}

/// Goals.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Score {
    /// Of team blue.
    pub blue: u32,
    /// Of team yellow.
    pub yellow: u32,
}

#[derive(Debug, Serialize)]
struct Ball {
    /// m.
    at: [f32; 2],
    /// Above the field surface, m.
    height: f32,
    /// m/s.
    velocity: [f32; 2],
    /// 0–1.
    confidence: f32,
}

#[derive(Debug, Serialize)]
struct Robot {
    id: u8,
    /// m.
    at: [f32; 2],
    heading_deg: f32,
    /// m/s.
    speed: f32,
    /// 0–1.
    confidence: f32,
    /// Decision of the host of its team, if the file has one.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    decided: Option<Decided>,
}

impl Robot {
    fn of(robot: &host::world::Robot, hosts: &[&Host]) -> Self {
        Self {
            id: robot.who.id.number(),
            at: metres(robot.pose.position),
            heading_deg: robot.pose.heading.radians().to_degrees(),
            speed: robot.velocity.norm(),
            confidence: robot.confidence,
            decided: Decided::of(hosts, robot.who),
        }
    }
}

impl Moment {
    /// The moment of `world` and `game`, with what `hosts` order their robots.
    pub fn new(at_s: f64, event: Option<String>, world: &World, game: &Game, hosts: &[&Host]) -> Self {
        Self {
            at_s,
            event,
            phase: game.phase.to_string(),
            stage: spaced(&format!("{:?}", game.stage)),
            score: Score { blue: game.team(Colour::Blue).score, yellow: game.team(Colour::Yellow).score },
            placement: game.placement.map(metres),
            ball: world.ball.as_ref().map(|ball| Ball {
                at: metres(ball.position),
                height: ball.height,
                velocity: [ball.velocity.x(), ball.velocity.y()],
                confidence: ball.confidence,
            }),
            blue: world.team(Colour::Blue).map(|robot| Robot::of(robot, hosts)).collect(),
            yellow: world.team(Colour::Yellow).map(|robot| Robot::of(robot, hosts)).collect(),
        }
    }

    /// A few lines of text.
    pub fn text(&self) -> String {
        let mut lines = vec![match &self.event {
            Some(event) => format!("{:.3} s: {event}", self.at_s),
            None => format!("{:.3} s", self.at_s),
        }];
        let Score { blue, yellow } = self.score;
        lines.push(format!("referee  {}, {}, blue {blue} : {yellow} yellow", self.phase, self.stage));
        if let Some([x, y]) = self.placement {
            lines.push(format!("         the ball is to be placed at ({x:.2}, {y:.2}) m"));
        }
        lines.push(match &self.ball {
            None => "ball     not seen".to_owned(),
            Some(ball) => {
                let ([x, y], [vx, vy]) = (ball.at, ball.velocity);
                format!(
                    "ball     ({x:.3}, {y:.3}) m, {:.3} m high, velocity ({vx:.2}, {vy:.2}) m/s, sure by {:.2}",
                    ball.height, ball.confidence
                )
            }
        });
        for (name, robots) in [("blue", &self.blue), ("yellow", &self.yellow)] {
            if robots.is_empty() {
                lines.push(format!("{name:<8} no robot is seen"));
            }
            for robot in robots {
                let [x, y] = robot.at;
                lines.push(format!(
                    "{:<8} ({x:.3}, {y:.3}) m, heading {:.0}°, {:.2} m/s",
                    format!("{name} {}", robot.id),
                    robot.heading_deg,
                    robot.speed
                ));
                if let Some(decided) = &robot.decided {
                    lines.push(format!("{:<8} {}", "", decided.text()));
                }
            }
        }
        lines.join("\n") + "\n"
    }
}

fn metres(point: Point<Field>) -> [f32; 2] {
    [point.x(), point.y()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_is_written_in_words() {
        assert_eq!(spaced("ExtraFirstHalfPre"), "extra first half pre");
    }
}
