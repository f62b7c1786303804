//! `defence`: tests: the threat-based defence is stable on real camera data: recordings of the league's
//! programs, tracked, and defended against by either team, with and without the defence's memory.

use std::path::Path;

use geometry::GoalEnd;
use host::strategy::View;
use host::strategy::stakes::Stakes;
use host::strategy::threat::{Defence, Guards, Memory, ThreatSettings, defend};
use host::strategy::view::{ROBOTS_MAX, RobotSet, ViewGame};
use host::tracking::Tracker;
use protocol::{Instant, RobotId};
use rules::{Colour, FieldSpec, League, Phase};
use ssl::log::Packet;

/// Counts over a recording.
#[derive(Debug, Default)]
struct Seen {
    /// Number of orders, one per robot and world.
    orders: usize,
    /// How often a robot got another task than in the world before.
    changes: usize,
    /// Places in our area that are not the keeper's.
    in_area: usize,
    /// Duration, s.
    seconds: f32,
}

/// Both teams defend over the recording.
fn defended(name: &str, field: FieldSpec, remembers: bool) -> Seen {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data").join(name);
    let (mut tracker, mut first, mut seen) = (Tracker::default(), None, Seen::default());
    let teams = [(Colour::Yellow, GoalEnd::Negative), (Colour::Blue, GoalEnd::Positive)];
    let mut memories = [Memory::default(), Memory::default()];
    let mut before = [[None; ROBOTS_MAX]; 2];
    let mut all_robots = RobotSet::default();
    RobotId::all().for_each(|id| all_robots.insert(id));
    for record in ssl::log::open(&path).unwrap() {
        let since = (record.timestamp_ns - *first.get_or_insert(record.timestamp_ns)).max(0) as u64;
        let Ok(Some(Packet::Vision(packet))) = record.decode() else { continue };
        let now = Instant(since / 1000);
        tracker.handle(&packet, now);
        seen.seconds = now.as_secs_f32();
        let world = tracker.world(now);
        for (team, (us, defending)) in teams.into_iter().enumerate() {
            let game = ViewGame {
                phase: Phase::Run,
                next: None,
                placement: None,
                defending,
                keeper: RobotId::ZERO,
                their_keeper: RobotId::ZERO,
                stakes: Stakes::EVEN,
            };
            let view = View::of(&world, us, &game, field, all_robots);
            if !remembers {
                memories[team] = Memory::default();
            }
            let defence = defend(&view, all_robots, &mut memories[team], &ThreatSettings::default());
            count(&view, &defence, &mut before[team], &mut seen);
        }
    }
    seen
}

fn count(view: &View, defence: &Defence, before: &mut [Option<Guards>; ROBOTS_MAX], seen: &mut Seen) {
    for assignment in &defence.assignments {
        let last = before[assignment.robot.index()].replace(assignment.guards);
        seen.orders += 1;
        seen.changes += usize::from(last.is_some_and(|last| !same(last, assignment.guards)));
        let keeper = assignment.robot == view.keeper;
        seen.in_area += usize::from(!keeper && view.in_our_area(assignment.at, 0.09));
    }
}

/// The same task, independent of its numbers.
fn same(a: Guards, b: Guards) -> bool {
    match (a, b) {
        (
            Guards::SecondLevel { opponent: a, blocks: x, .. },
            Guards::SecondLevel { opponent: b, blocks: y, .. },
        ) => a == b && x == y,
        (a, b) => std::mem::discriminant(&a) == std::mem::discriminant(&b),
    }
}

#[test]
fn over_recorded_matches_tasks_do_not_flicker() {
    let field = League::DivisionB.field();
    // The recorded robots do not go where they are sent, and ER-Force's are all placed elsewhere at 1.8 s:
    // tasks have to change.
    for (name, times) in [("grsim_divB_noisy_64s.log.gz", 5), ("erforce_divB_realistic_22s.log.gz", 3)] {
        let (calm, nervous) = (defended(name, field, true), defended(name, field, false));
        println!("{name}: {calm:?}, without a memory {nervous:?}");
        assert!(calm.orders > 10_000 && calm.in_area == 0, "{name}: {calm:?}");
        assert!(nervous.changes > times * calm.changes, "{name}: {calm:?}, without a memory {nervous:?}");
    }
}
