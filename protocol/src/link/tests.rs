//! Does a robot believe what its mates and its host say, and nothing else?

extern crate std;

use super::*;
use crate::host::{Command, Directive, Duty, WorldPart};
use crate::host_link::HostLink;
use crate::team::{Beacon, Progress, Role, Status};
use rules::Phase;

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn beacon(case_base: u32) -> TeamMessage {
    TeamMessage::Beacon(Beacon {
        pose: crate::quantized::WirePose::default(),
        ball: None,
        status: Status::AVAILABLE,
        case_base,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    })
}

fn link(me: u8, epoch: u32) -> Link {
    Link::new(TeamId(1), robot(me), TeamKey::ZERO, epoch)
}

fn host(epoch: u32) -> HostLink {
    HostLink::new(TeamId(1), TeamKey::ZERO, epoch)
}

fn stand(to: u8) -> HostMessage {
    let directive = Directive::Stand;
    HostMessage::Command(Command {
        to: robot(to),
        defending: geometry::GoalEnd::Negative,
        phase: Phase::Halt,
        duty: Duty::Player,
        directive,
    })
}

fn world(picture: u8, part: u8, parts: u8) -> HostMessage {
    let robots = heapless::Vec::new();
    let phase = Phase::Run;
    HostMessage::World(WorldPart { picture, part, parts, phase, placement: None, ball: None, robots })
}

fn welcome(to: u8, life: u32) -> HostMessage {
    HostMessage::Welcome(Welcome { to: robot(to), life })
}

/// A robot and its host that know each other.
fn acquainted() -> (Link, HostLink) {
    let (mut link, mut host) = (link(2, 9), host(70));
    assert!(host.open(&link.seal(&beacon(0))).is_ok());
    assert_eq!(host.life(robot(2)), Some(9));
    assert!(link.open(&host.seal(&welcome(2, 9))).is_ok());
    (link, host)
}

/// Both hear a first frame of each other, greet, and believe from then on.
fn acquaint(a: &mut Link, b: &mut Link) {
    let (from_a, from_b) = (a.seal(&beacon(0)), b.seal(&beacon(0)));
    assert!(matches!(b.open(&from_a), Err(Refusal::Stranger { .. })));
    assert!(matches!(a.open(&from_b), Err(Refusal::Stranger { .. })));
    let now = Instant(0);
    let (greets_b, greets_a) = (a.poll_greeting(now).unwrap(), b.poll_greeting(now).unwrap());
    assert!(a.open(&greets_a).is_ok() && b.open(&greets_b).is_ok());
}

#[test]
fn what_one_seals_another_opens_once() {
    let (mut a, mut b) = (link(1, 0), link(2, 0));
    acquaint(&mut a, &mut b);
    let packet = a.seal(&beacon(7));
    assert_eq!(b.open(&packet), Ok(Heard::Mate(robot(1), beacon(7))));
    // After a first frame and a greeting.
    assert_eq!(b.open(&packet), Err(Refusal::Counter { seen: 3, last: 3 }));
    assert_eq!(b.refused()[5], 1);
}

#[test]
fn a_forged_packet_does_not_move_the_counter() {
    let (mut a, mut b) = (link(1, 0), link(2, 0));
    acquaint(&mut a, &mut b);
    let good = a.seal(&beacon(7));
    let mut forged = good.clone();
    forged[7] = 200;
    assert_eq!(b.open(&forged), Err(Refusal::Tag));
    assert!(b.open(&good).is_ok());
}

#[test]
fn frames_of_an_earlier_life_are_refused() {
    let (mut old, mut new, mut b) = (link(1, 4), link(1, 5), link(2, 0));
    let late = old.seal(&beacon(1));
    acquaint(&mut new, &mut b);
    assert!(b.open(&new.seal(&beacon(2))).is_ok());
    assert_eq!(b.open(&late), Err(Refusal::Epoch { seen: 4, current: 5 }));
}

#[test]
fn a_host_is_a_stranger_until_it_welcomes_this_life_of_this_robot() {
    let (mut a, mut host) = (link(2, 9), host(70));
    let stranger = Err(Refusal::Stranger { epoch: 70 });
    assert_eq!(a.open(&host.seal(&stand(2))), stranger);
    assert_eq!(a.open(&host.seal(&welcome(2, 8))), stranger, "an earlier life");
    assert_eq!(a.open(&host.seal(&welcome(3, 9))), stranger, "another robot");
    assert_eq!(a.refused()[8], 3);
    assert!(a.open(&host.seal(&welcome(2, 9))).is_ok());
    assert_eq!(a.open(&host.seal(&stand(2))), Ok(Heard::Host(stand(2))));
    assert_eq!(
        a.open(&host.seal(&stand(3))),
        Ok(Heard::Host(stand(3))),
        "whose command it is, the reader sees"
    );
}

#[test]
fn after_a_boot_a_recording_of_the_host_moves_nobody() {
    let (mut before, mut host) = acquainted();
    let recorded = [host.seal(&welcome(2, 9)), host.seal(&stand(2)), host.seal(&world(0, 0, 1))];
    for packet in &recorded {
        assert!(before.open(packet).is_ok());
    }
    let mut after = link(2, 10);
    for packet in &recorded {
        assert_eq!(after.open(packet), Err(Refusal::Stranger { epoch: 70 }));
    }
}

#[test]
fn a_host_that_starts_again_takes_over_and_the_old_one_is_refused() {
    let (mut a, mut old) = acquainted();
    let mut new = host(71);
    assert_eq!(a.open(&new.seal(&stand(2))), Err(Refusal::Stranger { epoch: 71 }));
    assert!(a.open(&old.seal(&stand(2))).is_ok(), "a stranger moves nothing");
    assert!(a.open(&new.seal(&welcome(2, 9))).is_ok());
    assert!(a.open(&new.seal(&stand(2))).is_ok());
    assert_eq!(a.open(&old.seal(&stand(2))), Err(Refusal::Epoch { seen: 70, current: 71 }));
}

#[test]
fn a_host_hears_robots_and_refuses_hosts() {
    let (mut a, mut host) = acquainted();
    let telemetry = TeamMessage::Telemetry(Telemetry { battery: 1640, ..Telemetry::default() });
    assert_eq!(host.open(&a.seal(&telemetry)), Ok((robot(2), telemetry)));
    let mut second = HostLink::new(TeamId(1), TeamKey::ZERO, 71);
    assert_eq!(host.open(&second.seal(&stand(2))), Err(Refusal::Sender(16)));
    let mut foreign = Link::new(TeamId(2), robot(2), TeamKey::ZERO, 9);
    assert_eq!(host.open(&foreign.seal(&telemetry_of(0))), Err(Refusal::Team(TeamId(2))));
    assert_eq!((host.refused()[3], host.refused()[2]), (1, 1));
}

fn telemetry_of(battery: u16) -> TeamMessage {
    TeamMessage::Telemetry(Telemetry { battery, ..Telemetry::default() })
}

#[test]
fn a_part_that_cannot_be_is_no_message() {
    let (mut a, mut host) = acquainted();
    for (part, parts) in [(0, 0), (2, 2), (3, 2), (0, PARTS_MAX as u8 + 1), (255, 255)] {
        assert_eq!(a.open(&host.seal(&world(1, part, parts))), Err(Refusal::Payload), "{part} of {parts}");
    }
    let mut payload = [0; 64];
    let len = postcard::to_slice(&stand(2), &mut payload).unwrap().len();
    assert_eq!(decode::<HostMessage>(&payload[..len]), Some(stand(2)));
    assert_eq!(decode::<HostMessage>(&payload[..=len]), None, "a byte too many");
    assert_eq!(decode::<HostMessage>(&payload[..len - 1]), None, "a byte too few");
}

#[test]
fn what_is_lost_of_pictures_is_counted_by_their_numbers() {
    let (mut a, mut host) = acquainted();
    // Of pictures 254, 255, 0, 1, 2 with two parts each: all of 254, half of 255, nothing of 0 and 1, all of 2.
    for (picture, part) in [(254, 0), (254, 1), (255, 1), (2, 0), (2, 1)] {
        assert!(a.open(&host.seal(&world(picture, part, 2))).is_ok());
    }
    let mut telemetry = Telemetry { silence: 3, ..Telemetry::default() };
    a.tell(&mut telemetry);
    assert_eq!((telemetry.heard, telemetry.lost, telemetry.picture), (5, 5, 2));
    assert_eq!((telemetry.refused, telemetry.silence), ([0; Refusal::KINDS], 3));
}

#[test]
fn refusals_of_every_kind_reach_the_hosts_telemetry_each_in_its_place() {
    let (mut a, mut host) = acquainted();
    let good = host.seal(&stand(2));
    let sealed = |sender: Sender, epoch: u32, counter: u32, payload: &[u8]| {
        packet(&Frame { team: TeamId(1), sender, epoch, counter, payload }, &TeamKey::ZERO)
    };
    let mut forged = good.clone();
    forged[7] = 200;
    let refused = [
        Packet::from_slice(&[0; 18]).unwrap(),
        Packet::from_slice(&[9; 30]).unwrap(),
        link(3, 1).seal(&beacon(0)),
        sealed(Sender::Host, 69, 1, &[]),
        sealed(Sender::Host, 70, 1, &[]),
        forged,
        sealed(Sender::Host, 70, 500, &[0xff; 3]),
        sealed(Sender::Host, 71, 1, &[0xff; 3]),
    ];
    let kinds = [0, 1, 2, 4, 5, 6, 7, 8];
    let mut expected = [0; Refusal::KINDS];
    for (times, (mut packet, kind)) in refused.into_iter().zip(kinds).enumerate() {
        if kind == 2 {
            packet[1] = 7;
        }
        for _ in 0..=times {
            let refusal = a.open(&packet).unwrap_err();
            // The unreadable one is news only once.
            let kind = if refusal.kind() == 5 { 5 } else { kind };
            assert_eq!(refusal.kind(), kind);
            expected[kind] += 1;
        }
    }
    // No such sender; and our own words, which a base station that sends to all gives us back: no sign of trouble.
    let mut nobody = good.clone();
    nobody[2] = 17;
    assert_eq!(a.open(&nobody), Err(Refusal::Sender(17)));
    let own = a.seal(&beacon(0));
    assert_eq!(a.open(&own), Err(Refusal::Sender(2)));
    expected[3] = 1;
    let mut telemetry = Telemetry::default();
    a.tell(&mut telemetry);
    assert_eq!(telemetry.refused, expected);
    assert!(expected.iter().all(|count| *count > 0), "{expected:?}");
}

#[test]
fn after_a_boot_a_recording_of_a_mate_is_not_believed_and_keeps_the_mate_from_nothing() {
    let (mut mate, mut before) = (link(1, 5), link(2, 8));
    acquaint(&mut mate, &mut before);
    let recorded: std::vec::Vec<Packet> = (0..20).map(|n| mate.seal(&beacon(n))).collect();
    let mut after = link(2, 9);
    for packet in recorded.iter().chain(&recorded) {
        assert_eq!(after.open(packet), Err(Refusal::Stranger { epoch: 5 }));
    }
    let mut born_again = link(1, 6);
    acquaint(&mut born_again, &mut after);
    assert!(after.open(&born_again.seal(&beacon(7))).is_ok());
    for packet in &recorded {
        assert_eq!(after.open(packet), Err(Refusal::Epoch { seen: 5, current: 6 }));
    }
}

#[test]
fn random_bytes_never_panic() {
    let (mut b, mut h) = (link(2, 0), host(1));
    let mut state = 1_u64;
    for round in 0..20_000 {
        let mut bytes = [0_u8; 121];
        for byte in &mut bytes {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *byte = (state >> 56) as u8;
        }
        let len = usize::from(bytes[120]) % 121;
        (bytes[0], bytes[1], bytes[2]) = (1, 1, if round % 2 == 0 { 3 } else { 16 });
        assert!(b.open(&bytes[..len]).is_err());
        assert!(h.open(&bytes[..len]).is_err());
        bytes[0] %= 3;
        let _ = decode::<TeamMessage>(&bytes[..len]);
        let _ = host_message(&bytes[..len]);
    }
}

#[test]
fn what_is_for_somebody_else_is_known_before_it_is_opened() {
    let (mut link, mut host) = acquainted();
    let (mut mate, all) = (self::link(3, 5), &[1, 2, 3, 200][..]);
    for to in [2, 3] {
        for message in [stand(to), welcome(to, 9)] {
            assert_eq!(link.is_for_me(&host.seal(&message)), Ok(to == 2));
        }
    }
    assert_eq!(link.is_for_me(&host.seal(&world(1, 0, 1))), Ok(true));
    assert_eq!(link.is_for_me(&mate.seal(&TeamMessage::Telemetry(Telemetry::default()))), Ok(false));
    for message in [beacon(0), TeamMessage::Greeting(Greeting::default())] {
        assert_eq!(link.is_for_me(&mate.seal(&message)), Ok(true));
    }
    // What is refused without a look at the tag is refused, and counted, at once.
    let own = link.seal(&beacon(0));
    assert_eq!(link.is_for_me(&own), Err(Refusal::Sender(2)));
    assert_eq!(link.is_for_me(all), Err(Refusal::Length(4)));
    assert_eq!((link.refused()[0], link.refused()[3]), (1, 1));
}
