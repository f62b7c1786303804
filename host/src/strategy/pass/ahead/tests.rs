//! Tests: Algorithm 1 agrees with the Simple Temporal Network. The network (Dechter, Meiri and Pearl 1991;
//! paper 2 Fig. 4) is solved by Floyd and Warshall, the algorithm is run every 10 ms on robots that keep
//! their times exactly.

use super::*;
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

/// Events: the pass is requested; the passer starts, is at x_p, kicks; the receiver starts, is at x_r; the
/// ball is at x*.
const EVENTS: usize = 7;
const BEGIN: usize = 0;
const PASSER_STARTS: usize = 1;
const PASSER_THERE: usize = 2;
const KICK: usize = 3;
const RECEIVER_STARTS: usize = 4;
const RECEIVER_THERE: usize = 5;
const BALL_THERE: usize = 6;

/// Differences of times between events: `most[a][b]` bounds t_b − t_a from above.
struct Network {
    most: [[f64; EVENTS]; EVENTS],
}

impl Network {
    fn pass_ahead(receiver: f64, passer: f64, ball: f64) -> Self {
        let mut network = Self { most: [[f64::INFINITY; EVENTS]; EVENTS] };
        (0..EVENTS).for_each(|event| network.most[event][event] = 0.0);
        let for_ever = f64::INFINITY;
        network.between(BEGIN, PASSER_STARTS, 0.0, for_ever);
        network.between(BEGIN, RECEIVER_STARTS, 0.0, for_ever);
        network.between(PASSER_STARTS, PASSER_THERE, passer, passer);
        // At x_p it may wait indefinitely.
        network.between(PASSER_THERE, KICK, 0.0, for_ever);
        network.between(KICK, BALL_THERE, ball, ball);
        network.between(RECEIVER_STARTS, RECEIVER_THERE, receiver, receiver);
        network.between(RECEIVER_THERE, BALL_THERE, 0.0, 0.0);
        network
    }

    fn between(&mut self, from: usize, to: usize, least: f64, most: f64) {
        self.most[from][to] = self.most[from][to].min(most);
        self.most[to][from] = self.most[to][from].min(-least);
    }

    /// All shortest paths; `None` where the times contradict each other.
    fn solved(mut self) -> Option<Self> {
        for via in 0..EVENTS {
            for a in 0..EVENTS {
                for b in 0..EVENTS {
                    self.most[a][b] = self.most[a][b].min(self.most[a][via] + self.most[via][b]);
                }
            }
        }
        (0..EVENTS).all(|event| self.most[event][event] >= -1e-9).then_some(self)
    }

    /// The least time until the ball is at x*, and the latest times of all events that keep to it.
    fn latest_of_the_shortest(receiver: f64, passer: f64, ball: f64) -> [f64; EVENTS] {
        let free = Self::pass_ahead(receiver, passer, ball).solved().expect("a pass is possible");
        let least = -free.most[BALL_THERE][BEGIN];
        let mut network = Self::pass_ahead(receiver, passer, ball);
        network.between(BEGIN, BALL_THERE, least, least);
        network.solved().expect("the least time is possible").most[BEGIN]
    }
}

/// Robots that need exactly their estimated times, and start when they are ordered to.
fn simulate(receiver: f32, passer: f32, ball: f32) -> (PassAhead, f32) {
    let mut ahead = PassAhead::new(Instant(0));
    for tick in 0..1_000_u64 {
        let now = Instant(tick * TICK);
        let left = |whole: f32, started: Option<Instant>| {
            (whole - started.map_or(0.0, |at| now.since(at).as_secs_f32())).max(0.0)
        };
        let passer = left(passer, ahead.passer);
        let times = Times {
            receiver: left(receiver, ahead.receiver_started()),
            passer,
            ball,
            at_ball: passer <= 0.0,
        };
        if ahead.step(now, &times).passer == PasserMove::Shoots {
            return (ahead, times.receiver);
        }
    }
    panic!("never shot");
}

const TICK: u64 = 10_000;

fn seconds(at: Option<Instant>) -> f64 {
    f64::from(at.expect("it has happened").since(Instant(0)).as_secs_f32())
}

#[test]
fn the_network_of_a_pass_by_hand() {
    // T_r = 2, T_s = 0.5, T_b = 1: the ball is there after 2 s; the passer starts at 0.5 and kicks at 1.
    let latest = Network::latest_of_the_shortest(2.0, 0.5, 1.0);
    assert_eq!([latest[PASSER_STARTS], latest[PASSER_THERE], latest[KICK]], [0.5, 1.0, 1.0]);
    assert_eq!([latest[RECEIVER_STARTS], latest[RECEIVER_THERE], latest[BALL_THERE]], [0.0, 2.0, 2.0]);
    // T_r = 0.4: the receiver waits until 1.1.
    let latest = Network::latest_of_the_shortest(0.4, 0.5, 1.0);
    assert_eq!([latest[PASSER_STARTS], latest[KICK], latest[BALL_THERE]], [0.0, 0.5, 1.5]);
    assert!((latest[RECEIVER_STARTS] - 1.1).abs() < 1e-9);
    let mut impossible = Network::pass_ahead(1.0, 0.5, 1.0);
    impossible.between(BEGIN, BALL_THERE, 0.0, 1.2);
    assert!(impossible.solved().is_none(), "1.5 s do not fit into 1.2 s");
}

#[test]
fn everyone_starts_when_the_network_says() {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(9);
    let mut up_to = |most: f32| (rng.next_u32() >> 8) as f32 / 16_777_216.0 * most;
    // At most a tick late, each; and the kick may be early by the tolerance of the algorithm.
    let tick = 1.5 * TICK as f64 * 1e-6;
    let (mut receiver_first, mut passer_first) = (0, 0);
    for _ in 0..500 {
        let (receiver, passer, ball) = (up_to(2.5), up_to(1.5), 0.2 + up_to(1.3));
        let latest = Network::latest_of_the_shortest(receiver.into(), passer.into(), ball.into());
        let (ahead, _) = simulate(receiver, passer, ball);
        let near =
            |is: f64, latest: f64, early: f64| is <= latest + 2.0 * tick && is >= latest - early - tick;
        assert!(near(seconds(ahead.passer), latest[PASSER_STARTS], 0.0), "{ahead:?} {latest:?}");
        let forgiven = f64::from(RECEIVER_LATE_MAX_S);
        assert!(near(seconds(ahead.shot()), latest[KICK], forgiven), "{ahead:?} {latest:?}");
        // A receiver that has not started when the ball leaves would start later in the network.
        let receiver_starts = latest[RECEIVER_STARTS];
        if receiver_starts < seconds(ahead.shot()) - tick {
            assert!(
                near(seconds(ahead.receiver_started()), receiver_starts, forgiven),
                "{ahead:?} {latest:?}"
            );
        }
        receiver_first += u32::from(latest[PASSER_STARTS] > 0.0);
        passer_first += u32::from(receiver_starts > 0.0);
    }
    assert!(receiver_first > 100 && passer_first > 100, "{receiver_first} {passer_first}");
}

#[test]
fn equal_times_start_both() {
    let mut ahead = PassAhead::new(Instant(0));
    let moves = ahead.step(Instant(0), &Times { receiver: 1.5, passer: 0.5, ball: 1.0, at_ball: false });
    assert_eq!(moves, Moves { passer: PasserMove::Goes, receiver_goes: true });
}

#[test]
fn a_start_is_not_taken_back_when_the_times_change_their_minds() {
    let mut ahead = PassAhead::new(Instant(0));
    let long = Times { receiver: 2.0, passer: 0.2, ball: 1.0, at_ball: false };
    assert!(ahead.step(Instant(0), &long).receiver_goes);
    let short = Times { receiver: 0.5, ..long };
    let moves = ahead.step(Instant(10_000), &short);
    assert_eq!(moves, Moves { passer: PasserMove::Goes, receiver_goes: true });
    assert_eq!(ahead.step(Instant(20_000), &long).passer, PasserMove::Goes);
}

#[test]
fn the_ball_waits_for_a_late_receiver_and_leaves_for_one_in_time() {
    let mut ahead = PassAhead::new(Instant(0));
    let at_ball = |receiver: f32| Times { receiver, passer: 0.0, ball: 1.0, at_ball: true };
    assert_eq!(
        ahead.step(Instant(0), &at_ball(1.5)).passer,
        PasserMove::Waits,
        "T_r > T_p: the receiver first"
    );
    assert_eq!(ahead.step(Instant(400_000), &at_ball(1.1)).passer, PasserMove::Waits);
    assert_eq!(ahead.step(Instant(500_000), &at_ball(1.0)).passer, PasserMove::Shoots);
    // The state remains "shot".
    assert_eq!(ahead.step(Instant(900_000), &at_ball(9.0)).passer, PasserMove::Shoots);
}

#[test]
fn a_pass_that_never_comes_together_is_given_up() {
    let mut ahead = PassAhead::new(Instant(0));
    let never = Times { receiver: 3.0, passer: 0.5, ball: 1.0, at_ball: false };
    ahead.step(Instant(0), &never);
    let late = Instant(0) + SEARCH_TIME + Duration::millis(10);
    let moves = ahead.step(late, &never);
    assert!(
        matches!(moves.passer, PasserMove::GivesUp { after } if after > SEARCH_TIME) && !moves.receiver_goes
    );
}

#[test]
fn places_and_times_by_hand() {
    use geometry::Vector;
    let rating = super::super::scene::tests::rating_for_tests((2.0, 0.0), false);
    let places = Places::of(Point::new(0.0, 0.0), &rating);
    // 0.09 + 0.0215 − 0.01 = 0.1015 m behind the ball; the receiver beyond x*, facing it.
    assert!(places.passer.0.distance(Point::new(-0.1015, 0.0)) < 1e-5 && places.passer.1 == Angle::ZERO);
    assert!(places.receiver.0.distance(Point::new(2.1015, 0.0)) < 1e-5);
    assert!((places.receiver.1 - Angle::HALF_TURN).abs() < 1e-5);
    let robot = |x: f32, heading: f32| ViewRobot {
        id: protocol::RobotId::ZERO,
        position: Point::new(x, 0.0),
        heading: Angle::degrees(heading),
        velocity: Vector::default(),
    };
    let limits = FreeLimits::default();
    // 1 m to drive: 1.069045 s; 170° to turn on the spot: 2.967 rad at 6 rad/s and 30 rad/s²: 2.967/6 + 0.2 =
    // 0.694510 s.
    let times = Times::of(&places, &robot(-1.1015, 0.0), &robot(2.1015, 10.0), 0.9, &limits);
    assert!(
        (times.passer - 1.069_045).abs() < 0.01 && (times.receiver - 0.694_510).abs() < 1e-3,
        "{times:?}"
    );
    assert!(!times.at_ball && (times.pass() - times.passer - 0.9).abs() < 1e-6);
    assert!(Times::of(&places, &robot(-0.1015, 1.0), &robot(2.1015, 180.0), 0.9, &limits).at_ball);
    assert!(
        !Times::of(&places, &robot(-0.1015, 5.0), &robot(2.1015, 180.0), 0.9, &limits).at_ball,
        "it looks aside"
    );
}
