//! `upset`: tests: a register of a chip is upset in mid-match, at the robot or at the base station, and
//! frames arrive again.

use embedded_hal::spi::{Operation, SpiDevice};
use nrf24::{Base, Channel, Rate, Robot};
use nrf24_model::{Air, Faults};
use protocol::frame::{Frame, Sender, TeamKey};
use protocol::{Instant, RobotId, TeamId};

const ROBOT: u8 = 3;

/// A command to the robot.
fn frame(counter: u32) -> Vec<u8> {
    let robot = RobotId::new(ROBOT).unwrap();
    let payload = [1, ROBOT, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let sender = Sender::new(16).unwrap();
    let frame = Frame { team: TeamId(2), sender, audience: None, epoch: 5, counter, payload: &payload };
    frame.emit(TeamKey([7; 16]).of_team().of(robot)).expect("it fits").to_vec()
}

/// Frames that the robot receives in the second before the upset and in the two after it, and restarts of
/// both chips.
fn play(at_base: bool, rate: Rate, upset: &[(u8, &[u8])]) -> ([u32; 3], u32) {
    let air = Air::new(Faults::default(), 1);
    let channel = Channel { team: TeamId(2), megahertz: 10, rate };
    let (a, b) = (air.chip(), air.chip());
    let mut base = Base::start(Instant(0), channel, a.spi(), a.chip_enable(), a.pause()).unwrap();
    let number = RobotId::new(ROBOT).unwrap();
    let mut robot = Robot::start(Instant(0), channel, number, b.spi(), b.chip_enable(), b.pause()).unwrap();
    let (mut got, mut counter) = ([0; 3], 1);
    for now in (0..3_000_000_u64).step_by(100) {
        air.advance(now * 1000);
        if now == 1_000_000 {
            let mut spi = if at_base { a.spi() } else { b.spi() };
            for (register, value) in upset {
                let bytes = [&[0x20 | register], *value].concat();
                spi.transaction(&mut [Operation::Write(&bytes)]).unwrap();
            }
        }
        if now % 10_000 == 0 {
            counter += 1;
            base.send(Instant(now), &frame(counter)).unwrap();
        }
        while base.poll(Instant(now)).unwrap().is_some() {}
        while robot.poll(Instant(now)).unwrap().is_some() {
            got[(now / 1_000_000) as usize] += 1;
        }
    }
    (got, robot.counts().restarts + base.counts().restarts)
}

#[test]
fn an_upset_register_of_either_chip_is_set_again_within_a_fifth_of_a_second() {
    // Register, and what it is upset to: every one that is set, several in several ways.
    let upsets: [(&str, u8, &[u8]); 20] = [
        ("CONFIG, power", 0x00, &[0x0d]),
        ("CONFIG, direction", 0x00, &[0x0e]),
        ("CONFIG, reset", 0x00, &[0x08]),
        ("CONFIG, check sum of 8 bits", 0x00, &[0x0b]),
        ("EN_AA", 0x01, &[0x00]),
        ("EN_RXADDR, none", 0x02, &[0x00]),
        ("EN_RXADDR, pipe 0 alone", 0x02, &[0x01]),
        ("SETUP_AW", 0x03, &[0x01]),
        ("SETUP_RETR", 0x04, &[0xf0]),
        ("RF_CH", 0x05, &[11]),
        ("RF_SETUP, the other rate", 0x06, &[0x26]),
        ("RF_SETUP, power", 0x06, &[0x08]),
        ("RX_ADDR_P0", 0x0a, &[1, 2, 3, 4, 5]),
        ("RX_ADDR_P1", 0x0b, &[0x22, 2, 0, 0, 0]),
        ("RX_ADDR_P2", 0x0c, &[0x70]),
        ("TX_ADDR", 0x10, &[1, 2, 3, 4, 5]),
        ("RX_PW_P0", 0x11, &[0]),
        ("RX_PW_P1", 0x12, &[0]),
        ("DYNPD", 0x1c, &[0x00]),
        ("FEATURE", 0x1d, &[0x00]),
    ];
    for rate in [Rate::Mbps1, Rate::Mbps2] {
        for at_base in [false, true] {
            let (usual, restarts) = play(at_base, rate, &[]);
            assert!(restarts == 0 && usual.iter().all(|frames| *frames >= 98), "{usual:?}, {restarts}");
            for (name, register, value) in upsets {
                let (got, _) = play(at_base, rate, &[(register, value)]);
                let place = format!("{name} at the {}, {rate:?}", if at_base { "base" } else { "robot" });
                assert!(got[1] >= 78 && got[2] >= 98, "{place}: frames a second {got:?}");
            }
        }
    }
}
