//! Tests of `ledger`: plays made by hand, with the counts that a person would note.

use geometry::GoalEnd;
use protocol::decision::Grounds;
use protocol::quantized::WirePoint;
use protocol::team::{AbortReason, Closure, Decision, Play};
use protocol::{CaseId, Who};

use super::*;
use crate::attack::PossessionEnd;

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

const US: Colour = Colour::Blue;

fn state(counter: u32, decision: Decision) -> CycleState {
    CycleState { id: CycleId { counter, proposer: robot(1) }, coordinator: robot(2), decision }
}

/// Case 1 of two, played by robots 2 and 3.
fn play() -> Decision {
    let robots = [robot(2), robot(3)].into_iter().collect();
    Decision::Play(Play { case: CaseId(5), ball: WirePoint::default(), robots })
}

fn aborted(reason: AbortReason) -> Decision {
    Decision::Closed(Closure::Aborted { by: robot(2), reason })
}

fn kick(by: u8, at: f64, arrived: bool) -> BallEvent {
    BallEvent::Kick { by: Who { colour: US, id: robot(by) }, at, arrived }
}

fn lost(end: PossessionEnd) -> BallEvent {
    BallEvent::Lost { team: US, end }
}

const GOAL: BallEvent = BallEvent::Goal { team: US };
const THEIR_GOAL: BallEvent = BallEvent::Goal { team: Colour::Yellow };

fn shot() -> BallEvent {
    BallEvent::Shot { by: Who { colour: US, id: robot(3) } }
}

fn names() -> CaseNames {
    CaseNames::new(["back/kick", "center/pass"])
}

/// What followed a play that is decided at 1 s and ends at 3 s, by these events with their times.
fn followed(events: &[(f64, BallEvent)]) -> Vec<String> {
    let mut ledger = TeamLedger::default();
    ledger.hear(&state(1, play()), 6, 1.0);
    let mut ended = false;
    for (at, event) in events {
        if *at > 3.0 && !std::mem::replace(&mut ended, true) {
            ledger.hear(&state(1, Decision::Closed(Closure::Finished)), 6, 3.0);
        }
        ledger.follow(US, *at, event);
    }
    let table = ledger.table(&names(), true);
    table.cases[0].all.followed_by.keys().cloned().collect()
}

#[test]
fn plays_count_by_case_end_and_opponents_and_passes_for_the_play_that_made_them() {
    let mut ledger = TeamLedger::default();
    ledger.hear(&state(1, play()), 6, 1.0);
    // A pass before the decision, one of a robot that has no part, and two of the play's.
    ledger.follow(US, 2.0, &kick(2, 0.9, true));
    ledger.follow(US, 2.0, &kick(4, 1.5, true));
    ledger.follow(US, 2.0, &kick(2, 1.5, true));
    ledger.follow(US, 2.5, &kick(3, 2.2, false));
    ledger.hear(&state(1, aborted(AbortReason::OpponentOnBall)), 6, 3.0);
    // On its way when the play ended, and kicked after it.
    ledger.follow(US, 3.5, &kick(3, 2.9, true));
    ledger.follow(US, 3.5, &kick(3, 3.1, true));
    ledger.hear(&state(2, Decision::NoCase), 5, 4.0);
    ledger.hear(&state(3, play()), 5, 5.0);
    let ends = |table: &CaseTable| table.cases[0].all.ends.clone();
    let table = ledger.table(&names(), false);
    let end = |label: &str| (label.to_owned(), 1);
    assert_eq!(ends(&table), [end("opponent-on-ball"), end("running")].into());
    assert_eq!(ends(&ledger.table(&names(), true)), [end("opponent-on-ball"), end("trial-over")].into());
    let line = &table.cases[0];
    assert_eq!((&*line.case, table.cases.len(), line.all.finished), ("center/pass", 1, 0));
    assert_eq!((line.all.retrieved, line.all.passes, line.all.passes_arrived), (2, 3, 2));
    let passes: Vec<_> = line.by_opponents.iter().map(|(n, tally)| (*n, tally.passes)).collect();
    assert_eq!(passes, [(5, 0), (6, 3)]);
    assert_eq!((table.retrieved, table.no_case, table.no_case_by_opponents[&5]), (2, 1, 1));
}

#[test]
fn the_report_of_a_decision_tells_the_number_of_opponents_and_why_no_case_is_played() {
    let mut ledger = TeamLedger::default();
    ledger.hear(&state(1, play()), 6, 1.0);
    let report = |counter, opponents| DecisionReport {
        cycle: state(counter, play()).id,
        grounds: Grounds::Retrieved,
        case: Some(CaseId(5)),
        defending: GoalEnd::Negative,
        ball: WirePoint::default(),
        teammates: heapless_of(&[]),
        opponents: heapless_of(&vec![WirePoint::default(); opponents]),
    };
    assert!(ledger.report(&report(1, 4)));
    assert!(!ledger.report(&report(2, 3)), "no such decision is known yet");
    for (counter, grounds) in [(3, Grounds::BallRolls), (4, Grounds::Retrieved), (5, Grounds::BallRolls)] {
        ledger.hear(&state(counter, Decision::NoCase), 6, 2.0);
        assert!(ledger.report(&DecisionReport { grounds, ..report(counter, 5) }));
    }
    ledger.hear(&state(6, Decision::NoCase), 6, 2.0);
    let table = ledger.table(&names(), true);
    assert_eq!(table.cases[0].by_opponents.keys().copied().collect::<Vec<_>>(), [4]);
    assert_eq!(table.no_case_by_opponents, [(5, 3), (6, 1)].into());
    let because = [("ball-rolls", 2), ("none-fits", 1), ("unreported", 1)];
    assert_eq!(table.no_case_because, because.map(|(why, n)| (why.to_owned(), n)).into());
}

fn heapless_of<T: Clone, C: FromIterator<T>>(items: &[T]) -> C {
    items.iter().cloned().collect()
}

#[test]
fn what_follows_is_the_best_within_the_window() {
    use PossessionEnd as End;
    let stopped = BallEvent::Stopped;
    let resumed = BallEvent::Resumed;
    let table: [(&str, &[(f64, BallEvent)]); 12] = [
        ("nothing", &[(2.0, THEIR_GOAL), (3.5, BallEvent::Lost { team: Colour::Yellow, end: End::Left })]),
        ("loss", &[(2.0, lost(End::Tackle)), (3.5, GOAL)]),
        ("shot", &[(2.0, shot()), (2.5, lost(End::KickToOpponent))]),
        // Into the keeper, and from there into the goal.
        ("goal", &[(2.0, shot()), (2.1, lost(End::Shot)), (3.5, GOAL)]),
        ("shot", &[(2.0, shot()), (2.1, lost(End::Shot)), (4.2, GOAL)]),
        // The referee stops first and gives the goal later.
        ("goal", &[(2.0, shot()), (2.1, lost(End::Shot)), (2.1, stopped), (9.0, GOAL)]),
        ("goal", &[(2.0, lost(End::Out)), (2.0, stopped), (9.0, GOAL)]),
        ("out", &[(2.0, lost(End::Out)), (2.0, stopped), (9.0, resumed), (9.5, GOAL)]),
        ("stop", &[(2.0, lost(End::Referee)), (2.0, stopped), (9.0, resumed)]),
        ("loss", &[(2.0, lost(End::Left)), (2.5, stopped), (2.5, THEIR_GOAL)]),
        ("goal", &[(12.9, GOAL)]),
        ("nothing", &[(13.1, GOAL)]),
    ];
    for (expected, events) in table {
        assert_eq!(followed(events), [expected], "{events:?}");
    }
}

#[test]
fn a_column_holds_the_table_and_tables_of_matches_add_up() {
    let mut ledger = TeamLedger::default();
    for counter in 0..5 {
        let t = f64::from(counter) * 20.0;
        ledger.hear(&state(counter, play()), 5 + counter as usize % 2, t);
        ledger.follow(US, t + 0.5, &kick(2, t + 0.2, counter % 2 == 0));
        ledger.hear(&state(counter, aborted(AbortReason::PathBlocked)), 6, t + 1.0);
        ledger.follow(US, t + 1.5, &lost(PossessionEnd::Tackle));
    }
    ledger.hear(&state(9, Decision::NoCase), 6, 100.0);
    let table = ledger.table(&names(), true);
    let column = table.column();
    assert_eq!(
        column,
        "center/pass@5:retrieved=3,pass=3,arrived=3,end.path-blocked=3,then.loss=3 \
         center/pass@6:retrieved=2,pass=2,end.path-blocked=2,then.loss=2 no-case@6:retrieved=1 \
         no-case:unreported=1"
    );
    assert_eq!(CaseTable::read(&column), table);
    assert_eq!(CaseTable::read(""), CaseTable::default());
    assert_eq!(CaseTable::read("x a@b:c=1 a@6 @:"), CaseTable::default());
    let mut twice = table.clone();
    twice.merge(&table);
    assert_eq!((twice.retrieved, twice.no_case, twice.cases[0].all.passes), (10, 2, 10));
    assert_eq!(twice.cases[0].by_opponents[&5].followed(Followed::Loss), 6);
}
