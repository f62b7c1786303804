//! `problem`: export of a moment as a problem line, for `onetwo cases retrieve` and `explain` and for the
//! workbench, which drafts a case for it. mm, field frame (docs/case-format.md §5.1).

use std::collections::BTreeMap;

use serde::Serialize;

use crate::request::PageTeam;
use crate::scene::{Scene, SceneRobot};

/// Most robots of a team in a problem.
const PROBLEM_ROBOTS_MAX: usize = 11;

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
}
