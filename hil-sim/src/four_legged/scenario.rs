//! `scenario`: start positions of a trial. The paper's four scenarios as data files (§5.1.3, docs/papers.md
//! R31), and random ones.
//!
//! The paper gives no coordinates: `hil-sim/data/scenarios/*.toml` note which numbers were estimated from its
//! text and figures.

use std::fmt;
use std::sync::LazyLock;

use geometry::{Angle, Field, Point, Pose};
use rules::League;
use serde::Deserialize;

use crate::four_legged::opponents::{Conduct, OpponentRole};
use crate::four_legged::parameters::Parameters;
use crate::four_legged::referee::Configuration;
use crate::rng::Stream;

geometry::labels! {
    /// A scenario, by the paper's number or `random`.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Scenario {
        /// 1: ball and attackers in the middle-back.
        #[default]
        MiddleBack = "1",
        /// 2: ball and attackers on the left side.
        LeftSide = "2",
        /// 3: middle-front, a defender ahead but farther than 40 cm.
        DefenderAhead = "3",
        /// 4: middle-front, a defender within 40 cm.
        DefenderClose = "4",
        /// Drawn from the trial's seed.
        Random = "random",
    }
}

/// Positions of ball and robots at kick-off.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Position of the resting ball, m.
    pub ball: Point<Field>,
    /// The robots controlled by brains: A, B, and the others of the team.
    pub attackers: Vec<Pose<Field>>,
    /// The scripted opponents with their conduct.
    pub opponents: Vec<Placed>,
}

/// A scripted opponent at kick-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Role of the opponent.
    pub role: OpponentRole,
    /// Conduct in the trial.
    pub conduct: Conduct,
    /// Position and heading at kick-off.
    pub pose: Pose<Field>,
}

impl Placed {
    /// An opponent that plays from its home region, facing the ball.
    pub fn at_home(role: OpponentRole, position: Point<Field>, ball: Point<Field>) -> Self {
        let pose = Pose { position, heading: position.direction_to(ball) };
        Self { role, conduct: Conduct::AtHome, pose }
    }
}

impl Scenario {
    /// The paper's four scenarios, in its order.
    pub const PAPER: [Self; 4] = [Self::MiddleBack, Self::LeftSide, Self::DefenderAhead, Self::DefenderClose];

    /// Title of the scenario, a few words in lower case.
    pub fn title(self) -> &'static str {
        self.file().map_or("random", |file| &file.title)
    }

    /// The start positions; `seed` is used by [`Scenario::Random`] alone.
    pub fn layout(self, configuration: Configuration, parameters: &Parameters, seed: u64) -> Layout {
        let Some(file) = self.file() else { return random(configuration, parameters, seed) };
        let ball = in_metres(file.ball);
        let opponents = match configuration {
            Configuration::DefenderGoalie => &file.opponents.dg,
            Configuration::TwoDefenders => &file.opponents.two,
        };
        let heading = |place: &PlaceFile| Angle::degrees(place.heading_deg as f32);
        Layout {
            ball,
            attackers: (file.attackers.iter())
                .map(|a| Pose { position: in_metres(a.at), heading: heading(a) })
                .collect(),
            opponents: opponents.iter().map(|o| Placed::at_home(o.role, in_metres(o.at), ball)).collect(),
        }
    }

    fn file(self) -> Option<&'static ScenarioFile> {
        let index = Self::PAPER.iter().position(|&scenario| scenario == self)?;
        FILES.get(index)
    }
}

impl fmt::Display for Scenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label())
    }
}

/// The ball anywhere between the own third and the defenders' line, A behind it, the others around, the
/// opponents at home.
fn random(configuration: Configuration, parameters: &Parameters, seed: u64) -> Layout {
    let mut chance = Stream::new(seed, "scenario");
    let ball = Point::new(chance.between(-2.0, 1.2), chance.between(-1.4, 1.4));
    let mut taken = vec![ball];
    let field = League::FourLegged.field();
    let (x, y) = (ball.x(), ball.y());
    let mut attackers = vec![place(&mut chance, &mut taken, [x - 0.7, x - 0.3], [y - 0.3, y + 0.3])];
    for _ in 1..TEAM {
        attackers.push(place(&mut chance, &mut taken, [x - 1.2, x + 0.6], [y - 1.2, y + 1.2]));
    }
    let roles = match configuration {
        Configuration::DefenderGoalie => [OpponentRole::Defender, OpponentRole::Goalie],
        Configuration::TwoDefenders => [OpponentRole::Midfield, OpponentRole::Defender],
    };
    let opponents = roles.map(|role| {
        let home = role.home(parameters);
        Placed::at_home(role, place(&mut chance, &mut taken, home.x, home.y), ball)
    });
    let attackers =
        attackers.into_iter().map(|at| Pose { position: field.clamp(at, 0.0), heading: Angle::ZERO });
    Layout { ball, attackers: attackers.collect(), opponents: opponents.to_vec() }
}

/// Draws a position of that rectangle which is clear of those taken, and takes it.
fn place(chance: &mut Stream, taken: &mut Vec<Point<Field>>, x: [f32; 2], y: [f32; 2]) -> Point<Field> {
    for _ in 0..PLACING_ATTEMPTS {
        let at = Point::new(chance.between(x[0], x[1]), chance.between(y[0], y[1]));
        if taken.iter().all(|other| other.distance(at) >= PLACED_APART_MIN) {
            taken.push(at);
            return at;
        }
    }
    // Never in a region of a square metre with seven others on the field; overlapping robots are pushed apart
    // at once.
    Point::new(x[0], y[0])
}

fn in_metres([x, y]: [i16; 2]) -> Point<Field> {
    // Divided, not multiplied: 650 mm must give exactly the 0.65 m of a region's border.
    Point::new(f32::from(x) / 1000.0, f32::from(y) / 1000.0)
}

/// Content of `hil-sim/data/scenarios/*.toml`; mm, degrees.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioFile {
    title: String,
    ball: [i16; 2],
    attackers: [PlaceFile; TEAM],
    opponents: OpponentsFile,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlaceFile {
    at: [i16; 2],
    heading_deg: i16,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OpponentsFile {
    dg: [OpponentFile; 2],
    #[serde(rename = "2d")]
    two: [OpponentFile; 2],
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OpponentFile {
    role: OpponentRole,
    at: [i16; 2],
}

/// Maximum number of attackers of a scenario: a four-legged team.
pub const TEAM: usize = protocol::team::CASE_ROBOTS_MAX;
/// Minimum distance between any two things placed at random, m: two robots' radii and a margin.
const PLACED_APART_MIN: f32 = 0.35;
/// Maximum number of draws for a random position.
const PLACING_ATTEMPTS: usize = 100;

/// The scenarios' files, part of the program.
pub(crate) const SCENARIO_FILES: [&str; 4] = [
    include_str!("../../data/scenarios/1.toml"),
    include_str!("../../data/scenarios/2.toml"),
    include_str!("../../data/scenarios/3.toml"),
    include_str!("../../data/scenarios/4.toml"),
];

static FILES: LazyLock<[ScenarioFile; 4]> = LazyLock::new(|| {
    SCENARIO_FILES.map(|text| toml::from_str(text).expect("the built-in scenarios are read by a test"))
});

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Configuration; 2] = [Configuration::DefenderGoalie, Configuration::TwoDefenders];

    fn layouts() -> Vec<(Scenario, Configuration, Layout)> {
        let p = Parameters::four_legged();
        let random = (0..50).map(|seed| (Scenario::Random, seed));
        let all = Scenario::PAPER.into_iter().map(|scenario| (scenario, 0)).chain(random);
        all.flat_map(|(s, seed)| BOTH.map(|c| (s, c, s.layout(c, p, seed)))).collect()
    }

    #[test]
    fn start_positions_are_on_the_field_at_home_and_apart() {
        let (field, p) = (League::FourLegged.field(), Parameters::four_legged());
        for (scenario, configuration, layout) in layouts() {
            let robots = layout.attackers.iter().chain(layout.opponents.iter().map(|placed| &placed.pose));
            let places: Vec<_> = robots.map(|pose| pose.position).chain([layout.ball]).collect();
            for (i, a) in places.iter().enumerate() {
                assert!(field.contains(*a), "{scenario} {configuration:?}");
                for b in &places[..i] {
                    assert!(a.distance(*b) > 0.24, "{scenario} {configuration:?}: {a:?} and {b:?}");
                }
            }
            for Placed { role, pose, .. } in &layout.opponents {
                assert!(role.home(p).contains(pose.position), "{scenario} {role:?}");
            }
        }
    }

    #[test]
    fn the_defender_is_beyond_40_cm_in_scenario_3_and_within_in_4() {
        for configuration in BOTH {
            let ahead = |scenario: Scenario| {
                let layout = scenario.layout(configuration, Parameters::four_legged(), 0);
                layout.opponents[0].pose.position - layout.ball
            };
            assert!(ahead(Scenario::DefenderAhead).norm() > 0.4);
            assert!(ahead(Scenario::DefenderClose).norm() < 0.4);
            assert!(ahead(Scenario::DefenderClose).x() > 0.0 && ahead(Scenario::DefenderAhead).x() > 0.0);
        }
    }

    #[test]
    fn a_seed_determines_a_random_scenario() {
        let p = Parameters::four_legged();
        let draw = |seed| Scenario::Random.layout(Configuration::DefenderGoalie, p, seed);
        assert_eq!(draw(3), draw(3));
        assert_ne!(draw(3), draw(4));
        assert_eq!(Scenario::from_label("random"), Some(Scenario::Random));
        assert_eq!(Scenario::from_label("5"), None);
        assert_eq!(Scenario::LeftSide.title(), "left side");
    }
}
