//! `problem`: export of a moment. As a problem line for `onetwo cases retrieve` and `explain`, or as the
//! draft of a case file. mm, field frame (docs/case-format.md §1, §5.1).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::request::PageTeam;
use crate::scene::{Scene, SceneRobot};

/// Format of the export.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Freeze {
    /// One line of JSON.
    Problem,
    /// A case file to be finished by its author.
    Case,
}

/// Most robots of a team in a case file (docs/case-format.md §1).
const CASE_ROBOTS_MAX: usize = 4;
/// Most robots of a team in a problem.
const PROBLEM_ROBOTS_MAX: usize = 11;
/// The ball's initial scope, mm: as in the example of docs/case-format.md §1.
const BALL_SCOPE: &str = "[450, 250]";
/// An opponent's initial scope, mm.
const OPPONENT_SCOPE: &str = "[300, 300]";

#[derive(Serialize)]
struct Problem {
    ball: [i32; 2],
    defending: &'static str,
    teammates: BTreeMap<u8, [i32; 2]>,
    opponents: Vec<[i32; 2]>,
    /// Field players that cannot be given a part now: their host leads them elsewhere, or they are silent.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    unavailable: BTreeMap<u8, [i32; 2]>,
}

/// The moment as that team's problem; `None` without a ball. Its keeper is left out: it plays no cases;
/// robots that are not available are named apart.
pub fn problem(scene: &Scene, team: PageTeam) -> Option<String> {
    let ball = scene.ball.as_ref()?;
    let listed = |robot: &SceneRobot| (robot.id, mm(robot.at));
    let (teammates, unavailable): (Vec<_>, Vec<_>) = field_players(scene, team).partition(|robot| {
        // Where nothing is known of a team but positions, all of it may play.
        robot.detail.as_ref().is_none_or(|detail| detail.available)
    });
    let opponents = scene.robots.iter().filter(|robot| robot.team != team).take(PROBLEM_ROBOTS_MAX);
    let problem = Problem {
        ball: mm(ball.at),
        defending: defending(scene, team),
        teammates: teammates.into_iter().take(PROBLEM_ROBOTS_MAX).map(listed).collect(),
        opponents: opponents.map(|robot| mm(robot.at)).collect(),
        unavailable: unavailable.into_iter().map(listed).collect(),
    };
    serde_json::to_string(&problem).ok()
}

/// The moment as a case file of that team: the robots nearest to the ball; the first of them gets it and
/// passes to the second.
pub fn skeleton(scene: &Scene, team: PageTeam) -> Option<String> {
    let ball = scene.ball.as_ref()?;
    let far = |robot: &SceneRobot| {
        let (x, y) = (robot.at[0] - ball.at[0], robot.at[1] - ball.at[1]);
        x * x + y * y
    };
    let nearest = |mut robots: Vec<SceneRobot>| {
        robots.sort_by(|a, b| far(a).total_cmp(&far(b)).then(a.id.cmp(&b.id)));
        robots.truncate(CASE_ROBOTS_MAX);
        robots
    };
    let teammates = nearest(field_players(scene, team).cloned().collect());
    let opponents = nearest(scene.robots.iter().filter(|robot| robot.team != team).cloned().collect());
    if teammates.is_empty() {
        return None;
    }
    let place = |at: [f32; 2]| {
        let [x, y] = mm(inside(scene, at));
        format!("[{x}, {y}]")
    };
    let mut out = format!(
        "intent = \"A moment at {:.2} s: say what these robots shall do with it.\"\ndefending = \"{}\"\nball = {{ at = {}, scope = {BALL_SCOPE} }}\n",
        scene.t,
        defending(scene, team),
        place(ball.at)
    );
    for (i, robot) in teammates.iter().enumerate() {
        let plan = match (i, teammates.len()) {
            (0, 1) => "\"get_ball\"",
            (0, _) => "\"get_ball\", { pass_ball = 2 }",
            (1, _) => "\"wait\", { receive_ball = 1 }",
            _ => "\"wait\"",
        };
        let _ = write!(
            out,
            "\n[[teammates]] # robot {} of {}\nat = {}\ngameplay = [{plan}]\n",
            robot.id,
            label(team),
            place(robot.at)
        );
    }
    for robot in &opponents {
        let _ = write!(out, "\n[[opponents]]\nat = {}\nscope = {OPPONENT_SCOPE}\n", place(robot.at));
    }
    Some(out)
}

fn field_players(scene: &Scene, team: PageTeam) -> impl Iterator<Item = &SceneRobot> {
    let keeper = scene.game.teams.of(team).keeper;
    scene.robots.iter().filter(move |robot| robot.team == team && Some(robot.id) != keeper)
}

/// The paper's names: yellow is the goal at −x.
fn defending(scene: &Scene, team: PageTeam) -> &'static str {
    match scene.game.teams.of(team).defends {
        0 if team == PageTeam::Blue => "cyan",
        1 => "cyan",
        _ => "yellow",
    }
}

fn label(team: PageTeam) -> &'static str {
    match team {
        PageTeam::Blue => "blue",
        PageTeam::Yellow => "yellow",
    }
}

fn inside(scene: &Scene, [x, y]: [f32; 2]) -> [f32; 2] {
    let (half, side) = (scene.field.length / 2.0, scene.field.width / 2.0);
    [x.clamp(-half, half), y.clamp(-side, side)]
}

fn mm(at: [f32; 2]) -> [i32; 2] {
    at.map(|x| (x * 1000.0).round() as i32)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::scene::{Field, SceneBall};

    /// Three of each team, robot 0 their keepers, blue defends +x.
    pub(crate) fn scene() -> Scene {
        let mut scene = Scene {
            t: 12.5,
            field: Field { length: 9.0, width: 6.0, ..Field::default() },
            ball: Some(SceneBall { at: [0.5, -0.25], ..SceneBall::default() }),
            ..Scene::default()
        };
        for (team, sign) in [(PageTeam::Blue, 1.0), (PageTeam::Yellow, -1.0)] {
            *scene.game.teams.of_mut(team) =
                crate::TeamSheet { keeper: Some(0), defends: sign as i8, ..crate::TeamSheet::default() };
            for (id, x) in [(0, 4.4), (3, 1.0), (5, 0.5)] {
                scene.robots.push(SceneRobot {
                    team,
                    id,
                    at: [x * sign, 0.1 * f32::from(id)],
                    heading: 0.0,
                    velocity: [0.0; 2],
                    confidence: 1.0,
                    detail: None,
                    vitals: None,
                });
            }
        }
        scene
    }

    #[test]
    fn a_moment_becomes_the_problem_of_a_team_in_mm_without_its_keeper() {
        assert_eq!(
            problem(&scene(), PageTeam::Blue).unwrap(),
            r#"{"ball":[500,-250],"defending":"cyan","teammates":{"3":[1000,300],"5":[500,500]},"opponents":[[-4400,0],[-1000,300],[-500,500]]}"#
        );
        let no_ball = Scene { ball: None, ..scene() };
        assert_eq!(problem(&no_ball, PageTeam::Blue), None);
    }

    #[test]
    fn a_robot_that_is_not_available_is_named_apart() {
        let mut scene = scene();
        let detail = |available| Some(crate::RobotDetail { available, ..crate::RobotDetail::default() });
        (scene.robots[1].detail, scene.robots[2].detail) = (detail(true), detail(false));
        let line = problem(&scene, PageTeam::Blue).unwrap();
        assert!(line.contains(r#""teammates":{"3":[1000,300]},"#), "{line}");
        assert!(line.ends_with(r#""unavailable":{"5":[500,500]}}"#), "{line}");
    }

    #[test]
    fn a_skeleton_has_the_nearest_robots_and_one_that_gets_the_ball() {
        let text = skeleton(&scene(), PageTeam::Yellow).unwrap();
        assert_eq!(text.matches("get_ball").count(), 1);
        assert_eq!((text.matches("[[teammates]]").count(), text.matches("[[opponents]]").count()), (2, 3));
        assert!(text.contains("defending = \"yellow\"\nball = { at = [500, -250]"), "{text}");
        let first = text.split("[[teammates]]").nth(1).unwrap();
        assert!(first.starts_with(" # robot 5 of yellow\nat = [-500, 500]"), "{text}");
    }
}
