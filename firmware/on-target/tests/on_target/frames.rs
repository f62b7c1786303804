//! Are frames the bytes that `protocol/SPEC.md` says, on this processor too?

#[embedded_test::tests]
mod tests {
    use protocol::TeamId;
    use protocol::frame::{Frame, Sender, TeamKey};
    use protocol::serial::{Lines, line};

    /// `host-frame` of the specification: "stand" for robot 3, under the key 00 01 … 0f.
    const FRAME: [u8; 25] = [
        0x01, 0x01, 0x10, 0x00, 0x00, 0x00, 0x65, 0x01, 0x10, 0x00, 0x00, 0x01, 0x03, 0x00, 0x00, 0x00, 0x00,
        0x5d, 0x0c, 0x43, 0x91, 0x40, 0xbe, 0x58, 0x58,
    ];
    /// The same on a line.
    const LINE: [u8; 27] = [
        0x04, 0x01, 0x01, 0x10, 0x01, 0x01, 0x04, 0x65, 0x01, 0x10, 0x01, 0x03, 0x01, 0x03, 0x01, 0x01, 0x01,
        0x09, 0x5d, 0x0c, 0x43, 0x91, 0x40, 0xbe, 0x58, 0x58, 0x00,
    ];

    fn key() -> TeamKey {
        TeamKey(core::array::from_fn(|n| n as u8))
    }

    #[test]
    fn the_frame_of_the_specification_is_written_and_read() {
        let payload = FRAME.get(11..17).expect("six bytes");
        let frame =
            Frame { team: TeamId(1), sender: Sender::Host, epoch: 0x6500_0000, counter: 4097, payload };
        let mut out = [0; 64];
        let len = frame.emit(&key(), &mut out).expect("room");
        assert_eq!(out.get(..len), Some(&FRAME[..]));
        assert_eq!(Frame::parse(&FRAME, TeamId(1)), Ok(frame));
    }

    #[test]
    fn one_changed_bit_makes_a_frame_a_forgery() {
        assert!(Frame::is_genuine(&FRAME, &key()) && !Frame::is_genuine(&FRAME, &TeamKey::ZERO));
        for bit in 0..8 * FRAME.len() {
            let mut bytes = FRAME;
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(!Frame::is_genuine(&bytes, &key()), "bit {bit}");
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
