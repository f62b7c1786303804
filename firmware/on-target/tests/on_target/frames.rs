//! Frames are the bytes of `protocol/SPEC.md`, on this processor too.

#[embedded_test::tests]
mod tests {
    use protocol::frame::{Frame, Key, Sender, TeamKey};
    use protocol::serial::{Lines, line};
    use protocol::{RobotId, TeamId};

    /// `host-frame` of the specification: "stand" for robot 3, under its key of the team's key 00 01 … 0f.
    const FRAME: [u8; 25] = [
        0x02, 0x01, 0x10, 0x00, 0x00, 0x00, 0x65, 0x01, 0x10, 0x00, 0x00, 0x01, 0x03, 0x00, 0x00, 0x00, 0x00,
        0x86, 0x67, 0x4b, 0xb1, 0x4b, 0x9e, 0x24, 0x50,
    ];
    /// The same frame, encoded for a line.
    const LINE: [u8; 27] = [
        0x04, 0x02, 0x01, 0x10, 0x01, 0x01, 0x04, 0x65, 0x01, 0x10, 0x01, 0x03, 0x01, 0x03, 0x01, 0x01, 0x01,
        0x09, 0x86, 0x67, 0x4b, 0xb1, 0x4b, 0x9e, 0x24, 0x50, 0x00,
    ];

    fn robot() -> RobotId {
        RobotId::new(3).expect("an id")
    }

    fn key() -> Key {
        TeamKey(core::array::from_fn(|n| n as u8)).of_robot(robot()).host
    }

    fn frame() -> Frame<'static> {
        Frame {
            team: TeamId(1),
            sender: Sender::Host,
            audience: None,
            epoch: 0x6500_0000,
            counter: 4097,
            payload: FRAME.get(11..17).expect("six bytes"),
        }
    }

    #[test]
    fn the_frame_of_the_specification_is_written_and_read() {
        let out = frame().emit(&key()).expect("room");
        assert_eq!(out[..], FRAME[..]);
        assert_eq!(Frame::parse(&FRAME, TeamId(1)), Ok(frame()));
    }

    #[test]
    fn one_changed_bit_makes_a_frame_a_forgery() {
        let other = TeamKey::ZERO.of_robot(robot()).host;
        assert!(frame().is_genuine(&FRAME, &key(), robot()) && !frame().is_genuine(&FRAME, &other, robot()));
        for bit in 0..8 * FRAME.len() {
            let mut bytes = FRAME;
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(!frame().is_genuine(&bytes, &key(), robot()), "bit {bit}");
        }
    }

    #[test]
    fn a_line_brings_its_frame_after_any_rubbish() {
        assert_eq!(line(&FRAME)[..], LINE[..]);
        let mut lines = Lines::new();
        let rubbish = [0xff; 400].into_iter().chain([0]);
        let packets = rubbish.chain(LINE).filter_map(|byte| lines.push(byte));
        assert!(packets.last().is_some_and(|packet| packet[..] == FRAME[..]));
        assert!(lines.dropped() > 0);
    }
}
