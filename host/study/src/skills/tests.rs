//! Tests: tries succeed and fail by what truly happens, and repeat exactly.

use hil_sim::small_size::worlds::WorldChoice;
use rules::League;

use crate::store::Experiment;

use super::{Skill, SkillPlan, rows};

fn plan(skills: &[Skill], tries: u32) -> SkillPlan {
    SkillPlan {
        league: League::DivisionB,
        world: "nominal".to_owned(),
        worlds: vec![WorldChoice::Nominal],
        tries,
        first: 0,
        seed: 1,
        skills: skills.to_vec(),
    }
}

#[test]
fn every_skill_has_a_name_that_leads_back_to_it() {
    for skill in Skill::ALL {
        assert_eq!(Skill::from_label(skill.label()), Some(skill));
    }
    assert_eq!(Skill::from_label("luck"), None);
}

#[test]
fn a_ball_in_the_open_is_placed_in_the_leagues_own_world_and_again_to_the_tick() {
    let plan = plan(&[Skill::Placement], 1);
    let first = plan.play_all(&|| ()).unwrap();
    let again = plan.play_all(&|| ()).unwrap();
    assert_eq!(first.len(), 1);
    let took = first[0].end.clone().unwrap();
    assert!((2.0..15.0).contains(&took), "{took}");
    assert_eq!(again[0].end, first[0].end);
    let row = &rows(&plan, &first)[0];
    assert_eq!((row.skill, row.worlds, row.tries, row.succeeded), ("placement", 1, 1, 1));
}

#[test]
fn a_try_is_repeated_by_its_number_and_starts_equally_in_every_world() {
    let whole = plan(&[Skill::GetBall], 3).play_all(&|| ()).unwrap();
    let alone = SkillPlan { first: 2, ..plan(&[Skill::GetBall], 1) }.play_all(&|| ()).unwrap();
    assert_eq!((&alone[0].start, &alone[0].end), (&whole[2].start, &whole[2].end));
    let random = SkillPlan { worlds: vec![WorldChoice::Random(3)], ..plan(&[Skill::GetBall], 1) };
    assert_eq!(random.play_all(&|| ()).unwrap()[0].start, whole[0].start);
    assert!(whole[2].tried.command().contains("--first 2 --tries 1"));
}
