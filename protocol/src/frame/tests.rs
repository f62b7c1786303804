//! Tests of `frame`: bytes of the specification, flipped bits, refusals in order, counters and epochs.

use super::*;

const TEAM: TeamId = TeamId(3);
const KEY: Key = Key([7; 16]);

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

fn frame(epoch: u32, counter: u32) -> Frame<'static> {
    let sender = Sender::Robot(robot(2));
    Frame { team: TEAM, sender, audience: None, epoch, counter, payload: b"abc" }
}

fn to_several(robots: &[u8]) -> Frame<'static> {
    let audience = Some(robots.iter().map(|n| robot(*n)).collect());
    Frame { sender: Sender::Host, audience, ..frame(7, 9) }
}

#[test]
fn a_frame_has_the_bytes_of_the_specification() {
    let out = frame(0x0102_0304, 5).emit(&KEY).unwrap();
    assert_eq!(out.len(), OVERHEAD + 3);
    assert_eq!(&out[..14], &[2, 3, 2, 4, 3, 2, 1, 5, 0, 0, 0, b'a', b'b', b'c']);
    assert_eq!(Frame::parse(&out, TEAM), Ok(frame(0x0102_0304, 5)));
    assert!(frame(0x0102_0304, 5).is_genuine(&out, &KEY, robot(0)));
}

#[test]
fn a_frame_to_several_has_a_tag_each_and_each_notices_its_flipped_bits() {
    let keys = TeamKey([9; 16]).of_team();
    let sent = to_several(&[0, 4, 15]);
    let mut out = sent.emit_to_audience(&keys).unwrap();
    let n = out.len();
    assert_eq!(n, HEADER_LEN + 2 + 3 + 3 * 3);
    assert_eq!(out[2], 17);
    assert_eq!(Frame::parse(&out[..n], TEAM), Ok(sent));
    for reader in RobotId::all() {
        let addressed = [0, 4, 15].contains(&reader.number());
        assert_eq!(sent.is_genuine(&out[..n], keys.of(reader), reader), addressed, "{reader}");
        // No other robot's key opens it in this robot's place.
        let others = RobotId::all().filter(|other| *other != reader);
        assert_eq!(others.filter(|other| sent.is_genuine(&out[..n], keys.of(*other), reader)).count(), 0);
    }
    let covered = n - 9;
    for bit in 0..n * 8 {
        out[bit / 8] ^= 1 << (bit % 8);
        for (place, reader) in [0, 4, 15].map(robot).into_iter().enumerate() {
            let own = covered + 3 * place..covered + 3 * place + 3;
            let concerns = bit / 8 < covered || own.contains(&(bit / 8));
            assert_eq!(sent.is_genuine(&out[..n], keys.of(reader), reader), !concerns, "bit {bit}, {reader}");
        }
        out[bit / 8] ^= 1 << (bit % 8);
    }
}

#[test]
fn every_flipped_bit_is_noticed() {
    let mut out = frame(1, 1).emit(&KEY).unwrap();
    let n = out.len();
    for bit in 0..n * 8 {
        out[bit / 8] ^= 1 << (bit % 8);
        assert!(!frame(1, 1).is_genuine(&out[..n], &KEY, robot(0)), "bit {bit}");
        out[bit / 8] ^= 1 << (bit % 8);
    }
}

#[test]
fn the_order_of_refusals_is_length_then_id() {
    assert_eq!(Frame::parse(&[0; 18], TEAM), Err(Refusal::Length(18)));
    assert_eq!(Frame::parse(&[0; 121], TEAM), Err(Refusal::Length(121)));
    assert_eq!(Frame::parse(&[9; 19], TEAM), Err(Refusal::Version(9)));
    let mut bytes = [0; 19];
    bytes[0] = 1;
    assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Version(1)), "the version before keys were derived");
    bytes[0] = VERSION;
    assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Team(TeamId(0))));
    (bytes[1], bytes[2]) = (3, 18);
    assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Sender(18)));
    // More tags than bytes.
    (bytes[2], bytes[11], bytes[12]) = (17, 0x07, 0);
    assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Length(19)));
}

#[test]
fn a_counter_must_rise_and_a_new_epoch_starts_over() {
    let mut sessions = Sessions::default();
    sessions.accept(&frame(7, 10));
    assert_eq!(sessions.check(&frame(7, 10)), Err(Refusal::Counter { seen: 10, last: 10 }));
    assert_eq!(sessions.check(&frame(6, 99)), Err(Refusal::Epoch { seen: 6, current: 7 }));
    assert_eq!(sessions.check(&frame(7, 11)), Ok(()));
    assert_eq!(sessions.check(&frame(8, 0)), Ok(()));
}

#[test]
fn sixteen_robots_and_a_host_can_speak() {
    assert_eq!(Sender::new(15), RobotId::new(15).map(Sender::Robot));
    assert_eq!(Sender::new(16), Some(Sender::Host));
    assert_eq!(Sender::new(17), None);
    for n in 0..Sender::COUNT {
        let sender = Sender::new(n as u8).unwrap();
        assert_eq!((usize::from(sender.number()), sender.index()), (n, n));
    }
}

#[test]
fn a_frame_that_does_not_fit_is_not_written() {
    let keys = TeamKey([9; 16]).of_team();
    let payload = &[0; PAYLOAD_LEN_MAX + 1];
    assert_eq!(Frame { payload, ..frame(1, 1) }.emit(&KEY), None);
    assert_eq!(Frame { payload, ..to_several(&[1, 2]) }.emit_to_audience(&keys), None);
    assert_eq!(to_several(&[1, 2]).emit(&KEY), None);
    assert_eq!(frame(1, 1).emit_to_audience(&keys), None);
}
