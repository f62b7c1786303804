//! Tests: scenes are the same for every thread, a pair starts alike, and equal teams play equally.

use protocol::{RobotId, Who};

use super::*;

fn plan(free_kicks: u32, open_play: u32, variants: &[&str]) -> ScenePlan {
    ScenePlan {
        league: League::DivisionB,
        world: WorldChoice::Nominal,
        seed: 3,
        free_kicks,
        open_play,
        team: MatchTeam::ours(),
        variants: variants.iter().map(|team| MatchTeam::parse(team).unwrap()).collect(),
        opponents: vec![Team::Zone.into()],
    }
}

#[test]
fn starts_of_open_play_and_free_kicks_follow_the_rules() {
    let plan = plan(15, 15, &[]);
    let starts = start::draw(&plan, Team::Zone.into()).unwrap();
    assert_eq!(starts.len(), 30);
    let (field, limits) = (plan.league.field(), plan.league.limits().unwrap());
    for (kind, _, start) in &starts {
        assert_eq!(start.robots.len(), 12);
        let keeper = Who { colour: US, id: RobotId::ZERO };
        let at = start.robots.iter().find(|(who, _)| *who == keeper).unwrap().1.position;
        assert!(at.x() > 3.0, "our keeper guards the positive end: {at:?}");
        let distance =
            |(_, pose): &&(Who, geometry::Pose<geometry::Field>)| pose.position.distance(start.ball);
        let nearest = start.robots.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        match kind {
            SceneKind::OpenPlay => assert_eq!(nearest.0.colour, US),
            SceneKind::FreeKick => {
                assert_eq!(rules::restart::free_kick_fault(&field, &limits, start.ball), None);
                // Blue defends the positive half.
                assert!(start.ball.x() < 0.0, "{start:?}");
            }
        }
    }
}

#[test]
fn every_match_of_starts_and_every_seed_has_moments_of_its_own() {
    let plan = plan(1, 1, &[]);
    let moment = |plan: &ScenePlan, number| {
        let moments = start::of_match(plan, Team::Idle.into(), number).unwrap();
        format!("{:?}", moments.first().unwrap())
    };
    let other = ScenePlan { seed: plan.seed + 100, ..plan.clone() };
    let moments = [moment(&plan, 0), moment(&plan, 1), moment(&other, 0)];
    assert!(moments[0] != moments[1] && moments[0] != moments[2] && moments[1] != moments[2], "{moments:#?}");
}

#[test]
fn a_team_beside_itself_differs_in_no_scene_on_any_number_of_threads() {
    let mut plan = plan(2, 2, &[]);
    plan.variants = vec![plan.team];
    let play = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| plan.play_all(&|| ())).unwrap()
    };
    let rows = play(1);
    let outcomes = |rows: &[SceneRow]| rows.iter().map(|row| row.outcome).collect::<Vec<_>>();
    assert_eq!(outcomes(&rows), outcomes(&play(2)));
    assert_eq!(rows.len(), 8);
    for pair in rows.chunks(2) {
        assert_eq!(pair[0].outcome, pair[1].outcome);
        assert!(pair[0].outcome.played);
    }
}

#[test]
fn the_planner_plays_free_kicks_where_it_is_on_and_none_where_it_is_off() {
    let mut plan = plan(12, 0, &["ours-with-coerce"]);
    plan.opponents = vec![Team::Reactive.into()];
    let rows = plan.play_all(&|| ()).unwrap();
    let planned = |team: MatchTeam| rows.iter().filter(|row| row.team == team && row.outcome.planned).count();
    assert_eq!(planned(plan.team), 0);
    assert!(planned(plan.variants[0]) > 0);
    let effects = scene_effects(&plan, &rows);
    assert_eq!(effects.len(), 2 * SceneMeasure::ALL.len(), "against one opponent and against all");
    assert!(effects.iter().all(|effect| effect.part == "coerce"));
}
