//! Does the radio speak as often as it should, to whom it should, and does it know how well it is heard?

use super::*;
use crate::world::{BallModels, Robot};
use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use protocol::Who;
use protocol::host::{Directive, Duty};
use protocol::link::{Heard as RobotHeard, Link};
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

fn situation() -> Situation {
    Situation { us: Colour::Blue, phase: Phase::Run, placement: None }
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

fn stand(to: u8) -> Command {
    Command {
        to: id(to),
        defending: GoalEnd::Negative,
        phase: Phase::Run,
        duty: Duty::Player,
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
    Link::new(TEAM, id(n), TeamKey::ZERO, 100 + u32::from(n))
}

fn fetch(radio: &mut Radio) -> Vec<(To, Packet)> {
    std::iter::from_fn(|| radio.poll_packet()).collect()
}

/// Hands the packets that are for `n` to its link; gives what it believed.
fn deliver(link: &mut Link, n: u8, packets: &[(To, Packet)]) -> Vec<HostMessage> {
    let meant = packets.iter().filter(|(to, _)| *to == To::All || *to == To::One(id(n)));
    meant
        .filter_map(|(_, packet)| match link.open(packet) {
            Ok(RobotHeard::Host(message)) => Some(message),
            _ => None,
        })
        .collect()
}

#[test]
fn a_picture_of_two_teams_goes_to_all_in_parts_and_each_command_to_its_robot() {
    let mut radio = radio(Relay::No);
    radio.offer(ms(5), &world(ms(5), 6, 6), situation(), &[stand(0), stand(3), stand(3)]);
    let packets = fetch(&mut radio);
    let to: Vec<To> = packets.iter().map(|(to, _)| *to).collect();
    assert_eq!(to, [To::All, To::All, To::One(id(0)), To::One(id(3))]);
    assert!(packets.iter().all(|(_, packet)| packet.len() <= 120));
}

#[test]
fn a_robot_is_welcomed_when_it_is_first_heard_and_then_hears_everything() {
    let mut radio = radio(Relay::No);
    let mut link = robot(2);
    radio.offer(ms(0), &world(ms(0), 1, 0), situation(), &[stand(2)]);
    assert!(deliver(&mut link, 2, &fetch(&mut radio)).is_empty(), "a stranger's words");
    assert!(radio.handle_packet(ms(3), &link.seal(&beacon())).is_ok());
    assert_eq!(deliver(&mut link, 2, &fetch(&mut radio)).len(), 1, "the welcome");
    radio.offer(ms(10), &world(ms(10), 1, 0), situation(), &[stand(2)]);
    let heard = deliver(&mut link, 2, &fetch(&mut radio));
    assert!(matches!(heard[..], [HostMessage::World(_), HostMessage::Command(_)]), "{heard:?}");
    let HostMessage::World(part) = &heard[0] else { unreachable!() };
    // 1 m/s for the 3 ms of the way.
    assert_eq!(part.robots[0].pose.at.x, 3);
    // A new life is welcomed at once, an old one again after a while.
    let mut booted = Link::new(TEAM, id(2), TeamKey::ZERO, 999);
    assert!(radio.handle_packet(ms(12), &booted.seal(&beacon())).is_ok());
    assert_eq!(deliver(&mut booted, 2, &fetch(&mut radio)).len(), 1);
    assert!(radio.handle_packet(ms(20), &booted.seal(&beacon())).is_ok());
    assert!(fetch(&mut radio).is_empty());
    assert!(radio.handle_packet(ms(120), &booted.seal(&beacon())).is_ok());
    assert_eq!(fetch(&mut radio).len(), 1);
    assert_eq!(radio.quality(id(2)).unwrap().lives(), 2);
}

/// Offers a picture at each of `times` (µs) for a second and serves every deadline; gives when pictures went out.
fn departures(times: impl Iterator<Item = u64>, until: u64) -> Vec<u64> {
    let mut radio = radio(Relay::No);
    let mut out = Vec::new();
    let mut times = times.peekable();
    loop {
        let offer = times.peek().copied().unwrap_or(u64::MAX);
        let due = radio.poll_timeout().map_or(u64::MAX, |due| due.0);
        let now = Instant(offer.min(due));
        if now.0 > until {
            return out;
        }
        if due <= offer {
            radio.handle_timeout(now);
        } else {
            times.next();
            radio.offer(now, &world(now, 1, 0), situation(), &[]);
        }
        out.extend(fetch(&mut radio).iter().map(|_| now.0));
    }
}

#[test]
fn pictures_of_a_trembling_100_hz_camera_all_go_out_at_once() {
    // ± 1 ms around 10 ms.
    let times: Vec<u64> = (0..100).map(|n| 10_000 + n * 10_000 + (n * 7919 % 2000)).collect();
    assert_eq!(departures(times.iter().copied(), 1_010_000), times);
}

#[test]
fn of_too_many_pictures_a_hundred_a_second_go_out() {
    let out = departures((0..1_000).map(|n| n * 1_000), 999_999);
    assert!((99..=102).contains(&out.len()), "{}", out.len());
}

#[test]
fn of_too_few_pictures_sixty_a_second_go_out_until_half_a_second_is_over() {
    let out = departures((0..4).map(|n| n * 250_000), 3_000_000);
    let gaps = out.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(gaps.max().unwrap() <= PERIOD_MAX.0);
    let last = *out.last().unwrap();
    assert!((1_220_000..=1_250_000).contains(&last), "{last}");
}

#[test]
fn a_repeated_picture_is_carried_forward() {
    let mut radio = radio(Relay::No);
    let mut link = robot(0);
    assert!(radio.handle_packet(ms(0), &link.seal(&beacon())).is_ok());
    radio.offer(ms(1), &world(ms(1), 1, 0), situation(), &[]);
    deliver(&mut link, 0, &fetch(&mut radio));
    let due = radio.poll_timeout().unwrap();
    radio.handle_timeout(Instant(due.0 - 1));
    assert!(fetch(&mut radio).is_empty(), "not yet");
    radio.handle_timeout(due);
    let heard = deliver(&mut link, 0, &fetch(&mut radio));
    let [HostMessage::World(part)] = &heard[..] else { panic!("{heard:?}") };
    // 16.6 ms and 3 ms of way at 1 m/s, in whole millimetres.
    assert_eq!((part.picture, part.robots[0].pose.at.x), (1, 20));
}

#[test]
fn beacons_are_passed_on_unchanged_and_telemetry_is_not() {
    let (mut one, mut two) = (robot(1), robot(2));
    for relay in [Relay::No, Relay::ToEach, Relay::ToAll] {
        let mut radio = radio(relay);
        let others: Vec<Packet> = vec![two.seal(&beacon()), one.seal(&beacon())];
        assert!(radio.handle_packet(ms(0), &others[0]).is_ok());
        fetch(&mut radio);
        assert!(radio.handle_packet(ms(1), &others[1]).is_ok());
        let passed: Vec<_> =
            fetch(&mut radio).into_iter().filter(|(_, packet)| *packet == others[1]).collect();
        let to: Vec<To> = passed.iter().map(|(to, _)| *to).collect();
        let expected: &[To] = match relay {
            Relay::No => &[],
            Relay::ToEach => &[To::One(id(2))],
            Relay::ToAll => &[To::All],
        };
        assert_eq!(to, expected);
        let telemetry = one.seal(&TeamMessage::Telemetry(Telemetry::default()));
        assert!(radio.handle_packet(ms(2), &telemetry).is_ok());
        assert!(fetch(&mut radio).is_empty());
        assert_eq!(radio.handle_packet(ms(3), &telemetry), Err(Refusal::Counter { seen: 2, last: 2 }));
        one = robot(1);
        two = robot(2);
    }
}

/// A robot that tells of itself `held` after each picture; the way takes `way` each way, and of five pictures it hears four.
#[test]
fn round_trip_loss_rate_and_start_up_are_those_of_the_link() {
    let mut radio = radio(Relay::No);
    let mut link = robot(4);
    let (way, held) = (Duration(1_500), Duration(2_000));
    assert!(radio.handle_packet(ms(0), &link.seal(&beacon())).is_ok());
    for n in 0..500 {
        let now = ms(10 * n);
        radio.offer(now, &world(now, 4, 0), situation(), &[stand(4)]);
        let packets = fetch(&mut radio);
        if n % 5 == 4 {
            continue;
        }
        deliver(&mut link, 4, &packets);
        let mut telemetry =
            Telemetry { battery: 1580, silence: (held.0 / 100) as u16, ..Telemetry::default() };
        link.tell(&mut telemetry);
        let packet = link.seal(&TeamMessage::Telemetry(telemetry));
        // Of ten of its own words one is lost.
        if n % 10 != 1 {
            assert!(radio.handle_packet(now + way + held + way, &packet).is_ok());
        }
    }
    let quality = radio.quality(id(4)).unwrap();
    let near = |value: Option<f64>, truth: f64, off: f64| (value.unwrap() - truth).abs() <= off;
    // A lost picture is told of before it comes again: telemetry names the newest that came.
    assert!(near(quality.round_trip().mean(), 3.0, 1e-6), "{:?}", quality.round_trip());
    assert!(near(quality.round_trip().max(), 3.0, 1e-6));
    assert!(near(quality.loss_down(), 20.0, 0.5), "{:?}", quality.loss_down());
    assert!(near(quality.loss_up(), 12.5, 0.5), "{:?}", quality.loss_up());
    // 100 pictures of one part (71 B) and a command (24 B), 10 welcomes (25 B), 70 telemetries (49 B) a second.
    let bits = (100.0 * (part_len(4) + 24.0) + 10.0 * 25.0 + 70.0 * 49.0) * 8.0 * 1e-3;
    assert!(
        near(quality.data_rate().mean(), bits, bits * 0.02),
        "{:?}, not {bits}",
        quality.data_rate().mean()
    );
    assert_eq!(quality.start_up(), Some(way + held + way));
    assert!(near(quality.battery().map(f64::from), 15.8, 1e-4));
    let table = table([(id(4), quality)].into_iter(), radio.foreign());
    assert!(
        table.contains("    4      3.00    0.00     3.00") && table.ends_with("interference: no\n"),
        "{table}"
    );
}

/// Bytes of a part without placement and ball and with so many robots: overhead, variant, picture, part, parts, phase,
/// two options, a length, eleven bytes a robot.
fn part_len(robots: u8) -> f64 {
    f64::from(19 + 1 + 3 + 1 + 2 + 1 + 11 * u32::from(robots))
}

#[test]
fn a_robot_that_falls_silent_is_not_present_and_foreign_frames_are_interference() {
    let mut radio = radio(Relay::No);
    assert!(radio.handle_packet(ms(0), &robot(1).seal(&beacon())).is_ok());
    assert_eq!(radio.present(ms(900)).collect::<Vec<_>>(), [id(1)]);
    assert_eq!(radio.present(ms(1_100)).count(), 0);
    assert_eq!(radio.quality(id(1)).unwrap().silence(ms(1_100)), Some(Duration::millis(1_100)));
    assert!(radio.quality(id(2)).is_none());
    let mut foreign = Link::new(TeamId(2), id(1), TeamKey::ZERO, 1);
    let mut forged = Link::new(TEAM, id(1), TeamKey([1; 16]), 9_999);
    let mut second = Radio::new(RadioSettings::new(TEAM, 71));
    second.offer(ms(0), &world(ms(0), 1, 0), situation(), &[]);
    for packet in [foreign.seal(&beacon()), forged.seal(&beacon()), fetch(&mut second)[0].1.clone()] {
        assert!(radio.handle_packet(ms(1), &packet).is_err());
    }
    assert_eq!(radio.foreign(), 3);
}

#[test]
fn more_robots_than_fit_are_left_out_and_nobody_fetching_is_no_harm() {
    let mut radio = radio(Relay::No);
    let commands: Vec<Command> = (0..16).map(stand).collect();
    for n in 0..100 {
        radio.offer(ms(n * 10), &world(ms(n * 10), 16, 16), situation(), &commands);
    }
    let packets = fetch(&mut radio);
    assert_eq!((packets.len(), radio.dropped()), (OUT_MAX, (100 * 20 - OUT_MAX) as u32));
}
