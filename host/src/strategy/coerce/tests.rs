//! Tests: the planner follows the paper's seven steps, with passes valued by a rule that can be computed by
//! hand.

use super::super::view::tests::view;
use super::super::view::{View, ViewRobot};
use super::attack::{AttackSearch, PassOrigin, PassValue, Worth};
use super::grid::Cell;
use super::tactics::Models;
use super::*;
use geometry::{Attack, Point, Segment};
use protocol::RobotId;
use protocol::host::KickOrder;
use rules::{Phase, Side};

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

/// P(receive) falls with the nearness of opponents to the pass, P(goal) with their nearness to the shot and
/// with its length.
struct ByDistance;

impl ByDistance {
    fn free(distance: f32) -> f32 {
        (distance / 0.6).clamp(0.0, 1.0)
    }
}

impl PassValue for ByDistance {
    fn worths(
        &self,
        view: &View,
        PassOrigin { from, .. }: PassOrigin,
        _: &ViewRobot,
        places: &mut dyn Iterator<Item = Point<Attack>>,
        take: &mut dyn FnMut(Point<Attack>, Worth),
    ) {
        for at in places {
            let product = |path: Segment<Attack>| {
                view.theirs.iter().map(|robot| Self::free(path.distance_to(robot.position))).product::<f32>()
            };
            let goal = view.their_goal();
            let legal = !view.in_their_area(at, 0.3) && at.distance(from) > 0.8;
            let receive = if legal { product(Segment::new(from, at)) } else { 0.0 };
            let near = (1.0 - at.distance(goal) / 6.0).max(0.0);
            // The keeper always obstructs the shot: only the others count.
            let shot = Segment::new(at, goal);
            let blocked = view.theirs.iter().filter(|robot| robot.id != view.their_keeper);
            let open: f32 = blocked.map(|robot| Self::free(shot.distance_to(robot.position))).product();
            take(at, Worth { receive, goal: near * open, kick: KickOrder::Flat(400), aim: goal });
        }
    }

    fn meets_pass(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        1.0 - Self::free(Segment::new(from, to).distance_to(opponent.position))
    }

    fn meets_shot(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        1.0 - Self::free(Segment::new(from, to).distance_to(opponent.position))
    }
}

/// Division B, our free kick at (0.5, 1.8) with 1 as kicker; keeper 0, teammates from 2 on. Theirs: keeper 0,
/// primaries 1 and 2, then a marker goal-side of each teammate named.
fn free_kick(teammates: &[(f32, f32)], marked: &[usize]) -> View {
    let mut ours = vec![(-4.4, 0.0), (0.4, 1.9)];
    ours.extend(teammates);
    let goal = Point::<Attack>::new(4.5, 0.0);
    let mut theirs = vec![(4.3, 0.1), (3.39, 0.25), (3.39, 0.0)];
    for teammate in marked {
        let at = Point::new(teammates[*teammate].0, teammates[*teammate].1);
        let by = at + (goal - at).unit().unwrap() * 0.3;
        theirs.push((by.x(), by.y()));
    }
    let mut view = view((0.5, 1.8), &ours, &theirs);
    view.phase = Phase::FreeKick(Side::Ours);
    view
}

/// Passes of any value.
const ANY: attack::Least = attack::Least { receive: 0.0, value: 0.0 };
/// A search for any pass of robot 1.
fn search() -> AttackSearch {
    AttackSearch { kicker: id(1), least: ANY, seed: 1 }
}

fn planner() -> Planner {
    Planner::new(CoerceSettings { least: ANY, ..CoerceSettings::default() }, Models::default())
}

fn run(teammates: &[(f32, f32)], marked: &[usize]) -> (Planner, CapPlan, View) {
    let view = free_kick(teammates, marked);
    let mut planner = planner();
    planner.observe(&view, id(1));
    let plan = planner.plan(&view, &ByDistance, id(1), 1).unwrap().clone();
    (planner, plan, view)
}

const TEAMMATES: [(f32, f32); 4] = [(2.2, 0.2), (2.0, -1.2), (1.0, -0.6), (-1.0, 1.0)];

#[test]
fn as_many_coerce_as_are_followed_and_the_rest_attacks() {
    // The paper's examples: 3 followers of 4, then 4 of 4.
    let (_, plan, _) = run(&TEAMMATES, &[0, 1, 2]);
    let who: Vec<_> = plan
        .coerce
        .coercers
        .iter()
        .map(|coercer| (coercer.robot.number(), coercer.marker.number()))
        .collect();
    assert_eq!(who.len(), 3);
    for pair in [(2, 3), (3, 4), (4, 5)] {
        assert!(who.contains(&pair), "each draws the one that follows it: {who:?}");
    }
    assert_eq!(plan.attackers[..], [id(5)]);
    assert_eq!(plan.optimistic.receiver, id(5));
    let (_, all, _) = run(&TEAMMATES, &[0, 1, 2, 3]);
    assert_eq!((all.coerce.coercers.len(), all.attackers.len()), (4, 0));
    assert!(all.coercer(all.optimistic.receiver).is_some(), "one is used again");
    let (_, none, _) = run(&TEAMMATES, &[]);
    assert!(none.coerce.coercers.is_empty() && none.attackers.len() == 4);
}

#[test]
fn the_optimistic_attack_sees_ball_followers_only() {
    let (_, plan, view) = run(&TEAMMATES, &[0, 1, 2]);
    assert_eq!(plan.optimistic.against, 3);
    // Its value is above that against all opponents, and the best of all cells by hand.
    let mut seen = view.clone();
    let (_, all_robots) = attack::best_attack(&seen, &ByDistance, search(), &[id(5)]);
    assert!(all_robots.iter().zip(&plan.values).all(|(all, some)| all <= some));
    assert!(all_robots.iter().zip(&plan.values).any(|(all, some)| all < some));
    seen.theirs.truncate(3);
    let mut best = (0.0, None);
    let receiver = *seen.our(id(5)).unwrap();
    for cell in Cell::all() {
        let mut places = [cell.middle(&seen.field)].into_iter();
        ByDistance.worths(
            &seen,
            PassOrigin { from: Point::new(0.5, 1.8), kicker: id(1) },
            &receiver,
            &mut places,
            &mut |_, worth| {
                if worth.value() > best.0 {
                    best = (worth.value(), Some(cell));
                }
            },
        );
    }
    assert_eq!(Some(plan.optimistic.cell), best.1);
    assert!(plan.optimistic.worth.value() >= best.0, "refined within its cell");
    let (by, half) =
        (plan.optimistic.at - plan.optimistic.cell.middle(&view.field), Cell::size(&view.field) * 0.5);
    assert!(by.x().abs() <= half.x() + 1e-5 && by.y().abs() <= half.y() + 1e-5);
}

#[test]
fn coercers_go_where_their_followers_are_least_in_the_way() {
    let (_, plan, view) = run(&TEAMMATES, &[0, 1, 2]);
    let from = Point::new(0.5, 1.8);
    let (pass, shot) =
        (Segment::new(from, plan.optimistic.at), Segment::new(plan.optimistic.at, plan.optimistic.worth.aim));
    let mut cells = Vec::new();
    for coercer in &plan.coerce.coercers {
        // By hand: 1 − (1 − pass)(1 − shot), for a follower 0.3 m from the cell towards the goal.
        let goal = view.their_goal();
        let expected = coercer.at + (goal - coercer.at).unit().unwrap() * 0.3;
        assert!(expected.distance(coercer.expected) < 0.05, "{coercer:?}");
        let free = |path: Segment<Attack>| ByDistance::free(path.distance_to(coercer.expected));
        let by_hand = 1.0 - free(pass) * free(shot);
        assert!((coercer.interference - by_hand).abs() < 1e-5 && by_hand < 0.01, "{coercer:?}");
        assert!(pass.distance_to(coercer.at) >= 0.5 && shot.distance_to(coercer.at) >= 0.5);
        assert!(coercer.cell != plan.optimistic.cell && !cells.contains(&coercer.cell));
        assert!(coercer.time <= 4.0 && !view.in_their_area(coercer.at, 0.3));
        cells.push(coercer.cell);
    }
    // The opponent that interferes most comes first.
    let now: Vec<_> = plan.coerce.coercers.iter().map(|coercer| coercer.interference_now).collect();
    assert!(now.is_sorted_by(|a, b| a >= b), "{now:?}");
}

/// All robots move as ordered for `seconds`: coercers to their places, followers after them if `follow`.
fn play(planner: &mut Planner, view: &mut View, follow: bool, seconds: f32) -> CoerceProgress {
    let mut progress = planner.watch(view, &ByDistance);
    for _ in 0..(seconds * 100.0) as u32 {
        view.now += protocol::Duration::millis(10);
        for posting in &planner.postings(view) {
            let robot = view.ours.iter_mut().find(|robot| robot.id == posting.robot).unwrap();
            if let CoercePart::Coerces { marker, expected } = posting.part {
                robot.position += (posting.at - robot.position).clamped(0.02);
                let by = view.theirs.iter_mut().find(|robot| robot.id == marker).unwrap();
                if follow {
                    by.position += (expected - by.position).clamped(0.02);
                }
            }
        }
        progress = planner.watch(view, &ByDistance);
        if matches!(progress, CoerceProgress::Attacking(_)) {
            break;
        }
    }
    progress
}

#[test]
fn a_team_followed_as_expected_attacks_as_planned_once_the_followers_came() {
    let (mut planner, plan, mut view) = run(&TEAMMATES, &[0, 1, 2]);
    let begin = view.now;
    let first = planner.watch(&view, &ByDistance);
    assert!(matches!(first, CoerceProgress::Coercing { of: 3, .. }), "{first:?}");
    let CoerceProgress::Attacking(attack) = play(&mut planner, &mut view, true, 5.0) else { panic!() };
    assert!(matches!(attack.followed, Followed::AsExpected { worst } if worst < 0.5), "{attack:?}");
    assert_eq!((attack.plan, attack.reused), (plan.optimistic, false));
    let took = view.now.since(begin).as_secs_f32();
    assert!(took > 0.5 && took < 4.1, "{took}");
    // Orders now: the receiver has its place, the others stay.
    let postings = planner.postings(&view);
    let part = |n: u8| postings.iter().find(|posting| posting.robot == id(n)).unwrap().part;
    assert_eq!((part(1), part(5)), (CoercePart::Takes, CoercePart::Receives));
    assert!(matches!(part(2), CoercePart::Coerces { .. }));
    // The ball in play ends it.
    view.phase = Phase::Run;
    assert_eq!(planner.watch(&view, &ByDistance), CoerceProgress::Over(CoerceEnd::InPlay));
    assert!(planner.postings(&view).is_empty());
}

#[test]
fn an_opponent_that_does_not_follow_causes_a_new_attack_against_all() {
    let (mut planner, _, mut view) = run(&TEAMMATES, &[0, 1, 2]);
    let CoerceProgress::Attacking(attack) = play(&mut planner, &mut view, false, 5.0) else { panic!() };
    let Followed::Otherwise { off, .. } = attack.followed else { panic!("{attack:?}") };
    assert!(off > 0.5 && attack.plan.against == 6);
    // Coercers that no opponent followed are free: they may be used again.
    let candidates = [id(2), id(3), id(4), id(5)];
    let (best, _) = attack::best_attack(&view, &ByDistance, search(), &candidates);
    assert!(attack.plan.worth.value() <= best.unwrap().worth.value() + 1e-6);
    assert_eq!(attack.reused, attack.plan.receiver != id(5));
}

#[test]
fn where_all_coerce_one_that_no_opponent_follows_receives() {
    let (mut planner, plan, mut view) = run(&TEAMMATES, &[0, 1, 2, 3]);
    let marked = plan.optimistic.receiver;
    let CoerceProgress::Attacking(attack) = play(&mut planner, &mut view, true, 5.0) else { panic!() };
    // All are followed as expected, so the receiver is marked; no robot is free; one of them attacks
    // nevertheless.
    assert!(matches!(attack.followed, Followed::ReceiverMarked { .. }), "{attack:?} {marked:?}");
    assert!(attack.reused);
    // One loses its follower: it becomes the receiver.
    let (mut planner, plan, mut view) = run(&TEAMMATES, &[0, 1, 2, 3]);
    let left = plan.coercer(plan.optimistic.receiver).unwrap().marker;
    view.theirs.retain(|robot| robot.id != left);
    let free = plan.coerce.coercers.iter().find(|coercer| coercer.marker == left).unwrap().robot;
    let mut now = view.clone();
    for robot in &mut now.ours {
        if let Some(coercer) = plan.coercer(robot.id) {
            robot.position = coercer.at;
        }
    }
    for robot in &mut now.theirs {
        if let Some(coercer) = plan.coerce.coercers.iter().find(|coercer| coercer.marker == robot.id) {
            robot.position = coercer.expected;
        }
    }
    planner.watch(&now, &ByDistance);
    now.now += protocol::Duration::millis(600);
    let CoerceProgress::Attacking(attack) = planner.watch(&now, &ByDistance) else { panic!() };
    assert_eq!((attack.plan.receiver, attack.reused), (free, true));
    assert!(matches!(attack.followed, Followed::AsExpected { .. }));
}

#[test]
fn the_same_snapshots_and_seed_give_the_same_plan() {
    let (_, once, _) = run(&TEAMMATES, &[0, 2]);
    let (_, twice, _) = run(&TEAMMATES, &[0, 2]);
    assert_eq!(once, twice);
}

#[test]
fn before_the_free_kick_the_clock_stands_and_a_halt_ends_it() {
    let (mut planner, _, mut view) = run(&TEAMMATES, &[0, 1, 2]);
    view.phase = Phase::Stop;
    for _ in 0..1_000 {
        view.now += protocol::Duration::millis(10);
        assert!(matches!(planner.watch(&view, &ByDistance), CoerceProgress::Coercing { left: 4.0, .. }));
    }
    view.phase = Phase::Halt;
    assert_eq!(planner.watch(&view, &ByDistance), CoerceProgress::Over(CoerceEnd::Stopped));
    view.phase = Phase::FreeKick(Side::Ours);
    assert_eq!(
        planner.watch(&view, &ByDistance),
        CoerceProgress::Over(CoerceEnd::Stopped),
        "until it is planned anew"
    );
}

#[test]
fn without_a_ball_or_teammates_there_is_no_plan() {
    let mut planner = planner();
    let mut lonely = free_kick(&[], &[]);
    assert_eq!(planner.plan(&lonely, &ByDistance, id(1), 1), None);
    assert_eq!(planner.watch(&lonely, &ByDistance), CoerceProgress::Over(CoerceEnd::NoAttack));
    lonely.ball = None;
    assert_eq!(planner.plan(&lonely, &ByDistance, id(1), 1), None);
    let mut idle = Planner::new(CoerceSettings::default(), Models::default());
    assert_eq!(idle.watch(&lonely, &ByDistance), CoerceProgress::Idle);
}

#[test]
fn an_unlikely_pass_is_no_attack_and_is_searched_again_while_there_is_time() {
    let likely = |receive| CoerceSettings {
        least: attack::Least { receive, value: 0.0 },
        ..CoerceSettings::default()
    };
    let mut view = free_kick(&TEAMMATES, &[0, 1, 2]);
    let mut strict = Planner::new(likely(1.1), Models::default());
    assert_eq!(strict.plan(&view, &ByDistance, id(1), 1), None);
    let mut planner = Planner::new(likely(0.7), Models::default());
    let plan = planner.plan(&view, &ByDistance, id(1), 1).unwrap().clone();
    assert!(plan.optimistic.worth.receive >= 0.7);
    // One stands at the ball: no pass arrives anywhere.
    let mut closed = view.clone();
    closed.theirs[1].position = Point::new(0.5, 1.8);
    let (mut sought, mut over) = (0, None);
    for ms in (0..4_500).step_by(100) {
        closed.now = view.now + protocol::Duration::millis(ms);
        match planner.watch(&closed, &ByDistance) {
            CoerceProgress::Coercing { .. } => sought = ms,
            CoerceProgress::Over(end) => {
                over.get_or_insert((ms, end));
            }
            other => panic!("{other:?}"),
        }
    }
    assert_eq!((sought, over), (3_900, Some((4_000, CoerceEnd::NoAttack))));
    // It leaves in time: then there is a plan, and it is searched again as long as there is time.
    planner.plan(&view, &ByDistance, id(1), 1).unwrap();
    let begun = view.now;
    planner.watch(&view, &ByDistance);
    for robot in &mut view.ours {
        robot.position = plan.coercer(robot.id).map_or(robot.position, |coercer| coercer.at);
    }
    planner.watch(&view, &ByDistance);
    view.now += protocol::Duration::millis(600);
    let CoerceProgress::Attacking(first) = planner.watch(&view, &ByDistance) else { panic!() };
    assert!(first.plan.worth.receive >= 0.7);
    assert!(planner.reconsider(view.now));
    let CoerceProgress::Attacking(again) = planner.watch(&view, &ByDistance) else { panic!() };
    assert_eq!(again.plan, first.plan);
    assert!(!planner.reconsider(begun + protocol::Duration::millis(4_000)));
}

/// Counts the calls of each function.
#[derive(Default)]
struct Counting {
    worths: core::cell::Cell<usize>,
    meets: core::cell::Cell<usize>,
}

impl PassValue for Counting {
    fn worths(
        &self,
        view: &View,
        origin: PassOrigin,
        receiver: &ViewRobot,
        places: &mut dyn Iterator<Item = Point<Attack>>,
        take: &mut dyn FnMut(Point<Attack>, Worth),
    ) {
        ByDistance.worths(view, origin, receiver, places, &mut |at, worth| {
            self.worths.set(self.worths.get() + 1);
            take(at, worth);
        });
    }

    fn meets_pass(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        self.meets.set(self.meets.get() + 1);
        ByDistance.meets_pass(opponent, from, to)
    }

    fn meets_shot(&self, opponent: &ViewRobot, from: Point<Attack>, to: Point<Attack>) -> f32 {
        ByDistance.meets_shot(opponent, from, to)
    }
}

#[test]
fn the_work_of_a_tick_is_bounded_by_cells_receivers_and_followers() {
    for marked in [&[][..], &[0, 1], &[0, 1, 2, 3]] {
        let mut view = free_kick(&TEAMMATES, marked);
        let mut planner = planner();
        let counting = Counting::default();
        planner.plan(&view, &counting, id(1), 1);
        let receivers = if marked.len() == 4 { 4 } else { 4 - marked.len() };
        // Every cell for every receiver, and the samples around the best one.
        assert_eq!(counting.worths.take(), 24 * receivers + attack::SAMPLES as usize);
        // Every cell that is allowed for every follower, and each where it stands.
        assert!(counting.meets.take() <= 25 * marked.len());
        planner.watch(&view, &counting);
        let ticks = counting.worths.take();
        assert!(marked.is_empty() || ticks == 0, "nothing is rated while they go");
        view.now += protocol::Duration::millis(5_000);
        planner.watch(&view, &counting);
        assert!(counting.worths.take() <= 24 * 4 + attack::SAMPLES as usize);
    }
}
