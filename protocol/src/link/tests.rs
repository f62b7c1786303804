//! A robot trusts the messages of its authenticated teammates and host, and nothing else.

extern crate std;

use super::*;
use crate::frame::{Audience, TeamKey, packet_to_audience};
use crate::host::Welcome;
use crate::host::{Directive, HostCommand, RuleRole, WorldPart};
use crate::host_link::{HostLink, Opened};
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
    Link::new(TeamId(1), robot(me), TeamKey::ZERO.of_robot(robot(me)), epoch)
}

fn host(epoch: u32) -> HostLink {
    let mut host = HostLink::new(TeamId(1), TeamKey::ZERO, epoch);
    host.set_audience(Audience(1 << 2));
    host
}

const NOW: Instant = Instant(5_000_000);

fn stand(to: u8) -> HostMessage {
    let directive = Directive::Stand;
    HostMessage::Command(HostCommand {
        to: robot(to),
        defending: geometry::GoalEnd::Negative,
        phase: Phase::Halt,
        rule_role: RuleRole::Player,
        directive,
    })
}

fn world(snapshot: u8, part: u8, parts: u8) -> HostMessage {
    let robots = heapless::Vec::new();
    let phase = Phase::Run;
    HostMessage::World(WorldPart { snapshot, part, parts, phase, placement: None, ball: None, robots })
}

fn welcome(to: u8, boot_epoch: u32) -> HostMessage {
    HostMessage::Welcome(Welcome { to: robot(to), boot_epoch, offset: 0 })
}

/// Telemetry of the robot.
fn report(link: &mut Link) -> Packet {
    let mut telemetry = Telemetry::default();
    link.report(NOW, &mut telemetry);
    link.seal(&TeamMessage::Telemetry(telemetry))
}

fn after_handshake() -> (Link, HostLink) {
    let (mut link, mut host) = (link(2, 9), host(70));
    assert!(matches!(host.open(NOW, &report(&mut link)), Ok(Opened::Unauthenticated(..))));
    let welcome = host.welcome(robot(2)).unwrap();
    assert_eq!(welcome, Welcome { to: robot(2), boot_epoch: 9, offset: 0 });
    assert!(link.open(NOW, &host.seal(NOW, &HostMessage::Welcome(welcome))).is_ok());
    assert!(matches!(host.open(NOW, &report(&mut link)), Ok(Opened::Believed(..))));
    assert_eq!(host.boot_epoch(robot(2)), Some(9));
    (link, host)
}

/// Both receive a first frame of each other, exchange handshakes, and trust from then on.
fn shake_hands(a: &mut Link, b: &mut Link) {
    let (from_a, from_b) = (a.seal(&beacon(0)), b.seal(&beacon(0)));
    assert!(matches!(b.open(NOW, &from_a), Err(Refusal::Unauthenticated { .. })));
    assert!(matches!(a.open(NOW, &from_b), Err(Refusal::Unauthenticated { .. })));
    let now = Instant(0);
    let (from_a, from_b) = (a.poll_handshake(now).unwrap(), b.poll_handshake(now).unwrap());
    assert!(a.open(NOW, &from_b).is_ok() && b.open(NOW, &from_a).is_ok());
}

#[test]
fn a_sealed_frame_is_opened_once_by_its_receiver() {
    let (mut a, mut b) = (link(1, 0), link(2, 0));
    shake_hands(&mut a, &mut b);
    let packet = a.seal(&beacon(7));
    assert_eq!(b.open(NOW, &packet), Ok(Received::Teammate(robot(1), beacon(7))));
    // After a first frame and a handshake.
    assert_eq!(b.open(NOW, &packet), Err(Refusal::Counter { seen: 3, last: 3 }));
    assert_eq!(b.refused()[5], 1);
}

#[test]
fn a_forged_packet_does_not_move_the_counter() {
    let (mut a, mut b) = (link(1, 0), link(2, 0));
    shake_hands(&mut a, &mut b);
    let good = a.seal(&beacon(7));
    let mut forged = good.clone();
    forged[7] = 200;
    assert_eq!(b.open(NOW, &forged), Err(Refusal::Tag));
    assert!(b.open(NOW, &good).is_ok());
}

#[test]
fn frames_of_an_earlier_life_are_refused() {
    let (mut old, mut new, mut b) = (link(1, 4), link(1, 5), link(2, 0));
    let late = old.seal(&beacon(1));
    shake_hands(&mut new, &mut b);
    assert!(b.open(NOW, &new.seal(&beacon(2))).is_ok());
    assert_eq!(b.open(NOW, &late), Err(Refusal::Epoch { seen: 4, current: 5 }));
}

#[test]
fn a_host_is_unauthenticated_until_it_welcomes_this_boot_epoch() {
    let (mut a, mut host) = (link(2, 9), host(70));
    let unauthenticated = Err(Refusal::Unauthenticated { epoch: 70 });
    assert_eq!(a.open(NOW, &host.seal(NOW, &stand(2))), unauthenticated);
    assert_eq!(a.open(NOW, &host.seal(NOW, &welcome(2, 8))), unauthenticated, "an earlier boot epoch");
    assert_eq!(a.open(NOW, &host.seal(NOW, &welcome(3, 9))), Ok(Received::Elsewhere), "another robot");
    assert_eq!(a.refused()[8], 2);
    assert!(a.open(NOW, &host.seal(NOW, &welcome(2, 9))).is_ok());
    assert_eq!(a.open(NOW, &host.seal(NOW, &stand(2))), Ok(Received::Host(stand(2))));
    assert_eq!(a.open(NOW, &host.seal(NOW, &stand(3))), Ok(Received::Elsewhere));
}

#[test]
fn only_the_hosts_messages_to_one_other_robot_of_the_team_are_to_another() {
    let (a, mut host) = (link(2, 9), host(70));
    for message in [stand(3), welcome(3, 9)] {
        assert!(a.is_to_another(&host.seal(NOW, &message)), "{message:?}");
    }
    for message in [stand(2), welcome(2, 9), world(1, 0, 1)] {
        assert!(!a.is_to_another(&host.seal(NOW, &message)), "{message:?}");
    }
    let mut of_another_team = host.seal(NOW, &stand(3));
    of_another_team[1] += 1;
    // Counted as refused when it is opened.
    assert!(!a.is_to_another(&of_another_team) && !a.is_to_another(&[]));
    assert!(!a.is_to_another(&link(3, 9).seal(&beacon(7))));
}

#[test]
fn after_a_boot_recorded_frames_of_the_host_are_refused() {
    let (mut before, mut host) = after_handshake();
    let recorded =
        [host.seal(NOW, &welcome(2, 9)), host.seal(NOW, &stand(2)), host.seal(NOW, &world(0, 0, 1))];
    for packet in &recorded {
        assert!(before.open(NOW, packet).is_ok());
    }
    let mut after = link(2, 10);
    for packet in &recorded {
        assert_eq!(after.open(NOW, packet), Err(Refusal::Unauthenticated { epoch: 70 }));
    }
}

#[test]
fn a_host_that_starts_again_takes_over_and_the_old_one_is_refused() {
    let (mut a, mut old) = after_handshake();
    let mut new = host(71);
    assert_eq!(a.open(NOW, &new.seal(NOW, &stand(2))), Err(Refusal::Unauthenticated { epoch: 71 }));
    assert!(a.open(NOW, &old.seal(NOW, &stand(2))).is_ok(), "an unauthenticated host moves nothing");
    assert!(a.open(NOW, &new.seal(NOW, &welcome(2, 9))).is_ok());
    assert!(a.open(NOW, &new.seal(NOW, &stand(2))).is_ok());
    assert_eq!(a.open(NOW, &old.seal(NOW, &stand(2))), Err(Refusal::Epoch { seen: 70, current: 71 }));
}

#[test]
fn a_host_receives_robots_and_refuses_hosts() {
    let (mut a, mut host) = after_handshake();
    let telemetry = TeamMessage::Telemetry(Telemetry { battery: 1640, host: 70, ..Telemetry::default() });
    assert_eq!(host.open(NOW, &a.seal(&telemetry)), Ok(Opened::Believed(robot(2), telemetry)));
    let mut second = HostLink::new(TeamId(1), TeamKey::ZERO, 71);
    assert_eq!(host.open(NOW, &second.seal(NOW, &stand(2))), Err(Refusal::Sender(16)));
    let mut foreign = Link::new(TeamId(2), robot(2), TeamKey::ZERO.of_robot(robot(2)), 9);
    assert_eq!(host.open(NOW, &foreign.seal(&telemetry_of(0))), Err(Refusal::Team(TeamId(2))));
    assert_eq!((host.refused()[3], host.refused()[2]), (1, 1));
}

fn telemetry_of(battery: u16) -> TeamMessage {
    TeamMessage::Telemetry(Telemetry { battery, ..Telemetry::default() })
}

#[test]
fn a_part_that_cannot_be_is_no_message() {
    let (mut a, mut host) = after_handshake();
    for (part, parts) in [(0, 0), (2, 2), (3, 2), (0, PARTS_MAX as u8 + 1), (255, 255)] {
        assert_eq!(
            a.open(NOW, &host.seal(NOW, &world(1, part, parts))),
            Err(Refusal::Payload),
            "{part} of {parts}"
        );
    }
    let mut payload = [0; 64];
    let len = postcard::to_slice(&stand(2), &mut payload).unwrap().len();
    assert_eq!(decode::<HostMessage>(&payload[..len]), Some(stand(2)));
    assert_eq!(decode::<HostMessage>(&payload[..=len]), None, "a byte too many");
    assert_eq!(decode::<HostMessage>(&payload[..len - 1]), None, "a byte too few");
}

#[test]
fn lost_parts_of_snapshots_are_counted_by_their_numbers() {
    let (mut a, mut host) = after_handshake();
    // Of snapshots 254, 255, 0, 1, 2 with two parts each: all of 254, half of 255, nothing of 0 and 1, all
    // of 2.
    for (snapshot, part) in [(254, 0), (254, 1), (255, 1), (2, 0), (2, 1)] {
        assert!(a.open(NOW, &host.seal(NOW, &world(snapshot, part, 2))).is_ok());
    }
    let mut telemetry = Telemetry { silence: 3, ..Telemetry::default() };
    a.report(NOW, &mut telemetry);
    assert_eq!((telemetry.received, telemetry.lost, telemetry.snapshot), (5, 5, 2));
    assert_eq!((telemetry.refused, telemetry.silence), ([0; Refusal::KINDS], 3));
    // Of the next five, two parts were left unopened, two were lost, then all came.
    (0..2).for_each(|_| a.leave_snapshot_unopened());
    for (snapshot, part) in [(4, 1), (5, 0), (5, 1)] {
        assert!(a.open(NOW, &host.seal(NOW, &world(snapshot, part, 2))).is_ok());
    }
    a.report(NOW, &mut telemetry);
    assert_eq!((telemetry.received, telemetry.lost, telemetry.snapshot), (8, 6, 5));
}

#[test]
fn refusals_of_every_kind_reach_the_hosts_telemetry_each_in_its_place() {
    let (mut a, mut host) = after_handshake();
    let good = host.seal(NOW, &stand(2));
    let key = TeamKey::ZERO.of_robot(robot(2)).host;
    let sealed = |sender: Sender, epoch: u32, counter: u32, payload: &[u8]| {
        packet(&Frame { team: TeamId(1), sender, audience: None, epoch, counter, payload }, &key)
    };
    let mut forged = good.clone();
    forged[10] ^= 0x40;
    let now = ticks(NOW);
    let refused = [
        Packet::from_slice(&[0; 18]).unwrap(),
        Packet::from_slice(&[9; 30]).unwrap(),
        link(3, 1).seal(&beacon(0)),
        sealed(Sender::Host, 69, 1, &[]),
        sealed(Sender::Host, 70, 1, &[]),
        forged,
        sealed(Sender::Host, 70, now + 100, &[1, 2, 0xff]),
        sealed(Sender::Host, 71, 1, &[1, 2, 0xff]),
        sealed(Sender::Host, 70, now + 10_000, &[1, 2, 0, 0, 0, 0]),
    ];
    let kinds = [0, 1, 2, 4, 5, 6, 7, 8, 9];
    let mut expected = [0; Refusal::KINDS];
    for (times, (mut packet, kind)) in refused.into_iter().zip(kinds).enumerate() {
        if kind == 2 {
            packet[1] = 7;
        }
        for _ in 0..=times {
            let refusal = a.open(NOW, &packet).unwrap_err();
            // The unreadable one is new only once; one from the future makes the host unauthenticated until
            // its next welcome.
            let kind = if matches!(refusal.kind(), 5 | 8) { refusal.kind() } else { kind };
            assert_eq!(refusal.kind(), kind);
            expected[kind] += 1;
        }
    }
    // An invalid sender; and our own messages, echoed by a base station that sends to all: no sign of an
    // attack.
    let mut nobody = good.clone();
    nobody[2] = 18;
    assert_eq!(a.open(NOW, &nobody), Err(Refusal::Sender(18)));
    let own = a.seal(&beacon(0));
    assert_eq!(a.open(NOW, &own), Err(Refusal::Sender(2)));
    expected[3] = 1;
    let mut telemetry = Telemetry::default();
    a.report(NOW, &mut telemetry);
    assert_eq!(telemetry.refused, expected);
    assert!(expected.iter().all(|count| *count > 0), "{expected:?}");
}

#[test]
fn a_frame_that_was_withheld_is_stale_after_200_ms_and_moves_nothing() {
    let (mut a, mut host) = after_handshake();
    let withheld: std::vec::Vec<Packet> =
        (0..50).map(|n| host.seal(NOW + Duration::millis(10 * n), &stand(2))).collect();
    // Delivered one after the other, each 10 ms after the last: the first one 250 ms late.
    for (n, packet) in (0..).zip(&withheld) {
        assert_eq!(a.open(NOW + Duration::millis(250 + 10 * n), packet), Err(Refusal::Stale), "{n}");
    }
    let now = NOW + Duration::millis(800);
    let fresh = host.seal(now, &stand(2));
    assert_eq!(a.open(now + Duration::millis(150), &fresh), Ok(Received::Host(stand(2))));
    assert!((149_000..152_000).contains(&a.age().0), "{:?}", a.age());
}

#[test]
fn a_withheld_welcome_of_a_dead_host_does_not_lead_a_robot() {
    let mut a = link(2, 9);
    let mut host = host(70);
    assert!(host.open(NOW, &report(&mut a)).is_ok());
    let welcome = HostMessage::Welcome(host.welcome(robot(2)).unwrap());
    let (welcome, command) = (host.seal(NOW, &welcome), host.seal(NOW, &stand(2)));
    let late = NOW + Duration::millis(5_000);
    assert_eq!(a.open(late, &welcome), Err(Refusal::Stale));
    assert_eq!(a.open(late, &command), Err(Refusal::Unauthenticated { epoch: 70 }));
    assert_eq!(a.host_epoch(), None);
}

#[test]
fn a_robot_whose_clock_stood_still_refuses_old_frames_until_a_welcome() {
    let (mut a, mut host) = after_handshake();
    // The host's clock has advanced by ten seconds, the robot's has not.
    let later = NOW + Duration::millis(10_000);
    assert_eq!(a.open(NOW, &host.seal(later, &stand(2))), Err(Refusal::Stale));
    assert_eq!(a.open(NOW, &host.seal(later, &stand(2))), Err(Refusal::Unauthenticated { epoch: 70 }));
    assert!(host.open(later, &report(&mut a)).is_ok());
    let welcome = HostMessage::Welcome(host.welcome(robot(2)).unwrap());
    assert!(a.open(NOW, &host.seal(later, &welcome)).is_ok());
    assert!(a.open(NOW, &host.seal(later, &stand(2))).is_ok());
}

#[test]
fn another_robots_keys_make_no_frame_of_the_host_that_this_robot_believes() {
    let (mut a, mut host) = after_handshake();
    let stolen = TeamKey::ZERO.of_robot(robot(3));
    let command = host.seal(NOW, &stand(2));
    let frame = Frame::parse(&command, TeamId(1)).unwrap();
    let forged = Frame { counter: frame.counter + 1, ..frame };
    for key in [&stolen.host, &stolen.team] {
        assert_eq!(a.open(NOW, &packet(&forged, key)), Err(Refusal::Tag));
    }
    // A part of a snapshot with the stolen key's tag in every place.
    let mut payload = [0; 64];
    let payload = &*postcard::to_slice(&world(1, 0, 1), &mut payload).unwrap();
    let audience = Audience(1 << 2 | 1 << 3);
    let forged = Frame { audience: Some(audience), payload, ..forged };
    let mut bytes = packet_to_audience(&forged, &TeamKey([1; 16]).of_team());
    let tags = bytes.len() - 6;
    for key in [&stolen.host, &stolen.team] {
        let [x, y, z, ..] = key.tag(&bytes[..tags]).to_le_bytes();
        bytes[tags..].copy_from_slice(&[x, y, z, x, y, z]);
        assert_eq!(a.open(NOW, &bytes), Err(Refusal::Tag));
    }
    // Also refused: a command that only a short tag would protect.
    let mut payload = [0; 64];
    let payload = &*postcard::to_slice(&stand(2), &mut payload).unwrap();
    let smuggled = Frame { payload, ..forged };
    let smuggled = packet_to_audience(&smuggled, &TeamKey::ZERO.of_team());
    assert_eq!(a.open(NOW, &smuggled), Ok(Received::Elsewhere));
    assert!(a.open(NOW, &command).is_ok(), "nothing of it moved the counter");
}

#[test]
fn after_a_boot_recordings_of_a_teammate_are_refused_without_harm_to_it() {
    let (mut teammate, mut before) = (link(1, 5), link(2, 8));
    shake_hands(&mut teammate, &mut before);
    let recorded: std::vec::Vec<Packet> = (0..20).map(|n| teammate.seal(&beacon(n))).collect();
    let mut after = link(2, 9);
    for packet in recorded.iter().chain(&recorded) {
        assert_eq!(after.open(NOW, packet), Err(Refusal::Unauthenticated { epoch: 5 }));
    }
    let mut rebooted = link(1, 6);
    shake_hands(&mut rebooted, &mut after);
    assert!(after.open(NOW, &rebooted.seal(&beacon(7))).is_ok());
    for packet in &recorded {
        assert_eq!(after.open(NOW, packet), Err(Refusal::Epoch { seen: 5, current: 6 }));
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
        (bytes[0], bytes[1], bytes[2]) = (2, 1, [3, 16, 17][round % 3]);
        assert!(matches!(b.open(NOW, &bytes[..len]), Err(_) | Ok(Received::Elsewhere)));
        assert!(h.open(NOW, &bytes[..len]).is_err());
        bytes[0] %= 3;
        let _ = decode::<TeamMessage>(&bytes[..len]);
        let _ = host_message(&bytes[..len]);
    }
}

#[test]
fn frames_for_other_receivers_are_neither_opened_nor_counted() {
    let (mut link, mut host) = after_handshake();
    let mut teammate = self::link(3, 5);
    let telemetry = teammate.seal(&TeamMessage::Telemetry(Telemetry::default()));
    let others = [host.seal(NOW, &stand(3)), host.seal(NOW, &welcome(3, 9)), telemetry];
    host.set_audience(Audience(1 << 3));
    let world = host.seal(NOW, &world(1, 0, 1));
    for mut packet in others.into_iter().chain([world]) {
        if let Some(last) = packet.last_mut() {
            *last ^= 1;
        }
        assert_eq!(link.open(NOW, &packet), Ok(Received::Elsewhere), "its tag is not looked at");
    }
    assert_eq!(link.refused(), &[0; Refusal::KINDS]);
}
