//! `gameplay`: tests: robots play a case as the paper describes it, and leave it for the paper's reasons (Ros
//! et al. 2009 §4.2; docs/case-format.md §4, docs/architecture.md §5).
//!
//! Brains in an ideal world where failures come from the tests alone; the library is the worked example of
//! docs/case-format.md §1 alone.

use std::sync::LazyLock;

use brain::{BrainConfig, Positioning};
use case_tools::{Files, Library};
use geometry::{Point, Pose};
use match_tests::tabletop::Tabletop;
use protocol::robot_io::LeggedKick;
use protocol::team::{AbortReason, Closure, Decision, Progress, Role};
use protocol::{RobotId, TeamId};

#[test]
fn a_booting_robot_listens_for_one_lease_before_it_proposes() {
    let mut table = table(&[1, 3], Positioning::Dependent);
    assert!(table.until(1.0, |t| cycle(t, 1).is_some()));
    assert!(table.now().0 > 400_000, "proposed after {} us", table.now().0);
    let proposed = cycle(&mut table, 1).unwrap();
    assert_eq!(proposed.id.proposer.number(), 1, "the lowest id present proposes");
    assert_eq!(proposed.coordinator.number(), 1, "robot 1 is nearest the ball");
}

#[test]
fn a_pass_is_played_from_its_election_to_its_end() {
    let mut table = table(&[1, 3], Positioning::Dependent);
    assert!(table.until(2.0, |t| play(t, 3).is_some_and(|robots| robots == [1, 3])), "robot 3 gets its part");
    assert!(table.until(3.0, |t| matches!(progress(t, 1), Progress::Execute { .. })), "the getter arrives");
    assert!(table.until(0.2, |t| matches!(progress(t, 3), Progress::Execute { .. })), "and all execute");
    assert!(table.until(10.0, |t| t.kicks.len() == 1), "the pass");
    let (passer, kick, velocity) = table.kicks[0];
    assert_eq!(passer.number(), 1);
    let LeggedKick::Pass(distance) = kick else { panic!("{kick:?}") };
    // From about (−600, 0) to robot 3's place (300, 900): 1.27 m at 45°, played firmly.
    assert!((1.2 * 1.1..1.2 * 1.5).contains(&distance), "{distance}");
    assert!((35.0..55.0).contains(&velocity.angle().to_degrees()), "{velocity:?}");
    let done = |t: &mut Tabletop| progress(t, 1) == Progress::WaitEnd { finished: true };
    assert!(table.until(0.2, done), "the passer has done its part and waits for the end");
    assert!(table.until(10.0, |t| t.kicks.len() == 2), "the receiver shoots");
    assert_eq!(table.kicks[1].0.number(), 3);
    // Cycle counters of epoch 1 are 1 modulo 64: 65 follows 1.
    let ended = |t: &mut Tabletop| closure(t) == Some(Closure::Finished);
    assert!(table.until(0.2, ended), "the coordinator closes the cycle when all have finished");
    assert!(table.until(0.4, |t| cycle(t, 3).is_some_and(|c| c.id.counter == 65)), "and the next begins");
}

#[test]
fn independent_positioning_waits_until_all_have_arrived() {
    for (positioning, waits) in [(Positioning::Dependent, false), (Positioning::Independent, true)] {
        let mut table = table(&[1, 3], positioning);
        // Robot 3 starts a metre from its place.
        table.robot(3).pose.position = Point::new(0.3, -0.1);
        let arrived =
            |t: &mut Tabletop| !matches!(progress(t, 1), Progress::Idle | Progress::Adapt { arrived: false });
        assert!(table.until(4.0, arrived), "the getter arrives");
        table.until(0.2, |_| false);
        let still_there = progress(&mut table, 1) == Progress::Adapt { arrived: true };
        assert_eq!(still_there, waits, "{positioning:?}");
        assert!(table.until(8.0, |t| matches!(progress(t, 3), Progress::Execute { .. })), "{positioning:?}");
    }
}

#[test]
fn before_the_first_touch_ball_opponent_and_silent_robot_end_the_cycle() {
    assert_eq!(aborted_after(|table| table.ball = Point::new(-0.6, 0.6)), AbortReason::BallOutOfScope);
    assert_eq!(aborted_after(|table| table.opponents.push(Point::new(-0.2, 0.45))), AbortReason::PathBlocked);
    assert_eq!(aborted_after(|table| table.robot(3).dead = true), AbortReason::RobotLost);
}

#[test]
fn a_passer_that_loses_the_ball_ends_the_cycle() {
    let mut table = table(&[1, 3], Positioning::Dependent);
    assert!(table.until(8.0, |t| t.robot(1).holds));
    table.until(0.1, |_| false);
    table.robot(1).holds = false;
    table.ball = Point::new(-0.3, -0.3);
    let failed = table.until(0.2, |t| abort_reason(t) == Some(AbortReason::ActionFailed));
    assert!(failed, "{:?}", cycle(&mut table, 3));
}

#[test]
fn a_gameplay_that_cannot_go_on_times_out() {
    let mut table = table(&[1, 3], Positioning::Dependent);
    assert!(table.until(1.0, |t| play(t, 1).is_some()));
    // The getter cannot move; everything else is unchanged.
    let place = Pose::from_mm_deg(-1100.0, 0.0, 0.0);
    assert!(table.until(30.0, |t| {
        t.robot(1).pose = place;
        abort_reason(t) == Some(AbortReason::Timeout)
    }));
}

#[test]
fn without_a_case_robots_play_reactively_and_retrieve_again() {
    let mut table = table(&[1, 3], Positioning::Dependent);
    table.ball = Point::new(1.5, -1.0);
    assert!(table.until(1.0, |t| cycle(t, 3).is_some_and(|c| c.decision == Decision::NoCase)));
    table.until(0.1, |_| false);
    let roles = [3, 1].map(|n| table.robot(n).beacon.as_ref().unwrap().role);
    assert_eq!(roles, [Role::Attacker; 2], "none holds the ball, or is at it");
    assert!(
        table.until(1.0, |t| cycle(t, 1).is_some_and(|c| c.id.counter >= 3)),
        "a new try every few steps"
    );
    table.ball = Point::new(-0.6, 0.0);
    table.robot(1).pose = Pose::from_mm_deg(-900.0, 0.0, 0.0);
    table.robot(3).pose = Pose::from_mm_deg(200.0, 800.0, 0.0);
    assert!(table.until(1.0, |t| play(t, 1).is_some()), "and a case as soon as one fits");
}

#[test]
fn a_robot_that_is_not_involved_waits_for_the_end() {
    let mut table = table(&[1, 3, 5], Positioning::Dependent);
    assert!(table.until(2.0, |t| play(t, 5).is_some()));
    assert_eq!(progress(&mut table, 5), Progress::WaitEnd { finished: false });
    let mut nearest = f32::INFINITY;
    let passed = table.until(10.0, |t| {
        nearest = nearest.min(t.robot(5).pose.position.distance(t.ball));
        !t.kicks.is_empty()
    });
    assert!(passed && nearest > 0.6, "near the ball, but not after it: {nearest} m");
}

#[test]
fn a_robot_with_another_case_base_gets_no_part() {
    let other = other_library();
    let mut table = table(&[1, 3, 5], Positioning::Dependent);
    let config = config(3, Positioning::Dependent);
    table.robot(3).brain = brain::Brain::new(table.now(), &config, other.base());
    assert!(table.until(2.0, |t| play(t, 1).is_some()));
    assert_eq!(play(&mut table, 1).unwrap(), [1, 5], "robot 5 is farther away, but knows the case");
}

/// Lets a gameplay start, applies `harm` while its robots adapt, and returns the reason for which the cycle
/// ends.
fn aborted_after(harm: impl FnOnce(&mut Tabletop<'_>)) -> AbortReason {
    let mut table = table(&[1, 3], Positioning::Dependent);
    assert!(table.until(1.0, |t| play(t, 1).is_some()));
    harm(&mut table);
    table.until(1.0, |t| abort_reason(t).is_some());
    abort_reason(&table).expect("the cycle is aborted within a second")
}

static LIBRARY: LazyLock<Library> = LazyLock::new(|| library_of(&pass_and_shot()));

fn library_of(case: &str) -> Library {
    // The shot is longer than the body's hardest kick: it is kicked all the same.
    let league: String = LEAGUE
        .lines()
        .filter(|line| !line.starts_with("reach"))
        .fold(String::new(), |all, line| all + line + "\n");
    case_tools::build(&Files::from_texts("table", &league, &[("center/pass-around", case)])).expect("valid")
}

/// The case, with a shot after the reception.
fn pass_and_shot() -> String {
    PASS_AROUND.replace("{ receive_ball = 1 }", "{ receive_ball = 1 }, { kick = \"goal\" }")
}

/// The same case with a larger scope: another hash.
fn other_library() -> Library {
    library_of(&pass_and_shot().replace("[450, 250]", "[460, 250]"))
}

fn config(id: u8, positioning: Positioning) -> BrainConfig {
    BrainConfig { positioning, ..BrainConfig::new(RobotId::new(id).unwrap(), TeamId(1)) }
}

/// Robot 1 half a metre behind its place, robot 3 near its own, others at the back.
fn table<'a>(ids: &[u8], positioning: Positioning) -> Tabletop<'a> {
    let pose = |id| match id {
        1 => Pose::from_mm_deg(-1200.0, 0.0, 0.0),
        3 => Pose::from_mm_deg(200.0, 800.0, -135.0),
        _ => Pose::from_mm_deg(-600.0, 1200.0, 0.0),
    };
    let robots: Vec<_> = ids.iter().map(|&id| (config(id, positioning), pose(id))).collect();
    let mut table = Tabletop::new(LIBRARY.base(), (-0.6, 0.0), &robots);
    table.opponents.push(Point::new(-0.15, -0.1));
    table
}

fn cycle(table: &mut Tabletop<'_>, robot: u8) -> Option<protocol::team::CycleState> {
    table.robot(robot).beacon.as_ref()?.cycle.clone()
}

fn play(table: &mut Tabletop<'_>, robot: u8) -> Option<Vec<u8>> {
    let cycle = cycle(table, robot)?;
    Some(cycle.play()?.robots.iter().map(|id| id.number()).collect())
}

/// The end of the newest cycle that ended.
fn closure(table: &Tabletop<'_>) -> Option<Closure> {
    table.ends.last().map(|(_, end)| *end)
}

/// The reason for which the newest cycle was aborted, if it was.
fn abort_reason(table: &Tabletop<'_>) -> Option<AbortReason> {
    match closure(table) {
        Some(Closure::Aborted { reason, .. }) => Some(reason),
        _ => None,
    }
}

fn progress(table: &mut Tabletop<'_>, robot: u8) -> Progress {
    table.robot(robot).beacon.as_ref().map_or(Progress::Idle, |beacon| beacon.progress)
}

const LEAGUE: &str = include_str!("../../casebase/library/cases/four-legged/league.toml");
/// The worked example of docs/case-format.md §1, as it is in the built-in library.
const PASS_AROUND: &str = include_str!("../../casebase/library/cases/four-legged/center/pass-around.toml");
