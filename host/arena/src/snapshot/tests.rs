//! `tests`: tests: a snapshot gives back what it was taken of, and a file that is none is refused.

use casebase::CaseBase;
use hil_sim::NativeBackend;

use super::*;
use crate::game::{Game, GameConfig, NoWatcher};

const LEAGUE: League = League::DivisionB;

#[test]
fn ball_and_robots_return_to_the_moment_with_their_motion_and_through_a_file() {
    let config = GameConfig::new(LEAGUE, 3, 60.0);
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = Game::new(&config, &mut backend).unwrap();
    let moves = |game: &Game<'_>| game.world().robots().iter().any(|robot| robot.velocity.norm() > 0.5);
    while !moves(&game) {
        game.step(&mut NoWatcher).unwrap();
    }
    let taken = Snapshot::of(game.world(), LEAGUE);
    assert_eq!(taken.robots.len(), 12);
    for _ in 0..300 {
        game.step(&mut NoWatcher).unwrap();
    }
    assert_ne!(Snapshot::of(game.world(), LEAGUE).robots, taken.robots);
    let json = serde_json::to_string(&taken).unwrap();
    let read = Snapshot::from_json(&json, LEAGUE).unwrap();
    assert_eq!(read, taken);
    game.restore(&read);
    let now = Snapshot::of(game.world(), LEAGUE);
    assert_eq!((now.ball, &now.robots), (taken.ball, &taken.robots));
    assert!(now.t > taken.t + 2.9, "the clock goes on");
    // Who is off the field stays off it.
    let gone = Who { colour: Colour::Blue, id: RobotId::new(4).unwrap() };
    game.world_mut().remove(gone);
    game.restore(&read);
    assert_eq!(Snapshot::of(game.world(), LEAGUE).robots.len(), 11);
}

#[test]
fn a_file_that_is_no_snapshot_of_this_league_is_refused_with_the_reason() {
    let robot = r#"{"blue":true,"id":3,"at":[1,0.5],"heading":0.1}"#;
    let text = |league: &str, ball: &str, robot: &str| {
        format!(
            r#"{{"league":"{league}","t":1.0,"ball":{{"at":{ball},"velocity":[0,0]}},"robots":[{robot}]}}"#
        )
    };
    assert!(Snapshot::from_json(&text("division-b", "[0,0]", robot), LEAGUE).is_ok());
    let refused = |text: &str| Snapshot::from_json(text, LEAGUE).unwrap_err();
    assert_eq!(refused(&text("ssl-2013", "[0,0]", robot)), SnapshotError::League("ssl-2013".to_owned()));
    assert_eq!(refused(&text("division-b", "[0,99]", robot)), SnapshotError::Range("ball's place"));
    for (from, to) in [("3", "16"), ("1,0.5", "1,1e9"), ("0.1", "1e9")] {
        let robot = robot.replace(from, to);
        let error = refused(&text("division-b", "[0,0]", &robot));
        assert_eq!(error, SnapshotError::Range("place or number of a robot"), "{robot}");
    }
    for text in ["", "[]", "{}", &text("division-b", "[0]", robot)] {
        assert!(matches!(refused(text), SnapshotError::Malformed(_)), "{text}");
    }
}
