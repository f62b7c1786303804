//! Tests: the radio's rate, its receivers, and its measures of link quality.

use super::*;
use crate::world::{BallModels, Robot};
use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use protocol::Who;
use protocol::host::{Directive, RuleRole};
use protocol::link::{Link, Received as RobotReceived};
use protocol::team::{Progress, Role, Status};
use rules::{Colour, Phase};

const TEAM: TeamId = TeamId(1);

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn ms(n: u64) -> Instant {
    Instant(n * 1000)
}

fn radio(relay: Relay) -> Radio {
    Radio::new(RadioSettings { relay, ..RadioSettings::new(TEAM, 70) })
}

fn situation() -> RadioSituation {
    RadioSituation { us: Colour::Blue, phase: Phase::Run, placement: None }
}

/// `ours` blue and `theirs` yellow robots in a row, all moving at 1 m/s along +x.
fn world(now: Instant, ours: u8, theirs: u8) -> World {
    let mut world = World::empty(now, BallModels::default());
    for (colour, count) in [(Colour::Blue, ours), (Colour::Yellow, theirs)] {
        for n in 0..count {
            let position = Point::<Field>::new(f32::from(n) * 0.5, 0.0);
            world.put(Robot {
                who: Who { colour, id: id(n) },
                pose: Pose { position, heading: Angle::new(0.0) },
                velocity: Vector::new(1.0, 0.0),
                angular: 0.0,
                confidence: 1.0,
                seen: now,
            });
        }
    }
    world
}

fn stand(to: u8) -> HostCommand {
    HostCommand {
        to: id(to),
        defending: GoalEnd::Negative,
        phase: Phase::Run,
        rule_role: RuleRole::Player,
        directive: Directive::Stand,
    }
}

fn beacon() -> TeamMessage {
    TeamMessage::Beacon(Beacon {
        pose: protocol::quantized::WirePose::default(),
        ball: None,
        status: Status::AVAILABLE,
        case_base: 7,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    })
}

fn robot(n: u8) -> Link {
    Link::new(TEAM, id(n), TeamKey::ZERO.of_robot(id(n)), 100 + u32::from(n))
}

fn report(link: &mut Link, now: Instant) -> Packet {
    let mut telemetry = Telemetry::default();
    link.report(now, &mut telemetry);
    link.seal(&TeamMessage::Telemetry(telemetry))
}

/// Makes the robot present: telemetry, welcome, telemetry.
fn join(radio: &mut Radio, link: &mut Link, n: u8, now: Instant) {
    assert!(matches!(radio.handle_packet(now, &report(link, now)), Err(Refusal::Unauthenticated { .. })));
    let welcome = fetch(radio);
    assert!(matches!(deliver(link, n, now, &welcome)[..], [HostMessage::Welcome(_)]));
    assert!(radio.handle_packet(now, &report(link, now)).is_ok());
    assert!(radio.present(now).any(|robot| robot == id(n)) && fetch(radio).is_empty());
}

fn fetch(radio: &mut Radio) -> Vec<(To, Packet)> {
    std::iter::from_fn(|| radio.poll_packet()).collect()
}

/// Delivers the packets that are for `n` to its link; returns the messages it accepted.
fn deliver(link: &mut Link, n: u8, now: Instant, packets: &[(To, Packet)]) -> Vec<HostMessage> {
    let meant = packets.iter().filter(|(to, _)| *to == To::All || *to == To::One(id(n)));
    meant
        .filter_map(|(_, packet)| match link.open(now, packet) {
            Ok(RobotReceived::Host(message)) => Some(message),
            _ => None,
        })
        .collect()
}

#[test]
fn a_snapshot_of_two_teams_goes_to_all_in_parts_and_each_command_to_its_robot() {
    let mut radio = radio(Relay::No);
    for n in [0, 3] {
        join(&mut radio, &mut robot(n), n, ms(1));
    }
    radio.offer(ms(5), &world(ms(5), 6, 6), situation(), &[stand(0), stand(3), stand(3), stand(4)]);
    let packets = fetch(&mut radio);
    let to: Vec<To> = packets.iter().map(|(to, _)| *to).collect();
    // Robot 4 is not there.
    assert_eq!(to, [To::All, To::All, To::One(id(0)), To::One(id(3))]);
    assert!(packets.iter().all(|(_, packet)| packet.len() <= 120));
}

#[test]
fn eleven_robots_receive_a_snapshot_of_twenty_two_in_parts_that_fit() {
    let mut radio = radio(Relay::No);
    let mut links: Vec<Link> = (0..11).map(robot).collect();
    for (n, link) in (0..).zip(&mut links) {
        join(&mut radio, link, n, ms(1));
    }
    radio.offer(ms(5), &world(ms(5), 11, 11), situation(), &[]);
    let packets = fetch(&mut radio);
    assert!(packets.iter().all(|(_, packet)| packet.len() <= 120));
    for (n, link) in (0..).zip(&mut links) {
        let received = deliver(link, n, ms(6), &packets);
        let poses: usize = received
            .iter()
            .map(|message| if let HostMessage::World(part) = message { part.robots.len() } else { 0 })
            .sum();
        assert_eq!((received.len(), poses), (5, 22), "robot {n}");
    }
}

#[test]
fn a_robot_is_welcomed_at_its_first_telemetry_and_gets_all_once_it_names_our_epoch() {
    let mut radio = radio(Relay::No);
    let mut link = robot(2);
    assert!(radio.handle_packet(ms(1), &link.seal(&beacon())).is_err(), "a beacon proves nothing");
    radio.offer(ms(2), &world(ms(2), 1, 0), situation(), &[stand(2)]);
    // One part to an empty audience: a base station learns the host's address from it, no robot uses it.
    let announced = fetch(&mut radio);
    assert_eq!((announced.len(), radio.present(ms(2)).count()), (1, 0));
    assert!(deliver(&mut link, 2, ms(2), &announced).is_empty());
    join(&mut radio, &mut link, 2, ms(3));
    radio.offer(ms(15), &world(ms(15), 1, 0), situation(), &[stand(2)]);
    let received = deliver(&mut link, 2, ms(15), &fetch(&mut radio));
    assert!(matches!(received[..], [HostMessage::World(_), HostMessage::Command(_)]), "{received:?}");
    let HostMessage::World(part) = &received[0] else { unreachable!() };
    // 1 m/s for a latency of 3 ms.
    assert_eq!(part.robots[0].pose.at.x, 3);
    // It is welcomed again after a while.
    radio.offer(ms(103), &world(ms(103), 1, 0), situation(), &[]);
    assert_eq!(fetch(&mut radio).len(), 2);
    // A new boot epoch is welcomed within 20 ms, again and again until it names us.
    let mut booted = Link::new(TEAM, id(2), TeamKey::ZERO.of_robot(id(2)), 999);
    let welcomes = |radio: &mut Radio, link: &mut Link, at| {
        assert!(radio.handle_packet(ms(at), &report(link, ms(at))).is_err());
        fetch(radio)
    };
    assert!(welcomes(&mut radio, &mut booted, 110).is_empty());
    assert_eq!(welcomes(&mut radio, &mut booted, 123).len(), 1);
    assert!(welcomes(&mut radio, &mut booted, 130).is_empty());
    let welcome = welcomes(&mut radio, &mut booted, 143);
    assert_eq!(deliver(&mut booted, 2, ms(143), &welcome).len(), 1);
    assert!(radio.handle_packet(ms(150), &report(&mut booted, ms(150))).is_ok());
    assert_eq!(radio.quality(id(2)).unwrap().lives(), 2);
}

#[test]
fn recorded_frames_of_a_robot_make_a_fresh_host_send_welcomes_and_nothing_else() {
    let (mut before, mut link) = (radio(Relay::ToAll), robot(2));
    join(&mut before, &mut link, 2, ms(0));
    let mut recorded = Vec::new();
    for n in 0..60 {
        recorded.extend([report(&mut link, ms(10 * n)), link.seal(&beacon())]);
    }
    for relay in [Relay::ToEach, Relay::ToAll] {
        let mut fresh = Radio::new(RadioSettings { relay, ..RadioSettings::new(TEAM, 71) });
        let mut other = robot(3);
        join(&mut fresh, &mut other, 3, ms(0));
        let (mut welcomes, mut commands) = (0, 0);
        for (n, packet) in (0..).zip(&recorded) {
            let now = ms(5 * n);
            assert!(fresh.handle_packet(now, packet).is_err(), "frame {n}");
            assert!(fresh.handle_packet(now, &report(&mut other, now)).is_ok());
            fresh.offer(now, &world(now, 4, 4), situation(), &[stand(2), stand(3)]);
            for (to, packet) in fetch(&mut fresh) {
                assert!(!recorded.contains(&packet), "relayed");
                if to == To::One(id(2)) {
                    let keys = TeamKey::ZERO.of_robot(id(2));
                    let message = protocol::link::overhear_host(&packet, TEAM, &keys, id(2)).unwrap();
                    assert!(matches!(message, HostMessage::Welcome(_)), "{message:?}");
                    welcomes += 1;
                }
                commands += u32::from(to == To::One(id(3)));
            }
            assert_eq!(fresh.present(now).collect::<Vec<_>>(), [id(3)]);
        }
        assert!(fresh.quality(id(2)).is_none());
        // 600 ms of replayed frames, a welcome in 20 ms at most.
        assert!(
            (1..=31).contains(&welcomes) && commands > 50,
            "{welcomes} welcomes, {commands} commands to robot 3"
        );
    }
}

/// Offers a snapshot at each of `times` (µs) for a second and serves every deadline; returns when snapshots
/// went out.
fn departures(times: impl Iterator<Item = u64>, until: u64) -> Vec<u64> {
    let mut radio = radio(Relay::No);
    let mut link = robot(0);
    join(&mut radio, &mut link, 0, ms(0));
    let mut reported = 0;
    let mut out = Vec::new();
    let mut times = times.peekable();
    loop {
        let offer = times.peek().copied().unwrap_or(u64::MAX);
        let due = radio.poll_timeout().map_or(u64::MAX, |due| due.0);
        let now = Instant(offer.min(due));
        if now.0 > until {
            return out;
        }
        // Telemetry keeps it present.
        while reported + 100_000 <= now.0 {
            reported += 100_000;
            assert!(radio.handle_packet(Instant(reported), &report(&mut link, Instant(reported))).is_ok());
        }
        if due <= offer {
            radio.handle_timeout(now);
        } else {
            times.next();
            radio.offer(now, &world(now, 1, 0), situation(), &[]);
        }
        out.extend(fetch(&mut radio).iter().filter(|(to, _)| *to == To::All).map(|_| now.0));
    }
}

#[test]
fn snapshots_of_a_trembling_100_hz_camera_all_go_out_at_once() {
    // ± 1 ms around 10 ms.
    let times: Vec<u64> = (0..100).map(|n| 10_000 + n * 10_000 + (n * 7919 % 2000)).collect();
    assert_eq!(departures(times.iter().copied(), 1_010_000), times);
}

#[test]
fn of_too_many_snapshots_a_hundred_a_second_go_out() {
    let out = departures((0..1_000).map(|n| n * 1_000), 999_999);
    assert!((99..=102).contains(&out.len()), "{}", out.len());
}

#[test]
fn of_too_few_snapshots_sixty_a_second_go_out_until_half_a_second_is_over() {
    let out = departures((0..4).map(|n| n * 250_000), 3_000_000);
    let gaps = out.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(gaps.max().unwrap() <= PERIOD_MAX.0);
    let last = *out.last().unwrap();
    assert!((1_220_000..=1_250_000).contains(&last), "{last}");
}

#[test]
fn a_repeated_snapshot_is_carried_forward() {
    let mut radio = radio(Relay::No);
    let mut link = robot(0);
    join(&mut radio, &mut link, 0, ms(0));
    radio.offer(ms(1), &world(ms(1), 1, 0), situation(), &[]);
    deliver(&mut link, 0, ms(1), &fetch(&mut radio));
    let due = radio.poll_timeout().unwrap();
    radio.handle_timeout(Instant(due.0 - 1));
    assert!(fetch(&mut radio).is_empty(), "not yet");
    radio.handle_timeout(due);
    let received = deliver(&mut link, 0, due, &fetch(&mut radio));
    let [HostMessage::World(part)] = &received[..] else { panic!("{received:?}") };
    // 16.6 ms and a latency of 3 ms at 1 m/s, in whole millimetres.
    assert_eq!((part.snapshot, part.robots[0].pose.at.x), (1, 20));
}

#[test]
fn beacons_are_passed_on_unchanged_and_telemetry_is_not() {
    let (mut one, mut two) = (robot(1), robot(2));
    for relay in [Relay::No, Relay::ToEach, Relay::ToAll] {
        let mut radio = radio(relay);
        join(&mut radio, &mut two, 2, ms(0));
        assert!(radio.handle_packet(ms(0), &one.seal(&beacon())).is_err() && fetch(&mut radio).is_empty());
        join(&mut radio, &mut one, 1, ms(0));
        let passed_on = one.seal(&beacon());
        assert!(radio.handle_packet(ms(1), &passed_on).is_ok());
        let passed = fetch(&mut radio);
        assert!(passed.iter().all(|(_, packet)| *packet == passed_on));
        let to: Vec<To> = passed.iter().map(|(to, _)| *to).collect();
        let expected: &[To] = match relay {
            Relay::No => &[],
            Relay::ToEach => &[To::One(id(2))],
            Relay::ToAll => &[To::All],
        };
        assert_eq!(to, expected);
        let telemetry = report(&mut one, ms(2));
        assert!(radio.handle_packet(ms(2), &telemetry).is_ok());
        assert!(fetch(&mut radio).is_empty());
        assert_eq!(radio.handle_packet(ms(3), &telemetry), Err(Refusal::Counter { seen: 5, last: 5 }));
        // Once it is no longer present, none of its frames is forwarded.
        assert!(radio.handle_packet(ms(1_003), &one.seal(&beacon())).is_ok());
        assert!(fetch(&mut radio).is_empty());
        one = robot(1);
        two = robot(2);
    }
}

/// A robot that sends telemetry `held` after each snapshot; the latency is `latency` in each direction, and
/// it receives four of five snapshots.
#[test]
fn round_trip_loss_rate_and_start_up_are_those_of_the_link() {
    let mut radio = radio(Relay::No);
    let mut link = robot(4);
    let (latency, held) = (Duration(1_500), Duration(2_000));
    join(&mut radio, &mut link, 4, ms(0));
    for n in 0..500 {
        let now = ms(10 * n);
        radio.offer(now, &world(now, 4, 0), situation(), &[stand(4)]);
        let packets = fetch(&mut radio);
        if n % 5 == 4 {
            continue;
        }
        deliver(&mut link, 4, now, &packets);
        let mut telemetry =
            Telemetry { battery: 1580, silence: (held.0 / 100) as u16, ..Telemetry::default() };
        link.report(now, &mut telemetry);
        let packet = link.seal(&TeamMessage::Telemetry(telemetry));
        // Of ten of its own frames one is lost.
        if n % 10 != 1 {
            assert!(radio.handle_packet(now + latency + held + latency, &packet).is_ok());
        }
    }
    let quality = radio.quality(id(4)).unwrap();
    let near = |value: Option<f64>, truth: f64, off: f64| (value.unwrap() - truth).abs() <= off;
    // A lost snapshot's number is named before it comes again: telemetry names the newest that came.
    assert!(near(quality.round_trip().mean(), 3.0, 1e-6), "{:?}", quality.round_trip());
    assert!(near(quality.round_trip().max(), 3.0, 1e-6));
    assert!(near(quality.loss_down(), 20.0, 0.5), "{:?}", quality.loss_down());
    assert!(near(quality.loss_up(), 12.5, 0.5), "{:?}", quality.loss_up());
    // 100 snapshots of one part (68 B) and a command (24 B), 10 welcomes (29 B), 70 telemetries (59 B) a
    // second.
    let bits = (100.0 * (part_len(4) + 24.0) + 10.0 * 29.0 + 70.0 * 59.0) * 8.0 * 1e-3;
    assert!(
        near(quality.data_rate().mean(), bits, bits * 0.02),
        "{:?}, not {bits}",
        quality.data_rate().mean()
    );
    assert_eq!(quality.start_up(), Some(latency + held + latency));
    assert!(near(quality.battery().map(f64::from), 15.8, 1e-4));
    let table = table([(id(4), quality)].into_iter(), radio.foreign());
    assert!(
        table.contains("    4      3.00    0.00     3.00") && table.ends_with("interference: no\n"),
        "{table}"
    );
}

/// Bytes of a part to one robot without placement and ball and with that number of robots: header, audience,
/// a tag, variant, snapshot, part, parts, phase, two options, a length, eleven bytes a robot.
fn part_len(robots: u8) -> f64 {
    f64::from(11 + 2 + 3 + 1 + 3 + 1 + 2 + 1 + 11 * u32::from(robots))
}

#[test]
fn a_robot_that_falls_silent_is_not_present_and_foreign_frames_are_interference() {
    let mut radio = radio(Relay::No);
    join(&mut radio, &mut robot(1), 1, ms(0));
    assert_eq!(radio.present(ms(900)).collect::<Vec<_>>(), [id(1)]);
    assert_eq!(radio.present(ms(1_100)).count(), 0);
    assert_eq!(radio.quality(id(1)).unwrap().silence(ms(1_100)), Some(Duration::millis(1_100)));
    assert!(radio.quality(id(2)).is_none());
    let mut foreign = Link::new(TeamId(2), id(1), TeamKey::ZERO.of_robot(id(1)), 1);
    let mut forged = Link::new(TEAM, id(1), TeamKey([1; 16]).of_robot(id(1)), 9_999);
    let mut second = Radio::new(RadioSettings::new(TEAM, 71));
    join(&mut second, &mut robot(1), 1, ms(0));
    second.offer(ms(0), &world(ms(0), 1, 0), situation(), &[]);
    for packet in [foreign.seal(&beacon()), report(&mut forged, ms(1)), fetch(&mut second)[0].1.clone()] {
        assert!(radio.handle_packet(ms(1), &packet).is_err());
    }
    assert_eq!(radio.foreign(), 3);
}

#[test]
fn robots_beyond_the_capacity_are_left_out_and_packets_not_fetched_are_bounded() {
    let mut radio = radio(Relay::No);
    let commands: Vec<HostCommand> = (0..16).map(stand).collect();
    for n in 0..16 {
        join(&mut radio, &mut robot(n), n, ms(0));
    }
    for n in 0..50 {
        radio.offer(ms(n * 10), &world(ms(n * 10), 16, 16), situation(), &commands);
    }
    let packets = fetch(&mut radio);
    // 24 robots in eight parts for an audience of sixteen, as many commands; and sixteen welcomes each 100 ms
    // after the first.
    assert_eq!((packets.len(), radio.dropped()), (OUT_MAX, (50 * 24 + 4 * 16 - OUT_MAX) as u32));
}

#[test]
fn limits_go_to_one_robot_with_each_snapshot_and_only_if_some_are_set() {
    let mut radio = radio(Relay::No);
    let mut links = [robot(0), robot(3)];
    for (link, n) in links.iter_mut().zip([0, 3]) {
        join(&mut radio, link, n, ms(1));
    }
    let mut told = |radio: &mut Radio, now: Instant| {
        radio.offer(now, &world(now, 2, 2), situation(), &[]);
        let packets = fetch(radio);
        let messages = links.iter_mut().zip([0, 3]).flat_map(|(link, n)| deliver(link, n, now, &packets));
        let limits = messages.filter_map(|message| match message {
            HostMessage::Limits(limits) => Some((limits.to.number(), limits.speed, limits.acceleration)),
            _ => None,
        });
        limits.collect::<Vec<_>>()
    };
    assert_eq!(told(&mut radio, ms(20)), []);
    radio.limit(1500, DriveLimits::NONE);
    let mut both = [told(&mut radio, ms(40)), told(&mut radio, ms(60))].concat();
    both.sort_unstable();
    assert_eq!(both, [(0, 1500, DriveLimits::NONE), (3, 1500, DriveLimits::NONE)]);
}

#[test]
fn a_robot_flashed_with_another_number_is_led_and_reported_by_its_shell() {
    let mut given = [None; RobotId::COUNT];
    given[4] = Some(id(0));
    let numbers = RobotNumbers::new(given).unwrap();
    let settings = RadioSettings { relay: Relay::No, numbers, ..RadioSettings::new(TEAM, 70) };
    let (mut radio, mut link) = (Radio::new(settings), robot(0));
    assert!(radio.handle_packet(ms(1), &report(&mut link, ms(1))).is_err());
    let welcome = fetch(&mut radio);
    assert!(matches!(deliver(&mut link, 0, ms(1), &welcome)[..], [HostMessage::Welcome(_)]));
    let telemetry = radio.handle_packet(ms(1), &report(&mut link, ms(1)));
    assert!(matches!(telemetry, Ok(RadioReceived::Telemetry(shell, _)) if shell == id(4)));
    assert!(
        radio.present(ms(1)).eq([id(4)]) && radio.quality(id(4)).is_some() && radio.quality(id(0)).is_none()
    );

    let pass = HostCommand {
        directive: Directive::Pass {
            at: protocol::quantized::WirePoint::default(),
            receiver: id(4),
            kick: protocol::host::KickOrder::Flat(300),
            ready: true,
        },
        ..stand(4)
    };
    radio.offer(ms(5), &world(ms(5), 6, 6), situation(), &[stand(0), pass]);
    let packets = fetch(&mut radio);
    let messages = deliver(&mut link, 0, ms(6), &packets);
    // The robot on shell 4 stands at x = 2 m, and finds itself there as number 0.
    let ours = messages.iter().find_map(|message| match message {
        HostMessage::World(part) => part.robots.iter().find(|robot| u8::from(robot.who) == 0),
        _ => None,
    });
    assert!((2_000..2_020).contains(&ours.unwrap().pose.at.x), "{ours:?}");
    let command = messages.iter().find_map(|message| match message {
        HostMessage::Command(command) => Some(command.clone()),
        _ => None,
    });
    let command = command.unwrap();
    assert_eq!(command.to, id(0));
    assert!(
        matches!(command.directive, Directive::Pass { receiver, .. } if receiver == id(0)),
        "{command:?}"
    );
}
